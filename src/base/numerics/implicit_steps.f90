!> Integration of stiff ordinary differential equations: the implicit Runge–Kutta method of Radau
!! (IIA) with nine stages, of order 17, with step control.
!!
!! What changes much faster than the steps fades at once, and leaves no rounding behind: steps are
!! as long as what is left allows. The stages are found by Newton's method with one Jacobian a step.
!! A step needs nothing but the state before it, so that the coordinates may be others from one step
!! to the next; a method of several steps would begin anew at each. Hairer and Wanner, Solving
!! Ordinary Differential Equations II, IV.8.
module implicit_steps
  use dense_factor, only: dense_factor_t, factorize, solve, solve_transposed
  use gauss_collocation, only: collocation_t, new_radau_collocation
  use kinds, only: long, wp
  use rate_jacobians, only: find_jacobian, spectral_radius
  use rate_systems, only: rate_system_t
  implicit none (type, external)
  private

  public :: implicit_method_t, new_implicit_method, advance_implicitly, step_implicitly

  !> High order pays where steps are to be right to rounding: with five stages they are a fifth as
  !! long.
  integer, parameter :: stages = 9

  !> Of the estimate of errors.
  real(wp), parameter :: gamma = 1.0_wp/stages

  type :: implicit_method_t
    integer(long) :: steps = 0_long       !! accepted so far
    integer(long) :: evaluations = 0_long !! of rates so far
    real(wp) :: step = 0.0_wp             !! length of the next step that the error allows, in the
                                          !! unit of time
    real(wp) :: fastest = 0.0_wp          !! rate of the fastest change where the last step began,
                                          !! per unit of time
    real(wp), allocatable, private :: scale(:)      !! (unknowns) values small against it need no
                                                    !! accuracy
    real(wp), private :: tolerance = 0.0_wp         !! relative [-]
    type(collocation_t), private :: rule
    type(dense_factor_t), private :: stage_factor   !! of the coefficients of the rule
    real(wp), private :: at_start(stages) = 0.0_wp  !! of a polynomial at the nodes: its value at
                                                    !! the start of the step
    real(wp), allocatable, private :: changes(:, :) !! (unknowns, stages) of the last step; not
                                                    !! allocated before the first
    real(wp), private :: last_step = 0.0_wp         !! its length
  end type implicit_method_t

  !> A step is shortened by the first factor where its equations are not solved, and changes by the
  !! others at most.
  real(wp), parameter :: shorter = 0.4_wp, least_factor = 0.2_wp, most_factor = 4.0_wp, &
    safety = 0.9_wp

  !> Newton's iterations may leave this share of the error allowed.
  real(wp), parameter :: share_of_iterations = 0.03_wp
  integer, parameter :: most_iterations = 20

