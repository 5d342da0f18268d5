!> Drives that contradict what the links demand: more of them than a linkage has freedoms.
module superfluous_drives
  use constants, only: degree
  use errors, only: error_t
  use kinds, only: wp
  use linkages, only: gives_angle, linkage_t
  use pose_types, only: pose_t
  use poses, only: place_pins
  use redundancies, only: misfit_of_redundancy
  implicit none (type, external)
  private

  public :: find_superfluous_drive

contains

  !> The mobility of a linkage whose redundant equations are not fulfilled, and the last of its
  !! further drives that is to blame.
  !!
  !! Drives are moved one by one: redundant equations whose misfits follow leave them as many
  !! freedoms fewer as there are independent ones. An equation of a length that is wrong, and fits
  !! otherwise, hardly follows.
  pure subroutine find_superfluous_drive(linkage, crank, mobility, number)
    type(linkage_t), intent(in) :: linkage !! with redundancies
    real(wp), intent(in) :: crank          !! where it does not fit [deg] or [m]
    integer, intent(out) :: mobility       !! what the redundant equations leave of its drives
    integer, intent(out) :: number         !! of the drive; 0: no further one is to blame

    !> A misfit that follows a drive does so by this share of its way, or more.
    real(wp), parameter :: follows = 0.02_wp
    type(linkage_t) :: moved
    type(pose_t) :: pose, other
    type(error_t), allocatable :: error
    real(wp), dimension(size(linkage%redundancies), size(linkage%drives)) :: rates
    real(wp) :: row(size(linkage%drives)), span, step, angle
    integer :: pivot(2), rank, k, i

    number = 0
    mobility = size(linkage%drives)
    call place_pins(linkage, crank, pose, error)
    if (allocated(error)) return
    span = max(maxval(abs(pose%pin)), maxval(linkage%bodies%length))
    angle = 0.01_wp
    do k = 1, size(linkage%drives)
      step = angle*degree*span
      moved = linkage
      moved%drives(k)%phase = moved%drives(k)%phase + merge(angle, step, &
        gives_angle(linkage%drives(k)))
      call place_pins(moved, crank, other, error)
      if (allocated(error)) then
        number = 0
        return
      end if
      rates(:, k) = [((misfit_of_redundancy(moved, i, other, crank) - &
        misfit_of_redundancy(linkage, i, pose, crank))/step, &
        i=1, size(rates, 1))]
      if (k > 1 .and. any(abs(rates(:, k)) > follows)) number = k
    end do
    ! The rank, by elimination.
    do rank = 0, minval(shape(rates)) - 1
      pivot = maxloc(abs(rates))
      if (abs(rates(pivot(1), pivot(2))) <= follows) exit
      row = rates(pivot(1), :)/rates(pivot(1), pivot(2))
      do i = 1, size(rates, 1)
        rates(i, :) = rates(i, :) - rates(i, pivot(2))*row
      end do
    end do
    mobility = mobility - rank
  end subroutine find_superfluous_drive

end module superfluous_drives
