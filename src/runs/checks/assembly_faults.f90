!> Why a linkage with a plan does not assemble from its drawing, in words.
module assembly_faults
  use deck_lengths, only: in_deck
  use diagnostics, only: add_error, diagnostics_t
  use drawn_cranks, only: starting_cranks
  use errors, only: error_of_dead_point
  use kinds, only: wp
  use linkage_builder, only: assembly_t
  use linkages, only: linkage_t, turn_t
  use models, only: model_t
  use pose_types, only: pins_of_body
  use singular_drawings, only: find_singularity
  use text, only: to_string
  use tokens, only: token_t
  implicit none (type, external)
  private

  public :: report_assembly

contains

  !> The drawing does not assemble: the nearest assembly as PIN cards, if there is one.
  pure subroutine report_assembly(model, assembly, diagnostics)
    type(model_t), intent(in) :: model
    type(assembly_t), intent(in) :: assembly
    type(diagnostics_t), intent(inout) :: diagnostics

    type(token_t) :: place
    logical, allocatable :: turns(:)
    logical :: is_singular

    place = model%links(1)%name
    if (size(model%drawn_pins) > 0) place = model%drawn_pins(1)%pin
    call find_singularity(assembly%linkage, first_crank(model, assembly%linkage), is_singular, &
      turns)
    if (is_singular) then
      call report_singularity(model, assembly, turns, place, diagnostics)
    else if (assembly%error%kind == error_of_dead_point) then
      call add_error(diagnostics, place, "this drawing shows a dead point, or nearly so, where "// &
        "the drive cannot move the links; draw another position")
    else if (.not. allocated(assembly%nearest)) then
      call add_error(diagnostics, place, "the linkage does not assemble from this drawing: "// &
        assembly%error%text)
    else
      call report_nearest(model, assembly, place, diagnostics)
    end if
  end subroutine report_assembly

  !> The coordinate of the first drive in the drawing.
  pure function first_crank(model, linkage) result(crank)
    type(model_t), intent(in) :: model
    type(linkage_t), intent(in) :: linkage
    real(wp) :: crank

    real(wp), allocatable :: cranks(:)

    cranks = starting_cranks(model, linkage)
    crank = cranks(1)
  end function first_crank

  !> The drawing closes, and the equations of the links depend on each other at every position.
  !! Links on two guides or more, which hold them across only, are held square by a third name,
  !! those on a ground pivot by a CLAMP: such cards are added until no link is loose.
  pure subroutine report_singularity(model, assembly, turns, place, diagnostics)
    type(model_t), intent(in) :: model
    type(assembly_t), intent(in) :: assembly
    logical, intent(in) :: turns(:) !! (bodies)
    type(token_t), intent(in) :: place
    type(diagnostics_t), intent(inout) :: diagnostics

    character(len=:), allocatable :: links, cards, card
    type(linkage_t) :: held
    type(token_t) :: word
    logical, allocatable :: loose(:)
    logical :: is_singular, holds_blocks
    integer :: b

    links = ""
    do b = 1, size(turns)
      if (turns(b)) links = links//", '"//model%links(assembly%link(b))%name%text//"'"
    end do
    cards = ""
    word = place
    held = assembly%linkage
    loose = turns
    is_singular = .true.
    holds_blocks = .false.
    do while (is_singular)
      call hold_link(model, assembly, loose, held, card, word, holds_blocks)
      if (len(card) == 0) exit
      cards = cards//"; "//card
      call find_singularity(held, first_crank(model, held), is_singular, loose)
    end do
    if (len(links) == 0) links = ", no link"
    if (is_singular) cards = "; expected other lengths, or parts that hold it"
    if (.not. is_singular) cards = "; expected what holds them, a third name on SLIDER (square "// &
      "to its guide) or a CLAMP: "//cards(3:)
    call add_error(diagnostics, word, "the drawing closes, but the linkage is singular there "// &
      "and at every other position: "//links(3:)//" can turn by a little without any other "// &
      "part in the way"//cards)
  end subroutine report_singularity

  !> Holds a loose link, by a card that it needs.
  pure subroutine hold_link(model, assembly, loose, held, card, word, holds_blocks)
    type(model_t), intent(in) :: model
    type(assembly_t), intent(in) :: assembly
    logical, intent(in) :: loose(:) !! (bodies)
    type(linkage_t), intent(inout) :: held !! the same linkage, to which its turn is added
    character(len=:), allocatable, intent(out) :: card !! empty: none is known
    type(token_t), intent(inout) :: word   !! of the deck, at the first SLIDER card among them
    logical, intent(inout) :: holds_blocks !! there is one

    type(turn_t), allocatable :: turns(:)
    type(turn_t) :: turn
    integer :: b, i, pin, blocks

    card = ""
    associate (sliders => held%sliders)
      do b = 1, size(loose)
        if (.not. loose(b) .or. any(held%turns%body == b)) cycle
        blocks = 0
        do i = size(sliders), 1, -1
          if (sliders(i)%body > 0 .or. model%sliders(i)%turned_link > 0) cycle
          if (.not. any(pins_of_body(held%bodies(b)) == sliders(i)%pin)) cycle
          blocks = blocks + 1
          turn%slider = i
        end do
        if (blocks < 2) cycle
        turn%body = b
        if (.not. holds_blocks) word = model%sliders(turn%slider)%pin
        holds_blocks = .true.
        card = "SLIDER "//model%sliders(turn%slider)%pin%text//" "// &
          model%sliders(turn%slider)%on%text//" "//model%links(assembly%link(b))%name%text
        exit
      end do
      do b = 1, size(loose)
        if (len(card) > 0) exit
        if (.not. loose(b) .or. any(held%turns%body == b) .or. any(held%drives%body == b)) cycle
        pin = findloc(held%is_ground(pins_of_body(held%bodies(b))), .true., dim=1)
        if (pin == 0) cycle
        associate (pins => pins_of_body(held%bodies(b)))
          card = "CLAMP "//assembly%pins(pins(pin))%text//" "// &
            model%links(assembly%link(b))%name%text
        end associate
        turn%body = b
      end do
    end associate
    if (len(card) == 0) return
    associate (body => held%bodies(turn%body), drawn => held%drawing%pin)
      turn%relative = drawn(:, body%last_pin) - drawn(:, body%first_pin)
    end associate
    turn%relative = turn%relative/norm2(turn%relative)
    allocate (turns(size(held%turns) + 1))
    turns(:size(held%turns)) = held%turns
    turns(size(turns)) = turn
    call move_alloc(turns, held%turns)
  end subroutine hold_link

  !> The assembly nearest to the drawing, as PIN cards.
  pure subroutine report_nearest(model, assembly, place, diagnostics)
    type(model_t), intent(in) :: model
    type(assembly_t), intent(in) :: assembly
    type(token_t), intent(in) :: place
    type(diagnostics_t), intent(inout) :: diagnostics

    character(len=:), allocatable :: cards
    integer :: i

    cards = ""
    do i = 1, size(assembly%pins)
      if (assembly%linkage%is_ground(i)) cycle
      cards = cards//"; PIN "//assembly%pins(i)%text//" "//to_string(in_deck(model, &
        assembly%nearest%pin(1, i)), 6)//" "//to_string(in_deck(model, assembly%nearest%pin(2, &
        i)), 6)
    end do
    call add_error(diagnostics, place, "the linkage does not assemble near this drawing; the "// &
      "nearest assembly is: "//cards(3:))
  end subroutine report_nearest

end module assembly_faults
