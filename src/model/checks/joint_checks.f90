!> Checks of PIN, WELD, CLAMP and SLIDER cards: the pins, links and guides that they name.
module joint_checks
  use diagnostics, only: add_error, diagnostics_t
  use joint_cards, only: slider_card_t, weld_t
  use kinds, only: wp
  use link_shapes, only: find_drawn_place
  use models, only: is_end_of_spring, model_t
  use name_checks, only: look_up, pin_names
  use name_index, only: find_name, name_index_t, new_name_index
  use spelling, only: suggestion
  use text, only: append_string, same_word, string_t
  use tokens, only: token_t, token_texts
  implicit none (type, external)
  private

  public :: check_joints, joins, seek_pin, find_way

contains

  !> Looks up what these cards name. Errors: an unknown pin, link or guide, a PIN of a ground pivot,
  !! a weld of a link that is not at the pin, of one link twice, or of links that are not in the
  !! drawing, a clamp at a pin that moves or is of no link, a link clamped twice at a pin, a guide
  !! with the name of a link where either may stand, a block on its own link or twice on one, a
  !! fixed one, an inertia that cannot turn.
  pure subroutine check_joints(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(model_t), intent(inout) :: model             !! numbers of links and guides are set

    type(name_index_t) :: links, guides, pins, grounds
    type(weld_t) :: weld
    type(slider_card_t) :: slider
    integer :: i

    links = new_name_index(token_texts(model%links%name))
    guides = new_name_index(token_texts(model%guides%name))
    pins = new_name_index(token_texts(pin_names(model)))
    grounds = new_name_index(token_texts(model%grounds%pin))
    call check_drawing(diagnostics, model, links, pins, grounds)
    do i = 1, size(model%welds)
      weld = model%welds(i)
      call find_weld(diagnostics, model, links, pins, weld)
      model%welds(i) = weld
    end do
    do i = 1, size(model%clamps)
      weld = model%clamps(i)
      call find_clamp(diagnostics, model, links, pins, grounds, weld)
      model%clamps(i) = weld
    end do
    call refuse_same_clamps(diagnostics, model)
    do i = 1, size(model%sliders)
      slider = model%sliders(i)
      call find_slider(diagnostics, model, links, guides, pins, grounds, slider)
      model%sliders(i) = slider
    end do
    call refuse_same_sliders(diagnostics, model)
  end subroutine check_joints

  !> Whether a link is at a pin: the pin is one of its own, or a POINT on it.
  pure function joins(model, link, name) result(is)
    type(model_t), intent(in) :: model   !! whose points have their links
    integer, intent(in) :: link          !! number in the model
    character(len=*), intent(in) :: name !! of the pin, in any case of letters
    logical :: is

    integer :: i

    is = .true.
    do i = 1, size(model%links(link)%pins)
      if (same_word(model%links(link)%pins(i)%text, name)) return
    end do
    do i = 1, size(model%points)
      if (model%points(i)%link /= link) cycle
      if (same_word(model%points(i)%name%text, name)) return
    end do
    is = .false.
  end function joins

  !> Looks up a pin. Errors: an unknown pin, a link in its place.
  pure subroutine seek_pin(word, pins, links, diagnostics, known)
    type(token_t), intent(in) :: word                 !! without a line if the card lacks it
    type(name_index_t), intent(in) :: pins, links     !! of the deck
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    logical, intent(out) :: known                     !! whether there is such a pin

    known = .false.
    if (word%line == 0) return
    known = find_name(pins, word%text) > 0
    if (known) return
    if (find_name(links, word%text) > 0) then
      call add_error(diagnostics, word, "'"//word%text//"' is a link; a pin is expected here")
    else
      call add_error(diagnostics, word, "unknown pin '"//word%text//"'"//suggestion(word%text, &
        pins%name))
    end if
  end subroutine seek_pin

  !> PIN cards are about moving pins.
  pure subroutine check_drawing(diagnostics, model, links, pins, grounds)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    type(name_index_t), intent(in) :: links, pins, grounds

    integer :: i, ground
    logical :: known

    do i = 1, size(model%drawn_pins)
      associate (pin => model%drawn_pins(i)%pin)
        if (pin%line == 0) cycle
        ground = find_name(grounds, pin%text)
        if (ground > 0) then
          call add_error(diagnostics, pin, "'"//pin%text//"' is a ground pivot and has its "// &
            "place already", model%grounds(ground)%pin, "it is fixed here")
        else if (find_name(pins, pin%text) == 0 .and. has_slider_or_spring(model, pin%text)) then
          call add_error(diagnostics, pin, "pin '"//pin%text//"' is of no link; expected it on "// &
            "the LINK card of the body that slides or is held there (rigid, with 'mass='), or "// &
            "GROUND "//pin%text//" x y for the end of a spring that is fixed")
        else
          call seek_pin(pin, pins, links, diagnostics, known)
        end if
      end associate
    end do
  end subroutine check_drawing

  !> Whether a SLIDER, SPRING or DAMPER card names a pin.
  pure function has_slider_or_spring(model, name) result(holds)
    type(model_t), intent(in) :: model
    character(len=*), intent(in) :: name
    logical :: holds

    integer :: i

    holds = is_end_of_spring(model, name)
    do i = 1, size(model%sliders)
      if (model%sliders(i)%pin%line > 0) holds = holds .or. same_word(model%sliders(i)%pin%text, &
        name)
    end do
  end function has_slider_or_spring

  !> Looks up the links of a weld.
  pure subroutine find_weld(diagnostics, model, links, pins, weld)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    type(name_index_t), intent(in) :: links, pins
    type(weld_t), intent(inout) :: weld

    logical :: known

    if (size(weld%links) == 0) return
    call seek_pin(weld%pin, pins, links, diagnostics, known)
    call find_links(diagnostics, model, links, "is welded to itself", weld, known)
    if (.not. known .or. any(weld%link == 0)) return
    call require_drawn(diagnostics, model, weld, "the angle between welded links is")
  end subroutine find_weld

  !> Looks up the links of a clamp; without names it has all at its pin.
  pure subroutine find_clamp(diagnostics, model, links, pins, grounds, clamp)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    type(name_index_t), intent(in) :: links, pins, grounds
    type(weld_t), intent(inout) :: clamp

    integer :: i
    logical :: known

    call seek_pin(clamp%pin, pins, links, diagnostics, known)
    if (.not. known) return
    if (find_name(grounds, clamp%pin%text) == 0) then
      call add_error(diagnostics, clamp%pin, "a CLAMP holds links at a GROUND pin, and '"// &
        clamp%pin%text//"' moves; expected: GROUND "//clamp%pin%text//" x y, or WELD for links "// &
        "that turn together")
      return
    end if
    if (size(clamp%links) == 0) then
      clamp%link = pack([(i, i=1, size(model%links))], [(joins(model, i, clamp%pin%text), i=1, &
        size(model%links))])
      if (size(clamp%link) == 0) call add_error(diagnostics, clamp%pin, "no link is at pin '"// &
        clamp%pin%text//"': nothing is clamped there")
    else
      call find_links(diagnostics, model, links, "is clamped twice", clamp, known)
    end if
    if (.not. known .or. any(clamp%link == 0)) return
    call require_drawn(diagnostics, model, clamp, "the angle of a clamped link is")
  end subroutine find_clamp

  !> Refuses a link that two cards clamp at a pin.
  pure subroutine refuse_same_clamps(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    integer :: i, k, m

    do i = 2, size(model%clamps)
      others: do k = 1, i - 1
        if (.not. same_word(model%clamps(i)%pin%text, model%clamps(k)%pin%text)) cycle
        do m = 1, size(model%clamps(i)%link)
          if (model%clamps(i)%link(m) == 0) cycle
          if (.not. any(model%clamps(k)%link == model%clamps(i)%link(m))) cycle
          call add_error(diagnostics, model%clamps(i)%pin, "link '"// &
            model%links(model%clamps(i)%link(m))%name%text//"' is clamped at '"// &
            model%clamps(i)%pin%text//"' already; expected the names of other links, or no "// &
            "second card", model%clamps(k)%pin, "by this card")
          exit others
        end do
      end do others
    end do
  end subroutine refuse_same_clamps

  !> Looks up the links that a weld or a clamp names. `known` is whether they can be told.
  pure subroutine find_links(diagnostics, model, links, twice, weld, known)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    type(name_index_t), intent(in) :: links
    character(len=*), intent(in) :: twice !! what is said of a link that is named twice
    type(weld_t), intent(inout) :: weld
    logical, intent(inout) :: known !! whether the pin is

    integer :: i, k

    do i = 1, size(weld%links)
      associate (word => weld%links(i))
        call look_up(word, links, "link", diagnostics, weld%link(i))
        if (weld%link(i) == 0 .or. .not. known) cycle
        if (.not. joins(model, weld%link(i), weld%pin%text)) then
          call add_error(diagnostics, word, "link '"//word%text//"' is not at pin '"// &
            weld%pin%text//"'", model%links(weld%link(i))%name, "its pins are here")
          known = .false.
          cycle
        end if
        do k = 1, i - 1
          if (weld%link(k) /= weld%link(i)) cycle
          call add_error(diagnostics, word, "link '"//word%text//"' "//twice, &
            weld%links(k), "first named here")
          exit
        end do
      end associate
    end do
  end subroutine find_links

  !> The angles of welded and of clamped links are those of the drawing.
  pure subroutine require_drawn(diagnostics, model, weld, what)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    type(weld_t), intent(in) :: weld
    character(len=*), intent(in) :: what

    type(string_t), allocatable :: told(:)
    real(wp) :: place(2)
    integer :: i, k
    logical :: is_drawn

    do i = 1, size(weld%link)
      associate (link => model%links(weld%link(i)))
        do k = 1, size(link%pins)
          call find_drawn_place(model, link%pins(k)%text, place, is_drawn)
          if (.not. is_drawn) call append_once(told, link%pins(k)%text)
        end do
      end associate
    end do
    if (.not. allocated(told)) return
    call add_error(diagnostics, weld%pin, what//" that of the drawing; expected "// &
      pins_in_words(told))
  end subroutine require_drawn

  pure subroutine append_once(list, name)
    type(string_t), allocatable, intent(inout) :: list(:)
    character(len=*), intent(in) :: name

    integer :: i

    if (allocated(list)) then
      do i = 1, size(list)
        if (same_word(list(i)%text, name)) return
      end do
    end if
    call append_string(list, name)
  end subroutine append_once

  !> `PIN cards for 'A' and 'B'`
  pure function pins_in_words(names) result(words)
    type(string_t), intent(in) :: names(:)
    character(len=:), allocatable :: words

    integer :: i

    words = "PIN cards for "
    if (size(names) == 1) words = "a PIN card for "
    do i = 1, size(names)
      if (i > 1 .and. i < size(names)) words = words//", "
      if (i > 1 .and. i == size(names)) words = words//" and "
      words = words//"'"//names(i)%text//"'"
    end do
  end function pins_in_words

  !> Looks up the names of a SLIDER card.
  pure subroutine find_slider(diagnostics, model, links, guides, pins, grounds, slider)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    type(name_index_t), intent(in) :: links, guides, pins, grounds
    type(slider_card_t), intent(inout) :: slider

    integer :: ground
    logical :: known

    if (slider%pin%line == 0 .or. slider%on%line == 0) return
    ground = find_name(grounds, slider%pin%text)
    known = ground > 0
    if (.not. known) call seek_pin(slider%pin, pins, links, diagnostics, known)
    call find_way(diagnostics, model, links, guides, slider%on, slider%guide, slider%link)
    if (slider%guide > 0 .and. ground > 0) then
      call add_error(diagnostics, slider%pin, "'"//slider%pin%text//"' is fixed and cannot "// &
        "slide along a guide", model%grounds(ground)%pin, "it is fixed here")
    else if (slider%link > 0 .and. known) then
      if (joins(model, slider%link, slider%pin%text)) call add_error(diagnostics, slider%on, &
        "pin '"//slider%pin%text//"' belongs to link '"//slider%on%text//"' and cannot slide "// &
        "along it", model%links(slider%link)%name, "its pins are here")
    end if
    if (slider%turned%line > 0) call find_turned_link(diagnostics, model, links, known, slider)
    if (slider%guide > 0 .and. slider%turned%line == 0 .and. slider%inertia_word%line > 0) &
      call add_error(diagnostics, slider%inertia_word, "a block on a fixed guide does not "// &
      "turn: 'inertia=' has no meaning here")
  end subroutine find_slider

  !> Looks up a guide or a link, along which a block slides or a place is measured. Errors: it is
  !! neither, or both.
  pure subroutine find_way(diagnostics, model, links, guides, word, guide, link)
    type(diagnostics_t), intent(inout) :: diagnostics   !! errors are added
    type(model_t), intent(in) :: model                  !! its guides
    type(name_index_t), intent(in) :: links, guides     !! of the deck
    type(token_t), intent(in) :: word                   !! the name, in the deck
    integer, intent(out) :: guide, link                 !! its number, and 0; both 0: unknown

    type(string_t), allocatable :: names(:)
    integer :: i

    guide = find_name(guides, word%text)
    link = find_name(links, word%text)
    if (guide > 0 .and. link > 0) then
      call add_error(diagnostics, word, "'"//word%text//"' is a guide and a link; "// &
        "here either may stand, so they need different names", model%guides(guide)%name, &
        "the guide is here")
      link = 0
    else if (guide == 0 .and. link == 0) then
      allocate (names(size(guides%name) + size(links%name)))
      do i = 1, size(guides%name)
        names(i)%text = guides%name(i)%text
      end do
      do i = 1, size(links%name)
        names(size(guides%name) + i)%text = links%name(i)%text
      end do
      call add_error(diagnostics, word, "unknown guide or link '"//word%text//"'"// &
        suggestion(word%text, names))
    end if
  end subroutine find_way

  !> Looks up the link that cannot turn on a block.
  pure subroutine find_turned_link(diagnostics, model, links, known, slider)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    type(name_index_t), intent(in) :: links
    logical, intent(in) :: known !! the pin is
    type(slider_card_t), intent(inout) :: slider

    call look_up(slider%turned, links, "link", diagnostics, slider%turned_link)
    if (slider%turned_link == 0 .or. .not. known) return
    if (joins(model, slider%turned_link, slider%pin%text)) return
    call add_error(diagnostics, slider%turned, "link '"//slider%turned%text// &
      "' is not at pin '"//slider%pin%text//"'", model%links(slider%turned_link)%name, &
      "its pins are here")
  end subroutine find_turned_link

  !> One block at a pin slides along one guide.
  pure subroutine refuse_same_sliders(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    type(string_t) :: pairs(size(model%sliders))
    type(name_index_t) :: list
    integer :: i, first

    do i = 1, size(pairs)
      pairs(i)%text = model%sliders(i)%pin%text//" "//model%sliders(i)%on%text
    end do
    list = new_name_index(pairs)
    do i = 1, size(pairs)
      first = find_name(list, pairs(i)%text)
      if (first == i .or. model%sliders(i)%on%line == 0) cycle
      call add_error(diagnostics, model%sliders(i)%pin, "pin '"//model%sliders(i)%pin%text// &
        "' slides along '"//model%sliders(i)%on%text//"' already", model%sliders(first)%pin, &
        "the first SLIDER is here")
    end do
  end subroutine refuse_same_sliders

end module joint_checks
