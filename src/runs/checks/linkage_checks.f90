!> Checks of linkages that are no four-bars: whether they have a plan, assemble near the drawing,
!! fit, and reach the positions of the deck.
module linkage_checks
  use assembly_plan, only: problem_braced, problem_coupler_driven, &
    problem_drive_idle, problem_no_side, problem_not_drawn, problem_other_bases, problem_too_free
  use block_checks, only: check_blocks
  use diagnostics, only: add_error, add_warning, diagnostics_t, has_errors
  use errors, only: error_of_dead_point, error_of_reach, error_t
  use kinds, only: wp
  use linkage_parts, only: assembly_t
  use linkages, only: reference_point
  use mechanisms, only: mechanism_t, pins_of_body
  use models, only: drives_length, model_t, report_number
  use pose_types, only: pose_t
  use poses, only: place_groups, place_links
  use redundancies, only: body_of_redundancy, largest_misfit
  use text, only: plural, same_word, to_string
  use tokens, only: token_t
  use units, only: coherent_unit, dimension_length, from_si, unit_t
  implicit none (type, external)
  private

  public :: report_problem, check_linkage

  !> Positions at which the fit of redundant links and the reach are tried, at most.
  integer, parameter :: most_samples = 2000

  !> A misfit above this share of the linkage is no error of measures: the links form a structure.
  real(wp), parameter :: most_misfit = 0.1_wp

  !> Rounding in the misfit of redundant links, as a share of the linkage.
  real(wp), parameter :: fit = 1.0e-9_wp

