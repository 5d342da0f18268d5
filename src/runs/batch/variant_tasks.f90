!> The variants of a deck as tasks. Each task computes a variant and leaves its rows, its findings
!! and its totals.
module variant_tasks
  use byte_streams, only: byte_stream_t
  use deck_bytes, only: pass_deck
  use deck_outputs, only: forget_waiting, outputs_t, write_found_rows
  use deck_readings, only: deck_t
  use errors, only: error_of_input, error_of_numerics, error_t, set_error
  use evaluations, only: evaluation_store_t
  use interruption, only: was_interrupted
  use jobs, only: job_t
  use kinds, only: wp
  use models, only: model_t
  use omp_lib, only: omp_get_thread_num
  use progress, only: progress_t, show_progress
  use rank_tasks, only: help_with_tasks
  use ranks, only: rank_count
  use report_table, only: tables_of
  use report_types, only: any_table_t
  use run_findings, only: add_findings, findings_t
  use run_totals, only: add_totals, run_totals_t
  use study_parts, only: first_variant, last_variant, part_t
  use stopwatch, only: lap, start_stopwatch, stopwatch_t
  use task_journal, only: journal_t
  use tasks, only: run_tasks
  use text, only: string_t
  use variant_checks, only: begin_checks, check_t, check_number, checks_t, first_error, &
    is_refused, join_check, refuses_deck
  use variant_rows, only: fail_variant, find_variant_rows, pass_variant_rows, variant_rows_t
  use variant_runs, only: begin_variant_run, compute_variant, variant_run_t
  use variants, only: variant_count, variant_text, variant_values
  implicit none (type, external)
  private

  public :: variant_job_t, begin_variant_job, run_variant_tasks, help_with_variants, &
    variants_announced, group_of_variants

  !> The variants under way. Their results lie in a ring: a variant takes the place of one that was
  !! written before.
  type, extends(job_t) :: variant_job_t
    type(deck_t), pointer :: deck => null()                 !! with all variants
    type(outputs_t), pointer :: outputs => null()           !! opened
    type(part_t) :: part                                    !! of the study that is computed
    type(checks_t) :: checks                                !! of all finished variants
    type(findings_t) :: findings                            !! of all finished variants
    type(run_totals_t) :: totals                            !! of all finished variants
    type(progress_t) :: progress                            !! by number of variants
    character(len=:), allocatable :: log                    !! of the first variant that was
                                                            !! computed,
    integer :: logged = 0                                   !! its number,
    integer :: method = 0                                   !! by which its frequencies were found
    integer, private :: threads = 1                         !! that compute a variant together
    type(any_table_t), allocatable, private :: kinds(:)    !! (tables) of the deck
    type(variant_rows_t), allocatable, private :: rows(:)   !! (0: ring − 1) not yet written
    type(evaluation_store_t), allocatable, private :: stores(:) !! (threads)
    integer, private :: headless = 0                        !! number of the variant that leads
                                                            !! since others failed; 0: none
    type(variant_rows_t), private :: head                   !! what it brings for heads of tables
  contains
    procedure :: run => run_variant
    procedure :: pass => pass_variant
    procedure :: finish => finish_variant
  end type variant_job_t

  !> Variants that may wait for their turn, per thread: they have about this many rows, and they are
  !! at most this many. On all ranks together they are at most `most_of_all`, or two a thread.
  integer, parameter :: rows_at_a_time = 8192, most_at_a_time = 256, most_of_all = 16384

  !> Group of these tasks in the journal.
  integer, parameter :: group_of_variants = 0

  !> First word of what other ranks are told.
  character(len=*), parameter :: variants_announced = "variants"

