!> How the links move at a pose: kinematic coefficients, found once and good for every speed and
!! acceleration of the crank.
!!
!! With `h = dθ/dθ2` and `h' = d²θ/dθ2²` every angular velocity is `h ω2` and every angular
!! acceleration `h α2 + h' ω2²`; the same holds for points. Setting ω2 = 1 and α2 = 0 in (2.22),
!! (2.23), (2.35) and (2.36) of Ulker (2010) gives h and h'.
module kinematic_coefficients
  use kinds, only: wp
  use linkages, only: dyad_t, linkage_t, normal_to
  use poses, only: arm_to_middle, pose_t
  implicit none (type, external)
  private

  public :: motion_t, find_motion, angular_velocity, angular_acceleration
  public :: acceleration_field_t, unit_fields, scaled_sum, point_acceleration

  type :: motion_t
    real(wp), allocatable :: turn(:)          !! (bodies) h [-]
    real(wp), allocatable :: turn_slope(:)    !! (bodies) h' [-]
    real(wp), allocatable :: pin(:, :)        !! (2, pins) dx/dθ2 [m]
    real(wp), allocatable :: pin_slope(:, :)  !! (2, pins) d²x/dθ2² [m]
  end type motion_t

  !> Accelerations of all points: those of pins, and along every body `at_first + s slope`, s from
  !! its first pin.
  type :: acceleration_field_t
    real(wp), allocatable :: at_pin(:, :)   !! (2, pins) [m/s²]
    real(wp), allocatable :: at_first(:, :) !! (2, bodies) [m/s²]
    real(wp), allocatable :: slope(:, :)    !! (2, bodies) per length [1/s²]
    real(wp), allocatable :: angular(:)     !! (bodies) [rad/s²]
  end type acceleration_field_t

