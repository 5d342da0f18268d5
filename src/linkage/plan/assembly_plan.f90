!> The order in which a linkage is placed: groups of pins and bodies, each of which its equations
!! place from what is placed before.
!!
!! Dyads are recognized one after the other: two loci of a pin, circles about known pins or known
!! lines, place it. What is left where none can be is matched, equations with unknowns, and placed
!! by iterations. Equations that are fulfilled by what is placed already are redundancies, to be
!! checked at every position. The drives are used first, then parts in the order of the deck: of
!! several that would do, the last is the redundant one.
module assembly_plan
  use body_axes, only: has_pin
  use linkages, only: linkage_t
  use plan_dyads, only: take_meeting
  use plan_equations, only: append_equation, line_equation, renew_equations, turn_equation
  use plan_iterations, only: take_rest
  use plan_problems, only: check_plain_faults, new_problem, plan_problem_t, problem_drive_idle
  use plan_progress, only: new_progress, progress_t
  use plan_sides, only: find_line, find_undecided, problem_of_card, problem_of_group, side_t, &
    undecided_t
  use plan_sliding_bodies, only: take_cross_slide, take_through_pin
  use plan_turned_bodies, only: take_crank, take_drives, take_spanned, take_turns
  use pose_types, only: pins_of_body
  implicit none (type, external)
  private

  public :: plan_linkage

