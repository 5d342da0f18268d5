!> Legendre polynomials by their recurrence, their integrals, and the Gauss rule.
module legendre
  use constants, only: pi
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: legendre_values, once_integrated, twice_integrated, gauss_rule

contains

  !> `P_0(x) … P_degree(x)`, by `(j + 1) P_{j+1} = (2j + 1) x P_j − j P_{j−1}`.
  pure function legendre_values(degree, x) result(values)
    integer, intent(in) :: degree !! of the last polynomial, from 0
    real(wp), intent(in) :: x     !! from −1 to 1
    real(wp) :: values(0:degree)

    integer :: j

    values(0) = 1.0_wp
    if (degree > 0) values(1) = x
    do j = 1, degree - 1
      values(j + 1) = ((2*j + 1)*x*values(j) - j*values(j - 1))/(j + 1)
    end do
  end function legendre_values

  !> Legendre coefficients of `∫ P_j` from −1 to x, `(P_{j+1} − P_{j−1})/(2j + 1)`.
  pure function once_integrated(j) result(coefficient)
    integer, intent(in) :: j !! from 0
    real(wp) :: coefficient(0:j + 1)

    coefficient = 0.0_wp
    coefficient(j + 1) = 1.0_wp/(2*j + 1)
    if (j == 0) coefficient(0) = 1.0_wp
    if (j > 0) coefficient(j - 1) = -1.0_wp/(2*j + 1)
  end function once_integrated

  !> Legendre coefficients of `∫∫ P_j`, both from −1. For j ≥ 2, value and slope vanish at both
  !! ends.
  pure function twice_integrated(j) result(coefficient)
    integer, intent(in) :: j !! from 0
    real(wp) :: coefficient(0:j + 2)

    coefficient = 0.0_wp
    select case (j)
    case (0)
      coefficient = [2.0_wp/3.0_wp, 1.0_wp, 1.0_wp/3.0_wp]
    case (1)
      coefficient = [-1.0_wp/3.0_wp, -0.4_wp, 0.0_wp, 1.0_wp/15.0_wp]
    case default
      coefficient(j - 2:j + 2:2) = [1.0_wp/real((2*j - 1)*(2*j + 1), wp), &
        -2.0_wp/real((2*j - 1)*(2*j + 3), wp), 1.0_wp/real((2*j + 1)*(2*j + 3), wp)]
    end select
  end function twice_integrated

  !> Points and weights of the Gauss rule on −1 … 1: exact for polynomials up to degree `2 n − 1`.
  !!
  !! Newton's method for the roots of P_n from Chebyshev's guess; pairs ±x are made exactly
  !! symmetric.
  pure subroutine gauss_rule(point, weight)
    real(wp), intent(out) :: point(:)  !! (n) ascending
    real(wp), intent(out) :: weight(:) !! (n)

    integer, parameter :: most_steps = 20
    real(wp) :: p(0:size(point)), x, slope, step
    integer :: n, i, k

    n = size(point)
    do i = 1, (n + 1)/2
      x = cos(pi*(i - 0.25_wp)/(n + 0.5_wp))
      if (2*i == n + 1) x = 0.0_wp
      do k = 1, most_steps
        p = legendre_values(n, x)
        slope = n*(p(n - 1) - x*p(n))/(1.0_wp - x**2)
        step = p(n)/slope
        if (2*i < n + 1) x = x - step
        if (abs(step) <= epsilon(x)) exit
      end do
      p = legendre_values(n, x)
      slope = n*(p(n - 1) - x*p(n))/(1.0_wp - x**2)
      point([i, n + 1 - i]) = [-x, x]
      weight([i, n + 1 - i]) = 2.0_wp/((1.0_wp - x**2)*slope**2)
    end do
  end subroutine gauss_rule

end module legendre
