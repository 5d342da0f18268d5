!> Where terminals are, and how they move.
module terminals
  use coordinate_types, only: frame_t, terminal_t, twist_t
  use kinds, only: wp
  use linkages, only: linkage_t, normal_to, turned
  use pose_types, only: kinematic_coefficients_t, pose_t
  implicit none (type, external)
  private

  public :: terminal_place, terminal_velocity, terminal_direction, terminal_acceleration, &
    frames_of, places_of, twists_of, is_fixed

contains

  !> Places and directions of two terminals.
  pure function frames_of(linkage, pose, at) result(frame)
    type(linkage_t), intent(in) :: linkage !! first pins of its bodies
    type(pose_t), intent(in) :: pose       !! positions and directions
    type(terminal_t), intent(in) :: at(2)
    type(frame_t) :: frame(2)

    integer :: k

    do k = 1, 2
      frame(k)%place = terminal_place(linkage, pose, at(k))
      frame(k)%direction = terminal_direction(pose, at(k))
    end do
  end function frames_of

  !> Direction of a terminal, unit vector in global axes.
  pure function terminal_direction(pose, at) result(direction)
    type(pose_t), intent(in) :: pose !! directions of the bodies
    type(terminal_t), intent(in) :: at
    real(wp) :: direction(2)

    direction = at%direction
    if (at%body > 0) direction = turned(at%direction, pose%direction(:, at%body))
  end function terminal_direction

  !> Where a terminal is, counted as the pins of the pose [m].
  pure function terminal_place(linkage, pose, at) result(place)
    type(linkage_t), intent(in) :: linkage !! first pins of its bodies
    type(pose_t), intent(in) :: pose       !! positions and directions
    type(terminal_t), intent(in) :: at
    real(wp) :: place(2)

    if (at%body > 0) then
      place = pose%pin(:, linkage%bodies(at%body)%first_pin) + turned(at%place, &
        pose%direction(:, at%body))
    else if (at%pin > 0) then
      place = pose%pin(:, at%pin) + at%place
    else
      place = at%place - pose%origin
    end if
  end function terminal_place

  !> How fast its place moves: with r from the first pin and n the same vector turned by 90°,
  !! x' = x_first' + h n.
  pure function terminal_velocity(linkage, pose, motion, at) result(velocity)
    type(linkage_t), intent(in) :: linkage !! first pins of its bodies
    type(pose_t), intent(in) :: pose       !! directions of its bodies
    type(kinematic_coefficients_t), intent(in) :: motion !! velocities of pins and bodies
    type(terminal_t), intent(in) :: at
    real(wp) :: velocity(2)

    velocity = 0.0_wp
    if (at%body > 0) then
      velocity = motion%pin(:, linkage%bodies(at%body)%first_pin) + motion%turn(at%body)* &
        normal_to(turned(at%place, pose%direction(:, at%body)))
    else if (at%pin > 0) then
      velocity = motion%pin(:, at%pin)
    end if
  end function terminal_velocity

  !> Places of two terminals, counted as the pins of the pose [m].
  pure function places_of(linkage, pose, at) result(place)
    type(linkage_t), intent(in) :: linkage !! first pins of its bodies
    type(pose_t), intent(in) :: pose       !! positions and directions
    type(terminal_t), intent(in) :: at(2)
    real(wp) :: place(2, 2)                !! (2, terminals)

    place(:, 1) = terminal_place(linkage, pose, at(1))
    place(:, 2) = terminal_place(linkage, pose, at(2))
  end function places_of

  !> Velocities of two terminals.
  pure function twists_of(linkage, pose, motion, at) result(twist)
    type(linkage_t), intent(in) :: linkage !! first pins of its bodies
    type(pose_t), intent(in) :: pose       !! directions of its bodies
    type(kinematic_coefficients_t), intent(in) :: motion !! velocities of pins and bodies
    type(terminal_t), intent(in) :: at(2)
    type(twist_t) :: twist(2)

    integer :: k

    do k = 1, 2
      twist(k)%velocity = terminal_velocity(linkage, pose, motion, at(k))
      twist(k)%turn = 0.0_wp
      if (at(k)%body > 0) twist(k)%turn = motion%turn(at(k)%body)
    end do
  end function twists_of

  !> Accelerations of a terminal: x'' = x_first'' + h' n − h² r; of rates alone −h² r.
  pure function terminal_acceleration(linkage, pose, motion, at, of_rates_alone) result(slope)
    type(linkage_t), intent(in) :: linkage !! first pins of its bodies
    type(pose_t), intent(in) :: pose       !! directions of its bodies
    type(kinematic_coefficients_t), intent(in) :: motion !! velocities and accelerations
    type(terminal_t), intent(in) :: at
    logical, intent(in), optional :: of_rates_alone
    type(twist_t) :: slope

    real(wp) :: arm(2)
    logical :: evenly

    evenly = .false.
    if (present(of_rates_alone)) evenly = of_rates_alone
    slope = twist_t(0.0_wp, 0.0_wp)
    if (at%body > 0) then
      arm = turned(at%place, pose%direction(:, at%body))
      if (evenly) then
        slope%velocity = -motion%turn(at%body)**2*arm
        return
      end if
      slope%turn = motion%turn_slope(at%body)
      slope%velocity = motion%pin_slope(:, linkage%bodies(at%body)%first_pin) + &
        slope%turn*normal_to(arm) - motion%turn(at%body)**2*arm
    else if (at%pin > 0 .and. .not. evenly) then
      slope%velocity = motion%pin_slope(:, at%pin)
    end if
  end function terminal_acceleration

  !> Whether a terminal is on the ground.
  pure function is_fixed(linkage, at) result(is)
    type(linkage_t), intent(in) :: linkage !! its ground pivots
    type(terminal_t), intent(in) :: at
    logical :: is

    is = at%body == 0
    if (is .and. at%pin > 0) is = linkage%is_ground(at%pin)
  end function is_fixed

end module terminals
