!> Collocation methods: the implicit Runge–Kutta methods of Gauss, of order 2s with s stages, and of
!! Radau (IIA), of order 2s − 1, whose last stage is the end of the step.
module gauss_collocation
  use kinds, only: wp
  use legendre, only: gauss_rule, legendre_values, once_integrated
  implicit none (type, external)
  private

  public :: collocation_t, new_collocation, new_radau_collocation

  type :: collocation_t
    real(wp), allocatable :: node(:)      !! (stages) from 0 to 1
    real(wp), allocatable :: weight(:)    !! (stages) of the whole step
    real(wp), allocatable :: matrix(:, :) !! (stages, stages) a_ij: `∫` from 0 to node i of the
                                          !! polynomial that is 1 at node j, 0 at the others
  end type collocation_t

contains

  !> The method of Gauss with a number of stages: symplectic.
  pure function new_collocation(stages) result(rule)
    integer, intent(in) :: stages !! from 1
    type(collocation_t) :: rule

    real(wp) :: x(stages), w(stages)

    call gauss_rule(x, w)
    rule = collocation_on(x, w)
  end function new_collocation

  !> The method of Radau with a number of stages: what changes much faster than its steps fades at
  !! once.
  pure function new_radau_collocation(stages) result(rule)
    integer, intent(in) :: stages !! from 1
    type(collocation_t) :: rule

    real(wp) :: x(stages), w(stages)

    call radau_rule(x, w)
    rule = collocation_on(x, w)
  end function new_radau_collocation

  !> Nodes and weights of Radau's rule on −1 to 1, with the node 1: roots of `P_s − P_{s−1}` by
  !! Newton's method, each with the roots before it divided out.
  pure subroutine radau_rule(x, w)
    real(wp), intent(out) :: x(:), w(:)

    !> Left of all roots for any number of stages in use.
    real(wp), parameter :: start = -0.9999_wp
    integer, parameter :: most_iterations = 100
    real(wp) :: p(0:size(x)), slope, value, change
    integer :: i, k, s

    s = size(x)
    x(s) = 1.0_wp
    w(s) = 2.0_wp/s**2
    do i = 1, s - 1
      x(i) = start
      do k = 1, most_iterations
        p = legendre_values(s, x(i))
        value = p(s) - p(s - 1)
        slope = s*(p(s) + p(s - 1))/(1.0_wp + x(i))
        change = value/(slope - value*sum(1.0_wp/(x(i) - [x(:i - 1), 1.0_wp])))
        x(i) = x(i) - change
        if (abs(change) <= 2.0_wp*epsilon(1.0_wp)) exit
      end do
      p(:s - 1) = legendre_values(s - 1, x(i))
      w(i) = (1.0_wp + x(i))/(s*p(s - 1))**2
    end do
  end subroutine radau_rule

  !> The polynomial through given nodes, integrated from the start of a step to each of them. The
  !! rule is to be exact to degree 2s − 2.
  pure function collocation_on(x, w) result(rule)
    real(wp), intent(in) :: x(:), w(:) !! (stages) nodes on −1 to 1 and their weights
    type(collocation_t) :: rule

    real(wp) :: at_node(0:size(x) - 1), integral(0:size(x)), polynomials(0:size(x))
    integer :: i, j, k, stages

    stages = size(x)
    rule%node = 0.5_wp*(1.0_wp + x)
    rule%weight = 0.5_wp*w
    allocate (rule%matrix(stages, stages))
    ! The Lagrange polynomial of node j in Legendre polynomials: Σ (2k + 1)/2 w_j P_k(x_j) P_k.
    do j = 1, stages
      at_node = legendre_values(stages - 1, x(j))
      integral = 0.0_wp
      do k = 0, stages - 1
        integral(:k + 1) = integral(:k + 1) + 0.5_wp*(2*k + 1)*w(j)*at_node(k)*once_integrated(k)
      end do
      do i = 1, stages
        polynomials = legendre_values(stages, x(i))
        rule%matrix(i, j) = 0.5_wp*dot_product(integral, polynomials)
      end do
    end do
  end function collocation_on

end module gauss_collocation
