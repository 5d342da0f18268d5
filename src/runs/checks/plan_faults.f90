!> Why a linkage has no plan, in words, at the part of the deck that it is about.
module plan_faults
  use deck_lengths, only: length_text
  use diagnostics, only: add_error, diagnostics_t
  use drive_cards, only: branch_backward, branch_forward
  use kinds, only: wp
  use linkage_builder, only: assembly_t
  use models, only: model_t
  use plan_problems, only: problem_braced, problem_drive_idle, problem_no_side, &
    problem_not_drawn, problem_other_bases, problem_side_idle, problem_sides_differ, &
    problem_too_free
  use plan_sides, only: has_two_places, is_on_line
  use pose_types, only: place_of_pin, pins_of_body
  use text, only: plural, same_word, to_string
  use tokens, only: token_t
  implicit none (type, external)
  private

  public :: report_problem

contains

  !> Why a linkage has no plan, at the part of the deck that it is about.
  pure subroutine report_problem(model, assembly, diagnostics)
    type(model_t), intent(in) :: model                !! without errors so far
    type(assembly_t), intent(in) :: assembly          !! with a problem
    type(diagnostics_t), intent(inout) :: diagnostics !! to which the error is added

    type(token_t) :: place

    associate (problem => assembly%problem)
      place = model%links(1)%name
      if (size(problem%bodies) > 0) place = model%links(assembly%link(problem%bodies(1)))%name
      select case (problem%kind)
      case (problem_too_free)
        if (size(problem%pins) > 0) place = token_of_pin(model, assembly, problem%pins(1))
        if (problem%number > 0) then
          associate (subject => model%drives(problem%number)%subject)
            call add_error(diagnostics, subject, "this DRIVE moves nothing: '"//subject%text// &
              "' is held already, while "//what_is_free(assembly)//"; expected a DRIVE of what "// &
              "is free, or parts that hold it", place, "this is free")
          end associate
        else if (size(problem%redundant) > 0) then
          call report_loose_and_rigid(model, assembly, place, diagnostics)
        else
          call add_error(diagnostics, place, "the linkage has mobility "// &
            to_string(problem%mobility)//" and "//plural(size(model%drives), "DRIVE")//": "// &
            what_is_free(assembly)//" (add a DRIVE, or parts that hold it)")
        end if
      case (problem_braced)
        call report_brace(model, assembly, place, diagnostics)
      case (problem_drive_idle)
        call add_error(diagnostics, model%drives(problem%number)%subject, "the linkage has "// &
          "mobility "//to_string(problem%mobility)//" and "//plural(size(model%drives), &
          "DRIVE")//": the others leave this one nothing to move; remove this card, or another "// &
          "DRIVE")
      case (problem_no_side, problem_other_bases)
        call report_side(model, assembly, diagnostics)
      case (problem_side_idle)
        call report_idle_side(model, assembly, diagnostics)
      case (problem_sides_differ)
        call report_contradiction(model, assembly, diagnostics)
      case (problem_not_drawn)
        place = token_of_pin(model, assembly, problem%pins(1))
        call add_error(diagnostics, place, "several links have to be placed together here, and "// &
          "only a drawing tells how: PIN cards for "//names_of_pins(assembly, problem%pins)// &
          " are missing")
      end select
    end associate
  end subroutine report_problem

  !> Some parts are held by nothing, while others are held more than once: counted together they
  !! are of no use to anybody.
  pure subroutine report_loose_and_rigid(model, assembly, place, diagnostics)
    type(model_t), intent(in) :: model
    type(assembly_t), intent(in) :: assembly
    type(token_t), intent(in) :: place
    type(diagnostics_t), intent(inout) :: diagnostics

    character(len=:), allocatable :: links
    type(token_t) :: other
    integer :: i

    links = ""
    other = place
    associate (redundant => assembly%problem%redundant)
      do i = 1, size(redundant)
        if (redundant(i) == 0) cycle
        if (len(links) == 0) other = model%links(assembly%link(redundant(i)))%name
        if (len(links) > 0) links = links//", "
        links = links//"'"//model%links(assembly%link(redundant(i)))%name%text//"'"
      end do
    end associate
    if (len(links) == 0) links = "a block on a GUIDE"
    call add_error(diagnostics, place, what_is_free(assembly)//" (add a DRIVE, or parts that "// &
      "hold it); other parts are held more than once, by "//links//": unless it fits at every "// &
      "position, they form a structure and cannot move", other, "it is here")
  end subroutine report_loose_and_rigid

  !> A link between pins of one body: the ground, or another link.
  pure subroutine report_brace(model, assembly, place, diagnostics)
    type(model_t), intent(in) :: model
    type(assembly_t), intent(in) :: assembly
    type(token_t), intent(in) :: place !! the link
    type(diagnostics_t), intent(inout) :: diagnostics

    character(len=:), allocatable :: pins, remedy
    real(wp) :: own, other
    integer :: k

    associate (problem => assembly%problem, linkage => assembly%linkage)
      pins = names_of_pins(assembly, problem%pins)
      own = norm2(place_of_pin(linkage%bodies(problem%bodies(1)), problem%pins(2)) - &
        place_of_pin(linkage%bodies(problem%bodies(1)), problem%pins(1)))
      if (size(problem%bodies) == 1) then
        other = norm2(linkage%ground_position(:, problem%pins(2)) - linkage%ground_position(:, &
          problem%pins(1)))
        call add_error(diagnostics, place, "link '"//place%text//"' joins the ground pivots "// &
          pins(index(pins, "'"):)//" and cannot move"//what_misfits(model, place, own - other)// &
          "; expected no such link: it is a part of the ground")
        return
      end if
      k = problem%bodies(2)
      other = norm2(place_of_pin(linkage%bodies(k), problem%pins(2)) - &
        place_of_pin(linkage%bodies(k), problem%pins(1)))
      remedy = "one LINK with the pins of both"
      if (size(pins_of_body(linkage%bodies(problem%bodies(1)))) == size(problem%pins)) &
        remedy = "no '"//place%text//"' (a mass of it is a MASS of the other)"
      call add_error(diagnostics, place, "'"//place%text//"' and '"// &
        model%links(assembly%link(k))%name%text//"' are one body: both have "//pins// &
        what_misfits(model, place, own - other)//"; expected "//remedy, &
        model%links(assembly%link(k))%name, "the other one is here")
    end associate
  end subroutine report_brace

  !> ` ('bar' is 3 mm too short for them)`; empty if it fits.
  pure function what_misfits(model, link, excess) result(words)
    type(model_t), intent(in) :: model
    type(token_t), intent(in) :: link !! its name
    real(wp), intent(in) :: excess !! of the length of the link [m]
    character(len=:), allocatable :: words

    real(wp), parameter :: none = 1.0e-9_wp

    words = ""
    if (abs(excess) > none) words = " ('"//link%text//"' is "//length_text(model, &
      abs(excess), 6)//" too "//trim(merge("long ", "short", excess > 0.0_wp))//" for them)"
  end function what_misfits

  !> A dyad without a side, or with a card that does not fit it.
  pure subroutine report_side(model, assembly, diagnostics)
    type(model_t), intent(in) :: model
    type(assembly_t), intent(in) :: assembly
    type(diagnostics_t), intent(inout) :: diagnostics

    character(len=:), allocatable :: pin, way, card

    associate (problem => assembly%problem)
      pin = "pin '"//assembly%pins(problem%pins(1))%text//"'"
      card = card_of_side(assembly, problem%pins, problem%on_line)
      if (problem%kind == problem_other_bases) then
        associate (branch => model%branches(problem%number))
          call add_error(diagnostics, branch%pin, pin//what_does_not_fit(branch%which, &
            problem%on_line)//"; expected "//card)
        end associate
        return
      end if
      way = " has two places on its guide: expected "//card//", or PIN cards for '"// &
        assembly%pins(problem%pins(1))%text//"' and '"//assembly%pins(problem%pins(2))%text//"'"
      if (.not. problem%on_line) way = " has two places, left or right of '"// &
        assembly%pins(problem%pins(2))%text//"' -> '"//assembly%pins(problem%pins(3))%text// &
        "': expected "//card//", or PIN cards for the moving pins"
      call add_error(diagnostics, token_of_pin(model, assembly, problem%pins(1)), pin//way)
    end associate
  end subroutine report_side

  !> The BRANCH card that a dyad without one needs.
  pure function card_of_side(assembly, pins, on_line) result(card)
    type(assembly_t), intent(in) :: assembly
    integer, intent(in) :: pins(:)  !! its middle, then those that carry it
    logical, intent(in) :: on_line  !! it has a place forward and one backward
    character(len=:), allocatable :: card

    card = "BRANCH "//assembly%pins(pins(1))%text//" forward|backward"
    if (.not. on_line) card = "BRANCH "//assembly%pins(pins(1))%text//" left|right "// &
      assembly%pins(pins(2))%text//" "//assembly%pins(pins(3))%text
  end function card_of_side

  !> Why a card is not about the dyad of its pin.
  pure function what_does_not_fit(which, on_line) result(words)
    integer, intent(in) :: which    !! of the card, one of the branch_… constants
    logical, intent(in) :: on_line  !! the dyad has a place forward and one backward
    character(len=:), allocatable :: words

    logical :: is_along

    is_along = any(which == [branch_forward, branch_backward])
    words = " does not hang on these pins"
    if (on_line .and. .not. is_along) words = " has its two places along a guide or a link"
    if (is_along .and. .not. on_line) words = " has its two places beside the way between two pins"
  end function what_does_not_fit

  !> A card about a pin that has one place.
  pure subroutine report_idle_side(model, assembly, diagnostics)
    type(model_t), intent(in) :: model
    type(assembly_t), intent(in) :: assembly
    type(diagnostics_t), intent(inout) :: diagnostics

    character(len=:), allocatable :: pin

    associate (problem => assembly%problem)
      pin = "pin '"//assembly%pins(problem%pins(1))%text//"'"
      if (size(problem%bodies) > 0) then
        call add_error(diagnostics, model%branches(problem%number)%pin, pin// &
          " is placed together with others, as the drawing shows: a BRANCH card cannot choose "// &
          "its place, its PIN card does")
      else
        call add_error(diagnostics, model%branches(problem%number)%pin, pin// &
          " has one place only: this BRANCH card has nothing to choose"//what_to_choose(assembly))
      end if
    end associate
  end subroutine report_idle_side

  !> `; those that choose are of BRANCH B left|right A O4 and BRANCH C forward|backward`, for the
  !! first pins with two places.
  pure function what_to_choose(assembly) result(words)
    type(assembly_t), intent(in) :: assembly
    character(len=:), allocatable :: words

    integer, parameter :: most = 3
    integer :: g, told

    words = ""
    told = 0
    do g = 1, size(assembly%linkage%groups)
      associate (group => assembly%linkage%groups(g))
        if (.not. has_two_places(group)) cycle
        told = told + 1
        if (told > most) exit
        words = words//trim(merge("; expected", ", or      ", told == 1))//" "//card_of_side( &
          assembly, [group%middle, group%base], is_on_line(group))
      end associate
    end do
  end function what_to_choose

  !> A card with whose side no assembly has those of the others.
  pure subroutine report_contradiction(model, assembly, diagnostics)
    type(model_t), intent(in) :: model
    type(assembly_t), intent(in) :: assembly
    type(diagnostics_t), intent(inout) :: diagnostics

    character(len=:), allocatable :: side

    associate (problem => assembly%problem, branch => model%branches(assembly%problem%number))
      side = "'"//branch%pin%text//"' lies "//branch%word%text
      if (.not. problem%on_line) side = "'"//branch%pin%text//"' lies to the "//branch%word%text// &
        " of '"//branch%from%text//"' -> '"//branch%to%text//"'"
      if (problem%other > 0) then
        call add_error(diagnostics, branch%pin, "the BRANCH cards of pins '"// &
          model%branches(problem%other)%pin%text//"' and '"//branch%pin%text// &
          "' contradict each other: in no assembly of the first "//side, &
          model%branches(problem%other)%pin, "the first is here")
      else
        call add_error(diagnostics, branch%pin, "in no assembly of the linkage "//side)
      end if
    end associate
  end subroutine report_contradiction

  !> `nothing holds pins 'E', 'F'`
  pure function what_is_free(assembly) result(words)
    type(assembly_t), intent(in) :: assembly
    character(len=:), allocatable :: words

    associate (problem => assembly%problem)
      if (size(problem%pins) > 0) then
        words = "nothing holds "//names_of_pins(assembly, problem%pins)
        return
      end if
      words = "nothing turns "//plural(size(problem%bodies), "link")
    end associate
  end function what_is_free

  !> `pins 'E', 'F'`, or `pin 'E'`
  pure function names_of_pins(assembly, pins) result(words)
    type(assembly_t), intent(in) :: assembly
    integer, intent(in) :: pins(:)
    character(len=:), allocatable :: words

    integer :: i

    words = trim(merge("pin ", "pins", size(pins) == 1))
    do i = 1, size(pins)
      if (i > 1) words = words//","
      words = words//" '"//assembly%pins(pins(i))%text//"'"
    end do
  end function names_of_pins

  !> Where a pin first stands in the deck, on a LINK card or a SLIDER card.
  pure function token_of_pin(model, assembly, pin) result(place)
    type(model_t), intent(in) :: model
    type(assembly_t), intent(in) :: assembly
    integer, intent(in) :: pin
    type(token_t) :: place

    integer :: i, k

    do i = 1, size(model%links)
      do k = 1, size(model%links(i)%pins)
        place = model%links(i)%pins(k)
        if (same_word(place%text, assembly%pins(pin)%text)) return
      end do
    end do
    do i = 1, size(model%sliders)
      place = model%sliders(i)%pin
      if (same_word(place%text, assembly%pins(pin)%text)) return
    end do
    place = model%links(1)%name
  end function token_of_pin

end module plan_faults
