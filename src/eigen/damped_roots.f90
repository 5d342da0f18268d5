!> Roots of `(s² M + s C + K) y = 0`, each improved from a start and kept once; their error bounds.
module damped_roots
  use bordered_eigensolver, only: bordered_modes_t
  use bordered_matrix, only: bordered_matrix_t, bordered_times_vector
  use bordered_pencil, only: bordered_pencil_t
  use bordered_solver, only: solve_shifted
  use damped_solver, only: damped_system_t, damping_times_vector, mass_times_complex, &
    solve_damped, stiffness_times_complex
  use kinds, only: wp
  use sorting, only: ascending_order
  implicit none (type, external)
  private

  public :: damped_modes_t, root_list_t, new_root_list, bound_errors, same_root

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

  !> Roots that are found, in any order.
  type :: root_list_t
    integer :: number = 0                    !! of roots
    integer :: zeros = 0                     !! the first of them, which are exactly zero
    real(wp) :: least = 0.0_wp               !! where there are such, smaller |s| are zero [1/s]
    complex(wp), allocatable :: s(:)         !! (room) [1/s]
    complex(wp), allocatable :: vector(:, :) !! (unknowns, room) y with yᴴMy = 1
    integer :: solutions = 0                 !! of complex equations
  contains
    procedure :: place_zeros
    procedure :: improve_start
    procedure :: improve_pair
    procedure :: keep
    procedure :: is_zero
    procedure :: sort_into
  end type root_list_t

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

