!> Checks of what a deck requests: whether all it needs is there, and whether it makes sense.
module request_checks
  use card_table, only: card_names, pattern_of
  use cards, only: card_t
  use diagnostics, only: add_error, add_warning, diagnostics_t, has_errors
  use kinds, only: wp
  use models, only: effects_static, has_law, is_loaded, is_moving, model_t, needs_frequencies, &
    needs_positions, needs_response, needs_study, report_number, report_of_masses
  use motor_cards, only: is_geared
  use name_checks, only: pin_names
  use name_index, only: find_name, name_index_t, new_name_index
  use report_kinds, only: report_kind_t, report_names
  use report_needs, only: check_report_needs
  use response_cards, only: is_response_form
  use response_checks, only: check_response
  use spelling, only: nearest_word, suggestion
  use text, only: joined, same_word, string_t, to_string, upper_case, word_list
  use tokens, only: token_t, token_texts
  use value_lists, only: value_list_t, value_number
  use vibration_checks, only: check_vibrations
  implicit none (type, external)
  private

  public :: check_required, check_requests, has_card

  !> Below this ratio of length to depth, shear and rotary inertia matter.
  real(wp), parameter :: least_slenderness = 10.0_wp

  integer, parameter :: most_modes = 100, most_exponents = 20

contains

  !> Adds an error for every required card that is missing.
  subroutine check_required(cards, reports, diagnostics, model)
    type(card_t), intent(in) :: cards(:)              !! of the deck
    type(report_kind_t), intent(in) :: reports(:)     !! all that exist
    type(diagnostics_t), intent(inout) :: diagnostics !! to which errors are added
    type(model_t), intent(in) :: model                !! with its reports

    logical :: is_fixed

    if (.not. has_card(cards, "UNITS")) &
      call missing("there is no UNITS card; expected: "//pattern_of("UNITS"))
    ! Cards of a file that could not be included are not missing from the deck.
    if (has_card(cards, "INCLUDE")) return
    is_fixed = has_card(cards, "GROUND") .or. has_card(cards, "GUIDE")
    if (.not. is_fixed .or. .not. has_card(cards, "LINK")) then
      call missing("there are no "//trim(merge("GROUND", "LINK  ", .not. is_fixed))// &
        " cards: no linkage is described")
    end if
    if (.not. has_card(cards, "DRIVE") .and. model%motor%keyword%line > 0) then
      call add_error(diagnostics, model%motor%keyword, &
        "a motor needs a driven link; expected: "//pattern_of("DRIVE"))
    else if (.not. has_card(cards, "DRIVE") .and. .not. model%is_structure) then
      call missing("the linkage is not driven; expected: "//pattern_of("DRIVE"))
    end if
    if (needs_positions(model) .and. has_law(model)) then
      if (.not. has_card(cards, "TIME")) call add_error(diagnostics, model%drives(1)%law, &
        "the first drive moves by a law, and there is no TIME card; expected: "//pattern_of("TIME"))
    else if (needs_positions(model) .and. .not. model%is_structure .and. .not. has_card(cards, &
      "CRANK")) then
      call missing("there is no CRANK card; expected: "//pattern_of("CRANK"))
    end if
    ! A speed of 0, the default, is no speed for a steady state.
    if (has_law(model)) then
      if (max(report_number(model, "transient"), report_number(model, "sizing")) > 0 .and. &
        .not. needs_positions(model) .and. .not. has_card(cards, "TIME")) call &
        add_error(diagnostics, model%drives(1)%law, "the first drive moves by a law, and there "// &
        "is no TIME card; expected: "//pattern_of("TIME"))
    else if (needs_response(model) .and. .not. has_card(cards, "SPEED")) then
      call add_error(diagnostics, model%reports(findloc(model%reports%kind%response, .true., &
        dim=1))%keyword, "this report needs a turning crank, and there is no SPEED card; "// &
        "expected: "//pattern_of("SPEED"))
    end if
    if (.not. has_card(cards, "REPORT")) then
      call missing("there is no REPORT card; expected REPORT and one of: "// &
        joined(word_list(report_names(reports))))
    end if

  contains

    subroutine missing(message)
      character(len=*), intent(in) :: message

      call add_error(diagnostics, token_t("", 0, 0), message)
    end subroutine missing

  end subroutine check_required

  !> Whether a deck has a card, correctly spelt or not.
  function has_card(cards, keyword) result(has)
    type(card_t), intent(in) :: cards(:)    !! of the deck
    character(len=*), intent(in) :: keyword !! of the card
    logical :: has

    type(string_t), allocatable :: known(:)
    integer :: i

    has = .true.
    do i = 1, size(cards)
      if (same_word(cards(i)%keyword%text, keyword)) return
    end do
    known = card_names()
    do i = 1, size(cards)
      if (means(cards(i)%keyword%text, keyword, known)) return
    end do
    has = .false.
  end function has_card

  !> Whether an unknown keyword is probably a misspelt `keyword`; that card is then wrong, not
  !! missing.
  pure function means(unknown, keyword, known)
    character(len=*), intent(in) :: unknown, keyword
    type(string_t), intent(in) :: known(:) !! all keywords
    logical :: means

    integer :: i, nearest

    means = .false.
    ! Most keywords are spelt correctly, and comparing spellings takes time.
    do i = 1, size(known)
      if (same_word(known(i)%text, unknown)) return
    end do
    nearest = nearest_word(unknown, known)
    if (nearest > 0) means = same_word(known(nearest)%text, keyword)
  end function means

  !> Checks what reports need, and values that must stand on other cards too; warns of requests that
  !! are doubtful.
  subroutine check_requests(cards, diagnostics, model)
    type(card_t), intent(in) :: cards(:)              !! of the deck
    type(diagnostics_t), intent(inout) :: diagnostics !! to which errors and warnings are added
    type(model_t), intent(in) :: model                !! as far as its cards could be read

    call check_report_needs(diagnostics, model)
    call check_vibrations(diagnostics, model)
    call check_response(cards, diagnostics, model)
    call refuse_too_many_modes(diagnostics, model)
    call check_shapes(diagnostics, model)
    call check_about(diagnostics, model)
    call warn_of_stocky_links(diagnostics, model)
    call warn_of_static_loads(cards, diagnostics, model)
    call warn_of_idle_motors(diagnostics, model)
  end subroutine check_requests

  !> Refuses more modes than are certified.
  pure subroutine refuse_too_many_modes(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    character(len=*), parameter :: exponent_studies(3) = [character(len=9) :: "stability", &
      "intervals", "campbell"]
    integer :: i

    do i = 1, size(exponent_studies)
      if (needs_study(model, trim(exponent_studies(i))) .and. model%modes > most_exponents) &
        call add_error(diagnostics, model%modes_word, "at most "//to_string(most_exponents)// &
        " exponents are found in REPORT "//trim(exponent_studies(i))//", not "// &
        to_string(model%modes))
    end do
    if (.not. needs_frequencies(model) .or. model%modes <= most_modes) return
    call add_error(diagnostics, model%modes_word, "at most "//to_string(most_modes)// &
      " modes are certified, not "//to_string(model%modes))
  end subroutine refuse_too_many_modes

  !> Angles and speeds of REPORT shapes must be among those of CRANK and SPEED.
  subroutine check_shapes(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    integer :: i, number

    number = report_number(model, "shapes")
    if (number == 0) return
    associate (report => model%reports(number))
      call check_values(report%crank, model%crank, "crank angle", "CRANK")
      if (model%effects == effects_static .and. size(report%speed%value) > 0) then
        call add_error(diagnostics, report%speed%words(1), &
          "static shapes do not depend on the speed: 'speed=' has no meaning here")
      else
        call check_values(report%speed, model%speed, "speed", "SPEED")
      end if
    end associate

  contains

    subroutine check_values(wanted, given, noun, card)
      type(value_list_t), intent(in) :: wanted, given
      character(len=*), intent(in) :: noun, card

      do i = 1, size(wanted%value)
        if (size(given%value) == 0 .or. value_number(given, wanted%value(i)) > 0) cycle
        call add_error(diagnostics, wanted%words(wanted%word(i)), "the "//noun//" "// &
          to_string(wanted%value(i))//" is not on the "//card//" card")
      end do
    end subroutine check_values

  end subroutine check_shapes

  !> Moments on the frame are about a point that stands still.
  pure subroutine check_about(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    type(name_index_t) :: grounds, pins
    integer :: number

    number = report_number(model, "frame")
    if (number == 0) return
    associate (pin => model%reports(number)%about_pin)
      if (pin%line == 0) return
      grounds = new_name_index(token_texts(model%grounds%pin))
      if (find_name(grounds, pin%text) > 0) return
      pins = new_name_index(token_texts(pin_names(model)))
      if (find_name(pins, pin%text) > 0) then
        call add_error(diagnostics, pin, "pin '"//pin%text//"' moves, and moments on the frame "// &
          "are about a point that stands still; expected a GROUND pin, or its coordinates: "// &
          "about=x,y")
      else
        call add_error(diagnostics, pin, "unknown ground pivot '"//pin%text//"'"// &
          suggestion(pin%text, grounds%name)//"; expected a GROUND pin, or coordinates: about=x,y")
      end if
    end associate
  end subroutine check_about

  pure subroutine warn_of_stocky_links(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    integer :: i

    if (.not. needs_frequencies(model) .and. .not. needs_response(model)) return
    if (model%rotary .and. model%shear) return
    do i = 1, size(model%links)
      associate (link => model%links(i))
        if (link%section == 0 .or. link%length <= 0.0_wp .or. link%rigid) cycle
        associate (depth => model%sections(link%section)%depth)
          if (depth <= 0.0_wp .or. link%length >= least_slenderness*depth) cycle
          call add_warning(diagnostics, link%length_word, "link '"//link%name%text//"' is only "// &
            to_string(link%length/depth, 3)// &
            " times as long as thick; slender-beam theory needs 10 or "// &
            "more, or EFFECTS rotary shear", amount=depth/link%length)
        end associate
      end associate
    end do
  end subroutine warn_of_stocky_links

  pure subroutine warn_of_static_loads(cards, diagnostics, model)
    type(card_t), intent(in) :: cards(:)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    integer :: i

    character(len=:), allocatable :: what, cards_at_fault

    if (model%effects /= effects_static .or. .not. needs_frequencies(model)) return
    if (.not. is_moving(model) .and. .not. is_loaded(model)) return
    if (.not. is_loaded(model)) then
      what = "the speed"
      cards_at_fault = "SPEED says"
    else if (.not. is_moving(model)) then
      what = "loads"
      cards_at_fault = "GRAVITY, FORCE and TORQUE say"
    else
      what = "speed and loads"
      cards_at_fault = "SPEED, GRAVITY, FORCE and TORQUE say"
    end if
    do i = 1, size(cards)
      if (.not. same_word(cards(i)%keyword%text, "EFFECTS") .or. is_response_form(cards(i))) cycle
      call add_warning(diagnostics, cards(i)%keyword, "static frequencies do not depend on "// &
        what//": they are computed once, whatever "//cards_at_fault)
    end do
  end subroutine warn_of_static_loads

  !> A motor has no effect where the crank angle is prescribed, other loads none on kinematics. Of a
  !! deck with errors a report may be meant.
  pure subroutine warn_of_idle_motors(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    integer :: i

    if (has_errors(diagnostics)) return
    if (report_number(model, "motion") == 0 .and. model%motor%keyword%line > 0) then
      if (.not. is_geared(model%motor)) then
        call add_warning(diagnostics, model%motor%keyword, &
          "MOTOR is used by REPORT motion only, which is not asked for")
      else if (report_number(model, "sizing") == 0) then
        call add_warning(diagnostics, model%motor%keyword, "MOTOR is used by REPORT motion, "// &
          "and its gear and rotor by REPORT sizing, neither of which is asked for")
      end if
    end if
    if (report_of_masses(model) > 0 .or. needs_frequencies(model)) return
    do i = 1, size(model%processes)
      associate (keyword => model%processes(i)%keyword)
        call add_warning(diagnostics, keyword, upper_case(keyword%text)// &
          " is used by reports on forces and motion only, none of which is asked for")
      end associate
    end do
  end subroutine warn_of_idle_motors

end module request_checks
