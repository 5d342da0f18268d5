!> How long a run will still take, estimated from its pace so far.
module time_left
  use kinds, only: wp
  use text, only: to_string
  implicit none (type, external)
  private

  public :: pace_t, note_progress, seconds_left, time_left_text

  !> The pace of a run, measured since the last mark but one. Marks are set at times that double:
  !! the pace is that of the second half of the run, at least. What comes first (results of an
  !! earlier run, which take no time) does not count for long.
  type :: pace_t
    integer, private :: total = -1                 !! of the things that are counted
    real(wp), private :: begun(2) = 0.0_wp         !! times of the last two marks [s]
    integer, private :: done(2) = 0                !! numbers of things done at them
    real(wp), private :: next = 0.0_wp             !! time of the next mark [s]
    real(wp), private :: first = 0.0_wp            !! time of the first mark [s]
  end type pace_t

  !> Time from the first mark to the second [s].
  real(wp), parameter :: first_interval = 1.0_wp

contains

  !> Takes note of how far a run is. If other things are counted than before, or they are counted
  !! again, the pace is measured from now on.
  pure subroutine note_progress(pace, time, done, total)
    type(pace_t), intent(inout) :: pace !! so far
    real(wp), intent(in) :: time        !! on any clock, not before earlier ones [s]
    integer, intent(in) :: done, total  !! number of things done, and of all

    if (total /= pace%total .or. done < pace%done(2)) then
      pace%total = total
      pace%first = time
      pace%begun = time
      pace%done = done
      pace%next = time + first_interval
    else if (time >= pace%next) then
      pace%begun = [pace%begun(2), time]
      pace%done = [pace%done(2), done]
      pace%next = time + (time - pace%first)
    end if
  end subroutine note_progress

  !> Estimated time until all is done [s]; below 0 if there is no pace yet.
  pure function seconds_left(pace, time, done) result(seconds)
    type(pace_t), intent(in) :: pace !! noted
    real(wp), intent(in) :: time     !! now [s]
    integer, intent(in) :: done      !! number of things done
    real(wp) :: seconds

    seconds = -1.0_wp
    if (done > pace%done(1) .and. time > pace%begun(1)) seconds = (time - pace%begun(1))* &
      real(pace%total - done, wp)/real(done - pace%done(1), wp)
  end function seconds_left

  !> `about 40 s left`, `about 2 min left`, `about 3.5 h left`; blank if the time is not known.
  pure function time_left_text(seconds) result(text)
    real(wp), intent(in) :: seconds !! below 0: not known
    character(len=20) :: text

    real(wp), parameter :: minute = 60.0_wp, hour = 3600.0_wp, day = 86400.0_wp

    if (seconds < 0.0_wp) then
      text = ""
    else if (seconds < 10.0_wp) then
      text = "a few seconds left"
    else if (seconds < 1.5_wp*minute) then
      text = "about "//to_string(10*nint(seconds/10.0_wp))//" s left"
    else if (seconds < 1.5_wp*hour) then
      text = "about "//to_string(nint(seconds/minute))//" min left"
    else if (seconds < 2.0_wp*day) then
      text = "about "//to_string(0.5_wp*nint(2.0_wp*seconds/hour))//" h left"
    else if (seconds < 1000.0_wp*day) then
      text = "about "//to_string(nint(seconds/day))//" days left"
    else
      text = "years left"
    end if
  end function time_left_text

end module time_left
