!> The output of `--json`: errors, warnings and failed positions of all decks in one document.
module run_document
  use deck_readings, only: deck_t
  use deck_runs, only: run_result_t
  use deck_source, only: standard_input
  use deck_summary, only: add_plain_message, error_list, failure_array, warning_list
  use json_text, only: add_item, add_member, json_array, json_list_t, json_null, json_object, &
    json_value
  use program_version, only: program_name, version_number
  use run_findings, only: untold_failures
  use text, only: string_t
  use variants, only: parameter_names
  implicit none (type, external)
  private

  public :: deck_outcome_t, document_text

  !> The outcome of a deck.
  type :: deck_outcome_t
    integer :: exit_status = -1                  !! -1: not run, because of another deck
    type(string_t), allocatable :: complaints(:) !! what prevented the run, or stopped it
    type(run_result_t) :: result                 !! empty if the deck was not run
  end type deck_outcome_t

contains

  !> The whole document.
  pure function document_text(exit_status, complaint, paths, decks, outcomes) result(text)
    integer, intent(in) :: exit_status              !! of the program
    character(len=*), intent(in) :: complaint       !! what is wrong with the command line; empty if
                                                    !! nothing
    type(string_t), intent(in) :: paths(:)          !! of the decks, as the user gave them
    type(deck_t), intent(in) :: decks(:)            !! (as paths)
    type(deck_outcome_t), intent(in) :: outcomes(:) !! (as paths)
    character(len=:), allocatable :: text

    type(json_list_t) :: object, errors, list
    integer :: i

    call add_member(object, "program", json_value(program_name))
    call add_member(object, "version", json_value(version_number))
    call add_member(object, "exit_status", json_value(exit_status))
    if (len(complaint) > 0) call add_item(errors, message_object(complaint))
    call add_member(object, "errors", json_array(errors))
    do i = 1, size(decks)
      call add_item(list, deck_object(paths(i)%text, decks(i), outcomes(i)))
    end do
    call add_member(object, "decks", json_array(list))
    text = json_object(object)//achar(10)
  end function document_text

  !> An error of the command line.
  pure function message_object(message) result(value)
    character(len=*), intent(in) :: message
    character(len=:), allocatable :: value

    type(json_list_t) :: object

    call add_member(object, "message", json_value(message))
    value = json_object(object)
  end function message_object

  !> Messages and failed positions of one deck.
  pure function deck_object(path, deck, outcome) result(value)
    character(len=*), intent(in) :: path !! as the user gave it
    type(deck_t), intent(in) :: deck
    type(deck_outcome_t), intent(in) :: outcome
    character(len=:), allocatable :: value

    character(len=:), allocatable :: file
    type(json_list_t) :: object, errors
    integer :: i

    file = path
    if (path == "-") file = standard_input
    call add_member(object, "deck", json_value(path))
    if (outcome%exit_status < 0) then
      call add_member(object, "exit_status", json_null)
    else
      call add_member(object, "exit_status", json_value(outcome%exit_status))
    end if
    errors = error_list(deck%diagnostics, deck%source, file)
    if (allocated(deck%refusal)) then
      if (deck%refusal%place%line > 0) then
        call add_plain_message(errors, file, deck%refusal%text, deck%refusal%place%line, &
          deck%refusal%place%column)
      else
        call add_plain_message(errors, file, deck%refusal%text)
      end if
    end if
    if (allocated(outcome%complaints)) then
      do i = 1, size(outcome%complaints)
        call add_plain_message(errors, file, outcome%complaints(i)%text)
      end do
    end if
    call add_member(object, "errors", json_array(errors))
    call add_member(object, "warnings", json_array(warning_list(deck%diagnostics, deck%source, &
      outcome%result%findings, path)))
    call add_member(object, "failures", failure_array(outcome%result%findings, &
      parameter_names(deck%cards)))
    call add_member(object, "more_failures", &
      json_value(untold_failures(outcome%result%findings)))
    value = json_object(object)
  end function deck_object

end module run_document
