!> Model → the coordinates of the linkage that have names.
module coordinate_builder
  use applied_load_types, only: applied_load_t, applies_along
  use coordinate_types, only: coordinate_t, is_across, is_along, is_angle, is_sum, terminal_t
  use coordinates, only: slider_coordinate
  use group_equations, only: direction_at
  use linkages, only: drive_of_angle, linkage_t
  use measure_cards, only: measure_across, measure_angle, measure_card_t, measure_distance, &
    measure_sum, measure_travel
  use models, only: model_t
  use name_index, only: find_name, name_index_t
  use named_coordinates, only: coordinate_number, find_named_coordinates, named_coordinate_t, &
    of_measure, of_ram, of_slider, of_spring
  use spring_builder, only: place_of
  implicit none (type, external)
  private

  public :: build_coordinates, listed_coordinate_t

  !> A coordinate of the linkage, by its number there, and what acts along it.
  type :: listed_coordinate_t
    character(len=:), allocatable :: name
    logical :: is_angle = .false. !! else a length
    integer :: load = 0           !! number of its spring or damper among the loads; 0: none
    integer :: drive = 0          !! number of the drive that gives it; 0: none
  end type listed_coordinate_t

contains

  !> The coordinates of springs and dampers, rams, sliders and measures, in this order.
  pure subroutine build_coordinates(model, links, pins, linkage, listed)
    type(model_t), intent(in) :: model         !! without errors
    integer, intent(in) :: links(:)            !! (bodies) numbers of their links in the model
    type(name_index_t), intent(in) :: pins     !! names of the pins
    type(linkage_t), intent(inout) :: linkage  !! with its loads, springs last; gets coordinates
    type(listed_coordinate_t), allocatable, intent(out) :: listed(:) !! (coordinates)

    type(named_coordinate_t), allocatable :: named(:)
    integer :: i, first_spring

    call find_named_coordinates(model, named)
    allocate (linkage%coordinates(size(named)), listed(size(named)))
    first_spring = size(linkage%loads) - size(model%springs)
    do i = 1, size(named)
      listed(i)%name = named(i)%name
      listed(i)%is_angle = named(i)%is_angle
      associate (it => linkage%coordinates(i), number => named(i)%number)
        select case (named(i)%source)
        case (of_spring)
          listed(i)%load = first_spring + number
          call take_load(linkage, linkage%loads(first_spring + number), it)
        case (of_ram)
          listed(i)%drive = number
          it%drive = held_by(linkage, number)
          associate (body => linkage%bodies(linkage%drives(number)%body))
            it%at(1)%pin = body%first_pin
            it%at(2)%pin = body%last_pin
          end associate
        case (of_slider)
          listed(i)%drive = findloc(linkage%drives%slider, number, dim=1)
          it = slider_coordinate(linkage, number)
          it%drive = held_by(linkage, listed(i)%drive)
        case (of_measure)
          call take_measure(model, links, pins, named, model%measures(number), linkage, it)
        end select
        if (it%kind == is_angle) it%drive = drive_of(linkage, it)
      end associate
    end do
  end subroutine build_coordinates

  !> The line between the ends of a spring, or the angle between its bodies.
  pure subroutine take_load(linkage, load, coordinate)
    type(linkage_t), intent(in) :: linkage
    type(applied_load_t), intent(in) :: load
    type(coordinate_t), intent(inout) :: coordinate

    integer :: k

    do k = 1, 2
      if (load%kind == applies_along) then
        coordinate%at(k) = terminal_of(linkage, load%at(k))
      else
        coordinate%kind = is_angle
        coordinate%at(k) = heading_of(linkage, load%body(k))
      end if
    end do
  end subroutine take_load

  !> A terminal at a place of a spring, which counts fixed places from a ground pivot.
  pure function terminal_of(linkage, place) result(at)
    type(linkage_t), intent(in) :: linkage
    type(terminal_t), intent(in) :: place
    type(terminal_t) :: at

    at = place
    if (place%pin == 0) return
    if (.not. linkage%is_ground(place%pin)) return
    at%pin = 0
    at%place = linkage%ground_position(:, place%pin) + place%place
  end function terminal_of

  !> The direction of a body whose angle is that of the body; of the ground the x axis.
  pure function heading_of(linkage, body) result(at)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: body !! 0: the ground
    type(terminal_t) :: at

    at%body = body
    if (body > 0) at%direction = linkage%bodies(body)%heading
  end function heading_of

  !> A drive that gives a value at every position; 0 of one that is free there.
  pure function held_by(linkage, drive) result(number)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: drive !! number; 0: none
    integer :: number

    number = drive
    if (drive > 1) number = merge(0, drive, linkage%drives(drive)%is_free)
  end function held_by

  !> The drive that gives an angle, with all whole turns; 0: none does.
  pure function drive_of(linkage, coordinate) result(number)
    type(linkage_t), intent(in) :: linkage
    type(coordinate_t), intent(in) :: coordinate
    integer :: number

    do number = 1, size(linkage%drives)
      associate (drive => linkage%drives(number))
        if (drive%kind == drive_of_angle .and. drive%body == coordinate%at(2)%body .and. &
          drive%against == coordinate%at(1)%body .and. held_by(linkage, number) > 0) return
      end associate
    end do
    number = 0
  end function drive_of

  !> What a MEASURE card says.
  pure subroutine take_measure(model, links, pins, named, measure, linkage, coordinate)
    type(model_t), intent(in) :: model
    integer, intent(in) :: links(:)
    type(name_index_t), intent(in) :: pins
    type(named_coordinate_t), intent(in) :: named(:)
    type(measure_card_t), intent(in) :: measure
    type(linkage_t), intent(in) :: linkage
    type(coordinate_t), intent(inout) :: coordinate

    integer :: i

    select case (measure%kind)
    case (measure_distance)
      do i = 1, 2
        coordinate%at(i) = terminal_of(linkage, place_of(model, links, pins, linkage, &
          measure%places(i)%text))
      end do
    case (measure_angle)
      coordinate%kind = is_angle
      if (measure%link(2) > 0) coordinate%at(1) = heading_of(linkage, findloc(links, &
        measure%link(2), dim=1))
      coordinate%at(2) = heading_of(linkage, findloc(links, measure%link(1), dim=1))
    case (measure_sum)
      coordinate%kind = is_sum
      coordinate%weight = measure%weights
      allocate (coordinate%term(size(measure%terms)))
      do i = 1, size(measure%terms)
        coordinate%term(i) = coordinate_number(named, measure%terms(i)%text)
      end do
    case default
      coordinate%kind = merge(is_across, is_along, measure%kind == measure_across)
      coordinate%at(2) = terminal_of(linkage, place_of(model, links, pins, linkage, &
        measure%places(1)%text))
      if (measure%kind == measure_travel) then
        coordinate%at(1)%direction = measure%direction
      else
        coordinate%at(1) = line_of_measure(model, links, linkage, measure)
      end if
    end select
  end subroutine take_measure

  !> A guide, or the line through the first two pins of a link, as sliders have them.
  pure function line_of_measure(model, links, linkage, measure) result(at)
    type(model_t), intent(in) :: model
    integer, intent(in) :: links(:)
    type(linkage_t), intent(in) :: linkage
    type(measure_card_t), intent(in) :: measure
    type(terminal_t) :: at

    if (measure%guide > 0) then
      at%place = model%guides(measure%guide)%point
      at%direction = direction_at(model%guides(measure%guide)%degrees)
    else
      at%body = findloc(links, measure%line_link, dim=1)
      associate (body => linkage%bodies(at%body))
        at%place = body%origin
        at%direction = body%card_axis
      end associate
    end if
  end function line_of_measure

end module coordinate_builder
