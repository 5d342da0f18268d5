!> `mesh.dat`: the finite element model at every position.
module mesh_report
  use mesh_study, only: elements_at, mesh_element_t
  use report_kinds, only: four_bars, report_kind_t
  use report_types, only: add_table, report_record_t, rest_table_t
  use table_columns, only: cells, column_width, table_layout_t
  use table_rows, only: add_gap, add_row, rows_t
  use tables, only: integer_cell, name_cell
  use text, only: append_string, string_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: describe_mesh

  !> `mesh.dat`.
  type, extends(rest_table_t) :: mesh_table_t
  contains
    procedure, nopass :: find_notes => mesh_notes
    procedure, nopass :: add_at_rest => add_mesh
  end type mesh_table_t

contains

  !> REPORT mesh.
  subroutine describe_mesh(report)
    type(report_record_t), intent(out) :: report !! for the list of reports

    report%kind = report_kind_t(name="mesh", help="the finite element model", positions=.true., &
      beams=.true., reserved=.true., linkages=four_bars)
    call add_table(report, mesh_table_t(), "mesh", "crank:deg link:name element,node_a,"// &
      "node_b:# xa,ya,xb,yb:length mass_a,mass_b:mass")
  end subroutine describe_mesh

  !> Meaning of the columns of masses and nodes.
  pure subroutine mesh_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant       !! with its mechanism
    type(string_t), allocatable, intent(out) :: notes(:) !! lines of the table's head

    call append_string(notes, &
      "mass_a and mass_b: share of the element in the lumped masses of its nodes")
    call append_string(notes, "each link at a pin has a node of its own there")
    if (.not. all(variant%mechanism%linkage%bodies%bends)) call append_string(notes, &
      "rigid links have no elements")
  end subroutine mesh_notes

  !> Appends the rows of a position, one per element, and an empty line if a position follows. Each
  !! element brings half of its mass to each of its nodes.
  subroutine add_mesh(variant, layout, position, rows)
    type(variant_results_t), intent(in) :: variant !! with its positions computed
    type(table_layout_t), intent(in) :: layout     !! of this table
    integer, intent(in) :: position                !! number in the deck's list, with a pose
    type(rows_t), intent(inout) :: rows            !! to which they are appended

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
