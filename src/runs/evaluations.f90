!> One set of values of a deck → its results, without outputs, files or journal: what sweeps do with
!! every variant, on any thread or rank, and what searches over values do.
module evaluations
  use available_memory, only: available_memory_t
  use cards, only: card_t
  use diagnostics, only: diagnostic_t, diagnostics_t, errors_of, has_errors
  use errors, only: error_of_input, error_of_interruption, error_t, set_error
  use interruption, only: was_interrupted
  use link_store, only: link_store_t
  use kinds, only: wp
  use models, only: model_t, report_number
  use summary_values, only: find_lack, find_summary, summary_value_t
  use task_journal, only: journal_t
  use variant_readings, only: check_variant, read_values
  use variant_runs, only: begin_variant_run, compute_variant, variant_run_t
  use variants, only: deck_cards_t
  implicit none (type, external)
  private

  public :: evaluate, compute_values, refuse_values, evaluation_store_t, evaluation_limits_t

  !> What is kept from one evaluation to the next on the same thread.
  type :: evaluation_store_t
    type(card_t), allocatable :: cards(:) !! of the last values
    type(link_store_t) :: links           !! whose own modes are known
  end type evaluation_store_t

  !> What an evaluation may use.
  type :: evaluation_limits_t
    integer :: threads = 1              !! on which it is computed
    type(available_memory_t) :: memory  !! that values are checked with
  end type evaluation_limits_t

contains

  !> The quantities of REPORT summary for any values of the VARY cards, with their errors.
  !!
  !! Errors: the values make no sound deck; nothing can be computed; a quantity is nowhere; it was
  !! interrupted.
  subroutine evaluate(deck_cards, values, limits, store, found, error)
    type(deck_cards_t), intent(in) :: deck_cards    !! without errors, with REPORT summary
    real(wp), intent(in) :: values(:)               !! (parameters) in the units of their VARY cards
    type(evaluation_limits_t), intent(in) :: limits
    type(evaluation_store_t), intent(inout) :: store !! new, or of another evaluation of this deck
    type(summary_value_t), allocatable, intent(out) :: found(:) !! (quantities) as the card has them
    type(error_t), allocatable, intent(out) :: error !! why there are none

    type(variant_run_t) :: run
    character(len=:), allocatable :: reason
    integer :: places, failed

    call compute_values(deck_cards, values, limits, .false., store, run, error)
    if (allocated(error)) return
    if (report_number(run%results%model, "summary") == 0) then
      call set_error(error, error_of_input, "the quantities are those of REPORT summary, and "// &
        "there is none")
      return
    end if
    call find_summary(run%results, found, places, failed)
    call find_lack(run%results, found, reason)
    if (.not. allocated(reason)) return
    call set_error(error, error_of_input, reason)
    deallocate (found)
  end subroutine evaluate

  !> All results for any values of the VARY cards. Several threads may call it at the same time,
  !! with stores of their own.
  !!
  !! Errors: as for `evaluate`, but for the quantities.
  subroutine compute_values(deck_cards, values, limits, is_checked, store, run, error)
    type(deck_cards_t), intent(in) :: deck_cards     !! without errors
    real(wp), intent(in) :: values(:)                !! (parameters) in the units of their cards
    type(evaluation_limits_t), intent(in) :: limits
    logical, intent(in) :: is_checked                !! the values are known to be sound
    type(evaluation_store_t), intent(inout) :: store !! new, or of another evaluation of this deck
    type(variant_run_t), intent(inout) :: run        !! new; gets the results
    type(error_t), allocatable, intent(out) :: error !! without a place

    type(model_t) :: model
    type(journal_t) :: no_journal

    ! One thread at a time makes texts: gfortran 12 keeps the lengths of such results in one place
    ! for all threads.
    !$omp critical (one_at_a_time)
    call read_sound(deck_cards, values, limits, is_checked, store, model, error)
    if (.not. allocated(error)) call begin_variant_run(run, model)
    !$omp end critical (one_at_a_time)
    if (allocated(error)) return
    call compute_variant(run, limits%threads, no_journal, -1, store%links, error)
    if (.not. allocated(error) .and. was_interrupted()) call set_error(error, &
      error_of_interruption, "interrupted")
  end subroutine compute_values

  !> Why values make no sound deck: the first of their errors in the order of the deck's lines.
  subroutine refuse_values(deck_cards, values, limits, store, error)
    type(deck_cards_t), intent(in) :: deck_cards     !! without errors
    real(wp), intent(in) :: values(:)                !! (parameters), which were refused
    type(evaluation_limits_t), intent(in) :: limits
    type(evaluation_store_t), intent(inout) :: store !! as of `compute_values`
    type(error_t), allocatable, intent(out) :: error !! the reason, without a place

    type(model_t) :: model

    call read_sound(deck_cards, values, limits, .false., store, model, error)
    ! Another process may have found less memory than this one.
    if (.not. allocated(error)) call set_error(error, error_of_input, &
      "it was refused when all variants were checked")
  end subroutine refuse_values

  !> Reads a deck with values, and checks it.
  subroutine read_sound(deck_cards, values, limits, is_checked, store, model, error)
    type(deck_cards_t), intent(in) :: deck_cards
    real(wp), intent(in) :: values(:)
    type(evaluation_limits_t), intent(in) :: limits
    logical, intent(in) :: is_checked
    type(evaluation_store_t), intent(inout) :: store
    type(model_t), intent(out) :: model
    type(error_t), allocatable, intent(out) :: error

    type(diagnostics_t) :: diagnostics
    type(diagnostic_t), allocatable :: list(:)

    call read_values(deck_cards, values, store%cards, diagnostics, model)
    if (.not. is_checked) call check_variant(model, limits%threads, limits%memory, diagnostics)
    if (.not. has_errors(diagnostics)) return
    list = errors_of(diagnostics)
    call set_error(error, list(1)%kind, list(1)%message)
  end subroutine read_sound

end module evaluations
