!> Findings of a run in words, for standard error and the log.
module findings_texts
  use deck_source, only: source_t
  use diagnostics, only: diagnostics_t, warning_texts
  use kinds, only: wp
  use run_findings, only: failure_t, findings_t, untold_failures, warnings_of_grade
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

    if (failure%stage == "variant") then
      line = failure%variant//": "//failure%error%text
      return
    end if
    line = ""
    if (all(failure%stage /= [character(len=11) :: "position", "frequencies"])) line = ", "// &
      trim(failure%stage)
    if (allocated(failure%time)) line = line//", time "//failure%time_words
    if (allocated(failure%speed)) line = line//", "//failure%speed_words
    if (allocated(failure%crank)) line = line//", "//trim(merge("crank   ", "position", &
      is_angle(failure%crank_words)))//" "//failure%crank_words
    line = line(3:)
    line = line//": "//failure%error%text
    if (len(failure%variant) > 0) line = failure%variant//", "//line
  end function failure_text

  !> Whether a position is an angle, which is always in degrees, by its unit.
  pure function is_angle(words) result(is)
    character(len=*), intent(in) :: words !! `45 deg`, `0 to 25 deg, 6 positions`
    logical :: is

    is = index(words//",", " deg,") > 0
  end function is_angle

  !> Number of the last failure that is like one: at the next positions, for the same reason.
  pure function last_alike(findings, number) result(last)
    type(findings_t), intent(in) :: findings
    integer, intent(in) :: number
    integer :: last

    last = number
    associate (failed => findings%failed)
      do while (last < findings%kept)
        if (.not. is_alike(failed(last), failed(last + 1))) return
        last = last + 1
      end do
    end associate
  end function last_alike

  !> Whether two positions fail for the same reason: the same links are too short, by however much.
  pure function is_alike(one, other) result(is)
    type(failure_t), intent(in) :: one, other
    logical :: is

    is = one%position > 0 .and. other%position == one%position + 1 .and. &
      one%variant == other%variant .and. one%error%kind == other%error%kind
    if (.not. is) return
    if (abs(one%error%missing) > 0.0_wp) then
      is = one%error%missing*other%error%missing > 0.0_wp .and. &
        one%error%place%body == other%error%place%body .and. &
        one%error%place%other == other%error%place%other
    else
      is = one%error%text == other%error%text
    end if
  end function is_alike

  !> `crank 0 to 25 deg, 6 positions: out of reach: 'rod' is 12.5 mm too short at 0 deg`: failures
  !! that are alike, with the worst of them.
  pure function text_of_alike(findings, first, last) result(line)
    type(findings_t), intent(in) :: findings
    integer, intent(in) :: first, last
    character(len=:), allocatable :: line

    type(failure_t) :: all
    character(len=:), allocatable :: from, to
    integer :: worst, i

    if (first == last) then
      line = failure_text(findings%failed(first))
      return
    end if
    associate (failed => findings%failed)
      worst = first
      do i = first, last
        if (abs(failed(i)%error%missing) > abs(failed(worst)%error%missing)) worst = i
      end do
      from = failed(first)%crank_words
      to = failed(last)%crank_words
      all = failed(worst)
      if (abs(all%error%missing) > 0.0_wp) all%error%text = all%error%text//" at "// &
        all%crank_words
      ! One unit serves both ends.
      all%crank_words = from(:index(from, " ", back=.true.))//"to "//to//", "// &
        to_string(last - first + 1)//" positions"
    end associate
    line = failure_text(all)
  end function text_of_alike

  !> Warnings, those of meaningless results first, then failed rows, for standard error. Each line
  !! begins with the deck's path.
  pure function findings_messages(findings, path, has_log) result(text)
    type(findings_t), intent(in) :: findings !! of all variants
    character(len=*), intent(in) :: path     !! of the deck
    logical, intent(in), optional :: has_log !! whether there is a `run.log`; absent: yes
    character(len=:), allocatable :: text

    type(string_t), allocatable :: severe(:), others(:)
    integer :: i, lines, shown
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
    shown = 0
    do lines = 1, most_shown
      if (shown == findings%kept) exit
      i = last_alike(findings, shown + 1)
      text = text//path//": error: "//text_of_alike(findings, shown + 1, i)//line_feed
      shown = i
    end do
    if (findings%failures > shown) then
      if (logged .and. untold_failures(findings) > 0) listed = "; run.log lists the first "// &
        to_string(findings%kept)//", the tables mark all"
      text = text//path//": error: "//to_string(findings%failures - shown)//" more failures"// &
        listed//line_feed
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
    i = 1
    do while (i <= findings%kept)
      k = last_alike(findings, i)
      call append_text(buffer, text_of_alike(findings, i, k)//line_feed)
      i = k + 1
    end do
    if (untold_failures(findings) > 0) call append_text(buffer, "… and "// &
      to_string(untold_failures(findings))//" more: they are marked in the tables"//line_feed)
    text = buffer_text(buffer)
  end function findings_log

end module findings_texts
