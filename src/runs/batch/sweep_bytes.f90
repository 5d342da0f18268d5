!> Results of positions as bytes and back, exact to the last bit: the form in which blocks of a
!! sweep are kept in the journal.
module sweep_bytes
  use byte_streams, only: byte_stream_t, pass_error
  use ledger, only: ledger_t
  use position_results, only: position_result_t
  implicit none (type, external)
  private

  public :: pass_result, pass_ledger

contains

  !> Passes a result.
  pure subroutine pass_result(stream, result)
    type(byte_stream_t), intent(inout) :: stream
    type(position_result_t), intent(inout) :: result !! of a position; new if it is read; without a
                                                     !! pose it is empty

    integer :: speeds, k
    logical :: has_prints

    call stream%pass_allocatable(result%lambda)
    if (.not. allocated(result%lambda)) return ! no pose
    call stream%pass_allocatable(result%error)
    call stream%pass_allocatable(result%deflection)
    call stream%pass_allocatable(result%damping)
    call stream%pass(result%order_error)
    call pass_ledger(stream, result%counts)
    has_prints = allocated(result%prints)
    call stream%pass(has_prints)
    speeds = size(result%lambda, 2)
    if (stream%reads) then
      allocate (result%outcome(speeds), result%shapes(speeds), result%cause(speeds))
      if (has_prints) allocate (result%prints(speeds))
    end if
    call stream%pass(result%cause)
    do k = 1, speeds
      call pass_error(stream, result%outcome(k)%error)
      call stream%pass_allocatable(result%shapes(k)%displacement)
      if (.not. has_prints) cycle
      call stream%pass_allocatable(result%prints(k)%vector)
      call stream%pass_allocatable(result%prints(k)%mass_times)
    end do
  end subroutine pass_result

  !> Passes counts of the work done.
  pure subroutine pass_ledger(stream, counts)
    type(byte_stream_t), intent(inout) :: stream
    type(ledger_t), intent(inout) :: counts

    integer :: numbers(size(transfer(ledger_t(), [0])))

    numbers = transfer(counts, numbers)
    call stream%pass(numbers)
    counts = transfer(numbers, counts)
  end subroutine pass_ledger

end module sweep_bytes
