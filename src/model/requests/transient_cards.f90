!> `REPORT transient`: elastic motions in time.
module transient_cards
  use card_reader, only: has_key, has_value, read_choice, read_entry_count, read_entry_quantity, &
    read_quantity, require_positive, value_of
  use cards, only: card_t
  use diagnostics, only: add_error, diagnostics_t
  use errors, only: error_of_input, error_t, set_error
  use kinds, only: wp
  use numbers, only: read_integer
  use report_kinds, only: default_number, report_kind_t
  use text, only: to_string
  use tokens, only: token_t
  use units, only: dimension_angle, dimension_length, dimension_none, &
    dimension_velocity, unit_system_t
  use value_lists, only: find_items, read_entry_list, value_list_t
  implicit none (type, external)
  private

  public :: transient_card_t, read_transient

  !> What a motion in time is to be. Words have no line if the card does not give them.
  type :: transient_card_t
    real(wp) :: crank = 0.0_wp     !! first crank angle [deg]
    real(wp) :: turns = 0.0_wp     !! of the crank
    integer :: instants = 0        !! rows in the time of a turn at the speed
    logical :: steady = .false.    !! it starts from the steady state; else from rest
    integer :: mode = 0            !! of the perturbation; 0: none
    real(wp) :: amplitude = 0.0_wp !! of the perturbation [m]
    real(wp) :: velocity = 0.0_wp  !! of the perturbation [m/s]
    logical :: lacks_turns = .false. !! and no misspelt key may be these
    type(token_t) :: turns_word, crank_word, instants_word, start_word
  end type transient_card_t

  !> Rows beyond this are taken for a mistake, modes for more than are certified.
  integer, parameter :: most_rows = 100000, most_modes = 100

contains

  !> Reads the keys of `REPORT transient [turns=] [crank=] [start=rest|steady]
  !! [perturb=mode,amplitude,velocity] [instants=]`. Errors: unreadable values; turns or an
  !! amplitude that is not above 0; an unknown start; no whole mode from 1; too many rows.
  pure subroutine read_transient(card, kind, known_keys, system, diagnostics, transient)
    type(card_t), intent(in) :: card                  !! the REPORT card
    type(report_kind_t), intent(in) :: kind           !! with the defaults of its keys
    logical, intent(in) :: known_keys                 !! no key is unknown: a missing one is
                                                      !! not given
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(transient_card_t), intent(out) :: transient  !! as read

    type(value_list_t) :: angle
    integer :: choice, instants
    logical :: fine

    call read_entry_quantity(card, "turns", dimension_none, system, .false., diagnostics, &
      transient%turns, fine)
    transient%lacks_turns = known_keys .and. .not. has_key(card, "turns")
    transient%turns_word = value_of(card, "turns")
    transient%crank_word = value_of(card, "crank")
    transient%instants_word = value_of(card, "instants")
    transient%start_word = value_of(card, "start")
    if (fine) call require_positive(card, "turns", transient%turns, diagnostics)
    transient%crank = default_number(kind, "crank")
    call read_entry_list(card, "crank", dimension_angle, system, diagnostics, angle)
    if (size(angle%value) > 1) then
      call add_error(diagnostics, angle%words(2), &
        "a motion starts at one crank angle, not at several")
    else if (size(angle%value) == 1) then
      transient%crank = angle%value(1)
    end if
    transient%instants = nint(default_number(kind, "instants"))
    call read_entry_count(card, "instants", 1, diagnostics, instants, fine)
    if (fine) transient%instants = instants
    if (has_value(card, "turns") .and. transient%turns*transient%instants > most_rows) call &
      add_error(diagnostics, value_of(card, "turns"), "a motion of more than "// &
      to_string(most_rows)//" rows is asked for: "//to_string(transient%instants)//" in a "// &
      "turn; expected fewer 'turns=' or 'instants='")
    if (has_value(card, "start")) then
      call read_choice(transient%start_word, "rest steady", diagnostics, choice)
      transient%steady = choice == 2
    end if
    if (has_value(card, "perturb")) call read_perturbation(card, system, diagnostics, transient)
  end subroutine read_transient

  !> Reads `perturb=mode,amplitude` or `perturb=mode,amplitude,velocity`.
  pure subroutine read_perturbation(card, system, diagnostics, transient)
    type(card_t), intent(in) :: card
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(transient_card_t), intent(inout) :: transient

    type(token_t), allocatable :: words(:)
    type(error_t), allocatable :: error
    logical :: fine, moves

    call find_items(card, "perturb", diagnostics, words, fine)
    if (.not. fine) return
    if (size(words) < 2 .or. size(words) > 3) then
      call add_error(diagnostics, words(min(4, size(words))), "'perturb=' takes the number of "// &
        "a mode, a length, and perhaps a velocity: perturb=mode,amplitude,velocity")
      return
    end if
    call read_integer(words(1)%text, transient%mode, error)
    if (.not. allocated(error) .and. (transient%mode < 1 .or. transient%mode > most_modes)) then
      call set_error(error, error_of_input, "there is no mode "//words(1)%text//"; expected "// &
        "one from 1 to "//to_string(most_modes))
    end if
    if (allocated(error)) call add_error(diagnostics, words(1), error%text)
    call read_quantity(words(2), dimension_length, system, diagnostics, transient%amplitude, fine)
    if (size(words) == 3) call read_quantity(words(3), dimension_velocity, system, diagnostics, &
      transient%velocity, moves)
    if (.not. fine) return
    if (size(words) == 2 .and. transient%amplitude <= 0.0_wp) then
      call add_error(diagnostics, words(2), "an amplitude must be greater than 0, not "// &
        words(2)%text//", unless a velocity follows")
    else if (transient%amplitude < 0.0_wp) then
      call add_error(diagnostics, words(2), "an amplitude must not be less than 0, as "// &
        words(2)%text//" is; the velocity behind it may be")
    end if
  end subroutine read_perturbation

end module transient_cards
