!> Findings of a run in words, for standard error and the log.
module findings_texts
  use run_findings, only: at_position, failure_t, findings_t, in_motion, place_in_words
  use text, only: to_string
  use text_buffer, only: append_text, buffer_text, text_buffer_t
  implicit none (type, external)
  private

  public :: findings_messages, findings_log

  !> Warnings, and failed rows, that standard error shows at most; the log lists all.
  integer, parameter :: most_shown = 20

  character(len=*), parameter :: line_feed = achar(10)

contains

  !> `speed 20 rad/s, crank 45 deg: reason`, or `motion, time 2.5 s, crank 45 deg: reason`
  pure function failure_line(failure) result(line)
    type(failure_t), intent(in) :: failure
    character(len=:), allocatable :: line

    select case (failure%stage)
    case (in_motion)
      line = "motion, time "//to_string(failure%time, 12)//" s, "//place_in_words(failure%crank)
    case (at_position)
      line = place_in_words(failure%crank)
    case default
      line = place_in_words(failure%crank, failure%speed_words)
    end select
    line = line//": "//failure%error%text//line_feed
    if (len(failure%variant) > 0) line = failure%variant//", "//line
  end function failure_line

  !> Warnings, then failed rows, for standard error. Each line begins with the deck's path.
  pure function findings_messages(findings, path) result(text)
    type(findings_t), intent(in) :: findings !! of all variants
    character(len=*), intent(in) :: path     !! of the deck
    character(len=:), allocatable :: text

    integer :: i

    text = ""
    do i = 1, min(findings%warning_count, most_shown)
      text = text//path//": warning: "//findings%warnings(i)%text//line_feed
    end do
    if (findings%warning_count > most_shown) then
      text = text//path//": "//to_string(findings%warning_count - most_shown)// &
        " more warnings; run.log lists them"//line_feed
    end if
    do i = 1, min(findings%failures, most_shown)
      text = text//path//": error: "//failure_line(findings%failed(i))
    end do
    if (findings%failures > most_shown) then
      text = text//path//": error: "//to_string(findings%failures - most_shown)// &
        " more rows failed; run.log lists them"//line_feed
    end if
  end function findings_messages

  !> Warnings, then failed rows, for the log: all of them, without the path.
  pure function findings_log(findings) result(text)
    type(findings_t), intent(in) :: findings !! of all variants
    character(len=:), allocatable :: text

    type(text_buffer_t) :: buffer
    integer :: i

    do i = 1, findings%warning_count
      call append_text(buffer, "warning: "//findings%warnings(i)%text//line_feed)
    end do
    if (findings%failures > 0) call append_text(buffer, "failed rows: "// &
      to_string(findings%failures)//line_feed)
    do i = 1, findings%failures
      call append_text(buffer, failure_line(findings%failed(i)))
    end do
    text = buffer_text(buffer)
  end function findings_log

end module findings_texts