contains

  !> A method whose steps have an estimated error below `tolerance (scale + |y|)` in every unknown.
  pure function new_implicit_method(scale, tolerance) result(method)
    real(wp), intent(in) :: scale(:)  !! (unknowns) in their units
    real(wp), intent(in) :: tolerance !! relative [-]
    type(implicit_method_t) :: method

    integer :: i

    method%scale = scale
    method%tolerance = tolerance
    method%rule = new_radau_collocation(stages)
    call factorize(method%rule%matrix, method%stage_factor)
    do i = 1, stages
      method%at_start(i) = lagrange(method%rule%node, i, 0.0_wp)
    end do
  end function new_implicit_method

  !> The polynomial that is 1 at one node and 0 at the others.
  pure function lagrange(node, number, place) result(value)
    real(wp), intent(in) :: node(:)
    integer, intent(in) :: number !! of the node
    real(wp), intent(in) :: place
    real(wp) :: value

    integer :: k

    value = 1.0_wp
    do k = 1, size(node)
      if (k /= number) value = value*(place - node(k))/(node(number) - node(k))
    end do
  end function lagrange

  !> Takes one step, as long as the error allows but not beyond `limit`, which is met exactly.
  subroutine advance_implicitly(method, system, time, limit, state, found)
    type(implicit_method_t), intent(inout) :: method   !! of `new_implicit_method`, with a first
                                                       !! step
    class(rate_system_t), intent(inout) :: system      !! whose rates are integrated
    real(wp), intent(inout) :: time                    !! before the step, then after it
    real(wp), intent(in) :: limit                      !! latest end of the step
    real(wp), intent(inout) :: state(:)                !! (unknowns) at `time`
    logical, intent(out) :: found                      !! false: no step is short enough; state and
                                                       !! time are unchanged

    real(wp) :: rates(size(state)), jacobian(size(state), size(state)), &
      changes(size(state), stages), step, error, factor
    logical :: solved, is_cut

    method%evaluations = method%evaluations + 1_long
    call system%find_rates(time, state, rates, found)
    if (found) call find_jacobian(system, time, state, rates, method%scale, jacobian, found, &
      method%evaluations)
    if (.not. found) return
    method%fastest = spectral_radius(jacobian)
    step = method%step
    do
      is_cut = step >= limit - time
      if (is_cut) step = limit - time
      ! Steps this short do not come from the stiffness.
      found = time + 0.1_wp*step > time
      if (.not. found) return
      call solve_step(method, system, time, step, state, rates, jacobian, changes, error, solved)
      if (.not. solved) then
        step = shorter*step
        cycle
      end if
      factor = safety/max(error, tiny(1.0_wp))**(1.0_wp/(stages + 1))
      factor = min(most_factor, max(least_factor, factor))
      if (error <= 1.0_wp) exit
      step = min(factor, safety)*step
    end do
    method%steps = method%steps + 1_long
    if (is_cut) then
      time = limit
      method%step = max(method%step, factor*step)
    else
      time = time + step
      method%step = factor*step
    end if
    state = state + changes(:, stages)
    method%changes = changes
    method%last_step = step
  end subroutine advance_implicitly

  !> The state after one step of given length, whatever its error.
  subroutine step_implicitly(method, system, time, step, state, found)
    type(implicit_method_t), intent(inout) :: method !! of `new_implicit_method`
    class(rate_system_t), intent(inout) :: system    !! whose rates are integrated
    real(wp), intent(in) :: time                     !! before the step
    real(wp), intent(in) :: step                     !! its length, in the unit of time
    real(wp), intent(inout) :: state(:)              !! (unknowns) before the step, then after it
    logical, intent(out) :: found                    !! false: the step does not exist; the state is
                                                     !! unchanged

    real(wp) :: rates(size(state)), jacobian(size(state), size(state)), &
      changes(size(state), stages), error

    found = .true.
    if (.not. step > 0.0_wp) return
    method%evaluations = method%evaluations + 1_long
    call system%find_rates(time, state, rates, found)
    if (found) call find_jacobian(system, time, state, rates, method%scale, jacobian, found, &
      method%evaluations)
    if (found) call solve_step(method, system, time, step, state, rates, jacobian, changes, error, &
      found)
    if (found) state = state + changes(:, stages)
  end subroutine step_implicitly

  !> The changes z_i of the state from the start of a step to its stages,
  !! `z_i = h Σ_j a_ij f(t + c_j h, y + z_j)`, by Newton's method from those that the last step
  !! continues to, if its rates meet the present ones, or else from 0.
  subroutine solve_step(method, system, time, step, state, rates, jacobian, changes, error, solved)
    type(implicit_method_t), intent(inout) :: method
    class(rate_system_t), intent(inout) :: system
    real(wp), intent(in) :: time, step
    real(wp), intent(in) :: state(:)        !! (unknowns) y
    real(wp), intent(in) :: rates(:)        !! (unknowns) at the start
    real(wp), intent(in) :: jacobian(:, :)  !! (unknowns, unknowns) at the start
    real(wp), intent(out) :: changes(:, :)  !! (unknowns, stages)
    real(wp), intent(out) :: error          !! as a share of what is allowed
    logical, intent(out) :: solved          !! the iterations have converged

    type(dense_factor_t) :: factor, filter
    real(wp) :: allowed(size(state))
    logical :: continues

    error = huge(1.0_wp)
    call factorize(newton_matrix(method%rule, step, jacobian), factor)
    call factorize(filter_matrix(step, jacobian), filter)
    solved = min(abs(factor%determinant), abs(filter%determinant)) > 0.0_wp
    if (.not. solved) return
    allowed = method%tolerance*(method%scale + abs(state)) + rounding_of_step(step, state, &
      jacobian, filter)
    call continue_last(method, step, rates, changes, continues)
    solved = .false.
    if (continues) call iterate(method, system, time, step, state, factor, allowed, changes, solved)
    if (.not. solved) then
      changes = 0.0_wp
      call iterate(method, system, time, step, state, factor, allowed, changes, solved)
    end if
    if (solved) error = estimated_error(method, step, rates, filter, allowed, changes)
  end subroutine solve_step

  !> `1 − h A ⊗ J`, stage by stage.
  pure function newton_matrix(rule, step, jacobian) result(matrix)
    type(collocation_t), intent(in) :: rule
    real(wp), intent(in) :: step
    real(wp), intent(in) :: jacobian(:, :)
    real(wp) :: matrix(stages*size(jacobian, 1), stages*size(jacobian, 1))

    integer :: i, j, n

    n = size(jacobian, 1)
    do j = 1, stages
      do i = 1, stages
        matrix((i - 1)*n + 1:i*n, (j - 1)*n + 1:j*n) = -step*rule%matrix(i, j)*jacobian
      end do
    end do
    do i = 1, stages*n
      matrix(i, i) = matrix(i, i) + 1.0_wp
    end do
  end function newton_matrix

  !> `1 − γ h J`, whose inverse lets pass what changes slowly; γ is about that of the real
  !! eigenvalue of A.
  pure function filter_matrix(step, jacobian) result(matrix)
    real(wp), intent(in) :: step
    real(wp), intent(in) :: jacobian(:, :)
    real(wp) :: matrix(size(jacobian, 1), size(jacobian, 1))

    integer :: k

    matrix = -gamma*step*jacobian
    do k = 1, size(jacobian, 1)
      matrix(k, k) = matrix(k, k) + 1.0_wp
    end do
  end function filter_matrix

  !> What the rounded state leaves in a step, `|(1 − γhJ)⁻¹| h |J| |y| ε`: the power of a motor with
  !! a steep line, say, has no more digits than that.
  pure function rounding_of_step(step, state, jacobian, filter) result(rounding)
    real(wp), intent(in) :: step
    real(wp), intent(in) :: state(:)
    real(wp), intent(in) :: jacobian(:, :)
    type(dense_factor_t), intent(in) :: filter !! of `filter_matrix`
    real(wp) :: rounding(size(state))

    !> The share of this bound that is left by roundings of both signs.
    real(wp), parameter :: seen = 0.1_wp
    real(wp) :: of_rates(size(state)), unit(size(state))
    integer :: k

    of_rates = matmul(abs(jacobian), abs(state))
    rounding = 0.0_wp
    do k = 1, size(state)
      unit = 0.0_wp
      unit(k) = seen*step*epsilon(1.0_wp)*of_rates(k)
      rounding = rounding + abs(solve(filter, unit))
    end do
  end function rounding_of_step

  !> The changes to which the polynomial of the last step continues. Not where the present rates are
  !! not those of its end: the coordinates are others then.
  pure subroutine continue_last(method, step, rates, changes, continues)
    type(implicit_method_t), intent(in) :: method
    real(wp), intent(in) :: step
    real(wp), intent(in) :: rates(:)
    real(wp), intent(out) :: changes(:, :)
    logical, intent(out) :: continues

    !> A polynomial is continued over this share of the step that it is of, at most. Rates agree to
    !! the second.
    real(wp), parameter :: farthest = 2.0_wp, agreement = 0.01_wp
    real(wp) :: node(0:stages), last(size(rates), 0:stages), place, off
    integer :: i, j, k

    continues = allocated(method%changes)
    if (.not. continues) return
    continues = step <= farthest*method%last_step
    if (.not. continues) return
    do k = 1, size(rates)
      associate (z => method%changes(k, :))
        off = dot_product(solve_transposed(method%stage_factor, unit(stages)), z) - &
          method%last_step*rates(k)
        if (abs(off) > agreement*maxval(abs(z)) + method%tolerance*method%scale(k)) continues = &
          .false.
      end associate
    end do
    if (.not. continues) return
    node(0) = 0.0_wp
    node(1:) = method%rule%node
    last(:, 0) = 0.0_wp
    last(:, 1:) = method%changes
    changes = -spread(method%changes(:, stages), 2, stages)
    do i = 1, stages
      place = 1.0_wp + method%rule%node(i)*step/method%last_step
      do j = 1, stages
        changes(:, i) = changes(:, i) + lagrange(node, j + 1, place)*last(:, j)
      end do
    end do
  end subroutine continue_last

  !> A unit vector of the stages.
  pure function unit(number) result(vector)
    integer, intent(in) :: number
    real(wp) :: vector(stages)

    vector = 0.0_wp
    vector(number) = 1.0_wp
  end function unit

  !> Newton's iterations for the changes, until what they leave is small or rounding.
  subroutine iterate(method, system, time, step, state, factor, allowed, changes, solved)
    type(implicit_method_t), intent(inout) :: method
    class(rate_system_t), intent(inout) :: system
    real(wp), intent(in) :: time, step
    real(wp), intent(in) :: state(:)
    type(dense_factor_t), intent(in) :: factor !! of `newton_matrix`
    real(wp), intent(in) :: allowed(:)         !! (unknowns) error of the step
    real(wp), intent(inout) :: changes(:, :)   !! (unknowns, stages) first, then last iterate
    logical, intent(out) :: solved

    real(wp) :: rates(size(state), stages), correction(size(state), stages), now, before, ratio
    integer :: i, k

    before = huge(1.0_wp)
    do k = 1, most_iterations
      do i = 1, stages
        method%evaluations = method%evaluations + 1_long
        call system%find_rates(time + method%rule%node(i)*step, state + changes(:, i), &
          rates(:, i), solved)
        if (.not. solved) return
      end do
      correction = step*matmul(rates, transpose(method%rule%matrix)) - changes
      correction = reshape(solve(factor, reshape(correction, [size(correction)])), &
        shape(correction))
      changes = changes + correction
      now = maxval(abs(correction)/spread(allowed, 2, stages))
      ! Written so that NaN is refused as well.
      solved = now < sqrt(huge(1.0_wp))
      if (.not. solved) return
      ratio = now/before
      if (k == 1) ratio = 0.5_wp
      solved = now*ratio <= share_of_iterations .and. now <= 1.0_wp
      ! Where corrections no longer become smaller, they are rounding, or the step is too long.
      if (ratio >= 1.0_wp .and. .not. solved) solved = now <= 0.5_wp
      if (solved) return
      if (k > 2 .and. ratio >= 1.0_wp) return
      before = now
    end do
    solved = .false.
  end subroutine iterate

  !> Error of a step, as a share of what is allowed: how far the rates of its stages, continued to
  !! its start, are from those there, `(1 − γhJ)⁻¹ γ (h f(y) − Σ_i ℓ_i(0) (A⁻¹z)_i)`. An estimate of
  !! order 9: in what fades at once, the order of the step is not higher.
  pure function estimated_error(method, step, rates, filter, allowed, changes) result(error)
    type(implicit_method_t), intent(in) :: method
    real(wp), intent(in) :: step
    real(wp), intent(in) :: rates(:)           !! (unknowns) at the start
    type(dense_factor_t), intent(in) :: filter !! of `filter_matrix`
    real(wp), intent(in) :: allowed(:)         !! (unknowns) error of the step
    real(wp), intent(in) :: changes(:, :)
    real(wp) :: error

    real(wp) :: off(size(rates))

    off = gamma*(step*rates - matmul(changes, solve_transposed(method%stage_factor, &
      method%at_start)))
    error = maxval(abs(solve(filter, off))/allowed)
  end function estimated_error

end module implicit_steps
