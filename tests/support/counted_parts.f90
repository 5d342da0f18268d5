!> Texts in which tests look for words.
module counted_parts
  implicit none (type, external)
  private

  public :: count_of

contains

  !> How often a text has a part.
  pure function count_of(text, part) result(count)
    character(len=*), intent(in) :: text, part
    integer :: count

    integer :: at

    count = 0
    at = 1
    do while (index(text(at:), part) > 0)
      count = count + 1
      at = at + index(text(at:), part)
    end do
  end function count_of

end module counted_parts
