!> What becomes of signals, and of a time that is over: a run stops between two positions and leaves
!! nothing half done.
!!
!! The only module with variables of its own: a signal handler has no other place for its result.
module interruption
  use, intrinsic :: iso_c_binding, only: c_funloc, c_funptr, c_int, c_intptr_t, c_null_funptr
  use kinds, only: long, wp
  use system_calls, only: c_siginterrupt, c_signal
  implicit none (type, external)
  private

  public :: watch_for_interruption, limit_time, was_interrupted, was_out_of_time, interrupt

  !> Of POSIX and Linux: requests to end, SIGHUP, SIGINT, SIGTERM and SIGXCPU, and those that come
  !! of writing where nobody reads, SIGPIPE, or beyond a limit, SIGXFSZ.
  integer(c_int), parameter :: terminate_signal = 15_c_int, &
    requests(*) = [1_c_int, 2_c_int, terminate_signal, 24_c_int], of_writing(*) = [13_c_int, &
    25_c_int]

  integer(c_int), volatile :: last_signal = 0_c_int

  !> Ticks of the clock at which the time allowed is over.
  integer(long) :: last_tick = huge(last_tick)

contains

  !> Takes requests to end from now on. One that whoever has started the program lets it ignore, as
  !! `nohup` and shells do, stays ignored; a write that cannot be done is reported by what writes.
  subroutine watch_for_interruption()
    integer(c_intptr_t), parameter :: ignored = 1_c_intptr_t ! SIG_IGN of the common C libraries
    type(c_funptr) :: ignoring, previous
    integer(c_int) :: status
    integer :: i

    ignoring = transfer(ignored, c_null_funptr)
    do i = 1, size(of_writing)
      previous = c_signal(of_writing(i), ignoring)
    end do
    do i = 1, size(requests)
      previous = c_signal(requests(i), ignoring)
      if (transfer(previous, ignored) == ignored) cycle
      previous = c_signal(requests(i), c_funloc(note_signal))
      ! A pipe that nobody writes to is not waited for.
      status = c_siginterrupt(requests(i), 1_c_int)
    end do
  end subroutine watch_for_interruption

  !> Allows the program some time from now on.
  subroutine limit_time(seconds)
    real(wp), intent(in) :: seconds !! [s] huge: as much as it needs

    !> A clock counts as far: thirty years [s].
    real(wp), parameter :: longest = 1.0e9_wp
    integer(long) :: now, rate

    last_tick = huge(last_tick)
    if (seconds > longest) return
    call system_clock(now, rate)
    last_tick = now + nint(seconds*real(rate, wp), long)
  end subroutine limit_time

  !> Whether a request to end has arrived since then, or the time allowed is over.
  function was_interrupted() result(was)
    logical :: was

    was = last_signal /= 0_c_int
    if (.not. was) was = was_out_of_time()
  end function was_interrupted

  !> Whether the time allowed is over.
  function was_out_of_time() result(was)
    logical :: was

    integer(long) :: now

    was = last_tick < huge(last_tick)
    if (.not. was) return
    call system_clock(now)
    was = now >= last_tick
  end function was_out_of_time

  !> Does what a termination request does: this process follows another one that has got it.
  subroutine interrupt()
    last_signal = terminate_signal
  end subroutine interrupt

  subroutine note_signal(number) bind(c)
    integer(c_int), value :: number

    last_signal = number
  end subroutine note_signal

end module interruption
