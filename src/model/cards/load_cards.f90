!> GRAVITY card; FORCE and TORQUE cards of constant forces on pins and constant torques. Names are
!! looked up later, by `body_checks`; all other loads are in `process_cards`.
module load_cards
  use card_reader, only: check_form, read_quantity
  use card_table, only: pattern_of
  use cards, only: card_t
  use diagnostics, only: add_error, add_warning, diagnostics_t
  use errors, only: error_t
  use kinds, only: wp
  use numbers, only: number_length, read_real
  use text, only: string_t, to_string, word_list
  use tokens, only: token_t
  use units, only: coherent_unit, dimension_acceleration, dimension_force, dimension_moment, &
    read_unit, to_si, unit_system_t, unit_t
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

  !> Limits of gravity without a warning [m/s²]: that of the moon is 1.62, of Jupiter 24.8. A slip
  !! from mm to m is a factor of 1000.
  real(wp), parameter :: least_gravity = 1.0_wp, most_gravity = 30.0_wp

contains

  !> Reads `GRAVITY gx gy`. Errors: words or keys that do not fit the card, unreadable values.
  !! Warning: a gravity that points to wrong units.
  pure subroutine read_gravity(card, system, diagnostics, gravity)
    type(card_t), intent(in) :: card                  !! the GRAVITY card
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    real(wp), intent(out) :: gravity(2)               !! in global axes [m/s²]

    logical :: fine, both(2)

    gravity = 0.0_wp
    call check_form(card, diagnostics, fine)
    if (.not. fine) return
    call read_quantity(card%words(1), dimension_acceleration, system, diagnostics, gravity(1), &
      both(1))
    call read_quantity(card%words(2), dimension_acceleration, system, diagnostics, gravity(2), &
      both(2))
    if (all(both)) call warn_of_gravity(card%words(maxloc(abs(gravity), dim=1)), gravity, system, &
      diagnostics)
  end subroutine read_gravity

  !> Warns of a gravity unlike that of any planet, but not of none.
  pure subroutine warn_of_gravity(word, gravity, system, diagnostics)
    type(token_t), intent(in) :: word !! the larger component
    real(wp), intent(in) :: gravity(2)
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics

    type(unit_t) :: bare
    type(string_t), allocatable :: names(:)
    type(unit_t) :: measure
    type(error_t), allocatable :: error
    character(len=:), allocatable :: message
    real(wp) :: number
    integer :: i

    if (norm2(gravity) <= 0.0_wp .or. is_usual(norm2(gravity))) return
    message = "gravity of "//to_string(norm2(gravity), 3)//" m/s2"
    if (number_length(word%text) < len(word%text)) then
      call add_warning(diagnostics, word, message//" (on earth 9.81): is its unit right?")
      return
    end if
    bare = coherent_unit(system, dimension_acceleration)
    message = message//": bare accelerations are in "//bare%name//" here"
    call read_real(word%text, number, error)
    names = word_list("m/s2 mm/s2 cm/s2 ft/s2 in/s2")
    do i = 1, size(names)
      call read_unit(names(i)%text, dimension_acceleration, measure, error)
      if (.not. is_usual(abs(to_si(number, measure)))) cycle
      message = message//"; write "//word%text//names(i)%text
      exit
    end do
    call add_warning(diagnostics, word, message)
  end subroutine warn_of_gravity

  elemental function is_usual(gravity) result(is)
    real(wp), intent(in) :: gravity !! magnitude [m/s²]
    logical :: is

    is = gravity >= least_gravity .and. gravity <= most_gravity
  end function is_usual

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
    if (fine .and. size(card%words) < 2) then
      call add_error(diagnostics, card%keyword, "the torque is missing; expected: "// &
        pattern_of("TORQUE"))
      return
    end if
    if (fine) call read_quantity(card%words(2), dimension_moment, system, diagnostics, &
      torque%torque, fine)
  end subroutine read_torque

end module load_cards
