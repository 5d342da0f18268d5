!> UNITS card: the units of bare numbers.
module unit_cards
  use card_reader, only: check_form
  use cards, only: card_t
  use diagnostics, only: add_error, diagnostics_t
  use errors, only: error_t
  use tokens, only: token_t
  use units, only: dimension_length, dimension_mass, dimension_time, read_unit, unit_system_t, &
    unit_t, wrong_unit
  implicit none (type, external)
  private

  public :: read_units

contains

  !> Reads `UNITS length mass time`. Errors: words or keys that do not fit the card, an unknown unit
  !! or one of another dimension; that unit then keeps its value.
  subroutine read_units(card, diagnostics, system)
    type(card_t), intent(in) :: card                  !! the UNITS card
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(unit_system_t), intent(inout) :: system      !! has default units before

    logical :: fine

    call check_form(card, diagnostics, fine)
    if (.not. fine) return
    call read_word(card%words(1), dimension_length, diagnostics, system%length)
    call read_word(card%words(2), dimension_mass, diagnostics, system%mass)
    call read_word(card%words(3), dimension_time, diagnostics, system%time)
  end subroutine read_units

  subroutine read_word(word, dimension, diagnostics, measure)
    type(token_t), intent(in) :: word
    integer, intent(in) :: dimension(4)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(unit_t), intent(inout) :: measure

    type(unit_t) :: candidate
    type(error_t), allocatable :: error

    call read_unit(word%text, dimension, candidate, error)
    if (allocated(error)) then
      call add_error(diagnostics, word, error%text)
    else if (any(candidate%dimension /= dimension)) then
      call add_error(diagnostics, word, wrong_unit(candidate, dimension))
    else
      measure = candidate
    end if
  end subroutine read_word

end module unit_cards
