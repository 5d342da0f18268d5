!> Chebyshev series of smooth functions on an interval: what Fourier series are for periodic ones.
!! Trefethen, *Approximation Theory and Approximation Practice* (2013), chapters 3, 4.
module chebyshev_series
  use constants, only: pi
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: chebyshev_nodes, chebyshev_coefficients, chebyshev_slopes, chebyshev_value

contains

  !> The zeros of `T_n`, rising between −1 and 1.
  pure function chebyshev_nodes(n) result(x)
    integer, intent(in) :: n
    real(wp) :: x(n)

    integer :: k

    x = [(sin(pi*(2*k - n - 1)/(2.0_wp*n)), k=1, n)]
  end function chebyshev_nodes

  !> Coefficients of `Σ c_j T_j`, j from 0, which has given values at the nodes.
  pure function chebyshev_coefficients(values) result(c)
    real(wp), intent(in) :: values(:, :)              !! (nodes, functions)
    real(wp) :: c(size(values, 1), size(values, 2))   !! (j + 1, functions)

    integer :: n

    n = size(values, 1)
    c = matmul(transpose(polynomials(n)), values)*2.0_wp/n
    c(1, :) = 0.5_wp*c(1, :)
  end function chebyshev_coefficients

  !> Derivatives at the nodes.
  pure function chebyshev_slopes(values) result(slopes)
    real(wp), intent(in) :: values(:, :)                 !! (nodes, functions) at the nodes
    real(wp) :: slopes(size(values, 1), size(values, 2))

    real(wp) :: c(size(values, 1), size(values, 2)), d(size(values, 1) + 1, size(values, 2))
    integer :: j, n

    n = size(values, 1)
    c = chebyshev_coefficients(values)
    d = 0.0_wp
    do j = n - 1, 1, -1
      d(j, :) = 2.0_wp*j*c(j + 1, :)
      if (j + 2 <= n) d(j, :) = d(j, :) + d(j + 2, :)
    end do
    d(1, :) = 0.5_wp*d(1, :)
    slopes = matmul(polynomials(n), d(:n, :))
  end function chebyshev_slopes

  !> The sum of a series at a place (Clenshaw).
  pure function chebyshev_value(c, x) result(value)
    real(wp), intent(in) :: c(:, :)     !! (j + 1, functions)
    real(wp), intent(in) :: x           !! about −1 to 1
    real(wp) :: value(size(c, 2))

    real(wp) :: after(size(c, 2)), last(size(c, 2))
    integer :: j

    value = 0.0_wp
    after = 0.0_wp
    do j = size(c, 1), 2, -1
      last = after
      after = value
      value = 2.0_wp*x*after - last + c(j, :)
    end do
    value = x*value - after + c(1, :)
  end function chebyshev_value

  !> `T_j` of the nodes.
  pure function polynomials(n) result(t)
    integer, intent(in) :: n
    real(wp) :: t(n, n) !! (nodes, j + 1)

    integer :: j, k

    do j = 1, n
      do k = 1, n
        t(k, j) = cos(pi*(j - 1)*(2*(n - k) + 1)/(2.0_wp*n))
      end do
    end do
  end function polynomials

end module chebyshev_series
