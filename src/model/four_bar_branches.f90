!> The branch of a four-bar, from whichever card gives it.
module four_bar_branches
  use diagnostics, only: add_error, diagnostics_t, has_errors
  use drive_cards, only: branch_left, branch_right, branch_t
  use kinds, only: wp
  use link_shapes, only: find_drawn_pin
  use models, only: branch_crossed, branch_open, is_four_bar, model_t, word_of_four_bar
  use name_index, only: find_name, name_index_t, new_name_index
  use report_kinds, only: any_linkage, four_bars
  use text, only: same_word, to_string
  use tokens, only: token_t, token_texts
  use units, only: coherent_unit, dimension_length, from_si, unit_t
  implicit none (type, external)
  private

  public :: find_four_bar_branch, check_format_of_four_bar, refuse_format

contains

  !> Finds the branch of a four-bar, or of a linkage that `format=` calls one: from BRANCH open or
  !! crossed, from a BRANCH card about the pin of coupler and follower, or from the drawing; else it
  !! is open.
  !!
  !! Errors: links that form no loop; another BRANCH card; BRANCH open or crossed of another
  !! linkage. Any other linkage keeps its BRANCH cards as they are.
  pure subroutine find_four_bar_branch(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added; nothing is searched if it
                                                      !! has any before
    type(model_t), intent(inout) :: model             !! `branch` is set, and `branches` gets the
                                                      !! one that says the same about a pin

    type(token_t) :: asked, pins(4)
    integer :: loops

    if (has_errors(diagnostics)) return
    asked = word_of_four_bar(model)
    if ((.not. is_four_bar(model) .and. asked%line == 0) .or. size(model%drives) == 0) then
      if (model%branch_word%line == 0) return
      call add_error(diagnostics, model%branch_word, "open and crossed are the branches of a "// &
        "four-bar; of another linkage: BRANCH pin left|right pin pin, BRANCH pin "// &
        "forward|backward, or PIN cards"//loaded_point(model))
      return
    end if
    call find_loop(model, loops, pins)
    if (loops == 1) then
      call choose_branch(diagnostics, pins, model)
    else if (is_four_bar(model)) then
      call refuse_open_loop(diagnostics, model)
    end if
  end subroutine find_four_bar_branch

  !> For a four-bar but for a point that a FORCE makes a pin: the card that leaves it one. Else an
  !! empty text.
  pure function loaded_point(model) result(hint)
    type(model_t), intent(in) :: model !! no four-bar
    character(len=:), allocatable :: hint

    type(model_t) :: pointless
    type(unit_t) :: length
    integer :: i

    hint = ""
    pointless = model
    deallocate (pointless%points)
    allocate (pointless%points(0))
    if (.not. is_four_bar(pointless)) return
    do i = 1, size(model%points)
      associate (point => model%points(i))
        if (.not. (any_same(model%forces%pin, point%name) .or. any_same(model%processes%subject, &
          point%name))) cycle
        length = coherent_unit(model%units, dimension_length)
        hint = "; it is none because the FORCE on '"//point%name%text//"' makes this point a "// &
          "pin: FORCE "//point%link_name%text//" fx fy at="//to_string(from_si(point%place(1), &
          length), 12)
        if (abs(point%place(2)) > 0.0_wp) hint = hint//" offset="// &
          to_string(from_si(point%place(2), length), 12)
        hint = hint//" loads the same place of a four-bar"
        return
      end associate
    end do
  end function loaded_point

  pure function any_same(words, name) result(any_is)
    type(token_t), intent(in) :: words(:), name
    logical :: any_is

    integer :: i

    any_is = .false.
    do i = 1, size(words)
      any_is = any_is .or. same_word(words(i)%text, name%text)
    end do
  end function any_same

  !> Refuses `format=four_bar` of a linkage that has no such loop: its tables are then those of the
  !! deck.
  pure subroutine check_format_of_four_bar(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(model_t), intent(inout) :: model             !! with its links, drives and reports

    type(token_t) :: asked, pins(4)
    integer :: loops, i

    asked = word_of_four_bar(model)
    if (asked%line == 0 .or. is_four_bar(model)) return
    call find_loop(model, loops, pins)
    if (loops == 1) return
    if (.not. has_errors(diagnostics)) call refuse_format(diagnostics, asked)
    model%format = any_linkage
    do i = 1, size(model%reports)
      if (model%reports(i)%format == four_bars) model%reports(i)%format = any_linkage
    end do
  end subroutine check_format_of_four_bar

  !> Refuses tables of four-bars of a linkage that is none.
  pure subroutine refuse_format(diagnostics, word)
    type(diagnostics_t), intent(inout) :: diagnostics !! to which an error is added
    type(token_t), intent(in) :: word                 !! of `format=`

    call add_error(diagnostics, word, "this linkage is no four-bar: no driven link, coupler "// &
      "and follower alone hold each other between two ground pivots; expected linkage, or no "// &
      "format=")
  end subroutine refuse_format

  !> Ways from the driven ground pivot over three links to another ground pivot, in a linkage whose
  !! further links are welded on, and nothing slides.
  pure subroutine find_loop(model, loops, pins)
    type(model_t), intent(in) :: model       !! with its drives
    integer, intent(out) :: loops            !! how many there are
    type(token_t), intent(out) :: pins(4)    !! of the last: O2, A, B, O4

    type(name_index_t) :: grounds
    type(token_t) :: way(4)
    integer :: links(3), driven, k

    loops = 0
    pins = token_t("", 0, 0)
    if (size(model%drives) == 0) return
    driven = find_name(new_name_index(token_texts(model%links%name)), model%drives(1)%subject%text)
    if (driven == 0 .or. size(model%links) > 3 + count_welded(model) .or. size(model%sliders) > 0) &
      return
    grounds = new_name_index(token_texts(model%grounds%pin))
    links(1) = driven
    do k = 1, size(model%links(driven)%pins)
      way(1) = model%links(driven)%pins(k)
      if (find_name(grounds, way(1)%text) > 0) call follow_links(model, grounds, 1, links, way, &
        loops, pins)
    end do
  end subroutine find_loop

  !> Goes on from the last of some links, over pins that move, until a third link ends at another
  !! ground pivot.
  pure recursive subroutine follow_links(model, grounds, count, links, way, loops, pins)
    type(model_t), intent(in) :: model
    type(name_index_t), intent(in) :: grounds
    integer, intent(in) :: count           !! of links so far
    integer, intent(inout) :: links(3)     !! their numbers, from the driven one
    type(token_t), intent(inout) :: way(4) !! a pin before each of them
    integer, intent(inout) :: loops        !! as of `find_loop`
    type(token_t), intent(inout) :: pins(4)

    integer :: k, next

    associate (here => model%links(links(count))%pins)
      do k = 1, size(here)
        if (is_among(here(k), way(:count))) cycle
        if ((find_name(grounds, here(k)%text) > 0) .neqv. count == 3) cycle
        way(count + 1) = here(k)
        if (count == 3) then
          loops = loops + 1
          pins = way
          cycle
        end if
        do next = 1, size(model%links)
          if (any(links(:count) == next) .or. .not. is_among(here(k), model%links(next)%pins)) cycle
          links(count + 1) = next
          call follow_links(model, grounds, count + 1, links, way, loops, pins)
        end do
      end do
    end associate
  end subroutine follow_links

  !> Whether a pin is one of several.
  pure function is_among(pin, pins) result(is)
    type(token_t), intent(in) :: pin, pins(:)
    logical :: is

    integer :: k

    is = .false.
    do k = 1, size(pins)
      is = is .or. same_word(pins(k)%text, pin%text)
    end do
  end function is_among

  !> Open or crossed, without a card that says so: by a BRANCH card about the pin of coupler and
  !! follower, or else by the drawing. Errors: a card about another pin, or the side of another way
  !! than that from the driven link's pin to the other ground pivot.
  pure subroutine choose_branch(diagnostics, pins, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(token_t), intent(in) :: pins(4) !! round the loop
    type(model_t), intent(inout) :: model

    type(branch_t) :: found
    real(wp) :: place(2, 4), side
    logical :: is_drawn(4), is_left, is_reverse
    integer :: i

    do i = 1, size(model%branches)
      associate (branch => model%branches(i), a => pins(2), o4 => pins(4))
        is_reverse = same_word(branch%from%text, o4%text) .and. same_word(branch%to%text, a%text)
        if (model%branch_word%line > 0) then
          call add_error(diagnostics, branch%pin, "a second branch of the four-bar", &
            model%branch_word, "the first is here")
        else if (.not. same_word(branch%pin%text, pins(3)%text) .or. .not. &
          (is_reverse .or. (same_word(branch%from%text, a%text) .and. same_word(branch%to%text, &
          o4%text)))) then
          call add_error(diagnostics, branch%pin, "the branch of this four-bar is: BRANCH "// &
            pins(3)%text//" left|right "//a%text//" "//o4%text)
        else
          is_left = (branch%which == branch_left) .neqv. is_reverse
          model%branch = merge(branch_open, branch_crossed, is_left)
        end if
      end associate
    end do
    if (size(model%branches) == 0 .and. model%branch_word%line == 0) then
      do i = 1, 4
        call find_drawn_pin(model, pins(i)%text, place(:, i), is_drawn(i))
      end do
      if (all(is_drawn)) then
        side = (place(1, 4) - place(1, 2))*(place(2, 3) - place(2, 2)) - &
          (place(2, 4) - place(2, 2))*(place(1, 3) - place(1, 2))
        model%branch = merge(branch_crossed, branch_open, side < 0.0_wp)
      end if
    end if
    found%pin = pins(3)
    found%which = merge(branch_right, branch_left, model%branch == branch_crossed)
    found%from = pins(2)
    found%to = pins(4)
    model%branches = [found]
  end subroutine choose_branch

  !> How many links welds join to others.
  pure function count_welded(model) result(joined)
    type(model_t), intent(in) :: model
    integer :: joined

    integer :: i

    joined = sum([(max(0, size(model%welds(i)%links) - 1), i=1, size(model%welds))])
  end function count_welded

  !> Reports why the links form no loop, although every moving pin joins two links: two of the three
  !! are joined to each other, and the third joins the ground pivots.
  pure subroutine refuse_open_loop(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model

    type(name_index_t) :: grounds
    integer :: i

    grounds = new_name_index(token_texts(model%grounds%pin))
    do i = 1, size(model%links)
      if (find_name(grounds, model%links(i)%pins(1)%text) == 0 .or. find_name(grounds, &
        model%links(i)%pins(2)%text) == 0) cycle
      call add_error(diagnostics, model%links(i)%name, "link '"//model%links(i)%name%text// &
        "' joins the two ground pivots and cannot move")
      return
    end do
    call add_error(diagnostics, model%drive, "the links do not form a loop that '"// &
      model%drive%text//"' can drive")
  end subroutine refuse_open_loop

end module four_bar_branches
