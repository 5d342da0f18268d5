!> Cholesky factors of symmetric positive definite band matrices, with readable error messages.
module cholesky_factor
  use band_matrix, only: band_matrix_t, half_bandwidth_of, order_of
  use errors, only: error_of_numerics, error_t, set_error
  use kinds, only: wp
  use lapack, only: dpbtrf, dpbtrs
  use text, only: to_string
  implicit none (type, external)
  private

  public :: factor_band, solve_with_factor

contains

  !> Replaces a matrix by its Cholesky factor. Errors: the matrix is not positive definite; the
  !! message gives the number of the unknown.
  pure subroutine factor_band(matrix, error)
    type(band_matrix_t), intent(inout) :: matrix     !! then its lower factor
    type(error_t), allocatable, intent(out) :: error !! allocated on failure

    integer :: info

    call dpbtrf("L", order_of(matrix), half_bandwidth_of(matrix), matrix%entry, &
      size(matrix%entry, 1), info)
    if (info /= 0) call set_error(error, error_of_numerics, &
      "the stiffness matrix is not positive definite at unknown "//to_string(info))
  end subroutine factor_band

  !> Replaces a right-hand side by the solution.
  pure subroutine solve_with_factor(factor, x)
    type(band_matrix_t), intent(in) :: factor   !! by `factor_band`
    real(wp), intent(inout), contiguous :: x(:) !! (unknowns)

    integer :: info

    ! dpbtrs fails only if its arguments have wrong shapes; here they come from the factor itself.
    call dpbtrs("L", order_of(factor), half_bandwidth_of(factor), 1, factor%entry, &
      size(factor%entry, 1), x, size(x), info)
  end subroutine solve_with_factor

end module cholesky_factor
