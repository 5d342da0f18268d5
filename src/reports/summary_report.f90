!> `summary.dat`: one row a variant, with least, mean and greatest of quantities over its positions
!! and speeds.
!!
!! Values and failures are those of the tables that have a row for each of them. A new quantity is a
!! record of `summary_quantities` and a case of `find_value`.
module summary_report
  use drive_motions, only: drive_rates, place_columns, table_place
  use errors, only: error_t
  use friction_words, only: lock_words
  use frequency_report, only: effects_notes, shown_speed
  use frequency_study, only: damping_values, failure_at, frequency_values, has_result
  use joint_study, only: drives_at_speed, frame_at_speed, joints_at_speed
  use joints_report, only: open_words
  use kinds, only: wp
  use kinematics_study, only: kinematic_values, kinematics_at
  use load_notes, only: acceleration_note
  use locked_rows, only: is_locked_at, lock_at
  use models, only: accuracy_of_study, drives_length, has_law, model_t, needs_frequencies, &
    needs_response, report_number
  use report_kinds, only: report_kind_t
  use report_types, only: add_table, lay_out_columns, report_record_t, table_plan_t, &
    whole_table_t
  use response_notes, only: has_response
  use summary_quantities, only: column_names, quantity_kinds, quantity_name, quantity_t
  use table_columns, only: add_quantity_column, cells, table_layout_t
  use table_rows, only: add_failed_row, add_row, rows_t
  use tables, only: integer_cell
  use text, only: append_string, string_t, to_string, word_list
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_summary

  !> A value at a position and speed.
  type :: value_t
    logical :: is_there = .false. !! false: the row of its table has failed
    real(wp) :: value = 0.0_wp    !! in SI, or in the unit of its column
    real(wp) :: error = 0.0_wp    !! estimated [-]
  end type value_t

  !> A quantity over the positions and speeds at which it is there. Places are position and speed,
  !! the first with this value.
  type :: range_t
    integer :: count = 0
    real(wp) :: least = 0.0_wp, greatest = 0.0_wp, sum = 0.0_wp, error = 0.0_wp
    integer :: least_at(2) = 0, greatest_at(2) = 0
    integer :: failed_at(2) = 0 !! the first place without it; 0: none
  end type range_t

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
      "greatest values", pattern="REPORT summary of=f1,torque,... [accuracy=]", positions=.true.)
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

    select case (column(index(column, "_", back=.true.) + 1:))
    case ("time")
      unit = "time"
    case ("speed")
      unit = "speed"
      if (drives_length(model)) unit = model%speed_unit%name
    case ("crank")
      unit = trim(merge("length", "deg   ", drives_length(model)))
    case ("error")
      unit = "-"
    case default
      unit = trim(quantity_kinds(quantity%kind)%unit)
      ! What turns a crank is a force on a slider.
      if (unit == "moment" .and. drives_length(model) .and. index(column, "torque") > 0) &
        unit = "force"
    end select
  end function unit_of

  !> Appends the row of a variant, or a failed row if a quantity is nowhere.
  subroutine add_summary(variant, layout, rows)
    type(variant_results_t), intent(in) :: variant !! with all that the quantities need
    type(table_layout_t), intent(in) :: layout     !! of this table
    type(rows_t), intent(inout) :: rows            !! to which it is appended

    type(range_t), allocatable :: ranges(:)
    real(wp), allocatable :: values(:)
    real(wp) :: nowhere(0)
    character(len=:), allocatable :: reason
    integer :: failed, places, i, lacking

    call find_ranges(variant, ranges, places, failed)
    associate (summary => variant%model%reports(report_number(variant%model, "summary"))%summary)
      lacking = findloc(ranges%count, 0, dim=1)
      if (lacking > 0) then
        ! One thread at a time makes texts.
        !$omp critical (one_at_a_time)
        call find_reason(variant, summary%reports(lacking), ranges(lacking)%failed_at, reason)
        if (any(ranges%count > 0)) reason = quantity_name(summary%quantities(lacking))//": "// &
          reason
        !$omp end critical (one_at_a_time)
        call add_failed_row(rows, nowhere, reason)
        return
      end if
      allocate (values(0))
      do i = 1, size(ranges)
        associate (range => ranges(i))
          values = [values, range%least, place_of(variant, summary%reports(i), range%least_at), &
            range%sum/range%count, range%greatest, place_of(variant, summary%reports(i), &
            range%greatest_at)]
          if (quantity_kinds(summary%quantities(i)%kind)%has_error) values = [values, range%error]
        end associate
      end do
    end associate
    call add_row(rows, integer_cell(places - failed, "rows")//integer_cell(failed, "failed")// &
      cells(layout, 3, values))
  end subroutine add_summary

  !> Every quantity over its positions and speeds, in the order of their table.
  subroutine find_ranges(variant, ranges, places, failed)
    type(variant_results_t), intent(in) :: variant
    type(range_t), allocatable, intent(out) :: ranges(:) !! (quantities)
    integer, intent(out) :: places !! number of positions and speeds
    integer, intent(out) :: failed !! at how many of them a quantity is not there

    logical, allocatable :: lacks(:, :)
    type(value_t) :: found
    integer :: i, k, q, speeds

    associate (summary => variant%model%reports(report_number(variant%model, "summary"))%summary, &
        positions => size(variant%found%positions%crank))
      speeds = 0
      do q = 1, size(summary%quantities)
        speeds = max(speeds, speed_count(variant, summary%reports(q)))
      end do
      allocate (lacks(positions, speeds), source=.false.)
      allocate (ranges(size(summary%quantities)))
      do q = 1, size(ranges)
        do k = 1, speed_count(variant, summary%reports(q))
          do i = 1, positions
            call find_value(variant, summary%quantities(q), trim(summary%reports(q)), i, k, found)
            call take(found, [i, k], ranges(q))
            if (found%is_there) cycle
            ! Static frequencies are those of all speeds.
            if (speed_count(variant, summary%reports(q)) < speeds) lacks(i, :) = .true.
            lacks(i, k) = .true.
          end do
        end do
      end do
    end associate
    places = size(lacks)
    failed = count(lacks)
  end subroutine find_ranges

  !> Takes a value into a range.
  pure subroutine take(found, place, range)
    type(value_t), intent(in) :: found
    integer, intent(in) :: place(2)
    type(range_t), intent(inout) :: range

    if (.not. found%is_there) then
      if (range%failed_at(1) == 0) range%failed_at = place
      return
    end if
    if (range%count == 0 .or. found%value < range%least) then
      range%least = found%value
      range%least_at = place
    end if
    if (range%count == 0 .or. found%value > range%greatest) then
      range%greatest = found%value
      range%greatest_at = place
    end if
    range%count = range%count + 1
    range%sum = range%sum + found%value
    range%error = max(range%error, found%error)
  end subroutine take

  !> Number of speeds of a report's table.
  pure function speed_count(variant, report) result(count)
    type(variant_results_t), intent(in) :: variant
    character(len=*), intent(in) :: report !! name
    integer :: count

    count = size(variant%model%speed%value)
    if (report == "frequencies") count = size(variant%found%sweep%request%speed)
  end function speed_count

  !> The place of a row as its table has it.
  pure function place_of(variant, report, at) result(place)
    type(variant_results_t), intent(in) :: variant
    character(len=*), intent(in) :: report !! name
    integer, intent(in) :: at(2)           !! position and speed
    real(wp) :: place(place_columns(variant%model))

    place = table_place(variant%model, at(2), at(1))
    if (report == "frequencies") place(1) = shown_speed(variant, at(2))
  end function place_of

  !> A quantity at a position and speed.
  subroutine find_value(variant, quantity, report, position, speed, found)
    type(variant_results_t), intent(in) :: variant
    type(quantity_t), intent(in) :: quantity
    character(len=*), intent(in) :: report    !! that has it, of this linkage
    integer, intent(in) :: position, speed    !! numbers
    type(value_t), intent(out) :: found

    real(wp) :: rates(2), values(2*variant%model%modes), frame(6), &
      motion(kinematic_values), drives(3, size(variant%mechanism%linkage%drives))

    associate (model => variant%model, results => variant%found, &
        state => variant%found%positions%state(position), &
        name => quantity_kinds(quantity%kind)%name)
      found%is_there = is_computed(variant, table_of(report, name), position, speed)
      if (.not. found%is_there) return
      rates = drive_rates(model, speed, position)
      select case (report)
      case ("frequencies")
        values = frequency_values(results%sweep, state, speed)
        found%error = values(model%modes + quantity%mode)
        if (name == "zeta*") values(:model%modes) = damping_values(results%sweep, state, speed)
        found%value = values(quantity%mode)
      case ("kinematics")
        motion = kinematics_at(results%kinematics, state, rates(1), rates(2))
        found%value = motion(kinematic_values)
      case ("drives")
        drives = drives_at_speed(variant%mechanism%linkage, results%joints, state, &
          results%positions%crank(position), rates(1), rates(2), speed)
        frame = frame_at_speed(variant%mechanism%linkage, results%joints, state, rates(1), &
          rates(2), speed)
        if (name == "torque") found%value = drives(3, 1)
        if (name == "shaking_force") found%value = norm2(frame(:2))
        if (name == "shaking_moment") found%value = frame(3)
      case ("frame")
        frame = frame_at_speed(variant%mechanism%linkage, results%joints, state, rates(1), &
          rates(2), speed)
        found%value = norm2(frame(4:5))
      case ("bearings")
        found%value = greatest_force(variant, state, rates, speed)
      case ("strains", "response", "torque")
        call find_elastic_value(variant, trim(name), position, speed, found)
      end select
    end associate
  end subroutine find_value

  !> The greatest force in any joint [N].
  pure function greatest_force(variant, state, rates, speed) result(greatest)
    type(variant_results_t), intent(in) :: variant
    integer, intent(in) :: state
    real(wp), intent(in) :: rates(2)
    integer, intent(in) :: speed
    real(wp) :: greatest

    real(wp) :: forces(3, size(variant%found%joints%joints))

    forces = joints_at_speed(variant%found%joints, state, rates(1), rates(2), speed)
    greatest = maxval(norm2(forces(:2, :), dim=1))
  end function greatest_force

  !> A quantity of the elastic response: of gauges or points the greatest.
  pure subroutine find_elastic_value(variant, name, position, speed, found)
    type(variant_results_t), intent(in) :: variant
    character(len=*), intent(in) :: name
    integer, intent(in) :: position, speed
    type(value_t), intent(inout) :: found

    associate (at_speed => variant%found%response%at_speed(speed))
      select case (name)
      case ("strain")
        found%value = maxval(abs(at_speed%strain(1, :, position) + at_speed%strain(2, :, position)))
        found%error = maxval(at_speed%strain_error)
      case ("stress")
        found%value = maxval(at_speed%strain(6, :, position))
        found%error = maxval(at_speed%strain_error)
      case ("displacement")
        found%value = maxval(norm2(at_speed%displacement(:2, :, position), dim=1))
        found%error = maxval(at_speed%displacement_error)
      case ("elastic_torque")
        found%value = at_speed%drive(4, position)
        found%error = at_speed%drive_error
      end select
    end associate
  end subroutine find_elastic_value

  !> The table of a report that has a quantity.
  pure function table_of(report, quantity) result(table)
    character(len=*), intent(in) :: report, quantity !! names
    character(len=10) :: table

    table = report
    if (report == "drives" .and. index(quantity, "shaking") == 1) table = "shaking"
  end function table_of

  !> Whether a report's table has a row at a position and speed.
  pure function is_computed(variant, report, position, speed) result(is)
    type(variant_results_t), intent(in) :: variant
    character(len=*), intent(in) :: report
    integer, intent(in) :: position, speed
    logical :: is

    associate (found => variant%found, state => variant%found%positions%state(position))
      select case (report)
      case ("strains", "response", "torque")
        is = has_response(variant, speed)
      case ("frequencies")
        is = has_result(found%positions, found%sweep, state, speed)
      case default
        is = .not. allocated(found%positions%states(state)%error)
        if (is) is = .not. is_locked_at(variant, report, position, speed)
        if (is .and. report == "bearings") is = .not. any(found%joints%is_open(:, state))
      end select
    end associate
  end function is_computed

  !> Why it has none.
  pure subroutine find_reason(variant, report, at, reason)
    type(variant_results_t), intent(in) :: variant
    character(len=*), intent(in) :: report
    integer, intent(in) :: at(2) !! position and speed without a row
    character(len=:), allocatable, intent(out) :: reason

    type(error_t) :: error

    associate (found => variant%found, state => variant%found%positions%state(at(1)))
      select case (report)
      case ("strains", "response", "torque")
        reason = found%response%at_speed(at(2))%error%text
      case ("frequencies")
        error = failure_at(found%positions, found%sweep, state, at(2))
        reason = error%text
      case default
        if (allocated(found%positions%states(state)%error)) then
          reason = found%positions%states(state)%error%text
        else if (is_locked_at(variant, report, at(1), at(2))) then
          reason = lock_words(variant%model, variant%mechanism, lock_at(variant, report, at(1), &
            at(2)))
        else
          reason = open_words(variant, found%joints%joints(findloc(found%joints%is_open(:, state), &
            .true., dim=1)))
        end if
      end select
    end associate
  end subroutine find_reason

end module summary_report
