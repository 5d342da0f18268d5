!> MEASURE cards: coordinates of the linkage by name. Names are looked up later, by
!! `measure_checks`.
module measure_cards
  use card_reader, only: check_form, read_choice, read_part_name, read_quantity
  use card_table, only: card_kind_t, kind_of_card
  use cards, only: card_t
  use diagnostics, only: add_error, diagnostics_t
  use kinds, only: wp
  use natures, only: angle_nature, length_nature, nature_t
  use text, only: same_word
  use tokens, only: token_t
  use units, only: dimension_none, unit_system_t
  implicit none (type, external)
  private

  public :: measure_card_t, read_measure_card, nature_of_measure, card_named
  public :: measure_distance, measure_angle, measure_along, measure_across, measure_travel, &
    measure_sum

  ! In the order of the words in the table of cards.
  integer, parameter :: measure_distance = 1, measure_angle = 2, measure_along = 3, &
    measure_across = 4, measure_travel = 5, measure_sum = 6

  !> A MEASURE card. A word without a line is not on the card.
  type :: measure_card_t
    type(token_t) :: name                 !! without a line if the card cannot be read
    integer :: kind = 0                   !! one of the measure_… constants
    type(nature_t) :: nature = length_nature
    type(token_t) :: places(2)            !! pins or POINTs: both of a distance, one of a place
    type(token_t) :: links(2)             !! of an angle: its link, and that from which it is
                                          !! measured
    type(token_t) :: line                 !! guide or link along or across which a place is
    real(wp) :: direction(2) = 0.0_wp     !! of a travel, unit vector in global axes
    real(wp), allocatable :: weights(:)   !! (terms) of a sum
    type(token_t), allocatable :: terms(:) !! (terms) of a sum: names
    integer :: link(2) = 0                !! numbers of `links` in the model's list; 0: none
    integer :: guide = 0                  !! number of `line` in the model's list; 0: it is a link
    integer :: line_link = 0              !! the same; 0: it is a guide
  end type measure_card_t

