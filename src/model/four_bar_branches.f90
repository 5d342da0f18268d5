!> The branch of a four-bar, from whichever card gives it.
module four_bar_branches
  use diagnostics, only: add_error, diagnostics_t, has_errors
  use drive_cards, only: branch_left, branch_right, branch_t
  use kinds, only: wp
  use link_cards, only: link_t
  use link_shapes, only: find_drawn_pin
  use models, only: branch_crossed, branch_open, is_four_bar, model_t
  use name_index, only: find_name, name_index_t, new_name_index
  use text, only: same_word
  use tokens, only: token_t, token_texts
  implicit none (type, external)
  private

  public :: find_four_bar_branch

contains

  !> Finds the branch of a four-bar: from BRANCH open or crossed, from a BRANCH card about the pin
  !! of coupler and follower, or from the drawing; else it is open.
  !!
  !! Errors: links that form no loop; another BRANCH card; BRANCH open or crossed of another
  !! linkage. Any other linkage keeps its BRANCH cards as they are.
  pure subroutine find_four_bar_branch(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added; nothing is searched if it
                                                      !! has any before
    type(model_t), intent(inout) :: model             !! `branch` is set, and `branches` gets the
                                                      !! one that says the same about a pin

    type(name_index_t) :: grounds
    type(token_t) :: pin, pins(4)
    integer :: position, link, far_end
    logical :: used(size(model%links))

    if (.not. is_four_bar(model) .or. size(model%drives) == 0) then
      if (has_errors(diagnostics) .or. model%branch_word%line == 0) return
      call add_error(diagnostics, model%branch_word, "open and crossed are the branches of a "// &
        "four-bar; of another linkage: BRANCH pin left|right pin pin, BRANCH pin "// &
        "forward|backward, or PIN cards")
      return
    end if
    link = model%drives(1)%link
    if (link == 0 .or. has_errors(diagnostics)) return
    grounds = new_name_index(token_texts(model%grounds%pin))

    ! Pins round the loop, from the driven ground pivot to the other one.
    used = .false.
    far_end = merge(2, 1, find_name(grounds, model%links(link)%pins(1)%text) > 0)
    pin = model%links(link)%pins(3 - far_end)
    pins(1) = pin
    do position = 1, 3
      used(link) = .true.
      far_end = merge(2, 1, same_word(model%links(link)%pins(1)%text, pin%text))
      pin = model%links(link)%pins(far_end)
      pins(position + 1) = pin
      if (position == 3) exit
      link = link_at(model%links, used, pin%text)
      if (link == 0 .or. find_name(grounds, pin%text) > 0) then
        call refuse_open_loop(diagnostics, model, grounds, used)
        return
      end if
    end do
    call choose_branch(diagnostics, pins, model)
  end subroutine find_four_bar_branch

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

  !> Reports why the links form no loop, although every moving pin joins two links: two of the three
  !! are joined to each other, and the third joins the ground pivots.
  pure subroutine refuse_open_loop(diagnostics, model, grounds, used)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    type(name_index_t), intent(in) :: grounds
    logical, intent(in) :: used(:) !! (links) already in the loop

    integer :: i

    do i = 1, size(model%links)
      if (used(i)) cycle
      if (find_name(grounds, model%links(i)%pins(1)%text) == 0 .or. find_name(grounds, &
        model%links(i)%pins(2)%text) == 0) cycle
      call add_error(diagnostics, model%links(i)%name, "link '"//model%links(i)%name%text// &
        "' joins the two ground pivots and cannot move")
      return
    end do
    call add_error(diagnostics, model%drive, "the links do not form a loop that '"// &
      model%drive%text//"' can drive")
  end subroutine refuse_open_loop

  !> The link at a pin, of those not yet in the loop; 0 if none.
  pure function link_at(links, used, name) result(number)
    type(link_t), intent(in) :: links(:)
    logical, intent(in) :: used(:)       !! (links) already in the loop
    character(len=*), intent(in) :: name !! of the pin
    integer :: number

    integer :: n

    number = 0
    do n = 1, size(links)
      if (used(n)) cycle
      if (same_word(links(n)%pins(1)%text, name) .or. same_word(links(n)%pins(2)%text, name)) &
        number = n
    end do
  end function link_at

end module four_bar_branches
