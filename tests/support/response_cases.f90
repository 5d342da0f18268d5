!> Linkages for the tests of the elastic response, and their motion by quadrature over points of the links.
module response_cases
  use beam_mesh, only: beam_t
  use body_lumps, only: pieces_of
  use constants, only: two_pi
  use deformation_model, only: deformation_model_t, new_deformation_model
  use divided_structures, only: divide
  use elastic_equations, only: elastic_terms_t, functions_of, load_at_speed
  use equations_at_speed, only: equation_at_speed_t
  use errors, only: error_t
  use four_bars, only: new_four_bar
  use fourier_transform, only: close_fourier, derivatives, fourier_plan_t, open_fourier
  use kinds, only: long, wp
  use legendre, only: gauss_rule
  use link_degrees, only: link_degrees_t, uniform_degrees
  use link_rows, only: displacement_rows, strain_rows, strain_rows_t
  use linkages, only: body_t, lump_t
  use periodic_solver, only: solve_periodic
  use response_types, only: gauge_t, link_damping_t, link_section_t, response_point_t, response_request_t
  use slow_bases, only: new_slow_basis, slow_basis_t
  use slow_motions, only: new_slow_motion, slow_motion_t
  use structures, only: structure_t
  use strain_dampings, only: damping_t
  use turn_grids, only: new_turn_grid, turn_grid_t
  implicit none (type, external)
  private

  public :: random_t, next_random, between, random_structure, first_mechanism, rotating_cantilever, tip_mass
  public :: grid_of, smooth_motion, steady_motion, request_for
  public :: mass_point_t, mass_points, point_place, point_motion, matrix_of_form, strains_along, displacements_along

  !> Thickness and width of the strips of the first mechanism [m].
  real(wp), parameter, public :: thick = 1.6e-3_wp, wide = 25.4e-3_wp
  real(wp), parameter :: youngs_modulus = 200.0e9_wp, density = 7800.0_wp

  !> Numbers that only look random: the same in every run.
  type :: random_t
    integer(long) :: state = 1_long
  end type random_t

  !> A point with mass on a body.
  type :: mass_point_t
    real(wp) :: place(2) = 0.0_wp !! from the first pin, in the axes of the body [m]
    real(wp) :: mass = 0.0_wp     !! [kg]
    real(wp) :: inertia = 0.0_wp  !! that turns with the cross-section [kg m²]
    logical :: of_lump = .false.  !! the moment of inertia is that of masses in the plane about it, which feel centripetal forces
  end type mass_point_t

