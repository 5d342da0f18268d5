!> The slow part of the motion of an elastic linkage, in slow coordinates z (`slow_bases`).
!!
!! At a speed the equation `(M z' + G z)' = (Gᵀ − C/ω) z' + (W − K/ω²) z + F/ω²` is solved by
!! Gauss collocation, step after step, and closed to a periodic motion. It serves as an approximate
!! inverse of the whole equation, and gives the multipliers of a turn.
!!
!! With s stages z is a polynomial of degree s in a step, and collocation is Galerkin's method with
!! such polynomials and Gauss's rule, which is exact to degree 2s − 1. So a step is a finite element
!! whose inner amplitudes are eliminated: by one fewer a coordinate than a step has stages.
module slow_motions
  use constants, only: two_pi
  use errors, only: error_of_numerics, error_t, set_error
  use fourier_transform, only: close_fourier, coefficients_of, fourier_plan_t, open_fourier, &
    shifted, values_of
  use gauss_collocation, only: collocation_t, new_collocation
  use kinds, only: wp
  use lapack, only: dgeev, dgetrf, dgetrs
  use legendre, only: legendre_values
  use slow_bases, only: has_damping, matrices_at_speed, of_mass, slow_basis_t
  use text, only: to_string
  implicit none (type, external)
  private

  public :: slow_motion_t, new_slow_motion, find_monodromy, solve_slow, slow_mode_t, slow_modes, &
    slow_mode_shape, solve_slow_shifted, add_shape_frequencies

  !> Free motions that grow by more than this in a turn leave no digits of a periodic one; within
  !! the turn they may grow until numbers nearly overflow.
  real(wp), parameter :: most_growth = 1.0e12_wp, near_overflow = 1.0e100_wp

  !> Steps of the collocation at one speed.
  type :: slow_motion_t
    integer :: number = 0, steps = 0
    type(collocation_t) :: rule
    real(wp) :: scale = 1.0_wp                 !! of momenta
    real(wp), allocatable :: transfer(:, :, :) !! (2 number, 2 number, steps) of coordinates and
                                               !! momenta over a step
    real(wp), allocatable :: inner(:, :, :)    !! (2 number, number × (stages − 1), steps) share of
                                               !! forces on inner amplitudes in those on both ends
    real(wp), allocatable :: share(:, :)       !! (stages, stages + 1) of loads at the stages in
                                               !! forces on inner amplitudes and on both ends
    real(wp), allocatable :: monodromy(:, :)   !! (2 number, 2 number) over the turn
    logical :: grows = .false.                 !! too much in a turn
    real(wp), allocatable :: factor(:, :)      !! of `1 − monodromy`
    integer, allocatable :: pivot(:)
  end type slow_motion_t

  !> A free motion of the slow coordinates, `e^{σ θ} z(θ)`.
  type :: slow_mode_t
    complex(wp) :: exponent = (0.0_wp, 0.0_wp) !! σ, its imaginary part between 0 and 1/2
    complex(wp), allocatable :: start(:)       !! (2 number) coordinates and momenta at the first
                                               !! crank angle
    logical :: is_complex = .false.            !! its conjugate is another
    real(wp) :: frequency = 0.0_wp             !! of the shape there, `√(zᴴz/zᴴM z)` [rad/s]
    real(wp) :: shape_frequency = 0.0_wp       !! over the turn, `√(∮zᴴz/∮zᴴM z)` [rad/s]
    real(wp) :: action = 0.0_wp                !! about 1 or −1 by the Krein signature, 0 at
                                               !! collisions
  end type slow_mode_t

