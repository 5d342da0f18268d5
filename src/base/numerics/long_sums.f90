!> Sums of many terms whose round-off does not grow with their number.
module long_sums
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: add_exactly, long_dot

contains

  !> Adds to a running sum held in two parts, of which the second is what the first has lost to
  !! rounding.
  pure subroutine add_exactly(total, term)
    real(wp), intent(inout) :: total(2) !! rounded sum and correction
    real(wp), intent(in) :: term        !! added

    real(wp) :: sum_of, part

    sum_of = total(1) + term
    part = sum_of - total(1)
    total(2) = total(2) + ((total(1) - (sum_of - part)) + (term - part))
    total(1) = sum_of
  end subroutine add_exactly

  !> Scalar product of long vectors.
  pure function long_dot(a, b) result(product)
    real(wp), intent(in) :: a(:), b(:) !! (n)
    real(wp) :: product

    real(wp) :: total(2)
    integer :: i

    total = 0.0_wp
    do i = 1, size(a)
      call add_exactly(total, a(i)*b(i))
    end do
    product = sum(total)
  end function long_dot

end module long_sums
