!> Values in the units of a deck, as messages and heads of tables have them.
module value_words
  use kinds, only: wp
  use text, only: to_string
  use units, only: coherent_unit, from_si, unit_system_t, unit_t
  implicit none (type, external)
  private

  public :: in_words

contains

  !> `12.5 mm`
  pure function in_words(value, dimension, system, digits) result(words)
    real(wp), intent(in) :: value             !! [SI]
    integer, intent(in) :: dimension(4)       !! one of the dimension_… constants
    type(unit_system_t), intent(in) :: system !! of the deck
    integer, intent(in) :: digits             !! at most
    character(len=:), allocatable :: words

    type(unit_t) :: measure

    measure = coherent_unit(system, dimension)
    words = to_string(from_si(value, measure), digits)//" "//measure%name
  end function in_words

end module value_words
