!> CRANK and SPEED: the positions and speeds that are computed.
module request_cards
  use card_reader, only: check_form, read_entry_quantity
  use cards, only: card_t
  use diagnostics, only: diagnostics_t
  use kinds, only: wp
  use units, only: dimension_angle, dimension_angular_acceleration, dimension_rate, unit_system_t
  use value_lists, only: read_values, value_list_t
  implicit none (type, external)
  private

  public :: read_crank, read_speed

contains

  !> Reads `CRANK` angles [deg]: numbers and ranges `a to b step s`, perhaps with one unit at the
  !! end for all of them.
  pure subroutine read_crank(card, system, diagnostics, crank)
    type(card_t), intent(in) :: card
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(value_list_t), intent(out) :: crank

    logical :: fine

    call check_form(card, 1, huge(1), "", "CRANK a to b step s, or a list of angles", diagnostics, &
      fine)
    call read_values(card%words, dimension_angle, system, "crank angle", diagnostics, crank)
  end subroutine read_crank

  !> Reads `SPEED` values [rad/s], listed like crank angles, and `alpha=` [rad/s²].
  pure subroutine read_speed(card, system, diagnostics, speed, acceleration)
    type(card_t), intent(in) :: card
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(value_list_t), intent(out) :: speed
    real(wp), intent(out) :: acceleration !! [rad/s²]

    logical :: fine

    call check_form(card, 1, huge(1), "alpha", &
      "SPEED a list or range of speeds [rad/s|rpm] [alpha=]", diagnostics, fine)
    call read_values(card%words, dimension_rate, system, "speed", diagnostics, speed)
    call read_entry_quantity(card, "alpha", dimension_angular_acceleration, system, .false., &
      diagnostics, acceleration, fine)
  end subroutine read_speed

end module request_cards
