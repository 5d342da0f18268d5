!> The periodic elastic motion of a linkage at a speed, by GMRES on samples over the turn, with
!! Fourier derivatives.
!!
!! The approximate inverse takes the slow motion exactly, but for its steps, and the rest by its own
!! diagonal, harmonic by harmonic: what is left converges in a few iterations, in all unknowns and
!! all harmonics of the grid.
module periodic_solver
  use elastic_equations, only: apply_equation, equation_parts
  use equations_at_speed, only: equation_at_speed_t
  use errors, only: error_of_numerics, error_t, set_error
  use fourier_transform, only: coefficients_of, values_of
  use interruption, only: was_interrupted
  use kinds, only: wp
  use minimal_residuals, only: add_combination, add_product, minimal_residual_t, start_residual
  use row_products, only: products_of_rows
  use slow_bases, only: slow_basis_t
  use slow_motions, only: solve_slow, solve_slow_shifted
  use strain_dampings, only: mean_damping
  implicit none (type, external)
  private

  public :: solve_periodic, approximate_solution, complete_solution, slow_part, add_slow

  integer, parameter :: most_iterations = 60

  !> GMRES does not see the rounding of its solution: it begins anew from the residual, so often at
  !! most.
  integer, parameter :: most_rounds = 3

  !> A solution with a larger relative residual is none.
  real(wp), parameter :: no_solution = 1.0e-2_wp

  !> Where a harmonic is near the own frequency of a fast deformation, the diagonal is taken as far
  !! from zero as this.
  real(wp), parameter :: least_diagonal = 0.25_wp

