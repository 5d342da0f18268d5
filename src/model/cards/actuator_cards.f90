!> ACTUATE cards: coordinates along which efforts act in place of those of the drives. Names are
!! looked up later, by `actuator_checks`.
module actuator_cards
  use card_reader, only: check_form
  use cards, only: card_t
  use diagnostics, only: diagnostics_t
  use tokens, only: token_t
  implicit none (type, external)
  private

  public :: actuator_card_t, read_actuators

  !> A name on an ACTUATE card.
  type :: actuator_card_t
    type(token_t) :: name     !! of the coordinate
    integer :: coordinate = 0 !! number among those with names; 0: unknown
  end type actuator_card_t

contains

  !> Reads `ACTUATE name [name …]`. Errors: no name, keys.
  pure subroutine read_actuators(card, diagnostics, actuators)
    type(card_t), intent(in) :: card                  !! an ACTUATE card
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(actuator_card_t), allocatable, intent(inout) :: actuators(:) !! of the deck so far

    type(actuator_card_t), allocatable :: longer(:)
    logical :: fine
    integer :: n

    call check_form(card, diagnostics, fine)
    n = size(actuators)
    allocate (longer(n + size(card%words)))
    longer(:n) = actuators
    longer(n + 1:)%name = card%words
    call move_alloc(longer, actuators)
  end subroutine read_actuators

end module actuator_cards
