! src/output/ - tables, CSV and JSON as text, and the files of a run in their folder.
! In: columns, rows (`rows_t`), texts. Out: files that appear when all of them are complete. Begin
! with `open_table` and `write_rows` in `tables.f90`, then `put_in_place` in `output_folders.f90`.
! Not here: what is in a table (`src/reports`), which files a run has (`src/runs/deck_outputs.f90`).

!> Rows of a table before they are written: cells as text, gaps between blocks, failed rows.
!!
!! They are stored as bytes, item after item. Pieces that are computed in parallel can thus be
!! joined by joining their bytes, kept in a journal as they are, and sent to another process.
module table_rows
  use byte_streams, only: byte_stream_t
  use kinds, only: wp
  use text_buffer, only: append_text
  implicit none (type, external)
  private

  public :: rows_t, row_item_t, keep_cells, add_row, add_gap, add_failed_row, append_rows, &
    next_item, pass_rows
  public :: item_row, item_gap, item_failure

  !> Kinds of items.
  integer, parameter :: item_row = 1, item_gap = 2, item_failure = 3

  type :: rows_t
    type(byte_stream_t), private :: items              !! all items as bytes
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

    call rows%items%add(item_row)
    if (.not. allocated(rows%first)) then
      call rows%items%add_text(cells)
      return
    end if
    length = 0
    do i = 1, size(rows%first)
      associate (cell => cells(rows%first(i):rows%last(i)))
        kept(length + 1:length + len(cell)) = cell
        length = length + len(cell)
      end associate
    end do
    call rows%items%add_text(kept(:length))
  end subroutine add_row

  !> Appends empty lines: one where a curve breaks, two between blocks.
  pure subroutine add_gap(rows, lines)
    type(rows_t), intent(inout) :: rows !! so far
    integer, intent(in) :: lines        !! 1 or 2

    call rows%items%add(item_gap)
    call rows%items%add(lines)
  end subroutine add_gap

  !> Appends a row that could not be computed.
  pure subroutine add_failed_row(rows, place, reason)
    type(rows_t), intent(inout) :: rows    !! so far
    real(wp), intent(in) :: place(:)       !! (first columns) known values: speed, crank angle
    character(len=*), intent(in) :: reason !! for the table

    real(wp), allocatable :: values(:)

    allocate (values, source=place)
    call rows%items%add(item_failure)
    call rows%items%pass_allocatable(values)
    call rows%items%add_text(reason)
  end subroutine add_failed_row

  !> Appends other rows.
  pure subroutine append_rows(rows, more)
    type(rows_t), intent(inout) :: rows !! so far
    type(rows_t), intent(in) :: more    !! rows to append

    associate (bytes => more%items%bytes)
      if (bytes%length > 0) call append_text(rows%items%bytes, bytes%storage(:bytes%length))
    end associate
  end subroutine append_rows

  !> Reads the first item, then one after the other. Rows are complete when they are read.
  pure subroutine next_item(rows, item, found)
    type(rows_t), intent(inout) :: rows     !! to read
    type(row_item_t), intent(inout) :: item !! unchanged if none is found
    logical, intent(out) :: found           !! false beyond the last item; the next one is the first
                                            !! again

    if (.not. rows%items%reads) rows%items%at = 1
    found = .not. rows%items%is_at_end()
    rows%items%reads = found
    if (.not. found) return
    call rows%items%pass(item%kind)
    select case (item%kind)
    case (item_row)
      call rows%items%pass_text(item%text)
    case (item_gap)
      call rows%items%pass(item%lines)
    case (item_failure)
      call rows%items%pass_allocatable(item%place)
      call rows%items%pass_text(item%text)
    end select
  end subroutine next_item

  !> Passes rows.
  pure subroutine pass_rows(stream, rows)
    type(byte_stream_t), intent(inout) :: stream
    type(rows_t), intent(inout) :: rows

    call stream%pass_bytes(rows%items%bytes)
  end subroutine pass_rows

end module table_rows
