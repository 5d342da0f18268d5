!> The journal of a long run: results of a run that was killed, for one that continues with
!! `--resume`.
!!
!! Blocks of results are appended when they are done, each between two equal marks, by which a
!! block that was cut off is recognised. Results are kept to the last bit: a resumed run writes the
!! same bytes as an undisturbed one. The first lines are the deck as the program understood it, and
!! the program that computed it: a journal of another deck or program is not used.
module task_journal
  use byte_streams, only: get_integers, put_integers
  use file_system, only: joined_path, remove_file
  use kinds, only: long, wp
  use text_buffer, only: text_buffer_t
  implicit none (type, external)
  private

  public :: journal_t, open_journal, recall_task, keeps_tasks, keep_task, close_journal, &
    remove_journal, journal_name

  !> Name of its file in the output folder.
  character(len=*), parameter :: journal_name = "resume.part"

  !> A run shorter than this is not worth a journal [s].
  real(wp), parameter :: least_time = 0.25_wp

  !> Bytes are passed to the system after this time: so much work of a killed run is lost [s].
  real(wp), parameter :: flush_time = 0.25_wp

  !> A mark before and after every task: group, number, length in bytes.
  integer, parameter :: mark_bytes = 3*storage_size(1)/8

  !> The results of a task.
  type :: block_t
    integer :: task(2) = 0          !! group and number
    integer :: length = 0           !! [bytes]
    integer(long) :: place = 0_long !! of its first byte
  end type block_t

  !> A journal; it is open from its first task, or from the start of a resumed run.
  type :: journal_t
    character(len=:), allocatable, private :: path
    character(len=:), allocatable, private :: title !! deck and program
    integer, private :: unit = -1
    logical, private :: is_open = .false.
    logical, private :: broken = .false.            !! it could not be written; the run continues
                                                    !! without it
    integer, private :: blocks = 0                  !! of the earlier run
    type(block_t), allocatable, private :: list(:)  !! (at least blocks)
    integer, private :: last = 0                    !! block that was recalled last
    integer, private :: kept = 0                    !! blocks of this run
    integer(long), private :: next = 0_long         !! place of the next byte
    integer(long), private :: clock = 0_long        !! ticks at the start of the run, or when bytes
                                                    !! were last passed on
  end type journal_t

