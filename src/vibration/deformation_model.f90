!> A linkage of beams, described by the links' own deformations. The model holds everything that is
!! independent of the position and is built once a run.
module deformation_model
  use beam_element, only: axial_degree
  use beam_mesh, only: beam_t
  use body_lumps, only: lump_places, pieces_of
  use bordered_matrix, only: layout_t
  use deformation_shapes, only: axial_shapes, bending_shapes, deformation_shapes_t
  use errors, only: error_t
  use kinds, only: wp
  use link_degrees, only: link_degrees_t, uniform_degrees
  use link_modes, only: held_shapes, link_modes_t, new_link_modes
  use link_store, only: find_link, keep_link, link_key_t, link_store_t, new_link_key
  use linkages, only: body_t, linkage_t
  use lump_displacements, only: add_lump_displacements
  use next_orders, only: orders_beyond
  use reduced_assembly, only: reduced_layout
  use rigid_links, only: new_rigid_link
  use singular_vectors, only: find_right_singular_vectors
  implicit none (type, external)
  private

  public :: deformation_model_t, new_deformation_model

  type :: deformation_model_t
    integer, allocatable :: elements(:)         !! (bodies) of equal length; 0: a continuous link,
                                                !! one element between masses along the link
    integer, allocatable :: order(:)            !! (bodies) polynomial degree of the transverse
                                                !! displacement, the highest of all elements
    type(link_degrees_t), allocatable :: degrees(:) !! (bodies) of continuous links, piece by piece
    logical, allocatable :: lumped(:)           !! (bodies) axial force constant in each element;
                                                !! else quadratic along the link
    type(link_modes_t), allocatable :: links(:) !! (bodies) own modes, or a rigid link
    type(layout_t) :: layout                    !! of the unknowns in the bordered matrices
  end type deformation_model_t

contains

  !> Builds the model. Links that bend are taken from the store if it holds them, otherwise
  !! decomposed into their own modes and added to it.
  !!
  !! Errors: the singular value decomposition that gives the own modes of a link fails.
  subroutine new_deformation_model(linkage, beams, elements, order, lumped, model, error, store, &
      degrees)
    type(linkage_t), intent(in) :: linkage  !! its first body is clamped to the crankshaft
    type(beam_t), intent(in) :: beams(:)    !! (bodies) stiffnesses
    integer, intent(in) :: elements(:)      !! (bodies) as in `deformation_model_t`
    integer, intent(in) :: order(:)         !! (bodies) as in `deformation_model_t`
    logical, intent(in) :: lumped(:)        !! (bodies) as in `deformation_model_t`
    type(deformation_model_t), intent(out) :: model      !! complete unless `error` is allocated
    type(error_t), allocatable, intent(out) :: error     !! why a link has no own modes
    type(link_store_t), intent(inout), optional :: store !! links decomposed earlier; absent:
                                                         !! decompose all
    type(link_degrees_t), intent(in), optional :: degrees(:) !! (bodies) for continuous links, in
                                                             !! place of `order`

    type(link_key_t) :: key
    integer :: b
    logical :: known

    model%elements = elements
    model%order = order
    model%lumped = lumped
    allocate (model%links(size(beams)), model%degrees(size(beams)))
    do b = 1, size(beams)
      model%degrees(b) = uniform_degrees(pieces_in(linkage%bodies(b), elements(b)), order(b), &
        axial_degree(order(b)))
      if (present(degrees) .and. elements(b) == 0) model%degrees(b) = degrees(b)
      model%order(b) = maxval(model%degrees(b)%across)
      if (.not. linkage%bodies(b)%bends) then
        model%links(b) = new_rigid_link(linkage%bodies(b), b == 1)
        cycle
      end if
      key = new_link_key(linkage%bodies(b), beams(b), elements(b), model%degrees(b), b == 1, &
        lumped(b))
      known = .false.
      if (present(store)) call find_link(store, key, model%links(b), known)
      if (known) cycle
      call find_own_modes(linkage, beams(b), b, elements(b), model%degrees(b), lumped(b), &
        model%links(b), error)
      if (allocated(error)) return
      if (present(store)) call keep_link(store, key, model%links(b))
    end do
    model%layout = reduced_layout(linkage, model%links)
  end subroutine new_deformation_model

  !> Number of elements of a link.
  pure function pieces_in(body, elements) result(pieces)
    type(body_t), intent(in) :: body
    integer, intent(in) :: elements !! 0: one between masses along the link
    integer :: pieces

    pieces = elements
    if (elements == 0) pieces = size(pieces_of(body)) - 1
  end function pieces_in

  !> Decomposes one link into its own modes.
  !!
  !! A single element and the elements of a continuous link also hold the unknowns of the next
  !! orders, from which the error is estimated.
  !!
  !! With shear and without rotary inertia some deformations move no mass: v' = θ + γ = 0
  !! everywhere. They have no entries in M and K_G and are left out. The continuous displacements of
  !! the given degrees that vanish at both ends remain.
  subroutine find_own_modes(linkage, beam, b, mesh_elements, degrees, lumped, link, error)
    type(linkage_t), intent(in) :: linkage
    type(beam_t), intent(in) :: beam
    integer, intent(in) :: b, mesh_elements
    type(link_degrees_t), intent(in) :: degrees
    logical, intent(in) :: lumped
    type(link_modes_t), intent(out) :: link
    type(error_t), allocatable, intent(out) :: error

    type(deformation_shapes_t) :: bending, axial
    real(wp), allocatable :: basis(:, :), axial_basis(:, :), displacement(:, :), own(:, :), &
      axial_own(:, :), ends(:)
    integer :: elements, beyond, highest, furthest, independent
    logical :: clamped, sheared

    clamped = b == 1
    sheared = beam%shear_stiffness > 0.0_wp
    beyond = merge(orders_beyond, 0, mesh_elements <= 1)
    elements = size(degrees%across)
    highest = maxval(degrees%across)
    furthest = maxval(degrees%along)
    associate (body => linkage%bodies(b))
      if (mesh_elements == 0) then
        ends = pieces_of(body)
        bending = bending_shapes(body%length, body%line_density, beam%bending_stiffness, elements, &
          highest, beam%shear_stiffness, body%rotary_inertia, ends=ends, orders=degrees%across, &
          beyond=beyond)
        axial = axial_shapes(body%length, body%line_density, beam%axial_stiffness, elements, &
          furthest, ends, degrees%along, beyond)
      else
        bending = bending_shapes(body%length, body%line_density, beam%bending_stiffness, elements, &
          highest, beam%shear_stiffness, body%rotary_inertia, cuts=lump_places(body), beyond=beyond)
        axial = axial_shapes(body%length, body%line_density, beam%axial_stiffness, elements, &
          furthest, beyond=beyond)
      end if
      call add_lump_displacements(body, bending)
      call add_lump_displacements(body, axial)
    end associate
    call held_shapes(bending, bending%kept, clamped, basis, displacement)
    independent = size(basis, 2)
    if (sheared .and. linkage%bodies(b)%rotary_inertia <= 0.0_wp) independent = &
      sum(degrees%across) - 1
    call find_right_singular_vectors(displacement, own, error, independent)
    if (allocated(error)) return
    call held_shapes(axial, axial%kept, .false., axial_basis, displacement)
    call find_right_singular_vectors(displacement, axial_own, error)
    if (allocated(error)) return
    call new_link_modes(bending, axial, clamped, [beam%axial_stiffness, beam%bending_stiffness], &
      lumped, lump_places(linkage%bodies(b)), matmul(basis, own), axial_own, link)
  end subroutine find_own_modes

end module deformation_model
