!> Distances between eigenvalues.
module eigenvalue_gaps
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: relative_gap

contains

  !> Distance of an eigenvalue to the nearest other one, relative to the larger magnitude of the
  !! two; at most 1, and 1 without another.
  pure function relative_gap(lambda, i) result(gap)
    real(wp), intent(in) :: lambda(:) !! (modes)
    integer, intent(in) :: i          !! its number
    real(wp) :: gap

    integer :: j

    gap = 1.0_wp
    do j = 1, size(lambda)
      if (j == i) cycle
      gap = min(gap, abs(lambda(j) - lambda(i))/max(abs(lambda(i)), abs(lambda(j)), tiny(gap)))
    end do
  end function relative_gap

end module eigenvalue_gaps
