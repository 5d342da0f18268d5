!> One set of values of a deck → its results, without outputs, files or journal: what sweeps do with
!! every variant, on any thread or rank, and what searches over values do.
module evaluations
  use cards, only: card_t
  use errors, only: error_of_input, error_of_interruption, error_t, set_error
  use interruption, only: was_interrupted
  use link_store, only: link_store_t
  use kinds, only: wp
  use models, only: model_t, report_number
  use summary_values, only: find_lack, find_summary, summary_value_t
  use task_journal, only: journal_t
  use variant_checks, only: check_t, check_values, first_error
  use variant_readings, only: run_limits_t
  use variant_runs, only: begin_variant_run, compute_variant, variant_run_t
  use variants, only: deck_cards_t
  implicit none (type, external)
  private

  public :: evaluate, evaluation_store_t

  !> What is kept from one evaluation to the next on the same thread.
  type :: evaluation_store_t
    type(card_t), allocatable :: cards(:) !! of the last values
    type(link_store_t) :: links           !! whose own modes are known
  end type evaluation_store_t

contains

  !> The quantities of REPORT summary for any values of the VARY cards, with their errors. Several
  !! threads may call it at the same time, with stores of their own.
  !!
  !! Errors: the values make no sound deck, the first reason in the order of the deck's lines;
  !! nothing can be computed; a quantity is nowhere; it was interrupted.
  subroutine evaluate(deck_cards, values, limits, store, found, error)
    type(deck_cards_t), intent(in) :: deck_cards    !! without errors, with REPORT summary
    real(wp), intent(in) :: values(:)               !! (parameters) in the units of their VARY cards
    type(run_limits_t), intent(in) :: limits
    type(evaluation_store_t), intent(inout) :: store !! new, or of another evaluation of this deck
    type(summary_value_t), allocatable, intent(out) :: found(:) !! (quantities) as the card has them
    type(error_t), allocatable, intent(out) :: error !! why there are none, without a place

    type(variant_run_t) :: run
    type(model_t) :: model
    type(check_t) :: check
    type(journal_t) :: no_journal
    character(len=:), allocatable :: reason
    integer :: places, failed

    ! One thread at a time makes texts: gfortran 12 keeps the lengths of such results in one place
    ! for all threads.
    !$omp critical (one_at_a_time)
    call check_values(deck_cards, values, limits, store%cards, model, check)
    call first_error(check, error)
    if (.not. allocated(error)) call begin_variant_run(run, model)
    !$omp end critical (one_at_a_time)
    if (allocated(error)) return
    if (report_number(model, "summary") == 0) then
      call set_error(error, error_of_input, "the quantities are those of REPORT summary, and "// &
        "there is none")
      return
    end if
    call compute_variant(run, limits%threads, no_journal, -1, store%links, error)
    if (allocated(error)) return
    if (was_interrupted()) then
      call set_error(error, error_of_interruption, "interrupted")
      return
    end if
    call find_summary(run%results, found, places, failed)
    call find_lack(run%results, found, reason)
    if (.not. allocated(reason)) return
    call set_error(error, error_of_input, reason)
    deallocate (found)
  end subroutine evaluate

end module evaluations
