!> `peaks.dat`: the largest strain, stress and deflection of every link that bends, and the power
!! lost in it.
module peaks_report
  use kinds, only: wp
  use mechanisms, only: way_length
  use report_kinds, only: report_kind_t
  use report_types, only: add_table, report_record_t, speed_table_t
  use response_notes, only: add_failed_speed, append_response_notes, has_response
  use response_types, only: peak_t
  use table_columns, only: cells, column_width, table_layout_t
  use table_rows, only: add_row, rows_t
  use tables, only: name_cell
  use text, only: append_string, string_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_peaks

  !> `peaks.dat`.
  type, extends(speed_table_t) :: peaks_table_t
  contains
    procedure, nopass :: find_notes => peaks_notes
    procedure, nopass :: add_speed => add_peaks
  end type peaks_table_t

contains

  !> REPORT peaks.
  subroutine describe_peaks(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="peaks", help="largest strain, stress and deflection of "// &
      "every link", pattern="REPORT peaks [accuracy=] [columns=]", default="accuracy=1e-6", &
      studies="response", response=.true.)
    call add_table(report, peaks_table_t(), "peaks", "speed:speed link:name strain:- "// &
      "strain_at:length strain_crank:deg stress:stress stress_at:length stress_crank:deg "// &
      "deflection,deflection_at:length deflection_crank:deg power:power error:-")
  end subroutine describe_peaks

  !> Meaning of the columns, and what all tables of the response say.
  pure subroutine peaks_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its response computed
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    call append_string(notes, "largest values over the turn and along the link, also between "// &
      "the crank angles of the deck; strain: |axial| + |bending| at the fibre farthest from "// &
      "the centroid; stress: E x strain; deflection: from where the rigid link would be")
    call append_string(notes, "..._at: distance from the first pin of the LINK card; "// &
      "..._crank: crank angle, to about the square root of error in radians, -: of a "// &
      "constant; power: mean lost to damping in the link")
    call append_response_notes(notes, variant)
  end subroutine peaks_notes

  !> Appends the rows of a speed, one per link that bends.
  subroutine add_peaks(variant, layout, speed, rows)
    type(variant_results_t), intent(in) :: variant !! with its response computed
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: speed                   !! number in the deck's list
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    character(len=:), allocatable :: row
    integer :: b

    if (.not. has_response(variant, speed)) then
      call add_failed_speed(variant, speed, rows)
      return
    end if
    associate (found => variant%found%response%at_speed(speed), mechanism => variant%mechanism)
      do b = 1, size(mechanism%names)
        if (.not. mechanism%linkage%bodies(b)%bends) cycle
        row = cells(layout, 1, [variant%model%shown_speed(speed)])// &
          name_cell(mechanism%names(b)%text, column_width(layout, 2))
        call add_peak(3, found%largest_strain(b), row)
        call add_peak(6, found%largest_stress(b), row)
        call add_peak(9, found%largest_deflection(b), row)
        call add_row(rows, row//cells(layout, 12, [found%power_lost(b), found%peak_error(b)]))
      end do
    end associate

  contains

    !> Appends value, place on the link of the deck, and crank angle, which a constant has not.
    subroutine add_peak(column, peak, text)
      integer, intent(in) :: column !! its first
      type(peak_t), intent(in) :: peak
      character(len=:), allocatable, intent(inout) :: text

      real(wp) :: xi

      xi = peak%xi
      associate (body => variant%mechanism%linkage%bodies(b))
        if (variant%mechanism%is_reversed(b) .and. .not. allocated(body%corners)) xi = 1.0_wp - xi
        text = text//cells(layout, column, [peak%value, xi*way_length(body)])
      end associate
      if (peak%is_constant) then
        text = text//name_cell("-", column_width(layout, column + 2))
      else
        text = text//cells(layout, column + 2, [peak%crank])
      end if
    end subroutine add_peak

  end subroutine add_peaks

end module peaks_report
