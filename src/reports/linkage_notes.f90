!> Notes on the linkage, for the heads of tables, the log, and messages about what it does not reach.
module linkage_notes
  use four_bar_limits, only: reach_t
  use kinds, only: wp
  use mechanisms, only: mechanism_t
  use text, only: append_string, string_t, to_string
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: notes_on_linkage, angle_note
  public :: open_linkage_text, longest_link, reachable_text, reachable_intervals

contains

  !> Grashof class, limit positions, extreme transmission angles; or that the linkage does not
  !! close.
  pure function notes_on_linkage(variant) result(notes)
    type(variant_results_t), intent(in) :: variant !! with class and kinematics computed
    type(string_t), allocatable :: notes(:)

    character(len=:), allocatable :: limits
    integer :: i

    associate (class => variant%found%class, found => variant%found%kinematics, &
        crank => variant%found%positions%crank, state => variant%found%positions%state)
      call append_string(notes, class%grashof)
      if (.not. class%reach%closes) then
        call append_string(notes, variant%unreachable)
        return
      end if
      limits = "limit positions of the crank: none"
      do i = 1, size(class%limits)
        if (i == 1) limits = "limit positions of the crank:"
        limits = limits//" "//to_string(class%limits(i), 9)
      end do
      if (size(class%limits) > 0) limits = limits//" deg"
      call append_string(notes, limits)
      if (found%at_least == 0) return
      call append_string(notes, "transmission angle: "// &
        to_string(found%transmission(state(found%at_least)))//" deg at crank "// &
        to_string(crank(found%at_least), 10)//" to "// &
        to_string(found%transmission(state(found%at_most)))//" deg at crank "// &
        to_string(crank(found%at_most), 10))
    end associate
  end function notes_on_linkage

  !> The links with the angles theta3 and theta4, and the pins from and to which these are
  !! measured.
  pure function angle_note(variant) result(note)
    type(variant_results_t), intent(in) :: variant !! with its mechanism
    character(len=:), allocatable :: note

    associate (names => variant%mechanism%names, pins => variant%mechanism%pin_names)
      note = "3: link "//names(2)%text//", angle from "//pins(2)%text//" to "//pins(3)%text// &
        "; 4: link "//names(3)%text//", angle from "//pins(4)%text//" to "//pins(3)%text
    end associate
  end function angle_note

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

end module linkage_notes
