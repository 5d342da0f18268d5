!> Reading of SPRING and DAMPER cards, whose form depends on the names of links, and checks of the
!! links, pins and points that they name.
module spring_checks
  use body_checks, only: seek_link
  use cards, only: card_t
  use diagnostics, only: add_error, diagnostics_t
  use kinds, only: wp
  use link_checks, only: is_ram
  use link_shapes, only: compare_lengths, find_drawn_place
  use models, only: model_t, needs_frequencies, needs_response
  use name_checks, only: look_up, pin_names
  use name_index, only: find_name, name_index_t, new_name_index
  use spring_cards, only: is_spring_card, read_spring, spring_card_t
  use text, only: same_word, to_string
  use tokens, only: token_t, token_texts
  use units, only: dimension_length
  use value_words, only: in_words
  implicit none (type, external)
  private

  public :: read_springs, check_springs, is_on_link, is_on_weld, seek_place, check_ends, &
    refuse_still_links

  !> Relative difference of a length from that in the drawing that is more than rounding [-].
  real(wp), parameter :: least_difference = 1.0e-4_wp

contains

  !> Reads all SPRING and DAMPER cards: one is torsional if the word after its pin is a link.
  !! Errors: as for `read_spring`; such a word that is a link and a pin.
  pure subroutine read_springs(cards, diagnostics, model)
    type(card_t), intent(in) :: cards(:)              !! of the deck
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(model_t), intent(inout) :: model             !! with its links; its springs are set

    type(name_index_t) :: links, pins
    logical :: turns, is_unclear
    integer :: i, filled

    links = new_name_index(token_texts(model%links%name))
    pins = new_name_index(token_texts(pin_names(model)))
    allocate (model%springs(count_springs(cards)))
    filled = 0
    do i = 1, size(cards)
      if (.not. is_spring_card(cards(i))) cycle
      filled = filled + 1
      turns = .false.
      is_unclear = .false.
      if (size(cards(i)%words) > 2) then
        associate (word => cards(i)%words(3))
          turns = find_name(links, word%text) > 0
          is_unclear = turns .and. find_name(pins, word%text) > 0
          if (is_unclear) call add_error(diagnostics, word, "'"// &
            word%text//"' is a link and a pin, which tells nothing of the form of this card; "// &
            "give the pin another name", model%links(find_name(links, word%text))%name, &
            "the link is here")
        end associate
      end if
      associate (spring => model%springs(filled))
        call read_spring(cards(i), turns, model%units, diagnostics, spring)
        if (is_unclear) spring%ends(1) = token_t("", 0, 0)
      end associate
    end do
  end subroutine read_springs

  pure function count_springs(cards) result(number)
    type(card_t), intent(in) :: cards(:)
    integer :: number

    integer :: i

    number = 0
    do i = 1, size(cards)
      if (is_spring_card(cards(i))) number = number + 1
    end do
  end function count_springs

  !> Looks up what these cards name. Errors: an unknown link, pin or point; ends that are one place,
  !! on one link or on welded ones that do not bend, or both fixed; a link that does not turn about
  !! the pin; one link at a pin that moves; links that are welded there; no drawing, or a rough one,
  !! where the free length follows from it, or a negative free length that does; reports in which
  !! springs do not act.
  pure subroutine check_springs(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(model_t), intent(inout) :: model             !! has its links; link numbers of springs are
                                                      !! set

    type(name_index_t) :: links, pins, grounds
    type(spring_card_t) :: spring
    logical :: fine
    integer :: i, k

    if (size(model%springs) == 0) return
    links = new_name_index(token_texts(model%links%name))
    pins = new_name_index(token_texts(pin_names(model)))
    grounds = new_name_index(token_texts(model%grounds%pin))
    do i = 1, size(model%springs)
      spring = model%springs(i)
      if (spring%ends(1)%line == 0) cycle
      call seek_place(spring%ends(1), links, pins, grounds, diagnostics, fine)
      if (spring%turns) then
        do k = 1, 2
          if (spring%link_names(k)%line > 0) call seek_link(spring%link_names(k), links, pins, &
            diagnostics, spring%link(k))
          fine = fine .and. (spring%link(k) > 0 .or. spring%link_names(k)%line == 0)
        end do
        if (fine) call check_turning(diagnostics, model, grounds, spring, fine)
      else
        if (spring%ends(2)%line == 0) cycle
        call seek_place(spring%ends(2), links, pins, grounds, diagnostics, fine, fine)
        if (fine) call check_ends(diagnostics, model, grounds, spring%ends, &
          needs_frequencies(model) .or. needs_response(model), fine)
      end if
      if (fine) call check_drawn(diagnostics, model, spring)
      model%springs(i)%link = spring%link
    end do
    call refuse_reports(diagnostics, model)
  end subroutine check_springs

  !> Looks up an end: a pin of a link, a point or a ground pivot.
  pure subroutine seek_place(word, links, pins, grounds, diagnostics, known, others)
    type(token_t), intent(in) :: word                   !! the name, in the deck
    type(name_index_t), intent(in) :: links, pins, grounds !! of the deck
    type(diagnostics_t), intent(inout) :: diagnostics   !! errors are added
    logical, intent(inout) :: known                     !! whether it is one, and so `others`
    logical, intent(in), optional :: others !! whether what is before it on the card is known

    integer :: number

    known = .true.
    if (find_name(pins, word%text) == 0 .and. find_name(grounds, word%text) == 0) then
      known = .false.
      if (find_name(links, word%text) > 0) then
        call add_error(diagnostics, word, "'"//word%text//"' is a link; expected a "// &
          "pin, a POINT "// &
          "or a GROUND pin")
      else
        call look_up(word, pins, "pin", diagnostics, number)
      end if
    end if
    if (present(others)) known = known .and. others
  end subroutine seek_place

  !> Checks the ends of a line. Errors: they are one place, both fixed, on one link or on welded
  !! ones.
  pure subroutine check_ends(diagnostics, model, grounds, ends, bends, fine)
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(model_t), intent(in) :: model                !! its links and welds
    type(name_index_t), intent(in) :: grounds         !! of the deck
    type(token_t), intent(in) :: ends(2)              !! known places
    logical, intent(in) :: bends                      !! links bend, and ends on one may move
    logical, intent(out) :: fine                      !! the line has no such error

    integer :: i

    fine = .false.
    associate (one => ends(1), other => ends(2))
      if (same_word(one%text, other%text)) then
        call add_error(diagnostics, other, "both ends are at '"//one%text//"'", one, &
          "the first is here")
        return
      end if
      if (find_name(grounds, one%text) > 0 .and. find_name(grounds, other%text) > 0) then
        call add_error(diagnostics, other, "both ends are fixed: nothing moves between them", &
          model%grounds(find_name(grounds, one%text))%pin, "the other one is fixed here")
        return
      end if
      do i = 1, size(model%links)
        if (.not. is_on_link(model, i, one) .or. .not. is_on_link(model, i, other)) cycle
        if (bends .and. .not. model%links(i)%rigid) cycle
        if (any(model%drives%link == i) .and. .not. model%links(i)%has_length .and. &
          size(model%links(i)%lengths) == 0) cycle
        call add_error(diagnostics, other, "both ends are on link '"//model%links(i)%name%text// &
          "', which counts as rigid here: nothing moves between them", model%links(i)%name, &
          "the link is here")
        return
      end do
      do i = 1, size(model%welds)
        if (bends .and. any(.not. model%links(pack(model%welds(i)%link, &
          model%welds(i)%link > 0))%rigid)) cycle
        if (.not. is_on_weld(model, i, one) .or. .not. is_on_weld(model, i, other)) cycle
        call add_error(diagnostics, other, "both ends are on links that are welded: nothing "// &
          "moves between them", model%welds(i)%pin, "they are welded here")
        return
      end do
    end associate
    fine = .true.
  end subroutine check_ends

  !> Whether one of the links of a weld has a pin or a point.
  pure function is_on_weld(model, weld, word) result(is)
    type(model_t), intent(in) :: model !! with its links and welds looked up
    integer, intent(in) :: weld        !! number of the WELD card
    type(token_t), intent(in) :: word  !! name of the pin or the point
    logical :: is

    integer :: i

    is = .false.
    do i = 1, size(model%welds(weld)%link)
      associate (link => model%welds(weld)%link(i))
        if (link == 0) cycle
        ! The far end of a ram moves.
        if (.not. is_ram(model, model%links(link))) is = is .or. is_on_link(model, link, word)
      end associate
    end do
  end function is_on_weld

  !> Whether a link has a pin or a point.
  pure function is_on_link(model, link, word) result(is)
    type(model_t), intent(in) :: model !! with its links and points
    integer, intent(in) :: link        !! number
    type(token_t), intent(in) :: word  !! name of a pin or a point
    logical :: is

    integer :: k

    is = .false.
    do k = 1, size(model%links(link)%pins)
      is = is .or. same_word(model%links(link)%pins(k)%text, word%text)
    end do
    do k = 1, size(model%points)
      if (model%points(k)%link == link) is = is .or. same_word(model%points(k)%name%text, word%text)
    end do
  end function is_on_link

  !> Checks the pin and the links of a torsional one.
  pure subroutine check_turning(diagnostics, model, grounds, spring, fine)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    type(name_index_t), intent(in) :: grounds
    type(spring_card_t), intent(in) :: spring
    logical, intent(out) :: fine

    integer :: k

    fine = .false.
    do k = 1, 2
      if (spring%link(k) == 0) cycle
      if (is_on_link(model, spring%link(k), spring%ends(1))) cycle
      call add_error(diagnostics, spring%link_names(k), "link '"//spring%link_names(k)%text// &
        "' is not at pin '"//spring%ends(1)%text//"'", model%links(spring%link(k))%name, &
        "the link is here")
      return
    end do
    if (spring%link(2) == 0) then
      fine = find_name(grounds, spring%ends(1)%text) > 0
      if (.not. fine) call add_error(diagnostics, spring%ends(1), "pin '"//spring%ends(1)%text// &
        "' moves: between one link and the ground it must be a ground pivot; else name two links")
      return
    end if
    call refuse_still_links(diagnostics, model, spring%link_names, spring%link, fine)
  end subroutine check_turning

  !> Refuses an angle between a link and itself, or one that is welded to it.
  pure subroutine refuse_still_links(diagnostics, model, names, link, fine)
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(model_t), intent(in) :: model                !! its welds
    type(token_t), intent(in) :: names(2)             !! in the deck
    integer, intent(in) :: link(2)                    !! numbers in the model's list
    logical, intent(out) :: fine                      !! they turn against each other

    integer :: k

    fine = .false.
    if (link(1) == link(2)) then
      call add_error(diagnostics, names(2), "both links are one: nothing turns between them", &
        names(1), "the first is here")
      return
    end if
    do k = 1, size(model%welds)
      if (.not. any(model%welds(k)%link == link(1)) .or. .not. any(model%welds(k)%link == &
        link(2))) cycle
      call add_error(diagnostics, names(2), "links '"//names(1)%text//"' and '"// &
        names(2)%text//"' are welded: nothing turns between them", model%welds(k)%pin, &
        "they are welded here")
      return
    end do
    fine = .true.
  end subroutine refuse_still_links

  !> A spring without its free length or angle takes it from the drawing, which then must show all
  !! of it and be a position of the linkage.
  pure subroutine check_drawn(diagnostics, model, spring)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    type(spring_card_t), intent(in) :: spring

    real(wp), allocatable :: given(:), drawn(:)
    logical, allocatable :: known(:)
    real(wp) :: place(2, 2), rest
    logical :: is_drawn
    character(len=:), allocatable :: key
    integer :: i, k

    if (spring%damps .or. spring%has_rest .or. .not. spring%law%stiffness > 0.0_wp) return
    key = "free_"//trim(spring%nature%noun)
    if (spring%turns) then
      do k = 1, 2
        if (spring%link(k) == 0) cycle
        do i = 1, 2
          call find_drawn_place(model, model%links(spring%link(k))%pins(i)%text, place(:, i), &
            is_drawn)
          if (is_drawn) cycle
          call refuse_undrawn(diagnostics, spring, key, &
            model%links(spring%link(k))%pins(i)%text)
          return
        end do
      end do
    else
      do k = 1, 2
        call find_drawn_place(model, spring%ends(k)%text, place(:, k), is_drawn)
        if (is_drawn) cycle
        call refuse_undrawn(diagnostics, spring, key, spring%ends(k)%text)
        return
      end do
    end if
    do i = 1, size(model%links)
      call compare_lengths(model, model%links(i), given, drawn, known)
      do k = 1, size(given)
        if (.not. known(k)) cycle
        if (abs(given(k) - drawn(k)) <= least_difference*given(k)) cycle
        call add_error(diagnostics, spring%keyword, "without '"//key//"=' this spring is "// &
          "unloaded in the drawing, or has there the load of its card; but the drawing is "// &
          "rough: link '"//model%links(i)%name%text//"' is "//to_string(drawn(k)/given(k), 6)// &
          " times as long in it", model%links(i)%name, "the link is here")
        return
      end do
    end do
    if (spring%turns .or. spring%load_word%line == 0) return
    rest = norm2(place(:, 2) - place(:, 1)) - spring%load/spring%law%stiffness
    if (rest < 0.0_wp) call add_error(diagnostics, spring%load_word, "with this force in the "// &
      "drawing and its stiffness the free length of the spring would be negative: "// &
      in_words(rest, dimension_length, model%units, 6))
  end subroutine check_drawn

  pure subroutine refuse_undrawn(diagnostics, spring, key, name)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(spring_card_t), intent(in) :: spring
    character(len=*), intent(in) :: key  !! that gives the free length or angle
    character(len=*), intent(in) :: name !! of the pin or point

    call add_error(diagnostics, spring%keyword, "without '"//key//"=' this spring is unloaded "// &
      "in the drawing, or has there the load of its card; but '"//name// &
      "' is not in the drawing: expected '"//key//"=' or a PIN card")
  end subroutine refuse_undrawn

  !> With dampers refuses shapes, which are complex then.
  pure subroutine refuse_reports(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    integer :: i, damper

    damper = findloc(model%springs%damps, .true., dim=1)
    do i = 1, size(model%reports)
      associate (report => model%reports(i))
        if (report%kind%frequencies .and. all(report%kind%name /= ["frequencies", &
          "summary    "]) .and. damper > 0) then
          call add_error(diagnostics, report%keyword, "with dampers the shapes of modes are "// &
            "complex: REPORT "//trim(report%kind%name)//" takes none", &
            model%springs(damper)%keyword, "the first one is here")
        end if
      end associate
    end do
  end subroutine refuse_reports

end module spring_checks
