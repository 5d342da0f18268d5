!> `motion.dat` of linkages that are no four-bars, and its line in the log.
module linkage_motion_report
  use drive_cards, only: moves_along
  use kinds, only: wp
  use linkage_motion_study, only: free_drives, linkage_motion_tolerance
  use load_notes, only: potential_note, work_note
  use models, only: drives_length, model_t, report_number
  use motion_forces_report, only: motion_forces_table_t
  use motion_pins_report, only: motion_pins_table_t, time_in_table
  use motion_report, only: append_gear_notes, implicit_words, most_listed, power_columns, &
    power_note, steps_line
  use motion_study, only: undetermined_message
  use plan_words, only: group_names
  use report_kinds, only: other_linkages, report_kind_t
  use report_types, only: add_table, fit_columns, report_record_t, table_plan_t, whole_table_t
  use table_columns, only: cells, table_factor, table_layout_t, table_unit
  use table_rows, only: add_failed_row, add_row, rows_t
  use tables, only: decimal_cell
  use text, only: append_string, string_t, to_string
  use text_buffer, only: append_text, buffer_text, text_buffer_t
  use units, only: from_si, unit_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_linkage_motion, linkage_motion_log

  character(len=*), parameter :: line_feed = achar(10)

  !> `motion.dat` of other linkages.
  type, extends(whole_table_t) :: linkage_motion_table_t
  contains
    procedure, nopass :: find_notes => linkage_motion_notes
    procedure, nopass :: plan => plan_linkage_motion
    procedure, nopass :: fit => fit_linkage_motion
    procedure, nopass :: add_all => add_linkage_motion
  end type linkage_motion_table_t

