!> Whether frequencies and the elastic response can be found with the rigid links and the masses of
!! a deck.
module vibration_checks
  use diagnostics, only: add_error, diagnostics_t
  use kinds, only: wp
  use models, only: bends_links, model_t, needs_frequencies, needs_response, solver_band, &
    solver_dense
  use process_cards, only: process_force
  use text, only: lower_case
  implicit none (type, external)
  private

  public :: check_vibrations

contains

  !> Checks rigid links, masses and forces where beams are needed. Errors: all links rigid; rigid
  !! links with `SOLVER dense` or `band`; a mass or a force beyond an end of a bending link; a force
  !! beside the axis of one with shear and without rotary inertia.
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
    call check_masses(diagnostics, model)
    if (needs_frequencies(model)) call check_forces(diagnostics, model)
  end subroutine check_vibrations

  !> A mass is fixed to a cross-section of the beam that carries it, so there must be one at its
  !! place along the link.
  pure subroutine check_masses(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    integer :: i

    do i = 1, size(model%masses)
      if (model%masses(i)%link == 0) cycle
      associate (mass => model%masses(i), link => model%links(model%masses(i)%link))
        if (link%rigid) cycle
        if (mass%place(1) < 0.0_wp .or. mass%place(1) > link%length) then
          call add_error(diagnostics, mass%place_word, "a mass beyond the end of link '"// &
            link%name%text//"', which bends; "// &
            "expected 'at=' from 0 to its length, or a rigid link", link%length_word, &
            "its length is given here")
        end if
      end associate
    end do
  end subroutine check_masses

  !> So is a force, unless it depends on the motion and has no part in frequencies. Beside the axis
  !! it turns its cross-section, which has no inertia of its own with shear alone.
  pure subroutine check_forces(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    integer :: i

    do i = 1, size(model%processes)
      associate (process => model%processes(i))
        if (process%kind /= process_force .or. process%link == 0 .or. process%during /= 0) cycle
        associate (link => model%links(process%link))
          if (link%rigid) cycle
          if (process%place(1) < 0.0_wp .or. process%place(1) > link%length) then
            call add_error(diagnostics, process%place_word, "a force beyond the end of link '"// &
              link%name%text//"', which bends; "// &
              "expected 'at=' from 0 to its length, or a rigid link", link%length_word, &
              "its length is given here")
          else if (abs(process%place(2)) > 0.0_wp .and. model%shear .and. .not. model%rotary) then
            call add_error(diagnostics, process%place_word, "a force beside the axis of link '"// &
              link%name%text//"', which bends, turns a cross-section without inertia; "// &
              "expected 'offset=0', or EFFECTS with 'rotary' beside 'shear'", model%shear_word, &
              "shear is asked for here")
          end if
        end associate
      end associate
    end do
  end subroutine check_forces

end module vibration_checks
