! src/beam/ - links that bend, as beams: stiffnesses, elements, the mesh of a deck, straight parts.
! In: a planned `linkage_t`, a `beam_t` for each body. Out: mesh and parts of a `structure_t`
! (`structures.f90`). Begin with `new_beam_mesh` here and `new_elastic_linkage` in
! `elastic_linkages.f90`, which divides links into parts between what holds them. Nodal matrices:
! `assembly.f90`.
! Not here: own modes of a link (`src/deformation/links`), poses and forces of parts
! (`src/deformation/parts`).

!> Nodes, elements and unknowns of a linkage of beams.
!!
!! Nodes are numbered round the loop as in the thesis. Every body has its own nodes, so that a pin
!! between two bodies is two nodes at one place. Unknowns are numbered in the same order. At a pin,
!! the rotation of the body that ends there comes first, then the displacements shared by both
!! bodies, then the rotation of the body that begins there. Bubbles and shear strains come between
!! the nodes of their element. The half bandwidth of a chain of bodies is therefore one less than
!! the number of unknowns of its largest element, 5 for order 3, whatever the number of elements.
module beam_mesh
  use beam_element, only: element_unknowns, new_reference_element, reference_element_t
  use kinds, only: wp
  use linkages, only: linkage_t
  implicit none (type, external)
  private

  public :: beam_t, beam_mesh_t, new_beam_mesh, element_count, element_length, moving_unknowns

  !> Stiffnesses of a body as a beam.
  type :: beam_t
    real(wp) :: axial_stiffness = 0.0_wp   !! EA [N]
    real(wp) :: bending_stiffness = 0.0_wp !! EI [N m²]
    real(wp) :: shear_stiffness = 0.0_wp   !! kGA [N]; 0: rigid in shear
    real(wp) :: out_of_plane_stiffness = 0.0_wp !! EI of bending out of the plane [N m²]; 0: not
                                                !! known
    real(wp) :: torsional_stiffness = 0.0_wp    !! GJ [N m²]; 0: not known
    real(wp) :: polar_inertia = 0.0_wp          !! moment of inertia about the axis of the link per
                                                !! length [kg m]
    real(wp) :: line_density = 0.0_wp           !! mass per length of its parts [kg/m]
    real(wp) :: rotary_inertia = 0.0_wp         !! ρI of their cross-sections [kg m]; 0: neglected
  end type beam_t

  !> Division of all bodies into elements, and the numbers of their unknowns.
  type :: beam_mesh_t
    integer, allocatable :: elements(:)      !! (bodies) elements of each body, equal in length
    integer, allocatable :: order(:)         !! (bodies) p of its elements
    logical :: sheared = .false.             !! elements have shear strains
    integer, allocatable :: first_element(:) !! (bodies) number of its first element
    integer, allocatable :: first_node(:)    !! (bodies) number of its first node; its element i
                                             !! joins nodes first_node + i − 1 and first_node + i
    !> (largest element, elements) numbers of u1 v1 θ1, bubbles, shear strains, u2 v2 θ2 in the
    !! order of the element, nodal displacements in global axes; 0: held. Zero beyond the unknowns
    !! of an element.
    integer, allocatable :: unknown(:, :)
    integer, allocatable :: pin_unknown(:, :) !! (2, pins) numbers of the pins' displacements;
                                              !! 0: held
    type(reference_element_t), allocatable :: reference(:) !! (bodies) matrices common to all
                                                           !! elements of a body
    integer :: unknowns = 0       !! in all
    integer :: half_bandwidth = 0 !! of the assembled matrices
  end type beam_mesh_t

