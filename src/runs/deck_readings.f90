!> Reading and checking of a deck with all its variants.
module deck_readings
  use available_memory, only: available_memory_t, find_available_memory
  use card_echo, only: echo_cards
  use cards, only: card_t
  use deck_checks, only: check_mechanics
  use deck_source, only: read_source, source_from_text, source_t
  use diagnostics, only: add_error, add_warning, append_warnings, count_warnings, diagnostic_t, &
    diagnostics_t, errors_of, has_errors, has_other_errors, join_warnings, render_errors, &
    render_warnings
  use errors, only: error_of_input, error_of_reach, error_t, rendered, set_error
  use file_system, only: base_name
  use includes, only: read_all_cards
  use memory_needs, only: check_memory
  use model_reader, only: read_model
  use models, only: model_t
  use report_table, only: reports
  use table_files, only: add_table_files
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
  end type deck_t

  !> Kind of the warning about variants with positions out of reach, apart from other warnings at
  !! the same word.
  integer, parameter :: warning_of_reach = 1

contains

  !> Reads and checks a deck, with all variants if it has a VARY card.
  !!
  !! Errors: the file cannot be read, or its name gives no folder for the results (both in
  !! `refusal`); a card is wrong, memory does not suffice, or a variant fails the checks (all in
  !! `diagnostics`). Positions that only some variants do not reach are no errors.
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
    call add_table_files(deck%source, cards, deck%diagnostics)
    if (present(settings)) then
      call read_deck_cards(cards, settings, deck%source, reports, deck%diagnostics, &
        deck%cards)
    else
      call read_deck_cards(cards, none, deck%source, reports, deck%diagnostics, deck%cards)
    end if
    available = find_available_memory(threads)
    if (variant_count(deck%cards) > 1 .and. .not. has_errors(deck%diagnostics)) then
      call read_variants(deck, cards, threads, available)
    else
      call read_variant(deck%cards, 1, cards, deck%diagnostics, deck%model)
      call check_variant(deck%model, threads, available, deck%diagnostics)
      if (.not. has_errors(deck%diagnostics)) deck%model%echo = echo_cards(deck%cards, cards, &
        deck%model%effects, reports, deck%source)
    end if
    deck%errors = render_errors(deck%diagnostics, deck%source)
    deck%warnings = render_warnings(deck%diagnostics, deck%source)
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

  !> Reads and checks all variants: nothing is computed before they are known to be sound.
  !!
  !! Errors: the first variant that is refused is reported in full, the others are counted. Variants
  !! that do not reach some position, or none, are refused only if no variant reaches all; else they
  !! are computed as far as possible, and there is a warning.
  subroutine read_variants(deck, cards, threads, available)
    type(deck_t), intent(inout) :: deck                  !! whose cards are without errors
    type(card_t), allocatable, intent(inout) :: cards(:) !! not allocated, or of any variant
    integer, intent(in) :: threads
    type(available_memory_t), intent(in) :: available

    type(diagnostics_t) :: mine, refusals, unreachable, out_of_reach
    type(model_t) :: model
    character(len=:), allocatable :: name
    integer :: number, count, refused, short, last_refused

    count = variant_count(deck%cards)
    refused = 0
    short = 0
    last_refused = 0
    do number = 1, count
      call clear(mine)
      call read_variant(deck%cards, number, cards, mine, model)
      call check_variant(model, threads, available, mine)
      if (number == 1) then
        ! As a rule it is the deck that is wrong, not this variant.
        if (has_other_errors(mine, error_of_reach)) then
          call read_variant(deck%cards, number, cards, deck%diagnostics, deck%model)
          call check_variant(deck%model, threads, available, deck%diagnostics)
          return
        end if
        deck%model = model
        deck%model%echo = echo_cards(deck%cards, cards, model%effects, reports, deck%source)
      end if
      if (.not. has_errors(mine)) call compare_with_first(model, deck, mine)
      name = variant_text(deck%cards, number)
      call join_warnings(deck%diagnostics, mine, name)
      if (.not. has_errors(mine)) cycle
      if (has_other_errors(mine, error_of_reach)) then
        refused = refused + 1
        last_refused = number
        if (refused == 1) call take_errors(mine, "with "//name//": ", refusals)
      else
        short = short + 1
        if (short == 1) call take_errors(mine, "with "//name//": ", unreachable)
        call join_out_of_reach(mine, name, out_of_reach)
      end if
    end do
    if (refused == 0 .and. short == count) then
      refusals = unreachable
      refused = short
      last_refused = count
    else if (refused == 0) then
      call append_warnings(deck%diagnostics, out_of_reach)
    end if
    call count_warnings(deck%diagnostics, count)
    call take_errors(refusals, "", deck%diagnostics)
    if (refused > 1) call add_error(deck%diagnostics, deck%cards%variations(1)%name, &
      to_string(refused)//" of "//to_string(count)//" variants are refused, the last one with "// &
      variant_text(deck%cards, last_refused))
  end subroutine read_variants

  !> Compares a variant with the first one. Errors: they cannot be in one table.
  subroutine compare_with_first(model, deck, diagnostics)
    type(model_t), intent(in) :: model
    type(deck_t), intent(in) :: deck
    type(diagnostics_t), intent(inout) :: diagnostics

    if (model%modes /= deck%model%modes) then
      call add_error(diagnostics, model%modes_word, &
        "all variants must have as many modes: they are columns of one table")
    else if (model%effects /= deck%model%effects) then
      call add_error(diagnostics, deck%cards%variations(1)%name, &
        "of this variant and the first one, one stands still without "// &
        "loads and one does not: EFFECTS must say whether axial forces act")
    end if
  end subroutine compare_with_first

  !> Turns the errors of a variant that does not reach all positions into warnings, and joins them
  !! to those of the variants before.
  subroutine join_out_of_reach(mine, variant, out_of_reach)
    type(diagnostics_t), intent(in) :: mine
    character(len=*), intent(in) :: variant
    type(diagnostics_t), intent(inout) :: out_of_reach

    type(diagnostics_t) :: warnings
    type(diagnostic_t), allocatable :: list(:)
    integer :: i

    list = errors_of(mine)
    do i = 1, size(list)
      call add_warning(warnings, list(i)%place, "rows will be marked as failed: "// &
        list(i)%message, kind=warning_of_reach)
    end do
    call join_warnings(out_of_reach, warnings, variant)
  end subroutine join_out_of_reach

  !> Removes all messages.
  pure subroutine clear(diagnostics)
    type(diagnostics_t), intent(out) :: diagnostics
  end subroutine clear

  !> Adds errors, each after a few words.
  subroutine take_errors(mine, before, diagnostics)
    type(diagnostics_t), intent(in) :: mine
    character(len=*), intent(in) :: before !! `with L=90mm: `, or empty
    type(diagnostics_t), intent(inout) :: diagnostics

    type(diagnostic_t), allocatable :: list(:)
    integer :: i

    list = errors_of(mine)
    do i = 1, size(list)
      if (len(list(i)%note) > 0) then
        call add_error(diagnostics, list(i)%place, before//list(i)%message, &
          list(i)%second_place, list(i)%note, list(i)%kind)
      else
        call add_error(diagnostics, list(i)%place, before//list(i)%message, kind=list(i)%kind)
      end if
    end do
  end subroutine take_errors

end module deck_readings
