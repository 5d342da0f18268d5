!> Checks of linkages that are no four-bars and have a plan: whether they assemble near the drawing,
!! fit, and reach the positions of the deck.
module linkage_checks
  use assembly_faults, only: report_assembly
  use block_checks, only: check_blocks
  use cut_ways, only: ways_under
  use deck_lengths, only: crank_text, word_of_positions
  use diagnostics, only: add_error, add_warning, diagnostics_t, has_errors
  use division_checks, only: check_coupled_drives, check_shared_forces
  use errors, only: error_of_reach, error_t
  use kinds, only: wp
  use linkage_builder, only: assembly_t
  use linkages, only: demand_angle, demand_length, equation_t, group_dyad, is_dyad_linkage, &
    linkage_t
  use mechanisms, only: mechanism_t, pins_of_body
  use misfit_words, only: amount_text, misfit_text, name_redundancy
  use models, only: drives_length, effects_axial, model_t, needs_frequencies, needs_response, &
    solver_band, solver_dense
  use plan_words, only: group_names
  use pose_types, only: pose_t
  use poses, only: place_pins
  use reach_checks, only: check_reach
  use repeated_drives, only: find_repeated_drive
  use ram_checks, only: check_rams
  use redundancies, only: is_fit, largest_misfit
  use response_linkage_checks, only: check_running
  use structures, only: has_beams
  use superfluous_drives, only: find_superfluous_drive
  use text, only: lower_case, plural, to_string
  use tokens, only: token_t
  implicit none (type, external)
  private

  public :: check_linkage

  !> Positions at which the fit of redundant links and the reach are tried, at most.
  integer, parameter :: most_samples = 2000

  !> A misfit above this share of the linkage is no error of measures: the links form a structure.
  real(wp), parameter :: most_misfit = 0.1_wp

  !> By how much redundant links do not fit.
  type :: misfit_t
    integer :: number = 0             !! of the redundancy with the first misfit; 0: all fit
    real(wp) :: first = 0.0_wp        !! the misfit there [m]
    real(wp) :: at_first = 0.0_wp     !! coordinate of the first drive [deg] or [m]
    real(wp) :: largest = 0.0_wp      !! of all positions [m]
    integer :: worst = 0              !! its redundancy
    real(wp) :: at_largest = 0.0_wp   !! its coordinate
    real(wp) :: span = 0.0_wp         !! of the linkage [m]
    integer :: fitting = 0            !! positions where all fit
  end type misfit_t

