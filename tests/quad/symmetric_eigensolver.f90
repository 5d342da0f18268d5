!> All eigenvalues and vectors of small full symmetric matrices in any precision: what LAPACK does for the program, for its
!! quadruple-precision build.
module symmetric_eigensolver
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: solve_symmetric, solve_generalized, factor_full

  integer, parameter :: most_turns = 100 !! of QL for one eigenvalue; two or three are usual

contains

  !> `A z = w z`: Householder reflections to three diagonals, then QL with implicit shifts (Martin, Reinsch and Wilkinson,
  !! Numer. Math. 11 (1968) 181; Dubrulle, Martin and Wilkinson, Numer. Math. 12 (1968) 377).
  pure subroutine solve_symmetric(a, values, vectors, info)
    real(wp), intent(in) :: a(:, :)         !! (n, n)
    real(wp), intent(out) :: values(:)      !! (n) ascending
    real(wp), intent(out) :: vectors(:, :)  !! (n, n) orthonormal columns
    integer, intent(out) :: info            !! 0, or the number of an eigenvalue that did not converge

    real(wp) :: beside(size(values))

    call to_three_diagonals(a, values, beside, vectors)
    call iterate_ql(values, beside, vectors, info)
    if (info == 0) call put_in_order(values, vectors)
  end subroutine solve_symmetric

  !> `A = Z T Zᵀ`, T of three diagonals.
  pure subroutine to_three_diagonals(a, diagonal, beside, z)
    real(wp), intent(in) :: a(:, :)
    real(wp), intent(out) :: diagonal(:)
    real(wp), intent(out) :: beside(:) !! `beside(i)` couples i and i + 1; the last is 0
    real(wp), intent(out) :: z(:, :)

    real(wp) :: t(size(a, 1), size(a, 1)), mirror(size(a, 1)), product(size(a, 1)), length
    integer :: i, j, k, n

    n = size(a, 1)
    t = a
    z = 0.0_wp
    do i = 1, n
      z(i, i) = 1.0_wp
    end do
    do k = 1, n - 2
      length = norm2(t(k + 1:, k))
      if (length <= 0.0_wp .or. all(abs(t(k + 2:, k)) <= 0.0_wp)) cycle
      mirror = 0.0_wp
      mirror(k + 1:) = t(k + 1:, k)
      mirror(k + 1) = mirror(k + 1) + sign(length, mirror(k + 1))
      mirror = mirror/norm2(mirror)
      ! H T H = T − 2 v pᵀ − 2 p vᵀ for H = I − 2 v vᵀ and p = T v − (vᵀ T v) v.
      product = matmul(t(:, k + 1:), mirror(k + 1:))
      product = product - dot_product(mirror, product)*mirror
      do j = k, n
        t(k:, j) = t(k:, j) - 2.0_wp*(mirror(k:)*product(j) + product(k:)*mirror(j))
      end do
      product = matmul(z(:, k + 1:), mirror(k + 1:))
      do j = k + 1, n
        z(:, j) = z(:, j) - 2.0_wp*product*mirror(j)
      end do
    end do
    beside = 0.0_wp
    do i = 1, n
      diagonal(i) = t(i, i)
      if (i < n) beside(i) = t(i + 1, i)
    end do
  end subroutine to_three_diagonals

  !> Turns the diagonals beside the middle one to nothing, and the vectors with them.
  pure subroutine iterate_ql(d, e, z, info)
    real(wp), intent(inout) :: d(:), e(:), z(:, :)
    integer, intent(out) :: info

    integer :: first, last, turn

    info = 0
    do first = 1, size(d)
      do turn = 1, most_turns
        last = end_of_part(d, e, first)
        if (last == first) exit
        call turn_once(d, e, z, first, last)
      end do
      if (last > first) info = first
    end do
  end subroutine iterate_ql

  !> The last unknown that hangs together with the first: up to where the coupling is nothing but rounding.
  pure function end_of_part(d, e, first) result(last)
    real(wp), intent(in) :: d(:), e(:)
    integer, intent(in) :: first
    integer :: last

    do last = first, size(d) - 1
      if (abs(e(last)) <= 0.5_wp*epsilon(1.0_wp)*(abs(d(last)) + abs(d(last + 1)))) return
    end do
    last = size(d)
  end function end_of_part

  !> One step of QL with Wilkinson's shift on the part from `first` to `last`.
  pure subroutine turn_once(d, e, z, first, last)
    real(wp), intent(inout) :: d(:), e(:), z(:, :)
    integer, intent(in) :: first, last

    real(wp) :: g, r, s, c, p, f, b, column(size(z, 1))
    integer :: i

    g = (d(first + 1) - d(first))/(2.0_wp*e(first))
    g = d(last) - d(first) + e(first)/(g + sign(hypot(g, 1.0_wp), g))
    s = 1.0_wp
    c = 1.0_wp
    p = 0.0_wp
    do i = last - 1, first, -1
      f = s*e(i)
      b = c*e(i)
      r = hypot(f, g)
      e(i + 1) = r
      if (r <= 0.0_wp) then
        ! The part has come apart by itself.
        d(i + 1) = d(i + 1) - p
        e(last) = 0.0_wp
        return
      end if
      s = f/r
      c = g/r
      g = d(i + 1) - p
      r = (d(i) - g)*s + 2.0_wp*c*b
      p = s*r
      d(i + 1) = g + p
      g = c*r - b
      column = z(:, i + 1)
      z(:, i + 1) = s*z(:, i) + c*column
      z(:, i) = c*z(:, i) - s*column
    end do
    d(first) = d(first) - p
    e(first) = g
    e(last) = 0.0_wp
  end subroutine turn_once

  pure subroutine put_in_order(values, vectors)
    real(wp), intent(inout) :: values(:), vectors(:, :)

    real(wp) :: value, vector(size(vectors, 1))
    integer :: i, least

    do i = 1, size(values) - 1
      least = i - 1 + minloc(values(i:), dim=1)
      if (least == i) cycle
      value = values(i)
      values(i) = values(least)
      values(least) = value
      vector = vectors(:, i)
      vectors(:, i) = vectors(:, least)
      vectors(:, least) = vector
    end do
  end subroutine put_in_order

  !> `B = L Lᵀ`; only the lower triangle is read, and L replaces it.
  pure subroutine factor_full(b, info)
    real(wp), intent(inout) :: b(:, :)
    integer, intent(out) :: info !! 0, or the number of the first unknown up to which B is not positive definite

    integer :: i, j, n

    n = size(b, 1)
    do j = 1, n
      info = j
      b(j, j) = b(j, j) - dot_product(b(j, :j - 1), b(j, :j - 1))
      ! Not `<= 0`: NaN must not pass.
      if (.not. b(j, j) > 0.0_wp) return
      b(j, j) = sqrt(b(j, j))
      do i = j + 1, n
        b(i, j) = (b(i, j) - dot_product(b(i, :j - 1), b(j, :j - 1)))/b(j, j)
      end do
    end do
    info = 0
  end subroutine factor_full

  !> `A z = w B z` with `zᵀBz = 1`, as `L⁻¹ A L⁻ᵀ (Lᵀz) = w (Lᵀz)`. Of A and B the lower triangles are read.
  pure subroutine solve_generalized(a, b, values, vectors, info)
    real(wp), intent(in) :: a(:, :), b(:, :) !! (n, n)
    real(wp), intent(out) :: values(:)       !! (n) ascending
    real(wp), intent(out) :: vectors(:, :)   !! (n, n)
    integer, intent(out) :: info             !! as for LAPACK's dsygvx: above n for a B that is not positive definite

    real(wp) :: l(size(a, 1), size(a, 1)), c(size(a, 1), size(a, 1))
    integer :: i, j, n

    n = size(a, 1)
    l = b
    call factor_full(l, info)
    if (info > 0) then
      info = n + info
      values = 0.0_wp
      vectors = 0.0_wp
      return
    end if
    do j = 1, n
      c(j:, j) = a(j:, j)
      c(j, j:) = a(j:, j)
    end do
    do j = 1, n
      call solve_lower(l, c(:, j))
    end do
    c = transpose(c)
    do j = 1, n
      call solve_lower(l, c(:, j))
    end do
    c = 0.5_wp*(c + transpose(c))
    call solve_symmetric(c, values, vectors, info)
    do j = 1, n
      do i = n, 1, -1
        vectors(i, j) = (vectors(i, j) - dot_product(l(i + 1:, i), vectors(i + 1:, j)))/l(i, i)
      end do
    end do
  end subroutine solve_generalized

  !> Replaces x by `L⁻¹ x`.
  pure subroutine solve_lower(l, x)
    real(wp), intent(in) :: l(:, :)
    real(wp), intent(inout) :: x(:)

    integer :: i

    do i = 1, size(x)
      x(i) = x(i)/l(i, i)
      x(i + 1:) = x(i + 1:) - x(i)*l(i + 1:, i)
    end do
  end subroutine solve_lower

end module symmetric_eigensolver
