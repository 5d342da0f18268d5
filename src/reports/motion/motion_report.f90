!> `motion.dat`: forward dynamics, and its lines in the log. The table of a four-bar has a format of
!! its own, `four_bar_motion_format`.
module motion_report
  use coordinate_columns, only: columns_in, unit_names
  use drive_positions, only: shown_crank, unit_of_drive
  use four_bar_motion_format, only: crank_note, forces_note, four_bar_cells, four_bar_columns, &
    four_bar_event, motion_columns, motion_words, motor_columns, motor_values
  use kinds, only: long, wp
  use load_notes, only: potential_note, work_note
  use models, only: is_of_four_bar, model_t, nature_of_positions, report_number
  use motion_coordinates_report, only: motion_coordinates_table_t
  use motion_forces_report, only: motion_forces_table_t
  use motion_pins_report, only: add_early_end, motion_pins_table_t, time_in_table
  use motion_study, only: free_drives, motion_result_t, motion_tolerance, undetermined_message
  use motor_cards, only: is_geared, motor_t
  use natures, only: are_alike, nature_t, of_acceleration, of_effort, of_rate, of_value
  use plan_words, only: group_names
  use report_cards, only: report_t
  use four_bar_reactions, only: pin_forces_of
  use report_kinds, only: four_bars, other_linkages, report_kind_t
  use report_types, only: add_table, fit_columns, report_record_t, table_plan_t, whole_table_t
  use table_columns, only: cells, table_factor, table_layout_t, table_unit
  use table_rows, only: add_failed_row, add_row, rows_t
  use tables, only: real_cells
  use text, only: append_string, plural, string_t, to_string
  use text_buffer, only: append_text, buffer_text, text_buffer_t
  use units, only: dimension_time, from_si, unit_t
  use value_words, only: in_words
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_motion, describe_linkage_motion, motion_log

  character(len=*), parameter :: motor_note = "motor_torque, motor_speed, motor_power: of the "// &
    "motor at its own shaft, before its gear"
  character(len=*), parameter :: power_note = "motor_power: of the motor at its shaft; "// &
    "gear_loss: in its gear; load_power: of all loads without a potential; motor_power - "// &
    "gear_loss + load_power is the rate of kinetic + potential"

  !> Dead points and change points passed that the log lists at most.
  integer, parameter :: most_listed = 200

  character(len=*), parameter :: line_feed = achar(10), &
    default = "speed=0 pins=no coordinates=no", &
    pattern = "REPORT motion crank= [speed=0] end= step= [columns=accelerations,forces,"// &
    "power,motor] [pins=no|yes] [coordinates=no|yes] [change_points=stop|through] [format=]"

  !> `motion.dat`.
  type, extends(whole_table_t) :: motion_table_t
  contains
    procedure, nopass :: find_notes => motion_notes
    procedure, nopass :: plan => plan_motion
    procedure, nopass :: fit => fit_motion
    procedure, nopass :: add_all => add_motion
  end type motion_table_t

