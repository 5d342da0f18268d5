!> Reading and checking of one variant of a deck.
module variant_readings
  use available_memory, only: available_memory_t
  use cards, only: card_t
  use deck_checks, only: check_mechanics
  use diagnostics, only: diagnostic_t, diagnostics_t, errors_of, has_errors
  use errors, only: error_of_input, error_t, set_error
  use memory_needs, only: check_memory
  use model_reader, only: read_model
  use models, only: model_t
  use report_table, only: reports
  use variants, only: deck_cards_t, take_variant, variant_text, variant_values
  implicit none (type, external)
  private

  public :: read_variant, check_variant, refusal_of_variant

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

    call take_variant(deck_cards, number, cards)
    call read_model(cards, reports(), diagnostics, model)
    if (has_errors(diagnostics)) return
    model%variant = variant_text(deck_cards, number)
    model%varied = variant_values(deck_cards, number)
  end subroutine read_variant

  !> Whether memory suffices for a model, and then whether it makes sense mechanically.
  subroutine check_variant(model, threads, available, diagnostics)
    type(model_t), intent(in) :: model                !! as read
    integer, intent(in) :: threads                    !! that will compute it
    type(available_memory_t), intent(in) :: available !! when the deck was read
    type(diagnostics_t), intent(inout) :: diagnostics !! of the model; if it has errors, nothing
                                                      !! more is checked

    if (.not. has_errors(diagnostics)) call check_memory(model, threads, available, diagnostics)
    if (.not. has_errors(diagnostics)) call check_mechanics(model, diagnostics)
  end subroutine check_variant

  !> Why a variant was refused: the first of its errors in the order of the deck's lines.
  subroutine refusal_of_variant(deck_cards, number, threads, available, cards, error)
    type(deck_cards_t), intent(in) :: deck_cards         !! of all variants
    integer, intent(in) :: number                        !! of the variant, which was refused
    integer, intent(in) :: threads                       !! that compute the deck
    type(available_memory_t), intent(in) :: available    !! when the deck was read
    type(card_t), allocatable, intent(inout) :: cards(:) !! as for `read_variant`
    type(error_t), allocatable, intent(out) :: error     !! the reason, without a place

    type(diagnostics_t) :: mine
    type(model_t) :: model
    type(diagnostic_t), allocatable :: list(:)

    call read_variant(deck_cards, number, cards, mine, model)
    call check_variant(model, threads, available, mine)
    list = errors_of(mine)
    if (size(list) > 0) then
      call set_error(error, list(1)%kind, list(1)%message)
    else
      ! Another process may have found less memory than this one.
      call set_error(error, error_of_input, "it was refused when all variants were checked")
    end if
  end subroutine refusal_of_variant

end module variant_readings
