!> Distances between eigenvalues, and of eigenvalues from their true values.
module eigenvalue_gaps
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: relative_gap, relative_error

contains

  !> Distance of an eigenvalue to the nearest other one, relative to the larger magnitude of the
  !! two; at most 1, and 1 without another.
  pure function relative_gap(lambda, i, added) result(gap)
    real(wp), intent(in) :: lambda(:)       !! (modes)
    integer, intent(in) :: i                !! its number
    real(wp), intent(in), optional :: added !! to the larger magnitude, where eigenvalues may
                                            !! vanish; absent: 0
    real(wp) :: gap

    real(wp) :: more
    integer :: j

    more = 0.0_wp
    if (present(added)) more = added
    gap = 1.0_wp
    do j = 1, size(lambda)
      if (j == i) cycle
      gap = min(gap, abs(lambda(j) - lambda(i))/(max(abs(lambda(i)), abs(lambda(j)), tiny(gap)) + &
        more))
    end do
  end function relative_gap

  !> An error relative to its eigenvalue; at most 1e30, where no digit of the eigenvalue is left.
  elemental function relative_error(absolute, lambda) result(error)
    real(wp), intent(in) :: absolute !! error of the eigenvalue, not negative [1/s²]
    real(wp), intent(in) :: lambda   !! [1/s²]
    real(wp) :: error                !! [-]

    real(wp), parameter :: most = 1.0e30_wp

    error = absolute/max(abs(lambda), absolute/most, tiny(lambda))
  end function relative_error

end module eigenvalue_gaps
