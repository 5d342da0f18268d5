!> Reading and checking of a deck with all its variants.
module deck_readings
  use available_memory, only: available_memory_t, find_available_memory
  use card_echo, only: echo_cards
  use cards, only: card_t
  use deck_checks, only: check_mechanics
  use deck_source, only: read_source, source_from_text, source_t
  use diagnostics, only: add_error, add_warning, diagnostic_t, diagnostics_t, errors_of, &
    has_errors, render_errors, render_warnings, warning_texts, warnings_of
  use errors, only: error_of_input, error_t, rendered, set_error
  use file_system, only: base_name
  use includes, only: read_all_cards
  use memory_needs, only: check_memory
  use model_reader, only: read_model
  use models, only: model_t
  use report_table, only: reports
  use text, only: string_t, to_string
  use variants, only: deck_cards_t, read_deck_cards, take_variant, variant_count, variant_text, &
    variant_values
  implicit none (type, external)
  private

  public :: deck_t, read_deck, read_variant

  !> A deck as it was read.
  type :: deck_t
    type(source_t) :: source
    type(deck_cards_t) :: cards
    type(model_t) :: model                         !! of the first variant; the only one if nothing
                                                   !! varies
    type(diagnostics_t) :: diagnostics
    type(error_t), allocatable :: refusal          !! why it could not be read at all
    character(len=:), allocatable :: base          !! name of its output folder
    character(len=:), allocatable :: errors        !! ready for standard error; empty if none
    character(len=:), allocatable :: warnings      !! ready for standard error; empty if none
    character(len=:), allocatable :: warning_lines !! the warnings for the log
  end type deck_t

