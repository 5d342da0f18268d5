!> Intervals of speed in which free vibrations of a running linkage grow (parametric resonance),
!! found by following multipliers over the speed, not by sampling it.
!!
!! Without damping multipliers leave the unit circle only where two of opposite Krein signature
!! meet. The slow motion gives all meetings of the wanted vibrations, and how much they grow there;
!! edges and largest growth of those intervals that count come from the whole equation, with two
!! orders and numbers of samples, without damping and then with it.
module instability_intervals
  use constants, only: two_pi
  use errors, only: error_of_numerics, error_t
  use exponent_meetings, only: find_closest, find_interval, interval_t
  use frozen_modes, only: find_frozen_frequencies
  use interruption, only: was_interrupted
  use kinds, only: wp
  use link_store, only: link_store_t
  use meeting_exponents, only: begin_with, close_pair, find_numbers, &
    meeting_pair_t, open_pair
  use response_levels, only: level_slot_t, need_basis, need_level, sample_numbers
  use response_types, only: link_damping_t, no_damping
  use sorting, only: ascending_order
  use stability, only: first_order, first_samples
  use stability_types, only: gap_t, instability_t, intervals_t, stability_request_t, &
    unstable_combination, unstable_flip, unstable_fold
  use structures, only: structure_t
  use text, only: to_string
  use turn_grids, only: turn_grid_t
  use vibration_branches, only: begin_branches, branches_t, find_meetings, go_on, meeting_t, &
    new_station, station_t
  implicit none (type, external)
  private

  public :: find_intervals

  !> Steps of the speed: so long, in terms of the speed, and no longer than this [rad/s]; most
  !! halvings, most steps at once, and pieces of one where meetings are near each other.
  real(wp), parameter :: step_share = 0.01_wp, longest_step = 0.125_wp
  integer, parameter :: most_halvings = 9, most_over = 3, pieces = 16

  !> There are so many slow coordinates more than vibrations that are wanted; they and the samples
  !! are for no fewer vibrations than this: the next ones take part where multipliers are near each
  !! other. These are followed with steps for this accuracy: meetings only have to be found.
  integer, parameter :: above_wanted = 2, least_modes = 3
  real(wp), parameter :: to_follow = 0.1_wp

  !> Distance in turns of the places beside a meeting from which its growth is found.
  real(wp), parameter :: beside = 3.0e-4_wp

  !> Growth in the slow motion above this share of the least that counts is looked into, and above
  !! the second there is growth.
  real(wp), parameter :: worth = 0.5_wp, certain = 2.0_wp

  !> Orders of the second solution above those of the first; most times orders and samples are
  !! raised, and the largest order.
  integer, parameter :: orders_above = 2, most_rounds = 3, most_order = 24

  !> Estimated errors are this many times the difference of both solutions, and no less than these
  !! shares of the accuracy and of the width.
  real(wp), parameter :: safety = 2.0_wp, least_share = 1.0e-2_wp, of_width = 1.0e-4_wp

  !> A meeting on its way.
  type :: search_t
    real(wp) :: center = 0.0_wp, width = 0.0_wp !! of the interval, half its width [rad/s]
    real(wp) :: growth = 0.0_wp                 !! by the slow motion [nepers a turn]
    integer :: order = 0, at = 0                !! degree, number in `sample_numbers`
    integer :: level(2) = 0                     !! numbers of the levels of both solutions
    logical :: pending = .true.
    type(instability_t) :: interval
    character(len=80) :: fault = ""
  end type search_t

