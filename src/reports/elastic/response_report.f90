! src/reports/elastic/ - tables of links that bend: frequencies, loci, response, strains, stability.
! In: a `variant_results_t`. Out: rows. A file describes one report, or two, for `list_reports` in
! `src/reports/report_table.f90`. Begin with `describe_response` here, a short one. Shared:
! `plan_gauges` in `strains_report.f90`, `stability_words` in `stability_report.f90`.
! Not here: notes common to the response (`src/reports/words/response_notes.f90`), results
! (`src/studies/elastic`).

!> `response.dat`: displacements of pins and points from where they are with rigid links.
module response_report
  use constants, only: degree
  use position_rows, only: add_position_row
  use report_kinds, only: report_kind_t
  use report_types, only: add_table, report_record_t, response_table_t, table_plan_t
  use response_notes, only: append_response_notes
  use table_columns, only: name_list_t, table_layout_t
  use table_rows, only: rows_t
  use text, only: append_string, string_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_response, plan_response

  !> `response.dat`.
  type, extends(response_table_t) :: response_points_table_t
  contains
    procedure, nopass :: find_notes => response_notes_of
    procedure, nopass :: plan => plan_response
    procedure, nopass :: add_position => add_response
  end type response_points_table_t

contains

  !> REPORT response.
  subroutine describe_response(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="response", help="how far pins and points are from "// &
      "where rigid links are", pattern="REPORT response [accuracy=] [columns=]", &
      default="accuracy=1e-6", studies="response", positions=.true., response=.true.)
    call add_table(report, response_points_table_t(), "response", "speed:speed crank:deg "// &
      "point:name ux,uy:length rotation:deg error:-")
  end subroutine describe_response

  !> Meaning of the columns, and what all tables of the response say.
  pure subroutine response_notes_of(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its response computed
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    call append_string(notes, "ux, uy: displacement from the place that the point has with "// &
      "rigid links at the same crank angle, in global axes; rotation: of the link there, "// &
      "counter-clockwise")
    call append_string(notes, "A:crank: pin A as the end of link crank, and so on: the links "// &
      "at a pin have one displacement there, and rotations of their own")
    call append_response_notes(notes, variant)
  end subroutine response_notes_of

  !> The names in the column `point`.
  pure function response_point_names(variant) result(list)
    type(variant_results_t), intent(in) :: variant !! with its mechanism
    type(name_list_t) :: list

    integer :: i

    list%column = "point"
    allocate (list%names(size(variant%mechanism%response_points)))
    do i = 1, size(list%names)
      list%names(i)%text = variant%mechanism%response_points(i)%name
    end do
  end function response_point_names

  !> Appends the rows of a position and speed, one per point.
  subroutine add_response(variant, layout, position, speed, rows)
    type(variant_results_t), intent(in) :: variant !! with a response at this speed
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: position                !! number in the deck's list
    integer, intent(in) :: speed                   !! number in the deck's list
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    integer :: i

    associate (found => variant%found%response%at_speed(speed), &
        points => variant%mechanism%response_points)
      do i = 1, size(points)
        associate (u => found%displacement(:, i, position))
          call add_position_row(variant, layout, position, speed, [u(1), u(2), u(3)/degree, &
            found%displacement_error(i)], rows, points(i)%name)
        end associate
      end do
    end associate
  end subroutine add_response

  !> A column `point`.
  subroutine plan_response(variant, plan)
    type(variant_results_t), intent(in) :: variant !! with its results
    type(table_plan_t), intent(inout) :: plan      !! of the table

    plan%names(1) = response_point_names(variant)
  end subroutine plan_response

end module response_report
