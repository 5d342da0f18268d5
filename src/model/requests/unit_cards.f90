!> UNITS card: the units of bare numbers, and units and digits of results.
module unit_cards
  use card_reader, only: check_form, has_key, has_value, read_entry_count, value_of
  use cards, only: card_t
  use diagnostics, only: add_error, diagnostics_t
  use errors, only: error_of_input, error_t, set_error
  use number_text, only: most_digits
  use output_units, only: new_output_units, output_units_t, table_name
  use tokens, only: token_t
  use units, only: dimension_force, dimension_length, dimension_mass, dimension_moment, &
    dimension_rate, dimension_time, read_unit, unit_system_t, unit_t, wrong_unit
  implicit none (type, external)
  private

  public :: read_units

contains

  !> Reads `UNITS length mass time [force=] [torque=] [energy=] [speed=] [digits=]`. Errors: words
  !! or keys that do not fit the card, an unknown unit or one of another dimension, which then keeps
  !! its value; no number of digits.
  subroutine read_units(card, diagnostics, system, outputs, chooses_rate)
    type(card_t), intent(in) :: card                  !! the UNITS card
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(unit_system_t), intent(inout) :: system      !! has default units before
    type(output_units_t), intent(out) :: outputs      !! units and digits of results
    logical, intent(out) :: chooses_rate              !! whether it has `speed=`

    integer :: digits
    logical :: fine

    call check_form(card, diagnostics, fine)
    if (fine) then
      call read_word(card%words(1), dimension_length, diagnostics, system%length)
      call read_word(card%words(2), dimension_mass, diagnostics, system%mass)
      call read_word(card%words(3), dimension_time, diagnostics, system%time)
    end if
    outputs = new_output_units(system)
    call read_entry(card, "force", dimension_force, diagnostics, outputs%force)
    call read_entry(card, "torque", dimension_moment, diagnostics, outputs%moment)
    call read_entry(card, "energy", dimension_moment, diagnostics, outputs%energy)
    call read_entry(card, "speed", dimension_rate, diagnostics, outputs%rate)
    chooses_rate = has_key(card, "speed")
    call read_entry_count(card, "digits", 1, diagnostics, digits, fine, most_digits)
    if (fine) outputs%digits = digits
  end subroutine read_units

  !> The unit of a key; without the key it keeps its value.
  subroutine read_entry(card, key, dimension, diagnostics, measure)
    type(card_t), intent(in) :: card
    character(len=*), intent(in) :: key
    integer, intent(in) :: dimension(4)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(unit_t), intent(inout) :: measure

    if (.not. has_value(card, key)) return
    call read_word(value_of(card, key), dimension, diagnostics, measure, key == "energy")
    measure%name = table_name(measure)
  end subroutine read_entry

  subroutine read_word(word, dimension, diagnostics, measure, is_energy)
    type(token_t), intent(in) :: word
    integer, intent(in) :: dimension(4)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(unit_t), intent(inout) :: measure
    logical, intent(in), optional :: is_energy !! which has the dimension of a moment

    character(len=*), parameter :: moment = "moment"
    type(unit_t) :: candidate
    type(error_t), allocatable :: error

    call read_unit(word%text, dimension, candidate, error)
    if (.not. allocated(error)) then
      if (any(candidate%dimension /= dimension)) call set_error(error, error_of_input, &
        wrong_unit(candidate, dimension))
    end if
    if (.not. allocated(error)) then
      measure = candidate
      return
    end if
    if (present(is_energy)) then
      ! Both messages end with the quantity that is expected.
      if (is_energy) error%text = error%text(:len(error%text) - len(moment))//"energy"
    end if
    call add_error(diagnostics, word, error%text)
  end subroutine read_word

end module unit_cards
