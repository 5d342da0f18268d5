!> Elapsed time.
module stopwatch
  use kinds, only: long, wp
  implicit none (type, external)
  private

  public :: stopwatch_t, start_stopwatch, lap

  type :: stopwatch_t
    integer(long), private :: last = 0_long !! clock ticks at the start or the last lap
  end type stopwatch_t

contains

  !> Starts the first lap.
  subroutine start_stopwatch(watch)
    type(stopwatch_t), intent(out) :: watch !! may have been started before

    call system_clock(watch%last)
  end subroutine start_stopwatch

  !> Ends a lap and starts the next one.
  subroutine lap(watch, seconds)
    type(stopwatch_t), intent(inout) :: watch !! started
    real(wp), intent(out) :: seconds          !! since the start or the last lap [s]

    integer(long) :: now, rate

    call system_clock(now, rate)
    seconds = real(now - watch%last, wp)/real(rate, wp)
    watch%last = now
  end subroutine lap

end module stopwatch
