!> Choice of the polynomial orders that reach a given accuracy, link by link.
module order_choice
  use axial_forces, only: total_force
  use axial_limits, only: least_axial_force
  use beam_element, only: axial_degree
  use beam_mesh, only: beam_t
  use body_lumps, only: pieces_of
  use bordered_eigensolver, only: bordered_modes_t
  use deformation_model, only: deformation_model_t, new_deformation_model
  use errors, only: clear_outcome, error_t, outcome_t
  use kinds, only: wp
  use ledger, only: ledger_t
  use link_degrees, only: link_degrees_t, uniform_degrees
  use link_store, only: link_store_t
  use linkages, only: body_t, linkage_t
  use mixed_positions, only: modes_on_border
  use order_changes, only: part_count, part_of
  use order_errors, only: order_error
  use position_assembly, only: assemble_position, assembled_t, choose_form, new_assembled
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

  !> Highest degree of a displacement in a piece of a link, and most unknowns of a link across. Only
  !! links that buckle very many times over, as beside a dead point, ask for more.
  integer, parameter :: most_order = 3*digits(1.0_wp), most_unknowns = 12*digits(1.0_wp)

  !> Orders that every link may have at least, whatever its number of masses: `spare_orders` for
  !! one piece, for each mode its share of two, and `more_orders` for each further piece.
  integer, parameter :: spare_orders = digits(1.0_wp) + 3, more_orders = 16

  integer, parameter :: least_order = 4

  !> Orders are tried at one in `positions_a_sample` positions, within these limits. Afterwards the
  !! error is estimated at every row of the sweep.
  integer, parameter :: positions_a_sample = 9, least_samples = 2, most_samples = 6

  !> Share of the accuracy that one part of a link may use at the samples: other positions may be
  !! worse.
  real(wp), parameter :: share = 0.05_wp

  !> Unknowns across beyond the number of modes that all links together have at least.
  integer, parameter :: spare_unknowns = 8

  !> Wave numbers times lengths of the pieces of a link.
  type :: waves_t
    real(wp), allocatable :: across(:) !! bending
    real(wp), allocatable :: along(:)  !! along the axis
    real(wp), allocatable :: pulled(:) !! κL: a link that is pulled bends in layers exp(−κx) at its
                                       !! ends, of which exp(−p²/κL) is left beyond order p
  end type waves_t

  !> What the samples show.
  type :: sample_t
    real(wp), allocatable :: error(:)       !! (parts) largest relative error of any eigenvalue
    real(wp), allocatable :: least_force(:) !! (bodies) most compressive axial force, or 0 [N]
    real(wp), allocatable :: most_force(:)  !! (bodies) largest tension, or 0 [N]
    real(wp) :: highest = 0.0_wp            !! largest |eigenvalue| [1/s²]
  end type sample_t

