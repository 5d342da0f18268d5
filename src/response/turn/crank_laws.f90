!> The prescribed motion of the crank in time: at constant speed, from rest with constant
!! acceleration up to it, or by the law of the deck.
module crank_laws
  use chebyshev_series, only: chebyshev_nodes
  use constants, only: degree, two_pi
  use kinds, only: wp
  use motion_programs, only: motion_program_t, program_breaks, program_values_inside
  implicit none (type, external)
  private

  public :: crank_law_t, crank_range_t, crank_motion, crank_breaks, constant_from, time_of_turns, &
    range_of, positions_of, half_of, share_of

  !> Positions of the first drive that a motion covers: those of a turn, or of a part of the way.
  type :: crank_range_t
    logical :: is_turn = .true.
    real(wp) :: from = 0.0_wp, to = 360.0_wp !! [deg] or [m]
    real(wp) :: unit = degree                !! of a position [rad] or [m]
    real(wp) :: least = 1.0_wp               !! way that derivatives need [deg] or [m]
  end type crank_range_t

  !> Positions looked at between instants of a law.
  integer, parameter :: between = 16

  type :: crank_law_t
    real(wp) :: start = 0.0_wp !! first crank angle [deg]
    real(wp) :: speed = 0.0_wp !! ω2, once it is constant; not 0 [rad/s]
    real(wp) :: ramp = 0.0_wp  !! time from rest to this speed; 0: it is constant from the start [s]
    type(motion_program_t), allocatable :: program !! the position [deg] or [m], in place of the
                                                   !! above
    type(crank_range_t) :: range !! positions that the motion covers, their unit
  end type crank_law_t

contains

  !> Crank angle, speed and acceleration at a time of a smooth piece of the motion, up to its ends.
  pure function crank_motion(law, time, inside) result(motion)
    type(crank_law_t), intent(in) :: law
    real(wp), intent(in) :: time   !! from 0 [s]
    real(wp), intent(in) :: inside !! a time of the piece, not at its ends [s]
    real(wp) :: motion(0:2)        !! [deg, rad/s, rad/s²] or [m, m/s, m/s²]

    if (allocated(law%program)) then
      motion = program_values_inside(law%program, time, inside)*[1.0_wp, law%range%unit, &
        law%range%unit]
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

  !> The positions that a motion covers from the first time to the last.
  pure function range_of(law, time) result(range)
    type(crank_law_t), intent(in) :: law
    real(wp), intent(in) :: time(:)  !! rising [s]
    type(crank_range_t) :: range

    real(wp), allocatable :: ends(:)
    real(wp) :: motion(0:2), least, most
    integer :: i, j, k

    range = law%range
    least = huge(least)
    most = -huge(most)
    do k = 1, size(time) - 1
      ends = [time(k), crank_breaks(law, time(k), time(k + 1)), time(k + 1)]
      do i = 1, size(ends) - 1
        do j = 0, between
          motion = crank_motion(law, ends(i) + (ends(i + 1) - ends(i))*j/between, &
            0.5_wp*(ends(i) + ends(i + 1)))
          least = min(least, motion(0))
          most = max(most, motion(0))
        end do
      end do
    end do
    range%is_turn = range%unit < 1.0_wp .and. most - least >= 360.0_wp
    if (range%is_turn) return
    range%to = max(most, 0.5_wp*(least + most + range%least))
    range%from = min(least, range%to - range%least)
  end function range_of

  !> Positions of a range: evenly over a turn from 0, else those of Chebyshev series.
  pure function positions_of(range, number) result(positions)
    type(crank_range_t), intent(in) :: range
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
    type(crank_range_t), intent(in) :: range

    half_of = 0.5_wp*(range%to - range%from)*range%unit
  end function half_of

  !> Where a position is in a range, from −1 to 1.
  pure real(wp) function share_of(range, position)
    type(crank_range_t), intent(in) :: range
    real(wp), intent(in) :: position !! [deg] or [m]

    share_of = (2.0_wp*position - range%from - range%to)/(range%to - range%from)
  end function share_of

end module crank_laws