contains

  !> A list without roots.
  pure function new_root_list(unknowns, room, scale) result(list)
    integer, intent(in) :: unknowns
    integer, intent(in) :: room      !! for so many roots
    real(wp), intent(in) :: scale    !! of |s|² of modes that deform [1/s²]
    type(root_list_t) :: list

    allocate (list%s(room), list%vector(unknowns, room))
    list%least = no_root*sqrt(scale)
  end function new_root_list

  !> Roots that are exactly zero: free motions at rest, once where dampers slow them down, and twice
  !! where they do not.
  pure subroutine place_zeros(self, dampers, undamped)
    class(root_list_t), intent(inout) :: self
    real(wp), intent(in) :: dampers(:, :)          !! of `damped_system_t`
    type(bordered_modes_t), intent(in) :: undamped !! the first of them free motions at rest

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
    self%zeros = 2*undamped%zeros - rank
    self%number = self%zeros
    self%s(:self%zeros) = 0.0_wp
    do i = 1, self%zeros
      self%vector(:, i) = undamped%vector(:, min(i, undamped%zeros))
    end do
  end subroutine place_zeros

  !> Whether a root is zero but for rounding.
  pure function is_zero(self, s) result(zero)
    class(root_list_t), intent(in) :: self
    complex(wp), intent(in) :: s !! [1/s]
    logical :: zero

    zero = self%zeros > 0 .and. abs(s) <= self%least
  end function is_zero

  !> Improves a start and keeps the root.
  pure subroutine improve_start(self, system, start, direction)
    class(root_list_t), intent(inout) :: self
    type(damped_system_t), intent(in) :: system
    complex(wp), intent(in) :: start        !! [1/s]
    complex(wp), intent(in) :: direction(:) !! (unknowns)

    complex(wp) :: s, y(size(direction))
    logical :: converged

    if (self%is_zero(start)) return
    s = start
    y = direction
    if (aimag(s) > 0.0_wp .and. aimag(s) <= hardly_swings*abs(s)) then
      call self%improve_pair(system, s, y)
    else
      call improve(system, s, y, self%solutions, converged)
      if (converged) call self%keep(system, s, y)
    end if
  end subroutine improve_start

  !> A pair that hardly swings may be two real roots.
  pure subroutine improve_pair(self, system, s, y)
    class(root_list_t), intent(inout) :: self
    type(damped_system_t), intent(in) :: system
    complex(wp), intent(inout) :: s, y(:) !! a start

    complex(wp) :: shape(size(y)), root
    integer :: side
    logical :: converged

    call improve(system, s, y, self%solutions, converged)
    if (abs(aimag(s)) > hardly_swings*abs(s)) then
      if (converged) call self%keep(system, s, y)
      return
    end if
    do side = -1, 1, 2
      root = real(s, wp)*(1.0_wp + side*hardly_swings)
      shape = real(y/y(maxloc(abs(y), dim=1)), wp)
      call improve(system, root, shape, self%solutions, converged)
      if (converged) call self%keep(system, root, shape)
    end do
  end subroutine improve_pair

  !> Keeps a root unless it is there already.
  pure subroutine keep(self, system, root, shape)
    class(root_list_t), intent(inout) :: self
    type(damped_system_t), intent(in) :: system
    complex(wp), intent(in) :: root, shape(:)

    complex(wp) :: s, y(size(shape)), mass_times(size(shape))
    integer :: j

    ! A start that is zero but for rounding falls to zero.
    if (self%is_zero(root)) return
    s = root
    y = shape
    if (aimag(s) < 0.0_wp) then
      s = conjg(s)
      y = conjg(y)
    end if
    mass_times = mass_times_complex(system%pencil, y)
    do j = self%zeros + 1, self%number
      if (abs(self%s(j) - s) > same_root*abs(s)) cycle
      if (1.0_wp - abs(dot_product(self%vector(:, j), mass_times))**2 <= same_vector**2) return
    end do
    self%number = self%number + 1
    self%s(self%number) = s
    self%vector(:, self%number) = y
  end subroutine keep

  !> Hands the roots on, ascending by |s|; their errors are 0 for the time being.
  pure subroutine sort_into(self, found)
    class(root_list_t), intent(in) :: self
    type(damped_modes_t), intent(inout) :: found

    integer :: order(self%number)

    order = ascending_order(abs(self%s(:self%number)))
    found%s = self%s(order)
    found%vector = self%vector(:, order)
    found%swings = abs(aimag(found%s)) > 0.0_wp
    found%error = 0.0_wp*abs(found%s)
    found%solutions = found%solutions + self%solutions
  end subroutine sort_into

  !> Inverse iteration: s is the root of `a s² + b s + k` with `a = yᵀMy`, `b = yᵀCy` and
  !! `k = yᵀKy`, transposed and not conjugate, for the matrices are symmetric and so yᵀ is the left
  !! vector; it converges with the third power. A real s stays real.
  pure subroutine improve(system, s, y, solutions, converged)
    type(damped_system_t), intent(in) :: system
    complex(wp), intent(inout) :: s         !! a start; becomes the root [1/s]
    complex(wp), intent(inout) :: y(:)      !! (unknowns) a start; becomes the vector
    integer, intent(inout) :: solutions     !! counter
    logical, intent(out) :: converged

    integer, parameter :: most_iterations = 12
    complex(wp), dimension(size(y)) :: right, mass_times, damping_times
    complex(wp) :: before
    real(wp) :: square, largest, change, last
    integer :: i

    converged = .false.
    mass_times = mass_times_complex(system%pencil, y)
    last = huge(last)
    do i = 1, most_iterations
      right = 2.0_wp*s*mass_times + damping_times_vector(system%dampers, y)
      call solve_damped(system%pencil, system%dampers, s, right, y)
      solutions = solutions + 1
      largest = maxval(abs(y%re) + abs(y%im))
      if (.not. (largest > 0.0_wp .and. largest <= huge(largest))) return
      y = y/largest
      mass_times = mass_times_complex(system%pencil, y)
      square = real(dot_product(y, mass_times), wp)
      if (.not. square > 0.0_wp) return
      y = y/sqrt(square)
      mass_times = mass_times/sqrt(square)
      damping_times = damping_times_vector(system%dampers, y)
      before = s
      s = nearest_root(sum(y*mass_times), sum(y*damping_times), &
        sum(y*stiffness_times_complex(system%pencil, y)), s)
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
  subroutine bound_errors(system, zeros, kept, least_shift, found)
    type(damped_system_t), intent(in) :: system
    integer, intent(in) :: zeros        !! the first roots, which are exact
    integer, intent(in) :: kept         !! the first roots, which are complete
    real(wp), intent(in) :: least_shift !! that makes the stiffness definite [1/s²]
    type(damped_modes_t), intent(inout) :: found

    type(bordered_matrix_t) :: magnitude
    complex(wp), dimension(system%pencil%layout%unknowns) :: residual, mass_times, damping_times
    real(wp), dimension(system%pencil%layout%unknowns) :: moved, stretched
    real(wp) :: reach(size(system%dampers, 2)), terms, slope, distance, second
    integer :: i

    associate (pencil => system%pencil, dampers => system%dampers)
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
          distance = distance_to_others(found, i)
          second = second_order(pencil, residual, abs(s)**2 + least_shift)
          found%error(i) = root_error((rounding*epsilon(1.0_wp)*terms + 2.0_wp*second*abs(s)/ &
            distance)/max(slope, tiny(slope)), distance)/max(abs(s), tiny(slope))
        end associate
      end do
    end associate
  end subroutine bound_errors

  !> Distance of a root to the nearest other one, and to those beyond the radius [1/s].
  pure function distance_to_others(found, i) result(distance)
    type(damped_modes_t), intent(in) :: found !! all roots, with the radius
    integer, intent(in) :: i                  !! number of the root
    real(wp) :: distance

    integer :: j

    associate (s => found%s(i))
      distance = found%radius - abs(s)
      do j = 1, size(found%s)
        if (j /= i) distance = min(distance, abs(found%s(j) - s))
        if (found%swings(j)) distance = min(distance, abs(conjg(found%s(j)) - s))
      end do
      distance = max(distance, epsilon(1.0_wp)*abs(s))
    end associate
  end function distance_to_others

  !> `rᵀ(K + σM)⁻¹r` for the real and the imaginary part of a residual r, added.
  function second_order(pencil, residual, shift) result(second)
    type(bordered_pencil_t), intent(in) :: pencil
    complex(wp), intent(in) :: residual(:) !! (unknowns)
    real(wp), intent(in) :: shift          !! σ [1/s²]
    real(wp) :: second

    real(wp) :: solution(size(residual))

    call solve_shifted(pencil, -shift, real(residual, wp), solution)
    second = abs(dot_product(real(residual, wp), solution))
    call solve_shifted(pencil, -shift, aimag(residual), solution)
    second = second + abs(dot_product(aimag(residual), solution))
  end function second_order

  !> The error of a root at a distance from others, where it would be `first` without them [1/s].
  elemental function root_error(first, distance) result(error)
    real(wp), intent(in) :: first, distance !! [1/s]
    real(wp) :: error

    if (4.0_wp*first <= distance) then
      error = 2.0_wp*first/(1.0_wp + sqrt(1.0_wp - 4.0_wp*first/distance))
    else
      error = 0.5_wp*(distance + sqrt(distance**2 + 4.0_wp*first*distance))
    end if
  end function root_error

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

end module damped_roots
