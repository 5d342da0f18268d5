!> The manual page, in the macros of man(7), from the tables of options, cards and reports.
module manual_page
  use card_help, only: find_card_entries
  use option_table, only: option_t, options
  use program_version, only: program_name, version_number
  use text, only: string_t, upper_case
  use text_buffer, only: append_text, buffer_text, text_buffer_t
  implicit none (type, external)
  private

  public :: manual_page_text

  character(len=*), parameter :: line_feed = achar(10)

contains

  !> The text of `--man`.
  function manual_page_text() result(text)
    character(len=:), allocatable :: text

    type(text_buffer_t) :: page
    type(string_t), allocatable :: patterns(:), helps(:)
    integer :: i

    call append_text(page, '.TH '//upper_case(program_name)//' 1 "" "'//program_name//" "// &
      version_number//'" "User Commands"'//line_feed)
    call append_section(page, "NAME")
    call append_line(page, program_name// &
      " - dynamics, vibration and elastic response of planar linkages")
    call append_section(page, "SYNOPSIS")
    call append_text(page, ".B "//program_name//line_feed//"[options] DECK..."//line_feed)
    call append_section(page, "DESCRIPTION")
    call append_line(page, "Computes motion, forces, balance, natural frequencies and mode "// &
      "shapes of planar linkages, rigid or flexible, from decks: text files with one card per "// &
      "line.")
    call append_paragraph(page, "For every deck the tables are written to outputs/<deck base "// &
      "name>/, with run.log, echo.deck and summary.json. A deck named - is standard input.")
    call append_section(page, "OPTIONS")
    do i = 1, size(options)
      call append_entry(page, trim(trim(options(i)%name)//" "//options(i)%value), &
        option_help(options(i)))
    end do
    call append_section(page, "CARDS")
    call append_line(page, "Items in brackets are optional; | separates alternatives; = is "// &
      "followed by a value.")
    call find_card_entries(patterns, helps)
    do i = 1, size(patterns)
      call append_entry(page, patterns(i)%text, helps(i)%text)
    end do
    call append_section(page, "EXIT STATUS")
    call append_entry(page, "0", "Done; there may be warnings.")
    call append_entry(page, "1", &
      "Some position or mode could not be computed; the rest is written.")
    call append_entry(page, "2", "A bad deck or command line; nothing is written.")
    call append_entry(page, "130", &
      "Interrupted, or stopped at its time limit; earlier results stay.")
    call append_section(page, "EXAMPLES")
    call append_entry(page, program_name//" --check my.deck", "Reads and checks a deck.")
    call append_entry(page, program_name//" --threads 4 --set L=120mm my.deck", &
      "Runs it on four threads, with another length for $L.")
    call append_section(page, "SEE ALSO")
    call append_text(page, ".BR "//program_name//"\-plot (1)"//line_feed)
    text = buffer_text(page)
  end function manual_page_text

  !> The help of an option, with the values allowed.
  pure function option_help(option) result(help)
    type(option_t), intent(in) :: option
    character(len=:), allocatable :: help

    help = trim(option%help)
    if (option%choices /= "") help = help//" ("//trim(option%value)//" is one of: "// &
      trim(option%choices)//")"
  end function option_help

  pure subroutine append_section(page, title)
    type(text_buffer_t), intent(inout) :: page
    character(len=*), intent(in) :: title

    call append_text(page, ".SH "//title//line_feed)
  end subroutine append_section

  pure subroutine append_paragraph(page, words)
    type(text_buffer_t), intent(inout) :: page
    character(len=*), intent(in) :: words

    call append_text(page, ".PP"//line_feed)
    call append_line(page, words)
  end subroutine append_paragraph

  !> A term in bold, and below it what it means.
  pure subroutine append_entry(page, term, meaning)
    type(text_buffer_t), intent(inout) :: page
    character(len=*), intent(in) :: term, meaning

    call append_text(page, ".TP"//line_feed//"\fB"//escaped(term)//"\fR"//line_feed)
    call append_line(page, meaning)
  end subroutine append_entry

  pure subroutine append_line(page, words)
    type(text_buffer_t), intent(inout) :: page
    character(len=*), intent(in) :: words

    call append_text(page, escaped(words)//line_feed)
  end subroutine append_line

  !> The words as man prints them: hyphens as they are typed, and no dot or quote that would be
  !! taken for a macro at the start of a line.
  pure function escaped(words) result(text)
    character(len=*), intent(in) :: words
    character(len=:), allocatable :: text

    integer :: i

    text = ""
    if (scan(words(:min(1, len(words))), ".'") > 0) text = "\&"
    do i = 1, len(words)
      select case (words(i:i))
      case ("-")
        text = text//"\-"
      case ("\")
        text = text//"\e"
      case default
        text = text//words(i:i)
      end select
    end do
  end function escaped

end module manual_page
