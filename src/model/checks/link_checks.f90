!> Checks of the shapes of links: lengths and turns of LINK cards, or the drawing.
module link_checks
  use diagnostics, only: add_error, diagnostics_t
  use drive_cards, only: drive_ram
  use kinds, only: wp
  use link_cards, only: link_t, segment_count
  use link_shapes, only: find_drawn_link, find_drawn_place, find_link_shape, lay_out
  use models, only: model_t
  use text, only: same_word, to_string
  use units, only: from_si
  implicit none (type, external)
  private

  public :: check_links, is_ram

  !> Misfit of a closed link given by more numbers than it needs, which have few digits: relative
  !! to its length, and of the turns of a triangle [rad].
  real(wp), parameter :: most_gap = 1.0e-3_wp, most_turn_misfit = 1.0e-2_wp

contains

  !> Whether the shape of every link is known; links without lengths of their own get that of the
  !! drawing. Errors: a pin without a place in the drawing, two pins at one place, no turns where
  !! lengths leave the shape open, a closed link that does not close.
  pure subroutine check_links(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(model_t), intent(inout) :: model             !! as read; lengths of links are set

    integer :: i

    do i = 1, size(model%links)
      if (size(model%links(i)%pins) == 0) cycle
      if (model%links(i)%lacks_lengths) then
        call take_drawn_length(diagnostics, model, i)
      else if (size(model%links(i)%lengths) > 0) then
        call check_lengths(diagnostics, model, model%links(i))
      end if
    end do
  end subroutine check_links

  !> Sets the length of a link from the drawing.
  pure subroutine take_drawn_length(diagnostics, model, link)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(inout) :: model
    integer, intent(in) :: link !! number in the model

    real(wp), allocatable :: places(:, :)
    real(wp) :: length, total
    integer :: i, next
    logical :: is_drawn

    call find_drawn_link(model, model%links(link), places, is_drawn)
    if (.not. is_drawn) then
      if (is_ram(model, model%links(link))) return
      call report_lack(diagnostics, model, model%links(link))
      return
    end if
    total = 0.0_wp
    associate (this => model%links(link))
      do i = 1, segment_count(this)
        next = mod(i, size(this%pins)) + 1
        length = norm2(places(:, next) - places(:, i))
        total = total + length
        if (length > 0.0_wp) cycle
        call add_error(diagnostics, this%name, "link '"//this%name%text//"' has no length: "// &
          "pins '"//this%pins(i)%text//"' and '"//this%pins(next)%text// &
          "' are at one place in the drawing")
        return
      end do
    end associate
    model%links(link)%length = total
  end subroutine take_drawn_length

  !> Whether a DRIVE card gives the length of a link.
  pure function is_ram(model, link) result(is)
    type(model_t), intent(in) :: model !! as read
    type(link_t), intent(in) :: link   !! of the model
    logical :: is

    integer :: i

    is = .false.
    do i = 1, size(model%drives)
      if (model%drives(i)%kind /= drive_ram) cycle
      is = is .or. same_word(model%drives(i)%subject%text, link%name%text)
    end do
  end function is_ram

  !> Reports which pins of a link without lengths are not in the drawing.
  pure subroutine report_lack(diagnostics, model, link)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    type(link_t), intent(in) :: link

    character(len=:), allocatable :: pins, what
    real(wp) :: place(2)
    integer :: i, lacking, told
    logical :: is_drawn(size(link%pins))

    do i = 1, size(link%pins)
      call find_drawn_place(model, link%pins(i)%text, place, is_drawn(i))
    end do
    lacking = count(.not. is_drawn)
    told = 0
    pins = ""
    do i = 1, size(link%pins)
      if (is_drawn(i)) cycle
      told = told + 1
      if (told > 1 .and. told < lacking) pins = pins//", "
      if (told > 1 .and. told == lacking) pins = pins//" and "
      pins = pins//"'"//link%pins(i)%text//"'"
    end do
    if (size(link%pins) == 2) then
      what = "the length of '"//link%name%text//"' is not given: length=, or "
    else
      what = "the shape of '"//link%name%text//"' is not given: lengths= and turns=, or "
    end if
    if (lacking == 1) what = what//"a PIN card for "
    if (lacking > 1) what = what//"PIN cards for "
    call add_error(diagnostics, link%name, what//pins)
  end subroutine report_lack

  !> Checks `lengths=` and `turns=` against each other.
  pure subroutine check_lengths(diagnostics, model, link)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    type(link_t), intent(in) :: link !! with its lengths

    real(wp), allocatable :: places(:, :)
    logical :: known

    if (link%is_closed .and. size(link%pins) == 3) then
      if (2.0_wp*maxval(link%lengths) >= sum(link%lengths)) then
        call add_error(diagnostics, link%length_word, "no triangle has these sides: one is as "// &
          "long as the other two together, or longer")
        return
      end if
      call find_link_shape(model, link, places, known)
      if (.not. known) then
        call add_error(diagnostics, link%length_word, "a triangle and its mirror image have "// &
          "these sides; expected 'turns=', or PIN cards for its pins")
      else if (size(link%turns) > 0) then
        call check_triangle(diagnostics, link, places)
      end if
    else if (size(link%turns) == 0) then
      ! A wrong value of the key has been reported.
      if (link%turns_word%line == 0) call add_error(diagnostics, link%length_word, &
        "'turns=' is missing; expected the turn at pin '"//link%pins(2)%text//"'"// &
        trim(merge(" and at those that follow", "                         ", &
        segment_count(link) > 2)))
    else if (link%is_closed) then
      call check_closing(diagnostics, model, link)
    end if
  end subroutine check_lengths

  !> The turns of a triangle follow from its sides.
  pure subroutine check_triangle(diagnostics, link, places)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(link_t), intent(in) :: link
    real(wp), intent(in) :: places(:, :) !! (2, 3) [m]

    real(wp) :: way(2), turn, degree

    way = places(:, 3) - places(:, 2)
    turn = atan2(way(2), way(1))
    if (abs(turn - link%turns(1)) <= most_turn_misfit) return
    degree = atan(1.0_wp)/45.0_wp
    call add_error(diagnostics, link%turns_word, "the sides of this triangle turn by "// &
      to_string(turn/degree, 6)//" deg at pin '"//link%pins(2)%text//"', not by "// &
      to_string(link%turns(1)/degree, 6))
  end subroutine check_triangle

  !> The last segment of a closed link leads back to its first pin.
  pure subroutine check_closing(diagnostics, model, link)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    type(link_t), intent(in) :: link

    real(wp) :: places(2, size(link%pins)), closing
    integer :: last

    last = size(link%pins)
    places = lay_out(link%lengths, link%turns, last)
    closing = norm2(places(:, last))
    if (abs(closing - link%lengths(last)) <= most_gap*maxval(link%lengths)) return
    call add_error(diagnostics, link%length_word, "link '"//link%name%text// &
      "' does not close: by the other lengths and turns its last one is "// &
      to_string(from_si(closing, model%units%length), 6)//" "//model%units%length%name)
  end subroutine check_closing

end module link_checks
