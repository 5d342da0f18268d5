!> Tables: plain text, one row that stands alone, all the digits of a double; beside it, if asked
!! for, the same rows as CSV.
module tables
  use csv_text, only: csv_field, csv_line_end, csv_quoted, csv_record
  use errors, only: error_t
  use kinds, only: long, wp
  use number_text, only: number_width, scientific
  use output_files, only: append_output, discard_output, finish_output, open_output, &
    output_file_t, publish_output
  use table_rows, only: item_failure, item_gap, item_row, next_item, row_item_t, rows_t
  use text, only: string_t, to_string, word_list
  implicit none (type, external)
  private

  public :: table_t, open_table, begin_variant, finish_table, publish_table, discard_table
  public :: column_t, real_column, integer_column, name_column, append_column, append_real_columns
  public :: write_header, write_notes, write_rows
  public :: real_cells, integer_cell, name_cell, has_unit

  type :: column_t
    character(len=:), allocatable :: name
    character(len=:), allocatable :: unit
    integer :: width = 0
  end type column_t

  type :: table_t
    character(len=:), allocatable :: name     !! of its files, without `.dat` and `.csv`
    logical :: has_csv = .false.
    type(column_t), allocatable :: columns(:) !! all; not allocated before there is a header
    integer(long) :: rows = 0_long            !! written so far
    integer(long) :: failed_rows = 0_long     !! that could not be computed, besides
    type(output_file_t), private :: plain, csv
    logical, private :: gap_due = .false.     !! an empty line is to come before the next row
    type(string_t), allocatable, private :: notes(:)       !! of the header
    type(column_t), allocatable, private :: parameters(:)  !! columns of what varies, before all
                                                           !! others; none: one variant only
    real(wp), allocatable, private :: parameter_values(:)  !! of the variant whose rows are written
    character(len=:), allocatable, private :: first_cells  !! the same, as every row begins
  end type table_t

  integer, parameter :: integer_width = 9
  character(len=*), parameter :: no_unit = "-"
  character(len=*), parameter :: line_feed = achar(10)

