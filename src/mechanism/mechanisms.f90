!> Model → mechanism: the linkage with its masses and loads, its beams and its mesh.
module mechanisms
  use attached_parts, only: apply_loads, attach_masses, body_point_t, points_of, &
    runs_against
  use beam_mesh, only: new_beam_mesh
  use kinds, only: wp
  use link_cards, only: has_own_mass, link_t
  use linkages, only: new_four_bar
  use models, only: branch_crossed, inertia_lumped, link_line_density, model_t
  use response_parts, only: body_gauge_t, gauges_of, response_points_of
  use shear, only: link_rotary_inertia, link_shear_stiffness
  use structures, only: structure_t
  use text, only: same_word, string_t
  use tokens, only: token_texts
  use torsion, only: out_of_plane_second_moment, torsion_constant
  implicit none (type, external)
  private

  public :: mechanism_t, new_mechanism

  !> The structure of a deck, with the deck's names of its parts.
  type, extends(structure_t) :: mechanism_t
    real(wp) :: accuracy = 0.0_wp               !! relative, of the frequencies, where the program
                                                !! chooses the mesh; else 0
    type(body_point_t), allocatable :: points(:) !! whose paths are requested
    type(body_point_t), allocatable :: response_points(:) !! of REPORT response
    type(body_gauge_t), allocatable :: gauges(:) !! of REPORT strains
    logical, allocatable :: is_reversed(:)      !! (bodies) whose LINK card names the pins in the
                                                !! order against the way round the loop
    type(string_t), allocatable :: names(:)     !! (bodies) of the links
    type(string_t), allocatable :: pin_names(:) !! (pins)
  end type mechanism_t

  integer, parameter :: cubic_order = 3 !! order of the element that stands for a rigid link

contains

  !> The mechanism of a model, its links in their order round the loop.
  pure function new_mechanism(model) result(mechanism)
    type(model_t), intent(in) :: model !! without errors
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
    call add_beam_mesh(model, links, mechanism)
    call attach_masses(model, mechanism%linkage)
    call apply_loads(model, mechanism%linkage)
    mechanism%points = points_of(model)
    mechanism%response_points = response_points_of(model, mechanism%linkage)
    mechanism%gauges = gauges_of(model)
    mechanism%is_reversed = [(runs_against(model, i), i=1, size(links))]
    mechanism%names = token_texts(links%name)
    mechanism%pin_names = token_texts(model%loop_pins)
  end function new_mechanism

  !> Whether a link has a material and a section.
  elemental function is_solid(link) result(is)
    type(link_t), intent(in) :: link
    logical :: is

    is = link%material > 0 .and. link%section > 0
  end function is_solid

  !> Sets the stiffnesses of beams, and the rotary inertia of links without a mass of their own. No
  !! beams if a bending link lacks material or section, or no link bends.
  pure subroutine add_beams(model, links, mechanism)
    type(model_t), intent(in) :: model
    type(link_t), intent(in) :: links(:) !! (bodies)
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
        beam%out_of_plane_stiffness = material%youngs_modulus*out_of_plane_second_moment(section)
        if (material%has_ratio) beam%torsional_stiffness = material%youngs_modulus/ &
          (2.0_wp*(1.0_wp + material%poissons_ratio))*torsion_constant(section)
        if (.not. has_own_mass(links(i))) beam%polar_inertia = &
          material%density*(section%second_moment + out_of_plane_second_moment(section))
      end associate
    end do
  end subroutine add_beams

  !> Sets the mesh, and the elements on whose nodes lumped loads sit. No mesh if a bending link
  !! lacks one, or no link has one.
  pure subroutine add_beam_mesh(model, links, mechanism)
    type(model_t), intent(in) :: model
    type(link_t), intent(in) :: links(:) !! (bodies)
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
  end subroutine add_beam_mesh

  !> Position of a ground pivot in global axes [m].
  pure function ground_at(model, place) result(position)
    type(model_t), intent(in) :: model
    integer, intent(in) :: place !! number of the pin in the loop, 1 or 4
    real(wp) :: position(2)

    integer :: n

    position = 0.0_wp
    do n = 1, size(model%grounds)
      if (same_word(model%grounds(n)%pin%text, model%loop_pins(place)%text)) &
        position = model%grounds(n)%position
    end do
  end function ground_at

end module mechanisms
