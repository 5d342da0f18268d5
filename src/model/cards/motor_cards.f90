!> MOTOR card: the driving torque of forward dynamics (REPORT motion), and the gear of the motor. A
!! table of torques over speeds is read later, by `motor_checks`.
module motor_cards
  use card_reader, only: check_form, has_key, has_value, key_of, read_entry_count, &
    read_entry_quantity, refuse_negative, require_positive, value_of
  use card_table, only: pattern_of
  use cards, only: card_t
  use diagnostics, only: add_error, diagnostics_t
  use kinds, only: wp
  use tokens, only: earlier, token_t
  use units, only: dimension_inertia, dimension_moment, dimension_none, dimension_rate, &
    unit_system_t
  implicit none (type, external)
  private

  public :: motor_t, read_motor, is_geared

  !> Torque of the motor: constant, `stall (1 − ω/noload)`, or a line of a table; and what is
  !! between its shaft and the driven link.
  type :: motor_t
    type(token_t) :: keyword       !! without a line if the deck has no motor
    logical :: is_line = .false.   !! torque falls linearly with speed
    real(wp) :: torque = 0.0_wp    !! constant, counter-clockwise [N m]
    real(wp) :: stall = 0.0_wp     !! torque at rest, counter-clockwise [N m]
    real(wp) :: noload = 0.0_wp    !! speed at zero torque, of the same sign [rad/s]
    type(token_t) :: table_word    !! value of `table=`; without a line if it is not given
    integer :: line = 1            !! which column of torques of the table
    type(token_t) :: line_word     !! value of `line=`, likewise
    real(wp), allocatable :: speed(:), line_torque(:) !! (rows) of the table; none without it
                                   !! [rad/s], [N m]
    real(wp) :: ratio = 1.0_wp     !! turns of the motor per turn of the driven link [-]
    real(wp) :: rotor = 0.0_wp     !! its moment of inertia about its axis [kg m²]
    real(wp) :: efficiency = 1.0_wp !! of the gear [-]
    real(wp) :: smooth = 0.01_wp   !! speed of the driven link within which losses of the gear
                                   !! change their sign smoothly [rad/s]
  end type motor_t

