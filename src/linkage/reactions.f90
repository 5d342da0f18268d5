!> Inverse dynamics: the forces in all pins, the torque of the drive, and what the moving masses do
!! to the ground.
module reactions
  use inertia_loads, only: load_t
  use joint_forces, only: find_joint_forces, joint_forces_t
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkages, only: cross, linkage_t
  use load_cases, only: case_count, find_case_loads, find_unit_loads, unit_loads_t
  use poses, only: pose_t
  implicit none (type, external)
  private

  public :: reactions_t, unit_reactions_t, find_unit_reactions, reactions_at

  type :: reactions_t
    type(joint_forces_t) :: joints             !! forces on the bodies at their pins, torque of the
                                               !! drive
    real(wp) :: shaking_force(2) = 0.0_wp      !! `−Σ m a`, the resultant of the inertia forces [N]
    real(wp) :: shaking_moment = 0.0_wp        !! of these and of all −I α, about the ground pivot
                                               !! of the driven body [N m]
  end type reactions_t

  !> Reactions to each of the three loads of which all are made: for ω2² = 1, for α2 = 1, and the
  !! constant ones.
  type :: unit_reactions_t
    type(reactions_t) :: of_case(case_count)
  end type unit_reactions_t

contains

  !> Reactions at a pose, once for all speeds: (2.47) to (2.49) of Ulker (2010) for each load by
  !! itself.
  pure subroutine find_unit_reactions(linkage, elements, pose, coefficients, unit)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: elements(:)  !! (bodies) on whose nodes their masses sit; 0: distributed
    type(pose_t), intent(in) :: pose    !! away from dead points
    type(kinematic_coefficients_t), intent(in) :: coefficients
    type(unit_reactions_t), intent(out) :: unit

    type(unit_loads_t) :: loads
    type(load_t) :: body_loads(size(linkage%bodies))
    real(wp) :: pin_loads(2, size(linkage%is_ground))
    integer :: i

    loads = find_unit_loads(linkage, pose, coefficients)
    do i = 1, case_count
      call find_case_loads(linkage, elements, pose, loads%of_case(i), body_loads, pin_loads)
      unit%of_case(i)%joints = find_joint_forces(linkage, pose, body_loads, pin_loads)
      ! Gravity and the loads from outside shake nothing: they are no inertia forces.
      if (i < case_count) call add_up(linkage, pose, body_loads, pin_loads, unit%of_case(i))
    end do
  end subroutine find_unit_reactions

  !> Resultant of loads, and their moment about the ground pivot of the driven body.
  pure subroutine add_up(linkage, pose, body_loads, pin_loads, total)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(load_t), intent(in) :: body_loads(:)
    real(wp), intent(in) :: pin_loads(:, :) !! (2, pins) [N]
    type(reactions_t), intent(inout) :: total

    real(wp) :: pivot(2)
    integer :: i

    pivot = pose%pin(:, linkage%bodies(1)%first_pin)
    do i = 1, size(body_loads)
      total%shaking_force = total%shaking_force + body_loads(i)%force
      total%shaking_moment = total%shaking_moment + body_loads(i)%moment + &
        cross(pose%pin(:, linkage%bodies(i)%first_pin) - pivot, body_loads(i)%force)
    end do
    do i = 1, size(pin_loads, 2)
      total%shaking_force = total%shaking_force + pin_loads(:, i)
      total%shaking_moment = total%shaking_moment + cross(pose%pin(:, i) - pivot, pin_loads(:, i))
    end do
  end subroutine add_up

  !> `ω2² of turning + α2 of speeding up + constant`
  pure function reactions_at(unit, speed, acceleration) result(total)
    type(unit_reactions_t), intent(in) :: unit
    real(wp), intent(in) :: speed        !! ω2 [rad/s]
    real(wp), intent(in) :: acceleration !! α2 [rad/s²]
    type(reactions_t) :: total

    real(wp) :: factor(case_count)
    integer :: i

    factor = [speed**2, acceleration, 1.0_wp]
    allocate (total%joints%on_first, mold=unit%of_case(1)%joints%on_first)
    allocate (total%joints%on_last, mold=unit%of_case(1)%joints%on_last)
    total%joints%on_first = 0.0_wp
    total%joints%on_last = 0.0_wp
    do i = 1, case_count
      associate (part => unit%of_case(i))
        total%joints%on_first = total%joints%on_first + factor(i)*part%joints%on_first
        total%joints%on_last = total%joints%on_last + factor(i)*part%joints%on_last
        total%joints%torque = total%joints%torque + factor(i)*part%joints%torque
        total%shaking_force = total%shaking_force + factor(i)*part%shaking_force
        total%shaking_moment = total%shaking_moment + factor(i)*part%shaking_moment
      end associate
    end do
  end function reactions_at

end module reactions
