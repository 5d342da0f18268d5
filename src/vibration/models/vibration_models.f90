!> The models with which a run finds frequencies at any position; made once.
module vibration_models
  use damped_eigensolver, only: first_guards
  use deformation_model, only: deformation_model_t, new_deformation_model
  use deformation_shapes, only: bending_unknowns
  use errors, only: error_t
  use kinds, only: fineness, wp
  use ledger, only: ledger_t
  use link_store, only: link_store_t
  use load_cases, only: case_count, constant_case
  use order_choice, only: choose_orders, order_demand_t
  use positions, only: positions_t
  use structures, only: structure_t
  implicit none (type, external)
  private

  public :: mode_request_t, vibration_models_t, new_vibration_models, load_factors, &
    chosen_method, is_long_link, most_link_unknowns, modes_with_dampers
  public :: by_orders, by_link_modes, by_dense, by_band, any_method

  !> Methods for the frequencies that are written: continuous links of orders chosen by the program;
  !! the deck's mesh in deformation coordinates, from own modes of the links; the deck's mesh in
  !! nodal unknowns, with full or with band matrices.
  integer, parameter :: by_orders = 1, by_link_modes = 2, by_dense = 3, by_band = 4

  !> The choice is left to the program.
  integer, parameter :: any_method = 0

  !> Links with more unknowns than this are not decomposed into their own modes.
  integer, parameter :: most_link_unknowns = 200

  !> Accuracy of the continuous links from which the error of a mesh is estimated.
  real(wp), parameter :: judging_accuracy = 1.0e-13_wp*fineness

  !> The analysis requested at every position.
  type :: mode_request_t
    integer :: modes = 3               !! number, lowest first
    integer :: method = by_orders      !! one of the methods above
    real(wp) :: accuracy = judging_accuracy !! of frequencies, for orders chosen by the program
    logical :: lumped = .false.        !! inertia loads on the nodes of the mesh; else along the
                                       !! links
    logical :: follow = .false.        !! modes are followed from row to row
    integer :: points = 0              !! along each link, where shapes are requested
    real(wp), allocatable :: speed(:)  !! ω2 [rad/s]; static: one value, which has no effect
    real(wp) :: acceleration = 0.0_wp  !! α2 [rad/s²]
    logical :: axial = .false.         !! with the geometric stiffness of the loads
    logical :: constant = .false.      !! the loads include gravity or external forces and torques
  end type mode_request_t

  type :: vibration_models_t
    type(deformation_model_t) :: continuum !! continuous links of the orders that the accuracy
                                           !! requires; for every method
    type(deformation_model_t) :: mesh      !! the deck's mesh for `by_link_modes`
  end type vibration_models_t

contains

  !> Factors of the unit loads at every speed: ω2², α2, and 1 for constant loads; zero without the
  !! geometric stiffness.
  pure function load_factors(request) result(factor)
    type(mode_request_t), intent(in) :: request         !! speeds, loads
    real(wp) :: factor(case_count, size(request%speed)) !! (cases, speeds)

    factor = 0.0_wp
    if (.not. request%axial) return
    factor(1, :) = request%speed**2
    factor(2, :) = request%acceleration
    if (request%constant) factor(constant_case, :) = 1.0_wp
  end function load_factors

  !> The method for the deck's choice of solver and mesh.
  pure function chosen_method(wanted, accurate, elements, order, sheared) result(method)
    integer, intent(in) :: wanted                !! by_dense, by_band or any_method
    logical, intent(in) :: accurate              !! the program chooses the orders; no mesh is used
    integer, intent(in) :: elements(:), order(:) !! (bodies) of the mesh
    logical, intent(in) :: sheared               !! elements have shear strains
    integer :: method                            !! one of `by_orders` to `by_band`

    if (accurate) then
      method = by_orders
    else if (wanted /= any_method) then
      method = wanted
    else if (any(is_long_link(elements, order, sheared))) then
      method = by_band
    else
      method = by_link_modes
    end if
  end function chosen_method

  !> Whether a link has too many unknowns to be decomposed into own modes; a single element never
  !! has.
  elemental function is_long_link(elements, order, sheared) result(is)
    integer, intent(in) :: elements, order
    logical, intent(in) :: sheared
    logical :: is

    is = elements > 1 .and. elements*bending_unknowns(order, sheared) > most_link_unknowns
  end function is_long_link

  !> Makes the continuous links, of orders that keep an error bound at the given positions, and the
  !! models that the method needs besides.
  !!
  !! Errors: the own modes of a link could not be found.
  subroutine new_vibration_models(structure, positions, states, request, bound, store, models, &
      counts, error)
    type(structure_t), intent(in) :: structure       !! with a mesh unless the method is `by_orders`
    type(positions_t), intent(in) :: positions       !! of the run
    integer, intent(in) :: states(:)                 !! numbers of the positions to be solved
    type(mode_request_t), intent(in) :: request      !! modes, method, speeds, loads
    real(wp), intent(in) :: bound                    !! on the relative error of eigenvalues
    type(link_store_t), intent(inout) :: store       !! links decomposed earlier
    type(vibration_models_t), intent(out) :: models  !! for these positions
    type(ledger_t), intent(inout) :: counts          !! of the work done
    type(error_t), allocatable, intent(out) :: error !! why there are no models

    type(order_demand_t) :: demand

    demand%states = states
    demand%factor = load_factors(request)
    demand%modes = request%modes
    demand%bound = bound
    demand%modes = modes_with_dampers(structure, demand%modes)
    call choose_orders(structure, positions, demand, store, models%continuum, counts, error)
    if (allocated(error)) return
    if (request%method /= by_link_modes) return
    associate (mesh => structure%mesh)
      call new_deformation_model(structure%linkage, structure%beams, mesh%elements, mesh%order, &
        spread(request%lumped .and. request%axial, 1, size(structure%beams)), models%mesh, error, &
        store, models%continuum%degrees)
    end associate
  end subroutine new_vibration_models

  !> Number of modes without dampers from which so many with them are found: dampers that hold fast
  !! raise as many modes, and damped ones are found from more undamped ones.
  pure function modes_with_dampers(structure, wanted) result(modes)
    class(structure_t), intent(in) :: structure
    integer, intent(in) :: wanted !! modes
    integer :: modes

    modes = wanted
    associate (dampers => size(structure%elastic%dampers))
      if (dampers > 0) modes = wanted + first_guards + dampers
    end associate
  end function modes_with_dampers

end module vibration_models
