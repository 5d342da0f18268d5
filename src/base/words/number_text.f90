!> Numbers as text with all their significant digits.
module number_text
  use, intrinsic :: iso_c_binding, only: c_char, c_double, c_int, c_null_char, c_size_t
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: scientific, number_width

  interface
    !> `snprintf` for one double (ISO/IEC TS 18661-1, in the C library): three times as fast as a
    !! formatted write, which takes most of the time of writing a large table.
    function c_strfromd(text, size, format, value) bind(c, name="strfromd") result(length)
      import :: c_char, c_double, c_int, c_size_t
      character(kind=c_char), intent(out) :: text(*)
      integer(c_size_t), intent(in), value :: size
      character(kind=c_char), intent(in) :: format(*)
      real(c_double), intent(in), value :: value
      integer(c_int) :: length
    end function c_strfromd
  end interface

  integer, parameter :: number_width = 25 !! sign, 17 digits, point, exponent of three digits, and a
                                          !! blank
  integer, parameter :: longest = 32

contains

  !> A number with 17 digits and a three-digit exponent, right-aligned in a field, as `es25.16e3`
  !! writes it.
  function scientific(value, width) result(text)
    real(wp), intent(in) :: value !! finite
    integer, intent(in) :: width  !! of the field [characters], at least 24
    character(len=width) :: text

    character(kind=c_char) :: digits(longest)
    character(len=longest) :: number
    integer :: i, length, exponent_at, missing

    length = int(c_strfromd(digits, int(longest, c_size_t), ["%", ".", "1", "6", "E", &
      c_null_char], real(value, c_double)))
    do i = 1, length
      number(i:i) = digits(i)
    end do
    exponent_at = index(number(:length), "E")
    missing = 3 - (length - exponent_at - 1)
    text = repeat(" ", width - length - missing)//number(:exponent_at + 1)//repeat("0", missing)// &
      number(exponent_at + 2:length)
  end function scientific

end module number_text
