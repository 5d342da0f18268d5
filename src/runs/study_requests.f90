!> The requests of a model to the studies that are made step by step, in the terms of mechanics.
module study_requests
  use cubic_splines, only: ends_not_a_knot, new_cubic_spline
  use drives, only: motor_drive_t
  use elastic_equations, only: elastic_terms_t
  use gears, only: gear_t
  use frequency_report, only: is_drawn
  use kinds, only: wp
  use load_cases, only: has_constant_loads
  use linkage_motion_study, only: linkage_motion_request_t
  use mechanisms, only: mechanism_t
  use models, only: effects_static, has_gauge_histories, has_law, inertia_lumped, model_t, &
    motion_goes_through, needs_loads, needs_study, report_number, report_with, &
    accuracy_of_study, solver_band, solver_dense
  use motion_study, only: motion_request_t
  use motor_cards, only: motor_t
  use positions, only: positions_t
  use response_parts, only: body_damping_t, damping_by_ratio, damping_by_time, dampings_of
  use response_types, only: damping_ratio, damping_time, gauge_t, link_damping_t, no_damping, &
    response_point_t, response_request_t
  use sections, only: outer_distance
  use stability_types, only: stability_request_t
  use structures, only: has_mesh
  use transient_types, only: from_rest, from_steady, transient_request_t
  use vibration_models, only: any_method, by_band, by_dense, by_orders, chosen_method, &
    mode_request_t
  implicit none (type, external)
  private

  public :: mode_request_of, method_wanted, drawn_states, motion_request_of, &
    linkage_motion_request_of, campbell_request_of, intervals_request_of, motion_instants_of, &
    response_request_of, &
    stability_request_of, transient_request_of

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

  !> The requested motion.
  pure function motion_request_of(model) result(request)
    type(model_t), intent(in) :: model         !! with REPORT motion
    type(motion_request_t) :: request

    associate (asked => model%reports(report_number(model, "motion")))
      request%start_angle = asked%start_angle
      request%start_speed = asked%start_speed
      request%end_time = asked%end_time
      request%instants = asked%instants%value
      request%with_pins = asked%with_pins
      request%through = motion_goes_through(model)
      request%with_details = asked%with_accelerations .or. asked%with_forces .or. asked%with_power
    end associate
    request%drive = drive_of(model)
    request%gear = gear_of(model%motor)
  end function motion_request_of

  !> The requested motion of a linkage that is no four-bar.
  pure function linkage_motion_request_of(model) result(request)
    type(model_t), intent(in) :: model         !! with REPORT motion
    type(linkage_motion_request_t) :: request

    associate (asked => model%reports(report_number(model, "motion")))
      request%start = asked%start_angle
      request%speed = asked%start_speed
      request%end_time = asked%end_time
      request%instants = asked%instants%value
      request%with_pins = asked%with_pins
      request%with_forces = asked%with_forces
      request%with_details = asked%with_accelerations .or. asked%with_forces .or. asked%with_power
    end associate
    request%is_free = model%drives%is_free
    request%drive = drive_of(model)
    request%gear = gear_of(model%motor)
  end function linkage_motion_request_of

  !> Number of rows of a motion that reaches its end; 0 without REPORT motion.
  pure function motion_instants_of(model) result(instants)
    type(model_t), intent(in) :: model !! of the variant
    integer :: instants

    integer :: number

    instants = 0
    number = report_number(model, "motion")
    if (number > 0) instants = size(model%reports(number)%instants%value)
  end function motion_instants_of

  !> The requested elastic response: what its reports need and no more.
  pure function response_request_of(model, mechanism) result(request)
    type(model_t), intent(in) :: model         !! with a report on the response
    type(mechanism_t), intent(in) :: mechanism !! of the model
    type(response_request_t) :: request

    integer :: b

    request%speed = model%speed%value
    request%crank = model%crank%value
    request%accuracy = accuracy_of_study(model, "response")
    request%terms = terms_of(model)
    request%damping = link_dampings_of(model, mechanism%links)
    request%modes = model%modes
    request%peaks = report_number(model, "peaks") > 0
    request%validity = report_number(model, "validity") > 0
    allocate (request%section(size(mechanism%links)))
    do b = 1, size(mechanism%links)
      associate (link => model%links(mechanism%links(b)))
        if (link%section > 0) request%section(b)%outer = &
          outer_distance(model%sections(link%section))
        if (link%material > 0) request%section(b)%modulus = &
          model%materials(link%material)%youngs_modulus
      end associate
    end do
    call add_places(mechanism, report_with(model, "response") > 0, report_with(model, &
      "strains") > 0, request)
  end function response_request_of

  !> Gauges and points of the elastic response.
  pure subroutine add_places(mechanism, displacements, strains, request)
    type(mechanism_t), intent(in) :: mechanism
    logical, intent(in) :: displacements, strains !! are asked for
    type(response_request_t), intent(inout) :: request

    integer :: i

    allocate (request%gauges(merge(size(mechanism%gauges), 0, strains)))
    do i = 1, size(request%gauges)
      associate (gauge => mechanism%gauges(i))
        request%gauges(i) = gauge_t(gauge%body, gauge%place, merge(-1.0_wp, 1.0_wp, &
          gauge%is_reversed), real(gauge%side, wp))
      end associate
    end do
    allocate (request%points(merge(size(mechanism%response_points), 0, displacements)))
    do i = 1, size(request%points)
      associate (point => mechanism%response_points(i))
        request%points(i) = response_point_t(point%body, point%place)
      end associate
    end do
  end subroutine add_places

  !> The requested elastic motions in time, at all pins, points and gauges.
  pure function transient_request_of(model, mechanism) result(request)
    type(model_t), intent(in) :: model         !! with REPORT transient
    type(mechanism_t), intent(in) :: mechanism !! of the model
    type(transient_request_t) :: request

    associate (report => model%reports(report_number(model, "transient")))
      associate (asked => report%transient)
        request%response = response_request_of(model, mechanism)
        if (allocated(request%response%points)) deallocate (request%response%points)
        if (allocated(request%response%gauges)) deallocate (request%response%gauges)
        call add_places(mechanism, .true., has_gauge_histories(model), request%response)
        request%response%accuracy = report%accuracy
        if (has_law(model)) then
          request%program = model%program
          request%time = model%time%value
        end if
        request%ramp = model%ramp
        request%crank = asked%crank
        request%turns = asked%turns
        request%instants = asked%instants
        request%start = merge(from_steady, from_rest, asked%steady)
        request%mode = asked%mode
        request%amplitude = asked%amplitude
        request%velocity = asked%velocity
      end associate
    end associate
  end function transient_request_of

  !> The requested exponents.
  pure function stability_request_of(model, mechanism) result(request)
    type(model_t), intent(in) :: model         !! with a report on stability
    type(mechanism_t), intent(in) :: mechanism !! of the model
    type(stability_request_t) :: request

    request = exponents_of_study(model, mechanism, "stability")
  end function stability_request_of

  !> The requested Campbell diagram.
  pure function campbell_request_of(model, mechanism) result(request)
    type(model_t), intent(in) :: model         !! with REPORT campbell
    type(mechanism_t), intent(in) :: mechanism !! of the model
    type(stability_request_t) :: request

    request = exponents_of_study(model, mechanism, "campbell")
  end function campbell_request_of

  !> Exponents at the speeds of the deck, with the accuracy of a study.
  pure function exponents_of_study(model, mechanism, study) result(request)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    character(len=*), intent(in) :: study !! name
    type(stability_request_t) :: request

    request%speed = model%speed%value
    request%modes = model%modes
    request%accuracy = accuracy_of_study(model, study)
    request%terms = terms_of(model)
    request%damping = link_dampings_of(model, mechanism%links)
  end function exponents_of_study

  !> The requested intervals of instability.
  pure function intervals_request_of(model, mechanism) result(request)
    type(model_t), intent(in) :: model         !! with REPORT intervals
    type(mechanism_t), intent(in) :: mechanism !! of the model
    type(stability_request_t) :: request

    request%speed = model%speed%value
    request%modes = model%modes
    request%accuracy = accuracy_of_study(model, "intervals")
    request%least_growth = model%reports(report_number(model, "intervals"))%least_growth
    request%terms = terms_of(model)
    request%damping = link_dampings_of(model, mechanism%links)
  end function intervals_request_of

  !> The terms of the equations of motion that are not left out.
  pure function terms_of(model) result(terms)
    type(model_t), intent(in) :: model
    type(elastic_terms_t) :: terms

    terms%coriolis = .not. model%without%coriolis
    terms%centripetal = .not. model%without%centripetal
    terms%axial = .not. model%without%axial
    terms%quadratic = .not. model%without%quadratic
  end function terms_of

  !> Damping of every body.
  pure function link_dampings_of(model, links) result(found)
    type(model_t), intent(in) :: model
    integer, intent(in) :: links(:) !! (bodies) numbers of their links in the model
    type(link_damping_t) :: found(size(links))

    type(body_damping_t) :: dampings(size(links))
    integer :: b

    dampings = dampings_of(model, links)
    do b = 1, size(dampings)
      select case (dampings(b)%kind)
      case (damping_by_time)
        found(b) = link_damping_t(damping_time, dampings(b)%value)
      case (damping_by_ratio)
        found(b) = link_damping_t(damping_ratio, dampings(b)%value)
      case default
        found(b) = link_damping_t(no_damping, 0.0_wp)
      end select
    end do
  end function link_dampings_of

  !> The motor, at its own shaft; without MOTOR its torque is 0.
  pure function drive_of(model) result(drive)
    type(model_t), intent(in) :: model
    type(motor_drive_t) :: drive

    associate (motor => model%motor)
      drive%stall = merge(motor%stall, motor%torque, motor%is_line)
      if (motor%is_line) drive%slope = motor%stall/motor%noload
      if (size(motor%speed) < 2) return
      drive%line = new_cubic_spline(motor%speed, motor%line_torque, ends_not_a_knot)
      drive%table_name = motor%table_word%text
    end associate
  end function drive_of

  !> The gear of the motor, with its rotor.
  pure function gear_of(motor) result(gear)
    type(motor_t), intent(in) :: motor !! of the deck; without a card none
    type(gear_t) :: gear

    gear = gear_t(motor%ratio, motor%rotor, motor%efficiency, motor%smooth)
  end function gear_of

end module study_requests
