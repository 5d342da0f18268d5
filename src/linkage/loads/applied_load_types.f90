! src/linkage/loads/ - loads on a linkage: inertia, weights, springs, dampers, processes, friction.
! In: a linkage at a pose, its kinematic coefficients. Out: `unit_loads_t`: load cases of ω2², of
! α2, and constant loads. Begin with `find_unit_loads` in `load_cases.f90`; what depends on the
! speed otherwise: `find_running_loads` in `running_loads.f90`. Springs and processes:
! `applied_loads.f90`.
! Not here: forces in the joints (`src/linkage/statics`), loads of parts that bend
! (`src/deformation/parts`).

!> Loads on a linkage beside its weights and the constant forces and torques: what springs, dampers
!! and processes put on it.
module applied_load_types
  use coordinate_types, only: terminal_t
  use cubic_splines, only: cubic_spline_t
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: applied_load_t
  public :: applies_force, applies_couple, applies_along, applies_between
  public :: acts_always, acts_with_motion, acts_against_motion
  public :: over_nothing, over_drive, over_slider, over_travel, over_angle

  !> What a load puts on the linkage: a force at a place; a couple on a body; a force along the line
  !! between two places; a couple between two bodies, or a body and the ground.
  integer, parameter :: applies_force = 1, applies_couple = 2, applies_along = 3, &
    applies_between = 4

  !> While its place moves, or its body turns, with the load or against it; or always.
  integer, parameter :: acts_always = 0, acts_with_motion = 1, acts_against_motion = -1

  !> What a table is over: the coordinate of the first drive; the place of a slider along its line;
  !! the travel of the place of the force along its direction; the angle of a body.
  integer, parameter :: over_nothing = 0, over_drive = 1, over_slider = 2, over_travel = 3, &
    over_angle = 4

  !> A load. With the coordinate x of its kind, a length or an angle, and its rate v: `tension +
  !! stiffness (x − rest)` shortens a line or turns bodies back, and so does `damping v +
  !! resisting tanh(v/smooth)`; a force or couple is `value`, times that of a table, less the same
  !! resistance to the motion of its place or body.
  type :: applied_load_t
    integer :: kind = applies_force       !! one of the applies_… constants
    type(terminal_t) :: at(2)             !! of a force the first; of a line both ends, fixed ones
                                          !! counted from a ground pivot; of two
                                          !! bodies the first: the pin where they turn
    integer :: body(2) = 0                !! on which a couple acts, the first; of two bodies the
                                          !! second turns against the first; 0: the ground
    logical :: is_carried = .false.       !! the force turns with its body
    real(wp) :: force(2) = 0.0_wp         !! value of a force, in global axes or those of its body;
                                          !! with a table a unit vector [N] or [-]
    real(wp) :: couple = 0.0_wp           !! value of a couple, with a table its sign [N m] or [-]
    integer :: during = acts_always       !! one of the acts_… constants
    integer :: over = over_nothing        !! one of the over_… constants
    integer :: number = 0                 !! of the slider or body that a table is over
    type(cubic_spline_t) :: table         !! of forces or couples [N] or [N m]
    character(len=:), allocatable :: table_name !! for messages
    character(len=:), allocatable :: over_name  !! of the link whose angle it is over, for messages
    real(wp) :: tension = 0.0_wp          !! [N] or [N m]
    real(wp) :: stiffness = 0.0_wp        !! [N/m] or [N m/rad]
    real(wp) :: rest = 0.0_wp             !! [m] or [rad]
    real(wp) :: damping = 0.0_wp          !! [N s/m] or [N m s/rad]
    real(wp) :: resisting = 0.0_wp        !! [N] or [N m]
    real(wp) :: smooth = 1.0_wp           !! speed within which what changes its sign with the
                                          !! motion does so smoothly [m/s] or [rad/s]
  end type applied_load_t

end module applied_load_types
