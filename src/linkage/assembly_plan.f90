!> The order in which a linkage is placed: groups of pins and bodies, each of which its equations
!! place from what is placed before.
!!
!! Dyads are recognized one after the other: two loci of a pin, circles about known pins or known
!! lines, place it. What is left where none can be is matched, equations with unknowns; the strongly
!! connected part that depends on nothing else is a group for iterations. What cannot be matched
!! tells which pins nothing holds. Equations that are fulfilled by what is placed already are
!! redundancies, to be checked at every position. The drives are used first, then parts in the order
!! of the deck: of several that would do, the last is the redundant one.
module assembly_plan
  use group_equations, only: unknowns_of
  use kinds, only: wp
  use linkages, only: body_t, cross, demands_angle, demands_drive, demands_length, demands_line, &
    demands_turn, drives_angle, drives_length, drives_slider, equation_t, group_t, &
    groups_by_newton, groups_carried, groups_cross_slide, groups_dyad, groups_on_line, &
    groups_placed, groups_spanned, groups_through_pin, groups_turned, groups_two_lines, linkage_t, &
    turned, turned_back
  use pose_types, only: pins_of_body, place_of_pin
  use unknown_matching, only: matching_t, match_unknowns, source_component
  implicit none (type, external)
  private

  public :: side_t, plan_problem_t, plan_linkage, rebase
  public :: problem_too_free, problem_braced, problem_coupler_driven, &
    problem_no_side, problem_other_bases, problem_drive_idle, problem_not_drawn

  !> What may be wrong: pins that nothing holds; a link that joins two pins of another one; a driven
  !! link that turns about no ground pivot; a dyad with neither a side nor a drawing; a side that
  !! names other pins than those that carry the dyad; a drive that moves nothing; pins that only a
  !! drawing can place.
  integer, parameter :: problem_too_free = 1, problem_braced = 2, &
    problem_coupler_driven = 3, problem_no_side = 4, problem_other_bases = 5, &
    problem_drive_idle = 6, problem_not_drawn = 7

  !> On which side a pin lies, of two ways to place it.
  type :: side_t
    integer :: pin = 0
    real(wp) :: side = 1.0_wp !! +1: to the left of base 1 → base 2, or forward on the line
    integer :: base(2) = 0    !! pins; 0: on a line
  end type side_t

  type :: plan_problem_t
    integer :: kind = 0              !! one of the problem_… constants
    integer :: mobility = 0          !! of the linkage
    integer, allocatable :: pins(:)  !! that it is about
    integer, allocatable :: bodies(:) !! that it is about
    integer :: number = 0            !! of a drive, or of a side; 0: of none
    logical :: on_line = .false.     !! the side is one on a line
  end type plan_problem_t

  !> What is placed so far.
  type :: progress_t
    logical, allocatable :: pin(:)      !! (pins) placed
    logical, allocatable :: body(:)     !! (bodies) turned and placed
    logical, allocatable :: slider(:)   !! (sliders) used
    logical, allocatable :: turn(:)     !! (turns) used
    logical, allocatable :: drive(:)    !! (drives) used
  end type progress_t

