!> GROUND, PINMASS and MESH cards: fixed pivots, masses at pins, division of links into elements.
!! Names are looked up later, by `name_checks`.
module linkage_cards
  use card_reader, only: check_form, has_key, read_entry_accuracy, read_entry_count, &
    read_part_name, read_quantity, refuse_negative, value_of
  use cards, only: card_t
  use diagnostics, only: add_error, diagnostics_t
  use kinds, only: fineness, wp
  use text, only: same_word, to_string
  use tokens, only: token_t
  use units, only: dimension_length, dimension_mass, unit_system_t
  implicit none (type, external)
  private

  public :: ground_t, pin_mass_t, mesh_t
  public :: read_ground, read_pin_mass, read_mesh, set_default_mesh, default_accuracy

  !> A fixed pivot.
  type :: ground_t
    type(token_t) :: pin             !! without a line if the card lacks it
    real(wp) :: position(2) = 0.0_wp !! in global axes [m]
  end type ground_t

  !> A concentrated mass at a pin.
  type :: pin_mass_t
    type(token_t) :: pin      !! without a line if the card lacks it
    real(wp) :: mass = 0.0_wp !! [kg]
  end type pin_mass_t

  !> The order of the cubic beam element: deflection cubic, axial displacement linear.
  integer, parameter :: cubic_order = 3

  !> Number of elements per link, or required accuracy of the frequencies; both are 0 if the card
  !! cannot be read.
  type :: mesh_t
    type(token_t) :: keyword              !! without a line if the deck has no MESH card
    type(token_t), allocatable :: link_names(:) !! `*` for all others
    integer :: elements = 0               !! on each link; 1 where the program chooses
    integer :: order = cubic_order        !! polynomial order of the elements
    real(wp) :: accuracy = 0.0_wp         !! relative, of the frequencies; 0: not given
    type(token_t) :: accuracy_word        !! without a line if it is not given
  end type mesh_t

  integer, parameter :: highest_order = 100

  !> Round-off rules out far fewer cubic elements than this; the limit only keeps sums and memory
  !! within reason.
  integer, parameter :: most_elements = 1000000

  real(wp), parameter :: finest_accuracy = 1.0e-13_wp*fineness, coarsest_accuracy = 1.0e-2_wp, &
    default_accuracy = 1.0e-8_wp

