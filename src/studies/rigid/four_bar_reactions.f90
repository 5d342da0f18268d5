!> Forces in the pins of a four-bar, its driving torque, shaking force and moment, in the order of
!! its tables.
module four_bar_reactions
  use four_bar_loops, only: four_bar_t
  use joint_study, only: joint_t, joints_at_speed, joints_result_t
  use kinds, only: wp
  use rounded_sums, only: rounded_sum_t, without_rounding
  implicit none (type, external)
  private

  public :: reactions_at_speed, pin_forces_of, reaction_values, pin_forces, torque_value

  !> Places of the values of `reactions_at_speed`: up to `pin_forces` x and y of the forces on
  !! link 2 at O2 and A, on link 3 at A and B, on link 4 at B and O4; then driving torque, shaking
  !! force and moment.
  integer, parameter :: pin_forces = 12, torque_value = 13, reaction_values = 16

contains

  !> Reactions at a speed, Ulker 2010 (2.47) to (2.49): under the unit loads times ω2² and α2, under
  !! the constant loads, and under loads that depend on the speed [N, N m].
  pure function reactions_at_speed(four_bar, found, state, speed, acceleration, number) &
    result(values)
    type(four_bar_t), intent(in) :: four_bar   !! that the linkage is
    type(joints_result_t), intent(in) :: found !! of this linkage, for all positions
    integer, intent(in) :: state               !! number; with a pose
    real(wp), intent(in) :: speed              !! ω2 [rad/s]
    real(wp), intent(in) :: acceleration       !! α2 [rad/s²]
    integer, intent(in) :: number              !! of the speed, for loads that depend on it
    real(wp) :: values(reaction_values)

    type(rounded_sum_t) :: sums(torque_value:reaction_values)
    real(wp) :: factor(3)
    integer :: k

    values(:pin_forces) = pin_forces_of(four_bar, found%joints, joints_at_speed(found, &
      state, speed, acceleration, number))
    factor = [speed**2, acceleration, 1.0_wp]
    do k = 1, 3
      call sums%add(factor(k)*[found%drive(1, k, state), found%shaking(:, k, state)])
    end do
    if (size(found%running_drive, 2) > 0) call sums(torque_value)%add(found%running_drive(1, &
      number, state))
    values(torque_value:) = without_rounding(sums)
  end function reactions_at_speed

  !> x and y of the forces in the pins of the loop, in the order of `reactions_at_speed` [N].
  pure function pin_forces_of(four_bar, joints, forces) result(values)
    type(four_bar_t), intent(in) :: four_bar !! that the linkage is
    type(joint_t), intent(in) :: joints(:)   !! of `list_joints`
    real(wp), intent(in) :: forces(:, :)     !! (3, joints) fx, fy, moment [N, N m]
    real(wp) :: values(pin_forces)

    integer :: b, i, k

    values = 0.0_wp
    do i = 1, size(joints)
      if (joints(i)%slider > 0) cycle
      b = findloc(four_bar%body, joints(i)%body, dim=1)
      if (b == 0) cycle
      do k = 0, 1
        if (joints(i)%pin == four_bar%pin(b + k)) values(4*b + 2*k - 3:4*b + 2*k - 2) = &
          forces(:2, i)
      end do
    end do
  end function pin_forces_of

end module four_bar_reactions
