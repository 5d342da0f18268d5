!> Rows of a table before they are written: cells as text, gaps between blocks, failed rows.
!!
!! They are stored as bytes, item after item. Pieces that are computed in parallel can thus be
!! joined by joining their bytes, kept in a journal as they are, and sent to another process.
module table_rows
  use byte_streams, only: get_integers, get_reals, get_string, put_integers, put_reals, put_string
  use kinds, only: wp
  use text_buffer, only: append_text, text_buffer_t
  implicit none (type, external)
  private

  public :: rows_t, row_item_t, keep_cells, add_row, add_gap, add_failed_row, append_rows, &
    next_item, put_rows, get_rows
  public :: item_row, item_gap, item_failure

  !> Kinds of items.
  integer, parameter :: item_row = 1, item_gap = 2, item_failure = 3

  type :: rows_t
    type(text_buffer_t), private :: buffer             !! all items as bytes
    integer, allocatable, private :: first(:), last(:) !! (cells) characters of a row that are kept;
                                                       !! not allocated: all
  end type rows_t

  !> One item.
  type :: row_item_t
    integer :: kind = 0                    !! item_row, item_gap or item_failure
    character(len=:), allocatable :: text  !! cells of a row, or reason of a failure
    integer :: lines = 0                   !! of a gap
    real(wp), allocatable :: place(:)      !! (first columns) values of a failed row
  end type row_item_t

contains

  !> Of the rows that are added from now on some cells only are kept.
  pure subroutine keep_cells(rows, first, last)
    type(rows_t), intent(inout) :: rows             !! so far
    integer, allocatable, intent(in) :: first(:)    !! (cells) characters in a row, in the order in
                                                    !! which they are to stand; not allocated: all
    integer, allocatable, intent(in) :: last(:)     !! likewise

    if (.not. allocated(first)) return
    rows%first = first
    rows%last = last
  end subroutine keep_cells

  !> Appends a row of cells as text, each as wide as its column.
  pure subroutine add_row(rows, cells)
    type(rows_t), intent(inout) :: rows   !! so far
    character(len=*), intent(in) :: cells !! of all columns

    character(len=len(cells)) :: kept
    integer :: i, length

    call put_integers(rows%buffer, [item_row])
    if (.not. allocated(rows%first)) then
      call put_string(rows%buffer, cells)
      return
    end if
    length = 0
    do i = 1, size(rows%first)
      associate (cell => cells(rows%first(i):rows%last(i)))
        kept(length + 1:length + len(cell)) = cell
        length = length + len(cell)
      end associate
    end do
    call put_string(rows%buffer, kept(:length))
  end subroutine add_row

  !> Appends empty lines: one where a curve breaks, two between blocks.
  pure subroutine add_gap(rows, lines)
    type(rows_t), intent(inout) :: rows !! so far
    integer, intent(in) :: lines        !! 1 or 2

    call put_integers(rows%buffer, [item_gap, lines])
  end subroutine add_gap

  !> Appends a row that could not be computed.
  pure subroutine add_failed_row(rows, place, reason)
    type(rows_t), intent(inout) :: rows    !! so far
    real(wp), intent(in) :: place(:)       !! (first columns) known values: speed, crank angle
    character(len=*), intent(in) :: reason !! for the table

    call put_integers(rows%buffer, [item_failure, size(place)])
    call put_reals(rows%buffer, place)
    call put_string(rows%buffer, reason)
  end subroutine add_failed_row

  !> Appends other rows.
  pure subroutine append_rows(rows, more)
    type(rows_t), intent(inout) :: rows !! so far
    type(rows_t), intent(in) :: more    !! rows to append

    if (more%buffer%length > 0) call append_text(rows%buffer, &
      more%buffer%storage(:more%buffer%length))
  end subroutine append_rows

  !> Reads one item and moves on to the next.
  pure subroutine next_item(rows, at, item, found)
    type(rows_t), intent(in) :: rows        !! to read
    integer, intent(inout) :: at            !! byte of the item, from 1; of the next one after
    type(row_item_t), intent(inout) :: item !! unchanged if none is found
    logical, intent(out) :: found           !! false beyond the last item

    integer :: number(1)

    found = at <= rows%buffer%length
    if (.not. found) return
    associate (stream => rows%buffer%storage)
      call get_integers(stream, at, number)
      item%kind = number(1)
      select case (item%kind)
      case (item_row)
        call get_string(stream, at, item%text)
      case (item_gap)
        call get_integers(stream, at, number)
        item%lines = number(1)
      case (item_failure)
        call get_integers(stream, at, number)
        if (allocated(item%place)) deallocate (item%place)
        allocate (item%place(number(1)))
        call get_reals(stream, at, item%place)
        call get_string(stream, at, item%text)
      end select
    end associate
  end subroutine next_item

  !> Appends rows to a buffer as bytes, with their length.
  pure subroutine put_rows(buffer, rows)
    type(text_buffer_t), intent(inout) :: buffer !! the bytes are appended
    type(rows_t), intent(in) :: rows             !! to append

    call put_integers(buffer, [rows%buffer%length])
    if (rows%buffer%length > 0) call append_text(buffer, rows%buffer%storage(:rows%buffer%length))
  end subroutine put_rows

  !> Reads the bytes that `put_rows` wrote.
  pure subroutine get_rows(bytes, at, rows)
    character(len=*), intent(in) :: bytes !! with the rows at `at`
    integer, intent(inout) :: at          !! first byte of the rows; moves beyond the last one
    type(rows_t), intent(out) :: rows     !! as given to `put_rows`

    integer :: length(1)

    call get_integers(bytes, at, length)
    if (length(1) > 0) call append_text(rows%buffer, bytes(at:at + length(1) - 1))
    at = at + length(1)
  end subroutine get_rows

end module table_rows
