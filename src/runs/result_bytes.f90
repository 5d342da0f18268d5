!> Results of positions as bytes and back, to the last bit: what a run that is killed leaves for the
!! one that goes on.
module result_bytes
  use kinds, only: wp
  use ledger, only: ledger_t
  use modal_assurance, only: mode_prints_t
  use position_results, only: position_result_t
  use shape_samples, only: shapes_t
  use text_buffer, only: append_text, text_buffer_t
  implicit none (type, external)
  private

  public :: put_result, get_result, put_integers, get_integers

  integer, parameter :: real_bytes = storage_size(1.0_wp)/8, integer_bytes = storage_size(1)/8

contains

  !> Appends a result to a buffer.
  pure subroutine put_result(buffer, result)
    type(text_buffer_t), intent(inout) :: buffer
    type(position_result_t), intent(in) :: result

    integer :: k

    call put_logicals(buffer, [allocated(result%lambda), allocated(result%prints)])
    if (.not. allocated(result%lambda)) return ! no pose
    call put_integers(buffer, [shape(result%lambda), size(result%deflection, 1), &
      transfer(result%counts, [0])])
    call put_reals(buffer, [result%lambda, result%error, result%deflection, [result%order_error]])
    do k = 1, size(result%failure)
      call put_integers(buffer, [len(result%failure(k)%text)])
      call append_text(buffer, result%failure(k)%text)
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

  !> Reads what `put_result` wrote; `at` moves past it.
  pure subroutine get_result(bytes, at, result)
    character(len=*), intent(in) :: bytes
    integer, intent(inout) :: at !! of the next byte
    type(position_result_t), intent(out) :: result

    integer :: n(3 + size(transfer(ledger_t(), [0]))), modes, speeds, bodies, length(1), k
    logical :: is_there(2)

    call get_logicals(bytes, at, is_there)
    if (.not. is_there(1)) return
    call get_integers(bytes, at, n)
    modes = n(1)
    speeds = n(2)
    bodies = n(3)
    result%counts = transfer(n(4:), result%counts)
    allocate (result%lambda(modes, speeds), result%error(modes, speeds), result%deflection(bodies, &
      speeds))
    allocate (result%failure(speeds), result%shapes(speeds))
    if (is_there(2)) allocate (result%prints(speeds))
    call get_matrix(bytes, at, result%lambda)
    call get_matrix(bytes, at, result%error)
    call get_matrix(bytes, at, result%deflection)
    call get_real(bytes, at, result%order_error)
    do k = 1, speeds
      call get_integers(bytes, at, length)
      result%failure(k)%text = bytes(at:at + length(1) - 1)
      at = at + length(1)
      call get_shapes(bytes, at, result%shapes(k))
      if (is_there(2)) call get_prints(bytes, at, result%prints(k))
    end do
  end subroutine get_result

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

  pure subroutine put_integers(buffer, values)
    type(text_buffer_t), intent(inout) :: buffer
    integer, intent(in) :: values(:)

    character(len=integer_bytes*size(values)) :: bytes

    bytes = transfer(values, bytes)
    call append_text(buffer, bytes)
  end subroutine put_integers

  pure subroutine put_logicals(buffer, values)
    type(text_buffer_t), intent(inout) :: buffer
    logical, intent(in) :: values(:)

    call put_integers(buffer, merge(1, 0, values))
  end subroutine put_logicals

  pure subroutine put_reals(buffer, values)
    type(text_buffer_t), intent(inout) :: buffer
    real(wp), intent(in) :: values(:)

    character(len=real_bytes*size(values)) :: bytes

    bytes = transfer(values, bytes)
    call append_text(buffer, bytes)
  end subroutine put_reals

  pure subroutine get_integers(bytes, at, values)
    character(len=*), intent(in) :: bytes
    integer, intent(inout) :: at
    integer, intent(out) :: values(:)

    values = transfer(bytes(at:at + integer_bytes*size(values) - 1), values)
    at = at + integer_bytes*size(values)
  end subroutine get_integers

  pure subroutine get_logicals(bytes, at, values)
    character(len=*), intent(in) :: bytes
    integer, intent(inout) :: at
    logical, intent(out) :: values(:)

    integer :: numbers(size(values))

    call get_integers(bytes, at, numbers)
    values = numbers /= 0
  end subroutine get_logicals

  pure subroutine get_matrix(bytes, at, values)
    character(len=*), intent(in) :: bytes
    integer, intent(inout) :: at
    real(wp), intent(inout) :: values(:, :)

    values = reshape(transfer(bytes(at:at + real_bytes*size(values) - 1), [0.0_wp]), shape(values))
    at = at + real_bytes*size(values)
  end subroutine get_matrix

  pure subroutine get_real(bytes, at, value)
    character(len=*), intent(in) :: bytes
    integer, intent(inout) :: at
    real(wp), intent(out) :: value

    value = transfer(bytes(at:at + real_bytes - 1), value)
    at = at + real_bytes
  end subroutine get_real

end module result_bytes
