!> Errors and warnings about a deck as bytes, for tasks that are done elsewhere.
module diagnostic_bytes
  use byte_streams, only: byte_stream_t
  use card_bytes, only: pass_token
  use diagnostics, only: append_message, diagnostic_t, diagnostics_t, message_list_t
  use warnings, only: pass_warning
  implicit none (type, external)
  private

  public :: pass_diagnostics

contains

  !> Passes all messages, in the order in which they were added.
  pure subroutine pass_diagnostics(stream, diagnostics)
    type(byte_stream_t), intent(inout) :: stream
    type(diagnostics_t), intent(inout) :: diagnostics !! new if they are read

    call pass_messages(stream, diagnostics%errors)
    call pass_messages(stream, diagnostics%warnings)
  end subroutine pass_diagnostics

  pure subroutine pass_messages(stream, messages)
    type(byte_stream_t), intent(inout) :: stream
    type(message_list_t), intent(inout) :: messages

    type(diagnostic_t), allocatable :: item
    integer :: kept, total, i

    kept = messages%kept
    total = messages%total
    call stream%pass(kept)
    call stream%pass(total)
    do i = 1, kept
      allocate (item)
      if (.not. stream%reads) item = messages%list(i)
      call stream%pass_text(item%message)
      call pass_token(stream, item%place)
      call stream%pass_text(item%note)
      call pass_token(stream, item%second_place)
      call stream%pass(item%kind)
      call pass_warning(stream, item%warning)
      if (stream%reads) call append_message(messages, item)
      deallocate (item)
    end do
    messages%total = total
  end subroutine pass_messages

end module diagnostic_bytes
