!> The result of the whole: how many times as long each solver takes for a given error.
module bench_ratios
  use bench_cases, only: median_of, per_turn, plan_t, solver_names, table_work_precision, with_accuracy, with_dsygv, with_sweep
  use errors, only: error_t
  use kinds, only: wp
  use table_rows, only: add_failed_row, add_row, rows_t
  use tables, only: column_t, finish_table, name_cell, name_column, open_table, real_cells, real_column, table_file_t, &
    write_header, write_rows
  use text, only: string_t, to_string
  implicit none (type, external)
  private

  public :: write_ratios

  !> Errors wanted.
  real(wp), parameter :: wanted(6) = [1.0e-3_wp, 1.0e-5_wp, 1.0e-7_wp, 1.0e-9_wp, 1.0e-11_wp, 1.0e-14_wp]

contains

  !> Writes `ratios.dat`: a row a load, an error and a solver. Errors: the file could not be written.
  subroutine write_ratios(folder, notes, plan, error)
    character(len=*), intent(in) :: folder
    type(string_t), intent(in) :: notes(:) !! the machine
    type(plan_t), intent(in) :: plan
    type(error_t), allocatable, intent(out) :: error

    type(table_file_t) :: file
    type(rows_t) :: rows
    type(column_t) :: columns(5)
    type(string_t), allocatable :: solvers(:)
    real(wp) :: ours, theirs
    integer :: load, i, solver

    solvers = solver_names()
    call open_table(folder, "ratios", .false., file, error)
    if (allocated(error)) return
    columns(1) = name_column("load", [string_t("static"), string_t("axial")])
    columns(2) = name_column("solver", solvers)
    columns(3) = real_column("wanted", "-")
    columns(4) = real_column("median", "s")
    columns(5) = real_column("ratio", "-")
    call write_header(file, "first mechanism of Ulker (2010): the cheapest runs that come below an error", &
      [notes, string_t("ratio: to the cheapest run of accuracy=")], columns)
    do load = 1, 2
      do i = 1, size(wanted)
        ours = least_time(plan, with_accuracy, load == 2, wanted(i))
        do solver = with_dsygv, with_sweep
          theirs = least_time(plan, solver, load == 2, wanted(i))
          if (theirs < huge(theirs) .and. ours < huge(ours)) then
            call add_row(rows, name_cell(trim(merge("axial ", "static", load == 2)), columns(1)%width)// &
              name_cell(solvers(solver)%text, columns(2)%width)//real_cells([wanted(i), theirs, theirs/ours]))
          else
            call add_failed_row(rows, [real(wp) ::], "load="//trim(merge("axial ", "static", load == 2))//" solver="// &
              solvers(solver)%text//" wanted="//to_string(wanted(i))//": no run came below that error")
          end if
        end do
      end do
    end do
    call write_rows(file, rows)
    call finish_table(file, folder, error)
  end subroutine write_ratios

  !> Time of the cheapest run that keeps an error; huge if none does [s].
  pure function least_time(plan, solver, moving, error) result(seconds)
    type(plan_t), intent(in) :: plan
    integer, intent(in) :: solver
    logical, intent(in) :: moving
    real(wp), intent(in) :: error !! relative
    real(wp) :: seconds

    integer :: i

    seconds = huge(seconds)
    do i = 1, plan%count
      associate (this => plan%cases(i))
        if (this%table /= table_work_precision .or. this%solver /= solver .or. (this%moving .neqv. moving)) cycle
        if (len(this%failure) > 0 .or. this%error > error) cycle
        seconds = min(seconds, median_of(per_turn(this)))
      end associate
    end do
  end function least_time

end module bench_ratios
