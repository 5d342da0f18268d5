! src/base/sparse/ - sparse symmetric matrices that are sums of small dense element matrices.
! In: the unknowns of each element, and its values. Out: products, the number of negative
! eigenvalues, solutions. Begin with `elements_t` here; `new_elimination_plan` once in
! `elimination_plan.f90`, then `factorize` and `solve` in `indefinite_factor.f90`.
! Not here: band, bordered and full matrices (`src/base/numerics`), eigenproblems (`src/eigen`).

!> Sums of dense symmetric element matrices, and their products with vectors.
module element_matrices
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: elements_t, new_elements, times_vector, absolute_times_vector

  !> Which unknowns each element couples. Values are apart, in one list: of an element with n
  !! unknowns the n·n entries column by column, both triangles.
  type :: elements_t
    integer :: unknowns = 0                !! of the whole matrix
    integer, allocatable :: first(:)       !! (elements + 1) first entry of each in `unknown`
    integer, allocatable :: unknown(:)     !! numbers of the unknowns, element after element, no
                                           !! number twice in one
    integer, allocatable :: value_first(:) !! (elements + 1) first of the values of each
  end type elements_t

contains

  !> Elements from the unknowns of one after the other.
  pure function new_elements(unknowns, sizes, unknown) result(elements)
    integer, intent(in) :: unknowns   !! of the whole matrix
    integer, intent(in) :: sizes(:)   !! (elements) unknowns of each
    integer, intent(in) :: unknown(:) !! (sum of sizes) their numbers, from 1
    type(elements_t) :: elements

    integer :: e

    elements%unknowns = unknowns
    elements%unknown = unknown
    allocate (elements%first(size(sizes) + 1), elements%value_first(size(sizes) + 1))
    elements%first(1) = 1
    elements%value_first(1) = 1
    do e = 1, size(sizes)
      elements%first(e + 1) = elements%first(e) + sizes(e)
      elements%value_first(e + 1) = elements%value_first(e) + sizes(e)**2
    end do
  end function new_elements

  !> `y = A x`
  pure subroutine times_vector(elements, value, x, y)
    type(elements_t), intent(in) :: elements !! of A
    real(wp), intent(in), contiguous :: value(:)         !! of the elements
    real(wp), intent(in) :: x(:)             !! (unknowns)
    real(wp), intent(out) :: y(:)            !! (unknowns)

    integer :: e, n

    y = 0.0_wp
    do e = 1, size(elements%first) - 1
      n = elements%first(e + 1) - elements%first(e)
      call add_product(n, elements%unknown(elements%first(e):), &
        value(elements%value_first(e):), x, y)
    end do
  end subroutine times_vector

  !> `y = Σ |Aₑ| |x|`: what the rounding errors of `A x` are to be compared with.
  pure subroutine absolute_times_vector(elements, value, x, y)
    type(elements_t), intent(in) :: elements !! of A
    real(wp), intent(in), contiguous :: value(:)         !! of the elements
    real(wp), intent(in) :: x(:)             !! (unknowns)
    real(wp), intent(out) :: y(:)            !! (unknowns)

    call times_vector(elements, abs(value), abs(x), y)
  end subroutine absolute_times_vector

  !> Adds the product of one element.
  pure subroutine add_product(n, unknown, a, x, y)
    integer, intent(in) :: n             !! unknowns
    integer, intent(in) :: unknown(n)    !! their numbers
    real(wp), intent(in) :: a(n, n)      !! the element
    real(wp), intent(in) :: x(:)
    real(wp), intent(inout) :: y(:)

    real(wp) :: total(n)
    integer :: j

    total = 0.0_wp
    do j = 1, n
      total = total + a(:, j)*x(unknown(j))
    end do
    y(unknown) = y(unknown) + total
  end subroutine add_product

end module element_matrices
