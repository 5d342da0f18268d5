!> Studies of the rigid linkage: kinematics, forces, balance, limits.
module rigid_studies
  use body_attachments, only: body_point_t
  use balance_requests, only: balance_request_of
  use balance_study, only: balance_request_t, find_balance
  use coordinates_report, only: find_lost_coordinate
  use drive_motions, only: drive_rates
  use equilibrium_study, only: find_equilibria
  use errors, only: error_of_input, error_of_numerics, error_t, set_error
  use friction_study, only: find_joint_friction
  use geometry_study, only: find_geometry
  use harmonics_study, only: find_harmonics, has_settled
  use inertia_study, only: find_inertia_loads
  use joint_study, only: drives_at_speed, find_joints
  use joints_report, only: open_words
  use kinds, only: wp
  use lagrange_study, only: find_lagrange_terms
  use limits_study, only: find_branches, find_limits
  use models, only: balances, has_law, is_of_four_bar, model_t, report_number, report_with, &
    runs_in_time
  use named_coordinates, only: limited_coordinates
  use named_parts, only: name_outcomes
  use points_study, only: find_points
  use position_loads, only: elastic_division_t, fail_everywhere, find_division, take_failures
  use report_kinds, only: four_bars
  use run_findings, only: findings_t
  use run_totals, only: run_totals_t, widen
  use sizing_requests, only: sizing_request_of
  use sizing_study, only: find_sizing
  use study_findings, only: note_at_position, note_failure, note_warning
  use study_types, only: add_study, study_t, variant_run_t
  use text, only: to_string
  use variant_results, only: variant_results_t
  use warnings, only: warning_t
  implicit none (type, external)
  private

  public :: add_rigid_studies, places_of

  !> Harmonics that have not settled are told of by a warning beyond this change; below, by the head
  !! of their table only [-].
  real(wp), parameter :: least_warned = 1.0e-8_wp

