!> Numbers as text: the shortest decimal that is read back as the same double, as 60, 0.1 or
!! 2.5e-07. The digits are found by `shortest_digits.cpp`.
module number_text
  use, intrinsic :: iso_c_binding, only: c_char, c_double, c_int
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: real_cells, number_width, most_digits, rounded

  interface
    pure subroutine c_write_numbers(values, count, width, text) &
      bind(c, name="flexmech_write_numbers")
      import :: c_char, c_double, c_int
      real(c_double), intent(in) :: values(*)
      integer(c_int), intent(in), value :: count, width
      character(kind=c_char), intent(out) :: text(*)
    end subroutine c_write_numbers

    pure function c_rounded(value, digits) bind(c, name="flexmech_rounded") result(near)
      import :: c_double, c_int
      real(c_double), intent(in), value :: value
      integer(c_int), intent(in), value :: digits
      real(c_double) :: near
    end function c_rounded
  end interface

  integer, parameter :: number_width = 25 !! sign, 17 digits, point, exponent with letter, sign and
                                          !! three digits, and a blank
  integer, parameter :: most_digits = 17  !! that a double may need

contains

  !> Numbers at the right ends of fields. Zero has no sign: -0 would make equal tables differ.
  pure function real_cells(values) result(cells)
    real(wp), intent(in) :: values(:) !! finite, one per field
    character(len=number_width*size(values)) :: cells

    call c_write_numbers(values, size(values), number_width, cells)
  end function real_cells

  !> The number nearest to `value` that has so many significant digits.
  pure function rounded(value, digits) result(near)
    real(wp), intent(in) :: value !! finite
    integer, intent(in) :: digits !! from 1 to most_digits
    real(wp) :: near

    near = c_rounded(value, digits)
  end function rounded

end module number_text
