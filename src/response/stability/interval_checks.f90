!> Intervals of instability confirmed by exponents at single speeds in each of them and between
!! them, found from the whole equation on two levels as `REPORT stability` does, whatever was known
!! of the intervals.
module interval_checks
  use errors, only: error_t
  use interruption, only: was_interrupted
  use kinds, only: wp
  use link_store, only: link_store_t
  use multiplier_meetings, only: add_gap
  use response_types, only: no_damping
  use stability, only: find_stability
  use stability_types, only: exponent_t, instability_t, intervals_t, is_unstable, &
    speed_stability_t, stability_request_t, stability_t, unstable_combination
  use structures, only: structure_t
  use text, only: to_string
  implicit none (type, external)
  private

  public :: confirm_intervals

  !> Between intervals there is a speed at every tenth, at least in the middle.
  real(wp), parameter :: between = 0.1_wp

  !> The growth at one speed is at least these shares of the largest of the interval, beside errors:
  !! at its place, and at so much of the width beside it.
  real(wp), parameter :: at_peak = 0.999_wp, at_side = 0.5_wp, beside = 0.15_wp

  !> Places near the edges at which modes are numbered, in terms of the width.
  real(wp), parameter :: near_edge = 0.12_wp

  !> Exponents are found to this share of the least growth that counts.
  real(wp), parameter :: in_growth = 0.1_wp

