!> Stability of the motion of an elastic linkage at constant speed: the Floquet exponents of its
!! slowest vibrations, each found twice, with other orders and with samples that are no multiple.
!!
!! The second solution is the result, the difference its error. A verdict is given where the error
!! allows one: a multiplier that grows does so by more than its error; one without damping is stable
!! where it is on the circle and farther from those of the other signature, with which alone it
!! could leave it (Krein), than errors reach.
module stability
  use byte_streams, only: byte_stream_t
  use constants, only: two_pi
  use equations_at_speed, only: equation_at_speed_t
  use errors, only: error_of_numerics, error_t, set_error
  use floquet_exponents, only: find_floquet_modes, floquet_mode_t
  use fourier_transform, only: close_fourier, fourier_plan_t, open_fourier
  use frozen_modes, only: find_frozen_frequencies
  use kept_results, only: keep_result, keeper_t, recall_result
  use kinds, only: long, wp
  use link_store, only: link_store_t
  use mode_numbers, only: growing_mode, most_spread
  use order_transfer, only: transferred_halves
  use refinements, only: add_work, begin_round, compare, raise, refinement_limits_t, refinement_t
  use response_bytes, only: pass_refinement
  use response_levels, only: level_slot_t, level_t, set_equation
  use response_types, only: no_damping
  use sorting, only: ascending_order
  use stability_bytes, only: pass_stability
  use stability_types, only: exponent_t, speed_stability_t, stability_request_t, &
    stability_t, stable, undecided, unstable_combination, unstable_flip, unstable_fold
  use structures, only: structure_t
  use text, only: to_string
  use turn_grids, only: turn_grid_t
  use turn_spectra, only: begin_refinements, find_spectrum, need_two_levels, set_too_slow, &
    slow_number, turn_spectrum_t
  implicit none (type, external)
  private

  public :: find_stability

  !> Exponents of both solutions are wrong by no more than these shares of the accuracy for what
  !! their iterations leave. Errors are to hold some times what the second lacks by that.
  real(wp), parameter :: solved_to(2) = [2.0e-1_wp, 1.0e-1_wp], least_change = 1.0e-13_wp, many = &
    3.0_wp

  !> No error is stated smaller than this share of the accuracy: two solutions may agree by chance.
  real(wp), parameter :: least_share = 1.0e-2_wp

  !> The work at a speed takes some two seconds.
  type(refinement_limits_t), parameter :: limits = refinement_limits_t(order=26, rounds=6, &
    work=10000000_long, gain=0.5_wp, idle=1)

  !> Vibrations of the frozen linkage that fade by more than e to this in a turn beside the slowest
  !! to fade: those of the moving one may be lost in rounding.
  real(wp), parameter :: most_fading = 0.75_wp*most_spread

  !> Turns as near as this to 0 or 1/2 are so; exponents as near to each other as this are one.
  real(wp), parameter :: as_good_as = 1.0e-9_wp

  !> Larger errors, which leave no digit.
  real(wp), parameter :: no_digits = 0.1_wp

  !> Frequencies of shapes of slow motions are not known better than by this share.
  real(wp), parameter :: least_doubt = 1.0e-2_wp

  !> With damping, multipliers that have met are no farther from each other than this.
  real(wp), parameter :: met = 0.05_wp

