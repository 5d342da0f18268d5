!> Frequencies at every position and speed, in blocks of neighbouring positions.
module frequency_study
  use interruption, only: was_interrupted
  use kinds, only: wp
  use ledger, only: add_ledger
  use position_results, only: frequency_of, position_result_t, position_work_t
  use position_solver, only: new_position_work, solve_position
  use positions, only: positions_t, state_t
  use structures, only: structure_t
  use sweeps, only: failure_at, has_result, sweep_t
  use vibration_models, only: mode_request_t, vibration_models_t
  implicit none (type, external)
  private

  public :: begin_sweep, solve_block, finish_sweep, block_count, block_of, missed_states
  public :: station_on_link, frequency_values, has_result, failure_at, sweep_t, most_attempts

  !> Positions, neighbours in crank angle, that are solved one after the other. The division into
  !! blocks is the same for any number of threads, and so are the results.
  integer, parameter :: block_size = 64

  !> Times that orders are chosen anew for positions that need more than they give.
  integer, parameter :: most_attempts = 4

contains

  !> A sweep without results.
  pure subroutine begin_sweep(request, drawn, states, sweep)
    type(mode_request_t), intent(in) :: request
    logical, intent(in) :: drawn(:, :) !! (states, speeds) whether shapes are wanted
    integer, intent(in) :: states      !! how many
    type(sweep_t), intent(out) :: sweep

    sweep%request = request
    sweep%drawn = drawn
    allocate (sweep%results(states))
  end subroutine begin_sweep

  !> How many blocks so many positions make.
  pure function block_count(states) result(count)
    integer, intent(in) :: states
    integer :: count

    count = (states + block_size - 1)/block_size
  end function block_count

  !> The states of a block, of those that are listed.
  pure function block_of(states, number) result(block)
    integer, intent(in) :: states(:) !! numbers, by crank angle
    integer, intent(in) :: number    !! from 1
    integer, allocatable :: block(:)

    block = states((number - 1)*block_size + 1:min(number*block_size, size(states)))
  end function block_of

  !> Solves the states of a block that have a pose, from position to position. Several blocks may be
  !! solved at the same time.
  subroutine solve_block(structure, positions, models, states, sweep)
    type(structure_t), intent(in) :: structure
    type(positions_t), intent(in) :: positions
    type(vibration_models_t), intent(in) :: models
    integer, intent(in) :: states(:)        !! numbers, by crank angle
    type(sweep_t), intent(inout) :: sweep   !! whose results of these states are replaced

    type(position_work_t) :: work
    type(position_result_t) :: result
    integer :: i, k

    work = new_position_work(models, sweep%request)
    do k = 1, size(states)
      i = states(k)
      if (was_interrupted()) return
      if (allocated(positions%states(i)%error)) cycle
      call solve_position(structure, models, positions%states(i), sweep%request, &
        sweep%drawn(i, :), work, result)
      call add_ledger(result%counts, sweep%results(i)%counts)
      sweep%results(i) = result
    end do
  end subroutine solve_block

  !> States whose orders leave a larger error than is wanted: they need models of their own.
  pure function missed_states(sweep, states) result(missed)
    type(sweep_t), intent(in) :: sweep
    integer, intent(in) :: states(:) !! numbers
    integer, allocatable :: missed(:)

    missed = pack(states, sweep%results(states)%order_error > sweep%request%accuracy)
  end function missed_states

  !> Adds up what all positions have taken.
  pure subroutine finish_sweep(sweep)
    type(sweep_t), intent(inout) :: sweep

    integer :: i

    do i = 1, size(sweep%results)
      call add_ledger(sweep%counts, sweep%results(i)%counts)
    end do
  end subroutine finish_sweep

  !> Frequencies [Hz] and their relative errors at a position and speed.
  pure function frequency_values(sweep, state, speed) result(values)
    type(sweep_t), intent(in) :: sweep
    integer, intent(in) :: state, speed !! numbers, with a result
    real(wp) :: values(2*sweep%request%modes)

    associate (result => sweep%results(state))
      values = [frequency_of(result%lambda(:, speed)), result%error(:, speed)]
    end associate
  end function frequency_values

  !> A place on a link whose shape is drawn: distance from its first pin, and x and y in global axes
  !! [m].
  pure function station_on_link(structure, state, body, number, points) result(station)
    type(structure_t), intent(in) :: structure
    type(state_t), intent(in) :: state     !! with a pose
    integer, intent(in) :: body
    integer, intent(in) :: number, points  !! of the place, from 1, and how many there are
    real(wp) :: station(3)

    real(wp) :: s

    associate (this => structure%linkage%bodies(body))
      s = this%length*(number - 1)/(points - 1)
      station = [s, state%pose%pin(:, this%first_pin) + s*state%pose%direction(:, body)]
    end associate
  end function station_on_link

end module frequency_study
