!> Frequencies of the deck's own mesh at one position, in deformation coordinates: from the own
!! modes of the links.
module mesh_solver
  use deformation_model, only: deformation_model_t
  use kinds, only: wp
  use load_cases, only: case_count, unit_loads_t
  use mesh_forces, only: find_mesh_forces
  use position_equations, only: assemble_equations
  use position_results, only: position_result_t, take_mesh_value
  use positions, only: state_t
  use shape_samples, only: sample_reduced
  use speed_solver, only: solve_speeds, speed_work_t
  use structures, only: structure_t
  use vibration_models, only: load_factors, mode_request_t
  implicit none (type, external)
  private

  public :: solve_mesh

contains

  !> Solves the deck's mesh from the own modes of its links, for every speed. The difference to the
  !! continuous links, whose frequencies are in `result`, is added to the error of each frequency.
  !!
  !! Errors, speed by speed in `result%outcome`: no start leads to modes that are proven complete.
  subroutine solve_mesh(structure, model, state, unit_loads, request, want_shapes, work, result)
    type(structure_t), intent(in) :: structure     !! with a mesh
    type(deformation_model_t), intent(in) :: model !! of the mesh
    type(state_t), intent(in) :: state             !! with a pose
    type(unit_loads_t), intent(in) :: unit_loads   !! at this pose
    type(mode_request_t), intent(in) :: request    !! modes, loads, points along the links
    logical, intent(in) :: want_shapes(:)          !! (speeds)
    type(speed_work_t), intent(inout) :: work      !! for this model
    type(position_result_t), intent(inout) :: result !! of the continuous links; becomes that of the
                                                     !! mesh

    real(wp) :: factor(case_count, size(request%speed))
    real(wp), allocatable :: unit_force(:, :, :)
    integer :: k

    factor = load_factors(request)
    call find_mesh_forces(structure, model, state, unit_loads, request%lumped, unit_force)
    call assemble_equations(structure%linkage, model, state%pose, unit_force, factor, &
      work%equations, result%counts)
    call solve_speeds(state%crank, factor, request%modes, want_shapes, work, result%outcome, &
      result%counts)
    do k = 1, size(request%speed)
      if (allocated(result%outcome(k)%error)) cycle
      associate (found => work%found(k))
        call take_mesh_value(found%lambda(:request%modes), found%error(:request%modes), &
          result%lambda(:, k), result%error(:, k))
        if (.not. want_shapes(k)) cycle
        call sample_reduced(structure%linkage, model, work%equations%chords, state%pose, found, &
          request, result%shapes(k), structure%elastic)
      end associate
      result%counts%shapes = result%counts%shapes + request%modes
    end do
  end subroutine solve_mesh

end module mesh_solver
