!> Which of two places a pin has: from a card, else from the drawing.
module plan_sides
  use kinds, only: wp
  use linkages, only: cross, group_t, group_by_newton, group_driven_dyad, group_dyad, &
    group_on_line, group_through_pin, linkage_t, turned
  use plan_problems, only: new_problem, plan_problem_t, problem_no_side, problem_other_bases, &
    problem_side_idle
  use pose_types, only: pins_of_body
  implicit none (type, external)
  private

  public :: side_t, undecided_t, choose_side, card_about, find_undecided, problem_of_group, &
    problem_of_card, find_line, has_two_places, is_on_line, drawn_line

  !> On which side a pin lies, of two ways to place it.
  type :: side_t
    integer :: pin = 0
    real(wp) :: side = 1.0_wp   !! +1: to the left of base 1 → base 2, or forward on the line
    integer :: base(2) = 0      !! pins
    logical :: on_line = .false. !! forward or backward: without bases
  end type side_t

  !> What cards leave to be found of an assembly.
  type :: undecided_t
    integer, allocatable :: groups(:)   !! numbers of those without a card
    logical, allocatable :: is_open(:)  !! (groups) neither the drawing nor a rule gives the side
    integer, allocatable :: cards(:)    !! numbers of those that choose the side of no group
  end type undecided_t

