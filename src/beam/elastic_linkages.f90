!> The linkage that vibrates: every link that bends in straight parts between the places where
!! something holds it, every rigid link as a part of its own.
!!
!! It is a linkage like the one that moves, with its parts for bodies and with points for pins: the
!! pins, and the places where links are cut (`cut_ways`): for every block on a link that bends the
!! point of the link under the block, and masses and forces on the same way. An end of a part is a
!! hinge, or it is held: it turns with a rotation, which other parts may share (a corner, a cut, a
!! weld, a block that does not turn, a spring), or not at all (at a drive).
!!
!! Of a crank and dyads of binary links every link is a part, and its pins move in closed form.
module elastic_linkages
  use applied_load_types, only: applied_load_t, applies_along, applies_force, is_torsional
  use beam_mesh, only: beam_t
  use coordinate_types, only: terminal_t
  use cut_ways, only: carried_t, cut_way_t, find_ways, fixed_lumps, nearest_way
  use elastic_terminals, only: elastic_terminal_t, fixed_rotation
  use kinds, only: wp
  use linkages, only: drive_of_angle, drive_of_length, drive_of_slider, forced_place_t, &
    is_dyad_linkage, linkage_t, lump_t
  use pose_types, only: pins_of_body
  use turning_ends, only: add_end, join_ends, new_turning_ends, number_of, number_ends, &
    turning_ends_t
  implicit none (type, external)
  private

  public :: elastic_linkage_t, spring_t, new_elastic_linkage, scaled_link, &
    is_piece, add_couple, shared_pin

  !> A spring, a constant tension or a damper of the linkage.
  type :: spring_t
    integer :: load = 0             !! its number among the loads
    logical :: turns = .false.      !! between two rotations; else along a line
    real(wp) :: stiffness = 0.0_wp  !! [N/m] or [N m/rad]
    real(wp) :: damping = 0.0_wp    !! of a damper [N s/m] or [N m s/rad]
  end type spring_t

  !> Parts, points and rotations.
  type :: elastic_linkage_t
    type(linkage_t) :: linkage                !! bodies: parts; pins: points
    logical :: in_closed_form = .false.       !! a crank and dyads of binary links, all held by
                                              !! their pins alone: these move in closed form
    type(beam_t), allocatable :: beams(:)     !! (parts)
    integer, allocatable :: body(:)           !! (parts) number of the link
    real(wp), allocatable :: place(:, :)      !! (2, parts) of the first point, from the first pin
                                              !! of the link, in its axes [m]
    real(wp), allocatable :: axis(:, :)       !! (2, parts) direction in the axes of the link
    logical, allocatable :: held(:, :)        !! (2, parts) ends of parts that bend
    integer, allocatable :: rotation(:, :)    !! (2, parts) of held ends, of a rigid part twice its
                                              !! own; 0: a hinge
    integer :: rotations = 0                  !! number of them
    logical, allocatable :: is_fixed(:)       !! (points) that do not move
    integer :: places = 0                     !! points that are neither pins nor under blocks, but
                                              !! at masses and forces: the last ones
    integer, allocatable :: contact(:)        !! (sliders) point of a link that bends under the
                                              !! block; 0: none
    type(cut_way_t), allocatable :: ways(:)   !! of links that bend, in the order of the parts
    integer, allocatable :: way(:)            !! (parts) number of the way; 0: a rigid link
    type(carried_t), allocatable :: carried(:) !! what cuts carry
    integer, allocatable :: cut_part(:)       !! (sliders) that ends there at the position; the next
                                              !! one begins
    ! What acts on the second of two terminals acts back on the first.
    type(elastic_terminal_t), allocatable :: load_ends(:, :) !! (2, loads) of a pull; of a force the
                                              !! second is where it acts
    type(elastic_terminal_t), allocatable :: sliding(:, :) !! (2, sliders) the guide under the
                                              !! block, the block
    type(elastic_terminal_t), allocatable :: driven(:, :) !! (2, drives) of an angle: against what,
                                              !! what turns; of a slider its own
    type(elastic_terminal_t), allocatable :: turning(:, :) !! (2, turns) with what, what turns
    type(elastic_terminal_t), allocatable :: rubbing(:, :) !! (2, frictions) on what, what rubs
    integer, allocatable :: free_drives(:)    !! numbers of drives that hold nothing: what they give
                                              !! follows from the motion
    type(spring_t), allocatable :: springs(:) !! with a stiffness
    type(spring_t), allocatable :: tensions(:) !! without one
    type(spring_t), allocatable :: dampers(:) !! with a damping
    logical :: changes_lengths = .false.      !! of some parts from position to position
  end type elastic_linkage_t

