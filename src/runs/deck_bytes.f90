!> A deck as bytes and back: what other ranks need to compute any variant of it.
module deck_bytes
  use byte_streams, only: get_string, put_string
  use card_bytes, only: get_cards, put_cards
  use cards, only: card_t
  use deck_readings, only: deck_t, read_variant
  use deck_source, only: source_from_text
  use diagnostics, only: diagnostics_t
  use report_table, only: reports
  use text, only: string_t
  use text_buffer, only: text_buffer_t
  use variants, only: read_deck_cards
  implicit none (type, external)
  private

  public :: put_deck, get_deck

contains

  !> Appends a deck to a buffer.
  subroutine put_deck(buffer, deck)
    type(text_buffer_t), intent(inout) :: buffer !! bytes, to be read by `get_deck`
    type(deck_t), intent(in) :: deck             !! without errors

    call put_string(buffer, deck%source%path)
    call put_string(buffer, deck%source%text)
    call put_cards(buffer, deck%cards%written)
  end subroutine put_deck

  !> Reads what `put_deck` wrote. The deck has its cards and the model of its first variant.
  subroutine get_deck(bytes, at, settings, deck)
    character(len=*), intent(in) :: bytes      !! of `put_deck`, among others
    integer, intent(inout) :: at               !! place of the first byte; on return, after the last
    type(string_t), intent(in) :: settings(:)  !! of the command line, the same for both
    type(deck_t), intent(out) :: deck          !! not for messages: it knows no files

    character(len=:), allocatable :: path, text
    type(card_t), allocatable :: cards(:)
    type(diagnostics_t) :: none

    call get_string(bytes, at, path)
    call get_string(bytes, at, text)
    call get_cards(bytes, at, cards)
    deck%source = source_from_text(path, text)
    call read_deck_cards(cards, settings, deck%source, reports, none, deck%cards)
    call read_variant(deck%cards, 1, cards, none, deck%model)
  end subroutine get_deck

end module deck_bytes
