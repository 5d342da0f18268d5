!> Bodies whose own line passes through a pin that is placed: on a pin (RPR), or on a line without
!! turning (PPR).
module plan_sliding_bodies
  use body_axes, only: choose_pins, has_pin, other_pin
  use kinds, only: wp
  use linkages, only: group_t, group_cross_slide, group_through_pin, linkage_t
  use plan_equations, only: line_equation, turn_equation
  use plan_progress, only: append_group, carry_rest, known_pin, line_is_known, progress_t, turned_by
  use plan_sides, only: choose_side, side_t
  implicit none (type, external)
  private

  public :: take_through_pin, take_cross_slide

contains

  !> RPR: a body on a known pin whose line passes through another known pin.
  pure subroutine take_through_pin(linkage, sides, done, has_found)
    type(linkage_t), intent(inout) :: linkage !! to whose groups the first such is added
    type(side_t), intent(in) :: sides(:)      !! of its pins
    type(progress_t), intent(inout) :: done   !! what is placed
    logical, intent(out) :: has_found         !! whether there is any

    type(group_t) :: group
    integer :: s, base, body, other

    has_found = .false.
    do s = 1, size(linkage%sliders)
      if (done%slider(s) .or. .not. done%pin(linkage%sliders(s)%pin)) cycle
      body = linkage%sliders(s)%body
      if (body == 0) cycle
      if (done%body(body)) cycle
      base = known_pin(linkage, body, done)
      if (base == 0) cycle
      other = other_pin(linkage%bodies(body), base)
      call choose_pins(linkage, body, base, other)
      done%order = [done%order, body]
      group%kind = group_through_pin
      group%base(1) = base
      group%middle = linkage%sliders(s)%pin
      group%body(1) = body
      group%slider(1) = s
      allocate (group%pins(0), group%equations(1))
      group%bodies = [body]
      group%loaded = [body]
      group%equations(1) = line_equation(linkage, s)
      ! A block lies between the pins of its link, if nothing else is said.
      group%side = sign(1.0_wp, linkage%sliders(s)%direction(1))
      call choose_side(linkage, sides, group)
      done%slider(s) = .true.
      done%body(body) = .true.
      call append_group(linkage, group)
      call carry_rest(linkage, body, [integer ::], done)
      has_found = .true.
      return
    end do
  end subroutine take_through_pin

  !> PPR: a body whose angle is known, with a pin on a known line, and its own line through a known
  !! pin.
  pure subroutine take_cross_slide(linkage, done, has_found)
    type(linkage_t), intent(inout) :: linkage !! to whose groups the first such is added
    type(progress_t), intent(inout) :: done   !! what is placed
    logical, intent(out) :: has_found         !! whether there is any

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
          call choose_pins(linkage, body, linkage%sliders(s)%pin, other_pin(linkage%bodies(body), &
            linkage%sliders(s)%pin))
          done%order = [done%order, body]
          group%kind = group_cross_slide
          group%body(1) = body
          group%middle = linkage%sliders(k)%pin
          group%slider = [s, k]
          group%pins = [linkage%sliders(s)%pin]
          group%bodies = [body]
          group%loaded = [body]
          allocate (group%equations(3))
          group%equations(1) = turn_equation(linkage, t)
          group%equations(2) = line_equation(linkage, s)
          group%equations(3) = line_equation(linkage, k)
          done%turn(t) = .true.
          done%slider([s, k]) = .true.
          done%pin(linkage%sliders(s)%pin) = .true.
          done%body(body) = .true.
          call append_group(linkage, group)
          call carry_rest(linkage, body, [integer ::], done)
          has_found = .true.
          return
        end do
      end do
    end do
  end subroutine take_cross_slide

end module plan_sliding_bodies
