!> The gear between a motor and what it drives, and the rotor of the motor.
!!
!! With the ratio n of the shaft's turns to those of the driven body, whose rate is ω, the torque
!! `Tg = Tm − J n ω̇` goes from the motor through the gear: what it gives less what turns its rotor.
!! On the driven body acts `n η Tg` where power flows from the motor, and `n Tg/η` where it flows
!! back. Both are `n s Tg` with the share `s = η**tanh(±ω/smooth)`, whose sign is that of n Tg: it
!! changes smoothly where the motion turns round, where the power is nothing and s is 1.
module gears
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: gear_t, driven_t, gear_share, reflected_inertia, driven_by, is_direct, rotor_energy

  !> A gear and a rotor; by default the motor turns the driven body itself.
  type :: gear_t
    real(wp) :: ratio = 1.0_wp      !! n, turns of the motor per turn of the driven body; negative:
                                    !! against it [-]
    real(wp) :: rotor = 0.0_wp      !! J, moment of inertia of all that turns with the motor [kg m²]
    real(wp) :: efficiency = 1.0_wp !! η, above 0, at most 1 [-]
    real(wp) :: smooth = 0.01_wp    !! rate of the driven body within which losses change their
                                    !! sign smoothly [rad/s]
  end type gear_t

  !> Motor and gear at an instant.
  type :: driven_t
    real(wp) :: motor = 0.0_wp   !! Tm, torque of the motor on its shaft and rotor [N m]
    real(wp) :: through = 0.0_wp !! Tg, through the gear, at the motor's shaft [N m]
    real(wp) :: torque = 0.0_wp  !! on the driven body [N m]
    real(wp) :: power = 0.0_wp   !! of the motor [W]
    real(wp) :: loss = 0.0_wp    !! in the gear, 0 or more [W]
    real(wp) :: to_rotor = 0.0_wp !! rate of the rotor's kinetic energy [W]
  end type driven_t

contains

  !> Whether the torque of the motor times the ratio is that on the driven body, whatever its
  !! acceleration.
  elemental function is_direct(gear) result(is)
    type(gear_t), intent(in) :: gear
    logical :: is

    is = gear%rotor <= 0.0_wp .and. gear%efficiency >= 1.0_wp
  end function is_direct

  !> The share s: torque on the driven body over n times the torque through the gear [-].
  elemental function gear_share(gear, rate, through) result(share)
    type(gear_t), intent(in) :: gear
    real(wp), intent(in) :: rate    !! ω of the driven body [rad/s]
    real(wp), intent(in) :: through !! Tg, of which only the sign counts [N m]
    real(wp) :: share

    share = 1.0_wp
    if (gear%efficiency >= 1.0_wp) return
    share = exp(log(gear%efficiency)*tanh(sign(1.0_wp, gear%ratio*through)*rate/gear%smooth))
  end function gear_share

  !> Moment of inertia that the rotor adds to the driven body, s n² J [kg m²].
  elemental function reflected_inertia(gear, share) result(inertia)
    type(gear_t), intent(in) :: gear
    real(wp), intent(in) :: share !! of `gear_share`
    real(wp) :: inertia

    inertia = share*gear%ratio**2*gear%rotor
  end function reflected_inertia

  !> Kinetic energy of the rotor [J].
  elemental function rotor_energy(gear, rate) result(energy)
    type(gear_t), intent(in) :: gear
    real(wp), intent(in) :: rate !! ω of the driven body [rad/s]
    real(wp) :: energy

    energy = 0.5_wp*gear%rotor*(gear%ratio*rate)**2
  end function rotor_energy

  !> Torques and powers of motor and gear while the driven body moves.
  elemental function driven_by(gear, motor, share, rate, acceleration) result(driven)
    type(gear_t), intent(in) :: gear
    real(wp), intent(in) :: motor        !! Tm [N m]
    real(wp), intent(in) :: share        !! of `gear_share`
    real(wp), intent(in) :: rate         !! ω [rad/s]
    real(wp), intent(in) :: acceleration !! ω̇ [rad/s²]
    type(driven_t) :: driven

    real(wp) :: speed

    speed = gear%ratio*rate
    driven%motor = motor
    driven%through = motor - gear%rotor*gear%ratio*acceleration
    driven%torque = gear%ratio*share*driven%through
    driven%power = motor*speed
    driven%loss = (1.0_wp - share)*driven%through*speed
    driven%to_rotor = gear%rotor*gear%ratio*acceleration*speed
  end function driven_by

end module gears
