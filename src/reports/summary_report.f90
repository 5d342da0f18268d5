!> `summary.dat`: one row a variant, with least, mean and greatest of quantities over its positions
!! and speeds.
module summary_report
  use coordinates_report, only: ratio_unit
  use drive_motions, only: place_columns, table_place
  use effort_sources, only: effort_source_t, find_effort_sources
  use frequency_report, only: effects_notes, shown_speed
  use kinds, only: wp
  use load_notes, only: acceleration_note
  use models, only: accuracy_of_study, drives_length, has_law, model_t, nature_of_positions, &
    needs_frequencies, needs_response, report_number
  use named_coordinates, only: find_named_coordinates, named_coordinate_t
  use natures, only: length_nature, nature_t, of_effort, of_value
  use report_kinds, only: report_kind_t
  use report_types, only: add_table, lay_out_columns, report_record_t, table_plan_t, &
    whole_table_t
  use summary_quantities, only: column_names, quantity_kinds, quantity_name, quantity_t
  use summary_values, only: find_lack, find_summary, summary_value_t
  use table_columns, only: add_quantity_column, cells, table_layout_t
  use table_rows, only: add_failed_row, add_row, rows_t
  use tables, only: integer_cell
  use text, only: append_string, string_t, to_string, word_list
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_summary

  !> `summary.dat`.
  type, extends(whole_table_t) :: summary_table_t
  contains
    procedure, nopass :: find_notes => summary_notes
    procedure, nopass :: lay_out => lay_out_summary
    procedure, nopass :: add_all => add_summary
  end type summary_table_t

