!> Harmonics of what a four-bar does to its ground and asks of its drive, over a whole turn of the
!! crank, as it is and with counterweights.
module harmonics_study
  use constants, only: degree
  use counterweights, only: balanced_linkage, find_counterweights
  use crank_cycle, only: cycle_t, cycle_values, drive_torque, largest_values, quantity_count, &
    quantity_names, shaking_moment, turns_freely, usual_values
  use harmonics, only: highest_harmonic, spectrum_of, spectrum_t
  use interruption, only: was_interrupted
  use kinds, only: wp
  use linkages, only: linkage_t
  use settled_cycles, only: find_settled_cycles, least_share
  implicit none (type, external)
  private

  public :: harmonics_result_t, harmonic_t, find_harmonics, quantity_count, quantity_names, &
    highest_harmonic, is_moment

  !> A quantity over a turn: mean + Σ amplitude cos(k θ2 + phase).
  type :: harmonic_t
    real(wp) :: largest = 0.0_wp !! absolute value, between the samples too [N, N m]
    real(wp) :: rms = 0.0_wp     !! root of the mean square
    real(wp) :: mean = 0.0_wp
    real(wp) :: amplitude(highest_harmonic) = 0.0_wp
    real(wp) :: phase(highest_harmonic) = 0.0_wp !! 0 where the amplitude is only rounding [deg]
  end type harmonic_t

  type :: harmonics_result_t
    logical :: has_cycle = .false. !! else the crank does not turn fully: there is nothing else
    integer :: samples = 0
    real(wp) :: change = 0.0_wp    !! what every second sample gives differs by so much [-]
    type(harmonic_t), allocatable :: of(:, :, :) !! (quantities, linkages, speeds) of the linkage as
                                                 !! given, and balanced
  end type harmonics_result_t

  !> Harmonics smaller than this share of what is usual have no digit that says where they begin.
  real(wp), parameter :: unknown_phase = 1.0e-12_wp

contains

  !> Harmonics at every speed. An interrupted run gets what there is.
  subroutine find_harmonics(linkage, elements, speed, acceleration, threads, found)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: elements(:)   !! (bodies) on whose nodes their masses sit; 0: distributed
    real(wp), intent(in) :: speed(:)     !! ω2, the same all round [rad/s]
    real(wp), intent(in) :: acceleration !! α2, likewise [rad/s²]
    integer, intent(in) :: threads
    type(harmonics_result_t), intent(out) :: found

    type(linkage_t) :: linkages(2)
    type(cycle_t) :: turns(2)
    real(wp), allocatable :: largest(:, :, :) !! (quantities, linkages, speeds)
    integer :: i, k

    found%has_cycle = turns_freely(linkage)
    if (.not. found%has_cycle) return
    linkages(1) = linkage
    linkages(2) = balanced_linkage(linkage, find_counterweights(linkage, elements))
    call find_settled_cycles(linkages, elements, speed, acceleration, threads, turns, found%change)
    found%samples = size(turns(1)%part, 3)
    allocate (found%of(quantity_count, 2, size(speed)), largest(quantity_count, 2, size(speed)))
    largest = 0.0_wp
    !$omp parallel do collapse(2) num_threads(threads) schedule(dynamic) default(shared) &
    !$omp   private(i, k)
    do k = 1, size(speed)
      do i = 1, 2
        if (.not. was_interrupted()) largest(:, i, k) = &
          largest_values(linkages(i), elements, turns(i), speed(k), acceleration)
      end do
    end do
    !$omp end parallel do
    !$omp parallel do collapse(2) num_threads(threads) schedule(dynamic) default(shared) &
    !$omp   private(i, k)
    do k = 1, size(speed)
      do i = 1, 2
        if (.not. was_interrupted()) &
          call find_spectra(turns(i), speed(k), acceleration, largest(:, i, k), &
            max(maxval(largest(:, :, k), dim=2), least_share*usual_values(linkages(1), &
            elements, speed(k), acceleration)), found%of(:, i, k))
      end do
    end do
    !$omp end parallel do
  end subroutine find_harmonics

  !> The harmonics of a linkage at a speed.
  pure subroutine find_spectra(turn, speed, acceleration, largest, measure, found)
    type(cycle_t), intent(in) :: turn
    real(wp), intent(in) :: speed            !! ω2 [rad/s]
    real(wp), intent(in) :: acceleration     !! α2 [rad/s²]
    real(wp), intent(in) :: largest(:)       !! (quantities)
    real(wp), intent(in) :: measure(:)       !! (quantities) against which a harmonic is rounding
    type(harmonic_t), intent(out) :: found(:) !! (quantities)

    real(wp), allocatable :: values(:, :)
    type(spectrum_t) :: spectrum
    integer :: q

    values = cycle_values(turn, speed, acceleration)
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

  !> Whether a quantity is a moment, not a force.
  elemental function is_moment(quantity) result(is)
    integer, intent(in) :: quantity
    logical :: is

    is = quantity == shaking_moment .or. quantity == drive_torque
  end function is_moment

end module harmonics_study
