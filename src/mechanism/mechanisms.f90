!> Model → what mechanics works on: the linkage with its masses and loads, its beams, its mesh.
module mechanisms
  use attached_parts, only: apply_loads, attach_masses, body_point_t, points_of
  use beam_mesh, only: new_beam_mesh
  use kinds, only: wp
  use link_cards, only: has_own_mass, link_t
  use linkages, only: new_four_bar
  use models, only: branch_crossed, inertia_lumped, link_line_density, model_t
  use shear, only: link_rotary_inertia, link_shear_stiffness
  use structures, only: structure_t
  use text, only: same_word, string_t
  use tokens, only: token_texts
  implicit none (type, external)
  private

  public :: mechanism_t, new_mechanism

  !> The structure that a deck describes, with the names that the deck has for its parts.
  type, extends(structure_t) :: mechanism_t
    real(wp) :: accuracy = 0.0_wp             !! of frequencies, where the deck leaves the mesh to
                                              !! the program; else 0
    type(body_point_t), allocatable :: points(:)
    type(string_t), allocatable :: names(:)   !! (bodies) of the links
    type(string_t), allocatable :: pin_names(:) !! (pins)
  end type mechanism_t

  integer, parameter :: cubic_order = 3 !! of the element that stands for a rigid link

contains

  !> Puts the links in the order round the loop.
  pure function new_mechanism(model) result(mechanism)
    type(model_t), intent(in) :: model
    type(mechanism_t) :: mechanism

    real(wp) :: ground(2, 2), line_density(3), pin_mass(2)
    type(link_t) :: links(3)
    integer :: i, k

    ground = reshape([ground_at(model, 1), ground_at(model, 4)], [2, 2])
    pin_mass = 0.0_wp
    do i = 1, size(model%pin_masses)
      do k = 1, 2
        if (same_word(model%pin_masses(i)%pin%text, model%loop_pins(k + 1)%text)) pin_mass(k) = &
          model%pin_masses(i)%mass
      end do
    end do
    links = model%links(model%loop)
    line_density = 0.0_wp
    do i = 1, 3
      if (.not. has_own_mass(links(i))) line_density(i) = link_line_density(model, model%loop(i))
    end do
    mechanism%linkage = new_four_bar(ground, links%length, line_density, pin_mass, &
      model%branch == branch_crossed)
    mechanism%linkage%bodies%bends = .not. links%rigid
    call add_beams(model, links, mechanism)
    call add_mesh(model, links, mechanism)
    call attach_masses(model, mechanism%linkage)
    call apply_loads(model, mechanism%linkage)
    mechanism%points = points_of(model)
    mechanism%names = token_texts(links%name)
    mechanism%pin_names = token_texts(model%loop_pins)
  end function new_mechanism

  !> Whether a link is made of a material and has a section.
  elemental function is_solid(link) result(is)
    type(link_t), intent(in) :: link
    logical :: is

    is = link%material > 0 .and. link%section > 0
  end function is_solid

  !> Stiffnesses, and the rotary inertia of links that have no mass of their own.
  pure subroutine add_beams(model, links, mechanism)
    type(model_t), intent(in) :: model
    type(link_t), intent(in) :: links(:)
    type(mechanism_t), intent(inout) :: mechanism

    logical :: beams
    integer :: i

    beams = any(.not. links%rigid) .and. all(links%rigid .or. is_solid(links))
    allocate (mechanism%beams(merge(size(links), 0, beams)))
    do i = 1, size(links)
      if (.not. is_solid(links(i))) cycle
      if (.not. has_own_mass(links(i))) mechanism%linkage%bodies(i)%rotary_inertia = &
        link_rotary_inertia(model, model%loop(i))
      if (.not. beams) cycle
      associate (beam => mechanism%beams(i), material => model%materials(links(i)%material), &
          section => model%sections(links(i)%section))
        beam%axial_stiffness = material%youngs_modulus*section%area
        beam%bending_stiffness = material%youngs_modulus*section%second_moment
        beam%shear_stiffness = link_shear_stiffness(model, model%loop(i))
      end associate
    end do
  end subroutine add_beams

  !> The mesh, and where lumped loads sit: on the nodes of links that have them.
  pure subroutine add_mesh(model, links, mechanism)
    type(model_t), intent(in) :: model
    type(link_t), intent(in) :: links(:)
    type(mechanism_t), intent(inout) :: mechanism

    integer :: elements(size(links)), order(size(links)), i

    allocate (mechanism%load_elements(size(links)))
    mechanism%load_elements = 0
    elements = 1
    order = cubic_order
    do i = 1, size(links)
      if (links(i)%mesh == 0) cycle
      elements(i) = model%meshes(links(i)%mesh)%elements
      order(i) = model%meshes(links(i)%mesh)%order
      mechanism%accuracy = max(mechanism%accuracy, model%meshes(links(i)%mesh)%accuracy)
      if (model%inertia == inertia_lumped .and. .not. has_own_mass(links(i))) &
        mechanism%load_elements(i) = elements(i)
    end do
    if (.not. any(links%mesh > 0) .or. any(links%mesh == 0 .and. .not. links%rigid)) return
    mechanism%mesh = new_beam_mesh(mechanism%linkage, elements, order, &
      any(mechanism%beams%shear_stiffness > 0.0_wp))
  end subroutine add_mesh

  !> Position of the ground pivot at a place of the loop [m].
  pure function ground_at(model, place) result(position)
    type(model_t), intent(in) :: model
    integer, intent(in) :: place
    real(wp) :: position(2)

    integer :: n

    position = 0.0_wp
    do n = 1, size(model%grounds)
      if (same_word(model%grounds(n)%pin%text, model%loop_pins(place)%text)) &
        position = model%grounds(n)%position
    end do
  end function ground_at

end module mechanisms
