!> The structure that vibrates at a position: a linkage whose links bend as beams. Links of drives
!! that are not free are clamped to what they turn against.
module structures
  use beam_mesh, only: beam_mesh_t, beam_t, new_beam_mesh
  use elastic_linkages, only: elastic_linkage_t
  use errors, only: error_t
  use kinds, only: wp
  use linkages, only: linkage_t
  use poses, only: find_moving_pose, find_pose, pose_t
  implicit none (type, external)
  private

  public :: structure_t, in_parts, has_many_parts, has_beams, has_mesh, has_elastic_reactions, &
    holds_at_change_points, find_structure_pose, elements_replaced

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
    type(elastic_linkage_t) :: elastic       !! the parts that vibrate; empty without beams
  end type structure_t

  !> Number of parts from which the mixed form is faster than a border, and of binary links from
  !! which it is faster than their closed forms, for few modes. So many modes cost it as much again.
  integer, parameter :: many_parts = 16, many_links = 40, many_modes = 30

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

  !> Whether statics alone cannot tell the forces of a linkage, and its elasticity can.
  pure function has_elastic_reactions(structure) result(has)
    class(structure_t), intent(in) :: structure !! with or without beams
    logical :: has

    has = size(structure%linkage%redundancies) > 0 .and. has_beams(structure)
  end function has_elastic_reactions

  !> Whether parts that bend may hold a structure at its change points.
  pure function holds_at_change_points(structure) result(holds)
    class(structure_t), intent(in) :: structure
    logical :: holds

    ! Of several drives the rates there are not known one by one.
    holds = has_elastic_reactions(structure) .and. size(structure%linkage%drives) == 1
  end function holds_at_change_points

  !> A pose at which the vibrations of a structure are determined, as far as it tells by itself.
  !!
  !! Errors: those of `find_pose`, or of `find_moving_pose`.
  pure subroutine find_structure_pose(structure, crank, pose, error)
    class(structure_t), intent(in) :: structure
    real(wp), intent(in) :: crank !! of the first drive [deg] or [m]
    type(pose_t), intent(out) :: pose
    type(error_t), allocatable, intent(out) :: error

    if (holds_at_change_points(structure)) then
      call find_moving_pose(structure%linkage, crank, pose, error)
    else
      call find_pose(structure%linkage, crank, pose, error)
    end if
  end subroutine find_structure_pose

  !> The structure whose frequencies are found: of many binary links closed forms take too long.
  pure function in_parts(structure, modes) result(divided)
    class(structure_t), intent(in) :: structure !! with beams
    integer, intent(in) :: modes                !! wanted
    type(structure_t) :: divided

    divided%linkage = structure%linkage
    divided%beams = structure%beams
    divided%mesh = structure%mesh
    divided%load_elements = structure%load_elements
    divided%elastic = structure%elastic
    if (are_many(size(structure%beams), many_links, modes)) divided%elastic%in_closed_form = .false.
  end function in_parts

  !> Whether the equations of a linkage are solved in mixed form: it has so many parts that the cube
  !! of their number counts, no motion is free, and no damper acts.
  pure function has_many_parts(structure, modes) result(has)
    class(structure_t), intent(in) :: structure !! with parts
    integer, intent(in) :: modes                !! wanted; 0: statics
    logical :: has

    associate (parts => structure%elastic%linkage)
      has = .not. structure%elastic%in_closed_form .and. are_many(size(parts%bodies), many_parts, &
        modes) .and. .not. any(parts%drives%is_free) .and. size(structure%elastic%dampers) == 0 &
        .and. .not. any(parts%bodies%bends .and. parts%bodies%line_density <= 0.0_wp)
    end associate
  end function has_many_parts

  !> Whether parts are enough for the mixed form.
  pure logical function are_many(parts, least, modes)
    integer, intent(in) :: parts, least, modes

    are_many = parts*many_modes >= least*(many_modes + modes)
  end function are_many

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

end module structures