contains

  !> Finds a model of continuous links that keeps the estimated error of every eigenvalue below a
  !! bound, at sampled positions and at the lowest and the highest speed. Each link has one element,
  !! or one between masses along it. That is enough for any accuracy, since links are uniform and
  !! loads smooth between masses.
  !!
  !! Degrees are chosen piece by piece, across and along, from the shortest waves that occur there:
  !! the error of order p is about `((kL/4)^{p−1}/(p−1)!)²` for the wave number k and the length L
  !! of the piece. Where the model's own error estimate is above the bound, the degree is raised.
  !!
  !! Errors: those of `new_deformation_model`. A bound that is not reached at the highest degrees is
  !! no error.
  subroutine choose_orders(structure, positions, demand, store, model, counts, error)
    type(structure_t), intent(in) :: structure       !! with beams
    type(positions_t), intent(in) :: positions       !! of the run
    type(order_demand_t), intent(in) :: demand       !! positions, loads, modes, accuracy
    type(link_store_t), intent(inout) :: store       !! links decomposed earlier
    type(deformation_model_t), intent(out) :: model  !! of continuous links
    type(ledger_t), intent(inout) :: counts          !! of the work done
    type(error_t), allocatable, intent(out) :: error !! why there is no model

    type(sample_t) :: sample
    type(link_degrees_t), dimension(size(structure%elastic%body)) :: degrees, highest
    integer, allocatable :: chosen(:)
    real(wp) :: part_bound
    integer :: b, pieces, bending, first
    logical :: raised

    associate (modes => demand%modes, linkage => structure%elastic%linkage, &
      beams => structure%elastic%beams)
      part_bound = share*demand%bound
      chosen = sample_states(positions, demand%states)
      bending = max(1, count(linkage%bodies%bends))
      do b = 1, size(beams)
        pieces = size(pieces_of(linkage%bodies(b))) - 1
        highest(b) = highest_degrees(pieces, modes, bending, beams(b)%shear_stiffness > 0.0_wp)
        first = max(least_order, (max(8, (3*modes)/(2*bending) + 6) + pieces - 1)/pieces)
        degrees(b) = uniform_degrees(pieces, first, axial_degree(first))
      end do
      call make_model(model, error)
      if (allocated(error) .or. size(chosen) == 0) return
      ! One position is enough to estimate the shortest wave.
      call try_samples(structure, model, positions, chosen(size(chosen)/2 + &
        1:size(chosen)/2 + 1), demand, sample, counts)
      do b = 1, size(beams)
        if (linkage%bodies(b)%bends) degrees(b) = &
          guessed_degrees(waves_in(linkage%bodies(b), beams(b), sample, b), part_bound, highest(b))
      end do
      do while (unknowns_of(degrees, linkage%bodies%bends) < modes + spare_unknowns)
        if (.not. any(linkage%bodies%bends)) exit
        do b = 1, size(beams)
          degrees(b)%across = degrees(b)%across + 1
        end do
      end do
      do
        call make_model(model, error)
        if (allocated(error)) return
        call try_samples(structure, model, positions, chosen, demand, sample, counts)
        raised = .false.
        do b = 1, size(beams)
          if (linkage%bodies(b)%bends) call raise_degrees(waves_in(linkage%bodies(b), &
            beams(b), sample, b), model, sample, b, part_bound, highest(b), degrees(b), raised)
        end do
        if (.not. raised) exit
      end do
    end associate

  contains

    subroutine make_model(model, error)
      type(deformation_model_t), intent(out) :: model
      type(error_t), allocatable, intent(out) :: error

      integer :: i

      call new_deformation_model(structure%elastic%linkage, structure%elastic%beams, spread(0, 1, &
        size(degrees)), spread(0, 1, size(degrees)), spread(.false., 1, size(degrees)), model, &
        error, store, degrees, structure%elastic%held)
      if (.not. allocated(error)) call choose_form(structure, demand%modes, &
        [(positions%states(chosen(i))%crank, i=1, size(chosen))], model)
    end subroutine make_model

  end subroutine choose_orders

  !> The limits of the degrees of a link.
  pure function highest_degrees(pieces, modes, bending, sheared) result(highest)
    integer, intent(in) :: pieces  !! of the link
    integer, intent(in) :: modes   !! wanted
    integer, intent(in) :: bending !! number of links that bend
    logical, intent(in) :: sheared
    type(link_degrees_t) :: highest

    integer :: most

    most = min(most_order, most_unknowns/(pieces*merge(2, 1, sheared)))
    most = max(most, (spare_orders + (2*modes)/bending + (pieces - 1)*more_orders)/pieces)
    highest = uniform_degrees(pieces, most, most)
  end function highest_degrees

  !> Unknowns across of all links that bend.
  pure function unknowns_of(degrees, bends) result(unknowns)
    type(link_degrees_t), intent(in) :: degrees(:)
    logical, intent(in) :: bends(:)
    integer :: unknowns

    integer :: b

    unknowns = 0
    do b = 1, size(degrees)
      if (bends(b)) unknowns = unknowns + sum(degrees(b)%across - 1)
    end do
  end function unknowns_of

  !> Degrees from the waves that occur in each piece.
  pure function guessed_degrees(waves, bound, highest) result(degrees)
    type(waves_t), intent(in) :: waves !! of the link
    real(wp), intent(in) :: bound
    type(link_degrees_t), intent(in) :: highest
    type(link_degrees_t) :: degrees

    integer :: e, layer

    degrees = highest
    do e = 1, size(waves%across)
      layer = ceiling(min(sqrt(0.5_wp*waves%pulled(e)*abs(log(bound))), &
        real(highest%across(e), wp)))
      degrees%across(e) = max(layer, guessed_order(waves%across(e), bound, highest%across(e)))
      degrees%along(e) = max(1, guessed_order(waves%along(e), bound, highest%along(e)) - 2)
    end do
  end function guessed_degrees

  !> Raises the degrees of the parts whose error is above the bound; at least to those that the
  !! waves now known ask for.
  pure subroutine raise_degrees(waves, model, sample, b, bound, highest, degrees, raised)
    type(waves_t), intent(in) :: waves !! of the link
    type(deformation_model_t), intent(in) :: model
    type(sample_t), intent(in) :: sample
    integer, intent(in) :: b !! number of the body
    real(wp), intent(in) :: bound
    type(link_degrees_t), intent(in) :: highest
    type(link_degrees_t), intent(inout) :: degrees
    logical, intent(inout) :: raised

    type(link_degrees_t) :: guessed
    integer :: e

    guessed = guessed_degrees(waves, bound, highest)
    do e = 1, size(waves%across)
      call raise(degrees%across(e), guessed%across(e), highest%across(e), waves%across(e), bound, &
        sample%error(part_of(model%links, b, e, .false.)), raised)
      call raise(degrees%along(e), guessed%along(e), highest%along(e), waves%along(e), bound, &
        sample%error(part_of(model%links, b, e, .true.)), raised)
    end do
  end subroutine raise_degrees

  !> Raises one degree if its error is above the bound and its limit is not reached.
  pure subroutine raise(order, guessed, most, wave, bound, error, raised)
    integer, intent(inout) :: order
    integer, intent(in) :: guessed, most
    real(wp), intent(in) :: wave, bound, error
    logical, intent(inout) :: raised

    if (error <= bound .or. order >= most) return
    order = max(raised_order(wave, bound/error, order, most), min(guessed, most))
    raised = .true.
  end subroutine raise

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

  !> The shortest waves in each piece of a link, at the highest frequency and the axial forces of
  !! the samples.
  pure function waves_in(body, beam, sample, b) result(waves)
    type(body_t), intent(in) :: body
    type(beam_t), intent(in) :: beam
    type(sample_t), intent(in) :: sample
    integer, intent(in) :: b !! number of the body
    type(waves_t) :: waves

    real(wp), allocatable :: ends(:), length(:)

    ends = pieces_of(body)
    length = body%length*(ends(2:) - ends(:size(ends) - 1))
    waves%across = wave_number(body, beam, sample%highest, sample%least_force(b))*length
    waves%along = sqrt(sample%highest*body%line_density/beam%axial_stiffness)*length
    waves%pulled = sqrt(max(0.0_wp, sample%most_force(b))/beam%bending_stiffness)*length
  end function waves_in

  !> Wave number k of the shortest bending waves in a link at a frequency and axial force N.
  !!
  !! `EI(1 + N/kGA) k⁴ + (N − (ρI + EI μ/kGA) ω²) k² − μω² (1 − ρI ω²/kGA) = 0`
  pure function wave_number(body, beam, lambda, force) result(k)
    type(body_t), intent(in) :: body
    type(beam_t), intent(in) :: beam
    real(wp), intent(in) :: lambda !! ω² [1/s²]
    real(wp), intent(in) :: force  !! the least N: tension lengthens waves [N]
    real(wp) :: k                  !! [1/m]

    real(wp) :: slender, added, stiffness

    stiffness = beam%bending_stiffness
    added = -min(force, 0.0_wp) + body%rotary_inertia*lambda
    slender = body%line_density*lambda
    if (beam%shear_stiffness > 0.0_wp) then
      added = added + body%line_density*lambda*stiffness/beam%shear_stiffness
      slender = slender*(1.0_wp - body%rotary_inertia*lambda/beam%shear_stiffness)
      ! Near −kGA waves become infinitely short.
      stiffness = stiffness*max(0.1_wp, 1.0_wp + min(force, 0.0_wp)/beam%shear_stiffness)
    end if
    added = 0.5_wp*added/stiffness
    k = sqrt(added + sqrt(max(0.0_wp, added**2 + slender/stiffness)))
  end function wave_number

  !> Order estimated from the wave number times the length of an element and an error bound.
  pure function guessed_order(wave, bound, highest) result(order)
    real(wp), intent(in) :: wave     !! kL
    real(wp), intent(in) :: bound    !! on the relative error of eigenvalues
    integer, intent(in) :: highest   !! upper limit of the order
    integer :: order

    real(wp) :: term

    order = highest
    ! Waves too short for any order; kL may be too large for an integer.
    if (0.5_wp*wave > highest) return
    term = 1.0_wp
    do order = 2, highest
      term = term*0.25_wp*wave/(order - 1)
      if (order >= max(least_order, nint(0.5_wp*wave)) .and. term**2 <= bound) return
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

  !> Solves the samples at the lowest and the highest speed.
  subroutine try_samples(structure, model, positions, chosen, demand, sample, counts)
    type(structure_t), intent(in) :: structure
    type(deformation_model_t), intent(in) :: model
    type(positions_t), intent(in) :: positions
    integer, intent(in) :: chosen(:)        !! numbers of the sampled states
    type(order_demand_t), intent(in) :: demand
    type(sample_t), intent(out) :: sample
    type(ledger_t), intent(inout) :: counts

    type(speed_work_t) :: work
    type(assembled_t) :: here
    type(bordered_modes_t) :: modes
    type(outcome_t), allocatable :: outcome(:)
    real(wp), allocatable :: tried(:, :), present_force(:, :)
    integer :: i, k

    tried = demand%factor(:, [minloc(demand%factor(1, :), dim=1), maxloc(demand%factor(1, :), &
      dim=1)])
    if (all(abs(tried(:, 1) - tried(:, 2)) <= 0.0_wp)) tried = tried(:, :1)
    allocate (outcome(size(tried, 2)))
    work = new_speed_work(model, size(tried, 2), demand%bound)
    here = new_assembled(structure, model)
    allocate (sample%error(part_count(model%links)))
    allocate (sample%least_force(size(model%links)), sample%most_force(size(model%links)))
    sample%error = 0.0_wp
    sample%least_force = 0.0_wp
    sample%most_force = 0.0_wp
    do i = 1, size(chosen)
      associate (state => positions%states(chosen(i)))
        call clear_outcome(outcome)
        call assemble_position(structure, model, state, tried, work%equations, here, outcome, &
          counts)
        if (allocated(here%border)) then
          if (here%border%is_new) work%tracks%length = 0
        end if
        call solve_speeds(state%crank, tried, demand%modes, spread(.false., 1, size(outcome)), &
          work, outcome, counts, here%mixed)
      end associate
      do k = 1, size(outcome)
        if (allocated(outcome(k)%error)) cycle
        present_force = total_force(here%unit_force, tried(:, k))
        call add_force_range(structure%elastic%linkage, present_force, sample)
        sample%highest = max(sample%highest, maxval(abs(work%found(k)%lambda(:demand%modes))))
        if (allocated(here%mixed)) then
          call modes_on_border(here%mixed, here%elastic_position_t, work%found(k), &
            work%equations%chords, work%equations%pencil%mass%border, modes)
          sample%error = max(sample%error, maxval(order_error(here%model, work%equations, &
            present_force, modes, modes%near), dim=2))
        else
          sample%error = max(sample%error, maxval(order_error(here%model, work%equations, &
            present_force, work%found(k), work%found(k)%near), dim=2))
        end if
      end do
    end do
  end subroutine try_samples

  !> Extends the range of axial forces by those of a position.
  pure subroutine add_force_range(linkage, force, sample)
    type(linkage_t), intent(in) :: linkage
    real(wp), intent(in) :: force(:, :) !! (1, ξ, ξ², jumps; bodies) [N]
    type(sample_t), intent(inout) :: sample

    integer :: b

    if (size(force, 1) == 0) return
    do b = 1, size(linkage%bodies)
      if (.not. linkage%bodies(b)%bends) cycle
      sample%least_force(b) = min(sample%least_force(b), least_axial_force(linkage%bodies(b), &
        force(:, b)))
      sample%most_force(b) = max(sample%most_force(b), -least_axial_force(linkage%bodies(b), &
        -force(:, b)))
    end do
  end subroutine add_force_range

end module order_choice
