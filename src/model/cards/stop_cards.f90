!> STOP cards: what pushes a coordinate back beyond a limit. The coordinate is looked up later, by
!! `stop_checks`, which reads these cards: their units depend on it.
module stop_cards
  use card_reader, only: check_form, read_choice, read_entry_quantity, read_part_name, &
    refuse_negative, require_positive, value_of
  use cards, only: card_t
  use diagnostics, only: diagnostics_t
  use kinds, only: wp
  use natures, only: length_nature, nature_t
  use tokens, only: token_t
  use units, only: unit_system_t
  implicit none (type, external)
  private

  public :: stop_card_t, read_stop, read_contact

  type :: stop_card_t
    type(token_t) :: keyword
    type(token_t) :: name            !! without a line if the card lacks it
    type(token_t) :: measure         !! name of the coordinate; without a line likewise
    integer :: number = 0            !! of the coordinate among those with names; 0: unknown
    type(nature_t) :: nature = length_nature !! of the coordinate
    logical :: is_below = .false.    !! what is below the limit is pushed back; else what is above
    real(wp) :: limit = 0.0_wp       !! [m] or [rad]
    real(wp) :: stiffness = 0.0_wp   !! [N/m] or [N m/rad]
    real(wp) :: damping = 0.0_wp     !! [N s/m] or [N m s/rad]
    real(wp) :: contact = 0.0_wp     !! width of the contact [m] or [rad]; 0: not on the card
  end type stop_card_t

contains

  !> Reads `STOP name measure limit= stiffness= [damping=] [contact=] [below]`. Errors: words or
  !! keys that do not fit the card, an invalid name, a missing or unreadable value, a stiffness or
  !! width that is not positive, a negative damping.
  pure subroutine read_stop(card, nature, system, diagnostics, stop)
    type(card_t), intent(in) :: card                  !! the STOP card
    type(nature_t), intent(in) :: nature              !! of the coordinate that it names
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(stop_card_t), intent(out) :: stop            !! as read; names are not looked up

    logical :: fine, known_keys
    integer :: choice

    stop%keyword = card%keyword
    stop%name = token_t("", 0, 0)
    stop%measure = token_t("", 0, 0)
    stop%nature = nature
    call check_form(card, diagnostics, fine, known_keys)
    if (.not. fine) return
    stop%name = card%words(1)
    call read_part_name(stop%name, diagnostics)
    stop%measure = card%words(2)
    if (size(card%words) > 2) then
      call read_choice(card%words(3), "below", diagnostics, choice)
      stop%is_below = choice == 1
    end if
    call read_entry_quantity(card, "limit", nature%value, system, known_keys, diagnostics, &
      stop%limit, fine)
    call read_entry_quantity(card, "stiffness", nature%stiffness, system, known_keys, diagnostics, &
      stop%stiffness, fine)
    if (fine) call require_positive(card, "stiffness", stop%stiffness, diagnostics)
    call read_contact(card, nature, system, diagnostics, stop%damping, stop%contact)
  end subroutine read_stop

  !> Reads `[damping=] [contact=]` of what acts on one side of a limit. Errors: unreadable values, a
  !! negative damping, a width that is not positive.
  pure subroutine read_contact(card, nature, system, diagnostics, damping, contact)
    type(card_t), intent(in) :: card                  !! of any kind
    type(nature_t), intent(in) :: nature              !! of the coordinate
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    real(wp), intent(out) :: damping                  !! [N s/m] or [N m s/rad]
    real(wp), intent(out) :: contact                  !! [m] or [rad]; 0: not on the card

    logical :: fine

    call read_entry_quantity(card, "damping", nature%damping, system, .false., diagnostics, &
      damping, fine)
    if (fine) call refuse_negative(value_of(card, "damping"), damping, "the damping", diagnostics)
    call read_entry_quantity(card, "contact", nature%value, system, .false., diagnostics, contact, &
      fine)
    if (.not. fine) return
    call require_positive(card, "contact", contact, diagnostics)
    ! It is not missing, too.
    if (contact <= 0.0_wp) contact = 1.0_wp
  end subroutine read_contact

end module stop_cards
