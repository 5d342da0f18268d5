!> `campbell.dat`, `critical.dat`: frequencies of a running linkage against its speed, and the
!! speeds at which they are multiples of it.
module campbell_report
  use constants, only: two_pi
  use models, only: accuracy_of_study
  use number_text, only: number_width
  use report_kinds, only: report_kind_t
  use report_types, only: add_table, report_record_t, speed_table_t, table_plan_t, whole_table_t
  use response_notes, only: damping_note, without_note
  use stability_report, only: is_short, lost_note, stability_words, verdict_word
  use table_columns, only: cells, column_width, table_layout_t
  use table_rows, only: add_failed_row, add_row, rows_t
  use tables, only: integer_cell, name_cell
  use text, only: append_string, string_t, to_string
  use units, only: from_si
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_campbell

  !> `campbell.dat`.
  type, extends(speed_table_t) :: campbell_table_t
  contains
    procedure, nopass :: find_notes => campbell_notes
    procedure, nopass :: add_speed => add_campbell
  end type campbell_table_t

  !> `critical.dat`.
  type, extends(whole_table_t) :: critical_table_t
  contains
    procedure, nopass :: find_notes => critical_notes
    procedure, nopass :: plan => plan_critical
    procedure, nopass :: add_all => add_critical
  end type critical_table_t

contains

  !> REPORT campbell.
  subroutine describe_campbell(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="campbell", help="frequencies against the speed, and "// &
      "critical speeds", pattern="REPORT campbell [accuracy=]", default="accuracy=1e-6", &
      studies="campbell", response=.true.)
    call add_table(report, campbell_table_t(), "campbell", "speed:speed mode:# least,mean,"// &
      "greatest:Hz band_error:- floquet:Hz growth,error:- verdict:name", words=stability_words())
    call add_table(report, critical_table_t(), "critical", "speed:rate speed_error:- line,"// &
      "mode:# frequency:Hz excitation:length amplitude?:length growth,error:-")
  end subroutine describe_campbell

  !> Meaning of the columns of frequencies, damping, accuracy.
  pure subroutine campbell_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its Campbell diagram computed
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    integer :: i

    call append_string(notes, "least, mean, greatest: frequencies over a turn of the linkage "// &
      "frozen at its positions, with the axial forces of the speed; modes in ascending order")
    call append_string(notes, "floquet: of the free vibrations of the moving linkage; of those "// &
      "that the multiplier of a turn allows, the one nearest to the mean; modes by the "// &
      "frequencies of their shapes over the turn")
    call append_string(notes, "band_error: estimated, relative, of least, mean and greatest; "// &
      "error: estimated, of growth and of 2 pi floquet/speed")
    if (.not. all([(allocated(variant%found%campbell%at_speed(i)%band) .or. &
      allocated(variant%found%campbell%at_speed(i)%error), i=1, &
      size(variant%found%campbell%at_speed))])) call append_string(notes, "-: frozen in some "// &
      "position, the linkage buckles under the axial forces of the speed and has no frequencies")
    if (any([(is_short(variant%found%campbell%at_speed(i)%exponent, variant%model%modes), i=1, &
      size(variant%found%campbell%at_speed))])) call append_string(notes, lost_note)
    call append_common_notes(notes, variant)
  end subroutine campbell_notes

  !> Meaning of the columns of critical speeds, damping, accuracy.
  pure subroutine critical_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its Campbell diagram computed
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    call append_string(notes, "speeds at which a Floquet frequency is line x speed: a "// &
      "multiplier of a turn is real and positive, and the loads excite the vibration")
    call append_string(notes, "excitation: growth of the largest deflection of a link in the "// &
      "first turn, from the loads alone")
    if (variant%found%campbell%damped) call append_string(notes, "amplitude: largest "// &
      "deflection of the resonant part of the steady state")
    call append_string(notes, "speed_error: estimated, relative, with half the width of the "// &
      "interval in which the multiplier is real; error: of excitation and amplitude, relative")
    if (variant%found%campbell%left_out > 0) call append_string(notes, "not listed: "// &
      to_string(variant%found%campbell%left_out)//" with less than 1/100 of the greatest "// &
      "excitation")
    call append_common_notes(notes, variant)
  end subroutine critical_notes

  pure subroutine append_common_notes(notes, variant)
    type(string_t), allocatable, intent(inout) :: notes(:)
    type(variant_results_t), intent(in) :: variant

    call append_string(notes, damping_note(variant))
    associate (model => variant%model)
      if (model%without%keyword%line > 0) call append_string(notes, without_note(variant))
      call append_string(notes, "accuracy asked for: "//to_string(accuracy_of_study(model, &
        "campbell")))
    end associate
  end subroutine append_common_notes

  !> Appends the rows of a speed, one per mode, or its failure.
  subroutine add_campbell(variant, layout, speed, rows)
    type(variant_results_t), intent(in) :: variant !! with its Campbell diagram computed
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: speed                   !! number in the deck's list
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    character(len=:), allocatable :: frozen
    integer :: i

    associate (found => variant%found%campbell%at_speed(speed), &
        shown => variant%model%shown_speed(speed))
      if (allocated(found%error)) then
        call add_failed_row(rows, [shown], found%error%text)
        return
      end if
      do i = 1, size(found%exponent)
        frozen = repeat(name_cell("-", number_width), 4)
        if (allocated(found%band)) frozen = cells(layout, 3, [found%band(i)%least/two_pi, &
          found%band(i)%mean/two_pi, found%band(i)%greatest/two_pi, found%band(i)%error])
        associate (exponent => found%exponent(i))
          call add_row(rows, cells(layout, 1, [shown])//integer_cell(exponent%mode, "mode")// &
            frozen//cells(layout, 7, [exponent%frequency/two_pi, exponent%growth, &
            exponent%error])// &
            name_cell(trim(verdict_word(exponent)), column_width(layout, 10)))
        end associate
      end do
    end associate
  end subroutine add_campbell

  !> Appends the rows of all critical speeds.
  subroutine add_critical(variant, layout, rows)
    type(variant_results_t), intent(in) :: variant !! with its Campbell diagram computed
    type(table_layout_t), intent(in) :: layout     !! of this table
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    integer :: i

    associate (campbell => variant%found%campbell, model => variant%model)
      do i = 1, size(campbell%critical)
        associate (here => campbell%critical(i))
          if (allocated(here%fault)) then
            call add_failed_row(rows, [from_si(here%speed, model%outputs%rate)], here%fault%text)
          else if (campbell%damped) then
            call add_row(rows, cells(layout, 1, [here%speed, here%speed_error])// &
              integer_cell(here%line, "line")//integer_cell(here%mode, "mode")// &
              cells(layout, 5, [here%frequency/two_pi, here%excitation, here%amplitude, &
              here%growth, here%error]))
          else
            call add_row(rows, cells(layout, 1, [here%speed, here%speed_error])// &
              integer_cell(here%line, "line")//integer_cell(here%mode, "mode")// &
              cells(layout, 5, [here%frequency/two_pi, here%excitation, here%growth, &
              here%error]))
          end if
        end associate
      end do
    end associate
  end subroutine add_critical

  !> Amplitudes, if there is damping.
  subroutine plan_critical(variant, plan)
    type(variant_results_t), intent(in) :: variant !! with its results
    type(table_plan_t), intent(inout) :: plan      !! of the table

    plan%has_optional = variant%found%campbell%damped
  end subroutine plan_critical

end module campbell_report
