!> Forces in the pins, driving torque, shaking force and moment.
module reactions_study
  use joint_forces, only: joint_forces_t
  use kinds, only: wp
  use linkages, only: linkage_t
  use load_cases, only: case_count
  use positions, only: positions_t
  use reactions, only: find_unit_reactions, unit_reactions_t
  use running_loads, only: depends_on_speed, find_running_loads, lock_of, lock_t, running_t
  implicit none (type, external)
  private

  public :: reactions_result_t, find_reactions, reactions_at_speed, reaction_values, pin_forces, &
    torque_value, shaking_values

  !> Places of the values of `reactions_at_speed`: up to `pin_forces` x and y of the force on every
  !! body at its first and at its last pin, then driving torque, shaking force and shaking moment.
  integer, parameter :: pin_forces = 12, torque_value = 13, shaking_values(3) = [14, 15, 16]
  integer, parameter :: reaction_values = 16

  !> Reactions to each of the three unit loads, of which those at any speed are composed: for ω2² =
  !! 1, for α2 = 1, and for the constant loads; and what loads that depend on the speed add to them.
  !! Zeros where there is no pose.
  type :: reactions_result_t
    real(wp), allocatable :: unit(:, :, :) !! (values, cases, states) [N, N m]
    real(wp), allocatable :: running(:, :, :) !! (values, speeds, states) added at each speed; no
                                              !! speeds: nothing is [N, N m]
    type(lock_t), allocatable :: lock(:, :)    !! (speeds, states) where friction locks the linkage
  end type reactions_result_t

contains

  !> Reactions at all positions, once for all speeds: Ulker 2010 (2.47) to (2.49).
  subroutine find_reactions(linkage, elements, positions, threads, found, speeds, accelerations)
    type(linkage_t), intent(in) :: linkage         !! a four-bar
    integer, intent(in) :: elements(:)             !! (bodies) on whose nodes the masses are lumped;
                                                   !! 0: distributed
    type(positions_t), intent(in) :: positions     !! of the run
    integer, intent(in) :: threads                 !! number of OpenMP threads
    type(reactions_result_t), intent(out) :: found !! for all positions and speeds
    real(wp), intent(in), optional :: speeds(:, :) !! (speeds, states) of the first drive, for loads
                                                   !! that depend on it [rad/s] or [m/s]; absent:
                                                   !! without these
    real(wp), intent(in), optional :: accelerations(:, :) !! (speeds, states) likewise, for friction
                                                   !! [rad/s²] or [m/s²]; absent: none

    type(unit_reactions_t) :: unit
    type(running_t) :: running
    real(wp) :: acceleration
    integer :: i, k, running_speeds

    running_speeds = 0
    if (present(speeds) .and. depends_on_speed(linkage)) running_speeds = size(speeds, 1)
    allocate (found%unit(reaction_values, case_count, size(positions%states)), &
      found%running(reaction_values, running_speeds, size(positions%states)), &
      found%lock(running_speeds, size(positions%states)))
    !$omp parallel do num_threads(threads) schedule(dynamic, 32) default(shared) &
    !$omp   private(i, k, acceleration, unit, running)
    do i = 1, size(positions%states)
      found%unit(:, :, i) = 0.0_wp
      found%running(:, :, i) = 0.0_wp
      associate (state => positions%states(i))
        if (allocated(state%error)) cycle
        call find_unit_reactions(linkage, elements, state%pose, state%coefficients, unit)
        found%unit(:, :, i) = as_values(unit)
        do k = 1, running_speeds
          acceleration = 0.0_wp
          if (present(accelerations)) acceleration = accelerations(k, i)
          call find_running_loads(linkage, state%pose, state%coefficients, speeds(k, i), &
            acceleration, unit, running)
          found%lock(k, i) = lock_of(running)
          if (found%lock(k, i)%friction > 0) cycle
          found%running(:torque_value, k, i) = pin_forces_of(running%joints)
        end do
      end associate
    end do
    !$omp end parallel do
  end subroutine find_reactions

  !> Unit reactions in the order of the values of `reactions_at_speed`.
  pure function as_values(reactions) result(unit)
    type(unit_reactions_t), intent(in) :: reactions
    real(wp) :: unit(reaction_values, case_count)

    integer :: i

    do i = 1, case_count
      associate (part => reactions%of_case(i))
        unit(:torque_value, i) = pin_forces_of(part%joints)
        unit(shaking_values, i) = [part%shaking_force, part%shaking_moment]
      end associate
    end do
  end function as_values

  !> Pin forces and driving torque in the order of the values.
  pure function pin_forces_of(joints) result(values)
    type(joint_forces_t), intent(in) :: joints !! of a four-bar
    real(wp) :: values(torque_value)

    integer :: b

    do b = 1, 3
      values(4*b - 3:4*b) = [joints%on_first(:, b), joints%on_last(:, b)]
    end do
    values(torque_value) = joints%torque
  end function pin_forces_of

  !> Reactions at a speed: ω2² and α2 times those of the unit loads, plus those of the constant
  !! loads and of what the speed adds [N, N m].
  pure function reactions_at_speed(found, state, speed, acceleration, number) result(values)
    type(reactions_result_t), intent(in) :: found !! for all positions
    integer, intent(in) :: state                  !! number; with a pose
    real(wp), intent(in) :: speed                 !! ω2 [rad/s]
    real(wp), intent(in) :: acceleration          !! α2 [rad/s²]
    integer, intent(in), optional :: number !! of the speed, for loads that depend on it; absent:
                                            !! without these
    real(wp) :: values(reaction_values)

    real(wp) :: factor(case_count)
    integer :: i

    factor = [speed**2, acceleration, 1.0_wp]
    values = 0.0_wp
    do i = 1, case_count
      values = values + factor(i)*found%unit(:, i, state)
    end do
    if (.not. present(number)) return
    if (size(found%running, 2) > 0) values = values + found%running(:, number, state)
  end function reactions_at_speed

end module reactions_study
