!> Positions of a deck that are out of reach, of any linkage.
module reach_checks
  use crank_limits, only: crank_range_t, find_ranges_of_deck
  use deck_lengths, only: crank_text, in_deck, unit_of_crank
  use diagnostics, only: add_error, add_warning, diagnostics_t
  use drawn_cranks, only: starting_cranks
  use errors, only: error_of_reach, error_t
  use kinds, only: wp
  use mechanisms, only: mechanism_t
  use models, only: drives_length, has_law, model_t, runs_in_time
  use pose_types, only: pose_t
  use poses, only: place_links
  use reach_texts, only: reach_words
  use text, only: plural, to_string
  use value_lists, only: value_list_t
  implicit none (type, external)
  private

  public :: check_reach, interval_words, reachable_intervals

contains

  !> An error if the linkage closes at none of some positions, else a warning: how many are out of
  !! reach, what does not reach at the first of them, where the linkage closes and, where none is in
  !! reach, where it is drawn; with a CRANK card. Blocks that leave their links are not counted:
  !! they have messages of their own.
  pure subroutine check_reach(model, mechanism, crank, leaving, diagnostics)
    type(model_t), intent(in) :: model                !! without errors so far
    type(mechanism_t), intent(in) :: mechanism        !! of this model, that closes somewhere
    type(value_list_t), intent(in) :: crank           !! the positions [deg] or [m]
    integer, intent(out) :: leaving                   !! positions at which a block leaves its link
    type(diagnostics_t), intent(inout) :: diagnostics !! to which it is added

    type(error_t), allocatable :: error
    type(pose_t) :: pose
    character(len=:), allocatable :: why, where
    logical :: closes(size(crank%value))
    integer :: i, out_of_reach, first

    out_of_reach = 0
    leaving = 0
    first = 0
    do i = 1, size(closes)
      call place_links(mechanism%linkage, crank%value(i), pose, error)
      closes(i) = .true.
      if (.not. allocated(error)) cycle
      closes(i) = error%kind /= error_of_reach
      if (closes(i)) cycle
      if (error%place%pin > 0) then
        leaving = leaving + 1
        cycle
      end if
      out_of_reach = out_of_reach + 1
      if (first > 0) cycle
      first = i
      why = reach_words(model, mechanism, error)
      if (len(why) > 0) why = ": "//why
    end do
    if (out_of_reach == 0) return
    call say_where(model, mechanism, crank, closes, where)
    if (out_of_reach + leaving == size(closes)) then
      call add_error(diagnostics, crank%words(crank%word(first)), "the linkage closes at none "// &
        "of these positions, at "//crank_text(model, crank%value(first), 10)//" "// &
        unit_of_crank(model)//why//where, kind=error_of_reach)
    else
      call add_warning(diagnostics, crank%words(crank%word(first)), &
        plural(out_of_reach, "position")//" of "//to_string(size(closes))// &
        " out of reach, the first at "//crank_text(model, crank%value(first), 10)//" "// &
        unit_of_crank(model)//why//where)
    end if
  end subroutine check_reach

  !> Where a linkage closes, and is drawn if no position closes, with a CRANK card.
  pure subroutine say_where(model, mechanism, crank, closes, words)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(value_list_t), intent(in) :: crank
    logical, intent(in) :: closes(:) !! (positions)
    character(len=:), allocatable, intent(out) :: words

    real(wp), allocatable :: drawn(:), limits(:, :)

    words = ""
    if (runs_in_time(model)) return
    drawn = starting_cranks(model, mechanism%linkage)
    limits = reachable_intervals(mechanism, [pack(crank%value, closes), drawn(:1)], crank%value)
    if (size(limits) == 0) return
    words = "; the linkage closes "//interval_words(model, limits)
    if (.not. any(closes) .and. any(mechanism%linkage%drawing%is_drawn .and. .not. &
      mechanism%linkage%is_ground)) words = words//", and is drawn at "//crank_text(model, &
      drawn(1), 7)//" "//unit_of_crank(model)
    if (.not. has_law(model)) words = words//": "//ready_card(model, limits, step_of(crank))
  end subroutine say_where

  !> The intervals of the first drive in which a linkage closes, in the turns of some positions.
  pure function reachable_intervals(mechanism, inside, positions) result(limits)
    type(mechanism_t), intent(in) :: mechanism  !! any
    real(wp), intent(in) :: inside(:)           !! of a driven length intervals about these are
                                                !! found [deg] or [m]
    real(wp), intent(in) :: positions(:)        !! [deg] or [m]
    real(wp), allocatable :: limits(:, :)       !! (2, intervals), none if it turns fully

    type(crank_range_t), allocatable :: ranges(:)

    call find_ranges_of_deck(mechanism%linkage, inside, positions, ranges)
    ranges = pack(ranges, .not. ranges%turns)
    allocate (limits(2, size(ranges)))
    limits(1, :) = ranges%from
    limits(2, :) = ranges%to
  end function reachable_intervals

  !> `between -83.1 and 83.1 deg and between 110 and 140 deg`
  pure function interval_words(model, limits) result(words)
    type(model_t), intent(in) :: model      !! its units
    real(wp), intent(in) :: limits(:, :)    !! (2, intervals) [deg] or [m]
    character(len=:), allocatable :: words

    integer :: i

    words = ""
    do i = 1, size(limits, 2)
      if (i > 1) words = words//" and "
      words = words//"between "//crank_text(model, cleared(limits(1, i)), 7)//" and "// &
        crank_text(model, cleared(limits(2, i)), 7)
    end do
    words = words//" "//unit_of_crank(model)
  end function interval_words

  !> A limit at 0 without its rounding.
  pure function cleared(limit) result(value)
    real(wp), intent(in) :: limit
    real(wp) :: value

    real(wp), parameter :: rounding = 1.0e-9_wp

    value = limit
    if (abs(limit) < rounding) value = 0.0_wp
  end function cleared

  !> The step that the user has in mind: that of the first range; 0: none is known.
  pure function step_of(crank) result(step)
    type(value_list_t), intent(in) :: crank
    real(wp) :: step !! [deg] or [m]

    step = 0.0_wp
    if (size(crank%value) < 2) return
    if (crank%word(1) == crank%word(2)) step = abs(crank%value(2) - crank%value(1))
  end function step_of

  !> The reachable positions as a CRANK card. It keeps off the limits: these are dead points, and
  !! near them frequencies fade.
  pure function ready_card(model, limits, step) result(card)
    type(model_t), intent(in) :: model
    real(wp), intent(in) :: limits(:, :) !! (2, intervals) [deg] or [m]
    real(wp), intent(in) :: step         !! [deg] or [m]; 0: none is known
    character(len=:), allocatable :: card

    real(wp) :: ends(2), own_step, grid
    integer :: i

    card = "CRANK"
    do i = 1, size(limits, 2)
      if (drives_length(model)) then
        ends = [in_deck(model, limits(1, i)), in_deck(model, limits(2, i))]
        ! Hundredths of the range, in round numbers.
        grid = 10.0_wp**ceiling(2.0_wp - log10(ends(2) - ends(1)))
        own_step = in_deck(model, step)
        if (step <= 0.0_wp) own_step = 10.0_wp/grid
      else
        ends = limits(:, i)
        grid = merge(1.0_wp, 10.0_wp, ends(2) - ends(1) > 10.0_wp)
        own_step = merge(step, 5.0_wp, step > 0.0_wp)
      end if
      card = card//" "//interval(ends, own_step, grid)
    end do
  end function ready_card

  !> `a to b step s`, half a grid step or more inside the limits; in a tiny interval the middle
  !! alone.
  pure function interval(ends, step, grid) result(words)
    real(wp), intent(in) :: ends(2), step
    real(wp), intent(in) :: grid !! steps a unit
    character(len=:), allocatable :: words

    real(wp) :: first, last

    first = aint_up(ends(1)*grid + 0.5_wp)
    last = -aint_up(-(ends(2)*grid - 0.5_wp))
    if (first < last) then
      words = to_string(first/grid, 9)//" to "//to_string(last/grid, 9)//" step "//to_string(step)
    else
      words = to_string(0.5_wp*sum(ends), 12)
    end if
  end function interval

  !> The next whole number at or above a value.
  pure function aint_up(value) result(whole)
    real(wp), intent(in) :: value
    real(wp) :: whole

    whole = aint(value)
    if (whole < value) whole = whole + 1.0_wp
  end function aint_up

end module reach_checks
