!> Pose and velocities of a four-bar at a point of its loop-closure curve.
module four_bar_poses
  use constants, only: degree
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkages, only: linkage_t, normal_to
  use loop_curves, only: curve_point_t
  use pose_types, only: arm_to_pin, pins_of_body, pose_t
  implicit none (type, external)
  private

  public :: find_curve_pose

contains

  !> Positions and directions at a point of the curve, and velocities per rate of its length s.
  pure subroutine find_curve_pose(linkage, point, crank, pose, per)
    type(linkage_t), intent(in) :: linkage    !! a four-bar
    type(curve_point_t), intent(in) :: point  !! its directions and tangent
    real(wp), intent(in) :: crank             !! angle of the crank, with all whole turns [rad]
    type(pose_t), intent(out) :: pose         !! without `sine`
    type(kinematic_coefficients_t), intent(out) :: per !! no accelerations

    integer, allocatable :: pins(:)
    integer :: numbers(3), bases(3), b, i, k
    logical :: starts_there

    allocate (pose%pin, source=linkage%ground_position)
    allocate (pose%direction(2, 3), per%turn(3), per%turn_slope(3))
    allocate (per%pin, per%pin_slope, mold=pose%pin)
    pose%crank = crank/degree
    per%pin = 0.0_wp
    per%pin_slope = 0.0_wp
    per%turn_slope = 0.0_wp
    associate (dyad => linkage%groups(1))
      numbers = [1, dyad%body]
      bases = [linkage%bodies(1)%first_pin, dyad%base]
    end associate
    ! The coupler hangs on the crank's end, the follower on its ground pivot.
    do i = 1, 3
      b = numbers(i)
      starts_there = linkage%bodies(b)%first_pin == bases(i)
      pose%direction(:, b) = merge(1.0_wp, -1.0_wp, starts_there)*point%direction(:, i)
      per%turn(b) = point%tangent(i)
      pins = pins_of_body(linkage%bodies(b))
      do k = 1, size(pins)
        if (pins(k) == bases(i)) cycle
        associate (arm => arm_to_pin(linkage, pose, b, pins(k)) - arm_to_pin(linkage, pose, b, &
            bases(i)))
          pose%pin(:, pins(k)) = pose%pin(:, bases(i)) + arm
          per%pin(:, pins(k)) = per%pin(:, bases(i)) + point%tangent(i)*normal_to(arm)
        end associate
      end do
    end do
  end subroutine find_curve_pose

end module four_bar_poses
