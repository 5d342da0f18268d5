!> Reading of STOP cards, whose units depend on the coordinate that they name, and checks of stops
!! and of springs of one side.
module stop_checks
  use cards, only: card_t
  use diagnostics, only: add_error, diagnostics_t
  use kinds, only: wp
  use measure_checks, only: refuse_two, seek_coordinate
  use models, only: model_t
  use named_coordinates, only: coordinate_number, find_named_coordinates, named_coordinate_t
  use natures, only: length_nature, nature_t
  use stop_cards, only: read_stop
  use text, only: same_word
  use tokens, only: token_t
  implicit none (type, external)
  private

  public :: read_stops, check_stops

contains

  !> Reads all STOP cards. Errors: as for `read_stop`.
  pure subroutine read_stops(cards, diagnostics, model)
    type(card_t), intent(in) :: cards(:)              !! of the deck
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(model_t), intent(inout) :: model             !! with its springs; its stops are set

    type(named_coordinate_t), allocatable :: named(:)
    integer :: i, filled, number
    type(nature_t) :: nature

    filled = 0
    do i = 1, size(cards)
      if (same_word(cards(i)%keyword%text, "STOP")) filled = filled + 1
    end do
    allocate (model%stops(filled))
    if (filled == 0) return
    call find_named_coordinates(model, named)
    filled = 0
    do i = 1, size(cards)
      if (.not. same_word(cards(i)%keyword%text, "STOP")) cycle
      filled = filled + 1
      number = 0
      if (size(cards(i)%words) > 1) number = coordinate_number(named, cards(i)%words(2)%text)
      nature = length_nature
      if (number > 0) nature = named(number)%nature
      call read_stop(cards(i), nature, model%units, diagnostics, model%stops(filled))
      model%stops(filled)%number = number
    end do
  end subroutine read_stops

  !> Checks stops and springs of one side. Errors: an unknown coordinate, or a name of two; without
  !! gravity no `contact=`; reports on links that bend.
  pure subroutine check_stops(diagnostics, model)
    type(diagnostics_t), intent(inout) :: diagnostics !! errors are added
    type(model_t), intent(in) :: model                !! with its stops, springs and reports

    type(named_coordinate_t), allocatable :: named(:)
    integer :: i, number

    if (size(model%stops) > 0) call find_named_coordinates(model, named)
    do i = 1, size(model%stops)
      associate (stop => model%stops(i))
        if (stop%measure%line == 0) cycle
        call seek_coordinate(diagnostics, named, stop%measure, number)
        if (number > 0) call refuse_two(diagnostics, named, stop%measure, number)
        call require_contact(diagnostics, model, stop%law%contact, stop%keyword)
        call refuse_reports(diagnostics, model, stop%keyword, "a STOP")
      end associate
    end do
    do i = 1, size(model%springs)
      associate (spring => model%springs(i))
        if (spring%law%side == 0) cycle
        call require_contact(diagnostics, model, spring%law%contact, spring%side_word)
        call refuse_reports(diagnostics, model, spring%side_word, "a spring of one side")
      end associate
    end do
  end subroutine check_stops

  !> Reports a contact without a width that follows from nothing.
  pure subroutine require_contact(diagnostics, model, contact, word)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    real(wp), intent(in) :: contact  !! 0: not on the card
    type(token_t), intent(in) :: word

    if (contact > 0.0_wp .or. any(abs(model%gravity) > 0.0_wp)) return
    call add_error(diagnostics, word, "'contact=' is missing: without GRAVITY the width in "// &
      "which the contact begins does not follow from the weight; expected about a hundredth "// &
      "of the depth to which it is pressed")
  end subroutine require_contact

  !> Refuses reports on links that bend, which vibrate about a stiffness that does not change.
  pure subroutine refuse_reports(diagnostics, model, word, what)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(model_t), intent(in) :: model
    type(token_t), intent(in) :: word
    character(len=*), intent(in) :: what

    integer :: i

    do i = 1, size(model%reports)
      associate (report => model%reports(i))
        if (.not. (report%kind%frequencies .or. report%kind%response)) cycle
        call add_error(diagnostics, word, "REPORT "//trim(report%kind%name)//" does not take "// &
          what//", whose stiffness changes with its contact; put a SPRING in its place where "// &
          "it is in contact, and leave it out elsewhere", report%keyword, "it is asked for here")
        return
      end associate
    end do
  end subroutine refuse_reports

end module stop_checks
