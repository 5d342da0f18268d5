!> Which ends of links turn together: the corners of links that bend, welds, blocks that do not
!! turn, drives that hold an angle.
module turning_ends
  use linkages, only: linkage_t
  implicit none (type, external)
  private

  public :: turning_ends_t, new_turning_ends, add_end, join_ends, number_ends, number_of

  !> Of an end that turns with the ground.
  integer, parameter :: ground_number = -1

  !> Ends of links, as a forest: ends with the same root turn together. The first one is the ground.
  type :: turning_ends_t
    private
    logical, allocatable :: bends(:)   !! (bodies)
    integer, allocatable :: body(:)    !! (ends); 0: the ground
    integer, allocatable :: pin(:)     !! (ends); 0: a rigid link, which turns as a whole
    integer, allocatable :: above(:)   !! (ends) itself: a root
    integer, allocatable :: number(:)  !! (ends) of the rotation, of roots; −1: the ground
  end type turning_ends_t

contains

  !> No ends but the ground.
  pure function new_turning_ends(linkage) result(ends)
    type(linkage_t), intent(in) :: linkage !! which of its links bend
    type(turning_ends_t) :: ends

    ends%bends = linkage%bodies%bends
    ends%body = [0]
    ends%pin = [0]
    ends%above = [1]
    ends%number = [ground_number]
  end function new_turning_ends

  !> Adds an end that something holds.
  pure subroutine add_end(ends, body, pin)
    type(turning_ends_t), intent(inout) :: ends
    integer, intent(in) :: body !! number of its link
    integer, intent(in) :: pin  !! or point where it is; of a rigid link any

    integer :: number

    call find_end(ends, body, pin, number)
  end subroutine add_end

  !> Lets two ends turn together.
  pure subroutine join_ends(ends, body, pin)
    type(turning_ends_t), intent(inout) :: ends
    integer, intent(in) :: body(2) !! numbers of their links; 0: the ground
    integer, intent(in) :: pin(2)  !! or points where they are

    integer :: number, root(2), i

    do i = 1, 2
      call find_end(ends, body(i), pin(i), number)
      root(i) = root_of(ends, number)
    end do
    ! The ground stays a root.
    ends%above(maxval(root)) = minval(root)
  end subroutine join_ends

  !> Gives every rotation a number.
  pure subroutine number_ends(ends, rotations)
    type(turning_ends_t), intent(inout) :: ends
    integer, intent(out) :: rotations !! how many there are

    integer :: i

    rotations = 0
    do i = 2, size(ends%body)
      if (ends%above(i) /= i) cycle
      rotations = rotations + 1
      ends%number(i) = rotations
    end do
  end subroutine number_ends

  !> Number of the rotation of an end: 0 of a hinge, −1 of one that cannot turn.
  pure function number_of(ends, body, pin) result(number)
    type(turning_ends_t), intent(in) :: ends !! numbered
    integer, intent(in) :: body              !! number of its link
    integer, intent(in) :: pin               !! or point where it is
    integer :: number

    number = known_end(ends, body, pin)
    if (number > 0) number = ends%number(root_of(ends, number))
  end function number_of

  !> Number of an end, which is added if it is new.
  pure subroutine find_end(ends, body, pin, number)
    type(turning_ends_t), intent(inout) :: ends
    integer, intent(in) :: body, pin
    integer, intent(out) :: number

    number = known_end(ends, body, pin)
    if (number > 0) return
    number = size(ends%body) + 1
    ends%body = [ends%body, body]
    ends%pin = [ends%pin, pin_of(ends, body, pin)]
    ends%above = [ends%above, number]
    ends%number = [ends%number, 0]
  end subroutine find_end

  !> A rigid link turns as a whole.
  pure function pin_of(ends, body, pin) result(at)
    type(turning_ends_t), intent(in) :: ends
    integer, intent(in) :: body, pin
    integer :: at

    at = 0
    if (body == 0) return
    if (ends%bends(body)) at = pin
  end function pin_of

  !> Number of an end; 0: it turns freely.
  pure function known_end(ends, body, pin) result(number)
    type(turning_ends_t), intent(in) :: ends
    integer, intent(in) :: body, pin
    integer :: number

    do number = 1, size(ends%body)
      if (ends%body(number) == body .and. ends%pin(number) == pin_of(ends, body, pin)) return
    end do
    number = 0
  end function known_end

  !> The root of an end.
  pure function root_of(ends, number) result(root)
    type(turning_ends_t), intent(in) :: ends
    integer, intent(in) :: number
    integer :: root

    root = number
    do while (ends%above(root) /= root)
      root = ends%above(root)
    end do
  end function root_of

end module turning_ends
