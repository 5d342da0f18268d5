!> Tasks of a job: distributed to threads, and to other ranks that help; finished in order.
!!
!! A task that an earlier run has done is not done again: its bytes come from the journal, and those
!! of a new one are added to it. A single process is a rank without others.
module tasks
  use jobs, only: job_t
  use omp_lib, only: omp_get_thread_num
  use pauses, only: pause_for
  use rank_tasks, only: announce_job, has_help, look_again, serve_ranks
  use interruption, only: was_interrupted
  use task_journal, only: journal_t
  use task_pool, only: deliver_task, is_exhausted, keep_done_task, new_task_pool, take_tasks, &
    task_pool_t
  implicit none (type, external)
  private

  public :: run_tasks

contains

  !> Does the tasks of a job on several threads, and finishes them in their order. Other ranks help
  !! if the job is announced to them. After an interruption or an error some tasks are not done; the
  !! error is that of the first task that failed.
  subroutine run_tasks(job, first, last, threads, journal, group, window)
    class(job_t), intent(inout) :: job        !! with room for the results; its `error` is set if a
                                              !! task fails
    integer, intent(in) :: first, last        !! numbers of the tasks
    integer, intent(in) :: threads            !! number to use, on every rank
    type(journal_t), intent(inout) :: journal !! of the run
    integer, intent(in) :: group              !! of these tasks in the journal, from 0; below 0:
                                              !! they are not kept
    integer, intent(in), optional :: window   !! tasks for whose results the job has room; absent:
                                              !! all

    type(task_pool_t) :: pool
    integer :: room
    logical :: helped

    room = last - first + 1
    if (present(window)) room = min(room, window)
    if (room < 1) return
    pool = new_task_pool(first, last, group, room)
    helped = has_help(job) .and. last > first
    if (helped) call announce_job(job, threads)
    !$omp parallel num_threads(merge(threads + 1, threads, helped)) default(shared)
    ! The first thread, which may always call MPI, serves the others; when it has nothing to do, it
    ! sleeps.
    if (helped .and. omp_get_thread_num() == 0) then
      call serve_ranks(pool, job, journal, threads)
    else
      call do_tasks(pool, job, journal)
    end if
    !$omp end parallel
  end subroutine run_tasks

  !> Does tasks, one after another, until none is left.
  subroutine do_tasks(pool, job, journal)
    type(task_pool_t), intent(inout) :: pool
    class(job_t), intent(inout) :: job
    type(journal_t), intent(inout) :: journal

    integer :: first, last
    logical :: none_left

    do
      !$omp critical (one_at_a_time)
      call take_tasks(pool, job, journal, 1, first, last)
      none_left = is_exhausted(pool, job)
      !$omp end critical (one_at_a_time)
      if (first > last) then
        if (none_left) exit
        ! Results of others have to be finished before there is room for more.
        call pause_for(look_again)
        cycle
      end if
      call job%run(first)
      if (was_interrupted()) exit
      !$omp critical (one_at_a_time)
      call keep_done_task(pool, job, journal, first)
      call deliver_task(pool, job, first)
      !$omp end critical (one_at_a_time)
    end do
  end subroutine do_tasks

end module tasks
