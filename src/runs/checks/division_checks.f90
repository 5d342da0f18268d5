!> Checks of links that are more than needed: whether their elasticity divides the forces between
!! them in the reports of a deck.
module division_checks
  use bending_checks, only: check_forces_on_links
  use coupled_drives, only: find_coupled_drives
  use diagnostics, only: add_error, diagnostics_t
  use errors, only: error_t
  use kinds, only: wp
  use link_cards, only: has_own_mass
  use mechanisms, only: mechanism_t
  use models, only: model_t, needs_frequencies, report_number
  use natures, only: is_angular
  use pose_types, only: pose_t
  use poses, only: place_links
  use structures, only: has_beams
  implicit none (type, external)
  private

  public :: check_shared_forces, check_coupled_drives

  !> Positions at which forces of drives are tried, at most.
  integer, parameter :: most_samples = 2000

contains

  !> Forces that links share which are more than needed: their elasticity divides them. Rigid ones
  !! have none.
  pure subroutine check_shared_forces(model, mechanism, diagnostics)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(diagnostics_t), intent(inout) :: diagnostics

    character(len=:), allocatable :: in_links
    integer :: drive, motion, report
    logical :: in_motion

    in_links = "in '"//mechanism%names(max(1, mechanism%linkage%redundancies(1)%body))%text// &
      "' and the links that hold the same pins"
    if (size(model%actuators) > 0) call add_error(diagnostics, model%actuators(1)%name, &
      "forces "//in_links//" are not told with ACTUATE; take a redundant link or joint away, "// &
      "or leave ACTUATE out")
    report = max(report_number(model, "reactions"), report_number(model, "bearings"), &
      report_number(model, "sizing"))
    motion = report_number(model, "motion")
    in_motion = .false.
    if (motion > 0) in_motion = model%reports(motion)%with_forces
    if (.not. has_beams(mechanism)) then
      if (report > 0) then
        call add_error(diagnostics, model%reports(report)%keyword, "the forces "//in_links// &
          " cannot be told apart while all are rigid; REPORT drives, frame and lagrange do not "// &
          "need them")
      else if (size(model%frictions) > 0) then
        call add_error(diagnostics, model%frictions(1)%keyword, "friction depends on the "// &
          "forces in the joints, and those "//in_links//" cannot be told apart while all are rigid")
      end if
      if (in_motion) call add_error(diagnostics, model%reports(motion)%forces_word, &
        "the forces "//in_links//" cannot be told apart while all are rigid; accelerations and "// &
        "power do not need them")
      return
    end if
    drive = findloc(model%drives%measure > 0, .true., dim=1)
    if (drive > 0) then
      call add_error(diagnostics, model%drives(drive)%subject, "the forces "//in_links// &
        " are divided by how links bend, and a drive of a measure does not hold these; "// &
        "expected DRIVE of a link, a slider or a ram")
      return
    end if
    if (size(model%frictions) > 0) call check_divided_friction(model, in_links, diagnostics)
    if (in_motion) call check_divided_motion(model, in_links, diagnostics)
    if (report > 0 .or. in_motion .or. size(model%frictions) > 0) call &
      check_dividing_links(model, mechanism, in_links, diagnostics)
  end subroutine check_shared_forces

  !> Drives that a link more than needed joins hold it with any force: their torques are open.
  pure subroutine check_coupled_drives(model, mechanism, diagnostics)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(diagnostics_t), intent(inout) :: diagnostics

    type(error_t), allocatable :: error
    type(pose_t) :: pose
    character(len=:), allocatable :: name
    integer, allocatable :: drives(:)
    integer :: i, redundancy, report

    report = max(report_number(model, "drives"), report_number(model, "drive"), &
      report_number(model, "sizing"))
    ! Couples of links that turn together follow with those of drives.
    if (report == 0 .and. size(mechanism%linkage%turns) > 0) report = &
      report_number(model, "reactions")
    if (report == 0 .or. size(model%drives) < 2) return
    redundancy = 0
    do i = 1, size(model%crank%value), 1 + size(model%crank%value)/most_samples
      call place_links(mechanism%linkage, model%crank%value(i), pose, error)
      if (allocated(error)) cycle
      call find_coupled_drives(mechanism%linkage, pose, redundancy, drives)
      if (redundancy > 0) exit
    end do
    if (redundancy == 0) return
    name = "a slider"
    i = mechanism%linkage%redundancies(redundancy)%body
    if (i > 0) name = "'"//mechanism%names(i)%text//"'"
    call add_error(diagnostics, model%reports(report)%keyword, "the forces of the drives "// &
      "cannot be told apart: "//name//" joins what they move, and they may hold it with any "// &
      "force; expected one DRIVE less", &
      model%drives(maxval(drives))%keyword, "one of these drives")
  end subroutine check_coupled_drives

  !> Friction depends on the forces that elasticity divides, at given positions and speeds.
  pure subroutine check_divided_friction(model, in_links, diagnostics)
    type(model_t), intent(in) :: model
    character(len=*), intent(in) :: in_links
    type(diagnostics_t), intent(inout) :: diagnostics

    character(len=*), parameter :: without(*) = [character(len=7) :: "motion", "balance"]
    integer :: i, report

    do i = 1, size(without)
      report = report_number(model, trim(without(i)))
      if (report == 0) cycle
      call add_error(diagnostics, model%frictions(1)%keyword, "friction depends on the forces "// &
        "in the joints, and those "//in_links//" are divided by how links bend; REPORT "// &
        trim(without(i))//" does not know it: expected no friction", &
        model%reports(report)%keyword, "it is asked for here")
      return
    end do
  end subroutine check_divided_friction

  !> A second drive that holds its link bears a torque that only elasticity tells.
  pure subroutine check_divided_motion(model, in_links, diagnostics)
    type(model_t), intent(in) :: model
    character(len=*), intent(in) :: in_links
    type(diagnostics_t), intent(inout) :: diagnostics

    integer :: i

    do i = 2, size(model%drives)
      if (model%drives(i)%is_free .or. .not. is_angular(model%drives(i)%nature)) cycle
      call add_error(diagnostics, model%drives(i)%keyword, "the forces "//in_links// &
        " are divided by how links bend, and in a motion not with a second drive that holds "// &
        "its link; expected 'free'", model%reports(report_number(model, "motion"))%forces_word, &
        "they are asked for here")
      return
    end do
  end subroutine check_divided_motion

  !> Links that bend have the mass of their sections, and loads between their ends.
  pure subroutine check_dividing_links(model, mechanism, in_links, diagnostics)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    character(len=*), intent(in) :: in_links
    type(diagnostics_t), intent(inout) :: diagnostics

    integer :: i

    do i = 1, size(model%links)
      if (model%links(i)%rigid .or. .not. has_own_mass(model%links(i))) cycle
      call add_error(diagnostics, model%links(i)%body_word, "link '"//model%links(i)%name%text// &
        "' bends, and a beam has the mass of its section: the forces "//in_links// &
        " are divided by how links bend; expected 'rigid' on this card, or no '"// &
        model%links(i)%body_word%text//"='")
      return
    end do
    do i = 1, size(mechanism%elastic%contact)
      if (mechanism%elastic%contact(i) == 0) cycle
      if (mechanism%load_elements(mechanism%linkage%sliders(i)%body) == 0) cycle
      call add_error(diagnostics, model%inertia_word, "the masses of link '"// &
        mechanism%names(mechanism%linkage%sliders(i)%body)%text//"' are not lumped where a "// &
        "block divides it, and the forces "//in_links//" are divided by how links bend; "// &
        "expected: INERTIA distributed")
      return
    end do
    do i = 1, size(model%masses)
      if (model%masses(i)%link == 0 .or. .not. model%masses(i)%inertia > 0.0_wp) cycle
      if (model%links(model%masses(i)%link)%rigid) cycle
      if (all(mechanism%load_elements == 0)) exit
      call add_error(diagnostics, model%inertia_word, "masses are lumped, and one with a "// &
        "moment of inertia turns with link '"//model%links(model%masses(i)%link)%name%text// &
        "', which bends: the forces "//in_links//" are divided by how links bend; expected: "// &
        "INERTIA distributed", model%masses(i)%place_word, "the mass is here")
      return
    end do
    if (needs_frequencies(model)) return
    call check_forces_on_links(diagnostics, model, .true.)
  end subroutine check_dividing_links

end module division_checks