contains

  !> Finds the exponents at all speeds.
  !!
  !! Errors: the crank does not turn fully; own modes of a link could not be found. Those of a speed
  !! are in its result.
  subroutine find_stability(structure, request, threads, store, found, error, keeper)
    class(structure_t), intent(in) :: structure      !! linkage and beams
    type(stability_request_t), intent(in) :: request !! speeds, modes, accuracy
    integer, intent(in) :: threads                   !! number of OpenMP threads
    type(link_store_t), intent(inout) :: store       !! links decomposed earlier
    type(stability_t), intent(out) :: found
    type(error_t), allocatable, intent(out) :: error !! why there is nothing at any speed
    class(keeper_t), intent(inout), optional :: keeper !! of results at speeds, a round each

    type(level_slot_t), allocatable :: levels(:)
    type(refinement_t) :: refinement(size(request%speed))
    integer :: k, round

    allocate (found%at_speed(size(refinement)), levels(0))
    refinement%limits = limits
    call begin_refinements(structure, request, request%modes, request%speed, store, levels, &
      refinement, error)
    if (allocated(error)) return
    do k = 1, size(refinement)
      if (.not. refinement(k)%pending) call set_too_slow(request, found%at_speed(k)%error)
    end do
    round = 0
    do while (any(refinement%pending))
      round = round + 1
      call need_two_levels(structure, request, refinement, store, levels, error)
      if (allocated(error)) return
      !$omp parallel do num_threads(threads) schedule(dynamic) default(shared) private(k)
      do k = 1, size(refinement)
        call find_at_speed(k)
      end do
      !$omp end parallel do
    end do

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
        if (.not. known) call solve_speed(request, abs(request%speed(k)), &
          levels(here%level(1))%level, levels(here%level(2))%level, here, found%at_speed(k))
        if (.not. present(keeper)) return
        call pass_refinement(stream, here)
        call pass_stability(stream, found%at_speed(k))
        call keep_result(keeper, [1, round, k], stream)
      end associate
    end subroutine find_at_speed

  end subroutine find_stability

  !> Solves one speed on both levels: its result, and its next choice of orders and samples if it is
  !! not accurate enough.
  subroutine solve_speed(request, speed, level, above, refinement, found)
    type(stability_request_t), intent(in) :: request
    real(wp), intent(in) :: speed
    type(level_t), intent(in), target :: level, above
    type(refinement_t), intent(inout) :: refinement
    type(speed_stability_t), intent(inout) :: found

    type(speed_stability_t) :: here
    type(fourier_plan_t), target :: plan, above_plan
    type(turn_spectrum_t), target :: spectrum, above_spectrum
    type(equation_at_speed_t) :: equation
    type(floquet_mode_t), allocatable :: modes(:), above_modes(:), known(:)
    real(wp), allocatable :: mean(:)
    integer, allocatable :: wanted(:), above_wanted(:)
    integer :: slow

    slow = slow_number(above%grid, request%modes)
    call open_fourier(level%grid%samples, plan)
    call open_fourier(above%grid%samples, above_plan)
    attempt: block
      call find_spectrum(level, plan, slow_number(level%grid, request%modes), speed, spectrum, &
        here%error)
      if (allocated(here%error)) exit attempt
      wanted = modes_of_numbers(spectrum, request%modes)
      call find_means(level, spectrum%motion%number, speed, spectrum, wanted, mean, here%error)
      if (allocated(here%error)) exit attempt
      call find_spectrum(above, above_plan, slow, speed, above_spectrum, here%error)
      if (allocated(here%error)) exit attempt
      wanted = candidates(spectrum, above_spectrum, size(wanted))
      above_wanted = matched(spectrum, wanted, above_spectrum)
      call set_equation(level, plan, spectrum%motion, speed, request%damping, request%terms, &
        equation)
      call refine_all(equation, solved_to(1)*request%accuracy/two_pi, spectrum, wanted, modes, &
        here%error)
      call count_work(level%grid, sum(modes%applications))
      if (allocated(here%error)) exit attempt
      call transfer
      call set_equation(above, above_plan, above_spectrum%motion, speed, request%damping, &
        request%terms, equation)
      call refine_all(equation, solved_to(2)*request%accuracy/two_pi, above_spectrum, &
        above_wanted, above_modes, here%error, known)
      call count_work(above%grid, sum(above_modes%applications))
      if (allocated(here%error)) exit attempt
      call choose
      here%order = above%order
      here%samples = above%grid%samples
      here%slow = slow
      call judge
    end block attempt
    call close_fourier(above_plan)
    call close_fourier(plan)
    here%applications = here%applications + found%applications
    call settle

  contains

    !> The motions found, on the grid of the second solution.
    subroutine transfer
      integer :: i

      known = modes
      do i = 1, size(modes)
        call transferred_halves(level%grid, plan, above%grid, above_plan, modes(i)%motion, &
          known(i)%motion)
      end do
    end subroutine transfer

    !> Numbers the candidates by the frequencies of their shapes in the whole equation, and leaves
    !! those that are wanted. Of two real multipliers only the one is known there, and nothing of a
    !! candidate that led to the mode of another one.
    subroutine choose
      real(wp) :: frequency(size(above_wanted))
      integer, allocatable :: order(:)
      integer :: i

      frequency = frequency_of(above_spectrum, above_wanted)
      do i = 1, size(frequency)
        associate (mode => above_modes(i))
          if (.not. is_of_another(above_wanted(i), mode%exponent)) frequency(i) = frequency(i)* &
            mode%frequency/above_spectrum%mode(above_wanted(i))%shape_frequency
        end associate
      end do
      order = ascending_order(frequency)
      call renumber(spectrum, order)
      order = order(:size(mean))
      wanted = wanted(order)
      above_wanted = above_wanted(order)
      modes = modes(order)
      above_modes = above_modes(order)
    end subroutine choose

    !> Values, errors and verdicts.
    subroutine judge
      real(wp) :: change, same
      integer :: i, j

      allocate (here%exponent(size(wanted)))
      do i = 1, size(wanted)
        associate (mode => modes(i), better => above_modes(i), exponent => here%exponent(i))
          exponent%mode = spectrum%number(wanted(i))
          exponent%turns = abs(aimag(better%exponent))
          exponent%growth = two_pi*real(better%exponent)
          ! On the circle, where multipliers stay without damping.
          if (.not. has_damping() .and. abs(exponent%growth) <= least_share*request%accuracy) &
            exponent%growth = 0.0_wp
          change = abs(cmplx(real(better%exponent - mode%exponent), exponent%turns - &
            abs(aimag(mode%exponent)), wp))
          do j = 1, size(wanted)
            if (j == i) cycle
            ! Two approximations that lead to one mode or to its conjugate: another is missed.
            associate (other => above_modes(j))
              if (apart_from(other%exponent, better%exponent) <= as_good_as + &
                many*(better%change + other%change)) change = 1.0_wp
            end associate
          end do
          if (is_of_another(above_wanted(i), better%exponent)) change = 1.0_wp
          exponent%error = max(two_pi*(change + mode%change + many*better%change), &
            least_share*request%accuracy)
          exponent%signature = 0
          if (abs(exponent%growth) <= exponent%error .or. has_damping()) &
            exponent%signature = merge(1, -1, better%action > 0.0_wp)
          same = as_good_as
          ! Off the circle, a number that is real within its error is real.
          if (abs(exponent%growth) > exponent%error .and. exponent%error <= no_digits) &
            same = max(same, exponent%error/two_pi)
          if (exponent%turns <= same) exponent%turns = 0.0_wp
          if (0.5_wp - exponent%turns <= same) exponent%turns = 0.5_wp
          if (is_real(exponent)) then
            exponent%signature = 0
            ! Without damping the other of the pair is its inverse.
            if (.not. has_damping()) exponent%growth = abs(exponent%growth)
          end if
          exponent%frequency = nearest_frequency(exponent, mean(exponent%mode))
        end associate
      end do
      do i = 1, size(wanted)
        call give_verdict(i)
      end do
    end subroutine judge

    pure function has_damping() result(yes)
      logical :: yes

      yes = any(request%damping%kind /= no_damping)
    end function has_damping

    !> Whether an exponent is certainly that of another mode of the slow motion: much nearer to it.
    pure function is_of_another(wanted, exponent) result(yes)
      integer, intent(in) :: wanted
      complex(wp), intent(in) :: exponent
      logical :: yes

      real(wp), parameter :: near = 1.0e-3_wp, much = 3.0_wp
      real(wp) :: apart(size(above_spectrum%mode))

      apart = apart_from(above_spectrum%mode%exponent, exponent)
      yes = apart(wanted) > near + much*minval(apart)
    end function is_of_another

    !> Whether the multiplier is a real number.
    pure function is_real(exponent) result(yes)
      type(exponent_t), intent(in) :: exponent
      logical :: yes

      yes = min(exponent%turns, 0.5_wp - exponent%turns) <= 0.0_wp
    end function is_real

    !> The frequency that the turns allow next to a given one.
    pure function nearest_frequency(exponent, mean) result(frequency)
      type(exponent_t), intent(in) :: exponent
      real(wp), intent(in) :: mean
      real(wp) :: frequency

      real(wp) :: turns

      turns = merge(-1.0_wp, 1.0_wp, exponent%signature < 0)*exponent%turns
      frequency = speed*abs(nint(mean/speed - turns) + turns)
    end function nearest_frequency

    !> Whether an exponent is stable, or how it became unstable.
    subroutine give_verdict(i)
      integer, intent(in) :: i

      complex(wp) :: partner
      integer :: k

      associate (exponent => here%exponent(i))
        exponent%verdict = undecided
        if (exponent%error > no_digits) return
        if (exponent%growth > exponent%error .or. (.not. has_damping() .and. &
          exponent%growth < -exponent%error)) then
          if (is_real(exponent)) then
            exponent%verdict = merge(unstable_flip, unstable_fold, exponent%turns > 0.25_wp)
          else
            exponent%verdict = unstable_combination
            partner = above_modes(i)%exponent
            if (.not. has_damping()) partner = -conjg(partner)
            ! Modes are numbered on the first level: numbers may differ where shapes are much alike.
            k = nearest_other(spectrum, wanted(i), partner)
            if (k > 0) exponent%partner = spectrum%number(k)
          end if
        else if (has_damping()) then
          if (exponent%growth < -exponent%error) exponent%verdict = stable
        else if (abs(exponent%growth) <= exponent%error) then
          if (separation(i) > many*exponent%error/two_pi) exponent%verdict = stable
        end if
      end associate
    end subroutine give_verdict

    !> Distance in turns from the nearest multiplier of the other signature, certainly.
    function separation(i) result(distance)
      integer, intent(in) :: i
      real(wp) :: distance

      complex(wp) :: other
      real(wp) :: apart, doubt
      integer :: k, kind

      distance = huge(1.0_wp)
      associate (spectrum => above_spectrum, mine => above_modes(i))
        ! Those of others are known from the slow motion.
        doubt = many*abs(spectrum%mode(above_wanted(i))%exponent - mine%exponent)
        do k = 1, size(spectrum%mode)
          do kind = 1, 2
            other = spectrum%mode(k)%exponent
            if (kind == 2) other = conjg(other)
            if (k == above_wanted(i) .and. kind == 1) cycle
            if (k == above_wanted(i)) other = conjg(mine%exponent)
            apart = aimag(other - mine%exponent)
            apart = abs(cmplx(real(other - mine%exponent), apart - anint(apart), wp))
            if (k /= above_wanted(i) .and. same_side(spectrum%mode(k)%action*merge(-1, 1, &
              kind == 2), mine%action)) cycle
            if (k /= above_wanted(i)) apart = apart - doubt
            distance = min(distance, apart)
          end do
        end do
      end associate
    end function separation

    subroutine count_work(grid, applications)
      type(turn_grid_t), intent(in) :: grid
      integer, intent(in) :: applications

      here%applications = here%applications + applications
      call add_work(refinement, grid, applications)
    end subroutine count_work

    !> Keeps the better result, and raises order and samples if it is not good enough.
    subroutine settle
      real(wp) :: largest
      logical :: is_best

      here%applications = max(here%applications, found%applications)
      largest = huge(1.0_wp)
      if (allocated(here%exponent)) largest = maxval(here%exponent%error)
      call compare(refinement, largest, is_best)
      if (largest > request%accuracy) call raise(refinement, 1, refinement%samples + 1)
      if (is_best .or. .not. allocated(found%exponent)) found = here
      found%applications = here%applications
    end subroutine settle

  end subroutine solve_speed

  !> Whether actions have one sign for certain.
  pure function same_side(one, other) result(same)
    real(wp), intent(in) :: one, other
    logical :: same

    real(wp), parameter :: certain = 1.0e-3_wp

    same = min(abs(one), abs(other)) > certain .and. one*other > 0.0_wp
  end function same_side

  !> The modes of the slowest vibrations, in the order of their numbers.
  pure function modes_of_numbers(spectrum, most) result(modes)
    type(turn_spectrum_t), intent(in) :: spectrum
    integer, intent(in) :: most
    integer, allocatable :: modes(:)

    integer :: i

    modes = [(growing_mode(spectrum%mode, spectrum%number, i), i=1, min(most, &
      maxval(spectrum%number)))]
  end function modes_of_numbers

  !> The modes that may be the slowest ones, in the order of their numbers: a multiplier that by the
  !! slow motion alone meets that of a fast vibration gets of its shape, and of its frequency. That
  !! of two levels differs then.
  pure function candidates(spectrum, above, wanted) result(modes)
    type(turn_spectrum_t), intent(in) :: spectrum, above
    integer, intent(in) :: wanted !! modes
    integer, allocatable :: modes(:)

    real(wp), allocatable :: frequency(:), doubt(:)

    modes = modes_of_numbers(spectrum, size(above%mode))
    frequency = frequency_of(spectrum, modes)
    doubt = max(least_doubt*frequency, abs(frequency_of(above, matched(spectrum, modes, above)) - &
      frequency))
    modes = modes(:findloc(frequency - doubt <= maxval(frequency(:wanted) + doubt(:wanted)), &
      .true., dim=1, back=.true.))
  end function candidates

  !> Frequencies of shapes by which vibrations are numbered: of two real multipliers the smaller.
  pure function frequency_of(spectrum, modes) result(frequency)
    type(turn_spectrum_t), intent(in) :: spectrum
    integer, intent(in) :: modes(:)
    real(wp) :: frequency(size(modes))

    integer :: i

    frequency = spectrum%mode(modes)%shape_frequency
    do i = 1, size(modes)
      if (spectrum%number(modes(i)) > 0) frequency(i) = minval(spectrum%mode%shape_frequency, &
        mask=spectrum%number == spectrum%number(modes(i)))
    end do
  end function frequency_of

  !> Gives modes, with the real ones that are of the same vibration, the numbers 1, 2, ….
  pure subroutine renumber(spectrum, number)
    type(turn_spectrum_t), intent(inout) :: spectrum
    integer, intent(in) :: number(:) !! that they have: 1, 2, … in their new order

    integer :: before(size(spectrum%number)), i

    before = spectrum%number
    do i = 1, size(number)
      where (before == number(i)) spectrum%number = i
    end do
  end subroutine renumber

  !> Modes of the whole equation.
  !!
  !! Errors: nothing is known of an exponent.
  subroutine refine_all(equation, change, spectrum, wanted, modes, error, known)
    type(equation_at_speed_t), intent(in) :: equation
    real(wp), intent(in) :: change !! the last, if it can be as small
    type(turn_spectrum_t), intent(in) :: spectrum
    integer, intent(in) :: wanted(:)
    type(floquet_mode_t), allocatable, intent(out) :: modes(:)
    type(error_t), allocatable, intent(out) :: error
    type(floquet_mode_t), intent(in), optional :: known(:) !! about these

    allocate (modes(size(wanted)))
    call find_floquet_modes(equation, max(change, least_change), spectrum%mode, wanted, modes, &
      known)
    if (any(modes%change >= huge(1.0_wp))) call set_error(error, error_of_numerics, &
      "nothing is known of the exponent of a vibration: the equation has none in its motions")
  end subroutine refine_all

  !> The modes of another level with the exponents of those wanted, each once; of two real
  !! multipliers the one that grows.
  pure function matched(spectrum, wanted, other) result(found)
    type(turn_spectrum_t), intent(in) :: spectrum, other
    integer, intent(in) :: wanted(:)
    integer :: found(size(wanted))

    logical :: free(size(other%mode))
    integer :: i

    free = .false.
    free(modes_of_numbers(other, size(other%mode))) = .true.
    if (count(free) < size(wanted)) free = .true.
    do i = 1, size(wanted)
      found(i) = minloc(abs(other%mode%exponent - spectrum%mode(wanted(i))%exponent), dim=1, &
        mask=free)
      free(found(i)) = .false.
    end do
  end function matched

  !> Distance of an exponent from another or from its conjugate, which is of the same vibration.
  elemental function apart_from(other, exponent) result(apart)
    complex(wp), intent(in) :: other, exponent
    real(wp) :: apart

    apart = min(abs(other - exponent), abs(conjg(other) - exponent))
  end function apart_from

  !> The mode of another vibration whose exponent is nearest; 0: none is near.
  pure function nearest_other(spectrum, mine, exponent) result(nearest)
    type(turn_spectrum_t), intent(in) :: spectrum
    integer, intent(in) :: mine
    complex(wp), intent(in) :: exponent
    integer :: nearest

    real(wp) :: apart, smallest
    integer :: k

    nearest = 0
    smallest = met
    do k = 1, size(spectrum%mode)
      if (spectrum%number(k) == spectrum%number(mine)) cycle
      apart = apart_from(spectrum%mode(k)%exponent, exponent)
      if (apart >= smallest) cycle
      smallest = apart
      nearest = k
    end do
  end function nearest_other

  !> Mean frequencies over the turn of the frozen linkage; where it buckles in some position, those
  !! of the shapes of the moving one.
  !!
  !! Errors: a vibration fades so fast that its multiplier is lost in rounding.
  subroutine find_means(level, slow, speed, spectrum, wanted, mean, error)
    type(level_t), intent(in) :: level
    integer, intent(in) :: slow
    real(wp), intent(in) :: speed
    type(turn_spectrum_t), intent(in) :: spectrum
    integer, intent(in) :: wanted(:)
    real(wp), allocatable, intent(out) :: mean(:) !! (modes) [rad/s]
    type(error_t), allocatable, intent(out) :: error

    type(error_t), allocatable :: buckles
    real(wp), dimension(size(wanted), level%coarse%samples/2) :: frequency, fading
    real(wp) :: spread

    call find_frozen_frequencies(level%basis(slow), speed, frequency, fading, buckles)
    if (allocated(buckles)) then
      mean = spectrum%mode(wanted)%shape_frequency
      return
    end if
    mean = sum(frequency, dim=2)/size(frequency, 2)
    associate (mean_fading => sum(fading, dim=2)/size(fading, 2))
      spread = two_pi/speed*(maxval(mean_fading) - minval(mean_fading))
    end associate
    if (spread > most_fading) call set_error(error, error_of_numerics, "a vibration fades too "// &
      "fast: by about e^"//to_string(spread, 3)//" in a turn beside another, and rounding "// &
      "leaves nothing of its exponent")
  end subroutine find_means

end module stability
