!> `transient.dat`, `gauges.dat`: elastic motions in time, of pins and points and at gauges.
module transient_report
  use constants, only: degree
  use kinds, only: wp
  use models, only: drives_length, has_law, model_t, report_number
  use number_text, only: number_width
  use report_kinds, only: report_kind_t
  use report_types, only: add_table, report_record_t, speed_table_t
  use response_notes, only: damping_note, without_note
  use response_report, only: plan_response
  use response_types, only: axial_force, axial_strain, bending_strain, moment, stress
  use strains_report, only: append_gauge_notes, plan_gauges
  use table_columns, only: cells, column_width, table_factor, table_layout_t
  use table_rows, only: add_failed_row, add_gap, add_row, rows_t
  use tables, only: name_cell
  use text, only: append_string, string_t, to_string
  use transient_types, only: speed_transient_t
  use units, only: dimension_length, dimension_time, dimension_velocity, from_si
  use value_words, only: in_words
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_transient, transient_log

  character(len=*), parameter :: line_feed = achar(10)

  !> `transient.dat`.
  type, extends(speed_table_t) :: transient_table_t
  contains
    procedure, nopass :: find_notes => transient_notes
    procedure, nopass :: plan => plan_response
    procedure, nopass :: add_speed => add_points
  end type transient_table_t

  !> `gauges.dat`.
  type, extends(speed_table_t) :: gauges_table_t
  contains
    procedure, nopass :: find_notes => gauge_history_notes
    procedure, nopass :: plan => plan_gauges
    procedure, nopass :: add_speed => add_gauges
  end type gauges_table_t

