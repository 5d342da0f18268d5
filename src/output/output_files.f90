!> Output files that appear only when they are complete.
!!
!! A file is written under a temporary name. It is renamed only after its size on the disk has been
!! compared with the number of bytes written: nothing else reveals a full disk. Until then the file
!! of an earlier run remains untouched.
module output_files
  use errors, only: error_of_files, error_t, set_error
  use file_system, only: joined_path, remove_file, rename_file
  use kinds, only: long
  use text_buffer, only: append_text, text_buffer_t
  implicit none (type, external)
  private

  public :: output_file_t, open_output, append_output, finish_output, publish_output, &
    remove_output, discard_output

  type :: output_file_t
    character(len=:), allocatable :: path    !! final, without `.part`
    integer, private :: unit = -1
    logical, private :: is_open = .false.
    integer(long), private :: bytes = 0_long !! written so far
    logical, private :: sound = .true.       !! all writes have succeeded
    type(text_buffer_t), private :: buffer   !! text not yet written
  end type output_file_t

  character(len=*), parameter :: temporary = ".part"
  integer, parameter :: buffer_size = 65536 !! [bytes]

contains

  !> Opens a file under its temporary name. Errors: it cannot be opened.
  subroutine open_output(folder, name, file, error)
    character(len=*), intent(in) :: folder           !! existing
    character(len=*), intent(in) :: name             !! final, within the folder
    type(output_file_t), intent(out) :: file         !! ready for text
    type(error_t), allocatable, intent(out) :: error !! allocated if the file cannot be opened

    integer :: status

    file%path = joined_path(folder, name)
    open (newunit=file%unit, file=file%path//temporary, status="replace", action="write", &
      access="stream", form="unformatted", iostat=status)
    file%is_open = status == 0
    if (status /= 0) call set_error(error, error_of_files, "this file cannot be written", &
      file%path//temporary)
  end subroutine open_output

  !> Appends text as it is. A failure is reported by `finish_output`.
  subroutine append_output(file, text)
    type(output_file_t), intent(inout) :: file !! open
    character(len=*), intent(in) :: text       !! with its line ends

    call append_text(file%buffer, text)
    if (file%buffer%length > buffer_size) call write_buffer(file)
  end subroutine append_output

  subroutine write_buffer(file)
    type(output_file_t), intent(inout) :: file

    integer :: status

    if (file%buffer%length == 0) return
    write (file%unit, iostat=status) file%buffer%storage(:file%buffer%length)
    file%sound = file%sound .and. status == 0
    file%bytes = file%bytes + file%buffer%length
    file%buffer%length = 0
  end subroutine write_buffer

  !> Writes the rest of the buffer, closes the file and compares its size on the disk. Errors: not
  !! all bytes are on the disk.
  subroutine finish_output(file, error)
    type(output_file_t), intent(inout) :: file       !! open before, closed after
    type(error_t), allocatable, intent(out) :: error !! allocated if the file is incomplete

    integer :: status
    integer(long) :: size_on_disk

    call write_buffer(file)
    close (file%unit, iostat=status)
    file%is_open = .false.
    file%sound = file%sound .and. status == 0
    inquire (file=file%path//temporary, size=size_on_disk)
    if (.not. file%sound .or. size_on_disk /= file%bytes) then
      call set_error(error, error_of_files, &
        "the file could not be written completely; is the disk full?", file%path)
    end if
  end subroutine finish_output

  !> Renames a finished file to its final name and replaces an earlier one. Errors: it cannot be
  !! renamed.
  subroutine publish_output(file, error)
    type(output_file_t), intent(in) :: file          !! finished
    type(error_t), allocatable, intent(out) :: error !! allocated if the file cannot be renamed

    logical :: done

    call rename_file(file%path//temporary, file%path, done)
    if (.not. done) call set_error(error, error_of_files, "the file cannot be put in place", &
      file%path)
  end subroutine publish_output

  !> Removes a file that is no longer requested, and the temporary file that a killed run may have
  !! left.
  subroutine remove_output(folder, name)
    character(len=*), intent(in) :: folder !! of the run
    character(len=*), intent(in) :: name   !! final, within the folder

    call remove_file(joined_path(folder, name))
    call remove_file(joined_path(folder, name)//temporary)
  end subroutine remove_output

  !> Removes the temporary file; does nothing if no file was opened.
  subroutine discard_output(file)
    type(output_file_t), intent(inout) :: file !! open or finished; closed after

    integer :: status

    if (.not. allocated(file%path)) return
    if (file%is_open) close (file%unit, iostat=status)
    file%is_open = .false.
    call remove_file(file%path//temporary)
  end subroutine discard_output

end module output_files
