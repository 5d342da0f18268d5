!> Standard output: all of a text, or the reason why not.
module standard_output
  use, intrinsic :: iso_c_binding, only: c_int, c_long, c_size_t
  use errors, only: error_of_files, error_t, set_error
  use file_system, only: system_reason
  use kinds, only: wp
  use pauses, only: pause_for
  use system_calls, only: c_close, c_errno, c_write, interrupted_call, no_reader, not_open, &
    try_again
  implicit none (type, external)
  private

  public :: print_text, end_of_output

  integer(c_int), parameter :: descriptor = 1_c_int

  !> When to write again, and when there is nobody who reads.
  integer(c_int), parameter :: once_more(*) = [interrupted_call, try_again], nobody(*) = &
    [no_reader, not_open]

contains

  !> Writes a text. A reader who has gone is no error. Errors: not all of it was taken.
  subroutine print_text(text, error)
    character(len=*), intent(in) :: text               !! with its line ends
    type(error_t), allocatable, intent(inout) :: error !! as it was if there is none

    integer(c_long) :: written
    integer :: at

    at = 1
    do while (at <= len(text))
      written = c_write(descriptor, text(at:), int(len(text) - at + 1, c_size_t))
      if (written >= 0_c_long) then
        at = at + int(written)
      else if (any(c_errno() == once_more)) then
        call pause_for(1.0e-3_wp)
      else
        call refuse(error)
        return
      end if
    end do
  end subroutine print_text

  !> Closes standard output: some systems say only then that a disk is full. Errors: as for
  !! `print_text`.
  subroutine end_of_output(error)
    type(error_t), allocatable, intent(inout) :: error !! as it was if there is none

    if (c_close(descriptor) /= 0_c_int) call refuse(error)
  end subroutine end_of_output

  subroutine refuse(error)
    type(error_t), allocatable, intent(inout) :: error

    if (any(c_errno() == nobody)) return
    call set_error(error, error_of_files, "standard output cannot be written: "//system_reason())
  end subroutine refuse

end module standard_output
