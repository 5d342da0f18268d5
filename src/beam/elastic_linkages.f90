!> The linkage that vibrates: every link that bends in straight parts between the places where
!! something holds it, every rigid link as a part of its own.
!!
!! It is a linkage like the one that moves, with its parts for bodies and with points for pins: the
!! pins, and for every block on a link that bends the point of the link under the block, where the
!! link is cut in two. An end of a part is a hinge, or it is held: it turns with a rotation, which
!! other parts may share (a corner, a weld, a block that does not turn, a spring), or not at all (at
!! a drive).
module elastic_linkages
  use applied_load_types, only: applied_load_t, applies_along, applies_between
  use beam_mesh, only: beam_t
  use kinds, only: wp
  use linkages, only: body_t, cross, drives_angle, drives_length, drives_slider, &
    forced_place_t, is_dyad_linkage, linkage_t, lump_t
  use pose_types, only: pins_of_body, place_of_pin
  use turning_ends, only: add_end, join_ends, new_turning_ends, number_of, number_ends, &
    turning_ends_t
  implicit none (type, external)
  private

  public :: elastic_linkage_t, spring_t, new_elastic_linkage, needs_parts, scaled_link, &
    fixed_rotation, spring_pin, shared_pin

  !> Of an end that cannot turn.
  integer, parameter :: fixed_rotation = -1

  !> A spring, a constant tension or a damper of the linkage.
  type :: spring_t
    integer :: load = 0             !! its number among the loads
    logical :: turns = .false.      !! between two rotations; else along a line
    integer :: rotation(2) = 0      !! numbers; the ground is a `fixed_rotation`
    real(wp) :: stiffness = 0.0_wp  !! [N/m] or [N m/rad]
    real(wp) :: damping = 0.0_wp    !! of a damper [N s/m] or [N m s/rad]
  end type spring_t

  !> Parts, points and rotations.
  type :: elastic_linkage_t
    type(linkage_t) :: linkage                !! bodies: parts; pins: points
    type(beam_t), allocatable :: beams(:)     !! (parts)
    integer, allocatable :: body(:)           !! (parts) number of the link
    real(wp), allocatable :: place(:, :)      !! (2, parts) of the first point, from the first pin
                                              !! of the link, in its axes [m]
    real(wp), allocatable :: axis(:, :)       !! (2, parts) direction in the axes of the link
    logical, allocatable :: held(:, :)        !! (2, parts) ends of parts that bend
    integer, allocatable :: rotation(:, :)    !! (2, parts) of held ends, of a rigid part twice its
                                              !! own; 0: a hinge
    integer :: rotations = 0                  !! number of them
    real(wp), allocatable :: rotation_inertia(:) !! (rotations) of blocks [kg m²]
    logical, allocatable :: is_fixed(:)       !! (points) that do not move
    integer, allocatable :: contact(:)        !! (sliders) point of a link that bends under the
                                              !! block; 0: none
    integer, allocatable :: cut_part(:)       !! (sliders) that ends there; the next one begins
    integer, allocatable :: guide_rotation(:) !! (sliders) of the guide at the block; 0: it is fixed
    type(spring_t), allocatable :: springs(:) !! with a stiffness
    type(spring_t), allocatable :: tensions(:) !! without one
    type(spring_t), allocatable :: dampers(:) !! with a damping
    logical :: changes_lengths = .false.      !! of some parts from position to position
  end type elastic_linkage_t

