!> The steady elastic response at all speeds of a deck.
module response_study
  use errors, only: error_of_reach, error_t, set_error
  use full_turns, only: turns_fully
  use kept_results, only: keeper_t
  use kinds, only: wp
  use link_store, only: link_store_t
  use modal_distances, only: find_modal_distances, modal_distance_t
  use part_requests, only: dampings_of_parts, join_parts, request_of_parts
  use response_types, only: response_request_t, response_t, speed_response_t
  use stability_types, only: stability_request_t
  use steady_responses, only: find_steady_responses
  use structures, only: structure_t
  implicit none (type, external)
  private

  public :: find_response, largest_deflection, deflection_of

contains

  !> The response at every speed. What prevents it at all speeds fails each of them.
  subroutine find_response(structure, request, threads, store, response, keeper)
    class(structure_t), intent(in) :: structure     !! linkage and beams
    type(response_request_t), intent(in) :: request !! speeds, places, accuracy
    integer, intent(in) :: threads                  !! number of OpenMP threads
    type(link_store_t), intent(inout) :: store      !! links decomposed earlier
    type(response_t), intent(out) :: response       !! with a result or an error at every speed
    class(keeper_t), intent(inout), optional :: keeper !! of what is found on the way

    type(error_t), allocatable :: error
    integer :: k

    if (.not. turns_fully(structure%linkage, through=.false.)) then
      allocate (response%at_speed(size(request%speed)))
      call set_error(error, error_of_reach, "the crank does not turn fully, or meets a dead "// &
        "point: there is no steady state")
    else
      call find_steady_responses(structure, request_of_parts(structure%elastic, request), threads, &
        store, response, error, keeper)
      do k = 1, size(response%at_speed)
        call join_parts(structure%elastic, size(structure%linkage%bodies), response%at_speed(k))
      end do
    end if
    if (request%validity .and. .not. allocated(error)) call add_distances(structure, request, &
      threads, store, response, keeper)
    if (.not. allocated(error)) return
    do k = 1, size(request%speed)
      response%at_speed(k)%error = error
    end do
  end subroutine find_response

  !> Adds how near the speeds are to resonance.
  subroutine add_distances(structure, request, threads, store, response, keeper)
    class(structure_t), intent(in) :: structure
    type(response_request_t), intent(in) :: request
    integer, intent(in) :: threads
    type(link_store_t), intent(inout) :: store
    type(response_t), intent(inout) :: response
    class(keeper_t), intent(inout), optional :: keeper

    !> Multipliers are no more accurate than this.
    real(wp), parameter :: finest = 1.0e-9_wp
    type(stability_request_t) :: vibrations
    type(modal_distance_t), allocatable :: found(:)
    type(error_t), allocatable :: error
    integer, allocatable :: at(:)
    integer :: k

    at = pack([(k, k=1, size(request%speed))], [(.not. allocated(response%at_speed(k)%error), k=1, &
      size(request%speed))])
    if (size(at) == 0) return
    vibrations%speed = request%speed(at)
    vibrations%modes = request%modes
    vibrations%accuracy = max(request%accuracy, finest)
    vibrations%terms = request%terms
    vibrations%damping = dampings_of_parts(structure%elastic, request%damping)
    call find_modal_distances(structure, vibrations, threads, store, found, error, keeper)
    if (allocated(error)) return
    do k = 1, size(at)
      if (allocated(found(k)%why)) cycle
      response%at_speed(at(k))%modal_distance = found(k)%value
      response%at_speed(at(k))%modal_distance_error = found(k)%error
    end do
  end subroutine add_distances

  !> The largest deflection of a link relative to its length, at any speed.
  pure subroutine largest_deflection(response, length, share, body, speed)
    type(response_t), intent(in) :: response !! of all speeds
    real(wp), intent(in) :: length(:)        !! (bodies) [m]
    real(wp), intent(out) :: share           !! of the length; 0: no link bends anywhere
    integer, intent(out) :: body, speed      !! numbers; 0: none

    integer :: b, k

    share = 0.0_wp
    body = 0
    speed = 0
    do k = 1, size(response%at_speed)
      if (allocated(response%at_speed(k)%error)) cycle
      do b = 1, size(length)
        if (deflection_of(response%at_speed(k), b) <= share*length(b)) cycle
        share = deflection_of(response%at_speed(k), b)/length(b)
        body = b
        speed = k
      end do
    end do
  end subroutine largest_deflection

  !> The largest deflection of a link over the turn, as accurate as it is known [m].
  pure function deflection_of(found, body) result(deflection)
    type(speed_response_t), intent(in) :: found !! at a speed, without an error
    integer, intent(in) :: body                 !! number
    real(wp) :: deflection

    deflection = found%deflection(body)
    if (allocated(found%largest_deflection)) deflection = found%largest_deflection(body)%value
  end function deflection_of

end module response_study
