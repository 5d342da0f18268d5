!> Positions of the links at a crank angle.
module poses
  use constants, only: degree
  use errors, only: error_of_dead_point, error_of_reach, error_t, set_error
  use kinds, only: wp
  use linkages, only: cross, dyad_t, linkage_t, normal_to
  use text, only: to_string
  implicit none (type, external)
  private

  public :: pose_t, find_pose, place_links, arm_to_middle, arm_to_place, body_angle, &
    transmission_angle, dead_point_sine

  !> Positions of the pins and directions of the bodies.
  type :: pose_t
    real(wp), allocatable :: pin(:, :)       !! (2, pins) positions [m]
    real(wp), allocatable :: direction(:, :) !! (2, bodies) unit vectors, first → last pin
    real(wp), allocatable :: sine(:)         !! (dyads) of the angle from base 1 → middle to base 2
                                             !! → middle; 0 at a dead point
  end type pose_t

  !> Where |sin(θ4 − θ3)| is below this, near a dead point, the motion is not computed: velocities
  !! grow like 1/sin(θ4 − θ3).
  real(wp), parameter :: dead_point_sine = 1.0e-6_wp

  !> Relative slack for the area of the dyad's triangle: a limit position missed by rounding is a
  !! dead point, not out of reach.
  real(wp), parameter :: limit_slack = 1.0e-11_wp

