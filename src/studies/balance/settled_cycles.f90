!> Cycles of the crank, sampled so closely that more samples do not change the harmonics.
module settled_cycles
  use crank_cycle, only: cycle_t, cycle_values, find_parts, quantity_count, usual_values
  use errors, only: outcome_t
  use harmonics, only: spectrum_of, spectrum_t
  use interruption, only: was_interrupted
  use kinds, only: fineness, wp
  use linkages, only: linkage_t
  use load_cases, only: case_count
  implicit none (type, external)
  private

  public :: find_settled_cycles, least_share

  integer, parameter :: fewest_samples = 64, most_samples = 65536

  !> Quantities balanced to less than this share of their usual value are judged relative to this
  !! share, for the rest may be rounding only.
  real(wp), parameter :: least_share = 1.0e-3_wp

contains

  !> Doubles the number of samples of a cycle until harmonics, mean and rms of all quantities have
  !! converged: with every second sample they are the same to 1e-13 of the largest value. It ends at
  !! 65,536 samples a turn. A cycle without values at a sample has an error.
  !!
  !! Harmonics converge like a geometric series, the slower the nearer the crank passes a dead
  !! point. The error with all samples is about the square of the error with half of them. Many
  !! speeds next to a dead point take minutes; an interrupted run returns what it has.
  subroutine find_settled_cycles(linkages, elements, speed, acceleration, threads, turns, change, &
      period)
    type(linkage_t), intent(in) :: linkages(:) !! (linkages) with the same motion but different
                                               !! masses; the crank turns freely
    integer, intent(in) :: elements(:)         !! (bodies) on whose nodes the masses are lumped; 0:
                                               !! distributed
    real(wp), intent(in) :: speed(:)           !! (speeds) ω2 [rad/s]
    real(wp), intent(in) :: acceleration       !! α2 [rad/s²]
    integer, intent(in) :: threads             !! number of OpenMP threads
    type(cycle_t), intent(out) :: turns(:)     !! (linkages)
    real(wp), intent(out) :: change            !! difference to the results from every second
                                               !! sample, relative to the largest value [-]
    real(wp), intent(in), optional :: period   !! of positions and loads, whole turns [deg]; then
                                               !! with loads that depend on the speed; absent: a
                                               !! turn, without these

    real(wp), parameter :: settled = 1.0e-13_wp*fineness
    real(wp), allocatable :: running(:)
    real(wp) :: enough
    integer :: samples, most, i

    running = pack(speed, spread(present(period), 1, size(speed)))
    if (present(period)) turns%period = period
    samples = fewest_samples
    ! A power of two times the samples of all turns keeps those that there are already.
    if (present(period)) samples = samples*max(1, nint(period/360.0_wp))
    most = samples*(most_samples/fewest_samples)
    change = 0.0_wp
    do
      do i = 1, size(linkages)
        call sample_cycle(linkages(i), elements, running, acceleration, samples, threads, turns(i))
        if (allocated(turns(i)%error)) return
      end do
      ! One speed that needs more samples is enough to take them, and the other speeds are skipped.
      ! With the largest number of samples none is skipped, for that change is the result.
      enough = merge(settled, huge(enough), samples < most)
      change = largest_change(linkages, elements, turns, speed, acceleration, enough, threads)
      if (change <= settled .or. samples >= most .or. was_interrupted()) exit
      samples = 2*samples
    end do
  end subroutine find_settled_cycles

  !> Samples a cycle evenly, from the crank angle 0. One that already has half as many samples
  !! keeps them as every second one.
  subroutine sample_cycle(linkage, elements, speed, acceleration, samples, threads, turn)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: elements(:)
    real(wp), intent(in) :: speed(:) !! (speeds) for loads that depend on it; none: without these
    real(wp), intent(in) :: acceleration
    integer, intent(in) :: samples, threads
    type(cycle_t), intent(inout) :: turn

    type(outcome_t) :: outcome(samples)
    real(wp), allocatable :: part(:, :, :), running(:, :)
    integer :: i, step

    allocate (part(4, case_count, samples), running(size(speed), samples))
    step = 1
    if (allocated(turn%part)) then
      step = 2
      part(:, :, 1::2) = turn%part
      running(:, 1::2) = turn%running
    end if
    !$omp parallel do num_threads(threads) schedule(dynamic, 8) default(shared) private(i)
    do i = step, samples, step
      call find_parts(linkage, elements, turn%period*real(i - 1, wp)/samples, speed, acceleration, &
        part(:, :, i), running(:, i), outcome(i)%error)
    end do
    !$omp end parallel do
    call move_alloc(part, turn%part)
    call move_alloc(running, turn%running)
    if (size(speed) == 0) return
    do i = step, samples, step
      if (.not. allocated(outcome(i)%error)) cycle
      turn%error = outcome(i)%error
      turn%error_crank = turn%period*real(i - 1, wp)/samples
      return
    end do
  end subroutine sample_cycle

  !> The greatest difference, over all speeds, between the spectra of all samples and of every
  !! second one, relative to the largest value of each quantity. Once a difference is above `enough`
  !! the remaining speeds are skipped.
  function largest_change(linkages, elements, turns, speed, acceleration, enough, threads) &
    result(change)
    type(linkage_t), intent(in) :: linkages(:)
    integer, intent(in) :: elements(:)
    type(cycle_t), intent(in) :: turns(:)
    real(wp), intent(in) :: speed(:), acceleration
    real(wp), intent(in) :: enough !! [-]
    integer, intent(in) :: threads
    real(wp) :: change

    real(wp) :: mine
    integer :: i, k
    logical :: over, is_enough

    change = 0.0_wp
    is_enough = .false.
    !$omp parallel do collapse(2) num_threads(threads) schedule(dynamic) default(shared) &
    !$omp   private(i, k, mine, over) reduction(max: change)
    do k = 1, size(speed)
      do i = 1, size(turns)
        !$omp atomic read
        over = is_enough
        if (over .or. was_interrupted()) cycle
        mine = change_at(linkages, elements, turns, i, speed(k), acceleration, k)
        change = max(change, mine)
        if (mine > enough) then
          !$omp atomic write
          is_enough = .true.
        end if
      end do
    end do
    !$omp end parallel do
  end function largest_change

  !> The difference of one cycle at one speed, relative to the largest values of all of them.
  function change_at(linkages, elements, turns, number, speed, acceleration, speed_number) &
    result(change)
    type(linkage_t), intent(in) :: linkages(:)
    integer, intent(in) :: elements(:)
    type(cycle_t), intent(in) :: turns(:)
    integer, intent(in) :: number !! of the cycle
    real(wp), intent(in) :: speed, acceleration
    integer, intent(in) :: speed_number
    real(wp) :: change

    real(wp), allocatable :: values(:, :)
    real(wp) :: largest(quantity_count), difference(quantity_count)
    integer :: i, q

    largest = least_share*usual_values(linkages(1), elements, speed, acceleration)
    difference = 0.0_wp
    do i = 1, size(turns)
      values = cycle_values(turns(i), speed, acceleration, speed_number)
      largest = max(largest, maxval(abs(values), dim=1))
      if (i /= number) cycle
      do q = 1, quantity_count
        difference(q) = distance(spectrum_of(values(:, q)), spectrum_of(values(::2, q)))
      end do
    end do
    ! Quantities that are zero throughout have no difference.
    change = maxval(difference/max(largest, tiny(largest)))
  end function change_at

  !> The greatest difference between two spectra: mean, rms, harmonics.
  pure function distance(a, b)
    type(spectrum_t), intent(in) :: a, b
    real(wp) :: distance

    distance = max(abs(a%mean - b%mean), abs(a%rms - b%rms), &
      maxval(abs(a%coefficient - b%coefficient)))
  end function distance

end module settled_cycles
