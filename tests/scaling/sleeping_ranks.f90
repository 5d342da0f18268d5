!> A farm whose ranks sleep instead of computing: the scheduler as it is, with recorded tasks.
!!
!!     mpirun -n RANKS sleeping_ranks RECORD SLOWER
!!
!! prints the ranks, and the time from the first task to the last one written, divided by SLOWER [s].
program sleeping_ranks
  use, intrinsic :: iso_fortran_env, only: output_unit
  use kinds, only: wp
  use omp_lib, only: omp_get_wtime
  use rank_tasks, only: await_message, help_with_tasks, topic_of_commands
  use ranks, only: end_ranks, leader, own_rank, rank_count, start_ranks
  use sleeping_jobs, only: new_sleeping_job, sleeping_job_t
  use task_journal, only: journal_t
  use tasks, only: run_tasks
  implicit none (type, external)

  character(len=1024) :: record, word
  character(len=:), allocatable :: command
  type(sleeping_job_t) :: job
  type(journal_t) :: no_journal
  real(wp) :: slower, start

  call start_ranks()
  call get_command_argument(1, record)
  call get_command_argument(2, word)
  read (word, *) slower
  call new_sleeping_job(trim(record), slower, job)
  if (own_rank() == leader) then
    job%announcement = ""
    start = omp_get_wtime()
    call run_tasks(job, 1, size(job%bytes), 1, no_journal, -1)
    write (output_unit, "(i5, f10.4)") rank_count(), (omp_get_wtime() - start)/slower
  else
    call await_message(topic_of_commands, command)
    call help_with_tasks(job, 1)
  end if
  call end_ranks()

end program sleeping_ranks