contains

  !> Reads `GROUND name x y`. Errors: words or keys that do not fit the card, an invalid name,
  !! unreadable coordinates.
  pure subroutine read_ground(card, system, diagnostics, ground)
    type(card_t), intent(in) :: card                  !! the GROUND card
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(ground_t), intent(out) :: ground             !! as read

    logical :: fine

    ground%pin = token_t("", 0, 0)
    call check_form(card, diagnostics, fine)
    if (size(card%words) > 0) then
      ground%pin = card%words(1)
      call read_part_name(ground%pin, diagnostics)
    end if
    if (.not. fine) return
    call read_quantity(card%words(2), dimension_length, system, diagnostics, ground%position(1), &
      fine)
    call read_quantity(card%words(3), dimension_length, system, diagnostics, ground%position(2), &
      fine)
  end subroutine read_ground

  !> Reads `PINMASS pin mass`. Errors: words or keys that do not fit the card, an unreadable or
  !! negative mass.
  pure subroutine read_pin_mass(card, system, diagnostics, pin_mass)
    type(card_t), intent(in) :: card                  !! the PINMASS card
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(pin_mass_t), intent(out) :: pin_mass         !! as read; the pin is not looked up

    logical :: fine

    pin_mass%pin = token_t("", 0, 0)
    call check_form(card, diagnostics, fine)
    if (size(card%words) > 0) pin_mass%pin = card%words(1)
    if (.not. fine) return
    call read_quantity(card%words(2), dimension_mass, system, diagnostics, pin_mass%mass, fine)
    call refuse_negative(card%words(2), pin_mass%mass, "a mass", diagnostics)
  end subroutine read_pin_mass

  !> Reads `MESH link … elements= [order=3]` or `MESH link … accuracy=`; `*` stands for every link
  !! without a card of its own. Errors: words or keys that do not fit the card, neither `elements=`
  !! nor `accuracy=`, `accuracy=` beside one of the others, values that are unreadable or out of
  !! range.
  pure subroutine read_mesh(card, system, diagnostics, mesh)
    type(card_t), intent(in) :: card                  !! the MESH card
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(mesh_t), intent(out) :: mesh                 !! as read; the links are not looked up

    logical :: fine, known_keys

    call check_form(card, diagnostics, fine, known_keys)
    mesh%keyword = card%keyword
    mesh%link_names = card%words
    mesh%accuracy_word = token_t("", 0, 0)
    if (has_key(card, "accuracy")) then
      call read_accuracy(card, system, diagnostics, mesh)
    else
      call read_elements(card, known_keys, diagnostics, mesh)
    end if
  end subroutine read_mesh

  !> Reads `elements=` and `order=`.
  pure subroutine read_elements(card, known_keys, diagnostics, mesh)
    type(card_t), intent(in) :: card
    logical, intent(in) :: known_keys !! no key is unknown: missing ones are an error
    type(diagnostics_t), intent(inout) :: diagnostics
    type(mesh_t), intent(inout) :: mesh

    integer :: elements, order, most
    logical :: counted, ordered

    if (known_keys .and. .not. has_key(card, "elements")) then
      call add_error(diagnostics, card%keyword, &
        "'elements=' or 'accuracy=' is missing; expected a whole number of elements, "// &
        "or the relative accuracy of the frequencies")
    end if
    call read_entry_count(card, "elements", 1, diagnostics, elements, counted)
    call read_entry_count(card, "order", cubic_order, diagnostics, order, ordered)
    if (ordered .and. order > highest_order) then
      call add_error(diagnostics, value_of(card, "order"), &
        "'order=' must be at most "//to_string(highest_order)//", not "//to_string(order))
    else if (ordered) then
      mesh%order = order
    end if
    if (.not. counted) return
    ! The same limit on unknowns as for cubic elements.
    most = cubic_order*most_elements/mesh%order
    if (elements <= most) then
      mesh%elements = elements
    else if (mesh%order == cubic_order) then
      call add_error(diagnostics, value_of(card, "elements"), &
        "'elements=' must be at most "//to_string(most))
    else
      call add_error(diagnostics, value_of(card, "elements"), &
        "'elements=' must be at most "//to_string(most)//" of order "//to_string(mesh%order))
    end if
  end subroutine read_elements

  !> Reads `accuracy=`, which replaces `elements=` and `order=`.
  pure subroutine read_accuracy(card, system, diagnostics, mesh)
    type(card_t), intent(in) :: card
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(mesh_t), intent(inout) :: mesh

    real(wp) :: accuracy
    logical :: fine
    integer :: i

    do i = 1, size(card%entries)
      if (.not. (same_word(card%entries(i)%key%text, "elements") .or. &
        same_word(card%entries(i)%key%text, "order"))) cycle
      call add_error(diagnostics, card%entries(i)%key, "'"//card%entries(i)%key%text// &
        "=' has no meaning beside 'accuracy=', "// &
        "which leaves elements and their order to the program")
      return
    end do
    call read_entry_accuracy(card, finest_accuracy, coarsest_accuracy, system, diagnostics, &
      accuracy, fine)
    if (.not. fine) return
    mesh%accuracy = accuracy
    mesh%accuracy_word = value_of(card, "accuracy")
    mesh%elements = 1
  end subroutine read_accuracy

  !> The mesh of a deck without MESH card: all links, relative accuracy 1e-8.
  pure subroutine set_default_mesh(mesh)
    type(mesh_t), intent(out) :: mesh !! its words have no line

    type(token_t) :: nowhere

    nowhere = token_t("", 0, 0)
    mesh%keyword = nowhere
    mesh%accuracy_word = nowhere
    allocate (mesh%link_names(1))
    mesh%link_names(1) = token_t("*", 0, 0)
    mesh%accuracy = default_accuracy
    mesh%elements = 1
  end subroutine set_default_mesh

end module linkage_cards
