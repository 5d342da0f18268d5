! src/studies/balance/ - balancing: counterweights and shafts, forces with them, harmonics.
! In: a linkage; a `balance_request_t` for other aims than full force balance. Out:
! `balance_result_t`, `harmonics_result_t`. Begin with `find_balance` in `balance_study.f90`:
! `find_cancelling_weights` in `harmonics_study.f90`, or `find_partial_balance` here.
! Not here: counterweights themselves, and the forces of a cycle (`src/linkage/balance`).

!> Counterweights that minimise shaking force, shaking moment and driving torque over a turn, and
!! balance shafts that cancel harmonics of the shaking force.
!!
!! The sum of the aims is `Σ weight · mean square over the turn / the same without counterweights`,
!! at constant speed, of which it does not depend: all three grow as ω2².
module partial_balance_study
  use balance_shafts, only: cancelling_shaft, force_harmonic
  use balanced_linkages, only: balanced_linkage, counterweight_make_t, counterweight_t, &
    disc_diameter, own_inertia, radius_of
  use constants, only: pi
  use counterweight_series, only: counterweight_on, unit_forces
  use crank_cycle, only: cycle_t, drive_torque, parts_at, quantity_count, shaking_force, &
    shaking_moment, usual_values
  use errors, only: error_of_reach, error_t, set_error
  use full_turns, only: turns_fully
  use kinds, only: wp
  use linkages, only: linkage_t, reference_point, shaft_t
  use rigid_bodies, only: rigid_bodies_of, total_mass
  use settled_cycles, only: find_settled_cycles
  use vector_least_squares, only: find_least_squares, has_full_rank, vector_minimum_t, &
    vector_problem_t
  implicit none (type, external)
  private

  public :: balance_request_t, shaft_request_t, partial_balance_t, find_partial_balance
  public :: no_turn, aim_count, aim_force, aim_moment, aim_torque

  !> What may be minimised.
  integer, parameter :: aim_count = 3, aim_force = 1, aim_moment = 2, aim_torque = 3

  !> A pair of balance shafts, with and against the crank.
  type :: shaft_request_t
    integer :: order = 1              !! of the harmonic
    real(wp) :: place(2, 2) = 0.0_wp  !! (2, shafts) with and against the crank, in global axes [m]
    logical :: is_placed = .false.    !! else at the reference point of moments
    real(wp) :: radius = 0.0_wp       !! of the mass; 0: the length of the first body [m]
    type(counterweight_make_t) :: make
  end type shaft_request_t

  type :: balance_request_t
    integer, allocatable :: bodies(:)    !! that bear counterweights, each with one ground pivot
    real(wp), allocatable :: radius(:)   !! (bodies) of the counterweights; 0: the link's length [m]
    real(wp) :: aim(aim_count) = 0.0_wp  !! weights; 0: no aim. None: no counterweights
    type(counterweight_make_t) :: make
    type(shaft_request_t), allocatable :: shafts(:)
  end type balance_request_t

  type :: partial_balance_t
    type(error_t), allocatable :: error  !! why nothing is balanced: the crank does not turn fully
    type(counterweight_t), allocatable :: weights(:)
    real(wp), allocatable :: diameter(:) !! (weights) of discs; 0: no disc [m]
    integer, allocatable :: idle(:)      !! bodies on which a counterweight does nothing for the
                                         !! aims, or nothing that those before it do not
    real(wp) :: before(aim_count) = 0.0_wp !! rms of the aims at ω2 = 1, as given [N s², N m s²]
    real(wp) :: after(aim_count) = 0.0_wp  !! with counterweights and shafts
    logical :: is_alive(aim_count) = .false. !! the quantity is not zero as given
    logical :: is_counted(aim_count) = .false. !! and it is an aim
    type(vector_minimum_t) :: minimum    !! of the weighted sum
    integer :: samples = 0               !! of the turn
    type(linkage_t) :: linkage           !! balanced
  end type partial_balance_t

  character(len=*), parameter :: no_turn = "the crank does not turn fully, or comes to a dead "// &
    "point: BALANCE is over a whole turn, and there is none"

  !> Below this share of its usual value a quantity is rounding.
  real(wp), parameter :: rounding = 1.0e-13_wp

