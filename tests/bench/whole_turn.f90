!> The periodic motion by general methods on all unknowns: Gauss collocation of the whole turn in dense blocks, as a boundary-value
!! problem, and the matrices for the integrators of SciPy. The equation is `M y'' + D y' + B y = F`, ' = d/dθ2, with
!! `D = 2 G + C/ω`, `B = G' − W + (1 + K_G)/ω²`, `F = f/ω²`.
module whole_turn
  use constants, only: two_pi
  use elastic_equations, only: elastic_terms_t, geometric_force, inertia_force, load_at_speed, mass_force, slope_force
  use errors, only: error_of_files, error_of_numerics, error_t, set_error
  use fourier_transform, only: close_fourier, coefficients_of, fourier_plan_t, open_fourier, resampled, shifted, values_of
  use gauss_collocation, only: collocation_t, new_collocation
  use kinds, only: wp
  use lapack, only: dgetrf, dgetrs
  use load_cases, only: constant_case
  use turn_grids, only: turn_grid_t
  implicit none (type, external)
  private

  public :: turn_matrices_t, turn_matrices_of, collocate, write_matrices, write_shapes, read_motion

  !> Coefficients over the turn.
  type :: turn_matrices_t
    integer :: samples = 0, unknowns = 0
    real(wp), allocatable :: mass(:, :), velocity(:, :), position(:, :) !! (samples, unknowns²) M, D, B
    real(wp), allocatable :: load(:, :) !! (samples, unknowns) F
  end type turn_matrices_t

