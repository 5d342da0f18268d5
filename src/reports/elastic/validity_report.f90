!> `validity.dat`: what the linear equations of the response suppose, against what was found.
module validity_report
  use kinds, only: wp
  use mechanisms, only: way_length
  use number_text, only: number_width
  use report_kinds, only: report_kind_t
  use report_types, only: add_table, report_record_t, speed_table_t
  use response_notes, only: add_failed_speed, append_response_notes, has_response
  use response_types, only: speed_response_t
  use sections, only: outer_distance
  use table_columns, only: cells, column_width, table_layout_t
  use table_rows, only: add_row, rows_t
  use tables, only: name_cell
  use text, only: append_string, string_t, to_string
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_validity

  !> `validity.dat`.
  type, extends(speed_table_t) :: validity_table_t
  contains
    procedure, nopass :: find_notes => validity_notes
    procedure, nopass :: add_speed => add_validity
  end type validity_table_t

contains

  !> REPORT validity.
  subroutine describe_validity(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="validity", help="whether the equations of the response "// &
      "hold", pattern="REPORT validity [accuracy=]", default="accuracy=1e-6", studies="response", &
      response=.true.)
    call add_table(report, validity_table_t(), "validity", "speed:speed link:name deflection,"// &
      "load,quadratic:- out_of_plane:Hz distance,error:-")
  end subroutine describe_validity

  !> Meaning of the columns, and what all tables of the response say.
  pure subroutine validity_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its response computed
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    call append_string(notes, "deflection: largest over the turn / length of the link; load: "// &
      "largest compression of the rigid motion / that at which the link buckles as pinned at "// &
      "both ends, below 0: never compressed")
    call append_string(notes, "quadratic: estimated relative change of the largest strain by "// &
      "terms that the linear equations leave out; out_of_plane: estimated first frequency of "// &
      "vibrations out of the plane of motion; -: not estimated")
    call append_string(notes, "distance: least |1 - rho| of the multipliers rho of a turn of "// &
      "the "//to_string(variant%model%modes)//" slowest vibrations (MODES), of two real ones "// &
      "the greater, 0 at resonance; -: more vibrations a turn than samples resolve, or they "// &
      "grow too much (REPORT stability gives the reason)")
    call append_string(notes, "error: the largest estimated relative error of the values of "// &
      "the row")
    call append_response_notes(notes, variant)
  end subroutine validity_notes

  !> Appends the rows of a speed, one per link that bends.
  subroutine add_validity(variant, layout, speed, rows)
    type(variant_results_t), intent(in) :: variant !! with its response computed
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: speed                   !! number in the deck's list
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    integer :: b

    if (.not. has_response(variant, speed)) then
      call add_failed_speed(variant, speed, rows)
      return
    end if
    associate (found => variant%found%response%at_speed(speed), mechanism => variant%mechanism)
      do b = 1, size(mechanism%names)
        associate (body => mechanism%linkage%bodies(b))
          if (.not. body%bends) cycle
          call add_row(rows, cells(layout, 1, [variant%model%shown_speed(speed)])// &
            name_cell(mechanism%names(b)%text, column_width(layout, 2))//cells(layout, 3, &
            [found%largest_deflection(b)%value/way_length(body), found%buckling(b)])// &
            estimated_cells(layout, found, b, has_depth(variant, b)))
        end associate
      end do
    end associate
  end subroutine add_validity

  !> Whether strains of bending are known: a general section may come without its depth.
  pure function has_depth(variant, body) result(has)
    type(variant_results_t), intent(in) :: variant
    integer, intent(in) :: body !! that bends
    logical :: has

    associate (model => variant%model)
      has = outer_distance(model%sections(model%links(variant%mechanism%links( &
        body))%section)) > 0.0_wp
    end associate
  end function has_depth

  !> The columns from `quadratic` on: a dash where there is no estimate.
  function estimated_cells(layout, found, body, strains) result(text)
    type(table_layout_t), intent(in) :: layout
    type(speed_response_t), intent(in) :: found
    integer, intent(in) :: body
    logical, intent(in) :: strains !! its largest strain is known
    character(len=4*number_width) :: text

    character(len=number_width) :: cell(3)
    real(wp) :: error

    cell = name_cell("-", number_width)
    error = max(found%peak_error(body), found%buckling_error(body))
    if (strains .and. allocated(found%quadratic_change)) then
      cell(1) = cells(layout, 5, [found%quadratic_change(body)])
      error = max(error, found%quadratic_error(body))
    end if
    if (allocated(found%out_of_plane)) then
      cell(2) = cells(layout, 6, [found%out_of_plane])
      error = max(error, found%out_of_plane_error)
    end if
    if (allocated(found%modal_distance)) then
      cell(3) = cells(layout, 7, [found%modal_distance])
      error = max(error, found%modal_distance_error)
    end if
    text = cell(1)//cell(2)//cell(3)//cells(layout, 8, [error])
  end function estimated_cells

end module validity_report
