! src/base/words/ - text, numbers as text, names, bytes: nothing about decks or mechanics.
! Text to number: `read_real` in `numbers.f90`. Number to text: `to_string` here, `real_cells` in
! `number_text.f90` with all digits that are needed. Names: `find_name` in `name_index.f90`,
! `suggestion` in `spelling.f90`. Bytes: `byte_stream_t` (`byte_streams.f90`).
! Not here: words of a deck with their places (`src/deck`), cells of tables (`src/output`).

!> Small helpers for text: case, numbers as text, lists of words, lengths in characters rather than
!! bytes.
module text
  use kinds, only: long, wp
  use plain_numbers, only: digit_count, longest_real, real_length, usual_digits, write_real
  use text_buffer, only: append_text, buffer_text, text_buffer_t
  implicit none (type, external)
  private

  public :: string_t, to_string, word_list, trimmed_list, joined, plural, lower_case, upper_case, &
    same_word
  public :: append_string, has_word, is_among, character_count, character_length, &
    is_continuation_byte, in_single_quotes, visible, replacement

  !> In place of bytes that are no text: U+FFFD.
  character(len=*), parameter :: replacement = char(239)//char(191)//char(189)

  !> A line, a word or a name: an element of arrays of texts of different lengths.
  type :: string_t
    character(len=:), allocatable :: text
  end type string_t

  !> A number as text without blanks; a real number in the shortest common form.
  interface to_string
    module procedure :: integer_to_string
    module procedure :: long_to_string
    module procedure :: real_to_string
    module procedure :: rounded_to_string
  end interface to_string

