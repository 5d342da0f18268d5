!> Which cases are timed for which table.
module bench_plans
  use bench_cases, only: add_case, bench_case_t, is_nodal, new_case, plan_t, table_elements, table_modes, table_positions, &
    table_threads, table_work_precision, with_accuracy, with_band, with_deformation, with_dsygv, with_dsygvx, with_sweep
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: plan_cases

  !> Of the tables in which the program chooses the orders, and the nodal solvers get the same ones.
  real(wp), parameter :: common_accuracy = 1.0e-8_wp

contains

  !> All cases; in a short run a few of each kind, at a few positions.
  pure function plan_cases(processors, short) result(plan)
    integer, intent(in) :: processors
    logical, intent(in) :: short
    type(plan_t) :: plan

    integer :: i

    if (short) then
      call plan_work_precision(plan, [8, 16], [4, 8, 12], [2, 6, 10], 37, 10.0_wp)
      call plan_elements(plan, [1, 8, 64])
      call plan_positions(plan, [1, 37])
      call plan_modes(plan, [1, 10], 37, 10.0_wp)
      call plan_threads(plan, [1, 2], 37, 37)
    else
      call plan_work_precision(plan, [4, 8, 16, 32, 64], [(i, i=4, 16)], [(i, i=2, 13)], 361, 1.0_wp)
      call plan_elements(plan, [1, 2, 4, 8, 16, 32, 64])
      call plan_positions(plan, [1, 4, 13, 37, 121, 361, 1201, 3601])
      call plan_modes(plan, [1, 2, 3, 5, 10, 20, 50, 100], 361, 1.0_wp)
      call plan_threads(plan, [(i, i=1, processors)], 361, 3601)
    end if
  end function plan_cases

  !> Run time against error, at rest and moving: order 3 on the mesh of the thesis and finer ones, higher orders with one element a
  !! link, and accuracies 10^-d that the program is asked for.
  pure subroutine plan_work_precision(plan, elements, orders, digits, positions, step)
    type(plan_t), intent(inout) :: plan
    integer, intent(in) :: elements(:), orders(:), digits(:), positions
    real(wp), intent(in) :: step !! [deg]

    type(bench_case_t) :: this
    integer, dimension(3, 1 + size(elements) + size(orders)) :: mesh, order
    integer :: solver, load, i

    mesh(:, 1) = [1, 4, 4]
    mesh(:, 2:size(elements) + 1) = spread(elements, 1, 3)
    mesh(:, size(elements) + 2:) = 1
    order(:, :size(elements) + 1) = 3
    order(:, size(elements) + 2:) = spread(orders, 1, 3)
    do load = 1, 2
      do solver = with_dsygv, with_sweep
        do i = 1, size(mesh, 2)
          this = new_case(table_work_precision, solver, load == 2, mesh(:, i), order(:, i))
          this%positions = positions
          this%step = step
          call add_case(plan, this)
        end do
      end do
      do i = 1, size(digits)
        this = new_case(table_work_precision, with_accuracy, load == 2, [1, 1, 1], [3, 3, 3])
        this%accuracy = 10.0_wp**(-digits(i))
        this%positions = positions
        this%step = step
        call add_case(plan, this)
      end do
    end do
  end subroutine plan_work_precision

  !> Elements of order 3 on every link.
  pure subroutine plan_elements(plan, elements)
    type(plan_t), intent(inout) :: plan
    integer, intent(in) :: elements(:)

    type(bench_case_t) :: this
    integer :: solver, i

    do solver = with_dsygv, with_sweep
      do i = 1, size(elements)
        this = new_case(table_elements, solver, .true., spread(elements(i), 1, 3), [3, 3, 3])
        this%positions = 361
        call add_case(plan, this)
      end do
    end do
  end subroutine plan_elements

  !> Positions spread over a turn.
  pure subroutine plan_positions(plan, positions)
    type(plan_t), intent(inout) :: plan
    integer, intent(in) :: positions(:)

    integer :: i

    do i = 1, size(positions)
      call add_solvers(plan, table_positions, positions(i), 360.0_wp/max(1, positions(i) - 1), 3, 1)
    end do
  end subroutine plan_positions

  !> Fewer positions where each takes long.
  pure subroutine plan_modes(plan, modes, positions, step)
    type(plan_t), intent(inout) :: plan
    integer, intent(in) :: modes(:), positions
    real(wp), intent(in) :: step !! [deg]

    integer, parameter :: fewer_positions = 31
    integer :: i

    do i = 1, size(modes)
      call add_solvers(plan, table_modes, merge(positions, fewer_positions, modes(i) <= 20), step, modes(i), 1)
    end do
  end subroutine plan_modes

  !> The program's sweep needs more positions to be seen on several threads: its chunks have 64 of them.
  pure subroutine plan_threads(plan, threads, positions, many_positions)
    type(plan_t), intent(inout) :: plan
    integer, intent(in) :: threads(:), positions, many_positions

    integer :: i

    do i = 1, size(threads)
      call add_solvers(plan, table_threads, positions, 360.0_wp/(positions - 1), 3, threads(i), many_positions)
    end do
  end subroutine plan_threads

  !> The program with orders of its own choice, each position alone (on one thread), and the nodal solvers with the same orders.
  pure subroutine add_solvers(plan, table, positions, step, modes, threads, many_positions)
    type(plan_t), intent(inout) :: plan
    integer, intent(in) :: table, positions, modes, threads
    real(wp), intent(in) :: step !! [deg]
    integer, intent(in), optional :: many_positions

    integer, parameter :: solvers(5) = [with_accuracy, with_deformation, with_dsygv, with_dsygvx, with_band]
    type(bench_case_t) :: this
    integer :: i

    do i = 1, size(solvers)
      if (solvers(i) == with_deformation .and. table == table_threads) cycle
      ! The orders come with those of the program.
      this = new_case(table, solvers(i), .true., [1, 1, 1], [0, 0, 0])
      if (.not. is_nodal(solvers(i))) this%accuracy = common_accuracy
      this%positions = positions
      this%step = step
      if (present(many_positions) .and. solvers(i) == with_accuracy) then
        this%positions = many_positions
        this%step = 360.0_wp/(many_positions - 1)
      end if
      this%modes = modes
      this%threads = threads
      call add_case(plan, this)
    end do
  end subroutine add_solvers

end module bench_plans
