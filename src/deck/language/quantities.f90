!> Values with the exponents of their units, as arithmetic in SET carries them.
!!
!! A value is in the units of the deck's bare numbers, an angle in degrees or, where it is written
!! so, in radians. Thus 320mm − 2*40mm is 240mm and 2*15deg is 30deg to the last digit, which metres
!! and radians would round.
module quantities
  use constants, only: degree, pi
  use errors, only: error_t
  use kinds, only: wp
  use numbers, only: number_length, read_real, shortest_text
  use text, only: to_string
  use units, only: coherent_factor, coherent_unit, dimension_name, dimension_none, read_unit, &
    unit_system_t, unit_t
  implicit none (type, external)
  private

  public :: quantity_t, read_number, take_unit, are_alike, match_angles, multiply, raise, &
    quantity_text, product_text, kind_text

  type :: quantity_t
    real(wp) :: value = 0.0_wp    !! in units of bare lengths, masses and times, and an angle's
    integer :: dimension(4) = 0   !! exponents of length, mass, time, angle
    logical :: in_radians = .false. !! of an angle; else it is in degrees
    integer :: step = 0           !! of a formula over time, which gives it: its value says nothing;
                                  !! 0: it does not depend on the time
  end type quantity_t

  !> Units are written with one digit for a power.
  integer, parameter :: largest_power = 9