contains

  !> Whether a motor has a gear or a rotor: its shaft differs from that of the driven link.
  elemental function is_geared(motor) result(is)
    type(motor_t), intent(in) :: motor !! as read
    logical :: is

    is = abs(motor%ratio - 1.0_wp) > 0.0_wp .or. motor%rotor > 0.0_wp .or. &
      motor%efficiency < 1.0_wp
  end function is_geared

  !> Reads `MOTOR torque=`, `MOTOR stall= noload=` or `MOTOR table= [line=]`, with `[ratio=]
  !! [rotor=] [efficiency=] [smooth=]`. Errors: words or keys that do not fit the card, two forms at
  !! once or none, a missing or unreadable value, `stall=`, `noload=` or `ratio=` of 0, the first
  !! two with different signs, `line=` without a table, a negative rotor, an efficiency out of
  !! range, `smooth=` without an efficiency.
  pure subroutine read_motor(card, system, diagnostics, motor)
    type(card_t), intent(in) :: card                  !! the MOTOR card
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(motor_t), intent(out) :: motor               !! as read; its table is not looked up

    logical :: fine, known_keys, stalls, runs

    call clear_motor(motor)
    motor%keyword = card%keyword
    call check_form(card, diagnostics, fine, known_keys)
    motor%is_line = has_key(card, "stall") .or. has_key(card, "noload")
    if (count([has_key(card, "torque"), motor%is_line, has_key(card, "table")]) > 1) then
      call refuse_mixture(card, diagnostics)
      return
    end if
    call read_gear(card, system, diagnostics, motor)
    call read_table_word(card, diagnostics, motor)
    if (has_key(card, "table")) return
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
    call add_error(diagnostics, value_of(card, "noload"), &
      "'stall=' and 'noload=' must have the same sign: a motor turns in the sense of its torque", &
      value_of(card, "stall"), "'stall=' is given here")
  end subroutine read_motor

  !> No motor.
  pure subroutine clear_motor(motor)
    type(motor_t), intent(inout) :: motor

    motor%keyword = token_t("", 0, 0)
    motor%table_word = token_t("", 0, 0)
    motor%line_word = token_t("", 0, 0)
    allocate (motor%speed(0), motor%line_torque(0))
  end subroutine clear_motor

  !> Reads `table= [line=]`.
  pure subroutine read_table_word(card, diagnostics, motor)
    type(card_t), intent(in) :: card
    type(diagnostics_t), intent(inout) :: diagnostics
    type(motor_t), intent(inout) :: motor

    logical :: fine

    motor%table_word = value_of(card, "table")
    if (.not. has_value(card, "line")) return
    motor%line_word = value_of(card, "line")
    if (.not. has_key(card, "table")) call add_error(diagnostics, key_of(card, "line"), &
      "'line=' says which line of a table holds, and 'table=' is missing")
    call read_entry_count(card, "line", 1, diagnostics, motor%line, fine)
  end subroutine read_table_word

  !> Reads `[ratio=] [rotor=] [efficiency=] [smooth=]`.
  pure subroutine read_gear(card, system, diagnostics, motor)
    type(card_t), intent(in) :: card
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(motor_t), intent(inout) :: motor

    type(token_t) :: word
    real(wp) :: value
    logical :: fine

    call read_entry_quantity(card, "ratio", dimension_none, system, .false., diagnostics, value, &
      fine)
    if (fine) call refuse_zero(card, "ratio", value, diagnostics)
    if (fine) motor%ratio = value
    call read_entry_quantity(card, "rotor", dimension_inertia, system, .false., diagnostics, &
      motor%rotor, fine)
    if (fine) call refuse_negative(value_of(card, "rotor"), motor%rotor, &
      "a moment of inertia", diagnostics)
    call read_entry_quantity(card, "efficiency", dimension_none, system, .false., diagnostics, &
      value, fine)
    if (fine) then
      word = value_of(card, "efficiency")
      if (value > 0.0_wp .and. value <= 1.0_wp) then
        motor%efficiency = value
      else
        call add_error(diagnostics, word, "the efficiency of a gear is above 0 and at most 1, "// &
          "not "//word%text)
      end if
    end if
    if (.not. has_key(card, "smooth")) return
    if (.not. has_key(card, "efficiency")) call add_error(diagnostics, &
      key_of(card, "smooth"), "'smooth=' belongs to 'efficiency=', which is missing")
    call read_entry_quantity(card, "smooth", dimension_rate, system, .false., diagnostics, value, &
      fine)
    if (.not. fine) return
    call require_positive(card, "smooth", value, diagnostics)
    if (value > 0.0_wp) motor%smooth = value
  end subroutine read_gear

  pure subroutine refuse_zero(card, key, value, diagnostics)
    type(card_t), intent(in) :: card
    character(len=*), intent(in) :: key
    real(wp), intent(in) :: value
    type(diagnostics_t), intent(inout) :: diagnostics

    if (abs(value) > 0.0_wp) return
    call add_error(diagnostics, value_of(card, key), "'"//key//"=' must not be 0")
  end subroutine refuse_zero

  !> Reports a motor with two of a constant torque, one that falls with speed, and a table.
  pure subroutine refuse_mixture(card, diagnostics)
    type(card_t), intent(in) :: card
    type(diagnostics_t), intent(inout) :: diagnostics

    type(token_t) :: constant, line, table, other

    constant = key_of(card, "torque")
    line = earlier(key_of(card, "stall"), key_of(card, "noload"))
    table = key_of(card, "table")
    if (table%line > 0) then
      other = earlier(constant, line)
      call add_error(diagnostics, other, "the torque of this motor is that of its table: '"// &
        other%text//"=' has no meaning beside it", table, "'table=' is given here")
      return
    end if
    call add_error(diagnostics, line, "a motor has a constant torque, 'torque=', or one that "// &
      "falls with its speed, 'stall= noload=', not both", constant, "'torque=' is given here")
  end subroutine refuse_mixture

end module motor_cards
