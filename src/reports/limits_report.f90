!> `linkage.dat` of linkages that are no four-bars: ranges of the first drive, swings, strokes, time
!! ratios, transmission and pressure angles, a row each.
module limits_report
  use drive_cards, only: moves_along
  use kinds, only: wp
  use limits_study, only: angle_of_body, crank_range_t, place_of_slider, quantity_t, time_ratio, &
    transmission_of_dyad
  use linkage_notes, only: notes_on_linkage
  use links_report, only: shown_crank
  use table_columns, only: cells, column_width, name_list_t, table_factor, table_layout_t, &
    table_unit
  use table_rows, only: add_failed_row, add_row, rows_t
  use tables, only: name_cell
  use text, only: append_string, string_t, trimmed_list
  use units, only: from_si, unit_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: limits_notes, limits_words, add_limits

  character(len=*), parameter :: quantity_words(*) = [character(len=22) :: "range_from", &
    "range_to", &
    "turns", "least_angle", "greatest_angle", "swing", "least_place", "greatest_place", "stroke", &
    "time_ratio", "least_transmission", "greatest_transmission", "greatest_pressure"]

contains

  !> How the linkage is placed, and what the words mean.
  pure subroutine limits_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its limits found
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    notes = notes_on_linkage(variant)
    call append_string(notes, "range_from, range_to: where the first drive "// &
      "can be, on this branch; part: what stops it there")
    call append_string(notes, "swing, stroke: greatest less least value; turns: "// &
      "whole turns of the link a period; time_ratio: slower over quicker stroke at a "// &
      "constant rate of the drive")
    call append_string(notes, "transmission: angle between the two links of "// &
      "a dyad at their pin, best at 90 deg; pressure: between a rod and the guide of its pin, "// &
      "best at 0")
  end subroutine limits_notes

  !> The words in the columns `part`, `quantity` and `unit`.
  pure function limits_words(variant) result(lists)
    type(variant_results_t), intent(in) :: variant !! with its mechanism
    type(name_list_t) :: lists(3)

    type(unit_t) :: length
    integer :: i

    lists(1)%column = "part"
    lists(1)%names = variant%mechanism%names
    do i = 1, size(variant%mechanism%pin_names)
      call append_string(lists(1)%names, variant%mechanism%pin_names(i)%text)
    end do
    lists(2)%column = "quantity"
    lists(2)%names = trimmed_list(quantity_words)
    length = table_unit("length", variant%model%outputs)
    lists(3)%column = "unit"
    allocate (lists(3)%names(3))
    lists(3)%names(1)%text = "deg"
    lists(3)%names(2)%text = length%name
    lists(3)%names(3)%text = "1"
  end function limits_words

  !> Appends all rows.
  subroutine add_limits(variant, layout, rows)
    type(variant_results_t), intent(in) :: variant !! with its limits found
    type(table_layout_t), intent(in) :: layout     !! of this table
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    real(wp) :: nowhere(0)
    integer :: r, q

    associate (found => variant%found%limits, names => variant%mechanism%names)
      if (size(found%ranges) == 0) call add_failed_row(rows, nowhere, &
        "the linkage closes nowhere")
      do r = 1, size(found%ranges)
        if (.not. found%ranges(r)%turns) then
          call put(variant, layout, rows, part_at_end(variant, found%ranges(r), 1), &
            "range_from", found%ranges(r)%from, shown_crank(variant, found%ranges(r)%from), &
            of_drive=.true.)
          call put(variant, layout, rows, part_at_end(variant, found%ranges(r), 2), &
            "range_to", found%ranges(r)%to, shown_crank(variant, found%ranges(r)%to), &
            of_drive=.true.)
        end if
        do q = 1, size(found%quantities)
          call add_quantity(variant, layout, r, q, rows)
        end do
      end do
    end associate
  end subroutine add_limits

  !> The rows of a quantity over a range.
  subroutine add_quantity(variant, layout, r, q, rows)
    type(variant_results_t), intent(in) :: variant
    type(table_layout_t), intent(in) :: layout
    integer, intent(in) :: r, q
    type(rows_t), intent(inout) :: rows

    character(len=22) :: least, greatest, swing
    real(wp) :: ratio

    associate (found => variant%found%limits, x => variant%found%limits%extremes(q, r), &
        quantity => variant%found%limits%quantities(q))
      ratio = 0.0_wp
      least = ""
      swing = ""
      select case (quantity%kind)
      case (angle_of_body)
        if (abs(x%turned) > 0.0_wp) then
          call put(variant, layout, rows, part_of(variant, quantity), "turns", 0.0_wp, &
            x%turned/360.0_wp, pure_number=.true.)
          return
        end if
        least = "least_angle"
        greatest = "greatest_angle"
        swing = "swing"
        ratio = time_ratio(found%ranges(r), x)
      case (place_of_slider)
        least = "least_place"
        greatest = "greatest_place"
        swing = "stroke"
        ratio = time_ratio(found%ranges(r), x)
      case (transmission_of_dyad)
        least = "least_transmission"
        greatest = "greatest_transmission"
      case default
        greatest = "greatest_pressure"
      end select
      if (least /= "") call put(variant, layout, rows, part_of(variant, quantity), trim(least), &
        x%at_least, shown(variant, quantity, x%least), is_place=quantity%kind == place_of_slider)
      call put(variant, layout, rows, part_of(variant, quantity), trim(greatest), x%at_greatest, &
        shown(variant, quantity, x%greatest), is_place=quantity%kind == place_of_slider)
      if (swing /= "") call put(variant, layout, rows, part_of(variant, quantity), trim(swing), &
        x%at_greatest, shown(variant, quantity, x%greatest - x%least), &
        is_place=quantity%kind == place_of_slider)
      if (ratio > 0.0_wp) call put(variant, layout, rows, part_of(variant, quantity), &
        "time_ratio", x%at_greatest, ratio, pure_number=.true.)
    end associate
  end subroutine add_quantity

  !> A value in the unit of the table.
  pure function shown(variant, quantity, value) result(converted)
    type(variant_results_t), intent(in) :: variant
    type(quantity_t), intent(in) :: quantity
    real(wp), intent(in) :: value
    real(wp) :: converted

    converted = value
    if (quantity%kind == place_of_slider) converted = from_si(value, table_factor("length", &
      variant%model%outputs))
  end function shown

  !> The link, or the pin, that a quantity is of.
  pure function part_of(variant, quantity) result(number)
    type(variant_results_t), intent(in) :: variant
    type(quantity_t), intent(in) :: quantity
    integer :: number !! of the link, or minus that of the pin

    select case (quantity%kind)
    case (angle_of_body)
      number = quantity%number
    case (place_of_slider)
      number = -variant%mechanism%linkage%sliders(quantity%number)%pin
    case default
      number = -variant%mechanism%linkage%groups(quantity%number)%middle
    end select
  end function part_of

  !> The pin of a dyad or a block, or a link of another group, that ends a range; the first link
  !! without one.
  pure function part_at_end(variant, range, end) result(number)
    type(variant_results_t), intent(in) :: variant
    type(crank_range_t), intent(in) :: range
    integer, intent(in) :: end !! 1: from, 2: to
    integer :: number          !! of the link, or minus that of the pin

    integer :: group

    number = -range%left_at(end)
    if (number < 0) return
    number = 1
    group = range%blocked_by(end)
    if (group == 0) return
    associate (it => variant%mechanism%linkage%groups(group))
      if (it%middle > 0) then
        number = -it%middle
      else if (it%body(1) > 0) then
        number = it%body(1)
      else if (allocated(it%bodies)) then
        if (size(it%bodies) > 0) number = it%bodies(1)
      end if
    end associate
  end function part_at_end

  !> Appends a row.
  subroutine put(variant, layout, rows, part, quantity, crank, value, is_place, pure_number, &
    of_drive)
    type(variant_results_t), intent(in) :: variant
    type(table_layout_t), intent(in) :: layout
    type(rows_t), intent(inout) :: rows
    integer, intent(in) :: part
    character(len=*), intent(in) :: quantity
    real(wp), intent(in) :: crank, value
    logical, intent(in), optional :: is_place, pure_number, of_drive

    character(len=column_width(layout, 1)) :: part_cell
    character(len=column_width(layout, 5)) :: unit_cell
    type(unit_t) :: length
    logical :: in_length

    if (part > 0) then
      part_cell = name_cell(variant%mechanism%names(part)%text, column_width(layout, 1))
    else
      part_cell = name_cell(variant%mechanism%pin_names(-part)%text, column_width(layout, 1))
    end if
    in_length = .false.
    if (present(is_place)) in_length = is_place
    if (present(of_drive)) in_length = moves_along(variant%model%drives(1)%kind)
    length = table_unit("length", variant%model%outputs)
    unit_cell = name_cell("deg", column_width(layout, 5))
    if (in_length) unit_cell = name_cell(length%name, column_width(layout, 5))
    if (present(pure_number)) unit_cell = name_cell("1", column_width(layout, 5))
    call add_row(rows, part_cell//name_cell(quantity, column_width(layout, 2))//cells(layout, 3, &
      [crank, value])//unit_cell)
  end subroutine put

end module limits_report
