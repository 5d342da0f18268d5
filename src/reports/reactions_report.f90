!> `reactions.dat`: forces in the pins, driving torque, shaking force and moment.
module reactions_report
  use kinds, only: wp
  use load_notes, only: append_load_notes, append_motion_notes
  use mechanisms, only: mechanism_t
  use models, only: model_t
  use positions, only: positions_t, state_t
  use reactions, only: find_unit_reactions, reactions_at, reactions_t
  use tables, only: append_column, append_real_columns, column_t, real_cells, real_column, &
    table_t, write_failure, write_gap, write_header, write_row
  use text, only: append_string, string_t
  use units, only: coherent_unit, dimension_force, dimension_moment, from_si, unit_t
  implicit none (type, external)
  private

  public :: write_reactions

contains

  !> One row a position, one block a speed.
  subroutine write_reactions(table, model, mechanism, positions)
    type(table_t), intent(inout) :: table
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(positions_t), intent(in) :: positions

    type(unit_t) :: force, moment
    type(string_t), allocatable :: remarks(:)
    type(column_t), allocatable :: table_columns(:)
    integer :: i, k

    force = coherent_unit(model%units, dimension_force)
    moment = coherent_unit(model%units, dimension_moment)
    remarks = notes_of(model, mechanism)
    table_columns = columns_of(force, moment)
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
              real_cells([place, row_of(mechanism, state, place(1), model%acceleration, force, &
              moment)]))
          end if
        end associate
      end do
    end do
  end subroutine write_reactions

  pure function notes_of(model, mechanism) result(list)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(string_t), allocatable :: list(:)

    call append_motion_notes(list, model, mechanism)
    call append_string(list, &
      "forces in global axes: A2 on link 2 at A, and so on; O2 and O4 of the ground on links 2 "// &
      "and 4")
    call append_string(list, "torque: of the drive on link 2, counter-clockwise positive")
    call append_string(list, &
      "shaking: resultant of -m a of all masses; shaking_moment: of these and of -I alpha of "// &
      "all links, "//"about pin "//mechanism%pin_names(1)%text// &
      "; weights and loads from outside are no part of either")
    call append_load_notes(list, model, mechanism)
  end function notes_of

  pure function columns_of(force, moment) result(list)
    type(unit_t), intent(in) :: force, moment
    type(column_t), allocatable :: list(:)

    call append_column(list, real_column("speed", "rad/s"))
    call append_column(list, real_column("crank", "deg"))
    call append_real_columns(list, "O2x O2y A2x A2y A3x A3y B3x B3y B4x B4y O4x O4y", force%name)
    call append_column(list, real_column("torque", moment%name))
    call append_real_columns(list, "shaking_x shaking_y", force%name)
    call append_column(list, real_column("shaking_moment", moment%name))
  end function columns_of

  pure function row_of(mechanism, state, speed, acceleration, force, moment) result(row)
    type(mechanism_t), intent(in) :: mechanism
    type(state_t), intent(in) :: state
    real(wp), intent(in) :: speed, acceleration !! of the crank [rad/s, rad/s²]
    type(unit_t), intent(in) :: force, moment
    real(wp) :: row(16)

    type(reactions_t) :: found
    integer :: b

    found = reactions_at(find_unit_reactions(mechanism%linkage, mechanism%load_elements, &
      state%pose, state%coefficients), speed, acceleration)
    do b = 1, 3
      row(4*b - 3:4*b) = from_si([found%joints%on_first(:, b), found%joints%on_last(:, b)], force)
    end do
    row(13:) = [from_si(found%joints%torque, moment), from_si(found%shaking_force, force), &
      from_si(found%shaking_moment, moment)]
  end function row_of

end module reactions_report
