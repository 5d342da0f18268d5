!> What a run computed, and how long its stages took.
module run_statistics
  use frequency_sweep, only: sweep_t
  use kinds, only: long, wp
  use positions, only: positions_t
  use text, only: string_t, to_string
  implicit none (type, external)
  private

  public :: stopwatch_t, start_stopwatch, stop_stage, statistics_text, sweep_summary

  !> Seconds of one stage after another.
  type :: stopwatch_t
    integer(long), private :: last = 0_long
    type(string_t), allocatable, private :: stages(:)
  end type stopwatch_t

contains

  subroutine start_stopwatch(watch)
    type(stopwatch_t), intent(out) :: watch

    allocate (watch%stages(0))
    call system_clock(watch%last)
  end subroutine start_stopwatch

  !> Ends a stage and begins the next.
  subroutine stop_stage(watch, name)
    type(stopwatch_t), intent(inout) :: watch
    character(len=*), intent(in) :: name

    integer(long) :: now, rate

    call system_clock(now, rate)
    watch%stages = [watch%stages, string_t(name//" "//to_string(1000.0_wp*real(now - watch%last, wp)/real(rate, wp), 3)//" ms")]
    watch%last = now
  end subroutine stop_stage

  !> The ledger of `--stats`.
  pure function statistics_text(watch, name, positions, sweep) result(text)
    type(stopwatch_t), intent(in) :: watch
    character(len=*), intent(in) :: name !! of the deck
    type(positions_t), intent(in) :: positions
    type(sweep_t), intent(in) :: sweep
    character(len=:), allocatable :: text

    character(len=*), parameter :: line_feed = achar(10)
    integer :: i

    text = name//": rows "//to_string(size(positions%crank))//", different positions "//to_string(size(positions%states))//line_feed
    if (allocated(sweep%results)) then
      text = text//name//": stiffness and mass assembled "//to_string(count(solved(sweep)))//", geometric stiffness "// &
        to_string(sum(sweep%results%geometric_stiffnesses))//", eigenproblems "//to_string(sum(sweep%results%solutions))// &
        ", factorizations "//to_string(sum(sweep%results%factorizations))//", with vectors "// &
        to_string(count(sweep%drawn .and. spread(solved(sweep), 2, size(sweep%drawn, 2))))//line_feed
    end if
    text = text//name//":"
    do i = 1, size(watch%stages)
      text = text//" "//watch%stages(i)%text
      if (i < size(watch%stages)) text = text//","
    end do
    text = text//line_feed
  end function statistics_text

  pure function solved(sweep)
    type(sweep_t), intent(in) :: sweep
    logical :: solved(size(sweep%results))

    solved = sweep%results%solutions > 0
  end function solved

  !> How well the frequencies were checked, for the log.
  pure function sweep_summary(sweep, unknowns, half_bandwidth) result(text)
    type(sweep_t), intent(in) :: sweep
    integer, intent(in) :: unknowns, half_bandwidth
    character(len=:), allocatable :: text

    character(len=:), allocatable :: solver
    real(wp) :: uncertainty, residual, orthogonality
    integer :: i, k, rows

    uncertainty = 0.0_wp
    residual = 0.0_wp
    orthogonality = 0.0_wp
    rows = 0
    do i = 1, size(sweep%results)
      if (.not. allocated(sweep%results(i)%modes)) cycle
      do k = 1, size(sweep%results(i)%modes)
        if (len(sweep%results(i)%failure(k)%text) > 0) cycle
        rows = rows + 1
        uncertainty = max(uncertainty, sweep%results(i)%modes(k)%uncertainty)
        residual = max(residual, sweep%results(i)%modes(k)%residual)
        orthogonality = max(orthogonality, sweep%results(i)%modes(k)%orthogonality)
      end do
    end do
    solver = "shift and invert on dpbtrf (ARPACK)"
    if (sweep%request%dense) solver = "dsygvx (LAPACK)"
    text = "finite element model: "//to_string(unknowns)//" unknowns, half bandwidth "//to_string(half_bandwidth)// &
      ", solved by "//solver//achar(10)
    if (rows == 0) return
    text = text//"every eigenvalue written is confirmed by counts within "//to_string(uncertainty, 2)//" of itself"//achar(10)
    if (any(sweep%drawn)) then
      text = text//"shapes written: largest residual "//to_string(residual, 2)//", mass orthogonality within "// &
        to_string(orthogonality, 2)//achar(10)
    end if
  end function sweep_summary

end module run_statistics
