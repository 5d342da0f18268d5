!> `branches.dat`: frequencies followed by their mode shapes from position to position.
!!
!! The deck and the table call a locus a branch. In the code a branch is an assembly mode of the
!! linkage.
module loci_report
  use drive_positions, only: shown_crank
  use errors, only: error_t
  use frequency_report, only: effects_notes, shown_speed
  use frequency_study, only: failure_at
  use loci_study, only: event_ambiguous, event_crossing, event_start, event_veering, failed_rows, &
    is_empty, locus_row_t, rows_of_locus
  use report_kinds, only: report_kind_t
  use report_types, only: add_table, report_record_t, whole_table_t
  use table_columns, only: cells, name_list_t, table_layout_t
  use table_rows, only: add_failed_row, add_gap, add_row, rows_t
  use tables, only: integer_cell, name_cell
  use text, only: append_string, string_t, to_string
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_branches, locus_words

  !> Width of the column `event`: the longest word, and a blank.
  integer, parameter :: event_width = 18

  !> `branches.dat`.
  type, extends(whole_table_t) :: loci_table_t
  contains
    procedure, nopass :: find_notes => loci_notes
    procedure, nopass :: add_all => add_loci
  end type loci_table_t

contains

  !> REPORT branches.
  subroutine describe_branches(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="branches", help="frequencies followed by their shapes", &
      studies="frequencies loci", positions=.true., beams=.true., frequencies=.true., &
      reserved=.true.)
    call add_table(report, loci_table_t(), "branches", "speed:speed crank:deg branch,mode:# "// &
      "frequency:Hz mac:- event:name", words=locus_words())
  end subroutine describe_branches

  !> Effects in the equations, and the meaning of `mac` and the events.
  pure subroutine loci_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its sweep computed
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    notes = effects_notes(variant%model)
    call append_string(notes, &
      "modes followed by their shapes; mac: modal assurance criterion with the row before, "// &
      "in the mass inner product, from 0 to 1")
    call append_string(notes, "event: - or start, crossing:BRANCH, veering:BRANCH, ambiguous "// &
      "(shapes do not show which branch continues: a new one begins)")
  end subroutine loci_notes

  !> The column `event`, with a word as long as the longest.
  pure function locus_words() result(list)
    type(name_list_t) :: list(1)

    list(1)%column = "event"
    allocate (list(1)%names(1))
    list(1)%names(1)%text = repeat("x", event_width - 1)
  end function locus_words

  !> Appends one row per position and locus. One block per speed: first the failed rows, then locus
  !! after locus, each by crank angle.
  subroutine add_loci(variant, layout, rows)
    type(variant_results_t), intent(in) :: variant !! with sweep and loci computed
    type(table_layout_t), intent(in) :: layout     !! of this table
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    integer :: locus, k
    logical :: first

    associate (found => variant%found)
      do k = 1, size(found%sweep%request%speed)
        if (k > 1) call add_gap(rows, 2)
        call add_failures(variant, k, rows)
        first = .true.
        do locus = 1, found%loci%count
          if (is_empty(found%loci, locus, k)) cycle
          if (.not. first) call add_gap(rows, 1)
          first = .false.
          call add_locus(variant, layout, locus, k, rows)
        end do
      end do
    end associate
  end subroutine add_loci

  !> The failed rows of a speed, by crank angle.
  subroutine add_failures(variant, speed, rows)
    type(variant_results_t), intent(in) :: variant
    integer, intent(in) :: speed !! number
    type(rows_t), intent(inout) :: rows

    type(error_t) :: error
    integer, allocatable :: failed(:)
    integer :: i

    associate (found => variant%found)
      failed = failed_rows(found%positions, found%sweep, speed)
      do i = 1, size(failed)
        error = failure_at(found%positions, found%sweep, found%positions%state(failed(i)), speed)
        call add_failed_row(rows, [shown_speed(variant, speed), shown_crank(variant, &
          found%positions%crank(failed(i)))], error%text)
      end do
    end associate
  end subroutine add_failures

  !> The rows of one locus at one speed. A failed row interrupts the curve.
  subroutine add_locus(variant, layout, locus, speed, rows)
    type(variant_results_t), intent(in) :: variant
    type(table_layout_t), intent(in) :: layout
    integer, intent(in) :: locus, speed !! numbers
    type(rows_t), intent(inout) :: rows

    type(locus_row_t), allocatable :: list(:)
    integer :: i

    associate (found => variant%found)
      list = rows_of_locus(found%positions, found%sweep, found%loci, locus, speed)
      do i = 1, size(list)
        if (list(i)%is_broken) then
          ! One empty line breaks a curve; two would end the block.
          call add_gap(rows, 1)
          cycle
        end if
        call add_row(rows, cells(layout, 1, [shown_speed(variant, speed), &
          found%positions%crank(list(i)%position)])//integer_cell(locus, "branch")// &
          integer_cell(list(i)%mode, "mode")//cells(layout, 5, [list(i)%frequency, &
          list(i)%mac])//name_cell(trim(event_name(list(i)%event, list(i)%partner)), &
          event_width))
      end do
    end associate
  end subroutine add_locus

  !> Word in the column `event`.
  pure function event_name(event, partner) result(name)
    integer, intent(in) :: event   !! event_start, …
    integer, intent(in) :: partner !! locus that is crossed or veered from
    character(len=24) :: name

    select case (event)
    case (event_start)
      name = "start"
    case (event_crossing)
      name = "crossing:"//to_string(partner)
    case (event_veering)
      name = "veering:"//to_string(partner)
    case (event_ambiguous)
      name = "ambiguous"
    case default
      name = "-"
    end select
  end function event_name

end module loci_report
