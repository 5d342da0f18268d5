!> How many positions of a list a run keeps in memory at a time.
module kept_positions
  use kinds, only: wp
  use models, only: model_t, needs_positions
  use report_table, only: tables_of
  use report_types, only: any_table_t
  implicit none (type, external)
  private

  public :: positions_kept, many_rows

  !> A variant with more rows is computed by all ranks together, and its rows do not wait in memory.
  integer, parameter :: many_rows = 100000

  !> Rows of a block, and the least of its positions: enough for all threads. Tasks of frequencies
  !! have 64 positions.
  integer, parameter :: rows_of_block = 16384, least_positions = 1024, of_task = 64

contains

  !> Positions of a block if a list comes in blocks, as it does if no table looks back; else all.
  function positions_kept(model) result(count)
    type(model_t), intent(in) :: model !! of a variant
    integer :: count

    type(any_table_t), allocatable :: tables(:)
    integer :: speeds, i

    count = size(model%crank%value)
    speeds = max(1, size(model%speed%value))
    if (count*real(speeds, wp) <= many_rows .or. count <= least_positions .or. .not. &
      needs_positions(model)) return
    call tables_of(model, tables)
    do i = 1, size(tables)
      if (tables(i)%table%looks_back()) return
    end do
    count = min(count, max(least_positions, of_task*(rows_of_block/(of_task*speeds))))
  end function positions_kept

end module kept_positions
