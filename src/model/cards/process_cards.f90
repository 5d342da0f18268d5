!> FORCE, TORQUE and LOAD cards on loads of processes: at any place of a link, in its axes, by a
!! table, in one direction of the motion, against the motion. Names and tables are looked up later,
!! by `process_checks`; constant forces on pins and constant torques are in `load_cards`.
module process_cards
  use body_cards, only: read_place
  use card_reader, only: check_form, has_key, has_value, key_of, read_choice, read_entry_quantity, &
    read_measure, read_quantity, refuse_negative, require_positive, value_of
  use card_table, only: pattern_of
  use cards, only: card_t
  use diagnostics, only: add_error, diagnostics_t
  use kinds, only: wp
  use tokens, only: token_t
  use units, only: dimension_damping, dimension_force, dimension_line_damping, dimension_moment, &
    dimension_none, dimension_rate, dimension_velocity, unit_system_t, unit_t
  implicit none (type, external)
  private

  public :: process_card_t, is_process_form, read_process_force, read_process_torque, &
    read_resistance
  public :: process_force, process_torque, process_resistance
  public :: over_nothing, over_drive, over_slider, over_travel, over_angle, over_measure, over_time
  public :: smooth_velocity, smooth_rate

  integer, parameter :: process_force = 1, process_torque = 2, process_resistance = 3

  !> What a table is over: nothing, the first drive, the place of the block at a pin, the travel of
  !! the place of the force along it, the angle of a link, a coordinate with a name, the time.
  integer, parameter :: over_nothing = 0, over_drive = 1, over_slider = 2, over_travel = 3, &
    over_angle = 4, over_measure = 5, over_time = 6

  !> Speeds within which loads change smoothly, unless the card says another [m/s], [rad/s].
  real(wp), parameter :: smooth_velocity = 1.0e-3_wp, smooth_rate = 1.0e-2_wp

  !> A load. Words without a line are not on the card.
  type :: process_card_t
    integer :: kind = process_force
    type(token_t) :: keyword
    type(token_t) :: subject               !! a pin or a link; without a line if the card lacks it
    logical :: on_link = .false.           !! the subject is a link
    integer :: link = 0                    !! its number in the model's list; 0: a pin, or unknown
    real(wp) :: place(2) = 0.0_wp          !! on the link, from the first pin of its card [m]
    type(token_t) :: place_word            !! value of `at=`
    logical :: in_link_axes = .false.      !! of the force
    type(token_t) :: axes_word             !! value of `axes=`
    real(wp) :: force(2) = 0.0_wp          !! with a table its direction, of any length [N] or [-]
    real(wp) :: torque = 0.0_wp            !! counter-clockwise; of a LOAD taken from the link
                                           !! [N m]
    integer :: during = 0                  !! 1: while the place moves with the load, −1: against
                                           !! it, 0: always
    real(wp) :: damping = 0.0_wp           !! [N s/m] or [N m s/rad]
    real(wp) :: resisting = 0.0_wp         !! [N] or [N m]
    real(wp) :: smooth = smooth_velocity   !! [m/s] or [rad/s]
    type(token_t) :: table_word            !! value of `table=`
    type(token_t) :: over_word             !! value of `over=`
    integer :: over = over_nothing         !! one of the over_… constants
    integer :: number = 0                  !! of the slider, link or coordinate that the table is
                                           !! over
    logical :: is_periodic = .false.       !! the table
    real(wp), allocatable :: x(:), y(:)    !! (rows) of the table [rad], [m] or [s], [N] or [N m]
  end type process_card_t

