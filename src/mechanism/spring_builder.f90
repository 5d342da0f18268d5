!> Model → springs and dampers of the linkage.
module spring_builder
  use applied_load_types, only: applied_load_t, applies_along, counts_turns
  use constants, only: degree
  use coordinate_types, only: coordinate_t, is_angle, terminal_t
  use drive_values, only: drive_value
  use kinds, only: wp
  use link_shapes, only: find_drawn_place
  use linkages, only: body_t, drive_of_angle, linkage_t, turned
  use models, only: model_t, report_number
  use name_index, only: find_name, name_index_t
  use spring_cards, only: spring_card_t
  use stop_builder, only: contact_width
  use text, only: same_word
  implicit none (type, external)
  private

  public :: springs_of, coordinate_of_spring, place_of, angle_between

  !> Of a turn: an angle drawn at the first position is there.
  real(wp), parameter :: rounding = 1.0e-9_wp

contains

  !> The springs and dampers of a model, in the order of the deck.
  pure function springs_of(model, links, pins, linkage) result(loads)
    type(model_t), intent(in) :: model        !! without errors
    integer, intent(in) :: links(:)           !! (bodies) numbers of their links in the model
    type(name_index_t), intent(in) :: pins    !! names of the pins
    type(linkage_t), intent(in) :: linkage    !! its bodies
    type(applied_load_t), allocatable :: loads(:) !! (springs)

    integer :: i

    allocate (loads(size(model%springs)))
    do i = 1, size(loads)
      associate (load => loads(i), spring => model%springs(i))
        load%kind = applies_along
        load%along = coordinate_of_spring(model, links, pins, linkage, i)
        if (spring%turns) load%hinge = find_name(pins, spring%ends(1)%text)
        load%law = spring%law
        if (.not. spring%damps) call set_rest(model, pins, linkage, spring, load)
        if (load%law%side == 0) cycle
        load%name = spring%name%text
        load%law%rest = load%law%rest + load%law%side*spring%gap
        load%law%contact = contact_width(linkage, spring%law, spring%nature)
      end associate
    end do
  end function springs_of

  !> The coordinate of a spring or damper. Fixed places are counted from a ground pivot.
  pure function coordinate_of_spring(model, links, pins, linkage, number) result(coordinate)
    type(model_t), intent(in) :: model      !! without errors
    integer, intent(in) :: links(:)         !! (bodies) numbers of their links in the model
    type(name_index_t), intent(in) :: pins  !! names of the pins
    type(linkage_t), intent(in) :: linkage  !! bodies and drives
    integer, intent(in) :: number           !! of the spring, from 1
    type(coordinate_t) :: coordinate

    integer :: k

    associate (spring => model%springs(number))
      if (spring%turns .and. spring%link(2) > 0) then
        coordinate = angle_between(linkage, findloc(links, spring%link(1), dim=1), &
          findloc(links, spring%link(2), dim=1))
      else if (spring%turns) then
        ! One link turns against the ground.
        coordinate = angle_between(linkage, 0, findloc(links, spring%link(1), dim=1))
      else
        do k = 1, 2
          coordinate%at(k) = place_of(model, links, pins, linkage, spring%ends(k)%text)
        end do
      end if
    end associate
  end function coordinate_of_spring

  !> The angle of a body less that of another one or of the ground; with whole turns where a drive
  !! gives it at every position.
  pure function angle_between(linkage, against, body) result(coordinate)
    type(linkage_t), intent(in) :: linkage !! its drives
    integer, intent(in) :: against         !! number of the body; 0: the ground
    integer, intent(in) :: body            !! number
    type(coordinate_t) :: coordinate

    integer :: i

    coordinate%kind = is_angle
    coordinate%at%body = [against, body]
    do i = 1, 2
      associate (at => coordinate%at(i))
        if (at%body > 0) at%direction = linkage%bodies(at%body)%heading
      end associate
    end do
    do i = 1, size(linkage%drives)
      associate (drive => linkage%drives(i))
        if (drive%kind == drive_of_angle .and. drive%body == body .and. drive%against == against &
          .and. .not. (drive%is_free .and. i > 1)) coordinate%drive = i
      end associate
    end do
  end function angle_between

  !> The coordinate without load: given, or that of the drawing less the stretch of the load there.
  !! Without stiffness the load of the drawing stays.
  pure subroutine set_rest(model, pins, linkage, spring, load)
    type(model_t), intent(in) :: model
    type(name_index_t), intent(in) :: pins
    type(linkage_t), intent(in) :: linkage
    type(spring_card_t), intent(in) :: spring
    type(applied_load_t), intent(inout) :: load !! with its ends

    real(wp) :: place(2, 2)
    logical :: is_drawn
    integer :: k

    if (.not. load%law%stiffness > 0.0_wp) then
      load%law%tension = spring%load
    else if (spring%has_rest) then
      return
    else if (spring%turns) then
      associate (bodies => load%along%at%body)
        load%law%rest = drawn_angle(model, pins, linkage%bodies(bodies(2)))
        if (bodies(1) > 0) load%law%rest = load%law%rest - drawn_angle(model, pins, &
          linkage%bodies(bodies(1)))
      end associate
      if (counts_turns(load)) load%law%rest = turn_of_deck(model, linkage, load%along%drive, &
        load%law%rest)
      load%law%rest = load%law%rest - spring%load/load%law%stiffness
    else
      do k = 1, 2
        call find_drawn_place(model, spring%ends(k)%text, place(:, k), is_drawn)
      end do
      load%law%rest = norm2(place(:, 2) - place(:, 1)) - spring%load/load%law%stiffness
    end if
  end subroutine set_rest

  !> A pin, a point of a body, or a GROUND pin that is none of the linkage: such a place is counted
  !! from a ground pivot.
  pure function place_of(model, links, pins, linkage, name) result(at)
    type(model_t), intent(in) :: model        !! without errors
    integer, intent(in) :: links(:)           !! (bodies) numbers of their links in the model
    type(name_index_t), intent(in) :: pins    !! names of the pins
    type(linkage_t), intent(in) :: linkage    !! its bodies
    character(len=*), intent(in) :: name      !! in any case of letters
    type(terminal_t) :: at

    integer :: i

    at%pin = find_name(pins, name)
    if (at%pin > 0) return
    do i = 1, size(model%points)
      if (.not. same_word(model%points(i)%name%text, name)) cycle
      at%body = findloc(links, model%points(i)%link, dim=1)
      associate (body => linkage%bodies(at%body))
        at%place = body%origin + turned(model%points(i)%place, body%card_axis)
      end associate
      return
    end do
    at%pin = findloc(linkage%is_ground, .true., dim=1)
    do i = 1, size(model%grounds)
      if (same_word(model%grounds(i)%pin%text, name)) at%place = model%grounds(i)%position - &
        linkage%ground_position(:, at%pin)
    end do
  end function place_of

  !> The drawn angle that a drive gives with the whole turns that bring it among its positions in
  !! the deck, or next to them: a spring on it counts them [rad].
  pure function turn_of_deck(model, linkage, drive, angle) result(turned_angle)
    type(model_t), intent(in) :: model
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: drive       !! its number
    real(wp), intent(in) :: angle      !! [rad]
    real(wp) :: turned_angle

    real(wp), allocatable :: positions(:)
    real(wp) :: drawn
    integer :: i, motion

    positions = model%crank%value
    motion = report_number(model, "motion")
    if (motion > 0 .and. size(positions) == 0) positions = [model%reports(motion)%start_angle]
    turned_angle = angle
    if (size(positions) == 0) return
    positions = [(drive_value(linkage, drive, positions(i)), i=1, size(positions))]
    drawn = angle/degree
    associate (least => minval(positions), greatest => maxval(positions))
      ! The first turn from the least position on.
      drawn = drawn + 360.0_wp*ceiling((least - drawn)/360.0_wp - rounding)
      if (drawn > greatest .and. least - (drawn - 360.0_wp) < drawn - greatest) drawn = drawn - &
        360.0_wp
    end associate
    turned_angle = drawn*degree
  end function turn_of_deck

  !> Angle of a body in the drawing, as `body_angle` has it at a pose [rad].
  pure function drawn_angle(model, pins, body) result(angle)
    type(model_t), intent(in) :: model
    type(name_index_t), intent(in) :: pins
    type(body_t), intent(in) :: body
    real(wp) :: angle

    real(wp) :: start(2), end(2), way(2)
    logical :: is_drawn

    call find_drawn_place(model, pins%name(body%first_pin)%text, start, is_drawn)
    call find_drawn_place(model, pins%name(body%last_pin)%text, end, is_drawn)
    way = turned(body%heading, (end - start)/norm2(end - start))
    angle = atan2(way(2) + 0.0_wp, way(1) + 0.0_wp)
  end function drawn_angle

end module spring_builder
