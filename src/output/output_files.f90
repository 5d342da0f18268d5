!> Output files of a run, in a folder of its own until all are complete.
!!
!! What cannot be written shows when it is written or when the file is closed: a full disk, a limit.
module output_files
  use, intrinsic :: iso_c_binding, only: c_associated, c_char, c_int, c_null_char, c_null_ptr, &
    c_ptr, c_size_t
  use errors, only: error_of_files, error_t, set_error
  use file_system, only: remove_file, system_reason
  use system_calls, only: c_fclose, c_ferror, c_fflush, c_fopen, c_fread, c_fwrite
  use text_buffer, only: append_text, text_buffer_t
  implicit none (type, external)
  private

  public :: output_file_t, open_output, append_output, append_file, pass_on_output, is_failing, &
    finish_output, close_output

  type :: output_file_t
    type(c_ptr), private :: stream = c_null_ptr
    character(len=:), allocatable, private :: reason !! why a write has failed
    type(text_buffer_t), private :: buffer           !! text not yet written
  end type output_file_t

  integer, parameter :: buffer_size = 65536 !! [bytes]

contains

  !> Opens a file. Errors: it cannot be opened.
  subroutine open_output(path, file, error, at_end)
    character(len=*), intent(in) :: path             !! in an existing folder
    type(output_file_t), intent(out) :: file         !! ready for text
    type(error_t), allocatable, intent(out) :: error !! allocated if the file cannot be opened
    logical, intent(in), optional :: at_end          !! behind what is there; absent: in its place

    character :: mode

    mode = "w"
    if (present(at_end)) mode = merge("a", "w", at_end)
    file%stream = c_fopen(path//c_null_char, mode//c_null_char)
    if (.not. c_associated(file%stream)) call set_error(error, error_of_files, &
      "this file cannot be written: "//system_reason(), path)
  end subroutine open_output

  !> Appends text as it is. A failure is reported by `finish_output`.
  subroutine append_output(file, text)
    type(output_file_t), intent(inout) :: file !! open
    character(len=*), intent(in) :: text       !! with its line ends

    call append_text(file%buffer, text)
    if (file%buffer%length > buffer_size) call write_buffer(file)
  end subroutine append_output

  !> Appends a file to another one, and removes it. Failures are reported by `finish_output`.
  subroutine append_file(file, path)
    type(output_file_t), intent(inout) :: file !! open
    character(len=*), intent(in) :: path       !! of the other one, closed

    character(kind=c_char, len=buffer_size) :: piece
    type(c_ptr) :: stream
    integer :: length

    stream = c_fopen(path//c_null_char, "r"//c_null_char)
    if (.not. c_associated(stream)) then
      call keep_reason(file)
      return
    end if
    do
      length = int(c_fread(piece, 1_c_size_t, len(piece, c_size_t), stream))
      call append_output(file, piece(:length))
      if (length < len(piece)) exit
    end do
    if (c_ferror(stream) /= 0_c_int) call keep_reason(file)
    if (c_fclose(stream) == 0_c_int) call remove_file(path)
  end subroutine append_file

  subroutine write_buffer(file)
    type(output_file_t), intent(inout) :: file

    integer(c_size_t) :: bytes

    bytes = int(file%buffer%length, c_size_t)
    file%buffer%length = 0
    if (bytes == 0_c_size_t .or. allocated(file%reason)) return
    if (c_fwrite(file%buffer%storage(:bytes), 1_c_size_t, bytes, file%stream) /= bytes) &
      file%reason = system_reason()
  end subroutine write_buffer

  !> Passes all text to the system: a run that is killed later leaves it.
  subroutine pass_on_output(file)
    type(output_file_t), intent(inout) :: file !! open

    call write_buffer(file)
    if (allocated(file%reason)) return
    if (c_fflush(file%stream) /= 0_c_int) file%reason = system_reason()
  end subroutine pass_on_output

  !> Whether something could not be written; `finish_output` says why.
  pure function is_failing(file) result(is)
    type(output_file_t), intent(in) :: file
    logical :: is

    is = allocated(file%reason)
  end function is_failing

  !> Writes the rest of the buffer and closes the file. Errors: not all bytes were taken.
  subroutine finish_output(file, place, error)
    type(output_file_t), intent(inout) :: file       !! open before, closed after
    character(len=*), intent(in) :: place            !! final path, for a message
    type(error_t), allocatable, intent(out) :: error !! allocated if the file is incomplete

    call write_buffer(file)
    call close_output(file)
    if (allocated(file%reason)) call set_error(error, error_of_files, &
      "the file could not be written completely: "//file%reason, place)
  end subroutine finish_output

  !> Closes a file as it is; does nothing if none is open.
  subroutine close_output(file)
    type(output_file_t), intent(inout) :: file !! open, or not

    integer(c_int) :: status

    if (.not. c_associated(file%stream)) return
    status = c_fclose(file%stream)
    file%stream = c_null_ptr
    if (status /= 0_c_int) call keep_reason(file)
  end subroutine close_output

  !> The first reason counts.
  subroutine keep_reason(file)
    type(output_file_t), intent(inout) :: file

    if (.not. allocated(file%reason)) file%reason = system_reason()
  end subroutine keep_reason

end module output_files
