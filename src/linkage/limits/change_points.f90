!> Change points on the way of a linkage: two smooth ways cross, and the equations of a group depend
!! on each other. The linkage goes on smoothly.
!!
!! What lies between the places before and behind at which they are independent is a bridge: a
!! polynomial through nodes on both sides. The smooth way fulfils all equations there, those of
!! redundant links too; where the bridge does not, there is no change point but a limit, or a way
!! that turns sharply.
module change_points
  use bridges, only: change_of, cross_bridge, thinned
  use group_equations, only: misfit_of
  use kinds, only: wp
  use linkages, only: bridge_t, cross, linkage_t
  use plan_equations, only: length_drive, line_equation, turn_equation
  use path_steps, only: station_t, step_to, take_step
  use pose_types, only: arm_to_pin, pins_of_body, pose_t
  implicit none (type, external)
  private

  public :: find_bridge, is_near_change, near_change, largest_gap

  !> Equations depend on each other where a determinant is below this share of its usual size.
  real(wp), parameter :: near_change = 0.02_wp

  !> The ends of a bridge may stand nearer by so many halvings: the narrower the zone, the better
  !! its polynomial, but the more the places at its ends are rounded.
  integer, parameter :: most_halvings = 9

  !> A bridge with less error is as good as it can be.
  real(wp), parameter :: least_error = 1.0e-12_wp

  !> Nodes of a bridge on each side.
  integer, parameter :: nodes = 6

  !> A bridge stands if its places are as exact as this, as a share of the size of the linkage:
  !! links that fit well enough, to 1e-9, move its ends by as much more as these are near.
  real(wp), parameter :: most_error = 2.0e-8_wp

  !> So much more than errors of places count gaps in the equations, which are misfits themselves.
  real(wp), parameter :: weight_of_gaps = 2.0_wp

