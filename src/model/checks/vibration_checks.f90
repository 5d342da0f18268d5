!> Whether frequencies and the elastic response can be found with the rigid links and the masses of
!! a deck.
module vibration_checks
  use bending_checks, only: check_bending
  use diagnostics, only: add_error, diagnostics_t
  use models, only: bends_links, model_t, needs_frequencies, needs_response, solver_band, &
    solver_dense
  use nodal_checks, only: check_nodal
  use text, only: lower_case, to_string
  implicit none (type, external)
  private

  public :: check_vibrations

contains

  !> Checks rigid links, masses and forces where beams are needed. Errors: those of `check_rigid`
  !! where all links are; rigid links with `SOLVER dense` or `band`; those of `check_bending` and
  !! `check_nodal`.
  pure subroutine check_vibrations(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(model_t), intent(in) :: model                !! whose masses have their links

    integer :: rigid

    if (.not. bends_links(model) .or. size(model%links) == 0) return
    if (all(model%links%rigid)) then
      call check_rigid(diagnostics, model)
      return
    end if
    if (.not. needs_frequencies(model) .and. .not. needs_response(model)) return
    rigid = 0
    if (needs_frequencies(model)) rigid = findloc(model%links%rigid, .true., dim=1)
    if (rigid > 0 .and. (model%solver == solver_dense .or. model%solver == solver_band)) then
      call add_error(diagnostics, model%solver_word, refusal_of(model), &
        model%links(rigid)%rigid_word, "this link is rigid")
    end if
    call check_bending(diagnostics, model)
    call check_nodal(diagnostics, model)
  end subroutine check_vibrations

  !> Checks a linkage of rigid links, which vibrates as far as its drives are free. Errors: none is,
  !! or a report is on links that bend; more modes than free drives; `SOLVER dense` or `band`.
  pure subroutine check_rigid(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    integer :: free, report

    free = count(model%drives%is_free)
    ! The last one is on the response of links that bend, or on frequencies.
    report = findloc(model%reports%kind%response .or. model%reports%kind%beams .and. free == 0, &
      .true., dim=1, back=.true.)
    if (report > 0) then
      call add_error(diagnostics, model%reports(report)%keyword, "all links are rigid: nothing "// &
        "bends"//trim(merge("                      ", ", and no drive is free", &
        model%reports(report)%kind%response)), model%links(1)%rigid_word, "the first rigid link")
    else if (model%modes > free) then
      call add_error(diagnostics, model%modes_word, "rigid links have as many modes as there "// &
        "are free drives, "//to_string(free)//", not "//to_string(model%modes))
    else if (any(model%solver == [solver_dense, solver_band])) then
      call add_error(diagnostics, model%solver_word, refusal_of(model), &
        model%links(1)%rigid_word, "this link is rigid")
    end if
  end subroutine check_rigid

  !> Why a solver is refused beside rigid links.
  pure function refusal_of(model) result(text)
    type(model_t), intent(in) :: model
    character(len=:), allocatable :: text

    text = "SOLVER "//lower_case(model%solver_word%text)//" does not take rigid links; "// &
      "expected SOLVER auto or deformation"
  end function refusal_of

end module vibration_checks
