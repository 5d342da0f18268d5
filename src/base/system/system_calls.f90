! src/base/system/ - what the operating system does: files, locks, signals, time, memory, ranks.
! The calls of POSIX are declared here. Begin with `read_text` in `file_system.f90`, which uses
! them. Long loops ask `was_interrupted` in `interruption.f90`; ranks exchange bytes by
! `send_message` in `ranks.f90`.
! Not here: the output folder of a run (`src/output`), tasks for ranks (`src/runs/batch`).

!> The calls of the system, as POSIX has them, for which Fortran has no statements.
module system_calls
  use, intrinsic :: iso_c_binding, only: c_char, c_funptr, c_int, c_long, c_null_ptr, c_ptr, &
    c_size_t
  implicit none (type, external)
  private

  public :: glob_t, c_clearerr, c_close, c_closedir, c_errno, c_exit_at_once, c_fclose, c_fdopen, &
    c_ferror, c_fflush, c_fileno, c_flock, c_fopen, c_fread, c_fseek, c_fwrite, c_gethostname, &
    c_getpid, c_glob, c_globfree, c_isatty, c_mkdir, c_mkdtemp, c_opendir, c_realpath, c_rename, &
    c_rmdir, c_sched_yield, c_siginterrupt, c_signal, c_strerror, c_strlen, c_truncate, c_unlink, &
    c_usleep, c_write

  !> Values of `errno` on Linux: ENOENT, EINTR, EBADF, EAGAIN (EWOULDBLOCK), EACCES, EROFS, EPIPE.
  integer(c_int), parameter, public :: no_entry = 2_c_int, interrupted_call = 4_c_int, &
    not_open = 9_c_int, try_again = 11_c_int, not_allowed = 13_c_int, read_only = 30_c_int, &
    no_reader = 32_c_int

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

    !> The last six characters of the path are X, and replaced.
    function c_mkdtemp(path) bind(c, name="mkdtemp") result(made)
      import :: c_char, c_ptr
      character(kind=c_char), intent(inout) :: path(*)
      type(c_ptr) :: made
    end function c_mkdtemp

    function c_fopen(path, mode) bind(c, name="fopen") result(stream)
      import :: c_char, c_ptr
      character(kind=c_char), intent(in) :: path(*), mode(*)
      type(c_ptr) :: stream
    end function c_fopen

    function c_fseek(stream, offset, whence) bind(c, name="fseek") result(status)
      import :: c_int, c_long, c_ptr
      type(c_ptr), value :: stream
      integer(c_long), value :: offset
      integer(c_int), value :: whence
      integer(c_int) :: status
    end function c_fseek

    function c_fdopen(descriptor, mode) bind(c, name="fdopen") result(stream)
      import :: c_char, c_int, c_ptr
      integer(c_int), value :: descriptor
      character(kind=c_char), intent(in) :: mode(*)
      type(c_ptr) :: stream
    end function c_fdopen

    function c_fread(bytes, size, count, stream) bind(c, name="fread") result(taken)
      import :: c_char, c_ptr, c_size_t
      character(kind=c_char), intent(inout) :: bytes(*)
      integer(c_size_t), value :: size, count
      type(c_ptr), value :: stream
      integer(c_size_t) :: taken
    end function c_fread

    function c_ferror(stream) bind(c, name="ferror") result(status)
      import :: c_int, c_ptr
      type(c_ptr), value :: stream
      integer(c_int) :: status
    end function c_ferror

    subroutine c_clearerr(stream) bind(c, name="clearerr")
      import :: c_ptr
      type(c_ptr), value :: stream
    end subroutine c_clearerr

    function c_fclose(stream) bind(c, name="fclose") result(status)
      import :: c_int, c_ptr
      type(c_ptr), value :: stream
      integer(c_int) :: status
    end function c_fclose

    !> `errno`, a macro of C, as the compiler's library has it for its extension `ierrno`.
    function c_errno() bind(c, name="_gfortran_ierrno_i4") result(number)
      import :: c_int
      integer(c_int) :: number
    end function c_errno

    function c_strerror(number) bind(c, name="strerror") result(string)
      import :: c_int, c_ptr
      integer(c_int), value :: number
      type(c_ptr) :: string
    end function c_strerror

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

    function c_fwrite(bytes, size, count, stream) bind(c, name="fwrite") result(written)
      import :: c_char, c_ptr, c_size_t
      character(kind=c_char), intent(in) :: bytes(*)
      integer(c_size_t), value :: size, count
      type(c_ptr), value :: stream
      integer(c_size_t) :: written
    end function c_fwrite

    function c_fflush(stream) bind(c, name="fflush") result(status)
      import :: c_int, c_ptr
      type(c_ptr), value :: stream
      integer(c_int) :: status
    end function c_fflush

    function c_fileno(stream) bind(c, name="fileno") result(descriptor)
      import :: c_int, c_ptr
      type(c_ptr), value :: stream
      integer(c_int) :: descriptor
    end function c_fileno

    function c_flock(descriptor, operation) bind(c, name="flock") result(status)
      import :: c_int
      integer(c_int), value :: descriptor, operation
      integer(c_int) :: status
    end function c_flock

    !> `ssize_t` is as long as `size_t`.
    function c_write(descriptor, bytes, count) bind(c, name="write") result(written)
      import :: c_char, c_int, c_long, c_size_t
      integer(c_int), value :: descriptor
      character(kind=c_char), intent(in) :: bytes(*)
      integer(c_size_t), value :: count
      integer(c_long) :: written
    end function c_write

    function c_close(descriptor) bind(c, name="close") result(status)
      import :: c_int
      integer(c_int), value :: descriptor
      integer(c_int) :: status
    end function c_close

    subroutine c_exit_at_once(status) bind(c, name="_exit")
      import :: c_int
      integer(c_int), value :: status
    end subroutine c_exit_at_once

    function c_getpid() bind(c, name="getpid") result(number)
      import :: c_int
      integer(c_int) :: number
    end function c_getpid

    function c_gethostname(name, length) bind(c, name="gethostname") result(status)
      import :: c_char, c_int, c_size_t
      character(kind=c_char), intent(inout) :: name(*)
      integer(c_size_t), value :: length
      integer(c_int) :: status
    end function c_gethostname

    function c_signal(number, handler) bind(c, name="signal") result(previous)
      import :: c_funptr, c_int
      integer(c_int), value :: number
      type(c_funptr), value :: handler
      type(c_funptr) :: previous
    end function c_signal

    !> Whether a signal ends a call of the system that waits; else it goes on waiting.
    function c_siginterrupt(number, ends) bind(c, name="siginterrupt") result(status)
      import :: c_int
      integer(c_int), value :: number, ends
      integer(c_int) :: status
    end function c_siginterrupt

    function c_usleep(microseconds) bind(c, name="usleep") result(status)
      import :: c_int
      integer(c_int), value :: microseconds
      integer(c_int) :: status
    end function c_usleep

    function c_sched_yield() bind(c, name="sched_yield") result(status)
      import :: c_int
      integer(c_int) :: status
    end function c_sched_yield
  end interface

end module system_calls