contains

  !> Solves the equation for a load, from a start.
  !!
  !! Errors: the iterations do not converge at all.
  subroutine solve_periodic(equation, load, tolerance, y, iterations, remainder, error, &
    last_change, exponent)
    type(equation_at_speed_t), intent(in) :: equation
    real(wp), intent(in) :: load(:, :)          !! (samples, unknowns) [√J]
    real(wp), intent(in) :: tolerance           !! of the last change, relative to y; where rounding
                                                !! does not allow it, `remainder` says so
    real(wp), intent(inout) :: y(:, :)          !! (samples, unknowns) start, then solution [√J]
    integer, intent(out) :: iterations          !! applications of the equation
    real(wp), intent(out) :: remainder          !! estimated error, relative to y
    type(error_t), allocatable, intent(out) :: error
    real(wp), allocatable, intent(out), optional :: last_change(:, :) !! (samples, unknowns) last
                                                !! correction, from the residual of y: y lacks some
                                                !! times this at most
    real(wp), intent(in), optional :: exponent  !! σ: of `e^{σ θ} y` under `e^{σ θ}` times the load;
                                                !! absent: 0

    type(minimal_residual_t) :: problem
    real(wp), allocatable :: residual(:, :), correction(:, :), product(:, :)
    real(wp) :: limit, length
    integer :: round
    logical :: exhausted

    allocate (residual, correction, product, mold=y)
    iterations = 0
    remainder = huge(1.0_wp)
    exhausted = .false.
    do round = 1, most_rounds
      iterations = iterations + 1
      call apply(y, product)
      residual = load - product
      call approximate(residual, correction)
      length = norm2(y + correction)
      if (.not. length <= huge(1.0_wp)) then
        remainder = huge(1.0_wp)
        exit
      end if
      remainder = norm2(correction)/max(length, tiny(1.0_wp))
      if (remainder <= tolerance .or. round == most_rounds .or. exhausted) exit
      limit = 0.5_wp*tolerance*length
      call start_residual(correction, most_iterations, problem)
      do while (problem%last <= most_iterations .and. problem%residual > limit)
        call apply(problem%vector(:, :, problem%last), product)
        iterations = iterations + 1
        call approximate(product, correction)
        call add_product(problem, correction)
        if (was_interrupted()) exit
      end do
      call add_combination(problem, y)
      exhausted = problem%last > most_iterations
    end do
    if (remainder > no_solution) then
      call set_error(error, error_of_numerics, &
        "the iterations for the periodic motion do not converge")
      return
    end if
    y = y + correction
    if (present(last_change)) call move_alloc(correction, last_change)

  contains

    !> The left side of the equation.
    subroutine apply(motion_of_load, force)
      real(wp), intent(in) :: motion_of_load(:, :)
      real(wp), intent(out) :: force(:, :)

      real(wp), allocatable :: parts(:, :, :)

      if (present(exponent)) then
        allocate (parts(size(force, 1), size(force, 2), 0:2))
        call equation_parts(equation%grid, equation%plan, equation%speed, equation%damping, &
          equation%terms, motion_of_load, parts)
        force = parts(:, :, 0) + exponent*(parts(:, :, 1) + exponent*parts(:, :, 2))
      else
        call apply_equation(equation%grid, equation%plan, equation%speed, equation%damping, &
          equation%terms, motion_of_load, force)
      end if
    end subroutine apply

    subroutine approximate(force, motion_of_load)
      real(wp), intent(in) :: force(:, :)
      real(wp), intent(out) :: motion_of_load(:, :)

      call approximate_solution(equation, force, motion_of_load, exponent)
    end subroutine approximate

  end subroutine solve_periodic

  !> An approximate solution: the slow motion, and the rest by its diagonal.
  subroutine approximate_solution(equation, load, y, exponent)
    type(equation_at_speed_t), intent(in) :: equation
    real(wp), intent(in) :: load(:, :)              !! (samples, unknowns)
    real(wp), intent(out) :: y(:, :)                !! (samples, unknowns)
    real(wp), intent(in), optional :: exponent      !! as for `solve_periodic`

    real(wp), dimension(size(load, 1), equation%basis%number) :: part, z, none, ignored

    call slow_part(equation%basis, load, part)
    if (present(exponent)) then
      none = 0.0_wp
      call solve_slow_shifted(equation%plan, equation%motion, cmplx(exponent, 0.0_wp, wp), &
        part/equation%speed**2, none, z, ignored)
    else
      call solve_slow(equation%plan, equation%motion, part/equation%speed**2, z)
    end if
    call complete_solution(equation, load, part, z, y)
  end subroutine approximate_solution

  !> An approximate solution from the slow motion: in the rest both load and solution have no slow
  !! part, `f − X Xᵀ f`.
  subroutine complete_solution(equation, load, part, z, y)
    type(equation_at_speed_t), intent(in) :: equation
    real(wp), intent(in) :: load(:, :)        !! (samples, unknowns)
    real(wp), intent(in) :: part(:, :)        !! (samples, number) Xᵀ load
    real(wp), intent(in) :: z(:, :)           !! (samples, number) slow motion
    real(wp), intent(out) :: y(:, :)          !! (samples, unknowns)

    real(wp), allocatable :: coefficients(:, :), rest(:, :)
    real(wp) :: of_rest(size(part, 1), size(part, 2))

    allocate (coefficients, mold=load)
    rest = load
    call add_slow(equation%basis, -part, rest)
    call coefficients_of(equation%plan, rest, coefficients)
    call divide_by_diagonal(equation%basis%square, equation%speed, mean_damping(equation%grid, &
      equation%damping), coefficients)
    call values_of(equation%plan, coefficients, y)
    call slow_part(equation%basis, y, of_rest)
    call add_slow(equation%basis, z - of_rest, y)
  end subroutine complete_solution

  !> Adds `X z`.
  pure subroutine add_slow(basis, z, y)
    type(slow_basis_t), intent(in) :: basis
    real(wp), intent(in) :: z(:, :)    !! (samples, number)
    real(wp), intent(inout) :: y(:, :) !! (samples, unknowns)

    integer :: k

    do k = 1, size(y, 2)
      y(:, k) = y(:, k) + products_of_rows(basis%shape(:, k, :), z)
    end do
  end subroutine add_slow

  !> `Xᵀ f`.
  pure subroutine slow_part(basis, f, part)
    type(slow_basis_t), intent(in) :: basis
    real(wp), intent(in) :: f(:, :)     !! (samples, unknowns)
    real(wp), intent(out) :: part(:, :) !! (samples, number)

    integer :: i

    do i = 1, basis%number
      part(:, i) = products_of_rows(basis%shape(:, :, i), f)
    end do
  end subroutine slow_part

  !> Divides every harmonic of every unknown by `1 − ω² j² s + i ω j c`.
  pure subroutine divide_by_diagonal(square, speed, damping, coefficients)
    real(wp), intent(in) :: square(:)             !! (unknowns) 1/ω² of an unknown by itself; 0 of
                                                  !! slow ones
    real(wp), intent(in) :: speed, damping(:)
    real(wp), intent(inout) :: coefficients(:, :) !! (samples, unknowns)

    complex(wp) :: diagonal, value
    real(wp) :: real_part
    integer :: j, k, n

    n = size(coefficients, 1)
    do k = 1, size(coefficients, 2)
      do j = 1, n/2
        real_part = 1.0_wp - speed**2*real(j, wp)**2*square(k)
        if (abs(real_part) < least_diagonal) real_part = sign(least_diagonal, real_part)
        diagonal = cmplx(real_part, speed*j*damping(k), wp)
        if (2*j == n) then
          coefficients(n, k) = coefficients(n, k)/real_part
        else
          value = cmplx(coefficients(2*j, k), coefficients(2*j + 1, k), wp)/diagonal
          coefficients(2*j:2*j + 1, k) = [real(value), aimag(value)]
        end if
      end do
    end do
  end subroutine divide_by_diagonal

end module periodic_solver
