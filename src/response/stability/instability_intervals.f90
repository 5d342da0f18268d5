!> Intervals of speed in which free vibrations of a running linkage grow (parametric resonance),
!! found by following multipliers over the speed, not by sampling it.
!!
!! Without damping multipliers leave the unit circle only where two of opposite Krein signature
!! meet. The slow motion gives all meetings of the wanted vibrations, and how much they grow there;
!! edges and largest growth of those intervals that count come from the whole equation, with two
!! orders and numbers of samples, without damping and then with it. What was found is confirmed at
!! single speeds in every interval and between them.
module instability_intervals
  use byte_streams, only: byte_stream_t
  use errors, only: error_t
  use exponent_meetings, only: find_interval, interval_t
  use interval_checks, only: confirm_intervals
  use kept_results, only: keep_result, keeper_t, recall_result
  use kinds, only: wp
  use link_store, only: link_store_t
  use meeting_exponents, only: begin_with, close_pair, find_numbers, meeting_pair_t, meeting_t, &
    open_pair
  use multiplier_meetings, only: add_gap, find_meetings, least_modes
  use refinements, only: begin_round, raise, refinement_limits_t, refinement_t
  use response_bytes, only: pass_refinement
  use response_levels, only: level_slot_t
  use response_types, only: link_damping_t, no_damping
  use sorting, only: ascending_order
  use stability_bytes, only: pass_instability
  use stability_types, only: instability_t, intervals_t, stability_request_t, &
    unstable_combination, unstable_flip, unstable_fold
  use structures, only: structure_t
  use turn_spectra, only: begin_refinements, need_two_levels, slow_number
  implicit none (type, external)
  private

  public :: find_intervals

  !> Growth of the slow motion above this times the least that counts is growth.
  real(wp), parameter :: certain = 2.0_wp

  !> Share of the speed to which edges are found by the slow motion.
  real(wp), parameter :: to_begin = 1.0e-4_wp

  type(refinement_limits_t), parameter :: limits = refinement_limits_t(order=24, rounds=2)

  !> Estimated errors are this many times the difference of both solutions, and no less than these
  !! shares of the accuracy and of the width or the growth, for the parabolas.
  real(wp), parameter :: safety = 2.0_wp, least_share = 1.0e-2_wp, of_width = 2.0e-5_wp

  !> A meeting on its way.
  type :: search_t
    logical :: wanted = .true.
    type(instability_t) :: interval
    character(len=80) :: fault = ""
  end type search_t

