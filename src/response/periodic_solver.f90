!> The periodic elastic motion of a linkage at a speed, by GMRES (Saad and Schultz, SIAM J. Sci.
!! Stat. Comput. 7 (1986) 856) on samples over the turn, with Fourier derivatives.
!!
!! The approximate inverse takes the slow motion exactly, but for its steps, and the rest by its own
!! diagonal, harmonic by harmonic: what is left converges in a few iterations, in all unknowns and
!! all harmonics of the grid.
module periodic_solver
  use elastic_equations, only: apply_equation, elastic_terms_t
  use errors, only: error_of_numerics, error_t, set_error
  use fourier_transform, only: coefficients_of, fourier_plan_t, resampled, values_of
  use kinds, only: wp
  use slow_motions, only: slow_basis_t, slow_motion_t, solve_slow
  use turn_grids, only: turn_grid_t
  implicit none (type, external)
  private

  public :: solve_periodic, approximate_solution

  integer, parameter :: most_iterations = 80

  !> Where a harmonic is near the own frequency of a fast deformation, the diagonal is taken as far
  !! from zero as this.
  real(wp), parameter :: least_diagonal = 0.25_wp

contains

  !> Solves the equation for a load, from a start.
  !!
  !! Errors: the iterations do not converge.
  subroutine solve_periodic(grid, plan, basis, motion_plan, motion, speed, damping, terms, load, &
    tolerance, y, iterations, remainder, error)
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan    !! for its samples
    type(slow_basis_t), intent(in) :: basis     !! of this grid
    type(fourier_plan_t), intent(in) :: motion_plan !! for the steps of the slow motion
    type(slow_motion_t), intent(in) :: motion   !! at this speed, of as many coordinates
    real(wp), intent(in) :: speed               !! ω2 [rad/s]
    real(wp), intent(in) :: damping(:)          !! (unknowns) c [s]
    type(elastic_terms_t), intent(in) :: terms
    real(wp), intent(in) :: load(:, :)          !! (samples, unknowns) [√J]
    real(wp), intent(in) :: tolerance           !! of the last change, relative to y
    real(wp), intent(inout) :: y(:, :)          !! (samples, unknowns) start, then solution [√J]
    integer, intent(out) :: iterations          !! applications of the equation
    real(wp), intent(out) :: remainder          !! estimated error, relative to y
    type(error_t), allocatable, intent(out) :: error

    real(wp), allocatable :: basis_vector(:, :, :), residual(:, :), correction(:, :), product(:, :)
    real(wp) :: h(most_iterations + 1, most_iterations), rotation(2, most_iterations), &
      right(most_iterations + 1), weight(most_iterations), length, limit, c
    integer :: i, k, last

    allocate (residual, correction, product, mold=y)
    allocate (basis_vector(size(y, 1), size(y, 2), most_iterations + 1))
    iterations = 1
    call apply_equation(grid, plan, speed, damping, terms, y, product)
    residual = load - product
    call approximate_solution(plan, basis, motion_plan, motion, speed, damping, residual, &
      correction)
    limit = tolerance*max(norm2(y), norm2(y + correction))
    length = norm2(correction)
    remainder = length/max(norm2(y + correction), tiny(1.0_wp))
    if (length <= limit) then
      y = y + correction
      return
    end if
    h = 0.0_wp
    right = 0.0_wp
    right(1) = length
    basis_vector(:, :, 1) = correction/length
    last = most_iterations
    do k = 1, most_iterations
      call apply_equation(grid, plan, speed, damping, terms, basis_vector(:, :, k), product)
      iterations = iterations + 1
      call approximate_solution(plan, basis, motion_plan, motion, speed, damping, product, &
        correction)
      do i = 1, k
        h(i, k) = sum(basis_vector(:, :, i)*correction)
        correction = correction - h(i, k)*basis_vector(:, :, i)
      end do
      h(k + 1, k) = norm2(correction)
      if (h(k + 1, k) > 0.0_wp) basis_vector(:, :, k + 1) = correction/h(k + 1, k)
      do i = 1, k - 1
        h(i:i + 1, k) = [rotation(1, i)*h(i, k) + rotation(2, i)*h(i + 1, k), &
          -rotation(2, i)*h(i, k) + rotation(1, i)*h(i + 1, k)]
      end do
      c = hypot(h(k, k), h(k + 1, k))
      rotation(:, k) = [h(k, k), h(k + 1, k)]/c
      h(k:k + 1, k) = [c, 0.0_wp]
      right(k + 1) = -rotation(2, k)*right(k)
      right(k) = rotation(1, k)*right(k)
      if (abs(right(k + 1)) > limit .and. k < most_iterations) cycle
      last = k
      exit
    end do
    do k = last, 1, -1
      weight(k) = (right(k) - dot_product(h(k, k + 1:last), weight(k + 1:last)))/h(k, k)
    end do
    do k = 1, last
      y = y + weight(k)*basis_vector(:, :, k)
    end do
    remainder = abs(right(last + 1))/norm2(y)
    if (.not. abs(right(last + 1)) <= limit) call set_error(error, error_of_numerics, &
      "the iterations for the periodic motion do not converge")
  end subroutine solve_periodic

  !> What solves the equation nearly: the slow motion, and the rest by its diagonal.
  subroutine approximate_solution(plan, basis, motion_plan, motion, speed, damping, load, y)
    type(fourier_plan_t), intent(in) :: plan, motion_plan
    type(slow_basis_t), intent(in) :: basis
    type(slow_motion_t), intent(in) :: motion
    real(wp), intent(in) :: speed, damping(:)
    real(wp), intent(in) :: load(:, :) !! (samples, unknowns)
    real(wp), intent(out) :: y(:, :)   !! (samples, unknowns)

    real(wp), allocatable :: part(:, :), z(:, :), coefficients(:, :), rest(:, :), slow_load(:, :), &
      slow(:, :)
    integer :: i

    allocate (part(size(load, 1), basis%number), z(size(load, 1), basis%number))
    allocate (coefficients, rest, mold=load)
    allocate (slow_load(motion_plan%samples, basis%number), slow(motion_plan%samples, basis%number))
    do i = 1, basis%number
      part(:, i) = sum(basis%shape(:, :, i)*load, dim=2)
    end do
    call resample_samples(plan, motion_plan, part/speed**2, slow_load)
    call solve_slow(motion_plan, motion, slow_load, slow)
    call resample_samples(motion_plan, plan, slow, z)
    rest = load
    call take_out(part, rest)
    call coefficients_of(plan, rest, coefficients)
    call divide_by_diagonal(basis%square, speed, damping, coefficients)
    call values_of(plan, coefficients, y)
    do i = 1, basis%number
      part(:, i) = sum(basis%shape(:, :, i)*y, dim=2)
    end do
    call take_out(part, y)
    do i = 1, basis%number
      y = y + basis%shape(:, :, i)*spread(z(:, i), 2, size(y, 2))
    end do

  contains

    !> Takes the slow part out: `f − X (XᵀX)⁻¹ Xᵀ f`.
    subroutine take_out(part, f)
      real(wp), intent(in) :: part(:, :)  !! (samples, number) Xᵀ f
      real(wp), intent(inout) :: f(:, :)

      real(wp) :: share(size(part, 1))
      integer :: i, j

      do i = 1, basis%number
        share = 0.0_wp
        do j = 1, basis%number
          share = share + basis%inverse(:, i, j)*part(:, j)
        end do
        f = f - basis%shape(:, :, i)*spread(share, 2, size(f, 2))
      end do
    end subroutine take_out

  end subroutine approximate_solution

  !> Samples of the same functions at another number of crank angles.
  subroutine resample_samples(plan, to_plan, samples, other)
    type(fourier_plan_t), intent(in) :: plan, to_plan
    real(wp), intent(in) :: samples(:, :)
    real(wp), intent(out) :: other(:, :)

    real(wp) :: coefficients(size(samples, 1), size(samples, 2))

    other = 0.0_wp
    if (plan%samples == to_plan%samples) then
      other = samples
    else
      call coefficients_of(plan, samples, coefficients)
      call values_of(to_plan, resampled(coefficients, to_plan%samples), other)
    end if
  end subroutine resample_samples

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
