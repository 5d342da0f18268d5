!> Tasks that other ranks do: the leader hands them out, each thread of the others asks for more
!! when it has sent its results.
!!
!! Tasks are handed out a few at a time, so many that they take some milliseconds, and before the
!! last ones are done: nobody waits for the leader.
module rank_tasks
  use byte_streams, only: byte_stream_t
  use interruption, only: interrupt, was_interrupted
  use jobs, only: job_t
  use kinds, only: wp
  use omp_lib, only: omp_get_thread_num, omp_get_wtime
  use pauses, only: pause_for
  use ranks, only: leader, own_rank, rank_count, receive_message, send_message
  use task_journal, only: journal_t
  use task_pool, only: is_exhausted, take_result, take_tasks, task_pool_t, tasks_left
  use text_buffer, only: append_text, text_buffer_t
  implicit none (type, external)
  private

  public :: has_help, announce_job, serve_ranks, help_with_tasks, await_message, drop_results, &
    send_stream
  public :: topic_of_commands, topic_of_farewells, look_again

  !> What messages are about: commands of the leader to a rank as a whole; results of a thread; that
  !! a rank ends; tasks for a thread, the first one of a rank, those of the others following.
  integer, parameter :: topic_of_commands = 1, topic_of_results = 2, topic_of_farewells = 3, &
    topic_of_tasks = 16

  !> Time after which somebody without work looks for some, and the longest if there is none for a
  !! while: a look costs some microseconds [s].
  real(wp), parameter :: look_again = 5.0e-5_wp, look_at_last = 1.0e-3_wp

  !> Time that tasks handed out together take [s]. Shorter ones are handed out before the last ones
  !! are done.
  real(wp), parameter :: portion = 2.0e-2_wp

  !> Threads of other ranks that help, as the leader knows them.
  type :: helpers_t
    integer :: threads = 0                  !! of a rank
    integer, allocatable :: portions(:)     !! (threads of all) portions that they have or wait for;
                                            !! 0: they have not asked yet, or been sent home
    integer, allocatable :: waiting(:)      !! (at least count) threads that wait, the longest
                                            !! first; a thread may be in it twice
    integer :: first = 1, count = 0         !! place of the first one; number of those that wait
    integer :: gone = 0                     !! threads that were sent home
    integer :: tasks = 0                    !! that they have done
    real(wp) :: time = 0.0_wp               !! that these took [s]
  end type helpers_t

