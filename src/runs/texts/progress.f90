!> A progress line on the terminal, for runs longer than a second.
module progress
  use, intrinsic :: iso_fortran_env, only: error_unit
  use file_system, only: standard_error_is_terminal
  use kinds, only: long
  use text, only: to_string
  implicit none (type, external)
  private

  public :: progress_t, start_progress, show_progress, end_progress

  !> A progress line; silent until it is started.
  type :: progress_t
    logical, private :: wanted = .false.           !! and standard error is a terminal
    logical, private :: shown = .false.            !! there is a line to wipe out
    integer(long), private :: last = 0_long        !! clock ticks at the start, or when the line was
                                                   !! last written
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

    integer(long) :: now, rate

    if (.not. progress%wanted) return
    call system_clock(now, rate)
    if (now - progress%last < rate) return
    progress%last = now
    progress%shown = .true.
    write (error_unit, "(a)", advance="no") achar(13)//progress%name//": "//to_string(done)// &
      " of "//to_string(total)//" "//progress%noun
    flush (error_unit)
  end subroutine show_progress

  !> Wipes out the line.
  subroutine end_progress(progress)
    type(progress_t), intent(inout) :: progress !! perhaps shown

    if (progress%shown) write (error_unit, "(a)", advance="no") achar(13)// &
      repeat(" ", len(progress%name) + 50)//achar(13)
    progress%shown = .false.
  end subroutine end_progress

end module progress
