!> The prescribed motion of the first drive in time: at constant speed, from rest with constant
!! acceleration up to it, or by the law of the deck; and the positions that it covers.
module crank_laws
  use chebyshev_series, only: chebyshev_nodes
  use constants, only: degree, two_pi
  use kinds, only: wp
  use motion_programs, only: motion_program_t, program_breaks, program_values_inside
  implicit none (type, external)
  private

  public :: crank_law_t, covered_range_t, crank_motion, crank_breaks, constant_from, &
    time_of_turns, extremes_of, positions_of, half_of, place_in

  !> Positions of the first drive that a motion covers: those of a turn, or of a part of the way.
  type :: covered_range_t
    logical :: is_turn = .true.
    logical :: is_angle = .true.
    real(wp) :: from = 0.0_wp, to = 360.0_wp !! [deg] or [m]
  end type covered_range_t

  type :: crank_law_t
    real(wp) :: start = 0.0_wp !! first crank angle [deg]
    real(wp) :: speed = 0.0_wp !! ω2, once it is constant; not 0 [rad/s]
    real(wp) :: ramp = 0.0_wp  !! time from rest to this speed; 0: it is constant from the start [s]
    type(motion_program_t), allocatable :: program !! the position [deg] or [m], in place of the
                                                   !! above
    type(covered_range_t) :: range !! positions that the motion covers, their unit
  end type crank_law_t

  !> Positions of a law looked at between two instants, and in all.
  integer, parameter :: between = 16, in_all = 4000

contains

  !> Crank angle, speed and acceleration at a time of a smooth piece of the motion, up to its ends.
  pure function crank_motion(law, time, inside) result(motion)
    type(crank_law_t), intent(in) :: law
    real(wp), intent(in) :: time   !! from 0 [s]
    real(wp), intent(in) :: inside !! a time of the piece, not at its ends [s]
    real(wp) :: motion(0:2)        !! [deg, rad/s, rad/s²] or [m, m/s, m/s²]

    if (allocated(law%program)) then
      motion = program_values_inside(law%program, time, inside)*[1.0_wp, unit_of(law%range), &
        unit_of(law%range)]
    else if (inside < law%ramp) then
      motion = [law%start + 0.5_wp*law%speed*time**2/law%ramp/degree, law%speed*(time/law%ramp), &
        law%speed/law%ramp]
    else
      motion = [law%start + law%speed*(time - 0.5_wp*law%ramp)/degree, law%speed, 0.0_wp]
    end if
  end function crank_motion

  !> Times between two others at which pieces end.
  pure function crank_breaks(law, from, to) result(breaks)
    type(crank_law_t), intent(in) :: law
    real(wp), intent(in) :: from, to   !! [s]
    real(wp), allocatable :: breaks(:) !! rising [s]

    if (allocated(law%program)) then
      breaks = program_breaks(law%program, from, to)
    else
      breaks = pack([law%ramp], law%ramp > from .and. law%ramp < to)
    end if
  end function crank_breaks

  !> From when on the speed is constant [s]; never: huge.
  pure function constant_from(law) result(time)
    type(crank_law_t), intent(in) :: law
    real(wp) :: time

    time = law%ramp
    if (allocated(law%program)) time = huge(time)
  end function constant_from

  !> When the crank has made a number of turns, at constant speed or after a ramp [s].
  elemental function time_of_turns(law, turns) result(time)
    type(crank_law_t), intent(in) :: law
    real(wp), intent(in) :: turns !! from 0
    real(wp) :: time

    time = turns*two_pi/abs(law%speed)
    if (time >= 0.5_wp*law%ramp) then
      time = time + 0.5_wp*law%ramp
    else
      time = sqrt(2.0_wp*time*law%ramp)
    end if
  end function time_of_turns

  !> The least and the greatest position of a motion from the first time to the last.
  pure function extremes_of(law, time) result(extremes)
    type(crank_law_t), intent(in) :: law
    real(wp), intent(in) :: time(:)  !! rising [s]
    real(wp) :: extremes(2)          !! [deg] or [m]

    real(wp), allocatable :: ends(:)
    real(wp) :: motion(0:2), before(0:2), inside, step
    integer :: i, j, k, n

    n = max(between, in_all/size(time))
    extremes = [huge(1.0_wp), -huge(1.0_wp)]
    do k = 1, size(time) - 1
      ends = [time(k), crank_breaks(law, time(k), time(k + 1)), time(k + 1)]
      do i = 1, size(ends) - 1
        inside = 0.5_wp*(ends(i) + ends(i + 1))
        step = (ends(i + 1) - ends(i))/n
        do j = 0, n
          motion = crank_motion(law, ends(i) + j*step, inside)
          extremes = with(extremes, motion(0))
          if (j > 0) then
            if (before(1)*motion(1) < 0.0_wp) extremes = with(extremes, turning_point(law, &
              ends(i) + (j - 1)*step, ends(i) + j*step, inside))
          end if
          before = motion
        end do
      end do
    end do
  end function extremes_of

  !> Extremes among which another position is.
  pure function with(extremes, position)
    real(wp), intent(in) :: extremes(2), position
    real(wp) :: with(2)

    with = [min(extremes(1), position), max(extremes(2), position)]
  end function with

  !> The position between two times at which a drive turns back.
  pure real(wp) function turning_point(law, from, to, inside)
    type(crank_law_t), intent(in) :: law
    real(wp), intent(in) :: from, to !! with rates of different signs [s]
    real(wp), intent(in) :: inside   !! as for `crank_motion`

    integer, parameter :: halvings = 40
    real(wp) :: motion(0:2), first(0:2), a, b
    integer :: i

    a = from
    b = to
    first = crank_motion(law, a, inside)
    do i = 1, halvings
      motion = crank_motion(law, 0.5_wp*(a + b), inside)
      if (first(1)*motion(1) > 0.0_wp) then
        a = 0.5_wp*(a + b)
      else
        b = 0.5_wp*(a + b)
      end if
    end do
    turning_point = motion(0)
  end function turning_point

  !> A position in units of derivatives: rad of an angle, m of a length.
  pure real(wp) function unit_of(range)
    type(covered_range_t), intent(in) :: range

    unit_of = merge(degree, 1.0_wp, range%is_angle)
  end function unit_of

  !> Positions of a range: evenly over a turn from 0, else those of Chebyshev series.
  pure function positions_of(range, number) result(positions)
    type(covered_range_t), intent(in) :: range
    integer, intent(in) :: number
    real(wp) :: positions(number) !! [deg] or [m]

    integer :: k

    if (range%is_turn) then
      positions = [((360.0_wp*(k - 1))/number, k=1, number)]
    else
      positions = 0.5_wp*(range%from + range%to) + 0.5_wp*(range%to - range%from)* &
        chebyshev_nodes(number)
    end if
  end function positions_of

  !> Half of the way of a range [rad] or [m].
  pure real(wp) function half_of(range)
    type(covered_range_t), intent(in) :: range

    half_of = 0.5_wp*(range%to - range%from)*unit_of(range)
  end function half_of

  !> Where a position is in a range, from −1 to 1.
  pure real(wp) function place_in(range, position)
    type(covered_range_t), intent(in) :: range
    real(wp), intent(in) :: position !! [deg] or [m]

    place_in = (2.0_wp*position - range%from - range%to)/(range%to - range%from)
  end function place_in

end module crank_laws
