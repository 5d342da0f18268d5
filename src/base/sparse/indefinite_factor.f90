!> `L D Lᵀ` factors of sums of symmetric element matrices, definite or not; the number of negative
!! eigenvalues; solutions.
!!
!! Fronts of a plan one after the other. Pivots are single diagonal entries or pairs with what
!! couples them, the largest first that let no multiplier grow beyond a bound; what finds none
!! is left to the next front (Duff and Reid, ACM TOMS 9 (1983) 302; Duff, ACM TOMS 30 (2004) 118).
module indefinite_factor
  use element_matrices, only: elements_t
  use elimination_plan, only: elimination_plan_t
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: indefinite_factor_t, factorize, solve

  interface reserve
    module procedure :: reserve_integers, reserve_values
  end interface reserve

  interface solve
    module procedure :: solve_columns, solve_column
  end interface solve

  !> A pivot is at least this much of the rest of its column; pairs alike. Errors of 0.3 are a third
  !! of those of 0.1, and time is a twentieth more.
  real(wp), parameter :: threshold = 0.3_wp

  !> The largest diagonal entry is a pivot from this much of the largest of all entries on (Bunch
  !! and Parlett, SIAM J. Numer. Anal. 8 (1971) 639): (1 + √17)/8.
  real(wp), parameter :: balance = 0.6403882032022076_wp

  !> A pivot that is less is zero, and is given the second value; largest entries are about 1. No
  !! round-off is as small, even where rows are graded, and no solution overflows.
  real(wp), parameter :: zero_pivot = epsilon(1.0_wp)**4, moved_pivot = epsilon(1.0_wp)**2

  !> Factors. Storage is kept for the next matrix with the same plan.
  type :: indefinite_factor_t
    integer :: negative = 0                   !! negative eigenvalues
    integer :: delayed = 0                    !! pivots left to a next front, counted each time
    integer :: moved = 0                      !! pivots of zero that were moved off it
    real(wp) :: least_pivot = 0.0_wp          !! of the scaled matrix: of single pivots, and of
                                              !! √|determinant| of pairs
    real(wp) :: largest_pivot = 0.0_wp        !! likewise
    real(wp), allocatable :: scale(:)         !! (unknowns) powers of 2, by which rows and columns
                                              !! are multiplied; largest entries are then about 1
    integer, allocatable :: summed(:)         !! (fronts) candidates for pivots: delayed to the
                                              !! front, and its own
    integer, allocatable :: pivots(:)         !! (fronts) of these, eliminated
    integer, allocatable :: row_first(:)      !! (fronts + 1) first row
    integer, allocatable :: row(:)            !! unknowns: pivots, candidates left over, boundary
    integer, allocatable :: panel_first(:)    !! (fronts) first entry
    real(wp), allocatable :: panel(:)         !! (rows, pivots) of each front: L below the diagonal
    real(wp), allocatable :: pivot(:, :)      !! (2, unknowns) diagonal of D; the entry below it,
                                              !! not 0 of the first of a pair
    real(wp), allocatable :: stack(:)         !! what fronts left, lower triangles (rows, rows)
  end type indefinite_factor_t

