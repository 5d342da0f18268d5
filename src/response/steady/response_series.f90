!> Quantities of a periodic elastic motion over the turn: displacements of points, strains, and the
!! driving torque.
module response_series
  use elastic_equations, only: damper_force, deformations_of, elastic_terms_t, elongation_of, &
    functions_of, moved_functions, strain_rates, strained_functions, times_mass, times_swap, &
    unit_geometric_force
  use fourier_transform, only: coefficients_of, derivatives, fourier_plan_t, value_at
  use kinds, only: wp
  use link_rows, only: displacement_rows, strain_rows, strain_rows_t, sums_of_rows
  use load_cases, only: case_count, constant_case
  use piece_motions, only: add_convection, work_of_flux
  use passing_places, only: gauge_at_place, place_terms, point_at_place
  use response_levels, only: damping_of
  use response_types, only: response_request_t
  use row_products, only: products_of_rows
  use strain_dampings, only: damping_t, shares_of
  use turn_grids, only: moves, sense_of, turn_grid_t
  implicit none (type, external)
  private

  public :: response_series_of, series_count, first_of_point, first_of_gauge, first_of_torque, &
    point_series, place_series, strains_along, gauge_series, find_values_on_pieces

  !> Series of a point, a gauge (axial strain, curvature, shear force) and of the torque (rigid,
  !! linear, quadratic).
  integer, parameter :: of_point = 3, of_gauge = 3, of_torque = 3

