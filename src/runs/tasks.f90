!> Tasks of a job: distributed to threads, finished in order.
!!
!! The tasks of a job are independent of each other: the blocks of a long sweep, the variants of a
!! deck. A task that an earlier run has done is not done again: its bytes come from the journal,
!! and those of a new one are added to it. Another way to distribute tasks (to other machines, say)
!! is another procedure beside `run_tasks`; jobs need not change.
module tasks
  use errors, only: error_t
  use interruption, only: was_interrupted
  use task_journal, only: journal_t, keep_task, keeps_tasks, recall_task
  use text_buffer, only: text_buffer_t
  implicit none (type, external)
  private

  public :: job_t, run_tasks

  !> What the tasks of a job do. `run` may be called for several tasks at the same time; all other
  !! procedures are called for one task at a time. A task that could not be done packs nothing.
  type, abstract :: job_t
    type(error_t), allocatable :: error !! set by `finish`: no more tasks are begun
  contains
    procedure(task_interface), deferred :: run      !! does a task; its results stay in the job
    procedure(pack_interface), deferred :: pack     !! appends the results of a task as bytes
    procedure(unpack_interface), deferred :: unpack !! restores them, as if the task had been done
    procedure(task_interface), deferred :: finish   !! is called in the order of the tasks
  end type job_t

  abstract interface
    subroutine task_interface(self, number)
      import :: job_t
      class(job_t), intent(inout) :: self !! with the task's results, or room for them
      integer, intent(in) :: number       !! of the task
    end subroutine task_interface

    subroutine pack_interface(self, number, bytes)
      import :: job_t, text_buffer_t
      class(job_t), intent(in) :: self            !! with the task's results
      integer, intent(in) :: number               !! of the task
      type(text_buffer_t), intent(inout) :: bytes !! to which they are appended
    end subroutine pack_interface

    subroutine unpack_interface(self, number, bytes)
      import :: job_t
      class(job_t), intent(inout) :: self   !! with room for the task's results
      integer, intent(in) :: number         !! of the task
      character(len=*), intent(in) :: bytes !! of `pack`
    end subroutine unpack_interface
  end interface

contains

  !> Does the tasks of a job on several threads, and finishes them in their order. After an
  !! interruption or an error some tasks are not done; the error is that of the first task that
  !! failed.
  subroutine run_tasks(job, first, last, threads, journal, group)
    class(job_t), intent(inout) :: job        !! with room for the results; its `error` is set if a
                                              !! task fails
    integer, intent(in) :: first, last        !! numbers of the tasks
    integer, intent(in) :: threads            !! number to use
    type(journal_t), intent(inout) :: journal !! of the run
    integer, intent(in) :: group              !! of these tasks in the journal, from 0; below 0:
                                              !! they are not kept

    logical :: done(first:last), over, is_over
    integer :: number, next

    done = .false.
    over = .false.
    next = first
    !$omp parallel do num_threads(threads) schedule(dynamic) default(shared) &
    !$omp& private(number, is_over)
    do number = first, last
      if (was_interrupted()) cycle
      !$omp atomic read
      is_over = over
      if (is_over) cycle
      call do_task(job, number, journal, group)
      if (was_interrupted()) cycle
      !$omp critical (one_at_a_time)
      done(number) = .true.
      do while (next <= last .and. .not. allocated(job%error))
        if (.not. done(next)) exit
        call job%finish(next)
        next = next + 1
      end do
      if (allocated(job%error)) then
        !$omp atomic write
        over = .true.
      end if
      !$omp end critical (one_at_a_time)
    end do
    !$omp end parallel do
  end subroutine run_tasks

  !> Does a task, or restores its results from the journal.
  subroutine do_task(job, number, journal, group)
    class(job_t), intent(inout) :: job
    integer, intent(in) :: number
    type(journal_t), intent(inout) :: journal
    integer, intent(in) :: group

    character(len=:), allocatable :: recalled
    type(text_buffer_t) :: bytes
    logical :: found

    found = .false.
    if (group >= 0) then
      !$omp critical (one_at_a_time)
      call recall_task(journal, [group, number], recalled, found)
      if (found) call job%unpack(number, recalled)
      !$omp end critical (one_at_a_time)
    end if
    if (found) return
    call job%run(number)
    if (group < 0 .or. was_interrupted()) return
    !$omp critical (one_at_a_time)
    if (keeps_tasks(journal)) then
      call job%pack(number, bytes)
      if (bytes%length > 0) call keep_task(journal, [group, number], bytes)
    end if
    !$omp end critical (one_at_a_time)
  end subroutine do_task

end module tasks
