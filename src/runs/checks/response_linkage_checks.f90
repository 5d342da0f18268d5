!> Checks where the elastic response is asked for: which linkages its equations are for, and whether
!! the crank turns fully.
module response_linkage_checks
  use diagnostics, only: add_error, diagnostics_t, has_errors
  use errors, only: error_of_reach
  use four_bar_limits, only: reach_t
  use full_turns, only: turns_fully
  use kinds, only: wp
  use mechanisms, only: mechanism_t
  use models, only: drives_length, has_law, model_t, steady_state_report
  use reach_checks, only: interval_words, reachable_intervals
  use tokens, only: token_t
  implicit none (type, external)
  private

  public :: check_running, check_turn

contains

  !> The running elastic linkage: which ones its equations are for.
  pure subroutine check_running(model, mechanism, diagnostics)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(diagnostics_t), intent(inout) :: diagnostics

    character(len=:), allocatable :: name
    integer :: i, report

    report = findloc(model%reports%kind%response, .true., dim=1)
    name = "REPORT "//trim(model%reports(report)%kind%name)
    if (model%drives(1)%is_free) then
      call add_error(diagnostics, model%drives(1)%keyword, name//" is on a linkage whose first "// &
        "drive keeps to its motion, and this one is free; expected no 'free'; REPORT motion "// &
        "moves it, with rigid links, and frequencies are those of a position", &
        model%reports(report)%keyword, "it is asked for here")
      return
    end if
    if (drives_length(model) .and. steady_state_report(model) == 0 .and. &
      .not. has_law(model)) then
      call add_error(diagnostics, model%drives(1)%keyword, name//" follows a drive of a length "// &
        "over its law, for it makes no turns; expected 'law=' on this card, with LAW and TIME", &
        model%reports(report)%keyword, "it is asked for here")
      return
    end if
    call check_running_blocks(model, mechanism, report, diagnostics)
    if (.not. has_errors(diagnostics)) call check_turn(model, mechanism, diagnostics)
  end subroutine check_running

  !> Whether the crank turns fully, without a dead point, where the elastic response asks for that.
  pure subroutine check_turn(model, mechanism, diagnostics, reach)
    type(model_t), intent(in) :: model                !! without errors so far
    type(mechanism_t), intent(in) :: mechanism        !! of the model
    type(diagnostics_t), intent(inout) :: diagnostics !! to which an error is added
    type(reach_t), intent(in), optional :: reach      !! of the crank of a four-bar

    character(len=:), allocatable :: motion, why
    type(token_t) :: place
    integer :: report

    report = steady_state_report(model)
    if (report == 0) return
    if (turns_fully(mechanism%linkage, through=.false.)) return
    place = model%reports(report)%keyword
    motion = "; REPORT "//trim(model%reports(report)%kind%name)//" is on the steady state of a "// &
      "crank that turns fully, and there is none"
    if (.not. present(reach)) motion = motion//"; frequencies at positions do without"
    if (drives_length(model)) then
      place = model%drives(1)%keyword
      why = "the first DRIVE gives a length"
    else if (.not. present(reach)) then
      why = "the crank does not turn fully, meets a dead point or a change point, or the links "// &
        "are elsewhere after a turn"
    else if (reach%least > 0.0_wp .or. reach%most < 180.0_wp) then
      why = "the crank turns only "//interval_words(model, reachable_intervals(mechanism, &
        [0.0_wp], model%crank%value))
    else
      why = "the crank meets a dead point, where the links are in line"
    end if
    call add_error(diagnostics, place, why//motion, kind=error_of_reach)
  end subroutine check_turn

  !> Blocks that slide along links that bend: material moves through the functions of the pieces
  !! between the ends of the link and the block, which are those of slender uniform beams.
  pure subroutine check_running_blocks(model, mechanism, report, diagnostics)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism  !! with parts
    integer, intent(in) :: report               !! number of the report that asks for it
    type(diagnostics_t), intent(inout) :: diagnostics

    character(len=:), allocatable :: reason
    integer :: i

    do i = 1, size(model%sliders)
      if (mechanism%elastic%contact(i) == 0) cycle
      reason = reason_of_block(model, mechanism, i)
      if (len(reason) == 0) cycle
      call add_error(diagnostics, model%sliders(i)%pin, "REPORT "// &
        trim(model%reports(report)%kind%name)//" is not found yet with a block that slides "// &
        "along a link that bends"//reason, model%reports(report)%keyword, "it is asked for here")
      return
    end do
  end subroutine check_running_blocks

  !> Why a linkage with a block on a link that bends is not followed in motion, and what would do;
  !! empty: it is.
  pure function reason_of_block(model, mechanism, number) result(reason)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    integer, intent(in) :: number       !! of the slider
    character(len=:), allocatable :: reason

    character(len=:), allocatable :: rigid_link
    logical :: thick

    reason = ""
    associate (link => model%sliders(number)%link, elastic => mechanism%elastic)
      rigid_link = "'"//model%links(link)%name%text//"' to be rigid"
      thick = any((elastic%beams%shear_stiffness > 0.0_wp .or. elastic%beams%rotary_inertia > &
        0.0_wp) .and. elastic%body == mechanism%linkage%sliders(number)%body)
      if (model%sliders(number)%turned_link > 0) then
        ! Its couple makes the curvature jump, and the jump moves through the material.
        reason = " and turns with '"//model%links(model%sliders(number)%turned_link)%name%text// &
          "'; expected a block that turns on it, or "//rigid_link
      else if (thick) then
        reason = " with shear or rotary inertia; expected a slender one, or "//rigid_link
      else if (model%links(link)%damping > 0) then
        associate (damping => model%dampings(model%links(link)%damping))
          ! The jump of the curvature under it would lose energy as it moves.
          if (max(damping%time, damping%ratio) > 0.0_wp .and. model%sliders(number)%inertia > &
            0.0_wp) reason = " with 'inertia=' of the block and DAMPING of the link; expected "// &
            "one of them"
        end associate
      end if
    end associate
  end function reason_of_block

end module response_linkage_checks
