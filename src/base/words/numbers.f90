!> The one converter from text to numbers.
!!
!! Fortran's own list-directed `read` takes `/`, `1,000`, `2*3.5` and `nan` for numbers; a deck must
!! not.
module numbers
  use, intrinsic :: ieee_exceptions, only: ieee_get_halting_mode, ieee_overflow, ieee_set_flag, &
    ieee_set_halting_mode
  use errors, only: error_of_input, error_t, set_error
  use kinds, only: long, wp
  use text, only: to_string
  implicit none (type, external)
  private

  public :: number_length, read_real, read_integer, shortest_text

  !> Powers of ten of 0.d… beyond these are no doubles. Half the distance of two doubles has at most
  !! 767 digits; the last of more only says whether one of those that follow is not 0.
  integer(long), parameter :: largest_power = 340
  integer, parameter :: most_digits = 780, longest_decimal = most_digits + 16

contains

  !> How many leading characters of `string` form a number; 0 if it does not begin with one.
  !!
  !! A number is `[sign] digits [. digits] [e|d [sign] digits]` with at least one digit before the
  !! exponent. The letter is an exponent only before a digit or a sign, so that `10deg` is 10 and a
  !! unit.
  pure function number_length(string) result(length)
    character(len=*), intent(in) :: string !! that may go on with a unit
    integer :: length

    integer :: at, whole, fraction, exponent_start

    length = 0
    at = 1
    if (at <= len(string)) then
      if (scan(string(at:at), "+-") == 1) at = at + 1
    end if
    whole = count_digits(string, at)
    at = at + whole
    fraction = 0
    if (at <= len(string)) then
      if (string(at:at) == ".") then
        fraction = count_digits(string, at + 1)
        at = at + 1 + fraction
      end if
    end if
    if (whole + fraction == 0) return
    length = at - 1

    if (at + 1 > len(string)) return
    if (scan(string(at:at), "eEdD") == 0) return
    exponent_start = at + 1
    if (scan(string(at + 1:at + 1), "+-") == 1) exponent_start = at + 2
    if (exponent_start > at + 1 .or. count_digits(string, exponent_start) > 0) then
      length = exponent_start - 1 + count_digits(string, exponent_start)
    end if
  end function number_length

  !> Number of consecutive decimal digits from position `start` on.
  pure function count_digits(string, start) result(count)
    character(len=*), intent(in) :: string
    integer, intent(in) :: start
    integer :: count

    count = 0
    do while (start + count <= len(string))
      if (scan(string(start + count:start + count), "0123456789") == 0) exit
      count = count + 1
    end do
  end function count_digits

  !> Reads a text that is a number and nothing else.
  !!
  !! Errors: the text is not a number that a double can hold.
  pure subroutine read_real(string, value, error)
    character(len=*), intent(in) :: string !! with e, E, d or D before its exponent
    real(wp), intent(out) :: value         !! 0 if there is an error
    type(error_t), allocatable, intent(out) :: error !! without a place

    character(len=longest_decimal) :: decimal
    character(len=16) :: form
    integer(long) :: power
    integer :: length, status
    logical :: halts, done

    value = 0.0_wp
    if (number_length(string) /= len(string) .or. len(string) == 0) then
      call set_error(error, error_of_input, "'"//string//"' is not a number")
      return
    end if
    if (scan(string(len(string):), "+-") == 1) then
      call set_error(error, error_of_input, "the exponent of '"//string//"' has no digits")
      return
    end if
    call read_short(string, value, done)
    if (done) return
    call write_decimal(string, decimal, length, power)
    if (length == 0) then
      value = sign(0.0_wp, merge(-1.0_wp, 1.0_wp, string(1:1) == "-"))
      return
    end if
    if (abs(power) <= largest_power) then
      write (decimal(length + 1:), "(a,i0)") "e", power
      write (form, "(a,i0,a)") "(f", len_trim(decimal), ".0)"
      ! A number out of range is an error of the user: no trap, even where overflow traps.
      call ieee_get_halting_mode(ieee_overflow, halts)
      call ieee_set_halting_mode(ieee_overflow, .false.)
      read (decimal, form, iostat=status) value
      call ieee_set_flag(ieee_overflow, .false.)
      call ieee_set_halting_mode(ieee_overflow, halts)
    end if
    if (power > largest_power .or. abs(value) > huge(value)) then
      call set_error(error, error_of_input, "'"//string//"' is too large for a number")
    else if (power < -largest_power .or. abs(value) < tiny(value)) then
      call set_error(error, error_of_input, "'"//string//"' is too small for a number")
    end if
    if (allocated(error)) value = 0.0_wp
  end subroutine read_real

  !> A number as `-0.123` times a power of ten, with its digits from the first that is not 0 on. Of
  !! more than any double can depend on, the last one stands for all that follow.
  pure subroutine write_decimal(string, decimal, length, power)
    character(len=*), intent(in) :: string          !! a number
    character(len=longest_decimal), intent(out) :: decimal
    integer, intent(out) :: length                  !! of the decimal; 0: the number is 0
    integer(long), intent(out) :: power             !! of ten, at most `countless` from those of its
                                                    !! digits

    integer(long), parameter :: countless = 10_long**12
    integer :: at
    logical :: after_point

    decimal = merge("-", "+", string(1:1) == "-")//"0."
    length = 3
    power = 0_long
    after_point = .false.
    do at = 1, len(string)
      select case (string(at:at))
      case ("0":"9")
        if (length > 3 .or. string(at:at) /= "0") then
          if (.not. after_point) power = power + 1
          if (length < most_digits + 3) then
            length = length + 1
            decimal(length:length) = string(at:at)
          else if (string(at:at) /= "0") then
            decimal(length:length) = "1"
          end if
        else if (after_point) then
          power = power - 1
        end if
      case (".")
        after_point = .true.
      case ("e", "E", "d", "D")
        exit
      end select
    end do
    if (length == 3) length = 0
    power = power + exponent_of(string(at + 1:), countless)
  end subroutine write_decimal

  !> The digits after the letter of an exponent as a number; 0 if there are none.
  pure function exponent_of(digits, countless) result(exponent)
    character(len=*), intent(in) :: digits      !! with or without a sign
    integer(long), intent(in) :: countless      !! where counting ends
    integer(long) :: exponent

    integer :: at

    exponent = 0_long
    do at = max(1, verify(digits, "+-")), len(digits)
      exponent = min(10_long*exponent + (iachar(digits(at:at)) - iachar("0")), countless)
    end do
    if (index(digits, "-") == 1) exponent = -exponent
  end function exponent_of

  !> Reads a number of few digits, as nearly all of a deck are, in a tenth of the time that a
  !! formatted `read` takes.
  !!
  !! Whole numbers below 10¹⁵ and powers of ten up to 10²² are doubles exactly; so their product or
  !! quotient is the double nearest to the number, the same that `read` finds.
  pure subroutine read_short(string, value, done)
    character(len=*), intent(in) :: string !! a number
    real(wp), intent(out) :: value
    logical, intent(out) :: done           !! false: it has too many digits, or too large an
                                           !! exponent

    integer, parameter :: most_digits = 15, largest_power = 22
    integer(long) :: whole
    integer :: at, digits, power, exponent
    logical :: after_point

    value = 0.0_wp
    whole = 0_long
    digits = 0
    power = 0
    exponent = 0
    after_point = .false.
    done = .false.
    at = 1
    if (scan("+-", string(1:1)) > 0) at = 2
    do while (at <= len(string))
      select case (string(at:at))
      case ("0":"9")
        if (digits == most_digits) return
        whole = 10_long*whole + (iachar(string(at:at)) - iachar("0"))
        if (whole > 0_long) digits = digits + 1
        if (after_point) power = power - 1
      case (".")
        after_point = .true.
      case default
        exit
      end select
      at = at + 1
    end do
    if (at < len(string)) then
      at = at + 1
      if (len(string) - at > 3) return
      do digits = at + merge(1, 0, scan("+-", string(at:at)) > 0), len(string)
        exponent = 10*exponent + (iachar(string(digits:digits)) - iachar("0"))
      end do
      if (string(at:at) == "-") exponent = -exponent
    end if
    power = power + exponent
    if (abs(power) > largest_power) return
    value = real(whole, wp)
    if (power > 0) value = value*10.0_wp**power
    if (power < 0) value = value/10.0_wp**(-power)
    if (string(1:1) == "-") value = -value
    done = .true.
  end subroutine read_short

  !> A number in as few digits, from 15 on, as read back to the same double; trailing zeros are
  !! dropped.
  pure function shortest_text(value) result(string)
    real(wp), intent(in) :: value !! finite
    character(len=:), allocatable :: string

    type(error_t), allocatable :: error
    real(wp) :: again
    integer :: digits

    do digits = 15, 17
      string = to_string(value, digits)
      call read_real(string, again, error)
      if (abs(again - value) <= 0.0_wp) return
    end do
  end function shortest_text

  !> Reads a text that is a whole number and nothing else. Errors: it is none, or too large.
  pure subroutine read_integer(string, value, error)
    character(len=*), intent(in) :: string           !! digits, with or without a sign
    integer, intent(out) :: value                    !! 0 if there is an error
    type(error_t), allocatable, intent(out) :: error !! without a place

    character(len=32) :: form
    integer :: first, status

    value = 0
    first = 1
    if (len(string) > 1) then
      if (scan(string(1:1), "+-") == 1) first = 2
    end if
    if (len(string) == 0 .or. count_digits(string, first) /= len(string) - first + 1) then
      call set_error(error, error_of_input, "'"//string//"' is not a whole number")
      return
    end if
    write (form, "(a,i0,a)") "(i", len(string), ")"
    read (string, form, iostat=status) value
    if (status == 0) return
    value = 0
    call set_error(error, error_of_input, "'"//string//"' is too large for a whole number")
  end subroutine read_integer

end module numbers
