!> Rows of a variant that could not be computed.
module result_failures
  use errors, only: error_of_input, error_of_numerics, error_of_reach, error_t, set_error
  use friction_words, only: lock_words
  use frequency_study, only: has_result
  use joints_report, only: open_words
  use kinds, only: wp
  use locked_rows, only: is_locked_at, lock_at
  use models, only: drives_length, has_law, needs_frequencies, report_number, speed_in_words
  use motion_study, only: undetermined_message
  use run_findings, only: add_failure, at_forces, at_frequencies, at_instant, at_position, &
    failure_t, findings_t, in_campbell, in_intervals, in_motion, in_response, in_stability, &
    in_transient, of_variant
  use stability_types, only: gap_t
  use table_columns, only: table_unit
  use text, only: to_string
  use units, only: from_si, unit_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: find_failures

contains

  !> Appends every position, position and speed, or speed of a response or transient,
  !! without a result, and a motion that ended too soon; or the variant as a whole, if its linkage
  !! closes at no crank angle, or its crank does not turn fully and BALANCE needs that.
  pure subroutine find_failures(variant, findings)
    type(variant_results_t), intent(in) :: variant !! computed
    type(findings_t), intent(inout) :: findings    !! to which they are appended

    type(error_t), allocatable :: error
    integer :: i, k

    if (.not. variant%found%class%reach%closes) then
      call set_error(error, error_of_reach, variant%unreachable)
      call note_failure(variant, of_variant, error, 0.0_wp, 0, 0.0_wp, findings)
      return
    end if
    associate (found => variant%found, crank => variant%found%positions%crank)
      do i = 1, size(crank)
        associate (state => found%positions%state(i))
          if (allocated(found%positions%states(state)%error) .and. has_law(variant%model)) then
            call note_failure(variant, at_instant, found%positions%states(state)%error, &
              crank(i), 0, variant%model%time%value(i), findings)
          else if (allocated(found%positions%states(state)%error)) then
            call note_failure(variant, at_position, found%positions%states(state)%error, &
              crank(i), 0, 0.0_wp, findings, i)
          else if (needs_frequencies(variant%model)) then
            do k = 1, size(found%sweep%request%speed)
              if (has_result(found%positions, found%sweep, state, k)) cycle
              call note_failure(variant, at_frequencies, &
                found%sweep%results(state)%outcome(k)%error, crank(i), k, 0.0_wp, findings)
            end do
          end if
          if (.not. allocated(found%positions%states(state)%error)) then
            call note_locks(variant, i, findings)
            call note_open(variant, i, findings)
          end if
        end associate
      end do
      if (allocated(found%geometry%outcome)) then
        do i = 1, size(found%geometry%crank)
          if (allocated(found%geometry%outcome(i)%error)) call note_failure(variant, at_position, &
            found%geometry%outcome(i)%error, found%geometry%crank(i), 0, 0.0_wp, findings)
        end do
      end if
      if (allocated(found%sizing%error)) then
        if (found%sizing%period > 0.0_wp) then
          call note_failure(variant, at_position, found%sizing%error, found%sizing%error_crank, 0, &
            0.0_wp, findings)
        else
          call note_failure(variant, of_variant, found%sizing%error, 0.0_wp, 0, 0.0_wp, findings)
        end if
      end if
      if (allocated(found%harmonics%error)) call note_failure(variant, at_position, &
        found%harmonics%error, found%harmonics%error_crank, 0, 0.0_wp, findings)
      if (allocated(found%balance%partial)) then
        if (allocated(found%balance%partial%error)) call note_failure(variant, of_variant, &
          found%balance%partial%error, 0.0_wp, 0, 0.0_wp, findings)
      end if
      if (allocated(found%response%at_speed)) then
        do k = 1, size(found%response%at_speed)
          if (allocated(found%response%at_speed(k)%error)) call note_failure(variant, in_response, &
            found%response%at_speed(k)%error, 0.0_wp, k, 0.0_wp, findings)
        end do
      end if
      if (allocated(found%stability%at_speed)) then
        do k = 1, size(found%stability%at_speed)
          if (allocated(found%stability%at_speed(k)%error)) call note_failure(variant, &
            in_stability, found%stability%at_speed(k)%error, 0.0_wp, k, 0.0_wp, findings)
        end do
      end if
      if (allocated(found%intervals%gap)) then
        do k = 1, size(found%intervals%gap)
          call note_gap(variant, found%intervals%gap(k), findings)
        end do
      end if
      if (allocated(found%campbell%at_speed)) then
        do k = 1, size(found%campbell%at_speed)
          if (allocated(found%campbell%at_speed(k)%error)) call note_failure(variant, &
            in_campbell, found%campbell%at_speed(k)%error, 0.0_wp, k, 0.0_wp, findings)
        end do
      end if
      if (allocated(found%transient%at_speed)) then
        do k = 1, size(found%transient%at_speed)
          associate (motion => found%transient%at_speed(k), &
              speed => merge(0, k, has_law(variant%model)))
            if (allocated(motion%error)) call note_failure(variant, in_transient, motion%error, &
              0.0_wp, speed, 0.0_wp, findings)
            if (allocated(motion%strain_fault)) call note_failure(variant, in_transient, &
              motion%strain_fault, 0.0_wp, speed, 0.0_wp, findings)
          end associate
        end do
      end if
      if (allocated(found%sizing%is_open)) then
        i = findloc(found%sizing%is_open, .true., dim=1)
        if (i > 0) then
          call set_error(error, error_of_input, open_words(variant, found%sizing%joints(i)))
          call note_failure(variant, of_variant, error, 0.0_wp, 0, 0.0_wp, findings)
        end if
      end if
      call note_undetermined(variant, findings)
      if (allocated(found%motion%error)) call note_failure(variant, in_motion, found%motion%error, &
        found%motion%last%angle(1), 0, found%motion%last%time, findings)
      if (allocated(found%linkage_motion%error)) call note_failure(variant, in_motion, &
        found%linkage_motion%error, last_crank(variant), 0, &
        found%linkage_motion%last%time, findings)
    end associate
  end subroutine find_failures

  !> Speeds at which friction locks the linkage at a position.
  pure subroutine note_locks(variant, position, findings)
    type(variant_results_t), intent(in) :: variant
    integer, intent(in) :: position !! number in the deck's list, with a pose
    type(findings_t), intent(inout) :: findings

    type(error_t), allocatable :: error
    integer :: k

    do k = 1, size(variant%model%speed%value)
      if (.not. is_locked_at(variant, "", position, k)) cycle
      call set_error(error, error_of_numerics, lock_words(variant%model, variant%mechanism, &
        lock_at(variant, "", position, k)))
      if (has_law(variant%model)) then
        call note_failure(variant, at_instant, error, variant%found%positions%crank(position), 0, &
          variant%model%time%value(position), findings)
      else
        call note_failure(variant, at_forces, error, variant%found%positions%crank(position), k, &
          0.0_wp, findings)
      end if
    end do
  end subroutine note_locks

  !> A position at which rigid links alone hold each other, and some forces are open.
  pure subroutine note_open(variant, position, findings)
    type(variant_results_t), intent(in) :: variant
    integer, intent(in) :: position !! number in the deck's list, with a pose
    type(findings_t), intent(inout) :: findings

    type(error_t), allocatable :: error
    integer :: i

    if (max(report_number(variant%model, "reactions"), report_number(variant%model, &
      "bearings")) == 0) return
    associate (found => variant%found%joints, positions => variant%found%positions)
      if (.not. allocated(found%is_open)) return
      i = findloc(found%is_open(:, positions%state(position)), .true., dim=1)
      if (i == 0) return
      call set_error(error, error_of_input, open_words(variant, found%joints(i)))
      if (has_law(variant%model)) then
        call note_failure(variant, at_instant, error, positions%crank(position), 0, &
          variant%model%time%value(position), findings)
      else
        call note_failure(variant, at_position, error, positions%crank(position), 0, 0.0_wp, &
          findings)
      end if
    end associate
  end subroutine note_open

  !> Instants of a motion without the accelerations and forces that its card asks for.
  pure subroutine note_undetermined(variant, findings)
    type(variant_results_t), intent(in) :: variant
    type(findings_t), intent(inout) :: findings

    type(error_t), allocatable :: error
    integer :: i

    call set_error(error, error_of_numerics, undetermined_message)
    associate (motion => variant%found%motion, linkage_motion => variant%found%linkage_motion)
      if (allocated(motion%is_determined)) then
        do i = 1, motion%count
          if (.not. motion%is_determined(i)) call note_failure(variant, in_motion, error, &
            motion%samples(i)%angle(1), 0, motion%samples(i)%time, findings)
        end do
      end if
      if (allocated(linkage_motion%is_determined)) then
        do i = 1, linkage_motion%count
          if (.not. linkage_motion%is_determined(i)) call note_failure(variant, in_motion, error, &
            linkage_motion%samples(i)%position(1), 0, linkage_motion%samples(i)%time, findings)
        end do
      end if
      if (allocated(linkage_motion%is_open)) then
        i = findloc(any(linkage_motion%is_open(:, :linkage_motion%count), dim=1), .true., dim=1)
        if (i > 0) then
          call set_error(error, error_of_input, open_words(variant, linkage_motion%joints(findloc( &
            linkage_motion%is_open(:, i), .true., dim=1))))
          call note_failure(variant, in_motion, error, linkage_motion%samples(i)%position(1), 0, &
            linkage_motion%samples(i)%time, findings)
        end if
      end if
    end associate
  end subroutine note_undetermined

  !> Where the first drive was at last: at the start, if the motion has not begun [deg] or [m].
  pure function last_crank(variant) result(crank)
    type(variant_results_t), intent(in) :: variant !! with a motion
    real(wp) :: crank

    crank = variant%model%reports(report_number(variant%model, "motion"))%start_angle
    associate (motion => variant%found%linkage_motion)
      if (allocated(motion%last%position)) crank = motion%last%position(1)
    end associate
  end function last_crank

  pure subroutine note_failure(variant, stage, error, crank, speed, time, findings, position)
    type(variant_results_t), intent(in) :: variant
    integer, intent(in) :: stage     !! one of those of `run_findings`
    type(error_t), intent(in) :: error
    real(wp), intent(in) :: crank    !! [deg] or [m]
    integer, intent(in) :: speed     !! number in the list of the sweep, of a response in that of
                                     !! the deck; 0: none
    real(wp), intent(in) :: time     !! [s]
    type(findings_t), intent(inout) :: findings
    integer, intent(in), optional :: position !! number in the deck's list

    type(failure_t) :: failure
    type(unit_t) :: unit

    failure%stage = stage
    if (present(position)) failure%position = position
    failure%crank = crank
    if (drives_length(variant%model)) then
      unit = table_unit("length", variant%model%outputs)
      failure%crank_words = to_string(from_si(crank, unit), 12)//" "//unit%name
    end if
    failure%speed_words = ""
    if (speed > 0) then
      failure%speed = variant%model%speed%value(speed)
      if (stage == at_frequencies) failure%speed = variant%found%sweep%request%speed(speed)
      failure%speed_words = speed_in_words(variant%model, speed, failure%speed)
    end if
    failure%time = time
    failure%error = error
    failure%variant = variant%model%variant
    failure%varied = variant%model%varied
    call add_failure(findings, failure)
  end subroutine note_failure

  !> Speeds at which intervals could not be found.
  pure subroutine note_gap(variant, gap, findings)
    type(variant_results_t), intent(in) :: variant
    type(gap_t), intent(in) :: gap
    type(findings_t), intent(inout) :: findings

    type(failure_t) :: failure

    failure%stage = in_intervals
    failure%speed = gap%from
    associate (rate => variant%model%outputs%rate)
      failure%speed_words = to_string(from_si(gap%from, rate), 6)//" to "// &
        to_string(from_si(gap%to, rate), 6)//" "//rate%name
    end associate
    failure%error = gap%error
    failure%variant = variant%model%variant
    failure%varied = variant%model%varied
    call add_failure(findings, failure)
  end subroutine note_gap

end module result_failures
