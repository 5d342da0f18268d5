!> `motion.dat`: forward dynamics, and its lines in the log.
module motion_report
  use kinds, only: long, wp
  use linkage_notes, only: angle_note
  use load_notes, only: potential_note, work_note
  use models, only: model_t, report_number
  use motion_pins_report, only: motion_pins_table_t, time_in_table
  use motion_study, only: motion_result_t, motion_tolerance, undetermined_message
  use motor_cards, only: is_geared, motor_t
  use number_text, only: number_width
  use report_cards, only: report_t
  use report_kinds, only: four_bars, report_kind_t
  use report_types, only: add_table, fit_columns, report_record_t, whole_table_t
  use table_columns, only: cells, column_width, name_list_t, table_factor, table_layout_t, &
    table_unit
  use table_rows, only: add_failed_row, add_row, rows_t
  use tables, only: decimal_cell, name_cell, real_cells
  use text, only: append_string, plural, string_t, to_string, word_list
  use text_buffer, only: append_text, buffer_text, text_buffer_t
  use units, only: from_si, unit_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_motion, motion_log, steps_line, implicit_words, most_listed, &
    power_columns, power_note, append_gear_notes

  !> What `columns=` adds. Forces are those of `reactions.dat`.
  character(len=*), parameter :: acceleration_columns = " alpha2,alpha3,alpha4:rad/s2", &
    power_columns = " motor_power,gear_loss,load_power:power", &
    force_columns = " O2x,O2y,A2x,A2y,A3x,A3y,B3x,B3y,B4x,B4y,O4x,O4y:force"

  !> All columns, which a table has if its card asks for them.
  character(len=*), parameter :: always_columns = "time:time crank,theta3,theta4:deg "// &
    "omega2,omega3,omega4:rate torque:moment kinetic,potential,work,energy_error:energy "// &
    "closure:length branch:name", motion_columns = always_columns//acceleration_columns// &
    power_columns//force_columns

  !> Number of the column `branch`, the last that is always there.
  integer, parameter :: branch_column = 14

  character(len=*), parameter :: power_note = "motor_power: of the motor at its shaft; "// &
    "gear_loss: in its gear; load_power: of all loads without a potential; motor_power - "// &
    "gear_loss + load_power is the rate of kinetic + potential"

  character(len=*), parameter :: branch_names = "open crossed"

  !> Turning points, or dead points passed, that the log lists at most.
  integer, parameter :: most_listed = 200

  character(len=*), parameter :: line_feed = achar(10)

  !> `motion.dat` of a four-bar.
  type, extends(whole_table_t) :: motion_table_t
  contains
    procedure, nopass :: find_notes => motion_notes
    procedure, nopass :: fit => fit_motion
    procedure, nopass :: add_all => add_motion
  end type motion_table_t

