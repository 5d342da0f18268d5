!> Symmetric band matrices in LAPACK's storage (`uplo = 'L'`).
module band_matrix
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: band_matrix_t, new_band_matrix, add_to_band, band_times_vector, full_matrix, &
    full_band, order_of, half_bandwidth_of

  !> `entry(1 + i - j, j) = A(i, j)` for `j ≤ i ≤ min(n, j + half bandwidth)`.
  type :: band_matrix_t
    real(wp), allocatable :: entry(:, :) !! (half bandwidth + 1, order)
  end type band_matrix_t

contains

  !> A zero matrix.
  pure function new_band_matrix(order, half_bandwidth) result(matrix)
    integer, intent(in) :: order          !! rows
    integer, intent(in) :: half_bandwidth !! subdiagonals
    type(band_matrix_t) :: matrix

    allocate (matrix%entry(half_bandwidth + 1, order))
    matrix%entry = 0.0_wp
  end function new_band_matrix

  !> Number of rows.
  pure function order_of(matrix) result(order)
    type(band_matrix_t), intent(in) :: matrix !! in band storage
    integer :: order

    order = size(matrix%entry, 2)
  end function order_of

  !> Number of subdiagonals.
  pure function half_bandwidth_of(matrix) result(half_bandwidth)
    type(band_matrix_t), intent(in) :: matrix !! in band storage
    integer :: half_bandwidth

    half_bandwidth = size(matrix%entry, 1) - 1
  end function half_bandwidth_of

  !> Adds a small symmetric matrix at the given unknowns; unknown 0 is a support and is skipped.
  pure subroutine add_to_band(matrix, small, unknown)
    type(band_matrix_t), intent(inout) :: matrix !! sum so far
    real(wp), intent(in) :: small(:, :)          !! (n, n)
    integer, intent(in) :: unknown(:)            !! (n) rows in the band matrix, 0 for a support

    integer :: i, j

    do j = 1, size(unknown)
      if (unknown(j) == 0) cycle
      do i = 1, size(unknown)
        if (unknown(i) < unknown(j)) cycle
        associate (entry => matrix%entry(1 + unknown(i) - unknown(j), unknown(j)))
          entry = entry + small(i, j)
        end associate
      end do
    end do
  end subroutine add_to_band

  !> `y = A x`
  pure function band_times_vector(matrix, x) result(y)
    type(band_matrix_t), intent(in) :: matrix !! A
    real(wp), intent(in) :: x(:)              !! (order)
    real(wp) :: y(size(x))

    integer :: i, j

    y = matrix%entry(1, :)*x
    do j = 1, size(x)
      do i = j + 1, min(size(x), j + half_bandwidth_of(matrix))
        y(i) = y(i) + matrix%entry(1 + i - j, j)*x(j)
        y(j) = y(j) + matrix%entry(1 + i - j, j)*x(i)
      end do
    end do
  end function band_times_vector

  !> The matrix with all its entries.
  pure function full_matrix(matrix) result(full)
    type(band_matrix_t), intent(in) :: matrix !! in band storage
    real(wp), allocatable :: full(:, :)       !! (order, order)

    integer :: i, j

    allocate (full(order_of(matrix), order_of(matrix)))
    full = 0.0_wp
    do j = 1, order_of(matrix)
      do i = j, min(order_of(matrix), j + half_bandwidth_of(matrix))
        full(i, j) = matrix%entry(1 + i - j, j)
        full(j, i) = full(i, j)
      end do
    end do
  end function full_matrix

  !> A full symmetric matrix in band storage of the largest width.
  pure function full_band(full) result(band)
    real(wp), intent(in) :: full(:, :) !! (order, order); only the lower triangle is read
    type(band_matrix_t) :: band

    integer :: j, n

    n = size(full, 1)
    band = new_band_matrix(n, n - 1)
    do j = 1, n
      band%entry(:n - j + 1, j) = full(j:, j)
    end do
  end function full_band

end module band_matrix
