!> Couples between links that turn together, from the equilibrium of moments at the end of a link
!! that bends, or on a rigid link as a whole.
!!
!! Equilibrium gives the sum of the couples on an end. Where one of them is unknown it follows, and
!! is then known on the other link. Where ends hold each other in a closed chain, one couple stays
!! indeterminate.
module part_couples
  use drive_rates, only: is_joint
  use elastic_linkages, only: elastic_linkage_t, spring_t
  use elastic_positions, only: elastic_position_t
  use inertia_loads, only: load_t
  use joint_forces, only: joint_forces_t
  use kinds, only: wp
  use linkages, only: cross, drive_of_angle, linkage_t
  use load_cases, only: constant_case
  use part_force_types, only: loaded_parts_t
  use pose_types, only: arm_to_pin, pins_of_body
  use rigid_part_loads, only: load_on_rigid
  implicit none (type, external)
  private

  public :: find_part_couples

  !> Where couples act.
  type :: turned_end_t
    integer :: body = 0            !! number of the link; 0: the ground
    integer :: pin = 0             !! or point, of a link that bends; 0 of a rigid one
    real(wp) :: moment = 0.0_wp    !! of all its couples [N m]
  end type turned_end_t

contains

  !> The couples of a load case.
  pure subroutine find_part_couples(linkage, at, loaded, case, on_part, joints, given, open)
    type(linkage_t), intent(in) :: linkage         !! that moves: its bodies, turns, drives
    type(elastic_position_t), intent(in) :: at     !! of it, with parts that are placed
    type(loaded_parts_t), intent(in) :: loaded     !! its loads and forces
    integer, intent(in) :: case                    !! number of the load case
    real(wp), intent(in) :: on_part(:, :)          !! (6, parts) forces on both ends of parts that
                                                   !! bend, then moments [N, N m]
    type(joint_forces_t), intent(inout) :: joints  !! with forces at pins and of drives: couples
    real(wp), intent(in), optional :: given(:)     !! (open couples) their values; absent: 0 [N m]
    integer, allocatable, intent(out), optional :: open(:) !! (open couples) numbers of their turns

    type(turned_end_t) :: ends(2, size(linkage%turns))
    logical :: is_known(size(linkage%turns)), is_new
    integer, allocatable :: free(:)
    integer :: i, k

    do i = 1, size(linkage%turns)
      associate (turn => linkage%turns(i))
        ends(1, i) = turned_end(turn%body, turn%pin, 0)
        ends(2, i) = turned_end(turn%against, turn%pin, turn%slider)
      end associate
    end do
    is_known = .false.
    joints%couple = 0.0_wp
    allocate (free(0))
    do
      is_new = .false.
      do i = 1, size(is_known)
        do k = 1, 2
          if (is_known(i) .or. ends(k, i)%body == 0) cycle
          if (others_unknown(ends, is_known, k, i)) cycle
          joints%couple(i) = merge(1.0_wp, -1.0_wp, k == 1)*(ends(k, i)%moment - &
            moment_of_others(ends, joints%couple, k, i))
          is_known(i) = .true.
          is_new = .true.
        end do
      end do
      if (all(is_known)) exit
      if (is_new) cycle
      i = findloc(is_known, .false., dim=1)
      free = [free, i]
      if (present(given)) joints%couple(i) = given(size(free))
      is_known(i) = .true.
    end do
    if (present(open)) call move_alloc(free, open)

  contains

    !> An end of a turn.
    pure function turned_end(body, pin, slider) result(end)
      integer, intent(in) :: body, pin, slider
      type(turned_end_t) :: end

      end%body = body
      if (body == 0) return
      if (.not. linkage%bodies(body)%bends) then
        end%moment = -moment_on_rigid(linkage, at, loaded, case, body, joints)
        return
      end if
      end%pin = pin
      if (slider > 0) then
        if (at%elastic%contact(slider) > 0) end%pin = at%elastic%contact(slider)
      end if
      end%moment = moment_on_end(linkage, at%elastic, loaded, case, on_part, body, end%pin, joints)
    end function turned_end

  end subroutine find_part_couples

  !> Whether another unknown couple acts on an end of a turn.
  pure function others_unknown(ends, is_known, end, number) result(are)
    type(turned_end_t), intent(in) :: ends(:, :) !! (2, turns)
    logical, intent(in) :: is_known(:)           !! (turns) their couples
    integer, intent(in) :: end, number           !! 1 or 2; number of the turn
    logical :: are

    integer :: j

    are = .false.
    do j = 1, size(is_known)
      if (j == number .or. is_known(j)) cycle
      are = are .or. is_same(ends(end, number), ends(1, j)) .or. &
        is_same(ends(end, number), ends(2, j))
    end do
  end function others_unknown

  !> Moment of the other couples on an end of a turn [N m].
  pure function moment_of_others(ends, couple, end, number) result(moment)
    type(turned_end_t), intent(in) :: ends(:, :) !! (2, turns)
    real(wp), intent(in) :: couple(:)            !! (turns) [N m]
    integer, intent(in) :: end, number           !! 1 or 2; number of the turn
    real(wp) :: moment

    integer :: j

    moment = 0.0_wp
    do j = 1, size(couple)
      if (j == number) cycle
      if (is_same(ends(end, number), ends(1, j))) moment = moment + couple(j)
      if (is_same(ends(end, number), ends(2, j))) moment = moment - couple(j)
    end do
  end function moment_of_others

  pure function is_same(one, other)
    type(turned_end_t), intent(in) :: one, other
    logical :: is_same

    is_same = one%body == other%body .and. one%pin == other%pin
  end function is_same

  !> Moment that the couples of turns put on the end of a link that bends: what the parts there
  !! bear, less the moments of springs, drives and of what is fixed to it.
  pure function moment_on_end(linkage, elastic, loaded, case, on_part, body, point, joints) &
    result(moment)
    type(linkage_t), intent(in) :: linkage
    type(elastic_linkage_t), intent(in) :: elastic
    type(loaded_parts_t), intent(in) :: loaded
    integer, intent(in) :: case
    real(wp), intent(in) :: on_part(:, :)
    integer, intent(in) :: body, point
    type(joint_forces_t), intent(in) :: joints
    real(wp) :: moment

    integer :: i, k, rotation

    moment = 0.0_wp
    rotation = 0
    do k = 1, size(elastic%body)
      if (elastic%body(k) /= body) cycle
      associate (part => elastic%linkage%bodies(k))
        if (part%first_pin == point) then
          moment = moment + on_part(5, k)
          rotation = elastic%rotation(1, k)
        end if
        if (part%last_pin == point) then
          moment = moment + on_part(6, k)
          rotation = elastic%rotation(2, k)
        end if
      end associate
    end do
    moment = moment - moment_of_springs(elastic, loaded, case, body, rotation)
    do k = 1, size(elastic%body)
      if (elastic%body(k) /= body) cycle
      if (elastic%linkage%bodies(k)%first_pin == point) moment = moment - &
        loaded%loads%end_couple(1, k, case)
      if (elastic%linkage%bodies(k)%last_pin == point) moment = moment - &
        loaded%loads%end_couple(2, k, case)
    end do
    do i = 1, size(linkage%drives)
      associate (drive => linkage%drives(i))
        if (drive%kind /= drive_of_angle) cycle
        if (drive%body == body .and. is_joint(linkage, point, drive%against)) moment = moment - &
          joints%drive(i)
        if (drive%against == body .and. is_joint(linkage, point, drive%body)) moment = moment + &
          joints%drive(i)
      end associate
    end do
    do i = 1, size(elastic%carried)
      if (elastic%carried(i)%body == body .and. elastic%carried(i)%point == point) &
        moment = moment - loaded%loads%carried(3, i, case)
    end do
    do i = 1, size(elastic%ways)
      if (elastic%ways(i)%body /= body) cycle
      k = findloc(elastic%ways(i)%cuts%point, point, dim=1)
      if (k > 0) moment = moment + elastic%ways(i)%cuts(k)%inertia* &
        loaded%loads%unit%of_case(case)%field%angular(elastic%ways(i)%first_part)
    end do
  end function moment_on_end

  !> Moment on a rigid link about its first pin of everything but the couples of turns.
  pure function moment_on_rigid(linkage, at, loaded, case, body, joints) result(moment)
    type(linkage_t), intent(in) :: linkage
    type(elastic_position_t), intent(in) :: at
    type(loaded_parts_t), intent(in) :: loaded
    integer, intent(in) :: case, body
    type(joint_forces_t), intent(in) :: joints
    real(wp) :: moment

    type(load_t) :: load
    integer :: pins(2 + size(linkage%bodies(body)%further)), i, part, row

    part = findloc(at%elastic%body, body, dim=1)
    load = load_on_rigid(at, loaded, case, part)
    moment = load%moment + moment_of_springs(at%elastic, loaded, case, body, &
      at%elastic%rotation(1, part))
    pins = pins_of_body(linkage%bodies(body))
    do i = 2, size(pins)
      row = at%numbers%body_constraint(part) + 2*(i - 2)
      moment = moment + cross(arm_to_pin(at%elastic%linkage, at%pose, part, pins(i)), &
        loaded%forces%constraint(row + 1:row + 2, case))
    end do
    do i = 1, size(linkage%drives)
      associate (drive => linkage%drives(i))
        if (drive%kind /= drive_of_angle) cycle
        if (drive%body == body) moment = moment + joints%drive(i)
        if (drive%against == body) moment = moment - joints%drive(i)
      end associate
    end do
  end function moment_on_rigid

  !> Moments of the springs and constant tensions that turn an end of a link.
  pure function moment_of_springs(elastic, loaded, case, body, rotation) result(moment)
    type(elastic_linkage_t), intent(in) :: elastic
    type(loaded_parts_t), intent(in) :: loaded
    integer, intent(in) :: case, body
    integer, intent(in) :: rotation !! number of that of the end
    real(wp) :: moment

    moment = moment_of(elastic%springs, loaded%forces%spring(:, case))
    if (case == constant_case) moment = moment + moment_of(elastic%tensions, loaded%loads%tension)

  contains

    pure function moment_of(springs, pull) result(moment)
      type(spring_t), intent(in) :: springs(:)
      real(wp), intent(in) :: pull(:) !! (springs) [N] or [N m]
      real(wp) :: moment

      integer :: i, k

      moment = 0.0_wp
      do i = 1, size(springs)
        if (.not. springs(i)%turns) cycle
        do k = 1, 2
          if (elastic%linkage%loads(springs(i)%load)%along%at(k)%body == body .and. &
            springs(i)%rotation(k) == rotation) moment = moment + merge(pull(i), -pull(i), k == 1)
        end do
      end do
    end function moment_of

  end function moment_of_springs

end module part_couples
