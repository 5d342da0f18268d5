!> LU factors of small dense matrices, with rows scaled and exchanged; solutions with the matrix and
!! with its transpose, and its determinant as a measure of how far it is from singular.
module dense_factor
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: dense_factor_t, factorize, solve, solve_transposed, least_singular_value

  !> `P S A = L U` with row scales S and exchanges P.
  type :: dense_factor_t
    real(wp), allocatable :: lu(:, :)      !! (n, n) L below the diagonal, U from it on
    real(wp), allocatable :: row_scale(:)  !! (n) reciprocals of the norms of the rows
    integer, allocatable :: pivot(:)       !! (n) row with which each is exchanged
    real(wp) :: determinant = 0.0_wp       !! of the matrix with rows of length one, in [−1, 1]; 0:
                                           !! singular
  end type dense_factor_t

contains

  !> Factors of a square matrix. A singular one has determinant 0; it must not be solved with.
  pure subroutine factorize(matrix, factor)
    real(wp), intent(in) :: matrix(:, :)         !! (n, n)
    type(dense_factor_t), intent(out) :: factor  !! its factors

    real(wp) :: row(size(matrix, 1))
    integer :: n, i, k, p

    n = size(matrix, 1)
    factor%lu = matrix
    allocate (factor%row_scale(n), factor%pivot(n))
    factor%determinant = 0.0_wp
    do i = 1, n
      factor%row_scale(i) = norm2(matrix(i, :))
      if (.not. factor%row_scale(i) > 0.0_wp) return
      factor%row_scale(i) = 1.0_wp/factor%row_scale(i)
      factor%lu(i, :) = factor%row_scale(i)*factor%lu(i, :)
    end do
    factor%determinant = 1.0_wp
    do k = 1, n
      p = k - 1 + maxloc(abs(factor%lu(k:, k)), dim=1)
      factor%pivot(k) = p
      if (p /= k) then
        row = factor%lu(k, :)
        factor%lu(k, :) = factor%lu(p, :)
        factor%lu(p, :) = row
        factor%determinant = -factor%determinant
      end if
      factor%determinant = factor%determinant*factor%lu(k, k)
      if (.not. abs(factor%lu(k, k)) > 0.0_wp) then
        factor%determinant = 0.0_wp
        return
      end if
      factor%lu(k + 1:, k) = factor%lu(k + 1:, k)/factor%lu(k, k)
      do i = k + 1, n
        factor%lu(k + 1:, i) = factor%lu(k + 1:, i) - factor%lu(k, i)*factor%lu(k + 1:, k)
      end do
    end do
  end subroutine factorize

  !> Solution x of `A x = b`.
  pure function solve(factor, b) result(x)
    type(dense_factor_t), intent(in) :: factor !! of A, not singular
    real(wp), intent(in) :: b(:)               !! (n)
    real(wp) :: x(size(b))

    real(wp) :: other
    integer :: k, n

    n = size(b)
    x = factor%row_scale*b
    do k = 1, n
      other = x(factor%pivot(k))
      x(factor%pivot(k)) = x(k)
      x(k) = other
    end do
    do k = 1, n
      x(k + 1:) = x(k + 1:) - x(k)*factor%lu(k + 1:, k)
    end do
    do k = n, 1, -1
      x(k) = x(k)/factor%lu(k, k)
      x(:k - 1) = x(:k - 1) - x(k)*factor%lu(:k - 1, k)
    end do
  end function solve

  !> Solution x of `Aᵀ x = b`.
  pure function solve_transposed(factor, b) result(x)
    type(dense_factor_t), intent(in) :: factor !! of A, not singular
    real(wp), intent(in) :: b(:)               !! (n)
    real(wp) :: x(size(b))

    real(wp) :: other
    integer :: k, n

    n = size(b)
    x = b
    do k = 1, n
      x(k) = (x(k) - dot_product(factor%lu(:k - 1, k), x(:k - 1)))/factor%lu(k, k)
    end do
    do k = n, 1, -1
      x(k) = x(k) - dot_product(factor%lu(k + 1:, k), x(k + 1:))
    end do
    do k = n, 1, -1
      other = x(factor%pivot(k))
      x(factor%pivot(k)) = x(k)
      x(k) = other
    end do
    x = factor%row_scale*x
  end function solve_transposed

  !> The smallest singular value of the matrix with rows of length one, with the sign of the
  !! determinant: by how much the rows are independent, however many there are. By inverse
  !! iteration with AᵀA.
  pure function least_singular_value(factor) result(value)
    type(dense_factor_t), intent(in) :: factor
    real(wp) :: value !! in [−1, 1]; 0: singular

    integer, parameter :: most_iterations = 50
    real(wp), parameter :: accuracy = 1.0e-10_wp
    real(wp) :: v(size(factor%lu, 1)), last
    integer :: i

    value = 0.0_wp
    if (.not. abs(factor%determinant) > 0.0_wp) return
    ! Not across any vector that geometry makes likely.
    v = [(1.0_wp + 0.37_wp*sin(2.3_wp*i), i=1, size(v))]
    v = v/norm2(v)
    do i = 1, most_iterations
      last = value
      v = solve_transposed(factor, v)/factor%row_scale
      v = solve(factor, v/factor%row_scale)
      value = 1.0_wp/sqrt(norm2(v))
      if (.not. value > 0.0_wp) exit
      v = v/norm2(v)
      if (abs(value - last) <= accuracy*value) exit
    end do
    value = sign(min(value, 1.0_wp), factor%determinant)
  end function least_singular_value

end module dense_factor
