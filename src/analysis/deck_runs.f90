!> One deck: read and checked, then computed and written.
module deck_runs
  use branch_tracking, only: branches_t, follow_branches
  use card_echo, only: echo_cards
  use cards, only: card_t
  use deck_checks, only: check_mechanics
  use deck_outputs, only: discard_outputs, open_outputs, outputs_t, publish_outputs, write_outputs, write_summary
  use deck_source, only: read_source, source_from_text, source_t
  use deck_summary, only: summary_text
  use diagnostics, only: diagnostics_t, has_errors, render_errors, render_warnings, warning_texts
  use errors, only: error_t, set_error
  use file_system, only: base_name, file_name, joined_path
  use frequency_sweep, only: run_sweep, sweep_t
  use includes, only: read_all_cards
  use interruption, only: was_interrupted
  use link_store, only: link_store_t
  use mechanisms, only: mechanism_t, new_mechanism
  use model_reader, only: read_model
  use models, only: model_t, needs_frequencies
  use positions, only: find_positions, positions_t
  use progress, only: end_progress, progress_t, start_progress
  use run_findings, only: find_failures, find_warnings, findings_log, findings_messages, findings_t, linkage_notes
  use run_log, only: model_summary
  use run_statistics, only: start_stopwatch, statistics_text, stop_stage, stopwatch_t, sweep_summary
  use sweep_journal, only: journal_t
  use text, only: string_t
  use variants, only: deck_cards_t, read_deck_cards, take_variant, variant_text
  implicit none (type, external)
  private

  public :: deck_t, run_options_t, run_result_t, read_deck, read_variant, run_deck

  !> A deck that has been read.
  type :: deck_t
    type(source_t) :: source
    type(deck_cards_t) :: cards
    type(model_t) :: model                         !! of the first variant, of the only one where nothing varies
    type(diagnostics_t) :: diagnostics
    character(len=:), allocatable :: refusal       !! why it could not be read at all, with its path; empty if it could
    character(len=:), allocatable :: base          !! name of its output folder
    character(len=:), allocatable :: errors        !! ready for standard error; empty if there are none
    character(len=:), allocatable :: warnings      !! likewise
    character(len=:), allocatable :: warning_lines !! the same for the log
  end type deck_t

  !> What the command line says about every run.
  type :: run_options_t
    character(len=:), allocatable :: folder !! that holds the output folders
    integer :: threads = 1
    logical :: quiet = .false.
    logical :: resume = .false.             !! go on where an earlier run was killed
    logical :: csv = .false.                !! tables as comma-separated values too
  end type run_options_t

  !> What a run has to say.
  type :: run_result_t
    character(len=:), allocatable :: messages   !! warnings and failed rows, for standard error
    character(len=:), allocatable :: statistics !! what was computed, for `--stats`
    logical :: failed = .false.                 !! some position or mode could not be computed
    type(findings_t) :: findings                !! what the messages tell
  end type run_result_t

  character(len=*), parameter :: line_feed = achar(10)

