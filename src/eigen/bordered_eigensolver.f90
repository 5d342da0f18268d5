! src/eigen/ - eigenproblems of matrices whose unknowns have numbers and no names.
! In: matrices, the number of modes wanted. Out: modes with error bounds, and a proof that none is
! missing. Begin with `find_bordered_modes` here; for dampers `find_damped_modes` in
! `damped_eigensolver.f90`, for band matrices `find_modes` in `nodal_eigensolver.f90`.
! Not here: the matrices (`src/base/numerics`), what their unknowns mean (`src/vibration`), Floquet
! exponents (`src/response/stability`).

!> The lowest modes of `K y = λ M y` with `K = I + G` for bordered matrices, each with an error
!! bound, and a proof that none is missing.
!!
!! Free motions, which have 0 in place of 1 in K, are modes as others under loads. Without loads
!! they are the lowest modes, with an eigenvalue of exactly zero, and all others are orthogonal to
!! them.
module bordered_eigensolver
  use band_matrix, only: band_matrix_t, full_band
  use bordered_matrix, only: all_unknowns, bordered_matrix_t, bordered_times_vector, dense_form, &
    layout_t
  use bordered_pencil, only: bordered_pencil_t, elastic_square, stiffness_times_vector
  use bordered_solver, only: solve_shifted
  use completeness_proof, only: count_limit, count_margin, is_complete, rest_norm
  use dense_eigensolver, only: solve_dense
  use eigenvalue_gaps, only: relative_error, relative_gap
  use errors, only: error_of_numerics, error_t, set_error
  use free_motions, only: balanced_pencil, balancing_factors, eigenvalue_scale, rest_modes
  use kinds, only: wp
  use nodal_eigensolver, only: find_definite_shift
  use sorting, only: ascending_order
  use sturm_count, only: shifted
  use text, only: to_string
  implicit none (type, external)
  private

  public :: bordered_modes_t, start_t, find_bordered_modes, new_start, overlaps, choose_modes

  !> Start values for a search, from neighbouring positions or a dense eigenproblem.
  type :: start_t
    integer :: modes = 0                     !! 0: no start
    real(wp), allocatable :: lambda(:)       !! (modes) estimated eigenvalues [1/s²]
    real(wp), allocatable :: direction(:, :) !! (unknowns, modes) M y, of any length
  end type start_t

  !> Modes found, with their errors and the work done.
  type :: bordered_modes_t
    real(wp), allocatable :: lambda(:)             !! (modes) ω², ascending; there may be more modes
                                                   !! than requested [1/s²]
    real(wp), allocatable :: vector(:, :)          !! (unknowns, modes) with yᵀMy = 1
    real(wp), allocatable :: mass_times(:, :)      !! (unknowns, modes) M y
    real(wp), allocatable :: stiffness_times(:, :) !! (unknowns, modes) K y
    real(wp), allocatable :: error(:)              !! (modes) bound of the relative error of λ, for
                                                   !! these matrices
    integer, allocatable :: origin(:)              !! (modes) number of the mode of the start that
                                                   !! led to it
    integer :: zeros = 0                           !! free motions at rest: the first modes, with λ
                                                   !! and error exactly 0
    integer :: near = 0                            !! modes wanted, and those within the clearance
                                                   !! above them
    real(wp) :: clear = 0.0_wp                     !! relative distance above the last wanted mode
                                                   !! up to which no mode is missing
    real(wp) :: rest = 0.0_wp                      !! norm that, below 1, proves that no mode up to
                                                   !! the last requested one is missing
    integer :: factorizations = 0                  !! of the bordered matrix: one per inverse
                                                   !! iteration, one per Cholesky proof
    integer :: full_solutions = 0                  !! of the dense eigenproblem of all unknowns
    integer :: reduced_solutions = 0               !! of the dense eigenproblem of the first few
                                                   !! modes of every link
  end type bordered_modes_t

  integer, parameter :: most_iterations = 8

  !> Two starts have converged to the same mode where the overlap yᵢᵀMyⱼ of their modes is above
  !! this.
  real(wp), parameter :: most_overlap = 1.0e-5_wp

  !> Relative distance of eigenvalues below which a mode is kept orthogonal to those found before.
  real(wp), parameter :: same_eigenvalue = 1.0e-3_wp

  !> A start is a free motion where its eigenvalue is below this share of the eigenvalues of modes
  !! that deform.
  real(wp), parameter :: same_zero = 1.0e-8_wp

  !> Rounding error of an eigenvalue, in units of ε times the terms that cancel in its Rayleigh
  !! quotient.
  real(wp), parameter :: rounding = 16.0_wp

  !> Below `most_rest` the proof holds, with a margin for its own rounding. Modes beyond those
  !! wanted support the proof. They are kept for the next position unless the norm is below
  !! `easy_rest` without them.
  real(wp), parameter :: most_rest = 0.999_wp, easy_rest = 0.8_wp

  !> Up to this number of modes requested, sums of squares are tried first: for more they are rarely
  !! sharp enough, and cost more than a factorization.
  integer, parameter :: most_by_norm = 8

  !> Relative distance from the last wanted mode up to which a factorization is first to prove that
  !! there is no other: it bounds the error of the last mode better than the least one.
  real(wp), parameter :: wide_margin = 1.0e-3_wp

  !> Modes beyond those requested in a search without a start: at first, and at most.
  integer, parameter :: first_guards = 2, most_guards = 32

  !> Searches for modes within the clearance, once those requested are proven.
  integer, parameter :: most_attempts = 3

  !> Approximate relative accuracy of the last eigenvalue of a dense start. Inverse iteration finds
  !! the remaining digits.
  real(wp), parameter :: start_accuracy = 1.0e-6_wp

