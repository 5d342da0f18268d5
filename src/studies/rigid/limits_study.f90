!> What a linkage can do: ranges of its drives, dead points, swings of its links, strokes of its
!! sliders, time ratios, transmission and pressure angles, extremes of coordinates; of a four-bar in
!! closed form on both branches, whichever of them it is on.
module limits_study
  use branch_ranges, only: branch_range_t, find_branch_ranges
  use crank_extremes, only: extremes_t, find_extremes
  use crank_limits, only: crank_range_t, find_ranges, find_ranges_of_deck
  use dead_points, only: find_low_points
  use four_bar_loops, only: four_bar_t
  use drive_values, only: drive_value, drive_weight
  use group_equations, only: line_offset
  use kinds, only: wp
  use limited_quantities, only: angle_of_body, place_of_slider, pressure_of_lever, &
    pressure_of_slider, quantity_t, transmission_of_dyad, transmission_of_lines, &
    value_of_coordinate
  use linkage_paths, only: has_iterations, leave_path
  use low_points, only: low_point_t
  use linkages, only: gives_angle, group_by_newton, group_cross_slide, group_driven_dyad, &
    group_dyad, group_on_line, group_through_pin, group_two_lines, linkage_t, mobility
  use sorting, only: ascending_order
  use special_positions, only: event_names, find_change_points, find_special_positions, &
    special_position_t
  implicit none (type, external)
  private

  public :: limits_result_t, crank_range_t, drive_range_t, low_points_t, find_limits, time_ratio, &
    everywhere, branches_t, branch_result_t, find_branches, event_names, special_position_t
  public :: quantity_t, angle_of_body, place_of_slider, pressure_of_lever, pressure_of_slider, &
    transmission_of_dyad, transmission_of_lines, value_of_coordinate

  !> What a range has inside.
  type :: low_points_t
    type(low_point_t), allocatable :: at(:) !! dead points, and where iterated groups come nearest
  end type low_points_t

  !> Where a further drive can be: one that goes with the first, over its range; one that is held,
  !! if it alone moves.
  type :: drive_range_t
    integer :: drive = 0          !! number, from 2
    type(crank_range_t) :: range  !! of its own coordinate
    real(wp) :: crank(2) = 0.0_wp !! coordinates of the first drive there [deg] or [m]
  end type drive_range_t

  !> Ranges, and the extremes of every quantity over each.
  type :: limits_result_t
    type(crank_range_t), allocatable :: ranges(:)
    type(low_points_t), allocatable :: low(:)       !! (ranges)
    type(drive_range_t), allocatable :: further(:)  !! of further drives that do not turn fully
    type(quantity_t), allocatable :: quantities(:)
    type(extremes_t), allocatable :: extremes(:, :) !! (quantities, ranges)
  end type limits_result_t

  type :: branch_result_t
    type(branch_range_t), allocatable :: ranges(:)        !! of crank and follower
    type(special_position_t), allocatable :: positions(:) !! in the order of crank angles
  end type branch_result_t

  !> Both branches of a four-bar.
  type :: branches_t
    integer :: links = 0           !! including the ground
    integer :: mobility = 0        !! degrees of freedom, by counting links and pins
    type(branch_result_t) :: of(2) !! open, crossed
    type(special_position_t), allocatable :: change_points(:) !! where they meet
  end type branches_t

