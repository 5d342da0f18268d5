!> Products of rows of two matrices, column after column: arrays over the crank angle run along
!! their columns.
module row_products
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: products_of_rows

contains

  !> `Σ_j a(i, j) b(i, j)` for every row i.
  pure function products_of_rows(a, b) result(products)
    real(wp), intent(in) :: a(:, :), b(:, :) !! of one shape
    real(wp) :: products(size(a, 1))

    integer :: j

    products = 0.0_wp
    do j = 1, size(a, 2)
      products = products + a(:, j)*b(:, j)
    end do
  end function products_of_rows

end module row_products
