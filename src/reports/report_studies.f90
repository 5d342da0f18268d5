!> The studies of rigid linkages that are made in one piece, by name.
module report_studies
  use balance_requests, only: balance_request_of
  use balance_study, only: balance_request_t, find_balance, find_hung_balance
  use equilibrium_study, only: find_equilibria
  use errors, only: error_t
  use friction_study, only: find_joint_friction
  use geometry_study, only: find_geometry
  use harmonics_study, only: find_harmonics
  use inertia_study, only: find_inertia_loads
  use joint_study, only: find_joints
  use kinds, only: wp
  use kinematics_study, only: find_kinematics
  use lagrange_study, only: find_lagrange_terms
  use limits_study, only: find_limits
  use linkage_study, only: find_linkage
  use models, only: balances, has_law, model_t, report_number
  use points_study, only: find_points
  use position_loads, only: elastic_division_t, fail_everywhere, find_division, &
    take_failures
  use reactions_study, only: find_reactions
  use sizing_requests, only: sizing_request_of
  use sizing_study, only: find_sizing
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: study_names, find_study

  !> All studies in the order in which they are made: some use the results of others. The last
  !! are made by `variant_runs`, some of them block by block or step by step.
  character(len=*), parameter :: study_names(22) = [character(len=12) :: "kinematics", "geometry", &
    "inertia", "points", "reactions", "joints", "friction", "lagrange", "balance", "harmonics", &
    "linkage", "limits", "sizing", "equilibrium", "response", &
    "stability", "intervals", "campbell", "transient", "motion", "frequencies", "loci"]

contains

  !> Makes a study that is made in one piece. The studies whose results it uses are made before.
  subroutine find_study(study, threads, variant)
    character(len=*), intent(in) :: study !! name
    integer, intent(in) :: threads       !! on which it is computed
    type(variant_results_t), intent(inout) :: variant !! that gets the result

    real(wp), allocatable :: speeds(:, :), accelerations(:, :)
    type(balance_request_t), allocatable :: request !! absent: to cancel the shaking force
    type(elastic_division_t), allocatable :: division !! absent: statics tells the forces
    type(error_t), allocatable :: failure
    integer :: i

    associate (linkage => variant%mechanism%linkage, elements => variant%mechanism%load_elements, &
        model => variant%model, points => variant%mechanism%points, found => variant%found)
      if (has_law(model)) then
        ! There is a state for every instant.
        speeds = model%law_rates(1:1, :)
        accelerations = model%law_rates(2:2, :)
      else if (allocated(found%positions%states)) then
        speeds = spread(model%speed%value, 2, size(found%positions%states))
        allocate (accelerations, mold=speeds)
        accelerations = model%acceleration
      end if
      if (study == "sizing") then
        call find_division(variant%mechanism%structure_t, division, found%sizing%error)
        if (allocated(found%sizing%error)) return
      else if (any(study == [character(len=8) :: "joints", "friction", "lagrange"])) then
        call find_division(variant%mechanism%structure_t, division, failure, &
          found%positions%states%crank)
        if (allocated(failure)) then
          call fail_everywhere(failure, found%positions)
          return
        end if
      end if
      select case (study)
      case ("kinematics")
        if (variant%mechanism%is_four_bar) call find_kinematics(linkage, found%positions, threads, &
          found%kinematics)
      case ("inertia")
        call find_inertia_loads(linkage, elements, found%positions, threads, found%inertia)
      case ("points")
        call find_points(linkage, points%body, &
          reshape([(points(i)%place, i=1, size(points))], [2, size(points)]), found%positions, &
          threads, found%points)
      case ("geometry")
        call find_geometry(linkage, points%body, &
          reshape([(points(i)%place, i=1, size(points))], [2, size(points)]), &
          model%reports(report_number(model, "geometry"))%crank%value, threads, found%geometry)
      case ("reactions")
        call find_reactions(linkage, elements, found%positions, threads, found%reactions, &
          speeds, accelerations)
      case ("joints")
        call find_joints(linkage, elements, found%positions, threads, found%joints, &
          speeds, accelerations, division)
        call take_failures(found%joints%outcome, found%positions)
      case ("friction")
        call find_joint_friction(linkage, elements, found%positions, threads, speeds, &
          accelerations, found%friction, division)
        call take_failures(found%friction%outcome, found%positions)
      case ("lagrange")
        call find_lagrange_terms(linkage, elements, found%positions, threads, found%lagrange, &
          speeds, accelerations, division)
        call take_failures(found%lagrange%outcome, found%positions)
      case ("balance")
        if (balances(model)) allocate (request, source=balance_request_of(model, &
          variant%mechanism))
        if (variant%mechanism%is_four_bar) then
          call find_balance(linkage, elements, found%positions, threads, found%balance, request, &
            speeds, accelerations)
        else
          call find_hung_balance(linkage, elements, found%positions, threads, found%balance, &
            request, speeds, accelerations)
        end if
      case ("harmonics")
        if (allocated(found%balance%partial)) then
          call find_harmonics(linkage, elements, model%speed%value, model%acceleration, threads, &
            found%harmonics, found%balance%partial%linkage)
        else
          call find_harmonics(linkage, elements, model%speed%value, model%acceleration, threads, &
            found%harmonics)
        end if
      case ("linkage")
        call find_linkage(linkage, found%linkage)
      case ("sizing")
        call find_sizing(linkage, elements, sizing_request_of(model), threads, found%sizing, &
          division)
      case ("limits")
        call find_limits(linkage, positions_of_deck(model), found%limits)
      case ("equilibrium")
        call find_equilibria(linkage, elements, positions_of_deck(model), found%equilibria)
      end select
    end associate
  end subroutine find_study

  !> Positions of the first drive that the deck names: on CRANK, or at the start of a motion.
  pure function positions_of_deck(model) result(positions)
    type(model_t), intent(in) :: model
    real(wp), allocatable :: positions(:) !! [deg] or [m]

    integer :: number

    positions = model%crank%value
    number = report_number(model, "motion")
    if (number > 0) positions = [positions, model%reports(number)%start_angle]
  end function positions_of_deck

end module report_studies