contains

  !> REPORT motion of four-bars.
  subroutine describe_motion(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="motion", help="the motion under motor and loads", &
      pattern=pattern, default=default, studies="motion", masses=.true., &
      weighs=.true., linkages=four_bars)
    call add_table(report, motion_table_t(), "motion", motion_columns, words=motion_words())
    call add_table(report, motion_pins_table_t(), "motion_pins", "time:time pin:name x,y:length")
    call add_table(report, motion_coordinates_table_t(), "motion_coordinates", "time:time "// &
      "coordinate:name value,rate,acceleration,effort:see_head power:power")
  end subroutine describe_motion

  !> REPORT motion of other linkages.
  subroutine describe_linkage_motion(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="motion", help="of other linkages: their motion", &
      pattern=pattern, default=default, studies="motion", masses=.true., weighs=.true., &
      linkages=other_linkages)
    call add_table(report, motion_table_t(), "motion", "time:time position*:deg "// &
      "rate*:rate torque:moment kinetic,potential,work,energy_error:energy "// &
      "acceleration*:rad/s2 motor_torque:moment motor_speed:rate motor_power,gear_loss,"// &
      "load_power:power")
    call add_table(report, motion_pins_table_t(), "motion_pins", "time:time pin:name x,y:length")
    call add_table(report, motion_coordinates_table_t(), "motion_coordinates", "time:time "// &
      "coordinate:name value,rate,acceleration,effort:see_head power:power")
    call add_table(report, motion_forces_table_t(), "motion_forces", "time:time pin,"// &
      "link:name fx,fy:force moment:moment")
  end subroutine describe_linkage_motion

  !> Meaning of the columns, the initial energy and the tolerance of the integration.
  pure subroutine motion_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its motion computed
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    type(unit_t) :: energy

    energy = table_unit("energy", variant%model%outputs)
    associate (asked => variant%model%reports(report_number(variant%model, "motion")), &
        four_bar => is_of_four_bar(variant%model, "motion"), motion => variant%found%motion)
      if (four_bar) then
        call append_string(notes, crank_note(variant))
        call append_string(notes, torque_words(variant%model%motor, "of the motor", &
          "of the motor on the crank")//"; "//potential_note)
        call append_string(notes, work_note//"; closure: the gap of the loop")
      else
        call append_coordinate_notes(variant%model, notes)
        call append_string(notes, work_note)
      end if
      call append_gear_notes(variant%model%motor, asked%with_motor, notes)
      if (asked%with_motor) call append_string(notes, motor_note)
      if (asked%with_power) call append_string(notes, power_note)
      if (four_bar .and. asked%with_forces) call append_string(notes, forces_note)
      if (motion%count > 0) call append_string(notes, "initial energy: "// &
        to_string(from_si(motion%energy, energy))//" "//energy%name//"; steps of order 8"// &
        implicit_words(motion%implicit_steps)//", each to "//to_string(motion_tolerance)// &
        trim(merge(" of a radian and of the speed", "                             ", four_bar)))
    end associate
  end subroutine motion_notes

  !> The coordinates, with their units if these differ, and the torque.
  pure subroutine append_coordinate_notes(model, notes)
    type(model_t), intent(in) :: model                     !! with its drives
    type(string_t), allocatable, intent(inout) :: notes(:) !! to which lines are added

    integer, allocatable :: free(:)
    type(nature_t) :: nature
    character(len=:), allocatable :: line
    logical :: mixed
    integer :: k

    free = free_drives(model%drives%is_free)
    mixed = .not. are_alike(model%drives(free)%nature)
    line = "coordinates:"
    do k = 1, size(free)
      if (k > 1) line = line//","
      line = line//" "//to_string(k)//" drive "//model%drives(free(k))%subject%text
      nature = model%drives(free(k))%nature
      if (mixed) line = line//" in "//unit_names(nature%words([of_value, of_rate]), model%outputs, &
        " and ")
    end do
    call append_string(notes, line//"; angles continue past whole turns")
    line = ""
    nature = nature_of_positions(model)
    if (mixed) line = " in "//unit_names([nature%words(of_effort)], model%outputs)
    line = "of the motor on the first drive"//line
    call append_string(notes, torque_words(model%motor, line, line)//"; "//potential_note)
  end subroutine append_coordinate_notes

  !> `torque: of the motor on the crank, behind its gear and less what turns its rotor`
  pure function torque_words(motor, directly, geared) result(words)
    type(motor_t), intent(in) :: motor           !! of the deck
    character(len=*), intent(in) :: directly     !! whose torque it is
    character(len=*), intent(in) :: geared       !! whose with a gear or a rotor
    character(len=:), allocatable :: words

    words = "torque: "//directly
    if (.not. is_geared(motor)) return
    words = "torque: "//geared//","
    if (has_gear(motor)) words = words//" behind its gear"
    if (has_gear(motor) .and. motor%rotor > 0.0_wp) words = words//" and"
    if (motor%rotor > 0.0_wp) words = words//" less what turns its rotor"
  end function torque_words

  !> Where the energies of a rotor and of a gear are, and the torque of the motor itself.
  pure subroutine append_gear_notes(motor, with_motor, notes)
    type(motor_t), intent(in) :: motor                     !! of the deck
    logical, intent(in) :: with_motor                      !! the table has its own torque
    type(string_t), allocatable, intent(inout) :: notes(:) !! to which lines are added

    if (.not. is_geared(motor)) return
    call append_string(notes, "kinetic: with that of the rotor; work: less what the gear takes")
    if (.not. with_motor) call append_string(notes, "torque and speed at the shaft of the "// &
      "motor: REPORT motion columns=motor")
  end subroutine append_gear_notes

  !> Whether the motor turns otherwise than the driven link, or loses power on the way to it.
  pure function has_gear(motor) result(has)
    type(motor_t), intent(in) :: motor !! of the deck
    logical :: has

    has = abs(motor%ratio - 1.0_wp) > 0.0_wp .or. motor%efficiency < 1.0_wp
  end function has_gear

  !> What the head of a table says of implicit steps, if there are some.
  pure function implicit_words(steps) result(words)
    integer(long), intent(in) :: steps !! of the implicit method
    character(len=:), allocatable :: words

    words = ""
    if (steps > 0) words = ", or 17 where the equations are stiff"
  end function implicit_words

  !> A column for every drive that is free.
  subroutine plan_motion(variant, plan)
    type(variant_results_t), intent(in) :: variant !! with its results
    type(table_plan_t), intent(inout) :: plan      !! of the table

    plan%count = size(free_drives(variant%model%drives%is_free))
  end subroutine plan_motion

  !> The columns that the card asks for.
  pure subroutine fit_motion(model, columns)
    type(model_t), intent(in) :: model         !! with REPORT motion
    character(len=*), intent(inout) :: columns !! of the record

    columns = motion_columns_of(model)
    call fit_columns(model, columns)
  end subroutine fit_motion

  !> The columns of `motion.dat`, in the units of the coordinates; mixed ones in the units of the
  !! deck, see its head.
  pure function motion_columns_of(model) result(columns)
    type(model_t), intent(in) :: model !! with REPORT motion and its drives
    character(len=:), allocatable :: columns

    type(nature_t), allocatable :: natures(:)

    if (is_of_four_bar(model, "motion")) then
      columns = four_bar_columns(model%reports(report_number(model, "motion")))
      return
    end if
    natures = model%drives(free_drives(model%drives%is_free))%nature
    columns = "time:time "//columns_in(natures, "position* rate* torque", [of_value, of_rate, &
      of_effort])//" kinetic,potential,work,energy_error:energy"
    associate (asked => model%reports(report_number(model, "motion")))
      if (asked%with_accelerations) columns = columns//" "//columns_in(natures, &
        "acceleration*", [of_acceleration])
      columns = columns//motor_columns(asked, nature_of_positions(model))
    end associate
  end function motion_columns_of

  !> Appends one row per instant, and a failed row if the motion ends before its end time.
  subroutine add_motion(variant, layout, rows)
    type(variant_results_t), intent(in) :: variant !! with its motion computed
    type(table_layout_t), intent(in) :: layout     !! of this table
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    character(len=:), allocatable :: row
    integer :: i

    associate (motion => variant%found%motion, model => variant%model, &
        asked => variant%model%reports(report_number(variant%model, "motion")))
      do i = 1, motion%count
        if (.not. has_details(asked, motion, i)) then
          call add_failed_row(rows, [time_in_table(model, i)], undetermined_message)
          cycle
        end if
        if (is_of_four_bar(model, "motion")) then
          call four_bar_cells(model, asked, layout, motion, i, extra_values(variant, asked, i), row)
        else
          call general_cells(model, asked, layout, motion, i, row)
        end if
        call add_row(rows, real_cells([time_in_table(model, i)])//row)
      end do
    end associate
    call add_early_end(variant, rows)
  end subroutine add_motion

  !> Whether an instant has the values that `columns=` adds to its row.
  pure function has_details(asked, motion, instant) result(has)
    type(report_t), intent(in) :: asked
    type(motion_result_t), intent(in) :: motion
    integer, intent(in) :: instant !! number
    logical :: has

    has = .true.
    if (allocated(motion%is_determined)) has = motion%is_determined(instant)
    ! Forces of linkages that are no four-bars have a table of their own.
    if (asked%kind%linkages /= four_bars) has = has .or. .not. (asked%with_accelerations .or. &
      asked%with_power .or. asked%with_motor)
  end function has_details

  !> What `columns=` adds to the row of an instant of a four-bar: accelerations, powers, forces.
  pure function extra_values(variant, asked, instant) result(values)
    type(variant_results_t), intent(in) :: variant !! with its motion
    type(report_t), intent(in) :: asked
    integer, intent(in) :: instant !! number
    real(wp), allocatable :: values(:)

    allocate (values(0))
    associate (motion => variant%found%motion)
      if (asked%with_accelerations) values = [values, motion%acceleration(:, instant)]
      values = [values, motor_values(asked, motion, instant)]
      if (asked%with_forces) values = [values, pin_forces_of(variant%mechanism%four_bar, &
        motion%joints, motion%force(:, :, instant))]
    end associate
  end function extra_values

  !> The row of an instant behind its time, in the coordinates of the free drives.
  subroutine general_cells(model, asked, layout, motion, instant, row)
    type(model_t), intent(in) :: model
    type(report_t), intent(in) :: asked
    type(table_layout_t), intent(in) :: layout
    type(motion_result_t), intent(in) :: motion
    integer, intent(in) :: instant !! number
    character(len=:), allocatable, intent(out) :: row

    real(wp), allocatable :: position(:), rate(:), extra(:)
    real(wp) :: torque
    type(nature_t), allocatable :: natures(:)
    type(nature_t) :: of_motor
    integer :: k

    natures = model%drives(free_drives(model%drives%is_free))%nature
    associate (sample => motion%samples(instant))
      position = sample%position
      rate = sample%rate
      torque = sample%torque
      allocate (extra(0))
      if (asked%with_accelerations) extra = motion%acceleration(:size(natures), instant)
      if (.not. are_alike(natures)) then
        associate (outputs => model%outputs)
          do k = 1, size(natures)
            position(k) = from_si(position(k), table_factor(natures(k)%words(of_value), outputs))
            rate(k) = from_si(rate(k), table_factor(natures(k)%words(of_rate), outputs))
            if (asked%with_accelerations) extra(k) = from_si(extra(k), &
              table_factor(natures(k)%words(of_acceleration), outputs))
          end do
          of_motor = nature_of_positions(model)
          torque = from_si(torque, table_factor(of_motor%words(of_effort), outputs))
        end associate
      end if
      extra = [extra, motor_values(asked, motion, instant)]
      row = cells(layout, 2, [position, rate, torque, sample%kinetic, sample%potential, &
        sample%work, sample%energy_error, extra])
    end associate
  end subroutine general_cells

  !> Log lines: one for each dead point and change point that was passed, then the numbers of steps
  !! and rows.
  pure function motion_log(variant) result(text)
    type(variant_results_t), intent(in) :: variant !! with its motion
    character(len=:), allocatable :: text

    type(text_buffer_t) :: buffer
    integer :: i

    associate (motion => variant%found%motion)
      if (allocated(motion%passages)) then
        do i = 1, min(most_listed, size(motion%passages))
          if (is_of_four_bar(variant%model, "motion")) then
            call append_text(buffer, four_bar_event(variant%model, motion, i)//line_feed)
          else
            call append_text(buffer, event_words(variant, i)//line_feed)
          end if
        end do
        if (size(motion%passages) > most_listed) call append_text(buffer, "motion: "// &
          to_string(size(motion%passages) - most_listed)//" more of these"//line_feed)
      end if
      call append_text(buffer, steps_line(motion%steps, motion%implicit_steps, motion%count))
    end associate
    text = buffer_text(buffer)
  end function motion_log

  !> What the log says of a dead point that was passed.
  pure function event_words(variant, number) result(words)
    type(variant_results_t), intent(in) :: variant
    integer, intent(in) :: number !! of the passage
    character(len=:), allocatable :: words

    associate (mechanism => variant%mechanism, passage => variant%found%motion%passages(number))
      words = "motion: at t="//in_words(passage%time, dimension_time, variant%model%units, 12)// &
        ", the first drive at "// &
        to_string(shown_crank(variant, passage%position), 12)//" "//unit_of_drive(variant)
      if (passage%group == 0) then
        words = words//", the linkage goes straight through a change point"
        return
      end if
      words = words//", the linkage passes a dead point of "//group_names(mechanism, &
        mechanism%linkage%groups(passage%group))//" and goes on on its other branch"
    end associate
  end function event_words

  !> A line of the log: steps of the methods of integration, and rows.
  pure function steps_line(steps, implicit_steps, rows) result(line)
    integer(long), intent(in) :: steps          !! of both methods
    integer(long), intent(in) :: implicit_steps !! of the implicit one
    integer, intent(in) :: rows                 !! of the table, without a failed one
    character(len=:), allocatable :: line

    line = "motion: "//to_string(steps)//" steps"
    if (implicit_steps > 0) line = line//", "//to_string(steps - implicit_steps)// &
      " explicit ones of order 8 and "//to_string(implicit_steps)// &
      " implicit ones of order 17, where the equations are stiff"
    line = line//", "//plural(rows, "row")//line_feed
  end function steps_line

end module motion_report
