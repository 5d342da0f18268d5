! src/vibration/models/ - all links of a linkage in own modes: orders, their errors, the store.
! In: a structure, positions, a `mode_request_t`. Out: `vibration_models_t`, made of
! `deformation_model_t`. Begin with `new_vibration_models` in `vibration_models.f90`:
! `choose_orders` in `order_choice.f90`, `new_deformation_model` here, `find_link` in
! `link_store.f90`.
! Not here: own modes of one link (`src/deformation/links`), the equations at a position
! (`src/vibration`).

!> A linkage of beams, described by the links' own deformations. The model holds everything that is
!! independent of the position and is built once per run.
module deformation_model
  use beam_element, only: axial_degree
  use beam_mesh, only: beam_t
  use body_lumps, only: has_turning_lumps, lump_inertias, lump_offsets, lump_places, pieces_of
  use deformation_model_types, only: deformation_model_t
  use deformation_shapes, only: axial_shapes, bending_shapes, deformation_shapes_t
  use errors, only: error_t
  use kinds, only: wp
  use link_degrees, only: link_degrees_t, uniform_degrees
  use link_modes, only: coupled_shapes, held_shapes, link_modes_t, new_link_modes
  use link_store, only: find_link, keep_link, link_key_t, link_store_t, new_link_key
  use linkages, only: body_t, linkage_t
  use lump_displacements, only: add_lump_displacements, add_lump_rotations, lump_arms_t, &
    new_lump_arms
  use next_orders, only: orders_beyond
  use pin_displacements, only: held_ends
  use reduced_assembly, only: reduced_layout
  use rescaled_links, only: can_be_rescaled, rescale_link
  use rigid_links, only: new_rigid_link
  use singular_vectors, only: find_right_singular_vectors
  implicit none (type, external)
  private

  public :: deformation_model_t, new_deformation_model, renew_link

  !> Masses nearer to each other than this share of the length turn together.
  real(wp), parameter :: least_distance = 1.0e-9_wp

