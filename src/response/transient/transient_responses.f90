!> The elastic motion in time from a state at prescribed motion of the crank, with estimated errors.
!!
!! Every speed is solved with orders and steps that rise from one solution to the next, orders by
!! two, steps by half. A sudden start excites vibrations of all orders, and strains then converge as
!! slowly as a power of the order: not the last difference bounds the error, but the sum of those
!! that would follow, which three solutions tell. Vibrations too fast for the steps are in no
!! solution; what steps miss of them is added.
module transient_responses
  use byte_streams, only: byte_stream_t, pass_error
  use constants, only: two_pi
  use crank_laws, only: constant_from, covered_range_t, crank_law_t, crank_motion, extremes_of, &
    time_of_turns
  use deformation_model, only: deformation_model_t
  use errors, only: error_of_numerics, error_t, set_error
  use excited_vibrations, only: excited_vibration_t, find_excited_vibrations, missed_by_steps
  use gauge_values, only: gauge_values_of
  use interruption, only: was_interrupted
  use kept_results, only: keep_result, keeper_t, recall_result
  use kinds, only: wp
  use link_store, only: link_store_t
  use linkages, only: gives_angle
  use part_requests, only: join_largest, request_of_parts
  use path_grids, only: new_path_grid, place_grid
  use poses, only: find_pose, pose_t
  use refinements, only: compare, raise, refinement_limits_t, refinement_t
  use response_levels, only: damping_of, new_order_model
  use response_peaks, only: sampled_deflections
  use response_types, only: strain_values
  use slow_bases, only: own_squares
  use structures, only: structure_t
  use strain_dampings, only: damping_t
  use text, only: to_string
  use transient_quantities, only: of_gauge, of_point, quantities_of
  use transient_motions, only: new_stepping, solve_motion, stages, transient_motion_t
  use transient_steps, only: stepping_t
  use transient_starts, only: find_start
  use transient_types, only: speed_transient_t, transient_request_t, transient_t
  use turn_grids, only: turn_grid_t
  implicit none (type, external)
  private

  public :: find_transients

  !> Estimated errors are what differences of solutions leave, or the last of these, times this.
  !! None is stated below the rounding of the whole, and below so much of the highest harmonics of
  !! the path, or what a steady state lacks from which it starts.
  real(wp), parameter :: safety = 2.0_wp, rounding = 1.0e-12_wp, of_tail = 100.0_wp

  !> Steps are to miss no more of vibrations than this share of the accuracy.
  real(wp), parameter :: of_steps = 0.2_wp

  !> Slowest and fastest powers of the order by which errors are taken to fall.
  real(wp), parameter :: slowest = 0.5_wp, fastest = 50.0_wp

  !> First steps: radians of the slowest vibration in one, at most.
  real(wp), parameter :: first_radians = 0.6_wp

  !> Orders are raised, and steps by half; where errors do not fall two times, one after another,
  !! more of the same does not help. They are estimated from so many solutions on.
  type(refinement_limits_t), parameter :: limits = refinement_limits_t(order=34, rounds=8, &
    gain=0.8_wp, idle=2)
  integer, parameter :: least_rounds = 3

  !> No solution is begun that takes more than this: steps × (unknowns × stages)³, about a minute;
  !! nor are steps raised for fast vibrations to more than the second. The terms of a step take at
  !! least the third.
  real(wp), parameter :: most_work = 1.0e11_wp, most_raised = 1.0e10_wp, of_terms = 4.0e6_wp

  !> A quantity smaller than this beside what goes with it is taken for zero by its nature.
  real(wp), parameter :: by_nature = 1.0e-3_wp

  !> Displacements smaller than this beside the largest of all points are of rounding.
  real(wp), parameter :: of_rounding = 1.0e-6_wp

  !> Derivatives of terms need a way, by an angle [deg] or as a share of the longest link; of those
  !! of a block along a link, which come in twice, so many times more.
  real(wp), parameter :: least_angle = 1.0_wp, least_share = 0.01_wp, for_blocks = 12.0_wp

  !> Instants whose places are found together.
  integer, parameter :: at_a_time = 128

  !> A row that would stand so little after the end, in steps between rows, stands at it.
  real(wp), parameter :: slack = 1.0e-9_wp

