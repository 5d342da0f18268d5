!> The memory that a run will take, estimated before it takes any.
!!
!! The estimate is on the safe side. It adds up the sizes of the data that are kept, and constants
!! measured with the peak memory of the process.
module memory_needs
  use available_memory, only: available_memory_t, memory_text
  use diagnostics, only: add_error, diagnostics_t
  use errors, only: error_of_memory
  use kept_positions, only: positions_kept
  use kinds, only: wp
  use models, only: model_t
  use study_list, only: list_studies
  use study_types, only: add_need, bytes_of_number, memory_needs_t, study_t
  use text, only: plural
  use tokens, only: token_t
  implicit none (type, external)
  private

  public :: memory_of_run, check_memory

  !> Bytes of a pose with its kinematic coefficients, of a position in a list that comes in blocks,
  !! and that every run takes; factor for memory that is wasted between allocated pieces.
  real(wp), parameter :: of_pose = 1050.0_wp, of_listed = 80.0_wp, of_process = 1.0e7_wp, &
    spare = 1.1_wp

contains

  !> Compares the estimated memory with the available memory.
  !!
  !! Errors: the run needs more; the message points at the card that requests most of it.
  subroutine check_memory(model, threads, available, diagnostics)
    type(model_t), intent(in) :: model                !! without errors so far
    integer, intent(in) :: threads                    !! that will compute it
    type(available_memory_t), intent(in) :: available !! on this machine
    type(diagnostics_t), intent(inout) :: diagnostics !! to which the error is appended

    type(memory_needs_t) :: needs
    character(len=:), allocatable :: of_all
    real(wp) :: total
    integer :: most

    call memory_of_run(model, threads, needs)
    total = of_process + spare*sum(needs%list%bytes)
    if (total <= available%bytes) return
    most = maxloc(needs%list%bytes, dim=1)
    of_all = ""
    if (needs%list(most)%bytes < 0.8_wp*total) of_all = " of "//memory_text(total)//" in all"
    call add_error(diagnostics, needs%list(most)%place, needs%list(most)%what//" need "// &
      memory_text(needs%list(most)%bytes)//of_all//", and "//available%clause, kind=error_of_memory)
  end subroutine check_memory

  !> The memory of all parts of a run.
  subroutine memory_of_run(model, threads, needs)
    type(model_t), intent(in) :: model         !! without errors
    integer, intent(in) :: threads             !! that will compute it
    type(memory_needs_t), intent(out) :: needs

    type(study_t), allocatable :: studies(:)
    type(token_t) :: place
    integer :: i

    needs%threads = threads
    allocate (needs%list(0))
    place = model%reports(1)%keyword
    if (size(model%crank%words) > 0) place = model%crank%words(1)
    needs%kept = positions_kept(model)
    associate (positions => size(model%crank%value), kept => needs%kept, &
        numbers => sum(model%reports%kind%numbers))
      call add_need(needs, place, "the results at "//plural(positions, "position"), &
        (positions - kept)*of_listed + kept*(of_pose + bytes_of_number*numbers))
    end associate
    call list_studies(studies)
    do i = 1, size(studies)
      if (associated(studies(i)%add_memory)) call studies(i)%add_memory(model, needs)
    end do
  end subroutine memory_of_run

end module memory_needs
