!> Inertia and loads of a four-bar as functions of one coordinate, the length s of its loop-closure
!! curve.
!!
!! `M(s) s̈ + ½ M'(s) ṡ² = Q_s`, Lagrange's equation with the kinetic energy `½ M ṡ²`: (2.50) to
!! (2.56) of Ulker (2010) with s in place of θ2, which makes it regular where the crank turns back.
module curve_dynamics
  use kinds, only: wp
  use linkages, only: linkage_t
  use loop_curves, only: curve_point_t
  use rigid_bodies, only: rigid_body_t
  implicit none (type, external)
  private

  public :: curve_dynamics_t, new_curve_dynamics, find_inertia, conservative_torques, &
    potential_energy

  !> What does not change while a four-bar moves; in the order crank, coupler, follower.
  type :: curve_dynamics_t
    real(wp) :: inertia(3) = 0.0_wp   !! about O2, A, O4, with what hangs on A or B: `T = ½ Σ
                                      !! inertia ω² + coupling` [kg m²]
    real(wp) :: coupling(2) = 0.0_wp  !! r2 times the first moment of the coupler, along and to the
                                      !! left of it [kg m²]
    real(wp) :: weight(2, 3) = 0.0_wp !! `U = −Σ weight·(cos θ, sin θ)`, of gravity and constant
                                      !! forces [N m]
    real(wp) :: couple(3) = 0.0_wp    !! constant torques from outside: `U = −Σ couple θ` [N m]
  end type curve_dynamics_t

contains

  !> Gathers bodies, pin masses, gravity, forces and couples.
  pure function new_curve_dynamics(linkage, rigid) result(dynamics)
    type(linkage_t), intent(in) :: linkage
    type(rigid_body_t), intent(in) :: rigid(:) !! (bodies)
    type(curve_dynamics_t) :: dynamics

    type(rigid_body_t) :: bodies(3)
    real(wp) :: carried(3), force(2, 3)
    integer :: i, number(3), base(3)

    associate (dyad => linkage%dyads(1), r => linkage%bodies%length)
      number = [1, dyad%body]
      base = [linkage%bodies(1)%first_pin, dyad%base]
      do i = 1, 3
        bodies(i) = seen_from_base(rigid(number(i)), r(number(i)), &
          linkage%bodies(number(i))%first_pin == base(i))
      end do
      ! What turns with each angle besides the body itself: at the crank's end pin A and the
      ! coupler; pin B with the follower.
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
      dynamics%coupling = r(1)*bodies(2)%first_moment
      dynamics%couple = linkage%couple(number)
    end associate
  end function new_curve_dynamics

  !> The weight `w` with `w·(cos θ, sin θ) = force·(S1 e + S2 n)`: e at the angle θ, n to its left.
  pure function turned(force, moment) result(weight)
    real(wp), intent(in) :: force(2)  !! per mass [m/s²]
    real(wp), intent(in) :: moment(2) !! first moment S in the axes of the body [kg m]
    real(wp) :: weight(2)

    weight = moment(1)*force + moment(2)*[force(2), -force(1)]
  end function turned

  !> A body in axes from its base, which may be its last pin on the way round the loop, to its other
  !! pin.
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
    type(curve_dynamics_t), intent(in) :: dynamics
    type(curve_point_t), intent(in) :: point
    real(wp), intent(out) :: inertia !! M [kg m²]
    real(wp), intent(out) :: slope   !! M' [kg m²/rad]

    real(wp) :: cosine, sine, coupling, coupling_slope

    associate (e => point%direction, t => point%tangent, dt => point%tangent_slope, &
      c => dynamics%coupling)
      ! Of θ3 − θ2.
      cosine = e(1, 1)*e(1, 2) + e(2, 1)*e(2, 2)
      sine = e(1, 1)*e(2, 2) - e(2, 1)*e(1, 2)
      coupling = c(1)*cosine - c(2)*sine
      coupling_slope = -(c(1)*sine + c(2)*cosine)*(t(2) - t(1))
      inertia = sum(dynamics%inertia*t**2) + 2.0_wp*t(1)*t(2)*coupling
      slope = 2.0_wp*(sum(dynamics%inertia*t*dt) + (dt(1)*t(2) + t(1)*dt(2))*coupling + &
        t(1)*t(2)*coupling_slope)
    end associate
  end subroutine find_inertia

  !> Torques on the angles of gravity and of constant forces and couples: `−∂U/∂θ` [N m].
  pure function conservative_torques(dynamics, point) result(torque)
    type(curve_dynamics_t), intent(in) :: dynamics
    type(curve_point_t), intent(in) :: point
    real(wp) :: torque(3)

    torque = dynamics%couple + point%direction(1, :)*dynamics%weight(2, :) - point%direction(2, &
      :)*dynamics%weight(1, :)
  end function conservative_torques

  !> Potential energy of the same: of crank and coupler it is counted from O2, of the follower and
  !! pin B from O4, of couples from angle 0 [J].
  pure function potential_energy(dynamics, point, angle) result(energy)
    type(curve_dynamics_t), intent(in) :: dynamics
    type(curve_point_t), intent(in) :: point
    real(wp), intent(in) :: angle(3) !! with all whole turns [rad]
    real(wp) :: energy

    energy = -sum(dynamics%weight*point%direction) - sum(dynamics%couple*angle)
  end function potential_energy

end module curve_dynamics
