!> Axial force in every element, by equilibrium of the part of the link beyond it.
!!
!! At a mass along the link the force jumps. Jumps are told apart from the rest, which is smooth: a
!! force from the first pin up to the mass.
!!
!! Of a link that does not bend one number counts, its mean: turned by ψ, its dead loads F at places
!! r do the work `−½ ψ² Σ F·r`, and `Σ F·r`, which is `∫ N dx` of a slender link, is L times that
!! mean.
module axial_forces
  use acceleration_fields, only: acceleration_field_t, point_acceleration
  use beam_mesh, only: beam_mesh_t, element_count, element_length
  use body_lumps, only: lump_count
  use inertia_loads, only: load_t, lumped_masses, lumped_stations
  use joint_forces, only: find_joint_forces, joint_forces_t
  use kinds, only: wp
  use linkages, only: linkage_t, normal_to
  use load_cases, only: case_count, find_case_loads, unit_loads_t
  use poses, only: pose_t
  use rigid_bodies, only: rigid_body, rigid_body_t
  implicit none (type, external)
  private

  public :: lumped_axial_forces, distributed_axial_forces, link_axial_force, axial_jumps, &
    mean_axial_force
  public :: distributed_unit_forces, most_jumps, total_force

contains

  !> With all mass on the nodes the force is constant in each element, but for jumps.
  pure function lumped_axial_forces(linkage, mesh, pose, field, joints) result(force)
    type(linkage_t), intent(in) :: linkage
    type(beam_mesh_t), intent(in) :: mesh
    type(pose_t), intent(in) :: pose
    type(acceleration_field_t), intent(in) :: field
    type(joint_forces_t), intent(in) :: joints
    real(wp), allocatable :: force(:, :) !! (0:2, elements) coefficients of 1, ξ, ξ², tension
                                         !! positive [N]

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
        beyond = beyond - masses(i + 1)*dot_product(pose%direction(:, body), &
          point_acceleration(field, body, stations(i + 1)))
        force(0, mesh%first_element(body) + i - 1) = beyond
      end do
    end do
  end function lumped_axial_forces

  !> With uniform mass `N(s) = e·F_last − μ ∫ e·a ds` from s to the last pin: quadratic along the
  !! link, so in each element too, but for jumps.
  pure function distributed_axial_forces(linkage, mesh, pose, field, joints) result(force)
    type(linkage_t), intent(in) :: linkage
    type(beam_mesh_t), intent(in) :: mesh
    type(pose_t), intent(in) :: pose
    type(acceleration_field_t), intent(in) :: field
    type(joint_forces_t), intent(in) :: joints
    real(wp), allocatable :: force(:, :) !! (0:2, elements) coefficients of 1, ξ, ξ², tension
                                         !! positive [N]

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
          force(:, mesh%first_element(body) + i - 1) = [dot_product(e, joints%on_last(:, body)) - &
            mu*(this%length - left)*(along + 0.5_wp*growth*(this%length + left)), &
            mu*length*(along + growth*left), 0.5_wp*mu*growth*length**2]
        end do
      end associate
    end do
  end function distributed_axial_forces

  !> The same for a link as a whole: `N(ξ) = n0 + n1 ξ + n2 ξ²`, ξ from 0 to 1 along it, but for
  !! jumps.
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
      force = [dot_product(e, joints%on_last(:, body)) - mass*(along + growth), mass*along, &
        mass*growth]
    end associate
  end function link_axial_force

  !> What the inertia load of every mass along a link adds to the axial force before it, tension
  !! positive [N].
  pure function axial_jumps(linkage, body, pose, field) result(jump)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: body
    type(pose_t), intent(in) :: pose
    type(acceleration_field_t), intent(in) :: field
    real(wp), allocatable :: jump(:) !! (lumps)

    integer :: i

    associate (this => linkage%bodies(body))
      allocate (jump(lump_count(this)))
      do i = 1, size(jump)
        jump(i) = -this%lumps(i)%mass*dot_product(pose%direction(:, body), &
          point_acceleration(field, body, this%lumps(i)%place(1)))
      end do
    end associate
  end function axial_jumps

  !> Mean over the length of the axial force of a link that does not bend, tension positive [N]: `Σ
  !! F·r/L`, r from its first pin.
  !!
  !! Inertia loads act where the mass is, and `−∫ a·r dm = −(a_first·S + (slope·e) I)` with the
  !! first moment S and the moment of inertia I about the first pin. That of cross-sections does not
  !! count, as it does not in a slender link.
  pure function mean_axial_force(linkage, body, elements, pose, field, joints) result(force)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: body
    integer, intent(in) :: elements !! on whose nodes the mass of the link sits; 0: it is
                                    !! distributed
    type(pose_t), intent(in) :: pose
    type(acceleration_field_t), intent(in) :: field
    type(joint_forces_t), intent(in) :: joints
    real(wp) :: force

    type(rigid_body_t) :: whole

    associate (e => pose%direction(:, body), this => linkage%bodies(body))
      whole = rigid_body(this, elements)
      if (elements == 0) whole%inertia = whole%inertia - this%rotary_inertia*this%length
      force = dot_product(e, joints%on_last(:, body)) - (whole%first_moment(1)*dot_product(e, &
        field%at_first(:, body)) + whole%first_moment(2)*dot_product(normal_to(e), &
        field%at_first(:, body)) + whole%inertia*dot_product(e, field%slope(:, body)))/this%length
    end associate
  end function mean_axial_force

  !> The sum of the forces of the unit loads, each times its factor: `N_const + ω2² N_ω + α2 N_α`.
  pure function total_force(unit_force, factor) result(force)
    real(wp), intent(in) :: unit_force(:, :, :) !! (…, …, cases) [N]
    real(wp), intent(in) :: factor(case_count)
    real(wp) :: force(size(unit_force, 1), size(unit_force, 2))

    integer :: i

    force = factor(1)*unit_force(:, :, 1)
    do i = 2, case_count
      force = force + factor(i)*unit_force(:, :, i)
    end do
  end function total_force

  !> Axial forces of links under the unit loads, their masses distributed along them; without loads
  !! there are no force functions.
  pure function distributed_unit_forces(linkage, pose, unit_loads) result(force)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(unit_loads_t), intent(in) :: unit_loads !! of this pose
    real(wp), allocatable :: force(:, :, :)      !! (1, ξ, ξ², jumps; bodies; cases) [N]; zero in
                                                 !! cases that do not occur

    type(load_t) :: loads(size(linkage%bodies))
    type(joint_forces_t) :: joints
    real(wp), allocatable :: jump(:)
    real(wp) :: pin_loads(2, size(linkage%pin_mass))
    integer :: b, i

    allocate (force(merge(3 + most_jumps(linkage), 0, any(unit_loads%occurs)), &
      size(linkage%bodies), case_count))
    if (.not. any(unit_loads%occurs)) return
    force = 0.0_wp
    do i = 1, case_count
      if (.not. unit_loads%occurs(i)) cycle
      associate (case => unit_loads%of_case(i))
        call find_case_loads(linkage, spread(0, 1, size(loads)), pose, case, loads, pin_loads)
        joints = find_joint_forces(linkage, pose, loads, pin_loads)
        do b = 1, size(linkage%bodies)
          if (linkage%bodies(b)%bends) then
            force(:3, b, i) = link_axial_force(linkage, b, pose, case%field, joints)
            if (lump_count(linkage%bodies(b)) == 0) cycle
            jump = axial_jumps(linkage, b, pose, case%field)
            force(4:3 + size(jump), b, i) = jump
          else
            force(1, b, i) = mean_axial_force(linkage, b, 0, pose, case%field, joints)
          end if
        end do
      end associate
    end do
  end function distributed_unit_forces

  !> Jumps of the axial force in the link that bends and carries most masses.
  pure function most_jumps(linkage) result(most)
    type(linkage_t), intent(in) :: linkage
    integer :: most

    integer :: b

    most = 0
    do b = 1, size(linkage%bodies)
      if (linkage%bodies(b)%bends) most = max(most, lump_count(linkage%bodies(b)))
    end do
  end function most_jumps

end module axial_forces
