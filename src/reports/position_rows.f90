!> Rows of tables of positions and speeds: numbers, or the numbers of something with a name.
module position_rows
  use drive_motions, only: place_columns, table_place
  use kinds, only: wp
  use table_columns, only: cells, column_width, table_layout_t
  use table_rows, only: add_row, rows_t
  use tables, only: name_cell
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: add_position_row

contains

  !> Appends a row: its place, the name of what it is about if there are several, then values.
  subroutine add_position_row(variant, layout, position, speed, values, rows, name)
    type(variant_results_t), intent(in) :: variant !! with its positions
    type(table_layout_t), intent(in) :: layout     !! of the table
    integer, intent(in) :: position                !! number in the deck's list, with a pose
    integer, intent(in) :: speed                   !! number in the deck's list
    real(wp), intent(in) :: values(:)              !! quantities in SI, others in their column's
                                                   !! unit
    type(rows_t), intent(inout) :: rows            !! to which it is appended
    character(len=*), intent(in), optional :: name !! for the column behind the place

    real(wp) :: place(place_columns(variant%model))
    integer :: next

    place = table_place(variant%model, speed, position)
    if (.not. present(name)) then
      call add_row(rows, cells(layout, 1, [place, values]))
      return
    end if
    next = size(place) + 1
    call add_row(rows, cells(layout, 1, place)//name_cell(name, column_width(layout, next))// &
      cells(layout, next + 1, values))
  end subroutine add_position_row

end module position_rows
