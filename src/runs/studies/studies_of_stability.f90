!> Stability of running elastic linkages: exponents, intervals of instability, Campbell diagrams.
module studies_of_stability
  use campbell_study, only: find_campbell_of
  use elastic_requests, only: link_dampings_of, terms_of
  use errors, only: error_t
  use kinds, only: wp
  use mechanisms, only: mechanism_t
  use models, only: accuracy_of_study, model_t, report_number
  use named_parts, only: name_outcomes, name_parts
  use run_findings, only: failure_t, findings_t
  use stability_study, only: find_intervals_of, find_stability_of
  use stability_types, only: stability_request_t
  use study_findings, only: note_failed_speeds, note_failure_here, note_warning
  use study_keepers, only: kept_campbell, kept_intervals, kept_stability, study_keeper_t
  use study_types, only: add_study, study_t, variant_run_t
  use text, only: to_string
  use units, only: from_si
  use variant_results, only: variant_results_t
  use warnings, only: warning_t
  implicit none (type, external)
  private

  public :: add_stability_studies
  public :: stability_request_of, campbell_request_of

contains

  !> Appends the studies of this file.
  subroutine add_stability_studies(list)
    type(study_t), allocatable, intent(inout) :: list(:) !! to which they are appended

    call add_study(list, study_t("stability", keeps=.true., compute=compute_stability, &
      add_failures=add_stability_failures))
    call add_study(list, study_t("intervals", keeps=.true., compute=compute_intervals, &
      add_failures=add_intervals_failures))
    call add_study(list, study_t("campbell", keeps=.true., compute=compute_campbell, &
      add_failures=add_campbell_failures, add_warnings=add_campbell_warnings))
  end subroutine add_stability_studies

  subroutine compute_stability(run)
    type(variant_run_t), intent(inout), target :: run

    type(study_keeper_t) :: keeper

    keeper = study_keeper_t(run%journal, run%group, kept_stability)
    associate (variant => run%results, stability => run%results%found%stability)
      call find_stability_of(variant%mechanism%structure_t, stability_request_of(variant%model, &
        variant%mechanism), run%threads, run%store, stability, keeper)
      call name_outcomes(variant, stability%at_speed)
    end associate
  end subroutine compute_stability

  pure subroutine add_stability_failures(variant, findings)
    type(variant_results_t), intent(in) :: variant
    type(findings_t), intent(inout) :: findings

    if (allocated(variant%found%stability%at_speed)) call note_failed_speeds(variant, "stability", &
      variant%found%stability%at_speed, findings)
  end subroutine add_stability_failures

  subroutine compute_intervals(run)
    type(variant_run_t), intent(inout), target :: run

    type(study_keeper_t) :: keeper
    type(error_t), allocatable :: error
    integer :: k

    keeper = study_keeper_t(run%journal, run%group, kept_intervals)
    associate (variant => run%results, intervals => run%results%found%intervals)
      call find_intervals_of(variant%mechanism%structure_t, intervals_request_of(variant%model, &
        variant%mechanism), run%threads, run%store, intervals, keeper)
      do k = 1, size(intervals%gap)
        error = intervals%gap(k)%error
        call name_parts(variant, error)
        intervals%gap(k)%error = error
      end do
    end associate
  end subroutine compute_intervals

  !> Speeds at which intervals could not be found.
  pure subroutine add_intervals_failures(variant, findings)
    type(variant_results_t), intent(in) :: variant
    type(findings_t), intent(inout) :: findings

    type(failure_t) :: failure
    integer :: k

    if (.not. allocated(variant%found%intervals%gap)) return
    do k = 1, size(variant%found%intervals%gap)
      associate (gap => variant%found%intervals%gap(k), rate => variant%model%outputs%rate)
        failure%stage = "intervals"
        failure%speed = gap%from
        failure%speed_words = "speeds "//to_string(from_si(gap%from, rate), 6)//" to "// &
          to_string(from_si(gap%to, rate), 6)//" "//rate%name
        failure%error = gap%error
      end associate
      call note_failure_here(variant, failure, findings)
    end do
  end subroutine add_intervals_failures

  subroutine compute_campbell(run)
    type(variant_run_t), intent(inout), target :: run

    type(study_keeper_t) :: keeper

    keeper = study_keeper_t(run%journal, run%group, kept_campbell)
    associate (variant => run%results, campbell => run%results%found%campbell)
      call find_campbell_of(variant%mechanism%structure_t, campbell_request_of(variant%model, &
        variant%mechanism), run%threads, run%store, campbell, keeper)
      call name_outcomes(variant, campbell%at_speed)
    end associate
  end subroutine compute_campbell

  pure subroutine add_campbell_failures(variant, findings)
    type(variant_results_t), intent(in) :: variant
    type(findings_t), intent(inout) :: findings

    if (allocated(variant%found%campbell%at_speed)) call note_failed_speeds(variant, "campbell", &
      variant%found%campbell%at_speed, findings)
  end subroutine add_campbell_failures

  pure subroutine add_campbell_warnings(variant, findings)
    type(variant_results_t), intent(in) :: variant
    type(findings_t), intent(inout) :: findings

    type(warning_t) :: warning

    warning = missed_critical_speeds(variant)
    call note_warning(variant, "campbell", warning, findings)
  end subroutine add_campbell_warnings

  !> The speeds between which critical ones may be missed.
  pure function missed_critical_speeds(variant) result(warning)
    type(variant_results_t), intent(in) :: variant
    type(warning_t) :: warning !! without a text if there is none

    integer, parameter :: most_named = 5
    real(wp) :: ends(2)
    integer :: i

    if (size(variant%found%campbell%gap) == 0) return
    warning%amount = size(variant%found%campbell%gap)
    warning%text = "critical speeds may be missed: multipliers cannot be followed"
    do i = 1, min(size(variant%found%campbell%gap), most_named)
      ends = from_si(variant%found%campbell%gap(i)%speed, variant%model%outputs%rate)
      if (i > 1) warning%text = warning%text//","
      if (ends(2) > ends(1)) then
        warning%text = warning%text//" from "//to_string(ends(1), 6)//" to "// &
          to_string(ends(2), 6)
      else
        warning%text = warning%text//" near "//to_string(ends(1), 6)
      end if
    end do
    warning%text = warning%text//" "//variant%model%outputs%rate%name
    if (size(variant%found%campbell%gap) > most_named) warning%text = warning%text// &
      ", and elsewhere"
  end function missed_critical_speeds

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

end module studies_of_stability
