!> Reading of FRICTION cards, whose form depends on what slides where, and what rubs on what at the
!! pins that they name.
module friction_checks
  use cards, only: card_t
  use diagnostics, only: add_error, diagnostics_t
  use friction_cards, only: friction_card_t, read_friction
  use kinds, only: wp
  use models, only: model_t, report_number
  use name_checks, only: look_up, pin_names
  use name_index, only: name_index_t, new_name_index
  use spring_checks, only: is_on_link
  use text, only: same_word
  use tokens, only: token_texts
  implicit none (type, external)
  private

  public :: read_frictions, check_frictions

contains

  !> Reads all FRICTION cards: one is on a block if its second word is what its pin slides along.
  !! Errors: as for `read_friction`.
  pure subroutine read_frictions(cards, diagnostics, model)
    type(card_t), intent(in) :: cards(:)              !! of the deck
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(model_t), intent(inout) :: model             !! with its sliders; its frictions are set

    integer :: i, slider, filled

    filled = 0
    do i = 1, size(cards)
      if (same_word(cards(i)%keyword%text, "FRICTION")) filled = filled + 1
    end do
    allocate (model%frictions(filled))
    filled = 0
    do i = 1, size(cards)
      if (.not. same_word(cards(i)%keyword%text, "FRICTION")) cycle
      filled = filled + 1
      slider = 0
      if (size(cards(i)%words) > 1) slider = slider_at(model, cards(i)%words(1)%text, &
        cards(i)%words(2)%text)
      call read_friction(cards(i), slider > 0, model%units, diagnostics, model%frictions(filled))
      model%frictions(filled)%slider = slider
    end do
  end subroutine read_frictions

  !> Number of the SLIDER card of a pin, on a guide or link of a name, or on any; 0: there is none.
  pure function slider_at(model, pin, on) result(number)
    type(model_t), intent(in) :: model
    character(len=*), intent(in) :: pin
    character(len=*), intent(in), optional :: on
    integer :: number

    do number = 1, size(model%sliders)
      if (.not. same_word(model%sliders(number)%pin%text, pin)) cycle
      if (.not. present(on)) return
      if (same_word(model%sliders(number)%on%text, on)) return
    end do
    number = 0
  end function slider_at

  !> Looks up what these cards name, and finds the links that rub on each other.
  !!
  !! Errors: an unknown pin, link or guide; a guide on which no block slides at this pin; a block to
  !! which a link is fixed without a length, and a length without such a link; a pin where nothing
  !! rubs, or where more links than two meet and none is named as that which bears it; a pin with a
  !! load of its own, likewise; welded links; the same joint twice; reports in which friction does
  !! not act.
  pure subroutine check_frictions(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(model_t), intent(inout) :: model             !! with its links and sliders looked up; pairs
                                                      !! of its frictions are set

    type(name_index_t) :: links, pins
    integer :: i, k, number(2)

    if (size(model%frictions) == 0) return
    links = new_name_index(token_texts(model%links%name))
    pins = new_name_index(token_texts(pin_names(model)))
    do i = 1, size(model%frictions)
      associate (friction => model%frictions(i))
        if (friction%pin%line == 0) cycle
        if (friction%slider > 0) then
          call check_length(diagnostics, model, friction)
        else
          call look_up(friction%pin, pins, "pin", diagnostics, number(1))
          if (number(1) == 0) cycle
          number = 0
          do k = 1, 2
            if (friction%names(k)%line == 0) exit
            call seek_link(diagnostics, model, links, friction, k, number(k))
            if (number(k) == 0) exit
          end do
          if (k < 3) then
            if (friction%names(k)%line > 0) cycle
          end if
          call find_pairs(diagnostics, model, number, friction)
        end if
        call refuse_twice(diagnostics, model, i)
      end associate
    end do
    call refuse_reports(diagnostics, model)
  end subroutine check_frictions

  !> Looks up a link of the card, which must be at its pin.
  pure subroutine seek_link(diagnostics, model, links, friction, place, number)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    type(name_index_t), intent(in) :: links
    type(friction_card_t), intent(in) :: friction
    integer, intent(in) :: place   !! on the card, 1 or 2
    integer, intent(out) :: number !! 0: refused

    integer :: i

    number = 0
    associate (word => friction%names(place))
      do i = 1, size(model%guides)
        if (.not. same_word(model%guides(i)%name%text, word%text)) cycle
        call add_error(diagnostics, word, "no block slides at pin '"//friction%pin%text// &
          "' along guide '"//word%text//"'", model%guides(i)%name, "the guide is here")
        return
      end do
      call look_up(word, links, "link or guide", diagnostics, number)
      if (number == 0) return
      if (is_on_link(model, number, friction%pin)) return
      call add_error(diagnostics, word, "link '"//word%text//"' is not at pin '"// &
        friction%pin%text//"', and no block there slides along it", model%links(number)%name, &
        "the link is here")
      number = 0
    end associate
  end subroutine seek_link

  !> The ends of a block to which a link is fixed press on the line: its length says how much.
  pure subroutine check_length(diagnostics, model, friction)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    type(friction_card_t), intent(in) :: friction

    associate (slider => model%sliders(friction%slider))
      if (slider%turned%line > 0 .and. friction%coefficient > 0.0_wp .and. &
        friction%length <= 0.0_wp) then
        call add_error(diagnostics, friction%keyword, "'length=' of the block is missing: link "// &
          "'"//slider%turned%text//"' does not turn on it, and its ends press the more the "// &
          "shorter it is", slider%turned, "the link is fixed to it here")
      else if (slider%turned%line == 0 .and. friction%length > 0.0_wp) then
        call add_error(diagnostics, friction%keyword, "'length=' does nothing: links turn on "// &
          "the block at '"//friction%pin%text//"', so that no moment presses on its ends", &
          slider%pin, "the block is here")
      end if
    end associate
  end subroutine check_length

  !> The links that rub at a pin.
  pure subroutine find_pairs(diagnostics, model, named, friction)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    integer, intent(in) :: named(2) !! links on the card; 0: none
    type(friction_card_t), intent(inout) :: friction

    integer, allocatable :: there(:), rubbing(:)
    integer :: i, slider, bearer, fixed
    logical :: is_ground, fine

    associate (pin => friction%pin)
      there = pack([(i, i=1, size(model%links))], [(is_on_link(model, i, pin), i=1, &
        size(model%links))])
      is_ground = .false.
      do i = 1, size(model%grounds)
        is_ground = is_ground .or. same_word(model%grounds(i)%pin%text, pin%text)
      end do
      slider = slider_at(model, pin%text)
      bearer = 0
      if (slider > 0) then
        do i = slider + 1, size(model%sliders)
          if (.not. same_word(model%sliders(i)%pin%text, pin%text)) cycle
          call add_error(diagnostics, pin, "two blocks are at pin '"//pin%text//"', which does "// &
            "not tell on which one links turn", model%sliders(i)%pin, "the second is here")
          return
        end do
        if (is_ground) then
          call add_error(diagnostics, pin, "the block at ground pivot '"//pin%text// &
            "' rubs along '"//model%sliders(slider)%on%text//"' only: friction of its pivot is "// &
            "not built", model%sliders(slider)%pin, "the block is here")
          return
        end if
        fixed = model%sliders(slider)%turned_link
        bearer = merge(fixed, model%sliders(slider)%link, fixed > 0)
        there = pack(there, there /= fixed)
      end if
      if (slider > 0 .or. is_ground) then
        if (named(2) > 0) then
          call add_error(diagnostics, friction%names(2), "links turn on the "// &
            trim(merge("block       ", "ground pivot", slider > 0))//" at '"//pin%text// &
            "', not on each other: expected one link at most")
          return
        end if
        rubbing = there
        if (named(1) > 0) rubbing = pack(there, there == named(1))
      else
        call find_bearer(diagnostics, model, named, there, friction, bearer)
        if (bearer == 0) return
        rubbing = pack(there, there /= bearer)
        if (named(1) > 0) rubbing = named(1:1)
      end if
      if (size(rubbing) == 0) then
        call add_error(diagnostics, pin, "no link turns on anything at pin '"//pin%text//"'")
        return
      end if
      do i = 1, size(rubbing)
        call refuse_welded(diagnostics, model, friction, rubbing(i), fine)
        if (.not. fine) return
      end do
    end associate
    deallocate (friction%pairs)
    allocate (friction%pairs(2, size(rubbing)))
    friction%pairs(1, :) = rubbing
    friction%pairs(2, :) = bearer
  end subroutine find_pairs

  !> The link that bears a moving pin without a block: the second one on the card, or of two the
  !! other. The force between them is that on the first one, which must be told from it where the
  !! pin has a load of its own.
  pure subroutine find_bearer(diagnostics, model, named, there, friction, bearer)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    integer, intent(in) :: named(2), there(:)
    type(friction_card_t), intent(in) :: friction
    integer, intent(out) :: bearer !! 0: refused

    bearer = 0
    associate (pin => friction%pin)
      if (named(2) > 0) then
        if (named(1) == named(2)) then
          call add_error(diagnostics, friction%names(2), "both links are one: nothing turns "// &
            "between them", friction%names(1), "the first is here")
          return
        end if
        bearer = named(2)
      else if (size(there) > 2) then
        call add_error(diagnostics, pin, "more than two links meet at pin '"//pin%text// &
          "': expected 'FRICTION "//pin%text//" link link', the link that turns and the link "// &
          "that bears the pin")
      else if (size(there) == 2 .and. bears_load(model, pin%text)) then
        call add_error(diagnostics, pin, "pin '"//pin%text//"' has a mass or a load of its "// &
          "own: expected 'FRICTION "//pin%text//" link link', the link that turns and the link "// &
          "that bears the pin with it")
      else if (size(there) == 2) then
        bearer = there(2)
        if (named(1) == bearer) bearer = there(1)
      else
        call add_error(diagnostics, pin, "no link turns on anything at pin '"//pin%text//"'")
      end if
    end associate
  end subroutine find_bearer

  !> Whether a mass, a force or a spring is at a pin.
  pure function bears_load(model, pin) result(bears)
    type(model_t), intent(in) :: model
    character(len=*), intent(in) :: pin
    logical :: bears

    integer :: i, k

    bears = .true.
    do i = 1, size(model%pin_masses)
      if (same_word(model%pin_masses(i)%pin%text, pin)) return
    end do
    do i = 1, size(model%forces)
      if (same_word(model%forces(i)%pin%text, pin)) return
    end do
    do i = 1, size(model%processes)
      if (.not. model%processes(i)%on_link .and. same_word(model%processes(i)%subject%text, pin)) &
        return
    end do
    do i = 1, size(model%springs)
      do k = 1, 2
        if (.not. model%springs(i)%turns .and. same_word(model%springs(i)%ends(k)%text, pin)) return
      end do
    end do
    bears = .false.
  end function bears_load

  !> Reports a link that is welded to another one at the pin, which shares its force.
  pure subroutine refuse_welded(diagnostics, model, friction, link, fine)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    type(friction_card_t), intent(in) :: friction
    integer, intent(in) :: link
    logical, intent(out) :: fine

    integer :: i

    fine = .false.
    do i = 1, size(model%welds)
      if (.not. same_word(model%welds(i)%pin%text, friction%pin%text)) cycle
      if (.not. any(model%welds(i)%link == link)) cycle
      call add_error(diagnostics, friction%pin, "link '"//model%links(link)%name%text// &
        "' is welded at pin '"//friction%pin%text//"' to one that shares its force; name "// &
        "another link first, or make one LINK of both", model%welds(i)%pin, &
        "they are welded here")
      return
    end do
    fine = .true.
  end subroutine refuse_welded

  !> Reports a joint that a card before has already.
  pure subroutine refuse_twice(diagnostics, model, number)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    integer, intent(in) :: number !! of the card

    integer :: i, k
    logical :: is_same

    associate (friction => model%frictions(number))
      do i = 1, number - 1
        associate (before => model%frictions(i))
          if (.not. same_word(before%pin%text, friction%pin%text)) cycle
          is_same = friction%slider > 0 .and. friction%slider == before%slider
          do k = 1, size(friction%pairs, 2)
            is_same = is_same .or. any(before%pairs(1, :) == friction%pairs(1, k)) .or. &
              any(before%pairs(1, :) == friction%pairs(2, k) .and. before%pairs(2, :) == &
              friction%pairs(1, k))
          end do
          if (.not. is_same) cycle
          call add_error(diagnostics, friction%pin, "a FRICTION card before this one is on the "// &
            "same joint", before%pin, "it is here")
          return
        end associate
      end do
    end associate
  end subroutine refuse_twice

  !> Refuses frequencies and all of the elastic linkage in motion, and motions through change
  !! points, where the forces in the joints are not determined.
  pure subroutine refuse_reports(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    integer :: i

    do i = 1, size(model%reports)
      associate (report => model%reports(i))
        if (.not. report%kind%frequencies .and. .not. report%kind%response) cycle
        call add_error(diagnostics, report%keyword, "friction does not act in REPORT "// &
          trim(report%kind%name)//" yet", model%frictions(1)%keyword, "the first one is here")
      end associate
    end do
    i = report_number(model, "motion")
    if (i == 0) return
    if (model%reports(i)%through) call add_error(diagnostics, model%reports(i)%through_word, &
      "at a change point the forces in the joints are not determined, and friction depends on "// &
      "them; expected change_points=stop", model%frictions(1)%keyword, "the first FRICTION is here")
  end subroutine refuse_reports

end module friction_checks