contains

  !> Whether other ranks can help with a job.
  function has_help(job) result(has)
    class(job_t), intent(in) :: job
    logical :: has

    has = .false.
    if (allocated(job%announcement)) has = rank_count() > 1 .and. own_rank() == leader
  end function has_help

  !> Calls all other ranks to help with a job.
  subroutine announce_job(job, threads)
    class(job_t), intent(in) :: job !! with its announcement
    integer, intent(in) :: threads  !! number for every rank to use

    type(byte_stream_t) :: stream
    integer :: rank

    call stream%add(threads)
    call append_text(stream%bytes, job%announcement)
    do rank = 0, rank_count() - 1
      if (rank /= leader) call send_stream(rank, topic_of_commands, stream)
    end do
  end subroutine announce_job

  !> Serves all other ranks: takes their results and gives them tasks, until there are none left.
  subroutine serve_ranks(pool, job, journal, threads)
    type(task_pool_t), intent(inout) :: pool  !! shared with the leader's threads
    class(job_t), intent(inout) :: job        !! announced
    type(journal_t), intent(inout) :: journal !! of the run
    integer, intent(in) :: threads            !! of every rank

    type(helpers_t) :: helpers
    character(len=:), allocatable :: results
    real(wp) :: pause
    integer :: rank, thread
    logical :: found, is_idle

    pause = look_again
    helpers%threads = threads
    allocate (helpers%portions((rank_count() - 1)*threads), &
      helpers%waiting(2*(rank_count() - 1)*threads))
    helpers%portions = 0
    do while (helpers%gone < size(helpers%portions))
      is_idle = .true.
      do
        call receive_message(topic_of_results, rank, results, found)
        if (.not. found) exit
        is_idle = .false.
        call take_results(pool, job, journal, helpers, rank, results)
        call give_tasks(pool, job, journal, helpers)
      end do
      call give_tasks(pool, job, journal, helpers)
      if (was_interrupted()) exit
      if (is_idle) call pause_for(pause)
      pause = merge(min(2*pause, look_at_last), look_again, is_idle)
    end do
    ! Nobody waits for results that would not be used.
    do thread = 1, size(helpers%portions)
      if (was_interrupted()) call send_home(helpers, thread)
    end do
  end subroutine serve_ranks

  !> Takes the results of a portion. Its thread waits for more.
  subroutine take_results(pool, job, journal, helpers, rank, results)
    type(task_pool_t), intent(inout) :: pool
    class(job_t), intent(inout) :: job
    type(journal_t), intent(inout) :: journal
    type(helpers_t), intent(inout) :: helpers
    integer, intent(in) :: rank
    character(len=*), intent(in) :: results

    type(byte_stream_t) :: stream
    type(text_buffer_t) :: bytes
    real(wp) :: time
    integer :: head(3), number, thread

    call stream%open(results)
    call stream%pass(head)
    call stream%pass(time)
    thread = 1 + (rank - 1)*helpers%threads + head(1)
    if (head(3) < head(2)) then
      ! The first message of a thread has no results; so has the last one, if the thread stops.
      helpers%portions(thread) = 1
      if (head(2) < 0) call interrupt()
    end if
    helpers%tasks = helpers%tasks + head(3) - head(2) + 1
    helpers%time = helpers%time + time
    do number = head(2), head(3)
      call stream%pass_bytes(bytes)
      ! Not in the critical section, for a task may enter it.
      if (bytes%length == 0) call job%run(number)
      !$omp critical (one_at_a_time)
      if (.not. allocated(job%error)) call take_result(pool, job, journal, number, bytes)
      !$omp end critical (one_at_a_time)
    end do
    call let_wait(helpers, thread)
    if (helpers%portions(thread) == 1 .and. time_of_task(helpers) < portion) then
      helpers%portions(thread) = 2
      call let_wait(helpers, thread)
    end if
  end subroutine take_results

  !> Puts a thread at the end of those that wait.
  pure subroutine let_wait(helpers, thread)
    type(helpers_t), intent(inout) :: helpers
    integer, intent(in) :: thread

    helpers%waiting(1 + modulo(helpers%first + helpers%count - 1, size(helpers%waiting))) = thread
    helpers%count = helpers%count + 1
  end subroutine let_wait

  !> Average time of a task; before any is done, more than a portion takes [s].
  pure function time_of_task(helpers) result(time)
    type(helpers_t), intent(in) :: helpers
    real(wp) :: time

    time = 2*portion
    if (helpers%tasks > 0) time = helpers%time/helpers%tasks
  end function time_of_task

  !> Gives tasks to those that wait, as far as there are any; sends them home when all are given.
  subroutine give_tasks(pool, job, journal, helpers)
    type(task_pool_t), intent(inout) :: pool
    class(job_t), intent(inout) :: job
    type(journal_t), intent(inout) :: journal
    type(helpers_t), intent(inout) :: helpers

    integer :: first, last, thread, most
    logical :: none_left

    do while (helpers%count > 0)
      thread = helpers%waiting(helpers%first)
      !$omp critical (one_at_a_time)
      ! Towards the end portions become small, so that all end at the same time.
      most = min(int(portion/time_of_task(helpers)), tasks_left(pool)/(4*(size(helpers%portions) &
        + helpers%threads)))
      call take_tasks(pool, job, journal, max(1, most), first, last)
      none_left = is_exhausted(pool, job)
      !$omp end critical (one_at_a_time)
      if (first > last .and. .not. none_left) return
      helpers%first = 1 + modulo(helpers%first, size(helpers%waiting))
      helpers%count = helpers%count - 1
      if (first <= last) then
        call send_tasks(helpers, thread, first, last)
      else
        helpers%portions(thread) = helpers%portions(thread) - 1
        if (helpers%portions(thread) == 0) call send_home(helpers, thread)
      end if
    end do
  end subroutine give_tasks

  subroutine send_home(helpers, thread)
    type(helpers_t), intent(inout) :: helpers
    integer, intent(in) :: thread

    call send_tasks(helpers, thread, 0, -1)
    helpers%gone = helpers%gone + 1
  end subroutine send_home

  subroutine send_tasks(helpers, thread, first, last)
    type(helpers_t), intent(in) :: helpers
    integer, intent(in) :: thread, first, last

    type(byte_stream_t) :: stream

    call stream%add(first)
    call stream%add(last)
    call send_stream(1 + (thread - 1)/helpers%threads, topic_of_tasks + modulo(thread - 1, &
      helpers%threads), stream)
  end subroutine send_tasks

  !> Helps the leader with a job: does the tasks that it hands out, on several threads, and sends it
  !! their results, until it has no more.
  subroutine help_with_tasks(job, threads)
    class(job_t), intent(inout) :: job !! the same as that of the leader
    integer, intent(in) :: threads     !! number to use

    !$omp parallel num_threads(threads) default(shared)
    call help_on_thread(job, omp_get_thread_num())
    !$omp end parallel
  end subroutine help_with_tasks

  subroutine help_on_thread(job, thread)
    class(job_t), intent(inout) :: job
    integer, intent(in) :: thread !! from 0

    character(len=:), allocatable :: tasks
    type(byte_stream_t) :: stream, one, results
    integer :: bounds(2), number
    real(wp) :: start

    call send_results([thread, 1, 0], 0.0_wp, results)
    do
      call await_message(topic_of_tasks + thread, tasks)
      call stream%open(tasks)
      call stream%pass(bounds)
      if (bounds(2) < bounds(1)) exit
      results%bytes%length = 0
      start = omp_get_wtime()
      do number = bounds(1), bounds(2)
        call job%run(number)
        if (was_interrupted()) then
          call send_results([thread, -1, -2], 0.0_wp, one)
          return
        end if
        one%bytes%length = 0
        !$omp critical (one_at_a_time)
        call job%pass(number, one)
        !$omp end critical (one_at_a_time)
        call results%pass_bytes(one%bytes)
      end do
      call send_results([thread, bounds], omp_get_wtime() - start, results)
    end do
  end subroutine help_on_thread

  subroutine send_results(head, time, results)
    integer, intent(in) :: head(3) !! number of the thread, of the first and the last task
    real(wp), intent(in) :: time   !! that they took [s]
    type(byte_stream_t), intent(in) :: results

    type(byte_stream_t) :: stream
    integer :: numbers(3)
    real(wp) :: seconds

    numbers = head
    seconds = time
    call stream%pass(numbers)
    call stream%pass(seconds)
    if (head(3) >= head(2)) call append_text(stream%bytes, &
      results%bytes%storage(:results%bytes%length))
    call send_stream(leader, topic_of_results, stream)
  end subroutine send_results

  !> Sends what a stream has written.
  subroutine send_stream(rank, topic, stream)
    integer, intent(in) :: rank  !! of the receiver
    integer, intent(in) :: topic !! what it is about
    type(byte_stream_t), intent(in) :: stream

    call send_message(rank, topic, stream%bytes%storage(:stream%bytes%length))
  end subroutine send_stream

  !> Takes results that nobody needs any more, so that those who send them go on.
  subroutine drop_results()
    character(len=:), allocatable :: results
    integer :: rank
    logical :: found

    do
      call receive_message(topic_of_results, rank, results, found)
      if (.not. found) exit
    end do
  end subroutine drop_results

  !> Waits for the leader's next message on a topic.
  subroutine await_message(topic, bytes)
    integer, intent(in) :: topic                        !! what it is about
    character(len=:), allocatable, intent(out) :: bytes !! of the message

    real(wp) :: pause
    integer :: rank
    logical :: found

    pause = look_again
    do
      call receive_message(topic, rank, bytes, found)
      if (found) exit
      call pause_for(pause)
      pause = min(2*pause, look_at_last)
    end do
  end subroutine await_message

end module rank_tasks
