!> The Campbell diagram of the speeds of a deck.
module campbell_study
  use campbell, only: find_campbell
  use campbell_types, only: campbell_t
  use errors, only: error_of_reach, error_t, set_error
  use full_turns, only: turns_fully
  use kept_results, only: keeper_t
  use link_store, only: link_store_t
  use stability_study, only: of_vibrating_bodies
  use stability_types, only: stability_request_t
  use structures, only: structure_t
  implicit none (type, external)
  private

  public :: find_campbell_of

contains

  !> The diagram. What prevents it at all speeds fails each of them.
  subroutine find_campbell_of(structure, request, threads, store, found, keeper)
    class(structure_t), intent(in) :: structure      !! linkage and beams
    type(stability_request_t), intent(in) :: request !! speeds of one sign, modes, accuracy
    integer, intent(in) :: threads                   !! number of OpenMP threads
    type(link_store_t), intent(inout) :: store       !! links decomposed earlier
    type(campbell_t), intent(out) :: found           !! with a result or an error at every speed
    class(keeper_t), intent(inout), optional :: keeper !! of what is found on the way

    type(error_t), allocatable :: error
    integer :: k

    if (turns_fully(structure%linkage, through=.false.)) then
      call find_campbell(structure, of_vibrating_bodies(structure, request), threads, store, &
        found, error, keeper)
    else
      allocate (found%at_speed(size(request%speed)), found%critical(0), found%gap(0))
      call set_error(error, error_of_reach, "the crank does not turn fully, or meets a dead "// &
        "point: there is no steady motion")
    end if
    if (.not. allocated(error)) return
    do k = 1, size(request%speed)
      found%at_speed(k)%error = error
    end do
    if (.not. allocated(found%critical)) allocate (found%critical(0))
    if (.not. allocated(found%gap)) allocate (found%gap(0))
  end subroutine find_campbell_of

end module campbell_study
