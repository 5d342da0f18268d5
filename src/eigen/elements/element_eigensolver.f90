! src/eigen/elements/ - the lowest modes of matrices that are sums of small ones, with conditions.
! In: `element_pencil_t`, the number of modes wanted. Out: modes with error bounds, and a proof that
! none is missing, as of bordered matrices. Begin with `find_element_modes` here.
! Not here: the factor of the matrices (`src/base/sparse`), bordered matrices (`src/eigen`).

!> The lowest modes of `K z = λ M z` where K has rows of conditions with multipliers, each with an
!! error bound, and a proof that none is missing.
!!
!! M is zero between multipliers, and positive between unknowns that meet the conditions. K − μM
!! then has as many negative eigenvalues as there are conditions and modes below μ.
module element_eigensolver
  use band_matrix, only: full_band
  use bordered_eigensolver, only: bordered_modes_t, choose_modes, overlaps, start_t
  use completeness_proof, only: count_margin
  use dense_eigensolver, only: solve_dense
  use eigenvalue_gaps, only: relative_gap
  use element_matrices, only: absolute_times_vector, elements_t, times_vector
  use elimination_plan, only: elimination_plan_t
  use errors, only: error_of_numerics, error_t, set_error
  use indefinite_factor, only: factorize, indefinite_factor_t, solve
  use kinds, only: wp
  use sorting, only: ascending_order
  use text, only: to_string
  implicit none (type, external)
  private

  public :: element_pencil_t, find_element_modes, check_conditions

  !> K and M of the same elements.
  type :: element_pencil_t
    real(wp), allocatable :: stiffness(:) !! values of K
    real(wp), allocatable :: mass(:)      !! values of M [s²]
    integer :: conditions = 0             !! number of multipliers
    type(indefinite_factor_t) :: factor   !! of `K − μM`, its room
  end type element_pencil_t

  integer, parameter :: most_iterations = 8

  !> Relative distance of eigenvalues below which a mode is kept orthogonal to those found before.
  real(wp), parameter :: same_eigenvalue = 1.0e-3_wp

  !> Rounding error of an eigenvalue, in units of ε times the terms of its Rayleigh quotient.
  real(wp), parameter :: rounding = 16.0_wp

  !> Relative distances above the last wanted mode at which modes are counted, the first that
  !! proves.
  real(wp), parameter :: margins(3) = [1.0e-3_wp, 1.0e-5_wp, count_margin]

  !> Searches for what is missing.
  integer, parameter :: most_attempts = 100

  !> Vectors of a block of a search: at first, and at most; largest number of all
  !! of them; relative change of eigenvalues from block to block at which it ends.
  integer, parameter :: first_block = 2, most_block = 16, most_vectors = 400
  real(wp), parameter :: start_accuracy = 1.0e-7_wp

  !> A pivot below is rounding, where the largest are about 1: conditions depend on each other.
  real(wp), parameter :: least_pivot = 64.0_wp*epsilon(1.0_wp)

  !> Modes beyond those missing in a search.
  integer, parameter :: guards = 2

