!> `drive.dat`: the driving torque of the elastic linkage with its parts, and the power.
module drive_report
  use position_rows, only: add_position_row
  use report_kinds, only: four_bars, report_kind_t
  use report_types, only: add_table, report_record_t, response_table_t
  use response_notes, only: append_response_notes
  use table_columns, only: table_layout_t, table_unit
  use table_rows, only: rows_t
  use text, only: append_string, string_t, to_string
  use units, only: from_si, unit_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_drive, describe_torque

  !> `drive.dat` of a four-bar and `torque.dat`.
  type, extends(response_table_t) :: drive_table_t
  contains
    procedure, nopass :: find_notes => drive_notes
    procedure, nopass :: add_position => add_drive
  end type drive_table_t

contains

  !> REPORT drive of four-bars, as REPORT torque was called.
  subroutine describe_drive(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="drive", help="older name of REPORT torque", &
      pattern="REPORT drive [accuracy=]", default="accuracy=1e-6", offered=.false., &
      studies="response", positions=.true., response=.true., linkages=four_bars)
    call add_table(report, drive_table_t(), "drive", "speed:speed crank:deg rigid,linear,"// &
      "quadratic,total:moment power:power error:-")
  end subroutine describe_drive

  !> REPORT torque.
  subroutine describe_torque(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="torque", help="the torque of the elastic linkage, with "// &
      "its parts", pattern="REPORT torque [accuracy=] [columns=]", default="accuracy=1e-6", &
      studies="response", positions=.true., response=.true.)
    call add_table(report, drive_table_t(), "torque", "speed:speed crank:deg rigid,linear,"// &
      "quadratic,total:moment power:power error:-")
  end subroutine describe_torque

  !> Meaning of the columns, mean torques, and what all tables of the response say.
  pure subroutine drive_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its response computed
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    integer :: body

    body = max(1, variant%mechanism%linkage%drives(1)%body)
    call append_string(notes, "torque of the drive on link "//variant%mechanism%names(body)%text// &
      ", counter-clockwise positive; rigid: of the rigid linkage; linear, quadratic: what the "// &
      "deformations add, in terms linear and quadratic in them; total: the sum; power: total x "// &
      "speed")
    if (variant%model%without%quadratic) call append_string(notes, "quadratic: left out by "// &
      "EFFECTS response: 0, and not in the total")
    call append_means(notes, variant)
    call append_response_notes(notes, variant)
  end subroutine drive_notes

  !> The mean torque of the only speed. Over a turn it does as much work as damping takes, unless a
  !! TORQUE does work, too, or terms of the equations are left out.
  pure subroutine append_means(notes, variant)
    type(string_t), allocatable, intent(inout) :: notes(:)
    type(variant_results_t), intent(in) :: variant

    type(unit_t) :: moment
    character(len=:), allocatable :: words

    associate (at_speed => variant%found%response%at_speed, model => variant%model)
      if (size(at_speed) /= 1) return
      if (allocated(at_speed(1)%error)) return
      moment = table_unit("moment", model%outputs)
      words = "mean of total over the turn: "//to_string(from_si(at_speed(1)%mean_torque, &
        moment), 8)//" "//moment%name
      if (size(model%torques) == 0 .and. model%without%keyword%line == 0) words = words// &
        "; times the speed it is the power that damping takes"
      call append_string(notes, words)
    end associate
  end subroutine append_means

  !> Appends the row of a position and speed.
  subroutine add_drive(variant, layout, position, speed, rows)
    type(variant_results_t), intent(in) :: variant !! with a response at this speed
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: position                !! number in the deck's list
    integer, intent(in) :: speed                   !! number in the deck's list
    type(rows_t), intent(inout) :: rows            !! to which it is appended

    associate (found => variant%found%response%at_speed(speed))
      call add_position_row(variant, layout, position, speed, [found%drive(:, position), &
        found%drive_error], rows)
    end associate
  end subroutine add_drive

end module drive_report
