!> `branches.dat`: frequencies by branch.
module branch_report
  use frequency_loci, only: branches_t, event_ambiguous, event_crossing, event_start, event_veering
  use frequency_report, only: effects_notes
  use models, only: model_t
  use position_results, only: frequency_of
  use positions, only: positions_t
  use sorting, only: ascending_order
  use sweeps, only: failure_at, has_result, sweep_t
  use tables, only: append_column, column_t, integer_cell, integer_column, name_cell, real_cells, &
    real_column, table_t, write_failure, write_gap, write_header, write_row
  use text, only: append_string, string_t, to_string
  implicit none (type, external)
  private

  public :: write_branches

  integer, parameter :: event_width = 18

contains

  !> One row a position and branch; a block a speed, within it branch after branch, each along the
  !! crank angle.
  subroutine write_branches(table, model, positions, sweep, branches)
    type(table_t), intent(inout) :: table
    type(model_t), intent(in) :: model
    type(positions_t), intent(in) :: positions
    type(sweep_t), intent(in) :: sweep
    type(branches_t), intent(in) :: branches

    type(column_t), allocatable :: columns(:)
    type(column_t) :: event_column
    type(string_t), allocatable :: notes(:)
    integer :: branch, k
    logical :: first

    notes = effects_notes(model)
    call append_string(notes, &
      "modes followed by their shapes; mac: likeness to the row before, in the mass inner "// &
      "product, "//"from 0 to 1")
    call append_string(notes, &
      "event: - or start, crossing:BRANCH, veering:BRANCH, ambiguous (shapes do not tell which "// &
      "branch "//"goes on: a new one begins)")
    event_column%name = "event"
    event_column%unit = "-"
    event_column%width = event_width
    call append_column(columns, real_column("speed", "rad/s"))
    call append_column(columns, real_column("crank", "deg"))
    call append_column(columns, integer_column("branch"))
    call append_column(columns, integer_column("mode"))
    call append_column(columns, real_column("frequency", "Hz"))
    call append_column(columns, real_column("mac", "-"))
    call append_column(columns, event_column)
    call write_header(table, model%title, notes, columns)
    do k = 1, size(sweep%request%speed)
      if (k > 1) call write_gap(table, 2)
      call write_failures(table, positions, sweep, k)
      first = .true.
      do branch = 1, branches%count
        if (all(branches%branch(:, :, k) /= branch)) cycle
        if (.not. first) call write_gap(table, 1)
        first = .false.
        call write_branch(table, positions, sweep, branches, branch, k)
      end do
    end do
  end subroutine write_branches

  !> The failed rows of a speed, in the order of their crank angles.
  subroutine write_failures(table, positions, sweep, speed)
    type(table_t), intent(inout) :: table
    type(positions_t), intent(in) :: positions
    type(sweep_t), intent(in) :: sweep
    integer, intent(in) :: speed !! number

    integer :: order(size(positions%crank)), i

    order = ascending_order(positions%crank)
    do i = 1, size(order)
      if (has_result(positions, sweep, positions%state(order(i)), speed)) cycle
      call write_failure(table, [sweep%request%speed(speed), positions%crank(order(i))], &
        failure_at(positions, sweep, positions%state(order(i)), speed))
    end do
  end subroutine write_failures

  !> The rows of one branch at one speed; where it is interrupted by a failed row, so is its curve.
  subroutine write_branch(table, positions, sweep, branches, branch, speed)
    type(table_t), intent(inout) :: table
    type(positions_t), intent(in) :: positions
    type(sweep_t), intent(in) :: sweep
    type(branches_t), intent(in) :: branches
    integer, intent(in) :: branch, speed !! numbers

    integer :: order(size(positions%crank)), i, row, mode, last
    logical :: broken

    order = ascending_order(positions%crank)
    last = 0
    broken = .false.
    do i = 1, size(order)
      if (any(branches%branch(:, order(i), speed) == branch)) last = i
    end do
    do i = findloc([(any(branches%branch(:, order(row), speed) == branch), row=1, size(order))], &
      .true., dim=1), last
      row = order(i)
      if (.not. has_result(positions, sweep, positions%state(row), speed)) then
        ! One empty line breaks a curve; two would end the block.
        if (.not. broken) call write_gap(table, 1)
        broken = .true.
        cycle
      end if
      broken = .false.
      mode = findloc(branches%branch(:, row, speed), branch, dim=1)
      call write_row(table, real_cells([sweep%request%speed(speed), positions%crank(row)])// &
        integer_cell(branch, "branch")//integer_cell(mode, "mode")// &
        real_cells([frequency_of(sweep%results(positions%state(row))%lambda(mode, speed)), &
        branches%mac(mode, row, speed)])// &
        name_cell(event_name(branches%event(mode, row, speed), branches%partner(mode, row, &
        speed)), event_width))
    end do
  end subroutine write_branch

  pure function event_name(event, partner) result(name)
    integer, intent(in) :: event, partner
    character(len=:), allocatable :: name

    select case (event)
    case (event_start)
      name = "start"
    case (event_crossing)
      name = "crossing:"//to_string(partner)
    case (event_veering)
      name = "veering:"//to_string(partner)
    case (event_ambiguous)
      name = "ambiguous"
    case default
      name = "-"
    end select
  end function event_name

end module branch_report
