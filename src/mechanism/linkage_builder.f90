!> Model → linkage: pins, bodies, sliders, welds and drives by number, and the plan of its groups.
module linkage_builder
  use assembly_plan, only: plan_linkage
  use chosen_assemblies, only: choose_assembly
  use constants, only: degree
  use coordinate_builder, only: list_coordinates
  use drive_cards, only: branch_backward, branch_left, branch_right, drive_card_t, drive_ram, &
    drive_slider
  use drawn_cranks, only: starting_cranks
  use drawn_places, only: complete_drawing
  use errors, only: error_t
  use drive_values, only: direction_at
  use kinds, only: wp
  use link_axis, only: foot_on_axis, foot_t, lies_on_axis
  use link_cards, only: has_own_mass, segment_count
  use link_shapes, only: find_drawn_link, find_drawn_pin, find_link_shape
  use linkage_paths, only: follow_path
  use linkages, only: body_t, drive_of_angle, drive_of_coordinate, drive_of_length, &
    drive_of_nothing, drive_of_slider, drive_t, linkage_t
  use measure_cards, only: measure_along, measure_angle
  use models, only: is_four_bar, is_pin, model_t, report_number, rule_at_change_points, &
    runs_in_time
  use natures, only: are_alike, is_angular
  use motion_programs, only: program_period
  use name_index, only: find_name, name_index_t, new_name_index
  use named_coordinates, only: measured_coordinate
  use plan_problems, only: plan_problem_t
  use plan_sides, only: side_t, undecided_t
  use pose_types, only: pose_t
  use text, only: same_word, string_t
  use tokens, only: token_t
  implicit none (type, external)
  private

  public :: assembly_t, assemble_linkage

  !> A linkage, planned, with the parts of the deck that its numbers stand for.
  type :: assembly_t
    type(linkage_t) :: linkage             !! without masses and loads
    integer, allocatable :: link(:)        !! (bodies) numbers in the model
    type(string_t), allocatable :: pins(:) !! (pins) their names
    type(plan_problem_t), allocatable :: problem !! why there is no plan
    type(error_t), allocatable :: error    !! why there is no path of groups that iterations place
    type(pose_t), allocatable :: nearest   !! then the assembly nearest to the drawing, if any
  end type assembly_t

