!> Whether a linkage has a steady motion: its crank turns fully.
module full_turns
  use crank_cycle, only: turns_freely
  use crank_limits, only: turns_fully
  use four_bar_loops, only: find_four_bar, four_bar_t
  use linkage_paths, only: has_change_points
  use linkages, only: linkage_t
  implicit none (type, external)
  private

  public :: has_steady_turn

contains

  !> Whether the first drive turns a link fully, without a dead point, and all positions repeat. For
  !! a four-bar that is a closed form; with others it is tried every half degree.
  pure function has_steady_turn(linkage) result(has)
    type(linkage_t), intent(in) :: linkage !! of any kind, with its path
    logical :: has

    type(four_bar_t), allocatable :: four_bar

    call find_four_bar(linkage, four_bar)
    if (allocated(four_bar)) then
      has = turns_freely(linkage, four_bar)
    else
      has = turns_fully(linkage) .and. .not. has_change_points(linkage)
    end if
  end function has_steady_turn

end module full_turns
