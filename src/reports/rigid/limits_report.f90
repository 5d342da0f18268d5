!> `linkage.dat` of linkages that are no four-bars: ranges of the drives, dead points, swings,
!! strokes, time ratios, transmission and pressure angles, extremes of coordinates, a row each.
module limits_report
  use coordinate_columns, only: shown_unit
  use kinds, only: wp
  use limits_study, only: angle_of_body, crank_range_t, drive_range_t, place_of_slider, &
    quantity_t, time_ratio, transmission_of_dyad, transmission_of_lines, value_of_coordinate
  use limits_words, only: limits_names, limits_notes
  use models, only: nature_of_positions
  use named_coordinates, only: measured_coordinate
  use natures, only: angle_nature, length_nature, nature_t
  use report_kinds, only: other_linkages, report_kind_t
  use report_types, only: add_table, report_record_t, table_plan_t, whole_table_t
  use table_columns, only: cells, column_width, table_layout_t
  use table_rows, only: add_failed_row, add_row, rows_t
  use tables, only: name_cell
  use units, only: from_si, unit_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_limits

  !> `linkage.dat` of other linkages.
  type, extends(whole_table_t) :: limits_table_t
  contains
    procedure, nopass :: find_notes => limits_notes
    procedure, nopass :: plan => plan_limits
    procedure, nopass :: add_all => add_limits
  end type limits_table_t

  !> What a row is about: a link, a pin, or a coordinate, by its number.
  type :: part_t
    integer :: link = 0
    integer :: pin = 0
    integer :: line = 0       !! link along which the pin slides: part of the name
    integer :: coordinate = 0 !! number in the mechanism's list
  end type part_t

