!> Cards as bytes and back, with the places of their words: the form in which a deck goes to other
!! processes.
module card_bytes
  use byte_streams, only: get_integers, get_logicals, get_string, put_integers, put_logicals, &
    put_string
  use cards, only: card_t
  use text_buffer, only: text_buffer_t
  use tokens, only: token_t
  implicit none (type, external)
  private

  public :: put_cards, get_cards, put_token, get_token

contains

  !> Appends cards to a buffer.
  pure subroutine put_cards(buffer, cards)
    type(text_buffer_t), intent(inout) :: buffer !! bytes, to be read by `get_cards`
    type(card_t), intent(in) :: cards(:)         !! of a deck

    integer :: i, k

    call put_integers(buffer, [size(cards)])
    do i = 1, size(cards)
      call put_token(buffer, cards(i)%keyword)
      call put_tokens(buffer, cards(i)%words)
      call put_integers(buffer, [size(cards(i)%entries)])
      do k = 1, size(cards(i)%entries)
        associate (entry => cards(i)%entries(k))
          call put_token(buffer, entry%key)
          call put_token(buffer, entry%value)
          call put_logicals(buffer, [allocated(entry%items)])
          if (allocated(entry%items)) call put_tokens(buffer, entry%items)
        end associate
      end do
    end do
  end subroutine put_cards

  !> Reads what `put_cards` wrote.
  pure subroutine get_cards(bytes, at, cards)
    character(len=*), intent(in) :: bytes              !! of `put_cards`, among others
    integer, intent(inout) :: at                       !! place of the first byte; on return, after
                                                       !! the last
    type(card_t), allocatable, intent(out) :: cards(:) !! of the deck

    integer :: count(1), i, k
    logical :: has_items(1)

    call get_integers(bytes, at, count)
    allocate (cards(count(1)))
    do i = 1, size(cards)
      call get_token(bytes, at, cards(i)%keyword)
      call get_tokens(bytes, at, cards(i)%words)
      call get_integers(bytes, at, count)
      allocate (cards(i)%entries(count(1)))
      do k = 1, size(cards(i)%entries)
        associate (entry => cards(i)%entries(k))
          call get_token(bytes, at, entry%key)
          call get_token(bytes, at, entry%value)
          call get_logicals(bytes, at, has_items)
          if (has_items(1)) call get_tokens(bytes, at, entry%items)
        end associate
      end do
    end do
  end subroutine get_cards

  !> Appends a word with its places to a buffer.
  pure subroutine put_token(buffer, token)
    type(text_buffer_t), intent(inout) :: buffer !! bytes, to be read by `get_token`
    type(token_t), intent(in) :: token           !! without a text: as an empty one

    call put_integers(buffer, [token%line, token%column, token%set_line, token%set_column])
    if (allocated(token%text)) then
      call put_string(buffer, token%text)
    else
      call put_string(buffer, "")
    end if
  end subroutine put_token

  !> Reads what `put_token` wrote.
  pure subroutine get_token(bytes, at, token)
    character(len=*), intent(in) :: bytes !! of `put_token`, among others
    integer, intent(inout) :: at          !! place of the first byte; on return, after the last
    type(token_t), intent(out) :: token   !! with a text

    integer :: places(4)

    call get_integers(bytes, at, places)
    token%line = places(1)
    token%column = places(2)
    token%set_line = places(3)
    token%set_column = places(4)
    call get_string(bytes, at, token%text)
  end subroutine get_token

  pure subroutine put_tokens(buffer, tokens)
    type(text_buffer_t), intent(inout) :: buffer
    type(token_t), intent(in) :: tokens(:)

    integer :: i

    call put_integers(buffer, [size(tokens)])
    do i = 1, size(tokens)
      call put_token(buffer, tokens(i))
    end do
  end subroutine put_tokens

  pure subroutine get_tokens(bytes, at, tokens)
    character(len=*), intent(in) :: bytes
    integer, intent(inout) :: at
    type(token_t), allocatable, intent(out) :: tokens(:)

    integer :: count(1), i

    call get_integers(bytes, at, count)
    allocate (tokens(count(1)))
    do i = 1, size(tokens)
      call get_token(bytes, at, tokens(i))
    end do
  end subroutine get_tokens

end module card_bytes
