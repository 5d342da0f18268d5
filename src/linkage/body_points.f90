!> Points fixed to bodies: where they are, and how they move with the crank.
module body_points
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkages, only: linkage_t, normal_to
  use poses, only: arm_to_place, pose_t
  implicit none (type, external)
  private

  public :: point_coefficients_t, find_point_coefficients, point_velocity, point_total_acceleration

  !> A point with the velocity `x' ω2` and the acceleration `x' α2 + x'' ω2²`.
  type :: point_coefficients_t
    real(wp) :: place(2) = 0.0_wp  !! x, in global axes [m]
    real(wp) :: rate(2) = 0.0_wp   !! x' = dx/dθ2 [m]
    real(wp) :: slope(2) = 0.0_wp  !! x'' = d²x/dθ2² [m]
  end type point_coefficients_t

contains

  !> Place and kinematic coefficients of a point: Ulker 2010 (2.39) to (2.44) per ω2, ω2² and α2.
  !! With r from the first pin to the point and n the same vector turned by 90°,
  !! `x' = x_first' + h n` and `x'' = x_first'' + h' n − h² r`.
  pure function find_point_coefficients(linkage, pose, coefficients, body, place) result(point)
    type(linkage_t), intent(in) :: linkage !! first pins of its bodies
    type(pose_t), intent(in) :: pose       !! positions and directions
    type(kinematic_coefficients_t), intent(in) :: coefficients !! of this pose
    integer, intent(in) :: body            !! number, from 1
    real(wp), intent(in) :: place(2)       !! from the first pin of the body, in its axes [m]
    type(point_coefficients_t) :: point

    real(wp) :: arm(2)

    arm = arm_to_place(pose, body, place)
    associate (pin => linkage%bodies(body)%first_pin, h => coefficients%turn(body))
      point%place = pose%pin(:, pin) + arm
      point%rate = coefficients%pin(:, pin) + h*normal_to(arm)
      point%slope = coefficients%pin_slope(:, pin) + &
        coefficients%turn_slope(body)*normal_to(arm) - h**2*arm
    end associate
  end function find_point_coefficients

  !> Velocity of a point at a speed of the crank [m/s].
  pure function point_velocity(point, speed) result(velocity)
    type(point_coefficients_t), intent(in) :: point !! its place and coefficients
    real(wp), intent(in) :: speed !! ω2 [rad/s]
    real(wp) :: velocity(2)

    velocity = point%rate*speed
  end function point_velocity

  !> Acceleration of a point at a speed and an acceleration of the crank [m/s²].
  pure function point_total_acceleration(point, speed, acceleration) result(total)
    type(point_coefficients_t), intent(in) :: point !! its place and coefficients
    real(wp), intent(in) :: speed                   !! ω2 [rad/s]
    real(wp), intent(in) :: acceleration            !! α2 [rad/s²]
    real(wp) :: total(2)

    total = point%rate*acceleration + point%slope*speed**2
  end function point_total_acceleration

end module body_points
