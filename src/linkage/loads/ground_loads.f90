!> What springs and dampers that stand on the ground put on it.
module ground_loads
  use applied_load_types, only: applies_along, applies_between
  use kinds, only: wp
  use linkages, only: cross, linkage_t, reference_point
  use load_coordinates, only: load_axis
  use pose_types, only: pose_t
  use terminals, only: terminal_place
  implicit none (type, external)
  private

  public :: pulls_on_ground

contains

  !> Force on the ground, and its moment about `reference_point`, of what pulls at it along lines or
  !! turns bodies against it [N, N m].
  pure function pulls_on_ground(linkage, pose, pull) result(total)
    type(linkage_t), intent(in) :: linkage !! its loads
    type(pose_t), intent(in) :: pose       !! positions in global axes, and directions
    real(wp), intent(in) :: pull(:)        !! (loads) of springs or of dampers, 0 of all others [N]
                                           !! or [N m]
    real(wp) :: total(3)

    real(wp) :: force(2)
    integer :: i, k

    total = 0.0_wp
    do i = 1, size(pull)
      associate (load => linkage%loads(i))
        if (load%kind == applies_between .and. load%body(1) == 0) total(3) = total(3) + pull(i)
        if (load%kind /= applies_along) cycle
        do k = 1, 2
          if (load%at(k)%pin == 0) cycle
          if (.not. linkage%is_ground(load%at(k)%pin)) cycle
          force = merge(pull(i), -pull(i), k == 1)*load_axis(linkage, pose, load)
          total = total + [force, cross(terminal_place(linkage, pose, load%at(k)) - &
            reference_point(linkage), force)]
        end do
      end associate
    end do
  end function pulls_on_ground

end module ground_loads
