! src/linkage/four_bar/ - closed forms that hold for a four-bar only, on both branches.
! In: ground pivots, lengths of crank, coupler, follower. Out: angles, ranges, special positions.
! Begin with `angles_at` here and `crank_reach` in `four_bar_limits.f90`. Full force balance:
! `counterweights.f90`.
! Not here: which linkages are four-bars (`src/linkage/four_bar_loops.f90`); poses and forces, found
! as of any linkage (`src/linkage/groups`, `src/linkage/statics`).

!> Angles of a four-bar at a crank angle in closed form, valid also where links are in line.
!!
!! The diagonal from A to O4 divides the four-bar into two triangles. Ground and crank give its
!! length and direction; coupler and follower stand on it, to the left (open) or to the right
!! (crossed). Angles are measured from the line O2 → O4 and do not jump as the crank turns, so that
!! they show how far the follower swings. Where links are in line, no digits are lost to the root of
!! a small number; in `poses` that loss is unavoidable.
module four_bar_angles
  use constants, only: degree
  use four_bar_limits, only: crank_reach, in_line_slack, reach_t
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: four_bar_t, station_t, angles_t, four_bar_of, seen_from_follower, angles_at, half_turn
  public :: least_stations, most_stations, crank_limits, posture_folded

  !> Lengths of the links and reach of the crank.
  type :: four_bar_t
    real(wp) :: ground = 0.0_wp      !! r1 [m]
    real(wp) :: length(3) = 0.0_wp   !! r2, r3, r4 [m]
    type(reach_t) :: reach           !! of the crank
    logical :: meets_pivot = .false. !! A can lie on O4, with B anywhere on a circle about both
  end type four_bar_t

  !> Posture of coupler and follower: not in line, folded, stretched out.
  integer, parameter :: posture_apart = 0, posture_folded = 1, posture_stretched = 2

  !> A crank angle, with the posture known there.
  type :: station_t
    real(wp) :: crank = 0.0_wp         !! from the line O2 → O4 [deg]
    integer :: posture = posture_apart !! posture_apart: the diagonal decides
  end type station_t

  !> All angles at a crank angle, from the line O2 → O4 [deg].
  type :: angles_t
    real(wp) :: crank = 0.0_wp
    real(wp) :: coupler = 0.0_wp       !! A → B
    real(wp) :: follower = 0.0_wp      !! O4 → B
    real(wp) :: transmission = 0.0_wp  !! between coupler and follower, from 0 to 180
  end type angles_t

