!> Lagrange's equation of a rigid linkage with one degree of freedom: Ulker 2010 (2.50) to (2.64),
!! for any number of bodies of any shape.
!!
!! The torque required for a motion follows from energies alone, without any pin force.
module lagrange
  use applied_loads, only: add_standing_loads, applied_potential, evaluate_loads, &
    generalised_force, has_standing_loads
  use body_points, only: find_point_coefficients, point_coefficients_t
  use coordinates, only: evaluated_t
  use inertia_loads, only: load_t
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkages, only: linkage_t
  use poses, only: pose_t
  use rigid_bodies, only: central_inertia, mass_centre, rigid_body_t
  implicit none (type, external)
  private

  public :: lagrange_t, find_lagrange, velocity_term, demanded_torque, kinetic_energy

  !> The terms of `M α2 + ½ M' ω2² + gravity + load = torque` at a pose, for every speed.
  type :: lagrange_t
    real(wp) :: inertia = 0.0_wp       !! M, generalised inertia of all moving masses at the
                                       !! crank [kg m²]
    real(wp) :: inertia_slope = 0.0_wp !! M' = dM/dθ2 [kg m²]
    real(wp) :: gravity = 0.0_wp       !! dU/dθ2 of the weights [N m]
    real(wp) :: load = 0.0_wp          !! minus the generalised force of all other loads [N m]
    real(wp) :: potential = 0.0_wp     !! U of the weights and constant forces, zero with all at the
                                       !! global origin, and of springs, zero unloaded [N m]
  end type lagrange_t

contains

  !> M and M' of (2.54), dU/dθ2 and the generalised load at a pose.
  !!
  !! Twice the kinetic energy (2.50), summed over i = 2…4 (1…3 is a misprint), is at ω2 = 1
  !! `M = Σ (m x_G'·x_G' + I_G h²)`. Its derivative is `M' = 2 Σ (m x_G'·x_G'' + I_G h h')`. For
  !! mass centres on the links these are (2.55) and the terms of (2.56) with S2, S3 and C1, where
  !! the print omits ω2²: `V = ½ M' ω2²`. The terms with G, which is −U by (2.62), are right as
  !! printed.
  pure function find_lagrange(linkage, rigid, pose, coefficients) result(terms)
    type(linkage_t), intent(in) :: linkage     !! pins and constant loads
    type(rigid_body_t), intent(in) :: rigid(:) !! (bodies) of the linkage
    type(pose_t), intent(in) :: pose           !! away from dead points
    type(kinematic_coefficients_t), intent(in) :: coefficients !! of this pose
    type(lagrange_t) :: terms

    type(point_coefficients_t) :: point
    real(wp) :: turning
    integer :: b, p

    do b = 1, size(linkage%bodies)
      point = find_point_coefficients(linkage, pose, coefficients, b, mass_centre(rigid(b)))
      call add_mass(rigid(b)%mass, linkage%gravity, point, terms)
      turning = central_inertia(rigid(b))*coefficients%turn(b)
      terms%inertia = terms%inertia + turning*coefficients%turn(b)
      terms%inertia_slope = terms%inertia_slope + 2.0_wp*turning*coefficients%turn_slope(b)
      terms%load = terms%load - linkage%couple(b)*coefficients%turn(b)
    end do
    do p = 1, size(linkage%is_ground)
      point = point_coefficients_t(pose%pin(:, p), coefficients%pin(:, p), &
        coefficients%pin_slope(:, p))
      call add_mass(linkage%pin_mass(p), linkage%gravity, point, terms)
      terms%load = terms%load - dot_product(linkage%pin_force(:, p), point%rate)
      terms%potential = terms%potential - dot_product(linkage%pin_force(:, p), point%place)
    end do
    if (has_standing_loads(linkage)) call add_applied_loads(linkage, pose, coefficients, terms)
  end function find_lagrange

  !> Adds the loads of springs and processes that a pose determines.
  pure subroutine add_applied_loads(linkage, pose, coefficients, terms)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(kinematic_coefficients_t), intent(in) :: coefficients
    type(lagrange_t), intent(inout) :: terms

    type(load_t) :: body_load(size(linkage%bodies))
    real(wp) :: pin_load(2, size(linkage%is_ground))
    type(evaluated_t), allocatable :: along(:)

    pin_load = 0.0_wp
    call evaluate_loads(linkage, pose, along)
    call add_standing_loads(linkage, pose, along, body_load, pin_load)
    terms%load = terms%load - generalised_force(linkage, coefficients, body_load, pin_load)
    terms%potential = terms%potential + applied_potential(linkage, pose, along)
  end subroutine add_applied_loads

  !> Adds a mass that moves without rotating.
  pure subroutine add_mass(mass, gravity, point, terms)
    real(wp), intent(in) :: mass       !! [kg]
    real(wp), intent(in) :: gravity(2) !! [m/s²]
    type(point_coefficients_t), intent(in) :: point
    type(lagrange_t), intent(inout) :: terms

    terms%inertia = terms%inertia + mass*dot_product(point%rate, point%rate)
    terms%inertia_slope = terms%inertia_slope + 2.0_wp*mass*dot_product(point%rate, point%slope)
    terms%gravity = terms%gravity - mass*dot_product(gravity, point%rate)
    terms%potential = terms%potential - mass*dot_product(gravity, point%place)
  end subroutine add_mass

  !> `V = ½ M' ω2²` [N m]: (2.56) without its potential terms.
  pure function velocity_term(terms, speed) result(torque)
    type(lagrange_t), intent(in) :: terms !! at a pose
    real(wp), intent(in) :: speed         !! ω2 [rad/s]
    real(wp) :: torque

    torque = 0.5_wp*terms%inertia_slope*speed**2
  end function velocity_term

  !> Torque on the crank that a motion requires, (2.54) [N m].
  pure function demanded_torque(terms, speed, acceleration) result(torque)
    type(lagrange_t), intent(in) :: terms !! at a pose
    real(wp), intent(in) :: speed         !! ω2 [rad/s]
    real(wp), intent(in) :: acceleration  !! α2 [rad/s²]
    real(wp) :: torque

    torque = terms%inertia*acceleration + velocity_term(terms, speed) + terms%gravity + terms%load
  end function demanded_torque

  !> Kinetic energy `½ M ω2²`, (2.50) [N m].
  pure function kinetic_energy(terms, speed) result(energy)
    type(lagrange_t), intent(in) :: terms !! at a pose
    real(wp), intent(in) :: speed         !! ω2 [rad/s]
    real(wp) :: energy

    energy = 0.5_wp*terms%inertia*speed**2
  end function kinetic_energy

end module lagrange