contains

  !> Counterweights first, then the shafts: they cancel what the counterweights leave of their
  !! harmonic. The half of a first harmonic that turns with the crank is the crank's own
  !! counterweight, if it has a ground pivot.
  subroutine find_partial_balance(request, linkage, elements, threads, found)
    type(balance_request_t), intent(in) :: request
    type(linkage_t), intent(in) :: linkage !! of any kind, without counterweights
    integer, intent(in) :: elements(:)     !! (bodies) on whose nodes the masses are lumped; 0:
                                           !! distributed
    integer, intent(in) :: threads         !! number of OpenMP threads
    type(partial_balance_t), intent(out) :: found

    real(wp), allocatable :: given(:, :)
    integer :: i

    found%linkage = linkage
    allocate (found%weights(0), found%diameter(0), found%idle(0))
    if (.not. turns_fully(linkage, through=.true.)) then
      call set_error(found%error, error_of_reach, no_turn)
      return
    end if
    call sample_given(request, linkage, elements, threads, given)
    found%samples = size(given, 2)
    found%before = rms_of(given)
    if (any(request%aim > 0.0_wp)) call minimise(request, linkage, elements, given, found)
    do i = 1, size(request%shafts)
      if (request%shafts(i)%order == 1 .and. linkage%has_crank .and. &
        .not. any(found%weights%body == 1)) call balance_crank(request%shafts(i), elements, &
        size(given, 2), found)
    end do
    found%is_alive = is_alive(found%before, linkage, elements)
    found%is_counted = request%aim > 0.0_wp .and. found%is_alive
    found%linkage = balanced_linkage(linkage, found%weights)
    if (size(request%shafts) > 0) call add_shafts(request, elements, size(given, 2), found)
    found%after = rms_of(sampled(found%linkage, elements, size(given, 2)))
  end subroutine find_partial_balance

  !> Adds the counterweight of the crank that leaves least of the shaking force: it cancels the half
  !! of its first harmonic that turns with the crank.
  subroutine balance_crank(pair, elements, samples, found)
    type(shaft_request_t), intent(in) :: pair
    integer, intent(in) :: elements(:), samples
    type(partial_balance_t), intent(inout) :: found !! with the other counterweights

    type(balance_request_t) :: request
    type(linkage_t) :: linkage
    type(partial_balance_t) :: alone

    request%bodies = [1]
    request%radius = [pair%radius]
    request%aim(aim_force) = 1.0_wp
    request%make = pair%make
    linkage = balanced_linkage(found%linkage, found%weights)
    allocate (alone%weights(0), alone%diameter(0), alone%idle(0))
    call minimise(request, linkage, elements, sampled(linkage, elements, samples), alone)
    found%weights = [found%weights, alone%weights]
    found%idle = pack(found%idle, found%idle /= 1)
    found%diameter = [found%diameter, alone%diameter]
  end subroutine balance_crank

  !> Shaking force, moment and torque of the given linkage at ω2 = 1, over a turn. There are enough
  !! samples for its spectra, and for the spectra with heavy counterweights, to have converged.
  subroutine sample_given(request, linkage, elements, threads, given)
    type(balance_request_t), intent(in) :: request
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: elements(:), threads
    real(wp), allocatable, intent(out) :: given(:, :) !! (4, samples)

    type(linkage_t) :: linkages(2)
    type(cycle_t) :: turns(2)
    type(counterweight_t) :: weight
    real(wp) :: change, mass
    integer :: i

    linkages(1) = linkage
    linkages(2) = linkage
    mass = total_mass(linkage, rigid_bodies_of(linkage, elements))
    do i = 1, size(request%bodies)
      weight = counterweight_on(linkage, request%bodies(i))
      weight%first_moment = mass*linkage%bodies(weight%body)%length*[0.6_wp, 0.8_wp]
      weight%needed = .true.
      linkages(2) = balanced_linkage(linkages(2), [weight])
    end do
    ! At rest only weights and loads would be left: any speed gives the same spectra.
    call find_settled_cycles(linkages, elements, [1.0_wp], 0.0_wp, threads, turns, change)
    given = turns(1)%part(:, 1, :)
  end subroutine sample_given

  !> Shaking force, moment and torque at ω2 = 1 over a turn.
  pure function sampled(linkage, elements, samples) result(values)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: elements(:), samples
    real(wp) :: values(4, samples)

    real(wp), allocatable :: part(:, :)
    integer :: i

    do i = 1, samples
      part = parts_at(linkage, elements, 360.0_wp*real(i - 1, wp)/samples)
      values(:, i) = part(:, 1)
    end do
  end function sampled

  !> Root mean squares of the shaking force, the shaking moment and the torque.
  pure function rms_of(values) result(rms)
    real(wp), intent(in) :: values(:, :) !! (4, samples)
    real(wp) :: rms(aim_count)

    integer :: n

    n = size(values, 2)
    rms = sqrt([sum(values(:2, :)**2), sum(values(3, :)**2), sum(values(4, :)**2)]/n)
  end function rms_of

  !> Whether aims are more than rounding.
  pure function is_alive(rms, linkage, elements) result(is)
    real(wp), intent(in) :: rms(:) !! (aims) at ω2 = 1
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: elements(:)
    logical :: is(aim_count)

    type(linkage_t) :: weightless
    real(wp) :: usual(quantity_count)

    weightless = linkage
    weightless%gravity = 0.0_wp
    usual = usual_values(weightless, elements, 1.0_wp, 0.0_wp)
    is = rms > rounding*usual([shaking_force, shaking_moment, drive_torque])
  end function is_alive

  !> Adds the counterweights that minimise the aims.
  subroutine minimise(request, linkage, elements, given, found)
    type(balance_request_t), intent(in) :: request
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: elements(:)
    real(wp), intent(in) :: given(:, :) !! (4, samples) at ω2 = 1
    type(partial_balance_t), intent(inout) :: found

    type(counterweight_t), allocatable :: weights(:)
    type(vector_problem_t) :: problem
    real(wp), allocatable :: forces(:, :, :, :), scale(:)
    real(wp) :: moment, length, row(4), rms(aim_count), radius(size(request%bodies))
    logical :: is_idle(size(request%bodies)), counted(aim_count)
    integer, allocatable :: kept(:)
    integer :: i, k, n, samples

    samples = size(given, 2)
    allocate (weights(size(request%bodies)), forces(4, 3, size(request%bodies), samples))
    do i = 1, size(weights)
      weights(i) = counterweight_on(linkage, request%bodies(i))
      weights(i)%radius = request%radius(i)
      radius(i) = radius_of(weights(i), linkage%bodies(weights(i)%body))
    end do
    do i = 1, samples
      call unit_forces(linkage, weights, 360.0_wp*real(i - 1, wp)/samples, forces(:, :, :, i))
    end do
    ! Unknowns are shares of the mass at the sum of the lengths.
    length = sum(linkage%bodies%length)
    moment = total_mass(linkage, rigid_bodies_of(linkage, elements))*length
    rms = rms_of(given)
    counted = request%aim > 0.0_wp .and. is_alive(rms, linkage, elements)
    row = 0.0_wp
    if (counted(aim_force)) row(:2) = sqrt(request%aim(aim_force))/rms(aim_force)
    if (counted(aim_moment)) row(3) = sqrt(request%aim(aim_moment))/rms(aim_moment)
    if (counted(aim_torque)) row(4) = sqrt(request%aim(aim_torque))/rms(aim_torque)
    row = row/sqrt(real(samples, wp))
    scale = [moment, moment, moment*length]
    do i = 1, samples
      do k = 1, 3
        forces(:, k, :, i) = scale(k)*forces(:, k, :, i)*spread(row, 2, size(weights))
      end do
    end do
    call find_idle(forces, is_idle)
    found%idle = [found%idle, pack(request%bodies, is_idle)]
    kept = pack([(i, i=1, size(weights))], .not. is_idle)
    n = size(kept)
    if (n == 0) then
      ! Nothing helps: the sum is that without counterweights.
      found%minimum%value = sum((given*spread(row, 2, samples))**2)
      found%minimum%is_least = norm2(forces(:, 3, :, :)) <= rounding*norm2(forces)
      return
    end if
    allocate (problem%along(4*samples, 2*n), problem%by_length(4*samples, n))
    do i = 1, n
      problem%along(:, 2*i - 1) = reshape(forces(:, 1, kept(i), :), [4*samples])
      problem%along(:, 2*i) = reshape(forces(:, 2, kept(i), :), [4*samples])
      problem%by_length(:, i) = reshape(forces(:, 3, kept(i), :), [4*samples])
    end do
    problem%constant = reshape(given*spread(row, 2, samples), [4*samples])
    problem%jump = spread(request%make%inertia/(moment*length), 1, n)
    problem%linear = radius(kept)/length
    problem%square = spread(0.0_wp, 1, n)
    ! J = m r² + m²/(2 ρ π t) with m = |p|/r.
    if (request%make%density > 0.0_wp) problem%square = moment/(length*radius(kept)**2*2.0_wp*pi* &
      request%make%density*request%make%thickness)
    call find_least_squares(problem, found%minimum)
    do i = 1, n
      associate (weight => weights(kept(i)))
        weight%first_moment = moment*found%minimum%vector(:, i)
        weight%needed = norm2(found%minimum%vector(:, i)) > rounding
        ! Across the link there may be rounding only.
        where (abs(weight%first_moment) <= rounding*norm2(weight%first_moment)) &
          weight%first_moment = 0.0_wp
        weight%radius = radius(kept(i))
        if (weight%needed) weight%inertia = own_inertia(request%make, norm2(weight%first_moment)/ &
          radius(kept(i)))
        found%weights = [found%weights, weight]
        found%diameter = [found%diameter, 0.0_wp]
        if (weight%needed .and. request%make%density > 0.0_wp) &
          found%diameter(size(found%diameter)) = disc_diameter(request%make, &
          norm2(weight%first_moment)/radius(kept(i)))
      end associate
    end do
  end subroutine minimise

  !> Bodies whose counterweights are of no use to the aims: in any direction they change nothing, or
  !! only what counterweights on the bodies before them change as well.
  pure subroutine find_idle(forces, is_idle)
    real(wp), intent(in) :: forces(:, :, :, :) !! (4, 3, bodies, samples)
    logical, intent(out) :: is_idle(:)        !! (bodies)

    real(wp), allocatable :: others(:, :), mine(:, :), longer(:, :)
    real(wp) :: usual
    integer :: i, rows

    rows = size(forces, 1)*size(forces, 4)
    usual = norm2(forces)
    allocate (others(rows, 0))
    do i = 1, size(is_idle)
      mine = reshape([reshape(forces(:, 1, i, :), [rows]), reshape(forces(:, 2, i, :), [rows])], &
        [rows, 2])
      is_idle(i) = any(norm2(mine, dim=1) <= rounding*usual) .or. .not. usual > 0.0_wp
      if (.not. is_idle(i)) is_idle(i) = .not. has_full_rank(mine, others)
      if (is_idle(i)) cycle
      longer = reshape([others, mine], [rows, size(others, 2) + 2])
      call move_alloc(longer, others)
    end do
  end subroutine find_idle

  !> The balance shafts of all pairs, for what the counterweights leave.
  subroutine add_shafts(request, elements, samples, found)
    type(balance_request_t), intent(in) :: request
    integer, intent(in) :: elements(:), samples
    type(partial_balance_t), intent(inout) :: found !! its linkage has the counterweights

    type(shaft_t) :: shaft
    type(linkage_t) :: weightless
    real(wp) :: values(4, samples), usual(quantity_count), place(2), radius
    integer :: i, k

    values = sampled(found%linkage, elements, samples)
    weightless = found%linkage
    weightless%gravity = 0.0_wp
    usual = usual_values(weightless, elements, 1.0_wp, 0.0_wp)
    allocate (found%linkage%shafts(0))
    do i = 1, size(request%shafts)
      associate (pair => request%shafts(i))
        do k = 1, 2
          place = reference_point(found%linkage)
          if (pair%is_placed) place = pair%place(:, k)
          shaft = cancelling_shaft(force_harmonic(values(:2, :), merge(pair%order, -pair%order, &
            k == 1)), merge(pair%order, -pair%order, k == 1), place)
          if (shaft%first_moment*pair%order**2 <= rounding*usual(shaking_force)) cycle
          radius = pair%radius
          if (.not. radius > 0.0_wp) radius = found%linkage%bodies(1)%length
          shaft%radius = radius
          shaft%inertia = shaft%first_moment*radius + own_inertia(pair%make, &
            shaft%first_moment/radius)
          found%linkage%shafts = [found%linkage%shafts, shaft]
        end do
      end associate
    end do
  end subroutine add_shafts

end module partial_balance_study
