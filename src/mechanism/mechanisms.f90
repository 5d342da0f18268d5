! src/mechanism/ - the model in the terms of mechanics: names become numbers, cards become bodies.
! In: a `model_t` without errors. Out: a `mechanism_t`: the structure, and the names of its links
! and pins. Begin with `new_mechanism` here and `assemble_linkage` in `linkage_builder.f90`, which
! makes the linkage and its plan; other builders make loads, friction, damping.
! Not here: reading cards (`src/model`), what is refused because mechanics cannot do it
! (`src/runs/checks`).

!> Model → mechanism: the linkage with its masses and loads, its beams and its mesh.
module mechanisms
  use applied_loads, only: forced_places
  use body_attachments, only: append_loads, apply_loads, attach_masses, body_point_t, points_of, &
    runs_against
  use beam_mesh, only: new_beam_mesh
  use four_bar_loops, only: find_four_bar, four_bar_t
  use coordinate_builder, only: build_coordinates, listed_coordinate_t
  use elastic_linkages, only: new_elastic_linkage
  use friction_builder, only: frictions_of
  use kinds, only: wp
  use link_cards, only: has_own_mass, link_t
  use linkage_builder, only: assemble_linkage, assembly_t
  use linkages, only: is_dyad_linkage
  use linkage_cards, only: default_accuracy
  use models, only: as_four_bar, inertia_lumped, link_line_density, model_t, needs_beams
  use name_index, only: name_index_t, new_name_index
  use pose_types, only: pins_of_body, way_length
  use process_builder, only: process_loads
  use response_builder, only: body_gauge_t, gauges_of, response_points_of
  use shear, only: link_rotary_inertia, link_shear_stiffness
  use spring_builder, only: springs_of
  use stop_builder, only: stops_of
  use structures, only: has_beams, structure_t
  use text, only: string_t
  use tokens, only: token_texts
  use torsion, only: out_of_plane_second_moment, torsion_constant
  implicit none (type, external)
  private

  public :: mechanism_t, new_mechanism, mechanism_of, pins_of_body, way_length, link_lengths

  !> The structure of a deck, with the deck's names of its parts.
  type, extends(structure_t) :: mechanism_t
    real(wp) :: accuracy = 0.0_wp               !! relative, of the frequencies, where the program
                                                !! chooses the mesh; else 0
    type(body_point_t), allocatable :: points(:) !! whose paths are requested
    type(body_point_t), allocatable :: response_points(:) !! of REPORT response
    type(body_gauge_t), allocatable :: gauges(:) !! of REPORT strains
    type(listed_coordinate_t), allocatable :: coordinates(:) !! of the linkage, in its order
    type(four_bar_t), allocatable :: four_bar   !! that the linkage is; not allocated: another one
    logical :: is_four_bar = .true.             !! it is written as one, unless a report has a
                                                !! format of its own
    integer, allocatable :: links(:)            !! (bodies) numbers of their links in the model
    logical, allocatable :: is_reversed(:)      !! (bodies) whose LINK card names the pins in the
                                                !! order against the way round the loop
    type(string_t), allocatable :: names(:)     !! (bodies) of the links
    type(string_t), allocatable :: pin_names(:) !! (pins)
  end type mechanism_t

  integer, parameter :: cubic_order = 3 !! order of the element that stands for a rigid link

