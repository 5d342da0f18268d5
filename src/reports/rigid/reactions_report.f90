!> `reactions.dat`: pin forces, driving torque, shaking force and shaking moment.
module reactions_report
  use drive_motions, only: drive_rates
  use load_notes, only: append_load_notes, append_motion_notes
  use position_rows, only: add_position_row
  use four_bar_reactions, only: reactions_at_speed
  use report_kinds, only: four_bars, report_kind_t
  use report_types, only: add_table, report_record_t, state_table_t
  use table_columns, only: table_layout_t
  use table_rows, only: rows_t
  use text, only: append_string, string_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_reactions

  !> `reactions.dat` of a four-bar.
  type, extends(state_table_t) :: reactions_table_t
  contains
    procedure, nopass :: find_notes => reactions_notes
    procedure, nopass :: add_position => add_reactions
  end type reactions_table_t

contains

  !> REPORT reactions.
  subroutine describe_reactions(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="reactions", help="forces in the pins, torque, shaking "// &
      "force and moment", pattern="REPORT reactions [columns=] [format=]", studies="joints", &
      positions=.true., masses=.true., linkages=four_bars, numbers=104)
    call add_table(report, reactions_table_t(), "reactions", "speed:speed crank:deg O2x,O2y,"// &
      "A2x,A2y,A3x,A3y,B3x,B3y,B4x,B4y,O4x,O4y:force torque:moment shaking_x,shaking_y:force "// &
      "shaking_moment:moment")
  end subroutine describe_reactions

  !> The link on which each force acts, axes and signs, definitions, loads.
  pure subroutine reactions_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its mechanism
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    call append_motion_notes(notes, variant%model, variant%mechanism, .true.)
    call append_string(notes, "forces in global axes: A2 on link 2 at A, and so on; "// &
      "O2 and O4 of the ground on links 2 and 4")
    call append_string(notes, "torque: of the drive on link 2, counter-clockwise positive")
    call append_string(notes, "shaking: resultant of -m a of all masses; shaking_moment: of "// &
      "these and of -I alpha of all links, about pin "//variant%mechanism%pin_names( &
      variant%mechanism%four_bar%pin(1))%text// &
      "; weights and external loads are not included")
    call append_load_notes(notes, variant%model, variant%mechanism)
  end subroutine reactions_notes

  !> Appends the row of a position and speed.
  subroutine add_reactions(variant, layout, position, speed, rows)
    type(variant_results_t), intent(in) :: variant !! with reactions computed
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: position                !! number in the deck's list, with a pose
    integer, intent(in) :: speed                   !! number in the deck's list
    type(rows_t), intent(inout) :: rows            !! to which it is appended

    associate (rates => drive_rates(variant%model, speed, position), &
        state => variant%found%positions%state(position))
      call add_position_row(variant, layout, position, speed, &
        reactions_at_speed(variant%mechanism%four_bar, variant%found%joints, state, rates(1), &
        rates(2), speed), rows)
    end associate
  end subroutine add_reactions

end module reactions_report
