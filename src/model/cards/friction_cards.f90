!> FRICTION cards: what rubs at a pin, or a block along its guide. Names are looked up later, by
!! `friction_checks`.
module friction_cards
  use card_reader, only: check_form, has_key, key_of, read_entry_quantity, refuse_negative, &
    require_positive, value_of
  use card_table, only: pattern_of
  use cards, only: card_t
  use diagnostics, only: add_error, diagnostics_t
  use kinds, only: wp
  use process_cards, only: smooth_rate, smooth_velocity
  use tokens, only: token_t
  use units, only: dimension_damping, dimension_length, dimension_line_damping, dimension_none, &
    dimension_rate, dimension_velocity, unit_system_t
  implicit none (type, external)
  private

  public :: friction_card_t, read_friction

  !> Friction at a pin. Words without a line are not on the card.
  type :: friction_card_t
    type(token_t) :: keyword
    type(token_t) :: pin                !! without a line if the card lacks it
    type(token_t) :: names(2)           !! the link that rubs, or the guide of the block; the link
                                        !! that bears the pin
    integer :: slider = 0               !! whose block rubs on its line: number in the model's list;
                                        !! 0: the pin rubs
    integer, allocatable :: pairs(:, :) !! (2, pairs) links that rub at the pin: one that turns on
                                        !! it, and that which bears it; 0: the ground, or a block
                                        !! that does not turn
    real(wp) :: radius = 0.0_wp         !! of the bearing; 0: not given [m]
    real(wp) :: coefficient = 0.0_wp    !! of Coulomb friction [-]
    real(wp) :: viscous = 0.0_wp        !! [N m s/rad] or [N s/m]
    real(wp) :: smooth = smooth_rate    !! [rad/s] or [m/s]
    real(wp) :: length = 0.0_wp         !! of the block; 0: not given [m]
  end type friction_card_t

contains

  !> Reads `FRICTION pin [link [link]] radius= coefficient= [viscous=] [smooth=]` or `FRICTION pin
  !! guide coefficient= [viscous=] [smooth=] [length=]`. Errors: words or keys that do not fit the
  !! card, keys of the other form, unreadable or negative values, no friction at all, Coulomb
  !! friction of a pin without a radius.
  pure subroutine read_friction(card, slides, system, diagnostics, friction)
    type(card_t), intent(in) :: card                  !! the FRICTION card
    logical, intent(in) :: slides                     !! it is on a block: its second word is what
                                                      !! the pin slides along
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(friction_card_t), intent(out) :: friction    !! as read; names are not looked up

    logical :: fine, known_keys
    integer :: i

    friction%keyword = card%keyword
    friction%pin = token_t("", 0, 0)
    friction%names(1) = token_t("", 0, 0)
    friction%names(2) = token_t("", 0, 0)
    allocate (friction%pairs(2, 0))
    call check_form(card, diagnostics, fine, known_keys)
    if (.not. fine .or. .not. known_keys) return
    friction%pin = card%words(1)
    do i = 2, size(card%words)
      friction%names(i - 1) = card%words(i)
    end do
    if (slides .and. size(card%words) > 2) call add_error(diagnostics, card%words(3), &
      "a block rubs on what it slides along, and nothing follows; expected: "// &
      pattern_of("FRICTION"))
    if (slides) then
      call refuse_key(card, "radius", diagnostics, "of a bearing at a pin; this card is on a "// &
        "block along '"//card%words(2)%text//"'")
    else
      call refuse_key(card, "length", diagnostics, "of a block along its guide; this card is "// &
        "on the pin '"//card%words(1)%text//"'")
    end if
    call read_value(card, "coefficient", dimension_none, system, diagnostics, friction%coefficient)
    call read_value(card, "viscous", merge(dimension_line_damping, dimension_damping, slides), &
      system, diagnostics, friction%viscous)
    friction%smooth = merge(smooth_velocity, smooth_rate, slides)
    call read_positive(card, "smooth", merge(dimension_velocity, dimension_rate, slides), system, &
      diagnostics, friction%smooth)
    call read_positive(card, "radius", dimension_length, system, diagnostics, friction%radius)
    call read_positive(card, "length", dimension_length, system, diagnostics, friction%length)
    if (.not. has_key(card, "coefficient") .and. .not. has_key(card, "viscous")) then
      call add_error(diagnostics, card%keyword, "'coefficient=' or 'viscous=' is missing: "// &
        "nothing would rub")
    else if (.not. slides .and. friction%coefficient > 0.0_wp .and. .not. has_key(card, "radius")) &
      then
      call add_error(diagnostics, card%keyword, "'radius=' of the bearing is missing: the "// &
        "couple of Coulomb friction is coefficient * force * radius")
    end if
  end subroutine read_friction

  !> Reports a key of the other form.
  pure subroutine refuse_key(card, key, diagnostics, words)
    type(card_t), intent(in) :: card
    character(len=*), intent(in) :: key
    type(diagnostics_t), intent(inout) :: diagnostics
    character(len=*), intent(in) :: words !! of what it is

    if (has_key(card, key)) call add_error(diagnostics, key_of(card, key), &
      "'"//key//"=' is "//words)
  end subroutine refuse_key

  pure subroutine read_value(card, key, dimension, system, diagnostics, value)
    type(card_t), intent(in) :: card
    character(len=*), intent(in) :: key
    integer, intent(in) :: dimension(4)
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    real(wp), intent(out) :: value !! 0 if it is not given

    logical :: fine

    call read_entry_quantity(card, key, dimension, system, .false., diagnostics, value, fine)
    if (fine) call refuse_negative(value_of(card, key), value, key, diagnostics)
    if (.not. fine) value = 0.0_wp
  end subroutine read_value

  pure subroutine read_positive(card, key, dimension, system, diagnostics, value)
    type(card_t), intent(in) :: card
    character(len=*), intent(in) :: key
    integer, intent(in) :: dimension(4)
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    real(wp), intent(inout) :: value !! as it is if it is not given

    real(wp) :: given
    logical :: fine

    call read_entry_quantity(card, key, dimension, system, .false., diagnostics, given, fine)
    if (.not. fine) return
    call require_positive(card, key, given, diagnostics)
    if (given > 0.0_wp) value = given
  end subroutine read_positive

end module friction_cards
