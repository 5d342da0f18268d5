!> A progress line on the terminal, with an estimate of the time left, for runs longer than a
!! second.
module progress
  use, intrinsic :: iso_fortran_env, only: error_unit
  use file_system, only: standard_error_is_terminal
  use kinds, only: long, wp
  use text, only: to_string
  use time_left, only: note_progress, pace_t, seconds_left, time_left_text
  implicit none (type, external)
  private

  public :: progress_t, start_progress, show_progress, end_progress, write_progress

  !> A progress line; silent until it is started.
  type :: progress_t
    logical, private :: wanted = .false.           !! and standard error is a terminal
    integer, private :: shown = 0                  !! length of the line to wipe out
    integer(long), private :: last = 0_long        !! clock ticks at the start, or when the line was
                                                   !! last written
    type(pace_t), private :: pace                  !! of the run
    character(len=:), allocatable, private :: name !! of the deck
    character(len=:), allocatable, private :: noun !! what is counted
  end type progress_t

contains

  !> Starts the clock. Nothing is ever shown when standard error is a file or a pipe.
  subroutine start_progress(progress, name, noun, wanted)
    type(progress_t), intent(out) :: progress !! ready to be shown
    character(len=*), intent(in) :: name      !! of the deck
    character(len=*), intent(in) :: noun      !! what is counted
    logical, intent(in) :: wanted             !! whether the user wants it

    progress%name = name
    progress%noun = noun
    progress%wanted = wanted
    if (wanted) progress%wanted = standard_error_is_terminal()
    call system_clock(progress%last)
  end subroutine start_progress

  !> Shows how far the run is, at most once a second.
  subroutine show_progress(progress, done, total)
    type(progress_t), intent(inout) :: progress !! started, else nothing is shown
    integer, intent(in) :: done                 !! number of things done
    integer, intent(in) :: total                !! number of all

    character(len=:), allocatable :: line
    real(wp) :: time
    integer(long) :: now, rate

    if (.not. progress%wanted) return
    call system_clock(now, rate)
    time = real(now, wp)/real(rate, wp)
    call note_progress(progress%pace, time, done, total)
    if (now - progress%last < rate) return
    progress%last = now
    call write_progress(progress%name, progress%noun, done, total, seconds_left(progress%pace, &
      time, done), line)
    write (error_unit, "(a)", advance="no") achar(13)//line//repeat(" ", max(0, progress%shown - &
      len(line)))
    flush (error_unit)
    progress%shown = len(line)
  end subroutine show_progress

  !> `name: 34 % (680 of 2000 variants), about 2 min left`
  pure subroutine write_progress(name, noun, done, total, seconds, line)
    character(len=*), intent(in) :: name !! of the deck
    character(len=*), intent(in) :: noun !! what is counted
    integer, intent(in) :: done, total   !! number of things done, and of all
    real(wp), intent(in) :: seconds      !! that are left; below 0: not known
    character(len=:), allocatable, intent(out) :: line

    line = name//": "//to_string(int(100.0_wp*done/max(1, total)))//" % ("//to_string(done)// &
      " of "//to_string(total)//" "//noun//")"
    if (seconds >= 0.0_wp) line = line//", "//trim(time_left_text(seconds))
  end subroutine write_progress

  !> Wipes out the line.
  subroutine end_progress(progress)
    type(progress_t), intent(inout) :: progress !! perhaps shown

    if (progress%shown > 0) write (error_unit, "(a)", advance="no") achar(13)// &
      repeat(" ", progress%shown)//achar(13)
    progress%shown = 0
  end subroutine end_progress

end module progress
