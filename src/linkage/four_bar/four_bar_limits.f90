!> Limits of a four-bar: crank angles at which its loop closes, and its Grashof class.
module four_bar_limits
  use constants, only: degree
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: reach_t, crank_reach, can_reach, grashof_class, limit_angles, in_line_slack

  !> Crank angles at which the loop closes: `±[least, most]` from the line of the ground pivots.
  type :: reach_t
    real(wp) :: least = 0.0_wp  !! [deg]; 0: the crank passes the line O2 → O4
    real(wp) :: most = 180.0_wp !! [deg]; 180: the crank passes the opposite line
    real(wp) :: ground = 0.0_wp !! angle of O2 → O4 from the global x axis [deg]
    logical :: closes = .true.  !! at some crank angle
  end type reach_t

contains

  !> Crank angles for which `|r3 − r4| ≤ |O4 − A| ≤ r3 + r4`.
  pure function crank_reach(ground, length) result(reach)
    real(wp), intent(in) :: ground(2, 2) !! O2 and O4 [m]
    real(wp), intent(in) :: length(3)    !! crank, coupler, follower [m]
    type(reach_t) :: reach

    real(wp) :: r1, line(2), nearest, farthest, slack

    line = ground(:, 2) - ground(:, 1)
    r1 = norm2(line)
    reach%ground = atan2(line(2), line(1))/degree
    associate (r2 => length(1), r3 => length(2), r4 => length(3))
      nearest = abs(r3 - r4)
      farthest = r3 + r4
      ! Links that close only stretched out or folded, within the rounding of their lengths, reach
      ! that dead point and are accepted.
      slack = in_line_slack(r1, length)
      reach%closes = r1 + r2 >= nearest - slack .and. abs(r1 - r2) <= farthest + slack
      if (.not. reach%closes) return
      if (nearest > abs(r1 - r2) + slack) reach%least = crank_angle_at(r1, r2, nearest)
      if (farthest < r1 + r2 - slack) reach%most = crank_angle_at(r1, r2, farthest)
    end associate
  end function crank_reach

  !> Sums and differences of the lengths count as equal if they differ by less than this, within the
  !! digits of a deck [m].
  pure function in_line_slack(ground_length, length) result(slack)
    real(wp), intent(in) :: ground_length !! r1 [m]
    real(wp), intent(in) :: length(3)     !! crank, coupler, follower [m]
    real(wp) :: slack

    real(wp), parameter :: rounding = 1.0e-13_wp

    slack = rounding*(ground_length + sum(length))
  end function in_line_slack

  !> Crank angle from the line O2 → O4 at which A has a given distance from O4 [deg].
  !!
  !! `distance² = (r1 − r2)² + 4 r1 r2 sin²(φ/2)`: no digits are lost at φ = 0, half of them at
  !! 180°.
  pure function crank_angle_at(r1, r2, distance) result(angle)
    real(wp), intent(in) :: r1, r2, distance !! [m]
    real(wp) :: angle

    real(wp) :: squared_sine

    squared_sine = (distance - (r1 - r2))*(distance + (r1 - r2))/(4.0_wp*r1*r2)
    angle = 2.0_wp*asin(sqrt(max(0.0_wp, min(1.0_wp, squared_sine))))/degree
  end function crank_angle_at

  !> Whether the loop closes at a crank angle.
  elemental function can_reach(reach, crank_degrees) result(can)
    type(reach_t), intent(in) :: reach    !! of the crank
    real(wp), intent(in) :: crank_degrees !! from the global x axis [deg]
    logical :: can

    ! A limit position met within rounding is a dead point, not out of reach.
    real(wp), parameter :: slack = 1.0e-10_wp
    real(wp) :: angle

    angle = abs(modulo(crank_degrees - reach%ground + 180.0_wp, 360.0_wp) - 180.0_wp)
    can = reach%closes .and. angle >= reach%least - slack .and. angle <= reach%most + slack
  end function can_reach

  !> Crank angles from the global x axis at which the crank must turn back; none if it turns
  !! fully [deg].
  pure function limit_angles(reach) result(angles)
    type(reach_t), intent(in) :: reach !! of the crank
    real(wp), allocatable :: angles(:)

    allocate (angles(0))
    if (reach%least > 0.0_wp) angles = [reach%ground - reach%least, reach%ground + reach%least]
    if (reach%most < 180.0_wp) angles = [angles, reach%ground - reach%most, &
      reach%ground + reach%most]
  end function limit_angles

  !> Grashof class in words, padded with blanks: shortest + longest against the other two; the
  !! shortest link decides the kind.
  pure function grashof_class(ground_length, length) result(class)
    real(wp), intent(in) :: ground_length !! r1 [m]
    real(wp), intent(in) :: length(3)     !! crank, coupler, follower [m]
    character(len=72) :: class

    real(wp) :: all_lengths(4), excess

    all_lengths = [ground_length, length]
    excess = 2.0_wp*(minval(all_lengths) + maxval(all_lengths)) - sum(all_lengths)
    if (abs(excess) <= in_line_slack(ground_length, length)) then
      class = "change-point linkage (shortest + longest = sum of the other two)"
    else if (excess > 0.0_wp) then
      class = "non-Grashof triple rocker: no link turns fully"
    else
      select case (minloc(all_lengths, dim=1))
      case (1)
        class = "Grashof double crank: both grounded links turn fully"
      case (2)
        class = "Grashof crank-rocker: the driven link turns fully"
      case (3)
        class = "Grashof double rocker: only the coupler turns fully"
      case default
        class = "Grashof rocker-crank: the follower turns fully"
      end select
    end if
  end function grashof_class

end module four_bar_limits
