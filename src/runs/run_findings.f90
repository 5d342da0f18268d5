!> What a run has to say besides its tables: rows that failed, and results that need a warning.
module run_findings
  use constants, only: degree
  use four_bar_limits, only: crank_reach, grashof_class, limit_angles, reach_t
  use kinds, only: wp
  use mechanisms, only: mechanism_t
  use models, only: model_t, needs_frequencies
  use motion_study, only: motion_failed, motion_failure, motion_run_t
  use poses, only: transmission_angle
  use positions, only: positions_t
  use sorting, only: ascending_order
  use sweeps, only: failure_at, sweep_t
  use text, only: append_string, plural, string_t, to_string
  use text_buffer, only: append_text, buffer_text, text_buffer_t
  use vibration_models, only: by_orders
  implicit none (type, external)
  private

  public :: findings_t, failure_t, find_failures, find_motion_failure, find_warnings, &
    add_findings, linkage_notes
  public :: findings_messages, findings_log

  !> A position without a result.
  type :: failure_t
    real(wp) :: crank = 0.0_wp     !! [deg]
    logical :: at_every_speed = .true. !! there is no pose
    real(wp) :: speed = 0.0_wp     !! where there is a pose, but there are no modes [rad/s]
    logical :: of_motion = .false. !! where REPORT motion comes to its end too soon
    real(wp) :: time = 0.0_wp      !! when [s]
    character(len=:), allocatable :: reason
    character(len=:), allocatable :: variant !! `L=90mm`, of a deck with VARY; else empty
    real(wp), allocatable :: varied(:)       !! the values of what varies
  end type failure_t

  type :: findings_t
    integer :: failures = 0                    !! positions without a pose, and positions × speeds
                                               !! without modes
    type(failure_t), allocatable :: failed(:)  !! (at least failures)
    integer :: warning_count = 0
    type(string_t), allocatable :: warnings(:) !! (at least warning_count)
  end type findings_t

  !> The axial frequencies assume that the loads bend the links little; this is the share of a
  !! link's length that is still little.
  real(wp), parameter :: most_deflection = 0.01_wp

  !> More warnings, or failed rows, than this are listed in the log only.
  integer, parameter :: most_shown = 20

  character(len=*), parameter :: line_feed = achar(10)

