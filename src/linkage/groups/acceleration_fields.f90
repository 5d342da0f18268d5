!> Accelerations of all points of a linkage at a pose, from its kinematic coefficients.
module acceleration_fields
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkages, only: linkage_t, normal_to
  use poses, only: pose_t
  implicit none (type, external)
  private

  public :: acceleration_field_t, unit_fields, find_unit_field, scaled_sum, point_acceleration

  !> Accelerations of all points: of the pins, and along each body `at_first + s slope`, with s from
  !! its first pin. A unit field holds them per ω2² or per α2.
  type :: acceleration_field_t
    real(wp), allocatable :: at_pin(:, :)   !! (2, pins) [m/s²]
    real(wp), allocatable :: at_first(:, :) !! (2, bodies) at its first pin [m/s²]
    real(wp), allocatable :: slope(:, :)    !! (2, bodies) change per length [1/s²]
    real(wp), allocatable :: angular(:)     !! (bodies) [rad/s²]
  end type acceleration_field_t

contains

  !> The two fields that make up every acceleration: for ω2² = 1, α2 = 0 and for ω2 = 0, α2 = 1.
  pure function unit_fields(linkage, pose, coefficients) result(fields)
    type(linkage_t), intent(in) :: linkage !! first pins of its bodies
    type(pose_t), intent(in) :: pose       !! directions of the bodies
    type(kinematic_coefficients_t), intent(in) :: coefficients !! of this pose
    type(acceleration_field_t) :: fields(2)

    integer :: i

    do i = 1, 2
      call find_unit_field(linkage, pose, coefficients, i, fields(i))
    end do
  end function unit_fields

  !> One of the two unit fields: Ulker 2010 (2.39) to (2.44) for all points,
  !! `a = a_first + s (α n − ω² e)`.
  pure subroutine find_unit_field(linkage, pose, coefficients, number, field)
    type(linkage_t), intent(in) :: linkage                     !! first pins of its bodies
    type(pose_t), intent(in) :: pose                           !! directions of the bodies
    type(kinematic_coefficients_t), intent(in) :: coefficients !! of this pose
    integer, intent(in) :: number                              !! 1: ω2² = 1; 2: α2 = 1
    type(acceleration_field_t), intent(inout) :: field         !! its slope not yet allocated

    real(wp) :: squared_velocity
    integer :: i

    if (number == 1) then
      field%at_pin = coefficients%pin_slope
      field%angular = coefficients%turn_slope
    else
      field%at_pin = coefficients%pin
      field%angular = coefficients%turn
    end if
    field%at_first = field%at_pin(:, linkage%bodies%first_pin)
    allocate (field%slope(2, size(field%angular)))
    squared_velocity = 0.0_wp
    do i = 1, size(field%angular)
      if (number == 1) squared_velocity = coefficients%turn(i)**2
      field%slope(:, i) = field%angular(i)*normal_to(pose%direction(:, i)) - &
        squared_velocity*pose%direction(:, i)
    end do
  end subroutine find_unit_field

  !> The field at a speed and an acceleration of the crank: `ω2² fields(1) + α2 fields(2)`.
  pure function scaled_sum(fields, speed, acceleration) result(total)
    type(acceleration_field_t), intent(in) :: fields(2) !! of `unit_fields`
    real(wp), intent(in) :: speed        !! ω2 [rad/s]
    real(wp), intent(in) :: acceleration !! α2 [rad/s²]
    type(acceleration_field_t) :: total

    total%at_pin = speed**2*fields(1)%at_pin + acceleration*fields(2)%at_pin
    total%at_first = speed**2*fields(1)%at_first + acceleration*fields(2)%at_first
    total%slope = speed**2*fields(1)%slope + acceleration*fields(2)%slope
    total%angular = speed**2*fields(1)%angular + acceleration*fields(2)%angular
  end function scaled_sum

  !> Acceleration of the point of a body at distance `s` from its first pin, `offset` to the left of
  !! the link [m/s²].
  pure function point_acceleration(field, body, s, offset) result(acceleration)
    type(acceleration_field_t), intent(in) :: field !! of all points
    integer, intent(in) :: body                     !! number, from 1
    real(wp), intent(in) :: s                       !! [m]
    real(wp), intent(in), optional :: offset        !! [m]; absent: 0
    real(wp) :: acceleration(2)

    acceleration = field%at_first(:, body) + s*field%slope(:, body)
    ! An offset across the link accelerates like one along it, turned by 90°.
    if (present(offset)) acceleration = acceleration + offset*normal_to(field%slope(:, body))
  end function point_acceleration

end module acceleration_fields
