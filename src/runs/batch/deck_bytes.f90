!> A deck as bytes and back: what other ranks need to compute any variant of it.
module deck_bytes
  use byte_streams, only: get_integers, get_reals, get_string, put_integers, put_reals, put_string
  use cards, only: card_t
  use deck_card_bytes, only: get_deck_cards, put_deck_cards
  use deck_readings, only: deck_t
  use diagnostics, only: diagnostics_t
  use kinds, only: wp
  use text, only: string_t
  use text_buffer, only: text_buffer_t
  use variant_readings, only: read_variant
  implicit none (type, external)
  private

  public :: put_deck, get_deck

contains

  !> Appends a deck to a buffer.
  subroutine put_deck(buffer, deck)
    type(text_buffer_t), intent(inout) :: buffer !! bytes, to be read by `get_deck`
    type(deck_t), intent(in) :: deck             !! without errors

    call put_deck_cards(buffer, deck%source, deck%cards)
    associate (verdict => deck%verdict)
      call put_integers(buffer, [verdict%leading, verdict%threads, verdict%refused_count])
      if (verdict%refused_count > 0) call put_integers(buffer, &
        verdict%refused(:verdict%refused_count))
      call put_reals(buffer, [verdict%available%bytes])
      call put_string(buffer, verdict%available%clause)
    end associate
  end subroutine put_deck

  !> Reads what `put_deck` wrote. The deck has its cards and the model of the variant that leads.
  subroutine get_deck(bytes, at, settings, deck)
    character(len=*), intent(in) :: bytes      !! of `put_deck`, among others
    integer, intent(inout) :: at               !! place of the first byte; on return, after the last
    type(string_t), intent(in) :: settings(:)  !! of the command line, the same for both
    type(deck_t), intent(out) :: deck          !! not for messages: it knows no files

    type(card_t), allocatable :: cards(:)
    type(diagnostics_t) :: none
    integer :: numbers(3)
    real(wp) :: memory(1)

    call get_deck_cards(bytes, at, settings, deck%source, deck%cards)
    associate (verdict => deck%verdict)
      call get_integers(bytes, at, numbers)
      verdict%leading = numbers(1)
      verdict%threads = numbers(2)
      verdict%refused_count = numbers(3)
      allocate (verdict%refused(numbers(3)))
      if (numbers(3) > 0) call get_integers(bytes, at, verdict%refused)
      call get_reals(bytes, at, memory)
      verdict%available%bytes = memory(1)
      call get_string(bytes, at, verdict%available%clause)
      call read_variant(deck%cards, verdict%leading, cards, none, deck%model)
    end associate
  end subroutine get_deck

end module deck_bytes
