! src/linkage/coordinates/ - scalar coordinates of a linkage: distances, places on lines, angles.
! In: a `coordinate_t` between terminals, a pose, how it moves. Out: its value, rate and
! acceleration, and what an effort along it puts on its terminals. Begin with `coordinate_t` here,
! then `coordinate_value` in `coordinates.f90`; a kind has a file of its own, which sees frames and
! twists of terminals only.
! Not here: what acts along a coordinate (`src/linkage/loads`), the equations that hold joints
! together (`src/linkage/groups`), their names (`src/mechanism`).

!> Coordinates of a linkage: scalars of frames that are fixed to what moves.
module coordinate_types
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: terminal_t, frame_t, twist_t, wrench_t, coordinate_t, partial_t, gradients_t
  public :: is_distance, is_along, is_across, is_angle, is_sum

  !> Kinds: the distance of two places; the place of the second terminal along and across the line
  !! of the first; the angle from the direction of the first to that of the second; a sum of other
  !! coordinates.
  integer, parameter :: is_distance = 1, is_along = 2, is_across = 3, is_angle = 4, is_sum = 5

  !> A frame on a pin, a body or the ground. Only lines and angles use its direction.
  type :: terminal_t
    integer :: pin = 0             !! number; it does not turn
    integer :: body = 0            !! number; not of a pin. Both 0: the ground
    real(wp) :: place(2) = 0.0_wp  !! of a body from its first pin, in its axes; in global axes of a
                                   !! pin from there, of the ground from the origin [m]
    real(wp) :: direction(2) = [1.0_wp, 0.0_wp] !! unit vector, in the same axes
  end type terminal_t

  !> A terminal at a pose.
  type :: frame_t
    real(wp) :: place(2)     !! counted as the pins of the pose [m]
    real(wp) :: direction(2) !! unit vector, global axes
  end type frame_t

  !> How a terminal moves: velocities or, without those of its turning, accelerations.
  type :: twist_t
    real(wp) :: velocity(2) !! of its place
    real(wp) :: turn        !! of its direction
  end type twist_t

  !> What an effort of 1 along a coordinate puts on one of its terminals.
  type :: wrench_t
    real(wp) :: place(2) !! of the terminal, counted as the pins of the pose; 0 without a force [m]
    real(wp) :: force(2) !! there, global axes
    real(wp) :: couple
  end type wrench_t

  type :: coordinate_t
    integer :: kind = is_distance
    type(terminal_t) :: at(2)
    integer :: drive = 0               !! number of the drive that gives its value, with all whole
                                       !! turns of an angle; 0: none, an angle is from −π to π
    integer, allocatable :: term(:)    !! (terms) of a sum: numbers of others, which are no sums
    real(wp), allocatable :: weight(:) !! (terms) of a sum
  end type coordinate_t

  !> Derivatives of a coordinate by what moves one of its terminals: the position of a pin, or of
  !! the first pin of a body, and the angle of the body.
  type :: partial_t
    integer :: pin        !! number; 0 of an angle
    integer :: body       !! 0: a pin by itself
    real(wp) :: by_pin(2) !! [-]
    real(wp) :: by_angle  !! [m], or [-] of angles; 0 of a pin
  end type partial_t

  !> Gradients of a list of coordinates, one after the other: terminals on the ground have no part
  !! in them.
  type :: gradients_t
    integer, allocatable :: last(:) !! (0:coordinates) number of the last partial of each
    type(partial_t), allocatable :: partial(:)
  end type gradients_t

end module coordinate_types
