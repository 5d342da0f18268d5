!> LINK card: a beam with a material and a section, or a rigid body of any shape.
module link_cards
  use card_reader, only: check_form, entry_number, has_key, read_entry_quantity, read_name, &
    refuse_negative, require_positive, unit_apart
  use card_table, only: pattern_of
  use cards, only: card_t
  use diagnostics, only: add_error, diagnostics_t
  use kinds, only: wp
  use spelling, only: suggestion
  use text, only: same_word, word_list
  use tokens, only: token_t
  use units, only: dimension_inertia, dimension_length, dimension_mass, unit_system_t
  use value_lists, only: read_entry_pair
  implicit none (type, external)
  private

  public :: link_t, read_link, has_own_mass

  !> A link between two pins.
  type :: link_t
    type(token_t) :: name
    type(token_t) :: pin(2)           !! at its ends, in the order of the card; without a line if
                                      !! they cannot be read
    type(token_t) :: length_word      !! value of `length=`, or the keyword without one
    real(wp) :: length = 0.0_wp       !! [m]
    type(token_t) :: material_name    !! without a line if the card names none
    type(token_t) :: section_name     !! the same
    integer :: material = 0           !! number in the model's list; 0: none
    integer :: section = 0            !! the same
    integer :: mesh = 0               !! the same; 0 also for a rigid link
    integer :: damping = 0            !! number of its DAMPING card in the model's list; 0: none
    logical :: rigid = .false.        !! it does not bend
    type(token_t) :: rigid_word       !! without a line if the link bends
    logical :: has_mass = .false.     !! `mass=` replaces the mass of section and material
    logical :: has_inertia = .false.  !! `inertia=` is given
    logical :: has_center = .false.   !! `center=` is given
    real(wp) :: mass = 0.0_wp         !! [kg]
    real(wp) :: inertia = 0.0_wp      !! about its own mass centre [kg m²]
    real(wp) :: center(2) = 0.0_wp    !! mass centre, from the first pin of the card: along the
                                      !! link, and to the left of the direction to the second pin
                                      !! [m]
    type(token_t) :: body_word        !! the first key of `mass=`, `inertia=` and `center=`; without
                                      !! a line if the card has none of them
  end type link_t

contains

  !> Reads `LINK name pin pin [rigid] length= [material= section=] [mass= inertia=
  !! center=along,offset]`. Errors: words or keys that do not fit the card, invalid names, the same
  !! pin at both ends, a missing or unreadable value, a length of 0 or less, a negative mass or
  !! moment of inertia.
  pure subroutine read_link(card, system, diagnostics, link)
    type(card_t), intent(in) :: card                  !! the LINK card
    type(unit_system_t), intent(in) :: system         !! units of bare numbers
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(link_t), intent(out) :: link                 !! as read; material and section are not
                                                      !! looked up

    type(token_t) :: nowhere
    logical :: fine, known_keys

    call check_form(card, diagnostics, fine, known_keys)
    link%name = card%keyword
    nowhere = token_t("", 0, 0)
    link%pin(:) = nowhere
    link%material_name = nowhere
    link%section_name = nowhere
    link%rigid_word = nowhere
    link%body_word = nowhere
    link%length_word = card%keyword
    if (size(card%words) > 0) then
      link%name = card%words(1)
      call read_name(link%name, diagnostics)
    end if
    if (fine .and. size(card%words) == 4) call read_rigid(card%words(4), diagnostics, link, fine)
    if (fine) call read_pins(card%words(2:3), diagnostics, link)
    call read_entry_quantity(card, "length", dimension_length, system, known_keys, diagnostics, &
      link%length, fine)
    if (fine) then
      call require_positive(card, "length", link%length, diagnostics)
      link%length_word = card%entries(entry_number(card, "length"))%value
    end if
    if (entry_number(card, "material") > 0) link%material_name = card%entries(entry_number(card, &
      "material"))%value
    if (entry_number(card, "section") > 0) link%section_name = card%entries(entry_number(card, &
      "section"))%value
    call read_body(card, system, diagnostics, link)
  end subroutine read_link

  !> Reads the only word that may follow the pins.
  pure subroutine read_rigid(word, diagnostics, link, fine)
    type(token_t), intent(in) :: word
    type(diagnostics_t), intent(inout) :: diagnostics
    type(link_t), intent(inout) :: link
    logical, intent(out) :: fine

    fine = same_word(word%text, "rigid")
    if (fine) then
      link%rigid = .true.
      link%rigid_word = word
    else
      call add_error(diagnostics, word, "unexpected '"//word%text//"'"//suggestion(word%text, &
        word_list("rigid"))//unit_apart(word%text)//"; expected: "//pattern_of("LINK"))
    end if
  end subroutine read_rigid

  pure subroutine read_pins(words, diagnostics, link)
    type(token_t), intent(in) :: words(2)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(link_t), intent(inout) :: link

    link%pin = words
    call read_name(link%pin(1), diagnostics)
    call read_name(link%pin(2), diagnostics)
    if (.not. same_word(link%pin(1)%text, link%pin(2)%text)) return
    call add_error(diagnostics, link%pin(2), "link '"//link%name%text// &
      "' has the same pin at both ends")
    link%pin(:) = token_t("", 0, 0)
  end subroutine read_pins

  !> Reads the keys that make a link a rigid body of its own shape.
  pure subroutine read_body(card, system, diagnostics, link)
    type(card_t), intent(in) :: card
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(link_t), intent(inout) :: link

    logical :: fine
    integer :: i

    ! A key with a wrong value counts as given, so that nothing else is reported as missing.
    link%has_mass = has_key(card, "mass")
    link%has_inertia = has_key(card, "inertia")
    link%has_center = has_key(card, "center")
    call read_entry_quantity(card, "mass", dimension_mass, system, .false., diagnostics, &
      link%mass, fine)
    if (fine) call refuse_negative(card%entries(entry_number(card, "mass"))%value, link%mass, &
      "a mass", diagnostics)
    call read_entry_quantity(card, "inertia", dimension_inertia, system, .false., diagnostics, &
      link%inertia, fine)
    if (fine) then
      call refuse_negative(card%entries(entry_number(card, "inertia"))%value, link%inertia, &
        "a moment of inertia", diagnostics)
    end if
    call read_entry_pair(card, "center", "along,offset", dimension_length, system, diagnostics, &
      link%center, fine)
    do i = size(card%entries), 1, -1
      associate (key => card%entries(i)%key)
        if (same_word(key%text, "mass") .or. same_word(key%text, "inertia") .or. &
          same_word(key%text, "center")) link%body_word = key
      end associate
    end do

  end subroutine read_body

  !> Whether the card gives a link its mass, moment of inertia or mass centre.
  elemental function has_own_mass(link) result(has)
    type(link_t), intent(in) :: link !! of the deck
    logical :: has

    has = link%has_mass .or. link%has_inertia .or. link%has_center
  end function has_own_mass

end module link_cards
