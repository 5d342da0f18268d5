!> What counterweights about ground pivots add to the shaking force, the shaking moment and the
!! driving torque over a turn at constant speed: linear in their first moments and in their moments
!! of inertia about the pivots.
module counterweight_series
  use balanced_linkages, only: counterweight_t
  use errors, only: error_t
  use kinds, only: wp
  use kinematic_coefficients, only: find_kinematic_coefficients, kinematic_coefficients_t
  use linkages, only: cross, linkage_t, normal_to, reference_point, turned
  use pose_types, only: pins_of_body, place_of_pin
  use poses, only: find_moving_pose, pose_t
  implicit none (type, external)
  private

  public :: counterweight_on, unit_forces

contains

  !> A counterweight on a body about its only ground pivot, without mass yet.
  pure function counterweight_on(linkage, body) result(weight)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: body !! number, with one ground pivot
    type(counterweight_t) :: weight

    integer, allocatable :: pins(:)
    integer :: k

    pins = pins_of_body(linkage%bodies(body))
    k = findloc(linkage%is_ground(pins), .true., dim=1)
    weight%body = body
    weight%pin = pins(k)
    weight%towards = merge(pins(2), pins(1), k == 1)
  end function counterweight_on

  !> Shaking force, shaking moment and driving torque of counterweights at a crank angle, per first
  !! moment along the way from the pivot to the other pin, per first moment to its left, and per
  !! moment of inertia about the pivot, at ω2 = 1 and α2 = 0; zeros where there is no pose.
  !!
  !! With e along the way, n to its left, h and h' the derivatives of the angle of the link, and arm
  !! that of the pivot from the reference point, e has `F = h² e − h' n` and n `F = h² n + h' e`,
  !! with the moments `arm × F`; the moment of inertia has the moment `−h'` and the torque `h h'`.
  pure subroutine unit_forces(linkage, weights, crank, forces)
    type(linkage_t), intent(in) :: linkage          !! that turns fully
    type(counterweight_t), intent(in) :: weights(:) !! by `counterweight_on`
    real(wp), intent(in) :: crank                   !! [deg]
    real(wp), intent(out) :: forces(:, :, :)        !! (4, 3, weights) force, moment, torque [1/s²],
                                                    !! [m/s²] and [1/s²] per unit

    type(pose_t) :: pose
    type(error_t), allocatable :: error
    type(kinematic_coefficients_t) :: coefficients
    real(wp) :: e(2), n(2), way(2), arm(2), h, slope
    integer :: i

    forces = 0.0_wp
    call find_moving_pose(linkage, crank, pose, error)
    if (allocated(error)) return
    coefficients = find_kinematic_coefficients(linkage, pose)
    do i = 1, size(weights)
      associate (b => weights(i)%body, pin => weights(i)%pin)
        way = place_of_pin(linkage%bodies(b), weights(i)%towards) - &
          place_of_pin(linkage%bodies(b), pin)
        e = turned(way/norm2(way), pose%direction(:, b))
        n = normal_to(e)
        h = coefficients%turn(b)
        slope = coefficients%turn_slope(b)
        arm = linkage%ground_position(:, pin) - reference_point(linkage)
        forces(:2, 1, i) = h**2*e - slope*n
        forces(:2, 2, i) = h**2*n + slope*e
        forces(3, :, i) = [cross(arm, forces(:2, 1, i)), cross(arm, forces(:2, 2, i)), -slope]
        forces(4, 3, i) = h*slope
      end associate
    end do
  end subroutine unit_forces

end module counterweight_series
