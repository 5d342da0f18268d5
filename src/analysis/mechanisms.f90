!> Model → what mechanics works on: the linkage, its beams, its mesh.
module mechanisms
  use beam_mesh, only: beam_mesh_t, beam_t, new_beam_mesh
  use kinds, only: wp
  use linkages, only: linkage_t, new_four_bar
  use linkage_cards, only: link_t
  use models, only: branch_crossed, model_t
  use shear, only: link_rotary_inertia, link_shear_stiffness
  use text, only: same_word, string_t
  use tokens, only: token_texts
  implicit none (type, external)
  private

  public :: mechanism_t, new_mechanism, mesh_with, has_beams, has_mesh

  type :: mechanism_t
    type(linkage_t) :: linkage
    type(beam_t), allocatable :: beams(:)     !! (bodies); empty if a link has no material or section
    type(beam_mesh_t) :: mesh                 !! without unknowns if a link has no mesh
    real(wp) :: accuracy = 0.0_wp             !! of frequencies, where the deck leaves the mesh to the program; else 0
    type(string_t), allocatable :: names(:)   !! (bodies) of the links
    type(string_t), allocatable :: pin_names(:) !! (pins)
  end type mechanism_t

contains

  !> Puts the links in the order round the loop.
  pure function new_mechanism(model) result(mechanism)
    type(model_t), intent(in) :: model
    type(mechanism_t) :: mechanism

    real(wp) :: ground(2, 2), length(3), line_density(3), pin_mass(2)
    type(link_t) :: links(3)
    integer :: i, k
    logical :: beams, meshed

    ground = reshape([ground_at(model, 1), ground_at(model, 4)], [2, 2])
    pin_mass = 0.0_wp
    do i = 1, size(model%pin_masses)
      do k = 1, 2
        if (same_word(model%pin_masses(i)%pin%text, model%loop_pins(k + 1)%text)) pin_mass(k) = model%pin_masses(i)%mass
      end do
    end do
    links = model%links(model%loop)
    length = links%length
    beams = all(links%material > 0 .and. links%section > 0)
    meshed = all(links%mesh > 0)
    line_density = 0.0_wp
    allocate (mechanism%beams(merge(3, 0, beams)))
    if (beams) then
      line_density = model%materials(links%material)%density*model%sections(links%section)%area
      mechanism%beams%axial_stiffness = model%materials(links%material)%youngs_modulus*model%sections(links%section)%area
      mechanism%beams%bending_stiffness = model%materials(links%material)%youngs_modulus* &
        model%sections(links%section)%second_moment
    end if
    mechanism%linkage = new_four_bar(ground, length, line_density, pin_mass, model%branch == branch_crossed)
    if (beams) then
      mechanism%linkage%bodies%rotary_inertia = [(link_rotary_inertia(model, model%loop(i)), i=1, 3)]
      mechanism%beams%shear_stiffness = [(link_shear_stiffness(model, model%loop(i)), i=1, 3)]
    end if
    if (meshed) then
      mechanism%mesh = new_beam_mesh(mechanism%linkage, model%meshes(links%mesh)%elements, model%meshes(links%mesh)%order, &
        any(mechanism%beams%shear_stiffness > 0.0_wp))
      mechanism%accuracy = maxval(model%meshes(links%mesh)%accuracy)
    end if
    mechanism%names = token_texts(links%name)
    mechanism%pin_names = token_texts(model%loop_pins)

  end function new_mechanism

  !> Position of the ground pivot at a place of the loop [m].
  pure function ground_at(model, place) result(position)
    type(model_t), intent(in) :: model
    integer, intent(in) :: place
    real(wp) :: position(2)

    integer :: n

    position = 0.0_wp
    do n = 1, size(model%grounds)
      if (same_word(model%grounds(n)%pin%text, model%loop_pins(place)%text)) position = model%grounds(n)%position
    end do
  end function ground_at

  !> The same mechanism with another number of elements on each body.
  pure function mesh_with(mechanism, elements) result(other)
    type(mechanism_t), intent(in) :: mechanism
    integer, intent(in) :: elements(:) !! (bodies)
    type(mechanism_t) :: other

    other = mechanism
    other%mesh = new_beam_mesh(mechanism%linkage, elements, mechanism%mesh%order, mechanism%mesh%sheared)
  end function mesh_with

  pure function has_beams(mechanism) result(has)
    type(mechanism_t), intent(in) :: mechanism
    logical :: has

    has = size(mechanism%beams) > 0
  end function has_beams

  pure function has_mesh(mechanism) result(has)
    type(mechanism_t), intent(in) :: mechanism
    logical :: has

    has = mechanism%mesh%unknowns > 0
  end function has_mesh

end module mechanisms
