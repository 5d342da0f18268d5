!> `points.dat`: paths, velocities and accelerations of points fixed to links.
module points_report
  use body_lines, only: place_words
  use drive_motions, only: drive_rates
  use load_notes, only: acceleration_note
  use points_study, only: point_at_speed
  use position_rows, only: add_position_row
  use report_kinds, only: report_kind_t
  use report_types, only: add_table, report_record_t, state_table_t, table_plan_t
  use table_columns, only: name_list_t, table_layout_t, table_unit
  use table_rows, only: rows_t
  use text, only: append_string, string_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_points, point_names

  !> `points.dat`.
  type, extends(state_table_t) :: points_table_t
  contains
    procedure, nopass :: find_notes => points_notes
    procedure, nopass :: plan => plan_points
    procedure, nopass :: add_position => add_points
  end type points_table_t

contains

  !> REPORT points.
  subroutine describe_points(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="points", help="paths, velocities and accelerations of "// &
      "points", pattern="REPORT points [columns=]", studies="points", positions=.true.)
    call add_table(report, points_table_t(), "points", "speed:speed crank:deg point:name x,"// &
      "y:length vx,vy:velocity ax,ay:acceleration")
  end subroutine describe_points

  !> Place of every point on its link, axes, the crank's angular acceleration.
  pure subroutine points_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its model
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    integer :: i

    associate (model => variant%model)
      do i = 1, size(model%points)
        associate (point => model%points(i), link => model%links(model%points(i)%link))
          call append_string(notes, "point "//point%name%text//": on link "//link%name%text// &
            ", "//place_words(point%place, table_unit("length", model%outputs))//" from "// &
            link%pins(1)%text)
        end associate
      end do
      call append_string(notes, "global axes; "//acceleration_note(model))
    end associate
  end subroutine points_notes

  !> The names in the column `point`.
  pure function point_names(variant) result(list)
    type(variant_results_t), intent(in) :: variant !! with its mechanism
    type(name_list_t) :: list

    integer :: i

    list%column = "point"
    allocate (list%names(size(variant%mechanism%points)))
    do i = 1, size(list%names)
      list%names(i)%text = variant%mechanism%points(i)%name
    end do
  end function point_names

  !> Appends the rows of a position and speed, one per point.
  subroutine add_points(variant, layout, position, speed, rows)
    type(variant_results_t), intent(in) :: variant !! with its points computed
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: position                !! number in the deck's list, with a pose
    integer, intent(in) :: speed                   !! number in the deck's list
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    integer :: p

    associate (rates => drive_rates(variant%model, speed, position), &
        state => variant%found%positions%state(position), points => variant%mechanism%points)
      do p = 1, size(points)
        call add_position_row(variant, layout, position, speed, point_at_speed( &
          variant%found%points(p, state), rates(1), rates(2)), rows, points(p)%name)
      end do
    end associate
  end subroutine add_points

  !> A column `point`.
  subroutine plan_points(variant, plan)
    type(variant_results_t), intent(in) :: variant !! with its results
    type(table_plan_t), intent(inout) :: plan      !! of the table

    plan%names(1) = point_names(variant)
  end subroutine plan_points

end module points_report
