!> The journal of a long run: results of a run that was killed, for one that continues with
!! `--resume`. The parts of a study that `--part` computes are complete journals.
!!
!! Blocks of results are appended when they are done, each between two equal marks, by which a
!! block that was cut off or changed is recognised. Results are kept to the last bit: a resumed run
!! writes the same bytes as an undisturbed one. The first lines are the deck as the program
!! understood it, and the program that computed it: a journal of another deck or program is not
!! used.
module task_journal
  use errors, only: error_of_files, error_t, set_error
  use file_system, only: file_exists, joined_path, remove_file, rename_file, shorten_file, &
    system_reason
  use kinds, only: long, wp
  use output_files, only: append_output, close_output, finish_output, is_failing, open_output, &
    output_file_t, pass_on_output
  use sorting, only: ascending_order
  use text, only: append_string, string_t
  use text_buffer, only: text_buffer_t
  implicit none (type, external)
  private

  public :: journal_t, open_journal, new_journal, add_journal_file, recall_task, has_task, &
    keeps_tasks, keep_task, close_journal, publish_journal, remove_journal, read_title
  public :: journal_name, begun

  !> Name of its file in the output folder.
  character(len=*), parameter :: journal_name = "resume.part"

  !> A journal that is to stay has this after its path until it is complete.
  character(len=*), parameter :: begun = ".resume"

  !> A run shorter than this is not worth a journal [s].
  real(wp), parameter :: least_time = 0.25_wp

  !> Bytes are passed to the system after this time: so much work of a killed run is lost [s].
  real(wp), parameter :: flush_time = 0.25_wp

  !> A mark before and after every task: group, number, length in bytes, checksum.
  integer, parameter :: marks = 4, mark_bytes = marks*storage_size(1)/8

  !> The results of a task; there may be millions of them.
  type :: block_t
    integer :: task(2) = 0          !! group and number
    integer :: length = 0           !! [bytes]
    integer :: file = 0             !! number of the file that has it; 0: the journal itself
    integer(long) :: place = 0_long !! of its first byte
  end type block_t

  !> A journal; it is open from its first task, or from the start of a resumed run.
  type :: journal_t
    character(len=:), allocatable, private :: path
    character(len=:), allocatable, private :: title !! deck and program
    type(output_file_t), private :: file            !! to which tasks are added
    logical, private :: is_open = .false.           !! `file`
    type(error_t), allocatable :: error             !! why it could not be opened; the run continues
                                                    !! without it
    logical, private :: stays = .false.             !! it is a result: tasks of the shortest run are
                                                    !! kept, too
    logical, private :: only_read = .false.         !! nothing is added
    integer, private :: blocks = 0                  !! of earlier runs
    type(block_t), allocatable, private :: list(:)  !! (at least blocks) in the order of the files,
                                                    !! from the first question on in that of tasks
    logical, private :: is_sorted = .false.         !! `list`
    integer, private :: last = 0                    !! block that was found last
    integer, private :: kept = 0                    !! blocks of this run
    integer(long), private :: first = 0_long        !! place of the first block
    integer(long), private :: clock = 0_long        !! ticks at the start of the run, or when bytes
                                                    !! were last passed on
    type(string_t), allocatable, private :: files(:) !! paths of complete journals of other runs
    integer, private :: open_file = -1              !! number of the one that is read; 0: the
                                                    !! journal itself; -1: none
    integer, private :: reader = -1                 !! its unit
  end type journal_t

