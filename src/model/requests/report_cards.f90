! src/model/requests/ - what a deck asks for: reports, positions, speeds, units, effects, balance.
! In: cards, the kinds of reports. Out: a `report_t` for each REPORT card, other requests, messages
! on what is missing. Begin with `read_report` here, then `check_requests` in `request_checks.f90`,
! `check_report_needs` in `report_needs.f90`.
! Not here: tables (`src/reports`), requests in the terms of mechanics (`src/runs/studies`).

!> REPORT card: requests one or several tables.
module report_cards
  use card_reader, only: check_words, has_key, has_value, key_of, read_choice, &
    read_entry_accuracy, read_entry_count, read_entry_quantity, read_quantity, require_positive, &
    value_of
  use card_table, only: keys_in
  use cards, only: card_t
  use diagnostics, only: add_error, diagnostics_t
  use kinds, only: fineness, wp
  use natures, only: nature_t
  use report_kinds, only: any_linkage, default_number, format_words, kind_named, report_kind_t, &
    report_names
  use summary_cards, only: read_summary, summary_card_t
  use text, only: joined, lower_case, same_word, to_string, word_list
  use tokens, only: token_t
  use transient_cards, only: read_transient, transient_card_t
  use units, only: dimension_length, dimension_none, dimension_time, unit_system_t
  use value_lists, only: empty_list, find_items, list_steps, read_entry_list, read_entry_pair, &
    read_values, value_list_t
  implicit none (type, external)
  private

  public :: report_t, read_report

  !> `accuracy=` of reports on the elastic response, relative to the largest value of a quantity
  !! over the turn; on stability, of exponents; of intervals, relative to the speed.
  real(wp), parameter :: finest_response_accuracy = 1.0e-12_wp*fineness, &
    coarsest_response_accuracy = 1.0e-2_wp

  !> `accuracy=` of REPORT summary, where it is not written out: most quantities have none.
  real(wp), parameter :: usual_response_accuracy = 1.0e-6_wp

  !> `fluctuation=` of REPORT sizing.
  real(wp), parameter :: least_fluctuation = 1.0e-6_wp, most_fluctuation = 1.0_wp

  !> One REPORT card.
  type :: report_t
    type(token_t) :: keyword
    type(report_kind_t) :: kind  !! without a name if it is unknown
    integer :: format = any_linkage !! four_bars or other_linkages by `format=`; else as the deck is
    type(token_t) :: format_word !! the word of `format=`
    type(value_list_t) :: crank  !! `crank=` of shapes and geometry [deg], where a slider or a ram
                                 !! is driven [m]; empty: all positions
    type(value_list_t) :: speed  !! `speed=` of shapes [rad/s] or [m/s]; empty: all speeds. Of
                                 !! motion: its start speed, as a list of one, or none
    integer :: points = 0        !! `points=` of shapes, along each link
    real(wp) :: least_growth = 0.0_wp !! `growth=` of intervals [nepers a turn]
    real(wp) :: accuracy = 0.0_wp !! of reports on the elastic linkage in motion
    ! REPORT motion: each value with its word, which has no line if the card does not give it.
    real(wp) :: start_angle = 0.0_wp !! of the crank [deg]
    real(wp) :: start_speed = 0.0_wp !! of the crank [rad/s]
    real(wp) :: end_time = 0.0_wp    !! [s]
    real(wp) :: time_step = 0.0_wp   !! between rows [s]
    type(value_list_t) :: instants   !! of the rows [s]
    logical :: with_pins = .false.   !! with a table of the places of the pins
    logical :: with_coordinates = .false. !! with a table of springs, sliders and measures
    logical :: through = .false.     !! straight through change points
    logical :: with_accelerations = .false., with_forces = .false., with_power = .false., &
      with_motor = .false.           !! columns
    type(token_t) :: start_angle_word, start_speed_word, end_time_word, time_step_word, &
      through_word, forces_word
    type(transient_card_t) :: transient !! REPORT transient
    ! REPORT frame: about a place, about a pin, or without either about the point of reference.
    logical :: has_about = .false.   !! `about=x,y` is given
    real(wp) :: about(2) = 0.0_wp    !! in global axes [m]
    real(wp) :: fluctuation = 0.0_wp !! of REPORT sizing; 0: no flywheel is asked for [-]
    type(token_t) :: about_pin       !! value of `about=pin`; without a line if it is not given
    type(token_t) :: ratio_to        !! of coordinates and summary; likewise
    type(token_t) :: times_word      !! of geometry: `crank` has instants [s]; likewise
    integer :: reference = 0         !! number of that coordinate; 0: no ratios are asked for
    type(summary_card_t) :: summary  !! REPORT summary
    type(token_t), allocatable :: columns(:) !! `columns=` of all but motion: what its first table
                                     !! has; not allocated: all
  end type report_t

  !> A motion with more rows than this is taken for a mistake.
  integer, parameter :: most_rows = 1000000

