!> Frequencies of the instantaneous structure at one position, for all speeds, each with its
!! estimated error.
module position_solver
  use axial_forces, only: total_force
  use bordered_eigensolver, only: bordered_modes_t
  use bordered_pencil, only: elastic_squares
  use damped_frequencies, only: modes_for_dampers, solve_damped_speed
  use elastic_linkages, only: elastic_linkage_t, is_piece
  use errors, only: outcome_t
  use kinds, only: wp
  use link_modes, only: stations
  use load_cases, only: case_count
  use load_sizes, only: axial_sizes, second_order_work
  use massless_links, only: refuse_missing_modes
  use matrix_rounding, only: find_matrix_errors
  use mesh_solver, only: solve_mesh
  use mixed_positions, only: displacements_of, find_mixed_prints, largest_work, modes_on_border
  use mode_prints, only: prints_of
  use nodal_solver, only: solve_nodal
  use order_errors, only: order_error, with_modes_above
  use pin_displacements, only: chords_t
  use pose_rounding, only: pose_error
  use position_assembly, only: assemble_position, assembled_t, new_assembled
  use position_results, only: frequency_error, largest_error, position_result_t, position_work_t
  use positions, only: state_t
  use reduced_deflections, only: reduced_deflection
  use shape_samples, only: sample_reduced
  use speed_solver, only: new_speed_work, solve_speeds
  use structures, only: structure_t
  use vibration_models, only: by_band, by_dense, by_link_modes, by_orders, &
    load_factors, mode_request_t, vibration_models_t
  implicit none (type, external)
  private

  public :: new_position_work, solve_position

