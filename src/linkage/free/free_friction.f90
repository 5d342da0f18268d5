!> Friction in the joints of a linkage that moves freely, where the forces in the joints depend on
!! the accelerations, and these on friction.
module free_friction
  use free_forces, only: add_free_loads, bent_motion, forces_of_loads, free_equations_t, loads_t, &
    new_free_equations
  use inertia_loads, only: load_t
  use joint_forces, only: joint_forces_t
  use joint_friction, only: coulomb_efforts, find_normal_forces, find_rubbing, finish_friction, &
    force_in_joint, friction_rates, friction_t, put_friction
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use pose_types, only: pose_t
  use rigid_bodies, only: rigid_body_t
  use whole_systems, only: drive_acceleration, whole_system_t
  implicit none (type, external)
  private

  public :: find_free_friction

contains

  !> Friction while a linkage moves with given rates under given loads.
  !!
  !! Without friction, forces in the joints follow from ü = M⁻¹ Q, and so does what friction of unit
  !! force in each joint adds to them, by its own ü. The magnitudes are then found as at a known
  !! motion, see `find_friction`. Forces in the joints are the multipliers of all equations as one
  !! system, which dead points do not disturb. Where joints lock there is no motion that balances
  !! the forces.
  pure subroutine find_free_friction(whole, rigid, pose, per, now, body_load, pin_load, &
    drive_force, friction, on_drive)
    type(whole_system_t), intent(in) :: whole      !! of a linkage that is not redundant
    type(rigid_body_t), intent(in) :: rigid(:)     !! (bodies)
    type(pose_t), intent(in) :: pose               !! pins and directions
    type(kinematic_coefficients_t), intent(in) :: per(:) !! (coordinates) velocities per rate
    type(kinematic_coefficients_t), intent(in) :: now !! velocities [m/s], [rad/s]
    type(load_t), intent(in) :: body_load(:)       !! (bodies) of springs, dampers and processes
    real(wp), intent(in) :: pin_load(:, :)         !! (2, pins) likewise [N]
    real(wp), intent(in) :: drive_force            !! of the first drive, but for the inertia there
                                                   !! [N m] or [N]
    type(friction_t), intent(out) :: friction      !! its loads act beside those above
    real(wp), intent(in), optional :: on_drive     !! moment of inertia on the first drive; absent:
                                                   !! none [kg m²]

    type(free_equations_t) :: equations
    type(kinematic_coefficients_t) :: bent
    type(loads_t) :: loads
    type(joint_forces_t) :: joints
    real(wp), dimension(size(whole%linkage%frictions)) :: viscous, coulomb
    real(wp) :: base(2, size(viscous)), influence(2, size(viscous), size(viscous))
    real(wp) :: inertia
    integer :: i, j, k

    inertia = 0.0_wp
    if (present(on_drive)) inertia = on_drive
    associate (linkage => whole%linkage, rubs => whole%linkage%frictions)
      call new_free_equations(whole, rigid, pose, per, inertia, equations)
      bent = bent_motion(whole, pose, now, equations)
      call find_rubbing(linkage, pose, friction%rubbing)
      friction%rate = friction_rates(linkage, pose, friction%rubbing, now)
      coulomb = coulomb_efforts(rubs, friction%rate)
      viscous = -rubs%viscous*friction%rate
      allocate (loads%body(size(linkage%bodies)), loads%pin(2, size(linkage%is_ground)))
      call put_friction(linkage, pose, friction%rubbing, viscous, loads%body, loads%pin)
      call add_free_loads(whole, rigid, pose, bent, body_load, pin_load, loads)
      joints = forces_of_loads(whole, pose, per, equations, loads, drive_force - &
        inertia*drive_acceleration(whole, pose, 1, bent))
      do k = 1, size(rubs)
        base(:, k) = force_in_joint(linkage, joints, rubs(k))
      end do
      do j = 1, size(rubs)
        call put_friction(linkage, pose, friction%rubbing, merge(coulomb, 0.0_wp, [(i == j, i=1, &
          size(rubs))]), loads%body, loads%pin)
        joints = forces_of_loads(whole, pose, per, equations, loads, 0.0_wp)
        do k = 1, size(rubs)
          influence(:, k, j) = force_in_joint(linkage, joints, rubs(k))
        end do
      end do
      call find_normal_forces(base, influence, friction)
      call finish_friction(linkage, pose, viscous, coulomb, friction)
    end associate
  end subroutine find_free_friction

end module free_friction
