!> Periodic quantities, sampled evenly over their period: mean, root of the mean square, harmonics.
module harmonics
  use constants, only: two_pi
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: spectrum_t, spectrum_of, highest_harmonic

  integer, parameter :: highest_harmonic = 10

  !> `mean + Σ amplitude(k) cos(k t + phase(k))`, in the units of what was sampled.
  type :: spectrum_t
    real(wp) :: mean = 0.0_wp
    real(wp) :: rms = 0.0_wp                                !! of the whole, not of these harmonics
                                                            !! only
    complex(wp) :: coefficient(highest_harmonic) = 0.0_wp   !! amplitude and phase of each
  end type spectrum_t

contains

  !> The spectrum of a quantity by sums over its samples, which converge faster than any power of
  !! their number where the quantity is smooth (Trefethen, Weideman: The exponentially convergent
  !! trapezoidal rule. SIAM Review 56 (2014) 385).
  !!
  !! With n samples harmonic k takes up harmonic n − k: n has to be well above what the quantity
  !! has.
  pure function spectrum_of(samples) result(spectrum)
    real(wp), intent(in) :: samples(:) !! at t = 0, 2π/n, … ; more than twice the highest harmonic
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
      ! Without the mean, so that its rounding does not stand in for small harmonics.
      do k = 1, highest_harmonic
        power = power*turn
        sums(k) = sums(k) + (samples(i) - spectrum%mean)*power
      end do
    end do
    spectrum%coefficient = 2.0_wp*sums/n
  end function spectrum_of

end module harmonics