contains

  !> Places every pin for a crank angle at which the crank can move the links.
  !!
  !! Errors: those of `place_links`; a dead point (`|sin(θ4 − θ3)|` below 1e-6).
  pure subroutine find_pose(linkage, crank_degrees, pose, error)
    type(linkage_t), intent(in) :: linkage           !! lengths, pins and dyads
    real(wp), intent(in) :: crank_degrees            !! angle of the driven body from the global x
                                                     !! axis [deg]
    type(pose_t), intent(out) :: pose                !! incomplete if out of reach
    type(error_t), allocatable, intent(out) :: error !! why the links cannot be moved

    integer :: i

    call place_links(linkage, crank_degrees, pose, error)
    if (allocated(error)) return
    do i = 1, size(pose%sine)
      if (abs(pose%sine(i)) >= dead_point_sine) cycle
      call set_error(error, error_of_dead_point, "dead point: |sin(theta4 - theta3)| = "// &
        to_string(abs(pose%sine(i)), 3)//" is below "//to_string(dead_point_sine))
      return
    end do
  end subroutine find_pose

  !> Places every pin for a crank angle, including dead points: Ulker 2010 (2.1), solved by
  !! intersecting circles.
  !!
  !! Errors: the position is out of reach; the two bases of a dyad coincide, which leaves its
  !! direction undetermined.
  pure subroutine place_links(linkage, crank_degrees, pose, error)
    type(linkage_t), intent(in) :: linkage           !! lengths, pins and dyads
    real(wp), intent(in) :: crank_degrees            !! angle of the driven body from the global x
                                                     !! axis [deg]
    type(pose_t), intent(out) :: pose                !! incomplete after an error
    type(error_t), allocatable, intent(out) :: error !! why there is no pose

    real(wp) :: origin(2)
    integer :: i

    allocate (pose%pin(2, size(linkage%is_ground)), pose%direction(2, size(linkage%bodies)), &
      pose%sine(size(linkage%dyads)))
    ! Relative to the crank's pivot, so that a far-off origin of the drawing costs no digits.
    origin = linkage%ground_position(:, linkage%bodies(1)%first_pin)
    pose%pin = linkage%ground_position - spread(origin, 2, size(pose%pin, 2))
    pose%direction = 0.0_wp
    pose%sine = 0.0_wp
    pose%direction(:, 1) = direction_at(crank_degrees)
    pose%pin(:, linkage%bodies(1)%last_pin) = linkage%bodies(1)%length*pose%direction(:, 1)
    do i = 1, size(linkage%dyads)
      call place_dyad(linkage, linkage%dyads(i), pose, pose%sine(i), error)
      if (allocated(error)) return
    end do
    pose%pin = pose%pin + spread(origin, 2, size(pose%pin, 2))
  end subroutine place_links

  !> Cosine and sine of an angle in degrees. Whole turns are removed first: 0° and 360° are the same
  !! position to the last digit.
  pure function direction_at(degrees) result(direction)
    real(wp), intent(in) :: degrees
    real(wp) :: direction(2)

    real(wp) :: angle, quadrants

    ! Within ±45° of an axis cosine and sine keep their last digits: 90° gives 0 and 1.
    angle = modulo(degrees, 360.0_wp)
    quadrants = anint(angle/90.0_wp)
    angle = (angle - 90.0_wp*quadrants)*degree
    direction = [cos(angle), sin(angle)]
    select case (modulo(nint(quadrants), 4))
    case (1)
      direction = [-direction(2), direction(1)]
    case (2)
      direction = -direction
    case (3)
      direction = [direction(2), -direction(1)]
    end select
  end function direction_at

  !> Intersects the circles about the two bases of a dyad.
  !!
  !! The height of the triangle over the line of the bases comes from its area by Heron's formula,
  !! whose factors vanish exactly where the dyad is stretched or folded.
  pure subroutine place_dyad(linkage, dyad, pose, sine, error)
    type(linkage_t), intent(in) :: linkage
    type(dyad_t), intent(in) :: dyad
    type(pose_t), intent(inout) :: pose
    real(wp), intent(out) :: sine
    type(error_t), allocatable, intent(inout) :: error

    real(wp) :: base(2), unit(2), distance, r(2), along, four_areas_squared, height, arm(2, 2)
    integer :: k

    r = linkage%bodies(dyad%body)%length
    base = pose%pin(:, dyad%base(2)) - pose%pin(:, dyad%base(1))
    distance = norm2(base)
    sine = 0.0_wp
    four_areas_squared = (r(1) + r(2) + distance)*(r(1) + r(2) - distance)*(distance + r(1) - &
      r(2))*(distance - r(1) + r(2))
    if (four_areas_squared < -limit_slack*maxval([r, distance])**4) then
      call set_error(error, error_of_reach, "the position is out of reach")
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
      dyad%side*height*normal_to(unit)

    do k = 1, 2
      arm(:, k) = pose%pin(:, dyad%middle) - pose%pin(:, dyad%base(k))
      arm(:, k) = arm(:, k)/norm2(arm(:, k))
      pose%direction(:, dyad%body(k)) = merge(1.0_wp, -1.0_wp, &
        linkage%bodies(dyad%body(k))%last_pin == dyad%middle)*arm(:, k)
    end do
    sine = cross(arm(:, 1), arm(:, 2))
  end subroutine place_dyad

  !> Angle of a body from the global x axis, in (−π, π] [rad].
  pure function body_angle(linkage, pose, body) result(angle)
    type(linkage_t), intent(in) :: linkage !! senses of its bodies
    type(pose_t), intent(in) :: pose       !! directions of the bodies
    integer, intent(in) :: body            !! number, from 1
    real(wp) :: angle

    real(wp) :: e(2)

    e = linkage%bodies(body)%sense*pose%direction(:, body)
    ! Adding zero turns -0 into 0: an angle of -π would be outside the interval.
    angle = atan2(e(2) + 0.0_wp, e(1) + 0.0_wp)
  end function body_angle

  !> Transmission angle: between the two bodies of a dyad at their common pin, in [0, π] [rad]; best
  !! at π/2.
  pure function transmission_angle(linkage, pose, dyad) result(angle)
    type(linkage_t), intent(in) :: linkage !! bodies and dyads
    type(pose_t), intent(in) :: pose       !! directions of the bodies
    integer, intent(in) :: dyad            !! number, from 1
    real(wp) :: angle

    real(wp) :: arm(2, 2)
    integer :: k

    do k = 1, 2
      arm(:, k) = arm_to_middle(linkage, linkage%dyads(dyad), pose, k)
    end do
    angle = atan2(abs(pose%sine(dyad)), dot_product(arm(:, 1), arm(:, 2)))
  end function transmission_angle

  !> From the first pin of a body to a place on it, in global axes [m].
  pure function arm_to_place(pose, body, place) result(arm)
    type(pose_t), intent(in) :: pose !! directions of the bodies
    integer, intent(in) :: body      !! number, from 1
    real(wp), intent(in) :: place(2) !! from the first pin, in the axes of the body [m]
    real(wp) :: arm(2)

    arm = place(1)*pose%direction(:, body) + place(2)*normal_to(pose%direction(:, body))
  end function arm_to_place

  !> Unit vector along a body of a dyad, from its base to the middle pin.
  pure function arm_to_middle(linkage, dyad, pose, k) result(arm)
    type(linkage_t), intent(in) :: linkage !! last pins of its bodies
    type(dyad_t), intent(in) :: dyad       !! of this linkage
    type(pose_t), intent(in) :: pose       !! directions of the bodies
    integer, intent(in) :: k               !! body of the dyad, 1 or 2
    real(wp) :: arm(2)

    arm = pose%direction(:, dyad%body(k))
    if (linkage%bodies(dyad%body(k))%last_pin /= dyad%middle) arm = -arm
  end function arm_to_middle

end module poses
