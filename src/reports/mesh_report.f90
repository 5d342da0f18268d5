!> `mesh.dat`: the finite element model at every position.
module mesh_report
  use beam_mesh, only: element_length
  use kinds, only: wp
  use mechanisms, only: mechanism_t
  use models, only: model_t
  use poses, only: pose_t
  use positions, only: positions_t
  use tables, only: append_column, append_real_columns, column_t, integer_cell, integer_column, &
    name_cell, name_column, real_cells, real_column, table_t, write_failure, write_gap, &
    write_header, write_row
  use text, only: append_string, string_t
  use units, only: coherent_unit, dimension_length, dimension_mass, from_si, unit_t
  implicit none (type, external)
  private

  public :: write_mesh

contains

  !> One row an element, an empty line between positions. Each element brings half of its mass to
  !! either node.
  subroutine write_mesh(table, model, mechanism, positions)
    type(table_t), intent(inout) :: table
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(positions_t), intent(in) :: positions

    type(column_t), allocatable :: columns(:)
    type(string_t), allocatable :: notes(:)
    type(unit_t) :: length, mass
    integer :: i

    length = coherent_unit(model%units, dimension_length)
    mass = coherent_unit(model%units, dimension_mass)
    call append_column(columns, real_column("crank", "deg"))
    call append_column(columns, name_column("link", mechanism%names))
    call append_column(columns, integer_column("element"))
    call append_column(columns, integer_column("node_a"))
    call append_column(columns, integer_column("node_b"))
    call append_real_columns(columns, "xa ya xb yb", length%name)
    call append_real_columns(columns, "mass_a mass_b", mass%name)
    call append_string(notes, &
      "mass_a and mass_b: what the element brings to the lumped masses of its nodes")
    call append_string(notes, "both links at a pin have a node of their own there")
    if (.not. all(mechanism%linkage%bodies%bends)) call append_string(notes, &
      "rigid links have no elements")
    call write_header(table, model%title, notes, columns)
    do i = 1, size(positions%crank)
      associate (state => positions%states(positions%state(i)))
        if (allocated(state%error)) then
          call write_failure(table, [positions%crank(i)], state%error%message)
        else
          call write_position(table, mechanism, columns, length, mass, state%pose, &
            positions%crank(i))
          if (i < size(positions%crank)) call write_gap(table, 1)
        end if
      end associate
    end do
  end subroutine write_mesh

  subroutine write_position(table, mechanism, columns, length_unit, mass_unit, pose, crank)
    type(table_t), intent(inout) :: table
    type(mechanism_t), intent(in) :: mechanism
    type(column_t), intent(in) :: columns(:)
    type(unit_t), intent(in) :: length_unit, mass_unit
    type(pose_t), intent(in) :: pose
    real(wp), intent(in) :: crank !! [deg]

    real(wp) :: ends(2, 2), length, half_mass
    integer :: body, i

    do body = 1, size(mechanism%names)
      if (.not. mechanism%linkage%bodies(body)%bends) cycle
      associate (this => mechanism%linkage%bodies(body), mesh => mechanism%mesh)
        length = element_length(mesh, mechanism%linkage, body)
        half_mass = 0.5_wp*this%line_density*length
        do i = 1, mesh%elements(body)
          ends(:, 1) = pose%pin(:, this%first_pin) + (i - 1)*length*pose%direction(:, body)
          ends(:, 2) = pose%pin(:, this%first_pin) + i*length*pose%direction(:, body)
          call write_row(table, real_cells([crank])//name_cell(mechanism%names(body)%text, &
            columns(2)%width)//integer_cell(mesh%first_element(body) + i - 1, "element")// &
            integer_cell(mesh%first_node(body) + i - 1, "node_a")// &
            integer_cell(mesh%first_node(body) + i, "node_b")// &
            real_cells([from_si(reshape(ends, [4]), length_unit), from_si([half_mass, half_mass], &
            mass_unit)]))
        end do
      end associate
    end do
  end subroutine write_position

end module mesh_report
