!> Rows of tables of positions and speeds that hold numbers only.
module position_rows
  use drive_motions, only: table_place
  use kinds, only: wp
  use table_columns, only: cells, table_layout_t
  use table_rows, only: add_row, rows_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: add_position_row

contains

  !> Appends a row: its place, then values.
  subroutine add_position_row(variant, layout, position, speed, values, rows)
    type(variant_results_t), intent(in) :: variant !! with its positions
    type(table_layout_t), intent(in) :: layout     !! of the table
    integer, intent(in) :: position                !! number in the deck's list, with a pose
    integer, intent(in) :: speed                   !! number in the deck's list
    real(wp), intent(in) :: values(:)              !! quantities in SI, others in their column's
                                                   !! unit
    type(rows_t), intent(inout) :: rows            !! to which it is appended

    call add_row(rows, cells(layout, 1, [table_place(variant%model, speed, position), values]))
  end subroutine add_position_row

end module position_rows
