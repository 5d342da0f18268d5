!> A deck as bytes and back: what other ranks need to compute any variant of it.
module deck_bytes
  use byte_streams, only: byte_stream_t
  use card_bytes, only: pass_cards
  use cards, only: card_t
  use deck_readings, only: deck_t
  use deck_source, only: source_from_text
  use diagnostics, only: diagnostics_t
  use report_table, only: reports
  use settings, only: options_path
  use text, only: string_t
  use variant_readings, only: read_variant
  use variants, only: read_deck_cards
  implicit none (type, external)
  private

  public :: pass_deck

contains

  !> Passes a deck. One that is read has its cards and the model of the variant that leads; it is
  !! not for messages, for it knows no files.
  subroutine pass_deck(stream, deck, settings)
    type(byte_stream_t), intent(inout) :: stream
    type(deck_t), intent(inout) :: deck       !! without errors, or new
    type(string_t), intent(in) :: settings(:) !! of the command line, the same for both ways; needed
                                              !! to read

    character(len=:), allocatable :: path, text
    type(card_t), allocatable :: cards(:)
    type(diagnostics_t) :: none

    if (.not. stream%reads) then
      path = deck%source%path
      text = deck%source%text
      ! Lines of `--set` are appended again where the deck is read again.
      associate (last => deck%source%files(size(deck%source%files)))
        if (last%path == options_path) text = text(:deck%source%line_start(last%first_line) - 1)
      end associate
      cards = deck%cards%written
    end if
    call stream%pass_text(path)
    call stream%pass_text(text)
    call pass_cards(stream, cards)
    call stream%pass(deck%leading)
    call stream%pass(deck%limits%threads)
    call stream%pass(deck%limits%memory%bytes)
    call stream%pass_text(deck%limits%memory%clause)
    if (.not. stream%reads) return
    deck%source = source_from_text(path, text)
    call read_deck_cards(cards, settings, deck%source, reports(), none, deck%cards)
    call read_variant(deck%cards, deck%leading, cards, none, deck%model)
  end subroutine pass_deck

end module deck_bytes