contains

  !> Numbers nodes and unknowns. The driven body is clamped at its first pin; the other ground pins
  !! are held but free to rotate (thesis, 3.2.2).
  pure function new_beam_mesh(linkage, elements, orders, sheared) result(mesh)
    type(linkage_t), intent(in) :: linkage   !! pins and bodies
    integer, intent(in) :: elements(:)       !! (bodies) number, at least 1
    integer, intent(in) :: orders(:)         !! (bodies) p, at least 3
    logical, intent(in), optional :: sheared !! elements have shear strains; absent: no
    type(beam_mesh_t) :: mesh

    integer :: body, i
    logical :: placed(size(linkage%is_ground))

    mesh%elements = elements
    mesh%order = orders
    if (present(sheared)) mesh%sheared = sheared
    mesh%first_element = [(1 + sum(elements(:body - 1)), body=1, size(elements))]
    mesh%first_node = [(body + sum(elements(:body - 1)), body=1, size(elements))]
    allocate (mesh%unknown(maxval(element_unknowns(orders, mesh%sheared)), sum(elements)))
    allocate (mesh%pin_unknown(2, size(linkage%is_ground)))
    allocate (mesh%reference(size(elements)))
    mesh%unknown = 0
    mesh%pin_unknown = 0
    placed = linkage%is_ground
    do body = 1, size(elements)
      mesh%reference(body) = new_reference_element(orders(body), mesh%sheared)
      call number_body(mesh, linkage, body, placed)
    end do
    mesh%half_bandwidth = 0
    do i = 1, size(mesh%unknown, 2)
      associate (column => mesh%unknown(:, i))
        mesh%half_bandwidth = max(mesh%half_bandwidth, maxval(column) - minval(column, &
          mask=column > 0))
      end associate
    end do
  end function new_beam_mesh

  !> Numbers the unknowns of a body. Bubbles come between the nodes of their element, which keeps
  !! the numbers of an element together.
  pure subroutine number_body(mesh, linkage, body, placed)
    type(beam_mesh_t), intent(inout) :: mesh
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: body
    logical, intent(inout) :: placed(:) !! (pins) whose displacements are numbered or held

    integer :: i, n, node(3), last_node(3), &
      bubble(element_unknowns(mesh%order(body), mesh%sheared) - 6)

    n = size(bubble) + 6
    associate (first => linkage%bodies(body)%first_pin, last => linkage%bodies(body)%last_pin)
      call place_pin(mesh, first, placed)
      last_node = [mesh%pin_unknown(:, first), 0]
      if (body > 1 .or. .not. linkage%is_ground(first)) call add_unknowns(mesh, last_node(3:3))
      do i = 1, mesh%elements(body)
        call add_unknowns(mesh, bubble)
        if (i < mesh%elements(body)) then
          call add_unknowns(mesh, node)
        else
          call add_unknowns(mesh, node(3:3))
          call place_pin(mesh, last, placed)
          node(:2) = mesh%pin_unknown(:, last)
        end if
        mesh%unknown(:n, mesh%first_element(body) + i - 1) = [last_node, bubble, node]
        last_node = node
      end do
    end associate
  end subroutine number_body

  !> Gives the next free numbers to unknowns.
  pure subroutine add_unknowns(mesh, unknown)
    type(beam_mesh_t), intent(inout) :: mesh
    integer, intent(out) :: unknown(:)

    integer :: i

    unknown = [(mesh%unknowns + i, i=1, size(unknown))]
    mesh%unknowns = mesh%unknowns + size(unknown)
  end subroutine add_unknowns

  !> Numbers the displacements of a pin when the first body reaches it.
  pure subroutine place_pin(mesh, pin, placed)
    type(beam_mesh_t), intent(inout) :: mesh
    integer, intent(in) :: pin
    logical, intent(inout) :: placed(:) !! (pins) ground pins from the beginning

    if (placed(pin)) return
    call add_unknowns(mesh, mesh%pin_unknown(:, pin))
    placed(pin) = .true.
  end subroutine place_pin

  !> Number of elements in all bodies.
  pure function element_count(mesh) result(count)
    type(beam_mesh_t), intent(in) :: mesh !! of the whole linkage
    integer :: count

    count = size(mesh%unknown, 2)
  end function element_count

  !> Number of modes of a mesh that have a finite frequency.
  !!
  !! Every link that bends adds the unknowns of its elements less those of one node each; a rigid
  !! link adds none. With shear but without rotary inertia, deformations that rotate cross-sections
  !! while the axis stays at rest move no mass and are not counted: θ = −γ, continuous along a link,
  !! of degree p − 2 in its elements, and zero at the clamp.
  pure function moving_unknowns(mesh, linkage) result(number)
    type(beam_mesh_t), intent(in) :: mesh  !! elements and orders
    type(linkage_t), intent(in) :: linkage !! which links bend, and rotary inertia
    integer :: number

    number = sum(mesh%elements*(element_unknowns(mesh%order, mesh%sheared) - 3), &
      mask=linkage%bodies%bends)
    if (.not. mesh%sheared .or. any(linkage%bodies%rotary_inertia > 0.0_wp)) return
    number = number - sum(mesh%elements*(mesh%order - 2) + 1, mask=linkage%bodies%bends) + &
      merge(1, 0, linkage%bodies(1)%bends)
  end function moving_unknowns

  !> Length of the elements of a body [m].
  pure function element_length(mesh, linkage, body) result(length)
    type(beam_mesh_t), intent(in) :: mesh  !! number of elements
    type(linkage_t), intent(in) :: linkage !! lengths of its bodies
    integer, intent(in) :: body            !! number, from 1
    real(wp) :: length

    length = linkage%bodies(body)%length/mesh%elements(body)
  end function element_length

end module beam_mesh
