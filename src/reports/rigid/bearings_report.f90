!> `bearings.dat`: the force in every joint, in global axes and in those of the link on which it
!! acts.
module bearings_report
  use drive_motions, only: drive_rates, place_columns, table_place
  use joint_study, only: bearings_at_speed
  use joints_report, only: add_open_row, owner_cell, plan_joints
  use kinds, only: wp
  use load_notes, only: acceleration_note, append_load_notes
  use report_kinds, only: report_kind_t
  use report_types, only: add_table, report_record_t, state_table_t
  use table_columns, only: cells, column_width, table_layout_t
  use table_rows, only: add_row, rows_t
  use tables, only: name_cell
  use text, only: append_string, string_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_bearings

  !> `bearings.dat`.
  type, extends(state_table_t) :: bearings_table_t
  contains
    procedure, nopass :: find_notes => bearings_notes
    procedure, nopass :: plan => plan_joints
    procedure, nopass :: add_position => add_bearings
  end type bearings_table_t

contains

  !> REPORT bearings.
  subroutine describe_bearings(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="bearings", help="forces in the joints, in the axes of "// &
      "the links too", pattern="REPORT bearings [columns=]", studies="joints", positions=.true., &
      masses=.true., numbers=82)
    call add_table(report, bearings_table_t(), "bearings", "speed:speed crank:deg pin,"// &
      "link:name fx,fy,axial,transverse,magnitude:force angle:deg")
  end subroutine describe_bearings

  !> On what the forces act, both axes, the angle, loads.
  pure subroutine bearings_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its mechanism
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    call append_string(notes, "forces on the link at the pin; of a guide: by the guide on the "// &
      "pin; of a block on a link: by the block on that link")
    call append_string(notes, "fx, fy: in global axes; axial, transverse: in those of the "// &
      "link, along the way from the first pin of its card to the second, and to the left of "// &
      "it; of a guide, along it and to its left")
    call append_string(notes, "angle: of the force in the axes of the link, counter-clockwise "// &
      "from axial; 0 where a force is only round-off")
    call append_string(notes, acceleration_note(variant%model))
    call append_load_notes(notes, variant%model, variant%mechanism)
  end subroutine bearings_notes

  !> Appends the rows of a position and speed, one per joint.
  subroutine add_bearings(variant, layout, position, speed, rows)
    type(variant_results_t), intent(in) :: variant !! with its joints computed
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: position                !! number in the deck's list, with a pose
    integer, intent(in) :: speed                   !! number in the deck's list
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    real(wp) :: place(place_columns(variant%model)), rates(2)
    integer :: i, next

    place = table_place(variant%model, speed, position)
    next = size(place) + 1
    rates = drive_rates(variant%model, speed, position)
    associate (mechanism => variant%mechanism, found => variant%found%joints, &
        state => variant%found%positions%state(position))
      associate (values => bearings_at_speed(mechanism%linkage, found, &
          variant%found%positions%states(state)%pose, state, rates(1), rates(2), speed))
        do i = 1, size(found%joints)
          if (found%is_open(i, state)) then
            call add_open_row(rows, place, variant, found%joints(i))
            cycle
          end if
          call add_row(rows, cells(layout, 1, place)// &
            name_cell(mechanism%pin_names(found%joints(i)%pin)%text, column_width(layout, next))// &
            owner_cell(variant, found%joints(i), column_width(layout, next + 1))// &
            cells(layout, next + 2, values(:, i)))
        end do
      end associate
    end associate
  end subroutine add_bearings

end module bearings_report
