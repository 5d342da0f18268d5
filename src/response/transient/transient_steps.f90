!> Steps in time of the elastic motion, by collocation in all unknowns.
!!
!! In canonical form `P = M ẏ + ω G y`, `Ṗ = ω Gᵀ ẏ + (ω² W − 1 − K_G) y − C ẏ + f` the matrices
!! need no derivatives over time, at constant speed or not.
module transient_steps
  use crank_laws, only: crank_law_t, crank_motion
  use errors, only: error_of_numerics, error_t, set_error
  use gauss_collocation, only: collocation_t
  use kinds, only: wp
  use lapack, only: dgetrf, dgetrs
  use motion_matrices, only: find_motion_matrices, load_at, motion_matrices_t, stiffness_at
  use path_grids, only: place_grid
  use strain_dampings, only: damping_t, share_at
  use structures, only: structure_t
  use turn_grids, only: turn_grid_t
  implicit none (type, external)
  private

  public :: stepping_t, transient_step_t, make_steps, take_steps, elastic_state_t, add_damping, &
    advance, kick, momenta_of, rates_of

  !> What is solved in steps, and how: so many equal ones at a time as the grid has stages for.
  type :: stepping_t
    type(crank_law_t) :: law            !! of the crank; smooth over these steps
    type(damping_t) :: damping          !! of `damping_of`
    logical :: axial = .true.           !! with the stiffness of axial forces
    type(collocation_t) :: rule         !! of a step
    type(turn_grid_t) :: grid           !! by `new_path_grid`, for all stages of all steps
    type(motion_matrices_t) :: matrices !! at the stages
  end type stepping_t

  !> What a step does to the state (y, P): its change is `change · state + push`.
  type :: transient_step_t
    real(wp), allocatable :: change(:, :) !! (2 unknowns, 2 unknowns)
    real(wp), allocatable :: push(:)      !! (2 unknowns) [√J, √J s]
  end type transient_step_t

  !> Terms of the equation at the stages of a step.
  type :: stage_terms_t
    real(wp), allocatable :: v(:, :, :) !! (unknowns, unknowns, stages) ω² W − 1 − K_G
    real(wp), allocatable :: d(:, :, :) !! ω Gᵀ − C [s]
    real(wp), allocatable :: g(:, :, :) !! ω G [s]
    real(wp), allocatable :: load(:, :) !! (unknowns, stages) f [√J]
    real(wp), allocatable :: left(:, :) !! matrix of the rates of all stages
  end type stage_terms_t

  !> Coordinates and momenta, with what rounding has taken from their sums.
  type :: elastic_state_t
    real(wp), allocatable :: value(:) !! (2 unknowns) y, P [√J, √J s]
    real(wp), allocatable :: carry(:) !! (2 unknowns) to be added
  end type elastic_state_t

