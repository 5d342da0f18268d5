!> Loads of parts beside those that a pose determines: dampers, resistances and loads in one
!! direction of the motion, friction in a joint, the torque of a motor. All are in the first case.
module part_efforts
  use applied_load_types, only: applies_couple, applies_force
  use applied_loads, only: evaluate_loads, is_moving, moving_couple, moving_force, moving_pulls
  use carried_bodies, only: carried_force
  use coordinates, only: evaluated_t
  use elastic_linkages, only: add_couple, elastic_linkage_t
  use elastic_positions, only: elastic_position_t
  use elastic_terminals, only: elastic_terminal_t
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkages, only: cross, linkage_t
  use load_cases, only: case_count
  use part_force_types, only: part_loads_t
  use part_poses, only: highest_force
  use poses, only: arm_to_place, pose_t
  use terminal_work, only: find_end, line_direction, terminal_arm
  implicit none (type, external)
  private

  public :: effort_case, no_part_loads, add_moving_efforts, add_friction_effort, add_drive_effort

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
      associate (load => linkage%loads(i), ends => at%elastic%load_ends(:, i))
        if (.not. is_moving(load)) cycle
        select case (load%kind)
        case (applies_force)
          call add_load(at, i, ends(2), moving_force(linkage, pose, now, load), 0.0_wp, loads)
        case (applies_couple)
          call add_couple(at%elastic, load%at%body, moving_couple(linkage, pose, now, load), &
            loads%unit%of_case(effort_case)%couple)
        case default
          do k = 1, 2
            associate (wrench => along(i)%wrench(k))
              call add_load(at, i, ends(k), -pull(i)*wrench%force, -pull(i)*wrench%couple, loads)
            end associate
          end do
        end select
      end associate
    end do
  end subroutine add_moving_efforts

  !> Adds the loads of a unit friction force or couple in a joint, as `put_friction` does.
  pure subroutine add_friction_effort(number, at, loads)
    integer, intent(in) :: number                   !! of the friction
    type(elastic_position_t), intent(in) :: at
    type(part_loads_t), intent(inout) :: loads      !! of these parts

    associate (slider => at%elastic%linkage%frictions(number)%slider, ends => &
        at%elastic%rubbing(:, number))
      if (slider > 0) then
        call add_load_between(at, ends, line_direction(at%elastic, at%pose, slider), 0.0_wp, loads)
      else
        call add_load_between(at, ends, [0.0_wp, 0.0_wp], 1.0_wp, loads)
      end if
    end associate
  end subroutine add_friction_effort

  !> Adds the torque of a drive of an angle.
  pure subroutine add_drive_effort(number, torque, at, loads)
    integer, intent(in) :: number                   !! of the drive
    real(wp), intent(in) :: torque                  !! [N m]
    type(elastic_position_t), intent(in) :: at
    type(part_loads_t), intent(inout) :: loads      !! of these parts

    call add_load_between(at, at%elastic%driven(:, number), [0.0_wp, 0.0_wp], torque, loads)
  end subroutine add_drive_effort

  !> Adds a force and a couple on the second of two terminals, and the opposite on the first.
  pure subroutine add_load_between(at, ends, force, couple, loads)
    type(elastic_position_t), intent(in) :: at
    type(elastic_terminal_t), intent(in) :: ends(2)
    real(wp), intent(in) :: force(2), couple
    type(part_loads_t), intent(inout) :: loads

    call add_load(at, 0, ends(2), force, couple, loads)
    call add_load(at, 0, ends(1), -force, -couple, loads)
  end subroutine add_load_between

  !> Adds a force and a couple at a terminal.
  pure subroutine add_load(at, number, terminal, force, couple, loads)
    type(elastic_position_t), intent(in) :: at
    integer, intent(in) :: number             !! of the load, at a place of a link that bends
    type(elastic_terminal_t), intent(in) :: terminal
    real(wp), intent(in) :: force(2), couple
    type(part_loads_t), intent(inout) :: loads

    integer :: part, end

    associate (case => loads%unit%of_case(effort_case))
      if (terminal%is_rigid) then
        part = terminal%part
        case%body_force(:, part) = case%body_force(:, part) + force
        case%couple(part) = case%couple(part) + couple + cross(terminal_arm(at%pose, terminal), &
          force)
        return
      end if
      if (terminal%point > 0) then
        case%pin_force(:, terminal%point) = case%pin_force(:, terminal%point) + force
      else if (terminal%part > 0) then
        call add_at_places(at%elastic, at%pose, number, terminal%part, force, loads)
      end if
    end associate
    if (terminal%part == 0 .or. .not. abs(couple) > 0.0_wp) return
    call find_end(at%elastic, terminal, part, end)
    loads%end_couple(end, part, effort_case) = loads%end_couple(end, part, effort_case) + couple
  end subroutine add_load

  !> Adds a force at a place between the points of a link that bends.
  pure subroutine add_at_places(elastic, placed, number, first, force, loads)
    type(elastic_linkage_t), intent(in) :: elastic
    type(pose_t), intent(in) :: placed
    integer, intent(in) :: number !! of the load
    integer, intent(in) :: first  !! part of the link
    real(wp), intent(in) :: force(2)
    type(part_loads_t), intent(inout) :: loads

    integer :: i, k

    associate (case => loads%unit%of_case(effort_case))
      do k = first, size(elastic%body)
        if (elastic%body(k) /= elastic%body(first)) exit
        associate (part => elastic%linkage%bodies(k))
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
  end subroutine add_at_places

end module part_efforts
