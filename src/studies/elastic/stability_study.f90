! src/studies/elastic/ - studies of links that bend: frequencies, loci, response, stability.
! In: a `structure_t`, a request. Out: results, most of them of types in `src/vibration` and
! `src/response`. Begin with `find_stability_of` here, a short one, then `solve_block` in
! `frequency_study.f90`.
! Not here: elastic motions in time, which runs take from
! `src/response/transient/transient_responses.f90`.

!> Stability of the motion at all speeds of a deck.
module stability_study
  use instability_intervals, only: find_intervals
  use errors, only: error_of_reach, error_t, set_error
  use full_turns, only: turns_fully
  use kept_results, only: keeper_t
  use link_store, only: link_store_t
  use part_requests, only: dampings_of_parts
  use stability, only: find_stability
  use stability_types, only: gap_t, instability_t, intervals_t, stability_request_t, stability_t
  use structures, only: structure_t
  implicit none (type, external)
  private

  public :: find_stability_of, find_intervals_of, of_vibrating_bodies

  character(len=*), parameter :: no_motion = "the crank does not turn fully, or meets a dead "// &
    "point: there is no steady motion"

contains

  !> The exponents at every speed. What prevents them at all speeds fails each of them.
  subroutine find_stability_of(structure, request, threads, store, found, keeper)
    class(structure_t), intent(in) :: structure      !! linkage and beams
    type(stability_request_t), intent(in) :: request !! speeds, modes, accuracy
    integer, intent(in) :: threads                   !! number of OpenMP threads
    type(link_store_t), intent(inout) :: store       !! links decomposed earlier
    type(stability_t), intent(out) :: found          !! with a result or an error at every speed
    class(keeper_t), intent(inout), optional :: keeper !! of what is found on the way

    type(error_t), allocatable :: error
    integer :: k

    if (turns_fully(structure%linkage, through=.false.)) then
      call find_stability(structure, of_vibrating_bodies(structure, request), threads, store, &
        found, error, keeper)
    else
      allocate (found%at_speed(size(request%speed)))
      call set_error(error, error_of_reach, no_motion)
    end if
    if (.not. allocated(error)) return
    do k = 1, size(request%speed)
      found%at_speed(k)%error = error
    end do
  end subroutine find_stability_of

  !> The intervals of speed in which vibrations grow. What prevents them is a gap from the least to
  !! the greatest speed.
  subroutine find_intervals_of(structure, request, threads, store, found, keeper)
    class(structure_t), intent(in) :: structure      !! linkage and beams
    type(stability_request_t), intent(in) :: request !! range of speeds of one sign, modes,
                                                     !! accuracy, least growth
    integer, intent(in) :: threads                   !! number of OpenMP threads
    type(link_store_t), intent(inout) :: store       !! links decomposed earlier
    type(intervals_t), intent(out) :: found
    class(keeper_t), intent(inout), optional :: keeper !! of what is found on the way

    type(error_t), allocatable :: error

    if (turns_fully(structure%linkage, through=.false.)) then
      call find_intervals(structure, of_vibrating_bodies(structure, request), threads, store, &
        found, error, keeper)
    else
      call set_error(error, error_of_reach, no_motion)
    end if
    if (.not. allocated(error)) return
    found%range = [minval(request%speed), maxval(request%speed)]
    found%interval = [instability_t ::]
    found%gap = [gap_t(found%range(1), found%range(2), error)]
  end subroutine find_intervals_of

  !> The request with the damping of parts where the linkage has them.
  pure function of_vibrating_bodies(structure, request) result(of_bodies)
    class(structure_t), intent(in) :: structure      !! linkage and beams
    type(stability_request_t), intent(in) :: request !! damping of links
    type(stability_request_t) :: of_bodies

    of_bodies = request
    of_bodies%damping = dampings_of_parts(structure%elastic, request%damping)
  end function of_vibrating_bodies

end module stability_study
