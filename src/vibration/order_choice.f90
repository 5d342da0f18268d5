!> Choice of the polynomial orders that reach a given accuracy, link by link.
module order_choice
  use axial_forces, only: distributed_unit_forces, total_force
  use beam_mesh, only: beam_t
  use body_lumps, only: pieces_of
  use bordered_eigensolver, only: bordered_modes_t
  use deformation_model, only: deformation_model_t, new_deformation_model
  use errors, only: clear_outcome, error_t, outcome_t
  use kinds, only: wp
  use ledger, only: ledger_t
  use link_store, only: link_store_t
  use linkages, only: body_t, linkage_t
  use load_cases, only: find_unit_loads, unit_loads_t
  use order_errors, only: order_error
  use position_equations, only: assemble_equations
  use positions, only: positions_t
  use speed_solver, only: new_speed_work, solve_speeds, speed_work_t
  use structures, only: structure_t
  implicit none (type, external)
  private

  public :: choose_orders, order_demand_t

  !> Requirements on the orders.
  type :: order_demand_t
    integer, allocatable :: states(:)     !! numbers of the positions where the orders are used
    real(wp), allocatable :: factor(:, :) !! (cases, speeds) of the unit loads: ω2², α2, 1
    integer :: modes = 0                  !! number, lowest first
    real(wp) :: bound = 0.0_wp            !! on the relative error of their eigenvalues
  end type order_demand_t

  !> Highest order of a link without masses along it: this number, 56, plus two thirds of the number
  !! of modes (where all three links bend). That exceeds what any accuracy within the precision
  !! needs, except under loads that buckle a link many times over, as beside a dead point.
  integer, parameter :: spare_orders = digits(1.0_wp) + 3

  !> The elements between masses along a link share its highest order. Each element beyond the first
  !! adds this many orders, which are needed for the last digits.
  integer, parameter :: more_orders = 16

  integer, parameter :: least_order = 4

  !> Orders are tried at one in `positions_a_sample` positions, within these limits. Afterwards the
  !! error is estimated at every row of the sweep.
  integer, parameter :: positions_a_sample = 9, least_samples = 2, most_samples = 6

  !> Share of the accuracy that one link may use at the samples: other positions may be worse.
  real(wp), parameter :: share = 0.1_wp