contains

  !> The linkage of a model: its bodies in the order in which they are placed, the crank first.
  !!
  !! Errors: a linkage without a plan has a problem; its numbers are those of the deck's order.
  pure subroutine assemble_linkage(model, assembly)
    type(model_t), intent(in) :: model         !! without errors
    type(assembly_t), intent(out) :: assembly  !! with a plan, or a problem

    type(side_t), allocatable :: sides(:)
    type(undecided_t) :: undecided
    integer, allocatable :: body_order(:), pin_order(:)
    integer :: i

    call list_pins(model, assembly%pins)
    assembly%link = [(i, i=1, size(model%links))]
    call build_from_cards(model, assembly, sides)
    call plan_linkage(assembly%linkage, sides, assembly%problem, body_order, pin_order, &
      undecided)
    if (allocated(assembly%problem)) return
    assembly%link = assembly%link(body_order)
    assembly%pins = assembly%pins(pin_order)
    call build_from_cards(model, assembly, sides)
    call plan_linkage(assembly%linkage, sides, assembly%problem, body_order, pin_order, &
      undecided)
    if (is_four_bar(model)) assembly%linkage%bodies(2)%heading = [1.0_wp, 0.0_wp]
    if (allocated(assembly%problem)) return
    call choose_assembly(assembly%linkage, sides, undecided, starting_cranks(model, &
      assembly%linkage), assembly%problem)
    if (allocated(assembly%problem)) return
    call follow_path(assembly%linkage, starting_cranks(model, assembly%linkage), &
      rule_at_change_points(model), assembly%nearest, assembly%error)
  end subroutine assemble_linkage

  !> The pins of all links in the order of the deck, points of links that other cards use as pins,
  !! springs of frequencies among them, and ground pivots that only sliders or springs use.
  pure subroutine list_pins(model, pins)
    type(model_t), intent(in) :: model
    type(string_t), allocatable, intent(out) :: pins(:)

    integer :: i, k

    allocate (pins(0))
    do i = 1, size(model%links)
      do k = 1, size(model%links(i)%pins)
        call add_pin(model%links(i)%pins(k), pins)
      end do
    end do
    do i = 1, size(model%sliders)
      call add_pin(model%sliders(i)%pin, pins)
    end do
    do i = 1, size(model%pin_masses)
      call add_pin(model%pin_masses(i)%pin, pins)
    end do
    do i = 1, size(model%forces)
      call add_pin(model%forces(i)%pin, pins)
    end do
    do i = 1, size(model%processes)
      if (.not. model%processes(i)%on_link) call add_pin(model%processes(i)%subject, pins)
    end do
    if (is_four_bar(model)) return
    do i = 1, size(model%springs)
      do k = 1, 2
        if (is_ground(model, model%springs(i)%ends(k)) .or. is_pin(model, &
          model%springs(i)%ends(k)%text)) call add_pin(model%springs(i)%ends(k), pins)
      end do
    end do
    do i = 1, size(model%drawn_pins)
      call add_pin(model%drawn_pins(i)%pin, pins)
    end do
  end subroutine list_pins

  !> Whether a GROUND card has this pin.
  pure function is_ground(model, pin) result(is)
    type(model_t), intent(in) :: model
    type(token_t), intent(in) :: pin
    logical :: is

    integer :: i

    is = .false.
    do i = 1, size(model%grounds)
      is = is .or. same_word(model%grounds(i)%pin%text, pin%text)
    end do
  end function is_ground

  !> Adds a pin to a list that does not have it.
  pure subroutine add_pin(pin, pins)
    type(token_t), intent(in) :: pin
    type(string_t), allocatable, intent(inout) :: pins(:)

    type(string_t), allocatable :: longer(:)
    integer :: i

    if (pin%line == 0) return
    do i = 1, size(pins)
      if (same_word(pins(i)%text, pin%text)) return
    end do
    allocate (longer(size(pins) + 1))
    longer(:size(pins)) = pins
    longer(size(longer))%text = pin%text
    call move_alloc(longer, pins)
  end subroutine add_pin

  !> Pins, bodies, sliders, turns, drives and sides, in the order of the assembly's lists.
  pure subroutine build_from_cards(model, assembly, sides)
    type(model_t), intent(in) :: model
    type(assembly_t), intent(inout) :: assembly
    type(side_t), allocatable, intent(out) :: sides(:)

    type(name_index_t) :: pins
    type(linkage_t) :: linkage
    integer :: i, k, n

    pins = new_name_index(assembly%pins)
    n = size(assembly%pins)
    allocate (linkage%is_ground(n), linkage%ground_position(2, n), linkage%pin_mass(n), &
      linkage%pin_force(2, n), linkage%couple(size(assembly%link)), &
      linkage%bodies(size(assembly%link)), linkage%drawing%is_drawn(n), linkage%drawing%pin(2, n), &
      linkage%loads(0))
    linkage%is_ground = .false.
    linkage%ground_position = 0.0_wp
    linkage%pin_mass = 0.0_wp
    linkage%pin_force = 0.0_wp
    linkage%couple = 0.0_wp
    do i = 1, size(model%grounds)
      k = find_name(pins, model%grounds(i)%pin%text)
      if (k == 0) cycle
      linkage%is_ground(k) = .true.
      linkage%ground_position(:, k) = model%grounds(i)%position
    end do
    do i = 1, n
      call find_drawn_pin(model, assembly%pins(i)%text, linkage%drawing%pin(:, i), &
        linkage%drawing%is_drawn(i))
    end do
    do i = 1, size(assembly%link)
      call take_body(model, pins, assembly%link(i), linkage%is_ground, linkage%bodies(i))
    end do
    call take_sliders(model, pins, assembly%link, linkage)
    call take_turns(model, pins, assembly%link, linkage)
    call take_drives(model, assembly%link, linkage)
    if (any(model%drives%measure > 0)) call list_coordinates(model, assembly%link, pins, linkage)
    call take_sides(model, pins, sides)
    if (size(model%drawn_pins) > 0) call complete_drawing(linkage, model%crank%value)
    assembly%linkage = linkage
  end subroutine build_from_cards

  !> A body with the pins of its link: the first two of the card are its first and last.
  pure subroutine take_body(model, pins, number, is_ground, body)
    type(model_t), intent(in) :: model
    type(name_index_t), intent(in) :: pins
    integer, intent(in) :: number          !! of the link in the model
    logical, intent(in) :: is_ground(:)
    type(body_t), intent(inout) :: body

    real(wp), allocatable :: places(:, :)
    integer, allocatable :: points(:)
    real(wp) :: way(2)
    logical :: known
    integer :: i, k, grounded

    associate (link => model%links(number))
      call find_link_shape(model, link, places, known)
      points = points_as_pins(model, pins, number)
      body%first_pin = find_name(pins, link%pins(1)%text)
      body%last_pin = find_name(pins, link%pins(2)%text)
      body%length = places(1, 2)
      ! The length of a ram is its drive's; here it only stands for a direction.
      if (.not. body%length > 0.0_wp) then
        body%length = 1.0_wp
        places(:, 2) = [body%length, 0.0_wp]
      end if
      body%bends = .not. link%rigid
      body%may_brace = body%bends .and. link%section > 0
      allocate (body%lumps(0), body%further(size(link%pins) - 2 + size(points)))
      do i = 3, size(link%pins)
        body%further(i - 2)%pin = find_name(pins, link%pins(i)%text)
        body%further(i - 2)%place = places(:, i)
      end do
      do i = 1, size(points)
        k = size(link%pins) - 2 + i
        body%further(k)%pin = find_name(pins, model%points(points(i))%name%text)
        body%further(k)%place = model%points(points(i))%place
      end do
      if (body%bends .and. .not. has_own_mass(link)) call take_corners(model, pins, number, &
        places, points, body)
      ! Its angle is that of the way from its ground pivot to the next pin of the card.
      grounded = 0
      do i = size(link%pins), 1, -1
        if (is_ground(find_name(pins, link%pins(i)%text))) grounded = i
      end do
      if (grounded > 1) then
        way = places(:, modulo(grounded, size(link%pins)) + 1) - places(:, grounded)
        body%heading = way/norm2(way)
      end if
    end associate
  end subroutine take_body

  !> The corners of a link that bends, if it has more than two pins: its pins in the order of the
  !! card, and between them points on its axis that are pins.
  pure subroutine take_corners(model, pins, number, places, points, body)
    type(model_t), intent(in) :: model
    type(name_index_t), intent(in) :: pins
    integer, intent(in) :: number          !! of the link in the model
    real(wp), intent(in) :: places(:, :)   !! (2, pins) of its pins, in the axes of the card [m]
    integer, intent(in) :: points(:)       !! numbers of the points in the model
    type(body_t), intent(inout) :: body

    type(foot_t) :: feet(size(points))
    integer :: segment, i, next

    associate (link => model%links(number))
      if (size(link%pins) + size(points) == 2) return
      do i = 1, size(points)
        feet(i) = foot_on_axis(places, link%is_closed, model%points(points(i))%place)
        if (.not. lies_on_axis(places, feet(i))) feet(i)%segment = 0
      end do
      allocate (body%corners(0))
      do segment = 1, segment_count(link)
        body%corners = [body%corners, find_name(pins, link%pins(segment)%text)]
        do
          next = findloc(feet%segment, segment, dim=1)
          if (next == 0) exit
          next = minloc(feet%along, dim=1, mask=feet%segment == segment)
          body%corners = [body%corners, find_name(pins, model%points(points(next))%name%text)]
          feet(next)%segment = 0
        end do
      end do
      next = mod(segment_count(link), size(link%pins)) + 1
      body%corners = [body%corners, find_name(pins, link%pins(next)%text)]
    end associate
  end subroutine take_corners

  !> The points of a link that are pins: other cards name them.
  pure function points_as_pins(model, pins, number) result(points)
    type(model_t), intent(in) :: model
    type(name_index_t), intent(in) :: pins
    integer, intent(in) :: number !! of the link in the model
    integer, allocatable :: points(:)

    integer :: i

    points = pack([(i, i=1, size(model%points))], model%points%link == number .and. &
      [(find_name(pins, model%points(i)%name%text) > 0, i=1, size(model%points))])
  end function points_as_pins

  !> Pins on guides and on links: the line of a link is that through the first two pins of its card.
  pure subroutine take_sliders(model, pins, link, linkage)
    type(model_t), intent(in) :: model
    type(name_index_t), intent(in) :: pins
    integer, intent(in) :: link(:)
    type(linkage_t), intent(inout) :: linkage

    integer :: i

    allocate (linkage%sliders(size(model%sliders)))
    do i = 1, size(model%sliders)
      associate (card => model%sliders(i), slider => linkage%sliders(i))
        slider%pin = find_name(pins, card%pin%text)
        if (card%guide > 0) then
          slider%point = model%guides(card%guide)%point
          slider%direction = direction_at(model%guides(card%guide)%degrees)
        else
          slider%body = findloc(link, card%link, dim=1)
          slider%inertia = card%inertia
          call find_ends(model, card%link, slider%has_ends, slider%ends)
        end if
      end associate
    end do
  end subroutine take_sliders

  !> A block lies between the outermost pins and points of its link that are on the line. A link
  !! whose length is driven has no other end than that.
  pure subroutine find_ends(model, number, has_ends, ends)
    type(model_t), intent(in) :: model
    integer, intent(in) :: number       !! of the link in the model
    logical, intent(out) :: has_ends
    real(wp), intent(out) :: ends(2)    !! from the first pin towards the second [m]

    real(wp), parameter :: on_line = 1.0e-6_wp !! distance from the line, as a share of the link
    real(wp), allocatable :: places(:, :)
    real(wp) :: near
    integer :: i

    ends = 0.0_wp
    has_ends = .not. any(model%drives%kind == drive_ram .and. model%drives%link == number)
    if (.not. has_ends) return
    call find_link_shape(model, model%links(number), places, has_ends)
    near = on_line*maxval(abs(places))
    do i = 1, size(places, 2)
      call reach(places(:, i), near, ends)
    end do
    do i = 1, size(model%points)
      if (model%points(i)%link == number) call reach(model%points(i)%place, near, ends)
    end do
  end subroutine find_ends

  !> Moves the ends of a line out to a place, if it is on the line.
  pure subroutine reach(place, near, ends)
    real(wp), intent(in) :: place(2)    !! [m]
    real(wp), intent(in) :: near        !! farthest from the line [m]
    real(wp), intent(inout) :: ends(2)  !! [m]

    if (abs(place(2)) <= near) ends = [min(ends(1), place(1)), max(ends(2), place(1))]
  end subroutine reach

  !> Links that cannot turn on a block, welds, clamps: at the angle of the drawing. Without one a
  !! link lies along the line of its block.
  pure subroutine take_turns(model, pins, link, linkage)
    type(model_t), intent(in) :: model
    type(name_index_t), intent(in) :: pins
    integer, intent(in) :: link(:)
    type(linkage_t), intent(inout) :: linkage

    integer :: i, k, turns

    turns = count(model%sliders%turned_link > 0)
    do i = 1, size(model%welds)
      turns = turns + max(0, size(model%welds(i)%link) - 1)
    end do
    do i = 1, size(model%clamps)
      turns = turns + size(model%clamps(i)%link)
    end do
    allocate (linkage%turns(turns))
    turns = 0
    do i = 1, size(model%sliders)
      associate (card => model%sliders(i))
        if (card%turned_link == 0) cycle
        turns = turns + 1
        linkage%turns(turns)%body = findloc(link, card%turned_link, dim=1)
        linkage%turns(turns)%slider = i
        linkage%turns(turns)%pin = linkage%sliders(i)%pin
        if (card%link > 0) then
          linkage%turns(turns)%against = findloc(link, card%link, dim=1)
          linkage%turns(turns)%relative = angle_between(drawn_axis(model, card%link), &
            drawn_axis(model, card%turned_link))
        else
          linkage%turns(turns)%relative = drawn_axis(model, card%turned_link)
          if (.not. norm2(linkage%turns(turns)%relative) > 0.0_wp) &
            linkage%turns(turns)%relative = linkage%sliders(i)%direction
        end if
      end associate
    end do
    do i = 1, size(model%welds)
      do k = 2, size(model%welds(i)%link)
        turns = turns + 1
        linkage%turns(turns)%body = findloc(link, model%welds(i)%link(k), dim=1)
        linkage%turns(turns)%against = findloc(link, model%welds(i)%link(1), dim=1)
        linkage%turns(turns)%pin = find_name(pins, model%welds(i)%pin%text)
        linkage%turns(turns)%relative = angle_between(drawn_axis(model, model%welds(i)%link(1)), &
          drawn_axis(model, model%welds(i)%link(k)))
      end do
    end do
    do i = 1, size(model%clamps)
      do k = 1, size(model%clamps(i)%link)
        turns = turns + 1
        linkage%turns(turns)%body = findloc(link, model%clamps(i)%link(k), dim=1)
        linkage%turns(turns)%pin = find_name(pins, model%clamps(i)%pin%text)
        linkage%turns(turns)%relative = drawn_axis(model, model%clamps(i)%link(k))
      end do
    end do
  end subroutine take_turns

  !> Direction of the first segment of a link in the drawing; zero where it is not drawn.
  pure function drawn_axis(model, number) result(axis)
    type(model_t), intent(in) :: model
    integer, intent(in) :: number !! of the link
    real(wp) :: axis(2)

    real(wp), allocatable :: drawn(:, :)
    logical :: is_drawn

    axis = 0.0_wp
    call find_drawn_link(model, model%links(number), drawn, is_drawn)
    if (.not. is_drawn) return
    axis = drawn(:, 2) - drawn(:, 1)
    if (norm2(axis) > 0.0_wp) axis = axis/norm2(axis)
  end function drawn_axis

  !> A direction in the axes that another one gives; along it where either is unknown.
  pure function angle_between(axis, direction) result(relative)
    real(wp), intent(in) :: axis(2), direction(2)
    real(wp) :: relative(2)

    relative = [dot_product(axis, direction), axis(1)*direction(2) - axis(2)*direction(1)]
    if (norm2(relative) > 0.0_wp) then
      relative = relative/norm2(relative)
    else
      relative = [1.0_wp, 0.0_wp]
    end if
  end function angle_between

  !> Drives in degrees and metres.
  pure subroutine take_drives(model, link, linkage)
    type(model_t), intent(in) :: model
    integer, intent(in) :: link(:)
    type(linkage_t), intent(inout) :: linkage

    real(wp) :: unit
    integer :: i

    if (model%is_structure) then
      allocate (linkage%drives(1))
      linkage%drives(1)%kind = drive_of_nothing
      return
    end if
    allocate (linkage%drives(size(model%drives)))
    if (runs_in_time(model)) call take_times(model, linkage)
    do i = 1, size(model%drives)
      associate (card => model%drives(i), drive => linkage%drives(i))
        drive%kind = drive_of_angle
        drive%is_free = card%is_free
        if (card%kind == drive_slider) drive%kind = drive_of_slider
        if (card%kind == drive_ram) drive%kind = drive_of_length
        if (card%link > 0) drive%body = findloc(link, card%link, dim=1)
        if (card%against_link > 0 .and. drive%kind == drive_of_angle) &
          drive%against = findloc(link, card%against_link, dim=1)
        if (drive%kind == drive_of_slider) drive%slider = card%slider
        if (card%measure > 0) call take_measured(model, card, link, drive)
        if (i == 1) cycle
        unit = 1.0_wp
        if (is_angular(card%nature)) unit = 1.0_wp/degree
        drive%ratio = card%ratio*unit
        if (is_angular(model%drives(1)%nature)) drive%ratio = drive%ratio*degree
        if (are_alike([card%nature, model%drives(1)%nature])) drive%ratio = card%ratio
        drive%phase = card%phase*unit
        ! It moves, and not as the first one does.
        if (drive%has_law) drive%ratio = 1.0_wp
        if (card%has_at) then
          drive%ratio = 0.0_wp
          drive%phase = card%at*unit
        end if
      end associate
    end do
  end subroutine take_drives

  !> A drive of a MEASURE: of the angle of a link, or of a pin along the line on which it slides,
  !! as if these were driven by name.
  pure subroutine take_measured(model, card, link, drive)
    type(model_t), intent(in) :: model
    type(drive_card_t), intent(in) :: card
    integer, intent(in) :: link(:)
    type(drive_t), intent(inout) :: drive

    integer :: i

    associate (measure => model%measures(card%measure))
      if (measure%kind == measure_angle) then
        drive%body = findloc(link, measure%link(1), dim=1)
        if (measure%link(2) > 0) drive%against = findloc(link, measure%link(2), dim=1)
        return
      end if
      drive%kind = drive_of_coordinate
      drive%coordinate = measured_coordinate(model, card%measure)
      drive%is_angle = is_angular(card%nature)
      if (measure%kind /= measure_along) return
      do i = 1, size(model%sliders)
        if (.not. same_word(model%sliders(i)%pin%text, measure%places(1)%text)) cycle
        if (.not. same_word(model%sliders(i)%on%text, measure%line%text)) cycle
        drive%kind = drive_of_slider
        drive%slider = i
      end do
    end associate
  end subroutine take_measured

  !> Laws of drives, and between which instants they are wanted; a path needs some way.
  pure subroutine take_times(model, linkage)
    type(model_t), intent(in) :: model
    type(linkage_t), intent(inout) :: linkage

    real(wp), parameter :: shortest = 1.0e-6_wp !! [s]
    real(wp) :: range(2)
    integer :: i

    linkage%runs_in_time = .true.
    do i = 1, size(linkage%drives)
      linkage%drives(i)%has_law = model%drives(i)%law%line > 0
      if (linkage%drives(i)%has_law) linkage%drives(i)%law = model%programs(i)
    end do
    if (size(model%time%value) == 0) return
    linkage%times = [minval(model%time%value), maxval(model%time%value)]
    ! Ratings are those of a whole period.
    if (report_number(model, "sizing") > 0) then
      do i = 1, size(linkage%drives)
        range = program_period(linkage%drives(i)%law)
        if (range(2) > range(1)) linkage%times = [min(linkage%times(1), range(1)), &
          max(linkage%times(2), range(2))]
      end do
    end if
    linkage%times(2) = max(linkage%times(2), linkage%times(1) + shortest)
  end subroutine take_times

  !> The sides that BRANCH cards give.
  pure subroutine take_sides(model, pins, sides)
    type(model_t), intent(in) :: model
    type(name_index_t), intent(in) :: pins
    type(side_t), allocatable, intent(out) :: sides(:)

    integer :: i

    allocate (sides(size(model%branches)))
    do i = 1, size(sides)
      associate (card => model%branches(i))
        sides(i)%pin = find_name(pins, card%pin%text)
        if (any(card%which == [branch_right, branch_backward])) sides(i)%side = -1.0_wp
        sides(i)%on_line = .not. any(card%which == [branch_left, branch_right])
        if (.not. sides(i)%on_line) sides(i)%base = [find_name(pins, card%from%text), &
          find_name(pins, card%to%text)]
      end associate
    end do
  end subroutine take_sides

end module linkage_builder