contains

  !> The side of a group: that of a card about it, else that of the drawing. A group with neither
  !! keeps the side that it has.
  pure subroutine choose_side(linkage, sides, group)
    type(linkage_t), intent(in) :: linkage  !! bodies, sliders, and the drawing
    type(side_t), intent(in) :: sides(:)    !! of its pins
    type(group_t), intent(inout) :: group   !! with its bases and its middle; its side is set

    integer :: number
    logical :: is_known

    number = card_about(sides, group)
    if (number > 0) then
      group%side = sides(number)%side
      if (.not. is_on_line(group) .and. sides(number)%base(1) /= group%base(1)) group%side = &
        -group%side
    else
      call take_drawn_side(linkage, group, is_known)
    end if
  end subroutine choose_side

  !> The card that chooses the side of a group: about its middle, of its form, with its bases; 0:
  !! none.
  pure function card_about(sides, group) result(number)
    type(side_t), intent(in) :: sides(:)
    type(group_t), intent(in) :: group
    integer :: number

    number = 0
    if (.not. has_two_places(group)) return
    do number = size(sides), 1, -1
      associate (side => sides(number))
        if (side%pin /= group%middle .or. (side%on_line .neqv. is_on_line(group))) cycle
        if (side%on_line .or. all(side%base == group%base) .or. all(side%base == &
          group%base([2, 1]))) return
      end associate
    end do
  end function card_about

  !> The groups whose side no card chooses, and the cards that choose none.
  pure function find_undecided(linkage, sides) result(undecided)
    type(linkage_t), intent(in) :: linkage !! with all its groups, and the drawing
    type(side_t), intent(in) :: sides(:)   !! of its pins
    type(undecided_t) :: undecided

    type(group_t) :: group
    logical :: is_idle(size(sides)), is_known
    integer :: g, i

    is_idle = sides%pin > 0
    allocate (undecided%groups(0), undecided%is_open(0))
    do g = 1, size(linkage%groups)
      group = linkage%groups(g)
      if (.not. has_two_places(group)) cycle
      i = card_about(sides, group)
      if (i > 0) then
        is_idle(i) = .false.
        cycle
      end if
      call take_drawn_side(linkage, group, is_known)
      undecided%groups = [undecided%groups, g]
      undecided%is_open = [undecided%is_open, .not. is_known .and. group%kind /= &
        group_through_pin]
    end do
    undecided%cards = pack([(i, i=1, size(sides))], is_idle)
  end function find_undecided

  !> Whether the side of a group is one along a line; else it is one of the way between its bases.
  pure function is_on_line(group) result(is)
    type(group_t), intent(in) :: group
    logical :: is

    is = any(group%kind == [group_on_line, group_through_pin])
  end function is_on_line

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

  !> The line along which a pin may lie forward or backward, and the pin from which that counts: of
  !! a guide that by which a body reaches it, of a body that about which it turns.
  pure subroutine find_line(linkage, pin, slider, base)
    type(linkage_t), intent(in) :: linkage !! sliders and bodies
    integer, intent(in) :: pin
    integer, intent(out) :: slider, base   !! numbers; 0: there is none

    integer, allocatable :: pins(:)
    integer :: s, b

    slider = 0
    base = 0
    do s = 1, size(linkage%sliders)
      if (linkage%sliders(s)%pin /= pin) cycle
      slider = s
      if (linkage%sliders(s)%body > 0) then
        base = linkage%bodies(linkage%sliders(s)%body)%first_pin
        return
      end if
      do b = 1, size(linkage%bodies)
        pins = pins_of_body(linkage%bodies(b))
        if (.not. any(pins == pin)) cycle
        base = pins(findloc(pins /= pin, .true., dim=1))
        return
      end do
    end do
  end subroutine find_line

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

  !> A group without a side; perhaps a card about its middle is of the other form.
  pure function problem_of_group(group, sides) result(problem)
    type(group_t), intent(in) :: group
    type(side_t), intent(in) :: sides(:) !! of its pins
    type(plan_problem_t) :: problem

    integer :: number

    number = findloc(sides%pin, group%middle, dim=1)
    problem = problem_of_side(merge(problem_other_bases, problem_no_side, number > 0), group, &
      number)
  end function problem_of_group

  !> A card that chooses nothing: of another form than the group of its pin, about other bases, or
  !! about a pin that has one place only. A group for iterations has the place near the drawing.
  pure function problem_of_card(linkage, sides, number) result(problem)
    type(linkage_t), intent(in) :: linkage !! with all its groups
    type(side_t), intent(in) :: sides(:)   !! of its pins
    integer, intent(in) :: number          !! of the card
    type(plan_problem_t) :: problem

    integer :: g, own

    own = 0
    do g = size(linkage%groups), 1, -1
      associate (group => linkage%groups(g))
        if (group%middle /= sides(number)%pin .or. .not. has_two_places(group)) cycle
        if (own == 0 .or. (is_on_line(group) .eqv. sides(number)%on_line)) own = g
      end associate
    end do
    if (own > 0) then
      problem = problem_of_side(problem_other_bases, linkage%groups(own), number)
    else
      problem = new_problem(problem_side_idle, [sides(number)%pin], bodies_placed_with(linkage, &
        sides(number)%pin), number)
    end if
  end function problem_of_card

  !> A problem with the side of a group, about its middle and its bases.
  pure function problem_of_side(kind, group, number) result(problem)
    integer, intent(in) :: kind
    type(group_t), intent(in) :: group
    integer, intent(in) :: number !! of the card; 0: there is none
    type(plan_problem_t) :: problem

    problem = new_problem(kind, [group%middle, pack(group%base, group%base > 0)], number=number)
    problem%on_line = is_on_line(group)
  end function problem_of_side

  !> Whether a group has two places: one on each side.
  pure function has_two_places(group) result(has)
    type(group_t), intent(in) :: group
    logical :: has

    has = any(group%kind == [group_dyad, group_driven_dyad, group_on_line, group_through_pin])
  end function has_two_places

  !> The bodies that iterations place together with a pin.
  pure function bodies_placed_with(linkage, pin) result(bodies)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: pin
    integer, allocatable :: bodies(:)

    integer :: g

    bodies = [integer ::]
    do g = 1, size(linkage%groups)
      if (linkage%groups(g)%kind /= group_by_newton) cycle
      if (any(linkage%groups(g)%pins == pin)) bodies = linkage%groups(g)%bodies
    end do
  end function bodies_placed_with

end module plan_sides
