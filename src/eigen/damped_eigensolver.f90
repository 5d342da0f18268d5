!> The lowest roots s of `(s² M + s C + K) y = 0` for bordered matrices with dampers between
!! unknowns of the border, each with an error bound, and a proof that none is missing.
!!
!! Starts come from the equations of a few shapes: the lowest undamped modes, and what forces at the
!! dampers do statically. They hold the roots of every damping, however strong, real ones too, and
!! need not be followed from those without dampers. Each is improved by inverse iteration in complex
!! numbers. What is found is counted: `damped_count` tells how many roots there are in a disc.
module damped_eigensolver
  use bordered_eigensolver, only: bordered_modes_t, find_bordered_modes, start_t
  use bordered_matrix, only: bordered_matrix_t, bordered_times_vector
  use bordered_pencil, only: bordered_pencil_t, stiffness_times_vector
  use bordered_solver, only: solve_shifted
  use damped_count, only: count_in_disc, moment_count, response_t
  use damped_solver, only: damping_times_vector, mass_times_complex, solve_damped, &
    stiffness_times_complex
  use errors, only: error_of_numerics, error_t, set_error
  use free_motions, only: balanced_pencil, balancing_factors
  use kinds, only: wp
  use lapack, only: dgeev, dgetrf, dgetrs
  use sorting, only: ascending_order
  use text, only: to_string
  implicit none (type, external)
  private

  public :: damped_modes_t, find_damped_modes

  !> Roots with Im s ≥ 0, by |s|: one of every conjugate pair, and the real ones, each by itself. A
  !! mode that does not swing (overdamped) has two real roots, which need not be neighbours.
  type :: damped_modes_t
    complex(wp), allocatable :: s(:)          !! (modes) ascending by |s|; there may be more modes
                                              !! than requested [1/s]
    complex(wp), allocatable :: vector(:, :)  !! (unknowns, modes) y with yᴴMy = 1
    real(wp), allocatable :: error(:)         !! (modes) bound of |Δs|/|s|, for these matrices; 0
                                              !! where s is exactly 0
    logical, allocatable :: swings(:)         !! (modes) one of a conjugate pair; .false.: s is real
    real(wp) :: radius = 0.0_wp               !! no root is missing with |s| below this [1/s]
    integer :: solutions = 0                  !! of complex equations
    integer :: counts = 0                     !! of roots in a disc
    integer :: searches = 0                   !! for more undamped modes than were given
  end type damped_modes_t

  !> Undamped modes beyond those requested with which the first attempt is made, and by how many
  !! times this number is raised from attempt to attempt.
  integer, parameter :: first_guards = 4, most_attempts = 6

  integer, parameter :: most_iterations = 12

  !> Shapes that are nearly combinations of others are left out.
  real(wp), parameter :: independent = 1.0e-7_wp

  !> Roots nearer than this, relative to their size, may be one and the same, found twice.
  real(wp), parameter :: same_root = 1.0e-6_wp

  !> Roots below this share of those of modes that deform are zero, those of free motions at rest.
  real(wp), parameter :: no_root = 1.0e-13_wp

  !> Two vectors of unit length are the same if the one without its part along the other is shorter.
  real(wp), parameter :: same_vector = 1.0e-4_wp

  !> Rounding error, in units of ε times the terms that cancel.
  real(wp), parameter :: rounding = 16.0_wp

  !> An imaginary part of this size, relative to |s|, may be rounding.
  real(wp), parameter :: hardly_swings = 1.0e-6_wp

  !> Dampers that move by less than this share of the length of their rows do not move.
  real(wp), parameter :: no_damping = 1.0e-12_wp

  !> The disc about all roots found ends at so many times the last.
  real(wp), parameter :: last_gap = 2.0_wp