contains

  !> Reads `REPORT kind`; shapes with `crank=`, `speed=` and `points=`, geometry with its crank
  !! angles, motion with start, end and step, frame with its point, summary with its quantities,
  !! several with `columns=`. Errors: an unknown kind, words or keys that do not fit it, a
  !! missing or unreadable value, fewer than two `points=`, an `accuracy=` out of range, a motion
  !! whose end or step is not above 0, whose step exceeds its end, or which has more than a
  !! million steps, an unknown quantity, a column named twice.
  pure subroutine read_report(card, reports, system, diagnostics, report, nature)
    type(card_t), intent(in) :: card                  !! the REPORT card
    type(report_kind_t), intent(in) :: reports(:)     !! (kinds) all that exist
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(report_t), intent(out) :: report             !! as read
    type(nature_t), intent(in) :: nature              !! of positions

    character(len=:), allocatable :: pattern
    integer :: number
    logical :: fine, known_keys

    report%keyword = card%keyword
    report%crank = empty_list()
    report%speed = empty_list()
    report%instants = empty_list()
    report%start_angle_word = token_t("", 0, 0)
    report%start_speed_word = token_t("", 0, 0)
    report%end_time_word = token_t("", 0, 0)
    report%time_step_word = token_t("", 0, 0)
    report%about_pin = token_t("", 0, 0)
    report%ratio_to = token_t("", 0, 0)
    report%times_word = token_t("", 0, 0)
    report%format_word = token_t("", 0, 0)
    report%through_word = token_t("", 0, 0)
    report%forces_word = token_t("", 0, 0)
    pattern = "REPORT "//joined(word_list(report_names(reports)), "|")
    number = 0
    if (size(card%words) > 0) then
      number = kind_named(reports, lower_case(card%words(1)%text))
      if (number == 0) then
        call read_choice(card%words(1), report_names(reports), diagnostics, number)
        return
      end if
      report%kind = reports(number)
      if (len_trim(report%kind%pattern) > 0) pattern = trim(report%kind%pattern)
    end if
    if (size(card%words) > 1) then
      if (kind_named(reports, lower_case(card%words(2)%text)) > 0) pattern = "REPORT "// &
        trim(report%kind%name)//", and a REPORT card of its own for "//card%words(2)%text
    end if
    call check_words(card, 1, 1, keys_in(pattern), pattern, diagnostics, fine, known_keys)
    if (has_value(card, "format")) then
      report%format_word = value_of(card, "format")
      call read_choice(report%format_word, format_words, diagnostics, report%format)
    end if
    if (report%kind%response) call read_response(card, system, diagnostics, report)
    if (has_value(card, "ratio_to")) report%ratio_to = value_of(card, "ratio_to")
    select case (report%kind%name)
    case ("shapes")
      call read_shapes(card, nature, system, diagnostics, report)
    case ("geometry")
      call read_geometry(card, known_keys, nature, system, diagnostics, report)
    case ("motion")
      call read_motion(card, known_keys, nature, system, diagnostics, report)
    case ("intervals")
      call read_intervals(card, system, diagnostics, report)
    case ("transient")
      call read_transient(card, report%kind, known_keys, system, diagnostics, report%transient)
    case ("sizing")
      call read_sizing(card, system, diagnostics, report)
    case ("frame")
      call read_frame(card, system, diagnostics, report)
    case ("summary")
      call read_summary(card, known_keys, diagnostics, report%summary)
      call read_response(card, system, diagnostics, report)
    end select
    if (report%kind%name /= "motion" .and. has_value(card, "columns")) &
      call read_chosen_columns(card, diagnostics, report)
  end subroutine read_report

  !> Reads `REPORT response [accuracy=]`, and the other reports on the elastic linkage in motion.
  pure subroutine read_response(card, system, diagnostics, report)
    type(card_t), intent(in) :: card
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(report_t), intent(inout) :: report

    real(wp) :: accuracy
    logical :: fine

    call read_entry_accuracy(card, finest_response_accuracy, coarsest_response_accuracy, system, &
      diagnostics, accuracy, fine)
    report%accuracy = default_number(report%kind, "accuracy")
    if (report%accuracy <= 0.0_wp) report%accuracy = usual_response_accuracy
    if (fine) report%accuracy = accuracy
  end subroutine read_response

  !> Reads `growth=` of `REPORT intervals`.
  pure subroutine read_intervals(card, system, diagnostics, report)
    type(card_t), intent(in) :: card
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(report_t), intent(inout) :: report

    real(wp), parameter :: least = 1.0e-6_wp, most = 1.0_wp
    type(token_t) :: word
    real(wp) :: growth
    logical :: fine

    report%least_growth = default_number(report%kind, "growth")
    call read_entry_quantity(card, "growth", dimension_none, system, .false., diagnostics, growth, &
      fine)
    if (.not. fine) return
    if (growth < least .or. growth > most) then
      word = value_of(card, "growth")
      call add_error(diagnostics, word, "the growth in a turn from which intervals count is "// &
        "from 1e-6 to 1, not "//word%text)
    else
      report%least_growth = growth
    end if
  end subroutine read_intervals

  !> Reads `REPORT sizing [fluctuation=]`: a share, or a percentage with its sign.
  pure subroutine read_sizing(card, system, diagnostics, report)
    type(card_t), intent(in) :: card
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(report_t), intent(inout) :: report

    type(token_t) :: word
    real(wp) :: fluctuation, factor
    logical :: fine
    integer :: last

    if (.not. has_value(card, "fluctuation")) return
    word = value_of(card, "fluctuation")
    last = len(word%text)
    factor = 1.0_wp
    if (last > 1) then
      if (word%text(last:) == "%") then
        word%text = word%text(:last - 1)
        factor = 100.0_wp
      end if
    end if
    call read_quantity(word, dimension_none, system, diagnostics, fluctuation, fine)
    if (.not. fine) return
    fluctuation = fluctuation/factor
    if (fluctuation < least_fluctuation .or. fluctuation > most_fluctuation) then
      word = value_of(card, "fluctuation")
      call add_error(diagnostics, word, "the fluctuation of the speed, (greatest - least)/mean,"// &
        " is from 1e-6 to 1, or in %, not "//word%text)
    else
      report%fluctuation = fluctuation
    end if
  end subroutine read_sizing

  !> Reads `REPORT frame [about=x,y|pin]`: a name, or the coordinates of a place.
  pure subroutine read_frame(card, system, diagnostics, report)
    type(card_t), intent(in) :: card
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(report_t), intent(inout) :: report

    type(token_t) :: word

    word = value_of(card, "about")
    if (word%line == 0) return
    if (index(word%text, ",") == 0) then
      report%about_pin = word
    else
      call read_entry_pair(card, "about", "x,y", dimension_length, system, diagnostics, &
        report%about, report%has_about)
    end if
  end subroutine read_frame

  !> Reads `REPORT shapes [crank=a,b,...] [speed=...] [points=]`.
  pure subroutine read_shapes(card, nature, system, diagnostics, report)
    type(card_t), intent(in) :: card
    type(nature_t), intent(in) :: nature !! of positions
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(report_t), intent(inout) :: report

    integer :: points
    logical :: fine

    call read_entry_list(card, "crank", nature%value, system, diagnostics, report%crank)
    call read_entry_list(card, "speed", nature%rate, system, diagnostics, report%speed)
    call read_entry_count(card, "points", 2, diagnostics, points, fine)
    report%points = nint(default_number(report%kind, "points"))
    if (fine) report%points = points
  end subroutine read_shapes

  !> Reads `REPORT geometry crank=a,b,...` or `time=a,b,...`.
  pure subroutine read_geometry(card, known_keys, nature, system, diagnostics, report)
    type(card_t), intent(in) :: card
    logical, intent(in) :: known_keys !! no key is unknown: a missing one is an error
    type(nature_t), intent(in) :: nature !! of positions
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(report_t), intent(inout) :: report

    if (has_key(card, "time")) then
      if (has_key(card, "crank")) call add_error(diagnostics, key_of(card, "crank"), &
        "'crank=' has no meaning beside 'time='")
      if (has_value(card, "time")) report%times_word = value_of(card, "time")
      call read_entry_list(card, "time", dimension_time, system, diagnostics, report%crank)
      return
    end if
    if (known_keys .and. .not. has_key(card, "crank")) then
      call add_error(diagnostics, card%keyword, &
        "'crank=' is missing; expected the angles at which the linkage is to be drawn")
    end if
    call read_entry_list(card, "crank", nature%value, system, diagnostics, report%crank)
  end subroutine read_geometry

  !> Reads `REPORT motion crank= [speed=0] end= step= [columns=] [pins=no|yes]
  !! [coordinates=no|yes] [change_points=stop|through]`.
  pure subroutine read_motion(card, known_keys, nature, system, diagnostics, report)
    type(card_t), intent(in) :: card
    logical, intent(in) :: known_keys !! no key is unknown: missing ones are an error
    type(nature_t), intent(in) :: nature !! of positions
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(report_t), intent(inout) :: report

    type(value_list_t) :: angle
    logical :: fine, ends, steps
    integer :: choice

    if (known_keys .and. .not. has_key(card, "crank")) then
      call add_error(diagnostics, card%keyword, &
        "'crank=' is missing; expected the angle at which the motion starts")
    end if
    call read_entry_list(card, "crank", nature%value, system, diagnostics, angle)
    if (size(angle%value) > 1) then
      call add_error(diagnostics, angle%words(2), &
        "a motion starts at one crank angle, not at several")
    else if (size(angle%value) == 1) then
      report%start_angle = angle%value(1)
      report%start_angle_word = angle%words(1)
    end if
    call read_entry_quantity(card, "speed", nature%rate, system, .false., diagnostics, &
      report%start_speed, fine)
    if (fine) then
      report%start_speed_word = value_of(card, "speed")
      call read_values([report%start_speed_word], nature%rate, system, "speed", &
        diagnostics, report%speed)
    end if
    if (has_value(card, "pins")) then
      call read_choice(value_of(card, "pins"), "no yes", diagnostics, choice)
      report%with_pins = choice == 2
    end if
    if (has_value(card, "coordinates")) then
      call read_choice(value_of(card, "coordinates"), "no yes", diagnostics, choice)
      report%with_coordinates = choice == 2
    end if
    call read_columns(card, diagnostics, report)
    if (has_value(card, "change_points")) then
      report%through_word = value_of(card, "change_points")
      call read_choice(report%through_word, "stop through", diagnostics, choice)
      report%through = choice == 2
    end if
    call read_entry_quantity(card, "end", dimension_time, system, known_keys, diagnostics, &
      report%end_time, ends)
    if (ends) report%end_time_word = value_of(card, "end")
    call read_entry_quantity(card, "step", dimension_time, system, known_keys, diagnostics, &
      report%time_step, steps)
    if (steps) report%time_step_word = value_of(card, "step")
    if (ends) call require_positive(card, "end", report%end_time, diagnostics)
    if (steps) call require_positive(card, "step", report%time_step, diagnostics)
    if (report%end_time <= 0.0_wp .or. report%time_step <= 0.0_wp) return
    if (report%time_step > report%end_time) then
      call add_error(diagnostics, report%time_step_word, "'step=' must be at most 'end=', "// &
        report%end_time_word%text//", not "//report%time_step_word%text)
    else if (report%end_time > most_rows*report%time_step) then
      call add_error(diagnostics, report%time_step_word, "a motion of more than "// &
        to_string(most_rows)//" steps is asked for")
    else
      call list_steps(report%end_time_word, report%time_step_word, dimension_time, system, &
        report%instants)
    end if
  end subroutine read_motion

  !> Reads `columns=` of other reports. What columns there are depends on the linkage. Errors: a
  !! column named twice.
  pure subroutine read_chosen_columns(card, diagnostics, report)
    type(card_t), intent(in) :: card
    type(diagnostics_t), intent(inout) :: diagnostics
    type(report_t), intent(inout) :: report

    type(token_t), allocatable :: words(:)
    logical :: fine
    integer :: i, k

    call find_items(card, "columns", diagnostics, words, fine)
    if (.not. fine) return
    do i = 2, size(words)
      do k = 1, i - 1
        if (.not. same_word(words(i)%text, words(k)%text)) cycle
        call add_error(diagnostics, words(i), "'"//words(i)%text//"' is given twice", words(k), &
          "first given here")
        exit
      end do
    end do
    call move_alloc(words, report%columns)
  end subroutine read_chosen_columns

  !> Reads `columns=` of REPORT motion: what stands in its tables beside what always does.
  pure subroutine read_columns(card, diagnostics, report)
    type(card_t), intent(in) :: card
    type(diagnostics_t), intent(inout) :: diagnostics
    type(report_t), intent(inout) :: report

    type(token_t), allocatable :: words(:)
    integer :: first(4), choice, i !! `first`: number of each word in the list, 0: absent
    logical :: fine

    if (.not. has_value(card, "columns")) return
    call find_items(card, "columns", diagnostics, words, fine)
    if (.not. fine) return
    first = 0
    do i = 1, size(words)
      call read_choice(words(i), "accelerations forces power motor", diagnostics, choice)
      if (choice == 0) cycle
      if (first(choice) > 0) then
        call add_error(diagnostics, words(i), "'"//lower_case(words(i)%text)// &
          "' is given twice", words(first(choice)), "first given here")
        cycle
      end if
      first(choice) = i
      if (choice == 2) report%forces_word = words(i)
    end do
    report%with_accelerations = first(1) > 0
    report%with_forces = first(2) > 0
    report%with_power = first(3) > 0
    report%with_motor = first(4) > 0
  end subroutine read_columns

end module report_cards
