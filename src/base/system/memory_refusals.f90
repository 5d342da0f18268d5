!> What is said when the system refuses memory, and the end of the program.
!!
!! The compiler's library ends it with words on a line of the sources. Procedures of its names here
!! take their place when the program is linked; they may not return, so that this is the only end
!! besides that in `main`. The run's folder keeps the files of an earlier run, and the journal.
module memory_refusals
  use, intrinsic :: iso_c_binding, only: c_int, c_long, c_null_ptr, c_ptr, c_size_t
  use, intrinsic :: iso_fortran_env, only: int8
  use system_calls, only: c_exit_at_once, c_write
  implicit none (type, external)
  private

  public :: require_memory, refuse_allocation, refuse_memory

  character(len=*), parameter :: words = "flexmech: error: the system refuses more memory; "// &
    "nothing was written, and an earlier run's files are untouched: expected fewer --threads, "// &
    "positions, speeds or modes, or a higher limit (ulimit -v)"//achar(10)

contains

  !> Ends the program unless the system still gives so much memory. Assignments of polymorphic
  !! components do not check what they are given (gfortran 12), and stop with a signal.
  subroutine require_memory(bytes)
    integer, intent(in) :: bytes !! number

    ! Or it is found out that nothing uses the memory.
    integer(int8), allocatable, volatile :: room(:)
    integer :: status

    allocate (room(bytes), stat=status)
    if (status /= 0) call refuse_memory(c_null_ptr)
  end subroutine require_memory

  !> In place of the library's end after ALLOCATE.
  subroutine refuse_allocation(place, message) bind(c, name="_gfortran_os_error_at")
    type(c_ptr), value :: place, message !! of the library: where in the sources, how many bytes

    call refuse_memory(message)
  end subroutine refuse_allocation

  !> In place of its end elsewhere.
  subroutine refuse_memory(message) bind(c, name="_gfortran_os_error")
    type(c_ptr), value :: message

    integer(c_int), parameter :: standard_error = 2_c_int, failure = 1_c_int
    integer(c_long) :: written

    ! Other threads may be refused memory, too: one speaks.
    !$omp critical (memory_is_refused)
    written = c_write(standard_error, words, len(words, c_size_t))
    call c_exit_at_once(failure)
    !$omp end critical (memory_is_refused)
  end subroutine refuse_memory

end module memory_refusals
