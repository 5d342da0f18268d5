!> Which of two places a pin has: from a card, else from the drawing.
module plan_sides
  use kinds, only: wp
  use linkages, only: cross, group_t, groups_by_newton, groups_driven_dyad, groups_dyad, &
    groups_on_line, groups_through_pin, linkage_t, turned
  use plan_problems, only: new_problem, plan_problem_t, problem_no_side, problem_other_bases, &
    problem_side_idle
  implicit none (type, external)
  private

  public :: side_t, choose_side, check_sides, drawn_line

  !> On which side a pin lies, of two ways to place it.
  type :: side_t
    integer :: pin = 0
    real(wp) :: side = 1.0_wp   !! +1: to the left of base 1 → base 2, or forward on the line
    integer :: base(2) = 0      !! pins
    logical :: on_line = .false. !! forward or backward: without bases
  end type side_t

contains

  !> The side of a group: that of a card of its form, else that of the drawing. A group whose body
  !! passes through a pin keeps the side that it has if neither tells.
  pure subroutine choose_side(linkage, sides, group, problem)
    type(linkage_t), intent(in) :: linkage  !! bodies, sliders, and the drawing
    type(side_t), intent(in) :: sides(:)    !! of its pins
    type(group_t), intent(inout) :: group   !! with its bases and its middle; its side is set
    type(plan_problem_t), allocatable, intent(inout) :: problem !! why it has no side

    integer :: number
    logical :: is_known

    number = findloc(sides%pin == group%middle .and. (sides%on_line .eqv. is_on_line(group)), &
      .true., dim=1)
    if (number > 0) then
      call take_side(sides(number), group, is_known)
      if (.not. is_known) problem = problem_of_side(problem_other_bases, group, number)
      return
    end if
    call take_drawn_side(linkage, group, is_known)
    if (is_known .or. group%kind == groups_through_pin) return
    number = findloc(sides%pin, group%middle, dim=1)
    if (number > 0) then
      problem = problem_of_side(problem_other_bases, group, number)
    else
      problem = problem_of_side(problem_no_side, group, 0)
    end if
  end subroutine choose_side

  !> Whether the side of a group is one along a line; else it is one of the way between its bases.
  pure function is_on_line(group) result(is)
    type(group_t), intent(in) :: group
    logical :: is

    is = any(group%kind == [groups_on_line, groups_through_pin])
  end function is_on_line

  !> The side that a card gives a group, if it is about its bases.
  pure subroutine take_side(side, group, is_known)
    type(side_t), intent(in) :: side
    type(group_t), intent(inout) :: group
    logical, intent(out) :: is_known

    is_known = side%on_line
    if (side%on_line .or. all(side%base == group%base)) then
      group%side = side%side
      is_known = .true.
    else if (all(side%base == group%base([2, 1]))) then
      group%side = -side%side
      is_known = .true.
    end if
  end subroutine take_side

  !> The side of a group in the drawing, if its pins are drawn.
  pure subroutine take_drawn_side(linkage, group, is_known)
    type(linkage_t), intent(in) :: linkage
    type(group_t), intent(inout) :: group
    logical, intent(out) :: is_known

    real(wp) :: way(2), direction(2)

    associate (at => linkage%drawing%pin, is_drawn => linkage%drawing%is_drawn)
      is_known = is_drawn(group%base(1)) .and. is_drawn(group%middle)
      if (.not. is_known) return
      way = at(:, group%middle) - at(:, group%base(1))
      if (is_on_line(group)) then
        call drawn_line(linkage, group%slider(1), direction, is_known)
        if (is_known) group%side = sign(1.0_wp, dot_product(direction, way))
      else
        is_known = is_drawn(group%base(2))
        if (is_known) group%side = sign(1.0_wp, cross(at(:, group%base(2)) - at(:, &
          group%base(1)), way))
      end if
    end associate
  end subroutine take_drawn_side

  !> Direction of the line of a slider in the drawing.
  pure subroutine drawn_line(linkage, slider, direction, is_known)
    type(linkage_t), intent(in) :: linkage    !! sliders, bodies, and the drawing
    integer, intent(in) :: slider             !! number, from 1
    real(wp), intent(out) :: direction(2)     !! unit vector, global axes
    logical, intent(out) :: is_known          !! the line is fixed, or its body is drawn

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

  !> A problem with the side of a group, about its middle and its bases.
  pure function problem_of_side(kind, group, number) result(problem)
    integer, intent(in) :: kind
    type(group_t), intent(in) :: group
    integer, intent(in) :: number !! of the card; 0: there is none
    type(plan_problem_t) :: problem

    problem = new_problem(kind, [group%middle, pack(group%base, group%base > 0)], number=number)
    problem%on_line = is_on_line(group)
  end function problem_of_side

  !> Every card must have chosen something.
  pure subroutine check_sides(linkage, sides, problem)
    type(linkage_t), intent(in) :: linkage  !! with all its groups
    type(side_t), intent(in) :: sides(:)    !! of its pins
    type(plan_problem_t), allocatable, intent(inout) :: problem !! with the first card that has not

    integer :: i

    do i = 1, size(sides)
      if (sides(i)%pin > 0) call check_side(linkage, sides(i), i, problem)
      if (allocated(problem)) return
    end do
  end subroutine check_sides

  !> A card of another form than the group of its pin, or about a pin that has one place only. A
  !! group for iterations has the place near the drawing.
  pure subroutine check_side(linkage, side, number, problem)
    type(linkage_t), intent(in) :: linkage
    type(side_t), intent(in) :: side
    integer, intent(in) :: number !! of the card
    type(plan_problem_t), allocatable, intent(inout) :: problem

    integer :: g

    do g = 1, size(linkage%groups)
      associate (group => linkage%groups(g))
        if (group%middle /= side%pin .or. .not. has_two_places(group)) cycle
        if (is_on_line(group) .eqv. side%on_line) return
      end associate
    end do
    do g = 1, size(linkage%groups)
      associate (group => linkage%groups(g))
        if (group%middle /= side%pin .or. .not. has_two_places(group)) cycle
        problem = problem_of_side(problem_other_bases, group, number)
        return
      end associate
    end do
    problem = new_problem(problem_side_idle, [side%pin], bodies_placed_with(linkage, side%pin), &
      number)
  end subroutine check_side

  pure function has_two_places(group) result(has)
    type(group_t), intent(in) :: group
    logical :: has

    has = any(group%kind == [groups_dyad, groups_driven_dyad, groups_on_line, groups_through_pin])
  end function has_two_places

  !> The bodies that iterations place together with a pin.
  pure function bodies_placed_with(linkage, pin) result(bodies)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: pin
    integer, allocatable :: bodies(:)

    integer :: g

    bodies = [integer ::]
    do g = 1, size(linkage%groups)
      if (linkage%groups(g)%kind /= groups_by_newton) cycle
      if (any(linkage%groups(g)%pins == pin)) bodies = linkage%groups(g)%bodies
    end do
  end function bodies_placed_with

end module plan_sides
