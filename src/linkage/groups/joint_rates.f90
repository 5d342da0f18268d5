!> How fast joints of a linkage turn or slide.
module joint_rates
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkages, only: linkage_t, normal_to, turned
  use pose_types, only: pins_of_body, pose_t
  implicit none (type, external)
  private

  public :: joint_rate

contains

  !> Rate of a body at a pin against the other part there, per rate of the first drive: against
  !! the ground at a ground pivot; against the block of a slider, if there is one; against the other
  !! body; of more than two, against the first one, and the first against the second; of a body that
  !! is alone there, its own. Of a slider, the rate of its pin along the line.
  pure function joint_rate(linkage, pose, coefficients, pin, body, slider) result(rate)
    type(linkage_t), intent(in) :: linkage !! its bodies and sliders
    type(pose_t), intent(in) :: pose       !! positions and directions
    type(kinematic_coefficients_t), intent(in) :: coefficients !! of this pose
    integer, intent(in) :: pin             !! number
    integer, intent(in) :: body            !! that turns; not used of a slider
    integer, intent(in) :: slider          !! whose rate is meant; 0: that of the body
    real(wp) :: rate                       !! [-] or [m], or, with a drive by length, [1/m] or [-]

    integer :: i

    if (slider > 0) then
      rate = slider_rate(linkage, pose, coefficients, slider)
      return
    end if
    rate = coefficients%turn(body)
    if (linkage%is_ground(pin)) return
    do i = 1, size(linkage%sliders)
      if (linkage%sliders(i)%pin /= pin) cycle
      if (linkage%sliders(i)%body > 0) rate = rate - coefficients%turn(linkage%sliders(i)%body)
      return
    end do
    do i = 1, size(linkage%bodies)
      if (i == body .or. .not. any(pins_of_body(linkage%bodies(i)) == pin)) cycle
      rate = rate - coefficients%turn(i)
      return
    end do
  end function joint_rate

  !> Rate of the pin of a slider along its line.
  pure function slider_rate(linkage, pose, coefficients, number) result(rate)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(kinematic_coefficients_t), intent(in) :: coefficients
    integer, intent(in) :: number !! of the slider
    real(wp) :: rate

    integer :: first

    associate (slider => linkage%sliders(number))
      if (slider%body == 0) then
        rate = dot_product(slider%direction, coefficients%pin(:, slider%pin))
        return
      end if
      first = linkage%bodies(slider%body)%first_pin
      rate = dot_product(turned(slider%direction, pose%direction(:, slider%body)), &
        coefficients%pin(:, slider%pin) - coefficients%pin(:, first) - &
        coefficients%turn(slider%body)*normal_to(pose%pin(:, slider%pin) - pose%pin(:, first)))
    end associate
  end function slider_rate

end module joint_rates
