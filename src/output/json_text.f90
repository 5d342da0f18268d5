!> Values as JSON (RFC 8259).
module json_text
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
  use kinds, only: long, wp
  use number_text, only: real_cells
  use text, only: character_length, replacement, to_string
  use text_buffer, only: append_text, buffer_text, text_buffer_t
  implicit none (type, external)
  private

  public :: json_list_t, add_item, add_member, json_array, json_object
  public :: json_value, json_null

  !> The items of an array or the members of an object.
  type :: json_list_t
    integer, private :: count = 0          !! items or members so far
    type(text_buffer_t), private :: buffer !! their text, with separators
  end type json_list_t

  !> A string, or a number in the shortest form that reads back to the same value; null for a number
  !! that is not finite.
  interface json_value
    module procedure :: json_string
    module procedure :: json_integer
    module procedure :: json_long
    module procedure :: json_number
  end interface json_value

  character(len=*), parameter :: json_null = "null", line_feed = achar(10)

contains

  !> Appends a value to an array.
  pure subroutine add_item(list, value)
    type(json_list_t), intent(inout) :: list !! the items so far
    character(len=*), intent(in) :: value    !! in JSON

    if (list%count > 0) call append_text(list%buffer, ","//line_feed)
    call append_text(list%buffer, value)
    list%count = list%count + 1
  end subroutine add_item

  !> Appends a name and its value to an object.
  pure subroutine add_member(list, name, value)
    type(json_list_t), intent(inout) :: list !! the members so far
    character(len=*), intent(in) :: name     !! as plain text
    character(len=*), intent(in) :: value    !! in JSON

    if (list%count > 0) call append_text(list%buffer, ", ")
    call append_text(list%buffer, json_string(name)//": "//value)
    list%count = list%count + 1
  end subroutine add_member

  !> The items in brackets, one per line.
  pure function json_array(list) result(value)
    type(json_list_t), intent(in) :: list !! of items
    character(len=:), allocatable :: value

    value = "["//line_feed//buffer_text(list%buffer)//line_feed//"]"
    if (list%count == 0) value = "[]"
  end function json_array

  !> The members in braces, on one line.
  pure function json_object(list) result(value)
    type(json_list_t), intent(in) :: list !! of members
    character(len=:), allocatable :: value

    value = "{"//buffer_text(list%buffer)//"}"
  end function json_object

  pure function json_integer(number) result(value)
    integer, intent(in) :: number
    character(len=:), allocatable :: value

    value = to_string(number)
  end function json_integer

  pure function json_long(number) result(value)
    integer(long), intent(in) :: number
    character(len=:), allocatable :: value

    value = to_string(number)
  end function json_long

  !> `null` if not finite.
  pure function json_number(number) result(value)
    real(wp), intent(in) :: number
    character(len=:), allocatable :: value

    value = json_null
    if (ieee_is_finite(number)) value = trim(adjustl(real_cells([number])))
  end function json_number

  !> Text in quotes. UTF-8 is kept, bytes that are not UTF-8 become U+FFFD, control characters are
  !! escaped.
  pure function json_string(text) result(value)
    character(len=*), intent(in) :: text
    character(len=:), allocatable :: value

    type(text_buffer_t) :: buffer
    character(len=4) :: code
    integer :: i, length

    call append_text(buffer, '"')
    i = 1
    do while (i <= len(text))
      length = character_length(text(i:))
      if (length == 0) then
        call append_text(buffer, replacement)
        length = 1
      else if (scan(text(i:i), '"\') == 1) then
        call append_text(buffer, "\"//text(i:i))
      else if (iachar(text(i:i)) < 32 .or. iachar(text(i:i)) == 127) then
        write (code, "(z4.4)") iachar(text(i:i))
        call append_text(buffer, "\u"//code)
      else
        call append_text(buffer, text(i:i + length - 1))
      end if
      i = i + length
    end do
    call append_text(buffer, '"')
    value = buffer_text(buffer)
  end function json_string

end module json_text