contains

  !> Why a linkage has no plan, at the part of the deck that it is about.
  pure subroutine report_problem(model, assembly, diagnostics)
    type(model_t), intent(in) :: model                !! without errors so far
    type(assembly_t), intent(in) :: assembly          !! with a problem
    type(diagnostics_t), intent(inout) :: diagnostics !! to which the error is added

    type(token_t) :: place
    character(len=:), allocatable :: pins

    associate (problem => assembly%problem)
      place = model%links(1)%name
      if (size(problem%bodies) > 0) place = model%links(assembly%link(problem%bodies(1)))%name
      pins = names_of_pins(assembly, problem%pins)
      select case (problem%kind)
      case (problem_too_free)
        if (size(problem%pins) > 0) place = token_of_pin(model, assembly, problem%pins(1))
        call add_error(diagnostics, place, "the linkage has mobility "// &
          to_string(problem%mobility)//" and "//plural(size(model%drives), "DRIVE")//": "// &
          what_is_free(assembly)//" (add a DRIVE, or parts that hold it)")
      case (problem_braced)
        if (size(problem%bodies) == 1) then
          call add_error(diagnostics, place, "link '"//place%text//"' joins the ground "// &
            "pivots "//pins(index(pins, "'"):)//" and cannot move")
        else
          call add_error(diagnostics, place, &
            "mobility 0: '"//place%text//"' joins two pins of '"// &
            model%links(assembly%link(problem%bodies(2)))%name%text//"'", &
            model%links(assembly%link(problem%bodies(2)))%name, "it is here")
        end if
      case (problem_coupler_driven)
        call add_error(diagnostics, model%drives(problem%number)%subject, "'"// &
          model%drives(problem%number)%subject%text//"' turns about no ground pivot; drive it "// &
          "against a link: DRIVE "//model%drives(problem%number)%subject%text//" against link")
      case (problem_drive_idle)
        call add_error(diagnostics, model%drives(problem%number)%subject, "this DRIVE has "// &
          "nothing to move: the linkage has "//plural(size(model%drives), "DRIVE card")// &
          ", and the others leave it no freedom")
      case (problem_no_side, problem_other_bases)
        call report_side(model, assembly, diagnostics)
      case (problem_not_drawn)
        place = token_of_pin(model, assembly, problem%pins(1))
        call add_error(diagnostics, place, "several links have to be placed together here, and "// &
          "only a drawing tells how: PIN cards for "//pins//" are missing")
      end select
    end associate
  end subroutine report_problem

  !> A dyad without a side, or with one between other pins.
  pure subroutine report_side(model, assembly, diagnostics)
    type(model_t), intent(in) :: model
    type(assembly_t), intent(in) :: assembly
    type(diagnostics_t), intent(inout) :: diagnostics

    character(len=:), allocatable :: pin, from, to, card
    type(token_t) :: place

    associate (problem => assembly%problem)
      pin = assembly%pins(problem%pins(1))%text
      from = assembly%pins(problem%pins(2))%text
      to = assembly%pins(problem%pins(3))%text
      card = "BRANCH "//pin//" left|right "//from//" "//to
      if (problem%on_line) card = "BRANCH "//pin//" forward|backward"
      if (problem%kind == problem_no_side) then
        place = token_of_pin(model, assembly, problem%pins(1))
        if (problem%on_line) then
          call add_error(diagnostics, place, "pin '"//pin//"' has two places on its guide: "// &
            "expected "//card//", or PIN cards for '"//pin//"' and '"//from//"'")
        else
          call add_error(diagnostics, place, "pin '"//pin//"' has two "// &
            "places, left or right of '"// &
            from//"' -> '"//to//"': expected "//card//", or PIN cards for the moving pins")
        end if
      else
        call add_error(diagnostics, model%branches(problem%number)%pin, "pin '"//pin// &
          "' does not hang on these pins; expected "//card)
      end if
    end associate
  end subroutine report_side

  !> `nothing holds pins 'E', 'F'`
  pure function what_is_free(assembly) result(words)
    type(assembly_t), intent(in) :: assembly
    character(len=:), allocatable :: words

    associate (problem => assembly%problem)
      if (size(problem%pins) > 0) then
        words = "nothing holds "//names_of_pins(assembly, problem%pins)
        return
      end if
      words = "nothing turns "//plural(size(problem%bodies), "link")
    end associate
  end function what_is_free

  !> `pins 'E', 'F'`, or `pin 'E'`
  pure function names_of_pins(assembly, pins) result(words)
    type(assembly_t), intent(in) :: assembly
    integer, intent(in) :: pins(:)
    character(len=:), allocatable :: words

    integer :: i

    words = trim(merge("pin ", "pins", size(pins) == 1))
    do i = 1, size(pins)
      if (i > 1) words = words//","
      words = words//" '"//assembly%pins(pins(i))%text//"'"
    end do
  end function names_of_pins

  !> Where a pin first stands in the deck, on a LINK card or a SLIDER card.
  pure function token_of_pin(model, assembly, pin) result(place)
    type(model_t), intent(in) :: model
    type(assembly_t), intent(in) :: assembly
    integer, intent(in) :: pin
    type(token_t) :: place

    integer :: i, k

    do i = 1, size(model%links)
      do k = 1, size(model%links(i)%pins)
        place = model%links(i)%pins(k)
        if (same_word(place%text, assembly%pins(pin)%text)) return
      end do
    end do
    do i = 1, size(model%sliders)
      place = model%sliders(i)%pin
      if (same_word(place%text, assembly%pins(pin)%text)) return
    end do
    place = model%links(1)%name
  end function token_of_pin

  !> Whether a planned linkage assembles near its drawing, fits, and reaches the positions.
  pure subroutine check_linkage(model, assembly, mechanism, diagnostics)
    type(model_t), intent(in) :: model                !! without errors so far
    type(assembly_t), intent(in) :: assembly          !! with a plan
    type(mechanism_t), intent(in) :: mechanism        !! of the model
    type(diagnostics_t), intent(inout) :: diagnostics !! to which errors and warnings are added

    integer :: report

    if (allocated(assembly%error)) then
      call report_assembly(model, assembly, diagnostics)
      return
    end if
    if (size(mechanism%linkage%redundancies) > 0) then
      ! Positions on a path have a start of their own there, and tell their misfit one by one.
      if (.not. allocated(mechanism%linkage%path%crank)) call check_fit(model, mechanism, &
        diagnostics)
      if (has_errors(diagnostics)) return
      report = report_number(model, "reactions")
      if (report > 0) call add_error(diagnostics, model%reports(report)%keyword, &
        "the forces in '"//mechanism%names(max(1, body_of_redundancy(mechanism%linkage, &
        1)))%text//"' and the links that hold the same pins cannot be told apart while all are "// &
        "rigid; REPORT drive and REPORT lagrange do not need them")
    end if
    if (drives_length(model) .and. model%motor%keyword%line > 0) call add_error(diagnostics, &
      model%motor%keyword, "a MOTOR turns a link, and the first DRIVE moves a slider or a ram; "// &
      "a FORCE on its pin, or a DRIVE of a link, may serve")
    call check_reach(model, mechanism, diagnostics)
    call check_blocks(model, mechanism, diagnostics)
  end subroutine check_linkage

  !> The drawing does not assemble: the nearest assembly as PIN cards, if there is one.
  pure subroutine report_assembly(model, assembly, diagnostics)
    type(model_t), intent(in) :: model
    type(assembly_t), intent(in) :: assembly
    type(diagnostics_t), intent(inout) :: diagnostics

    character(len=:), allocatable :: cards
    type(token_t) :: place
    integer :: i

    place = model%links(1)%name
    if (size(model%drawn_pins) > 0) place = model%drawn_pins(1)%pin
    if (assembly%error%kind == error_of_dead_point) then
      call add_error(diagnostics, place, "this drawing shows a dead point, or nearly so, where "// &
        "the drive cannot move the links; draw another position")
      return
    end if
    if (.not. allocated(assembly%nearest)) then
      call add_error(diagnostics, place, "the linkage does not assemble from this drawing: "// &
        assembly%error%text)
      return
    end if
    cards = ""
    do i = 1, size(assembly%pins)
      if (assembly%linkage%is_ground(i)) cycle
      cards = cards//"; PIN "//assembly%pins(i)%text//" "//in_deck(model, assembly%nearest%pin(1, &
        i))//" "//in_deck(model, assembly%nearest%pin(2, i))
    end do
    call add_error(diagnostics, place, "the linkage does not assemble near this drawing; the "// &
      "nearest assembly is: "//cards(3:))
  end subroutine report_assembly

  !> A length in the unit of the deck, with six digits.
  pure function in_deck(model, length) result(words)
    type(model_t), intent(in) :: model
    real(wp), intent(in) :: length !! [m]
    character(len=:), allocatable :: words

    words = to_string(from_si(length, coherent_unit(model%units, dimension_length)), 6)
  end function in_deck

  !> Redundant links must fit at every position.
  pure subroutine check_fit(model, mechanism, diagnostics)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(diagnostics_t), intent(inout) :: diagnostics

    type(error_t), allocatable :: error
    type(pose_t) :: pose
    type(token_t) :: place
    real(wp) :: misfit, correction, largest, first, span, at_largest, at_first
    character(len=:), allocatable :: name
    integer :: i, number, worst, step, body

    largest = 0.0_wp
    first = 0.0_wp
    worst = 0
    span = 0.0_wp
    step = 1 + size(model%crank%value)/most_samples
    do i = 1, size(model%crank%value), step
      call clear(pose)
      if (allocated(error)) deallocate (error)
      call place_groups(mechanism%linkage, model%crank%value(i), pose, correction, error)
      if (allocated(error)) cycle
      span = max(span, maxval(abs(pose%pin)), maxval(mechanism%linkage%bodies%length))
      call largest_misfit(mechanism%linkage, pose, reference_point(mechanism%linkage), &
        model%crank%value(i), misfit, number)
      if (worst == 0 .and. abs(misfit) > fit*span) then
        first = misfit
        at_first = model%crank%value(i)
        worst = number
      end if
      if (abs(misfit) <= abs(largest)) cycle
      largest = misfit
      at_largest = model%crank%value(i)
    end do
    if (worst == 0) return
    body = body_of_redundancy(mechanism%linkage, worst)
    place = model%links(1)%name
    name = "a slider"
    if (body > 0) then
      place = model%links(mechanism%links(body))%name
      name = "'"//place%text//"'"
    end if
    if (abs(largest) > most_misfit*span) then
      call add_error(diagnostics, place, "links "//neighbours_of(mechanism, body)//name// &
        " form a structure and cannot move"//while_driven(model), kind=error_of_reach)
    else
      call add_error(diagnostics, place, name//" does not fit: "//in_deck(model, abs(first))// &
        " "//length_name(model)//" too "//trim(merge("short", "long ", first > 0.0_wp))// &
        " at crank "//to_string(at_first, 10)//"; largest misfit "//in_deck(model, &
        abs(largest))//" "//length_name(model)//" at "//to_string(at_largest, 10), &
        kind=error_of_reach)
    end if
  end subroutine check_fit

  !> Several drives may be one too many.
  pure function while_driven(model) result(words)
    type(model_t), intent(in) :: model
    character(len=:), allocatable :: words

    words = ""
    if (size(model%drives) > 1) words = " while "//plural(size(model%drives), "DRIVE card")// &
      " give their positions"
  end function while_driven

  !> `'a', 'b', `: the links that share a moving pin with one.
  pure function neighbours_of(mechanism, body) result(words)
    type(mechanism_t), intent(in) :: mechanism
    integer, intent(in) :: body !! number; 0: none
    character(len=:), allocatable :: words

    integer, allocatable :: pins(:)
    integer :: b, i

    words = ""
    if (body == 0) return
    pins = pins_of_body(mechanism%linkage%bodies(body))
    do b = 1, size(mechanism%names)
      if (b == body) cycle
      do i = 1, size(pins)
        if (mechanism%linkage%is_ground(pins(i))) cycle
        if (.not. any(pins_of_body(mechanism%linkage%bodies(b)) == pins(i))) cycle
        words = words//"'"//mechanism%names(b)%text//"', "
        exit
      end do
    end do
  end function neighbours_of

  pure subroutine clear(pose)
    type(pose_t), intent(out) :: pose
  end subroutine clear

  pure function length_name(model) result(name)
    type(model_t), intent(in) :: model
    character(len=:), allocatable :: name

    type(unit_t) :: measure

    measure = coherent_unit(model%units, dimension_length)
    name = measure%name
  end function length_name

  !> Positions out of reach: an error if none is in reach, else a warning with the first and their
  !! number. Blocks that leave their links have messages of their own.
  pure subroutine check_reach(model, mechanism, diagnostics)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(diagnostics_t), intent(inout) :: diagnostics

    type(error_t), allocatable :: error
    type(pose_t) :: pose
    character(len=:), allocatable :: why
    integer :: i, out_of_reach, leaving, first
    real(wp) :: shown

    out_of_reach = 0
    leaving = 0
    first = 0
    do i = 1, size(model%crank%value)
      call place_links(mechanism%linkage, model%crank%value(i), pose, error)
      if (.not. allocated(error)) cycle
      if (error%kind /= error_of_reach) cycle
      if (error%place%pin > 0) then
        leaving = leaving + 1
        cycle
      end if
      out_of_reach = out_of_reach + 1
      if (first > 0) cycle
      first = i
      why = ""
      if (error%place%body > 0) why = ": '"//mechanism%names(error%place%body)%text// &
        "' does not "//trim(merge("fit  ", "reach", index(error%text, "redundant") > 0))
    end do
    if (out_of_reach == 0) return
    shown = model%crank%value(first)
    if (drives_length(model)) shown = from_si(shown, coherent_unit(model%units, dimension_length))
    if (out_of_reach + leaving == size(model%crank%value)) then
      call add_error(diagnostics, model%crank%words(model%crank%word(first)), &
        "the linkage closes at none of these positions"//why, kind=error_of_reach)
    else
      call add_warning(diagnostics, model%crank%words(model%crank%word(first)), &
        plural(out_of_reach, "position")//" of "//to_string(size(model%crank%value))// &
        " out of reach, the first at "//to_string(shown, 10)//why)
    end if
  end subroutine check_reach

end module linkage_checks
