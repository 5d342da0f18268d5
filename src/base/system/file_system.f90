!> Files and folders: what Fortran has no statements for.
module file_system
  use, intrinsic :: iso_c_binding, only: c_associated, c_char, c_f_pointer, c_int, c_long, &
    c_null_char, c_null_ptr, c_ptr, c_size_t
  use interruption, only: was_interrupted
  use kinds, only: long
  use system_calls, only: c_clearerr, c_closedir, c_errno, c_fclose, c_fdopen, c_ferror, c_fopen, &
    c_fread, c_fseek, c_glob, c_globfree, c_isatty, c_mkdir, c_mkdtemp, c_opendir, c_realpath, &
    c_rename, c_rmdir, c_strerror, c_strlen, c_truncate, c_unlink, glob_t, interrupted_call, &
    no_entry, not_allowed, read_only
  use text, only: append_string, string_t, to_string
  use text_buffer, only: append_text, buffer_text, text_buffer_t
  implicit none (type, external)
  private

  public :: is_directory, is_plain_file, file_exists, make_directories, make_own_directory, &
    rename_file, remove_file, remove_empty_directory, remove_directory, shorten_file, &
    find_matching_files, read_text, read_standard_input
  public :: base_name, file_name, folder_name, joined_path, real_path, standard_error_is_terminal, &
    system_reason

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

  !> Whether there is a file that can be read from any place: no folder, pipe or terminal.
  function is_plain_file(path) result(is)
    character(len=*), intent(in) :: path !! absolute or from the working folder
    logical :: is

    integer(c_int), parameter :: from_end = 2_c_int
    type(c_ptr) :: stream

    ! A pipe that nobody writes to blocks who opens it for reading, but not for both.
    stream = c_fopen(path//c_null_char, "r+"//c_null_char)
    if (c_associated(stream)) then
      is = c_fseek(stream, 0_c_long, from_end) == 0
      is = c_fclose(stream) == 0 .and. is
    else
      is = (c_errno() == not_allowed .or. c_errno() == read_only) .and. file_exists(path)
    end if
  end function is_plain_file

  !> Why the last call of the system has failed: `Permission denied`.
  function system_reason() result(reason)
    character(len=:), allocatable :: reason

    reason = string_of(c_strerror(c_errno()))
  end function system_reason

  !> A text of C.
  function string_of(string) result(text)
    type(c_ptr), intent(in) :: string
    character(len=:), allocatable :: text

    character(kind=c_char), pointer :: characters(:)
    integer :: i

    call c_f_pointer(string, characters, [c_strlen(string)])
    text = repeat(" ", size(characters))
    do i = 1, size(characters)
      text(i:i) = characters(i)
    end do
  end function string_of

  !> Makes a folder and all missing folders above it. If it is not made, `system_reason` says why.
  subroutine make_directories(path, made, is_new)
    character(len=*), intent(in) :: path                  !! of the innermost folder
    logical, intent(out) :: made                          !! whether the folder exists in the end
    type(string_t), allocatable, intent(out) :: is_new(:) !! folders that did not exist before,
                                                          !! outermost first

    integer(c_int), parameter :: everybody = int(o'777', c_int) ! less the bits of the user's umask
    integer :: at, count

    allocate (is_new(len(path)))
    count = 0
    made = len(path) > 0
    do at = 1, len(path)
      if (at < len(path)) then
        if (path(at + 1:at + 1) /= "/") cycle
      end if
      if (is_directory(path(:at))) cycle
      made = c_mkdir(path(:at)//c_null_char, everybody) == 0
      if (.not. made) then
        ! Another process may have been faster, or have removed in between what it had made.
        made = is_directory(path(:at))
        if (made) cycle
        made = c_mkdir(path(:at)//c_null_char, everybody) == 0
        if (.not. made) exit
      end if
      count = count + 1
      is_new(count)%text = path(:at)
    end do
    is_new = is_new(:count)
  end subroutine make_directories

  !> Makes a folder that nobody else has, whose name begins as given: `.new-` gives `.new-x7Kq2z`.
  !! If none is made, `system_reason` says why.
  subroutine make_own_directory(beginning, path, made)
    character(len=*), intent(in) :: beginning              !! of its path
    character(len=:), allocatable, intent(out) :: path     !! of the folder
    logical, intent(out) :: made

    path = beginning//"XXXXXX"//c_null_char
    made = c_associated(c_mkdtemp(path))
    path = path(:len(path) - 1)
  end subroutine make_own_directory

  !> Renames a file or a folder; a file of the new name is replaced. If it is not done,
  !! `system_reason` says why.
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

  !> Removes a folder with the files in it, unless it holds other folders. Failures are ignored.
  subroutine remove_directory(path)
    character(len=*), intent(in) :: path !! of the folder

    type(string_t), allocatable :: names(:)
    integer :: i

    call find_matching_files(path, "", names)
    do i = 1, size(names)
      call remove_file(joined_path(path, names(i)%text))
    end do
    call remove_empty_directory(path)
  end subroutine remove_directory

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
    character(len=:), allocatable :: path
    integer(c_int) :: status
    integer :: i, first

    allocate (names(0))
    first = len(joined_path(folder, "")) + 1
    status = c_glob(escaped(joined_path(folder, beginning))//"*"//c_null_char, no_flags, &
      c_null_ptr, found)
    if (status == 0) then
      call c_f_pointer(found%paths, paths, [found%count])
      do i = 1, size(paths)
        path = string_of(paths(i))
        call append_string(names, path(first:))
      end do
    end if
    call c_globfree(found)
  end subroutine find_matching_files

  !> The bytes of a file, as far as it can be read.
  subroutine read_text(path, text, reason)
    character(len=*), intent(in) :: path                 !! also of a pipe or a device
    character(len=:), allocatable, intent(out) :: text
    character(len=:), allocatable, intent(out), optional :: reason !! why it cannot be read; empty
                                                                   !! if it is

    character(len=:), allocatable :: why
    type(c_ptr) :: stream
    integer(c_int) :: status

    text = ""
    stream = c_fopen(path//c_null_char, "r"//c_null_char)
    if (c_associated(stream)) then
      call read_stream(stream, text, why)
      status = c_fclose(stream)
    else if (c_errno() == no_entry) then
      why = "no such file"
    else
      why = system_reason()
    end if
    if (present(reason)) reason = why
  end subroutine read_text

  !> The bytes of standard input.
  subroutine read_standard_input(text, reason)
    character(len=:), allocatable, intent(out) :: text
    character(len=:), allocatable, intent(out) :: reason !! why it cannot be read; empty if it is

    integer(c_int), parameter :: standard_input = 0_c_int
    type(c_ptr) :: stream

    text = ""
    stream = c_fdopen(standard_input, "r"//c_null_char)
    if (c_associated(stream)) then
      call read_stream(stream, text, reason)
    else
      reason = system_reason()
    end if
  end subroutine read_standard_input

  !> An endless device must not fill the memory: reading ends at a NUL byte, which is no text, or at
  !! half a gigabyte, more than any deck.
  subroutine read_stream(stream, text, reason)
    type(c_ptr), intent(in) :: stream
    character(len=:), allocatable, intent(out) :: text, reason

    integer, parameter :: most_bytes = 500000000
    character(kind=c_char, len=8192) :: piece
    type(text_buffer_t) :: buffer
    integer :: length

    reason = ""
    do
      length = int(c_fread(piece, 1_c_size_t, len(piece, c_size_t), stream))
      call append_text(buffer, piece(:length))
      if (index(piece(:length), c_null_char) > 0) exit
      if (buffer%length > most_bytes) then
        reason = "it is larger than "//to_string(most_bytes)//" bytes"
        exit
      end if
      if (length == len(piece)) cycle
      if (c_ferror(stream) == 0_c_int) exit
      reason = system_reason()
      if (c_errno() /= interrupted_call .or. was_interrupted()) exit
      reason = ""
      call c_clearerr(stream)
    end do
    text = buffer_text(buffer)
  end subroutine read_stream

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

  !> The folder of a path: `inputs/one.deck` gives `inputs`, `one.deck` gives `.`.
  pure function folder_name(path) result(name)
    character(len=*), intent(in) :: path !! of a file
    character(len=:), allocatable :: name

    integer :: slash

    slash = index(path, "/", back=.true.)
    name = "."
    if (slash > 0) name = path(:max(1, slash - 1))
  end function folder_name

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

    character(kind=c_char, len=8192) :: resolved

    absolute = ""
    if (c_associated(c_realpath(path//c_null_char, resolved))) absolute = &
      resolved(:index(resolved, c_null_char) - 1)
  end function real_path

  !> Whether standard error is a terminal, not a file or a pipe.
  function standard_error_is_terminal() result(is)
    logical :: is

    integer(c_int), parameter :: standard_error = 2_c_int

    is = c_isatty(standard_error) /= 0
  end function standard_error_is_terminal

end module file_system
