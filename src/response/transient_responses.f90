!> The elastic motion in time from a state at prescribed motion of the crank, with estimated errors.
!!
!! Every speed is solved with orders and steps that rise from one solution to the next, orders by
!! two, steps by half. Vibrations too fast for the steps, or beyond the orders, differ from one
!! solution to the next. A sudden start excites all of them, and strains then converge as slowly as
!! a power of the order: not the last difference bounds the error, but the sum of those that would
!! follow, which three solutions tell.
module transient_responses
  use beam_mesh, only: beam_t
  use constants, only: two_pi
  use crank_laws, only: constant_from, crank_law_t, crank_motion, time_of_turns
  use deformation_model, only: deformation_model_t
  use errors, only: error_of_numerics, error_t, set_error
  use gauge_values, only: gauge_values_of
  use interruption, only: was_interrupted
  use kinds, only: long, wp
  use link_store, only: link_store_t
  use linkages, only: linkage_t
  use part_requests, only: join_largest, request_of_parts
  use path_grids, only: new_path_grid, place_grid
  use response_levels, only: damping_of, new_order_model
  use response_peaks, only: sampled_deflections
  use response_series, only: gauge_series, point_series, strains_along
  use response_types, only: strain_values, stress
  use slow_motions, only: own_squares
  use structures, only: structure_t, vibrating_beams, vibrating_linkage
  use text, only: to_string
  use transient_motions, only: solve_motion, stages, transient_motion_t
  use transient_starts, only: find_start
  use transient_types, only: speed_transient_t, transient_request_t, transient_t
  use turn_grids, only: moves, turn_grid_t
  implicit none (type, external)
  private

  public :: find_transients

  !> Estimated errors are what differences of solutions leave, or the last of these, times this.
  !! None is stated below the rounding of the whole, and below so much of the highest harmonics of
  !! the path, or what a steady state lacks from which it starts.
  real(wp), parameter :: safety = 2.0_wp, rounding = 1.0e-12_wp, of_tail = 100.0_wp

  !> Slowest and fastest powers of the order by which errors are taken to fall.
  real(wp), parameter :: slowest = 0.5_wp, fastest = 50.0_wp

  !> First steps: radians of the slowest vibration in one, at most.
  real(wp), parameter :: first_radians = 0.6_wp

  !> Orders are raised by this each time, steps by half, so many times at most; errors are estimated
  !! from so many solutions on.
  integer, parameter :: orders_above = 2, most_rounds = 9, most_order = 34, least_rounds = 3

  !> No solution is begun that takes more than this: steps × (unknowns × stages)³, about a minute.
  real(wp), parameter :: most_work = 1.0e11_wp

  !> Errors are to fall by this from one solution to the next; where they do not so many times, one
  !! after another, more of the same does not help.
  real(wp), parameter :: least_gain = 0.8_wp
  integer, parameter :: most_idle = 2

  !> A quantity smaller than this beside what goes with it is taken for zero by its nature.
  real(wp), parameter :: by_nature = 1.0e-3_wp

  !> Instants whose places are found together.
  integer, parameter :: at_a_time = 128

  !> A row that would stand so little after the end, in steps between rows, stands at it.
  real(wp), parameter :: slack = 1.0e-9_wp

  !> Quantities at all instants, in the order points (x, y, rotation), gauges (axial strain,
  !! curvature).
  integer, parameter :: of_point = 3, of_gauge = 2

