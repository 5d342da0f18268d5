!> Positions of the links at a crank angle.
module poses
  use block_ends, only: refuse_leaving_block
  use bridges, only: bridge_at, cross_bridge, place_on_path
  use dyad_places, only: place_dyad
  use errors, only: error_of_dead_point, error_of_numerics, error_of_reach, error_t, set_error
  use drive_values, only: drive_direction
  use group_places, only: improve_group, place_group
  use kinds, only: wp
  use linkages, only: bridge_t, group_t, group_by_newton, group_dyad, is_dyad_linkage, &
    linkage_t, normal_to, path_t, reference_point, turned
  use pose_types, only: count_from, pose_t
  use redundancies, only: refuse_misfit
  use text, only: to_string
  implicit none (type, external)
  private

  public :: pose_t, find_pose, find_moving_pose, refuse_change_point, place_links, place_pins, &
    place_groups, arm_to_middle, arm_to_place, body_angle, angle_along, transmission_angle, &
    dead_point_sine

  !> Where the scaled determinant of a group, of a dyad the sine of the angle between its bodies, is
  !! below this, it is at a dead point: velocities grow like its inverse.
  real(wp), parameter :: dead_point_sine = 1.0e-6_wp

  !> In time, corrections below this share of the longest link are rounding of one that stands
  !! still.
  real(wp), parameter, public :: still = 1.0e-9_wp

