!> Forces in the pins of a four-bar made by hand, whose bodies and pins are in the order of the loop.
module pin_reactions
  use four_bar_loops, only: four_bar_t
  use four_bar_reactions, only: of_four_bar => reactions_at_speed, pin_forces, reaction_values, torque_value
  use joint_study, only: find_joints, reactions_result_t => joints_result_t
  use kinds, only: wp
  use linkages, only: linkage_t
  use positions, only: positions_t
  implicit none (type, external)
  private

  public :: reactions_result_t, find_reactions, reactions_at_speed, reaction_values, pin_forces, torque_value, shaking_values

  !> Places of shaking force and moment.
  integer, parameter :: shaking_values(3) = torque_value + [1, 2, 3]

contains

  subroutine find_reactions(linkage, elements, positions, threads, found)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: elements(:), threads
    type(positions_t), intent(in) :: positions
    type(reactions_result_t), intent(out) :: found

    call find_joints(linkage, elements, positions, threads, found)
  end subroutine find_reactions

  !> As of `four_bar_reactions`.
  function reactions_at_speed(found, state, speed, acceleration, number) result(values)
    type(reactions_result_t), intent(in) :: found
    integer, intent(in) :: state
    real(wp), intent(in) :: speed, acceleration
    integer, intent(in), optional :: number
    real(wp) :: values(reaction_values)

    integer :: speed_number

    speed_number = 1
    if (present(number)) speed_number = number
    values = of_four_bar(four_bar_t(body=[1, 2, 3], pin=[1, 2, 3, 4]), found, state, speed, acceleration, speed_number)
  end function reactions_at_speed

end module pin_reactions
