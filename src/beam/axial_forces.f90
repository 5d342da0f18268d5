!> Axial force in every element, by equilibrium of the part of the link beyond it.
module axial_forces
  use beam_mesh, only: beam_mesh_t, element_count, element_length
  use inertia_loads, only: distributed_load, load_t, lumped_masses, lumped_stations, pin_load
  use joint_forces, only: find_joint_forces, joint_forces_t
  use kinds, only: wp
  use linkages, only: linkage_t
  use motions, only: acceleration_field_t, motion_t, point_acceleration, unit_fields
  use poses, only: pose_t
  implicit none (type, external)
  private

  public :: lumped_axial_forces, distributed_axial_forces, link_axial_force, distributed_unit_forces, total_force

contains

  !> With all mass on the nodes the force is constant in each element.
  pure function lumped_axial_forces(linkage, mesh, pose, field, joints) result(force)
    type(linkage_t), intent(in) :: linkage
    type(beam_mesh_t), intent(in) :: mesh
    type(pose_t), intent(in) :: pose
    type(acceleration_field_t), intent(in) :: field
    type(joint_forces_t), intent(in) :: joints
    real(wp), allocatable :: force(:, :) !! (0:2, elements) coefficients of 1, ξ, ξ², tension positive [N]

    real(wp), allocatable :: masses(:), stations(:)
    real(wp) :: beyond
    integer :: body, i

    allocate (force(0:2, element_count(mesh)))
    force = 0.0_wp
    do body = 1, size(linkage%bodies)
      masses = lumped_masses(linkage%bodies(body), mesh%elements(body))
      stations = lumped_stations(linkage%bodies(body), mesh%elements(body))
      beyond = dot_product(pose%direction(:, body), joints%on_last(:, body))
      do i = mesh%elements(body), 1, -1
        beyond = beyond - masses(i + 1)*dot_product(pose%direction(:, body), point_acceleration(field, body, stations(i + 1)))
        force(0, mesh%first_element(body) + i - 1) = beyond
      end do
    end do
  end function lumped_axial_forces

  !> With uniform mass `N(s) = e·F_last − μ ∫ e·a ds` from s to the last pin: quadratic along the link, so in each element too.
  pure function distributed_axial_forces(linkage, mesh, pose, field, joints) result(force)
    type(linkage_t), intent(in) :: linkage
    type(beam_mesh_t), intent(in) :: mesh
    type(pose_t), intent(in) :: pose
    type(acceleration_field_t), intent(in) :: field
    type(joint_forces_t), intent(in) :: joints
    real(wp), allocatable :: force(:, :) !! (0:2, elements) coefficients of 1, ξ, ξ², tension positive [N]

    real(wp) :: along, growth, length, left, mu
    integer :: body, i

    allocate (force(0:2, element_count(mesh)))
    do body = 1, size(linkage%bodies)
      associate (e => pose%direction(:, body), this => linkage%bodies(body))
        mu = this%line_density
        along = dot_product(e, field%at_first(:, body))
        growth = dot_product(e, field%slope(:, body))
        length = element_length(mesh, linkage, body)
        do i = 1, mesh%elements(body)
          left = (i - 1)*length
          force(:, mesh%first_element(body) + i - 1) = [ &
            dot_product(e, joints%on_last(:, body)) - mu*(this%length - left)*(along + 0.5_wp*growth*(this%length + left)), &
            mu*length*(along + growth*left), &
            0.5_wp*mu*growth*length**2]
        end do
      end associate
    end do
  end function distributed_axial_forces

  !> The same for a link as a whole: `N(ξ) = n0 + n1 ξ + n2 ξ²`, ξ from 0 to 1 along it.
  pure function link_axial_force(linkage, body, pose, field, joints) result(force)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: body
    type(pose_t), intent(in) :: pose
    type(acceleration_field_t), intent(in) :: field
    type(joint_forces_t), intent(in) :: joints
    real(wp) :: force(0:2) !! n0, n1, n2, tension positive [N]

    real(wp) :: along, growth, mass

    associate (e => pose%direction(:, body), length => linkage%bodies(body)%length)
      mass = linkage%bodies(body)%line_density*length
      along = dot_product(e, field%at_first(:, body))
      growth = 0.5_wp*length*dot_product(e, field%slope(:, body))
      force = [dot_product(e, joints%on_last(:, body)) - mass*(along + growth), mass*along, mass*growth]
    end associate
  end function link_axial_force

  !> `ω2² N_ω + α2 N_α` from the forces of the two unit loads.
  pure function total_force(unit_force, factor) result(force)
    real(wp), intent(in) :: unit_force(:, :, :) !! (…, …, 2) [N]
    real(wp), intent(in) :: factor(2)           !! ω2² and α2
    real(wp) :: force(size(unit_force, 1), size(unit_force, 2))

    force = factor(1)*unit_force(:, :, 1) + factor(2)*unit_force(:, :, 2)
  end function total_force

  !> Axial forces of uniform links under the inertia loads of the two unit fields; without loads there are no force functions.
  pure function distributed_unit_forces(linkage, pose, motion, loaded) result(force)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(motion_t), intent(in) :: motion
    logical, intent(in) :: loaded
    real(wp), allocatable :: force(:, :, :) !! (1, ξ, ξ²; bodies; for ω2² = 1 and α2 = 1) [N]

    type(acceleration_field_t) :: fields(2)
    type(load_t) :: loads(size(linkage%bodies))
    type(joint_forces_t) :: joints
    integer :: b, i

    allocate (force(merge(3, 0, loaded), size(linkage%bodies), 2))
    if (.not. loaded) return
    fields = unit_fields(linkage, pose, motion)
    do i = 1, 2
      do b = 1, size(linkage%bodies)
        loads(b) = distributed_load(linkage%bodies(b), b, pose, fields(i))
      end do
      joints = find_joint_forces(linkage, pose, loads, pin_load(linkage, fields(i)))
      do b = 1, size(linkage%bodies)
        force(:, b, i) = link_axial_force(linkage, b, pose, fields(i), joints)
      end do
    end do
  end function distributed_unit_forces

end module axial_forces
