!> Least squares in plane vectors p and functions of their lengths: the smallest
!! `|d + Σ A_b p_b + Σ c_b φ_b(|p_b|)|²`, with `φ(s) = jump + linear s + square s²` for s > 0 and
!! φ(0) = 0, all of them not negative.
!!
!! With j_b in place of φ_b(|p_b|) the sum of squares is convex in (p, j), and j_b ≥ φ_b(|p_b|) is a
!! convex set. By the conditions of Karush, Kuhn and Tucker a stationary point at which no sum of
!! squares falls as a j_b grows is the smallest over that set, and so over all p: that proves it.
module vector_least_squares
  use constants, only: two_pi
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: vector_problem_t, vector_minimum_t, find_least_squares, has_full_rank

  type :: vector_problem_t
    real(wp), allocatable :: along(:, :)   !! (rows, 2·vectors) A, two columns a vector
    real(wp), allocatable :: by_length(:, :) !! (rows, vectors) c
    real(wp), allocatable :: constant(:)   !! (rows) d
    real(wp), allocatable :: jump(:)       !! (vectors) of φ
    real(wp), allocatable :: linear(:)     !! (vectors)
    real(wp), allocatable :: square(:)     !! (vectors)
  end type vector_problem_t

  type :: vector_minimum_t
    real(wp), allocatable :: vector(:, :)  !! (2, vectors) p
    real(wp) :: value = 0.0_wp             !! the sum of squares
    real(wp) :: gradient = 0.0_wp          !! largest derivative by a component, over twice the
                                           !! norms of its column and of d [-]
    logical :: is_minimum = .false.        !! the matrix of second derivatives is positive definite
    logical :: is_least = .false.          !! proved the smallest of all
    logical :: length_helps = .false.      !! the sum of squares falls as some φ grows
  end type vector_minimum_t

  !> The problem reduced to its triangular factor.
  type :: reduced_t
    integer :: n = 0                       !! vectors
    real(wp), allocatable :: r(:, :)       !! (3n + 1, 3n + 1) of [A, c, d]
    real(wp), allocatable :: jump(:), linear(:), square(:)
    logical, allocatable :: carried(:)     !! (vectors) that are there; the others are zero
  end type reduced_t

  integer, parameter :: most_steps = 300

  !> Directions from which a vector is started where nothing is proved, each with the best of some
  !! sizes over so many powers of ten to either side of the usual one.
  integer, parameter :: directions = 24, sizes = 12
  real(wp), parameter :: powers = 2.0_wp

  !> Rounding of a derivative, relative as `gradient` is.
  real(wp), parameter :: flat = 1.0e-13_wp

