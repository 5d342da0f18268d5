!> What a run reports besides its tables: failed rows and warnings about results.
module run_findings
  use byte_streams, only: byte_stream_t, pass_error
  use errors, only: error_t
  use kinds, only: long, wp
  use text, only: append_string, string_t
  use warnings, only: counted_text, join_warning, pass_warning, warning_t
  implicit none (type, external)
  private

  public :: findings_t, failure_t, add_failure, add_warning_of_run, add_findings, &
    pass_findings, warnings_of_grade, untold_failures, most_failures

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
    character(len=:), allocatable :: time_words !! in the unit of the deck: `25 ms`; with a time
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

  !> Passes the findings of one variant.
  pure subroutine pass_findings(stream, findings)
    type(byte_stream_t), intent(inout) :: stream
    type(findings_t), intent(inout) :: findings !! new if they are read

    type(failure_t), allocatable :: failure
    type(warning_t), allocatable :: warning
    integer(long) :: failures
    integer :: kept, warnings, i

    failures = findings%failures
    kept = findings%kept
    warnings = findings%warning_count
    call stream%pass(failures)
    call stream%pass(kept)
    call stream%pass(warnings)
    do i = 1, kept
      allocate (failure)
      if (.not. stream%reads) failure = findings%failed(i)
      call pass_failure(stream, failure)
      if (stream%reads) call add_failure(findings, failure)
      deallocate (failure)
    end do
    findings%failures = failures
    do i = 1, warnings
      allocate (warning)
      if (.not. stream%reads) warning = findings%warnings(i)
      call pass_warning(stream, warning)
      if (stream%reads) call add_warning_of_run(findings, warning)
      deallocate (warning)
    end do
  end subroutine pass_findings

  pure subroutine pass_failure(stream, failure)
    type(byte_stream_t), intent(inout) :: stream
    type(failure_t), intent(inout) :: failure

    call stream%pass_word(failure%stage)
    call stream%pass(failure%position)
    call stream%pass_allocatable(failure%crank)
    call stream%pass_allocatable(failure%speed)
    call stream%pass_allocatable(failure%time)
    call stream%pass_text(failure%crank_words)
    call stream%pass_text(failure%speed_words)
    call stream%pass_text(failure%time_words)
    call pass_error(stream, failure%error)
    call stream%pass_text(failure%variant)
    call stream%pass_allocatable(failure%varied)
  end subroutine pass_failure

end module run_findings
