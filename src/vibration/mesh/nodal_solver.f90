!> Frequencies of the deck's own mesh at one position, in nodal displacements, by LAPACK or ARPACK.
module nodal_solver
  use assembly, only: add_axial_jumps, add_turning_forces, assemble_geometric_stiffness, &
    assemble_mass, assemble_stiffness
  use axial_forces, only: axial_jumps, turning_forces
  use band_matrix, only: band_matrix_t
  use errors, only: error_t
  use joint_forces, only: joint_forces_t
  use kinds, only: wp
  use load_cases, only: case_count, unit_loads_t
  use mesh_forces, only: find_element_forces
  use nodal_eigensolver, only: find_modes, modes_t
  use position_results, only: position_result_t, take_mesh_value
  use positions, only: state_t
  use round_off, only: round_off_error
  use shape_samples, only: sample_nodal
  use structures, only: structure_t
  use vibration_models, only: by_dense, mode_request_t
  implicit none (type, external)
  private

  public :: solve_nodal

contains

  !> Solves the deck's mesh in nodal displacements, for every speed. The difference to the
  !! continuous links, whose frequencies are in `result`, is added to the error of each frequency.
  !!
  !! Matrices are assembled once per position; the geometric stiffness of a speed is the sum of unit
  !! matrices, one for each unit load that occurs, times their factors.
  !!
  !! Errors, speed by speed in `result%outcome`: those of `find_modes`.
  subroutine solve_nodal(structure, state, unit_loads, request, factor, want_shapes, result)
    type(structure_t), intent(in) :: structure    !! with a mesh
    type(state_t), intent(in) :: state            !! with a pose
    type(unit_loads_t), intent(in) :: unit_loads  !! at this pose
    type(mode_request_t), intent(in) :: request   !! method `by_dense` or `by_band`
    real(wp), intent(in) :: factor(:, :)          !! (cases, speeds) of the unit loads: ω2², α2, 1
    logical, intent(in) :: want_shapes(:)         !! (speeds)
    type(position_result_t), intent(inout) :: result !! of the continuous links; becomes that of the
                                                     !! mesh

    type(band_matrix_t) :: stiffness, mass, total, unit_stiffness(case_count)
    type(modes_t) :: found
    type(joint_forces_t) :: joints
    type(error_t), allocatable :: error
    real(wp) :: in_element(3, sum(structure%mesh%elements))
    integer :: b, i, k

    stiffness = assemble_stiffness(structure%linkage, structure%beams, structure%mesh, state%pose)
    mass = assemble_mass(structure%linkage, structure%mesh, state%pose)
    result%counts%stiffness_matrices = result%counts%stiffness_matrices + 1
    result%counts%mass_matrices = result%counts%mass_matrices + 1
    do i = 1, case_count
      if (.not. unit_loads%occurs(i)) cycle
      associate (case => unit_loads%of_case(i))
        call find_element_forces(structure, state, case, request%lumped, in_element, joints)
        unit_stiffness(i) = assemble_geometric_stiffness(structure%linkage, structure%mesh, &
          state%pose, in_element)
        do b = 1, size(structure%beams)
          call add_axial_jumps(structure%linkage, structure%mesh, state%pose, b, &
            axial_jumps(structure%linkage, b, state%pose, case), unit_stiffness(i))
          call add_turning_forces(structure%linkage, structure%mesh, state%pose, b, &
            turning_forces(structure%linkage, b, state%pose, case), unit_stiffness(i))
        end do
      end associate
      result%counts%geometric_matrices = result%counts%geometric_matrices + 1
    end do
    do k = 1, size(factor, 2)
      if (allocated(result%outcome(k)%error)) cycle
      total = stiffness
      do i = 1, case_count
        if (abs(factor(i, k)) > 0.0_wp) total%entry = total%entry + &
          factor(i, k)*unit_stiffness(i)%entry
      end do
      call find_modes(total, mass, request%modes, request%method == by_dense, &
        all(abs(factor(:, k)) <= 0.0_wp), round_off_error(structure%linkage, structure%beams, &
        structure%mesh), want_shapes(k), found, error)
      result%counts%factorizations = result%counts%factorizations + found%factorizations
      result%counts%full_solutions = result%counts%full_solutions + 1
      if (allocated(error)) then
        call move_alloc(error, result%outcome(k)%error)
        cycle
      end if
      call take_mesh_value(found%lambda, 0.0_wp, result%lambda(:, k), result%error(:, k))
      if (.not. want_shapes(k)) cycle
      call sample_nodal(structure, state, found%vector, request, result%shapes(k))
      result%counts%shapes = result%counts%shapes + request%modes
    end do
  end subroutine solve_nodal

end module nodal_solver
