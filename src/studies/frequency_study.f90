!> Frequencies at every position and speed, in blocks of neighbouring positions.
module frequency_study
  use interruption, only: was_interrupted
  use kinds, only: wp
  use ledger, only: add_ledger, ledger_t
  use position_results, only: frequency_of, position_work_t
  use position_solver, only: new_position_work, solve_position
  use positions, only: positions_t, state_t
  use structures, only: structure_t
  use sweeps, only: failure_at, has_result, sweep_t
  use vibration_models, only: mode_request_t, vibration_models_t
  implicit none (type, external)
  private

  public :: begin_sweep, solve_block, finish_sweep, block_count, block_of, missed_states
  public :: station_on_link, frequency_values, has_result, failure_at, most_attempts

  !> Number of neighbouring positions that are solved one after another. The division into blocks,
  !! and with it the results, does not depend on the number of threads.
  integer, parameter :: block_size = 64

  !> How often orders are chosen at most: once for all positions, then again for those that need
  !! higher ones.
  integer, parameter :: most_attempts = 4

contains

  !> A sweep without results yet.
  pure subroutine begin_sweep(request, drawn, states, sweep)
    type(mode_request_t), intent(in) :: request !! modes, method, speeds, loads
    logical, intent(in) :: drawn(:, :)          !! (states, speeds) whether shapes are requested
    integer, intent(in) :: states               !! number of them
    type(sweep_t), intent(out) :: sweep         !! with empty results

    sweep%request = request
    sweep%drawn = drawn
    allocate (sweep%results(states))
  end subroutine begin_sweep

  !> Number of blocks into which a number of positions is divided.
  pure function block_count(states) result(count)
    integer, intent(in) :: states !! number of positions
    integer :: count

    count = (states + block_size - 1)/block_size
  end function block_count

  !> The states of a block.
  pure function block_of(states, number) result(block)
    integer, intent(in) :: states(:) !! numbers of all to be solved, by crank angle
    integer, intent(in) :: number    !! of the block, from 1
    integer, allocatable :: block(:) !! numbers of states

    block = states((number - 1)*block_size + 1:min(number*block_size, size(states)))
  end function block_of

  !> Solves the states of a block that have a pose, from position to position. Several blocks may be
  !! solved at the same time. An interrupted run stops between two positions.
  !!
  !! Errors: those of `solve_position`, in the results.
  subroutine solve_block(structure, positions, models, states, sweep)
    type(structure_t), intent(in) :: structure     !! with beams
    type(positions_t), intent(in) :: positions     !! of the run
    type(vibration_models_t), intent(in) :: models !! for these states
    integer, intent(in) :: states(:)               !! numbers, by crank angle
    type(sweep_t), intent(inout) :: sweep          !! results of these states are replaced, and
                                                   !! their work is added to that done before

    type(position_work_t) :: work
    type(ledger_t) :: before
    integer :: i, k

    work = new_position_work(structure, models, sweep%request)
    do k = 1, size(states)
      i = states(k)
      if (was_interrupted()) return
      if (allocated(positions%states(i)%error)) cycle
      before = sweep%results(i)%counts
      call solve_position(structure, models, positions%states(i), sweep%request, &
        sweep%drawn(i, :), work, sweep%results(i))
      call add_ledger(sweep%results(i)%counts, before)
    end do
  end subroutine solve_block

  !> States where the error due to the polynomial orders exceeds the accuracy requested. They need
  !! models of higher orders.
  pure function missed_states(sweep, states) result(missed)
    type(sweep_t), intent(in) :: sweep !! with results of these states
    integer, intent(in) :: states(:)   !! numbers
    integer, allocatable :: missed(:)  !! numbers of those that miss the accuracy

    missed = pack(states, sweep%results(states)%order_error > sweep%request%accuracy)
  end function missed_states

  !> Adds the work done at all positions to the counts of the sweep.
  pure subroutine finish_sweep(sweep)
    type(sweep_t), intent(inout) :: sweep !! with all results

    integer :: i

    do i = 1, size(sweep%results)
      call add_ledger(sweep%counts, sweep%results(i)%counts)
    end do
  end subroutine finish_sweep

  !> Frequencies [Hz] and their relative errors at a position and speed.
  pure function frequency_values(sweep, state, speed) result(values)
    type(sweep_t), intent(in) :: sweep        !! with results
    integer, intent(in) :: state, speed       !! numbers; with a result
    real(wp) :: values(2*sweep%request%modes) !! frequencies, then errors

    associate (result => sweep%results(state))
      values = [frequency_of(result%lambda(:, speed)), result%error(:, speed)]
    end associate
  end function frequency_values

  !> A point on a link at which mode shapes are written.
  pure function station_on_link(structure, state, body, number, points) result(station)
    type(structure_t), intent(in) :: structure !! whose links are drawn
    type(state_t), intent(in) :: state         !! with a pose
    integer, intent(in) :: body                !! number
    integer, intent(in) :: number              !! of the point, from 1
    integer, intent(in) :: points              !! on each link, equally spaced, ends included
    real(wp) :: station(3)                     !! distance from the first pin, then x and y in
                                               !! global axes [m]

    real(wp) :: s

    associate (this => structure%linkage%bodies(body))
      s = this%length*(number - 1)/(points - 1)
      station = [s, state%pose%pin(:, this%first_pin) + s*state%pose%direction(:, body)]
    end associate
  end function station_on_link

end module frequency_study
