! src/model/checks/ - cards against each other: names, shapes of links, drives, springs, laws.
! In: a `model_t` with its cards read. Out: messages, and numbers of other cards in place of names.
! Begin with `check_names` here, then follow the calls of `read_model` in
! `src/model/model_reader.f90`.
! Not here: a card by itself (`src/model/cards`), requests (`src/model/requests`), checks by
! mechanics (`src/runs/checks`).

!> Names across cards: duplicate definitions, and references from card to card.
module name_checks
  use card_table, only: pattern_of
  use diagnostics, only: add_error, add_warning, diagnostics_t
  use errors, only: error_of_input, error_of_writing
  use link_cards, only: link_t
  use models, only: is_end_of_measure, is_four_bar, model_t
  use name_index, only: find_name, name_index_t, new_name_index
  use process_cards, only: process_resistance
  use spelling, only: suggestion
  use text, only: append_string, same_word, string_t, upper_case
  use tokens, only: token_t, token_texts
  implicit none (type, external)
  private

  public :: check_names, look_up, kind_of_unknown, link_ends, pin_names, looks_misspelt

  !> More than the number of report kinds: limits the comparisons in a deck of very many cards.
  integer, parameter :: most_reports = 100

contains

  !> Checks names, and gives each link its material, section and mesh. Errors: a name defined twice,
  !! an unknown material, section, link or pin, two meshes for a link or one for a rigid link, a
  !! moving pin at one link only that looks misspelt, an unused ground pivot. Warning: a mass at a
  !! ground pivot.
  subroutine check_names(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics !! errors and warnings are added
    type(model_t), intent(inout) :: model             !! material, section and mesh numbers of its
                                                      !! links are set

    call refuse_same_names(diagnostics, model)
    call find_materials_and_sections(diagnostics, model)
    call find_meshes(diagnostics, model)
    call check_pins(diagnostics, model)
    call check_pin_masses(diagnostics, model)
  end subroutine check_names

  !> Refuses two parts of one kind with the same name, two masses or forces at one pin, two torques
  !! or loads on one link, two reports of one kind.
  subroutine refuse_same_names(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    integer :: i, j

    call refuse_same(model%materials%name, "material")
    call refuse_same(model%sections%name, "section")
    call refuse_same(model%grounds%pin, "ground pivot")
    call refuse_same(model%drawn_pins%pin, "place of pin")
    call refuse_same(model%links%name, "link")
    call refuse_same(model%guides%name, "guide")
    call refuse_same(model%branches%pin, "branch of pin")
    call refuse_same(model%pin_masses%pin, "mass at pin")
    call refuse_same(model%points%name, "point")
    call refuse_same(model%gauges%name, "gauge")
    call refuse_same(model%forces%pin, "force at pin")
    call refuse_same(model%torques%link_name, "torque on link")
    call refuse_same(subjects_of(model, .true.), "load on")
    call refuse_same(model%springs%name, "spring or damper")
    call refuse_same(model%measures%name, "measure")
    call refuse_same(model%stops%name, "stop")
    do i = 2, size(model%reports)
      do j = 1, min(i - 1, most_reports)
        if (len_trim(model%reports(i)%kind%name) == 0 .or. &
          model%reports(i)%kind%name /= model%reports(j)%kind%name) cycle
        call add_error(diagnostics, model%reports(i)%keyword, "this report is asked for twice", &
          model%reports(j)%keyword, "first asked for here")
        exit
      end do
    end do

  contains

    subroutine refuse_same(names, noun)
      type(token_t), intent(in) :: names(:)
      character(len=*), intent(in) :: noun

      type(name_index_t) :: list
      integer :: n, first

      list = new_name_index(token_texts(names))
      do n = 1, size(names)
        first = find_name(list, names(n)%text)
        if (first == n .or. names(n)%line == 0) cycle
        call add_error(diagnostics, names(n), "a second "//noun//" '"//names(n)%text//"'", &
          names(first), "first defined here")
      end do
    end subroutine refuse_same

  end subroutine refuse_same_names

  !> Looks up the materials and sections on LINK cards.
  pure subroutine find_materials_and_sections(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(inout) :: model

    call find_parts(model%links%material_name, new_name_index(token_texts(model%materials%name)), &
      "material", diagnostics, model%links%material)
    call find_parts(model%links%section_name, new_name_index(token_texts(model%sections%name)), &
      "section", diagnostics, model%links%section)
  end subroutine find_materials_and_sections

  !> Looks up what links are made of. Where the deck has no such card at all, this is said once.
  pure subroutine find_parts(words, list, noun, diagnostics, numbers)
    type(token_t), intent(in) :: words(:)   !! (links) without a line where the link has none
    type(name_index_t), intent(in) :: list  !! of the cards
    character(len=*), intent(in) :: noun    !! material or section
    type(diagnostics_t), intent(inout) :: diagnostics
    integer, intent(inout) :: numbers(:)    !! (links) unchanged without a word

    character(len=:), allocatable :: library
    integer :: i, first

    first = findloc(words%line > 0, .true., dim=1)
    if (size(list%name) == 0 .and. first > 0) then
      library = ""
      if (noun == "material") library = ", or INCLUDE library/materials.inc, which has steel"
      call add_error(diagnostics, words(first), "there is no "//upper_case(noun)//" card for '"// &
        words(first)%text//"'; expected: "//pattern_of(upper_case(noun))//library)
      return
    end if
    do i = 1, size(words)
      if (words(i)%line > 0) call look_up(words(i), list, noun, diagnostics, numbers(i))
    end do
  end subroutine find_parts

  !> Gives every link its mesh: a card that names the link takes precedence over `MESH *`.
  pure subroutine find_meshes(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(inout) :: model

    type(name_index_t) :: links
    type(token_t) :: place(0:size(model%links))
    integer :: i, k, link, for_all, misnamed

    links = new_name_index(token_texts(model%links%name))
    for_all = 0
    misnamed = 0
    do i = 1, size(model%meshes)
      do k = 1, size(model%meshes(i)%link_names)
        associate (word => model%meshes(i)%link_names(k))
          link = 0
          if (word%text /= "*") call look_up(word, links, "link", diagnostics, link)
          if (word%text /= "*" .and. link == 0) then
            ! Some link is meant: it is not reported to lack a mesh as well.
            misnamed = i
            cycle
          end if
          if (place(link)%line > 0) then
            call add_error(diagnostics, word, "a second mesh for '"//word%text//"'", place(link), &
              "the first is here")
            cycle
          end if
          place(link) = word
          if (link > 0) then
            model%links(link)%mesh = i
            if (model%links(link)%rigid) call add_error(diagnostics, word, "link '"//word%text// &
              "' is rigid: it has no elements", model%links(link)%rigid_word, &
              "it is rigid by this word")
          end if
          if (link == 0) for_all = i
        end associate
      end do
    end do
    where (model%links%mesh == 0 .and. .not. model%links%rigid) model%links%mesh = merge(for_all, &
      misnamed, for_all > 0)
  end subroutine find_meshes

  !> Finds a name in a list. Errors: it is not in the list; the message suggests the nearest.
  pure subroutine look_up(word, list, noun, diagnostics, number)
    type(token_t), intent(in) :: word                 !! the name, in the deck
    type(name_index_t), intent(in) :: list            !! to search
    character(len=*), intent(in) :: noun              !! kind of name, for the message: `link`
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    integer, intent(out) :: number                    !! in the list, from 1; 0: unknown

    number = find_name(list, word%text)
    if (number == 0) call add_error(diagnostics, word, "unknown "//noun//" '"//word%text//"'"// &
      suggestion(word%text, list%name), kind=kind_of_unknown(word%text))
  end subroutine look_up

  !> Kind of the error that a name is unknown: so it is whatever varies, unless it begins like a
  !! number, as a value of VARY that names something does.
  pure function kind_of_unknown(name) result(kind)
    character(len=*), intent(in) :: name
    integer :: kind

    kind = error_of_writing
    if (scan(name, "0123456789.+-") == 1) kind = error_of_input
  end function kind_of_unknown

  !> Every moving pin of a four-bar joins at least two links; of another linkage it may be an end,
  !! unless it looks like a misspelt one. Every ground pivot carries a link or a block.
  pure subroutine check_pins(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    type(name_index_t) :: grounds, ends, named, blocks, springs(2)
    character(len=:), allocatable :: hint
    integer, allocatable :: uses(:)
    integer :: i, k, first
    logical :: four_bar

    ! An unreadable card would make the pins on it look unused.
    if (any(model%grounds%pin%line == 0) .or. any(model%sliders%pin%line == 0)) return
    do i = 1, size(model%links)
      if (size(model%links(i)%pins) == 0) return
    end do
    four_bar = is_four_bar(model)
    grounds = new_name_index(token_texts(model%grounds%pin))
    ends = new_name_index(token_texts(link_ends(model%links)))
    named = new_name_index(names_on_other_cards(model))
    blocks = new_name_index(token_texts(model%sliders%pin))
    springs(1) = new_name_index(token_texts(model%springs%ends(1)))
    springs(2) = new_name_index(token_texts(model%springs%ends(2)))
    allocate (uses(size(ends%name)))
    uses = 0
    do i = 1, size(uses)
      first = find_name(ends, ends%name(i)%text)
      uses(first) = uses(first) + 1
    end do
    k = 0
    do i = 1, size(model%links)
      do first = 1, size(model%links(i)%pins)
        k = k + 1
        associate (pin => model%links(i)%pins(first))
          if (uses(k) /= 1 .or. find_name(grounds, pin%text) > 0) cycle
          if (.not. four_bar .and. find_name(named, pin%text) > 0) cycle
          hint = suggestion(pin%text, other_names(ends, grounds, pin%text, .not. four_bar))
          if (.not. four_bar .and. len(hint) == 0) cycle
          call add_error(diagnostics, pin, "pin '"//pin%text// &
            "' is used once only; a moving pin joins two links"//hint)
        end associate
      end do
    end do
    do i = 1, size(model%grounds)
      if (find_name(ends, model%grounds(i)%pin%text) > 0) cycle
      if (find_name(blocks, model%grounds(i)%pin%text) > 0) cycle
      if (find_name(springs(1), model%grounds(i)%pin%text) > 0) cycle
      if (find_name(springs(2), model%grounds(i)%pin%text) > 0) cycle
      if (is_end_of_measure(model, model%grounds(i)%pin%text)) cycle
      call add_error(diagnostics, model%grounds(i)%pin, "no link uses the ground pivot '"// &
        model%grounds(i)%pin%text//"'")
    end do
  end subroutine check_pins

  !> Whether a pin that no card but LINK names is much like another one.
  pure function looks_misspelt(model, pin) result(looks)
    type(model_t), intent(in) :: model  !! as read
    character(len=*), intent(in) :: pin
    logical :: looks

    looks = find_name(new_name_index(names_on_other_cards(model)), pin) == 0
    if (looks) looks = len(suggestion(pin, other_names(new_name_index(token_texts(link_ends( &
      model%links))), new_name_index(token_texts(model%grounds%pin)), pin, .true.))) > 0
  end function looks_misspelt

  !> The pins of all links, one link after the other.
  pure function link_ends(links) result(pins)
    type(link_t), intent(in) :: links(:) !! (links)
    type(token_t), allocatable :: pins(:)

    integer :: i, k, filled

    filled = 0
    do i = 1, size(links)
      filled = filled + size(links(i)%pins)
    end do
    allocate (pins(filled))
    filled = 0
    do i = 1, size(links)
      do k = 1, size(links(i)%pins)
        filled = filled + 1
        pins(filled) = links(i)%pins(k)
      end do
    end do
  end function link_ends

  !> All that a card may take for a pin: the pins of links, then the POINTs.
  pure function pin_names(model) result(pins)
    type(model_t), intent(in) :: model !! as read
    type(token_t), allocatable :: pins(:)

    type(token_t), allocatable :: ends(:)
    integer :: i

    ends = link_ends(model%links)
    allocate (pins(size(ends) + size(model%points)))
    do i = 1, size(ends)
      pins(i) = ends(i)
    end do
    do i = 1, size(model%points)
      pins(size(ends) + i) = model%points(i)%name
    end do
  end function pin_names

  !> The names on LOAD cards, or the pins on FORCE and LOAD cards of processes.
  pure function subjects_of(model, loads) result(subjects)
    type(model_t), intent(in) :: model
    logical, intent(in) :: loads !! else the pins
    type(token_t), allocatable :: subjects(:)

    logical :: is_one(size(model%processes))
    integer :: i, filled

    is_one = .not. model%processes%on_link
    if (loads) is_one = model%processes%kind == process_resistance
    allocate (subjects(count(is_one)))
    filled = 0
    do i = 1, size(model%processes)
      if (.not. is_one(i)) cycle
      filled = filled + 1
      subjects(filled) = model%processes(i)%subject
    end do
  end function subjects_of

  !> The pins that cards other than LINK name: who writes such a card knows the pin.
  pure function names_on_other_cards(model) result(names)
    type(model_t), intent(in) :: model
    type(string_t), allocatable :: names(:)

    integer :: filled

    filled = size(model%drawn_pins) + size(model%points) + size(model%pin_masses) + &
      size(model%forces) + count(.not. model%processes%on_link) + size(model%sliders) + &
      size(model%welds) + size(model%drives) + 3*size(model%branches)
    allocate (names(filled))
    filled = 0
    call append_texts(model%drawn_pins%pin, filled, names)
    call append_texts(model%points%name, filled, names)
    call append_texts(model%pin_masses%pin, filled, names)
    call append_texts(model%forces%pin, filled, names)
    call append_texts(subjects_of(model, .false.), filled, names)
    call append_texts(model%sliders%pin, filled, names)
    call append_texts(model%welds%pin, filled, names)
    call append_texts(model%drives%subject, filled, names)
    call append_texts(model%branches%pin, filled, names)
    call append_texts(model%branches%from, filled, names)
    call append_texts(model%branches%to, filled, names)
  end function names_on_other_cards

  !> Appends the texts of words.
  pure subroutine append_texts(words, filled, names)
    type(token_t), intent(in) :: words(:)
    integer, intent(inout) :: filled !! names so far
    type(string_t), intent(inout) :: names(:)

    integer :: n

    do n = 1, size(words)
      filled = filled + 1
      names(filled)%text = words(n)%text
    end do
  end subroutine append_texts

  !> Names that a misspelt pin may stand for: all pins and ground pivots but itself. Empty for a
  !! deck with more than 100 of both.
  pure function other_names(ends, grounds, name, numbered) result(list)
    type(name_index_t), intent(in) :: ends, grounds
    character(len=*), intent(in) :: name
    logical, intent(in) :: numbered !! names that differ in digits only, P4 and P5, are different on
                                    !! purpose
    type(string_t), allocatable :: list(:)

    integer, parameter :: most_names = 100
    integer :: n

    allocate (list(0))
    if (size(ends%name) + size(grounds%name) > most_names) return
    do n = 1, size(ends%name)
      if (same_word(ends%name(n)%text, name)) cycle
      if (numbered .and. differ_in_digits(ends%name(n)%text, name)) cycle
      call append_string(list, ends%name(n)%text)
    end do
    do n = 1, size(grounds%name)
      if (numbered .and. differ_in_digits(grounds%name(n)%text, name)) cycle
      call append_string(list, grounds%name(n)%text)
    end do
  end function other_names

  !> Whether two names are the same but for digits.
  pure function differ_in_digits(a, b) result(differ)
    character(len=*), intent(in) :: a, b
    logical :: differ

    character(len=*), parameter :: digits = "0123456789"
    integer :: i

    differ = len(a) == len(b)
    do i = 1, min(len(a), len(b))
      differ = differ .and. (same_word(a(i:i), b(i:i)) .or. &
        (index(digits, a(i:i)) > 0 .and. index(digits, b(i:i)) > 0))
    end do
  end function differ_in_digits

  !> Pin masses must sit at moving pins; at a ground pivot they only cause a warning.
  pure subroutine check_pin_masses(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    type(name_index_t) :: pins, grounds
    integer :: i, number

    pins = new_name_index(token_texts(pin_names(model)))
    grounds = new_name_index(token_texts(model%grounds%pin))
    do i = 1, size(model%pin_masses)
      associate (pin => model%pin_masses(i)%pin)
        if (pin%line == 0) cycle
        if (find_name(grounds, pin%text) > 0) then
          call add_warning(diagnostics, pin, "a mass at the ground pivot '"//pin%text// &
            "' has no effect")
        else
          call look_up(pin, pins, "pin", diagnostics, number)
        end if
      end associate
    end do
  end subroutine check_pin_masses

end module name_checks
