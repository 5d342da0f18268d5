!> The run of one deck: its variants are computed, its files written.
module deck_runs
  use, intrinsic :: iso_fortran_env, only: compiler_version
  use byte_streams, only: byte_stream_t
  use cards, only: card_t
  use deck_bytes, only: pass_deck
  use deck_outputs, only: close_outputs, discard_outputs, end_results, &
    open_outputs, open_part, outputs_t, publish_outputs, write_found_rows, write_results, &
    write_texts
  use deck_readings, only: deck_t
  use deck_summary, only: summary_text
  use diagnostics, only: diagnostic_t, diagnostics_t, render_errors, render_warnings, warnings_of
  use echo, only: echo_text
  use errors, only: error_of_interruption, error_of_numerics, error_t, set_error
  use evaluations, only: evaluation_store_t
  use file_system, only: file_name, joined_path
  use findings_texts, only: failure_text, findings_log, findings_messages
  use interruption, only: was_interrupted, was_out_of_time
  use kept_positions, only: many_rows, positions_kept
  use kinds, only: wp
  use models, only: model_t, report_number, solver_band
  use position_blocks, only: divide_positions
  use part_files, only: find_parts, read_parts, refuse_part
  use program_version, only: version_number
  use progress, only: end_progress, progress_t, show_progress, start_progress
  use ranks, only: rank_count
  use run_findings, only: add_findings, findings_t, warnings_of_grade
  use run_statistics, only: accuracy_summary, run_times_t, statistics_text
  use run_totals, only: add_totals, run_totals_t
  use stopwatch, only: lap, start_stopwatch, stopwatch_t
  use study_parts, only: first_variant, last_variant, part_name, part_t
  use study_of_motion, only: motion_instants_of
  use success_text, only: text_of_success
  use tables, only: column_t, real_column
  use task_journal, only: close_journal, journal_t, keeps_tasks, open_journal, &
    publish_journal, remove_journal
  use text, only: append_string, plural, string_t, to_string
  use variant_findings, only: find_failures, find_warnings, totals_of
  use variant_log, only: log_of_variant
  use variant_checks, only: begin_checks, check_t, check_number, checks_t, conclude_checks, &
    first_error, is_refused, join_check, refuses_deck
  use variant_readings, only: read_variant
  use variant_rows, only: fail_variant, variant_rows_t
  use variant_runs, only: begin_computing, begin_variant_run, block_count, compute_block, &
    help_with_variant, variant_run_t
  use variant_tasks, only: group_of_variants, run_variant_tasks, variant_job_t
  use variants, only: parameter_names, variant_count, variant_text, variant_values
  use warnings, only: grade_meaningless
  implicit none (type, external)
  private

  public :: run_options_t, run_result_t, check_parts, run_deck, help_with_blocks, blocks_announced

  !> Options of the command line that hold for every deck.
  type :: run_options_t
    character(len=:), allocatable :: folder !! that contains the output folders
    integer :: threads = 1                  !! number to use
    logical :: quiet = .false.              !! no progress line
    logical :: resume = .false.             !! go on where an earlier run was killed
    logical :: csv = .false.                !! also write tables as comma-separated values
    character(len=:), allocatable :: figures !! command that draws figures; empty or not allocated:
                                             !! not known
    logical :: csv_only = .false.           !! and not as plain text
    integer :: digits = 0                   !! of numbers in tables; 0: as the deck says
    type(part_t) :: part                    !! of the variants that is computed, without tables
    logical :: join = .false.               !! put parts together
    character(len=:), allocatable :: limit  !! of time, as the user gave it; not allocated: none
  end type run_options_t

  !> What a run reports besides its files.
  type :: run_result_t
    character(len=:), allocatable :: warnings   !! about variants, for standard error
    character(len=:), allocatable :: messages   !! warnings and failed rows, for standard error
    character(len=:), allocatable :: statistics !! work done and times, for `--stats`
    character(len=:), allocatable :: success    !! what has been done, for standard output
    logical :: failed = .false.                 !! some position or mode could not be computed
    type(findings_t) :: findings                !! on which the messages are based
  end type run_result_t

  !> What the variants of a deck share while they are computed.
  type :: session_t
    type(outputs_t) :: outputs
    type(journal_t) :: journal
    type(progress_t) :: progress
    type(checks_t) :: checks             !! of all variants so far
    type(run_totals_t) :: totals         !! of all variants so far
    type(findings_t) :: findings         !! of all variants so far
    character(len=:), allocatable :: log !! of the first variant that was computed,
    integer :: logged = 0                !! its number,
    integer :: method = 0                !! by which its frequencies were found
    character(len=:), allocatable :: lost !! study that an interruption leaves nothing of
  end type session_t

  !> A variant with more positions than this keeps all threads busy.
  integer, parameter :: many_positions = 1024

  !> First word of what other ranks are told of the blocks of a sweep.
  character(len=*), parameter :: blocks_announced = "blocks"

  character(len=*), parameter :: line_feed = achar(10)

  !> Form of the bytes in a journal: another number wherever they mean something else, since the
  !! version of the program may stay the same.
  character(len=*), parameter :: journal_form = "journal 14"

