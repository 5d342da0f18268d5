!> `pins.dat`: paths, velocities and accelerations of the pins.
module pins_report
  use drive_motions, only: drive_rates
  use kinematics_study, only: pin_at_speed
  use load_notes, only: acceleration_note
  use position_rows, only: add_position_row
  use report_kinds, only: report_kind_t
  use report_types, only: add_table, report_record_t, state_table_t, table_plan_t
  use table_columns, only: name_list_t, table_layout_t
  use table_rows, only: rows_t
  use text, only: append_string, string_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_pins, plan_pins, pin_names

  !> `pins.dat`.
  type, extends(state_table_t) :: pins_table_t
  contains
    procedure, nopass :: find_notes => pins_notes
    procedure, nopass :: plan => plan_pins
    procedure, nopass :: add_position => add_pins
  end type pins_table_t

contains

  !> REPORT pins.
  subroutine describe_pins(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="pins", help="paths, velocities and accelerations of "// &
      "the pins", pattern="REPORT pins [columns=]", positions=.true.)
    call add_table(report, pins_table_t(), "pins", "speed:speed crank:deg pin:name x,"// &
      "y:length vx,vy:velocity ax,ay:acceleration")
  end subroutine describe_pins

  !> Axes, and the acceleration of the first drive.
  pure subroutine pins_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its model
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    call append_string(notes, "global axes; "//acceleration_note(variant%model))
  end subroutine pins_notes

  !> The names in a column `pin`.
  pure function pin_names(variant) result(list)
    type(variant_results_t), intent(in) :: variant !! with its mechanism
    type(name_list_t) :: list

    list%column = "pin"
    list%names = variant%mechanism%pin_names
  end function pin_names

  !> Appends the rows of a position and speed, one per moving pin.
  subroutine add_pins(variant, layout, position, speed, rows)
    type(variant_results_t), intent(in) :: variant !! with its positions
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: position                !! number in the deck's list, with a pose
    integer, intent(in) :: speed                   !! number in the deck's list
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    integer :: p

    associate (positions => variant%found%positions, mechanism => variant%mechanism, &
        rates => drive_rates(variant%model, speed, position))
      associate (state => positions%states(positions%state(position)))
        do p = 1, size(mechanism%pin_names)
          if (mechanism%linkage%is_ground(p)) cycle
          call add_position_row(variant, layout, position, speed, pin_at_speed(state, p, &
            rates(1), rates(2)), rows, mechanism%pin_names(p)%text)
        end do
      end associate
    end associate
  end subroutine add_pins

  !> A column `pin`.
  subroutine plan_pins(variant, plan)
    type(variant_results_t), intent(in) :: variant !! with its results
    type(table_plan_t), intent(inout) :: plan      !! of the table

    plan%names(1) = pin_names(variant)
  end subroutine plan_pins

end module pins_report
