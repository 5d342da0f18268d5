!> Axial force in every element, from the equilibrium of the part of the link beyond it.
!!
!! The axial force jumps at every mass along the link, and at the place of every force. A jump is
!! kept as a constant force from the first pin to there, apart from the smooth rest. The
!! cross-section that carries a mass at the offset e turns by θ: a force F across the link on the
!! mass does the work `−½ F e θ²`. The centrifugal forces about its mass centre, with the moment of
!! inertia I, do `−½ I ω² θ²`. Both are kept as (F e + I ω²)/L, after the jumps.
!!
!! Of a rigid link only the mean of the axial force is needed. When the link turns by ψ, dead loads
!! F at places r do the work `−½ ψ² Σ F·r`. The mean is `Σ F·r/L`; of a slender link `Σ F·r` is
!! `∫ N dx`.
module axial_forces
  use acceleration_fields, only: acceleration_field_t, point_acceleration
  use beam_mesh, only: beam_mesh_t, element_count, element_length
  use body_lumps, only: force_functions_of, has_turning_lumps, lump_count
  use group_factors, only: factorize_groups, group_factors_t
  use inertia_loads, only: load_t, lumped_masses, lumped_stations
  use joint_forces, only: find_joint_forces, joint_forces_t
  use kinds, only: wp
  use linkages, only: forced_place_t, linkage_t, normal_to
  use load_cases, only: case_count, find_case_loads, load_case_t, unit_loads_t
  use poses, only: arm_to_place, pose_t
  use rigid_bodies, only: rigid_body, rigid_body_t
  implicit none (type, external)
  private

  public :: lumped_axial_forces, distributed_axial_forces, link_axial_force, axial_jumps, &
    turning_forces, lump_functions, mean_axial_force
  public :: distributed_unit_forces, most_lump_functions, total_force

