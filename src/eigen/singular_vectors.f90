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

  !> Up to this number of columns rotations start from the matrix itself.
  integer, parameter :: few_columns = 24

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
  !! perpendicular, so they are left alone and their vectors are left out.
  !!
  !! Of many columns, vectors that are nearly right are found first, from the triangular factor of
  !! the matrix, whose rows are nearly perpendicular (Drmač and Veselić, SIAM J. Matrix Anal. Appl.
  !! 29 (2008) 1322): that takes a quarter of the rotations. The rotations of the matrix itself end
  !! in any case when its columns are perpendicular. Errors: no convergence.
  pure subroutine find_right_singular_vectors(matrix, vectors, error, rank)
    real(wp), intent(in) :: matrix(:, :)                !! (rows, columns) no fewer rows than
                                                        !! independent columns
    real(wp), allocatable, intent(out) :: vectors(:, :) !! (columns, independent columns)
    type(error_t), allocatable, intent(out) :: error    !! allocated on failure
    integer, intent(in), optional :: rank               !! number of independent columns; absent:
                                                        !! all

    real(wp), allocatable :: a(:, :)
    real(wp) :: least
    integer :: i, n

    n = size(matrix, 2)
    if (present(rank)) n = rank
    least = -1.0_wp
    if (size(matrix, 2) > few_columns) then
      call find_starts(matrix, n, vectors, error)
      if (allocated(error)) return
      a = matmul(matrix, vectors)
    else
      n = size(matrix, 2)
      allocate (vectors(n, n))
      vectors = 0.0_wp
      do i = 1, n
        vectors(i, i) = 1.0_wp
      end do
      a = matrix
      if (present(rank)) then
        if (rank < n) least = (no_column*epsilon(1.0_wp))**2*sum(matrix**2)
      end if
    end if
    call rotate(a, vectors, least, error)
    if (allocated(error)) return
    vectors = vectors(:, ascending_order(-sum(a**2, dim=1)))
    ! Thousands of rotations have changed the lengths in the last digits, all in the same direction.
    do i = 1, n
      vectors(:, i) = vectors(:, i)/norm2(vectors(:, i))
    end do
    if (present(rank)) vectors = vectors(:, :rank)
  end subroutine find_right_singular_vectors

  !> Rotates pairs of columns, and the vectors with them, until all are perpendicular.
  pure subroutine rotate(a, vectors, least, error)
    real(wp), intent(inout) :: a(:, :)       !! (rows, columns)
    real(wp), intent(inout) :: vectors(:, :) !! (any number, columns)
    real(wp), intent(in) :: least            !! squared length up to which a column counts as zero
    type(error_t), allocatable, intent(out) :: error

    integer :: i, j, sweep
    logical :: turned

    do sweep = 1, most_sweeps
      turned = .false.
      do i = 1, size(a, 2) - 1
        do j = i + 1, size(a, 2)
          call make_perpendicular(a(:, i), a(:, j), vectors(:, i), vectors(:, j), least, turned)
        end do
      end do
      if (.not. turned) return
    end do
    if (size(a, 2) > 1) call set_error(error, error_of_numerics, &
      "the vibrations of a single link were not found in "//to_string(most_sweeps)// &
      " sweeps of rotations")
  end subroutine rotate

  !> Vectors near the right singular vectors. With `A P = Q R`, the right ones of A are the left
  !! ones of `P Rᵀ`: its columns, once rotations have made them perpendicular.
  pure subroutine find_starts(matrix, rank, vectors, error)
    real(wp), intent(in) :: matrix(:, :)
    integer, intent(in) :: rank                         !! number of independent columns
    real(wp), allocatable, intent(out) :: vectors(:, :) !! (columns, rank) of unit length
    type(error_t), allocatable, intent(out) :: error

    real(wp) :: r(size(matrix, 1), size(matrix, 2)), none(0, rank)
    real(wp), allocatable :: turned(:, :)
    integer :: order(size(matrix, 2)), i, j

    r = matrix
    call reduce_to_triangle(r, rank, order)
    allocate (turned(size(matrix, 2), rank))
    turned = 0.0_wp
    do i = 1, rank
      do j = i, size(matrix, 2)
        turned(order(j), i) = r(i, j)
      end do
    end do
    call rotate(turned, none, -1.0_wp, error)
    if (allocated(error)) return
    do i = 1, rank
      turned(:, i) = turned(:, i)/norm2(turned(:, i))
    end do
    call move_alloc(turned, vectors)
  end subroutine find_starts

  !> `A P = Q R` by Householder's reflections, the longest remaining column next.
  pure subroutine reduce_to_triangle(a, rank, order)
    real(wp), intent(inout) :: a(:, :)     !! A; its upper triangle becomes that of R
    integer, intent(in) :: rank            !! columns to be reduced
    integer, intent(out) :: order(:)       !! (columns) P: number in A of each column of R

    real(wp) :: mirror(size(a, 1)), column(size(a, 1)), length, factor
    integer :: j, k, next

    order = [(k, k=1, size(a, 2))]
    do k = 1, rank
      next = k - 1 + maxloc(sum(a(k:, k:)**2, dim=1), dim=1)
      column = a(:, k)
      a(:, k) = a(:, next)
      a(:, next) = column
      order([k, next]) = order([next, k])
      length = norm2(a(k:, k))
      if (length <= 0.0_wp) return
      mirror(k:) = a(k:, k)
      mirror(k) = mirror(k) + sign(length, mirror(k))
      factor = 2.0_wp/dot_product(mirror(k:), mirror(k:))
      do j = k, size(a, 2)
        a(k:, j) = a(k:, j) - factor*dot_product(mirror(k:), a(k:, j))*mirror(k:)
      end do
    end do
  end subroutine reduce_to_triangle

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
