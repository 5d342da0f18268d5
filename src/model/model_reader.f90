!> Cards → model.
module model_reader
  use actuator_cards, only: read_actuators
  use actuator_checks, only: check_actuators
  use balance_cards, only: is_shaft_form, read_balance, read_shaft, shaft_card_t, shaft_form
  use balance_checks, only: check_balance
  use body_cards, only: read_mass, read_point
  use body_checks, only: check_bodies, warn_of_far_centers
  use card_lists, only: append_card
  use card_reader, only: has_value, read_choice, value_of
  use card_table, only: card_kind_number, card_kinds, card_names
  use cards, only: card_t
  use diagnostics, only: add_error, add_warning, diagnostics_t, has_errors
  use drive_cards, only: branch_t, kind_of_drive, nature_of_drive, read_branch, read_drive
  use drive_checks, only: check_drives
  use effect_cards, only: effects_axial, effects_static, effects_t, read_effects
  use errors, only: error_of_writing
  use four_bar_branches, only: check_format_of_four_bar, find_four_bar_branch
  use followed_places, only: find_followed_places
  use friction_checks, only: check_frictions, read_frictions
  use idle_links, only: leave_out_idle_links
  use joint_cards, only: read_guide, read_pin, read_slider, read_weld
  use joint_checks, only: check_joints
  use kinds, only: wp
  use law_cards, only: read_law, read_time
  use law_checks, only: find_laws, refuse_reports_of_law
  use link_cards, only: read_link
  use link_checks, only: check_links
  use linkage_cards, only: read_ground, read_mesh, read_pin_mass, set_default_mesh
  use load_cards, only: force_card_t, read_force, read_gravity, read_torque, torque_card_t
  use materials, only: read_material
  use measure_cards, only: card_named, read_measure_card
  use measure_checks, only: check_measures
  use mesh_checks, only: check_meshes
  use models, only: as_four_bar, drives_length, has_gauge_histories, has_law, &
    inertia_distributed, inertia_none, is_four_bar, is_loaded, is_moving, is_sprung, model_t, &
    needs_frequencies, needs_inertia, needs_mesh, &
    needs_response, report_number, runs_in_time
  use motor_cards, only: read_motor
  use motor_checks, only: find_motor_line
  use process_cards, only: is_process_form, process_card_t, read_process_force, &
    read_process_torque, read_resistance
  use process_checks, only: find_processes
  use name_checks, only: check_names
  use natures, only: angle_nature, nature_t
  use output_units, only: new_output_units, table_name
  use report_cards, only: read_report
  use report_kinds, only: any_linkage, format_words, four_bars, kind_of_linkage, other_linkages, &
    report_kind_t, table_kind_t
  use request_cards, only: read_crank, read_modes, read_option, read_speed, read_title
  use request_checks, only: check_requests, check_required, has_card
  use response_cards, only: is_response_form, read_damping, read_gauge, read_omitted_terms, &
    response_form
  use response_checks, only: find_dampings, find_gauges
  use sections, only: read_section
  use shear, only: check_shear
  use spelling, only: suggestion
  use stop_checks, only: check_stops, read_stops
  use structure_checks, only: check_structure, describes_structure, take_structure
  use summary_needs, only: add_forces_of_drives, take_needs
  use spring_checks, only: check_springs, read_springs
  use table_cards, only: check_tables
  use text, only: joined, same_word, string_t, upper_case
  use tokens, only: token_t
  use unit_cards, only: read_units
  use unit_checks, only: check_bare_units
  use units, only: coherent_unit, dimension_velocity, from_si, si_units, unit_t
  use value_lists, only: empty_list, value_list_t
  use vibration_checks, only: most_modes
  implicit none (type, external)
  private

  public :: read_model

