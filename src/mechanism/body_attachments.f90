!> Model → masses and points on the bodies of the linkage, and external loads. Places are turned
!! from the axes of the LINK card into those of the body.
module body_attachments
  use applied_load_types, only: applied_load_t
  use kinds, only: wp
  use link_bodies, only: link_center, link_inertia
  use link_cards, only: has_own_mass, link_t
  use link_shapes, only: find_link_shape
  use linkages, only: body_t, linkage_t, lump_t, turned, turned_back
  use models, only: inertia_lumped, link_line_density, link_mass, model_t
  use name_index, only: find_name, name_index_t
  use shear, only: link_rotary_inertia
  implicit none (type, external)
  private

  public :: body_point_t, attach_masses, apply_loads, append_loads, points_of, &
    place_on_body, place_on_card, runs_against

  !> A point fixed to a body.
  type :: body_point_t
    character(len=:), allocatable :: name
    integer :: body = 0           !! number in the linkage, from 1
    real(wp) :: place(2) = 0.0_wp !! from the first pin, in the axes of the body [m]
  end type body_point_t

contains

  !> Gives every body its masses: a link without a mass of its own is uniform along the segments of
  !! its card; one with a mass of its own is a lump; so is each MASS card, and each block that turns
  !! with the link. Blocks and PINMASS cards are masses at pins.
  pure subroutine attach_masses(model, links, pins, linkage)
    type(model_t), intent(in) :: model        !! without errors
    integer, intent(in) :: links(:)           !! (bodies) numbers of their links in the model
    type(name_index_t), intent(in) :: pins    !! names of the pins
    type(linkage_t), intent(inout) :: linkage !! the masses of its bodies and pins are replaced

    integer :: i, k

    do i = 1, size(links)
      associate (link => model%links(links(i)), body => linkage%bodies(i))
        deallocate (body%lumps)
        allocate (body%lumps(0))
        body%line_density = 0.0_wp
        if (has_own_mass(link)) then
          call append_lump(body, own_lump(model, links(i), body))
        else if (is_uniform(link, body)) then
          body%line_density = link_line_density(model, links(i))
          if (link%material > 0 .and. link%section > 0) body%rotary_inertia = &
            link_rotary_inertia(model, links(i))
        else
          call attach_segments(model, links(i), body)
        end if
        body%own_lumps = size(body%lumps)
        do k = 1, size(model%masses)
          if (model%masses(k)%link /= links(i)) cycle
          call append_lump(body, lump_t(model%masses(k)%mass, place_on_body(body, &
            model%masses(k)%place), model%masses(k)%inertia))
        end do
        do k = 1, size(model%sliders)
          ! A block turns with the link that it slides along.
          if (model%sliders(k)%link /= links(i) .or. model%sliders(k)%inertia <= 0.0_wp) cycle
          call append_lump(body, lump_t(0.0_wp, [0.0_wp, 0.0_wp], model%sliders(k)%inertia))
        end do
      end associate
    end do
    linkage%pin_mass = 0.0_wp
    do i = 1, size(model%pin_masses)
      k = find_name(pins, model%pin_masses(i)%pin%text)
      if (k > 0) linkage%pin_mass(k) = model%pin_masses(i)%mass
    end do
    do i = 1, size(model%sliders)
      k = find_name(pins, model%sliders(i)%pin%text)
      linkage%pin_mass(k) = linkage%pin_mass(k) + model%sliders(i)%mass
    end do
    where (linkage%is_ground) linkage%pin_mass = 0.0_wp
  end subroutine attach_masses

  !> Whether a body is the straight way between the two pins of its card.
  pure function is_uniform(link, body) result(is)
    type(link_t), intent(in) :: link
    type(body_t), intent(in) :: body
    logical :: is

    is = size(link%pins) == 2 .and. abs(body%card_axis(2)) <= 0.0_wp .and. &
      (body%card_axis(1) > 0.0_wp .and. abs(body%origin(1)) <= 0.0_wp .or. &
      body%card_axis(1) < 0.0_wp .and. abs(body%origin(1) - body%length) <= 0.0_wp) .and. &
      abs(body%length - link%length) <= 1.0e-12_wp*link%length
  end function is_uniform

  !> A lump for every straight segment of a link, with its mass centre and moment of inertia.
  pure subroutine attach_segments(model, number, body)
    type(model_t), intent(in) :: model
    integer, intent(in) :: number !! of the link in the model
    type(body_t), intent(inout) :: body

    real(wp), allocatable :: places(:, :)
    real(wp) :: way(2), length, density, rotary
    logical :: known
    integer :: i, k, elements

    associate (link => model%links(number))
      if (link%material == 0 .or. link%section == 0) return
      density = link_line_density(model, number)
      rotary = link_rotary_inertia(model, number)
      elements = 0
      if (link%mesh > 0 .and. model%inertia == inertia_lumped) elements = &
        model%meshes(link%mesh)%elements
      call find_link_shape(model, link, places, known)
      do i = 1, size(places, 2)
        k = i + 1
        if (i == size(places, 2)) then
          if (.not. link%is_closed) exit
          k = 1
        end if
        way = places(:, k) - places(:, i)
        length = norm2(way)
        call append_lump(body, lump_t(density*length, place_on_body(body, places(:, i) + &
          0.5_wp*way), density*length**3/12.0_wp + rotary*length, rotary*length))
        ! Half the mass of an element is farther out than where it is along the link.
        if (elements == 0) cycle
        associate (lump => body%lumps(size(body%lumps)))
          lump%inertia = density*length**3*(1.0_wp/12.0_wp + 1.0_wp/(6.0_wp*real(elements, wp)**2))
          lump%rotary_inertia = 0.0_wp
        end associate
      end do
    end associate
  end subroutine attach_segments

  pure subroutine append_lump(body, lump)
    type(body_t), intent(inout) :: body
    type(lump_t), intent(in) :: lump

    type(lump_t), allocatable :: longer(:)

    allocate (longer(size(body%lumps) + 1))
    longer(:size(body%lumps)) = body%lumps
    longer(size(longer)) = lump
    call move_alloc(longer, body%lumps)
  end subroutine append_lump

  !> The lump of a link with a mass of its own: mass, mass centre, moment of inertia.
  pure function own_lump(model, link, body) result(lump)
    type(model_t), intent(in) :: model
    integer, intent(in) :: link !! number in the model
    type(body_t), intent(in) :: body
    type(lump_t) :: lump

    lump%mass = link_mass(model, link)
    lump%place = place_on_body(body, link_center(model, link))
    lump%inertia = link_inertia(model, link)
  end function own_lump

  !> A place on a link in the axes of its body.
  pure function place_on_body(body, place) result(turned_place)
    type(body_t), intent(in) :: body !! with the axes of its card
    real(wp), intent(in) :: place(2) !! from the first pin of the card: along the link, and to its
                                     !! left [m]
    real(wp) :: turned_place(2)      !! from the first pin of the body, in its axes [m]

    turned_place = body%origin + turned(place, body%card_axis)
  end function place_on_body

  !> A place on a body in the axes of its LINK card.
  pure function place_on_card(body, place) result(turned_place)
    type(body_t), intent(in) :: body !! with the axes of its card
    real(wp), intent(in) :: place(2) !! from the first pin of the body, in its axes [m]
    real(wp) :: turned_place(2)      !! from the first pin of the card: along the link, and to its
                                     !! left [m]

    turned_place = turned_back(place - body%origin, body%card_axis)
  end function place_on_card

  !> Whether a body runs from the second pin of its LINK card to the first.
  elemental function runs_against(body) result(against)
    type(body_t), intent(in) :: body !! with the axes of its card
    logical :: against

    against = body%card_axis(1) < 0.0_wp
  end function runs_against

  !> Sets gravity, constant forces on pins and constant torques on links.
  pure subroutine apply_loads(model, links, pins, linkage)
    type(model_t), intent(in) :: model        !! without errors
    integer, intent(in) :: links(:)           !! (bodies) numbers of their links in the model
    type(name_index_t), intent(in) :: pins    !! names of the pins
    type(linkage_t), intent(inout) :: linkage !! its external loads are set

    integer :: i, k

    linkage%gravity = model%gravity
    do i = 1, size(model%forces)
      k = find_name(pins, model%forces(i)%pin%text)
      if (k > 0) linkage%pin_force(:, k) = model%forces(i)%force
    end do
    do i = 1, size(model%torques)
      linkage%couple(findloc(links, model%torques(i)%link, dim=1)) = model%torques(i)%torque
    end do
  end subroutine apply_loads

  !> Appends loads to those of a linkage.
  pure subroutine append_loads(loads, linkage)
    type(applied_load_t), intent(in) :: loads(:)
    type(linkage_t), intent(inout) :: linkage

    type(applied_load_t), allocatable :: longer(:)
    integer :: before

    before = size(linkage%loads)
    allocate (longer(before + size(loads)))
    longer(:before) = linkage%loads
    longer(before + 1:) = loads
    call move_alloc(longer, linkage%loads)
  end subroutine append_loads

  !> The points whose paths are requested, in the order of the deck.
  pure function points_of(model, links, linkage) result(points)
    type(model_t), intent(in) :: model           !! without errors
    integer, intent(in) :: links(:)              !! (bodies) numbers of their links in the model
    type(linkage_t), intent(in) :: linkage       !! its bodies
    type(body_point_t), allocatable :: points(:) !! (points)

    integer :: i

    allocate (points(size(model%points)))
    do i = 1, size(points)
      points(i)%name = model%points(i)%name%text
      points(i)%body = findloc(links, model%points(i)%link, dim=1)
      points(i)%place = place_on_body(linkage%bodies(points(i)%body), model%points(i)%place)
    end do
  end function points_of

end module body_attachments
