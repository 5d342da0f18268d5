!> One deck: computed variant by variant, and written.
module deck_runs
  use, intrinsic :: iso_fortran_env, only: compiler_version
  use cards, only: card_t
  use deck_outputs, only: discard_outputs, open_outputs, outputs_t, publish_outputs, write_texts, &
    write_variant
  use deck_readings, only: deck_t, read_variant
  use deck_summary, only: summary_text
  use diagnostics, only: diagnostics_t
  use echo, only: echo_text
  use errors, only: error_t, set_error
  use file_system, only: file_name, joined_path
  use interruption, only: was_interrupted
  use link_store, only: link_store_t
  use models, only: solver_band
  use motion_report, only: motion_log
  use motion_study, only: has_motion, motion_rows_of
  use omp_lib, only: omp_get_thread_num
  use program_version, only: version_number
  use progress, only: end_progress, progress_t, show_progress, start_progress
  use run_findings, only: add_findings, findings_log, findings_messages, findings_t, linkage_notes
  use run_log, only: model_summary
  use run_statistics, only: accuracy_summary, start_stopwatch, statistics_text, stop_stage, &
    stopwatch_t, sweep_summary
  use sweep_journal, only: close_journal, journal_t, open_journal, remove_journal
  use tables, only: column_t, real_column
  use text, only: plural, string_t, to_string
  use variant_runs, only: add_totals, finish_variant, prepare_variant, run_totals_t, run_variant, &
    solve_variant, totals_of, variant_run_t
  use variants, only: parameter_names, variant_count, variant_text
  implicit none (type, external)
  private

  public :: run_options_t, run_result_t, run_deck

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

  !> Why a variant could not be computed, if it could not.
  type :: problem_t
    type(error_t), allocatable :: error
  end type problem_t

  !> What a deck's variants have in common while they are computed.
  type :: session_t
    type(outputs_t) :: outputs
    type(journal_t) :: journal
    type(progress_t) :: progress
    type(column_t), allocatable :: parameters(:) !! columns of what varies
    type(run_totals_t) :: totals
    type(findings_t) :: findings
    character(len=:), allocatable :: log         !! of the first variant
    integer :: method = 0                        !! by which its frequencies were found
  end type session_t

  !> Variants that are computed at a time have about so many rows together, and there are no more of
  !! them than the second.
  integer, parameter :: rows_at_a_time = 8192, most_at_a_time = 256

  !> Variants with more positions than this keep all threads busy by themselves.
  integer, parameter :: many_positions = 1024

  character(len=*), parameter :: line_feed = achar(10)

