!> Mean, root mean square and harmonics of periodic quantities sampled evenly over their period.
module harmonics
  use constants, only: two_pi
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: spectrum_t, spectrum_of, highest_harmonic

  integer, parameter :: highest_harmonic = 10

  !> `mean + Σ amplitude(k) cos(k t + phase(k))`, in the unit of the samples.
  type :: spectrum_t
    real(wp) :: mean = 0.0_wp                             !! over the period
    real(wp) :: rms = 0.0_wp                              !! of the whole quantity, not only of
                                                          !! these harmonics
    complex(wp) :: coefficient(highest_harmonic) = 0.0_wp !! amplitude and phase of each harmonic as
                                                          !! a complex number
  end type spectrum_t

contains

  !> The spectrum of a quantity by sums over its samples, which for smooth quantities converge
  !! faster than any power of the number of samples (Trefethen, Weideman: The exponentially
  !! convergent trapezoidal rule. SIAM Review 56 (2014) 385).
  !!
  !! Aliasing: with n samples, harmonic k also takes up harmonic n − k, so n must be well above the
  !! highest harmonic of the quantity.
  pure function spectrum_of(samples) result(spectrum)
    real(wp), intent(in) :: samples(:) !! (n) at t = 0, 2π/n, …; n more than twice the highest
                                       !! harmonic
    type(spectrum_t) :: spectrum

    complex(wp) :: sums(highest_harmonic), turn, power
    integer :: i, k, n

    n = size(samples)
    spectrum%mean = sum(samples)/n
    spectrum%rms = sqrt(sum(samples**2)/n)
    sums = 0.0_wp
    do i = 1, n
      turn = exp(cmplx(0.0_wp, -two_pi*real(i - 1, wp)/n, wp))
      power = 1.0_wp
      ! Without the mean, whose round-off would otherwise mask small harmonics.
      do k = 1, highest_harmonic
        power = power*turn
        sums(k) = sums(k) + (samples(i) - spectrum%mean)*power
      end do
    end do
    spectrum%coefficient = 2.0_wp*sums/n
  end function spectrum_of

end module harmonics
