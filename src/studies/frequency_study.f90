!> Frequencies at every position and speed.
module frequency_study
  use errors, only: error_t
  use interruption, only: was_interrupted
  use kinds, only: wp
  use ledger, only: add_ledger
  use link_store, only: link_store_t
  use load_cases, only: has_constant_loads
  use mechanisms, only: mechanism_t
  use models, only: effects_static, inertia_lumped, model_t, needs_loads, report_number, &
    solver_band, solver_dense
  use position_results, only: position_result_t, position_work_t
  use position_solver, only: new_position_work, solve_position
  use positions, only: by_crank_angle, positions_t
  use progress, only: progress_t, show_progress
  use request_cards, only: report_branches, report_shapes, report_t
  use sweep_journal, only: journal_t, keep_block, recall_block
  use sweeps, only: sweep_t
  use value_lists, only: value_list_t, value_number
  use vibration_models, only: any_method, by_band, by_dense, chosen_method, mode_request_t, &
    new_vibration_models, vibration_models_t
  implicit none (type, external)
  private

  public :: run_sweep, is_drawn, method_wanted

  !> Positions, neighbours in crank angle, that are solved one after the other. The division into
  !! chunks is the same for any number of threads, and so are the results.
  integer, parameter :: chunk = 64

  !> Times that orders are chosen anew for positions that need more than they give.
  integer, parameter :: most_attempts = 4

