!> `points.dat`: paths, velocities and accelerations of points fixed to links.
module points_report
  use body_lines, only: place_words
  use body_points, only: find_point_coefficients, point_coefficients_t, point_total_acceleration, &
    point_velocity
  use kinds, only: wp
  use load_notes, only: acceleration_note
  use mechanisms, only: mechanism_t
  use models, only: model_t
  use positions, only: positions_t, state_t
  use tables, only: append_column, append_real_columns, column_t, name_cell, name_column, &
    real_cells, real_column, table_t, write_failure, write_gap, write_header, write_row
  use text, only: append_string, string_t
  use units, only: coherent_unit, dimension_acceleration, dimension_length, dimension_velocity, &
    from_si, unit_t
  implicit none (type, external)
  private

  public :: write_points

  !> The units of the table.
  type :: measures_t
    type(unit_t) :: length, velocity, acceleration
  end type measures_t

contains

  !> One row a position and point, one block a speed.
  subroutine write_points(table, model, mechanism, positions)
    type(table_t), intent(inout) :: table
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(positions_t), intent(in) :: positions

    type(measures_t) :: measures
    type(column_t), allocatable :: columns(:)
    type(string_t), allocatable :: names(:), notes(:)
    integer :: i, k

    measures%length = coherent_unit(model%units, dimension_length)
    measures%velocity = coherent_unit(model%units, dimension_velocity)
    measures%acceleration = coherent_unit(model%units, dimension_acceleration)
    allocate (names(0), notes(0))
    do i = 1, size(mechanism%points)
      call append_string(names, mechanism%points(i)%name)
      associate (point => model%points(i))
        call append_string(notes, "point "//point%name%text//": on link "// &
          model%links(point%link)%name%text//", "//place_words(point%place, measures%length)// &
          " from "//model%links(point%link)%pin(1)%text)
      end associate
    end do
    call append_string(notes, "global axes; "//acceleration_note(model))
    call append_column(columns, real_column("speed", "rad/s"))
    call append_column(columns, real_column("crank", "deg"))
    call append_column(columns, name_column("point", names))
    call append_real_columns(columns, "x y", measures%length%name)
    call append_real_columns(columns, "vx vy", measures%velocity%name)
    call append_real_columns(columns, "ax ay", measures%acceleration%name)
    call write_header(table, model%title, notes, columns)
    do k = 1, size(model%speed%value)
      if (k > 1) call write_gap(table, 2)
      do i = 1, size(positions%crank)
        associate (state => positions%states(positions%state(i)), place => [model%speed%value(k), &
          positions%crank(i)])
          if (allocated(state%error)) then
            call write_failure(table, place, state%error%message)
          else
            call write_position(table, mechanism, measures, columns(3)%width, state, place, &
              model%acceleration)
          end if
        end associate
      end do
    end do
  end subroutine write_points

  !> All points at one position and speed.
  subroutine write_position(table, mechanism, measures, width, state, place, acceleration)
    type(table_t), intent(inout) :: table
    type(mechanism_t), intent(in) :: mechanism
    type(measures_t), intent(in) :: measures
    integer, intent(in) :: width             !! of the column of names
    type(state_t), intent(in) :: state
    real(wp), intent(in) :: place(2)         !! speed and crank angle [rad/s, deg]
    real(wp), intent(in) :: acceleration     !! of the crank [rad/s²]

    type(point_coefficients_t) :: point
    integer :: i

    do i = 1, size(mechanism%points)
      associate (this => mechanism%points(i))
        point = find_point_coefficients(mechanism%linkage, state%pose, state%coefficients, &
          this%body, this%place)
        call write_row(table, real_cells(place)//name_cell(this%name, width)// &
          real_cells([from_si(point%place, measures%length), &
          from_si(point_velocity(point, place(1)), measures%velocity), &
          from_si(point_total_acceleration(point, place(1), acceleration), measures%acceleration)]))
      end associate
    end do
  end subroutine write_position

end module points_report
