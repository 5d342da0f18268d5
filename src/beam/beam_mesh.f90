!> Nodes, elements and unknowns of a linkage of beams.
!!
!! Nodes are numbered round the loop as in the thesis: every body has its own nodes, so that a pin
!! between two bodies is two nodes in one place. Unknowns are numbered along the same way; at a pin
!! the rotation of the body that ends comes before the displacements that both share, and these
!! before the rotation of the body that begins. Bubbles and shear strains come between the nodes of
!! their element. So the half bandwidth of a chain of bodies is one less than the unknowns of its
!! largest element, 5 for order 3, whatever the number of elements.
module beam_mesh
  use beam_element, only: element_unknowns, new_reference_element, reference_element_t
  use kinds, only: wp
  use linkages, only: linkage_t
  implicit none (type, external)
  private

  public :: beam_t, beam_mesh_t, new_beam_mesh, element_count, element_length, moving_unknowns

  !> What a body is made of, as a beam.
  type :: beam_t
    real(wp) :: axial_stiffness = 0.0_wp   !! EA [N]
    real(wp) :: bending_stiffness = 0.0_wp !! EI [N m²]
    real(wp) :: shear_stiffness = 0.0_wp   !! kGA [N]; 0: rigid in shear
  end type beam_t

  type :: beam_mesh_t
    integer, allocatable :: elements(:)       !! (bodies) elements of each body, all of one length
    integer, allocatable :: order(:)          !! (bodies) of its elements
    logical :: sheared = .false.              !! elements have shear strains
    integer, allocatable :: first_element(:)  !! (bodies) number of its first element
    integer, allocatable :: first_node(:)     !! (bodies) number of its first node; its element i
                                              !! joins nodes i and i + 1 from here
    !> (largest element, elements) of u1 v1 θ1, bubbles, shear strains, u2 v2 θ2 as in the element,
    !! nodal displacements in global axes; 0: held. An element has as many as its order asks for,
    !! and zeros beyond.
    integer, allocatable :: unknown(:, :)
    integer, allocatable :: pin_unknown(:, :) !! (2, pins) of the displacements of pins; 0: held
    type(reference_element_t), allocatable :: reference(:) !! (bodies) what its elements have in
                                                           !! common
    integer :: unknowns = 0
    integer :: half_bandwidth = 0
  end type beam_mesh_t

contains

  !> Numbers nodes and unknowns. The driven body is clamped at its first pin, the other grounds hold
  !! their pin (thesis, 3.2.2).
  pure function new_beam_mesh(linkage, elements, orders, sheared) result(mesh)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: elements(:) !! (bodies)
    integer, intent(in) :: orders(:)   !! (bodies) at least 3
    logical, intent(in), optional :: sheared !! absent: no
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

  !> Numbers the unknowns of a body: bubbles between the nodes of their element, so that every
  !! element has a run of its own.
  pure subroutine number_body(mesh, linkage, body, placed)
    type(beam_mesh_t), intent(inout) :: mesh
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: body
    logical, intent(inout) :: placed(:) !! (pins)

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

  !> Gives the next numbers to unknowns.
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
    logical, intent(inout) :: placed(:) !! (pins) grounds are placed from the beginning

    if (placed(pin)) return
    call add_unknowns(mesh, mesh%pin_unknown(:, pin))
    placed(pin) = .true.
  end subroutine place_pin

  pure function element_count(mesh) result(count)
    type(beam_mesh_t), intent(in) :: mesh
    integer :: count

    count = size(mesh%unknown, 2)
  end function element_count

  !> How many modes of a finite frequency a mesh has.
  !!
  !! A link that does not bend has none: every other one brings the unknowns of its elements but
  !! those of one node each. With shear and without rotary inertia cross-sections that turn, the
  !! axis at rest, move no mass: θ = −γ, continuous along a link and of degree p − 2 in its
  !! elements, zero at the clamp.
  pure function moving_unknowns(mesh, linkage) result(number)
    type(beam_mesh_t), intent(in) :: mesh
    type(linkage_t), intent(in) :: linkage
    integer :: number

    number = sum(mesh%elements*(element_unknowns(mesh%order, mesh%sheared) - 3), &
      mask=linkage%bodies%bends)
    if (.not. mesh%sheared .or. any(linkage%bodies%rotary_inertia > 0.0_wp)) return
    number = number - sum(mesh%elements*(mesh%order - 2) + 1, mask=linkage%bodies%bends) + &
      merge(1, 0, linkage%bodies(1)%bends)
  end function moving_unknowns

  !> Length of the elements of a body [m].
  pure function element_length(mesh, linkage, body) result(length)
    type(beam_mesh_t), intent(in) :: mesh
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: body
    real(wp) :: length

    length = linkage%bodies(body)%length/mesh%elements(body)
  end function element_length

end module beam_mesh
