!> Tables: plain text, every row complete in itself, numbers with all digits that they need or with
!! as many as are asked for; on request the same rows as CSV.
module tables
  use csv_text, only: csv_field, csv_line_end, csv_quoted, csv_record
  use errors, only: error_t
  use file_system, only: joined_path
  use kinds, only: long, wp
  use number_text, only: most_digits, real_cells, number_width, rounded
  use numbers, only: number_length, read_real
  use output_files, only: append_file, append_output, close_output, finish_output, open_output, &
    output_file_t
  use table_rows, only: item_failure, item_gap, item_row, next_item, row_item_t, rows_t
  use text, only: is_among, string_t, to_string
  implicit none (type, external)
  private

  public :: table_file_t, open_table, begin_variant, finish_table, close_table, open_later_rows, &
    append_later_rows
  public :: column_t, real_column, integer_column, name_column, append_column
  public :: write_header, write_notes, write_rows
  public :: real_cells, integer_cell, name_cell, has_unit

  type :: column_t
    character(len=:), allocatable :: name
    character(len=:), allocatable :: unit !! `-` without one
    integer :: width = 0                  !! characters, with the blank before
    integer :: least_digits = 0           !! that its numbers keep at least where they are rounded;
                                          !! 0: they are not real
  end type column_t

  type :: table_file_t
    character(len=:), allocatable :: name     !! of its files, without `.dat` and `.csv`
    logical :: has_plain = .true.             !! at least one of the two
    logical :: has_csv = .false.
    logical :: has_blocks = .true.            !! empty lines separate the variants
    integer :: digits = most_digits           !! of real numbers; most_digits: not rounded
    type(column_t), allocatable :: columns(:) !! all; not allocated before the header is written
    integer(long) :: rows = 0_long            !! written so far, without failed ones
    integer(long) :: failed_rows = 0_long     !! could not be computed
    type(output_file_t), private :: plain, csv !! `.dat` and `.csv`
    logical, private :: gap_due = .false.     !! an empty line must precede the next row
    type(string_t), allocatable, private :: notes(:)       !! of the header
    type(column_t), allocatable, private :: parameters(:)  !! first columns: what varies; none if
                                                           !! the deck has one variant only
    real(wp), allocatable, private :: parameter_values(:)  !! (parameters) of the current variant
    character(len=:), allocatable, private :: first_cells  !! the same as text: start of every row
    integer, allocatable, private :: widths(:)             !! (columns) of the file
  end type table_file_t

  integer, parameter :: integer_width = 9
  !> Digits that are kept of what tells rows apart, and of what is an error. A failed row gives its
  !! place in so many, too.
  integer, parameter, public :: digits_of_place = 12, digits_of_errors = 3
  character(len=*), parameter :: no_unit = "-"
  character(len=*), parameter :: line_feed = achar(10)

