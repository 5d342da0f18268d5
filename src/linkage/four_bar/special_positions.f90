!> Special positions of a four-bar: where a grounded link turns back, where the transmission angle
!! is least and greatest, and where all links are in line.
module special_positions
  use constants, only: degree
  use four_bar_angles, only: angles_at, angles_t, crank_limits, four_bar_of, four_bar_t, &
    half_turn, least_stations, most_stations, posture_folded, seen_from_follower, station_t
  use four_bar_limits, only: in_line_slack
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: special_position_t, find_special_positions, find_change_points, event_names
  public :: crank_limit_stretched, crank_limit_folded, follower_limit_stretched, &
    follower_limit_folded, transmission_smallest, transmission_largest, change_point

  !> Crank limit: coupler and follower are in line, stretched out or folded; the crank turns back,
  !! and the linkage may change to the other branch. Follower limit: the same of crank and coupler;
  !! the follower turns back. Change point: all links are in line.
  integer, parameter :: crank_limit_stretched = 1, crank_limit_folded = 2, &
    follower_limit_stretched = 3, follower_limit_folded = 4, transmission_smallest = 5, &
    transmission_largest = 6, change_point = 7
  character(len=*), parameter :: event_names(7) = [character(len=24) :: "crank_limit_stretched", &
    "crank_limit_folded", "follower_limit_stretched", "follower_limit_folded", &
    "transmission_smallest", "transmission_largest", "change_point"]

  !> A special position of one branch; angles are from the global x axis.
  type :: special_position_t
    integer :: event = 0                    !! one of the numbers above
    real(wp) :: crank = 0.0_wp              !! from 0 to below 360 [deg]
    real(wp) :: coupler = 0.0_wp            !! A → B, above −180 and at most 180 [deg]
    real(wp) :: follower = 0.0_wp           !! O4 → B, above −180 and at most 180 [deg]
    real(wp) :: transmission_angle = 0.0_wp !! between coupler and follower, from 0 to 180 [deg]
  end type special_position_t

contains

  !> All special positions of a branch, grouped by event; none if the linkage does not close.
  !!
  !! With `d = |O4 − A|` the transmission angle is `cos μ = (r3² + r4² − d²)/(2 r3 r4)`, and d grows
  !! with the crank's angle from the line of the ground. On both branches μ is therefore least and
  !! greatest at the ends of the reach of that angle.
  pure function find_special_positions(ground, length, side) result(list)
    real(wp), intent(in) :: ground(2, 2) !! O2 and O4 [m]
    real(wp), intent(in) :: length(3)    !! crank, coupler, follower [m]
    real(wp), intent(in) :: side         !! branch, +1: B to the left of A → O4, −1: to its right
    type(special_position_t), allocatable :: list(:)

    type(four_bar_t) :: bar
    type(station_t), allocatable :: limits(:)

    bar = four_bar_of(ground, length)
    allocate (list(0))
    if (.not. bar%reach%closes) return
    limits = crank_limits(bar)
    list = [at_stations(bar, limits, side, merge(crank_limit_folded, crank_limit_stretched, &
      limits%posture == posture_folded)), follower_limits(ground, length, side)]
    limits = least_stations(bar)
    list = [list, at_stations(bar, limits, side, spread(transmission_smallest, 1, size(limits)))]
    limits = most_stations(bar)
    list = [list, at_stations(bar, limits, side, spread(transmission_largest, 1, size(limits))), &
      find_change_points(ground, length)]
  end function find_special_positions

  !> Special positions at given crank angles, each with its event.
  pure function at_stations(bar, stations, side, events) result(list)
    type(four_bar_t), intent(in) :: bar
    type(station_t), intent(in) :: stations(:)
    real(wp), intent(in) :: side
    integer, intent(in) :: events(:) !! (stations)
    type(special_position_t) :: list(size(stations))

    type(angles_t) :: angles
    integer :: i

    do i = 1, size(stations)
      angles = angles_at(bar, stations(i), side)
      list(i) = position_of(events(i), bar%reach%ground, angles%crank, angles%coupler, &
        angles%follower, angles%transmission)
    end do
  end function at_stations

  !> Limits of the follower: crank limits of the linkage seen from the follower. The sign of
  !! `sin(θ4 − θ3)` shows which branch they are on.
  pure function follower_limits(ground, length, side) result(list)
    real(wp), intent(in) :: ground(2, 2), length(3), side
    type(special_position_t), allocatable :: list(:)

    type(four_bar_t) :: bar
    type(station_t), allocatable :: limits(:)
    type(angles_t) :: angles
    real(wp) :: difference
    integer :: i

    bar = seen_from_follower(ground, length)
    limits = crank_limits(bar)
    allocate (list(0))
    do i = 1, size(limits)
      angles = angles_at(bar, limits(i), side)
      ! Seen from the follower, the crank angle is that of the follower, the coupler's that of
      ! B → A.
      difference = half_turn(angles%crank - angles%coupler - 180.0_wp)
      if (side*difference <= 0.0_wp) cycle
      list = [list, position_of(merge(follower_limit_folded, follower_limit_stretched, &
        limits(i)%posture == posture_folded), bar%reach%ground, angles%follower, angles%coupler + &
        180.0_wp, angles%crank, abs(difference))]
    end do
  end function follower_limits

  !> Positions with all links in line, within the digits of their lengths: `±r2 ± r3 = r1 ± r4`.
  !! There the branches meet, and only its momentum decides on which of them the linkage continues.
  pure function find_change_points(ground, length) result(list)
    real(wp), intent(in) :: ground(2, 2) !! O2 and O4 [m]
    real(wp), intent(in) :: length(3)    !! crank, coupler, follower [m]
    type(special_position_t), allocatable :: list(:)

    real(wp) :: line(2), r1, turned(3)
    integer :: i

    line = ground(:, 2) - ground(:, 1)
    r1 = norm2(line)
    allocate (list(0))
    do i = 0, 7
      ! 180° for each link that points from O4 to O2
      turned = merge(180.0_wp, 0.0_wp, btest(i, [0, 1, 2]))
      if (abs(dot_product(cos(turned*degree), length*[1.0_wp, 1.0_wp, -1.0_wp]) - r1) > &
        in_line_slack(r1, length)) cycle
      list = [list, position_of(change_point, atan2(line(2), line(1))/degree, turned(1), &
        turned(2), turned(3), abs(turned(3) - turned(2)))]
    end do
  end function find_change_points

  !> A special position from angles measured from the line of the ground.
  pure function position_of(event, ground, crank, coupler, follower, transmission) result(position)
    integer, intent(in) :: event         !! one of the numbers above
    real(wp), intent(in) :: ground       !! angle of the line from the global x axis [deg]
    real(wp), intent(in) :: crank, coupler, follower !! from the line [deg]
    real(wp), intent(in) :: transmission !! [deg]
    type(special_position_t) :: position

    position%event = event
    position%crank = modulo(ground + crank, 360.0_wp)
    ! For a tiny negative angle `modulo` rounds to the whole turn.
    if (position%crank >= 360.0_wp) position%crank = 0.0_wp
    position%coupler = half_turn(ground + coupler)
    position%follower = half_turn(ground + follower)
    position%transmission_angle = transmission
  end function position_of

end module special_positions
