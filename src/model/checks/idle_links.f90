!> Rigid links and ground pivots that move nothing and hold nothing, as files of other programs have
!! them: they are left out, with a warning.
module idle_links
  use cards, only: card_t
  use diagnostics, only: add_warning, diagnostics_t, has_errors
  use joint_cards, only: drawn_pin_t
  use kinds, only: wp
  use link_cards, only: link_t
  use link_checks, only: is_ram
  use link_shapes, only: find_link_shape
  use linkage_cards, only: ground_t
  use models, only: model_t, needs_frequencies, needs_response
  use name_checks, only: looks_misspelt
  use text, only: has_word, same_word, word_list
  implicit none (type, external)
  private

  public :: leave_out_idle_links

  !> Characters of names.
  character(len=*), parameter :: name_characters = &
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.'"

  !> Cards whose words, but for the first of a LINK, are pins of the drawing.
  character(len=*), parameter :: drawing = "LINK GROUND PIN"

  !> Cards that name neither links nor pins, whatever numbers and words they have.
  character(len=*), parameter :: nameless = "TITLE UNITS MATERIAL SECTION CRANK SPEED TIME LAW "// &
    "TABLE GRAVITY INERTIA EFFECTS SOLVER MODES SET VARY"

contains

  !> Leaves out rigid links without mass that no card but their own names: those between ground
  !! pivots, those along another rigid link, and in linkages with a drive those that hang free or
  !! are joined to nothing; then ground pivots that nothing uses. What bends, has a mass or is named
  !! stays. So does what looks misspelt, and what hangs on a linkage that is not complete without
  !! it: parts may be missing.
  pure subroutine leave_out_idle_links(cards, diagnostics, model)
    type(card_t), intent(in) :: cards(:)              !! of the deck
    type(diagnostics_t), intent(inout) :: diagnostics !! a warning for each part is added
    type(model_t), intent(inout) :: model             !! with its cards read; nothing looked up

    logical :: stays(size(model%links)), plain(size(model%links))
    integer :: i, pass

    if (has_errors(diagnostics)) return
    stays = .true.
    do i = 1, size(model%links)
      if (size(model%links(i)%pins) < 2) return
    end do
    plain = [(may_be_idle(model, model%links(i)), i=1, size(plain))]
    ! First those without an end of their own.
    do pass = 1, 2
      do i = size(model%links), 1, -1
        if (.not. plain(i) .or. .not. stays(i)) cycle
        if (pass == 1 .and. .not. all(shared_pins(model, stays, i))) cycle
        call leave_along(cards, model, i, diagnostics, stays)
      end do
    end do
    if (size(model%drives) > 0) call leave_hanging(cards, model, plain, diagnostics, stays)
    if (.not. all(stays)) call keep_links(cards, stays, model)
    call keep_grounds(cards, diagnostics, model)
  end subroutine leave_out_idle_links

  !> Whether a link has neither a mass nor anything that bends.
  pure function may_be_idle(model, link) result(may)
    type(model_t), intent(in) :: model
    type(link_t), intent(in) :: link
    logical :: may

    may = link%section_name%line == 0 .and. link%material_name%line == 0 .and. &
      .not. (link%mass > 0.0_wp .or. link%inertia > 0.0_wp)
    if (.not. link%rigid) may = may .and. .not. (needs_frequencies(model) .or. &
      needs_response(model))
  end function may_be_idle

  !> Leaves out a link all of whose pins that others have are ground pivots, or pins of one other
  !! rigid link, at the same distances.
  pure subroutine leave_along(cards, model, number, diagnostics, stays)
    type(card_t), intent(in) :: cards(:)
    type(model_t), intent(in) :: model
    integer, intent(in) :: number !! of the link
    type(diagnostics_t), intent(inout) :: diagnostics
    logical, intent(inout) :: stays(:)

    logical :: shared(size(model%links(number)%pins))
    real(wp), allocatable :: places(:, :), others(:, :)
    integer :: i, k

    associate (link => model%links(number))
      shared = shared_pins(model, stays, number)
      if (count(shared) < 2) return
      do i = 1, size(model%links) + 1
        k = i - 1
        if (k == number) cycle
        if (k > 0) then
          if (.not. stays(k) .or. .not. is_rigid(model, model%links(k))) cycle
        end if
        if (.not. has_all(model, k, link, shared)) cycle
        if (is_named(cards, model, link, shared)) return
        call find_common(model, k, link, shared, places, others)
        if (.not. are_same(places, others)) return
        stays(number) = .false.
        if (k == 0) then
          call add_warning(diagnostics, link%name, "link '"//link%name%text//"' joins ground "// &
            "pivots and moves nothing: it is left out")
        else
          call add_warning(diagnostics, link%name, "link '"//link%name%text//"' lies along '"// &
            model%links(k)%name%text//"', on pins of it, and holds nothing more: it is left out", &
            second_place=model%links(k)%name, note="it is here")
        end if
        return
      end do
    end associate
  end subroutine leave_along

  !> Leaves out links that hang on one pin of others, or on none.
  pure subroutine leave_hanging(cards, model, plain, diagnostics, stays)
    type(card_t), intent(in) :: cards(:)
    type(model_t), intent(in) :: model
    logical, intent(in) :: plain(:)
    type(diagnostics_t), intent(inout) :: diagnostics
    logical, intent(inout) :: stays(:)

    logical, dimension(size(stays)) :: hangs, driven, rest
    logical, allocatable :: shared(:)
    integer :: i, k, pin

    hangs = .false.
    do i = 1, size(stays)
      driven(i) = any_drives(cards, model%links(i)%name%text)
      if (.not. stays(i) .or. .not. plain(i) .or. driven(i)) cycle
      shared = shared_pins(model, stays, i)
      if (count(shared) > 1) cycle
      hangs(i) = .not. is_named(cards, model, model%links(i), shared) .and. .not. any([( &
        .not. shared(k) .and. looks_misspelt(model, model%links(i)%pins(k)%text), k=1, &
        size(shared))])
    end do
    if (.not. any(hangs)) return
    rest = stays .and. .not. hangs
    if (all(driven .or. .not. rest) .or. freedoms(model, rest) > size(model%drives)) return
    do i = 1, size(stays)
      if (.not. hangs(i)) cycle
      associate (link => model%links(i))
        pin = findloc(shared_pins(model, stays, i), .true., dim=1)
        if (pin > 0) then
          call add_warning(diagnostics, link%name, "link '"//link%name%text//"' hangs free on "// &
            "pin '"//link%pins(pin)%text//"', without mass: it is left out (add a DRIVE, or "// &
            "parts that hold it)")
        else
          call add_warning(diagnostics, link%name, "link '"//link%name%text//"' is joined to "// &
            "nothing, and has no mass: it is left out")
        end if
      end associate
    end do
    stays = rest
  end subroutine leave_hanging

  !> Freedoms of some links by counting: three each, less two for every link but one at a pin, one
  !! for a block, one for what turns together.
  pure function freedoms(model, stays) result(number)
    type(model_t), intent(in) :: model
    logical, intent(in) :: stays(:) !! (links)
    integer :: number

    logical, allocatable :: shared(:)
    integer :: i, k, n
    logical :: counted(size(stays))

    counted = .false.
    number = 0
    do i = 1, size(stays)
      if (.not. stays(i)) cycle
      number = number + 3
      if (is_ram(model, model%links(i))) number = number + 1
      ! Joints with the links before, and with the ground.
      shared = [(is_ground(model, model%links(i)%pins(k)%text), k=1, size(model%links(i)%pins))]
      do n = 1, i - 1
        if (counted(n)) shared = shared .or. [(has_pin(model%links(n), &
          model%links(i)%pins(k)%text), k=1, size(shared))]
      end do
      number = number - 2*count(shared)
      counted(i) = .true.
    end do
    number = number - size(model%sliders) - count(model%sliders%turned%line > 0)
    do i = 1, size(model%welds)
      number = number - size(model%welds(i)%links) + 1
    end do
    do i = 1, size(model%clamps)
      number = number - max(1, size(model%clamps(i)%links))
    end do
  end function freedoms

  !> Which pins of a link others have: ground pivots, and those of links that stay and of blocks.
  pure function shared_pins(model, stays, number) result(shared)
    type(model_t), intent(in) :: model
    logical, intent(in) :: stays(:)
    integer, intent(in) :: number !! of the link
    logical, allocatable :: shared(:)

    integer :: i, k

    associate (pins => model%links(number)%pins)
      allocate (shared(size(pins)))
      do i = 1, size(pins)
        shared(i) = is_held(model, pins(i)%text)
        do k = 1, size(stays)
          if (k /= number .and. stays(k)) shared(i) = shared(i) .or. has_pin(model%links(k), &
            pins(i)%text)
        end do
      end do
    end associate
  end function shared_pins

  !> Whether a pin is fixed, or is that of a block.
  pure function is_held(model, pin) result(is)
    type(model_t), intent(in) :: model
    character(len=*), intent(in) :: pin
    logical :: is

    integer :: i

    is = is_ground(model, pin)
    do i = 1, size(model%sliders)
      is = is .or. same_word(model%sliders(i)%pin%text, pin)
    end do
  end function is_held

  pure function is_ground(model, pin) result(is)
    type(model_t), intent(in) :: model
    character(len=*), intent(in) :: pin
    logical :: is

    integer :: i

    is = .false.
    do i = 1, size(model%grounds)
      is = is .or. same_word(model%grounds(i)%pin%text, pin)
    end do
  end function is_ground

  pure function has_pin(link, pin) result(has)
    type(link_t), intent(in) :: link
    character(len=*), intent(in) :: pin
    logical :: has

    integer :: i

    has = .false.
    do i = 1, size(link%pins)
      has = has .or. same_word(link%pins(i)%text, pin)
    end do
  end function has_pin

  !> Whether a link bends nowhere: as a beam it may hold what a rigid one beside it does not.
  pure function is_rigid(model, link) result(is)
    type(model_t), intent(in) :: model
    type(link_t), intent(in) :: link
    logical :: is

    is = .not. is_ram(model, link)
    if (.not. link%rigid) is = is .and. link%section_name%line == 0 .and. &
      .not. (needs_frequencies(model) .or. needs_response(model))
  end function is_rigid

  !> Whether a link, or the ground, has all those pins of another one that are shared.
  pure function has_all(model, number, link, shared) result(has)
    type(model_t), intent(in) :: model
    integer, intent(in) :: number !! 0: the ground
    type(link_t), intent(in) :: link
    logical, intent(in) :: shared(:)
    logical :: has

    integer :: i

    has = .true.
    do i = 1, size(shared)
      if (.not. shared(i)) cycle
      if (number == 0) then
        has = has .and. is_ground(model, link%pins(i)%text)
      else
        has = has .and. has_pin(model%links(number), link%pins(i)%text)
      end if
    end do
  end function has_all

  !> Places of the shared pins on a link, and on the other one or in the ground; 0 where the shape
  !! is not known.
  pure subroutine find_common(model, number, link, shared, places, others)
    type(model_t), intent(in) :: model
    integer, intent(in) :: number !! of the other link; 0: the ground
    type(link_t), intent(in) :: link
    logical, intent(in) :: shared(:)
    real(wp), allocatable, intent(out) :: places(:, :), others(:, :) !! (2, shared pins) [m]

    real(wp), allocatable :: own(:, :), all_others(:, :)
    integer :: i, k, n
    logical :: known

    call find_link_shape(model, link, own, known)
    if (number > 0) call find_link_shape(model, model%links(number), all_others, known)
    allocate (places(2, count(shared)), others(2, count(shared)))
    others = 0.0_wp
    n = 0
    do i = 1, size(shared)
      if (.not. shared(i)) cycle
      n = n + 1
      places(:, n) = own(:, i)
      if (number == 0) then
        do k = 1, size(model%grounds)
          if (same_word(model%grounds(k)%pin%text, link%pins(i)%text)) others(:, n) = &
            model%grounds(k)%position
        end do
      else
        do k = 1, size(model%links(number)%pins)
          if (same_word(model%links(number)%pins(k)%text, link%pins(i)%text)) others(:, n) = &
            all_others(:, k)
        end do
      end if
    end do
  end subroutine find_common

  !> Whether two patterns of points are the same but for where they are.
  pure function are_same(a, b)
    real(wp), intent(in) :: a(:, :), b(:, :) !! (2, points) [m]
    logical :: are_same

    real(wp), parameter :: nearly = 1.0e-9_wp !! as a share of their size
    real(wp) :: u(2), v(2), w(2), x(2), length
    integer :: i

    u = a(:, 2) - a(:, 1)
    v = b(:, 2) - b(:, 1)
    length = norm2(u)
    are_same = length > 0.0_wp .and. norm2(v) > 0.0_wp
    do i = 2, size(a, 2)
      w = a(:, i) - a(:, 1)
      x = b(:, i) - b(:, 1)
      are_same = are_same .and. abs(dot_product(u, w) - dot_product(v, x)) <= nearly*length* &
        max(length, norm2(w)) .and. abs(u(1)*w(2) - u(2)*w(1) - v(1)*x(2) + v(2)*x(1)) <= &
        nearly*length*max(length, norm2(w))
    end do
  end function are_same

  !> Whether a card names a link, a pin of its own, or holds it at a pin without naming it.
  pure function is_named(cards, model, link, shared) result(is)
    type(card_t), intent(in) :: cards(:)
    type(model_t), intent(in) :: model
    type(link_t), intent(in) :: link
    logical, intent(in) :: shared(:) !! (pins) others have it
    logical :: is

    integer :: i

    is = names(cards, "LINK GROUND PIN PINMASS BRANCH", link%name%text)
    do i = 1, size(shared)
      if (.not. shared(i)) is = is .or. names(cards, drawing, link%pins(i)%text)
    end do
    do i = 1, size(model%clamps)
      if (size(model%clamps(i)%links) == 0) is = is .or. has_pin(link, model%clamps(i)%pin%text)
    end do
  end function is_named

  !> Whether a DRIVE card names a link.
  pure function any_drives(cards, name) result(drives)
    type(card_t), intent(in) :: cards(:)
    character(len=*), intent(in) :: name
    logical :: drives

    integer :: i

    drives = .false.
    do i = 1, size(cards)
      if (same_word(cards(i)%keyword%text, "DRIVE")) drives = drives .or. has_name(cards(i), name)
    end do
  end function any_drives

  !> Whether any card has a name, but those with some keywords.
  pure function names(cards, but, name)
    type(card_t), intent(in) :: cards(:)
    character(len=*), intent(in) :: but !! keywords, in capitals
    character(len=*), intent(in) :: name
    logical :: names

    integer :: i

    names = .false.
    do i = 1, size(cards)
      if (has_word(word_list(but//" "//nameless), cards(i)%keyword%text)) cycle
      names = has_name(cards(i), name)
      if (names) return
    end do
  end function names

  !> Whether a name stands among the words or the values of a card.
  pure function has_name(card, name) result(has)
    type(card_t), intent(in) :: card
    character(len=*), intent(in) :: name
    logical :: has

    integer :: i, k

    has = .false.
    do i = 1, size(card%words)
      has = has .or. contains_name(card%words(i)%text, name)
    end do
    do i = 1, size(card%entries)
      has = has .or. contains_name(card%entries(i)%value%text, name)
      if (.not. allocated(card%entries(i)%items)) cycle
      do k = 1, size(card%entries(i)%items)
        has = has .or. contains_name(card%entries(i)%items(k)%text, name)
      end do
    end do
  end function has_name

  !> Whether a name is a word, or a part of one between characters that no name has.
  pure function contains_name(word, name) result(has)
    character(len=*), intent(in) :: word, name
    logical :: has

    integer :: from, to

    has = .false.
    if (len(word) < len(name)) return
    from = 1
    do while (from <= len(word))
      to = verify(word(from:), name_characters)
      to = merge(len(word), from + to - 2, to == 0)
      has = same_word(word(from:to), name)
      if (has) return
      from = to + 2
    end do
  end function contains_name

  !> Whether a link that stays, a block or any card uses a ground pivot.
  pure function is_used(cards, model, stays, pin) result(is)
    type(card_t), intent(in) :: cards(:)
    type(model_t), intent(in) :: model
    logical, intent(in) :: stays(:) !! (links)
    character(len=*), intent(in) :: pin
    logical :: is

    integer :: i

    is = .true.
    do i = 1, size(model%links)
      if (.not. stays(i)) cycle
      if (has_pin(model%links(i), pin)) return
    end do
    is = names(cards, "LINK GROUND", pin)
  end function is_used

  !> Whether a pin of one link only looks misspelt.
  pure function has_misspelt_pin(model) result(has)
    type(model_t), intent(in) :: model
    logical :: has

    logical :: stays(size(model%links))
    logical, allocatable :: shared(:)
    integer :: i, k

    has = .true.
    stays = .true.
    do i = 1, size(model%links)
      shared = shared_pins(model, stays, i)
      associate (pins => model%links(i)%pins)
        do k = 1, size(pins)
          if (shared(k)) cycle
          if (looks_misspelt(model, pins(k)%text)) return
        end do
      end associate
    end do
    has = .false.
  end function has_misspelt_pin

  !> The links that stay, and the places of their pins.
  pure subroutine keep_links(cards, stays, model)
    type(card_t), intent(in) :: cards(:)
    logical, intent(in) :: stays(:)
    type(model_t), intent(inout) :: model

    type(link_t), allocatable :: links(:)
    type(drawn_pin_t), allocatable :: pins(:)
    logical :: drawn(size(model%drawn_pins))
    integer :: i, k, n

    do i = 1, size(drawn)
      associate (pin => model%drawn_pins(i)%pin%text)
        drawn(i) = .not. any([(.not. stays(k) .and. has_pin(model%links(k), pin), k=1, &
          size(stays))])
        drawn(i) = drawn(i) .or. any([(stays(k) .and. has_pin(model%links(k), pin), k=1, &
          size(stays))])
        if (.not. drawn(i)) drawn(i) = names(cards, drawing, pin)
      end associate
    end do
    allocate (links(count(stays)), pins(count(drawn)))
    n = 0
    do i = 1, size(stays)
      if (.not. stays(i)) cycle
      n = n + 1
      links(n) = model%links(i)
    end do
    n = 0
    do i = 1, size(drawn)
      if (.not. drawn(i)) cycle
      n = n + 1
      pins(n) = model%drawn_pins(i)
    end do
    call move_alloc(links, model%links)
    call move_alloc(pins, model%drawn_pins)
  end subroutine keep_links

  !> The ground pivots that anything uses.
  pure subroutine keep_grounds(cards, diagnostics, model)
    type(card_t), intent(in) :: cards(:)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(inout) :: model

    type(ground_t), allocatable :: grounds(:)
    logical :: used(size(model%grounds))
    integer :: i, n

    used = [(is_used(cards, model, spread(.true., 1, size(model%links)), &
      model%grounds(i)%pin%text), i=1, size(used))]
    if (all(used)) return
    if (has_misspelt_pin(model)) return
    allocate (grounds(count(used)))
    n = 0
    do i = 1, size(used)
      if (used(i)) then
        n = n + 1
        grounds(n) = model%grounds(i)
      else
        call add_warning(diagnostics, model%grounds(i)%pin, "no link uses the ground pivot '"// &
          model%grounds(i)%pin%text//"': it is left out")
      end if
    end do
    call move_alloc(grounds, model%grounds)
  end subroutine keep_grounds

end module idle_links
