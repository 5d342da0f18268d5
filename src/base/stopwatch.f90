!> Seconds from one moment to the next.
module stopwatch
  use kinds, only: long, wp
  implicit none (type, external)
  private

  public :: stopwatch_t, start_stopwatch, lap

  type :: stopwatch_t
    integer(long), private :: last = 0_long !! clock ticks when it was started, or at the last lap
  end type stopwatch_t

contains

  !> Starts to count.
  subroutine start_stopwatch(watch)
    type(stopwatch_t), intent(out) :: watch

    call system_clock(watch%last)
  end subroutine start_stopwatch

  !> Seconds since the start or the last lap; a new lap begins.
  subroutine lap(watch, seconds)
    type(stopwatch_t), intent(inout) :: watch
    real(wp), intent(out) :: seconds

    integer(long) :: now, rate

    call system_clock(now, rate)
    seconds = real(now - watch%last, wp)/real(rate, wp)
    watch%last = now
  end subroutine lap

end module stopwatch
