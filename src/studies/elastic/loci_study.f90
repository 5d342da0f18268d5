!> The rows of each frequency locus, a mode followed over positions by its shape.
module loci_study
  use frequency_loci, only: event_ambiguous, event_crossing, event_none, event_start, &
    event_veering, follow_loci, loci_t
  use kinds, only: wp
  use position_results, only: frequency_of
  use positions, only: positions_t
  use sorting, only: ascending_order
  use sweeps, only: has_result, sweep_t
  implicit none (type, external)
  private

  public :: loci_t, locus_row_t, follow_loci, rows_of_locus, failed_rows, is_empty
  public :: event_none, event_start, event_crossing, event_veering, event_ambiguous

  !> A locus at one position, or a gap in it.
  type :: locus_row_t
    logical :: is_broken = .false.   !! a gap: the curve is interrupted, no other component is set
    integer :: position = 0          !! number in the deck's list
    integer :: mode = 0              !! number of the frequency at this position, lowest first
    real(wp) :: frequency = 0.0_wp   !! [Hz]
    real(wp) :: mac = 0.0_wp         !! modal assurance criterion with the row before, 0 to 1 [-]
    integer :: event = event_none    !! one of `event_none` to `event_ambiguous`
    integer :: partner = 0           !! other locus of a crossing or veering; 0: none
  end type locus_row_t

contains

  !> Whether a locus has no position at a speed.
  pure function is_empty(loci, locus, speed)
    type(loci_t), intent(in) :: loci    !! of all modes
    integer, intent(in) :: locus, speed !! numbers
    logical :: is_empty

    is_empty = all(loci%locus(:, :, speed) /= locus)
  end function is_empty

  !> The rows of a locus at a speed, in the order of crank angles. Failed positions between two rows
  !! become one gap.
  pure function rows_of_locus(positions, sweep, loci, locus, speed) result(rows)
    type(positions_t), intent(in) :: positions !! of the run
    type(sweep_t), intent(in) :: sweep         !! over these positions
    type(loci_t), intent(in) :: loci           !! of this sweep
    integer, intent(in) :: locus, speed        !! numbers; the locus is not empty at this speed
    type(locus_row_t), allocatable :: rows(:)

    type(locus_row_t) :: list(size(positions%crank))
    integer :: order(size(positions%crank)), i, n, first, last
    logical :: is_on(size(positions%crank)), broken

    order = ascending_order(positions%crank)
    is_on = [(any(loci%locus(:, order(i), speed) == locus), i=1, size(order))]
    first = findloc(is_on, .true., dim=1)
    last = findloc(is_on, .true., dim=1, back=.true.)
    broken = .false.
    n = 0
    do i = first, last
      if (has_result(positions, sweep, positions%state(order(i)), speed)) then
        n = n + 1
        broken = .false.
        list(n) = row_at(positions, sweep, loci, locus, speed, order(i))
      else if (.not. broken) then
        n = n + 1
        broken = .true.
        list(n)%is_broken = .true.
      end if
    end do
    rows = list(:n)
  end function rows_of_locus

  pure function row_at(positions, sweep, loci, locus, speed, position) result(row)
    type(positions_t), intent(in) :: positions
    type(sweep_t), intent(in) :: sweep
    type(loci_t), intent(in) :: loci
    integer, intent(in) :: locus, speed, position
    type(locus_row_t) :: row

    row%position = position
    row%mode = findloc(loci%locus(:, position, speed), locus, dim=1)
    row%frequency = frequency_of(sweep%results(positions%state(position))%lambda(row%mode, speed))
    row%mac = loci%mac(row%mode, position, speed)
    row%event = loci%event(row%mode, position, speed)
    row%partner = loci%partner(row%mode, position, speed)
  end function row_at

  !> The positions without a result at a speed, in the order of crank angles.
  pure function failed_rows(positions, sweep, speed) result(failed)
    type(positions_t), intent(in) :: positions !! of the run
    type(sweep_t), intent(in) :: sweep         !! over these positions
    integer, intent(in) :: speed               !! number
    integer, allocatable :: failed(:)          !! numbers in the deck's list

    integer :: i

    failed = ascending_order(positions%crank)
    failed = pack(failed, [(.not. has_result(positions, sweep, positions%state(failed(i)), speed), &
      i=1, size(failed))])
  end function failed_rows

end module loci_study