contains

  !> Turns cards into a model and makes all checks that need no mechanics.
  !!
  !! The model is complete only if `diagnostics` has no errors afterwards. Errors: unknown, repeated
  !! or missing cards, and whatever their readers and the checks report.
  subroutine read_model(cards, reports, diagnostics, model)
    type(card_t), intent(in) :: cards(:)              !! (cards) of one variant, with values in
                                                      !! place of the `$name`s
    type(report_kind_t), intent(in) :: reports(:)     !! (kinds) all that exist
    type(diagnostics_t), intent(inout) :: diagnostics !! errors and warnings are added
    type(model_t), intent(out) :: model               !! in SI, but angles of CRANK in degrees

    logical :: chooses_rate !! UNITS has `speed=`

    model%title = ""
    model%variant = ""
    allocate (model%varied(0))
    model%drive = token_t("", 0, 0)
    model%branch_word = token_t("", 0, 0)
    model%shear_word = token_t("", 0, 0)
    model%modes_word = token_t("", 0, 0)
    model%inertia_word = token_t("", 0, 0)
    model%solver_word = token_t("", 0, 0)
    model%gravity_word = token_t("", 0, 0)
    model%motor%keyword = token_t("", 0, 0)
    model%motor%table_word = token_t("", 0, 0)
    model%motor%line_word = token_t("", 0, 0)
    allocate (model%motor%speed(0), model%motor%line_torque(0))
    model%balance%keyword = token_t("", 0, 0)
    model%without%keyword = token_t("", 0, 0)
    allocate (model%crank%value(0), model%crank%word(0), model%crank%words(0))
    model%speed%value = [0.0_wp]
    model%speed%word = [0]
    allocate (model%speed%words(0))
    model%time = empty_list()
    allocate (model%followed(0))
    model%effects = 0
    call check_keywords(cards, diagnostics)
    call refuse_second_cards(cards, diagnostics)
    call read_system(cards, diagnostics, model, chooses_rate)
    call read_model_cards(cards, reports, diagnostics, model)
    model%has_branch_card = has_card(cards, "BRANCH")
    if (.not. any([has_card(cards, "DRIVE"), has_card(cards, "CRANK"), has_card(cards, "TIME"), &
      has_card(cards, "MOTOR"), has_card(cards, "LAW"), .not. describes_structure(model)])) &
      call take_structure(model)
    call leave_out_idle_links(cards, diagnostics, model)
    call read_springs(cards, diagnostics, model)
    call read_stops(cards, diagnostics, model)
    call read_frictions(cards, diagnostics, model)
    call check_tables(cards, diagnostics)
    call find_laws(cards, diagnostics, model)
    call find_motor_line(cards, diagnostics, model)
    call find_cuts(reports, model)
    call choose_reports(reports, diagnostics, model)
    if (has_law(model)) call refuse_reports_of_law(diagnostics, model)
    if (.not. chooses_rate) call take_rate_of_deck(model)
    call choose_speed_unit(model)
    call show_speeds(model)
    if (model%effects == 0) model%effects = merge(effects_axial, effects_static, &
      is_moving(model) .or. is_loaded(model) .or. is_sprung(model))
    if (model%inertia == inertia_none .and. needs_inertia(model)) model%inertia = &
      inertia_distributed
    if (size(model%meshes) == 0 .and. needs_mesh(model)) then
      deallocate (model%meshes)
      allocate (model%meshes(1))
      call set_default_mesh(model%meshes(1))
    end if
    call check_required(cards, reports, diagnostics, model)
    call check_structure(diagnostics, model)
    call check_names(diagnostics, model)
    call check_bodies(diagnostics, model)
    call find_processes(cards, diagnostics, model)
    call find_followed_places(model)
    call check_links(diagnostics, model)
    call check_joints(diagnostics, model)
    call check_drives(diagnostics, model)
    if (model%modes_word%line == 0) model%modes = max(1, min(model%modes, most_modes(model)))
    call check_springs(diagnostics, model)
    call check_measures(diagnostics, model)
    call check_stops(diagnostics, model)
    call check_actuators(diagnostics, model)
    call check_frictions(diagnostics, model)
    call check_balance(diagnostics, model)
    call find_dampings(diagnostics, model)
    call find_gauges(diagnostics, model)
    call find_four_bar_branch(diagnostics, model)
    call check_requests(cards, diagnostics, model)
    call warn_of_far_centers(diagnostics, model)
    call check_shear(diagnostics, model)
    call check_meshes(cards, diagnostics, model)
    call check_bare_units(cards, diagnostics, model)
  end subroutine read_model

  !> Whether links bend. `REPORT drive` bends those of four-bars, but one with a spring at a point
  !! of a link that bends is a linkage of more parts: that is decided here, before reports are
  !! chosen, as if links were rigid.
  pure subroutine find_cuts(reports, model)
    type(report_kind_t), intent(in) :: reports(:)
    type(model_t), intent(inout) :: model

    type(model_t) :: rigid
    type(diagnostics_t) :: repeated

    if (size(model%springs) == 0 .or. size(model%points) == 0) return
    rigid = model
    call choose_reports(reports, repeated, rigid)
    model%cuts_at_springs = needs_frequencies(rigid) .or. needs_response(rigid)
  end subroutine find_cuts

  !> Takes, of two reports with one name, that on the linkage of the deck, or of `format=`.
  pure subroutine choose_reports(reports, diagnostics, model)
    type(report_kind_t), intent(in) :: reports(:)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(inout) :: model

    logical :: four_bar, is_sound
    integer :: i, number, drives

    ! Of a deck with errors the linkage may be another one than it seems to be.
    is_sound = .not. has_errors(diagnostics)
    call check_format_of_four_bar(diagnostics, model)
    do i = 1, size(model%reports)
      associate (report => model%reports(i))
        if (len_trim(report%kind%name) == 0) cycle
        four_bar = as_four_bar(model)
        if (report%format /= any_linkage) four_bar = report%format == four_bars
        ! An older name means what it has meant, and a mesh is one of links with two pins.
        if (any(report%kind%name == [character(len=5) :: "drive", "mesh"])) four_bar = &
          is_four_bar(model)
        number = kind_of_linkage(reports, trim(report%kind%name), four_bar)
        if (number == 0) number = kind_of_linkage(reports, trim(report%kind%name), &
          is_four_bar(model))
        if (number > 0) then
          report%kind = reports(number)
          if (report%kind%name == "motion") then
            if (.not. report%with_pins) report%kind%tables(2) = table_kind_t()
            if (.not. report%with_coordinates) report%kind%tables(3) = table_kind_t()
            if (.not. report%with_forces) report%kind%tables(4) = table_kind_t()
          end if
          if (report%kind%name == "geometry" .and. report_number(model, "motion") == 0) &
            report%kind%tables(2) = table_kind_t()
          if (report%kind%name == "transient" .and. .not. has_gauge_histories(model)) &
            report%kind%tables(2) = table_kind_t()
          if (report%kind%name == "coordinates") then
            if (report%ratio_to%line == 0) report%kind%tables(2) = table_kind_t()
            call add_forces_of_drives(model, report%kind)
          end if
          if (report%kind%name == "summary") call take_needs(reports, model, as_four_bar(model) &
            .or. is_four_bar(model), is_sound, diagnostics, report)
          if (report%kind%name == "drive") call add_warning(diagnostics, report%keyword, &
            "REPORT drive is an older name; expected REPORT "//merge("torque", "drives", &
            report%kind%linkages == four_bars)//", which has the same columns")
          ! Harmonics are of a whole turn at constant speed.
          if (report%kind%name == "balance" .and. has_law(model)) then
            report%kind%tables(2) = table_kind_t()
            report%kind%studies = report%kind%studies(:index(report%kind%studies, "harmonics") - 1)
          end if
          ! What starts the linkage from rest is told of a first drive that moves all.
          if (report%kind%name == "friction" .and. (runs_in_time(model) .or. &
            size(model%actuators) > 0)) report%kind%tables(2) = table_kind_t()
        else if (is_sound) then
          call add_error(diagnostics, report%keyword, "REPORT "//trim(report%kind%name)// &
            " is made for four-bars only, so far: three links with two pins each, two ground "// &
            "pivots, and a driven link")
          ! What it would need is not asked for.
          report%kind = report_kind_t()
        end if
      end associate
    end do
    number = report_number(model, "drive")
    drives = report_number(model, "drives")
    if (number == 0 .or. drives == 0) return
    if (model%reports(number)%kind%linkages == other_linkages) call add_error(diagnostics, &
      model%reports(number)%keyword, "REPORT drive is the older name of REPORT drives", &
      model%reports(drives)%keyword, "which is here")
  end subroutine choose_reports

  !> Reports every unknown card.
  pure subroutine check_keywords(cards, diagnostics)
    type(card_t), intent(in) :: cards(:)
    type(diagnostics_t), intent(inout) :: diagnostics

    type(string_t), allocatable :: known(:)
    character(len=:), allocatable :: hint
    logical :: listed
    integer :: i

    known = card_names()
    listed = .false.
    do i = 1, size(cards)
      associate (keyword => cards(i)%keyword)
        if (card_kind_number(keyword%text) > 0) cycle
        hint = keyword_hint(keyword%text, known)
        if (len(hint) == 0 .and. .not. listed) then
          ! Once a deck: a file that is no deck at all has an unknown card in every line.
          hint = "; the cards are: "//joined(known)//", END"
          listed = .true.
        end if
        call add_error(diagnostics, keyword, "unknown card '"//keyword%text//"'"//hint, &
          kind=error_of_writing)
      end associate
    end do
  end subroutine check_keywords

  !> What an unknown keyword may mean: a misspelt one, a part of mechanisms that this program does
  !! not have, a comment of another language. Empty if nothing is known.
  pure function keyword_hint(keyword, known) result(hint)
    character(len=*), intent(in) :: keyword
    type(string_t), intent(in) :: known(:)
    character(len=:), allocatable :: hint

    ! In any spelling with or without an s at its end.
    character(len=*), parameter :: not_built = " RACK TORSION DASHPOT CAM GEAR "// &
      "BELT CHAIN CONTACT CLEARANCE ", sliding = " SLIDE PISTON PRISMATIC SLOT BLOCK ", &
      joints = " JOINT HINGE REVOLUTE PIVOT "
    character(len=*), parameter :: signs(*) = ["//", "/*", "--", "% ", "* ", "; ", "''"]
    character(len=:), allocatable :: word

    word = upper_case(keyword)
    if (len(word) > 1 .and. word(len(word):) == "S") word = word(:len(word) - 1)
    if (index(not_built, " "//word//" ") > 0) then
      hint = ": cams, gears, belts and contact are not built yet"
      if (word == "TORSION") hint = "; a torsional spring is a SPRING at a pin of links"
      if (word == "DASHPOT") hint = "; expected DAMPER"
      return
    else if (index(sliding, " "//word//" ") > 0) then
      hint = "; what slides is described by SLIDER, and what it slides along by GUIDE or LINK"
      return
    else if (index(joints, " "//word//" ") > 0) then
      hint = "; links with the same pin turn on it without a card, GROUND fixes a pin, and "// &
        "WELD joins links rigidly"
      return
    end if
    if (any(signs(:3) == keyword(:min(2, len(keyword)))) .or. &
      any(signs(4:)(1:1) == keyword(1:1))) then
      hint = " (a comment begins with ! or #)"
      return
    end if
    hint = suggestion(keyword, known)
  end function keyword_hint

  !> Reports a second card of a kind that a deck may have only once.
  pure subroutine refuse_second_cards(cards, diagnostics)
    type(card_t), intent(in) :: cards(:)
    type(diagnostics_t), intent(inout) :: diagnostics

    integer :: first(size(card_kinds)), i, kind

    first = 0
    do i = 1, size(cards)
      kind = card_kind_number(cards(i)%keyword%text)
      if (kind == 0) cycle
      if (is_response_form(cards(i))) kind = card_kind_number(cards(i)%keyword%text, response_form)
      if (is_shaft_form(cards(i))) kind = card_kind_number(cards(i)%keyword%text, shaft_form)
      if (first(kind) == 0) then
        first(kind) = i
      else if (card_kinds(kind)%is_single) then
        call add_error(diagnostics, cards(i)%keyword, "a second "// &
          trim(trim(card_kinds(kind)%keyword)//" "//card_kinds(kind)%form)//" card", &
          cards(first(kind))%keyword, "the first is here")
      end if
    end do
  end subroutine refuse_second_cards

  !> Reads the UNITS card, which may be anywhere in the deck. Without one the deck is read in SI, to
  !! find its other errors.
  subroutine read_system(cards, diagnostics, model, chooses_rate)
    type(card_t), intent(in) :: cards(:)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(inout) :: model !! gets units and format
    logical, intent(out) :: chooses_rate

    integer :: i

    model%units = si_units()
    model%format_word = token_t("", 0, 0)
    do i = 1, size(cards)
      if (.not. same_word(cards(i)%keyword%text, "UNITS")) cycle
      call read_units(cards(i), diagnostics, model%units, model%outputs, chooses_rate)
      if (.not. has_value(cards(i), "format")) return
      model%format_word = value_of(cards(i), "format")
      call read_choice(model%format_word, format_words, diagnostics, model%format)
      return
    end do
    model%outputs = new_output_units(model%units)
    chooses_rate = .false.
  end subroutine read_system

  !> Angular velocities are given in the unit that the SPEED card names, or else the speed at which
  !! REPORT motion starts. It does not depend on numbers, and is the same in all variants.
  pure subroutine take_rate_of_deck(model)
    type(model_t), intent(inout) :: model !! with its cards read

    integer :: motion

    motion = report_number(model, "motion")
    if (allocated(model%speed%unit%name) .and. .not. drives_length(model)) then
      model%outputs%rate = model%speed%unit
    else if (motion > 0) then
      if (allocated(model%reports(motion)%speed%unit%name)) &
        model%outputs%rate = model%reports(motion)%speed%unit
    end if
    model%outputs%rate%name = table_name(model%outputs%rate)
  end subroutine take_rate_of_deck

  !> The unit of speeds in tables: that of angular velocities, or of a slider or a ram the unit that
  !! the SPEED card names, else the deck's.
  pure subroutine choose_speed_unit(model)
    type(model_t), intent(inout) :: model !! with its cards read, and the unit of angular velocities

    model%speed_unit = model%outputs%rate
    if (.not. drives_length(model)) return
    model%speed_unit = coherent_unit(model%units, dimension_velocity)
    if (allocated(model%speed%unit%name)) model%speed_unit = model%speed%unit
    model%speed_unit%name = table_name(model%speed_unit)
  end subroutine choose_speed_unit

  !> The speeds in the unit of results. Where this is the unit that the deck gives them in, they are
  !! its numbers.
  pure subroutine show_speeds(model)
    type(model_t), intent(inout) :: model !! with its speeds and their unit, and that of angular
                                          !! velocities

    integer :: motion

    model%shown_speed = shown(model%speed, model%speed_unit)
    motion = report_number(model, "motion")
    if (motion == 0) return
    if (size(model%reports(motion)%speed%value) == 0) return
    model%shown_start = sum(shown(model%reports(motion)%speed, model%outputs%rate))

  contains

    pure function shown(list, unit) result(values)
      type(value_list_t), intent(in) :: list !! in SI
      type(unit_t), intent(in) :: unit       !! of the result
      real(wp) :: values(size(list%value))

      values = from_si(list%value, unit)
      if (.not. allocated(list%unit%name)) return
      if (table_name(list%unit) == unit%name) values = list%written
    end function shown

  end subroutine show_speeds

  !> Reads all cards into the model.
  subroutine read_model_cards(cards, reports, diagnostics, model)
    type(card_t), intent(in) :: cards(:)
    type(report_kind_t), intent(in) :: reports(:) !! (kinds) all that exist
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(inout) :: model !! has its units

    integer :: so_far(size(card_kinds)), i, kind, first_drive, first_kind
    type(nature_t) :: nature
    logical :: on_link

    allocate (model%materials(number_of(cards, "MATERIAL")), &
      model%sections(number_of(cards, "SECTION")), model%grounds(number_of(cards, "GROUND")), &
      model%links(number_of(cards, "LINK")), model%pin_masses(number_of(cards, "PINMASS")), &
      model%meshes(number_of(cards, "MESH")), model%reports(number_of(cards, "REPORT")))
    allocate (model%masses(number_of(cards, "MASS")), model%points(number_of(cards, "POINT")), &
      model%dampings(number_of(cards, "DAMPING")), model%gauges(number_of(cards, "GAUGE")))
    allocate (model%drawn_pins(number_of(cards, "PIN")), model%welds(number_of(cards, "WELD")), &
      model%clamps(number_of(cards, "CLAMP")), &
      model%guides(number_of(cards, "GUIDE")), model%sliders(number_of(cards, "SLIDER")), &
      model%drives(number_of(cards, "DRIVE")), model%laws(number_of(cards, "LAW")), &
      model%measures(number_of(cards, "MEASURE")))
    allocate (model%branches(0), model%shafts(0), model%forces(0), model%torques(0), &
      model%processes(0), model%actuators(0))
    ! What the first drive moves says what CRANK and SPEED are.
    do first_drive = 1, size(cards)
      if (same_word(cards(first_drive)%keyword%text, "DRIVE")) exit
    end do
    first_kind = 0
    if (first_drive <= size(cards)) first_kind = kind_of_drive(cards(first_drive), cards)
    so_far = 0
    do i = 1, size(cards)
      kind = card_kind_number(cards(i)%keyword%text)
      if (kind == 0) cycle
      so_far(kind) = so_far(kind) + 1
      on_link = card_kinds(kind)%keyword == "LOAD"
      if (on_link .and. size(cards(i)%words) > 0) on_link = card_named(cards, "LINK", &
        cards(i)%words(1)%text) > 0
      ! Of a law its drive says what its positions are.
      nature = nature_of_drive(first_kind)
      if (card_kinds(kind)%keyword == "LAW") nature = nature_of_law(cards(i), cards)
      call read_card(cards(i), trim(card_kinds(kind)%keyword), so_far(kind), &
        cards(min(first_drive, size(cards))), first_kind, nature, on_link, cards, reports, &
        diagnostics, model)
    end do
    if (size(model%drives) > 0) model%drive = model%drives(1)%subject
  end subroutine read_model_cards

  !> What the positions of a LAW card are: those of the first DRIVE that has it, or without one of
  !! the first of all.
  pure function nature_of_law(law, cards) result(nature)
    type(card_t), intent(in) :: law
    type(card_t), intent(in) :: cards(:) !! all of the deck
    type(nature_t) :: nature

    type(token_t) :: word
    integer :: i
    logical :: is_known

    nature = angle_nature
    is_known = .false.
    do i = 1, size(cards)
      if (.not. same_word(cards(i)%keyword%text, "DRIVE")) cycle
      if (.not. is_known) nature = nature_of_drive(kind_of_drive(cards(i), cards))
      is_known = .true.
      if (size(law%words) == 0) return
      if (.not. has_value(cards(i), "law")) cycle
      word = value_of(cards(i), "law")
      if (.not. same_word(word%text, law%words(1)%text)) cycle
      nature = nature_of_drive(kind_of_drive(cards(i), cards))
      return
    end do
  end function nature_of_law

  pure function number_of(cards, keyword) result(number)
    type(card_t), intent(in) :: cards(:)
    character(len=*), intent(in) :: keyword
    integer :: number

    integer :: i

    number = 0
    do i = 1, size(cards)
      if (same_word(cards(i)%keyword%text, keyword)) number = number + 1
    end do
  end function number_of

  !> Reads one card. UNITS is read before; INCLUDE, SET and VARY are already carried out.
  subroutine read_card(card, keyword, number, first_drive, first_kind, nature, on_link, cards, &
    reports, diagnostics, model)
    type(card_t), intent(in) :: card
    character(len=*), intent(in) :: keyword       !! as in the table of cards
    integer, intent(in) :: number                 !! of the card among those of its keyword, from 1
    type(card_t), intent(in) :: first_drive       !! the first DRIVE card, if there is one
    integer, intent(in) :: first_kind             !! what it drives; 0 without one
    type(nature_t), intent(in) :: nature          !! of positions on it
    logical, intent(in) :: on_link                !! of LOAD: its first word names a link
    type(card_t), intent(in) :: cards(:)          !! all of the deck
    type(report_kind_t), intent(in) :: reports(:) !! (kinds) all that exist
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(inout) :: model !! has its units, and its lists their lengths

    type(branch_t) :: branch
    type(force_card_t) :: force
    type(torque_card_t) :: torque
    type(process_card_t) :: process
    type(shaft_card_t) :: shaft

    associate (system => model%units)
      select case (keyword)
      case ("TITLE")
        call read_title(card, diagnostics, model%title)
      case ("MATERIAL")
        call read_material(card, system, diagnostics, model%materials(number))
      case ("SECTION")
        call read_section(card, system, diagnostics, model%sections(number))
      case ("GROUND")
        call read_ground(card, system, diagnostics, model%grounds(number))
      case ("LINK")
        call read_link(card, system, diagnostics, model%links(number))
      case ("DRIVE")
        call read_drive(card, kind_of_drive(card, cards), first_drive, first_kind, system, &
          diagnostics, model%drives(number))
      case ("BRANCH")
        call read_branch(card, diagnostics, model%branch, model%branch_word, branch)
        if (branch%pin%line > 0) call append_card(model%branches, branch)
      case ("PIN")
        call read_pin(card, system, diagnostics, model%drawn_pins(number))
      case ("WELD")
        call read_weld(card, diagnostics, model%welds(number))
      case ("CLAMP")
        call read_weld(card, diagnostics, model%clamps(number))
      case ("GUIDE")
        call read_guide(card, system, diagnostics, model%guides(number))
      case ("SLIDER")
        call read_slider(card, system, diagnostics, model%sliders(number))
      case ("PINMASS")
        call read_pin_mass(card, system, diagnostics, model%pin_masses(number))
      case ("MESH")
        call read_mesh(card, system, diagnostics, model%meshes(number))
      case ("MASS")
        call read_mass(card, system, diagnostics, model%masses(number))
      case ("POINT")
        call read_point(card, system, diagnostics, model%points(number))
      case ("DAMPING")
        call read_damping(card, system, diagnostics, model%dampings(number))
      case ("GAUGE")
        call read_gauge(card, system, diagnostics, model%gauges(number))
      case ("GRAVITY")
        model%gravity_word = card%keyword
        call read_gravity(card, system, diagnostics, model%gravity)
      case ("FORCE")
        if (is_process_form(card)) then
          call read_process_force(card, system, diagnostics, process)
          call append_card(model%processes, process)
        else
          call read_force(card, system, diagnostics, force)
          if (force%pin%line > 0) call append_card(model%forces, force)
        end if
      case ("TORQUE")
        if (is_process_form(card)) then
          call read_process_torque(card, system, diagnostics, process)
          call append_card(model%processes, process)
        else
          call read_torque(card, system, diagnostics, torque)
          if (torque%link_name%line > 0) call append_card(model%torques, torque)
        end if
      case ("MEASURE")
        call read_measure_card(card, cards, system, diagnostics, model%measures(number))
      case ("ACTUATE")
        call read_actuators(card, diagnostics, model%actuators)
      case ("MOTOR")
        call read_motor(card, system, diagnostics, model%motor)
      case ("LOAD")
        call read_resistance(card, on_link, system, diagnostics, process)
        call append_card(model%processes, process)
      case ("BALANCE")
        if (is_shaft_form(card)) then
          call read_shaft(card, system, diagnostics, shaft)
          call append_card(model%shafts, shaft)
        else
          call read_balance(card, system, diagnostics, model%balance)
        end if
      case ("CRANK")
        call read_crank(card, system, diagnostics, model%crank, nature)
      case ("SPEED")
        call read_speed(card, system, diagnostics, model%speed, model%acceleration, &
          model%ramp, model%ramp_word, nature)
      case ("LAW")
        call read_law(card, system, diagnostics, model%laws(number), nature)
      case ("TIME")
        call read_time(card, system, diagnostics, model%time)
      case ("INERTIA")
        call read_option(card, diagnostics, model%inertia, model%inertia_word)
      case ("EFFECTS")
        if (is_response_form(card)) then
          call read_omitted_terms(card, diagnostics, model%without)
        else
          call take_effects(card, diagnostics, model)
        end if
      case ("SOLVER")
        call read_option(card, diagnostics, model%solver, model%solver_word)
      case ("MODES")
        call read_modes(card, diagnostics, model%modes, model%modes_word)
      case ("REPORT")
        call read_report(card, reports, system, diagnostics, model%reports(number), nature)
      end select
    end associate
  end subroutine read_card

  !> Reads an EFFECTS card into a model.
  subroutine take_effects(card, diagnostics, model)
    type(card_t), intent(in) :: card
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(inout) :: model

    type(effects_t) :: effects

    effects%loads = model%effects
    effects%shear_word = model%shear_word
    call read_effects(card, diagnostics, effects)
    model%effects = effects%loads
    model%rotary = effects%rotary
    model%shear = effects%shear
    model%shear_word = effects%shear_word
  end subroutine take_effects

end module model_reader
