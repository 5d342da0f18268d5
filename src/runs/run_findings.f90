!> What a run reports besides its tables: failed rows and warnings about results.
module run_findings
  use byte_streams, only: get_error, get_integers, get_logicals, get_reals, get_string, put_error, &
    put_integers, put_logicals, put_reals, put_string
  use errors, only: error_t
  use kinds, only: long, wp
  use text, only: append_string, string_t
  use text_buffer, only: text_buffer_t
  use warnings, only: counted_text, get_warning, join_warning, put_warning, warning_t
  implicit none (type, external)
  private

  public :: findings_t, failure_t, add_failure, add_warning_of_run, add_findings, put_findings, &
    get_findings, warnings_of_grade, untold_failures, most_failures

  !> A position, a speed, an instant or a variant without a result.
  type :: failure_t
    character(len=12) :: stage = "position"  !! `position`: no pose, hence no row at any speed;
                                             !! `forces`; `variant`: nothing; or a study
    integer :: position = 0                  !! number of a position in the deck's list; 0: of none
    real(wp), allocatable :: crank           !! [deg], of a slider or a ram [m]
    real(wp), allocatable :: speed           !! of the first drive [rad/s] or [m/s]
    real(wp), allocatable :: time            !! at which a motion ended, or of an instant [s]
    character(len=:), allocatable :: crank_words !! in the unit of results: `45 deg`; with a crank
    character(len=:), allocatable :: speed_words !! likewise: `speed 300 rpm`; with a speed
    type(error_t), allocatable :: error      !! the reason
    character(len=:), allocatable :: variant !! `L=90mm`; empty for a deck without VARY
    real(wp), allocatable :: varied(:)       !! (parameters) values, in the units of their VARY
                                             !! cards
  end type failure_t

  !> Most failures that are kept with their places and reasons: those of a study may be as many as
  !! its rows, which are marked in the tables.
  integer, parameter :: most_failures = 1000

  !> Failed rows and warnings of a variant, or of several.
  type :: findings_t
    integer :: variants = 0                     !! that were joined; 0: of one alone
    integer(long) :: failures = 0_long          !! positions without a pose, positions × speeds
                                                !! without modes, motions that ended too soon,
                                                !! variants that failed as a whole
    integer :: kept = 0                         !! the first of them, at most `most_failures`
    type(failure_t), allocatable :: failed(:)   !! (at least kept)
    integer :: warning_count = 0
    type(warning_t), allocatable :: warnings(:) !! (at least warning_count)
  end type findings_t

