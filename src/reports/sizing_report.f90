!> `sizing.dat`: what is bought for a linkage: drives, bearings and a flywheel, a value a row.
module sizing_report
  use drive_cards, only: moves_along
  use constants, only: degree
  use joints_report, only: joint_owners, owner_cell
  use kinds, only: wp
  use links_report, only: pin_names
  use load_notes, only: acceleration_note, append_load_notes
  use models, only: report_number
  use motor_cards, only: is_geared
  use sizing_study, only: sized_t, sizing_t
  use table_columns, only: cells, column_width, name_list_t, table_layout_t, table_unit
  use table_rows, only: add_failed_row, add_gap, add_row, rows_t
  use tables, only: name_cell
  use text, only: append_string, string_t, to_string, trimmed_list
  use units, only: from_si, unit_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: sizing_notes, sizing_names, add_sizing

  character(len=*), parameter :: quantity_words(*) = [character(len=20) :: "peak_torque", &
    "rms_torque", "mean_torque", "peak_force", "rms_force", "mean_force", "cubic_mean_force", &
    "angle_at_peak", "rate", "peak_power", "mean_power", "flywheel", &
    "energy_of_cycle", "fluctuation_without", "fluctuation", "greatest_rate", "least_rate"]

  !> Names of quantities whose units the deck's results have.
  character(len=*), parameter :: unit_words(*) = [character(len=8) :: "moment", "force", "rate", &
    "velocity", "power", "inertia", "energy"]

  !> In place of a pin in rows of drives.
  character(len=*), parameter :: no_pin = "-", flywheel_word = "flywheel", motor_word = "motor"

