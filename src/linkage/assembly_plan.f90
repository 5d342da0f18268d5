!> The order in which a linkage is placed: groups of pins and bodies, each of which its equations
!! place from what is placed before.
!!
!! Dyads are recognized one after the other: two loci of a pin, circles about known pins or known
!! lines, place it. What is left where none can be is matched, equations with unknowns, and placed
!! by iterations. Equations that are fulfilled by what is placed already are redundancies, to be
!! checked at every position. The drives are used first, then parts in the order of the deck: of
!! several that would do, the last is the redundant one.
module assembly_plan
  use linkages, only: linkage_t
  use plan_dyads, only: take_meeting
  use plan_equations, only: append_equation, line_equation, turn_equation
  use plan_iterations, only: take_rest
  use plan_problems, only: check_plain_faults, new_problem, plan_problem_t, problem_drive_idle
  use plan_progress, only: new_progress, progress_t
  use plan_sides, only: check_sides, side_t
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
    done = new_progress(linkage)
    linkage%has_crank = .false.
    call take_crank(linkage, done)
    do
      call place_next(linkage, sides, done, problem, has_found)
      if (allocated(problem)) return
      if (has_found) cycle
      if (all(done%pin) .and. all(done%body)) exit
      call take_rest(linkage, done, problem, has_found)
      if (allocated(problem)) return
    end do
    call collect_redundancies(linkage, done, problem)
    ! Of links more than needed, others than those that a card is about may place its pin.
    if (.not. allocated(problem) .and. size(linkage%redundancies) == 0) call check_sides(linkage, &
      sides, problem)
    body_order = done%order
    pin_order = pins_in_order(linkage, body_order)
  end subroutine plan_linkage

  !> Places what one group of a known kind can place. `has_found` if there is any.
  pure subroutine place_next(linkage, sides, done, problem, has_found)
    type(linkage_t), intent(inout) :: linkage
    type(side_t), intent(in) :: sides(:)
    type(progress_t), intent(inout) :: done
    type(plan_problem_t), allocatable, intent(inout) :: problem
    logical, intent(out) :: has_found

    call take_drives(linkage, done, has_found)
    if (.not. has_found) call take_turns(linkage, done, has_found)
    if (.not. has_found) call take_spanned(linkage, done, has_found)
    if (.not. has_found) call take_meeting(linkage, sides, done, problem, has_found)
    if (.not. has_found) call take_through_pin(linkage, sides, done, problem, has_found)
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
