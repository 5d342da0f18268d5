!> Whether frequencies and the elastic response can be found with the rigid links and the masses of
!! a deck.
module vibration_checks
  use bending_checks, only: check_bending
  use diagnostics, only: add_error, diagnostics_t
  use kinds, only: wp
  use models, only: bends_links, is_damped, link_line_density, link_mass, model_t, &
    needs_frequencies, needs_response, report_in_motion, solver_band, solver_dense
  use nodal_checks, only: check_nodal
  use text, only: lower_case, plural, same_word, to_string
  implicit none (type, external)
  private

  public :: check_vibrations, most_modes

contains

  !> Checks rigid links, masses and forces where beams are needed. Errors: those of `check_rigid`
  !! where all links are; a measure that is driven; rigid links with `SOLVER dense` or
  !! `band`; those of `check_massless`, `check_bending` and `check_nodal`.
  pure subroutine check_vibrations(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(model_t), intent(in) :: model                !! whose masses have their links

    integer :: rigid

    if (.not. bends_links(model) .or. size(model%links) == 0) return
    call refuse_driven_measure(diagnostics, model)
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
    call check_massless(diagnostics, model)
    call check_bending(diagnostics, model)
    call check_nodal(diagnostics, model)
  end subroutine check_vibrations

  !> A drive clamps the links that it drives, or holds a pin on its line, and where it is free loads
  !! are balanced there: one of a measure does neither.
  pure subroutine refuse_driven_measure(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    integer :: i, report

    i = findloc(model%drives%measure > 0, .true., dim=1)
    if (i == 0) return
    report = findloc(model%reports%kind%response .or. model%reports%kind%beams, .true., dim=1)
    call add_error(diagnostics, model%drives(i)%subject, "links that vibrate are not held, nor "// &
      "their loads balanced, along a measure; expected DRIVE of a link, a slider or a ram", &
      model%reports(report)%keyword, "they vibrate in this report")
  end subroutine refuse_driven_measure

  !> The most modes that a linkage may have: as many as free drives where all links are rigid; where
  !! links that bend have no mass, as many as the masses that move may have freedoms. Their number
  !! at a position may be lower.
  pure function most_modes(model) result(most)
    type(model_t), intent(in) :: model !! whose masses and links have their numbers
    integer :: most

    integer :: i, k

    most = huge(most)
    if (all(model%links%rigid)) then
      most = count(model%drives%is_free)
      return
    end if
    if (any([(.not. model%links(i)%rigid .and. link_line_density(model, i) > 0.0_wp, i=1, &
      size(model%links))])) return
    most = 0
    do i = 1, size(model%pin_masses)
      if (model%pin_masses(i)%mass > 0.0_wp .and. .not. any([(same_word( &
        model%grounds(k)%pin%text, model%pin_masses(i)%pin%text), k=1, size(model%grounds))])) &
        most = most + 2
    end do
    do i = 1, size(model%masses)
      if (model%masses(i)%mass > 0.0_wp) most = most + 2
      if (model%masses(i)%inertia > 0.0_wp) most = most + 1
    end do
    do i = 1, size(model%sliders)
      if (model%sliders(i)%mass > 0.0_wp) most = most + 2
      if (model%sliders(i)%inertia > 0.0_wp) most = most + 1
    end do
    most = most + 3*count([(model%links(i)%rigid .and. (link_mass(model, i) > 0.0_wp .or. &
      model%links(i)%inertia > 0.0_wp), i=1, size(model%links))])
  end function most_modes

  !> Checks links that bend without mass. Errors: the elastic response, `SOLVER dense` or `band`,
  !! dampers where no link has mass; nothing that vibrates has mass; more modes than its masses have
  !! freedoms.
  pure subroutine check_massless(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    integer :: i, most

    do i = 1, size(model%links)
      if (model%links(i)%material == 0 .or. model%links(i)%rigid) cycle
      if (model%materials(model%links(i)%material)%is_massless) exit
    end do
    if (i > size(model%links)) return
    associate (name => model%links(i)%name, material => &
        model%materials(model%links(i)%material)%name)
      if (needs_response(model)) call add_error(diagnostics, material, report_in_motion(model)// &
        " needs links with mass; expected 'density=' above 0, or a link that is rigid", name, &
        "this link bends without mass")
      if (.not. needs_frequencies(model)) return
      if (any(model%solver == [solver_dense, solver_band])) call add_error(diagnostics, &
        model%solver_word, "SOLVER "//lower_case(model%solver_word%text)//" does not take "// &
        "links without mass; expected SOLVER auto or deformation", name, "this link has none")
      most = most_modes(model)
      if (is_damped(model) .and. most < huge(most)) call add_error(diagnostics, material, &
        "damped modes need links with mass; expected 'density=' above 0, or no DAMPER", name, &
        "this link bends without mass")
      if (most == 0) then
        call add_error(diagnostics, material, "nothing that vibrates has mass, so there are no "// &
          "frequencies; expected 'density=' above 0, or MASS, PINMASS", name, &
          "this link bends without mass")
      else if (model%modes > most) then
        call add_error(diagnostics, model%modes_word, "the links that bend have no mass, and "// &
          "the masses on them at most "//plural(most, "freedom")//": there are no "// &
          to_string(model%modes)//" modes; expected MODES "//to_string(most))
      end if
    end associate
  end subroutine check_massless

  !> Checks a linkage of rigid links, which vibrates as far as its drives are free. Errors: none is,
  !! or a report is on links that bend; more modes than free drives; `SOLVER dense` or `band`.
  pure subroutine check_rigid(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    character(len=:), allocatable :: what
    integer :: free, report

    free = count(model%drives%is_free)
    ! The last one is on the response of links that bend, or on frequencies.
    report = findloc(model%reports%kind%response .or. model%reports%kind%beams .and. free == 0, &
      .true., dim=1, back=.true.)
    if (report > 0) then
      what = "all links are rigid: nothing bends"
      if (.not. model%reports(report)%kind%response) what = what//", and no drive is free"
      if (model%is_structure) what = what//"; expected a DRIVE card with 'free' for every "// &
        "freedom, and CRANK: a body on springs alone hangs on links without mass, whose drives "// &
        "are free"
      call add_error(diagnostics, model%reports(report)%keyword, what, &
        model%links(1)%rigid_word, "the first rigid link")
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
