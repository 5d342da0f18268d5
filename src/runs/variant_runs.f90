!> One variant of a deck computed; a deck without VARY has just one.
module variant_runs
  use errors, only: error_t
  use frequency_loci, only: branches_t, follow_branches
  use frequency_study, only: run_sweep
  use interruption, only: was_interrupted
  use kinds, only: long, wp
  use ledger, only: add_ledger, ledger_t
  use link_store, only: link_store_t
  use mechanisms, only: mechanism_t, new_mechanism
  use models, only: model_t, needs_frequencies, needs_positions
  use motion_study, only: has_motion, motion_run_t, run_motion
  use positions, only: find_positions, positions_t
  use progress, only: progress_t
  use run_findings, only: find_failures, find_motion_failure, find_warnings, findings_t
  use sweep_journal, only: journal_t
  use sweeps, only: sweep_t
  implicit none (type, external)
  private

  public :: variant_run_t, run_totals_t, run_variant, prepare_variant, solve_variant, &
    finish_variant, totals_of, add_totals

  !> What was computed. Empty parts were not asked for.
  type :: variant_run_t
    type(model_t) :: model
    type(mechanism_t) :: mechanism
    type(positions_t) :: positions
    type(sweep_t) :: sweep
    type(branches_t) :: branches
    type(motion_run_t) :: motion
    type(findings_t) :: findings
  end type variant_run_t

  !> How much was computed, over all variants.
  type :: run_totals_t
    integer :: variants = 0
    integer(long) :: rows = 0_long      !! positions as the decks list them
    integer(long) :: positions = 0_long !! different ones
    integer :: speeds = 0               !! of the first variant
    integer(long) :: motion_steps = 0_long !! of forward motions
    logical :: has_frequencies = .false.
    type(ledger_t) :: counts
    real(wp) :: largest_error = -1.0_wp !! relative, of any frequency found; below 0 there is none
  end type run_totals_t

contains

  !> Computes what a model asks for. Errors: the models of its links could not be made.
  subroutine run_variant(number, threads, progress, journal, store, run, error)
    integer, intent(in) :: number !! of the variant, from 1
    integer, intent(in) :: threads
    type(progress_t), intent(inout) :: progress
    type(journal_t), intent(inout) :: journal
    type(link_store_t), intent(inout) :: store
    type(variant_run_t), intent(inout) :: run !! with its model
    type(error_t), allocatable, intent(out) :: error

    call prepare_variant(run)
    call solve_variant(number, threads, progress, journal, store, run, error)
    if (.not. allocated(error) .and. .not. was_interrupted()) call finish_variant(run)
  end subroutine run_variant

  !> Mechanism and motion.
  subroutine prepare_variant(run)
    type(variant_run_t), intent(inout) :: run !! with its model

    run%mechanism = new_mechanism(run%model)
    ! Crank angles that no report asks about cannot fail.
    if (needs_positions(run%model)) then
      run%positions = find_positions(run%mechanism%linkage, run%model%crank%value)
    else
      run%positions = find_positions(run%mechanism%linkage, [real(wp) ::])
    end if
  end subroutine prepare_variant

  !> Forward motion and frequencies, nearly all of the work. Variants may be solved at the same
  !! time: here are no texts, which gfortran 12 gives lengths that all threads share. Errors: as
  !! above.
  subroutine solve_variant(number, threads, progress, journal, store, run, error)
    integer, intent(in) :: number !! of the variant, from 1
    integer, intent(in) :: threads
    type(progress_t), intent(inout) :: progress
    type(journal_t), intent(inout) :: journal
    type(link_store_t), intent(inout) :: store
    type(variant_run_t), intent(inout) :: run !! prepared
    type(error_t), allocatable, intent(out) :: error

    call run_motion(run%model, run%mechanism, progress, run%motion)
    if (.not. needs_frequencies(run%model)) return
    call run_sweep(run%model, run%mechanism, run%positions, threads, progress, journal, number, &
      store, run%sweep, error)
  end subroutine solve_variant

  !> Branches, failed rows and warnings.
  subroutine finish_variant(run)
    type(variant_run_t), intent(inout) :: run !! solved

    if (needs_frequencies(run%model)) then
      if (run%sweep%request%follow) call follow_branches(run%mechanism%linkage, run%positions, &
        run%sweep, run%branches)
    end if
    call find_failures(run%model, run%positions, run%sweep, run%findings)
    if (has_motion(run%motion)) call find_motion_failure(run%model, run%motion, run%findings)
    call find_warnings(run%model, run%mechanism, run%positions, run%sweep, run%findings)
  end subroutine finish_variant

  pure function totals_of(run) result(totals)
    type(variant_run_t), intent(in) :: run
    type(run_totals_t) :: totals

    integer :: i, k

    totals%variants = 1
    totals%rows = size(run%positions%crank)
    totals%positions = size(run%positions%states)
    totals%motion_steps = run%motion%steps
    totals%has_frequencies = allocated(run%sweep%results)
    if (.not. totals%has_frequencies) return
    totals%speeds = size(run%sweep%request%speed)
    totals%counts = run%sweep%counts
    do i = 1, size(run%sweep%results)
      associate (result => run%sweep%results(i))
        if (.not. allocated(result%failure)) cycle
        do k = 1, size(result%failure)
          if (len(result%failure(k)%text) == 0) totals%largest_error = max(totals%largest_error, &
            maxval(result%error(:, k)))
        end do
      end associate
    end do
  end function totals_of

  !> Adds the totals of variants to those of others before them.
  pure subroutine add_totals(totals, more)
    type(run_totals_t), intent(inout) :: totals
    type(run_totals_t), intent(in) :: more

    if (totals%variants == 0) totals%speeds = more%speeds
    totals%variants = totals%variants + more%variants
    totals%rows = totals%rows + more%rows
    totals%positions = totals%positions + more%positions
    totals%motion_steps = totals%motion_steps + more%motion_steps
    totals%has_frequencies = totals%has_frequencies .or. more%has_frequencies
    call add_ledger(totals%counts, more%counts)
    totals%largest_error = max(totals%largest_error, more%largest_error)
  end subroutine add_totals

end module variant_runs
