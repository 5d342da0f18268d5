!> Fourier transforms of periodic real functions sampled evenly over their period: the mixed-radix
!! transforms of the GNU Scientific Library. Fast where the number of samples has small factors.
!!
!! The library computes in double precision, whatever the working precision.
module fourier_transform
  use, intrinsic :: iso_c_binding, only: c_associated, c_double, c_int, c_null_ptr, c_ptr, c_size_t
  use constants, only: two_pi
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: fourier_plan_t, open_fourier, close_fourier
  public :: coefficients_of, values_of, derivative_of, shifted, resampled, resample, value_at, &
    derivatives

  !> Tables for one number of samples. To be closed after use, and never copied; one thread at a
  !! time.
  type :: fourier_plan_t
    integer :: samples = 0
    type(c_ptr), private :: forward = c_null_ptr, backward = c_null_ptr, work = c_null_ptr
  end type fourier_plan_t

  interface
    function gsl_fft_real_wavetable_alloc(n) bind(c) result(table)
      import :: c_ptr, c_size_t
      integer(c_size_t), value :: n
      type(c_ptr) :: table
    end function gsl_fft_real_wavetable_alloc

    function gsl_fft_halfcomplex_wavetable_alloc(n) bind(c) result(table)
      import :: c_ptr, c_size_t
      integer(c_size_t), value :: n
      type(c_ptr) :: table
    end function gsl_fft_halfcomplex_wavetable_alloc

    function gsl_fft_real_workspace_alloc(n) bind(c) result(work)
      import :: c_ptr, c_size_t
      integer(c_size_t), value :: n
      type(c_ptr) :: work
    end function gsl_fft_real_workspace_alloc

    subroutine gsl_fft_real_wavetable_free(table) bind(c)
      import :: c_ptr
      type(c_ptr), value :: table
    end subroutine gsl_fft_real_wavetable_free

    subroutine gsl_fft_halfcomplex_wavetable_free(table) bind(c)
      import :: c_ptr
      type(c_ptr), value :: table
    end subroutine gsl_fft_halfcomplex_wavetable_free

    subroutine gsl_fft_real_workspace_free(work) bind(c)
      import :: c_ptr
      type(c_ptr), value :: work
    end subroutine gsl_fft_real_workspace_free

    function gsl_fft_real_transform(data, stride, n, table, work) bind(c) result(status)
      import :: c_double, c_int, c_ptr, c_size_t
      real(c_double), intent(inout) :: data(*)
      integer(c_size_t), value :: stride, n
      type(c_ptr), value :: table, work
      integer(c_int) :: status
    end function gsl_fft_real_transform

    function gsl_fft_halfcomplex_transform(data, stride, n, table, work) bind(c) result(status)
      import :: c_double, c_int, c_ptr, c_size_t
      real(c_double), intent(inout) :: data(*)
      integer(c_size_t), value :: stride, n
      type(c_ptr), value :: table, work
      integer(c_int) :: status
    end function gsl_fft_halfcomplex_transform
  end interface

