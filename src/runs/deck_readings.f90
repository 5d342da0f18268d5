! src/runs/ - one deck from reading to files: read, checked, computed, written, put in place.
! In: the path of a deck, options. Out: files in its folder, and messages that `src/main.f90`
! prints. Begin with `read_deck` here and `run_deck` in `deck_runs.f90`; `compute_variant` in
! `variant_runs.f90` knows no files. Further: `src/runs/checks`, `src/runs/studies`,
! `src/runs/batch` (variants, ranks, journal), `src/runs/texts`.
! Not here: reading the command line (`src/command_line.f90`), rows of tables (`src/reports`).

!> Reading and checking of a deck with all its variants.
module deck_readings
  use available_memory, only: find_available_memory
  use card_echo, only: echo_cards
  use cards, only: card_t
  use deck_source, only: read_source, source_from_text, source_t
  use diagnostics, only: diagnostics_t, has_errors, render_errors, render_warnings
  use errors, only: error_of_input, error_t, rendered, set_error
  use file_system, only: base_name
  use interruption, only: was_interrupted
  use includes, only: read_all_cards
  use models, only: model_t
  use report_table, only: reports
  use study_parts, only: first_variant, last_variant, part_t
  use table_files, only: add_table_files
  use text, only: string_t
  use variant_checks, only: check_variants, find_leading
  use variant_readings, only: check_variant, read_variant, run_limits_t
  use variants, only: deck_cards_t, read_deck_cards, variant_count
  implicit none (type, external)
  private

  public :: deck_t, read_deck

  !> A deck as it was read.
  type :: deck_t
    type(source_t) :: source
    type(deck_cards_t) :: cards
    type(model_t) :: model                         !! of the first variant that can be computed; the
                                                   !! only one if nothing varies
    integer :: leading = 1                         !! number of this variant
    type(run_limits_t) :: limits                   !! that variants are checked with
    type(diagnostics_t) :: diagnostics
    type(error_t), allocatable :: refusal          !! why it could not be read at all
    character(len=:), allocatable :: base          !! name of its output folder
    character(len=:), allocatable :: errors        !! ready for standard error; empty if none
    character(len=:), allocatable :: warnings      !! ready for standard error; empty if none
  end type deck_t

contains

  !> Reads and checks a deck. Of variants the first ones are checked until one is sound, the others
  !! where they are computed.
  !!
  !! Errors: the file cannot be read, or its name gives no folder for the results (both in
  !! `refusal`); a card is wrong, memory does not suffice, or the mechanics are wrong (all in
  !! `diagnostics`); of variants, those of `find_leading` and `check_variants`. After an
  !! interruption the deck is not for use.
  subroutine read_deck(path, threads, deck, settings, processes, joins, checks, part)
    character(len=*), intent(in) :: path                !! `-`: standard input
    integer, intent(in) :: threads                      !! that will compute the deck
    type(deck_t), intent(out) :: deck                   !! as read; its model is complete only
                                                        !! without errors
    type(string_t), intent(in), optional :: settings(:) !! of the command line, each `name=value`
    integer, intent(in), optional :: processes          !! that share the memory; absent: one
    logical, intent(in), optional :: joins              !! whether it has been computed elsewhere,
                                                        !! and takes no memory; absent: it has not
    logical, intent(in), optional :: checks             !! whether all variants are checked now;
                                                        !! absent: they are not
    type(part_t), intent(in), optional :: part          !! of the variants that are checked now;
                                                        !! absent: all

    type(card_t), allocatable :: cards(:)
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
      call read_deck_cards(cards, settings, deck%source, reports(), deck%diagnostics, &
        deck%cards)
    else
      call read_deck_cards(cards, none, deck%source, reports(), deck%diagnostics, deck%cards)
    end if
    deck%limits = run_limits_t(threads, find_available_memory(threads, processes))
    if (is_true(joins)) deck%limits%memory%bytes = huge(deck%limits%memory%bytes)
    if (variant_count(deck%cards) > 1 .and. .not. has_errors(deck%diagnostics)) then
      call read_variants(deck, checks, part)
    else
      call read_variant(deck%cards, 1, cards, deck%diagnostics, deck%model)
      call check_variant(deck%model, deck%limits, deck%diagnostics)
      if (.not. has_errors(deck%diagnostics)) deck%model%echo = echo_cards(deck%cards, cards, &
        deck%model%effects, deck%source)
    end if
    deck%errors = render_errors(deck%diagnostics, deck%source)
    ! What variants are warned of is told when all are known.
    if (variant_count(deck%cards) == 1 .or. len(deck%errors) > 0 .or. is_true(checks)) &
      deck%warnings = render_warnings(deck%diagnostics, deck%source)
  end subroutine read_deck

  !> Takes the model of the variant that leads, and checks all variants if that is wanted. Errors:
  !! those of `find_leading` and `check_variants`.
  subroutine read_variants(deck, checks, part)
    type(deck_t), intent(inout) :: deck          !! whose cards are without errors
    logical, intent(in), optional :: checks      !! as for `read_deck`
    type(part_t), intent(in), optional :: part   !! likewise

    type(card_t), allocatable :: cards(:)
    type(diagnostics_t) :: none
    integer :: first, last

    call find_leading(deck%cards, deck%limits, deck%diagnostics, deck%leading)
    if (has_errors(deck%diagnostics) .or. was_interrupted()) return
    call read_variant(deck%cards, deck%leading, cards, none, deck%model)
    deck%model%echo = echo_cards(deck%cards, cards, deck%model%effects, deck%source)
    if (.not. is_true(checks)) return
    first = 1
    last = variant_count(deck%cards)
    if (present(part)) then
      first = first_variant(part, variant_count(deck%cards))
      last = last_variant(part, variant_count(deck%cards))
    end if
    call check_variants(deck%cards, deck%limits, first, last, deck%model, deck%diagnostics)
  end subroutine read_variants

  !> Whether an option is there, and true.
  pure function is_true(option) result(is)
    logical, intent(in), optional :: option
    logical :: is

    is = .false.
    if (present(option)) is = option
  end function is_true

end module deck_readings
