!> The prescribed motion of the crank in time: at constant speed, or from rest with constant
!! acceleration up to it.
module crank_laws
  use constants, only: degree, two_pi
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: crank_law_t, crank_angle_at, crank_speed_at, crank_acceleration_at, time_of_turns

  type :: crank_law_t
    real(wp) :: start = 0.0_wp !! first crank angle [deg]
    real(wp) :: speed = 0.0_wp !! ω2, once it is constant; not 0 [rad/s]
    real(wp) :: ramp = 0.0_wp  !! time from rest to this speed; 0: it is constant from the start [s]
  end type crank_law_t

contains

  !> Crank angle [deg].
  elemental function crank_angle_at(law, time) result(angle)
    type(crank_law_t), intent(in) :: law
    real(wp), intent(in) :: time !! from 0 [s]
    real(wp) :: angle

    if (time < law%ramp) then
      angle = law%start + 0.5_wp*law%speed*time**2/law%ramp/degree
    else
      angle = law%start + law%speed*(time - 0.5_wp*law%ramp)/degree
    end if
  end function crank_angle_at

  !> ω2 [rad/s].
  elemental function crank_speed_at(law, time) result(speed)
    type(crank_law_t), intent(in) :: law
    real(wp), intent(in) :: time !! [s]
    real(wp) :: speed

    speed = law%speed
    if (time < law%ramp) speed = law%speed*(time/law%ramp)
  end function crank_speed_at

  !> α2 [rad/s²]; at the end of the ramp that after it.
  elemental function crank_acceleration_at(law, time) result(acceleration)
    type(crank_law_t), intent(in) :: law
    real(wp), intent(in) :: time !! [s]
    real(wp) :: acceleration

    acceleration = 0.0_wp
    if (time < law%ramp) acceleration = law%speed/law%ramp
  end function crank_acceleration_at

  !> When the crank has made a number of turns [s].
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
