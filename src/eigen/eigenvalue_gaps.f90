!> How near eigenvalues are to each other.
module eigenvalue_gaps
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: relative_gap

contains

  !> Distance of an eigenvalue to the nearest other one, relative to the larger of both; 1 if there
  !! is no other.
  pure function relative_gap(lambda, i) result(gap)
    real(wp), intent(in) :: lambda(:)
    integer, intent(in) :: i
    real(wp) :: gap

    integer :: j

    gap = 1.0_wp
    do j = 1, size(lambda)
      if (j == i) cycle
      gap = min(gap, abs(lambda(j) - lambda(i))/max(abs(lambda(i)), abs(lambda(j)), tiny(gap)))
    end do
  end function relative_gap

end module eigenvalue_gaps
