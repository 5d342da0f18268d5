!> Class of a four-bar: properties that every run needs.
module linkage_study
  use four_bar_limits, only: crank_reach, grashof_class, limit_angles, reach_t
  use four_bar_loops, only: four_bar_t
  use kinds, only: wp
  use sorting, only: ascending_order
  implicit none (type, external)
  private

  public :: linkage_class_t, classify_linkage

  !> Of a linkage that is no four-bar: it is in no class, and each position tells whether it is
  !! reached.
  type :: linkage_class_t
    character(len=:), allocatable :: grashof !! Grashof class in words
    logical :: closes = .true.               !! at some crank angle
    real(wp), allocatable :: limits(:)       !! (limits) crank angles at which the crank must turn
                                             !! back, 0 ≤ angle < 360, ascending; empty if it turns
                                             !! fully [deg]
  end type linkage_class_t

contains

  !> Grashof class and limit positions.
  pure subroutine classify_linkage(four_bar, class)
    type(four_bar_t), intent(in) :: four_bar    !! that the linkage is
    type(linkage_class_t), intent(out) :: class !! Grashof class and limits

    type(reach_t) :: reach

    associate (ground => four_bar%ground, length => four_bar%length)
      class%grashof = trim(grashof_class(norm2(ground(:, 2) - ground(:, 1)), length))
      reach = crank_reach(ground, length)
    end associate
    class%closes = reach%closes
    class%limits = modulo(limit_angles(reach), 360.0_wp)
    class%limits = class%limits(ascending_order(class%limits))
  end subroutine classify_linkage

end module linkage_study