contains

  !> The smallest sum of squares. Where no proof is found it is the smallest of the minima reached
  !! from the solution without lengths and from two dozen directions of every vector.
  pure subroutine find_least_squares(problem, found)
    type(vector_problem_t), intent(in) :: problem !! whose A has full rank
    type(vector_minimum_t), intent(out) :: found

    type(vector_minimum_t) :: other
    type(reduced_t) :: reduced
    real(wp) :: bound
    logical :: all_proved
    integer :: mask, b, n

    n = size(problem%jump)
    reduced = reduced_problem(problem)
    if (.not. any(problem%jump > 0.0_wp)) then
      call find_of_carried(reduced, found)
      return
    end if
    ! A jump is a cost of a vector, however small: it may be better to do without the vector. One
    ! that vanishes with its jump is no vector, and its sum of squares only a bound.
    found%value = huge(bound)
    bound = huge(bound)
    all_proved = .true.
    do mask = 0, 2**n - 1
      reduced%carried = [(.not. btest(mask, b - 1), b=1, n)]
      if (any(.not. reduced%carried .and. .not. problem%jump > 0.0_wp)) cycle
      call find_of_carried(reduced, other)
      all_proved = all_proved .and. other%is_least
      if (any(reduced%carried .and. problem%jump > 0.0_wp .and. norm2(other%vector, dim=1) <= &
        0.0_wp)) then
        bound = min(bound, other%value)
      else if (other%value < found%value) then
        found = other
      end if
    end do
    found%is_least = all_proved .and. found%value <= bound
  end subroutine find_least_squares

  !> Whether columns are independent of those before, but for rounding.
  pure function has_full_rank(columns, others) result(has)
    real(wp), intent(in) :: columns(:, :) !! (rows, columns)
    real(wp), intent(in) :: others(:, :)  !! (rows, columns) independent
    logical :: has

    real(wp), parameter :: rounding = 1.0e-10_wp
    real(wp) :: basis(size(columns, 1), size(columns, 2) + size(others, 2)), length
    integer :: i, k, pass

    has = .true.
    basis(:, :size(others, 2)) = others
    basis(:, size(others, 2) + 1:) = columns
    do i = 1, size(basis, 2)
      length = norm2(basis(:, i))
      do pass = 1, 2
        do k = 1, i - 1
          basis(:, i) = basis(:, i) - dot_product(basis(:, k), basis(:, i))*basis(:, k)
        end do
      end do
      if (i > size(others, 2)) has = has .and. norm2(basis(:, i)) > rounding*length
      if (norm2(basis(:, i)) > 0.0_wp) basis(:, i) = basis(:, i)/norm2(basis(:, i))
    end do
  end function has_full_rank

  !> The triangular factor of [A, c, d] by Householder's reflections: the sum of squares is that of
  !! its product with the unknowns.
  pure function reduced_problem(problem) result(reduced)
    type(vector_problem_t), intent(in) :: problem
    type(reduced_t) :: reduced

    real(wp), allocatable :: work(:, :), mirror(:)
    real(wp) :: alpha
    integer :: i, k, n, rows, columns

    n = size(problem%jump)
    reduced%n = n
    reduced%jump = problem%jump
    reduced%linear = problem%linear
    reduced%square = problem%square
    reduced%carried = spread(.true., 1, n)
    columns = 3*n + 1
    rows = max(size(problem%constant), columns)
    allocate (work(rows, columns), mirror(rows))
    work = 0.0_wp
    work(:size(problem%constant), :2*n) = problem%along
    work(:size(problem%constant), 2*n + 1:3*n) = problem%by_length
    work(:size(problem%constant), columns) = problem%constant
    do k = 1, columns
      alpha = norm2(work(k:, k))
      if (.not. alpha > 0.0_wp) cycle
      if (work(k, k) > 0.0_wp) alpha = -alpha
      mirror(k:) = work(k:, k)
      mirror(k) = mirror(k) - alpha
      mirror(k:) = mirror(k:)/norm2(mirror(k:))
      do i = k + 1, columns
        work(k:, i) = work(k:, i) - 2.0_wp*dot_product(mirror(k:), work(k:, i))*mirror(k:)
      end do
      work(k, k) = alpha
      work(k + 1:, k) = 0.0_wp
    end do
    reduced%r = work(:columns, :)
  end function reduced_problem

  !> The smallest sum of squares with some of the vectors, the others being zero.
  pure subroutine find_of_carried(reduced, found)
    type(reduced_t), intent(in) :: reduced
    type(vector_minimum_t), intent(out) :: found

    type(vector_minimum_t) :: other
    real(wp) :: start(2, reduced%n), trial(2, reduced%n), angle, usual, value, least
    integer :: b, i, k

    start = without_lengths(reduced)
    usual = norm2(start)
    call descend(reduced, start, found)
    ! Where lengths cost much more than vectors gain, a descent may end too soon.
    trial = 0.0_wp
    call descend(reduced, trial, other)
    if (.not. found%value <= other%value) found = other
    if (found%is_least .or. .not. usual > 0.0_wp) return
    do b = 1, reduced%n
      if (.not. reduced%carried(b)) cycle
      do i = 1, directions
        angle = i*two_pi/directions
        least = huge(least)
        do k = -sizes, sizes
          trial = found%vector
          trial(:, b) = usual*10.0_wp**(powers*k/sizes)*[cos(angle), sin(angle)]
          value = sum_of_squares(reduced, trial)
          if (value >= least) cycle
          least = value
          start = trial
        end do
        call descend(reduced, start, other)
        if (other%is_least .or. other%value < found%value*(1.0_wp - 1.0e-12_wp)) found = other
        if (found%is_least) return
      end do
    end do
  end subroutine find_of_carried

  !> The solution with all φ = 0.
  pure function without_lengths(reduced) result(start)
    type(reduced_t), intent(in) :: reduced
    real(wp) :: start(2, reduced%n)

    type(reduced_t) :: alone
    real(wp) :: x(2*reduced%n)
    integer :: i, n, columns
    integer, allocatable :: kept(:)
    type(vector_problem_t) :: less

    start = 0.0_wp
    n = count(reduced%carried)
    if (n == 0) return
    kept = pack([(i, i=1, reduced%n)], reduced%carried)
    columns = 3*reduced%n + 1
    allocate (less%along(columns, 2*n), less%by_length(columns, n))
    do i = 1, n
      less%along(:, 2*i - 1:2*i) = reduced%r(:, 2*kept(i) - 1:2*kept(i))
    end do
    less%by_length = 0.0_wp
    less%constant = reduced%r(:, columns)
    less%jump = reduced%jump(kept)
    less%linear = reduced%linear(kept)
    less%square = reduced%square(kept)
    alone = reduced_problem(less)
    do i = 2*n, 1, -1
      x(i) = -(alone%r(i, 3*n + 1) + dot_product(alone%r(i, i + 1:2*n), x(i + 1:2*n)))/ &
        alone%r(i, i)
    end do
    do i = 1, n
      start(:, kept(i)) = x(2*i - 1:2*i)
    end do
  end function without_lengths

  !> Newton's method, with a multiple of the unit matrix where it does not descend (Levenberg,
  !! Marquardt). A vector that vanishes rests; one that is at rest moves where that descends.
  pure subroutine descend(reduced, start, found)
    type(reduced_t), intent(in) :: reduced
    real(wp), intent(in) :: start(:, :) !! (2, vectors)
    type(vector_minimum_t), intent(out) :: found

    real(wp) :: p(2, reduced%n), trial(2, reduced%n), g(2*reduced%n), h(2*reduced%n, 2*reduced%n), &
      step(2*reduced%n), measure(2*reduced%n), damping, value, next, tiny_length, whole
    logical :: moves(reduced%n), is_definite
    integer :: steps, b

    p = start
    do b = 1, reduced%n
      if (.not. reduced%carried(b)) p(:, b) = 0.0_wp
    end do
    tiny_length = 1.0e-12_wp*norm2(start)
    whole = norm2(reduced%r(:, 3*reduced%n + 1))
    damping = 0.0_wp
    value = sum_of_squares(reduced, p)
    is_definite = .false.
    do steps = 1, most_steps
      moves = norm2(p, dim=1) > tiny_length
      where (spread(.not. moves, 1, 2)) p = 0.0_wp
      call differentiate(reduced, p, moves, g, h, measure)
      found%gradient = maxval(abs(g)/measure)
      if (found%gradient <= epsilon(1.0_wp)) then
        call wake(reduced, p, value)
        if (any((norm2(p, dim=1) > 0.0_wp) .neqv. moves)) cycle
        exit
      end if
      call solve_definite(h, g, moves, damping, step, is_definite)
      next = value
      if (is_definite) then
        trial = p - reshape(step, shape(p))
        next = sum_of_squares(reduced, trial)
      end if
      if (is_definite .and. next < value) then
        p = trial
        value = next
        damping = merge(0.0_wp, 0.1_wp*damping, damping < 1.0e-12_wp)
        cycle
      end if
      ! Near the minimum the derivatives tell more than the sum of squares.
      if (is_definite) then
        call differentiate(reduced, trial, moves, g, h, measure)
        if (next <= value + epsilon(1.0_wp)*whole**2 .and. maxval(abs(g)/measure) < &
          0.5_wp*found%gradient) then
          p = trial
          value = next
          cycle
        end if
      end if
      ! Rounding ends the descent where the derivatives are nothing but rounding.
      if (found%gradient <= flat) then
        call wake(reduced, p, value)
        if (all((norm2(p, dim=1) > 0.0_wp) .eqv. moves)) exit
        cycle
      end if
      ! Zero is a corner, to which Newton's steps do not lead.
      do b = 1, reduced%n
        if (.not. moves(b)) cycle
        trial = p
        trial(:, b) = 0.0_wp
        next = sum_of_squares(reduced, trial)
        if (.not. next < value) cycle
        p = trial
        value = next
      end do
      damping = max(10.0_wp*damping, 1.0e-10_wp)
      if (damping > 1.0e20_wp) exit
    end do
    moves = norm2(p, dim=1) > 0.0_wp
    call differentiate(reduced, p, moves, g, h, measure)
    found%gradient = maxval(abs(g)/measure)
    call solve_definite(h, g, moves, 0.0_wp, step, found%is_minimum)
    found%vector = p
    found%value = value
    call prove(reduced, p, found)
  end subroutine descend

  !> The unknowns (p, φ, 1) of the triangular factor.
  pure function unknowns_of(reduced, p) result(x)
    type(reduced_t), intent(in) :: reduced
    real(wp), intent(in) :: p(:, :)
    real(wp) :: x(3*reduced%n + 1)

    real(wp) :: s
    integer :: b, n

    n = reduced%n
    x(:2*n) = reshape(p, [2*n])
    do b = 1, n
      s = norm2(p(:, b))
      x(2*n + b) = reduced%linear(b)*s + reduced%square(b)*s**2
      if (reduced%carried(b)) x(2*n + b) = x(2*n + b) + reduced%jump(b)
    end do
    x(3*n + 1) = 1.0_wp
  end function unknowns_of

  pure function sum_of_squares(reduced, p) result(value)
    type(reduced_t), intent(in) :: reduced
    real(wp), intent(in) :: p(:, :)
    real(wp) :: value

    value = sum(matmul(reduced%r, unknowns_of(reduced, p))**2)
  end function sum_of_squares

  !> First and second derivatives of the sum of squares by the vectors that move; for the others
  !! zeros, and ones on the diagonal.
  pure subroutine differentiate(reduced, p, moves, g, h, measure)
    type(reduced_t), intent(in) :: reduced
    real(wp), intent(in) :: p(:, :)
    logical, intent(in) :: moves(:)
    real(wp), intent(out) :: g(:)       !! (2·vectors)
    real(wp), intent(out) :: h(:, :)    !! (2·vectors, 2·vectors)
    real(wp), intent(out) :: measure(:) !! (2·vectors) with which g is compared

    real(wp) :: rest(3*reduced%n + 1), slope(3*reduced%n + 1, 2*reduced%n), u(2), s, first, &
      along_length, plane(2, 2), whole
    integer :: b, i, n

    n = reduced%n
    rest = matmul(reduced%r, unknowns_of(reduced, p))
    whole = norm2(reduced%r(:, 3*n + 1))
    slope = 0.0_wp
    do b = 1, n
      if (.not. moves(b)) cycle
      s = norm2(p(:, b))
      u = p(:, b)/s
      first = reduced%linear(b) + 2.0_wp*reduced%square(b)*s
      do i = 1, 2
        slope(:, 2*b - 2 + i) = reduced%r(:, 2*b - 2 + i) + first*u(i)*reduced%r(:, 2*n + b)
      end do
    end do
    g = 2.0_wp*matmul(rest, slope)
    h = 2.0_wp*matmul(transpose(slope), slope)
    measure = 1.0_wp
    do b = 1, n
      if (.not. moves(b)) then
        h(2*b - 1, 2*b - 1) = 1.0_wp
        h(2*b, 2*b) = 1.0_wp
        cycle
      end if
      s = norm2(p(:, b))
      u = p(:, b)/s
      first = reduced%linear(b) + 2.0_wp*reduced%square(b)*s
      along_length = 2.0_wp*dot_product(rest, reduced%r(:, 2*n + b))
      plane = spread(u, 2, 2)*spread(u, 1, 2)
      h(2*b - 1:2*b, 2*b - 1:2*b) = h(2*b - 1:2*b, 2*b - 1:2*b) + along_length* &
        (2.0_wp*reduced%square(b) - first/s)*plane
      do i = 2*b - 1, 2*b
        h(i, i) = h(i, i) + along_length*first/s
        measure(i) = max(2.0_wp*norm2(slope(:, i))*whole, tiny(whole))
      end do
    end do
  end subroutine differentiate

  !> The step of Newton's method with damping, by Cholesky's factors; none if the matrix is not
  !! positive definite.
  pure subroutine solve_definite(h, g, moves, damping, step, is_definite)
    real(wp), intent(in) :: h(:, :), g(:)
    logical, intent(in) :: moves(:)
    real(wp), intent(in) :: damping      !! relative to the diagonal
    real(wp), intent(out) :: step(:)
    logical, intent(out) :: is_definite

    real(wp) :: l(size(g), size(g)), diagonal(size(g))
    integer :: i, k

    l = h
    do i = 1, size(g)
      diagonal(i) = abs(h(i, i))
    end do
    do i = 1, size(g)
      l(i, i) = l(i, i) + damping*max(diagonal(i), maxval(diagonal, mask=[(moves((k + 1)/2), k=1, &
        size(g))])*1.0e-6_wp)
    end do
    step = 0.0_wp
    is_definite = .true.
    do k = 1, size(g)
      l(k, k) = l(k, k) - sum(l(k, :k - 1)**2)
      is_definite = is_definite .and. l(k, k) > 0.0_wp
      if (.not. is_definite) return
      l(k, k) = sqrt(l(k, k))
      do i = k + 1, size(g)
        l(i, k) = (l(i, k) - dot_product(l(i, :k - 1), l(k, :k - 1)))/l(k, k)
      end do
    end do
    step = g
    do k = 1, size(g)
      step(k) = (step(k) - dot_product(l(k, :k - 1), step(:k - 1)))/l(k, k)
    end do
    do k = size(g), 1, -1
      step(k) = (step(k) - dot_product(l(k + 1:, k), step(k + 1:)))/l(k, k)
    end do
  end subroutine solve_definite

  !> Moves vectors at rest whose growth lessens the sum of squares: its slope at p = 0 is least
  !! against the gradient.
  pure subroutine wake(reduced, p, value)
    type(reduced_t), intent(in) :: reduced
    real(wp), intent(inout) :: p(:, :)
    real(wp), intent(inout) :: value

    real(wp) :: rest(3*reduced%n + 1), g(2), slope, trial(2, reduced%n), s, next
    integer :: b, n, halvings

    n = reduced%n
    do b = 1, n
      if (.not. reduced%carried(b) .or. norm2(p(:, b)) > 0.0_wp) cycle
      rest = matmul(reduced%r, unknowns_of(reduced, p))
      g = 2.0_wp*matmul(rest, reduced%r(:, 2*b - 1:2*b))
      slope = 2.0_wp*dot_product(rest, reduced%r(:, 2*n + b))*reduced%linear(b) - norm2(g)
      if (slope >= -flat*2.0_wp*norm2(reduced%r(:, 2*b - 1:2*b))*norm2(reduced%r(:, 3*n + 1))) cycle
      ! The step at which a parabola with the curvature of A would be least.
      s = -slope/(2.0_wp*sum(reduced%r(:, 2*b - 1:2*b)**2))
      do halvings = 1, 60
        trial = p
        trial(:, b) = -s*g/norm2(g)
        next = sum_of_squares(reduced, trial)
        if (next < value) then
          p = trial
          value = next
          exit
        end if
        s = 0.5_wp*s
      end do
    end do
  end subroutine wake

  !> Whether the sum of squares would not fall if any φ grew, at a stationary point.
  pure subroutine prove(reduced, p, found)
    type(reduced_t), intent(in) :: reduced
    real(wp), intent(in) :: p(:, :)
    type(vector_minimum_t), intent(inout) :: found

    real(wp) :: rest(3*reduced%n + 1), slope
    logical :: rests !! vectors that are zero stay so
    integer :: b, n

    n = reduced%n
    rest = matmul(reduced%r, unknowns_of(reduced, p))
    found%length_helps = .false.
    rests = .true.
    do b = 1, n
      if (.not. reduced%carried(b)) cycle
      slope = 2.0_wp*dot_product(rest, reduced%r(:, 2*n + b))
      found%length_helps = found%length_helps .or. slope < -2.0_wp*flat*norm2(reduced%r(:, 2*n + &
        b))*norm2(reduced%r(:, 3*n + 1))
      if (norm2(p(:, b)) > 0.0_wp) cycle
      rests = rests .and. 2.0_wp*norm2(matmul(rest, reduced%r(:, 2*b - 1:2*b))) <= slope* &
        reduced%linear(b) + 2.0_wp*flat*norm2(reduced%r(:, 2*b - 1:2*b))*norm2(reduced%r(:, &
        3*n + 1))
    end do
    found%is_least = found%gradient <= 1.0e-12_wp .and. rests .and. .not. found%length_helps
  end subroutine prove

end module vector_least_squares
