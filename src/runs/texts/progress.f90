!> A line that counts on a terminal, for runs longer than a second.
module progress
  use, intrinsic :: iso_fortran_env, only: error_unit
  use file_system, only: standard_error_is_terminal
  use kinds, only: long
  use text, only: to_string
  implicit none (type, external)
  private

  public :: progress_t, start_progress, show_progress, end_progress

  type :: progress_t
    logical, private :: wanted = .false.
    logical, private :: shown = .false.
    integer(long), private :: last = 0_long !! clock ticks when a line was last written, or at the
                                            !! start
    character(len=:), allocatable, private :: name, noun
  end type progress_t

contains

  !> Nothing is ever shown when standard error is a file or a pipe.
  subroutine start_progress(progress, name, noun, wanted)
    type(progress_t), intent(out) :: progress
    character(len=*), intent(in) :: name !! of the deck
    character(len=*), intent(in) :: noun !! what is counted
    logical, intent(in) :: wanted

    progress%name = name
    progress%noun = noun
    progress%wanted = wanted
    if (wanted) progress%wanted = standard_error_is_terminal()
    call system_clock(progress%last)
  end subroutine start_progress

  !> Tells how far the run has come, once a second.
  subroutine show_progress(progress, done, total)
    type(progress_t), intent(inout) :: progress
    integer, intent(in) :: done, total

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

  !> Wipes the line out.
  subroutine end_progress(progress)
    type(progress_t), intent(inout) :: progress

    if (progress%shown) write (error_unit, "(a)", advance="no") achar(13)// &
      repeat(" ", len(progress%name) + 50)//achar(13)
    progress%shown = .false.
  end subroutine end_progress

end module progress
