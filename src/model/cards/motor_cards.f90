!> MOTOR card: the driving torque of forward dynamics (REPORT motion).
module motor_cards
  use card_reader, only: check_form, entry_number, has_key, read_entry_quantity
  use card_table, only: pattern_of
  use cards, only: card_t
  use diagnostics, only: add_error, diagnostics_t
  use kinds, only: wp
  use text, only: same_word
  use tokens, only: token_t
  use units, only: dimension_moment, dimension_rate, unit_system_t
  implicit none (type, external)
  private

  public :: motor_t, read_motor

  !> Torque on the driven link: constant, or `stall (1 − ω2/noload)`.
  type :: motor_t
    type(token_t) :: keyword       !! without a line if the deck has no motor
    logical :: is_line = .false.   !! torque falls linearly with speed
    real(wp) :: torque = 0.0_wp    !! constant, counter-clockwise [N m]
    real(wp) :: stall = 0.0_wp     !! torque at rest, counter-clockwise [N m]
    real(wp) :: noload = 0.0_wp    !! speed at zero torque, of the same sign [rad/s]
  end type motor_t

contains

  !> Reads `MOTOR torque=` or `MOTOR stall= noload=`. Errors: words or keys that do not fit the
  !! card, both forms at once or neither, a missing or unreadable value, `stall=` or `noload=` of 0
  !! or with different signs.
  pure subroutine read_motor(card, system, diagnostics, motor)
    type(card_t), intent(in) :: card                  !! the MOTOR card
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(motor_t), intent(out) :: motor               !! as read

    logical :: fine, known_keys, stalls, runs

    motor%keyword = card%keyword
    call check_form(card, diagnostics, fine, known_keys)
    motor%is_line = has_key(card, "stall") .or. has_key(card, "noload")
    if (has_key(card, "torque") .and. motor%is_line) then
      call refuse_mixture(card, diagnostics)
      return
    end if
    if (known_keys .and. .not. has_key(card, "torque") .and. .not. motor%is_line) then
      call add_error(diagnostics, card%keyword, &
        "the torque of the motor is missing; expected: "//pattern_of("MOTOR"))
    end if
    call read_entry_quantity(card, "torque", dimension_moment, system, .false., diagnostics, &
      motor%torque, fine)
    if (.not. motor%is_line) return
    call read_entry_quantity(card, "stall", dimension_moment, system, known_keys, diagnostics, &
      motor%stall, stalls)
    call read_entry_quantity(card, "noload", dimension_rate, system, known_keys, diagnostics, &
      motor%noload, runs)
    if (stalls) call refuse_zero(card, "stall", motor%stall, diagnostics)
    if (runs) call refuse_zero(card, "noload", motor%noload, diagnostics)
    if (.not. (stalls .and. runs) .or. motor%stall*motor%noload >= 0.0_wp) return
    call add_error(diagnostics, card%entries(entry_number(card, "noload"))%value, &
      "'stall=' and 'noload=' must have the same sign: a motor turns in the sense of its torque", &
      card%entries(entry_number(card, "stall"))%value, "'stall=' is given here")
  end subroutine read_motor

  pure subroutine refuse_zero(card, key, value, diagnostics)
    type(card_t), intent(in) :: card
    character(len=*), intent(in) :: key
    real(wp), intent(in) :: value
    type(diagnostics_t), intent(inout) :: diagnostics

    if (abs(value) > 0.0_wp) return
    call add_error(diagnostics, card%entries(entry_number(card, key))%value, &
      "'"//key//"=' must not be 0")
  end subroutine refuse_zero

  !> Reports a motor with both a constant torque and one that falls with speed.
  pure subroutine refuse_mixture(card, diagnostics)
    type(card_t), intent(in) :: card
    type(diagnostics_t), intent(inout) :: diagnostics

    integer :: i, constant, line

    constant = 0
    line = 0
    do i = size(card%entries), 1, -1
      associate (key => card%entries(i)%key%text)
        if (same_word(key, "torque")) constant = i
        if (same_word(key, "stall") .or. same_word(key, "noload")) line = i
      end associate
    end do
    call add_error(diagnostics, card%entries(line)%key, &
      "a motor has a constant torque, 'torque=', or one that falls with its "// &
      "speed, 'stall= noload=', not both", card%entries(constant)%key, "'torque=' is given here")
  end subroutine refuse_mixture

end module motor_cards
