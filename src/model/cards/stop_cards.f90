!> STOP cards: what pushes a coordinate back beyond a limit. The coordinate is looked up later, by
!! `stop_checks`, which reads these cards: their units depend on it.
module stop_cards
  use card_reader, only: check_form, read_choice, read_entry_quantity, read_part_name, &
    refuse_negative, require_positive, value_of
  use cards, only: card_t
  use diagnostics, only: diagnostics_t
  use kinds, only: wp
  use natures, only: length_nature, nature_t
  use pull_laws, only: pull_law_t
  use tokens, only: token_t
  use units, only: unit_system_t
  implicit none (type, external)
  private

  public :: stop_card_t, read_stop, read_contact, contact_keys

  !> Keys of what acts on one side of a limit, beside the stiffness.
  character(len=*), parameter :: contact_keys(*) = [character(len=7) :: "damping", "contact"]

  type :: stop_card_t
    type(token_t) :: keyword
    type(token_t) :: name            !! without a line if the card lacks it
    type(token_t) :: measure         !! name of the coordinate; without a line likewise
    integer :: number = 0            !! of the coordinate among those with names; 0: unknown
    type(nature_t) :: nature = length_nature !! of the coordinate
    type(pull_law_t) :: law          !! its rest is the limit; without `contact=` 0
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
    stop%law%side = 1
    call check_form(card, diagnostics, fine, known_keys)
    if (.not. fine) return
    stop%name = card%words(1)
    call read_part_name(stop%name, diagnostics)
    stop%measure = card%words(2)
    if (size(card%words) > 2) then
      call read_choice(card%words(3), "below", diagnostics, choice)
      if (choice == 1) stop%law%side = -1
    end if
    call read_entry_quantity(card, "limit", nature%value, system, known_keys, diagnostics, &
      stop%law%rest, fine)
    call read_entry_quantity(card, "stiffness", nature%stiffness, system, known_keys, diagnostics, &
      stop%law%stiffness, fine)
    if (fine) call require_positive(card, "stiffness", stop%law%stiffness, diagnostics)
    call read_contact(card, nature, system, diagnostics, stop%law)
  end subroutine read_stop

  !> Reads the `contact_keys` of what acts on one side of a limit. Errors: unreadable values, a
  !! negative damping, a width that is not positive.
  pure subroutine read_contact(card, nature, system, diagnostics, law)
    type(card_t), intent(in) :: card                  !! of any kind
    type(nature_t), intent(in) :: nature              !! of the coordinate
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(pull_law_t), intent(inout) :: law            !! has its side and stiffness

    logical :: fine

    call read_entry_quantity(card, "damping", nature%damping, system, .false., diagnostics, &
      law%damping, fine)
    if (fine) call refuse_negative(value_of(card, "damping"), law%damping, "the damping", &
      diagnostics)
    call read_entry_quantity(card, "contact", nature%value, system, .false., diagnostics, &
      law%contact, fine)
    if (.not. fine) return
    call require_positive(card, "contact", law%contact, diagnostics)
    ! It is not missing, too.
    if (law%contact <= 0.0_wp) law%contact = 1.0_wp
  end subroutine read_contact

end module stop_cards
