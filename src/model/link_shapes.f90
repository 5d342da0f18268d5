!> The shapes of links, and where their pins are in the drawing: PIN and GROUND cards.
module link_shapes
  use kinds, only: wp
  use link_cards, only: link_t, segment_count
  use models, only: model_t
  use text, only: same_word
  implicit none (type, external)
  private

  public :: find_link_shape, find_drawn_pin, find_drawn_link, find_drawn_place, compare_lengths, &
    lay_out

contains

  !> Places of all pins of a link in its own axes: origin at its first pin, x towards its second
  !! pin, y to the left of that. They follow from `length=`, from `lengths=` and `turns=`, or from
  !! the drawing. Of a closed triangle three lengths leave its mirror image: the side is that of
  !! `turns=`, else that of the drawing.
  pure subroutine find_link_shape(model, link, places, known)
    type(model_t), intent(in) :: model              !! as read
    type(link_t), intent(in) :: link                !! of the model
    real(wp), allocatable, intent(out) :: places(:, :) !! (2, pins) [m]
    logical, intent(out) :: known                   !! whether cards give the shape; `places` are 0
                                                    !! if not

    real(wp), allocatable :: drawn(:, :)
    real(wp) :: axis(2), side
    logical :: is_drawn

    allocate (places(2, size(link%pins)))
    places = 0.0_wp
    known = size(link%pins) > 1
    if (.not. known) return
    call find_drawn_link(model, link, drawn, is_drawn)
    if (link%has_length) then
      places(1, 2) = link%length
      known = size(link%pins) == 2 .and. link%length > 0.0_wp
    else if (size(link%lengths) == 3 .and. link%is_closed) then
      side = 0.0_wp
      if (size(link%turns) > 0) then
        side = sin(link%turns(1))
      else if (is_drawn) then
        side = cross(drawn(:, 2) - drawn(:, 1), drawn(:, 3) - drawn(:, 1))
      end if
      places = triangle(link%lengths, side)
      known = abs(side) > 0.0_wp
    else if (size(link%lengths) > 0) then
      known = size(link%turns) >= size(link%pins) - 2
      if (known) places = lay_out(link%lengths, link%turns, size(link%pins))
    else
      known = is_drawn
      if (.not. known) return
      axis = drawn(:, 2) - drawn(:, 1)
      known = norm2(axis) > 0.0_wp
      if (.not. known) return
      axis = axis/norm2(axis)
      places(1, :) = axis(1)*(drawn(1, :) - drawn(1, 1)) + axis(2)*(drawn(2, :) - drawn(2, 1))
      places(2, :) = axis(1)*(drawn(2, :) - drawn(2, 1)) - axis(2)*(drawn(1, :) - drawn(1, 1))
      ! The second pin is on the axis, whatever rounding makes of it.
      places(2, 2) = 0.0_wp
    end if
    if (.not. known) places = 0.0_wp
  end subroutine find_link_shape

  !> The corners of a way of straight segments that begins at the origin along x.
  pure function lay_out(lengths, turns, corners) result(places)
    real(wp), intent(in) :: lengths(:) !! of the segments [m]
    real(wp), intent(in) :: turns(:)   !! to the left, at the second corner, the third, … [rad]
    integer, intent(in) :: corners     !! how many are wanted, with the origin
    real(wp) :: places(2, corners)     !! [m]

    real(wp) :: angle
    integer :: i

    places = 0.0_wp
    angle = 0.0_wp
    do i = 2, corners
      places(:, i) = places(:, i - 1) + lengths(i - 1)*[cos(angle), sin(angle)]
      if (i < corners) angle = angle + turns(i - 1)
    end do
  end function lay_out

  !> The corners of a triangle of given sides: from the first to the second, to the third, and back.
  pure function triangle(lengths, side) result(places)
    real(wp), intent(in) :: lengths(3) !! [m]
    real(wp), intent(in) :: side       !! positive: the third corner is to the left of the first
                                       !! side
    real(wp) :: places(2, 3)           !! [m]

    real(wp) :: x

    x = (lengths(1)**2 + lengths(3)**2 - lengths(2)**2)/(2.0_wp*lengths(1))
    places = 0.0_wp
    places(1, 2) = lengths(1)
    places(:, 3) = [x, sign(sqrt(max(0.0_wp, lengths(3)**2 - x**2)), side)]
  end function triangle

  pure function cross(a, b) result(product)
    real(wp), intent(in) :: a(2), b(2)
    real(wp) :: product

    product = a(1)*b(2) - a(2)*b(1)
  end function cross

  !> Where a pin is in the drawing: the place of its GROUND or PIN card.
  pure subroutine find_drawn_pin(model, name, position, is_drawn)
    type(model_t), intent(in) :: model    !! as read
    character(len=*), intent(in) :: name  !! of the pin, in any case of letters
    real(wp), intent(out) :: position(2)  !! in global axes; 0 if it is unknown [m]
    logical, intent(out) :: is_drawn      !! whether the pin has such a card

    integer :: i

    position = 0.0_wp
    is_drawn = .true.
    do i = 1, size(model%grounds)
      if (.not. same_word(model%grounds(i)%pin%text, name)) cycle
      position = model%grounds(i)%position
      return
    end do
    do i = 1, size(model%drawn_pins)
      if (.not. same_word(model%drawn_pins(i)%pin%text, name)) cycle
      position = model%drawn_pins(i)%position
      return
    end do
    is_drawn = .false.
  end subroutine find_drawn_pin

  !> Where a pin or a POINT is in the drawing: the place of its card, or that which follows.
  pure subroutine find_drawn_place(model, name, position, is_drawn)
    type(model_t), intent(in) :: model    !! as read
    character(len=*), intent(in) :: name  !! of the pin or POINT, in any case of letters
    real(wp), intent(out) :: position(2)  !! in global axes; 0 if it is unknown [m]
    logical, intent(out) :: is_drawn      !! whether it is known

    integer :: i

    call find_drawn_pin(model, name, position, is_drawn)
    if (is_drawn) return
    do i = 1, size(model%followed)
      is_drawn = same_word(model%followed(i)%pin%text, name)
      if (.not. is_drawn) cycle
      position = model%followed(i)%position
      return
    end do
  end subroutine find_drawn_place

  !> Where the pins of a link are in the drawing.
  pure subroutine find_drawn_link(model, link, positions, is_drawn)
    type(model_t), intent(in) :: model                 !! as read
    type(link_t), intent(in) :: link                   !! of the model
    real(wp), allocatable, intent(out) :: positions(:, :) !! (2, pins) in global axes; 0 where they
                                                       !! are unknown [m]
    logical, intent(out) :: is_drawn                   !! whether all of them are known

    integer :: i
    logical :: has

    allocate (positions(2, size(link%pins)))
    is_drawn = .true.
    do i = 1, size(link%pins)
      call find_drawn_place(model, link%pins(i)%text, positions(:, i), has)
      is_drawn = is_drawn .and. has
    end do
  end subroutine find_drawn_link

  !> The lengths of a link's segments by its card and by the drawing, where both give them.
  pure subroutine compare_lengths(model, link, given, drawn, known)
    type(model_t), intent(in) :: model             !! as read
    type(link_t), intent(in) :: link               !! of the model
    real(wp), allocatable, intent(out) :: given(:) !! (segments) of `length=` or `lengths=` [m]
    real(wp), allocatable, intent(out) :: drawn(:) !! (segments) from pin to pin in the drawing [m]
    logical, allocatable, intent(out) :: known(:)  !! (segments) whether there are both

    real(wp) :: start(2), end(2)
    integer :: i, next
    logical :: has_start, has_end

    allocate (given(segment_count(link)), drawn(segment_count(link)), known(segment_count(link)))
    given = 0.0_wp
    if (size(link%lengths) == size(given)) given = link%lengths
    if (link%has_length .and. size(given) == 1) given = link%length
    do i = 1, size(given)
      next = mod(i, size(link%pins)) + 1
      call find_drawn_pin(model, link%pins(i)%text, start, has_start)
      call find_drawn_pin(model, link%pins(next)%text, end, has_end)
      drawn(i) = norm2(end - start)
      known(i) = has_start .and. has_end .and. given(i) > 0.0_wp
    end do
  end subroutine compare_lengths

end module link_shapes