contains

  !> Collects every position and speed without a result.
  pure subroutine find_failures(model, positions, sweep, findings)
    type(model_t), intent(in) :: model
    type(positions_t), intent(in) :: positions
    type(sweep_t), intent(in) :: sweep !! empty if no frequencies are asked for
    type(findings_t), intent(inout) :: findings

    character(len=:), allocatable :: reason
    integer :: i, k

    do i = 1, size(positions%crank)
      if (allocated(positions%states(positions%state(i))%error)) then
        call add_failure(findings, model, positions%states(positions%state(i))%error%message, &
          positions%crank(i))
      else if (needs_frequencies(model)) then
        do k = 1, size(sweep%request%speed)
          reason = failure_at(positions, sweep, positions%state(i), k)
          if (len(reason) > 0) call add_failure(findings, model, reason, positions%crank(i), &
            sweep%request%speed(k))
        end do
      end if
    end do

  end subroutine find_failures

  !> Notes that a motion comes to its end too soon, if it does.
  pure subroutine find_motion_failure(model, motion, findings)
    type(model_t), intent(in) :: model
    type(motion_run_t), intent(in) :: motion
    type(findings_t), intent(inout) :: findings

    if (.not. motion_failed(motion)) return
    call add_failure(findings, model, motion_failure(motion), motion%last%angle(1))
    findings%failed(findings%failures)%of_motion = .true.
    findings%failed(findings%failures)%time = motion%last%time
  end subroutine find_motion_failure

  pure subroutine add_failure(findings, model, reason, crank, speed)
    type(findings_t), intent(inout) :: findings
    type(model_t), intent(in) :: model
    character(len=*), intent(in) :: reason
    real(wp), intent(in) :: crank           !! [deg]
    real(wp), intent(in), optional :: speed !! [rad/s]

    findings%failures = findings%failures + 1
    call make_room_for_failures(findings)
    associate (new => findings%failed(findings%failures))
      new%reason = reason
      new%crank = crank
      new%at_every_speed = .not. present(speed)
      if (present(speed)) new%speed = speed
      new%variant = model%variant
      new%varied = model%varied
    end associate
  end subroutine add_failure

  !> Sees that all failures have a place.
  pure subroutine make_room_for_failures(findings)
    type(findings_t), intent(inout) :: findings

    type(failure_t), allocatable :: larger(:)

    if (.not. allocated(findings%failed)) allocate (findings%failed(16))
    if (findings%failures <= size(findings%failed)) return
    allocate (larger(2*findings%failures))
    larger(:size(findings%failed)) = findings%failed
    call move_alloc(larger, findings%failed)
  end subroutine make_room_for_failures

  pure subroutine add_warnings(findings, variant, warnings)
    type(findings_t), intent(inout) :: findings
    character(len=*), intent(in) :: variant !! `L=90mm`, or empty
    type(string_t), intent(in) :: warnings(:)

    type(string_t), allocatable :: larger(:)
    integer :: i

    if (.not. allocated(findings%warnings)) allocate (findings%warnings(8))
    if (findings%warning_count + size(warnings) > size(findings%warnings)) then
      allocate (larger(2*(findings%warning_count + size(warnings))))
      larger(:findings%warning_count) = findings%warnings(:findings%warning_count)
      call move_alloc(larger, findings%warnings)
    end if
    do i = 1, size(warnings)
      findings%warnings(findings%warning_count + i)%text = of_variant(variant)//warnings(i)%text
    end do
    findings%warning_count = findings%warning_count + size(warnings)
  end subroutine add_warnings

  !> `L=90mm, `
  pure function of_variant(variant) result(phrase)
    character(len=*), intent(in) :: variant
    character(len=:), allocatable :: phrase

    phrase = ""
    if (len(variant) > 0) phrase = variant//", "
  end function of_variant

  !> Appends what was found in a variant to what was found in those before.
  pure subroutine add_findings(findings, more)
    type(findings_t), intent(inout) :: findings
    type(findings_t), intent(in) :: more

    integer :: i

    if (more%warning_count > 0) call add_warnings(findings, "", more%warnings(:more%warning_count))
    do i = 1, more%failures
      findings%failures = findings%failures + 1
      call make_room_for_failures(findings)
      findings%failed(findings%failures) = more%failed(i)
    end do
  end subroutine add_findings

  !> `speed 20 rad/s, crank 45 deg: reason`, or `motion, time 2.5 s, crank 45 deg: reason`
  pure function failure_line(failure) result(line)
    type(failure_t), intent(in) :: failure
    character(len=:), allocatable :: line

    if (failure%of_motion) then
      line = "motion, time "//to_string(failure%time, 12)//" s, "//at(failure%crank)//": "// &
        failure%reason//line_feed
    else if (failure%at_every_speed) then
      line = at(failure%crank)//": "//failure%reason//line_feed
    else
      line = at(failure%crank, failure%speed)//": "//failure%reason//line_feed
    end if
    line = of_variant(failure%variant)//line
  end function failure_line

  !> Collects divergences and large deflections.
  pure subroutine find_warnings(model, mechanism, positions, sweep, findings)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(positions_t), intent(in) :: positions
    type(sweep_t), intent(in) :: sweep
    type(findings_t), intent(inout) :: findings

    type(string_t), allocatable :: more(:)
    integer :: k

    ! Function results by themselves: as arguments gfortran 12 would lose their memory.
    if (.not. needs_frequencies(model)) return
    do k = 1, size(sweep%request%speed)
      more = divergences(positions, sweep, k)
      call add_warnings(findings, model%variant, more)
    end do
    if (sweep%request%axial) then
      more = deflections(mechanism, positions, sweep)
      call add_warnings(findings, model%variant, more)
    end if
    if (sweep%request%method == by_orders) then
      more = missed_accuracy(positions, sweep)
      call add_warnings(findings, model%variant, more)
    end if
  end subroutine find_warnings

  !> The crank angles at which an eigenvalue is negative at one speed, neighbours of the deck's list
  !! drawn together.
  pure function divergences(positions, sweep, speed) result(warning)
    type(positions_t), intent(in) :: positions
    type(sweep_t), intent(in) :: sweep
    integer, intent(in) :: speed !! number
    type(string_t), allocatable :: warning(:)

    character(len=:), allocatable :: ranges
    integer :: i, first

    allocate (warning(0))
    ranges = ""
    first = 0
    do i = 1, size(positions%crank)
      if (diverges(positions, sweep, i, speed) .and. first == 0) first = i
      if (first == 0) cycle
      if (i < size(positions%crank)) then
        if (diverges(positions, sweep, i + 1, speed)) cycle
      end if
      if (len(ranges) > 0) ranges = ranges//", "
      ranges = ranges//to_string(positions%crank(first), 10)
      if (i > first) ranges = ranges//" to "//to_string(positions%crank(i), 10)
      first = 0
    end do
    if (len(ranges) == 0) return
    call append_string(warning, "static divergence at speed "// &
      to_string(sweep%request%speed(speed), 10)//" rad/s, crank "//ranges// &
      " deg: an eigenvalue is negative, and so the frequency written")

  end function divergences

  !> Whether the lowest eigenvalue of a position and speed, both by number, is negative.
  pure function diverges(positions, sweep, position, speed)
    type(positions_t), intent(in) :: positions
    type(sweep_t), intent(in) :: sweep
    integer, intent(in) :: position, speed
    logical :: diverges

    diverges = .false.
    if (allocated(positions%states(positions%state(position))%error)) return
    associate (result => sweep%results(positions%state(position)))
      if (len(result%failure(speed)%text) == 0) diverges = result%lambda(1, speed) < 0.0_wp
    end associate
  end function diverges

  !> The largest static deflection under the loads, if it is too large for the theory.
  pure function deflections(mechanism, positions, sweep) result(warning)
    type(mechanism_t), intent(in) :: mechanism
    type(positions_t), intent(in) :: positions
    type(sweep_t), intent(in) :: sweep
    type(string_t), allocatable :: warning(:)

    real(wp) :: largest
    integer :: i, body, speed, at_body, at_speed, at_position

    allocate (warning(0))
    largest = 0.0_wp
    at_body = 1
    at_speed = 1
    at_position = 1
    do i = 1, size(positions%crank)
      if (allocated(positions%states(positions%state(i))%error)) cycle
      do speed = 1, size(sweep%request%speed)
        do body = 1, size(mechanism%names)
          ! A hair more, so that equal positions (0 and 360) name the first of them.
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
    call append_string(warning, "the "//trim(merge("loads        ", "inertia loads", &
      sweep%request%constant))//" at "// &
      at(positions%crank(at_position), sweep%request%speed(at_speed))//" deflect link '"// &
      mechanism%names(at_body)%text//"' by "//to_string(100.0_wp*largest, 3)// &
      " % of its length: above "//to_string(100.0_wp*most_deflection)// &
      " % the axial frequencies begin to mislead")
  end function deflections

  !> Where a frequency is not as accurate as the deck asks for, mostly because of rounding.
  pure function missed_accuracy(positions, sweep) result(warning)
    type(positions_t), intent(in) :: positions
    type(sweep_t), intent(in) :: sweep
    type(string_t), allocatable :: warning(:)

    real(wp) :: worst, error
    integer :: i, k, rows, at_position, at_speed

    allocate (warning(0))
    worst = 0.0_wp
    rows = 0
    at_position = 1
    at_speed = 1
    do i = 1, size(positions%crank)
      if (allocated(positions%states(positions%state(i))%error)) cycle
      associate (result => sweep%results(positions%state(i)))
        do k = 1, size(sweep%request%speed)
          if (len(result%failure(k)%text) > 0) cycle
          error = maxval(result%error(:, k))
          if (error <= sweep%request%accuracy) cycle
          rows = rows + 1
          if (error <= worst) cycle
          worst = error
          at_position = i
          at_speed = k
        end do
      end associate
    end do
    if (rows == 0) return
    call append_string(warning, "the accuracy "//to_string(sweep%request%accuracy)// &
      " is not reached in "//plural(rows, "row")//": the error is up to "//to_string(worst, 2)// &
      ", at "//at(positions%crank(at_position), sweep%request%speed(at_speed))// &
      " (near a dead point or a divergence digits are lost; the error columns tell how many)")
  end function missed_accuracy

  !> `speed 20 rad/s, crank 45 deg`
  pure function at(crank, speed) result(place)
    real(wp), intent(in) :: crank           !! [deg]
    real(wp), intent(in), optional :: speed !! [rad/s]
    character(len=:), allocatable :: place

    place = "crank "//to_string(crank, 12)//" deg"
    if (present(speed)) place = "speed "//to_string(speed, 12)//" rad/s, "//place
  end function at

  !> Everything for standard error, each line with the deck's path.
  pure function findings_messages(findings, path) result(text)
    type(findings_t), intent(in) :: findings
    character(len=*), intent(in) :: path
    character(len=:), allocatable :: text

    integer :: i

    text = ""
    do i = 1, min(findings%warning_count, most_shown)
      text = text//path//": warning: "//findings%warnings(i)%text//line_feed
    end do
    if (findings%warning_count > most_shown) then
      text = text//path//": "//to_string(findings%warning_count - most_shown)// &
        " more warnings; run.log lists them"//line_feed
    end if
    do i = 1, min(findings%failures, most_shown)
      text = text//path//": error: "//failure_line(findings%failed(i))
    end do
    if (findings%failures > most_shown) then
      text = text//path//": error: "//to_string(findings%failures - most_shown)// &
        " more rows failed; run.log lists them"//line_feed
    end if
  end function findings_messages

  !> The same for the log, complete and without the path.
  pure function findings_log(findings) result(text)
    type(findings_t), intent(in) :: findings
    character(len=:), allocatable :: text

    type(text_buffer_t) :: buffer
    integer :: i

    do i = 1, findings%warning_count
      call append_text(buffer, "warning: "//findings%warnings(i)%text//line_feed)
    end do
    if (findings%failures > 0) call append_text(buffer, "failed rows: "// &
      to_string(findings%failures)//line_feed)
    do i = 1, findings%failures
      call append_text(buffer, failure_line(findings%failed(i)))
    end do
    text = buffer_text(buffer)
  end function findings_log

  !> Grashof class, limit positions, extreme transmission angles: what to know of the linkage before
  !! its tables.
  pure function linkage_notes(mechanism, positions) result(notes)
    type(mechanism_t), intent(in) :: mechanism
    type(positions_t), intent(in) :: positions
    type(string_t), allocatable :: notes(:)

    type(reach_t) :: reach
    character(len=:), allocatable :: limits
    real(wp) :: angle, least, most
    real(wp), allocatable :: at_limits(:)
    integer :: i, at_least, at_most

    associate (ground => mechanism%linkage%ground_position(:, [1, 4]), &
      length => mechanism%linkage%bodies%length)
      reach = crank_reach(ground, length)
      call append_string(notes, grashof_class(norm2(ground(:, 2) - ground(:, 1)), length))
    end associate
    at_limits = modulo(limit_angles(reach), 360.0_wp)
    at_limits = at_limits(ascending_order(at_limits))
    limits = "limit positions of the crank: none"
    do i = 1, size(at_limits)
      if (i == 1) limits = "limit positions of the crank:"
      limits = limits//" "//to_string(at_limits(i), 9)
    end do
    if (size(at_limits) > 0) limits = limits//" deg"
    call append_string(notes, limits)

    least = huge(least)
    most = -1.0_wp
    at_least = 0
    at_most = 0
    do i = 1, size(positions%crank)
      associate (state => positions%states(positions%state(i)))
        if (allocated(state%error)) cycle
        angle = transmission_angle(mechanism%linkage, state%pose, 1)/degree
      end associate
      if (angle < least) at_least = i
      if (angle > most) at_most = i
      least = min(least, angle)
      most = max(most, angle)
    end do
    if (at_least == 0) return
    call append_string(notes, "transmission angle: "//to_string(least)//" deg at crank "// &
      to_string(positions%crank(at_least), 10)//" to "//to_string(most)//" deg at crank "// &
      to_string(positions%crank(at_most), 10))
  end function linkage_notes

end module run_findings
