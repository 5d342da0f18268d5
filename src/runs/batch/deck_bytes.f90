!> A deck as bytes and back: what other ranks need to compute any variant of it.
module deck_bytes
  use byte_streams, only: get_integers, get_reals, get_string, put_integers, put_reals, put_string
  use card_bytes, only: get_cards, put_cards
  use cards, only: card_t
  use deck_readings, only: deck_t
  use deck_source, only: source_from_text
  use diagnostics, only: diagnostics_t
  use kinds, only: wp
  use report_table, only: reports
  use settings, only: options_path
  use text, only: string_t
  use text_buffer, only: text_buffer_t
  use variant_readings, only: read_variant
  use variants, only: read_deck_cards
  implicit none (type, external)
  private

  public :: put_deck, get_deck

contains

  !> Appends a deck to a buffer.
  subroutine put_deck(buffer, deck)
    type(text_buffer_t), intent(inout) :: buffer !! bytes, to be read by `get_deck`
    type(deck_t), intent(in) :: deck             !! without errors

    integer :: length

    ! Lines of `--set` are appended again where the deck is read again.
    length = len(deck%source%text)
    associate (last => deck%source%files(size(deck%source%files)))
      if (last%path == options_path) length = deck%source%line_start(last%first_line) - 1
    end associate
    call put_string(buffer, deck%source%path)
    call put_string(buffer, deck%source%text(:length))
    call put_cards(buffer, deck%cards%written)
    call put_integers(buffer, [deck%leading, deck%limits%threads])
    call put_reals(buffer, [deck%limits%memory%bytes])
    call put_string(buffer, deck%limits%memory%clause)
  end subroutine put_deck

  !> Reads what `put_deck` wrote. The deck has its cards and the model of the variant that leads.
  subroutine get_deck(bytes, at, settings, deck)
    character(len=*), intent(in) :: bytes      !! of `put_deck`, among others
    integer, intent(inout) :: at               !! place of the first byte; on return, after the last
    type(string_t), intent(in) :: settings(:)  !! of the command line, the same for both
    type(deck_t), intent(out) :: deck          !! not for messages: it knows no files

    character(len=:), allocatable :: path, text
    type(card_t), allocatable :: cards(:)
    type(diagnostics_t) :: none
    integer :: numbers(2)
    real(wp) :: memory(1)

    call get_string(bytes, at, path)
    call get_string(bytes, at, text)
    call get_cards(bytes, at, cards)
    deck%source = source_from_text(path, text)
    call read_deck_cards(cards, settings, deck%source, reports(), none, deck%cards)
    call get_integers(bytes, at, numbers)
    deck%leading = numbers(1)
    deck%limits%threads = numbers(2)
    call get_reals(bytes, at, memory)
    deck%limits%memory%bytes = memory(1)
    call get_string(bytes, at, deck%limits%memory%clause)
    call read_variant(deck%cards, deck%leading, cards, none, deck%model)
  end subroutine get_deck

end module deck_bytes
