!> Checks of MASS, POINT, FORCE and TORQUE cards: the links and pins that they name, and
!! whether rigid bodies have all their data.
module body_checks
  use diagnostics, only: add_error, add_warning, diagnostics_t
  use kinds, only: wp
  use link_bodies, only: link_center, link_inertia, uniform_center
  use link_cards, only: link_t
  use link_checks, only: is_ram
  use models, only: is_moving, model_t, needs_masses
  use name_checks, only: link_ends, look_up, pin_names
  use name_index, only: find_name, name_index_t, new_name_index
  use text, only: same_word, to_string
  use tokens, only: token_t, token_texts
  use units, only: coherent_unit, dimension_inertia, dimension_length, from_si, unit_t
  implicit none (type, external)
  private

  public :: check_bodies, warn_of_far_centers, seek_link, seek_loaded_pin

contains

  !> Looks up the links of all these cards. Errors: an unknown link or pin, a point named like a
  !! pin of its own link or a ground pivot, a force on a ground pivot, a ram with a mass but no
  !! moment of inertia.
  pure subroutine check_bodies(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(model_t), intent(inout) :: model             !! has its links with materials and sections;
                                                      !! link numbers of the cards are set

    type(name_index_t) :: links, pins
    integer :: i

    links = new_name_index(token_texts(model%links%name))
    pins = new_name_index(token_texts(link_ends(model%links)))
    do i = 1, size(model%masses)
      call seek_link(model%masses(i)%link_name, links, pins, diagnostics, model%masses(i)%link)
    end do
    do i = 1, size(model%points)
      call seek_link(model%points(i)%link_name, links, pins, diagnostics, model%points(i)%link)
    end do
    do i = 1, size(model%torques)
      call seek_link(model%torques(i)%link_name, links, pins, diagnostics, model%torques(i)%link)
    end do
    call check_points(diagnostics, model)
    call check_forces(diagnostics, model)
    do i = 1, size(model%links)
      call check_inertia(diagnostics, model, model%links(i))
    end do
  end subroutine check_bodies

  !> Looks up a link. Errors: an unknown link; a pin in its place.
  pure subroutine seek_link(word, links, pins, diagnostics, link)
    type(token_t), intent(in) :: word                 !! without a line if the card lacks it
    type(name_index_t), intent(in) :: links, pins     !! of the deck
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    integer, intent(inout) :: link                    !! unchanged if the card lacks it, 0 if
                                                      !! unknown

    if (word%line == 0) return
    if (find_name(links, word%text) == 0 .and. find_name(pins, word%text) > 0) then
      link = 0
      call add_error(diagnostics, word, "'"//word%text//"' is a pin; this card takes a link")
    else
      call look_up(word, links, "link", diagnostics, link)
    end if
  end subroutine seek_link

  !> Refuses points named like pins of their own links, or like ground pivots: a point with the name
  !! of another link's pin is that pin.
  pure subroutine check_points(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    type(name_index_t) :: grounds
    integer :: i, k, number

    grounds = new_name_index(token_texts(model%grounds%pin))
    do i = 1, size(model%points)
      associate (name => model%points(i)%name)
        if (name%line == 0) cycle
        number = find_name(grounds, name%text)
        if (number > 0) call add_error(diagnostics, name, "the point '"//name%text// &
          "' has the name of a ground pivot", model%grounds(number)%pin, "the pivot is here")
        if (model%points(i)%link == 0) cycle
        associate (link => model%links(model%points(i)%link))
          do k = 1, size(link%pins)
            if (.not. same_word(link%pins(k)%text, name%text)) cycle
            call add_error(diagnostics, name, "the point '"//name%text// &
              "' has the name of a pin of its own link", link%pins(k), "the pin is here")
          end do
        end associate
      end associate
    end do
  end subroutine check_points

  !> Forces must act on moving pins or points.
  pure subroutine check_forces(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    type(name_index_t) :: pins, grounds, links
    integer :: i

    pins = new_name_index(token_texts(pin_names(model)))
    grounds = new_name_index(token_texts(model%grounds%pin))
    links = new_name_index(token_texts(model%links%name))
    do i = 1, size(model%forces)
      call seek_loaded_pin(model%forces(i)%pin, pins, grounds, links, model, diagnostics)
    end do
  end subroutine check_forces

  !> Looks up a pin on which a load acts. Errors: an unknown pin; a fixed one; a link in its place.
  pure subroutine seek_loaded_pin(pin, pins, grounds, links, model, diagnostics)
    type(token_t), intent(in) :: pin                  !! without a line if the card lacks it
    type(name_index_t), intent(in) :: pins, grounds, links !! of the deck
    type(model_t), intent(in) :: model                !! its GROUND cards
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added

    integer :: number

    if (pin%line == 0) return
    number = find_name(grounds, pin%text)
    if (number > 0) then
      call add_error(diagnostics, pin, &
        "a load on a fixed pin: it would act on nothing but the ground", &
        model%grounds(number)%pin, "'"//pin%text//"' is fixed here")
    else if (find_name(pins, pin%text) > 0) then
      return
    else if (find_name(links, pin%text) > 0) then
      call add_error(diagnostics, pin, "'"//pin%text//"' is a link; a FORCE on a link needs "// &
        "its place there, 'at='")
    else
      call look_up(pin, pins, "pin", diagnostics, number)
    end if
  end subroutine seek_loaded_pin

  !> A link with `mass=` has the moment of inertia of the uniform link, unless its card gives
  !! another; one that changes its length has none, without material and section.
  pure subroutine check_inertia(diagnostics, model, link)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    type(link_t), intent(in) :: link

    if (.not. link%has_mass .or. link%has_inertia) return
    if (link%material_name%line > 0 .and. link%section_name%line > 0) return
    if (.not. is_ram(model, link)) return
    call add_error(diagnostics, link%body_word, "link '"//link%name%text// &
      "' has a mass, no moment of inertia, and no length of its own; expected "// &
      "'inertia=' about its mass centre")
  end subroutine check_inertia

  !> A mass that lies beside its link is no uniform bar from pin to pin, whose moment of inertia it
  !! has by default.
  pure subroutine warn_of_far_centers(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics !! warnings are added
    type(model_t), intent(in) :: model                !! with the lengths of its links

    type(unit_t) :: length, inertia
    real(wp) :: way
    integer :: i

    if (.not. (needs_masses(model) .and. is_moving(model) .or. any(model%reports%kind%weighs))) &
      return
    length = coherent_unit(model%units, dimension_length)
    inertia = coherent_unit(model%units, dimension_inertia)
    do i = 1, size(model%links)
      associate (link => model%links(i))
        way = norm2(link_center(model, i) - uniform_center(model, i))
        if (link%has_inertia .or. .not. link%mass > 0.0_wp .or. .not. link%length > 0.0_wp .or. &
          way <= link%length) cycle
        call add_warning(diagnostics, link%body_word, "the mass of link '"//link%name%text// &
          "' lies "//to_string(from_si(way, length), 4)//" "//length%name//" beside the middle "// &
          "of its pins, and it has the moment of inertia of a bar of "// &
          to_string(from_si(link%length, length), 4)//" "//length%name//", "// &
          to_string(from_si(link_inertia(model, i), inertia), 4)//" "//inertia%name// &
          "; expected 'inertia='", amount=way/link%length)
      end associate
    end do
  end subroutine warn_of_far_centers

end module body_checks