contains

  !> Solves every position that has a pose, on as many threads as are allowed. What a journal knows
  !! is not solved again, what is solved is kept there; the first variant has its models made in any
  !! case, for the log.
  !!
  !! Errors: the models could not be made.
  subroutine run_sweep(model, mechanism, positions, threads, progress, journal, variant, store, &
    sweep, error)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(positions_t), intent(in) :: positions
    integer, intent(in) :: threads
    type(progress_t), intent(inout) :: progress
    type(journal_t), intent(inout) :: journal
    integer, intent(in) :: variant             !! number of this model among those of the journal
    type(link_store_t), intent(inout) :: store !! of links taken apart before
    type(sweep_t), intent(out) :: sweep
    type(error_t), allocatable, intent(out) :: error

    type(vibration_models_t) :: models
    integer, allocatable :: states(:)
    logical, allocatable :: known(:) !! (chunks)
    integer :: attempt, i, made

    sweep%request = request_of(model, mechanism)
    call choose_drawn(model, positions, sweep)
    allocate (sweep%results(size(positions%states)))
    states = by_crank_angle(positions)
    made = store%made
    allocate (known((size(states) + chunk - 1)/chunk))
    call recall_chunks(journal, variant, states, sweep%results, known)
    do attempt = 1, most_attempts
      if (attempt > 1 .or. .not. all(known) .or. variant == 1 .or. sweep%request%follow) then
        call new_vibration_models(mechanism%structure_t, positions, states, sweep%request, &
          sweep%request%accuracy, store, models, sweep%counts, error)
        if (allocated(error)) return
        if (attempt == 1) sweep%models = models
        call sweep_positions(mechanism, positions, states, known .and. attempt == 1, models, &
          threads, progress, journal, merge(variant, 0, attempt == 1), sweep)
      end if
      ! Some positions may need more than the samples by which orders were chosen: these are found
      ! again.
      states = pack(states, sweep%results(states)%order_error > sweep%request%accuracy)
      if (size(states) == 0 .or. was_interrupted()) exit
    end do
    sweep%counts%link_models = store%made - made
    do i = 1, size(sweep%results)
      call add_ledger(sweep%counts, sweep%results(i)%counts)
    end do
  end subroutine run_sweep

  !> Takes chunks from the journal.
  subroutine recall_chunks(journal, variant, states, results, known)
    type(journal_t), intent(inout) :: journal
    integer, intent(in) :: variant
    integer, intent(in) :: states(:)
    type(position_result_t), intent(inout) :: results(:)
    logical, intent(out) :: known(:) !! (chunks)

    integer :: i

    !$omp critical (use_journal)
    do i = 1, size(known)
      call recall_block(journal, variant, i, states((i - 1)*chunk + 1:min(i*chunk, size(states))), &
        results, known(i))
    end do
    !$omp end critical (use_journal)
  end subroutine recall_chunks

  !> Solves chunk after chunk of some positions, given in the order of their crank angles, and each
  !! chunk from position to position.
  subroutine sweep_positions(mechanism, positions, states, known, models, threads, progress, &
    journal, variant, sweep)
    type(mechanism_t), intent(in) :: mechanism
    type(positions_t), intent(in) :: positions
    integer, intent(in) :: states(:) !! numbers
    logical, intent(in) :: known(:)  !! (chunks) solved already
    type(vibration_models_t), intent(in) :: models
    integer, intent(in) :: threads
    type(progress_t), intent(inout) :: progress
    type(journal_t), intent(inout) :: journal
    integer, intent(in) :: variant !! under which to keep what is solved; 0: not at all
    type(sweep_t), intent(inout) :: sweep

    type(position_work_t) :: work
    type(position_result_t) :: result
    integer :: i, k, first, last, done

    done = size(positions%states) - size(states)
    ! ARPACK serves one thread at a time: more of them would only wait.
    !$omp parallel do schedule(dynamic) default(shared) private(first, last, k, i, work, result) &
    !$omp   num_threads(merge(1, threads, sweep%request%method == by_band))
    do first = 1, size(states), chunk
      last = min(first + chunk - 1, size(states))
      if (known((first - 1)/chunk + 1)) cycle
      work = new_position_work(models, sweep%request)
      do k = first, last
        i = states(k)
        if (was_interrupted()) cycle
        if (allocated(positions%states(i)%error)) cycle
        call solve_position(mechanism%structure_t, models, positions%states(i), sweep%request, &
          sweep%drawn(i, :), work, result)
        call add_ledger(result%counts, sweep%results(i)%counts)
        sweep%results(i) = result
      end do
      if (variant > 0 .and. .not. was_interrupted()) then
        !$omp critical (use_journal)
        call keep_block(journal, variant, (first - 1)/chunk + 1, states(first:last), sweep%results)
        !$omp end critical (use_journal)
      end if
      !$omp critical (count_progress)
      done = done + last - first + 1
      call show_progress(progress, done, size(positions%states))
      !$omp end critical (count_progress)
    end do
    !$omp end parallel do
  end subroutine sweep_positions

  !> What the deck asks for, with the way to find it.
  pure function request_of(model, mechanism) result(request)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(mode_request_t) :: request

    integer :: number

    request%modes = model%modes
    request%axial = needs_loads(model)
    request%constant = has_constant_loads(mechanism%linkage)
    request%lumped = model%inertia == inertia_lumped
    request%method = chosen_method(method_wanted(model), mechanism%accuracy > 0.0_wp, &
      mechanism%mesh%elements, mechanism%mesh%order, mechanism%mesh%sheared)
    if (mechanism%accuracy > 0.0_wp) request%accuracy = mechanism%accuracy
    request%follow = report_number(model, report_branches) > 0
    number = report_number(model, report_shapes)
    if (number > 0) request%points = model%reports(number)%points
    request%acceleration = model%acceleration
    if (model%effects == effects_static) then
      request%speed = [0.0_wp]
    else
      request%speed = model%speed%value
    end if
  end function request_of

  !> What SOLVER says.
  pure function method_wanted(model) result(method)
    type(model_t), intent(in) :: model
    integer :: method

    method = any_method
    if (model%solver == solver_dense) method = by_dense
    if (model%solver == solver_band) method = by_band
  end function method_wanted

  !> Marks the positions and speeds whose shapes are asked for.
  pure subroutine choose_drawn(model, positions, sweep)
    type(model_t), intent(in) :: model
    type(positions_t), intent(in) :: positions
    type(sweep_t), intent(inout) :: sweep

    integer :: i, k, number

    allocate (sweep%drawn(size(positions%states), size(sweep%request%speed)))
    sweep%drawn = .false.
    number = report_number(model, report_shapes)
    if (number == 0) return
    do k = 1, size(sweep%request%speed)
      do i = 1, size(positions%crank)
        if (is_drawn(model%reports(number), positions%crank(i), sweep%request%speed(k))) then
          sweep%drawn(positions%state(i), k) = .true.
        end if
      end do
    end do
  end subroutine choose_drawn

  !> Whether a report of shapes asks for a position and speed; without `crank=` and `speed=` it asks
  !! for all.
  pure function is_drawn(report, crank, speed) result(is)
    type(report_t), intent(in) :: report
    real(wp), intent(in) :: crank !! [deg]
    real(wp), intent(in) :: speed !! [rad/s]
    logical :: is

    is = chosen(report%crank, crank) .and. chosen(report%speed, speed)

  end function is_drawn

  !> Whether a list has a value; an empty list has them all.
  pure function chosen(list, value)
    type(value_list_t), intent(in) :: list
    real(wp), intent(in) :: value
    logical :: chosen

    chosen = size(list%value) == 0
    if (.not. chosen) chosen = value_number(list, value) > 0
  end function chosen

end module frequency_study
