!> The steady elastic response of a linkage whose crank turns at constant speed, with estimated
!! errors.
!!
!! Every speed is solved twice: with the orders and samples chosen, and, starting from that
!! solution, with orders higher by two and half as many samples more. The first is the result, the
!! difference its error. Where that exceeds the accuracy, orders or samples are raised, whichever is
!! to blame.
module steady_responses
  use byte_streams, only: byte_stream_t
  use constants, only: degree, two_pi
  use elastic_equations, only: deformations_of, load_at_speed, strain_rates
  use equations_at_speed, only: equation_at_speed_t
  use errors, only: error_of_numerics, error_t, set_error
  use floquet_exponents, only: find_nearest_mode, floquet_mode_t
  use fourier_transform, only: close_fourier, coefficients_of, derivatives, fourier_plan_t, &
    open_fourier, resample, resampled, value_at, values_of
  use gauge_values, only: gauge_values_of
  use kept_results, only: keep_result, keeper_t, recall_result
  use kinds, only: long, wp
  use link_loads, only: buckling_shares
  use link_store, only: link_store_t
  use order_transfer, only: transferred
  use out_of_plane, only: find_out_of_plane_frequency
  use periodic_solver, only: solve_periodic
  use quadratic_change, only: find_quadratic_change
  use refinements, only: add_work, begin_round, compare, most_samples, raise, refinement_limits_t, &
    refinement_t, repeat_round, sample_numbers, samples_on
  use response_bytes, only: pass_refinement, pass_response
  use response_levels, only: level_slot_t, level_t, need_basis, need_level, need_levels, &
    set_equation
  use response_peaks, only: find_peaks, sampled_deflections
  use response_series, only: first_of_gauge, first_of_point, first_of_torque, place_series, &
    find_values_on_pieces, response_series_of, series_count, strains_along
  use response_types, only: drive_values, no_damping, peak_t, power, quadratic_torque, &
    response_request_t, response_t, rigid_torque, speed_response_t, strain_values, total_torque
  use sorting, only: ascending_order
  use slow_bases, only: own_squares, slow_count
  use slow_motions, only: new_slow_motion, slow_motion_t
  use strain_dampings, only: damping_t, shares_of
  use structures, only: structure_t
  use text, only: to_string
  use turn_grids, only: moves, sense_of, turn_grid_t
  implicit none (type, external)
  private

  public :: find_steady_responses

  !> The second solution lacks at most so many times its last change; and in a quantity of its own
  !! so many times what it lacks in all.
  real(wp), parameter :: many = 10.0_wp

  !> Remainders above this are none of rounding.
  real(wp), parameter :: unfinished = 1.0e-9_wp

  !> Where errors may be those of rounding, the second time that they do not fall the best result so
  !! far is the last word. The work at a speed takes some twenty seconds.
  type(refinement_limits_t), parameter :: limits = refinement_limits_t(order=34, rounds=8, &
    work=40000000_long, gain=0.5_wp, idle=2, rounding=1.0e-6_wp)

  !> Samples of the second solution in a period of the slowest modes, at their mean frequency, up to
  !! a limit: their harmonics may rise again beyond those that have fallen.
  real(wp), parameter :: samples_of_free = 4.0_wp, most_of_free = 1024.0_wp

  !> Accuracy that the samples to begin with are at least chosen for: with fewer the iterations
  !! converge slowly or not at all, which takes longer.
  real(wp), parameter :: coarsest = 1.0e-6_wp

  !> Slow vibrations have at least this many samples a period; where the iterations do not get on,
  !! so many of the samples of the second solution, up to twice those of the first: all vibrations
  !! that its harmonics meet are then slow ones.
  real(wp), parameter :: samples_a_period = 2.5_wp, least_a_period = 2.0_wp

  !> Stages of the collocation of slow motions.
  integer, parameter :: stages = 3

  !> Estimated errors are differences of two solutions times this: enough where the error of the
  !! second is up to four fifths of that of the first. Errors of strains fall slowly with the orders
  !! where a link's damping is by ratio.
  real(wp), parameter :: safety = 5.0_wp

  !> Remainders of the iterations beside the accuracy: smaller in the second solution, so that the
  !! difference shows that of the first in every quantity. Below the least there is rounding of the
  !! equation, in which iterations would go on and on.
  real(wp), parameter :: solved_to = 1.0e-3_wp, compared_to = 1.0e-5_wp, &
    least_remainder = 1.0e-13_wp

  !> They are as for this accuracy where that asked for is coarser.
  real(wp), parameter :: coarsest_iterations = 1.0e-4_wp

  !> No error is stated smaller than this share of the accuracy, or of that if the accuracy is
  !! coarser: at a place along a link both solutions may happen to be equally wrong.
  real(wp), parameter :: least_share = 0.1_wp, coarsest_share = 1.0e-7_wp

  !> Iterations have stagnated if they stop above their tolerance and this, which rounding does not
  !! reach. The residual says little of quantities of high harmonics or of stiff links.
  real(wp), parameter :: stuck = 1.0e-11_wp

  !> Slow motions that grow too much are believed with so many times raised samples.
  integer, parameter :: enough_rounds = 3

  !> The highest eighth of the harmonics of a series may have this share of the accuracy; they are
  !! taken to fall at least this fast.
  real(wp), parameter :: tail_share = 0.3_wp, slowest_fall = 0.02_wp

  !> Larger errors are none of the orders.
  real(wp), parameter :: of_orders = 1.0e-2_wp

  !> Errors of strains fall about so much with two orders.
  real(wp), parameter :: gain_of_orders = 30.0_wp

  !> Where an accuracy is not reached errors do not fall as they should, and two solutions may lack
  !! the same vibration near resonance: estimates count so many times.
  real(wp), parameter :: not_reached = 3.0_wp

  !> Larger errors, above the coarsest accuracy that may be asked for, are no estimates any more.
  real(wp), parameter :: no_digits = 1.0e-2_wp

  !> Multipliers nearer to 1 than this are found from the whole equation.
  real(wp), parameter :: near = 0.05_wp

  !> A quantity smaller than this beside what goes with it is taken for zero by its nature.
  real(wp), parameter :: by_nature = 1.0e-3_wp

  !> Errors of which more than this share is what the iterations left are theirs.
  real(wp), parameter :: of_iterations = 0.1_wp

  !> Rounding of a solution, with no resonance near.
  real(wp), parameter :: rounding = 3.0e-13_wp

  !> Remainder of the iterations for quadratic terms beside the accuracy, and the least. On the
  !! second level, which starts from the first, it is smaller by this: else both lack the same.
  real(wp), parameter :: change_share = 1.0e-3_wp, least_change = 1.0e-9_wp, compared_change = &
    1.0e-2_wp

  !> Changes of quadratic terms count at least this share of the largest of any link.
  real(wp), parameter :: share_of_all = 0.1_wp

  !> What else is chosen at a speed.
  type :: choice_t
    integer :: slow = 0            !! slow coordinates
    logical :: more_slow = .false. !! as many as `least_a_period` has them
    logical :: tightened = .false. !! iterations go on to smaller remainders
    logical :: raised_order = .false.           !! last time
    type(speed_response_t), allocatable :: best !! result with the smallest error so far
  end type choice_t

  !> One solution at a speed.
  type :: solution_t
    real(wp), allocatable :: y(:, :)      !! (samples, unknowns)
    real(wp), allocatable :: last_change(:, :) !! of y, by the iterations
    real(wp), allocatable :: series(:, :) !! coefficients of the series
    integer :: applications = 0
    real(wp) :: remainder = 0.0_wp
  end type solution_t

