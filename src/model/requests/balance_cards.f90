!> BALANCE cards: counterweights that minimise what shakes and drives a linkage, and balance shafts.
!! Names are looked up later, by `balance_checks`.
module balance_cards
  use card_reader, only: check_form, has_key, has_value, key_of, read_choice, read_entry_count, &
    read_entry_quantity, read_quantity, refuse_negative, require_positive, value_of
  use card_table, only: card_kind_t, kind_of_card
  use cards, only: card_t
  use diagnostics, only: add_error, diagnostics_t
  use kinds, only: wp
  use text, only: joined, lower_case, same_word, to_string, word_list
  use tokens, only: later, token_t
  use units, only: dimension_density, dimension_inertia, dimension_length, dimension_none, &
    unit_system_t
  use value_lists, only: find_items
  implicit none (type, external)
  private

  public :: balance_card_t, shaft_card_t, weight_make_t, read_balance, read_shaft, is_shaft_form, &
    shaft_form, highest_order

  !> First word of the BALANCE card on balance shafts.
  character(len=*), parameter :: shaft_form = "shaft"

  !> Of a harmonic that balance shafts cancel: the tables have no more.
  integer, parameter :: highest_order = 10

  !> Of what a counterweight is made.
  type :: weight_make_t
    real(wp) :: density = 0.0_wp        !! of a disc [kg/m³]; 0: no disc
    real(wp) :: thickness = 0.0_wp      !! of the disc [m]
    real(wp) :: inertia = 0.0_wp        !! about its mass centre [kg m²]
  end type weight_make_t

  !> Counterweights on links.
  type :: balance_card_t
    type(token_t) :: keyword                    !! without a line if the deck has none
    type(token_t), allocatable :: link_names(:) !! none: all links that turn about a ground pivot
    integer, allocatable :: links(:)            !! numbers in the model's list
    real(wp) :: aim(3) = 0.0_wp                 !! weights of force, moment and torque; 0: no aim
    real(wp), allocatable :: radius(:)          !! none, one, or one per link [m]
    type(token_t) :: radius_word                !! without a line if the card lacks it
    type(weight_make_t) :: make
  end type balance_card_t

  !> A pair of balance shafts.
  type :: shaft_card_t
    type(token_t) :: keyword           !! without a line if the card is one on links
    integer :: order = 0               !! of the harmonic; 0: not read
    type(token_t) :: order_word
    logical :: is_placed = .false.     !! `at=` is given
    real(wp) :: place(2, 2) = 0.0_wp   !! (2, shafts) with and against the crank [m]
    real(wp) :: radius = 0.0_wp        !! 0: not given [m]
    type(weight_make_t) :: make
  end type shaft_card_t