contains

  !> Finds the lowest roots, by |s|.
  !!
  !! Errors: negative constants; fewer roots than wanted; the undamped modes fail; no attempt leads
  !! to as many roots as are counted.
  subroutine find_damped_modes(pencil, rows, constant, wanted, undamped, complete, found, error)
    type(bordered_pencil_t), intent(in) :: pencil  !! G and M; free motions in any unit
    real(wp), intent(in) :: rows(:, :)             !! (border, dampers) velocity of each damper for
                                                   !! unit velocities of the border
    real(wp), intent(in) :: constant(:)            !! (dampers) c, in units in which `C = Σ c b bᵀ`
                                                   !! has that of √(M K) [s]
    integer, intent(in) :: wanted                  !! number of roots with Im s ≥ 0
    type(bordered_modes_t), intent(in) :: undamped !! lowest modes without dampers
    integer, intent(in) :: complete                !! as many of them miss none
    type(damped_modes_t), intent(out) :: found     !! the roots wanted, perhaps more
    type(error_t), allocatable, intent(out) :: error !! allocated on failure

    type(bordered_pencil_t) :: balanced
    type(bordered_modes_t) :: modes
    real(wp) :: factor(pencil%layout%free), dampers(size(rows, 1), size(rows, 2))
    integer :: i, stiff

    if (any(constant < 0.0_wp)) then
      call set_error(error, error_of_numerics, "the constant of a damper is negative")
      return
    end if
    if (wanted > pencil%layout%unknowns) then
      call set_error(error, error_of_numerics, to_string(wanted)// &
        " modes are asked for, and there are only "//to_string(pencil%layout%unknowns)//" unknowns")
      return
    end if
    stiff = pencil%layout%border - pencil%layout%free
    factor = balancing_factors(pencil)
    balanced = balanced_pencil(pencil, factor)
    modes = undamped
    do i = 1, size(rows, 2)
      dampers(:, i) = sqrt(constant(i))*rows(:, i)
    end do
    do i = 1, size(factor)
      dampers(stiff + i, :) = factor(i)*dampers(stiff + i, :)
      modes%vector(stiff + i, :) = modes%vector(stiff + i, :)/factor(i)
      modes%mass_times(stiff + i, :) = modes%mass_times(stiff + i, :)*factor(i)
    end do
    call search(balanced, independent_columns(dampers), wanted, modes, complete, found, error)
    if (allocated(error)) return
    do i = 1, size(factor)
      found%vector(stiff + i, :) = factor(i)*found%vector(stiff + i, :)
    end do
  end subroutine find_damped_modes

  !> The search of `find_damped_modes`, with more undamped modes from attempt to attempt.
  subroutine search(pencil, dampers, wanted, undamped, complete, found, error)
    type(bordered_pencil_t), intent(in) :: pencil
    real(wp), intent(in) :: dampers(:, :) !! (border, dampers) rows times √c, independent
    integer, intent(in) :: wanted
    type(bordered_modes_t), intent(inout) :: undamped
    integer, intent(in) :: complete
    type(damped_modes_t), intent(inout) :: found
    type(error_t), allocatable, intent(out) :: error

    type(start_t) :: start
    real(wp), allocatable :: shapes(:, :)
    complex(wp), allocatable :: s(:), vector(:, :)
    type(response_t) :: response
    integer :: attempt, guards, known, number
    logical :: proven

    guards = first_guards + size(dampers, 2)
    known = complete
    do attempt = 1, most_attempts
      number = min(wanted + guards, pencil%layout%unknowns)
      if (known < number) then
        start = start_t(0, undamped%lambda, undamped%mass_times)
        if (size(undamped%lambda) >= number) start%modes = size(undamped%lambda)
        call find_bordered_modes(pencil, number, .true., start, undamped, error)
        found%searches = found%searches + 1
        if (allocated(error)) return
        known = number
      end if
      call build_shapes(pencil, dampers, undamped, known, shapes, response)
      call solve_reduced(pencil, dampers, shapes, undamped%zeros, s, vector)
      call improve_all(pencil, dampers, wanted, s, vector, undamped, response, found, proven)
      if (proven) return
      if (known == pencil%layout%unknowns) exit
      guards = 2*guards
    end do
    call set_error(error, error_of_numerics, &
      "it could not be proven that no damped mode is missing")
  end subroutine search

  !> A basis of the column space of dampers such that B Bᵀ stays: as it is where the columns are
  !! independent; where some are combinations of others, fewer columns.
  pure function independent_columns(dampers) result(columns)
    real(wp), intent(in) :: dampers(:, :) !! (border, dampers)
    real(wp), allocatable :: columns(:, :)

    real(wp), parameter :: dependent = 1.0e-12_wp
    real(wp) :: basis(size(dampers, 1), size(dampers, 2)), part(size(dampers, 2), &
      size(dampers, 2)), rest(size(dampers, 1))
    real(wp), allocatable :: square(:, :)
    integer :: i, j, n, pass, order(size(dampers, 2))
    logical :: silent

    n = 0
    part = 0.0_wp
    silent = .false.
    order = ascending_order(-norm2(dampers, dim=1))
    do i = 1, size(order)
      rest = dampers(:, order(i))
      do pass = 1, 2
        do j = 1, n
          part(j, order(i)) = part(j, order(i)) + dot_product(basis(:, j), rest)
          rest = rest - dot_product(basis(:, j), rest)*basis(:, j)
        end do
      end do
      if (norm2(rest) <= dependent*norm2(dampers(:, order(i)))) then
        silent = .true.
        cycle
      end if
      n = n + 1
      part(n, order(i)) = norm2(rest)
      basis(:, n) = rest/norm2(rest)
    end do
    if (.not. silent) then
      columns = dampers
      return
    end if
    ! B = Q R, and R Rᵀ = L Lᵀ has few rows.
    square = matmul(part(:n, :), transpose(part(:n, :)))
    do j = 1, n
      square(j, j) = sqrt(square(j, j) - sum(square(j, :j - 1)**2))
      do i = j + 1, n
        square(i, j) = (square(i, j) - sum(square(i, :j - 1)*square(j, :j - 1)))/square(j, j)
      end do
      square(j, j + 1:) = 0.0_wp
    end do
    columns = matmul(basis(:, :n), square)
  end function independent_columns

  !> Shapes for the reduced equations, orthonormal in M: undamped modes, what forces at the dampers
  !! do statically, and what the inertia of that does; and what the dampers are told by all modes.
  subroutine build_shapes(pencil, dampers, undamped, known, shapes, response)
    type(bordered_pencil_t), intent(in) :: pencil
    real(wp), intent(in) :: dampers(:, :)
    type(bordered_modes_t), intent(in) :: undamped
    integer, intent(in) :: known                    !! undamped modes that miss none
    real(wp), allocatable, intent(out) :: shapes(:, :) !! (unknowns, shapes)
    type(response_t), intent(out) :: response

    real(wp), dimension(pencil%layout%unknowns, size(dampers, 2)) :: first, second, mass_first, &
      mass_second
    real(wp) :: force(pencil%layout%unknowns), inverse
    integer :: d, i, j, modes, n

    d = size(dampers, 2)
    n = pencil%layout%border
    modes = size(undamped%lambda)
    response%lambda = undamped%lambda
    response%limit = undamped%lambda(known)
    if (known == pencil%layout%unknowns) response%limit = huge(1.0_wp)
    response%shift = 2.0_wp*max(0.0_wp, -undamped%lambda(1)) + &
      1.0e-2_wp*maxval(abs(undamped%lambda(:known)))
    allocate (response%excitation(d, modes), response%moment(d, d, moment_count), &
      response%rounding(d, moment_count))
    do i = 1, modes
      response%excitation(:, i) = matmul(undamped%vector(:n, i), dampers)
    end do
    do i = 1, d
      force = 0.0_wp
      force(:n) = dampers(:, i)
      call solve_shifted(pencil, -response%shift, force, first(:, i))
      call bordered_times_vector(pencil%layout, pencil%mass, first(:, i), mass_first(:, i))
      call solve_shifted(pencil, -response%shift, mass_first(:, i), second(:, i))
      call bordered_times_vector(pencil%layout, pencil%mass, second(:, i), mass_second(:, i))
    end do
    response%moment(:, :, 1) = matmul(transpose(dampers), first(:n, :))
    response%moment(:, :, 2) = matmul(transpose(first), mass_first)
    response%moment(:, :, 3) = matmul(transpose(first), mass_second)
    response%moment(:, :, 4) = matmul(transpose(second), mass_second)
    do i = 1, moment_count
      associate (moment => response%moment(:, :, i))
        response%rounding(:, i) = 64.0_wp*epsilon(1.0_wp)*[(abs(moment(j, j)), j=1, d)]
        do j = 1, modes
          inverse = 1.0_wp/(undamped%lambda(j) + response%shift)
          moment = moment - inverse**i*matmul(reshape(response%excitation(:, j), [d, 1]), &
            reshape(response%excitation(:, j), [1, d]))
        end do
      end associate
    end do
    if (known == pencil%layout%unknowns) then
      ! There are no other modes.
      response%moment = 0.0_wp
      response%rounding = 0.0_wp
    end if
    allocate (shapes(pencil%layout%unknowns, modes + 2*d))
    shapes(:, :modes) = undamped%vector
    i = modes
    do j = 1, d
      call add_shape(first(:, j))
      call add_shape(second(:, j))
    end do
    shapes = shapes(:, :i)

  contains

    !> Adds the part of a shape that is orthogonal to the others in M, if anything is left of it.
    subroutine add_shape(shape)
      real(wp), intent(in) :: shape(:)

      real(wp), dimension(size(shape)) :: part, product
      real(wp) :: before
      integer :: k, pass

      part = shape
      call bordered_times_vector(pencil%layout, pencil%mass, part, product)
      before = dot_product(part, product)
      if (.not. before > 0.0_wp) return
      do pass = 1, 2
        do k = 1, i
          part = part - dot_product(product, shapes(:, k))*shapes(:, k)
          call bordered_times_vector(pencil%layout, pencil%mass, part, product)
        end do
      end do
      if (.not. dot_product(part, product) > independent**2*before) return
      i = i + 1
      shapes(:, i) = part/sqrt(dot_product(part, product))
    end subroutine add_shape

  end subroutine build_shapes

  !> All roots of the reduced equations, with s = σ0 + 1/μ: those near a positive σ0 do not suffer
  !! from others that are far away. Where LAPACK fails, none.
  !!
  !! Of a free motion at rest the velocity is the unknown, so that its position has no root: those
  !! at zero would be multiple and spoil small ones.
  subroutine solve_reduced(pencil, dampers, shapes, zeros, s, vector)
    type(bordered_pencil_t), intent(in) :: pencil
    real(wp), intent(in) :: dampers(:, :)
    real(wp), intent(in) :: shapes(:, :)              !! (unknowns, shapes)
    integer, intent(in) :: zeros                      !! the first shapes: free motions at rest
    complex(wp), allocatable, intent(out) :: s(:)     !! (roots) with Im s ≥ 0
    complex(wp), allocatable, intent(out) :: vector(:, :) !! (unknowns, roots)

    real(wp), dimension(size(shapes, 2), size(shapes, 2)) :: mass, damping, stiffness, factor
    real(wp) :: told(size(dampers, 2), size(shapes, 2)), product(size(shapes, 1))
    real(wp) :: right(size(shapes, 2), 2*size(shapes, 2)), whole(2*size(shapes, 2), &
      2*size(shapes, 2)), shape(2*size(shapes, 2), 2*size(shapes, 2))
    real(wp) :: re(2*size(shapes, 2)), im(2*size(shapes, 2)), work(32*size(shapes, 2)), none(1, 1)
    real(wp) :: near
    complex(wp) :: mu, part(size(shapes, 2))
    integer :: pivot(size(shapes, 2)), i, n, number, info

    n = size(shapes, 2)
    told = matmul(transpose(dampers), shapes(:size(dampers, 1), :))
    damping = matmul(transpose(told), told)
    do i = 1, n
      call stiffness_times_vector(pencil, shapes(:, i), product)
      stiffness(:, i) = matmul(product, shapes)
      call bordered_times_vector(pencil%layout, pencil%mass, shapes(:, i), product)
      mass(:, i) = matmul(product, shapes)
    end do
    near = sqrt(2.0_wp*max(0.0_wp, -minval([(stiffness(i, i), i=1, n)])) + &
      0.1_wp*minval([(abs(stiffness(i, i)), i=1, n)], mask=[(abs(stiffness(i, i)) > &
      1.0e-6_wp*maxval(abs(stiffness)), i=1, n)]))
    stiffness(:, :zeros) = damping(:, :zeros)
    damping(:, :zeros) = mass(:, :zeros)
    mass(:, :zeros) = 0.0_wp
    factor = stiffness + near*(damping + near*mass)
    right(:, :n) = -mass
    right(:, n + 1:) = -(damping + 2.0_wp*near*mass)
    call dgetrf(n, n, factor, n, pivot, info)
    if (info == 0) then
      call dgetrs("N", n, 2*n, factor, n, pivot, right, n, info)
      whole = 0.0_wp
      do i = 1, n
        whole(i, n + i) = 1.0_wp
      end do
      whole(n + 1:, :) = right
      call dgeev("N", "V", 2*n, whole, 2*n, re, im, none, 1, shape, 2*n, work, size(work), info)
    end if
    number = 0
    allocate (s(2*n), vector(size(shapes, 1), 2*n))
    if (info == 0) then
      do i = 1, 2*n
        ! 1/μ turns the sign of the imaginary part: of a pair μ the second gives Im s > 0.
        if (im(i) > 0.0_wp) cycle
        mu = cmplx(re(i), im(i), wp)
        if (abs(mu) <= tiny(near)) cycle
        number = number + 1
        s(number) = near + 1.0_wp/mu
        part = shape(:n, i)
        if (im(i) < 0.0_wp) part = cmplx(shape(:n, i - 1), -shape(:n, i), wp)
        if (zeros > 0) part(zeros + 1:) = s(number)*part(zeros + 1:)
        vector(:, number) = cmplx(matmul(shapes, real(part, wp)), matmul(shapes, aimag(part)), wp)
      end do
    end if
    s = s(:number)
    vector = vector(:, :number)
  end subroutine solve_reduced

  !> Improves the lowest roots, and counts them.
  subroutine improve_all(pencil, dampers, wanted, start, direction, undamped, response, found, &
      proven)
    type(bordered_pencil_t), intent(in) :: pencil
    real(wp), intent(in) :: dampers(:, :)
    integer, intent(in) :: wanted
    complex(wp), intent(in) :: start(:), direction(:, :)
    type(bordered_modes_t), intent(in) :: undamped
    type(response_t), intent(in) :: response
    type(damped_modes_t), intent(inout) :: found
    logical, intent(out) :: proven

    integer, allocatable :: order(:)
    real(wp), allocatable :: size_of(:)
    real(wp) :: next
    complex(wp) :: s, y(pencil%layout%unknowns)
    integer :: i, number, zeros, inside, counted
    logical :: converged

    proven = .false.
    if (allocated(found%s)) deallocate (found%s, found%vector, found%error, found%swings)
    number = size(start) + 2*pencil%layout%free
    allocate (found%s(number), found%vector(pencil%layout%unknowns, number), found%error(number), &
      found%swings(number))
    call place_zeros(dampers, undamped, found, zeros)
    number = zeros
    order = ascending_order(abs(start))
    do i = 1, size(order)
      if (number >= wanted + size(dampers, 2) + 3) exit
      s = start(order(i))
      y = direction(:, order(i))
      if (zeros > 0 .and. abs(s) <= no_root*sqrt(response%shift)) cycle
      if (aimag(s) > 0.0_wp .and. aimag(s) <= hardly_swings*abs(s)) then
        call improve_pair(s, y)
      else
        call improve(pencil, dampers, s, y, found%solutions, converged)
        if (converged) call keep(s, y)
      end if
    end do
    order = ascending_order(abs(found%s(:number)))
    found%s = found%s(order)
    found%vector = found%vector(:, order)
    found%swings = abs(aimag(found%s)) > 0.0_wp
    found%error = found%error(order)
    if (number < wanted) return
    size_of = abs(found%s)
    ! A disc that holds those wanted, as far as can be from roots and undamped modes.
    do i = wanted, number
      next = last_gap*size_of(i)
      if (i < number) next = size_of(i + 1)
      if (next <= (1.0_wp + same_root)*size_of(i)) cycle
      found%radius = widest_gap(size_of(i), next, response)
      if (found%radius**2 >= response%limit) exit
      counted = count_in_disc(response, found%radius)
      found%counts = found%counts + 1
      inside = i + count(found%swings(:i))
      if (counted /= inside) cycle
      proven = .true.
      exit
    end do
    if (.not. proven) return
    call bound_errors(pencil, dampers, zeros, i, number, 2.0_wp*max(0.0_wp, &
      -undamped%lambda(1)), found)
    ! No real root has an imaginary part of −0.
    found%s = cmplx(real(found%s(:i), wp), abs(aimag(found%s(:i))), wp)
    found%vector = found%vector(:, :i)
    found%error = found%error(:i)
    found%swings = found%swings(:i)

  contains

    !> Keeps a root unless it is there already.
    subroutine keep(root, shape)
      complex(wp), intent(in) :: root, shape(:)

      complex(wp) :: s, y(size(shape)), mass_times(size(shape))
      integer :: j

      s = root
      y = shape
      ! A start that is zero but for rounding falls to zero.
      if (zeros > 0 .and. abs(s) <= no_root*sqrt(response%shift)) return
      if (aimag(s) < 0.0_wp) then
        s = conjg(s)
        y = conjg(y)
      end if
      mass_times = mass_times_complex(pencil, y)
      do j = zeros + 1, number
        if (abs(found%s(j) - s) > same_root*abs(s)) cycle
        if (1.0_wp - abs(dot_product(found%vector(:, j), mass_times))**2 <= same_vector**2) return
      end do
      number = number + 1
      found%s(number) = s
      found%vector(:, number) = y
      found%error(number) = 0.0_wp
    end subroutine keep

    !> A pair that hardly swings may be two real roots.
    subroutine improve_pair(s, y)
      complex(wp), intent(inout) :: s, y(:)

      complex(wp) :: part(size(y)), root
      integer :: side

      call improve(pencil, dampers, s, y, found%solutions, converged)
      if (abs(aimag(s)) > hardly_swings*abs(s)) then
        if (converged) call keep(s, y)
        return
      end if
      do side = -1, 1, 2
        root = real(s, wp)*(1.0_wp + side*hardly_swings)
        part = real(y/y(maxloc(abs(y), dim=1)), wp)
        call improve(pencil, dampers, root, part, found%solutions, converged)
        if (converged) call keep(root, part)
      end do
    end subroutine improve_pair

  end subroutine improve_all

  !> Roots that are exactly zero: free motions at rest, once where dampers slow them down, and twice
  !! where they do not.
  subroutine place_zeros(dampers, undamped, found, zeros)
    real(wp), intent(in) :: dampers(:, :)
    type(bordered_modes_t), intent(in) :: undamped
    type(damped_modes_t), intent(inout) :: found
    integer, intent(out) :: zeros

    real(wp) :: told(size(dampers, 2), undamped%zeros), largest
    integer :: i, j, rank

    told = matmul(transpose(dampers), undamped%vector(:size(dampers, 1), :undamped%zeros))
    largest = maxval([0.0_wp, norm2(dampers, dim=1)])
    rank = 0
    do i = 1, undamped%zeros
      j = maxloc(norm2(told, dim=1), dim=1)
      if (norm2(told(:, j)) <= no_damping*largest) exit
      rank = rank + 1
      associate (unit => told(:, j)/norm2(told(:, j)))
        told = told - matmul(reshape(unit, [size(unit), 1]), reshape(matmul(unit, told), [1, &
          size(told, 2)]))
      end associate
    end do
    zeros = 2*undamped%zeros - rank
    found%s(:zeros) = 0.0_wp
    found%error(:zeros) = 0.0_wp
    do i = 1, zeros
      found%vector(:, i) = undamped%vector(:, min(i, undamped%zeros))
    end do
  end subroutine place_zeros

  !> The radius in an interval that is the farthest, by factors, from its ends and all undamped
  !! modes.
  pure function widest_gap(low, high, response) result(radius)
    real(wp), intent(in) :: low, high !! [1/s]
    type(response_t), intent(in) :: response
    real(wp) :: radius

    real(wp) :: mark(size(response%lambda) + 2), widest
    integer :: i, n

    n = 1
    mark(1) = max(low, 1.0e-3_wp*high)
    do i = 1, size(response%lambda)
      associate (own => sqrt(abs(response%lambda(i))))
        if (own <= mark(1) .or. own >= high) cycle
        n = n + 1
        mark(n) = own
      end associate
    end do
    n = n + 1
    mark(n) = high
    mark(:n) = mark(ascending_order(mark(:n)))
    widest = 0.0_wp
    radius = high
    do i = 1, n - 1
      if (mark(i + 1)/mark(i) <= widest) cycle
      widest = mark(i + 1)/mark(i)
      radius = sqrt(mark(i)*mark(i + 1))
    end do
  end function widest_gap

  !> Inverse iteration: s is the root of `a s² + b s + k` with `a = yᵀMy`, `b = yᵀCy` and
  !! `k = yᵀKy`, transposed and not conjugate, for the matrices are symmetric and so yᵀ is the left
  !! vector; it converges with the third power. A real s stays real.
  pure subroutine improve(pencil, dampers, s, y, solutions, converged)
    type(bordered_pencil_t), intent(in) :: pencil
    real(wp), intent(in) :: dampers(:, :)
    complex(wp), intent(inout) :: s         !! a start; becomes the root [1/s]
    complex(wp), intent(inout) :: y(:)      !! (unknowns) a start; becomes the vector
    integer, intent(inout) :: solutions     !! counter
    logical, intent(out) :: converged

    complex(wp), dimension(size(y)) :: right, mass_times, damping_times
    complex(wp) :: before
    real(wp) :: square, largest, change, last
    integer :: i

    converged = .false.
    mass_times = mass_times_complex(pencil, y)
    last = huge(last)
    do i = 1, most_iterations
      right = 2.0_wp*s*mass_times + damping_times_vector(dampers, y)
      call solve_damped(pencil, dampers, s, right, y)
      solutions = solutions + 1
      largest = maxval(abs(y%re) + abs(y%im))
      if (.not. (largest > 0.0_wp .and. largest <= huge(largest))) return
      y = y/largest
      mass_times = mass_times_complex(pencil, y)
      square = real(dot_product(y, mass_times), wp)
      if (.not. square > 0.0_wp) return
      y = y/sqrt(square)
      mass_times = mass_times/sqrt(square)
      damping_times = damping_times_vector(dampers, y)
      before = s
      s = nearest_root(sum(y*mass_times), sum(y*damping_times), &
        sum(y*stiffness_times_complex(pencil, y)), s)
      change = abs(s - before)
      converged = change <= 4.0_wp*epsilon(change)*abs(s) .or. (i > 3 .and. change >= 0.5_wp*last &
        .and. change <= 1.0e-7_wp*abs(s))
      if (converged) return
      last = change
    end do
  end subroutine improve

  !> The root of `a s² + b s + k` nearest to a number.
  pure function nearest_root(a, b, k, near) result(s)
    complex(wp), intent(in) :: a, b, k, near
    complex(wp) :: s

    complex(wp) :: half, other

    if (abs(aimag(a)) + abs(aimag(b)) + abs(aimag(k)) <= 0.0_wp .and. abs(aimag(near)) <= 0.0_wp &
      .and. b%re**2 >= 4.0_wp*a%re*k%re) then
      half = -0.5_wp*(b%re + sign(sqrt(b%re**2 - 4.0_wp*a%re*k%re), b%re))
    else
      half = sqrt(b**2 - 4.0_wp*a*k)
      if (real(half*conjg(b), wp) < 0.0_wp) half = -half
      half = -0.5_wp*(b + half)
    end if
    s = near
    if (abs(half) <= 0.0_wp) then
      if (abs(a) > 0.0_wp) s = 0.0_wp
      return
    end if
    other = k/half
    s = other
    if (abs(a) <= tiny(1.0_wp)) return
    if (abs(half/a - near) < abs(other - near)) s = half/a
  end function nearest_root

  !> Error bounds, once the roots are complete.
  !!
  !! Where yᵀ is the left vector, `|Δs| ≤ ε/|yᵀ(2sM + C)y|` for an ε that holds the rounding of the
  !! terms of `yᵀ(s²M + sC + K)y` and what the residual r does, which is of second order. With
  !! another root at a distance δ the true Δs is a root of `Δs² + δ Δs = δ ε/|yᵀ(2sM + C)y|` at
  !! worst: for a root that is nearly double, the bound is about its square root.
  subroutine bound_errors(pencil, dampers, zeros, kept, number, least_shift, found)
    type(bordered_pencil_t), intent(in) :: pencil
    real(wp), intent(in) :: dampers(:, :)
    integer, intent(in) :: zeros, kept, number
    real(wp), intent(in) :: least_shift !! that makes the stiffness definite [1/s²]
    type(damped_modes_t), intent(inout) :: found

    type(bordered_matrix_t) :: magnitude
    complex(wp), dimension(pencil%layout%unknowns) :: residual, mass_times, damping_times
    real(wp), dimension(pencil%layout%unknowns) :: solution, moved, stretched
    real(wp) :: reach(size(dampers, 2)), terms, slope, distance, shift, second, first
    integer :: i, j

    if (pencil%loaded) then
      magnitude = pencil%geometric
      magnitude%border = abs(magnitude%border)
      magnitude%coupling = abs(magnitude%coupling)
      magnitude%block = abs(magnitude%block)
    end if
    do i = zeros + 1, kept
      associate (s => found%s(i), y => found%vector(:, i))
        mass_times = mass_times_complex(pencil, y)
        damping_times = damping_times_vector(dampers, y)
        residual = s**2*mass_times + s*damping_times + stiffness_times_complex(pencil, y)
        slope = abs(sum(y*(2.0_wp*s*mass_times + damping_times)))
        moved = abs(y)
        ! A strong damper is hardly moved: what cancels in its velocity counts, not its square.
        reach = matmul(moved(:size(dampers, 1)), abs(dampers))
        terms = abs(s)**2*mass_terms(pencil, moved) + elastic_terms(pencil, moved) + &
          abs(s)*dot_product(reach, abs(matmul(y(:size(dampers, 1)), dampers)) + &
          rounding*epsilon(1.0_wp)*reach)
        if (pencil%loaded) then
          call bordered_times_vector(pencil%layout, magnitude, moved, stretched)
          terms = terms + dot_product(moved, stretched)
        end if
        distance = found%radius - abs(s)
        do j = 1, number
          if (j /= i) distance = min(distance, abs(found%s(j) - s))
          if (found%swings(j)) distance = min(distance, abs(conjg(found%s(j)) - s))
        end do
        distance = max(distance, epsilon(1.0_wp)*abs(s))
        shift = abs(s)**2 + least_shift
        second = 0.0_wp
        call solve_shifted(pencil, -shift, real(residual, wp), solution)
        second = second + abs(dot_product(real(residual, wp), solution))
        call solve_shifted(pencil, -shift, aimag(residual), solution)
        second = second + abs(dot_product(aimag(residual), solution))
        first = (rounding*epsilon(1.0_wp)*terms + 2.0_wp*second*abs(s)/distance)/max(slope, &
          tiny(slope))
        if (4.0_wp*first <= distance) then
          first = 2.0_wp*first/(1.0_wp + sqrt(1.0_wp - 4.0_wp*first/distance))
        else
          first = 0.5_wp*(distance + sqrt(distance**2 + 4.0_wp*first*distance))
        end if
        found%error(i) = first/max(abs(s), tiny(first))
      end associate
    end do
  end subroutine bound_errors

  !> A bound of the terms of `yᵀMy`.
  pure function mass_terms(pencil, moved) result(terms)
    type(bordered_pencil_t), intent(in) :: pencil
    real(wp), intent(in) :: moved(:) !! |y|
    real(wp) :: terms

    integer :: i

    terms = 0.0_wp
    do i = 1, pencil%layout%border
      terms = terms + moved(i)*sqrt(pencil%mass%border(i, i))
    end do
    do i = pencil%layout%border + 1, pencil%layout%unknowns
      terms = terms + moved(i)*sqrt(pencil%mass%diagonal(i))
    end do
    terms = terms**2
  end function mass_terms

  !> The terms of twice the elastic energy.
  pure function elastic_terms(pencil, moved) result(terms)
    type(bordered_pencil_t), intent(in) :: pencil
    real(wp), intent(in) :: moved(:) !! |y|
    real(wp) :: terms

    terms = sum(moved(:pencil%layout%border - pencil%layout%free)**2) + &
      sum(moved(pencil%layout%border + 1:)**2)
  end function elastic_terms

end module damped_eigensolver
