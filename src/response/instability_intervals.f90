!> Intervals of speed in which free vibrations of a running linkage grow (parametric resonance),
!! found by following multipliers over the speed, not by sampling it.
!!
!! Without damping multipliers leave the unit circle only where two of opposite Krein signature
!! meet: where the phases of two vibrations, counted in the sense of their signatures, add up to a
!! whole number of turns, `αᵢ + αⱼ = N`. The phases are followed from speed to speed by the slow
!! motion; between two speeds every N that a sum passes is a meeting. There `D = −(σᵢ − σⱼ)²`, with
!! both on one sheet, is an analytic function of the speed, positive beside an interval and negative
!! in it: its least value gives the largest growth, its zeros are the edges. Those of intervals that
!! count are found from the whole equation, with two orders and numbers of samples.
module instability_intervals
  use constants, only: two_pi
  use errors, only: error_t
  use floquet_exponents, only: find_floquet_modes, floquet_mode_t
  use fourier_transform, only: close_fourier, fourier_plan_t, open_fourier
  use interruption, only: was_interrupted
  use kinds, only: wp
  use link_store, only: link_store_t
  use response_levels, only: damping_of, level_slot_t, level_t, need_basis, need_level, &
    sample_numbers
  use response_types, only: link_damping_t, no_damping
  use sorting, only: ascending_order
  use stability, only: find_spectrum, first_order, first_samples, slow_number, turn_spectrum_t
  use stability_types, only: gap_t, instability_t, intervals_t, stability_request_t, &
    unstable_combination, unstable_flip, unstable_fold
  use structures, only: structure_t
  implicit none (type, external)
  private

  public :: find_intervals

  !> Steps of the speed: so long, in terms of the speed, and no longer than this [rad/s]; the
  !! shortest by halving.
  real(wp), parameter :: step_share = 0.01_wp, longest_step = 0.125_wp, shortest_share = 1.0e-4_wp

  !> A vibration is followed while its frequency is found so near to where it is expected, in terms
  !! of the speed.
  real(wp), parameter :: near_enough = 0.02_wp

  !> Sums of phases this near to a whole number are locked to it.
  real(wp), parameter :: locked = 1.0e-9_wp

  !> Distance in turns of the places beside a meeting from which its growth is found.
  real(wp), parameter :: beside = 3.0e-4_wp

  !> Growth in the slow motion above this share of the least that counts is looked into.
  real(wp), parameter :: worth = 0.5_wp

  !> Edges are found to this share of the speed; most steps for an edge and for a peak.
  real(wp), parameter :: fine_edge = 1.0e-9_wp
  integer, parameter :: most_steps = 40

  !> Actions above this are certain of their sign.
  real(wp), parameter :: certain = 0.1_wp

  !> Most parabolas for a least value; the last change of an exponent.
  integer, parameter :: most_parabolas = 10
  real(wp), parameter :: last_change = 1.0e-12_wp

  !> Orders of the second solution above those of the first.
  integer, parameter :: orders_above = 2

  !> Estimated errors are this many times the difference of both solutions, and at least so much of
  !! the speed.
  real(wp), parameter :: safety = 2.0_wp, least_error = 1.0e-8_wp

  !> A meeting of two vibrations.
  type :: meeting_t
    logical :: of_one = .false.               !! of a vibration with its own conjugate
    real(wp) :: speed(2) = 0.0_wp             !! between which it is [rad/s]
    real(wp) :: frequency(2, 2) = 0.0_wp      !! (vibrations, speeds) [rad/s]
    real(wp) :: total = 0.0_wp                !! N
    real(wp) :: center = 0.0_wp               !! speed of largest growth
    real(wp) :: least = 0.0_wp                !! D there
    real(wp) :: slope = 0.0_wp                !! of the sum of phases [turns per rad/s]
    logical :: is_lost = .false.              !! vibrations were not found again
  end type meeting_t

  !> Multipliers at a speed on the sheet on which their signature is positive.
  type :: station_t
    real(wp) :: speed = 0.0_wp
    logical :: is_known = .false.
    real(wp), allocatable :: phase(:) !! (candidates) [turns]
    real(wp), allocatable :: frequency(:) !! (modes) of the vibrations by their numbers [rad/s]
  end type station_t

