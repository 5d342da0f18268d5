!> Steps along the way of a linkage: a place near by is found from velocities and accelerations, and
!! solved for.
module path_steps
  use errors, only: error_t
  use group_determinants, only: determinants_of
  use kinds, only: wp
  use kinematic_coefficients, only: find_kinematic_coefficients, kinematic_coefficients_t
  use linkages, only: linkage_t, normal_to
  use pose_types, only: pose_t
  use poses, only: dead_point_sine, place_groups, still
  implicit none (type, external)
  private

  public :: station_t, new_station, take_step, step_to

  !> A place on the way.
  type :: station_t
    real(wp) :: crank = 0.0_wp    !! coordinate of the first drive [deg] or [m]
    type(pose_t) :: pose          !! pins from `reference_point`
    type(kinematic_coefficients_t) :: coefficients
  end type station_t

contains

  !> A pose as a place on the way.
  pure function new_station(linkage, crank, pose) result(station)
    type(linkage_t), intent(in) :: linkage !! with groups
    real(wp), intent(in) :: crank          !! coordinate of the first drive [deg] or [m]
    type(pose_t), intent(in) :: pose       !! away from dead points
    type(station_t) :: station

    station%crank = crank
    station%pose = pose
    station%coefficients = find_kinematic_coefficients(linkage, pose)
  end function new_station

  !> One step along the way, on the same side of all change points, from velocities and
  !! accelerations.
  pure subroutine take_step(linkage, station, step, unit, next, is_good)
    type(linkage_t), intent(in) :: linkage     !! with groups
    type(station_t), intent(in) :: station     !! before the step
    real(wp), intent(in) :: step               !! [deg] or [m]
    real(wp), intent(in) :: unit               !! of the coordinate [rad] or [m]
    type(station_t), intent(out) :: next
    logical, intent(out) :: is_good            !! as of `step_to`

    type(pose_t) :: expected

    expected = expected_pose(station, step*unit)
    is_good = all(determinants_of(linkage, expected)*station%pose%sine > 0.0_wp)
    if (is_good) call step_to(linkage, station, station%crank + step, expected, next, is_good)
  end subroutine take_step

  !> A step to where the linkage is expected. It is good if the linkage closes near there, with the
  !! determinants that are expected: it cannot have left its branch, and over a change point goes on
  !! smoothly.
  pure subroutine step_to(linkage, station, crank, expected, next, is_good)
    type(linkage_t), intent(in) :: linkage     !! with groups
    type(station_t), intent(in) :: station     !! before the step
    real(wp), intent(in) :: crank              !! after it [deg] or [m]
    type(pose_t), intent(in) :: expected       !! then
    type(station_t), intent(out) :: next
    logical, intent(out) :: is_good

    type(error_t), allocatable :: error
    type(pose_t) :: pose
    real(wp) :: sine(size(linkage%groups)), correction

    sine = determinants_of(linkage, expected)
    pose = expected
    if (allocated(pose%coefficients)) deallocate (pose%coefficients)
    call place_groups(linkage, crank, pose, correction, error, sign(1.0_wp, sine))
    is_good = .not. allocated(error)
    if (.not. is_good) return
    correction = maxval(abs(pose%pin - expected%pin))
    ! Drives that stand still leave nothing but rounding.
    if (linkage%runs_in_time) correction = correction - still*maxval(linkage%bodies%length)
    is_good = all(pose%sine*sine > 0.0_wp) .and. all(abs(pose%sine) > dead_point_sine) .and. &
      correction <= 0.1_wp*maxval(abs(pose%pin - station%pose%pin))
    if (is_good) next = new_station(linkage, crank, pose)
  end subroutine step_to

  !> Where velocities and accelerations lead.
  pure function expected_pose(station, d) result(pose)
    type(station_t), intent(in) :: station
    real(wp), intent(in) :: d !! [rad] or [m]
    type(pose_t) :: pose

    real(wp) :: angle
    integer :: b

    pose = station%pose
    if (allocated(pose%coefficients)) deallocate (pose%coefficients)
    associate (it => station%coefficients)
      pose%pin = pose%pin + d*it%pin + 0.5_wp*d**2*it%pin_slope
      do b = 1, size(pose%direction, 2)
        angle = d*it%turn(b) + 0.5_wp*d**2*it%turn_slope(b)
        pose%direction(:, b) = cos(angle)*station%pose%direction(:, b) + sin(angle)*normal_to( &
          station%pose%direction(:, b))
      end do
    end associate
  end function expected_pose

end module path_steps