contains

  !> Finds the intervals between the least and the greatest speed of a request, in which vibrations
  !! of those wanted meet.
  !!
  !! Errors: the crank does not turn fully; own modes of a link could not be found.
  subroutine find_intervals(structure, request, threads, store, found, error)
    class(structure_t), intent(in) :: structure      !! linkage and beams
    type(stability_request_t), intent(in) :: request !! speeds of one sign, modes, least growth
    integer, intent(in) :: threads                   !! number of OpenMP threads
    type(link_store_t), intent(inout) :: store       !! links decomposed earlier
    type(intervals_t), intent(out) :: found
    type(error_t), allocatable, intent(out) :: error !! why there are none

    type(stability_request_t) :: undamped
    type(level_slot_t), allocatable :: levels(:)
    type(meeting_t), allocatable :: meetings(:)
    type(search_t), allocatable :: searches(:)
    logical, allocatable :: chosen(:)
    integer :: i

    undamped = request
    undamped%damping = spread(link_damping_t(), 1, size(request%damping))
    found%range = [minval(abs(request%speed)), maxval(abs(request%speed))]
    allocate (found%gap(0), found%interval(0), meetings(0))
    call follow(structure, undamped, threads, store, found, meetings, searches, error)
    if (allocated(error)) return
    found%meetings = size(meetings)
    chosen = [(len_trim(searches(i)%fault) == 0 .and. searches(i)%growth >= worth* &
      request%least_growth, i=1, size(searches))]
    call add_gaps(meetings, searches, found)
    meetings = pack(meetings, chosen)
    searches = pack(searches, chosen)
    allocate (levels(0))
    call measure(structure, undamped, threads, store, meetings, levels, searches, error)
    if (allocated(error)) return
    if (any(request%damping%kind /= no_damping)) then
      do i = 1, size(searches)
        associate (search => searches(i), interval => searches(i)%interval)
          search%center = interval%at
          search%width = 0.5_wp*(interval%to - interval%from)
          search%pending = interval%growth > 0.0_wp
        end associate
      end do
      deallocate (levels)
      allocate (levels(0))
      call measure(structure, request, threads, store, meetings, levels, searches, error)
      if (allocated(error)) return
    end if
    call add_gaps(meetings, searches, found)
    found%interval = pack(searches%interval, [(is_asked_for(searches(i)%interval), i=1, &
      size(searches))])
    found%interval = found%interval(ascending_order(found%interval%from))
    if (request%speed(1) < 0.0_wp) call turn_round(found)

  contains

    !> Whether an interval counts, is at least partly in the range, and of a vibration wanted.
    pure function is_asked_for(interval) result(yes)
      type(instability_t), intent(in) :: interval
      logical :: yes

      yes = interval%growth >= request%least_growth .and. interval%to > found%range(1) .and. &
        interval%from < found%range(2) .and. interval%mode(1) <= request%modes
    end function is_asked_for

  end subroutine find_intervals

  !> Intervals of negative speeds.
  pure subroutine turn_round(found)
    type(intervals_t), intent(inout) :: found

    integer :: i

    found%range = -found%range([2, 1])
    do i = 1, size(found%gap)
      associate (gap => found%gap(i))
        call exchange(gap%from, gap%to)
        gap%from = -gap%from
        gap%to = -gap%to
      end associate
    end do
    do i = 1, size(found%interval)
      associate (interval => found%interval(i))
        interval%at = -interval%at
        interval%from = -interval%from
        interval%to = -interval%to
        call exchange(interval%from, interval%to)
      end associate
    end do
    found%interval = found%interval(size(found%interval):1:-1)

  contains

    pure subroutine exchange(a, b)
      real(wp), intent(inout) :: a, b

      real(wp) :: kept

      kept = a
      a = b
      b = kept
    end subroutine exchange

  end subroutine turn_round

  !> Names the speeds of meetings that could not be looked into.
  subroutine add_gaps(meetings, searches, found)
    type(meeting_t), intent(in) :: meetings(:)
    type(search_t), intent(in) :: searches(:)
    type(intervals_t), intent(inout) :: found

    integer :: i

    do i = 1, size(searches)
      if (len_trim(searches(i)%fault) == 0) cycle
      associate (speed => meetings(i)%speed, search => searches(i))
        call add_gap(min(speed(1), meetings(i)%around(1)), max(speed(2), meetings(i)%around(2)), &
          "two multipliers meet: "//trim(search%fault), found)
      end associate
    end do
  end subroutine add_gaps

  !> Names speeds at which intervals could not be found, as far as they are in the range.
  subroutine add_gap(from, to, reason, found)
    real(wp), intent(in) :: from, to !! [rad/s]
    character(len=*), intent(in) :: reason
    type(intervals_t), intent(inout) :: found

    type(gap_t) :: gap
    integer :: i

    if (from >= found%range(2) .or. to <= found%range(1)) return
    gap%from = max(from, found%range(1))
    gap%to = min(to, found%range(2))
    do i = 1, size(found%gap)
      ! Several meetings there.
      if (found%gap(i)%error%text == reason .and. abs(found%gap(i)%from - gap%from) <= 0.0_wp &
        .and. abs(found%gap(i)%to - gap%to) <= 0.0_wp) return
    end do
    gap%error%kind = error_of_numerics
    gap%error%text = reason
    found%gap = [found%gap, gap]
  end subroutine add_gap

  !> Follows the vibrations over the speed by the slow motion, and looks into their meetings.
  subroutine follow(structure, request, threads, store, found, meetings, searches, error)
    class(structure_t), intent(in) :: structure
    type(stability_request_t), intent(in) :: request
    integer, intent(in) :: threads
    type(link_store_t), intent(inout) :: store
    type(intervals_t), intent(inout) :: found !! gets gaps and the number of stations
    type(meeting_t), allocatable, intent(inout) :: meetings(:)
    type(search_t), allocatable, intent(out) :: searches(:)
    type(error_t), allocatable, intent(out) :: error

    type(level_slot_t), allocatable, target :: levels(:)
    type(station_t), allocatable :: stations(:)
    type(branches_t) :: branches
    real(wp), allocatable :: speeds(:)
    real(wp) :: from, range(2), speed
    integer :: i, k, last, number(size(sample_numbers)), over, slow
    type(branches_t), allocatable :: trail(:)
    integer, allocatable :: lost(:)
    integer :: steps
    logical :: failed

    allocate (levels(0), searches(0))
    ! By the slow motion meetings are a little beside where they are.
    range = found%range + [-1, 1]*step_at(found%range)
    call make_levels(error)
    if (allocated(error)) return
    from = range(1)
    do while (samples_at(levels(1)%level%grid, request%modes, from, to_follow) == 0)
      from = 1.1_wp*from
    end do
    if (from > range(1)) call add_gap(range(1), from, "too many vibrations in a turn of the "// &
      "crank for "//to_string(sample_numbers(size(sample_numbers)))//" samples", found)
    if (from >= range(2)) return
    speeds = [from]
    do while (speeds(size(speeds)) < range(2))
      speed = speeds(size(speeds))
      speeds = [speeds, min(speed + step_at(speed), range(2))]
    end do
    allocate (stations(size(speeds)))
    !$omp parallel do num_threads(threads) schedule(dynamic) default(shared) private(k)
    do k = 1, size(speeds)
      if (.not. was_interrupted()) call find_station(speeds(k), stations(k))
    end do
    !$omp end parallel do
    allocate (trail(2*size(speeds)))
    steps = 0
    k = 0
    last = 0
    failed = .true.
    do while (k < size(stations) .and. .not. was_interrupted())
      if (failed) then
        ! The next speed at which vibrations can be told apart.
        do k = k + 1, size(stations)
          if (allocated(stations(k)%phase)) exit
        end do
        if (k > size(stations)) exit
        if (k > 1) call add_gap(speeds(max(1, last)), speeds(k), &
          "vibrations cannot be followed", found)
        call begin_branches(stations(k), means_at(speeds(k)), branches)
        call keep(branches)
        failed = .false.
      else
        ! Where two pass each other the next may do, or the one after.
        do over = 1, min(most_over, size(stations) - k)
          call advance(stations(k + over), failed)
          if (.not. failed) exit
        end do
        if (.not. failed) k = k + over
      end if
      if (.not. failed) last = k
    end do
    if (last < size(speeds)) call add_gap(speeds(max(1, last)), speeds(size(speeds)), &
      "vibrations cannot be followed", found)
    found%stations = found%stations + size(speeds)
    deallocate (searches)
    allocate (searches(size(meetings)))
    !$omp parallel do num_threads(threads) schedule(dynamic) default(shared) private(i)
    do i = 1, size(meetings)
      if (.not. was_interrupted()) call look_into(meetings(i), searches(i))
    end do
    !$omp end parallel do
    ! Meetings near those of others: in short steps.
    lost = pack(meetings%step, [(len_trim(searches(i)%fault) > 0, i=1, size(searches))])
    do i = 1, size(lost)
      if (any(lost(:i - 1) == lost(i)) .or. was_interrupted()) cycle
      call look_again(lost(i))
    end do
    do i = 1, size(meetings)
      meetings(i)%around = around(meetings(i)%step)
    end do

  contains

    !> Keeps the state after a step, and its meetings.
    subroutine keep(next)
      type(branches_t), intent(in) :: next

      integer :: before

      before = size(meetings)
      if (steps == size(trail)) trail = [trail, trail]
      steps = steps + 1
      trail(steps) = next
      if (failed) then
        call find_meetings(next, next, meetings)
      else
        call find_meetings(trail(steps - 1), next, meetings)
      end if
      meetings(before + 1:)%step = steps
    end subroutine keep

    !> Looks again into the meetings of a step, which is divided.
    subroutine look_again(step)
      integer, intent(in) :: step

      type(branches_t) :: left, right
      type(station_t) :: station
      type(meeting_t), allocatable :: more(:)
      type(search_t), allocatable :: more_searches(:)
      logical, allocatable :: others(:)
      real(wp) :: from, to
      logical :: is_like, is_near
      integer :: i

      if (step == 1) return
      from = trail(step - 1)%speed
      to = trail(step)%speed
      left = trail(step - 1)
      allocate (more(0))
      do i = 1, pieces
        call find_station(from + (to - from)*i/pieces, station)
        if (.not. allocated(station%phase)) return
        call go_on(left, station, request%modes, right, is_near, is_like)
        if (.not. is_near) return
        call find_meetings(left, right, more)
        left = right
      end do
      found%stations = found%stations + pieces
      more%step = step
      allocate (more_searches(size(more)))
      do i = 1, size(more)
        call look_into(more(i), more_searches(i))
      end do
      others = meetings%step /= step
      meetings = [pack(meetings, others), more]
      searches = [pack(searches, others), more_searches]
    end subroutine look_again

    !> The nearest speeds before and after a step at which no multipliers have met.
    function around(step) result(speed)
      integer, intent(in) :: step
      real(wp) :: speed(2)

      integer :: k

      do k = max(1, step - 1), 2, -1
        if (.not. trail(k)%have_met) exit
      end do
      speed(1) = trail(max(k, 1))%speed
      do k = step, steps - 1
        if (.not. trail(k)%have_met) exit
      end do
      speed(2) = trail(min(k, steps))%speed
    end function around

    !> The levels of all speeds.
    subroutine make_levels(error)
      type(error_t), allocatable, intent(out) :: error

      integer :: at, place, last
      logical :: backwards

      backwards = request%speed(1) < 0.0_wp
      call need_level(structure, first_order(to_follow), sample_numbers(1), backwards, store, &
        levels, place, error)
      if (allocated(error)) return
      slow = slow_count_of(levels(1)%level%grid, request%modes)
      last = samples_at(levels(1)%level%grid, request%modes, range(1), to_follow)
      if (last == 0) last = size(sample_numbers)
      number = 0
      do at = max(1, samples_at(levels(1)%level%grid, request%modes, range(2), to_follow)), last
        call need_level(structure, first_order(to_follow), sample_numbers(at), backwards, store, &
          levels, number(at), error)
        if (allocated(error)) return
        call need_basis(slow, request%damping, levels(number(at))%level, error, .true.)
        if (allocated(error)) return
      end do
    end subroutine make_levels

    !> The number of the level for a speed.
    function level_for(speed) result(level)
      real(wp), intent(in) :: speed
      integer :: level

      level = number(samples_at(levels(1)%level%grid, request%modes, speed, to_follow))
    end function level_for

    subroutine find_station(speed, station)
      real(wp), intent(in) :: speed
      type(station_t), intent(out) :: station

      type(meeting_pair_t) :: pair

      call open_pair(request, levels(level_for(speed))%level, slow, meeting_t(), .false., pair)
      call pair%find_spectrum(speed)
      if (.not. allocated(pair%error)) call new_station(pair%spectrum, speed, &
        station)
      call close_pair(pair)
    end subroutine find_station

    !> Mean frequencies of the frozen linkage; 0 where it buckles in some position.
    function means_at(speed) result(mean)
      real(wp), intent(in) :: speed
      real(wp) :: mean(request%modes)

      real(wp), allocatable :: frequency(:, :), fading(:, :)
      type(error_t), allocatable :: error
      integer :: level

      level = level_for(speed)
      allocate (frequency(request%modes, levels(level)%level%coarse%samples/2))
      allocate (fading, mold=frequency)
      call find_frozen_frequencies(levels(level)%level%basis(slow), speed, frequency, fading, &
        error)
      mean = sum(frequency, dim=2)/size(frequency, 2)
      if (allocated(error)) mean = 0.0_wp
    end function means_at

    !> Goes on to a station, in steps that are short enough.
    subroutine advance(goal, failed)
      type(station_t), intent(in) :: goal
      logical, intent(out) :: failed

      type(station_t) :: station
      type(branches_t) :: next
      integer :: halvings
      logical :: is_like, is_near

      halvings = 0
      station = goal
      do
        failed = .not. allocated(station%phase)
        if (.not. failed) then
          call go_on(branches, station, request%modes, next, is_near, is_like)
          ! Two that pass each other closely need not be told apart.
          failed = .not. is_near .or. .not. (is_like .or. halvings == most_halvings)
        end if
        if (.not. failed) then
          call keep(next)
          branches = next
          if (branches%speed >= goal%speed) return
          station = goal
          halvings = max(0, halvings - 1)
          cycle
        end if
        halvings = halvings + 1
        if (halvings > most_halvings .or. was_interrupted()) return
        call find_station(0.5_wp*(branches%speed + station%speed), station)
        found%stations = found%stations + 1
      end do
    end subroutine advance

    !> Growth and place of a meeting by the slow motion.
    subroutine look_into(meeting, search)
      type(meeting_t), intent(in) :: meeting
      type(search_t), intent(out) :: search

      type(meeting_pair_t) :: pair
      real(wp) :: sum(2), rate, square, slope
      logical :: good

      ! The speed at which both frequencies are `total` times the speed, together.
      sum = meeting%frequency(1, :) + meeting%frequency(2, :)
      rate = 0.0_wp
      if (meeting%speed(2) > meeting%speed(1)) rate = (sum(2) - sum(1))/(meeting%speed(2) - &
        meeting%speed(1))
      search%center = meeting%speed(1)
      if (rate < meeting%total) search%center = (sum(1) - rate*meeting%speed(1))/(meeting%total - &
        rate)
      search%center = max(meeting%speed(1), min(meeting%speed(2), search%center))
      call open_pair(request, levels(level_for(meeting%speed(1)))%level, slow, meeting, .false., &
        pair)
      call find_closest(pair, search%center, beside*search%center/max(1.0_wp, meeting%total - &
        rate), square, slope, good)
      call close_pair(pair)
      if (.not. good) then
        search%fault = "their multipliers are too near to others"
        return
      end if
      search%growth = 0.5_wp*two_pi*sqrt(max(-square, 0.0_wp))
      search%width = sqrt(max(-square, 0.0_wp))/slope
    end subroutine look_into

  end subroutine follow

  !> The step from a speed to the next.
  elemental function step_at(speed) result(step)
    real(wp), intent(in) :: speed !! [rad/s]
    real(wp) :: step

    step = min(step_share*speed, longest_step)
  end function step_at

  !> Samples for so many vibrations; 0: too many.
  pure function samples_at(grid, modes, speed, accuracy) result(at)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: modes
    real(wp), intent(in) :: speed !! [rad/s]
    real(wp), intent(in) :: accuracy
    integer :: at !! of `sample_numbers`

    at = first_samples(grid, max(modes, least_modes), speed, accuracy)
  end function samples_at

  !> Slow coordinates for so many vibrations.
  pure function slow_count_of(grid, modes) result(number)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: modes
    integer :: number

    number = min(grid%unknowns, max(modes, least_modes) + above_wanted)
  end function slow_count_of

  !> Measures intervals by the whole equation, on two levels, and with higher orders and more
  !! samples where they are not accurate enough.
  subroutine measure(structure, request, threads, store, meetings, levels, searches, error)
    class(structure_t), intent(in) :: structure
    type(stability_request_t), intent(in) :: request
    integer, intent(in) :: threads
    type(link_store_t), intent(inout) :: store
    type(meeting_t), intent(in) :: meetings(:)
    type(level_slot_t), allocatable, intent(inout), target :: levels(:)
    type(search_t), intent(inout) :: searches(:) !! one for each meeting
    type(error_t), allocatable, intent(out) :: error

    integer :: i, number, round

    if (size(searches) == 0) return
    call need_level(structure, first_order(request%accuracy), sample_numbers(1), &
      request%speed(1) < 0.0_wp, store, levels, number, error)
    if (allocated(error)) return
    do i = 1, size(searches)
      if (.not. searches(i)%pending) cycle
      searches(i)%order = first_order(request%accuracy)
      searches(i)%at = samples_at(levels(number)%level%grid, request%modes, &
        searches(i)%center, request%accuracy)
      if (searches(i)%at > 0) cycle
      searches(i)%pending = .false.
      searches(i)%fault = "too many vibrations in a turn of the crank"
    end do
    do round = 1, most_rounds
      do i = 1, size(searches)
        if (.not. searches(i)%pending) cycle
        call find_levels(searches(i))
        if (allocated(error)) return
      end do
      !$omp parallel do num_threads(threads) schedule(dynamic) default(shared) private(i)
      do i = 1, size(searches)
        if (.not. searches(i)%pending .or. was_interrupted()) cycle
        call measure_interval(meetings(i), searches(i))
      end do
      !$omp end parallel do
    end do

  contains

    !> Finds or makes the two levels of a search.
    subroutine find_levels(search)
      type(search_t), intent(inout) :: search

      integer :: k

      do k = 1, 2
        call need_level(structure, search%order + (k - 1)*orders_above, (k + 1)* &
          sample_numbers(search%at)/2, request%speed(1) < 0.0_wp, store, levels, &
          search%level(k), error)
        if (allocated(error)) return
        associate (level => levels(search%level(k))%level)
          call need_basis(slow_count_of(level%grid, request%modes), request%damping, level, error, &
            .true.)
        end associate
        if (allocated(error)) return
      end do
    end subroutine find_levels

    !> Measures one on both levels.
    subroutine measure_interval(meeting, search)
      type(meeting_t), intent(in) :: meeting
      type(search_t), intent(inout) :: search

      type(meeting_pair_t) :: pair(2)
      type(interval_t) :: of(2)
      real(wp) :: doubt
      integer :: k
      logical :: good

      do k = 1, 2
        associate (level => levels(search%level(k))%level)
          call open_pair(request, level, slow_count_of(level%grid, request%modes), meeting, &
            .true., pair(k), search%growth)
        end associate
        if (k == 1) then
          call find_interval(pair(1), search%center, search%width, least_error()*search%center, &
            of(1), good)
        else
          call begin_with(pair(1), pair(2))
          call find_interval(pair(2), of(1)%at, 0.5_wp*(of(1)%to - of(1)%from), least_error()* &
            search%center, of(2), good)
        end if
        if (.not. good .or. of(k)%growth <= 0.0_wp) exit
      end do
      if (good .and. of(2)%growth > 0.0_wp) call find_numbers(pair(2), of(2)%at, good)
      do k = 1, min(k, 2)
        call close_pair(pair(k))
      end do
      ! Much growth of the slow motion is growth.
      if (good .and. .not. pair(1)%is_damped) good = of(2)%growth > 0.0_wp .or. search%growth < &
        certain*request%least_growth
      if (.not. good) search%fault = "their exponents are not found"
      search%interval%growth = 0.0_wp
      search%pending = good .and. of(2)%growth > 0.0_wp
      if (.not. search%pending) return
      associate (interval => search%interval)
        doubt = safety*maxval(pair%doubt)
        interval%growth_error = safety*abs(of(2)%growth - of(1)%growth) + doubt*of(2)%growth + &
          least_error()
        interval%from = of(2)%from
        interval%to = of(2)%to
        interval%at = of(2)%at
        interval%growth = of(2)%growth
        interval%error = safety*max(abs(of(2)%from - of(1)%from), abs(of(2)%to - of(1)%to)) + &
          least_error()*interval%at + (of_width + doubt)*(interval%to - interval%from)
        interval%kind = unstable_combination
        if (meeting%vibration(1) == meeting%vibration(2)) interval%kind = merge(unstable_flip, &
          unstable_fold, modulo(meeting%total, 2) == 1)
        interval%mode = [minval(pair(2)%number), maxval(pair(2)%number)]
        search%center = interval%at
        search%width = 0.5_wp*(interval%to - interval%from)
        search%pending = search%order + 2 <= most_order .and. search%at < size(sample_numbers) &
          .and. (interval%error > request%accuracy*interval%at .or. &
          interval%growth_error > request%accuracy)
      end associate
      search%order = search%order + 2
      search%at = min(search%at + 1, size(sample_numbers))
    end subroutine measure_interval

    !> No error is stated smaller than this.
    pure function least_error() result(least)
      real(wp) :: least

      least = least_share*request%accuracy
    end function least_error

  end subroutine measure

end module instability_intervals
