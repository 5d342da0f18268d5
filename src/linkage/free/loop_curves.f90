!> All positions of a four-bar as one smooth curve in the space of its angles θ2, θ3, θ4: the points
!! where its loop is closed.
!!
!! Along the curve the crank's angle may turn back and the branch may change, while the curve goes
!! on. Only at change points, where all links lie in one line, is it not smooth: two branches cross,
!! and on request the curve is the one that goes straight through (`curve_crossings`).
module loop_curves
  use constants, only: pi, two_pi
  use curve_crossings, only: crossing_branch_t, crossing_branches, find_on_branch, place_on_branch
  use errors, only: error_of_dead_point, error_t, set_error
  use four_bar_loops, only: find_four_bar, four_bar_t
  use kinds, only: wp
  use linkages, only: cross, linkage_t, normal_to
  use poses, only: arm_to_middle, dead_point_sine, place_links, pose_t
  implicit none (type, external)
  private

  public :: loop_curve_t, curve_point_t, new_loop_curve, find_start, find_point, closure_error, &
    project, reduce, choose_branch, place_from_crossing
  public :: change_point_message

  !> Lengths that define the curve.
  type :: loop_curve_t
    type(four_bar_t) :: four_bar   !! whose curve it is
    real(wp) :: length(3) = 0.0_wp !! of crank, coupler, follower: r2, r3, r4 [m]
    real(wp) :: ground(2) = 0.0_wp !! O2 → O4 [m]
    !> Branches to follow through change points; none: the curve ends there.
    type(crossing_branch_t), allocatable :: branches(:)
    integer :: near = 0            !! number of the branch that is followed near a change point; 0:
                                   !! there is none near by
    real(wp) :: sense = 1.0_wp     !! −1: the curve is followed against v
  end type loop_curve_t

  !> A point of the curve, with direction and curvature of the curve there; s is the length of the
  !! curve [rad].
  type :: curve_point_t
    real(wp) :: direction(2, 3) = 0.0_wp  !! (2, links) unit vectors along O2 → A, A → B, O4 → B
    real(wp) :: tangent(3) = 0.0_wp       !! dθ/ds, a unit vector
    real(wp) :: tangent_slope(3) = 0.0_wp !! d²θ/ds² [1/rad]
    real(wp) :: sine = 0.0_wp             !! sin(θ4 − θ3): positive on the open branch; 0 where the
                                          !! crank turns back
  end type curve_point_t

  !> If the sines of all angles between the moving links are below this, the links are taken to lie
  !! in one line.
  real(wp), parameter :: change_point_sine = 1.0e-6_wp

  !> A branch is followed as such where no angle is farther from the change point than the first; it
  !! is left where one is beyond the second [rad].
  real(wp), parameter :: near_crossing = 0.2_wp, far_from_crossing = 0.3_wp

  character(len=*), parameter :: change_point_message = &
    "change point: all links lie in one line, and the linkage may go on either way"

