!> Catches Ctrl-C and termination requests, so that a run can stop between two positions and leave
!! nothing half done.
!!
!! The only module with a variable of its own: a signal handler has no other place for its result.
module interruption
  use, intrinsic :: iso_c_binding, only: c_funloc, c_funptr, c_int
  implicit none (type, external)
  private

  public :: watch_for_interruption, was_interrupted, interrupt

  !> SIGINT and SIGTERM of POSIX.
  integer(c_int), parameter :: interrupt_signal = 2_c_int, terminate_signal = 15_c_int

  integer(c_int), volatile :: last_signal = 0_c_int

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

  !> Whether one of the signals has arrived since then.
  function was_interrupted() result(was)
    logical :: was

    was = last_signal /= 0_c_int
  end function was_interrupted

  !> Does what a termination request does: this process follows another one that has got it.
  subroutine interrupt()
    last_signal = terminate_signal
  end subroutine interrupt

  subroutine note_signal(number) bind(c)
    integer(c_int), value :: number

    last_signal = number
  end subroutine note_signal

end module interruption
