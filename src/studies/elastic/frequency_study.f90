!> Frequencies at every position and speed, in blocks of neighbouring positions.
module frequency_study
  use elastic_linkages, only: elastic_linkage_t
  use errors, only: error_t
  use interruption, only: was_interrupted
  use joint_study, only: joint_t
  use kinds, only: wp
  use ledger, only: add_ledger
  use linkages, only: linkage_t, normal_to
  use part_poses, only: place_parts_of
  use pose_types, only: pose_t
  use position_results, only: frequency_of, position_work_t
  use position_solver, only: new_position_work, solve_position
  use poses, only: arm_to_place
  use positions, only: positions_t, state_t
  use structures, only: structure_t
  use sweeps, only: failure_at, has_result, sweep_t
  use vibration_models, only: mode_request_t, vibration_models_t
  implicit none (type, external)
  private

  public :: begin_sweep, solve_block, add_work, block_count, block_of, missed_states
  public :: find_stations, find_displacements, link_of_part, frequency_values, damping_values
  public :: has_result, failure_at, most_attempts

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
    type(sweep_t), intent(inout) :: sweep          !! results of these states are replaced

    type(position_work_t) :: work
    integer :: i, k

    work = new_position_work(structure, models, sweep%request)
    do k = 1, size(states)
      i = states(k)
      if (was_interrupted()) return
      if (allocated(positions%states(i)%error)) cycle
      call solve_position(structure, models, positions%states(i), sweep%request, &
        sweep%drawn(i, :), work, sweep%results(i))
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

  !> Adds the work done at states to the counts of the sweep.
  pure subroutine add_work(sweep, states)
    type(sweep_t), intent(inout) :: sweep !! with results of these states
    integer, intent(in) :: states(:)      !! numbers

    integer :: i

    do i = 1, size(states)
      call add_ledger(sweep%counts, sweep%results(states(i))%counts)
    end do
  end subroutine add_work

  !> Frequencies [Hz] and their relative errors at a position and speed.
  pure function frequency_values(sweep, state, speed) result(values)
    type(sweep_t), intent(in) :: sweep        !! with results
    integer, intent(in) :: state, speed       !! numbers; with a result
    real(wp) :: values(2*sweep%request%modes) !! frequencies, then errors

    associate (result => sweep%results(state))
      values = [frequency_of(result%lambda(:, speed)), result%error(:, speed)]
    end associate
  end function frequency_values

  !> Damping ratios at a position and speed. Where all dampers have the constant 0: none.
  pure function damping_values(sweep, state, speed) result(values)
    type(sweep_t), intent(in) :: sweep      !! with results
    integer, intent(in) :: state, speed     !! numbers; with a result
    real(wp) :: values(sweep%request%modes) !! [-]

    associate (result => sweep%results(state))
      if (allocated(result%damping)) then
        values = result%damping(:, speed)
      else
        values = merge(-1.0_wp, 0.0_wp, result%lambda(:, speed) < 0.0_wp)
      end if
    end associate
  end function damping_values

  !> The points of links at which mode shapes are written: on every part that vibrates equally
  !! spaced, its ends included.
  subroutine find_stations(structure, state, points, station)
    type(structure_t), intent(in) :: structure   !! whose links are drawn
    type(state_t), intent(in) :: state           !! with a pose
    integer, intent(in) :: points                !! on every part
    real(wp), allocatable, intent(out) :: station(:, :, :) !! (3, points, parts) distance along the
                                                 !! link from where its first part begins, then x
                                                 !! and y in global axes [m]

    type(linkage_t) :: parts
    type(pose_t) :: placed
    real(wp) :: before
    integer :: part

    call place_parts(structure, state, parts, placed)
    allocate (station(3, points, size(parts%bodies)))
    before = 0.0_wp
    do part = 1, size(station, 3)
      if (link_of_part(structure, part) /= link_of_part(structure, max(1, part - 1))) &
        before = 0.0_wp
      call place_stations(parts, placed, part, before, station(:, :, part))
      before = before + parts%bodies(part)%length
    end do
  end subroutine find_stations

  !> The parts of the links that vibrate, as they are at a position.
  pure subroutine place_parts(structure, state, parts, placed)
    type(structure_t), intent(in) :: structure
    type(state_t), intent(in) :: state
    type(linkage_t), intent(out) :: parts !! whose bodies are the parts
    type(pose_t), intent(out) :: placed   !! of these

    type(elastic_linkage_t) :: elastic
    type(error_t), allocatable :: error

    elastic = structure%elastic
    call place_parts_of(structure%linkage, state%pose, elastic, placed, error)
    parts = elastic%linkage
  end subroutine place_parts

  !> Where joints and points of rigid links are, and how they move in modes: links have an end of a
  !! part at each of their joints.
  pure subroutine find_displacements(structure, state, joints, body, place, shape, x, moved)
    type(structure_t), intent(in) :: structure   !! whose links vibrate
    type(state_t), intent(in) :: state           !! with a pose
    type(joint_t), intent(in) :: joints(:)       !! of `list_joints`
    integer, intent(in) :: body(:)               !! (points) rigid bodies that carry them
    real(wp), intent(in) :: place(:, :)          !! (2, points) from the first pin of the body, in
                                                 !! its axes [m]
    real(wp), intent(in) :: shape(:, :, :, :)    !! (3, points, parts, modes) of `shapes_t`
    real(wp), allocatable, intent(out) :: x(:, :)        !! (2, joints and points) global axes [m]
    real(wp), allocatable, intent(out) :: moved(:, :, :) !! (3, joints and points, modes) of a link
                                                 !! there; of a block as its pin moves, and its line
                                                 !! turns: units of `shapes_t`

    type(linkage_t) :: parts
    type(pose_t) :: placed
    integer :: i, b, point

    allocate (x(2, size(joints) + size(body)))
    allocate (moved(3, size(x, 2), size(shape, 4)), source=0.0_wp)
    call place_parts(structure, state, parts, placed)
    do i = 1, size(x, 2)
      if (i > size(joints)) then
        b = body(i - size(joints))
        point = 0
        x(:, i) = state%pose%pin(:, structure%linkage%bodies(b)%first_pin) + &
          arm_to_place(state%pose, b, place(:, i - size(joints)))
      else
        b = joints(i)%body
        point = joints(i)%pin
        x(:, i) = state%pose%pin(:, point)
        if (joints(i)%slider > 0) point = max(point, structure%elastic%contact(joints(i)%slider))
      end if
      if (b > 0) call take_displacement(structure, parts, placed, shape, b, point, x(:, i), &
        moved(:, i, :))
      if (i > size(joints)) cycle
      if (joints(i)%slider > 0) moved(:2, i, :) = moved(:2, findloc(joints%pin, joints(i)%pin, &
        dim=1), :)
    end do
  end subroutine find_displacements

  !> The displacement of a link at an end of one of its parts, or at any place of a rigid link.
  pure subroutine take_displacement(structure, parts, placed, shape, body, point, x, moved)
    type(structure_t), intent(in) :: structure
    type(linkage_t), intent(in) :: parts
    type(pose_t), intent(in) :: placed
    real(wp), intent(in) :: shape(:, :, :, :) !! (3, points, parts, modes)
    integer, intent(in) :: body, point        !! numbers
    real(wp), intent(in) :: x(2)              !! the place
    real(wp), intent(out) :: moved(:, :)      !! (3, modes)

    real(wp) :: arm(2)
    integer :: part, last, i

    last = 1
    do part = 1, size(parts%bodies)
      if (link_of_part(structure, part) /= body) cycle
      last = part
      moved = shape(:, 1, part, :)
      if (parts%bodies(part)%first_pin == point) return
      moved = shape(:, size(shape, 2), part, :)
      if (parts%bodies(part)%last_pin == point) return
    end do
    moved = shape(:, 1, last, :)
    arm = normal_to(x - placed%pin(:, parts%bodies(last)%first_pin))
    do i = 1, 2
      moved(i, :) = moved(i, :) + arm(i)*moved(3, :)
    end do
  end subroutine take_displacement

  !> The points of a part.
  pure subroutine place_stations(linkage, pose, part, before, station)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    integer, intent(in) :: part
    real(wp), intent(in) :: before         !! where it begins along its link [m]
    real(wp), intent(out) :: station(:, :) !! (3, points)

    real(wp) :: s
    integer :: i

    associate (this => linkage%bodies(part))
      do i = 1, size(station, 2)
        s = this%length*(i - 1)/(size(station, 2) - 1)
        station(:, i) = [before + s, pose%pin(:, this%first_pin) + s*pose%direction(:, part)]
      end do
    end associate
  end subroutine place_stations

  !> Number of the link that a part belongs to.
  pure function link_of_part(structure, part) result(link)
    type(structure_t), intent(in) :: structure !! with beams
    integer, intent(in) :: part                !! number, from 1
    integer :: link

    link = structure%elastic%body(part)
  end function link_of_part

end module frequency_study
