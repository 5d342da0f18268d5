!> The basis that makes a sum of squares of weighted rows the unit matrix, whatever their weights.
!!
!! Rows b_i with weights w_i and rows that must vanish, `g_k·p = 0`, in n unknowns p. Wanted are the
!! p for which `Σ (w_i b_i·p)² = |z|²`: the columns of `p = S z`, and the weighted rows `y = Q z`.
!! Rows are eliminated by size, each relative to itself, so that weights may differ by any number of
!! decades (Powell and Reid 1969; Cox and Higham, BIT 38 (1998) 34): LU of the sorted rows, and
!! where there are more rows than unknowns Cholesky factors of `I + FᵀF` with the other rows F in
!! terms of the pivot rows (Peters and Wilkinson, Comp. J. 13 (1970) 309).
module graded_rows
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: graded_rows_t, row_basis_t, find_row_basis

  !> A row of which less than this is left is a combination of those before, relative to its largest
  !! entry: geometry decides, not stiffness.
  real(wp), parameter :: least_rest = 1.0e-9_wp

  !> A row of which less than this is left is one exactly: what is left is round-off. It must not
  !! count by the weight of the row where only light rows hold what it would move.
  real(wp), parameter :: round_off = 64.0_wp*epsilon(1.0_wp)

  !> Multipliers up to which pivot rows that are given are kept, those of the rows as they are and
  !! those of weighted rows: a row that is no pivot must not be much heavier than those that are.
  real(wp), parameter :: most_growth = 100.0_wp

  !> Rows in unknowns that are about equally large.
  type :: graded_rows_t
    real(wp), allocatable :: constraint(:, :) !! (unknowns, constraints)
    real(wp), allocatable :: row(:, :)        !! (unknowns, rows)
    real(wp), allocatable :: weight(:)        !! (rows) positive
  end type graded_rows_t

  !> The basis. Its unknowns are z, then free ones that none of the rows feels.
  type :: row_basis_t
    integer :: free = 0                     !! the last unknowns of the basis: y does not depend on
                                            !! them
    integer :: idle_constraints = 0         !! constraints that follow from the others
    real(wp) :: least_pivot = 1.0_wp        !! what was left of a pivot row, per its largest entry
    real(wp), allocatable :: unknown(:, :)  !! (unknowns, basis) S
    real(wp), allocatable :: weighted(:, :) !! (rows, basis − free) Q, with orthonormal columns
    integer, allocatable :: primary(:)      !! (basis − free) the pivot rows, ascending
    !> (unknowns, constraints) p that violates each constraint by one, with all pivot rows at zero;
    !! zero of an idle one
    real(wp), allocatable :: violation(:, :)
    !> (rows, constraints) the weighted rows there: zero of pivot rows
    real(wp), allocatable :: weighted_violation(:, :)
    !> (constraints, idle constraints) c of combinations that vanish, `Σ c_k g_k = 0`
    real(wp), allocatable :: dependence(:, :)
  end type row_basis_t

