!> Harmonics of the shaking force, the shaking moment and the driving torque of a linkage over a
!! cycle of the crank, as given and, where there are any, with counterweights.
module harmonics_study
  use load_tables, only: load_period
  use balanced_linkages, only: balanced_linkage, counterweight_t
  use constants, only: degree
  use counterweights, only: find_counterweights
  use errors, only: error_t
  use crank_cycle, only: cycle_t, cycle_values, drive_torque, find_largest_value, quantity_count, &
    quantity_names, shaking_moment, usual_values
  use four_bar_loops, only: is_plain
  use full_turns, only: turns_fully
  use harmonics, only: highest_harmonic, spectrum_of, spectrum_t
  use hung_counterweights, only: find_hung_counterweights, obstacle_t
  use interruption, only: was_interrupted
  use kinds, only: wp
  use linkage_paths, only: period_of
  use linkages, only: linkage_t
  use settled_cycles, only: find_settled_cycles, least_share
  implicit none (type, external)
  private

  public :: harmonics_result_t, harmonic_t, find_harmonics, quantity_count, quantity_names, &
    highest_harmonic, is_moment, has_settled, find_cancelling_weights

  !> A quantity over a cycle of n turns: mean + Σ amplitude cos(k θ2/n + phase), all in [N] or [N m]
  !! but phases.
  type :: harmonic_t
    real(wp) :: largest = 0.0_wp !! absolute value, also between the samples
    real(wp) :: rms = 0.0_wp     !! root mean square
    real(wp) :: mean = 0.0_wp
    real(wp) :: amplitude(highest_harmonic) = 0.0_wp
    real(wp) :: phase(highest_harmonic) = 0.0_wp !! 0 where the amplitude is only rounding [deg]
  end type harmonic_t

  type :: harmonics_result_t
    logical :: has_cycle = .false. !! else the crank does not turn fully, and all that follows is
                                   !! empty
    integer :: turns = 0           !! of the crank, after which positions and loads repeat; 0: they
                                   !! do not, and all that follows is empty
    type(error_t), allocatable :: error !! why all that follows is empty: a position beyond the ends
                                   !! of a table, or locked by friction
    real(wp) :: error_crank = 0.0_wp !! where [deg]
    integer :: samples = 0         !! of the cycle
    integer :: solutions = 0       !! poses found, for samples and largest values
    real(wp) :: change = 0.0_wp    !! difference to the results from every second sample, relative
                                   !! to the largest value [-]
    type(harmonic_t), allocatable :: of(:, :, :) !! (quantities; as given and, where there are
                                                 !! counterweights, balanced; speeds)
  end type harmonics_result_t

  !> The phase of a harmonic below this share of the usual value is only rounding.
  real(wp), parameter :: unknown_phase = 1.0e-12_wp

  !> Harmonics have settled if doubling the number of samples changes them by no more than this:
  !! rounding changes them by less [-].
  real(wp), parameter :: unsettled = 1.0e-10_wp

