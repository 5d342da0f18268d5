!> GRAVITY, FORCE and TORQUE cards: constant external loads. Names are looked up later, by
!! `body_checks`.
module load_cards
  use card_reader, only: check_form, read_quantity
  use cards, only: card_t
  use diagnostics, only: diagnostics_t
  use kinds, only: wp
  use tokens, only: token_t
  use units, only: dimension_acceleration, dimension_force, dimension_moment, unit_system_t
  implicit none (type, external)
  private

  public :: force_card_t, torque_card_t, read_gravity, read_force, read_torque

  !> A force on a moving pin, in global axes.
  type :: force_card_t
    type(token_t) :: pin           !! without a line if the card lacks it
    real(wp) :: force(2) = 0.0_wp  !! [N]
  end type force_card_t

  !> A torque on a link.
  type :: torque_card_t
    type(token_t) :: link_name     !! without a line if the card lacks it
    integer :: link = 0            !! number in the model's list; 0: unknown
    real(wp) :: torque = 0.0_wp    !! counter-clockwise [N m]
  end type torque_card_t

contains

  !> Reads `GRAVITY gx gy`. Errors: words or keys that do not fit the card, unreadable values.
  pure subroutine read_gravity(card, system, diagnostics, gravity)
    type(card_t), intent(in) :: card                  !! the GRAVITY card
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    real(wp), intent(out) :: gravity(2)               !! in global axes [m/s²]

    logical :: fine

    gravity = 0.0_wp
    call check_form(card, diagnostics, fine)
    if (.not. fine) return
    call read_quantity(card%words(1), dimension_acceleration, system, diagnostics, gravity(1), fine)
    call read_quantity(card%words(2), dimension_acceleration, system, diagnostics, gravity(2), fine)
  end subroutine read_gravity

  !> Reads `FORCE pin fx fy`. Errors: words or keys that do not fit the card, unreadable values.
  pure subroutine read_force(card, system, diagnostics, force)
    type(card_t), intent(in) :: card                  !! the FORCE card
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(force_card_t), intent(out) :: force          !! as read; the pin is not looked up

    logical :: fine

    force%pin = token_t("", 0, 0)
    call check_form(card, diagnostics, fine)
    if (size(card%words) > 0) force%pin = card%words(1)
    if (.not. fine) return
    call read_quantity(card%words(2), dimension_force, system, diagnostics, force%force(1), fine)
    call read_quantity(card%words(3), dimension_force, system, diagnostics, force%force(2), fine)
  end subroutine read_force

  !> Reads `TORQUE link value`. Errors: words or keys that do not fit the card, an unreadable value.
  pure subroutine read_torque(card, system, diagnostics, torque)
    type(card_t), intent(in) :: card                  !! the TORQUE card
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(torque_card_t), intent(out) :: torque        !! as read; the link is not looked up

    logical :: fine

    torque%link_name = token_t("", 0, 0)
    call check_form(card, diagnostics, fine)
    if (size(card%words) > 0) torque%link_name = card%words(1)
    if (fine) call read_quantity(card%words(2), dimension_moment, system, diagnostics, &
      torque%torque, fine)
  end subroutine read_torque

end module load_cards
