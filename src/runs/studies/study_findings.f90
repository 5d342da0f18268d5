!> Failures and warnings of studies: what all of them have in common.
module study_findings
  use drive_motions, only: first_position
  use errors, only: error_t, outcome_t
  use coordinate_columns, only: shown_unit
  use kinds, only: wp
  use models, only: has_law, model_t, nature_of_positions, speed_in_words
  use run_findings, only: add_failure, add_warning_of_run, failure_t, findings_t
  use text, only: to_string
  use units, only: dimension_time, from_si, unit_t
  use value_words, only: in_words
  use variant_results, only: variant_results_t
  use warnings, only: grade_meaningless, warning_t
  implicit none (type, external)
  private

  public :: note_failure, note_failed_speeds, note_at_position, note_failure_here, note_warning
  public :: most_deflection, judge_deflection, unit_of_positions

  !> Largest deflection without a warning, relative to the link's length: equations assume that
  !! links bend little [-].
  real(wp), parameter :: most_deflection = 0.01_wp

  !> Deflection, relative to the link's length, beyond which results mean nothing: no link can be
  !! bent so far [-].
  real(wp), parameter :: impossible_deflection = 1.0_wp

contains

  !> Appends a failure of a variant as a whole, or at some of a position, a speed, an instant.
  pure subroutine note_failure(variant, stage, error, findings, crank, speed, time, position)
    type(variant_results_t), intent(in) :: variant
    character(len=*), intent(in) :: stage       !! as of `failure_t`
    type(error_t), intent(in) :: error          !! why
    type(findings_t), intent(inout) :: findings !! to which it is appended
    real(wp), intent(in), optional :: crank     !! [deg] or [m]
    integer, intent(in), optional :: speed      !! number in the deck's list; 0: none
    real(wp), intent(in), optional :: time      !! [s]
    integer, intent(in), optional :: position   !! number in the deck's list: told together with
                                                !! neighbours of the same kind

    type(failure_t) :: failure

    failure%stage = stage
    failure%error = error
    if (present(position)) failure%position = position
    if (present(crank)) failure%crank = crank
    if (present(time)) failure%time = time
    if (present(speed)) then
      if (speed > 0) then
        failure%speed = variant%model%speed%value(speed)
        failure%speed_words = "speed "//speed_in_words(variant%model, speed, failure%speed)
      end if
    end if
    call note_failure_here(variant, failure, findings)
  end subroutine note_failure

  !> Appends the speeds at which a study has no result.
  pure subroutine note_failed_speeds(variant, study, outcomes, findings)
    type(variant_results_t), intent(in) :: variant
    character(len=*), intent(in) :: study        !! its name
    class(outcome_t), intent(in) :: outcomes(:)  !! (speeds)
    type(findings_t), intent(inout) :: findings  !! to which they are appended

    integer :: k

    do k = 1, size(outcomes)
      if (allocated(outcomes(k)%error)) call note_failure(variant, study, outcomes(k)%error, &
        findings, speed=k)
    end do
  end subroutine note_failed_speeds

  !> Appends a failure at a position of the deck's list; with a law, at an instant of it.
  pure subroutine note_at_position(variant, position, error, findings)
    type(variant_results_t), intent(in) :: variant
    integer, intent(in) :: position             !! number
    type(error_t), intent(in) :: error          !! why
    type(findings_t), intent(inout) :: findings !! to which it is appended

    associate (crank => first_position(variant%model, position))
      if (has_law(variant%model)) then
        call note_failure(variant, "position", error, findings, crank=crank, &
          time=variant%model%time%value(position))
      else
        call note_failure(variant, "position", error, findings, crank=crank)
      end if
    end associate
  end subroutine note_at_position

  !> Appends a failure that has its place, and adds the variant.
  pure subroutine note_failure_here(variant, failure, findings)
    type(variant_results_t), intent(in) :: variant
    type(failure_t), intent(inout) :: failure   !! on return with the words of its place
    type(findings_t), intent(inout) :: findings !! to which it is appended

    type(unit_t) :: unit

    if (allocated(failure%crank)) then
      unit = unit_of_positions(variant%model)
      failure%crank_words = to_string(from_si(failure%crank, unit), 12)//" "//unit%name
    end if
    if (allocated(failure%time)) failure%time_words = in_words(failure%time, dimension_time, &
      variant%model%units, 12)
    failure%variant = variant%model%variant
    failure%varied = variant%model%varied
    call add_failure(findings, failure)
  end subroutine note_failure_here

  !> Appends a warning of a study, if it has a text.
  pure subroutine note_warning(variant, study, warning, findings)
    type(variant_results_t), intent(in) :: variant
    character(len=*), intent(in) :: study       !! its name
    type(warning_t), intent(inout) :: warning   !! its kind is one of those of the study
    type(findings_t), intent(inout) :: findings !! to which it is appended

    if (.not. allocated(warning%text)) return
    warning%study = study
    warning%variant = variant%model%variant
    call add_warning_of_run(findings, warning)
  end subroutine note_warning

  !> Says how large a deflection is, and what follows.
  pure subroutine judge_deflection(largest, results, equations, warning)
    real(wp), intent(in) :: largest           !! relative to the link's length, above
                                              !! `most_deflection` [-]
    character(len=*), intent(in) :: results   !! `this response means`
    character(len=*), intent(in) :: equations !! what becomes unreliable
    type(warning_t), intent(inout) :: warning !! its text is of the place so far

    warning%amount = largest
    warning%text = warning%text//" by "//to_string(100.0_wp*largest, 3)//" % of its length: "
    if (largest > impossible_deflection) then
      warning%grade = grade_meaningless
      warning%text = warning%text//"no link bends so far, and "//results//" nothing"
    else
      warning%text = warning%text//"above "//to_string(100.0_wp*most_deflection)//" % the "// &
        equations//" become unreliable"
    end if
  end subroutine judge_deflection

  !> Degrees, of a slider or a ram the unit of lengths.
  pure function unit_of_positions(model) result(unit)
    type(model_t), intent(in) :: model !! with its drives
    type(unit_t) :: unit

    unit = shown_unit(nature_of_positions(model), model%outputs)
  end function unit_of_positions

end module study_findings
