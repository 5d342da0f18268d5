!> Warnings about results of a variant: static divergence, large deflections, accuracy not reached,
!! unstable steady states, unsettled harmonics.
module result_warnings
  use campbell_types, only: campbell_t
  use harmonics_study, only: harmonics_result_t, has_settled
  use kinds, only: wp
  use mechanisms, only: link_lengths, mechanism_t
  use models, only: accuracy_of_study, drives_length, has_law, model_t, needs_frequencies, &
    needs_study, speed_in_words
  use position_results, only: error_of_divergence, error_of_orders, error_of_position
  use positions, only: positions_t
  use response_parts, only: body_damping_t, damping_none, dampings_of
  use response_study, only: largest_deflection
  use response_types, only: response_t
  use run_findings, only: add_warning_of_run, findings_t
  use sweeps, only: has_result, sweep_t
  use table_columns, only: table_unit
  use text, only: plural, to_string
  use units, only: from_si, unit_t
  use variant_results, only: variant_results_t
  use vibration_models, only: by_orders
  use warnings, only: grade_meaningless, warning_t
  implicit none (type, external)
  private

  public :: find_warnings
  public :: warning_of_divergence, warning_of_deflection, warning_of_accuracy, &
    warning_of_response_deflection, warning_of_transient_deflection, &
    warning_of_response_accuracy, warning_of_instability, &
    warning_of_no_damping, warning_of_gaps, warning_of_harmonics

  !> Kinds of warnings: an eigenvalue is negative; the loads bend a link too much; the accuracy is
  !! not reached; the last two in the elastic response; its steady state is unstable; nothing
  !! damps it; critical speeds may be missed; harmonics have not settled; deflections in time.
  integer, parameter :: warning_of_divergence = 1, warning_of_deflection = 2, &
    warning_of_accuracy = 3, warning_of_response_deflection = 4, &
    warning_of_response_accuracy = 5, warning_of_instability = 6, warning_of_no_damping = 7, &
    warning_of_gaps = 8, warning_of_harmonics = 9, warning_of_transient_deflection = 10

  !> Largest static deflection without a warning, relative to the link's length: the axial
  !! frequencies assume that the loads bend the links little [-].
  real(wp), parameter :: most_deflection = 0.01_wp

  !> Static deflection, relative to the link's length, beyond which the frequencies mean nothing:
  !! no link can be bent so far [-].
  real(wp), parameter :: impossible_deflection = 1.0_wp

  !> Largest ln |multiplier| of a turn that may be rounding, and not growth [-].
  real(wp), parameter :: most_growth = 1.0e-3_wp