contains

  !> REPORT summary.
  subroutine describe_summary(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="summary", help="a row a variant: least, mean and "// &
      "greatest values", pattern="REPORT summary of=f1,torque,... [ratio_to=] "// &
      "[accuracy=]", positions=.true.)
    call add_table(report, summary_table_t(), "summary", "rows,failed:#", has_blocks=.false.)
  end subroutine describe_summary

  !> What the columns mean, and of what the quantities are. They do not depend on results, which
  !! differ from variant to variant.
  pure subroutine summary_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its model
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    type(string_t), allocatable :: effects(:)
    integer :: i

    associate (model => variant%model)
      call append_string(notes, "least, mean and greatest over all positions and speeds that "// &
        "could be computed, all with the same weight; rows: how many these are; failed: how "// &
        "many could not be computed; ..._least_crank and so on: the first place with this value")
      associate (summary => model%reports(report_number(model, "summary"))%summary)
        do i = 1, size(summary%quantities)
          call append_string(notes, quantity_name(summary%quantities(i))//": "// &
            trim(quantity_kinds(summary%quantities(i)%kind)%meaning)//", as in REPORT "// &
            trim(summary%reports(i)))
        end do
        if (any(quantity_kinds(summary%quantities%kind)%has_error)) call append_string(notes, &
          "..._error: the largest estimated error of these rows, relative to the frequency, or "// &
          "to the largest value of the quantity over the turn")
      end associate
      if (needs_frequencies(model)) then
        effects = effects_notes(model)
        do i = 1, size(effects)
          call append_string(notes, effects(i)%text)
        end do
      end if
      if (needs_response(model)) call append_string(notes, "elastic response: steady state at "// &
        "constant speed; accuracy asked for: "//to_string(accuracy_of_study(model, "response")))
      if (.not. needs_frequencies(model)) call append_string(notes, acceleration_note(model))
    end associate
  end subroutine summary_notes

  !> Appends the columns of the quantities to those that count rows.
  subroutine lay_out_summary(model, plan)
    type(model_t), intent(in) :: model        !! with REPORT summary
    type(table_plan_t), intent(inout) :: plan !! of the table

    type(string_t), allocatable :: places(:), names(:)
    character(len=:), allocatable :: unit
    integer :: i, k

    call lay_out_columns(model, plan)
    places = place_names(model)
    associate (summary => model%reports(report_number(model, "summary"))%summary)
      do i = 1, size(summary%quantities)
        names = column_names(summary%quantities(i), places)
        do k = 1, size(names)
          unit = unit_of(model, summary%quantities(i), names(k)%text)
          call add_quantity_column(plan%layout, names(k)%text, unit, model%outputs)
        end do
      end do
    end associate
  end subroutine lay_out_summary

  !> The columns that say where a row of a table of positions is.
  pure function place_names(model) result(names)
    type(model_t), intent(in) :: model
    type(string_t), allocatable :: names(:)

    names = word_list("speed crank")
    if (has_law(model)) names = word_list("time speed crank")
  end function place_names

  !> The unit of a column, as in the table of reports.
  pure function unit_of(model, quantity, column) result(unit)
    type(model_t), intent(in) :: model
    type(quantity_t), intent(in) :: quantity
    character(len=*), intent(in) :: column
    character(len=:), allocatable :: unit

    type(nature_t) :: nature
    type(effort_source_t), allocatable :: sources(:)

    select case (column(index(column, "_", back=.true.) + 1:))
    case ("time")
      unit = "time"
    case ("speed")
      unit = "speed"
      if (drives_length(model)) unit = model%speed_unit%name
    case ("crank")
      nature = nature_of_positions(model)
      unit = trim(nature%words(of_value))
    case ("error")
      unit = "-"
    case default
      unit = trim(quantity_kinds(quantity%kind)%unit)
      if (quantity%of /= "") unit = unit_of_coordinate(model, quantity)
      ! What turns a crank is a force on a slider.
      if (unit == "moment" .and. index(column, "torque") > 0) then
        call find_effort_sources(model, sources)
        unit = trim(sources(1)%nature%words(of_effort))
      end if
    end select
  end function unit_of

  !> The unit of a quantity of a coordinate: of lengths as in the table of quantities.
  pure function unit_of_coordinate(model, quantity) result(unit)
    type(model_t), intent(in) :: model
    type(quantity_t), intent(in) :: quantity
    character(len=:), allocatable :: unit

    type(named_coordinate_t), allocatable :: named(:)
    integer :: i

    call find_named_coordinates(model, named)
    associate (reference => model%reports(report_number(model, "summary"))%reference)
      unit = trim(quantity_kinds(quantity%kind)%unit)
      if (unit == "-") then
        unit = ratio_unit(model, named([quantity%mode, reference])%nature)
        return
      end if
      i = findloc(length_nature%words == unit, .true., dim=1)
      if (i > 0) unit = trim(named(quantity%mode)%nature%words(i))
    end associate
  end function unit_of_coordinate

  !> Appends the row of a variant, or a failed row if a quantity is nowhere.
  subroutine add_summary(variant, layout, rows)
    type(variant_results_t), intent(in) :: variant !! with all that the quantities need
    type(table_layout_t), intent(in) :: layout     !! of this table
    type(rows_t), intent(inout) :: rows            !! to which it is appended

    type(summary_value_t), allocatable :: values(:)
    real(wp), allocatable :: numbers(:)
    real(wp) :: nowhere(0)
    character(len=:), allocatable :: reason
    integer :: failed, places, i

    call find_summary(variant, values, places, failed)
    call find_lack(variant, values, reason)
    if (allocated(reason)) then
      call add_failed_row(rows, nowhere, reason)
      return
    end if
    allocate (numbers(0))
    associate (summary => variant%model%reports(report_number(variant%model, "summary"))%summary)
      do i = 1, size(values)
        associate (this => values(i))
          numbers = [numbers, this%least, place_of(variant, summary%reports(i), this%least_at), &
            this%mean, this%greatest, place_of(variant, summary%reports(i), this%greatest_at)]
          if (quantity_kinds(summary%quantities(i)%kind)%has_error) numbers = [numbers, this%error]
        end associate
      end do
    end associate
    call add_row(rows, integer_cell(places - failed, "rows")//integer_cell(failed, "failed")// &
      cells(layout, 3, numbers))
  end subroutine add_summary

  !> The place of a row as its table has it.
  pure function place_of(variant, report, at) result(place)
    type(variant_results_t), intent(in) :: variant
    character(len=*), intent(in) :: report !! name
    integer, intent(in) :: at(2)           !! position and speed
    real(wp) :: place(place_columns(variant%model))

    place = table_place(variant%model, at(2), at(1))
    if (report == "frequencies") place(1) = shown_speed(variant, at(2))
  end function place_of

end module summary_report
