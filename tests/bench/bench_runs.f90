!> Runs one case: once to find out what it gives, and then again and again for its time.
module bench_runs
  use bench_cases, only: bench_case_t, is_nodal, with_deformation
  use bench_models, only: base_t, model_of, refusal
  use errors, only: error_t
  use exact_values, only: bench_speed, exact_states, exact_values_t, largest_error
  use kinds, only: long, wp
  use ledger, only: ledger_t
  use link_store, only: link_store_t
  use mechanisms, only: mechanism_t, new_mechanism
  use models, only: model_t
  use nodal_runs, only: solve_nodal_states
  use position_results, only: position_result_t, position_work_t
  use position_solver, only: new_position_work, solve_position
  use positions, only: by_crank_angle, find_positions, positions_t
  use task_journal, only: journal_t
  use text, only: to_string
  use variant_runs, only: begin_variant_run, compute_variant, variant_run_t
  use vibration_models, only: by_orders, new_vibration_models, vibration_models_t
  implicit none (type, external)
  private

  public :: prepare_case, time_case, seconds_since

  !> Solvers that do not use neighbours are timed at as many positions as fit into this, three at least, and not at all where one
  !! takes longer [s].
  real(wp), parameter :: most_seconds = 0.1_wp, most_of_one = 0.3_wp
  integer, parameter :: fewest = 3

  !> A case that took longer than this to prepare is repeated less often [s].
  real(wp), parameter :: is_long = 1.0_wp

