!> Inertia and loads of a four-bar as functions of one coordinate, the length s of its loop-closure
!! curve.
!!
!! Lagrange's equation is `M(s) s̈ + ½ M'(s) ṡ² = Q_s`, with the kinetic energy `½ M ṡ²`: (2.50) to
!! (2.56) of Ulker (2010) with s in place of θ2, which keeps the equation regular where the crank
!! turns back.
module curve_dynamics
  use kinds, only: wp
  use linkages, only: linkage_t
  use loop_curves, only: curve_point_t
  use rigid_bodies, only: rigid_body_t
  implicit none (type, external)
  private

  public :: curve_dynamics_t, new_curve_dynamics, find_inertia, conservative_torques, &
    potential_energy

  !> Constants of a moving four-bar, in the order crank, coupler, follower. The kinetic energy is
  !! `½ Σ inertia ω²` plus `ω2 ω3 (c1 cos(θ3 − θ2) − c2 sin(θ3 − θ2))`, where c is `coupling`; the
  !! potential energy is `U = level − Σ weight·(cos θ, sin θ)`.
  type :: curve_dynamics_t
    real(wp) :: inertia(3) = 0.0_wp   !! about O2, A, O4, with what is carried at A or B [kg m²]
    real(wp) :: coupling(2) = 0.0_wp  !! r2 times the first moment of the coupler, along it and to
                                      !! its left [kg m²]
    real(wp) :: weight(2, 3) = 0.0_wp !! of gravity and constant forces, along x and y [N m]
    real(wp) :: level = 0.0_wp        !! of weights and constant forces at the ground pivots, 0 at
                                      !! the global origin [J]
    real(wp) :: couple(3) = 0.0_wp    !! constant external torques, which have no potential [N m]
  end type curve_dynamics_t

contains

  !> Collects the constants of bodies, pin masses, gravity, forces and torques.
  pure function new_curve_dynamics(linkage, rigid) result(dynamics)
    type(linkage_t), intent(in) :: linkage     !! a four-bar with its loads
    type(rigid_body_t), intent(in) :: rigid(:) !! (bodies) of the linkage
    type(curve_dynamics_t) :: dynamics

    type(rigid_body_t) :: bodies(3)
    real(wp) :: carried(3), force(2, 3)
    integer :: i, number(3), base(3)

    associate (dyad => linkage%groups(1), r => linkage%bodies%length)
      number = [1, dyad%body]
      base = [linkage%bodies(1)%first_pin, dyad%base]
      do i = 1, 3
        bodies(i) = seen_from_base(rigid(number(i)), r(number(i)), &
          linkage%bodies(number(i))%first_pin == base(i))
      end do
      ! Mass that each link carries at its end: pin A and the coupler on the crank, pin B on the
      ! follower.
      carried = [linkage%pin_mass(dyad%base(1)) + bodies(2)%mass, 0.0_wp, &
        linkage%pin_mass(dyad%middle)]
      force = 0.0_wp
      force(:, 1) = linkage%pin_force(:, dyad%base(1))
      force(:, 3) = linkage%pin_force(:, dyad%middle)
      do i = 1, 3
        dynamics%inertia(i) = bodies(i)%inertia + carried(i)*r(number(i))**2
        dynamics%weight(:, i) = turned(linkage%gravity, bodies(i)%first_moment) + &
          r(number(i))*(carried(i)*linkage%gravity + force(:, i))
      end do
      dynamics%level = -dot_product((bodies(1)%mass + carried(1))*linkage%gravity + force(:, 1), &
        linkage%ground_position(:, base(1))) - dot_product((bodies(3)%mass + carried(3))* &
        linkage%gravity + force(:, 3), linkage%ground_position(:, base(3)))
      dynamics%coupling = r(1)*bodies(2)%first_moment
      dynamics%couple = linkage%couple(number)
    end associate
  end function new_curve_dynamics

  !> The weight `w` with `w·(cos θ, sin θ) = force·(S1 e + S2 n)`, for e at the angle θ and n to its
  !! left.
  pure function turned(force, moment) result(weight)
    real(wp), intent(in) :: force(2)  !! per mass [m/s²]
    real(wp), intent(in) :: moment(2) !! first moment S in the axes of the body [kg m]
    real(wp) :: weight(2)

    weight = moment(1)*force + moment(2)*[force(2), -force(1)]
  end function turned

  !> A body in axes from its base to its other pin. The base may be the last pin on the path round
  !! the loop.
  pure function seen_from_base(rigid, length, starts_there) result(seen)
    type(rigid_body_t), intent(in) :: rigid
    real(wp), intent(in) :: length      !! [m]
    logical, intent(in) :: starts_there !! the base is the body's first pin
    type(rigid_body_t) :: seen

    seen = rigid
    if (starts_there) return
    seen%first_moment = [rigid%mass*length, 0.0_wp] - rigid%first_moment
    seen%inertia = rigid%inertia + length*(rigid%mass*length - 2.0_wp*rigid%first_moment(1))
  end function seen_from_base

  !> M and M' = dM/ds at a point of the curve.
  pure subroutine find_inertia(dynamics, point, inertia, slope)
    type(curve_dynamics_t), intent(in) :: dynamics !! constants of the four-bar
    type(curve_point_t), intent(in) :: point       !! direction, tangent and its slope
    real(wp), intent(out) :: inertia               !! M [kg m²]
    real(wp), intent(out) :: slope                 !! M' [kg m²/rad]

    real(wp) :: cosine, sine, coupling, coupling_slope

    associate (e => point%direction, t => point%tangent, dt => point%tangent_slope, &
      c => dynamics%coupling)
      ! Cosine and sine of θ3 − θ2.
      cosine = e(1, 1)*e(1, 2) + e(2, 1)*e(2, 2)
      sine = e(1, 1)*e(2, 2) - e(2, 1)*e(1, 2)
      coupling = c(1)*cosine - c(2)*sine
      coupling_slope = -(c(1)*sine + c(2)*cosine)*(t(2) - t(1))
      inertia = sum(dynamics%inertia*t**2) + 2.0_wp*t(1)*t(2)*coupling
      slope = 2.0_wp*(sum(dynamics%inertia*t*dt) + (dt(1)*t(2) + t(1)*dt(2))*coupling + &
        t(1)*t(2)*coupling_slope)
    end associate
  end subroutine find_inertia

  !> Torques on the angles θ2, θ3, θ4 from gravity and constant forces: `−∂U/∂θ` [N m].
  pure function conservative_torques(dynamics, point) result(torque)
    type(curve_dynamics_t), intent(in) :: dynamics !! constants of the four-bar
    type(curve_point_t), intent(in) :: point       !! its directions
    real(wp) :: torque(3)

    torque = point%direction(1, :)*dynamics%weight(2, :) - point%direction(2, :)* &
      dynamics%weight(1, :)
  end function conservative_torques

  !> Potential energy of gravity and constant forces, 0 with all at the global origin [J].
  pure function potential_energy(dynamics, point) result(energy)
    type(curve_dynamics_t), intent(in) :: dynamics !! constants of the four-bar
    type(curve_point_t), intent(in) :: point       !! its directions
    real(wp) :: energy

    energy = dynamics%level - sum(dynamics%weight*point%direction)
  end function potential_energy

end module curve_dynamics