contains

  !> Number of series of a request.
  pure function series_count(request) result(number)
    type(response_request_t), intent(in) :: request
    integer :: number

    number = first_of_torque(request) + of_torque - 1
  end function series_count

  !> Number of the first series of a point.
  elemental function first_of_point(point) result(number)
    integer, intent(in) :: point !! its number
    integer :: number

    number = of_point*(point - 1) + 1
  end function first_of_point

  !> Number of the first series of a gauge; points come before.
  pure function first_of_gauge(request, gauge) result(number)
    type(response_request_t), intent(in) :: request
    integer, intent(in) :: gauge !! its number
    integer :: number

    number = first_of_point(size(request%points) + 1) + of_gauge*(gauge - 1)
  end function first_of_gauge

  !> Number of the first series of the torque.
  pure function first_of_torque(request) result(number)
    type(response_request_t), intent(in) :: request
    integer :: number

    number = first_of_gauge(request, size(request%gauges) + 1)
  end function first_of_torque

  !> All series: x, y and rotation of every point; axial strain, curvature and shear force at every
  !! gauge; the driving torque of the rigid linkage, and its linear and quadratic parts.
  subroutine response_series_of(grid, plan, request, speed, y, series)
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan
    type(response_request_t), intent(in) :: request
    real(wp), intent(in) :: speed         !! ω2 [rad/s]
    real(wp), intent(in) :: y(:, :)       !! (samples, unknowns) [√J]
    real(wp), intent(out) :: series(:, :) !! (samples, series) [m, rad; -, 1/m, N; N m]

    integer :: i, first

    do i = 1, size(request%points)
      first = first_of_point(i)
      associate (point => request%points(i))
        series(:, first:first + 2) = point_series(grid, point%body, point%place, y)
      end associate
    end do
    do i = 1, size(request%gauges)
      first = first_of_gauge(request, i)
      call add_gauge(grid, plan, request%gauges(i)%body, request%gauges(i)%xi, speed, y, &
        series(:, first:first + 2))
    end do
    first = first_of_torque(request)
    call torque_series(grid, plan, request%terms, speed, y, series(:, first:first + 2))
    if (.not. allocated(grid%weighted) .and. .not. allocated(grid%pieces)) return
    associate (torque => series(:, first:first + 2))
      torque = torque + sense_of(grid)*speed*damping_torque(grid, plan, &
        damping_of(request%damping, grid), request%terms, y)
    end associate
  end subroutine response_series_of

  !> Torque of the damping per ω, in the parts of the torque, from Rayleigh's function `½ ẇᵀC ẇ`: of
  !! the deformations `w = Q y` of parts, which change at constant y, `(Q' y)·C (Q y)'`, and of
  !! strains, which move through pieces with their material; of a damper of the length
  !! `l + w + ½ yᵀH y` in all `c (l + w + ½ yᵀH y)˙ ∂(l + w + ½ yᵀH y)/∂θ`.
  function damping_torque(grid, plan, damping, terms, y) result(torque)
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan
    type(damping_t), intent(in) :: damping !! of `damping_of`
    type(elastic_terms_t), intent(in) :: terms
    real(wp), intent(in) :: y(:, :)
    real(wp) :: torque(size(y, 1), 3)

    real(wp) :: first(size(y, 1), size(y, 2)), force(size(y, 1), size(y, 2)), &
      energy(size(y, 1), 1), energy_slope(size(y, 1), 1)
    real(wp), allocatable :: w(:, :), slope(:, :), moved(:, :), rates(:, :)
    integer :: i, k

    torque = 0.0_wp
    call derivatives(plan, y, first)
    call strain_rates(grid, plan, y, first, w, slope, rates)
    moved = slope - deformations_of(grid, first)
    k = merge(grid%unknowns, 0, allocated(grid%weighted))
    if (terms%quadratic) torque(:, 3) = matmul(shares_of(grid, damping, k + 1, k + size(w, 2))* &
      moved*slope, damping%c(k + 1:k + size(w, 2)))
    if (terms%quadratic .and. allocated(grid%pieces)) then
      associate (own => grid%border + 1, last => grid%unknowns)
        torque(:, 3) = torque(:, 3) + matmul(shares_of(grid, damping, own, last)* &
          (rates(:, own:) - first(:, own:))*rates(:, own:), damping%c(own:last))
      end associate
    end if
    k = size(w, 2) - size(grid%dampers)
    do i = 1, size(grid%dampers)
      associate (damper => grid%dampers(i), c => damping%c(grid%unknowns + k + i))
        torque(:, 1) = torque(:, 1) + c*damper%rate**2
        torque(:, 2) = torque(:, 2) + c*damper%rate*(moved(:, k + i) + slope(:, k + i))
        if (.not. terms%quadratic .or. .not. terms%axial) cycle
        call damper_force(grid, i, y, force)
        energy(:, 1) = products_of_rows(y, force)
        call derivatives(plan, energy, energy_slope)
        torque(:, 3) = torque(:, 3) + c*damper%rate*(energy_slope(:, 1) - products_of_rows(first, &
          force))
      end associate
    end do
  end function damping_torque

  !> Displacement of a point in global axes and the rotation of its cross-section. On a link along
  !! which blocks slide it is on one piece or on another.
  pure function point_series(grid, body, place, y) result(series)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body      !! number; of a way with blocks its first piece
    real(wp), intent(in) :: place(2) !! from its first end, in its axes [m]
    real(wp), intent(in) :: y(:, :)  !! (samples, unknowns) [√J]
    real(wp) :: series(size(y, 1), 3)

    real(wp), allocatable :: terms(:, :)
    integer :: k

    if (.not. moves(grid, body)) then
      series = place_series(grid, body, place, y)
      return
    end if
    terms = place_terms(grid, body, y)
    do k = 1, size(y, 1)
      series(k, :) = point_at_place(grid, body, place, terms(k, :))
    end do
  end function point_series

  !> The same of a place that keeps its share of the length of a body.
  pure function place_series(grid, body, place, y) result(series)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    real(wp), intent(in) :: place(2) !! at the length of the tables [m]
    real(wp), intent(in) :: y(:, :)
    real(wp) :: series(size(y, 1), 3)

    real(wp) :: local(size(y, 1), 3)

    local = matmul(functions_of(grid, body, y), transpose(displacement_rows( &
      grid%model%links(body), place)))
    if (moves(grid, body)) local(:, 3) = local(:, 3)/grid%ratio(:, body)
    associate (e => grid%direction(:, :, body))
      series(:, 1) = e(:, 1)*local(:, 1) - e(:, 2)*local(:, 2)
      series(:, 2) = e(:, 2)*local(:, 1) + e(:, 1)*local(:, 2)
      series(:, 3) = local(:, 3)
    end associate
  end function place_series

  !> Axial strain, curvature and shear force at a place of a link. On one along which blocks slide
  !! it is on one piece or on another.
  subroutine add_gauge(grid, plan, body, xi, speed, y, series)
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan
    integer, intent(in) :: body
    real(wp), intent(in) :: xi, speed
    real(wp), intent(in) :: y(:, :)
    real(wp), intent(out) :: series(:, :)

    type(strain_rows_t) :: rows
    real(wp), dimension(size(y, 1), 1) :: rotation, first, second
    real(wp) :: q(size(y, 1), grid%integrals(body)%chord + grid%integrals(body)%own)
    integer :: chord

    if (moves(grid, body)) then
      series = gauge_series(grid, body, xi, y)
      return
    end if
    rows = strain_rows(grid%model%links(body), xi)
    chord = grid%integrals(body)%chord
    q = functions_of(grid, body, y)
    series(:, 1) = elongation_of(grid, body, y)*rows%elongation + matmul(q(:, chord + 1:), &
      rows%axial)
    series(:, 2) = sums_of_rows(q, chord, rows%curvature)
    series(:, 3) = sums_of_rows(q, chord, rows%shear)
    ! Without shear strains the rotary inertia of the cross-sections takes part in the balance of
    ! moments.
    if (grid%model%links(body)%bending_shapes%shear_stiffness > 0.0_wp .or. &
      grid%rotary_inertia(body) <= 0.0_wp) return
    rotation(:, 1) = sums_of_rows(q, chord, rows%rotation) + (q(:, 2) - q(:, &
      1))/grid%model%links(body)%length
    call derivatives(plan, rotation, first, second)
    series(:, 3) = series(:, 3) + grid%rotary_inertia(body)*speed**2*(second(:, 1) + &
      grid%rate_slope(:, body))
  end subroutine add_gauge

  !> Axial strain, curvature and shear force at a place of a link along which a block slides.
  pure function gauge_series(grid, body, share, y) result(series)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body     !! the first piece
    real(wp), intent(in) :: share   !! of the way
    real(wp), intent(in) :: y(:, :) !! (samples, unknowns)
    real(wp) :: series(size(y, 1), 3)

    real(wp), allocatable :: terms(:, :)
    integer :: k

    terms = place_terms(grid, body, y)
    do k = 1, size(y, 1)
      series(k, :) = gauge_at_place(grid, body, share, terms(k, :))
    end do
  end function gauge_series

  !> Quantities at places that a block passes, at any angles. They have kinks there: not they are
  !! interpolated over the turn, but what they are made of.
  subroutine find_values_on_pieces(grid, plan, request, y, angle, values)
    type(turn_grid_t), intent(in) :: grid        !! with pieces
    type(fourier_plan_t), intent(in) :: plan     !! for its samples
    type(response_request_t), intent(in) :: request
    real(wp), intent(in) :: y(:, :)              !! (samples, unknowns) [√J]
    real(wp), intent(in) :: angle(:)             !! from the first sample on [rad]
    real(wp), intent(inout) :: values(:, :)      !! (angles, series) of such places

    real(wp), allocatable :: coefficients(:, :)
    integer :: at, i, k

    do i = 1, size(request%points)
      if (.not. moves(grid, request%points(i)%body)) cycle
      at = first_of_point(i)
      associate (point => request%points(i))
        call find_coefficients(point%body)
        do k = 1, size(angle)
          values(k, at:at + 2) = point_at_place(grid, point%body, point%place, &
            value_at(coefficients, angle(k)))
        end do
      end associate
    end do
    do i = 1, size(request%gauges)
      if (.not. moves(grid, request%gauges(i)%body)) cycle
      at = first_of_gauge(request, i)
      associate (gauge => request%gauges(i))
        call find_coefficients(gauge%body)
        do k = 1, size(angle)
          values(k, at:at + 2) = gauge_at_place(grid, gauge%body, gauge%xi, &
            value_at(coefficients, angle(k)))
        end do
      end associate
    end do

  contains

    !> Of what quantities of a link are made.
    subroutine find_coefficients(body)
      integer, intent(in) :: body

      real(wp), allocatable :: terms(:, :)

      terms = place_terms(grid, body, y)
      if (allocated(coefficients)) deallocate (coefficients)
      allocate (coefficients, mold=terms)
      call coefficients_of(plan, terms, coefficients)
    end subroutine find_coefficients

  end subroutine find_values_on_pieces

  !> Axial strain and curvature at many places of a link, which keep their shares of its length.
  pure subroutine strains_along(grid, body, xi, y, axial, curvature)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: body
    real(wp), intent(in) :: xi(:)              !! (places)
    real(wp), intent(in) :: y(:, :)            !! (samples, unknowns)
    real(wp), intent(out) :: axial(:, :)       !! (samples, places)
    real(wp), intent(out) :: curvature(:, :)   !! (samples, places) [1/m]

    type(strain_rows_t) :: rows
    real(wp) :: q(size(y, 1), grid%integrals(body)%chord + grid%integrals(body)%own)
    integer :: chord, i

    chord = grid%integrals(body)%chord
    q = strained_functions(grid, body, y)
    do i = 1, size(xi)
      rows = strain_rows(grid%model%links(body), xi(i))
      axial(:, i) = elongation_of(grid, body, y)*rows%elongation + matmul(q(:, chord + 1:), &
        rows%axial)
      curvature(:, i) = sums_of_rows(q, chord, rows%curvature)
    end do
  end subroutine strains_along

  !> Driving torque of the rigid linkage, its part linear in the deformations and its quadratic
  !! part: `−∂L/∂θ + d/dt ∂L/∂ω − d²/dt² ∂L/∂α`, with the Lagrangian L of Ulker 2010 (2.70).
  !!
  !! With L linear in y, `L = (ω² f_ω + α f_α + f_c)·y`, the linear part is `ω² (2 (f_ω·y)' − f_ω'·y
  !! − (f_α·y)'') − f_c'·y`. With `D = S y` and `K_G = ω² K_ω + α K_α + K_c` the quadratic one is
  !! `ω² (∫ μ (S' y)·D'' dx − ½ (yᵀK_ω y)' − y'ᵀK_ω y + ½ (yᵀK_α y)'') + ½ (yᵀK_c y)' − y'ᵀK_c y`.
  subroutine torque_series(grid, plan, terms, speed, y, series)
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan
    type(elastic_terms_t), intent(in) :: terms
    real(wp), intent(in) :: speed
    real(wp), intent(in) :: y(:, :)
    real(wp), intent(out) :: series(:, :) !! (samples, 3) [N m]

    series(:, 1) = speed**2*grid%torque(:, 1) + grid%torque(:, constant_case)
    call elastic_torque(grid, plan, terms, speed, y, series(:, 2:3))
    ! Derivatives for −θ2 give a torque that is positive clockwise.
    if (grid%backwards) series(:, 2:3) = -series(:, 2:3)
  end subroutine torque_series

  !> The linear and the quadratic part.
  subroutine elastic_torque(grid, plan, terms, speed, y, series)
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan
    type(elastic_terms_t), intent(in) :: terms
    real(wp), intent(in) :: speed
    real(wp), intent(in) :: y(:, :)
    real(wp), intent(out) :: series(:, :)

    real(wp), dimension(size(y, 1), case_count) :: work, slope, second, energy, rate_work
    real(wp) :: first(size(y, 1), size(y, 2)), force(size(y, 1), size(y, 2)), load_slope(size(y, &
      1), size(y, 2))
    integer :: c

    do c = 1, case_count
      work(:, c) = products_of_rows(grid%load(:, :, c), y)
    end do
    call derivatives(plan, work, slope, second)
    call derivatives(plan, speed**2*grid%load(:, :, 1) + grid%load(:, :, constant_case), &
      load_slope)
    series(:, 1) = speed**2*(2.0_wp*slope(:, 1) - second(:, 2)) - products_of_rows(load_slope, y)
    series(:, 2) = 0.0_wp
    if (.not. terms%quadratic) return
    call derivatives(plan, y, first)
    call swept_work(grid, plan, y, series(:, 2))
    series(:, 2) = speed**2*series(:, 2)
    if (.not. terms%axial) return
    do c = 1, case_count
      force = 0.0_wp
      call unit_geometric_force(grid, c, y, force)
      energy(:, c) = products_of_rows(y, force)
      rate_work(:, c) = products_of_rows(first, force)
    end do
    call derivatives(plan, energy, slope, second)
    series(:, 2) = series(:, 2) + speed**2*(-0.5_wp*slope(:, 1) - rate_work(:, 1) + &
      0.5_wp*second(:, 2)) + 0.5_wp*slope(:, constant_case) - rate_work(:, constant_case)
  end subroutine elastic_torque

  !> `∫ μ (S' y)·(S y)'' dx` with S' the change of the shapes at constant y.
  subroutine swept_work(grid, plan, y, work)
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan
    real(wp), intent(in) :: y(:, :)
    real(wp), intent(out) :: work(:)

    real(wp), allocatable :: q(:, :), first(:, :), second(:, :), moved(:, :), &
      turned(:, :), swept(:, :), pin(:, :), pin_first(:, :), pin_second(:, :)
    integer :: b, i, j, k, p

    work = 0.0_wp
    do b = 1, size(grid%integrals)
      associate (integrals => grid%integrals(b), h => grid%rate(:, b), slope => &
        grid%rate_slope(:, b))
        q = functions_of(grid, b, y)
        allocate (first, second, swept, mold=q)
        call derivatives(plan, q, first, second)
        call add_convection(grid, b, q, first, second)
        moved = moved_functions(grid, b, q, y)
        ! moved·(m Q'' + J (2hQ' + h'Q) − h² m_t Q) + h (−Qᵀ J Q'' + Qᵀ m_t (2hQ' + h'Q))
        turned = times_mass(grid, b, second)
        work = work + products_of_rows(moved, turned)
        turned = -times_swap(grid, b, second)
        work = work - h*products_of_rows(q, turned)
        do i = 1, size(q, 2)
          swept(:, i) = 2.0_wp*h*first(:, i) + slope*q(:, i)
        end do
        turned = -times_swap(grid, b, swept)
        work = work + products_of_rows(moved, turned)
        turned = times_mass(grid, b, swept)
        if (size(integrals%rotary) > 0) turned = turned - matmul(swept, integrals%rotary)
        work = work + h*products_of_rows(q, turned)
        turned = times_mass(grid, b, q)
        if (size(integrals%rotary) > 0) turned = turned - matmul(q, integrals%rotary)
        work = work - h**2*products_of_rows(moved, turned)
        work = work + work_of_flux(grid, b, q, moved)
        deallocate (first, second, swept)
      end associate
    end do
    if (allocated(moved)) deallocate (moved)
    allocate (pin(size(y, 1), 2), pin_first(size(y, 1), 2), pin_second(size(y, 1), 2), &
      moved(size(y, 1), 2))
    do p = 1, size(grid%pin_mass)
      if (grid%pin_mass(p) <= 0.0_wp) cycle
      pin = 0.0_wp
      moved = 0.0_wp
      do j = 1, grid%border
        do k = 1, 2
          pin(:, k) = pin(:, k) + grid%pin(:, k, p, j)*y(:, j)
          moved(:, k) = moved(:, k) + grid%pin_slope(:, k, p, j)*y(:, j)
        end do
      end do
      call derivatives(plan, pin, pin_first, pin_second)
      work = work + grid%pin_mass(p)*products_of_rows(moved, pin_second)
    end do
  end subroutine swept_work

end module response_series