contains

  !> Lengths of a four-bar and reach of its crank.
  pure function four_bar_of(ground, length) result(bar)
    real(wp), intent(in) :: ground(2, 2) !! O2 and O4 [m]
    real(wp), intent(in) :: length(3)    !! crank, coupler, follower [m]
    type(four_bar_t) :: bar

    real(wp) :: slack

    bar%ground = norm2(ground(:, 2) - ground(:, 1))
    bar%length = length
    bar%reach = crank_reach(ground, length)
    slack = in_line_slack(bar%ground, length)
    bar%meets_pivot = abs(bar%ground - length(1)) <= slack .and. abs(length(2) - length(3)) <= slack
    ! Lengths made equal to the last digit, so that the triangles of this deltoid close where the
    ! diagonal vanishes.
    if (bar%meets_pivot) bar%length = [bar%ground, length(2), length(2)]
  end function four_bar_of

  !> The same linkage with crank and follower exchanged and O4 for O2. Its angles are from the line
  !! O4 → O2; the coupler's is that of B → A.
  pure function seen_from_follower(ground, length) result(bar)
    real(wp), intent(in) :: ground(2, 2) !! O2 and O4 [m]
    real(wp), intent(in) :: length(3)    !! crank, coupler, follower [m]
    type(four_bar_t) :: bar

    bar = four_bar_of(ground(:, [2, 1]), length([3, 2, 1]))
  end function seen_from_follower

  !> Crank angles of the shortest diagonal: on the line of the ground, or at the crank's limits with
  !! coupler and follower folded.
  pure function least_stations(bar) result(stations)
    type(four_bar_t), intent(in) :: bar !! a four-bar that closes
    type(station_t), allocatable :: stations(:)

    if (bar%meets_pivot) then
      ! B jumps to the other side of A as the crank passes the line, so that the two ends of a turn
      ! have different places of B.
      stations = [station_t(0.0_wp, posture_apart), station_t(360.0_wp, posture_apart)]
    else if (bar%reach%least <= 0.0_wp) then
      stations = [station_t(0.0_wp, posture_of(bar, abs(bar%ground - bar%length(1))))]
    else
      stations = both_sides(bar%reach%least, posture_folded)
    end if
  end function least_stations

  !> Crank angles of the longest diagonal: on the line of the ground, or at the crank's limits with
  !! coupler and follower stretched out.
  pure function most_stations(bar) result(stations)
    type(four_bar_t), intent(in) :: bar !! a four-bar that closes
    type(station_t), allocatable :: stations(:)

    if (bar%reach%most >= 180.0_wp) then
      stations = [station_t(180.0_wp, posture_of(bar, bar%ground + bar%length(1)))]
    else
      stations = both_sides(bar%reach%most, posture_stretched)
    end if
  end function most_stations

  !> Crank angles where the crank must turn back; none if it turns fully.
  pure function crank_limits(bar) result(stations)
    type(four_bar_t), intent(in) :: bar !! a four-bar that closes
    type(station_t), allocatable :: stations(:)

    allocate (stations(0))
    if (bar%reach%least > 0.0_wp) stations = least_stations(bar)
    if (bar%reach%most < 180.0_wp) stations = [stations, most_stations(bar)]
  end function crank_limits

  !> The crank angles ±angle, from 0 to below 360°; only one on the line of the ground.
  pure function both_sides(angle, posture) result(stations)
    real(wp), intent(in) :: angle !! from 0 to 180 [deg]
    integer, intent(in) :: posture
    type(station_t), allocatable :: stations(:)

    stations = [station_t(angle, posture)]
    if (angle > 0.0_wp .and. angle < 180.0_wp) stations = [stations, station_t(360.0_wp - angle, &
      posture)]
  end function both_sides

  !> Posture on a diagonal; in line within the rounding of the lengths.
  pure function posture_of(bar, diagonal) result(posture)
    type(four_bar_t), intent(in) :: bar
    real(wp), intent(in) :: diagonal !! [m]
    integer :: posture

    real(wp) :: slack

    slack = in_line_slack(bar%ground, bar%length)
    posture = posture_apart
    if (abs(diagonal - abs(bar%length(2) - bar%length(3))) <= slack) posture = posture_folded
    if (abs(diagonal - (bar%length(2) + bar%length(3))) <= slack) posture = posture_stretched
  end function posture_of

  !> Angles of all links at a crank angle within reach. They are continuous functions of it; with a
  !! crank as long as the ground only from 0 to 360°.
  pure function angles_at(bar, station, side) result(angles)
    type(four_bar_t), intent(in) :: bar    !! a four-bar that closes
    type(station_t), intent(in) :: station !! within reach
    real(wp), intent(in) :: side           !! branch, +1: B to the left of A → O4, −1: to its right
    type(angles_t) :: angles

    real(wp) :: direction, diagonal, at_crank, at_follower

    associate (r3 => bar%length(2), r4 => bar%length(3))
      direction = diagonal_angle(bar, station%crank)
      at_crank = 0.0_wp
      at_follower = 0.0_wp
      select case (station%posture)
      case (posture_stretched)
        angles%transmission = 180.0_wp
      case (posture_folded)
        if (r3 < r4) at_crank = 180.0_wp
        if (r3 >= r4) at_follower = 180.0_wp
      case default
        ! Whole turns are removed, so that it vanishes at the end of a turn if it does at the
        ! beginning.
        diagonal = hypot(bar%ground - bar%length(1), &
          2.0_wp*sqrt(bar%ground*bar%length(1))*sin(0.5_wp*modulo(station%crank, 360.0_wp)*degree))
        at_crank = triangle_angle(r4, diagonal, r3)
        at_follower = triangle_angle(r3, diagonal, r4)
        angles%transmission = triangle_angle(diagonal, r3, r4)
      end select
      angles%crank = station%crank
      angles%coupler = direction + side*at_crank
      angles%follower = direction + 180.0_wp - side*at_follower
    end associate
  end function angles_at

  !> Angle of A → O4 at a crank angle, without jumps [deg].
  !!
  !! O4 − A is `(r1 − r2) + 2 r2 sin²(φ/2)` along the ground and `−r2 sin φ` across it. With a crank
  !! longer than the ground the diagonal makes a full turn too: seen from the crank's own direction,
  !! r1 and r2 exchange their roles.
  pure function diagonal_angle(bar, crank) result(angle)
    type(four_bar_t), intent(in) :: bar
    real(wp), intent(in) :: crank !! [deg]
    real(wp) :: angle

    real(wp) :: sine, cosine

    sine = sin(0.5_wp*crank*degree)
    cosine = cos(0.5_wp*crank*degree)
    associate (r1 => bar%ground, r2 => bar%length(1))
      if (r2 < r1) then
        angle = atan2(-2.0_wp*r2*sine*cosine, (r1 - r2) + 2.0_wp*r2*sine**2)/degree
      else if (r2 > r1) then
        angle = crank - 180.0_wp + atan2(2.0_wp*r1*sine*cosine, (r2 - r1) + 2.0_wp*r1*sine**2)/ &
          degree
      else
        angle = 0.5_wp*crank - 90.0_wp
      end if
    end associate
  end function diagonal_angle

  !> Angle of a triangle between two of its sides, by the half-angle formula
  !! `tan²(γ/2) = (s − b)(s − c)/(s (s − a))` [deg].
  !!
  !! Next to a side of zero length the angle is undetermined. It is then 90°, the limit for two
  !! equal other sides.
  pure function triangle_angle(opposite, b, c) result(angle)
    real(wp), intent(in) :: opposite, b, c !! sides [m]
    real(wp) :: angle

    real(wp) :: above, below

    above = max(0.0_wp, (opposite - (b - c))*(opposite + (b - c)))
    below = max(0.0_wp, (b + c - opposite)*(b + c + opposite))
    angle = 90.0_wp
    if (above > 0.0_wp .or. below > 0.0_wp) angle = 2.0_wp*atan2(sqrt(above), sqrt(below))/degree
  end function triangle_angle

  !> An angle reduced by whole turns to above −180° and at most 180° [deg].
  elemental function half_turn(angle) result(reduced)
    real(wp), intent(in) :: angle !! [deg]
    real(wp) :: reduced

    reduced = 180.0_wp - modulo(180.0_wp - angle, 360.0_wp)
    if (reduced <= -180.0_wp) reduced = 180.0_wp
  end function half_turn

end module four_bar_angles
