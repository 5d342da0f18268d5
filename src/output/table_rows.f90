!> Rows of a table before they are written: their cells as text, the gaps between blocks, and what
!! could not be computed.
!!
!! They are bytes, one item after the other, so that pieces found at the same time are put together
!! by putting their bytes together, are kept in a journal as they are, and go from one process to
!! another.
module table_rows
  use byte_streams, only: get_integers, get_reals, get_string, put_integers, put_reals, put_string
  use kinds, only: wp
  use text_buffer, only: append_text, text_buffer_t
  implicit none (type, external)
  private

  public :: rows_t, row_item_t, add_row, add_gap, add_failure, append_rows, next_item, put_rows, &
    get_rows
  public :: item_row, item_gap, item_failure

  !> What an item is.
  integer, parameter :: item_row = 1, item_gap = 2, item_failure = 3

  type :: rows_t
    type(text_buffer_t), private :: buffer
  end type rows_t

  !> One item.
  type :: row_item_t
    integer :: kind = 0                    !! item_row, item_gap or item_failure
    character(len=:), allocatable :: text  !! the cells of a row, why one has failed
    integer :: lines = 0                   !! of a gap
    real(wp), allocatable :: place(:)      !! what the first columns of a failed row hold
  end type row_item_t

contains

  !> A row of cells as text, each as wide as its column.
  pure subroutine add_row(rows, cells)
    type(rows_t), intent(inout) :: rows
    character(len=*), intent(in) :: cells

    call put_integers(rows%buffer, [item_row])
    call put_string(rows%buffer, cells)
  end subroutine add_row

  !> Empty lines: one where a curve breaks, two between blocks.
  pure subroutine add_gap(rows, lines)
    type(rows_t), intent(inout) :: rows
    integer, intent(in) :: lines

    call put_integers(rows%buffer, [item_gap, lines])
  end subroutine add_gap

  !> A row that could not be computed.
  pure subroutine add_failure(rows, place, reason)
    type(rows_t), intent(inout) :: rows
    real(wp), intent(in) :: place(:) !! what its first columns hold: speed, crank angle
    character(len=*), intent(in) :: reason

    call put_integers(rows%buffer, [item_failure, size(place)])
    call put_reals(rows%buffer, place)
    call put_string(rows%buffer, reason)
  end subroutine add_failure

  !> Puts more rows behind those that are there.
  pure subroutine append_rows(rows, more)
    type(rows_t), intent(inout) :: rows
    type(rows_t), intent(in) :: more

    if (more%buffer%length > 0) call append_text(rows%buffer, &
      more%buffer%storage(:more%buffer%length))
  end subroutine append_rows

  !> Reads the item at a place, from 1, and moves on to the next; `found` is false behind the last.
  pure subroutine next_item(rows, at, item, found)
    type(rows_t), intent(in) :: rows
    integer, intent(inout) :: at
    type(row_item_t), intent(inout) :: item
    logical, intent(out) :: found

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

  !> Appends rows to a buffer as bytes.
  pure subroutine put_rows(buffer, rows)
    type(text_buffer_t), intent(inout) :: buffer
    type(rows_t), intent(in) :: rows

    call put_integers(buffer, [rows%buffer%length])
    if (rows%buffer%length > 0) call append_text(buffer, rows%buffer%storage(:rows%buffer%length))
  end subroutine put_rows

  !> Reads what `put_rows` wrote.
  pure subroutine get_rows(bytes, at, rows)
    character(len=*), intent(in) :: bytes
    integer, intent(inout) :: at !! place of the first byte; moves past the last
    type(rows_t), intent(out) :: rows

    integer :: length(1)

    call get_integers(bytes, at, length)
    if (length(1) > 0) call append_text(rows%buffer, bytes(at:at + length(1) - 1))
    at = at + length(1)
  end subroutine get_rows

end module table_rows
