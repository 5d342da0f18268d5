!> Words and remarks of `linkage.dat` of linkages that are no four-bars.
module limits_words
  use coordinate_columns, only: shown_unit
  use drive_positions, only: shown_crank, unit_of_drive
  use kinds, only: wp
  use limits_study, only: crank_range_t
  use linkage_notes, only: notes_on_linkage
  use models, only: drives_length
  use natures, only: all_natures
  use named_coordinates, only: limited_coordinates
  use plan_words, only: group_words
  use table_columns, only: name_list_t
  use text, only: append_string, string_t, to_string, trimmed_list
  use units, only: unit_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: limits_notes, limits_names

  character(len=*), parameter :: quantity_words(*) = [character(len=22) :: "range_from", &
    "range_to", "drive_from", "drive_to", "change_point", "dead_point", &
    "least_determinant", &
    "turns", "least_angle", "greatest_angle", "swing", "least_place", "greatest_place", "stroke", &
    "time_ratio", "least_transmission", "greatest_transmission", "greatest_pressure", &
    "least_value", "greatest_value", "span", "gain"]

contains

  !> How the linkage is placed, and what the words mean.
  pure subroutine limits_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its limits found
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    notes = notes_on_linkage(variant)
    call append_string(notes, "range_from, range_to: where the first drive "// &
      "can be, on this branch; part: what stops it there")
    if (size(variant%model%drives) > 1) call append_string(notes, "drive_from, drive_to: the "// &
      "same of further drives: of those that go with the first one over its range, of the "// &
      "others while all but they stand still")
    call append_ends(variant, notes)
    call append_string(notes, "swing, stroke: greatest less least value; turns: "// &
      "whole turns of the link a period; time_ratio: slower over quicker stroke at a "// &
      "constant rate of the drive")
    call append_string(notes, "transmission: angle between the two links of "// &
      "a dyad at their pin, best at 90 deg, or between two lines that place a pin; pressure: "// &
      "between a rod and the guide of its pin, or between force and motion of a lever at its "// &
      "block, best at 0")
    if (size(limited_coordinates(variant%model)) > 0) call append_string(notes, "least_value, "// &
      "greatest_value: of springs, dampers and measures, as in REPORT coordinates, but that "// &
      "angles go on past half turns; span: greatest less least value; gain: of an angle that "// &
      "does not return, a period")
  end subroutine limits_notes

  !> Where the first drive ends, and at dead points inside its range, the group that ends it there.
  pure subroutine append_ends(variant, notes)
    type(variant_results_t), intent(in) :: variant
    type(string_t), allocatable, intent(inout) :: notes(:)

    integer :: r, i

    associate (found => variant%found%limits)
      do r = 1, size(found%ranges)
        call append_cycle(variant, found%ranges(r), notes)
        if (.not. found%ranges(r)%turns) then
          associate (range => found%ranges(r))
            if (range%left_at(1) == 0) call append_end(variant, range%from, range%blocked_by(1), &
              notes)
            if (range%left_at(2) == 0) call append_end(variant, range%to, range%blocked_by(2), &
              notes)
          end associate
        end if
        do i = 1, size(found%low(r)%at)
          associate (point => found%low(r)%at(i))
            if (point%is_dead) call append_end(variant, point%crank, point%group, notes)
            if (point%is_change) call append_end(variant, point%crank, point%group, notes, &
              "change point, passed smoothly,")
          end associate
        end do
      end do
    end associate
  end subroutine append_ends

  !> How long a cycle is of more than a turn, or that there is none and no end of a range.
  pure subroutine append_cycle(variant, range, notes)
    type(variant_results_t), intent(in) :: variant
    type(crank_range_t), intent(in) :: range
    type(string_t), allocatable, intent(inout) :: notes(:)

    character(len=:), allocatable :: from, to, what
    logical :: along

    from = to_string(shown_crank(variant, range%from), 9)
    to = to_string(shown_crank(variant, range%to), 9)//" "//unit_of_drive(variant)
    along = drives_length(variant%model)
    if (all(range%is_open)) then
      what = ", and no cycle"
      if (along) what = ""
      call append_string(notes, "the first drive has no end either way"//what// &
        ": swings and strokes are from "//from//" to "//to)
    else if (any(range%is_open)) then
      what = "upwards"
      if (range%is_open(1)) what = "downwards"
      call append_string(notes, "the first drive has no end "//what// &
        ": swings and strokes are from "//from//" to "//to)
    end if
  end subroutine append_cycle

  !> `dead point at 216.87 deg: B by rod and a slider, forward (RRP)`
  pure subroutine append_end(variant, crank, group, notes, what)
    type(variant_results_t), intent(in) :: variant
    real(wp), intent(in) :: crank
    integer, intent(in) :: group !! number; 0: none, where the linkage has been followed no farther
    type(string_t), allocatable, intent(inout) :: notes(:)
    character(len=*), intent(in), optional :: what !! is there; absent: a dead point

    character(len=:), allocatable :: event

    if (group == 0) return
    event = "dead point"
    if (present(what)) event = what
    call append_string(notes, event//" at "//to_string(shown_crank(variant, crank), 9)//" "// &
      unit_of_drive(variant)//": "//group_words(variant%mechanism, &
      variant%mechanism%linkage%groups(group)))
  end subroutine append_end

  !> The words in the columns `part`, `quantity` and `unit`.
  pure function limits_names(variant) result(lists)
    type(variant_results_t), intent(in) :: variant !! with its mechanism
    type(name_list_t) :: lists(3)

    type(unit_t) :: measure
    integer :: i

    lists(1)%column = "part"
    lists(1)%names = variant%mechanism%names
    do i = 1, size(variant%mechanism%pin_names)
      call append_string(lists(1)%names, variant%mechanism%pin_names(i)%text)
    end do
    associate (sliders => variant%mechanism%linkage%sliders)
      do i = 1, size(sliders)
        if (sliders(i)%body > 0) call append_string(lists(1)%names, &
          variant%mechanism%pin_names(sliders(i)%pin)%text//":"//variant%mechanism%names( &
          sliders(i)%body)%text)
      end do
    end associate
    do i = 1, size(variant%mechanism%coordinates)
      if (any(limited_coordinates(variant%model) == i)) call append_string(lists(1)%names, &
        variant%mechanism%coordinates(i)%name)
    end do
    lists(2)%column = "quantity"
    lists(2)%names = trimmed_list(quantity_words)
    lists(3)%column = "unit"
    allocate (lists(3)%names(0))
    do i = 1, size(all_natures)
      measure = shown_unit(all_natures(i), variant%model%outputs)
      call append_string(lists(3)%names, measure%name)
    end do
    call append_string(lists(3)%names, "1")
  end function limits_names

end module limits_words
