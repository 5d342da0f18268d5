!> Pose and motion of a linkage of one loop, a four-bar, at a point of its loop-closure curve.
module loop_poses
  use constants, only: degree
  use four_bar_loops, only: find_four_bar, four_bar_t
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkages, only: linkage_t, normal_to, reference_point, turned
  use loop_curves, only: curve_point_t
  use pose_types, only: pose_t
  implicit none (type, external)
  private

  public :: has_loop, place_on_curve

contains

  !> Whether a linkage moves along the curve of a four-bar: nothing but pins is beside its links.
  pure function has_loop(linkage) result(has)
    type(linkage_t), intent(in) :: linkage !! with its groups
    logical :: has

    type(four_bar_t), allocatable :: four_bar

    call find_four_bar(linkage, four_bar)
    has = allocated(four_bar)
    if (has) has = size(linkage%bodies) == 3 .and. linkage%bodies(1)%last_pin == four_bar%pin(2)
  end function has_loop

  !> Positions and directions at a point of the curve, velocities per rate of its length s,
  !! velocities, and accelerations while this rate does not change.
  pure subroutine place_on_curve(linkage, four_bar, point, crank, rate, pose, per, now)
    type(linkage_t), intent(in) :: linkage    !! of which `has_loop` is true
    type(four_bar_t), intent(in) :: four_bar  !! that it is
    type(curve_point_t), intent(in) :: point  !! its directions, tangent and curvature
    real(wp), intent(in) :: crank             !! angle of the crank, with all whole turns [rad]
    real(wp), intent(in) :: rate              !! ṡ [rad/s]
    type(pose_t), intent(inout) :: pose       !! new, or at another point; without `sine`
    type(kinematic_coefficients_t), intent(inout) :: per !! likewise [-], [m]; its slopes are 0
    type(kinematic_coefficients_t), intent(inout) :: now !! likewise, per second

    integer, parameter :: from_pin(3) = [1, 2, 4], to_pin(3) = [2, 3, 3] !! O2 → A → B, O4 → B
    real(wp) :: turning(3)
    integer :: i, k

    if (.not. allocated(pose%pin)) call make_room(linkage, pose, per, now)
    pose%crank = crank/degree
    do i = 1, 3
      associate (b => four_bar%body(i), link => linkage%bodies(four_bar%body(i)), &
          from => four_bar%pin(from_pin(i)))
        pose%direction(:, b) = merge(1.0_wp, -1.0_wp, link%first_pin == from)*point%direction(:, i)
        turning = [point%tangent(i), point%tangent(i)*rate, point%tangent_slope(i)*rate**2]
        per%turn(b) = turning(1)
        now%turn(b) = turning(2)
        now%turn_slope(b) = turning(3)
        call place_pin(from, four_bar%pin(to_pin(i)), link%length*point%direction(:, i), turning, &
          pose, per, now)
        do k = 1, size(link%further)
          call place_pin(link%first_pin, link%further(k)%pin, turned(link%further(k)%place, &
            pose%direction(:, b)), turning, pose, per, now)
        end do
      end associate
    end do
  end subroutine place_on_curve

  !> Place and motion of another pin of a link.
  pure subroutine place_pin(from, to, arm, turning, pose, per, now)
    integer, intent(in) :: from        !! pin that is placed
    integer, intent(in) :: to          !! pin
    real(wp), intent(in) :: arm(2)     !! between them [m]
    real(wp), intent(in) :: turning(3) !! of the link: per rate, speed, acceleration
    type(pose_t), intent(inout) :: pose
    type(kinematic_coefficients_t), intent(inout) :: per, now

    real(wp) :: across(2)

    across = normal_to(arm)
    pose%pin(:, to) = pose%pin(:, from) + arm
    per%pin(:, to) = per%pin(:, from) + turning(1)*across
    now%pin(:, to) = now%pin(:, from) + turning(2)*across
    now%pin_slope(:, to) = now%pin_slope(:, from) + turning(3)*across - turning(2)**2*arm
  end subroutine place_pin

  !> Room for all, with the places of the ground, which do not move.
  pure subroutine make_room(linkage, pose, per, now)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(inout) :: pose
    type(kinematic_coefficients_t), intent(inout) :: per, now

    integer :: pins, i

    pins = size(linkage%is_ground)
    pose%origin = reference_point(linkage)
    allocate (pose%pin(2, pins), pose%direction(2, 3), per%turn(3), per%turn_slope(3), &
      per%pin(2, pins), per%pin_slope(2, pins), now%turn(3), now%turn_slope(3), now%pin(2, pins), &
      now%pin_slope(2, pins))
    do i = 1, pins
      pose%pin(:, i) = linkage%ground_position(:, i) - pose%origin
    end do
    per%turn_slope = 0.0_wp
    per%pin = 0.0_wp
    per%pin_slope = 0.0_wp
    now%pin = 0.0_wp
    now%pin_slope = 0.0_wp
  end subroutine make_room

end module loop_poses
