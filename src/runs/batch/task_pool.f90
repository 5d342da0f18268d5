!> The tasks of a job on the rank that leads: which are to be handed out, which are done, whose turn
!! it is to be finished. One thread at a time may use a pool.
module task_pool
  use byte_streams, only: byte_stream_t
  use interruption, only: was_interrupted
  use jobs, only: job_t
  use task_journal, only: journal_t, keep_task, keeps_tasks, recall_task
  use text_buffer, only: text_buffer_t
  implicit none (type, external)
  private

  public :: task_pool_t, new_task_pool, take_tasks, keep_done_task, take_result, deliver_task, &
    is_exhausted, is_over, tasks_left

  type :: task_pool_t
    integer, private :: next = 1               !! first task that nobody has
    integer, private :: turn = 1               !! task to be finished next
    integer, private :: last = 0               !! number of the last task
    integer, private :: group = -1             !! in the journal; below 0: tasks are not kept
    logical, allocatable, private :: done(:)   !! (0: window − 1) tasks that wait for their turn, by
                                               !! their number modulo the window
  end type task_pool_t

contains

  !> A pool of tasks of which none is done.
  pure function new_task_pool(first, last, group, window) result(pool)
    integer, intent(in) :: first, last !! numbers of the tasks
    integer, intent(in) :: group       !! in the journal; below 0: they are not kept
    integer, intent(in) :: window      !! tasks that may be under way or wait for their turn
    type(task_pool_t) :: pool

    pool%next = first
    pool%turn = first
    pool%last = last
    pool%group = group
    allocate (pool%done(0:max(1, min(window, last - first + 1)) - 1))
    pool%done = .false.
  end function new_task_pool

  !> Takes tasks out of the pool. Those that the journal knows are done at once.
  subroutine take_tasks(pool, job, journal, most, first, last)
    type(task_pool_t), intent(inout) :: pool
    class(job_t), intent(inout) :: job        !! whose tasks they are
    type(journal_t), intent(inout) :: journal !! of the run
    integer, intent(in) :: most               !! number to take, at least 1
    integer, intent(out) :: first, last       !! numbers; last < first: none now

    type(byte_stream_t) :: stream
    character(len=:), allocatable :: recalled
    integer :: limit, number
    logical :: found

    do
      first = pool%next
      last = first - 1
      limit = min(pool%last, pool%turn + size(pool%done) - 1)
      if (is_over(job) .or. first > limit) return
      number = first
      do while (number < first + most .and. number <= limit)
        found = .false.
        if (pool%group >= 0) call recall_task(journal, [pool%group, number], recalled, found)
        if (found) exit
        number = number + 1
      end do
      last = number - 1
      pool%next = number
      if (number < first + most .and. number <= limit) then
        call stream%open(recalled)
        call job%pass(number, stream)
        pool%next = number + 1
        call deliver_task(pool, job, number)
      end if
      if (last >= first) return
    end do
  end subroutine take_tasks

  !> Adds the results of a task to the journal.
  subroutine keep_done_task(pool, job, journal, number)
    type(task_pool_t), intent(in) :: pool
    class(job_t), intent(inout) :: job        !! with the results
    type(journal_t), intent(inout) :: journal !! of the run
    integer, intent(in) :: number             !! of the task

    type(byte_stream_t) :: stream

    if (pool%group < 0) return
    if (.not. keeps_tasks(journal)) return
    call job%pass(number, stream)
    if (stream%bytes%length > 0) call keep_task(journal, [pool%group, number], stream%bytes)
  end subroutine keep_done_task

  !> Takes the results of a task that another rank has done, and adds them to the journal. If it
  !! could not be done there, it has been done again here: why is not in the bytes.
  subroutine take_result(pool, job, journal, number, results)
    type(task_pool_t), intent(inout) :: pool
    class(job_t), intent(inout) :: job        !! that gets the results
    type(journal_t), intent(inout) :: journal !! of the run
    integer, intent(in) :: number             !! of the task
    type(text_buffer_t), intent(in) :: results !! as bytes; empty: the job has them

    type(byte_stream_t) :: stream

    if (results%length > 0) then
      call stream%open(results%storage(:results%length))
      call job%pass(number, stream)
      if (pool%group >= 0) call keep_task(journal, [pool%group, number], results)
    end if
    call deliver_task(pool, job, number)
  end subroutine take_result

  !> Finishes a task that is done when its turn has come, and those that waited for it.
  subroutine deliver_task(pool, job, number)
    type(task_pool_t), intent(inout) :: pool
    class(job_t), intent(inout) :: job !! with the results
    integer, intent(in) :: number      !! of the task

    pool%done(modulo(number, size(pool%done))) = .true.
    do while (pool%turn <= pool%last .and. .not. allocated(job%error))
      associate (done => pool%done(modulo(pool%turn, size(pool%done))))
        if (.not. done) exit
        done = .false.
      end associate
      call job%finish(pool%turn)
      pool%turn = pool%turn + 1
    end do
  end subroutine deliver_task

  !> Whether nothing is to be handed out any more.
  function is_exhausted(pool, job) result(is)
    type(task_pool_t), intent(in) :: pool
    class(job_t), intent(in) :: job
    logical :: is

    is = pool%next > pool%last .or. is_over(job)
  end function is_exhausted

  !> Whether a job ends before its last task.
  function is_over(job) result(is)
    class(job_t), intent(in) :: job
    logical :: is

    is = allocated(job%error) .or. was_interrupted()
  end function is_over

  !> Number of tasks that may be handed out, now or later.
  pure function tasks_left(pool) result(left)
    type(task_pool_t), intent(in) :: pool
    integer :: left

    left = pool%last - pool%next + 1
  end function tasks_left

end module task_pool
