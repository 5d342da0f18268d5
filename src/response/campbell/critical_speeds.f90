!> Critical speeds of a linkage: those at which a Floquet frequency is a multiple of the speed, so
!! that the loads of the motion, which repeat with the turn, excite the vibration; and how much.
!!
!! Crossings of slow motions are solved again with the exponents of the whole equation, whose errors
!! are known. A multiplier that meets its own conjugate at 1 leaves the circle in a narrow interval
!! of speeds: then the critical speed is its middle. Near a crossing the square of turns, less than
!! 0 where multipliers are real, is `s² (ω − ω_c)² − κ²`, s being the slope of turns.
!!
!! Crossings that the slow motion says to be hardly excited are left out.
module critical_speeds
  use byte_streams, only: byte_stream_t, pass_error
  use campbell_types, only: critical_t, gap_t
  use constants, only: two_pi
  use elastic_equations, only: load_at_speed
  use equations_at_speed, only: equation_at_speed_t
  use errors, only: error_of_numerics, error_t, set_error
  use floquet_exponents, only: find_floquet_modes, floquet_mode_t
  use fourier_transform, only: close_fourier, fourier_plan_t, open_fourier
  use frozen_modes, only: find_frozen_frequencies
  use interruption, only: was_interrupted
  use kept_results, only: keep_result, keeper_t, recall_result
  use kinds, only: wp
  use link_store, only: link_store_t
  use mode_numbers, only: growing_mode
  use multiplier_angles, only: angle_t, angles_of, nearest_to_one
  use multiplier_crossings, only: beside, crossing_t, find_crossings
  use resonance_growth, only: critical_pair_t, find_growth, growth_t
  use refinements, only: refinement_t
  use response_levels, only: level_slot_t, level_t, set_equation
  use response_peaks, only: find_peaks, sampled_deflections
  use response_types, only: no_damping, response_request_t, speed_response_t
  use stability_types, only: stability_request_t
  use strain_dampings, only: is_damped
  use structures, only: structure_t
  use turn_grids, only: turn_grid_t
  use turn_spectra, only: begin_refinements, find_spectrum, need_two_levels, slow_number, &
    turn_spectrum_t
  implicit none (type, external)
  private

  public :: find_critical_speeds

  !> Critical speeds with less of the greatest excitation are left out; so are, before, those with
  !! less of it in slow motions.
  real(wp), parameter :: least_excited = 1.0e-2_wp, hardly_excited = 5.0e-3_wp

  !> So are those with less of the deflection of the linkage at rest under the same loads: rounding.
  real(wp), parameter :: of_rounding = 1.0e-8_wp

  !> Speeds are solved for in so many rounds at most, to the first share of the accuracy; exponents
  !! are wrong by no more than the second for what their iterations leave, or than the least.
  integer, parameter :: most_rounds = 6, most_rounds_of_ends = 20
  real(wp), parameter :: enough = 0.1_wp, solved_to = 3.0e-4_wp, least_change = 1.0e-13_wp

  !> Exponents have no more turns than this at a critical speed: the excitation depends on them.
  real(wp), parameter :: near_pole = 2.0e-5_wp

  !> Turns below this are 0, and below the last share of the real part; real multipliers less apart
  !! than the second are one.
  real(wp), parameter :: on_axis = 1.0e-9_wp, solved_to_turns = 1.0e-7_wp, real_share = 0.1_wp

  !> Exponents that are farther from a multiple than this are not those of the crossing.
  real(wp), parameter :: far = 0.05_wp

  !> Critical speeds have no larger relative error, and are no farther in turns from the crossing of
  !! the slow motion.
  real(wp), parameter :: most_error = 0.1_wp, far_from_crossing = 0.25_wp

  !> Multipliers that are real are looked at this far from the middle, times their distance; at
  !! least as for this one, in turns.
  real(wp), parameter :: outside = 3.0_wp, narrow = 1.0e-5_wp

  !> The ends of intervals in which turns would be more than this are solved for; turns above the
  !! second are on the other side of the circle.
  real(wp), parameter :: wide_enough = 1.0e-4_wp, other_side = 0.3_wp

  !> Crossings of slow motions are looked for outside of the speeds asked for, too, by this share of
  !! them: the critical speed may be inside.
  real(wp), parameter :: beyond = 1.0e-3_wp

  !> Estimated errors are differences of two solutions times the first, what iterations leave
  !! of exponents times the second; none is stated below rounding.
  real(wp), parameter :: safety = 2.0_wp, many = 3.0_wp, rounding = 1.0e-9_wp

  !> A crossing on its way to a critical speed.
  type :: candidate_t
    type(crossing_t) :: crossing
    real(wp) :: speed = 0.0_wp       !! next to be tried, then the critical one [rad/s]
    real(wp) :: speed_error = 0.0_wp !! relative
    integer :: line = 0
    real(wp) :: centre(2) = 0.0_wp   !! of its exponents on both levels, per radian of the crank
    real(wp) :: square(2) = 0.0_wp   !! of their distance from it; less than 0: it is imaginary
    real(wp) :: change = 0.0_wp      !! what iterations leave of them, times `many`
    integer :: level(2) = 0          !! numbers of the levels of both solutions
    logical :: found = .false.
  end type candidate_t

  !> What is found at a speed near a crossing.
  type :: trial_t
    real(wp) :: speed = 0.0_wp       !! [rad/s]
    real(wp) :: turns = 0.0_wp       !! with their sense
    real(wp) :: change = 0.0_wp      !! of the exponent in the last round
    real(wp) :: centre = 0.0_wp, apart = 0.0_wp !! real part, or mean and distance of two
    real(wp) :: alone = 0.0_wp       !! of two real exponents the only one found, perhaps; 0: both
                                     !! are
    real(wp) :: mean = 0.0_wp        !! frequency of the frozen linkage [rad/s]
    logical :: found = .false.
  end type trial_t

