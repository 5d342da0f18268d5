!> Waiting without keeping a processor busy.
module pauses
  use, intrinsic :: iso_c_binding, only: c_int
  use kinds, only: wp
  use system_calls, only: c_sched_yield, c_usleep
  implicit none (type, external)
  private

  public :: pause_for, let_others_run

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