contains

  !> The curve of a four-bar.
  pure function new_loop_curve(linkage, through) result(curve)
    type(linkage_t), intent(in) :: linkage !! a four-bar
    logical, intent(in), optional :: through !! it goes straight through change points
    type(loop_curve_t) :: curve

    type(four_bar_t), allocatable :: four_bar

    call find_four_bar(linkage, four_bar)
    curve%four_bar = four_bar
    curve%length = four_bar%length
    curve%ground = four_bar%ground(:, 2) - four_bar%ground(:, 1)
    allocate (curve%branches(0))
    if (.not. present(through)) return
    if (through) curve%branches = crossing_branches(curve%length, curve%ground)
  end function new_loop_curve

  !> Takes the branch that the linkage is on where it comes near a change point, and leaves it
  !! farther away. The tangent keeps its direction.
  pure subroutine choose_branch(curve, angle)
    type(loop_curve_t), intent(inout) :: curve !! its `near` and `sense` are set
    real(wp), intent(in) :: angle(3)           !! θ2, θ3, θ4 on the curve [rad]

    type(curve_point_t) :: before, after
    real(wp) :: change(3), place, on_branch(3), slope(3), bend(3), off, least
    integer :: i, nearest
    logical :: found, is_smooth

    if (size(curve%branches) == 0) return
    call find_point(curve, angle, before, is_smooth)
    if (.not. is_smooth) return
    if (curve%near > 0) then
      call place_on_branch(curve%branches(curve%near), angle, change, place)
      if (maxval(abs(change)) < far_from_crossing) return
      curve%near = 0
    else
      nearest = 0
      least = huge(1.0_wp)
      do i = 1, size(curve%branches)
        call place_on_branch(curve%branches(i), angle, change, place)
        if (maxval(abs(change)) > near_crossing) cycle
        call find_on_branch(curve%branches(i), place, on_branch, slope, bend, found)
        if (.not. found) cycle
        off = norm2(change - on_branch)
        if (off >= least) cycle
        least = off
        nearest = i
      end do
      if (nearest == 0) return
      curve%near = nearest
    end if
    call find_point(curve, angle, after, is_smooth)
    if (dot_product(before%tangent, after%tangent) < 0.0_wp) curve%sense = -curve%sense
  end subroutine choose_branch

  !> Where the linkage is along the branch through a change point, in the direction of the tangent;
  !! its zero is the change point.
  pure subroutine place_from_crossing(curve, angle, place, slope)
    type(loop_curve_t), intent(in) :: curve !! near a change point
    real(wp), intent(in) :: angle(3)        !! θ2, θ3, θ4 [rad]
    real(wp), intent(out) :: place          !! x [rad]
    real(wp), intent(out) :: slope(3)       !! ∂x/∂θ [-]

    real(wp) :: change(3)

    call place_on_branch(curve%branches(curve%near), angle, change, place)
    slope = curve%branches(curve%near)%tangent
  end subroutine place_from_crossing

  !> The angles θ2, θ3, θ4 at a crank angle, on the branch of the linkage, in (−π, π] [rad].
  !!
  !! Errors: those of `place_links`; a change point.
  pure subroutine find_start(linkage, crank_degrees, angle, error)
    type(linkage_t), intent(in) :: linkage           !! a four-bar
    real(wp), intent(in) :: crank_degrees            !! from the global x axis [deg]
    real(wp), intent(out) :: angle(3)                !! θ2, θ3, θ4 [rad]
    type(error_t), allocatable, intent(out) :: error !! why there is no position

    type(four_bar_t), allocatable :: four_bar
    type(pose_t) :: pose
    real(wp) :: e(2, 3)
    integer :: k

    angle = 0.0_wp
    call place_links(linkage, crank_degrees, pose, error)
    if (allocated(error)) return
    call find_four_bar(linkage, four_bar)
    associate (dyad => linkage%groups(four_bar%dyad))
      e(:, 1) = pose%direction(:, 1)
      do k = 2, 3
        e(:, k) = arm_to_middle(linkage, dyad, pose, findloc(dyad%body, four_bar%body(k), dim=1))
      end do
    end associate
    ! Adding zero turns -0 into 0: an angle of -π would be outside the interval.
    angle = atan2(e(2, :) + 0.0_wp, e(1, :) + 0.0_wp)
    if (max(abs(cross(e(:, 1), e(:, 2))), abs(cross(e(:, 1), e(:, 3))), &
      abs(cross(e(:, 2), e(:, 3)))) < change_point_sine) then
      call set_error(error, error_of_dead_point, change_point_message)
    else if (abs(pose%sine(four_bar%dyad)) < dead_point_sine) then
      ! The rounded crank angle of a limit position may be slightly out of reach.
      call project(new_loop_curve(linkage), angle)
    end if
  end subroutine find_start

  !> Direction and curvature of the curve at a point on it or near it.
  !!
  !! The tangent is `v/|v|` with `v = (r3 r4 sin(θ3 − θ4), r2 r4 sin(θ4 − θ2), r2 r3 sin(θ3 − θ2))`,
  !! which satisfies the velocity loop `r2 n2 v2 + r3 n3 v3 − r4 n4 v4 = 0`. With v' along the
  !! tangent τ, `τ' = (v' − τ (τ·v'))/|v|`. Near a change point that the curve goes through, where v
  !! turns over, both are those of the branch.
  pure subroutine find_point(curve, angle, point, is_smooth)
    type(loop_curve_t), intent(in) :: curve   !! lengths of the links
    real(wp), intent(in) :: angle(3)          !! θ2, θ3, θ4 [rad]
    type(curve_point_t), intent(out) :: point !! directions, tangent, curvature
    logical, intent(out) :: is_smooth         !! false: a change point; only the directions are then
                                              !! defined

    real(wp) :: sines(3), cosines(3), area(3), v(3), bend(3), size_of_v

    associate (r2 => curve%length(1), r3 => curve%length(2), r4 => curve%length(3), &
      e => point%direction)
      e(1, :) = cos(angle)
      e(2, :) = sin(angle)
      sines = [cross(e(:, 3), e(:, 2)), cross(e(:, 1), e(:, 3)), cross(e(:, 1), e(:, 2))]
      cosines = [dot_product(e(:, 3), e(:, 2)), dot_product(e(:, 1), e(:, 3)), &
        dot_product(e(:, 1), e(:, 2))]
      point%sine = -sines(1)
      if (curve%near > 0) then
        call find_point_on_branch(curve, angle, point, is_smooth)
        return
      end if
      is_smooth = maxval(abs(sines)) >= change_point_sine
      if (.not. is_smooth) return
      area = [r3*r4, r2*r4, r2*r3]
      v = area*sines
      size_of_v = norm2(v)
      associate (tangent => point%tangent)
        tangent = v/size_of_v
        bend = area*cosines*[tangent(2) - tangent(3), tangent(3) - tangent(1), &
          tangent(2) - tangent(1)]
        point%tangent_slope = (bend - tangent*dot_product(tangent, bend))/size_of_v
        tangent = curve%sense*tangent
      end associate
    end associate
  end subroutine find_point

  !> Tangent and curvature of the branch through a change point, at the place of a point near it.
  pure subroutine find_point_on_branch(curve, angle, point, found)
    type(loop_curve_t), intent(in) :: curve
    real(wp), intent(in) :: angle(3)
    type(curve_point_t), intent(inout) :: point !! gets them
    logical, intent(out) :: found               !! false: it is not near

    real(wp) :: change(3), place, on_branch(3), slope(3), bend(3)

    call place_on_branch(curve%branches(curve%near), angle, change, place)
    call find_on_branch(curve%branches(curve%near), place, on_branch, slope, bend, found)
    if (.not. found) return
    point%tangent = curve%sense*slope/norm2(slope)
    point%tangent_slope = (bend - point%tangent*dot_product(point%tangent, bend))/sum(slope**2)
  end subroutine find_point_on_branch

  !> Vector from B as placed by the follower to B as placed by crank and coupler [m].
  pure function gap_of(curve, direction) result(gap)
    type(loop_curve_t), intent(in) :: curve
    real(wp), intent(in) :: direction(2, 3)
    real(wp) :: gap(2)

    gap = matmul(direction, [curve%length(1:2), -curve%length(3)]) - curve%ground
  end function gap_of

  !> Gap of the loop, zero on the curve [m].
  pure function closure_error(curve, angle) result(distance)
    type(loop_curve_t), intent(in) :: curve !! lengths of the links
    real(wp), intent(in) :: angle(3)        !! θ2, θ3, θ4 [rad]
    real(wp) :: distance

    distance = norm2(gap_of(curve, reshape([cos(angle(1)), sin(angle(1)), cos(angle(2)), &
      sin(angle(2)), cos(angle(3)), sin(angle(3))], [2, 3])))
  end function closure_error

  !> Moves angles near the curve onto it by the smallest change: Newton's method,
  !! `Δθ = −Jᵀ (J Jᵀ)⁻¹ gap`. Near a change point, to the same place on the branch through it.
  pure subroutine project(curve, angle)
    type(loop_curve_t), intent(in) :: curve !! lengths of the links
    real(wp), intent(inout) :: angle(3)     !! θ2, θ3, θ4 away from change points [rad]

    ! Each iteration squares the error. As integration stays near the curve, two leave only
    ! rounding.
    integer, parameter :: turns = 2
    real(wp) :: direction(2, 3), jacobian(2, 3), gap(2), square(2, 2), multiplier(2)
    real(wp) :: change(3), place, on_branch(3), slope(3), bend(3)
    integer :: i, k
    logical :: found

    if (curve%near > 0) then
      call place_on_branch(curve%branches(curve%near), angle, change, place)
      call find_on_branch(curve%branches(curve%near), place, on_branch, slope, bend, found)
      if (found) angle = angle + (on_branch - change)
      return
    end if
    do i = 1, turns
      direction(1, :) = cos(angle)
      direction(2, :) = sin(angle)
      gap = gap_of(curve, direction)
      do k = 1, 3
        jacobian(:, k) = merge(-1.0_wp, 1.0_wp, k == 3)*curve%length(k)*normal_to(direction(:, k))
      end do
      square = matmul(jacobian, transpose(jacobian))
      multiplier = [square(2, 2)*gap(1) - square(1, 2)*gap(2), square(1, 1)*gap(2) - square(1, &
        2)*gap(1)]/(square(1, 1)*square(2, 2) - square(1, 2)**2)
      angle = angle - matmul(multiplier, jacobian)
    end do
  end subroutine project

  !> Takes whole turns off angles outside [−π, π] and counts them, so that no digits are lost
  !! however far a link turns.
  pure subroutine reduce(angle, turns)
    real(wp), intent(inout) :: angle(3) !! θ2, θ3, θ4 [rad]
    real(wp), intent(inout) :: turns(3) !! whole turns taken off so far

    real(wp) :: more(3)

    more = merge(anint(angle/two_pi), 0.0_wp, abs(angle) > pi)
    angle = angle - more*two_pi
    turns = turns + more
  end subroutine reduce

end module loop_curves