contains

  !> Opens `name.dat` and perhaps `name.csv` under temporary names.
  subroutine open_table(folder, name, has_csv, table, error)
    character(len=*), intent(in) :: folder, name
    logical, intent(in) :: has_csv
    type(table_t), intent(out) :: table
    type(error_t), allocatable, intent(out) :: error

    table%name = name
    table%has_csv = has_csv
    allocate (table%parameters(0), table%parameter_values(0))
    table%first_cells = ""
    call open_output(folder, name//".dat", table%plain, error)
    if (has_csv .and. .not. allocated(error)) call open_output(folder, name//".csv", table%csv, &
      error)
  end subroutine open_table

  !> The rows that follow are those of a variant: what varies stands in their first columns.
  subroutine begin_variant(table, parameters, values)
    type(table_t), intent(inout) :: table
    type(column_t), intent(in) :: parameters(:)
    real(wp), intent(in) :: values(:)

    table%parameters = parameters
    table%parameter_values = values
    table%first_cells = real_cells(values)
  end subroutine begin_variant

  !> Writes what is left and checks that everything is on the disk. Errors: it is not.
  subroutine finish_table(table, error)
    type(table_t), intent(inout) :: table
    type(error_t), allocatable, intent(out) :: error

    if (table%gap_due) call append_output(table%plain, line_feed)
    table%gap_due = .false.
    call finish_output(table%plain, error)
    if (table%has_csv .and. .not. allocated(error)) call finish_output(table%csv, error)
  end subroutine finish_table

  !> Gives a finished table its names.
  subroutine publish_table(table, error)
    type(table_t), intent(in) :: table
    type(error_t), allocatable, intent(out) :: error

    call publish_output(table%plain, error)
    if (table%has_csv .and. .not. allocated(error)) call publish_output(table%csv, error)
  end subroutine publish_table

  !> Removes what was written so far.
  subroutine discard_table(table)
    type(table_t), intent(inout) :: table

    call discard_output(table%plain)
    call discard_output(table%csv)
  end subroutine discard_table

  pure function real_column(name, unit) result(column)
    character(len=*), intent(in) :: name, unit
    type(column_t) :: column

    column = column_t(name, unit, number_width)
  end function real_column

  pure function integer_column(name) result(column)
    character(len=*), intent(in) :: name
    type(column_t) :: column

    column = column_t(name, no_unit, max(integer_width, len(name) + 1))
  end function integer_column

  !> A column wide enough for any of the names that stand in it.
  pure function name_column(name, entries) result(column)
    character(len=*), intent(in) :: name
    type(string_t), intent(in) :: entries(:)
    type(column_t) :: column

    integer :: i

    column = column_t(name, no_unit, len(name) + 1)
    do i = 1, size(entries)
      column%width = max(column%width, len(entries(i)%text) + 1)
    end do
  end function name_column

  pure function has_unit(column) result(has)
    type(column_t), intent(in) :: column
    logical :: has

    has = column%unit /= no_unit
  end function has_unit

  !> `crank [deg]`
  pure function name_with_unit(column) result(name)
    type(column_t), intent(in) :: column
    character(len=:), allocatable :: name

    name = column%name
    if (has_unit(column)) name = column%name//" ["//column%unit//"]"
  end function name_with_unit

  !> Lengthens a table by a column: an array constructor of function results would lose their memory
  !! in gfortran 12.
  pure subroutine append_column(columns, column)
    type(column_t), allocatable, intent(inout) :: columns(:) !! not allocated is as good as empty
    type(column_t), intent(in) :: column

    type(column_t), allocatable :: wider(:)
    integer :: i, n

    n = 0
    if (allocated(columns)) n = size(columns)
    allocate (wider(n + 1))
    do i = 1, n
      wider(i) = columns(i)
    end do
    wider(n + 1) = column
    call move_alloc(wider, columns)
  end subroutine append_column

  !> Lengthens a table by columns of numbers of one unit.
  pure subroutine append_real_columns(columns, names, unit)
    type(column_t), allocatable, intent(inout) :: columns(:)
    character(len=*), intent(in) :: names !! separated by single blanks
    character(len=*), intent(in) :: unit  !! of all

    type(string_t), allocatable :: words(:)
    integer :: i

    words = word_list(names)
    do i = 1, size(words)
      call append_column(columns, real_column(words(i)%text, unit))
    end do
  end subroutine append_real_columns

  !> Writes what the head of a table has to say of another variant than the first: empty lines, and
  !! those notes that the header does not have.
  subroutine write_notes(table, notes)
    type(table_t), intent(inout) :: table !! with its header
    type(string_t), intent(in) :: notes(:)

    integer :: i

    call write_gap(table, 2)
    do i = 1, size(notes)
      if (any_same(table%notes, notes(i)%text)) cycle
      call append_output(table%plain, "# "//notes(i)%text//line_feed)
    end do
  end subroutine write_notes

  !> Writes the `#` lines: title, notes, names of the columns, their units; in CSV the names of the
  !! columns alone.
  subroutine write_header(table, title, notes, columns)
    type(table_t), intent(inout) :: table
    character(len=*), intent(in) :: title
    type(string_t), intent(in) :: notes(:)
    type(column_t), intent(in) :: columns(:)

    character(len=:), allocatable :: names, units, fields
    integer :: i

    table%notes = notes
    table%columns = [table%parameters, columns]
    call append_output(table%plain, "# "//title_line(title)//line_feed)
    do i = 1, size(notes)
      call append_output(table%plain, "# "//notes(i)%text//line_feed)
    end do
    names = ""
    units = ""
    fields = ""
    do i = 1, size(table%columns)
      associate (column => table%columns(i))
        names = names//name_cell(column%name, column%width)
        units = units//name_cell(column%unit, column%width)
        fields = fields//csv_field(name_with_unit(column))//","
      end associate
    end do
    ! The mark takes the place of a blank that every first column begins with.
    call append_output(table%plain, "#"//names(2:)//line_feed//"#"//units(2:)//line_feed)
    if (table%has_csv) call append_output(table%csv, fields//"failure"//csv_line_end)
  end subroutine write_header

  pure function any_same(list, text) result(any_is)
    type(string_t), intent(in) :: list(:)
    character(len=*), intent(in) :: text
    logical :: any_is

    integer :: i

    any_is = .false.
    do i = 1, size(list)
      any_is = any_is .or. list(i)%text == text
    end do
  end function any_same

  !> A table has a first line whether or not its deck has a title.
  pure function title_line(title) result(line)
    character(len=*), intent(in) :: title
    character(len=:), allocatable :: line

    line = title
    if (len(title) == 0) line = "(no title)"
  end function title_line

  !> Writes rows, gaps and failures in their order.
  subroutine write_rows(table, rows)
    type(table_t), intent(inout) :: table !! with its header
    type(rows_t), intent(in) :: rows

    type(row_item_t) :: item
    integer :: at
    logical :: found

    at = 1
    do
      call next_item(rows, at, item, found)
      if (.not. found) exit
      select case (item%kind)
      case (item_row)
        call write_row(table, item%text)
      case (item_gap)
        call write_gap(table, item%lines)
      case (item_failure)
        call write_failure(table, item%place, item%text)
      end select
    end do
  end subroutine write_rows

  subroutine write_row(table, cells)
    type(table_t), intent(inout) :: table
    character(len=*), intent(in) :: cells

    if (table%gap_due) call append_output(table%plain, line_feed)
    table%gap_due = .false.
    call append_output(table%plain, table%first_cells)
    call append_output(table%plain, cells)
    call append_output(table%plain, line_feed)
    table%rows = table%rows + 1
    if (table%has_csv) call append_output(table%csv, csv_record(table%first_cells//cells)//","// &
      csv_line_end)
  end subroutine write_row

  !> Empty lines: one where a curve breaks, two between blocks. CSV has none: the columns tell.
  subroutine write_gap(table, lines)
    type(table_t), intent(inout) :: table
    integer, intent(in) :: lines

    table%gap_due = .false.
    call append_output(table%plain, repeat(line_feed, lines))
  end subroutine write_gap

  !> A row that could not be computed: a comment, and an empty line that breaks a plotted curve. In
  !! CSV it is a row all the same.
  !!
  !! Rows that fail one after another share one empty line: two would be the end of a block.
  subroutine write_failure(table, place, reason)
    type(table_t), intent(inout) :: table
    real(wp), intent(in) :: place(:) !! what the first columns hold behind those of what varies:
                                     !! speed, crank angle
    character(len=*), intent(in) :: reason

    real(wp), allocatable :: known(:)
    integer :: i

    known = [table%parameter_values, place]
    call append_output(table%plain, "# failed")
    do i = 1, size(known)
      call append_output(table%plain, " "//table%columns(i)%name//"="//to_string(known(i), 12))
    end do
    call append_output(table%plain, " : "//reason//line_feed)
    table%gap_due = .true.
    table%failed_rows = table%failed_rows + 1
    if (.not. table%has_csv) return
    call append_output(table%csv, csv_record(real_cells(known))//repeat(",", &
      size(table%columns) - size(known) + 1)//csv_quoted(reason)//csv_line_end)
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
