!> Limits of a way: where the determinant of a group comes to zero and the linkage goes no farther.
!!
!! At a limit the coordinate of the first drive turns back, and places change with the root of the
!! distance from it: but both are smooth functions of the determinant. Polynomials in it, through
!! places before the limit, lead to the limit itself; solving there would lose half the digits.
module path_limits
  use bridges, only: cross_bridge, node_weights, thinned
  use constants, only: degree
  use kinds, only: wp
  use linkages, only: bridge_t, follows_angle, linkage_t
  use path_steps, only: station_t
  use pose_types, only: pose_t
  implicit none (type, external)
  private

  public :: approach_t, watch

  !> Nodes of the polynomials.
  integer, parameter :: nodes = 6

  !> The last stations on the way to a limit, each with half the determinant of the one before or
  !! less, and where they lead.
  type :: approach_t
    integer :: group = 0          !! whose determinant is smallest
    integer :: known = 0          !! stations
    type(station_t) :: at(nodes)
    logical :: is_over = .false.  !! farther on the limit is found no better
    logical :: is_found = .false.
    real(wp) :: error = 0.0_wp    !! estimated, of the limit
    type(bridge_t) :: limit       !! from one of the stations on, the best so far
  end type approach_t

contains

  !> Remembers a station if it is distinctly nearer to a limit than those before; finds the limit.
  pure subroutine watch(linkage, station, span, approach)
    type(linkage_t), intent(in) :: linkage      !! with groups
    type(station_t), intent(in) :: station      !! the next one on the way
    real(wp), intent(in) :: span                !! size of the linkage [m]
    type(approach_t), intent(inout) :: approach

    !> Farther away no limit is in sight; nearer no digit is gained.
    real(wp), parameter :: in_sight = 0.1_wp, at_hand = 3.0e-5_wp
    !> Ratio of determinants up to which they are alike.
    real(wp), parameter :: at_once = 1.001_wp
    real(wp) :: last
    integer :: group

    group = minloc(abs(station%pose%sine), dim=1)
    ! Several may come to it at once.
    if (approach%group > 0) then
      if (abs(station%pose%sine(approach%group)) <= at_once*abs(station%pose%sine(group))) &
        group = approach%group
    end if
    associate (sine => abs(station%pose%sine(group)))
      if (group /= approach%group .or. sine > in_sight) call leave(approach)
      approach%group = group
      if (sine > in_sight) return
      if (approach%known > 0) then
        last = abs(approach%at(approach%known)%pose%sine(group))
        if (sine > last) call leave(approach)
        if (sine > 0.5_wp*last .and. sine <= last) return
      end if
      if (approach%known == nodes) then
        approach%at(:nodes - 1) = approach%at(2:)
      else
        approach%known = approach%known + 1
      end if
      approach%at(approach%known) = station
      if (approach%known == nodes) call look_ahead(linkage, span, approach)
      approach%is_over = approach%is_over .or. (approach%is_found .and. sine < at_hand)
    end associate
  end subroutine watch

  !> Forgets all stations.
  pure subroutine leave(approach)
    type(approach_t), intent(inout) :: approach

    approach%known = 0
    approach%is_found = .false.
  end subroutine leave

  !> The limit to which the last stations lead; the best is kept. First the polynomials become
  !! better with every station, then rounding makes them worse.
  pure subroutine look_ahead(linkage, span, approach)
    type(linkage_t), intent(in) :: linkage
    real(wp), intent(in) :: span
    type(approach_t), intent(inout) :: approach

    !> Errors of the limit, and of places there, from polynomials through fewer nodes: as a share of
    !! the size of the linkage, or in radians. Those of places count less.
    real(wp), parameter :: most_error = 1.0e-11_wp, weight_of_places = 1.0e-3_wp
    type(bridge_t) :: limit, fewer_nodes
    type(pose_t) :: pose, other
    real(wp) :: weight(nodes, 0:2), fewer(nodes - 1, 0:2), sine(nodes), way, error
    integer :: k

    sine = [(approach%at(k)%pose%sine(approach%group), k=1, nodes)]
    limit%group = approach%group
    limit%by_sine = .true.
    associate (pins => size(approach%at(1)%pose%pin, 2), groups => size(linkage%groups), &
        bodies => size(approach%at(1)%pose%direction, 2))
      allocate (limit%crank(nodes), limit%pin(2, pins, nodes), limit%direction(2, bodies, nodes), &
        limit%sine(groups, nodes))
    end associate
    do k = 1, nodes
      limit%crank(k) = approach%at(k)%crank
      limit%pin(:, :, k) = approach%at(k)%pose%pin
      limit%direction(:, :, k) = approach%at(k)%pose%direction
      limit%sine(:, k) = approach%at(k)%pose%sine
    end do
    weight = node_weights(sine, 0.0_wp)
    fewer = node_weights(sine(2:), 0.0_wp)
    associate (last => limit%crank(nodes), before => limit%crank(nodes - 1))
      way = dot_product(weight(:, 0), limit%crank - last)
      error = abs(way - dot_product(fewer(:, 0), limit%crank(2:) - last))/span
      if (follows_angle(linkage)) error = error*span*degree
      ! It lies ahead, and no farther than the stations say.
      if (way*(last - before) <= 0.0_wp .or. abs(way) > 2.0_wp*abs(last - before)) return
      limit%change = last + way
      limit%from = min(last, limit%change)
      limit%to = max(last, limit%change)
    end associate
    call cross_bridge(linkage, limit, limit%change, pose)
    fewer_nodes = thinned(limit)
    call cross_bridge(linkage, fewer_nodes, limit%change, other)
    limit%error = max(maxval(abs(pose%pin - other%pin))/span, maxval(abs(pose%direction - &
      other%direction)))
    error = error + weight_of_places*limit%error
    if (error > most_error) return
    approach%is_over = approach%is_found .and. error > approach%error
    if (approach%is_over) return
    approach%is_found = .true.
    approach%error = error
    approach%limit = limit
  end subroutine look_ahead

end module path_limits
