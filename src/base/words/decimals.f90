!> Decimal numbers as whole numbers times powers of ten, whose sums have no rounding: the tenth of
!! ten steps of 0.05 from 1 is then 1.5, and the nineteenth 1.95.
module decimals
  use errors, only: error_t
  use kinds, only: long, wp
  use numbers, only: number_length, read_real
  use text, only: to_string
  implicit none (type, external)
  private

  public :: decimal_t, decimal_of, decimal_point, decimal_value

  !> digits × 10**power
  type :: decimal_t
    logical :: is_exact = .false.     !! false: the number has too many digits for this type
    integer(long) :: digits = 0_long
    integer :: power = 0
  end type decimal_t

  !> Whole numbers below `largest` can be added to each other; text of more than `most_digits`
  !! digits is not taken.
  integer(long), parameter :: largest = 4000000000000000000_long
  integer, parameter :: most_digits = 17

contains

  !> The number in a text; not exact if it has more than 17 digits, from the first that is not 0 to
  !! the last, or more than four characters after the letter of its exponent.
  pure function decimal_of(string) result(number)
    character(len=*), intent(in) :: string !! a number as decks have them, with e, E, d or D before
                                           !! its exponent, and nothing else
    type(decimal_t) :: number

    integer :: at, exponent, digits
    logical :: after_point

    if (len(string) == 0 .or. number_length(string) /= len(string)) return
    digits = 0
    after_point = .false.
    do at = 1, len(string)
      select case (string(at:at))
      case ("0":"9")
        number%digits = 10_long*number%digits + (iachar(string(at:at)) - iachar("0"))
        if (number%digits > 0_long) digits = digits + 1
        if (digits > most_digits) return
        if (after_point) number%power = number%power - 1
      case (".")
        after_point = .true.
      case ("+", "-")
      case default
        exit
      end select
    end do
    if (string(1:1) == "-") number%digits = -number%digits
    if (at < len(string)) then
      if (len(string) - at > 4) return
      exponent = 0
      do digits = at + 1, len(string)
        if (scan(string(digits:digits), "+-") > 0) cycle
        exponent = 10*exponent + (iachar(string(digits:digits)) - iachar("0"))
      end do
      if (string(at + 1:at + 1) == "-") exponent = -exponent
      number%power = number%power + exponent
    end if
    number%is_exact = .true.
  end function decimal_of

  !> first + count × step; not exact if either is not, or if they are too unlike in size.
  pure function decimal_point(first, step, count) result(point)
    type(decimal_t), intent(in) :: first, step
    integer, intent(in) :: count !! from 0
    type(decimal_t) :: point

    integer(long) :: factors(2)
    integer :: shifts(2)

    if (.not. (first%is_exact .and. step%is_exact)) return
    point%power = min(first%power, step%power)
    if (first%digits == 0_long) point%power = step%power
    if (step%digits == 0_long) point%power = first%power
    shifts = max(0, [first%power, step%power] - point%power)
    where ([first%digits, step%digits] == 0_long) shifts = 0
    if (any(shifts > most_digits)) return
    factors = 10_long**shifts
    if (abs(first%digits) > largest/factors(1)) return
    if (abs(step%digits) > largest/factors(2)/max(1, count)) return
    point%digits = first%digits*factors(1) + count*(step%digits*factors(2))
    point%is_exact = .true.
  end function decimal_point

  !> The nearest real number: what `read_real` makes of the same digits.
  pure function decimal_value(number) result(value)
    type(decimal_t), intent(in) :: number !! exact
    real(wp) :: value

    ! Whole numbers below 10**15 and powers of ten up to 10**22 are doubles; so their product or
    ! quotient is rounded once.
    integer(long), parameter :: exact_whole = 1000000000000000_long
    integer, parameter :: exact_power = 22
    type(error_t), allocatable :: error

    if (number%digits == 0_long) then
      value = 0.0_wp
    else if (abs(number%digits) < exact_whole .and. abs(number%power) <= exact_power) then
      value = real(number%digits, wp)
      if (number%power > 0) value = value*10.0_wp**number%power
      if (number%power < 0) value = value/10.0_wp**(-number%power)
    else
      call read_real(to_string(number%digits)//"e"//to_string(number%power), value, error)
    end if
  end function decimal_value

end module decimals
