!> Small helpers for text: case, numbers as text, lists as prose, lengths in characters rather than bytes.
module text
  use kinds, only: long, wp
  implicit none (type, external)
  private

  public :: string_t, to_string, word_list, joined, plural, lower_case, upper_case, same_word
  public :: append_string, character_count, is_continuation_byte

  !> A line, a word, a name: what an array of texts of different lengths is made of.
  type :: string_t
    character(len=:), allocatable :: text
  end type string_t

  !> A number as text without blanks; a real number in the shortest of the forms that people write.
  interface to_string
    module procedure :: integer_to_string
    module procedure :: long_to_string
    module procedure :: real_to_string
  end interface to_string

contains

  !> Lengthens a list by one text. The constructor `[list, string_t(text)]` does the same, but gfortran 12 loses the memory of what
  !! function results and structure constructors leave in an array constructor.
  pure subroutine append_string(list, text)
    type(string_t), allocatable, intent(inout) :: list(:) !! not allocated is as good as empty
    character(len=*), intent(in) :: text

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

  pure function integer_to_string(value) result(string)
    integer, intent(in) :: value
    character(len=:), allocatable :: string

    string = long_to_string(int(value, long))
  end function integer_to_string

  pure function long_to_string(value) result(string)
    integer(long), intent(in) :: value
    character(len=:), allocatable :: string

    character(len=24) :: buffer

    write (buffer, "(i0)") value
    string = trim(buffer)
  end function long_to_string

  !> `value` with `digits` significant digits (six if absent), trailing zeros dropped.
  pure function real_to_string(value, digits) result(string)
    real(wp), intent(in) :: value
    integer, intent(in), optional :: digits
    character(len=:), allocatable :: string

    character(len=48) :: buffer
    character(len=16) :: form
    integer :: significant, decimals, power

    significant = 6
    if (present(digits)) significant = digits
    if (abs(value) <= 0.0_wp) then
      string = "0"
      return
    else if (.not. abs(value) <= huge(value)) then
      string = "not a number"
      return
    end if
    write (form, "(a,i0,a)") "(es40.", significant - 1, "e3)"
    write (buffer, form) value
    power = exponent_of(buffer)
    if (power >= -4 .and. power < max(significant, 6)) then
      decimals = max(significant - 1 - power, 0)
      write (form, "(a,i0,a)") "(f0.", decimals, ")"
      write (buffer, form) value
      string = without_trailing_zeros(with_leading_zero(trim(buffer)))
    else
      buffer = adjustl(buffer)
      string = without_trailing_zeros(buffer(:index(buffer, "E") - 1))//"e"//to_string(exponent_of(buffer))
    end if
  end function real_to_string

  !> The decimal exponent in a number written as `1.5E-007`.
  pure function exponent_of(buffer) result(power)
    character(len=*), intent(in) :: buffer
    integer :: power

    read (buffer(index(buffer, "E") + 1:), *) power
  end function exponent_of

  !> `-.5` as `-0.5`: compilers leave the zero out under `f0`.
  pure function with_leading_zero(number) result(string)
    character(len=*), intent(in) :: number
    character(len=:), allocatable :: string

    integer :: point

    point = index(number, ".")
    string = number
    if (point == 1) string = "0"//number
    if (point == 2 .and. number(1:1) == "-") string = "-0"//number(2:)
  end function with_leading_zero

  pure function without_trailing_zeros(number) result(string)
    character(len=*), intent(in) :: number
    character(len=:), allocatable :: string

    integer :: last

    string = number
    if (index(number, ".") == 0) return
    last = verify(number, "0", back=.true.)
    if (number(last:last) == ".") last = last - 1
    string = number(:last)
  end function without_trailing_zeros

  pure function lower_case(string) result(lower)
    character(len=*), intent(in) :: string
    character(len=len(string)) :: lower

    integer :: i

    do i = 1, len(string)
      lower(i:i) = string(i:i)
      if (lge(string(i:i), "A") .and. lle(string(i:i), "Z")) lower(i:i) = achar(iachar(string(i:i)) + 32)
    end do
  end function lower_case

  pure function upper_case(string) result(upper)
    character(len=*), intent(in) :: string
    character(len=len(string)) :: upper

    integer :: i

    do i = 1, len(string)
      upper(i:i) = string(i:i)
      if (lge(string(i:i), "a") .and. lle(string(i:i), "z")) upper(i:i) = achar(iachar(string(i:i)) - 32)
    end do
  end function upper_case

  !> Whether two words are the same but for the case of their letters.
  elemental function same_word(a, b) result(same)
    character(len=*), intent(in) :: a, b
    logical :: same

    same = len(a) == len(b)
    if (same) same = lower_case(a) == lower_case(b)
  end function same_word

  !> `1 mode`, `3 modes`.
  pure function plural(count, noun) result(phrase)
    integer, intent(in) :: count
    character(len=*), intent(in) :: noun
    character(len=:), allocatable :: phrase

    phrase = to_string(count)//" "//noun
    if (count /= 1) phrase = phrase//"s"
  end function plural

  !> Number of characters in UTF-8 text.
  pure function character_count(string) result(count)
    character(len=*), intent(in) :: string
    integer :: count

    integer :: i

    count = 0
    do i = 1, len(string)
      if (.not. is_continuation_byte(string(i:i))) count = count + 1
    end do
  end function character_count

  !> Whether a byte continues a UTF-8 character that an earlier byte began.
  elemental function is_continuation_byte(byte) result(continues)
    character(len=1), intent(in) :: byte
    logical :: continues

    continues = iand(ichar(byte), 192) == 128
  end function is_continuation_byte

  !> Splits `"a b c"` into a list of texts.
  pure function word_list(words) result(list)
    character(len=*), intent(in) :: words !! separated by single blanks
    type(string_t), allocatable :: list(:)

    integer :: i, first, length

    allocate (list(merge(0, 1 + count([(words(i:i) == " ", i=1, len(words))]), len(words) == 0)))
    first = 1
    do i = 1, size(list)
      length = index(words(first:)//" ", " ") - 1
      list(i)%text = words(first:first + length - 1)
      first = first + length + 1
    end do
  end function word_list

  !> `a, b, c`, or with another separator.
  pure function joined(list, separator) result(phrase)
    type(string_t), intent(in) :: list(:)
    character(len=*), intent(in), optional :: separator
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