contains

  !> Finds all ranges, and the extremes in them.
  pure subroutine find_limits(linkage, positions, found, coordinates)
    type(linkage_t), intent(in) :: linkage      !! of any kind, with its path
    real(wp), intent(in) :: positions(:)        !! of the first drive in the deck [deg] or [m]; of a
                                                !! driven length ranges are looked for from there,
                                                !! without any everywhere
    type(limits_result_t), intent(out) :: found !! over all ranges
    integer, intent(in), optional :: coordinates(:) !! numbers of those whose extremes are wanted,
                                                !! besides links, sliders and groups

    real(wp), allocatable :: inside(:)
    integer :: i, r

    inside = positions
    if (size(inside) == 0) inside = everywhere(linkage)
    call find_ranges_of_deck(linkage, inside, positions, found%ranges)
    call list_quantities(linkage, found%quantities)
    if (present(coordinates)) found%quantities = [found%quantities, &
      (quantity_t(value_of_coordinate, coordinates(i)), i=1, size(coordinates))]
    call find_further_ranges(linkage, inside(1), found)
    allocate (found%extremes(size(found%quantities), size(found%ranges)), &
      found%low(size(found%ranges)))
    do r = 1, size(found%ranges)
      call find_low_points(linkage, found%ranges(r), linkage%groups%kind == group_by_newton, &
        found%low(r)%at)
      call find_extremes(linkage, found%ranges(r), found%quantities, found%extremes(:, r))
    end do
  end subroutine find_limits

  !> Mobility, ranges and special positions of a four-bar on both branches.
  pure subroutine find_branches(linkage, four_bar, found)
    type(linkage_t), intent(in) :: linkage    !! a four-bar
    type(four_bar_t), intent(in) :: four_bar  !! that it is
    type(branches_t), intent(out) :: found    !! open branch first

    real(wp), parameter :: sides(2) = [1.0_wp, -1.0_wp]
    type(special_position_t), allocatable :: positions(:)
    integer :: i

    found%links = size(linkage%bodies) + 1
    found%mobility = mobility(linkage)
    associate (ground => four_bar%ground, length => four_bar%length)
      do i = 1, size(sides)
        found%of(i)%ranges = find_branch_ranges(ground, length, sides(i))
        positions = find_special_positions(ground, length, sides(i))
        found%of(i)%positions = positions(ascending_order(positions%crank))
      end do
      found%change_points = find_change_points(ground, length)
    end associate
  end subroutine find_branches

  !> Coordinates of the first drive of a deck that names none: 0 of an angle, of a length as far as
  !! all links together reach.
  pure function everywhere(linkage) result(positions)
    type(linkage_t), intent(in) :: linkage
    real(wp), allocatable :: positions(:) !! [deg] or [m]

    integer, parameter :: steps = 720
    real(wp) :: span
    integer :: i

    positions = [0.0_wp]
    if (gives_angle(linkage%drives(1))) return
    span = drive_weight(linkage, 1)*(2.0_wp*sum(linkage%bodies%length) + maxval(norm2( &
      linkage%ground_position, dim=1)))
    positions = [(span*i/steps, i=-steps, steps)]
  end function everywhere

  !> Ranges of further drives.
  pure subroutine find_further_ranges(linkage, inside, found)
    type(linkage_t), intent(in) :: linkage
    real(wp), intent(in) :: inside                 !! where the first drive is meanwhile
    type(limits_result_t), intent(inout) :: found  !! with the ranges of the first one

    type(drive_range_t) :: mine
    integer :: d, r

    allocate (found%further(0))
    do d = 2, size(linkage%drives)
      associate (drive => linkage%drives(d))
        mine%drive = d
        if (.not. abs(drive%ratio) > 0.0_wp) then
          call find_held_range(linkage, d, inside, mine)
          if (mine%drive > 0) found%further = [found%further, mine]
          cycle
        end if
        do r = 1, size(found%ranges)
          associate (range => found%ranges(r))
            if (range%turns) cycle
            mine%crank = [range%from, range%to]
            mine%range%blocked_by = range%blocked_by
            if (drive%ratio < 0.0_wp) then
              mine%crank = [range%to, range%from]
              mine%range%blocked_by = range%blocked_by([2, 1])
            end if
            mine%range%from = drive_value(linkage, d, mine%crank(1))
            mine%range%to = drive_value(linkage, d, mine%crank(2))
            found%further = [found%further, mine]
          end associate
        end do
      end associate
    end do
  end subroutine find_further_ranges

  !> Where a drive that is held can be while all others stand still. None if it turns fully, and
  !! none with groups that iterations place, which are followed for the first drive only.
  pure subroutine find_held_range(linkage, number, inside, found)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: number             !! of the drive
    real(wp), intent(in) :: inside            !! where the first drive stands
    type(drive_range_t), intent(inout) :: found !! its drive is 0 if there is none

    type(linkage_t) :: alone
    type(crank_range_t), allocatable :: ranges(:)
    real(wp) :: value, ahead
    integer :: d, r

    found = drive_range_t(crank=[inside, inside])
    if (has_iterations(linkage)) return
    alone = linkage
    call leave_path(alone, inside)
    do d = 1, size(alone%drives)
      alone%drives(d)%phase = drive_value(linkage, d, inside)
      alone%drives(d)%ratio = 0.0_wp
    end do
    value = alone%drives(number)%phase
    alone%drives(number)%phase = 0.0_wp
    alone%drives(number)%ratio = 1.0_wp
    call find_ranges(alone, [value], ranges, number)
    do r = 1, size(ranges)
      ahead = value - ranges(r)%from
      if (gives_angle(linkage%drives(number))) ahead = modulo(ahead, 360.0_wp)
      if (ranges(r)%turns .or. ahead > ranges(r)%to - ranges(r)%from) cycle
      found%drive = number
      found%range = ranges(r)
      ! The turn of the deck.
      found%range%from = value - ahead
      found%range%to = found%range%from + (ranges(r)%to - ranges(r)%from)
    end do
  end subroutine find_held_range

  !> Angles of all bodies but the crank, places along guides and links, angles of dyads.
  pure subroutine list_quantities(linkage, quantities)
    type(linkage_t), intent(in) :: linkage
    type(quantity_t), allocatable, intent(out) :: quantities(:)

    type(quantity_t) :: room(size(linkage%bodies) + size(linkage%sliders) + size(linkage%groups))
    integer :: i, filled

    filled = 0
    do i = 1, size(linkage%bodies)
      if (linkage%has_crank .and. i == 1) cycle
      filled = filled + 1
      room(filled) = quantity_t(angle_of_body, i)
    end do
    do i = 1, size(linkage%sliders)
      ! A ground pivot in which a link slides has a place along that link.
      filled = filled + 1
      room(filled) = quantity_t(place_of_slider, i)
    end do
    do i = 1, size(linkage%groups)
      associate (group => linkage%groups(i))
        select case (group%kind)
        case (group_dyad, group_driven_dyad)
          filled = filled + 1
          room(filled) = quantity_t(transmission_of_dyad, i)
        case (group_on_line)
          filled = filled + 1
          room(filled) = quantity_t(pressure_of_slider, i)
        case (group_two_lines, group_cross_slide)
          filled = filled + 1
          room(filled) = quantity_t(transmission_of_lines, i)
        case (group_through_pin)
          ! A line through its pivot leaves no angle.
          if (abs(line_offset(linkage, group%slider(1))) <= 1.0e-12_wp*linkage%bodies( &
            group%body(1))%length) cycle
          filled = filled + 1
          room(filled) = quantity_t(pressure_of_lever, i)
        end select
      end associate
    end do
    allocate (quantities(filled))
    quantities = room(:filled)
  end subroutine list_quantities

  !> Time of the slower of two strokes over that of the quicker one, at a constant rate of the first
  !! drive; 0 where there are not two strokes a period.
  pure function time_ratio(range, extremes) result(ratio)
    type(crank_range_t), intent(in) :: range   !! of the first drive
    type(extremes_t), intent(in) :: extremes   !! of an angle or a place over it
    real(wp) :: ratio

    real(wp) :: forward, period

    ratio = 0.0_wp
    if (.not. range%turns .or. extremes%reversals /= 2 .or. abs(extremes%turned) > 0.0_wp) return
    period = range%to - range%from
    forward = modulo(extremes%at_greatest - extremes%at_least, period)
    if (forward <= 0.0_wp) return
    ratio = max(forward, period - forward)/min(forward, period - forward)
  end function time_ratio

end module limits_study
