!> Floquet exponents of an elastic linkage: `y = e^{σ θ} z(θ)` with z periodic solves the equation
!! of motion without load.
!!
!! The slow motion gives the first approximation. Residual inverse iteration (Neumaier, SIAM J.
!! Numer. Anal. 22 (1985) 914) on the whole equation makes it as accurate as grid and orders allow:
!! with D in place of d/dθ2, the equation at σ is that with D + σ, `L(σ) = L0 + σ L1 + σ² L2`.
module floquet_exponents
  use constants, only: two_pi
  use elastic_equations, only: apply_equation, elastic_terms_t, mass_force, slope_force
  use errors, only: error_t
  use fourier_transform, only: derivatives, fourier_plan_t
  use kinds, only: fineness, wp
  use minimal_residuals, only: add_combination, add_product, minimal_residual_t, start_residual
  use periodic_solver, only: add_slow, complete_solution, slow_part
  use slow_motions, only: slow_basis_t, slow_mode_shape, slow_mode_t, slow_modes, slow_motion_t, &
    solve_slow_shifted
  use sorting, only: ascending_order
  use turn_grids, only: turn_grid_t
  implicit none (type, external)
  private

  public :: floquet_mode_t, find_floquet_modes, find_nearest_mode

  !> The shift from the first approximation at which equations are solved: near enough to converge
  !! in a few rounds, far enough to leave them regular.
  real(wp), parameter :: shift = 1.0e-3_wp

  !> They are given up where the exponent moves away by so much.
  real(wp), parameter :: lost = 100.0_wp
  integer, parameter :: most_rounds = 12, most_products = 40

  !> Exponents change by no more than this in the last round; where only the nearness of resonance
  !! is asked for, by no more than that.
  real(wp), parameter :: fine_change = 1.0e-13_wp*fineness, rough_change = 1.0e-7_wp

  !> No exponent differs more than this from its first approximation.
  real(wp), parameter :: farthest = 0.02_wp

  !> Modes with fewer samples a period are not resolved; exponents of the slow motion are right to
  !! about this much.
  real(wp), parameter :: resolved_samples = 6.0_wp, of_slow_motion = 1.0e-3_wp

  !> Growth of the slow motion above this is looked for in the whole equation.
  real(wp), parameter :: least_growth = 1.0e-6_wp

  !> Rounds that change the exponent by more than this share of the change before lead nowhere; the
  !! first say nothing yet.
  real(wp), parameter :: least_fall = 0.5_wp
  integer, parameter :: first_rounds = 3

  !> Solutions gain so much in a round.
  real(wp), parameter :: gain = 1.0e-4_wp

  !> A mode of free motion.
  type :: floquet_mode_t
    complex(wp) :: exponent = (0.0_wp, 0.0_wp)  !! σ, per radian of the crank; its imaginary part is
                                                !! vibrations per turn, between 0 and 1/2
    real(wp) :: change = 0.0_wp                 !! of the exponent in the last round
    integer :: applications = 0                 !! of the equation, to complex motions
    real(wp) :: frequency = 0.0_wp              !! of its shape at the first crank angle [rad/s]
  end type floquet_mode_t

