!> `lagrange.dat`: terms of Lagrange's equation, driving torque, energies.
module lagrange_report
  use drive_motions, only: drive_rates
  use lagrange_study, only: lagrange_at_speed
  use load_notes, only: append_load_notes, append_motion_notes, potential_note
  use models, only: drives_length, model_t
  use position_rows, only: add_position_row
  use report_kinds, only: report_kind_t
  use report_types, only: add_table, fit_columns, report_record_t, state_table_t
  use table_columns, only: table_layout_t
  use table_rows, only: rows_t
  use text, only: append_string, string_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_lagrange

  !> `lagrange.dat`.
  type, extends(state_table_t) :: lagrange_table_t
  contains
    procedure, nopass :: find_notes => lagrange_notes
    procedure, nopass :: fit => fit_lagrange
    procedure, nopass :: add_position => add_lagrange
  end type lagrange_table_t

contains

  !> REPORT lagrange.
  subroutine describe_lagrange(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="lagrange", help="the torque from energies", &
      pattern="REPORT lagrange [columns=]", studies="lagrange", positions=.true., &
      masses=.true., weighs=.true., numbers=5)
    call add_table(report, lagrange_table_t(), "lagrange", "speed:speed crank:deg M,"// &
      "dM:inertia V,gravity,load,torque:moment kinetic,potential:energy")
  end subroutine describe_lagrange

  !> Definition of the terms, and the loads.
  pure subroutine lagrange_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its mechanism
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    call append_motion_notes(notes, variant%model, variant%mechanism, &
      variant%mechanism%is_four_bar)
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

  !> What turns a crank is a force on a slider, and its inertia a mass.
  pure subroutine fit_lagrange(model, columns)
    type(model_t), intent(in) :: model         !! with its drives
    character(len=*), intent(inout) :: columns !! of the record

    if (drives_length(model)) columns = "speed:speed crank:deg M:mass dM:mass_per_length "// &
      "V,gravity,load,torque:force kinetic,potential:energy"
    call fit_columns(model, columns)
  end subroutine fit_lagrange

end module lagrange_report
