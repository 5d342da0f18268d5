!> Loads of parts beside those that a pose determines: dampers, resistances and loads in one
!! direction of the motion, friction in a joint, the torque of a motor. All are in the first case.
module part_efforts
  use applied_load_types, only: applies_couple, applies_force, is_torsional
  use applied_loads, only: evaluate_loads, is_moving, moving_couple, moving_force, moving_pulls
  use carried_bodies, only: carried_force
  use coordinate_types, only: terminal_t
  use coordinates, only: evaluated_t
  use elastic_linkages, only: add_couple, elastic_linkage_t, spring_pin
  use elastic_positions, only: elastic_position_t
  use group_equations, only: line_axis
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkages, only: cross, linkage_t
  use load_cases, only: case_count
  use part_force_types, only: part_loads_t
  use part_poses, only: highest_force
  use poses, only: arm_to_place, pose_t
  implicit none (type, external)
  private

  public :: effort_case, no_part_loads, add_moving_efforts, add_friction_effort, add_end_couple

  !> The case that holds these loads: one without what only loads at rest have.
  integer, parameter :: effort_case = 1

contains

  !> Parts without any loads.
  pure function no_part_loads(elastic) result(loads)
    type(elastic_linkage_t), intent(in) :: elastic !! parts, points, rotations
    type(part_loads_t) :: loads

    integer :: parts, points

    parts = size(elastic%body)
    points = size(elastic%is_fixed)
    loads%unit%occurs = .false.
    loads%unit%occurs(effort_case) = .true.
    allocate (loads%moment(elastic%rotations, case_count), source=0.0_wp)
    allocate (loads%pull(size(elastic%springs)), loads%tension(size(elastic%tensions)), &
      source=0.0_wp)
    allocate (loads%end_couple(2, parts, case_count), loads%carried(4, size(elastic%carried), &
      case_count), source=0.0_wp)
    associate (case => loads%unit%of_case(effort_case))
      allocate (case%field%at_pin(2, points), source=0.0_wp)
      allocate (case%field%at_first(2, parts), source=0.0_wp)
      allocate (case%field%slope(2, parts), source=0.0_wp)
      allocate (case%field%angular(parts), source=0.0_wp)
      allocate (case%pin_force(2, points), source=0.0_wp)
      allocate (case%couple(parts), source=0.0_wp)
      allocate (case%body_force(2, parts), source=0.0_wp)
      allocate (case%place_force(2, highest_force(elastic)), source=0.0_wp)
    end associate
  end function no_part_loads

  !> Adds dampers, resistances, and loads that act in one direction of the motion only.
  pure subroutine add_moving_efforts(linkage, pose, now, at, loads)
    type(linkage_t), intent(in) :: linkage          !! that moves, with its loads
    type(pose_t), intent(in) :: pose                !! of it
    type(kinematic_coefficients_t), intent(in) :: now !! velocities [m/s], [rad/s]
    type(elastic_position_t), intent(in) :: at      !! of it; places of such forces on parts that
                                                    !! bend are among its `forced`
    type(part_loads_t), intent(inout) :: loads      !! of these parts

    real(wp), allocatable :: pull(:)
    type(evaluated_t), allocatable :: along(:)
    integer :: i, k

    call evaluate_loads(linkage, pose, along)
    pull = moving_pulls(linkage, pose, along, now)
    do i = 1, size(linkage%loads)
      associate (load => linkage%loads(i))
        if (.not. is_moving(load)) cycle
        select case (load%kind)
        case (applies_force)
          call add_force(at%elastic, at%pose, i, load%at, moving_force(linkage, pose, now, load), &
            loads)
        case (applies_couple)
          call add_couple(at%elastic, load%at%body, moving_couple(linkage, pose, now, load), &
            loads%unit%of_case(effort_case)%couple)
        case default
          do k = 1, 2
            associate (wrench => along(i)%wrench(k))
              if (is_torsional(load)) then
                call add_end_couple(at%elastic, load%along%at(k)%body, spring_pin(linkage, &
                  i), -pull(i)*wrench%couple, loads)
              else
                call add_force(at%elastic, at%pose, i, load%along%at(k), -pull(i)*wrench%force, &
                  loads)
              end if
            end associate
          end do
        end select
      end associate
    end do
  end subroutine add_moving_efforts

  !> Adds the loads of a unit friction force or couple in a joint, as `put_friction` does.
  pure subroutine add_friction_effort(linkage, pose, number, at, loads)
    type(linkage_t), intent(in) :: linkage          !! that moves, with its frictions
    type(pose_t), intent(in) :: pose                !! of it
    integer, intent(in) :: number                   !! of the friction
    type(elastic_position_t), intent(in) :: at      !! of it
    type(part_loads_t), intent(inout) :: loads      !! of these parts

    real(wp) :: force(2)
    integer :: k

    associate (rub => linkage%frictions(number), case => loads%unit%of_case(effort_case))
      if (rub%slider == 0) then
        call add_end_couple(at%elastic, rub%body, rub%pin, 1.0_wp, loads)
        call add_end_couple(at%elastic, rub%against, rub%pin, -1.0_wp, loads)
        return
      end if
      force = line_axis(linkage, pose, rub%slider)
      case%pin_force(:, rub%pin) = case%pin_force(:, rub%pin) + force
      associate (carrier => linkage%sliders(rub%slider)%body, point => &
        at%elastic%contact(rub%slider))
        if (point > 0) then
          case%pin_force(:, point) = case%pin_force(:, point) - force
        else if (carrier > 0) then
          k = findloc(at%elastic%body, carrier, dim=1)
          case%body_force(:, k) = case%body_force(:, k) - force
          case%couple(k) = case%couple(k) - cross(at%pose%pin(:, rub%pin) - at%pose%pin(:, &
            at%elastic%linkage%bodies(k)%first_pin), force)
        end if
      end associate
    end associate
  end subroutine add_friction_effort

  !> Adds a couple on a link where it is at a pin: on the end of a part that bends.
  pure subroutine add_end_couple(elastic, body, pin, couple, loads)
    type(elastic_linkage_t), intent(in) :: elastic  !! parts
    integer, intent(in) :: body                     !! number of the link; 0: the ground
    integer, intent(in) :: pin                      !! one of its pins
    real(wp), intent(in) :: couple                  !! [N m]
    type(part_loads_t), intent(inout) :: loads      !! of these parts

    integer :: e, k

    if (body == 0) return
    k = findloc(elastic%body, body, dim=1)
    if (elastic%linkage%bodies(k)%bends) then
      do k = findloc(elastic%body, body, dim=1), findloc(elastic%body, body, dim=1, back=.true.)
        associate (part => elastic%linkage%bodies(k))
          e = findloc([part%first_pin, part%last_pin], pin, dim=1)
        end associate
        if (e == 0) cycle
        loads%end_couple(e, k, effort_case) = loads%end_couple(e, k, effort_case) + couple
        return
      end do
    end if
    call add_couple(elastic, body, couple, loads%unit%of_case(effort_case)%couple)
  end subroutine add_end_couple

  !> Adds a force at a pin or at a place of a link.
  pure subroutine add_force(elastic, placed, number, at, force, loads)
    type(elastic_linkage_t), intent(in) :: elastic
    type(pose_t), intent(in) :: placed
    integer, intent(in) :: number !! of the load
    type(terminal_t), intent(in) :: at
    real(wp), intent(in) :: force(2)
    type(part_loads_t), intent(inout) :: loads

    integer :: i, k

    associate (case => loads%unit%of_case(effort_case))
      if (at%pin > 0) then
        case%pin_force(:, at%pin) = case%pin_force(:, at%pin) + force
        return
      end if
      do k = findloc(elastic%body, at%body, dim=1), findloc(elastic%body, at%body, dim=1, &
        back=.true.)
        associate (part => elastic%linkage%bodies(k))
          if (.not. part%bends) then
            case%body_force(:, k) = case%body_force(:, k) + force
            case%couple(k) = case%couple(k) + cross(arm_to_place(placed, k, at%place), force)
            cycle
          end if
          if (.not. allocated(part%forced)) cycle
          do i = 1, size(part%forced)
            if (part%forced(i)%load /= number) cycle
            case%place_force(:, number) = case%place_force(:, number) + force
            case%body_force(:, k) = case%body_force(:, k) + force
            case%couple(k) = case%couple(k) + cross(arm_to_place(placed, k, &
              part%forced(i)%place), force)
          end do
        end associate
      end do
      do i = 1, size(elastic%carried)
        if (elastic%carried(i)%load == number) loads%carried(:3, i, effort_case) = &
          loads%carried(:3, i, effort_case) + carried_force(elastic, placed, i, force)
      end do
    end associate
  end subroutine add_force

end module part_efforts
