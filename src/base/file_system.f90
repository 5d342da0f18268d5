!> The few operating system calls that Fortran lacks.
module file_system
  use, intrinsic :: iso_c_binding, only: c_associated, c_char, c_int, c_null_char, c_ptr
  use text, only: string_t
  implicit none (type, external)
  private

  public :: is_directory, file_exists, make_directories, rename_file, remove_file, &
    remove_empty_directory
  public :: base_name, file_name, joined_path, real_path, standard_error_is_terminal

  interface
    function c_opendir(path) bind(c, name="opendir") result(directory)
      import :: c_char, c_ptr
      character(kind=c_char), intent(in) :: path(*)
      type(c_ptr) :: directory
    end function c_opendir

    function c_closedir(directory) bind(c, name="closedir") result(status)
      import :: c_int, c_ptr
      type(c_ptr), value :: directory
      integer(c_int) :: status
    end function c_closedir

    !> `mode_t` is an unsigned integer of 16 or 32 bits wherever it exists; passed by value, both
    !! arrive as `int`.
    function c_mkdir(path, mode) bind(c, name="mkdir") result(status)
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int), value :: mode
      integer(c_int) :: status
    end function c_mkdir

    function c_rename(from, to) bind(c, name="rename") result(status)
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: from(*), to(*)
      integer(c_int) :: status
    end function c_rename

    function c_unlink(path) bind(c, name="unlink") result(status)
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int) :: status
    end function c_unlink

    function c_rmdir(path) bind(c, name="rmdir") result(status)
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int) :: status
    end function c_rmdir

    !> `resolved` needs at least PATH_MAX bytes, which is 4096 at most.
    function c_realpath(path, resolved) bind(c, name="realpath") result(found)
      import :: c_char, c_ptr
      character(kind=c_char), intent(in) :: path(*)
      character(kind=c_char), intent(inout) :: resolved(*)
      type(c_ptr) :: found
    end function c_realpath

    function c_isatty(descriptor) bind(c, name="isatty") result(status)
      import :: c_int
      integer(c_int), value :: descriptor
      integer(c_int) :: status
    end function c_isatty
  end interface

contains

  !> Whether a path leads to a folder that can be opened.
  function is_directory(path) result(is)
    character(len=*), intent(in) :: path !! absolute or from the working folder
    logical :: is

    type(c_ptr) :: directory

    directory = c_opendir(path//c_null_char)
    is = c_associated(directory)
    if (is) is = c_closedir(directory) == 0
  end function is_directory

  !> Whether there is a file.
  function file_exists(path) result(exists)
    character(len=*), intent(in) :: path !! of a file, not of a folder
    logical :: exists

    inquire (file=path, exist=exists)
  end function file_exists

  !> Makes a folder and all missing folders above it.
  subroutine make_directories(path, made, is_new)
    character(len=*), intent(in) :: path                  !! of the innermost folder
    logical, intent(out) :: made                          !! whether the folder exists in the end
    type(string_t), allocatable, intent(out) :: is_new(:) !! folders that did not exist before,
                                                          !! outermost first

    integer(c_int), parameter :: everybody = int(o'777', c_int) ! less the bits of the user's umask
    integer :: at, count

    allocate (is_new(len(path)))
    count = 0
    do at = 1, len(path)
      if (at < len(path)) then
        if (path(at + 1:at + 1) /= "/") cycle
      end if
      if (is_directory(path(:at))) cycle
      if (c_mkdir(path(:at)//c_null_char, everybody) /= 0) exit
      count = count + 1
      is_new(count)%text = path(:at)
    end do
    is_new = is_new(:count)
    made = is_directory(path)
  end subroutine make_directories

  !> Renames a file; a file of the new name is replaced.
  subroutine rename_file(from, to, done)
    character(len=*), intent(in) :: from !! current path
    character(len=*), intent(in) :: to   !! new path
    logical, intent(out) :: done         !! false: the operating system refused

    done = c_rename(from//c_null_char, to//c_null_char) == 0
  end subroutine rename_file

  !> Removes a file if it exists. Failures are ignored.
  subroutine remove_file(path)
    character(len=*), intent(in) :: path !! of the file

    integer(c_int) :: status

    status = c_unlink(path//c_null_char)
  end subroutine remove_file

  !> Removes a folder if it is empty. Failures are ignored.
  subroutine remove_empty_directory(path)
    character(len=*), intent(in) :: path !! of the folder

    integer(c_int) :: status

    status = c_rmdir(path//c_null_char)
  end subroutine remove_empty_directory

  !> The last part of a path without its last extension: `inputs/one.deck` gives `one`.
  pure function base_name(path) result(name)
    character(len=*), intent(in) :: path !! of a file
    character(len=:), allocatable :: name

    integer :: dot

    name = file_name(path)
    dot = index(name, ".", back=.true.)
    if (dot > 1) name = name(:dot - 1)
  end function base_name

  !> The last part of a path: `inputs/one.deck` gives `one.deck`.
  pure function file_name(path) result(name)
    character(len=*), intent(in) :: path !! of a file
    character(len=:), allocatable :: name

    name = path(index(path, "/", back=.true.) + 1:)
  end function file_name

  !> `folder/name`, without a second slash if the folder ends with one.
  pure function joined_path(folder, name) result(path)
    character(len=*), intent(in) :: folder !! may end with a slash
    character(len=*), intent(in) :: name   !! of a file in it
    character(len=:), allocatable :: path

    path = folder//"/"//name
    if (len(folder) > 0) then
      if (folder(len(folder):) == "/") path = folder//name
    end if
  end function joined_path

  !> The absolute path of a file with all symbolic links and dots resolved; empty if the file does
  !! not exist.
  function real_path(path) result(absolute)
    character(len=*), intent(in) :: path !! of a file or folder
    character(len=:), allocatable :: absolute

    integer, parameter :: longest = 8192
    character(kind=c_char) :: resolved(longest)
    integer :: i, length

    absolute = ""
    resolved = c_null_char
    if (.not. c_associated(c_realpath(path//c_null_char, resolved))) return
    length = findloc(resolved, c_null_char, dim=1) - 1
    absolute = repeat(" ", length)
    do i = 1, length
      absolute(i:i) = resolved(i)
    end do
  end function real_path

  !> Whether standard error is a terminal, not a file or a pipe.
  function standard_error_is_terminal() result(is)
    logical :: is

    integer(c_int), parameter :: standard_error = 2_c_int

    is = c_isatty(standard_error) /= 0
  end function standard_error_is_terminal

end module file_system
