!> What REPORT summary needs: all that the reports need which have its quantities.
module summary_needs
  use diagnostics, only: add_error, diagnostics_t
  use models, only: is_damped, model_t
  use natures, only: is_angular
  use report_kinds, only: kind_of_linkage, report_kind_t
  use report_cards, only: report_t
  use summary_quantities, only: quantity_kinds, quantity_name, quantity_t
  use text, only: to_string
  use tokens, only: token_t
  implicit none (type, external)
  private

  public :: take_needs, add_forces_of_drives

contains

  !> Finds the reports that have the quantities, and takes studies and needs from them. Errors: a
  !! quantity that only four-bars have, a mode beyond MODES, a damping ratio without dampers.
  pure subroutine take_needs(reports, model, four_bar, is_sound, diagnostics, report)
    type(report_kind_t), intent(in) :: reports(:)     !! all that exist
    type(model_t), intent(in) :: model                !! with its links and springs read
    logical, intent(in) :: four_bar                   !! its linkage is one
    logical, intent(in) :: is_sound                   !! the deck has no errors so far: the linkage
                                                      !! is what it seems to be
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(report_t), intent(inout) :: report           !! REPORT summary, as read

    integer :: i

    associate (summary => report%summary)
      allocate (summary%reports(size(summary%quantities)))
      summary%reports = ""
      do i = 1, size(summary%quantities)
        associate (kind => quantity_kinds(summary%quantities(i)%kind), word => summary%words(i))
          if (kind%of_four_bars .and. .not. four_bar) then
            if (is_sound) call add_error(diagnostics, word, "'"//trim(kind%name)//"' is made "// &
              "for four-bars only, so far: three links with two pins each, two ground pivots, "// &
              "and a driven link")
          else if (summary%quantities(i)%mode > model%modes) then
            call refuse_mode(model, summary%quantities(i), word, diagnostics)
          else if (kind%name == "zeta*" .and. .not. is_damped(model)) then
            call add_error(diagnostics, word, "'"//quantity_name(summary%quantities(i))// &
              "' is a damping ratio of modes with dampers, and there is no DAMPER card")
          else
            summary%reports(i) = kind%report
            call join(reports(kind_of_linkage(reports, trim(kind%report), four_bar)), report%kind)
            if (kind%report == "coordinates") call add_forces_of_drives(model, report%kind)
          end if
        end associate
      end do
    end associate

  end subroutine take_needs

  !> A report on coordinates needs forces, if a drive moves along one of them, or efforts act.
  pure subroutine add_forces_of_drives(model, kind)
    type(model_t), intent(in) :: model           !! with its drives
    type(report_kind_t), intent(inout) :: kind   !! of the report

    if (all(is_angular(model%drives%nature)) .and. size(model%actuators) == 0) return
    kind%masses = .true.
    if (index(kind%studies, "joints") == 0) kind%studies = trim(kind%studies)//" joints"
  end subroutine add_forces_of_drives

  !> Errors: a mode that is not asked for.
  pure subroutine refuse_mode(model, quantity, word, diagnostics)
    type(model_t), intent(in) :: model
    type(quantity_t), intent(in) :: quantity
    type(token_t), intent(in) :: word
    type(diagnostics_t), intent(inout) :: diagnostics

    character(len=:), allocatable :: message

    message = "'"//quantity_name(quantity)//"' is of mode "//to_string(quantity%mode)//", and "// &
      "MODES is "//to_string(model%modes)//"; expected MODES "//to_string(quantity%mode)
    if (model%modes_word%line > 0) then
      call add_error(diagnostics, word, message, model%modes_word, "given here")
    else
      call add_error(diagnostics, word, message)
    end if
  end subroutine refuse_mode

  !> Adds needs and study of a report to those of another. All that have quantities have one study,
  !! or none.
  pure subroutine join(source, kind)
    type(report_kind_t), intent(in) :: source
    type(report_kind_t), intent(inout) :: kind

    kind%masses = kind%masses .or. source%masses
    kind%weighs = kind%weighs .or. source%weighs
    kind%beams = kind%beams .or. source%beams
    kind%frequencies = kind%frequencies .or. source%frequencies
    kind%response = kind%response .or. source%response
    if (index(" "//kind%studies, " "//trim(source%studies)//" ") > 0) return
    kind%numbers = kind%numbers + source%numbers
    kind%studies = adjustl(trim(kind%studies)//" "//trim(source%studies))
  end subroutine join

end module summary_needs