contains

  !> Reads and checks a deck, with all variants if it has a VARY card.
  !!
  !! Errors: the file cannot be read, or its name gives no folder for the results (both in
  !! `refusal`); a card is wrong, memory does not suffice, or a variant fails the checks (all in
  !! `diagnostics`).
  subroutine read_deck(path, threads, deck, settings)
    character(len=*), intent(in) :: path                !! `-`: standard input
    integer, intent(in) :: threads                      !! that will compute the deck
    type(deck_t), intent(out) :: deck                   !! as read; its model is complete only
                                                        !! without errors
    type(string_t), intent(in), optional :: settings(:) !! of the command line, each `name=value`

    type(card_t), allocatable :: cards(:)
    type(available_memory_t) :: available
    type(string_t) :: none(0)

    deck%base = base_name(path)
    if (path == "-") deck%base = "stdin"
    deck%errors = ""
    deck%warnings = ""
    deck%warning_lines = ""
    call read_source(path, deck%source, deck%refusal)
    if (.not. allocated(deck%refusal) .and. (deck%base == "" .or. deck%base == "." .or. &
      deck%base == "..")) then
      call set_error(deck%refusal, error_of_input, "this name gives no folder for the results", &
        path)
    end if
    if (allocated(deck%refusal)) then
      deck%source = source_from_text(path, "")
      deck%errors = rendered(deck%refusal)//achar(10)
      return
    end if
    call read_all_cards(deck%source, cards, deck%diagnostics)
    if (present(settings)) then
      call read_deck_cards(cards, settings, deck%source, reports, deck%diagnostics, &
        deck%cards)
    else
      call read_deck_cards(cards, none, deck%source, reports, deck%diagnostics, deck%cards)
    end if
    available = find_available_memory(threads)
    call read_variant(deck%cards, 1, cards, deck%diagnostics, deck%model)
    call check_variant(deck%model, threads, available, deck%diagnostics)
    if (.not. has_errors(deck%diagnostics)) then
      deck%model%echo = echo_cards(deck%cards, cards, deck%model%effects, reports, &
        deck%source)
      call check_variants(deck%cards, cards, deck%model, threads, available, deck%diagnostics)
    end if
    deck%errors = render_errors(deck%diagnostics, deck%source)
    deck%warnings = render_warnings(deck%diagnostics, deck%source)
    deck%warning_lines = warning_texts(deck%diagnostics, deck%source)
  end subroutine read_deck

  !> Turns the cards of one variant into a model; files are not read again. A deck without VARY has
  !! one variant. Errors: a card of the variant is wrong.
  subroutine read_variant(deck_cards, number, cards, diagnostics, model)
    type(deck_cards_t), intent(in) :: deck_cards         !! of all variants
    integer, intent(in) :: number                        !! of the variant, from 1
    type(card_t), allocatable, intent(inout) :: cards(:) !! of another variant, or not allocated; on
                                                         !! return, of this one
    type(diagnostics_t), intent(inout) :: diagnostics    !! of the cards, with new ones appended
    type(model_t), intent(out) :: model                  !! complete only if there are no errors on
                                                         !! return

    call take_variant(deck_cards, number, cards)
    call read_model(cards, reports, diagnostics, model)
    if (has_errors(diagnostics)) return
    model%variant = variant_text(deck_cards, number)
    model%varied = variant_values(deck_cards, number)
  end subroutine read_variant

  !> Whether memory suffices for a model, and then whether it makes sense mechanically.
  subroutine check_variant(model, threads, available, diagnostics)
    type(model_t), intent(in) :: model
    integer, intent(in) :: threads
    type(available_memory_t), intent(in) :: available
    type(diagnostics_t), intent(inout) :: diagnostics !! of the model; if it has errors, nothing
                                                      !! more is checked

    if (.not. has_errors(diagnostics)) call check_memory(model, threads, available, diagnostics)
    if (.not. has_errors(diagnostics)) call check_mechanics(model, diagnostics)
  end subroutine check_variant

  !> Checks every variant but the first, which has been checked: nothing is computed before all
  !! variants are known to be sound.
  !!
  !! The first variant that is refused is reported in full, the others are counted. Of several
  !! warnings at the same place only the first is reported.
  subroutine check_variants(deck_cards, cards, first, threads, available, diagnostics)
    type(deck_cards_t), intent(in) :: deck_cards
    type(card_t), allocatable, intent(inout) :: cards(:) !! of the first variant
    type(model_t), intent(in) :: first
    integer, intent(in) :: threads
    type(available_memory_t), intent(in) :: available
    type(diagnostics_t), intent(inout) :: diagnostics

    type(diagnostics_t) :: mine
    type(model_t) :: model
    integer :: number, refused, last_refused

    refused = 0
    last_refused = 0
    do number = 2, variant_count(deck_cards)
      call clear(mine)
      call read_variant(deck_cards, number, cards, mine, model)
      call check_variant(model, threads, available, mine)
      if (.not. has_errors(mine) .and. model%modes /= first%modes) then
        call add_error(mine, model%modes_word, &
          "all variants must have as many modes: they are columns of one table")
      else if (.not. has_errors(mine) .and. model%effects /= first%effects) then
        call add_error(mine, deck_cards%variations(1)%name, &
          "of this variant and the first one, one stands still without "// &
          "loads and one does not: EFFECTS must say whether axial forces act")
      end if
      call take_warnings(mine, variant_text(deck_cards, number), diagnostics)
      if (.not. has_errors(mine)) cycle
      refused = refused + 1
      last_refused = number
      if (refused == 1) call take_errors(mine, variant_text(deck_cards, number), diagnostics)
    end do
    if (refused < 2) return
    call add_error(diagnostics, deck_cards%variations(1)%name, to_string(refused)//" of "// &
      to_string(variant_count(deck_cards))//" variants are refused, the last one with "// &
      variant_text(deck_cards, last_refused))
  end subroutine check_variants

  !> Removes all messages.
  pure subroutine clear(diagnostics)
    type(diagnostics_t), intent(out) :: diagnostics
  end subroutine clear

  !> Adds the errors of a variant, each after the values that the variant has.
  subroutine take_errors(mine, variant, diagnostics)
    type(diagnostics_t), intent(in) :: mine
    character(len=*), intent(in) :: variant
    type(diagnostics_t), intent(inout) :: diagnostics

    type(diagnostic_t), allocatable :: list(:)
    integer :: i

    list = errors_of(mine)
    do i = 1, size(list)
      if (len(list(i)%note) > 0) then
        call add_error(diagnostics, list(i)%place, "with "//variant//": "//list(i)%message, &
          list(i)%second_place, list(i)%note)
      else
        call add_error(diagnostics, list(i)%place, "with "//variant//": "//list(i)%message)
      end if
    end do
  end subroutine take_errors

  !> Adds the warnings of a variant at places that have none yet.
  subroutine take_warnings(mine, variant, diagnostics)
    type(diagnostics_t), intent(in) :: mine
    character(len=*), intent(in) :: variant
    type(diagnostics_t), intent(inout) :: diagnostics

    type(diagnostic_t), allocatable :: new(:), told(:)
    integer :: i

    new = warnings_of(mine)
    if (size(new) == 0) return
    told = warnings_of(diagnostics)
    do i = 1, size(new)
      if (any(told%place%line == new(i)%place%line .and. told%place%column == &
        new(i)%place%column)) cycle
      call add_warning(diagnostics, new(i)%place, "with "//variant//": "//new(i)%message)
    end do
  end subroutine take_warnings

end module deck_readings
