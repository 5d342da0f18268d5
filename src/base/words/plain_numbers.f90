!> Numbers in the shortest common form, in texts of fixed length.
module plain_numbers
  use kinds, only: long, wp
  implicit none (type, external)
  private

  public :: digit_count, real_length, write_real, usual_digits, longest_real

  !> Significant digits where their number is not given; most characters of a real number.
  integer, parameter :: usual_digits = 6, longest_real = 56

contains

  !> Characters of a whole number, its sign included.
  pure function digit_count(value) result(count)
    integer(long), intent(in) :: value !! of either sign
    integer :: count

    character(len=24) :: buffer

    write (buffer, "(i0)") value
    count = len_trim(buffer)
  end function digit_count

  !> Characters that `write_real` uses for a number.
  pure function real_length(value, digits) result(length)
    real(wp), intent(in) :: value !! any
    integer, intent(in) :: digits !! significant digits, from 1
    integer :: length

    character(len=longest_real) :: buffer

    call write_real(value, digits, buffer, length)
  end function real_length

  !> Writes a real number into the first `length` characters of a buffer, without trailing zeros. It
  !! has an exponent only below 1e-4 and where its whole part has more digits than both `digits` and
  !! `usual_digits`. NaN and infinities are `not a number`.
  pure subroutine write_real(value, digits, buffer, length)
    real(wp), intent(in) :: value           !! any
    integer, intent(in) :: digits           !! significant digits, from 1
    character(len=*), intent(out) :: buffer !! of `longest_real` characters; the rest is blank
    integer, intent(out) :: length          !! characters in use

    character(len=16) :: form
    character(len=8) :: exponent
    integer :: power

    if (abs(value) <= 0.0_wp) then
      buffer = "0"
    else if (.not. abs(value) <= huge(value)) then
      buffer = "not a number"
    else
      write (form, "(a,i0,a)") "(es44.", digits - 1, "e4)"
      write (buffer, form) value
      read (buffer(index(buffer, "E") + 1:), *) power
      if (power >= -4 .and. power < max(digits, usual_digits)) then
        write (form, "(a,i0,a)") "(f0.", max(digits - 1 - power, 0), ")"
        write (buffer, form) value
        call put_leading_zero(buffer)
        call drop_trailing_zeros(buffer)
      else
        buffer = adjustl(buffer)
        buffer(index(buffer, "E"):) = ""
        call drop_trailing_zeros(buffer)
        write (exponent, "(i0)") power
        buffer = trim(buffer)//"e"//exponent
      end if
    end if
    length = len_trim(buffer)
  end subroutine write_real

  !> `-.5` as `-0.5`: compilers omit the zero with `f0`.
  pure subroutine put_leading_zero(number)
    character(len=*), intent(inout) :: number

    integer :: point

    point = index(number, ".")
    if (point == 1) number = "0"//number
    if (point == 2 .and. number(1:1) == "-") number = "-0"//number(2:)
  end subroutine put_leading_zero

  pure subroutine drop_trailing_zeros(number)
    character(len=*), intent(inout) :: number

    integer :: last

    if (index(number, ".") == 0) return
    last = verify(trim(number), "0", back=.true.)
    if (number(last:last) == ".") last = last - 1
    number(last + 1:) = ""
  end subroutine drop_trailing_zeros

end module plain_numbers
