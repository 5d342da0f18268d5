!> Waiting without keeping a processor busy.
module pauses
  use, intrinsic :: iso_c_binding, only: c_int
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: pause_for

  interface
    function c_usleep(microseconds) bind(c, name="usleep") result(status)
      import :: c_int
      integer(c_int), value :: microseconds
      integer(c_int) :: status
    end function c_usleep
  end interface

contains

  !> Lets the calling thread sleep; a signal may end that sooner.
  subroutine pause_for(time)
    real(wp), intent(in) :: time !! less than a second [s]

    integer(c_int) :: status

    status = c_usleep(int(1.0e6_wp*time, c_int))
  end subroutine pause_for

end module pauses