contains

  !> Reads `MEASURE name kind …`. Errors: words or keys that do not fit the kind, an unknown kind,
  !! an invalid name, unreadable numbers, a direction of no length, a weight without a name.
  pure subroutine read_measure_card(card, cards, system, diagnostics, measure)
    type(card_t), intent(in) :: card                  !! the MEASURE card
    type(card_t), intent(in) :: cards(:)              !! all of the deck
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(measure_card_t), intent(out) :: measure      !! as read; names are not looked up

    type(card_kind_t) :: kind
    type(token_t) :: none
    logical :: fine

    none = token_t("", 0, 0)
    measure%nature = nature_of_measure(card, cards)
    measure%name = none
    measure%places(1) = none
    measure%places(2) = none
    measure%links(1) = none
    measure%links(2) = none
    measure%line = none
    allocate (measure%weights(0), measure%terms(0))
    if (size(card%words) < 2) then
      call check_form(card, diagnostics, fine)
      return
    end if
    kind = kind_of_card(card%keyword%text)
    call read_choice(card%words(2), trim(kind%choices), diagnostics, measure%kind)
    select case (measure%kind)
    case (measure_distance)
      call check_form(card, diagnostics, fine, form="distance")
      if (fine) measure%places(1) = card%words(3)
      if (fine) measure%places(2) = card%words(4)
    case (measure_angle)
      call read_angle(card, diagnostics, measure, fine)
    case (measure_along, measure_across)
      call check_form(card, diagnostics, fine, form=trim(merge("along ", "across", measure%kind == &
        measure_along)))
      if (fine) measure%places(1) = card%words(3)
      if (fine) measure%line = card%words(4)
    case (measure_travel)
      call read_travel(card, system, diagnostics, measure, fine)
    case (measure_sum)
      call read_sum(card, system, diagnostics, measure, fine)
    case default
      fine = .false.
    end select
    if (.not. fine) return
    measure%name = card%words(1)
    call read_part_name(measure%name, diagnostics)
  end subroutine read_measure_card

  !> What a MEASURE card is about: a sum is as its first term.
  pure function nature_of_measure(card, cards) result(nature)
    type(card_t), intent(in) :: card     !! the MEASURE card
    type(card_t), intent(in) :: cards(:) !! all of the deck
    type(nature_t) :: nature

    type(token_t) :: word
    integer :: term

    nature = length_nature
    if (size(card%words) < 3) return
    word = card%words(2)
    if (same_word(word%text, "sum") .and. size(card%words) > 3) then
      associate (name => card%words(4)%text)
        term = card_named(cards, "MEASURE", name)
        ! Sums of sums are refused later.
        if (term == 0) term = max(card_named(cards, "SPRING", name), &
          card_named(cards, "DAMPER", name))
      end associate
      if (term == 0) return
      associate (words => cards(term)%words)
        if (same_word(cards(term)%keyword%text, "MEASURE")) then
          if (size(words) > 1) word = words(2)
        else if (card_named(cards, "LINK", words(size(words))%text) > 0) then
          nature = angle_nature
        end if
      end associate
    end if
    if (same_word(word%text, "angle")) nature = angle_nature
  end function nature_of_measure

  !> The first card of a keyword whose first word is a name; 0: there is none.
  pure function card_named(cards, keyword, name) result(number)
    type(card_t), intent(in) :: cards(:)     !! all of the deck
    character(len=*), intent(in) :: keyword
    character(len=*), intent(in) :: name     !! in any case of letters
    integer :: number

    do number = 1, size(cards)
      if (.not. same_word(cards(number)%keyword%text, keyword)) cycle
      if (size(cards(number)%words) == 0) cycle
      if (same_word(cards(number)%words(1)%text, name)) return
    end do
    number = 0
  end function card_named

  !> Reads `angle link [against link]`.
  pure subroutine read_angle(card, diagnostics, measure, fine)
    type(card_t), intent(in) :: card
    type(diagnostics_t), intent(inout) :: diagnostics
    type(measure_card_t), intent(inout) :: measure
    logical, intent(out) :: fine

    call check_form(card, diagnostics, fine, form="angle")
    if (.not. fine) return
    measure%links(1) = card%words(3)
    if (size(card%words) == 3) return
    fine = same_word(card%words(4)%text, "against")
    if (fine .and. size(card%words) == 5) then
      measure%links(2) = card%words(5)
    else if (fine) then
      fine = .false.
      call add_error(diagnostics, card%words(4), "'against' is followed by a link; expected: "// &
        form_of("angle"))
    else
      call add_error(diagnostics, card%words(4), "unexpected '"//card%words(4)%text// &
        "'; expected: "//form_of("angle"))
    end if
  end subroutine read_angle

  pure function form_of(form) result(pattern)
    character(len=*), intent(in) :: form
    character(len=:), allocatable :: pattern

    type(card_kind_t) :: kind

    kind = kind_of_card("MEASURE", form)
    pattern = trim(kind%pattern)
  end function form_of

  !> Reads `travel pin dx dy`.
  pure subroutine read_travel(card, system, diagnostics, measure, fine)
    type(card_t), intent(in) :: card
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(measure_card_t), intent(inout) :: measure
    logical, intent(out) :: fine

    logical :: is_number
    integer :: k

    call check_form(card, diagnostics, fine, form="travel")
    if (.not. fine) return
    measure%places(1) = card%words(3)
    do k = 1, 2
      call read_quantity(card%words(3 + k), dimension_none, system, diagnostics, &
        measure%direction(k), is_number)
      fine = fine .and. is_number
    end do
    if (.not. fine) return
    fine = norm2(measure%direction) > 0.0_wp
    if (fine) then
      measure%direction = measure%direction/norm2(measure%direction)
    else
      call add_error(diagnostics, card%words(4), "a travel has a direction, and 0 0 is none")
    end if
  end subroutine read_travel

  !> Reads `sum weight name weight name …`.
  pure subroutine read_sum(card, system, diagnostics, measure, fine)
    type(card_t), intent(in) :: card
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(measure_card_t), intent(inout) :: measure
    logical, intent(out) :: fine

    logical :: is_number
    integer :: i, terms

    call check_form(card, diagnostics, fine, form="sum")
    if (.not. fine) return
    terms = size(card%words)/2 - 1
    if (mod(size(card%words), 2) /= 0) then
      fine = .false.
      call add_error(diagnostics, card%words(size(card%words)), "a sum has a weight before "// &
        "every name; expected: "//form_of("sum"))
      return
    end if
    deallocate (measure%weights, measure%terms)
    allocate (measure%weights(terms), measure%terms(terms))
    do i = 1, terms
      call read_quantity(card%words(2*i + 1), dimension_none, system, diagnostics, &
        measure%weights(i), is_number)
      fine = fine .and. is_number
      measure%terms(i) = card%words(2*i + 2)
    end do
  end subroutine read_sum

end module measure_cards
