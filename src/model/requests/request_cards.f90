!> TITLE, CRANK, SPEED and MODES cards, and cards that choose one of several words (INERTIA,
!! SOLVER).
module request_cards
  use card_reader, only: check_form, read_choice, read_entry_quantity, require_positive, value_of
  use card_table, only: card_kind_t, kind_of_card
  use cards, only: card_t
  use diagnostics, only: add_error, diagnostics_t
  use errors, only: error_of_input, error_t, set_error
  use kinds, only: wp
  use natures, only: is_angular, nature_t
  use numbers, only: read_integer
  use text, only: to_string
  use tokens, only: token_t
  use units, only: dimension_time, unit_system_t
  use value_lists, only: read_values, value_list_t
  implicit none (type, external)
  private

  public :: read_title, read_option, read_crank, read_speed, read_modes

contains

  !> Reads `TITLE text`. Errors: no blank between keyword and text.
  pure subroutine read_title(card, diagnostics, title)
    type(card_t), intent(in) :: card                      !! the TITLE card
    type(diagnostics_t), intent(inout) :: diagnostics     !! errors are added
    character(len=:), allocatable, intent(inout) :: title !! unchanged if the card has no text

    if (size(card%words) == 0) return
    title = card%words(1)%text
    if (card%words(1)%column == card%keyword%column + len("TITLE")) call add_error(diagnostics, &
      card%words(1), "a blank must stand between TITLE and its text")
  end subroutine read_title

  !> Reads a card of one word, such as `SOLVER dense`. Errors: words or keys that do not fit
  !! the card, an unknown word.
  pure subroutine read_option(card, diagnostics, option, word)
    type(card_t), intent(in) :: card                  !! INERTIA or SOLVER
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    integer, intent(inout) :: option                  !! number among the card's words in the table
                                                      !! of cards; unchanged after an error
    type(token_t), intent(inout), optional :: word    !! the word read; unchanged after an error

    type(card_kind_t) :: kind
    integer :: choice
    logical :: fine

    call check_form(card, diagnostics, fine)
    if (.not. fine) return
    kind = kind_of_card(card%keyword%text)
    call read_choice(card%words(1), trim(kind%choices), diagnostics, choice)
    if (choice == 0) return
    option = choice
    if (present(word)) word = card%words(1)
  end subroutine read_option

  !> Reads `CRANK` angles [deg], or lengths [m]: numbers and ranges `a to b step s`, with or
  !! without one unit at the end for all. Errors: words or keys that do not fit the card, unreadable
  !! values or ranges, a value given twice, to the last digit.
  pure subroutine read_crank(card, system, diagnostics, crank, nature)
    type(card_t), intent(in) :: card                  !! the CRANK card
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(value_list_t), intent(out) :: crank          !! angles [deg] or lengths [m]
    type(nature_t), intent(in) :: nature              !! of positions

    logical :: fine

    call check_form(card, diagnostics, fine)
    call read_values(card%words, nature%value, system, trim(merge("crank angle", "position   ", &
      is_angular(nature))), diagnostics, crank, to_all_digits=.true.)
  end subroutine read_crank

  !> Reads `SPEED` values [rad/s], listed like crank angles, and `alpha=` [rad/s²], and
  !! `ramp=` [s]; of a slider or a ram in m/s and m/s². Errors: as for CRANK, and an unreadable
  !! `alpha=` or `ramp=`; a ramp of no time.
  pure subroutine read_speed(card, system, diagnostics, speed, acceleration, ramp, ramp_word, &
    nature)
    type(card_t), intent(in) :: card                  !! the SPEED card
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(value_list_t), intent(out) :: speed          !! [rad/s] or [m/s]
    real(wp), intent(out) :: acceleration             !! [rad/s²] or [m/s²]
    real(wp), intent(inout) :: ramp                   !! time from rest to the speed [s]; unchanged
                                                      !! without the key
    type(token_t), intent(inout) :: ramp_word         !! its word in the deck; likewise
    type(nature_t), intent(in) :: nature              !! of positions

    real(wp) :: time
    logical :: fine

    call check_form(card, diagnostics, fine)
    call read_values(card%words, nature%rate, system, "speed", diagnostics, speed)
    call read_entry_quantity(card, "alpha", nature%acceleration, system, .false., diagnostics, &
      acceleration, fine)
    call read_entry_quantity(card, "ramp", dimension_time, system, .false., diagnostics, time, fine)
    if (.not. fine) return
    call require_positive(card, "ramp", time, diagnostics)
    ramp = max(time, 0.0_wp)
    ramp_word = value_of(card, "ramp")
  end subroutine read_speed

  !> Reads `MODES number`. Errors: words or keys that do not fit the card, a number that is not
  !! whole or is below 1.
  pure subroutine read_modes(card, diagnostics, modes, word)
    type(card_t), intent(in) :: card                  !! the MODES card
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    integer, intent(inout) :: modes                   !! number of modes; unchanged after an error
    type(token_t), intent(inout) :: word              !! its word in the deck; unchanged after an
                                                      !! error

    type(error_t), allocatable :: error
    logical :: fine
    integer :: number

    call check_form(card, diagnostics, fine)
    if (.not. fine) return
    call read_integer(card%words(1)%text, number, error)
    if (.not. allocated(error) .and. number < 1) call set_error(error, error_of_input, &
      "the number of modes must be at least 1, not "//to_string(number))
    if (allocated(error)) then
      call add_error(diagnostics, card%words(1), error%text)
    else
      modes = number
      word = card%words(1)
    end if
  end subroutine read_modes

end module request_cards
