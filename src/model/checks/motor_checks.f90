!> The table of a MOTOR card: torques of one or several lines over the speed of the motor.
module motor_checks
  use cards, only: card_t
  use diagnostics, only: add_error, diagnostics_t
  use models, only: model_t
  use table_cards, only: column_count, number_table_t, read_table
  use text, only: plural, to_string
  use units, only: dimension_moment, dimension_rate
  implicit none (type, external)
  private

  public :: find_motor_line

contains

  !> Reads the table of the motor, if it has one, and takes its line.
  !!
  !! Errors: those of `read_table`; a table of less than two rows; a line that it does not have.
  pure subroutine find_motor_line(cards, diagnostics, model)
    type(card_t), intent(in) :: cards(:)              !! (cards) all of the deck
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(model_t), intent(inout) :: model             !! has its MOTOR card; its line is set

    type(number_table_t) :: table
    integer, allocatable :: dimensions(:, :)
    integer :: columns
    logical :: fine

    associate (motor => model%motor)
      if (motor%table_word%line == 0) return
      ! One line at least, whatever the table has.
      columns = max(2, column_count(cards, motor%table_word%text))
      dimensions = spread(dimension_moment, 2, columns)
      dimensions(:, 1) = dimension_rate
      call read_table(cards, motor%table_word, "speed and torques", dimensions, diagnostics, &
        table, fine)
      if (.not. fine) return
      if (size(table%values, 2) < 2) then
        call add_error(diagnostics, motor%table_word, &
          "the line of a motor needs two rows at least; this table has "// &
          to_string(size(table%values, 2)))
        return
      end if
      if (motor%line > columns - 1) then
        call add_error(diagnostics, motor%line_word, "this table has "//plural(columns - 1, &
          "line")//", and there is no line "//motor%line_word%text, motor%table_word, &
          "the table is named here")
        return
      end if
      motor%speed = table%values(1, :)
      motor%line_torque = table%values(1 + motor%line, :)
    end associate
  end subroutine find_motor_line

end module motor_checks