contains

  !> Builds the model. Links that bend are taken from the store if it holds them, otherwise
  !! decomposed into their own modes and added to it.
  !!
  !! Errors: the singular value decomposition that gives the own modes of a link fails.
  subroutine new_deformation_model(linkage, beams, elements, order, lumped, model, error, store, &
      degrees, held)
    type(linkage_t), intent(in) :: linkage  !! which links bend, their masses
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
    logical, intent(in), optional :: held(:, :) !! (2, bodies) first and last ends that are held,
                                                !! all others being pinned; absent: the first end
                                                !! of the first body, which is driven

    type(link_key_t) :: key
    integer :: b
    logical :: known, ends(2, size(beams))

    ends = held_ends(size(beams))
    if (present(held)) ends = held
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
        model%links(b) = new_rigid_link(linkage%bodies(b))
        cycle
      end if
      key = new_link_key(linkage%bodies(b), beams(b), elements(b), model%degrees(b), &
        ends(:, b), lumped(b))
      known = .false.
      if (present(store)) call find_link(store, key, model%links(b), known)
      if (known) cycle
      call find_own_modes(linkage%bodies(b), beams(b), elements(b), model%degrees(b), lumped(b), &
        ends(:, b), model%links(b), error)
      if (allocated(error)) return
      if (present(store)) call keep_link(store, key, model%links(b))
    end do
    model%layout = reduced_layout(linkage, model%links)
  end subroutine new_deformation_model

  !> The own modes of a continuous link whose length has changed.
  !!
  !! Errors: the singular value decomposition fails.
  subroutine renew_link(model, number, body, beam, held, link, error)
    type(deformation_model_t), intent(in) :: model   !! with the link at another length
    integer, intent(in) :: number                    !! of the link
    type(body_t), intent(in) :: body                 !! with its new length
    type(beam_t), intent(in) :: beam                 !! stiffnesses
    logical, intent(in) :: held(2)                   !! its ends
    type(link_modes_t), intent(inout) :: link        !! a copy of that of the model, of any length;
                                                     !! becomes that of the new one
    type(error_t), allocatable, intent(out) :: error !! why it has no own modes

    if (abs(link%length - body%length) <= 0.0_wp) return
    if (can_be_rescaled(model%links(number))) then
      call rescale_link(model%links(number), body%length, link)
      return
    end if
    call find_own_modes(body, beam, 0, model%degrees(number), .false., held, link, error)
  end subroutine renew_link

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
  !! the given degrees that vanish at both ends remain, and the rotations of masses beside the axis
  !! or with a moment of inertia of their own.
  subroutine find_own_modes(body, beam, mesh_elements, degrees, lumped, held, link, error)
    type(body_t), intent(in) :: body
    type(beam_t), intent(in) :: beam
    integer, intent(in) :: mesh_elements
    type(link_degrees_t), intent(in) :: degrees
    logical, intent(in) :: lumped
    logical, intent(in) :: held(2)
    type(link_modes_t), intent(out) :: link
    type(error_t), allocatable, intent(out) :: error

    type(deformation_shapes_t) :: bending, axial
    type(lump_arms_t) :: arms
    real(wp), allocatable :: basis(:, :), axial_basis(:, :), displacement(:, :), own(:, :), &
      axial_own(:, :), along(:, :), ends(:)
    integer :: elements, beyond, highest, furthest, independent
    logical :: sheared

    sheared = beam%shear_stiffness > 0.0_wp
    beyond = merge(orders_beyond, 0, mesh_elements <= 1)
    elements = size(degrees%across)
    highest = maxval(degrees%across)
    furthest = maxval(degrees%along)
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
    call add_lump_rotations(body, bending)
    arms = new_lump_arms(body, bending)
    call held_shapes(bending, bending%kept, held, basis, displacement)
    independent = size(basis, 2)
    if (sheared .and. body%rotary_inertia <= 0.0_wp) independent = &
      min(sum(degrees%across) - 1 + free_turns(body, bending, degrees%across, held), independent)
    call held_shapes(axial, axial%kept, [.false., .false.], axial_basis, along)
    if (has_turning_lumps(body)) then
      displacement = coupled_shapes(displacement, along, matmul(arms%displacement(:, &
        :bending%kept), basis))
      call find_right_singular_vectors(displacement, own, error, independent + axial%kept)
      if (allocated(error)) return
      axial_own = own(size(basis, 2) + 1:, :)
      own = own(:size(basis, 2), :)
    else
      call find_right_singular_vectors(displacement, own, error, independent)
      if (allocated(error)) return
      call find_right_singular_vectors(along, axial_own, error)
      if (allocated(error)) return
    end if
    call new_link_modes(bending, axial, held, [beam%axial_stiffness, beam%bending_stiffness], &
      lumped, lump_places(body), matmul(basis, own), axial_own, link, arms)
  end subroutine find_own_modes

  !> Number of independent rotations of cross-sections that move or turn masses of a body while its
  !! axis stays where it is: those of piecewise polynomials, continuous, of one degree less than the
  !! slopes of its elements, at the places of the masses.
  pure function free_turns(body, shapes, across, held) result(number)
    type(body_t), intent(in) :: body
    type(deformation_shapes_t), intent(in) :: shapes !! its elements
    integer, intent(in) :: across(:)                 !! (elements) degrees of the displacement
    logical, intent(in) :: held(2)                   !! first and last end
    integer :: number

    real(wp), allocatable :: xi(:), turning(:)
    real(wp) :: last
    integer :: e, free, here

    xi = lump_places(body)
    turning = pack(xi, abs(lump_offsets(body)) > 0.0_wp .or. lump_inertias(body) > 0.0_wp)
    if (held(2)) turning = pack(turning, turning < 1.0_wp - least_distance)
    last = -1.0_wp
    if (held(1)) last = 0.0_wp
    number = 0
    free = merge(0, 1, held(1))
    do e = 1, shapes%elements
      here = 0
      do
        xi = pack(turning, turning > last + least_distance .and. &
          turning <= shapes%last(e)/shapes%elements + least_distance)
        if (size(xi) == 0) exit
        here = here + 1
        last = minval(xi)
      end do
      ! An element shares its first rotation with the element before it.
      free = free + across(e) - 2
      if (e == shapes%elements .and. held(2)) free = free - 1
      here = min(here, free)
      number = number + here
      free = min(1, free - here)
    end do
  end function free_turns

end module deformation_model
