!> Converts values to bytes and back without loss, for data kept from a run and data passed between
!! tasks.
module byte_streams
  use errors, only: error_t, set_error
  use kinds, only: wp
  use text_buffer, only: append_text, text_buffer_t
  implicit none (type, external)
  private

  public :: put_integers, put_logicals, put_reals, put_string, put_error
  public :: get_integers, get_logicals, get_reals, get_string, get_error

  integer, parameter :: real_bytes = storage_size(1.0_wp)/8, integer_bytes = storage_size(1)/8

contains

  !> Appends integers to a buffer.
  pure subroutine put_integers(buffer, values)
    type(text_buffer_t), intent(inout) :: buffer !! bytes so far
    integer, intent(in) :: values(:)             !! appended in their order

    character(len=:), allocatable :: bytes

    allocate (character(len=integer_bytes*size(values)) :: bytes)
    bytes = transfer(values, bytes)
    call append_text(buffer, bytes)
  end subroutine put_integers

  !> Appends logical values to a buffer, as integers 0 and 1.
  pure subroutine put_logicals(buffer, values)
    type(text_buffer_t), intent(inout) :: buffer !! bytes so far
    logical, intent(in) :: values(:)             !! appended in their order

    call put_integers(buffer, merge(1, 0, values))
  end subroutine put_logicals

  !> Appends real numbers to a buffer.
  pure subroutine put_reals(buffer, values)
    type(text_buffer_t), intent(inout) :: buffer !! bytes so far
    real(wp), intent(in) :: values(:)            !! appended in their order

    character(len=:), allocatable :: bytes

    allocate (character(len=real_bytes*size(values)) :: bytes)
    bytes = transfer(values, bytes)
    call append_text(buffer, bytes)
  end subroutine put_reals

  !> Appends a text and, before it, its length to a buffer.
  pure subroutine put_string(buffer, text)
    type(text_buffer_t), intent(inout) :: buffer !! bytes so far
    character(len=*), intent(in) :: text         !! of any length

    call put_integers(buffer, [len(text)])
    call append_text(buffer, text)
  end subroutine put_string

  !> Appends kind, text and link of an error to a buffer, or that there is none. Its place in a file
  !! is not kept.
  pure subroutine put_error(buffer, error)
    type(text_buffer_t), intent(inout) :: buffer     !! bytes so far
    type(error_t), allocatable, intent(in) :: error  !! may be unallocated: no error

    call put_logicals(buffer, [allocated(error)])
    if (.not. allocated(error)) return
    call put_integers(buffer, [error%kind, error%place%body, error%place%other])
    call put_reals(buffer, [error%missing])
    call put_string(buffer, error%text)
  end subroutine put_error

  !> Reads integers; `at` moves past them.
  pure subroutine get_integers(bytes, at, values)
    character(len=*), intent(in) :: bytes !! as filled by the put_… procedures
    integer, intent(inout) :: at          !! place of the next byte, from 1
    integer, intent(out) :: values(:)     !! as many as were written

    values = transfer(bytes(at:at + integer_bytes*size(values) - 1), values)
    at = at + integer_bytes*size(values)
  end subroutine get_integers

  !> Reads logical values; `at` moves past them.
  pure subroutine get_logicals(bytes, at, values)
    character(len=*), intent(in) :: bytes !! as filled by the put_… procedures
    integer, intent(inout) :: at          !! place of the next byte, from 1
    logical, intent(out) :: values(:)     !! as many as were written

    integer :: numbers(size(values))

    call get_integers(bytes, at, numbers)
    values = numbers /= 0
  end subroutine get_logicals

  !> Reads real numbers; `at` moves past them.
  pure subroutine get_reals(bytes, at, values)
    character(len=*), intent(in) :: bytes !! as filled by the put_… procedures
    integer, intent(inout) :: at          !! place of the next byte, from 1
    real(wp), intent(out) :: values(:)    !! as many as were written

    values = transfer(bytes(at:at + real_bytes*size(values) - 1), values)
    at = at + real_bytes*size(values)
  end subroutine get_reals

  !> Reads a text; `at` moves past it.
  pure subroutine get_string(bytes, at, text)
    character(len=*), intent(in) :: bytes              !! as filled by the put_… procedures
    integer, intent(inout) :: at                       !! place of the next byte, from 1
    character(len=:), allocatable, intent(out) :: text !! without its length

    integer :: length(1)

    call get_integers(bytes, at, length)
    text = bytes(at:at + length(1) - 1)
    at = at + length(1)
  end subroutine get_string

  !> Reads an error, or that there is none; `at` moves past it.
  pure subroutine get_error(bytes, at, error)
    character(len=*), intent(in) :: bytes            !! as filled by the put_… procedures
    integer, intent(inout) :: at                     !! place of the next byte, from 1
    type(error_t), allocatable, intent(out) :: error !! without its place in a file

    character(len=:), allocatable :: text
    integer :: numbers(3)
    real(wp) :: missing(1)
    logical :: is_there(1)

    call get_logicals(bytes, at, is_there)
    if (.not. is_there(1)) return
    call get_integers(bytes, at, numbers)
    call get_reals(bytes, at, missing)
    call get_string(bytes, at, text)
    call set_error(error, numbers(1), text, body=numbers(2), other=numbers(3), missing=missing(1))
  end subroutine get_error

end module byte_streams
