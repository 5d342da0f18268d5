! src/model/ - what a deck says: the linkage as its user describes it, and what is asked of it.
! In: the cards of one variant. Out: a `model_t`, and messages at the words that they are about.
! Begin with `model_t` here, then `read_model` in `model_reader.f90`, which calls all readers
! (`src/model/cards`, `src/model/requests`) and checks (`src/model/checks`).
! Not here: the language of cards (`src/deck/language`), bodies by number (`src/mechanism`), checks
! by mechanics (`src/runs/checks`).

!> The model: the contents of a deck in SI (crank angles in degrees), each part with the word of the
!! deck it came from.
module models
  use actuator_cards, only: actuator_card_t
  use balance_cards, only: balance_card_t, shaft_card_t
  use body_cards, only: mass_card_t, point_t
  use card_echo, only: echo_line_t
  use drive_cards, only: branch_t, drive_angle, drive_card_t
  use effect_cards, only: effects_axial, effects_static
  use friction_cards, only: friction_card_t
  use joint_cards, only: drawn_pin_t, guide_t, slider_card_t, weld_t
  use kinds, only: wp
  use law_cards, only: law_card_t
  use link_cards, only: has_own_mass, link_t
  use linkage_cards, only: ground_t, mesh_t, pin_mass_t
  use load_cards, only: force_card_t, torque_card_t
  use materials, only: material_t
  use measure_cards, only: measure_card_t
  use motion_programs, only: motion_program_t
  use motor_cards, only: motor_t
  use natures, only: angle_nature, is_angular, nature_t
  use process_cards, only: over_nothing, process_card_t
  use output_units, only: output_units_t
  use report_cards, only: report_t
  use report_kinds, only: any_linkage, four_bars, report_kind_t
  use response_cards, only: damping_card_t, gauge_card_t, omitted_terms_t
  use sections, only: section_t
  use spring_cards, only: spring_card_t
  use stop_cards, only: stop_card_t
  use summary_cards, only: takes_from
  use text, only: same_word, to_string
  use tokens, only: token_t
  use units, only: from_si, unit_system_t, unit_t
  use value_lists, only: value_list_t
  implicit none (type, external)
  private

  public :: model_t, report_number, report_with, needs_study, needs_positions, is_moving, &
    is_loaded, is_sprung, is_damped, needs_loads, needs_inertia, needs_frequencies, &
    needs_response, has_gauge_histories, report_in_motion, steady_state_report, &
    accuracy_of_study, needs_beams, &
    bends_links, needs_masses, weighs_links, needs_mesh, report_of_masses, bears_lumped_masses, &
    link_mass, &
    link_line_density, speed_in_table, speed_in_words, is_four_bar, as_four_bar, &
    is_of_four_bar, word_of_four_bar, is_pin, pivots, &
    is_end_of_spring, is_end_of_measure, nature_of_positions, drives_length, balances, &
    has_law, runs_in_time, rule_at_change_points, motion_goes_through
  public :: inertia_none, inertia_lumped, inertia_distributed, effects_static, effects_axial
  public :: solver_auto, solver_deformation, solver_dense, solver_band, branch_open, branch_crossed

  ! In the order of the words in the table of cards.
  integer, parameter :: inertia_none = 0, inertia_lumped = 1, inertia_distributed = 2
  integer, parameter :: solver_auto = 1, solver_deformation = 2, solver_dense = 3, solver_band = 4
  integer, parameter :: branch_open = 1, branch_crossed = 2

  !> Lists are in the order of the deck. A word without a line is not in the deck.
  type :: model_t
    character(len=:), allocatable :: title      !! empty without TITLE
    type(unit_system_t) :: units                !! of bare numbers; the model itself is in SI
    type(output_units_t) :: outputs             !! of results
    type(material_t), allocatable :: materials(:)
    type(section_t), allocatable :: sections(:)
    type(ground_t), allocatable :: grounds(:)
    type(drawn_pin_t), allocatable :: drawn_pins(:) !! PIN cards
    type(drawn_pin_t), allocatable :: followed(:)   !! pins and POINTs without one, whose places
                                                    !! follow
    type(link_t), allocatable :: links(:)
    type(weld_t), allocatable :: welds(:)
    type(weld_t), allocatable :: clamps(:)      !! CLAMP cards: links that turn with the ground
    type(guide_t), allocatable :: guides(:)
    type(slider_card_t), allocatable :: sliders(:)
    type(pin_mass_t), allocatable :: pin_masses(:)
    type(mesh_t), allocatable :: meshes(:)
    type(mass_card_t), allocatable :: masses(:)
    type(point_t), allocatable :: points(:)
    type(damping_card_t), allocatable :: dampings(:)
    type(gauge_card_t), allocatable :: gauges(:)
    real(wp) :: gravity(2) = 0.0_wp             !! in global axes [m/s²]
    type(token_t) :: gravity_word               !! keyword
    type(force_card_t), allocatable :: forces(:)
    type(torque_card_t), allocatable :: torques(:)
    type(motor_t) :: motor
    type(process_card_t), allocatable :: processes(:) !! FORCE, TORQUE and LOAD cards on all
                                                !! other loads
    type(spring_card_t), allocatable :: springs(:)   !! SPRING and DAMPER cards
    type(stop_card_t), allocatable :: stops(:)       !! STOP cards
    type(friction_card_t), allocatable :: frictions(:) !! FRICTION cards
    type(measure_card_t), allocatable :: measures(:)   !! MEASURE cards
    type(actuator_card_t), allocatable :: actuators(:) !! names of ACTUATE cards
    type(balance_card_t) :: balance             !! counterweights of REPORT balance
    type(shaft_card_t), allocatable :: shafts(:) !! its balance shafts
    type(law_card_t), allocatable :: laws(:)    !! LAW cards
    type(drive_card_t), allocatable :: drives(:)     !! the first one's positions are those of CRANK
    logical :: is_structure = .false.           !! without a drive, by intent: one position
    logical :: cuts_at_springs = .false.        !! links bend: a point with a spring is a pin
    type(token_t) :: drive                      !! first word of the first DRIVE card: the driven
                                                !! link, or the pin of the driven slider
    integer :: format = any_linkage             !! of all tables: four_bars or other_linkages by
                                                !! UNITS … format=; else as the deck is
    type(token_t) :: format_word                !! its word
    integer :: branch = branch_open             !! of a four-bar: branch_open or branch_crossed
    type(token_t) :: branch_word                !! keyword of BRANCH open|crossed
    logical :: has_branch_card = .false.        !! of any form
    type(branch_t), allocatable :: branches(:)  !! BRANCH cards about pins; of a four-bar
                                                !! the one that says its branch
    type(value_list_t) :: crank                 !! positions of the first drive: angles [deg], of a
                                                !! slider or a ram [m]; in time, instants [s]
    type(value_list_t) :: speed                 !! ω2 [rad/s], of a slider or a ram [m/s]
    type(unit_t) :: speed_unit                  !! of speeds in tables: `outputs%rate`, of a slider
                                                !! or a ram a unit of velocity
    real(wp), allocatable :: shown_speed(:)     !! (speeds) in `speed_unit`, as the deck has them
    real(wp) :: shown_start = 0.0_wp            !! start speed of REPORT motion in `outputs%rate`,
                                                !! likewise
    real(wp) :: acceleration = 0.0_wp           !! α2, at every speed [rad/s²], of a slider or a ram
                                                !! [m/s²]
    type(value_list_t) :: time                  !! instants of a law [s], each with its position in
                                                !! `crank`; else empty
    real(wp), allocatable :: law_rates(:, :)    !! (2, instants) speed and acceleration [as `speed`,
                                                !! `acceleration`]; not allocated without a law
    type(motion_program_t) :: program           !! the law, its positions in degrees, of a slider
                                                !! or a ram in m
    type(motion_program_t), allocatable :: programs(:) !! (drives) their laws, likewise; of those
                                                !! without one of no use. Allocated in time only
    real(wp), allocatable :: law_places(:)      !! (instants) positions of the first drive in time
                                                !! [deg] or [m]; allocated in time only
    real(wp) :: ramp = 0.0_wp                   !! time in which REPORT transient gets to the speed
                                                !! from rest; 0: it has it [s]
    type(token_t) :: ramp_word
    integer :: inertia = inertia_none           !! one of the inertia_… constants; none: it does not
                                                !! matter
    type(token_t) :: inertia_word
    integer :: effects = effects_static         !! effects_static or effects_axial
    logical :: rotary = .false.                 !! cross-sections have rotary inertia
    logical :: shear = .false.                  !! shear: cross-sections turn relative to the slope
    type(token_t) :: shear_word                 !! `shear` on the EFFECTS card
    type(omitted_terms_t) :: without            !! terms left out of the elastic response
    integer :: solver = solver_auto             !! one of the solver_… constants
    type(token_t) :: solver_word
    integer :: modes = 3                        !! at each position
    type(token_t) :: modes_word
    type(report_t), allocatable :: reports(:)
    type(echo_line_t), allocatable :: echo(:)   !! (cards) written back; set after the model is read
    character(len=:), allocatable :: variant    !! `L=90mm`, of a deck with VARY; else empty
    real(wp), allocatable :: varied(:)          !! (parameters) values of this variant, in the units
                                                !! of the VARY cards
  end type model_t