contains

  !> Makes the tables for a number of samples.
  subroutine open_fourier(samples, plan)
    integer, intent(in) :: samples            !! even, at least 4
    type(fourier_plan_t), intent(out) :: plan !! to be closed

    plan%samples = samples
    plan%forward = gsl_fft_real_wavetable_alloc(int(samples, c_size_t))
    plan%backward = gsl_fft_halfcomplex_wavetable_alloc(int(samples, c_size_t))
    plan%work = gsl_fft_real_workspace_alloc(int(samples, c_size_t))
  end subroutine open_fourier

  !> Gives the tables back.
  subroutine close_fourier(plan)
    type(fourier_plan_t), intent(inout) :: plan !! open or not

    if (c_associated(plan%forward)) call gsl_fft_real_wavetable_free(plan%forward)
    if (c_associated(plan%backward)) call gsl_fft_halfcomplex_wavetable_free(plan%backward)
    if (c_associated(plan%work)) call gsl_fft_real_workspace_free(plan%work)
    plan%forward = c_null_ptr
    plan%backward = c_null_ptr
    plan%work = c_null_ptr
  end subroutine close_fourier

  !> Coefficients of every column in the order a0, a1, b1, a2, b2, …, a(n/2), where the function is
  !! `a0 + 2 Σ (a_j cos jθ − b_j sin jθ) + a(n/2) cos (n/2)θ`.
  subroutine coefficients_of(plan, samples, coefficients)
    type(fourier_plan_t), intent(in) :: plan       !! of this number of samples
    real(wp), intent(in) :: samples(:, :)          !! (samples, functions) at θ = 0, 2π/n, …
    real(wp), intent(out) :: coefficients(:, :)    !! (samples, functions)

    real(c_double) :: data(plan%samples)
    integer(c_int) :: status
    integer :: i

    do i = 1, size(samples, 2)
      data = real(samples(:, i), c_double)
      status = gsl_fft_real_transform(data, 1_c_size_t, int(plan%samples, c_size_t), &
        plan%forward, plan%work)
      coefficients(:, i) = real(data, wp)/plan%samples
    end do
  end subroutine coefficients_of

  !> Samples of functions from their coefficients.
  subroutine values_of(plan, coefficients, samples)
    type(fourier_plan_t), intent(in) :: plan    !! of this number of samples
    real(wp), intent(in) :: coefficients(:, :)  !! (samples, functions)
    real(wp), intent(out) :: samples(:, :)      !! (samples, functions) at θ = 0, 2π/n, …

    real(c_double) :: data(plan%samples)
    integer(c_int) :: status
    integer :: i

    do i = 1, size(samples, 2)
      data = real(coefficients(:, i), c_double)
      status = gsl_fft_halfcomplex_transform(data, 1_c_size_t, int(plan%samples, c_size_t), &
        plan%backward, plan%work)
      samples(:, i) = real(data, wp)
    end do
  end subroutine values_of

  !> Coefficients of the derivative. The highest harmonic, of which only the cosine is known, has
  !! none.
  pure function derivative_of(coefficients) result(derivative)
    real(wp), intent(in) :: coefficients(:, :) !! (samples, functions)
    real(wp) :: derivative(size(coefficients, 1), size(coefficients, 2))

    integer :: i, j, n

    n = size(coefficients, 1)
    do i = 1, size(coefficients, 2)
      derivative(1, i) = 0.0_wp
      do j = 1, (n - 1)/2
        derivative(2*j, i) = -j*coefficients(2*j + 1, i)
        derivative(2*j + 1, i) = j*coefficients(2*j, i)
      end do
      derivative(n, i) = 0.0_wp
    end do
  end function derivative_of

  !> First and second derivatives of sampled functions.
  subroutine derivatives(plan, samples, first, second)
    type(fourier_plan_t), intent(in) :: plan          !! of this number of samples
    real(wp), intent(in) :: samples(:, :)             !! (samples, functions)
    real(wp), intent(out) :: first(:, :)              !! d/dθ
    real(wp), intent(out), optional :: second(:, :)   !! d²/dθ²

    real(wp), allocatable :: coefficients(:, :)

    allocate (coefficients(size(samples, 1), size(samples, 2)))
    call coefficients_of(plan, samples, coefficients)
    coefficients = derivative_of(coefficients)
    call values_of(plan, coefficients, first)
    if (.not. present(second)) return
    coefficients = derivative_of(coefficients)
    call values_of(plan, coefficients, second)
  end subroutine derivatives

  !> Coefficients of f(θ + shift).
  pure function shifted(coefficients, shift) result(moved)
    real(wp), intent(in) :: coefficients(:, :) !! (samples, functions) of f
    real(wp), intent(in) :: shift              !! [rad]
    real(wp) :: moved(size(coefficients, 1), size(coefficients, 2))

    real(wp) :: c(size(coefficients, 1)/2), s(size(coefficients, 1)/2)
    integer :: i, j, n

    n = size(coefficients, 1)
    do j = 1, n/2
      c(j) = cos(j*shift)
      s(j) = sin(j*shift)
    end do
    do i = 1, size(coefficients, 2)
      moved(1, i) = coefficients(1, i)
      do j = 1, (n - 1)/2
        moved(2*j, i) = c(j)*coefficients(2*j, i) - s(j)*coefficients(2*j + 1, i)
        moved(2*j + 1, i) = s(j)*coefficients(2*j, i) + c(j)*coefficients(2*j + 1, i)
      end do
      moved(n, i) = c(n/2)*coefficients(n, i)
    end do
  end function shifted

  !> Coefficients for another number of samples: harmonics are left out or added as zeros.
  pure function resampled(coefficients, samples) result(other)
    real(wp), intent(in) :: coefficients(:, :) !! (samples before, functions)
    integer, intent(in) :: samples             !! even
    real(wp) :: other(samples, size(coefficients, 2))

    integer :: kept, n

    n = size(coefficients, 1)
    other = 0.0_wp
    kept = min(n, samples) - 1
    other(:kept, :) = coefficients(:kept, :)
    ! The highest harmonic is shared by +n/2 and −n/2.
    if (samples > n) other(n, :) = 0.5_wp*coefficients(n, :)
    if (samples == n) other(n, :) = coefficients(n, :)
  end function resampled

  !> Samples of functions in another number.
  subroutine resample(plan, samples, other_plan, other)
    type(fourier_plan_t), intent(in) :: plan       !! of this number of samples
    real(wp), intent(in) :: samples(:, :)          !! (samples, functions)
    type(fourier_plan_t), intent(in) :: other_plan !! of the other number
    real(wp), intent(out) :: other(:, :)           !! (other samples, functions)

    real(wp), allocatable :: coefficients(:, :)

    allocate (coefficients, mold=samples)
    call coefficients_of(plan, samples, coefficients)
    call values_of(other_plan, resampled(coefficients, other_plan%samples), other)
  end subroutine resample

  !> Values at any angle.
  pure function value_at(coefficients, theta) result(value)
    real(wp), intent(in) :: coefficients(:, :) !! (samples, functions)
    real(wp), intent(in) :: theta              !! [rad]
    real(wp) :: value(size(coefficients, 2))

    !> Harmonics that are turned at once, each from that so many before, and terms that are summed
    !! side by side: none waits for its neighbour.
    integer, parameter :: together = 8
    real(wp) :: wave(size(coefficients, 1) + 2*together), part(together)
    complex(wp) :: turn(together), turned
    integer :: i, j, n

    n = size(coefficients, 1)
    turn = [(exp(cmplx(0.0_wp, j*modulo(theta, two_pi), wp)), j=1, together)]
    turned = turn(together)
    wave(1) = 1.0_wp
    do j = 2, n, 2*together
      wave(j:j + 2*together - 2:2) = 2.0_wp*real(turn)
      wave(j + 1:j + 2*together - 1:2) = -2.0_wp*aimag(turn)
      turn = turn*turned
    end do
    wave(n) = 0.5_wp*wave(n)
    do i = 1, size(value)
      part = 0.0_wp
      do j = 1, n - together + 1, together
        part = part + wave(j:j + together - 1)*coefficients(j:j + together - 1, i)
      end do
      value(i) = sum(part) + dot_product(wave(j:n), coefficients(j:n, i))
    end do
  end function value_at

end module fourier_transform