contains

  !> Finds the intervals between the least and the greatest speed of a request.
  !!
  !! Errors: the crank does not turn fully; own modes of a link could not be found.
  subroutine find_intervals(structure, request, threads, store, found, error)
    class(structure_t), intent(in) :: structure      !! linkage and beams
    type(stability_request_t), intent(in) :: request !! speeds of one sign, modes, least growth
    integer, intent(in) :: threads                   !! number of OpenMP threads
    type(link_store_t), intent(inout) :: store       !! links decomposed earlier
    type(intervals_t), intent(out) :: found
    type(error_t), allocatable, intent(out) :: error !! why there are none

    type(level_slot_t), allocatable :: levels(:), damped_levels(:)
    type(stability_request_t) :: undamped
    type(meeting_t), allocatable :: meetings(:)
    type(instability_t), allocatable :: intervals(:)
    integer :: number(2, size(sample_numbers)), damped_number(2, size(sample_numbers)), i

    undamped = request
    undamped%damping = link_damping_t()
    found%range = [minval(abs(request%speed)), maxval(abs(request%speed))]
    allocate (levels(0), damped_levels(0), found%gap(0))
    call make_levels(structure, undamped, found%range, store, levels, number, error)
    if (allocated(error)) return
    call find_meetings(undamped, levels, number, threads, meetings, found)
    found%meetings = size(meetings)
    !$omp parallel do num_threads(threads) schedule(dynamic) default(shared) private(i)
    do i = 1, size(meetings)
      if (.not. was_interrupted()) call look_into(undamped, levels, number, meetings(i))
    end do
    !$omp end parallel do
    do i = 1, size(meetings)
      if (meetings(i)%is_lost) found%gap = [found%gap, gap_t(meetings(i)%speed(1), &
        meetings(i)%speed(2), "two multipliers that meet there are too near to others")]
    end do
    meetings = pack(meetings, .not. meetings%is_lost .and. pi_root(-meetings%least) >= &
      worth*request%least_growth)
    allocate (intervals(size(meetings)))
    !$omp parallel do num_threads(threads) schedule(dynamic) default(shared) private(i)
    do i = 1, size(meetings)
      if (.not. was_interrupted()) call measure_interval(undamped, levels, number, meetings(i), &
        intervals(i))
    end do
    !$omp end parallel do
    if (any(request%damping%kind /= no_damping)) then
      call make_levels(structure, request, found%range, store, damped_levels, damped_number, error)
      if (allocated(error)) return
      !$omp parallel do num_threads(threads) schedule(dynamic) default(shared) private(i)
      do i = 1, size(meetings)
        if (intervals(i)%growth > 0.0_wp .and. .not. was_interrupted()) call measure_damped( &
          request, damped_levels, damped_number, meetings(i), intervals(i))
      end do
      !$omp end parallel do
    end if
    intervals = pack(intervals, intervals%growth >= request%least_growth .and. &
      intervals%to > found%range(1) .and. intervals%from < found%range(2))
    found%interval = intervals(ascending_order(intervals%from))
  end subroutine find_intervals

  !> `π √x`, 0 of what is negative: the growth in a turn of exponents whose difference has the
  !! square x.
  elemental function pi_root(x) result(growth)
    real(wp), intent(in) :: x
    real(wp) :: growth

    growth = 0.5_wp*two_pi*sqrt(max(x, 0.0_wp))
  end function pi_root

  !> Makes the levels of all speeds, by the place in `sample_numbers` of the samples that they need.
  subroutine make_levels(structure, request, range, store, levels, number, error)
    class(structure_t), intent(in) :: structure
    type(stability_request_t), intent(in) :: request
    real(wp), intent(in) :: range(2)
    type(link_store_t), intent(inout) :: store
    type(level_slot_t), allocatable, intent(inout) :: levels(:)
    integer, intent(out) :: number(:, :) !! (first and second solution, place); 0: none needs it
    type(error_t), allocatable, intent(out) :: error

    integer :: at, first, i, order
    logical :: backwards

    backwards = request%speed(1) < 0.0_wp
    order = first_order(request%accuracy)
    number = 0
    call need_level(structure, order, sample_numbers(1), backwards, store, levels, first, error)
    if (allocated(error)) return
    do at = place_of(levels(first)%level, request, range(2)), &
      place_of(levels(first)%level, request, range(1))
      do i = 1, 2
        call need_level(structure, order + (i - 1)*orders_above, (i + 1)*sample_numbers(at)/2, &
          backwards, store, levels, number(i, at), error)
        if (allocated(error)) return
        associate (level => levels(number(i, at))%level)
          call need_basis(slow_number(level%grid, request%modes), request%damping, level, error, &
            .true.)
        end associate
        if (allocated(error)) return
      end do
    end do
  end subroutine make_levels

  !> The place of the samples for a speed; where it is too slow, the last.
  pure function place_of(level, request, speed) result(at)
    type(level_t), intent(in) :: level
    type(stability_request_t), intent(in) :: request
    real(wp), intent(in) :: speed
    integer :: at

    at = first_samples(level%grid, request%modes, speed, request%accuracy)
    if (at == 0) at = size(sample_numbers)
  end function place_of

  !> The free motions of the slow coordinates at a speed.
  subroutine find_spectrum_at(request, levels, number, speed, second, spectrum, level, error)
    type(stability_request_t), intent(in) :: request
    type(level_slot_t), intent(in) :: levels(:)
    integer, intent(in) :: number(:, :)
    real(wp), intent(in) :: speed
    logical, intent(in) :: second            !! on the level of the second solution
    type(turn_spectrum_t), intent(out) :: spectrum
    integer, intent(out) :: level            !! its number
    type(error_t), allocatable, intent(out) :: error

    type(fourier_plan_t) :: plan
    integer :: at

    at = place_of(levels(1)%level, request, speed)
    at = max(at, findloc(number(1, :) > 0, .true., dim=1))
    at = min(at, findloc(number(1, :) > 0, .true., dim=1, back=.true.))
    level = number(merge(2, 1, second), at)
    call open_fourier(levels(level)%level%grid%samples, plan)
    call find_spectrum(levels(level)%level, plan, slow_number(levels(level)%level%grid, &
      request%modes), speed, spectrum, error)
    call close_fourier(plan)
  end subroutine find_spectrum_at

  !> Follows the vibrations over the speed, and finds where their phases meet.
  subroutine find_meetings(request, levels, number, threads, meetings, found)
    type(stability_request_t), intent(in) :: request
    type(level_slot_t), intent(in) :: levels(:)
    integer, intent(in) :: number(:, :)
    integer, intent(in) :: threads
    type(meeting_t), allocatable, intent(out) :: meetings(:)
    type(intervals_t), intent(inout) :: found !! gets gaps and the number of stations

    type(station_t), allocatable :: stations(:), here
    real(wp), allocatable :: speeds(:), frequency(:), slope(:)
    real(wp) :: speed
    logical :: is_first
    integer :: k

    speeds = [found%range(1)]
    do while (speeds(size(speeds)) < found%range(2))
      speed = speeds(size(speeds))
      speeds = [speeds, min(speed + min(step_share*speed, longest_step), found%range(2))]
    end do
    allocate (stations(size(speeds)), meetings(0))
    !$omp parallel do num_threads(threads) schedule(dynamic) default(shared) private(k)
    do k = 1, size(speeds)
      if (.not. was_interrupted()) call find_station(request, levels, number, speeds(k), &
        stations(k))
    end do
    !$omp end parallel do
    found%stations = size(speeds)
    is_first = .true.
    do k = 1, size(stations)
      if (.not. stations(k)%is_known) then
        call add_gap(max(1, k - 1), k, "multipliers grow too much in a turn")
        is_first = .true.
        cycle
      end if
      if (is_first) then
        frequency = stations(k)%frequency
        slope = 0.0_wp*frequency
        is_first = .false.
        call count_meetings(stations(k), stations(k)%frequency, stations(k), &
          stations(k)%frequency, .true.)
        cycle
      end if
      here = stations(k - 1)
      call advance(here, stations(k), is_first)
      if (is_first) then
        call add_gap(k - 1, k, "vibrations cannot be told apart")
        frequency = stations(k)%frequency
        slope = 0.0_wp
        is_first = .false.
      end if
    end do

  contains

    subroutine add_gap(from, to, reason)
      integer, intent(in) :: from, to
      character(len=*), intent(in) :: reason

      found%gap = [found%gap, gap_t(speeds(from), speeds(to), reason)]
    end subroutine add_gap

    !> Goes on from a station to another, in steps that are short enough.
    subroutine advance(from, goal, failed)
      type(station_t), intent(inout) :: from
      type(station_t), intent(in) :: goal
      logical, intent(out) :: failed

      type(station_t) :: next
      real(wp) :: new(size(frequency)), h
      logical :: good

      failed = .false.
      next = goal
      do
        h = next%speed - from%speed
        if (next%is_known) call match(next, frequency + slope*h, new, good)
        if (next%is_known .and. good) then
          call count_meetings(from, frequency, next, new, .false.)
          slope = (new - frequency)/h
          frequency = new
          from = next
          if (from%speed >= goal%speed) return
          next = goal
          cycle
        end if
        failed = h < shortest_share*from%speed
        if (failed) return
        call find_station(request, levels, number, from%speed + 0.5_wp*h, next)
        found%stations = found%stations + 1
      end do
    end subroutine advance

    !> Frequencies at a station, each the nearest to where it is expected.
    subroutine match(station, expected, frequency, good)
      type(station_t), intent(in) :: station
      real(wp), intent(in) :: expected(:)
      real(wp), intent(out) :: frequency(:)
      logical, intent(out) :: good

      real(wp) :: apart(size(station%phase))
      logical :: free(size(station%phase))
      integer :: i, nearest

      free = .true.
      good = .true.
      do i = 1, size(expected)
        apart = station%phase - expected(i)/station%speed
        apart = apart - anint(apart)
        nearest = minloc(abs(apart), dim=1, mask=free)
        free(nearest) = .false.
        frequency(i) = expected(i) + apart(nearest)*station%speed
        good = good .and. abs(apart(nearest)) < near_enough
      end do
    end subroutine match

    !> Appends the meetings between two stations; at the first, those that last there.
    subroutine count_meetings(left, at_left, right, at_right, at_first)
      type(station_t), intent(in) :: left, right
      real(wp), intent(in) :: at_left(:), at_right(:)
      logical, intent(in) :: at_first

      type(meeting_t) :: meeting
      real(wp) :: total(2)
      integer :: i, j, n

      do i = 1, size(at_left)
        do j = i, size(at_left)
          total = [(at_left(i) + at_left(j))/left%speed, (at_right(i) + at_right(j))/right%speed]
          do n = ceiling(minval(total) - locked), floor(maxval(total) + locked)
            if (abs(total(1) - n) <= locked .neqv. at_first) cycle
            meeting%of_one = i == j
            meeting%speed = [left%speed, right%speed]
            meeting%frequency(:, 1) = [at_left(i), at_left(j)]
            meeting%frequency(:, 2) = [at_right(i), at_right(j)]
            meeting%total = n
            meetings = [meetings, meeting]
          end do
        end do
      end do
    end subroutine count_meetings

  end subroutine find_meetings

  !> The multipliers at a speed, each on the sheet where its signature is positive; on both if it has
  !! none.
  subroutine find_station(request, levels, number, speed, station)
    type(stability_request_t), intent(in) :: request
    type(level_slot_t), intent(in) :: levels(:)
    integer, intent(in) :: number(:, :)
    real(wp), intent(in) :: speed
    type(station_t), intent(out) :: station

    type(turn_spectrum_t) :: spectrum
    type(error_t), allocatable :: error
    real(wp) :: turns
    integer :: i, k, level

    station%speed = speed
    call find_spectrum_at(request, levels, number, speed, .false., spectrum, level, error)
    if (allocated(error)) return
    station%is_known = .true.
    allocate (station%phase(0))
    do k = 1, size(spectrum%mode)
      turns = aimag(spectrum%mode(k)%exponent)
      if (abs(spectrum%mode(k)%action) < certain) then
        station%phase = [station%phase, turns, -turns]
      else
        station%phase = [station%phase, sign(turns, spectrum%mode(k)%action)]
      end if
    end do
    allocate (station%frequency(min(request%modes, maxval(spectrum%number))))
    do i = 1, size(station%frequency)
      k = findloc(spectrum%number, i, dim=1)
      turns = aimag(spectrum%mode(k)%exponent)
      if (spectrum%mode(k)%action < 0.0_wp) turns = -turns
      station%frequency(i) = speed*(turns + anint(spectrum%mode(k)%shape_frequency/speed - turns))
    end do
  end subroutine find_station

  !> The two multipliers of a meeting at a speed: numbers of their modes, whether each is the
  !! conjugate, and `σᵢ − σⱼ`, both on one sheet.
  pure subroutine find_pair(spectrum, meeting, speed, mode, conjugate, waves, difference, good)
    type(turn_spectrum_t), intent(in) :: spectrum
    type(meeting_t), intent(in) :: meeting
    real(wp), intent(in) :: speed
    integer, intent(out) :: mode(2)
    logical, intent(out) :: conjugate(2)
    integer, intent(out) :: waves(2)           !! turns to be added for the common sheet
    complex(wp), intent(out) :: difference
    logical, intent(out) :: good

    complex(wp) :: expected(2), value, chosen(2)
    real(wp) :: share, phase(2), apart, smallest
    integer :: i, k, kind, shift

    share = 0.0_wp
    if (meeting%speed(2) > meeting%speed(1)) share = (speed - meeting%speed(1))/ &
      (meeting%speed(2) - meeting%speed(1))
    phase = (meeting%frequency(:, 1) + share*(meeting%frequency(:, 2) - meeting%frequency(:, 1)))/ &
      speed
    expected = [cmplx(0.0_wp, phase(1), wp), cmplx(0.0_wp, meeting%total - phase(2), wp)]
    good = .true.
    mode = 0
    chosen = 0.0_wp
    do i = 1, 2
      smallest = huge(1.0_wp)
      do k = 1, size(spectrum%mode)
        do kind = 1, merge(2, 1, spectrum%mode(k)%is_complex)
          if (i == 2 .and. k == mode(1) .and. (kind == 2 .eqv. conjugate(1))) cycle
          ! The first on the sheet of its positive signature, the second on the other.
          associate (action => spectrum%mode(k)%action)
            if (abs(action) > certain .and. ((kind == 1 .eqv. action > 0.0_wp) .neqv. i == 1)) cycle
          end associate
          value = spectrum%mode(k)%exponent
          if (kind == 2) value = conjg(value)
          shift = nint(aimag(expected(i) - value))
          apart = abs(value + cmplx(0.0_wp, shift, wp) - expected(i))
          if (apart >= smallest) cycle
          smallest = apart
          mode(i) = k
          conjugate(i) = kind == 2
          waves(i) = shift
          chosen(i) = value + cmplx(0.0_wp, shift, wp)
        end do
      end do
      good = good .and. mode(i) > 0 .and. smallest < 0.1_wp
    end do
    difference = chosen(1) - chosen(2)
  end subroutine find_pair

  !> Finds the speed near a meeting at which D is least, by the slow motion.
  subroutine look_into(request, levels, number, meeting)
    type(stability_request_t), intent(in) :: request
    type(level_slot_t), intent(in) :: levels(:)
    integer, intent(in) :: number(:, :)
    type(meeting_t), intent(inout) :: meeting

    real(wp) :: total(2), slope, h
    logical :: good

    total = sum(meeting%frequency, dim=1)/meeting%speed
    slope = -meeting%total/meeting%speed(1)
    if (meeting%speed(2) > meeting%speed(1) .and. abs(total(2) - meeting%total) > locked) &
      slope = (total(2) - total(1))/(meeting%speed(2) - meeting%speed(1))
    meeting%center = meeting%speed(1)
    if (abs(total(1) - meeting%total) > locked) meeting%center = min(meeting%speed(2), &
      max(meeting%speed(1), meeting%speed(1) + (meeting%total - total(1))/slope))
    h = beside/max(abs(slope), tiny(1.0_wp))
    call find_least(value_of, 0.5_wp, meeting%center, h, meeting%least, meeting%slope, good)
    meeting%is_lost = .not. good

  contains

    subroutine value_of(speed, value, good)
      real(wp), intent(in) :: speed
      real(wp), intent(out) :: value
      logical, intent(out) :: good

      type(turn_spectrum_t) :: spectrum
      type(error_t), allocatable :: error
      complex(wp) :: difference
      integer :: level, mode(2), waves(2)
      logical :: conjugate(2)

      value = 0.0_wp
      call find_spectrum_at(request, levels, number, speed, .false., spectrum, level, error)
      good = .not. allocated(error)
      if (.not. good) return
      call find_pair(spectrum, meeting, speed, mode, conjugate, waves, difference, good)
      value = -real(difference**2)
    end subroutine value_of

  end subroutine look_into

  !> The least value of a function, by parabolas through three places.
  subroutine find_least(value_of, share, place, h, least, slope, good)
    interface
      subroutine value_of(speed, value, good)
        import :: wp
        real(wp), intent(in) :: speed
        real(wp), intent(out) :: value
        logical, intent(out) :: good
      end subroutine value_of
    end interface
    real(wp), intent(in) :: share        !! of h that the place moves at most in the last step
    real(wp), intent(inout) :: place     !! start, then where it is least
    real(wp), intent(inout) :: h         !! distance of the places
    real(wp), intent(out) :: least, slope !! value; root of half the second derivative
    logical, intent(out) :: good         !! found

    real(wp) :: value(-1:1), curvature, gradient, move
    integer :: i, step

    do step = 1, most_parabolas
      do i = -1, 1
        call value_of(place + i*h, value(i), good)
        if (.not. good) return
      end do
      curvature = (value(-1) - 2.0_wp*value(0) + value(1))/(2.0_wp*h**2)
      gradient = (value(1) - value(-1))/(2.0_wp*h)
      good = curvature > 0.0_wp
      if (.not. good) then
        h = 0.5_wp*h
        cycle
      end if
      move = -gradient/(2.0_wp*curvature)
      least = value(0) + 0.5_wp*gradient*move
      slope = sqrt(curvature)
      good = abs(move) <= share*h
      place = place + max(-10.0_wp*h, min(10.0_wp*h, move))
      if (good) return
    end do
  end subroutine find_least

  !> Edges and largest growth of an interval from the whole equation, on both levels. Its growth is 0
  !! where there is none.
  subroutine measure_interval(request, levels, number, meeting, interval)
    type(stability_request_t), intent(in) :: request
    type(level_slot_t), intent(in) :: levels(:)
    integer, intent(in) :: number(:, :)
    type(meeting_t), intent(in) :: meeting
    type(instability_t), intent(out) :: interval

    type(instability_t) :: first
    integer :: modes(2)
    logical :: second

    modes = 0
    interval%kind = unstable_combination
    if (meeting%of_one) interval%kind = merge(unstable_flip, unstable_fold, &
      modulo(nint(meeting%total), 2) == 1)
    second = .false.
    call measure(value_of, meeting%center, sqrt(max(-meeting%least, 0.0_wp))/meeting%slope, first)
    if (first%growth <= 0.0_wp) return
    second = .true.
    call measure(value_of, first%at, 0.5_wp*(first%to - first%from), interval)
    interval%kind = merge(interval%kind, unstable_combination, meeting%of_one)
    interval%mode = [minval(modes), maxval(modes)]
    call compare(first, interval)
    interval%growth = pi_root(interval%growth)
    first%growth = pi_root(first%growth)
    interval%growth_error = max(safety*abs(interval%growth - first%growth), request%accuracy)

  contains

    !> `D` by the whole equation.
    subroutine value_of(speed, value, good)
      real(wp), intent(in) :: speed
      real(wp), intent(out) :: value
      logical, intent(out) :: good

      type(turn_spectrum_t) :: spectrum
      type(error_t), allocatable :: error
      complex(wp) :: difference, exponent(2)
      integer :: i, level, mode(2), waves(2)
      logical :: conjugate(2)

      value = 0.0_wp
      call find_spectrum_at(request, levels, number, speed, second, spectrum, level, error)
      good = .not. allocated(error)
      if (.not. good) return
      call find_pair(spectrum, meeting, speed, mode, conjugate, waves, difference, good)
      if (.not. good) return
      modes = spectrum%number(mode)
      do i = 1, merge(1, 2, meeting%of_one)
        exponent(i) = refined(request, levels(level)%level, spectrum, mode(i), speed)
        if (conjugate(i)) exponent(i) = conjg(exponent(i))
        exponent(i) = exponent(i) + cmplx(0.0_wp, waves(i), wp)
      end do
      ! Either part is zero.
      if (meeting%of_one) then
        value = (2.0_wp*aimag(exponent(1)) - meeting%total)**2 - 4.0_wp*real(exponent(1))**2
      else
        value = aimag(exponent(1) - exponent(2))**2 - real(exponent(1) - exponent(2))**2
      end if
    end subroutine value_of

  end subroutine measure_interval

  !> What damping leaves of an interval.
  subroutine measure_damped(request, levels, number, meeting, interval)
    type(stability_request_t), intent(in) :: request
    type(level_slot_t), intent(in) :: levels(:)
    integer, intent(in) :: number(:, :)
    type(meeting_t), intent(in) :: meeting
    type(instability_t), intent(inout) :: interval !! without damping, then with it

    type(instability_t) :: first, other
    logical :: second

    second = .false.
    call measure(value_of, interval%at, 0.5_wp*(interval%to - interval%from), first)
    interval%growth = 0.0_wp
    if (first%growth <= 0.0_wp) return
    second = .true.
    call measure(value_of, first%at, 0.5_wp*(first%to - first%from), other)
    other%kind = merge(interval%kind, unstable_combination, meeting%of_one)
    other%mode = interval%mode
    call compare(first, other)
    other%growth = two_pi*other%growth
    other%growth_error = max(safety*abs(other%growth - two_pi*first%growth), request%accuracy)
    interval = other

  contains

    !> The largest growth of any vibration, negative.
    subroutine value_of(speed, value, good)
      real(wp), intent(in) :: speed
      real(wp), intent(out) :: value
      logical, intent(out) :: good

      type(turn_spectrum_t) :: spectrum
      type(error_t), allocatable :: error
      integer :: level

      value = 0.0_wp
      call find_spectrum_at(request, levels, number, speed, second, spectrum, level, error)
      good = .not. allocated(error)
      if (good) value = -real(refined(request, levels(level)%level, spectrum, &
        maxloc(real(spectrum%mode%exponent, wp), dim=1), speed))
    end subroutine value_of

  end subroutine measure_damped

  !> Estimated error of the edges from both solutions.
  pure subroutine compare(first, interval)
    type(instability_t), intent(in) :: first
    type(instability_t), intent(inout) :: interval

    interval%error = max(safety*max(abs(interval%from - first%from), abs(interval%to - first%to)), &
      least_error*interval%at)
  end subroutine compare

  !> Where a value is negative: edges, place of the least one and, as growth, that with the other
  !! sign; 0 where there is none.
  subroutine measure(value_of, center, width, interval)
    interface
      subroutine value_of(speed, value, good)
        import :: wp
        real(wp), intent(in) :: speed
        real(wp), intent(out) :: value
        logical, intent(out) :: good
      end subroutine value_of
    end interface
    real(wp), intent(in) :: center, width !! about where it is, half as wide
    type(instability_t), intent(out) :: interval

    real(wp) :: h, least, slope
    logical :: good

    interval%at = center
    h = 0.5_wp*width
    call find_least(value_of, 0.05_wp, interval%at, h, least, slope, good)
    if (.not. good .or. least >= 0.0_wp) return
    call find_edge(-1.0_wp, interval%from)
    if (good) call find_edge(1.0_wp, interval%to)
    if (good) interval%growth = -least

  contains

    !> The zero on one side.
    subroutine find_edge(side, edge)
      real(wp), intent(in) :: side
      real(wp), intent(out) :: edge

      real(wp) :: inside, outside, at_inside, at_outside, new, at_new, reach
      integer :: step, kept

      inside = interval%at
      at_inside = least
      reach = sqrt(-least)/slope
      do step = 1, most_steps
        reach = 1.3_wp*reach
        outside = interval%at + side*reach
        call value_of(outside, at_outside, good)
        if (.not. good) return
        if (at_outside >= 0.0_wp) exit
        inside = outside
        at_inside = at_outside
      end do
      kept = 0
      edge = outside
      do step = 1, most_steps
        ! The Illinois method.
        new = (inside*at_outside - outside*at_inside)/(at_outside - at_inside)
        call value_of(new, at_new, good)
        if (.not. good) return
        if (abs(new - edge) <= fine_edge*edge) then
          edge = new
          return
        end if
        edge = new
        if (at_new >= 0.0_wp) then
          outside = new
          at_outside = at_new
          if (kept == 1) at_inside = 0.5_wp*at_inside
          kept = 1
        else
          inside = new
          at_inside = at_new
          if (kept == -1) at_outside = 0.5_wp*at_outside
          kept = -1
        end if
      end do
      good = .false.
    end subroutine find_edge

  end subroutine measure

  !> The exponent of a mode of the slow motion by the whole equation.
  function refined(request, level, spectrum, mode, speed) result(exponent)
    type(stability_request_t), intent(in) :: request
    type(level_t), intent(in) :: level
    type(turn_spectrum_t), intent(in) :: spectrum
    integer, intent(in) :: mode
    real(wp), intent(in) :: speed
    complex(wp) :: exponent

    type(fourier_plan_t) :: plan
    type(floquet_mode_t) :: found(1)

    call open_fourier(level%grid%samples, plan)
    call find_floquet_modes(level%grid, plan, level%basis(spectrum%motion%number), &
      spectrum%motion, speed, damping_of(request%damping, level%grid), request%terms, &
      last_change, spectrum%mode, [mode], found)
    call close_fourier(plan)
    exponent = found(1)%exponent
  end function refined

end module instability_intervals
