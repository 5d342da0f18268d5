!> Exponents at a speed, and intervals of instability, as bytes and back, exact to the last bit.
module stability_bytes
  use byte_streams, only: byte_stream_t, pass_error
  use stability_types, only: exponent_t, instability_t, speed_stability_t
  implicit none (type, external)
  private

  public :: pass_stability, pass_instability

contains

  pure subroutine pass_stability(stream, found)
    type(byte_stream_t), intent(inout) :: stream
    type(speed_stability_t), intent(inout) :: found !! at a speed

    integer :: numbers(storage_size(exponent_t())/storage_size(1)), count, i

    call pass_error(stream, found%error)
    count = -1
    if (allocated(found%exponent)) count = size(found%exponent)
    call stream%pass(count)
    if (stream%reads .and. allocated(found%exponent)) deallocate (found%exponent)
    if (stream%reads .and. count >= 0) allocate (found%exponent(count))
    do i = 1, count
      numbers = transfer(found%exponent(i), numbers)
      call stream%pass(numbers)
      found%exponent(i) = transfer(numbers, found%exponent(i))
    end do
    call stream%pass(found%order)
    call stream%pass(found%samples)
    call stream%pass(found%slow)
    call stream%pass(found%applications)
  end subroutine pass_stability

  pure subroutine pass_instability(stream, interval)
    type(byte_stream_t), intent(inout) :: stream
    type(instability_t), intent(inout) :: interval

    integer :: numbers(storage_size(interval)/storage_size(1))

    numbers = transfer(interval, numbers)
    call stream%pass(numbers)
    interval = transfer(numbers, interval)
  end subroutine pass_instability

end module stability_bytes
