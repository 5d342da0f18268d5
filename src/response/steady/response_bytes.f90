!> The response at a speed as bytes and back, exact to the last bit.
module response_bytes
  use byte_streams, only: byte_stream_t, pass_error
  use kinds, only: wp
  use refinements, only: refinement_t
  use response_types, only: peak_t, speed_response_t
  implicit none (type, external)
  private

  public :: pass_refinement, pass_response

contains

  !> Passes what is chosen, and how it went so far.
  pure subroutine pass_refinement(stream, refinement)
    type(byte_stream_t), intent(inout) :: stream
    type(refinement_t), intent(inout) :: refinement

    integer :: numbers(storage_size(refinement)/storage_size(1))

    numbers = transfer(refinement, numbers)
    call stream%pass(numbers)
    refinement = transfer(numbers, refinement)
  end subroutine pass_refinement

  pure subroutine pass_response(stream, found)
    type(byte_stream_t), intent(inout) :: stream
    type(speed_response_t), intent(inout) :: found

    real(wp) :: nearest(2)

    call pass_error(stream, found%error)
    call stream%pass_allocatable(found%displacement)
    call stream%pass_allocatable(found%displacement_error)
    call stream%pass_allocatable(found%strain)
    call stream%pass_allocatable(found%strain_error)
    call stream%pass_allocatable(found%drive)
    call stream%pass(found%drive_error)
    call stream%pass(found%mean_torque)
    call pass_peaks(stream, found%largest_strain)
    call pass_peaks(stream, found%largest_stress)
    call pass_peaks(stream, found%largest_deflection)
    call stream%pass_allocatable(found%deflection)
    call stream%pass_allocatable(found%power_lost)
    call stream%pass_allocatable(found%peak_error)
    call stream%pass_allocatable(found%buckling)
    call stream%pass_allocatable(found%buckling_error)
    call stream%pass_allocatable(found%quadratic_change)
    call stream%pass_allocatable(found%quadratic_error)
    call stream%pass_allocatable(found%out_of_plane)
    call stream%pass(found%out_of_plane_error)
    call stream%pass_allocatable(found%modal_distance)
    call stream%pass(found%modal_distance_error)
    call stream%pass(found%distance)
    call stream%pass(found%growth)
    nearest = [real(found%nearest), aimag(found%nearest)]
    call stream%pass(nearest)
    found%nearest = cmplx(nearest(1), nearest(2), wp)
    call stream%pass(found%order)
    call stream%pass(found%samples)
    call stream%pass(found%slow)
    call stream%pass(found%applications)
    call stream%pass(found%largest_error)
  end subroutine pass_response

  !> Passes the largest values of links, or that there are none.
  pure subroutine pass_peaks(stream, peaks)
    type(byte_stream_t), intent(inout) :: stream
    type(peak_t), allocatable, intent(inout) :: peaks(:)

    integer :: count, i

    count = -1
    if (allocated(peaks)) count = size(peaks)
    call stream%pass(count)
    if (stream%reads .and. allocated(peaks)) deallocate (peaks)
    if (count < 0) return
    if (stream%reads) allocate (peaks(count))
    do i = 1, count
      call stream%pass(peaks(i)%value)
      call stream%pass(peaks(i)%xi)
      call stream%pass(peaks(i)%share)
      call stream%pass(peaks(i)%crank)
      call stream%pass(peaks(i)%is_constant)
    end do
  end subroutine pass_peaks

end module response_bytes
