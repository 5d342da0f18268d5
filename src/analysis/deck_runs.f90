!> One deck: read and checked, then computed and written.
module deck_runs
  use available_memory, only: find_available_memory
  use branch_tracking, only: branches_t, follow_branches
  use cards, only: card_t, read_cards
  use deck_checks, only: check_mechanics
  use deck_outputs, only: discard_outputs, open_outputs, outputs_t, publish_outputs, write_outputs
  use deck_source, only: read_source, source_t
  use diagnostics, only: diagnostics_t, has_errors, render_errors, render_warnings, warning_texts
  use errors, only: error_t, set_error
  use file_system, only: base_name, joined_path
  use frequency_sweep, only: run_sweep, sweep_t
  use interruption, only: was_interrupted
  use memory_needs, only: check_memory
  use mechanisms, only: mechanism_t, new_mechanism
  use model_reader, only: read_model
  use models, only: model_t, needs_frequencies
  use positions, only: find_positions, positions_t
  use progress, only: end_progress, progress_t, start_progress
  use run_findings, only: find_failures, find_warnings, findings_log, findings_messages, findings_t, linkage_notes
  use run_log, only: model_summary
  use run_statistics, only: start_stopwatch, statistics_text, stop_stage, stopwatch_t, sweep_summary
  use text, only: string_t
  implicit none (type, external)
  private

  public :: deck_t, run_options_t, run_result_t, read_deck, run_deck

  !> A deck that has been read.
  type :: deck_t
    type(source_t) :: source
    type(model_t) :: model
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
  end type run_options_t

  !> What a run has to say.
  type :: run_result_t
    character(len=:), allocatable :: messages   !! warnings and failed rows, for standard error
    character(len=:), allocatable :: statistics !! what was computed, for `--stats`
    logical :: failed = .false.                 !! some position or mode could not be computed
  end type run_result_t

  character(len=*), parameter :: line_feed = achar(10)

contains

  !> Reads and checks a deck; the path `-` is standard input.
  subroutine read_deck(path, threads, deck)
    character(len=*), intent(in) :: path
    integer, intent(in) :: threads   !! that will compute it
    type(deck_t), intent(out) :: deck

    type(card_t), allocatable :: cards(:)
    type(diagnostics_t) :: diagnostics
    type(error_t), allocatable :: error

    deck%base = base_name(path)
    if (path == "-") deck%base = "stdin"
    deck%errors = ""
    deck%warnings = ""
    deck%warning_lines = ""
    call read_source(path, deck%source, error)
    if (.not. allocated(error) .and. (deck%base == "" .or. deck%base == "." .or. deck%base == "..")) then
      call set_error(error, path//": error: this name gives no folder for the results")
    end if
    if (allocated(error)) then
      deck%errors = error%message//line_feed
      return
    end if
    call read_cards(deck%source, cards, diagnostics)
    call read_model(cards, diagnostics, deck%model)
    if (.not. has_errors(diagnostics)) call check_memory(deck%model, threads, find_available_memory(threads), diagnostics)
    if (.not. has_errors(diagnostics)) call check_mechanics(deck%model, diagnostics)
    deck%errors = render_errors(diagnostics, deck%source)
    deck%warnings = render_warnings(diagnostics, deck%source)
    deck%warning_lines = warning_texts(diagnostics)
  end subroutine read_deck

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
    type(findings_t) :: findings
    type(outputs_t) :: outputs
    type(progress_t) :: progress
    type(stopwatch_t) :: watch

    call start_stopwatch(watch)
    call open_outputs(joined_path(options%folder, deck%base), deck%model, outputs, error)
    if (allocated(error)) then
      call discard_outputs(outputs)
      return
    end if
    mechanism = new_mechanism(deck%model)
    positions = find_positions(mechanism%linkage, deck%model%crank%value)
    call stop_stage(watch, "motion")
    if (needs_frequencies(deck%model)) then
      call start_progress(progress, deck%base, .not. options%quiet)
      call run_sweep(deck%model, mechanism, positions, options%threads, progress, sweep, error)
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
      call find_failures(deck%model, positions, sweep, findings)
      call find_warnings(deck%model, mechanism, positions, sweep, findings)
      call write_outputs(outputs, deck%model, mechanism, positions, sweep, branches, options%threads, &
        log_text(deck, mechanism, positions, sweep, findings))
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
    result%failed = findings%failures > 0
    result%messages = findings_messages(findings, deck%source%path)
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
