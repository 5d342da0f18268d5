!> The cards of a deck with values in place of its `$name`s: one set of cards, or one per variant of
!! a deck with VARY.
module variants
  use card_reader, only: value_of
  use cards, only: card_t
  use deck_source, only: source_t
  use diagnostics, only: add_error, diagnostics_t, has_errors
  use expressions, only: operand_t
  use kinds, only: long, wp
  use numbers, only: shortest_text
  use report_kinds, only: report_kind_t
  use setting_values, only: find_fixed_values, find_varying_values, mark_uses
  use settings, only: no_name, read_settings, setting_t, settings_t, warn_of_unused_settings
  use substitution, only: put_value, slot_t, substitute
  use table_cards, only: find_columns, number_table_t, table_number
  use text, only: same_word, string_t, to_string
  use tokens, only: token_t, token_texts
  use variations, only: get_value_word, read_column, read_variation, value_word, variation_t
  implicit none (type, external)
  private

  public :: deck_cards_t, read_deck_cards, variant_count, take_variant, take_values, &
    variant_values, variant_text, text_of_values, parameter_names

  !> All cards of a deck, and the values of its `$name`s.
  type :: deck_cards_t
    type(card_t), allocatable :: written(:)         !! (cards) as they stand in the files
    type(report_kind_t), allocatable :: reports(:)  !! the table of reports
    type(settings_t) :: settings                    !! of SET, VARY and `--set`
    type(variation_t), allocatable :: variations(:) !! (variations) in the order of the deck; the
                                                    !! last one varies fastest
    type(card_t), allocatable, private :: fixed(:)  !! (cards) with the values of SET in place
    type(slot_t), allocatable, private :: slots(:)  !! (slots) where values go that vary
  end type deck_cards_t

  integer, parameter :: most_variants = 1000000

