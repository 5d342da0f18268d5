!> Intervals of instability confirmed by exponents at single speeds in each of them and between
!! them, found from the whole equation on two levels as `REPORT stability` does, whatever was known
!! of the intervals.
module interval_checks
  use errors, only: error_t
  use interruption, only: was_interrupted
  use kinds, only: wp
  use link_store, only: link_store_t
  use multiplier_meetings, only: add_gap
  use stability, only: find_stability
  use stability_types, only: exponent_t, instability_t, intervals_t, is_unstable, &
    stability_request_t, stability_t, unstable_combination
  use structures, only: structure_t
  use text, only: to_string
  implicit none (type, external)
  private

  public :: confirm_intervals

  !> Between intervals there is a speed at every tenth, at least in the middle.
  real(wp), parameter :: between = 0.1_wp

  !> The growth at one speed and the largest of an interval agree to this share beside their errors.
  real(wp), parameter :: same_growth = 1.0e-3_wp

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

    type(stability_request_t) :: single
    type(stability_t) :: at
    type(instability_t), allocatable :: confirmed(:)
    real(wp), allocatable :: speed(:), edge(:, :)
    integer, allocatable :: mode(:)
    integer :: i, k, n

    n = size(intervals)
    call list_speeds
    single = request
    single%speed = sign(speed, request%speed(1))
    single%accuracy = in_growth*request%least_growth
    call find_stability(structure, single, threads, store, at, error)
    if (allocated(error)) return
    ! An interrupted run leaves speeds without exponents.
    if (was_interrupted()) return
    confirmed = intervals
    do i = 1, n
      call confirm(i)
    end do
    do k = n + 1, size(speed)
      call look_for_others(k)
    end do

  contains

    !> The places of the intervals, then speeds between them.
    subroutine list_speeds
      real(wp) :: from, to
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
            speed = [speed, from + (to - from)*(j - 0.5_wp)/pieces]
            edge = reshape([edge, [from, to]], [2, size(speed)])
          end do
        end if
        if (i <= n) from = max(from, intervals(i)%to)
      end do
    end subroutine list_speeds

    !> Confirms an interval by the exponents at its place.
    subroutine confirm(i)
      integer, intent(in) :: i

      integer :: k
      logical :: known

      associate (interval => intervals(i), here => at%at_speed(i))
        known = .not. allocated(here%error)
        if (known) known = any(here%exponent%verdict == interval%kind)
        if (known) then
          k = minloc(abs(here%exponent%growth - interval%growth), dim=1, mask= &
            here%exponent%verdict == interval%kind)
          associate (exponent => here%exponent(k))
            known = abs(exponent%growth - interval%growth) <= interval%growth_error + &
              exponent%error + same_growth*interval%growth
            mode = [exponent%mode, exponent%mode]
            if (interval%kind == unstable_combination) mode(2) = exponent%partner
            if (mode(2) == 0) mode = interval%mode
            confirmed(i)%mode = [minval(mode), maxval(mode)]
          end associate
        end if
        if (known) then
          if (confirmed(i)%mode(1) <= request%modes) found%interval = [found%interval, confirmed(i)]
        else if (interval%mode(1) <= request%modes) then
          call add_gap(interval%from, interval%to, "the interval is not confirmed at "// &
            to_string(interval%at, 6)//" rad/s", found)
        end if
      end associate
    end subroutine confirm

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
          some = pack(some, some%growth + some%error >= request%least_growth .and. .not. &
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
