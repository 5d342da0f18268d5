!> How much a run computed, over all variants, and how long it took.
module run_totals
  use byte_streams, only: get_integers, get_logicals, get_reals, put_integers, put_logicals, &
    put_reals
  use kinds, only: long, wp
  use ledger, only: add_ledger, ledger_t
  use sweep_bytes, only: get_ledger, put_ledger
  use text_buffer, only: text_buffer_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: run_totals_t, totals_of, add_totals, put_totals, get_totals

  !> Sums over variants.
  type :: run_totals_t
    integer :: variants = 0                !! computed
    integer(long) :: rows = 0_long         !! positions as the variants list them
    integer(long) :: positions = 0_long    !! different ones
    integer(long) :: kinematic_solutions = 0_long !! poses sought, at positions and by studies
    integer :: speeds = 0                  !! of the first variant
    integer(long) :: motion_steps = 0_long !! of forward dynamics
    logical :: has_frequencies = .false.   !! whether any variant has
    type(ledger_t) :: counts               !! of the work on frequencies
    real(wp) :: largest_error = -1.0_wp    !! largest estimated relative error of a frequency; below
                                           !! 0: no frequency found
    real(wp) :: computing = 0.0_wp         !! studies, sum over threads [s]
    real(wp) :: writing = 0.0_wp           !! rows found and written, sum over threads [s]
  end type run_totals_t

contains

  !> Totals of one variant, without times.
  pure function totals_of(variant) result(totals)
    type(variant_results_t), intent(in) :: variant !! computed
    type(run_totals_t) :: totals

    integer :: i, k

    totals%variants = 1
    associate (found => variant%found)
      totals%rows = size(found%positions%crank)
      totals%positions = size(found%positions%states)
      totals%motion_steps = found%motion%steps
      totals%kinematic_solutions = totals%positions + found%harmonics%solutions + &
        found%sweep%counts%kinematic_solutions + merge(1, 0, found%motion%has_begun)
      if (allocated(found%geometry%crank)) totals%kinematic_solutions = &
        totals%kinematic_solutions + size(found%geometry%crank)
      totals%has_frequencies = allocated(found%sweep%results)
      if (.not. totals%has_frequencies) return
      totals%speeds = size(found%sweep%request%speed)
      totals%counts = found%sweep%counts
      do i = 1, size(found%sweep%results)
        associate (result => found%sweep%results(i))
          if (.not. allocated(result%outcome)) cycle
          do k = 1, size(result%outcome)
            if (.not. allocated(result%outcome(k)%error)) totals%largest_error = &
              max(totals%largest_error, maxval(result%error(:, k)))
          end do
        end associate
      end do
    end associate
  end function totals_of

  !> Adds totals of further variants.
  pure subroutine add_totals(totals, more)
    type(run_totals_t), intent(inout) :: totals !! of the variants before
    type(run_totals_t), intent(in) :: more      !! of the variants that follow

    if (totals%variants == 0) totals%speeds = more%speeds
    totals%variants = totals%variants + more%variants
    totals%rows = totals%rows + more%rows
    totals%positions = totals%positions + more%positions
    totals%kinematic_solutions = totals%kinematic_solutions + more%kinematic_solutions
    totals%motion_steps = totals%motion_steps + more%motion_steps
    totals%has_frequencies = totals%has_frequencies .or. more%has_frequencies
    call add_ledger(totals%counts, more%counts)
    totals%largest_error = max(totals%largest_error, more%largest_error)
    totals%computing = totals%computing + more%computing
    totals%writing = totals%writing + more%writing
  end subroutine add_totals

  !> Appends totals to a buffer as bytes, without times: a resumed run has not spent them.
  pure subroutine put_totals(buffer, totals)
    type(text_buffer_t), intent(inout) :: buffer !! bytes, to be read by `get_totals`
    type(run_totals_t), intent(in) :: totals     !! of one variant or more

    call put_integers(buffer, [totals%variants, totals%speeds])
    call put_integers(buffer, transfer([totals%rows, totals%positions, &
      totals%kinematic_solutions, totals%motion_steps], [0]))
    call put_logicals(buffer, [totals%has_frequencies])
    call put_ledger(buffer, totals%counts)
    call put_reals(buffer, [totals%largest_error])
  end subroutine put_totals

  !> Reads what `put_totals` wrote.
  pure subroutine get_totals(bytes, at, totals)
    character(len=*), intent(in) :: bytes     !! of `put_totals`, among others
    integer, intent(inout) :: at              !! place of the first byte; on return, behind the last
    type(run_totals_t), intent(out) :: totals !! with times of 0

    integer(long) :: counts(4)
    integer :: numbers(2), words(size(transfer([0_long, 0_long, 0_long, 0_long], [0])))
    logical :: has_frequencies(1)
    real(wp) :: largest_error(1)

    call get_integers(bytes, at, numbers)
    call get_integers(bytes, at, words)
    counts = transfer(words, counts)
    call get_logicals(bytes, at, has_frequencies)
    call get_ledger(bytes, at, totals%counts)
    call get_reals(bytes, at, largest_error)
    totals%variants = numbers(1)
    totals%speeds = numbers(2)
    totals%rows = counts(1)
    totals%positions = counts(2)
    totals%kinematic_solutions = counts(3)
    totals%motion_steps = counts(4)
    totals%has_frequencies = has_frequencies(1)
    totals%largest_error = largest_error(1)
  end subroutine get_totals

end module run_totals
