!> The journal of a long run: what a run that was killed has computed, for the one that goes on with
!! `--resume`.
!!
!! Blocks of results are appended as they are done, each between two marks, so that a block that was
!! cut off is known for what it is. Results are kept to the last bit: a run that goes on writes the
!! same bytes as one that nobody disturbed. The first lines are the deck as it was understood, and
!! the program that computed it: a journal of anything else is not used.
module sweep_journal
  use file_system, only: joined_path, remove_file
  use kinds, only: long, wp
  use position_results, only: position_result_t
  use result_bytes, only: get_integers, get_result, put_integers, put_result
  use text_buffer, only: buffer_text, text_buffer_t
  implicit none (type, external)
  private

  public :: journal_t, open_journal, recall_block, keep_block, close_journal, remove_journal, &
    journal_name

  character(len=*), parameter :: journal_name = "resume.part"

  !> A run that takes less than this is not worth a journal [s].
  real(wp), parameter :: least_time = 0.25_wp

  !> Bytes are handed to the system after so much time: that much of a killed run is lost [s].
  real(wp), parameter :: flush_time = 0.25_wp

  !> A mark before and after every block: its variant, its number, its length in bytes.
  integer, parameter :: mark_bytes = 3*storage_size(1)/8

  type :: block_t
    integer :: variant = 0, number = 0, length = 0
    integer(long) :: place = 0_long !! of its first byte
  end type block_t

  type :: journal_t
    character(len=:), allocatable, private :: path
    character(len=:), allocatable, private :: title !! deck and program
    integer, private :: unit = -1
    logical, private :: is_open = .false.
    logical, private :: broken = .false.   !! it could not be written: the run goes on without
    integer, private :: blocks = 0         !! of the earlier run
    type(block_t), allocatable, private :: list(:)
    integer, private :: last = 0           !! block that was recalled last
    integer, private :: kept = 0           !! blocks of this run
    integer(long), private :: next = 0_long !! place of the next byte
    integer(long), private :: clock = 0_long !! when the run began, or bytes were last handed over
  end type journal_t

contains

  !> Opens the journal of an earlier run if there is one to go on with; else one is begun when the
  !! run turns out to be long.
  subroutine open_journal(folder, title, resume, journal, blocks)
    character(len=*), intent(in) :: folder
    character(len=*), intent(in) :: title !! what must be the same for results to be the same
    logical, intent(in) :: resume
    type(journal_t), intent(out) :: journal
    integer, intent(out) :: blocks        !! complete ones of the earlier run; -1 if it was of
                                          !! another deck or program

    blocks = 0
    journal%path = joined_path(folder, journal_name)
    journal%title = title
    allocate (journal%list(64))
    call system_clock(journal%clock)
    if (resume) call read_journal(journal, blocks)
    if (journal%is_open) return
    call remove_file(journal%path)
  end subroutine open_journal

  !> Finds the complete blocks of a journal, and what comes behind the last of them is written over.
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

  !> Notes the block that a mark speaks of behind those that are known; false if there is no room
  !! for it in the file.
  function enters(journal, mark, place, bytes)
    type(journal_t), intent(inout) :: journal
    character(len=*), intent(in) :: mark
    integer(long), intent(in) :: place, bytes
    logical :: enters

    type(block_t), allocatable :: larger(:)
    integer :: numbers(3), at

    at = 1
    call get_integers(mark, at, numbers)
    enters = all(numbers > 0)
    if (enters) enters = place + numbers(3) + mark_bytes - 1 <= bytes
    if (.not. enters) return
    if (journal%blocks == size(journal%list)) then
      allocate (larger(2*size(journal%list)))
      larger(:size(journal%list)) = journal%list
      call move_alloc(larger, journal%list)
    end if
    journal%list(journal%blocks + 1) = block_t(numbers(1), numbers(2), numbers(3), place)
  end function enters

  !> Gives the results of a block that the earlier run has computed.
  subroutine recall_block(journal, variant, number, states, results, found)
    type(journal_t), intent(inout) :: journal
    integer, intent(in) :: variant, number !! from 1
    integer, intent(in) :: states(:)       !! of the block: numbers in `results`
    type(position_result_t), intent(inout) :: results(:)
    logical, intent(out) :: found

    character(len=:), allocatable :: bytes
    integer :: i, k, at, status

    found = .false.
    do k = 1, journal%blocks
      ! Blocks are asked for nearly in the order in which they were kept.
      i = 1 + modulo(journal%last + k - 1, journal%blocks)
      associate (block => journal%list(i))
        if (block%variant /= variant .or. block%number /= number) cycle
        allocate (character(len=block%length) :: bytes)
        read (journal%unit, pos=block%place, iostat=status) bytes
      end associate
      if (status /= 0) return
      at = 1
      journal%last = i
      found = .true.
      exit
    end do
    if (.not. found) return
    do i = 1, size(states)
      call get_result(bytes, at, results(states(i)))
    end do
  end subroutine recall_block

  !> Appends a block of results, once the run has taken long enough.
  subroutine keep_block(journal, variant, number, states, results)
    type(journal_t), intent(inout) :: journal
    integer, intent(in) :: variant, number !! from 1
    integer, intent(in) :: states(:)       !! of the block: numbers in `results`
    type(position_result_t), intent(in) :: results(:)

    type(text_buffer_t) :: payload, mark
    integer(long) :: now, rate
    integer :: i, status

    if (journal%broken .or. .not. allocated(journal%path)) return
    call system_clock(now, rate)
    if (.not. journal%is_open) then
      if (real(now - journal%clock, wp) < least_time*real(rate, wp)) return
      call begin_journal(journal)
      if (journal%broken) return
    end if
    do i = 1, size(states)
      call put_result(payload, results(states(i)))
    end do
    call put_integers(mark, [variant, number, payload%length])
    write (journal%unit, pos=journal%next, iostat=status) buffer_text(mark), &
      payload%storage(:payload%length), buffer_text(mark)
    journal%broken = status /= 0
    if (journal%broken) return
    journal%next = journal%next + 2*mark%length + payload%length
    journal%kept = journal%kept + 1
    if (real(now - journal%clock, wp) < flush_time*real(rate, wp)) return
    flush (journal%unit, iostat=status)
    journal%clock = now
  end subroutine keep_block

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

  !> Closes the journal of a run that was interrupted, and tells how many blocks it holds for one
  !! that goes on.
  subroutine close_journal(journal, blocks)
    type(journal_t), intent(inout) :: journal
    integer, intent(out) :: blocks

    integer :: status

    blocks = 0
    if (.not. journal%is_open) return
    close (journal%unit, iostat=status)
    journal%is_open = .false.
    if (status == 0 .and. .not. journal%broken) blocks = journal%blocks + journal%kept
  end subroutine close_journal

  !> Removes the journal of a run that is done.
  subroutine remove_journal(journal)
    type(journal_t), intent(inout) :: journal

    integer :: status

    if (journal%is_open) close (journal%unit, iostat=status)
    journal%is_open = .false.
    if (allocated(journal%path)) call remove_file(journal%path)
  end subroutine remove_journal

end module sweep_journal
