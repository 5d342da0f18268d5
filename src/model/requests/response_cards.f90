!> DAMPING, GAUGE and EFFECTS response cards: the elastic response of links in a turning linkage.
!! Names are looked up later, by `response_checks`.
module response_cards
  use body_cards, only: read_place
  use card_reader, only: check_form, has_key, has_value, key_of, read_choice, read_entry_quantity, &
    read_name, refuse_negative, value_of
  use card_table, only: card_kind_t, kind_of_card
  use cards, only: card_t
  use diagnostics, only: add_error, diagnostics_t
  use kinds, only: wp
  use spelling, only: suggestion
  use text, only: joined, lower_case, same_word, word_list
  use tokens, only: earlier, later, token_t
  use units, only: dimension_none, dimension_time, unit_system_t
  use value_lists, only: find_items
  implicit none (type, external)
  private

  public :: damping_card_t, gauge_card_t, omitted_terms_t, read_damping, read_gauge, &
    read_omitted_terms, is_response_form, side_left, side_right, response_form

  ! In the order of the words in the table of cards.
  integer, parameter :: side_left = 1, side_right = 2

  !> First word of the EFFECTS card on the elastic response.
  character(len=*), parameter :: response_form = "response"

  !> The damping of bending links: either a time or a ratio, unless the card is wrong.
  type :: damping_card_t
    type(token_t) :: keyword
    type(token_t), allocatable :: link_names(:) !! `*`: bending links without a card of their own
    logical :: has_time = .false.  !! `time=` is given
    logical :: has_ratio = .false. !! `ratio=` is given
    real(wp) :: time = 0.0_wp      !! Kelvin–Voigt time c: stress E(ε + c dε/dt) [s]
    real(wp) :: ratio = 0.0_wp     !! damping ratio of the link's own modes, below 1 [-]
  end type damping_card_t

  !> A strain gauge on a face of a link.
  type :: gauge_card_t
    type(token_t) :: name      !! without a line if the card lacks it
    type(token_t) :: link_name !! likewise
    integer :: link = 0        !! number in the model's list; 0: unknown
    real(wp) :: at = 0.0_wp    !! from the first pin of the LINK card along the link [m]
    type(token_t) :: at_word   !! value of `at=`, or the keyword without one
    integer :: side = side_right !! looking from the first pin of the LINK card to the second
  end type gauge_card_t

  !> Terms that are left out of the equations of the response.
  type :: omitted_terms_t
    type(token_t) :: keyword       !! of the card; without a line if the deck has none
    logical :: coriolis = .false.
    logical :: centripetal = .false.
    logical :: tangential = .false.
    logical :: axial = .false.     !! the geometric stiffness
    logical :: quadratic = .false. !! of the driving torque
  end type omitted_terms_t

