!> The output of `flexmech --help-cards`: every card and every report, from their tables.
module card_help
  use card_table, only: card_kind_t, card_kinds
  use report_kinds, only: report_kind_t
  use report_table, only: reports
  use text, only: append_string, joined, string_t
  use text_buffer, only: append_text, buffer_text, text_buffer_t
  implicit none (type, external)
  private

  public :: card_help_text, find_card_entries

  character(len=*), parameter :: line_feed = achar(10)

contains

  !> Two lines per card: its pattern and its purpose.
  function card_help_text() result(text)
    character(len=:), allocatable :: text

    type(text_buffer_t) :: buffer
    type(string_t), allocatable :: patterns(:), helps(:)
    integer :: i

    call append_text(buffer, &
      "A deck has one card per line, in any order. Items in brackets are optional;"// &
      line_feed//"| separates alternatives; = is followed by a value."// &
      line_feed//line_feed)
    call find_card_entries(patterns, helps)
    do i = 1, size(patterns)
      call append_text(buffer, patterns(i)%text//line_feed//"    "//helps(i)%text//line_feed)
    end do
    text = buffer_text(buffer)
  end function card_help_text

  !> Every card and report: how it is written, and what it is for.
  subroutine find_card_entries(patterns, helps)
    type(string_t), allocatable, intent(out) :: patterns(:), helps(:) !! as many of either

    type(report_kind_t), allocatable :: kinds(:)
    integer :: i

    do i = 1, size(card_kinds)
      call append_string(patterns, trim(card_kinds(i)%pattern))
      call append_string(helps, help_of_card(card_kinds(i)))
    end do
    kinds = reports()
    do i = 1, size(kinds)
      call append_string(patterns, pattern_of_report(kinds(i)))
      call append_string(helps, help_of_report(kinds(i)))
    end do
    call append_string(patterns, "END")
    call append_string(helps, "nothing may follow; optional")
  end subroutine find_card_entries

  !> With the default of a missing entry or of a missing card.
  pure function help_of_card(kind) result(help)
    type(card_kind_t), intent(in) :: kind
    character(len=:), allocatable :: help

    help = trim(kind%help)
    if (len_trim(kind%entry) > 0) help = help//" (default: "//trim(kind%entry)//")"
    if (len_trim(kind%default) > 0) help = help//" (without this card: "//trim(kind%keyword)// &
      " "//trim(kind%default)//")"
  end function help_of_card

  pure function pattern_of_report(kind) result(pattern)
    type(report_kind_t), intent(in) :: kind
    character(len=:), allocatable :: pattern

    pattern = trim(kind%pattern)
    if (len(pattern) == 0) pattern = "REPORT "//trim(kind%name)
  end function pattern_of_report

  !> With the files that it writes.
  pure function help_of_report(kind) result(help)
    type(report_kind_t), intent(in) :: kind
    character(len=:), allocatable :: help

    type(string_t), allocatable :: files(:)
    integer :: i

    do i = 1, size(kind%tables)
      if (kind%tables(i)%name /= "") call append_string(files, trim(kind%tables(i)%name)//".dat")
    end do
    help = trim(kind%help)//": "//joined(files)
    if (len_trim(kind%default) > 0) help = help//" (default: "//trim(kind%default)//")"
  end function help_of_report

end module card_help
