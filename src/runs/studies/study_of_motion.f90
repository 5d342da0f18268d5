!> Forward motion: a linkage that moves freely.
module study_of_motion
  use cubic_splines, only: ends_not_a_knot, new_cubic_spline
  use drives, only: motor_drive_t
  use errors, only: error_of_input, error_of_numerics, error_t, set_error
  use gears, only: gear_t
  use geometry_study, only: find_moving_geometry
  use joints_report, only: open_words
  use kinds, only: wp
  use mechanisms, only: mechanism_t
  use models, only: model_t, motion_goes_through, report_number
  use motion_study, only: begin_motion, continue_motion, finish_motion, motion_request_t, &
    motion_under_way_t, undetermined_message
  use motor_cards, only: motor_t
  use named_parts, only: name_parts
  use progress, only: show_progress
  use rigid_studies, only: places_of
  use run_findings, only: findings_t
  use run_totals, only: run_totals_t
  use study_findings, only: note_failure
  use study_types, only: add_need, add_study, bytes_of_number, memory_needs_t, study_t, &
    variant_run_t
  use text, only: plural
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: add_motion_study, motion_request_of, motion_instants_of

  !> Instants after which the progress is shown.
  integer, parameter :: instants_at_a_time = 100

contains

  !> Appends the study of this file.
  subroutine add_motion_study(list)
    type(study_t), allocatable, intent(inout) :: list(:) !! to which they are appended

    call add_study(list, study_t("motion", compute=compute_motion, &
      add_failures=add_motion_failures, add_work=add_motion_work, add_memory=add_motion_memory))
  end subroutine add_motion_study

  !> A number of instants at a time.
  subroutine compute_motion(run)
    type(variant_run_t), intent(inout), target :: run

    type(motion_under_way_t) :: under_way

    associate (mechanism => run%results%mechanism, motion => run%results%found%motion, &
        points => run%results%mechanism%points)
      call begin_motion(motion_request_of(run%results%model, mechanism), mechanism%linkage, &
        mechanism%load_elements, under_way, motion, mechanism%structure_t)
      do while (.not. under_way%is_over)
        call continue_motion(under_way, instants_at_a_time, motion)
        call show_progress(run%progress, motion%count, size(motion%samples))
      end do
      call finish_motion(under_way, motion)
      call name_parts(run%results, motion%error)
      if (report_number(run%results%model, "geometry") > 0) call find_moving_geometry( &
        mechanism%linkage, points%body, places_of(points), motion%samples(:motion%count), &
        run%results%found%motion_places)
    end associate
  end subroutine compute_motion

  !> The requested motion.
  pure function motion_request_of(model, mechanism) result(request)
    type(model_t), intent(in) :: model         !! with REPORT motion
    type(mechanism_t), intent(in) :: mechanism !! of this model
    type(motion_request_t) :: request

    integer :: i

    associate (asked => model%reports(report_number(model, "motion")))
      request%start = asked%start_angle
      request%speed = asked%start_speed
      request%end_time = asked%end_time
      request%instants = asked%instants%value
      request%with_pins = asked%with_pins .or. report_number(model, "geometry") > 0
      request%through = motion_goes_through(model)
      if (asked%with_coordinates) then
        request%held_by = mechanism%coordinates%drive
        ! Free drives but the first have no force.
        do i = 1, size(request%held_by)
          if (request%held_by(i) > 1) request%held_by(i) = merge(0, request%held_by(i), &
            model%drives(request%held_by(i))%is_free)
        end do
        request%with_forces = any(request%held_by > 1)
      end if
      request%with_forces = request%with_forces .or. asked%with_forces
      request%with_details = asked%with_accelerations .or. request%with_forces .or. &
        asked%with_power .or. asked%with_motor .or. asked%with_coordinates
    end associate
    request%is_free = model%drives%is_free
    request%rates = model%drives%speed
    request%drive = drive_of(model)
    request%gear = gear_of(model%motor)
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

  !> Instants without the accelerations and forces that the card asks for, and an end too soon.
  pure subroutine add_motion_failures(variant, findings)
    type(variant_results_t), intent(in) :: variant
    type(findings_t), intent(inout) :: findings

    type(error_t), allocatable :: undetermined, error
    integer :: i

    call set_error(undetermined, error_of_numerics, undetermined_message)
    associate (motion => variant%found%motion)
      if (allocated(motion%is_determined)) then
        do i = 1, motion%count
          if (.not. motion%is_determined(i)) call note_failure(variant, "motion", undetermined, &
            findings, crank=motion%samples(i)%position(1), time=motion%samples(i)%time)
        end do
      end if
      if (allocated(motion%is_open)) then
        i = findloc(any(motion%is_open(:, :motion%count), dim=1), .true., dim=1)
        if (i > 0) then
          call set_error(error, error_of_input, open_words(variant, motion%joints(findloc( &
            motion%is_open(:, i), .true., dim=1))))
          call note_failure(variant, "motion", error, findings, &
            crank=motion%samples(i)%position(1), time=motion%samples(i)%time)
        end if
      end if
      if (allocated(motion%error)) call note_failure(variant, "motion", motion%error, findings, &
        crank=last_crank(variant), time=motion%last%time)
    end associate
  end subroutine add_motion_failures

  !> Where the first drive was at last: at the start, if the motion has not begun [deg] or [m].
  pure function last_crank(variant) result(crank)
    type(variant_results_t), intent(in) :: variant !! with a motion
    real(wp) :: crank

    crank = variant%model%reports(report_number(variant%model, "motion"))%start_angle
    associate (motion => variant%found%motion)
      if (allocated(motion%last%position)) crank = motion%last%position(1)
    end associate
  end function last_crank

  pure subroutine add_motion_work(variant, totals)
    type(variant_results_t), intent(in) :: variant
    type(run_totals_t), intent(inout) :: totals

    associate (found => variant%found)
      totals%motion_steps = found%motion%steps
      if (found%motion%has_begun .and. variant%mechanism%is_four_bar) &
        totals%kinematic_solutions = totals%kinematic_solutions + 1
    end associate
  end subroutine add_motion_work

  !> All instants of a motion, kept until they are written.
  pure subroutine add_motion_memory(model, needs)
    type(model_t), intent(in) :: model
    type(memory_needs_t), intent(inout) :: needs

    integer, parameter :: numbers = 56 !! of a sample, with what its arrays take beside them
    integer, parameter :: of_joint = 3 !! numbers of a joint
    integer, parameter :: numbers_of_coordinate = 5
    integer :: report, pins, columns, i

    report = report_number(model, "motion")
    if (report == 0) return
    pins = 0
    if (model%reports(report)%with_pins .or. report_number(model, "geometry") > 0) &
      pins = sum([(size(model%links(i)%pins), i=1, size(model%links))])
    if (report_number(model, "geometry") > 0) pins = 2*pins + size(model%points) + &
      size(model%sliders)
    columns = 0
    associate (asked => model%reports(report))
      if (asked%with_coordinates) columns = numbers_of_coordinate*(size(model%springs) + &
        size(model%drives) + size(model%sliders) + size(model%measures))
      if (asked%with_accelerations) columns = columns + max(3, size(model%drives))
      if (asked%with_power .or. asked%with_motor) columns = columns + 5
      if (asked%with_forces) columns = columns + of_joint*(sum([(size(model%links(i)%pins), &
        i=1, size(model%links))]) + size(model%sliders))
    end associate
    call add_need(needs, model%reports(report)%keyword, "the "//plural(motion_instants_of(model), &
      "instant")//" of the motion", (numbers + 2*pins + columns)*bytes_of_number* &
      motion_instants_of(model))
  end subroutine add_motion_memory

end module study_of_motion
