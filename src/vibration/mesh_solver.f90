!> Frequencies of the deck's own mesh at one position, in one of three ways.
module mesh_solver
  use assembly, only: add_axial_jumps, assemble_geometric_stiffness, assemble_mass, &
    assemble_stiffness
  use axial_forces, only: axial_jumps, distributed_axial_forces, link_axial_force, &
    lumped_axial_forces, mean_axial_force, most_jumps, total_force
  use band_matrix, only: band_matrix_t
  use bordered_eigensolver, only: bordered_modes_t
  use bordered_matrix, only: bordered_matrix_t
  use chain_solver, only: find_chain_modes
  use deformation_chain, only: deformation_chain_t
  use deformation_model, only: deformation_model_t
  use errors, only: error_t
  use inertia_loads, only: load_t
  use joint_forces, only: find_joint_forces, joint_forces_t
  use kinds, only: wp
  use load_cases, only: case_count, find_case_loads, load_case_t, unit_cases
  use mechanisms, only: mechanism_t
  use nodal_eigensolver, only: find_modes, modes_t
  use pin_displacements, only: chords_t
  use position_results, only: of_frequency, position_result_t, position_work_t
  use positions, only: state_t
  use reduced_assembly, only: reduced_geometric_stiffness
  use round_off, only: round_off_error
  use shape_samples, only: sample_chain, sample_nodal, sample_reduced
  use speed_solver, only: combine, reduced_work_t, solve_reduced
  use subspace_eigensolver, only: subspace_modes_t
  use vibration_models, only: by_dense, mode_request_t
  implicit none (type, external)
  private

  public :: solve_mesh, solve_long_mesh, solve_nodal

