!> `kinematics.dat`: how the links move.
module kinematics_report
  use constants, only: degree
  use kinds, only: wp
  use kinematic_coefficients, only: angular_acceleration, angular_velocity, kinematic_coefficients_t
  use load_notes, only: acceleration_note
  use mechanisms, only: mechanism_t
  use models, only: model_t
  use poses, only: body_angle, pose_t, transmission_angle
  use positions, only: positions_t
  use tables, only: append_column, append_real_columns, column_t, real_cells, real_column, &
    table_t, write_failure, write_gap, write_header, write_row
  use text, only: append_string, string_t
  use units, only: coherent_unit, dimension_length, from_si, unit_t
  implicit none (type, external)
  private

  public :: write_kinematics, angle_note

contains

  !> One row a position, one block a speed.
  subroutine write_kinematics(table, model, mechanism, positions, notes)
    type(table_t), intent(inout) :: table
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(positions_t), intent(in) :: positions
    type(string_t), intent(in) :: notes(:) !! on the linkage as a whole

    type(unit_t) :: length
    type(string_t), allocatable :: remarks(:)
    integer :: i, k

    length = coherent_unit(model%units, dimension_length)
    remarks = notes
    call append_string(remarks, angle_note(mechanism))
    call append_string(remarks, "A: pin "//mechanism%pin_names(2)%text//"; B: pin "// &
      mechanism%pin_names(3)%text)
    call append_string(remarks, acceleration_note(model))
    call write_header(table, model%title, remarks, columns(length))
    do k = 1, size(model%speed%value)
      if (k > 1) call write_gap(table, 2)
      do i = 1, size(positions%crank)
        associate (state => positions%states(positions%state(i)))
          if (allocated(state%error)) then
            call write_failure(table, [model%speed%value(k), positions%crank(i)], &
              state%error%message)
          else
            call write_row(table, real_cells([model%speed%value(k), positions%crank(i), &
              row_of(mechanism, state%pose, state%coefficients, model%speed%value(k), &
              model%acceleration, length)]))
          end if
        end associate
      end do
    end do
  end subroutine write_kinematics

  !> Which link's angle theta3 and theta4 are.
  pure function angle_note(mechanism) result(note)
    type(mechanism_t), intent(in) :: mechanism
    character(len=:), allocatable :: note

    note = "3: link "//mechanism%names(2)%text//", angle from "//mechanism%pin_names(2)%text// &
      " to "//mechanism%pin_names(3)%text//"; 4: link "//mechanism%names(3)%text// &
      ", angle from "//mechanism%pin_names(4)%text//" to "//mechanism%pin_names(3)%text
  end function angle_note

  pure function columns(length) result(list)
    type(unit_t), intent(in) :: length
    type(column_t), allocatable :: list(:)

    call append_column(list, real_column("speed", "rad/s"))
    call append_real_columns(list, "crank theta3 theta4", "deg")
    call append_real_columns(list, "omega3 omega4", "rad/s")
    call append_real_columns(list, "alpha3 alpha4", "rad/s2")
    call append_real_columns(list, "Ax Ay Bx By", length%name)
    call append_column(list, real_column("transmission_angle", "deg"))
  end function columns

  pure function row_of(mechanism, pose, coefficients, speed, acceleration, length) result(row)
    type(mechanism_t), intent(in) :: mechanism
    type(pose_t), intent(in) :: pose
    type(kinematic_coefficients_t), intent(in) :: coefficients
    real(wp), intent(in) :: speed, acceleration !! of the crank [rad/s, rad/s²]
    type(unit_t), intent(in) :: length
    real(wp) :: row(11)

    real(wp) :: velocity(3), angular(3)

    velocity = angular_velocity(coefficients, speed)
    angular = angular_acceleration(coefficients, speed, acceleration)
    row = [body_angle(mechanism%linkage, pose, 2)/degree, body_angle(mechanism%linkage, pose, &
      3)/degree, velocity(2:3), angular(2:3), from_si(pose%pin(:, 2), length), &
      from_si(pose%pin(:, 3), length), transmission_angle(mechanism%linkage, pose, 1)/degree]
  end function row_of

end module kinematics_report
