!> `mesh.dat`: the finite element model at every position.
module mesh_report
  use mesh_study, only: elements_at, mesh_element_t
  use table_columns, only: cells, column_width, table_layout_t
  use table_rows, only: add_gap, add_row, rows_t
  use tables, only: integer_cell, name_cell
  use text, only: append_string, string_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: mesh_notes, add_mesh

contains

  !> What masses and nodes are.
  pure subroutine mesh_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant
    type(string_t), allocatable, intent(out) :: notes(:)

    call append_string(notes, &
      "mass_a and mass_b: what the element brings to the lumped masses of its nodes")
    call append_string(notes, "both links at a pin have a node of their own there")
    if (.not. all(variant%mechanism%linkage%bodies%bends)) call append_string(notes, &
      "rigid links have no elements")
  end subroutine mesh_notes

  !> The rows of a position: one an element, and an empty line before the next position. Each
  !! element brings half of its mass to either node.
  subroutine add_mesh(variant, layout, position, rows)
    type(variant_results_t), intent(in) :: variant
    type(table_layout_t), intent(in) :: layout
    integer, intent(in) :: position !! number
    type(rows_t), intent(inout) :: rows

    type(mesh_element_t), allocatable :: elements(:)
    integer :: i

    associate (positions => variant%found%positions)
      call elements_at(variant%mechanism%structure_t, &
        positions%states(positions%state(position)), elements)
      do i = 1, size(elements)
        associate (this => elements(i))
          call add_row(rows, cells(layout, 1, positions%crank(position:position))// &
            name_cell(variant%mechanism%names(this%body)%text, column_width(layout, 2))// &
            integer_cell(this%number, "element")//integer_cell(this%nodes(1), "node_a")// &
            integer_cell(this%nodes(2), "node_b")// &
            cells(layout, 6, [this%ends, this%half_mass, this%half_mass]))
        end associate
      end do
      if (position < size(positions%crank)) call add_gap(rows, 1)
    end associate
  end subroutine add_mesh

end module mesh_report
