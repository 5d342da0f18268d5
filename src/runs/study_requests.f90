!> The requests of a model to the studies that are made step by step, in the terms of mechanics.
module study_requests
  use attached_parts, only: body_of
  use drives, only: motor_drive_t, resistances_t
  use frequency_report, only: is_drawn
  use kinds, only: wp
  use load_cases, only: has_constant_loads
  use mechanisms, only: mechanism_t
  use models, only: effects_static, inertia_lumped, model_t, needs_loads, needs_study, &
    report_number, solver_band, solver_dense
  use motion_study, only: motion_request_t
  use positions, only: positions_t
  use vibration_models, only: any_method, by_band, by_dense, chosen_method, mode_request_t
  implicit none (type, external)
  private

  public :: mode_request_of, method_wanted, drawn_states, motion_request_of, &
    motion_instants_of

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
    request%method = chosen_method(method_wanted(model), mechanism%accuracy > 0.0_wp, &
      mechanism%mesh%elements, mechanism%mesh%order, mechanism%mesh%sheared)
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

  !> The requested motion.
  pure function motion_request_of(model) result(request)
    type(model_t), intent(in) :: model !! with REPORT motion
    type(motion_request_t) :: request

    associate (asked => model%reports(report_number(model, "motion")))
      request%start_angle = asked%start_angle
      request%start_speed = asked%start_speed
      request%end_time = asked%end_time
      request%instants = asked%instants%value
    end associate
    request%drive = drive_of(model)
    request%resistances = resistances_of(model)
  end function motion_request_of

  !> Number of rows of a motion that reaches its end; 0 without REPORT motion.
  pure function motion_instants_of(model) result(instants)
    type(model_t), intent(in) :: model !! of the variant
    integer :: instants

    integer :: number

    instants = 0
    number = report_number(model, "motion")
    if (number > 0) instants = size(model%reports(number)%instants%value)
  end function motion_instants_of

  !> The motor on the driven link; without MOTOR its torque is 0.
  pure function drive_of(model) result(drive)
    type(model_t), intent(in) :: model
    type(motor_drive_t) :: drive

    associate (motor => model%motor)
      drive%stall = merge(motor%stall, motor%torque, motor%is_line)
      if (motor%is_line) drive%slope = motor%stall/motor%noload
    end associate
  end function drive_of

  !> Resisting torques of the LOAD cards, at most one per link, on the bodies.
  pure function resistances_of(model) result(resistances)
    type(model_t), intent(in) :: model
    type(resistances_t) :: resistances

    integer :: i, body

    do i = 1, size(model%resistances)
      associate (resistance => model%resistances(i))
        body = body_of(model, resistance%link)
        resistances%taken(body) = resistance%torque
        resistances%damping(body) = resistance%damping
      end associate
    end do
  end function resistances_of

end module study_requests
