!> The variants of a deck as tasks. Each task computes a variant and leaves its rows, its findings
!! and its totals.
module variant_tasks
  use byte_streams, only: get_integers, put_integers, put_string
  use cards, only: card_t
  use deck_bytes, only: get_deck, put_deck
  use deck_outputs, only: outputs_t, tables_of, write_found_rows
  use deck_readings, only: deck_t, read_variant
  use diagnostics, only: diagnostics_t
  use errors, only: error_t, outcome_t
  use interruption, only: was_interrupted
  use jobs, only: job_t
  use kinds, only: wp
  use link_store, only: link_store_t
  use models, only: model_t
  use omp_lib, only: omp_get_thread_num
  use progress, only: progress_t, show_progress
  use rank_tasks, only: help_with_tasks
  use ranks, only: rank_count
  use report_kinds, only: table_kind_t
  use run_findings, only: add_findings, findings_t
  use run_totals, only: add_totals, run_totals_t
  use stopwatch, only: lap, start_stopwatch, stopwatch_t
  use task_journal, only: journal_t
  use tasks, only: run_tasks
  use text, only: string_t
  use text_buffer, only: text_buffer_t
  use variant_rows, only: find_variant_rows, get_variant_rows, put_variant_rows, variant_rows_t
  use variant_runs, only: begin_variant_run, compute_variant, variant_run_t
  use variants, only: variant_count
  implicit none (type, external)
  private

  public :: variant_job_t, run_variant_tasks, help_with_variants, variants_announced

  !> What a thread keeps from one variant to the next.
  type :: thread_store_t
    type(card_t), allocatable :: cards(:) !! of the last variant
    type(link_store_t) :: links           !! whose own modes are known
  end type thread_store_t

  !> The variants under way. Their results lie in a ring: a variant takes the place of one that was
  !! written before.
  type, extends(job_t) :: variant_job_t
    type(deck_t), pointer :: deck => null()                 !! with all variants
    type(outputs_t), pointer :: outputs => null()           !! opened
    type(findings_t) :: findings                            !! of all finished variants
    type(run_totals_t) :: totals                            !! of all finished variants
    type(progress_t) :: progress                            !! by number of variants
    character(len=:), allocatable :: log                    !! of the first variant
    integer :: method = 0                                   !! by which its frequencies were found
    integer, private :: threads = 1                         !! that compute a variant together
    type(table_kind_t), allocatable, private :: kinds(:)    !! (tables) of the deck
    type(variant_rows_t), allocatable, private :: rows(:)   !! (0: ring − 1) not yet written
    type(outcome_t), allocatable, private :: outcomes(:)    !! (0: ring − 1)
    type(thread_store_t), allocatable, private :: stores(:) !! (threads)
  contains
    procedure :: run => run_variant
    procedure :: pack => pack_variant
    procedure :: unpack => unpack_variant
    procedure :: finish => finish_variant
  end type variant_job_t

  !> Variants that may wait for their turn, per thread: they have about this many rows, and they are
  !! at most this many. On all ranks together they are at most `most_of_all`, or two a thread.
  integer, parameter :: rows_at_a_time = 8192, most_at_a_time = 256, most_of_all = 16384

  !> Group of these tasks in the journal.
  integer, parameter :: journal_group = 0

  !> First word of what other ranks are told.
  character(len=*), parameter :: variants_announced = "variants"

