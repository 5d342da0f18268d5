!> Comma-separated values (RFC 4180).
module csv_text
  use text_buffer, only: append_text, buffer_text, text_buffer_t
  implicit none (type, external)
  private

  public :: csv_record, csv_field, csv_quoted, csv_line_end

  character(len=*), parameter :: csv_line_end = achar(13)//achar(10)

contains

  !> A row of cells separated by blanks as fields separated by commas, without line end.
  pure function csv_record(cells) result(record)
    character(len=*), intent(in) :: cells !! separated by blanks
    character(len=:), allocatable :: record

    type(text_buffer_t) :: buffer
    integer :: first, last

    last = 0
    do
      first = verify(cells(last + 1:), " ")
      if (first == 0) exit
      first = last + first
      last = index(cells(first:), " ")
      last = merge(len(cells), first + last - 2, last == 0)
      if (buffer%length > 0) call append_text(buffer, ",")
      call append_text(buffer, csv_field(cells(first:last)))
    end do
    record = buffer_text(buffer)
  end function csv_record

  !> A text as a field, in quotes only where it needs them.
  pure function csv_field(text) result(field)
    character(len=*), intent(in) :: text !! of one cell
    character(len=:), allocatable :: field

    field = text
    if (scan(text, '",'//csv_line_end) > 0) field = csv_quoted(text)
  end function csv_field

  !> A text in quotes, with inner quotes doubled.
  pure function csv_quoted(text) result(field)
    character(len=*), intent(in) :: text !! without outer quotes
    character(len=:), allocatable :: field

    integer :: i

    field = '"'
    do i = 1, len(text)
      if (text(i:i) == '"') field = field//'"'
      field = field//text(i:i)
    end do
    field = field//'"'
  end function csv_quoted

end module csv_text