contains

  !> The motion at every speed, or why there is none.
  subroutine find_transients(structure, request, store, transient, keeper)
    class(structure_t), intent(in) :: structure        !! linkage and beams
    type(transient_request_t), intent(in) :: request
    type(link_store_t), intent(inout) :: store         !! links decomposed earlier
    type(transient_t), intent(out) :: transient        !! with a result or an error at every speed
    class(keeper_t), intent(inout), optional :: keeper !! of solutions at speeds, a round each

    type(transient_request_t) :: of_bodies
    type(crank_law_t) :: law
    integer :: k

    of_bodies = request
    of_bodies%response = request_of_parts(structure%elastic, request%response)
    allocate (transient%at_speed(size(request%response%speed)))
    do k = 1, size(transient%at_speed)
      if (was_interrupted()) exit
      law = crank_law_t(request%crank, request%response%speed(k), request%ramp)
      if (allocated(request%program)) law%program = request%program
      law%range%is_angle = gives_angle(structure%linkage%drives(1))
      law%range%is_turn = law%range%is_angle .and. request%turns_fully
      call find_transient(structure, of_bodies, law, k, store, transient%at_speed(k), keeper)
      call join_largest(structure%elastic, size(structure%linkage%bodies), &
        transient%at_speed(k)%deflection)
    end do
  end subroutine find_transients

  !> Solutions one after another until two agree.
  subroutine find_transient(structure, request, law, number, store, found, keeper)
    class(structure_t), intent(in) :: structure
    type(transient_request_t), intent(in) :: request
    type(crank_law_t), intent(inout) :: law !! its range becomes what the motion covers
    integer, intent(in) :: number           !! of the speed
    type(link_store_t), intent(inout) :: store
    type(speed_transient_t), intent(inout) :: found
    class(keeper_t), intent(inout), optional :: keeper

    type(deformation_model_t) :: model
    type(refinement_t) :: refinement
    real(wp), allocatable :: older(:, :), before(:, :), series(:, :), missed(:)
    real(wp) :: accuracy
    integer :: reached(2)
    logical :: is_best

    call find_instants(request, law, found)
    if (.not. law%range%is_turn) call cover(structure, extremes_of(law, found%time), law%range)
    accuracy = request%response%accuracy
    refinement = refinement_t(limits, first_order(accuracy))
    found%steps = 0
    reached = 0
    do
      found%order = refinement%order
      call new_order_model(structure, found%order, store, model, found%error, law%range)
      if (allocated(found%error)) return
      if (refinement%round == 0) found%steps = first_steps(structure, request, law, &
        found%crank(1), model)
      if (work_of(request, law, found, model, found%steps) > most_work .and. &
        refinement%round >= least_rounds) then
        found%order = reached(1)
        found%steps = reached(2)
        exit
      end if
      call solve_round
      if (allocated(found%error) .or. was_interrupted()) return
      if (refinement%round + 1 >= least_rounds) then
        call evaluate(structure, request, older, before, series, missed, found)
        if (found%largest_error <= accuracy) return
        call compare(refinement, found%largest_error, is_best)
      end if
      call raise(refinement, 1, refinement%samples)
      if (.not. refinement%pending) exit
      if (allocated(before)) call move_alloc(before, older)
      call move_alloc(series, before)
      reached = [found%order, found%steps]
      ! The first two solutions, of low orders, tell how fast these converge.
      if (refinement%round > 1) found%steps = (3*found%steps + 1)/2
    end do
    if (maxval([0.0_wp, found%displacement_error]) > accuracy) then
      call set_missed(maxval(found%displacement_error), "displacements", found%error)
    else
      call set_missed(maxval(found%strain_error), "strains", found%strain_fault)
    end if

  contains

    !> A solution, or that of an earlier run.
    subroutine solve_round
      type(byte_stream_t) :: stream
      logical :: known

      associate (place => [1, refinement%round + 1, number])
        call recall_result(keeper, place, stream, known)
        if (.not. known) call solve_once(structure, request, law, model, store, before, found, &
          series, missed)
        if (.not. present(keeper)) return
        call pass_error(stream, found%error)
        call stream%pass(found%steps)
        call stream%pass(found%made)
        call stream%pass(found%taken)
        call stream%pass(found%least_error)
        call stream%pass_allocatable(found%deflection)
        call stream%pass_allocatable(series)
        call stream%pass_allocatable(missed)
        call keep_result(keeper, place, stream)
      end associate
    end subroutine solve_round

    !> Says that the accuracy is not reached.
    pure subroutine set_missed(difference, what, error)
      real(wp), intent(in) :: difference     !! estimated error
      character(len=*), intent(in) :: what
      type(error_t), allocatable, intent(out) :: error

      call set_error(error, error_of_numerics, "the accuracy asked for, "//to_string(accuracy)// &
        ", is not reached: the error of "//what//" is "//to_string(difference, 2)// &
        " with order "//to_string(found%order)//"; vibrations that the start excites are too "// &
        "fast for the steps, or too short for the order: a coarser 'accuracy=', 'ramp=' of "// &
        "SPEED or DAMPING helps")
    end subroutine set_missed

  end subroutine find_transient

  !> The positions that a motion covers, and as many beside them as derivatives need and the linkage
  !! reaches.
  subroutine cover(structure, extremes, range)
    class(structure_t), intent(in) :: structure
    real(wp), intent(in) :: extremes(2)          !! [deg] or [m]
    type(covered_range_t), intent(inout) :: range

    type(pose_t) :: pose
    type(error_t), allocatable :: lower, upper
    real(wp) :: way, from
    integer :: i

    way = merge(least_angle, least_share*maxval(structure%linkage%bodies%length), range%is_angle)
    if (any(structure%linkage%sliders%body > 0)) way = for_blocks*way
    range%from = extremes(1)
    range%to = extremes(2)
    if (range%to - range%from >= way) return
    do i = 1, 3
      ! In the middle of it, else at one of its ends.
      if (i == 1) from = 0.5_wp*(extremes(1) + extremes(2) - way)
      if (i == 2) from = extremes(1)
      if (i == 3) from = extremes(2) - way
      call find_pose(structure%linkage, from, pose, lower)
      call find_pose(structure%linkage, from + way, pose, upper)
      if (allocated(lower) .or. allocated(upper)) cycle
      range%from = from
      range%to = from + way
      return
    end do
  end subroutine cover

  !> Times of the rows, up to the end itself, with crank angles and speeds.
  pure subroutine find_instants(request, law, found)
    type(transient_request_t), intent(in) :: request
    type(crank_law_t), intent(in) :: law
    type(speed_transient_t), intent(inout) :: found

    real(wp) :: interval, motion(0:2), last, parts
    integer :: k

    if (allocated(law%program)) then
      found%time = request%time
    else
      interval = interval_of(request, law)
      last = time_of_turns(law, request%turns)
      found%time = [(k*interval, k=0, int(last/interval + slack))]
      if (last - found%time(size(found%time)) > slack*interval) found%time = [found%time, last]
    end if
    allocate (found%crank, found%rate, mold=found%time)
    do k = 1, size(found%time)
      motion = crank_motion(law, found%time(k), found%time(k))
      found%crank(k) = motion(0)
      found%rate(k) = motion(1)
      if (allocated(law%program) .or. law%ramp > 0.0_wp) cycle
      ! Parts of a turn without the rounding of times; the last may be less than one.
      parts = anint(found%time(k)/interval)
      if (abs(found%time(k) - parts*interval) <= 0.0_wp) found%crank(k) = law%start + &
        sign(360.0_wp, law%speed)*parts/request%instants
    end do
  end subroutine find_instants

  !> The time between rows, of a law the longest.
  pure function interval_of(request, law) result(interval)
    type(transient_request_t), intent(in) :: request
    type(crank_law_t), intent(in) :: law
    real(wp) :: interval !! [s]

    if (allocated(law%program)) then
      interval = maxval(request%time(2:) - request%time(:size(request%time) - 1))
    else
      interval = two_pi/(abs(law%speed)*request%instants)
    end if
  end function interval_of

  !> Polynomial degree to begin with.
  pure function first_order(accuracy) result(order)
    real(wp), intent(in) :: accuracy
    integer :: order

    order = max(6, min(4 + 2*ceiling(-0.25_wp*log10(accuracy)), 12))
  end function first_order

  !> Steps between instants to begin with, at least two: half as many more are not twice as many.
  function first_steps(structure, request, law, crank, model) result(steps)
    class(structure_t), intent(in) :: structure
    type(transient_request_t), intent(in) :: request
    type(crank_law_t), intent(in) :: law
    real(wp), intent(in) :: crank !! first angle [deg]
    type(deformation_model_t), intent(in) :: model
    integer :: steps

    type(turn_grid_t) :: grid
    logical :: reached
    integer :: wanted

    steps = 2
    call grid_at(structure, model, law%range, crank, grid, reached)
    if (.not. reached) return
    wanted = ceiling(interval_of(request, law)/(first_radians*sqrt(maxval(own_squares(grid)))))
    steps = max(steps, min(wanted, 1000))
  end function first_steps

  !> What a solution costs: matrices of all steps, of a turn once at constant speed.
  pure real(wp) function work_of(request, law, found, model, steps)
    type(transient_request_t), intent(in) :: request
    type(crank_law_t), intent(in) :: law
    type(speed_transient_t), intent(in) :: found !! with times
    type(deformation_model_t), intent(in) :: model
    integer, intent(in) :: steps                 !! between rows

    real(wp) :: rows

    rows = size(found%time)
    if (.not. constant_from(law) > found%time(size(found%time))) rows = min(rows, &
      request%instants + real(count(found%time < law%ramp), wp))
    work_of = steps*rows*max(of_terms, (real(stages, wp)*model%layout%unknowns)**3)
  end function work_of

  !> The terms at one crank angle.
  subroutine grid_at(structure, model, range, crank, grid, reached)
    class(structure_t), intent(in) :: structure
    type(deformation_model_t), intent(in) :: model
    type(covered_range_t), intent(in) :: range
    real(wp), intent(in) :: crank !! [deg]
    type(turn_grid_t), intent(out) :: grid
    logical, intent(out) :: reached !! the terms are there

    type(error_t), allocatable :: error

    call new_path_grid(structure, model, 1, grid, error, range)
    if (.not. allocated(error)) call place_grid(structure, [crank], grid, error)
    reached = .not. allocated(error)
  end subroutine grid_at

  !> One solution, as series of all quantities.
  subroutine solve_once(structure, request, law, model, store, before, found, series, missed)
    class(structure_t), intent(in) :: structure
    type(transient_request_t), intent(in) :: request
    type(crank_law_t), intent(in) :: law
    type(deformation_model_t), intent(in) :: model
    type(link_store_t), intent(inout) :: store
    real(wp), allocatable, intent(in) :: before(:, :)  !! series of the solution before, if any
    type(speed_transient_t), intent(inout) :: found    !! with order and steps
    real(wp), allocatable, intent(out) :: series(:, :) !! (instants, quantities)
    real(wp), allocatable, intent(out) :: missed(:)    !! (quantities) vibrations not followed

    type(turn_grid_t) :: grid
    type(stepping_t) :: stepping
    type(transient_motion_t) :: motion
    type(excited_vibration_t), allocatable :: vibration(:)
    type(damping_t) :: damping
    real(wp), allocatable :: start(:)
    real(wp) :: lack

    call new_path_grid(structure, model, 1, grid, found%error, law%range)
    if (allocated(found%error)) return
    damping = damping_of(request%response%damping, grid)
    call find_start(structure, request, law, found%order, grid, store, start, found%error, lack)
    if (allocated(found%error)) return
    call find_excited_vibrations(structure, request, law, found%time, start, damping, grid, &
      vibration, found%error)
    if (allocated(found%error)) return
    if (allocated(before)) call raise_steps
    call new_stepping(structure, model, law, damping, request%response%terms%axial, found%steps, &
      stepping, found%error)
    if (.not. allocated(found%error)) call solve_motion(structure, found%time, request%instants, &
      start, stepping, motion, found%error)
    found%made = found%made + motion%made
    found%taken = found%taken + motion%taken
    if (allocated(found%error) .or. was_interrupted()) return
    found%least_error = rounding + of_tail*grid%tail + safety*lack
    call find_series(structure, request, law, model, motion, found, series)
    if (allocated(found%error)) return
    missed = missed_by_steps(vibration, found%time, found%steps, stages, size(series, 2))

  contains

    !> As many steps as follow the vibrations, if these are not too many.
    subroutine raise_steps
      real(wp) :: displacement(size(request%response%points)), strain(size(request%response%gauges))
      integer :: steps, enough

      steps = found%steps
      enough = 0
      do
        call relative_errors(structure, request, missed_by_steps(vibration, found%time, steps, &
          stages, size(before, 2)), before, displacement, strain)
        ! Displacements are those of slower vibrations than strains.
        if (enough == 0 .and. maxval([displacement, 0.0_wp]) <= of_steps* &
          request%response%accuracy) enough = steps
        if (enough > 0 .and. maxval([strain, 0.0_wp]) <= of_steps*request%response%accuracy) then
          enough = steps
          exit
        end if
        steps = (3*steps + 1)/2
        if (work_of(request, law, found, model, steps) > most_raised) exit
      end do
      if (enough > 0) found%steps = enough
    end subroutine raise_steps

  end subroutine solve_once

  !> All quantities at all instants, some instants at a time.
  subroutine find_series(structure, request, law, model, motion, found, series)
    class(structure_t), intent(in) :: structure
    type(transient_request_t), intent(in) :: request
    type(crank_law_t), intent(in) :: law
    type(deformation_model_t), intent(in) :: model
    type(transient_motion_t), intent(in) :: motion
    type(speed_transient_t), intent(inout) :: found    !! with crank angles; gets deflections
    real(wp), allocatable, intent(out) :: series(:, :) !! (instants, quantities)

    type(turn_grid_t) :: grid
    real(wp), allocatable :: y(:, :), here(:, :)
    integer, allocatable :: rows(:)
    integer :: at, block, i, n

    n = size(found%crank)
    block = min(at_a_time, n)
    call new_path_grid(structure, model, block, grid, found%error, law%range)
    if (allocated(found%error)) return
    found%deflection = spread(0.0_wp, 1, size(grid%integrals))
    do at = 1, n, block
      ! The last are repeated to fill the block.
      rows = [(min(i, n), i=at, at + block - 1)]
      call place_grid(structure, found%crank(rows), grid, found%error)
      if (allocated(found%error)) return
      y = transpose(motion%state(:grid%unknowns, rows))
      found%deflection = max(found%deflection, sampled_deflections(grid, y))
      here = quantities_of(grid, request%response, y)
      if (at == 1) allocate (series(n, size(here, 2)))
      series(at:min(at + block - 1, n), :) = here(:min(block, n + 1 - at), :)
    end do
  end subroutine find_series

  !> Values and errors from the last three solutions.
  subroutine evaluate(structure, request, older, before, series, missed, found)
    class(structure_t), intent(in) :: structure
    type(transient_request_t), intent(in) :: request
    real(wp), intent(in) :: older(:, :), before(:, :), series(:, :) !! (instants, quantities)
    real(wp), intent(in) :: missed(:) !! (quantities) by steps
    type(speed_transient_t), intent(inout) :: found

    real(wp) :: change(size(series, 2))
    integer :: first, i, k, n

    n = size(series, 1)
    change = missed + safety*what_remains(maxval(abs(series - before), dim=1), maxval(abs(before - &
      older), dim=1), found%order)
    associate (points => request%response%points, gauges => request%response%gauges)
      found%displacement = reshape([((series(k, of_point*(i - 1) + 1:of_point*i), i=1, &
        size(points)), k=1, n)], [of_point, size(points), n])
      found%displacement_error = spread(0.0_wp, 1, size(points))
      found%strain_error = spread(0.0_wp, 1, size(gauges))
      if (allocated(found%strain)) deallocate (found%strain)
      allocate (found%strain(strain_values, size(gauges), n))
      do i = 1, size(gauges)
        first = of_point*size(points) + of_gauge*(i - 1) + 1
        do k = 1, n
          found%strain(:, i, k) = gauge_values_of(gauges(i), &
            structure%elastic%beams(gauges(i)%body), request%response%section(gauges(i)%body), &
            series(k, first), series(k, first + 1))
        end do
      end do
    end associate
    call relative_errors(structure, request, change, series, found%displacement_error, &
      found%strain_error)
    found%displacement_error = found%displacement_error + found%least_error
    found%strain_error = found%strain_error + found%least_error
    found%largest_error = maxval([found%displacement_error, found%strain_error, 0.0_wp])
  end subroutine evaluate

  !> Errors of points and gauges from those of their quantities, relative to the largest values.
  subroutine relative_errors(structure, request, change, series, displacement, strain)
    class(structure_t), intent(in) :: structure
    type(transient_request_t), intent(in) :: request
    real(wp), intent(in) :: change(:)        !! (quantities) errors
    real(wp), intent(in) :: series(:, :)     !! (instants, quantities)
    real(wp), intent(out) :: displacement(:) !! (points)
    real(wp), intent(out) :: strain(:)       !! (gauges)

    real(wp) :: largest(size(series, 2)), far(size(displacement)), least, tension, bend, turn
    integer :: first, i

    largest = maxval(abs(series), dim=1)
    do i = 1, size(displacement)
      first = of_point*(i - 1) + 1
      far(i) = sqrt(maxval(series(:, first)**2 + series(:, first + 1)**2))
    end do
    ! What the drive holds does not move but for rounding.
    far = max(far, of_rounding*maxval([0.0_wp, far]), tiny(1.0_wp))
    turn = max(of_rounding*maxval([0.0_wp, largest(of_point:of_point*size(far):of_point)]), &
      tiny(1.0_wp))
    do i = 1, size(displacement)
      first = of_point*(i - 1) + 1
      displacement(i) = max(norm2(change(first:first + 1))/far(i), change(first + 2)/ &
        max(largest(first + 2), by_nature*far(i)/structure%elastic%linkage%bodies( &
        request%response%points(i)%body)%length, turn))
    end do
    do i = 1, size(strain)
      first = of_point*size(displacement) + of_gauge*(i - 1) + 1
      associate (outer => request%response%section(request%response%gauges(i)%body)%outer)
        tension = change(first)
        bend = outer*change(first + 1)
        least = max(by_nature*(largest(first) + outer*largest(first + 1)), tiny(1.0_wp))
        ! The stress has the errors of both.
        strain(i) = max(tension/max(largest(first), least), bend/max(outer*largest(first + 1), &
          least), (tension + bend)/max(maxval(abs(series(:, first)) + outer*abs(series(:, first + &
          1))), least))
      end associate
    end do
  end subroutine relative_errors

  !> What solutions of higher orders would change yet, from the changes by the last two orders:
  !! errors fall as a power of the order, `C n^(-p)`, whose differences these are. Not less than
  !! the last.
  elemental function what_remains(last, before, order) result(rest)
    real(wp), intent(in) :: last, before
    integer, intent(in) :: order !! of the last
    real(wp) :: rest

    real(wp) :: high, low, p, r(3)
    integer :: i

    rest = last
    if (last <= tiny(last)) return
    ! Lowest order first, as shares of the last.
    r = real(order - [4, 2, 0], wp)/order
    low = slowest
    high = fastest
    do i = 1, 40
      p = 0.5_wp*(low + high)
      if (last*(r(1)**(-p) - r(2)**(-p)) < before*(r(2)**(-p) - 1.0_wp)) then
        low = p
      else
        high = p
      end if
    end do
    rest = max(last, last/(r(2)**(-low) - 1.0_wp))
  end function what_remains

end module transient_responses
