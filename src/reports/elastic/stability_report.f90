!> `stability.dat`: Floquet exponents of the slowest vibrations at every speed, with verdicts.
module stability_report
  use constants, only: two_pi
  use models, only: accuracy_of_study
  use report_kinds, only: report_kind_t
  use report_types, only: add_table, report_record_t, speed_table_t
  use response_notes, only: damping_note, without_note
  use stability_types, only: exponent_t, stable, unstable_combination, unstable_flip, unstable_fold
  use table_columns, only: cells, name_list_t, table_layout_t
  use table_rows, only: add_failed_row, add_row, rows_t
  use tables, only: integer_cell, name_cell
  use text, only: append_string, string_t, to_string
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_stability, stability_words, verdict_word, is_short, lost_note

  !> Why modes have no row.
  character(len=*), parameter :: lost_note = "modes without a row fade so fast beside the "// &
    "slowest to fade that rounding leaves nothing of their multipliers"

  !> Width of the column `verdict`: the longest word, and a blank.
  integer, parameter :: verdict_width = 16

  !> `stability.dat`.
  type, extends(speed_table_t) :: stability_table_t
  contains
    procedure, nopass :: find_notes => stability_notes
    procedure, nopass :: add_speed => add_stability
  end type stability_table_t

contains

  !> REPORT stability.
  subroutine describe_stability(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="stability", help="whether vibrations of the running "// &
      "linkage grow", pattern="REPORT stability [accuracy=]", default="accuracy=1e-6", &
      studies="stability", response=.true.)
    call add_table(report, stability_table_t(), "stability", "speed:speed mode:# turns,"// &
      "growth:- frequency:Hz signature:# error:- verdict:name", words=stability_words())
  end subroutine describe_stability

  !> Meaning of the columns, damping, accuracy.
  pure subroutine stability_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its stability computed
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    integer :: i

    call append_string(notes, "free vibrations of the moving linkage at constant speed of the "// &
      "crank; after a turn each is multiplied by e^(growth + 2 pi i turns); modes are numbered "// &
      "by the frequencies of their shapes over the turn")
    call append_string(notes, "frequency: of those that the turns allow, (whole number + or - "// &
      "turns) x speed, the one nearest to the mean of the frozen linkage; signature: of Krein, "// &
      "0 where multipliers have met")
    call append_string(notes, "verdict: stable; unstable:flip, unstable:fold (turns 1/2, 0), "// &
      "unstable:2+3 (multipliers of these modes have met); undecided where the error does not "// &
      "decide")
    call append_string(notes, damping_note(variant))
    if (any([(is_short(variant%found%stability%at_speed(i)%exponent, variant%model%modes), i=1, &
      size(variant%found%stability%at_speed))])) call append_string(notes, lost_note)
    associate (model => variant%model)
      if (model%without%keyword%line > 0) call append_string(notes, without_note(variant))
      call append_string(notes, "error: estimated, of growth and of 2 pi turns; accuracy asked "// &
        "for: "//to_string(accuracy_of_study(model, "stability")))
    end associate
  end subroutine stability_notes

  !> Whether exponents were found, but not of all modes.
  pure function is_short(exponent, modes) result(yes)
    type(exponent_t), allocatable, intent(in) :: exponent(:)
    integer, intent(in) :: modes
    logical :: yes

    yes = .false.
    if (allocated(exponent)) yes = size(exponent) < modes
  end function is_short

  !> The column `verdict`, with a word as long as the longest.
  pure function stability_words() result(list)
    type(name_list_t) :: list(1)

    list(1)%column = "verdict"
    allocate (list(1)%names(1))
    list(1)%names(1)%text = repeat("x", verdict_width - 1)
  end function stability_words

  !> Appends the rows of a speed, one per mode, or its failure.
  subroutine add_stability(variant, layout, speed, rows)
    type(variant_results_t), intent(in) :: variant !! with its stability computed
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: speed                   !! number in the deck's list
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    integer :: i

    associate (found => variant%found%stability%at_speed(speed), &
        shown => variant%model%shown_speed(speed))
      if (allocated(found%error)) then
        call add_failed_row(rows, [shown], found%error%text)
        return
      end if
      do i = 1, size(found%exponent)
        associate (exponent => found%exponent(i))
          call add_row(rows, cells(layout, 1, [shown])//integer_cell(exponent%mode, "mode")// &
            cells(layout, 3, [exponent%turns, exponent%growth, exponent%frequency/two_pi])// &
            integer_cell(exponent%signature, "signature")//cells(layout, 7, [exponent%error])// &
            name_cell(trim(verdict_word(exponent)), verdict_width))
        end associate
      end do
    end associate
  end subroutine add_stability

  !> Word in the column `verdict`.
  pure function verdict_word(exponent) result(word)
    type(exponent_t), intent(in) :: exponent
    character(len=24) :: word

    select case (exponent%verdict)
    case (stable)
      word = "stable"
    case (unstable_flip)
      word = "unstable:flip"
    case (unstable_fold)
      word = "unstable:fold"
    case (unstable_combination)
      word = "unstable"
      if (exponent%partner > 0) word = "unstable:"// &
        to_string(min(exponent%mode, exponent%partner))//"+"// &
        to_string(max(exponent%mode, exponent%partner))
    case default
      word = "undecided"
    end select
  end function verdict_word

end module stability_report
