!> Numbers as text with all the digits of quadruple precision: in place of src/base/words/number_text.f90.
module number_text
  use, intrinsic :: iso_c_binding, only: c_char, c_int, c_null_char, c_size_t
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: scientific, number_width

  interface
    !> `snprintf` for one quadruple number (ISO/IEC TS 18661-3, in the GNU C library).
    function c_strfromf128(text, size, format, value) bind(c, name="strfromf128") result(length)
      import :: c_char, c_int, c_size_t, wp
      character(kind=c_char), intent(out) :: text(*)
      integer(c_size_t), intent(in), value :: size
      character(kind=c_char), intent(in) :: format(*)
      real(wp), intent(in), value :: value
      integer(c_int) :: length
    end function c_strfromf128
  end interface

  integer, parameter :: number_width = 43 !! sign, 35 digits, point, exponent of four digits, and a blank
  integer, parameter :: longest = 64

contains

  !> A finite number with 35 digits and an exponent of three, at the right end of a field.
  function scientific(value, width) result(text)
    real(wp), intent(in) :: value
    integer, intent(in) :: width
    character(len=width) :: text

    character(kind=c_char) :: digits(longest)
    character(len=longest) :: number
    integer :: i, length, exponent_at, missing

    length = int(c_strfromf128(digits, int(longest, c_size_t), ["%", ".", "3", "4", "E", c_null_char], value))
    do i = 1, length
      number(i:i) = digits(i)
    end do
    exponent_at = index(number(:length), "E")
    missing = max(0, 3 - (length - exponent_at - 1))
    text = repeat(" ", width - length - missing)//number(:exponent_at + 1)//repeat("0", missing)//number(exponent_at + 2:length)
  end function scientific

end module number_text