contains

  !> Number of a report in the model's list; 0 if it is not requested.
  pure function report_number(model, name) result(number)
    type(model_t), intent(in) :: model   !! as read
    character(len=*), intent(in) :: name !! of the report, as in the table of reports
    integer :: number

    integer :: i

    number = 0
    do i = 1, size(model%reports)
      if (model%reports(i)%kind%name == name) number = i
    end do
  end function report_number

  !> Number of the first report that has values of a report: this one, or a summary of its
  !! quantities; 0 if there is none.
  pure function report_with(model, name) result(number)
    type(model_t), intent(in) :: model   !! as read
    character(len=*), intent(in) :: name !! of a report, as in the table of reports
    integer :: number

    do number = 1, size(model%reports)
      associate (report => model%reports(number))
        if (report%kind%name == name .or. takes_from(report%summary, name)) return
      end associate
    end do
    number = 0
  end function report_with

  !> Whether REPORT transient, if there is one, is to have strains: GAUGE cards or REPORT strains
  !! ask for them.
  pure function has_gauge_histories(model) result(has)
    type(model_t), intent(in) :: model !! as read
    logical :: has

    has = size(model%gauges) > 0 .or. report_with(model, "strains") > 0
  end function has_gauge_histories

  !> Whether the linkage has the parts of a four-bar and no others: three links between two pins
  !! each, two ground pivots, one driven link. GROUND pins that are ends of springs and measures
  !! only do not count. Decks that were made with PIN or BRANCH cards about pins must form its loop,
  !! too; of others a pin that does not fit is a mistake.
  pure function is_four_bar(model) result(is)
    type(model_t), intent(in) :: model !! as read
    logical :: is

    integer :: i

    is = .not. model%is_structure .and. size(model%links) == 3 .and. &
      size(pivots(model)) == 2 .and. size(model%guides) == 0 .and. &
      size(model%sliders) == 0 .and. size(model%welds) == 0 .and. size(model%clamps) == 0 .and. &
      size(model%drives) <= 1
    if (.not. is) return
    do i = 1, size(model%drives)
      is = is .and. model%drives(i)%kind <= drive_angle .and. .not. model%drives(i)%is_free
    end do
    do i = 1, 3
      ! A link without pins cannot be read.
      is = is .and. size(model%links(i)%pins) <= 2
    end do
    do i = 1, size(model%points)
      is = is .and. .not. is_pin(model, model%points(i)%name%text)
    end do
    if (.not. is .or. (size(model%drawn_pins) == 0 .and. size(model%branches) == 0)) return
    is = forms_loop(model)
  end function is_four_bar

  !> Whether tables and words that ask for no other format are those of four-bars.
  pure function as_four_bar(model) result(as)
    type(model_t), intent(in) :: model !! as read
    logical :: as

    as = model%format == four_bars
    if (model%format == any_linkage) as = is_four_bar(model) .and. size(model%actuators) == 0
  end function as_four_bar

  !> Whether a report, which the deck has, is written as of a four-bar.
  pure function is_of_four_bar(model, name) result(is)
    type(model_t), intent(in) :: model   !! as read
    character(len=*), intent(in) :: name !! of the report
    logical :: is

    is = model%reports(report_number(model, name))%kind%linkages == four_bars
  end function is_of_four_bar

  !> The word that asks for tables of four-bars; without a line if none does.
  pure function word_of_four_bar(model) result(word)
    type(model_t), intent(in) :: model !! as read
    type(token_t) :: word

    integer :: i

    word = token_t("", 0, 0)
    do i = size(model%reports), 1, -1
      if (model%reports(i)%format == four_bars) word = model%reports(i)%format_word
    end do
    if (model%format == four_bars) word = model%format_word
  end function word_of_four_bar

  !> Whether links, PINMASS or FORCE cards take a name for that of a pin; and springs on a link that
  !! bends, where frequencies are asked for.
  pure function is_pin(model, name) result(is)
    type(model_t), intent(in) :: model
    character(len=*), intent(in) :: name
    logical :: is

    integer :: i, k

    is = .true.
    do i = 1, size(model%links)
      do k = 1, size(model%links(i)%pins)
        if (same_word(model%links(i)%pins(k)%text, name)) return
      end do
    end do
    do i = 1, size(model%pin_masses)
      if (same_word(model%pin_masses(i)%pin%text, name)) return
    end do
    do i = 1, size(model%forces)
      if (same_word(model%forces(i)%pin%text, name)) return
    end do
    do i = 1, size(model%processes)
      if (.not. model%processes(i)%on_link .and. same_word(model%processes(i)%subject%text, name)) &
        return
    end do
    is = holds_spring(model, name)
  end function is_pin

  !> Whether a SPRING or DAMPER card names a place.
  pure function is_end_of_spring(model, name) result(is)
    type(model_t), intent(in) :: model
    character(len=*), intent(in) :: name
    logical :: is

    integer :: i, k

    is = .false.
    if (.not. allocated(model%springs)) return
    do i = 1, size(model%springs)
      do k = 1, 2
        if (model%springs(i)%ends(k)%line > 0) is = is .or. &
          same_word(model%springs(i)%ends(k)%text, name)
      end do
    end do
  end function is_end_of_spring

  !> Whether a MEASURE card names a place.
  pure function is_end_of_measure(model, name) result(is)
    type(model_t), intent(in) :: model !! as read
    character(len=*), intent(in) :: name
    logical :: is

    integer :: i, k

    is = .false.
    do i = 1, size(model%measures)
      do k = 1, 2
        if (model%measures(i)%places(k)%line > 0) is = is .or. &
          same_word(model%measures(i)%places(k)%text, name)
      end do
    end do
  end function is_end_of_measure

  !> Whether links bend, and a name is that of a point at which a spring or damper holds one that
  !! does.
  pure function holds_spring(model, name) result(holds)
    type(model_t), intent(in) :: model
    character(len=*), intent(in) :: name
    logical :: holds

    integer :: i, k

    holds = .false.
    if (model%cuts_at_springs) holds = is_end_of_spring(model, name)
    if (.not. holds) return
    do i = 1, size(model%points)
      if (.not. same_word(model%points(i)%name%text, name)) cycle
      do k = 1, size(model%links)
        holds = same_word(model%points(i)%link_name%text, model%links(k)%name%text)
        if (.not. holds) cycle
        holds = .not. model%links(k)%rigid
        return
      end do
    end do
    holds = .false.
  end function holds_spring

  !> Whether three links of two pins lead from one ground pivot to the other: each ground pivot
  !! carries one link, each other pin joins two, and no link joins the ground pivots.
  pure function forms_loop(model) result(forms)
    type(model_t), intent(in) :: model !! with two ground pivots
    logical :: forms

    integer :: ground(2), i, k, g, uses, grounded
    logical :: is_ground

    ground = pivots(model)
    forms = .true.
    do i = 1, 3
      grounded = 0
      do k = 1, size(model%links(i)%pins)
        associate (pin => model%links(i)%pins(k)%text)
          is_ground = .false.
          do g = 1, 2
            is_ground = is_ground .or. same_word(model%grounds(ground(g))%pin%text, pin)
          end do
          if (is_ground) grounded = grounded + 1
          uses = pin_uses(model, pin)
          forms = forms .and. uses == merge(1, 2, is_ground)
        end associate
      end do
      forms = forms .and. grounded < 2
    end do
  end function forms_loop

  !> Numbers of the GROUND pins, but for those that are ends of springs, dampers and measures only.
  pure function pivots(model) result(numbers)
    type(model_t), intent(in) :: model !! as read
    integer, allocatable :: numbers(:)

    logical :: is_end(size(model%grounds))
    integer :: g

    do g = 1, size(model%grounds)
      associate (pin => model%grounds(g)%pin%text)
        is_end(g) = is_end_of_spring(model, pin) .or. is_end_of_measure(model, pin)
        if (is_end(g)) is_end(g) = pin_uses(model, pin) == 0
      end associate
    end do
    numbers = pack([(g, g=1, size(model%grounds))], .not. is_end)
  end function pivots

  !> How many links have a pin.
  pure function pin_uses(model, name) result(uses)
    type(model_t), intent(in) :: model
    character(len=*), intent(in) :: name
    integer :: uses

    integer :: i, k

    uses = 0
    do i = 1, size(model%links)
      do k = 1, size(model%links(i)%pins)
        if (same_word(model%links(i)%pins(k)%text, name)) uses = uses + 1
      end do
    end do
  end function pin_uses

  !> What positions of the deck are: those of its first drive.
  pure function nature_of_positions(model) result(nature)
    type(model_t), intent(in) :: model !! as read
    type(nature_t) :: nature

    nature = angle_nature
    if (size(model%drives) > 0) nature = model%drives(1)%nature
  end function nature_of_positions

  !> Whether positions and speeds of the deck are those of a slider or a ram, lengths and
  !! velocities; else they are angles and angular velocities.
  pure function drives_length(model) result(drives)
    type(model_t), intent(in) :: model !! as read
    logical :: drives

    drives = .false.
    if (size(model%drives) > 0) drives = .not. is_angular(model%drives(1)%nature)
  end function drives_length

  !> Whether the deck has BALANCE cards.
  pure function balances(model) result(has)
    type(model_t), intent(in) :: model !! as read
    logical :: has

    has = model%balance%keyword%line > 0 .or. size(model%shafts) > 0
  end function balances

  !> Whether further drives have laws of their own: then the time takes the place of the first
  !! drive wherever the linkage is placed and moved.
  pure function runs_in_time(model) result(runs)
    type(model_t), intent(in) :: model !! as read
    logical :: runs

    runs = .false.
    if (size(model%drives) > 1) runs = any(model%drives(2:)%law%line > 0)
  end function runs_in_time

  !> Whether the first drive moves by a law.
  pure function has_law(model) result(has)
    type(model_t), intent(in) :: model !! as read
    logical :: has

    has = allocated(model%law_rates)
  end function has_law

  !> What happens at change points, in the order of the words of DRIVE. Where a BRANCH card is
  !! written, each position is on its side.
  pure function rule_at_change_points(model) result(rule)
    type(model_t), intent(in) :: model !! as read
    integer :: rule

    rule = merge(3, 1, model%has_branch_card)
    if (size(model%drives) == 0) return
    if (model%drives(1)%change_points > 0) rule = model%drives(1)%change_points
  end function rule_at_change_points

  !> Whether the motion of REPORT motion goes through change points: as its card says, or else that
  !! of the first DRIVE. Friction depends on forces that are not determined there.
  pure function motion_goes_through(model) result(goes)
    type(model_t), intent(in) :: model !! with that report
    logical :: goes

    associate (report => model%reports(report_number(model, "motion")))
      goes = report%through
      if (report%through_word%line == 0) goes = rule_at_change_points(model) == 1 .and. &
        size(model%frictions) == 0
    end associate
  end function motion_goes_through

  !> Whether any report has a row for every crank angle; true without REPORT cards. A report that
  !! cannot be read does not count.
  pure function needs_positions(model) result(needs)
    type(model_t), intent(in) :: model !! as read
    logical :: needs

    needs = size(model%reports) == 0 .or. any(model%reports%kind%positions)
  end function needs_positions

  !> Whether the linkage moves by a law, or any speed or the acceleration is not zero.
  pure function is_moving(model) result(is)
    type(model_t), intent(in) :: model !! as read
    logical :: is

    is = has_law(model) .or. any(abs(model%speed%value) > 0.0_wp) .or. &
      abs(model%acceleration) > 0.0_wp
  end function is_moving

  !> Whether there are external loads: gravity, forces on pins or torques on links.
  pure function is_loaded(model) result(is)
    type(model_t), intent(in) :: model !! as read
    logical :: is

    integer :: i

    is = any(abs(model%gravity) > 0.0_wp)
    do i = 1, size(model%forces)
      is = is .or. any(abs(model%forces(i)%force) > 0.0_wp)
    end do
    is = is .or. any(abs(model%torques%torque) > 0.0_wp)
    do i = 1, size(model%processes)
      associate (process => model%processes(i))
        is = is .or. process%during == 0 .and. (process%over /= over_nothing .or. &
          any(abs(process%force) > 0.0_wp) .or. abs(process%torque) > 0.0_wp)
      end associate
    end do
  end function is_loaded

  !> Whether springs load the links: all SPRING cards do.
  pure function is_sprung(model) result(is)
    type(model_t), intent(in) :: model !! as read
    logical :: is

    is = .false.
    if (allocated(model%springs)) is = any(.not. model%springs%damps)
  end function is_sprung

  !> Whether the linkage has dampers.
  pure function is_damped(model) result(is)
    type(model_t), intent(in) :: model !! as read
    logical :: is

    is = .false.
    if (allocated(model%springs)) is = any(model%springs%damps)
  end function is_damped

  !> Whether frequencies are requested: alone, with mode shapes or as loci.
  pure function needs_frequencies(model) result(needs)
    type(model_t), intent(in) :: model !! as read
    logical :: needs

    needs = any(model%reports%kind%frequencies)
  end function needs_frequencies

  !> Whether anything is requested of the elastic linkage that turns at constant speed: its
  !! response, its stability.
  pure function needs_response(model) result(needs)
    type(model_t), intent(in) :: model !! as read
    logical :: needs

    needs = any(model%reports%kind%response)
  end function needs_response

  !> The first report on the elastic linkage that turns at constant speed: `REPORT response`.
  pure function report_in_motion(model) result(words)
    type(model_t), intent(in) :: model !! with such a report
    character(len=:), allocatable :: words

    words = "REPORT "//trim(model%reports(findloc(model%reports%kind%response, .true., &
      dim=1))%kind%name)
  end function report_in_motion

  !> The accuracy of a study of the elastic linkage in motion: the smallest of all reports on it,
  !! for they share one solution.
  pure function accuracy_of_study(model, study) result(accuracy)
    type(model_t), intent(in) :: model    !! as read, with a report on it
    character(len=*), intent(in) :: study !! name of the study, as in the table of reports
    real(wp) :: accuracy

    integer :: i

    accuracy = huge(1.0_wp)
    do i = 1, size(model%reports)
      if (uses_study(model%reports(i)%kind, study)) accuracy = min(accuracy, &
        model%reports(i)%accuracy)
    end do
  end function accuracy_of_study

  !> Number of the first report that needs a crank that turns fully at constant speed, 0 if there is
  !! none: all on the elastic linkage in motion, but motions in time only if they start from that
  !! state.
  pure function steady_state_report(model) result(number)
    type(model_t), intent(in) :: model !! as read
    integer :: number

    do number = 1, size(model%reports)
      associate (report => model%reports(number))
        if (.not. report%kind%response) cycle
        if (report%kind%name /= "transient" .or. report%transient%steady) return
      end associate
    end do
    number = 0
  end function steady_state_report

  !> Whether any report is on links that bend, by their elements or without.
  pure function bends_links(model) result(bends)
    type(model_t), intent(in) :: model !! as read
    logical :: bends

    bends = needs_beams(model) .or. needs_response(model)
  end function bends_links

  !> Whether any report takes links as beams divided into elements.
  pure function needs_beams(model) result(needs)
    type(model_t), intent(in) :: model !! as read
    logical :: needs

    needs = any(model%reports%kind%beams)
  end function needs_beams

  !> Number of the first report on masses and their loads; 0 if none is requested.
  pure function report_of_masses(model) result(number)
    type(model_t), intent(in) :: model !! as read
    integer :: number

    do number = 1, size(model%reports)
      if (model%reports(number)%kind%masses) return
    end do
    number = 0
  end function report_of_masses

  !> Whether any report takes its rows from a study.
  pure function needs_study(model, study) result(needs)
    type(model_t), intent(in) :: model    !! as read
    character(len=*), intent(in) :: study !! name of the study, as in the table of reports
    logical :: needs

    integer :: i

    needs = .false.
    do i = 1, size(model%reports)
      needs = needs .or. uses_study(model%reports(i)%kind, study)
    end do
  end function needs_study

  !> Whether a report takes its rows from a study.
  pure function uses_study(kind, study) result(uses)
    type(report_kind_t), intent(in) :: kind
    character(len=*), intent(in) :: study
    logical :: uses

    uses = index(" "//kind%studies, " "//trim(study)//" ") > 0
  end function uses_study

  !> Whether any report is on masses and their loads.
  pure function needs_masses(model) result(needs)
    type(model_t), intent(in) :: model !! as read
    logical :: needs

    needs = report_of_masses(model) > 0
  end function needs_masses

  !> Whether any report depends on the masses of links: at rest and without gravity, forces do not.
  pure function weighs_links(model) result(weighs)
    type(model_t), intent(in) :: model !! as read
    logical :: weighs

    if (is_moving(model) .or. any(abs(model%gravity) > 0.0_wp)) then
      weighs = needs_masses(model)
    else
      weighs = any(model%reports%kind%weighs)
    end if
  end function weighs_links

  !> Whether the lumped masses of a link sit on nodes: those of its section. A link that is rigid or
  !! has a mass of its own has no nodes.
  elemental function bears_lumped_masses(link) result(bears)
    type(link_t), intent(in) :: link !! of the deck
    logical :: bears

    bears = link%section_name%line > 0 .and. .not. (link%rigid .or. has_own_mass(link))
  end function bears_lumped_masses

  !> Whether links must be divided into elements: for beams, and for lumped masses, which sit on
  !! nodes.
  pure function needs_mesh(model) result(needs)
    type(model_t), intent(in) :: model !! as read
    logical :: needs

    needs = needs_beams(model)
    if (model%inertia == inertia_lumped .and. needs_masses(model)) needs = needs .or. &
      any(bears_lumped_masses(model%links))
  end function needs_mesh

  !> Whether requested frequencies depend on loads, of the motion, of springs or external ones.
  pure function needs_loads(model) result(needs)
    type(model_t), intent(in) :: model !! as read
    logical :: needs

    needs = needs_frequencies(model) .and. model%effects == effects_axial .and. &
      (is_moving(model) .or. is_loaded(model) .or. is_sprung(model))
  end function needs_loads

  !> Whether results depend on INERTIA, which determines how the mass of links makes loads. At a
  !! structure it makes none but weights.
  pure function needs_inertia(model) result(needs)
    type(model_t), intent(in) :: model !! as read
    logical :: needs

    needs = needs_frequencies(model) .and. model%effects == effects_axial .and. &
      (is_moving(model) .or. any(abs(model%gravity) > 0.0_wp))
    needs = (needs .or. needs_masses(model)) .and. any(bears_lumped_masses(model%links))
    if (model%is_structure) needs = needs .and. any(abs(model%gravity) > 0.0_wp)
  end function needs_inertia

  !> A speed in the unit of results: that of the deck to the last digit.
  pure function speed_in_table(model, number, speed) result(value)
    type(model_t), intent(in) :: model !! as read
    integer, intent(in) :: number      !! of the speed, among those of the deck or of a study
    real(wp), intent(in) :: speed      !! ω2 [rad/s]
    real(wp) :: value

    ! A study may have other speeds than the deck: static frequencies have one, 0.
    value = from_si(speed, model%speed_unit)
    if (number > size(model%speed%value)) return
    if (abs(model%speed%value(number) - speed) <= 0.0_wp) value = model%shown_speed(number)
  end function speed_in_table

  !> `20 rad/s`, `300 rpm`
  pure function speed_in_words(model, number, speed) result(words)
    type(model_t), intent(in) :: model !! as read
    integer, intent(in) :: number      !! as for `speed_in_table`
    real(wp), intent(in) :: speed      !! ω2 [rad/s]
    character(len=:), allocatable :: words

    words = to_string(speed_in_table(model, number, speed), 12)//" "//model%speed_unit%name
  end function speed_in_words

  !> Mass of a link [kg]: `mass=` of its card, else that of material and section; 0 without either.
  pure function link_mass(model, link) result(mass)
    type(model_t), intent(in) :: model !! whose links have their materials and sections
    integer, intent(in) :: link        !! number in the model, from 1
    real(wp) :: mass

    associate (this => model%links(link))
      if (this%has_mass) then
        mass = this%mass
      else
        mass = link_line_density(model, link)*this%length
      end if
    end associate
  end function link_mass

  !> ρA of a link, whatever its `mass=`; 0 without material or section [kg/m].
  pure function link_line_density(model, link) result(line_density)
    type(model_t), intent(in) :: model !! whose links have their materials and sections
    integer, intent(in) :: link        !! number in the model, from 1
    real(wp) :: line_density

    line_density = 0.0_wp
    associate (this => model%links(link))
      if (this%material == 0 .or. this%section == 0) return
      line_density = model%materials(this%material)%density*model%sections(this%section)%area
    end associate
  end function link_line_density

end module models