contains

  !> Reads the SET and VARY cards of a deck, and finds every `$name`.
  !!
  !! Errors: those of `read_settings`, `find_fixed_values`, `substitute` and `read_variation`; a
  !! VARY that no card uses or whose values vary themselves; too many variants. Warnings: a SET that
  !! nothing uses.
  pure subroutine read_deck_cards(cards, options, source, reports, diagnostics, deck)
    type(card_t), allocatable, intent(inout) :: cards(:) !! moved into `deck`
    type(string_t), intent(in) :: options(:)             !! of the command line, each `name=value`
    type(source_t), intent(inout) :: source              !! the options are appended to it as places
                                                         !! of messages
    type(report_kind_t), intent(in) :: reports(:)        !! the table of reports
    type(diagnostics_t), intent(inout) :: diagnostics    !! errors and warnings are added
    type(deck_cards_t), intent(out) :: deck              !! complete if there are no errors

    deck%reports = reports
    call move_alloc(cards, deck%written)
    allocate (deck%variations(0), deck%slots(0))
    call read_settings(deck%written, options, source, diagnostics, deck%settings)
    call find_fixed_values(deck%written, diagnostics, deck%settings)
    deck%fixed = deck%written
    call substitute(deck%fixed, deck%settings, diagnostics, deck%slots)
    call warn_of_unused_settings(deck%settings, diagnostics)
    call read_variations(deck, diagnostics)
  end subroutine read_deck_cards

  !> Reads the VARY cards, but for the names that the command line overrides.
  pure subroutine read_variations(deck, diagnostics)
    type(deck_cards_t), intent(inout) :: deck
    type(diagnostics_t), intent(inout) :: diagnostics

    type(variation_t), allocatable :: list(:)
    integer(long) :: variants
    integer :: i, k, count
    logical :: all_found !! whether every `$name` so far is known
    logical :: is_used(size(deck%settings%list)) !! by a card, also by way of other settings

    all_found = .not. has_errors(diagnostics)
    call refuse_varied_variations(deck, diagnostics)
    allocate (list(size(deck%settings%list)))
    is_used = .false.
    is_used(deck%slots%setting) = .true.
    call mark_uses(deck%settings, is_used)
    count = 0
    variants = 1
    do i = 1, size(list)
      associate (setting => deck%settings%list(i))
        if (.not. setting%is_varied) cycle
        if (setting%column > 0) then
          call read_varied_column(deck, i, diagnostics, list(count + 1))
        else if (size(deck%fixed(setting%card)%words) > 1) then
          call read_variation(deck%fixed(setting%card), i, deck%fixed, deck%reports, diagnostics, &
            list(count + 1))
        else
          cycle
        end if
        count = count + 1
        list(count)%card = setting%card
        if (.not. is_used(i) .and. all_found) call tell_of_no_use(setting, diagnostics)
        if (.not. is_first_of_card(list(:count), count)) cycle
        variants = min(variants*max(1, size(list(count)%value)), most_variants + 1_long)
        if (variants > most_variants .and. .not. has_errors(diagnostics)) then
          call add_error(diagnostics, setting%name, "there are more than "// &
            to_string(most_variants)//" variants")
        end if
      end associate
    end do
    deallocate (deck%variations)
    allocate (deck%variations(count))
    do k = 1, count
      deck%variations(k) = list(k)
    end do
  end subroutine read_variations

  !> Reads the values of a name from its column of a table. What is wrong with the table is told at
  !! the first name of the card.
  pure subroutine read_varied_column(deck, number, diagnostics, variation)
    type(deck_cards_t), intent(in) :: deck
    integer, intent(in) :: number !! of the name among the settings
    type(diagnostics_t), intent(inout) :: diagnostics
    type(variation_t), intent(out) :: variation

    type(number_table_t) :: table
    type(token_t) :: name
    type(diagnostics_t) :: told
    logical :: fine, is_first

    associate (setting => deck%settings%list(number), list => deck%settings%list)
      name = value_of(deck%fixed(setting%card), "table")
      is_first = number == findloc(list%card == setting%card .and. list%is_varied, .true., dim=1)
      fine = name%line > 0
      if (fine .and. is_first) then
        call find_columns(deck%fixed, name, size(deck%fixed(setting%card)%words), &
          "the names on the card", diagnostics, table, fine)
        if (fine .and. size(table%words, 2) == 0) call add_error(diagnostics, name, &
          "the table '"//name%text//"' has no rows")
      else if (fine) then
        call find_columns(deck%fixed, name, size(deck%fixed(setting%card)%words), "", told, table, &
          fine)
      end if
      if (fine) then
        call read_column(setting%name, number, table%units(setting%column), &
          table%words(setting%column, :), deck%fixed, deck%reports, diagnostics, variation)
      else
        variation%name = setting%name
        variation%setting = number
        variation%unit = ""
        allocate (variation%value(0))
      end if
    end associate
  end subroutine read_varied_column

  !> Whether a variation is the first one of its card.
  pure function is_first_of_card(variations, number) result(is)
    type(variation_t), intent(in) :: variations(:)
    integer, intent(in) :: number
    logical :: is

    is = number == 1
    if (.not. is) is = variations(number - 1)%card /= variations(number)%card
  end function is_first_of_card

  !> Adds the error that nothing uses a name of a VARY.
  pure subroutine tell_of_no_use(setting, diagnostics)
    type(setting_t), intent(in) :: setting
    type(diagnostics_t), intent(inout) :: diagnostics

    if (setting%column == 0) then
      call add_error(diagnostics, setting%name, "no card uses '$"//setting%name%text// &
        "': all variants would be the same")
    else
      call add_error(diagnostics, setting%name, "no card uses '$"//setting%name%text// &
        "': write "//no_name//" for a column that the deck does not take")
    end if
  end subroutine tell_of_no_use

  !> Errors: a value on a VARY card, or in its table, is varied itself; it would have to be known
  !! before the variants.
  pure subroutine refuse_varied_variations(deck, diagnostics)
    type(deck_cards_t), intent(inout) :: deck
    type(diagnostics_t), intent(inout) :: diagnostics

    integer :: k

    do k = 1, size(deck%slots)
      associate (slot => deck%slots(k))
        if (.not. gives_variants(deck%fixed, slot%card)) cycle
        ! A key on the card is reported as an error of its own.
        if (slot%word == 0) cycle
        call add_error(diagnostics, deck%fixed(slot%card)%words(slot%word), &
          "the values of a VARY cannot vary themselves", deck%settings%list(slot%setting)%name, &
          "this one does")
        call mark_unknown(deck%fixed, slot)
      end associate
    end do
  end subroutine refuse_varied_variations

  !> Whether a card is a VARY, or the table of one.
  pure function gives_variants(cards, number) result(gives)
    type(card_t), intent(in) :: cards(:)
    integer, intent(in) :: number !! of the card
    logical :: gives

    type(token_t) :: name
    integer :: i

    gives = same_word(cards(number)%keyword%text, "VARY")
    if (gives .or. .not. same_word(cards(number)%keyword%text, "TABLE")) return
    do i = 1, size(cards)
      if (.not. same_word(cards(i)%keyword%text, "VARY")) cycle
      name = value_of(cards(i), "table")
      if (name%line == 0) cycle
      gives = gives .or. table_number(cards, name%text) == number
    end do
  end function gives_variants

  !> Number of variants of a deck; 1 without VARY, 0 if a VARY has no values after an error.
  pure function variant_count(deck) result(count)
    type(deck_cards_t), intent(in) :: deck !! with or without errors
    integer :: count

    integer :: k

    count = 1
    do k = 1, size(deck%variations)
      if (is_first_of_card(deck%variations, k)) count = count*size(deck%variations(k)%value)
    end do
  end function variant_count

  !> The cards of a variant. Given the cards of another variant of the same deck, it only replaces
  !! the values of VARY.
  !!
  !! Errors: arithmetic that these values do not allow. Slots of a variation without values, already
  !! reported as an error, are marked as unknown.
  pure subroutine take_variant(deck, number, cards, diagnostics)
    type(deck_cards_t), intent(in) :: deck               !! with or without errors
    integer, intent(in) :: number                        !! of the variant, from 1
    type(card_t), allocatable, intent(inout) :: cards(:) !! (cards) not allocated, or of another
                                                         !! variant
    type(diagnostics_t), intent(inout) :: diagnostics    !! errors are added

    type(token_t) :: words(size(deck%variations))
    integer :: choice(size(deck%variations)), k

    choice = choices(deck, number)
    do k = 1, size(words)
      words(k) = token_t("", 0)
      if (size(deck%variations(k)%value) > 0) call get_value_word(deck%variations(k), choice(k), &
        words(k))
    end do
    call put_words(deck, words, cards, diagnostics)
  end subroutine take_variant

  !> Puts any values of the VARY cards in place.
  pure subroutine take_values(deck, values, cards, diagnostics)
    type(deck_cards_t), intent(in) :: deck               !! without errors
    real(wp), intent(in) :: values(:)                    !! (parameters) in the units of their cards
    type(card_t), allocatable, intent(inout) :: cards(:) !! (cards) as for `take_variant`
    type(diagnostics_t), intent(inout) :: diagnostics    !! likewise

    type(token_t) :: words(size(values))
    integer :: k

    do k = 1, size(values)
      words(k) = value_word(deck%variations(k), values(k))
    end do
    call put_words(deck, words, cards, diagnostics)
  end subroutine take_values

  !> Puts a word of every VARY card in place.
  pure subroutine put_words(deck, words, cards, diagnostics)
    type(deck_cards_t), intent(in) :: deck
    type(token_t), intent(in) :: words(:)                !! (variations) without a line: unknown
    type(card_t), allocatable, intent(inout) :: cards(:) !! (cards) as for `take_variant`
    type(diagnostics_t), intent(inout) :: diagnostics

    type(operand_t), allocatable :: values(:)
    integer :: k

    if (.not. allocated(cards)) cards = deck%fixed
    if (size(deck%slots) == 0) return
    call find_varying_values(deck%settings, deck%variations%setting, words, diagnostics, values)
    do k = 1, size(deck%slots)
      call put_value(cards, deck%slots(k), values(deck%slots(k)%setting), deck%settings%system, &
        diagnostics)
    end do
  end subroutine put_words

  !> Marks a value as unknown, so that no further error is reported for it.
  pure subroutine mark_unknown(cards, slot)
    type(card_t), intent(inout) :: cards(:)
    type(slot_t), intent(in) :: slot

    associate (card => cards(slot%card))
      if (slot%word > 0) then
        card%words(slot%word)%set_line = -1
      else
        card%entries(slot%entry)%value%set_line = -1
        if (slot%item > 0) card%entries(slot%entry)%items(slot%item)%set_line = -1
      end if
    end associate
  end subroutine mark_unknown

  !> Number of the value of each VARY in a variant; the last card varies fastest.
  pure function choices(deck, number) result(choice)
    type(deck_cards_t), intent(in) :: deck
    integer, intent(in) :: number
    integer :: choice(size(deck%variations))

    integer :: k, rest, count

    rest = number - 1
    do k = size(choice), 1, -1
      count = max(1, size(deck%variations(k)%value))
      choice(k) = 1 + mod(rest, count)
      if (is_first_of_card(deck%variations, k)) rest = rest/count
    end do
  end function choices

  !> The names on the VARY cards.
  pure function parameter_names(deck) result(names)
    type(deck_cards_t), intent(in) :: deck !! with or without errors
    type(string_t), allocatable :: names(:)

    allocate (names(0))
    if (allocated(deck%variations)) names = token_texts(deck%variations%name)
  end function parameter_names

  !> The value of every VARY in a variant, in the units of their cards; 0 of a card that cannot be
  !! read, which has none.
  pure function variant_values(deck, number) result(values)
    type(deck_cards_t), intent(in) :: deck !! with or without errors
    integer, intent(in) :: number          !! of the variant, from 1
    real(wp) :: values(size(deck%variations))

    integer :: choice(size(deck%variations)), k

    choice = choices(deck, number)
    values = 0.0_wp
    do k = 1, size(values)
      if (choice(k) <= size(deck%variations(k)%value)) values(k) = &
        deck%variations(k)%value(choice(k))
    end do
  end function variant_values

  !> `L=90.5mm w=2`; empty for a deck without VARY.
  pure function variant_text(deck, number) result(text)
    type(deck_cards_t), intent(in) :: deck !! without errors
    integer, intent(in) :: number          !! of the variant, from 1
    character(len=:), allocatable :: text

    text = text_of_values(deck, variant_values(deck, number))
  end function variant_text

  !> The same of any values.
  pure function text_of_values(deck, values) result(text)
    type(deck_cards_t), intent(in) :: deck !! without errors
    real(wp), intent(in) :: values(:)      !! (parameters) in the units of their cards
    character(len=:), allocatable :: text

    integer :: k

    text = ""
    do k = 1, size(values)
      if (k > 1) text = text//" "
      associate (variation => deck%variations(k))
        text = text//variation%name%text//"="//shortest_text(values(k))//variation%unit
      end associate
    end do
  end function text_of_values

end module variants
