!> How loads lie at a pose: the line between their places, its length or the angle between two
!! bodies, and the rates of these.
module load_coordinates
  use applied_load_types, only: applied_load_t, applies_along
  use constants, only: degree
  use coordinate_types, only: frame_t
  use distances, only: distance_axis, distance_rate, distance_value
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkages, only: linkage_t
  use pose_types, only: pose_t
  use poses, only: body_angle
  use terminals, only: terminal_frame, terminal_twist
  implicit none (type, external)
  private

  public :: load_axis, load_deflection, load_rate, counts_turns

contains

  !> By how much a spring is stretched [m], or turned: from −π to π, but on a crank with all whole
  !! turns [rad].
  pure function load_deflection(linkage, pose, load) result(stretch)
    type(linkage_t), intent(in) :: linkage   !! senses of its bodies
    type(pose_t), intent(in) :: pose         !! with the angle of the crank
    type(applied_load_t), intent(in) :: load !! along a line or between two bodies
    real(wp) :: stretch

    real(wp) :: angle

    if (load%kind == applies_along) then
      stretch = distance_value(ends_of(linkage, pose, load)) - load%rest
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
      rate = distance_rate(ends_of(linkage, pose, load), [terminal_twist(linkage, pose, now, &
        load%at(1)), terminal_twist(linkage, pose, now, load%at(2))])
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

    axis = distance_axis(ends_of(linkage, pose, load))
  end function load_axis

  pure function ends_of(linkage, pose, load) result(ends)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(applied_load_t), intent(in) :: load
    type(frame_t) :: ends(2)

    integer :: k

    do k = 1, 2
      ends(k) = terminal_frame(linkage, pose, load%at(k))
    end do
  end function ends_of

end module load_coordinates
