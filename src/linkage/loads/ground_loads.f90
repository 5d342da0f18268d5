!> What springs, dampers and stops that stand on the ground put on it.
module ground_loads
  use applied_load_types, only: applies_along
  use coordinate_types, only: coordinate_t, is_sum
  use coordinates, only: evaluate, evaluated_t
  use kinds, only: wp
  use linkages, only: cross, linkage_t, reference_point
  use pose_types, only: pose_t
  use terminals, only: is_fixed
  implicit none (type, external)
  private

  public :: pulls_on_ground, effort_on_ground

contains

  !> Force on the ground, and its moment about `reference_point`, of what pulls at it [N, N m].
  pure function pulls_on_ground(linkage, pose, along, pull) result(total)
    type(linkage_t), intent(in) :: linkage !! its loads
    type(pose_t), intent(in) :: pose       !! positions and directions
    type(evaluated_t), intent(in) :: along(:) !! (loads) of `evaluate_loads` at this pose
    real(wp), intent(in) :: pull(:)        !! (loads) along coordinates, 0 of all others [N] or
                                           !! [N m]
    real(wp) :: total(3)

    integer :: i

    total = 0.0_wp
    do i = 1, size(pull)
      if (linkage%loads(i)%kind == applies_along) total = total + effort_on_ground(linkage, pose, &
        linkage%loads(i)%along, along(i), -pull(i))
    end do
  end function pulls_on_ground

  !> The same of an effort along a coordinate.
  pure recursive function effort_on_ground(linkage, pose, coordinate, evaluated, effort) &
    result(total)
    type(linkage_t), intent(in) :: linkage         !! the terms of a sum
    type(pose_t), intent(in) :: pose               !! positions and directions
    type(coordinate_t), intent(in) :: coordinate
    type(evaluated_t), intent(in) :: evaluated     !! of it, at this pose
    real(wp), intent(in) :: effort                 !! [N] or [N m]
    real(wp) :: total(3)                           !! as of `pulls_on_ground`

    type(evaluated_t) :: term
    integer :: i

    total = 0.0_wp
    if (coordinate%kind == is_sum) then
      do i = 1, size(coordinate%term)
        call evaluate(linkage, pose, linkage%coordinates(coordinate%term(i)), term)
        total = total + effort_on_ground(linkage, pose, linkage%coordinates(coordinate%term(i)), &
          term, coordinate%weight(i)*effort)
      end do
      return
    end if
    do i = 1, 2
      if (.not. is_fixed(linkage, coordinate%at(i))) cycle
      associate (wrench => evaluated%wrench(i), force => effort*evaluated%wrench(i)%force)
        total = total + [force, effort*wrench%couple + cross(wrench%place + pose%origin - &
          reference_point(linkage), force)]
      end associate
    end do
  end function effort_on_ground

end module ground_loads