contains

  !> Finds a model of continuous links that keeps the estimated error of every eigenvalue below a
  !! bound, at sampled positions and at the lowest and the highest speed. Each link has one element,
  !! or one between masses along it. That is enough for any accuracy, since links are uniform and
  !! loads smooth between masses.
  !!
  !! The error of order p is about `((kL/4)^{p−1}/(p−1)!)²` for the wave number k and the length L
  !! of the element. This gives a first guess; where the model's own error estimate is above the
  !! bound, the order is raised.
  !!
  !! Errors: those of `new_deformation_model`. A bound that is not reached at the highest order is
  !! no error.
  subroutine choose_orders(structure, positions, demand, store, model, counts, error)
    type(structure_t), intent(in) :: structure       !! with beams
    type(positions_t), intent(in) :: positions       !! of the run
    type(order_demand_t), intent(in) :: demand       !! positions, loads, modes, accuracy
    type(link_store_t), intent(inout) :: store       !! links decomposed earlier
    type(deformation_model_t), intent(out) :: model  !! of continuous links
    type(ledger_t), intent(inout) :: counts          !! of the work done
    type(error_t), allocatable, intent(out) :: error !! why there is no model

    real(wp) :: link_error(size(structure%beams)), highest, wave
    integer :: order(size(structure%beams)), highest_order(size(structure%beams)), b, bending, &
      pieces
    integer, allocatable :: chosen(:)
    integer :: between_masses(size(structure%beams))
    logical :: continuous(size(structure%beams))

    associate (linkage => structure%linkage, beams => structure%beams, modes => demand%modes, &
        link_bound => share*demand%bound)
      chosen = sample_states(positions, demand%states)
      bending = count(linkage%bodies%bends)
      do b = 1, size(beams)
        pieces = size(pieces_of(linkage%bodies(b))) - 1
        order(b) = max(least_order, (max(8, (3*modes)/(2*bending) + 6) + pieces - 1)/pieces)
        highest_order(b) = (spare_orders + (2*modes)/bending + (pieces - 1)*more_orders)/pieces
      end do
      between_masses = 0
      continuous = .false. ! no masses on nodes
      call new_deformation_model(linkage, beams, between_masses, order, continuous, model, error, &
        store)
      if (allocated(error) .or. size(chosen) == 0) return
      ! One position is enough to estimate the shortest wave.
      call try_samples(linkage, model, positions, chosen(size(chosen)/2 + 1:size(chosen)/2 + 1), &
        demand, link_error, highest, counts)
      do b = 1, size(beams)
        if (.not. linkage%bodies(b)%bends) cycle
        wave = longest_piece(linkage%bodies(b))*wave_number(linkage%bodies(b), beams(b), highest)
        order(b) = guessed_order(wave, link_bound, order(b), highest_order(b), modes, bending)
      end do
      do
        call new_deformation_model(linkage, beams, between_masses, order, continuous, model, &
          error, store)
        if (allocated(error)) return
        call try_samples(linkage, model, positions, chosen, demand, link_error, highest, counts)
        if (all(link_error <= link_bound .or. order >= highest_order)) exit
        do b = 1, size(beams)
          if (link_error(b) <= link_bound) cycle
          wave = longest_piece(linkage%bodies(b))*wave_number(linkage%bodies(b), beams(b), highest)
          order(b) = raised_order(wave, link_bound/link_error(b), order(b), highest_order(b))
        end do
      end do
    end associate
  end subroutine choose_orders

  !> A sample of the states that have a pose, spread evenly over the list.
  pure function sample_states(positions, states) result(chosen)
    type(positions_t), intent(in) :: positions
    integer, intent(in) :: states(:)
    integer, allocatable :: chosen(:)

    integer :: sound(size(states)), i, count, number

    count = 0
    do i = 1, size(states)
      if (allocated(positions%states(states(i))%error)) cycle
      count = count + 1
      sound(count) = states(i)
    end do
    number = min(max(least_samples, min(count/positions_a_sample, most_samples)), count)
    chosen = [(sound(1 + ((i - 1)*(count - 1))/max(1, number - 1)), i=1, number)]
  end function sample_states

  !> Length of the longest part of a link between masses [m].
  pure function longest_piece(body) result(length)
    type(body_t), intent(in) :: body
    real(wp) :: length

    real(wp), allocatable :: ends(:)

    ends = pieces_of(body)
    length = body%length*maxval(ends(2:) - ends(:size(ends) - 1))
  end function longest_piece

  !> Wave number k of the shortest bending waves in a link at a frequency.
  !!
  !! `EI k⁴ − (ρI + EI μ/kGA) ω² k² − μω² (1 − ρI ω²/kGA) = 0`
  pure function wave_number(body, beam, lambda) result(k)
    type(body_t), intent(in) :: body
    type(beam_t), intent(in) :: beam
    real(wp), intent(in) :: lambda !! ω² [1/s²]
    real(wp) :: k                  !! [1/m]

    real(wp) :: slender, added

    slender = body%line_density*lambda/beam%bending_stiffness
    k = slender**0.25_wp
    if (body%rotary_inertia <= 0.0_wp .and. beam%shear_stiffness <= 0.0_wp) return
    added = body%rotary_inertia/beam%bending_stiffness
    if (beam%shear_stiffness > 0.0_wp) then
      added = added + body%line_density/beam%shear_stiffness
      slender = slender*(1.0_wp - body%rotary_inertia*lambda/beam%shear_stiffness)
    end if
    added = 0.5_wp*added*lambda
    k = sqrt(added + sqrt(max(0.0_wp, added**2 + slender)))
  end function wave_number

  !> Order estimated from the wave number times the length of an element and an error bound. Where
  !! many modes are wanted it is not below the order of the first model, so that there are enough
  !! unknowns for all of them.
  pure function guessed_order(wave, bound, first, highest, modes, bending) result(order)
    real(wp), intent(in) :: wave     !! kL
    real(wp), intent(in) :: bound    !! on the relative error of eigenvalues
    integer, intent(in) :: first     !! order of the first model
    integer, intent(in) :: highest   !! upper limit of the order
    integer, intent(in) :: modes     !! number wanted
    integer, intent(in) :: bending   !! number of links that bend
    integer :: order

    real(wp) :: term
    integer :: least

    order = highest
    ! Waves too short for any order; kL may be too large for an integer.
    if (0.5_wp*wave > highest) return
    least = least_order
    if (2*modes > bending*least) least = first
    term = 1.0_wp
    do order = 2, highest
      term = term*0.25_wp*wave/(order - 1)
      if (order >= max(least, nint(0.5_wp*wave)) .and. term**2 <= bound) return
    end do
    order = highest
  end function guessed_order

  !> Order at which the error has fallen to a given share of itself: from order p to p + 1 it falls
  !! by the square of `kL/4p`. The order is raised by at most `most_raised`: where it is far too low
  !! the error estimate is unreliable.
  pure function raised_order(wave, share_wanted, order, highest) result(raised)
    real(wp), intent(in) :: wave         !! kL
    real(wp), intent(in) :: share_wanted !! below 1
    integer, intent(in) :: order, highest
    integer :: raised

    integer, parameter :: most_raised = 8
    real(wp) :: fallen

    fallen = 1.0_wp
    do raised = order + 1, min(order + most_raised, highest) - 1
      fallen = fallen*min(0.5_wp, 0.25_wp*wave/(raised - 1))**2
      if (fallen <= share_wanted) return
    end do
    raised = min(order + most_raised, highest)
  end function raised_order

  !> Solves the samples at the lowest and the highest speed: the largest error of any mode, link by
  !! link, and the largest eigenvalue in absolute value.
  subroutine try_samples(linkage, model, positions, chosen, demand, link_error, highest, counts)
    type(linkage_t), intent(in) :: linkage
    type(deformation_model_t), intent(in) :: model
    type(positions_t), intent(in) :: positions
    integer, intent(in) :: chosen(:)        !! numbers of the sampled states
    type(order_demand_t), intent(in) :: demand
    real(wp), intent(out) :: link_error(:)  !! (bodies) relative, of eigenvalues
    real(wp), intent(out) :: highest        !! |eigenvalue| [1/s²]
    type(ledger_t), intent(inout) :: counts

    type(speed_work_t) :: work
    type(unit_loads_t) :: loads
    type(bordered_modes_t), allocatable :: found(:)
    type(outcome_t), allocatable :: outcome(:)
    real(wp), allocatable :: force(:, :, :), tried(:, :)
    integer :: i, k

    tried = demand%factor(:, [minloc(demand%factor(1, :), dim=1), maxloc(demand%factor(1, :), &
      dim=1)])
    if (all(abs(tried(:, 1) - tried(:, 2)) <= 0.0_wp)) tried = tried(:, :1)
    allocate (found(size(tried, 2)), outcome(size(tried, 2)))
    work = new_speed_work(model, size(tried, 2))
    link_error = 0.0_wp
    highest = 0.0_wp
    do i = 1, size(chosen)
      associate (state => positions%states(chosen(i)))
        loads = find_unit_loads(linkage, state%pose, state%coefficients, &
          any(abs(tried) > 0.0_wp, dim=2))
        force = distributed_unit_forces(linkage, state%pose, loads)
        call clear_outcome(outcome)
        call assemble_equations(linkage, model, state%pose, force, tried, work%equations, counts)
        call solve_speeds(state%crank, tried, demand%modes, spread(.false., 1, size(found)), work, &
          found, outcome, counts)
      end associate
      do k = 1, size(found)
        if (allocated(outcome(k)%error)) cycle
        highest = max(highest, maxval(abs(found(k)%lambda(:demand%modes))))
        link_error = max(link_error, maxval(order_error(model, work%equations%chords, &
          total_force(force, tried(:, k)), found(k), demand%modes), dim=2))
      end do
    end do
  end subroutine try_samples

end module order_choice
