!> Findings of a run in words, for standard error and the log.
module findings_texts
  use deck_source, only: source_t
  use diagnostics, only: diagnostics_t, warning_texts
  use run_findings, only: at_forces, at_instant, at_position, failure_t, findings_t, in_motion, &
    in_response, in_campbell, in_intervals, in_stability, in_transient, of_variant, &
    place_of_failure, untold_failures, warnings_of_grade
  use text, only: string_t, to_string
  use text_buffer, only: append_text, buffer_text, text_buffer_t
  use warnings, only: grade_doubt, grade_meaningless
  implicit none (type, external)
  private

  public :: findings_messages, findings_log, failure_text

  !> Warnings, and failed rows, that standard error shows at most; the log lists more.
  integer, parameter :: most_shown = 20

  character(len=*), parameter :: line_feed = achar(10)

contains

  !> `speed 20 rad/s, crank 45 deg: reason`, `response, speed 20 rad/s: reason` or `motion, time
  !! 2.5 s, crank 45 deg: reason`; of a variant as a whole, the reason alone
  pure function failure_text(failure) result(line)
    type(failure_t), intent(in) :: failure
    character(len=:), allocatable :: line

    select case (failure%stage)
    case (in_motion)
      line = "motion, time "//to_string(failure%time, 12)//" s, "//place_of_failure(failure)
    case (at_instant)
      line = "time "//to_string(failure%time, 12)//" s, "//place_of_failure(failure)
    case (at_position)
      line = place_of_failure(failure)
    case (at_forces)
      line = "forces, speed "//failure%speed_words//", "//place_of_failure(failure)
    case (in_response)
      line = "response, speed "//failure%speed_words
    case (in_stability)
      line = "stability, speed "//failure%speed_words
    case (in_intervals)
      line = "intervals, speeds "//failure%speed_words
    case (in_campbell)
      line = "campbell, speed "//failure%speed_words
    case (in_transient)
      line = "transient"
      if (len(failure%speed_words) > 0) line = line//", speed "//failure%speed_words
    case (of_variant)
      line = failure%variant//": "//failure%error%text
      return
    case default
      line = "speed "//failure%speed_words//", "//place_of_failure(failure)
    end select
    line = line//": "//failure%error%text
    if (len(failure%variant) > 0) line = failure%variant//", "//line
  end function failure_text

  !> Warnings, those of meaningless results first, then failed rows, for standard error. Each line
  !! begins with the deck's path.
  pure function findings_messages(findings, path, has_log) result(text)
    type(findings_t), intent(in) :: findings !! of all variants
    character(len=*), intent(in) :: path     !! of the deck
    logical, intent(in), optional :: has_log !! whether there is a `run.log`; absent: yes
    character(len=:), allocatable :: text

    type(string_t), allocatable :: severe(:), others(:)
    integer :: i
    character(len=:), allocatable :: listed
    logical :: logged

    text = ""
    logged = .true.
    if (present(has_log)) logged = has_log
    listed = ""
    if (logged) listed = "; run.log lists them"
    severe = warnings_of_grade(findings, grade_meaningless)
    others = warnings_of_grade(findings, grade_doubt)
    do i = 1, size(severe)
      text = text//path//": warning: "//severe(i)%text//line_feed
    end do
    do i = 1, min(size(others), most_shown)
      text = text//path//": warning: "//others(i)%text//line_feed
    end do
    if (size(others) > most_shown) then
      text = text//path//": "//to_string(size(others) - most_shown)// &
        " more warnings"//listed//line_feed
    end if
    do i = 1, min(findings%kept, most_shown)
      text = text//path//": error: "//failure_text(findings%failed(i))//line_feed
    end do
    if (findings%failures > most_shown) then
      if (logged .and. untold_failures(findings) > 0) listed = "; run.log lists the first "// &
        to_string(findings%kept)//", the tables mark all"
      text = text//path//": error: "//to_string(findings%failures - most_shown)// &
        " more failures"//listed//line_feed
    end if
  end function findings_messages

  !> Warnings of the deck and of the run, those of meaningless results first, then failed rows as
  !! far as they are kept, for the log, without the path.
  pure function findings_log(diagnostics, source, findings) result(text)
    type(diagnostics_t), intent(in) :: diagnostics !! of the deck
    type(source_t), intent(in) :: source           !! that their places refer to
    type(findings_t), intent(in) :: findings       !! of all variants
    character(len=:), allocatable :: text

    integer, parameter :: grades(2) = [grade_meaningless, grade_doubt]
    type(text_buffer_t) :: buffer
    type(string_t), allocatable :: list(:)
    integer :: i, k

    do k = 1, size(grades)
      list = warning_texts(diagnostics, source, grades(k))
      do i = 1, size(list)
        call append_text(buffer, "warning: "//list(i)%text//line_feed)
      end do
      list = warnings_of_grade(findings, grades(k))
      do i = 1, size(list)
        call append_text(buffer, "warning: "//list(i)%text//line_feed)
      end do
    end do
    if (findings%failures > 0) call append_text(buffer, "failures: "// &
      to_string(findings%failures)//line_feed)
    do i = 1, findings%kept
      call append_text(buffer, failure_text(findings%failed(i))//line_feed)
    end do
    if (untold_failures(findings) > 0) call append_text(buffer, "… and "// &
      to_string(untold_failures(findings))//" more: they are marked in the tables"//line_feed)
    text = buffer_text(buffer)
  end function findings_log

end module findings_texts
