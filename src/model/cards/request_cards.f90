!> CRANK, SPEED, REPORT and the choices: what is to be computed.
module request_cards
  use card_reader, only: check_form, entry_number, has_key, read_choice, read_entry_count, &
    read_entry_quantity, require_positive
  use cards, only: card_t
  use diagnostics, only: add_error, diagnostics_t
  use kinds, only: wp
  use text, only: joined, to_string, word_list
  use tokens, only: token_t
  use units, only: dimension_angle, dimension_angular_acceleration, dimension_rate, &
    dimension_time, unit_system_t
  use value_lists, only: empty_list, read_entry_list, read_values, value_list_t
  implicit none (type, external)
  private

  public :: report_t, read_crank, read_speed, read_report, report_kinds, report_kind_count
  public :: report_kinematics, report_inertia, report_mesh, report_frequencies, report_shapes, &
    report_branches
  public :: report_reactions, report_points, report_lagrange, report_linkage, report_balance, &
    report_motion

  !> One REPORT card.
  type :: report_t
    type(token_t) :: keyword
    integer :: kind = 0          !! one of the report_… numbers; 0: unknown
    type(value_list_t) :: crank  !! of `crank=` [deg]; empty: every position
    type(value_list_t) :: speed  !! of `speed=` [rad/s]; empty: every speed
    integer :: points = 21       !! of `points=`, along each link
    ! Of REPORT motion, each with its word; the words have no line if the deck does not say.
    real(wp) :: start_angle = 0.0_wp !! of the crank [deg]
    real(wp) :: start_speed = 0.0_wp !! of the crank [rad/s]
    real(wp) :: end_time = 0.0_wp    !! [s]
    real(wp) :: time_step = 0.0_wp   !! between rows [s]
    type(token_t) :: start_angle_word, start_speed_word, end_time_word, time_step_word
  end type report_t

  character(len=*), parameter :: report_kinds = &
    "kinematics inertia mesh frequencies shapes branches reactions points lagrange "// &
    "linkage balance motion"
  integer, parameter :: report_kinematics = 1, report_inertia = 2, report_mesh = 3, &
    report_frequencies = 4, report_shapes = 5, report_branches = 6, report_reactions = 7, &
    report_points = 8, report_lagrange = 9, report_linkage = 10, report_balance = 11, &
    report_motion = 12
  integer, parameter :: report_kind_count = 12

  !> More rows of a motion than this are a slip of the pen.
  integer, parameter :: most_rows = 1000000

contains

  !> Reads `CRANK` angles [deg]: numbers and ranges `a to b step s`, perhaps with one unit at the
  !! end for all of them.
  pure subroutine read_crank(card, system, diagnostics, crank)
    type(card_t), intent(in) :: card
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(value_list_t), intent(out) :: crank

    logical :: fine

    call check_form(card, 1, huge(1), "", "CRANK a to b step s, or a list of angles", diagnostics, &
      fine)
    call read_values(card%words, dimension_angle, system, "crank angle", diagnostics, crank)
  end subroutine read_crank

  !> Reads `SPEED` values [rad/s], listed like crank angles, and `alpha=` [rad/s²].
  pure subroutine read_speed(card, system, diagnostics, speed, acceleration)
    type(card_t), intent(in) :: card
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(value_list_t), intent(out) :: speed
    real(wp), intent(out) :: acceleration !! [rad/s²]

    logical :: fine

    call check_form(card, 1, huge(1), "alpha", &
      "SPEED a list or range of speeds [rad/s|rpm] [alpha=]", diagnostics, fine)
    call read_values(card%words, dimension_rate, system, "speed", diagnostics, speed)
    call read_entry_quantity(card, "alpha", dimension_angular_acceleration, system, .false., &
      diagnostics, acceleration, fine)
  end subroutine read_speed

  !> Reads `REPORT kind`, for shapes with `crank=`, `speed=` and `points=`, for a motion with its
  !! start and its times.
  pure subroutine read_report(card, system, diagnostics, report)
    type(card_t), intent(in) :: card
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(report_t), intent(out) :: report

    logical :: fine
    integer :: points

    report%keyword = card%keyword
    report%crank = empty_list()
    report%speed = empty_list()
    report%start_angle_word = token_t("", 0, 0)
    report%start_speed_word = token_t("", 0, 0)
    report%end_time_word = token_t("", 0, 0)
    report%time_step_word = token_t("", 0, 0)
    if (size(card%words) > 0) call read_choice(card%words(1), report_kinds, diagnostics, &
      report%kind)
    if (report%kind == report_shapes) then
      call check_form(card, 1, 1, "crank speed points", &
        "REPORT shapes [crank=a,b,...] [speed=...] [points=]", diagnostics, fine)
      call read_entry_list(card, "crank", dimension_angle, system, diagnostics, report%crank)
      call read_entry_list(card, "speed", dimension_rate, system, diagnostics, report%speed)
      call read_entry_count(card, "points", 2, diagnostics, points, fine)
      if (fine) then
        report%points = points
      end if
    else if (report%kind == report_motion) then
      call read_motion(card, system, diagnostics, report)
    else if (report%kind > 0 .or. size(card%words) == 0) then
      call check_form(card, 1, 1, "", "REPORT "//joined(word_list(report_kinds), "|"), &
        diagnostics, fine)
    end if
  end subroutine read_report

  !> Reads `REPORT motion crank= [speed=0] end= step=`.
  pure subroutine read_motion(card, system, diagnostics, report)
    type(card_t), intent(in) :: card
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(report_t), intent(inout) :: report

    type(value_list_t) :: angle
    logical :: fine, known_keys, ends, steps

    call check_form(card, 1, 1, "crank speed end step", &
      "REPORT motion crank= [speed=0] end= step=", diagnostics, fine, known_keys)
    if (known_keys .and. .not. has_key(card, "crank")) then
      call add_error(diagnostics, card%keyword, &
        "'crank=' is missing; expected the angle at which the motion starts")
    end if
    call read_entry_list(card, "crank", dimension_angle, system, diagnostics, angle)
    if (size(angle%value) > 1) then
      call add_error(diagnostics, angle%words(2), &
        "a motion starts at one crank angle, not at several")
    else if (size(angle%value) == 1) then
      report%start_angle = angle%value(1)
      report%start_angle_word = angle%words(1)
    end if
    call read_entry_quantity(card, "speed", dimension_rate, system, .false., diagnostics, &
      report%start_speed, fine)
    if (fine) report%start_speed_word = card%entries(entry_number(card, "speed"))%value
    call read_entry_quantity(card, "end", dimension_time, system, known_keys, diagnostics, &
      report%end_time, ends)
    if (ends) report%end_time_word = card%entries(entry_number(card, "end"))%value
    call read_entry_quantity(card, "step", dimension_time, system, known_keys, diagnostics, &
      report%time_step, steps)
    if (steps) report%time_step_word = card%entries(entry_number(card, "step"))%value
    if (ends) call require_positive(card, "end", report%end_time, diagnostics)
    if (steps) call require_positive(card, "step", report%time_step, diagnostics)
    if (report%end_time <= 0.0_wp .or. report%time_step <= 0.0_wp) return
    if (report%time_step > report%end_time) then
      call add_error(diagnostics, report%time_step_word, "'step=' must be at most 'end=', "// &
        report%end_time_word%text//", not "//report%time_step_word%text)
    else if (report%end_time > most_rows*report%time_step) then
      call add_error(diagnostics, report%time_step_word, "a motion of more than "// &
        to_string(most_rows)//" steps is asked for")
    end if
  end subroutine read_motion

end module request_cards