contains

  !> Whether a linkage is more than a crank and dyads of binary links, all held by their pins alone,
  !! whose pins move in closed form.
  pure function needs_parts(linkage) result(needs)
    type(linkage_t), intent(in) :: linkage !! planned, with its loads
    logical :: needs

    needs = .not. is_dyad_linkage(linkage)
    if (.not. needs) needs = any(linkage%drives%is_free)
    if (.not. needs .and. allocated(linkage%loads)) needs = any(linkage%loads%stiffness > 0.0_wp &
      .or. is_tension(linkage%loads) .or. is_damper(linkage%loads))
  end function needs_parts

  !> Whether a load is a spring whose force does not change.
  elemental function is_tension(load) result(is)
    type(applied_load_t), intent(in) :: load
    logical :: is

    is = abs(load%tension) > 0.0_wp .and. .not. load%stiffness > 0.0_wp
  end function is_tension

  !> Whether a load is a damper along a line or between two bodies.
  elemental function is_damper(load) result(is)
    type(applied_load_t), intent(in) :: load
    logical :: is

    is = load%damping > 0.0_wp .and. (load%kind == applies_along .or. load%kind == applies_between)
  end function is_damper

  !> Divides a linkage into parts.
  pure function new_elastic_linkage(linkage, beams) result(elastic)
    type(linkage_t), intent(in) :: linkage        !! planned, with masses and loads
    type(beam_t), intent(in) :: beams(:)          !! (bodies) of links that bend
    type(elastic_linkage_t) :: elastic

    call add_points(linkage, elastic)
    call add_parts(linkage, beams, elastic)
    call add_rotations(linkage, elastic)
  end function new_elastic_linkage

  !> The pins, and the points of links under blocks.
  pure subroutine add_points(linkage, elastic)
    type(linkage_t), intent(in) :: linkage
    type(elastic_linkage_t), intent(inout) :: elastic

    integer :: i, n

    n = size(linkage%is_ground)
    allocate (elastic%contact(size(linkage%sliders)), elastic%cut_part(size(linkage%sliders)), &
      elastic%guide_rotation(size(linkage%sliders)))
    elastic%contact = 0
    elastic%cut_part = 0
    elastic%guide_rotation = 0
    do i = 1, size(linkage%sliders)
      if (linkage%sliders(i)%body == 0) cycle
      if (.not. linkage%bodies(linkage%sliders(i)%body)%bends) cycle
      n = n + 1
      elastic%contact(i) = n
    end do
    associate (parts => elastic%linkage, pins => size(linkage%is_ground))
      allocate (parts%is_ground(n), parts%ground_position(2, n), parts%pin_mass(n), &
        parts%pin_force(2, n))
      parts%is_ground = .false.
      parts%ground_position = 0.0_wp
      parts%pin_mass = 0.0_wp
      parts%pin_force = 0.0_wp
      parts%is_ground(:pins) = linkage%is_ground
      parts%ground_position(:, :pins) = linkage%ground_position
      parts%pin_mass(:pins) = linkage%pin_mass
      parts%pin_force(:, :pins) = linkage%pin_force
      parts%gravity = linkage%gravity
      parts%loads = linkage%loads
      parts%sliders = linkage%sliders
      parts%drives = linkage%drives
      parts%has_crank = linkage%has_crank
      allocate (parts%turns(0), parts%groups(0), parts%redundancies(0))
      elastic%is_fixed = parts%is_ground
    end associate
    do i = 1, size(linkage%drives)
      associate (drive => linkage%drives(i))
        if (drive%kind /= drives_slider .or. drive%is_free) cycle
        if (linkage%sliders(drive%slider)%body == 0) &
          elastic%is_fixed(linkage%sliders(drive%slider)%pin) = .true.
      end associate
    end do
  end subroutine add_points

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

  !> Rigid links, and the straight parts of all others.
  pure subroutine add_parts(linkage, beams, elastic)
    type(linkage_t), intent(in) :: linkage
    type(beam_t), intent(in) :: beams(:)
    type(elastic_linkage_t), intent(inout) :: elastic

    integer, allocatable :: corners(:), cut(:)
    integer :: b, i, k, n, first

    n = count(elastic%contact > 0)
    do b = 1, size(linkage%bodies)
      if (linkage%bodies(b)%bends) then
        n = n + size(corners_of(linkage%bodies(b))) - 1
      else
        n = n + 1
      end if
    end do
    allocate (elastic%linkage%bodies(n), elastic%linkage%couple(n), elastic%beams(n), &
      elastic%body(n), elastic%place(2, n), elastic%axis(2, n))
    elastic%linkage%couple = 0.0_wp
    n = 0
    do b = 1, size(linkage%bodies)
      if (.not. linkage%bodies(b)%bends) then
        n = n + 1
        elastic%linkage%bodies(n) = linkage%bodies(b)
        elastic%body(n) = b
        elastic%place(:, n) = 0.0_wp
        elastic%axis(:, n) = [1.0_wp, 0.0_wp]
        if (any(linkage%drives%kind == drives_length .and. linkage%drives%body == b)) &
          elastic%changes_lengths = .true.
        cycle
      end if
      first = n + 1
      corners = corners_of(linkage%bodies(b))
      do k = 1, size(corners) - 1
        cut = pack([(i, i=1, size(linkage%sliders))], elastic%contact > 0 .and. &
          linkage%sliders%body == b)
        cut = pack(cut, [(is_under(linkage, cut(i), corners, k), i=1, size(cut))])
        n = n + 1
        call add_straight(linkage, b, corners(k:k + 1), elastic, n)
        if (size(cut) == 0) cycle
        ! Places on both parts are those of the position.
        elastic%changes_lengths = .true.
        elastic%linkage%bodies(n)%last_pin = elastic%contact(cut(1))
        elastic%cut_part(cut(1)) = n
        n = n + 1
        call add_straight(linkage, b, corners(k:k + 1), elastic, n)
        elastic%linkage%bodies(n)%first_pin = elastic%contact(cut(1))
      end do
      do k = first, n
        elastic%beams(k) = beams(b)
        elastic%linkage%bodies(k)%line_density = beams(b)%line_density
        elastic%linkage%bodies(k)%rotary_inertia = beams(b)%rotary_inertia
      end do
      call share_lumps(linkage, b, first, n, elastic)
    end do
    elastic%linkage%bodies = elastic%linkage%bodies(:n)
    elastic%linkage%couple = elastic%linkage%couple(:n)
    elastic%beams = elastic%beams(:n)
    elastic%body = elastic%body(:n)
    elastic%place = elastic%place(:, :n)
    elastic%axis = elastic%axis(:, :n)
  end subroutine add_parts

  !> A straight part between two pins of a link.
  pure subroutine add_straight(linkage, b, pins, elastic, number)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: b       !! number of the link
    integer, intent(in) :: pins(2) !! where it begins and ends
    type(elastic_linkage_t), intent(inout) :: elastic
    integer, intent(in) :: number  !! of the part

    real(wp) :: way(2)

    elastic%body(number) = b
    associate (part => elastic%linkage%bodies(number), body => linkage%bodies(b))
      elastic%place(:, number) = place_of_pin(body, pins(1))
      way = place_of_pin(body, pins(2)) - elastic%place(:, number)
      part%first_pin = pins(1)
      part%last_pin = pins(2)
      part%length = norm2(way)
      elastic%axis(:, number) = way/part%length
      part%bends = .true.
      allocate (part%lumps(0), part%further(0))
    end associate
  end subroutine add_straight

  !> Whether a block slides along this straight part of its link: of those on its line, the longest.
  pure function is_under(linkage, slider, corners, k) result(is)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: slider     !! number, along this link
    integer, intent(in) :: corners(:)
    integer, intent(in) :: k          !! the part from corner k to the next
    logical :: is

    real(wp) :: length(size(corners) - 1)
    integer :: i

    do i = 1, size(length)
      length(i) = length_on_line(linkage, slider, corners(i:i + 1))
    end do
    is = length(k) > 0.0_wp .and. k == maxloc(length, dim=1)
  end function is_under

  !> Length of a straight part that lies on the line of a block; 0: it does not.
  pure function length_on_line(linkage, slider, pins) result(length)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: slider
    integer, intent(in) :: pins(2)
    real(wp) :: length

    real(wp), parameter :: near = 1.0e-6_wp
    real(wp) :: first(2), last(2), off(2)

    associate (line => linkage%sliders(slider), &
        body => linkage%bodies(linkage%sliders(slider)%body))
      first = place_of_pin(body, pins(1))
      last = place_of_pin(body, pins(2))
      length = norm2(last - first)
      off = abs([cross(line%direction, first - line%point), cross(line%direction, last - &
        line%point)])
      if (any(off > near*length)) length = 0.0_wp
    end associate
  end function length_on_line

  !> Masses and places of forces of a link go to the straight part that they are nearest to.
  pure subroutine share_lumps(linkage, b, first, last, elastic)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: b           !! number of the link
    integer, intent(in) :: first, last !! its parts
    type(elastic_linkage_t), intent(inout) :: elastic

    real(wp) :: place(2)
    integer :: i, k, blocks

    ! Blocks turn with the part under them.
    blocks = count(linkage%sliders%body == b .and. linkage%sliders%inertia > 0.0_wp)
    associate (lumps => linkage%bodies(b)%lumps, parts => elastic%linkage%bodies)
      do i = linkage%bodies(b)%own_lumps + 1, size(lumps) - blocks
        call nearest_part(lumps(i)%place, elastic, first, last, k, place)
        parts(k)%lumps = [parts(k)%lumps, lump_t(lumps(i)%mass, place, lumps(i)%inertia)]
      end do
      if (.not. allocated(linkage%bodies(b)%forced)) return
      do k = first, last
        allocate (parts(k)%forced(0))
      end do
      do i = 1, size(linkage%bodies(b)%forced)
        call nearest_part(linkage%bodies(b)%forced(i)%place, elastic, first, last, k, place)
        parts(k)%forced = [parts(k)%forced, forced_place_t(linkage%bodies(b)%forced(i)%load, place)]
      end do
    end associate
  end subroutine share_lumps

  !> The part that a place of a link is nearest to, and the place on it.
  pure subroutine nearest_part(place, elastic, first, last, part, on_part)
    real(wp), intent(in) :: place(2) !! from the first pin of the link, in its axes [m]
    type(elastic_linkage_t), intent(in) :: elastic
    integer, intent(in) :: first, last !! parts of the link
    integer, intent(out) :: part
    real(wp), intent(out) :: on_part(2) !! from its first point, in its axes [m]

    real(wp) :: here(2), from, distance, least
    integer :: k

    part = first
    least = huge(least)
    on_part = 0.0_wp
    do k = first, last
      from = elastic%linkage%bodies(k)%length
      associate (axis => elastic%axis(:, k), way => place - elastic%place(:, k))
        here = [dot_product(axis, way), cross(axis, way)]
      end associate
      distance = norm2([here(1) - max(0.0_wp, min(from, here(1))), here(2)])
      if (distance >= least) cycle
      least = distance
      part = k
      on_part = here
    end do
  end subroutine nearest_part

  !> What turns together.
  pure subroutine add_rotations(linkage, elastic)
    type(linkage_t), intent(in) :: linkage
    type(elastic_linkage_t), intent(inout) :: elastic

    type(turning_ends_t) :: ends
    integer :: i, k, n

    ends = new_turning_ends(linkage)
    do k = 1, size(elastic%body)
      associate (part => elastic%linkage%bodies(k))
        if (.not. part%bends) then
          call add_end(ends, elastic%body(k), 0)
        else if (k > 1) then
          if (elastic%body(k - 1) == elastic%body(k)) call add_end(ends, elastic%body(k), &
            part%first_pin)
        end if
      end associate
    end do
    do k = 1, size(linkage%bodies)
      if (.not. linkage%bodies(k)%bends .or. .not. allocated(linkage%bodies(k)%corners)) cycle
      associate (corners => linkage%bodies(k)%corners)
        if (corners(1) == corners(size(corners))) call add_end(ends, k, corners(1))
      end associate
    end do
    do i = 1, size(linkage%turns)
      associate (turn => linkage%turns(i))
        n = turn%pin
        if (turn%slider > 0) then
          if (elastic%contact(turn%slider) > 0) n = elastic%contact(turn%slider)
        end if
        call join_ends(ends, [turn%body, turn%against], [turn%pin, n])
      end associate
    end do
    do i = 1, size(linkage%drives)
      associate (drive => linkage%drives(i))
        if (drive%kind /= drives_angle .or. drive%is_free) cycle
        n = shared_pin(linkage, drive%body, drive%against)
        call join_ends(ends, [drive%body, drive%against], [n, n])
      end associate
    end do
    if (allocated(linkage%loads)) then
      call add_springs(linkage, linkage%loads%stiffness > 0.0_wp, ends, elastic%springs)
      call add_springs(linkage, is_tension(linkage%loads), ends, elastic%tensions)
      call add_springs(linkage, is_damper(linkage%loads), ends, elastic%dampers)
    else
      allocate (elastic%springs(0), elastic%tensions(0), elastic%dampers(0))
    end if
    do i = 1, size(linkage%sliders)
      if (elastic%contact(i) > 0) call add_end(ends, linkage%sliders(i)%body, elastic%contact(i))
    end do
    call number_ends(ends, elastic%rotations)
    n = size(elastic%body)
    allocate (elastic%rotation(2, n), elastic%rotation_inertia(elastic%rotations))
    do k = 1, n
      associate (part => elastic%linkage%bodies(k))
        if (part%bends) then
          elastic%rotation(1, k) = number_of(ends, elastic%body(k), part%first_pin)
          elastic%rotation(2, k) = number_of(ends, elastic%body(k), part%last_pin)
        else
          elastic%rotation(:, k) = number_of(ends, elastic%body(k), 0)
        end if
      end associate
    end do
    elastic%held = elastic%rotation /= 0
    do k = 1, n
      if (.not. elastic%linkage%bodies(k)%bends) elastic%held(:, k) = .false.
    end do
    elastic%rotation_inertia = 0.0_wp
    do i = 1, size(linkage%sliders)
      if (linkage%sliders(i)%body == 0) cycle
      elastic%guide_rotation(i) = number_of(ends, linkage%sliders(i)%body, elastic%contact(i))
      k = elastic%guide_rotation(i)
      ! The block of a rigid link is among its lumps.
      if (elastic%contact(i) > 0 .and. k > 0) elastic%rotation_inertia(k) = &
        elastic%rotation_inertia(k) + linkage%sliders(i)%inertia
    end do
    call number_springs(linkage, ends, elastic%springs)
    call number_springs(linkage, ends, elastic%tensions)
    call number_springs(linkage, ends, elastic%dampers)
  end subroutine add_rotations

  !> Rotations of springs, tensions or dampers that turn.
  pure subroutine number_springs(linkage, ends, springs)
    type(linkage_t), intent(in) :: linkage
    type(turning_ends_t), intent(in) :: ends
    type(spring_t), intent(inout) :: springs(:)

    integer :: i, k

    do i = 1, size(springs)
      if (.not. springs(i)%turns) cycle
      associate (load => linkage%loads(springs(i)%load))
        do k = 1, 2
          springs(i)%rotation(k) = fixed_rotation
          if (load%body(k) > 0) springs(i)%rotation(k) = number_of(ends, load%body(k), &
            spring_pin(linkage, springs(i)%load))
        end do
      end associate
    end do
  end subroutine number_springs

  !> Springs, tensions or dampers; those that turn hold the ends that they turn.
  pure subroutine add_springs(linkage, is_one, ends, springs)
    type(linkage_t), intent(in) :: linkage
    logical, intent(in) :: is_one(:) !! (loads)
    type(turning_ends_t), intent(inout) :: ends
    type(spring_t), allocatable, intent(out) :: springs(:)

    integer, allocatable :: loads(:)
    integer :: i, k

    loads = pack([(i, i=1, size(is_one))], is_one)
    allocate (springs(size(loads)))
    do i = 1, size(loads)
      associate (spring => springs(i), load => linkage%loads(loads(i)))
        spring%load = loads(i)
        spring%stiffness = load%stiffness
        spring%damping = load%damping
        spring%turns = load%kind == applies_between
        if (.not. spring%turns) cycle
        do k = 1, 2
          if (load%body(k) > 0) call add_end(ends, load%body(k), spring_pin(linkage, loads(i)))
        end do
      end associate
    end do
  end subroutine add_springs

  !> The pin at which a spring turns two links.
  pure function spring_pin(linkage, number) result(pin)
    type(linkage_t), intent(in) :: linkage !! its loads
    integer, intent(in) :: number          !! of the load, between two bodies
    integer :: pin

    associate (load => linkage%loads(number))
      pin = load%at(1)%pin
      if (pin == 0) pin = shared_pin(linkage, load%body(2), load%body(1))
    end associate
  end function spring_pin

  !> A pin of two links, or a ground pivot of one; its first pin if there is none.
  pure function shared_pin(linkage, body, other) result(pin)
    type(linkage_t), intent(in) :: linkage !! its bodies
    integer, intent(in) :: body, other     !! numbers; the other may be 0: the ground
    integer :: pin

    integer, allocatable :: pins(:)
    integer :: i

    pins = pins_of_body(linkage%bodies(body))
    do i = 1, size(pins)
      pin = pins(i)
      if (other == 0) then
        if (linkage%is_ground(pin)) return
      else if (any(pins_of_body(linkage%bodies(other)) == pin)) then
        return
      end if
    end do
    pin = pins(1)
  end function shared_pin

  !> The same linkage with one link, its places and its parts, longer or shorter, but for its
  !! stiffness and mass: how the rounding of a length acts.
  pure subroutine scaled_link(linkage, elastic, body, factor)
    type(linkage_t), intent(inout) :: linkage            !! that moves
    type(elastic_linkage_t), intent(inout) :: elastic    !! of this linkage
    integer, intent(in) :: body                          !! number of the link
    real(wp), intent(in) :: factor                       !! near 1

    integer :: g, i, k

    associate (this => linkage%bodies(body))
      this%length = factor*this%length
      do i = 1, size(this%further)
        this%further(i)%place = factor*this%further(i)%place
      end do
    end associate
    do g = 1, size(linkage%groups)
      if (.not. allocated(linkage%groups(g)%equations)) cycle
      do i = 1, size(linkage%groups(g)%equations)
        associate (equation => linkage%groups(g)%equations(i))
          if (equation%body == body) equation%place = factor*equation%place
        end associate
      end do
    end do
    do k = 1, size(elastic%body)
      if (elastic%body(k) /= body) cycle
      associate (part => elastic%linkage%bodies(k))
        part%length = factor*part%length
        do i = 1, size(part%further)
          part%further(i)%place = factor*part%further(i)%place
        end do
      end associate
      elastic%place(:, k) = factor*elastic%place(:, k)
    end do
  end subroutine scaled_link

end module elastic_linkages