contains

  !> All critical speeds between the least and the greatest of a request; none if the run is
  !! interrupted.
  !!
  !! Errors: the crank does not turn fully; own modes of a link could not be found.
  subroutine find_critical_speeds(structure, request, frequency, threads, store, critical, gap, &
    left_out, error, keeper)
    class(structure_t), intent(in) :: structure      !! linkage and beams
    type(stability_request_t), intent(in) :: request !! speeds of one sign, modes, accuracy
    real(wp), intent(in) :: frequency(2)             !! of the lowest and the highest mode [rad/s]
    integer, intent(in) :: threads                   !! number of OpenMP threads
    type(link_store_t), intent(inout) :: store       !! links decomposed earlier
    type(critical_t), allocatable, intent(out) :: critical(:) !! ascending
    type(gap_t), allocatable, intent(out) :: gap(:)  !! speeds between which some may be missed
    integer, intent(out) :: left_out                 !! hardly excited
    type(error_t), allocatable, intent(out) :: error !! why there is nothing
    class(keeper_t), intent(inout), optional :: keeper !! of crossings solved for, stage 2, and
                                                       !! how much they are excited, stage 3

    type(stability_request_t) :: wider
    type(level_slot_t), allocatable :: levels(:)
    type(crossing_t), allocatable :: crossing(:)
    type(candidate_t), allocatable :: candidate(:)
    type(refinement_t), allocatable :: refinement(:)
    real(wp), allocatable :: rough(:), at_rest(:)
    real(wp) :: range(2) !! of the speeds asked for [rad/s]
    integer :: i

    allocate (levels(0), critical(0))
    left_out = 0
    wider = request
    range = [minval(abs(request%speed)), maxval(abs(request%speed))]
    wider%speed = sign(range*[1.0_wp - beyond, 1.0_wp + beyond], request%speed(1))
    call find_crossings(structure, wider, frequency, threads, store, levels, crossing, gap, error)
    if (allocated(error) .or. was_interrupted()) return
    gap = pack(gap, gap%speed(2) > range(1) .and. gap%speed(1) < range(2))
    allocate (candidate(size(crossing)), refinement(size(crossing)), rough(size(crossing)), &
      at_rest(size(crossing)))
    call begin_refinements(structure, request, request%modes, sign(crossing%speed, &
      request%speed(1)), store, levels, refinement, error)
    if (allocated(error)) return
    ! All, where samples are too few with as many as possible.
    refinement%pending = .true.
    call need_two_levels(structure, request, refinement, store, levels, error)
    if (allocated(error) .or. was_interrupted()) return
    do i = 1, size(crossing)
      candidate(i)%crossing = crossing(i)
      candidate(i)%speed = crossing(i)%speed
      candidate(i)%centre = crossing(i)%angle%growth
      candidate(i)%square = crossing(i)%angle%apart**2
      candidate(i)%level = refinement(i)%level
    end do
    rough = 0.0_wp
    at_rest = 0.0_wp
    !$omp parallel do num_threads(threads) schedule(dynamic) default(shared) private(i)
    do i = 1, size(candidate)
      if (was_interrupted()) cycle
      call find_rough(request, levels(candidate(i)%level(1))%level, candidate(i), rough(i), &
        at_rest(i))
    end do
    !$omp end parallel do
    left_out = count((rough < hardly_excited*maxval(rough) .or. rough <= of_rounding*at_rest) &
      .and. .not. is_outside(candidate%speed))
    candidate = pack(candidate, rough >= hardly_excited*maxval(rough) .and. rough > &
      of_rounding*at_rest)
    !$omp parallel do num_threads(threads) schedule(dynamic) default(shared) private(i)
    do i = 1, size(candidate)
      call refine_crossing(i)
    end do
    !$omp end parallel do
    if (was_interrupted()) return
    do i = 1, size(candidate)
      if (candidate(i)%found) cycle
      gap = [gap, gap_t(spread(min(max(candidate(i)%crossing%speed, range(1)), range(2)), 1, 2))]
    end do
    candidate = pack(candidate, candidate%found .and. .not. is_outside(candidate%speed))
    candidate = pack(candidate, .not. [(is_again(i), i=1, size(candidate))])
    deallocate (critical)
    allocate (critical(size(candidate)))
    !$omp parallel do num_threads(threads) schedule(dynamic) default(shared) private(i)
    do i = 1, size(candidate)
      if (.not. was_interrupted()) call excite(i)
    end do
    !$omp end parallel do
    i = size(critical)
    critical = pack(critical, critical%excitation >= least_excited*maxval(critical%excitation) &
      .or. [(allocated(critical(i)%fault), i=1, size(critical))])
    left_out = left_out + size(candidate) - size(critical)

  contains

    !> Solves for the speed of a candidate, or takes that of an earlier run.
    subroutine refine_crossing(i)
      integer, intent(in) :: i

      type(byte_stream_t) :: stream
      logical :: known

      call recall_result(keeper, [2, 1, i], stream, known)
      if (.not. known) call refine_speed(request, levels(candidate(i)%level(1))%level, &
        levels(candidate(i)%level(2))%level, candidate(i))
      if (.not. present(keeper)) return
      call pass_candidate(stream, candidate(i))
      call keep_result(keeper, [2, 1, i], stream)
    end subroutine refine_crossing

    !> Likewise for its excitation.
    subroutine excite(i)
      integer, intent(in) :: i

      type(byte_stream_t) :: stream
      logical :: known

      call recall_result(keeper, [3, 1, i], stream, known)
      if (.not. known) call find_excitation(request, levels(candidate(i)%level(1))%level, &
        levels(candidate(i)%level(2))%level, candidate(i), critical(i))
      if (.not. present(keeper)) return
      call pass_critical(stream, critical(i))
      call keep_result(keeper, [3, 1, i], stream)
    end subroutine excite

    !> Whether a candidate is the interval of one before it, in which a multiplier passes 1 twice.
    logical function is_again(i)
      integer, intent(in) :: i

      associate (here => candidate(i), before => candidate(:i - 1))
        is_again = any(before%line == here%line .and. before%crossing%mode == here%crossing%mode &
          .and. abs(before%speed - here%speed) <= here%speed*min(before%speed_error, &
          here%speed_error))
      end associate
    end function is_again

    !> Whether a speed is not one of those asked for.
    elemental logical function is_outside(speed)
      real(wp), intent(in) :: speed

      is_outside = speed < range(1) .or. speed > range(2)
    end function is_outside

  end subroutine find_critical_speeds

  !> Passes what `refine_speed` finds of a candidate.
  pure subroutine pass_candidate(stream, candidate)
    type(byte_stream_t), intent(inout) :: stream
    type(candidate_t), intent(inout) :: candidate

    call stream%pass(candidate%speed)
    call stream%pass(candidate%speed_error)
    call stream%pass(candidate%line)
    call stream%pass(candidate%centre)
    call stream%pass(candidate%square)
    call stream%pass(candidate%change)
    call stream%pass(candidate%found)
  end subroutine pass_candidate

  pure subroutine pass_critical(stream, critical)
    type(byte_stream_t), intent(inout) :: stream
    type(critical_t), intent(inout) :: critical

    call stream%pass(critical%speed)
    call stream%pass(critical%speed_error)
    call stream%pass(critical%line)
    call stream%pass(critical%mode)
    call stream%pass(critical%frequency)
    call stream%pass(critical%growth)
    call stream%pass(critical%excitation)
    call stream%pass(critical%amplitude)
    call stream%pass(critical%error)
    call pass_error(stream, critical%fault)
  end subroutine pass_critical

  !> The excitation by the slow motion alone, and the deflection under the same loads at rest.
  subroutine find_rough(request, level, candidate, excitation, at_rest)
    type(stability_request_t), intent(in) :: request
    type(level_t), intent(in) :: level
    type(candidate_t), intent(in) :: candidate
    real(wp), intent(out) :: excitation, at_rest !! [m]

    type(growth_t) :: found
    type(error_t), allocatable :: error

    call find_growth(level, slow_number(level%grid, request%modes), critical_pair_t( &
      candidate%speed, candidate%centre(1), candidate%square(1)), request%damping, request%terms, &
      huge(1.0_wp), found, error)
    excitation = huge(1.0_wp)
    at_rest = maxval(sampled_deflections(level%grid, load_at_speed(level%grid, candidate%speed)))
    if (allocated(error)) return
    excitation = maxval(sampled_deflections(level%grid, found%growth(:, :, 1)))
  end subroutine find_rough

  !> Solves for the speed with the exponents of the whole equation: by secants on the finer level,
  !! its error from the other. Between two speeds at which multipliers are real the middle counts.
  subroutine refine_speed(request, level, above, candidate)
    type(stability_request_t), intent(in) :: request
    type(level_t), intent(in) :: level, above
    type(candidate_t), intent(inout) :: candidate

    type(trial_t) :: here, before, rough
    real(wp) :: slope, accuracy, centre, wanted
    integer :: round
    logical :: found

    slope = candidate%crossing%slope
    accuracy = request%accuracy
    do round = 1, most_rounds
      call try_speed(request, above, candidate, candidate%speed, here)
      if (.not. here%found .or. abs(here%turns) > far) return
      if (round > 1 .and. abs(here%turns - before%turns) > 0.0_wp) slope = secant(before, here)
      ! Differences of rounding tell no slope.
      if (abs(slope/candidate%crossing%slope - 1.0_wp) > 0.5_wp) slope = candidate%crossing%slope
      wanted = enough*accuracy*here%speed*abs(slope)
      if (abs(here%turns) <= min(wanted, near_pole)) exit
      if (round == most_rounds) then
        if (abs(here%turns) <= wanted) exit
        return
      end if
      before = here
      candidate%speed = here%speed - here%turns/slope
    end do
    call try_speed(request, level, candidate, here%speed, rough)
    if (.not. rough%found .or. abs(rough%turns) > far) return
    candidate%speed_error = abs(here%turns) + safety*abs(here%turns - rough%turns) + &
      many*here%change
    if (here%apart > solved_to_turns .or. abs(here%alone) > 0.0_wp) then
      call find_middle(request, above, slope, here, candidate, centre, found)
      if (.not. found) return
      call try_speed(request, above, candidate, candidate%speed, here)
      call try_speed(request, level, candidate, candidate%speed, rough)
      if (.not. (here%found .and. rough%found)) return
      call complete(centre, here)
      call complete(centre, rough)
    end if
    candidate%centre = [rough%centre, here%centre]
    candidate%square = [rough%apart, here%apart]**2 - [rough%turns, here%turns]**2
    candidate%speed_error = max(rounding, candidate%speed_error/(abs(slope)*here%speed))
    candidate%change = many*max(rough%change, here%change)
    candidate%line = nint(here%mean/here%speed)
    ! What went far from the crossing is not solved for.
    candidate%found = candidate%line > 0 .and. candidate%speed_error <= most_error .and. &
      abs(slope*(candidate%speed - candidate%crossing%speed)) <= far_from_crossing

  contains

    pure real(wp) function secant(one, other)
      type(trial_t), intent(in) :: one, other

      secant = (other%turns - one%turns)/(other%speed - one%speed)
    end function secant

  end subroutine refine_speed

  !> The other of two real exponents, from their mean.
  pure subroutine complete(centre, trial)
    real(wp), intent(in) :: centre
    type(trial_t), intent(inout) :: trial

    if (abs(trial%alone) <= 0.0_wp) return
    trial%centre = centre
    trial%apart = abs(trial%alone - centre)
  end subroutine complete

  !> The middle of the interval in which multipliers are real, from its ends: those of the parabola
  !! of the square of turns, less than 0 in it, through a speed in it and one on either side, then
  !! solved for. Its half width is added to the error.
  subroutine find_middle(request, level, slope, inside, candidate, centre, found)
    type(stability_request_t), intent(in) :: request
    type(level_t), intent(in) :: level
    real(wp), intent(in) :: slope                 !! of turns
    type(trial_t), intent(inout) :: inside        !! completed
    type(candidate_t), intent(inout) :: candidate !! at a speed in it; error in turns
    real(wp), intent(out) :: centre               !! mean real part of the exponents on either side
    logical, intent(out) :: found                 !! else only `centre` is set

    type(trial_t) :: side(2)
    real(wp) :: wide, bend, tilt, half, ends(2)
    integer :: i, round

    centre = candidate%centre(2)
    found = .false.
    wide = outside*max(inside%apart, narrow)/abs(slope)
    do round = 1, most_rounds
      do i = 1, 2
        call try_speed(request, level, candidate, candidate%speed + (2*i - 3)*wide, side(i))
      end do
      if (.not. all(side%found)) return
      if (any(abs(side%turns) > other_side)) then
        wide = 0.6_wp*wide
      else if (all(abs(side%turns) > 0.0_wp)) then
        exit
      else
        wide = 2.0_wp*wide
      end if
    end do
    centre = 0.5_wp*sum(side%centre)
    call complete(centre, inside)
    associate (before => side(1)%turns**2, after => side(2)%turns**2, here => -inside%apart**2)
      bend = (0.5_wp*(before + after) - here)/wide**2
      tilt = 0.5_wp*(after - before)/wide
      if (.not. bend > 0.0_wp) return
      half = sqrt(max(0.0_wp, (0.25_wp*tilt**2/bend - here)/bend))
      ends = candidate%speed - 0.5_wp*tilt/bend + [-half, half]
    end associate
    ! The parabola is not quite one.
    if (half*abs(slope) > wide_enough) then
      do i = 1, 2
        call solve_end(side(i), ends(i))
        if (.not. ends(i) > 0.0_wp) return
      end do
    end if
    candidate%speed = 0.5_wp*(ends(1) + ends(2))
    candidate%speed_error = candidate%speed_error + 0.5_wp*abs(slope)*(ends(2) - ends(1))
    found = .true.

  contains

    !> Solves for an end between the speed inside and one outside by false position, where of a
    !! bound that stays twice the value counts half (Illinois).
    subroutine solve_end(outer, at)
      type(trial_t), intent(in) :: outer
      real(wp), intent(inout) :: at !! about there; on return the end, or 0: not found

      type(trial_t) :: here
      real(wp) :: bound(2), value(2), before
      integer :: which, last, round

      bound = [inside%speed, outer%speed]
      value = [-inside%apart**2, outer%turns**2]
      last = 0
      do round = 1, most_rounds_of_ends
        if ((at - bound(1))*(at - bound(2)) >= 0.0_wp) at = 0.5_wp*sum(bound)
        call try_speed(request, level, candidate, at, here)
        if (.not. here%found .or. abs(here%turns) > other_side) exit
        call complete(centre, here)
        which = merge(2, 1, here%turns**2 > here%apart**2)
        bound(which) = at
        value(which) = here%turns**2 - here%apart**2
        if (which == last) value(3 - which) = 0.5_wp*value(3 - which)
        last = which
        before = at
        at = bound(1) - value(1)*(bound(2) - bound(1))/(value(2) - value(1))
        if (abs(at - before) <= enough*request%accuracy*at) return
      end do
      at = 0.0_wp
    end subroutine solve_end

  end subroutine find_middle

  !> The exponent of the crossing at a speed near it.
  subroutine try_speed(request, level, candidate, speed, trial)
    type(stability_request_t), intent(in) :: request
    type(level_t), intent(in), target :: level
    type(candidate_t), intent(in) :: candidate
    real(wp), intent(in) :: speed              !! |ω2| [rad/s]
    type(trial_t), intent(out) :: trial

    type(fourier_plan_t), target :: plan
    type(turn_spectrum_t), target :: spectrum
    type(equation_at_speed_t) :: equation
    type(angle_t), allocatable :: angle(:)
    type(floquet_mode_t), allocatable :: mode(:)
    integer, allocatable :: wanted(:)
    type(error_t), allocatable :: error
    real(wp) :: apart
    integer :: slow, i, m

    trial%speed = speed
    if (was_interrupted()) return
    slow = slow_number(level%grid, request%modes)
    call open_fourier(level%grid%samples, plan)
    attempt: block
      call find_spectrum(level, plan, slow, speed, spectrum, error)
      if (allocated(error)) exit attempt
      call set_equation(level, plan, spectrum%motion, speed, request%damping, request%terms, &
        equation)
      angle = angles_of(spectrum%mode, spectrum%number, speed, request%modes + beside)
      if (size(angle) == 0) exit attempt
      m = nearest_to_one(angle, candidate%crossing%angle%rate)
      ! Of a pair on the circle one tells of both.
      wanted = pack([(i, i=1, size(spectrum%number))], spectrum%number == m)
      if (.not. is_damped(equation%damping)) wanted = &
        [growing_mode(spectrum%mode, spectrum%number, m)]
      allocate (mode(size(wanted)))
      call find_floquet_modes(equation, max(solved_to*request%accuracy/two_pi, least_change), &
        spectrum%mode, wanted, mode)
      if (any(mode%change > far)) exit attempt
      trial%turns = abs(aimag(mode(1)%exponent))
      trial%change = maxval(mode%change)
      if (is_damped(equation%damping)) trial%centre = sum(real(mode%exponent))/size(mode)
      ! A number that is real within its error is real, and so is one far from the centre.
      apart = abs(real(mode(1)%exponent) - trial%centre)
      if (trial%turns <= max(on_axis, many*trial%change, real_share*apart)) then
        trial%turns = 0.0_wp
        trial%apart = apart
        if (is_damped(equation%damping) .and. trial%apart < solved_to_turns) trial%alone = &
          real(mode(1)%exponent)
      end if
      trial%turns = sign(trial%turns, mode(1)%action)
      call find_mean(level, slow, speed, angle(m)%rate*speed, candidate%crossing%mode, trial%mean)
      trial%found = .true.
    end block attempt
    call close_fourier(plan)
  end subroutine try_speed

  !> Mean frequency of a mode of the frozen linkage; where it buckles in some position, that of its
  !! shape.
  subroutine find_mean(level, slow, speed, of_shape, mode, mean)
    type(level_t), intent(in) :: level
    integer, intent(in) :: slow
    real(wp), intent(in) :: speed, of_shape !! [rad/s]
    integer, intent(in) :: mode
    real(wp), intent(out) :: mean           !! [rad/s]

    real(wp), dimension(mode, level%coarse%samples/2) :: frequency, fading
    type(error_t), allocatable :: buckles

    mean = of_shape
    call find_frozen_frequencies(level%basis(slow), speed, frequency, fading, buckles)
    if (.not. allocated(buckles)) mean = sum(frequency(mode, :))/size(frequency, 2)
  end subroutine find_mean

  !> The excitation at a critical speed, on both levels.
  subroutine find_excitation(request, level, above, candidate, critical)
    type(stability_request_t), intent(in) :: request
    type(level_t), intent(in) :: level, above
    type(candidate_t), intent(in) :: candidate
    type(critical_t), intent(out) :: critical

    real(wp), dimension(2) :: rough, fine, ignored, change !! of growth and steady part
    real(wp) :: lack(2)                                    !! on both levels

    critical%speed = candidate%speed
    critical%speed_error = candidate%speed_error
    critical%mode = candidate%crossing%mode
    critical%line = candidate%line
    critical%frequency = critical%line*candidate%speed
    critical%growth = two_pi*candidate%centre(2)
    call solve(level, 1, rough, ignored, lack(1))
    if (allocated(critical%fault)) return
    call solve(above, 2, fine, change, lack(2))
    if (allocated(critical%fault)) return
    critical%excitation = fine(1)
    critical%amplitude = fine(2)
    critical%error = max(rounding, maxval((safety*abs(fine - rough) + change)/max(fine, &
      tiny(1.0_wp))) + safety*lack(2))
    ! The amplitude is that of the resonance over the growth.
    if (fine(2) > 0.0_wp) critical%error = critical%error + candidate%change/max( &
      abs(candidate%centre(2)), candidate%change)
    if (fine(2) <= 0.0_wp .and. any(request%damping%kind /= no_damping)) call set_error( &
      critical%fault, error_of_numerics, "vibrations grow by themselves: there is no steady state")

  contains

    subroutine solve(on, number, largest, change, lack)
      type(level_t), intent(in) :: on
      integer, intent(in) :: number !! of the level
      real(wp), intent(out) :: largest(2), change(2) !! [m]
      real(wp), intent(out) :: lack

      type(fourier_plan_t) :: plan
      type(growth_t) :: found

      call find_growth(on, slow_number(on%grid, request%modes), critical_pair_t(candidate%speed, &
        candidate%centre(number), candidate%square(number), candidate%change), request%damping, &
        request%terms, max(solved_to*request%accuracy, least_change), found, critical%fault)
      if (allocated(critical%fault)) return
      call open_fourier(on%grid%samples, plan)
      largest = [largest_deflection(on%grid, plan, found%growth(:, :, 1)), &
        largest_deflection(on%grid, plan, found%steady(:, :, 1))]
      change = [maxval(sampled_deflections(on%grid, found%growth(:, :, 2))), &
        maxval(sampled_deflections(on%grid, found%steady(:, :, 2)))]
      lack = found%lack
      call close_fourier(plan)
    end subroutine solve

  end subroutine find_excitation

  !> The largest deflection of all links.
  function largest_deflection(grid, plan, y) result(largest)
    type(turn_grid_t), intent(in) :: grid
    type(fourier_plan_t), intent(in) :: plan
    real(wp), intent(in) :: y(:, :)
    real(wp) :: largest !! [m]

    type(response_request_t) :: nothing
    type(speed_response_t) :: peaks

    largest = 0.0_wp
    if (maxval(abs(y)) <= 0.0_wp) return
    allocate (nothing%section(size(grid%integrals)))
    call find_peaks(grid, plan, nothing, y, peaks)
    largest = maxval(peaks%largest_deflection%value)
  end function largest_deflection

end module critical_speeds
