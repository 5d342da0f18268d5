!> Straight ways of links that bend, and where blocks that slide along them cut them in pieces.
!!
!! A way with a block is cut under every block, at every pin between its ends, and at every mass and
!! place of a force, so that no piece has a mass inside. There is one piece more than cuts at every
!! position; the order of the cuts is that of the position, for blocks pass masses, pins and each
!! other. Pieces are numbered along the way.
module cut_ways
  use kinds, only: wp
  use linkages, only: body_t, cross, linkage_t
  use pose_types, only: place_of_pin
  implicit none (type, external)
  private

  public :: cut_way_t, carried_t, find_ways, ways_under, nearest_way, fixed_lumps

  !> A place where a way is cut.
  type :: cut_t
    integer :: point = 0          !! of the elastic linkage
    integer :: slider = 0         !! whose block is over it; 0: it is a place of the link
    real(wp) :: along = 0.0_wp    !! of a place of the link, from where the way begins [m]
    integer :: rotation = 0       !! of the cross-section; a `fixed_rotation` if it cannot turn
    real(wp) :: inertia = 0.0_wp  !! ρI L of the cross-sections of short pieces beside it at the
                                  !! position, which turn with it [kg m²]
  end type cut_t

  !> A straight way between two pins of a link that bends.
  type :: cut_way_t
    integer :: body = 0               !! number of the link
    integer :: pins(2) = 0            !! where it begins and ends
    real(wp) :: place(2) = 0.0_wp     !! where it begins, from the first pin of the link, in its
                                      !! axes [m]
    real(wp) :: axis(2) = 0.0_wp      !! direction in the axes of the link
    real(wp) :: length = 0.0_wp       !! [m]
    integer :: first_part = 0         !! number of its first piece in the elastic linkage
    integer :: rotation(2) = 0        !! of its ends, as of parts
    type(cut_t), allocatable :: cuts(:) !! none: the way is one part
  end type cut_way_t

  !> What is fixed to a cross-section where a way is cut: a mass, or a place where a force acts, or
  !! a block that turns with its guide.
  type :: carried_t
    integer :: body = 0               !! number of the link
    integer :: way = 0                !! number of its way
    integer :: point = 0              !! of the elastic linkage: that of the cut
    integer :: rotation = 0           !! of the cross-section, as of a cut
    real(wp) :: place(2) = 0.0_wp     !! from where the way begins, in the axes of the way [m]
    real(wp) :: arm(2) = 0.0_wp       !! from the point, likewise [m]
    real(wp) :: mass = 0.0_wp         !! [kg]
    real(wp) :: inertia = 0.0_wp      !! about its own mass centre [kg m²]
    integer :: load = 0               !! number of the force that acts there; 0: none
  end type carried_t

  !> Pins nearer to the line of a block than this share of the way between them are on it.
  real(wp), parameter :: near = 1.0e-6_wp

  !> The same of pins that are meant to be on it, and drawn with some six digits.
  real(wp), parameter :: drawn = 1.0e-5_wp

  !> Rounding of a place, as a share of the way; sine of the angle between two ways that are one.
  real(wp), parameter :: rounding = 4.0_wp*epsilon(1.0_wp), straight = 1.0e-12_wp

  !> The least length of a piece, as a share of its way: where two cuts meet, as little as the
  !! rounding of the position. A piece so short is rigid, and has neither mass nor length.
  real(wp), parameter, public :: least_piece = epsilon(1.0_wp)