contains

  !> Steps of the collocation at a speed, as many as samples.
  !!
  !! Errors: a multiplier of the slow motion is 1 (resonance); it grows too much in a turn, and the
  !! monodromy matrix is not finished.
  subroutine new_slow_motion(plan, basis, speed, stages, motion, error)
    type(fourier_plan_t), intent(in) :: plan !! for its samples
    type(slow_basis_t), intent(in) :: basis
    real(wp), intent(in) :: speed !! ω2 [rad/s]
    integer, intent(in) :: stages !! of a step
    type(slow_motion_t), intent(out) :: motion
    type(error_t), allocatable, intent(out) :: error !! why it cannot be closed

    integer :: i, m, n, info

    n = plan%samples
    m = basis%number
    motion%number = m
    motion%steps = n
    motion%rule = new_collocation(stages)
    allocate (motion%transfer(2*m, 2*m, n), motion%inner(2*m, m*(stages - 1), n))
    call make_steps(basis, speed, motion)
    call find_monodromy(motion, error)
    if (allocated(error)) return
    motion%factor = -motion%monodromy
    do i = 1, 2*m
      motion%factor(i, i) = 1.0_wp + motion%factor(i, i)
    end do
    allocate (motion%pivot(2*m))
    call dgetrf(2*m, 2*m, motion%factor, 2*m, motion%pivot, info)
    if (info /= 0) call set_error(error, error_of_numerics, &
      "resonance: the slow motion has a multiplier of 1")
  end subroutine new_slow_motion

  !> The monodromy matrix of all steps.
  !!
  !! Errors: the motion grows too much in a turn, and the matrix is not finished.
  subroutine find_monodromy(motion, error)
    type(slow_motion_t), intent(inout) :: motion !! with transfers
    type(error_t), allocatable, intent(out) :: error

    integer :: k, n

    n = motion%steps
    motion%monodromy = motion%transfer(:, :, 1)
    do k = 2, n
      motion%monodromy = matmul(motion%transfer(:, :, k), motion%monodromy)
      motion%grows = .not. maxval(abs(motion%monodromy)) <= merge(most_growth, near_overflow, &
        k == n)
      if (.not. motion%grows) cycle
      call set_error(error, error_of_numerics, "free vibrations seem to grow by a factor above "// &
        "10^"//to_string(nint(log10(most_growth)))//" in a turn: the linkage is unstable, or "// &
        "its slowest motions alone do not show how it vibrates")
      return
    end do
  end subroutine find_monodromy

  !> All steps. Their matrices are functions of the crank angle, too: those of steps that are evenly
  !! spaced come from short transforms.
  subroutine make_steps(basis, speed, motion)
    type(slow_basis_t), intent(in) :: basis
    real(wp), intent(in) :: speed
    type(slow_motion_t), intent(inout) :: motion !! with its rule

    type(fourier_plan_t) :: plan
    complex(wp), allocatable :: series(:, :, :, :), turned(:)
    real(wp), allocatable :: coefficients(:, :), values(:, :), forms(:, :, :, :)
    logical :: symmetric
    integer :: apart, e, first, i, j, k, n, together, trials

    trials = size(motion%rule%node) + 1
    symmetric = .not. has_damping(basis)
    call find_forms(basis, speed, symmetric, motion, series)
    n = 2*ubound(series, 1)
    apart = 1
    do i = 2, motion%steps/n
      if (modulo(motion%steps, 2*i) == 0) apart = i
    end do
    together = motion%steps/apart
    allocate (coefficients(together, size(series, 2)), values(together, size(series, 2)), &
      source=0.0_wp)
    allocate (forms(size(series, 2), trials, trials, together))
    call open_fourier(together, plan)
    do first = 1, apart
      turned = [(exp(cmplx(0.0_wp, two_pi*k*(first - 1)/motion%steps, wp)), k=0, n/2)]
      do j = 1, trials
        do i = 1, merge(j, trials, symmetric)
          do e = 1, size(series, 2)
            call take(turned*series(:, e, i, j), coefficients(:, e))
          end do
          call values_of(plan, coefficients, values)
          forms(:, i, j, :) = transpose(values)
        end do
      end do
      do k = 1, together
        call make_step(motion, first + (k - 1)*apart, symmetric, trials, forms(:, :, :, k))
      end do
    end do
    call close_fourier(plan)

  contains

    pure subroutine take(harmonic, coefficients)
      complex(wp), intent(in) :: harmonic(0:)
      real(wp), intent(inout) :: coefficients(:)

      coefficients(1) = real(harmonic(0))
      coefficients(2:n:2) = real(harmonic(1:))
      coefficients(3:n - 1:2) = aimag(harmonic(1:n/2 - 1))
      ! The highest harmonic is shared by +n/2 and −n/2.
      if (together > n) coefficients(n:n + 1) = 0.5_wp*[real(harmonic(n/2)), aimag(harmonic(n/2))]
    end subroutine take

  end subroutine make_steps

  !> Series of the matrices H of a step from any crank angle on, by pairs of trial functions of its
  !! polynomials. With forces f, `Σ H_ij Z_j + f_i` is 0 for inner amplitudes, less the momentum for
  !! the start, the momentum for the end. Trial functions are integrals of Legendre's polynomials
  !! for inner amplitudes, then those of the start and of the end.
  subroutine find_forms(basis, speed, symmetric, motion, series)
    type(slow_basis_t), intent(in) :: basis
    real(wp), intent(in) :: speed
    logical, intent(in) :: symmetric             !! only H_ij with i ≤ j
    type(slow_motion_t), intent(inout) :: motion !! gets shares of loads and the scale of momenta
    complex(wp), allocatable, intent(out) :: series(:, :, :, :) !! (harmonics from 0, number², i, j)

    real(wp), dimension(size(motion%rule%node), size(motion%rule%node) + 1) :: value, slope
    real(wp) :: p(0:size(motion%rule%node)), h
    real(wp), allocatable :: total(:, :, :)
    !> M, G, Gᵀ − C, V; of the stages, and what pairs take of these matrices
    complex(wp), allocatable :: matrix(:, :, :), wave(:, :), weight(:, :)
    integer, allocatable :: turned(:)
    integer :: e, i, j, k, m, n, s

    m = basis%number
    s = size(motion%rule%node)
    n = min(size(basis%sums, 1), motion%steps)
    h = two_pi/motion%steps
    do i = 1, s
      associate (x => motion%rule%node(i))
        p = legendre_values(s, 2.0_wp*x - 1.0_wp)
        value(i, :) = [((p(j + 1) - p(j - 1))/(4*j + 2), j=1, s - 1), 1.0_wp - x, x]
        slope(i, :) = [(p(j), j=1, s - 1), -1.0_wp, 1.0_wp]/h
      end associate
    end do
    motion%share = h*spread(motion%rule%weight, 2, s + 1)*value
    call matrices_at_speed(basis, speed, n, total)
    motion%scale = sqrt(sum(abs(total(1, 1::m + 1, 1)))/m)/abs(speed)
    allocate (matrix(0:n/2, m**2, 4), series(0:n/2, m**2, s + 1, s + 1))
    matrix(0, :, :) = total(1, :, :)
    do k = 1, n/2 - 1
      matrix(k, :, :) = cmplx(total(2*k, :, :), total(2*k + 1, :, :), wp)
    end do
    matrix(n/2, :, :) = total(n, :, :)
    turned = [transpose(reshape([(e, e=1, m**2)], [m, m]))]
    matrix = matrix(:, :, [1, 2, 4, 3])
    matrix(:, :, 3) = matrix(:, turned, 2) - matrix(:, :, 3)
    wave = reshape([((exp(cmplx(0.0_wp, k*h*motion%rule%node(i), wp)), k=0, n/2), i=1, s)], &
      [n/2 + 1, s])
    do j = 1, s + 1
      do i = 1, merge(j, s + 1, symmetric)
        weight = matmul(wave, h*spread(motion%rule%weight, 2, 4)*reshape([slope(:, i)*slope(:, j), &
          slope(:, i)*value(:, j), value(:, i)*slope(:, j), value(:, i)*value(:, j)], [s, 4]))
        do e = 1, m**2
          series(:, e, i, j) = weight(:, 1)*matrix(:, e, 1) + weight(:, 2)*matrix(:, e, 2) + &
            weight(:, 3)*matrix(:, e, 3) + weight(:, 4)*matrix(:, e, 4)
        end do
      end do
    end do
  end subroutine find_forms

  !> One step: its inner amplitudes are eliminated, then it gives coordinates and momenta at its end
  !! from those at its start.
  pure subroutine make_step(motion, step, symmetric, trials, forms)
    type(slow_motion_t), intent(inout) :: motion
    integer, intent(in) :: step
    logical, intent(in) :: symmetric !! forms are there with i ≤ j
    integer, intent(in) :: trials    !! trial functions
    real(wp), intent(in) :: forms(motion%number, motion%number, trials, trials)

    real(wp) :: form(motion%number*trials, motion%number*trials)
    real(wp) :: inner(motion%number*(trials - 2), motion%number*trials)
    real(wp) :: ends(2*motion%number, 2*motion%number), after(motion%number, 3*motion%number)
    integer :: i, j, m, n

    m = motion%number
    n = m*(trials - 2)
    do j = 1, trials
      do i = 1, merge(j, trials, symmetric)
        form((i - 1)*m + 1:i*m, (j - 1)*m + 1:j*m) = forms(:, :, i, j)
        if (symmetric .and. i < j) form((j - 1)*m + 1:j*m, (i - 1)*m + 1:i*m) = &
          transpose(forms(:, :, i, j))
      end do
    end do
    inner = transpose(form(:, :n))
    call divide(n, m*trials, inner)
    associate (transfer => motion%transfer(:, :, step), pushed => motion%inner(:, :, step), &
      scale => motion%scale)
      pushed = transpose(inner(:, n + 1:))
      ends = form(n + 1:, n + 1:) - matmul(pushed, form(:n, n + 1:))
      after(:, :m) = -ends(:m, m + 1:)
      after(:, m + 1:2*m) = ends(:m, :m)
      after(:, 2*m + 1:) = 0.0_wp
      do i = 1, m
        after(i, 2*m + i) = scale
      end do
      call divide(m, 3*m, after)
      transfer(:m, :) = after(:, m + 1:)
      transfer(m + 1:, :) = matmul(ends(m + 1:, m + 1:), after(:, m + 1:))/scale
      transfer(m + 1:, :m) = transfer(m + 1:, :m) + ends(m + 1:, :m)/scale
    end associate
  end subroutine make_step

  !> Replaces B by `A⁻¹ B`, with exchanges of rows. Products of large parts take less time than
  !! column after column: with LAPACK's dgetrf or dgetf2 stability takes a tenth more, a response a
  !! twentieth.
  pure subroutine divide(n, columns, a)
    integer, intent(in) :: n, columns
    real(wp), intent(inout) :: a(n, columns) !! A, then B

    integer, parameter :: together = 24
    real(wp) :: row(columns), left(n)
    integer :: first, j, k, last, p

    do first = 1, n, together
      last = min(first + together - 1, n)
      do k = first, last
        p = k - 1 + maxloc(abs(a(k:, k)), dim=1)
        if (p /= k) then
          row = a(k, :)
          a(k, :) = a(p, :)
          a(p, :) = row
        end if
        left(k + 1:) = a(k + 1:, k)/a(k, k)
        a(k + 1:, k) = left(k + 1:)
        do j = k + 1, last
          a(k + 1:, j) = a(k + 1:, j) - a(k, j)*left(k + 1:)
        end do
      end do
      do k = first, last - 1
        left(k + 1:last) = a(k + 1:last, k)
        do j = last + 1, columns
          a(k + 1:last, j) = a(k + 1:last, j) - a(k, j)*left(k + 1:last)
        end do
      end do
      if (last < n) a(last + 1:, last + 1:) = a(last + 1:, last + 1:) - &
        matmul(a(last + 1:, first:last), a(first:last, last + 1:))
    end do
    do first = together*((n - 1)/together) + 1, 1, -together
      last = min(first + together - 1, n)
      do k = last, first, -1
        left(first:k - 1) = a(first:k - 1, k)
        do j = n + 1, columns
          a(k, j) = a(k, j)/a(k, k)
          a(first:k - 1, j) = a(first:k - 1, j) - a(k, j)*left(first:k - 1)
        end do
      end do
      if (first > 1) a(:first - 1, n + 1:) = a(:first - 1, n + 1:) - &
        matmul(a(:first - 1, first:last), a(first:last, n + 1:))
    end do
  end subroutine divide

  !> The periodic slow motion under a load.
  subroutine solve_slow(plan, motion, load, z)
    type(fourier_plan_t), intent(in) :: plan
    type(slow_motion_t), intent(in) :: motion
    real(wp), intent(in) :: load(:, :) !! (samples, number) F per ω2²
    real(wp), intent(out) :: z(:, :)   !! (samples, number)

    real(wp), dimension(size(load, 1), size(load, 2)) :: coefficients, moved
    real(wp) :: force(size(load, 1), size(load, 2), size(motion%share, 2)), &
      push(2*motion%number, size(load, 1)), state(2*motion%number)
    integer :: i, k, m, n, info

    m = motion%number
    n = motion%steps
    call coefficients_of(plan, load, coefficients)
    force = 0.0_wp
    do i = 1, size(motion%rule%node)
      call values_of(plan, shifted(coefficients, motion%rule%node(i)*two_pi/n), moved)
      call add_stage(motion, i, moved, force)
    end do
    push = pushes(motion, force)
    state = 0.0_wp
    do k = 1, n
      call go_on(motion, k, push(:, k), state)
    end do
    call dgetrs("N", 2*m, 1, motion%factor, 2*m, motion%pivot, state, 2*m, info)
    do k = 1, n
      z(k, :) = state(:m)
      call go_on(motion, k, push(:, k), state)
    end do
  end subroutine solve_slow

  !> The state, coordinates and momenta, from the start of a step to its end.
  pure subroutine go_on(motion, step, push, state)
    type(slow_motion_t), intent(in) :: motion
    integer, intent(in) :: step
    real(wp), intent(in) :: push(:)     !! (2 number) of `pushes`
    real(wp), intent(inout) :: state(:) !! (2 number)

    associate (m => motion%number)
      state(m + 1:) = state(m + 1:) + push(:m)
      state = matmul(motion%transfer(:, :, step), state)
      state(m + 1:) = state(m + 1:) + push(m + 1:)
    end associate
  end subroutine go_on

  !> Adds what loads at a stage are as forces on the trial functions of the steps.
  pure subroutine add_stage(motion, stage, load, force)
    type(slow_motion_t), intent(in) :: motion
    integer, intent(in) :: stage
    real(wp), intent(in) :: load(:, :)        !! (steps, number)
    real(wp), intent(inout) :: force(:, :, :) !! (steps, number, functions)

    integer :: i

    do i = 1, size(force, 3)
      force(:, :, i) = force(:, :, i) + motion%share(stage, i)*load
    end do
  end subroutine add_stage

  !> What forces change of the momenta at the start and at the end of every step.
  pure function pushes(motion, force) result(push)
    type(slow_motion_t), intent(in) :: motion
    real(wp), intent(in) :: force(:, :, :) !! (steps, number, functions)
    real(wp) :: push(2*motion%number, size(force, 1))

    real(wp) :: turned(motion%number*size(force, 3), size(force, 1))
    integer :: k, n

    turned = transpose(reshape(force, [size(force, 1), size(turned, 1)]))
    n = size(motion%inner, 2)
    do k = 1, size(force, 1)
      push(:, k) = (turned(n + 1:, k) - matmul(motion%inner(:, :, k), turned(:n, k)))/motion%scale
    end do
  end function pushes

  !> Free motions, of each pair of conjugate ones that with positive turns.
  !!
  !! Errors: the multipliers do not converge.
  subroutine slow_modes(basis, motion, modes, error)
    type(slow_basis_t), intent(in) :: basis
    type(slow_motion_t), intent(in) :: motion !! of these coordinates
    type(slow_mode_t), allocatable, intent(out) :: modes(:)
    type(error_t), allocatable, intent(out) :: error

    real(wp) :: a(2*motion%number, 2*motion%number), vectors(2*motion%number, 2*motion%number)
    real(wp) :: re(2*motion%number), im(2*motion%number), work(32*motion%number), none(1, 1)
    real(wp) :: mass(motion%number, motion%number)
    integer :: i, m, n, number, info

    m = motion%number
    n = 2*m
    mass = reshape(basis%sums(1, :, of_mass), [m, m])
    a = motion%monodromy
    call dgeev("N", "V", n, a, n, re, im, none, 1, vectors, n, work, size(work), info)
    if (info /= 0 .or. .not. all(hypot(re, im) <= huge(re))) then
      call set_error(error, error_of_numerics, "the multipliers of a turn do not converge")
      return
    end if
    allocate (modes(count(im >= 0.0_wp)))
    number = 0
    do i = 1, n
      if (im(i) < 0.0_wp) cycle
      number = number + 1
      associate (mode => modes(number))
        ! Strong damping leaves nothing of a vibration after a turn: zero has no logarithm.
        mode%exponent = log(cmplx(merge(tiny(re), re(i), hypot(re(i), im(i)) < tiny(re)), im(i), &
          wp))/two_pi
        mode%start = cmplx(vectors(:, i), 0.0_wp, wp)
        mode%is_complex = im(i) > 0.0_wp
        if (mode%is_complex) mode%start = cmplx(vectors(:, i), vectors(:, i + 1), wp)
        associate (z => mode%start(:m))
          ! Where nothing at all is left, vectors may be momenta without displacements.
          mode%frequency = 0.0_wp
          if (any(abs(z) > 0.0_wp)) mode%frequency = sqrt(real(dot_product(z, z))/ &
            real(dot_product(z, matmul(mass, z))))
        end associate
      end associate
    end do
  end subroutine slow_modes

  !> Adds frequencies of shapes over the turn, and actions `ω Im(zᴴp)` over the root of
  !! `∮zᴴz ∮zᴴM z`: without damping the first is the same at all angles.
  pure subroutine add_shape_frequencies(basis, motion, speed, modes)
    type(slow_basis_t), intent(in) :: basis        !! with its followers
    type(slow_motion_t), intent(in) :: motion      !! of these coordinates
    real(wp), intent(in) :: speed                  !! ω2 [rad/s]
    type(slow_mode_t), intent(inout) :: modes(:)

    !> Of all modes, real and imaginary parts: at a step, z there
    real(wp) :: state(2*motion%number, 2, size(modes)), z(motion%number, 2, size(modes))
    real(wp), dimension(motion%number, 2*size(modes)) :: product
    real(wp) :: form(2, size(modes))
    integer :: i, k, m

    m = motion%number
    do i = 1, size(modes)
      state(:, 1, i) = real(modes(i)%start)
      state(:, 2, i) = aimag(modes(i)%start)
    end do
    form = 0.0_wp
    do k = 1, motion%steps
      do i = 1, size(modes)
        z(:, :, i) = parts_of_product(exp(-modes(i)%exponent*two_pi*(k - 1)/motion%steps), &
          state(:m, 1, i), state(:m, 2, i))
      end do
      product = matmul(reshape(basis%mass(k, :), [m, m]), reshape(z, [m, 2*size(modes)]))
      do i = 1, size(modes)
        form(:, i) = form(:, i) + [sum(z(:, :, i)*product(:, 2*i - 1:2*i)), sum(z(:, :, i)**2)]
      end do
      state = reshape(matmul(motion%transfer(:, :, k), reshape(state, [2*m, 2*size(modes)])), &
        shape(state))
    end do
    form = form/motion%steps
    modes%shape_frequency = sqrt(form(2, :)/form(1, :))
    do i = 1, size(modes)
      modes(i)%action = speed*motion%scale*aimag(dot_product(modes(i)%start(:m), &
        modes(i)%start(m + 1:)))/sqrt(form(1, i)*form(2, i))
    end do
  end subroutine add_shape_frequencies

  !> z of a free motion over the turn. That of a mode that fades fast is lost in the rounding of
  !! slower ones.
  pure function slow_mode_shape(motion, mode) result(shape)
    type(slow_motion_t), intent(in) :: motion
    type(slow_mode_t), intent(in) :: mode
    complex(wp) :: shape(motion%steps, motion%number)

    real(wp) :: state(2*motion%number, 2)
    integer :: k

    state(:, 1) = real(mode%start)
    state(:, 2) = aimag(mode%start)
    do k = 1, motion%steps
      shape(k, :) = exp(-mode%exponent*two_pi*(k - 1)/motion%steps)* &
        cmplx(state(:motion%number, 1), state(:motion%number, 2), wp)
      state = matmul(motion%transfer(:, :, k), state)
    end do
  end function slow_mode_shape

  !> The periodic solution z of the slow equation with d/dθ2 + σ in place of d/dθ2, under a complex
  !! load.
  subroutine solve_slow_shifted(plan, motion, exponent, load, load_imaginary, z, z_imaginary)
    type(fourier_plan_t), intent(in) :: plan
    type(slow_motion_t), intent(in) :: motion
    complex(wp), intent(in) :: exponent !! σ, not one of a free motion
    real(wp), intent(in) :: load(:, :), load_imaginary(:, :) !! (samples, number) F per ω2²
    real(wp), intent(out) :: z(:, :), z_imaginary(:, :)      !! (samples, number)

    real(wp), dimension(size(load, 1), size(load, 2)) :: coefficients, coefficients_imaginary, &
      moved, moved_imaginary
    real(wp), dimension(size(load, 1), size(load, 2), size(motion%share, 2)) :: force, &
      force_imaginary
    real(wp), dimension(2*motion%number, 2) :: state, turned_back
    real(wp) :: push(2*motion%number, size(load, 1), 2), left(4*motion%number, 4*motion%number), &
      theta
    complex(wp) :: wave(size(load, 1)), turned
    integer :: pivot(4*motion%number), i, k, m, n, info

    m = motion%number
    n = motion%steps
    call coefficients_of(plan, load, coefficients)
    call coefficients_of(plan, load_imaginary, coefficients_imaginary)
    force = 0.0_wp
    force_imaginary = 0.0_wp
    do i = 1, size(motion%rule%node)
      theta = motion%rule%node(i)*two_pi/n
      call values_of(plan, shifted(coefficients, theta), moved)
      call values_of(plan, shifted(coefficients_imaginary, theta), moved_imaginary)
      wave = [(exp(exponent*(theta + two_pi*(k - 1)/n)), k=1, n)]
      associate (re => spread(real(wave), 2, m), im => spread(aimag(wave), 2, m))
        call add_stage(motion, i, re*moved - im*moved_imaginary, force)
        call add_stage(motion, i, im*moved + re*moved_imaginary, force_imaginary)
      end associate
    end do
    push(:, :, 1) = pushes(motion, force)
    push(:, :, 2) = pushes(motion, force_imaginary)
    state = 0.0_wp
    do k = 1, n
      do i = 1, 2
        call go_on(motion, k, push(:, k, i), state(:, i))
      end do
    end do
    ! (e^{2πσ} − monodromy) state = what the load leaves after a turn, in real numbers
    turned = exp(two_pi*exponent)
    left = 0.0_wp
    left(:2*m, :2*m) = -motion%monodromy
    left(2*m + 1:, 2*m + 1:) = -motion%monodromy
    do i = 1, 2*m
      left(i, i) = left(i, i) + real(turned)
      left(2*m + i, 2*m + i) = left(2*m + i, 2*m + i) + real(turned)
      left(i, 2*m + i) = -aimag(turned)
      left(2*m + i, i) = aimag(turned)
    end do
    call dgetrf(4*m, 4*m, left, 4*m, pivot, info)
    call dgetrs("N", 4*m, 1, left, 4*m, pivot, state, 4*m, info)
    do k = 1, n
      turned_back = parts_of_product(exp(-exponent*two_pi*(k - 1)/n), state(:, 1), state(:, 2))
      z(k, :) = turned_back(:m, 1)
      z_imaginary(k, :) = turned_back(:m, 2)
      do i = 1, 2
        call go_on(motion, k, push(:, k, i), state(:, i))
      end do
    end do
  end subroutine solve_slow_shifted

  !> Real and imaginary parts of a number times a complex vector.
  pure function parts_of_product(number, re, im) result(parts)
    complex(wp), intent(in) :: number
    real(wp), intent(in) :: re(:), im(:)
    real(wp) :: parts(size(re), 2)

    parts(:, 1) = real(number)*re - aimag(number)*im
    parts(:, 2) = aimag(number)*re + real(number)*im
  end function parts_of_product

end module slow_motions
