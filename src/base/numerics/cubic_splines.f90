!> Cubic splines through given points: continuous with their first two derivatives.
!!
!! The unknowns are the second derivatives at the knots, from the equations of continuous first
!! derivatives; de Boor, *A Practical Guide to Splines*, 2001, chapter IV.
module cubic_splines
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: cubic_spline_t, new_cubic_spline, new_monotone_spline, spline_values
  public :: ends_natural, ends_not_a_knot, ends_at_rest, ends_periodic

  !> Conditions at the ends: no second derivative; one cubic over the first two intervals, and over
  !! the last two; no first derivative; value and both derivatives are those of the other end.
  integer, parameter :: ends_natural = 1, ends_not_a_knot = 2, ends_at_rest = 3, ends_periodic = 4

  type :: cubic_spline_t
    logical :: is_periodic = .false.
    real(wp), allocatable :: x(:)    !! (knots) rising
    real(wp), allocatable :: y(:)    !! (knots)
    real(wp), allocatable :: bend(:)  !! (knots) second derivatives; of a monotone one not allocated
    real(wp), allocatable :: slope(:) !! (knots) of a monotone one the first derivatives
  end type cubic_spline_t

contains

  !> The spline through points.
  !!
  !! Two points make a straight line, whatever the ends but those at rest; three with not-a-knot
  !! ends a parabola.
  pure function new_cubic_spline(x, y, ends) result(spline)
    real(wp), intent(in) :: x(:)   !! (knots) rising, two at least
    real(wp), intent(in) :: y(:)   !! (knots) of a periodic one the last is as the first
    integer, intent(in) :: ends    !! one of the ends_… constants
    type(cubic_spline_t) :: spline

    real(wp) :: h(size(x) - 1)
    integer :: n

    n = size(x)
    h = x(2:) - x(:n - 1)
    spline%x = x
    spline%y = y
    spline%is_periodic = ends == ends_periodic
    allocate (spline%bend(n), source=0.0_wp)
    if (spline%is_periodic .and. n > 2) then
      call find_periodic_bends(h, y, spline%bend)
    else if (n > 2 .or. ends == ends_at_rest) then
      call find_bends(h, y, ends, spline%bend)
    end if
  end function new_cubic_spline

  !> Cubics that are monotone between points, and nowhere beyond both neighbours: without the waves
  !! of a spline beside a step, but continuous with the first derivative only; Steffen,
  !! *Astronomy and Astrophysics* 239 (1990), 443. With the slopes s of the chords and p of the
  !! parabola through three points, that of a point is
  !! `(sign s₁ + sign s₂) min(|s₁|, |s₂|, ½ |p|)`.
  pure function new_monotone_spline(x, y) result(spline)
    real(wp), intent(in) :: x(:) !! (knots) rising, two at least
    real(wp), intent(in) :: y(:) !! (knots)
    type(cubic_spline_t) :: spline

    real(wp) :: h(size(x) - 1), s(size(x) - 1), p
    integer :: i, n

    n = size(x)
    h = x(2:) - x(:n - 1)
    s = (y(2:) - y(:n - 1))/h
    spline%x = x
    spline%y = y
    allocate (spline%slope(n))
    spline%slope([1, n]) = s([1, n - 1])
    do i = 2, n - 1
      p = (s(i - 1)*h(i) + s(i)*h(i - 1))/(h(i - 1) + h(i))
      spline%slope(i) = (sign(1.0_wp, s(i - 1)) + sign(1.0_wp, s(i)))*min(abs(s(i - 1)), &
        abs(s(i)), 0.5_wp*abs(p))
    end do
    if (n == 2) return
    spline%slope(1) = end_slope(h(1), h(2), s(1), s(2))
    spline%slope(n) = end_slope(h(n - 1), h(n - 2), s(n - 1), s(n - 2))
  end function new_monotone_spline

  !> The slope at the end of the parabola through the last three points, within what keeps it
  !! monotone.
  pure function end_slope(h, h_next, s, s_next) result(slope)
    real(wp), intent(in) :: h, h_next !! lengths of the last interval and of that beside it
    real(wp), intent(in) :: s, s_next !! slopes of their chords
    real(wp) :: slope

    slope = s + (s - s_next)*h/(h + h_next)
    if (slope*s <= 0.0_wp) then
      slope = 0.0_wp
    else if (abs(slope) > 2.0_wp*abs(s)) then
      slope = 2.0_wp*s
    end if
  end function end_slope

  !> Second derivatives m of a spline with ends:
  !! h₁ m₁ + 2 (h₁ + h₂) m₂ + h₂ m₃ = 6 (Δ₂ − Δ₁), with the slopes Δ of the chords.
  pure subroutine find_bends(h, y, ends, m)
    real(wp), intent(in) :: h(:)  !! (intervals)
    real(wp), intent(in) :: y(:)  !! (knots)
    integer, intent(in) :: ends
    real(wp), intent(out) :: m(:) !! (knots)

    real(wp), dimension(size(y)) :: lower, diagonal, upper, right
    real(wp) :: slope(size(h))
    integer :: n, i

    n = size(y)
    slope = (y(2:) - y(:n - 1))/h
    do i = 2, n - 1
      lower(i) = h(i - 1)
      diagonal(i) = 2.0_wp*(h(i - 1) + h(i))
      upper(i) = h(i)
      right(i) = 6.0_wp*(slope(i) - slope(i - 1))
    end do
    diagonal([1, n]) = 1.0_wp
    upper(1) = 0.0_wp
    lower(n) = 0.0_wp
    right([1, n]) = 0.0_wp
    if (ends == ends_at_rest) then
      diagonal(1) = 2.0_wp*h(1)
      upper(1) = h(1)
      right(1) = 6.0_wp*slope(1)
      diagonal(n) = 2.0_wp*h(n - 1)
      lower(n) = h(n - 1)
      right(n) = -6.0_wp*slope(n - 1)
    else if (ends == ends_not_a_knot .and. n == 3) then
      m = right(2)/(3.0_wp*(h(1) + h(2)))
      return
    else if (ends == ends_not_a_knot) then
      ! m changes linearly through the second knot, and the last but one: the ends are eliminated.
      associate (q => h(1)/h(2))
        diagonal(2) = diagonal(2) + h(1)*(1.0_wp + q)
        upper(2) = upper(2) - h(1)*q
        lower(2) = 0.0_wp
      end associate
      associate (q => h(n - 1)/h(n - 2))
        diagonal(n - 1) = diagonal(n - 1) + h(n - 1)*(1.0_wp + q)
        lower(n - 1) = lower(n - 1) - h(n - 1)*q
        upper(n - 1) = 0.0_wp
      end associate
    end if
    call solve_tridiagonal(lower, diagonal, upper, right, m)
    if (ends /= ends_not_a_knot) return
    m(1) = m(2) - h(1)/h(2)*(m(3) - m(2))
    m(n) = m(n - 1) + h(n - 1)/h(n - 2)*(m(n - 1) - m(n - 2))
  end subroutine find_bends

  !> Second derivatives of a periodic spline: the last knot is the first one, and the corners of the
  !! cyclic matrix are a change of rank one (Sherman and Morrison).
  pure subroutine find_periodic_bends(h, y, m)
    real(wp), intent(in) :: h(:)  !! (intervals)
    real(wp), intent(in) :: y(:)  !! (knots) the last as the first
    real(wp), intent(out) :: m(:) !! (knots)

    real(wp), dimension(size(h)) :: lower, diagonal, upper, right, corner, with, without
    real(wp) :: slope(size(h)), before
    integer :: n, i, last

    n = size(h)
    slope = (y(2:) - y(:n))/h
    do i = 1, n
      last = merge(n, i - 1, i == 1)
      lower(i) = h(last)
      diagonal(i) = 2.0_wp*(h(last) + h(i))
      upper(i) = h(i)
      right(i) = 6.0_wp*(slope(i) - slope(last))
    end do
    if (n == 2) then
      ! Both neighbours of a knot are the other one.
      before = h(1) + h(2)
      m(1) = (2.0_wp*right(1) - right(2))/(3.0_wp*before)
      m(2) = (2.0_wp*right(2) - right(1))/(3.0_wp*before)
      m(3) = m(1)
      return
    end if
    ! The matrix is tridiagonal + u vᵀ with u = (−d₁, 0, …, upperₙ), v = (1, 0, …, −lower₁/d₁).
    before = diagonal(1)
    corner = 0.0_wp
    corner(1) = -before
    corner(n) = upper(n)
    diagonal(1) = 2.0_wp*before
    diagonal(n) = diagonal(n) + upper(n)*lower(1)/before
    call solve_tridiagonal(lower, diagonal, upper, right, without)
    call solve_tridiagonal(lower, diagonal, upper, corner, with)
    associate (ratio => -lower(1)/before)
      m(:n) = without - with*(without(1) + ratio*without(n))/(1.0_wp + with(1) + ratio*with(n))
    end associate
    m(n + 1) = m(1)
  end subroutine find_periodic_bends

  !> Solves a tridiagonal system by elimination without pivoting, which a dominant diagonal allows.
  pure subroutine solve_tridiagonal(lower, diagonal, upper, right, x)
    real(wp), intent(in) :: lower(:), diagonal(:), upper(:), right(:) !! (n)
    real(wp), intent(out) :: x(:)                                     !! (n)

    real(wp) :: pivot(size(x))
    integer :: n, i

    n = size(x)
    pivot(1) = diagonal(1)
    x(1) = right(1)
    do i = 2, n
      pivot(i) = diagonal(i) - lower(i)/pivot(i - 1)*upper(i - 1)
      x(i) = right(i) - lower(i)/pivot(i - 1)*x(i - 1)
    end do
    x(n) = x(n)/pivot(n)
    do i = n - 1, 1, -1
      x(i) = (x(i) - upper(i)*x(i + 1))/pivot(i)
    end do
  end subroutine solve_tridiagonal

  !> Value and derivatives. Of a periodic spline anywhere; beyond the ends of others, those of the
  !! first and the last cubic go on.
  pure function spline_values(spline, x) result(values)
    type(cubic_spline_t), intent(in) :: spline
    real(wp), intent(in) :: x
    real(wp) :: values(0:2) !! y, y′, y″

    real(wp) :: at, h, a, b
    integer :: i

    at = in_period(spline, x)
    i = interval_of(spline, at)
    if (allocated(spline%slope)) then
      values = monotone_values(spline, i, at)
      return
    end if
    associate (y => spline%y, m => spline%bend)
      h = spline%x(i + 1) - spline%x(i)
      b = (at - spline%x(i))/h
      a = (spline%x(i + 1) - at)/h
      values(0) = a*y(i) + b*y(i + 1) + h**2/6.0_wp*((a**3 - a)*m(i) + (b**3 - b)*m(i + 1))
      values(1) = (y(i + 1) - y(i))/h + h/6.0_wp*((3.0_wp*b**2 - 1.0_wp)*m(i + 1) - &
        (3.0_wp*a**2 - 1.0_wp)*m(i))
      values(2) = a*m(i) + b*m(i + 1)
    end associate
  end function spline_values

  !> The same in an interval of a monotone one, from values and slopes at its ends.
  pure function monotone_values(spline, i, x) result(values)
    type(cubic_spline_t), intent(in) :: spline
    integer, intent(in) :: i !! number of the interval
    real(wp), intent(in) :: x
    real(wp) :: values(0:2)

    real(wp) :: h, s, t, c, d

    h = spline%x(i + 1) - spline%x(i)
    t = x - spline%x(i)
    associate (y => spline%y, slope => spline%slope)
      s = (y(i + 1) - y(i))/h
      c = (3.0_wp*s - 2.0_wp*slope(i) - slope(i + 1))/h
      d = (slope(i) + slope(i + 1) - 2.0_wp*s)/h**2
      values = [y(i) + t*(slope(i) + t*(c + t*d)), slope(i) + t*(2.0_wp*c + 3.0_wp*t*d), &
        2.0_wp*c + 6.0_wp*t*d]
    end associate
  end function monotone_values

  !> The place in the first period.
  pure function in_period(spline, x) result(at)
    type(cubic_spline_t), intent(in) :: spline
    real(wp), intent(in) :: x
    real(wp) :: at

    at = x
    if (.not. spline%is_periodic) return
    associate (first => spline%x(1), last => spline%x(size(spline%x)))
      if (x < first .or. x > last) at = first + modulo(x - first, last - first)
    end associate
  end function in_period

  !> Number of the interval that holds a place, the first or the last for places beyond the ends; by
  !! bisection.
  pure function interval_of(spline, x) result(low)
    type(cubic_spline_t), intent(in) :: spline
    real(wp), intent(in) :: x
    integer :: low

    integer :: high, middle

    low = 1
    high = size(spline%x)
    do while (high - low > 1)
      middle = (low + high)/2
      if (spline%x(middle) <= x) then
        low = middle
      else
        high = middle
      end if
    end do
  end function interval_of

end module cubic_splines
