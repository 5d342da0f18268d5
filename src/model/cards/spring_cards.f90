!> SPRING and DAMPER cards: along the line between two places, or torsional between two links or a
!! link and the ground. Names are looked up later, by `spring_checks`.
module spring_cards
  use card_reader, only: check_form, has_key, has_value, key_of, read_choice, &
    read_entry_quantity, read_part_name, refuse_negative, require_positive, value_of
  use cards, only: card_t
  use diagnostics, only: add_error, diagnostics_t
  use kinds, only: wp
  use natures, only: angle_nature, length_nature, nature_t
  use pull_laws, only: pull_law_t
  use stop_cards, only: contact_keys, read_contact
  use text, only: same_word
  use tokens, only: earlier, later, token_t
  use units, only: unit_system_t
  implicit none (type, external)
  private

  public :: spring_card_t, is_spring_card, read_spring

  !> A spring or a damper. Its coordinate is the distance of its ends, or the angle of its second
  !! link less that of its first: of one link the angle of this.
  type :: spring_card_t
    type(token_t) :: keyword
    type(token_t) :: name                !! without a line if the card lacks it
    logical :: damps = .false.           !! a damper
    logical :: turns = .false.           !! torsional
    type(nature_t) :: nature = length_nature !! of its coordinate
    type(token_t) :: ends(2)             !! pins or points; of a torsional one the first is its pin
    type(token_t) :: link_names(2)       !! of a torsional one; the second has no line if the first
                                         !! turns against the ground
    integer :: link(2) = 0               !! numbers in the model's list; 0: unknown, the ground
    type(pull_law_t) :: law              !! without `contact=` 0
    logical :: has_rest = .false.        !! `free_length=` or `free_angle=`; else it follows from
                                         !! the drawing
    type(token_t) :: load_word           !! value of `force=` or `torque=`; else without a line
    type(token_t) :: side_word           !! value of `only=`; else without a line
    real(wp) :: gap = 0.0_wp             !! from the rest to where it acts [m] or [rad]
    real(wp) :: load = 0.0_wp            !! in the drawing: tension, or against a growing angle [N]
                                         !! or [N m]
  end type spring_card_t