contains

  !> Lengthens a list by one text. The constructor `[list, string_t(text)]` does the same, but
  !! gfortran 12 leaks the memory of function results and structure constructors inside an array
  !! constructor.
  pure subroutine append_string(list, text)
    type(string_t), allocatable, intent(inout) :: list(:) !! not allocated is treated as empty
    character(len=*), intent(in) :: text                  !! new last element

    type(string_t), allocatable :: longer(:)
    integer :: i, n

    n = 0
    if (allocated(list)) n = size(list)
    allocate (longer(n + 1))
    do i = 1, n
      call move_alloc(list(i)%text, longer(i)%text)
    end do
    longer(n + 1)%text = text
    call move_alloc(longer, list)
  end subroutine append_string

  ! Lengths are computed before the texts: gfortran 12 keeps the length of a function result of
  ! deferred length in one place for all threads, so several threads must not call such a function
  ! at the same time (failed positions are reported from inside a parallel sweep).

  pure function integer_to_string(value) result(string)
    integer, intent(in) :: value
    character(len=digit_count(int(value, long))) :: string

    write (string, "(i0)") value
  end function integer_to_string

  pure function long_to_string(value) result(string)
    integer(long), intent(in) :: value
    character(len=digit_count(value)) :: string

    write (string, "(i0)") value
  end function long_to_string

  !> `value` with six significant digits, trailing zeros dropped.
  pure function real_to_string(value) result(string)
    real(wp), intent(in) :: value
    character(len=real_length(value, usual_digits)) :: string

    character(len=longest_real) :: buffer
    integer :: length

    call write_real(value, usual_digits, buffer, length)
    string = buffer(:length)
  end function real_to_string

  !> `value` with `digits` significant digits, trailing zeros dropped.
  pure function rounded_to_string(value, digits) result(string)
    real(wp), intent(in) :: value
    integer, intent(in) :: digits
    character(len=real_length(value, digits)) :: string

    character(len=longest_real) :: buffer
    integer :: length

    call write_real(value, digits, buffer, length)
    string = buffer(:length)
  end function rounded_to_string

  !> A text with the letters A–Z replaced by a–z.
  pure function lower_case(string) result(lower)
    character(len=*), intent(in) :: string !! any text
    character(len=len(string)) :: lower

    integer :: i

    do i = 1, len(string)
      lower(i:i) = string(i:i)
      if (lge(string(i:i), "A") .and. lle(string(i:i), "Z")) lower(i:i) = &
        achar(iachar(string(i:i)) + 32)
    end do
  end function lower_case

  !> A text with the letters a–z replaced by A–Z.
  pure function upper_case(string) result(upper)
    character(len=*), intent(in) :: string !! any text
    character(len=len(string)) :: upper

    integer :: i

    do i = 1, len(string)
      upper(i:i) = string(i:i)
      if (lge(string(i:i), "a") .and. lle(string(i:i), "z")) upper(i:i) = &
        achar(iachar(string(i:i)) - 32)
    end do
  end function upper_case

  !> Whether two words are equal, ignoring case.
  elemental function same_word(a, b) result(same)
    character(len=*), intent(in) :: a, b !! without trailing blanks
    logical :: same

    same = len(a) == len(b)
    if (same) same = lower_case(a) == lower_case(b)
  end function same_word

  !> `1 mode`, `3 modes`.
  pure function plural(count, noun) result(phrase)
    integer, intent(in) :: count         !! 1 takes the singular
    character(len=*), intent(in) :: noun !! singular; its plural ends with s
    character(len=:), allocatable :: phrase

    phrase = to_string(count)//" "//noun
    if (count /= 1) phrase = phrase//"s"
  end function plural

  !> Number of characters in UTF-8 text.
  pure function character_count(string) result(count)
    character(len=*), intent(in) :: string !! UTF-8
    integer :: count

    integer :: i

    count = 0
    do i = 1, len(string)
      if (.not. is_continuation_byte(string(i:i))) count = count + 1
    end do
  end function character_count

  !> Number of bytes of the UTF-8 character at the start of a text (RFC 3629, section 4); 0 if there
  !! is no valid one.
  pure function character_length(text) result(length)
    character(len=*), intent(in) :: text !! not empty
    integer :: length

    integer :: second, least, most

    ! The first byte determines the length and the range of the second byte, which excludes overlong
    ! forms, surrogates and everything beyond U+10FFFF.
    least = 128
    most = 191
    select case (ichar(text(1:1)))
    case (:127)
      length = 1
    case (194:223)
      length = 2
    case (224:239)
      length = 3
      if (ichar(text(1:1)) == 224) least = 160
      if (ichar(text(1:1)) == 237) most = 159
    case (240:244)
      length = 4
      if (ichar(text(1:1)) == 240) least = 144
      if (ichar(text(1:1)) == 244) most = 143
    case default
      length = 0
    end select
    if (length < 2) return
    if (len(text) < length) then
      length = 0
      return
    end if
    second = ichar(text(2:2))
    if (second < least .or. second > most) length = 0
    if (length > 2) then
      if (.not. all(is_continuation_byte([text(3:3), text(length:length)]))) length = 0
    end if
  end function character_length

  !> A text for a terminal: what is no UTF-8 and every control character but line feeds and tabs is
  !! the replacement character.
  pure function visible(text) result(shown)
    character(len=*), intent(in) :: text
    character(len=:), allocatable :: shown

    type(text_buffer_t) :: buffer
    integer :: i, length
    logical :: is_control

    i = 1
    do while (i <= len(text))
      length = character_length(text(i:))
      is_control = iachar(text(i:i)) == 127 .or. iachar(text(i:i)) < 32 .and. text(i:i) /= &
        achar(10) .and. text(i:i) /= achar(9)
      ! U+0080 to U+009F.
      if (length == 2 .and. text(i:i) == char(194)) is_control = iachar(text(i + 1:i + 1)) < 160
      if (length == 0 .or. is_control) then
        call append_text(buffer, replacement)
      else
        call append_text(buffer, text(i:i + length - 1))
      end if
      i = i + max(1, length)
    end do
    shown = buffer_text(buffer)
  end function visible

  !> Whether a byte continues a UTF-8 character that began with an earlier byte.
  elemental function is_continuation_byte(byte) result(continues)
    character(len=1), intent(in) :: byte !! of UTF-8 text
    logical :: continues

    continues = iand(ichar(byte), 192) == 128
  end function is_continuation_byte

  !> A text in single quotes, with those inside as shells read them: `'it'\''s'`.
  pure function in_single_quotes(string) result(quoted)
    character(len=*), intent(in) :: string
    character(len=:), allocatable :: quoted

    integer :: i

    quoted = "'"
    do i = 1, len(string)
      if (string(i:i) == "'") then
        quoted = quoted//"'\''"
      else
        quoted = quoted//string(i:i)
      end if
    end do
    quoted = quoted//"'"
  end function in_single_quotes

  !> Whether a list has a word, in capital or small letters.
  pure function has_word(list, word) result(has)
    type(string_t), intent(in) :: list(:)
    character(len=*), intent(in) :: word
    logical :: has

    integer :: i

    has = .false.
    do i = 1, size(list)
      has = has .or. same_word(list(i)%text, word)
    end do
  end function has_word

  !> Whether a list has a text, letter by letter.
  pure function is_among(list, text) result(any_is)
    type(string_t), intent(in) :: list(:)
    character(len=*), intent(in) :: text
    logical :: any_is

    integer :: i

    any_is = .false.
    do i = 1, size(list)
      any_is = any_is .or. list(i)%text == text
    end do
  end function is_among

  !> Splits `"a b c"` into a list of texts.
  pure function word_list(words) result(list)
    character(len=*), intent(in) :: words !! separated by single blanks
    type(string_t), allocatable :: list(:)

    integer :: i, first, last

    allocate (list(merge(0, 1 + count([(words(i:i) == " ", i=1, len(words))]), len(words) == 0)))
    first = 1
    do i = 1, size(list)
      last = len(words)
      if (i < size(list)) last = first + index(words(first:), " ") - 2
      list(i)%text = words(first:last)
      first = last + 2
    end do
  end function word_list

  !> The elements of an array without their trailing blanks.
  pure function trimmed_list(words) result(list)
    character(len=*), intent(in) :: words(:) !! padded with blanks
    type(string_t), allocatable :: list(:)

    integer :: i

    allocate (list(size(words)))
    do i = 1, size(words)
      list(i)%text = trim(words(i))
    end do
  end function trimmed_list

  !> The texts of a list in one: `a, b, c`.
  pure function joined(list, separator) result(phrase)
    type(string_t), intent(in) :: list(:)               !! may be empty
    character(len=*), intent(in), optional :: separator !! absent: comma and blank
    character(len=:), allocatable :: phrase

    integer :: i

    phrase = ""
    do i = 1, size(list)
      if (i > 1 .and. present(separator)) phrase = phrase//separator
      if (i > 1 .and. .not. present(separator)) phrase = phrase//", "
      phrase = phrase//list(i)%text
    end do
  end function joined

end module text
