!> Two symmetric matrices that can be multiplied with a vector, whatever they look like.
module symmetric_pencil
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: symmetric_pencil_t, long_dot

  type, abstract :: symmetric_pencil_t
    integer :: unknowns = 0
  contains
    procedure(multiply), deferred :: multiply
  end type symmetric_pencil_t

  abstract interface
    !> `M x` and `K x`
    pure subroutine multiply(pencil, vector, mass_times, stiffness_times)
      import :: symmetric_pencil_t, wp
      class(symmetric_pencil_t), intent(in) :: pencil
      real(wp), intent(in) :: vector(:)
      real(wp), intent(out) :: mass_times(:), stiffness_times(:)
    end subroutine multiply
  end interface

contains

  !> Scalar product of long vectors. What each addition loses to rounding is added up as well, so that the error of the result does
  !! not grow with their length.
  pure function long_dot(a, b) result(total)
    real(wp), intent(in) :: a(:), b(:)
    real(wp) :: total

    real(wp) :: term, lost, sum_of, part
    integer :: i

    total = 0.0_wp
    lost = 0.0_wp
    do i = 1, size(a)
      term = a(i)*b(i)
      sum_of = total + term
      part = sum_of - total
      lost = lost + ((total - (sum_of - part)) + (term - part))
      total = sum_of
    end do
    total = total + lost
  end function long_dot

end module symmetric_pencil
