!> Texts that are not in UTF-8.
module encodings
  use text, only: character_length
  use text_buffer, only: append_text, buffer_text, text_buffer_t
  implicit none (type, external)
  private

  public :: is_utf8, utf8_of

  !> Characters 128 to 159 of Windows-1252; those that it does not have are the replacement
  !! character.
  integer, parameter :: windows_signs(128:159) = [ &
    8364, 65533, 8218, 402, 8222, 8230, 8224, 8225, 710, 8240, 352, 8249, 338, 65533, 381, 65533, &
    65533, 8216, 8217, 8220, 8221, 8226, 8211, 8212, 732, 8482, 353, 8250, 339, 65533, 382, 376]

contains

  !> Whether a text is in UTF-8.
  pure function is_utf8(text) result(is)
    character(len=*), intent(in) :: text
    logical :: is

    integer :: i, length

    i = 1
    is = .true.
    do while (i <= len(text))
      length = character_length(text(i:min(i + 3, len(text))))
      is = length > 0
      if (.not. is) return
      i = i + length
    end do
  end function is_utf8

  !> A text in UTF-8: bytes of it that are not are characters of Windows-1252, of which Latin-1 is
  !! the printable part. A file may be joined from others, and may have a byte order mark.
  pure function utf8_of(text) result(utf8)
    character(len=*), intent(in) :: text
    character(len=:), allocatable :: utf8

    type(text_buffer_t) :: buffer
    integer :: i, code, length

    i = 1
    do while (i <= len(text))
      length = character_length(text(i:min(i + 3, len(text))))
      if (length > 0) then
        call append_text(buffer, text(i:i + length - 1))
      else
        code = ichar(text(i:i))
        if (code <= ubound(windows_signs, 1)) code = windows_signs(code)
        call append_text(buffer, utf8_character(code))
      end if
      i = i + max(1, length)
    end do
    utf8 = buffer_text(buffer)
  end function utf8_of

  !> A character of two or three bytes.
  pure function utf8_character(code) result(bytes)
    integer, intent(in) :: code !! in Unicode
    character(len=:), allocatable :: bytes

    select case (code)
    case (:2047)
      bytes = char(192 + code/64)//char(128 + mod(code, 64))
    case default
      bytes = char(224 + code/4096)//char(128 + mod(code/64, 64))//char(128 + mod(code, 64))
    end select
  end function utf8_character

end module encodings
