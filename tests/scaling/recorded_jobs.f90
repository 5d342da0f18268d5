!> A job that measures another one.
module recorded_jobs
  use byte_streams, only: byte_stream_t
  use jobs, only: job_t
  use kinds, only: wp
  use omp_lib, only: omp_get_wtime
  implicit none (type, external)
  private

  public :: recorded_job_t

  type, extends(job_t) :: recorded_job_t
    class(job_t), pointer :: inner => null()
    real(wp), allocatable :: computing(:) !! (tasks) until the bytes are ready [s]
    real(wp), allocatable :: writing(:)   !! (tasks) bytes restored and written [s]
    integer, allocatable :: bytes(:)      !! (tasks)
  contains
    procedure :: run
    procedure :: pass
    procedure :: finish
  end type recorded_job_t

contains

  !> Does a task, and all that another rank and the leader would do with its bytes.
  subroutine run(self, number)
    class(recorded_job_t), intent(inout) :: self
    integer, intent(in) :: number

    type(byte_stream_t) :: stream, second
    real(wp) :: start

    start = omp_get_wtime()
    call self%inner%run(number)
    call self%inner%pass(number, stream)
    self%computing(number) = omp_get_wtime() - start
    self%bytes(number) = stream%bytes%length
    start = omp_get_wtime()
    call second%open(stream%bytes%storage(:stream%bytes%length))
    call self%inner%pass(number, second)
    self%writing(number) = omp_get_wtime() - start
  end subroutine run

  subroutine pass(self, number, stream)
    class(recorded_job_t), intent(inout) :: self
    integer, intent(in) :: number
    type(byte_stream_t), intent(inout) :: stream

    call self%inner%pass(number, stream)
  end subroutine pass

  subroutine finish(self, number)
    class(recorded_job_t), intent(inout) :: self
    integer, intent(in) :: number

    real(wp) :: start

    start = omp_get_wtime()
    call self%inner%finish(number)
    self%writing(number) = self%writing(number) + omp_get_wtime() - start
  end subroutine finish

end module recorded_jobs
