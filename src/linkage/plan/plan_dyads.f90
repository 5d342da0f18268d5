!> Dyads that place a pin: two loci, circles about known pins or known lines.
module plan_dyads
  use body_axes, only: choose_pins, has_pin
  use linkages, only: demand_angle, group_t, group_driven_dyad, group_dyad, group_on_line, &
    group_two_lines, linkage_t
  use plan_equations, only: length_drive, length_equation, line_equation, pin_equation
  use plan_progress, only: append_group, carry_rest, known_pin, line_is_known, progress_t
  use plan_sides, only: choose_side, side_t
  implicit none (type, external)
  private

  public :: take_meeting, take_crossing

contains

  !> A pin with two loci: bodies on known pins, known lines. The first such pin in the order of the
  !! bodies, or of the sliders.
  pure subroutine take_meeting(linkage, sides, done, has_found)
    type(linkage_t), intent(inout) :: linkage !! to whose groups the first such is added
    type(side_t), intent(in) :: sides(:)      !! of its pins
    type(progress_t), intent(inout) :: done   !! what is placed
    logical, intent(out) :: has_found         !! whether there is any

    integer, allocatable :: bodies(:), lines(:)
    integer :: p, last, best, least

    ! What the deck lists first places pins; of links that would do as well, the last is redundant.
    best = 0
    least = huge(least)
    do p = 1, size(done%pin)
      if (done%pin(p)) cycle
      call find_loci(linkage, done, p, bodies, lines)
      if (size(bodies) + size(lines) < 2) cycle
      last = 0
      if (size(lines) < 2) last = deck_order(linkage, bodies(2 - size(lines)))
      if (last >= least) cycle
      best = p
      least = last
    end do
    has_found = best > 0
    if (.not. has_found) return
    call find_loci(linkage, done, best, bodies, lines)
    if (size(lines) >= 2) then
      call place_on_two_lines(linkage, best, lines, done)
    else if (size(lines) == 1) then
      call place_on_line(linkage, sides, best, bodies(1), lines(1), done)
    else
      call place_dyad(linkage, sides, best, bodies(:2), done)
    end if
  end subroutine take_meeting

  !> The first pin on two known lines.
  pure subroutine take_crossing(linkage, done, has_found)
    type(linkage_t), intent(inout) :: linkage !! to whose groups it is added
    type(progress_t), intent(inout) :: done   !! what is placed
    logical, intent(out) :: has_found         !! whether there is any

    integer, allocatable :: bodies(:), lines(:)
    integer :: p

    has_found = .false.
    do p = 1, size(done%pin)
      if (done%pin(p)) cycle
      call find_loci(linkage, done, p, bodies, lines)
      has_found = size(lines) >= 2
      if (.not. has_found) cycle
      call place_on_two_lines(linkage, p, lines, done)
      return
    end do
  end subroutine take_crossing

  !> The place of a body in the order of the deck, rams behind all others.
  pure function deck_order(linkage, body)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: body
    integer :: deck_order

    deck_order = body
    if (length_drive(linkage, body) > 0) deck_order = body + size(linkage%bodies)
  end function deck_order

  !> The bodies on known pins, and the known lines, on which a pin lies. Rams come last: a drive
  !! that moves nothing is told, and no link blamed for it.
  pure subroutine find_loci(linkage, done, pin, bodies, lines)
    type(linkage_t), intent(in) :: linkage
    type(progress_t), intent(in) :: done
    integer, intent(in) :: pin
    integer, allocatable, intent(out) :: bodies(:)
    integer, allocatable, intent(out) :: lines(:)

    integer, allocatable :: rams(:)
    integer :: b, s

    allocate (bodies(0), rams(0), lines(0))
    do b = 1, size(linkage%bodies)
      if (done%body(b) .or. .not. has_pin(linkage%bodies(b), pin)) cycle
      if (known_pin(linkage, b, done) == 0) cycle
      if (length_drive(linkage, b) > 0) then
        rams = [rams, b]
      else
        bodies = [bodies, b]
      end if
    end do
    bodies = [bodies, rams]
    do s = 1, size(linkage%sliders)
      if (done%slider(s) .or. linkage%sliders(s)%pin /= pin) cycle
      if (line_is_known(linkage, s, done)) lines = [lines, s]
    end do
  end subroutine find_loci

  !> PRP: a pin on two lines.
  pure subroutine place_on_two_lines(linkage, pin, lines, done)
    type(linkage_t), intent(inout) :: linkage
    integer, intent(in) :: pin
    integer, intent(in) :: lines(:)
    type(progress_t), intent(inout) :: done

    type(group_t) :: group

    group%kind = group_two_lines
    group%pins = [pin]
    group%slider = lines(:2)
    allocate (group%bodies(0), group%loaded(0), group%equations(2))
    group%equations(1) = line_equation(linkage, lines(1))
    group%equations(2) = line_equation(linkage, lines(2))
    done%slider(lines(:2)) = .true.
    done%pin(pin) = .true.
    call append_group(linkage, group)
  end subroutine place_on_two_lines

  !> RRP: a body on a known pin, with another one of its pins on a known line.
  pure subroutine place_on_line(linkage, sides, pin, body, line, done)
    type(linkage_t), intent(inout) :: linkage
    type(side_t), intent(in) :: sides(:)
    integer, intent(in) :: pin, body, line
    type(progress_t), intent(inout) :: done

    type(group_t) :: group

    group%kind = group_on_line
    group%base(1) = known_pin(linkage, body, done)
    group%middle = pin
    group%body(1) = body
    group%slider(1) = line
    group%pins = [pin]
    group%bodies = [body]
    group%loaded = [body]
    call choose_pins(linkage, body, group%base(1), pin)
    allocate (group%equations(3))
    group%equations(1) = length_equation(linkage, body, pin)
    group%equations(2) = pin_equation(linkage, demand_angle, body, pin)
    group%equations(3) = line_equation(linkage, line)
    call choose_side(linkage, sides, group)
    done%slider(line) = .true.
    call record_dyad(linkage, group, done)
    call carry_rest(linkage, body, [pin], done)
  end subroutine place_on_line

  !> RRR: two bodies on known pins that meet.
  pure subroutine place_dyad(linkage, sides, pin, bodies, done)
    type(linkage_t), intent(inout) :: linkage
    type(side_t), intent(in) :: sides(:)
    integer, intent(in) :: pin
    integer, intent(in) :: bodies(2)
    type(progress_t), intent(inout) :: done

    type(group_t) :: group
    integer :: k

    group%kind = group_dyad
    group%middle = pin
    group%body = bodies
    group%base = [(known_pin(linkage, bodies(k), done), k=1, 2)]
    ! A moving base first: a four-bar's way round runs from the crank.
    if (linkage%is_ground(group%base(1)) .and. .not. linkage%is_ground(group%base(2))) then
      group%body = group%body([2, 1])
      group%base = group%base([2, 1])
    end if
    call choose_side(linkage, sides, group)
    call choose_pins(linkage, group%body(1), group%base(1), pin)
    if (any([(length_drive(linkage, bodies(k)) > 0, k=1, 2)])) then
      call choose_pins(linkage, group%body(2), group%base(2), pin)
      call write_driven_dyad(linkage, group)
    else
      call choose_pins(linkage, group%body(2), pin, group%base(2))
    end if
    call record_dyad(linkage, group, done)
    call carry_rest(linkage, group%body(1), [pin], done)
    call carry_rest(linkage, group%body(2), [pin, group%base(2)], done)
  end subroutine place_dyad

  !> The pins, bodies and equations of a dyad with driven lengths: each body runs from its base.
  pure subroutine write_driven_dyad(linkage, group)
    type(linkage_t), intent(in) :: linkage
    type(group_t), intent(inout) :: group

    integer :: k

    group%kind = group_driven_dyad
    group%pins = [group%middle]
    group%bodies = group%body
    group%loaded = group%body
    allocate (group%equations(4))
    do k = 1, 2
      group%equations(2*k - 1) = length_equation(linkage, group%body(k), group%middle)
      group%equations(2*k) = pin_equation(linkage, demand_angle, group%body(k), group%middle)
    end do
  end subroutine write_driven_dyad

  !> The middle and the bodies of a dyad are placed, and its drives used.
  pure subroutine record_dyad(linkage, group, done)
    type(linkage_t), intent(inout) :: linkage
    type(group_t), intent(in) :: group
    type(progress_t), intent(inout) :: done

    integer, allocatable :: bodies(:)
    integer :: k, drive

    bodies = pack(group%body, group%body > 0)
    done%pin(group%middle) = .true.
    done%body(bodies) = .true.
    done%order = [done%order, bodies]
    do k = 1, size(bodies)
      drive = length_drive(linkage, bodies(k))
      if (drive > 0) done%drive(drive) = .true.
    end do
    call append_group(linkage, group)
  end subroutine record_dyad

end module plan_dyads
