!> Whether the crank of a deck with BALANCE cards turns fully.
module balance_turn_checks
  use diagnostics, only: add_error, diagnostics_t
  use errors, only: error_of_reach
  use full_turns, only: turns_fully
  use mechanisms, only: mechanism_t
  use models, only: balances, model_t, report_number
  use partial_balance_study, only: no_turn
  use tokens, only: token_t
  implicit none (type, external)
  private

  public :: check_balance_turn

contains

  !> Aims and harmonics are those of a whole turn. Errors: the crank does not turn fully, or meets a
  !! dead point.
  pure subroutine check_balance_turn(model, mechanism, diagnostics)
    type(model_t), intent(in) :: model                !! without errors so far
    type(mechanism_t), intent(in) :: mechanism        !! of the model, assembled
    type(diagnostics_t), intent(inout) :: diagnostics !! to which errors are added

    type(token_t) :: place

    if (.not. balances(model) .or. report_number(model, "balance") == 0) return
    if (turns_fully(mechanism%linkage, through=.true.)) return
    place = model%balance%keyword
    if (place%line == 0) place = model%shafts(1)%keyword
    call add_error(diagnostics, place, no_turn, kind=error_of_reach)
  end subroutine check_balance_turn

end module balance_turn_checks
