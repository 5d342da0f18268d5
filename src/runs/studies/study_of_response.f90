!> The steady elastic response at all speeds.
module study_of_response
  use elastic_requests, only: link_dampings_of, terms_of
  use kinds, only: wp
  use mechanisms, only: link_lengths, mechanism_t
  use models, only: accuracy_of_study, model_t, needs_response, report_number, report_with, &
    speed_in_words
  use named_parts, only: name_outcomes
  use response_builder, only: body_damping_t, damping_none, dampings_of
  use response_study, only: find_response, largest_deflection
  use response_types, only: drive_values, gauge_t, response_point_t, response_request_t, &
    response_t, strain_values
  use run_findings, only: findings_t
  use run_totals, only: run_totals_t
  use sections, only: outer_distance
  use study_findings, only: judge_deflection, most_deflection, note_failed_speeds, note_warning
  use study_keepers, only: kept_response, study_keeper_t
  use study_types, only: add_need, add_study, bytes_of_number, memory_needs_t, study_t, &
    variant_run_t
  use text, only: plural, to_string
  use variant_results, only: variant_results_t
  use warnings, only: warning_t
  implicit none (type, external)
  private

  public :: add_response_study, response_request_of, add_places

  character(len=*), parameter :: study_name = "response"

  !> Kinds of warnings: a link deflects too much, the accuracy is not reached, the steady state is
  !! unstable, nothing damps it.
  integer, parameter :: of_deflection = 1, of_accuracy = 2, of_instability = 3, of_no_damping = 4

  !> Largest ln |multiplier| of a turn that may be rounding, and not growth [-].
  real(wp), parameter :: most_growth = 1.0e-3_wp

