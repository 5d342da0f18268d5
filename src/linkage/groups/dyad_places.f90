!> Places of RRR dyads: two circles meet.
module dyad_places
  use errors, only: error_of_dead_point, error_of_numerics, error_of_reach, error_t, set_error
  use kinds, only: wp
  use linkages, only: cross, group_t, linkage_t, normal_to
  use pose_types, only: pose_t
  implicit none (type, external)
  private

  public :: place_dyad, limit_slack

  !> Relative slack for the area of a dyad's triangle, or the square of a distance: a limit position
  !! missed by rounding is a dead point, not out of reach.
  real(wp), parameter :: limit_slack = 1.0e-11_wp

contains

  !> Intersects the circles about the two bases of a dyad.
  !!
  !! The height of the triangle over the line of the bases comes from its area by Heron's formula,
  !! whose factors vanish exactly where the dyad is stretched or folded.
  !!
  !! Errors: the position is out of reach; the two bases coincide, which leaves the direction of the
  !! dyad undetermined; a link is shorter than the rounding of coordinates.
  pure subroutine place_dyad(linkage, dyad, r, side, pose, sine, error)
    type(linkage_t), intent(in) :: linkage !! last pins of the two bodies
    type(group_t), intent(in) :: dyad      !! of this linkage
    real(wp), intent(in) :: r(2)           !! from each base to the middle [m]
    real(wp), intent(in) :: side           !! as in `group_t`
    type(pose_t), intent(inout) :: pose    !! with the bases; its middle and two bodies are placed
    real(wp), intent(out) :: sine          !! of the dyad; see `pose_t`
    type(error_t), allocatable, intent(inout) :: error !! why it cannot be placed

    real(wp) :: base(2), unit(2), distance, along, four_areas_squared, height, arm(2, 2)
    integer :: k

    base = pose%pin(:, dyad%base(2)) - pose%pin(:, dyad%base(1))
    distance = norm2(base)
    sine = 0.0_wp
    four_areas_squared = (r(1) + r(2) + distance)*(r(1) + r(2) - distance)*(distance + r(1) - &
      r(2))*(distance - r(1) + r(2))
    if (four_areas_squared < -limit_slack*maxval([r, distance])**4) then
      if (distance > sum(r)) then
        call set_error(error, error_of_reach, "the position is out of reach", body=dyad%body(1), &
          other=dyad%body(2), missing=distance - sum(r))
      else
        call set_error(error, error_of_reach, "the position is out of reach", &
          body=dyad%body(maxloc(r, dim=1)), missing=-(abs(r(1) - r(2)) - distance))
      end if
      return
    end if
    ! With both bases at one place, a dead point, the direction of the dyad is undetermined.
    if (distance <= 0.0_wp) then
      call set_error(error, error_of_dead_point, &
        "dead point: the pins that carry the dyad coincide")
      return
    end if
    unit = base/distance
    along = 0.5_wp*(distance + (r(1) - r(2))*(r(1) + r(2))/distance)
    height = 0.5_wp*sqrt(max(four_areas_squared, 0.0_wp))/distance
    pose%pin(:, dyad%middle) = pose%pin(:, dyad%base(1)) + along*unit + &
      side*height*normal_to(unit)

    do k = 1, 2
      arm(:, k) = pose%pin(:, dyad%middle) - pose%pin(:, dyad%base(k))
      ! Far from the reference point a short link is less than the rounding of its ends.
      if (.not. norm2(arm(:, k)) > 0.0_wp) then
        call set_error(error, error_of_numerics, "a link is lost in the rounding of coordinates", &
          body=dyad%body(k))
        return
      end if
      arm(:, k) = arm(:, k)/norm2(arm(:, k))
      pose%direction(:, dyad%body(k)) = merge(1.0_wp, -1.0_wp, &
        linkage%bodies(dyad%body(k))%last_pin == dyad%middle)*arm(:, k)
    end do
    ! At the limit, or beyond it by rounding, what is left of a sine is noise.
    if (four_areas_squared > 0.0_wp) sine = cross(arm(:, 1), arm(:, 2))
  end subroutine place_dyad

end module dyad_places