contains

  !> Whether a linkage is a crank and dyads of binary links, all held by their pins alone.
  pure function moves_in_closed_form(linkage) result(moves)
    type(linkage_t), intent(in) :: linkage !! planned, with its loads
    logical :: moves

    moves = is_dyad_linkage(linkage) .and. .not. any(linkage%drives%is_free)
    if (moves .and. allocated(linkage%loads)) moves = .not. any(linkage%loads%law%stiffness > &
      0.0_wp .or. is_tension(linkage%loads) .or. is_damper(linkage%loads))
  end function moves_in_closed_form

  !> Whether a load is a spring whose force does not change.
  elemental function is_tension(load) result(is)
    type(applied_load_t), intent(in) :: load
    logical :: is

    is = abs(load%law%tension) > 0.0_wp .and. .not. load%law%stiffness > 0.0_wp
  end function is_tension

  !> Whether a load is a damper along a line or between two bodies.
  elemental function is_damper(load) result(is)
    type(applied_load_t), intent(in) :: load
    logical :: is

    is = load%law%damping > 0.0_wp .and. load%kind == applies_along
  end function is_damper

  !> Divides a linkage into parts.
  pure function new_elastic_linkage(linkage, beams) result(elastic)
    type(linkage_t), intent(in) :: linkage        !! planned, with masses and loads
    type(beam_t), intent(in) :: beams(:)          !! (bodies) of links that bend
    type(elastic_linkage_t) :: elastic

    call add_points(linkage, elastic)
    call add_parts(linkage, beams, elastic)
    call add_rotations(linkage, elastic)
    elastic%in_closed_form = moves_in_closed_form(linkage)
    if (elastic%in_closed_form) elastic%linkage%groups = linkage%groups
  end function new_elastic_linkage

  !> Whether the length of a part of a link that bends, and its ends, are those of the position.
  elemental function is_piece(elastic, part) result(is)
    type(elastic_linkage_t), intent(in) :: elastic
    integer, intent(in) :: part             !! number, from 1
    logical :: is

    is = elastic%way(part) > 0
    if (is) is = size(elastic%ways(elastic%way(part))%cuts) > 0
  end function is_piece

  !> Adds a couple on a link, spread evenly over the length of one that bends. On a straight way
  !! that acts on the chord from end to end, however the way is divided.
  pure subroutine add_couple(elastic, body, couple, on_parts)
    type(elastic_linkage_t), intent(in) :: elastic !! at a position
    integer, intent(in) :: body                    !! number of the link
    real(wp), intent(in) :: couple                 !! [N m]
    real(wp), intent(inout) :: on_parts(:)         !! (parts) [N m]

    integer :: first, last

    first = findloc(elastic%body, body, dim=1)
    last = findloc(elastic%body, body, dim=1, back=.true.)
    if (first == last) then
      on_parts(first) = on_parts(first) + couple
    else
      associate (length => elastic%linkage%bodies(first:last)%length)
        on_parts(first:last) = on_parts(first:last) + couple*(length/sum(length))
      end associate
    end if
  end subroutine add_couple

  !> The pins, and the points of links under blocks and at other cuts.
  pure subroutine add_points(linkage, elastic)
    type(linkage_t), intent(in) :: linkage
    type(elastic_linkage_t), intent(inout) :: elastic

    integer :: i, n

    n = size(linkage%is_ground)
    allocate (elastic%contact(size(linkage%sliders)), elastic%cut_part(size(linkage%sliders)))
    elastic%contact = 0
    elastic%cut_part = 0
    do i = 1, size(linkage%sliders)
      if (linkage%sliders(i)%body == 0) cycle
      if (.not. linkage%bodies(linkage%sliders(i)%body)%bends) cycle
      n = n + 1
      elastic%contact(i) = n
    end do
    elastic%places = -n
    call find_ways(linkage, elastic%contact, n, elastic%ways, elastic%carried)
    elastic%places = elastic%places + n
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
      if (allocated(linkage%frictions)) parts%frictions = linkage%frictions
      parts%has_crank = linkage%has_crank
      allocate (parts%turns(0), parts%groups(0), parts%redundancies(0))
      elastic%is_fixed = parts%is_ground
    end associate
    do i = 1, size(linkage%drives)
      associate (drive => linkage%drives(i))
        if (drive%kind /= drive_of_slider .or. drive%is_free) cycle
        if (linkage%sliders(drive%slider)%body == 0) &
          elastic%is_fixed(linkage%sliders(drive%slider)%pin) = .true.
      end associate
    end do
  end subroutine add_points

  !> Rigid links, and the straight parts of all others.
  pure subroutine add_parts(linkage, beams, elastic)
    type(linkage_t), intent(in) :: linkage
    type(beam_t), intent(in) :: beams(:)
    type(elastic_linkage_t), intent(inout) :: elastic

    integer :: b, i, k, n

    n = count(.not. linkage%bodies%bends)
    do i = 1, size(elastic%ways)
      n = n + size(elastic%ways(i)%cuts) + 1
    end do
    allocate (elastic%linkage%bodies(n), elastic%linkage%couple(n), elastic%beams(n), &
      elastic%body(n), elastic%way(n), elastic%place(2, n), elastic%axis(2, n))
    elastic%linkage%couple = 0.0_wp
    elastic%body = 0
    elastic%way = 0
    n = 0
    i = 0
    do b = 1, size(linkage%bodies)
      if (.not. linkage%bodies(b)%bends) then
        n = n + 1
        elastic%linkage%bodies(n) = linkage%bodies(b)
        elastic%body(n) = b
        elastic%place(:, n) = 0.0_wp
        elastic%axis(:, n) = [1.0_wp, 0.0_wp]
        if (any(linkage%drives%kind == drive_of_length .and. linkage%drives%body == b)) &
          elastic%changes_lengths = .true.
        cycle
      end if
      do while (i < size(elastic%ways))
        if (elastic%ways(i + 1)%body /= b) exit
        i = i + 1
        elastic%ways(i)%first_part = n + 1
        do k = 0, size(elastic%ways(i)%cuts)
          n = n + 1
          call add_part(i, k, beams(b), elastic, n)
        end do
      end do
      call share_lumps(linkage, b, elastic)
    end do
  end subroutine add_parts

  !> A part of a way. Places and lengths of pieces, and the order of their ends, are those of a
  !! position; until then the whole way is the length of each.
  pure subroutine add_part(i, number, beam, elastic, part)
    integer, intent(in) :: i      !! number of the way
    integer, intent(in) :: number !! of the cut where it begins; 0: the first pin
    type(beam_t), intent(in) :: beam
    type(elastic_linkage_t), intent(inout) :: elastic
    integer, intent(in) :: part   !! its number

    associate (this => elastic%linkage%bodies(part), way => elastic%ways(i))
      elastic%body(part) = way%body
      elastic%way(part) = i
      elastic%place(:, part) = way%place
      elastic%axis(:, part) = way%axis
      elastic%beams(part) = beam
      this%first_pin = way%pins(1)
      this%last_pin = way%pins(2)
      if (number > 0) this%first_pin = way%cuts(number)%point
      if (number < size(way%cuts)) then
        this%last_pin = way%cuts(number + 1)%point
        if (way%cuts(number + 1)%slider > 0) elastic%cut_part(way%cuts(number + 1)%slider) = part
      end if
      this%length = way%length
      this%bends = .true.
      this%line_density = beam%line_density
      this%rotary_inertia = beam%rotary_inertia
      allocate (this%lumps(0), this%further(0))
      if (size(way%cuts) > 0) elastic%changes_lengths = .true.
    end associate
  end subroutine add_part

  !> Masses and places of forces of a link go to the way that they are nearest to. Where it is cut,
  !! the cuts carry them.
  pure subroutine share_lumps(linkage, b, elastic)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: b           !! number of the link
    type(elastic_linkage_t), intent(inout) :: elastic

    real(wp) :: place(2)
    integer :: i, k, first, last

    associate (lumps => linkage%bodies(b)%lumps, parts => elastic%linkage%bodies)
      call fixed_lumps(linkage, b, first, last)
      do i = first, last
        call nearest_way(elastic%ways, b, lumps(i)%place, k, place)
        if (size(elastic%ways(k)%cuts) > 0) cycle
        associate (part => parts(elastic%ways(k)%first_part))
          part%lumps = [part%lumps, lump_t(lumps(i)%mass, place, lumps(i)%inertia)]
        end associate
      end do
      if (.not. allocated(linkage%bodies(b)%forced)) return
      do k = 1, size(elastic%body)
        if (elastic%body(k) == b) allocate (parts(k)%forced(0))
      end do
      do i = 1, size(linkage%bodies(b)%forced)
        call nearest_way(elastic%ways, b, linkage%bodies(b)%forced(i)%place, k, place)
        if (size(elastic%ways(k)%cuts) > 0) cycle
        associate (part => parts(elastic%ways(k)%first_part))
          part%forced = [part%forced, forced_place_t(linkage%bodies(b)%forced(i)%load, place)]
        end associate
      end do
    end associate
  end subroutine share_lumps

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
        if (drive%kind /= drive_of_angle .or. drive%is_free) cycle
        n = shared_pin(linkage, drive%body, drive%against)
        call join_ends(ends, [drive%body, drive%against], [n, n])
      end associate
    end do
    if (allocated(linkage%loads)) then
      call add_springs(linkage, linkage%loads%law%stiffness > 0.0_wp, ends, elastic%springs)
      call add_springs(linkage, is_tension(linkage%loads), ends, elastic%tensions)
      call add_springs(linkage, is_damper(linkage%loads), ends, elastic%dampers)
    else
      allocate (elastic%springs(0), elastic%tensions(0), elastic%dampers(0))
    end if
    do i = 1, size(linkage%sliders)
      if (elastic%contact(i) > 0) call add_end(ends, linkage%sliders(i)%body, elastic%contact(i))
    end do
    do i = 1, size(elastic%carried)
      call add_end(ends, elastic%carried(i)%body, elastic%carried(i)%point)
    end do
    call number_ends(ends, elastic%rotations)
    n = size(elastic%body)
    allocate (elastic%rotation(2, n))
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
    do i = 1, size(elastic%ways)
      associate (way => elastic%ways(i))
        way%rotation = [(number_of(ends, way%body, way%pins(k)), k=1, 2)]
        do k = 1, size(way%cuts)
          way%cuts(k)%rotation = number_of(ends, way%body, way%cuts(k)%point)
        end do
      end associate
    end do
    do i = 1, size(elastic%carried)
      associate (this => elastic%carried(i))
        this%rotation = number_of(ends, this%body, this%point)
      end associate
    end do
    call add_terminals(linkage, ends, elastic)
  end subroutine add_rotations

  !> Where pulls and forces, blocks, drives and turns hold the linkage.
  pure subroutine add_terminals(linkage, ends, elastic)
    type(linkage_t), intent(in) :: linkage
    type(turning_ends_t), intent(in) :: ends !! numbered
    type(elastic_linkage_t), intent(inout) :: elastic

    integer :: i, k, pin, loads, frictions

    loads = 0
    if (allocated(linkage%loads)) loads = size(linkage%loads)
    frictions = 0
    if (allocated(linkage%frictions)) frictions = size(linkage%frictions)
    allocate (elastic%load_ends(2, loads), elastic%sliding(2, size(linkage%sliders)), &
      elastic%driven(2, size(linkage%drives)), elastic%turning(2, size(linkage%turns)), &
      elastic%rubbing(2, frictions))
    do i = 1, loads
      associate (load => linkage%loads(i), at => elastic%load_ends(:, i))
        if (load%kind == applies_force) then
          at(2) = place_on(load%at)
        else if (load%kind == applies_along) then
          do k = 1, 2
            if (is_torsional(load)) then
              at(k) = end_on(load%along%at(k)%body, spring_pin(linkage, i))
            else
              at(k) = place_on(load%along%at(k))
            end if
          end do
        end if
      end associate
    end do
    do i = 1, size(linkage%sliders)
      elastic%sliding(1, i) = end_on(linkage%sliders(i)%body, elastic%contact(i))
      if (elastic%sliding(1, i)%is_rigid) elastic%sliding(1, i)%block = linkage%sliders(i)%pin
      elastic%sliding(2, i)%point = linkage%sliders(i)%pin
    end do
    do i = 1, size(linkage%drives)
      associate (drive => linkage%drives(i))
        if (drive%kind == drive_of_slider) elastic%driven(:, i) = elastic%sliding(:, drive%slider)
        if (drive%kind /= drive_of_angle) cycle
        pin = shared_pin(linkage, drive%body, drive%against)
        elastic%driven(1, i) = end_on(drive%against, pin)
        elastic%driven(2, i) = end_on(drive%body, pin)
      end associate
    end do
    do i = 1, size(linkage%turns)
      associate (turn => linkage%turns(i))
        pin = turn%pin
        elastic%turning(2, i) = end_on(turn%body, pin)
        if (turn%slider > 0) then
          if (elastic%contact(turn%slider) > 0) pin = elastic%contact(turn%slider)
        end if
        elastic%turning(1, i) = end_on(turn%against, pin)
      end associate
    end do
    do i = 1, frictions
      associate (rub => linkage%frictions(i))
        if (rub%slider > 0) then
          elastic%rubbing(:, i) = elastic%sliding(:, rub%slider)
        else
          elastic%rubbing(1, i) = end_on(rub%against, rub%pin)
          elastic%rubbing(2, i) = end_on(rub%body, rub%pin)
        end if
      end associate
    end do
    elastic%free_drives = pack([(i, i=1, size(linkage%drives))], linkage%drives%is_free)

  contains

    !> The end of a link at a pin, or a rigid link as a whole.
    pure function end_on(body, pin) result(terminal)
      integer, intent(in) :: body !! number; 0: the ground
      integer, intent(in) :: pin  !! or point
      type(elastic_terminal_t) :: terminal

      terminal%rotation = fixed_rotation
      if (body == 0) return
      terminal%part = findloc(elastic%body, body, dim=1)
      terminal%rotation = number_of(ends, body, pin)
      terminal%point = pin
      terminal%is_rigid = .not. linkage%bodies(body)%bends
      if (terminal%is_rigid) terminal%point = linkage%bodies(body)%first_pin
    end function end_on

    !> A pin, a place on a rigid link, or one of a link that bends.
    pure function place_on(at) result(terminal)
      type(terminal_t), intent(in) :: at
      type(elastic_terminal_t) :: terminal

      terminal%point = at%pin
      if (at%body > 0) then
        terminal = end_on(at%body, 0)
        if (.not. terminal%is_rigid) terminal%point = 0
      end if
      terminal%place = at%place
    end function place_on

  end subroutine add_terminals

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
        spring%stiffness = load%law%stiffness
        spring%damping = load%law%damping
        spring%turns = is_torsional(load)
        if (.not. spring%turns) cycle
        do k = 1, 2
          if (load%along%at(k)%body > 0) call add_end(ends, load%along%at(k)%body, &
            spring_pin(linkage, loads(i)))
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
      pin = load%hinge
      if (pin == 0) pin = shared_pin(linkage, load%along%at(2)%body, load%along%at(1)%body)
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
    do k = 1, size(elastic%ways)
      if (elastic%ways(k)%body /= body) cycle
      associate (way => elastic%ways(k))
        way%place = factor*way%place
        way%length = factor*way%length
        way%cuts%along = factor*way%cuts%along
      end associate
    end do
    do k = 1, size(elastic%carried)
      associate (this => elastic%carried(k))
        if (this%body == body) this%place = factor*this%place
        if (this%body == body) this%arm = factor*this%arm
      end associate
    end do
  end subroutine scaled_link

end module elastic_linkages