contains

  function seconds_since(start) result(seconds)
    integer(long), intent(in) :: start !! of the system clock
    real(wp) :: seconds

    integer(long) :: now, rate

    call system_clock(now, rate)
    seconds = real(now - start, wp)/real(rate, wp)
  end function seconds_since

  !> Solves a case once: its unknowns, its error, whether and at which positions it can be timed.
  subroutine prepare_case(base, exact, this)
    type(base_t), intent(in) :: base
    type(exact_values_t), intent(in) :: exact
    type(bench_case_t), intent(inout) :: this

    type(model_t) :: model
    type(mechanism_t) :: mechanism
    type(positions_t) :: positions
    real(wp), allocatable :: lambda(:, :)
    integer(long) :: start
    integer :: i

    model = model_of(base, this)
    allocate (this%setup(0), this%rest(0))
    call system_clock(start)
    this%failure = refusal(base, model)
    if (len(this%failure) > 0) return
    mechanism = new_mechanism(model)
    positions = find_positions(mechanism%linkage, model%crank%value)
    this%states = size(positions%states)
    this%timed = [(i, i=1, this%states)]
    allocate (lambda(this%modes, this%states))
    lambda = 0.0_wp
    if (is_nodal(this%solver)) then
      this%unknowns = mechanism%mesh%unknowns
      call prepare_nodal(mechanism, positions, exact, this, lambda)
    else
      this%unknowns = mechanism%mesh%unknowns
      call prepare_sweep(model, this, lambda)
    end if
    this%is_long = .not. is_nodal(this%solver) .and. seconds_since(start) > is_long
    if (len(this%failure) > 0) return
    this%error = largest_error(exact, positions, speed_of(this), lambda)
  end subroutine prepare_case

  !> Finds the exact positions' frequencies, and how many positions can be timed.
  subroutine prepare_nodal(mechanism, positions, exact, this, lambda)
    type(mechanism_t), intent(in) :: mechanism
    type(positions_t), intent(in) :: positions
    type(exact_values_t), intent(in) :: exact
    type(bench_case_t), intent(inout) :: this
    real(wp), intent(inout) :: lambda(:, :)

    type(error_t), allocatable :: error
    integer, allocatable :: numbers(:)
    integer(long) :: start
    real(wp) :: one

    call system_clock(start)
    call solve_nodal_states(mechanism, positions%states, [1], speed_of(this), this%modes, this%solver, 1, lambda, error)
    one = seconds_since(start)
    if (.not. allocated(error) .and. one > most_of_one) then
      this%failure = "one position takes more than "//to_string(most_of_one)//" s"
      return
    end if
    numbers = exact_states(exact, positions, speed_of(this))
    call system_clock(start)
    if (.not. allocated(error)) call solve_nodal_states(mechanism, positions%states, numbers, speed_of(this), this%modes, &
      this%solver, 1, lambda, error)
    one = seconds_since(start)/size(numbers)
    if (allocated(error)) then
      this%failure = error%text
      return
    end if
    this%timed = spread_states(this%states, int(most_seconds*this%threads/one))
  end subroutine prepare_nodal

  !> As many states as wanted, or `fewest`, spread over all of them.
  pure function spread_states(states, wanted) result(numbers)
    integer, intent(in) :: states, wanted
    integer, allocatable :: numbers(:)

    integer :: i, number

    number = min(states, max(fewest, wanted))
    numbers = [(1 + ((i - 1)*states)/number, i=1, number)]
  end function spread_states

  !> Solves all positions as the program does.
  subroutine prepare_sweep(model, this, lambda)
    type(model_t), intent(in) :: model
    type(bench_case_t), intent(inout) :: this
    real(wp), intent(inout) :: lambda(:, :)

    type(variant_run_t) :: run
    type(journal_t) :: no_journal
    type(link_store_t) :: store
    type(error_t), allocatable :: error
    integer(long) :: start
    integer :: i

    call begin_variant_run(run, model)
    call system_clock(start)
    call compute_variant(run, this%threads, no_journal, -1, store, error)
    if (this%solver == with_deformation) this%timed = spread_states(this%states, int(most_seconds*this%states/seconds_since(start)))
    if (allocated(error)) then
      this%failure = error%text
      return
    end if
    associate (sweep => run%results%found%sweep)
      this%request = sweep%request
      if (this%request%method == by_orders) then
        this%unknowns = sweep%models%continuum%layout%unknowns
        this%order = sweep%models%continuum%order
      end if
      do i = 1, this%states
        associate (result => sweep%results(i))
          if (allocated(result%outcome(1)%error)) this%failure = result%outcome(1)%error%text
          lambda(:, i) = result%lambda(:, 1)
        end associate
      end do
    end associate
  end subroutine prepare_sweep

  pure function speed_of(this) result(speed)
    type(bench_case_t), intent(in) :: this
    real(wp) :: speed

    speed = merge(bench_speed, 0.0_wp, this%moving)
  end function speed_of

  !> One more repetition. What it finds was found before; `error` is for what cannot happen then.
  subroutine time_case(base, this, error)
    type(base_t), intent(in) :: base
    type(bench_case_t), intent(inout) :: this
    type(error_t), allocatable, intent(out) :: error

    type(model_t) :: model
    real(wp) :: setup, rest

    model = model_of(base, this)
    if (is_nodal(this%solver)) then
      call time_nodal(model, this, setup, rest, error)
    else if (this%solver == with_deformation) then
      call time_each_alone(model, this, setup, rest, error)
    else
      call time_sweep(model, this, setup, rest, error)
    end if
    this%setup = [this%setup, setup]
    this%rest = [this%rest, rest]
  end subroutine time_case

  subroutine time_nodal(model, this, setup, rest, error)
    type(model_t), intent(in) :: model
    type(bench_case_t), intent(in) :: this
    real(wp), intent(out) :: setup, rest !! [s]
    type(error_t), allocatable, intent(out) :: error

    type(mechanism_t) :: mechanism
    type(positions_t) :: positions
    real(wp) :: lambda(this%modes, this%states)
    integer(long) :: start
    integer :: i

    lambda = 0.0_wp
    call system_clock(start)
    mechanism = new_mechanism(model)
    setup = seconds_since(start)
    call system_clock(start)
    positions = find_positions(mechanism%linkage, model%crank%value(this%timed))
    call solve_nodal_states(mechanism, positions%states, [(i, i=1, size(positions%states))], speed_of(this), this%modes, &
      this%solver, this%threads, lambda, error)
    rest = seconds_since(start)
  end subroutine time_nodal

  !> Deformation coordinates without neighbours: every position forgets the one before.
  subroutine time_each_alone(model, this, setup, rest, error)
    type(model_t), intent(in) :: model
    type(bench_case_t), intent(in) :: this
    real(wp), intent(out) :: setup, rest !! [s]
    type(error_t), allocatable, intent(out) :: error

    type(mechanism_t) :: mechanism
    type(positions_t) :: positions
    type(vibration_models_t) :: models
    type(position_work_t) :: work
    type(position_result_t) :: result
    type(ledger_t) :: counts
    type(link_store_t) :: store
    integer(long) :: start
    integer :: i

    call system_clock(start)
    mechanism = new_mechanism(model)
    positions = find_positions(mechanism%linkage, model%crank%value)
    rest = seconds_since(start)*(real(size(this%timed), wp)/this%states)
    call system_clock(start)
    call new_vibration_models(mechanism%structure_t, positions, by_crank_angle(positions), &
      this%request, this%request%accuracy, store, models, counts, error)
    setup = seconds_since(start)
    if (allocated(error)) return
    call system_clock(start)
    work = new_position_work(mechanism%structure_t, models, this%request)
    do i = 1, size(this%timed)
      work%continuum%tracks%length = 0
      if (allocated(work%mesh%tracks)) work%mesh%tracks%length = 0
      call solve_position(mechanism%structure_t, models, positions%states(this%timed(i)), &
        this%request, [.false.], work, result)
    end do
    rest = rest + seconds_since(start)
  end subroutine time_each_alone

  !> The program's own way: all that it computes for such a deck, of which frequencies are nearly
  !! all. What its models take is measured by making them once more.
  subroutine time_sweep(model, this, setup, rest, error)
    type(model_t), intent(in) :: model
    type(bench_case_t), intent(in) :: this
    real(wp), intent(out) :: setup, rest !! [s]
    type(error_t), allocatable, intent(out) :: error

    type(variant_run_t) :: run
    type(vibration_models_t) :: models
    type(journal_t) :: no_journal
    type(link_store_t) :: store
    type(ledger_t) :: counts
    integer(long) :: start
    real(wp) :: total

    call system_clock(start)
    call begin_variant_run(run, model)
    call compute_variant(run, this%threads, no_journal, -1, store, error)
    total = seconds_since(start)
    setup = 0.0_wp
    rest = total
    if (allocated(error)) return
    associate (positions => run%results%found%positions)
      call system_clock(start)
      call new_vibration_models(run%results%mechanism%structure_t, positions, &
        by_crank_angle(positions), this%request, this%request%accuracy, store, models, counts, error)
    end associate
    setup = min(total, seconds_since(start))
    rest = total - setup
  end subroutine time_sweep

end module bench_runs
