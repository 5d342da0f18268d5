!> The multipliers of free vibrations on their way round the unit circle as the speed of the crank
!! rises, known from slow motions: the angle of every vibration, in turns and with a sense.
!!
!! Of a pair of conjugate multipliers one stands for vibrations that run with the crank: that of
!! positive Krein signature. Its angle is `F/ω2` but for whole turns, F the Floquet frequency, and
!! falls with the speed by about `F/ω2 dω2/ω2`. Such multipliers keep their order round the circle;
!! numbers of modes, which follow their shapes, may pass from one to another.
module multiplier_angles
  use errors, only: error_t
  use fourier_transform, only: close_fourier, fourier_plan_t, open_fourier
  use kinds, only: wp
  use response_levels, only: level_t
  use slow_motions, only: slow_mode_t
  use turn_spectra, only: find_spectrum, turn_spectrum_t
  implicit none (type, external)
  private

  public :: angle_t, angles_t, find_angles, angles_of, match_angles, nearest_to_one, wrapped

  !> Actions below this have no certain sign; vibrations whose multipliers have met are as near as
  !! that in turns.
  real(wp), parameter :: uncertain = 0.05_wp, met = 0.02_wp

  !> Of multipliers as near to a place as each other that which is as fast is taken: turns for a
  !! vibration a turn.
  real(wp), parameter :: unlike = 0.01_wp

  !> The angle of a vibration.
  type :: angle_t
    integer :: mode = 0           !! its number
    real(wp) :: turns = 0.0_wp    !! −1/2 to 1/2
    real(wp) :: growth = 0.0_wp   !! mean real part of its exponents, per radian of the crank
    real(wp) :: apart = 0.0_wp    !! of real multipliers: how far exponents are from the mean
    real(wp) :: rate = 0.0_wp     !! vibrations a turn, by its shape
    logical :: is_real = .false.  !! its multipliers are
  end type angle_t

  !> The angles at a speed.
  type :: angles_t
    real(wp) :: speed = 0.0_wp              !! |ω2| [rad/s]
    type(angle_t), allocatable :: angle(:)  !! by number of mode; none if they cannot be found
  end type angles_t

contains

  !> The angles of the slowest vibrations at a speed.
  subroutine find_angles(level, slow, speed, modes, angles)
    type(level_t), intent(in) :: level      !! with this many slow coordinates, and followers
    integer, intent(in) :: slow
    real(wp), intent(in) :: speed           !! |ω2| [rad/s]
    integer, intent(in) :: modes            !! most that are wanted
    type(angles_t), intent(out) :: angles

    type(turn_spectrum_t) :: spectrum
    type(fourier_plan_t) :: plan
    type(error_t), allocatable :: error

    angles%speed = speed
    call open_fourier(level%grid%samples, plan)
    call find_spectrum(level, plan, slow, speed, spectrum, error)
    call close_fourier(plan)
    if (allocated(error)) then
      allocate (angles%angle(0))
    else
      angles%angle = angles_of(spectrum%mode, spectrum%number, speed, modes)
    end if
  end subroutine find_angles

  !> The angles of the vibrations with the lowest numbers.
  pure function angles_of(mode, number, speed, modes) result(angle)
    type(slow_mode_t), intent(in) :: mode(:) !! of a slow motion, with shape frequencies and actions
    integer, intent(in) :: number(:)         !! of the vibration of every mode
    real(wp), intent(in) :: speed            !! |ω2| [rad/s]
    integer, intent(in) :: modes
    type(angle_t), allocatable :: angle(:)

    integer :: b, k, other

    allocate (angle(min(modes, maxval([0, number]))))
    do b = 1, size(angle)
      associate (here => angle(b))
        k = findloc(number, b, dim=1)
        here%mode = b
        here%rate = mode(k)%shape_frequency/speed
        here%turns = aimag(mode(k)%exponent)
        here%growth = real(mode(k)%exponent)
        here%is_real = .not. mode(k)%is_complex
        if (here%is_real) then
          other = findloc(number, b, dim=1, back=.true.)
          here%growth = 0.5_wp*real(mode(k)%exponent + mode(other)%exponent)
          here%apart = abs(0.5_wp*real(mode(k)%exponent - mode(other)%exponent))
          if (here%turns > 0.25_wp) here%turns = 0.5_wp
        else if (abs(mode(k)%action) > uncertain) then
          here%turns = sign(here%turns, mode(k)%action)
        else
          other = partner_of(k)
          if (other > 0) then
            ! Of two that have met one runs with the crank, one against it.
            if (number(other) < b) here%turns = -here%turns
          else
            here%turns = sign(here%turns, mode(k)%action)
          end if
        end if
      end associate
    end do

  contains

    !> The mode whose multiplier a mode has met; 0: none.
    pure function partner_of(mine) result(nearest)
      integer, intent(in) :: mine
      integer :: nearest

      real(wp) :: apart, smallest
      integer :: i

      nearest = 0
      smallest = met
      do i = 1, size(mode)
        if (i == mine .or. .not. mode(i)%is_complex .or. abs(mode(i)%action) > uncertain .or. &
          number(i) == 0) cycle
        apart = abs(aimag(mode(i)%exponent - mode(mine)%exponent))
        if (apart >= smallest) cycle
        smallest = apart
        nearest = i
      end do
    end function partner_of

  end function angles_of

  !> Which angle of a speed became which of another that is near, by where they are expected, and
  !! how fast the vibrations are: one may pass another that stays where it is; the nearest first.
  pure subroutine match_angles(from, to, modes, partner, mismatch)
    type(angles_t), intent(in) :: from, to
    integer, intent(in) :: modes            !! of these the mismatch counts
    integer, intent(out) :: partner(:)      !! (angles of `from`) among those of `to`; 0: none
    real(wp), intent(out) :: mismatch       !! largest [turns]; huge where one has no partner

    real(wp), dimension(size(from%angle), size(to%angle)) :: apart, cost
    real(wp) :: expected(size(from%angle))
    integer :: at(2), i, k

    expected = from%angle%turns - from%angle%rate*log(to%speed/from%speed)
    do k = 1, size(to%angle)
      apart(:, k) = abs(wrapped(to%angle(k)%turns - expected))
      cost(:, k) = apart(:, k) + unlike*abs(to%angle(k)%rate - from%angle%rate)
    end do
    partner = 0
    mismatch = 0.0_wp
    if (min(size(from%angle), size(to%angle)) < modes) mismatch = huge(1.0_wp)
    do i = 1, min(size(from%angle), size(to%angle))
      at = minloc(cost)
      partner(at(1)) = at(2)
      if (min(at(1), at(2)) <= modes) mismatch = max(mismatch, apart(at(1), at(2)))
      cost(at(1), :) = huge(1.0_wp)
      cost(:, at(2)) = huge(1.0_wp)
    end do
  end subroutine match_angles

  !> Number of the angle nearest to 0; of several that of the vibration that is as fast as one
  !! known.
  pure function nearest_to_one(angle, rate) result(nearest)
    type(angle_t), intent(in) :: angle(:)
    real(wp), intent(in) :: rate        !! vibrations a turn
    integer :: nearest

    nearest = minloc(abs(angle%turns) + unlike*abs(angle%rate - rate), dim=1)
  end function nearest_to_one

  !> An angle between −1/2 and 1/2.
  elemental function wrapped(turns) result(angle)
    real(wp), intent(in) :: turns
    real(wp) :: angle

    angle = turns - anint(turns)
  end function wrapped

end module multiplier_angles
