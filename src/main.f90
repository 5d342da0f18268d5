!> FLEXMECH: vibration of flexible mechanisms. Arguments, one call a deck, exit status.
program main
  use, intrinsic :: iso_fortran_env, only: error_unit, output_unit
  use command_line, only: command_t, help_text, read_command_line, version_text
  use deck_runs, only: deck_t, read_deck, run_deck, run_result_t
  use errors, only: error_t
  use interruption, only: was_interrupted, watch_for_interruption
  implicit none (type, external)

  type(command_t) :: command
  type(deck_t), allocatable :: decks(:)
  type(run_result_t) :: result
  type(error_t), allocatable :: error
  integer :: i, j
  logical :: refused, failed

  call read_command_line(command, error)
  if (allocated(error)) then
    call say("flexmech: error: "//error%message//achar(10))
    stop 2, quiet=.true.
  end if
  if (command%help) then
    write (output_unit, "(a)", advance="no") help_text()
    stop 0, quiet=.true.
  else if (command%version) then
    write (output_unit, "(a)") version_text()
    stop 0, quiet=.true.
  end if

  allocate (decks(size(command%decks)))
  refused = .false.
  do i = 1, size(decks)
    call read_deck(command%decks(i)%text, command%run%threads, decks(i))
    if (.not. command%run%quiet) call say(decks(i)%warnings)
    call say(decks(i)%errors)
    refused = refused .or. len(decks(i)%errors) > 0
    do j = 1, i - 1
      if (decks(j)%base /= decks(i)%base) cycle
      call say("flexmech: error: two decks would write to the same folder '"//decks(i)%base//"': "//command%decks(j)%text// &
        " and "//command%decks(i)%text//achar(10))
      refused = .true.
    end do
  end do
  if (refused) stop 2, quiet=.true.
  if (command%check_only) stop 0, quiet=.true.

  call watch_for_interruption()
  failed = .false.
  do i = 1, size(decks)
    call run_deck(decks(i), command%run, result, error)
    if (allocated(error)) then
      call say(error%message//achar(10))
      if (was_interrupted()) stop 130, quiet=.true.
      stop 2, quiet=.true.
    end if
    if (.not. command%run%quiet .or. result%failed) call say(result%messages)
    if (command%stats) call say(result%statistics)
    failed = failed .or. result%failed
  end do
  deallocate (decks)
  if (failed) stop 1, quiet=.true.

contains

  !> Writes to standard error; the text brings its own line ends.
  subroutine say(text)
    character(len=*), intent(in) :: text

    write (error_unit, "(a)", advance="no") text
  end subroutine say

end program main
