!> The equation of motion of an elastic linkage that turns at constant speed, applied to a periodic
!! motion: Ulker 2010 (2.77), (2.82), (2.83) and (2.85) with every term, from Lagrange's equation
!! (2.73).
!!
!! `ω² ∫ μ Sᵀ (S y)'' dx + ω C y' + (1 + K_G) y = f`, ' = d/dθ2. The inertia force is that of the
!! displacement d = S y in fixed axes: `∫ μ Sᵀ (S y)'' = M y'' + 2 G y' + (G' − W) y`.
module elastic_equations
  use fourier_transform, only: derivatives, fourier_plan_t
  use kinds, only: wp
  use load_cases, only: constant_case
  use piece_motions, only: add_convection, add_flux, add_moved, add_strain_convection, &
    moved_back, scale_amplitudes, scale_share, scale_slopes
  use strain_dampings, only: damping_t, grown, is_damped
  use turn_grids, only: moves, rate_case, turn_grid_t
  implicit none (type, external)
  private

  public :: elastic_terms_t, inertia_force, inertia_parts, slope_force, swept_force, &
    apply_equation, equation_parts, load_at_speed, functions_of, geometric_force, slopes_of, &
    mass_force, times_mass, times_swap, spread_over_unknowns, unit_geometric_force, elongation_of, &
    add_damping_parts, deformations_of, damper_force, strained_functions, moved_functions, &
    strain_rates

  !> Terms of the equation and of the torque; false: omitted.
  type :: elastic_terms_t
    logical :: coriolis = .true.    !! 2 ω G ẏ
    logical :: centripetal = .true. !! ω² (G' − W) y
    logical :: axial = .true.       !! K_G y
    logical :: quadratic = .true.   !! of the driving torque
  end type elastic_terms_t

contains

  !> Whether the inertia force has all of its terms.
  pure function all_terms(terms) result(all_there)
    type(elastic_terms_t), intent(in) :: terms
    logical :: all_there

    all_there = terms%coriolis .and. terms%centripetal
  end function all_terms

  !> Amplitudes of all functions of a body in a motion: Q = T y; of a piece whose length changes
  !! those of the functions at the length of the tables.
  pure function functions_of(grid, body, y) result(q)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    real(wp), intent(in) :: y(:, :) !! (samples, unknowns)
    real(wp) :: q(size(y, 1), grid%integrals(body)%chord + grid%integrals(body)%own)

    q = own_functions_of(grid, body, y)
    call scale_amplitudes(grid, body, q)
  end function functions_of

  !> Amplitudes for the strains of a body from those at the length of the tables.
  pure function strained_functions(grid, body, y) result(q)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    real(wp), intent(in) :: y(:, :) !! (samples, unknowns)
    real(wp) :: q(size(y, 1), grid%integrals(body)%chord + grid%integrals(body)%own)

    q = own_functions_of(grid, body, y)
    if (moves(grid, body)) q = q/spread(sqrt(grid%ratio(:, body)), 2, size(q, 2))
  end function strained_functions

  !> T y.
  pure function own_functions_of(grid, body, y) result(q)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    real(wp), intent(in) :: y(:, :) !! (samples, unknowns)
    real(wp) :: q(size(y, 1), grid%integrals(body)%chord + grid%integrals(body)%own)

    integer :: i, j, m

    associate (integrals => grid%integrals(body), link => grid%model%links(body))
      q(:, :integrals%chord) = 0.0_wp
      do j = 1, grid%border
        do i = 1, integrals%chord
          q(:, i) = q(:, i) + grid%chord(:, i, j, body)*y(:, j)
        end do
      end do
      m = integrals%chord + link%modes
      q(:, integrals%chord + 1:m) = y(:, grid%first(body):grid%first(body) + link%modes - 1)
      q(:, m + 1:) = y(:, grid%first_along(body):grid%first_along(body) + link%axial_modes - 1)
    end associate
  end function own_functions_of

  !> Adds forces on the functions of a body to those on the unknowns: Tᵀ R.
  pure subroutine spread_over_unknowns(grid, body, forces, total)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    real(wp), intent(in) :: forces(:, :)   !! (samples, functions)
    real(wp), intent(inout) :: total(:, :) !! (samples, unknowns)

    real(wp), allocatable :: scaled(:, :)

    if (moves(grid, body)) then
      scaled = forces
      call scale_amplitudes(grid, body, scaled)
      call spread_own(grid, body, scaled, total)
    else
      call spread_own(grid, body, forces, total)
    end if
  end subroutine spread_over_unknowns

  !> The same of forces on T y.
  pure subroutine spread_own(grid, body, forces, total)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    real(wp), intent(in) :: forces(:, :)
    real(wp), intent(inout) :: total(:, :)

    integer :: i, j, m

    associate (integrals => grid%integrals(body), link => grid%model%links(body))
      do j = 1, grid%border
        do i = 1, integrals%chord
          total(:, j) = total(:, j) + grid%chord(:, i, j, body)*forces(:, i)
        end do
      end do
      m = integrals%chord + link%modes
      associate (across => total(:, grid%first(body):grid%first(body) + link%modes - 1), &
        along => total(:, grid%first_along(body):grid%first_along(body) + link%axial_modes - 1))
        across = across + forces(:, integrals%chord + 1:m)
        along = along + forces(:, m + 1:)
      end associate
    end associate
  end subroutine spread_own

  !> What the functions of a body do at constant unknowns as the linkage turns, in axes that turn
  !! with it: `C' y`, with what moves through a piece whose length changes.
  pure function moved_functions(grid, body, q, y) result(moved)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    real(wp), intent(in) :: q(:, :) !! (samples, functions) of `functions_of`
    real(wp), intent(in) :: y(:, :) !! (samples, unknowns)
    real(wp) :: moved(size(q, 1), size(q, 2))

    integer :: i, j

    moved = 0.0_wp
    do j = 1, grid%border
      do i = 1, grid%integrals(body)%chord
        moved(:, i) = moved(:, i) + grid%chord_slope(:, i, j, body)*y(:, j)
      end do
    end do
    call add_moved(grid, body, q, moved)
  end function moved_functions

  !> `Q J`, antisymmetric: −J on every sample.
  pure function times_swap(grid, body, q) result(product)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    real(wp), intent(in) :: q(:, :) !! (samples, functions)
    real(wp) :: product(size(q, 1), size(q, 2))

    product = matmul(q, grid%integrals(body)%swap)
    call scale_share(grid, body, product)
  end function times_swap

  !> `m Q'' + J (2 h Q' + h' Q) − h² m_t Q` of a body, per ω2². J h is m_vel of Ulker 2010 (2.80),
  !! J h' − h² m_t is m_acc of (2.81).
  pure function inertia_of_body(grid, body, q, first, second) result(force)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    real(wp), intent(in) :: q(:, :), first(:, :), second(:, :) !! (samples, functions) Q, Q', Q''
    real(wp) :: force(size(q, 1), size(q, 2))

    real(wp), allocatable :: swept(:, :)
    integer :: i

    allocate (swept(size(q, 1), size(q, 2)))
    associate (h => grid%rate(:, body), slope => grid%rate_slope(:, body))
      do i = 1, size(q, 2)
        swept(:, i) = second(:, i) - h**2*q(:, i)
      end do
      force = times_mass(grid, body, swept)
      do i = 1, size(q, 2)
        swept(:, i) = 2.0_wp*h*first(:, i) + slope*q(:, i)
      end do
      ! J is antisymmetric.
      force = force - times_swap(grid, body, swept)
      call add_flux(grid, body, q, force)
      if (size(grid%integrals(body)%rotary) > 0) then
        swept = matmul(q, grid%integrals(body)%rotary)
        do i = 1, size(q, 2)
          force(:, i) = force(:, i) + h**2*swept(:, i)
        end do
      end if
    end associate
  end function inertia_of_body

  !> `m Q`: own modes are coupled to the functions of the chord only.
  pure function times_mass(grid, body, q) result(product)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    real(wp), intent(in) :: q(:, :)
    real(wp) :: product(size(q, 1), size(q, 2))

    integer :: i, j, chord

    associate (mass => grid%integrals(body)%mass)
      chord = grid%integrals(body)%chord
      product(:, :chord) = 0.0_wp
      do j = chord + 1, size(q, 2)
        product(:, j) = mass(j, j)*q(:, j)
        do i = 1, chord
          if (abs(mass(i, j)) <= 0.0_wp) cycle
          product(:, i) = product(:, i) + mass(i, j)*q(:, j)
          product(:, j) = product(:, j) + mass(i, j)*q(:, i)
        end do
      end do
      do j = 1, chord
        do i = 1, chord
          product(:, i) = product(:, i) + mass(i, j)*q(:, j)
        end do
      end do
    end associate
    call scale_share(grid, body, product)
  end function times_mass

  !> `∫ μ Sᵀ (S y)'' dx` [√J per rad²/s²], with or without its terms in G and W; on request also y'.
  subroutine inertia_force(grid, plan, terms, y, force, rates)
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan     !! for its samples
    type(elastic_terms_t), intent(in) :: terms
    real(wp), intent(in) :: y(:, :)              !! (samples, unknowns) [√J]
    real(wp), intent(out) :: force(:, :)         !! (samples, unknowns)
    real(wp), intent(out), optional :: rates(:, :) !! (samples, unknowns)

    real(wp), allocatable :: q(:, :), first(:, :), second(:, :)
    integer :: b, i, k, p

    force = 0.0_wp
    if (.not. all_terms(terms)) then
      if (present(rates)) call derivatives(plan, y, rates)
      call chosen_inertia_force(grid, plan, terms, y, force)
      return
    end if
    if (present(rates)) call derivatives(plan, y(:, :grid%border), rates(:, :grid%border))
    do b = 1, size(grid%integrals)
      q = functions_of(grid, b, y)
      allocate (first, mold=q)
      allocate (second, mold=q)
      call derivatives(plan, q, first, second)
      if (present(rates)) call take_rates(grid, plan, b, first, y, rates)
      call add_convection(grid, b, q, first, second)
      call spread_over_unknowns(grid, b, inertia_of_body(grid, b, q, first, second), force)
      deallocate (first, second)
    end do
    allocate (first(size(y, 1), 2), second(size(y, 1), 2))
    do p = 1, size(grid%pin_mass)
      if (grid%pin_mass(p) <= 0.0_wp) cycle
      q = pin_motion(grid, p, y)
      call derivatives(plan, q, first, second)
      do i = 1, grid%border
        do k = 1, 2
          force(:, i) = force(:, i) + grid%pin_mass(p)*grid%pin(:, k, p, i)*second(:, k)
        end do
      end do
    end do
  end subroutine inertia_force

  !> The inertia force of `e^{σ θ} y` over `e^{σ θ}`, in powers of σ: `I0 + σ I1 + σ² I2`, where
  !! `I1 = 2 (M y' + G y)` and `I2 = M y`.
  subroutine inertia_parts(grid, plan, terms, y, parts)
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan   !! for its samples
    type(elastic_terms_t), intent(in) :: terms
    real(wp), intent(in) :: y(:, :)            !! (samples, unknowns) [√J]
    real(wp), intent(out) :: parts(:, :, 0:)   !! (samples, unknowns, power) [√J per rad²/s²]

    real(wp), allocatable :: q(:, :), first(:, :), second(:, :)
    real(wp) :: push(size(y, 1))
    integer :: b, i, k, p

    parts = 0.0_wp
    if (.not. all_terms(terms)) then
      call chosen_inertia_force(grid, plan, terms, y, parts(:, :, 0))
      allocate (first, second, mold=y)
      call derivatives(plan, y, first)
      call mass_force(grid, first, second)
      call slope_force(grid, y, first)
      parts(:, :, 1) = 2.0_wp*second
      if (terms%coriolis) parts(:, :, 1) = parts(:, :, 1) + 2.0_wp*first
      call mass_force(grid, y, parts(:, :, 2))
      return
    end if
    do b = 1, size(grid%integrals)
      q = functions_of(grid, b, y)
      allocate (first, mold=q)
      allocate (second, mold=q)
      call derivatives(plan, q, first, second)
      call add_convection(grid, b, q, first, second)
      call spread_over_unknowns(grid, b, inertia_of_body(grid, b, q, first, second), &
        parts(:, :, 0))
      call spread_over_unknowns(grid, b, times_mass(grid, b, q), parts(:, :, 2))
      second = times_mass(grid, b, first)
      do i = 1, size(q, 2)
        first(:, i) = grid%rate(:, b)*q(:, i)
      end do
      call spread_over_unknowns(grid, b, 2.0_wp*(second - times_swap(grid, b, first)), &
        parts(:, :, 1))
      deallocate (first, second)
    end do
    allocate (first(size(y, 1), 2), second(size(y, 1), 2))
    do p = 1, size(grid%pin_mass)
      if (grid%pin_mass(p) <= 0.0_wp) cycle
      q = pin_motion(grid, p, y)
      call derivatives(plan, q, first, second)
      do i = 1, grid%border
        do k = 1, 2
          push = grid%pin_mass(p)*grid%pin(:, k, p, i)
          parts(:, i, 0) = parts(:, i, 0) + push*second(:, k)
          parts(:, i, 1) = parts(:, i, 1) + 2.0_wp*push*first(:, k)
          parts(:, i, 2) = parts(:, i, 2) + push*q(:, k)
        end do
      end do
    end do
  end subroutine inertia_parts

  !> Rates of the own modes of a body, which are functions of it unless its length changes.
  subroutine take_rates(grid, plan, body, first, y, rates)
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan
    integer, intent(in) :: body
    real(wp), intent(in) :: first(:, :)    !! (samples, functions) Q'
    real(wp), intent(in) :: y(:, :)        !! (samples, unknowns)
    real(wp), intent(inout) :: rates(:, :) !! (samples, unknowns)

    integer :: m

    associate (chord => grid%integrals(body)%chord, link => grid%model%links(body), &
      across => grid%first(body), along => grid%first_along(body))
      if (moves(grid, body)) then
        call derivatives(plan, y(:, across:across + link%modes - 1), rates(:, across:across + &
          link%modes - 1))
        call derivatives(plan, y(:, along:along + link%axial_modes - 1), rates(:, along:along + &
          link%axial_modes - 1))
        return
      end if
      m = chord + link%modes
      rates(:, across:across + link%modes - 1) = first(:, chord + 1:m)
      rates(:, along:along + link%axial_modes - 1) = first(:, m + 1:)
    end associate
  end subroutine take_rates

  !> Displacement of a pin in fixed axes.
  pure function pin_motion(grid, p, y) result(motion)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: p
    real(wp), intent(in) :: y(:, :)
    real(wp) :: motion(size(y, 1), 2)

    integer :: i, k

    motion = 0.0_wp
    do i = 1, grid%border
      do k = 1, 2
        motion(:, k) = motion(:, k) + grid%pin(:, k, p, i)*y(:, i)
      end do
    end do
  end function pin_motion

  !> The inertia force from `M y''`, `2 G y'` and `(G' − W) y`, some of which are omitted.
  subroutine chosen_inertia_force(grid, plan, terms, y, force)
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan
    type(elastic_terms_t), intent(in) :: terms
    real(wp), intent(in) :: y(:, :)
    real(wp), intent(inout) :: force(:, :)

    real(wp), allocatable :: first(:, :), second(:, :), mass(:, :), gyration(:, :)

    allocate (first, second, mass, gyration, mold=y)
    call derivatives(plan, y, first, second)
    call mass_force(grid, second, mass)
    call slope_force(grid, first, gyration)
    if (terms%centripetal) then
      call inertia_force(grid, plan, elastic_terms_t(), y, force)
      if (.not. terms%coriolis) force = force - 2.0_wp*gyration
    else
      force = mass
      if (terms%coriolis) force = force + 2.0_wp*gyration
    end if
  end subroutine chosen_inertia_force

  !> `M y`.
  pure subroutine mass_force(grid, y, force)
    type(turn_grid_t), intent(in) :: grid
    real(wp), intent(in) :: y(:, :)
    real(wp), intent(out) :: force(:, :)

    real(wp) :: motion(size(y, 1), 2)
    integer :: b, i, k, p

    force = 0.0_wp
    do b = 1, size(grid%integrals)
      call spread_over_unknowns(grid, b, times_mass(grid, b, functions_of(grid, b, y)), force)
    end do
    do p = 1, size(grid%pin_mass)
      if (grid%pin_mass(p) <= 0.0_wp) cycle
      motion = pin_motion(grid, p, y)
      do i = 1, grid%border
        do k = 1, 2
          force(:, i) = force(:, i) + grid%pin_mass(p)*grid%pin(:, k, p, i)*motion(:, k)
        end do
      end do
    end do
  end subroutine mass_force

  !> `G y = ∫ μ Sᵀ S' dx y`; ω2 G is M_ω of Ulker 2010 (2.86), ω2² (G' − W) is M_α of (2.87).
  pure subroutine slope_force(grid, y, force)
    type(turn_grid_t), intent(in) :: grid
    real(wp), intent(in) :: y(:, :)      !! (samples, unknowns)
    real(wp), intent(out) :: force(:, :) !! (samples, unknowns)

    real(wp), allocatable :: q(:, :), moved(:, :), turned(:, :)
    real(wp) :: motion(size(y, 1), 2)
    integer :: b, i, j, k, p

    force = 0.0_wp
    do b = 1, size(grid%integrals)
      q = functions_of(grid, b, y)
      moved = moved_functions(grid, b, q, y)
      turned = times_swap(grid, b, q)
      moved = times_mass(grid, b, moved)
      do i = 1, size(q, 2)
        moved(:, i) = moved(:, i) - grid%rate(:, b)*turned(:, i)
      end do
      call spread_over_unknowns(grid, b, moved, force)
    end do
    do p = 1, size(grid%pin_mass)
      if (grid%pin_mass(p) <= 0.0_wp) cycle
      motion = 0.0_wp
      do j = 1, grid%border
        do k = 1, 2
          motion(:, k) = motion(:, k) + grid%pin_slope(:, k, p, j)*y(:, j)
        end do
      end do
      do i = 1, grid%border
        do k = 1, 2
          force(:, i) = force(:, i) + grid%pin_mass(p)*grid%pin(:, k, p, i)*motion(:, k)
        end do
      end do
    end do
  end subroutine slope_force

  !> `W y = ∫ μ S'ᵀS' dx y`: with the chords moved by C' and the axes turned by h,
  !! `S' = C' + h J`, and turned lengthwise masses are those without rotary inertia.
  pure subroutine swept_force(grid, y, force)
    type(turn_grid_t), intent(in) :: grid
    real(wp), intent(in) :: y(:, :)      !! (samples, unknowns)
    real(wp), intent(out) :: force(:, :) !! (samples, unknowns)

    real(wp), allocatable :: q(:, :), moved(:, :), on_moved(:, :), on_turned(:, :), turned(:, :)
    real(wp) :: motion(size(y, 1), 2)
    integer :: b, i, j, k, p

    force = 0.0_wp
    do b = 1, size(grid%integrals)
      associate (integrals => grid%integrals(b), h => grid%rate(:, b))
        q = functions_of(grid, b, y)
        moved = moved_functions(grid, b, q, y)
        ! J is antisymmetric.
        turned = -times_swap(grid, b, q)
        on_moved = times_mass(grid, b, moved)
        do i = 1, size(q, 2)
          on_moved(:, i) = on_moved(:, i) + h*turned(:, i)
        end do
        call spread_moved(grid, b, on_moved, force)
        turned = times_swap(grid, b, moved)
        on_turned = times_mass(grid, b, q)
        if (size(integrals%rotary) > 0) on_turned = on_turned - matmul(q, integrals%rotary)
        do i = 1, size(q, 2)
          on_turned(:, i) = h*turned(:, i) + h**2*on_turned(:, i)
        end do
        call spread_over_unknowns(grid, b, on_turned, force)
      end associate
    end do
    do p = 1, size(grid%pin_mass)
      if (grid%pin_mass(p) <= 0.0_wp) cycle
      motion = 0.0_wp
      do j = 1, grid%border
        do k = 1, 2
          motion(:, k) = motion(:, k) + grid%pin_slope(:, k, p, j)*y(:, j)
        end do
      end do
      do i = 1, grid%border
        do k = 1, 2
          force(:, i) = force(:, i) + grid%pin_mass(p)*grid%pin_slope(:, k, p, i)*motion(:, k)
        end do
      end do
    end do
  end subroutine swept_force

  !> Adds forces on what `moved_functions` gives to those on the unknowns.
  pure subroutine spread_moved(grid, body, forces, total)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    real(wp), intent(in) :: forces(:, :)   !! (samples, functions)
    real(wp), intent(inout) :: total(:, :) !! (samples, unknowns)

    real(wp), allocatable :: scaled(:, :)
    integer :: i, j

    scaled = forces
    if (moves(grid, body)) then
      call spread_over_unknowns(grid, body, moved_back(grid, body, forces), total)
      call scale_amplitudes(grid, body, scaled)
    end if
    do j = 1, grid%border
      do i = 1, grid%integrals(body)%chord
        total(:, j) = total(:, j) + grid%chord_slope(:, i, j, body)*scaled(:, i)
      end do
    end do
  end subroutine spread_moved

  !> Slopes of a body that axial forces act on: rotation of its chord, curves of its held ends, its
  !! own modes.
  pure function slopes_of(grid, body, y) result(slope)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    real(wp), intent(in) :: y(:, :) !! (samples, unknowns)
    real(wp) :: slope(size(y, 1), size(grid%model%links(body)%geometric, 1))

    integer :: c, j

    associate (link => grid%model%links(body), first => grid%first(body))
      slope(:, :1 + link%curves) = 0.0_wp
      do j = 1, grid%border
        slope(:, 1) = slope(:, 1) + grid%turn(:, j, body)*y(:, j)
        do c = 1, link%curves
          slope(:, 1 + c) = slope(:, 1 + c) + grid%chord(:, 2 + c, j, body)*y(:, j)
        end do
      end do
      slope(:, 2 + link%curves:) = y(:, first:first + link%modes - 1)
    end associate
    call scale_slopes(grid, body, slope)
  end function slopes_of

  !> Adds `K_G y` of given axial forces: Ulker 2010 (2.69), (2.84).
  pure subroutine geometric_force(grid, force_of, y, force)
    type(turn_grid_t), intent(in) :: grid
    real(wp), intent(in) :: force_of(:, :, :) !! (samples, force functions, bodies) [N]
    real(wp), intent(in) :: y(:, :)           !! (samples, unknowns)
    real(wp), intent(inout) :: force(:, :)    !! (samples, unknowns)

    real(wp), allocatable :: slope(:, :), pulled(:, :), stacked(:, :), total(:, :)
    integer :: b, c, i, j, n

    do b = 1, size(grid%integrals)
      if (.not. any(abs(force_of(:, :, b)) > 0.0_wp)) cycle
      associate (link => grid%model%links(b), first => grid%first(b))
        slope = slopes_of(grid, b, y)
        n = size(slope, 2)
        ! One product of large matrices takes less time than several of small ones.
        allocate (pulled(size(y, 1), n*size(link%geometric, 3)), &
          stacked(n*size(link%geometric, 3), n))
        do j = 1, size(link%geometric, 3)
          stacked((j - 1)*n + 1:j*n, :) = link%geometric(:, :, j)
          do i = 1, n
            pulled(:, (j - 1)*n + i) = force_of(:, j, b)*slope(:, i)
          end do
        end do
        total = matmul(pulled, stacked)
        call scale_share(grid, b, total)
        call scale_slopes(grid, b, total)
        do j = 1, grid%border
          force(:, j) = force(:, j) + grid%turn(:, j, b)*total(:, 1)
          do c = 1, link%curves
            force(:, j) = force(:, j) + grid%chord(:, 2 + c, j, b)*total(:, 1 + c)
          end do
        end do
        force(:, first:first + link%modes - 1) = force(:, first:first + link%modes - 1) + &
          total(:, 2 + link%curves:)
        deallocate (slope, pulled, stacked, total)
      end associate
    end do
  end subroutine geometric_force

  !> Adds `ω C y'`; between border unknowns C is that of the deformations w of parts and of dampers,
  !! with `(Q y)'`.
  subroutine add_damping(grid, plan, speed, damping, y, rates, force)
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan
    real(wp), intent(in) :: speed
    type(damping_t), intent(in) :: damping
    real(wp), intent(in) :: y(:, :), rates(:, :) !! (samples, unknowns) y, y'
    real(wp), intent(inout) :: force(:, :)

    real(wp), allocatable :: w(:, :), slope(:, :), own_rates(:, :)

    if (.not. allocated(grid%weighted) .and. .not. allocated(grid%pieces)) then
      call add_own_damping(grid, speed, damping, rates, force)
      return
    end if
    call strain_rates(grid, plan, y, rates, w, slope, own_rates)
    if (.not. allocated(grid%weighted)) own_rates(:, :grid%border) = slope
    call add_own_damping(grid, speed, damping, own_rates, force)
    if (allocated(grid%weighted)) call add_to_border(grid, speed, damping, slope, force)
  end subroutine add_damping

  !> Strains of parts in a motion, in the unknowns, and their rates in the material.
  subroutine strain_rates(grid, plan, y, first, w, w_rates, rates)
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan           !! for its samples
    real(wp), intent(in) :: y(:, :)                    !! (samples, unknowns) [√J]
    real(wp), intent(in) :: first(:, :)                !! (samples, unknowns) y'
    real(wp), allocatable, intent(out) :: w(:, :)      !! (samples, deformations) of ends of parts
    real(wp), allocatable, intent(out) :: w_rates(:, :) !! (samples, deformations)
    real(wp), allocatable, intent(out) :: rates(:, :)  !! (samples, unknowns), of own modes

    w = deformations_of(grid, y)
    allocate (w_rates, mold=w)
    call derivatives(plan, w, w_rates)
    rates = first
    if (allocated(grid%pieces)) call add_strain_convection(grid, w, y, w_rates, rates)
  end subroutine strain_rates

  !> The same of unknowns with a damping of their own.
  pure subroutine add_own_damping(grid, speed, damping, rates, force)
    type(turn_grid_t), intent(in) :: grid
    real(wp), intent(in) :: speed
    type(damping_t), intent(in) :: damping
    real(wp), intent(in) :: rates(:, :)
    real(wp), intent(inout) :: force(:, :)

    integer :: i

    do i = merge(grid%border + 1, 1, allocated(grid%weighted)), size(rates, 2)
      force(:, i) = force(:, i) + speed*damping%c(i)*grown(grid, damping, i, rates(:, i))
    end do
  end subroutine add_own_damping

  !> Adds `ω Qᵀ C w`.
  pure subroutine add_to_border(grid, speed, damping, w, force)
    type(turn_grid_t), intent(in) :: grid
    real(wp), intent(in) :: speed
    type(damping_t), intent(in) :: damping
    real(wp), intent(in) :: w(:, :)        !! (samples, deformations)
    real(wp), intent(inout) :: force(:, :)

    real(wp) :: rate(size(w, 1))
    integer :: i, j

    do i = 1, size(w, 2)
      rate = grown(grid, damping, grid%unknowns + i, w(:, i))
      do j = 1, grid%border
        force(:, j) = force(:, j) + speed*damping%c(grid%unknowns + i)*grid%weighted(:, i, j)*rate
      end do
    end do
  end subroutine add_to_border

  !> Deformations of the ends of parts, of springs and dampers in a motion: w = Q y, or the border
  !! unknowns themselves.
  pure function deformations_of(grid, y) result(w)
    type(turn_grid_t), intent(in) :: grid
    real(wp), intent(in) :: y(:, :)       !! (samples, unknowns) [√J]
    real(wp), allocatable :: w(:, :)      !! (samples, deformations)

    integer :: j

    if (.not. allocated(grid%weighted)) then
      w = y(:, :grid%border)
      return
    end if
    allocate (w(size(y, 1), size(grid%weighted, 2)), source=0.0_wp)
    do j = 1, grid%border
      w = w + grid%weighted(:, :, j)*spread(y(:, j), 2, size(w, 2))
    end do
  end function deformations_of

  !> The elongation of a link that bends, in units of that of a unit unknown; of a piece whose
  !! length changes as for the strains at the length of the tables.
  pure function elongation_of(grid, body, y) result(elongation)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    real(wp), intent(in) :: y(:, :)       !! (samples, unknowns) [√J]
    real(wp) :: elongation(size(y, 1))

    if (allocated(grid%weighted)) then
      elongation = sum(grid%weighted(:, grid%elongation(body), :)*y(:, :grid%border), dim=2)
    else
      elongation = y(:, grid%elongation(body))
    end if
    if (moves(grid, body)) elongation = elongation/sqrt(grid%ratio(:, body))
  end function elongation_of

  !> Adds `K_G y` at a constant speed.
  pure subroutine geometric_force_at(grid, speed, y, force)
    type(turn_grid_t), intent(in) :: grid
    real(wp), intent(in) :: speed          !! ω2 [rad/s]
    real(wp), intent(in) :: y(:, :)        !! (samples, unknowns)
    real(wp), intent(inout) :: force(:, :) !! (samples, unknowns)

    real(wp) :: axial(size(grid%force, 1), size(grid%force, 2), size(grid%force, 3))

    axial = speed**2*grid%force(:, :, :, 1) + grid%force(:, :, :, constant_case)
    if (grid%cases >= rate_case) axial = axial + speed*grid%force(:, :, :, rate_case)
    call geometric_force(grid, axial, y, force)
    call add_second_order(grid, 1, speed**2, y, force)
    call add_second_order(grid, constant_case, 1.0_wp, y, force)
    if (grid%cases >= rate_case) call add_second_order(grid, rate_case, speed, y, force)
  end subroutine geometric_force_at

  !> Adds `K_G y` of a unit load.
  pure subroutine unit_geometric_force(grid, case, y, force)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: case            !! its number
    real(wp), intent(in) :: y(:, :)        !! (samples, unknowns)
    real(wp), intent(inout) :: force(:, :) !! (samples, unknowns)

    call geometric_force(grid, grid%force(:, :, :, case), y, force)
    call add_second_order(grid, case, 1.0_wp, y, force)
  end subroutine unit_geometric_force

  !> `H y` of a damper: K_G of its unit pull.
  pure subroutine damper_force(grid, number, y, force)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: number          !! of the damper
    real(wp), intent(in) :: y(:, :)        !! (samples, unknowns)
    real(wp), intent(out) :: force(:, :)   !! (samples, unknowns)

    real(wp) :: axial(size(grid%force, 1), size(grid%force, 2), size(grid%force, 3))
    integer :: j

    axial = 0.0_wp
    axial(:, 1, :) = grid%dampers(number)%force
    force = 0.0_wp
    call geometric_force(grid, axial, y, force)
    do j = 1, grid%border
      force(:, :grid%border) = force(:, :grid%border) + &
        grid%dampers(number)%second_order(:, :, j)*spread(y(:, j), 2, grid%border)
    end do
  end subroutine damper_force

  !> Adds what K_G of a unit load, times a factor, has between border unknowns alone.
  pure subroutine add_second_order(grid, case, factor, y, force)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: case
    real(wp), intent(in) :: factor
    real(wp), intent(in) :: y(:, :)
    real(wp), intent(inout) :: force(:, :)

    integer :: i, j

    if (.not. allocated(grid%second_order)) return
    do j = 1, grid%border
      do i = 1, grid%border
        force(:, i) = force(:, i) + factor*grid%second_order(:, i, j, case)*y(:, j)
      end do
    end do
  end subroutine add_second_order

  !> The left side of the equation: that of Ulker 2010 (2.85) in deformation coordinates.
  subroutine apply_equation(grid, plan, speed, damping, terms, y, force)
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan   !! for its samples
    real(wp), intent(in) :: speed              !! ω2 [rad/s]
    type(damping_t), intent(in) :: damping     !! see `damping_of`
    type(elastic_terms_t), intent(in) :: terms
    real(wp), intent(in) :: y(:, :)            !! (samples, unknowns) [√J]
    real(wp), intent(out) :: force(:, :)       !! (samples, unknowns) [√J]

    real(wp), allocatable :: first(:, :)

    if (is_damped(damping)) then
      allocate (first, mold=y)
      call inertia_force(grid, plan, terms, y, force, first)
    else
      call inertia_force(grid, plan, terms, y, force)
    end if
    force = speed**2*force + y
    if (allocated(first)) call add_damping(grid, plan, speed, damping, y, first, force)
    if (terms%axial) call geometric_force_at(grid, speed, y, force)
  end subroutine apply_equation

  !> The left side of the equation for `e^{σ θ} y` over `e^{σ θ}`, in powers of σ:
  !! `L0 y + σ L1 y + σ² L2 y`; L0 y is that of `apply_equation`.
  subroutine equation_parts(grid, plan, speed, damping, terms, y, parts)
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan   !! for its samples
    real(wp), intent(in) :: speed              !! ω2 [rad/s]
    type(damping_t), intent(in) :: damping     !! see `damping_of`
    type(elastic_terms_t), intent(in) :: terms
    real(wp), intent(in) :: y(:, :)            !! (samples, unknowns) [√J]
    real(wp), intent(out) :: parts(:, :, 0:)   !! (samples, unknowns, power) [√J]

    call inertia_parts(grid, plan, terms, y, parts)
    parts = speed**2*parts
    parts(:, :, 0) = parts(:, :, 0) + y
    if (is_damped(damping)) call add_damping_parts(grid, plan, speed, damping, y, parts(:, :, :1))
    if (terms%axial) call geometric_force_at(grid, speed, y, parts(:, :, 0))
  end subroutine equation_parts

  !> Adds what damping has in them: `ω C y'` and `ω C y`.
  subroutine add_damping_parts(grid, plan, speed, damping, y, parts)
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan     !! for its samples
    real(wp), intent(in) :: speed                !! ω2 [rad/s]
    type(damping_t), intent(in) :: damping       !! see `damping_of`
    real(wp), intent(in) :: y(:, :)              !! (samples, unknowns) [√J]
    real(wp), intent(inout) :: parts(:, :, 0:)   !! (samples, unknowns, power 0 and 1) [√J]

    real(wp) :: first(size(y, 1), size(y, 2))

    call derivatives(plan, y, first)
    call add_damping(grid, plan, speed, damping, y, first, parts(:, :, 0))
    call add_own_damping(grid, speed, damping, y, parts(:, :, 1))
    if (allocated(grid%weighted)) call add_to_border(grid, speed, damping, deformations_of(grid, &
      y), parts(:, :, 1))
  end subroutine add_damping_parts

  !> The right side of the equation [√J].
  pure function load_at_speed(grid, speed) result(load)
    type(turn_grid_t), intent(in) :: grid
    real(wp), intent(in) :: speed !! ω2 [rad/s]
    real(wp) :: load(grid%samples, grid%unknowns)

    load = speed**2*grid%load(:, :, 1) + grid%load(:, :, constant_case)
    if (grid%cases >= rate_case) load = load + speed*grid%load(:, :, rate_case)
  end function load_at_speed

end module elastic_equations
