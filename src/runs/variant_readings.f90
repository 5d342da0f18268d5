!> Reading and checking of a deck with one set of values.
module variant_readings
  use available_memory, only: available_memory_t
  use cards, only: card_t
  use deck_checks, only: check_mechanics
  use diagnostics, only: diagnostics_t, has_errors
  use kinds, only: wp
  use memory_needs, only: check_memory
  use model_reader, only: read_model
  use models, only: model_t
  use variants, only: deck_cards_t, take_values, take_variant, text_of_values, variant_values
  implicit none (type, external)
  private

  public :: run_limits_t, read_variant, read_values, check_variant

  !> What the computation of a deck may use, as far as checks depend on it.
  type :: run_limits_t
    integer :: threads = 1             !! on which it is computed
    type(available_memory_t) :: memory !! when the deck was read
  end type run_limits_t

contains

  !> Turns the cards of one variant into a model; files are not read again. A deck without VARY has
  !! one variant. Errors: a card of the variant is wrong.
  subroutine read_variant(deck_cards, number, cards, diagnostics, model)
    type(deck_cards_t), intent(in) :: deck_cards         !! of all variants
    integer, intent(in) :: number                        !! of the variant, from 1
    type(card_t), allocatable, intent(inout) :: cards(:) !! of another variant, or not allocated; on
                                                         !! return, of this one
    type(diagnostics_t), intent(inout) :: diagnostics    !! of the cards, with new ones appended
    type(model_t), intent(out) :: model                  !! complete only if there are no errors on
                                                         !! return

    call take_variant(deck_cards, number, cards, diagnostics)
    call finish_model(deck_cards, variant_values(deck_cards, number), cards, diagnostics, model)
  end subroutine read_variant

  !> The same of any values of the VARY cards.
  subroutine read_values(deck_cards, values, cards, diagnostics, model)
    type(deck_cards_t), intent(in) :: deck_cards         !! of all variants, without errors
    real(wp), intent(in) :: values(:)                    !! (parameters) in the units of their cards
    type(card_t), allocatable, intent(inout) :: cards(:) !! as for `read_variant`
    type(diagnostics_t), intent(inout) :: diagnostics    !! likewise
    type(model_t), intent(out) :: model                  !! likewise

    call take_values(deck_cards, values, cards, diagnostics)
    call finish_model(deck_cards, values, cards, diagnostics, model)
  end subroutine read_values

  !> Makes a model of cards with values in place.
  subroutine finish_model(deck_cards, values, cards, diagnostics, model)
    type(deck_cards_t), intent(in) :: deck_cards
    real(wp), intent(in) :: values(:)
    type(card_t), intent(in) :: cards(:)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(out) :: model

    call read_model(cards, deck_cards%reports, diagnostics, model)
    if (has_errors(diagnostics)) return
    model%variant = text_of_values(deck_cards, values)
    model%varied = values
  end subroutine finish_model

  !> Whether memory suffices for a model, and then whether it makes sense mechanically.
  subroutine check_variant(model, limits, diagnostics)
    type(model_t), intent(in) :: model                !! as read
    type(run_limits_t), intent(in) :: limits
    type(diagnostics_t), intent(inout) :: diagnostics !! of the model; if it has errors, nothing
                                                      !! more is checked

    if (.not. has_errors(diagnostics)) call check_memory(model, limits%threads, &
      limits%memory, diagnostics)
    if (.not. has_errors(diagnostics)) call check_mechanics(model, diagnostics)
  end subroutine check_variant

end module variant_readings