contains

  !> Whether a BALANCE card is about shafts. A link may have that name.
  pure function is_shaft_form(card) result(is)
    type(card_t), intent(in) :: card !! of any kind
    logical :: is

    is = .false.
    if (.not. same_word(card%keyword%text, "BALANCE")) return
    is = has_key(card, "order")
    if (size(card%words) > 0) is = is .or. same_word(card%words(1)%text, shaft_form) .and. &
      .not. has_key(card, "minimise")
  end function is_shaft_form

  !> Reads `BALANCE [link …] minimise=force,moment,torque [weights=] [radius=]` with `density=
  !! thickness=` or `inertia=`. Errors: keys that do not fit the card, no `minimise=`, unknown aims
  !! or one given twice, the torque alone, not one weight an aim, negative weights or none above 0,
  !! a radius that is not above 0, and what `read_make` reports.
  pure subroutine read_balance(card, system, diagnostics, balance)
    type(card_t), intent(in) :: card                  !! a BALANCE card of this form
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(balance_card_t), intent(out) :: balance      !! as read; the links are not looked up

    type(token_t), allocatable :: words(:)
    logical :: fine, known_keys
    real(wp) :: value
    integer :: i

    balance%keyword = card%keyword
    balance%link_names = card%words
    balance%radius_word = token_t("", 0, 0)
    allocate (balance%links(0), balance%radius(0))
    call check_form(card, diagnostics, fine, known_keys)
    call read_aims(card, known_keys, system, diagnostics, balance)
    if (has_value(card, "radius")) then
      call find_items(card, "radius", diagnostics, words, fine)
      if (fine) balance%radius_word = words(1)
      do i = 1, merge(size(words), 0, fine)
        call read_quantity(words(i), dimension_length, system, diagnostics, value, fine)
        if (fine .and. .not. value > 0.0_wp) call add_error(diagnostics, words(i), &
          "'radius=' must be greater than 0, not "//words(i)%text)
        balance%radius = [balance%radius, value]
      end do
    end if
    call read_make(card, system, diagnostics, balance%make)
  end subroutine read_balance

  !> Reads what is minimised, and how much each counts.
  pure subroutine read_aims(card, known_keys, system, diagnostics, balance)
    type(card_t), intent(in) :: card
    logical, intent(in) :: known_keys !! no key is unknown: a missing one is an error
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(balance_card_t), intent(inout) :: balance

    type(card_kind_t) :: kind
    type(token_t), allocatable :: aims(:), words(:)
    real(wp), allocatable :: weights(:)
    integer, allocatable :: choices(:)
    integer :: i
    logical :: fine, all_fine

    kind = kind_of_card(card%keyword%text)
    if (.not. has_value(card, "minimise")) then
      if (known_keys .and. .not. has_key(card, "minimise")) call add_error(diagnostics, &
        card%keyword, "'minimise=' is missing; expected one or several of: "// &
        joined(word_list(trim(kind%choices)))//", with commas between them")
      return
    end if
    call find_items(card, "minimise", diagnostics, aims, all_fine)
    if (.not. all_fine) return
    allocate (choices(size(aims)), weights(size(aims)))
    do i = 1, size(aims)
      call read_choice(aims(i), trim(kind%choices), diagnostics, choices(i))
      all_fine = all_fine .and. choices(i) > 0
      if (.not. any(choices(:i - 1) == choices(i)) .or. choices(i) == 0) cycle
      call add_error(diagnostics, aims(i), "'"//lower_case(aims(i)%text)//"' is given twice", &
        aims(findloc(choices, choices(i), dim=1)), "first given here")
      all_fine = .false.
    end do
    if (.not. all_fine) return
    if (all(choices == 3)) call add_error(diagnostics, aims(1), "the torque depends on "// &
      "moments of inertia alone, so that the direction of a counterweight does not follow from "// &
      "it; expected force or moment beside it")
    weights = 1.0_wp
    if (has_value(card, "weights")) then
      call find_items(card, "weights", diagnostics, words, fine)
      if (.not. fine) return
      if (size(words) /= size(aims)) then
        call add_error(diagnostics, words(1), "'weights=' has "//to_string(size(words))// &
          trim(merge(" value ", " values", size(words) == 1))//", and 'minimise=' "// &
          to_string(size(aims))//"; expected one for each", aims(1), "these are to be minimised")
        return
      end if
      do i = 1, size(words)
        call read_quantity(words(i), dimension_none, system, diagnostics, weights(i), fine)
        if (fine) call refuse_negative(words(i), weights(i), "a weight", diagnostics)
        all_fine = all_fine .and. fine
      end do
      if (.not. all_fine) return
      if (all(weights <= 0.0_wp)) call add_error(diagnostics, words(1), &
        "all weights are 0: nothing is to be minimised")
    end if
    do i = 1, size(choices)
      balance%aim(choices(i)) = weights(i)
    end do
  end subroutine read_aims

  !> Reads `BALANCE shaft order= [at=x,y] [radius=]` with `density= thickness=` or `inertia=`.
  !! Errors: words or keys that do not fit the card, no `order=` or one that is no whole number from
  !! 1 to 10, places that are not two or four lengths, a radius that is not above 0, and what
  !! `read_make` reports.
  pure subroutine read_shaft(card, system, diagnostics, shaft)
    type(card_t), intent(in) :: card                  !! a BALANCE card of this form
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(shaft_card_t), intent(out) :: shaft          !! as read

    type(card_kind_t) :: kind
    type(token_t), allocatable :: words(:)
    real(wp) :: values(4)
    logical :: fine, known_keys
    integer :: i

    shaft%keyword = card%keyword
    shaft%order_word = card%keyword
    kind = kind_of_card(card%keyword%text, shaft_form)
    call check_form(card, diagnostics, fine, known_keys, shaft_form)
    if (size(card%words) == 1) then
      if (.not. same_word(card%words(1)%text, shaft_form)) call add_error(diagnostics, &
        card%words(1), "unexpected '"//card%words(1)%text//"': 'order=' is of balance shafts; "// &
        "expected: "//trim(kind%pattern))
    end if
    if (has_value(card, "order")) then
      shaft%order_word = value_of(card, "order")
      call read_entry_count(card, "order", 1, diagnostics, shaft%order, fine)
      if (fine .and. shaft%order > highest_order) call add_error(diagnostics, shaft%order_word, &
        "'order=' must be at most "//to_string(highest_order)//", not "//shaft%order_word%text)
      if (.not. fine) shaft%order = 0
    else if (known_keys .and. .not. has_key(card, "order")) then
      call add_error(diagnostics, card%keyword, "'order=' is missing; expected 1 for shafts at "// &
        "the speed of the crank, 2 for twice that speed")
    end if
    if (has_value(card, "at")) then
      call find_items(card, "at", diagnostics, words, fine)
      if (.not. fine) return
      if (size(words) /= 2 .and. size(words) /= 4) then
        call add_error(diagnostics, words(1), "'at=' has two lengths, x,y of both shafts, or "// &
          "four: x,y of the one that turns with the crank, then of the other")
      else
        do i = 1, size(words)
          call read_quantity(words(i), dimension_length, system, diagnostics, values(i), fine)
        end do
        if (size(words) == 2) values(3:) = values(:2)
        shaft%place = reshape(values, [2, 2])
        shaft%is_placed = .true.
      end if
    end if
    call read_entry_quantity(card, "radius", dimension_length, system, .false., diagnostics, &
      shaft%radius, fine)
    if (fine) call require_positive(card, "radius", shaft%radius, diagnostics)
    call read_make(card, system, diagnostics, shaft%make)
  end subroutine read_shaft

  !> Reads of what counterweights are made. Errors: both forms at once, a density without a
  !! thickness or the reverse, either form without `radius=`, values that are not above 0, a
  !! negative moment of inertia.
  pure subroutine read_make(card, system, diagnostics, make)
    type(card_t), intent(in) :: card
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(weight_make_t), intent(out) :: make

    type(token_t) :: disc, last
    logical :: has_density, has_thickness, has_inertia

    call read_entry_quantity(card, "density", dimension_density, system, .false., diagnostics, &
      make%density, has_density)
    if (has_density) call require_positive(card, "density", make%density, diagnostics)
    call read_entry_quantity(card, "thickness", dimension_length, system, .false., diagnostics, &
      make%thickness, has_thickness)
    if (has_thickness) call require_positive(card, "thickness", make%thickness, diagnostics)
    call read_entry_quantity(card, "inertia", dimension_inertia, system, .false., diagnostics, &
      make%inertia, has_inertia)
    if (has_inertia) call refuse_negative(value_of(card, "inertia"), make%inertia, &
      "a moment of inertia", diagnostics)
    disc = later(key_of(card, "density"), key_of(card, "thickness"))
    last = later(disc, key_of(card, "inertia"))
    if (disc%line > 0 .and. has_key(card, "inertia")) then
      call add_error(diagnostics, last, "the moment of inertia of a counterweight is given by "// &
        "'inertia=', or follows from the disc of 'density=' and 'thickness='; expected one of "// &
        "these")
    else if (has_key(card, "density") .neqv. has_key(card, "thickness")) then
      call add_error(diagnostics, disc, "a disc has a density and a thickness; expected '"// &
        trim(merge("thickness", "density  ", has_key(card, "density")))//"=' too")
    else if (last%line > 0 .and. .not. has_key(card, "radius")) then
      call add_error(diagnostics, last, "a counterweight with a moment of inertia of its own "// &
        "needs its distance from the pivot; expected 'radius=' too")
    end if
  end subroutine read_make

end module balance_cards