contains

  !> Plans the groups of a linkage, and chooses the first and last pins of its bodies.
  !!
  !! The order of bodies and pins that follows is that in which they are placed; a linkage in that
  !! order has the same plan.
  pure subroutine plan_linkage(linkage, sides, problem, body_order, pin_order)
    type(linkage_t), intent(inout) :: linkage !! bodies with all their pins, sliders, turns and
                                              !! drives, the drawing; groups are set
    type(side_t), intent(in) :: sides(:)      !! of its pins
    type(plan_problem_t), allocatable, intent(out) :: problem !! why there is no plan
    integer, allocatable, intent(out) :: body_order(:)        !! their numbers in the order in which
                                                              !! they are placed
    integer, allocatable, intent(out) :: pin_order(:)         !! their numbers in the order in which
                                                              !! bodies have them

    type(progress_t) :: done
    logical :: has_found

    if (allocated(linkage%groups)) deallocate (linkage%groups)
    if (allocated(linkage%redundancies)) deallocate (linkage%redundancies)
    allocate (linkage%groups(0), linkage%redundancies(0), body_order(0), pin_order(0))
    call check_plain_faults(linkage, problem)
    if (allocated(problem)) return
    done%pin = linkage%is_ground
    allocate (done%body(size(linkage%bodies)), done%slider(size(linkage%sliders)), &
      done%turn(size(linkage%turns)), done%drive(size(linkage%drives)))
    done%body = .false.
    done%slider = .false.
    done%turn = .false.
    done%drive = .false.
    linkage%has_crank = .false.
    call take_crank(linkage, done, body_order)
    do
      call place_next(linkage, sides, done, body_order, problem, has_found)
      if (allocated(problem)) return
      if (has_found) cycle
      if (all(done%pin) .and. all(done%body)) exit
      call take_rest(linkage, done, body_order, problem, has_found)
      if (allocated(problem)) return
    end do
    call collect_redundancies(linkage, done, problem)
    call order_pins(linkage, body_order, pin_order)
  end subroutine plan_linkage

  !> Faults that need no plan.
  pure subroutine check_plain_faults(linkage, problem)
    type(linkage_t), intent(in) :: linkage
    type(plan_problem_t), allocatable, intent(out) :: problem

    integer :: b, c, d
    integer, allocatable :: pins(:), others(:)

    do d = 1, size(linkage%drives)
      associate (drive => linkage%drives(d))
        if (drive%kind /= drives_angle .or. drive%against > 0) cycle
        if (any(linkage%is_ground(pins_of_body(linkage%bodies(drive%body))))) cycle
        if (any(linkage%turns%body == drive%body .and. linkage%turns%against == 0)) cycle
        allocate (problem)
        problem%kind = problem_coupler_driven
        problem%bodies = [drive%body]
        problem%pins = [integer ::]
        problem%number = d
        return
      end associate
    end do
    do b = 1, size(linkage%bodies)
      pins = pins_of_body(linkage%bodies(b))
      if (count(linkage%is_ground(pins)) >= 2) then
        allocate (problem)
        problem%kind = problem_braced
        problem%bodies = [b]
        problem%pins = pack(pins, linkage%is_ground(pins))
        return
      end if
      do c = 1, b - 1
        others = pins_of_body(linkage%bodies(c))
        if (count([(any(others == pins(d)), d=1, size(pins))]) < 2) cycle
        allocate (problem)
        problem%kind = problem_braced
        problem%bodies = [b, c]
        if (size(others) < size(pins)) problem%bodies = [c, b]
        problem%pins = pack(pins, [(any(others == pins(d)), d=1, size(pins))])
        return
      end do
    end do
  end subroutine check_plain_faults

  !> The first drive, where it turns a body about a ground pivot.
  pure subroutine take_crank(linkage, done, body_order)
    type(linkage_t), intent(inout) :: linkage
    type(progress_t), intent(inout) :: done
    integer, allocatable, intent(inout) :: body_order(:)

    integer :: crank, pivot
    integer, allocatable :: pins(:)

    if (size(linkage%drives) == 0) return
    associate (drive => linkage%drives(1))
      if (drive%kind /= drives_angle .or. drive%against > 0) return
      crank = drive%body
    end associate
    pins = pins_of_body(linkage%bodies(crank))
    if (.not. any(linkage%is_ground(pins))) return
    pivot = pins(findloc(linkage%is_ground(pins), .true., dim=1))
    call rebase(linkage, crank, pivot, other_pin(linkage%bodies(crank), pivot))
    ! The linkage proper has its crank first; before it is put in order another body may be.
    linkage%has_crank = crank == 1
    done%drive(1) = .true.
    body_order = [crank]
    if (linkage%has_crank) then
      done%body(1) = .true.
      done%pin(linkage%bodies(1)%last_pin) = .true.
      call carry_rest(linkage, crank, [linkage%bodies(1)%last_pin], done)
    else
      call turn_body(linkage, crank, drive_equation(1), done)
    end if
  end subroutine take_crank

  !> The pin of a body named first, but not a certain one.
  pure function other_pin(body, pin) result(other)
    type(body_t), intent(in) :: body
    integer, intent(in) :: pin
    integer :: other

    integer, allocatable :: pins(:)

    pins = pins_of_body(body)
    other = pins(1)
    if (other == pin) other = pins(2)
  end function other_pin

  !> Places what one group of a known kind can place. `has_found` if there is any.
  pure subroutine place_next(linkage, sides, done, body_order, problem, has_found)
    type(linkage_t), intent(inout) :: linkage
    type(side_t), intent(in) :: sides(:)
    type(progress_t), intent(inout) :: done
    integer, allocatable, intent(inout) :: body_order(:)
    type(plan_problem_t), allocatable, intent(inout) :: problem
    logical, intent(out) :: has_found

    call take_drives(linkage, done, body_order, has_found)
    if (.not. has_found) call take_turns(linkage, done, body_order, has_found)
    if (.not. has_found) call take_spanned(linkage, done, body_order, has_found)
    if (.not. has_found) call take_meeting(linkage, sides, done, body_order, problem, has_found)
    if (.not. has_found) call take_through_pin(linkage, sides, done, body_order, has_found)
    if (.not. has_found) call take_cross_slide(linkage, done, body_order, has_found)
  end subroutine place_next

  !> A driven angle of a body on a known pin; a driven slider on a known line.
  pure subroutine take_drives(linkage, done, body_order, has_found)
    type(linkage_t), intent(inout) :: linkage
    type(progress_t), intent(inout) :: done
    integer, allocatable, intent(inout) :: body_order(:)
    logical, intent(out) :: has_found

    type(group_t) :: group
    integer :: d, pin

    has_found = .false.
    do d = 1, size(linkage%drives)
      if (done%drive(d)) cycle
      associate (drive => linkage%drives(d))
        if (drive%kind == drives_angle) then
          if (done%body(drive%body)) cycle
          if (drive%against > 0) then
            if (.not. done%body(drive%against)) cycle
          end if
          pin = known_pin(linkage, drive%body, done)
          if (pin == 0) cycle
          call rebase(linkage, drive%body, pin, other_pin(linkage%bodies(drive%body), pin))
          body_order = [body_order, drive%body]
          call turn_body(linkage, drive%body, drive_equation(d), done)
          done%drive(d) = .true.
          has_found = .true.
          return
        else if (drive%kind == drives_slider) then
          associate (slider => linkage%sliders(drive%slider))
            if (done%slider(drive%slider) .or. done%pin(slider%pin)) cycle
            if (.not. line_is_known(linkage, drive%slider, done)) cycle
            group%kind = groups_placed
            group%pins = [slider%pin]
            group%slider(1) = drive%slider
            allocate (group%bodies(0), group%loaded(0), group%equations(2))
            group%equations(1) = drive_equation(d)
            group%equations(2) = line_equation(drive%slider)
            done%pin(slider%pin) = .true.
            done%slider(drive%slider) = .true.
          end associate
          done%drive(d) = .true.
          call append(linkage, group)
          has_found = .true.
          return
        end if
      end associate
    end do
  end subroutine take_drives

  !> A body that a drive, or another body, turns about its first pin.
  pure subroutine turn_body(linkage, body, equation, done)
    type(linkage_t), intent(inout) :: linkage
    integer, intent(in) :: body
    type(equation_t), intent(in) :: equation !! that gives its angle
    type(progress_t), intent(inout) :: done

    type(group_t) :: group

    group%kind = groups_turned
    group%base(1) = linkage%bodies(body)%first_pin
    group%body(1) = body
    allocate (group%pins(0), group%equations(1))
    group%bodies = [body]
    group%loaded = [body]
    group%equations(1) = equation
    done%body(body) = .true.
    call append(linkage, group)
    call carry_rest(linkage, body, [integer ::], done)
  end subroutine turn_body

  !> A body on a known pin that turns with a body that is placed, or does not turn.
  pure subroutine take_turns(linkage, done, body_order, has_found)
    type(linkage_t), intent(inout) :: linkage
    type(progress_t), intent(inout) :: done
    integer, allocatable, intent(inout) :: body_order(:)
    logical, intent(out) :: has_found

    integer :: t, body, pin

    has_found = .false.
    do t = 1, size(linkage%turns)
      if (done%turn(t)) cycle
      body = turned_by(linkage, t, done)
      if (body == 0) cycle
      pin = known_pin(linkage, body, done)
      if (pin == 0) cycle
      call rebase(linkage, body, pin, other_pin(linkage%bodies(body), pin))
      body_order = [body_order, body]
      call turn_body(linkage, body, turn_equation(t), done)
      done%turn(t) = .true.
      has_found = .true.
      return
    end do
  end subroutine take_turns

  !> The body of a turn whose angle follows from what is placed; 0 if none does.
  pure function turned_by(linkage, turn, done) result(body)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: turn
    type(progress_t), intent(in) :: done
    integer :: body

    logical :: is_known(2)

    associate (it => linkage%turns(turn))
      is_known = [done%body(it%body), .true.]
      if (it%against > 0) is_known(2) = done%body(it%against)
      body = 0
      if (is_known(2) .and. .not. is_known(1)) body = it%body
      if (is_known(1) .and. .not. is_known(2)) body = it%against
    end associate
  end function turned_by

  !> A body between two pins that are placed: its length is redundant.
  pure subroutine take_spanned(linkage, done, body_order, has_found)
    type(linkage_t), intent(inout) :: linkage
    type(progress_t), intent(inout) :: done
    integer, allocatable, intent(inout) :: body_order(:)
    logical, intent(out) :: has_found

    type(group_t) :: group
    integer, allocatable :: pins(:)
    integer :: b

    has_found = .false.
    do b = 1, size(linkage%bodies)
      if (done%body(b)) cycle
      pins = pins_of_body(linkage%bodies(b))
      pins = pack(pins, done%pin(pins))
      if (size(pins) < 2) cycle
      call rebase(linkage, b, pins(1), pins(2))
      body_order = [body_order, b]
      group%kind = groups_spanned
      group%base(1) = pins(1)
      group%middle = pins(2)
      group%body(1) = b
      allocate (group%pins(0), group%equations(1))
      group%bodies = [b]
      group%loaded = [b]
      group%equations(1) = pin_equation(linkage, demands_angle, b, pins(2))
      ! A ram has no length of its own: its drive is what is redundant.
      if (drive_of_length(linkage, b) == 0 .and. .not. is_used(linkage, demands_length, b, &
        pins(2))) call append_equation(linkage%redundancies, pin_equation(linkage, &
        demands_length, b, pins(2)))
      done%body(b) = .true.
      call append(linkage, group)
      call carry_rest(linkage, b, [pins(2)], done)
      has_found = .true.
      return
    end do
  end subroutine take_spanned

  !> A pin with two loci: bodies on known pins, known lines. The first such pin in the order of the
  !! bodies, or of the sliders.
  pure subroutine take_meeting(linkage, sides, done, body_order, problem, has_found)
    type(linkage_t), intent(inout) :: linkage
    type(side_t), intent(in) :: sides(:)
    type(progress_t), intent(inout) :: done
    integer, allocatable, intent(inout) :: body_order(:)
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
      call place_on_line(linkage, sides, best, bodies(1), lines(1), done, body_order, problem)
    else
      call place_dyad(linkage, sides, best, bodies(:2), done, body_order, problem)
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
    call append(linkage, group)
  end subroutine place_on_two_lines

  !> RRP: a body on a known pin, with another one of its pins on a known line.
  pure subroutine place_on_line(linkage, sides, pin, body, line, done, body_order, problem)
    type(linkage_t), intent(inout) :: linkage
    type(side_t), intent(in) :: sides(:)
    integer, intent(in) :: pin, body, line
    type(progress_t), intent(inout) :: done
    integer, allocatable, intent(inout) :: body_order(:)
    type(plan_problem_t), allocatable, intent(inout) :: problem

    type(group_t) :: group
    real(wp) :: direction(2)
    logical :: is_known
    integer :: base, number

    base = known_pin(linkage, body, done)
    call rebase(linkage, body, base, pin)
    body_order = [body_order, body]
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
    call append(linkage, group)
    call carry_rest(linkage, body, [pin], done)
  end subroutine place_on_line

  !> RRR: two bodies on known pins that meet.
  pure subroutine place_dyad(linkage, sides, pin, bodies, done, body_order, problem)
    type(linkage_t), intent(inout) :: linkage
    type(side_t), intent(in) :: sides(:)
    integer, intent(in) :: pin
    integer, intent(in) :: bodies(2)
    type(progress_t), intent(inout) :: done
    integer, allocatable, intent(inout) :: body_order(:)
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
    body_order = [body_order, group%body]
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
    call append(linkage, group)
    call carry_rest(linkage, group%body(1), [pin], done)
    call carry_rest(linkage, group%body(2), [group%base(2)], done)
  end subroutine place_dyad

  pure subroutine report_side(problem, kind, pin, bases, number, on_line)
    type(plan_problem_t), allocatable, intent(inout) :: problem
    integer, intent(in) :: kind, pin
    integer, intent(in) :: bases(:)
    integer, intent(in) :: number
    logical, intent(in) :: on_line

    allocate (problem)
    problem%kind = kind
    problem%pins = [pin, bases]
    problem%bodies = [integer ::]
    problem%number = number
    problem%on_line = on_line
  end subroutine report_side

  !> RPR: a body on a known pin whose line passes through another known pin.
  pure subroutine take_through_pin(linkage, sides, done, body_order, has_found)
    type(linkage_t), intent(inout) :: linkage
    type(side_t), intent(in) :: sides(:)
    type(progress_t), intent(inout) :: done
    integer, allocatable, intent(inout) :: body_order(:)
    logical, intent(out) :: has_found

    type(group_t) :: group
    integer :: s, base, body, other, number

    has_found = .false.
    do s = 1, size(linkage%sliders)
      if (done%slider(s) .or. .not. done%pin(linkage%sliders(s)%pin)) cycle
      body = linkage%sliders(s)%body
      if (body == 0) cycle
      if (done%body(body)) cycle
      base = known_pin(linkage, body, done)
      if (base == 0) cycle
      other = other_pin(linkage%bodies(body), base)
      call rebase(linkage, body, base, other)
      body_order = [body_order, body]
      group%kind = groups_through_pin
      group%base(1) = base
      group%middle = linkage%sliders(s)%pin
      group%body(1) = body
      group%slider(1) = s
      allocate (group%pins(0), group%equations(1))
      group%bodies = [body]
      group%loaded = [body]
      group%equations(1) = line_equation(s)
      ! A block lies between the pins of its link, if nothing else is said.
      group%side = sign(1.0_wp, linkage%sliders(s)%direction(1))
      number = findloc(sides%pin, linkage%sliders(s)%pin, dim=1)
      if (number > 0) then
        if (all(sides(number)%base == 0)) group%side = sides(number)%side
      end if
      done%slider(s) = .true.
      done%body(body) = .true.
      call append(linkage, group)
      call carry_rest(linkage, body, [integer ::], done)
      has_found = .true.
      return
    end do
  end subroutine take_through_pin

  !> PPR: a body whose angle is known, with a pin on a known line, and its own line through a known
  !! pin.
  pure subroutine take_cross_slide(linkage, done, body_order, has_found)
    type(linkage_t), intent(inout) :: linkage
    type(progress_t), intent(inout) :: done
    integer, allocatable, intent(inout) :: body_order(:)
    logical, intent(out) :: has_found

    type(group_t) :: group
    integer :: t, s, k, body

    has_found = .false.
    do t = 1, size(linkage%turns)
      if (done%turn(t)) cycle
      body = turned_by(linkage, t, done)
      if (body == 0) cycle
      do s = 1, size(linkage%sliders)
        if (done%slider(s) .or. .not. has_pin(linkage%bodies(body), linkage%sliders(s)%pin)) cycle
        if (.not. line_is_known(linkage, s, done)) cycle
        do k = 1, size(linkage%sliders)
          if (done%slider(k) .or. linkage%sliders(k)%body /= body) cycle
          if (.not. done%pin(linkage%sliders(k)%pin)) cycle
          call rebase(linkage, body, linkage%sliders(s)%pin, other_pin(linkage%bodies(body), &
            linkage%sliders(s)%pin))
          body_order = [body_order, body]
          group%kind = groups_cross_slide
          group%body(1) = body
          group%middle = linkage%sliders(k)%pin
          group%slider = [s, k]
          group%pins = [linkage%sliders(s)%pin]
          group%bodies = [body]
          group%loaded = [body]
          allocate (group%equations(3))
          group%equations(1) = turn_equation(t)
          group%equations(2) = line_equation(s)
          group%equations(3) = line_equation(k)
          done%turn(t) = .true.
          done%slider([s, k]) = .true.
          done%pin(linkage%sliders(s)%pin) = .true.
          done%body(body) = .true.
          call append(linkage, group)
          call carry_rest(linkage, body, [integer ::], done)
          has_found = .true.
          return
        end do
      end do
    end do
  end subroutine take_cross_slide

  !> A group for iterations, from what no dyad places. Without one, the pins that nothing holds are
  !! the problem.
  pure subroutine take_rest(linkage, done, body_order, problem, has_found)
    type(linkage_t), intent(inout) :: linkage
    type(progress_t), intent(inout) :: done
    integer, allocatable, intent(inout) :: body_order(:)
    type(plan_problem_t), allocatable, intent(inout) :: problem
    logical, intent(out) :: has_found

    type(group_t) :: group
    type(equation_t), allocatable :: equations(:)
    type(matching_t) :: matching
    logical, allocatable :: has(:, :)
    integer, allocatable :: unknown_pins(:), unknown_bodies(:), part(:)
    integer :: b, i, np, pin

    do b = 1, size(linkage%bodies)
      if (done%body(b)) cycle
      pin = known_pin(linkage, b, done)
      if (pin > 0) call rebase(linkage, b, pin, other_pin(linkage%bodies(b), pin))
    end do
    unknown_pins = pack([(i, i=1, size(done%pin))], .not. done%pin)
    unknown_bodies = pack([(i, i=1, size(done%body))], .not. done%body)
    np = size(unknown_pins)
    call open_equations(linkage, done, equations)
    call find_dependence(linkage, equations, unknown_pins, unknown_bodies, has)
    matching = match_unknowns(has)
    part = source_component(has, matching, [([i, i], i=1, np), (np + i, i=1, &
      size(unknown_bodies))], [(0, i=1, np), (findloc(unknown_pins, linkage%bodies( &
      unknown_bodies(i))%first_pin, dim=1), i=1, size(unknown_bodies))])
    has_found = size(part) > 0
    if (.not. has_found) then
      allocate (problem)
      problem%kind = problem_too_free
      problem%mobility = count(matching%equation_of == 0) + size(linkage%drives)
      problem%pins = unknown_pins(pack([(i, i=1, np)], [(matching%is_loose(2*i - 1) .or. &
        matching%is_loose(2*i), i=1, np)]))
      problem%bodies = unknown_bodies(pack([(i, i=1, size(unknown_bodies))], &
        matching%is_loose(2*np + 1:)))
      return
    end if
    group%kind = groups_by_newton
    group%pins = unknown_pins(pack(part, part <= np))
    group%bodies = unknown_bodies(pack(part, part > np) - np)
    if (.not. all(linkage%drawing%is_drawn(group%pins))) then
      allocate (problem)
      problem%kind = problem_not_drawn
      problem%pins = pack(group%pins, .not. linkage%drawing%is_drawn(group%pins))
      problem%bodies = group%bodies
      return
    end if
    allocate (group%equations(unknowns_of(group)))
    call take_equations(equations, matching, part, np, group)
    group%loaded = group%bodies
    do i = 1, size(group%equations)
      select case (group%equations(i)%kind)
      case (demands_line)
        done%slider(group%equations(i)%number) = .true.
      case (demands_turn)
        done%turn(group%equations(i)%number) = .true.
      case (demands_drive)
        done%drive(group%equations(i)%number) = .true.
      end select
    end do
    done%pin(group%pins) = .true.
    call settle_bodies(linkage, done, body_order, group)
  end subroutine take_rest

  !> The equations matched with the unknowns of a part.
  pure subroutine take_equations(equations, matching, part, np, group)
    type(equation_t), intent(in) :: equations(:)
    type(matching_t), intent(in) :: matching
    integer, intent(in) :: part(:)
    integer, intent(in) :: np
    type(group_t), intent(inout) :: group

    integer :: i, filled

    filled = 0
    do i = 1, size(part)
      if (part(i) <= np) then
        group%equations(filled + 1) = equations(matching%equation_of(2*part(i) - 1))
        group%equations(filled + 2) = equations(matching%equation_of(2*part(i)))
        filled = filled + 2
      else
        group%equations(filled + 1) = equations(matching%equation_of(np + part(i)))
        filled = filled + 1
      end if
    end do
  end subroutine take_equations

  !> Bodies that a group for iterations turns: their further pins are carried, and equations of pins
  !! that it has not used are redundancies.
  pure subroutine settle_bodies(linkage, done, body_order, group)
    type(linkage_t), intent(inout) :: linkage
    type(progress_t), intent(inout) :: done
    integer, allocatable, intent(inout) :: body_order(:)
    type(group_t), intent(in) :: group

    integer :: i

    call append(linkage, group)
    done%body(group%bodies) = .true.
    body_order = [body_order, group%bodies]
    do i = 1, size(group%bodies)
      call carry_rest(linkage, group%bodies(i), [integer ::], done)
    end do
  end subroutine settle_bodies

  !> All equations not used yet that have unknowns.
  pure subroutine open_equations(linkage, done, equations)
    type(linkage_t), intent(in) :: linkage
    type(progress_t), intent(in) :: done
    type(equation_t), allocatable, intent(out) :: equations(:)

    integer, allocatable :: pins(:)
    integer :: i, k

    allocate (equations(0))
    do i = 1, size(linkage%drives)
      if (.not. done%drive(i)) call append_equation(equations, drive_equation(i))
    end do
    do i = 1, size(linkage%bodies)
      if (done%body(i)) cycle
      pins = pins_of_body(linkage%bodies(i))
      do k = 2, size(pins)
        if (.not. is_used(linkage, demands_length, i, pins(k)) .and. (k > 2 .or. &
          drive_of_length(linkage, i) == 0)) call append_equation(equations, pin_equation( &
          linkage, demands_length, i, pins(k)))
        if (.not. is_used(linkage, demands_angle, i, pins(k))) call append_equation(equations, &
          pin_equation(linkage, demands_angle, i, pins(k)))
      end do
    end do
    do i = 1, size(linkage%turns)
      if (.not. done%turn(i)) call append_equation(equations, turn_equation(i))
    end do
    do i = 1, size(linkage%sliders)
      if (.not. done%slider(i)) call append_equation(equations, line_equation(i))
    end do
  end subroutine open_equations

  !> On which unknowns equations depend: two of each pin, then one of each body.
  pure subroutine find_dependence(linkage, equations, pins, bodies, has)
    type(linkage_t), intent(in) :: linkage
    type(equation_t), intent(in) :: equations(:)
    integer, intent(in) :: pins(:), bodies(:) !! unknown
    logical, allocatable, intent(out) :: has(:, :) !! (unknowns, equations)

    integer :: i

    allocate (has(2*size(pins) + size(bodies), size(equations)))
    has = .false.
    do i = 1, size(equations)
      associate (equation => equations(i))
        select case (equation%kind)
        case (demands_length)
          call mark(pins, equation%pin, 2, 0, has(:, i))
          call mark(pins, linkage%bodies(equation%body)%first_pin, 2, 0, has(:, i))
        case (demands_angle)
          call mark(pins, equation%pin, 2, 0, has(:, i))
          call mark(pins, linkage%bodies(equation%body)%first_pin, 2, 0, has(:, i))
          call mark(bodies, equation%body, 1, 2*size(pins), has(:, i))
        case (demands_line)
          call mark_line(equation%number, has(:, i))
        case (demands_turn)
          call mark(bodies, linkage%turns(equation%number)%body, 1, 2*size(pins), has(:, i))
          call mark(bodies, linkage%turns(equation%number)%against, 1, 2*size(pins), has(:, i))
        case (demands_drive)
          associate (drive => linkage%drives(equation%number))
            select case (drive%kind)
            case (drives_angle)
              call mark(bodies, drive%body, 1, 2*size(pins), has(:, i))
              call mark(bodies, drive%against, 1, 2*size(pins), has(:, i))
            case (drives_slider)
              call mark_line(drive%slider, has(:, i))
            case (drives_length)
              call mark(pins, linkage%bodies(drive%body)%first_pin, 2, 0, has(:, i))
              call mark(pins, linkage%bodies(drive%body)%last_pin, 2, 0, has(:, i))
            end select
          end associate
        end select
      end associate
    end do

  contains

    pure subroutine mark_line(number, row)
      integer, intent(in) :: number !! of the slider
      logical, intent(inout) :: row(:)

      call mark(pins, linkage%sliders(number)%pin, 2, 0, row)
      if (linkage%sliders(number)%body == 0) return
      call mark(pins, linkage%bodies(linkage%sliders(number)%body)%first_pin, 2, 0, row)
      call mark(bodies, linkage%sliders(number)%body, 1, 2*size(pins), row)
    end subroutine mark_line

  end subroutine find_dependence

  !> Marks the unknowns of a pin or a body, if it is one of those listed.
  pure subroutine mark(list, number, each, before, row)
    integer, intent(in) :: list(:)
    integer, intent(in) :: number
    integer, intent(in) :: each   !! unknowns of each in the list
    integer, intent(in) :: before !! unknowns before the first
    logical, intent(inout) :: row(:)

    integer :: at

    at = findloc(list, number, dim=1)
    if (at > 0) row(before + each*(at - 1) + 1:before + each*at) = .true.
  end subroutine mark

  !> What nothing has used: it must be fulfilled by what is placed. A drive that is not used is a
  !! problem.
  pure subroutine collect_redundancies(linkage, done, problem)
    type(linkage_t), intent(inout) :: linkage
    type(progress_t), intent(in) :: done
    type(plan_problem_t), allocatable, intent(inout) :: problem

    integer :: i

    do i = 1, size(done%drive)
      if (done%drive(i)) cycle
      allocate (problem)
      problem%kind = problem_drive_idle
      problem%number = i
      problem%pins = [integer ::]
      problem%bodies = [integer ::]
      return
    end do
    do i = 1, size(done%turn)
      if (done%turn(i)) cycle
      call append_equation(linkage%redundancies, turn_equation(i))
    end do
    do i = 1, size(done%slider)
      if (done%slider(i)) cycle
      call append_equation(linkage%redundancies, line_equation(i))
    end do
  end subroutine collect_redundancies

  !> Places the pins of a body that are not placed yet; those that are, and whose equations are not
  !! used, are redundant.
  pure subroutine carry_rest(linkage, body, used, done)
    type(linkage_t), intent(inout) :: linkage
    integer, intent(in) :: body
    integer, intent(in) :: used(:) !! pins that place the body, beside its first
    type(progress_t), intent(inout) :: done

    type(group_t) :: group
    integer, allocatable :: pins(:)
    integer :: i

    pins = pins_of_body(linkage%bodies(body))
    do i = 2, size(pins)
      if (.not. done%pin(pins(i)) .or. any(used == pins(i))) cycle
      if (.not. is_used(linkage, demands_length, body, pins(i))) call append_equation( &
        linkage%redundancies, pin_equation(linkage, demands_length, body, pins(i)))
      if (.not. is_used(linkage, demands_angle, body, pins(i))) call append_equation( &
        linkage%redundancies, pin_equation(linkage, demands_angle, body, pins(i)))
    end do
    pins = pack(pins, .not. done%pin(pins))
    if (size(pins) == 0) return
    group%kind = groups_carried
    group%base(1) = linkage%bodies(body)%first_pin
    group%body(1) = body
    group%pins = pins
    allocate (group%bodies(0), group%loaded(0), group%equations(0))
    done%pin(pins) = .true.
    call append(linkage, group)
  end subroutine carry_rest

  !> Whether a group has used what a body demands of a pin.
  pure function is_used(linkage, kind, body, pin)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: kind, body, pin
    logical :: is_used

    integer :: i

    is_used = .false.
    do i = 1, size(linkage%groups)
      if (.not. allocated(linkage%groups(i)%equations)) cycle
      associate (equations => linkage%groups(i)%equations)
        is_used = is_used .or. any(equations%kind == kind .and. equations%body == body .and. &
          equations%pin == pin)
      end associate
    end do
  end function is_used

  !> Chooses the first and the last pin of a body; its axes, and what is placed in them, turn.
  pure subroutine rebase(linkage, body, first, last)
    type(linkage_t), intent(inout) :: linkage !! bodies and sliders
    integer, intent(in) :: body               !! number, from 1
    integer, intent(in) :: first, last        !! two of its pins

    real(wp) :: origin(2), axis(2), length
    integer, allocatable :: pins(:)
    real(wp), allocatable :: places(:, :)
    integer :: i, filled

    associate (it => linkage%bodies(body))
      if (it%first_pin == first .and. it%last_pin == last) return
      pins = pins_of_body(it)
      allocate (places(2, size(pins)))
      do i = 1, size(pins)
        places(:, i) = place_of_pin(it, pins(i))
      end do
      origin = place_of_pin(it, first)
      axis = place_of_pin(it, last) - origin
      length = norm2(axis)
      axis = axis/length
      ! The same two pins: nothing is rounded.
      if (it%first_pin == last .and. it%last_pin == first) then
        axis = [-1.0_wp, 0.0_wp]
        length = it%length
      end if
      it%length = length
      it%heading = turned_back(it%heading, axis)
      it%origin = turned_back(it%origin - origin, axis)
      it%card_axis = turned_back(it%card_axis, axis)
      it%first_pin = first
      it%last_pin = last
      filled = 0
      do i = 1, size(pins)
        if (any(pins(i) == [first, last])) cycle
        filled = filled + 1
        it%further(filled)%pin = pins(i)
        it%further(filled)%place = turned_back(places(:, i) - origin, axis)
      end do
    end associate
    do i = 1, size(linkage%sliders)
      if (linkage%sliders(i)%body /= body) cycle
      linkage%sliders(i)%point = turned_back(linkage%sliders(i)%point - origin, axis)
      linkage%sliders(i)%direction = turned_back(linkage%sliders(i)%direction, axis)
    end do
    do i = 1, size(linkage%turns)
      if (linkage%turns(i)%body == body) linkage%turns(i)%relative = turned(axis, &
        linkage%turns(i)%relative)
      if (linkage%turns(i)%against == body) linkage%turns(i)%relative = turned_back( &
        linkage%turns(i)%relative, axis)
    end do
  end subroutine rebase

  !> The pins in the order in which the bodies have them: first and last ones, further ones, those
  !! of sliders alone.
  pure subroutine order_pins(linkage, body_order, pin_order)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: body_order(:)
    integer, allocatable, intent(inout) :: pin_order(:)

    integer, allocatable :: pins(:)
    integer :: i, k

    do i = 1, size(body_order)
      pins = pins_of_body(linkage%bodies(body_order(i)))
      do k = 1, 2
        if (.not. any(pin_order == pins(k))) pin_order = [pin_order, pins(k)]
      end do
    end do
    do i = 1, size(body_order)
      pins = pins_of_body(linkage%bodies(body_order(i)))
      do k = 3, size(pins)
        if (.not. any(pin_order == pins(k))) pin_order = [pin_order, pins(k)]
      end do
    end do
    do i = 1, size(linkage%is_ground)
      if (.not. any(pin_order == i)) pin_order = [pin_order, i]
    end do
  end subroutine order_pins

  !> A pin of a body that is placed, ground pivots first; 0 if none is.
  pure function known_pin(linkage, body, done) result(pin)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: body
    type(progress_t), intent(in) :: done
    integer :: pin

    integer, allocatable :: pins(:)
    integer :: i

    pins = pins_of_body(linkage%bodies(body))
    pin = 0
    do i = size(pins), 1, -1
      if (done%pin(pins(i))) pin = pins(i)
    end do
  end function known_pin

  pure function has_pin(body, pin)
    type(body_t), intent(in) :: body
    integer, intent(in) :: pin
    logical :: has_pin

    has_pin = any(pins_of_body(body) == pin)
  end function has_pin

  !> Whether the line of a slider is placed.
  pure function line_is_known(linkage, slider, done) result(is)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: slider
    type(progress_t), intent(in) :: done
    logical :: is

    is = .true.
    if (linkage%sliders(slider)%body > 0) is = done%body(linkage%sliders(slider)%body)
  end function line_is_known

  !> Direction of the line of a slider in the drawing.
  pure subroutine drawn_line(linkage, slider, direction, is_known)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: slider
    real(wp), intent(out) :: direction(2)
    logical, intent(out) :: is_known

    real(wp) :: way(2)

    direction = linkage%sliders(slider)%direction
    is_known = .true.
    if (linkage%sliders(slider)%body == 0) return
    associate (body => linkage%bodies(linkage%sliders(slider)%body))
      is_known = all(linkage%drawing%is_drawn([body%first_pin, body%last_pin]))
      if (.not. is_known) return
      way = linkage%drawing%pin(:, body%last_pin) - linkage%drawing%pin(:, body%first_pin)
      direction = turned(direction, way/norm2(way))
    end associate
  end subroutine drawn_line

  !> Number of the drive of the length of a body; 0 if it has none.
  pure function drive_of_length(linkage, body) result(number)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: body
    integer :: number

    do number = 1, size(linkage%drives)
      if (linkage%drives(number)%kind == drives_length .and. &
        linkage%drives(number)%body == body) return
    end do
    number = 0
  end function drive_of_length

  pure function pin_equation(linkage, kind, body, pin) result(equation)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: kind, body, pin
    type(equation_t) :: equation

    equation%kind = kind
    equation%body = body
    equation%pin = pin
    equation%place = place_of_pin(linkage%bodies(body), pin)
  end function pin_equation

  pure function line_equation(slider) result(equation)
    integer, intent(in) :: slider
    type(equation_t) :: equation

    equation%kind = demands_line
    equation%number = slider
  end function line_equation

  pure function turn_equation(turn) result(equation)
    integer, intent(in) :: turn
    type(equation_t) :: equation

    equation%kind = demands_turn
    equation%number = turn
  end function turn_equation

  pure function drive_equation(drive) result(equation)
    integer, intent(in) :: drive
    type(equation_t) :: equation

    equation%kind = demands_drive
    equation%number = drive
  end function drive_equation

  pure subroutine append_equation(list, equation)
    type(equation_t), allocatable, intent(inout) :: list(:)
    type(equation_t), intent(in) :: equation

    type(equation_t), allocatable :: longer(:)

    allocate (longer(size(list) + 1))
    longer(:size(list)) = list
    longer(size(longer)) = equation
    call move_alloc(longer, list)
  end subroutine append_equation

  pure subroutine append(linkage, group)
    type(linkage_t), intent(inout) :: linkage
    type(group_t), intent(in) :: group

    type(group_t), allocatable :: longer(:)
    integer :: i

    allocate (longer(size(linkage%groups) + 1))
    do i = 1, size(linkage%groups)
      longer(i) = linkage%groups(i)
    end do
    longer(size(longer)) = group
    call move_alloc(longer, linkage%groups)
  end subroutine append

end module assembly_plan
