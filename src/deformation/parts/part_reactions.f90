!> Forces in the joints of a linkage by its elasticity: those that statics alone cannot tell apart.
!!
!! What its neighbours do to a part that bends is the work of its border forces on the displacements
!! of its ends, less the work of its loads on them. To a rigid link they do the forces of its
!! constraints, and at its first pin what is left in equilibrium.
module part_reactions
  use acceleration_fields, only: acceleration_field_t
  use border_loads, only: border_work
  use border_rows, only: border_unknowns_t, part_rows
  use drive_rates, only: end_at_joint, turn_of_end
  use elastic_linkages, only: elastic_linkage_t
  use inertia_loads, only: load_t
  use joint_forces, only: joint_forces_t
  use kinds, only: wp
  use link_modes, only: link_modes_t
  use linkages, only: drive_of_angle, linkage_t, normal_to
  use load_cases, only: load_case_t
  use part_couples, only: find_part_couples
  use part_force_types, only: part_forces_t
  use part_poses, only: part_loads_t
  use pin_displacements, only: chords_t
  use pose_types, only: pins_of_body
  use poses, only: pose_t
  use rigid_part_loads, only: load_on_rigid
  implicit none (type, external)
  private

  public :: take_part_reactions

contains

  !> Puts the forces of a load case in place of those of statics; what drives do is left, for it
  !! follows from the power.
  pure subroutine take_part_reactions(linkage, elastic, links, pose, loads, numbers, forces, case, &
    joints, given, open)
    type(linkage_t), intent(in) :: linkage         !! that moves: its bodies, sliders and turns
    type(elastic_linkage_t), intent(in) :: elastic !! at this position
    type(link_modes_t), intent(in) :: links(:)     !! (parts)
    type(pose_t), intent(in) :: pose               !! of points and parts
    type(part_loads_t), intent(in) :: loads        !! of this position
    type(border_unknowns_t), intent(in) :: numbers !! of constraints
    type(part_forces_t), intent(in) :: forces      !! of these loads
    integer, intent(in) :: case                    !! number of the load case
    type(joint_forces_t), intent(inout) :: joints  !! of this linkage
    real(wp), intent(in), optional :: given(:)     !! (open couples) as of `find_part_couples`
    integer, allocatable, intent(out), optional :: open(:) !! (open couples) likewise

    real(wp) :: on_part(6, size(links)), force(2)
    integer :: b, i, k, further

    do k = 1, size(links)
      on_part(:, k) = 0.0_wp
      if (elastic%linkage%bodies(k)%bends) on_part(:, k) = on_ends(elastic, links(k), k, pose, &
        loads%unit%of_case(case), numbers, forces%weighted(:, case), torques_of_drives(linkage, &
        elastic, k, forces%drive(:, case)) + merge(loads%end_couple(:, k, case), 0.0_wp, &
        elastic%rotation(:, k) == 0))
    end do
    further = 0
    do b = 1, size(linkage%bodies)
      do i = 1, 2 + size(linkage%bodies(b)%further)
        force = force_on_link(linkage, elastic, pose, loads, numbers, forces, case, on_part, b, i)
        if (i == 1) then
          joints%on_first(:, b) = force
        else if (i == 2) then
          joints%on_last(:, b) = force
        else
          joints%on_further(:, further + i - 2) = force
        end if
      end do
      further = further + size(linkage%bodies(b)%further)
    end do
    if (allocated(joints%guide)) joints%guide = forces%guide(:, case)
    if (allocated(joints%couple)) call find_part_couples(linkage, elastic, pose, loads, numbers, &
      forces, case, on_part, joints, given, open)
  end subroutine take_part_reactions

  !> Forces on both ends of a part that bends, and moments: as the displacements of `part_rows`.
  pure function on_ends(elastic, link, part, pose, case, numbers, weighted, torque) &
    result(on_part)
    type(elastic_linkage_t), intent(in) :: elastic
    type(link_modes_t), intent(in) :: link
    integer, intent(in) :: part
    type(pose_t), intent(in) :: pose
    type(load_case_t), intent(in) :: case
    type(border_unknowns_t), intent(in) :: numbers
    real(wp), intent(in) :: weighted(:)
    real(wp), intent(in) :: torque(2) !! of drives and loads on its hinged ends [N m]
    real(wp) :: on_part(6)

    type(linkage_t) :: alone
    type(load_case_t) :: its_case
    type(pose_t) :: its_pose
    type(chords_t) :: chords
    real(wp) :: rows(6, 1 + link%curves)
    integer :: i

    rows = part_rows(link, elastic%linkage%bodies(part)%length, pose%direction(:, part))
    on_part = rows(:, 1)*weighted(numbers%elongation(part))
    do i = 1, link%curves
      on_part = on_part + rows(:, 1 + i)*weighted(numbers%curve(i, part))
    end do
    allocate (alone%bodies(1), alone%pin_mass(0))
    alone%bodies(1) = elastic%linkage%bodies(part)
    its_case%field = acceleration_field_t(reshape([real(wp) ::], [2, 0]), &
      case%field%at_first(:, part:part), case%field%slope(:, part:part), &
      case%field%angular(part:part))
    allocate (its_case%pin_force(2, 0))
    its_case%couple = case%couple(part:part)
    if (allocated(case%place_force)) its_case%place_force = case%place_force
    its_pose%direction = pose%direction(:, part:part)
    chords = own_chords(rows, pose%direction(:, part), elastic%linkage%bodies(part)%length)
    on_part = on_part - border_work(alone, [link], chords, its_pose, its_case)
    do i = 1, 2
      if (abs(torque(i)) > 0.0_wp) on_part = on_part - torque(i)*turn_of_end(link, &
        chords%turn(:, 1), chords%across(3:, :, 1), i)
    end do
  end function on_ends

  !> Torques of free drives on the hinged ends of a part; those of ends that are held act on their
  !! rotations.
  pure function torques_of_drives(linkage, elastic, part, drive) result(torque)
    type(linkage_t), intent(in) :: linkage
    type(elastic_linkage_t), intent(in) :: elastic
    integer, intent(in) :: part
    real(wp), intent(in) :: drive(:) !! (drives) [N m] or [N]
    real(wp) :: torque(2)

    integer :: i, k, number, links(2)

    torque = 0.0_wp
    do i = 1, size(drive)
      if (linkage%drives(i)%kind /= drive_of_angle .or. .not. linkage%drives(i)%is_free) cycle
      links = [linkage%drives(i)%body, linkage%drives(i)%against]
      do k = 1, 2
        if (elastic%body(part) /= links(k)) cycle
        number = end_at_joint(linkage, elastic, part, links(3 - k))
        if (number == 0) cycle
        if (elastic%rotation(number, part) == 0) torque(number) = torque(number) + &
          merge(1.0_wp, -1.0_wp, k == 1)*drive(i)
      end do
    end do
  end function torques_of_drives

  !> What the displacements of `part_rows` do to the part.
  pure function own_chords(rows, axis, length) result(chords)
    real(wp), intent(in) :: rows(:, :)
    real(wp), intent(in) :: axis(2), length
    type(chords_t) :: chords

    integer :: i

    allocate (chords%across(1 + size(rows, 2), 6, 1), chords%along(2, 6, 1), chords%turn(6, 1), &
      chords%pin(2, 0, 6))
    chords%across = 0.0_wp
    chords%along = 0.0_wp
    chords%across(1, 1:2, 1) = normal_to(axis)
    chords%across(2, 3:4, 1) = normal_to(axis)
    chords%along(1, 1:2, 1) = axis
    chords%along(2, 3:4, 1) = axis
    do i = 2, size(rows, 2)
      chords%across(1 + i, :, 1) = rows(:, i)
    end do
    chords%turn(:, 1) = (chords%across(2, :, 1) - chords%across(1, :, 1))/length
  end function own_chords

  !> Force on a link at one of its pins.
  pure function force_on_link(linkage, elastic, pose, loads, numbers, forces, case, on_part, body, &
    number) result(force)
    type(linkage_t), intent(in) :: linkage
    type(elastic_linkage_t), intent(in) :: elastic
    type(pose_t), intent(in) :: pose
    type(part_loads_t), intent(in) :: loads
    type(border_unknowns_t), intent(in) :: numbers
    type(part_forces_t), intent(in) :: forces
    integer, intent(in) :: case
    real(wp), intent(in) :: on_part(:, :)
    integer, intent(in) :: body, number
    real(wp) :: force(2)

    integer :: pins(2 + size(linkage%bodies(body)%further)), i, k, row
    type(load_t) :: load

    pins = pins_of_body(linkage%bodies(body))
    force = 0.0_wp
    if (linkage%bodies(body)%bends) then
      do k = 1, size(elastic%body)
        if (elastic%body(k) /= body) cycle
        if (elastic%linkage%bodies(k)%first_pin == pins(number)) force = force + on_part(1:2, k)
        if (elastic%linkage%bodies(k)%last_pin == pins(number)) force = force + on_part(3:4, k)
      end do
      do i = 1, size(elastic%carried)
        associate (this => elastic%carried(i))
          if (this%body == body .and. this%point == pins(number)) force = force - &
            loads%carried(:2, i, case)
        end associate
      end do
      return
    end if
    k = findloc(elastic%body, body, dim=1)
    if (number > 1) then
      row = numbers%body_constraint(k) + 2*(number - 2)
      force = forces%constraint(row + 1:row + 2, case)
      return
    end if
    load = load_on_rigid(elastic, pose, loads, numbers, forces, case, k)
    force = -load%force
    do i = 2, size(pins)
      row = numbers%body_constraint(k) + 2*(i - 2)
      force = force - forces%constraint(row + 1:row + 2, case)
    end do
  end function force_on_link

end module part_reactions
