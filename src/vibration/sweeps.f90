!> Results of a sweep over positions and speeds.
module sweeps
  use errors, only: error_t
  use ledger, only: ledger_t
  use position_results, only: position_result_t
  use positions, only: positions_t
  use structures, only: structure_t
  use vibration_models, only: mode_request_t, vibration_models_t
  implicit none (type, external)
  private

  public :: sweep_t, has_result, failure_at

  !> One result for each different position.
  type :: sweep_t
    type(mode_request_t) :: request                    !! modes, method, speeds, loads
    type(structure_t) :: structure                     !! that vibrates
    type(vibration_models_t) :: models                 !! of the first attempt; positions that
                                                       !! need higher orders have others
    type(position_result_t), allocatable :: results(:) !! (states); empty where there is no pose
    logical, allocatable :: drawn(:, :)                !! (states, speeds) whether shapes are
                                                       !! requested
    type(ledger_t) :: counts                           !! of the work done, models included
  end type sweep_t

contains

  !> Whether there is a result at a position and speed.
  pure function has_result(positions, sweep, state, speed) result(has)
    type(positions_t), intent(in) :: positions !! of the run
    type(sweep_t), intent(in) :: sweep         !! over these positions
    integer, intent(in) :: state, speed        !! numbers
    logical :: has

    has = .not. allocated(positions%states(state)%error)
    if (has) has = .not. allocated(sweep%results(state)%outcome(speed)%error)
  end function has_result

  !> The error at a position and speed without a result.
  pure function failure_at(positions, sweep, state, speed) result(error)
    type(positions_t), intent(in) :: positions !! of the run
    type(sweep_t), intent(in) :: sweep         !! over these positions
    integer, intent(in) :: state, speed        !! numbers; without a result
    type(error_t) :: error

    if (allocated(positions%states(state)%error)) then
      error = positions%states(state)%error
    else
      error = sweep%results(state)%outcome(speed)%error
    end if
  end function failure_at

end module sweeps