contains

  !> Reads `DAMPING link … time=` or `DAMPING link … ratio=`; `*` stands for every bending link
  !! without a card of its own. Errors: words or keys that do not fit the card, both keys or
  !! neither, an unreadable or negative value, a ratio of 1 or more.
  pure subroutine read_damping(card, system, diagnostics, damping)
    type(card_t), intent(in) :: card                  !! the DAMPING card
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(damping_card_t), intent(out) :: damping      !! as read; the links are not looked up

    type(token_t) :: word
    logical :: fine, known_keys

    damping%keyword = card%keyword
    damping%link_names = card%words
    call check_form(card, diagnostics, fine, known_keys)
    if (has_key(card, "time") .and. has_key(card, "ratio")) then
      call refuse_both(card, diagnostics)
      return
    end if
    if (known_keys .and. .not. has_key(card, "time") .and. .not. has_key(card, "ratio")) then
      call add_error(diagnostics, card%keyword, "'time=' or 'ratio=' is missing; expected the "// &
        "time of Kelvin-Voigt damping, or the damping ratio of the link's own modes")
    end if
    call read_entry_quantity(card, "time", dimension_time, system, .false., diagnostics, &
      damping%time, damping%has_time)
    if (damping%has_time) call refuse_negative(value_of(card, "time"), &
      damping%time, "a damping time", diagnostics)
    call read_entry_quantity(card, "ratio", dimension_none, system, .false., diagnostics, &
      damping%ratio, damping%has_ratio)
    if (.not. damping%has_ratio) return
    word = value_of(card, "ratio")
    call refuse_negative(word, damping%ratio, "a damping ratio", diagnostics)
    if (damping%ratio >= 1.0_wp) call add_error(diagnostics, word, &
      "a damping ratio must be less than 1, not "//word%text)
  end subroutine read_damping

  !> Reports that both keys are given, at the later one.
  pure subroutine refuse_both(card, diagnostics)
    type(card_t), intent(in) :: card
    type(diagnostics_t), intent(inout) :: diagnostics

    type(token_t) :: first

    first = earlier(key_of(card, "time"), key_of(card, "ratio"))
    call add_error(diagnostics, later(key_of(card, "time"), key_of(card, "ratio")), "the "// &
      "damping of a link is given by 'time=' or by 'ratio=', not by both", first, "'"// &
      first%text//"=' is given here")
  end subroutine refuse_both

  !> Reads `GAUGE name link at= [side=left|right]`. Errors: words or keys that do not fit the card,
  !! an invalid name, no `at=`, unreadable values.
  pure subroutine read_gauge(card, system, diagnostics, gauge)
    type(card_t), intent(in) :: card                  !! the GAUGE card
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(gauge_card_t), intent(out) :: gauge               !! as read; the link is not looked up

    type(card_kind_t) :: kind
    real(wp) :: place(2)
    integer :: choice
    logical :: fine, known_keys

    gauge%name = token_t("", 0, 0)
    gauge%link_name = token_t("", 0, 0)
    call check_form(card, diagnostics, fine, known_keys)
    if (size(card%words) > 0) then
      gauge%name = card%words(1)
      call read_name(gauge%name, diagnostics)
    end if
    if (size(card%words) > 1) gauge%link_name = card%words(2)
    ! It has no `offset=`: the second coordinate stays 0.
    call read_place(card, "at", known_keys, system, diagnostics, place, gauge%at_word)
    gauge%at = place(1)
    if (.not. has_value(card, "side")) return
    kind = kind_of_card(card%keyword%text)
    call read_choice(value_of(card, "side"), trim(kind%choices), diagnostics, choice)
    if (choice > 0) gauge%side = choice
  end subroutine read_gauge

  !> Whether an EFFECTS card is about the elastic response, not about frequencies.
  pure function is_response_form(card) result(is)
    type(card_t), intent(in) :: card !! of any kind
    logical :: is

    is = .false.
    if (.not. same_word(card%keyword%text, "EFFECTS")) return
    is = has_key(card, "without")
    if (size(card%words) > 0) is = is .or. same_word(card%words(1)%text, response_form)
  end function is_response_form

  !> Reads `EFFECTS response without=` and a list of terms. Errors: words or keys that do not fit
  !! the card, no `without=`, an unknown term, a term given twice.
  pure subroutine read_omitted_terms(card, diagnostics, terms)
    type(card_t), intent(in) :: card                  !! an EFFECTS card of this form
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(omitted_terms_t), intent(out) :: terms       !! as read

    type(card_kind_t) :: kind
    type(token_t), allocatable :: words(:)
    integer :: first(5), choice, i !! `first`: number of each term in the list, 0: absent
    logical :: fine, known_keys

    terms%keyword = card%keyword
    call check_form(card, diagnostics, fine, known_keys, response_form)
    kind = kind_of_card(card%keyword%text, response_form)
    if (fine) fine = same_word(card%words(1)%text, response_form)
    if (.not. fine .and. size(card%words) == 1) call add_error(diagnostics, card%words(1), &
      "unknown word '"//card%words(1)%text//"'"//suggestion(card%words(1)%text, &
      word_list(response_form))//"; expected: "//trim(kind%pattern))
    if (known_keys .and. .not. has_key(card, "without")) call add_error(diagnostics, &
      card%keyword, "'without=' is missing; expected one or several of: "// &
      joined(word_list(trim(kind%choices)))//", with commas between them")
    if (.not. has_value(card, "without")) return
    call find_items(card, "without", diagnostics, words, fine)
    if (.not. fine) return
    first = 0
    do i = 1, size(words)
      call read_choice(words(i), trim(kind%choices), diagnostics, choice)
      if (choice == 0) cycle
      if (first(choice) > 0) then
        call add_error(diagnostics, words(i), "'"//lower_case(words(i)%text)// &
          "' is given twice", words(first(choice)), "first given here")
        cycle
      end if
      first(choice) = i
    end do
    terms%coriolis = first(1) > 0
    terms%centripetal = first(2) > 0
    terms%tangential = first(3) > 0
    terms%axial = first(4) > 0
    terms%quadratic = first(5) > 0
  end subroutine read_omitted_terms

end module response_cards
