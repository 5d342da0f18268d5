!> Tables: plain text, one row that stands alone, all the digits of a double.
module tables
  use kinds, only: wp
  use number_text, only: number_width, scientific
  use output_files, only: append_output, output_file_t
  use text, only: string_t
  implicit none (type, external)
  private

  public :: column_t, real_column, integer_column, name_column, write_header, write_row, write_gap, write_failure
  public :: real_cells, integer_cell, name_cell

  type :: column_t
    character(len=:), allocatable :: name
    character(len=:), allocatable :: unit
    integer :: width = 0
  end type column_t

  integer, parameter :: integer_width = 9
  character(len=*), parameter :: line_feed = achar(10)

contains

  pure function real_column(name, unit) result(column)
    character(len=*), intent(in) :: name, unit
    type(column_t) :: column

    column = column_t(name, unit, number_width)
  end function real_column

  pure function integer_column(name) result(column)
    character(len=*), intent(in) :: name
    type(column_t) :: column

    column = column_t(name, "-", max(integer_width, len(name) + 1))
  end function integer_column

  !> A column wide enough for any of the names that stand in it.
  pure function name_column(name, entries) result(column)
    character(len=*), intent(in) :: name
    type(string_t), intent(in) :: entries(:)
    type(column_t) :: column

    integer :: i

    column = column_t(name, "-", len(name) + 1)
    do i = 1, size(entries)
      column%width = max(column%width, len(entries(i)%text) + 1)
    end do
  end function name_column

  !> Writes the `#` lines: title, notes, names of the columns, their units.
  subroutine write_header(file, title, notes, columns)
    type(output_file_t), intent(inout) :: file
    character(len=*), intent(in) :: title
    type(string_t), intent(in) :: notes(:)
    type(column_t), intent(in) :: columns(:)

    character(len=:), allocatable :: names, units
    integer :: i

    call append_output(file, "# "//title_line(title)//line_feed)
    do i = 1, size(notes)
      call append_output(file, "# "//notes(i)%text//line_feed)
    end do
    names = ""
    units = ""
    do i = 1, size(columns)
      names = names//name_cell(columns(i)%name, columns(i)%width)
      units = units//name_cell(columns(i)%unit, columns(i)%width)
    end do
    ! The mark takes the place of a blank that every first column begins with.
    call append_output(file, "#"//names(2:)//line_feed//"#"//units(2:)//line_feed)
  end subroutine write_header

  !> A table has a first line whether or not its deck has a title.
  pure function title_line(title) result(line)
    character(len=*), intent(in) :: title
    character(len=:), allocatable :: line

    line = title
    if (len(title) == 0) line = "(no title)"
  end function title_line

  subroutine write_row(file, cells)
    type(output_file_t), intent(inout) :: file
    character(len=*), intent(in) :: cells

    if (file%gap_due) call append_output(file, line_feed)
    file%gap_due = .false.
    call append_output(file, cells//line_feed)
  end subroutine write_row

  !> Empty lines: one where a curve breaks, two between blocks.
  subroutine write_gap(file, lines)
    type(output_file_t), intent(inout) :: file
    integer, intent(in) :: lines

    file%gap_due = .false.
    call append_output(file, repeat(line_feed, lines))
  end subroutine write_gap

  !> A row that could not be computed: a comment, and an empty line that breaks a plotted curve.
  !!
  !! Rows that fail one after another share one empty line: two would be the end of a block.
  subroutine write_failure(file, place, reason)
    type(output_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place  !! `speed=… crank=…`
    character(len=*), intent(in) :: reason

    call append_output(file, "# failed "//place//" : "//reason//line_feed)
    file%gap_due = .true.
  end subroutine write_failure

  !> Numbers with 17 digits. Zero has no sign: -0 would make equal tables differ.
  function real_cells(values) result(cells)
    real(wp), intent(in) :: values(:)
    character(len=number_width*size(values)) :: cells

    integer :: i

    do i = 1, size(values)
      cells(number_width*(i - 1) + 1:number_width*i) = scientific(values(i) + 0.0_wp, number_width)
    end do
  end function real_cells

  pure function integer_cell(value, name) result(cell)
    integer, intent(in) :: value
    character(len=*), intent(in) :: name !! of the column
    character(len=max(integer_width, len(name) + 1)) :: cell

    character(len=12) :: digits

    write (digits, "(i0)") value
    cell = repeat(" ", len(cell) - len_trim(digits))//digits
  end function integer_cell

  !> A name at the right end of its column.
  pure function name_cell(name, width) result(cell)
    character(len=*), intent(in) :: name
    integer, intent(in) :: width
    character(len=max(width, len(name) + 1)) :: cell

    cell = repeat(" ", len(cell) - len(name))//name
  end function name_cell

end module tables
