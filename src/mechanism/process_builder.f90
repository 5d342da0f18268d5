!> Model → loads of processes on the linkage.
module process_builder
  use applied_load_types, only: acts_against_motion, acts_always, acts_with_motion, &
    applied_load_t, applies_couple, applies_force, over_coordinate, over_time
  use body_attachments, only: place_on_body
  use coordinate_types, only: is_along
  use coordinates, only: slider_coordinate
  use cubic_splines, only: ends_not_a_knot, ends_periodic, new_cubic_spline, new_monotone_spline
  use linkages, only: linkage_t, turned
  use models, only: model_t, nature_of_positions
  use name_index, only: find_name, name_index_t
  use natures, only: angle_nature, length_nature, nature_t
  use process_cards, only: over_angle, over_drive, over_nothing, over_slider, &
    card_over_time => over_time, over_travel, process_card_t, process_force, process_resistance
  use spring_builder, only: angle_between
  use units, only: coherent_unit, dimension_time
  implicit none (type, external)
  private

  public :: process_loads

contains

  !> The loads of FORCE, TORQUE and LOAD cards that are not constant forces on pins or constant
  !! torques, in the order of the deck. What a table over a coordinate with a name is over is left
  !! to `build_coordinates`.
  pure function process_loads(model, links, pins, linkage) result(loads)
    type(model_t), intent(in) :: model        !! without errors
    integer, intent(in) :: links(:)           !! (bodies) numbers of their links in the model
    type(name_index_t), intent(in) :: pins    !! names of the pins
    type(linkage_t), intent(in) :: linkage    !! its bodies and sliders
    type(applied_load_t), allocatable :: loads(:)

    integer :: i

    allocate (loads(size(model%processes)))
    do i = 1, size(loads)
      associate (process => model%processes(i), load => loads(i))
        load%kind = merge(applies_force, applies_couple, process%kind == process_force .or. &
          .not. process%on_link)
        if (process%on_link) then
          load%at%body = findloc(links, process%link, dim=1)
          load%at%place = place_on_body(linkage%bodies(load%at%body), process%place)
        else
          load%at%pin = find_name(pins, process%subject%text)
        end if
        load%force = process%force
        load%is_carried = process%in_link_axes
        if (load%is_carried) load%force = turned(process%force, &
          linkage%bodies(load%at%body)%card_axis)
        load%couple = process%torque
        if (process%kind == process_resistance) load%couple = -process%torque
        load%law%damping = process%damping
        load%resisting = process%resisting
        load%smooth = process%smooth
        load%during = merge(acts_with_motion, acts_against_motion, process%during > 0)
        if (process%during == 0) load%during = acts_always
        if (process%over /= over_nothing) call set_table(model, process, links, linkage, load)
      end associate
    end do
  end function process_loads

  !> The table of a load; its force is then a unit vector.
  pure subroutine set_table(model, process, links, linkage, load)
    type(model_t), intent(in) :: model
    type(process_card_t), intent(in) :: process
    integer, intent(in) :: links(:)
    type(linkage_t), intent(in) :: linkage
    type(applied_load_t), intent(inout) :: load

    type(nature_t) :: nature

    load%table_name = process%table_word%text
    if (process%over == card_over_time) then
      load%table = new_monotone_spline(process%x, process%y)
    else
      load%table = new_cubic_spline(process%x, process%y, merge(ends_periodic, ends_not_a_knot, &
        process%is_periodic))
    end if
    if (process%kind == process_force) load%force = load%force/norm2(load%force)
    load%over = over_coordinate
    nature = length_nature
    select case (process%over)
    case (over_drive)
      load%variable%drive = 1
      nature = nature_of_positions(model)
    case (over_slider)
      load%variable = slider_coordinate(linkage, process%number)
    case (over_travel)
      load%variable%kind = is_along
      load%variable%at(1)%direction = load%force
      load%variable%at(2) = load%at
    case (over_angle)
      load%angle_name = process%over_word%text
      load%variable = angle_between(linkage, 0, findloc(links, process%number, dim=1))
      ! As in `kinematics.dat`, from −180° to 180°.
      load%variable%drive = 0
      nature = angle_nature
    case (card_over_time)
      load%over = over_time
    end select
    load%variable_unit = coherent_unit(model%units, nature%value)
    if (load%over == over_time) load%variable_unit = coherent_unit(model%units, dimension_time)
  end subroutine set_table

end module process_builder