contains

  !> Appends a failure; beyond `most_failures` it is only counted.
  pure subroutine add_failure(findings, failure)
    type(findings_t), intent(inout) :: findings !! to which it is appended
    type(failure_t), intent(in) :: failure      !! with its error

    type(failure_t), allocatable :: larger(:)

    findings%failures = findings%failures + 1
    if (findings%kept == most_failures) return
    if (.not. allocated(findings%failed)) allocate (findings%failed(16))
    if (findings%kept == size(findings%failed)) then
      allocate (larger(2*size(findings%failed)))
      larger(:findings%kept) = findings%failed
      call move_alloc(larger, findings%failed)
    end if
    findings%kept = findings%kept + 1
    findings%failed(findings%kept) = failure
  end subroutine add_failure

  !> Number of failures beyond those kept.
  pure function untold_failures(findings) result(count)
    type(findings_t), intent(in) :: findings !! of a variant, or of all
    integer(long) :: count

    count = findings%failures - findings%kept
  end function untold_failures

  !> Appends a warning.
  pure subroutine add_warning_of_run(findings, warning)
    type(findings_t), intent(inout) :: findings !! to which it is appended
    type(warning_t), intent(in) :: warning      !! with its text and variant

    type(warning_t), allocatable :: larger(:)

    if (.not. allocated(findings%warnings)) allocate (findings%warnings(8))
    if (findings%warning_count == size(findings%warnings)) then
      allocate (larger(2*size(findings%warnings)))
      larger(:findings%warning_count) = findings%warnings
      call move_alloc(larger, findings%warnings)
    end if
    findings%warning_count = findings%warning_count + 1
    findings%warnings(findings%warning_count) = warning
  end subroutine add_warning_of_run

  !> Appends the findings of a variant to those of the variants before. Where something varies,
  !! warnings of the same kind and grade are joined.
  pure subroutine add_findings(findings, more)
    type(findings_t), intent(inout) :: findings !! to which they are appended
    type(findings_t), intent(in) :: more        !! of one variant

    integer :: i, known
    logical :: is_new

    do i = 1, more%warning_count
      known = 0
      if (len(more%warnings(i)%variant) > 0) known = same_warning(findings, more%warnings(i))
      if (known == 0) then
        call add_warning_of_run(findings, more%warnings(i))
      else
        is_new = same_warning(more, more%warnings(i)) == i
        call join_warning(findings%warnings(known), more%warnings(i), is_new)
      end if
    end do
    do i = 1, more%kept
      call add_failure(findings, more%failed(i))
    end do
    findings%failures = findings%failures + untold_failures(more)
    findings%variants = findings%variants + 1
  end subroutine add_findings

  !> Number of the first warning of the same kind and grade; 0 if there is none.
  pure function same_warning(findings, warning) result(number)
    type(findings_t), intent(in) :: findings
    type(warning_t), intent(in) :: warning
    integer :: number

    do number = 1, findings%warning_count
      associate (known => findings%warnings(number))
        if (known%study == warning%study .and. known%kind == warning%kind .and. &
          known%grade == warning%grade) return
      end associate
    end do
    number = 0
  end function same_warning

  !> The warnings of a grade, each with the number of variants that have it.
  pure function warnings_of_grade(findings, grade) result(list)
    type(findings_t), intent(in) :: findings !! of all variants
    integer, intent(in) :: grade             !! one of the grades of `warnings`
    type(string_t), allocatable :: list(:)   !! a line each

    integer :: i

    allocate (list(0))
    do i = 1, findings%warning_count
      if (findings%warnings(i)%grade == grade) call append_string(list, &
        counted_text(findings%warnings(i), findings%variants))
    end do
  end function warnings_of_grade

  !> Appends findings to a buffer as bytes.
  pure subroutine put_findings(buffer, findings)
    type(text_buffer_t), intent(inout) :: buffer !! bytes, to be read by `get_findings`
    type(findings_t), intent(in) :: findings     !! of one variant

    integer :: i

    ! Of one variant, which has fewer failures than a whole number can say.
    call put_integers(buffer, [int(findings%failures), findings%kept, findings%warning_count])
    do i = 1, findings%kept
      associate (failure => findings%failed(i))
        call put_string(buffer, trim(failure%stage))
        call put_integers(buffer, [failure%position, size(failure%varied)])
        call put_reals(buffer, failure%varied)
        call put_error(buffer, failure%error)
        call put_string(buffer, failure%variant)
        call put_logicals(buffer, [allocated(failure%crank), allocated(failure%speed), &
          allocated(failure%time)])
        if (allocated(failure%crank)) then
          call put_reals(buffer, [failure%crank])
          call put_string(buffer, failure%crank_words)
        end if
        if (allocated(failure%speed)) then
          call put_reals(buffer, [failure%speed])
          call put_string(buffer, failure%speed_words)
        end if
        if (allocated(failure%time)) call put_reals(buffer, [failure%time])
      end associate
    end do
    do i = 1, findings%warning_count
      call put_warning(buffer, findings%warnings(i))
    end do
  end subroutine put_findings

  !> Reads what `put_findings` wrote.
  pure subroutine get_findings(bytes, at, findings)
    character(len=*), intent(in) :: bytes     !! of `put_findings`, among others
    integer, intent(inout) :: at              !! place of the first byte; on return, after the last
    type(findings_t), intent(out) :: findings !! of one variant

    type(failure_t), allocatable :: failure
    type(warning_t) :: warning
    integer :: counts(3), i

    call get_integers(bytes, at, counts)
    do i = 1, counts(2)
      allocate (failure)
      call get_failure(bytes, at, failure)
      call add_failure(findings, failure)
      deallocate (failure)
    end do
    findings%failures = counts(1)
    do i = 1, counts(3)
      call get_warning(bytes, at, warning)
      call add_warning_of_run(findings, warning)
    end do
  end subroutine get_findings

  pure subroutine get_failure(bytes, at, failure)
    character(len=*), intent(in) :: bytes
    integer, intent(inout) :: at
    type(failure_t), intent(inout) :: failure

    character(len=:), allocatable :: stage
    real(wp) :: number(1)
    integer :: codes(2)
    logical :: has(3)

    call get_string(bytes, at, stage)
    failure%stage = stage
    call get_integers(bytes, at, codes)
    failure%position = codes(1)
    allocate (failure%varied(codes(2)))
    call get_reals(bytes, at, failure%varied)
    call get_error(bytes, at, failure%error)
    call get_string(bytes, at, failure%variant)
    call get_logicals(bytes, at, has)
    if (has(1)) then
      call get_reals(bytes, at, number)
      failure%crank = number(1)
      call get_string(bytes, at, failure%crank_words)
    end if
    if (has(2)) then
      call get_reals(bytes, at, number)
      failure%speed = number(1)
      call get_string(bytes, at, failure%speed_words)
    end if
    if (has(3)) then
      call get_reals(bytes, at, number)
      failure%time = number(1)
    end if
  end subroutine get_failure

end module run_findings
