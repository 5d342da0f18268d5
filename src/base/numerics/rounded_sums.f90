!> Sums that are zero where nothing but rounding is left of them.
module rounded_sums
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: rounded_sum_t, without_rounding

  !> A sum and the sum of the sizes of its terms.
  type :: rounded_sum_t
    real(wp) :: value = 0.0_wp
    real(wp) :: size = 0.0_wp
    integer :: terms = 0
  contains
    procedure :: add
  end type rounded_sum_t

  !> Roundings that a term has of its own: it is a product of some numbers.
  integer, parameter :: own_roundings = 8

contains

  !> Adds a term.
  elemental subroutine add(self, term)
    class(rounded_sum_t), intent(inout) :: self
    real(wp), intent(in) :: term

    self%value = self%value + term
    self%size = self%size + abs(term)
    self%terms = self%terms + 1
  end subroutine add

  !> The sum; 0 where it is no larger than its rounding.
  elemental function without_rounding(sum) result(value)
    type(rounded_sum_t), intent(in) :: sum
    real(wp) :: value

    value = sum%value
    if (abs(value) <= (sum%terms + own_roundings)*epsilon(1.0_wp)*sum%size) value = 0.0_wp
  end function without_rounding

end module rounded_sums
