!> Checks of a model that need mechanics; their messages point at the deck.
module deck_checks
  use balance_turn_checks, only: check_balance_turn
  use beam_mesh, only: moving_unknowns
  use change_point_checks, only: warn_of_change_points
  use column_checks, only: check_columns
  use deformation_shapes, only: bending_unknowns
  use diagnostics, only: add_error, add_warning, diagnostics_t, has_errors
  use drawing_checks, only: check_drawing
  use errors, only: error_of_reach
  use four_bar_loops, only: is_plain
  use four_bar_branches, only: refuse_format
  use four_bar_limits, only: crank_reach, reach_t
  use kinds, only: wp
  use linkage_checks, only: check_linkage
  use linkage_builder, only: assemble_linkage, assembly_t
  use loop_poses, only: has_loop
  use mechanisms, only: mechanism_of, mechanism_t
  use models, only: is_four_bar, model_t, needs_frequencies, pivots, report_number, &
    solver_band, solver_deformation, solver_dense, word_of_four_bar
  use report_kinds, only: four_bars
  use motion_checks, only: check_motion
  use nodal_eigensolver, only: most_round_off
  use plan_faults, only: report_problem
  use reach_checks, only: check_reach
  use reach_texts, only: longest_link, open_linkage_text
  use response_linkage_checks, only: check_turn
  use rest_eigenvalues, only: lowest_rest_eigenvalues
  use round_off, only: round_off_error
  use sorting, only: ascending_order
  use structures, only: elements_replaced, has_beams, has_mesh, structure_t
  use mode_requests, only: method_wanted
  use stop_drawings, only: check_drawn_stops
  use text, only: plural, to_string
  use tokens, only: token_t
  use vibration_models, only: by_link_modes, chosen_method, is_long_link, most_link_unknowns
  implicit none (type, external)
  private

  public :: check_mechanics

  !> Share of the distance of the ground pivots that the rounding of their coordinates may take.
  real(wp), parameter :: most_coordinate_error = 1.0e-10_wp

  !> Positions at which the lowest frequency is estimated to judge round-off.
  integer, parameter :: most_samples = 25

