!> `sizing.dat`: what is bought for a linkage: drives, bearings and a flywheel, a value a row.
module sizing_report
  use constants, only: degree
  use effort_sources, only: effort_source_t, find_effort_sources
  use joints_report, only: add_open_row, joint_owners, owner_cell
  use kinds, only: wp
  use number_text, only: most_digits, rounded
  use load_notes, only: acceleration_note, append_load_notes
  use models, only: has_law, model_t, report_number
  use motor_cards, only: is_geared
  use pins_report, only: pin_names
  use natures, only: of_effort, of_rate
  use report_kinds, only: report_kind_t
  use report_types, only: add_table, fit_columns, report_record_t, table_plan_t, whole_table_t
  use sizing_study, only: sized_t, sizing_result_t, sizing_t
  use table_columns, only: cells, column_width, name_list_t, table_layout_t, table_unit
  use table_rows, only: add_failed_row, add_gap, add_row, rows_t
  use tables, only: name_cell
  use text, only: append_string, string_t, to_string, trimmed_list, word_list
  use units, only: dimension_time, from_si, unit_t
  use value_words, only: in_words
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_sizing

  character(len=*), parameter :: quantity_words(*) = [character(len=20) :: "peak_torque", &
    "rms_torque", "mean_torque", "peak_force", "rms_force", "mean_force", "cubic_mean_force", &
    "equivalent_force", "angle_at_peak", "rate", "peak_rate", "rms_rate", "peak_power", &
    "mean_power", "flywheel", "energy_of_cycle", "fluctuation_without", "fluctuation", &
    "greatest_rate", "least_rate"]

  !> Names of quantities whose units the deck's results have.
  character(len=*), parameter :: unit_words(*) = [character(len=8) :: "moment", "force", "rate", &
    "velocity", "power", "inertia", "energy"]

  !> In place of a pin in rows of drives.
  character(len=*), parameter :: no_pin = "-", flywheel_word = "flywheel", motor_word = "motor"

  !> What a row says of its part.
  type :: value_t
    character(len=20) :: quantity    !! one of `quantity_words`
    real(wp) :: value                !! [SI] or [deg]
    character(len=8) :: unit         !! one of `unit_words`, `deg` or `1`
    real(wp) :: crank = 0.0_wp       !! where it is, of laws the time; 0 without a place
    real(wp) :: error = 0.0_wp       !! estimated, a share of the peak
  end type value_t

  !> `sizing.dat`.
  type, extends(whole_table_t) :: sizing_table_t
  contains
    procedure, nopass :: find_notes => sizing_notes
    procedure, nopass :: fit => fit_sizing
    procedure, nopass :: plan => plan_sizing
    procedure, nopass :: add_all => add_sizing
  end type sizing_table_t