contains

  !> REPORT motion of linkages that are no four-bars.
  subroutine describe_linkage_motion(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="motion", help="of other linkages: the motion under "// &
      "motor and loads", pattern="REPORT motion crank= [speed=0] end= step= "// &
      "[columns=accelerations,forces,power] [pins=no|yes] [change_points=stop|through]", &
      default="speed=0 pins=no", studies="motion", masses=.true., linkages=other_linkages)
    call add_table(report, linkage_motion_table_t(), "motion", "time:time position*:deg "// &
      "rate*:rate torque:moment kinetic,potential,work,energy_error:energy "// &
      "acceleration*:rad/s2 motor_power,gear_loss,load_power:power")
    call add_table(report, motion_pins_table_t(), "motion_pins", "time:time pin:name x,y:length")
    call add_table(report, motion_forces_table_t(), "motion_forces", "time:time pin,"// &
      "link:name fx,fy:force moment:moment")
  end subroutine describe_linkage_motion

  !> The coordinates, with their units if these differ, the energies, the initial energy and the
  !! tolerance.
  pure subroutine linkage_motion_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its motion computed
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    integer, allocatable :: free(:)
    type(unit_t) :: energy, of_motor
    character(len=:), allocatable :: line
    logical :: mixed
    integer :: k

    free = free_drives(variant%model%drives%is_free)
    mixed = are_mixed(variant%model, free)
    line = "coordinates:"
    do k = 1, size(free)
      if (k > 1) line = line//","
      line = line//" "//to_string(k)//" drive "//variant%model%drives(free(k))%subject%text
      if (mixed) line = line//unit_words(variant%model, free(k))
    end do
    call append_string(notes, line//"; angles continue past whole turns")
    line = ""
    if (mixed) then
      of_motor = table_unit("moment", variant%model%outputs)
      if (moves_along(variant%model%drives(1)%kind)) of_motor = table_unit("force", &
        variant%model%outputs)
      line = " in "//of_motor%name
    end if
    call append_string(notes, "torque: of the motor on the first drive"//line// &
      "; "//potential_note)
    call append_string(notes, work_note)
    call append_gear_notes(variant%model%motor, notes)
    if (variant%model%reports(report_number(variant%model, "motion"))%with_power) &
      call append_string(notes, power_note)
    energy = table_unit("energy", variant%model%outputs)
    if (variant%found%linkage_motion%count > 0) call append_string(notes, "initial energy: "// &
      to_string(from_si(variant%found%linkage_motion%energy, energy))//" "//energy%name// &
      "; steps of order 8"//implicit_words(variant%found%linkage_motion%implicit_steps)// &
      ", each to "//to_string(linkage_motion_tolerance))
  end subroutine linkage_motion_notes

  !> Whether some coordinates are angles and others lengths.
  pure function are_mixed(model, free) result(mixed)
    type(model_t), intent(in) :: model
    integer, intent(in) :: free(:) !! numbers of the free drives
    logical :: mixed

    mixed = any(moves_along(model%drives(free)%kind)) .and. .not. all(moves_along(model%drives( &
      free)%kind))
  end function are_mixed

  !> ` in deg and rad/s`: the units of the position and the rate of a drive.
  pure function unit_words(model, drive) result(words)
    type(model_t), intent(in) :: model
    integer, intent(in) :: drive !! number
    character(len=:), allocatable :: words

    type(unit_t) :: length, velocity

    words = " in deg and "//model%outputs%rate%name
    if (.not. moves_along(model%drives(drive)%kind)) return
    length = table_unit("length", model%outputs)
    velocity = table_unit("velocity", model%outputs)
    words = " in "//length%name//" and "//velocity%name
  end function unit_words

  !> The columns of `motion.dat`, in the units of the coordinates; mixed ones in the units of the
  !! deck, see its head.
  pure function linkage_motion_columns(model) result(columns)
    type(model_t), intent(in) :: model !! with its drives
    character(len=:), allocatable :: columns

    integer, allocatable :: free(:)

    free = free_drives(model%drives%is_free)
    if (all(moves_along(model%drives(free)%kind))) then
      columns = "time:time position*:length rate*:velocity torque:force "
    else if (any(moves_along(model%drives(free)%kind))) then
      columns = "time:time position*,rate*,torque:see_head "
    else
      columns = "time:time position*:deg rate*:rate torque:moment "
    end if
    columns = columns//"kinetic,potential,work,energy_error:energy"
    associate (asked => model%reports(report_number(model, "motion")))
      if (asked%with_accelerations) then
        if (all(moves_along(model%drives(free)%kind))) then
          columns = columns//" acceleration*:acceleration"
        else if (any(moves_along(model%drives(free)%kind))) then
          columns = columns//" acceleration*:see_head"
        else
          columns = columns//" acceleration*:rad/s2"
        end if
      end if
      if (asked%with_power) columns = columns//power_columns
    end associate
  end function linkage_motion_columns

  !> Appends one row per instant, and a failed row if the motion ends before its end time.
  subroutine add_linkage_motion(variant, layout, rows)
    type(variant_results_t), intent(in) :: variant !! with its motion computed
    type(table_layout_t), intent(in) :: layout     !! of this table
    type(rows_t), intent(inout) :: rows            !! to which they are appended

    real(wp), allocatable :: position(:), rate(:), extra(:)
    real(wp) :: torque
    integer, allocatable :: free(:)
    logical :: mixed
    integer :: i, k

    free = free_drives(variant%model%drives%is_free)
    associate (motion => variant%found%linkage_motion, model => variant%model, &
        asked => variant%model%reports(report_number(variant%model, "motion")))
      mixed = are_mixed(model, free)
      do i = 1, motion%count
        associate (sample => motion%samples(i))
          position = sample%position
          rate = sample%rate
          torque = sample%torque
          allocate (extra(0))
          if (asked%with_accelerations) extra = motion%acceleration(:, i)
          if (mixed) then
            do k = 1, size(free)
              if (moves_along(model%drives(free(k))%kind)) then
                position(k) = from_si(position(k), table_factor("length", model%outputs))
                rate(k) = from_si(rate(k), table_factor("velocity", model%outputs))
                if (asked%with_accelerations) extra(k) = from_si(extra(k), &
                  table_factor("acceleration", model%outputs))
              else
                rate(k) = from_si(rate(k), model%outputs%rate)
              end if
            end do
            if (moves_along(model%drives(1)%kind)) then
              torque = from_si(torque, table_factor("force", model%outputs))
            else
              torque = from_si(torque, table_factor("moment", model%outputs))
            end if
          end if
          if (asked%with_power) extra = [extra, motion%power(:, i)]
          if (.not. has_details(i)) then
            call add_failed_row(rows, [time_in_table(model, i)], undetermined_message)
          else
            call add_row(rows, decimal_cell(time_in_table(model, i))//cells(layout, 2, [position, &
              rate, torque, sample%kinetic, sample%potential, sample%work, sample%energy_error, &
              extra]))
          end if
          deallocate (extra)
        end associate
      end do
      if (allocated(motion%error)) call add_failed_row(rows, [from_si(motion%last%time, &
        table_factor("time", model%outputs))], motion%error%text)
    end associate

  contains

    !> Whether an instant has the values that `columns=` adds to its row.
    pure function has_details(instant) result(has)
      integer, intent(in) :: instant
      logical :: has

      has = .true.
      associate (asked => variant%model%reports(report_number(variant%model, "motion")))
        if (asked%with_accelerations .or. asked%with_power) has = &
          variant%found%linkage_motion%is_determined(instant)
      end associate
    end function has_details

  end subroutine add_linkage_motion

  !> Log lines: one for each dead point that was passed, then the numbers of steps and rows.
  pure function linkage_motion_log(variant) result(text)
    type(variant_results_t), intent(in) :: variant !! with its motion
    character(len=:), allocatable :: text

    type(text_buffer_t) :: buffer
    type(unit_t) :: length
    character(len=:), allocatable :: place
    integer :: i

    length = table_unit("length", variant%model%outputs)
    associate (motion => variant%found%linkage_motion, mechanism => variant%mechanism)
      if (allocated(motion%passages)) then
        do i = 1, min(most_listed, size(motion%passages))
          associate (passage => motion%passages(i))
            place = to_string(passage%position, 12)//" deg"
            if (drives_length(variant%model)) place = to_string(from_si(passage%position, &
              length), 12)//" "//length%name
            call append_text(buffer, "motion: at t="//to_string(passage%time, 12)// &
              " s, the first drive at "//place//", the linkage passes a dead point of "// &
              group_names(mechanism, mechanism%linkage%groups(passage%group))// &
              " and goes on on its other branch"//line_feed)
          end associate
        end do
        if (size(motion%passages) > most_listed) call append_text(buffer, "motion: "// &
          to_string(size(motion%passages) - most_listed)//" more of these"//line_feed)
      end if
      call append_text(buffer, steps_line(motion%steps, motion%implicit_steps, motion%count))
    end associate
    text = buffer_text(buffer)
  end function linkage_motion_log

  !> A column for every drive that is free.
  subroutine plan_linkage_motion(variant, plan)
    type(variant_results_t), intent(in) :: variant !! with its results
    type(table_plan_t), intent(inout) :: plan      !! of the table

    plan%count = size(free_drives(variant%model%drives%is_free))
  end subroutine plan_linkage_motion

  !> The columns that the card asks for, in the units of the drives.
  pure subroutine fit_linkage_motion(model, columns)
    type(model_t), intent(in) :: model         !! with REPORT motion
    character(len=*), intent(inout) :: columns !! of the record

    columns = linkage_motion_columns(model)
    call fit_columns(model, columns)
  end subroutine fit_linkage_motion

end module linkage_motion_report