contains

  !> Harmonics at every speed, the torque with all loads, over as many turns as positions and loads
  !! take to repeat. An interrupted run returns incomplete results: too few samples, or
  !! largest values of 0.
  subroutine find_harmonics(linkage, elements, speed, acceleration, threads, found, balanced)
    type(linkage_t), intent(in) :: linkage !! of any kind, without counterweights
    integer, intent(in) :: elements(:)     !! (bodies) on whose nodes the masses are lumped; 0:
                                           !! distributed
    real(wp), intent(in) :: speed(:)       !! (speeds) ω2, constant over the cycle [rad/s]
    real(wp), intent(in) :: acceleration   !! α2, constant over the cycle [rad/s²]
    integer, intent(in) :: threads         !! number of OpenMP threads
    type(harmonics_result_t), intent(out) :: found !! empty if the crank does not turn fully
    type(linkage_t), intent(in), optional :: balanced !! absent: with counterweights that cancel the
                                                   !! shaking force

    type(linkage_t), allocatable :: linkages(:)
    type(cycle_t), allocatable :: turns(:)
    real(wp), allocatable :: largest(:, :, :) !! (quantities, linkages, speeds)
    real(wp) :: period
    integer :: solutions, i, k, q

    found%has_cycle = turns_fully(linkage, through=.true.)
    if (.not. found%has_cycle) return
    period = load_period(linkage, period_of(linkage))
    found%turns = nint(period/360.0_wp)
    if (found%turns == 0) return
    if (present(balanced)) then
      allocate (linkages(2))
      linkages(1) = linkage
      linkages(2) = balanced
    else
      call balance_linkage(linkage, elements, linkages)
    end if
    allocate (turns(size(linkages)))
    call find_settled_cycles(linkages, elements, speed, acceleration, threads, turns, &
      found%change, period)
    do i = 1, size(turns)
      if (.not. allocated(turns(i)%error)) cycle
      found%error = turns(i)%error
      found%error_crank = turns(i)%error_crank
      return
    end do
    found%samples = size(turns(1)%part, 3)
    allocate (found%of(quantity_count, size(turns), size(speed)), largest(quantity_count, &
      size(turns), size(speed)))
    largest = 0.0_wp
    ! Two more have shown that the crank turns.
    found%solutions = 2 + size(turns)*found%samples
    !$omp parallel do collapse(3) num_threads(threads) schedule(dynamic) default(shared) &
    !$omp   private(i, k, q, solutions)
    do k = 1, size(speed)
      do i = 1, size(linkages)
        do q = 1, quantity_count
          if (was_interrupted()) cycle
          call find_largest_value(linkages(i), elements, turns(i), q, speed(k), acceleration, &
            largest(q, i, k), solutions, k)
          !$omp atomic
          found%solutions = found%solutions + solutions
        end do
      end do
    end do
    !$omp end parallel do
    !$omp parallel do collapse(2) num_threads(threads) schedule(dynamic) default(shared) &
    !$omp   private(i, k)
    do k = 1, size(speed)
      do i = 1, size(linkages)
        if (.not. was_interrupted()) &
          call find_spectra(turns(i), speed(k), acceleration, k, largest(:, i, k), &
            max(maxval(largest(:, :, k), dim=2), least_share*usual_values(linkages(1), &
            elements, speed(k), acceleration)), found%of(:, i, k))
      end do
    end do
    !$omp end parallel do
  end subroutine find_harmonics

  !> The linkage as given and, where there are counterweights in closed form, balanced.
  pure subroutine balance_linkage(linkage, elements, linkages)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: elements(:)
    type(linkage_t), allocatable, intent(out) :: linkages(:)

    type(counterweight_t), allocatable :: weights(:)
    type(obstacle_t) :: obstacle

    call find_cancelling_weights(linkage, elements, weights, obstacle)
    allocate (linkages(merge(2, 1, size(weights) > 0)))
    linkages(1) = linkage
    if (size(linkages) > 1) linkages(2) = balanced_linkage(linkage, weights)
  end subroutine balance_linkage

  !> Counterweights that cancel the shaking force: of a four-bar as Berkof and Lowen 1969 have them,
  !! see `counterweights`; where links hang on each other without a loop, see `hung_counterweights`.
  pure subroutine find_cancelling_weights(linkage, elements, weights, obstacle)
    type(linkage_t), intent(in) :: linkage                       !! of any kind, without them
    integer, intent(in) :: elements(:)                           !! (bodies) as of `find_harmonics`
    type(counterweight_t), allocatable, intent(out) :: weights(:) !! none where there is an obstacle
    type(obstacle_t), intent(out) :: obstacle                    !! why there are none

    if (is_plain(linkage)) then
      weights = find_counterweights(linkage, elements)
    else
      call find_hung_counterweights(linkage, elements, weights, obstacle)
    end if
  end subroutine find_cancelling_weights

  !> Harmonics of all quantities of a linkage at one speed.
  pure subroutine find_spectra(turn, speed, acceleration, number, largest, measure, found)
    type(cycle_t), intent(in) :: turn
    real(wp), intent(in) :: speed            !! ω2 [rad/s]
    real(wp), intent(in) :: acceleration     !! α2 [rad/s²]
    integer, intent(in) :: number            !! of the speed
    real(wp), intent(in) :: largest(:)       !! (quantities) absolute values [N, N m]
    real(wp), intent(in) :: measure(:)       !! (quantities) usual value, with which harmonics are
                                             !! compared [N, N m]
    type(harmonic_t), intent(out) :: found(:) !! (quantities)

    real(wp), allocatable :: values(:, :)
    type(spectrum_t) :: spectrum
    integer :: q

    values = cycle_values(turn, speed, acceleration, number)
    do q = 1, quantity_count
      spectrum = spectrum_of(values(:, q))
      found(q)%largest = largest(q)
      found(q)%rms = spectrum%rms
      found(q)%mean = spectrum%mean
      found(q)%amplitude = abs(spectrum%coefficient)
      where (abs(spectrum%coefficient) > unknown_phase*measure(q)) found(q)%phase = &
        atan2(aimag(spectrum%coefficient), real(spectrum%coefficient))/degree
    end do
  end subroutine find_spectra

  !> Whether more samples would not change the harmonics; so it is without any.
  pure function has_settled(found) result(has)
    type(harmonics_result_t), intent(in) :: found !! of `find_harmonics`
    logical :: has

    has = .not. found%change > unsettled
  end function has_settled

  !> Whether a quantity is a moment, not a force.
  elemental function is_moment(quantity) result(is)
    integer, intent(in) :: quantity !! number, as in `quantity_names`
    logical :: is

    is = quantity == shaking_moment .or. quantity == drive_torque
  end function is_moment

end module harmonics_study
