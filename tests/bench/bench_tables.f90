!> Writes what was timed as tables like the program's own.
module bench_tables
  use bench_cases, only: bench_case_t, each_of, median_of, per_position, per_turn, plan_t, solver_names, table_elements, &
    table_names, table_threads, table_work_precision, with_accuracy, with_sweep
  use errors, only: error_t
  use kinds, only: wp
  use table_rows, only: add_failed_row, add_row, rows_t
  use tables, only: column_t, finish_table, integer_cell, integer_column, name_cell, name_column, open_table, &
    real_cells, real_column, table_file_t, write_header, write_rows
  use text, only: string_t, to_string
  implicit none (type, external)
  private

  public :: write_plan, write_times

  !> Of two errors that are both rounding, neither is better.
  real(wp), parameter :: all_digits = 1.0e-14_wp

contains

  !> Writes one of the tables of cases. Errors: the file could not be written.
  subroutine write_plan(folder, table, notes, plan, error)
    character(len=*), intent(in) :: folder
    integer, intent(in) :: table
    type(string_t), intent(in) :: notes(:) !! the machine
    type(plan_t), intent(in) :: plan
    type(error_t), allocatable, intent(out) :: error

    type(table_file_t) :: file
    type(rows_t) :: rows
    type(string_t), allocatable :: names(:)
    type(column_t), allocatable :: columns(:)
    integer :: i

    names = table_names()
    call open_table(folder, names(table)%text, .false., file, error)
    if (allocated(error)) return
    columns = columns_of(plan)
    call write_header(file, "first mechanism of Ulker (2010): run times", [notes, &
      string_t("median and minimum: of a whole run; setup: the part that is done once; each: every position without it; "// &
      "timed: different"), &
      string_t("positions that were solved for it, the others count alike; per_position: the run divided by its positions"), &
      string_t("error: largest of f1 to f3, relative, at the positions with exact values; "// &
      "ratio: to the sweep on the same mesh or with orders of its own"), &
      string_t("equal_error: median divided by that of the cheapest accuracy= with no larger error (0: not compared)")], columns)
    do i = 1, plan%count
      associate (this => plan%cases(i))
        if (this%table /= table) cycle
        if (len(this%failure) > 0) then
          call add_failed_row(rows, [real(wp) ::], place_of(this)//": "//this%failure)
        else
          call add_row(rows, row_of(plan, this, columns))
        end if
      end associate
    end do
    call write_rows(file, rows)
    call finish_table(file, folder, error)
  end subroutine write_plan

  pure function columns_of(plan) result(columns)
    type(plan_t), intent(in) :: plan
    type(column_t), allocatable :: columns(:)

    type(string_t) :: meshes(plan%count), orders(plan%count)
    integer :: i

    do i = 1, plan%count
      meshes(i)%text = three(plan%cases(i)%elements)
      orders(i)%text = three(plan%cases(i)%order)
    end do
    allocate (columns(21))
    columns(1) = name_column("load", [string_t("static"), string_t("axial")])
    columns(2) = name_column("solver", solver_names())
    columns(3) = name_column("family", [string_t("accuracy")])
    columns(4) = name_column("mesh", meshes)
    columns(5) = name_column("order", orders)
    columns(6) = real_column("asked", "-")
    columns(7) = integer_column("elements")
    columns(8) = integer_column("modes")
    columns(9) = integer_column("positions")
    columns(10) = integer_column("threads")
    columns(11) = integer_column("unknowns")
    columns(12) = integer_column("timed")
    columns(13) = integer_column("repetitions")
    columns(14) = real_column("median", "s")
    columns(15) = real_column("minimum", "s")
    columns(16) = real_column("setup", "s")
    columns(17) = real_column("per_position", "s")
    columns(18) = real_column("each", "s")
    columns(19) = real_column("error", "-")
    columns(20) = real_column("ratio", "-")
    columns(21) = real_column("equal_error", "-")
  end function columns_of

  function row_of(plan, this, columns) result(cells)
    type(plan_t), intent(in) :: plan
    type(bench_case_t), intent(in) :: this
    type(column_t), intent(in) :: columns(:)
    character(len=:), allocatable :: cells

    type(string_t), allocatable :: solvers(:)
    real(wp) :: turn, equal_error

    solvers = solver_names()
    turn = median_of(per_turn(this))
    equal_error = 0.0_wp
    if (this%table == table_work_precision) equal_error = turn/equally_exact(plan, this)
    cells = name_cell(trim(merge("axial ", "static", this%moving)), columns(1)%width)// &
      name_cell(solvers(this%solver)%text, columns(2)%width)//name_cell(family_of(this), columns(3)%width)// &
      name_cell(three(this%elements), columns(4)%width)//name_cell(three(this%order), columns(5)%width)// &
      real_cells([this%accuracy])//integer_cell(maxval(this%elements), "elements")//integer_cell(this%modes, "modes")// &
      integer_cell(this%positions, "positions")//integer_cell(this%threads, "threads")// &
      integer_cell(this%unknowns, "unknowns")//integer_cell(size(this%timed), "timed")// &
      integer_cell(size(this%rest), "repetitions")//real_cells([turn, minval(per_turn(this)), median_of(this%setup), &
      median_of(per_position(this)), median_of(each_of(this)), this%error, median_of(per_position(this))/reference_of(plan, this), &
      equal_error])
  end function row_of

  !> Elements of order 3, one element of a higher order a link, or orders that the program chooses.
  pure function family_of(this) result(family)
    type(bench_case_t), intent(in) :: this
    character(len=:), allocatable :: family

    if (this%accuracy > 0.0_wp) then
      family = "accuracy"
    else if (all(this%order == 3)) then
      family = "meshes"
    else
      family = "orders"
    end if
  end function family_of

  !> Time of a position by the program's own way in the same circumstances [s].
  pure function reference_of(plan, this) result(seconds)
    type(plan_t), intent(in) :: plan
    type(bench_case_t), intent(in) :: this
    real(wp) :: seconds

    integer :: i, reference

    seconds = median_of(per_position(this))
    if (this%solver == with_accuracy) return
    reference = with_accuracy
    if (any(this%table == [table_work_precision, table_elements])) reference = with_sweep
    do i = 1, plan%count
      associate (that => plan%cases(i))
        if (that%table /= this%table .or. that%solver /= reference .or. (that%moving .neqv. this%moving)) cycle
        if (len(that%failure) > 0 .or. any(that%elements /= this%elements) .or. that%modes /= this%modes) cycle
        if (reference == with_sweep .and. any(that%order /= this%order)) cycle
        if (that%threads /= this%threads) cycle
        if (that%positions /= this%positions .and. this%table /= table_threads) cycle
        seconds = median_of(per_position(that))
      end associate
    end do
  end function reference_of

  !> Time of the cheapest run of orders chosen by the program that is no less exact than this one [s].
  pure function equally_exact(plan, this) result(seconds)
    type(plan_t), intent(in) :: plan
    type(bench_case_t), intent(in) :: this
    real(wp) :: seconds

    integer :: i

    seconds = huge(seconds)
    do i = 1, plan%count
      associate (that => plan%cases(i))
        if (that%table /= this%table .or. that%solver /= with_accuracy .or. (that%moving .neqv. this%moving)) cycle
        if (len(that%failure) > 0 .or. that%error > max(this%error, all_digits)) cycle
        seconds = min(seconds, median_of(per_turn(that)))
      end associate
    end do
  end function equally_exact

  !> `axial band 128/128/128 order 3/3/3`, in the words of the columns.
  pure function place_of(this) result(place)
    type(bench_case_t), intent(in) :: this
    character(len=:), allocatable :: place

    type(string_t), allocatable :: solvers(:)

    solvers = solver_names()
    place = "load="//trim(merge("axial ", "static", this%moving))//" solver="//solvers(this%solver)%text//" mesh="// &
      three(this%elements)//" order="//three(this%order)//" modes="//to_string(this%modes)//" positions="// &
      to_string(this%positions)
  end function place_of

  !> `1/4/4`
  pure function three(numbers) result(text)
    integer, intent(in) :: numbers(3)
    character(len=:), allocatable :: text

    text = to_string(numbers(1))//"/"//to_string(numbers(2))//"/"//to_string(numbers(3))
  end function three

  !> Writes times of whole processes. Errors: the file could not be written.
  subroutine write_times(folder, name, notes, jobs, times, error)
    character(len=*), intent(in) :: folder, name
    type(string_t), intent(in) :: notes(:), jobs(:)
    real(wp), intent(in) :: times(:, :) !! (jobs, repetitions) [s]
    type(error_t), allocatable, intent(out) :: error

    type(table_file_t) :: file
    type(rows_t) :: rows
    type(column_t) :: columns(4)
    integer :: i

    call open_table(folder, name, .false., file, error)
    if (allocated(error)) return
    columns(1) = name_column("job", jobs)
    columns(2) = integer_column("repetitions")
    columns(3) = real_column("median", "s")
    columns(4) = real_column("minimum", "s")
    call write_header(file, "whole processes: started by a shell, deck read, tables written", notes, columns)
    do i = 1, size(jobs)
      call add_row(rows, name_cell(jobs(i)%text, columns(1)%width)//integer_cell(size(times, 2), "repetitions")// &
        real_cells([median_of(times(i, :)), minval(times(i, :))]))
    end do
    call write_rows(file, rows)
    call finish_table(file, folder, error)
  end subroutine write_times

end module bench_tables