contains

  !> Times, speeds and accelerations of the stages of equal steps, one after another, and the
  !! matrices there.
  !!
  !! Errors: the crank cannot reach an angle, or meets a dead point.
  subroutine place_stages(structure, start, length, stepping, speed, acceleration, error)
    class(structure_t), intent(in) :: structure
    real(wp), intent(in) :: start, length
    type(stepping_t), intent(inout) :: stepping
    real(wp), intent(out) :: speed(:), acceleration(:) !! (samples of the grid)
    type(error_t), allocatable, intent(out) :: error

    real(wp) :: motion(0:2, stepping%grid%samples)
    integer :: i, k

    associate (node => stepping%rule%node)
      do k = 1, stepping%grid%samples/size(node)
        do i = 1, size(node)
          motion(:, (k - 1)*size(node) + i) = crank_motion(stepping%law, start + &
            length*(k - 1 + node(i)), start + 0.5_wp*length)
        end do
      end do
    end associate
    call place_grid(structure, motion(0, :), stepping%grid, error)
    if (allocated(error)) return
    call find_motion_matrices(stepping%grid, stepping%matrices)
    speed = motion(1, :)
    acceleration = motion(2, :)
  end subroutine place_stages

  !> Equal steps one after another, for any state.
  !!
  !! Errors: the crank cannot reach an angle, or meets a dead point; a step has no solution.
  subroutine make_steps(structure, start, length, stepping, steps, error)
    class(structure_t), intent(in) :: structure !! of the grid
    real(wp), intent(in) :: start            !! of the first step [s]
    real(wp), intent(in) :: length           !! of each step [s]
    type(stepping_t), intent(inout) :: stepping
    type(transient_step_t), allocatable, intent(out) :: steps(:) !! as many as the grid is for
    type(error_t), allocatable, intent(out) :: error

    type(stage_terms_t) :: terms
    real(wp), dimension(stepping%grid%samples) :: speed, acceleration
    integer :: k, s

    s = size(stepping%rule%node)
    allocate (steps(stepping%grid%samples/s))
    call place_stages(structure, start, length, stepping, speed, acceleration, error)
    if (allocated(error)) return
    do k = 1, size(steps)
      associate (first => (k - 1)*s + 1)
        call find_terms(stepping, first, speed(first:), acceleration(first:), length, terms)
      end associate
      call make_step(stepping%grid, stepping%rule, length, terms, steps(k), error)
      if (allocated(error)) return
    end do
  end subroutine make_steps

  !> The state after equal steps that are taken once.
  !!
  !! Errors: as `make_steps`.
  subroutine take_steps(structure, start, length, stepping, state, error)
    class(structure_t), intent(in) :: structure !! arguments as of `make_steps`
    real(wp), intent(in) :: start, length
    type(stepping_t), intent(inout) :: stepping
    type(elastic_state_t), intent(inout) :: state
    type(error_t), allocatable, intent(out) :: error

    type(stage_terms_t) :: terms
    real(wp), dimension(stepping%grid%samples) :: speed, acceleration
    integer :: k, s

    s = size(stepping%rule%node)
    call place_stages(structure, start, length, stepping, speed, acceleration, error)
    if (allocated(error)) return
    do k = 1, stepping%grid%samples/s
      associate (first => (k - 1)*s + 1)
        call find_terms(stepping, first, speed(first:), acceleration(first:), length, terms)
      end associate
      call take_step(stepping%grid, stepping%rule, length, terms, state, error)
      if (allocated(error)) return
    end do
  end subroutine take_steps

  !> Terms of a step: `M_i v_i + ω G_i y_i = P_i`, `y_i = y + h Σ a_ij v_j`, `P_i = P + h Σ a_ij
  !! Ṗ_j`, `Ṗ_j = D_j v_j + V_j y_j + f_j` for the rates v of the stages.
  subroutine find_terms(stepping, first, speed, acceleration, h, terms)
    type(stepping_t), intent(in) :: stepping
    integer, intent(in) :: first            !! number of the first stage in the matrices
    real(wp), intent(in) :: speed(:)        !! (stages) ω2 [rad/s]
    real(wp), intent(in) :: acceleration(:) !! (stages) α2 [rad/s²]
    real(wp), intent(in) :: h               !! length [s]
    type(stage_terms_t), intent(inout) :: terms

    real(wp), allocatable :: block(:, :)
    integer :: at, i, j, l, n, s

    associate (matrices => stepping%matrices, a => stepping%rule%matrix)
      n = size(matrices%mass, 1)
      s = size(stepping%rule%node)
      if (.not. allocated(terms%v)) allocate (terms%v(n, n, s), terms%d(n, n, s), &
        terms%g(n, n, s), terms%load(n, s), terms%left(n*s, n*s))
      do i = 1, s
        at = first + i - 1
        terms%g(:, :, i) = speed(i)*matrices%slope(:, :, at)
        terms%d(:, :, i) = transpose(terms%g(:, :, i))
        terms%v(:, :, i) = speed(i)**2*matrices%swept(:, :, at) - stiffness_at(matrices, at, &
          speed(i), acceleration(i), stepping%axial)
        call add_damping(matrices, at, stepping%damping, speed(i), terms%d(:, :, i), &
          terms%v(:, :, i))
        terms%load(:, i) = load_at(matrices, at, speed(i), acceleration(i))
      end do
      do i = 1, s
        do l = 1, s
          block = h*a(i, l)*(terms%g(:, :, i) - terms%d(:, :, l))
          do j = 1, s
            block = block - h**2*a(i, j)*a(j, l)*terms%v(:, :, j)
          end do
          if (i == l) block = block + matrices%mass(:, :, first + i - 1)
          terms%left((i - 1)*n + 1:i*n, (l - 1)*n + 1:l*n) = block
        end do
      end do
    end associate
  end subroutine find_terms

  !> Takes `C ẏ` away; of deformations `w = Q y` of parts and dampers `Qᵀ c (Q ẏ + ω Q' y)`, and so
  !! of all strains where some move through pieces with their material.
  subroutine add_damping(matrices, at, damping, speed, d, v)
    type(motion_matrices_t), intent(in) :: matrices
    integer, intent(in) :: at               !! number of the stage in the matrices
    type(damping_t), intent(in) :: damping
    real(wp), intent(in) :: speed           !! ω2 [rad/s]
    real(wp), intent(inout) :: d(:, :), v(:, :) !! (unknowns, unknowns)

    real(wp), allocatable :: damped(:, :)
    integer :: border, k, n

    n = size(d, 1)
    border = 0
    if (allocated(matrices%strain)) then
      associate (strain => matrices%strain(:, :, at), slope => matrices%strain_slope(:, :, at), &
          numbers => matrices%strain_damping)
        damped = spread(damping%c(numbers)*share_at(damping, numbers, &
          matrices%strain_length(:, at)), 2, n)*strain
        d = d - matmul(transpose(damped), strain)
        v = v - speed*matmul(transpose(damped), slope)
      end associate
      return
    end if
    if (allocated(matrices%deformed)) then
      associate (q => matrices%deformed(:, :, at), slope => matrices%deformed_slope(:, :, at))
        border = size(q, 2)
        damped = spread(damping%c(n + 1:), 2, border)*q
        d(:border, :border) = d(:border, :border) - matmul(transpose(damped), q)
        v(:border, :border) = v(:border, :border) - speed*matmul(transpose(damped), slope)
      end associate
    end if
    do k = border + 1, n
      d(k, k) = d(k, k) - damping%c(k)
    end do
  end subroutine add_damping

  !> A step for any state: the rates for every unit of it and for the load.
  subroutine make_step(grid, rule, h, terms, step, error)
    type(turn_grid_t), intent(in) :: grid
    type(collocation_t), intent(in) :: rule
    real(wp), intent(in) :: h
    type(stage_terms_t), intent(inout) :: terms !! `left` is used up
    type(transient_step_t), intent(out) :: step
    type(error_t), allocatable, intent(out) :: error

    real(wp), allocatable :: right(:, :), block(:, :)
    integer :: i, j, k, l, n, s

    n = grid%unknowns
    s = size(rule%node)
    allocate (right(n*s, 2*n + 1), step%change(2*n, 2*n), step%push(2*n))
    associate (a => rule%matrix, w => rule%weight, v => terms%v)
      right = 0.0_wp
      do i = 1, s
        associate (rows => right((i - 1)*n + 1:i*n, :))
          rows(:, :n) = -terms%g(:, :, i)
          do j = 1, s
            rows(:, :n) = rows(:, :n) + h*a(i, j)*v(:, :, j)
            rows(:, 2*n + 1) = rows(:, 2*n + 1) + h*a(i, j)*terms%load(:, j)
          end do
          do k = 1, n
            rows(k, n + k) = 1.0_wp
          end do
        end associate
      end do
      call solve_by_bodies(grid, terms%left, right, error)
      if (allocated(error)) return
      step%change = 0.0_wp
      step%push = 0.0_wp
      do l = 1, s
        block = terms%d(:, :, l)
        do j = 1, s
          block = block + h*w(j)*a(j, l)/w(l)*v(:, :, j)
        end do
        associate (rows => right((l - 1)*n + 1:l*n, :))
          step%change(:n, :) = step%change(:n, :) + h*w(l)*rows(:, :2*n)
          step%change(n + 1:, :) = step%change(n + 1:, :) + h*w(l)*matmul(block, rows(:, :2*n))
          step%push(:n) = step%push(:n) + h*w(l)*rows(:, 2*n + 1)
          step%push(n + 1:) = step%push(n + 1:) + h*w(l)*(matmul(block, rows(:, 2*n + 1)) + &
            terms%load(:, l))
        end associate
        step%change(n + 1:, :n) = step%change(n + 1:, :n) + h*w(l)*v(:, :, l)
      end do
    end associate
  end subroutine make_step

  !> A step from one state.
  subroutine take_step(grid, rule, h, terms, state, error)
    type(turn_grid_t), intent(in) :: grid
    type(collocation_t), intent(in) :: rule
    real(wp), intent(in) :: h
    type(stage_terms_t), intent(inout) :: terms !! `left` is used up
    type(elastic_state_t), intent(inout) :: state
    type(error_t), allocatable, intent(out) :: error

    real(wp) :: right(grid%unknowns*size(rule%node), 1), force(grid%unknowns, size(rule%node)), &
      v(grid%unknowns, size(rule%node)), change(2*grid%unknowns)
    integer :: i, n, s

    n = grid%unknowns
    s = size(rule%node)
    associate (y => state%value(:n), p => state%value(n + 1:))
      do i = 1, s
        force(:, i) = matmul(terms%v(:, :, i), y) + terms%load(:, i)
      end do
      do i = 1, s
        right((i - 1)*n + 1:i*n, 1) = p - matmul(terms%g(:, :, i), y) + h*matmul(force, &
          rule%matrix(i, :))
      end do
      call solve_by_bodies(grid, terms%left, right, error)
      if (allocated(error)) return
      v = reshape(right, [n, s])
      do i = 1, s
        force(:, i) = force(:, i) + matmul(terms%d(:, :, i), v(:, i)) + &
          h*matmul(terms%v(:, :, i), matmul(v, rule%matrix(i, :)))
      end do
    end associate
    change(:n) = h*matmul(v, rule%weight)
    change(n + 1:) = h*matmul(force, rule%weight)
    call add_change(change, state)
  end subroutine take_step

  !> Solves `A X = B` of all stages. Own modes of different links are coupled through the unknowns
  !! of the border only: link by link they are eliminated, and the border comes last.
  subroutine solve_by_bodies(grid, left, right, error)
    type(turn_grid_t), intent(in) :: grid
    real(wp), intent(in) :: left(:, :)     !! A, stage after stage
    real(wp), intent(inout) :: right(:, :) !! B, on return X
    type(error_t), allocatable, intent(out) :: error

    type :: part_t
      integer, allocatable :: at(:)
      real(wp), allocatable :: factor(:, :), to_border(:, :)
      integer, allocatable :: pivot(:)
    end type part_t
    type(part_t) :: parts(size(grid%integrals))
    real(wp), allocatable :: last(:, :), rest(:, :)
    integer, allocatable :: border(:), own(:), pivot(:)
    integer :: b, i, m, n, s, info

    n = grid%unknowns
    s = size(left, 1)/n
    border = at_stages([(i, i=1, grid%border)])
    last = left(border, border)
    rest = right(border, :)
    info = 0
    do b = 1, size(parts)
      associate (part => parts(b), link => grid%model%links(b))
        own = [(i, i=grid%first(b), grid%first(b) + link%modes - 1), &
          (i, i=grid%first_along(b), grid%first_along(b) + link%axial_modes - 1)]
        if (size(own) == 0) cycle
        part%at = at_stages(own)
        m = size(part%at)
        part%factor = left(part%at, part%at)
        allocate (part%pivot(m))
        call dgetrf(m, m, part%factor, m, part%pivot, info)
        if (info /= 0) exit
        part%to_border = left(part%at, border)
        call dgetrs("N", m, size(border), part%factor, m, part%pivot, part%to_border, m, info)
        last = last - matmul(left(border, part%at), part%to_border)
        block
          real(wp), allocatable :: here(:, :)

          here = right(part%at, :)
          call dgetrs("N", m, size(here, 2), part%factor, m, part%pivot, here, m, info)
          rest = rest - matmul(left(border, part%at), here)
          right(part%at, :) = here
        end block
      end associate
    end do
    m = size(border)
    allocate (pivot(m))
    if (info == 0) call dgetrf(m, m, last, m, pivot, info)
    if (info /= 0) then
      call set_error(error, error_of_numerics, "a step in time has no solution")
      return
    end if
    call dgetrs("N", m, size(rest, 2), last, m, pivot, rest, m, info)
    right(border, :) = rest
    do b = 1, size(parts)
      if (.not. allocated(parts(b)%at)) cycle
      right(parts(b)%at, :) = right(parts(b)%at, :) - matmul(parts(b)%to_border, rest)
    end do

  contains

    !> Numbers of unknowns at all stages.
    pure function at_stages(unknowns) result(at)
      integer, intent(in) :: unknowns(:)
      integer :: at(s*size(unknowns))

      integer :: k

      do k = 1, s
        at((k - 1)*size(unknowns) + 1:k*size(unknowns)) = (k - 1)*n + unknowns
      end do
    end function at_stages

  end subroutine solve_by_bodies

  !> The state after a step.
  pure subroutine advance(step, state)
    type(transient_step_t), intent(in) :: step
    type(elastic_state_t), intent(inout) :: state

    call add_change(matmul(step%change, state%value) + step%push, state)
  end subroutine advance

  !> Changes are added with the rounding of the sums before (Kahan), so that it does not pile up
  !! over many turns.
  pure subroutine add_change(change, state)
    real(wp), intent(in) :: change(:)
    type(elastic_state_t), intent(inout) :: state

    real(wp), dimension(size(change)) :: whole, after

    whole = change + state%carry
    after = state%value + whole
    state%carry = whole - (after - state%value)
    state%value = after
  end subroutine add_change

  !> A jump Δω of the crank's speed: `ΔP = Δω (f_α − K_α y)`, what the terms of α2 do in no time.
  pure subroutine kick(matrices, sample, jump, axial, state)
    type(motion_matrices_t), intent(in) :: matrices
    integer, intent(in) :: sample
    real(wp), intent(in) :: jump   !! Δω2 [rad/s]
    logical, intent(in) :: axial   !! with the stiffness of axial forces
    type(elastic_state_t), intent(inout) :: state

    real(wp) :: change(size(state%value))
    integer :: n

    n = size(state%value)/2
    change(:n) = 0.0_wp
    change(n + 1:) = jump*(load_at(matrices, sample, 0.0_wp, 1.0_wp) - load_at(matrices, sample, &
      0.0_wp, 0.0_wp) - matmul(stiffness_at(matrices, sample, 0.0_wp, 1.0_wp, axial) - &
      stiffness_at(matrices, sample, 0.0_wp, 0.0_wp, axial), state%value(:n)))
    call add_change(change, state)
  end subroutine kick

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
