!> The distance of two terminals: l = |P₂ − P₁|.
module distances
  use coordinate_types, only: twist_t
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: distance_value, distance_axis, distance_rate, distance_acceleration

contains

  pure function distance_value(place) result(value)
    real(wp), intent(in) :: place(2, 2) !! (2, terminals) [m]
    real(wp) :: value !! [m]

    value = norm2(place(:, 2) - place(:, 1))
  end function distance_value

  !> Unit vector from the first to the second; zero where they meet.
  pure function distance_axis(place) result(axis)
    real(wp), intent(in) :: place(2, 2) !! (2, terminals) [m]
    real(wp) :: axis(2)

    axis = place(:, 2) - place(:, 1)
    if (norm2(axis) > 0.0_wp) axis = axis/norm2(axis)
  end function distance_axis

  !> u·(v₂ − v₁) with the axis u.
  pure function distance_rate(place, twist) result(rate)
    real(wp), intent(in) :: place(2, 2) !! (2, terminals) [m]
    type(twist_t), intent(in) :: twist(2)
    real(wp) :: rate

    rate = dot_product(distance_axis(place), twist(2)%velocity - twist(1)%velocity)
  end function distance_rate

  !> u·(a₂ − a₁) + (n·(v₂ − v₁))²/l: the axis turns by n·(v₂ − v₁)/l. 0 where they meet.
  pure function distance_acceleration(place, twist, slope) result(acceleration)
    real(wp), intent(in) :: place(2, 2) !! (2, terminals) [m]
    type(twist_t), intent(in) :: twist(2), slope(2) !! velocities; accelerations
    real(wp) :: acceleration

    real(wp) :: axis(2), velocity(2)

    axis = distance_axis(place)
    velocity = twist(2)%velocity - twist(1)%velocity
    acceleration = dot_product(axis, slope(2)%velocity - slope(1)%velocity)
    if (any(abs(axis) > 0.0_wp)) acceleration = acceleration + (axis(1)*velocity(2) - &
      axis(2)*velocity(1))**2/distance_value(place)
  end function distance_acceleration

end module distances