contains

  !> Finds the intervals between the least and the greatest speed of a request, in which vibrations
  !! of those wanted meet.
  !!
  !! Errors: the crank does not turn fully; own modes of a link could not be found.
  subroutine find_intervals(structure, request, threads, store, found, error, keeper)
    class(structure_t), intent(in) :: structure      !! linkage and beams
    type(stability_request_t), intent(in) :: request !! speeds of one sign, modes, least growth
    integer, intent(in) :: threads                   !! number of OpenMP threads
    type(link_store_t), intent(inout) :: store       !! links decomposed earlier
    type(intervals_t), intent(out) :: found
    type(error_t), allocatable, intent(out) :: error !! why there are none
    class(keeper_t), intent(inout), optional :: keeper !! of meetings, a round each: without damping
                                                       !! stage 1, with it stage 2

    type(stability_request_t) :: undamped
    type(meeting_t), allocatable :: meetings(:)
    type(search_t), allocatable :: searches(:)
    type(instability_t), allocatable :: all(:)

    undamped = request
    undamped%damping = spread(link_damping_t(), 1, size(request%damping))
    found%range = [minval(abs(request%speed)), maxval(abs(request%speed))]
    allocate (found%gap(0), found%interval(0))
    call find_meetings(structure, undamped, threads, store, found, meetings, error)
    if (allocated(error)) return
    allocate (searches(size(meetings)))
    call measure(structure, undamped, threads, store, meetings, 1, searches, error, keeper)
    if (allocated(error)) return
    if (any(request%damping%kind /= no_damping)) then
      searches%wanted = searches%interval%growth > 0.0_wp
      meetings%from = searches%interval%from
      meetings%at = searches%interval%at
      meetings%to = searches%interval%to
      call measure(structure, request, threads, store, meetings, 2, searches, error, keeper)
      if (allocated(error)) return
    end if
    call add_gaps(meetings, searches, found)
    all = pack(searches%interval, searches%interval%growth >= request%least_growth .and. &
      searches%interval%to > found%range(1) .and. searches%interval%from < found%range(2))
    all = all(ascending_order(all%from))
    call confirm_intervals(structure, request, threads, store, all, found, error)
    if (request%speed(1) < 0.0_wp) call turn_round(found)
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

  !> Names the speeds of meetings that could not be looked into, with half their width on both
  !! sides: so far their edges by the slow motion are from those of the whole equation where growth
  !! is large.
  subroutine add_gaps(meetings, searches, found)
    type(meeting_t), intent(in) :: meetings(:)
    type(search_t), intent(in) :: searches(:)
    type(intervals_t), intent(inout) :: found

    real(wp) :: half
    integer :: i

    do i = 1, size(searches)
      if (len_trim(searches(i)%fault) == 0) cycle
      half = 0.5_wp*(meetings(i)%to - meetings(i)%from)
      call add_gap(meetings(i)%from - half, meetings(i)%to + half, "two multipliers meet: "// &
        trim(searches(i)%fault), found)
    end do
  end subroutine add_gaps

  !> Measures intervals by the whole equation, on two levels, and with higher orders and more
  !! samples where they are not accurate enough.
  subroutine measure(structure, request, threads, store, meetings, stage, searches, error, keeper)
    class(structure_t), intent(in) :: structure
    type(stability_request_t), intent(in) :: request
    integer, intent(in) :: threads
    type(link_store_t), intent(inout) :: store
    type(meeting_t), intent(in) :: meetings(:)
    integer, intent(in) :: stage                 !! of what is kept
    type(search_t), intent(inout) :: searches(:) !! one for each meeting
    type(error_t), allocatable, intent(out) :: error
    class(keeper_t), intent(inout), optional :: keeper

    type(level_slot_t), allocatable, target :: levels(:)
    type(refinement_t) :: refinement(size(searches))
    integer :: i, round

    allocate (levels(0))
    refinement%limits = limits
    refinement%pending = searches%wanted
    call begin_refinements(structure, request, max(request%modes, least_modes), &
      sign(meetings%at, request%speed(1)), store, levels, refinement, error)
    if (allocated(error)) return
    do i = 1, size(searches)
      if (searches(i)%wanted .and. .not. refinement(i)%pending) searches(i)%fault = &
        "too many vibrations in a turn of the crank"
    end do
    round = 0
    do while (any(refinement%pending))
      round = round + 1
      call need_two_levels(structure, request, refinement, store, levels, error)
      if (allocated(error)) return
      !$omp parallel do num_threads(threads) schedule(dynamic) default(shared) private(i)
      do i = 1, size(searches)
        call measure_meeting(i)
      end do
      !$omp end parallel do
    end do

  contains

    !> A round of a meeting, if one is pending: measured, or what an earlier run has found in it.
    subroutine measure_meeting(i)
      integer, intent(in) :: i

      type(byte_stream_t) :: stream
      logical :: begun, known

      call begin_round(refinement(i), begun)
      if (.not. begun) return
      call recall_result(keeper, [stage, round, i], stream, known)
      if (.not. known) call measure_interval(meetings(i), refinement(i), searches(i))
      if (.not. present(keeper)) return
      call pass_refinement(stream, refinement(i))
      call pass_instability(stream, searches(i)%interval)
      call stream%pass_word(searches(i)%fault)
      call keep_result(keeper, [stage, round, i], stream)
    end subroutine measure_meeting

    !> Measures one on both levels.
    subroutine measure_interval(meeting, refinement, search)
      type(meeting_t), intent(in) :: meeting
      type(refinement_t), intent(inout) :: refinement
      type(search_t), intent(inout) :: search

      type(meeting_pair_t) :: pair(2)
      type(interval_t) :: of(2)
      real(wp) :: about(3), doubt
      integer :: k
      logical :: good

      do k = 1, 2
        associate (level => levels(refinement%level(k))%level)
          call open_pair(request, level, slow_number(level%grid, request%modes), meeting, &
            .true., pair(k))
        end associate
        if (k == 1 .and. search%interval%growth > 0.0_wp) then
          about = [search%interval%from, search%interval%at, search%interval%to]
        else if (k == 1) then
          about = first_places(meeting, pair(1))
        else
          call begin_with(pair(1), pair(2))
          about = [of(1)%from, of(1)%at, of(1)%to]
        end if
        call find_interval(pair(k), about, least_error()*meeting%at, of(k), good)
        if (.not. good .or. of(k)%growth <= 0.0_wp) exit
      end do
      if (good .and. of(2)%growth > 0.0_wp) call find_numbers(pair(2), of(2)%at, good)
      do k = 1, min(k, 2)
        call close_pair(pair(k))
      end do
      ! Much growth of the slow motion is growth.
      if (good .and. .not. pair(1)%is_damped) good = of(2)%growth > 0.0_wp .or. meeting%growth < &
        certain*request%least_growth
      if (.not. good) search%fault = "their exponents are not found"
      search%interval%growth = 0.0_wp
      if (.not. good .or. of(2)%growth <= 0.0_wp) return
      associate (interval => search%interval)
        doubt = safety*maxval(pair%doubt)
        interval%growth_error = safety*abs(of(2)%growth - of(1)%growth) + (of_width + doubt)* &
          of(2)%growth + least_error()
        interval%from = of(2)%from
        interval%to = of(2)%to
        interval%at = of(2)%at
        interval%growth = of(2)%growth
        interval%error = safety*max(abs(of(2)%from - of(1)%from), abs(of(2)%to - of(1)%to)) + &
          least_error()*interval%at + (of_width + doubt)*(interval%to - interval%from)
        interval%kind = unstable_combination
        associate (here => meeting%plane(minloc(abs(meeting%plane%speed - interval%at), dim=1)))
          if (meeting%is_own) interval%kind = merge(unstable_flip, unstable_fold, abs(here%turns) &
            > 0.25_wp)
        end associate
        interval%mode = [minval(pair(2)%number), maxval(pair(2)%number)]
        if (interval%error > request%accuracy*interval%at .or. interval%growth_error > &
          request%accuracy) call raise(refinement, 1, refinement%samples + 1)
      end associate
    end subroutine measure_interval

    !> Edges and peak by the slow motion, whose speeds cost little.
    function first_places(meeting, pair) result(places)
      type(meeting_t), intent(in) :: meeting
      type(meeting_pair_t), intent(inout) :: pair
      real(wp) :: places(3)

      type(interval_t) :: of
      logical :: good

      places = [meeting%from, meeting%at, meeting%to]
      if (pair%is_damped) return
      pair%whole = .false.
      call find_interval(pair, places, to_begin*meeting%at, of, good)
      pair%whole = .true.
      if (good .and. of%growth > 0.0_wp) places = [of%from, of%at, of%to]
    end function first_places

    !> No error is stated smaller than this.
    pure function least_error() result(least)
      real(wp) :: least

      least = least_share*request%accuracy
    end function least_error

  end subroutine measure

end module instability_intervals
