! src/vibration/mesh/ - frequencies of the mesh that a deck gives, beside those of continuous links.
! In: a structure with a mesh, a state, unit loads. Out: frequencies in a `position_result_t`; to
! their error the difference to continuous links is added. Begin with `solve_mesh` in
! `mesh_solver.f90` (own modes of links) and `solve_nodal` in `nodal_solver.f90` (nodal
! displacements).
! Not here: elements and nodal matrices (`src/beam`), orders that the program chooses
! (`src/vibration/models`).

!> Axial forces in the elements of the deck's own mesh under the unit loads.
module mesh_forces
  use axial_forces, only: distributed_axial_forces, link_axial_force, lump_functions, &
    lumped_axial_forces, mean_axial_force, most_lump_functions
  use deformation_model, only: deformation_model_t
  use inertia_loads, only: load_t
  use joint_forces, only: find_joint_forces, joint_forces_t
  use kinds, only: wp
  use load_cases, only: case_count, find_case_loads, load_case_t, unit_loads_t
  use positions, only: state_t
  use structures, only: structure_t
  implicit none (type, external)
  private

  public :: find_mesh_forces, find_element_forces

contains

  !> Axial forces under the unit loads, as coefficients of the model's force functions.
  pure subroutine find_mesh_forces(structure, model, state, unit_loads, lumped, force)
    type(structure_t), intent(in) :: structure       !! with a mesh
    type(deformation_model_t), intent(in) :: model   !! of the mesh
    type(state_t), intent(in) :: state               !! with a pose
    type(unit_loads_t), intent(in) :: unit_loads     !! at this pose
    logical, intent(in) :: lumped                    !! masses on the nodes of the mesh; else along
                                                     !! the links
    real(wp), allocatable, intent(out) :: force(:, :, :)      !! (force functions, then those
                                                              !! of lumps; bodies; cases) [N];
                                                              !! without loads
                                                              !! no functions

    type(joint_forces_t) :: joints
    real(wp) :: in_element(3, sum(structure%mesh%elements))
    real(wp), allocatable :: jump(:)
    integer :: b, i, first, functions, smooth

    associate (linkage => structure%linkage, mesh => structure%mesh, occurs => unit_loads%occurs)
      functions = 0
      if (any(occurs)) functions = max(3, maxval(model%elements, mask=model%lumped)) + &
        most_lump_functions(linkage)
      allocate (force(functions, size(model%links), case_count))
      force = 0.0_wp
      do i = 1, case_count
        if (.not. occurs(i)) cycle
        associate (case => unit_loads%of_case(i))
          call find_element_forces(structure, state, case, lumped, in_element, joints)
          do b = 1, size(model%links)
            first = mesh%first_element(b)
            if (.not. model%links(b)%bends) then
              force(1, b, i) = in_element(1, first)
              cycle
            end if
            smooth = smooth_functions(model, b)
            if (model%lumped(b)) then
              force(:smooth, b, i) = in_element(1, first:first + smooth - 1)
            else
              force(:smooth, b, i) = link_axial_force(linkage, b, state%pose, case%field, joints)
            end if
            jump = lump_functions(linkage, b, state%pose, case)
            force(smooth + 1:smooth + size(jump), b, i) = jump
          end do
        end associate
      end do
    end associate
  end subroutine find_mesh_forces

  !> Number of force functions of a body before the jumps, which follow them.
  pure function smooth_functions(model, body) result(number)
    type(deformation_model_t), intent(in) :: model !! of the mesh
    integer, intent(in) :: body                    !! number of a link that bends
    integer :: number

    number = merge(model%elements(body), 3, model%lumped(body))
  end function smooth_functions

  !> Axial forces in all elements under one of the unit loads. The first element of a rigid link has
  !! the mean axial force of the link.
  pure subroutine find_element_forces(structure, state, case, lumped, in_element, joints)
    type(structure_t), intent(in) :: structure  !! with a mesh
    type(state_t), intent(in) :: state          !! with a pose
    type(load_case_t), intent(in) :: case       !! one unit load at this pose
    logical, intent(in) :: lumped               !! masses on the nodes; else along the links
    real(wp), intent(out) :: in_element(:, :)   !! (1, ξ, ξ²; elements) tension positive [N]
    type(joint_forces_t), intent(out) :: joints !! forces in the pins under this load

    type(load_t) :: loads(size(structure%linkage%bodies))
    real(wp) :: pin_loads(2, size(structure%linkage%pin_mass))
    integer :: elements(size(loads)), b

    associate (linkage => structure%linkage, mesh => structure%mesh)
      elements = 0
      if (lumped) elements = structure%load_elements
      call find_case_loads(linkage, elements, state%pose, case, loads, pin_loads)
      joints = find_joint_forces(linkage, state%pose, loads, pin_loads)
      if (lumped) then
        in_element = lumped_axial_forces(linkage, mesh, state%pose, case%field, joints)
      else
        in_element = distributed_axial_forces(linkage, mesh, state%pose, case%field, joints)
      end if
      do b = 1, size(loads)
        if (linkage%bodies(b)%bends) cycle
        in_element(:, mesh%first_element(b)) = [mean_axial_force(linkage, b, elements(b), &
          state%pose, case, joints), 0.0_wp, 0.0_wp]
      end do
    end associate
  end subroutine find_element_forces

end module mesh_forces
