!> `lagrange.dat`: the terms of Lagrange's equation, the torque that they demand, and the energies.
module lagrange_report
  use kinds, only: wp
  use lagrange, only: demanded_torque, find_lagrange, kinetic_energy, lagrange_t, velocity_term
  use load_notes, only: append_load_notes, append_motion_notes
  use mechanisms, only: mechanism_t
  use models, only: model_t
  use positions, only: positions_t
  use rigid_bodies, only: rigid_bodies_of, rigid_body_t
  use tables, only: append_column, append_real_columns, column_t, real_cells, real_column, &
    table_t, write_failure, write_gap, write_header, write_row
  use text, only: append_string, string_t
  use units, only: coherent_unit, dimension_inertia, dimension_moment, from_si, unit_t
  implicit none (type, external)
  private

  public :: write_lagrange

contains

  !> One row a position, one block a speed.
  subroutine write_lagrange(table, model, mechanism, positions)
    type(table_t), intent(inout) :: table
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(positions_t), intent(in) :: positions

    type(unit_t) :: inertia, moment
    type(string_t), allocatable :: remarks(:)
    type(column_t), allocatable :: table_columns(:)
    type(rigid_body_t), allocatable :: rigid(:)
    integer :: i, k

    inertia = coherent_unit(model%units, dimension_inertia)
    moment = coherent_unit(model%units, dimension_moment)
    rigid = rigid_bodies_of(mechanism%linkage, mechanism%load_elements)
    remarks = notes_of(model, mechanism)
    table_columns = columns_of(inertia, moment)
    call write_header(table, model%title, remarks, table_columns)
    do k = 1, size(model%speed%value)
      if (k > 1) call write_gap(table, 2)
      do i = 1, size(positions%crank)
        associate (state => positions%states(positions%state(i)), place => [model%speed%value(k), &
          positions%crank(i)])
          if (allocated(state%error)) then
            call write_failure(table, place, state%error%message)
          else
            call write_row(table, &
              real_cells([place, row_of(find_lagrange(mechanism%linkage, rigid, state%pose, &
              state%coefficients), place(1), model%acceleration, inertia, moment)]))
          end if
        end associate
      end do
    end do
  end subroutine write_lagrange

  pure function notes_of(model, mechanism) result(list)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(string_t), allocatable :: list(:)

    call append_motion_notes(list, model, mechanism)
    call append_string(list, &
      "torque = M alpha2 + V + gravity + load, of the drive on link 2, counter-clockwise positive")
    call append_string(list, &
      "M: all masses at the crank; dM: dM/dtheta2; V = dM omega2^2/2; gravity: dU/dtheta2 of "// &
      "the "//"weights; load: what holds the loads from outside")
    call append_string(list, &
      "kinetic = M omega2^2/2; potential: of the weights and of the forces from outside, 0 "// &
      "with all "//"masses and pins at the global origin; torques on links have none here")
    call append_load_notes(list, model, mechanism)
  end function notes_of

  pure function columns_of(inertia, moment) result(list)
    type(unit_t), intent(in) :: inertia, moment
    type(column_t), allocatable :: list(:)

    call append_column(list, real_column("speed", "rad/s"))
    call append_column(list, real_column("crank", "deg"))
    call append_real_columns(list, "M dM", inertia%name)
    call append_real_columns(list, "V gravity load torque kinetic potential", moment%name)
  end function columns_of

  pure function row_of(terms, speed, acceleration, inertia, moment) result(row)
    type(lagrange_t), intent(in) :: terms
    real(wp), intent(in) :: speed, acceleration !! of the crank [rad/s, rad/s²]
    type(unit_t), intent(in) :: inertia, moment
    real(wp) :: row(8)

    row = [from_si([terms%inertia, terms%inertia_slope], inertia), &
      from_si([velocity_term(terms, speed), terms%gravity, terms%load, demanded_torque(terms, &
      speed, acceleration), kinetic_energy(terms, speed), terms%potential], moment)]
  end function row_of

end module lagrange_report
