! src/model/cards/ - readers of the cards that describe a linkage, its loads and drives.
! In: a `card_t`, the units of bare numbers. Out: a record in SI, messages in `diagnostics_t`. Begin
! with `read_link` here; other readers are like it, and `src/model/model_reader.f90` calls them.
! Not here: looking up names that cards use (`src/model/checks`), cards of requests
! (`src/model/requests`).

!> LINK card: a beam with a material and a section, or a rigid body of any shape.
module link_cards
  use card_reader, only: check_form, has_key, has_value, key_of, read_entry_quantity, &
    read_part_name, read_quantity, refuse_negative, require_positive, unit_apart, value_of
  use card_table, only: pattern_of
  use cards, only: card_t
  use diagnostics, only: add_error, diagnostics_t, error_count
  use kinds, only: wp
  use name_index, only: find_name, name_index_t, new_name_index
  use spelling, only: suggestion
  use text, only: plural, same_word, to_string, word_list
  use tokens, only: is_before, token_t, token_texts
  use units, only: dimension_angle, dimension_inertia, dimension_length, dimension_mass, &
    unit_system_t
  use value_lists, only: find_items, read_entry_pair
  implicit none (type, external)
  private

  public :: link_t, read_link, has_own_mass, segment_count

  !> A link between pins: straight from each to the next.
  type :: link_t
    type(token_t) :: name
    type(token_t), allocatable :: pins(:) !! in the order of the card, each once; none if they
                                      !! cannot be read
    logical :: is_closed = .false.    !! a last segment leads back from the last pin to the first
    type(token_t) :: length_word      !! value of `length=` or `lengths=`, or the keyword without
    real(wp) :: length = 0.0_wp       !! of all segments together; without `length=` or `lengths=`
                                      !! that of the drawing, set after all cards are read [m]
    logical :: has_length = .false.   !! `length=` is given
    logical :: has_lengths = .false.  !! `lengths=` is given
    logical :: lacks_lengths = .false. !! neither is, and no key that may be one of them misspelt
    real(wp), allocatable :: lengths(:) !! (segments) value of `lengths=`; none without it [m]
    real(wp), allocatable :: turns(:) !! turn to the left from a segment to the next, at the second
                                      !! pin, the third, …; none without `turns=` [rad]
    type(token_t) :: turns_word       !! value of `turns=`; without a line if there is none
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

  !> Reads `LINK name pin pin … [rigid] [length= | lengths= turns=] [material= section=] [mass=
  !! inertia= center=along,offset]`. Errors: words or keys that do not fit the card, invalid names,
  !! a pin twice (but for the first as the last of three or more others), an unreadable value, a
  !! length of 0 or less, as many lengths or turns as do not fit the pins, a negative mass or moment
  !! of inertia. Whether the shape is given at all is left to `link_checks`.
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
    allocate (link%pins(0), link%lengths(0), link%turns(0))
    link%material_name = nowhere
    link%section_name = nowhere
    link%rigid_word = nowhere
    link%body_word = nowhere
    link%turns_word = nowhere
    link%length_word = card%keyword
    if (size(card%words) > 0) then
      link%name = card%words(1)
      call read_part_name(link%name, diagnostics)
    end if
    if (fine) call read_pins(card, diagnostics, link)
    link%has_length = has_key(card, "length")
    link%has_lengths = has_key(card, "lengths")
    link%lacks_lengths = known_keys .and. .not. (link%has_length .or. link%has_lengths)
    call read_length(card, system, diagnostics, link)
    call read_lengths(card, system, diagnostics, link)
    call read_turns(card, system, diagnostics, link)
    if (has_value(card, "material")) link%material_name = value_of(card, "material")
    if (has_value(card, "section")) link%section_name = value_of(card, "section")
    call read_body(card, system, diagnostics, link)
  end subroutine read_link

  !> Reads the pins and the word that may follow them. Errors: a word behind the first key, or one
  !! like `rigid`.
  pure subroutine read_pins(card, diagnostics, link)
    type(card_t), intent(in) :: card !! with three words at least
    type(diagnostics_t), intent(inout) :: diagnostics
    type(link_t), intent(inout) :: link

    integer :: last, i

    last = size(card%words)
    associate (word => card%words(last))
      if (same_word(word%text, "rigid")) then
        link%rigid = .true.
        link%rigid_word = word
        last = last - 1
      else if (last > 3 .and. len(suggestion(word%text, word_list("rigid"))) > 0) then
        call refuse_word(word, suggestion(word%text, word_list("rigid")), diagnostics)
        return
      end if
    end associate
    if (last < 3) then
      call add_error(diagnostics, card%keyword, "this card is too short; expected: "// &
        pattern_of("LINK"))
      return
    end if
    do i = 4, last
      ! A unit behind its number, or a second value, is no pin.
      if (.not. is_behind_key(card, card%words(i))) cycle
      call refuse_word(card%words(i), "", diagnostics)
      return
    end do
    call take_pins(card%words(2:last), diagnostics, link)
  end subroutine read_pins

  pure subroutine refuse_word(word, hint, diagnostics)
    type(token_t), intent(in) :: word
    character(len=*), intent(in) :: hint
    type(diagnostics_t), intent(inout) :: diagnostics

    call add_error(diagnostics, word, "unexpected '"//word%text//"'"//hint// &
      unit_apart(word%text)//"; expected: "//pattern_of("LINK"))
  end subroutine refuse_word

  !> Whether a word stands behind the first key of its card.
  pure function is_behind_key(card, word) result(is)
    type(card_t), intent(in) :: card
    type(token_t), intent(in) :: word !! of the card
    logical :: is

    is = .false.
    if (size(card%entries) > 0) is = is_before(card%entries(1)%key, word)
  end function is_behind_key

  !> Takes words as pins. Errors: a pin twice, but for the first one as the last of a closed link.
  pure subroutine take_pins(words, diagnostics, link)
    type(token_t), intent(in) :: words(:) !! two at least
    type(diagnostics_t), intent(inout) :: diagnostics
    type(link_t), intent(inout) :: link

    type(name_index_t) :: names
    integer :: pins, i, first, errors

    pins = size(words)
    errors = error_count(diagnostics)
    do i = 1, pins
      call read_part_name(words(i), diagnostics)
    end do
    ! What is no name may be no pin either: lengths are not counted against it.
    if (error_count(diagnostics) > errors) return
    if (same_word(words(1)%text, words(pins)%text)) then
      if (pins <= 3) then
        call add_error(diagnostics, words(pins), "link '"//link%name%text// &
          "' has the same pin at both ends")
        return
      end if
      link%is_closed = .true.
      pins = pins - 1
    end if
    names = new_name_index(token_texts(words(:pins)))
    do i = 2, pins
      first = find_name(names, words(i)%text)
      if (first == i) cycle
      call add_error(diagnostics, words(i), "link '"//link%name%text//"' has pin '"// &
        words(i)%text//"' twice", words(first), "first named here")
      link%is_closed = .false.
      return
    end do
    link%pins = words(:pins)
  end subroutine take_pins

  !> How many straight segments a link has.
  pure function segment_count(link) result(segments)
    type(link_t), intent(in) :: link !! whose pins are read
    integer :: segments

    segments = size(link%pins) - merge(0, 1, link%is_closed)
  end function segment_count

  !> Reads `length=`.
  pure subroutine read_length(card, system, diagnostics, link)
    type(card_t), intent(in) :: card
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(link_t), intent(inout) :: link

    logical :: fine

    call read_entry_quantity(card, "length", dimension_length, system, .false., diagnostics, &
      link%length, fine)
    if (.not. fine) return
    call require_positive(card, "length", link%length, diagnostics)
    link%length_word = value_of(card, "length")
    if (size(link%pins) > 2) then
      call add_error(diagnostics, link%length_word, "'length=' is for two pins, and link '"// &
        link%name%text//"' has "//to_string(size(link%pins))//"; expected 'lengths=' and "// &
        "'turns=', or PIN cards")
    else if (link%has_lengths) then
      call add_error(diagnostics, key_of(card, "length"), &
        "'length=' has no meaning beside 'lengths='")
    end if
  end subroutine read_length

  !> Reads `lengths=`, one for every segment.
  pure subroutine read_lengths(card, system, diagnostics, link)
    type(card_t), intent(in) :: card
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(link_t), intent(inout) :: link

    type(token_t), allocatable :: words(:)
    real(wp), allocatable :: lengths(:)
    integer :: i
    logical :: fine

    call read_list(card, "lengths", dimension_length, system, diagnostics, words, lengths, fine)
    if (.not. fine) return
    do i = 1, size(words)
      if (lengths(i) > 0.0_wp) cycle
      call add_error(diagnostics, words(i), "'lengths=' must be greater than 0, not "// &
        words(i)%text)
      return
    end do
    link%length_word = value_of(card, "lengths")
    if (size(link%pins) == 0) return
    if (size(link%pins) == 2) then
      ! Beside 'length=' that has been said.
      if (.not. has_key(card, "length")) call add_error(diagnostics, key_of(card, "lengths"), &
        "link '"//link%name%text//"' has two pins: expected 'length='")
    else if (size(words) /= segment_count(link)) then
      call add_error(diagnostics, words(min(size(words), segment_count(link) + 1)), &
        "link '"//link%name%text//"' has "//to_string(segment_count(link))//" segments from "// &
        "pin to pin, and 'lengths=' has "//plural(size(words), "value"))
    else
      link%lengths = lengths
      link%length = sum(lengths)
    end if
  end subroutine read_lengths

  !> Reads `turns=`: one at every pin between two segments that follow each other on the card. Of a
  !! closed link the last one follows from the others and may be left out.
  pure subroutine read_turns(card, system, diagnostics, link)
    type(card_t), intent(in) :: card
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(link_t), intent(inout) :: link

    type(token_t), allocatable :: words(:)
    real(wp), allocatable :: turns(:)
    integer :: expected
    logical :: fine

    call read_list(card, "turns", dimension_angle, system, diagnostics, words, turns, fine)
    if (.not. fine) return
    link%turns_word = value_of(card, "turns")
    if (size(link%pins) == 0) return
    expected = segment_count(link) - 1
    if (size(link%pins) == 2 .or. .not. link%has_lengths) then
      call add_error(diagnostics, key_of(card, "turns"), &
        "'turns=' stands beside 'lengths=' of a link with three pins or more")
    else if (size(words) /= expected .and. .not. (link%is_closed .and. size(words) == expected - &
      1)) then
      call add_error(diagnostics, words(min(size(words), expected + 1)), "link '"// &
        link%name%text//"' turns at "//plural(expected, "pin")//" between its segments, and "// &
        "'turns=' has "//plural(size(words), "value"))
    else
      link%turns = turns
    end if
  end subroutine read_turns

  !> Reads the values of a key in SI.
  pure subroutine read_list(card, key, dimension, system, diagnostics, words, values, fine)
    type(card_t), intent(in) :: card
    character(len=*), intent(in) :: key
    integer, intent(in) :: dimension(4)
    type(unit_system_t), intent(in) :: system
    type(diagnostics_t), intent(inout) :: diagnostics
    type(token_t), allocatable, intent(out) :: words(:) !! (values)
    real(wp), allocatable, intent(out) :: values(:)     !! (values)
    logical, intent(out) :: fine !! the key is given, and all values are right

    integer :: i
    logical :: is_right

    fine = has_value(card, key)
    if (.not. fine) return
    call find_items(card, key, diagnostics, words, fine)
    if (.not. fine) return
    allocate (values(size(words)))
    do i = 1, size(words)
      call read_quantity(words(i), dimension, system, diagnostics, values(i), is_right)
      fine = fine .and. is_right
    end do
  end subroutine read_list

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
    if (fine) call refuse_negative(value_of(card, "mass"), link%mass, "a mass", diagnostics)
    call read_entry_quantity(card, "inertia", dimension_inertia, system, .false., diagnostics, &
      link%inertia, fine)
    if (fine) then
      call refuse_negative(value_of(card, "inertia"), link%inertia, &
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
