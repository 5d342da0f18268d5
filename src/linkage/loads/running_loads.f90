!> Loads that depend on the speed of a running linkage otherwise than as its square: dampers,
!! resistances, loads that act in one direction of the motion, and friction in the joints.
module running_loads
  use actuated_forces, only: find_actuated_forces
  use applied_loads, only: add_moving_loads, evaluate_loads, generalised_force, has_moving_loads, &
    moving_pulls
  use coordinates, only: evaluated_t
  use ground_loads, only: pulls_on_ground
  use inertia_loads, only: load_t
  use joint_forces, only: add_scaled, joint_forces_t
  use joint_friction, only: find_friction, friction_on_ground, friction_t, has_friction, &
    is_locked
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkages, only: linkage_t
  use load_cases, only: case_count
  use poses, only: pose_t
  use reactions, only: unit_reactions_t
  implicit none (type, external)
  private

  public :: running_t, lock_t, divided_t, depends_on_speed, find_running_loads, lock_of, &
    velocities_at

  !> What the speed adds to the load cases.
  type :: running_t
    type(load_t), allocatable :: body_load(:)   !! (bodies) about their first pins
    real(wp), allocatable :: pin_load(:, :)     !! (2, pins) [N]
    type(joint_forces_t) :: joints              !! forces in the pins, and of the drives, that
                                                !! balance them
    real(wp) :: on_ground(3) = 0.0_wp           !! force of dampers and friction on the ground, and
                                                !! moment about `reference_point` [N, N m]
    real(wp) :: load = 0.0_wp                   !! minus their generalised force at the first drive
                                                !! [N m] or [N]
    type(friction_t) :: friction                !! in the joints; empty without
  end type running_t

  !> Forces in the joints of a linkage whose elasticity divides them.
  type :: divided_t
    type(joint_forces_t) :: moving                  !! that balance the loads but friction
    type(joint_forces_t), allocatable :: friction(:) !! (frictions) that balance an effort of one
  end type divided_t

  !> Where friction locks a linkage.
  type :: lock_t
    integer :: friction = 0      !! number of the friction that grows most; 0: nothing locks
    real(wp) :: share = 1.0_wp   !! of all coefficients at which forces grow beyond all bounds [-]
  end type lock_t

contains

  !> Whether friction locks the linkage: then there are no loads.
  pure function lock_of(running) result(lock)
    type(running_t), intent(in) :: running !! of `find_running_loads`
    type(lock_t) :: lock

    if (running%friction%state /= is_locked) return
    lock%friction = running%friction%locked
    lock%share = running%friction%share
  end function lock_of

  !> Whether a linkage has such loads.
  pure function depends_on_speed(linkage) result(depends)
    type(linkage_t), intent(in) :: linkage !! its loads
    logical :: depends

    depends = has_moving_loads(linkage) .or. has_friction(linkage)
  end function depends_on_speed

  !> These loads at a pose, speed and acceleration, and the forces that balance them. Friction
  !! depends on all forces in the joints, those of the load cases too.
  pure subroutine find_running_loads(linkage, pose, coefficients, speed, acceleration, unit, &
    running, divided)
    type(linkage_t), intent(in) :: linkage !! its loads
    type(pose_t), intent(in) :: pose       !! away from dead points
    type(kinematic_coefficients_t), intent(in) :: coefficients !! of this pose
    real(wp), intent(in) :: speed          !! of the first drive [rad/s] or [m/s]
    real(wp), intent(in) :: acceleration   !! of the first drive [rad/s²] or [m/s²]
    type(unit_reactions_t), intent(in) :: unit !! of this pose; without it forces in joints that do
                                           !! not rub are of no use, and `load` is right
    type(running_t), intent(out) :: running
    type(divided_t), intent(in), optional :: divided !! at this pose and speed; absent: statics
                                                     !! tells the forces in the joints

    type(kinematic_coefficients_t) :: now
    type(joint_forces_t) :: without(case_count + 1)
    type(evaluated_t), allocatable :: along(:)
    integer :: i

    allocate (running%body_load(size(linkage%bodies)), running%pin_load(2, &
      size(linkage%is_ground)))
    running%pin_load = 0.0_wp
    if (has_moving_loads(linkage)) then
      now = velocities_at(coefficients, speed)
      call evaluate_loads(linkage, pose, along)
      call add_moving_loads(linkage, pose, along, now, running%body_load, running%pin_load)
      running%on_ground = pulls_on_ground(linkage, pose, along, moving_pulls(linkage, pose, along, &
        now))
    end if
    if (present(divided)) then
      running%joints = divided%moving
    else
      running%joints = find_actuated_forces(linkage, pose, unit%factors, running%body_load, &
        running%pin_load)
    end if
    running%load = -generalised_force(linkage, coefficients, running%body_load, running%pin_load)
    if (.not. has_friction(linkage)) return
    do i = 1, case_count
      without(i) = unit%of_case(i)%joints
    end do
    without(case_count + 1) = running%joints
    if (present(divided)) then
      call find_friction(linkage, pose, coefficients, speed, [speed**2, acceleration, 1.0_wp, &
        1.0_wp], without, running%friction, divided%friction)
    else
      call find_friction(linkage, pose, coefficients, speed, [speed**2, acceleration, 1.0_wp, &
        1.0_wp], without, running%friction, factors=unit%factors)
    end if
    running%on_ground = running%on_ground + friction_on_ground(linkage, pose, running%friction)
    do i = 1, size(running%body_load)
      running%body_load(i)%force = running%body_load(i)%force + &
        running%friction%body_load(i)%force
      running%body_load(i)%moment = running%body_load(i)%moment + &
        running%friction%body_load(i)%moment
    end do
    running%pin_load = running%pin_load + running%friction%pin_load
    running%load = running%load + running%friction%load
    if (present(divided)) then
      call add_scaled(running%joints, 1.0_wp, running%friction%joints)
    else
      running%joints = find_actuated_forces(linkage, pose, unit%factors, running%body_load, &
        running%pin_load)
    end if
    running%joints%friction = running%friction%effort
  end subroutine find_running_loads

  !> Velocities at a speed of the first drive; no accelerations.
  pure function velocities_at(coefficients, speed) result(now)
    type(kinematic_coefficients_t), intent(in) :: coefficients !! of a pose
    real(wp), intent(in) :: speed          !! of the first drive [rad/s] or [m/s]
    type(kinematic_coefficients_t) :: now  !! without accelerations

    allocate (now%turn, source=speed*coefficients%turn)
    allocate (now%pin, source=speed*coefficients%pin)
    allocate (now%turn_slope, mold=coefficients%turn)
    allocate (now%pin_slope, mold=coefficients%pin)
    now%turn_slope = 0.0_wp
    now%pin_slope = 0.0_wp
  end function velocities_at

end module running_loads