contains

  !> Work space for the positions of a block; no modes are remembered yet.
  pure function new_position_work(structure, models, request) result(work)
    type(structure_t), intent(in) :: structure     !! with beams
    type(vibration_models_t), intent(in) :: models !! to be solved
    type(mode_request_t), intent(in) :: request    !! method and speeds
    type(position_work_t) :: work

    work%here = new_assembled(structure, models%continuum)
    work%continuum = new_speed_work(models%continuum, size(request%speed), request%accuracy)
    if (request%method == by_link_modes) work%mesh = new_speed_work(models%mesh, &
      size(request%speed))
  end function new_position_work

  !> Solves Ulker 2010 (2.88) at a pose for every speed, with or without the axial forces of the
  !! loads.
  !!
  !! The structure with continuous links is always solved, to the accuracy of `models`. If the deck
  !! has a mesh of its own, that is solved as well and its frequencies are the result; their error
  !! includes the difference to the continuous links.
  !!
  !! Errors, speed by speed in `result%outcome`: a link is compressed by more than its shear
  !! stiffness, a solver does not converge, or a mode may be missing.
  subroutine solve_position(structure, models, state, request, want_shapes, work, result)
    type(structure_t), intent(in) :: structure     !! with a mesh unless the method is `by_orders`
    type(vibration_models_t), intent(in) :: models !! of this structure
    type(state_t), intent(in) :: state             !! with a pose
    type(mode_request_t), intent(in) :: request    !! modes, method, speeds, loads
    logical, intent(in) :: want_shapes(:)          !! (speeds)
    type(position_work_t), intent(inout) :: work   !! from the positions before
    type(position_result_t), intent(out) :: result !! for all speeds

    integer :: n

    n = size(request%speed)
    allocate (result%lambda(request%modes, n), result%error(request%modes, n), result%outcome(n), &
      result%shapes(n))
    allocate (result%deflection(size(structure%beams), n))
    result%lambda = 0.0_wp
    result%error = 0.0_wp
    if (size(structure%elastic%dampers) > 0) allocate (result%damping(request%modes, n), &
      source=0.0_wp)
    result%deflection = 0.0_wp
    allocate (result%cause(n))
    result%cause = 0
    work%factor = load_factors(request)
    call assemble_position(structure, models%continuum, state, work%factor, &
      work%continuum%equations, work%here, result%outcome, result%counts)
    if (all_failed(result%outcome)) return
    ! The basis of the border has turned: modes of the last positions are in another one.
    if (allocated(work%here%border)) then
      if (work%here%border%is_new) work%continuum%tracks%length = 0
    end if
    call solve_assembled(structure, models, state, request, want_shapes, work, result)
  end subroutine solve_position

  !> Whether there are errors at all speeds.
  pure function all_failed(outcome)
    type(outcome_t), intent(in) :: outcome(:)
    logical :: all_failed

    integer :: k

    all_failed = .true.
    do k = 1, size(outcome)
      all_failed = all_failed .and. allocated(outcome(k)%error)
    end do
  end function all_failed

  !> Solves a position that is assembled.
  subroutine solve_assembled(structure, models, state, request, want_shapes, work, result)
    type(structure_t), intent(in) :: structure
    type(vibration_models_t), intent(in) :: models
    type(state_t), intent(in) :: state
    type(mode_request_t), intent(in) :: request
    logical, intent(in) :: want_shapes(:)
    type(position_work_t), intent(inout) :: work
    type(position_result_t), intent(inout) :: result

    type(bordered_modes_t) :: modes
    logical :: is_damped
    integer :: k, n, wanted

    n = size(request%speed)
    is_damped = size(structure%elastic%dampers) > 0
    wanted = modes_for_dampers(structure, work%here%model, request%modes)
    call refuse_missing_modes(work%here%elastic%linkage%bodies, work%continuum%equations, &
      work%here%model%layout, wanted, result%outcome)
    call solve_speeds(state%crank, work%factor, wanted, want_shapes .and. request%method == &
      by_orders .or. is_damped, work%continuum, result%outcome, result%counts, work%here%mixed)
    if (request%follow) allocate (result%prints(n))
    associate (here => work%here, equations => work%continuum%equations, &
        found => work%continuum%found)
      if (size(here%unit_force) > 0) then
        if (allocated(here%mixed)) equations%chords = displacements_of(here%mixed%form, &
          here%elastic_position_t, here%mixed%solution)
        call find_deflection(equations%chords, here, work%factor, result%deflection)
      end if
      do k = 1, n
        if (allocated(result%outcome(k)%error)) cycle
        if (allocated(here%mixed)) then
          call modes_on_border(here%mixed, here%elastic_position_t, found(k), equations%chords, &
            equations%pencil%mass%border, modes)
          call finish_speed(structure, state, request, k, modes, work, result)
          call keep_speed(request, k, want_shapes(k), modes, work, result)
          if (request%follow) call find_mixed_prints(here%mixed, here%model%links, found(k), &
            request%modes, result%prints(k))
        else
          if (is_damped) then
            call solve_damped_speed(structure, state, request, k, work, result)
          else
            call finish_speed(structure, state, request, k, found(k), work, result)
          end if
          call keep_speed(request, k, want_shapes(k), found(k), work, result)
          if (request%follow) result%prints(k) = prints_of(here%model, equations%chords, &
            found(k), request%modes)
        end if
      end do
    end associate
    select case (request%method)
    case (by_link_modes)
      call solve_mesh(structure, models%mesh, state, work%here%loads, request, want_shapes, &
        work%mesh, result)
    case (by_dense, by_band)
      call solve_nodal(structure, state, work%here%loads, request, work%factor, want_shapes, result)
    end select
  end subroutine solve_assembled

  !> Takes the modes of a speed, with their errors.
  subroutine finish_speed(structure, state, request, k, found, work, result)
    type(structure_t), intent(in) :: structure
    type(state_t), intent(in) :: state
    type(mode_request_t), intent(in) :: request
    integer, intent(in) :: k                        !! number of the speed
    type(bordered_modes_t), intent(in) :: found     !! in unknowns of a border and own modes
    type(position_work_t), intent(in) :: work
    type(position_result_t), intent(inout) :: result

    real(wp), dimension(request%modes) :: discretisation, rounding, of_matrices, load_work

    associate (equations => work%continuum%equations, here => work%here, &
        model => work%here%model, factor => work%factor(:, k))
      discretisation = with_modes_above(found%lambda, sum(order_error(model, equations, &
        total_force(here%unit_force, factor), found, found%near), dim=1), request%modes, &
        found%zeros)
      result%order_error = max(result%order_error, maxval(discretisation))
      result%lambda(:, k) = found%lambda(:request%modes)
      call find_matrix_errors(model, equations%chords, axial_sizes(here, factor), found, &
        request%modes, of_matrices, load_work)
      if (allocated(here%mixed)) then
        load_work = load_work + largest_work(here%mixed, factor, work%continuum%found(k), &
          request%modes)
      else
        load_work = load_work + second_order_work(here, factor, found, request%modes)
      end if
      call pose_error(structure, state, k, work, load_work, found, rounding, result%counts)
      of_matrices = of_matrices + found%error(:request%modes)
      result%error(:, k) = frequency_error(discretisation + (rounding + of_matrices))
      if (maxval(result%error(:, k)) > request%accuracy) result%cause(k) = &
        largest_error(discretisation, rounding, of_matrices, elastic_squares(model%layout, &
        found%vector(:, :request%modes)), found%lambda(:request%modes))
    end associate
  end subroutine finish_speed

  !> Keeps the shapes of the modes of a speed, if they are asked for.
  subroutine keep_speed(request, k, want_shapes, found, work, result)
    type(mode_request_t), intent(in) :: request
    integer, intent(in) :: k                        !! number of the speed
    logical, intent(in) :: want_shapes
    type(bordered_modes_t), intent(in) :: found
    type(position_work_t), intent(in) :: work
    type(position_result_t), intent(inout) :: result

    if (.not. want_shapes .or. request%method /= by_orders) return
    associate (here => work%here)
      call sample_reduced(here%elastic%linkage, here%model, work%continuum%equations%chords, &
        here%pose, found, request, result%shapes(k), here%elastic)
    end associate
    result%counts%shapes = result%counts%shapes + request%modes
  end subroutine keep_speed

  !> Largest static deflection of every link / its length, or that of one of its ways, at every
  !! speed.
  subroutine find_deflection(chords, here, factor, ratio)
    type(chords_t), intent(in) :: chords   !! at this position
    type(assembled_t), intent(in) :: here  !! with loads
    real(wp), intent(in) :: factor(:, :)   !! (cases, speeds) of the unit loads
    real(wp), intent(out) :: ratio(:, :)   !! (bodies, speeds) [-]

    real(wp) :: unit(2, stations, size(here%elastic%body), case_count), displacement(2), squared
    integer :: b, i, j, k

    unit = 0.0_wp
    do i = 1, case_count
      if (.not. here%loads%occurs(i)) cycle
      call reduced_deflection(here%elastic%linkage, here%model%links, chords, here%pose, &
        here%loaded%loads%unit%of_case(i), here%loaded%forces%border(:, i), unit(:, :, :, i))
    end do
    ratio = 0.0_wp
    do k = 1, size(factor, 2)
      do b = 1, size(here%elastic%body)
        squared = 0.0_wp
        do i = 1, stations
          displacement = factor(1, k)*unit(:, i, b, 1)
          do j = 2, case_count
            displacement = displacement + factor(j, k)*unit(:, i, b, j)
          end do
          squared = max(squared, sum(displacement**2))
        end do
        associate (share => ratio(here%elastic%body(b), k))
          share = max(share, sqrt(squared)/length_of(here%elastic, b))
        end associate
      end do
    end do
  end subroutine find_deflection

  !> The length of a part, of a piece that of its whole way [m].
  pure function length_of(elastic, part) result(length)
    type(elastic_linkage_t), intent(in) :: elastic
    integer, intent(in) :: part
    real(wp) :: length

    length = elastic%linkage%bodies(part)%length
    if (is_piece(elastic, part)) length = elastic%ways(elastic%way(part))%length
  end function length_of

end module position_solver
