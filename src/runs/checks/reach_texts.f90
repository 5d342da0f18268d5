!> What a four-bar reaches, in words: for messages about a deck and for failed rows.
module reach_texts
  use four_bar_limits, only: reach_t
  use kinds, only: wp
  use mechanisms, only: mechanism_t
  use text, only: to_string
  implicit none (type, external)
  private

  public :: open_linkage_text, longest_link, reachable_text, reachable_intervals

contains

  !> Why a linkage closes at no crank angle: one link is longer than all the others together.
  pure function open_linkage_text(mechanism) result(text)
    type(mechanism_t), intent(in) :: mechanism !! whose linkage does not close
    character(len=:), allocatable :: text

    integer :: longest

    longest = longest_link(mechanism)
    if (longest == 0) then
      text = "the linkage closes at no crank angle: the ground pivots are farther "// &
        "apart than the three links together are long"
    else
      text = "the linkage closes at no crank angle: link '"//mechanism%names(longest)%text// &
        "' is longer than the other links and the distance of the ground pivots together"
    end if
  end function open_linkage_text

  !> Number of the longest link.
  pure function longest_link(mechanism) result(longest)
    type(mechanism_t), intent(in) :: mechanism !! a four-bar
    integer :: longest                         !! body; 0: the ground

    associate (ground => mechanism%linkage%ground_position, &
      length => mechanism%linkage%bodies%length)
      longest = maxloc(length, dim=1)
      if (norm2(ground(:, 4) - ground(:, 1)) > length(longest)) longest = 0
    end associate
  end function longest_link

  !> `between -132.6 and 132.6 deg`
  pure function reachable_text(reach) result(phrase)
    type(reach_t), intent(in) :: reach !! of a linkage that closes
    character(len=:), allocatable :: phrase

    real(wp), allocatable :: limits(:, :)
    integer :: i

    limits = reachable_intervals(reach)
    phrase = ""
    do i = 1, size(limits, 2)
      if (i > 1) phrase = phrase//" and "
      phrase = phrase//"between "//to_string(limits(1, i), 7)//" and "//to_string(limits(2, i), 7)
    end do
    phrase = phrase//" deg"
  end function reachable_text

  !> The crank angles at which a linkage closes: one interval or two, from the global x axis.
  pure function reachable_intervals(reach) result(limits)
    type(reach_t), intent(in) :: reach    !! of a linkage that closes
    real(wp), allocatable :: limits(:, :) !! (2, intervals) [deg]

    real(wp), parameter :: near_zero = 1.0e-9_wp

    if (reach%least <= near_zero) then
      limits = reshape([-reach%most, reach%most], [2, 1])
    else if (reach%most >= 180.0_wp - near_zero) then
      limits = reshape([reach%least, 360.0_wp - reach%least], [2, 1])
    else
      limits = reshape([reach%least, reach%most, 360.0_wp - reach%most, 360.0_wp - reach%least], &
        [2, 2])
    end if
    limits = limits + reach%ground
  end function reachable_intervals

end module reach_texts