contains

  !> REPORT sizing.
  subroutine describe_sizing(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="sizing", help="peaks and means of drives and bearings, "// &
      "the flywheel", pattern="REPORT sizing [fluctuation=]", studies="sizing", &
      masses=.true., weighs=.true.)
    call add_table(report, sizing_table_t(), "sizing", "speed:speed part,pin,quantity:name "// &
      "value:see_unit unit:name crank:deg error:-")
  end subroutine describe_sizing

  !> Over what, signs, which cubic mean, what the flywheel does, loads.
  pure subroutine sizing_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its sizing found
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    character(len=5) :: place

    place = merge("time ", "crank", has_law(variant%model))
    associate (found => variant%found%sizing, report => variant%model%reports(report_number( &
        variant%model, "sizing")))
      if (.not. allocated(found%error)) call append_string(notes, cycle_note(variant, found))
      call append_string(notes, "peak: greatest absolute value, of drives with its sign; "// &
        trim(place)//": where it is, 0 in rows without a place; cubic_mean_force: cube root "// &
        "of the mean of |F|^3 over the cycle; equivalent_force: the same weighted by the rate "// &
        "at which the joint turns or slides, cube root of (integral of |F|^3 |v|)/(integral of "// &
        "|v|), by ISO 281 the constant load of the same life of a ball "// &
        "bearing; none where a joint is at rest; v of a link at a pin is that against the "// &
        "ground, the block or the other link, where there are more against the first one")
      call append_string(notes, "forces of joints: on the link at the pin, as in bearings.dat; "// &
        "angle_at_peak: of the force in the axes of the link")
      call append_string(notes, "power: of the drive on the linkage, positive where it drives; "// &
        "error: estimated, as a share of the peak, from half as many samples; of "// &
        "angle_at_peak in deg, where the peak is flat")
      if (is_geared(variant%model%motor)) call append_string(notes, "motor: at its shaft, "// &
        "before its gear, with the losses there and, under an acceleration, its rotor; drive "// &
        variant%model%drives(1)%subject%text//": behind the gear")
      if (report%fluctuation > 0.0_wp) call append_flywheel_notes(report%fluctuation, &
        variant%model%motor%rotor > 0.0_wp, notes)
    end associate
    call append_string(notes, acceleration_note(variant%model))
    call append_load_notes(notes, variant%model, variant%mechanism)
  end subroutine sizing_notes

  !> Over what cycle all values are.
  pure function cycle_note(variant, found) result(note)
    type(variant_results_t), intent(in) :: variant
    type(sizing_result_t), intent(in) :: found !! its sizing
    character(len=:), allocatable :: note

    if (.not. has_law(variant%model)) then
      note = "over a cycle of "//to_string(found%period, 6)//" deg of the first drive at "// &
        "constant speed: "//to_string(found%samples)//" samples, peaks enclosed between them"
    else if (found%repeats) then
      note = "over a period of "//in_words(found%period, dimension_time, variant%model%units, &
        6)//" of the laws: "//to_string(found%samples)//" samples, peaks enclosed between them"
    else
      note = "over the "//in_words(found%period, dimension_time, variant%model%units, 6)// &
        " from the first to the last instant of TIME as the cycle: "// &
        to_string(found%samples)//" samples, at instants, jumps of laws, "// &
        "rows of tables over the time, and between these; peaks enclosed between samples"
    end if
  end function cycle_note

  !> What the flywheel does.
  pure subroutine append_flywheel_notes(fluctuation, has_rotor, notes)
    real(wp), intent(in) :: fluctuation
    logical, intent(in) :: has_rotor !! the motor has a rotor
    type(string_t), allocatable, intent(inout) :: notes(:)

    call append_string(notes, "flywheel: moment of inertia on the first drive with which "// &
      "(greatest - least)/mean speed is "//to_string(fluctuation, 9)// &
      " while a constant torque, mean_torque, drives the linkage; the mean of the speed is "// &
      "that over time; 0: none is "// &
      "needed; loads that depend on the speed are those at the mean speed")
    if (has_rotor) call append_string(notes, "flywheel: beside the rotor of the motor, which "// &
      "acts as one; without the losses in its gear")
    call append_string(notes, "energy_of_cycle: greatest less least of the integral of "// &
      "(mean_torque - torque of the loads); fluctuation_without: without a flywheel; "// &
      "greatest_rate, least_rate: with it; error: a share of the value, of mean_torque of "// &
      "peak_torque")
  end subroutine append_flywheel_notes

  !> The words in the columns `part`, `pin`, `quantity` and `unit`.
  pure function sizing_names(variant) result(lists)
    type(variant_results_t), intent(in) :: variant !! with its mechanism
    type(name_list_t) :: lists(4)

    type(effort_source_t), allocatable :: sources(:)
    type(unit_t) :: measure
    integer :: i

    lists(1) = joint_owners(variant)
    lists(1)%column = "part"
    call find_effort_sources(variant%model, sources)
    do i = 1, size(sources)
      call append_string(lists(1)%names, sources(i)%name)
    end do
    call append_string(lists(1)%names, flywheel_word)
    call append_string(lists(1)%names, motor_word)
    lists(2) = pin_names(variant)
    lists(2)%column = "pin"
    call append_string(lists(2)%names, no_pin)
    lists(3)%column = "quantity"
    lists(3)%names = trimmed_list(quantity_words)
    lists(4)%column = "unit"
    lists(4)%names = word_list("deg 1")
    do i = 1, size(unit_words)
      measure = table_unit(trim(unit_words(i)), variant%model%outputs)
      call append_string(lists(4)%names, measure%name)
    end do
  end function sizing_names

  !> Appends all rows: drives, joints, the flywheel; a block per speed.
  subroutine add_sizing(variant, layout, rows)
    type(variant_results_t), intent(in) :: variant !! with its sizing found
    type(table_layout_t), intent(in) :: layout     !! of this table
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    integer :: speed

    do speed = 1, size(variant%model%speed%value)
      if (speed > 1) call add_gap(rows, 2)
      call add_speed(variant, layout, speed, rows)
    end do
  end subroutine add_sizing

  !> Appends the rows of a speed.
  subroutine add_speed(variant, layout, speed, rows)
    type(variant_results_t), intent(in) :: variant
    type(table_layout_t), intent(in) :: layout
    integer, intent(in) :: speed !! number in the deck's list
    type(rows_t), intent(inout) :: rows

    integer :: s

    associate (found => variant%found%sizing)
      if (allocated(found%error)) then
        call add_failed_row(rows, place_of(variant, speed), found%error%text)
        return
      end if
      associate (at_speed => found%at_speed(speed))
        do s = 1, size(at_speed%sized)
          if (at_speed%sized(s)%drive > 0) then
            call add_drive(variant, layout, speed, at_speed%sized(s), rows)
          else if (found%is_open(at_speed%sized(s)%joint)) then
            call add_open_row(rows, place_of(variant, speed), variant, &
              found%joints(at_speed%sized(s)%joint))
          else
            call add_joint(variant, layout, speed, at_speed%sized(s), rows)
          end if
        end do
        if (at_speed%has_flywheel) call add_flywheel(variant, layout, speed, at_speed, rows)
      end associate
    end associate
  end subroutine add_speed

  !> The rows of a drive.
  subroutine add_drive(variant, layout, speed, sized, rows)
    type(variant_results_t), intent(in) :: variant
    type(table_layout_t), intent(in) :: layout
    integer, intent(in) :: speed
    type(sized_t), intent(in) :: sized
    type(rows_t), intent(inout) :: rows

    type(effort_source_t), allocatable :: sources(:)
    character(len=8) :: unit, unit_of_rate
    character(len=:), allocatable :: part, names, word

    call find_effort_sources(variant%model, sources)
    part = sources(sized%drive)%name
    if (sized%is_motor) part = motor_word
    associate (nature => sources(sized%drive)%nature)
      word = trim(nature%effort_noun)
      unit = nature%words(of_effort)
      unit_of_rate = nature%words(of_rate)
    end associate
    names = name_cell(part, column_width(layout, first_column(variant%model)))// &
      name_cell(no_pin, column_width(layout, first_column(variant%model) + 1))
    call put_rows(variant, layout, speed, names, [value_t("peak_"//word, sized%peak, unit, &
      sized%crank, sized%error), value_t("rms_"//word, sized%rms, unit, error=sized%error), &
      value_t("mean_"//word, sized%mean, unit, error=sized%error)], rows)
    if (sized%varies) then
      associate (timed => sized%timed)
        call put_rows(variant, layout, speed, names, &
          [value_t("peak_rate", sized%rate, unit_of_rate, timed%rate_at, timed%error(1)), &
          value_t("rms_rate", timed%rms_rate, unit_of_rate, error=timed%error(1)), &
          value_t("peak_power", timed%peak_power, "power", timed%power_at, timed%error(2)), &
          value_t("mean_power", timed%mean_power, "power", error=timed%error(2))], rows)
      end associate
    else
      call put_rows(variant, layout, speed, names, [value_t("rate", sized%rate, unit_of_rate), &
        value_t("peak_power", sized%peak*sized%rate, "power", sized%crank, sized%error), &
        value_t("mean_power", sized%mean*sized%rate, "power", error=sized%error)], rows)
    end if
  end subroutine add_drive

  !> The rows of a joint.
  subroutine add_joint(variant, layout, speed, sized, rows)
    type(variant_results_t), intent(in) :: variant
    type(table_layout_t), intent(in) :: layout
    integer, intent(in) :: speed
    type(sized_t), intent(in) :: sized
    type(rows_t), intent(inout) :: rows

    character(len=:), allocatable :: names
    integer :: first

    first = first_column(variant%model)
    associate (joint => variant%found%sizing%joints(sized%joint))
      names = owner_cell(variant, joint, column_width(layout, first))// &
        name_cell(variant%mechanism%pin_names(joint%pin)%text, column_width(layout, first + 1))
      call put_rows(variant, layout, speed, names, &
        [value_t("peak_force", sized%peak, "force", sized%crank, sized%error), &
        value_t("angle_at_peak", sized%angle, "deg", sized%crank, sized%angle_error), &
        value_t("rms_force", sized%rms, "force", error=sized%error), &
        value_t("mean_force", sized%mean, "force", error=sized%error), &
        value_t("cubic_mean_force", sized%cubic, "force", error=sized%error)], rows)
      if (sized%turns) call put_rows(variant, layout, speed, names, [value_t("equivalent_force", &
        sized%turned_cubic, "force", error=sized%turned_error)], rows)
    end associate
  end subroutine add_joint

  !> The rows of a flywheel.
  subroutine add_flywheel(variant, layout, speed, sizing, rows)
    type(variant_results_t), intent(in) :: variant
    type(table_layout_t), intent(in) :: layout
    integer, intent(in) :: speed
    type(sizing_t), intent(in) :: sizing
    type(rows_t), intent(inout) :: rows

    type(value_t) :: values(7)

    associate (flywheel => sizing%flywheel)
      values = [value_t("mean_torque", flywheel%mean_torque, "moment"), &
        value_t("energy_of_cycle", flywheel%energy, "energy"), &
        value_t("fluctuation_without", flywheel%alone, "1"), &
        value_t("flywheel", flywheel%inertia, "inertia"), &
        value_t("fluctuation", flywheel%fluctuation, "1"), &
        value_t("greatest_rate", flywheel%greatest, "rate", flywheel%at_greatest/degree), &
        value_t("least_rate", flywheel%least, "rate", flywheel%at_least/degree)]
      values%error = sizing%flywheel_error
      call put_rows(variant, layout, speed, name_cell(flywheel_word, column_width(layout, 2))// &
        name_cell(no_pin, column_width(layout, 3)), pack(values, flywheel%moves_alone .or. &
        values%quantity /= "fluctuation_without"), rows)
    end associate
  end subroutine add_flywheel

  !> Appends rows of a part: values in the units of the deck's results.
  subroutine put_rows(variant, layout, speed, names, values, rows)
    type(variant_results_t), intent(in) :: variant
    type(table_layout_t), intent(in) :: layout
    integer, intent(in) :: speed
    character(len=*), intent(in) :: names    !! cells of part and pin
    type(value_t), intent(in) :: values(:)   !! a row each
    type(rows_t), intent(inout) :: rows

    type(unit_t) :: measure
    character(len=:), allocatable :: unit
    real(wp) :: shown
    integer :: i, first

    first = first_column(variant%model)
    do i = 1, size(values)
      shown = values(i)%value
      unit = trim(values(i)%unit)
      if (any(unit_words == unit)) then
        measure = table_unit(unit, variant%model%outputs)
        shown = from_si(shown, measure)
        unit = measure%name
      end if
      if (values(i)%error > 0.0_wp) shown = rounded(shown, digits_to(values(i)%error, unit, shown))
      call add_row(rows, cells(layout, 1, place_of(variant, speed))//names// &
        name_cell(trim(values(i)%quantity), column_width(layout, first + 2))//cells(layout, &
        first + 3, [shown])//name_cell(unit, column_width(layout, first + 4))//cells(layout, &
        first + 5, [values(i)%crank, values(i)%error]))
    end do
  end subroutine put_rows

  !> Digits up to a thousandth of the error, which is an estimate; six at least.
  pure function digits_to(error, unit, value) result(digits)
    real(wp), intent(in) :: error        !! a share of the value, of an angle in degrees itself
    character(len=*), intent(in) :: unit !! of the value
    real(wp), intent(in) :: value
    integer :: digits

    real(wp) :: share

    share = error
    if (unit == "deg") share = error/max(abs(value), error)
    digits = min(most_digits, max(6, 4 - floor(log10(share))))
  end function digits_to

  !> The column of parts: the first of all where laws leave no speed to tell.
  pure function first_column(model) result(column)
    type(model_t), intent(in) :: model
    integer :: column

    column = merge(1, 2, has_law(model))
  end function first_column

  !> What a row begins with: the speed, where there is one.
  pure function place_of(variant, speed) result(place)
    type(variant_results_t), intent(in) :: variant
    integer, intent(in) :: speed
    real(wp) :: place(first_column(variant%model) - 1)

    place = variant%model%shown_speed(speed)
  end function place_of

  !> Of laws no speed, and times in place of positions.
  pure subroutine fit_sizing(model, columns)
    type(model_t), intent(in) :: model         !! with its drives
    character(len=*), intent(inout) :: columns !! of the record

    if (has_law(model)) columns = "part,pin,quantity:name value:see_unit unit:name "// &
      "time:time error:-"
    call fit_columns(model, columns)
  end subroutine fit_sizing

  !> Names of parts and quantities.
  subroutine plan_sizing(variant, plan)
    type(variant_results_t), intent(in) :: variant !! with its results
    type(table_plan_t), intent(inout) :: plan      !! of the table

    plan%names = sizing_names(variant)
  end subroutine plan_sizing

end module sizing_report
