!> Values, rates and accelerations of coordinates.
!!
!! With kinematic coefficients in place of velocities and accelerations, rates and accelerations are
!! derivatives with respect to the coordinate of the first drive: s' and s''.
module coordinates
  use constants, only: degree
  use coordinate_types, only: coordinate_t, frame_t, is_across, is_along, is_angle, is_distance, &
    is_sum, terminal_t, twist_t
  use distances, only: distance_acceleration, distance_rate, distance_value
  use group_equations, only: drive_value
  use kinds, only: wp
  use lines, only: line_acceleration, line_rate, line_value
  use linkages, only: cross, linkage_t
  use pose_types, only: kinematic_coefficients_t, pose_t
  use terminals, only: terminal_acceleration, terminal_frame, terminal_twist
  implicit none (type, external)
  private

  public :: coordinate_value, coordinate_rate, coordinate_acceleration, slider_coordinate

contains

  !> Its value [m] or [rad].
  pure function coordinate_value(linkage, pose, coordinate) result(value)
    type(linkage_t), intent(in) :: linkage !! its bodies, and the terms of a sum
    type(pose_t), intent(in) :: pose       !! positions and directions
    type(coordinate_t), intent(in) :: coordinate
    real(wp) :: value

    integer :: i

    if (coordinate%kind /= is_sum) then
      value = simple_value(linkage, pose, coordinate)
      return
    end if
    value = 0.0_wp
    do i = 1, size(coordinate%term)
      value = value + coordinate%weight(i)*simple_value(linkage, pose, &
        linkage%coordinates(coordinate%term(i)))
    end do
  end function coordinate_value

  !> Its rate [m/s] or [rad/s].
  pure function coordinate_rate(linkage, pose, motion, coordinate) result(rate)
    type(linkage_t), intent(in) :: linkage !! as for `coordinate_value`
    type(pose_t), intent(in) :: pose       !! positions and directions
    type(kinematic_coefficients_t), intent(in) :: motion !! velocities of pins and bodies
    type(coordinate_t), intent(in) :: coordinate
    real(wp) :: rate

    integer :: i

    if (coordinate%kind /= is_sum) then
      rate = simple_rate(linkage, pose, motion, coordinate)
      return
    end if
    rate = 0.0_wp
    do i = 1, size(coordinate%term)
      rate = rate + coordinate%weight(i)*simple_rate(linkage, pose, motion, &
        linkage%coordinates(coordinate%term(i)))
    end do
  end function coordinate_rate

  !> Its acceleration [m/s²] or [rad/s²].
  pure function coordinate_acceleration(linkage, pose, motion, coordinate) result(acceleration)
    type(linkage_t), intent(in) :: linkage !! as for `coordinate_value`
    type(pose_t), intent(in) :: pose       !! positions and directions
    type(kinematic_coefficients_t), intent(in) :: motion !! velocities and accelerations
    type(coordinate_t), intent(in) :: coordinate
    real(wp) :: acceleration

    integer :: i

    if (coordinate%kind /= is_sum) then
      acceleration = simple_acceleration(linkage, pose, motion, coordinate)
      return
    end if
    acceleration = 0.0_wp
    do i = 1, size(coordinate%term)
      acceleration = acceleration + coordinate%weight(i)*simple_acceleration(linkage, pose, &
        motion, linkage%coordinates(coordinate%term(i)))
    end do
  end function coordinate_acceleration

  !> The place of the pin of a slider along its line.
  pure function slider_coordinate(linkage, number) result(coordinate)
    type(linkage_t), intent(in) :: linkage !! its sliders
    integer, intent(in) :: number          !! of the slider, from 1
    type(coordinate_t) :: coordinate

    coordinate%kind = is_along
    associate (slider => linkage%sliders(number))
      coordinate%at(1) = terminal_t(body=slider%body, place=slider%point, &
        direction=slider%direction)
      coordinate%at(2)%pin = slider%pin
    end associate
  end function slider_coordinate

  !> The value of one that is no sum.
  pure function simple_value(linkage, pose, coordinate) result(value)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(coordinate_t), intent(in) :: coordinate
    real(wp) :: value

    type(frame_t) :: frame(2)

    value = 0.0_wp
    if (coordinate%drive > 0) then
      value = drive_value(linkage%drives(coordinate%drive), pose%crank)
      if (coordinate%kind == is_angle) value = value*degree
      return
    end if
    frame = frames_of(linkage, pose, coordinate)
    select case (coordinate%kind)
    case (is_distance)
      value = distance_value(frame)
    case (is_along, is_across)
      value = line_value(frame, coordinate%kind == is_across)
    case (is_angle)
      ! Adding zero turns −0 into 0.
      value = atan2(cross(frame(1)%direction, frame(2)%direction) + 0.0_wp, &
        dot_product(frame(1)%direction, frame(2)%direction) + 0.0_wp)
    end select
  end function simple_value

  !> The rate of one that is no sum.
  pure function simple_rate(linkage, pose, motion, coordinate) result(rate)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(kinematic_coefficients_t), intent(in) :: motion
    type(coordinate_t), intent(in) :: coordinate
    real(wp) :: rate

    type(twist_t) :: twist(2)

    rate = 0.0_wp
    twist = twists_of(linkage, pose, motion, coordinate)
    select case (coordinate%kind)
    case (is_distance)
      rate = distance_rate(frames_of(linkage, pose, coordinate), twist)
    case (is_along, is_across)
      rate = line_rate(frames_of(linkage, pose, coordinate), twist, coordinate%kind == is_across)
    case (is_angle)
      rate = twist(2)%turn - twist(1)%turn
    end select
  end function simple_rate

  !> The acceleration of one that is no sum.
  pure function simple_acceleration(linkage, pose, motion, coordinate) result(acceleration)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(kinematic_coefficients_t), intent(in) :: motion
    type(coordinate_t), intent(in) :: coordinate
    real(wp) :: acceleration

    type(twist_t) :: twist(2), slope(2)
    integer :: k

    acceleration = 0.0_wp
    twist = twists_of(linkage, pose, motion, coordinate)
    do k = 1, 2
      slope(k) = terminal_acceleration(linkage, pose, motion, coordinate%at(k))
    end do
    select case (coordinate%kind)
    case (is_distance)
      acceleration = distance_acceleration(frames_of(linkage, pose, coordinate), twist, slope)
    case (is_along, is_across)
      acceleration = line_acceleration(frames_of(linkage, pose, coordinate), twist, slope, &
        coordinate%kind == is_across)
    case (is_angle)
      acceleration = slope(2)%turn - slope(1)%turn
    end select
  end function simple_acceleration

  pure function frames_of(linkage, pose, coordinate) result(frame)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(coordinate_t), intent(in) :: coordinate
    type(frame_t) :: frame(2)

    integer :: k

    do k = 1, 2
      frame(k) = terminal_frame(linkage, pose, coordinate%at(k))
    end do
  end function frames_of

  pure function twists_of(linkage, pose, motion, coordinate) result(twist)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(kinematic_coefficients_t), intent(in) :: motion
    type(coordinate_t), intent(in) :: coordinate
    type(twist_t) :: twist(2)

    integer :: k

    do k = 1, 2
      twist(k) = terminal_twist(linkage, pose, motion, coordinate%at(k))
    end do
  end function twists_of

end module coordinates