contains

  !> Opens the journal of an earlier run if there is one to go on from. Otherwise removes it; a new
  !! one is started when the run turns out to be long.
  subroutine open_journal(folder, title, resume, journal, blocks, name)
    character(len=*), intent(in) :: folder  !! of the outputs
    character(len=*), intent(in) :: title   !! what must be the same for results to be the same
    logical, intent(in) :: resume           !! whether to go on from an earlier run
    type(journal_t), intent(out) :: journal !! ready for tasks
    integer, intent(out) :: blocks          !! complete ones of the earlier run; -1: it was of
                                            !! another deck or program, or is unreadable
    character(len=*), intent(in), optional :: name !! of a journal that stays when it is complete,
                                                   !! with all tasks

    blocks = 0
    journal%title = title
    allocate (journal%list(64), journal%files(0))
    call system_clock(journal%clock)
    if (present(name)) then
      journal%path = joined_path(folder, name)//begun
      journal%stays = .true.
      if (resume) call begin_again(joined_path(folder, name), journal)
    else
      journal%path = joined_path(folder, journal_name)
    end if
    if (resume) call read_journal(journal, blocks)
    if (journal%is_open) return
    call remove_file(journal%path)
  end subroutine open_journal

  !> A journal to which nothing is added: its tasks are those of files of other runs.
  subroutine new_journal(folder, title, journal)
    character(len=*), intent(in) :: folder  !! of the outputs
    character(len=*), intent(in) :: title   !! that the files must have
    type(journal_t), intent(out) :: journal !! without tasks

    journal%path = joined_path(folder, journal_name)
    journal%title = title
    journal%only_read = .true.
    allocate (journal%list(64), journal%files(0))
  end subroutine new_journal

  !> Goes on from a complete journal, if it is of this run and there is none under way.
  subroutine begin_again(path, journal)
    character(len=*), intent(in) :: path !! of the complete journal
    type(journal_t), intent(in) :: journal

    character(len=:), allocatable :: title
    logical :: done

    if (file_exists(journal%path) .or. .not. file_exists(path)) return
    call read_title(path, title)
    if (is_title(journal, title)) call rename_file(path, journal%path, done)
  end subroutine begin_again

  !> The title of a journal; empty if there is none.
  subroutine read_title(path, title)
    character(len=*), intent(in) :: path               !! of the file
    character(len=:), allocatable, intent(out) :: title

    integer :: unit, status

    title = ""
    open (newunit=unit, file=path, status="old", action="read", access="stream", &
      form="unformatted", iostat=status)
    if (status /= 0) return
    call read_title_of(unit, title)
    close (unit)
  end subroutine read_title

  !> Likewise, of an open file at its start.
  subroutine read_title_of(unit, title)
    integer, intent(in) :: unit
    character(len=:), allocatable, intent(out) :: title

    integer(long) :: bytes
    integer :: status, length

    title = ""
    inquire (unit=unit, size=bytes)
    read (unit, iostat=status) length
    if (status /= 0) return
    if (length < 1 .or. length > bytes) return
    deallocate (title)
    allocate (character(len=length) :: title)
    read (unit, iostat=status) title
    if (status /= 0) title = ""
  end subroutine read_title_of

  pure logical function is_title(journal, title)
    type(journal_t), intent(in) :: journal
    character(len=*), intent(in) :: title

    ! Blanks at the end of a text make no difference for `==`.
    is_title = len(title) == len(journal%title) .and. title == journal%title
  end function is_title

  !> Finds the complete blocks of a journal. Bytes after the last of them are cut off.
  subroutine read_journal(journal, blocks)
    type(journal_t), intent(inout) :: journal
    integer, intent(out) :: blocks

    character(len=:), allocatable :: title
    integer(long) :: next, bytes
    integer :: unit, status

    blocks = 0
    open (newunit=unit, file=journal%path, status="old", action="read", access="stream", &
      form="unformatted", iostat=status)
    if (status /= 0) return
    call read_title_of(unit, title)
    journal%is_open = is_title(journal, title)
    if (journal%is_open) then
      inquire (unit=unit, pos=journal%first)
      call read_blocks(journal, unit, 0, next)
      blocks = journal%blocks
    else
      blocks = -1
    end if
    close (unit)
    if (.not. journal%is_open) return
    call shorten_file(journal%path, next - 1)
    inquire (file=journal%path, size=bytes)
    call open_output(journal%path, journal%file, journal%error, at_end=.true.)
    ! What followed bytes that are no block would be lost.
    if (.not. allocated(journal%error) .and. bytes /= next - 1) call set_error(journal%error, &
      error_of_files, "what is behind its last block cannot be cut off", journal%path)
  end subroutine read_journal

  !> Takes the blocks of a complete journal of another run, which is only read.
  subroutine add_journal_file(journal, path, is_whole)
    type(journal_t), intent(inout) :: journal !! opened
    character(len=*), intent(in) :: path      !! of the file
    logical, intent(out) :: is_whole          !! whether it has the title of the journal and ends
                                              !! with a complete block

    character(len=:), allocatable :: title
    integer(long) :: next, bytes
    integer :: unit, status

    is_whole = .false.
    open (newunit=unit, file=path, status="old", action="read", access="stream", &
      form="unformatted", iostat=status)
    if (status /= 0) return
    call read_title_of(unit, title)
    if (is_title(journal, title)) then
      call append_string(journal%files, path)
      call read_blocks(journal, unit, size(journal%files), next)
      inquire (unit=unit, size=bytes)
      is_whole = next == bytes + 1
    end if
    close (unit)
  end subroutine add_journal_file

  !> Adds the complete blocks of a file to the list.
  subroutine read_blocks(journal, unit, file, next)
    type(journal_t), intent(inout) :: journal
    integer, intent(in) :: unit         !! open, its title read
    integer, intent(in) :: file         !! its number; 0: the journal itself
    integer(long), intent(out) :: next  !! place after the last complete block

    integer(long) :: bytes, place
    integer :: mark(marks), end_mark(marks), status

    inquire (unit=unit, size=bytes)
    inquire (unit=unit, pos=next)
    journal%is_sorted = .false.
    do
      read (unit, pos=next, iostat=status) mark
      if (status /= 0) exit
      if (any(mark(:2) < 0) .or. mark(3) <= 0) exit
      place = next + mark_bytes
      if (place + mark(3) + mark_bytes - 1 > bytes) exit
      read (unit, pos=place + mark(3), iostat=status) end_mark
      if (status /= 0 .or. any(end_mark /= mark)) exit
      call add_block(journal, block_t(mark(:2), mark(3), file, place))
      next = place + mark(3) + mark_bytes
    end do
  end subroutine read_blocks

  pure subroutine add_block(journal, block)
    type(journal_t), intent(inout) :: journal
    type(block_t), intent(in) :: block

    type(block_t), allocatable :: larger(:)

    if (journal%blocks == size(journal%list)) then
      allocate (larger(2*size(journal%list)))
      larger(:size(journal%list)) = journal%list
      call move_alloc(larger, journal%list)
    end if
    journal%blocks = journal%blocks + 1
    journal%list(journal%blocks) = block
  end subroutine add_block

  !> Returns the bytes of a task that an earlier run did, if they are as it wrote them.
  subroutine recall_task(journal, task, bytes, found)
    type(journal_t), intent(inout) :: journal           !! opened
    integer, intent(in) :: task(2)                      !! group and number
    character(len=:), allocatable, intent(out) :: bytes !! what the task gave; not allocated if it
                                                        !! is not in the journal
    logical, intent(out) :: found                       !! whether the bytes could be read

    integer :: mark(marks), unit, status

    found = has_task(journal, task)
    if (.not. found) return
    associate (block => journal%list(journal%last))
      call find_unit(journal, block%file, unit)
      allocate (character(len=block%length) :: bytes)
      read (unit, pos=block%place - mark_bytes, iostat=status) mark, bytes
    end associate
    found = status == 0
    if (found) found = mark(marks) == checksum_of(bytes)
  end subroutine recall_task

  !> A sum that tells bytes from those in which some are changed: two sums of words, the second of
  !! the first (J. G. Fletcher, IEEE Trans. Commun. 30, 1982).
  pure function checksum_of(bytes) result(sum)
    character(len=*), intent(in) :: bytes
    integer :: sum

    integer(long), parameter :: modulus = 2_long**31 - 1, least = 2_long**31
    !> As many words as the second sum has room for.
    integer, parameter :: piece = 1024, word = storage_size(1)/8
    integer :: words(piece), first, count, i
    integer(long) :: sums(2)

    sums = 1
    do first = 1, len(bytes), piece*word
      count = min(piece*word, len(bytes) - first + 1)
      words = 0
      words(:count/word) = transfer(bytes(first:first + count - 1), words, count/word)
      ! The last bytes are no whole word.
      do i = count - modulo(count, word) + 1, count
        words(count/word + 1) = 256*words(count/word + 1) + iachar(bytes(first + i - 1:first + i &
          - 1))
      end do
      do i = 1, (count + word - 1)/word
        sums(1) = sums(1) + words(i) + least
        sums(2) = sums(2) + sums(1)
      end do
      sums = modulo(sums, modulus)
    end do
    sum = int(ieor(sums(1), modulo(sums(2)*65599_long, modulus)))
  end function checksum_of

  !> Whether the results of a task are in the journal.
  function has_task(journal, task) result(has)
    type(journal_t), intent(inout) :: journal !! opened
    integer, intent(in) :: task(2)            !! group and number
    logical :: has

    integer :: low, high, middle

    has = .false.
    if (journal%blocks == 0) return
    if (.not. journal%is_sorted) call sort_blocks(journal)
    ! Tasks are requested nearly in their order.
    high = min(journal%last + 1, journal%blocks)
    if (any(journal%list(high)%task /= task)) then
      low = 1
      high = journal%blocks
      do while (low < high)
        middle = (low + high)/2
        if (is_before(journal%list(middle)%task, task)) then
          low = middle + 1
        else
          high = middle
        end if
      end do
    end if
    has = all(journal%list(high)%task == task)
    if (has) journal%last = high
  end function has_task

  pure logical function is_before(a, b)
    integer, intent(in) :: a(2), b(2) !! group and number

    is_before = a(1) < b(1)
    if (a(1) == b(1)) is_before = a(2) < b(2)
  end function is_before

  !> Sorts the list by groups and numbers.
  pure subroutine sort_blocks(journal)
    type(journal_t), intent(inout) :: journal

    ! More than any number of a task: as a real number, a group and a number are exact.
    real(wp), parameter :: numbers = 2.0_wp**32
    integer, allocatable :: order(:)

    associate (list => journal%list(:journal%blocks))
      order = ascending_order(list%task(1)*numbers + list%task(2))
      list = list(order)
    end associate
    journal%is_sorted = .true.
    journal%last = 0
  end subroutine sort_blocks

  !> The unit from which a file is read: one is open at a time, for there may be thousands.
  subroutine find_unit(journal, file, unit)
    type(journal_t), intent(inout) :: journal
    integer, intent(in) :: file  !! its number; 0: the journal itself
    integer, intent(out) :: unit !! an error of opening shows when it is read

    character(len=:), allocatable :: path
    integer :: status

    if (journal%open_file /= file) then
      call close_reader(journal)
      path = journal%path
      if (file > 0) path = journal%files(file)%text
      open (newunit=journal%reader, file=path, status="old", action="read", access="stream", &
        form="unformatted", iostat=status)
      journal%open_file = file
    end if
    unit = journal%reader
  end subroutine find_unit

  !> Whether results of tasks are to be kept: only once the run has lasted `least_time`. Begins the
  !! journal then.
  function keeps_tasks(journal) result(keeps)
    type(journal_t), intent(inout) :: journal !! opened
    logical :: keeps

    integer(long) :: now, rate

    keeps = .false.
    if (journal%only_read .or. .not. allocated(journal%path)) return
    if (.not. journal%is_open) then
      call system_clock(now, rate)
      if (.not. journal%stays .and. &
        real(now - journal%clock, wp) < least_time*real(rate, wp)) return
      call begin_journal(journal)
    end if
    keeps = .not. (allocated(journal%error) .or. is_failing(journal%file))
  end function keeps_tasks

  !> Appends the bytes of a task. If they cannot be written, the run continues without a journal.
  subroutine keep_task(journal, task, bytes)
    type(journal_t), intent(inout) :: journal !! opened
    integer, intent(in) :: task(2)            !! group and number
    type(text_buffer_t), intent(in) :: bytes  !! what the task gave

    character(len=mark_bytes) :: mark
    integer(long) :: now, rate

    if (.not. keeps_tasks(journal)) return
    mark = transfer([task, bytes%length, checksum_of(bytes%storage(:bytes%length))], mark)
    call append_output(journal%file, mark)
    call append_output(journal%file, bytes%storage(:bytes%length))
    call append_output(journal%file, mark)
    journal%kept = journal%kept + 1
    call system_clock(now, rate)
    if (real(now - journal%clock, wp) < flush_time*real(rate, wp)) return
    call pass_on_output(journal%file)
    journal%clock = now
  end subroutine keep_task

  subroutine begin_journal(journal)
    type(journal_t), intent(inout) :: journal

    character(len=storage_size(1)/8) :: length

    journal%is_open = .true.
    call open_output(journal%path, journal%file, journal%error)
    if (allocated(journal%error)) return
    length = transfer(len(journal%title), length)
    journal%first = len(length) + len(journal%title) + 1
    call append_output(journal%file, length//journal%title)
  end subroutine begin_journal

  !> Closes the journal of an interrupted run.
  subroutine close_journal(journal, blocks)
    type(journal_t), intent(inout) :: journal !! opened, or not begun
    integer, intent(out) :: blocks            !! in it for a run that resumes; 0: nothing to resume
                                              !! from

    type(error_t), allocatable :: error
    integer(long) :: bytes

    blocks = 0
    call close_reader(journal)
    if (.not. journal%is_open .or. allocated(journal%error)) return
    call finish_output(journal%file, journal%path, error)
    journal%is_open = .false.
    if (.not. allocated(error)) blocks = journal%blocks + journal%kept
    ! On a full disk there may be a file without a block.
    inquire (file=journal%path, size=bytes)
    if (bytes < journal%first) call remove_file(journal%path)
  end subroutine close_journal

  !> Puts a journal that stays in place, complete.
  !!
  !! Errors: not all of it is on the disk, or it cannot be renamed.
  subroutine publish_journal(journal, error)
    type(journal_t), intent(inout) :: journal !! with all tasks
    type(error_t), allocatable, intent(out) :: error

    character(len=:), allocatable :: path
    logical :: done

    call close_reader(journal)
    path = journal%path(:len(journal%path) - len(begun))
    if (allocated(journal%error)) then
      error = journal%error
      return
    end if
    call finish_output(journal%file, path, error)
    journal%is_open = .false.
    if (allocated(error)) return
    call rename_file(journal%path, path, done)
    if (.not. done) call set_error(error, error_of_files, "the file cannot be put in place: "// &
      system_reason(), path)
  end subroutine publish_journal

  !> Closes and deletes the journal of a finished run.
  subroutine remove_journal(journal)
    type(journal_t), intent(inout) :: journal !! opened, or not begun

    call close_reader(journal)
    call close_output(journal%file)
    journal%is_open = .false.
    if (allocated(journal%path)) call remove_file(journal%path)
  end subroutine remove_journal

  !> Closes the file that is read.
  subroutine close_reader(journal)
    type(journal_t), intent(inout) :: journal

    if (journal%open_file >= 0) close (journal%reader)
    journal%open_file = -1
  end subroutine close_reader

end module task_journal