contains

  !> Appends the studies of this file.
  subroutine add_rigid_studies(list)
    type(study_t), allocatable, intent(inout) :: list(:) !! to which they are appended

    call add_study(list, study_t("geometry", compute=compute_geometry, &
      add_failures=add_geometry_failures, add_work=add_geometry_work))
    call add_study(list, study_t("inertia", compute=compute_inertia))
    call add_study(list, study_t("points", compute=compute_points))
    call add_study(list, study_t("coordinates", add_failures_at=add_lost_coordinates))
    call add_study(list, study_t("joints", compute=compute_joints, &
      add_failures_at=add_open_joints, add_work=add_torque_range))
    call add_study(list, study_t("friction", compute=compute_friction))
    call add_study(list, study_t("lagrange", compute=compute_lagrange))
    call add_study(list, study_t("balance", compute=compute_balance, &
      add_failures=add_balance_failures))
    call add_study(list, study_t("harmonics", compute=compute_harmonics, &
      add_failures=add_harmonics_failures, add_warnings=add_harmonics_warnings, &
      add_work=add_harmonics_work))
    call add_study(list, study_t("limits", compute=compute_limits))
    call add_study(list, study_t("sizing", compute=compute_sizing, &
      add_failures=add_sizing_failures))
    call add_study(list, study_t("equilibrium", compute=compute_equilibrium))
  end subroutine add_rigid_studies

  subroutine compute_geometry(run)
    type(variant_run_t), intent(inout), target :: run

    associate (model => run%results%model, mechanism => run%results%mechanism, &
        points => run%results%mechanism%points, geometry => run%results%found%geometry)
      call find_geometry(mechanism%linkage, points%body, places_of(points), &
        model%reports(report_number(model, "geometry"))%crank%value, run%threads, geometry)
      call name_outcomes(run%results, geometry%outcome)
    end associate
  end subroutine compute_geometry

  subroutine compute_points(run)
    type(variant_run_t), intent(inout), target :: run

    associate (mechanism => run%results%mechanism, points => run%results%mechanism%points, &
        found => run%results%found)
      call find_points(mechanism%linkage, points%body, places_of(points), found%positions, &
        run%threads, found%points)
    end associate
  end subroutine compute_points

  !> Places of points, from the first pins of their bodies, in their axes [m].
  pure function places_of(points) result(places)
    type(body_point_t), intent(in) :: points(:) !! of the deck
    real(wp) :: places(2, size(points))

    integer :: i

    do i = 1, size(points)
      places(:, i) = points(i)%place
    end do
  end function places_of

  subroutine compute_inertia(run)
    type(variant_run_t), intent(inout), target :: run

    associate (mechanism => run%results%mechanism, found => run%results%found)
      call find_inertia_loads(mechanism%linkage, mechanism%load_elements, found%positions, &
        run%threads, found%inertia)
    end associate
  end subroutine compute_inertia

  subroutine compute_joints(run)
    type(variant_run_t), intent(inout), target :: run

    real(wp), allocatable :: speeds(:, :), accelerations(:, :)
    type(elastic_division_t), allocatable :: division

    call find_rates(run%results, speeds, accelerations)
    call find_division_of(run%results, division)
    associate (mechanism => run%results%mechanism, found => run%results%found)
      call find_joints(mechanism%linkage, mechanism%load_elements, found%positions, run%threads, &
        found%joints, speeds, accelerations, division)
      call take_failures(found%joints%outcome, found%positions)
    end associate
  end subroutine compute_joints

  subroutine compute_friction(run)
    type(variant_run_t), intent(inout), target :: run

    real(wp), allocatable :: speeds(:, :), accelerations(:, :)
    type(elastic_division_t), allocatable :: division

    call find_rates(run%results, speeds, accelerations)
    call find_division_of(run%results, division)
    associate (mechanism => run%results%mechanism, found => run%results%found)
      call find_joint_friction(mechanism%linkage, mechanism%load_elements, found%positions, &
        run%threads, speeds, accelerations, found%friction, division)
      call take_failures(found%friction%outcome, found%positions)
    end associate
  end subroutine compute_friction

  subroutine compute_lagrange(run)
    type(variant_run_t), intent(inout), target :: run

    real(wp), allocatable :: speeds(:, :), accelerations(:, :)
    type(elastic_division_t), allocatable :: division

    call find_rates(run%results, speeds, accelerations)
    call find_division_of(run%results, division)
    associate (mechanism => run%results%mechanism, found => run%results%found)
      call find_lagrange_terms(mechanism%linkage, mechanism%load_elements, found%positions, &
        run%threads, found%lagrange, speeds, accelerations, division)
      call take_failures(found%lagrange%outcome, found%positions)
    end associate
  end subroutine compute_lagrange

  subroutine compute_balance(run)
    type(variant_run_t), intent(inout), target :: run

    real(wp), allocatable :: speeds(:, :), accelerations(:, :)
    type(balance_request_t), allocatable :: request !! absent: to cancel the shaking force

    call find_rates(run%results, speeds, accelerations)
    associate (model => run%results%model, mechanism => run%results%mechanism, &
        found => run%results%found)
      if (balances(model)) allocate (request, source=balance_request_of(model, mechanism))
      call find_balance(mechanism%linkage, mechanism%load_elements, found%positions, run%threads, &
        found%balance, request, speeds, accelerations)
    end associate
  end subroutine compute_balance

  subroutine compute_harmonics(run)
    type(variant_run_t), intent(inout), target :: run

    associate (model => run%results%model, mechanism => run%results%mechanism, &
        found => run%results%found)
      if (allocated(found%balance%partial)) then
        call find_harmonics(mechanism%linkage, mechanism%load_elements, model%speed%value, &
          model%acceleration, run%threads, found%harmonics, found%balance%partial%linkage)
      else
        call find_harmonics(mechanism%linkage, mechanism%load_elements, model%speed%value, &
          model%acceleration, run%threads, found%harmonics)
      end if
    end associate
  end subroutine compute_harmonics

  !> As of four-bars on both branches, else on the one that the deck has, of coordinates too.
  subroutine compute_limits(run)
    type(variant_run_t), intent(inout), target :: run

    associate (model => run%results%model, mechanism => run%results%mechanism, &
        found => run%results%found)
      if (is_of_four_bar(model, "linkage")) then
        call find_branches(mechanism%linkage, mechanism%four_bar, found%branches)
      else
        call find_limits(mechanism%linkage, positions_of_deck(model), found%limits, &
          limited_coordinates(model))
      end if
    end associate
  end subroutine compute_limits

  subroutine compute_sizing(run)
    type(variant_run_t), intent(inout), target :: run

    type(elastic_division_t), allocatable :: division !! absent: statics tells the forces

    associate (mechanism => run%results%mechanism, sizing => run%results%found%sizing)
      if (has_law(run%results%model)) then
        call find_division(mechanism%structure_t, division, sizing%error, &
          run%results%model%crank%value)
      else
        call find_division(mechanism%structure_t, division, sizing%error)
      end if
      if (allocated(sizing%error)) return
      call find_sizing(mechanism%linkage, mechanism%load_elements, &
        sizing_request_of(run%results%model), run%threads, sizing, division)
    end associate
  end subroutine compute_sizing

  subroutine compute_equilibrium(run)
    type(variant_run_t), intent(inout), target :: run

    associate (mechanism => run%results%mechanism)
      call find_equilibria(mechanism%linkage, mechanism%load_elements, &
        positions_of_deck(run%results%model), run%results%found%equilibria)
    end associate
  end subroutine compute_equilibrium

  !> Speeds and accelerations of the drive at all states; a law has one for every instant.
  subroutine find_rates(variant, speeds, accelerations)
    type(variant_results_t), intent(in) :: variant !! with positions
    real(wp), allocatable, intent(out) :: speeds(:, :), accelerations(:, :) !! (speeds, states)

    associate (model => variant%model, states => variant%found%positions%states)
      if (runs_in_time(model)) then
        allocate (speeds(1, size(states)), accelerations(1, size(states)))
        speeds = 1.0_wp
        accelerations = 0.0_wp
      else if (has_law(model)) then
        speeds = model%law_rates(1:1, :)
        accelerations = model%law_rates(2:2, :)
      else
        speeds = spread(model%speed%value, 2, size(states))
        allocate (accelerations, mold=speeds)
        accelerations = model%acceleration
      end if
    end associate
  end subroutine find_rates

  !> How elasticity divides forces, where it does.
  subroutine find_division_of(variant, division)
    type(variant_results_t), intent(inout) :: variant !! with positions, which fail if it fails
    type(elastic_division_t), allocatable, intent(out) :: division !! absent: statics is enough

    type(error_t), allocatable :: failure

    call find_division(variant%mechanism%structure_t, division, failure, &
      variant%found%positions%states%crank)
    if (allocated(failure)) call fail_everywhere(failure, variant%found%positions)
  end subroutine find_division_of

  !> Positions of the first drive that the deck names: on CRANK, or at the start of a motion.
  pure function positions_of_deck(model) result(positions)
    type(model_t), intent(in) :: model
    real(wp), allocatable :: positions(:) !! [deg] or [m]

    integer :: number

    positions = model%crank%value
    number = report_number(model, "motion")
    if (number > 0) positions = [positions, model%reports(number)%start_angle]
  end function positions_of_deck

  pure subroutine add_geometry_failures(variant, findings)
    type(variant_results_t), intent(in) :: variant
    type(findings_t), intent(inout) :: findings

    integer :: i

    associate (geometry => variant%found%geometry)
      if (.not. allocated(geometry%outcome)) return
      do i = 1, size(geometry%crank)
        if (.not. allocated(geometry%outcome(i)%error)) cycle
        if (runs_in_time(variant%model)) then
          call note_failure(variant, "position", geometry%outcome(i)%error, findings, &
            time=geometry%crank(i))
        else
          call note_failure(variant, "position", geometry%outcome(i)%error, findings, &
            crank=geometry%crank(i))
        end if
      end do
    end associate
  end subroutine add_geometry_failures

  pure subroutine add_geometry_work(variant, totals)
    type(variant_results_t), intent(in) :: variant
    type(run_totals_t), intent(inout) :: totals

    if (allocated(variant%found%geometry%crank)) totals%kinematic_solutions = &
      totals%kinematic_solutions + size(variant%found%geometry%crank)
  end subroutine add_geometry_work

  !> A position at which rigid links alone hold each other, and some forces are open.
  pure subroutine add_open_joints(variant, position, findings)
    type(variant_results_t), intent(in) :: variant
    integer, intent(in) :: position
    type(findings_t), intent(inout) :: findings

    type(error_t), allocatable :: error
    integer :: i

    if (max(report_number(variant%model, "reactions"), report_number(variant%model, &
      "bearings")) == 0) return
    associate (joints => variant%found%joints)
      if (.not. allocated(joints%is_open)) return
      i = findloc(joints%is_open(:, variant%found%positions%state(position)), .true., dim=1)
      if (i == 0) return
      call set_error(error, error_of_input, open_words(variant, joints%joints(i)))
      call note_at_position(variant, position, error, findings)
    end associate
  end subroutine add_open_joints

  !> A position at which a coordinate has no rate, or nothing a ratio.
  pure subroutine add_lost_coordinates(variant, position, findings)
    type(variant_results_t), intent(in) :: variant
    integer, intent(in) :: position
    type(findings_t), intent(inout) :: findings

    type(error_t), allocatable :: error
    character(len=:), allocatable :: words

    if (report_with(variant%model, "coordinates") == 0) return
    words = find_lost_coordinate(variant, position)
    if (len(words) == 0) return
    call set_error(error, error_of_numerics, words)
    call note_at_position(variant, position, error, findings)
  end subroutine add_lost_coordinates

  pure subroutine add_balance_failures(variant, findings)
    type(variant_results_t), intent(in) :: variant
    type(findings_t), intent(inout) :: findings

    associate (balance => variant%found%balance)
      if (.not. allocated(balance%partial)) return
      if (allocated(balance%partial%error)) call note_failure(variant, "variant", &
        balance%partial%error, findings)
    end associate
  end subroutine add_balance_failures

  pure subroutine add_harmonics_failures(variant, findings)
    type(variant_results_t), intent(in) :: variant
    type(findings_t), intent(inout) :: findings

    associate (harmonics => variant%found%harmonics)
      if (allocated(harmonics%error)) call note_failure(variant, "position", harmonics%error, &
        findings, crank=harmonics%error_crank)
    end associate
  end subroutine add_harmonics_failures

  !> Harmonics that even the largest number of samples does not settle.
  pure subroutine add_harmonics_warnings(variant, findings)
    type(variant_results_t), intent(in) :: variant
    type(findings_t), intent(inout) :: findings

    type(warning_t) :: warning

    associate (harmonics => variant%found%harmonics)
      if (has_settled(harmonics) .or. harmonics%change <= least_warned) return
      warning%amount = harmonics%change
      warning%text = "harmonics have not converged: with every second one of "// &
        to_string(harmonics%samples)//" samples they differ by "//to_string(harmonics%change, 2)// &
        " of the largest value; the crank passes close to a dead point, or the shaking force "// &
        "through zero"
    end associate
    call note_warning(variant, "harmonics", warning, findings)
  end subroutine add_harmonics_warnings

  pure subroutine add_harmonics_work(variant, totals)
    type(variant_results_t), intent(in) :: variant
    type(run_totals_t), intent(inout) :: totals

    totals%kinematic_solutions = totals%kinematic_solutions + variant%found%harmonics%solutions
  end subroutine add_harmonics_work

  pure subroutine add_sizing_failures(variant, findings)
    type(variant_results_t), intent(in) :: variant
    type(findings_t), intent(inout) :: findings

    type(error_t), allocatable :: error
    integer :: i

    associate (sizing => variant%found%sizing)
      if (allocated(sizing%error)) then
        if (sizing%period > 0.0_wp .and. has_law(variant%model)) then
          call note_failure(variant, "position", sizing%error, findings, time=sizing%error_crank)
        else if (sizing%period > 0.0_wp) then
          call note_failure(variant, "position", sizing%error, findings, crank=sizing%error_crank)
        else
          call note_failure(variant, "variant", sizing%error, findings)
        end if
      end if
      if (.not. allocated(sizing%is_open)) return
      i = findloc(sizing%is_open, .true., dim=1)
      if (i == 0) return
      call set_error(error, error_of_input, open_words(variant, sizing%joints(i)))
      call note_failure(variant, "variant", error, findings)
    end associate
  end subroutine add_sizing_failures

  !> The driving torque of a four-bar at all positions and speeds, where tables have it.
  pure subroutine add_torque_range(variant, totals)
    type(variant_results_t), intent(in) :: variant
    type(run_totals_t), intent(inout) :: totals

    real(wp), allocatable :: drives(:, :)
    real(wp) :: rates(2)
    integer :: i, k, state

    associate (found => variant%found, kinds => variant%model%reports%kind)
      if (.not. (variant%mechanism%is_four_bar .and. allocated(found%joints%drive))) return
      if (.not. any(kinds%linkages == four_bars .and. index(kinds%studies, "joints") > 0 .or. &
        index(kinds%name, "summary") > 0 .and. index(kinds%studies, "joints") > 0)) return
      do i = 1, size(found%positions%crank)
        state = found%positions%state(i)
        if (allocated(found%positions%states(state)%error)) cycle
        do k = 1, size(variant%model%speed%value)
          rates = drive_rates(variant%model, k, i)
          drives = drives_at_speed(variant%mechanism%linkage, found%joints, &
            found%positions%states(state), state, found%positions%crank(i), rates(1), rates(2), k)
          call widen(totals%torque, drives(3, 1))
        end do
      end do
    end associate
  end subroutine add_torque_range

end module rigid_studies