contains

  !> Errors: the deck has no such part, or its parts cannot be joined.
  subroutine check_parts(deck, options, error)
    type(deck_t), intent(in) :: deck           !! without errors
    type(run_options_t), intent(in) :: options !! of the command line
    type(error_t), allocatable, intent(out) :: error

    integer :: count

    if (options%part%count == 0 .and. .not. options%join) return
    associate (variants => variant_count(deck%cards), path => deck%source%path)
      call refuse_part(path, variants, size(deck%cards%variations) > 0, options%part, error)
      if (allocated(error) .or. .not. options%join) return
      call find_parts(joined_path(options%folder, deck%base), deck%base, path, &
        journal_title(deck), variants, count, error)
    end associate
  end subroutine check_parts

  !> Computes the reports of a sound deck and writes its files; or a part of its variants, or the
  !! files from all parts.
  !!
  !! Errors: the run was interrupted, no variant could be computed, or files could not be written.
  !! The deck is refused for what a variant has: then it has errors, which `read_deck` left to this.
  !! The output folder is then as it was before, except for the journal of a long run.
  subroutine run_deck(deck, options, result, error)
    type(deck_t), intent(inout) :: deck              !! without errors; on return, with what is
                                                     !! told of its variants
    type(run_options_t), intent(in) :: options       !! of the command line
    type(run_result_t), intent(out) :: result        !! empty after an error, but for `warnings`
    type(error_t), allocatable, intent(out) :: error !! why there are no results

    type(session_t) :: session
    type(run_times_t) :: times
    type(stopwatch_t) :: watch
    integer :: blocks, variants

    result%warnings = ""
    variants = variant_count(deck%cards)
    call open_files(deck, options, session, blocks, error)
    if (.not. allocated(error)) then
      call start_progress(session%progress, deck%base, &
        trim(merge("variants ", "positions", variants > 1)), .not. options%quiet)
      call start_stopwatch(watch)
      call run_variants(deck, options, session, error)
      call lap(watch, times%variants)
      call end_progress(session%progress)
      if (variants > 1 .and. .not. was_interrupted()) call tell_of_variants(deck, session, result)
      ! Of a part nobody knows what the others come to.
      if (variants > 1 .and. options%part%count == 0 .and. session%outputs%computed == 0 .and. &
        .not. (allocated(error) .or. was_interrupted() .or. len(deck%errors) > 0)) then
        call set_error(error, error_of_numerics, "none of the "//to_string(variants)// &
          " variants could be computed; "//failure_text(session%findings%failed(1)), &
          deck%source%path)
      end if
      if (allocated(error) .or. len(deck%errors) > 0) then
        ! It would fail again: nothing to resume from.
        call remove_journal(session%journal)
      else
        call publish(deck, options, session, error)
      end if
    end if
    if (allocated(error) .or. len(deck%errors) > 0) then
      call discard_outputs(session%outputs)
      return
    end if
    call close_outputs(session%outputs)
    call lap(watch, times%files)
    result%findings = session%findings
    result%failed = result%findings%failures > 0
    result%messages = resumption_message(deck, options%resume, blocks)// &
      findings_messages(result%findings, deck%source%path, options%part%count == 0)
    result%statistics = statistics_text(deck%base, session%totals, times)
    ! Figures are drawn from plain tables.
    if (options%part%count > 0) then
      result%success = success_of_part(deck, options%part, session%outputs%folder%path)
    else if (options%csv_only .or. .not. allocated(options%figures)) then
      result%success = success_of(deck, session, "")
    else
      result%success = success_of(deck, session, options%figures)
    end if
  end subroutine run_deck

  !> Adds what the checks of variants have left to the messages of the deck.
  subroutine tell_of_variants(deck, session, result)
    type(deck_t), intent(inout) :: deck
    type(session_t), intent(in) :: session !! with all variants computed
    type(run_result_t), intent(inout) :: result

    call conclude_checks(session%checks, deck%cards, deck%diagnostics)
    deck%errors = render_errors(deck%diagnostics, deck%source)
    result%warnings = render_warnings(deck%diagnostics, deck%source)
  end subroutine tell_of_variants

  !> Opens the files of a run and the journal that it goes on from. Errors: they cannot be made, or
  !! parts cannot be joined.
  subroutine open_files(deck, options, session, blocks, error)
    type(deck_t), intent(in) :: deck
    type(run_options_t), intent(in) :: options
    type(session_t), intent(inout) :: session
    integer, intent(out) :: blocks !! of an earlier run; -1: it was of another deck or program
    type(error_t), allocatable, intent(out) :: error

    character(len=:), allocatable :: folder, title, name
    type(string_t), allocatable :: inputs(:)
    integer :: count, i

    blocks = 0
    do i = 1, size(deck%source%files)
      call append_string(inputs, deck%source%files(i)%path)
    end do
    folder = joined_path(options%folder, deck%base)
    title = journal_title(deck)
    if (options%part%count > 0) then
      name = part_name(deck%base, options%part)
      call open_part(folder, name, inputs, session%outputs, error)
      if (allocated(error)) return
      call open_journal(folder, title, options%resume, session%journal, blocks, name)
      if (keeps_tasks(session%journal)) return
      ! What could not be written later is told when the part is put in place.
      if (allocated(session%journal%error)) error = session%journal%error
      return
    end if
    if (options%join) then
      associate (variants => variant_count(deck%cards))
        call find_parts(folder, deck%base, deck%source%path, title, variants, count, error)
        if (.not. allocated(error)) call read_parts(folder, deck%base, title, variants, count, &
          group_of_variants, session%journal, error)
      end associate
      if (allocated(error)) return
    end if
    call open_outputs(folder, deck%model, inputs, parameter_columns(deck), options%csv, &
      session%outputs, error, options%csv_only, options%digits)
    if (.not. (allocated(error) .or. options%join)) call open_journal(folder, title, &
      options%resume, session%journal, blocks)
  end subroutine open_files

  !> What a run with `--part` has done.
  pure function success_of_part(deck, part, folder) result(text)
    type(deck_t), intent(in) :: deck
    type(part_t), intent(in) :: part
    character(len=*), intent(in) :: folder !! with the part
    character(len=:), allocatable :: text

    integer :: first, last

    first = first_variant(part, variant_count(deck%cards))
    last = last_variant(part, variant_count(deck%cards))
    text = deck%base//": part "//to_string(part%number)//" of "//to_string(part%count)//", variant"
    if (last > first) text = text//"s "//to_string(first)//" to"
    text = text//" "//to_string(last)//", in "//joined_path(folder, part_name(deck%base, part))// &
      line_feed
  end function success_of_part

  !> What a run has done, with the first reason why its results mean nothing, if there is one.
  pure function success_of(deck, session, command) result(text)
    type(deck_t), intent(in) :: deck
    type(session_t), intent(in) :: session !! with all files written
    character(len=*), intent(in) :: command !! that draws figures
    character(len=:), allocatable :: text

    type(diagnostic_t), allocatable :: of_deck(:)
    type(string_t), allocatable :: of_run(:)
    character(len=:), allocatable :: warning, drawing

    ! Of variants only frequencies and summaries are drawn.
    drawing = command
    if (session%totals%variants > 1 .and. .not. session%totals%has_frequencies .and. &
      report_number(deck%model, "summary") == 0) drawing = ""
    warning = ""
    of_run = warnings_of_grade(session%findings, grade_meaningless)
    if (size(of_run) > 0) warning = of_run(1)%text
    ! The first ones are those of meaningless results.
    of_deck = warnings_of(deck%diagnostics)
    if (size(of_deck) > 0) then
      if (of_deck(1)%warning%grade == grade_meaningless) warning = of_deck(1)%message
    end if
    associate (tables => session%outputs%tables)
      text = text_of_success(deck%base, session%outputs%folder%path, size(tables), &
        sum(tables%failed_rows), session%totals, deck%model%modes, deck%model%outputs, warning, &
        drawing)
    end associate
  end function success_of

  !> What must be the same for a run to resume from the results of another: program, compiler, form
  !! of the journal, and the deck with its settings.
  pure function journal_title(deck) result(title)
    type(deck_t), intent(in) :: deck
    character(len=:), allocatable :: title

    title = version_number//line_feed//compiler_version()//line_feed//journal_form//line_feed// &
      echo_text(deck%model)
  end function journal_title

  !> What --resume had to go on from; empty without it.
  pure function resumption_message(deck, resume, blocks) result(message)
    type(deck_t), intent(in) :: deck
    logical, intent(in) :: resume
    integer, intent(in) :: blocks !! complete ones of an earlier run; -1: it was of another deck or
                                  !! program
    character(len=:), allocatable :: message

    message = ""
    if (.not. resume) return
    if (blocks < 0) then
      message = "the earlier run was of another deck or by another program; this one started "// &
        "afresh"
    else if (blocks == 0) then
      message = "no earlier run left anything to resume; this one started afresh"
    else
      message = "resumed with "//plural(blocks, "block")//" of results from an earlier run"
      if (variant_count(deck%cards) > 1) message = "resumed with "//plural(blocks, "variant")// &
        " from an earlier run"
    end if
    message = deck%source%path//": "//message//line_feed
  end function resumption_message

  !> The columns of the VARY parameters.
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

  !> Computes a variant on all threads and writes its rows; of the first one it also keeps the log.
  !! Errors: the own modes of a link could not be found, in the only variant of a deck.
  subroutine run_whole_variant(deck, number, threads, session, error)
    type(deck_t), intent(inout) :: deck !! the same on return
    integer, intent(in) :: number !! of the variant, from 1
    integer, intent(in) :: threads
    type(session_t), intent(inout) :: session
    type(error_t), allocatable, intent(out) :: error

    type(variant_run_t) :: run
    type(model_t) :: model
    type(check_t) :: check
    type(evaluation_store_t) :: store
    type(findings_t) :: findings
    type(run_totals_t) :: totals
    type(stopwatch_t) :: watch
    type(error_t), allocatable :: failure
    real(wp) :: computing, writing
    integer :: block

    call start_stopwatch(watch)
    if (variant_count(deck%cards) == 1) then
      call begin_variant_run(run, deck%model)
      run%progress = session%progress
    else
      call check_number(deck%cards, number, deck%limits, store%cards, model, check)
      call join_check(session%checks, deck%cards, number, check)
      if (refuses_deck(session%checks)) return
      if (is_refused(check)) then
        call first_error(check, error)
        call write_failed_variant(deck, number, session, error)
        return
      end if
      call begin_variant_run(run, model)
    end if
    call divide_positions(run%results%model, positions_kept(run%results%model), &
      run%results%mechanism%linkage, threads, run%blocks)
    call begin_computing(run, threads, session%journal, number, store%links)
    do block = 1, block_count(run)
      call announce_block(deck, number, block, run)
      call compute_block(run, block, error)
      call lap(watch, computing)
      if (was_interrupted()) then
        session%lost = trim(run%under_way)
        return
      end if
      if (allocated(error)) then
        if (variant_count(deck%cards) == 1) return
        if (block > 1) call end_results(session%outputs, failure)
        call write_failed_variant(deck, number, session, error)
        call move_alloc(failure, error)
        return
      end if
      call write_results(session%outputs, run%results, threads, block_count(run) > 1, error)
      if (allocated(error)) return
      call lap(watch, writing)
      totals = totals_of(run%results)
      totals%computing = computing
      totals%writing = writing
      ! Every block was placed before, when all were surveyed.
      if (block_count(run) > 1) totals%kinematic_solutions = totals%kinematic_solutions + &
        totals%rows
      call add_totals(session%totals, totals)
      call find_failures(run%results, findings)
      if (.not. allocated(run%blocks)) cycle
      associate (all => size(run%blocks%first_alike))
        call show_progress(run%progress, min(block*run%blocks%kept, all), all)
      end associate
    end do
    if (variant_count(deck%cards) == 1) session%progress = run%progress
    call end_results(session%outputs, error)
    if (allocated(error)) return
    call find_warnings(run%results, findings)
    call add_findings(session%findings, findings)
    if (session%logged > 0) return
    if (allocated(run%blocks)) run%results%model = run%blocks%model
    session%log = log_of_variant(run%results)
    session%logged = number
    if (totals%has_frequencies) session%method = run%results%found%sweep%request%method
  end subroutine run_whole_variant

  !> Makes the words by which other ranks help with a block of positions.
  subroutine announce_block(deck, number, block, run)
    type(deck_t), intent(inout) :: deck !! the same on return
    integer, intent(in) :: number, block !! of the variant, of the block
    type(variant_run_t), intent(inout) :: run

    type(byte_stream_t) :: announced
    type(string_t) :: no_settings(0)

    if (rank_count() == 1) return
    call announced%add_text(blocks_announced)
    call pass_deck(announced, deck, no_settings)
    call announced%add(number)
    call announced%add(merge(block, 0, block_count(run) > 1))
    run%announcement = announced%bytes%storage(:announced%bytes%length)
  end subroutine announce_block

  !> Writes the failed rows of a variant that could not be computed.
  subroutine write_failed_variant(deck, number, session, error)
    type(deck_t), intent(in) :: deck
    integer, intent(in) :: number !! of the variant
    type(session_t), intent(inout) :: session
    type(error_t), allocatable, intent(inout) :: error !! the reason; not allocated on return

    type(variant_rows_t) :: rows

    call fail_variant(size(session%outputs%kinds), variant_text(deck%cards, number), &
      variant_values(deck%cards, number), error, rows)
    call write_found_rows(session%outputs, deck%model%title, rows)
    call add_totals(session%totals, rows%totals)
    call add_findings(session%findings, rows%findings)
    deallocate (error)
  end subroutine write_failed_variant

  !> Computes all variants and writes their rows in order. Several are computed at a time if one of
  !! them has too few positions for all threads. Errors: as for `run_whole_variant`.
  subroutine run_variants(deck, options, session, error)
    type(deck_t), intent(inout), target :: deck !! the same on return
    type(run_options_t), intent(in) :: options
    type(session_t), intent(inout), target :: session
    type(error_t), allocatable, intent(out) :: error

    type(variant_job_t) :: job
    integer :: variants, rows, i, together

    variants = variant_count(deck%cards)
    associate (model => deck%model, threads => options%threads)
      rows = size(model%crank%value)*size(model%speed%value) + motion_instants_of(model)
      ! Parts have variants as a whole.
      if ((variants == 1 .or. rows > many_rows) .and. options%part%count == 0 .and. &
        .not. options%join) then
        session%checks = begin_checks(model, deck%diagnostics, variants)
        do i = 1, variants
          call run_whole_variant(deck, i, threads, session, error)
          if (allocated(error) .or. was_interrupted() .or. refuses_deck(session%checks)) return
          if (variants > 1) call show_progress(session%progress, i, variants)
        end do
        return
      end if
      ! Only one thread at a time can use ARPACK.
      together = 1
      if (size(model%crank%value) > many_positions .or. model%solver == solver_band) &
        together = threads
      job%deck => deck
      job%outputs => session%outputs
      job%progress = session%progress
      job%part = options%part
      call run_variant_tasks(job, rows, threads/together, together, session%journal)
      session%checks = job%checks
      session%findings = job%findings
      session%totals = job%totals
      session%progress = job%progress
      session%method = job%method
      session%logged = job%logged
      if (allocated(job%log)) session%log = job%log
    end associate
  end subroutine run_variants

  !> Helps the leader with the blocks of a sweep that it has announced.
  subroutine help_with_blocks(stream, settings, threads)
    type(byte_stream_t), intent(inout) :: stream !! that announces them
    type(string_t), intent(in) :: settings(:) !! of the command line
    integer, intent(in) :: threads            !! number to use

    type(deck_t) :: deck
    type(variant_run_t) :: run
    type(model_t) :: model
    type(card_t), allocatable :: cards(:)
    type(diagnostics_t) :: none
    integer :: number, block

    call pass_deck(stream, deck, settings)
    call stream%pass(number)
    call stream%pass(block)
    call read_variant(deck%cards, number, cards, none, model)
    call begin_variant_run(run, model)
    if (block > 0) call divide_positions(model, positions_kept(model), &
      run%results%mechanism%linkage, threads, run%blocks)
    call help_with_variant(run, threads, max(1, block), stream)
  end subroutine help_with_blocks

  !> Writes the texts beside the tables, and puts all files in place. Errors: the run was
  !! interrupted, or a file is not complete.
  subroutine publish(deck, options, session, error)
    type(deck_t), intent(in) :: deck
    type(run_options_t), intent(in) :: options
    type(session_t), intent(inout) :: session
    type(error_t), allocatable, intent(out) :: error

    integer :: blocks

    ! Checked once, before files are put in place: afterwards the run counts as done.
    if (was_interrupted()) then
      call close_journal(session%journal, blocks)
      call set_error(error, error_of_interruption, end_of_run(options)// &
        "; its earlier results are untouched"//resume_hint(blocks, session%lost), deck%source%path)
      return
    end if
    if (options%part%count > 0) then
      call publish_journal(session%journal, error)
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

  !> What ended a run before it was done.
  function end_of_run(options) result(text)
    type(run_options_t), intent(in) :: options
    character(len=:), allocatable :: text

    text = "interrupted"
    if (.not. allocated(options%limit)) return
    if (was_out_of_time()) text = "stopped at its time limit of "//options%limit
  end function end_of_run

  !> What to do after an interruption; empty without a journal, if nothing is lost.
  pure function resume_hint(blocks, lost) result(hint)
    integer, intent(in) :: blocks !! in the journal
    character(len=:), allocatable, intent(in) :: lost !! study of which nothing is kept
    character(len=:), allocatable :: hint

    hint = ""
    if (blocks > 0) hint = "; --resume continues from what it has computed"
    if (.not. allocated(lost)) return
    if (len(lost) > 0) hint = hint//"; nothing is kept of '"//lost//"'"
  end function resume_hint

  !> The text of `run.log`: what the deck describes, accuracy of its results, warnings, failed
  !! rows.
  pure function log_text(deck, session) result(text)
    type(deck_t), intent(in) :: deck
    type(session_t), intent(in) :: session
    character(len=:), allocatable :: text

    text = findings_log(deck%diagnostics, deck%source, session%findings)
    if (session%totals%has_frequencies) text = accuracy_summary(session%method, &
      session%totals%largest_error)//text
    if (session%totals%variants > 1) then
      if (len(text) == 0) text = "nothing to be told of them"//line_feed
      text = trim(merge("first of          ", "first computed of ", session%logged == 1))//" "// &
        to_string(session%totals%variants)//" variants, "//variant_text(deck%cards, &
        session%logged)//":"//line_feed//session%log//"all variants, the last one with "// &
        variant_text(deck%cards, session%totals%variants)//":"//line_feed//text
    else
      text = session%log//text
    end if
  end function log_text

end module deck_runs
