!> What is timed: one solver on one mesh at a number of positions, and what came of it.
module bench_cases
  use kinds, only: wp
  use text, only: string_t, word_list
  use vibration_models, only: mode_request_t
  implicit none (type, external)
  private

  public :: bench_case_t, plan_t, new_case, add_case, solver_names, per_turn, median_of, per_position, each_of, is_nodal
  public :: with_dsygv, with_dsygvx, with_band, with_deformation, with_sweep, with_accuracy
  public :: table_work_precision, table_elements, table_positions, table_modes, table_threads, table_names

  integer, parameter :: with_dsygv = 1, with_dsygvx = 2, with_band = 3, with_deformation = 4, with_sweep = 5, with_accuracy = 6
  integer, parameter :: table_work_precision = 1, table_elements = 2, table_positions = 3, table_modes = 4, table_threads = 5

  type :: bench_case_t
    integer :: table = 0, solver = 0
    logical :: moving = .false.        !! at `bench_speed`, with the axial forces of the motion
    integer :: elements(3) = 1         !! of every link
    integer :: order(3) = 3            !! of its elements; where `accuracy` is given the program replaces them
    real(wp) :: accuracy = 0.0_wp      !! that the program is to choose orders for; 0: the mesh is as given
    integer :: modes = 3
    integer :: positions = 361
    real(wp) :: step = 1.0_wp          !! between them [deg]
    integer :: threads = 1
    integer :: at = 0                  !! abscissa of its curve
    !> What was found out before timing.
    type(mode_request_t) :: request    !! how the program solves it
    integer :: unknowns = 0
    integer :: states = 0              !! different positions
    integer, allocatable :: timed(:)   !! those that are solved when it is timed: all, or some where all would take too long
    logical :: is_long = .false.       !! so that it is repeated less often
    real(wp) :: error = 0.0_wp         !! largest of the first three frequencies, relative, against exact values
    character(len=:), allocatable :: failure !! why it is not timed; empty if it is
    !> One a repetition [s].
    real(wp), allocatable :: setup(:)  !! once a run: the mechanism and the models of its links
    real(wp), allocatable :: rest(:)   !! motion, loads, matrices, modes, of the positions timed
  end type bench_case_t

  type :: plan_t
    type(bench_case_t), allocatable :: cases(:)
    integer :: count = 0
  end type plan_t

contains

  pure function solver_names() result(names)
    type(string_t), allocatable :: names(:)

    names = word_list("dsygv dsygvx band deformation sweep accuracy")
  end function solver_names

  pure function table_names() result(names)
    type(string_t), allocatable :: names(:)

    names = word_list("work_precision cost_elements cost_positions cost_modes cost_threads")
  end function table_names

  !> Whether a solver works on nodal displacements, one position like the other.
  elemental function is_nodal(solver) result(is)
    integer, intent(in) :: solver
    logical :: is

    is = any(solver == [with_dsygv, with_dsygvx, with_band])
  end function is_nodal

  pure function new_case(table, solver, moving, elements, order) result(new)
    integer, intent(in) :: table, solver
    logical, intent(in) :: moving
    integer, intent(in) :: elements(3), order(3)
    type(bench_case_t) :: new

    new%table = table
    new%solver = solver
    new%moving = moving
    new%elements = elements
    new%order = order
    new%failure = ""
  end function new_case

  pure subroutine add_case(plan, new)
    type(plan_t), intent(inout) :: plan
    type(bench_case_t), intent(in) :: new

    type(bench_case_t), allocatable :: longer(:)

    if (.not. allocated(plan%cases)) allocate (plan%cases(64))
    if (plan%count == size(plan%cases)) then
      allocate (longer(2*plan%count))
      longer(:plan%count) = plan%cases
      call move_alloc(longer, plan%cases)
    end if
    plan%count = plan%count + 1
    plan%cases(plan%count) = new
  end subroutine add_case

  !> The time of a whole run, every repetition [s]. Positions that were left out cost what the others do: only solvers that know nothing
  !! of neighbours leave some out.
  pure function per_turn(this) result(seconds)
    type(bench_case_t), intent(in) :: this
    real(wp), allocatable :: seconds(:)

    seconds = this%setup + this%rest*(real(this%states, wp)/size(this%timed))
  end function per_turn

  !> The same divided by the number of positions [s].
  pure function per_position(this) result(seconds)
    type(bench_case_t), intent(in) :: this
    real(wp), allocatable :: seconds(:)

    seconds = per_turn(this)/this%states
  end function per_position

  !> What every further position takes [s].
  pure function each_of(this) result(seconds)
    type(bench_case_t), intent(in) :: this
    real(wp), allocatable :: seconds(:)

    seconds = this%rest/size(this%timed)
  end function each_of

  !> The middle value, or the mean of the two middle ones.
  pure function median_of(values) result(median)
    real(wp), intent(in) :: values(:)
    real(wp) :: median

    integer :: i, n, below(size(values))

    ! Few values: the one with half of the others before it.
    n = size(values)
    do i = 1, n
      below(i) = count(values < values(i)) + count(abs(values(:i - 1) - values(i)) <= 0.0_wp)
    end do
    median = 0.5_wp*(values(findloc(below, (n - 1)/2, dim=1)) + values(findloc(below, n/2, dim=1)))
  end function median_of

end module bench_cases
