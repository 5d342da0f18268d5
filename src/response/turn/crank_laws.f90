!> The prescribed motion of the crank in time: at constant speed, from rest with constant
!! acceleration up to it, or by the law of the deck.
module crank_laws
  use constants, only: degree, two_pi
  use kinds, only: wp
  use motion_programs, only: motion_program_t, program_breaks, program_values_inside
  implicit none (type, external)
  private

  public :: crank_law_t, crank_motion, crank_breaks, constant_from, time_of_turns

  type :: crank_law_t
    real(wp) :: start = 0.0_wp !! first crank angle [deg]
    real(wp) :: speed = 0.0_wp !! ω2, once it is constant; not 0 [rad/s]
    real(wp) :: ramp = 0.0_wp  !! time from rest to this speed; 0: it is constant from the start [s]
    type(motion_program_t), allocatable :: program !! the angle in degrees, in place of the above
  end type crank_law_t

contains

  !> Crank angle, speed and acceleration at a time of a smooth piece of the motion, up to its ends.
  pure function crank_motion(law, time, inside) result(motion)
    type(crank_law_t), intent(in) :: law
    real(wp), intent(in) :: time   !! from 0 [s]
    real(wp), intent(in) :: inside !! a time of the piece, not at its ends [s]
    real(wp) :: motion(0:2)        !! [deg, rad/s, rad/s²]

    if (allocated(law%program)) then
      motion = program_values_inside(law%program, time, inside)*[1.0_wp, degree, degree]
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

end module crank_laws
