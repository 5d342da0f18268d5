!> The structure that vibrates at a position: a linkage whose links bend as beams. Links of drives
!! that are not free are clamped to what they turn against.
module structures
  use beam_mesh, only: beam_mesh_t, beam_t, new_beam_mesh
  use elastic_linkages, only: elastic_linkage_t, new_elastic_linkage
  use errors, only: error_t
  use kinds, only: wp
  use linkages, only: linkage_t
  use poses, only: find_moving_pose, find_pose, pose_t
  implicit none (type, external)
  private

  public :: structure_t, in_parts, has_many_parts, has_beams, has_mesh, has_elastic_reactions, &
    holds_at_change_points, find_structure_pose, damper_count, elements_replaced, &
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

    has = size(structure%linkage%redundancies) > 0 .and. allocated(structure%elastic)
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

  !> The structure whose frequencies are found: of many binary links, too, each is a part.
  pure function in_parts(structure, modes) result(divided)
    class(structure_t), intent(in) :: structure !! with beams
    integer, intent(in) :: modes                !! wanted
    type(structure_t) :: divided

    divided%linkage = structure%linkage
    divided%beams = structure%beams
    divided%mesh = structure%mesh
    divided%load_elements = structure%load_elements
    if (allocated(structure%elastic)) then
      divided%elastic = structure%elastic
    else if (are_many(size(structure%beams), many_links, modes)) then
      divided%elastic = new_elastic_linkage(structure%linkage, structure%beams)
    end if
  end function in_parts

  !> Whether the equations of a linkage are solved in mixed form: it has so many parts that the cube
  !! of their number counts, no motion is free, and no damper acts.
  pure function has_many_parts(structure, modes) result(has)
    class(structure_t), intent(in) :: structure !! with or without parts
    integer, intent(in) :: modes                !! wanted; 0: statics
    logical :: has

    has = allocated(structure%elastic)
    if (.not. has) return
    associate (parts => structure%elastic%linkage)
      has = are_many(size(parts%bodies), many_parts, modes) .and. &
        .not. any(parts%drives%is_free) .and. &
        size(structure%elastic%dampers) == 0 .and. .not. any(parts%bodies%bends .and. &
        parts%bodies%line_density <= 0.0_wp)
    end associate
  end function has_many_parts

  !> Whether parts are enough for the mixed form.
  pure logical function are_many(parts, least, modes)
    integer, intent(in) :: parts, least, modes

    are_many = parts*many_modes >= least*(many_modes + modes)
  end function are_many

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
