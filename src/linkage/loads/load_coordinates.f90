!> Where loads act and how they lie at a pose: the line between their places, its length or the
!! angle between two bodies, and the rates of these.
module load_coordinates
  use applied_load_types, only: applied_load_t, applies_along, load_place_t
  use body_points, only: find_point_coefficients, point_coefficients_t
  use constants, only: degree
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkages, only: linkage_t
  use pose_types, only: pose_t
  use poses, only: arm_to_place, body_angle
  implicit none (type, external)
  private

  public :: place_in, velocity_at, load_axis, load_deflection, load_rate, counts_turns

contains

  !> Where a load acts [m].
  pure function place_in(linkage, pose, at) result(place)
    type(linkage_t), intent(in) :: linkage !! first pins of its bodies
    type(pose_t), intent(in) :: pose       !! positions and directions
    type(load_place_t), intent(in) :: at   !! a pin, or a place of a body
    real(wp) :: place(2)

    if (at%pin > 0) then
      place = pose%pin(:, at%pin) + at%place
    else
      place = pose%pin(:, linkage%bodies(at%body)%first_pin) + arm_to_place(pose, at%body, at%place)
    end if
  end function place_in

  !> How fast that place moves [m/s].
  pure function velocity_at(linkage, pose, now, at) result(velocity)
    type(linkage_t), intent(in) :: linkage !! first pins of its bodies
    type(pose_t), intent(in) :: pose       !! directions of the bodies
    type(kinematic_coefficients_t), intent(in) :: now !! velocities [m/s], [rad/s]
    type(load_place_t), intent(in) :: at   !! a pin, or a place of a body
    real(wp) :: velocity(2)

    type(point_coefficients_t) :: point

    if (at%pin > 0) then
      velocity = now%pin(:, at%pin)
    else
      point = find_point_coefficients(linkage, pose, now, at%body, at%place)
      velocity = point%rate
    end if
  end function velocity_at

  !> By how much a spring is stretched [m], or turned: from −π to π, but on a crank with all whole
  !! turns [rad].
  pure function load_deflection(linkage, pose, load) result(stretch)
    type(linkage_t), intent(in) :: linkage   !! senses of its bodies
    type(pose_t), intent(in) :: pose         !! with the angle of the crank
    type(applied_load_t), intent(in) :: load !! along a line or between two bodies
    real(wp) :: stretch

    real(wp) :: angle

    if (load%kind == applies_along) then
      stretch = norm2(place_in(linkage, pose, load%at(2)) - place_in(linkage, pose, load%at(1))) - &
        load%rest
    else if (counts_turns(linkage, load)) then
      stretch = pose%crank*degree - load%rest
    else
      angle = body_angle(linkage, pose, load%body(2)) - load%rest
      if (load%body(1) > 0) angle = angle - body_angle(linkage, pose, load%body(1))
      stretch = atan2(sin(angle), cos(angle))
    end if
  end function load_deflection

  !> Whether a spring counts whole turns: from the ground to the crank.
  pure function counts_turns(linkage, load) result(counts)
    type(linkage_t), intent(in) :: linkage   !! whether its first body is a crank
    type(applied_load_t), intent(in) :: load !! between two bodies
    logical :: counts

    counts = linkage%has_crank .and. load%body(2) == 1 .and. load%body(1) == 0
  end function counts_turns

  !> Rate of the coordinate of a line or of two bodies [m/s] or [rad/s].
  pure function load_rate(linkage, pose, now, load) result(rate)
    type(linkage_t), intent(in) :: linkage   !! first pins of its bodies
    type(pose_t), intent(in) :: pose         !! positions and directions
    type(kinematic_coefficients_t), intent(in) :: now !! velocities [m/s], [rad/s]
    type(applied_load_t), intent(in) :: load !! along a line or between two bodies
    real(wp) :: rate

    if (load%kind == applies_along) then
      rate = dot_product(load_axis(linkage, pose, load), velocity_at(linkage, pose, now, &
        load%at(2)) - velocity_at(linkage, pose, now, load%at(1)))
    else
      rate = now%turn(load%body(2))
      if (load%body(1) > 0) rate = rate - now%turn(load%body(1))
    end if
  end function load_rate

  !> Unit vector along a line; zero where its ends meet.
  pure function load_axis(linkage, pose, load) result(axis)
    type(linkage_t), intent(in) :: linkage   !! first pins of its bodies
    type(pose_t), intent(in) :: pose         !! positions and directions
    type(applied_load_t), intent(in) :: load !! along a line
    real(wp) :: axis(2)

    axis = place_in(linkage, pose, load%at(2)) - place_in(linkage, pose, load%at(1))
    if (norm2(axis) > 0.0_wp) axis = axis/norm2(axis)
  end function load_axis

end module load_coordinates
