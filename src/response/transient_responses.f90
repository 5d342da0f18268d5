!> The elastic motion in time from a state at prescribed motion of the crank, with estimated errors.
!!
!! Every speed is solved with orders and steps that rise from one solution to the next, orders by
!! two, steps by half: the difference of the last two bounds the error of the last. Vibrations too
!! fast for the steps, or beyond the orders, differ from one solution to the next: what they are of
!! the motion is in the difference.
module transient_responses
  use beam_mesh, only: beam_t
  use constants, only: two_pi
  use crank_laws, only: crank_angle_at, crank_law_t, time_of_turns
  use deformation_model, only: deformation_model_t
  use errors, only: error_of_numerics, error_t, set_error
  use gauge_values, only: gauge_values_of
  use interruption, only: was_interrupted
  use kinds, only: long, wp
  use link_store, only: link_store_t
  use linkages, only: linkage_t
  use part_requests, only: request_of_parts
  use path_grids, only: new_path_grid, place_grid
  use response_levels, only: damping_of, new_order_model
  use response_series, only: gauge_series, point_series, strains_along
  use response_types, only: strain_values
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

  !> Estimated errors are differences of two solutions times this: enough where the error of the
  !! last is up to two thirds of that before. None is stated below the rounding of the whole.
  real(wp), parameter :: safety = 2.0_wp, rounding = 1.0e-12_wp

  !> First steps: radians of the slowest vibration in one, at most.
  real(wp), parameter :: first_radians = 0.6_wp

  !> Orders are raised by this each time, steps by half, so many times at most.
  integer, parameter :: orders_above = 2, most_rounds = 8, most_order = 34

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
    integer :: k

    of_bodies = request
    if (allocated(structure%elastic)) of_bodies%response = request_of_parts(structure%elastic, &
      request%response)
    allocate (transient%at_speed(size(request%response%speed)))
    do k = 1, size(transient%at_speed)
      if (was_interrupted()) exit
      call find_transient(structure, of_bodies, crank_law_t(request%crank, &
        request%response%speed(k), request%ramp), store, transient%at_speed(k))
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
    real(wp), allocatable :: before(:, :), series(:, :)
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
      if (round == 1) found%steps = first_steps(structure, request, law, model)
      work = found%steps*real(size(found%time), wp)*(real(stages, wp)*model%layout%unknowns)**3
      if (.not. law%ramp > found%time(size(found%time))) work = min(work, (found%steps* &
        (request%instants + real(count(found%time < law%ramp), wp)))*(real(stages, wp)* &
        model%layout%unknowns)**3)
      if (work > most_work .and. round > 2) then
        found%order = reached(1)
        found%steps = reached(2)
        exit
      end if
      call solve_once(structure, request, law, model, store, found, series)
      if (allocated(found%error) .or. was_interrupted()) return
      if (round > 1) then
        call evaluate(structure, request, before, series, found)
        if (found%largest_error <= accuracy) return
        idle = merge(0, idle + 1, found%largest_error <= least_gain*last_error)
        last_error = found%largest_error
        if (idle >= most_idle) exit
      end if
      if (round == most_rounds .or. found%order + orders_above > most_order) exit
      call move_alloc(series, before)
      reached = [found%order, found%steps]
      found%order = found%order + orders_above
      found%steps = (3*found%steps + 1)/2
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

  !> Times and crank angles of the rows.
  pure subroutine find_instants(request, law, found)
    type(transient_request_t), intent(in) :: request
    type(crank_law_t), intent(in) :: law
    type(speed_transient_t), intent(inout) :: found

    real(wp) :: interval
    integer :: k

    interval = two_pi/(abs(law%speed)*request%instants)
    found%time = [(k*interval, k=0, int(time_of_turns(law, request%turns)/interval + slack))]
    found%crank = crank_angle_at(law, found%time)
  end subroutine find_instants

  !> Polynomial degree to begin with.
  pure function first_order(accuracy) result(order)
    real(wp), intent(in) :: accuracy
    integer :: order

    order = max(6, min(6 + 2*ceiling(-0.25_wp*log10(accuracy)), 14))
  end function first_order

  !> Steps between instants to begin with, at least two: half as many more are not twice as many.
  function first_steps(structure, request, law, model) result(steps)
    class(structure_t), intent(in) :: structure
    type(transient_request_t), intent(in) :: request
    type(crank_law_t), intent(in) :: law
    type(deformation_model_t), intent(in) :: model
    integer :: steps

    type(turn_grid_t) :: grid
    type(crank_law_t) :: own
    logical :: reached
    integer :: wanted

    own = law
    steps = 2
    call grid_at(structure, model, own%start, grid, reached)
    if (.not. reached) return
    wanted = ceiling(two_pi/(abs(law%speed)*request%instants*first_radians* &
      sqrt(maxval(own_squares(grid)))))
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

    call new_path_grid(structure, model, 1, grid, found%error)
    if (allocated(found%error)) return
    damping = damping_of(request%response%damping, grid)
    call find_start(structure, request, law, found%order, grid, store, start, found%error)
    if (allocated(found%error)) return
    call solve_motion(structure, model, law, damping, request%response%terms%axial, &
      found%time, request%instants, found%steps, start, motion, found%error)
    found%made = found%made + motion%made
    found%taken = found%taken + motion%taken
    if (allocated(found%error) .or. was_interrupted()) return
    call find_series(structure, request, found%crank, model, motion, series, found%error)
  end subroutine solve_once

  !> All quantities at all instants, some instants at a time.
  subroutine find_series(structure, request, crank, model, motion, series, error)
    class(structure_t), intent(in) :: structure
    type(transient_request_t), intent(in) :: request
    real(wp), intent(in) :: crank(:) !! (instants) [deg]
    type(deformation_model_t), intent(in) :: model
    type(transient_motion_t), intent(in) :: motion
    real(wp), allocatable, intent(out) :: series(:, :) !! (instants, quantities)
    type(error_t), allocatable, intent(out) :: error

    type(turn_grid_t) :: grid
    real(wp), allocatable :: y(:, :), axial(:, :), curvature(:, :), moved(:, :)
    integer, allocatable :: rows(:)
    integer :: at, block, first, i, n

    block = min(at_a_time, size(crank))
    call new_path_grid(structure, model, block, grid, error)
    if (allocated(error)) return
    allocate (axial(block, 1), curvature(block, 1))
    associate (points => request%response%points, gauges => request%response%gauges)
      allocate (series(size(crank), of_point*size(points) + of_gauge*size(gauges)))
      do at = 1, size(crank), block
        ! The last are repeated to fill the block.
        rows = [(min(i, size(crank)), i=at, at + block - 1)]
        n = min(block, size(crank) + 1 - at)
        call place_grid(structure, crank(rows), grid, error)
        if (allocated(error)) return
        y = transpose(motion%state(:grid%unknowns, rows))
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

  !> Values and errors from the last two solutions.
  subroutine evaluate(structure, request, before, series, found)
    class(structure_t), intent(in) :: structure
    type(transient_request_t), intent(in) :: request
    real(wp), intent(in) :: before(:, :), series(:, :) !! (instants, quantities)
    type(speed_transient_t), intent(inout) :: found

    type(linkage_t) :: linkage
    type(beam_t), allocatable :: beams(:)
    real(wp) :: change(size(series, 2)), largest(size(series, 2)), length, strain
    integer :: first, i, k, n

    linkage = vibrating_linkage(structure)
    beams = vibrating_beams(structure)
    n = size(series, 1)
    change = maxval(abs(series - before), dim=1)
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
          strain = largest(first) + section%outer*largest(first + 1)
          found%strain_error(i) = max(change(first)/max(largest(first), by_nature*strain, &
            tiny(1.0_wp)), section%outer*change(first + 1)/max(section%outer*largest(first + 1), &
            by_nature*strain, tiny(1.0_wp)))
        end associate
      end do
    end associate
    found%displacement_error = safety*found%displacement_error + rounding
    found%strain_error = safety*found%strain_error + rounding
    found%largest_error = max(maxval([0.0_wp, found%displacement_error]), maxval([0.0_wp, &
      found%strain_error]))
  end subroutine evaluate

end module transient_responses
