!> Sine and cosine of degrees: exact at multiples of 30° and 90°, which π would round.
module degree_functions
  use constants, only: degree
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: sine_of_degrees, cosine_of_degrees

contains

  !> Sine of degrees.
  pure function sine_of_degrees(degrees) result(value)
    real(wp), intent(in) :: degrees
    real(wp) :: value, a

    a = mod(abs(degrees), 360.0_wp)
    if (a > 180.0_wp) then
      value = -quarter_sine(min(a - 180.0_wp, 360.0_wp - a))
    else
      value = quarter_sine(min(a, 180.0_wp - a))
    end if
    if (degrees < 0.0_wp) value = -value
  end function sine_of_degrees

  !> Cosine of degrees.
  pure function cosine_of_degrees(degrees) result(value)
    real(wp), intent(in) :: degrees
    real(wp) :: value, a

    a = mod(abs(degrees), 360.0_wp)
    if (a > 180.0_wp) a = 360.0_wp - a
    if (a > 90.0_wp) then
      value = -quarter_cosine(180.0_wp - a)
    else
      value = quarter_cosine(a)
    end if
  end function cosine_of_degrees

  !> Sine of degrees from 0 to 90. The differences are without rounding where they are small.
  pure function quarter_sine(a) result(value)
    real(wp), intent(in) :: a
    real(wp) :: value

    if (a > 45.0_wp) then
      value = cos((90.0_wp - a)*degree)
    else if (abs(a - 30.0_wp) > 0.0_wp) then
      value = sin(a*degree)
    else
      value = 0.5_wp
    end if
  end function quarter_sine

  !> Cosine of degrees from 0 to 90. That of 45 is its sine.
  pure function quarter_cosine(a) result(value)
    real(wp), intent(in) :: a
    real(wp) :: value

    if (a < 45.0_wp) then
      value = cos(a*degree)
    else if (abs(a - 60.0_wp) > 0.0_wp) then
      value = sin((90.0_wp - a)*degree)
    else
      value = 0.5_wp
    end if
  end function quarter_cosine

end module degree_functions
