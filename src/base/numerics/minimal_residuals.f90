!> GMRES: the combination of products of a linear operator that leaves the smallest residual (Saad
!! and Schultz, SIAM J. Sci. Stat. Comput. 7 (1986) 856). The caller applies the operator.
module minimal_residuals
  use kinds, only: wp
  use row_products, only: sum_of_products
  implicit none (type, external)
  private

  public :: minimal_residual_t, start_residual, add_product, add_combination

  !> The products so far, made orthonormal.
  type :: minimal_residual_t
    real(wp), allocatable :: vector(:, :, :) !! (rows, columns, products + 1)
    integer :: last = 0                      !! number of the vector to which the operator is to be
                                             !! applied next
    real(wp) :: residual = 0.0_wp            !! norm of the smallest residual so far
    real(wp), private, allocatable :: h(:, :), rotation(:, :), right(:)
  end type minimal_residual_t

contains

  !> Begins with a residual.
  pure subroutine start_residual(residual, most, problem)
    real(wp), intent(in) :: residual(:, :)          !! not zero
    integer, intent(in) :: most                     !! number of products
    type(minimal_residual_t), intent(out) :: problem !! with the first vector

    allocate (problem%vector(size(residual, 1), size(residual, 2), most + 1))
    allocate (problem%h(most + 1, most), problem%rotation(2, most), problem%right(most + 1))
    problem%h = 0.0_wp
    problem%right = 0.0_wp
    problem%residual = norm2(residual)
    problem%right(1) = problem%residual
    problem%vector(:, :, 1) = residual/problem%residual
    problem%last = 1
  end subroutine start_residual

  !> Takes in the product of the operator with the last vector.
  pure subroutine add_product(problem, product)
    type(minimal_residual_t), intent(inout) :: problem
    real(wp), intent(inout) :: product(:, :) !! overwritten

    real(wp) :: length
    integer :: i, k

    k = problem%last
    associate (h => problem%h(:, k), rotation => problem%rotation)
      do i = 1, k
        h(i) = sum_of_products(problem%vector(:, :, i), product)
        product = product - h(i)*problem%vector(:, :, i)
      end do
      h(k + 1) = sqrt(sum_of_products(product, product))
      if (h(k + 1) > 0.0_wp) product = product/h(k + 1)
      problem%vector(:, :, k + 1) = product
      do i = 1, k - 1
        h(i:i + 1) = [rotation(1, i)*h(i) + rotation(2, i)*h(i + 1), &
          -rotation(2, i)*h(i) + rotation(1, i)*h(i + 1)]
      end do
      length = hypot(h(k), h(k + 1))
      rotation(:, k) = [h(k), h(k + 1)]/length
      h(k:k + 1) = [length, 0.0_wp]
      problem%right(k + 1) = -rotation(2, k)*problem%right(k)
      problem%right(k) = rotation(1, k)*problem%right(k)
    end associate
    problem%residual = abs(problem%right(k + 1))
    problem%last = k + 1
  end subroutine add_product

  !> Adds the combination of vectors that leaves the smallest residual.
  pure subroutine add_combination(problem, y)
    type(minimal_residual_t), intent(in) :: problem
    real(wp), intent(inout) :: y(:, :)

    real(wp) :: weight(problem%last - 1)
    integer :: k, n

    n = problem%last - 1
    do k = n, 1, -1
      weight(k) = (problem%right(k) - dot_product(problem%h(k, k + 1:n), weight(k + 1:n)))/ &
        problem%h(k, k)
    end do
    do k = 1, n
      y = y + weight(k)*problem%vector(:, :, k)
    end do
  end subroutine add_combination

end module minimal_residuals
