!> Forces in the joints of a linkage by its elasticity: those that statics alone cannot tell apart.
!!
!! What its neighbours do to a part that bends is the work of its border forces on the displacements
!! of its ends, less the work of its loads on them. To a rigid link they do the forces of its
!! constraints, and at its first pin what is left in equilibrium.
module part_reactions
  use acceleration_fields, only: acceleration_field_t
  use border_loads, only: border_work
  use border_rows, only: line_direction, part_rows
  use elastic_linkages, only: elastic_linkage_t
  use inertia_loads, only: distributed_load, load_t
  use joint_forces, only: joint_forces_t
  use kinds, only: wp
  use link_modes, only: link_modes_t
  use linkages, only: body_t, cross, linkage_t, normal_to
  use load_cases, only: load_case_t
  use part_displacements, only: border_t
  use part_forces, only: part_forces_t
  use part_poses, only: part_loads_t
  use pin_displacements, only: chords_t
  use pose_types, only: arm_to_pin, pins_of_body
  use poses, only: pose_t
  implicit none (type, external)
  private

  public :: take_part_reactions

contains

  !> Puts the forces of a load case in place of those of statics; what drives do is left, for it
  !! follows from the power.
  pure subroutine take_part_reactions(linkage, elastic, links, pose, loads, border, forces, case, &
    joints)
    type(linkage_t), intent(in) :: linkage         !! that moves: its bodies, sliders and turns
    type(elastic_linkage_t), intent(in) :: elastic !! at this position
    type(link_modes_t), intent(in) :: links(:)     !! (parts)
    type(pose_t), intent(in) :: pose               !! of points and parts
    type(part_loads_t), intent(in) :: loads        !! of this position
    type(border_t), intent(in) :: border           !! numbers of constraints
    type(part_forces_t), intent(in) :: forces      !! of these loads
    integer, intent(in) :: case                    !! number of the load case
    type(joint_forces_t), intent(inout) :: joints  !! of this linkage

    real(wp) :: on_part(6, size(links)), force(2)
    integer :: b, i, k, further

    do k = 1, size(links)
      on_part(:, k) = 0.0_wp
      if (elastic%linkage%bodies(k)%bends) on_part(:, k) = on_ends(elastic, links(k), k, pose, &
        loads%unit%of_case(case), border, forces%weighted(:, case))
    end do
    further = 0
    do b = 1, size(linkage%bodies)
      do i = 1, 2 + size(linkage%bodies(b)%further)
        force = force_on_link(linkage, elastic, pose, loads%unit%of_case(case), border, &
          forces%constraint(:, case), on_part, b, i)
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
    do i = 1, size(linkage%turns)
      associate (turn => linkage%turns(i))
        joints%couple(i) = moment_at(elastic, on_part, turn%body, turn%pin)
        if (turn%against > 0 .and. .not. linkage%bodies(turn%body)%bends) joints%couple(i) = &
          -moment_at(elastic, on_part, turn%against, pin_of_turn(elastic, turn%slider, turn%pin))
      end associate
    end do
  end subroutine take_part_reactions

  !> The point where a link turns with the other one: under its block on a link that bends.
  pure function pin_of_turn(elastic, slider, pin) result(point)
    type(elastic_linkage_t), intent(in) :: elastic
    integer, intent(in) :: slider, pin
    integer :: point

    point = pin
    if (slider == 0) return
    if (elastic%contact(slider) > 0) point = elastic%contact(slider)
  end function pin_of_turn

  !> Forces on both ends of a part that bends, and moments: as the displacements of `part_rows`.
  pure function on_ends(elastic, link, part, pose, case, border, weighted) result(on_part)
    type(elastic_linkage_t), intent(in) :: elastic
    type(link_modes_t), intent(in) :: link
    integer, intent(in) :: part
    type(pose_t), intent(in) :: pose
    type(load_case_t), intent(in) :: case
    type(border_t), intent(in) :: border
    real(wp), intent(in) :: weighted(:)
    real(wp) :: on_part(6)

    type(linkage_t) :: alone
    type(load_case_t) :: its_case
    type(pose_t) :: its_pose
    type(chords_t) :: chords
    real(wp) :: rows(6, 1 + link%curves)
    integer :: i

    rows = part_rows(link, elastic%linkage%bodies(part)%length, pose%direction(:, part))
    on_part = rows(:, 1)*weighted(border%numbers%elongation(part))
    do i = 1, link%curves
      on_part = on_part + rows(:, 1 + i)*weighted(border%numbers%curve(i, part))
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
  end function on_ends

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
  pure function force_on_link(linkage, elastic, pose, case, border, lambda, on_part, body, number) &
    result(force)
    type(linkage_t), intent(in) :: linkage
    type(elastic_linkage_t), intent(in) :: elastic
    type(pose_t), intent(in) :: pose
    type(load_case_t), intent(in) :: case
    type(border_t), intent(in) :: border
    real(wp), intent(in) :: lambda(:)
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
      return
    end if
    k = findloc(elastic%body, body, dim=1)
    if (number > 1) then
      row = border%numbers%body_constraint(k) + 2*(number - 2)
      force = lambda(row + 1:row + 2)
      return
    end if
    load = distributed_load(elastic%linkage%bodies(k), k, pose, case%field)
    force = -load%force
    if (allocated(case%body_force)) force = force - case%body_force(:, k)
    do i = 2, size(pins)
      row = border%numbers%body_constraint(k) + 2*(i - 2)
      force = force - lambda(row + 1:row + 2)
    end do
    do i = 1, size(linkage%sliders)
      row = border%numbers%line_constraint(i)
      if (linkage%sliders(i)%body == body .and. row > 0) force = force - &
        lambda(row)*normal_to(line_direction(elastic, pose, i))
    end do
    do i = 1, size(linkage%drives)
      row = border%numbers%drive_constraint(i)
      if (row == 0) cycle
      if (linkage%sliders(linkage%drives(i)%slider)%body == body) force = force - &
        lambda(row)*line_direction(elastic, pose, linkage%drives(i)%slider)
    end do
  end function force_on_link

  !> Moment on the ends of a link that bends at a point.
  pure function moment_at(elastic, on_part, body, point) result(moment)
    type(elastic_linkage_t), intent(in) :: elastic
    real(wp), intent(in) :: on_part(:, :)
    integer, intent(in) :: body, point
    real(wp) :: moment

    integer :: k

    moment = 0.0_wp
    do k = 1, size(elastic%body)
      if (elastic%body(k) /= body) cycle
      if (elastic%linkage%bodies(k)%first_pin == point) moment = moment + on_part(5, k)
      if (elastic%linkage%bodies(k)%last_pin == point) moment = moment + on_part(6, k)
    end do
  end function moment_at

end module part_reactions
