!> The few operating system calls that Fortran lacks.
module file_system
  use, intrinsic :: iso_c_binding, only: c_associated, c_char, c_f_pointer, c_int, c_long, &
    c_null_char, c_null_ptr, c_ptr, c_size_t
  use kinds, only: long
  use text, only: append_string, string_t
  implicit none (type, external)
  private

  public :: is_directory, file_exists, make_directories, rename_file, remove_file, &
    remove_empty_directory, shorten_file, find_matching_files
  public :: base_name, file_name, joined_path, real_path, standard_error_is_terminal

  !> The result of `glob`, as the C libraries of Linux have it: its members of POSIX, and more
  !! room than their own ones need.
  type, bind(c) :: glob_t
    integer(c_size_t) :: count = 0_c_size_t
    type(c_ptr) :: paths = c_null_ptr
    integer(c_size_t) :: offset = 0_c_size_t
    integer(c_long) :: others(32) = 0_c_long
  end type glob_t

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

    !> `off_t` is a long integer on all machines of 64 bits.
    function c_truncate(path, length) bind(c, name="truncate") result(status)
      import :: c_char, c_int, c_long
      character(kind=c_char), intent(in) :: path(*)
      integer(c_long), value :: length
      integer(c_int) :: status
    end function c_truncate

    function c_glob(pattern, flags, on_error, found) bind(c, name="glob") result(status)
      import :: c_char, c_int, c_ptr, glob_t
      character(kind=c_char), intent(in) :: pattern(*)
      integer(c_int), value :: flags
      type(c_ptr), value :: on_error
      type(glob_t), intent(inout) :: found
      integer(c_int) :: status
    end function c_glob

    subroutine c_globfree(found) bind(c, name="globfree")
      import :: glob_t
      type(glob_t), intent(inout) :: found
    end subroutine c_globfree

    function c_strlen(string) bind(c, name="strlen") result(length)
      import :: c_ptr, c_size_t
      type(c_ptr), value :: string
      integer(c_size_t) :: length
    end function c_strlen

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

  !> Cuts off the end of a file. Failures are ignored.
  subroutine shorten_file(path, bytes)
    character(len=*), intent(in) :: path  !! of the file
    integer(long), intent(in) :: bytes    !! that remain

    integer(c_int) :: status

    status = c_truncate(path//c_null_char, int(bytes, c_long))
  end subroutine shorten_file

  !> The files of a folder whose names begin with a text, in the order of the bytes of their names.
  subroutine find_matching_files(folder, beginning, names)
    character(len=*), intent(in) :: folder                !! existing, or not
    character(len=*), intent(in) :: beginning             !! of the names
    type(string_t), allocatable, intent(out) :: names(:)  !! without the folder

    integer(c_int), parameter :: no_flags = 0_c_int
    type(glob_t) :: found
    type(c_ptr), pointer :: paths(:)
    character(kind=c_char), pointer :: path(:)
    integer(c_int) :: status
    integer :: i, first

    allocate (names(0))
    first = len(joined_path(folder, "")) + 1
    status = c_glob(escaped(joined_path(folder, beginning))//"*"//c_null_char, no_flags, &
      c_null_ptr, found)
    if (status == 0) then
      call c_f_pointer(found%paths, paths, [found%count])
      do i = 1, size(paths)
        call c_f_pointer(paths(i), path, [c_strlen(paths(i))])
        call append_string(names, text_of(path(first:)))
      end do
    end if
    call c_globfree(found)
  end subroutine find_matching_files

  !> A text without the meaning that some characters have in patterns of names.
  pure function escaped(words) result(text)
    character(len=*), intent(in) :: words
    character(len=:), allocatable :: text

    integer :: i

    text = ""
    do i = 1, len(words)
      if (scan(words(i:i), "*?[]\") > 0) text = text//"\"
      text = text//words(i:i)
    end do
  end function escaped

  pure function text_of(characters) result(text)
    character(kind=c_char), intent(in) :: characters(:)
    character(len=size(characters)) :: text

    integer :: i

    do i = 1, size(characters)
      text(i:i) = characters(i)
    end do
  end function text_of

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