contains

  !> No start values: the search begins with a dense eigenproblem.
  pure function new_start() result(start)
    type(start_t) :: start

    start%modes = 0
    allocate (start%lambda(0), start%direction(0, 0))
  end function new_start

  !> Finds the lowest modes from a start; without one, or if its modes are not proven to be
  !! complete, from a dense eigenproblem.
  !!
  !! Every mode is improved by inverse iteration at its Rayleigh quotient until the error of its
  !! eigenvalue is below rounding. If there are modes within the clearance above the last one
  !! wanted, they are found, too, if that can be done; `found%near` counts them in. Errors: more
  !! modes wanted than unknowns; the dense eigenproblem fails; no start leads to enough modes that
  !! are proven to be complete.
  subroutine find_bordered_modes(pencil, wanted, accurate_vectors, start, found, error, clearance)
    type(bordered_pencil_t), intent(in) :: pencil    !! G and M; free motions in any unit
    integer, intent(in) :: wanted                    !! number of modes
    logical, intent(in) :: accurate_vectors          !! all digits in the vectors, too, not only in
                                                     !! the eigenvalues
    type(start_t), intent(in) :: start               !! used if it has at least the modes requested
    type(bordered_modes_t), intent(inout) :: found   !! the modes wanted, perhaps more; what it held
                                                     !! is lost, but its room is used again
    type(error_t), allocatable, intent(out) :: error !! allocated on failure
    real(wp), intent(in), optional :: clearance      !! relative distance above the last wanted mode
                                                     !! within which modes are to be found, too;
                                                     !! absent: 0

    real(wp) :: distance

    distance = 0.0_wp
    if (present(clearance)) distance = clearance
    if (pencil%layout%free == 0) then
      call search(pencil, wanted, accurate_vectors, start, distance, 0.0_wp, found, error)
    else
      call search_balanced(pencil, wanted, accurate_vectors, start, distance, found, error)
    end if
  end subroutine find_bordered_modes

  !> The search with free motions, in units in which they have about the mass of the others.
  subroutine search_balanced(pencil, wanted, accurate_vectors, start, distance, found, error)
    type(bordered_pencil_t), intent(in) :: pencil
    integer, intent(in) :: wanted
    logical, intent(in) :: accurate_vectors
    type(start_t), intent(in) :: start
    real(wp), intent(in) :: distance !! the clearance
    type(bordered_modes_t), intent(inout) :: found
    type(error_t), allocatable, intent(out) :: error

    type(bordered_pencil_t) :: balanced
    type(start_t) :: balanced_start
    real(wp) :: factor(pencil%layout%free)
    integer :: i, stiff

    stiff = pencil%layout%border - pencil%layout%free
    factor = balancing_factors(pencil)
    balanced = balanced_pencil(pencil, factor)
    balanced_start = start
    do i = 1, size(factor)
      associate (k => stiff + i)
        if (start%modes > 0) balanced_start%direction(k, :) = factor(i)*start%direction(k, :)
      end associate
    end do
    call search(balanced, wanted, accurate_vectors, balanced_start, distance, &
      eigenvalue_scale(balanced), found, error)
    if (allocated(error)) return
    do i = 1, size(factor)
      associate (k => stiff + i)
        found%vector(k, :) = factor(i)*found%vector(k, :)
        found%mass_times(k, :) = found%mass_times(k, :)/factor(i)
        found%stiffness_times(k, :) = found%stiffness_times(k, :)/factor(i)
      end associate
    end do
  end subroutine search_balanced

  !> The search of `find_bordered_modes`.
  subroutine search(pencil, wanted, accurate_vectors, start, distance, scale, found, error)
    type(bordered_pencil_t), intent(in) :: pencil
    integer, intent(in) :: wanted
    logical, intent(in) :: accurate_vectors
    type(start_t), intent(in) :: start
    real(wp), intent(in) :: distance !! the clearance
    real(wp), intent(in) :: scale    !! of eigenvalues, with free motions; else 0 [1/s²]
    type(bordered_modes_t), intent(inout) :: found
    type(error_t), allocatable, intent(out) :: error

    type(start_t) :: dense_start
    type(bordered_modes_t) :: proven_modes
    integer, allocatable :: leading(:)
    integer :: guards, attempt
    logical :: proven, known

    found%factorizations = 0
    found%full_solutions = 0
    found%reduced_solutions = 0
    found%zeros = merge(0, pencil%layout%free, pencil%loaded)
    if (wanted > pencil%layout%unknowns) then
      call set_error(error, error_of_numerics, to_string(wanted)// &
        " modes are asked for, and there are only "//to_string(pencil%layout%unknowns)//" unknowns")
      return
    end if
    if (wanted <= found%zeros) then
      ! Without loads nothing has an eigenvalue below zero, and nothing else that of zero.
      call make_room(found, pencil%layout%unknowns, found%zeros)
      call place_rest_modes(pencil, start%modes, found)
      found%near = found%zeros
      found%clear = huge(found%clear)
      found%rest = 0.0_wp
      return
    end if
    known = .false.
    if (start%modes >= wanted) then
      call improve_all(pencil, wanted, accurate_vectors, distance, scale, start, found, proven)
      if (is_enough(found, proven, distance, proven_modes, known)) return
    end if
    leading = leading_unknowns(pencil, wanted)
    guards = first_guards + pencil%layout%free
    attempt = 0
    ! Nearly all unknowns are as expensive as all of them.
    do while (4*size(leading) < 3*pencil%layout%unknowns)
      call solve_dense_start(pencil, leading, wanted + guards, scale, dense_start, &
        found%factorizations, error)
      if (.not. allocated(error)) then
        found%reduced_solutions = found%reduced_solutions + 1
        call improve_all(pencil, wanted, accurate_vectors, distance, scale, dense_start, found, &
          proven)
        if (is_enough(found, proven, distance, proven_modes, known)) return
      end if
      attempt = attempt + 1
      if (known .and. attempt >= most_attempts) exit
      leading = softest_unknowns(pencil, 2*size(leading))
      guards = min(2*guards, most_guards)
    end do
    if (.not. (known .and. attempt >= most_attempts)) then
      guards = first_guards + pencil%layout%free
      do
        guards = min(2*guards, pencil%layout%unknowns - wanted)
        call solve_dense_start(pencil, all_unknowns(pencil%layout), wanted + guards, scale, &
          dense_start, found%factorizations, error)
        found%full_solutions = found%full_solutions + 1
        if (allocated(error)) exit
        call improve_all(pencil, wanted, accurate_vectors, distance, scale, dense_start, found, &
          proven)
        if (is_enough(found, proven, distance, proven_modes, known)) return
        attempt = attempt + 1
        if (known .and. attempt >= most_attempts) exit
        if (guards == pencil%layout%unknowns - wanted .or. guards >= most_guards) exit
      end do
    end if
    if (known) then
      ! Proven up to the modes wanted; what is just above them was not found, be it because a dense
      ! eigenproblem failed.
      if (allocated(error)) deallocate (error)
      call keep_counts(found, proven_modes)
      found = proven_modes
      return
    end if
    if (allocated(error)) return
    if (found%rest > 0.0_wp .and. found%rest < huge(found%rest)) then
      call set_error(error, error_of_numerics, &
        "it could not be proven that no mode is missing (norm of the remainder "// &
        to_string(found%rest, 3)//")")
    else if (size(found%lambda) >= wanted) then
      call set_error(error, error_of_numerics, "it could not be proven that no mode is missing")
    else
      call set_error(error, error_of_numerics, "fewer modes were found than requested")
    end if
  end subroutine search

  !> Whether the modes are proven and reach far enough; if they are proven only, they are kept.
  logical function is_enough(found, proven, distance, proven_modes, known)
    type(bordered_modes_t), intent(in) :: found
    logical, intent(in) :: proven
    real(wp), intent(in) :: distance
    type(bordered_modes_t), intent(inout) :: proven_modes
    logical, intent(inout) :: known !! whether there are proven modes already

    is_enough = proven .and. found%clear >= distance
    if (is_enough .or. .not. proven .or. known) return
    proven_modes = found
    known = .true.
  end function is_enough

  !> Adds up the work of further attempts.
  pure subroutine keep_counts(from, to)
    type(bordered_modes_t), intent(in) :: from
    type(bordered_modes_t), intent(inout) :: to

    to%factorizations = from%factorizations
    to%full_solutions = from%full_solutions
    to%reduced_solutions = from%reduced_solutions
  end subroutine keep_counts

  !> Improves every mode of a start, sorts them, and checks that they are complete.
  subroutine improve_all(pencil, wanted, accurate_vectors, distance, scale, start, found, proven)
    type(bordered_pencil_t), intent(in) :: pencil
    integer, intent(in) :: wanted
    logical, intent(in) :: accurate_vectors
    real(wp), intent(in) :: distance
    real(wp), intent(in) :: scale
    type(start_t), intent(in) :: start
    type(bordered_modes_t), intent(inout) :: found
    logical, intent(out) :: proven

    real(wp) :: gap
    integer :: i, number, order(found%zeros + start%modes)
    logical :: converged

    proven = .false.
    call make_room(found, pencil%layout%unknowns, size(order))
    if (found%zeros > 0) call place_rest_modes(pencil, start%modes, found)
    number = found%zeros
    do i = 1, start%modes
      if (found%zeros > 0 .and. start%lambda(i) <= same_zero*scale) cycle
      found%lambda(number + 1) = start%lambda(i)
      found%mass_times(:, number + 1) = start%direction(:, i)
      gap = relative_gap(start%lambda, i, scale)
      ! Those near zero are separated afterwards.
      if (abs(start%lambda(i)) <= same_eigenvalue*scale) gap = max(gap, same_eigenvalue)
      call improve(pencil, accurate_vectors, gap, scale, number + 1, found, converged)
      if (.not. converged) cycle
      ! Two starts may converge to one mode. If a requested mode is lost that way, the proof fails.
      if (overlaps(found%vector(:, number + 1), found%mass_times(:, :number))) cycle
      number = number + 1
      found%origin(number) = i
    end do
    if (number < wanted) then
      call choose_modes(found, [(i, i=1, number)])
      return
    end if
    if (scale > 0.0_wp .and. pencil%loaded) call separate(pencil, same_eigenvalue*scale, number, &
      found)
    order(:number) = ascending_order(found%lambda(:number))
    if (number < size(order) .or. any(order(2:number) < order(:number - 1))) then
      call choose_modes(found, order(:number))
    end if
    call check(pencil, wanted, distance, scale, found, proven)
  end subroutine improve_all

  !> Separates modes with eigenvalues near zero, be they as near to each other as rounding: the
  !! modes of the matrix `yᵢᵀKyⱼ`.
  subroutine separate(pencil, near_zero, number, found)
    type(bordered_pencil_t), intent(in) :: pencil
    real(wp), intent(in) :: near_zero !! [1/s²]
    integer, intent(in) :: number     !! modes so far
    type(bordered_modes_t), intent(inout) :: found

    real(wp), allocatable :: products(:, :), unit(:, :), mixed(:, :), inverse(:)
    integer, allocatable :: alike(:)
    type(error_t), allocatable :: error
    integer :: i, n

    alike = pack([(i, i=1, number)], abs(found%lambda(:number)) <= near_zero)
    n = size(alike)
    if (n < 2) return
    allocate (unit(n, n), inverse(n))
    unit = 0.0_wp
    do i = 1, n
      unit(i, i) = 1.0_wp
    end do
    products = matmul(transpose(found%vector(:, alike)), found%stiffness_times(:, alike))
    products = 0.5_wp*(products + transpose(products))
    call solve_dense(full_band(unit), full_band(products), n, .true., inverse, mixed, error)
    ! Without it the modes are as they were, and their bounds say how good that is.
    if (allocated(error)) return
    found%vector(:, alike) = matmul(found%vector(:, alike), mixed)
    do i = 1, n
      associate (mode => alike(i))
        call bordered_times_vector(pencil%layout, pencil%mass, found%vector(:, mode), &
          found%mass_times(:, mode))
        call stiffness_times_vector(pencil, found%vector(:, mode), found%stiffness_times(:, mode))
        found%lambda(mode) = dot_product(found%vector(:, mode), found%stiffness_times(:, mode))
      end associate
    end do
  end subroutine separate

  !> The free motions at rest, in the first columns.
  pure subroutine place_rest_modes(pencil, starts, found)
    type(bordered_pencil_t), intent(in) :: pencil !! without loads
    integer, intent(in) :: starts                 !! modes of the start
    type(bordered_modes_t), intent(inout) :: found

    integer :: i

    call rest_modes(pencil, found%vector(:, :found%zeros), found%mass_times(:, :found%zeros))
    do i = 1, found%zeros
      found%lambda(i) = 0.0_wp
      found%error(i) = 0.0_wp
      found%stiffness_times(:, i) = 0.0_wp
      ! Where the start was that of a loaded linkage, it has no mode that leads to this one.
      found%origin(i) = max(1, min(i, starts))
    end do
  end subroutine place_rest_modes

  !> Allocates arrays for this many modes; previous contents are lost.
  pure subroutine make_room(found, unknowns, modes)
    type(bordered_modes_t), intent(inout) :: found
    integer, intent(in) :: unknowns, modes

    if (allocated(found%lambda) .and. allocated(found%stiffness_times)) then
      if (all(shape(found%stiffness_times) == [unknowns, modes])) return
    end if
    if (allocated(found%lambda)) deallocate (found%lambda)
    if (allocated(found%error)) deallocate (found%error)
    if (allocated(found%origin)) deallocate (found%origin)
    if (allocated(found%vector)) deallocate (found%vector)
    if (allocated(found%mass_times)) deallocate (found%mass_times)
    if (allocated(found%stiffness_times)) deallocate (found%stiffness_times)
    allocate (found%lambda(modes), found%error(modes), found%origin(modes))
    allocate (found%vector(unknowns, modes), found%mass_times(unknowns, modes), &
      found%stiffness_times(unknowns, modes))
  end subroutine make_room

  !> Whether a mode is already among those found.
  pure function overlaps(vector, mass_times)
    real(wp), intent(in) :: vector(:)        !! (unknowns)
    real(wp), intent(in) :: mass_times(:, :) !! (unknowns, modes) M times those found
    logical :: overlaps

    integer :: j

    overlaps = .false.
    do j = 1, size(mass_times, 2)
      overlaps = overlaps .or. abs(dot_product(vector, mass_times(:, j))) > most_overlap
    end do
  end function overlaps

  !> Keeps the modes listed, in this order.
  pure subroutine choose_modes(found, order)
    type(bordered_modes_t), intent(inout) :: found !! with K y or without
    integer, intent(in) :: order(:)                !! their numbers

    found%lambda = found%lambda(order)
    found%error = found%error(order)
    found%origin = found%origin(order)
    found%vector = found%vector(:, order)
    found%mass_times = found%mass_times(:, order)
    if (allocated(found%stiffness_times)) found%stiffness_times = found%stiffness_times(:, order)
  end subroutine choose_modes

  !> Inverse iteration at the Rayleigh quotient. The mode's column of `found` holds the start: a
  !! direction `M y` and an estimate of the eigenvalue. `found%error` becomes |r|²/λ; divided by the
  !! relative gap, this is the relative error of λ.
  !!
  !! Modes with nearly the same eigenvalue in the columns before are projected out in every step.
  !! Without that, rounding alone would decide to which of them the iteration converges. So are the
  !! free motions at rest.
  pure subroutine improve(pencil, accurate_vector, gap_guess, least_size, mode, found, converged)
    type(bordered_pencil_t), intent(in) :: pencil
    logical, intent(in) :: accurate_vector
    real(wp), intent(in) :: gap_guess  !! relative distance of the nearest other eigenvalue
    real(wp), intent(in) :: least_size !! lesser eigenvalues are compared as if of this size [1/s²]
    integer, intent(in) :: mode        !! number of its column
    type(bordered_modes_t), intent(inout) :: found
    logical, intent(out) :: converged

    !> Beyond this exponent, squares overflow or underflow.
    integer, parameter :: most_exponent = maxexponent(1.0_wp)/2 - digits(1.0_wp)
    real(wp) :: residual, square, scale, error, previous, largest, apart
    integer :: i, j, pass

    associate (lambda => found%lambda(mode), vector => found%vector(:, mode), &
        mass_times => found%mass_times(:, mode), stiffness_times => found%stiffness_times(:, mode))
      previous = huge(previous)
      ! These values remain if rounding leaves nothing of M or of the direction.
      converged = .false.
      residual = 0.0_wp
      stiffness_times = 0.0_wp
      do i = 1, most_iterations
        call solve_shifted(pencil, lambda, mass_times, vector)
        found%factorizations = found%factorizations + 1
        ! Normalised before the products, so that nothing overflows.
        largest = maxval(abs(vector))
        if (.not. (largest > 0.0_wp .and. largest <= huge(largest))) exit
        if (abs(exponent(largest)) > most_exponent) vector = vector/largest
        vector = vector/sqrt(dot_product(vector, vector))
        apart = same_eigenvalue*max(abs(lambda), least_size)
        ! Twice: the second pass restores the orthogonality that the first loses to rounding.
        do pass = 1, 2
          do j = 1, mode - 1
            if (abs(found%lambda(j) - lambda) > apart .and. j > found%zeros) cycle
            vector = vector - dot_product(found%mass_times(:, j), vector)*found%vector(:, j)
            vector = vector/sqrt(dot_product(vector, vector))
          end do
        end do
        call bordered_times_vector(pencil%layout, pencil%mass, vector, mass_times)
        call stiffness_times_vector(pencil, vector, stiffness_times)
        square = dot_product(vector, mass_times)
        if (.not. square > 0.0_wp) exit
        scale = 1.0_wp/sqrt(square)
        vector = scale*vector
        mass_times = scale*mass_times
        stiffness_times = scale*stiffness_times
        lambda = dot_product(vector, stiffness_times)
        ! With yᵀMy = 1 and K near I: |y|² = scale² is about λ, and the error of λ about |r|²/gap.
        residual = sum((stiffness_times - lambda*mass_times)**2)
        error = residual/max(gap_guess, epsilon(1.0_wp))
        converged = error <= 0.25_wp*epsilon(1.0_wp)*abs(lambda)
        if (accurate_vector) converged = converged .and. error <= (1.0e-13_wp*scale)**2
        if (converged) exit
        ! The residual no longer falls because of rounding: this accuracy is final.
        if (i > 2 .and. residual >= 0.25_wp*previous) then
          converged = error <= 1.0e-10_wp*max(abs(lambda), 1.0e-6_wp*scale**2, least_size)
          exit
        end if
        previous = residual
      end do
      found%error(mode) = residual/max(abs(lambda), tiny(lambda))
    end associate
  end subroutine improve

  !> Sum of the magnitudes of the terms of `yᵀKy/yᵀMy`, relative to λ: the factor by which rounding
  !! is amplified.
  !!
  !! For M, by the Cauchy–Schwarz inequality, `|M_jk| ≤ √(M_jj M_kk)`.
  pure function cancellation(mass, layout, vector, stiffness_times, lambda)
    type(bordered_matrix_t), intent(in) :: mass
    type(layout_t), intent(in) :: layout
    real(wp), intent(in) :: vector(:), stiffness_times(:), lambda
    real(wp) :: cancellation

    cancellation = mass_terms(mass, layout, vector) + &
      (dot_product(vector, vector) + sum(abs(vector*(stiffness_times - vector))))/max(abs(lambda), &
      tiny(lambda))
  end function cancellation

  !> A bound of the terms of `yᵀMy`.
  pure function mass_terms(mass, layout, vector) result(terms)
    type(bordered_matrix_t), intent(in) :: mass
    type(layout_t), intent(in) :: layout
    real(wp), intent(in) :: vector(:)
    real(wp) :: terms

    real(wp) :: size_of
    integer :: i

    size_of = 0.0_wp
    do i = 1, layout%border
      size_of = size_of + abs(vector(i))*sqrt(mass%border(i, i))
    end do
    do i = layout%border + 1, layout%unknowns
      size_of = size_of + abs(vector(i))*sqrt(mass%diagonal(i))
    end do
    terms = size_of**2
  end function mass_terms

  !> Proves that the modes are complete up to the last requested one, and bounds their errors.
  !!
  !! Let μ lie just above the last of k modes, Q be an orthonormal basis of their K y, and P the
  !! projection on its complement. If `‖P (μM − G) P‖ < 1`, then `K − μM` is positive on the
  !! complement, so no more than k modes lie below μ: those found. The norm is the Frobenius norm,
  !! from sums of squares. Where it is not below 1, with free motions, and for many modes, a
  !! Cholesky factorization may still prove completeness.
  subroutine check(pencil, wanted, distance, scale, found, proven)
    type(bordered_pencil_t), intent(in) :: pencil
    integer, intent(in) :: wanted
    real(wp), intent(in) :: distance !! relative, above the last requested mode, to be cleared
    real(wp), intent(in) :: scale    !! of eigenvalues, with free motions: what is added to that of
                                     !! the last requested mode before distances are taken
    type(bordered_modes_t), intent(inout) :: found
    logical, intent(out) :: proven

    real(wp) :: rest(size(found%lambda)), margin, margins(3), least_tried
    integer :: i, kept

    proven = .false.
    found%rest = 0.0_wp
    if (wanted <= most_by_norm .and. pencil%layout%free == 0) then
      rest = huge(1.0_wp)
      do i = wanted, size(rest)
        rest(i) = rest_norm(pencil, count_limit(found%lambda(i)), &
          found%stiffness_times(:, :i))
        if (rest(i) < easy_rest) exit
      end do
      kept = wanted - 1 + minloc(rest(wanted:), dim=1)
      found%rest = rest(kept)
      proven = found%rest < most_rest
      margin = 1.0_wp - found%rest
      found%clear = margin
    end if
    if (proven .and. found%clear < distance) call clear_up_to(distance)
    if (.not. proven) then
      ! A mode may be nearer than the first: then as far as is asked for, and at last the least.
      margins = [max(distance, wide_margin), min(max(distance, count_margin), wide_margin), &
        count_margin]
      least_tried = huge(least_tried)
      do i = 1, size(margins)
        if (margins(i) >= least_tried) cycle
        least_tried = margins(i)
        call clear_up_to(margins(i))
        if (proven) exit
      end do
    end if
    if (.not. proven) return
    if (pencil%layout%free > 0) call bound_errors(pencil, wanted, margin, scale, kept, found)
    do i = merge(1, kept + 1, pencil%layout%free == 0), kept
      found%error(i) = found%error(i)/true_gap(found%lambda, i, wanted, margin) + &
        rounding*epsilon(1.0_wp)*cancellation(pencil%mass, pencil%layout, found%vector(:, i), &
        found%stiffness_times(:, i), found%lambda(i))
    end do
    if (kept < size(found%lambda)) call choose_modes(found, [(i, i=1, kept)])
    found%near = max(wanted, count(found%lambda <= found%lambda(wanted) + &
      distance*abs(found%lambda(wanted))))

  contains

    !> Proves, if it can, that there are no modes but those found up to a relative distance above
    !! the last requested one.
    subroutine clear_up_to(reach)
      real(wp), intent(in) :: reach

      integer :: below
      real(wp) :: limit
      logical :: is_clear

      limit = found%lambda(wanted) + reach*(abs(found%lambda(wanted)) + scale)
      below = count(found%lambda < limit)
      call is_complete(pencil, limit, found%lambda(:below), found%mass_times(:, :below), is_clear)
      found%factorizations = found%factorizations + 1
      if (.not. is_clear) return
      proven = .true.
      kept = below
      margin = reach
      found%clear = reach
    end subroutine clear_up_to

  end subroutine check

  !> Error bounds with free motions, whose eigenvalues may be of any size and sign.
  !!
  !! With a shift σ that makes `B = K + σM` positive definite, and θ = 1/(λ + σ), the modes are
  !! those of `M y = θ B y`. A Rayleigh quotient with the residual `r = K y − λ M y` differs from
  !! the nearest eigenvalue by `rᵀ B⁻¹ r` times `(λ_j + σ)/|λ_j − λ|` at most, with the next
  !! eigenvalue λ_j (Kato and Temple). To this the rounding of the terms of the quotient is added.
  !! Of modes with eigenvalues near zero, which are separated in the space of all of them, the
  !! residuals add up, and the next eigenvalue is the next to them.
  subroutine bound_errors(pencil, wanted, margin, scale, kept, found)
    type(bordered_pencil_t), intent(in) :: pencil
    integer, intent(in) :: wanted
    real(wp), intent(in) :: margin !! of `check`
    real(wp), intent(in) :: scale  !! of eigenvalues [1/s²]
    integer, intent(in) :: kept    !! modes that are complete
    type(bordered_modes_t), intent(inout) :: found

    type(bordered_matrix_t) :: magnitude
    real(wp), dimension(pencil%layout%unknowns) :: residual, solution, products
    real(wp), dimension(size(found%lambda)) :: square, terms, distance
    logical :: alike(size(found%lambda))
    real(wp) :: shift, beyond
    integer :: i

    shift = scale + 2.0_wp*max(0.0_wp, -found%lambda(1))
    beyond = margin*(abs(found%lambda(wanted)) + scale)
    if (pencil%loaded) then
      magnitude = pencil%geometric
      magnitude%border = abs(magnitude%border)
      magnitude%coupling = abs(magnitude%coupling)
      magnitude%block = abs(magnitude%block)
    end if
    alike = pencil%loaded .and. abs(found%lambda) <= same_eigenvalue*scale
    square = 0.0_wp
    terms = 0.0_wp
    do i = found%zeros + 1, size(alike)
      if (i > kept .and. .not. alike(i)) cycle
      associate (lambda => found%lambda(i), y => found%vector(:, i))
        distance(i) = relative_gap([lambda, pack(found%lambda, others(i))], 1, shift)
        ! The next mode may not be known.
        if (i >= wanted) distance(i) = min(distance(i), beyond/(abs(lambda) + beyond + shift))
        residual = found%stiffness_times(:, i) - lambda*found%mass_times(:, i)
        call solve_shifted(pencil, -shift, residual, solution)
        found%factorizations = found%factorizations + 1
        square(i) = max(0.0_wp, dot_product(residual, solution))
        terms(i) = abs(lambda)*mass_terms(pencil%mass, pencil%layout, y) + &
          elastic_square(pencil%layout, y)
        if (pencil%loaded) then
          call bordered_times_vector(pencil%layout, magnitude, abs(y), products)
          terms(i) = terms(i) + dot_product(abs(y), products)
        end if
      end associate
    end do
    do i = found%zeros + 1, kept
      associate (together => alike .and. alike(i))
        found%error(i) = relative_error(max(square(i), sum(square, mask=together))/ &
          max(distance(i), epsilon(1.0_wp)) + rounding*epsilon(1.0_wp)*max(terms(i), sum(terms, &
          mask=together)), found%lambda(i))
      end associate
    end do

  contains

    !> The modes from which one is to be told apart.
    pure function others(mode)
      integer, intent(in) :: mode
      logical :: others(size(alike))

      others = .not. (alike .and. alike(mode))
      others(mode) = .false.
    end function others

  end subroutine bound_errors

  !> Relative distance of an eigenvalue to the nearest other one. From the last wanted mode on, the
  !! next mode may not be known; the proof then limits how near it can be.
  pure function true_gap(lambda, i, wanted, margin) result(distance)
    real(wp), intent(in) :: lambda(:)
    integer, intent(in) :: i, wanted
    real(wp), intent(in) :: margin !! relative distance that the proof leaves
    real(wp) :: distance

    distance = max(relative_gap(lambda, i), epsilon(1.0_wp))
    if (i >= wanted) distance = min(distance, max(margin, count_margin))
  end function true_gap

  !> Start from the dense eigenproblem of some unknowns, with the others fixed at zero.
  subroutine solve_dense_start(pencil, chosen, modes, scale, start, factorizations, error)
    type(bordered_pencil_t), intent(in) :: pencil
    integer, intent(in) :: chosen(:) !! numbers of unknowns; all free motions
    integer, intent(in) :: modes
    real(wp), intent(in) :: scale    !! of eigenvalues, with free motions [1/s²]
    type(start_t), intent(out) :: start
    integer, intent(inout) :: factorizations !! counter
    type(error_t), allocatable, intent(out) :: error

    type(band_matrix_t) :: m, k
    real(wp) :: shift, inverse(modes), full(pencil%layout%unknowns)
    real(wp), allocatable :: vector(:, :), dense(:, :), diagonal(:)
    integer :: i

    if (modes > size(chosen)) then
      call set_error(error, error_of_numerics, to_string(modes)//" modes of "// &
        to_string(size(chosen))//" unknowns")
      return
    end if
    m = full_band(dense_form(pencil%layout, pencil%mass, chosen))
    allocate (dense(size(chosen), size(chosen)))
    dense = 0.0_wp
    if (pencil%loaded) dense = dense_form(pencil%layout, pencil%geometric, chosen)
    do i = 1, size(chosen)
      if (is_free(pencil%layout, chosen(i))) cycle
      dense(i, i) = dense(i, i) + 1.0_wp
    end do
    k = full_band(dense)
    shift = 0.0_wp
    if (pencil%layout%free > 0) then
      call find_definite_shift(k, m, shift, factorizations, scale)
    else if (pencil%loaded) then
      call find_definite_shift(k, m, shift, factorizations)
    end if
    ! Quotients of the diagonals approximate the eigenvalues, and so the size of the last one
    ! wanted.
    diagonal = m%entry(1, :)/(k%entry(1, :) + shift*m%entry(1, :))
    diagonal = diagonal(ascending_order(diagonal))
    call solve_dense(shifted(k, m, shift), m, modes, .true., inverse, vector, error, &
      start_accuracy*abs(diagonal(size(chosen) - modes + 1)))
    if (allocated(error)) return
    start%modes = modes
    start%lambda = 1.0_wp/inverse - shift
    allocate (start%direction(pencil%layout%unknowns, modes))
    do i = 1, modes
      full = 0.0_wp
      full(chosen) = vector(:, i)
      call bordered_times_vector(pencil%layout, pencil%mass, full, start%direction(:, i))
    end do
  end subroutine solve_dense_start

  !> Whether an unknown is a free motion.
  pure logical function is_free(layout, unknown)
    type(layout_t), intent(in) :: layout
    integer, intent(in) :: unknown

    is_free = unknown > layout%border - layout%free .and. unknown <= layout%border
  end function is_free

  !> The border and the first own modes of every link: a cheap basis that gives good starts for the
  !! lowest modes. Where that is more than enough, only the softest of them.
  pure function leading_unknowns(pencil, wanted) result(chosen)
    type(bordered_pencil_t), intent(in) :: pencil
    integer, intent(in) :: wanted
    integer, allocatable :: chosen(:)

    !> A mode of the linkage at a high number is made of own modes of all links up to about this
    !! part of its number more.
    integer, parameter :: share = 3, least = 12
    integer :: b, i

    associate (layout => pencil%layout)
      chosen = [(i, i=1, layout%border)]
      do b = 1, size(layout%size)
        chosen = [chosen, (layout%first(b) + i - 1, i=1, min(layout%size(b), wanted + 2))]
      end do
      i = layout%border + wanted + wanted/share + least
      if (size(chosen) > i) chosen = softest_unknowns(pencil, i)
    end associate
  end function leading_unknowns

  !> The border and the own modes, along and across, that the matrices' diagonals make the softest.
  pure function softest_unknowns(pencil, number) result(chosen)
    type(bordered_pencil_t), intent(in) :: pencil
    integer, intent(in) :: number !! at most, with the border
    integer, allocatable :: chosen(:)

    real(wp) :: softness(pencil%layout%unknowns)
    integer :: b, i, k, order(pencil%layout%unknowns)
    logical :: taken(pencil%layout%unknowns)

    associate (layout => pencil%layout)
      softness = pencil%mass%diagonal
      softness(:layout%border) = huge(softness)
      if (pencil%loaded) then
        do b = 1, size(layout%size)
          do i = 1, layout%size(b)
            k = layout%first(b) + i - 1
            softness(k) = softness(k)/max(1.0_wp + pencil%geometric%block(i, i, b), &
              epsilon(1.0_wp))
          end do
        end do
      end if
      order = ascending_order(-softness)
      taken = .false.
      taken(order(:min(max(number, layout%border), layout%unknowns))) = .true.
      chosen = pack(all_unknowns(layout), taken)
    end associate
  end function softest_unknowns

end module bordered_eigensolver