contains

  !> Appends warnings about static divergence, large deflections, accuracy that is not reached,
  !! unstable steady states, and harmonics that have not settled.
  pure subroutine find_warnings(variant, findings)
    type(variant_results_t), intent(in) :: variant !! computed
    type(findings_t), intent(inout) :: findings    !! to which they are appended

    type(warning_t) :: warning
    integer :: k

    ! Function results go through a variable: gfortran 12 does not free them if they are arguments.
    if (needs_study(variant%model, "response")) then
      associate (model => variant%model, response => variant%found%response)
        warning = response_deflections(model, variant%mechanism, response)
        call add_if_any(findings, model%variant, warning)
        warning = no_damping_at_all(model)
        call add_if_any(findings, model%variant, warning)
        warning = instabilities(model, response)
        call add_if_any(findings, model%variant, warning)
        warning = missed_response_accuracy(model, response)
        call add_if_any(findings, model%variant, warning)
      end associate
    end if
    if (needs_study(variant%model, "transient")) then
      warning = transient_deflections(variant)
      call add_if_any(findings, variant%model%variant, warning)
    end if
    if (needs_study(variant%model, "campbell")) then
      warning = missed_critical_speeds(variant%model, variant%found%campbell)
      call add_if_any(findings, variant%model%variant, warning)
    end if
    if (needs_study(variant%model, "harmonics")) then
      warning = unsettled_harmonics(variant%found%harmonics)
      call add_if_any(findings, variant%model%variant, warning)
    end if
    if (.not. needs_frequencies(variant%model)) return
    associate (model => variant%model, positions => variant%found%positions, &
        sweep => variant%found%sweep)
      do k = 1, size(sweep%request%speed)
        warning = divergences(model, positions, sweep, k)
        call add_if_any(findings, model%variant, warning)
      end do
      if (sweep%request%axial) then
        warning = deflections(model, variant%mechanism, positions, sweep)
        call add_if_any(findings, model%variant, warning)
      end if
      if (sweep%request%method == by_orders) then
        warning = missed_accuracy(model, positions, sweep)
        call add_if_any(findings, model%variant, warning)
      end if
    end associate
  end subroutine find_warnings

  !> Appends a warning of a variant, if it has a text.
  pure subroutine add_if_any(findings, variant, warning)
    type(findings_t), intent(inout) :: findings
    character(len=*), intent(in) :: variant
    type(warning_t), intent(inout) :: warning

    if (.not. allocated(warning%text)) return
    warning%variant = variant
    call add_warning_of_run(findings, warning)
  end subroutine add_if_any

  !> The crank angles at which an eigenvalue is negative at one speed. Neighbours in the deck's
  !! list are joined to ranges.
  pure function divergences(model, positions, sweep, speed) result(warning)
    type(model_t), intent(in) :: model
    type(positions_t), intent(in) :: positions
    type(sweep_t), intent(in) :: sweep
    integer, intent(in) :: speed !! number
    type(warning_t) :: warning             !! without a text if there is none

    character(len=:), allocatable :: ranges
    type(unit_t) :: unit
    integer :: i, first

    warning%kind = warning_of_divergence
    unit = unit_of_positions(model)
    ranges = ""
    first = 0
    do i = 1, size(positions%crank)
      if (diverges(positions, sweep, i, speed)) then
        warning%amount = max(warning%amount, &
          -minval(sweep%results(positions%state(i))%lambda(:, speed)))
        if (first == 0) first = i
      end if
      if (first == 0) cycle
      if (i < size(positions%crank)) then
        if (diverges(positions, sweep, i + 1, speed)) cycle
      end if
      if (len(ranges) > 0) ranges = ranges//", "
      ranges = ranges//to_string(from_si(positions%crank(first), unit), 10)
      if (i > first) ranges = ranges//" to "//to_string(from_si(positions%crank(i), unit), 10)
      first = 0
    end do
    if (len(ranges) == 0) return
    warning%text = "static divergence at speed "// &
      speed_in_words(model, speed, sweep%request%speed(speed))//", crank "//ranges// &
      " "//unit%name//": an eigenvalue is negative, and so is the frequency written"
  end function divergences

  !> Degrees, of a slider or a ram the unit of lengths.
  pure function unit_of_positions(model) result(unit)
    type(model_t), intent(in) :: model
    type(unit_t) :: unit

    unit%name = "deg"
    if (drives_length(model)) unit = table_unit("length", model%outputs)
  end function unit_of_positions

  !> `speed 20 rad/s, crank 45 deg`
  pure function place_of_row(model, sweep, crank, speed) result(place)
    type(model_t), intent(in) :: model
    type(sweep_t), intent(in) :: sweep
    real(wp), intent(in) :: crank !! [deg] or [m]
    integer, intent(in) :: speed  !! number
    character(len=:), allocatable :: place

    type(unit_t) :: unit

    unit = unit_of_positions(model)
    place = "speed "//speed_in_words(model, speed, sweep%request%speed(speed))//", crank "// &
      to_string(from_si(crank, unit), 12)//" "//unit%name
  end function place_of_row

  !> Whether the lowest eigenvalue at a position and speed is negative.
  pure function diverges(positions, sweep, position, speed)
    type(positions_t), intent(in) :: positions
    type(sweep_t), intent(in) :: sweep
    integer, intent(in) :: position, speed !! numbers
    logical :: diverges

    associate (state => positions%state(position))
      diverges = has_result(positions, sweep, state, speed)
      if (diverges) diverges = any(sweep%results(state)%lambda(:, speed) < 0.0_wp)
    end associate
  end function diverges

  !> The largest static deflection under the loads, if it is too large for the theory of the axial
  !! frequencies.
  pure function deflections(model, mechanism, positions, sweep) result(warning)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(positions_t), intent(in) :: positions
    type(sweep_t), intent(in) :: sweep
    type(warning_t) :: warning             !! without a text if there is none

    real(wp) :: largest
    integer :: i, body, speed, at_body, at_speed, at_position

    warning%kind = warning_of_deflection
    largest = 0.0_wp
    at_body = 1
    at_speed = 1
    at_position = 1
    do i = 1, size(positions%crank)
      if (allocated(positions%states(positions%state(i))%error)) cycle
      do speed = 1, size(sweep%request%speed)
        do body = 1, size(mechanism%names)
          ! With a tolerance, so that of equal positions (0 and 360) the first is named.
          if (sweep%results(positions%state(i))%deflection(body, &
            speed) <= largest*(1.0_wp + 1.0e-12_wp)) cycle
          largest = sweep%results(positions%state(i))%deflection(body, speed)
          at_body = body
          at_speed = speed
          at_position = i
        end do
      end do
    end do
    if (largest <= most_deflection) return
    warning%amount = largest
    warning%text = "the "//trim(merge("loads        ", "inertia loads", &
      sweep%request%constant))//" at "// &
      place_of_row(model, sweep, positions%crank(at_position), at_speed)//" deflect link '"// &
      mechanism%names(at_body)%text//"' by "//to_string(100.0_wp*largest, 3)// &
      " % of its length: "
    if (largest > impossible_deflection) then
      warning%grade = grade_meaningless
      warning%text = warning%text//"no link bends so far, and frequencies under these loads "// &
        "mean nothing"
    else
      warning%text = warning%text//"above "//to_string(100.0_wp*most_deflection)// &
        " % the axial frequencies become unreliable"
    end if
  end function deflections

  !> Number of rows with a frequency less accurate than requested, the worst of them, and what
  !! limits it there.
  pure function missed_accuracy(model, positions, sweep) result(warning)
    type(model_t), intent(in) :: model
    type(positions_t), intent(in) :: positions
    type(sweep_t), intent(in) :: sweep
    type(warning_t) :: warning             !! without a text if there is none

    real(wp) :: worst, error
    integer :: i, k, rows, at_position, at_speed

    warning%kind = warning_of_accuracy
    worst = 0.0_wp
    rows = 0
    at_position = 1
    at_speed = 1
    do i = 1, size(positions%crank)
      do k = 1, size(sweep%request%speed)
        if (.not. has_result(positions, sweep, positions%state(i), k)) cycle
        error = maxval(sweep%results(positions%state(i))%error(:, k))
        if (error <= sweep%request%accuracy) cycle
        rows = rows + 1
        if (error <= worst) cycle
        worst = error
        at_position = i
        at_speed = k
      end do
    end do
    if (rows == 0) return
    warning%amount = worst
    warning%text = "the accuracy "//to_string(sweep%request%accuracy)// &
      " is not reached in "//plural(rows, "row")//": the error is up to "//to_string(worst, 2)// &
      ", at "//place_of_row(model, sweep, positions%crank(at_position), at_speed)// &
      " ("//reason_of(sweep%results(positions%state(at_position))%cause(at_speed))//")"
  end function missed_accuracy

  !> The largest deflection of the elastic response, if it is too large for linear equations.
  pure function response_deflections(model, mechanism, response) result(warning)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(response_t), intent(in) :: response
    type(warning_t) :: warning !! without a text if there is none

    real(wp) :: largest
    integer :: body, speed

    warning%kind = warning_of_response_deflection
    call largest_deflection(response, link_lengths(mechanism), largest, body, speed)
    if (largest > most_deflection) call say_deflection("in the response at speed "// &
      speed_in_words(model, speed, model%speed%value(speed))//" link '"// &
      mechanism%names(body)%text, largest, "response", warning)
  end function response_deflections

  !> The same of motions in time.
  pure function transient_deflections(variant) result(warning)
    type(variant_results_t), intent(in) :: variant
    type(warning_t) :: warning !! without a text if there is none

    character(len=:), allocatable :: words
    real(wp) :: length(size(link_lengths(variant%mechanism))), largest
    integer :: body, k

    warning%kind = warning_of_transient_deflection
    length = link_lengths(variant%mechanism)
    largest = 0.0_wp
    words = ""
    do k = 1, size(variant%found%transient%at_speed)
      associate (found => variant%found%transient%at_speed(k))
        if (allocated(found%error) .or. .not. allocated(found%deflection)) cycle
        body = maxloc(found%deflection/length, dim=1)
        if (found%deflection(body) <= largest*length(body)) cycle
        largest = found%deflection(body)/length(body)
        words = "in the motion in time"
        if (.not. has_law(variant%model)) words = words//" at speed "// &
          speed_in_words(variant%model, k, variant%model%speed%value(k))
        words = words//" link '"//variant%mechanism%names(body)%text
      end associate
    end do
    if (largest > most_deflection) call say_deflection(words, largest, "motion", warning)
  end function transient_deflections

  !> That a deflection is too large for linear equations.
  pure subroutine say_deflection(place, largest, what, warning)
    character(len=*), intent(in) :: place !! the link, its name last
    real(wp), intent(in) :: largest       !! beside its length
    character(len=*), intent(in) :: what  !! that deflects it
    type(warning_t), intent(inout) :: warning

    warning%amount = largest
    warning%text = place//"' deflects by "//to_string(100.0_wp*largest, 3)//" % of its length: "
    if (largest > impossible_deflection) then
      warning%grade = grade_meaningless
      warning%text = warning%text//"no link bends so far, and this "//what//" means nothing"
    else
      warning%text = warning%text//"above "//to_string(100.0_wp*most_deflection)// &
        " % the linear equations become unreliable"
    end if
  end subroutine say_deflection

  !> Near resonances only damping limits the response.
  pure function no_damping_at_all(model) result(warning)
    type(model_t), intent(in) :: model
    type(warning_t) :: warning !! without a text if a link is damped, or none bends

    type(body_damping_t) :: dampings(size(model%links))
    integer :: i

    warning%kind = warning_of_no_damping
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

    warning%kind = warning_of_instability
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

  !> The speeds between which critical ones may be missed.
  pure function missed_critical_speeds(model, campbell) result(warning)
    type(model_t), intent(in) :: model
    type(campbell_t), intent(in) :: campbell
    type(warning_t) :: warning !! without a text if there is none

    integer, parameter :: most_named = 5
    real(wp) :: ends(2)
    integer :: i

    warning%kind = warning_of_gaps
    if (size(campbell%gap) == 0) return
    warning%amount = size(campbell%gap)
    warning%text = "critical speeds may be missed: multipliers cannot be followed"
    do i = 1, min(size(campbell%gap), most_named)
      ends = from_si(campbell%gap(i)%speed, model%outputs%rate)
      if (i > 1) warning%text = warning%text//","
      if (ends(2) > ends(1)) then
        warning%text = warning%text//" from "//to_string(ends(1), 6)//" to "// &
          to_string(ends(2), 6)
      else
        warning%text = warning%text//" near "//to_string(ends(1), 6)
      end if
    end do
    warning%text = warning%text//" "//model%outputs%rate%name
    if (size(campbell%gap) > most_named) warning%text = warning%text//", and elsewhere"
  end function missed_critical_speeds

  !> Harmonics that even the largest number of samples does not settle.
  pure function unsettled_harmonics(harmonics) result(warning)
    type(harmonics_result_t), intent(in) :: harmonics
    type(warning_t) :: warning !! without a text if they have settled

    warning%kind = warning_of_harmonics
    if (has_settled(harmonics)) return
    warning%amount = harmonics%change
    warning%text = "harmonics have not converged: with every second one of "// &
      to_string(harmonics%samples)//" samples they differ by "//to_string(harmonics%change, 2)// &
      " of the largest value; the crank passes close to a dead point, or the shaking force "// &
      "through zero"
  end function unsettled_harmonics

  !> The speeds at which the response is less accurate than requested, and the worst of them.
  pure function missed_response_accuracy(model, response) result(warning)
    type(model_t), intent(in) :: model
    type(response_t), intent(in) :: response
    type(warning_t) :: warning !! without a text if there is none

    integer :: k, worst, speeds

    warning%kind = warning_of_response_accuracy
    worst = 0
    speeds = 0
    do k = 1, size(response%at_speed)
      if (allocated(response%at_speed(k)%error)) cycle
      if (response%at_speed(k)%largest_error <= accuracy_of_study(model, "response")) cycle
      speeds = speeds + 1
      if (response%at_speed(k)%largest_error <= warning%amount) cycle
      worst = k
      warning%amount = response%at_speed(k)%largest_error
    end do
    if (speeds == 0) return
    warning%text = "the accuracy "//to_string(accuracy_of_study(model, "response"))// &
      " of the response is not reached at "//plural(speeds, "speed")//": the error is up to "// &
      to_string(warning%amount, 2)//", at "//speed_in_words(model, worst, &
      model%speed%value(worst))
  end function missed_response_accuracy

  !> What limits the accuracy of a row, in words.
  pure function reason_of(cause) result(text)
    integer, intent(in) :: cause
    character(len=:), allocatable :: text

    select case (cause)
    case (error_of_orders)
      text = "the highest polynomial orders cannot resolve such short waves"
    case (error_of_position)
      text = "so close to a dead point round-off leaves no more digits of the position"
    case (error_of_divergence)
      text = "near a divergence loads and stiffness nearly cancel, and digits are lost"
    case default
      text = "round-off in double precision leaves no more digits"
    end select
  end function reason_of

end module result_warnings
