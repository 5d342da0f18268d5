!> `motion.dat` of four-bars: the motion of the linkage in the angles of crank, coupler and
!! follower, with their branch.
module four_bar_motion_format
  use kinds, only: wp
  use linkage_notes, only: angle_note
  use models, only: model_t
  use motion_study, only: motion_result_t
  use natures, only: angle_nature, nature_t, of_effort, of_rate
  use report_cards, only: report_t
  use table_columns, only: cells, column_width, name_list_t, table_layout_t
  use tables, only: name_cell, real_cells
  use text, only: to_string, word_list
  use units, only: dimension_time
  use value_words, only: in_words
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: four_bar_columns, motion_words, motion_columns, motor_columns, motor_values, &
    crank_note, forces_note, four_bar_cells, four_bar_event

  !> What `columns=` adds. Forces are those of `reactions.dat`.
  character(len=*), parameter :: acceleration_columns = " alpha2,alpha3,alpha4:rad/s2", &
    power_columns = " motor_torque:moment motor_speed:rate motor_power,gear_loss,"// &
    "load_power:power", force_columns = " O2x,O2y,A2x,A2y,A3x,A3y,B3x,B3y,B4x,B4y,O4x,O4y:force"

  !> All columns, which a table has if its card asks for them.
  character(len=*), parameter :: always_columns = "time:time crank,theta3,theta4:deg "// &
    "omega2,omega3,omega4:rate torque:moment kinetic,potential,work,energy_error:energy "// &
    "closure:length branch:name", motion_columns = always_columns//acceleration_columns// &
    power_columns//force_columns

  !> Number of the column `branch`, the last that is always there.
  integer, parameter :: branch_column = 14

  character(len=*), parameter :: forces_note = "forces in global axes: A2 on link 2 at A, and "// &
    "so on; O2 and O4 of the ground on links 2 and 4"

contains

  !> The columns that a deck asks for.
  pure function four_bar_columns(asked) result(columns)
    type(report_t), intent(in) :: asked !! REPORT motion
    character(len=:), allocatable :: columns

    columns = always_columns
    if (asked%with_accelerations) columns = columns//acceleration_columns
    columns = columns//motor_columns(asked, angle_nature)
    if (asked%with_forces) columns = columns//force_columns
  end function four_bar_columns

  !> The columns of the motor and its gear.
  pure function motor_columns(asked, nature) result(columns)
    type(report_t), intent(in) :: asked !! REPORT motion
    type(nature_t), intent(in) :: nature !! of the first drive
    character(len=:), allocatable :: columns

    columns = ""
    if (asked%with_motor) columns = " motor_torque:"//trim(nature%words(of_effort))// &
      " motor_speed:"//trim(nature%words(of_rate))
    if (asked%with_power) then
      columns = columns//" motor_power,gear_loss,load_power:power"
    else if (asked%with_motor) then
      columns = columns//" motor_power:power"
    end if
  end function motor_columns

  !> Their values at an instant.
  pure function motor_values(asked, motion, instant) result(values)
    type(report_t), intent(in) :: asked         !! REPORT motion
    type(motion_result_t), intent(in) :: motion !! with details, if columns of the motor are asked
                                                !! for
    integer, intent(in) :: instant              !! number
    real(wp), allocatable :: values(:)

    allocate (values(0))
    if (asked%with_motor) values = motion%motor(:, instant)
    if (asked%with_power) then
      values = [values, motion%power(:, instant)]
    else if (asked%with_motor) then
      values = [values, motion%power(1, instant)]
    end if
  end function motor_values

  !> Which link is the crank, and where angles are measured.
  pure function crank_note(variant) result(note)
    type(variant_results_t), intent(in) :: variant !! with its mechanism
    character(len=:), allocatable :: note

    note = "crank, 2: link "//variant%mechanism%names(1)%text//"; "//angle_note(variant)// &
      "; angles continue past whole turns"
  end function crank_note

  !> The words in the column `branch`.
  pure function motion_words() result(lists)
    type(name_list_t) :: lists(1)

    lists(1)%column = "branch"
    lists(1)%names = word_list("open crossed")
  end function motion_words

  !> The row of an instant behind its time, in the columns of `columns=` too.
  subroutine four_bar_cells(model, asked, layout, motion, instant, extra, row)
    type(model_t), intent(in) :: model           !! with its first speed
    type(report_t), intent(in) :: asked          !! REPORT motion
    type(table_layout_t), intent(in) :: layout   !! of this table
    type(motion_result_t), intent(in) :: motion  !! of a linkage of one loop
    integer, intent(in) :: instant               !! number; the first has the numbers of the deck
    real(wp), intent(in) :: extra(:)             !! accelerations, powers, forces
    character(len=:), allocatable, intent(out) :: row

    associate (sample => motion%samples(instant), loop => motion%samples(instant)%loop)
      if (instant == 1) then
        row = real_cells([asked%start_angle])//cells(layout, 3, loop%angle(2:))// &
          real_cells([model%shown_start])
      else
        row = cells(layout, 2, [loop%angle, loop%speed(1)])
      end if
      row = row//cells(layout, 6, [loop%speed(2:), sample%torque, sample%kinetic, &
        sample%potential, sample%work, sample%energy_error, loop%closure])//name_cell(trim( &
        branch_of(loop%is_left)), column_width(layout, branch_column))//cells(layout, &
        branch_column + 1, extra)
    end associate
  end subroutine four_bar_cells

  pure function branch_of(is_open) result(name)
    logical, intent(in) :: is_open
    character(len=7) :: name

    name = merge("open   ", "crossed", is_open)
  end function branch_of

  !> What the log says of a point at which the crank turned back, or of a change point passed.
  pure function four_bar_event(model, motion, number) result(words)
    type(model_t), intent(in) :: model         !! its units
    type(motion_result_t), intent(in) :: motion !! of a linkage of one loop
    integer, intent(in) :: number               !! of the passage
    character(len=:), allocatable :: words

    associate (passage => motion%passages(number))
      words = "motion: at t="//in_words(passage%time, dimension_time, model%units, 12)//" the "
      if (passage%group > 0) then
        words = words//"crank turns back at "//to_string(passage%position, 12)// &
          " deg; the linkage changes from "//trim(branch_of(.not. passage%to_left))//" to "// &
          trim(branch_of(passage%to_left))
      else
        words = words//"linkage goes straight through a change point, the crank at "// &
          to_string(passage%position, 12)//" deg; it goes on as "//trim(branch_of(passage%to_left))
      end if
    end associate
  end function four_bar_event

end module four_bar_motion_format