contains

  !> Opens the journal of an earlier run if there is one to go on from. Otherwise removes it; a new
  !! one is started when the run turns out to be long.
  subroutine open_journal(folder, title, resume, journal, blocks)
    character(len=*), intent(in) :: folder  !! of the outputs
    character(len=*), intent(in) :: title   !! what must be the same for results to be the same
    logical, intent(in) :: resume           !! whether to go on from an earlier run
    type(journal_t), intent(out) :: journal !! ready for tasks
    integer, intent(out) :: blocks          !! complete ones of the earlier run; -1: it was of
                                            !! another deck or program, or is unreadable

    blocks = 0
    journal%path = joined_path(folder, journal_name)
    journal%title = title
    allocate (journal%list(64))
    call system_clock(journal%clock)
    if (resume) call read_journal(journal, blocks)
    if (journal%is_open) return
    call remove_file(journal%path)
  end subroutine open_journal

  !> Finds the complete blocks of a journal. Bytes after the last of them will be overwritten.
  subroutine read_journal(journal, blocks)
    type(journal_t), intent(inout) :: journal
    integer, intent(out) :: blocks

    character(len=:), allocatable :: title
    character(len=mark_bytes) :: mark, end_mark
    integer(long) :: place, bytes
    integer :: status, length

    blocks = 0
    open (newunit=journal%unit, file=journal%path, status="old", action="readwrite", &
      access="stream", form="unformatted", iostat=status)
    if (status /= 0) return
    journal%is_open = .true.
    inquire (unit=journal%unit, size=bytes)
    read (journal%unit, iostat=status) length
    if (status == 0 .and. length == len(journal%title)) then
      allocate (character(len=length) :: title)
      read (journal%unit, iostat=status) title
      if (status == 0 .and. title /= journal%title) status = -1
    else
      status = -1
    end if
    if (status /= 0) then
      close (journal%unit)
      journal%is_open = .false.
      blocks = -1
      return
    end if
    inquire (unit=journal%unit, pos=place)
    do
      read (journal%unit, pos=place, iostat=status) mark
      if (status /= 0) exit
      if (.not. enters(journal, mark, place + mark_bytes, bytes)) exit
      read (journal%unit, pos=place + mark_bytes + journal%list(journal%blocks + 1)%length, &
        iostat=status) end_mark
      if (status /= 0 .or. end_mark /= mark) exit
      journal%blocks = journal%blocks + 1
      place = place + 2*mark_bytes + journal%list(journal%blocks)%length
    end do
    blocks = journal%blocks
    journal%next = place
  end subroutine read_journal

  !> Adds the block of a mark to the list, if the file is long enough for it.
  function enters(journal, mark, place, bytes)
    type(journal_t), intent(inout) :: journal
    character(len=*), intent(in) :: mark !! group, number and length of the block
    integer(long), intent(in) :: place   !! of the block's first byte
    integer(long), intent(in) :: bytes   !! length of the file
    logical :: enters                    !! whether the block was added

    type(block_t), allocatable :: larger(:)
    integer :: numbers(3), at

    at = 1
    call get_integers(mark, at, numbers)
    enters = all(numbers(:2) >= 0) .and. numbers(3) > 0
    if (enters) enters = place + numbers(3) + mark_bytes - 1 <= bytes
    if (.not. enters) return
    if (journal%blocks == size(journal%list)) then
      allocate (larger(2*size(journal%list)))
      larger(:size(journal%list)) = journal%list
      call move_alloc(larger, journal%list)
    end if
    journal%list(journal%blocks + 1) = block_t(numbers(:2), numbers(3), place)
  end function enters

  !> Returns the bytes of a task that the earlier run did.
  subroutine recall_task(journal, task, bytes, found)
    type(journal_t), intent(inout) :: journal           !! opened
    integer, intent(in) :: task(2)                      !! group and number
    character(len=:), allocatable, intent(out) :: bytes !! what the task gave; not allocated if it
                                                        !! is not in the journal
    logical, intent(out) :: found                       !! whether the bytes could be read

    integer :: i, k, status

    found = .false.
    do k = 1, journal%blocks
      ! Tasks are requested nearly in the order in which they were kept.
      i = 1 + modulo(journal%last + k - 1, journal%blocks)
      associate (block => journal%list(i))
        if (any(block%task /= task)) cycle
        allocate (character(len=block%length) :: bytes)
        read (journal%unit, pos=block%place, iostat=status) bytes
      end associate
      found = status == 0
      journal%last = i
      return
    end do
  end subroutine recall_task

  !> Whether results of tasks are to be kept: only once the run has lasted `least_time`. Begins the
  !! journal then.
  function keeps_tasks(journal) result(keeps)
    type(journal_t), intent(inout) :: journal !! opened
    logical :: keeps

    integer(long) :: now, rate

    keeps = .false.
    if (journal%broken .or. .not. allocated(journal%path)) return
    if (.not. journal%is_open) then
      call system_clock(now, rate)
      if (real(now - journal%clock, wp) < least_time*real(rate, wp)) return
      call begin_journal(journal)
    end if
    keeps = .not. journal%broken
  end function keeps_tasks

  !> Appends the bytes of a task. If they cannot be written, the run continues without a journal.
  subroutine keep_task(journal, task, bytes)
    type(journal_t), intent(inout) :: journal !! opened
    integer, intent(in) :: task(2)            !! group and number
    type(text_buffer_t), intent(in) :: bytes  !! what the task gave

    type(text_buffer_t) :: mark
    integer(long) :: now, rate
    integer :: status

    if (.not. keeps_tasks(journal)) return
    call put_integers(mark, [task, bytes%length])
    write (journal%unit, pos=journal%next, iostat=status) mark%storage(:mark%length), &
      bytes%storage(:bytes%length), mark%storage(:mark%length)
    journal%broken = status /= 0
    if (journal%broken) return
    journal%next = journal%next + 2*mark%length + bytes%length
    journal%kept = journal%kept + 1
    call system_clock(now, rate)
    if (real(now - journal%clock, wp) < flush_time*real(rate, wp)) return
    flush (journal%unit, iostat=status)
    journal%clock = now
  end subroutine keep_task

  subroutine begin_journal(journal)
    type(journal_t), intent(inout) :: journal

    integer :: status

    open (newunit=journal%unit, file=journal%path, status="replace", action="readwrite", &
      access="stream", form="unformatted", iostat=status)
    journal%is_open = status == 0
    if (status == 0) write (journal%unit, iostat=status) len(journal%title), journal%title
    journal%broken = status /= 0
    if (.not. journal%broken) inquire (unit=journal%unit, pos=journal%next)
  end subroutine begin_journal

  !> Closes the journal of an interrupted run.
  subroutine close_journal(journal, blocks)
    type(journal_t), intent(inout) :: journal !! opened, or not begun
    integer, intent(out) :: blocks            !! in it for a run that resumes; 0: nothing to resume
                                              !! from

    integer :: status

    blocks = 0
    if (.not. journal%is_open) return
    close (journal%unit, iostat=status)
    journal%is_open = .false.
    if (status == 0 .and. .not. journal%broken) blocks = journal%blocks + journal%kept
  end subroutine close_journal

  !> Closes and deletes the journal of a finished run.
  subroutine remove_journal(journal)
    type(journal_t), intent(inout) :: journal !! opened, or not begun

    integer :: status

    if (journal%is_open) close (journal%unit, iostat=status)
    journal%is_open = .false.
    if (allocated(journal%path)) call remove_file(journal%path)
  end subroutine remove_journal

end module task_journal
