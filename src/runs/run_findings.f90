!> What a run reports besides its tables: failed rows and warnings about results.
module run_findings
  use byte_streams, only: get_error, get_integers, get_reals, get_string, put_error, put_integers, &
    put_reals, put_string
  use errors, only: error_t
  use kinds, only: wp
  use text, only: string_t, to_string
  use text_buffer, only: text_buffer_t
  implicit none (type, external)
  private

  public :: findings_t, failure_t, add_failure, add_warnings, add_findings, put_findings, &
    get_findings, place_in_words
  public :: at_position, at_frequencies, in_motion

  !> Stages at which rows fail: no pose at a crank angle, hence no row at any speed; no frequencies
  !! at a crank angle and speed; a motion that ended too soon.
  integer, parameter :: at_position = 1, at_frequencies = 2, in_motion = 3

  !> A position, or an instant of a motion, without a result.
  type :: failure_t
    integer :: stage = at_position           !! at_position, at_frequencies or in_motion
    real(wp) :: crank = 0.0_wp               !! [deg]
    real(wp) :: speed = 0.0_wp               !! of frequencies [rad/s]
    character(len=:), allocatable :: speed_words !! the same in the unit of results: `300 rpm`
    real(wp) :: time = 0.0_wp                !! at which a motion ended [s]
    type(error_t), allocatable :: error      !! the reason
    character(len=:), allocatable :: variant !! `L=90mm`; empty for a deck without VARY
    real(wp), allocatable :: varied(:)       !! (parameters) values, in the units of their VARY
                                             !! cards
  end type failure_t

  !> Failed rows and warnings of a variant, or of several.
  type :: findings_t
    integer :: failures = 0                    !! positions without a pose, positions × speeds
                                               !! without modes, motions that ended too soon
    type(failure_t), allocatable :: failed(:)  !! (at least failures)
    integer :: warning_count = 0
    type(string_t), allocatable :: warnings(:) !! (at least warning_count)
  end type findings_t

contains

  !> Appends a failure.
  pure subroutine add_failure(findings, failure)
    type(findings_t), intent(inout) :: findings !! to which it is appended
    type(failure_t), intent(in) :: failure      !! with its error

    type(failure_t), allocatable :: larger(:)

    if (.not. allocated(findings%failed)) allocate (findings%failed(16))
    if (findings%failures == size(findings%failed)) then
      allocate (larger(2*size(findings%failed)))
      larger(:findings%failures) = findings%failed
      call move_alloc(larger, findings%failed)
    end if
    findings%failures = findings%failures + 1
    findings%failed(findings%failures) = failure
  end subroutine add_failure

  !> Appends warnings, each preceded by the variant that it is about.
  pure subroutine add_warnings(findings, variant, warnings)
    type(findings_t), intent(inout) :: findings !! to which they are appended
    character(len=*), intent(in) :: variant     !! `L=90mm`, or empty
    type(string_t), intent(in) :: warnings(:)   !! without the variant

    type(string_t), allocatable :: larger(:)
    integer :: i

    if (.not. allocated(findings%warnings)) allocate (findings%warnings(8))
    if (findings%warning_count + size(warnings) > size(findings%warnings)) then
      allocate (larger(2*(findings%warning_count + size(warnings))))
      larger(:findings%warning_count) = findings%warnings(:findings%warning_count)
      call move_alloc(larger, findings%warnings)
    end if
    do i = 1, size(warnings)
      associate (new => findings%warnings(findings%warning_count + i))
        new = warnings(i)
        if (len(variant) > 0) new%text = variant//", "//warnings(i)%text
      end associate
    end do
    findings%warning_count = findings%warning_count + size(warnings)
  end subroutine add_warnings

  !> Appends the findings of a variant to those of the variants before.
  pure subroutine add_findings(findings, more)
    type(findings_t), intent(inout) :: findings !! to which they are appended
    type(findings_t), intent(in) :: more        !! of one variant

    integer :: i

    if (more%warning_count > 0) call add_warnings(findings, "", more%warnings(:more%warning_count))
    do i = 1, more%failures
      call add_failure(findings, more%failed(i))
    end do
  end subroutine add_findings

  !> `speed 20 rad/s, crank 45 deg`, or without the speed
  pure function place_in_words(crank, speed) result(place)
    real(wp), intent(in) :: crank                   !! [deg]
    character(len=*), intent(in), optional :: speed !! with its unit
    character(len=:), allocatable :: place

    place = "crank "//to_string(crank, 12)//" deg"
    if (present(speed)) place = "speed "//speed//", "//place
  end function place_in_words

  !> Appends findings to a buffer as bytes.
  pure subroutine put_findings(buffer, findings)
    type(text_buffer_t), intent(inout) :: buffer !! bytes, to be read by `get_findings`
    type(findings_t), intent(in) :: findings     !! of one variant

    integer :: i

    call put_integers(buffer, [findings%failures, findings%warning_count])
    do i = 1, findings%failures
      associate (failure => findings%failed(i))
        call put_integers(buffer, [failure%stage, size(failure%varied)])
        call put_reals(buffer, [failure%crank, failure%speed, failure%time, failure%varied])
        call put_error(buffer, failure%error)
        call put_string(buffer, failure%variant)
        call put_string(buffer, failure%speed_words)
      end associate
    end do
    do i = 1, findings%warning_count
      call put_string(buffer, findings%warnings(i)%text)
    end do
  end subroutine put_findings

  !> Reads what `put_findings` wrote.
  pure subroutine get_findings(bytes, at, findings)
    character(len=*), intent(in) :: bytes     !! of `put_findings`, among others
    integer, intent(inout) :: at              !! place of the first byte; on return, behind the last
    type(findings_t), intent(out) :: findings !! of one variant

    type(failure_t), allocatable :: failure
    type(string_t) :: warning
    integer :: counts(2), i

    call get_integers(bytes, at, counts)
    do i = 1, counts(1)
      allocate (failure)
      call get_failure(bytes, at, failure)
      call add_failure(findings, failure)
      deallocate (failure)
    end do
    do i = 1, counts(2)
      call get_string(bytes, at, warning%text)
      call add_warnings(findings, "", [warning])
    end do
  end subroutine get_findings

  pure subroutine get_failure(bytes, at, failure)
    character(len=*), intent(in) :: bytes
    integer, intent(inout) :: at
    type(failure_t), intent(inout) :: failure

    real(wp) :: numbers(3)
    integer :: codes(2)

    call get_integers(bytes, at, codes)
    call get_reals(bytes, at, numbers)
    failure%stage = codes(1)
    failure%crank = numbers(1)
    failure%speed = numbers(2)
    failure%time = numbers(3)
    allocate (failure%varied(codes(2)))
    call get_reals(bytes, at, failure%varied)
    call get_error(bytes, at, failure%error)
    call get_string(bytes, at, failure%variant)
    call get_string(bytes, at, failure%speed_words)
  end subroutine get_failure

end module run_findings
