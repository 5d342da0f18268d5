!> Where loads turn over with the motion of a linkage.
module motion_switches
  use applied_loads, only: load_switches, turns_over
  use coordinates, only: evaluated_t
  use gears, only: gear_t
  use joint_friction, only: find_rubbing, friction_rates, has_friction, rubbing_t
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkages, only: linkage_t
  use pose_types, only: pose_t
  implicit none (type, external)
  private

  public :: switches_at, has_switches

contains

  !> Whether any load turns over with the motion.
  pure function has_switches(linkage, gear) result(has)
    type(linkage_t), intent(in) :: linkage !! its frictions and loads
    type(gear_t), intent(in) :: gear       !! of the first drive
    logical :: has

    has = has_friction(linkage) .or. gear%efficiency < 1.0_wp
    if (allocated(linkage%loads)) has = has .or. any(turns_over(linkage%loads))
  end function has_switches

  !> Velocities of what rubs, of loads, and of the driven body where its gear has losses, over those
  !! within which they turn over smoothly; see `rate_systems`.
  pure function switches_at(linkage, pose, along, now, gear, rate) result(switches)
    type(linkage_t), intent(in) :: linkage  !! its frictions and loads
    type(pose_t), intent(in) :: pose        !! positions and directions
    type(evaluated_t), intent(in) :: along(:) !! (loads) of `evaluate_loads` at this pose
    type(kinematic_coefficients_t), intent(in) :: now !! velocities [m/s], [rad/s]
    type(gear_t), intent(in) :: gear        !! of the first drive
    real(wp), intent(in) :: rate            !! of this drive [rad/s] or [m/s]
    real(wp), allocatable :: switches(:, :) !! (2, frictions, loads twice, gear) [-]

    type(rubbing_t), allocatable :: rubbing(:)
    real(wp), allocatable :: of_loads(:, :)
    integer :: f

    of_loads = load_switches(linkage, pose, along, now)
    f = 0
    if (has_friction(linkage)) f = size(linkage%frictions)
    allocate (switches(2, f + size(of_loads, 2) + 1))
    switches = 0.0_wp
    if (f > 0) then
      call find_rubbing(linkage, pose, rubbing)
      switches(1, :f) = friction_rates(linkage, pose, rubbing, now)/linkage%frictions%smooth
    end if
    switches(:, f + 1:f + size(of_loads, 2)) = of_loads
    if (gear%efficiency < 1.0_wp) switches(1, size(switches, 2)) = rate/gear%smooth
  end function switches_at

end module motion_switches