contains

  !> Opens `name.dat` and, on request, `name.csv` beside it or in its place. Errors: a file cannot
  !! be opened.
  subroutine open_table(folder, name, has_csv, table, error, csv_only)
    character(len=*), intent(in) :: folder           !! existing
    character(len=*), intent(in) :: name             !! of the files, without extension
    logical, intent(in) :: has_csv                   !! whether to write CSV as well
    type(table_file_t), intent(out) :: table         !! without header
    type(error_t), allocatable, intent(out) :: error !! allocated if a file cannot be opened
    logical, intent(in), optional :: csv_only        !! with `has_csv`: no plain table

    table%name = name
    table%has_csv = has_csv
    if (present(csv_only)) table%has_plain = .not. (has_csv .and. csv_only)
    allocate (table%parameters(0), table%parameter_values(0))
    table%first_cells = ""
    if (table%has_plain) call open_output(joined_path(folder, name//".dat"), &
      table%plain, error)
    if (has_csv .and. .not. allocated(error)) call open_output( &
      joined_path(folder, name//".csv"), table%csv, error)
  end subroutine open_table

  !> Begins the rows of a variant, with its parameters in their first columns.
  subroutine begin_variant(table, parameters, values)
    type(table_file_t), intent(inout) :: table  !! open
    type(column_t), intent(in) :: parameters(:) !! (parameters) columns of what varies
    real(wp), intent(in) :: values(:)           !! (parameters) in the units of their columns

    table%parameters = parameters
    table%parameter_values = values
    table%first_cells = real_cells(values)
  end subroutine begin_variant

  !> Writes the rest and closes the files. Errors: not everything was taken.
  subroutine finish_table(table, folder, error)
    type(table_file_t), intent(inout) :: table       !! open before, closed after
    character(len=*), intent(in) :: folder           !! where its files will be, for a message
    type(error_t), allocatable, intent(out) :: error !! allocated if a file is incomplete

    if (table%gap_due) call append_plain(table, line_feed)
    table%gap_due = .false.
    if (table%has_plain) call finish_output(table%plain, joined_path(folder, table%name//".dat"), &
      error)
    if (table%has_csv .and. .not. allocated(error)) call finish_output(table%csv, &
      joined_path(folder, table%name//".csv"), error)
  end subroutine finish_table

  !> Opens files of their own for rows that follow others, which are yet to come.
  subroutine open_later_rows(table, folder, number, later, error)
    type(table_file_t), intent(in) :: table  !! with its header and variant
    character(len=*), intent(in) :: folder   !! existing
    integer, intent(in) :: number            !! different for every such file of the table
    type(table_file_t), intent(out) :: later !! takes rows as the table does
    type(error_t), allocatable, intent(out) :: error !! a file cannot be opened

    call open_table(folder, table%name//"."//to_string(number), table%has_csv, later, error, &
      .not. table%has_plain)
    later%has_blocks = table%has_blocks
    later%columns = table%columns
    later%digits = table%digits
    later%widths = table%widths
    call begin_variant(later, table%parameters, table%parameter_values)
  end subroutine open_later_rows

  !> Appends such rows, and removes their files. Errors: not everything was taken.
  subroutine append_later_rows(table, folder, place, later, error)
    type(table_file_t), intent(inout) :: table       !! with the rows before
    character(len=*), intent(in) :: folder           !! with the files of the later rows
    character(len=*), intent(in) :: place            !! where the table will be, for a message
    type(table_file_t), intent(inout) :: later       !! open before, removed after
    type(error_t), allocatable, intent(out) :: error !! allocated if a file is incomplete

    character(len=:), allocatable :: path
    logical :: gap_due

    path = joined_path(folder, later%name)
    gap_due = later%gap_due
    later%gap_due = .false.
    later%name = table%name
    call finish_table(later, place, error)
    if (allocated(error)) return
    if (table%has_plain) call append_file(table%plain, path//".dat")
    if (table%has_csv) call append_file(table%csv, path//".csv")
    table%gap_due = gap_due
    table%rows = table%rows + later%rows
    table%failed_rows = table%failed_rows + later%failed_rows
  end subroutine append_later_rows

  !> Closes the files as they are.
  subroutine close_table(table)
    type(table_file_t), intent(inout) :: table !! open or finished

    call close_output(table%plain)
    call close_output(table%csv)
  end subroutine close_table

  !> A column of real numbers. Errors, the residuals of equations and growth, which are to be seen
  !! as small as they are, keep some digits where others are rounded to fewer.
  pure function real_column(name, unit) result(column)
    character(len=*), intent(in) :: name !! at the head
    character(len=*), intent(in) :: unit !! as in the table; `-`: none
    type(column_t) :: column

    column = column_t(name, unit, number_width, 1)
    if (index(name, "error") + index(name, "closure") + index(name, "growth") > 0) &
      column%least_digits = digits_of_errors
  end function real_column

  !> A column of whole numbers, without unit.
  pure function integer_column(name) result(column)
    character(len=*), intent(in) :: name !! at the head
    type(column_t) :: column

    column = column_t(name, no_unit, max(integer_width, len(name) + 1))
  end function integer_column

  !> A column of names, as wide as the longest of them requires.
  pure function name_column(name, entries) result(column)
    character(len=*), intent(in) :: name     !! at the head
    type(string_t), intent(in) :: entries(:) !! all names that may appear in it
    type(column_t) :: column

    integer :: i

    column = column_t(name, no_unit, len(name) + 1)
    do i = 1, size(entries)
      column%width = max(column%width, len(entries(i)%text) + 1)
    end do
  end function name_column

  !> Whether a column has a unit.
  pure function has_unit(column) result(has)
    type(column_t), intent(in) :: column !! of any kind
    logical :: has

    has = column%unit /= no_unit
  end function has_unit

  !> Head of a column in CSV: `crank [deg]`.
  pure function name_with_unit(column) result(name)
    type(column_t), intent(in) :: column
    character(len=:), allocatable :: name

    name = column%name
    if (has_unit(column)) name = column%name//" ["//column%unit//"]"
  end function name_with_unit

  !> Appends a column. An array constructor of function results would leak memory in gfortran 12.
  pure subroutine append_column(columns, column)
    type(column_t), allocatable, intent(inout) :: columns(:) !! may be unallocated: no columns
    type(column_t), intent(in) :: column                     !! to append

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

  !> Separates a variant from the one before: two empty lines, unless its rows are no block, and
  !! those of its notes that the header does not have.
  subroutine write_notes(table, notes)
    type(table_file_t), intent(inout) :: table  !! with its header
    type(string_t), intent(in) :: notes(:) !! lines of text, of the variant

    integer :: i

    if (table%has_blocks) call write_gap(table, 2)
    do i = 1, size(notes)
      if (is_among(table%notes, notes(i)%text)) cycle
      call append_plain(table, "# "//notes(i)%text//line_feed)
    end do
  end subroutine write_notes

  !> Writes the `#` lines: title, notes, column names, units. CSV gets one line of column names with
  !! their units.
  subroutine write_header(table, title, notes, columns)
    type(table_file_t), intent(inout) :: table    !! without header
    character(len=*), intent(in) :: title    !! of the deck; may be empty
    type(string_t), intent(in) :: notes(:)   !! lines of text, of the first variant
    type(column_t), intent(in) :: columns(:) !! (columns) without those of what varies

    character(len=:), allocatable :: names, units, fields
    integer :: i

    table%notes = notes
    table%columns = [table%parameters, columns]
    table%columns(:size(table%parameters))%least_digits = digits_of_place
    allocate (table%widths(size(table%columns)))
    do i = 1, size(table%columns)
      table%widths(i) = width_of(table%columns(i), table%digits)
    end do
    call append_plain(table, "# "//title_line(title)//line_feed)
    do i = 1, size(notes)
      call append_plain(table, "# "//notes(i)%text//line_feed)
    end do
    names = ""
    units = ""
    fields = ""
    do i = 1, size(table%columns)
      associate (column => table%columns(i))
        names = names//name_cell(column%name, table%widths(i))
        units = units//name_cell(column%unit, table%widths(i))
        fields = fields//csv_field(name_with_unit(column))//","
      end associate
    end do
    ! `#` replaces the blank at the start of every first column.
    call append_plain(table, "#"//names(2:)//line_feed//"#"//units(2:)//line_feed)
    if (table%has_csv) call append_output(table%csv, fields//"failure"//csv_line_end)
  end subroutine write_header

  !> The first line of a table, also of a deck without title.
  pure function title_line(title) result(line)
    character(len=*), intent(in) :: title
    character(len=:), allocatable :: line

    line = title
    if (len(title) == 0) line = "(no title)"
  end function title_line

  !> Writes rows, gaps and failures in their order.
  subroutine write_rows(table, rows)
    type(table_file_t), intent(inout) :: table !! with its header
    type(rows_t), intent(inout) :: rows        !! to write

    type(row_item_t) :: item
    logical :: found

    do
      call next_item(rows, item, found)
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

  !> Appends text to the plain table, if there is one.
  subroutine append_plain(table, text)
    type(table_file_t), intent(inout) :: table
    character(len=*), intent(in) :: text

    if (table%has_plain) call append_output(table%plain, text)
  end subroutine append_plain

  subroutine write_row(table, cells)
    type(table_file_t), intent(inout) :: table
    character(len=*), intent(in) :: cells

    if (table%digits < most_digits) then
      call write_cells(table, rounded_cells(table, table%first_cells//cells))
    else
      call write_cells(table, table%first_cells//cells)
    end if
    table%rows = table%rows + 1
  end subroutine write_row

  subroutine write_cells(table, cells)
    type(table_file_t), intent(inout) :: table
    character(len=*), intent(in) :: cells !! of all columns

    if (table%gap_due) call append_plain(table, line_feed)
    table%gap_due = .false.
    call append_plain(table, cells)
    call append_plain(table, line_feed)
    if (table%has_csv) call append_output(table%csv, csv_record(cells)//","//csv_line_end)
  end subroutine write_cells

  !> The cells of the first columns with numbers rounded and columns as narrow as these allow.
  pure function rounded_cells(table, cells) result(narrow)
    type(table_file_t), intent(in) :: table
    character(len=*), intent(in) :: cells !! separated by blanks, of the first columns or all
    character(len=:), allocatable :: narrow

    type(error_t), allocatable :: error
    character(len=number_width) :: number
    real(wp) :: value
    integer :: i, first, last

    narrow = ""
    last = 0
    do i = 1, size(table%columns)
      first = verify(cells(last + 1:), " ")
      if (first == 0) return
      first = last + first
      last = first + index(cells(first:)//" ", " ") - 2
      associate (column => table%columns(i), cell => cells(first:last))
        if (column%least_digits > 0 .and. number_length(cell) == len(cell)) then
          call read_real(cell, value, error)
          number = real_cells([rounded(value, max(table%digits, column%least_digits))])
          narrow = narrow//name_cell(trim(adjustl(number)), table%widths(i))
        else
          narrow = narrow//name_cell(cell, table%widths(i))
        end if
      end associate
    end do
  end function rounded_cells

  !> Width of a column whose numbers are rounded.
  pure function width_of(column, digits) result(width)
    type(column_t), intent(in) :: column
    integer, intent(in) :: digits
    integer :: width

    width = column%width
    if (column%least_digits == 0 .or. digits == most_digits) return
    width = max(width - most_digits + max(digits, column%least_digits), len(column%name) + 1, &
      len(column%unit) + 1)
  end function width_of

  !> Writes empty lines: one where a curve breaks, two between blocks. CSV needs none, since its
  !! columns show both.
  subroutine write_gap(table, lines)
    type(table_file_t), intent(inout) :: table
    integer, intent(in) :: lines

    table%gap_due = .false.
    call append_plain(table, repeat(line_feed, lines))
  end subroutine write_gap

  !> Writes a row that could not be computed: a comment, and an empty line before the next row,
  !! which breaks a plotted curve. CSV gets a row with the reason in its last column.
  !!
  !! Successive failed rows share one empty line: two would end a block.
  subroutine write_failure(table, place, reason)
    type(table_file_t), intent(inout) :: table
    real(wp), intent(in) :: place(:) !! (first columns) known values after those of what varies:
                                     !! speed, crank angle
    character(len=*), intent(in) :: reason

    real(wp), allocatable :: known(:)
    character(len=:), allocatable :: cells
    integer :: i

    known = [table%parameter_values, place]
    call append_plain(table, "# failed")
    do i = 1, size(known)
      call append_plain(table, " "//table%columns(i)%name//"="//to_string(known(i), &
        digits_of_place))
    end do
    call append_plain(table, " : "//reason//line_feed)
    table%gap_due = table%has_blocks
    table%failed_rows = table%failed_rows + 1
    if (.not. table%has_csv) return
    cells = real_cells(known)
    if (table%digits < most_digits) cells = rounded_cells(table, cells)
    ! Without a known value there is one comma less: none stands before the first field.
    call append_output(table%csv, csv_record(cells)//repeat(",", &
      size(table%columns) - max(1, size(known)) + 1)//csv_quoted(reason)//csv_line_end)
  end subroutine write_failure

  !> A whole number at the right end of its column.
  pure function integer_cell(value, name) result(cell)
    integer, intent(in) :: value         !! of the cell
    character(len=*), intent(in) :: name !! of the column, which determines its width
    character(len=max(integer_width, len(name) + 1)) :: cell

    character(len=12) :: digits

    write (digits, "(i0)") value
    cell = repeat(" ", len(cell) - len_trim(digits))//digits
  end function integer_cell

  !> A name at the right end of its column.
  pure function name_cell(name, width) result(cell)
    character(len=*), intent(in) :: name !! in the cell
    integer, intent(in) :: width         !! of the column
    character(len=max(width, len(name) + 1)) :: cell

    cell = repeat(" ", len(cell) - len(name))//name
  end function name_cell

end module tables
