!> Blocks that slide along links: whether they are still between the ends of their links.
module block_ends
  use coordinates, only: coordinate_value, slider_coordinate
  use errors, only: error_of_reach, error_t, set_error
  use kinds, only: wp
  use linkages, only: linkage_t
  use pose_types, only: pose_t
  implicit none (type, external)
  private

  public :: refuse_leaving_block, leaving_block

  !> Rounding of a place, as a share of the way between the ends.
  real(wp), parameter :: slack = 1.0e-9_wp

contains

  !> An error where a block is beyond an end of its link; its place has the link and the pin.
  pure subroutine refuse_leaving_block(linkage, pose, error)
    type(linkage_t), intent(in) :: linkage !! its sliders and their ends
    type(pose_t), intent(in) :: pose       !! of all pins and bodies
    type(error_t), allocatable, intent(inout) :: error !! allocated if there is such a block

    integer :: number

    number = leaving_block(linkage, pose)
    if (number == 0) return
    call set_error(error, error_of_reach, "the block leaves its link", &
      body=linkage%sliders(number)%body, pin=linkage%sliders(number)%pin)
  end subroutine refuse_leaving_block

  !> The first slider whose block is beyond an end of its link; 0: there is none.
  pure function leaving_block(linkage, pose) result(number)
    type(linkage_t), intent(in) :: linkage !! its sliders and their ends
    type(pose_t), intent(in) :: pose       !! of all pins and bodies
    integer :: number

    real(wp) :: place, rounding

    do number = 1, size(linkage%sliders)
      associate (slider => linkage%sliders(number))
        if (slider%body == 0 .or. .not. slider%has_ends) cycle
        place = coordinate_value(linkage, pose, slider_coordinate(linkage, number))
        rounding = slack*(slider%ends(2) - slider%ends(1))
        if (place < slider%ends(1) - rounding .or. place > slider%ends(2) + rounding) return
      end associate
    end do
    number = 0
  end function leaving_block

end module block_ends