contains

  !> Finds the lowest modes from a start. What is missing then, all without one, or what the count
  !! has told, is searched for in the space without the modes found, again and again: of equal or
  !! nearly equal eigenvalues a search finds a few each time.
  !!
  !! Every mode is improved by inverse iteration at its Rayleigh quotient until the error of its
  !! eigenvalue is below rounding. Modes within the clearance above the last one wanted are found,
  !! too. Errors: fewer modes than wanted; no start leads to modes that are proven to be complete.
  subroutine find_element_modes(elements, plan, pencil, wanted, accurate_vectors, start, found, &
    error, clearance)
    type(elements_t), intent(in) :: elements         !! of K and M
    type(elimination_plan_t), intent(in) :: plan     !! of these
    type(element_pencil_t), intent(inout) :: pencil  !! K and M
    integer, intent(in) :: wanted                    !! number of modes
    logical, intent(in) :: accurate_vectors          !! all digits in the vectors, too
    type(start_t), intent(in) :: start               !! used if it has at least the modes wanted
    type(bordered_modes_t), intent(inout) :: found   !! the modes wanted, perhaps more
    type(error_t), allocatable, intent(out) :: error !! allocated on failure
    real(wp), intent(in) :: clearance                !! relative distance above the last wanted mode
                                                     !! within which modes are found, too

    type(start_t) :: blind
    integer :: attempt, before, block, missing
    logical :: proven

    found%factorizations = 0
    found%full_solutions = 0
    found%reduced_solutions = 0
    found%zeros = 0
    found%rest = 0.0_wp
    proven = .false.
    call make_room(found, elements%unknowns, 0)
    if (start%modes >= wanted) call add_modes(elements, plan, pencil, accurate_vectors, start, &
      .true., found)
    block = first_block
    do attempt = 1, most_attempts
      missing = wanted - size(found%lambda)
      if (missing <= 0) call check(elements, plan, pencil, wanted, clearance, found, proven, &
        missing)
      if (proven) return
      if (missing == 0 .or. block > most_block) exit
      block = max(block, min(missing, most_block))
      before = size(found%lambda)
      call search(elements, plan, pencil, found, missing + guards, block, blind)
      found%full_solutions = found%full_solutions + 1
      call add_modes(elements, plan, pencil, accurate_vectors, blind, .false., found)
      if (size(found%lambda) == before) block = 2*block
    end do
    if (size(found%lambda) < wanted) then
      call set_error(error, error_of_numerics, to_string(wanted)// &
        " modes are asked for, and only "//to_string(size(found%lambda))//" were found")
    else
      call set_error(error, error_of_numerics, "it could not be proven that no mode is missing")
    end if
  end subroutine find_element_modes

  !> Whether no condition follows from others, and none is wanting: K is regular, and has as many
  !! negative eigenvalues as there are conditions.
  pure subroutine check_conditions(elements, plan, pencil, hold)
    type(elements_t), intent(in) :: elements        !! of K and M
    type(elimination_plan_t), intent(in) :: plan    !! of these
    type(element_pencil_t), intent(inout) :: pencil !! at rest; its factor becomes that of K
    logical, intent(out) :: hold

    call factorize(plan, elements, pencil%stiffness, pencil%factor)
    hold = pencil%factor%least_pivot > least_pivot .and. pencil%factor%negative == &
      pencil%conditions
  end subroutine check_conditions

  !> Factorizes `K − μM`.
  pure subroutine shift_to(elements, plan, pencil, shift, factorizations)
    type(elements_t), intent(in) :: elements
    type(elimination_plan_t), intent(in) :: plan
    type(element_pencil_t), intent(inout) :: pencil
    real(wp), intent(in) :: shift !! μ [1/s²]
    integer, intent(inout) :: factorizations

    call factorize(plan, elements, pencil%stiffness - shift*pencil%mass, pencil%factor)
    factorizations = factorizations + 1
  end subroutine shift_to

  !> Counts the modes below a shift.
  pure subroutine count_below(elements, plan, pencil, shift, number, factorizations)
    type(elements_t), intent(in) :: elements
    type(elimination_plan_t), intent(in) :: plan
    type(element_pencil_t), intent(inout) :: pencil
    real(wp), intent(in) :: shift
    integer, intent(out) :: number
    integer, intent(inout) :: factorizations

    call shift_to(elements, plan, pencil, shift, factorizations)
    number = pencil%factor%negative - pencil%conditions
  end subroutine count_below

  !> Improves every mode of a start, adds those that are new, and sorts all.
  pure subroutine add_modes(elements, plan, pencil, accurate_vectors, start, is_known, found)
    type(elements_t), intent(in) :: elements
    type(elimination_plan_t), intent(in) :: plan
    type(element_pencil_t), intent(inout) :: pencil
    logical, intent(in) :: accurate_vectors
    type(start_t), intent(in) :: start
    logical, intent(in) :: is_known !! its modes are those of `origin`
    type(bordered_modes_t), intent(inout) :: found

    type(bordered_modes_t) :: more
    integer :: i, number
    logical :: converged

    number = size(found%lambda)
    call make_room(more, elements%unknowns, number + start%modes)
    more%lambda(:number) = found%lambda
    more%error(:number) = found%error
    more%origin(:number) = found%origin
    more%vector(:, :number) = found%vector
    more%mass_times(:, :number) = found%mass_times
    more%factorizations = found%factorizations
    do i = 1, start%modes
      more%lambda(number + 1) = start%lambda(i)
      more%mass_times(:, number + 1) = start%direction(:, i)
      call improve(elements, plan, pencil, accurate_vectors, relative_gap(start%lambda, i), &
        number + 1, more, converged)
      if (.not. converged) cycle
      if (overlaps(more%vector(:, number + 1), more%mass_times(:, :number))) cycle
      number = number + 1
      more%origin(number) = merge(i, 0, is_known)
    end do
    call choose_modes(more, ascending_order(more%lambda(:number)))
    found%factorizations = more%factorizations
    call move_alloc(more%lambda, found%lambda)
    call move_alloc(more%error, found%error)
    call move_alloc(more%origin, found%origin)
    call move_alloc(more%vector, found%vector)
    call move_alloc(more%mass_times, found%mass_times)
  end subroutine add_modes

  !> Allocates arrays for this many modes; previous contents are lost.
  pure subroutine make_room(found, unknowns, modes)
    type(bordered_modes_t), intent(inout) :: found
    integer, intent(in) :: unknowns, modes

    if (allocated(found%lambda)) deallocate (found%lambda)
    if (allocated(found%error)) deallocate (found%error)
    if (allocated(found%origin)) deallocate (found%origin)
    if (allocated(found%vector)) deallocate (found%vector)
    if (allocated(found%mass_times)) deallocate (found%mass_times)
    allocate (found%lambda(modes), found%error(modes), found%origin(modes), &
      found%vector(unknowns, modes), found%mass_times(unknowns, modes))
  end subroutine make_room

  !> Inverse iteration at the Rayleigh quotient, two steps with each factor. The mode's column of
  !! `found` holds the start: a direction `M z` and an estimate of the eigenvalue.
  !!
  !! With `(K − σM) w = M v`, vᵀMv = 1 and x = w/β of unit mass, the residual of x is
  !! `M (v/β − (λ − σ) x)`, and its square in the norm of M⁻¹ is `(1 − (xᵀMv)²)/β²`: divided by the
  !! distance of the next eigenvalue, it bounds the error of λ (Kato and Temple). `found%error`
  !! becomes its ratio to λ².
  pure subroutine improve(elements, plan, pencil, accurate_vector, gap_guess, mode, found, &
    converged)
    type(elements_t), intent(in) :: elements
    type(elimination_plan_t), intent(in) :: plan
    type(element_pencil_t), intent(inout) :: pencil
    logical, intent(in) :: accurate_vector
    real(wp), intent(in) :: gap_guess !! relative distance of the nearest other eigenvalue
    integer, intent(in) :: mode       !! number of its column
    type(bordered_modes_t), intent(inout) :: found
    logical, intent(out) :: converged

    real(wp), dimension(elements%unknowns) :: before, stiffness_times
    real(wp) :: scale, residual, previous, change, overlap
    integer :: i, step
    logical :: sound

    converged = .false.
    residual = 0.0_wp
    previous = huge(previous)
    associate (lambda => found%lambda(mode), vector => found%vector(:, mode), &
        mass_times => found%mass_times(:, mode))
      iterations: do i = 1, most_iterations
        call shift_to(elements, plan, pencil, lambda, found%factorizations)
        do step = 1, 2
          if (step == 2) before = vector
          vector = mass_times
          call solve(plan, pencil%factor, vector)
          call take_off(found, mode, lambda, vector)
          call normalise(elements, pencil, vector, mass_times, scale, sound)
          if (.not. sound) exit iterations
        end do
        ! What is left of the step before, as a vector: its square is no difference of squares.
        overlap = dot_product(before, mass_times)
        before = before - overlap*vector
        call times_vector(elements, pencil%mass, before, stiffness_times)
        residual = max(0.0_wp, dot_product(before, stiffness_times))*scale**2
        call times_vector(elements, pencil%stiffness, vector, stiffness_times)
        lambda = dot_product(vector, stiffness_times)
        change = residual/max(gap_guess, epsilon(1.0_wp))
        converged = change <= 0.25_wp*epsilon(1.0_wp)*lambda**2
        if (accurate_vector) converged = converged .and. change <= (1.0e-13_wp*lambda)**2
        if (converged) exit
        ! The residual no longer falls because of rounding: this accuracy is final.
        if (i > 2 .and. residual >= 0.25_wp*previous) then
          converged = change <= 1.0e-10_wp*lambda**2
          exit
        end if
        previous = residual
      end do iterations
      found%error(mode) = residual/max(lambda**2, tiny(lambda))
    end associate
  end subroutine improve

  !> Takes the parts off a vector that are modes found before with nearly the same eigenvalue.
  pure subroutine take_off(found, mode, lambda, vector)
    type(bordered_modes_t), intent(in) :: found
    integer, intent(in) :: mode
    real(wp), intent(in) :: lambda
    real(wp), intent(inout) :: vector(:)

    integer :: j, pass

    ! Twice: the second pass restores the orthogonality that the first loses to rounding.
    do pass = 1, 2
      do j = 1, mode - 1
        if (abs(found%lambda(j) - lambda) > same_eigenvalue*abs(lambda)) cycle
        vector = vector - dot_product(found%mass_times(:, j), vector)*found%vector(:, j)
      end do
    end do
  end subroutine take_off

  !> Gives a vector unit mass.
  pure subroutine normalise(elements, pencil, vector, mass_times, scale, sound)
    type(elements_t), intent(in) :: elements
    type(element_pencil_t), intent(in) :: pencil
    real(wp), intent(inout) :: vector(:)
    real(wp), intent(out) :: mass_times(:) !! M times it
    real(wp), intent(out) :: scale         !! by which it was multiplied
    logical, intent(out) :: sound          !! false: rounding leaves nothing of it, or of its mass

    real(wp) :: largest, square

    sound = .false.
    mass_times = 0.0_wp
    scale = 0.0_wp
    largest = maxval(abs(vector))
    if (.not. (largest > 0.0_wp .and. largest <= huge(largest))) return
    vector = vector/largest
    call times_vector(elements, pencil%mass, vector, mass_times)
    square = dot_product(vector, mass_times)
    if (.not. square > 0.0_wp) return
    sound = .true.
    vector = vector/sqrt(square)
    mass_times = mass_times/sqrt(square)
    scale = 1.0_wp/(sqrt(square)*largest)
  end subroutine normalise

  !> Proves that the modes are complete up to the last requested one, and bounds their errors.
  pure subroutine check(elements, plan, pencil, wanted, distance, found, proven, missing)
    type(elements_t), intent(in) :: elements
    type(elimination_plan_t), intent(in) :: plan
    type(element_pencil_t), intent(inout) :: pencil
    integer, intent(in) :: wanted
    real(wp), intent(in) :: distance !! relative, above the last requested mode, to be cleared
    type(bordered_modes_t), intent(inout) :: found
    logical, intent(out) :: proven
    integer, intent(out) :: missing  !! modes that the count tells of and that are not found; 0: the
                                     !! count cannot be trusted

    real(wp), dimension(elements%unknowns) :: products, mass_products
    real(wp) :: limit, reach, gap
    integer :: i, below, counted

    proven = .false.
    do i = 1, size(margins)
      reach = max(distance, margins(i))
      if (i > 1 .and. margins(i) < distance) exit
      limit = found%lambda(wanted) + reach*abs(found%lambda(wanted))
      below = count(found%lambda < limit)
      call count_below(elements, plan, pencil, limit, counted, found%factorizations)
      proven = counted == below .and. pencil%factor%moved == 0
      if (proven) exit
    end do
    missing = 0
    if (pencil%factor%moved == 0) missing = max(0, counted - below)
    if (.not. proven) return
    found%clear = reach
    do i = 1, below
      gap = max(relative_gap(found%lambda, i), epsilon(1.0_wp))
      ! From the last wanted mode on the next one may not be known.
      if (i >= wanted) gap = min(gap, reach)
      associate (z => found%vector(:, i), lambda => found%lambda(i))
        call absolute_times_vector(elements, pencil%stiffness, z, products)
        call absolute_times_vector(elements, pencil%mass, z, mass_products)
        found%error(i) = found%error(i)/gap + rounding*epsilon(1.0_wp)*(dot_product(abs(z), &
          products)/max(abs(lambda), tiny(lambda)) + dot_product(abs(z), mass_products))
      end associate
    end do
    if (below < size(found%lambda)) call choose_modes(found, [(i, i=1, below)])
    found%near = max(wanted, count(found%lambda <= found%lambda(wanted) + &
      distance*abs(found%lambda(wanted))))
  end subroutine check

  !> Approximate lowest modes, by a Krylov space of blocks from vectors that contain everything: all
  !! eigenvalues 1/(λ − σ) of `(K − σM)⁻¹ M` with σ below all modes.
  subroutine search(elements, plan, pencil, found, wanted, block, start)
    type(elements_t), intent(in) :: elements
    type(elimination_plan_t), intent(in) :: plan
    type(element_pencil_t), intent(inout) :: pencil
    type(bordered_modes_t), intent(inout) :: found !! modes to be left out; factors are counted
    integer, intent(in) :: wanted !! modes
    integer, intent(in) :: block  !! vectors of a block
    type(start_t), intent(out) :: start !! perhaps fewer of them

    real(wp), allocatable :: basis(:, :), mass_times(:, :), products(:, :), vectors(:, :), &
      inverse(:), last(:), next(:)
    type(error_t), allocatable :: error
    real(wp) :: shift, scale, seed
    integer :: i, j, n, from, to, chosen, enough
    logical :: sound

    start%modes = 0
    allocate (start%lambda(0), start%direction(elements%unknowns, 0))
    call find_definite_shift(elements, plan, pencil, shift, found%factorizations, sound)
    if (.not. sound) return
    allocate (basis(elements%unknowns, most_vectors), mass_times(elements%unknowns, most_vectors), &
      next(elements%unknowns), last(0))
    n = 0
    seed = 0.5_wp
    do j = 1, block
      do i = 1, size(next)
        ! Numbers without order, the same everywhere.
        seed = modulo(seed*997.0_wp + 0.6180339887498949_wp, 1.0_wp)
        next(i) = seed - 0.5_wp
      end do
      call times_vector(elements, pencil%mass, next, basis(:, n + 1))
      next = basis(:, n + 1)
      call solve(plan, pencil%factor, next)
      call add_vector()
    end do
    from = 1
    enough = wanted
    allocate (products(most_vectors, most_vectors), source=0.0_wp)
    do
      to = n
      if (from > to) exit
      do j = from, to
        next = mass_times(:, j)
        call solve(plan, pencil%factor, next)
        do i = 1, to
          products(i, j) = dot_product(mass_times(:, i), next)
          products(j, i) = products(i, j)
        end do
        if (n + 1 < most_vectors) call add_vector()
      end do
      from = to + 1
      if (to < enough .and. from <= n .and. n + block < most_vectors) cycle
      ! The eigenproblem of all vectors is solved again once there are a fifth more.
      enough = to + to/5
      chosen = min(wanted, to)
      call largest_of(products(:to, :to), chosen, inverse, vectors, error)
      ! What was found before is good enough to go on with.
      if (allocated(error)) exit
      start%modes = count(inverse > 0.0_wp)
      start%lambda = shift + 1.0_wp/inverse(:start%modes)
      start%direction = matmul(mass_times(:, :to), vectors(:, :start%modes))
      if (size(last) == size(inverse) .and. chosen == wanted) then
        if (all(abs(inverse - last) <= start_accuracy*abs(inverse))) exit
      end if
      last = inverse
      if (n + block >= most_vectors) exit
    end do

  contains

    !> Adds what is new in `next` to the basis.
    subroutine add_vector()
      integer :: k, pass

      call normalise(elements, pencil, next, mass_times(:, n + 1), scale, sound)
      if (.not. sound) return
      do pass = 1, 2
        do k = 1, size(found%lambda)
          next = next - dot_product(found%mass_times(:, k), next)*found%vector(:, k)
        end do
        do k = 1, n
          next = next - dot_product(mass_times(:, k), next)*basis(:, k)
        end do
      end do
      call times_vector(elements, pencil%mass, next, mass_times(:, n + 1))
      ! Nothing new but rounding.
      if (dot_product(next, mass_times(:, n + 1)) <= (100.0_wp*epsilon(1.0_wp))**2) return
      call normalise(elements, pencil, next, mass_times(:, n + 1), scale, sound)
      if (.not. sound) return
      n = n + 1
      basis(:, n) = next
    end subroutine add_vector

  end subroutine search

  !> A shift below all modes: zero, or below eigenvalues that loads have made negative.
  pure subroutine find_definite_shift(elements, plan, pencil, shift, factorizations, is_definite)
    type(elements_t), intent(in) :: elements
    type(elimination_plan_t), intent(in) :: plan
    type(element_pencil_t), intent(inout) :: pencil
    real(wp), intent(out) :: shift
    integer, intent(inout) :: factorizations
    logical, intent(out) :: is_definite !! false: none was found

    integer :: i, below

    shift = 0.0_wp
    call count_below(elements, plan, pencil, shift, below, factorizations)
    is_definite = below == 0
    if (is_definite) return
    ! Quotients of the diagonals are about the size of eigenvalues.
    shift = -maxval(abs(pencil%stiffness))/maxval(pencil%mass)
    do i = 1, 60
      call count_below(elements, plan, pencil, shift, below, factorizations)
      is_definite = below == 0
      if (is_definite) return
      shift = 4.0_wp*shift
    end do
  end subroutine find_definite_shift

  !> The largest eigenvalues of a symmetric matrix.
  subroutine largest_of(matrix, wanted, value, vectors, error)
    real(wp), intent(in) :: matrix(:, :)
    integer, intent(in) :: wanted
    real(wp), allocatable, intent(out) :: value(:)
    real(wp), allocatable, intent(out) :: vectors(:, :)
    type(error_t), allocatable, intent(out) :: error

    real(wp) :: unit(size(matrix, 1), size(matrix, 1))
    integer :: i

    unit = 0.0_wp
    do i = 1, size(unit, 1)
      unit(i, i) = 1.0_wp
    end do
    allocate (value(wanted))
    call solve_dense(full_band(unit), full_band(matrix), wanted, .true., value, vectors, error)
  end subroutine largest_of

end module element_eigensolver
