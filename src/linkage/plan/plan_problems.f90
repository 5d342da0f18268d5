!> What may stand in the way of a plan, and the faults that are seen without one.
module plan_problems
  use linkages, only: linkage_t
  use pose_types, only: pins_of_body
  implicit none (type, external)
  private

  public :: plan_problem_t, new_problem, check_plain_faults
  public :: problem_too_free, problem_braced, problem_no_side, problem_other_bases, &
    problem_drive_idle, problem_not_drawn, problem_side_idle, problem_sides_differ

  !> What may be wrong: pins that nothing holds; a link that joins two pins of another one; a dyad
  !! with neither a side nor a drawing; a side that names other pins than those that carry the dyad,
  !! or is of the other form; a drive that moves nothing; pins that only a drawing can place; a side
  !! of a pin that has one place only; sides that no assembly has together.
  integer, parameter :: problem_too_free = 1, problem_braced = 2, problem_no_side = 3, &
    problem_other_bases = 4, problem_drive_idle = 5, problem_not_drawn = 6, &
    problem_side_idle = 7, problem_sides_differ = 8

  !> Why there is no plan.
  type :: plan_problem_t
    integer :: kind = 0              !! one of the problem_… constants
    integer :: mobility = 0          !! of the linkage
    integer, allocatable :: pins(:)  !! that it is about
    integer, allocatable :: bodies(:) !! that it is about
    integer :: number = 0            !! of a drive that moves nothing, or of a side; 0: of none
    integer :: other = 0             !! number of a further side; 0: of none
    integer, allocatable :: redundant(:) !! bodies of equations that elsewhere are more than needed;
                                     !! 0: of guides alone
    logical :: on_line = .false.     !! the side is one on a line
  end type plan_problem_t

contains

  !> Faults that need no plan: links between ground pivots or between pins of one other link.
  pure subroutine check_plain_faults(linkage, problem)
    type(linkage_t), intent(in) :: linkage                    !! bodies, turns and drives
    type(plan_problem_t), allocatable, intent(out) :: problem !! the first fault, if there is any

    integer :: i

    do i = 1, size(linkage%bodies)
      call check_body(linkage, i, problem)
      if (allocated(problem)) return
    end do
  end subroutine check_plain_faults

  !> A body has one ground pivot at most, and one pin at most in common with any other, unless it
  !! is a beam.
  pure subroutine check_body(linkage, number, problem)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: number !! of the body
    type(plan_problem_t), allocatable, intent(inout) :: problem

    integer, allocatable :: pins(:), others(:)
    logical, allocatable :: is_common(:)
    integer :: c, i

    pins = pins_of_body(linkage%bodies(number))
    if (count(linkage%is_ground(pins)) >= 2 .and. .not. linkage%bodies(number)%may_brace) then
      problem = new_problem(problem_braced, pack(pins, linkage%is_ground(pins)), [number])
      return
    end if
    do c = 1, number - 1
      others = pins_of_body(linkage%bodies(c))
      is_common = [(any(others == pins(i)), i=1, size(pins))]
      if (count(is_common) < 2 .or. linkage%bodies(number)%may_brace .or. &
        linkage%bodies(c)%may_brace) cycle
      problem = new_problem(problem_braced, pack(pins, is_common), [number, c])
      ! The smaller one is the brace.
      if (size(others) < size(pins)) problem%bodies = [c, number]
      return
    end do
  end subroutine check_body

  !> A problem with the parts that it is about.
  pure function new_problem(kind, pins, bodies, number) result(problem)
    integer, intent(in) :: kind                !! one of the problem_… constants
    integer, intent(in), optional :: pins(:)   !! that it is about
    integer, intent(in), optional :: bodies(:) !! that it is about
    integer, intent(in), optional :: number    !! of a drive, or of a side
    type(plan_problem_t) :: problem

    problem%kind = kind
    problem%pins = [integer ::]
    problem%bodies = [integer ::]
    problem%redundant = [integer ::]
    if (present(pins)) problem%pins = pins
    if (present(bodies)) problem%bodies = bodies
    if (present(number)) problem%number = number
  end function new_problem

end module plan_problems