contains

  !> Whether some group is near a point where its equations depend on each other.
  pure function is_near_change(sine, usual, share) result(is)
    real(wp), intent(in) :: sine(:)  !! (groups) as in `pose_t`
    real(wp), intent(in) :: usual(:) !! (groups) its largest size so far
    real(wp), intent(in) :: share    !! of the usual size that is near
    logical :: is

    is = any(abs(sine) < share*usual)
  end function is_near_change

  !> Looks for a change point in the next steps, and for the bridge over it.
  pure subroutine find_bridge(linkage, station, step, unit, usual, span, bridge, last, next, &
    found, is_ahead)
    type(linkage_t), intent(in) :: linkage   !! with groups and redundancies
    type(station_t), intent(in) :: station   !! before it, where equations are independent
    real(wp), intent(in) :: step             !! along the way, with its sign [deg] or [m]
    real(wp), intent(in) :: unit             !! of the coordinate [rad] or [m]
    real(wp), intent(in) :: usual(:)         !! (groups) sizes of the determinants
    real(wp), intent(in) :: span             !! size of the linkage [m]
    type(bridge_t), intent(out) :: bridge
    type(station_t), intent(out) :: last, next !! its ends, in the sense of the way
    logical, intent(out) :: found
    logical, intent(out) :: is_ahead           !! it may lie beyond the next step

    !> Of a step: it did not end at a change point.
    real(wp), parameter :: whole = 0.999_wp
    type(station_t) :: before, far, behind
    type(bridge_t) :: tried
    real(wp) :: share, ahead, width, spacing, least, error
    logical :: crosses, has_crossed
    integer :: closer, k

    bridge%error = huge(1.0_wp)
    least = huge(least)
    is_ahead = .false.
    has_crossed = .false.
    ahead = step
    before = station
    do closer = 0, most_halvings
      share = near_change/2.0_wp**closer
      if (is_near_change(station%pose%sine, usual, share)) cycle
      far = before
      call approach(linkage, far, ahead, unit, usual, share, before)
      is_ahead = closer > 0 .and. .not. has_crossed .and. abs(before%crank - far%crank) > &
        whole*abs(step)
      ! Steps may have failed for another reason, or the zone may be wide enough.
      if (is_ahead .or. .not. is_near_change(before%pose%sine, usual, 2.0_wp*share)) exit
      call cross_over(linkage, before, step, unit, usual, share, far, width, crosses)
      if (.not. crosses) cycle
      has_crossed = .true.
      ahead = width
      call approach(linkage, far, before%crank - far%crank, unit, usual, share, behind)
      ! The best spacing is not known beforehand: wide zones want wide ones.
      spacing = sign(0.5_wp*max(abs(step), abs(width)), step)
      do k = 1, 7
        call build(linkage, before, behind, spacing, unit, span, tried)
        spacing = 0.5_wp*spacing
        if (tried%error > most_error) cycle
        ! That of accelerations: those of a narrower bridge are less exact than its places.
        error = tried%error/(tried%to - tried%from)**2
        if (error >= least) cycle
        least = error
        bridge = tried
        last = before
        next = behind
      end do
      if (bridge%error <= least_error) exit
    end do
    found = least < huge(least)
    if (.not. found) return
    bridge%group = maxloc(merge(1.0_wp, 0.0_wp, last%pose%sine*next%pose%sine < 0.0_wp), dim=1)
    bridge%change = change_of(linkage, bridge, bridge%group)
  end subroutine find_bridge

  !> Over the change point: the polynomial through places before it leads to one behind, where
  !! equations are independent again. How far it is, is known from the rate of the determinant.
  pure subroutine cross_over(linkage, last, step, unit, usual, share, far, width, found)
    type(linkage_t), intent(in) :: linkage
    type(station_t), intent(in) :: last  !! where equations are still independent
    real(wp), intent(in) :: step         !! along the way, with its sign
    real(wp), intent(in) :: unit
    real(wp), intent(in) :: usual(:)
    real(wp), intent(in) :: share
    type(station_t), intent(out) :: far  !! behind it
    real(wp), intent(out) :: width       !! estimated, from here to the change point
    logical, intent(out) :: found

    real(wp), parameter :: ways(*) = [2.0_wp, 2.3_wp, 2.7_wp, 3.2_wp, 4.0_wp, 1.7_wp]
    !> A zone may be as wide as this many steps.
    integer, parameter :: most_steps = 20
    type(station_t) :: before
    type(bridge_t) :: behind
    type(pose_t) :: expected
    real(wp) :: small, rate
    logical :: is_good
    integer :: group, i, k

    found = .false.
    width = step
    group = minloc(abs(last%pose%sine)/max(usual, tiny(1.0_wp)), dim=1)
    small = 1.0e-3_wp*step
    call take_step(linkage, last, -small, unit, before, is_good)
    if (.not. is_good) return
    rate = (before%pose%sine(group) - last%pose%sine(group))/small
    if (.not. abs(rate) > 0.0_wp) return
    width = last%pose%sine(group)/rate
    if (width/step <= 0.0_wp .or. abs(width) > most_steps*abs(step)) return
    ! Places before, ever closer if they are not on the way or do not lead over.
    do k = 1, 4
      call look_back(linkage, last, -width*0.5_wp**k, unit, behind, is_good)
      if (.not. is_good) cycle
      do i = 1, size(ways)
        call cross_bridge(linkage, behind, last%crank + ways(i)*width, expected)
        call step_to(linkage, last, last%crank + ways(i)*width, expected, far, found)
        if (found) found = .not. is_near_change(far%pose%sine, usual, share)
        if (found) return
      end do
    end do
  end subroutine cross_over

  !> Nodes from a station back.
  pure subroutine look_back(linkage, last, spacing, unit, behind, is_good)
    type(linkage_t), intent(in) :: linkage
    type(station_t), intent(in) :: last
    real(wp), intent(in) :: spacing !! against the way
    real(wp), intent(in) :: unit
    type(bridge_t), intent(out) :: behind
    logical, intent(out) :: is_good

    call make_room(last%pose, nodes, behind)
    call place_nodes(linkage, last, spacing, unit, 1, 1, behind, is_good)
  end subroutine look_back

  !> Room for nodes.
  pure subroutine make_room(pose, number, bridge)
    type(pose_t), intent(in) :: pose
    integer, intent(in) :: number
    type(bridge_t), intent(inout) :: bridge

    associate (pins => size(pose%pin, 2), bodies => size(pose%direction, 2), &
        groups => size(pose%sine))
      allocate (bridge%crank(number), bridge%pin(2, pins, number), &
        bridge%direction(2, bodies, number), bridge%sine(groups, number))
    end associate
  end subroutine make_room

  !> As far ahead as equations are independent.
  pure subroutine approach(linkage, station, ahead, unit, usual, share, last)
    type(linkage_t), intent(in) :: linkage
    type(station_t), intent(in) :: station
    real(wp), intent(in) :: ahead !! beyond that, with its sign
    real(wp), intent(in) :: unit
    real(wp), intent(in) :: usual(:)
    real(wp), intent(in) :: share
    type(station_t), intent(out) :: last

    type(station_t) :: next
    integer, parameter :: most_tries = 12
    real(wp) :: way
    logical :: is_good
    integer :: i

    last = station
    way = ahead
    i = 0
    do while (i < most_tries)
      call take_step(linkage, last, way, unit, next, is_good)
      if (is_good) is_good = .not. is_near_change(next%pose%sine, usual, share) .and. &
        (next%crank - station%crank)/ahead < 1.0_wp
      if (is_good) then
        last = next
      else
        way = 0.5_wp*way
        i = i + 1
      end if
    end do
  end subroutine approach

  !> A bridge through nodes at a spacing, with its error: that of the polynomial, from that through
  !! fewer nodes, and by how much equations are not fulfilled.
  pure subroutine build(linkage, last, next, spacing, unit, span, bridge)
    type(linkage_t), intent(in) :: linkage
    type(station_t), intent(in) :: last, next
    real(wp), intent(in) :: spacing !! with the sign of the way
    real(wp), intent(in) :: unit
    real(wp), intent(in) :: span
    type(bridge_t), intent(out) :: bridge

    integer, parameter :: probes = 5
    type(bridge_t) :: narrow
    type(pose_t) :: all_nodes, fewer
    real(wp) :: at, error
    logical :: is_good
    integer :: i

    bridge%error = huge(1.0_wp)
    bridge%from = min(last%crank, next%crank)
    bridge%to = max(last%crank, next%crank)
    call make_room(last%pose, 2*nodes, bridge)
    if (spacing > 0.0_wp) then
      call place_nodes(linkage, last, -spacing, unit, nodes, -1, bridge, is_good)
      if (is_good) call place_nodes(linkage, next, spacing, unit, nodes + 1, 1, bridge, is_good)
    else
      call place_nodes(linkage, next, spacing, unit, nodes, -1, bridge, is_good)
      if (is_good) call place_nodes(linkage, last, -spacing, unit, nodes + 1, 1, bridge, is_good)
    end if
    if (.not. is_good) return
    narrow = thinned(bridge)
    error = 0.0_wp
    do i = 1, probes
      at = bridge%from + (bridge%to - bridge%from)*i/(probes + 1)
      call cross_bridge(linkage, bridge, at, all_nodes)
      call cross_bridge(linkage, narrow, at, fewer)
      error = max(error, maxval(abs(all_nodes%pin - fewer%pin))/span, &
        maxval(abs(all_nodes%direction - fewer%direction)), &
        weight_of_gaps*largest_gap(linkage, all_nodes, at)/span)
    end do
    bridge%error = error
  end subroutine build

  !> Nodes on one side.
  pure subroutine place_nodes(linkage, first, spacing, unit, number, order, bridge, is_good)
    type(linkage_t), intent(in) :: linkage
    type(station_t), intent(in) :: first !! the node nearest to the change point
    real(wp), intent(in) :: spacing      !! away from it
    real(wp), intent(in) :: unit
    integer, intent(in) :: number        !! of the first node
    integer, intent(in) :: order         !! −1: of lower ones, 1: of higher ones
    type(bridge_t), intent(inout) :: bridge
    logical, intent(out) :: is_good

    type(station_t) :: station, next
    integer :: i

    station = first
    is_good = .true.
    do i = 0, nodes - 1
      if (i > 0) then
        call take_step(linkage, station, spacing, unit, next, is_good)
        if (.not. is_good) return
        station = next
      end if
      associate (k => number + order*i)
        bridge%crank(k) = station%crank
        bridge%pin(:, :, k) = station%pose%pin
        bridge%direction(:, :, k) = station%pose%direction
        bridge%sine(:, k) = station%pose%sine
      end associate
    end do
  end subroutine place_nodes

  !> The largest gap between what joints hold together [m]; angles count with the length of a body.
  pure function largest_gap(linkage, pose, crank) result(gap)
    type(linkage_t), intent(in) :: linkage !! with or without redundancies
    type(pose_t), intent(in) :: pose
    real(wp), intent(in) :: crank          !! coordinate of the first drive [deg] or [m]
    real(wp) :: gap

    integer, allocatable :: pins(:)
    real(wp) :: way(2)
    integer :: b, i

    gap = 0.0_wp
    do b = 1, size(linkage%bodies)
      pins = pins_of_body(linkage%bodies(b))
      do i = 2, size(pins)
        way = pose%pin(:, pins(i)) - pose%pin(:, pins(1))
        if (i == 2 .and. length_drive(linkage, b) > 0) then
          gap = max(gap, abs(cross(pose%direction(:, b), way)))
        else
          gap = max(gap, maxval(abs(way - arm_to_pin(linkage, pose, b, pins(i)))))
        end if
      end do
    end do
    do i = 1, size(linkage%sliders)
      gap = max(gap, abs(misfit_of(linkage, line_equation(linkage, i), pose, crank)))
    end do
    do i = 1, size(linkage%turns)
      gap = max(gap, linkage%bodies(linkage%turns(i)%body)%length*abs(misfit_of(linkage, &
        turn_equation(linkage, i), pose, crank)))
    end do
  end function largest_gap

end module change_points
