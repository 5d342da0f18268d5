!> Catches Ctrl-C and termination requests, and knows when the time allowed is over, so that a run
!! can stop between two positions and leave nothing half done.
!!
!! The only module with variables of its own: a signal handler has no other place for its result.
module interruption
  use, intrinsic :: iso_c_binding, only: c_funloc, c_funptr, c_int
  use kinds, only: long, wp
  implicit none (type, external)
  private

  public :: watch_for_interruption, limit_time, was_interrupted, was_out_of_time, interrupt

  !> SIGINT and SIGTERM of POSIX.
  integer(c_int), parameter :: interrupt_signal = 2_c_int, terminate_signal = 15_c_int

  integer(c_int), volatile :: last_signal = 0_c_int

  !> Ticks of the clock at which the time allowed is over.
  integer(long) :: last_tick = huge(last_tick)

  interface
    function c_signal(number, handler) bind(c, name="signal") result(previous)
      import :: c_funptr, c_int
      integer(c_int), value :: number
      type(c_funptr), value :: handler
      type(c_funptr) :: previous
    end function c_signal
  end interface

contains

  !> Installs the handler of both signals.
  subroutine watch_for_interruption()
    type(c_funptr) :: previous

    previous = c_signal(interrupt_signal, c_funloc(note_signal))
    previous = c_signal(terminate_signal, c_funloc(note_signal))
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

  !> Whether one of the signals has arrived since then, or the time allowed is over.
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
