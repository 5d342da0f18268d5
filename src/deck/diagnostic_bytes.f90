!> Errors and warnings about a deck as bytes, for tasks that are done elsewhere.
module diagnostic_bytes
  use byte_streams, only: get_integers, get_logicals, get_string, put_integers, put_logicals, &
    put_string
  use card_bytes, only: get_token, put_token
  use diagnostics, only: append_message, diagnostic_t, diagnostics_t, message_list_t
  use text_buffer, only: text_buffer_t
  use warnings, only: get_warning, put_warning
  implicit none (type, external)
  private

  public :: put_diagnostics, get_diagnostics

contains

  !> Appends all messages to a buffer as bytes, in the order in which they were added.
  pure subroutine put_diagnostics(buffer, diagnostics)
    type(text_buffer_t), intent(inout) :: buffer   !! bytes, to be read by `get_diagnostics`
    type(diagnostics_t), intent(in) :: diagnostics !! of a deck or a variant

    call put_messages(buffer, diagnostics%errors)
    call put_messages(buffer, diagnostics%warnings)
  end subroutine put_diagnostics

  !> Reads what `put_diagnostics` wrote.
  pure subroutine get_diagnostics(bytes, at, diagnostics)
    character(len=*), intent(in) :: bytes           !! of `put_diagnostics`, among others
    integer, intent(inout) :: at                    !! place of the first byte; on return, after the
                                                    !! last
    type(diagnostics_t), intent(out) :: diagnostics !! as they were put

    call get_messages(bytes, at, diagnostics%errors)
    call get_messages(bytes, at, diagnostics%warnings)
  end subroutine get_diagnostics

  pure subroutine put_messages(buffer, messages)
    type(text_buffer_t), intent(inout) :: buffer
    type(message_list_t), intent(in) :: messages

    integer :: i

    call put_integers(buffer, [messages%total, messages%kept])
    do i = 1, messages%kept
      associate (item => messages%list(i))
        call put_string(buffer, item%message)
        call put_token(buffer, item%place)
        call put_string(buffer, item%note)
        call put_token(buffer, item%second_place)
        ! An error has no warning.
        call put_integers(buffer, [item%kind])
        call put_logicals(buffer, [allocated(item%warning%text)])
        if (allocated(item%warning%text)) call put_warning(buffer, item%warning)
      end associate
    end do
  end subroutine put_messages

  pure subroutine get_messages(bytes, at, messages)
    character(len=*), intent(in) :: bytes
    integer, intent(inout) :: at
    type(message_list_t), intent(inout) :: messages

    type(diagnostic_t), allocatable :: item
    integer :: counts(2), kind(1), i
    logical :: warns(1)

    call get_integers(bytes, at, counts)
    do i = 1, counts(2)
      allocate (item)
      call get_string(bytes, at, item%message)
      call get_token(bytes, at, item%place)
      call get_string(bytes, at, item%note)
      call get_token(bytes, at, item%second_place)
      call get_integers(bytes, at, kind)
      item%kind = kind(1)
      call get_logicals(bytes, at, warns)
      if (warns(1)) call get_warning(bytes, at, item%warning)
      call append_message(messages, item)
      deallocate (item)
    end do
    messages%total = counts(1)
  end subroutine get_messages

end module diagnostic_bytes
