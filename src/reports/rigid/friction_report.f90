!> `friction.dat`: what every joint that rubs bears, and the power that it loses; `holding.dat`:
!! whether the linkage holds itself at rest.
module friction_report
  use drive_motions, only: place_columns, table_place
  use friction_study, only: backward_sense, force_value, forward_sense, moment_value, &
    normal_value, power_value, sliding_value
  use joints_report, only: plan_joints
  use kinds, only: wp
  use load_notes, only: acceleration_note, append_load_notes
  use report_kinds, only: report_kind_t
  use report_types, only: add_table, report_record_t, rest_table_t, state_table_t
  use table_columns, only: cells, column_width, name_list_t, table_layout_t
  use table_rows, only: add_row, rows_t
  use tables, only: name_cell
  use text, only: append_string, plural, string_t, to_string, word_list
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_friction

  !> What a linkage at rest does without its drive, or that no drive can move it.
  character(len=*), parameter :: verdicts(7) = [character(len=14) :: "holds", "runs_forward", &
    "runs_backward", "runs", "locks_forward", "locks_backward", "locks"]
  integer, parameter :: holds = 1, runs_forward = 2, runs_backward = 3, runs_both = 4, &
    locks_forward = 5, locks_backward = 6, locks_both = 7

  !> `friction.dat`.
  type, extends(state_table_t) :: friction_table_t
  contains
    procedure, nopass :: find_notes => friction_notes
    procedure, nopass :: plan => plan_joints
    procedure, nopass :: add_position => add_friction
  end type friction_table_t

  !> `holding.dat`.
  type, extends(rest_table_t) :: holding_table_t
  contains
    procedure, nopass :: find_notes => holding_notes
    procedure, nopass :: add_at_rest => add_holding
  end type holding_table_t

contains

  !> REPORT friction.
  subroutine describe_friction(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="friction", help="joints that rub: forces, losses, "// &
      "self-locking", studies="friction", positions=.true., masses=.true., numbers=82)
    call add_table(report, friction_table_t(), "friction", "speed:speed crank:deg pin,"// &
      "link:name force:force sliding:velocity friction:force moment:moment lost:power")
    call add_table(report, holding_table_t(), "holding", "crank:deg forward,backward:effort "// &
      "verdict:name", words=holding_words())
  end subroutine describe_friction

  !> What the columns are; loads.
  subroutine friction_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its friction
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    call append_string(notes, "force: in the joint, of a block across its line, with both of "// &
      "its ends where a link is fixed to it; sliding: velocity of the link on the pin at the "// &
      "radius of the bearing, or of the block along its line")
    call append_string(notes, "friction: on the block along its line; moment: on the link at "// &
      "the pin, counter-clockwise positive; lost: power")
    call append_string(notes, acceleration_note(variant%model))
    call append_load_notes(notes, variant%model, variant%mechanism)
  end subroutine friction_notes

  !> Likewise, and at how many positions it holds itself, or locks.
  subroutine holding_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its friction
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    integer :: counts(size(verdicts)), i, positions
    character(len=:), allocatable :: line

    call append_string(notes, "forward, backward: torque or force of the first drive that "// &
      "starts the linkage from rest against full friction and resistances, with loads of this "// &
      "direction of the motion; 0 where none can")
    call append_string(notes, "verdict: at rest without its drive the linkage holds, or runs "// &
      "forward or backward, or in either sense once it is pushed; it locks in the senses in "// &
      "which no drive can move it")
    counts = 0
    associate (places => variant%found%positions)
      positions = size(places%crank)
      do i = 1, positions
        associate (state => places%state(i))
          if (allocated(places%states(state)%error)) cycle
          associate (verdict => verdict_at(variant, state))
            counts(verdict) = counts(verdict) + 1
          end associate
        end associate
      end do
    end associate
    line = "of "//plural(positions, "position")//":"
    do i = 1, size(verdicts)
      if (counts(i) > 0) line = line//" "//trim(verdicts(i))//" at "//to_string(counts(i))//","
    end do
    call append_string(notes, line(:len(line) - 1))
    call append_load_notes(notes, variant%model, variant%mechanism)
  end subroutine holding_notes

  !> The words in the column `verdict`.
  pure function holding_words() result(list)
    type(name_list_t) :: list(1)

    list(1)%column = "verdict"
    list(1)%names = word_list("holds runs_forward runs_backward runs locks_forward "// &
      "locks_backward locks")
  end function holding_words

  !> Appends the rows of a position and speed, one per joint that rubs.
  subroutine add_friction(variant, layout, position, speed, rows)
    type(variant_results_t), intent(in) :: variant !! with its friction
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: position                !! number in the deck's list, with a pose
    integer, intent(in) :: speed                   !! number in the deck's list
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    real(wp) :: place(place_columns(variant%model))
    integer :: j, next

    place = table_place(variant%model, speed, position)
    next = size(place) + 1
    associate (mechanism => variant%mechanism, found => variant%found%friction, &
        state => variant%found%positions%state(position))
      do j = 1, size(found%first)
        associate (rub => mechanism%linkage%frictions(found%first(j)))
          call add_row(rows, cells(layout, 1, place)// &
            name_cell(mechanism%pin_names(rub%pin)%text, column_width(layout, next))// &
            owner_cell(variant, found%first(j), column_width(layout, next + 1))// &
            cells(layout, next + 2, found%values([normal_value, sliding_value, force_value, &
            moment_value, power_value], j, speed, state)))
        end associate
      end do
    end associate
  end subroutine add_friction

  !> The cell of the link that turns, or what the block slides along.
  function owner_cell(variant, number, width) result(cell)
    type(variant_results_t), intent(in) :: variant
    integer, intent(in) :: number !! of the friction
    integer, intent(in) :: width
    character(len=width) :: cell

    associate (rub => variant%mechanism%linkage%frictions(number))
      if (rub%slider > 0) then
        cell = name_cell(variant%model%sliders(rub%slider)%on%text, width)
      else
        cell = name_cell(variant%mechanism%names(rub%body)%text, width)
      end if
    end associate
  end function owner_cell

  !> Appends the row of a position.
  subroutine add_holding(variant, layout, position, rows)
    type(variant_results_t), intent(in) :: variant !! with its friction
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: position                !! number in the deck's list, with a pose
    type(rows_t), intent(inout) :: rows            !! to which it is appended

    integer, parameter :: verdict_column = 4

    associate (found => variant%found%friction, positions => variant%found%positions)
      associate (state => positions%state(position))
        call add_row(rows, cells(layout, 1, [positions%crank(position), found%start(:, state)])// &
          name_cell(trim(verdicts(verdict_at(variant, state))), column_width(layout, &
          verdict_column)))
      end associate
    end associate
  end subroutine add_holding

  !> What the linkage does at rest.
  pure function verdict_at(variant, state) result(verdict)
    type(variant_results_t), intent(in) :: variant
    integer, intent(in) :: state !! number
    integer :: verdict

    associate (found => variant%found%friction)
      associate (forward => found%start(forward_sense, state), &
          backward => found%start(backward_sense, state), &
          locked => found%start_lock(:, state)%friction > 0)
        if (all(locked)) then
          verdict = locks_both
        else if (locked(forward_sense)) then
          verdict = locks_forward
        else if (locked(backward_sense)) then
          verdict = locks_backward
        else if (forward < 0.0_wp .and. backward > 0.0_wp) then
          verdict = runs_both
        else if (forward < 0.0_wp) then
          verdict = runs_forward
        else if (backward > 0.0_wp) then
          verdict = runs_backward
        else
          verdict = holds
        end if
      end associate
    end associate
  end function verdict_at

end module friction_report
