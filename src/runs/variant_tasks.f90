!> The variants of a deck as tasks. Each task computes a variant and leaves its rows, its findings
!! and its totals.
module variant_tasks
  use cards, only: card_t
  use deck_outputs, only: outputs_t, write_found_rows
  use deck_readings, only: deck_t
  use diagnostics, only: diagnostics_t
  use errors, only: error_t, outcome_t
  use interruption, only: was_interrupted
  use kinds, only: wp
  use link_store, only: link_store_t
  use models, only: model_t
  use omp_lib, only: omp_get_thread_num
  use progress, only: progress_t, show_progress
  use run_findings, only: add_findings, findings_t
  use run_totals, only: add_totals, run_totals_t
  use stopwatch, only: lap, start_stopwatch, stopwatch_t
  use task_journal, only: journal_t
  use tasks, only: job_t, run_tasks
  use text_buffer, only: text_buffer_t
  use variant_readings, only: read_variant
  use variant_rows, only: find_variant_rows, get_variant_rows, put_variant_rows, variant_rows_t
  use variant_runs, only: begin_variant_run, compute_variant, variant_run_t
  use variants, only: variant_count
  implicit none (type, external)
  private

  public :: variant_job_t, run_variant_tasks

  !> What a thread keeps from one variant to the next.
  type :: thread_store_t
    type(card_t), allocatable :: cards(:) !! of the last variant
    type(link_store_t) :: links           !! whose own modes are known
  end type thread_store_t

  !> The variants under way: those from `first` on.
  type, extends(job_t) :: variant_job_t
    type(deck_t), pointer :: deck => null()                 !! with all variants
    type(outputs_t), pointer :: outputs => null()           !! opened
    type(findings_t) :: findings                            !! of all finished variants
    type(run_totals_t) :: totals                            !! of all finished variants
    type(progress_t) :: progress                            !! by number of variants
    integer, private :: first = 1                           !! number of the first one under way
    type(variant_rows_t), allocatable, private :: rows(:)   !! (variants under way) not yet written
    type(outcome_t), allocatable, private :: outcomes(:)    !! (variants under way)
    type(thread_store_t), allocatable, private :: stores(:) !! (threads)
  contains
    procedure :: run => run_variant
    procedure :: pack => pack_variant
    procedure :: unpack => unpack_variant
    procedure :: finish => finish_variant
  end type variant_job_t

  !> Variants that are handed out together, per thread: they have about this many rows, and they are
  !! at most this many.
  integer, parameter :: rows_at_a_time = 8192, most_at_a_time = 256

  !> Group of these tasks in the journal.
  integer, parameter :: journal_group = 0

contains

  !> Computes all variants but the first, which have been checked, and writes their rows in order.
  !! Errors: the own modes of a link could not be found.
  subroutine run_variant_tasks(job, rows_of_variant, threads, journal, error)
    type(variant_job_t), intent(inout) :: job        !! with its deck and outputs
    integer, intent(in) :: rows_of_variant           !! approximate number, of each table
    integer, intent(in) :: threads                   !! number to use
    type(journal_t), intent(inout) :: journal        !! of the run
    type(error_t), allocatable, intent(out) :: error !! of the first variant that fails

    integer :: first, last, count, at_a_time

    count = variant_count(job%deck%cards)
    at_a_time = threads*max(1, min(most_at_a_time, rows_at_a_time/max(1, rows_of_variant)))
    allocate (job%stores(threads))
    do first = 2, count, at_a_time
      last = min(first + at_a_time - 1, count)
      job%first = first
      allocate (job%rows(last - first + 1), job%outcomes(last - first + 1))
      call run_tasks(job, first, last, threads, journal, journal_group)
      deallocate (job%rows, job%outcomes)
      if (allocated(job%error)) error = job%error
      if (allocated(job%error) .or. was_interrupted()) return
    end do
  end subroutine run_variant_tasks

  !> Computes a variant.
  subroutine run_variant(self, number)
    class(variant_job_t), intent(inout) :: self
    integer, intent(in) :: number !! of the variant

    integer :: mine

    mine = number - self%first + 1
    associate (store => self%stores(omp_get_thread_num() + 1))
      call compute(self%deck, self%outputs, number, store, self%rows(mine), &
        self%outcomes(mine)%error)
    end associate
  end subroutine run_variant

  subroutine compute(deck, outputs, number, store, rows, error)
    type(deck_t), intent(in) :: deck
    type(outputs_t), intent(in) :: outputs
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
    call read_variant(deck%cards, number, store%cards, none, model)
    call begin_variant_run(run, model)
    call lap(watch, reading)
    !$omp end critical (one_at_a_time)
    call compute_variant(run, 1, no_journal, -1, store%links, error)
    call lap(watch, computing)
    if (allocated(error) .or. was_interrupted()) return
    call find_variant_rows(outputs%kinds, run%results, rows)
    call lap(watch, writing)
    rows%totals%computing = reading + computing
    rows%totals%writing = writing
  end subroutine compute

  !> Appends the rows of a variant as bytes; nothing if it could not be computed.
  subroutine pack_variant(self, number, bytes)
    class(variant_job_t), intent(in) :: self
    integer, intent(in) :: number !! of the variant
    type(text_buffer_t), intent(inout) :: bytes

    if (allocated(self%outcomes(number - self%first + 1)%error)) return
    call put_variant_rows(bytes, self%rows(number - self%first + 1))
  end subroutine pack_variant

  !> Reads what `pack_variant` wrote.
  subroutine unpack_variant(self, number, bytes)
    class(variant_job_t), intent(inout) :: self
    integer, intent(in) :: number !! of the variant
    character(len=*), intent(in) :: bytes

    integer :: at

    at = 1
    call get_variant_rows(bytes, at, self%rows(number - self%first + 1))
  end subroutine unpack_variant

  !> Writes the rows of a variant and adds its findings and totals to those of all.
  subroutine finish_variant(self, number)
    class(variant_job_t), intent(inout) :: self
    integer, intent(in) :: number !! of the variant

    type(variant_rows_t) :: rows
    type(stopwatch_t) :: watch
    real(wp) :: writing
    integer :: mine

    mine = number - self%first + 1
    if (allocated(self%outcomes(mine)%error)) then
      self%error = self%outcomes(mine)%error
      return
    end if
    call start_stopwatch(watch)
    call write_found_rows(self%outputs, self%rows(mine))
    call lap(watch, writing)
    self%rows(mine)%totals%writing = self%rows(mine)%totals%writing + writing
    call add_findings(self%findings, self%rows(mine)%findings)
    call add_totals(self%totals, self%rows(mine)%totals)
    self%rows(mine) = rows
    call show_progress(self%progress, number, variant_count(self%deck%cards))
  end subroutine finish_variant

end module variant_tasks
