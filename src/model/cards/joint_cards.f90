!> PIN, WELD, GUIDE and SLIDER cards: the drawing of a linkage, links that turn together, what pins
!! slide along. Names are looked up later, by `joint_checks`.
module joint_cards
  use card_reader, only: check_form, has_key, has_value, read_entry_quantity, read_measure, &
    read_part_name, read_quantity, refuse_negative, value_of
  use cards, only: card_t
  use constants, only: pi
  use diagnostics, only: add_error, diagnostics_t
  use kinds, only: wp
  use tokens, only: token_t
  use units, only: coherent_unit, dimension_angle, dimension_inertia, dimension_length, &
    dimension_mass, dimension_name, to_si, unit_system_t, unit_t
  implicit none (type, external)
  private

  public :: drawn_pin_t, weld_t, guide_t, slider_card_t
  public :: read_pin, read_weld, read_guide, read_slider

  !> Where a moving pin is in the drawing.
  type :: drawn_pin_t
    type(token_t) :: pin             !! without a line if the card lacks it
    real(wp) :: position(2) = 0.0_wp !! in global axes [m]
  end type drawn_pin_t

  !> Links that turn together at a pin, at the angle of the drawing.
  type :: weld_t
    type(token_t) :: pin                  !! without a line if the card lacks it
    type(token_t), allocatable :: links(:) !! two or more; none if the card cannot be read
    integer, allocatable :: link(:)       !! (links) numbers in the model's list; 0: unknown
  end type weld_t

  !> A fixed straight line that pins slide along.
  type :: guide_t
    type(token_t) :: name            !! without a line if the card lacks it
    real(wp) :: point(2) = 0.0_wp    !! on it, from which places are measured, in global axes [m]
    real(wp) :: angle = 0.0_wp       !! of its direction, in global axes [rad]
    real(wp) :: degrees = 0.0_wp     !! the same, as written if it is written in degrees [deg]
  end type guide_t

  !> A block at a pin that slides along a guide or a link.
  type :: slider_card_t
    type(token_t) :: pin             !! without a line if the card lacks it
    type(token_t) :: on              !! guide or link that it slides along; likewise
    type(token_t) :: turned          !! link that cannot turn on the block; without a line if all
                                     !! turn on it
    real(wp) :: mass = 0.0_wp        !! moves with the pin [kg]
    real(wp) :: inertia = 0.0_wp     !! turns with the block [kg m²]
    type(token_t) :: inertia_word    !! value of `inertia=`; without a line if there is none
    integer :: guide = 0             !! number of `on` in the model's list; 0: it is a link
    integer :: link = 0              !! the same; 0: it is a guide
    integer :: turned_link = 0       !! number of `turned` in the model's list; 0: none
  end type slider_card_t

contains

  !> Reads `PIN name x y`. Errors: words or keys that do not fit the card, an invalid name,
  !! unreadable coordinates.
  pure subroutine read_pin(card, system, diagnostics, pin)
    type(card_t), intent(in) :: card                  !! the PIN card
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(drawn_pin_t), intent(out) :: pin             !! as read; the pin is not looked up

    logical :: fine

    pin%pin = token_t("", 0, 0)
    call check_form(card, diagnostics, fine)
    if (size(card%words) > 0) then
      pin%pin = card%words(1)
      call read_part_name(pin%pin, diagnostics)
    end if
    if (.not. fine) return
    call read_quantity(card%words(2), dimension_length, system, diagnostics, pin%position(1), fine)
    call read_quantity(card%words(3), dimension_length, system, diagnostics, pin%position(2), fine)
  end subroutine read_pin

  !> Reads `WELD pin link link …`. Errors: words or keys that do not fit the card.
  pure subroutine read_weld(card, diagnostics, weld)
    type(card_t), intent(in) :: card                  !! the WELD card
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(weld_t), intent(out) :: weld                 !! as read; the names are not looked up

    logical :: fine

    weld%pin = token_t("", 0, 0)
    allocate (weld%links(0))
    call check_form(card, diagnostics, fine)
    if (size(card%words) > 0) weld%pin = card%words(1)
    if (fine) weld%links = card%words(2:)
    allocate (weld%link(size(weld%links)))
    weld%link = 0
  end subroutine read_weld

  !> Reads `GUIDE name x y angle=`. Errors: words or keys that do not fit the card, an invalid name,
  !! unreadable values, no angle.
  pure subroutine read_guide(card, system, diagnostics, guide)
    type(card_t), intent(in) :: card                  !! the GUIDE card
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(guide_t), intent(out) :: guide               !! as read

    type(unit_t) :: measure
    real(wp) :: value
    logical :: fine, known_keys, read

    guide%name = token_t("", 0, 0)
    call check_form(card, diagnostics, fine, known_keys)
    if (size(card%words) > 0) then
      guide%name = card%words(1)
      call read_part_name(guide%name, diagnostics)
    end if
    if (has_value(card, "angle")) then
      call read_measure(value_of(card, "angle"), dimension_angle, coherent_unit(system, &
        dimension_angle), diagnostics, value, measure, read)
      if (read) then
        guide%angle = to_si(value, measure)
        guide%degrees = guide%angle*180.0_wp/pi
        if (measure%name == "deg") guide%degrees = value
      end if
    else if (known_keys .and. .not. has_key(card, "angle")) then
      call add_error(diagnostics, card%keyword, "'angle=' is missing; expected "// &
        dimension_name(dimension_angle)//", that of the direction of the guide")
    end if
    if (.not. fine) return
    call read_quantity(card%words(2), dimension_length, system, diagnostics, guide%point(1), fine)
    call read_quantity(card%words(3), dimension_length, system, diagnostics, guide%point(2), fine)
  end subroutine read_guide

  !> Reads `SLIDER pin guide [link] [mass= inertia=]`. Errors: words or keys that do not fit the
  !! card, unreadable or negative values.
  pure subroutine read_slider(card, system, diagnostics, slider)
    type(card_t), intent(in) :: card                  !! the SLIDER card
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(slider_card_t), intent(out) :: slider             !! as read; the names are not looked up

    type(token_t) :: nowhere
    logical :: fine

    nowhere = token_t("", 0, 0)
    slider%pin = nowhere
    slider%on = nowhere
    slider%turned = nowhere
    slider%inertia_word = nowhere
    call check_form(card, diagnostics, fine)
    if (size(card%words) > 0) slider%pin = card%words(1)
    if (size(card%words) > 1) slider%on = card%words(2)
    if (size(card%words) > 2) slider%turned = card%words(3)
    call read_entry_quantity(card, "mass", dimension_mass, system, .false., diagnostics, &
      slider%mass, fine)
    if (fine) call refuse_negative(value_of(card, "mass"), slider%mass, "a mass", diagnostics)
    call read_entry_quantity(card, "inertia", dimension_inertia, system, .false., diagnostics, &
      slider%inertia, fine)
    if (.not. fine) return
    slider%inertia_word = value_of(card, "inertia")
    call refuse_negative(slider%inertia_word, slider%inertia, "a moment of inertia", diagnostics)
  end subroutine read_slider

end module joint_cards
