!> Directions at right angles to the rows of a matrix, and the rows that give them best.
module orthogonal_complement
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: find_complement

contains

  !> Chooses as many rows as are wanted, those that are least dependent on each other, and finds
  !! orthonormal vectors at right angles to them: Householder's reflections of the transposed
  !! matrix, with the largest remaining row next (Businger and Golub 1965).
  pure subroutine find_complement(rows, rank, chosen, complement, smallest)
    real(wp), intent(in) :: rows(:, :)         !! (rows, n) of length one
    integer, intent(in) :: rank                !! rows wanted, below n
    integer, intent(out) :: chosen(:)          !! (rank) their numbers, ascending
    real(wp), intent(out) :: complement(:, :)  !! (n, n − rank)
    real(wp), intent(out) :: smallest          !! what is left of the last row at right angles to
                                               !! the others [-]; 0: fewer rows are independent

    real(wp) :: a(size(rows, 2), size(rows, 1)), v(size(rows, 2), rank), length
    integer :: order(size(rows, 1)), k, j, p, n

    n = size(rows, 2)
    a = transpose(rows)
    order = [(k, k=1, size(order))]
    v = 0.0_wp
    smallest = 0.0_wp
    do k = 1, rank
      p = k - 1 + maxloc([(sum(a(k:, j)**2), j=k, size(order))], dim=1)
      call swap(a(:, k), a(:, p))
      order([k, p]) = order([p, k])
      length = norm2(a(k:, k))
      smallest = length
      if (.not. length > 0.0_wp) exit
      v(k:, k) = a(k:, k)
      v(k, k) = v(k, k) + sign(length, a(k, k))
      v(k:, k) = v(k:, k)/norm2(v(k:, k))
      do j = k + 1, size(order)
        a(k:, j) = a(k:, j) - 2.0_wp*dot_product(v(k:, k), a(k:, j))*v(k:, k)
      end do
    end do
    do j = 1, n - rank
      complement(:, j) = 0.0_wp
      complement(rank + j, j) = 1.0_wp
      do k = rank, 1, -1
        complement(k:, j) = complement(k:, j) - 2.0_wp*dot_product(v(k:, k), complement(k:, j))* &
          v(k:, k)
      end do
    end do
    chosen = pack([(k, k=1, size(order))], [(any(order(:rank) == k), k=1, size(order))])
  end subroutine find_complement

  pure subroutine swap(a, b)
    real(wp), intent(inout) :: a(:), b(:)

    real(wp) :: other(size(a))

    other = a
    a = b
    b = other
  end subroutine swap

end module orthogonal_complement
