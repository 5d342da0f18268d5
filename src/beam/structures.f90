!> A linkage whose links bend as beams: what vibrates at a position, with its driven link clamped.
module structures
  use beam_mesh, only: beam_mesh_t, beam_t, new_beam_mesh
  use linkages, only: linkage_t
  implicit none (type, external)
  private

  public :: structure_t, has_beams, has_mesh, elements_replaced

  type :: structure_t
    type(linkage_t) :: linkage
    type(beam_t), allocatable :: beams(:)    !! (bodies); of a rigid link without stiffness; empty
                                             !! if a link that bends has no material or section
    type(beam_mesh_t) :: mesh                !! one element on a rigid link; without unknowns if a
                                             !! link that bends has no mesh
    integer, allocatable :: load_elements(:) !! (bodies) on whose nodes their masses sit as loads;
                                             !! 0: distributed, and for links that have no nodes
  end type structure_t

contains

  !> Whether all links that bend have stiffnesses, and any link bends.
  pure function has_beams(structure) result(has)
    class(structure_t), intent(in) :: structure
    logical :: has

    has = size(structure%beams) > 0
  end function has_beams

  !> Whether all links that bend are divided into elements.
  pure function has_mesh(structure) result(has)
    class(structure_t), intent(in) :: structure
    logical :: has

    has = structure%mesh%unknowns > 0
  end function has_mesh

  !> The same structure with another number of elements on each body.
  pure function elements_replaced(structure, elements) result(other)
    type(structure_t), intent(in) :: structure
    integer, intent(in) :: elements(:) !! (bodies)
    type(structure_t) :: other

    other = structure
    associate (mesh => structure%mesh)
      other%mesh = new_beam_mesh(structure%linkage, elements, mesh%order, mesh%sheared)
    end associate
    where (structure%load_elements > 0) other%load_elements = elements
  end function elements_replaced

end module structures
