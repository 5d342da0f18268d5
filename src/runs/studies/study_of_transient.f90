!> Elastic motions in time at all speeds.
module study_of_transient
  use full_turns, only: turns_fully
  use kinds, only: wp
  use mechanisms, only: link_lengths, mechanism_t
  use models, only: has_gauge_histories, has_law, model_t, report_number, speed_in_words
  use named_parts, only: name_outcomes
  use run_findings, only: findings_t
  use study_findings, only: judge_deflection, most_deflection, note_failure, note_warning
  use study_of_response, only: add_places, response_request_of
  use study_keepers, only: kept_transient, study_keeper_t
  use study_types, only: add_study, study_t, variant_run_t
  use transient_responses, only: find_transients
  use transient_types, only: from_rest, from_steady, transient_request_t
  use variant_results, only: variant_results_t
  use warnings, only: warning_t
  implicit none (type, external)
  private

  public :: add_transient_study

  character(len=*), parameter :: study_name = "transient"

contains

  !> Appends the study of this file.
  subroutine add_transient_study(list)
    type(study_t), allocatable, intent(inout) :: list(:) !! to which they are appended

    call add_study(list, study_t(study_name, keeps=.true., compute=compute_transient, &
      add_failures=add_transient_failures, add_warnings=add_transient_warnings))
  end subroutine add_transient_study

  subroutine compute_transient(run)
    type(variant_run_t), intent(inout), target :: run

    type(study_keeper_t) :: keeper

    keeper = study_keeper_t(run%journal, run%group, kept_transient)
    associate (variant => run%results, transient => run%results%found%transient)
      call find_transients(variant%mechanism%structure_t, transient_request_of(variant%model, &
        variant%mechanism), run%store, transient, keeper)
      call name_outcomes(variant, transient%at_speed)
    end associate
  end subroutine compute_transient

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
        request%turns_fully = turns_fully(mechanism%linkage, through=.false.)
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

  pure subroutine add_transient_failures(variant, findings)
    type(variant_results_t), intent(in) :: variant
    type(findings_t), intent(inout) :: findings

    integer :: k, speed

    if (.not. allocated(variant%found%transient%at_speed)) return
    do k = 1, size(variant%found%transient%at_speed)
      speed = merge(0, k, has_law(variant%model))
      associate (motion => variant%found%transient%at_speed(k))
        if (allocated(motion%error)) call note_failure(variant, study_name, motion%error, &
          findings, speed=speed)
        if (allocated(motion%strain_fault)) call note_failure(variant, study_name, &
          motion%strain_fault, findings, speed=speed)
      end associate
    end do
  end subroutine add_transient_failures

  pure subroutine add_transient_warnings(variant, findings)
    type(variant_results_t), intent(in) :: variant
    type(findings_t), intent(inout) :: findings

    type(warning_t) :: warning

    warning = deflections(variant)
    call note_warning(variant, study_name, warning, findings)
  end subroutine add_transient_warnings

  !> The largest deflection, if it is too large for linear equations.
  pure function deflections(variant) result(warning)
    type(variant_results_t), intent(in) :: variant
    type(warning_t) :: warning !! without a text if there is none

    character(len=:), allocatable :: words
    real(wp) :: length(size(link_lengths(variant%mechanism))), largest
    integer :: body, k

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
        words = words//" link '"//variant%mechanism%names(body)%text//"' deflects"
      end associate
    end do
    if (largest <= most_deflection) return
    warning%text = words
    call judge_deflection(largest, "this motion means", "linear equations", warning)
  end function deflections

end module study_of_transient
