!> Groups with one place only: what drives move, what turns with another body, and bodies between
!! two pins that are placed.
module plan_turned_bodies
  use body_axes, only: choose_pins, other_pin
  use linkages, only: demand_angle, demand_length, drive_of_angle, drive_of_slider, equation_t, &
    group_t, group_placed, group_spanned, group_turned, linkage_t
  use plan_equations, only: append_equation, drive_equation, length_drive, is_used, &
    line_equation, pin_equation, turn_equation
  use plan_progress, only: append_group, carry_rest, known_pin, line_is_known, progress_t, turned_by
  use pose_types, only: pins_of_body
  implicit none (type, external)
  private

  public :: take_crank, take_drives, take_turns, take_spanned

contains

  !> The first drive, where it turns a body about a ground pivot.
  pure subroutine take_crank(linkage, done)
    type(linkage_t), intent(inout) :: linkage !! to whose groups it is added, if it is not its crank
    type(progress_t), intent(inout) :: done   !! nothing but the ground pivots

    integer :: crank, pivot
    integer, allocatable :: pins(:)

    if (size(linkage%drives) == 0) return
    associate (drive => linkage%drives(1))
      if (drive%kind /= drive_of_angle .or. drive%against > 0) return
      crank = drive%body
    end associate
    pins = pins_of_body(linkage%bodies(crank))
    if (.not. any(linkage%is_ground(pins))) return
    pivot = pins(findloc(linkage%is_ground(pins), .true., dim=1))
    call choose_pins(linkage, crank, pivot, other_pin(linkage%bodies(crank), pivot))
    ! The linkage proper has its crank first; before it is put in order another body may be.
    linkage%has_crank = crank == 1
    done%drive(1) = .true.
    done%order = [crank]
    if (linkage%has_crank) then
      done%body(1) = .true.
      done%pin(linkage%bodies(1)%last_pin) = .true.
      call carry_rest(linkage, crank, [linkage%bodies(1)%last_pin], done)
    else
      call turn_body(linkage, crank, drive_equation(linkage, 1), done)
    end if
  end subroutine take_crank

  !> A driven angle of a body on a known pin; a driven slider on a known line.
  pure subroutine take_drives(linkage, done, has_found)
    type(linkage_t), intent(inout) :: linkage !! to whose groups the first such is added
    type(progress_t), intent(inout) :: done   !! what is placed
    logical, intent(out) :: has_found         !! whether there is any

    integer :: d

    has_found = .false.
    do d = 1, size(linkage%drives)
      if (done%drive(d)) cycle
      if (linkage%drives(d)%kind == drive_of_angle) call turn_driven_body(linkage, d, done, &
        has_found)
      if (linkage%drives(d)%kind == drive_of_slider) call place_driven_slider(linkage, d, done, &
        has_found)
      if (has_found) return
    end do
  end subroutine take_drives

  !> The body of a drive, if it is on a known pin and its angle counts from what is placed.
  pure subroutine turn_driven_body(linkage, number, done, has_found)
    type(linkage_t), intent(inout) :: linkage
    integer, intent(in) :: number !! of the drive
    type(progress_t), intent(inout) :: done
    logical, intent(inout) :: has_found

    integer :: body, against

    body = linkage%drives(number)%body
    against = linkage%drives(number)%against
    if (done%body(body)) return
    if (against > 0) then
      if (.not. done%body(against)) return
    end if
    call turn_on_known_pin(linkage, body, drive_equation(linkage, number), done, has_found)
    if (has_found) done%drive(number) = .true.
  end subroutine turn_driven_body

  !> A body that an equation turns about one of its pins, if any of them is placed.
  pure subroutine turn_on_known_pin(linkage, body, equation, done, has_found)
    type(linkage_t), intent(inout) :: linkage
    integer, intent(in) :: body
    type(equation_t), intent(in) :: equation !! that gives its angle
    type(progress_t), intent(inout) :: done
    logical, intent(inout) :: has_found

    integer :: pin

    pin = known_pin(linkage, body, done)
    if (pin == 0) return
    call choose_pins(linkage, body, pin, other_pin(linkage%bodies(body), pin))
    done%order = [done%order, body]
    call turn_body(linkage, body, equation, done)
    has_found = .true.
  end subroutine turn_on_known_pin

  !> The pin of a slider that is driven, if its line is known.
  pure subroutine place_driven_slider(linkage, number, done, has_found)
    type(linkage_t), intent(inout) :: linkage
    integer, intent(in) :: number !! of the drive
    type(progress_t), intent(inout) :: done
    logical, intent(inout) :: has_found

    type(group_t) :: group
    integer :: slider, pin

    slider = linkage%drives(number)%slider
    pin = linkage%sliders(slider)%pin
    if (done%slider(slider) .or. done%pin(pin)) return
    if (.not. line_is_known(linkage, slider, done)) return
    group%kind = group_placed
    group%pins = [pin]
    group%slider(1) = slider
    allocate (group%bodies(0), group%loaded(0), group%equations(2))
    group%equations(1) = drive_equation(linkage, number)
    group%equations(2) = line_equation(linkage, slider)
    done%pin(pin) = .true.
    done%slider(slider) = .true.
    done%drive(number) = .true.
    call append_group(linkage, group)
    has_found = .true.
  end subroutine place_driven_slider

  !> A body that a drive, or another body, turns about its first pin.
  pure subroutine turn_body(linkage, body, equation, done)
    type(linkage_t), intent(inout) :: linkage
    integer, intent(in) :: body
    type(equation_t), intent(in) :: equation !! that gives its angle
    type(progress_t), intent(inout) :: done

    type(group_t) :: group

    group%kind = group_turned
    group%base(1) = linkage%bodies(body)%first_pin
    group%body(1) = body
    allocate (group%pins(0), group%equations(1))
    group%bodies = [body]
    group%loaded = [body]
    group%equations(1) = equation
    done%body(body) = .true.
    call append_group(linkage, group)
    call carry_rest(linkage, body, [integer ::], done)
  end subroutine turn_body

  !> A body on a known pin that turns with a body that is placed, or does not turn.
  pure subroutine take_turns(linkage, done, has_found)
    type(linkage_t), intent(inout) :: linkage !! to whose groups the first such is added
    type(progress_t), intent(inout) :: done   !! what is placed
    logical, intent(out) :: has_found         !! whether there is any

    integer :: t, body

    has_found = .false.
    do t = 1, size(linkage%turns)
      if (done%turn(t)) cycle
      body = turned_by(linkage, t, done)
      if (body == 0) cycle
      call turn_on_known_pin(linkage, body, turn_equation(linkage, t), done, has_found)
      if (.not. has_found) cycle
      done%turn(t) = .true.
      return
    end do
  end subroutine take_turns

  !> A body between two pins that are placed: its length is redundant. A ram is one between its ends
  !! only.
  pure subroutine take_spanned(linkage, done, has_found)
    type(linkage_t), intent(inout) :: linkage !! to whose groups the first such is added
    type(progress_t), intent(inout) :: done   !! what is placed
    logical, intent(out) :: has_found         !! whether there is any

    type(group_t) :: group
    integer, allocatable :: pins(:)
    integer :: b

    has_found = .false.
    do b = 1, size(linkage%bodies)
      if (done%body(b)) cycle
      pins = pins_of_body(linkage%bodies(b))
      pins = pack(pins, done%pin(pins))
      if (size(pins) < 2) cycle
      if (length_drive(linkage, b) > 0 .and. .not. all(done%pin([linkage%bodies(b)%first_pin, &
        linkage%bodies(b)%last_pin]))) cycle
      call choose_pins(linkage, b, pins(1), pins(2))
      done%order = [done%order, b]
      group%kind = group_spanned
      group%base(1) = pins(1)
      group%middle = pins(2)
      group%body(1) = b
      allocate (group%pins(0), group%equations(1))
      group%bodies = [b]
      group%loaded = [b]
      group%equations(1) = pin_equation(linkage, demand_angle, b, pins(2))
      ! A ram has no length of its own: its drive is what is redundant.
      if (length_drive(linkage, b) == 0 .and. .not. is_used(linkage, demand_length, b, &
        pins(2))) call append_equation(linkage%redundancies, pin_equation(linkage, &
        demand_length, b, pins(2)))
      done%body(b) = .true.
      call append_group(linkage, group)
      call carry_rest(linkage, b, [pins(2)], done)
      has_found = .true.
      return
    end do
  end subroutine take_spanned

end module plan_turned_bodies
