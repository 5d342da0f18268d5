!> What acts on a rigid link of a vibrating linkage beside its pins: inertia, forces at places,
!! blocks that slide along it, springs.
module rigid_part_loads
  use border_rows, only: line_direction, spring_way
  use elastic_linkages, only: elastic_linkage_t
  use inertia_loads, only: distributed_load, load_t
  use kinds, only: wp
  use linkages, only: cross, linkage_t, normal_to, turned
  use load_cases, only: constant_case
  use part_displacements, only: border_t
  use part_forces, only: part_forces_t
  use part_poses, only: part_loads_t
  use poses, only: pose_t
  implicit none (type, external)
  private

  public :: load_on_rigid

contains

  !> The resultant of all but the forces at its pins, and the couples of turns, of drives and of
  !! springs that turn.
  pure function load_on_rigid(linkage, elastic, pose, loads, border, forces, case, part) &
    result(load)
    type(linkage_t), intent(in) :: linkage         !! that moves: its sliders and drives
    type(elastic_linkage_t), intent(in) :: elastic !! at this position
    type(pose_t), intent(in) :: pose               !! of points and parts
    type(part_loads_t), intent(in) :: loads        !! of this position
    type(border_t), intent(in) :: border           !! numbers of constraints
    type(part_forces_t), intent(in) :: forces      !! of these loads
    integer, intent(in) :: case                    !! number of the load case
    integer, intent(in) :: part                    !! number of the rigid part
    type(load_t) :: load                           !! about its first pin [N, N m]

    real(wp) :: way(2), change
    integer :: i, k

    associate (of_case => loads%unit%of_case(case))
      load = distributed_load(elastic%linkage%bodies(part), part, pose, of_case%field)
      load%moment = load%moment + of_case%couple(part)
      if (allocated(of_case%body_force)) load%force = load%force + of_case%body_force(:, part)
    end associate
    do i = 1, size(linkage%sliders)
      if (linkage%sliders(i)%body /= elastic%body(part)) cycle
      call add(-force_on_block(linkage, elastic, pose, border, forces, case, i), pose%pin(:, &
        linkage%sliders(i)%pin) - pose%pin(:, elastic%linkage%bodies(part)%first_pin))
    end do
    ! Pulls at the pose are among the forces at places; the linkage yields to the loads.
    do i = 1, size(elastic%springs)
      if (elastic%springs(i)%turns) cycle
      change = forces%spring(i, case)
      if (case == constant_case) change = change - loads%pull(i)
      way = spring_way(elastic, pose, i)
      if (norm2(way) > 0.0_wp) way = way/norm2(way)
      do k = 1, 2
        associate (at => elastic%linkage%loads(elastic%springs(i)%load)%at(k))
          if (at%pin > 0 .or. at%body /= elastic%body(part)) cycle
          call add(merge(change, -change, k == 1)*way, turned(at%place, pose%direction(:, part)))
        end associate
      end do
    end do

  contains

    !> Adds a force.
    pure subroutine add(force, arm)
      real(wp), intent(in) :: force(2), arm(2)

      load%force = load%force + force
      load%moment = load%moment + cross(arm, force)
    end subroutine add

  end function load_on_rigid

  !> Force of a guide on its block, with that of a drive that moves the block [N].
  pure function force_on_block(linkage, elastic, pose, border, forces, case, slider) result(force)
    type(linkage_t), intent(in) :: linkage
    type(elastic_linkage_t), intent(in) :: elastic
    type(pose_t), intent(in) :: pose
    type(border_t), intent(in) :: border
    type(part_forces_t), intent(in) :: forces
    integer, intent(in) :: case, slider
    real(wp) :: force(2)

    real(wp) :: direction(2)
    integer :: i, row

    direction = line_direction(elastic, pose, slider)
    force = forces%guide(slider, case)*normal_to(direction)
    do i = 1, size(linkage%drives)
      if (linkage%drives(i)%slider /= slider) cycle
      force = force + forces%drive(i, case)*direction
      row = border%numbers%drive_constraint(i)
      if (row > 0) force = force - forces%constraint(row, case)*direction
    end do
  end function force_on_block

end module rigid_part_loads
