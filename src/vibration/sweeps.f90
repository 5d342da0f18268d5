!> The results of a sweep over positions and speeds.
module sweeps
  use errors, only: error_t
  use ledger, only: ledger_t
  use position_results, only: position_result_t
  use positions, only: positions_t
  use vibration_models, only: mode_request_t, vibration_models_t
  implicit none (type, external)
  private

  public :: sweep_t, has_result, failure_at

  !> The results, one a different position.
  type :: sweep_t
    type(mode_request_t) :: request
    type(vibration_models_t) :: models                 !! that serve most positions
    type(position_result_t), allocatable :: results(:) !! (states); nothing in it where there is no
                                                       !! pose
    logical, allocatable :: drawn(:, :)                !! (states, speeds) whether its shapes are
                                                       !! asked for
    type(ledger_t) :: counts
  end type sweep_t

contains

  !> Whether there is a result at a position and speed.
  pure function has_result(positions, sweep, state, speed) result(has)
    type(positions_t), intent(in) :: positions
    type(sweep_t), intent(in) :: sweep
    integer, intent(in) :: state, speed !! numbers
    logical :: has

    has = .not. allocated(positions%states(state)%error)
    if (has) has = .not. allocated(sweep%results(state)%outcome(speed)%error)
  end function has_result

  !> Why there is no result at a position and speed where there is none.
  pure function failure_at(positions, sweep, state, speed) result(error)
    type(positions_t), intent(in) :: positions
    type(sweep_t), intent(in) :: sweep
    integer, intent(in) :: state, speed !! numbers
    type(error_t) :: error

    if (allocated(positions%states(state)%error)) then
      error = positions%states(state)%error
    else
      error = sweep%results(state)%outcome(speed)%error
    end if
  end function failure_at

end module sweeps
