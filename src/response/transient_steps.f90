!> Steps in time of the elastic motion, by Gauss collocation in all unknowns.
!!
!! In canonical form `P = M ẏ + ω G y`, `Ṗ = ω Gᵀ ẏ + (ω² W − 1 − K_G) y − C ẏ + f` the matrices
!! need no derivatives over time, at constant speed or not. Gauss collocation is symplectic: without
!! damping it neither adds nor takes energy, and it is stable for vibrations too fast for its steps.
module transient_steps
  use crank_laws, only: crank_acceleration_at, crank_angle_at, crank_law_t, crank_speed_at
  use errors, only: error_of_numerics, error_t, set_error
  use gauss_collocation, only: collocation_t
  use kinds, only: wp
  use lapack, only: dgetrf, dgetrs
  use motion_matrices, only: find_motion_matrices, load_at, motion_matrices_t, stiffness_at
  use linkages, only: linkage_t
  use turn_grids, only: place_grid, turn_grid_t
  implicit none (type, external)
  private

  public :: transient_step_t, make_steps, elastic_state_t, advance, momenta_of, rates_of

  !> What a step does to the state (y, P): its change is `change · state + push`.
  type :: transient_step_t
    real(wp), allocatable :: change(:, :) !! (2 unknowns, 2 unknowns)
    real(wp), allocatable :: push(:)      !! (2 unknowns) [√J, √J s]
  end type transient_step_t

  !> Coordinates and momenta, with what rounding has taken from their sums.
  type :: elastic_state_t
    real(wp), allocatable :: value(:) !! (2 unknowns) y, P [√J, √J s]
    real(wp), allocatable :: carry(:) !! (2 unknowns) to be added
  end type elastic_state_t

