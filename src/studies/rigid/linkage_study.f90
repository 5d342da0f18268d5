!> Class, limits and special positions of a four-bar, on both branches.
module linkage_study
  use branch_ranges, only: branch_range_t, find_branch_ranges
  use four_bar_loops, only: four_bar_t
  use four_bar_limits, only: crank_reach, grashof_class, limit_angles, reach_t
  use kinds, only: wp
  use linkages, only: linkage_t, mobility
  use sorting, only: ascending_order
  use special_positions, only: event_names, find_change_points, find_special_positions, &
    special_position_t
  implicit none (type, external)
  private

  public :: linkage_class_t, linkage_result_t, branch_result_t, classify_linkage, find_linkage, &
    class_of_other, &
    event_names, special_position_t

  !> The two branches: open and crossed.
  real(wp), parameter :: sides(2) = [1.0_wp, -1.0_wp]

  !> Properties that every run needs.
  type :: linkage_class_t
    character(len=:), allocatable :: grashof !! Grashof class in words
    type(reach_t) :: reach                   !! crank angles at which the linkage closes
    real(wp), allocatable :: limits(:)       !! (limits) crank angles at which the crank must turn
                                             !! back, 0 ≤ angle < 360, ascending; empty if it turns
                                             !! fully [deg]
  end type linkage_class_t

  type :: branch_result_t
    type(branch_range_t), allocatable :: ranges(:)        !! of crank and follower
    type(special_position_t), allocatable :: positions(:) !! in the order of crank angles
  end type branch_result_t

  type :: linkage_result_t
    integer :: links = 0    !! including the ground
    integer :: mobility = 0 !! degrees of freedom, by counting links and pins
    character(len=:), allocatable :: grashof !! Grashof class in words
    type(branch_result_t) :: branches(2)     !! open, crossed
    type(special_position_t), allocatable :: change_points(:) !! where the branches meet
  end type linkage_result_t

contains

  !> Grashof class and limit positions.
  pure subroutine classify_linkage(four_bar, class)
    type(four_bar_t), intent(in) :: four_bar    !! that the linkage is
    type(linkage_class_t), intent(out) :: class !! Grashof class and limits

    associate (ground => four_bar%ground, length => four_bar%length)
      class%grashof = trim(grashof_class(norm2(ground(:, 2) - ground(:, 1)), length))
      class%reach = crank_reach(ground, length)
      class%limits = modulo(limit_angles(class%reach), 360.0_wp)
    end associate
    class%limits = class%limits(ascending_order(class%limits))
  end subroutine classify_linkage

  !> What runs need of a linkage that is no four-bar: it is in no class, and each position tells
  !! whether it is reached.
  pure function class_of_other() result(class)
    type(linkage_class_t) :: class

    class%grashof = ""
    class%reach%closes = .true.
    allocate (class%limits(0))
  end function class_of_other

  !> Class, mobility, ranges and special positions of both branches, whichever of them the deck's
  !! linkage is on.
  pure subroutine find_linkage(linkage, four_bar, found)
    type(linkage_t), intent(in) :: linkage       !! a four-bar
    type(four_bar_t), intent(in) :: four_bar     !! that it is
    type(linkage_result_t), intent(out) :: found !! open branch first

    type(special_position_t), allocatable :: positions(:)
    real(wp) :: ground(2, 2), length(3)
    integer :: i

    ground = four_bar%ground
    length = four_bar%length
    found%links = size(linkage%bodies) + 1
    found%mobility = mobility(linkage)
    found%grashof = trim(grashof_class(norm2(ground(:, 2) - ground(:, 1)), length))
    do i = 1, size(sides)
      found%branches(i)%ranges = find_branch_ranges(ground, length, sides(i))
      positions = find_special_positions(ground, length, sides(i))
      found%branches(i)%positions = positions(ascending_order(positions%crank))
    end do
    found%change_points = find_change_points(ground, length)
  end subroutine find_linkage

end module linkage_study
