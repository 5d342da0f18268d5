!> The steady elastic response at all speeds of a deck.
module response_study
  use errors, only: error_t
  use kinds, only: wp
  use link_store, only: link_store_t
  use response_types, only: response_request_t, response_t, speed_response_t
  use steady_responses, only: find_steady_responses
  use structures, only: structure_t
  implicit none (type, external)
  private

  public :: find_response, distance_from_circle, largest_deflection

contains

  !> The response at every speed. What prevents it at all speeds fails each of them.
  subroutine find_response(structure, request, threads, store, response)
    class(structure_t), intent(in) :: structure     !! linkage and beams
    type(response_request_t), intent(in) :: request !! speeds, places, accuracy
    integer, intent(in) :: threads                  !! number of OpenMP threads
    type(link_store_t), intent(inout) :: store      !! links decomposed earlier
    type(response_t), intent(out) :: response       !! with a result or an error at every speed

    type(error_t), allocatable :: error
    integer :: k

    call find_steady_responses(structure, request, threads, store, response, error)
    if (.not. allocated(error)) return
    do k = 1, size(request%speed)
      response%at_speed(k)%error = error
    end do
  end subroutine find_response

  !> Least distance of a multiplier of a turn from the circle |ρ| = 1, where vibrations neither grow
  !! nor fade.
  pure function distance_from_circle(found) result(distance)
    type(speed_response_t), intent(in) :: found !! at a speed, without an error
    real(wp) :: distance

    distance = minval(abs(abs(found%multiplier) - 1.0_wp))
  end function distance_from_circle

  !> Largest deflection of a link relative to its length at any speed.
  pure subroutine largest_deflection(response, length, share, body, speed)
    type(response_t), intent(in) :: response !! with peaks
    real(wp), intent(in) :: length(:)        !! (bodies) [m]
    real(wp), intent(out) :: share           !! of the length; 0: no link bends anywhere
    integer, intent(out) :: body, speed      !! numbers; 0: none

    integer :: b, k

    share = 0.0_wp
    body = 0
    speed = 0
    do k = 1, size(response%at_speed)
      associate (found => response%at_speed(k))
        if (allocated(found%error) .or. .not. allocated(found%largest_deflection)) cycle
        do b = 1, size(length)
          if (found%largest_deflection(b)%value <= share*length(b)) cycle
          share = found%largest_deflection(b)%value/length(b)
          body = b
          speed = k
        end do
      end associate
    end do
  end subroutine largest_deflection

end module response_study
