!> Frequencies at every position and speed.
module frequency_sweep
  use interruption, only: was_interrupted
  use kinds, only: wp
  use mechanisms, only: mechanism_t
  use models, only: effects_static, inertia_lumped, model_t, needs_loads, report_number, solver_auto, solver_dense
  use modes, only: dense_limit
  use position_modes, only: mode_request_t, position_result_t, solve_position
  use positions, only: positions_t
  use progress, only: progress_t, show_progress
  use requests, only: report_shapes, report_t
  use value_lists, only: value_list_t, value_number
  implicit none (type, external)
  private

  public :: sweep_t, run_sweep, is_drawn

  !> The results, one a different position.
  type :: sweep_t
    type(mode_request_t) :: request
    type(position_result_t), allocatable :: results(:) !! (states); nothing in it where there is no pose
    logical, allocatable :: drawn(:, :)                !! (states, speeds) whether its shapes are asked for
  end type sweep_t

contains

  !> Solves every position that has a pose, on as many threads as are allowed. Each result depends on its own position only, so
  !! that the number of threads changes nothing.
  subroutine run_sweep(model, mechanism, positions, threads, progress, sweep)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(positions_t), intent(in) :: positions
    integer, intent(in) :: threads
    type(progress_t), intent(inout) :: progress
    type(sweep_t), intent(out) :: sweep

    integer :: i, done

    sweep%request = request_of(model, mechanism)
    call choose_drawn(model, positions, sweep)
    allocate (sweep%results(size(positions%states)))
    done = 0
    ! The band solver has ARPACK, which serves one thread at a time: more of them would only wait.
    !$omp parallel do schedule(static) num_threads(merge(threads, 1, sweep%request%dense)) default(shared) private(i)
    do i = 1, size(positions%states)
      if (was_interrupted()) cycle
      if (allocated(positions%states(i)%error)) cycle
      call solve_position(mechanism, positions%states(i)%pose, positions%states(i)%motion, sweep%request, sweep%drawn(i, :), &
        sweep%results(i))
      !$omp critical (count_progress)
      done = done + 1
      call show_progress(progress, done, size(positions%states))
      !$omp end critical (count_progress)
    end do
    !$omp end parallel do
  end subroutine run_sweep

  !> What the deck asks for, with the solver chosen.
  pure function request_of(model, mechanism) result(request)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(mode_request_t) :: request

    request%modes = model%modes
    request%axial = needs_loads(model)
    request%lumped = model%inertia == inertia_lumped
    request%dense = model%solver == solver_dense
    ! ARPACK finds fewer modes than there are unknowns, and gains nothing when nearly all are wanted.
    if (model%solver == solver_auto) then
      request%dense = mechanism%mesh%unknowns <= max(dense_limit, 2*model%modes)
    end if
    request%acceleration = model%acceleration
    if (model%effects == effects_static) then
      request%speed = [0.0_wp]
    else
      request%speed = model%speed%value
    end if
  end function request_of

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

  !> Whether a report of shapes asks for a position and speed; without `crank=` and `speed=` it asks for all.
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

end module frequency_sweep
