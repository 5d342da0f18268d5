!> Groups for iterations, from what no dyad places: equations are matched with unknowns, and the
!! strongly connected component that depends on nothing else is one. What cannot be matched tells
!! which pins nothing holds.
module plan_iterations
  use body_axes, only: choose_pins, other_pin
  use coordinate_types, only: coordinate_t, is_angle, is_distance, is_sum
  use drawn_places, only: needed_places
  use group_equations, only: unknowns_of
  use kinds, only: wp
  use linkages, only: demand_angle, demand_drive, demand_length, demand_line, demand_turn, &
    drive_of_nothing, equation_t, group_t, group_by_newton, linkage_t
  use plan_equations, only: append_equation, drive_equation, length_drive, is_used, &
    line_equation, pin_equation, turn_equation
  use plan_problems, only: new_problem, plan_problem_t, problem_not_drawn, problem_too_free
  use plan_progress, only: append_group, carry_rest, known_pin, progress_t
  use pose_types, only: pins_of_body
  use unknown_matching, only: matching_t, match_unknowns, source_component
  implicit none (type, external)
  private

  public :: take_rest

contains

  !> A group for iterations, from what no dyad places. Without one, the pins that nothing holds are
  !! the problem.
  pure subroutine take_rest(linkage, done, problem, has_found)
    type(linkage_t), intent(inout) :: linkage !! to whose groups it is added
    type(progress_t), intent(inout) :: done   !! with pins or bodies that are not placed
    type(plan_problem_t), allocatable, intent(inout) :: problem !! why there is none
    logical, intent(out) :: has_found         !! whether anything can be placed

    type(group_t) :: group
    type(equation_t), allocatable :: equations(:)
    type(matching_t) :: matching
    logical, allocatable :: has(:, :)
    integer, allocatable :: pins(:), bodies(:), component(:)
    integer :: i, np

    call choose_known_pins(linkage, done)
    pins = pack([(i, i=1, size(done%pin))], .not. done%pin)
    bodies = pack([(i, i=1, size(done%body))], .not. done%body)
    np = size(pins)
    call open_equations(linkage, done, equations)
    call find_dependence(linkage, equations, pins, bodies, has)
    matching = match_unknowns(has)
    component = source_component(has, matching, [([i, i], i=1, np), (np + i, i=1, size(bodies))], &
      [(0, i=1, np), (findloc(pins, linkage%bodies(bodies(i))%first_pin, dim=1), i=1, &
      size(bodies))])
    has_found = size(component) > 0
    if (.not. has_found) then
      problem = what_is_free(linkage, matching, pins, bodies)
      call blame_parts(linkage, pack(equations, matching%unknown_of == 0), problem)
      return
    end if
    group%kind = group_by_newton
    group%pins = pins(pack(component, component <= np))
    group%bodies = bodies(pack(component, component > np) - np)
    group%loaded = group%bodies
    if (.not. all(linkage%drawing%is_drawn(group%pins))) then
      problem = new_problem(problem_not_drawn, needed_places(linkage, pack(group%pins, .not. &
        linkage%drawing%is_drawn(group%pins))), group%bodies)
      return
    end if
    allocate (group%equations(unknowns_of(group)))
    call find_matched_equations(equations, matching, component, np, group)
    call record_group(linkage, done, group)
  end subroutine take_rest

  !> Bodies with a pin that is placed are measured from it.
  pure subroutine choose_known_pins(linkage, done)
    type(linkage_t), intent(inout) :: linkage
    type(progress_t), intent(in) :: done

    integer :: b, pin

    do b = 1, size(linkage%bodies)
      if (done%body(b)) cycle
      pin = known_pin(linkage, b, done)
      if (pin > 0) call choose_pins(linkage, b, pin, other_pin(linkage%bodies(b), pin))
    end do
  end subroutine choose_known_pins

  !> Pins and bodies whose unknowns no equation is left for, or could be left without one.
  pure function what_is_free(linkage, matching, pins, bodies) result(problem)
    type(linkage_t), intent(in) :: linkage
    type(matching_t), intent(in) :: matching
    integer, intent(in) :: pins(:), bodies(:) !! unknown
    type(plan_problem_t) :: problem

    integer :: i, np

    np = size(pins)
    problem = new_problem(problem_too_free, pack(pins, [(matching%is_loose(2*i - 1) .or. &
      matching%is_loose(2*i), i=1, np)]), pack(bodies, matching%is_loose(2*np + 1:)))
    problem%mobility = count(matching%equation_of == 0) + count(linkage%drives%kind /= &
      drive_of_nothing)
  end function what_is_free

  !> What does nothing while other parts are free: a drive, or else bodies held more than once.
  pure subroutine blame_parts(linkage, idle, problem)
    type(linkage_t), intent(in) :: linkage
    type(equation_t), intent(in) :: idle(:) !! that nothing is left for
    type(plan_problem_t), intent(inout) :: problem

    integer :: i

    i = findloc(idle%kind, demand_drive, dim=1)
    if (i > 0) then
      problem%number = idle(i)%number
    else
      problem%redundant = redundant_bodies(linkage, idle)
    end if
  end subroutine blame_parts

  !> Bodies of the redundancies so far, and of equations that nothing is left for.
  pure function redundant_bodies(linkage, idle) result(bodies)
    type(linkage_t), intent(in) :: linkage
    type(equation_t), intent(in) :: idle(:)
    integer, allocatable :: bodies(:)

    integer :: i, body

    allocate (bodies(0))
    do i = 1, size(linkage%redundancies) + size(idle)
      if (i <= size(linkage%redundancies)) then
        body = linkage%redundancies(i)%body
      else
        body = idle(i - size(linkage%redundancies))%body
      end if
      if (.not. any(bodies == body)) bodies = [bodies, body]
    end do
  end function redundant_bodies

  !> The equations matched with the unknowns of a component.
  pure subroutine find_matched_equations(equations, matching, component, np, group)
    type(equation_t), intent(in) :: equations(:)
    type(matching_t), intent(in) :: matching
    integer, intent(in) :: component(:)
    integer, intent(in) :: np
    type(group_t), intent(inout) :: group

    integer :: i, filled

    filled = 0
    do i = 1, size(component)
      if (component(i) <= np) then
        group%equations(filled + 1) = equations(matching%equation_of(2*component(i) - 1))
        group%equations(filled + 2) = equations(matching%equation_of(2*component(i)))
        filled = filled + 2
      else
        group%equations(filled + 1) = equations(matching%equation_of(np + component(i)))
        filled = filled + 1
      end if
    end do
  end subroutine find_matched_equations

  !> What a group for iterations uses and places. The further pins of its bodies are carried, and
  !! equations of pins that it has not used are redundancies.
  pure subroutine record_group(linkage, done, group)
    type(linkage_t), intent(inout) :: linkage
    type(progress_t), intent(inout) :: done
    type(group_t), intent(in) :: group

    integer :: i

    do i = 1, size(group%equations)
      select case (group%equations(i)%kind)
      case (demand_line)
        done%slider(group%equations(i)%number) = .true.
      case (demand_turn)
        done%turn(group%equations(i)%number) = .true.
      case (demand_drive)
        done%drive(group%equations(i)%number) = .true.
      end select
    end do
    done%pin(group%pins) = .true.
    done%body(group%bodies) = .true.
    done%order = [done%order, group%bodies]
    call append_group(linkage, group)
    do i = 1, size(group%bodies)
      call carry_rest(linkage, group%bodies(i), [integer ::], done)
    end do
  end subroutine record_group

  !> All equations not used yet that have unknowns.
  pure subroutine open_equations(linkage, done, equations)
    type(linkage_t), intent(in) :: linkage
    type(progress_t), intent(in) :: done
    type(equation_t), allocatable, intent(out) :: equations(:)

    integer, allocatable :: pins(:)
    integer :: i, k

    allocate (equations(0))
    do i = 1, size(linkage%drives)
      if (.not. done%drive(i)) call append_equation(equations, drive_equation(linkage, i))
    end do
    do i = 1, size(linkage%bodies)
      if (done%body(i)) cycle
      pins = pins_of_body(linkage%bodies(i))
      do k = 2, size(pins)
        if (.not. is_used(linkage, demand_length, i, pins(k)) .and. (k > 2 .or. &
          length_drive(linkage, i) == 0)) call append_equation(equations, pin_equation( &
          linkage, demand_length, i, pins(k)))
        if (.not. is_used(linkage, demand_angle, i, pins(k))) call append_equation(equations, &
          pin_equation(linkage, demand_angle, i, pins(k)))
      end do
    end do
    do i = 1, size(linkage%turns)
      if (.not. done%turn(i)) call append_equation(equations, turn_equation(linkage, i))
    end do
    do i = 1, size(linkage%sliders)
      if (.not. done%slider(i)) call append_equation(equations, line_equation(linkage, i))
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
      call mark_coordinate(linkage, equations(i)%coordinate, pins, bodies, has(:, i))
    end do
  end subroutine find_dependence

  !> Marks the unknowns on which a coordinate depends.
  pure recursive subroutine mark_coordinate(linkage, coordinate, pins, bodies, row)
    type(linkage_t), intent(in) :: linkage
    type(coordinate_t), intent(in) :: coordinate
    integer, intent(in) :: pins(:), bodies(:) !! unknown
    logical, intent(inout) :: row(:)

    integer :: i

    if (coordinate%kind == is_sum) then
      do i = 1, size(coordinate%term)
        call mark_coordinate(linkage, linkage%coordinates(coordinate%term(i)), pins, bodies, row)
      end do
      return
    end if
    do i = 1, 2
      associate (at => coordinate%at(i))
        call mark(pins, at%pin, 2, 0, row)
        if (at%body == 0) cycle
        if (coordinate%kind /= is_angle) call mark(pins, linkage%bodies(at%body)%first_pin, 2, 0, &
          row)
        ! The distance from the first pin of a body is the same however it turns.
        if (coordinate%kind /= is_distance .or. any(abs(at%place) > 0.0_wp)) call mark(bodies, &
          at%body, 1, 2*size(pins), row)
      end associate
    end do
  end subroutine mark_coordinate

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

end module plan_iterations
