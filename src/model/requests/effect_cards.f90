!> EFFECTS card: what the frequencies depend on.
module effect_cards
  use card_reader, only: check_form, read_choice
  use card_table, only: card_kind_t, kind_of_card
  use cards, only: card_t
  use diagnostics, only: add_error, diagnostics_t
  use text, only: lower_case
  use tokens, only: token_t
  implicit none (type, external)
  private

  public :: effects_t, read_effects, effect_words, effects_static, effects_axial

  integer, parameter :: effects_static = 1, effects_axial = 2

  type :: effects_t
    integer :: loads = 0        !! effects_static or effects_axial; 0 if the card gives neither:
                                !! speeds and loads then decide
    logical :: rotary = .false. !! cross-sections have rotary inertia
    logical :: shear = .false.  !! shear: cross-sections turn relative to the slope
    type(token_t) :: shear_word !! without a line if the deck does not request shear
  end type effects_t

contains

  !> Reads `EFFECTS [static|axial] [rotary] [shear]`, in any order. Errors: words or keys that do
  !! not fit the card, a word given twice, both static and axial.
  pure subroutine read_effects(card, diagnostics, effects)
    type(card_t), intent(in) :: card                  !! the EFFECTS card
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(effects_t), intent(inout) :: effects         !! `loads` and `shear_word` keep their values
                                                      !! if the card does not give them

    logical :: fine
    type(card_kind_t) :: kind
    integer :: first(4), choice, other, i !! `first`: number of each word on the card, 0: absent

    call check_form(card, diagnostics, fine)
    kind = kind_of_card(card%keyword%text)
    first = 0
    do i = 1, min(size(card%words), size(first))
      call read_choice(card%words(i), trim(kind%choices), diagnostics, choice)
      if (choice == 0) cycle
      if (first(choice) > 0) then
        call add_error(diagnostics, card%words(i), "'"//lower_case(card%words(i)%text)// &
          "' is given twice", card%words(first(choice)), "first given here")
        cycle
      end if
      first(choice) = i
      if (choice <= effects_axial) then
        other = effects_static + effects_axial - choice
        if (first(other) > 0) then
          call add_error(diagnostics, card%words(i), &
            "frequencies are either static or axial, not both", card%words(first(other)), &
            "the other word is here")
        else
          effects%loads = choice
        end if
      end if
    end do
    effects%rotary = first(3) > 0
    effects%shear = first(4) > 0
    if (effects%shear) effects%shear_word = card%words(first(4))
  end subroutine read_effects

  !> The words of an EFFECTS card, separated by blanks.
  pure function effect_words(loads, rotary, shear) result(text)
    integer, intent(in) :: loads         !! effects_static or effects_axial
    logical, intent(in) :: rotary, shear !! whether the card has these words
    character(len=:), allocatable :: text

    text = trim(merge("axial ", "static", loads == effects_axial))
    if (rotary) text = text//" rotary"
    if (shear) text = text//" shear"
  end function effect_words

end module effect_cards