contains

  !> REPORT transient.
  subroutine describe_transient(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="transient", help="the elastic motion in time from a state", &
      pattern="REPORT transient turns= [crank=0] [start=rest|steady] [perturb=mode,"// &
      "amplitude[,velocity]] [instants=] [accuracy=]", default="crank=0 start=rest "// &
      "instants=72 accuracy=1e-3", studies="transient", response=.true.)
    call add_table(report, transient_table_t(), "transient", "speed:speed time:time "// &
      "crank:deg point:name ux,uy:length rotation:deg error:-")
    call add_table(report, gauges_table_t(), "gauges", "speed:speed time:time crank:deg "// &
      "gauge:name axial_strain,bending_strain:- moment:moment axial_force:force "// &
      "stress:stress error:-")
  end subroutine describe_transient

  !> Meaning of the columns of displacements, and what both tables say.
  pure subroutine transient_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its motions computed
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    call append_string(notes, "ux, uy: displacement from the place that the point has with "// &
      "rigid links at the same crank angle, in global axes; rotation: of the link there, "// &
      "counter-clockwise")
    call append_common_notes(notes, variant)
  end subroutine transient_notes

  !> Meaning of the columns of strains, and what both tables say.
  pure subroutine gauge_history_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its motions computed
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    call append_gauge_notes(notes, variant, .false.)
    call append_common_notes(notes, variant)
  end subroutine gauge_history_notes

  !> How the motion starts, how the crank moves, damping, what the errors are.
  pure subroutine append_common_notes(notes, variant)
    type(string_t), allocatable, intent(inout) :: notes(:)
    type(variant_results_t), intent(in) :: variant

    character(len=:), allocatable :: words

    associate (model => variant%model)
      associate (report => model%reports(report_number(model, "transient")))
        associate (asked => report%transient)
          if (asked%steady) then
            words = "start: the steady state at the speed"
          else
            words = "start: undeformed, moving as rigid links do"
          end if
          if (asked%mode > 0) words = words//", with the shape of mode "//to_string(asked%mode)// &
            " of the mechanism frozen there, its largest displacement along a link "// &
            in_words(asked%amplitude, dimension_length, model%units, 9)
          if (abs(asked%velocity) > 0.0_wp) words = words//", its largest velocity "// &
            in_words(asked%velocity, dimension_velocity, model%units, 9)
          call append_string(notes, words)
          words = "crank: at constant speed"
          if (model%ramp > 0.0_wp) words = "crank: from rest with constant acceleration for "// &
            in_words(model%ramp, dimension_time, model%units, 9)//", then at constant speed"
          if (has_law(model)) words = "crank: by the law '"//model%drives(1)%law%text//"'"
          if (.not. drives_length(model)) words = words//"; its angle continues past whole turns"
          call append_string(notes, words)
          call append_string(notes, damping_note(variant))
          if (model%without%keyword%line > 0) call append_string(notes, without_note(variant))
          call append_string(notes, "error: estimated, relative to the largest value of the "// &
            "quantity over the run; accuracy asked for: "//to_string(report%accuracy))
        end associate
      end associate
    end associate
  end subroutine append_common_notes

  !> Appends the rows of pins and points, instant after instant, or a failure.
  subroutine add_points(variant, layout, speed, rows)
    type(variant_results_t), intent(in) :: variant !! with its motions computed
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: speed                   !! number in the deck's list
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    integer :: i, k

    if (speed > 1) call add_gap(rows, 2)
    associate (found => variant%found%transient%at_speed(speed), mechanism => variant%mechanism)
      if (allocated(found%error)) then
        call add_failed_row(rows, failed_place(variant%model, found, speed), found%error%text)
        return
      end if
      do k = 1, size(found%time)
        do i = 1, size(mechanism%response_points)
          associate (u => found%displacement(:, i, k), name => mechanism%response_points(i)%name)
            call add_row(rows, start_of_row(variant, layout, speed, k, name)//cells(layout, 5, &
              [u(1), u(2), u(3)/degree, found%displacement_error(i)]))
          end associate
        end do
      end do
    end associate
  end subroutine add_points

  !> Appends the rows of gauges, likewise.
  subroutine add_gauges(variant, layout, speed, rows)
    type(variant_results_t), intent(in) :: variant !! with its motions computed
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: speed                   !! number in the deck's list
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    integer :: i, k

    if (speed > 1) call add_gap(rows, 2)
    associate (found => variant%found%transient%at_speed(speed), mechanism => variant%mechanism)
      if (allocated(found%error)) then
        call add_failed_row(rows, failed_place(variant%model, found, speed), found%error%text)
        return
      end if
      if (allocated(found%strain_fault)) then
        call add_failed_row(rows, failed_place(variant%model, found, speed), &
          found%strain_fault%text)
        return
      end if
      do k = 1, size(found%time)
        do i = 1, size(mechanism%gauges)
          associate (values => found%strain(:, i, k), name => mechanism%gauges(i)%name)
            call add_row(rows, start_of_row(variant, layout, speed, k, name)//cells(layout, 5, &
              [values([axial_strain, bending_strain, moment, axial_force, stress]), &
              found%strain_error(i)]))
          end associate
        end do
      end do
    end associate
  end subroutine add_gauges

  !> The cells of an instant, and of a name.
  function start_of_row(variant, layout, speed, k, name) result(text)
    type(variant_results_t), intent(in) :: variant
    type(table_layout_t), intent(in) :: layout
    integer, intent(in) :: speed, k !! numbers of speed and instant
    character(len=*), intent(in) :: name
    character(len=3*number_width + column_width(layout, 4)) :: text

    associate (found => variant%found%transient%at_speed(speed))
      text = cells(layout, 1, [shown_rate(variant%model, found, speed, k), found%time(k), &
        found%crank(k)])//name_cell(name, column_width(layout, 4))
    end associate
  end function start_of_row

  !> The speed of the deck, of a law that at an instant, as tables show it.
  pure function shown_rate(model, found, speed, k) result(shown)
    type(model_t), intent(in) :: model
    type(speed_transient_t), intent(in) :: found
    integer, intent(in) :: speed !! number
    integer, intent(in) :: k     !! number of the instant
    real(wp) :: shown

    shown = model%shown_speed(speed)
    if (has_law(model)) shown = from_si(found%rate(k), model%speed_unit)
  end function shown_rate

  !> Where a motion is that failed: its speed; of a law its beginning.
  pure function failed_place(model, found, speed) result(place)
    type(model_t), intent(in) :: model
    type(speed_transient_t), intent(in) :: found
    integer, intent(in) :: speed !! number
    real(wp), allocatable :: place(:)

    place = [shown_rate(model, found, speed, 1)]
    if (has_law(model)) place = [place, from_si(found%time(1), table_factor("time", &
      model%outputs)), found%crank(1)]
  end function failed_place

  !> Log lines: orders, steps and work of every speed.
  pure function transient_log(variant) result(text)
    type(variant_results_t), intent(in) :: variant !! with its motions computed
    character(len=:), allocatable :: text

    integer :: k

    text = ""
    do k = 1, size(variant%found%transient%at_speed)
      associate (found => variant%found%transient%at_speed(k))
        if (.not. allocated(found%displacement_error)) cycle
        text = text//"transient: order "//to_string(found%order)//", "//to_string(found%steps)// &
          " steps between rows; "//to_string(found%made)//" steps made, "// &
          to_string(found%taken)//" taken; estimated errors up to "// &
          to_string(maxval([0.0_wp, found%displacement_error]), 2)//" of displacements, "// &
          to_string(maxval([0.0_wp, found%strain_error]), 2)//" of strains"//line_feed
      end associate
    end do
  end function transient_log

end module transient_report
