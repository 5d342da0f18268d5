!> Checks of ACTUATE cards: the coordinates that they name, whether they are as many as the drives,
!! and which reports take them.
module actuator_checks
  use diagnostics, only: add_error, add_warning, diagnostics_t, has_errors
  use measure_checks, only: refuse_two, seek_coordinate
  use kinds, only: wp
  use models, only: model_t, report_of_masses, word_of_four_bar
  use named_coordinates, only: find_named_coordinates, named_coordinate_t
  use report_cards, only: report_t
  use text, only: plural
  use tokens, only: token_t
  implicit none (type, external)
  private

  public :: check_actuators

contains

  !> Looks up what the cards name. Errors: an unknown coordinate, a name of two, one that is named
  !! twice; more or fewer than drives; tables of four-bars; a MOTOR; reports in which nothing
  !! actuates, or the drives do.
  pure subroutine check_actuators(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(model_t), intent(inout) :: model             !! numbers of the coordinates are set

    type(named_coordinate_t), allocatable :: named(:)
    type(token_t) :: word
    integer :: i, first

    if (size(model%actuators) == 0) return
    call find_named_coordinates(model, named)
    do i = 1, size(model%actuators)
      associate (it => model%actuators(i))
        call seek_coordinate(diagnostics, named, it%name, it%coordinate)
        if (it%coordinate == 0) cycle
        call refuse_two(diagnostics, named, it%name, it%coordinate)
        first = findloc(model%actuators%coordinate, it%coordinate, dim=1)
        if (first < i) call add_error(diagnostics, it%name, "'"//it%name%text//"' is actuated "// &
          "twice", model%actuators(first)%name, "first here")
      end associate
    end do
    call check_number(diagnostics, model)
    word = word_of_four_bar(model)
    if (word%line > 0) call add_error(diagnostics, word, "tables of four-bars have the torque "// &
      "of the driven link, which gives none with ACTUATE; expected linkage, or no format=", &
      model%actuators(1)%name, "it is actuated here")
    if (model%motor%keyword%line > 0) call add_error(diagnostics, model%motor%keyword, &
      "a MOTOR is that of the first DRIVE, which gives no effort with ACTUATE; expected one of "// &
      "these cards", model%actuators(1)%name, "this gives it")
    do i = 1, size(model%reports)
      call check_report(diagnostics, model%actuators(1)%name, model%reports(i))
    end do
    if (report_of_masses(model) == 0 .and. .not. has_errors(diagnostics)) call &
      add_warning(diagnostics, model%actuators(1)%name, &
      "ACTUATE is used by reports on forces only, none of which is asked for")
  end subroutine check_actuators

  !> As many efforts as drives hold a linkage.
  pure subroutine check_number(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    integer :: drives, actuators

    drives = size(model%drives)
    actuators = size(model%actuators)
    if (actuators == drives .or. drives == 0 .and. .not. model%is_structure) return
    if (model%is_structure) then
      call add_error(diagnostics, model%actuators(1)%name, "nothing moves here, and no effort "// &
        "is needed; expected no ACTUATE, or DRIVE cards")
    else if (actuators > drives) then
      call add_error(diagnostics, model%actuators(drives + 1)%name, "'"// &
        model%actuators(drives + 1)%name%text//"' is one too many: as many "// &
        "coordinates are actuated as there are drives", model%drives(drives)%keyword, &
        "this is the last drive")
    else
      call add_error(diagnostics, model%actuators(actuators)%name, "there are "// &
        plural(drives, "DRIVE")//", and only "//plural(actuators, "coordinate")// &
        " actuated: as many efforts hold the linkage as drives move it; expected a further "// &
        "ACTUATE name", model%drives(actuators + 1)%keyword, "this drive is not replaced")
    end if
  end subroutine check_number

  !> Reports that do not take actuators, and what to do instead.
  pure subroutine check_report(diagnostics, name, report)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(token_t), intent(in) :: name !! of the first actuator
    type(report_t), intent(in) :: report

    character(len=:), allocatable :: reason

    if (report%fluctuation > 0.0_wp) call add_error(diagnostics, report%keyword, "a flywheel "// &
      "evens out the speed of the first drive, which gives no torque with ACTUATE; expected no "// &
      "'fluctuation='", name, "it is actuated here")
    if (report%kind%frequencies .or. report%kind%response) then
      reason = "it holds the drives where they are, and nothing else; leave ACTUATE out for it"
    else
      select case (report%kind%name)
      case ("motion", "equilibrium")
        reason = "there nothing holds the linkage but its loads; leave ACTUATE out for it, and "// &
          "let a SPRING, FORCE or TORQUE act in its place"
      case ("lagrange", "balance")
        reason = "it has the torque of the first drive; REPORT drives and sizing have the "// &
          "efforts of ACTUATE"
      case default
        return
      end select
    end if
    call add_error(diagnostics, report%keyword, "REPORT "//trim(report%kind%name)//" does not "// &
      "take ACTUATE: "//reason, name, "it is actuated here")
  end subroutine check_report

end module actuator_checks
