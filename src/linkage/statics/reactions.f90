!> Inverse dynamics: forces in all pins, torque of the drive, shaking force and moment.
module reactions
  use actuated_forces, only: factorize_statics, find_actuated_forces, statics_factors_t
  use inertia_loads, only: load_t
  use joint_forces, only: joint_forces_t
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkages, only: cross, linkage_t, reference_point
  use load_cases, only: case_count, find_case_loads, find_unit_loads, unit_loads_t
  use poses, only: pose_t
  use rounded_sums, only: rounded_sum_t, without_rounding
  implicit none (type, external)
  private

  public :: reactions_t, unit_reactions_t, find_unit_reactions

  type :: reactions_t
    type(joint_forces_t) :: joints             !! forces on the bodies at their pins, torque of the
                                               !! drive
    real(wp) :: shaking_force(2) = 0.0_wp      !! `−Σ m a`, the resultant of the inertia forces [N]
    real(wp) :: shaking_moment = 0.0_wp        !! of these and of all −I α, about
                                               !! `reference_point`, the ground pivot of a crank
                                               !! [N m]
  end type reactions_t

  !> Reactions to the three unit load cases that make up all loads: ω2² = 1, α2 = 1, and the
  !! constant loads.
  type :: unit_reactions_t
    type(reactions_t) :: of_case(case_count)
    type(statics_factors_t) :: factors !! of the pose, for other loads there
  end type unit_reactions_t

contains

  !> Reactions at a pose, once for all speeds: Ulker 2010 (2.47) to (2.49) for each load case.
  pure subroutine find_unit_reactions(linkage, elements, pose, coefficients, unit)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: elements(:)  !! (bodies) on whose nodes their masses sit; 0: distributed
    type(pose_t), intent(in) :: pose    !! away from dead points
    type(kinematic_coefficients_t), intent(in) :: coefficients !! at the pose
    type(unit_reactions_t), intent(out) :: unit                !! [N, N m] per [rad²/s²], [rad/s²]
                                                               !! and as they are

    type(unit_loads_t) :: loads
    type(load_t) :: body_loads(size(linkage%bodies))
    real(wp) :: pin_loads(2, size(linkage%is_ground))
    integer :: i

    loads = find_unit_loads(linkage, pose, coefficients)
    call factorize_statics(linkage, pose, unit%factors)
    do i = 1, case_count
      call find_case_loads(linkage, elements, pose, loads%of_case(i), body_loads, pin_loads)
      unit%of_case(i)%joints = find_actuated_forces(linkage, pose, unit%factors, body_loads, &
        pin_loads)
      ! Gravity and external loads are no inertia forces: they do not shake the ground.
      if (i < case_count) call add_up(linkage, pose, body_loads, pin_loads, unit%of_case(i))
    end do
  end subroutine find_unit_reactions

  !> Resultant of loads, and their moment about the ground pivot of the driven body; without a crank
  !! about the first ground pivot or, without one, the point of the first guide.
  pure subroutine add_up(linkage, pose, body_loads, pin_loads, total)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(load_t), intent(in) :: body_loads(:) !! (bodies)
    real(wp), intent(in) :: pin_loads(:, :)   !! (2, pins) [N]
    type(reactions_t), intent(inout) :: total !! gets shaking force and moment

    type(rounded_sum_t) :: force(2), moment
    real(wp) :: pivot(2)
    integer :: i

    pivot = reference_point(linkage)
    do i = 1, size(body_loads)
      call force%add(body_loads(i)%force)
      call moment%add(body_loads(i)%moment)
      call moment%add(cross(pose%pin(:, linkage%bodies(i)%first_pin) - pivot, body_loads(i)%force))
    end do
    do i = 1, size(pin_loads, 2)
      call force%add(pin_loads(:, i))
      call moment%add(cross(pose%pin(:, i) - pivot, pin_loads(:, i)))
    end do
    total%shaking_force = without_rounding(force)
    total%shaking_moment = without_rounding(moment)
  end subroutine add_up

end module reactions