contains

  !> Finds the response at all speeds.
  !!
  !! Errors: the crank does not turn fully; own modes of a link could not be found. Those of a speed
  !! are in its result.
  subroutine find_steady_responses(structure, request, threads, store, response, error, keeper)
    class(structure_t), intent(in) :: structure       !! linkage and beams
    type(response_request_t), intent(in) :: request   !! speeds, places, accuracy
    integer, intent(in) :: threads                    !! number of OpenMP threads
    type(link_store_t), intent(inout) :: store        !! links decomposed earlier
    type(response_t), intent(out) :: response
    type(error_t), allocatable, intent(out) :: error  !! why there is no response at any speed
    class(keeper_t), intent(inout), optional :: keeper !! of results at speeds, a round each

    type(level_slot_t), allocatable :: levels(:)
    type(refinement_t) :: refinement(size(request%speed))
    type(choice_t) :: choice(size(request%speed))
    real(wp), allocatable :: squares(:)
    integer :: first, free, round, k

    allocate (response%at_speed(size(choice)), levels(0))
    refinement%limits = limits
    refinement%backwards = request%speed < 0.0_wp
    refinement%order = first_order(request%accuracy)
    call need_level(structure, refinement(1)%order, sample_numbers(1), .false., store, levels, &
      first, error)
    if (allocated(error)) return
    squares = own_squares(levels(first)%level%grid)
    squares = squares(ascending_order(-squares))
    refinement%samples = first_samples(request%speed*sqrt(squares(1)), min(request%accuracy, &
      coarsest))
    ! Without damping, passages through resonance leave free vibrations of several modes behind: the
    ! second solution is to see those that the first cannot.
    free = min(merge(1, 3, any(request%damping%kind /= no_damping)), size(squares))
    refinement%least_above = samples_of(samples_of_free/max(abs(request%speed)*sqrt( &
      squares(free)), tiny(1.0_wp)), most_of_free)
    round = 0
    do while (any(refinement%pending))
      round = round + 1
      call need_levels(structure, refinement, store, levels, error)
      if (allocated(error)) return
      do k = 1, size(choice)
        if (refinement(k)%pending) call find_bases(request, abs(request%speed(k)), refinement(k), &
          levels, choice(k), error)
        if (allocated(error)) return
      end do
      !$omp parallel do num_threads(threads) schedule(dynamic) default(shared) private(k)
      do k = 1, size(choice)
        call find_at_speed(k)
      end do
      !$omp end parallel do
    end do
    if (request%validity) call add_out_of_plane(structure, response)

  contains

    !> A round at a speed, if one is pending: solved, or what an earlier run has found in it.
    subroutine find_at_speed(k)
      integer, intent(in) :: k

      type(byte_stream_t) :: stream
      logical :: begun, known

      associate (here => refinement(k))
        call begin_round(here, begun)
        if (.not. begun) return
        call recall_result(keeper, [1, round, k], stream, known)
        if (.not. known) call solve_speed(structure, request, abs(request%speed(k)), &
          levels(here%level(1))%level, levels(here%level(2))%level, here, choice(k), &
          response%at_speed(k))
        if (.not. present(keeper)) return
        call pass_refinement(stream, here)
        call pass_choice(stream, choice(k))
        call pass_response(stream, response%at_speed(k))
        call keep_result(keeper, [1, round, k], stream)
      end associate
    end subroutine find_at_speed

  end subroutine find_steady_responses

  pure subroutine pass_choice(stream, choice)
    type(byte_stream_t), intent(inout) :: stream
    type(choice_t), intent(inout) :: choice

    logical :: has_best

    call stream%pass(choice%slow)
    call stream%pass(choice%more_slow)
    call stream%pass(choice%tightened)
    call stream%pass(choice%raised_order)
    has_best = allocated(choice%best)
    call stream%pass(has_best)
    if (.not. has_best) return
    if (.not. allocated(choice%best)) allocate (choice%best)
    call pass_response(stream, choice%best)
  end subroutine pass_choice

  !> Adds the estimated frequency out of the plane, the same at all speeds: it is that at rest. A
  !! remark does without one where there is none.
  subroutine add_out_of_plane(structure, response)
    class(structure_t), intent(in) :: structure
    type(response_t), intent(inout) :: response

    type(error_t), allocatable :: error
    real(wp), allocatable :: frequency
    real(wp) :: relative_error
    integer :: k

    call find_out_of_plane_frequency(structure, frequency, relative_error, error)
    if (.not. allocated(frequency)) return
    do k = 1, size(response%at_speed)
      response%at_speed(k)%out_of_plane = frequency
      response%at_speed(k)%out_of_plane_error = relative_error
    end do
  end subroutine add_out_of_plane

  !> Makes the slow coordinates of a speed, the same number for both solutions.
  subroutine find_bases(request, speed, refinement, levels, choice, error)
    type(response_request_t), intent(in) :: request
    real(wp), intent(in) :: speed
    type(refinement_t), intent(in) :: refinement   !! with its levels
    type(level_slot_t), intent(inout) :: levels(:)
    type(choice_t), intent(inout) :: choice
    type(error_t), allocatable, intent(out) :: error

    associate (samples => refinement%samples, above => samples_on(refinement, 2))
      choice%slow = slow_count(levels(refinement%level(1))%level%coarse, speed* &
        merge(min(above, 2*samples)/least_a_period, samples/samples_a_period, choice%more_slow))
    end associate
    call need_basis(choice%slow, request%damping, levels(refinement%level(1))%level, error)
    if (.not. allocated(error)) call need_basis(choice%slow, request%damping, &
      levels(refinement%level(2))%level, error, known=levels(refinement%level(1))%level)
  end subroutine find_bases

  !> Polynomial degree to begin with.
  pure function first_order(accuracy) result(order)
    real(wp), intent(in) :: accuracy
    integer :: order

    order = max(8, min(8 + 2*ceiling(-0.5_wp*log10(accuracy)), 22))
  end function first_order

  !> Samples to begin with, from the number of vibrations of the slowest mode in a turn: what was
  !! found sufficient for machines of many kinds.
  elemental function first_samples(share, accuracy) result(samples)
    real(wp), intent(in) :: share    !! speed / frequency of that mode
    real(wp), intent(in) :: accuracy
    integer :: samples

    real(wp) :: wanted

    wanted = 120.0_wp + 13.0_wp*(1.0_wp/max(abs(share), 1.0e-3_wp))**0.8_wp
    samples = samples_of(wanted*(0.1_wp - 0.15_wp*log10(accuracy)), real(most_samples, wp))
  end function first_samples

  !> The least number of samples of those that there are.
  elemental function samples_of(wanted, most) result(samples)
    real(wp), intent(in) :: wanted, most !! the smaller of them
    integer :: samples

    samples = sample_numbers(findloc(sample_numbers >= nint(min(wanted, most)), .true., dim=1))
  end function samples_of

  !> Solves one speed on both levels: its result, and its next choice of orders and samples if it
  !! is not accurate enough.
  subroutine solve_speed(structure, request, speed, level, above, refinement, choice, found)
    class(structure_t), intent(in) :: structure
    type(response_request_t), intent(in) :: request
    real(wp), intent(in) :: speed
    type(level_t), intent(in), target :: level, above
    type(refinement_t), intent(inout) :: refinement
    type(choice_t), intent(inout) :: choice
    type(speed_response_t), intent(inout) :: found

    type(fourier_plan_t), target :: plan, above_plan
    type(slow_motion_t), target :: motion, above_motion
    type(equation_at_speed_t) :: equation, above_equation
    type(solution_t) :: solution, better
    real(wp), allocatable :: errors(:), unsolved(:)
    integer(long) :: before
    integer :: looking
    logical :: more_slow

    before = found%applications
    looking = 0
    call clear(found)
    call open_fourier(level%grid%samples, plan)
    call open_fourier(above%grid%samples, above_plan)
    attempt: block
      call new_slow_motion(plan, level%basis(choice%slow), speed, stages, motion, found%error)
      ! Fewer slow coordinates may grow where more do not.
      more_slow = motion%grows .and. .not. choice%more_slow
      if (allocated(found%error)) exit attempt
      call set_equation(level, plan, motion, speed, request%damping, request%terms, equation)
      allocate (solution%y(level%grid%samples, level%grid%unknowns))
      solution%y = 0.0_wp
      call solve_level(request, equation, tolerance_of(solved_to), solution, found%error)
      if (allocated(found%error)) exit attempt
      more_slow = is_stuck(solution, solved_to)
      if (more_slow) exit attempt
      call transferred(level%grid, plan, above%grid, above_plan, solution%y, better%y)
      ! Its own slow motion: that of the first has no harmonics beyond its samples.
      call new_slow_motion(above_plan, above%basis(choice%slow), speed, stages, above_motion, &
        found%error)
      if (allocated(found%error)) exit attempt
      call set_equation(above, above_plan, above_motion, speed, request%damping, request%terms, &
        above_equation)
      call solve_level(request, above_equation, tolerance_of(compared_to), better, found%error)
      if (allocated(found%error)) exit attempt
      more_slow = is_stuck(better, compared_to)
      if (more_slow) exit attempt
      found%order = refinement%order
      found%samples = level%grid%samples
      found%slow = choice%slow
      call look_at_multipliers(equation, found, looking)
      if (allocated(found%error)) exit attempt
      call evaluate(structure, request, equation, above_equation, solution, better, found, &
        errors, unsolved)
      ! The exact kinematics are those of links between two pins.
      if (request%validity .and. structure%elastic%in_closed_form) call find_changes
    end block attempt
    found%applications = before + solution%applications + better%applications
    call add_work(refinement, level%grid, solution%applications + 2*looking, choice%slow)
    call add_work(refinement, above%grid, better%applications, choice%slow)
    call close_fourier(above_plan)
    call close_fourier(plan)
    if (more_slow) then
      choice%more_slow = .true.
      call repeat_round(refinement)
      ! The last word if there is no time for it.
      if (.not. allocated(found%error)) call set_error(found%error, error_of_numerics, &
        "the iterations for the periodic motion do not get on")
    else if (allocated(found%error)) then
      if (.not. motion%grows .or. refinement%round < enough_rounds) call raise(refinement, 0, &
        refinement%samples + 1)
    else if (found%largest_error > request%accuracy) then
      call improve
    end if
    if (.not. refinement%pending) call settle(request%accuracy, choice, found)

  contains

    !> Quadratic terms on both levels.
    subroutine find_changes
      real(wp), allocatable :: other(:), step(:, :), above_step(:, :)
      real(wp) :: share, tolerance
      integer :: b

      tolerance = max(change_share*request%accuracy, least_change)
      call find_quadratic_change(structure%linkage, equation, request, solution%y, tolerance, &
        found%largest_strain%value, step, found%quadratic_change)
      if (.not. allocated(found%quadratic_change)) return
      call transferred(level%grid, plan, above%grid, above_plan, step, above_step)
      call find_quadratic_change(structure%linkage, above_equation, request, better%y, &
        compared_change*tolerance, found%largest_strain%value, above_step, other)
      if (allocated(other)) then
        ! In one link both may agree by chance, in all they do not.
        other = abs(found%quadratic_change - other)
        share = 0.0_wp
        do b = 1, size(other)
          if (other(b) < found%quadratic_change(b)) share = max(share, share_of_all*other(b)/ &
            found%quadratic_change(b))
        end do
        found%quadratic_error = many*tolerance*found%quadratic_change + safety*max(other, &
          share*found%quadratic_change)
        ! A change that is nothing but rounding is none: its error is a share of the strain.
        where (found%quadratic_change <= found%quadratic_error)
          found%quadratic_change = 0.0_wp
        elsewhere
          ! That of the strain, to which the change is relative, too.
          found%quadratic_error = found%quadratic_error/found%quadratic_change + found%peak_error
        end where
      else
        deallocate (found%quadratic_change)
      end if
    end subroutine find_changes

    !> What remains of the iterations is to be below this.
    pure function tolerance_of(share) result(tolerance)
      real(wp), intent(in) :: share !! of the accuracy
      real(wp) :: tolerance

      tolerance = max(share*merge(1.0e-2_wp, 1.0_wp, choice%tightened)* &
        min(request%accuracy, coarsest_iterations), least_remainder)
    end function tolerance_of

    !> Whether the iterations have not got on, and more slow coordinates may help.
    pure function is_stuck(found_there, share) result(yes)
      type(solution_t), intent(in) :: found_there
      real(wp), intent(in) :: share
      logical :: yes

      yes = .not. choice%more_slow .and. found_there%remainder > max(tolerance_of(share), stuck)
    end function is_stuck

    !> The next choice after a result that is not accurate enough.
    subroutine improve
      logical :: is_best

      call compare(refinement, found%largest_error, is_best)
      if (is_best) choice%best = found
      if (refinement%idle >= limits%idle) return
      if (max(solution%remainder, many*better%remainder) > 0.5_wp*request%accuracy) then
        ! Either rounding leaves no more digits, or harmonics left out hinder the iterations.
        if (better%remainder > unfinished .or. found%largest_error > of_orders) &
          call raise(refinement, 0, refinement%samples + 1)
      else if (rounding/found%distance > request%accuracy) then
        if (allocated(choice%best)) deallocate (choice%best)
        call set_error(found%error, error_of_numerics, "resonance: an exponent of the turn, "// &
          trim(in_words(found%nearest))//", is too near to 0 for the accuracy asked for")
      else if (.not. choice%tightened .and. any(errors > request%accuracy .and. unsolved > &
        of_iterations)) then
        ! The same once more, as a quantity that is nearly nothing beside the motion needs it.
        choice%tightened = .true.
        call repeat_round(refinement)
      else
        call raise_either(request%accuracy, found%largest_error, errors, solution%series, &
          with_kinks(request, level%grid), refinement, choice)
      end if
    end subroutine improve

  end subroutine solve_speed

  !> The last word on a speed: the best result, unless it has no digits at all.
  subroutine settle(accuracy, choice, found)
    real(wp), intent(in) :: accuracy
    type(choice_t), intent(inout) :: choice
    type(speed_response_t), intent(inout) :: found

    integer(long) :: applications

    applications = found%applications
    if (allocated(choice%best)) then
      if (allocated(found%error) .or. found%largest_error > choice%best%largest_error) found = &
        choice%best
      found%applications = applications
      deallocate (choice%best)
    end if
    if (allocated(found%error) .or. found%largest_error <= accuracy) return
    found%displacement_error = not_reached*found%displacement_error
    found%strain_error = not_reached*found%strain_error
    found%drive_error = not_reached*found%drive_error
    found%peak_error = not_reached*found%peak_error
    found%largest_error = not_reached*found%largest_error
    if (found%largest_error <= no_digits) return
    call set_error(found%error, error_of_numerics, "no accuracy is reached with "// &
      to_string(found%samples)//" samples of the turn and order "//to_string(found%order)// &
      "; the nearest exponent of the turn is "//trim(in_words(found%nearest)))
  end subroutine settle

  !> Raises the samples if the errors of the series that are not accurate enough come from harmonics
  !! left out, else the orders.
  pure subroutine raise_either(accuracy, largest_error, errors, series, kinks, refinement, choice)
    real(wp), intent(in) :: accuracy, largest_error
    real(wp), intent(in) :: errors(:)    !! (series)
    real(wp), intent(in) :: series(:, :) !! coefficients
    logical, intent(in) :: kinks(:)      !! (series) that tell nothing by their harmonics
    type(refinement_t), intent(inout) :: refinement
    type(choice_t), intent(inout) :: choice

    real(wp) :: tail(2), last, largest, fall, wanted
    integer :: i, n, next
    logical :: order

    n = size(series, 1)
    next = n
    order = .not. any(errors > accuracy)
    do i = 1, size(series, 2)
      if (errors(i) <= accuracy) cycle
      order = order .or. kinks(i)
      if (kinks(i)) cycle
      largest = sum(abs(series(:, i)))
      last = sum(abs(series(n - n/8:, i)))/largest
      if (last <= tail_share*errors(i) .and. errors(i) <= of_orders) order = .true.
      if (last <= tail_share*min(errors(i), accuracy)) cycle
      if (last <= tail_share*errors(i) .and. errors(i) <= of_orders) cycle
      ! Harmonics fall exponentially. The highest of all are raised by those above them.
      tail = [sum(abs(series(n/2:n/2 + n/8, i))), sum(abs(series(n/2 + n/4:n/2 + 3*n/8, i)))]
      fall = max(log(tail(1)/tail(2))/(n/4), slowest_fall)
      wanted = n + log(errors(i)/(0.3_wp*accuracy))/fall
      next = max(next, nint(min(wanted, real(2*n, wp))))
    end do
    order = order .or. next == n
    ! Higher orders that gain nothing show that the iterations or harmonics are to blame.
    if (choice%raised_order .and. .not. refinement%gained) then
      order = .false.
      choice%tightened = .true.
      next = max(next, n + 1)
    end if
    choice%raised_order = order
    call raise(refinement, merge(max(1, ceiling(log(largest_error/accuracy)/ &
      log(gain_of_orders))), 0, order), next)
  end subroutine raise_either

  !> Series at places that a block passes.
  pure function with_kinks(request, grid) result(kinks)
    type(response_request_t), intent(in) :: request
    type(turn_grid_t), intent(in) :: grid
    logical :: kinks(series_count(request))

    integer :: i

    kinks = .false.
    do i = 1, size(request%points)
      kinks(first_of_point(i):first_of_point(i + 1) - 1) = moves(grid, request%points(i)%body)
    end do
    do i = 1, size(request%gauges)
      kinks(first_of_gauge(request, i):first_of_gauge(request, i + 1) - 1) = moves(grid, &
        request%gauges(i)%body)
    end do
  end function with_kinks

  !> An exponent as growth and turns.
  pure function in_words(exponent) result(words)
    complex(wp), intent(in) :: exponent !! ln|multiplier| and turns
    character(len=48) :: words          ! no deferred length, which threads would share

    words = to_string(real(exponent, wp), 4)//" and "//to_string(aimag(exponent), 6)//" turns"
  end function in_words

  !> Forgets the result of a solution before.
  subroutine clear(found)
    type(speed_response_t), intent(out) :: found
  end subroutine clear

  !> The periodic motion on one level, and its series.
  subroutine solve_level(request, equation, tolerance, solution, error)
    type(response_request_t), intent(in) :: request
    type(equation_at_speed_t), intent(in) :: equation
    real(wp), intent(in) :: tolerance
    type(solution_t), intent(inout) :: solution     !! with a start
    type(error_t), allocatable, intent(out) :: error

    real(wp), allocatable :: series(:, :)

    call solve_periodic(equation, load_at_speed(equation%grid, equation%speed), tolerance, &
      solution%y, solution%applications, solution%remainder, error, solution%last_change)
    if (allocated(error)) return
    allocate (series(equation%grid%samples, series_count(request)))
    allocate (solution%series, mold=series)
    call response_series_of(equation%grid, equation%plan, request, equation%speed, solution%y, &
      series)
    call coefficients_of(equation%plan, series, solution%series)
  end subroutine solve_level

  !> Multipliers of a turn, and how near the motion is to resonance.
  subroutine look_at_multipliers(equation, found, applications)
    type(equation_at_speed_t), intent(in) :: equation
    type(speed_response_t), intent(inout) :: found
    integer, intent(out) :: applications !! of the equation, to complex motions

    type(floquet_mode_t) :: mode

    applications = 0
    call find_nearest_mode(equation, near, mode, found%growth, found%error)
    if (allocated(found%error)) return
    applications = mode%applications
    found%nearest = cmplx(two_pi*real(mode%exponent), abs(aimag(mode%exponent)), wp)
    found%distance = max(abs(1.0_wp - exp(two_pi*mode%exponent)), epsilon(1.0_wp))
  end subroutine look_at_multipliers

  !> All quantities at the crank angles of the deck, and their errors.
  subroutine evaluate(structure, request, level, above, solution, better, found, errors, unsolved)
    class(structure_t), intent(in) :: structure
    type(response_request_t), intent(in) :: request
    type(equation_at_speed_t), intent(in) :: level, above
    type(solution_t), intent(in) :: solution, better
    type(speed_response_t), intent(inout) :: found
    real(wp), allocatable, intent(out) :: errors(:) !! (series)
    real(wp), allocatable, intent(out) :: unsolved(:) !! (series) share of it that the iterations of
                                                    !! the first solution left

    real(wp), allocatable :: values(:, :), fine(:, :), before(:, :), at_position(:, :), scale(:)
    real(wp) :: extra
    integer :: i, k, first, n

    n = size(solution%series, 2)
    allocate (values(above%grid%samples, n), fine(above%grid%samples, n), &
      before(above%grid%samples, n), errors(n))
    call values_of(above%plan, resampled(solution%series, above%grid%samples), values)
    if (allocated(level%grid%pieces)) call find_values_on_pieces(level%grid, level%plan, request, &
      solution%y, [(two_pi*(k - 1)/above%grid%samples, k=1, above%grid%samples)], values)
    call values_of(above%plan, better%series, fine)
    ! What the iterations leave in both, one starts from the other, is in no difference: slow
    ! motions near resonance may lack many times the last change.
    call response_series_of(above%grid, above%plan, request, level%speed, better%y - &
      better%last_change, before)
    errors = safety*maxval(abs(values - fine), dim=1) + many*maxval(abs(before - fine), dim=1)
    call find_scales
    errors = errors/scale
    call find_unsolved
    ! How far the iterations came below their tolerance is chance.
    extra = max(many*better%remainder, least_share*min(request%accuracy, coarsest_share)) + &
      rounding/found%distance
    allocate (at_position(n, size(request%crank)))
    do k = 1, size(request%crank)
      at_position(:, k) = value_at(solution%series, angle_of(k))
    end do
    if (allocated(level%grid%pieces)) call take_pieces

    allocate (found%displacement(3, size(request%points), size(request%crank)), &
      found%displacement_error(size(request%points)))
    do i = 1, size(request%points)
      first = first_of_point(i)
      found%displacement(:, i, :) = at_position(first:first + 2, :)
      found%displacement_error(i) = extra + max(norm2(errors(first:first + 1)), errors(first + 2))
    end do
    call evaluate_gauges
    call evaluate_drive
    call evaluate_peaks
    found%deflection = sampled_deflections(level%grid, solution%y)
    if (request%validity) then
      found%buckling = buckling_shares(structure%elastic%linkage, level%grid, level%plan, &
        level%speed)
      found%buckling_error = least_share*coarsest_share + safety*abs(found%buckling - &
        buckling_shares(structure%elastic%linkage, above%grid, above%plan, level%speed))/ &
        max(abs(found%buckling), tiny(1.0_wp))
    end if
    found%largest_error = max(maxval([0.0_wp, found%displacement_error]), &
      maxval([0.0_wp, found%strain_error]), found%drive_error, maxval([0.0_wp, found%peak_error]))

  contains

    !> Quantities at places that a block passes, at the crank angles of the deck.
    subroutine take_pieces
      real(wp) :: there(size(request%crank), n)

      there = transpose(at_position)
      call find_values_on_pieces(level%grid, level%plan, request, solution%y, [(angle_of(k), k=1, &
        size(request%crank))], there)
      at_position = transpose(there)
    end subroutine take_pieces

    !> Angle of a crank angle of the deck. Whole turns make no difference, to the last digit.
    pure function angle_of(k) result(angle)
      integer, intent(in) :: k
      real(wp) :: angle

      angle = sense_of(level%grid)*modulo(request%crank(k), 360.0_wp)*degree
    end function angle_of

    !> What the last change of the first solution changes, where errors are too large.
    subroutine find_unsolved
      real(wp) :: here(level%grid%samples, n), there(level%grid%samples, n)

      allocate (unsolved(n), source=0.0_wp)
      if (all(errors <= request%accuracy)) return
      call response_series_of(level%grid, level%plan, request, level%speed, solution%y, here)
      call response_series_of(level%grid, level%plan, request, level%speed, solution%y - &
        solution%last_change, there)
      unsolved = safety*maxval(abs(here - there), dim=1)/scale/max(errors, tiny(1.0_wp))
    end subroutine find_unsolved

    !> The largest value of every series over the turn, to which its errors are relative; of a
    !! displacement that of both components. A quantity that is zero by its nature is measured
    !! against what goes with it.
    subroutine find_scales
      real(wp) :: largest(n), work

      allocate (scale(n))
      largest = maxval(abs(fine), dim=1)
      do i = 1, size(request%points)
        first = first_of_point(i)
        scale(first:first + 1) = sqrt(maxval(fine(:, first)**2 + fine(:, first + 1)**2))
        scale(first + 2) = max(largest(first + 2), by_nature*scale(first)/ &
          structure%elastic%linkage%bodies(request%points(i)%body)%length)
      end do
      do i = 1, size(request%gauges)
        first = first_of_gauge(request, i)
        associate (body => request%gauges(i)%body)
          associate (outer => request%section(body)%outer, beam => structure%elastic%beams(body))
            associate (strain => largest(first) + outer*largest(first + 1))
              scale(first) = max(largest(first), by_nature*strain)
              scale(first + 1) = max(largest(first + 1), by_nature*strain/max(outer, tiny(1.0_wp)))
              scale(first + 2) = max(largest(first + 2), &
                by_nature**2*beam%axial_stiffness*strain)
            end associate
          end associate
        end associate
      end do
      first = first_of_torque(request)
      ! The work of the loads on the deformations measures torques that vanish altogether: all of it
      ! where they are nothing but rounding.
      work = maxval(abs(sum(load_at_speed(above%grid, level%speed)*better%y, dim=2)))
      if (any(largest(first:) > errors(first:)) .or. any(errors(first:) > &
        sqrt(epsilon(1.0_wp))*work)) work = by_nature*work
      scale(first:) = max(largest(first:), by_nature*maxval(abs(sum(fine(:, first:), dim=2))), &
        work)
      scale = max(scale, tiny(1.0_wp))
    end subroutine find_scales

    subroutine evaluate_gauges
      real(wp), dimension(above%grid%samples) :: strain, fine_strain
      integer :: g

      allocate (found%strain(strain_values, size(request%gauges), size(request%crank)), &
        found%strain_error(size(request%gauges)))
      do g = 1, size(request%gauges)
        first = first_of_gauge(request, g)
        associate (gauge => request%gauges(g), &
          beam => structure%elastic%beams(request%gauges(g)%body), &
          section => request%section(request%gauges(g)%body))
          do k = 1, size(request%crank)
            found%strain(:, g, k) = gauge_values_of(gauge, beam, section, at_position(first, k), &
              at_position(first + 1, k), at_position(first + 2, k))
          end do
          strain = abs(values(:, first)) + section%outer*abs(values(:, first + 1))
          fine_strain = abs(fine(:, first)) + section%outer*abs(fine(:, first + 1))
          found%strain_error(g) = extra + max(maxval(errors(first:first + 2)), &
            safety*maxval(abs(strain - fine_strain))/max(maxval(fine_strain), tiny(1.0_wp)))
        end associate
      end do
    end subroutine evaluate_gauges

    subroutine evaluate_drive
      real(wp), dimension(above%grid%samples) :: total, fine_total

      first = first_of_torque(request)
      allocate (found%drive(drive_values, size(request%crank)))
      found%drive(rigid_torque:quadratic_torque, :) = at_position(first:first + 2, :)
      found%drive(total_torque, :) = sum(found%drive(rigid_torque:quadratic_torque, :), dim=1)
      found%drive(power, :) = found%drive(total_torque, :)*sense_of(level%grid)*level%speed
      found%mean_torque = sum(solution%series(1, first:first + 2))
      total = sum(values(:, first:first + 2), dim=2)
      fine_total = sum(fine(:, first:first + 2), dim=2)
      found%drive_error = extra + max(maxval(errors(first:first + 2)), &
        safety*maxval(abs(total - fine_total))/max(maxval(abs(fine_total)), scale(first)))
    end subroutine evaluate_drive

    subroutine evaluate_peaks
      type(speed_response_t) :: other
      integer :: b

      allocate (found%peak_error(merge(size(structure%elastic%beams), 0, request%peaks .or. &
        request%validity)))
      found%peak_error = 0.0_wp
      if (size(found%peak_error) == 0) return
      call find_peaks(level%grid, level%plan, request, solution%y, found, solution%last_change)
      call find_peaks(above%grid, above%plan, request, better%y, other, better%last_change)
      found%power_lost = level%speed**2*power_of(level, solution%y)
      other%power_lost = level%speed**2*power_of(above, better%y)
      do b = 1, size(structure%elastic%beams)
        found%peak_error(b) = safety*abs(found%power_lost(b) - other%power_lost(b))/ &
          max(sum(other%power_lost), tiny(1.0_wp))
        if (structure%elastic%linkage%bodies(b)%bends) found%peak_error(b) = &
          max(found%peak_error(b), &
          safety*strain_change(b, [found%largest_strain(b), other%largest_strain(b)])/ &
          max(other%largest_strain(b)%value, by_nature**2*maxval(other%largest_strain%value), &
          tiny(1.0_wp)), &
          safety*deflection_change(b, [found%largest_deflection(b), other%largest_deflection(b)])/ &
          max(other%largest_deflection(b)%value, tiny(1.0_wp)))
        found%peak_error(b) = extra + found%peak_error(b)
      end do
    end subroutine evaluate_peaks

    !> The difference of the largest strains of both solutions, or the largest difference over the
    !! turn of the strains at their places: two peaks may agree by chance.
    function strain_change(body, peaks) result(change)
      integer, intent(in) :: body           !! that bends
      type(peak_t), intent(in) :: peaks(2)  !! of both solutions
      real(wp) :: change

      real(wp) :: here(level%grid%samples, 4), moved(above%grid%samples, 4), &
        there(above%grid%samples, 4)

      call strains_along(level%grid, body, peaks%xi, solution%y, here(:, :2), here(:, 3:))
      call strains_along(above%grid, body, peaks%xi, better%y, there(:, :2), there(:, 3:))
      call resample(level%plan, here, above%plan, moved)
      there = abs(there) - abs(moved)
      change = max(abs(peaks(1)%value - peaks(2)%value), &
        maxval(abs(there(:, :2) + request%section(body)%outer*there(:, 3:))))
    end function strain_change

    !> The same in the deflection.
    function deflection_change(body, peaks) result(change)
      integer, intent(in) :: body           !! that bends
      type(peak_t), intent(in) :: peaks(2)  !! of both solutions
      real(wp) :: change

      real(wp) :: here(level%grid%samples, 3), moved(above%grid%samples, 3), place(2)
      integer :: i

      change = abs(peaks(1)%value - peaks(2)%value)
      do i = 1, size(peaks)
        place = [peaks(i)%xi*structure%elastic%linkage%bodies(body)%length, 0.0_wp]
        here = place_series(level%grid, body, place, solution%y)
        call resample(level%plan, here, above%plan, moved)
        moved = moved - place_series(above%grid, body, place, better%y)
        change = max(change, sqrt(maxval(moved(:, 1)**2 + moved(:, 2)**2)))
      end do
    end function deflection_change

    !> Mean of `y'ᵀ C y'` of every link.
    function power_of(equation, y) result(power)
      type(equation_at_speed_t), intent(in) :: equation
      real(wp), intent(in) :: y(:, :)
      real(wp) :: power(size(equation%grid%integrals))

      integer :: first, last

      power = 0.0_wp
      first = equation%grid%border + 1
      last = equation%grid%unknowns
      associate (grid => equation%grid, plan => equation%plan, c => equation%damping)
        if (allocated(grid%pieces)) then
          call add_power_of_strains(grid, plan, y, c, power)
        else if (.not. allocated(grid%weighted)) then
          call add_power(plan, y, c%c, grid%owner, power)
        else
          call add_power(plan, y(:, first:), c%c(first:last), grid%owner(first:), power)
          call add_power(plan, deformations_of(grid, y), c%c(last + 1:), grid%deformed, power)
        end if
      end associate
    end function power_of

    !> The same where strains move through pieces with their material.
    subroutine add_power_of_strains(grid, plan, y, damping, power)
      type(turn_grid_t), intent(in) :: grid
      type(fourier_plan_t), intent(in) :: plan
      real(wp), intent(in) :: y(:, :)
      type(damping_t), intent(in) :: damping
      real(wp), intent(inout) :: power(:)

      real(wp) :: first(size(y, 1), size(y, 2)), share(size(y, 1), size(damping%c))
      real(wp), allocatable :: w(:, :), w_rates(:, :), rates(:, :)
      integer :: before, i

      call derivatives(plan, y, first)
      call strain_rates(grid, plan, y, first, w, w_rates, rates)
      share = shares_of(grid, damping, 1, size(damping%c))
      before = merge(grid%unknowns, 0, allocated(grid%weighted))
      do i = 1, size(w, 2)
        associate (b => grid%deformed(i))
          if (b > 0) power(b) = power(b) + damping%c(before + i)*sum(share(:, before + i)* &
            w_rates(:, i)**2)/grid%samples
        end associate
      end do
      do i = grid%border + 1, grid%unknowns
        associate (b => grid%owner(i))
          power(b) = power(b) + damping%c(i)*sum(share(:, i)*rates(:, i)**2)/grid%samples
        end associate
      end do
    end subroutine add_power_of_strains

    !> Adds that of some motions, each with its damping, to those of the links they belong to.
    subroutine add_power(plan, y, c, owner, power)
      type(fourier_plan_t), intent(in) :: plan
      real(wp), intent(in) :: y(:, :), c(:)   !! (samples, motions), (motions)
      integer, intent(in) :: owner(:)         !! (motions); 0: a spring, which is not damped
      real(wp), intent(inout) :: power(:)

      real(wp) :: coefficients(size(y, 1), size(y, 2))
      integer :: i, j

      call coefficients_of(plan, y, coefficients)
      do i = 1, size(y, 2)
        if (owner(i) == 0) cycle
        do j = 1, (size(y, 1) - 1)/2
          power(owner(i)) = power(owner(i)) + 2.0_wp*c(i)*real(j, wp)**2* &
            sum(coefficients(2*j:2*j + 1, i)**2)
        end do
      end do
    end subroutine add_power

  end subroutine evaluate

end module steady_responses