contains

  !> Equal steps one after another.
  !!
  !! Errors: the crank cannot reach an angle, or meets a dead point; a step has no solution.
  subroutine make_steps(linkage, law, damping, axial, rule, start, length, grid, matrices, steps, &
    error)
    type(linkage_t), intent(in) :: linkage   !! of the grid
    type(crank_law_t), intent(in) :: law     !! of the crank; not changing between two laws inside
    real(wp), intent(in) :: damping(:)       !! (unknowns) c [s]
    logical, intent(in) :: axial             !! with the stiffness of axial forces
    type(collocation_t), intent(in) :: rule  !! of a step
    real(wp), intent(in) :: start            !! of the first step [s]
    real(wp), intent(in) :: length           !! of each step [s]
    type(turn_grid_t), intent(inout) :: grid !! by `new_path_grid`, for all stages of all steps
    type(motion_matrices_t), intent(inout) :: matrices !! room for those at the stages
    type(transient_step_t), allocatable, intent(out) :: steps(:) !! as many as the grid is for
    type(error_t), allocatable, intent(out) :: error

    real(wp) :: time(grid%samples)
    integer :: i, k, s

    s = size(rule%node)
    allocate (steps(grid%samples/s))
    do k = 1, size(steps)
      time((k - 1)*s + 1:k*s) = start + length*(k - 1 + rule%node)
    end do
    call place_grid(linkage, crank_angle_at(law, time), grid, error)
    if (allocated(error)) return
    call find_motion_matrices(grid, matrices)
    do k = 1, size(steps)
      call make_step(matrices, damping, axial, rule, [((k - 1)*s + i, i=1, s)], &
        crank_speed_at(law, time((k - 1)*s + 1:k*s)), &
        crank_acceleration_at(law, time((k - 1)*s + 1:k*s)), length, steps(k), error)
      if (allocated(error)) return
    end do
  end subroutine make_steps

  !> One step. Unknowns are the rates v of the stages, for every unit of the state and for the load:
  !! `M_i v_i + ω G_i y_i = P_i`, `y_i = y + h Σ a_ij v_j`, `P_i = P + h Σ a_ij Ṗ_j`.
  subroutine make_step(matrices, damping, axial, rule, at, speed, acceleration, h, step, error)
    type(motion_matrices_t), intent(in) :: matrices
    real(wp), intent(in) :: damping(:)
    logical, intent(in) :: axial
    type(collocation_t), intent(in) :: rule
    integer, intent(in) :: at(:)            !! (stages) samples of the matrices
    real(wp), intent(in) :: speed(:)        !! (stages) ω2 [rad/s]
    real(wp), intent(in) :: acceleration(:) !! (stages) α2 [rad/s²]
    real(wp), intent(in) :: h               !! length [s]
    type(transient_step_t), intent(out) :: step
    type(error_t), allocatable, intent(out) :: error

    real(wp), allocatable :: v(:, :, :), d(:, :, :), g(:, :, :), load(:, :), left(:, :), right(:, :)
    real(wp), allocatable :: sum_of_v(:, :)
    integer, allocatable :: pivot(:)
    integer :: i, j, k, l, m, n, s, info

    n = size(damping)
    s = size(at)
    m = n*s
    allocate (v(n, n, s), d(n, n, s), g(n, n, s), load(n, s), left(m, m), right(m, 2*n + 1))
    allocate (pivot(m), step%change(2*n, 2*n), step%push(2*n))
    do i = 1, s
      g(:, :, i) = speed(i)*matrices%slope(:, :, at(i))
      d(:, :, i) = transpose(g(:, :, i))
      do k = 1, n
        d(k, k, i) = d(k, k, i) - damping(k)
      end do
      v(:, :, i) = speed(i)**2*matrices%swept(:, :, at(i)) - stiffness_at(matrices, at(i), &
        speed(i), acceleration(i), axial)
      load(:, i) = load_at(matrices, at(i), speed(i), acceleration(i))
    end do
    associate (a => rule%matrix, w => rule%weight)
      right = 0.0_wp
      do i = 1, s
        associate (rows => right((i - 1)*n + 1:i*n, :))
          rows(:, :n) = -g(:, :, i)
          do j = 1, s
            rows(:, :n) = rows(:, :n) + h*a(i, j)*v(:, :, j)
            rows(:, 2*n + 1) = rows(:, 2*n + 1) + h*a(i, j)*load(:, j)
          end do
          do k = 1, n
            rows(k, n + k) = 1.0_wp
          end do
        end associate
        do l = 1, s
          sum_of_v = h*a(i, l)*(g(:, :, i) - d(:, :, l))
          do j = 1, s
            sum_of_v = sum_of_v - h**2*a(i, j)*a(j, l)*v(:, :, j)
          end do
          if (i == l) sum_of_v = sum_of_v + matrices%mass(:, :, at(i))
          left((i - 1)*n + 1:i*n, (l - 1)*n + 1:l*n) = sum_of_v
        end do
      end do
      call dgetrf(m, m, left, m, pivot, info)
      if (info /= 0) then
        call set_error(error, error_of_numerics, "a step in time has no solution")
        return
      end if
      call dgetrs("N", m, 2*n + 1, left, m, pivot, right, m, info)
      step%change = 0.0_wp
      step%push = 0.0_wp
      do l = 1, s
        sum_of_v = d(:, :, l)
        do j = 1, s
          sum_of_v = sum_of_v + h*w(j)*a(j, l)/w(l)*v(:, :, j)
        end do
        associate (rows => right((l - 1)*n + 1:l*n, :))
          step%change(:n, :) = step%change(:n, :) + h*w(l)*rows(:, :2*n)
          step%change(n + 1:, :) = step%change(n + 1:, :) + h*w(l)*matmul(sum_of_v, rows(:, :2*n))
          step%push(:n) = step%push(:n) + h*w(l)*rows(:, 2*n + 1)
          step%push(n + 1:) = step%push(n + 1:) + h*w(l)*(matmul(sum_of_v, rows(:, 2*n + 1)) + &
            load(:, l))
        end associate
        step%change(n + 1:, :n) = step%change(n + 1:, :n) + h*w(l)*v(:, :, l)
      end do
    end associate
  end subroutine make_step

  !> The state after a step: changes are added with the rounding of the sums before (Kahan), so that
  !! it does not pile up over many turns.
  pure subroutine advance(step, state)
    type(transient_step_t), intent(in) :: step
    type(elastic_state_t), intent(inout) :: state

    real(wp), dimension(size(step%push)) :: change, after

    change = matmul(step%change, state%value) + step%push + state%carry
    after = state%value + change
    state%carry = change - (after - state%value)
    state%value = after
  end subroutine advance

  !> `P = M ẏ + ω G y`.
  pure function momenta_of(matrices, sample, speed, y, rates) result(momenta)
    type(motion_matrices_t), intent(in) :: matrices
    integer, intent(in) :: sample
    real(wp), intent(in) :: speed    !! ω2 [rad/s]
    real(wp), intent(in) :: y(:)     !! (unknowns) [√J]
    real(wp), intent(in) :: rates(:) !! (unknowns) ẏ
    real(wp) :: momenta(size(y))

    momenta = matmul(matrices%mass(:, :, sample), rates) + speed*matmul(matrices%slope(:, :, &
      sample), y)
  end function momenta_of

  !> ẏ from the state.
  pure function rates_of(matrices, sample, speed, state) result(rates)
    type(motion_matrices_t), intent(in) :: matrices
    integer, intent(in) :: sample
    real(wp), intent(in) :: speed    !! ω2 [rad/s]
    real(wp), intent(in) :: state(:) !! (2 unknowns) y, P
    real(wp) :: rates(size(state)/2)

    real(wp) :: left(size(rates), size(rates)), right(size(rates), 1)
    integer :: pivot(size(rates)), n, info

    n = size(rates)
    left = matrices%mass(:, :, sample)
    right(:, 1) = state(n + 1:) - speed*matmul(matrices%slope(:, :, sample), state(:n))
    call dgetrf(n, n, left, n, pivot, info)
    call dgetrs("N", n, 1, left, n, pivot, right, n, info)
    rates = right(:, 1)
  end function rates_of

end module transient_steps