contains

  !> Places every pin for a crank angle at which the crank can move the links, and all forces in the
  !! joints are determined.
  !!
  !! Errors: those of `find_moving_pose`; a change point.
  pure subroutine find_pose(linkage, crank, pose, error)
    type(linkage_t), intent(in) :: linkage           !! bodies, groups and what joins them
    real(wp), intent(in) :: crank                    !! coordinate of the first drive [deg] or [m]
    type(pose_t), intent(out) :: pose                !! incomplete if out of reach
    type(error_t), allocatable, intent(out) :: error !! why the links cannot be moved, or solved for

    call find_moving_pose(linkage, crank, pose, error)
    if (.not. allocated(error)) call refuse_change_point(pose, error)
  end subroutine find_pose

  !> An error at a change point: the linkage moves on smoothly, but rigid links do not determine the
  !! forces in its joints.
  pure subroutine refuse_change_point(pose, error)
    type(pose_t), intent(in) :: pose !! of all groups
    type(error_t), allocatable, intent(inout) :: error

    if (any(abs(pose%sine) < dead_point_sine)) call set_error(error, error_of_dead_point, &
      "change point: the linkage moves on smoothly, but the forces in its joints are not "// &
      "determined")
  end subroutine refuse_change_point

  !> Places every pin for a crank angle at which the crank can move the links, change points too.
  !!
  !! Errors: those of `place_links`; a dead point (`|sin(θ4 − θ3)|`, or what it is of another group,
  !! below 1e-6).
  pure subroutine find_moving_pose(linkage, crank, pose, error)
    type(linkage_t), intent(in) :: linkage           !! bodies, groups and what joins them
    real(wp), intent(in) :: crank                    !! angle of the driven body from the global x
                                                     !! axis [deg], or coordinate of the first
                                                     !! drive [m]
    type(pose_t), intent(out) :: pose                !! incomplete if out of reach
    type(error_t), allocatable, intent(out) :: error !! why the links cannot be moved

    integer :: i

    call place_links(linkage, crank, pose, error)
    if (allocated(error)) return
    if (allocated(pose%coefficients)) return
    do i = 1, size(pose%sine)
      if (abs(pose%sine(i)) >= dead_point_sine) cycle
      if (is_dyad_linkage(linkage) .and. size(linkage%groups) == 1) then
        call set_error(error, error_of_dead_point, "dead point: |sin(theta4 - theta3)| = "// &
          to_string(abs(pose%sine(i)), 3)//" is below "//to_string(dead_point_sine))
      else
        call set_error(error, error_of_dead_point, "dead point: the scaled determinant "// &
          to_string(abs(pose%sine(i)), 3)//" is below "//to_string(dead_point_sine), &
          body=a_body_of(linkage%groups(i)))
      end if
      return
    end do
  end subroutine find_moving_pose

  !> The first body of a group; 0 if it has none.
  pure function a_body_of(group) result(body)
    type(group_t), intent(in) :: group
    integer :: body

    body = group%body(1)
    if (allocated(group%bodies)) then
      if (size(group%bodies) > 0) body = group%bodies(1)
    end if
  end function a_body_of

  !> Places every pin for a crank angle, including dead points: Ulker 2010 (2.1), solved by
  !! intersecting circles, and other groups of bodies.
  !!
  !! Errors: the position is out of reach; the two bases of a dyad coincide, which leaves its
  !! direction undetermined; iterations that do not converge; redundant links that do not fit; a
  !! block beyond the ends of its link.
  pure subroutine place_links(linkage, crank, pose, error)
    type(linkage_t), intent(in) :: linkage           !! bodies, groups and what joins them
    real(wp), intent(in) :: crank                    !! angle of the driven body from the global x
                                                     !! axis [deg], or coordinate of the first
                                                     !! drive [m]
    type(pose_t), intent(out) :: pose                !! incomplete after an error
    type(error_t), allocatable, intent(out) :: error !! why there is no pose

    call place_pins(linkage, crank, pose, error)
    if (allocated(error)) return
    call refuse_misfit(linkage, pose, crank, error)
    if (.not. allocated(error)) call refuse_leaving_block(linkage, pose, error)
    call count_from([0.0_wp, 0.0_wp], pose)
  end subroutine place_links

  !> Places every pin relative to `reference_point`, whether redundant links fit there or not.
  !!
  !! Errors: those of `place_links` but for redundant links.
  pure subroutine place_pins(linkage, crank, pose, error)
    type(linkage_t), intent(in) :: linkage           !! bodies, groups and what joins them
    real(wp), intent(in) :: crank                    !! coordinate of the first drive [deg] or [m]
    type(pose_t), intent(out) :: pose                !! incomplete after an error
    type(error_t), allocatable, intent(out) :: error !! why there is no pose

    real(wp) :: at, correction, allowed
    real(wp), allocatable :: side(:)
    integer :: bridge, k

    if (.not. allocated(linkage%path%crank)) then
      call place_groups(linkage, crank, pose, correction, error)
      return
    end if
    associate (path => linkage%path)
      at = place_on_path(path, crank)
      bridge = bridge_at(path, at)
      if (bridge > 0) then
        call cross_bridge(linkage, path%bridges(bridge), at, pose)
        pose%crank = crank
        return
      end if
      do k = 1, 2
        if (.not. allocated(path%limits(k)%crank)) cycle
        associate (limit => path%limits(k))
          if (at < limit%from - slack(path) .or. at > limit%to + slack(path)) cycle
          call cross_bridge(linkage, limit, min(max(at, limit%from), limit%to), pose)
          pose%crank = crank
          if (at < limit%from .or. at > limit%to) then
            pose%sine(limit%group) = 0.0_wp
          else
            call improve_near_limit(linkage, limit, pose)
          end if
        end associate
        if (any(abs(pose%sine) < dead_point_sine) .and. allocated(pose%coefficients)) &
          deallocate (pose%coefficients)
        return
      end do
      call start_on_path(path, at, pose, side, allowed, error)
    end associate
    if (allocated(error)) then
      if (linkage%path%stops .or. any(linkage%groups%kind == group_by_newton)) then
        k = linkage%path%limits(merge(1, 2, at < linkage%path%crank(1)))%group
        if (k > 0) error%place%body = a_body_of(linkage%groups(k))
        return
      end if
      if (any(linkage%path%is_lost)) then
        call set_error(error, error_of_numerics, "the linkage has not been followed as far as "// &
          "here: beyond a change point it may go on in several ways; expected "// &
          "change_points=branch on the first DRIVE")
        return
      end if
      ! Another range: dyads close there without a way from the drawing.
      deallocate (error)
      call place_groups(linkage, crank, pose, correction, error)
      return
    end if
    call place_groups(linkage, crank, pose, correction, error, side)
    if (allocated(error)) return
    ! In time the linkage may stand still between two stations.
    if (linkage%runs_in_time) allowed = allowed + still*maxval(linkage%bodies%length)
    if (correction > allowed) call set_error(error, error_of_numerics, &
      "the position was not found by iterations: they left the path")
  end subroutine place_pins

  !> Solves for a pose that polynomials gave, where that loses fewer digits than they do.
  pure subroutine improve_near_limit(linkage, limit, pose)
    type(linkage_t), intent(in) :: linkage !! with groups
    type(bridge_t), intent(in) :: limit    !! by whose polynomials
    type(pose_t), intent(inout) :: pose    !! pins from `reference_point`

    !> Rounding of polynomials; what is this near is the same assembly, as a share of the
    !! determinant: the other one is twice as far as a determinant of 1 is.
    real(wp), parameter :: rounding = 1.0e-12_wp, near = 0.1_wp
    type(pose_t) :: solved
    type(error_t), allocatable :: error
    real(wp) :: correction

    associate (sine => abs(pose%sine(limit%group)), usual => linkage%groups(limit%group)%usual)
      if (sine*usual*max(limit%error, rounding) <= epsilon(1.0_wp)) return
      solved = pose
      deallocate (solved%coefficients)
      call place_groups(linkage, pose%crank, solved, correction, error, sign(1.0_wp, pose%sine))
      if (allocated(error)) return
      if (maxval(abs(solved%pin - pose%pin)) > near*sine*maxval(linkage%bodies%length)) return
    end associate
    pose = solved
  end subroutine improve_near_limit

  !> Places the crank, and group after group. Positions are relative to `reference_point`, so that a
  !! far-off origin of the drawing costs no digits.
  !!
  !! Errors: those of `place_links`.
  pure subroutine place_groups(linkage, crank, pose, correction, error, side)
    type(linkage_t), intent(in) :: linkage  !! bodies, groups and what joins them
    real(wp), intent(in) :: crank           !! coordinate of the first drive [deg] or [m]
    type(pose_t), intent(inout) :: pose     !! near by, for groups that iterations place; without
                                            !! such groups it may be empty. The pose
    real(wp), intent(out) :: correction     !! largest of iterations [m]
    type(error_t), allocatable, intent(inout) :: error !! why there is no pose
    real(wp), intent(in), optional :: side(:) !! (groups) in place of their own

    real(wp) :: largest, its_side
    integer :: i, iterations

    pose%origin = reference_point(linkage)
    correction = 0.0_wp
    pose%crank = crank
    if (.not. allocated(pose%pin)) then
      allocate (pose%pin(2, size(linkage%is_ground)), pose%direction(2, size(linkage%bodies)))
      pose%pin = 0.0_wp
      pose%direction = 0.0_wp
    end if
    if (.not. allocated(pose%sine)) allocate (pose%sine(size(linkage%groups)))
    do i = 1, size(linkage%is_ground)
      if (linkage%is_ground(i)) pose%pin(:, i) = linkage%ground_position(:, i) - pose%origin
    end do
    pose%sine = 0.0_wp
    if (linkage%has_crank) then
      pose%direction(:, 1) = drive_direction(linkage, 1, pose, crank)
      pose%pin(:, linkage%bodies(1)%last_pin) = linkage%bodies(1)%length*pose%direction(:, 1)
    end if
    do i = 1, size(linkage%groups)
      associate (group => linkage%groups(i))
        its_side = group%side
        if (present(side)) its_side = side(i)
        if (group%kind == group_dyad) then
          call place_dyad(linkage, group, linkage%bodies(group%body)%length, its_side, pose, &
            pose%sine(i), error)
        else if (group%kind == group_by_newton) then
          call improve_group(linkage, group, crank, pose, pose%sine(i), largest, &
            iterations, error)
          correction = max(correction, largest)
        else
          call place_group(linkage, group, its_side, crank, pose, pose%sine(i), error)
        end if
      end associate
      if (allocated(error)) return
    end do
  end subroutine place_groups

  !> A start for iterations, between two stations of the path: cubic polynomials with the positions
  !! and the rates there.
  !!
  !! Errors: the position lies beyond the ends of the path.
  pure subroutine start_on_path(path, c, pose, side, allowed, error)
    type(path_t), intent(in) :: path    !! with stations
    real(wp), intent(in) :: c           !! coordinate of the first drive, without whole periods
                                        !! [deg] or [m]
    type(pose_t), intent(out) :: pose   !! relative to the reference point
    real(wp), allocatable, intent(out) :: side(:) !! (groups) as `side` of `group_t`
    real(wp), intent(out) :: allowed    !! correction: a quarter of the way between the stations [m]
    type(error_t), allocatable, intent(inout) :: error !! out of reach

    real(wp) :: t, h, weight(2), slope_weight(2)
    integer :: k, b, last

    last = size(path%crank)
    allowed = 0.0_wp
    if (c < path%crank(1) - slack(path) .or. c > path%crank(last) + slack(path)) then
      call set_error(error, error_of_reach, "the position is out of reach")
      return
    end if
    k = station_before(path%crank, c)
    side = path%side(:, k)
    h = path%crank(k + 1) - path%crank(k)
    t = (c - path%crank(k))/h
    weight = [(1.0_wp + 2.0_wp*t)*(1.0_wp - t)**2, t**2*(3.0_wp - 2.0_wp*t)]
    slope_weight = h*[t*(1.0_wp - t)**2, t**2*(t - 1.0_wp)]
    pose%pin = weight(1)*path%pin(:, :, k) + weight(2)*path%pin(:, :, k + 1) + &
      slope_weight(1)*path%pin_rate(:, :, k) + slope_weight(2)*path%pin_rate(:, :, k + 1)
    allocate (pose%direction, mold=path%direction(:, :, k))
    do b = 1, size(pose%direction, 2)
      pose%direction(:, b) = weight(1)*path%direction(:, b, k) + weight(2)*path%direction(:, b, &
        k + 1) + slope_weight(1)*path%turn_rate(b, k)*normal_to(path%direction(:, b, k)) + &
        slope_weight(2)*path%turn_rate(b, k + 1)*normal_to(path%direction(:, b, k + 1))
      pose%direction(:, b) = pose%direction(:, b)/norm2(pose%direction(:, b))
    end do
    allowed = 0.25_wp*maxval(abs(path%pin(:, :, k + 1) - path%pin(:, :, k)))
  end subroutine start_on_path

  !> By how much rounding may put a coordinate beyond the ends of the path.
  pure function slack(path)
    type(path_t), intent(in) :: path
    real(wp) :: slack

    slack = 1.0e-12_wp*(path%crank(size(path%crank)) - path%crank(1))
  end function slack

  !> Number of the last station, but one, at or before a coordinate, by bisection.
  pure function station_before(stations, c) result(k)
    real(wp), intent(in) :: stations(:)
    real(wp), intent(in) :: c
    integer :: k

    integer :: upper, middle

    k = 1
    upper = size(stations)
    do while (upper - k > 1)
      middle = (k + upper)/2
      if (stations(middle) <= c) then
        k = middle
      else
        upper = middle
      end if
    end do
  end function station_before

  !> Angle of a body from the global x axis, in (−π, π] [rad].
  pure function body_angle(linkage, pose, body) result(angle)
    type(linkage_t), intent(in) :: linkage !! senses of its bodies
    type(pose_t), intent(in) :: pose       !! directions of the bodies
    integer, intent(in) :: body            !! number, from 1
    real(wp) :: angle

    angle = angle_of(turned(linkage%bodies(body)%heading, pose%direction(:, body)))
  end function body_angle

  !> Angle of a body from one of its two ends to the other, in (−π, π] [rad].
  pure function angle_along(linkage, pose, body, from) result(angle)
    type(linkage_t), intent(in) :: linkage !! its bodies
    type(pose_t), intent(in) :: pose       !! directions of the bodies
    integer, intent(in) :: body            !! number, from 1
    integer, intent(in) :: from            !! its first or its last pin
    real(wp) :: angle

    angle = angle_of(merge(1.0_wp, -1.0_wp, linkage%bodies(body)%first_pin == from)* &
      pose%direction(:, body))
  end function angle_along

  !> Angle of a vector, in (−π, π] [rad].
  pure function angle_of(e) result(angle)
    real(wp), intent(in) :: e(2)
    real(wp) :: angle

    ! Adding zero turns -0 into 0: an angle of -π would be outside the interval.
    angle = atan2(e(2) + 0.0_wp, e(1) + 0.0_wp)
  end function angle_of

  !> Transmission angle: between the two bodies of a dyad at their common pin, in [0, π] [rad]; best
  !! at π/2.
  pure function transmission_angle(linkage, pose, dyad) result(angle)
    type(linkage_t), intent(in) :: linkage !! bodies and dyads
    type(pose_t), intent(in) :: pose       !! directions of the bodies
    integer, intent(in) :: dyad            !! number, from 1
    real(wp) :: angle

    real(wp) :: arm(2, 2)
    integer :: k

    do k = 1, 2
      arm(:, k) = arm_to_middle(linkage, linkage%groups(dyad), pose, k)
    end do
    angle = atan2(abs(pose%sine(dyad)), dot_product(arm(:, 1), arm(:, 2)))
  end function transmission_angle

  !> From the first pin of a body to a place on it, in global axes [m].
  pure function arm_to_place(pose, body, place) result(arm)
    type(pose_t), intent(in) :: pose !! directions of the bodies
    integer, intent(in) :: body      !! number, from 1
    real(wp), intent(in) :: place(2) !! from the first pin, in the axes of the body [m]
    real(wp) :: arm(2)

    arm = place(1)*pose%direction(:, body) + place(2)*normal_to(pose%direction(:, body))
  end function arm_to_place

  !> Unit vector along a body of a dyad, from its base to the middle pin.
  pure function arm_to_middle(linkage, dyad, pose, k) result(arm)
    type(linkage_t), intent(in) :: linkage !! last pins of its bodies
    type(group_t), intent(in) :: dyad       !! of this linkage
    type(pose_t), intent(in) :: pose       !! directions of the bodies
    integer, intent(in) :: k               !! body of the dyad, 1 or 2
    real(wp) :: arm(2)

    arm = pose%direction(:, dyad%body(k))
    if (linkage%bodies(dyad%body(k))%last_pin /= dyad%middle) arm = -arm
  end function arm_to_middle

end module poses
