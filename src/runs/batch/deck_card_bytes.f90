!> The cards of a deck as bytes and back: what other ranks need to read any variant of it.
module deck_card_bytes
  use byte_streams, only: get_string, put_string
  use card_bytes, only: get_cards, put_cards
  use cards, only: card_t
  use deck_source, only: source_from_text, source_t
  use diagnostics, only: diagnostics_t
  use report_table, only: reports
  use settings, only: options_path
  use text, only: string_t
  use text_buffer, only: text_buffer_t
  use variants, only: deck_cards_t, read_deck_cards
  implicit none (type, external)
  private

  public :: put_deck_cards, get_deck_cards

contains

  !> Appends the cards of a deck to a buffer.
  subroutine put_deck_cards(buffer, source, deck_cards)
    type(text_buffer_t), intent(inout) :: buffer !! bytes, to be read by `get_deck_cards`
    type(source_t), intent(in) :: source         !! of the deck
    type(deck_cards_t), intent(in) :: deck_cards !! without errors

    integer :: length

    ! Lines of `--set` are appended again where the deck is read again.
    length = len(source%text)
    associate (last => source%files(size(source%files)))
      if (last%path == options_path) length = source%line_start(last%first_line) - 1
    end associate
    call put_string(buffer, source%path)
    call put_string(buffer, source%text(:length))
    call put_cards(buffer, deck_cards%written)
  end subroutine put_deck_cards

  !> Reads what `put_deck_cards` wrote.
  subroutine get_deck_cards(bytes, at, settings, source, deck_cards)
    character(len=*), intent(in) :: bytes         !! of `put_deck_cards`, among others
    integer, intent(inout) :: at                  !! place of the first byte; on return, after the
                                                  !! last
    type(string_t), intent(in) :: settings(:)     !! of the command line, the same for both
    type(source_t), intent(out) :: source         !! not for messages: it knows no files
    type(deck_cards_t), intent(out) :: deck_cards !! with the same places as the original ones

    character(len=:), allocatable :: path, text
    type(card_t), allocatable :: cards(:)
    type(diagnostics_t) :: none

    call get_string(bytes, at, path)
    call get_string(bytes, at, text)
    call get_cards(bytes, at, cards)
    source = source_from_text(path, text)
    call read_deck_cards(cards, settings, source, reports(), none, deck_cards)
  end subroutine get_deck_cards

end module deck_card_bytes
