!> What a job is: tasks that are independent of each other, such as the blocks of a long sweep or
!! the variants of a deck, whose results are put together in the order of the tasks.
module jobs
  use errors, only: error_t
  use text_buffer, only: text_buffer_t
  implicit none (type, external)
  private

  public :: job_t

  !> What the tasks of a job do. `run` may be called for several tasks at the same time; all other
  !! procedures are called for one task at a time. A task that could not be done packs nothing.
  type, abstract :: job_t
    type(error_t), allocatable :: error !! set by `finish`: no more tasks are begun
    character(len=:), allocatable :: announcement !! by which other ranks make the same job and help
                                                  !! (`rank_service`); not allocated: they do not
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

end module jobs
