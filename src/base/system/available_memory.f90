!> How much memory a run may take, where the system reports it (Linux: /proc and control groups).
module available_memory
  use kinds, only: long, wp
  use text, only: to_string
  implicit none (type, external)
  private

  public :: available_memory_t, find_available_memory, threads_in_memory, memory_text

  type :: available_memory_t
    real(wp) :: bytes = huge(1.0_wp)        !! that may still be taken; huge if unknown
    character(len=:), allocatable :: clause !! the same in words, for a message
  end type available_memory_t

  !> Address space that every thread beyond the first takes for its stack, used or not, and what the
  !! C library sets aside for what it allocates [bytes].
  real(wp), parameter :: stack_size = 8.0_wp*2.0_wp**20, heap_size = 64.0_wp*2.0_wp**20

  real(wp), parameter :: kibibyte = 1024.0_wp
  integer, parameter :: line_length = 512

contains

  !> The least of what the machine has free, what its control groups leave, and what the limit of
  !! address space leaves.
  function find_available_memory(threads, processes) result(available)
    integer, intent(in) :: threads             !! of the run
    integer, intent(in), optional :: processes !! of the run on this machine, which share its
                                               !! memory; absent: one
    type(available_memory_t) :: available      !! for one of them

    real(wp) :: limit
    character(len=:), allocatable :: shared
    integer :: sharing

    sharing = 1
    if (present(processes)) sharing = processes
    shared = ""
    if (sharing > 1) shared = "for each of "//to_string(sharing)//" processes"
    available%clause = ""
    limit = number_after("/proc/meminfo", "MemAvailable:")
    if (limit >= 0.0_wp) call lower(kibibyte*limit/sharing, "this machine has", "free "//shared)
    call lower(left_by_groups()/sharing, "its control group leaves", shared)
    limit = address_space()
    if (limit < huge(limit)) call lower(max(0.0_wp, limit - (threads - 1)*stack_size), &
      "the limit of address space (ulimit -v) leaves", "")

  contains

    subroutine lower(bytes, before, after)
      real(wp), intent(in) :: bytes
      character(len=*), intent(in) :: before, after

      if (bytes >= available%bytes) return
      available%bytes = bytes
      available%clause = trim(before//" "//memory_text(bytes)//" "//after)
    end subroutine lower

  end function find_available_memory

  !> How many of so many threads the limit of address space has room for: they take at most half of
  !! it. Where a thread finds no room for what it allocates, every piece takes a page.
  integer function threads_in_memory(threads)
    integer, intent(in) :: threads !! 1 or more

    real(wp) :: room

    threads_in_memory = threads
    if (threads == 1) return
    room = 0.5_wp*address_space()/(stack_size + heap_size)
    if (room < threads - 1) threads_in_memory = 1 + int(room)
  end function threads_in_memory

  !> What the limit of address space leaves; huge without a limit [bytes].
  real(wp) function address_space()
    real(wp) :: limit, taken

    address_space = huge(address_space)
    limit = number_after("/proc/self/limits", "Max address space")
    taken = number_after("/proc/self/status", "VmSize:")
    if (limit >= 0.0_wp .and. taken >= 0.0_wp) address_space = max(0.0_wp, limit - kibibyte*taken)
  end function address_space

  !> `7.8 GB`, to two digits; below 0.995 GB in MB, at least 1.0 MB.
  pure function memory_text(bytes) result(text)
    real(wp), intent(in) :: bytes !! [bytes]
    character(len=:), allocatable :: text

    if (bytes < 0.995e9_wp) then
      text = to_string(max(bytes, 1.0e6_wp)/1.0e6_wp, 2)//" MB"
    else
      text = to_string(bytes/1.0e9_wp, 2)//" GB"
    end if
  end function memory_text

  !> What the control groups of this process leave, the innermost and all above it; huge where there
  !! is no limit [bytes].
  function left_by_groups() result(bytes)
    real(wp) :: bytes

    character(len=line_length) :: line
    integer :: unit, status, first

    bytes = huge(bytes)
    open (newunit=unit, file="/proc/self/cgroup", status="old", action="read", iostat=status)
    if (status /= 0) return
    do
      read (unit, "(a)", iostat=status) line
      if (status /= 0) exit
      ! `0::/path` in version 2, `4:memory:/path` in version 1.
      first = index(line, ":/") + 1
      if (first == 1) cycle
      if (index(line, "0::") == 1) then
        bytes = min(bytes, left_by_path("/sys/fs/cgroup", trim(line(first:)), "memory.max", &
          "memory.current", "inactive_file"))
      else if (index(line, ":memory:") > 0) then
        bytes = min(bytes, left_by_path("/sys/fs/cgroup/memory", trim(line(first:)), &
          "memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"))
      end if
    end do
    close (unit, iostat=status)
  end function left_by_groups

  !> The least that a group and those above it leave. What the group keeps of files that nobody
  !! reads any more counts as free.
  function left_by_path(root, path, limit_file, use_file, cache_key) result(bytes)
    character(len=*), intent(in) :: root, path, limit_file, use_file, cache_key
    real(wp) :: bytes

    real(wp) :: limit, taken
    character(len=:), allocatable :: folder, group

    bytes = huge(bytes)
    group = path
    do
      folder = root//"/"
      if (len(group) > 1) folder = root//group//"/"
      limit = number_after(folder//limit_file, "")
      taken = number_after(folder//use_file, "")
      if (limit >= 0.0_wp .and. taken >= 0.0_wp) then
        bytes = min(bytes, &
          max(0.0_wp, limit - taken + max(0.0_wp, number_after(folder//"memory.stat", &
          cache_key//" "))))
      end if
      if (len(group) <= 1) exit
      group = group(:max(1, index(group, "/", back=.true.) - 1))
    end do
  end function left_by_path

  !> The whole number after a key at the start of a line of a file; −1 if there is no such file, no
  !! such line or no number (`max`).
  function number_after(path, key) result(number)
    character(len=*), intent(in) :: path, key
    real(wp) :: number

    character(len=line_length) :: line
    integer(long) :: whole
    integer :: unit, status, first, last

    number = -1.0_wp
    open (newunit=unit, file=path, status="old", action="read", iostat=status)
    if (status /= 0) return
    do
      read (unit, "(a)", iostat=status) line
      if (status /= 0) exit
      if (index(line, key) /= 1) cycle
      line = line(len(key) + 1:)
      line = line(max(1, verify(line, " "//achar(9))):)
      first = verify(line, "0123456789")
      last = first - 1
      if (last >= 1 .and. last <= 18) then
        read (line(:last), "(i18)", iostat=status) whole
        if (status == 0) number = real(whole, wp)
      end if
      exit
    end do
    close (unit, iostat=status)
  end function number_after

end module available_memory
