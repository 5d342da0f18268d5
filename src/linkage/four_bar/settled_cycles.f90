!> Turns of the crank sampled so closely that their harmonics do not change with more samples.
module settled_cycles
  use crank_cycle, only: cycle_t, cycle_values, find_cycle, quantity_count, usual_values
  use harmonics, only: spectrum_of, spectrum_t
  use interruption, only: was_interrupted
  use kinds, only: fineness, wp
  use linkages, only: linkage_t
  implicit none (type, external)
  private

  public :: find_settled_cycles, least_share

  integer, parameter :: fewest_samples = 64, most_samples = 65536

  !> Quantities that something balances to less than this share of the usual are judged by this
  !! share: what is left may be rounding.
  real(wp), parameter :: least_share = 1.0e-3_wp

contains

  !> Doubles the samples of a turn until harmonics, mean and rms of all quantities are to 1e-13 of
  !! the largest value what every second sample gives, or until there are 65,536 of them.
  !!
  !! They converge like a geometric series, the slower the nearer the crank comes to a dead point;
  !! the error of all samples is about the square of that of half of them. Many speeds next to a
  !! dead point take minutes: an interrupted run gets what there is.
  subroutine find_settled_cycles(linkages, elements, speed, acceleration, turns, change)
    type(linkage_t), intent(in) :: linkages(:) !! of the same motion, and bodies with different
                                               !! masses; the crank turns freely
    integer, intent(in) :: elements(:)         !! (bodies) on whose nodes their masses sit; 0:
                                               !! distributed
    real(wp), intent(in) :: speed(:)           !! ω2, all that are wanted [rad/s]
    real(wp), intent(in) :: acceleration       !! α2 [rad/s²]
    type(cycle_t), intent(out) :: turns(:)     !! (linkages)
    real(wp), intent(out) :: change            !! by which every second sample differs, by the
                                               !! largest value

    real(wp), parameter :: settled = 1.0e-13_wp*fineness
    real(wp) :: enough
    integer :: samples, i

    samples = fewest_samples
    do
      do i = 1, size(linkages)
        turns(i) = find_cycle(linkages(i), elements, samples)
      end do
      ! One speed that asks for more samples is enough to take them; what the last samples give is
      ! told.
      enough = merge(settled, huge(enough), samples < most_samples)
      change = largest_change(linkages, elements, turns, speed, acceleration, enough)
      if (change <= settled .or. samples >= most_samples .or. was_interrupted()) exit
      samples = 2*samples
    end do
  end subroutine find_settled_cycles

  !> The greatest difference between the spectra of all samples and of every second, by the largest
  !! value of each quantity; the first one above `enough`, if there is any.
  function largest_change(linkages, elements, turns, speed, acceleration, enough) result(change)
    type(linkage_t), intent(in) :: linkages(:)
    integer, intent(in) :: elements(:)
    type(cycle_t), intent(in) :: turns(:)
    real(wp), intent(in) :: speed(:), acceleration
    real(wp), intent(in) :: enough !! [-]
    real(wp) :: change

    real(wp), allocatable :: values(:, :)
    real(wp) :: largest(quantity_count), difference(quantity_count)
    integer :: i, k, q

    change = 0.0_wp
    do k = 1, size(speed)
      if (change > enough .or. was_interrupted()) return
      largest = least_share*usual_values(linkages(1), elements, speed(k), acceleration)
      difference = 0.0_wp
      do i = 1, size(turns)
        values = cycle_values(turns(i), speed(k), acceleration)
        largest = max(largest, maxval(abs(values), dim=1))
        do q = 1, quantity_count
          difference(q) = max(difference(q), distance(spectrum_of(values(:, q)), &
            spectrum_of(values(::2, q))))
        end do
      end do
      ! Where there is no value there is no difference either.
      change = max(change, maxval(difference/max(largest, tiny(largest))))
    end do
  end function largest_change

  pure function distance(a, b)
    type(spectrum_t), intent(in) :: a, b
    real(wp) :: distance

    distance = max(abs(a%mean - b%mean), abs(a%rms - b%rms), &
      maxval(abs(a%coefficient - b%coefficient)))
  end function distance

end module settled_cycles
