!> States from which an elastic motion in time starts.
module transient_starts
  use constants, only: degree
  use crank_laws, only: crank_breaks, crank_law_t, crank_motion
  use elastic_equations, only: load_at_speed
  use equations_at_speed, only: equation_at_speed_t
  use errors, only: error_of_numerics, error_t, set_error
  use fourier_transform, only: close_fourier, coefficients_of, derivative_of, fourier_plan_t, &
    open_fourier, value_at
  use kinds, only: wp
  use lapack, only: dsygvx
  use link_store, only: link_store_t
  use motion_matrices, only: find_motion_matrices, motion_matrices_t, stiffness_at
  use path_grids, only: place_grid
  use periodic_solver, only: solve_periodic
  use refinements, only: sample_numbers
  use response_levels, only: level_slot_t, need_basis, need_level, set_equation
  use response_series, only: place_series
  use slow_bases, only: slow_count
  use slow_motions, only: new_slow_motion, slow_motion_t
  use structures, only: structure_t
  use text, only: to_string
  use transient_steps, only: momenta_of
  use transient_types, only: from_steady, transient_request_t
  use turn_grids, only: turn_grid_t
  implicit none (type, external)
  private

  public :: find_start

  !> Stages of the collocation of slow motions, and samples of a period of the fastest of them.
  integer, parameter :: slow_stages = 3
  real(wp), parameter :: samples_a_period = 2.5_wp

  !> The periodic motion is solved to this; what it lacks is to be below so much of the accuracy.
  real(wp), parameter :: tolerance = 1.0e-13_wp, share = 0.1_wp

  !> The highest eighth of the harmonics of the periodic motion, beside the whole.
  real(wp), parameter :: tail = 1.0e-11_wp

  !> Places along a link at which the largest displacement of a shape is sought.
  integer, parameter :: places = 100

