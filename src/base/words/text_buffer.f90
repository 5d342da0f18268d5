!> Text that grows at its end without being copied for every piece.
module text_buffer
  implicit none (type, external)
  private

  public :: text_buffer_t, append_text, buffer_text

  type :: text_buffer_t
    integer :: length = 0                    !! bytes in use
    character(len=:), allocatable :: storage !! (at least `length` bytes)
  end type text_buffer_t

contains

  !> Appends a piece; the storage grows by doubling.
  pure subroutine append_text(buffer, piece)
    type(text_buffer_t), intent(inout) :: buffer !! lengthened
    character(len=*), intent(in) :: piece        !! may be empty

    character(len=:), allocatable :: larger

    if (.not. allocated(buffer%storage)) allocate (character(len=4096) :: buffer%storage)
    if (buffer%length + len(piece) > len(buffer%storage)) then
      allocate (character(len=2*(buffer%length + len(piece))) :: larger)
      larger(:buffer%length) = buffer%storage(:buffer%length)
      call move_alloc(larger, buffer%storage)
    end if
    buffer%storage(buffer%length + 1:buffer%length + len(piece)) = piece
    buffer%length = buffer%length + len(piece)
  end subroutine append_text

  !> The whole text of a buffer.
  pure function buffer_text(buffer) result(text)
    type(text_buffer_t), intent(in) :: buffer !! may be empty
    character(len=:), allocatable :: text

    text = ""
    if (allocated(buffer%storage)) text = buffer%storage(:buffer%length)
  end function buffer_text

end module text_buffer
