!> Values as bytes and back without loss, for data kept from a run and data passed between tasks.
!!
!! A stream writes, or reads what another one has written. One procedure serves both ways: it passes
!! the values of a type in their order, so they cannot come back in another one.
module byte_streams
  use errors, only: error_t
  use kinds, only: long, wp
  use text_buffer, only: append_text, text_buffer_t
  implicit none (type, external)
  private

  public :: byte_stream_t, pass_error

  integer, parameter :: real_bytes = storage_size(1.0_wp)/8, integer_bytes = storage_size(1)/8

  !> A new stream writes.
  type :: byte_stream_t
    type(text_buffer_t) :: bytes        !! written so far, or to be read
    logical :: reads = .false.          !! whether values are taken from the bytes
    integer :: at = 1                   !! place of the next byte to read
  contains
    procedure :: open                   !! for bytes to be read
    procedure :: is_at_end              !! whether all bytes are read
    procedure, private :: pass_integer, pass_integers, pass_long, pass_logical, pass_logicals, &
      pass_real, pass_reals, pass_matrix
    generic :: pass => pass_integer, pass_integers, pass_long, pass_logical, pass_logicals, &
      pass_real, pass_reals, pass_matrix
    procedure, private :: pass_scalar, pass_list, pass_table, pass_layers, pass_block
    generic :: pass_allocatable => pass_scalar, pass_list, pass_table, pass_layers, pass_block
    procedure :: pass_text, pass_word, pass_bytes
    procedure :: add, add_text          !! what is written only
  end type byte_stream_t