contains

  !> y and P at the first instant: undeformed, with ẏ = 0, or in the steady state at the first crank
  !! angle; with the shape of a mode added, as a deformation, as a velocity or both. The deformation
  !! by itself has none: the rates of all strains are as small as they can be.
  !!
  !! Errors: the crank cannot reach its first angle; there is no steady state, or it is not accurate
  !! enough; the mode does not exist.
  subroutine find_start(structure, request, law, order, grid, store, start, error, lack)
    class(structure_t), intent(in) :: structure       !! linkage and beams
    type(transient_request_t), intent(in) :: request
    type(crank_law_t), intent(in) :: law              !! of the crank
    integer, intent(in) :: order                      !! of the model
    type(turn_grid_t), intent(inout) :: grid          !! of the model, for one crank angle
    type(link_store_t), intent(inout) :: store        !! links decomposed earlier
    real(wp), allocatable, intent(out) :: start(:)    !! (2 unknowns)
    type(error_t), allocatable, intent(out) :: error
    real(wp), intent(out), optional :: lack           !! what the steady state lacks, as a share

    type(motion_matrices_t) :: matrices
    real(wp) :: lacks
    real(wp), dimension(grid%unknowns) :: y, rates, shape
    real(wp) :: motion(0:2)

    motion = first_motion(request, law)
    call place_grid(structure, motion(:0), grid, error)
    if (allocated(error)) return
    call find_motion_matrices(grid, matrices)
    y = 0.0_wp
    rates = 0.0_wp
    lacks = 0.0_wp
    if (request%start == from_steady) then
      call find_steady(structure, request, law, order, store, y, rates, lacks, error)
      if (allocated(error)) return
    end if
    if (request%mode > 0) then
      call find_shape(structure, request, motion, grid, matrices, shape, error)
      if (allocated(error)) return
      y = y + request%amplitude*shape
      rates = rates + request%velocity*shape - request%amplitude*motion(1)*idle_rates(grid, &
        matrices, shape)
    end if
    start = [y, momenta_of(matrices, 1, motion(1), y, rates)]
    if (present(lack)) lack = lacks
  end subroutine find_start

  !> Crank angle, speed and acceleration at the first instant, of a law those that follow it.
  pure function first_motion(request, law) result(motion)
    type(transient_request_t), intent(in) :: request
    type(crank_law_t), intent(in) :: law
    real(wp) :: motion(0:2)

    real(wp), allocatable :: places(:)

    if (.not. allocated(law%program)) then
      motion = crank_motion(law, 0.0_wp, 0.0_wp)
      return
    end if
    associate (first => request%time(1), last => request%time(size(request%time)))
      places = [crank_breaks(law, first, last), last]
      motion = crank_motion(law, first, 0.5_wp*(first + places(1)))
    end associate
  end function first_motion

  !> Rates per ω2 that unknowns would have to lose for strains `w = Q y` of parts to have the least
  !! rates `Q ẏ + ω Q' y`: `Qᵀ Q' y`, since `QᵀQ = 1`. Where unknowns are strains there are none.
  pure function idle_rates(grid, matrices, y) result(rates)
    type(turn_grid_t), intent(in) :: grid
    type(motion_matrices_t), intent(in) :: matrices !! at one crank angle
    real(wp), intent(in) :: y(:)
    real(wp) :: rates(size(y))

    real(wp), allocatable :: w(:)
    integer :: d

    rates = 0.0_wp
    d = size(grid%dampers)
    if (allocated(matrices%strain)) then
      w = matmul(matrices%strain_slope(:, :, 1), y)
      associate (deformations => size(grid%deformed))
        w(deformations - d + 1:deformations) = 0.0_wp
      end associate
      rates = matmul(w, matrices%strain(:, :, 1))
    else if (allocated(matrices%deformed)) then
      w = matmul(matrices%deformed_slope(:, :, 1), y(:grid%border))
      w(size(w) - d + 1:) = 0.0_wp
      rates(:grid%border) = matmul(w, matrices%deformed(:, :, 1))
    end if
  end function idle_rates

  !> y and ẏ of the steady state at the first crank angle, with as many samples of the turn as its
  !! harmonics need.
  subroutine find_steady(structure, request, law, order, store, y, rates, lack, error)
    class(structure_t), intent(in) :: structure
    type(transient_request_t), intent(in) :: request
    type(crank_law_t), intent(in) :: law
    integer, intent(in) :: order
    type(link_store_t), intent(inout) :: store
    real(wp), intent(out) :: y(:), rates(:)
    real(wp), intent(out) :: lack !! what it lacks, as a share of it
    type(error_t), allocatable, intent(out) :: error

    type(level_slot_t), allocatable, target :: levels(:)
    type(slow_motion_t), target :: motion
    type(fourier_plan_t), target :: plan
    type(equation_at_speed_t) :: equation
    real(wp), allocatable :: periodic(:, :), coefficients(:, :)
    real(wp) :: speed, theta, remainder, last
    integer :: at, iterations, level, n, slow

    speed = abs(law%speed)
    theta = sign(1.0_wp, law%speed)*law%start*degree
    last = huge(1.0_wp)
    lack = last
    do at = 3, size(sample_numbers), 2
      n = sample_numbers(at)
      allocate (levels(0))
      call need_level(structure, order, n, law%speed < 0.0_wp, store, levels, level, error)
      if (allocated(error)) return
      associate (here => levels(level)%level)
        slow = slow_count(here%coarse, speed*n/samples_a_period)
        call need_basis(slow, request%response%damping, here, error)
        if (allocated(error)) return
        call open_fourier(n, plan)
        allocate (periodic(n, size(y)), coefficients(n, size(y)))
        periodic = 0.0_wp
        remainder = huge(1.0_wp)
        call new_slow_motion(plan, here%basis(slow), speed, slow_stages, motion, error)
        if (.not. allocated(error)) then
          call set_equation(here, plan, motion, speed, request%response%damping, &
            request%response%terms, equation)
          call solve_periodic(equation, load_at_speed(here%grid, speed), tolerance, periodic, &
            iterations, remainder, error)
        end if
        if (.not. allocated(error)) then
          call coefficients_of(plan, periodic, coefficients)
          last = norm2(coefficients(n - n/8:, :))/max(norm2(coefficients), tiny(1.0_wp))
          y = value_at(coefficients, theta)
          rates = speed*value_at(derivative_of(coefficients), theta)
        end if
        call close_fourier(plan)
      end associate
      lack = max(last, remainder)
      deallocate (levels, periodic, coefficients)
      if (.not. allocated(error) .and. last <= tail .and. remainder <= &
        share*request%response%accuracy) return
      if (allocated(error) .and. at + 2 > size(sample_numbers)) return
    end do
    if (last > share*request%response%accuracy .or. remainder > share*request%response%accuracy) &
      call set_error(error, error_of_numerics, "the steady state is not accurate enough to "// &
      "start from: it lacks "//to_string(max(last, remainder), 2))
  end subroutine find_steady

  !> The shape of a mode of the linkage frozen at the first instant, its largest displacement 1 m.
  !! The largest displacement across a link at its middle is to the left.
  subroutine find_shape(structure, request, motion, grid, matrices, shape, error)
    class(structure_t), intent(in) :: structure
    type(transient_request_t), intent(in) :: request
    real(wp), intent(in) :: motion(0:2)               !! of `first_motion`
    type(turn_grid_t), intent(in) :: grid             !! at the first crank angle
    type(motion_matrices_t), intent(in) :: matrices   !! there
    real(wp), intent(out) :: shape(:)                 !! (unknowns) y of 1 m
    type(error_t), allocatable, intent(out) :: error

    real(wp), dimension(size(shape), size(shape)) :: mass, stiffness
    real(wp) :: value(size(shape)), vector(size(shape), 1), work(8*size(shape)), moved(1, 3)
    real(wp) :: largest, across, here
    integer :: iwork(5*size(shape)), fail(size(shape)), b, found, i, info, n, number

    n = size(shape)
    number = n + 1 - request%mode
    if (number < 1) then
      call set_error(error, error_of_numerics, "there is no mode "//to_string(request%mode)// &
        ": the links have "//to_string(n)//" modes at order "//to_string(maxval( &
        grid%model%links%modes)))
      return
    end if
    mass = matrices%mass(:, :, 1)
    stiffness = stiffness_at(matrices, 1, motion(1), motion(2), request%response%terms%axial)
    ! M φ = 1/ω² (1 + K_G) φ: the lowest modes have the largest values.
    call dsygvx(1, "V", "I", "U", n, mass, n, stiffness, n, 0.0_wp, 0.0_wp, number, number, &
      0.0_wp, found, value, vector, n, work, size(work), iwork, fail, info)
    if (info /= 0) then
      call set_error(error, error_of_numerics, "the linkage frozen at the first crank angle "// &
        "diverges: it has no modes of vibration there")
      return
    end if
    shape = vector(:, 1)
    largest = 0.0_wp
    across = 0.0_wp
    do b = 1, size(structure%elastic%body)
      do i = 0, places
        moved = place_series(grid, b, [structure%elastic%linkage%bodies(b)%length*i/places, &
          0.0_wp], transpose(vector))
        largest = max(largest, norm2(moved(1, :2)))
        here = grid%direction(1, 1, b)*moved(1, 2) - grid%direction(1, 2, b)*moved(1, 1)
        if (2*i == places .and. abs(here) > abs(across)) across = here
      end do
    end do
    shape = shape*sign(1.0_wp/largest, across)
  end subroutine find_shape

end module transient_starts
