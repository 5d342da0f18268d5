!> Rows of a table, found on several threads and put in order.
module report_rows
  use report_types, only: add_item_rows, table_plan_t
  use table_columns, only: find_chosen_cells
  use table_rows, only: append_rows, keep_cells, rows_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: find_rows

contains

  !> Appends the rows of the items `first` to `last`, in their order.
  subroutine find_rows(plan, variant, first, last, threads, rows)
    type(table_plan_t), intent(in) :: plan         !! of the table
    type(variant_results_t), intent(in) :: variant !! with all results that the table needs
    integer, intent(in) :: first, last             !! numbers of items, from 1
    integer, intent(in) :: threads                 !! number to use
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    type(rows_t), allocatable :: pieces(:)
    integer, allocatable :: first_cells(:), last_cells(:)
    integer :: items, piece, count, i

    call find_chosen_cells(plan%layout, first_cells, last_cells)
    call keep_cells(rows, first_cells, last_cells)
    if (threads == 1) then
      do i = first, last
        call add_item_rows(plan, variant, i, rows)
      end do
      return
    end if
    items = last - first + 1
    count = max(1, min(4*threads, items))
    allocate (pieces(count))
    do piece = 1, count
      call keep_cells(pieces(piece), first_cells, last_cells)
    end do
    !$omp parallel do num_threads(threads) schedule(dynamic) default(shared) private(piece, i)
    do piece = 1, count
      do i = first + ((piece - 1)*items)/count, first + (piece*items)/count - 1
        call add_item_rows(plan, variant, i, pieces(piece))
      end do
    end do
    !$omp end parallel do
    do piece = 1, count
      call append_rows(rows, pieces(piece))
    end do
  end subroutine find_rows

end module report_rows
