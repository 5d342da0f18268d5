!> `intervals.dat`: the intervals of speed in which vibrations grow.
module intervals_report
  use models, only: accuracy_of_study, report_number
  use report_kinds, only: report_kind_t
  use report_types, only: add_table, report_record_t, whole_table_t
  use response_notes, only: damping_note, without_note
  use stability_types, only: instability_t, unstable_flip, unstable_fold
  use table_columns, only: cells, column_width, name_list_t, table_layout_t
  use table_rows, only: add_failed_row, add_row, rows_t
  use tables, only: name_cell
  use text, only: append_string, string_t, to_string
  use units, only: from_si
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_intervals

  character(len=*), parameter :: longest_kind = "combination", longest_modes = "20+20"

  !> `intervals.dat`.
  type, extends(whole_table_t) :: intervals_table_t
  contains
    procedure, nopass :: find_notes => intervals_notes
    procedure, nopass :: add_all => add_intervals
  end type intervals_table_t

contains

  !> REPORT intervals.
  subroutine describe_intervals(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="intervals", help="all speeds at which vibrations grow", &
      pattern="REPORT intervals [growth=] [accuracy=]", default="growth=1e-4 accuracy=1e-5", &
      studies="intervals", response=.true.)
    call add_table(report, intervals_table_t(), "intervals", "from,to:speed kind,modes:name "// &
      "largest_growth,growth_error:- at,error:speed", words=interval_words())
  end subroutine describe_intervals

  !> Range, meaning of the columns, damping, accuracy.
  pure subroutine intervals_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its intervals computed
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    associate (model => variant%model, range => variant%found%intervals%range)
      call append_string(notes, "all intervals of speed from "// &
        to_string(from_si(range(1), model%outputs%rate), 12)//" to "// &
        to_string(from_si(range(2), model%outputs%rate), 12)//" "//model%outputs%rate%name// &
        " in which free vibrations of the "//to_string(model%modes)//" slowest modes grow by "// &
        "more than e^"// &
        to_string(model%reports(report_number(model, "intervals"))%least_growth)//" in a turn")
      call append_string(notes, "flip: a multiplier passes -1, fold: 1, combination: the "// &
        "multipliers of two modes meet; modes are numbered by the frequencies of their shapes "// &
        "over the turn at the speed of largest growth")
      call append_string(notes, "largest_growth in a turn, at this speed; error: estimated, of "// &
        "from and to; accuracy asked for: "//to_string(accuracy_of_study(model, "intervals")))
      call append_string(notes, damping_note(variant))
      if (model%without%keyword%line > 0) call append_string(notes, without_note(variant))
    end associate
  end subroutine intervals_notes

  !> The columns `kind` and `modes`.
  pure function interval_words() result(lists)
    type(name_list_t) :: lists(2)

    lists(1)%column = "kind"
    lists(2)%column = "modes"
    allocate (lists(1)%names(1), lists(2)%names(1))
    lists(1)%names(1)%text = longest_kind
    lists(2)%names(1)%text = longest_modes
  end function interval_words

  !> Appends one row per interval, by speed, and a failed row for speeds at which none could be
  !! found.
  subroutine add_intervals(variant, layout, rows)
    type(variant_results_t), intent(in) :: variant !! with its intervals computed
    type(table_layout_t), intent(in) :: layout     !! of this table
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    integer :: i

    associate (found => variant%found%intervals, rate => variant%model%outputs%rate)
      do i = 1, size(found%interval)
        associate (interval => found%interval(i))
          call add_row(rows, cells(layout, 1, [from_si(interval%from, rate), &
            from_si(interval%to, rate)])// &
            name_cell(trim(kind_word(interval)), column_width(layout, 3))// &
            name_cell(trim(modes_word(interval)), column_width(layout, 4))// &
            cells(layout, 5, [interval%growth, interval%growth_error, &
            from_si(interval%at, rate), from_si(interval%error, rate)]))
        end associate
      end do
      do i = 1, size(found%gap)
        associate (gap => found%gap(i))
          call add_failed_row(rows, [from_si(gap%from, rate), from_si(gap%to, rate)], &
            gap%error%text)
        end associate
      end do
    end associate
  end subroutine add_intervals

  !> Word in the column `kind`.
  pure function kind_word(interval) result(word)
    type(instability_t), intent(in) :: interval
    character(len=len(longest_kind)) :: word

    select case (interval%kind)
    case (unstable_flip)
      word = "flip"
    case (unstable_fold)
      word = "fold"
    case default
      word = longest_kind
    end select
  end function kind_word

  !> Word in the column `modes`: `1`, or `2+3`.
  pure function modes_word(interval) result(word)
    type(instability_t), intent(in) :: interval
    character(len=12) :: word

    word = to_string(interval%mode(1))
    if (interval%mode(2) /= interval%mode(1)) word = trim(word)//"+"//to_string(interval%mode(2))
  end function modes_word

end module intervals_report
