!> `motion.dat`: how the linkage moves by itself, and what the log tells of it.
module motion_report
  use forward_motions, only: motion_tolerance
  use kinematics_report, only: angle_note
  use mechanisms, only: mechanism_t
  use models, only: model_t
  use motion_study, only: motion_failed, motion_failure, motion_run_t
  use tables, only: append_column, append_real_columns, column_t, name_cell, name_column, &
    real_cells, real_column, table_t, write_failure, write_header, write_row
  use text, only: append_string, plural, string_t, to_string, word_list
  use text_buffer, only: append_text, buffer_text, text_buffer_t
  use units, only: coherent_unit, dimension_length, dimension_moment, dimension_time, from_si, &
    unit_t
  implicit none (type, external)
  private

  public :: write_motion, motion_log

  character(len=*), parameter :: branch_names = "open crossed"

  !> The log lists no more turning points than this.
  integer, parameter :: most_listed = 200

  character(len=*), parameter :: line_feed = achar(10)

contains

  !> One row an instant.
  subroutine write_motion(table, model, mechanism, motion)
    type(table_t), intent(inout) :: table
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(motion_run_t), intent(in) :: motion

    type(unit_t) :: length, moment, time
    type(column_t), allocatable :: columns(:)
    type(column_t) :: branch
    type(string_t), allocatable :: names(:)
    integer :: i

    length = coherent_unit(model%units, dimension_length)
    moment = coherent_unit(model%units, dimension_moment)
    time = coherent_unit(model%units, dimension_time)
    names = word_list(branch_names)
    branch = name_column("branch", names)
    call append_column(columns, real_column("time", time%name))
    call append_real_columns(columns, "crank theta3 theta4", "deg")
    call append_real_columns(columns, "omega2 omega3 omega4", "rad/s")
    call append_real_columns(columns, "torque kinetic potential work energy_error", moment%name)
    call append_column(columns, real_column("closure", length%name))
    call append_column(columns, branch)
    call write_header(table, model%title, remarks(mechanism, motion, moment), columns)
    do i = 1, motion%count
      associate (sample => motion%samples(i))
        call write_row(table, real_cells([from_si(sample%time, time), sample%angle, sample%speed, &
          from_si([sample%torque, sample%kinetic, sample%potential, sample%work, &
          sample%energy_error], moment), from_si(sample%closure, length)])// &
          name_cell(branch_of(sample%is_open), branch%width))
      end associate
    end do
    if (motion_failed(motion)) call write_failure(table, [from_si(motion%last%time, time)], &
      motion_failure(motion))
  end subroutine write_motion

  !> What the columns are.
  pure function remarks(mechanism, motion, moment) result(notes)
    type(mechanism_t), intent(in) :: mechanism
    type(motion_run_t), intent(in) :: motion
    type(unit_t), intent(in) :: moment
    type(string_t), allocatable :: notes(:)

    call append_string(notes, "crank, 2: link "//mechanism%names(1)%text//"; "// &
      angle_note(mechanism)//"; angles go on over whole turns")
    call append_string(notes, &
      "torque: of the motor; potential: of GRAVITY, FORCE and TORQUE, of crank and coupler "// &
      "from the "//"crank's ground pivot, of the follower from its own, of torques from angle 0")
    call append_string(notes, &
      "work: of the motor, less what LOAD takes, since the start; energy_error: kinetic + "// &
      "potential - "//"work, less the initial energy; closure: by how much the loop is open")
    if (motion%count == 0) return
    call append_string(notes, "initial energy: "//to_string(from_si(motion%energy, moment))//" "// &
      moment%name//"; steps of order 8, each to "//to_string(motion_tolerance)// &
      " of a radian and of the speed")
  end function remarks

  pure function branch_of(is_open) result(name)
    logical, intent(in) :: is_open
    character(len=:), allocatable :: name

    name = trim(merge("open   ", "crossed", is_open))
  end function branch_of

  !> Where the crank turns back, a line each, and how the motion was found.
  pure function motion_log(motion) result(text)
    type(motion_run_t), intent(in) :: motion
    character(len=:), allocatable :: text

    type(text_buffer_t) :: buffer
    integer :: i

    do i = 1, min(most_listed, size(motion%turnings))
      associate (turning => motion%turnings(i))
        call append_text(buffer, "motion: at t="//to_string(turning%time, 12)// &
          " s the crank turns back at "//to_string(turning%crank, 12)// &
          " deg; the linkage goes over from "//branch_of(.not. turning%to_open)//" to "// &
          branch_of(turning%to_open)//line_feed)
      end associate
    end do
    if (size(motion%turnings) > most_listed) then
      call append_text(buffer, "motion: "//to_string(size(motion%turnings) - most_listed)// &
        " more of these"//line_feed)
    end if
    call append_text(buffer, "motion: "//to_string(motion%steps)//" steps, "//plural(motion%count, &
      "row")//line_feed)
    text = buffer_text(buffer)
  end function motion_log

end module motion_report
