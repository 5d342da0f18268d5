!> Steps along the way of a linkage: a place near by is found from velocities and accelerations, and
!! solved for.
module path_steps
  use errors, only: error_t
  use group_determinants, only: determinants_of
  use kinds, only: wp
  use kinematic_coefficients, only: find_kinematic_coefficients, kinematic_coefficients_t
  use linkages, only: linkage_t, normal_to
  use pose_types, only: pose_t
  use poses, only: dead_point_sine, place_groups
  implicit none (type, external)
  private

  public :: station_t, new_station, take_step, expected_sines

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

  !> One step along the way. It is good if the linkage closes near where it is expected, with the
  !! determinants that are expected: it cannot have left its branch, and over a change point goes on
  !! smoothly.
  pure subroutine take_step(linkage, station, step, unit, next, is_good, over_change)
    type(linkage_t), intent(in) :: linkage     !! with groups
    type(station_t), intent(in) :: station     !! before the step
    real(wp), intent(in) :: step               !! [deg] or [m]
    real(wp), intent(in) :: unit               !! of the coordinate [rad] or [m]
    type(station_t), intent(out) :: next
    logical, intent(out) :: is_good
    logical, intent(in), optional :: over_change !! determinants may change their signs; absent: no

    type(error_t), allocatable :: error
    type(pose_t) :: expected, pose
    real(wp) :: sine(size(linkage%groups)), correction

    expected = expected_pose(station, step*unit)
    sine = determinants_of(linkage, expected)
    is_good = present(over_change) .or. all(sine*station%pose%sine > 0.0_wp)
    if (.not. is_good) return
    pose = expected
    call place_groups(linkage, station%crank + step, pose, correction, error, sign(1.0_wp, sine))
    is_good = .not. allocated(error)
    if (.not. is_good) return
    correction = maxval(abs(pose%pin - expected%pin))
    is_good = all(pose%sine*sine > 0.0_wp) .and. all(abs(pose%sine) > dead_point_sine) .and. &
      correction <= 0.1_wp*maxval(abs(pose%pin - station%pose%pin))
    if (is_good) next = new_station(linkage, station%crank + step, pose)
  end subroutine take_step

  !> The determinants of groups that are expected after a step.
  pure function expected_sines(linkage, station, step, unit) result(sine)
    type(linkage_t), intent(in) :: linkage
    type(station_t), intent(in) :: station !! before the step
    real(wp), intent(in) :: step           !! [deg] or [m]
    real(wp), intent(in) :: unit           !! of the coordinate [rad] or [m]
    real(wp) :: sine(size(linkage%groups))

    sine = determinants_of(linkage, expected_pose(station, step*unit))
  end function expected_sines

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
