!> Numbers as text with all the digits of quadruple precision: in place of src/base/words/number_text.f90.
module number_text
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: real_cells, number_width, most_digits, rounded

  integer, parameter :: number_width = 44 !! sign, 35 digits, point, exponent of four digits, and a blank
  integer, parameter :: most_digits = 17  !! to which numbers are rounded; this one means all

contains

  !> Numbers with 35 digits at the right ends of fields.
  pure function real_cells(values) result(cells)
    real(wp), intent(in) :: values(:) !! finite, one per field
    character(len=number_width*size(values)) :: cells

    integer :: i

    do i = 1, size(values)
      write (cells(number_width*(i - 1) + 1:number_width*i), "(es44.34e4)") values(i) + 0.0_wp
    end do
  end function real_cells

  !> The number nearest to `value` that has so many significant digits.
  pure function rounded(value, digits) result(near)
    real(wp), intent(in) :: value !! finite
    integer, intent(in) :: digits !! from 1
    real(wp) :: near

    character(len=64) :: form, text

    write (form, "(a,i0,a)") "(es60.", digits - 1, "e4)"
    write (text, form) value
    read (text, *) near
  end function rounded

end module number_text
