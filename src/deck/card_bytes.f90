!> Cards as bytes and back, with the places of their words: the form in which a deck goes to other
!! processes.
module card_bytes
  use byte_streams, only: byte_stream_t
  use cards, only: card_t
  use tokens, only: token_t
  implicit none (type, external)
  private

  public :: pass_cards, pass_token

contains

  !> Passes the cards of a deck.
  pure subroutine pass_cards(stream, cards)
    type(byte_stream_t), intent(inout) :: stream
    type(card_t), allocatable, intent(inout) :: cards(:)

    integer :: count, i

    if (.not. stream%reads) count = size(cards)
    call stream%pass(count)
    if (stream%reads) then
      if (allocated(cards)) deallocate (cards)
      allocate (cards(count))
    end if
    do i = 1, count
      call pass_token(stream, cards(i)%keyword)
      call pass_tokens(stream, cards(i)%words)
      call pass_entries(stream, cards(i))
    end do
  end subroutine pass_cards

  pure subroutine pass_entries(stream, card)
    type(byte_stream_t), intent(inout) :: stream
    type(card_t), intent(inout) :: card

    integer :: count, k

    if (.not. stream%reads) count = size(card%entries)
    call stream%pass(count)
    if (stream%reads) allocate (card%entries(count))
    do k = 1, count
      call pass_token(stream, card%entries(k)%key)
      call pass_token(stream, card%entries(k)%value)
      call pass_tokens(stream, card%entries(k)%items)
    end do
  end subroutine pass_entries

  !> Passes a word with its places; one without a text becomes empty.
  pure subroutine pass_token(stream, token)
    type(byte_stream_t), intent(inout) :: stream
    type(token_t), intent(inout) :: token

    if (.not. allocated(token%text)) token%text = ""
    call stream%pass_text(token%text)
    call stream%pass(token%line)
    call stream%pass(token%column)
    call stream%pass(token%set_line)
    call stream%pass(token%set_column)
    call stream%pass(token%is_computed)
  end subroutine pass_token

  !> Passes words, or that there is no list of them.
  pure subroutine pass_tokens(stream, tokens)
    type(byte_stream_t), intent(inout) :: stream
    type(token_t), allocatable, intent(inout) :: tokens(:)

    integer :: count, i

    count = -1
    if (allocated(tokens)) count = size(tokens)
    call stream%pass(count)
    if (stream%reads .and. count >= 0) allocate (tokens(count))
    do i = 1, count
      call pass_token(stream, tokens(i))
    end do
  end subroutine pass_tokens

end module card_bytes
