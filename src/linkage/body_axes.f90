!> Which of its pins a body is measured from.
module body_axes
  use kinds, only: wp
  use linkages, only: body_t, linkage_t, turned, turned_back
  use pose_types, only: pins_of_body, place_of_pin
  implicit none (type, external)
  private

  public :: choose_pins, other_pin, has_pin

contains

  !> Chooses the first and the last pin of a body; its axes, and what is placed in them, turn.
  pure subroutine choose_pins(linkage, body, first, last)
    type(linkage_t), intent(inout) :: linkage !! bodies and sliders
    integer, intent(in) :: body               !! number, from 1
    integer, intent(in) :: first, last        !! two of its pins

    real(wp) :: origin(2), axis(2), length
    integer, allocatable :: pins(:)
    real(wp), allocatable :: places(:, :)
    integer :: i, k, filled

    associate (it => linkage%bodies(body))
      if (it%first_pin == first .and. it%last_pin == last) return
      pins = pins_of_body(it)
      allocate (places(2, size(pins)))
      do i = 1, size(pins)
        places(:, i) = place_of_pin(it, pins(i))
      end do
      origin = place_of_pin(it, first)
      axis = place_of_pin(it, last) - origin
      length = norm2(axis)
      axis = axis/length
      ! The same two pins: nothing is rounded.
      if (it%first_pin == last .and. it%last_pin == first) then
        axis = [-1.0_wp, 0.0_wp]
        length = it%length
      end if
      it%length = length
      it%heading = turned_back(it%heading, axis)
      it%origin = turned_back(it%origin - origin, axis)
      it%card_axis = turned_back(it%card_axis, axis)
      it%first_pin = first
      it%last_pin = last
      filled = 0
      do i = 1, size(pins)
        if (any(pins(i) == [first, last])) cycle
        filled = filled + 1
        it%further(filled)%pin = pins(i)
        it%further(filled)%place = turned_back(places(:, i) - origin, axis)
      end do
    end associate
    do i = 1, size(linkage%sliders)
      if (linkage%sliders(i)%body /= body) cycle
      linkage%sliders(i)%point = turned_back(linkage%sliders(i)%point - origin, axis)
      linkage%sliders(i)%direction = turned_back(linkage%sliders(i)%direction, axis)
    end do
    if (allocated(linkage%coordinates)) then
      do i = 1, size(linkage%coordinates)
        do k = 1, 2
          associate (at => linkage%coordinates(i)%at(k))
            if (at%body /= body) cycle
            at%place = turned_back(at%place - origin, axis)
            at%direction = turned_back(at%direction, axis)
          end associate
        end do
      end do
    end if
    do i = 1, size(linkage%turns)
      if (linkage%turns(i)%body == body) linkage%turns(i)%relative = turned(axis, &
        linkage%turns(i)%relative)
      if (linkage%turns(i)%against == body) linkage%turns(i)%relative = turned_back( &
        linkage%turns(i)%relative, axis)
    end do
  end subroutine choose_pins

  !> The pin of a body named first, but not a certain one.
  pure function other_pin(body, pin) result(other)
    type(body_t), intent(in) :: body
    integer, intent(in) :: pin
    integer :: other

    integer, allocatable :: pins(:)

    pins = pins_of_body(body)
    other = pins(1)
    if (other == pin) other = pins(2)
  end function other_pin

  !> Whether a pin is one of a body. No list of them is made: plans ask for every body and pin.
  pure function has_pin(body, pin)
    type(body_t), intent(in) :: body
    integer, intent(in) :: pin
    logical :: has_pin

    integer :: i

    has_pin = body%first_pin == pin .or. body%last_pin == pin
    do i = 1, size(body%further)
      has_pin = has_pin .or. body%further(i)%pin == pin
    end do
  end function has_pin

end module body_axes
