!> How much a run computed, over all variants, between which limits the results are, and how long it
!! took.
module run_totals
  use byte_streams, only: byte_stream_t
  use kinds, only: long, wp
  use ledger, only: add_ledger, ledger_t
  use sweep_bytes, only: pass_ledger
  implicit none (type, external)
  private

  public :: run_totals_t, add_totals, pass_totals, value_range_t, widen, is_empty

  !> From the least to the greatest of some values; the other way round if there is none.
  type :: value_range_t
    real(wp) :: least = huge(1.0_wp)
    real(wp) :: most = -huge(1.0_wp)
  end type value_range_t

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
    type(value_range_t) :: lowest          !! the first frequency of every position and speed [Hz]
    type(value_range_t) :: highest         !! the last one [Hz]
    type(value_range_t) :: torque          !! driving torque, of REPORT reactions or balance
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
    type(value_range_t), intent(inout) :: range !! on return with the value
    real(wp), intent(in) :: value         !! to take in

    range%least = min(range%least, value)
    range%most = max(range%most, value)
  end subroutine widen

  !> The range of two ranges.
  pure subroutine join_ranges(range, more)
    type(value_range_t), intent(inout) :: range
    type(value_range_t), intent(in) :: more

    range%least = min(range%least, more%least)
    range%most = max(range%most, more%most)
  end subroutine join_ranges

  !> Whether a range has no value.
  pure function is_empty(range) result(is)
    type(value_range_t), intent(in) :: range !! of any values
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

  !> Passes totals but for times: a resumed run has not spent them.
  pure subroutine pass_totals(stream, totals)
    type(byte_stream_t), intent(inout) :: stream
    type(run_totals_t), intent(inout) :: totals !! of one variant or more; new if they are read

    call stream%pass(totals%variants)
    call stream%pass(totals%rows)
    call stream%pass(totals%positions)
    call stream%pass(totals%kinematic_solutions)
    call stream%pass(totals%speeds)
    call stream%pass(totals%motion_steps)
    call stream%pass(totals%has_frequencies)
    call pass_ledger(stream, totals%counts)
    call stream%pass(totals%largest_error)
    call pass_range(stream, totals%lowest)
    call pass_range(stream, totals%highest)
    call pass_range(stream, totals%torque)
    call stream%pass(totals%response_speeds)
    call stream%pass(totals%applications)
    call stream%pass(totals%strain)
    call stream%pass(totals%displacement)
  end subroutine pass_totals

  pure subroutine pass_range(stream, range)
    type(byte_stream_t), intent(inout) :: stream
    type(value_range_t), intent(inout) :: range

    call stream%pass(range%least)
    call stream%pass(range%most)
  end subroutine pass_range

end module run_totals
