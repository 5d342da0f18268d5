!> Products of rows of two matrices, column after column: arrays over the crank angle run along
!! their columns.
module row_products
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: products_of_rows, sum_of_products

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

end module row_products
