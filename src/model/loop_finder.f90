!> Order of the links and pins round the loop of a four-bar: driven link, coupler, follower.
module loop_finder
  use diagnostics, only: add_error, diagnostics_t, has_errors
  use link_cards, only: link_t
  use models, only: model_t
  use name_checks, only: look_up
  use name_index, only: find_name, name_index_t, new_name_index
  use text, only: same_word, to_string
  use tokens, only: token_t, token_texts
  implicit none (type, external)
  private

  public :: find_loop

contains

  !> Finds the order of the links round the four-bar: driven link, coupler, follower; and of its
  !! pins, from the driven ground pivot to the other one. Errors: an unknown driven link, not three
  !! links and two ground pivots, a driven link on no or both ground pivots, links that form no
  !! loop. The order is then incomplete.
  pure subroutine find_loop(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added; the loop is not searched
                                                      !! if it has any before
    type(model_t), intent(inout) :: model             !! `loop` and `loop_pins` are set

    type(name_index_t) :: links, grounds
    type(token_t) :: pin
    integer :: i, position, link, grounded, far_end
    logical :: used(size(model%links))

    links = new_name_index(token_texts(model%links%name))
    grounds = new_name_index(token_texts(model%grounds%pin))
    link = 0
    if (model%drive%line > 0) call look_up(model%drive, links, "link", diagnostics, link)
    allocate (model%loop(3), model%loop_pins(4))
    model%loop = 0
    if (link == 0 .or. has_errors(diagnostics)) return

    grounded = count([(find_name(grounds, model%links(link)%pin(i)%text) > 0, i=1, 2)])
    if (size(model%links) /= 3 .or. size(model%grounds) /= 2) then
      call add_error(diagnostics, model%links(min(4, size(model%links)))%name, &
        "only the four-bar can be solved: three links and two ground pivots; this deck has "// &
        to_string(size(model%links))//" and "//to_string(size(model%grounds)))
      return
    else if (grounded /= 1) then
      call add_error(diagnostics, model%drive, "the driven link '"//model%drive%text//"' "// &
        merge("turns about no ground pivot", "joins the two ground pivots", grounded == 0))
      return
    end if

    used = .false.
    pin = model%links(link)%pin(merge(1, 2, find_name(grounds, model%links(link)%pin(1)%text) > 0))
    model%loop_pins(1) = pin
    do position = 1, 3
      used(link) = .true.
      model%loop(position) = link
      far_end = merge(2, 1, same_word(model%links(link)%pin(1)%text, pin%text))
      pin = model%links(link)%pin(far_end)
      model%loop_pins(position + 1) = pin
      if (position == 3) exit
      link = link_at(model%links, used, pin%text)
      if (link == 0 .or. find_name(grounds, pin%text) > 0) then
        call refuse_open_loop(diagnostics, model, grounds, used)
        return
      end if
    end do
  end subroutine find_loop

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
      if (find_name(grounds, model%links(i)%pin(1)%text) == 0 .or. find_name(grounds, &
        model%links(i)%pin(2)%text) == 0) cycle
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
      if (same_word(links(n)%pin(1)%text, name) .or. same_word(links(n)%pin(2)%text, name)) &
        number = n
    end do
  end function link_at

end module loop_finder
