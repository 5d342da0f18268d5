!> Pose and motion of a linkage of one loop, a four-bar, at a point of its loop-closure curve.
module loop_poses
  use constants, only: degree
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkages, only: is_dyad_linkage, linkage_t, normal_to
  use loop_curves, only: curve_point_t
  use pose_types, only: pose_t
  implicit none (type, external)
  private

  public :: has_loop, loop_bodies, place_on_curve

contains

  !> Whether a linkage is a crank and a dyad on one more ground pivot, and nothing else.
  pure function has_loop(linkage) result(has)
    type(linkage_t), intent(in) :: linkage !! with its groups
    logical :: has

    integer :: b

    has = is_dyad_linkage(linkage) .and. size(linkage%groups) == 1 .and. size(linkage%bodies) == 3 &
      .and. size(linkage%turns) == 0 .and. size(linkage%redundancies) == 0
    if (.not. has) return
    do b = 1, 3
      has = has .and. size(linkage%bodies(b)%further) == 0
    end do
    associate (dyad => linkage%groups(1))
      has = has .and. dyad%base(1) == linkage%bodies(1)%last_pin .and. &
        linkage%is_ground(dyad%base(2)) .and. linkage%drives(1)%against == 0
    end associate
  end function has_loop

  !> Numbers of crank, coupler and follower.
  pure function loop_bodies(linkage) result(bodies)
    type(linkage_t), intent(in) :: linkage !! of which `has_loop` is true
    integer :: bodies(3)

    bodies = [1, linkage%groups(1)%body]
  end function loop_bodies

  !> Positions and directions at a point of the curve, velocities per rate of its length s,
  !! velocities, and accelerations while this rate does not change.
  pure subroutine place_on_curve(linkage, origin, point, crank, rate, pose, per, now)
    type(linkage_t), intent(in) :: linkage    !! of which `has_loop` is true
    real(wp), intent(in) :: origin(2)         !! from which pins are counted [m]
    type(curve_point_t), intent(in) :: point  !! its directions, tangent and curvature
    real(wp), intent(in) :: crank             !! angle of the crank, with all whole turns [rad]
    real(wp), intent(in) :: rate              !! ṡ [rad/s]
    type(pose_t), intent(inout) :: pose       !! new, or at another point; without `sine`
    type(kinematic_coefficients_t), intent(inout) :: per !! likewise [-], [m]; its slopes are 0
    type(kinematic_coefficients_t), intent(inout) :: now !! likewise, per second

    real(wp) :: arm(2), across(2), speed, acceleration
    integer :: body(3), base(3), tip(3), i

    if (.not. allocated(pose%pin)) call make_room(linkage, origin, pose, per, now)
    pose%crank = crank/degree
    associate (dyad => linkage%groups(1), first => linkage%bodies(1))
      body = [1, dyad%body]
      base = [first%first_pin, dyad%base]
      tip = [first%last_pin, dyad%middle, dyad%middle]
    end associate
    ! The coupler hangs on the crank's end, the follower on its ground pivot.
    do i = 1, 3
      associate (b => body(i), link => linkage%bodies(body(i)), from => base(i), to => tip(i))
        pose%direction(:, b) = merge(1.0_wp, -1.0_wp, link%first_pin == from)*point%direction(:, i)
        arm = link%length*point%direction(:, i)
        across = normal_to(arm)
        speed = point%tangent(i)*rate
        acceleration = point%tangent_slope(i)*rate**2
        per%turn(b) = point%tangent(i)
        now%turn(b) = speed
        now%turn_slope(b) = acceleration
        pose%pin(:, to) = pose%pin(:, from) + arm
        per%pin(:, to) = per%pin(:, from) + point%tangent(i)*across
        now%pin(:, to) = now%pin(:, from) + speed*across
        now%pin_slope(:, to) = now%pin_slope(:, from) + acceleration*across - speed**2*arm
      end associate
    end do
  end subroutine place_on_curve

  !> Room for all, with the places of the ground, which do not move.
  pure subroutine make_room(linkage, origin, pose, per, now)
    type(linkage_t), intent(in) :: linkage
    real(wp), intent(in) :: origin(2)
    type(pose_t), intent(inout) :: pose
    type(kinematic_coefficients_t), intent(inout) :: per, now

    integer :: pins, i

    pins = size(linkage%is_ground)
    allocate (pose%pin(2, pins), pose%direction(2, 3), per%turn(3), per%turn_slope(3), &
      per%pin(2, pins), per%pin_slope(2, pins), now%turn(3), now%turn_slope(3), now%pin(2, pins), &
      now%pin_slope(2, pins))
    do i = 1, pins
      pose%pin(:, i) = linkage%ground_position(:, i) - origin
    end do
    per%turn_slope = 0.0_wp
    per%pin = 0.0_wp
    per%pin_slope = 0.0_wp
    now%pin = 0.0_wp
    now%pin_slope = 0.0_wp
  end subroutine make_room

end module loop_poses
