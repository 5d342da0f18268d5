!> Ranges of crank and follower of a four-bar on each branch (assembly mode).
module branch_ranges
  use four_bar_angles, only: angles_at, angles_t, four_bar_of, four_bar_t, half_turn, &
    least_stations, most_stations, station_t
  use kinds, only: wp
  use special_positions, only: find_special_positions, follower_limit_folded, &
    follower_limit_stretched, special_position_t
  implicit none (type, external)
  private

  public :: branch_range_t, find_branch_ranges

  !> A connected interval of the crank and the range of the follower in it. Angles are from the
  !! global x axis; the second of each pair is counter-clockwise of the first.
  type :: branch_range_t
    real(wp) :: crank(2) = 0.0_wp       !! the first above −180 and at most 180 [deg]
    real(wp) :: follower(2) = 0.0_wp    !! the first above −180 and at most 180 [deg]
    logical :: crank_turns = .false.    !! the crank makes full turns
    logical :: follower_turns = .false. !! the follower makes full turns
  end type branch_range_t

contains

  !> The ranges of a branch, one or two; none if the linkage does not close.
  !!
  !! The follower's angle is a continuous function of the crank's. It is greatest and least at the
  !! ends of the crank's interval, at the follower's own limits, or where links are in line as the
  !! crank passes the line of the ground.
  pure function find_branch_ranges(ground, length, side) result(ranges)
    real(wp), intent(in) :: ground(2, 2) !! O2 and O4 [m]
    real(wp), intent(in) :: length(3)    !! crank, coupler, follower [m]
    real(wp), intent(in) :: side         !! branch, +1: B to the left of A → O4, −1: to its right
    type(branch_range_t), allocatable :: ranges(:)

    real(wp), parameter :: full = 360.0_wp*(1.0_wp - 1.0e-12_wp)
    type(four_bar_t) :: bar
    type(station_t), allocatable :: stations(:)
    real(wp), allocatable :: intervals(:, :)
    integer :: i

    bar = four_bar_of(ground, length)
    allocate (ranges(0))
    if (.not. bar%reach%closes) return
    intervals = crank_intervals(bar)
    stations = [least_stations(bar), most_stations(bar), follower_stations(ground, length, side, &
      bar%reach%ground)]
    deallocate (ranges)
    allocate (ranges(size(intervals, 2)))
    do i = 1, size(ranges)
      ranges(i)%crank_turns = intervals(2, i) - intervals(1, i) >= full
      ranges(i)%crank = from_x_axis(intervals(:, i), bar%reach%ground)
      ranges(i)%follower = follower_range(bar, stations, intervals(:, i), side)
      ranges(i)%follower_turns = ranges(i)%follower(2) - ranges(i)%follower(1) >= full
      ranges(i)%follower = from_x_axis(ranges(i)%follower, bar%reach%ground)
    end do
  end function find_branch_ranges

  !> Crank angles within reach, from the line of the ground, as intervals in which the linkage moves
  !! without a jump [deg].
  pure function crank_intervals(bar) result(intervals)
    type(four_bar_t), intent(in) :: bar
    real(wp), allocatable :: intervals(:, :) !! (2, pieces)

    associate (least => bar%reach%least, most => bar%reach%most)
      if (least <= 0.0_wp .and. most >= 180.0_wp) then
        intervals = reshape([0.0_wp, 360.0_wp], [2, 1])
      else if (least <= 0.0_wp .and. .not. bar%meets_pivot) then
        intervals = reshape([-most, most], [2, 1])
      else if (most >= 180.0_wp) then
        intervals = reshape([least, 360.0_wp - least], [2, 1])
      else
        intervals = reshape([least, most, 360.0_wp - most, 360.0_wp - least], [2, 2])
      end if
    end associate
  end function crank_intervals

  !> Crank angles at the follower's limits, from the line of the ground.
  pure function follower_stations(ground, length, side, line) result(stations)
    real(wp), intent(in) :: ground(2, 2), length(3), side
    real(wp), intent(in) :: line !! angle of O2 → O4 from the global x axis [deg]
    type(station_t), allocatable :: stations(:)

    type(special_position_t), allocatable :: positions(:)
    integer :: i

    positions = find_special_positions(ground, length, side)
    allocate (stations(0))
    do i = 1, size(positions)
      if (any(positions(i)%event == [follower_limit_stretched, follower_limit_folded])) then
        stations = [stations, station_t(modulo(positions(i)%crank - line, 360.0_wp))]
      end if
    end do
  end function follower_stations

  !> Least and greatest angle of the follower in an interval of the crank, from the line of the
  !! ground [deg].
  pure function follower_range(bar, stations, interval, side) result(range)
    type(four_bar_t), intent(in) :: bar
    type(station_t), intent(in) :: stations(:) !! where the angle may be least or greatest
    real(wp), intent(in) :: interval(2)        !! [deg]
    real(wp), intent(in) :: side
    real(wp) :: range(2)

    real(wp), parameter :: slack = 1.0e-10_wp
    type(station_t) :: station
    type(angles_t) :: angles
    integer :: i, turns

    range = [huge(range), -huge(range)]
    do i = 1, size(stations)
      do turns = -1, 1
        station = stations(i)
        station%crank = station%crank + 360.0_wp*turns
        if (station%crank < interval(1) - slack .or. station%crank > interval(2) + slack) cycle
        angles = angles_at(bar, station, side)
        range = [min(range(1), angles%follower), max(range(2), angles%follower)]
      end do
    end do
  end function follower_range

  !> An interval measured from the global x axis, starting above −180° and at most at 180° [deg].
  pure function from_x_axis(interval, line) result(turned)
    real(wp), intent(in) :: interval(2), line
    real(wp) :: turned(2)

    turned(1) = half_turn(interval(1) + line)
    turned(2) = turned(1) + (interval(2) - interval(1))
  end function from_x_axis

end module branch_ranges
