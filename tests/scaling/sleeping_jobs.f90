!> A job that sleeps as long as recorded tasks took, and gives as many bytes: so a machine of two
!! processors can be a farm of many ranks.
module sleeping_jobs
  use byte_streams, only: byte_stream_t
  use jobs, only: job_t
  use kinds, only: wp
  use pauses, only: pause_for
  use text_buffer, only: append_text
  implicit none (type, external)
  private

  public :: sleeping_job_t, new_sleeping_job

  type, extends(job_t) :: sleeping_job_t
    real(wp), allocatable :: computing(:) !! (tasks) of the rank that does it [s]
    real(wp), allocatable :: writing(:)   !! (tasks) of the leader [s]
    integer, allocatable :: bytes(:)      !! (tasks)
    real(wp) :: owed = 0.0_wp             !! of the leader, less than is worth a sleep [s]
  contains
    procedure :: run
    procedure :: pass
    procedure :: finish
  end type sleeping_job_t

  !> A sleep takes about this longer than it is asked for [s].
  real(wp), parameter :: overslept = 6.0e-5_wp

contains

  !> The tasks of a record, of which each takes `slower` times as long.
  subroutine new_sleeping_job(record, slower, job)
    character(len=*), intent(in) :: record !! path of a file by `record_tasks`
    real(wp), intent(in) :: slower
    type(sleeping_job_t), intent(out) :: job

    integer :: unit, status, count, round, bytes
    real(wp) :: computing, writing

    do round = 1, 2
      open (newunit=unit, file=record, status="old", action="read")
      read (unit, *)
      count = 0
      do
        read (unit, *, iostat=status) computing, bytes, writing
        if (status /= 0) exit
        count = count + 1
        if (round == 1) cycle
        job%computing(count) = slower*computing
        job%writing(count) = slower*writing
        job%bytes(count) = bytes
      end do
      close (unit)
      if (round == 1) allocate (job%computing(count), job%writing(count), job%bytes(count))
    end do
  end subroutine new_sleeping_job

  subroutine run(self, number)
    class(sleeping_job_t), intent(inout) :: self
    integer, intent(in) :: number

    call pause_for(max(0.0_wp, self%computing(number) - overslept))
  end subroutine run

  subroutine pass(self, number, stream)
    class(sleeping_job_t), intent(inout) :: self
    integer, intent(in) :: number
    type(byte_stream_t), intent(inout) :: stream

    if (.not. stream%reads) call append_text(stream%bytes, repeat("x", self%bytes(number)))
  end subroutine pass

  !> Many short times are slept at once.
  subroutine finish(self, number)
    class(sleeping_job_t), intent(inout) :: self
    integer, intent(in) :: number

    self%owed = self%owed + self%writing(number)
    if (self%owed < 10*overslept) return
    call pause_for(self%owed - overslept)
    self%owed = 0.0_wp
  end subroutine finish

end module sleeping_jobs