contains

  !> Finds the basis. Pivot rows that are given are kept as long as they are good ones: the basis
  !! then turns as little as it can when the rows change.
  pure subroutine find_row_basis(rows, basis, primary, with_violations)
    type(graded_rows_t), intent(in) :: rows            !! constraints, rows, weights
    type(row_basis_t), intent(out) :: basis            !! of these rows
    integer, intent(in), optional :: primary(:)        !! rows to be pivots; absent or empty: any
    logical, intent(in), optional :: with_violations   !! also `violation` and `dependence`; absent:
                                                       !! no

    real(wp) :: work(size(rows%row, 1), size(rows%constraint, 2) + size(rows%row, 2))
    real(wp) :: scale(size(work, 2))
    integer :: pivot(size(work, 1)), column(size(work, 1)), pivots, i
    logical :: found

    do i = 1, size(rows%constraint, 2)
      work(:, i) = rows%constraint(:, i)
    end do
    do i = 1, size(rows%row, 2)
      work(:, size(rows%constraint, 2) + i) = rows%row(:, i)
    end do
    do i = 1, size(work, 2)
      scale(i) = maxval(abs(work(:, i)))
      if (scale(i) > 0.0_wp) work(:, i) = work(:, i)/scale(i)
    end do
    found = .false.
    if (present(primary)) then
      if (size(primary) > 0) call eliminate_given(rows, scale, primary, work, pivot, column, &
        pivots, found)
    end if
    if (.not. found) call eliminate_largest(rows, scale, work, pivot, column, pivots)
    call fill_basis(rows, scale, work, pivot, column, pivots, basis)
    if (.not. present(with_violations)) return
    if (.not. with_violations) return
    call fill_violations(rows, scale, work, pivot, column, pivots, basis)
    call fill_dependences(rows, scale, work, pivot, column, pivots, basis)
  end subroutine find_row_basis

  !> Constraints first, the largest of what is left of them; then rows, by the largest weighted
  !! entry that is left.
  pure subroutine eliminate_largest(rows, scale, work, pivot, column, pivots)
    type(graded_rows_t), intent(in) :: rows
    real(wp), intent(in) :: scale(:)
    real(wp), intent(inout) :: work(:, :)  !! rows become those of L and U
    integer, intent(inout) :: pivot(:), column(:) !! row and unknown of every step
    integer, intent(out) :: pivots         !! number of steps

    logical :: is_used(size(work, 2)), is_taken(size(work, 1))
    real(wp) :: left, size_of, largest
    integer :: i, r, stage, constraints

    is_used = .false.
    is_taken = .false.
    pivots = 0
    constraints = size(rows%constraint, 2)
    do stage = 1, 2
      do while (pivots < size(work, 1))
        largest = 0.0_wp
        r = 0
        do i = merge(1, constraints + 1, stage == 1), merge(constraints, size(work, 2), stage == 1)
          if (is_used(i)) cycle
          left = maxval(abs(work(:, i)), mask=.not. is_taken)
          if (left < least_rest) cycle
          size_of = left
          if (stage == 2) size_of = left*scale(i)*rows%weight(i - constraints)
          if (size_of <= largest) cycle
          largest = size_of
          r = i
        end do
        if (r == 0) exit
        call make_pivot(r, work, is_used, is_taken, pivot, column, pivots)
      end do
    end do
  end subroutine eliminate_largest

  !> Constraints, then the given rows by weight.
  pure subroutine eliminate_given(rows, scale, primary, work, pivot, column, pivots, found)
    type(graded_rows_t), intent(in) :: rows
    real(wp), intent(in) :: scale(:)
    integer, intent(in) :: primary(:)
    real(wp), intent(inout) :: work(:, :)
    integer, intent(inout) :: pivot(:), column(:)
    integer, intent(out) :: pivots
    logical, intent(out) :: found          !! false: they are bad pivots, and `work` is as before

    real(wp) :: before(size(work, 1), size(work, 2))
    integer :: order(size(primary)), i, k, r, constraints
    logical :: is_taken(size(work, 1)), is_used(size(work, 2))
    real(wp) :: largest

    before = work
    constraints = size(rows%constraint, 2)
    is_taken = .false.
    is_used = .false.
    pivots = 0
    found = .false.
    do k = 1, constraints
      r = 0
      largest = least_rest
      do i = 1, constraints
        if (is_used(i)) cycle
        if (maxval(abs(work(:, i)), mask=.not. is_taken) <= largest) cycle
        largest = maxval(abs(work(:, i)), mask=.not. is_taken)
        r = i
      end do
      if (r == 0) exit
      call make_pivot(r, work, is_used, is_taken, pivot, column, pivots)
    end do
    order = by_weight(rows%weight(primary))
    do k = 1, size(primary)
      r = constraints + primary(order(k))
      if (pivots == size(work, 1)) exit
      if (maxval(abs(work(:, r)), mask=.not. is_taken) < 1.0_wp/most_growth) then
        work = before
        return
      end if
      call make_pivot(r, work, is_used, is_taken, pivot, column, pivots)
      do i = constraints + 1, size(work, 2)
        if (is_used(i)) cycle
        if (abs(work(column(pivots), i))*scale(i)*rows%weight(i - constraints) <= &
          most_growth*scale(r)*rows%weight(r - constraints)) cycle
        work = before
        return
      end do
    end do
    ! Every other row has to be a combination of these.
    do i = constraints + 1, size(work, 2)
      if (is_used(i)) cycle
      if (pivots == size(work, 1)) exit
      if (maxval(abs(work(:, i)), mask=.not. is_taken) >= least_rest) then
        work = before
        return
      end if
    end do
    found = .true.
  end subroutine eliminate_given

  !> Makes a row the next pivot.
  pure subroutine make_pivot(row, work, is_used, is_taken, pivot, column, pivots)
    integer, intent(in) :: row
    real(wp), intent(inout) :: work(:, :)
    logical, intent(inout) :: is_used(:), is_taken(:) !! rows, unknowns
    integer, intent(inout) :: pivot(:), column(:), pivots

    integer :: i

    is_used(row) = .true.
    pivots = pivots + 1
    pivot(pivots) = row
    column(pivots) = maxloc(abs(work(:, row)), dim=1, mask=.not. is_taken)
    is_taken(column(pivots)) = .true.
    do i = 1, size(work, 2)
      if (is_used(i)) cycle
      call subtract(work(:, row), column(pivots), is_taken, work(:, i))
      if (maxval(abs(work(:, i)), mask=.not. is_taken) < round_off) work(:, i) = merge(work(:, i), &
        0.0_wp, is_taken)
    end do
  end subroutine make_pivot

  !> Numbers of the weights, the largest first.
  pure function by_weight(weight) result(order)
    real(wp), intent(in) :: weight(:)
    integer :: order(size(weight))

    integer :: i, k

    do i = 1, size(weight)
      k = 1 + count(weight > weight(i)) + count(weight(:i - 1) >= weight(i) .and. weight(:i - 1) &
        <= weight(i))
      order(k) = i
    end do
  end function by_weight

  !> Takes the pivot's unknown out of a row; the multiplier takes its place.
  pure subroutine subtract(pivot_row, column, is_taken, row)
    real(wp), intent(in) :: pivot_row(:)
    integer, intent(in) :: column
    logical, intent(in) :: is_taken(:)
    real(wp), intent(inout) :: row(:)

    real(wp) :: factor

    if (.not. abs(row(column)) > 0.0_wp) return
    factor = row(column)/pivot_row(column)
    where (.not. is_taken) row = row - factor*pivot_row
    row(column) = factor
  end subroutine subtract

  !> Solves `row_i·p = right_i` of the pivot rows, scaled as they were eliminated; other unknowns
  !! are given in p.
  pure subroutine solve(work, pivot, column, pivots, right, p)
    real(wp), intent(in) :: work(:, :)
    integer, intent(in) :: pivot(:), column(:), pivots
    real(wp), intent(inout) :: right(:)  !! (pivots) destroyed
    real(wp), intent(inout) :: p(:)      !! zero but for the unknowns that are no pivot's

    integer :: i, k

    do k = 1, pivots
      do i = 1, k - 1
        right(k) = right(k) - work(column(i), pivot(k))*right(i)
      end do
    end do
    call substitute_back(work, pivot, column, pivots, right, p)
  end subroutine solve

  !> S, Q and what is free.
  pure subroutine fill_basis(rows, scale, work, pivot, column, pivots, basis)
    type(graded_rows_t), intent(in) :: rows
    real(wp), intent(in) :: scale(:)
    real(wp), intent(in) :: work(:, :)
    integer, intent(in) :: pivot(:), column(:), pivots
    type(row_basis_t), intent(inout) :: basis

    real(wp) :: right(pivots)
    real(wp), allocatable :: other(:, :), factor(:, :)
    integer, allocatable :: rest(:), step(:)
    logical :: is_taken(size(work, 1)), is_primary(size(rows%row, 2))
    integer :: constraints, n, i, j, k, free

    constraints = size(rows%constraint, 2)
    is_primary = .false.
    do i = 1, pivots
      if (pivot(i) > constraints) is_primary(pivot(i) - constraints) = .true.
    end do
    basis%primary = pack([(i, i=1, size(is_primary))], is_primary)
    rest = pack([(i, i=1, size(is_primary))], .not. is_primary)
    n = size(basis%primary)
    basis%idle_constraints = constraints - (pivots - n)
    basis%free = size(work, 1) - pivots
    do i = 1, pivots
      basis%least_pivot = min(basis%least_pivot, abs(work(column(i), pivot(i))))
    end do
    allocate (basis%unknown(size(work, 1), n + basis%free), basis%weighted(size(rows%row, 2), n))
    allocate (step(n))
    do j = 1, n
      step(j) = findloc(pivot(:pivots), constraints + basis%primary(j), dim=1)
    end do
    basis%unknown = 0.0_wp
    do j = 1, n
      right = 0.0_wp
      i = basis%primary(j)
      right(step(j)) = 1.0_wp/(rows%weight(i)*scale(constraints + i))
      call solve(work, pivot, column, pivots, right, basis%unknown(:, j))
    end do
    is_taken = .false.
    is_taken(column(:pivots)) = .true.
    free = n
    do k = 1, size(work, 1)
      if (is_taken(k)) cycle
      free = free + 1
      basis%unknown(k, free) = 1.0_wp
      do i = 1, pivots
        right(i) = -work(k, pivot(i))
      end do
      ! The rows of U alone: their multipliers have been applied to this unknown.
      call substitute_back(work, pivot, column, pivots, right, basis%unknown(:, free))
    end do
    basis%weighted = 0.0_wp
    do j = 1, n
      basis%weighted(basis%primary(j), j) = 1.0_wp
    end do
    if (size(rest) == 0) return
    allocate (other(size(rest), n), factor(n, n))
    do i = 1, size(rest)
      right = shares_of(work, pivot, column, pivots, constraints + rest(i))
      do j = 1, n
        other(i, j) = right(step(j))*(rows%weight(rest(i))*scale(constraints + rest(i)))/ &
          (rows%weight(basis%primary(j))*scale(constraints + basis%primary(j)))
      end do
    end do
    factor = matmul(transpose(other), other)
    do j = 1, n
      factor(j, j) = factor(j, j) + 1.0_wp
    end do
    call factor_cholesky(factor)
    call divide_by_factor(factor, basis%unknown(:, :n))
    call divide_by_factor(factor, other)
    basis%weighted(rest, :) = other
    basis%weighted(basis%primary, :) = 0.0_wp
    do j = 1, n
      basis%weighted(basis%primary(j), j) = 1.0_wp
    end do
    other = basis%weighted(basis%primary, :)
    call divide_by_factor(factor, other)
    basis%weighted(basis%primary, :) = other
  end subroutine fill_basis

  !> Back substitution with U.
  pure subroutine substitute_back(work, pivot, column, pivots, right, p)
    real(wp), intent(in) :: work(:, :)
    integer, intent(in) :: pivot(:), column(:), pivots
    real(wp), intent(in) :: right(:)
    real(wp), intent(inout) :: p(:)

    real(wp) :: total
    integer :: i, k

    do k = pivots, 1, -1
      total = right(k)
      do i = k + 1, pivots
        total = total - work(column(i), pivot(k))*p(column(i))
      end do
      p(column(k)) = total/work(column(k), pivot(k))
    end do
  end subroutine substitute_back

  !> What violates one constraint only.
  pure subroutine fill_violations(rows, scale, work, pivot, column, pivots, basis)
    type(graded_rows_t), intent(in) :: rows
    real(wp), intent(in) :: scale(:)
    real(wp), intent(in) :: work(:, :)
    integer, intent(in) :: pivot(:), column(:), pivots
    type(row_basis_t), intent(inout) :: basis

    real(wp) :: right(pivots), share(pivots, size(rows%row, 2))
    integer :: i, k, r

    share = 0.0_wp
    do i = 1, size(rows%row, 2)
      if (.not. any(basis%primary == i)) share(:, i) = shares_of(work, pivot, column, pivots, &
        size(rows%constraint, 2) + i)
    end do
    allocate (basis%violation(size(work, 1), size(rows%constraint, 2)), &
      basis%weighted_violation(size(rows%row, 2), size(rows%constraint, 2)))
    basis%violation = 0.0_wp
    basis%weighted_violation = 0.0_wp
    do k = 1, size(rows%constraint, 2)
      r = findloc(pivot(:pivots), k, dim=1)
      if (r == 0) cycle
      right = 0.0_wp
      right(r) = 1.0_wp/scale(k)
      call solve(work, pivot, column, pivots, right, basis%violation(:, k))
      basis%weighted_violation(:, k) = rows%weight*scale(size(rows%constraint, 2) + 1:)* &
        share(r, :)/scale(k)
    end do
  end subroutine fill_violations

  !> How idle constraints follow from the others.
  pure subroutine fill_dependences(rows, scale, work, pivot, column, pivots, basis)
    type(graded_rows_t), intent(in) :: rows
    real(wp), intent(in) :: scale(:)
    real(wp), intent(in) :: work(:, :)
    integer, intent(in) :: pivot(:), column(:), pivots
    type(row_basis_t), intent(inout) :: basis

    real(wp) :: share(pivots)
    integer :: i, k, n, constraints

    constraints = size(rows%constraint, 2)
    allocate (basis%dependence(constraints, basis%idle_constraints), source=0.0_wp)
    n = 0
    do i = 1, constraints
      if (any(pivot(:pivots) == i)) cycle
      n = n + 1
      ! Constraints are the first pivots.
      share = shares_of(work, pivot, column, pivots, i)
      do k = 1, constraints - basis%idle_constraints
        basis%dependence(pivot(k), n) = -share(k)/scale(pivot(k))
      end do
      basis%dependence(i, n) = 1.0_wp
      if (scale(i) > 0.0_wp) basis%dependence(i, n) = 1.0_wp/scale(i)
    end do
  end subroutine fill_dependences

  !> How a row that is no pivot follows from those that are, all scaled as they were eliminated: it
  !! is the sum of its multipliers times the rows of U, and these follow from the pivot rows
  !! likewise. What was nothing in the elimination stays nothing, however heavy the row.
  pure function shares_of(work, pivot, column, pivots, row) result(share)
    real(wp), intent(in) :: work(:, :)
    integer, intent(in) :: pivot(:), column(:), pivots
    integer, intent(in) :: row
    real(wp) :: share(pivots)

    integer :: j, k

    do j = pivots, 1, -1
      share(j) = work(column(j), row)
      do k = j + 1, pivots
        share(j) = share(j) - share(k)*work(column(j), pivot(k))
      end do
    end do
  end function shares_of

  !> Lower Cholesky factor C of a matrix that is at least the unit matrix, in its lower triangle.
  pure subroutine factor_cholesky(matrix)
    real(wp), intent(inout) :: matrix(:, :)

    integer :: i, j, k

    do j = 1, size(matrix, 1)
      do k = 1, j - 1
        do i = j, size(matrix, 1)
          matrix(i, j) = matrix(i, j) - matrix(i, k)*matrix(j, k)
        end do
      end do
      matrix(j, j) = sqrt(matrix(j, j))
      matrix(j + 1:, j) = matrix(j + 1:, j)/matrix(j, j)
    end do
  end subroutine factor_cholesky

  !> `A C⁻ᵀ` in place of A.
  pure subroutine divide_by_factor(factor, a)
    real(wp), intent(in) :: factor(:, :)
    real(wp), intent(inout) :: a(:, :) !! (any, n)

    integer :: j, k

    do j = 1, size(factor, 1)
      do k = 1, j - 1
        a(:, j) = a(:, j) - factor(j, k)*a(:, k)
      end do
      a(:, j) = a(:, j)/factor(j, j)
    end do
  end subroutine divide_by_factor

end module graded_rows
