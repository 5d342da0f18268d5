!> What a model asks of frequencies.
module mode_requests
  use frequency_report, only: is_drawn
  use kinds, only: wp
  use load_cases, only: has_constant_loads
  use mechanisms, only: mechanism_t
  use models, only: effects_static, inertia_lumped, model_t, needs_loads, needs_study, &
    report_number, solver_band, solver_dense
  use positions, only: positions_t
  use structures, only: has_mesh
  use vibration_models, only: any_method, by_band, by_dense, by_orders, chosen_method, &
    mode_request_t
  implicit none (type, external)
  private

  public :: mode_request_of, method_wanted, drawn_states

contains

  !> The requested frequencies, with the method to find them.
  pure function mode_request_of(model, mechanism) result(request)
    type(model_t), intent(in) :: model         !! with frequencies
    type(mechanism_t), intent(in) :: mechanism !! of the model
    type(mode_request_t) :: request

    integer :: number

    request%modes = model%modes
    request%axial = needs_loads(model)
    request%constant = has_constant_loads(mechanism%linkage)
    request%lumped = model%inertia == inertia_lumped
    ! Links that cannot be divided into elements have orders that the program chooses.
    request%method = by_orders
    if (has_mesh(mechanism)) request%method = chosen_method(method_wanted(model), &
      mechanism%accuracy > 0.0_wp, mechanism%mesh%elements, mechanism%mesh%order, &
      mechanism%mesh%sheared)
    if (mechanism%accuracy > 0.0_wp) request%accuracy = mechanism%accuracy
    request%follow = needs_study(model, "loci")
    number = report_number(model, "shapes")
    if (number > 0) request%points = model%reports(number)%points
    request%acceleration = model%acceleration
    if (model%effects == effects_static) then
      request%speed = [0.0_wp]
    else
      request%speed = model%speed%value
    end if
  end function mode_request_of

  !> The method that SOLVER requests.
  pure function method_wanted(model) result(method)
    type(model_t), intent(in) :: model !! of the variant
    integer :: method

    method = any_method
    if (model%solver == solver_dense) method = by_dense
    if (model%solver == solver_band) method = by_band
  end function method_wanted

  !> The positions and speeds whose shapes are requested.
  pure function drawn_states(model, positions, speed) result(drawn)
    type(model_t), intent(in) :: model                    !! of the variant
    type(positions_t), intent(in) :: positions            !! of the sweep
    real(wp), intent(in) :: speed(:)                      !! of the frequencies [rad/s]
    logical :: drawn(size(positions%states), size(speed)) !! (states, speeds)

    integer :: i, k, number

    drawn = .false.
    number = report_number(model, "shapes")
    if (number == 0) return
    do k = 1, size(speed)
      do i = 1, size(positions%crank)
        if (is_drawn(model%reports(number), positions%crank(i), speed(k))) &
          drawn(positions%state(i), k) = .true.
      end do
    end do
  end function drawn_states

end module mode_requests
