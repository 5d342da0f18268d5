!> The pose of a linkage: where its pins are and how its bodies are turned.
module pose_types
  use kinds, only: wp
  use linkages, only: body_t, linkage_t, turned
  implicit none (type, external)
  private

  public :: pose_t, kinematic_coefficients_t, drawn_pose, pose_of_pins, count_from, arm_to_pin, &
    pins_of_body, place_of_pin, way_length

  !> First and second derivatives with respect to the crank angle θ2.
  type :: kinematic_coefficients_t
    real(wp), allocatable :: turn(:)          !! (bodies) h [-]
    real(wp), allocatable :: turn_slope(:)    !! (bodies) h' [-]
    real(wp), allocatable :: pin(:, :)        !! (2, pins) dx/dθ2 [m]
    real(wp), allocatable :: pin_slope(:, :)  !! (2, pins) d²x/dθ2² [m]
  end type kinematic_coefficients_t

  !> Positions of the pins and directions of the bodies.
  type :: pose_t
    real(wp) :: crank = 0.0_wp               !! coordinate of the first drive, with all whole turns
                                             !! [deg] or [m]
    real(wp) :: time = 0.0_wp                !! of an instant of a motion or of a law [s]
    logical :: has_time = .false.            !! it is one; else a position
    real(wp) :: origin(2) = 0.0_wp           !! from which its pins are counted, in global axes [m]
    real(wp), allocatable :: pin(:, :)       !! (2, pins) positions [m]
    real(wp), allocatable :: direction(:, :) !! (2, bodies) unit vectors, first → last pin
    real(wp), allocatable :: sine(:)         !! (groups) of a dyad: of the angle from base 1 →
                                             !! middle to base 2 → middle; of others: how
                                             !! independent their equations are; 0 at a dead point
    type(kinematic_coefficients_t), allocatable :: coefficients !! on a bridge, where equations do
                                             !! not give them
  end type pose_t

contains

  !> The drawing as a pose; bodies without a drawn direction lie along the global x axis.
  pure function drawn_pose(linkage, origin) result(pose)
    type(linkage_t), intent(in) :: linkage !! with its drawing
    real(wp), intent(in) :: origin(2)      !! from which pins are counted [m]
    type(pose_t) :: pose                   !! without `sine`

    pose = pose_of_pins(linkage, linkage%drawing%pin - spread(origin, 2, size(linkage%is_ground)))
    pose%origin = origin
  end function drawn_pose

  !> Counts the pins of a pose from another place: the global origin, or `reference_point`, so that
  !! a far-off origin of the drawing costs no digits.
  pure subroutine count_from(origin, pose)
    real(wp), intent(in) :: origin(2)   !! in global axes [m]
    type(pose_t), intent(inout) :: pose !! with its pins

    pose%pin = pose%pin + spread(pose%origin - origin, 2, size(pose%pin, 2))
    pose%origin = origin
  end subroutine count_from

  !> The pose with pins at given places; bodies whose pins coincide lie along the global x axis.
  pure function pose_of_pins(linkage, pin) result(pose)
    type(linkage_t), intent(in) :: linkage !! its bodies
    real(wp), intent(in) :: pin(:, :)      !! (2, pins) [m]
    type(pose_t) :: pose                   !! without `sine`

    integer :: b

    pose%pin = pin
    allocate (pose%direction(2, size(linkage%bodies)))
    do b = 1, size(linkage%bodies)
      associate (body => linkage%bodies(b), direction => pose%direction(:, b))
        direction = pose%pin(:, body%last_pin) - pose%pin(:, body%first_pin)
        if (.not. norm2(direction) > 0.0_wp) direction = [1.0_wp, 0.0_wp]
        direction = direction/norm2(direction)
      end associate
    end do
  end function pose_of_pins

  !> Numbers of all pins of a body: first, last, further.
  pure function pins_of_body(body) result(pins)
    type(body_t), intent(in) :: body !! with its pins
    integer :: pins(2 + size(body%further))

    pins(:2) = [body%first_pin, body%last_pin]
    pins(3:) = body%further%pin
  end function pins_of_body

  !> Place of one of its pins on a body, from its first pin, in its axes [m].
  pure function place_of_pin(body, pin) result(place)
    type(body_t), intent(in) :: body !! with its pins
    integer, intent(in) :: pin       !! number, one of its pins
    real(wp) :: place(2)

    integer :: i

    place = 0.0_wp
    if (pin == body%first_pin) return
    place(1) = body%length
    if (pin == body%last_pin) return
    do i = 1, size(body%further)
      if (body%further(i)%pin == pin) place = body%further(i)%place
    end do
  end function place_of_pin

  !> From the first pin of a body to one of its pins, in global axes [m].
  pure function arm_to_pin(linkage, pose, body, pin) result(arm)
    type(linkage_t), intent(in) :: linkage !! its bodies
    type(pose_t), intent(in) :: pose       !! directions of the bodies
    integer, intent(in) :: body            !! number, from 1
    integer, intent(in) :: pin             !! number, one of its pins
    real(wp) :: arm(2)

    arm = turned(place_of_pin(linkage%bodies(body), pin), pose%direction(:, body))
  end function arm_to_pin

  !> Length of a body along its corners, or from its first pin to its last [m].
  pure function way_length(body) result(length)
    type(body_t), intent(in) :: body !! with its pins
    real(wp) :: length

    integer :: i

    length = body%length
    if (.not. allocated(body%corners)) return
    length = 0.0_wp
    do i = 2, size(body%corners)
      length = length + norm2(place_of_pin(body, body%corners(i)) - place_of_pin(body, &
        body%corners(i - 1)))
    end do
  end function way_length

end module pose_types