contains

  !> Whether a planned linkage assembles near its drawing, fits, reaches the positions, and can be
  !! divided into the elements of the deck.
  pure subroutine check_linkage(model, assembly, mechanism, diagnostics)
    type(model_t), intent(in) :: model                !! without errors so far
    type(assembly_t), intent(in) :: assembly          !! with a plan
    type(mechanism_t), intent(in) :: mechanism        !! of the model
    type(diagnostics_t), intent(inout) :: diagnostics !! to which errors and warnings are added

    integer :: leaving, drive, first

    call find_repeated_drive(mechanism%linkage, drive, first)
    if (drive > 0) then
      call add_error(diagnostics, model%drives(drive)%subject, "'"// &
        model%drives(drive)%subject%text//"' is driven already; expected a DRIVE of something "// &
        "else", model%drives(first)%subject, "it follows from this one")
      return
    end if
    if (allocated(assembly%error)) then
      call report_assembly(model, assembly, diagnostics)
      return
    end if
    if (size(mechanism%linkage%redundancies) > 0) then
      call check_fit(model, mechanism, diagnostics)
      if (has_errors(diagnostics)) return
      call check_shared_forces(model, mechanism, diagnostics)
      call check_coupled_drives(model, mechanism, diagnostics)
    end if
    if (drives_length(model) .and. model%motor%keyword%line > 0) call add_error(diagnostics, &
      model%motor%keyword, "a MOTOR turns a link, and the first DRIVE gives a length; "// &
      "a FORCE on its pin, or a DRIVE of a link, may serve")
    call check_rams(model, mechanism, diagnostics)
    if (has_beams(mechanism)) call check_straight_guides(model, mechanism, diagnostics)
    if (needs_frequencies(model) .and. model%effects == effects_axial) call &
      warn_of_held_blocks(model, diagnostics)
    call check_reach(model, mechanism, model%crank, leaving, diagnostics)
    if (leaving > 0) call check_blocks(model, mechanism, diagnostics)
    if (needs_frequencies(model) .and. .not. has_errors(diagnostics)) call check_mesh(model, &
      mechanism, diagnostics)
    if (needs_response(model) .and. .not. has_errors(diagnostics)) call check_running(model, &
      mechanism, diagnostics)
  end subroutine check_linkage

  !> A block passes pins of a link that bends where this is straight, to all digits: a corner that
  !! rounding makes would be one more place where it bends.
  pure subroutine check_straight_guides(model, mechanism, diagnostics)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(diagnostics_t), intent(inout) :: diagnostics

    integer :: i

    do i = 1, size(model%sliders)
      if (mechanism%elastic%contact(i) == 0) cycle
      if (ways_under(mechanism%linkage, i, mechanism%elastic%ways) < 2) cycle
      associate (link => model%links(model%sliders(i)%link)%name)
        call add_error(diagnostics, model%sliders(i)%pin, "a block on link '"//link%text// &
          "', which is drawn straight but for rounding and bends; expected pins on one line to "// &
          "12 digits or more, or 'lengths=' with 'turns=0'", link, "the link is here")
      end associate
    end do
  end subroutine check_straight_guides

  !> The moment in the contact of a block that does not turn on a link that bends does work of the
  !! second order on its curvature, which jumps there: a block without length has no such term.
  pure subroutine warn_of_held_blocks(model, diagnostics)
    type(model_t), intent(in) :: model
    type(diagnostics_t), intent(inout) :: diagnostics

    integer :: i

    do i = 1, size(model%sliders)
      if (model%sliders(i)%turned_link == 0 .or. model%sliders(i)%link == 0) cycle
      if (model%links(model%sliders(i)%link)%rigid) cycle
      call add_warning(diagnostics, model%sliders(i)%turned, "link '"// &
        model%links(model%sliders(i)%turned_link)%name%text//"' does not turn on a block "// &
        "without length on link '"//model%links(model%sliders(i)%link)%name%text//"', which "// &
        "bends: what the moment between them adds to the stiffness is left out")
    end do
  end subroutine warn_of_held_blocks

  !> A mesh of the deck, and its nodal matrices, are of links that are placed two by two.
  pure subroutine check_mesh(model, mechanism, diagnostics)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(diagnostics_t), intent(inout) :: diagnostics

    character(len=:), allocatable :: reason
    integer :: i

    if (mechanism%accuracy > 0.0_wp .or. is_dyad_linkage(mechanism%linkage)) return
    reason = " is for links that are placed two by two"
    do i = 1, size(mechanism%linkage%groups)
      if (mechanism%linkage%groups(i)%kind == group_dyad) cycle
      reason = reason//", not "//group_names(mechanism, mechanism%linkage%groups(i))
      exit
    end do
    if (model%solver == solver_dense .or. model%solver == solver_band) then
      call add_error(diagnostics, model%solver_word, "SOLVER "// &
        lower_case(model%solver_word%text)//reason//"; expected SOLVER auto or deformation")
    else
      call add_error(diagnostics, model%meshes(1)%keyword, "MESH with 'elements='"//reason// &
        "; expected 'accuracy='")
    end if
  end subroutine check_mesh

  !> Redundant links must fit at every position.
  pure subroutine check_fit(model, mechanism, diagnostics)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(diagnostics_t), intent(inout) :: diagnostics

    type(misfit_t) :: found
    type(token_t) :: place
    character(len=:), allocatable :: subject, amount
    integer :: mobility, drive

    found = misfit_over(mechanism%linkage, model%crank%value)
    if (found%number == 0) return
    associate (equation => mechanism%linkage%redundancies(found%number))
      call name_redundancy(model, mechanism, equation, place, subject)
      amount = misfit_text(model, mechanism, equation, found%first)//" at "// &
        word_of_positions(model)//" "// &
        crank_text(model, found%at_first, 10)
      call find_superfluous_drive(mechanism%linkage, found%at_first, mobility, drive)
      if (mobility > 0 .and. drive > 0) then
        call add_error(diagnostics, model%drives(drive)%subject, "the linkage has mobility "// &
          to_string(mobility)//" and "//plural(size(model%drives), "DRIVE")//", of which this "// &
          "one leaves "//subject//" "//amount//"; remove this card, or another DRIVE", place, &
          "what does not fit is here", kind=error_of_reach)
      else if (abs(found%largest) > most_misfit*found%span .and. found%fitting == 0) then
        call add_error(diagnostics, place, neighbours_of(mechanism, equation, subject)// &
          " form a structure and cannot move"//while_driven(model), kind=error_of_reach)
      else
        call add_error(diagnostics, place, subject//" does not fit: "//amount// &
          "; largest misfit "//amount_text(model, mechanism, mechanism%linkage%redundancies( &
          found%worst), found%largest)//" at "//crank_text(model, found%at_largest, 10), &
          kind=error_of_reach)
      end if
    end associate
  end subroutine check_fit

  !> The first misfit of a redundant link over the positions of a deck, and the largest.
  pure function misfit_over(linkage, cranks) result(found)
    type(linkage_t), intent(in) :: linkage
    real(wp), intent(in) :: cranks(:) !! coordinates of the first drive [deg] or [m]
    type(misfit_t) :: found

    type(error_t), allocatable :: error
    type(pose_t) :: pose
    real(wp) :: misfit
    logical :: fits
    integer :: i, number

    do i = 1, size(cranks), 1 + size(cranks)/most_samples
      call place_pins(linkage, cranks(i), pose, error)
      if (allocated(error)) cycle
      found%span = max(found%span, maxval(abs(pose%pin)), maxval(linkage%bodies%length))
      call largest_misfit(linkage, pose, cranks(i), misfit, number)
      fits = is_fit(linkage, pose, misfit)
      if (fits) found%fitting = found%fitting + 1
      if (found%number == 0 .and. .not. fits) then
        found%first = misfit
        found%at_first = cranks(i)
        found%number = number
      end if
      ! A length is wrong by the same, but for rounding, wherever its pins are placed without it.
      if (abs(misfit) <= (1.0_wp + 1.0e-9_wp)*abs(found%largest)) cycle
      found%largest = misfit
      found%worst = number
      found%at_largest = cranks(i)
    end do
  end function misfit_over

  !> Several drives may be one too many.
  pure function while_driven(model) result(words)
    type(model_t), intent(in) :: model
    character(len=:), allocatable :: words

    words = ""
    if (size(model%drives) > 1) words = " while "//plural(size(model%drives), "DRIVE card")// &
      " give their positions"
  end function while_driven

  !> `links 'a', 'b', 'c'`: the links that share a moving pin with a redundant one, and this; or
  !! what else is redundant, and the links.
  pure function neighbours_of(mechanism, equation, subject) result(words)
    type(mechanism_t), intent(in) :: mechanism
    type(equation_t), intent(in) :: equation !! the redundancy
    character(len=*), intent(in) :: subject  !! its words
    character(len=:), allocatable :: words

    integer, allocatable :: pins(:)
    integer :: b, i

    words = "with "//subject//" the links"
    if (all(equation%kind /= [demand_length, demand_angle])) return
    words = "links "
    pins = pins_of_body(mechanism%linkage%bodies(equation%body))
    do b = 1, size(mechanism%names)
      if (b == equation%body) cycle
      do i = 1, size(pins)
        if (mechanism%linkage%is_ground(pins(i))) cycle
        if (.not. any(pins_of_body(mechanism%linkage%bodies(b)) == pins(i))) cycle
        words = words//"'"//mechanism%names(b)%text//"', "
        exit
      end do
    end do
    words = words//subject
  end function neighbours_of

end module linkage_checks
