!> Checks of BALANCE cards: the links that they name turn about ground pivots, and a report uses
!! them.
module balance_checks
  use balance_cards, only: shaft_form
  use body_checks, only: seek_link
  use diagnostics, only: add_error, add_warning, diagnostics_t, has_errors
  use drive_cards, only: drive_ram
  use kinds, only: wp
  use models, only: balances, drives_length, model_t, report_number
  use name_checks, only: link_ends
  use name_index, only: find_name, name_index_t, new_name_index
  use text, only: plural, to_string
  use tokens, only: token_t, token_texts
  implicit none (type, external)
  private

  public :: check_balance

  !> With a moment of inertia that does not depend on the mass all choices of links are tried.
  integer, parameter :: most_links = 8

contains

  !> Looks up the links of the BALANCE card; without names, all that turn about a ground pivot.
  !! Errors: an unknown link, one named twice, one without a ground pivot or with two, a ram; not
  !! one radius a link; a slider or a ram as the first drive; two pairs of shafts of one order.
  !! Warning: no REPORT balance.
  pure subroutine check_balance(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics !! errors and warnings are added
    type(model_t), intent(inout) :: model             !! link numbers of its card are set

    type(token_t) :: place
    integer :: i, k

    call find_links(diagnostics, model)
    do i = 1, size(model%shafts)
      do k = 1, i - 1
        if (model%shafts(k)%order /= model%shafts(i)%order .or. model%shafts(i)%order == 0) cycle
        call add_error(diagnostics, model%shafts(i)%order_word, "a second pair of balance "// &
          "shafts of order "//to_string(model%shafts(i)%order), model%shafts(k)%order_word, &
          "the first is here")
        exit
      end do
    end do
    if (.not. balances(model)) return
    place = model%balance%keyword
    if (place%line == 0) place = model%shafts(1)%keyword
    if (drives_length(model)) call add_error(diagnostics, place, "BALANCE is about a whole "// &
      "turn of the crank at constant speed, and the first DRIVE gives a length", &
      model%drive, "it is driven here")
    if (report_number(model, "balance") == 0 .and. .not. has_errors(diagnostics)) call &
      add_warning(diagnostics, place, "BALANCE is used by REPORT balance only, which is not "// &
      "asked for")
  end subroutine check_balance

  pure subroutine find_links(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(inout) :: model

    type(name_index_t) :: links, pins
    integer :: i, link, first

    if (model%balance%keyword%line == 0) return
    associate (balance => model%balance)
      if (size(balance%link_names) == 0) then
        balance%links = pack([(i, i=1, size(model%links))], [(turns(model, i), i=1, &
          size(model%links))])
        if (size(balance%links) == 0) call add_error(diagnostics, balance%keyword, &
          "no link turns about a ground pivot: there is none to bear a counterweight")
      end if
      links = new_name_index(token_texts(model%links%name))
      pins = new_name_index(token_texts(link_ends(model%links)))
      do i = 1, size(balance%link_names)
        associate (word => balance%link_names(i))
          link = 0
          call seek_link(word, links, pins, diagnostics, link)
          if (link == 0) cycle
          first = findloc(balance%links, link, dim=1)
          if (first > 0) then
            call add_error(diagnostics, word, "'"//word%text//"' is named twice")
            cycle
          end if
          balance%links = [balance%links, link]
          if (.not. turns(model, link)) call refuse_link(diagnostics, model, word, link)
        end associate
      end do
      if (size(balance%radius) > 1 .and. size(balance%radius) /= size(balance%links) .and. &
        size(balance%links) >= size(balance%link_names)) call add_error(diagnostics, &
        balance%radius_word, "'radius=' has "//plural(size(balance%radius), "value")//" for "// &
        plural(size(balance%links), "link")//"; expected one for all, or one for each")
      if (balance%make%inertia > 0.0_wp .and. size(balance%links) > most_links) call &
        add_error(diagnostics, balance%keyword, "'inertia=' is for "//to_string(most_links)// &
        " links at most, not "//to_string(size(balance%links))//"; expected the names of some, "// &
        "or 'density=' and 'thickness='")
    end associate
  end subroutine find_links

  !> How many pins of a link are ground pivots; a POINT is none.
  pure function grounded_pins(model, link) result(grounded)
    type(model_t), intent(in) :: model
    integer, intent(in) :: link
    integer :: grounded

    type(name_index_t) :: grounds
    integer :: i

    grounds = new_name_index(token_texts(model%grounds%pin))
    grounded = 0
    do i = 1, size(model%links(link)%pins)
      if (find_name(grounds, model%links(link)%pins(i)%text) > 0) grounded = grounded + 1
    end do
  end function grounded_pins

  !> Whether a link of constant length turns about one ground pivot.
  pure function turns(model, link)
    type(model_t), intent(in) :: model
    integer, intent(in) :: link
    logical :: turns

    turns = grounded_pins(model, link) == 1 .and. .not. is_ram(model, link)
  end function turns

  pure function is_ram(model, link) result(is)
    type(model_t), intent(in) :: model
    integer, intent(in) :: link
    logical :: is

    is = any(model%drives%kind == drive_ram .and. model%drives%link == link)
  end function is_ram

  pure subroutine refuse_link(diagnostics, model, word, link)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    type(token_t), intent(in) :: word
    integer, intent(in) :: link

    if (is_ram(model, link)) then
      call add_error(diagnostics, word, "link '"//word%text//"' changes its length: a "// &
        "counterweight is fixed to a link of constant length")
    else if (grounded_pins(model, link) > 1) then
      call add_error(diagnostics, word, "link '"//word%text//"' has two ground pivots and does "// &
        "not turn: a counterweight would do nothing")
    else
      call add_error(diagnostics, word, "link '"//word%text//"' has no ground pivot; expected "// &
        "links that turn about one, such as the crank, or 'BALANCE "//shaft_form//"'")
    end if
  end subroutine refuse_link

end module balance_checks
