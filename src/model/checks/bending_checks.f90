!> What a link that bends cannot have: pins beside its axis, masses and forces beyond its ends, a
!! length that is driven.
module bending_checks
  use diagnostics, only: add_error, diagnostics_t
  use kinds, only: wp
  use link_axis, only: foot_on_axis, foot_t, lies_on_axis
  use link_checks, only: is_ram
  use link_shapes, only: find_link_shape
  use models, only: is_four_bar, is_pin, model_t, needs_frequencies
  use process_cards, only: process_force
  use text, only: same_word
  implicit none (type, external)
  private

  public :: check_bending, carries_pin, check_forces_on_links

  !> Least distance of two pins along a link, as a share of its length [-].
  real(wp), parameter :: least_distance = 1.0e-6_wp

contains

  !> Checks the links that bend. Errors: a driven length; a point that is a pin beside the axis,
  !! beyond an end or where another pin is; a point that makes it longer for a block; a mass or a
  !! force beyond an end; a force beside the axis
  !! with shear and without rotary inertia.
  pure subroutine check_bending(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(model_t), intent(in) :: model                !! whose masses, points and forces have their
                                                      !! links

    integer :: i

    do i = 1, size(model%links)
      associate (link => model%links(i))
        if (link%rigid .or. .not. is_ram(model, link)) cycle
        call add_error(diagnostics, link%name, "the length of link '"//link%name%text// &
          "' is driven, and a link that bends has a length of its own; expected 'rigid' on "// &
          "this card")
      end associate
    end do
    do i = 1, size(model%points)
      if (carries_pin(model, i)) then
        call check_point(diagnostics, model, i)
      else
        call check_reach(diagnostics, model, i)
      end if
    end do
    do i = 1, size(model%masses)
      call check_mass(diagnostics, model, i)
    end do
    if (needs_frequencies(model)) call check_forces_on_links(diagnostics, model, .false.)
  end subroutine check_bending

  !> Forces at places of links that bend. Errors: beyond an end; beside the axis with shear and
  !! without rotary inertia.
  pure subroutine check_forces_on_links(diagnostics, model, with_moving)
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(model_t), intent(in) :: model                !! whose forces have their links
    logical, intent(in) :: with_moving                !! those that depend on the motion, too: they
                                                      !! have no part in frequencies

    integer :: i

    do i = 1, size(model%processes)
      if (model%processes(i)%during == 0 .or. with_moving) call check_force(diagnostics, model, i)
    end do
  end subroutine check_forces_on_links

  !> Whether a point is a pin of its link: other cards take its name for that of a pin.
  pure function carries_pin(model, number) result(is)
    type(model_t), intent(in) :: model !! as read
    integer, intent(in) :: number      !! of the point in the model
    logical :: is

    integer :: i

    associate (name => model%points(number)%name)
      is = is_pin(model, name%text)
      do i = 1, size(model%sliders)
        is = is .or. same_word(model%sliders(i)%pin%text, name%text)
      end do
      if (is .or. is_four_bar(model)) return
      do i = 1, size(model%drawn_pins)
        is = is .or. same_word(model%drawn_pins(i)%pin%text, name%text)
      end do
    end associate
  end function carries_pin

  !> The foot of a place on the axis of a link that bends, if its shape is known.
  pure subroutine find_foot(model, link, place, places, foot, known)
    type(model_t), intent(in) :: model
    integer, intent(in) :: link        !! number in the model; 0: unknown
    real(wp), intent(in) :: place(2)   !! in the axes of its card [m]
    real(wp), allocatable, intent(out) :: places(:, :) !! (2, pins) of its pins [m]
    type(foot_t), intent(out) :: foot
    logical, intent(out) :: known      !! false of rigid links too

    known = .false.
    if (link == 0) return
    if (model%links(link)%rigid .or. .not. model%links(link)%length > 0.0_wp) return
    call find_link_shape(model, model%links(link), places, known)
    if (known) foot = foot_on_axis(places, model%links(link)%is_closed, place)
  end subroutine find_foot

  !> A pin divides the axis of the link, so it must be on it.
  pure subroutine check_point(diagnostics, model, number)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    integer, intent(in) :: number !! of the point

    type(foot_t) :: foot
    real(wp), allocatable :: places(:, :)
    real(wp) :: apart
    integer :: i
    logical :: known

    associate (point => model%points(number))
      call find_foot(model, point%link, point%place, places, foot, known)
      if (.not. known) return
      associate (link => model%links(point%link))
        apart = least_distance*link%length
        if (foot%beyond > apart) then
          call add_error(diagnostics, point%name, "point '"//point%name%text//"' is a pin "// &
            "beyond the end of link '"//link%name%text//"', which bends between its pins; "// &
            "expected this pin on the LINK card, or a rigid link", link%name, "the link is here")
          return
        else if (.not. lies_on_axis(places, foot)) then
          call add_error(diagnostics, point%name, "point '"//point%name%text//"' is a pin "// &
            "beside the axis of link '"//link%name%text//"', which bends; expected 'offset=0', "// &
            "a rigid link, or a LINK to '"//point%name%text//"' that a WELD joins to it", &
            link%name, "the link is here")
          return
        end if
        do i = 1, size(places, 2)
          if (norm2(places(:, i) - point%place) > apart) cycle
          call add_error(diagnostics, point%name, "point '"//point%name%text//"' is at pin '"// &
            link%pins(i)%text//"' of its link; expected the name of the pin in its place", &
            link%pins(i), "the pin is here")
          return
        end do
        do i = 1, number - 1
          if (model%points(i)%link /= point%link .or. .not. carries_pin(model, i)) cycle
          if (norm2(model%points(i)%place - point%place) > apart) cycle
          call add_error(diagnostics, point%name, "point '"//point%name%text//"' is where "// &
            "point '"//model%points(i)%name%text//"' is, and both are pins of link '"// &
            link%name%text//"'", model%points(i)%name, "the other one is here")
          return
        end do
      end associate
    end associate
  end subroutine check_point

  !> A point beyond an end of a link along which a block slides says how far this reaches. One that
  !! bends ends at its pins.
  pure subroutine check_reach(diagnostics, model, number)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    integer, intent(in) :: number !! of the point

    type(foot_t) :: foot
    real(wp), allocatable :: places(:, :)
    logical :: known

    associate (point => model%points(number))
      if (.not. any(model%sliders%link == point%link)) return
      call find_foot(model, point%link, point%place, places, foot, known)
      if (.not. known) return
      if (foot%beyond <= least_distance*model%links(point%link)%length .or. &
        abs(point%place(2)) > 0.0_wp) return
      call add_error(diagnostics, point%name, "point '"//point%name%text//"' is beyond the end "// &
        "of link '"//model%links(point%link)%name%text//"', which bends between its pins; "// &
        "expected this pin on the LINK card, or a rigid link", model%links(point%link)%name, &
        "the link is here")
    end associate
  end subroutine check_reach

  !> A mass is fixed to a cross-section of the beam that carries it, so there must be one at its
  !! place along the link.
  pure subroutine check_mass(diagnostics, model, number)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    integer, intent(in) :: number !! of the mass

    type(foot_t) :: foot
    real(wp), allocatable :: places(:, :)
    logical :: known

    associate (mass => model%masses(number))
      call find_foot(model, mass%link, mass%place, places, foot, known)
      if (.not. known .or. .not. foot%beyond > 0.0_wp) return
      associate (link => model%links(mass%link))
        call add_error(diagnostics, mass%place_word, "a mass beyond the end of link '"// &
          link%name%text//"', which bends; "// &
          "expected 'at=' from 0 to its length, or a rigid link", link%length_word, &
          "its length is given here")
      end associate
    end associate
  end subroutine check_mass

  !> So is a force. Beside the axis it turns its cross-section, which has no inertia of its own with
  !! shear alone.
  pure subroutine check_force(diagnostics, model, number)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    integer, intent(in) :: number !! of the card

    type(foot_t) :: foot
    real(wp), allocatable :: places(:, :)
    logical :: known

    associate (process => model%processes(number))
      if (process%kind /= process_force .or. process%link == 0) return
      call find_foot(model, process%link, process%place, places, foot, known)
      if (.not. known) return
      associate (link => model%links(process%link))
        if (foot%beyond > 0.0_wp) then
          call add_error(diagnostics, process%place_word, "a force beyond the end of link '"// &
            link%name%text//"', which bends; "// &
            "expected 'at=' from 0 to its length, or a rigid link", link%length_word, &
            "its length is given here")
        else if (.not. lies_on_axis(places, foot) .and. model%shear .and. .not. model%rotary) then
          call add_error(diagnostics, process%place_word, "a force beside the axis of link '"// &
            link%name%text//"', which bends, turns a cross-section without inertia; "// &
            "expected 'offset=0', or EFFECTS with 'rotary' beside 'shear'", model%shear_word, &
            "shear is asked for here")
        end if
      end associate
    end associate
  end subroutine check_force

end module bending_checks