contains

  !> Computes the variants of a part, or all, and writes their rows in order. Those that cannot be
  !! computed have failed rows.
  subroutine run_variant_tasks(job, rows_of_variant, at_a_time, threads, journal)
    type(variant_job_t), intent(inout) :: job        !! with its deck and outputs
    integer, intent(in) :: rows_of_variant           !! approximate number, of each table
    integer, intent(in) :: at_a_time                 !! variants that a rank computes at a time
    integer, intent(in) :: threads                   !! that compute one together
    type(journal_t), intent(inout) :: journal        !! of the run

    type(byte_stream_t) :: stream
    type(string_t) :: no_settings(0)
    type(findings_t) :: no_findings
    type(run_totals_t) :: no_totals
    integer :: room, count, variants, first, last

    count = at_a_time*rank_count()
    room = max(1, min(most_at_a_time, rows_at_a_time/max(1, rows_of_variant)))
    room = max(min(count*room, most_of_all), 2*count)
    call begin_variant_job(job, room, at_a_time, threads)
    if (rank_count() > 1) then
      call stream%add_text(variants_announced)
      call pass_deck(stream, job%deck, no_settings)
      call stream%add(room)
      call stream%add(threads)
      job%announcement = stream%bytes%storage(:stream%bytes%length)
    end if
    variants = variant_count(job%deck%cards)
    first = first_variant(job%part, variants)
    last = last_variant(job%part, variants)
    call run_tasks(job, first, last, at_a_time, journal, group_of_variants, room)
    if (job%headless == 0) return
    ! The variant that was to lead has failed, and the next one that has not came without what the
    ! heads of tables are made of. It happens once in a run, if ever, before anything is written.
    call compute(job, job%headless, .true., job%stores(1), job%head)
    if (was_interrupted()) return
    deallocate (job%error)
    call begin_checks_of(job)
    job%findings = no_findings
    job%totals = no_totals
    call forget_waiting(job%outputs)
    call run_tasks(job, first, last, at_a_time, journal, group_of_variants, room)
  end subroutine run_variant_tasks

  !> Helps the leader with the variants that it has announced.
  subroutine help_with_variants(stream, settings, at_a_time)
    type(byte_stream_t), intent(inout) :: stream !! that announces them
    type(string_t), intent(in) :: settings(:) !! of the command line
    integer, intent(in) :: at_a_time          !! variants to compute at a time

    type(variant_job_t) :: job
    type(deck_t), target :: deck
    integer :: numbers(2)

    call pass_deck(stream, deck, settings)
    call stream%pass(numbers)
    job%deck => deck
    call begin_variant_job(job, numbers(1), at_a_time, numbers(2))
    call help_with_tasks(job, at_a_time)
  end subroutine help_with_variants

  !> Makes a job ready for its tasks.
  subroutine begin_variant_job(job, room, at_a_time, threads)
    type(variant_job_t), intent(inout) :: job !! with its deck
    integer, intent(in) :: room               !! variants under way or waiting for their turn
    integer, intent(in) :: at_a_time          !! variants that are computed at a time
    integer, intent(in) :: threads            !! that compute one together

    job%threads = threads
    call begin_checks_of(job)
    call tables_of(job%deck%model, job%kinds)
    ! One thread more may serve other ranks.
    allocate (job%stores(at_a_time + 1), job%rows(0:room - 1))
  end subroutine begin_variant_job

  !> Begins the checks of the variants of a part, or of all.
  subroutine begin_checks_of(job)
    type(variant_job_t), intent(inout) :: job !! with its deck

    associate (variants => variant_count(job%deck%cards))
      job%checks = begin_checks(job%deck%model, job%deck%diagnostics, &
        last_variant(job%part, variants) - first_variant(job%part, variants) + 1)
    end associate
  end subroutine begin_checks_of

  !> Place of a variant in the ring.
  pure integer function place_of(job, number)
    type(variant_job_t), intent(in) :: job
    integer, intent(in) :: number

    place_of = modulo(number, size(job%rows))
  end function place_of

  !> Computes a variant.
  subroutine run_variant(self, number)
    class(variant_job_t), intent(inout) :: self
    integer, intent(in) :: number !! of the variant

    associate (store => self%stores(omp_get_thread_num() + 1), mine => place_of(self, number))
      call compute(self, number, number == self%deck%leading, store, self%rows(mine))
    end associate
  end subroutine run_variant

  subroutine compute(job, number, leads, store, rows)
    class(variant_job_t), intent(in) :: job
    integer, intent(in) :: number                  !! of the variant
    logical, intent(in) :: leads                   !! whether heads of tables and log are to be its
    type(evaluation_store_t), intent(inout) :: store
    type(variant_rows_t), intent(inout) :: rows

    type(variant_run_t) :: run
    type(model_t) :: model
    type(check_t) :: check
    type(journal_t) :: no_journal
    type(stopwatch_t) :: watch
    type(error_t), allocatable :: error
    real(wp) :: computing, writing

    call start_stopwatch(watch)
    ! One thread at a time makes texts: gfortran 12 keeps the lengths of such results in one place
    ! for all threads.
    !$omp critical (one_at_a_time)
    call check_number(job%deck%cards, number, job%deck%limits, store%cards, model, check)
    if (is_refused(check)) then
      call first_error(check, error)
    else
      call begin_variant_run(run, model)
    end if
    !$omp end critical (one_at_a_time)
    if (.not. allocated(error)) call compute_variant(run, job%threads, no_journal, -1, &
      store%links, error)
    call lap(watch, computing)
    if (was_interrupted()) return
    if (allocated(error)) then
      !$omp critical (one_at_a_time)
      call fail_variant(size(job%kinds), variant_text(job%deck%cards, number), &
        variant_values(job%deck%cards, number), error, rows)
      !$omp end critical (one_at_a_time)
      rows%check = check
      return
    end if
    call find_variant_rows(job%kinds, run%results, job%threads, leads, rows)
    call lap(watch, writing)
    rows%check = check
    rows%totals%computing = computing
    rows%totals%writing = writing
  end subroutine compute

  !> Passes the rows of a variant.
  subroutine pass_variant(self, number, stream)
    class(variant_job_t), intent(inout) :: self
    integer, intent(in) :: number !! of the variant
    type(byte_stream_t), intent(inout) :: stream

    type(variant_rows_t) :: rows

    associate (mine => self%rows(place_of(self, number)))
      if (stream%reads) mine = rows
      call pass_variant_rows(stream, mine)
    end associate
  end subroutine pass_variant

  !> Writes the rows of a variant and adds its findings and totals to those of all.
  subroutine finish_variant(self, number)
    class(variant_job_t), intent(inout) :: self
    integer, intent(in) :: number !! of the variant

    type(variant_rows_t) :: rows
    type(stopwatch_t) :: watch
    real(wp) :: writing
    integer :: mine, first, variants
    logical :: writes

    mine = place_of(self, number)
    call join_check(self%checks, self%deck%cards, number, self%rows(mine)%check)
    if (refuses_deck(self%checks)) then
      call set_error(self%error, error_of_input, "the deck is refused")
      return
    end if
    ! A part has no tables: its rows are in the journal.
    writes = self%part%count == 0
    if (writes .and. .not. (self%outputs%have_heads .or. self%rows(mine)%has_failed .or. &
      allocated(self%rows(mine)%log))) then
      if (self%headless == 0) then
        ! Not here: other threads wait.
        self%headless = number
        call set_error(self%error, error_of_numerics, "the tables have no heads")
        return
      end if
      call take_head(self%head, self%rows(mine))
    end if
    call start_stopwatch(watch)
    if (writes) call write_found_rows(self%outputs, self%deck%model%title, self%rows(mine))
    call lap(watch, writing)
    self%rows(mine)%totals%writing = self%rows(mine)%totals%writing + writing
    call add_findings(self%findings, self%rows(mine)%findings)
    call add_totals(self%totals, self%rows(mine)%totals)
    if (allocated(self%rows(mine)%log)) then
      self%log = self%rows(mine)%log
      self%logged = number
      self%method = self%rows(mine)%method
    end if
    self%rows(mine) = rows
    variants = variant_count(self%deck%cards)
    first = first_variant(self%part, variants)
    call show_progress(self%progress, number - first + 1, &
      last_variant(self%part, variants) - first + 1)
  end subroutine finish_variant

  !> Takes what the heads of tables and the log are made of from the variant computed again.
  subroutine take_head(head, rows)
    type(variant_rows_t), intent(in) :: head
    type(variant_rows_t), intent(inout) :: rows !! of the same variant

    integer :: i

    do i = 1, size(rows%tables)
      rows%tables(i)%columns = head%tables(i)%columns
    end do
    rows%log = head%log
    rows%method = head%method
  end subroutine take_head

end module variant_tasks
