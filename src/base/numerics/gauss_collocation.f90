!> Gauss collocation: the implicit Runge–Kutta method of order 2s with s stages.
module gauss_collocation
  use kinds, only: wp
  use legendre, only: gauss_rule, legendre_values, once_integrated
  implicit none (type, external)
  private

  public :: collocation_t, new_collocation

  type :: collocation_t
    real(wp), allocatable :: node(:)      !! (stages) from 0 to 1
    real(wp), allocatable :: weight(:)    !! (stages) of the whole step
    real(wp), allocatable :: matrix(:, :) !! (stages, stages) a_ij: `∫` from 0 to node i of the
                                          !! polynomial that is 1 at node j, 0 at the others
  end type collocation_t

contains

  !> The method with a number of stages.
  pure function new_collocation(stages) result(rule)
    integer, intent(in) :: stages !! from 1
    type(collocation_t) :: rule

    real(wp) :: x(stages), w(stages), at_node(0:stages - 1), integral(0:stages)
    real(wp) :: polynomials(0:stages)
    integer :: i, j, k

    call gauss_rule(x, w)
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
  end function new_collocation

end module gauss_collocation
