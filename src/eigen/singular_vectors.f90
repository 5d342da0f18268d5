!> Singular vectors that are accurate to their own last digits, however small their singular values
!! are beside the largest.
module singular_vectors
  use errors, only: error_of_numerics, error_t, set_error
  use kinds, only: wp
  use sorting, only: ascending_order
  use text, only: to_string
  implicit none (type, external)
  private

  public :: find_right_singular_vectors

  integer, parameter :: most_sweeps = 60

  !> Where columns are dependent, a column this small beside the whole matrix is only rounding [ε].
  real(wp), parameter :: no_column = 64.0_wp

contains

  !> Right singular vectors of a matrix, largest singular values first, by one-sided Jacobi
  !! rotations.
  !!
  !! Pairs of columns are rotated until all are perpendicular. Unlike methods that first reduce the
  !! matrix to bidiagonal form, this keeps the relative accuracy of small singular values (Demmel
  !! and Veselić, SIAM J. Matrix Anal. Appl. 13 (1992) 1204): the high vibrations of a link are as
  !! accurate as the low ones. LAPACK's dgesvj does the same, but raises floating-point exceptions,
  !! at which the debug build stops.
  !!
  !! Dependent columns end as zero except for rounding. Such remainders can never all be
  !! perpendicular, so they are left alone and their vectors are left out. Errors: no convergence.
  pure subroutine find_right_singular_vectors(matrix, vectors, error, rank)
    real(wp), intent(in) :: matrix(:, :)                !! (rows, columns) no fewer rows than
                                                        !! independent columns
    real(wp), allocatable, intent(out) :: vectors(:, :) !! (columns, independent columns)
    type(error_t), allocatable, intent(out) :: error    !! allocated on failure
    integer, intent(in), optional :: rank               !! number of independent columns; absent:
                                                        !! all

    real(wp) :: a(size(matrix, 1), size(matrix, 2)), squared(size(matrix, 2)), least
    integer :: i, j, sweep, n
    logical :: turned

    n = size(matrix, 2)
    allocate (vectors(n, n))
    vectors = 0.0_wp
    do i = 1, n
      vectors(i, i) = 1.0_wp
    end do
    a = matrix
    least = -1.0_wp
    if (present(rank)) then
      if (rank < n) least = (no_column*epsilon(1.0_wp))**2*sum(matrix**2)
    end if
    do sweep = 1, most_sweeps
      turned = .false.
      do i = 1, n - 1
        do j = i + 1, n
          call make_perpendicular(a(:, i), a(:, j), vectors(:, i), vectors(:, j), least, turned)
        end do
      end do
      if (.not. turned) exit
    end do
    if (turned .and. n > 1) then
      call set_error(error, error_of_numerics, "the own vibrations of a link were not found in "// &
        to_string(most_sweeps)//" sweeps of rotations")
      return
    end if
    squared = sum(a**2, dim=1)
    vectors = vectors(:, ascending_order(-squared))
    ! Thousands of rotations have changed the lengths in the last digits, all in the same direction.
    do i = 1, n
      vectors(:, i) = vectors(:, i)/norm2(vectors(:, i))
    end do
    if (present(rank)) vectors = vectors(:, :rank)
  end subroutine find_right_singular_vectors

  !> Rotates two columns, and the vectors with them, so that the columns are perpendicular to within
  !! rounding.
  pure subroutine make_perpendicular(first, second, first_vector, second_vector, least, turned)
    real(wp), intent(inout) :: first(:), second(:), first_vector(:), second_vector(:)
    real(wp), intent(in) :: least !! squared length up to which a column counts as zero
    logical, intent(inout) :: turned

    real(wp) :: length(2), product, slope, tangent, cosine, column(size(first)), &
      vector(size(first_vector))

    length = [dot_product(first, first), dot_product(second, second)]
    if (minval(length) <= least) return
    product = dot_product(first, second)
    if (abs(product) <= 4.0_wp*epsilon(1.0_wp)*sqrt(length(1))*sqrt(length(2))) return
    turned = .true.
    slope = (length(2) - length(1))/(2.0_wp*product)
    tangent = sign(1.0_wp, slope)/(abs(slope) + hypot(1.0_wp, slope))
    cosine = 1.0_wp/sqrt(1.0_wp + tangent**2)
    column = first
    first = cosine*(column - tangent*second)
    second = cosine*(second + tangent*column)
    vector = first_vector
    first_vector = cosine*(vector - tangent*second_vector)
    second_vector = cosine*(second_vector + tangent*vector)
  end subroutine make_perpendicular

end module singular_vectors