contains

  !> Whether a FORCE or TORQUE card is on a load that is not constant, or not on a pin.
  pure function is_process_form(card) result(is)
    type(card_t), intent(in) :: card !! a FORCE or TORQUE card
    logical :: is

    is = size(card%entries) > 0
  end function is_process_form

  !> Reads `FORCE pin fx fy` or `FORCE link fx fy at= [offset=]`, with `[axes=] [table= over=]
  !! [during=] [smooth=]`. Errors: words or keys that do not fit the card, unreadable values, a
  !! table with a direction of no length.
  pure subroutine read_process_force(card, system, diagnostics, process)
    type(card_t), intent(in) :: card                  !! the FORCE card
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(process_card_t), intent(out) :: process      !! as read; names are not looked up

    type(unit_t) :: none, measure
    logical :: fine, known_keys, read(2)
    integer :: i, choice

    call begin_card(card, process_force, process)
    call check_form(card, diagnostics, fine, known_keys)
    if (.not. fine .or. .not. known_keys) return
    process%subject = card%words(1)
    process%on_link = has_key(card, "at")
    if (process%on_link) then
      call read_place(card, "at", known_keys, system, diagnostics, process%place, &
        process%place_word)
    else if (has_key(card, "offset")) then
      call add_error(diagnostics, key_of(card, "offset"), &
        "'offset=' belongs to a place on a link, and 'at=' is missing")
    end if
    if (has_value(card, "axes")) then
      process%axes_word = value_of(card, "axes")
      call read_choice(process%axes_word, "global link", diagnostics, choice)
      process%in_link_axes = choice == 2
      if (process%in_link_axes .and. .not. process%on_link) call add_error(diagnostics, &
        process%axes_word, "a force at a pin is in global axes; in those of a link it acts "// &
        "at a place of this link; expected: "//pattern_of("FORCE"))
    end if
    call read_course(card, dimension_velocity, system, diagnostics, process)
    if (process%table_word%line > 0) then
      none%name = ""
      do i = 1, 2
        call read_measure(card%words(1 + i), dimension_none, none, diagnostics, process%force(i), &
          measure, read(i))
      end do
      if (all(read) .and. .not. norm2(process%force) > 0.0_wp) call add_error(diagnostics, &
        card%words(2), "beside 'table=' these two numbers are the direction of the force, and "// &
        "may not both be 0")
    else
      call read_quantity(card%words(2), dimension_force, system, diagnostics, process%force(1), &
        fine)
      call read_quantity(card%words(3), dimension_force, system, diagnostics, process%force(2), &
        fine)
    end if
  end subroutine read_process_force

  !> Reads `TORQUE link torque` or `TORQUE link table= [over=]`, with `[during=] [smooth=]`. Errors:
  !! words or keys that do not fit the card, unreadable values, a torque and a table or neither.
  pure subroutine read_process_torque(card, system, diagnostics, process)
    type(card_t), intent(in) :: card                  !! the TORQUE card
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(process_card_t), intent(out) :: process      !! as read; names are not looked up

    logical :: fine, known_keys

    call begin_card(card, process_torque, process)
    call check_form(card, diagnostics, fine, known_keys)
    if (.not. fine .or. .not. known_keys) return
    process%subject = card%words(1)
    process%on_link = .true.
    call read_course(card, dimension_rate, system, diagnostics, process)
    if (process%table_word%line > 0) then
      process%torque = 1.0_wp
      if (size(card%words) > 1) call add_error(diagnostics, card%words(2), &
        "the torque is that of the table; expected: "//pattern_of("TORQUE"))
    else if (size(card%words) < 2) then
      call add_error(diagnostics, card%keyword, "the torque is missing; expected: "// &
        pattern_of("TORQUE"))
    else
      call read_quantity(card%words(2), dimension_moment, system, diagnostics, process%torque, fine)
    end if
  end subroutine read_process_torque

  !> Reads `LOAD name [torque=] [damping=] [resisting=] [smooth=]`. Errors: words or keys that do
  !! not fit the card, none of the first three, unreadable or negative values.
  pure subroutine read_resistance(card, on_link, system, diagnostics, process)
    type(card_t), intent(in) :: card                  !! the LOAD card
    logical, intent(in) :: on_link                    !! a LINK card has this name; else it is a pin
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(process_card_t), intent(out) :: process      !! as read; names are not looked up

    logical :: fine, known_keys

    call begin_card(card, process_resistance, process)
    call check_form(card, diagnostics, fine, known_keys)
    if (size(card%words) > 0) process%subject = card%words(1)
    ! A torque is taken from a link, whatever its name.
    process%on_link = on_link .or. has_key(card, "torque")
    if (.not. known_keys) return
    if (.not. has_key(card, "torque") .and. .not. has_key(card, "damping") .and. &
      .not. has_key(card, "resisting")) call add_error(diagnostics, card%keyword, &
      "'torque=', 'damping=' or 'resisting=' is missing: this load would be zero")
    if (process%on_link) call read_entry_quantity(card, "torque", dimension_moment, system, &
      .false., diagnostics, process%torque, fine)
    call read_not_negative(card, "damping", merge(dimension_damping, dimension_line_damping, &
      process%on_link), system, diagnostics, process%damping)
    call read_not_negative(card, "resisting", merge(dimension_moment, dimension_force, &
      process%on_link), system, diagnostics, process%resisting)
    if (has_key(card, "smooth") .and. .not. has_key(card, "resisting")) call add_error( &
      diagnostics, key_of(card, "smooth"), "'smooth=' belongs to 'resisting=', which is missing")
    call read_smooth(card, merge(dimension_rate, dimension_velocity, process%on_link), system, &
      diagnostics, process)
  end subroutine read_resistance

  !> A card without anything.
  pure subroutine begin_card(card, kind, process)
    type(card_t), intent(in) :: card
    integer, intent(in) :: kind
    type(process_card_t), intent(inout) :: process

    process%kind = kind
    process%keyword = card%keyword
    process%subject = token_t("", 0, 0)
    process%place_word = token_t("", 0, 0)
    process%axes_word = token_t("", 0, 0)
    process%table_word = token_t("", 0, 0)
    process%over_word = token_t("", 0, 0)
    allocate (process%x(0), process%y(0))
  end subroutine begin_card

  !> Reads `[table= over=] [during=] [smooth=]`.
  pure subroutine read_course(card, dimension, system, diagnostics, process)
    type(card_t), intent(in) :: card
    integer, intent(in) :: dimension(4) !! of `smooth=`
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(process_card_t), intent(inout) :: process

    integer :: choice

    process%table_word = value_of(card, "table")
    if (has_value(card, "over")) then
      process%over_word = value_of(card, "over")
      if (process%table_word%line == 0) call add_error(diagnostics, key_of(card, "over"), &
        "'over=' says what a table is over, and 'table=' is missing")
    end if
    if (has_value(card, "during")) then
      call read_choice(value_of(card, "during"), "with against", diagnostics, choice)
      if (choice > 0) process%during = merge(1, -1, choice == 1)
    else if (has_key(card, "smooth")) then
      call add_error(diagnostics, key_of(card, "smooth"), &
        "'smooth=' belongs to 'during=', which is missing")
    end if
    call read_smooth(card, dimension, system, diagnostics, process)
  end subroutine read_course

  !> Reads `smooth=`, the speed within which a load changes smoothly.
  pure subroutine read_smooth(card, dimension, system, diagnostics, process)
    type(card_t), intent(in) :: card
    integer, intent(in) :: dimension(4)
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(process_card_t), intent(inout) :: process

    real(wp) :: value
    logical :: fine

    process%smooth = merge(smooth_rate, smooth_velocity, all(dimension == dimension_rate))
    call read_entry_quantity(card, "smooth", dimension, system, .false., diagnostics, value, fine)
    if (.not. fine) return
    call require_positive(card, "smooth", value, diagnostics)
    if (value > 0.0_wp) process%smooth = value
  end subroutine read_smooth

  pure subroutine read_not_negative(card, key, dimension, system, diagnostics, value)
    type(card_t), intent(in) :: card
    character(len=*), intent(in) :: key
    integer, intent(in) :: dimension(4)
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    real(wp), intent(out) :: value

    logical :: fine

    call read_entry_quantity(card, key, dimension, system, .false., diagnostics, value, fine)
    if (fine) call refuse_negative(value_of(card, key), value, key, diagnostics)
  end subroutine read_not_negative

end module process_cards
