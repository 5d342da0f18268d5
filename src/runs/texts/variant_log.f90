!> A computed variant in the log.
module variant_log
  use counterweight_notes, only: balance_log
  use linkage_notes, only: notes_on_linkage
  use motion_report, only: motion_log
  use response_notes, only: response_log
  use run_log, only: model_summary
  use run_statistics, only: sweep_summary
  use text, only: string_t
  use transient_report, only: transient_log
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: log_of_variant

  character(len=*), parameter :: line_feed = achar(10)

contains

  !> Model, notes on the linkage, motion, how its response and its frequencies were found.
  function log_of_variant(variant) result(text)
    type(variant_results_t), intent(in) :: variant !! computed
    character(len=:), allocatable :: text

    type(string_t), allocatable :: notes(:)
    integer :: i

    text = model_summary(variant%model, variant%mechanism)
    notes = notes_on_linkage(variant)
    do i = 1, size(notes)
      text = text//notes(i)%text//line_feed
    end do
    associate (found => variant%found)
      if (allocated(found%balance%partial)) text = text//balance_log(variant)
      if (allocated(found%motion%samples)) text = text//motion_log(variant)
      if (allocated(found%response%at_speed)) text = text//response_log(variant)
      if (allocated(found%transient%at_speed)) text = text//transient_log(variant)
      if (allocated(found%sweep%results)) text = text//sweep_summary(found%sweep, &
        variant%mechanism%mesh)
    end associate
  end function log_of_variant

end module variant_log