contains

  !> Computes all variants and writes their rows in order. Errors: the own modes of a link could not
  !! be found.
  subroutine run_variant_tasks(job, rows_of_variant, at_a_time, threads, journal, error)
    type(variant_job_t), intent(inout) :: job        !! with its deck and outputs
    integer, intent(in) :: rows_of_variant           !! approximate number, of each table
    integer, intent(in) :: at_a_time                 !! variants that a rank computes at a time
    integer, intent(in) :: threads                   !! that compute one together
    type(journal_t), intent(inout) :: journal        !! of the run
    type(error_t), allocatable, intent(out) :: error !! of the first variant that fails

    type(text_buffer_t) :: bytes
    integer :: room, count

    count = at_a_time*rank_count()
    room = max(1, min(most_at_a_time, rows_at_a_time/max(1, rows_of_variant)))
    room = max(min(count*room, most_of_all), 2*count)
    call make_room(job, room, at_a_time, threads)
    call put_string(bytes, variants_announced)
    call put_deck(bytes, job%deck)
    call put_integers(bytes, [room, threads])
    job%announcement = bytes%storage(:bytes%length)
    call run_tasks(job, 1, variant_count(job%deck%cards), at_a_time, journal, journal_group, room)
    if (allocated(job%error)) error = job%error
  end subroutine run_variant_tasks

  !> Helps the leader with the variants that it has announced.
  subroutine help_with_variants(bytes, at, settings, at_a_time)
    character(len=*), intent(in) :: bytes     !! that announce them
    integer, intent(inout) :: at              !! place of the first byte; on return, after the last
    type(string_t), intent(in) :: settings(:) !! of the command line
    integer, intent(in) :: at_a_time          !! variants to compute at a time

    type(variant_job_t) :: job
    type(deck_t), target :: deck
    integer :: numbers(2)

    call get_deck(bytes, at, settings, deck)
    call get_integers(bytes, at, numbers)
    job%deck => deck
    call make_room(job, numbers(1), at_a_time, numbers(2))
    call help_with_tasks(job, at_a_time)
  end subroutine help_with_variants

  subroutine make_room(job, room, at_a_time, threads)
    type(variant_job_t), intent(inout) :: job
    integer, intent(in) :: room, at_a_time, threads

    job%threads = threads
    job%kinds = tables_of(job%deck%model)
    ! One thread more may serve other ranks.
    allocate (job%stores(at_a_time + 1), job%rows(0:room - 1), job%outcomes(0:room - 1))
  end subroutine make_room

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
      call compute(self, number, store, self%rows(mine), self%outcomes(mine)%error)
    end associate
  end subroutine run_variant

  subroutine compute(job, number, store, rows, error)
    class(variant_job_t), intent(in) :: job
    integer, intent(in) :: number                  !! of the variant
    type(thread_store_t), intent(inout) :: store
    type(variant_rows_t), intent(inout) :: rows
    type(error_t), allocatable, intent(out) :: error

    type(variant_run_t) :: run
    type(model_t) :: model
    type(diagnostics_t) :: none
    type(journal_t) :: no_journal
    type(stopwatch_t) :: watch
    real(wp) :: reading, computing, writing

    ! One thread at a time makes texts: gfortran 12 keeps the lengths of such results in one place
    ! for all threads.
    !$omp critical (one_at_a_time)
    call start_stopwatch(watch)
    call read_variant(job%deck%cards, number, store%cards, none, model)
    call begin_variant_run(run, model)
    call lap(watch, reading)
    !$omp end critical (one_at_a_time)
    call compute_variant(run, job%threads, no_journal, -1, store%links, error)
    call lap(watch, computing)
    if (allocated(error) .or. was_interrupted()) return
    call find_variant_rows(job%kinds, run%results, job%threads, number == 1, rows)
    call lap(watch, writing)
    rows%totals%computing = reading + computing
    rows%totals%writing = writing
  end subroutine compute

  !> Appends the rows of a variant as bytes; nothing if it could not be computed.
  subroutine pack_variant(self, number, bytes)
    class(variant_job_t), intent(in) :: self
    integer, intent(in) :: number !! of the variant
    type(text_buffer_t), intent(inout) :: bytes

    if (allocated(self%outcomes(place_of(self, number))%error)) return
    call put_variant_rows(bytes, self%rows(place_of(self, number)))
  end subroutine pack_variant

  !> Reads what `pack_variant` wrote.
  subroutine unpack_variant(self, number, bytes)
    class(variant_job_t), intent(inout) :: self
    integer, intent(in) :: number !! of the variant
    character(len=*), intent(in) :: bytes

    integer :: at

    at = 1
    call get_variant_rows(bytes, at, self%rows(place_of(self, number)))
  end subroutine unpack_variant

  !> Writes the rows of a variant and adds its findings and totals to those of all.
  subroutine finish_variant(self, number)
    class(variant_job_t), intent(inout) :: self
    integer, intent(in) :: number !! of the variant

    type(variant_rows_t) :: rows
    type(stopwatch_t) :: watch
    real(wp) :: writing
    integer :: mine

    mine = place_of(self, number)
    if (allocated(self%outcomes(mine)%error)) then
      self%error = self%outcomes(mine)%error
      return
    end if
    call start_stopwatch(watch)
    call write_found_rows(self%outputs, self%deck%model%title, self%rows(mine))
    call lap(watch, writing)
    self%rows(mine)%totals%writing = self%rows(mine)%totals%writing + writing
    call add_findings(self%findings, self%rows(mine)%findings)
    call add_totals(self%totals, self%rows(mine)%totals)
    if (allocated(self%rows(mine)%log)) then
      self%log = self%rows(mine)%log
      self%method = self%rows(mine)%method
    end if
    self%rows(mine) = rows
    call show_progress(self%progress, number, variant_count(self%deck%cards))
  end subroutine finish_variant

end module variant_tasks