contains

  !> The mechanism of a model, its links in the order in which they are placed: in a four-bar that
  !! round the loop.
  pure function new_mechanism(model) result(mechanism)
    type(model_t), intent(in) :: model !! without errors, of a linkage that has a plan
    type(mechanism_t) :: mechanism

    type(assembly_t) :: assembly

    call assemble_linkage(model, assembly)
    mechanism = mechanism_of(model, assembly)
  end function new_mechanism

  !> The mechanism of a linkage that is assembled: with masses, loads, beams and mesh.
  pure function mechanism_of(model, assembly) result(mechanism)
    type(model_t), intent(in) :: model         !! without errors
    type(assembly_t), intent(in) :: assembly   !! of this model
    type(mechanism_t) :: mechanism

    type(link_t) :: links(size(assembly%link))
    type(name_index_t) :: pins
    integer :: i

    mechanism%linkage = assembly%linkage
    call find_four_bar(mechanism%linkage, mechanism%four_bar)
    mechanism%is_four_bar = as_four_bar(model) .and. allocated(mechanism%four_bar)
    mechanism%links = assembly%link
    mechanism%pin_names = assembly%pins
    links = model%links(assembly%link)
    pins = new_name_index(assembly%pins)
    call attach_masses(model, assembly%link, pins, mechanism%linkage)
    call add_beams(model, links, mechanism)
    call add_beam_mesh(model, links, mechanism)
    call apply_loads(model, assembly%link, pins, mechanism%linkage)
    call append_loads(process_loads(model, assembly%link, pins, mechanism%linkage), &
      mechanism%linkage)
    do i = 1, size(links)
      mechanism%linkage%bodies(i)%forced = forced_places(mechanism%linkage%loads, i)
    end do
    call append_loads(springs_of(model, assembly%link, pins, mechanism%linkage), mechanism%linkage)
    call build_coordinates(model, assembly%link, pins, mechanism%linkage, mechanism%coordinates)
    call append_loads(stops_of(model, mechanism%linkage), mechanism%linkage)
    mechanism%linkage%frictions = frictions_of(model, assembly%link, pins, mechanism%linkage)
    if (has_beams(mechanism)) mechanism%elastic = new_elastic_linkage(mechanism%linkage, &
      mechanism%beams)
    mechanism%points = points_of(model, assembly%link, mechanism%linkage)
    mechanism%response_points = response_points_of(model, assembly%link, assembly%pins, &
      mechanism%linkage)
    mechanism%gauges = gauges_of(model, assembly%link, mechanism%linkage)
    mechanism%is_reversed = runs_against(mechanism%linkage%bodies)
    mechanism%names = token_texts(links%name)
  end function mechanism_of

  !> Lengths of the links along their pins [m].
  pure function link_lengths(mechanism) result(length)
    type(mechanism_t), intent(in) :: mechanism
    real(wp) :: length(size(mechanism%linkage%bodies))

    integer :: b

    do b = 1, size(length)
      length(b) = way_length(mechanism%linkage%bodies(b))
    end do
  end function link_lengths

  !> Whether a link has a material and a section.
  elemental function is_solid(link) result(is)
    type(link_t), intent(in) :: link
    logical :: is

    is = link%material > 0 .and. link%section > 0
  end function is_solid

  !> Sets the stiffnesses of beams, of a link with corners those of all its segments. No beams if a
  !! bending link lacks material or section, or no link bends.
  pure subroutine add_beams(model, links, mechanism)
    type(model_t), intent(in) :: model
    type(link_t), intent(in) :: links(:) !! (bodies)
    type(mechanism_t), intent(inout) :: mechanism

    logical :: beams
    integer :: i

    beams = (any(.not. links%rigid) .or. needs_beams(model)) .and. all(links%rigid .or. &
      is_solid(links))
    allocate (mechanism%beams(merge(size(links), 0, beams)))
    do i = 1, size(links)
      if (.not. is_solid(links(i))) cycle
      if (.not. beams) cycle
      associate (beam => mechanism%beams(i), material => model%materials(links(i)%material), &
          section => model%sections(links(i)%section))
        beam%axial_stiffness = material%youngs_modulus*section%area
        beam%bending_stiffness = material%youngs_modulus*section%second_moment
        beam%shear_stiffness = link_shear_stiffness(model, mechanism%links(i))
        beam%out_of_plane_stiffness = material%youngs_modulus*out_of_plane_second_moment(section)
        if (material%has_ratio) beam%torsional_stiffness = material%youngs_modulus/ &
          (2.0_wp*(1.0_wp + material%poissons_ratio))*torsion_constant(section)
        if (.not. links(i)%rigid) then
          beam%line_density = link_line_density(model, mechanism%links(i))
          beam%rotary_inertia = link_rotary_inertia(model, mechanism%links(i))
        end if
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
    ! Rigid links have no elements, and what they swing on is solved to all digits.
    if (all(links%rigid)) mechanism%accuracy = default_accuracy
    if (.not. is_dyad_linkage(mechanism%linkage)) return
    if (.not. any(links%mesh > 0) .or. any(links%mesh == 0 .and. .not. links%rigid)) return
    mechanism%mesh = new_beam_mesh(mechanism%linkage, elements, order, &
      any(mechanism%beams%shear_stiffness > 0.0_wp))
  end subroutine add_beam_mesh

end module mechanisms