contains

  !> Reads a number with or without a unit; a bare one is a pure number.
  pure subroutine read_number(text, system, found, fine)
    character(len=*), intent(in) :: text      !! `240mm`, `-3`, …
    type(unit_system_t), intent(in) :: system !! units of bare numbers
    type(quantity_t), intent(out) :: found
    logical, intent(out) :: fine              !! whether the text is nothing else

    type(unit_t) :: measure
    type(error_t), allocatable :: error
    integer :: length

    length = number_length(text)
    fine = length > 0
    if (.not. fine) return
    call read_real(text(:length), found%value, error)
    fine = .not. allocated(error)
    if (.not. fine .or. length == len(text)) return
    call read_unit(text(length + 1:), dimension_none, measure, error)
    fine = .not. allocated(error)
    if (fine) call take_unit(measure, system, found)
  end subroutine read_number

  !> Makes a pure number one of a unit.
  !!
  !! The factor is the quotient of two whole numbers in most decks, and reduced to the smallest:
  !! 0.1mm stays 0.1 in a deck of mm.
  pure subroutine take_unit(measure, system, quantity)
    type(unit_t), intent(in) :: measure           !! as read
    type(unit_system_t), intent(in) :: system     !! units of bare numbers
    type(quantity_t), intent(inout) :: quantity   !! a pure number before

    type(unit_t) :: base
    real(wp) :: numerator, denominator
    integer :: power

    base = coherent_factor(system, [measure%dimension(:3), 0])
    numerator = measure%numerator*base%denominator
    denominator = measure%denominator*base%numerator
    quantity%dimension = measure%dimension
    quantity%in_radians = index(measure%name, "deg") + index(measure%name, "rpm") == 0
    power = measure%dimension(4)
    if (.not. quantity%in_radians) then
      ! A degree is π/180: without π both are whole numbers again.
      if (power > 0) numerator = whole(numerator/pi**power)*180.0_wp**power
      if (power < 0) denominator = whole(denominator/pi**(-power))*180.0_wp**(-power)
    end if
    call reduce(numerator, denominator)
    quantity%value = quantity%value*numerator/denominator
  end subroutine take_unit

  !> A number, or the whole number from which it differs by rounding.
  pure function whole(number)
    real(wp), intent(in) :: number
    real(wp) :: whole

    whole = number
    if (abs(number - anint(number)) <= 4.0_wp*epsilon(number)*abs(number)) whole = anint(number)
  end function whole

  !> Reduces a fraction of whole numbers; one that differs from 1 by rounding becomes 1.
  pure subroutine reduce(numerator, denominator)
    real(wp), intent(inout) :: numerator, denominator !! above 0

    real(wp), parameter :: rounding = 1.0e-12_wp, largest_whole = 2.0_wp**53
    real(wp) :: a, b, rest

    if (abs(numerator - denominator) <= rounding*denominator) then
      numerator = 1.0_wp
      denominator = 1.0_wp
    end if
    a = max(numerator, denominator)
    b = min(numerator, denominator)
    if (a > largest_whole .or. abs(a - anint(a)) + abs(b - anint(b)) > 0.0_wp) return
    do while (b > 0.0_wp)
      rest = mod(a, b)
      a = b
      b = rest
    end do
    numerator = numerator/a
    denominator = denominator/a
  end subroutine reduce

  !> Whether two values may be added.
  pure function are_alike(one, other) result(are)
    type(quantity_t), intent(in) :: one, other
    logical :: are

    are = all(one%dimension == other%dimension)
  end function are_alike

  !> Gives a value the unit of angles that another one has.
  pure subroutine match_angles(one, other)
    type(quantity_t), intent(in) :: one
    type(quantity_t), intent(inout) :: other

    if (one%dimension(4) == 0) return
    if (other%dimension(4) /= 0 .and. (one%in_radians .neqv. other%in_radians)) then
      if (one%in_radians) other%value = other%value*degree**other%dimension(4)
      if (other%in_radians) other%value = other%value/degree**other%dimension(4)
    end if
    other%in_radians = one%in_radians
  end subroutine match_angles

  !> Multiplies by another value, or divides by it.
  pure subroutine multiply(found, other, divides)
    type(quantity_t), intent(inout) :: found
    type(quantity_t), intent(in) :: other !! not 0, if it divides
    logical, intent(in) :: divides

    type(quantity_t) :: factor

    factor = other
    call match_angles(found, factor)
    if (divides) then
      found%value = found%value/factor%value
      found%dimension = found%dimension - factor%dimension
    else
      found%value = found%value*factor%value
      found%dimension = found%dimension + factor%dimension
    end if
    found%in_radians = factor%in_radians
  end subroutine multiply

  !> Raises a value to a power.
  pure subroutine raise(found, power, system, message)
    type(quantity_t), intent(inout) :: found
    type(quantity_t), intent(in) :: power
    type(unit_system_t), intent(in) :: system             !! units of bare numbers, for the message
    character(len=:), allocatable, intent(out) :: message !! why it has none; empty: it has one

    real(wp), parameter :: largest_exponent = 1.0e9_wp
    real(wp) :: exponents(4)
    logical :: is_whole

    message = ""
    exponents = power%value*found%dimension
    is_whole = .not. abs(power%value - anint(power%value)) > 0.0_wp
    if (any(power%dimension /= 0)) then
      message = "an exponent is a pure number, not "//kind_text(power, system)
    else if (any(abs(exponents - anint(exponents)) > 0.0_wp) .or. &
      any(abs(exponents) > 9*largest_power)) then
      message = kind_text(found, system)//" has no power of "//to_string(power%value)
    else if (abs(power%value) > largest_exponent) then
      message = "this exponent is too large"
    else if (found%value < 0.0_wp .and. .not. is_whole) then
      message = "a negative number has no power of "//to_string(power%value)
    else if (.not. abs(found%value) > 0.0_wp .and. power%value < 0.0_wp) then
      message = "0 has no negative power"
    else if (is_whole) then
      found%value = found%value**nint(power%value)
    else
      found%value = found%value**power%value
    end if
    if (len(message) == 0) found%dimension = nint(exponents)
  end subroutine raise

  !> `240mm`: a value as a word of the deck, which reads back to the same double; empty if its unit
  !! cannot stand behind a number.
  pure function quantity_text(quantity, system) result(text)
    type(quantity_t), intent(in) :: quantity
    type(unit_system_t), intent(in) :: system !! units of bare numbers
    character(len=:), allocatable :: text

    text = unit_text(quantity, system)
    if (index(text, "1/") == 1 .or. any(abs(quantity%dimension) > largest_power)) then
      text = ""
    else
      ! The sum has no minus sign where the value is −0.
      text = shortest_text(quantity%value + 0.0_wp)//text
    end if
  end function quantity_text

  !> `3*1s**-1`: a value in any unit as arithmetic, which has the same double.
  pure function product_text(quantity, system) result(text)
    type(quantity_t), intent(in) :: quantity
    type(unit_system_t), intent(in) :: system !! units of bare numbers
    character(len=:), allocatable :: text

    type(quantity_t) :: base
    integer :: i

    text = shortest_text(quantity%value + 0.0_wp)
    base%in_radians = quantity%in_radians
    do i = 1, size(quantity%dimension)
      if (quantity%dimension(i) == 0) cycle
      base%dimension = 0
      base%dimension(i) = 1
      text = text//"*1"//unit_text(base, system)//"**"//to_string(quantity%dimension(i))
    end do
  end function product_text

  !> `mm`, `kg/mm/s2`, `deg/s`, `1/s`; empty for a pure number.
  pure function unit_text(quantity, system) result(text)
    type(quantity_t), intent(in) :: quantity
    type(unit_system_t), intent(in) :: system
    character(len=:), allocatable :: text

    type(unit_t) :: measure
    character(len=:), allocatable :: angle
    integer :: i, division

    measure = coherent_unit(system, [quantity%dimension(:3), 0])
    text = measure%name
    if (text == "-") text = ""
    ! A factor behind the stroke has one of its own on cards.
    division = index(text//"/", "/")
    do i = 1, len(text)
      if (text(i:i) == ".") text(i:i) = merge("*", "/", i < division)
    end do
    if (quantity%dimension(4) == 0) return
    angle = trim(merge("rad", "deg", quantity%in_radians))
    if (abs(quantity%dimension(4)) > 1) angle = angle//to_string(abs(quantity%dimension(4)))
    if (quantity%dimension(4) < 0) then
      if (len(text) == 0) text = "1"
      text = text//"/"//angle
    else if (index(text, "1/") == 1) then
      text = angle//text(2:)
    else if (len(text) > 0) then
      text = angle//"*"//text
    else
      text = angle
    end if
  end function unit_text

  !> `a length`, `a value in mm*kg`: what a value is, for messages.
  pure function kind_text(quantity, system) result(text)
    type(quantity_t), intent(in) :: quantity
    type(unit_system_t), intent(in) :: system !! units of bare numbers
    character(len=:), allocatable :: text

    text = dimension_name(quantity%dimension)
    if (text == "a quantity of another kind") text = "a value in "//unit_text(quantity, system)
  end function kind_text

end module quantities