contains

  !> Whether the linkage closes, reaches every position, has as many unknowns as modes, and a mesh
  !! that keeps enough digits. Errors of the kind error_of_reach concern single positions, or all of
  !! them.
  subroutine check_mechanics(model, diagnostics)
    type(model_t), intent(in) :: model                !! without errors so far
    type(diagnostics_t), intent(inout) :: diagnostics !! to which errors and warnings are added

    type(mechanism_t) :: mechanism
    type(reach_t) :: reach
    type(assembly_t) :: assembly
    integer :: pivot(2), report, leaving

    call check_columns(model, diagnostics)
    call check_drawing(model, diagnostics)
    call assemble_linkage(model, assembly)
    if (allocated(assembly%problem)) then
      call report_problem(model, assembly, diagnostics)
      return
    end if
    mechanism = mechanism_of(model, assembly)
    call check_drawn_stops(model, mechanism, diagnostics)
    call warn_of_change_points(model, mechanism, diagnostics)
    call check_format(model, mechanism, diagnostics)
    if (.not. (is_four_bar(model) .and. mechanism%is_four_bar)) then
      call check_linkage(model, assembly, mechanism, diagnostics)
      if (.not. allocated(assembly%error)) call check_balance_turn(model, mechanism, diagnostics)
      call check_matrices(model, mechanism, diagnostics)
      return
    end if
    pivot = pivots(model)
    associate (ground => mechanism%four_bar%ground)
      if (norm2(ground(:, 2) - ground(:, 1)) <= 0.0_wp) then
        call add_error(diagnostics, model%grounds(pivot(2))%pin, &
          "the two ground pivots are at the same place", model%grounds(pivot(1))%pin, &
          "the other one is here")
        return
      end if
      if (epsilon(1.0_wp)*maxval(abs(ground)) > most_coordinate_error*norm2(ground(:, &
        2) - ground(:, 1))) then
        call add_warning(diagnostics, model%grounds(pivot(2))%pin, &
          "the ground pivots are so far from the origin that their distance "// &
          "has lost digits; put the origin nearer to them")
      end if
      reach = crank_reach(ground, mechanism%four_bar%length)
    end associate
    if (.not. reach%closes) then
      call report_open_linkage(model, mechanism, diagnostics)
      return
    end if
    call check_reach(model, mechanism, model%crank, leaving, diagnostics)
    report = report_number(model, "geometry")
    if (report > 0) call check_reach(model, mechanism, model%reports(report)%crank, leaving, &
      diagnostics)
    call check_turn(model, mechanism, diagnostics, reach)
    call check_balance_turn(model, mechanism, diagnostics)
    call check_motion(model, mechanism, reach, diagnostics)
    call check_matrices(model, mechanism, diagnostics)
  end subroutine check_mechanics

  !> Whether the linkage is a four-bar, where reports are written as of one, and one of three links
  !! where their equations know no more.
  subroutine check_format(model, mechanism, diagnostics)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(diagnostics_t), intent(inout) :: diagnostics

    integer :: i

    do i = 1, size(model%reports)
      associate (report => model%reports(i))
        if (report%kind%linkages /= four_bars .or. report%kind%name == "mesh") cycle
        if (.not. allocated(mechanism%four_bar)) then
          call refuse_format(diagnostics, word_of_four_bar(model))
          return
        end if
        if (report%kind%name == "balance" .and. .not. is_plain(mechanism%linkage) .or. &
          report%kind%name == "motion" .and. .not. has_loop(mechanism%linkage)) call &
          add_error(diagnostics, report%keyword, "REPORT "//trim(report%kind%name)//" as of a "// &
          "four-bar knows three links without masses at further pins; expected REPORT "// &
          trim(report%kind%name)//" format=linkage")
      end associate
    end do
  end subroutine check_format

  !> Whether a mesh of the deck has as many unknowns as modes, and keeps enough digits.
  subroutine check_matrices(model, mechanism, diagnostics)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(diagnostics_t), intent(inout) :: diagnostics

    if (.not. needs_frequencies(model) .or. .not. has_mesh(mechanism) .or. &
      .not. has_beams(mechanism)) return
    ! Where the program chooses the orders there are enough unknowns, and deformation coordinates
    ! lose no digits.
    if (mechanism%accuracy > 0.0_wp) return
    call check_unknowns(model, mechanism, diagnostics)
    call check_long_links(model, mechanism, diagnostics)
    if (has_errors(diagnostics)) return
    associate (mesh => mechanism%mesh)
      if (chosen_method(method_wanted(model), .false., mesh%elements, mesh%order, mesh%sheared) /= &
        by_link_modes) call check_round_off(model, mechanism, diagnostics)
    end associate
  end subroutine check_matrices

  !> One link is longer than all the others together.
  subroutine report_open_linkage(model, mechanism, diagnostics)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(diagnostics_t), intent(inout) :: diagnostics

    type(token_t) :: place
    integer :: longest, pivot(2)

    longest = longest_link(mechanism)
    pivot = pivots(model)
    place = model%grounds(pivot(2))%pin
    if (longest > 0) place = model%links(mechanism%links(longest))%length_word
    call add_error(diagnostics, place, open_linkage_text(mechanism), kind=error_of_reach)
  end subroutine report_open_linkage

  !> Refuses more modes than the mesh has unknowns, or than SOLVER band finds of them.
  subroutine check_unknowns(model, mechanism, diagnostics)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(diagnostics_t), intent(inout) :: diagnostics

    type(token_t) :: place
    integer :: most

    most = moving_unknowns(mechanism%mesh, mechanism%linkage)
    place = model%modes_word
    if (place%line == 0) place = model%meshes(1)%keyword
    if (model%modes > most) then
      call add_error(diagnostics, place, plural(model%modes, "mode")// &
        " asked for, but the mesh has only "// &
        plural(most, trim(merge("unknown       ", "moving unknown", &
        most == mechanism%mesh%unknowns))))
    else if (model%modes > mechanism%mesh%unknowns - 2 .and. model%solver == solver_band) then
      call add_error(diagnostics, place, "SOLVER band finds at most "// &
        plural(mechanism%mesh%unknowns - 2, "mode")// &
        " of this mesh (two fewer than its unknowns), not "//to_string(model%modes))
    end if
  end subroutine check_unknowns

  !> Refuses links with too many unknowns for own modes where these are asked for, or where band
  !! matrices cannot take their place.
  subroutine check_long_links(model, mechanism, diagnostics)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(diagnostics_t), intent(inout) :: diagnostics

    character(len=:), allocatable :: instead
    logical :: has_band
    integer :: body

    if (any(model%solver == [solver_dense, solver_band])) return
    has_band = .not. any(model%links%rigid) .and. all(model%links%material > 0)
    if (has_band) has_band = .not. any(model%materials(model%links%material)%is_massless)
    if (has_band .and. model%solver /= solver_deformation) return
    instead = ""
    if (has_band) instead = ", SOLVER band"
    associate (mesh => mechanism%mesh)
      body = findloc(is_long_link(mesh%elements, mesh%order, mesh%sheared), .true., dim=1)
      if (body == 0) return
      call add_error(diagnostics, model%meshes(model%links(mechanism%links(body))%mesh)%keyword, &
        "link '"//mechanism%names(body)%text//"' has too many unknowns on this mesh: "// &
        to_string(mesh%elements(body)*bending_unknowns(mesh%order(body), mesh%sheared))// &
        ", and links are decomposed into own modes up to "//to_string(most_link_unknowns)// &
        "; expected fewer elements"//instead//", or 'accuracy=' in place of 'elements='")
    end associate
  end subroutine check_long_links

  !> Refuses a mesh so fine that the rounding of its matrices spoils the lowest frequencies.
  !!
  !! The bound is `ε‖K_e‖/(λ‖M_e‖)`, at the median of the positions: one position near a dead point
  !! affects its own row only.
  subroutine check_round_off(model, mechanism, diagnostics)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(diagnostics_t), intent(inout) :: diagnostics

    real(wp), allocatable :: lambda(:)
    real(wp) :: bound
    character(len=:), allocatable :: fault, amount
    integer :: i, body, samples

    samples = min(size(model%crank%value), most_samples)
    lambda = lowest_rest_eigenvalues(mechanism%structure_t, &
      [(model%crank%value(1 + ((i - 1)*(size(model%crank%value) - 1))/max(1, samples - 1)), i=1, &
      samples)])
    lambda = lambda(ascending_order(lambda))
    do body = 1, size(mechanism%beams)
      bound = bound_of(mechanism%structure_t, body, lambda((samples + 1)/2))
      if (bound <= most_round_off) cycle
      if (bound_of(elements_replaced(mechanism%structure_t, spread(1, 1, size(mechanism%beams))), &
        body, lambda((samples + 1)/2)) <= most_round_off) then
        fault = "this mesh is too fine for double precision: use fewer elements, "// &
          "or 'accuracy=' in place of 'elements='"
      else
        fault = "link '"//mechanism%names(body)%text//"' is too slender for double precision"
      end if
      amount = "more than 1000"
      if (bound < 1.0e3_wp) amount = to_string(bound, 2)
      call add_error(diagnostics, model%meshes(model%links(mechanism%links(body))%mesh)%keyword, &
        fault//"; round-off in '"//mechanism%names(body)%text//"' may reach "//amount// &
        " times the lowest eigenvalue, and the limit is "//to_string(most_round_off))
    end do
  end subroutine check_round_off

  !> `ε‖K_e‖/(λ‖M_e‖)` of a body's elements.
  pure function bound_of(structure, body, lambda) result(bound)
    type(structure_t), intent(in) :: structure
    integer, intent(in) :: body
    real(wp), intent(in) :: lambda !! [1/s²]
    real(wp) :: bound

    bound = round_off_error(structure%linkage, structure%beams, structure%mesh, body)/max(lambda, &
      sqrt(tiny(lambda)))
  end function bound_of

end module deck_checks
