!> Dyads that place a pin: two loci, circles about known pins or known lines.
module plan_dyads
  use body_axes, only: has_pin, rebase
  use kinds, only: wp
  use linkages, only: cross, demands_angle, demands_length, group_t, groups_dyad, groups_on_line, &
    groups_two_lines, linkage_t
  use plan_equations, only: drive_of_length, line_equation, pin_equation
  use plan_problems, only: plan_problem_t, problem_no_side, problem_other_bases
  use plan_progress, only: append_group, carry_rest, known_pin, line_is_known, progress_t
  use plan_sides, only: drawn_line, report_side, side_t
  implicit none (type, external)
  private

  public :: take_meeting

contains

  !> A pin with two loci: bodies on known pins, known lines. The first such pin in the order of the
  !! bodies, or of the sliders.
  pure subroutine take_meeting(linkage, sides, done, problem, has_found)
    type(linkage_t), intent(inout) :: linkage
    type(side_t), intent(in) :: sides(:)
    type(progress_t), intent(inout) :: done
    type(plan_problem_t), allocatable, intent(inout) :: problem
    logical, intent(out) :: has_found

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
      if (size(lines) < 2) last = bodies(2 - size(lines))
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
      call place_on_line(linkage, sides, best, bodies(1), lines(1), done, problem)
    else
      call place_dyad(linkage, sides, best, bodies(:2), done, problem)
    end if
  end subroutine take_meeting

  !> The bodies on known pins, and the known lines, on which a pin lies.
  pure subroutine find_loci(linkage, done, pin, bodies, lines)
    type(linkage_t), intent(in) :: linkage
    type(progress_t), intent(in) :: done
    integer, intent(in) :: pin
    integer, allocatable, intent(out) :: bodies(:)
    integer, allocatable, intent(out) :: lines(:)

    integer :: b, s

    allocate (bodies(0), lines(0))
    do b = 1, size(linkage%bodies)
      if (done%body(b)) cycle
      if (drive_of_length(linkage, b) > 0) cycle
      if (known_pin(linkage, b, done) > 0 .and. has_pin(linkage%bodies(b), pin)) bodies = &
        [bodies, b]
    end do
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

    group%kind = groups_two_lines
    group%pins = [pin]
    group%slider = lines(:2)
    allocate (group%bodies(0), group%loaded(0), group%equations(2))
    group%equations(1) = line_equation(lines(1))
    group%equations(2) = line_equation(lines(2))
    done%slider(lines(:2)) = .true.
    done%pin(pin) = .true.
    call append_group(linkage, group)
  end subroutine place_on_two_lines

  !> RRP: a body on a known pin, with another one of its pins on a known line.
  pure subroutine place_on_line(linkage, sides, pin, body, line, done, problem)
    type(linkage_t), intent(inout) :: linkage
    type(side_t), intent(in) :: sides(:)
    integer, intent(in) :: pin, body, line
    type(progress_t), intent(inout) :: done
    type(plan_problem_t), allocatable, intent(inout) :: problem

    type(group_t) :: group
    real(wp) :: direction(2)
    logical :: is_known
    integer :: base, number

    base = known_pin(linkage, body, done)
    call rebase(linkage, body, base, pin)
    done%order = [done%order, body]
    group%kind = groups_on_line
    group%base(1) = base
    group%middle = pin
    group%body(1) = body
    group%slider(1) = line
    group%pins = [pin]
    group%bodies = [body]
    group%loaded = [body]
    allocate (group%equations(3))
    group%equations(1) = pin_equation(linkage, demands_length, body, pin)
    group%equations(2) = pin_equation(linkage, demands_angle, body, pin)
    group%equations(3) = line_equation(line)
    number = findloc(sides%pin, pin, dim=1)
    is_known = .false.
    if (number > 0) then
      if (any(sides(number)%base > 0)) then
        call report_side(problem, problem_other_bases, pin, [base, pin], number, .true.)
        return
      end if
      group%side = sides(number)%side
      is_known = .true.
    else if (all(linkage%drawing%is_drawn([base, pin]))) then
      call drawn_line(linkage, line, direction, is_known)
      if (is_known) group%side = sign(1.0_wp, dot_product(direction, linkage%drawing%pin(:, pin) - &
        linkage%drawing%pin(:, base)))
    end if
    if (.not. is_known) call report_side(problem, problem_no_side, pin, [base, pin], 0, .true.)
    done%slider(line) = .true.
    done%pin(pin) = .true.
    done%body(body) = .true.
    call append_group(linkage, group)
    call carry_rest(linkage, body, [pin], done)
  end subroutine place_on_line

  !> RRR: two bodies on known pins that meet.
  pure subroutine place_dyad(linkage, sides, pin, bodies, done, problem)
    type(linkage_t), intent(inout) :: linkage
    type(side_t), intent(in) :: sides(:)
    integer, intent(in) :: pin
    integer, intent(in) :: bodies(2)
    type(progress_t), intent(inout) :: done
    type(plan_problem_t), allocatable, intent(inout) :: problem

    type(group_t) :: group
    integer :: k, number

    group%kind = groups_dyad
    group%middle = pin
    group%body = bodies
    group%base = [(known_pin(linkage, bodies(k), done), k=1, 2)]
    ! A moving base first: a four-bar's way round runs from the crank.
    if (linkage%is_ground(group%base(1)) .and. .not. linkage%is_ground(group%base(2))) then
      group%body = group%body([2, 1])
      group%base = group%base([2, 1])
    end if
    call rebase(linkage, group%body(1), group%base(1), pin)
    call rebase(linkage, group%body(2), pin, group%base(2))
    done%order = [done%order, group%body]
    number = findloc(sides%pin, pin, dim=1)
    if (number > 0) then
      associate (side => sides(number))
        if (all(side%base == group%base)) then
          group%side = side%side
        else if (all(side%base == group%base([2, 1]))) then
          group%side = -side%side
        else
          call report_side(problem, problem_other_bases, pin, group%base, number, .false.)
          return
        end if
      end associate
    else if (all(linkage%drawing%is_drawn([group%base, pin]))) then
      associate (at => linkage%drawing%pin)
        group%side = sign(1.0_wp, cross(at(:, group%base(2)) - at(:, group%base(1)), at(:, pin) - &
          at(:, group%base(1))))
      end associate
    else
      call report_side(problem, problem_no_side, pin, group%base, 0, .false.)
      return
    end if
    done%pin(pin) = .true.
    done%body(group%body) = .true.
    call append_group(linkage, group)
    call carry_rest(linkage, group%body(1), [pin], done)
    call carry_rest(linkage, group%body(2), [group%base(2)], done)
  end subroutine place_dyad

end module plan_dyads