contains

  !> All straight ways of the links that bend, in the order of the links, with what they carry.
  pure subroutine find_ways(linkage, contact, points, ways, carried)
    type(linkage_t), intent(in) :: linkage   !! planned, with masses and places of forces
    integer, intent(in) :: contact(:)        !! (sliders) point of a link that bends under the
                                             !! block; 0: none
    integer, intent(inout) :: points         !! how many there are; becomes that with places of cuts
    type(cut_way_t), allocatable, intent(out) :: ways(:)
    type(carried_t), allocatable, intent(out) :: carried(:)

    type(cut_way_t), allocatable :: room(:)
    integer :: b, i, n

    n = 0
    do b = 1, size(linkage%bodies)
      if (linkage%bodies(b)%bends) n = n + size(corners_of(linkage%bodies(b))) - 1
    end do
    allocate (room(n), carried(0))
    n = 0
    do b = 1, size(linkage%bodies)
      if (linkage%bodies(b)%bends) call add_ways(linkage, b, room, n)
    end do
    allocate (ways(n))
    do i = 1, n
      ways(i) = room(i)
    end do
    do i = 1, size(contact)
      if (contact(i) > 0) call add_block(linkage, i, contact(i), ways, carried)
    end do
    do b = 1, size(linkage%bodies)
      if (linkage%bodies(b)%bends) call add_places(linkage, b, points, ways, carried)
    end do
  end subroutine find_ways

  !> Pins along a link that bends, in order.
  pure function corners_of(body) result(corners)
    type(body_t), intent(in) :: body
    integer, allocatable :: corners(:)

    if (allocated(body%corners)) then
      corners = body%corners
    else
      corners = [body%first_pin, body%last_pin]
    end if
  end function corners_of

  !> The ways of a link: from corner to corner, but straight on over pins along which a block
  !! slides.
  pure subroutine add_ways(linkage, b, ways, n)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: b                    !! number of the link
    type(cut_way_t), intent(inout) :: ways(:)   !! the first n are those of the links before
    integer, intent(inout) :: n

    integer, allocatable :: corners(:)
    integer :: first, last

    corners = corners_of(linkage%bodies(b))
    first = 1
    do while (first < size(corners))
      last = first + 1
      do while (last < size(corners))
        if (.not. goes_on(linkage, b, corners(last - 1:last + 1))) exit
        last = last + 1
      end do
      n = n + 1
      ways(n) = new_way(linkage, b, corners(first:last))
      first = last
    end do
  end subroutine add_ways

  !> A way through some pins of a link. Those between its ends are places where it is cut.
  pure function new_way(linkage, b, corners) result(way)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: b
    integer, intent(in) :: corners(:)
    type(cut_way_t) :: way

    real(wp) :: whole(2)
    integer :: i, n

    n = size(corners)
    associate (body => linkage%bodies(b))
      way%body = b
      way%pins = corners([1, n])
      way%place = place_of_pin(body, corners(1))
      whole = place_of_pin(body, corners(n)) - way%place
      way%length = norm2(whole)
      way%axis = whole/way%length
      allocate (way%cuts(n - 2))
      do i = 2, n - 1
        way%cuts(i - 1)%point = corners(i)
        way%cuts(i - 1)%along = dot_product(way%axis, place_of_pin(body, corners(i)) - way%place)
      end do
    end associate
  end function new_way

  !> Whether a link goes straight on at a pin between two others, and a block slides over it.
  pure function goes_on(linkage, b, pins) result(goes)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: b
    integer, intent(in) :: pins(3)
    logical :: goes

    real(wp) :: ways(2, 2)
    integer :: i

    goes = .false.
    associate (body => linkage%bodies(b))
      do i = 1, 2
        ways(:, i) = place_of_pin(body, pins(i + 1)) - place_of_pin(body, pins(i))
        ways(:, i) = ways(:, i)/norm2(ways(:, i))
      end do
    end associate
    if (abs(cross(ways(:, 1), ways(:, 2))) > straight) return
    if (dot_product(ways(:, 1), ways(:, 2)) < 0.0_wp) return
    do i = 1, size(linkage%sliders)
      if (linkage%sliders(i)%body /= b) cycle
      goes = goes .or. (length_on_line(linkage, i, pins(1:2), near) > 0.0_wp .and. &
        length_on_line(linkage, i, pins(2:3), near) > 0.0_wp)
    end do
  end function goes_on

  !> How many ways of a link lie on the line of a block: more than one where pins between them are
  !! off the line by more than rounding.
  pure function ways_under(linkage, slider, ways) result(number)
    type(linkage_t), intent(in) :: linkage  !! planned
    integer, intent(in) :: slider           !! along a link that bends
    type(cut_way_t), intent(in) :: ways(:)  !! of this linkage
    integer :: number

    integer :: i

    number = 0
    do i = 1, size(ways)
      if (ways(i)%body /= linkage%sliders(slider)%body) cycle
      if (length_on_line(linkage, slider, ways(i)%pins, drawn) > 0.0_wp) number = number + 1
    end do
  end function ways_under

  !> Length of the way between two pins that lies on the line of a block; 0: it does not.
  pure function length_on_line(linkage, slider, pins, share) result(length)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: slider
    integer, intent(in) :: pins(2)
    real(wp), intent(in) :: share !! of it that pins may be beside the line
    real(wp) :: length

    real(wp) :: first(2), last(2), off(2)

    associate (line => linkage%sliders(slider), &
        body => linkage%bodies(linkage%sliders(slider)%body))
      first = place_of_pin(body, pins(1))
      last = place_of_pin(body, pins(2))
      length = norm2(last - first)
      off = abs([cross(line%direction, first - line%point), cross(line%direction, last - &
        line%point)])
      if (any(off > share*length)) length = 0.0_wp
    end associate
  end function length_on_line

  !> Cuts the way along which a block slides: of those on its line, the longest.
  pure subroutine add_block(linkage, slider, point, ways, carried)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: slider
    integer, intent(in) :: point      !! under the block
    type(cut_way_t), intent(inout) :: ways(:)
    type(carried_t), allocatable, intent(inout) :: carried(:)

    real(wp) :: length(size(ways))
    integer :: i

    length = 0.0_wp
    do i = 1, size(ways)
      if (ways(i)%body == linkage%sliders(slider)%body) length(i) = length_on_line(linkage, &
        slider, ways(i)%pins, near)
    end do
    i = maxloc(length, dim=1)
    ways(i)%cuts = [ways(i)%cuts, cut_t(point=point, slider=slider)]
    if (linkage%sliders(slider)%inertia > 0.0_wp) carried = [carried, &
      carried_t(body=ways(i)%body, way=i, point=point, inertia=linkage%sliders(slider)%inertia)]
  end subroutine add_block

  !> Cuts the ways of a link at its masses and at places of forces, where blocks cut them.
  pure subroutine add_places(linkage, b, points, ways, carried)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: b
    integer, intent(inout) :: points
    type(cut_way_t), intent(inout) :: ways(:)
    type(carried_t), allocatable, intent(inout) :: carried(:)

    integer :: i, first, last

    associate (body => linkage%bodies(b))
      call fixed_lumps(linkage, b, first, last)
      do i = first, last
        associate (lump => body%lumps(i))
          call add_carried(carried_t(body=b, mass=lump%mass, inertia=lump%inertia), lump%place, &
            points, ways, carried)
        end associate
      end do
      if (.not. allocated(body%forced)) return
      do i = 1, size(body%forced)
        call add_carried(carried_t(body=b, load=body%forced(i)%load), body%forced(i)%place, &
          points, ways, carried)
      end do
    end associate
  end subroutine add_places

  !> Adds what is fixed to a link at a place, if a block cuts the way there.
  pure subroutine add_carried(kind, place, points, ways, carried)
    type(carried_t), intent(in) :: kind   !! with its link
    real(wp), intent(in) :: place(2)      !! from the first pin of the link, in its axes [m]
    integer, intent(inout) :: points
    type(cut_way_t), intent(inout) :: ways(:)
    type(carried_t), allocatable, intent(inout) :: carried(:)

    type(carried_t) :: this
    real(wp) :: along

    this = kind
    call nearest_way(ways, this%body, place, this%way, this%place)
    if (size(ways(this%way)%cuts) == 0) return
    along = max(0.0_wp, min(ways(this%way)%length, this%place(1)))
    this%arm = this%place - [along, 0.0_wp]
    call cut_at(along, ways(this%way), points, this%point)
    carried = [carried, this]
  end subroutine add_carried

  !> Cuts a way at a place, if there is no end and no cut yet.
  pure subroutine cut_at(along, way, points, point)
    real(wp), intent(in) :: along          !! from where the way begins [m]
    type(cut_way_t), intent(inout) :: way
    integer, intent(inout) :: points       !! how many there are
    integer, intent(out) :: point          !! of the cut

    integer :: i

    point = 0
    if (along <= rounding*way%length) point = way%pins(1)
    if (along >= (1.0_wp - rounding)*way%length) point = way%pins(2)
    do i = 1, size(way%cuts)
      if (way%cuts(i)%slider > 0) cycle
      if (abs(way%cuts(i)%along - along) <= rounding*way%length) point = way%cuts(i)%point
    end do
    if (point > 0) return
    points = points + 1
    point = points
    way%cuts = [way%cuts, cut_t(point=point, along=along)]
  end subroutine cut_at

  !> The masses that are fixed to a link: not the link itself, nor blocks, which turn with the part
  !! under them.
  pure subroutine fixed_lumps(linkage, body, first, last)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: body         !! number of the link
    integer, intent(out) :: first, last !! numbers among its lumps; none: the first is beyond the
                                        !! last

    first = linkage%bodies(body)%own_lumps + 1
    last = size(linkage%bodies(body)%lumps) - count(linkage%sliders%body == body .and. &
      linkage%sliders%inertia > 0.0_wp)
  end subroutine fixed_lumps

  !> The way of a link that a place is nearest to, and the place on it.
  pure subroutine nearest_way(ways, body, place, number, on_way)
    type(cut_way_t), intent(in) :: ways(:) !! of all links
    integer, intent(in) :: body            !! number of the link
    real(wp), intent(in) :: place(2)       !! from its first pin, in its axes [m]
    integer, intent(out) :: number         !! of the way
    real(wp), intent(out) :: on_way(2)     !! from where the way begins, in its axes [m]

    real(wp) :: here(2), distance, least
    integer :: k

    number = 0
    least = huge(least)
    on_way = 0.0_wp
    do k = 1, size(ways)
      if (ways(k)%body /= body) cycle
      associate (axis => ways(k)%axis, arm => place - ways(k)%place)
        here = [dot_product(axis, arm), cross(axis, arm)]
      end associate
      distance = norm2([here(1) - max(0.0_wp, min(ways(k)%length, here(1))), here(2)])
      if (distance >= least) cycle
      least = distance
      number = k
      on_way = here
    end do
  end subroutine nearest_way

end module cut_ways
