!> How fast joints of a linkage turn or slide.
module joint_rates
  use coordinates, only: coordinate_rate, slider_coordinate
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkages, only: linkage_t
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
      rate = coordinate_rate(linkage, pose, coefficients, slider_coordinate(linkage, slider))
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

end module joint_rates