contains

  !> Computes what a sound deck asks for and writes its files.
  !!
  !! Errors: the run was interrupted, or its files could not be written; then the output folder is
  !! as it was before, but for the journal of a long run.
  subroutine run_deck(deck, options, result, error)
    type(deck_t), intent(in) :: deck
    type(run_options_t), intent(in) :: options
    type(run_result_t), intent(out) :: result
    type(error_t), allocatable, intent(out) :: error

    type(session_t) :: session
    type(stopwatch_t) :: watch
    integer :: blocks, variants

    variants = variant_count(deck%cards)
    call start_stopwatch(watch)
    call open_outputs(joined_path(options%folder, deck%base), deck%model, options%csv, &
      session%outputs, error)
    if (.not. allocated(error)) then
      call open_journal(session%outputs%folder, journal_title(deck), options%resume, &
        session%journal, blocks)
      session%parameters = parameter_columns(deck)
      call start_progress(session%progress, deck%base, &
        trim(merge("variants ", "positions", variants > 1)), .not. options%quiet)
      call run_first_variant(deck, options, watch, session, error)
      if (variants > 1 .and. .not. allocated(error)) then
        call run_other_variants(deck, options, session, error)
        call stop_stage(watch, "other variants")
      end if
      call end_progress(session%progress)
    end if
    if (.not. allocated(error)) call publish(deck, session, error)
    call stop_stage(watch, "files")
    if (allocated(error)) then
      call discard_outputs(session%outputs)
      return
    end if
    result%findings = session%findings
    result%failed = result%findings%failures > 0
    result%messages = resumption_message(deck, options%resume, blocks)// &
      findings_messages(result%findings, deck%source%path)
    result%statistics = statistics_text(watch, deck%base, session%totals)
  end subroutine run_deck

  !> What must be the same for a run to go on from the results of another: program, compiler, and
  !! the deck with its settings.
  pure function journal_title(deck) result(title)
    type(deck_t), intent(in) :: deck
    character(len=:), allocatable :: title

    title = version_number//line_feed//compiler_version()//line_feed//echo_text(deck%model)
  end function journal_title

  pure function resumption_message(deck, resume, blocks) result(message)
    type(deck_t), intent(in) :: deck
    logical, intent(in) :: resume
    integer, intent(in) :: blocks !! of an earlier run; -1: it was of something else
    character(len=:), allocatable :: message

    message = ""
    if (.not. resume) return
    if (blocks < 0) then
      message = "the earlier run was of another deck, or by another program; this one has "// &
        "begun anew"
    else if (blocks == 0) then
      message = "no earlier run has left anything to go on from; this one has begun anew"
    else
      message = "went on from "//plural(blocks, "block")// &
        " of positions that an earlier run had computed"
    end if
    message = deck%source%path//": "//message//line_feed
  end function resumption_message

  pure function parameter_columns(deck) result(columns)
    type(deck_t), intent(in) :: deck
    type(column_t), allocatable :: columns(:)

    type(string_t), allocatable :: names(:)
    character(len=:), allocatable :: unit
    integer :: i

    names = parameter_names(deck%cards)
    allocate (columns(size(names)))
    do i = 1, size(names)
      unit = deck%cards%variations(i)%unit
      if (len(unit) == 0) unit = "-"
      columns(i) = real_column(names(i)%text, unit)
    end do
  end function parameter_columns

  !> Computes the first variant and writes its rows; the log tells more of it than of the others.
  subroutine run_first_variant(deck, options, watch, session, error)
    type(deck_t), intent(in) :: deck
    type(run_options_t), intent(in) :: options
    type(stopwatch_t), intent(inout) :: watch
    type(session_t), intent(inout) :: session
    type(error_t), allocatable, intent(out) :: error

    type(variant_run_t) :: run
    type(link_store_t) :: store
    type(progress_t) :: silent

    run%model = deck%model
    if (size(session%parameters) == 0) then
      call run_variant(1, options%threads, session%progress, session%journal, store, run, error)
    else
      call run_variant(1, options%threads, silent, session%journal, store, run, error)
    end if
    call stop_stage(watch, "motion and modes")
    if (allocated(error) .or. was_interrupted()) return
    call write_variant(session%outputs, session%parameters, run, options%threads)
    call stop_stage(watch, "tables")
    call add_totals(session%totals, totals_of(run))
    call add_findings(session%findings, run%findings)
    session%log = first_log(run)
    if (allocated(run%sweep%results)) session%method = run%sweep%request%method
  end subroutine run_first_variant

  !> Computes all other variants, many at a time, and writes their rows in order. That they are
  !! sound has been checked.
  subroutine run_other_variants(deck, options, session, error)
    type(deck_t), intent(in) :: deck
    type(run_options_t), intent(in) :: options
    type(session_t), intent(inout) :: session
    type(error_t), allocatable, intent(out) :: error

    type(card_t), allocatable :: cards(:)
    type(diagnostics_t) :: diagnostics
    type(variant_run_t), allocatable :: runs(:)
    type(problem_t), allocatable :: problems(:)  !! (as runs)
    type(link_store_t), allocatable :: stores(:) !! (threads)
    type(progress_t) :: silent
    integer :: first, last, at_a_time, outer, i

    at_a_time = max(1, &
      min(most_at_a_time, &
      rows_at_a_time/max(1, size(deck%model%crank%value)*size(deck%model%speed%value) + &
      motion_rows_of(deck%model))))
    outer = options%threads
    ! ARPACK serves one thread at a time.
    if (size(deck%model%crank%value) > many_positions .or. deck%model%solver == solver_band) &
      outer = 1
    allocate (stores(0:outer - 1))
    do first = 2, variant_count(deck%cards), at_a_time*outer
      last = min(first + at_a_time*outer - 1, variant_count(deck%cards))
      allocate (runs(first:last), problems(first:last))
      do i = first, last
        call read_variant(deck%cards, i, cards, diagnostics, runs(i)%model)
        call prepare_variant(runs(i))
      end do
      !$omp parallel do schedule(dynamic) num_threads(outer) default(shared) private(i)
      do i = first, last
        if (was_interrupted()) cycle
        call solve_variant(i, merge(options%threads, 1, outer == 1), silent, session%journal, &
          stores(omp_get_thread_num()), runs(i), problems(i)%error)
      end do
      !$omp end parallel do
      do i = first, last
        if (was_interrupted()) return
        if (allocated(problems(i)%error)) then
          call move_alloc(problems(i)%error, error)
          return
        end if
        call finish_variant(runs(i))
        call write_variant(session%outputs, session%parameters, runs(i), 1)
        call add_findings(session%findings, runs(i)%findings)
        call add_totals(session%totals, totals_of(runs(i)))
      end do
      deallocate (runs, problems)
      call show_progress(session%progress, last, variant_count(deck%cards))
    end do
  end subroutine run_other_variants

  !> Writes what comes after the tables, and puts all files in place. Errors: the run was
  !! interrupted, or a file is not complete.
  subroutine publish(deck, session, error)
    type(deck_t), intent(in) :: deck
    type(session_t), intent(inout) :: session
    type(error_t), allocatable, intent(out) :: error

    integer :: blocks

    ! Asked once, before the files are put in place: from there on the run is done.
    if (was_interrupted()) then
      call close_journal(session%journal, blocks)
      call set_error(error, deck%source%path//": interrupted; its earlier results are untouched"// &
        resume_hint(blocks))
      return
    end if
    call write_texts(session%outputs, echo_text(deck%model), log_text(deck, session), &
      summary_text(deck%base, file_name(deck%source%path), deck%diagnostics, deck%source, &
      session%findings, deck%model, session%totals, parameter_names(deck%cards), &
      session%outputs%tables))
    call publish_outputs(session%outputs, error)
    if (allocated(error)) then
      call close_journal(session%journal, blocks)
    else
      call remove_journal(session%journal)
    end if
  end subroutine publish

  pure function resume_hint(blocks) result(hint)
    integer, intent(in) :: blocks
    character(len=:), allocatable :: hint

    hint = ""
    if (blocks > 0) hint = "; --resume goes on from what it has computed"
  end function resume_hint

  !> What the deck describes and how its frequencies were found.
  function first_log(run) result(text)
    type(variant_run_t), intent(in) :: run
    character(len=:), allocatable :: text

    type(string_t), allocatable :: notes(:)
    integer :: i

    text = model_summary(run%model)
    notes = linkage_notes(run%mechanism, run%positions)
    do i = 1, size(notes)
      text = text//notes(i)%text//line_feed
    end do
    if (has_motion(run%motion)) text = text//motion_log(run%motion)
    if (allocated(run%sweep%results)) text = text//sweep_summary(run%sweep, run%mechanism%mesh)
  end function first_log

  !> The text of `run.log`: what the deck describes, how sure its results are, what to beware of.
  pure function log_text(deck, session) result(text)
    type(deck_t), intent(in) :: deck
    type(session_t), intent(in) :: session
    character(len=:), allocatable :: text

    text = session%log
    if (session%totals%variants > 1) then
      text = "first of "//to_string(session%totals%variants)//" variants, "// &
        variant_text(deck%cards, 1)//":"//line_feed//text//"all variants, the last one with "// &
        variant_text(deck%cards, session%totals%variants)//":"//line_feed
    end if
    if (session%totals%has_frequencies) text = text//accuracy_summary(session%method, &
      session%totals%largest_error)
    if (len(deck%warning_lines) > 0) text = text//"warnings of the deck:"//line_feed// &
      deck%warning_lines
    text = text//findings_log(session%findings)
  end function log_text

end module deck_runs
