!> Model → the coordinates of the linkage that have names.
module coordinate_builder
  use coordinate_types, only: coordinate_t, is_across, is_along, is_sum, terminal_t
  use coordinates, only: slider_coordinate
  use drive_values, only: direction_at
  use linkages, only: linkage_t
  use measure_cards, only: measure_across, measure_angle, measure_card_t, measure_distance, &
    measure_sum, measure_travel
  use models, only: model_t
  use name_index, only: name_index_t
  use named_coordinates, only: coordinate_number, find_named_coordinates, named_coordinate_t, &
    of_measure, of_ram, of_slider, of_spring
  use natures, only: length_nature, nature_t
  use process_cards, only: over_measure
  use spring_builder, only: angle_between, coordinate_of_spring, place_of
  use units, only: coherent_unit
  implicit none (type, external)
  private

  public :: build_coordinates, list_coordinates, listed_coordinate_t

  !> A coordinate of the linkage, by its number there, and what acts along it.
  type :: listed_coordinate_t
    character(len=:), allocatable :: name
    type(nature_t) :: nature = length_nature
    integer :: drive = 0 !! number of the drive that gives it, or of the actuator along it, where
                         !! these give efforts; 0: none
  end type listed_coordinate_t

contains

  !> The coordinates of springs and dampers, rams, sliders and measures, in this order, and which of
  !! them are actuated, and loads are along and over.
  pure subroutine build_coordinates(model, links, pins, linkage, listed)
    type(model_t), intent(in) :: model         !! without errors
    integer, intent(in) :: links(:)            !! (bodies) numbers of their links in the model
    type(name_index_t), intent(in) :: pins     !! names of the pins
    type(linkage_t), intent(inout) :: linkage  !! with its loads: processes, then springs;
                                               !! gets coordinates and actuators
    type(listed_coordinate_t), allocatable, intent(out) :: listed(:) !! (coordinates)

    integer :: i

    call list_coordinates(model, links, pins, linkage, listed)
    ! Those of springs come first.
    do i = 1, size(model%springs)
      linkage%loads(size(model%processes) + i)%coordinate = i
    end do
    if (size(model%actuators) > 0) then
      listed%drive = 0
      allocate (linkage%actuators(size(model%actuators)))
      do i = 1, size(model%actuators)
        linkage%actuators(i)%coordinate = model%actuators(i)%coordinate
        linkage%actuators(i)%name = model%actuators(i)%name%text
        listed(model%actuators(i)%coordinate)%drive = i
      end do
    end if
    do i = 1, size(model%processes)
      associate (process => model%processes(i))
        if (process%over /= over_measure) cycle
        linkage%loads(i)%variable = linkage%coordinates(process%number)
        linkage%loads(i)%variable_name = listed(process%number)%name
        linkage%loads(i)%variable_unit = coherent_unit(model%units, &
          listed(process%number)%nature%value)
      end associate
    end do
  end subroutine build_coordinates

  !> The coordinates alone: a plan needs those that drives give.
  pure subroutine list_coordinates(model, links, pins, linkage, listed)
    type(model_t), intent(in) :: model         !! without errors
    integer, intent(in) :: links(:)            !! (bodies) numbers of their links in the model
    type(name_index_t), intent(in) :: pins     !! names of the pins
    type(linkage_t), intent(inout) :: linkage  !! gets coordinates
    type(listed_coordinate_t), allocatable, intent(out), optional :: listed(:) !! (coordinates)

    type(named_coordinate_t), allocatable :: named(:)
    integer :: drive, i

    call find_named_coordinates(model, named)
    if (allocated(linkage%coordinates)) deallocate (linkage%coordinates)
    allocate (linkage%coordinates(size(named)))
    if (present(listed)) allocate (listed(size(named)))
    do i = 1, size(named)
      associate (it => linkage%coordinates(i), number => named(i)%number)
        drive = 0
        select case (named(i)%source)
        case (of_spring)
          it = coordinate_of_spring(model, links, pins, linkage, number)
          it%at = [terminal_of(linkage, it%at(1)), terminal_of(linkage, it%at(2))]
        case (of_ram)
          drive = number
          associate (body => linkage%bodies(linkage%drives(number)%body))
            it%at(1)%pin = body%first_pin
            it%at(2)%pin = body%last_pin
          end associate
        case (of_slider)
          drive = findloc(linkage%drives%slider, number, dim=1)
          ! Its measure tells what drives it.
          if (drive > 0) then
            if (model%drives(drive)%measure > 0) drive = 0
          end if
          it = slider_coordinate(linkage, number)
        case (of_measure)
          drive = findloc(model%drives%measure, number, dim=1)
          call take_measure(model, links, pins, named, model%measures(number), linkage, it)
        end select
        if (drive > 0) it%drive = held_by(linkage, drive)
        if (.not. present(listed)) cycle
        listed(i)%name = named(i)%name
        listed(i)%nature = named(i)%nature
        listed(i)%drive = drive
      end associate
    end do
  end subroutine list_coordinates

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

  !> A drive that gives a value at every position; 0 of one that is free there.
  pure function held_by(linkage, drive) result(number)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: drive !! number; 0: none
    integer :: number

    number = drive
    if (drive > 1) number = merge(0, drive, linkage%drives(drive)%is_free)
  end function held_by

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
      i = 0
      if (measure%link(2) > 0) i = findloc(links, measure%link(2), dim=1)
      coordinate = angle_between(linkage, i, findloc(links, measure%link(1), dim=1))
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
