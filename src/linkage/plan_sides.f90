!> On which side a pin lies that has two places.
module plan_sides
  use kinds, only: wp
  use linkages, only: linkage_t, turned
  use plan_problems, only: new_problem, plan_problem_t
  implicit none (type, external)
  private

  public :: side_t, report_side, drawn_line

  !> On which side a pin lies, of two ways to place it.
  type :: side_t
    integer :: pin = 0
    real(wp) :: side = 1.0_wp !! +1: to the left of base 1 → base 2, or forward on the line
    integer :: base(2) = 0    !! pins; 0: on a line
  end type side_t

contains

  pure subroutine report_side(problem, kind, pin, bases, number, on_line)
    type(plan_problem_t), allocatable, intent(inout) :: problem
    integer, intent(in) :: kind, pin
    integer, intent(in) :: bases(:)
    integer, intent(in) :: number
    logical, intent(in) :: on_line

    problem = new_problem(kind, [pin, bases], number=number)
    problem%on_line = on_line
  end subroutine report_side

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

end module plan_sides
