!> The structure that vibrates at a position: a linkage whose links bend as beams, with its driven
!! link clamped.
module structures
  use beam_mesh, only: beam_mesh_t, beam_t, new_beam_mesh
  use elastic_linkages, only: elastic_linkage_t
  use linkages, only: linkage_t
  implicit none (type, external)
  private

  public :: structure_t, has_beams, has_mesh, damper_count, elements_replaced, &
    vibrating_linkage, vibrating_beams

  !> A linkage with the beams and the mesh of its links.
  type :: structure_t
    type(linkage_t) :: linkage               !! pins, bodies, loads
    type(beam_t), allocatable :: beams(:)    !! (bodies) stiffnesses, zero for a rigid link; empty
                                             !! if a link that bends has no material or section
    type(beam_mesh_t) :: mesh                !! one element on a rigid link; no unknowns if a link
                                             !! that bends has no mesh
    integer, allocatable :: load_elements(:) !! (bodies) elements whose nodes carry the lumped mass
                                             !! in inertia loads; 0: distributed mass, and links
                                             !! without nodes
    type(elastic_linkage_t), allocatable :: elastic !! the parts that vibrate; not allocated: binary
                                             !! links and pins, each link is a part
  end type structure_t

contains

  !> Whether any link bends, and all that bend have stiffnesses.
  pure function has_beams(structure) result(has)
    class(structure_t), intent(in) :: structure !! with or without beams
    logical :: has

    has = size(structure%beams) > 0
  end function has_beams

  !> Whether all links that bend are divided into elements.
  pure function has_mesh(structure) result(has)
    class(structure_t), intent(in) :: structure !! with or without mesh
    logical :: has

    has = structure%mesh%unknowns > 0
  end function has_mesh

  !> Number of dampers between parts.
  pure function damper_count(structure) result(number)
    class(structure_t), intent(in) :: structure !! with or without parts
    integer :: number

    number = 0
    if (allocated(structure%elastic)) number = size(structure%elastic%dampers)
  end function damper_count

  !> The same structure with other numbers of elements; lumped loads follow them.
  pure function elements_replaced(structure, elements) result(other)
    type(structure_t), intent(in) :: structure !! with a mesh
    integer, intent(in) :: elements(:)         !! (bodies) number, at least 1
    type(structure_t) :: other

    other = structure
    associate (mesh => structure%mesh)
      other%mesh = new_beam_mesh(structure%linkage, elements, mesh%order, mesh%sheared)
    end associate
    where (structure%load_elements > 0) other%load_elements = elements
  end function elements_replaced

  !> The linkage whose bodies vibrate each by themselves: the parts of a linkage that has them.
  pure function vibrating_linkage(structure) result(linkage)
    class(structure_t), intent(in) :: structure !! with beams
    type(linkage_t) :: linkage

    if (allocated(structure%elastic)) then
      linkage = structure%elastic%linkage
    else
      linkage = structure%linkage
    end if
  end function vibrating_linkage

  !> Stiffnesses of the bodies of `vibrating_linkage`.
  pure function vibrating_beams(structure) result(beams)
    class(structure_t), intent(in) :: structure !! with beams
    type(beam_t), allocatable :: beams(:)       !! (bodies)

    if (allocated(structure%elastic)) then
      beams = structure%elastic%beams
    else
      beams = structure%beams
    end if
  end function vibrating_beams

end module structures