contains

  !> The next number between 0 and 1.
  subroutine next_random(random, number)
    type(random_t), intent(inout) :: random
    real(wp), intent(out) :: number

    random%state = modulo(random%state*16807_long, 2147483647_long)
    number = real(random%state, wp)/2147483647.0_wp
  end subroutine next_random

  !> A number between two limits.
  subroutine between(random, low, high, number)
    type(random_t), intent(inout) :: random
    real(wp), intent(in) :: low, high
    real(wp), intent(out) :: number

    call next_random(random, number)
    number = low + (high - low)*number
  end subroutine between

  !> The first mechanism of Ulker (2010): steel strips, 1.6 mm thick.
  function first_mechanism() result(structure)
    type(structure_t) :: structure

    structure%linkage = new_four_bar(reshape([0.0_wp, 0.0_wp, 0.254_wp, 0.0_wp], [2, 2]), [0.1_wp, 0.2794_wp, 0.2667_wp], &
      spread(density*thick*wide, 1, 3), [0.0_wp, 0.0_wp], .false.)
    structure%beams = spread(beam_t(youngs_modulus*thick*wide, youngs_modulus*wide*thick**3/12.0_wp), 1, 3)
    call divide(structure)
  end function first_mechanism

  !> A crank that bends; coupler and follower are rigid and have no mass.
  function rotating_cantilever(length, line_density, beam) result(structure)
    real(wp), intent(in) :: length, line_density !! of the crank [m, kg/m]
    type(beam_t), intent(in) :: beam
    type(structure_t) :: structure

    structure%linkage = new_four_bar(length*reshape([0.0_wp, 0.0_wp, 5.0_wp, 0.0_wp], [2, 2]), length*[1.0_wp, 4.5_wp, &
      4.0_wp], [line_density, 0.0_wp, 0.0_wp], [0.0_wp, 0.0_wp], .false.)
    structure%linkage%bodies(2:3)%bends = .false.
    structure%beams = [beam, beam_t(), beam_t()]
    call divide(structure)
  end function rotating_cantilever

  !> A strip as good as without mass, with a mass at its tip, under gravity.
  function tip_mass(gravity, line_density) result(structure)
    real(wp), intent(in) :: gravity      !! downwards [m/s²]
    real(wp), intent(in) :: line_density !! [kg/m]
    type(structure_t) :: structure

    structure = rotating_cantilever(0.1_wp, line_density, beam_t(2.0e5_wp, 1.6_wp))
    structure%linkage%pin_mass(2) = 0.05_wp
    structure%linkage%gravity = [0.0_wp, -gravity]
    call divide(structure)
  end function tip_mass

  !> A linkage whose crank turns fully, with all that a link, a pin and the world around can have. Every third has a rigid link,
  !! every fourth a short ground, so that all links turn; every second is on the other branch.
  function random_structure(number) result(structure)
    integer, intent(in) :: number
    type(structure_t) :: structure

    type(random_t) :: random
    real(wp) :: length(3), ground, x, line_density(3), h
    real(wp), allocatable :: pin_mass(:)
    integer :: b, i

    random%state = 7919_long*number + 13_long
    do i = 1, 4
      call next_random(random, x)
    end do
    length(1) = 0.1_wp
    call between(random, 0.25_wp, 0.29_wp, length(2))
    call between(random, 0.22_wp, 0.28_wp, length(3))
    call between(random, 0.23_wp, 0.28_wp, ground)
    if (modulo(number, 4) == 0) then
      length(1) = ground
      ground = 0.09_wp
    end if
    allocate (structure%beams(3), pin_mass(2))
    do b = 1, 3
      call between(random, 2.0e-3_wp, 5.0e-3_wp, h)
      line_density(b) = density*h*wide
      structure%beams(b) = beam_t(youngs_modulus*h*wide, youngs_modulus*wide*h**3/12.0_wp)
    end do
    do i = 1, 2
      call between(random, 0.0_wp, 0.06_wp, pin_mass(i))
    end do
    structure%linkage = new_four_bar(reshape([0.02_wp, -0.01_wp, 0.02_wp + ground, 0.03_wp], [2, 2]), length, line_density, &
      pin_mass, modulo(number, 2) == 0)
    do i = 1, 2
      call between(random, -9.81_wp, 9.81_wp, structure%linkage%gravity(i))
      call between(random, -5.0_wp, 5.0_wp, structure%linkage%pin_force(i, 2))
      call between(random, -5.0_wp, 5.0_wp, structure%linkage%pin_force(i, 3))
    end do
    do b = 1, 3
      associate (body => structure%linkage%bodies(b), beam => structure%beams(b))
        call between(random, -0.5_wp, 0.5_wp, structure%linkage%couple(b))
        call next_random(random, x)
        if (x < 0.5_wp) body%rotary_inertia = body%line_density*beam%bending_stiffness/beam%axial_stiffness
        call next_random(random, x)
        if (x < 0.5_wp) beam%shear_stiffness = 0.3_wp*beam%axial_stiffness
        call add_lumps(random, body)
      end associate
    end do
    b = 0
    if (modulo(number, 3) == 1) b = 1 + modulo(number, 2) + modulo(number/3, 2)
    if (b > 0) then
      structure%linkage%bodies(b)%bends = .false.
      structure%beams(b) = beam_t()
    end if
    call divide(structure)
  end function random_structure

  !> Up to two masses: on the axis, beside it, or with a moment of inertia.
  subroutine add_lumps(random, body)
    type(random_t), intent(inout) :: random
    type(body_t), intent(inout) :: body

    real(wp) :: x, kind
    integer :: i

    call next_random(random, x)
    deallocate (body%lumps)
    allocate (body%lumps(int(3.0_wp*x)))
    call next_random(random, kind)
    do i = 1, size(body%lumps)
      call between(random, 0.01_wp, 0.06_wp, body%lumps(i)%mass)
      call between(random, 0.2_wp*body%length, 0.8_wp*body%length, body%lumps(i)%place(1))
      call between(random, -0.02_wp, 0.02_wp, x)
      if (kind < 0.5_wp) body%lumps(i)%place(2) = x
      if (kind > 0.3_wp .and. kind < 0.8_wp) body%lumps(i)%inertia = body%lumps(i)%mass*x**2
    end do
  end subroutine add_lumps

  !> Grid of a structure with one polynomial degree for all pieces of all links.
  subroutine grid_of(structure, order, samples, grid, error)
    type(structure_t), intent(in) :: structure
    integer, intent(in) :: order, samples
    type(turn_grid_t), intent(out) :: grid
    type(error_t), allocatable, intent(out) :: error

    type(deformation_model_t) :: model
    type(link_degrees_t) :: degrees(size(structure%beams))
    integer :: b

    do b = 1, size(degrees)
      degrees(b) = uniform_degrees(size(pieces_of(structure%linkage%bodies(b))) - 1, order, max(3, order - 3))
    end do
    call new_deformation_model(structure%linkage, structure%beams, spread(0, 1, size(degrees)), spread(order, 1, &
      size(degrees)), spread(.false., 1, size(degrees)), model, error, degrees=degrees)
    if (.not. allocated(error)) call new_turn_grid(structure, model, samples, grid, error)
  end subroutine grid_of

  !> A motion of few harmonics, of no equation.
  function smooth_motion(grid, number) result(y)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: number
    real(wp) :: y(grid%samples, grid%unknowns)

    type(random_t) :: random
    real(wp) :: a(2, 0:4)
    integer :: i, j, k

    random%state = 104729_long + 31_long*number
    do i = 1, grid%unknowns
      do j = 0, 4
        do k = 1, 2
          call between(random, -1.0_wp, 1.0_wp, a(k, j))
        end do
      end do
      do k = 1, grid%samples
        y(k, i) = sum([(a(1, j)*cos(j*two_pi*(k - 1)/grid%samples) + a(2, j)*sin(j*two_pi*(k - 1)/grid%samples), j=0, 4)])
      end do
    end do
  end function smooth_motion

  !> The periodic motion of a grid at a speed.
  subroutine steady_motion(grid, speed, damping, terms, slow, y, remainder, error)
    type(turn_grid_t), intent(in), target :: grid
    real(wp), intent(in) :: speed, damping(:)
    type(elastic_terms_t), intent(in) :: terms
    integer, intent(in) :: slow !! coordinates
    real(wp), allocatable, intent(out) :: y(:, :)
    real(wp), intent(out) :: remainder
    type(error_t), allocatable, intent(out) :: error

    type(fourier_plan_t), target :: plan
    type(slow_basis_t), target :: basis
    type(slow_motion_t), target :: motion
    type(equation_at_speed_t) :: equation
    integer :: iterations

    allocate (y(grid%samples, grid%unknowns))
    y = 0.0_wp
    remainder = 0.0_wp
    call open_fourier(grid%samples, plan)
    call new_slow_basis(grid, plan, plan, slow, damping_t(damping), basis, error)
    if (.not. allocated(error)) call new_slow_motion(plan, basis, speed, 3, motion, error)
    equation = equation_at_speed_t(grid, plan, basis, motion, speed, terms, damping_t(damping))
    if (.not. allocated(error)) call solve_periodic(equation, load_at_speed(grid, speed), 1.0e-13_wp, y, iterations, &
      remainder, error)
    call close_fourier(plan)
  end subroutine steady_motion

  !> A request for one speed: the middle of every link that bends as a gauge, pins A and B as points, and peaks.
  function request_for(structure, speed, accuracy, damping, crank) result(request)
    type(structure_t), intent(in) :: structure
    real(wp), intent(in) :: speed(:), accuracy
    type(link_damping_t), intent(in) :: damping !! of every link
    real(wp), intent(in) :: crank(:)            !! [deg]
    type(response_request_t) :: request

    integer :: b, i, n

    n = size(structure%beams)
    request%speed = speed
    request%crank = crank
    request%accuracy = accuracy
    allocate (request%damping(n), request%section(n))
    request%damping = damping
    request%section = link_section_t(0.5_wp*thick, youngs_modulus)
    allocate (request%points(2), request%gauges(count(structure%linkage%bodies%bends)))
    i = 0
    do b = 1, n
      if (b < n) request%points(b) = response_point_t(b, [structure%linkage%bodies(b)%length, 0.0_wp])
      if (.not. structure%linkage%bodies(b)%bends) cycle
      i = i + 1
      request%gauges(i) = gauge_t(b, 0.45_wp, 1.0_wp)
    end do
    request%peaks = .true.
  end function request_for

  !> The mass of a body as points: Gauss points of its pieces, and its lumps.
  function mass_points(body) result(points)
    type(body_t), intent(in) :: body
    type(mass_point_t), allocatable :: points(:)

    integer, parameter :: gauss = 16
    real(wp) :: x(gauss), w(gauss)
    real(wp), allocatable :: ends(:)
    integer :: e, i, n

    ends = pieces_of(body)
    allocate (points(gauss*(size(ends) - 1) + size(body%lumps)))
    call gauss_rule(x, w)
    n = 0
    do e = 1, size(ends) - 1
      do i = 1, gauss
        n = n + 1
        points(n)%place(1) = body%length*(ends(e) + 0.5_wp*(1.0_wp + x(i))*(ends(e + 1) - ends(e)))
        points(n)%mass = 0.5_wp*w(i)*(ends(e + 1) - ends(e))*body%length*body%line_density
        points(n)%inertia = 0.5_wp*w(i)*(ends(e + 1) - ends(e))*body%length*body%rotary_inertia
      end do
    end do
    do i = 1, size(body%lumps)
      points(n + i) = mass_point_t(body%lumps(i)%place, body%lumps(i)%mass, body%lumps(i)%inertia, .true.)
    end do
  end function mass_points

  !> Where a point of the rigid linkage is over the turn.
  function point_place(structure, grid, body, place) result(r)
    type(structure_t), intent(in) :: structure
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    real(wp), intent(in) :: place(2)
    real(wp) :: r(grid%samples, 2)

    associate (e => grid%direction(:, :, body), pin => structure%linkage%bodies(body)%first_pin)
      r(:, 1) = grid%place(:, 1, pin) + place(1)*e(:, 1) - place(2)*e(:, 2)
      r(:, 2) = grid%place(:, 2, pin) + place(1)*e(:, 2) + place(2)*e(:, 1)
    end associate
  end function point_place

  !> Displacement of a point in fixed axes, and the rotation of its cross-section.
  function point_motion(grid, body, place, y) result(d)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    real(wp), intent(in) :: place(2)
    real(wp), intent(in) :: y(:, :)
    real(wp) :: d(grid%samples, 3)

    real(wp) :: local(grid%samples, 3)

    local = matmul(functions_of(grid, body, y), transpose(displacement_rows(grid%model%links(body), place)))
    associate (e => grid%direction(:, :, body))
      d(:, 1) = e(:, 1)*local(:, 1) - e(:, 2)*local(:, 2)
      d(:, 2) = e(:, 2)*local(:, 1) + e(:, 1)*local(:, 2)
      d(:, 3) = local(:, 3)
    end associate
  end function point_motion

  !> Axial strain and curvature at places of a link, over the turn.
  subroutine strains_along(grid, body, xi, y, axial, curvature)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    real(wp), intent(in) :: xi(:), y(:, :)
    real(wp), intent(out) :: axial(:, :), curvature(:, :) !! (samples, places) [-, 1/m]

    type(strain_rows_t) :: rows
    real(wp), allocatable :: q(:, :)
    integer :: chord, i, j

    chord = grid%integrals(body)%chord
    q = functions_of(grid, body, y)
    do i = 1, size(xi)
      rows = strain_rows(grid%model%links(body), xi(i))
      axial(:, i) = y(:, grid%elongation(body))*rows%elongation + matmul(q(:, chord + 1:), rows%axial)
      curvature(:, i) = matmul(q(:, [(j, j=3, chord - 2), (j, j=chord + 1, size(q, 2))]), rows%curvature)
    end do
  end subroutine strains_along

  !> Displacements along and across a link at places, over the turn.
  subroutine displacements_along(grid, body, xi, y, displacement)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    real(wp), intent(in) :: xi(:), y(:, :)
    real(wp), intent(out) :: displacement(:, :, :) !! (samples, 2, places) [m]

    real(wp), allocatable :: rows(:, :)
    integer :: i

    do i = 1, size(xi)
      rows = displacement_rows(grid%model%links(body), [xi(i)*grid%model%links(body)%length, 0.0_wp])
      displacement(:, :, i) = matmul(functions_of(grid, body, y), transpose(rows(:2, :)))
    end do
  end subroutine displacements_along

  !> `∫ μ S_aᵀ S_b` over the turn, as sums over points, of the shapes themselves or their derivatives by the crank angle.
  subroutine matrix_of_form(structure, grid, slope, matrix)
    type(structure_t), intent(in) :: structure
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: slope(2)                         !! derivatives of the first and the second shape, 0 or 1
    real(wp), allocatable, intent(out) :: matrix(:, :, :)   !! (samples, unknowns, unknowns)

    type(fourier_plan_t) :: plan
    type(mass_point_t), allocatable :: points(:)
    real(wp) :: y(grid%samples, grid%unknowns), shape(grid%samples, 3, grid%unknowns, 0:1), weight(3)
    integer :: b, i, j, k, p

    allocate (matrix(grid%samples, grid%unknowns, grid%unknowns))
    matrix = 0.0_wp
    call open_fourier(grid%samples, plan)
    do b = 1, size(structure%beams)
      points = mass_points(structure%linkage%bodies(b))
      do p = 1, size(points)
        do i = 1, grid%unknowns
          y = 0.0_wp
          y(:, i) = 1.0_wp
          shape(:, :, i, 0) = point_motion(grid, b, points(p)%place, y)
          call derivatives(plan, shape(:, :, i, 0), shape(:, :, i, 1))
        end do
        weight = [points(p)%mass, points(p)%mass, points(p)%inertia]
        call add
      end do
    end do
    weight(3) = 0.0_wp
    do p = 1, size(grid%pin_mass)
      if (grid%pin_mass(p) <= 0.0_wp) cycle
      shape = 0.0_wp
      do i = 1, grid%border
        shape(:, :2, i, 0) = grid%pin(:, :, p, i)
        call derivatives(plan, shape(:, :, i, 0), shape(:, :, i, 1))
      end do
      weight(:2) = grid%pin_mass(p)
      call add
    end do
    call close_fourier(plan)

  contains

    subroutine add
      do j = 1, grid%unknowns
        do i = 1, grid%unknowns
          do k = 1, 3
            matrix(:, i, j) = matrix(:, i, j) + weight(k)*shape(:, k, i, slope(1))*shape(:, k, j, slope(2))
          end do
        end do
      end do
    end subroutine add

  end subroutine matrix_of_form

end module response_cases
