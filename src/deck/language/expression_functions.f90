!> Functions in the arithmetic of SET.
!!
!! An inverse function gives the whole number of degrees that has its value: asin(0.5) is 30deg.
module expression_functions
  use constants, only: degree
  use degree_functions, only: cosine_of_degrees, sine_of_degrees
  use kinds, only: wp
  use quantities, only: kind_text, match_angles, quantity_t
  use text, only: string_t, word_list
  use units, only: dimension_angle, dimension_none, unit_system_t
  implicit none (type, external)
  private

  public :: function_names, count_values, apply_function

  character(len=*), parameter :: of_one = "sin cos tan asin acos atan sqrt abs", &
    of_two = "atan2 min max hypot"

contains

  !> All functions.
  pure function function_names() result(names)
    type(string_t), allocatable :: names(:)

    names = word_list(of_one//" "//of_two)
  end function function_names

  !> How many values a function has: 1 or 2; 0 if there is none of this name.
  pure function count_values(name) result(count)
    character(len=*), intent(in) :: name !! letters and digits
    integer :: count

    count = 0
    if (index(" "//of_one//" ", " "//name//" ") > 0) count = 1
    if (index(" "//of_two//" ", " "//name//" ") > 0) count = 2
  end function count_values

  !> Gives a function its values.
  pure subroutine apply_function(name, other, system, found, message)
    character(len=*), intent(in) :: name                  !! of `function_names`
    type(quantity_t), intent(in) :: other                 !! the second value, of the kind of the
                                                          !! first; not used by functions of one
    type(unit_system_t), intent(in) :: system             !! units of bare numbers, for the message
    type(quantity_t), intent(inout) :: found              !! the first value; the result
    character(len=:), allocatable, intent(out) :: message !! why there is none; empty: there is one

    type(quantity_t) :: second

    message = ""
    second = other
    call match_angles(found, second)
    select case (name)
    case ("sin", "cos", "tan")
      call apply_circular(name, system, found, message)
    case ("asin", "acos", "atan")
      call apply_inverse(name, system, found, message)
    case ("atan2")
      if (abs(found%value) + abs(second%value) > 0.0_wp) then
        found = quantity_t(angle_of(found%value, second%value), dimension_angle)
      else
        message = "'atan2' of 0 and 0 is no angle"
      end if
    case ("sqrt")
      if (any(modulo(found%dimension, 2) > 0)) then
        message = kind_text(found, system)//" has no square root, as an area has"
      else if (found%value < 0.0_wp) then
        message = "a negative number has no square root"
      else
        found%value = sqrt(found%value)
        found%dimension = found%dimension/2
      end if
    case ("abs")
      found%value = abs(found%value)
    case ("min")
      found%value = min(found%value, second%value)
    case ("max")
      found%value = max(found%value, second%value)
    case ("hypot")
      found%value = hypot(found%value, second%value)
    end select
  end subroutine apply_function

  !> Sine, cosine and tangent of an angle.
  pure subroutine apply_circular(name, system, found, message)
    character(len=*), intent(in) :: name
    type(unit_system_t), intent(in) :: system
    type(quantity_t), intent(inout) :: found
    character(len=:), allocatable, intent(inout) :: message

    real(wp) :: s, c

    if (any(found%dimension /= dimension_angle)) then
      message = "'"//name//"' is of an angle, not of "//kind_text(found, system)
      if (all(found%dimension == dimension_none)) message = message//"; degrees are written 10deg"
      return
    end if
    if (found%in_radians) then
      s = sin(found%value)
      c = cos(found%value)
    else
      s = sine_of_degrees(found%value)
      c = cosine_of_degrees(found%value)
    end if
    found%dimension = dimension_none
    if (name == "sin") found%value = s
    if (name == "cos") found%value = c
    if (name /= "tan") return
    if (abs(c) > 0.0_wp) then
      found%value = s/c
    else
      message = "the tangent of a right angle is infinite"
    end if
  end subroutine apply_circular

  !> The angle of a sine, cosine or tangent.
  pure subroutine apply_inverse(name, system, found, message)
    character(len=*), intent(in) :: name
    type(unit_system_t), intent(in) :: system
    type(quantity_t), intent(inout) :: found
    character(len=:), allocatable, intent(inout) :: message

    real(wp) :: x, nearest

    x = found%value
    if (any(found%dimension /= dimension_none)) then
      message = "'"//name//"' is of a pure number, not of "//kind_text(found, system)
    else if (name /= "atan" .and. abs(x) > 1.0_wp) then
      message = "'"//name//"' is of a number from -1 to 1"
    else
      found = quantity_t(0.0_wp, dimension_angle)
      if (name == "atan") found%value = angle_of(x, 1.0_wp)
      if (name == "asin") found%value = asin(x)/degree
      if (name == "acos") found%value = acos(x)/degree
      nearest = anint(found%value)
      if (name == "asin" .and. .not. abs(sine_of_degrees(nearest) - x) > 0.0_wp) &
        found%value = nearest
      if (name == "acos" .and. .not. abs(cosine_of_degrees(nearest) - x) > 0.0_wp) &
        found%value = nearest
    end if
  end subroutine apply_inverse

  !> `atan2` in degrees.
  pure function angle_of(y, x) result(degrees)
    real(wp), intent(in) :: y, x
    real(wp) :: degrees, nearest

    degrees = atan2(y, x)/degree
    nearest = anint(degrees)
    if (.not. abs(y*cosine_of_degrees(nearest) - x*sine_of_degrees(nearest)) > 0.0_wp) &
      degrees = nearest
  end function angle_of

end module expression_functions