contains

  !> The modes of lowest frequency.
  !!
  !! Errors: the multipliers of the slow motion do not converge. A mode whose iterations do not
  !! converge keeps its last change.
  subroutine find_floquet_modes(grid, plan, basis, motion, speed, damping, terms, number, modes, &
    error)
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan   !! for its samples
    type(slow_basis_t), intent(in) :: basis    !! of this grid
    type(slow_motion_t), intent(in) :: motion  !! at this speed, with as many steps as samples
    real(wp), intent(in) :: speed              !! ω2 [rad/s]
    real(wp), intent(in) :: damping(:)         !! (unknowns) c [s]
    type(elastic_terms_t), intent(in) :: terms
    integer, intent(in) :: number              !! of modes wanted
    type(floquet_mode_t), allocatable, intent(out) :: modes(:) !! at most as many as slow
                                                               !! coordinates
    type(error_t), allocatable, intent(out) :: error

    type(slow_mode_t), allocatable :: slow(:)
    real(wp), allocatable :: z(:, :)
    integer :: i, n
    integer, allocatable :: order(:)

    call slow_modes(basis, motion, slow, error)
    if (allocated(error)) return
    order = ascending_order(slow%frequency)
    n = min(number, size(slow))
    allocate (modes(n))
    do i = 1, n
      z = expanded(basis, motion, slow(order(i)))
      modes(i)%frequency = slow(order(i))%frequency
      modes(i)%exponent = slow(order(i))%exponent
      call refine(grid, plan, basis, motion, speed, damping, terms, fine_change, z, modes(i))
    end do
  end subroutine find_floquet_modes

  !> The mode whose multiplier is nearest to 1, which says how near the linkage is to resonance, and
  !! the largest growth of any. Only modes count whose vibrations the samples resolve.
  !!
  !! Errors: the multipliers of the slow motion do not converge.
  subroutine find_nearest_mode(grid, plan, basis, motion, speed, damping, terms, near, mode, &
    growth, error)
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan   !! for its samples
    type(slow_basis_t), intent(in) :: basis    !! of this grid
    type(slow_motion_t), intent(in) :: motion  !! at this speed, with as many steps as samples
    real(wp), intent(in) :: speed              !! ω2 [rad/s]
    real(wp), intent(in) :: damping(:)         !! (unknowns) c [s]
    type(elastic_terms_t), intent(in) :: terms
    real(wp), intent(in) :: near               !! nearer multipliers are found from the whole
                                               !! equation
    type(floquet_mode_t), intent(out) :: mode  !! with all applications
    real(wp), intent(out) :: growth            !! largest ln|multiplier|; 0 or less where none is
                                               !! certain to grow
    type(error_t), allocatable, intent(out) :: error

    type(slow_mode_t), allocatable :: slow(:)
    type(floquet_mode_t) :: grown
    real(wp), allocatable :: z(:, :)
    logical, allocatable :: resolved(:)
    integer :: nearest, growing

    growth = 0.0_wp
    call slow_modes(basis, motion, slow, error)
    if (allocated(error)) return
    resolved = slow%frequency <= abs(speed)*motion%steps/resolved_samples
    if (.not. any(resolved)) resolved = slow%frequency <= minval(slow%frequency)
    nearest = minloc(abs(1.0_wp - exp(two_pi*slow%exponent)), dim=1, mask=resolved)
    call take(nearest, abs(1.0_wp - exp(two_pi*slow(nearest)%exponent)) < near, mode)
    growing = maxloc(real(slow%exponent, wp), dim=1, mask=resolved)
    call take(growing, two_pi*real(slow(growing)%exponent) > least_growth, grown)
    ! Growth that is found in the slow motion only may come from its steps.
    growth = two_pi*real(grown%exponent)
    if (grown%change > 0.1_wp*growth) growth = min(growth, 0.0_wp)
    mode%applications = mode%applications + grown%applications

  contains

    !> A mode of the slow motion, or of the whole equation.
    subroutine take(number, whole, mode)
      integer, intent(in) :: number
      logical, intent(in) :: whole
      type(floquet_mode_t), intent(out) :: mode

      mode%exponent = slow(number)%exponent
      mode%frequency = slow(number)%frequency
      mode%change = of_slow_motion
      if (.not. whole) return
      z = expanded(basis, motion, slow(number))
      call refine(grid, plan, basis, motion, speed, damping, terms, rough_change, z, mode)
      ! Iterations that lead elsewhere say nothing.
      if (abs(mode%exponent - slow(number)%exponent) <= farthest .and. &
        mode%change <= farthest) return
      mode%exponent = slow(number)%exponent
      mode%change = farthest
    end subroutine take

  end subroutine find_nearest_mode

  !> A slow mode in all unknowns: real parts, then imaginary parts.
  pure function expanded(basis, motion, mode) result(z)
    type(slow_basis_t), intent(in) :: basis
    type(slow_motion_t), intent(in) :: motion
    type(slow_mode_t), intent(in) :: mode
    real(wp) :: z(size(basis%shape, 1), 2*size(basis%shape, 2))

    complex(wp) :: shape(motion%steps, motion%number)
    integer :: n

    n = size(basis%shape, 2)
    z = 0.0_wp
    shape = slow_mode_shape(motion, mode)
    call add_slow(basis, real(shape, wp), z(:, :n))
    call add_slow(basis, aimag(shape), z(:, n + 1:))
    z = z/norm2(z)
  end function expanded

  !> Improves an exponent and its motion.
  subroutine refine(grid, plan, basis, motion, speed, damping, terms, tolerance, z, mode)
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan
    type(slow_basis_t), intent(in) :: basis
    type(slow_motion_t), intent(in) :: motion
    real(wp), intent(in) :: speed, damping(:)
    type(elastic_terms_t), intent(in) :: terms
    real(wp), intent(in) :: tolerance  !! of the last change
    real(wp), intent(inout) :: z(:, :) !! (samples, real parts and imaginary parts)
    type(floquet_mode_t), intent(inout) :: mode

    real(wp) :: parts(size(z, 1), size(z, 2), 0:2)
    real(wp), dimension(size(z, 1), size(z, 2)) :: residual, along
    complex(wp) :: fixed, before, step
    real(wp) :: last_change
    integer :: round

    fixed = mode%exponent + shift
    last_change = huge(1.0_wp)
    do round = 1, most_rounds
      call apply_parts(grid, plan, speed, damping, terms, z, parts)
      mode%applications = mode%applications + 1
      if (round <= 2) along = solved(slope_of(parts, mode%exponent))
      residual = solved(combined(parts, mode%exponent))
      ! z changes perpendicular to itself.
      step = -product_of(z, residual)/product_of(z, along)
      z = z - residual - times(step, along)
      z = z/norm2(z)
      before = mode%exponent
      mode%exponent = before + step
      mode%change = abs(step)
      if (mode%change <= tolerance) return
      if (.not. mode%change < lost*(1.0_wp + abs(fixed))) return
      if (round > first_rounds .and. mode%change > least_fall*last_change) return
      last_change = mode%change
    end do

  contains

    !> The solution of the equation at the fixed shift.
    function solved(load) result(y)
      real(wp), intent(in) :: load(:, :)
      real(wp) :: y(size(load, 1), size(load, 2))

      type(minimal_residual_t) :: problem
      real(wp), dimension(size(z, 1), size(z, 2)) :: product
      real(wp) :: products(size(z, 1), size(z, 2), 0:2), limit

      y = 0.0_wp
      call approximate(load, product)
      if (norm2(product) <= 0.0_wp) return
      limit = gain*norm2(product)
      call start_residual(product, most_products, problem)
      do while (problem%last <= most_products .and. problem%residual > limit)
        call apply_parts(grid, plan, speed, damping, terms, problem%vector(:, :, problem%last), &
          products)
        mode%applications = mode%applications + 1
        call approximate(combined(products, fixed), product)
        call add_product(problem, product)
      end do
      call add_combination(problem, y)
    end function solved

    !> An approximate solution of the equation at the fixed shift.
    subroutine approximate(load, y)
      real(wp), intent(in) :: load(:, :)
      real(wp), intent(out) :: y(:, :)

      real(wp), dimension(size(z, 1), basis%number) :: part, part_imaginary, slow, slow_imaginary
      integer :: n

      n = size(z, 2)/2
      call slow_part(basis, load(:, :n), part)
      call slow_part(basis, load(:, n + 1:), part_imaginary)
      call solve_slow_shifted(plan, motion, fixed, part/speed**2, part_imaginary/speed**2, slow, &
        slow_imaginary)
      call complete_solution(plan, basis, speed, damping, load(:, :n), part, slow, y(:, :n))
      call complete_solution(plan, basis, speed, damping, load(:, n + 1:), part_imaginary, &
        slow_imaginary, y(:, n + 1:))
    end subroutine approximate

  end subroutine refine

  !> L0, L1 and L2 applied to a complex motion.
  subroutine apply_parts(grid, plan, speed, damping, terms, z, parts)
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan
    real(wp), intent(in) :: speed, damping(:)
    type(elastic_terms_t), intent(in) :: terms
    real(wp), intent(in) :: z(:, :)
    real(wp), intent(out) :: parts(:, :, 0:)

    real(wp), dimension(size(z, 1), size(z, 2)/2) :: rate, product
    integer :: i, j, n

    n = size(z, 2)/2
    do i = 0, 1
      associate (y => z(:, i*n + 1:(i + 1)*n), first => parts(:, i*n + 1:(i + 1)*n, 1))
        call apply_equation(grid, plan, speed, damping, terms, y, parts(:, i*n + 1:(i + 1)*n, 0))
        call derivatives(plan, y, rate)
        call mass_force(grid, rate, product)
        first = 2.0_wp*speed**2*product
        if (terms%coriolis) then
          call slope_force(grid, y, product)
          first = first + 2.0_wp*speed**2*product
        end if
        do j = 1, n
          first(:, j) = first(:, j) + speed*damping(j)*y(:, j)
        end do
        call mass_force(grid, y, product)
        parts(:, i*n + 1:(i + 1)*n, 2) = speed**2*product
      end associate
    end do
  end subroutine apply_parts

  !> `L0 z + σ L1 z + σ² L2 z`.
  pure function combined(parts, exponent) result(total)
    real(wp), intent(in) :: parts(:, :, 0:) !! (samples, real and imaginary parts, power)
    complex(wp), intent(in) :: exponent
    real(wp) :: total(size(parts, 1), size(parts, 2))

    total = parts(:, :, 0) + times(exponent, parts(:, :, 1) + times(exponent, parts(:, :, 2)))
  end function combined

  !> `zᴴ f`.
  pure function product_of(z, f) result(product)
    real(wp), intent(in) :: z(:, :), f(:, :)
    complex(wp) :: product

    integer :: n

    n = size(z, 2)/2
    product = cmplx(sum(z*f), sum(z(:, :n)*f(:, n + 1:)) - sum(z(:, n + 1:)*f(:, :n)), wp)
  end function product_of

  !> `L1 z + 2 σ L2 z`.
  pure function slope_of(parts, exponent) result(total)
    real(wp), intent(in) :: parts(:, :, 0:)
    complex(wp), intent(in) :: exponent
    real(wp) :: total(size(parts, 1), size(parts, 2))

    total = parts(:, :, 1) + times(2.0_wp*exponent, parts(:, :, 2))
  end function slope_of

  !> `c f`.
  pure function times(c, f) result(product)
    complex(wp), intent(in) :: c
    real(wp), intent(in) :: f(:, :) !! (samples, real and imaginary parts)
    real(wp) :: product(size(f, 1), size(f, 2))

    integer :: n

    n = size(f, 2)/2
    product(:, :n) = real(c)*f(:, :n) - aimag(c)*f(:, n + 1:)
    product(:, n + 1:) = real(c)*f(:, n + 1:) + aimag(c)*f(:, :n)
  end function times

end module floquet_exponents
