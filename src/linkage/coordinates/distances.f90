!> The distance of two terminals: l = |P₂ − P₁|.
module distances
  use coordinate_types, only: twist_t
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: find_distance, distance_acceleration

contains

  !> l, and the unit vector from the first to the second; zero where they meet.
  pure subroutine find_distance(place, value, axis)
    real(wp), intent(in) :: place(2, 2) !! (2, terminals) [m]
    real(wp), intent(out) :: value      !! [m]
    real(wp), intent(out) :: axis(2)

    axis = place(:, 2) - place(:, 1)
    value = norm2(axis)
    if (value > 0.0_wp) axis = axis/value
  end subroutine find_distance

  !> u·(a₂ − a₁) + (n·(v₂ − v₁))²/l: the axis turns by n·(v₂ − v₁)/l. 0 where they meet.
  pure function distance_acceleration(place, twist, slope) result(acceleration)
    real(wp), intent(in) :: place(2, 2) !! (2, terminals) [m]
    type(twist_t), intent(in) :: twist(2), slope(2) !! velocities; accelerations
    real(wp) :: acceleration

    real(wp) :: value, axis(2), velocity(2)

    call find_distance(place, value, axis)
    velocity = twist(2)%velocity - twist(1)%velocity
    acceleration = dot_product(axis, slope(2)%velocity - slope(1)%velocity)
    if (value > 0.0_wp) acceleration = acceleration + (axis(1)*velocity(2) - &
      axis(2)*velocity(1))**2/value
  end function distance_acceleration

end module distances
