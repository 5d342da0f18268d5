!> Results of positions as bytes and back, exact to the last bit: the form in which blocks of a
!! sweep are kept in the journal.
module sweep_bytes
  use byte_streams, only: get_error, get_integers, get_logicals, get_reals, put_error, &
    put_integers, put_logicals, put_reals
  use kinds, only: wp
  use ledger, only: ledger_t
  use modal_assurance, only: mode_prints_t
  use position_results, only: position_result_t
  use shape_samples, only: shapes_t
  use text_buffer, only: text_buffer_t
  implicit none (type, external)
  private

  public :: put_result, get_result, put_ledger, get_ledger

contains

  !> Appends a result to a buffer.
  pure subroutine put_result(buffer, result)
    type(text_buffer_t), intent(inout) :: buffer  !! bytes, to be read by `get_result`
    type(position_result_t), intent(in) :: result !! of a position; without a pose it is empty

    integer :: k

    call put_logicals(buffer, [allocated(result%lambda), allocated(result%prints), &
      allocated(result%damping)])
    if (.not. allocated(result%lambda)) return ! no pose
    call put_integers(buffer, [shape(result%lambda), size(result%deflection, 1)])
    call put_ledger(buffer, result%counts)
    call put_reals(buffer, [result%lambda, result%error, result%deflection, [result%order_error]])
    if (allocated(result%damping)) call put_reals(buffer, [result%damping])
    call put_integers(buffer, result%cause)
    do k = 1, size(result%outcome)
      call put_error(buffer, result%outcome(k)%error)
      call put_logicals(buffer, [allocated(result%shapes(k)%displacement)])
      if (allocated(result%shapes(k)%displacement)) then
        call put_integers(buffer, shape(result%shapes(k)%displacement))
        call put_reals(buffer, [result%shapes(k)%displacement])
      end if
      if (.not. allocated(result%prints)) cycle
      call put_logicals(buffer, [allocated(result%prints(k)%vector)])
      if (.not. allocated(result%prints(k)%vector)) cycle
      call put_integers(buffer, shape(result%prints(k)%vector))
      call put_reals(buffer, [result%prints(k)%vector, result%prints(k)%mass_times])
    end do
  end subroutine put_result

  !> Reads what `put_result` wrote.
  pure subroutine get_result(bytes, at, result)
    character(len=*), intent(in) :: bytes          !! of `put_result`, among others
    integer, intent(inout) :: at                   !! place of the first byte; on return, after the
                                                   !! last
    type(position_result_t), intent(out) :: result !! of a position

    real(wp) :: order_error(1)
    integer :: n(3), k
    logical :: is_there(3)

    call get_logicals(bytes, at, is_there)
    if (.not. is_there(1)) return
    call get_integers(bytes, at, n)
    call get_ledger(bytes, at, result%counts)
    associate (modes => n(1), speeds => n(2), bodies => n(3))
      allocate (result%lambda(modes, speeds), result%error(modes, speeds), &
        result%deflection(bodies, speeds))
      allocate (result%outcome(speeds), result%shapes(speeds), result%cause(speeds))
      if (is_there(2)) allocate (result%prints(speeds))
    end associate
    call get_matrix(bytes, at, result%lambda)
    call get_matrix(bytes, at, result%error)
    call get_matrix(bytes, at, result%deflection)
    call get_reals(bytes, at, order_error)
    result%order_error = order_error(1)
    if (is_there(3)) then
      allocate (result%damping(n(1), n(2)))
      call get_matrix(bytes, at, result%damping)
    end if
    call get_integers(bytes, at, result%cause)
    do k = 1, size(result%outcome)
      call get_error(bytes, at, result%outcome(k)%error)
      call get_shapes(bytes, at, result%shapes(k))
      if (is_there(2)) call get_prints(bytes, at, result%prints(k))
    end do
  end subroutine get_result

  !> Appends counts to a buffer.
  pure subroutine put_ledger(buffer, counts)
    type(text_buffer_t), intent(inout) :: buffer !! bytes, to be read by `get_ledger`
    type(ledger_t), intent(in) :: counts         !! of the work done

    call put_integers(buffer, transfer(counts, [0]))
  end subroutine put_ledger

  !> Reads what `put_ledger` wrote.
  pure subroutine get_ledger(bytes, at, counts)
    character(len=*), intent(in) :: bytes !! of `put_ledger`, among others
    integer, intent(inout) :: at          !! place of the first byte; on return, after the last
    type(ledger_t), intent(out) :: counts !! of the work done

    integer :: numbers(size(transfer(ledger_t(), [0])))

    call get_integers(bytes, at, numbers)
    counts = transfer(numbers, counts)
  end subroutine get_ledger

  pure subroutine get_shapes(bytes, at, shapes)
    character(len=*), intent(in) :: bytes
    integer, intent(inout) :: at
    type(shapes_t), intent(inout) :: shapes

    integer :: n(4), i, j
    logical :: is_there(1)

    call get_logicals(bytes, at, is_there)
    if (.not. is_there(1)) return
    call get_integers(bytes, at, n)
    allocate (shapes%displacement(n(1), n(2), n(3), n(4)))
    do j = 1, n(4)
      do i = 1, n(3)
        call get_matrix(bytes, at, shapes%displacement(:, :, i, j))
      end do
    end do
  end subroutine get_shapes

  pure subroutine get_prints(bytes, at, prints)
    character(len=*), intent(in) :: bytes
    integer, intent(inout) :: at
    type(mode_prints_t), intent(inout) :: prints

    integer :: n(2)
    logical :: is_there(1)

    call get_logicals(bytes, at, is_there)
    if (.not. is_there(1)) return
    call get_integers(bytes, at, n)
    allocate (prints%vector(n(1), n(2)), prints%mass_times(n(1), n(2)))
    call get_matrix(bytes, at, prints%vector)
    call get_matrix(bytes, at, prints%mass_times)
  end subroutine get_prints

  pure subroutine get_matrix(bytes, at, values)
    character(len=*), intent(in) :: bytes
    integer, intent(inout) :: at
    real(wp), intent(inout) :: values(:, :)

    real(wp) :: list(size(values))

    call get_reals(bytes, at, list)
    values = reshape(list, shape(values))
  end subroutine get_matrix

end module sweep_bytes
