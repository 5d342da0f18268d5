!> Frequencies of the deck's own mesh at one position, in deformation coordinates: from the own
!! modes of the links or, where links have too many unknowns for that, by running sums along them.
module mesh_solver
  use axial_forces, only: total_force
  use bordered_eigensolver, only: bordered_modes_t
  use bordered_pencil, only: bordered_pencil_t
  use chain_solver, only: find_chain_modes
  use deformation_chain, only: deformation_chain_t
  use deformation_model, only: deformation_model_t
  use errors, only: error_t
  use kinds, only: wp
  use load_cases, only: unit_loads_t
  use mesh_forces, only: find_mesh_forces, smooth_functions
  use position_equations, only: assemble_equations, assemble_stiffness_of, set_speed
  use position_results, only: position_result_t, position_work_t, take_mesh_value
  use positions, only: state_t
  use shape_samples, only: sample_chain, sample_reduced
  use speed_solver, only: solve_speeds, speed_work_t
  use structures, only: structure_t
  use subspace_eigensolver, only: subspace_modes_t
  use vibration_models, only: mode_request_t
  implicit none (type, external)
  private

  public :: solve_mesh, solve_long_mesh

contains

  !> Solves the deck's mesh from the own modes of its links, for every speed. The difference to the
  !! continuous links, whose frequencies are in `result`, is added to the error of each frequency.
  !!
  !! Errors, speed by speed in `result%outcome`: no start leads to modes that are proven complete.
  subroutine solve_mesh(structure, model, state, unit_loads, request, factor, want_shapes, work, &
      result)
    type(structure_t), intent(in) :: structure     !! with a mesh
    type(deformation_model_t), intent(in) :: model !! of the mesh
    type(state_t), intent(in) :: state             !! with a pose
    type(unit_loads_t), intent(in) :: unit_loads   !! at this pose
    type(mode_request_t), intent(in) :: request    !! modes, loads, points along the links
    real(wp), intent(in) :: factor(:, :)           !! (cases, speeds) of the unit loads: ω2², α2, 1
    logical, intent(in) :: want_shapes(:)          !! (speeds)
    type(speed_work_t), intent(inout) :: work      !! for this model
    type(position_result_t), intent(inout) :: result !! of the continuous links; becomes that of the
                                                     !! mesh

    type(bordered_modes_t) :: found(size(factor, 2))
    real(wp), allocatable :: unit_force(:, :, :), in_element(:, :, :)
    integer :: k

    call find_mesh_forces(structure, model, state, unit_loads, request%lumped, unit_force, &
      in_element)
    call assemble_equations(structure%linkage, model, state%pose, unit_force, factor, &
      work%equations, result%counts)
    call solve_speeds(state%crank, factor, request%modes, want_shapes, work, found, &
      result%outcome, result%counts)
    do k = 1, size(factor, 2)
      if (allocated(result%outcome(k)%error)) cycle
      call take_mesh_value(found(k)%lambda(:request%modes), found(k)%error(:request%modes), &
        result%lambda(:, k), result%error(:, k))
      if (.not. want_shapes(k)) cycle
      call sample_reduced(structure%linkage, model, work%equations%chords, state%pose, found(k), &
        request, result%shapes(k))
      result%counts%shapes = result%counts%shapes + request%modes
    end do
  end subroutine solve_mesh

  !> Solves a mesh with links of too many unknowns to be decomposed into own modes, for every speed:
  !! by running sums along the links, starting from the modes of a near model, which has continuous
  !! links in place of the long ones. Errors are found as in `solve_mesh`.
  !!
  !! Errors, speed by speed in `result%outcome`: the near model has no proven modes, the iteration
  !! on the mesh does not converge, or a mode may be missing.
  subroutine solve_long_mesh(structure, near, state, unit_loads, request, factor, want_shapes, &
      work, result)
    type(structure_t), intent(in) :: structure    !! with a mesh
    type(deformation_model_t), intent(in) :: near !! the near model
    type(state_t), intent(in) :: state            !! with a pose
    type(unit_loads_t), intent(in) :: unit_loads  !! at this pose
    type(mode_request_t), intent(in) :: request   !! modes, loads, points along the links
    real(wp), intent(in) :: factor(:, :)          !! (cases, speeds) of the unit loads: ω2², α2, 1
    logical, intent(in) :: want_shapes(:)         !! (speeds)
    type(position_work_t), intent(inout) :: work  !! `mesh` for the near model, `chain` for the mesh
    type(position_result_t), intent(inout) :: result !! of the continuous links; becomes that of the
                                                     !! mesh

    type(bordered_modes_t) :: start(size(factor, 2))
    type(bordered_pencil_t) :: own, least
    type(subspace_modes_t) :: found
    type(error_t), allocatable :: error
    real(wp), allocatable :: unit_force(:, :, :), in_element(:, :, :), total(:, :)
    integer :: elements, k

    call find_mesh_forces(structure, near, state, unit_loads, request%lumped, unit_force, &
      in_element)
    call assemble_equations(structure%linkage, near, state%pose, unit_force, factor, &
      work%mesh%equations, result%counts)
    call solve_speeds(state%crank, factor, request%modes, want_shapes, work%mesh, start, &
      result%outcome, result%counts)
    work%chain%chords = work%mesh%equations%chords
    do k = 1, size(factor, 2)
      if (allocated(result%outcome(k)%error)) cycle
      call set_speed(work%mesh%equations, factor(:, k))
      own = work%mesh%equations%pencil
      elements = merge(size(in_element, 2), 0, own%loaded)
      work%chain%axial_force = total_force(in_element(:, :elements, :), factor(:, k))
      if (own%loaded) then
        total = total_force(unit_force, factor(:, k))
        call take_jumps(near, total, work%chain)
        call lower_to_mesh(structure, near, work%chain%axial_force, total)
        call assemble_stiffness_of(near, total, work%mesh%equations)
        result%counts%geometric_matrices = result%counts%geometric_matrices + 1
      end if
      least = work%mesh%equations%pencil
      call find_chain_modes(near, own, least, start(k), request%modes, want_shapes(k), &
        work%chain, result%counts, found, error)
      if (allocated(error)) then
        call move_alloc(error, result%outcome(k)%error)
        cycle
      end if
      call take_mesh_value(found%lambda(:request%modes), found%error(:request%modes), &
        result%lambda(:, k), result%error(:, k))
      if (.not. want_shapes(k)) cycle
      call sample_chain(structure%linkage, work%chain, state, found%vector, request, &
        result%shapes(k))
      result%counts%shapes = result%counts%shapes + request%modes
    end do
  end subroutine solve_long_mesh

  !> Copies the jumps of the axial forces, and the forces across masses, from the near model to the
  !! long mesh: they are the same.
  pure subroutine take_jumps(near, force, chain)
    type(deformation_model_t), intent(in) :: near
    real(wp), intent(in) :: force(:, :) !! (force functions, bodies) [N]
    type(deformation_chain_t), intent(inout) :: chain

    integer :: b, n

    do b = 1, size(near%links)
      if (.not. near%links(b)%bends) cycle
      n = size(chain%links(b)%lump)
      if (chain%links(b)%lumps_turn) n = 2*n
      associate (smooth => smooth_functions(near, b))
        chain%jump(:n, b) = force(smooth + 1:smooth + n, b)
      end associate
    end do
  end subroutine take_jumps

  !> Lowers the axial force of the continuous links until it is nowhere above that of the mesh. The
  !! near model is then nowhere stiffer than the mesh, as the proof requires.
  pure subroutine lower_to_mesh(structure, near, in_element, force)
    type(structure_t), intent(in) :: structure
    type(deformation_model_t), intent(in) :: near
    real(wp), intent(in) :: in_element(:, :) !! (1, ξ, ξ²; elements) of the mesh [N]
    real(wp), intent(inout) :: force(:, :)   !! (force functions, bodies) of the near model [N]

    real(wp) :: above, xi
    integer :: b, e, end_of, n

    do b = 1, size(near%links)
      if (near%lumped(b) .or. .not. near%links(b)%bends) cycle
      n = structure%mesh%elements(b)
      above = 0.0_wp
      do e = 1, n
        do end_of = 0, 1
          xi = real(e - 1 + end_of, wp)/n
          associate (of_mesh => in_element(:, structure%mesh%first_element(b) + e - 1))
            above = max(above, force(1, b) + xi*(force(2, b) + xi*force(3, b)) - &
              (of_mesh(1) + end_of*(of_mesh(2) + of_mesh(3))))
          end associate
        end do
      end do
      ! Between the ends of an element the parabola rises above its chord by at most
      ! |force(3)|/(4 n²).
      force(1, b) = force(1, b) - above - abs(force(3, b))/(4.0_wp*n**2)
    end do
  end subroutine lower_to_mesh

end module mesh_solver
