!> `equilibrium.dat`: where the linkage rests without its drive; `potential.dat`: its potential over
!! the ranges of the drive.
module equilibrium_report
  use kinds, only: wp
  use load_notes, only: append_load_notes, potential_note
  use report_kinds, only: report_kind_t
  use report_types, only: add_table, report_record_t, whole_table_t
  use table_columns, only: cells, column_width, name_list_t, table_layout_t
  use table_rows, only: add_failed_row, add_gap, add_row, rows_t
  use tables, only: name_cell
  use text, only: append_string, plural, string_t, word_list
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_equilibrium

  !> In the order of the is_… numbers.
  character(len=*), parameter :: verdicts(3) = [character(len=11) :: "stable", "unstable", &
    "indifferent"]

  !> `equilibrium.dat`.
  type, extends(whole_table_t) :: equilibrium_table_t
  contains
    procedure, nopass :: find_notes => equilibrium_notes
    procedure, nopass :: add_all => add_equilibria
  end type equilibrium_table_t

  !> `potential.dat`.
  type, extends(whole_table_t) :: potential_table_t
  contains
    procedure, nopass :: find_notes => potential_notes
    procedure, nopass :: add_all => add_potential
  end type potential_table_t

contains

  !> REPORT equilibrium.
  subroutine describe_equilibrium(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="equilibrium", help="where the linkage rests without "// &
      "its drive", studies="equilibrium", masses=.true.)
    call add_table(report, equilibrium_table_t(), "equilibrium", "crank:deg verdict:name "// &
      "potential:energy stiffness:turning_stiffness frequency:Hz error:-", &
      words=equilibrium_words())
    call add_table(report, potential_table_t(), "potential", "crank:deg torque:effort "// &
      "potential:energy")
  end subroutine describe_equilibrium

  !> The words in the column `verdict`.
  pure function equilibrium_words() result(list)
    type(name_list_t) :: list(1)

    list(1)%column = "verdict"
    list(1)%names = word_list("stable unstable indifferent")
  end function equilibrium_words

  !> What the columns are, and where rests were looked for.
  subroutine equilibrium_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its rests
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    associate (found => variant%found%equilibria)
      allocate (notes(0))
      call append_string(notes, "positions in which the linkage rests while its drive does not "// &
        "act; stiffness: derivative of the force or torque that the drive would have to give")
      call append_string(notes, "indifferent: it rests everywhere between this row "// &
          "and the next; "// &
        "frequency: of small oscillations without friction about a stable rest, else 0; "// &
        "error: estimated, relative")
      call append_string(notes, potential_note)
      if (any(verdicts(found%at%kind) == "stable" .and. .not. found%at%inertia > 0.0_wp)) call &
        append_string(notes, "no mass moves about a stable rest whose frequency is 0: it snaps "// &
        "back at once")
      if (found%gaps > 0) call append_string(notes, plural(found%gaps, "sample")// &
        " without a value, at dead points or beyond what loads allow: nothing is said of them")
      if (found%is_cut) call append_string(notes, "the first drive goes on beyond what has "// &
        "been searched: there may be further rests")
    end associate
    call append_load_notes(notes, variant%model, variant%mechanism)
  end subroutine equilibrium_notes

  !> What the columns are.
  subroutine potential_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its rests
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    allocate (notes(0))
    call append_string(notes, "over all ranges of the first drive, at rest; torque: what a "// &
      "drive would have to give, the derivative of the potential where all loads have one")
    call append_string(notes, potential_note)
    call append_load_notes(notes, variant%model, variant%mechanism)
  end subroutine potential_notes

  !> Appends a row for every position of the curve, a block for every range; an empty line where
  !! the linkage has no state.
  subroutine add_potential(variant, layout, rows)
    type(variant_results_t), intent(in) :: variant !! with its rests
    type(table_layout_t), intent(in) :: layout     !! of this table
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    integer :: i

    associate (found => variant%found%equilibria)
      do i = 1, size(found%curve)
        if (i > 1 .and. any(found%first == i)) call add_gap(rows, 2)
        associate (point => found%curve(i))
          if (point%is_known) then
            call add_row(rows, cells(layout, 1, [point%crank, point%force, point%potential]))
          else if (.not. any(found%first == i)) then
            if (found%curve(i - 1)%is_known) call add_gap(rows, 1)
          end if
        end associate
      end do
    end associate
  end subroutine add_potential

  !> Appends a row for every rest.
  subroutine add_equilibria(variant, layout, rows)
    type(variant_results_t), intent(in) :: variant !! with its rests
    type(table_layout_t), intent(in) :: layout     !! of this table
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    real(wp) :: nowhere(0)
    integer :: i

    associate (found => variant%found%equilibria)
      if (size(found%at) == 0) call add_failed_row(rows, nowhere, "the linkage rests nowhere")
      do i = 1, size(found%at)
        associate (rest => found%at(i))
          call add_row(rows, cells(layout, 1, [rest%crank])//name_cell(trim(verdicts(rest%kind)), &
            column_width(layout, 2))//cells(layout, 3, [rest%potential, rest%stiffness, &
            rest%frequency, rest%error]))
        end associate
      end do
    end associate
  end subroutine add_equilibria

end module equilibrium_report
