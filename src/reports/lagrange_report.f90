!> `lagrange.dat`: terms of Lagrange's equation, driving torque, energies.
module lagrange_report
  use drive_motions, only: drive_rates
  use lagrange_study, only: lagrange_at_speed
  use load_notes, only: append_load_notes, append_motion_notes, potential_note
  use position_rows, only: add_position_row
  use table_columns, only: table_layout_t
  use table_rows, only: rows_t
  use text, only: append_string, string_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: lagrange_notes, add_lagrange

contains

  !> Definition of the terms, and the loads.
  pure subroutine lagrange_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its mechanism
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    call append_motion_notes(notes, variant%model, variant%mechanism)
    call append_string(notes, "torque = M alpha2 + V + gravity + load, of the drive on link 2, "// &
      "counter-clockwise positive")
    call append_string(notes, "M: inertia reduced to the crank; dM: dM/dtheta2; "// &
      "V = dM omega2^2/2; gravity: dU/dtheta2 of the weights; load: to balance the external loads")
    call append_string(notes, "kinetic = M omega2^2/2; "//potential_note)
    call append_load_notes(notes, variant%model, variant%mechanism)
  end subroutine lagrange_notes

  !> Appends the row of a position and speed.
  subroutine add_lagrange(variant, layout, position, speed, rows)
    type(variant_results_t), intent(in) :: variant !! with the Lagrange terms computed
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: position                !! number in the deck's list, with a pose
    integer, intent(in) :: speed                   !! number in the deck's list
    type(rows_t), intent(inout) :: rows            !! to which it is appended

    associate (rates => drive_rates(variant%model, speed, position), &
        state => variant%found%positions%state(position))
      call add_position_row(variant, layout, position, speed, &
        lagrange_at_speed(variant%found%lagrange, state, rates(1), rates(2), speed), rows)
    end associate
  end subroutine add_lagrange

end module lagrange_report
