!> FLEXMECH: rigid dynamics and vibration of flexible mechanisms. Reads the arguments, runs each
!! deck and sets the exit status.
program main
  use, intrinsic :: iso_fortran_env, only: error_unit
  use available_memory, only: threads_in_memory
  use card_help, only: card_help_text
  use command_line, only: command_t, help_text, read_command_line, version_text
  use deck_readings, only: deck_t, read_deck
  use deck_runs, only: check_parts, run_deck, run_options_t
  use errors, only: error_of_interruption, error_t, rendered
  use figures_command, only: command_for_figures
  use interruption, only: limit_time, was_interrupted, watch_for_interruption
  use kinds, only: wp
  use memory_refusals, only: require_memory
  use manual_page, only: manual_page_text
  use rank_service, only: dismiss_ranks, serve_leader
  use ranks, only: leader, own_rank, ranks_here, start_ranks
  use run_document, only: deck_outcome_t, document_text
  use shell_completion, only: completion_text
  use standard_output, only: end_of_output, print_text
  use stopwatch, only: lap, start_stopwatch, stopwatch_t
  use text, only: plural, string_t, to_string, visible
  implicit none (type, external)

  !> To read a deck, however short [bytes].
  integer, parameter :: least_memory = 2000000

  type(command_t) :: command
  type(deck_t), allocatable :: decks(:)
  type(deck_outcome_t), allocatable :: outcomes(:)
  type(run_options_t) :: options
  type(error_t), allocatable :: error, unprinted
  type(stopwatch_t) :: watch
  real(wp) :: so_far
  integer :: i, j, processes, threads
  logical :: refused

  call start_stopwatch(watch)
  call start_ranks()
  call watch_for_interruption()
  processes = ranks_here()
  call read_command_line(command, error)
  if (own_rank() /= leader) then
    call serve_leader(command%settings)
    stop 0, quiet=.true.
  end if
  if (allocated(error)) then
    call say("flexmech: "//rendered(error)//achar(10))
    allocate (decks(0), outcomes(0))
    call finish(2, error%text)
  end if
  if (command%help) then
    call print_and_leave(help_text())
  else if (command%help_cards) then
    call print_and_leave(card_help_text())
  else if (command%version) then
    call print_and_leave(version_text()//achar(10))
  else if (command%manual) then
    call print_and_leave(manual_page_text())
  else if (allocated(command%shell)) then
    call print_and_leave(completion_text(command%shell))
  end if

  call require_memory(least_memory)
  threads = threads_in_memory(command%threads)
  if (threads < command%threads .and. .not. command%quiet) call say("flexmech: warning: the "// &
    "limit of address space (ulimit -v) has room for "//to_string(threads)//" of "// &
    plural(command%threads, "thread")//achar(10))
  command%threads = threads
  options%folder = command%folder
  options%threads = command%threads
  options%quiet = command%quiet
  options%resume = command%resume
  options%csv = command%csv
  options%figures = command_for_figures(command%program, command%search_path)
  options%csv_only = command%csv_only
  options%digits = command%digits
  options%part = command%part
  options%join = command%join
  if (allocated(command%limit)) options%limit = command%limit

  allocate (decks(size(command%decks)), outcomes(size(command%decks)))
  refused = .false.
  do i = 1, size(decks)
    call read_deck(command%decks(i)%text, command%threads, decks(i), command%settings, &
      processes, command%join, command%check_only, command%part)
    if (was_interrupted()) then
      call complain(outcomes(i), "interrupted")
      call say(command%decks(i)%text//": interrupted"//achar(10))
      outcomes(i)%exit_status = 130
      call finish(130, "")
    end if
    if (.not. command%quiet) call say(decks(i)%warnings)
    call say(decks(i)%errors)
    if (len(decks(i)%errors) > 0) outcomes(i)%exit_status = 2
    do j = 1, i - 1
      if (decks(j)%base /= decks(i)%base) cycle
      call complain(outcomes(i), "two decks would write to the same folder '"//decks(i)%base// &
        "': "//command%decks(j)%text//" and "//command%decks(i)%text)
      call say("flexmech: error: "//outcomes(i)%complaints(size(outcomes(i)%complaints))%text// &
        achar(10))
    end do
    if (outcomes(i)%exit_status /= 2) call check_parts(decks(i), options, error)
    if (allocated(error)) then
      call complain(outcomes(i), error%text)
      call say(rendered(error)//achar(10))
      deallocate (error)
    end if
    refused = refused .or. outcomes(i)%exit_status == 2
  end do
  if (refused) call finish(2, "")
  if (command%check_only) then
    outcomes%exit_status = 0
    call finish(0, "")
  end if

  ! Decks are read however long it takes: a loop of runs with --resume would get nowhere if that is
  ! all there is time for.
  call lap(watch, so_far)
  if (so_far >= command%most_time) then
    call say("flexmech: stopped at its time limit of "//command%limit//": reading and checking "// &
      "took "//to_string(so_far, 2)//" s, and nothing was computed; expected a longer "// &
      "--time-limit"//achar(10))
    outcomes%exit_status = 130
    call finish(130, "stopped at its time limit of "//command%limit)
  end if
  call limit_time(command%most_time - so_far)
  do i = 1, size(decks)
    call run_deck(decks(i), options, outcomes(i)%result, error)
    if (.not. command%quiet) call say(outcomes(i)%result%warnings)
    if (len(decks(i)%errors) > 0) then
      call say(decks(i)%errors)
      outcomes(i)%exit_status = 2
      call finish(2, "")
    end if
    if (allocated(error)) then
      call say(rendered(error)//achar(10))
      call complain(outcomes(i), rendered(error))
      if (error%kind == error_of_interruption) outcomes(i)%exit_status = 130
      call finish(outcomes(i)%exit_status, "")
    end if
    associate (result => outcomes(i)%result)
      if (.not. command%quiet .or. result%failed) call say(result%messages)
      if (command%stats) call say(result%statistics)
      if (.not. (command%quiet .or. command%json)) call print_text(result%success, unprinted)
      outcomes(i)%exit_status = merge(1, 0, result%failed)
    end associate
  end do
  call finish(maxval(outcomes%exit_status), "")

contains

  !> Ends the program; before, writes the JSON document if requested.
  subroutine finish(status, complaint)
    integer, intent(in) :: status             !! of the program
    character(len=*), intent(in) :: complaint !! error of the command line; empty: none

    if (command%json) call print_text(document_text(status, complaint, command%decks, decks, &
      outcomes), unprinted)
    call leave(status)
  end subroutine finish

  !> Prints a text that was asked for, and ends the program.
  subroutine print_and_leave(text)
    character(len=*), intent(in) :: text

    call print_text(text, unprinted)
    call leave(0)
  end subroutine print_and_leave

  !> Ends the program on all ranks.
  subroutine leave(status_so_far)
    integer, intent(in) :: status_so_far !! of the program

    !> Time for ranks that do something nobody needs any more [s].
    real(wp), parameter :: after_interruption = 2.0_wp
    integer :: status

    call end_of_output(unprinted)
    status = status_so_far
    if (allocated(unprinted)) then
      call say("flexmech: "//rendered(unprinted)//achar(10))
      status = 2
    end if
    call dismiss_ranks(status, merge(after_interruption, huge(1.0_wp), was_interrupted()))
    stop status, quiet=.true.
  end subroutine leave

  !> Keeps an error that concerns a deck as a whole.
  subroutine complain(outcome, complaint)
    type(deck_outcome_t), intent(inout) :: outcome
    character(len=*), intent(in) :: complaint

    if (.not. allocated(outcome%complaints)) allocate (outcome%complaints(0))
    outcome%complaints = [outcome%complaints, string_t(complaint)]
    outcome%exit_status = 2
  end subroutine complain

  !> Writes to standard error. The text contains its own line ends.
  subroutine say(text)
    character(len=*), intent(in) :: text

    integer :: status

    write (error_unit, "(a)", advance="no", iostat=status) visible(text)
  end subroutine say

end program main
