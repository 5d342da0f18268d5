!> Whether a linkage has a steady motion: its crank turns fully.
module steady_turns
  use crank_cycle, only: turns_freely
  use crank_limits, only: turns_fully
  use linkage_paths, only: has_change_points
  use linkages, only: is_dyad_linkage, linkage_t
  implicit none (type, external)
  private

  public :: has_steady_turn

contains

  !> Whether the first drive turns a link fully, without a dead point, and all positions repeat. For
  !! a four-bar that is a closed form; with others it is tried every half degree.
  pure function has_steady_turn(linkage) result(has)
    type(linkage_t), intent(in) :: linkage !! of any kind, with its path
    logical :: has

    logical :: is_four_bar

    is_four_bar = size(linkage%bodies) == 3 .and. size(linkage%is_ground) == 4 .and. &
      is_dyad_linkage(linkage)
    if (is_four_bar) is_four_bar = all(linkage%is_ground .eqv. [.true., .false., .false., .true.])
    if (is_four_bar) then
      has = turns_freely(linkage)
    else
      has = turns_fully(linkage) .and. .not. has_change_points(linkage)
    end if
  end function has_steady_turn

end module steady_turns
