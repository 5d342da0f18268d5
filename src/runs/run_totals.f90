!> How much a run computed, over all variants, between which limits the results are, and how long it
!! took.
module run_totals
  use byte_streams, only: get_integers, get_logicals, get_reals, put_integers, put_logicals, &
    put_reals
  use kinds, only: long, wp
  use ledger, only: add_ledger, ledger_t
  use sweep_bytes, only: get_ledger, put_ledger
  use text_buffer, only: text_buffer_t
  implicit none (type, external)
  private

  public :: run_totals_t, add_totals, put_totals, get_totals, range_t, widen, is_empty

  !> From the least to the greatest of some values; the other way round if there is none.
  type :: range_t
    real(wp) :: least = huge(1.0_wp)
    real(wp) :: most = -huge(1.0_wp)
  end type range_t

  !> Sums over variants.
  type :: run_totals_t
    integer :: variants = 0                !! computed, or failed as a whole
    integer(long) :: rows = 0_long         !! positions as the variants list them
    integer(long) :: positions = 0_long    !! different ones
    integer(long) :: kinematic_solutions = 0_long !! poses sought, at positions and by studies
    integer :: speeds = 0                  !! of the first variant that was computed
    integer(long) :: motion_steps = 0_long !! of forward dynamics
    logical :: has_frequencies = .false.   !! whether any variant has
    type(ledger_t) :: counts               !! of the work on frequencies
    real(wp) :: largest_error = -1.0_wp    !! largest estimated relative error of a frequency; below
                                           !! 0: no frequency found
    type(range_t) :: lowest                !! the first frequency of every position and speed [Hz]
    type(range_t) :: highest               !! the last one [Hz]
    type(range_t) :: torque                !! driving torque, of REPORT reactions or balance
                                           !! [N m]
    integer(long) :: response_speeds = 0_long !! at which an elastic response was sought
    integer(long) :: applications = 0_long !! of its equation
    real(wp) :: strain = -1.0_wp           !! largest of the elastic response; below 0: not sought
    real(wp) :: displacement = -1.0_wp     !! largest of REPORT response [m]; likewise
    real(wp) :: computing = 0.0_wp         !! studies, sum over threads [s]
    real(wp) :: writing = 0.0_wp           !! rows found and written, sum over threads [s]
  end type run_totals_t

contains

  !> Takes a value into a range.
  pure subroutine widen(range, value)
    type(range_t), intent(inout) :: range !! on return with the value
    real(wp), intent(in) :: value         !! to take in

    range%least = min(range%least, value)
    range%most = max(range%most, value)
  end subroutine widen

  !> The range of two ranges.
  pure subroutine join_ranges(range, more)
    type(range_t), intent(inout) :: range
    type(range_t), intent(in) :: more

    range%least = min(range%least, more%least)
    range%most = max(range%most, more%most)
  end subroutine join_ranges

  !> Whether a range has no value.
  pure function is_empty(range) result(is)
    type(range_t), intent(in) :: range !! of any values
    logical :: is

    is = range%least > range%most
  end function is_empty

  !> Adds totals of further variants.
  pure subroutine add_totals(totals, more)
    type(run_totals_t), intent(inout) :: totals !! of the variants before
    type(run_totals_t), intent(in) :: more      !! of the variants that follow

    ! Variants that failed as a whole have none.
    if (totals%speeds == 0) totals%speeds = more%speeds
    totals%variants = totals%variants + more%variants
    totals%rows = totals%rows + more%rows
    totals%positions = totals%positions + more%positions
    totals%kinematic_solutions = totals%kinematic_solutions + more%kinematic_solutions
    totals%motion_steps = totals%motion_steps + more%motion_steps
    totals%has_frequencies = totals%has_frequencies .or. more%has_frequencies
    call add_ledger(totals%counts, more%counts)
    totals%largest_error = max(totals%largest_error, more%largest_error)
    call join_ranges(totals%lowest, more%lowest)
    call join_ranges(totals%highest, more%highest)
    call join_ranges(totals%torque, more%torque)
    totals%response_speeds = totals%response_speeds + more%response_speeds
    totals%applications = totals%applications + more%applications
    totals%strain = max(totals%strain, more%strain)
    totals%displacement = max(totals%displacement, more%displacement)
    totals%computing = totals%computing + more%computing
    totals%writing = totals%writing + more%writing
  end subroutine add_totals

  !> Appends totals to a buffer as bytes, without times: a resumed run has not spent them.
  pure subroutine put_totals(buffer, totals)
    type(text_buffer_t), intent(inout) :: buffer !! bytes, to be read by `get_totals`
    type(run_totals_t), intent(in) :: totals     !! of one variant or more

    call put_integers(buffer, [totals%variants, totals%speeds])
    call put_integers(buffer, transfer([totals%rows, totals%positions, &
      totals%kinematic_solutions, totals%motion_steps, totals%response_speeds, &
      totals%applications], [0]))
    call put_logicals(buffer, [totals%has_frequencies])
    call put_ledger(buffer, totals%counts)
    call put_reals(buffer, [totals%largest_error, totals%lowest%least, totals%lowest%most, &
      totals%highest%least, totals%highest%most, totals%torque%least, totals%torque%most, &
      totals%strain, totals%displacement])
  end subroutine put_totals

  !> Reads what `put_totals` wrote.
  pure subroutine get_totals(bytes, at, totals)
    character(len=*), intent(in) :: bytes     !! of `put_totals`, among others
    integer, intent(inout) :: at              !! place of the first byte; on return, after the last
    type(run_totals_t), intent(out) :: totals !! with times of 0

    integer(long) :: counts(6)
    integer :: numbers(2), words(size(transfer(spread(0_long, 1, 6), [0])))
    logical :: has_frequencies(1)
    real(wp) :: reals(9)

    call get_integers(bytes, at, numbers)
    call get_integers(bytes, at, words)
    counts = transfer(words, counts)
    call get_logicals(bytes, at, has_frequencies)
    call get_ledger(bytes, at, totals%counts)
    call get_reals(bytes, at, reals)
    totals%variants = numbers(1)
    totals%speeds = numbers(2)
    totals%rows = counts(1)
    totals%positions = counts(2)
    totals%kinematic_solutions = counts(3)
    totals%motion_steps = counts(4)
    totals%response_speeds = counts(5)
    totals%applications = counts(6)
    totals%has_frequencies = has_frequencies(1)
    totals%largest_error = reals(1)
    totals%lowest = range_t(reals(2), reals(3))
    totals%highest = range_t(reals(4), reals(5))
    totals%torque = range_t(reals(6), reals(7))
    totals%strain = reals(8)
    totals%displacement = reals(9)
  end subroutine get_totals

end module run_totals
