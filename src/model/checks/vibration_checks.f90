!> Whether frequencies and the elastic response can be found with the rigid links and the masses of
!! a deck.
module vibration_checks
  use bending_checks, only: check_bending
  use diagnostics, only: add_error, diagnostics_t
  use models, only: bends_links, model_t, needs_frequencies, needs_response, solver_band, &
    solver_dense
  use nodal_checks, only: check_nodal
  use text, only: lower_case
  implicit none (type, external)
  private

  public :: check_vibrations

contains

  !> Checks rigid links, masses and forces where beams are needed. Errors: all links rigid; rigid
  !! links with `SOLVER dense` or `band`; those of `check_bending` and `check_nodal`.
  pure subroutine check_vibrations(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(model_t), intent(in) :: model                !! whose masses have their links

    integer :: report, rigid

    if (.not. bends_links(model) .or. size(model%links) == 0) return
    if (all(model%links%rigid)) then
      report = findloc(model%reports%kind%beams .or. model%reports%kind%response, .true., dim=1, &
        back=.true.)
      call add_error(diagnostics, model%reports(report)%keyword, &
        "all links are rigid: nothing bends", model%links(1)%rigid_word, "the first rigid link")
      return
    end if
    if (.not. needs_frequencies(model) .and. .not. needs_response(model)) return
    rigid = 0
    if (needs_frequencies(model)) rigid = findloc(model%links%rigid, .true., dim=1)
    if (rigid > 0 .and. (model%solver == solver_dense .or. model%solver == solver_band)) then
      call add_error(diagnostics, model%solver_word, &
        "SOLVER "//lower_case(model%solver_word%text)//" does not take rigid links; "// &
        "expected SOLVER auto or deformation", model%links(rigid)%rigid_word, "this link is rigid")
    end if
    call check_bending(diagnostics, model)
    call check_nodal(diagnostics, model)
  end subroutine check_vibrations

end module vibration_checks
