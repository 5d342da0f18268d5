!> What springs, dampers and stops that stand on the ground put on it.
module ground_loads
  use applied_load_types, only: applies_along
  use coordinate_types, only: coordinate_t, is_sum, wrench_t
  use coordinates, only: coordinate_wrenches
  use kinds, only: wp
  use linkages, only: cross, linkage_t, reference_point
  use pose_types, only: pose_t
  use terminals, only: is_fixed
  implicit none (type, external)
  private

  public :: pulls_on_ground

contains

  !> Force on the ground, and its moment about `reference_point`, of what pulls at it [N, N m].
  pure function pulls_on_ground(linkage, pose, pull) result(total)
    type(linkage_t), intent(in) :: linkage !! its loads
    type(pose_t), intent(in) :: pose       !! positions and directions
    real(wp), intent(in) :: pull(:)        !! (loads) along coordinates, 0 of all others [N] or
                                           !! [N m]
    real(wp) :: total(3)

    integer :: i

    total = 0.0_wp
    do i = 1, size(pull)
      if (linkage%loads(i)%kind == applies_along) total = total + on_ground(linkage, pose, &
        linkage%loads(i)%along, -pull(i))
    end do
  end function pulls_on_ground

  !> The same of an effort along a coordinate.
  pure recursive function on_ground(linkage, pose, coordinate, effort) result(total)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(coordinate_t), intent(in) :: coordinate
    real(wp), intent(in) :: effort !! [N] or [N m]
    real(wp) :: total(3)

    type(wrench_t) :: wrench(2)
    integer :: i

    total = 0.0_wp
    if (coordinate%kind == is_sum) then
      do i = 1, size(coordinate%term)
        total = total + on_ground(linkage, pose, linkage%coordinates(coordinate%term(i)), &
          coordinate%weight(i)*effort)
      end do
      return
    end if
    wrench = coordinate_wrenches(linkage, pose, coordinate)
    do i = 1, 2
      if (.not. is_fixed(linkage, coordinate%at(i))) cycle
      associate (force => effort*wrench(i)%force)
        total = total + [force, effort*wrench(i)%couple + cross(wrench(i)%place + pose%origin - &
          reference_point(linkage), force)]
      end associate
    end do
  end function on_ground

end module ground_loads