contains

  !> The motion at every speed, or why there is none.
  subroutine find_transients(structure, request, store, transient)
    class(structure_t), intent(in) :: structure        !! linkage and beams
    type(transient_request_t), intent(in) :: request
    type(link_store_t), intent(inout) :: store         !! links decomposed earlier
    type(transient_t), intent(out) :: transient        !! with a result or an error at every speed

    type(transient_request_t) :: of_bodies
    type(crank_law_t) :: law
    integer :: k

    of_bodies = request
    if (allocated(structure%elastic)) of_bodies%response = request_of_parts(structure%elastic, &
      request%response)
    allocate (transient%at_speed(size(request%response%speed)))
    do k = 1, size(transient%at_speed)
      if (was_interrupted()) exit
      law = crank_law_t(request%crank, request%response%speed(k), request%ramp)
      if (allocated(request%program)) law%program = request%program
      call find_transient(structure, of_bodies, law, store, transient%at_speed(k))
      if (allocated(structure%elastic)) call join_largest(structure%elastic, &
        size(structure%linkage%bodies), transient%at_speed(k)%deflection)
    end do
  end subroutine find_transients

  !> Solutions one after another until two agree.
  subroutine find_transient(structure, request, law, store, found)
    class(structure_t), intent(in) :: structure
    type(transient_request_t), intent(in) :: request
    type(crank_law_t), intent(in) :: law
    type(link_store_t), intent(inout) :: store
    type(speed_transient_t), intent(inout) :: found

    type(deformation_model_t) :: model
    real(wp), allocatable :: older(:, :), before(:, :), series(:, :)
    real(wp) :: work, accuracy, last_error
    integer :: round, idle, reached(2)

    call find_instants(request, law, found)
    accuracy = request%response%accuracy
    found%order = first_order(accuracy)
    found%steps = 0
    reached = 0
    idle = 0
    last_error = huge(1.0_wp)
    do round = 1, most_rounds
      call new_order_model(structure, found%order, store, model, found%error)
      if (allocated(found%error)) return
      if (round == 1) found%steps = first_steps(structure, request, law, &
        found%crank(1), model)
      work = found%steps*real(size(found%time), wp)*(real(stages, wp)*model%layout%unknowns)**3
      if (.not. constant_from(law) > found%time(size(found%time))) work = min(work, (found%steps* &
        (request%instants + real(count(found%time < law%ramp), wp)))*(real(stages, wp)* &
        model%layout%unknowns)**3)
      if (work > most_work .and. round > least_rounds) then
        found%order = reached(1)
        found%steps = reached(2)
        exit
      end if
      call solve_once(structure, request, law, model, store, found, series)
      if (allocated(found%error) .or. was_interrupted()) return
      if (round >= least_rounds) then
        call evaluate(structure, request, older, before, series, found)
        if (found%largest_error <= accuracy) return
        idle = merge(0, idle + 1, found%largest_error <= least_gain*last_error)
        last_error = found%largest_error
        if (idle >= most_idle) exit
      end if
      if (round == most_rounds .or. found%order + orders_above > most_order) exit
      if (allocated(before)) call move_alloc(before, older)
      call move_alloc(series, before)
      reached = [found%order, found%steps]
      found%order = found%order + orders_above
      ! The first two solutions, of low orders, tell how fast these converge.
      if (round > 1) found%steps = (3*found%steps + 1)/2
    end do
    if (maxval([0.0_wp, found%displacement_error]) > accuracy) then
      call set_missed(maxval(found%displacement_error), "displacements", found%error)
    else
      call set_missed(maxval(found%strain_error), "strains", found%strain_fault)
    end if

  contains

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

  !> Times of the rows, up to the end itself, with crank angles and speeds.
  pure subroutine find_instants(request, law, found)
    type(transient_request_t), intent(in) :: request
    type(crank_law_t), intent(in) :: law
    type(speed_transient_t), intent(inout) :: found

    real(wp) :: interval, motion(0:2), last
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
    call grid_at(structure, model, crank, grid, reached)
    if (.not. reached) return
    wanted = ceiling(interval_of(request, law)/(first_radians*sqrt(maxval(own_squares(grid)))))
    steps = max(steps, min(wanted, 1000))
  end function first_steps

  !> The terms at one crank angle.
  subroutine grid_at(structure, model, crank, grid, reached)
    class(structure_t), intent(in) :: structure
    type(deformation_model_t), intent(in) :: model
    real(wp), intent(in) :: crank !! [deg]
    type(turn_grid_t), intent(out) :: grid
    logical, intent(out) :: reached !! the terms are there

    type(error_t), allocatable :: error

    call new_path_grid(structure, model, 1, grid, error)
    if (.not. allocated(error)) call place_grid(structure, [crank], grid, error)
    reached = .not. allocated(error)
  end subroutine grid_at

  !> One solution, as series of all quantities.
  subroutine solve_once(structure, request, law, model, store, found, series)
    class(structure_t), intent(in) :: structure
    type(transient_request_t), intent(in) :: request
    type(crank_law_t), intent(in) :: law
    type(deformation_model_t), intent(in) :: model
    type(link_store_t), intent(inout) :: store
    type(speed_transient_t), intent(inout) :: found  !! with order and steps
    real(wp), allocatable, intent(out) :: series(:, :) !! (instants, quantities)

    type(turn_grid_t) :: grid
    type(transient_motion_t) :: motion
    real(wp), allocatable :: start(:), damping(:)
    real(wp) :: lack

    call new_path_grid(structure, model, 1, grid, found%error)
    if (allocated(found%error)) return
    damping = damping_of(request%response%damping, grid)
    call find_start(structure, request, law, found%order, grid, store, start, found%error, lack)
    if (allocated(found%error)) return
    call solve_motion(structure, model, law, damping, request%response%terms%axial, &
      found%time, request%instants, found%steps, start, motion, found%error)
    found%made = found%made + motion%made
    found%taken = found%taken + motion%taken
    if (allocated(found%error) .or. was_interrupted()) return
    found%least_error = rounding + of_tail*grid%tail + safety*lack
    call find_series(structure, request, found%crank, model, motion, series, found%deflection, &
      found%error)
  end subroutine solve_once

  !> All quantities at all instants, some instants at a time.
  subroutine find_series(structure, request, crank, model, motion, series, deflection, error)
    class(structure_t), intent(in) :: structure
    type(transient_request_t), intent(in) :: request
    real(wp), intent(in) :: crank(:) !! (instants) [deg]
    type(deformation_model_t), intent(in) :: model
    type(transient_motion_t), intent(in) :: motion
    real(wp), allocatable, intent(out) :: series(:, :) !! (instants, quantities)
    real(wp), allocatable, intent(out) :: deflection(:) !! (bodies) largest [m]
    type(error_t), allocatable, intent(out) :: error

    type(turn_grid_t) :: grid
    real(wp), allocatable :: y(:, :), axial(:, :), curvature(:, :), moved(:, :)
    integer, allocatable :: rows(:)
    integer :: at, block, first, i, n

    block = min(at_a_time, size(crank))
    call new_path_grid(structure, model, block, grid, error)
    if (allocated(error)) return
    allocate (axial(block, 1), curvature(block, 1), deflection(size(grid%integrals)), &
      source=0.0_wp)
    associate (points => request%response%points, gauges => request%response%gauges)
      allocate (series(size(crank), of_point*size(points) + of_gauge*size(gauges)))
      do at = 1, size(crank), block
        ! The last are repeated to fill the block.
        rows = [(min(i, size(crank)), i=at, at + block - 1)]
        n = min(block, size(crank) + 1 - at)
        call place_grid(structure, crank(rows), grid, error)
        if (allocated(error)) return
        y = transpose(motion%state(:grid%unknowns, rows))
        deflection = max(deflection, sampled_deflections(grid, y))
        do i = 1, size(points)
          first = of_point*(i - 1) + 1
          moved = point_series(grid, points(i)%body, points(i)%place, y)
          series(at:at + n - 1, first:first + 2) = moved(:n, :)
        end do
        do i = 1, size(gauges)
          first = of_point*size(points) + of_gauge*(i - 1) + 1
          if (moves(grid, gauges(i)%body)) then
            moved = gauge_series(grid, gauges(i)%body, gauges(i)%xi, y)
            series(at:at + n - 1, first:first + 1) = moved(:n, :2)
            cycle
          end if
          call strains_along(grid, gauges(i)%body, [gauges(i)%xi], y, axial, curvature)
          series(at:at + n - 1, first) = axial(:n, 1)
          series(at:at + n - 1, first + 1) = curvature(:n, 1)
        end do
      end do
    end associate
  end subroutine find_series

  !> Values and errors from the last three solutions.
  subroutine evaluate(structure, request, older, before, series, found)
    class(structure_t), intent(in) :: structure
    type(transient_request_t), intent(in) :: request
    real(wp), intent(in) :: older(:, :), before(:, :), series(:, :) !! (instants, quantities)
    type(speed_transient_t), intent(inout) :: found

    type(linkage_t) :: linkage
    type(beam_t), allocatable :: beams(:)
    real(wp) :: change(size(series, 2)), largest(size(series, 2)), length, strain, tension, bend
    integer :: first, i, k, n

    linkage = vibrating_linkage(structure)
    beams = vibrating_beams(structure)
    n = size(series, 1)
    change = what_remains(maxval(abs(series - before), dim=1), maxval(abs(before - older), dim=1), &
      found%order)
    largest = maxval(abs(series), dim=1)
    associate (points => request%response%points, gauges => request%response%gauges)
      found%displacement = reshape([((series(k, of_point*(i - 1) + 1:of_point*i), i=1, &
        size(points)), k=1, n)], [of_point, size(points), n])
      found%displacement_error = spread(0.0_wp, 1, size(points))
      do i = 1, size(points)
        first = of_point*(i - 1) + 1
        length = sqrt(maxval(series(:, first)**2 + series(:, first + 1)**2))
        found%displacement_error(i) = max(norm2(change(first:first + 1))/max(length, &
          tiny(1.0_wp)), change(first + 2)/max(largest(first + 2), by_nature*length/ &
          linkage%bodies(points(i)%body)%length, tiny(1.0_wp)))
      end do
      found%strain_error = spread(0.0_wp, 1, size(gauges))
      if (allocated(found%strain)) deallocate (found%strain)
      allocate (found%strain(strain_values, size(gauges), n))
      do i = 1, size(gauges)
        first = of_point*size(points) + of_gauge*(i - 1) + 1
        associate (gauge => gauges(i), section => request%response%section(gauges(i)%body))
          do k = 1, n
            found%strain(:, i, k) = gauge_values_of(gauge, beams(gauge%body), section, &
              series(k, first), series(k, first + 1))
          end do
          strain = max(by_nature*(largest(first) + section%outer*largest(first + 1)), tiny(1.0_wp))
          tension = change(first)
          bend = section%outer*change(first + 1)
          ! The stress has the errors of both.
          found%strain_error(i) = max(tension/max(largest(first), strain), &
            bend/max(section%outer*largest(first + 1), strain), (tension + bend)/ &
            max(maxval(abs(found%strain(stress, i, :)))/section%modulus, strain))
        end associate
      end do
    end associate
    found%displacement_error = safety*found%displacement_error + found%least_error
    found%strain_error = safety*found%strain_error + found%least_error
    found%largest_error = max(maxval([0.0_wp, found%displacement_error]), maxval([0.0_wp, &
      found%strain_error]))
  end subroutine evaluate

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
