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
  use coordinate_types, only: coordinate_t, is_angle, terminal_t
  use cubic_splines, only: cubic_spline_t
  use kinds, only: wp
  use units, only: unit_t
  implicit none (type, external)
  private

  public :: applied_load_t, is_torsional
  public :: applies_force, applies_couple, applies_along
  public :: acts_always, acts_with_motion, acts_against_motion
  public :: over_nothing, over_coordinate, over_time

  !> What a load puts on the linkage: a force at a place; a couple on a body; an effort along a
  !! coordinate, which is the pull of a spring, damper or stop: it makes the coordinate smaller.
  integer, parameter :: applies_force = 1, applies_couple = 2, applies_along = 3

  !> While its place moves, or its body turns, with the load or against it; or always.
  integer, parameter :: acts_always = 0, acts_with_motion = 1, acts_against_motion = -1

  !> What a table is over.
  integer, parameter :: over_nothing = 0, over_coordinate = 1, over_time = 2

  !> A load. With the deflection x − rest of its coordinate x and the rate v: the pull along it is
  !! `tension + stiffness (x − rest) + damping v`, or of one side only, see `pulls`; a force or
  !! couple is `value`, times that of a table, less `damping v + resisting tanh(v/smooth)` of its
  !! place or body.
  type :: applied_load_t
    integer :: kind = applies_force       !! one of the applies_… constants
    type(terminal_t) :: at                !! where a force acts; of a couple its body
    type(coordinate_t) :: along           !! of a pull; fixed ends are counted from a ground pivot
    integer :: coordinate = 0             !! number of the coordinate with a name that this is; 0:
                                          !! no pull
    integer :: hinge = 0                  !! pin where two bodies turn that a spring turns; 0: none
    logical :: is_carried = .false.       !! the force turns with its body
    real(wp) :: force(2) = 0.0_wp         !! value of a force, in global axes or those of its body;
                                          !! with a table a unit vector [N] or [-]
    real(wp) :: couple = 0.0_wp           !! value of a couple, with a table its sign [N m] or [-]
    integer :: during = acts_always       !! one of the acts_… constants
    integer :: over = over_nothing        !! one of the over_… constants
    type(coordinate_t) :: variable        !! that a table is over, which may be a sum
    type(cubic_spline_t) :: table         !! of forces or couples [N] or [N m]
    character(len=:), allocatable :: table_name !! for messages
    type(unit_t) :: variable_unit         !! of what a table is over, likewise
    character(len=:), allocatable :: angle_name !! of the link whose angle it is over, for messages
    character(len=:), allocatable :: variable_name !! of the coordinate with a name, likewise
    real(wp) :: tension = 0.0_wp          !! [N] or [N m]
    real(wp) :: stiffness = 0.0_wp        !! [N/m] or [N m/rad]
    real(wp) :: rest = 0.0_wp             !! [m] or [rad]
    real(wp) :: damping = 0.0_wp          !! [N s/m] or [N m s/rad]
    integer :: side = 0                   !! of its rest where the pull acts only: 1 above, −1
                                          !! below; 0: it acts on both
    real(wp) :: contact = 0.0_wp          !! of one side: width in which the pull begins [m], [rad]
    character(len=:), allocatable :: name !! of a stop, or spring of one side, for messages
    real(wp) :: resisting = 0.0_wp        !! [N] or [N m]
    real(wp) :: smooth = 1.0_wp           !! speed within which what changes its sign with the
                                          !! motion does so smoothly [m/s] or [rad/s]
  end type applied_load_t

contains

  !> Whether a load is a spring, damper or stop of the angle between two bodies.
  elemental function is_torsional(load) result(is)
    type(applied_load_t), intent(in) :: load
    logical :: is

    is = load%kind == applies_along .and. load%along%kind == is_angle
  end function is_torsional

end module applied_load_types
