!> The output of `flexmech --help-cards`: every card and every report, from their tables.
module card_help
  use card_table, only: card_kind_t, card_kinds
  use report_kinds, only: report_kind_t
  use report_table, only: reports
  use text, only: append_string, joined, string_t
  use text_buffer, only: append_text, buffer_text, text_buffer_t
  implicit none (type, external)
  private

  public :: card_help_text

  character(len=*), parameter :: line_feed = achar(10)

contains

  !> Two lines per card: its pattern and its purpose.
  pure function card_help_text() result(text)
    character(len=:), allocatable :: text

    type(text_buffer_t) :: buffer
    integer :: i

    call append_text(buffer, &
      "A deck has one card a line, in any order. What stands in brackets may be left out;"// &
      line_feed//"| separates words of which one is written, = is followed by a value."// &
      line_feed//line_feed)
    do i = 1, size(card_kinds)
      call append_card_help(buffer, card_kinds(i))
    end do
    do i = 1, size(reports)
      call append_report(buffer, reports(i))
    end do
    call append_entry(buffer, "END", "nothing may follow; optional")
    text = buffer_text(buffer)
  end function card_help_text

  !> A card, with the default of a missing entry or of a missing card.
  pure subroutine append_card_help(buffer, kind)
    type(text_buffer_t), intent(inout) :: buffer
    type(card_kind_t), intent(in) :: kind

    character(len=:), allocatable :: help

    help = trim(kind%help)
    if (len_trim(kind%entry) > 0) help = help//" (default: "//trim(kind%entry)//")"
    if (len_trim(kind%default) > 0) help = help//" (without this card: "//trim(kind%keyword)// &
      " "//trim(kind%default)//")"
    call append_entry(buffer, trim(kind%pattern), help)
  end subroutine append_card_help

  !> A report like a card, with the files that it writes.
  pure subroutine append_report(buffer, kind)
    type(text_buffer_t), intent(inout) :: buffer
    type(report_kind_t), intent(in) :: kind

    character(len=:), allocatable :: pattern, help
    type(string_t), allocatable :: files(:)
    integer :: i

    pattern = trim(kind%pattern)
    if (len(pattern) == 0) pattern = "REPORT "//trim(kind%name)
    do i = 1, size(kind%tables)
      if (kind%tables(i)%name /= "") call append_string(files, trim(kind%tables(i)%name)//".dat")
    end do
    help = trim(kind%help)//": "//joined(files)
    if (len_trim(kind%default) > 0) help = help//" (default: "//trim(kind%default)//")"
    call append_entry(buffer, pattern, help)
  end subroutine append_report

  pure subroutine append_entry(buffer, pattern, help)
    type(text_buffer_t), intent(inout) :: buffer
    character(len=*), intent(in) :: pattern, help

    call append_text(buffer, pattern//line_feed//"    "//help//line_feed)
  end subroutine append_entry

end module card_help
