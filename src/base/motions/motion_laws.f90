!> Motion laws: the rise from 0 to 1 in unit time, and motions of such rises with dwells between.
!!
!! Norton, *Cam Design and Manufacturing Handbook*, 2nd ed. 2009, chapters 3 and 4; Rothbart, *Cam
!! Design Handbook*, 2004, chapters 2 and 3. All of these laws are antimetric, s(1 − x) = 1 − s(x):
!! the second half follows from the first one.
module motion_laws
  use constants, only: pi
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: motion_segment_t, rise_values, motion_values
  public :: law_words, law_ramp, law_parabolic, law_harmonic, law_cycloidal, law_modified_sine, &
    law_modified_trapezoid, law_345, law_4567

  ! In the order of `law_words`.
  integer, parameter :: law_ramp = 1, law_parabolic = 2, law_harmonic = 3, law_cycloidal = 4, &
    law_modified_sine = 5, law_modified_trapezoid = 6, law_345 = 7, law_4567 = 8

  character(len=*), parameter :: law_words = "ramp parabolic harmonic cycloidal "// &
    "modified_sine modified_trapezoid polynomial_345 polynomial_4567"

  !> A rise or a return.
  type :: motion_segment_t
    integer :: law = 0           !! one of the law_… constants
    real(wp) :: start = 0.0_wp   !! [s]
    real(wp) :: stop = 0.0_wp    !! [s] after `start`
    real(wp) :: from = 0.0_wp    !! position at `start`, in any unit
    real(wp) :: to = 0.0_wp      !! position at `stop`, likewise
  end type motion_segment_t

contains

  !> Position, velocity and acceleration of a rise from 0 to 1.
  pure function rise_values(law, x) result(values)
    integer, intent(in) :: law  !! one of the law_… constants
    real(wp), intent(in) :: x   !! time, from 0 to 1
    real(wp) :: values(0:2)     !! s, s′, s″

    if (x <= 0.5_wp) then
      values = first_half(law, x)
    else
      values = [1.0_wp, 0.0_wp, 0.0_wp] - [1.0_wp, -1.0_wp, 1.0_wp]*first_half(law, 1.0_wp - x)
    end if
  end function rise_values

  !> The rise up to x = 1/2.
  pure function first_half(law, x) result(values)
    integer, intent(in) :: law
    real(wp), intent(in) :: x !! from 0 to 1/2
    real(wp) :: values(0:2)

    select case (law)
    case (law_ramp)
      values = [x, 1.0_wp, 0.0_wp]
    case (law_parabolic)
      values = [2.0_wp*x**2, 4.0_wp*x, 4.0_wp]
    case (law_harmonic)
      ! (1 − cos πx)/2, which is sin² without cancellation.
      values = [sin(0.5_wp*pi*x)**2, 0.5_wp*pi*sin(pi*x), 0.5_wp*pi**2*cos(pi*x)]
    case (law_cycloidal)
      values = [x - sin(2.0_wp*pi*x)/(2.0_wp*pi), 2.0_wp*sin(pi*x)**2, &
        2.0_wp*pi*sin(2.0_wp*pi*x)]
    case (law_modified_sine)
      values = modified_sine(x)
    case (law_modified_trapezoid)
      values = modified_trapezoid(x)
    case (law_345)
      values = [x**3*(10.0_wp - 15.0_wp*x + 6.0_wp*x**2), 30.0_wp*x**2*(1.0_wp - x)**2, &
        60.0_wp*x*(1.0_wp - x)*(1.0_wp - 2.0_wp*x)]
    case (law_4567)
      values = [x**4*(35.0_wp - 84.0_wp*x + 70.0_wp*x**2 - 20.0_wp*x**3), &
        140.0_wp*x**3*(1.0_wp - x)**3, 420.0_wp*x**2*(1.0_wp - x)**2*(1.0_wp - 2.0_wp*x)]
    case default
      values = 0.0_wp
    end select
  end function first_half

  !> Modified sine: the acceleration is a quarter of a sine up to x = 1/8, then goes through zero at
  !! x = 1/2 as half a cosine of three times the period. That the rise is 1 gives 4π²/(4 + π) for
  !! its greatest value.
  pure function modified_sine(x) result(values)
    real(wp), intent(in) :: x !! from 0 to 1/2
    real(wp) :: values(0:2)

    real(wp), parameter :: whole = 4.0_wp + pi
    real(wp) :: slow

    if (x <= 0.125_wp) then
      values = [pi*x - 0.25_wp*sin(4.0_wp*pi*x), 2.0_wp*pi*sin(2.0_wp*pi*x)**2, &
        4.0_wp*pi**2*sin(4.0_wp*pi*x)]/whole
    else
      slow = pi*(1.0_wp + 4.0_wp*x)/3.0_wp
      values = [2.0_wp + pi*x - 2.25_wp*sin(slow), pi*(1.0_wp - 3.0_wp*cos(slow)), &
        4.0_wp*pi**2*sin(slow)]/whole
    end if
  end function modified_sine

  !> Modified trapezoid: the acceleration rises as a quarter of a sine up to x = 1/8, is constant up
  !! to 3/8 and falls as a quarter of a cosine to zero at 1/2. That the rise is 1 gives 8π/(2 + π)
  !! for its greatest value.
  pure function modified_trapezoid(x) result(values)
    real(wp), intent(in) :: x !! from 0 to 1/2
    real(wp) :: values(0:2)

    real(wp), parameter :: most = 8.0_wp*pi/(2.0_wp + pi), unit = 1.0_wp/(4.0_wp*pi)
    real(wp) :: after

    if (x <= 0.125_wp) then
      values = [unit*x - unit**2*sin(x/unit), 2.0_wp*unit*sin(0.5_wp*x/unit)**2, sin(x/unit)]
    else if (x <= 0.375_wp) then
      after = x - 0.125_wp
      values = [0.125_wp*unit - unit**2 + unit*after + 0.5_wp*after**2, unit + after, 1.0_wp]
    else
      after = x - 0.375_wp
      values = [0.375_wp*unit - unit**2 + 0.03125_wp + (unit + 0.25_wp)*after + &
        2.0_wp*unit**2*sin(0.5_wp*after/unit)**2, unit + 0.25_wp + unit*sin(after/unit), &
        cos(after/unit)]
    end if
    values = most*values
  end function modified_trapezoid

  !> Position, velocity and acceleration of a motion of several segments: between them, before and
  !! behind them it stands still. Where they jump they are those of the time that follows.
  pure function motion_values(segments, time) result(values)
    type(motion_segment_t), intent(in) :: segments(:) !! (segments) one at least, one after the
                                                      !! other
    real(wp), intent(in) :: time                      !! [s]
    real(wp) :: values(0:2)                           !! [u, u/s, u/s²], u the unit of positions

    real(wp) :: way, duration
    integer :: i

    values = [segments(1)%from, 0.0_wp, 0.0_wp]
    do i = 1, size(segments)
      associate (segment => segments(i))
        if (time < segment%start) return
        values = [segment%to, 0.0_wp, 0.0_wp]
        if (time >= segment%stop) cycle
        way = segment%to - segment%from
        duration = segment%stop - segment%start
        values = rise_values(segment%law, (time - segment%start)/duration)
        ! From the end that is nearer, so that it is met exactly.
        if (values(0) <= 0.5_wp) then
          values(0) = segment%from + way*values(0)
        else
          values(0) = segment%to - way*(1.0_wp - values(0))
        end if
        values(1:) = way*values(1:)/[duration, duration**2]
        return
      end associate
    end do
  end function motion_values

end module motion_laws