contains

  !> Over what, signs, which cubic mean, what the flywheel does, loads.
  pure subroutine sizing_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its sizing found
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    associate (found => variant%found%sizing, report => variant%model%reports(report_number( &
        variant%model, "sizing")))
      if (.not. allocated(found%error)) call append_string(notes, "over a cycle of "// &
        to_string(found%period, 6)//" deg of the first drive at constant speed: "// &
        to_string(found%samples)//" samples, peaks enclosed between them")
      call append_string(notes, "peak: greatest absolute value, of drives with its sign; "// &
        "crank: where it is, 0 in rows without a place; cubic_mean_force: cube root of the "// &
        "mean of "// &
        "|F|^3 over the cycle, not weighted by how the pin turns in its bearing")
      call append_string(notes, "forces of joints: on the link at the pin, as in bearings.dat; "// &
        "angle_at_peak: of the force in the axes of the link")
      call append_string(notes, "power: of the drive on the linkage, positive where it drives; "// &
        "error: estimated, as a share of the peak, from half as many samples")
      if (is_geared(variant%model%motor)) call append_string(notes, "motor: at its shaft, "// &
        "before its gear, with the losses there and, under an acceleration, its rotor; drive "// &
        variant%model%drives(1)%subject%text//": behind the gear")
      if (report%fluctuation > 0.0_wp) call append_flywheel_notes(report%fluctuation, &
        variant%model%motor%rotor > 0.0_wp, notes)
    end associate
    call append_string(notes, acceleration_note(variant%model))
    call append_load_notes(notes, variant%model, variant%mechanism)
  end subroutine sizing_notes

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
      "acts as one")
    call append_string(notes, "energy_of_cycle: greatest less least of the integral of "// &
      "(mean_torque - torque of the loads); fluctuation_without: without a flywheel; "// &
      "greatest_rate, least_rate: with it")
  end subroutine append_flywheel_notes

  !> The words in the columns `part`, `pin`, `quantity` and `unit`.
  pure function sizing_names(variant) result(lists)
    type(variant_results_t), intent(in) :: variant !! with its mechanism
    type(name_list_t) :: lists(4)

    type(unit_t) :: measure
    integer :: i

    lists(1) = joint_owners(variant)
    lists(1)%column = "part"
    do i = 1, size(variant%model%drives)
      call append_string(lists(1)%names, variant%model%drives(i)%subject%text)
    end do
    call append_string(lists(1)%names, flywheel_word)
    call append_string(lists(1)%names, motor_word)
    lists(2) = pin_names(variant)
    lists(2)%column = "pin"
    call append_string(lists(2)%names, no_pin)
    lists(3)%column = "quantity"
    lists(3)%names = trimmed_list(quantity_words)
    lists(4)%column = "unit"
    lists(4)%names = [string_t("deg"), string_t("1")]
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
        call add_failed_row(rows, [variant%model%shown_speed(speed)], found%error%text)
        return
      end if
      associate (at_speed => found%at_speed(speed))
        do s = 1, size(at_speed%sized)
          if (at_speed%sized(s)%drive > 0) then
            call add_drive(variant, layout, speed, at_speed%sized(s), rows)
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

    character(len=:), allocatable :: word, unit, part

    part = variant%model%drives(sized%drive)%subject%text
    if (sized%is_motor) part = motor_word
    word = "torque"
    unit = "moment"
    if (moves_along(variant%model%drives(sized%drive)%kind)) then
      word = "force"
      unit = "force"
    end if
    call put("peak_"//word, sized%peak, unit, sized%crank, sized%error)
    call put("rms_"//word, sized%rms, unit, 0.0_wp, sized%error)
    call put("mean_"//word, sized%mean, unit, 0.0_wp, sized%error)
    call put("rate", sized%rate, trim(merge("velocity", "rate    ", unit == "force")), 0.0_wp, &
      0.0_wp)
    call put("peak_power", sized%peak*sized%rate, "power", sized%crank, sized%error)
    call put("mean_power", sized%mean*sized%rate, "power", 0.0_wp, sized%error)

  contains

    subroutine put(quantity, value, quantity_unit, crank, error)
      character(len=*), intent(in) :: quantity, quantity_unit
      real(wp), intent(in) :: value, crank, error

      call put_row(variant, layout, speed, name_cell(part, column_width(layout, 2))//name_cell( &
        no_pin, column_width(layout, 3)), quantity, value, quantity_unit, crank, error, rows)
    end subroutine put

  end subroutine add_drive

  !> The rows of a joint.
  subroutine add_joint(variant, layout, speed, sized, rows)
    type(variant_results_t), intent(in) :: variant
    type(table_layout_t), intent(in) :: layout
    integer, intent(in) :: speed
    type(sized_t), intent(in) :: sized
    type(rows_t), intent(inout) :: rows

    call put("peak_force", sized%peak, "force", sized%crank, sized%error)
    call put("angle_at_peak", sized%angle, "deg", sized%crank, 0.0_wp)
    call put("rms_force", sized%rms, "force", 0.0_wp, sized%error)
    call put("mean_force", sized%mean, "force", 0.0_wp, sized%error)
    call put("cubic_mean_force", sized%cubic, "force", 0.0_wp, sized%error)

  contains

    subroutine put(quantity, value, quantity_unit, crank, error)
      character(len=*), intent(in) :: quantity, quantity_unit
      real(wp), intent(in) :: value, crank, error

      associate (joint => variant%found%sizing%joints(sized%joint))
        call put_row(variant, layout, speed, owner_cell(variant, joint, column_width(layout, 2))// &
          name_cell(variant%mechanism%pin_names(joint%pin)%text, column_width(layout, 3)), &
          quantity, value, quantity_unit, crank, error, rows)
      end associate
    end subroutine put

  end subroutine add_joint

  !> The rows of a flywheel.
  subroutine add_flywheel(variant, layout, speed, sizing, rows)
    type(variant_results_t), intent(in) :: variant
    type(table_layout_t), intent(in) :: layout
    integer, intent(in) :: speed
    type(sizing_t), intent(in) :: sizing
    type(rows_t), intent(inout) :: rows

    associate (flywheel => sizing%flywheel)
      call put("mean_torque", flywheel%mean_torque, "moment", 0.0_wp)
      call put("energy_of_cycle", flywheel%energy, "energy", 0.0_wp)
      if (flywheel%moves_alone) call put("fluctuation_without", flywheel%alone, "1", 0.0_wp, &
        sizing%alone_error)
      call put("flywheel", flywheel%inertia, "inertia", 0.0_wp)
      call put("fluctuation", flywheel%fluctuation, "1", 0.0_wp)
      call put("greatest_rate", flywheel%greatest, "rate", flywheel%at_greatest/degree)
      call put("least_rate", flywheel%least, "rate", flywheel%at_least/degree)
    end associate

  contains

    subroutine put(quantity, value, quantity_unit, crank, error)
      character(len=*), intent(in) :: quantity, quantity_unit
      real(wp), intent(in) :: value, crank
      real(wp), intent(in), optional :: error !! absent: that of the flywheel

      real(wp) :: shown

      shown = sizing%flywheel_error
      if (present(error)) shown = error

      call put_row(variant, layout, speed, name_cell(flywheel_word, column_width(layout, 2))// &
        name_cell(no_pin, column_width(layout, 3)), quantity, value, quantity_unit, crank, shown, &
        rows)
    end subroutine put

  end subroutine add_flywheel

  !> Appends a row: a value in the unit of the deck's results.
  subroutine put_row(variant, layout, speed, names, quantity, value, quantity_unit, crank, error, &
    rows)
    type(variant_results_t), intent(in) :: variant
    type(table_layout_t), intent(in) :: layout
    integer, intent(in) :: speed
    character(len=*), intent(in) :: names           !! cells of part and pin
    character(len=*), intent(in) :: quantity        !! one of `quantity_words`
    real(wp), intent(in) :: value                   !! [SI] or [deg]
    character(len=*), intent(in) :: quantity_unit   !! one of `unit_words`, `deg` or `1`
    real(wp), intent(in) :: crank, error
    type(rows_t), intent(inout) :: rows

    type(unit_t) :: measure
    character(len=column_width(layout, 6)) :: unit_cell
    real(wp) :: shown

    shown = value
    if (any(unit_words == quantity_unit)) then
      measure = table_unit(quantity_unit, variant%model%outputs)
      shown = from_si(value, measure)
      unit_cell = name_cell(measure%name, column_width(layout, 6))
    else
      unit_cell = name_cell(quantity_unit, column_width(layout, 6))
    end if
    call add_row(rows, cells(layout, 1, [variant%model%shown_speed(speed)])//names// &
      name_cell(quantity, column_width(layout, 4))//cells(layout, 5, [shown])//unit_cell// &
      cells(layout, 7, [crank, error]))
  end subroutine put_row

end module sizing_report
