!> `transient.dat`, `gauges.dat`: elastic motions in time, of pins and points and at gauges.
module transient_report
  use constants, only: degree
  use kinds, only: wp
  use models, only: has_law, model_t, report_number
  use response_notes, only: damping_note, without_note
  use response_types, only: axial_force, axial_strain, bending_strain, moment, stress
  use strains_report, only: append_gauge_notes
  use table_columns, only: cells, column_width, table_factor, table_layout_t
  use table_rows, only: add_failed_row, add_row, rows_t
  use tables, only: name_cell
  use text, only: append_string, string_t, to_string
  use transient_types, only: speed_transient_t
  use units, only: from_si
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: transient_notes, gauge_history_notes, add_transient, transient_log

  character(len=*), parameter :: line_feed = achar(10)

contains

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
            to_string(asked%amplitude, 9)//" m"
          if (abs(asked%velocity) > 0.0_wp) words = words//", its largest velocity "// &
            to_string(asked%velocity, 9)//" m/s"
          call append_string(notes, words)
          words = "crank: at constant speed"
          if (model%ramp > 0.0_wp) words = "crank: from rest with constant acceleration for "// &
            to_string(model%ramp)//" s, then at constant speed"
          if (has_law(model)) words = "crank: by the law '"//model%drives(1)%law%text//"'"
          call append_string(notes, words//"; its angle continues past whole turns")
          call append_string(notes, damping_note(variant))
          if (model%without%keyword%line > 0) call append_string(notes, without_note(variant))
          call append_string(notes, "error: estimated, relative to the largest value of the "// &
            "quantity over the run; accuracy asked for: "//to_string(report%accuracy))
        end associate
      end associate
    end associate
  end subroutine append_common_notes

  !> Appends the rows of a speed, instant after instant, or its failure.
  subroutine add_transient(table, variant, layout, speed, rows)
    character(len=*), intent(in) :: table          !! transient or gauges
    type(variant_results_t), intent(in) :: variant !! with its motions computed
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: speed                   !! number in the deck's list
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    integer :: i, k

    associate (found => variant%found%transient%at_speed(speed), mechanism => variant%mechanism)
      if (allocated(found%error)) then
        call add_failed_row(rows, failed_place(variant%model, found, speed), found%error%text)
        return
      end if
      if (table /= "transient" .and. allocated(found%strain_fault)) then
        call add_failed_row(rows, failed_place(variant%model, found, speed), &
          found%strain_fault%text)
        return
      end if
      do k = 1, size(found%time)
        if (table == "transient") then
          do i = 1, size(mechanism%response_points)
            associate (u => found%displacement(:, i, k), &
                name => mechanism%response_points(i)%name)
              call add_row(rows, cells(layout, 1, [shown_rate(variant%model, &
                found, speed, k), found%time(k), found%crank(k)])//name_cell(name, &
                column_width(layout, 4))// &
                cells(layout, 5, [u(1), u(2), u(3)/degree, found%displacement_error(i)]))
            end associate
          end do
        else
          do i = 1, size(mechanism%gauges)
            associate (values => found%strain(:, i, k), name => mechanism%gauges(i)%name)
              call add_row(rows, cells(layout, 1, [shown_rate(variant%model, &
                found, speed, k), found%time(k), found%crank(k)])//name_cell(name, &
                column_width(layout, 4))// &
                cells(layout, 5, [values([axial_strain, bending_strain, moment, axial_force, &
                stress]), found%strain_error(i)]))
            end associate
          end do
        end if
      end do
    end associate
  end subroutine add_transient

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
