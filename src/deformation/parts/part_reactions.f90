!> Forces in the joints of a linkage by its elasticity: those that statics alone cannot tell apart.
!!
!! What its neighbours do to a part that bends is the work of its border forces on the displacements
!! of its ends, less the work of its loads on them. To a rigid link they do the forces of its
!! constraints, and at its first pin what is left in equilibrium.
module part_reactions
  use acceleration_fields, only: acceleration_field_t
  use border_loads, only: border_work
  use border_rows, only: part_rows
  use drive_rates, only: hinged_ends
  use elastic_positions, only: elastic_position_t
  use inertia_loads, only: load_t
  use joint_forces, only: joint_forces_t
  use kinds, only: wp
  use linkages, only: linkage_t, normal_to
  use load_cases, only: load_case_t
  use part_couples, only: find_part_couples
  use part_force_types, only: loaded_parts_t
  use pin_displacements, only: chords_t
  use pose_types, only: pins_of_body
  use poses, only: pose_t
  use rigid_part_loads, only: load_on_rigid
  use terminal_work, only: turn_of_end
  implicit none (type, external)
  private

  public :: take_part_reactions

contains

  !> Puts the forces of a load case in place of those of statics; what drives do is left, for it
  !! follows from the power.
  pure subroutine take_part_reactions(linkage, at, loaded, case, joints, given, open)
    type(linkage_t), intent(in) :: linkage         !! that moves: its bodies, sliders and turns
    type(elastic_position_t), intent(in) :: at     !! of it, with parts that are placed
    type(loaded_parts_t), intent(in) :: loaded     !! its loads and forces
    integer, intent(in) :: case                    !! number of the load case
    type(joint_forces_t), intent(inout) :: joints  !! of this linkage
    real(wp), intent(in), optional :: given(:)     !! (open couples) as of `find_part_couples`
    integer, allocatable, intent(out), optional :: open(:) !! (open couples) likewise

    real(wp) :: on_part(6, size(at%model%links)), force(2)
    integer :: b, i, k, further

    do k = 1, size(at%model%links)
      on_part(:, k) = 0.0_wp
      if (at%elastic%linkage%bodies(k)%bends) on_part(:, k) = on_ends(at, k, &
        loaded%loads%unit%of_case(case), loaded%forces%weighted(:, case), &
        matmul(loaded%forces%drive(at%elastic%free_drives, case), hinged_ends(at%elastic, k)) + &
        merge(loaded%loads%end_couple(:, k, case), 0.0_wp, at%elastic%rotation(:, k) == 0))
    end do
    further = 0
    do b = 1, size(linkage%bodies)
      do i = 1, 2 + size(linkage%bodies(b)%further)
        force = force_on_link(linkage, at, loaded, case, on_part, b, i)
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
    if (allocated(joints%guide)) joints%guide = loaded%forces%guide(:, case)
    if (allocated(joints%couple)) call find_part_couples(at, loaded, case, on_part, joints, &
      given, open)
  end subroutine take_part_reactions

  !> Forces on both ends of a part that bends, and moments: as the displacements of `part_rows`.
  pure function on_ends(at, part, case, weighted, torque) result(on_part)
    type(elastic_position_t), intent(in) :: at
    integer, intent(in) :: part
    type(load_case_t), intent(in) :: case
    real(wp), intent(in) :: weighted(:)
    real(wp), intent(in) :: torque(2) !! of drives and loads on its hinged ends [N m]
    real(wp) :: on_part(6)

    type(linkage_t) :: alone
    type(load_case_t) :: its_case
    type(pose_t) :: its_pose
    type(chords_t) :: chords
    real(wp) :: rows(6, 1 + at%model%links(part)%curves)
    integer :: i

    rows = part_rows(at%model%links(part), at%elastic%linkage%bodies(part)%length, &
      at%pose%direction(:, part))
    on_part = rows(:, 1)*weighted(at%numbers%elongation(part))
    do i = 1, size(rows, 2) - 1
      on_part = on_part + rows(:, 1 + i)*weighted(at%numbers%curve(i, part))
    end do
    allocate (alone%bodies(1), alone%pin_mass(0))
    alone%bodies(1) = at%elastic%linkage%bodies(part)
    its_case%field = acceleration_field_t(reshape([real(wp) ::], [2, 0]), &
      case%field%at_first(:, part:part), case%field%slope(:, part:part), &
      case%field%angular(part:part))
    allocate (its_case%pin_force(2, 0))
    its_case%couple = case%couple(part:part)
    if (allocated(case%place_force)) its_case%place_force = case%place_force
    its_pose%direction = at%pose%direction(:, part:part)
    chords = own_chords(rows, at%pose%direction(:, part), at%elastic%linkage%bodies(part)%length)
    on_part = on_part - border_work(alone, at%model%links(part:part), chords, its_pose, its_case)
    do i = 1, 2
      if (abs(torque(i)) > 0.0_wp) on_part = on_part - torque(i)*turn_of_end( &
        at%model%links(part), chords%turn(:, 1), chords%across(3:, :, 1), i)
    end do
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
  pure function force_on_link(linkage, at, loaded, case, on_part, body, number) result(force)
    type(linkage_t), intent(in) :: linkage
    type(elastic_position_t), intent(in) :: at
    type(loaded_parts_t), intent(in) :: loaded
    integer, intent(in) :: case
    real(wp), intent(in) :: on_part(:, :)
    integer, intent(in) :: body, number
    real(wp) :: force(2)

    integer :: pins(2 + size(linkage%bodies(body)%further)), i, k, row
    type(load_t) :: load

    pins = pins_of_body(linkage%bodies(body))
    force = 0.0_wp
    if (linkage%bodies(body)%bends) then
      do k = 1, size(at%elastic%body)
        if (at%elastic%body(k) /= body) cycle
        if (at%elastic%linkage%bodies(k)%first_pin == pins(number)) force = force + on_part(1:2, k)
        if (at%elastic%linkage%bodies(k)%last_pin == pins(number)) force = force + on_part(3:4, k)
      end do
      do i = 1, size(at%elastic%carried)
        associate (this => at%elastic%carried(i))
          if (this%body == body .and. this%point == pins(number)) force = force - &
            loaded%loads%carried(:2, i, case)
        end associate
      end do
      return
    end if
    k = findloc(at%elastic%body, body, dim=1)
    if (number > 1) then
      row = at%numbers%body_constraint(k) + 2*(number - 2)
      force = loaded%forces%constraint(row + 1:row + 2, case)
      return
    end if
    load = load_on_rigid(at, loaded, case, k)
    force = -load%force
    do i = 2, size(pins)
      row = at%numbers%body_constraint(k) + 2*(i - 2)
      force = force - loaded%forces%constraint(row + 1:row + 2, case)
    end do
  end function force_on_link

end module part_reactions