contains

  !> Appends the study of this file.
  subroutine add_response_study(list)
    type(study_t), allocatable, intent(inout) :: list(:) !! to which they are appended

    call add_study(list, study_t(study_name, keeps=.true., compute=compute_response, &
      add_failures=add_response_failures, add_warnings=add_response_warnings, &
      add_work=add_response_work, add_memory=add_response_memory))
  end subroutine add_response_study

  subroutine compute_response(run)
    type(variant_run_t), intent(inout), target :: run

    type(study_keeper_t) :: keeper

    keeper = study_keeper_t(run%journal, run%group, kept_response)
    associate (variant => run%results, response => run%results%found%response)
      call find_response(variant%mechanism%structure_t, response_request_of(variant%model, &
        variant%mechanism), run%threads, run%store, response, keeper)
      call name_outcomes(variant, response%at_speed)
    end associate
  end subroutine compute_response

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

  pure subroutine add_response_failures(variant, findings)
    type(variant_results_t), intent(in) :: variant
    type(findings_t), intent(inout) :: findings

    if (allocated(variant%found%response%at_speed)) call note_failed_speeds(variant, study_name, &
      variant%found%response%at_speed, findings)
  end subroutine add_response_failures

  pure subroutine add_response_warnings(variant, findings)
    type(variant_results_t), intent(in) :: variant
    type(findings_t), intent(inout) :: findings

    type(warning_t) :: warning

    ! Function results go through a variable: gfortran 12 does not free them if they are arguments.
    warning = deflections(variant)
    call note_warning(variant, study_name, warning, findings)
    warning = no_damping_at_all(variant%model)
    call note_warning(variant, study_name, warning, findings)
    warning = instabilities(variant%model, variant%found%response)
    call note_warning(variant, study_name, warning, findings)
    warning = missed_accuracy(variant%model, variant%found%response)
    call note_warning(variant, study_name, warning, findings)
  end subroutine add_response_warnings

  !> The largest deflection, if it is too large for linear equations.
  pure function deflections(variant) result(warning)
    type(variant_results_t), intent(in) :: variant
    type(warning_t) :: warning !! without a text if there is none

    real(wp) :: largest
    integer :: body, speed

    associate (model => variant%model, mechanism => variant%mechanism)
      warning%kind = of_deflection
      call largest_deflection(variant%found%response, link_lengths(mechanism), largest, body, speed)
      if (largest <= most_deflection) return
      warning%text = "in the response at speed "//speed_in_words(model, speed, &
        model%speed%value(speed))//" link '"//mechanism%names(body)%text//"' deflects"
      call judge_deflection(largest, "this response means", "linear equations", warning)
    end associate
  end function deflections

  !> Near resonances only damping limits the response.
  pure function no_damping_at_all(model) result(warning)
    type(model_t), intent(in) :: model
    type(warning_t) :: warning !! without a text if a link is damped, or none bends

    type(body_damping_t) :: dampings(size(model%links))
    integer :: i

    warning%kind = of_no_damping
    dampings = dampings_of(model, [(i, i=1, size(model%links))])
    if (any(dampings%kind /= damping_none) .or. all(model%links%rigid)) return
    if (any(model%springs%damps)) return
    warning%text = "no link has DAMPING: near resonances this response is that of no real machine"
  end function no_damping_at_all

  !> The speed at which disturbances of the steady state grow most, and the number of such speeds.
  pure function instabilities(model, response) result(warning)
    type(model_t), intent(in) :: model
    type(response_t), intent(in) :: response
    type(warning_t) :: warning !! without a text if there is none

    integer :: k, worst, speeds

    warning%kind = of_instability
    worst = 0
    speeds = 0
    do k = 1, size(response%at_speed)
      if (allocated(response%at_speed(k)%error)) cycle
      if (response%at_speed(k)%growth <= most_growth) cycle
      speeds = speeds + 1
      if (response%at_speed(k)%growth <= warning%amount) cycle
      worst = k
      warning%amount = response%at_speed(k)%growth
    end do
    if (speeds == 0) return
    warning%text = "the steady motion at "//speed_in_words(model, worst, &
      model%speed%value(worst))//" is unstable: small disturbances grow by a factor of "// &
      to_string(exp(min(warning%amount, 600.0_wp)), 4)//" a turn"
    if (speeds == 2) warning%text = warning%text//"; so is that at another speed"
    if (speeds > 2) warning%text = warning%text//"; so are those at "//to_string(speeds - 1)// &
      " other speeds"
  end function instabilities

  !> The speeds at which the response is less accurate than requested, and the worst of them.
  pure function missed_accuracy(model, response) result(warning)
    type(model_t), intent(in) :: model
    type(response_t), intent(in) :: response
    type(warning_t) :: warning !! without a text if there is none

    integer :: k, worst, speeds

    warning%kind = of_accuracy
    worst = 0
    speeds = 0
    do k = 1, size(response%at_speed)
      if (allocated(response%at_speed(k)%error)) cycle
      if (response%at_speed(k)%largest_error <= accuracy_of_study(model, study_name)) cycle
      speeds = speeds + 1
      if (response%at_speed(k)%largest_error <= warning%amount) cycle
      worst = k
      warning%amount = response%at_speed(k)%largest_error
    end do
    if (speeds == 0) return
    warning%text = "the accuracy "//to_string(accuracy_of_study(model, study_name))// &
      " of the response is not reached at "//plural(speeds, "speed")//": the error is up to "// &
      to_string(warning%amount, 2)//", at "//speed_in_words(model, worst, &
      model%speed%value(worst))
  end function missed_accuracy

  !> The largest strain and displacement.
  pure subroutine add_response_work(variant, totals)
    type(variant_results_t), intent(in) :: variant
    type(run_totals_t), intent(inout) :: totals

    integer :: k
    logical :: peaks

    if (.not. allocated(variant%found%response%at_speed)) return
    peaks = report_number(variant%model, "peaks") > 0
    totals%response_speeds = size(variant%found%response%at_speed)
    totals%applications = sum(variant%found%response%at_speed%applications)
    do k = 1, size(variant%found%response%at_speed)
      associate (at_speed => variant%found%response%at_speed(k))
        if (allocated(at_speed%error)) cycle
        if (peaks) totals%strain = max(totals%strain, maxval(at_speed%largest_strain%value))
        if (size(at_speed%displacement) > 0) totals%displacement = max(totals%displacement, &
          maxval(norm2(at_speed%displacement(:2, :, :), dim=1)))
      end associate
    end do
  end subroutine add_response_work

  !> The terms of the equations at the crank angles of a turn, for several orders; vectors of the
  !! iterations, for each thread; the results, kept until they are written.
  subroutine add_response_memory(model, needs)
    type(model_t), intent(in) :: model
    type(memory_needs_t), intent(inout) :: needs

    !> Crank angles and unknowns of a link, more than most linkages take; arrays of that size that
    !! are kept, and those of a thread: as found in runs. Accuracies near round-off try more of all.
    real(wp), parameter :: samples = 1024.0_wp, unknowns = 32.0_wp, kept = 100.0_wp, &
      own = 40.0_wp, hard = 1.0e-10_wp, more = 12.0_wp
    real(wp) :: results
    integer :: report

    if (.not. needs_response(model)) return
    report = findloc(model%reports%kind%response, .true., dim=1)
    results = drive_values
    if (report_number(model, "response") > 0) results = results + 3*(4 + size(model%points))
    if (report_number(model, "strains") > 0) results = results + strain_values*max(3, &
      size(model%gauges))
    call add_need(needs, model%reports(report)%keyword, "the elastic response at "// &
      plural(size(model%crank%value), "position")//" and "//plural(size(model%speed%value), &
      "speed"), &
      bytes_of_number*(size(model%crank%value)*size(model%speed%value)*results + &
      samples*unknowns*size(model%links)*(kept + own*needs%threads)* &
      merge(more, 1.0_wp, accuracy_of_study(model, study_name) < hard)))
  end subroutine add_response_memory

end module study_of_response