contains

  pure function find_motion(linkage, pose) result(motion)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose !! away from dead points
    type(motion_t) :: motion

    integer :: i

    allocate (motion%turn(size(linkage%bodies)), motion%turn_slope(size(linkage%bodies)))
    allocate (motion%pin(2, size(linkage%is_ground)), motion%pin_slope(2, size(linkage%is_ground)))
    motion%turn = 0.0_wp
    motion%turn_slope = 0.0_wp
    motion%pin = 0.0_wp
    motion%pin_slope = 0.0_wp
    motion%turn(1) = 1.0_wp
    associate (crank => linkage%bodies(1))
      motion%pin(:, crank%last_pin) = crank%length*normal_to(pose%direction(:, 1))
      motion%pin_slope(:, crank%last_pin) = -crank%length*pose%direction(:, 1)
    end associate
    do i = 1, size(linkage%dyads)
      call move_dyad(linkage, linkage%dyads(i), pose, pose%sine(i), motion)
    end do
  end function find_motion

  !> Closes the loop through a dyad once for velocities and once for accelerations.
  !!
  !! With `e` from base to middle and `n` its normal: `r3 h3 n3 − r4 h4 n4 = w`, where w is what the
  !! bases do. Since `n3·e4 = sin(θ4 − θ3)`, dotting with e4 and e3 separates the two (2.22, 2.23;
  !! with w' in place of w 2.37, 2.38).
  pure subroutine move_dyad(linkage, dyad, pose, sine, motion)
    type(linkage_t), intent(in) :: linkage
    type(dyad_t), intent(in) :: dyad
    type(pose_t), intent(in) :: pose
    real(wp), intent(in) :: sine
    type(motion_t), intent(inout) :: motion

    real(wp) :: r(2), e(2, 2), h(2), w(2)
    integer :: k

    do k = 1, 2
      r(k) = linkage%bodies(dyad%body(k))%length
      e(:, k) = arm_to_middle(linkage, dyad, pose, k)
    end do
    w = motion%pin(:, dyad%base(2)) - motion%pin(:, dyad%base(1))
    h = [dot_product(w, e(:, 2)), dot_product(w, e(:, 1))]/(r*sine)
    motion%turn(dyad%body) = h
    motion%pin(:, dyad%middle) = motion%pin(:, dyad%base(1)) + r(1)*h(1)*normal_to(e(:, 1))

    w = motion%pin_slope(:, dyad%base(2)) - motion%pin_slope(:, dyad%base(1)) + r(1)*h(1)**2*e(:, &
      1) - r(2)*h(2)**2*e(:, 2)
    motion%turn_slope(dyad%body) = [dot_product(w, e(:, 2)), dot_product(w, e(:, 1))]/(r*sine)
    motion%pin_slope(:, dyad%middle) = motion%pin_slope(:, dyad%base(1)) + &
      r(1)*(motion%turn_slope(dyad%body(1))*normal_to(e(:, 1)) - h(1)**2*e(:, 1))
  end subroutine move_dyad

  !> Angular velocities of all bodies [rad/s].
  pure function angular_velocity(motion, speed) result(velocity)
    type(motion_t), intent(in) :: motion
    real(wp), intent(in) :: speed !! ω2 [rad/s]
    real(wp) :: velocity(size(motion%turn))

    velocity = motion%turn*speed
  end function angular_velocity

  !> Angular accelerations of all bodies [rad/s²].
  pure function angular_acceleration(motion, speed, acceleration) result(angular)
    type(motion_t), intent(in) :: motion
    real(wp), intent(in) :: speed        !! ω2 [rad/s]
    real(wp), intent(in) :: acceleration !! α2 [rad/s²]
    real(wp) :: angular(size(motion%turn))

    angular = motion%turn*acceleration + motion%turn_slope*speed**2
  end function angular_acceleration

  !> The two fields of which every acceleration is made: for ω2² = 1, α2 = 0 and for ω2 = 0, α2 = 1.
  pure function unit_fields(linkage, pose, motion) result(fields)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(motion_t), intent(in) :: motion
    type(acceleration_field_t) :: fields(2)

    fields(1) = field_of(linkage, pose, motion%pin_slope, motion%turn_slope, motion%turn**2)
    fields(2) = field_of(linkage, pose, motion%pin, motion%turn, 0.0_wp*motion%turn)

  end function unit_fields

  !> (2.39) to (2.44) for all points: `a = a_first + s (α n − ω² e)`.
  pure function field_of(linkage, pose, at_pin, angular, squared_velocity) result(field)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    real(wp), intent(in) :: at_pin(:, :)        !! (2, pins) accelerations [m/s²]
    real(wp), intent(in) :: angular(:)          !! (bodies) α [rad/s²]
    real(wp), intent(in) :: squared_velocity(:) !! (bodies) ω² [rad²/s²]
    type(acceleration_field_t) :: field

    integer :: i

    field%at_pin = at_pin
    field%angular = angular
    field%at_first = at_pin(:, linkage%bodies%first_pin)
    allocate (field%slope(2, size(angular)))
    do i = 1, size(angular)
      field%slope(:, i) = angular(i)*normal_to(pose%direction(:, i)) - &
        squared_velocity(i)*pose%direction(:, i)
    end do
  end function field_of

  !> `ω2² fields(1) + α2 fields(2)`
  pure function scaled_sum(fields, speed, acceleration) result(total)
    type(acceleration_field_t), intent(in) :: fields(2)
    real(wp), intent(in) :: speed        !! ω2 [rad/s]
    real(wp), intent(in) :: acceleration !! α2 [rad/s²]
    type(acceleration_field_t) :: total

    total%at_pin = speed**2*fields(1)%at_pin + acceleration*fields(2)%at_pin
    total%at_first = speed**2*fields(1)%at_first + acceleration*fields(2)%at_first
    total%slope = speed**2*fields(1)%slope + acceleration*fields(2)%slope
    total%angular = speed**2*fields(1)%angular + acceleration*fields(2)%angular
  end function scaled_sum

  !> Acceleration of the point of a body at distance `s` from its first pin, `offset` to the left of
  !! it [m/s²].
  pure function point_acceleration(field, body, s, offset) result(acceleration)
    type(acceleration_field_t), intent(in) :: field
    integer, intent(in) :: body
    real(wp), intent(in) :: s                !! [m]
    real(wp), intent(in), optional :: offset !! [m]
    real(wp) :: acceleration(2)

    acceleration = field%at_first(:, body) + s*field%slope(:, body)
    ! What is across the link moves as what is along it, a quarter turn ahead.
    if (present(offset)) acceleration = acceleration + offset*normal_to(field%slope(:, body))
  end function point_acceleration

end module kinematic_coefficients
