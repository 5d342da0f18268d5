!> The drawing of a linkage: what follows from the pins that are drawn.
!!
!! Drawn pins are taken for ground pivots, and all is planned that has one place then: bodies
!! between two of them, bodies that turn with others, pins on two lines. What the first drive moves,
!! and is not in the drawing, is at the first position of the deck.
module drawn_places
  use errors, only: error_t
  use group_places, only: place_group
  use kinds, only: wp
  use linkages, only: linkage_t
  use plan_dyads, only: take_crossing
  use plan_progress, only: new_progress, progress_t
  use plan_sliding_bodies, only: take_cross_slide
  use plan_turned_bodies, only: take_drives, take_spanned, take_turns
  use pose_types, only: pose_t
  implicit none (type, external)
  private

  public :: complete_drawing, needed_places

contains

  !> Draws the pins whose places follow.
  pure subroutine complete_drawing(linkage, cranks)
    type(linkage_t), intent(inout) :: linkage !! parts without groups, and a drawing
    real(wp), intent(in) :: cranks(:)         !! positions of the deck [deg] or [m]

    type(linkage_t) :: drawn
    type(progress_t) :: done
    type(pose_t) :: pose
    type(error_t), allocatable :: error
    real(wp) :: sine, crank
    integer :: g

    call plan_from_drawing(linkage, size(cranks) > 0, drawn, done)
    crank = 0.0_wp
    if (size(cranks) > 0) crank = cranks(1)
    pose%pin = linkage%drawing%pin
    allocate (pose%direction(2, size(linkage%bodies)))
    pose%direction = 0.0_wp
    linkage%drawing%follows = linkage%drawing%is_drawn
    do g = 1, size(drawn%groups)
      associate (group => drawn%groups(g))
        call place_group(drawn, group, group%side, crank, pose, sine, error)
        ! Pins at one place, parallel lines: the drawing ends here.
        if (allocated(error)) exit
        linkage%drawing%is_drawn(group%pins) = .true.
        linkage%drawing%pin(:, group%pins) = pose%pin(:, group%pins)
      end associate
    end do
    linkage%drawing%follows = linkage%drawing%is_drawn .and. .not. linkage%drawing%follows
  end subroutine complete_drawing

  !> Those of some pins that have to be drawn, so that all of them are: of several that would do,
  !! the first. Where they all would follow, but for a drawing with pins at one place, all.
  pure function needed_places(linkage, pins) result(needed)
    type(linkage_t), intent(in) :: linkage !! with its drawing
    integer, intent(in) :: pins(:)         !! numbers; not drawn
    integer, allocatable :: needed(:)

    type(linkage_t) :: trial, drawn
    type(progress_t) :: done
    integer :: i

    trial = linkage
    trial%drawing%is_drawn(pins) = .true.
    do i = size(pins), 1, -1
      trial%drawing%is_drawn(pins(i)) = .false.
      call plan_from_drawing(trial, .true., drawn, done)
      trial%drawing%is_drawn(pins(i)) = .not. done%pin(pins(i))
    end do
    needed = pack(pins, trial%drawing%is_drawn(pins))
    if (size(needed) == 0) needed = pins
  end function needed_places

  !> The groups that place what follows.
  pure subroutine plan_from_drawing(linkage, has_positions, drawn, done)
    type(linkage_t), intent(in) :: linkage
    logical, intent(in) :: has_positions     !! the first drive has any
    type(linkage_t), intent(out) :: drawn    !! whose ground pivots are the drawn pins
    type(progress_t), intent(out) :: done    !! what is drawn or follows

    logical :: may_move(size(linkage%drives)), has_found

    drawn = linkage
    if (allocated(drawn%groups)) deallocate (drawn%groups)
    if (allocated(drawn%redundancies)) deallocate (drawn%redundancies)
    allocate (drawn%groups(0), drawn%redundancies(0))
    drawn%has_crank = .false.
    drawn%is_ground = linkage%drawing%is_drawn
    drawn%ground_position = linkage%drawing%pin
    done = new_progress(drawn)
    ! Drives that stand still are where they are; others wait for what the drawing shows.
    may_move = .not. done%drive
    done%drive = done%drive .or. abs(linkage%drives%ratio) > 0.0_wp
    do
      call take_spanned(drawn, done, has_found)
      if (.not. has_found) call take_turns(drawn, done, has_found)
      if (.not. has_found) call take_crossing(drawn, done, has_found)
      if (.not. has_found) call take_cross_slide(drawn, done, has_found)
      if (.not. has_found) call take_drives(drawn, done, has_found)
      if (has_found) cycle
      if (.not. has_positions .or. .not. any(may_move) .or. shows_first_drive(drawn, done)) exit
      done%drive = .not. may_move
      may_move = .false.
    end do
  end subroutine plan_from_drawing

  !> Whether the drawing shows where the first drive is: then it is not at a position of the deck.
  pure function shows_first_drive(linkage, done) result(shows)
    type(linkage_t), intent(in) :: linkage
    type(progress_t), intent(in) :: done
    logical :: shows

    associate (drive => linkage%drives(1))
      if (drive%slider > 0) then
        shows = done%pin(linkage%sliders(drive%slider)%pin)
      else
        shows = .false.
        if (drive%body > 0) shows = done%body(drive%body)
      end if
    end associate
  end function shows_first_drive

end module drawn_places