contains

  !> Factors of a sum of elements.
  pure subroutine factorize(plan, elements, value, factor)
    type(elimination_plan_t), intent(in) :: plan
    type(elements_t), intent(in) :: elements           !! those of the plan
    real(wp), intent(in), contiguous :: value(:)       !! their values
    type(indefinite_factor_t), intent(inout) :: factor !! of any matrix before; becomes that of this

    integer :: f, k, n, delayed, eliminated, height, first

    call prepare(plan, factor)
    call balance_rows(elements, value, factor%scale)
    first = 1
    eliminated = 0
    height = 0
    do f = 1, plan%fronts
      call list_rows(plan, f, factor, delayed, n)
      factor%delayed = factor%delayed + delayed
      factor%panel_first(f) = first
      call reserve(factor%panel, first + n*n)
      call assemble(plan, elements, value, factor%scale, f, n, delayed, factor%summed, &
        factor%pivots, factor%stack, height, factor%panel(first))
      associate (top => factor%row_first(f), pivots => factor%pivots(f))
        call eliminate(n, factor%summed(f), plan%parent(f) == 0, factor%panel(first), &
          factor%row(top:top + n - 1), factor%pivot(:, eliminated + 1:), pivots, factor%moved)
        k = n - pivots
        call reserve(factor%stack, height + k*k)
        call push_rest(n, pivots, factor%panel(first), factor%stack(height + 1:height + k*k))
        height = height + k*k
        first = first + n*pivots
        eliminated = eliminated + pivots
      end associate
    end do
    call describe_pivots(factor)
  end subroutine factorize

  !> The solution of `A x = b`.
  pure subroutine solve_column(plan, factor, x)
    type(elimination_plan_t), intent(in) :: plan
    type(indefinite_factor_t), intent(in) :: factor !! of A
    real(wp), intent(inout) :: x(:)                 !! (unknowns) b; becomes x

    real(wp) :: column(size(x), 1)

    column(:, 1) = x
    call solve_columns(plan, factor, column)
    x = column(:, 1)
  end subroutine solve_column

  !> Solutions of `A x = b`.
  pure subroutine solve_columns(plan, factor, x)
    type(elimination_plan_t), intent(in) :: plan
    type(indefinite_factor_t), intent(in) :: factor !! of A
    real(wp), intent(inout) :: x(:, :)              !! (unknowns, any) b; becomes x

    real(wp), allocatable :: part(:)
    integer :: c, f, first, n, pivots

    allocate (part(maxval(factor%row_first(2:) - factor%row_first(:plan%fronts))))
    do c = 1, size(x, 2)
      x(:, c) = factor%scale*x(:, c)
    end do
    do f = 1, plan%fronts
      associate (row => factor%row(factor%row_first(f):factor%row_first(f + 1) - 1))
        n = size(row)
        do c = 1, size(x, 2)
          part(:n) = x(row, c)
          call solve_lower(n, factor%pivots(f), factor%panel(factor%panel_first(f)), part)
          x(row, c) = part(:n)
        end do
      end associate
    end do
    first = plan%unknowns + 1
    do f = plan%fronts, 1, -1
      pivots = factor%pivots(f)
      first = first - pivots
      associate (row => factor%row(factor%row_first(f):factor%row_first(f + 1) - 1))
        n = size(row)
        do c = 1, size(x, 2)
          part(:n) = x(row, c)
          call solve_upper(n, pivots, factor%panel(factor%panel_first(f)), &
            factor%pivot(:, first:), part)
          x(row(:pivots), c) = part(:pivots)
        end do
      end associate
    end do
    do c = 1, size(x, 2)
      x(:, c) = factor%scale*x(:, c)
    end do
  end subroutine solve_columns

  !> Storage as far as the plan tells, the first time; counts at zero.
  pure subroutine prepare(plan, factor)
    type(elimination_plan_t), intent(in) :: plan
    type(indefinite_factor_t), intent(inout) :: factor

    factor%negative = 0
    factor%delayed = 0
    factor%moved = 0
    if (allocated(factor%pivots)) then
      if (size(factor%pivots) == plan%fronts .and. size(factor%pivot, 2) == plan%unknowns) return
      deallocate (factor%summed, factor%pivots, factor%row_first, factor%row, factor%panel_first, &
        factor%panel, factor%pivot, factor%stack, factor%scale)
    end if
    allocate (factor%summed(plan%fronts), factor%pivots(plan%fronts), factor%row(size(plan%row)), &
      factor%row_first(plan%fronts + 1), factor%panel_first(plan%fronts), factor%panel(1), &
      factor%pivot(2, plan%unknowns), factor%stack(1), factor%scale(plan%unknowns))
    factor%row_first(1) = 1
  end subroutine prepare

  !> Scales with which the largest entries of all rows are about 1, but for rows of zeros: a few
  !! rounds divide every row and column by the root of its largest entry (Ruiz, RAL-TR-2001-034).
  !! Without, graded rows find no pivots, and fronts grow.
  pure subroutine balance_rows(elements, value, factor)
    type(elements_t), intent(in) :: elements
    real(wp), intent(in), contiguous :: value(:)
    real(wp), intent(out) :: factor(:)           !! (unknowns) powers of 2

    integer, parameter :: most_rounds = 5        !! 20 decades are then less than one
    integer, parameter :: even = 6               !! this power of 2 and its inverse: the last round
    real(wp) :: largest(size(factor))
    integer :: e, n, round, farthest, power, u

    factor = 1.0_wp
    do round = 1, most_rounds
      largest = 0.0_wp
      do e = 1, size(elements%first) - 1
        n = elements%first(e + 1) - elements%first(e)
        call find_largest(n, value(elements%value_first(e):), &
          elements%unknown(elements%first(e):), factor, largest)
      end do
      farthest = 0
      do u = 1, size(factor)
        power = exponent(largest(u)*factor(u))
        if (abs(power) < 2) cycle
        factor(u) = scale(factor(u), -power/2)
        farthest = max(farthest, abs(power))
      end do
      if (farthest <= even) exit
    end do
  end subroutine balance_rows

  !> The largest entry of every row of an element, with scaled columns, if it is larger.
  pure subroutine find_largest(n, a, unknown, factor, largest)
    integer, intent(in) :: n
    real(wp), intent(in) :: a(n, n)
    integer, intent(in) :: unknown(n)
    real(wp), intent(in) :: factor(:)
    real(wp), intent(inout) :: largest(:)

    real(wp) :: most(n)
    integer :: j

    most = 0.0_wp
    do j = 1, n
      most = max(most, abs(a(:, j))*factor(unknown(j)))
    end do
    largest(unknown) = max(largest(unknown), most)
  end subroutine find_largest

  !> Rows of a front: what its children could not eliminate, then those of the plan.
  pure subroutine list_rows(plan, front, factor, delayed, n)
    type(elimination_plan_t), intent(in) :: plan
    integer, intent(in) :: front
    type(indefinite_factor_t), intent(inout) :: factor
    integer, intent(out) :: delayed, n !! unknowns from children; all rows

    integer :: first, c, i, k, left

    first = factor%row_first(front)
    delayed = 0
    do k = plan%child_first(front), plan%child_first(front + 1) - 1
      c = plan%child(k)
      delayed = delayed + factor%summed(c) - factor%pivots(c)
    end do
    factor%summed(front) = delayed + plan%own(front)
    n = delayed + plan%row_first(front + 1) - plan%row_first(front)
    factor%row_first(front + 1) = first + n
    call reserve(factor%row, first + n - 1)
    i = first
    do k = plan%child_first(front), plan%child_first(front + 1) - 1
      c = plan%child(k)
      left = factor%summed(c) - factor%pivots(c)
      factor%row(i:i + left - 1) = factor%row(factor%row_first(c) + factor%pivots(c): &
        factor%row_first(c) + factor%summed(c) - 1)
      i = i + left
    end do
    factor%row(i:first + n - 1) = plan%row(plan%row_first(front):plan%row_first(front + 1) - 1)
  end subroutine list_rows

  !> The sum of what a front takes: lower triangle, and all of the columns of candidates.
  pure subroutine assemble(plan, elements, value, scale, f, n, delayed, summed, pivots, stack, &
    height, front)
    type(elimination_plan_t), intent(in) :: plan
    type(elements_t), intent(in) :: elements
    real(wp), intent(in), contiguous :: value(:)
    real(wp), intent(in) :: scale(:)              !! (unknowns)
    integer, intent(in) :: f, n, delayed          !! the front, its rows, its delayed ones
    integer, intent(in) :: summed(:), pivots(:)   !! of fronts
    real(wp), intent(in), contiguous :: stack(:)
    integer, intent(inout) :: height              !! of the stack: what is taken is dropped
    real(wp), intent(out) :: front(n, n)

    real(wp) :: factor(n)
    integer :: place(n), c, e, first, i, j, k, left, rows, from_delayed

    front = 0.0_wp
    do k = plan%element_first(f), plan%element_first(f + 1) - 1
      e = plan%element(k)
      first = elements%first(e)
      rows = elements%first(e + 1) - first
      place(:rows) = delayed + plan%entry_row(first:first + rows - 1)
      factor(:rows) = scale(elements%unknown(first - 1 + plan%entry(first:first + rows - 1)))
      call add_element(rows, value(elements%value_first(e):), factor, plan%entry(first), place, n, &
        front)
    end do
    do k = plan%child_first(f), plan%child_first(f + 1) - 1
      c = plan%child(k)
      height = height - order_left(plan, c, summed, pivots)**2
    end do
    i = height
    from_delayed = 0
    do k = plan%child_first(f), plan%child_first(f + 1) - 1
      c = plan%child(k)
      rows = order_left(plan, c, summed, pivots)
      left = summed(c) - pivots(c)
      do j = 1, left
        place(j) = from_delayed + j
      end do
      place(left + 1:rows) = delayed + &
        plan%place(plan%row_first(c) + plan%own(c):plan%row_first(c + 1) - 1)
      if (rows > 0) call add_rest(rows, stack(i + 1:), place, n, front)
      i = i + rows**2
      from_delayed = from_delayed + left
    end do
    do j = 2, summed(f)
      front(:j - 1, j) = front(j, :j - 1)
    end do
  end subroutine assemble

  !> Rows that a front left.
  pure function order_left(plan, f, summed, pivots) result(rows)
    type(elimination_plan_t), intent(in) :: plan
    integer, intent(in) :: f, summed(:), pivots(:)
    integer :: rows

    rows = summed(f) - pivots(f) + plan%row_first(f + 1) - plan%row_first(f) - plan%own(f)
  end function order_left

  !> Adds an element to the lower triangle of a front.
  pure subroutine add_element(rows, a, factor, entry, place, n, front)
    integer, intent(in) :: rows, n
    real(wp), intent(in) :: a(rows, rows), factor(rows)  !! the element, scales by rows
    integer, intent(in) :: entry(rows), place(rows)      !! its entries by rows, ascending; the rows
    real(wp), intent(inout) :: front(n, n)

    integer :: i, j

    do j = 1, rows
      do i = j, rows
        front(place(i), place(j)) = front(place(i), place(j)) + &
          a(entry(i), entry(j))*(factor(i)*factor(j))
      end do
    end do
  end subroutine add_element

  !> Adds what another front left.
  pure subroutine add_rest(rows, a, place, n, front)
    integer, intent(in) :: rows, n
    real(wp), intent(in) :: a(rows, rows)  !! lower triangle
    integer, intent(in) :: place(rows)     !! ascending
    real(wp), intent(inout) :: front(n, n)

    integer :: i, j

    do j = 1, rows
      do i = j, rows
        front(place(i), place(j)) = front(place(i), place(j)) + a(i, j)
      end do
    end do
  end subroutine add_rest

  !> Eliminates candidates as long as there are pivots. L is left below the diagonal, `D Lᵀ` above
  !! it, and behind both what remains, its lower triangle only beyond the candidates.
  pure subroutine eliminate(n, candidates, is_root, front, row, pivot, pivots, moved)
    integer, intent(in) :: n, candidates      !! rows; the first ones, that may be eliminated
    logical, intent(in) :: is_root            !! all must be
    real(wp), intent(inout) :: front(n, n)
    integer, intent(inout) :: row(:)          !! (n) their unknowns
    real(wp), intent(inout) :: pivot(:, :)    !! (2, from 1) D
    integer, intent(out) :: pivots            !! eliminated
    integer, intent(inout) :: moved

    logical :: is_tried(candidates)
    integer :: j, k, p, q

    k = 1
    do while (k <= candidates)
      call choose_pivot(n, candidates, k, front, is_tried, p, q)
      if (p == 0) then
        if (.not. is_root) exit
        call choose_largest(n, k, front, p, q)
        if (p == 0) then
          p = k
          front(k, k) = sign(moved_pivot, front(k, k))
          moved = moved + 1
        end if
      end if
      call exchange(n, candidates, k, p, front, row)
      if (q == 0) then
        pivot(:, k) = [front(k, k), 0.0_wp]
        do j = candidates + 1, n
          front(k, j) = front(j, k)
        end do
        front(k + 1:, k) = front(k + 1:, k)/front(k, k)
        do j = k + 1, candidates
          if (.not. abs(front(k, j)) > 0.0_wp) cycle
          front(k + 1:, j) = front(k + 1:, j) - front(k, j)*front(k + 1:, k)
        end do
        k = k + 1
      else
        if (q == k) q = p
        call exchange(n, candidates, k + 1, q, front, row)
        pivot(:, k) = [front(k, k), front(k + 1, k)]
        pivot(:, k + 1) = [front(k + 1, k + 1), 0.0_wp]
        do j = candidates + 1, n
          front(k, j) = front(j, k)
          front(k + 1, j) = front(j, k + 1)
        end do
        call divide_by_pair(pivot(:, k:k + 1), front(k + 2:, k), front(k + 2:, k + 1))
        front(k + 1, k) = 0.0_wp
        do j = k + 2, candidates
          if (.not. max(abs(front(k, j)), abs(front(k + 1, j))) > 0.0_wp) cycle
          front(k + 2:, j) = front(k + 2:, j) - (front(k, j)*front(k + 2:, k) + &
            front(k + 1, j)*front(k + 2:, k + 1))
        end do
        k = k + 2
      end if
    end do
    pivots = k - 1
    call subtract_products(n, candidates, pivots, front)
  end subroutine eliminate

  !> The next pivot: the largest diagonal entry that is not much less than the rest of its column,
  !! or a pair, of one that is and what couples it most, if its multipliers are not large.
  pure subroutine choose_pivot(n, candidates, k, front, is_tried, p, q)
    integer, intent(in) :: n, candidates, k    !! rows; candidates are k to here
    real(wp), intent(in) :: front(n, n)
    logical, intent(inout) :: is_tried(:)      !! (candidates) work space
    integer, intent(out) :: p, q               !! p = 0: none; q = 0: p alone

    real(wp) :: coupling, det, most, rest_p, rest_q
    integer :: i, tried

    is_tried(k:) = .false.
    do tried = k, candidates
      most = -1.0_wp
      do i = k, candidates
        if (is_tried(i)) cycle
        if (abs(front(i, i)) <= most) cycle
        most = abs(front(i, i))
        p = i
      end do
      is_tried(p) = .true.
      q = 0
      rest_p = largest_beside(front(k:, p), p - k + 1, p - k + 1)
      if (most > zero_pivot .and. most >= threshold*rest_p) return
      coupling = zero_pivot
      do i = k, candidates
        if (i == p) cycle
        if (abs(front(i, p)) <= coupling) cycle
        coupling = abs(front(i, p))
        q = i
      end do
      if (q == 0) cycle
      rest_p = largest_beside(front(k:, p), p - k + 1, q - k + 1)
      rest_q = largest_beside(front(k:, q), p - k + 1, q - k + 1)
      det = abs(front(p, p)*front(q, q) - coupling**2)
      if (det >= threshold*(abs(front(q, q))*rest_p + coupling*rest_q) .and. &
        det >= threshold*(coupling*rest_p + abs(front(p, p))*rest_q)) return
    end do
    p = 0
  end subroutine choose_pivot

  !> The next pivot of a root, by the largest of all entries.
  pure subroutine choose_largest(n, k, front, p, q)
    integer, intent(in) :: n, k          !! rows; what remains begins at k
    real(wp), intent(in) :: front(n, n)
    integer, intent(out) :: p, q         !! p = 0: none; q = 0: p alone

    real(wp) :: single, coupling
    integer :: i, j, alone

    single = zero_pivot
    coupling = zero_pivot
    alone = 0
    p = 0
    do j = k, n
      if (abs(front(j, j)) > single) then
        single = abs(front(j, j))
        alone = j
      end if
      do i = j + 1, n
        if (abs(front(i, j)) <= coupling) cycle
        coupling = abs(front(i, j))
        p = j
        q = i
      end do
    end do
    if (single < balance*coupling .and. p /= 0) return
    p = alone
    q = 0
  end subroutine choose_largest

  !> Exchanges two candidates, k and one behind it.
  pure subroutine exchange(n, candidates, k, p, front, row)
    integer, intent(in) :: n, candidates, k, p
    real(wp), intent(inout) :: front(n, n)
    integer, intent(inout) :: row(:)

    real(wp) :: other
    integer :: i

    if (p == k) return
    i = row(k)
    row(k) = row(p)
    row(p) = i
    do i = 1, n
      other = front(i, k)
      front(i, k) = front(i, p)
      front(i, p) = other
    end do
    do i = 1, candidates
      other = front(k, i)
      front(k, i) = front(p, i)
      front(p, i) = other
    end do
  end subroutine exchange

  !> Two vectors times the inverse of a pair.
  pure subroutine divide_by_pair(pair, u, v)
    real(wp), intent(in) :: pair(:, :)        !! (2, 2) of D
    real(wp), intent(inout) :: u(:), v(:)

    real(wp) :: a, b, scale, other
    integer :: i

    a = pair(1, 1)/pair(2, 1)
    b = pair(1, 2)/pair(2, 1)
    scale = 1.0_wp/((a*b - 1.0_wp)*pair(2, 1))
    do i = 1, size(u)
      other = (b*u(i) - v(i))*scale
      v(i) = (a*v(i) - u(i))*scale
      u(i) = other
    end do
  end subroutine divide_by_pair

  !> `A − L D Lᵀ` beyond the candidates, lower triangle.
  pure subroutine subtract_products(n, candidates, pivots, front)
    integer, intent(in) :: n, candidates, pivots
    real(wp), intent(inout) :: front(n, n)

    integer :: i, j, k

    do j = candidates + 1, n
      do k = 1, pivots - 3, 4
        do i = j, n
          front(i, j) = front(i, j) - ((front(i, k)*front(k, j) + &
            front(i, k + 1)*front(k + 1, j)) + (front(i, k + 2)*front(k + 2, j) + &
            front(i, k + 3)*front(k + 3, j)))
        end do
      end do
      do k = pivots - modulo(pivots, 4) + 1, pivots
        do i = j, n
          front(i, j) = front(i, j) - front(i, k)*front(k, j)
        end do
      end do
    end do
  end subroutine subtract_products

  !> Puts on the stack what remains of a front, its lower triangle.
  pure subroutine push_rest(n, pivots, front, rest)
    integer, intent(in) :: n, pivots
    real(wp), intent(in) :: front(n, n)
    real(wp), intent(inout) :: rest(n - pivots, n - pivots)

    integer :: j

    do j = 1, n - pivots
      rest(j:, j) = front(pivots + j:, pivots + j)
    end do
  end subroutine push_rest

  !> Numbers about D.
  pure subroutine describe_pivots(factor)
    type(indefinite_factor_t), intent(inout) :: factor

    real(wp) :: size_of
    integer :: k

    factor%least_pivot = huge(1.0_wp)
    factor%largest_pivot = 0.0_wp
    k = 1
    do while (k <= size(factor%pivot, 2))
      associate (d => factor%pivot(:, k))
        if (abs(d(2)) > 0.0_wp) then
          k = k + 1
          size_of = d(1)/d(2)*(factor%pivot(1, k)/d(2)) - 1.0_wp
          if (size_of < 0.0_wp) factor%negative = factor%negative + 1
          if (size_of > 0.0_wp .and. d(1) < 0.0_wp) factor%negative = factor%negative + 2
          size_of = abs(d(2))*sqrt(abs(size_of))
        else
          if (d(1) < 0.0_wp) factor%negative = factor%negative + 1
          size_of = abs(d(1))
        end if
      end associate
      factor%least_pivot = min(factor%least_pivot, size_of)
      factor%largest_pivot = max(factor%largest_pivot, size_of)
      k = k + 1
    end do
  end subroutine describe_pivots

  !> Right sides of a front through L.
  pure subroutine solve_lower(n, pivots, panel, x)
    integer, intent(in) :: n, pivots
    real(wp), intent(in) :: panel(n, pivots)
    real(wp), intent(inout) :: x(n)

    integer :: k

    do k = 1, pivots
      x(k + 1:) = x(k + 1:) - x(k)*panel(k + 1:, k)
    end do
  end subroutine solve_lower

  !> Right sides of a front through D, then through Lᵀ with what is known beyond the pivots.
  pure subroutine solve_upper(n, pivots, panel, pivot, x)
    integer, intent(in) :: n, pivots
    real(wp), intent(in) :: panel(n, pivots)
    real(wp), intent(in) :: pivot(:, :)      !! (2, from 1) D
    real(wp), intent(inout) :: x(n)

    integer :: k

    k = 1
    do while (k <= pivots)
      if (abs(pivot(2, k)) > 0.0_wp) then
        call divide_by_pair(pivot(:, k:k + 1), x(k:k), x(k + 1:k + 1))
        k = k + 2
      else
        x(k) = x(k)/pivot(1, k)
        k = k + 1
      end if
    end do
    do k = pivots, 1, -1
      x(k) = x(k) - product_of(panel(k + 1:, k), x(k + 1:))
    end do
  end subroutine solve_upper

  !> The largest of a column but for two entries.
  pure function largest_beside(column, first, second) result(largest)
    real(wp), intent(in), contiguous :: column(:)
    integer, intent(in) :: first, second
    real(wp) :: largest

    associate (i => min(first, second), j => max(first, second))
      largest = max(largest_of(column(:i - 1)), largest_of(column(i + 1:j - 1)), &
        largest_of(column(j + 1:)))
    end associate
  end function largest_beside

  !> The largest absolute value; four at a time, as each has to wait for the one before.
  pure function largest_of(list) result(largest)
    real(wp), intent(in), contiguous :: list(:)
    real(wp) :: largest

    real(wp) :: four(4)
    integer :: i

    four = 0.0_wp
    do i = 1, size(list) - 3, 4
      four = max(four, abs(list(i:i + 3)))
    end do
    do i = size(list) - modulo(size(list), 4) + 1, size(list)
      four(1) = max(four(1), abs(list(i)))
    end do
    largest = max(max(four(1), four(2)), max(four(3), four(4)))
  end function largest_of

  !> Scalar product, likewise.
  pure function product_of(a, b) result(total)
    real(wp), intent(in), contiguous :: a(:), b(:)
    real(wp) :: total

    real(wp) :: four(4)
    integer :: i

    four = 0.0_wp
    do i = 1, size(a) - 3, 4
      four = four + a(i:i + 3)*b(i:i + 3)
    end do
    do i = size(a) - modulo(size(a), 4) + 1, size(a)
      four(1) = four(1) + a(i)*b(i)
    end do
    total = (four(1) + four(2)) + (four(3) + four(4))
  end function product_of

  !> Makes room, and more than asked for. What is there stays.
  pure subroutine reserve_integers(list, needed)
    integer, allocatable, intent(inout) :: list(:)
    integer, intent(in) :: needed

    integer, allocatable :: wider(:)

    if (size(list) >= needed) return
    allocate (wider(needed + size(list)))
    wider(:size(list)) = list
    call move_alloc(wider, list)
  end subroutine reserve_integers

  !> Likewise.
  pure subroutine reserve_values(list, needed)
    real(wp), allocatable, intent(inout) :: list(:)
    integer, intent(in) :: needed

    real(wp), allocatable :: wider(:)

    if (size(list) >= needed) return
    allocate (wider(needed + size(list)))
    wider(:size(list)) = list
    call move_alloc(wider, list)
  end subroutine reserve_values

end module indefinite_factor