contains

  !> Adds those intervals to what was found that are confirmed, and of those wanted, with the
  !! numbers of their modes; what is not confirmed is a gap.
  subroutine confirm_intervals(structure, request, threads, store, intervals, found, error)
    class(structure_t), intent(in) :: structure      !! linkage and beams
    type(stability_request_t), intent(in) :: request !! of the intervals
    integer, intent(in) :: threads                   !! number of OpenMP threads
    type(link_store_t), intent(inout) :: store       !! links decomposed earlier
    type(instability_t), intent(in) :: intervals(:)  !! all, by speed
    type(intervals_t), intent(inout) :: found        !! gets intervals and gaps
    type(error_t), allocatable, intent(out) :: error !! why nothing is confirmed

    type(stability_t) :: at
    type(instability_t), allocatable :: confirmed(:)
    real(wp), allocatable :: speed(:), edge(:, :)
    integer, allocatable :: others(:)
    logical, allocatable :: known(:), wanted(:)
    integer :: i, k, n

    n = size(intervals)
    call list_speeds
    if (size(speed) == 0) return
    confirmed = intervals
    call find_exponents(speed)
    if (allocated(error) .or. was_interrupted()) return
    known = [(is_confirmed(i, at%at_speed(i), at_peak), i=1, n)]
    do k = n + 1, size(speed)
      call look_for_others(k)
    end do
    ! Exponents may not be found at one speed.
    others = pack([(i, i=1, n)], .not. known)
    if (size(others) > 0) then
      call find_exponents(intervals(others)%at + beside*(intervals(others)%to - &
        intervals(others)%from))
      if (allocated(error) .or. was_interrupted()) return
      do k = 1, size(others)
        known(others(k)) = is_confirmed(others(k), at%at_speed(k), at_side)
      end do
    end if
    ! Numbers may change inside: one is not wanted where no part of it is.
    wanted = [(confirmed(i)%mode(2) <= request%modes, i=1, n)]
    others = pack([(i, i=1, n)], known .and. .not. wanted)
    if (size(others) > 0) then
      associate (some => intervals(others))
        call find_exponents([some%from + near_edge*(some%to - some%from), some%to - near_edge* &
          (some%to - some%from)])
      end associate
      if (allocated(error) .or. was_interrupted()) return
      do k = 1, size(others)
        wanted(others(k)) = is_wanted(intervals(others(k))%kind, at%at_speed(k)) .or. &
          is_wanted(intervals(others(k))%kind, at%at_speed(size(others) + k))
      end do
    end if
    do i = 1, n
      if (known(i) .and. wanted(i)) then
        found%interval = [found%interval, confirmed(i)]
      else if (.not. known(i) .and. intervals(i)%mode(1) <= request%modes) then
        call add_gap(intervals(i)%from, intervals(i)%to, "the interval is not confirmed at "// &
          to_string(intervals(i)%at, 6)//" rad/s", found)
      end if
    end do

  contains

    !> The places of the intervals, then speeds between them.
    subroutine list_speeds
      real(wp) :: from, middle, to
      integer :: i, j, pieces

      speed = intervals%at
      allocate (edge(2, n))
      edge = 0.0_wp
      from = found%range(1)
      do i = 1, n + 1
        to = found%range(2)
        if (i <= n) to = min(to, intervals(i)%from)
        if (to > from) then
          pieces = 1 + int((to - from)/(between*from))
          do j = 1, pieces
            middle = from + (to - from)*(j - 0.5_wp)/pieces
            ! Speeds of which is known why nothing is found.
            if (any(found%gap%from <= middle .and. middle <= found%gap%to)) cycle
            speed = [speed, middle]
            edge = reshape([edge, [from, to]], [2, size(speed)])
          end do
        end if
        if (i <= n) from = max(from, intervals(i)%to)
      end do
    end subroutine list_speeds

    !> An interrupted run leaves speeds without exponents.
    subroutine find_exponents(speeds)
      real(wp), intent(in) :: speeds(:) !! |ω2| [rad/s]

      type(stability_request_t) :: single

      single = request
      single%speed = sign(speeds, request%speed(1))
      single%accuracy = in_growth*request%least_growth
      call find_stability(structure, single, threads, store, at, error)
    end subroutine find_exponents

    !> Whether exponents at a speed confirm an interval; gets the numbers of its modes.
    function is_confirmed(i, here, share) result(is)
      integer, intent(in) :: i
      type(speed_stability_t), intent(in) :: here
      real(wp), intent(in) :: share !! of the largest growth that is there at least
      logical :: is

      real(wp), allocatable :: there(:)
      integer :: k, mode(2)

      is = .not. allocated(here%error)
      if (is) is = any(here%exponent%verdict == intervals(i)%kind)
      if (.not. is) return
      there = growth_of(here%exponent)
      associate (growth => intervals(i)%growth)
        k = minloc(abs(there - growth), dim=1, mask=here%exponent%verdict == intervals(i)%kind)
        associate (exponent => here%exponent(k))
          is = there(k) >= share*growth - intervals(i)%growth_error - exponent%error .and. &
            there(k) <= (2.0_wp - at_peak)*growth + intervals(i)%growth_error + exponent%error
          mode = [exponent%mode, exponent%mode]
          if (intervals(i)%kind == unstable_combination) mode(2) = exponent%partner
          if (mode(2) == 0) mode = intervals(i)%mode
          confirmed(i)%mode = [minval(mode), maxval(mode)]
        end associate
      end associate
    end function is_confirmed

    !> Whether two of the modes wanted grow at a speed in an interval.
    pure function is_wanted(kind, here) result(is)
      integer, intent(in) :: kind
      type(speed_stability_t), intent(in) :: here
      logical :: is

      is = allocated(here%error)
      if (.not. is) is = any(here%exponent%verdict == kind .and. max(here%exponent%mode, &
        here%exponent%partner) <= request%modes)
    end function is_wanted

    !> Growth of exponents. Without damping the partner of one that fades grows as much.
    elemental function growth_of(exponent) result(growth)
      type(exponent_t), intent(in) :: exponent
      real(wp) :: growth

      growth = exponent%growth
      if (all(request%damping%kind == no_damping)) growth = abs(growth)
    end function growth_of

    !> Whether no vibration grows at a speed between intervals.
    subroutine look_for_others(k)
      integer, intent(in) :: k

      type(exponent_t), allocatable :: some(:)
      character(len=:), allocatable :: reason

      associate (here => at%at_speed(k))
        if (allocated(here%error)) then
          reason = "nothing is confirmed at "//to_string(speed(k), 6)//" rad/s: "//here%error%text
        else
          some = pack(here%exponent, here%exponent%mode <= request%modes)
          some = pack(some, growth_of(some) + some%error >= request%least_growth .and. .not. &
            (is_unstable(some%verdict) .and. some%partner > request%modes))
          if (size(some) == 0) return
          reason = "mode "//to_string(some(1)%mode)//" may grow at "//to_string(speed(k), 6)// &
            " rad/s, by e^"//to_string(some(1)%growth, 2)//" in a turn with an error of "// &
            to_string(some(1)%error, 2)
        end if
        call add_gap(edge(1, k), edge(2, k), reason, found)
      end associate
    end subroutine look_for_others

  end subroutine confirm_intervals

end module interval_checks
