!> Equations that the others must fulfil: whether a linkage with redundant links fits.
module redundancies
  use errors, only: error_of_reach, error_t, set_error
  use group_equations, only: misfit_of
  use kinds, only: wp
  use linkages, only: demand_turn, linkage_t
  use pose_types, only: pose_t
  implicit none (type, external)
  private

  public :: largest_misfit, misfit_of_redundancy, refuse_misfit, is_fit

  !> A linkage fits where all equations are fulfilled to this share of its size.
  real(wp), parameter :: most_misfit = 1.0e-9_wp

contains

  !> The largest misfit of redundant equations; angles count with the length of the body [m].
  pure subroutine largest_misfit(linkage, pose, crank, misfit, number)
    type(linkage_t), intent(in) :: linkage !! with redundancies
    type(pose_t), intent(in) :: pose       !! of all groups
    real(wp), intent(in) :: crank          !! coordinate of the first drive [deg] or [m]
    real(wp), intent(out) :: misfit        !! with its sign: of a length, how much it is too short
    integer, intent(out) :: number         !! of the redundancy; 0: there is none

    real(wp) :: this
    integer :: i

    misfit = 0.0_wp
    number = 0
    do i = 1, size(linkage%redundancies)
      this = misfit_of_redundancy(linkage, i, pose, crank)
      if (number > 0 .and. abs(this) <= abs(misfit)) cycle
      misfit = this
      number = i
    end do
  end subroutine largest_misfit

  !> The misfit of a redundant equation; an angle counts with the length of the body [m].
  pure function misfit_of_redundancy(linkage, number, pose, crank) result(misfit)
    type(linkage_t), intent(in) :: linkage !! with redundancies
    integer, intent(in) :: number          !! of the redundancy, from 1
    type(pose_t), intent(in) :: pose       !! of all groups
    real(wp), intent(in) :: crank          !! coordinate of the first drive [deg] or [m]
    real(wp) :: misfit

    associate (equation => linkage%redundancies(number))
      misfit = misfit_of(linkage, equation, pose, crank)
      if (equation%kind == demand_turn) misfit = misfit*linkage%bodies(equation%body)%length
    end associate
  end function misfit_of_redundancy

  !> An error where a linkage does not fit.
  pure subroutine refuse_misfit(linkage, pose, crank, error)
    type(linkage_t), intent(in) :: linkage !! with or without redundancies
    type(pose_t), intent(in) :: pose       !! of all groups
    real(wp), intent(in) :: crank          !! coordinate of the first drive [deg] or [m]
    type(error_t), allocatable, intent(inout) :: error !! allocated if it does not

    real(wp) :: misfit
    integer :: number

    if (size(linkage%redundancies) == 0) return
    call largest_misfit(linkage, pose, crank, misfit, number)
    if (is_fit(linkage, pose, misfit)) return
    call set_error(error, error_of_reach, "the redundant link does not fit", &
      body=linkage%redundancies(number)%body, missing=misfit)
  end subroutine refuse_misfit

  !> Whether a misfit is small enough. The smaller determinants are, the more do pins move for what
  !! the lengths of links lack.
  pure function is_fit(linkage, pose, misfit)
    type(linkage_t), intent(in) :: linkage !! with redundancies
    type(pose_t), intent(in) :: pose       !! with or without determinants
    real(wp), intent(in) :: misfit         !! of one of them [m]
    logical :: is_fit

    real(wp), parameter :: least_share = 1.0e-5_wp
    real(wp) :: share

    share = 1.0_wp
    if (allocated(pose%sine)) share = min(1.0_wp, max(least_share, minval(abs(pose%sine))))
    is_fit = abs(misfit)*share <= most_misfit*max(maxval(linkage%bodies%length), &
      maxval(abs(pose%pin)))
  end function is_fit

end module redundancies