contains

  !> REPORT linkage of linkages that are no four-bars.
  subroutine describe_limits(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="linkage", help="of other linkages: ranges, swings, "// &
      "strokes, time ratios", pattern="REPORT linkage [format=]", studies="limits", &
      linkages=other_linkages)
    call add_table(report, limits_table_t(), "linkage", "part,quantity:name crank:deg "// &
      "value:see_unit unit:name")
  end subroutine describe_limits

  !> Appends all rows.
  subroutine add_limits(variant, layout, rows)
    type(variant_results_t), intent(in) :: variant !! with its limits found
    type(table_layout_t), intent(in) :: layout     !! of this table
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    type(nature_t) :: positions
    real(wp) :: nowhere(0)
    integer :: r, q

    positions = nature_of_positions(variant%model)
    associate (found => variant%found%limits, names => variant%mechanism%names)
      if (size(found%ranges) == 0) call add_failed_row(rows, nowhere, &
        "the linkage closes nowhere")
      do r = 1, size(found%ranges)
        if (.not. found%ranges(r)%turns) then
          if (.not. found%ranges(r)%is_open(1)) call put(variant, layout, rows, part_at_end( &
            variant, found%ranges(r), 1), "range_from", found%ranges(r)%from, &
            found%ranges(r)%from, positions)
          if (.not. found%ranges(r)%is_open(2)) call put(variant, layout, rows, part_at_end( &
            variant, found%ranges(r), 2), "range_to", found%ranges(r)%to, &
            found%ranges(r)%to, positions)
        end if
        call add_low_points(variant, layout, r, rows)
        do q = 1, size(found%quantities)
          call add_quantity(variant, layout, r, q, rows)
        end do
      end do
      do r = 1, size(found%further)
        call add_further(variant, layout, found%further(r), rows)
      end do
    end associate
  end subroutine add_limits

  !> Dead points inside a range, and how near to one groups come that iterations place.
  subroutine add_low_points(variant, layout, r, rows)
    type(variant_results_t), intent(in) :: variant
    type(table_layout_t), intent(in) :: layout
    integer, intent(in) :: r !! number of the range
    type(rows_t), intent(inout) :: rows

    integer :: i

    do i = 1, size(variant%found%limits%low(r)%at)
      associate (point => variant%found%limits%low(r)%at(i))
        if (point%is_change) then
          call put(variant, layout, rows, part_of_group(variant, point%group), "change_point", &
            point%crank, point%crank, nature_of_positions(variant%model))
        else if (point%is_dead) then
          call put(variant, layout, rows, part_of_group(variant, point%group), "dead_point", &
            point%crank, point%crank, nature_of_positions(variant%model))
        else
          call put(variant, layout, rows, part_of_group(variant, point%group), &
            "least_determinant", point%crank, point%sine)
        end if
      end associate
    end do
  end subroutine add_low_points

  !> The range of a further drive, in its own unit.
  subroutine add_further(variant, layout, further, rows)
    type(variant_results_t), intent(in) :: variant
    type(table_layout_t), intent(in) :: layout
    type(drive_range_t), intent(in) :: further
    type(rows_t), intent(inout) :: rows

    type(nature_t) :: nature
    type(part_t) :: part

    nature = variant%model%drives(further%drive)%nature
    associate (linkage => variant%mechanism%linkage, measure => variant%model%drives( &
        further%drive)%measure)
      part%link = linkage%drives(further%drive)%body
      if (measure > 0) then
        part%coordinate = measured_coordinate(variant%model, measure)
      else if (part%link == 0) then
        part%pin = linkage%sliders(linkage%drives(further%drive)%slider)%pin
      end if
    end associate
    call put(variant, layout, rows, part, "drive_from", further%crank(1), further%range%from, &
      nature)
    call put(variant, layout, rows, part, "drive_to", further%crank(2), further%range%to, nature)
  end subroutine add_further

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
      if (abs(x%turned) > 0.0_wp) then
        if (quantity%kind == value_of_coordinate) then
          call put_value("gain", 0.0_wp, x%turned)
        else
          call put(variant, layout, rows, part_of(variant, quantity), "turns", 0.0_wp, &
            x%turned/360.0_wp)
        end if
        return
      end if
      ratio = 0.0_wp
      least = ""
      swing = ""
      select case (quantity%kind)
      case (angle_of_body)
        least = "least_angle"
        greatest = "greatest_angle"
        swing = "swing"
        ratio = time_ratio(found%ranges(r), x)
      case (place_of_slider)
        least = "least_place"
        greatest = "greatest_place"
        swing = "stroke"
        ratio = time_ratio(found%ranges(r), x)
      case (value_of_coordinate)
        least = "least_value"
        greatest = "greatest_value"
        swing = "span"
        ratio = time_ratio(found%ranges(r), x)
      case (transmission_of_dyad, transmission_of_lines)
        least = "least_transmission"
        greatest = "greatest_transmission"
      case default
        greatest = "greatest_pressure"
      end select
      ! A constant place or angle has no limits.
      if (swing /= "" .and. swing /= "span" .and. .not. x%greatest > x%least) then
        call put_value(trim(swing), x%at_least, 0.0_wp)
        return
      end if
      if (least /= "") call put_value(trim(least), x%at_least, x%least)
      call put_value(trim(greatest), x%at_greatest, x%greatest)
      if (swing /= "") call put_value(trim(swing), x%at_greatest, x%greatest - x%least)
      if (ratio > 0.0_wp) call put(variant, layout, rows, part_of(variant, quantity), &
        "time_ratio", x%at_greatest, ratio)
    end associate

  contains

    subroutine put_value(word, crank, value)
      character(len=*), intent(in) :: word
      real(wp), intent(in) :: crank, value

      associate (quantity => variant%found%limits%quantities(q))
        call put(variant, layout, rows, part_of(variant, quantity), word, crank, value, &
          nature_of(variant, quantity))
      end associate
    end subroutine put_value

  end subroutine add_quantity

  !> What a quantity is.
  pure function nature_of(variant, quantity) result(nature)
    type(variant_results_t), intent(in) :: variant
    type(quantity_t), intent(in) :: quantity
    type(nature_t) :: nature

    nature = angle_nature
    if (quantity%kind == place_of_slider) nature = length_nature
    if (quantity%kind == value_of_coordinate) nature = &
      variant%mechanism%coordinates(quantity%number)%nature
  end function nature_of

  !> What a quantity is of.
  pure function part_of(variant, quantity) result(part)
    type(variant_results_t), intent(in) :: variant
    type(quantity_t), intent(in) :: quantity
    type(part_t) :: part

    associate (linkage => variant%mechanism%linkage, number => quantity%number)
      select case (quantity%kind)
      case (angle_of_body)
        part%link = number
      case (place_of_slider)
        part%pin = linkage%sliders(number)%pin
        part%line = linkage%sliders(number)%body
      case (value_of_coordinate)
        part%coordinate = number
      case (transmission_of_lines)
        part%pin = linkage%groups(number)%pins(1)
      case default
        part%pin = linkage%groups(number)%middle
      end select
    end associate
  end function part_of

  !> What ends a range: the pin of a block that leaves its link, or a part of a group.
  pure function part_at_end(variant, range, end) result(part)
    type(variant_results_t), intent(in) :: variant
    type(crank_range_t), intent(in) :: range
    integer, intent(in) :: end !! 1: from, 2: to
    type(part_t) :: part

    part%pin = range%left_at(end)
    if (part%pin == 0) part = part_of_group(variant, range%blocked_by(end))
  end function part_at_end

  !> The pin of a dyad, or a link of another group; the first link without one.
  pure function part_of_group(variant, group) result(part)
    type(variant_results_t), intent(in) :: variant
    integer, intent(in) :: group
    type(part_t) :: part

    part%link = 1
    if (group == 0) return
    associate (it => variant%mechanism%linkage%groups(group))
      if (it%middle > 0) then
        part = part_t(pin=it%middle)
      else if (it%body(1) > 0) then
        part%link = it%body(1)
      else if (allocated(it%bodies)) then
        if (size(it%bodies) > 0) part%link = it%bodies(1)
      end if
    end associate
  end function part_of_group

  !> Appends a row.
  subroutine put(variant, layout, rows, part, quantity, crank, value, nature)
    type(variant_results_t), intent(in) :: variant
    type(table_layout_t), intent(in) :: layout
    type(rows_t), intent(inout) :: rows
    type(part_t), intent(in) :: part
    character(len=*), intent(in) :: quantity
    real(wp), intent(in) :: crank, value
    type(nature_t), intent(in), optional :: nature !! of the value; absent: a pure number

    character(len=column_width(layout, 1)) :: part_cell
    type(unit_t) :: measure

    associate (mechanism => variant%mechanism, width => column_width(layout, 1))
      if (part%coordinate > 0) then
        part_cell = name_cell(mechanism%coordinates(part%coordinate)%name, width)
      else if (part%link > 0) then
        part_cell = name_cell(mechanism%names(part%link)%text, width)
      else if (part%line > 0) then
        part_cell = name_cell(mechanism%pin_names(part%pin)%text//":"//mechanism%names( &
          part%line)%text, width)
      else
        part_cell = name_cell(mechanism%pin_names(part%pin)%text, width)
      end if
    end associate
    measure%name = "1"
    if (present(nature)) measure = shown_unit(nature, variant%model%outputs)
    call add_row(rows, part_cell//name_cell(quantity, column_width(layout, 2))//cells(layout, 3, &
      [crank, from_si(value, measure)])//name_cell(measure%name, column_width(layout, 5)))
  end subroutine put

  !> Names of parts, quantities and units.
  subroutine plan_limits(variant, plan)
    type(variant_results_t), intent(in) :: variant !! with its results
    type(table_plan_t), intent(inout) :: plan      !! of the table

    plan%names(:3) = limits_names(variant)
  end subroutine plan_limits

end module limits_report