contains

  !> Reads and checks a deck; the path `-` is standard input. Of a deck with VARY it checks the first variant.
  subroutine read_deck(path, deck, settings)
    character(len=*), intent(in) :: path
    type(deck_t), intent(out) :: deck
    type(string_t), intent(in), optional :: settings(:) !! of the command line, each `name=value`

    type(card_t), allocatable :: cards(:)
    type(string_t) :: none(0)
    type(error_t), allocatable :: error

    deck%base = base_name(path)
    if (path == "-") deck%base = "stdin"
    deck%refusal = ""
    deck%errors = ""
    deck%warnings = ""
    deck%warning_lines = ""
    call read_source(path, deck%source, error)
    if (.not. allocated(error) .and. (deck%base == "" .or. deck%base == "." .or. deck%base == "..")) then
      call set_error(error, path//": error: this name gives no folder for the results")
    end if
    if (allocated(error)) then
      deck%source = source_from_text(path, "")
      deck%refusal = error%message
      deck%errors = error%message//line_feed
      return
    end if
    call read_all_cards(deck%source, cards, deck%diagnostics)
    if (present(settings)) then
      call read_deck_cards(cards, settings, deck%source, deck%diagnostics, deck%cards)
    else
      call read_deck_cards(cards, none, deck%source, deck%diagnostics, deck%cards)
    end if
    call read_variant(deck%cards, 1, cards, deck%diagnostics, deck%model)
    if (.not. has_errors(deck%diagnostics)) deck%model%echo = echo_cards(deck%cards, cards, deck%source)
    deck%errors = render_errors(deck%diagnostics, deck%source)
    deck%warnings = render_warnings(deck%diagnostics, deck%source)
    deck%warning_lines = warning_texts(deck%diagnostics, deck%source)
  end subroutine read_deck

  !> Turns the cards of one variant into a model and checks it; nothing is read again. A deck without VARY has one variant.
  subroutine read_variant(deck_cards, number, cards, diagnostics, model)
    type(deck_cards_t), intent(in) :: deck_cards
    integer, intent(in) :: number                        !! of the variant, from 1
    type(card_t), allocatable, intent(inout) :: cards(:) !! of another variant or not allocated; on return, of this one
    type(diagnostics_t), intent(inout) :: diagnostics    !! of the cards; the model is complete only if it has no errors afterwards
    type(model_t), intent(out) :: model

    call take_variant(deck_cards, number, cards)
    call read_model(cards, diagnostics, model)
    if (has_errors(diagnostics)) return
    model%variant = variant_text(deck_cards, number)
    call check_mechanics(model, diagnostics)
  end subroutine read_variant

  !> Computes what a sound deck asks for and writes its files.
  !!
  !! Errors: the run was interrupted, or its files could not be written; then the output folder is as it was before.
  subroutine run_deck(deck, options, result, error)
    type(deck_t), intent(in) :: deck
    type(run_options_t), intent(in) :: options
    type(run_result_t), intent(out) :: result
    type(error_t), allocatable, intent(out) :: error

    type(mechanism_t) :: mechanism
    type(positions_t) :: positions
    type(sweep_t) :: sweep
    type(branches_t) :: branches
    type(outputs_t) :: outputs
    type(progress_t) :: progress
    type(stopwatch_t) :: watch
    type(link_store_t) :: store
    type(journal_t) :: journal

    call start_stopwatch(watch)
    call open_outputs(joined_path(options%folder, deck%base), deck%model, options%csv, outputs, error)
    if (allocated(error)) then
      call discard_outputs(outputs)
      return
    end if
    mechanism = new_mechanism(deck%model)
    positions = find_positions(mechanism%linkage, deck%model%crank%value)
    call stop_stage(watch, "motion")
    if (needs_frequencies(deck%model)) then
      call start_progress(progress, deck%base, .not. options%quiet)
      call run_sweep(deck%model, mechanism, positions, options%threads, progress, journal, 1, store, sweep, error)
      call end_progress(progress)
      if (allocated(error)) then
        call discard_outputs(outputs)
        return
      end if
      call stop_stage(watch, "modes")
      if (sweep%request%follow) then
        call follow_branches(mechanism, positions, sweep, branches)
        call stop_stage(watch, "branches")
      end if
    end if
    if (.not. was_interrupted()) then
      call find_failures(deck%model, positions, sweep, result%findings)
      call find_warnings(deck%model, mechanism, positions, sweep, result%findings)
      call write_outputs(outputs, deck%model, mechanism, positions, sweep, branches, options%threads, &
        log_text(deck, mechanism, positions, sweep, result%findings))
      call write_summary(outputs, summary_text(deck%base, file_name(deck%source%path), deck%diagnostics, deck%source, &
        result%findings, deck%model, positions, outputs%tables))
    end if
    ! Asked once, before the files are put in place: from there on the run is done.
    if (was_interrupted()) then
      call set_error(error, deck%source%path//": interrupted; its earlier results are untouched")
    else
      call publish_outputs(outputs, error)
    end if
    call stop_stage(watch, "tables")
    if (allocated(error)) then
      call discard_outputs(outputs)
      return
    end if
    result%failed = result%findings%failures > 0
    result%messages = findings_messages(result%findings, deck%source%path)
    result%statistics = statistics_text(watch, deck%base, positions, sweep)
  end subroutine run_deck

  !> The text of `run.log`: what the deck describes, how sure its results are, what to beware of.
  function log_text(deck, mechanism, positions, sweep, findings) result(text)
    type(deck_t), intent(in) :: deck
    type(mechanism_t), intent(in) :: mechanism
    type(positions_t), intent(in) :: positions
    type(sweep_t), intent(in) :: sweep
    type(findings_t), intent(in) :: findings
    character(len=:), allocatable :: text

    type(string_t), allocatable :: notes(:)
    integer :: i

    text = model_summary(deck%model)
    notes = linkage_notes(mechanism, positions)
    do i = 1, size(notes)
      text = text//notes(i)%text//line_feed
    end do
    if (allocated(sweep%results)) text = text//sweep_summary(sweep, mechanism%mesh)
    if (len(deck%warning_lines) > 0) text = text//"warnings of the deck:"//line_feed//deck%warning_lines
    text = text//findings_log(findings)
  end function log_text

end module deck_runs
