!> `kinematics.dat`: angles, angular velocities and accelerations of the links, moving pins,
!! transmission angle.
module kinematics_report
  use drive_motions, only: drive_rates
  use kinematics_study, only: four_bar_at_speed
  use linkage_notes, only: angle_note, notes_on_linkage
  use load_notes, only: acceleration_note
  use position_rows, only: add_position_row
  use report_kinds, only: four_bars, report_kind_t
  use report_types, only: add_table, report_record_t, state_table_t
  use table_columns, only: table_layout_t
  use table_rows, only: rows_t
  use text, only: append_string, string_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_kinematics

  !> `kinematics.dat` of a four-bar.
  type, extends(state_table_t) :: kinematics_table_t
  contains
    procedure, nopass :: find_notes => kinematics_notes
    procedure, nopass :: add_position => add_kinematics
  end type kinematics_table_t

contains

  !> REPORT kinematics.
  subroutine describe_kinematics(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="kinematics", help="how the links move", &
      pattern="REPORT kinematics [columns=] [format=]", studies="kinematics", positions=.true., &
      reserved=.true., linkages=four_bars, numbers=11)
    call add_table(report, kinematics_table_t(), "kinematics", "speed:speed crank,theta3,"// &
      "theta4:deg omega3,omega4:rate alpha3,alpha4:rad/s2 Ax,Ay,Bx,By:length "// &
      "transmission_angle:deg")
  end subroutine describe_kinematics

  !> Notes on the linkage, the links and pins that the columns refer to, the crank's acceleration.
  pure subroutine kinematics_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with class and transmission angles
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    notes = notes_on_linkage(variant)
    call append_string(notes, angle_note(variant))
    associate (pins => variant%mechanism%pin_names(variant%mechanism%four_bar%pin))
      if (pins(2)%text /= "A" .or. pins(3)%text /= "B") call append_string(notes, "A: pin "// &
        pins(2)%text//"; B: pin "//pins(3)%text)
    end associate
    call append_string(notes, acceleration_note(variant%model))
  end subroutine kinematics_notes

  !> Appends the row of a position and speed.
  subroutine add_kinematics(variant, layout, position, speed, rows)
    type(variant_results_t), intent(in) :: variant !! with its positions
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: position                !! number in the deck's list, with a pose
    integer, intent(in) :: speed                   !! number in the deck's list
    type(rows_t), intent(inout) :: rows            !! to which it is appended

    associate (rates => drive_rates(variant%model, speed, position), &
        positions => variant%found%positions, mechanism => variant%mechanism)
      call add_position_row(variant, layout, position, speed, four_bar_at_speed( &
        mechanism%linkage, mechanism%four_bar, positions%states(positions%state(position)), &
        rates(1), rates(2)), rows)
    end associate
  end subroutine add_kinematics

end module kinematics_report
