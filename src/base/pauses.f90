!> Waiting without keeping a processor busy.
module pauses
  use, intrinsic :: iso_c_binding, only: c_int
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: pause_for, let_others_run

  interface
    function c_usleep(microseconds) bind(c, name="usleep") result(status)
      import :: c_int
      integer(c_int), value :: microseconds
      integer(c_int) :: status
    end function c_usleep

    function c_sched_yield() bind(c, name="sched_yield") result(status)
      import :: c_int
      integer(c_int) :: status
    end function c_sched_yield
  end interface

contains

  !> Lets the calling thread sleep; a signal may end that sooner.
  subroutine pause_for(time)
    real(wp), intent(in) :: time !! less than a second [s]

    integer(c_int) :: status

    status = c_usleep(int(1.0e6_wp*time, c_int))
  end subroutine pause_for

  !> Lets other threads have the processor first: those that wait for a lock which this one has just
  !! left and will soon want again.
  subroutine let_others_run()
    integer(c_int) :: status

    status = c_sched_yield()
  end subroutine let_others_run

end module pauses
