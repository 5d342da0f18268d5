!> Random numbers that are the same with every compiler: two linear congruential generators combined (L'Ecuyer, Commun. ACM 31
!! (1988) 742).
module random_numbers
  use kinds, only: long, wp
  implicit none (type, external)
  private

  public :: generator_t, new_generator, uniform, power, one_of, happens

  type :: generator_t
    private
    integer(long) :: state(2) = 1_long
  end type generator_t

  integer(long), parameter :: modulus(2) = [2147483563_long, 2147483399_long], factor(2) = [40014_long, 40692_long]

contains

  !> A sequence of its own for every number.
  pure function new_generator(number) result(draw)
    integer, intent(in) :: number
    type(generator_t) :: draw

    real(wp) :: ignored
    integer :: i

    draw%state = 1_long + modulo([7919_long*number + 20101107_long, 104729_long*number + 271828183_long], modulus - 1_long)
    do i = 1, 10
      call next(draw, ignored)
    end do
  end function new_generator

  pure subroutine next(draw, value)
    type(generator_t), intent(inout) :: draw
    real(wp), intent(out) :: value !! between 0 and 1

    draw%state = modulo(factor*draw%state, modulus)
    value = real(modulo(draw%state(1) - draw%state(2), modulus(1) - 1_long) + 1_long, wp)/real(modulus(1), wp)
  end subroutine next

  !> Evenly distributed.
  subroutine uniform(draw, low, high, value)
    type(generator_t), intent(inout) :: draw
    real(wp), intent(in) :: low, high
    real(wp), intent(out) :: value

    call next(draw, value)
    value = low + (high - low)*value
  end subroutine uniform

  !> Ten to a power that is evenly distributed.
  subroutine power(draw, low, high, value)
    type(generator_t), intent(inout) :: draw
    real(wp), intent(in) :: low, high
    real(wp), intent(out) :: value

    call uniform(draw, low, high, value)
    value = 10.0_wp**value
  end subroutine power

  !> One of the numbers from 1 to n.
  subroutine one_of(draw, n, value)
    type(generator_t), intent(inout) :: draw
    integer, intent(in) :: n
    integer, intent(out) :: value

    real(wp) :: x

    call next(draw, x)
    value = min(n, 1 + int(n*x))
  end subroutine one_of

  !> True with a probability.
  subroutine happens(draw, probability, value)
    type(generator_t), intent(inout) :: draw
    real(wp), intent(in) :: probability
    logical, intent(out) :: value

    real(wp) :: x

    call next(draw, x)
    value = x < probability
  end subroutine happens

end module random_numbers
