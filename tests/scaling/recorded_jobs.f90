!> A job that measures another one.
module recorded_jobs
  use jobs, only: job_t
  use kinds, only: wp
  use omp_lib, only: omp_get_wtime
  use text_buffer, only: text_buffer_t
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
    procedure :: pack
    procedure :: unpack
    procedure :: finish
  end type recorded_job_t

contains

  !> Does a task, and all that another rank and the leader would do with its bytes.
  subroutine run(self, number)
    class(recorded_job_t), intent(inout) :: self
    integer, intent(in) :: number

    type(text_buffer_t) :: bytes
    real(wp) :: start

    start = omp_get_wtime()
    call self%inner%run(number)
    call self%inner%pack(number, bytes)
    self%computing(number) = omp_get_wtime() - start
    self%bytes(number) = bytes%length
    start = omp_get_wtime()
    call self%inner%unpack(number, bytes%storage(:bytes%length))
    self%writing(number) = omp_get_wtime() - start
  end subroutine run

  subroutine pack(self, number, bytes)
    class(recorded_job_t), intent(in) :: self
    integer, intent(in) :: number
    type(text_buffer_t), intent(inout) :: bytes

    call self%inner%pack(number, bytes)
  end subroutine pack

  subroutine unpack(self, number, bytes)
    class(recorded_job_t), intent(inout) :: self
    integer, intent(in) :: number
    character(len=*), intent(in) :: bytes

    call self%inner%unpack(number, bytes)
  end subroutine unpack

  subroutine finish(self, number)
    class(recorded_job_t), intent(inout) :: self
    integer, intent(in) :: number

    real(wp) :: start

    start = omp_get_wtime()
    call self%inner%finish(number)
    self%writing(number) = self%writing(number) + omp_get_wtime() - start
  end subroutine finish

end module recorded_jobs