contains

  !> The mesh of the deck in deformation coordinates.
  subroutine solve_mesh(mechanism, model, state, request, factor, want_shapes, work, result)
    type(mechanism_t), intent(in) :: mechanism
    type(deformation_model_t), intent(in) :: model
    type(state_t), intent(in) :: state
    type(mode_request_t), intent(in) :: request
    real(wp), intent(in) :: factor(:, :)
    logical, intent(in) :: want_shapes(:)
    type(reduced_work_t), intent(inout) :: work
    type(position_result_t), intent(inout) :: result

    type(bordered_modes_t) :: found(size(factor, 2))
    type(chords_t) :: chords
    real(wp), allocatable :: unit_force(:, :, :), in_element(:, :, :)
    integer :: k

    call find_mesh_forces(mechanism, model, state, request%lumped, any(abs(factor) > 0.0_wp, &
      dim=2), unit_force, in_element)
    call solve_reduced(mechanism%linkage, model, state%pose, state%crank, unit_force, factor, &
      request%modes, want_shapes, work, chords, found, result%failure, result%counts)
    do k = 1, size(factor, 2)
      if (len(result%failure(k)%text) > 0) cycle
      call take_over(found(k)%lambda(:request%modes), found(k)%error(:request%modes), &
        result%lambda(:, k), result%error(:, k))
      if (.not. want_shapes(k)) cycle
      call sample_reduced(mechanism%linkage, model, chords, state, found(k), request, &
        result%shapes(k))
      result%counts%shapes = result%counts%shapes + request%modes
    end do
  end subroutine solve_mesh

  !> The mesh of the deck in deformation coordinates, when it is too long to be taken apart link by
  !! link: from the modes of a model that has continuous links in place of the long ones, and by
  !! running sums along them.
  subroutine solve_long_mesh(mechanism, near, state, request, factor, want_shapes, work, result)
    type(mechanism_t), intent(in) :: mechanism
    type(deformation_model_t), intent(in) :: near
    type(state_t), intent(in) :: state
    type(mode_request_t), intent(in) :: request
    real(wp), intent(in) :: factor(:, :)
    logical, intent(in) :: want_shapes(:)
    type(position_work_t), intent(inout) :: work
    type(position_result_t), intent(inout) :: result

    type(bordered_modes_t) :: start(size(factor, 2))
    type(bordered_matrix_t) :: least_geometric
    type(subspace_modes_t) :: found
    type(error_t), allocatable :: error
    real(wp), allocatable :: unit_force(:, :, :), in_element(:, :, :), total(:, :)
    integer :: elements, k
    logical :: loaded

    call find_mesh_forces(mechanism, near, state, request%lumped, any(abs(factor) > 0.0_wp, &
      dim=2), unit_force, in_element)
    call solve_reduced(mechanism%linkage, near, state%pose, state%crank, unit_force, factor, &
      request%modes, want_shapes, work%mesh, work%chain%chords, start, result%failure, &
      result%counts)
    do k = 1, size(factor, 2)
      if (len(result%failure(k)%text) > 0) cycle
      loaded = any(abs(factor(:, k)) > 0.0_wp)
      elements = merge(size(in_element, 2), 0, loaded)
      work%chain%axial_force = total_force(in_element(:, :elements, :), factor(:, k))
      if (loaded) call take_jumps(near, total_force(unit_force, factor(:, k)), work%chain)
      least_geometric = work%mesh%geometric
      if (loaded) then
        call combine(work%mesh, factor(:, k))
        total = total_force(unit_force, factor(:, k))
        call lower_to_mesh(mechanism, near, work%chain%axial_force, total)
        call reduced_geometric_stiffness(near%links, near%layout, work%chain%chords, total, &
          least_geometric)
      end if
      call find_chain_modes(near, work%mesh, loaded, least_geometric, start(k), request%modes, &
        want_shapes(k), work%chain, found, error)
      result%counts%operator_products = result%counts%operator_products + found%products
      result%counts%factorizations = result%counts%factorizations + 1
      if (allocated(error)) then
        result%failure(k)%text = error%message
        cycle
      end if
      call take_over(found%lambda(:request%modes), found%error(:request%modes), &
        result%lambda(:, k), result%error(:, k))
      if (.not. want_shapes(k)) cycle
      call sample_chain(mechanism%linkage, work%chain, state, found%vector, request, &
        result%shapes(k))
      result%counts%shapes = result%counts%shapes + request%modes
    end do
  end subroutine solve_long_mesh

  !> Gives a long mesh the jumps of its axial forces, which are those of the near model.
  pure subroutine take_jumps(near, force, chain)
    type(deformation_model_t), intent(in) :: near
    real(wp), intent(in) :: force(:, :) !! (force functions, bodies) [N]
    type(deformation_chain_t), intent(inout) :: chain

    integer :: b, n

    do b = 1, size(near%links)
      if (.not. near%links(b)%bends) cycle
      n = size(chain%links(b)%lump)
      associate (smooth => smooth_functions(near, b))
        chain%jump(:n, b) = force(smooth + 1:smooth + n, b)
      end associate
    end do
  end subroutine take_jumps

  !> Lowers the axial force of continuous links until it is nowhere above that of the mesh.
  pure subroutine lower_to_mesh(mechanism, near, in_element, force)
    type(mechanism_t), intent(in) :: mechanism
    type(deformation_model_t), intent(in) :: near
    real(wp), intent(in) :: in_element(:, :) !! (1, ξ, ξ²; elements)
    real(wp), intent(inout) :: force(:, :)   !! (force functions, bodies)

    real(wp) :: above, xi
    integer :: b, e, end_of, n

    do b = 1, size(near%links)
      if (near%lumped(b) .or. .not. near%links(b)%bends) cycle
      n = mechanism%mesh%elements(b)
      above = 0.0_wp
      do e = 1, n
        do end_of = 0, 1
          xi = real(e - 1 + end_of, wp)/n
          associate (of_mesh => in_element(:, mechanism%mesh%first_element(b) + e - 1))
            above = max(above, force(1, b) + xi*(force(2, b) + xi*force(3, b)) - &
              (of_mesh(1) + end_of*(of_mesh(2) + of_mesh(3))))
          end associate
        end do
      end do
      ! Between the ends of an element a parabola rises above its chord by so much at most.
      force(1, b) = force(1, b) - above - abs(force(3, b))/(4.0_wp*n**2)
    end do
  end subroutine lower_to_mesh

  !> The mesh of the deck in nodal displacements.
  !!
  !! Matrices are assembled once; the geometric stiffness is made of unit matrices, one for each of
  !! the unit loads that occur.
  subroutine solve_nodal(mechanism, state, request, factor, want_shapes, result)
    type(mechanism_t), intent(in) :: mechanism
    type(state_t), intent(in) :: state
    type(mode_request_t), intent(in) :: request
    real(wp), intent(in) :: factor(:, :)
    logical, intent(in) :: want_shapes(:)
    type(position_result_t), intent(inout) :: result

    type(band_matrix_t) :: stiffness, mass, total, unit_stiffness(case_count)
    type(load_case_t) :: cases(case_count)
    type(modes_t) :: found
    type(joint_forces_t) :: joints
    type(error_t), allocatable :: error
    real(wp) :: in_element(3, sum(mechanism%mesh%elements))
    integer :: b, i, k

    stiffness = assemble_stiffness(mechanism%linkage, mechanism%beams, mechanism%mesh, state%pose)
    mass = assemble_mass(mechanism%linkage, mechanism%mesh, state%pose)
    result%counts%stiffness_matrices = result%counts%stiffness_matrices + 1
    result%counts%mass_matrices = result%counts%mass_matrices + 1
    if (any(abs(factor) > 0.0_wp)) cases = unit_cases(mechanism%linkage, state%pose, &
      state%coefficients)
    do i = 1, case_count
      if (all(abs(factor(i, :)) <= 0.0_wp)) cycle
      call find_axial_forces(mechanism, state, cases(i), request%lumped, in_element, joints)
      unit_stiffness(i) = assemble_geometric_stiffness(mechanism%linkage, mechanism%mesh, &
        state%pose, in_element)
      do b = 1, size(mechanism%beams)
        call add_axial_jumps(mechanism%linkage, mechanism%mesh, state%pose, b, &
          axial_jumps(mechanism%linkage, b, state%pose, cases(i)%field), unit_stiffness(i))
      end do
      result%counts%geometric_matrices = result%counts%geometric_matrices + 1
    end do
    do k = 1, size(factor, 2)
      if (len(result%failure(k)%text) > 0) cycle
      total = stiffness
      do i = 1, case_count
        if (abs(factor(i, k)) > 0.0_wp) total%entry = total%entry + &
          factor(i, k)*unit_stiffness(i)%entry
      end do
      call find_modes(total, mass, request%modes, request%method == by_dense, &
        all(abs(factor(:, k)) <= 0.0_wp), round_off_error(mechanism%linkage, mechanism%beams, &
        mechanism%mesh), want_shapes(k), found, error)
      result%counts%factorizations = result%counts%factorizations + found%factorizations
      result%counts%full_solutions = result%counts%full_solutions + 1
      if (allocated(error)) then
        result%failure(k)%text = error%message
        cycle
      end if
      call take_over(found%lambda, 0.0_wp, result%lambda(:, k), result%error(:, k))
      if (.not. want_shapes(k)) cycle
      call sample_nodal(mechanism, state, found%vector, request, result%shapes(k))
      result%counts%shapes = result%counts%shapes + request%modes
    end do
  end subroutine solve_nodal

  !> Replaces what the continuous links gave by what the mesh gives; the difference is its error.
  elemental subroutine take_over(lambda_of_mesh, own_error, lambda, error)
    real(wp), intent(in) :: lambda_of_mesh, own_error !! eigenvalue of the mesh, relative error of
                                                      !! it
    real(wp), intent(inout) :: lambda, error

    real(wp) :: frequency, exact

    frequency = sign(sqrt(abs(lambda_of_mesh)), lambda_of_mesh)
    exact = sign(sqrt(abs(lambda)), lambda)
    error = (abs(frequency - exact) + error*abs(exact))/max(abs(frequency), tiny(frequency)) + &
      of_frequency*own_error
    lambda = lambda_of_mesh
  end subroutine take_over

  !> Axial forces of the unit loads, in the force functions of a model and element by element of the
  !! mesh.
  pure subroutine find_mesh_forces(mechanism, model, state, lumped, occurs, force, in_element)
    type(mechanism_t), intent(in) :: mechanism
    type(deformation_model_t), intent(in) :: model
    type(state_t), intent(in) :: state
    logical, intent(in) :: lumped                              !! masses on the nodes of the mesh,
                                                               !! or along the links
    logical, intent(in) :: occurs(case_count)                  !! unit loads that there are; without
                                                               !! any no functions, no elements
    real(wp), allocatable, intent(out) :: force(:, :, :)       !! (force functions with jumps,
                                                               !! bodies, cases) [N]
    real(wp), allocatable, intent(out) :: in_element(:, :, :)  !! (1, ξ, ξ²; elements; cases) [N]

    type(load_case_t) :: cases(case_count)
    type(joint_forces_t) :: joints
    real(wp), allocatable :: jump(:)
    integer :: b, i, first, functions, smooth

    functions = 0
    if (any(occurs)) functions = max(3, maxval(model%elements, mask=model%lumped)) + &
      most_jumps(mechanism%linkage)
    allocate (force(functions, size(model%links), case_count))
    allocate (in_element(3, merge(sum(mechanism%mesh%elements), 0, any(occurs)), case_count))
    force = 0.0_wp
    in_element = 0.0_wp
    if (.not. any(occurs)) return
    cases = unit_cases(mechanism%linkage, state%pose, state%coefficients, occurs)
    do i = 1, case_count
      if (.not. occurs(i)) cycle
      call find_axial_forces(mechanism, state, cases(i), lumped, in_element(:, :, i), joints)
      do b = 1, size(model%links)
        first = mechanism%mesh%first_element(b)
        if (.not. model%links(b)%bends) then
          force(1, b, i) = in_element(1, first, i)
          cycle
        end if
        smooth = smooth_functions(model, b)
        if (model%lumped(b)) then
          force(:smooth, b, i) = in_element(1, first:first + smooth - 1, i)
        else
          force(:smooth, b, i) = link_axial_force(mechanism%linkage, b, state%pose, &
            cases(i)%field, joints)
        end if
        jump = axial_jumps(mechanism%linkage, b, state%pose, cases(i)%field)
        force(smooth + 1:smooth + size(jump), b, i) = jump
      end do
    end do
  end subroutine find_mesh_forces

  !> Force functions of a body without the jumps, which follow them.
  pure function smooth_functions(model, body) result(number)
    type(deformation_model_t), intent(in) :: model
    integer, intent(in) :: body
    integer :: number

    number = merge(model%elements(body), 3, model%lumped(body))
  end function smooth_functions

  !> Axial forces in all elements under one of the unit loads; of a link that does not bend the
  !! mean, in its first element.
  pure subroutine find_axial_forces(mechanism, state, case, lumped, in_element, joints)
    type(mechanism_t), intent(in) :: mechanism
    type(state_t), intent(in) :: state
    type(load_case_t), intent(in) :: case
    logical, intent(in) :: lumped
    real(wp), intent(out) :: in_element(:, :) !! (1, ξ, ξ²; elements) [N]
    type(joint_forces_t), intent(out) :: joints

    type(load_t) :: loads(size(mechanism%linkage%bodies))
    real(wp) :: pin_loads(2, size(mechanism%linkage%pin_mass))
    integer :: elements(size(loads)), b

    associate (linkage => mechanism%linkage, mesh => mechanism%mesh)
      elements = 0
      if (lumped) elements = mechanism%load_elements
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
          state%pose, case%field, joints), 0.0_wp, 0.0_wp]
      end do
    end associate
  end subroutine find_axial_forces

end module mesh_solver
