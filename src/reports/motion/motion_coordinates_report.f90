!> `motion_coordinates.dat`: springs, dampers, rams, sliders and measures while the linkage moves
!! under its motor and loads.
module motion_coordinates_report
  use coordinates_report, only: coordinate_names, coordinate_notes, shown_state, state_columns
  use models, only: model_t
  use motion_pins_report, only: add_early_end, time_in_table
  use motion_study, only: undetermined_message
  use report_types, only: fit_columns, table_plan_t, whole_table_t
  use table_columns, only: cells, column_width, table_layout_t
  use table_rows, only: add_failed_row, add_row, rows_t
  use tables, only: name_cell, real_cells
  use text, only: append_string, string_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: motion_coordinates_table_t

  !> `motion_coordinates.dat`.
  type, extends(whole_table_t) :: motion_coordinates_table_t
  contains
    procedure, nopass :: find_notes => motion_coordinates_notes
    procedure, nopass :: plan => plan_motion_coordinates
    procedure, nopass :: fit => fit_motion_coordinates
    procedure, nopass :: add_all => add_motion_coordinates
  end type motion_coordinates_table_t

contains

  !> Units and signs.
  pure subroutine motion_coordinates_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its mechanism
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    notes = coordinate_notes(variant)
    call append_string(notes, "instants of motion.dat")
  end subroutine motion_coordinates_notes

  !> A column `coordinate`.
  subroutine plan_motion_coordinates(variant, plan)
    type(variant_results_t), intent(in) :: variant !! with its results
    type(table_plan_t), intent(inout) :: plan      !! of the table

    plan%names(1) = coordinate_names(variant)
  end subroutine plan_motion_coordinates

  !> Columns in the units of the coordinates.
  pure subroutine fit_motion_coordinates(model, columns)
    type(model_t), intent(in) :: model         !! with its springs, drives and measures
    character(len=*), intent(inout) :: columns !! of the record

    columns = "time:time coordinate:name "//state_columns(model)
    call fit_columns(model, columns)
  end subroutine fit_motion_coordinates

  !> Appends, for every instant, a row per coordinate, and a failed row if the motion ends before
  !! its end time.
  subroutine add_motion_coordinates(variant, layout, rows)
    type(variant_results_t), intent(in) :: variant !! with its motion and the coordinates of it
    type(table_layout_t), intent(in) :: layout     !! of this table
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    integer :: i, k

    associate (motion => variant%found%motion, listed => variant%mechanism%coordinates)
      do i = 1, motion%count
        if (.not. motion%is_determined(i)) then
          call add_failed_row(rows, [time_in_table(variant%model, i)], undetermined_message)
          cycle
        end if
        do k = 1, size(listed)
          call add_row(rows, real_cells([time_in_table(variant%model, i)])// &
            name_cell(listed(k)%name, column_width(layout, 2))//cells(layout, 3, &
            shown_state(variant, k, motion%coordinates(k, i))))
        end do
      end do
    end associate
    call add_early_end(variant, rows)
  end subroutine add_motion_coordinates

end module motion_coordinates_report