contains

  !> The matrices at a speed, from the equation applied to unit vectors.
  subroutine turn_matrices_of(grid, speed, damping, matrices)
    type(turn_grid_t), intent(in) :: grid
    real(wp), intent(in) :: speed      !! [rad/s]
    real(wp), intent(in) :: damping    !! of every unknown [s]
    type(turn_matrices_t), intent(out) :: matrices

    type(fourier_plan_t) :: plan
    real(wp), dimension(grid%samples, grid%unknowns) :: unit, force, geometric
    integer :: first, i, last, n

    n = grid%unknowns
    matrices%samples = grid%samples
    matrices%unknowns = n
    allocate (matrices%mass(grid%samples, n**2), matrices%velocity(grid%samples, n**2), matrices%position(grid%samples, n**2), &
      matrices%load(grid%samples, n))
    call open_fourier(grid%samples, plan)
    do i = 1, n
      first = (i - 1)*n + 1
      last = i*n
      unit = 0.0_wp
      unit(:, i) = 1.0_wp
      call mass_force(grid, unit, force)
      call coefficients_of(plan, force, matrices%mass(:, first:last))
      call slope_force(grid, unit, force)
      force = 2.0_wp*force
      force(:, i) = force(:, i) + damping/speed
      call coefficients_of(plan, force, matrices%velocity(:, first:last))
      call inertia_force(grid, plan, elastic_terms_t(), unit, force)
      geometric = unit
      call geometric_force(grid, speed**2*grid%force(:, :, :, 1) + grid%force(:, :, :, constant_case), unit, geometric)
      call coefficients_of(plan, force + geometric/speed**2, matrices%position(:, first:last))
    end do
    call coefficients_of(plan, load_at_speed(grid, speed)/speed**2, matrices%load)
    call close_fourier(plan)
  end subroutine turn_matrices_of

  !> Collocation of the whole turn: `stages` a step, all unknowns of a step in one dense block, the turn closed by the product of
  !! all steps. Errors: a block is singular.
  subroutine collocate(matrices, steps, stages, y, error)
    type(turn_matrices_t), intent(in) :: matrices
    integer, intent(in) :: steps, stages
    real(wp), allocatable, intent(out) :: y(:, :)    !! (2 steps, unknowns) at the starts and middles of the steps
    type(error_t), allocatable, intent(out) :: error

    type(collocation_t) :: rule
    type(fourier_plan_t) :: plan
    real(wp), allocatable :: at(:, :, :, :), load(:, :, :), transfer(:, :, :), push(:, :), middle(:, :, :), left(:, :), closed(:, :)
    real(wp), allocatable :: state(:)
    integer, allocatable :: pivot(:)
    integer :: i, info, k, n

    n = matrices%unknowns
    rule = new_collocation(stages)
    allocate (at(steps, n**2, 3, stages), load(steps, n, stages))
    call open_fourier(steps, plan)
    do i = 1, stages
      associate (shift => rule%node(i)*two_pi/steps)
        call values_of(plan, shifted(resampled(matrices%mass, steps), shift), at(:, :, 1, i))
        call values_of(plan, shifted(resampled(matrices%velocity, steps), shift), at(:, :, 2, i))
        call values_of(plan, shifted(resampled(matrices%position, steps), shift), at(:, :, 3, i))
        call values_of(plan, shifted(resampled(matrices%load, steps), shift), load(:, :, i))
      end associate
    end do
    call close_fourier(plan)
    allocate (transfer(2*n, 2*n, steps), push(2*n, steps), middle(n, 2*n + 1, steps), state(2*n), pivot(2*n))
    do k = 1, steps
      call take_step(rule, two_pi/steps, reshape(at(k, :, :, :), [n, n, 3, stages]), load(k, :, :), transfer(:, :, k), push(:, k), &
        middle(:, :, k), info)
      if (info /= 0) exit
    end do
    if (info == 0) then
      closed = transfer(:, :, 1)
      state = push(:, 1)
      do k = 2, steps
        closed = matmul(transfer(:, :, k), closed)
        state = matmul(transfer(:, :, k), state) + push(:, k)
      end do
      left = -closed
      do i = 1, 2*n
        left(i, i) = left(i, i) + 1.0_wp
      end do
      call dgetrf(2*n, 2*n, left, 2*n, pivot, info)
    end if
    if (info /= 0) then
      call set_error(error, error_of_numerics, "a block of the collocation is singular")
      return
    end if
    call dgetrs("N", 2*n, 1, left, 2*n, pivot, state, 2*n, info)
    allocate (y(2*steps, n))
    do k = 1, steps
      y(2*k - 1, :) = state(:n)
      y(2*k, :) = matmul(middle(:, :2*n, k), state) + middle(:, 2*n + 1, k)
      state = matmul(transfer(:, :, k), state) + push(:, k)
    end do
  end subroutine collocate

  !> One step of the collocation; the unknowns are y'' at the stages.
  subroutine take_step(rule, h, at, load, transfer, push, middle, info)
    type(collocation_t), intent(in) :: rule
    real(wp), intent(in) :: h
    real(wp), intent(in) :: at(:, :, :, :)        !! (unknowns, unknowns, 3, stages) M, D, B
    real(wp), intent(in) :: load(:, :)            !! (unknowns, stages)
    real(wp), intent(out) :: transfer(:, :), push(:) !! to y, y' at the end
    real(wp), intent(out) :: middle(:, :)         !! (unknowns, 2 unknowns + 1) to y in the middle, with what the load does
    integer, intent(out) :: info                  !! not 0: singular

    real(wp), allocatable :: left(:, :), right(:, :)
    real(wp) :: twice(size(load, 2), size(load, 2)), ends(size(load, 2)), half(size(load, 2))
    integer, allocatable :: pivot(:)
    integer :: i, j, n, s, first, last

    n = size(load, 1)
    s = size(load, 2)
    twice = matmul(rule%matrix, rule%matrix)
    ends = matmul(rule%weight, rule%matrix)
    allocate (left(n*s, n*s), right(n*s, 2*n + 1), pivot(n*s))
    do i = 1, s
      first = (i - 1)*n + 1
      last = i*n
      do j = 1, s
        left(first:last, (j - 1)*n + 1:j*n) = h*rule%matrix(i, j)*at(:, :, 2, i) + h**2*twice(i, j)*at(:, :, 3, i)
      end do
      left(first:last, first:last) = left(first:last, first:last) + at(:, :, 1, i)
      right(first:last, :n) = -at(:, :, 3, i)
      right(first:last, n + 1:2*n) = -at(:, :, 2, i) - h*rule%node(i)*at(:, :, 3, i)
      right(first:last, 2*n + 1) = load(:, i)
    end do
    call dgetrf(n*s, n*s, left, n*s, pivot, info)
    if (info /= 0) return
    call dgetrs("N", n*s, 2*n + 1, left, n*s, pivot, right, n*s, info)
    half = half_weights(rule)
    transfer = 0.0_wp
    push = 0.0_wp
    middle = 0.0_wp
    do i = 1, n
      middle(i, i) = 1.0_wp
      middle(i, n + i) = 0.5_wp*h
      transfer(i, i) = 1.0_wp
      transfer(n + i, n + i) = 1.0_wp
      transfer(i, n + i) = h
    end do
    do i = 1, s
      first = (i - 1)*n + 1
      last = i*n
      transfer(:n, :) = transfer(:n, :) + h**2*ends(i)*right(first:last, :2*n)
      transfer(n + 1:, :) = transfer(n + 1:, :) + h*rule%weight(i)*right(first:last, :2*n)
      push(:n) = push(:n) + h**2*ends(i)*right(first:last, 2*n + 1)
      push(n + 1:) = push(n + 1:) + h*rule%weight(i)*right(first:last, 2*n + 1)
      middle = middle + h**2*half(i)*right(first:last, :)
    end do
  end subroutine take_step

  !> Weights of y'' at the stages for y in the middle of a step: exact for polynomials of degree < stages.
  function half_weights(rule) result(weights)
    type(collocation_t), intent(in) :: rule
    real(wp) :: weights(size(rule%node))

    real(wp) :: powers(size(rule%node), size(rule%node)), right(size(rule%node), 1)
    integer :: info, p, pivot(size(rule%node)), s

    s = size(rule%node)
    do p = 0, s - 1
      powers(p + 1, :) = rule%node**p
      right(p + 1, 1) = 0.5_wp**(p + 2)/((p + 1)*(p + 2))
    end do
    call dgetrf(s, s, powers, s, pivot, info)
    call dgetrs("N", s, 1, powers, s, pivot, right, s, info)
    weights = right(:, 1)
  end function half_weights

  !> Writes the samples of the matrices: numbers of samples and unknowns, then M, D, B and F, all as doubles. Errors: the file
  !! could not be written.
  subroutine write_matrices(path, matrices, error)
    character(len=*), intent(in) :: path
    type(turn_matrices_t), intent(in) :: matrices
    type(error_t), allocatable, intent(out) :: error

    type(fourier_plan_t) :: plan
    real(wp), allocatable :: samples(:, :)
    integer :: status, unit

    open (newunit=unit, file=path, access="stream", status="replace", action="write", iostat=status)
    if (status /= 0) then
      call set_error(error, error_of_files, "this file cannot be written", path)
      return
    end if
    allocate (samples, mold=matrices%mass)
    call open_fourier(matrices%samples, plan)
    write (unit) real(matrices%samples, wp), real(matrices%unknowns, wp)
    call values_of(plan, matrices%mass, samples)
    write (unit) samples
    call values_of(plan, matrices%velocity, samples)
    write (unit) samples
    call values_of(plan, matrices%position, samples)
    write (unit) samples
    call values_of(plan, matrices%load, samples(:, :matrices%unknowns))
    write (unit) samples(:, :matrices%unknowns)
    call close_fourier(plan)
    close (unit)
  end subroutine write_matrices

  !> Writes the shapes of slow coordinates as doubles. Errors: the file could not be written.
  subroutine write_shapes(path, shape, error)
    character(len=*), intent(in) :: path
    real(wp), intent(in) :: shape(:, :, :) !! (samples, unknowns, number)
    type(error_t), allocatable, intent(out) :: error

    integer :: status, unit

    open (newunit=unit, file=path, access="stream", status="replace", action="write", iostat=status)
    if (status == 0) write (unit, iostat=status) shape
    if (status /= 0) call set_error(error, error_of_files, "this file cannot be written", path)
    close (unit, iostat=status)
  end subroutine write_shapes

  !> Reads what an integrator found: seconds by the clock and of the processor, turns, steps, then y. Errors: there is no such file.
  subroutine read_motion(path, header, y, error)
    character(len=*), intent(in) :: path
    real(wp), intent(out) :: header(:)
    real(wp), intent(out) :: y(:, :)  !! (samples, unknowns)
    type(error_t), allocatable, intent(out) :: error

    integer :: status, unit

    header = 0.0_wp
    y = 0.0_wp
    open (newunit=unit, file=path, access="stream", status="old", action="read", iostat=status)
    if (status == 0) then
      read (unit, iostat=status) header, y
      close (unit)
    end if
    if (status /= 0) call set_error(error, error_of_files, "this file cannot be read", path)
  end subroutine read_motion

end module whole_turn