contains

  !> Makes a stream one that reads.
  pure subroutine open(self, bytes)
    class(byte_stream_t), intent(inout) :: self !! new
    character(len=*), intent(in) :: bytes       !! of another stream

    self%reads = .true.
    self%bytes%length = 0
    self%at = 1
    call append_text(self%bytes, bytes)
  end subroutine open

  pure logical function is_at_end(self)
    class(byte_stream_t), intent(in) :: self

    is_at_end = self%at > self%bytes%length
  end function is_at_end

  !> Integers, as many as were written.
  pure subroutine pass_integers(self, values)
    class(byte_stream_t), intent(inout) :: self
    integer, intent(inout) :: values(:)

    character(len=integer_bytes*size(values)) :: bytes

    if (.not. self%reads) bytes = transfer(values, bytes)
    call self%pass_word(bytes)
    if (self%reads) values = transfer(bytes, values)
  end subroutine pass_integers

  pure subroutine pass_integer(self, value)
    class(byte_stream_t), intent(inout) :: self
    integer, intent(inout) :: value

    integer :: values(1)

    values = value
    call self%pass_integers(values)
    value = values(1)
  end subroutine pass_integer

  pure subroutine pass_long(self, value)
    class(byte_stream_t), intent(inout) :: self
    integer(long), intent(inout) :: value

    integer :: values(storage_size(value)/storage_size(1))

    values = transfer(value, values)
    call self%pass_integers(values)
    value = transfer(values, value)
  end subroutine pass_long

  !> As integers 0 and 1.
  pure subroutine pass_logicals(self, values)
    class(byte_stream_t), intent(inout) :: self
    logical, intent(inout) :: values(:)

    integer :: numbers(size(values))

    numbers = merge(1, 0, values)
    call self%pass_integers(numbers)
    values = numbers /= 0
  end subroutine pass_logicals

  pure subroutine pass_logical(self, value)
    class(byte_stream_t), intent(inout) :: self
    logical, intent(inout) :: value

    logical :: values(1)

    values = value
    call self%pass_logicals(values)
    value = values(1)
  end subroutine pass_logical

  !> Real numbers, as many as were written.
  pure subroutine pass_reals(self, values)
    class(byte_stream_t), intent(inout) :: self
    real(wp), intent(inout) :: values(:)

    character(len=:), allocatable :: bytes

    ! Not on the stack: there may be many.
    allocate (character(len=real_bytes*size(values)) :: bytes)
    if (.not. self%reads) bytes = transfer(values, bytes)
    call self%pass_word(bytes)
    if (self%reads) values = transfer(bytes, values)
  end subroutine pass_reals

  pure subroutine pass_real(self, value)
    class(byte_stream_t), intent(inout) :: self
    real(wp), intent(inout) :: value

    real(wp) :: values(1)

    values = value
    call self%pass_reals(values)
    value = values(1)
  end subroutine pass_real

  pure subroutine pass_matrix(self, values)
    class(byte_stream_t), intent(inout) :: self
    real(wp), intent(inout) :: values(:, :)

    integer :: k

    do k = 1, size(values, 2)
      call self%pass_reals(values(:, k))
    end do
  end subroutine pass_matrix

  !> A number, or that it is not allocated.
  pure subroutine pass_scalar(self, value)
    class(byte_stream_t), intent(inout) :: self
    real(wp), allocatable, intent(inout) :: value

    logical :: is_there

    is_there = allocated(value)
    call self%pass_logical(is_there)
    if (self%reads .and. allocated(value)) deallocate (value)
    if (.not. is_there) return
    if (self%reads) allocate (value)
    call self%pass_real(value)
  end subroutine pass_scalar

  !> An array with its size, or that it is not allocated.
  pure subroutine pass_list(self, values)
    class(byte_stream_t), intent(inout) :: self
    real(wp), allocatable, intent(inout) :: values(:)

    integer :: sizes(1)

    sizes = -1
    if (allocated(values)) sizes = shape(values)
    call self%pass_integers(sizes)
    if (self%reads .and. allocated(values)) deallocate (values)
    if (sizes(1) < 0) return
    if (self%reads) allocate (values(sizes(1)))
    call self%pass_reals(values)
  end subroutine pass_list

  pure subroutine pass_table(self, values)
    class(byte_stream_t), intent(inout) :: self
    real(wp), allocatable, intent(inout) :: values(:, :)

    integer :: sizes(2)

    sizes = -1
    if (allocated(values)) sizes = shape(values)
    call self%pass_integers(sizes)
    if (self%reads .and. allocated(values)) deallocate (values)
    if (sizes(1) < 0) return
    if (self%reads) allocate (values(sizes(1), sizes(2)))
    call self%pass_matrix(values)
  end subroutine pass_table

  pure subroutine pass_layers(self, values)
    class(byte_stream_t), intent(inout) :: self
    real(wp), allocatable, intent(inout) :: values(:, :, :)

    integer :: sizes(3), k

    sizes = -1
    if (allocated(values)) sizes = shape(values)
    call self%pass_integers(sizes)
    if (self%reads .and. allocated(values)) deallocate (values)
    if (sizes(1) < 0) return
    if (self%reads) allocate (values(sizes(1), sizes(2), sizes(3)))
    do k = 1, sizes(3)
      call self%pass_matrix(values(:, :, k))
    end do
  end subroutine pass_layers

  pure subroutine pass_block(self, values)
    class(byte_stream_t), intent(inout) :: self
    real(wp), allocatable, intent(inout) :: values(:, :, :, :)

    integer :: sizes(4), i, k

    sizes = -1
    if (allocated(values)) sizes = shape(values)
    call self%pass_integers(sizes)
    if (self%reads .and. allocated(values)) deallocate (values)
    if (sizes(1) < 0) return
    if (self%reads) allocate (values(sizes(1), sizes(2), sizes(3), sizes(4)))
    do k = 1, sizes(4)
      do i = 1, sizes(3)
        call self%pass_matrix(values(:, :, i, k))
      end do
    end do
  end subroutine pass_block

  !> A text with its length, or that it is not allocated.
  pure subroutine pass_text(self, text)
    class(byte_stream_t), intent(inout) :: self
    character(len=:), allocatable, intent(inout) :: text

    integer :: length

    length = -1
    if (allocated(text)) length = len(text)
    call self%pass_integer(length)
    if (self%reads .and. allocated(text)) deallocate (text)
    if (length < 0) return
    if (self%reads) allocate (character(len=length) :: text)
    call self%pass_word(text)
  end subroutine pass_text

  !> Writes an integer, for `pass`.
  pure subroutine add(self, value)
    class(byte_stream_t), intent(inout) :: self !! that writes
    integer, intent(in) :: value

    integer :: values(1)

    values = value
    call self%pass_integers(values)
  end subroutine add

  !> Writes a text, for `pass_text`.
  pure subroutine add_text(self, text)
    class(byte_stream_t), intent(inout) :: self !! that writes
    character(len=*), intent(in) :: text

    call self%add(len(text))
    call append_text(self%bytes, text)
  end subroutine add_text

  !> A text of fixed length.
  pure subroutine pass_word(self, word)
    class(byte_stream_t), intent(inout) :: self
    character(len=*), intent(inout) :: word

    if (self%reads) then
      word = self%bytes%storage(self%at:self%at + len(word) - 1)
      self%at = self%at + len(word)
    else
      call append_text(self%bytes, word)
    end if
  end subroutine pass_word

  !> The bytes of a buffer, with their number.
  pure subroutine pass_bytes(self, buffer)
    class(byte_stream_t), intent(inout) :: self
    type(text_buffer_t), intent(inout) :: buffer

    integer :: length

    length = buffer%length
    call self%pass_integer(length)
    if (self%reads) then
      buffer%length = 0
      if (length > 0) call append_text(buffer, self%bytes%storage(self%at:self%at + length - 1))
      self%at = self%at + length
    else if (length > 0) then
      call append_text(self%bytes, buffer%storage(:length))
    end if
  end subroutine pass_bytes

  !> Kind, text, link and pin of an error, or that there is none. Its place in a file is not kept.
  pure subroutine pass_error(stream, error)
    type(byte_stream_t), intent(inout) :: stream
    type(error_t), allocatable, intent(inout) :: error !! not allocated: no error

    logical :: is_there

    is_there = allocated(error)
    call stream%pass(is_there)
    if (stream%reads .and. allocated(error)) deallocate (error)
    if (.not. is_there) return
    if (stream%reads) allocate (error)
    call stream%pass(error%kind)
    call stream%pass(error%place%body)
    call stream%pass(error%place%other)
    call stream%pass(error%place%pin)
    call stream%pass(error%missing)
    call stream%pass_text(error%text)
  end subroutine pass_error

end module byte_streams
