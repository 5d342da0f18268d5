!> Cards written out again in one form, with the user's own words, for `echo.deck`.
module card_echo
  use cards, only: card_t
  use card_reader, only: entry_number
  use text, only: lower_case, same_word, to_string, upper_case
  use text_buffer, only: append_text, buffer_text, text_buffer_t
  implicit none (type, external)
  private

  public :: echo_line_t, echo_card, append_default

  type :: echo_line_t
    character(len=:), allocatable :: text   !! the card
    character(len=:), allocatable :: origin !! where it comes from; empty where a comment cannot stand
  end type echo_line_t

contains

  !> A card with its defaults written out.
  pure function echo_card(card) result(line)
    type(card_t), intent(in) :: card
    type(echo_line_t) :: line

    type(text_buffer_t) :: buffer
    integer :: i

    call append_text(buffer, upper_case(card%keyword%text))
    do i = 1, size(card%words)
      call append_text(buffer, " "//card%words(i)%text)
    end do
    do i = 1, size(card%entries)
      call append_text(buffer, " "//card%entries(i)%key%text//"="//card%entries(i)%value%text)
    end do
    line%text = buffer_text(buffer)
    line%origin = "line "//to_string(card%keyword%line)
    select case (lower_case(card%keyword%text))
    case ("title")
      line%origin = ""
    case ("mesh")
      if (entry_number(card, "order") == 0 .and. entry_number(card, "accuracy") == 0) call append_default(line, "order=3")
    case ("report")
      if (.not. same_word(card%words(1)%text, "shapes")) return
      if (entry_number(card, "points") == 0) call append_default(line, "points=21")
    end select
  end function echo_card

  !> Adds what a card leaves out.
  pure subroutine append_default(line, entry)
    type(echo_line_t), intent(inout) :: line
    character(len=*), intent(in) :: entry

    line%text = line%text//" "//entry
    line%origin = line%origin//"; "//entry//" is the default"
  end subroutine append_default

end module card_echo