contains

  !> Whether a card is one of these.
  pure function is_spring_card(card) result(is)
    type(card_t), intent(in) :: card !! of any kind
    logical :: is

    is = same_word(card%keyword%text, "SPRING") .or. same_word(card%keyword%text, "DAMPER")
  end function is_spring_card

  !> Reads `SPRING name end end stiffness= [free_length= | force=]`, `SPRING name pin link [link]
  !! stiffness= [free_angle= | torque=]`, both with `[only=push|pull [gap=] [damping=] [contact=]]`,
  !! and the DAMPER cards that have `damping=` instead.
  !! Errors: words or keys that do not fit the card, an invalid name, a missing, negative or
  !! unreadable value, a key of the other form, a rest and a load at once.
  pure subroutine read_spring(card, turns, system, diagnostics, spring)
    type(card_t), intent(in) :: card                  !! the SPRING or DAMPER card
    logical, intent(in) :: turns                      !! it is torsional: its last word is a link
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(spring_card_t), intent(out) :: spring             !! as read; names are not looked up

    type(token_t) :: none
    character(len=:), allocatable :: rest, load
    logical :: fine, known_keys, has_load, is_stiff

    none = token_t("", 0, 0)
    spring%keyword = card%keyword
    spring%name = none
    spring%ends(1) = none
    spring%ends(2) = none
    spring%link_names(1) = none
    spring%link_names(2) = none
    spring%load_word = none
    spring%side_word = none
    spring%damps = same_word(card%keyword%text, "DAMPER")
    spring%turns = turns
    if (turns) spring%nature = angle_nature
    rest = "free_"//trim(spring%nature%noun)
    load = trim(spring%nature%effort_noun)
    call check_form(card, diagnostics, fine, known_keys)
    if (size(card%words) > 0) then
      spring%name = card%words(1)
      call read_part_name(spring%name, diagnostics)
    end if
    if (fine) then
      spring%ends(1) = card%words(2)
      if (turns) then
        spring%link_names(1) = card%words(3)
        if (size(card%words) > 3) spring%link_names(2) = card%words(4)
      else
        spring%ends(2) = card%words(3)
        if (size(card%words) > 3) call add_error(diagnostics, card%words(4), &
          "between two places nothing follows them; a torsional one has a pin and two links")
      end if
    end if
    if (spring%damps) then
      call read_factor(card, "damping", spring%nature%damping, known_keys, system, diagnostics, &
        spring%law%damping, fine)
      return
    end if
    call read_factor(card, "stiffness", spring%nature%stiffness, known_keys, system, diagnostics, &
      spring%law%stiffness, is_stiff)
    call refuse_other_form(card, turns, diagnostics)
    call read_entry_quantity(card, rest, spring%nature%value, system, .false., diagnostics, &
      spring%law%rest, spring%has_rest)
    if (spring%has_rest .and. .not. turns) call refuse_negative(value_of(card, rest), &
      spring%law%rest, "a free length", diagnostics)
    call read_entry_quantity(card, load, spring%nature%effort, system, .false., diagnostics, &
      spring%load, has_load)
    if (has_load) spring%load_word = value_of(card, load)
    call read_side(card, rest, load, is_stiff, system, diagnostics, spring)
    if (spring%has_rest .and. has_load) call refuse_both(card, rest, load, diagnostics)
    if (is_stiff .and. .not. spring%law%stiffness > 0.0_wp .and. .not. has_load .and. &
      spring%side_word%line == 0) call &
      add_error(diagnostics, value_of(card, "stiffness"), &
      "a spring without stiffness does nothing but with '"//load//"=', which it then keeps")
  end subroutine read_spring

  !> Reads `[only=push|pull [gap=] [damping=] [contact=]]`. Errors: unreadable or negative values,
  !! the others without the first, a load in the drawing beside it, no stiffness.
  pure subroutine read_side(card, rest, load, is_stiff, system, diagnostics, spring)
    type(card_t), intent(in) :: card
    character(len=*), intent(in) :: rest, load !! keys
    logical, intent(in) :: is_stiff !! its stiffness was read
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(spring_card_t), intent(inout) :: spring !! with all else

    character(len=*), parameter :: others(*) = [character(len=7) :: "gap", contact_keys]
    logical :: fine
    integer :: choice, i

    if (.not. has_key(card, "only")) then
      do i = 1, size(others)
        if (has_key(card, trim(others(i)))) call add_error(diagnostics, key_of(card, &
          trim(others(i))), "'"//trim(others(i))//"=' belongs to a spring of one side, and "// &
          "'only=push' or 'only=pull' is missing")
      end do
      return
    end if
    if (.not. has_value(card, "only")) return
    spring%side_word = value_of(card, "only")
    call read_choice(spring%side_word, "push pull", diagnostics, choice)
    if (choice > 0) spring%law%side = merge(-1, 1, choice == 1)
    call read_entry_quantity(card, "gap", spring%nature%value, system, .false., diagnostics, &
      spring%gap, fine)
    if (fine) call refuse_negative(value_of(card, "gap"), spring%gap, "a gap", diagnostics)
    call read_contact(card, spring%nature, system, diagnostics, spring%law)
    if (spring%load_word%line > 0) call add_error(diagnostics, key_of(card, load), &
      "a spring of one side is unloaded in the drawing, or at '"//rest//"='")
    if (is_stiff) call require_positive(card, "stiffness", spring%law%stiffness, diagnostics)
  end subroutine read_side

  !> Reads the value that every such card has.
  pure subroutine read_factor(card, key, dimension, known_keys, system, diagnostics, value, &
    fine)
    type(card_t), intent(in) :: card
    character(len=*), intent(in) :: key
    integer, intent(in) :: dimension(4)
    logical, intent(in) :: known_keys !! no key is unknown: a missing one is an error
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    real(wp), intent(out) :: value
    logical, intent(out) :: fine !! whether it was read and is not negative

    call read_entry_quantity(card, key, dimension, system, known_keys, diagnostics, value, fine)
    if (fine) call refuse_negative(value_of(card, key), value, "the "//key, diagnostics)
    fine = fine .and. value >= 0.0_wp
  end subroutine read_factor

  !> Reports keys of springs between places on a torsional one, and the other way round.
  pure subroutine refuse_other_form(card, turns, diagnostics)
    type(card_t), intent(in) :: card
    logical, intent(in) :: turns
    type(diagnostics_t), intent(inout) :: diagnostics

    integer :: i

    do i = 1, size(card%entries)
      associate (key => card%entries(i)%key)
        if (turns .and. (same_word(key%text, "free_length") .or. same_word(key%text, "force"))) &
          then
          call add_error(diagnostics, key, "'"//key%text//"=' is of a spring between "// &
          "two places; "// &
            "this one is torsional, for its last word is a link: 'free_angle=' or 'torque='")
        else if (.not. turns .and. (same_word(key%text, "free_angle") .or. same_word(key%text, &
          "torque"))) then
          call add_error(diagnostics, key, "'"//key%text//"=' is of a torsional spring, at a "// &
            "pin of links; this one is between two places: 'free_length=' or 'force='")
        end if
      end associate
    end do
  end subroutine refuse_other_form

  !> Reports a spring whose load in the drawing and whose rest are given.
  pure subroutine refuse_both(card, rest, load, diagnostics)
    type(card_t), intent(in) :: card
    character(len=*), intent(in) :: rest, load !! keys
    type(diagnostics_t), intent(inout) :: diagnostics

    type(token_t) :: first

    first = earlier(key_of(card, rest), key_of(card, load))
    call add_error(diagnostics, later(key_of(card, rest), key_of(card, load)), "a spring has '"// &
      rest//"=' or '"//load//"=', not both", first, "'"//first%text//"=' is given here")
  end subroutine refuse_both

end module spring_cards