contains

  !> Axial forces with all mass on the nodes: constant in each element. Jumps at masses along the
  !! links are left out, see `axial_jumps`.
  pure function lumped_axial_forces(linkage, mesh, pose, field, joints) result(force)
    type(linkage_t), intent(in) :: linkage          !! lengths and line densities
    type(beam_mesh_t), intent(in) :: mesh           !! elements of every body
    type(pose_t), intent(in) :: pose                !! directions of the links
    type(acceleration_field_t), intent(in) :: field !! of this load case
    type(joint_forces_t), intent(in) :: joints      !! in equilibrium with the same loads
    real(wp), allocatable :: force(:, :)            !! (0:2, elements) coefficients of 1, ξ, ξ² in
                                                    !! every element, without jumps; tension
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

  !> Axial forces with uniform mass: `N(s) = e·F_last − μ ∫ e·a ds`, integrated from s to the last
  !! pin. N is quadratic along the link, and so in each element. Jumps at masses along the links are
  !! left out, see `axial_jumps`.
  pure function distributed_axial_forces(linkage, mesh, pose, field, joints) result(force)
    type(linkage_t), intent(in) :: linkage          !! lengths and line densities
    type(beam_mesh_t), intent(in) :: mesh           !! elements of every body
    type(pose_t), intent(in) :: pose                !! directions of the links
    type(acceleration_field_t), intent(in) :: field !! of this load case
    type(joint_forces_t), intent(in) :: joints      !! in equilibrium with the same loads
    real(wp), allocatable :: force(:, :)            !! (0:2, elements) coefficients of 1, ξ, ξ² in
                                                    !! every element, without jumps; tension
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

  !> Axial force of a whole link with uniform mass: `N(ξ) = n0 + n1 ξ + n2 ξ²`, ξ from 0 to 1 along
  !! it, without the jumps at masses.
  pure function link_axial_force(linkage, body, pose, field, joints) result(force)
    type(linkage_t), intent(in) :: linkage          !! lengths and line densities
    integer, intent(in) :: body                     !! number of the link
    type(pose_t), intent(in) :: pose                !! directions of the links
    type(acceleration_field_t), intent(in) :: field !! of this load case
    type(joint_forces_t), intent(in) :: joints      !! in equilibrium with the same loads
    real(wp) :: force(0:2)                          !! n0, n1, n2, tension positive [N]

    real(wp) :: along, growth, mass

    associate (e => pose%direction(:, body), length => linkage%bodies(body)%length)
      mass = linkage%bodies(body)%line_density*length
      along = dot_product(e, field%at_first(:, body))
      growth = 0.5_wp*length*dot_product(e, field%slope(:, body))
      force = [dot_product(e, joints%on_last(:, body)) - mass*(along + growth), mass*along, &
        mass*growth]
    end associate
  end function link_axial_force

  !> Contribution of every lump of a link to the axial force between the first pin and the lump:
  !! `−m e·a` from the inertia load of a mass, `e·F` from a force.
  pure function axial_jumps(linkage, body, pose, case) result(jump)
    type(linkage_t), intent(in) :: linkage  !! masses and forces along the links
    integer, intent(in) :: body             !! number of the link
    type(pose_t), intent(in) :: pose        !! directions of the links
    type(load_case_t), intent(in) :: case   !! accelerations, and forces at places
    real(wp), allocatable :: jump(:)        !! (lumps) tension positive [N]

    integer :: i, masses

    associate (this => linkage%bodies(body))
      allocate (jump(lump_count(this)))
      masses = 0
      if (allocated(this%lumps)) masses = size(this%lumps)
      do i = 1, masses
        jump(i) = -this%lumps(i)%mass*dot_product(pose%direction(:, body), &
          point_acceleration(case%field, body, this%lumps(i)%place(1), this%lumps(i)%place(2)))
      end do
      do i = masses + 1, size(jump)
        jump(i) = dot_product(pose%direction(:, body), force_at(case, this%forced(i - masses)))
      end do
    end associate
  end function axial_jumps

  !> What the inertia loads of masses do against the rotation of the cross-sections that carry them,
  !! divided by the length: `−(m e n·a + I e_x·slope)/L`, with the acceleration a of the mass and
  !! its slope along the link, whose part in that direction is −ω²; and what forces do: `e n·F/L`.
  pure function turning_forces(linkage, body, pose, case) result(force)
    type(linkage_t), intent(in) :: linkage  !! masses and forces along the links
    integer, intent(in) :: body             !! number of the link
    type(pose_t), intent(in) :: pose        !! directions of the links
    type(load_case_t), intent(in) :: case   !! accelerations, and forces at places
    real(wp), allocatable :: force(:)       !! (lumps) positive if it turns them back [N]

    integer :: i, masses

    associate (this => linkage%bodies(body), axis => pose%direction(:, body))
      allocate (force(lump_count(this)))
      masses = 0
      if (allocated(this%lumps)) masses = size(this%lumps)
      do i = 1, masses
        associate (lump => this%lumps(i))
          force(i) = -(lump%mass*lump%place(2)*dot_product(normal_to(axis), &
            point_acceleration(case%field, body, lump%place(1), lump%place(2))) + &
            lump%inertia*dot_product(axis, case%field%slope(:, body)))/this%length
        end associate
      end do
      do i = masses + 1, size(force)
        associate (at => this%forced(i - masses))
          force(i) = at%place(2)*dot_product(normal_to(axis), force_at(case, at))/this%length
        end associate
      end do
    end associate
  end function turning_forces

  !> The force at a place of a body; 0 in load cases without forces.
  pure function force_at(case, at) result(force)
    type(load_case_t), intent(in) :: case
    type(forced_place_t), intent(in) :: at
    real(wp) :: force(2) !! [N]

    force = 0.0_wp
    if (allocated(case%place_force)) force = case%place_force(:, at%load)
  end function force_at

  !> What the lumps of a link add to the functions of its axial force: jumps and, if one turns with
  !! its cross-section, `turning_forces`.
  pure function lump_functions(linkage, body, pose, case) result(force)
    type(linkage_t), intent(in) :: linkage  !! masses and forces along the links
    integer, intent(in) :: body             !! number of the link
    type(pose_t), intent(in) :: pose        !! directions of the links
    type(load_case_t), intent(in) :: case   !! accelerations, and forces at places
    real(wp), allocatable :: force(:)       !! (lumps, perhaps twice) [N]

    force = axial_jumps(linkage, body, pose, case)
    if (has_turning_lumps(linkage%bodies(body))) force = [force, turning_forces(linkage, body, &
      pose, case)]
  end function lump_functions

  !> Mean axial force over the length of a rigid link: `Σ F·r/L`, r from its first pin.
  !!
  !! Inertia loads act where the mass is: `−∫ a·r dm = −(a_first·S + (slope·e) I)` with the first
  !! moment S and the moment of inertia I about the first pin. The rotary inertia of cross-sections
  !! does not count, as in a slender link.
  pure function mean_axial_force(linkage, body, elements, pose, case, joints) result(force)
    type(linkage_t), intent(in) :: linkage          !! lengths and masses
    integer, intent(in) :: body                     !! number of the link
    integer, intent(in) :: elements                 !! on whose nodes the mass of the link sits; 0:
                                                    !! distributed
    type(pose_t), intent(in) :: pose                !! directions of the links
    type(load_case_t), intent(in) :: case           !! accelerations, and forces at places
    type(joint_forces_t), intent(in) :: joints      !! in equilibrium with the same loads
    real(wp) :: force                               !! tension positive [N]

    type(rigid_body_t) :: whole
    integer :: i

    associate (e => pose%direction(:, body), this => linkage%bodies(body), field => case%field)
      whole = rigid_body(this, elements)
      if (elements == 0) whole%inertia = whole%inertia - this%rotary_inertia*this%length
      if (allocated(this%lumps)) whole%inertia = whole%inertia - sum(this%lumps%rotary_inertia)
      force = dot_product(e, joints%on_last(:, body)) - (whole%first_moment(1)*dot_product(e, &
        field%at_first(:, body)) + whole%first_moment(2)*dot_product(normal_to(e), &
        field%at_first(:, body)) + whole%inertia*dot_product(e, field%slope(:, body)))/this%length
      if (.not. allocated(this%forced)) return
      do i = 1, size(this%forced)
        force = force + dot_product(force_at(case, this%forced(i)), arm_to_place(pose, body, &
          this%forced(i)%place))/this%length
      end do
    end associate
  end function mean_axial_force

  !> Axial forces of all unit loads together, each times its factor: `N_const + ω2² N_ω + α2 N_α`.
  pure function total_force(unit_force, factor) result(force)
    real(wp), intent(in) :: unit_force(:, :, :) !! (coefficients, bodies or elements, cases) [N]
    real(wp), intent(in) :: factor(case_count)  !! ω2², α2, 1
    real(wp) :: force(size(unit_force, 1), size(unit_force, 2)) !! [N]

    integer :: i

    force = factor(1)*unit_force(:, :, 1)
    do i = 2, case_count
      force = force + factor(i)*unit_force(:, :, i)
    end do
  end function total_force

  !> Axial forces of all links under the unit loads, with the mass distributed along the links. For
  !! a rigid link this is its mean force. Without any load the first dimension is empty.
  pure function distributed_unit_forces(linkage, pose, unit_loads) result(force)
    type(linkage_t), intent(in) :: linkage       !! lengths, masses, loads
    type(pose_t), intent(in) :: pose             !! away from dead points
    type(unit_loads_t), intent(in) :: unit_loads !! of this pose
    real(wp), allocatable :: force(:, :, :)      !! (1, ξ, ξ², lumps; bodies; cases) zero in cases
                                                 !! that do not occur [N]

    type(load_t) :: loads(size(linkage%bodies))
    type(joint_forces_t) :: joints
    type(group_factors_t), allocatable :: factors(:)
    real(wp), allocatable :: jump(:)
    real(wp) :: pin_loads(2, size(linkage%pin_mass))
    integer :: b, i

    allocate (force(merge(3 + most_lump_functions(linkage), 0, any(unit_loads%occurs)), &
      size(linkage%bodies), case_count))
    if (.not. any(unit_loads%occurs)) return
    force = 0.0_wp
    call factorize_groups(linkage, pose, factors)
    do i = 1, case_count
      if (.not. unit_loads%occurs(i)) cycle
      associate (case => unit_loads%of_case(i))
        call find_case_loads(linkage, spread(0, 1, size(loads)), pose, case, loads, pin_loads)
        joints = find_joint_forces(linkage, pose, loads, pin_loads, factors)
        do b = 1, size(linkage%bodies)
          if (linkage%bodies(b)%bends) then
            force(:3, b, i) = link_axial_force(linkage, b, pose, case%field, joints)
            if (lump_count(linkage%bodies(b)) == 0) cycle
            jump = lump_functions(linkage, b, pose, case)
            force(4:3 + size(jump), b, i) = jump
          else
            force(1, b, i) = mean_axial_force(linkage, b, 0, pose, case, joints)
          end if
        end do
      end associate
    end do
  end function distributed_unit_forces

  !> Largest number of force functions that the lumps of any link that bends add.
  pure function most_lump_functions(linkage) result(most)
    type(linkage_t), intent(in) :: linkage !! masses along the links
    integer :: most

    integer :: b

    most = 0
    do b = 1, size(linkage%bodies)
      if (linkage%bodies(b)%bends) most = max(most, force_functions_of(linkage%bodies(b)))
    end do
  end function most_lump_functions

end module axial_forces
