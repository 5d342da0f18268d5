!> `motion_forces.dat`: the forces in the joints of a linkage that is no four-bar, while it moves
!! under its motor and loads.
module motion_forces_report
  use joints_report, only: add_open_row, friction_note, owner_cell, plan_joints
  use load_notes, only: append_load_notes
  use motion_pins_report, only: add_early_end, time_in_table
  use motion_study, only: undetermined_message
  use report_types, only: whole_table_t
  use table_columns, only: cells, column_width, table_layout_t
  use table_rows, only: add_failed_row, add_row, rows_t
  use tables, only: name_cell, real_cells
  use text, only: append_string, string_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: motion_forces_table_t

  !> `motion_forces.dat`.
  type, extends(whole_table_t) :: motion_forces_table_t
  contains
    procedure, nopass :: find_notes => motion_forces_notes
    procedure, nopass :: plan => plan_joints
    procedure, nopass :: add_all => add_motion_forces
  end type motion_forces_table_t

contains

  !> On what the forces act, axes and signs, loads.
  pure subroutine motion_forces_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its mechanism
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    call append_string(notes, "instants of motion.dat; forces and moments as in reactions.dat: "// &
      "in global axes on the link at the pin; of a guide: by the guide on the pin; of a block "// &
      "on a link: by the block on that link")
    call append_string(notes, "moment: on the link, of a weld or of a block on which it cannot "// &
      "turn; counter-clockwise positive")
    if (size(variant%model%frictions) > 0) call append_string(notes, friction_note)
    call append_load_notes(notes, variant%model, variant%mechanism)
  end subroutine motion_forces_notes

  !> Appends, for every instant, a row per joint, and a failed row if the motion ends before its end
  !! time.
  subroutine add_motion_forces(variant, layout, rows)
    type(variant_results_t), intent(in) :: variant !! with its motion and the forces of it
    type(table_layout_t), intent(in) :: layout     !! of this table
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    integer :: i, k

    associate (motion => variant%found%motion, mechanism => variant%mechanism)
      do i = 1, motion%count
        if (.not. motion%is_determined(i)) then
          call add_failed_row(rows, [time_in_table(variant%model, i)], undetermined_message)
          cycle
        end if
        do k = 1, size(motion%joints)
          if (motion%is_open(k, i)) then
            call add_open_row(rows, [time_in_table(variant%model, i)], variant, motion%joints(k))
            cycle
          end if
          call add_row(rows, real_cells([time_in_table(variant%model, i)])//name_cell( &
            mechanism%pin_names(motion%joints(k)%pin)%text, column_width(layout, 2))// &
            owner_cell(variant, motion%joints(k), column_width(layout, 3))//cells(layout, 4, &
            motion%force(:, k, i)))
        end do
      end do
    end associate
    call add_early_end(variant, rows)
  end subroutine add_motion_forces

end module motion_forces_report
