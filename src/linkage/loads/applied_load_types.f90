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
  use pull_laws, only: pull_law_t
  use units, only: unit_t
  implicit none (type, external)
  private

  public :: applied_load_t, is_torsional, counts_turns, deflection
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

  !> A load. A pull along a coordinate is that of its law; a force or couple is `value`, times that
  !! of a table, less `damping v + resisting tanh(v/smooth)` with the velocity v of its place or
  !! body.
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
    type(pull_law_t) :: law               !! of a pull; of a force or couple the damping alone
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

  !> Whether a torsional load counts whole turns: a drive gives its angle.
  elemental function counts_turns(load) result(counts)
    type(applied_load_t), intent(in) :: load !! along a coordinate
    logical :: counts

    counts = is_torsional(load) .and. load%along%drive > 0
  end function counts_turns

  !> By how much a coordinate differs from the rest of a load: an angle from −π to π, but one that a
  !! drive gives with all whole turns [m] or [rad].
  pure function deflection(load, value) result(x)
    type(applied_load_t), intent(in) :: load !! along a coordinate
    real(wp), intent(in) :: value            !! of the coordinate [m] or [rad]
    real(wp) :: x

    x = value - load%law%rest
    if (is_torsional(load) .and. .not. counts_turns(load)) x = atan2(sin(x), cos(x))
  end function deflection

end module applied_load_types
