!> A lock that keeps other runs away from a folder, or from a file of it.
!!
!! The system holds it for an open file and lets it go with the process, however that ends: a file
!! that a killed run has left locks nothing.
module folder_locks
  use, intrinsic :: iso_c_binding, only: c_associated, c_char, c_int, c_null_char, &
    c_null_ptr, c_ptr, c_size_t
  use file_system, only: read_text, remove_file, system_reason
  use kinds, only: long
  use system_calls, only: c_errno, c_fclose, c_fflush, c_fileno, c_flock, c_fopen, c_getpid, &
    c_gethostname, c_fwrite, try_again
  use text, only: to_string
  implicit none (type, external)
  private

  public :: lock_t, take_lock, leave_lock

  type :: lock_t
    character(len=:), allocatable, private :: path
    type(c_ptr), private :: stream = c_null_ptr
    logical :: is_held = .false.
    logical :: is_sure = .false. !! false: the file system has no locks, and others may be there
  end type lock_t

contains

  !> Takes the lock, if nobody has it.
  subroutine take_lock(path, lock, holder, reason)
    character(len=*), intent(in) :: path                 !! of the lock's file, which may not exist
    type(lock_t), intent(out) :: lock
    character(len=:), allocatable, intent(out) :: holder !! `process 4711 on a host`; empty: nobody
    character(len=:), allocatable, intent(out) :: reason !! of the system, if it is not taken and
                                                         !! nobody has it

    integer(c_int), parameter :: exclusive = 2_c_int, at_once = 4_c_int
    integer, parameter :: most_tries = 100
    character(len=:), allocatable :: own, words
    integer :: try
    integer(c_int) :: status
    integer(c_size_t) :: written
    logical :: is_written

    holder = ""
    reason = ""
    lock%path = path
    own = own_name()
    do try = 1, most_tries
      lock%stream = c_fopen(path//c_null_char, "a"//c_null_char)
      if (.not. c_associated(lock%stream)) then
        reason = system_reason()
        return
      end if
      lock%is_sure = .true.
      if (c_flock(c_fileno(lock%stream), ior(exclusive, at_once)) /= 0) then
        lock%is_sure = .false.
        if (c_errno() == try_again) then
          call read_text(path, words)
          holder = holder_of(words)
          status = c_fclose(lock%stream)
          return
        end if
      end if
      ! Whoever had the lock before has removed the file, maybe after it was opened here: then
      ! another one may hold a new file of the same name.
      written = c_fwrite(own//achar(10), 1_c_size_t, len(own, c_size_t) + 1_c_size_t, lock%stream)
      is_written = c_fflush(lock%stream) == 0_c_int
      if (.not. is_written) reason = system_reason()
      call read_text(path, words)
      lock%is_held = index(words, own) > 0 .or. .not. lock%is_sure
      if (lock%is_held) return
      if (.not. is_written .and. words == "") call remove_file(path)
      status = c_fclose(lock%stream)
      if (.not. is_written) return
    end do
    holder = "another process"
  end subroutine take_lock

  !> Lets the lock go and removes its file. Nothing happens if it is not held.
  subroutine leave_lock(lock)
    type(lock_t), intent(inout) :: lock

    integer(c_int) :: status

    if (.not. lock%is_held) return
    call remove_file(lock%path)
    status = c_fclose(lock%stream)
    lock%is_held = .false.
  end subroutine leave_lock

  !> A line that no other process writes: `process 4711 on a host, 123456789`.
  function own_name() result(name)
    character(len=:), allocatable :: name

    character(kind=c_char, len=257) :: host
    integer(long) :: now

    host = repeat(c_null_char, len(host))
    if (c_gethostname(host, 256_c_size_t) /= 0) host(1:1) = c_null_char
    call system_clock(now)
    name = "process "//to_string(int(c_getpid()))//" on "//host(:index(host, c_null_char) - 1)// &
      ", "//to_string(now)
  end function own_name

  !> The last line of a lock's file without what makes it unique.
  pure function holder_of(words) result(holder)
    character(len=*), intent(in) :: words
    character(len=:), allocatable :: holder

    integer :: first, last

    holder = "another process"
    last = index(words, ", ", back=.true.) - 1
    if (last < 1) return
    first = index(words(:last), achar(10), back=.true.) + 1
    holder = words(first:last)
  end function holder_of

end module folder_locks