contains

  !> REPORT motion.
  subroutine describe_motion(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="motion", help="the motion under motor and loads", &
      pattern="REPORT motion crank= [speed=0] end= step= [columns=accelerations,forces,"// &
      "power] [pins=no|yes] [change_points=stop|through]", default="speed=0 pins=no", &
      studies="motion", masses=.true., linkages=four_bars)
    call add_table(report, motion_table_t(), "motion", motion_columns, words=motion_words())
    call add_table(report, motion_pins_table_t(), "motion_pins", "time:time pin:name x,y:length")
  end subroutine describe_motion

  !> The columns that a deck asks for.
  pure function motion_columns_of(model) result(columns)
    type(model_t), intent(in) :: model !! with REPORT motion
    character(len=:), allocatable :: columns

    associate (asked => model%reports(report_number(model, "motion")))
      columns = always_columns
      if (asked%with_accelerations) columns = columns//acceleration_columns
      if (asked%with_power) columns = columns//power_columns
      if (asked%with_forces) columns = columns//force_columns
    end associate
  end function motion_columns_of

  !> Meaning of the columns, initial energy, tolerance of the integration.
  pure subroutine motion_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its motion computed
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    type(unit_t) :: energy

    energy = table_unit("energy", variant%model%outputs)
    associate (motion => variant%found%motion)
      call append_string(notes, "crank, 2: link "//variant%mechanism%names(1)%text//"; "// &
        angle_note(variant)//"; angles continue past whole turns")
      call append_string(notes, &
        "torque: of the motor; "//potential_note)
      call append_string(notes, work_note//"; closure: the gap of the loop")
      call append_gear_notes(variant%model%motor, notes)
      associate (asked => variant%model%reports(report_number(variant%model, "motion")))
        if (asked%with_power) call append_string(notes, power_note)
        if (asked%with_forces) call append_string(notes, "forces in global axes: A2 on link 2 "// &
          "at A, and so on; O2 and O4 of the ground on links 2 and 4")
      end associate
      if (motion%count == 0) return
      call append_string(notes, "initial energy: "//to_string(from_si(motion%energy, energy))// &
        " "//energy%name//"; steps of order 8"//implicit_words(motion%implicit_steps)// &
        ", each to "//to_string(motion_tolerance)//" of a radian and of the speed")
    end associate
  end subroutine motion_notes

  !> What torque and energies are, if the motor has a gear or a rotor.
  pure subroutine append_gear_notes(motor, notes)
    type(motor_t), intent(in) :: motor                     !! of the deck
    type(string_t), allocatable, intent(inout) :: notes(:) !! to which a line is added

    if (is_geared(motor)) call append_string(notes, "torque: through the gear on the driven "// &
      "link, less what turns the rotor; kinetic: with that of the rotor; work: less what the "// &
      "gear takes")
  end subroutine append_gear_notes

  !> What the head of a table says of implicit steps, if there are some.
  pure function implicit_words(steps) result(words)
    integer(long), intent(in) :: steps !! of the implicit method
    character(len=:), allocatable :: words

    words = ""
    if (steps > 0) words = ", or 17 where the equations are stiff"
  end function implicit_words

  !> The words in the column `branch`.
  pure function motion_words() result(list)
    type(name_list_t) :: list(1)

    list(1)%column = "branch"
    list(1)%names = word_list(branch_names)
  end function motion_words

  !> Appends one row per instant, and a failed row if the motion ends before its end time.
  subroutine add_motion(variant, layout, rows)
    type(variant_results_t), intent(in) :: variant !! with its motion computed
    type(table_layout_t), intent(in) :: layout     !! of this table
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    character(len=number_width) :: crank, speed
    real(wp), allocatable :: extra(:)
    integer :: i, report

    associate (motion => variant%found%motion, model => variant%model)
      report = report_number(model, "motion")
      do i = 1, motion%count
        associate (sample => motion%samples(i))
          crank = cells(layout, 2, [sample%angle(1)])
          speed = cells(layout, 5, [sample%speed(1)])
          if (i == 1) then
            ! The numbers of the deck to the last digit.
            crank = real_cells([model%reports(report)%start_angle])
            speed = real_cells([model%shown_start])
          end if
          extra = extra_values(model%reports(report), motion, i)
          if (size(extra) > 0) then
            if (.not. motion%is_determined(i)) then
              call add_failed_row(rows, [time_in_table(model, i)], undetermined_message)
              cycle
            end if
          end if
          call add_row(rows, decimal_cell(time_in_table(model, i))//crank// &
            cells(layout, 3, sample%angle(2:))//speed//cells(layout, 6, [sample%speed(2:), &
            sample%torque, sample%kinetic, sample%potential, sample%work, sample%energy_error, &
            sample%closure])//name_cell(trim(branch_of(sample%is_open)), column_width(layout, &
            branch_column))//cells(layout, branch_column + 1, extra))
        end associate
      end do
      if (allocated(motion%error)) call add_failed_row(rows, [from_si(motion%last%time, &
        table_factor("time", variant%model%outputs))], motion%error%text)
    end associate
  end subroutine add_motion

  !> What `columns=` adds to the row of an instant.
  pure function extra_values(asked, motion, instant) result(values)
    type(report_t), intent(in) :: asked
    type(motion_result_t), intent(in) :: motion
    integer, intent(in) :: instant !! number
    real(wp), allocatable :: values(:)

    allocate (values(0))
    if (asked%with_accelerations) values = [values, motion%acceleration(:, instant)]
    if (asked%with_power) values = [values, motion%power(:, instant)]
    if (asked%with_forces) values = [values, motion%force(:, instant)]
  end function extra_values

  pure function branch_of(is_open) result(name)
    logical, intent(in) :: is_open
    character(len=7) :: name

    name = merge("open   ", "crossed", is_open)
  end function branch_of

  !> Log lines: one for each point where the crank turns back and each change point passed, then the
  !! numbers of steps and rows.
  pure function motion_log(motion) result(text)
    type(motion_result_t), intent(in) :: motion !! finished
    character(len=:), allocatable :: text

    type(text_buffer_t) :: buffer
    integer :: i

    do i = 1, min(most_listed, size(motion%turnings))
      associate (turning => motion%turnings(i))
        if (turning%is_change_point) then
          call append_text(buffer, "motion: at t="//to_string(turning%time, 12)// &
            " s the linkage goes straight through a change point, the crank at "// &
            to_string(turning%crank, 12)//" deg; it goes on as "//trim(branch_of( &
            turning%to_open))//line_feed)
          cycle
        end if
        call append_text(buffer, "motion: at t="//to_string(turning%time, 12)// &
          " s the crank turns back at "//to_string(turning%crank, 12)// &
          " deg; the linkage changes from "//trim(branch_of(.not. turning%to_open))//" to "// &
          trim(branch_of(turning%to_open))//line_feed)
      end associate
    end do
    if (size(motion%turnings) > most_listed) then
      call append_text(buffer, "motion: "//to_string(size(motion%turnings) - most_listed)// &
        " more of these"//line_feed)
    end if
    call append_text(buffer, steps_line(motion%steps, motion%implicit_steps, motion%count))
    text = buffer_text(buffer)
  end function motion_log

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

  !> The columns that the card asks for.
  pure subroutine fit_motion(model, columns)
    type(model_t), intent(in) :: model         !! with REPORT motion
    character(len=*), intent(inout) :: columns !! of the record

    columns = motion_columns_of(model)
    call fit_columns(model, columns)
  end subroutine fit_motion

end module motion_report