contains

  !> Plans the groups of a linkage, and chooses the first and last pins of its bodies.
  !!
  !! The order of bodies and pins that follows is that in which they are placed; a linkage in that
  !! order has the same plan. Cards about pins that other dyads than those of the plan could place
  !! are undecided; else every group that has two places has its side.
  pure subroutine plan_linkage(linkage, sides, problem, body_order, pin_order, undecided)
    type(linkage_t), intent(inout) :: linkage !! bodies with all their pins, sliders, turns and
                                              !! drives, the drawing; groups are set
    type(side_t), intent(in) :: sides(:)      !! of its pins
    type(plan_problem_t), allocatable, intent(out) :: problem !! why there is no plan
    integer, allocatable, intent(out) :: body_order(:)        !! their numbers in the order in which
                                                              !! they are placed
    integer, allocatable, intent(out) :: pin_order(:)         !! their numbers in the order in which
                                                              !! bodies have them
    type(undecided_t), intent(out) :: undecided               !! what `choose_assembly` has to find

    type(progress_t) :: done
    integer :: i

    allocate (body_order(0), pin_order(0))
    call check_plain_faults(linkage, problem)
    if (allocated(problem)) return
    call plan_groups(linkage, sides, done, problem)
    if (allocated(problem)) return
    call collect_redundancies(linkage, done, problem)
    call renew_equations(linkage, linkage%redundancies)
    do i = 1, size(linkage%groups)
      if (allocated(linkage%groups(i)%equations)) call renew_equations(linkage, &
        linkage%groups(i)%equations)
    end do
    undecided = find_undecided(linkage, sides)
    if (.not. allocated(problem)) call check_sides(linkage, sides, undecided, problem)
    body_order = done%order
    pin_order = pins_in_order(linkage, body_order)
  end subroutine plan_linkage

  !> Places all pins and bodies, group by group.
  pure subroutine plan_groups(linkage, sides, done, problem)
    type(linkage_t), intent(inout) :: linkage
    type(side_t), intent(in) :: sides(:)
    type(progress_t), intent(out) :: done !! what is placed before a problem
    type(plan_problem_t), allocatable, intent(inout) :: problem

    logical :: has_found

    if (allocated(linkage%groups)) deallocate (linkage%groups)
    if (allocated(linkage%redundancies)) deallocate (linkage%redundancies)
    allocate (linkage%groups(0), linkage%redundancies(0))
    done = new_progress(linkage)
    linkage%has_crank = .false.
    call take_crank(linkage, done)
    do
      call place_next(linkage, sides, done, has_found)
      if (has_found) cycle
      if (all(done%pin) .and. all(done%body)) exit
      call take_rest(linkage, done, problem, has_found)
      if (allocated(problem)) return
    end do
  end subroutine plan_groups

  !> Every card must be about a group, or about a pin that another dyad could place; every group has
  !! a side then.
  pure subroutine check_sides(linkage, sides, undecided, problem)
    type(linkage_t), intent(in) :: linkage
    type(side_t), intent(in) :: sides(:)
    type(undecided_t), intent(in) :: undecided
    type(plan_problem_t), allocatable, intent(inout) :: problem

    integer :: i

    do i = 1, size(undecided%cards)
      if (has_other_dyad(linkage, sides(undecided%cards(i)))) cycle
      problem = problem_of_card(linkage, sides, undecided%cards(i))
      return
    end do
    if (size(undecided%cards) > 0 .or. .not. any(undecided%is_open)) return
    i = findloc(undecided%is_open, .true., dim=1)
    problem = problem_of_group(linkage%groups(undecided%groups(i)), sides)
  end subroutine check_sides

  !> Whether the pins that carry the pin of a card are placed even if nothing joins it to them.
  pure function has_other_dyad(linkage, card) result(has)
    type(linkage_t), intent(in) :: linkage
    type(side_t), intent(in) :: card
    logical :: has

    type(linkage_t) :: cut
    integer :: slider, base, a, b

    has = .false.
    if (card%on_line) then
      call find_line(linkage, card%pin, slider, base)
      if (base == 0) return
      cut = linkage
      call add_pin_like(cut, card%pin)
      cut%sliders(slider)%pin = size(cut%is_ground)
      ! The pin of a guide is what its line places, that of a body places it.
      has = are_placed(cut, merge([base, card%pin], [base, base], &
        linkage%sliders(slider)%body > 0))
      return
    end if
    do a = 1, size(linkage%bodies)
      if (.not. all([has_pin(linkage%bodies(a), card%pin), has_pin(linkage%bodies(a), &
        card%base(1))])) cycle
      do b = 1, size(linkage%bodies)
        if (b == a .or. .not. all([has_pin(linkage%bodies(b), card%pin), &
          has_pin(linkage%bodies(b), card%base(2))])) cycle
        cut = linkage
        call release(cut, b, card%pin)
        has = has .or. are_placed(cut, card%base)
      end do
    end do
  end function has_other_dyad

  !> Whether two pins of a linkage have a plan, on whatever sides.
  pure function are_placed(linkage, pins) result(are)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: pins(2)
    logical :: are

    type(linkage_t) :: planned
    type(progress_t) :: done
    type(plan_problem_t), allocatable :: problem

    planned = linkage
    call plan_groups(planned, [side_t ::], done, problem)
    are = all(done%pin(pins))
  end function are_placed

  !> Gives a body a pin of its own in place of one that it shares.
  pure subroutine release(linkage, body, pin)
    type(linkage_t), intent(inout) :: linkage
    integer, intent(in) :: body, pin

    integer :: new

    call add_pin_like(linkage, pin)
    new = size(linkage%is_ground)
    associate (it => linkage%bodies(body))
      if (it%first_pin == pin) it%first_pin = new
      if (it%last_pin == pin) it%last_pin = new
      where (it%further%pin == pin) it%further%pin = new
    end associate
  end subroutine release

  !> Adds a moving pin, drawn where another one is.
  pure subroutine add_pin_like(linkage, pin)
    type(linkage_t), intent(inout) :: linkage
    integer, intent(in) :: pin

    linkage%is_ground = [linkage%is_ground, .false.]
    associate (drawing => linkage%drawing)
      drawing%is_drawn = [drawing%is_drawn, drawing%is_drawn(pin)]
      drawing%pin = reshape([drawing%pin, drawing%pin(:, pin)], [2, size(drawing%is_drawn)])
    end associate
  end subroutine add_pin_like

  !> Places what one group of a known kind can place. `has_found` if there is any.
  pure subroutine place_next(linkage, sides, done, has_found)
    type(linkage_t), intent(inout) :: linkage
    type(side_t), intent(in) :: sides(:)
    type(progress_t), intent(inout) :: done
    logical, intent(out) :: has_found

    call take_drives(linkage, done, has_found)
    if (.not. has_found) call take_turns(linkage, done, has_found)
    if (.not. has_found) call take_spanned(linkage, done, has_found)
    if (.not. has_found) call take_meeting(linkage, sides, done, has_found)
    if (.not. has_found) call take_through_pin(linkage, sides, done, has_found)
    if (.not. has_found) call take_cross_slide(linkage, done, has_found)
  end subroutine place_next

  !> What nothing has used: it must be fulfilled by what is placed. A drive that is not used is a
  !! problem.
  pure subroutine collect_redundancies(linkage, done, problem)
    type(linkage_t), intent(inout) :: linkage
    type(progress_t), intent(in) :: done
    type(plan_problem_t), allocatable, intent(inout) :: problem

    integer :: i

    do i = 1, size(done%drive)
      if (done%drive(i)) cycle
      problem = new_problem(problem_drive_idle, number=i)
      problem%mobility = count(done%drive)
      return
    end do
    do i = 1, size(done%turn)
      if (done%turn(i)) cycle
      call append_equation(linkage%redundancies, turn_equation(linkage, i))
    end do
    do i = 1, size(done%slider)
      if (done%slider(i)) cycle
      call append_equation(linkage%redundancies, line_equation(linkage, i))
    end do
  end subroutine collect_redundancies

  !> The pins in the order in which the bodies have them: first and last ones, further ones, those
  !! of sliders alone.
  pure function pins_in_order(linkage, body_order) result(pin_order)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: body_order(:)
    integer, allocatable :: pin_order(:)

    integer, allocatable :: pins(:)
    integer :: i, k

    allocate (pin_order(0))
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
  end function pins_in_order

end module assembly_plan
