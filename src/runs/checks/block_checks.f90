!> Blocks that leave the links along which they slide: at which positions, told before the run.
module block_checks
  use coordinates, only: coordinate_value, slider_coordinate
  use deck_lengths, only: crank_text, length_text, word_of_positions
  use diagnostics, only: add_error, add_warning, diagnostics_t
  use errors, only: error_of_reach, error_t
  use kinds, only: wp
  use linkages, only: linkage_t
  use mechanisms, only: mechanism_t
  use models, only: model_t, needs_frequencies
  use pose_types, only: pose_t
  use poses, only: place_links
  use sorting, only: ascending_order
  use text, only: plural
  implicit none (type, external)
  private

  public :: check_blocks

  !> Kind of the warning, apart from other warnings at the same word.
  integer, parameter :: warning_of_block = 1

  !> What a user may do whose link is longer than the way between its pins, of a link that bends
  !! too.
  character(len=*), parameter :: remedies(2) = [character(len=78) :: &
    " (if the link is longer, a POINT on its line says how far it reaches)", &
    " (if the link is longer, a further pin on its card says how far it reaches)"]

  !> Intervals that a message names.
  integer, parameter :: most_named = 3

contains

  !> A warning for every block that leaves its link at some positions of the deck, with the
  !! intervals; an error if it does so at all of them.
  pure subroutine check_blocks(model, mechanism, diagnostics)
    type(model_t), intent(in) :: model                !! without errors so far
    type(mechanism_t), intent(in) :: mechanism        !! of the model
    type(diagnostics_t), intent(inout) :: diagnostics !! to which errors and warnings are added

    real(wp) :: crank(size(model%crank%value)), excess(size(model%crank%value)), way
    character(len=:), allocatable :: words, remedy
    integer :: number, i

    crank = model%crank%value(ascending_order(model%crank%value))
    do number = 1, size(mechanism%linkage%sliders)
      associate (slider => mechanism%linkage%sliders(number))
        if (.not. slider%has_ends) cycle
        excess = [(excess_at(mechanism%linkage, number, crank(i)), i=1, size(crank))]
        if (.not. any(excess > 0.0_wp)) cycle
        way = slider%ends(2) - slider%ends(1)
        remedy = trim(remedies(merge(2, 1, needs_frequencies(model) .and. &
          mechanism%linkage%bodies(slider%body)%bends)))
        words = "the block at "//mechanism%pin_names(slider%pin)%text//" leaves '"// &
          mechanism%names(slider%body)%text//"'"
        if (all(excess > 0.0_wp)) then
          call add_error(diagnostics, model%sliders(number)%on, words// &
            " at all these positions, by "//length_text(model, minval(excess), 4)//" or more"// &
            remedy, kind=error_of_reach)
        else
          call add_warning(diagnostics, model%sliders(number)%on, words//" between "// &
            word_of_positions(model)//" "// &
            intervals(model, mechanism%linkage, number, crank, excess)//", by up to "// &
            length_text(model, maxval(excess), 4)//": "//plural(count(excess > 0.0_wp), &
            "position")//" will be marked as failed"//remedy, kind=warning_of_block, &
            amount=maxval(excess)/way)
        end if
      end associate
    end do
  end subroutine check_blocks

  !> How far the block of a slider is beyond an end of its link; 0 where it is not, or where the
  !! linkage cannot be placed at all [m].
  pure function excess_at(linkage, number, crank) result(excess)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: number !! of the slider
    real(wp), intent(in) :: crank !! [deg] or [m]
    real(wp) :: excess

    type(pose_t) :: pose
    type(error_t), allocatable :: error
    real(wp) :: place

    excess = 0.0_wp
    call place_links(linkage, crank, pose, error)
    if (.not. allocated(error)) return
    ! Of all errors only that about a block leaves a pose, and it is about any of the blocks.
    if (error%place%pin == 0) return
    place = coordinate_value(linkage, pose, slider_coordinate(linkage, number))
    associate (ends => linkage%sliders(number)%ends)
      excess = max(ends(1) - place, place - ends(2))
      if (excess <= 1.0e-9_wp*(ends(2) - ends(1))) excess = 0.0_wp
    end associate
  end function excess_at

  !> `200.4 and 230.1, 310 and 320`: where the block is beyond an end, from and to.
  pure function intervals(model, linkage, number, crank, excess) result(words)
    type(model_t), intent(in) :: model
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: number      !! of the slider
    real(wp), intent(in) :: crank(:)   !! ascending [deg] or [m]
    real(wp), intent(in) :: excess(:)  !! at these positions [m]
    character(len=:), allocatable :: words

    real(wp) :: from, to
    integer :: first, last, found

    words = ""
    found = 0
    last = 0
    do
      first = last + findloc(excess(last + 1:) > 0.0_wp, .true., dim=1)
      if (first == last) exit
      last = first
      do while (last < size(crank))
        if (.not. excess(last + 1) > 0.0_wp) exit
        last = last + 1
      end do
      found = found + 1
      if (found > most_named) cycle
      from = crank(first)
      to = crank(last)
      if (first > 1) from = edge(linkage, number, crank(first), crank(first - 1))
      if (last < size(crank)) to = edge(linkage, number, crank(last), crank(last + 1))
      if (found > 1) words = words//", "
      words = words//crank_text(model, from, 5)//" and "//crank_text(model, to, 5)
    end do
    if (found > most_named) words = words//" and in "//plural(found - most_named, "other interval")
  end function intervals

  !> Where the block comes to the end of its link, by bisection.
  pure function edge(linkage, number, beyond, inside) result(crank)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: number          !! of the slider
    real(wp), intent(in) :: beyond, inside !! positions [deg] or [m]
    real(wp) :: crank

    real(wp) :: middle, other
    integer :: i

    crank = beyond
    other = inside
    do i = 1, 50
      middle = 0.5_wp*(crank + other)
      if (excess_at(linkage, number, middle) > 0.0_wp) then
        crank = middle
      else
        other = middle
      end if
    end do
  end function edge

end module block_checks
