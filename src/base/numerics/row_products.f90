!> Products of matrices that arrays hold row by row: arrays over the crank angle run along their
!! columns, and every sample has a matrix of its own.
module row_products
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: products_of_rows, sum_of_products, add_products, gather, scatter, together

  !> Samples whose matrices are gathered together: a line of the memory holds so many numbers.
  integer, parameter :: together = 8

contains

  !> `Σ_j a(i, j) b(i, j)` for every row i.
  pure function products_of_rows(a, b) result(products)
    real(wp), intent(in) :: a(:, :), b(:, :) !! of one shape
    real(wp) :: products(size(a, 1))

    integer :: j

    products = 0.0_wp
    ! Four at once: the sums are in memory, and go there and back once.
    do j = 1, size(a, 2) - 3, 4
      products = products + a(:, j)*b(:, j) + a(:, j + 1)*b(:, j + 1) + &
        a(:, j + 2)*b(:, j + 2) + a(:, j + 3)*b(:, j + 3)
    end do
    do j = size(a, 2) - modulo(size(a, 2), 4) + 1, size(a, 2)
      products = products + a(:, j)*b(:, j)
    end do
  end function products_of_rows

  !> `Σ a(i, j) b(i, j)` over all: a sum for every row first, since one sum for all waits for
  !! itself.
  pure function sum_of_products(a, b) result(total)
    real(wp), intent(in) :: a(:, :), b(:, :) !! of one shape
    real(wp) :: total

    total = sum(products_of_rows(a, b))
  end function sum_of_products

  !> Adds `AᵀB` of every sample.
  pure subroutine add_products(a, b, total)
    real(wp), intent(in) :: a(:, :, :)       !! (samples, rows, m)
    real(wp), intent(in) :: b(:, :, :)       !! (samples, rows, n)
    real(wp), intent(inout) :: total(:, :)   !! (samples, m n)

    real(wp), allocatable :: left(:, :, :), right(:, :, :), product(:, :)
    integer :: i, j, k, first, last, m, n

    m = size(a, 3)
    n = size(b, 3)
    allocate (left(m, size(a, 2), together), right(size(b, 2), n, together), product(m, n))
    do first = 1, size(a, 1), together
      last = min(first + together - 1, size(a, 1))
      do j = 1, size(a, 2)
        do i = 1, m
          left(i, j, :last - first + 1) = a(first:last, j, i)
        end do
      end do
      call gather(b, first, last, right)
      do k = first, last
        product = matmul(left(:, :, k - first + 1), right(:, :, k - first + 1))
        do j = 1, n
          total(k, (j - 1)*m + 1:j*m) = total(k, (j - 1)*m + 1:j*m) + product(:, j)
        end do
      end do
    end do
  end subroutine add_products

  !> The matrices of some samples.
  pure subroutine gather(a, first, last, matrices)
    real(wp), intent(in) :: a(:, :, :)           !! (samples, rows, columns)
    integer, intent(in) :: first, last           !! of the samples
    real(wp), intent(inout) :: matrices(:, :, :) !! (rows, columns, samples)

    integer :: i, j

    do j = 1, size(a, 3)
      do i = 1, size(a, 2)
        matrices(i, j, :last - first + 1) = a(first:last, i, j)
      end do
    end do
  end subroutine gather

  !> Puts the matrices of some samples back.
  pure subroutine scatter(matrices, first, last, a)
    real(wp), intent(in) :: matrices(:, :, :) !! (rows, columns, samples)
    integer, intent(in) :: first, last        !! of the samples
    real(wp), intent(inout) :: a(:, :, :)     !! (samples, rows, columns)

    integer :: i, j

    do j = 1, size(a, 3)
      do i = 1, size(a, 2)
        a(first:last, i, j) = matrices(i, j, :last - first + 1)
      end do
    end do
  end subroutine scatter

end module row_products
