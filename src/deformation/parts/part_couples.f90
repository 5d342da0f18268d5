!> Couples between links that turn together, from the equilibrium of moments at the end of a link
!! that bends, or on a rigid link as a whole.
!!
!! Equilibrium gives the sum of the couples on an end. Where one of them is unknown it follows, and
!! is then known on the other link. Where ends hold each other in a closed chain, one couple stays
!! indeterminate.
module part_couples
  use elastic_linkages, only: elastic_linkage_t, spring_t
  use elastic_positions, only: elastic_position_t
  use elastic_terminals, only: elastic_terminal_t, is_same
  use inertia_loads, only: load_t
  use joint_forces, only: joint_forces_t
  use kinds, only: wp
  use linkages, only: cross, drive_of_angle
  use load_cases, only: constant_case
  use part_force_types, only: loaded_parts_t
  use pose_types, only: arm_to_pin, pins_of_body
  use rigid_part_loads, only: load_on_rigid
  implicit none (type, external)
  private

  public :: find_part_couples

contains

  !> The couples of a load case.
  pure subroutine find_part_couples(at, loaded, case, on_part, joints, given, open)
    type(elastic_position_t), intent(in) :: at     !! with parts that are placed
    type(loaded_parts_t), intent(in) :: loaded     !! its loads and forces
    integer, intent(in) :: case                    !! number of the load case
    real(wp), intent(in) :: on_part(:, :)          !! (6, parts) forces on both ends of parts that
                                                   !! bend, then moments [N, N m]
    type(joint_forces_t), intent(inout) :: joints  !! with forces at pins and of drives: couples
    real(wp), intent(in), optional :: given(:)     !! (open couples) their values; absent: 0 [N m]
    integer, allocatable, intent(out), optional :: open(:) !! (open couples) numbers of their turns

    real(wp) :: moment(2, size(at%elastic%turning, 2)) !! of all couples of turns on each end [N m]
    logical :: is_known(size(at%elastic%turning, 2)), is_new
    integer, allocatable :: free(:)
    integer :: i, k

    moment = 0.0_wp
    do i = 1, size(at%elastic%turning, 2)
      do k = 1, 2
        associate (end => at%elastic%turning(k, i))
          if (end%is_rigid) then
            moment(k, i) = -moment_on_rigid(at, loaded, case, end, joints)
          else if (end%part > 0) then
            moment(k, i) = moment_on_end(at%elastic, loaded, case, on_part, end, joints)
          end if
        end associate
      end do
    end do
    is_known = .false.
    joints%couple = 0.0_wp
    allocate (free(0))
    do
      is_new = .false.
      do i = 1, size(is_known)
        do k = 2, 1, -1
          if (is_known(i) .or. at%elastic%turning(k, i)%part == 0) cycle
          if (others_unknown(at%elastic%turning, is_known, k, i)) cycle
          joints%couple(i) = merge(-1.0_wp, 1.0_wp, k == 1)*(moment(k, i) - &
            moment_of_others(at%elastic%turning, joints%couple, k, i))
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
  end subroutine find_part_couples

  !> Whether another unknown couple acts on an end of a turn.
  pure function others_unknown(ends, is_known, end, number) result(are)
    type(elastic_terminal_t), intent(in) :: ends(:, :) !! (2, turns)
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
    type(elastic_terminal_t), intent(in) :: ends(:, :) !! (2, turns)
    real(wp), intent(in) :: couple(:)            !! (turns) [N m]
    integer, intent(in) :: end, number           !! 1 or 2; number of the turn
    real(wp) :: moment

    integer :: j

    moment = 0.0_wp
    do j = 1, size(couple)
      if (j == number) cycle
      if (is_same(ends(end, number), ends(2, j))) moment = moment + couple(j)
      if (is_same(ends(end, number), ends(1, j))) moment = moment - couple(j)
    end do
  end function moment_of_others

  !> Moment that the couples of turns put on the end of a link that bends: what the parts there
  !! bear, less the moments of springs, drives and of what is fixed to it.
  pure function moment_on_end(elastic, loaded, case, on_part, end, joints) result(moment)
    type(elastic_linkage_t), intent(in) :: elastic
    type(loaded_parts_t), intent(in) :: loaded
    integer, intent(in) :: case
    real(wp), intent(in) :: on_part(:, :)
    type(elastic_terminal_t), intent(in) :: end
    type(joint_forces_t), intent(in) :: joints
    real(wp) :: moment

    integer :: i, k

    moment = 0.0_wp
    associate (body => elastic%body(end%part))
      do k = 1, size(elastic%body)
        if (elastic%body(k) /= body) cycle
        associate (part => elastic%linkage%bodies(k))
          if (part%first_pin == end%point) moment = moment + on_part(5, k) - &
            loaded%loads%end_couple(1, k, case)
          if (part%last_pin == end%point) moment = moment + on_part(6, k) - &
            loaded%loads%end_couple(2, k, case)
        end associate
      end do
      moment = moment - moment_of_springs(elastic, loaded, case, end) - moment_of_drives(elastic, &
        joints, end)
      do i = 1, size(elastic%carried)
        if (elastic%carried(i)%body == body .and. elastic%carried(i)%point == end%point) &
          moment = moment - loaded%loads%carried(3, i, case)
      end do
      do i = 1, size(elastic%ways)
        if (elastic%ways(i)%body /= body) cycle
        k = findloc(elastic%ways(i)%cuts%point, end%point, dim=1)
        if (k > 0) moment = moment + elastic%ways(i)%cuts(k)%inertia* &
          loaded%loads%unit%of_case(case)%field%angular(elastic%ways(i)%first_part)
      end do
    end associate
  end function moment_on_end

  !> Moment on a rigid link about its first pin of everything but the couples of turns.
  pure function moment_on_rigid(at, loaded, case, end, joints) result(moment)
    type(elastic_position_t), intent(in) :: at
    type(loaded_parts_t), intent(in) :: loaded
    integer, intent(in) :: case
    type(elastic_terminal_t), intent(in) :: end
    type(joint_forces_t), intent(in) :: joints
    real(wp) :: moment

    type(load_t) :: load
    integer, allocatable :: pins(:)
    integer :: i, row

    load = load_on_rigid(at, loaded, case, end%part)
    moment = load%moment + moment_of_springs(at%elastic, loaded, case, end)
    pins = pins_of_body(at%elastic%linkage%bodies(end%part))
    do i = 2, size(pins)
      row = at%numbers%body_constraint(end%part) + 2*(i - 2)
      moment = moment + cross(arm_to_pin(at%elastic%linkage, at%pose, end%part, pins(i)), &
        loaded%forces%constraint(row + 1:row + 2, case))
    end do
    moment = moment + moment_of_drives(at%elastic, joints, end)
  end function moment_on_rigid

  !> Moments of drives of angles on an end of a link.
  pure function moment_of_drives(elastic, joints, end) result(moment)
    type(elastic_linkage_t), intent(in) :: elastic
    type(joint_forces_t), intent(in) :: joints
    type(elastic_terminal_t), intent(in) :: end
    real(wp) :: moment

    integer :: i, k

    moment = 0.0_wp
    do i = 1, size(elastic%driven, 2)
      if (elastic%linkage%drives(i)%kind /= drive_of_angle) cycle
      do k = 1, 2
        if (is_same(elastic%driven(k, i), end)) moment = moment + merge(-joints%drive(i), &
          joints%drive(i), k == 1)
      end do
    end do
  end function moment_of_drives

  !> Moments of the springs and constant tensions that turn an end of a link.
  pure function moment_of_springs(elastic, loaded, case, end) result(moment)
    type(elastic_linkage_t), intent(in) :: elastic
    type(loaded_parts_t), intent(in) :: loaded
    integer, intent(in) :: case
    type(elastic_terminal_t), intent(in) :: end
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
          if (is_same(elastic%load_ends(k, springs(i)%load), end)) moment = moment + &
            merge(pull(i), -pull(i), k == 1)
        end do
      end do
    end function moment_of

  end function moment_of_springs

end module part_couples
