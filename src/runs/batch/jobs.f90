! src/runs/batch/ - many tasks on threads, ranks and in several runs; the journal of what is done.
! In: a `job_t` with numbered tasks. Out: their results, finished in the order of the tasks, whoever
! did them. Begin with `run_tasks` in `tasks.f90`, then `run_variant_tasks` in `variant_tasks.f90`,
! `open_journal` in `task_journal.f90`. Other ranks begin with `serve_leader` in `rank_service.f90`.
! Parts of a study: `read_parts` in `part_files.f90`.
! Not here: MPI (`src/base/system/ranks.f90`), what a variant computes
! (`src/runs/variant_runs.f90`).

!> What a job is: tasks that are independent of each other, such as the blocks of a long sweep or
!! the variants of a deck, whose results are put together in the order of the tasks.
module jobs
  use byte_streams, only: byte_stream_t
  use errors, only: error_t
  implicit none (type, external)
  private

  public :: job_t

  !> What the tasks of a job do. `run` may be called for several tasks at the same time; all other
  !! procedures are called for one task at a time. A task that could not be done writes nothing.
  type, abstract :: job_t
    type(error_t), allocatable :: error !! set by `finish`: no more tasks are begun
    character(len=:), allocatable :: announcement !! by which other ranks make the same job and help
                                                  !! (`rank_service`); not allocated: they do not
  contains
    procedure(task_interface), deferred :: run      !! does a task; its results stay in the job
    procedure(pass_interface), deferred :: pass     !! passes the results of a task; read, they
                                                    !! are as if it had been done
    procedure(task_interface), deferred :: finish   !! is called in the order of the tasks
  end type job_t

  abstract interface
    subroutine task_interface(self, number)
      import :: job_t
      class(job_t), intent(inout) :: self !! with the task's results, or room for them
      integer, intent(in) :: number       !! of the task
    end subroutine task_interface

    subroutine pass_interface(self, number, stream)
      import :: byte_stream_t, job_t
      class(job_t), intent(inout) :: self          !! with the task's results, or room for them
      integer, intent(in) :: number                !! of the task
      type(byte_stream_t), intent(inout) :: stream !! to which they are appended, or that has them
    end subroutine pass_interface
  end interface

end module jobs
