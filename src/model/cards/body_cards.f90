!> MASS and POINT cards: masses and points fixed to links. Names are looked up later, by
!! `body_checks`.
module body_cards
  use card_reader, only: check_form, has_value, read_entry_quantity, read_part_name, &
    read_quantity, refuse_negative, value_of
  use cards, only: card_t
  use diagnostics, only: add_error, diagnostics_t
  use kinds, only: wp
  use tokens, only: token_t
  use units, only: dimension_inertia, dimension_length, dimension_mass, unit_system_t
  implicit none (type, external)
  private

  public :: mass_card_t, point_t, read_mass, read_point, read_place

  !> A mass fixed to a link.
  type :: mass_card_t
    type(token_t) :: link_name       !! without a line if the card lacks it
    integer :: link = 0              !! number in the model's list; 0: unknown
    real(wp) :: place(2) = 0.0_wp    !! from the first pin of the LINK card: along the link, and to
                                     !! the left of the direction to the second pin [m]
    type(token_t) :: place_word      !! value of `at=`, or the keyword without one
    real(wp) :: mass = 0.0_wp        !! [kg]
    real(wp) :: inertia = 0.0_wp     !! moment of inertia about its own mass centre [kg m²]
  end type mass_card_t

  !> A point fixed to a link, whose path is requested.
  type :: point_t
    type(token_t) :: name            !! without a line if the card lacks it
    type(token_t) :: link_name       !! the same
    integer :: link = 0              !! number in the model's list; 0: unknown
    real(wp) :: place(2) = 0.0_wp    !! as `place` of a mass [m]
  end type point_t

contains

  !> Reads `MASS link at= [offset= inertia=] value`. Errors: words or keys that do not fit the card,
  !! no `at=`, unreadable values, a mass of 0 or less, a negative moment of inertia.
  pure subroutine read_mass(card, system, diagnostics, mass)
    type(card_t), intent(in) :: card                  !! the MASS card
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(mass_card_t), intent(out) :: mass            !! as read; the link is not looked up

    logical :: fine, known_keys, has_inertia

    mass%link_name = token_t("", 0, 0)
    mass%place_word = card%keyword
    call check_form(card, diagnostics, fine, known_keys)
    if (size(card%words) > 0) mass%link_name = card%words(1)
    call read_place(card, "at", known_keys, system, diagnostics, mass%place, mass%place_word)
    call read_entry_quantity(card, "inertia", dimension_inertia, system, .false., diagnostics, &
      mass%inertia, has_inertia)
    if (has_inertia) call refuse_negative(value_of(card, "inertia"), &
      mass%inertia, "a moment of inertia", diagnostics)
    if (.not. fine) return
    call read_quantity(card%words(2), dimension_mass, system, diagnostics, mass%mass, fine)
    if (fine .and. mass%mass <= 0.0_wp) then
      call add_error(diagnostics, card%words(2), "a mass must be greater than 0, not "// &
        card%words(2)%text)
    end if
  end subroutine read_mass

  !> Reads `POINT name link along= [offset=]`. Errors: words or keys that do not fit the card, no
  !! `along=`, an invalid name, unreadable values.
  pure subroutine read_point(card, system, diagnostics, point)
    type(card_t), intent(in) :: card                  !! the POINT card
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(point_t), intent(out) :: point               !! as read; the link is not looked up

    type(token_t) :: place_word
    logical :: fine, known_keys

    point%name = token_t("", 0, 0)
    point%link_name = token_t("", 0, 0)
    call check_form(card, diagnostics, fine, known_keys)
    if (size(card%words) > 0) then
      point%name = card%words(1)
      call read_part_name(point%name, diagnostics)
    end if
    if (size(card%words) > 1) point%link_name = card%words(2)
    call read_place(card, "along", known_keys, system, diagnostics, point%place, place_word)
  end subroutine read_point

  !> Reads the two keys of a place on a link; `offset=` is optional. Errors: no coordinate along the
  !! link, unreadable values.
  pure subroutine read_place(card, key, known_keys, system, diagnostics, place, word)
    type(card_t), intent(in) :: card                  !! of any kind
    character(len=*), intent(in) :: key               !! coordinate along the link: `at` or `along`
    logical, intent(in) :: known_keys                 !! no key is unknown: a missing one is an
                                                      !! error
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    real(wp), intent(out) :: place(2)                 !! from the first pin of the LINK card: along
                                                      !! the link, and to its left [m]
    type(token_t), intent(out) :: word                !! value of `key`; the keyword without one

    logical :: fine

    word = card%keyword
    call read_entry_quantity(card, key, dimension_length, system, known_keys, diagnostics, &
      place(1), fine)
    call read_entry_quantity(card, "offset", dimension_length, system, .false., diagnostics, &
      place(2), fine)
    if (has_value(card, key)) word = value_of(card, key)
  end subroutine read_place

end module body_cards
