!> Balance shafts: what their unbalanced masses exert. A pair that turns with and against the crank
!! at its speed, or at a multiple of it, cancels a harmonic of the shaking force.
!!
!! F. W. Lanchester: Engine balancing. Proc. Inst. Automobile Engineers 8 (1914) 195. E. N.
!! Stevensen: Balancing of machines. J. Eng. Ind. 95 (1973) 650: with `F = Σ Z_k exp(i k θ2)` for
!! the shaking force in complex coordinates, over k of both signs, a shaft that makes k turns in one
!! of the crank cancels Z_k if its first moment is `|Z_k|/(k ω2)²`, opposite to Z_k at θ2 = 0.
module balance_shafts
  use constants, only: degree, two_pi
  use drive_values, only: direction_at
  use kinds, only: wp
  use linkages, only: cross, linkage_t, normal_to, reference_point, shaft_t
  use load_cases, only: case_count
  implicit none (type, external)
  private

  public :: parts_of_shafts, cancelling_shaft, force_harmonic

contains

  !> Shaking force and moment of the balance shafts of a linkage, and the torque that they need from
  !! the first drive, for each of the three load cases; zeros without shafts.
  !!
  !! With s its first moment, u the direction of its mass, n the normal of u and k its turns, a
  !! shaft has `F = s (k² ω2² u − k α2 n)`, the moment `−k J α2` besides that of F, and takes the
  !! torque `k² J α2 − k s g·n`.
  pure function parts_of_shafts(linkage, crank) result(part)
    type(linkage_t), intent(in) :: linkage !! with its shafts, and gravity
    real(wp), intent(in) :: crank          !! coordinate of the first drive [deg]
    real(wp) :: part(4, case_count)        !! force, moment, torque [N, N, N m, N m]

    real(wp) :: u(2), n(2), arm(2), force(2, 2)
    integer :: i

    part = 0.0_wp
    if (.not. allocated(linkage%shafts)) return
    do i = 1, size(linkage%shafts)
      associate (shaft => linkage%shafts(i))
        u = direction_at(shaft%turns*crank + shaft%phase)
        n = normal_to(u)
        arm = shaft%place - reference_point(linkage)
        force(:, 1) = shaft%first_moment*real(shaft%turns, wp)**2*u
        force(:, 2) = -shaft%first_moment*shaft%turns*n
        part(:2, :2) = part(:2, :2) + force
        part(3, :2) = part(3, :2) + [cross(arm, force(:, 1)), cross(arm, force(:, 2)) - &
          shaft%turns*shaft%inertia]
        part(4, 2) = part(4, 2) + real(shaft%turns, wp)**2*shaft%inertia
        part(4, 3) = part(4, 3) - shaft%turns*shaft%first_moment*dot_product(linkage%gravity, n)
      end associate
    end do
  end function parts_of_shafts

  !> The coefficient Z_k of `F = Σ Z_k exp(i k θ2)`, for k of either sign [N].
  pure function force_harmonic(force, turns) result(coefficient)
    real(wp), intent(in) :: force(:, :) !! (2, n) at θ2 = 0, 2π/n, … [N]
    integer, intent(in) :: turns        !! k
    complex(wp) :: coefficient

    integer :: i, n

    n = size(force, 2)
    coefficient = (0.0_wp, 0.0_wp)
    do i = 1, n
      coefficient = coefficient + cmplx(force(1, i), force(2, i), wp)*exp(cmplx(0.0_wp, &
        -two_pi*real(modulo(turns*(i - 1), n), wp)/n, wp))
    end do
    coefficient = coefficient/n
  end function force_harmonic

  !> The shaft that cancels a harmonic of the shaking force.
  pure function cancelling_shaft(coefficient, turns, place) result(shaft)
    complex(wp), intent(in) :: coefficient !! Z_k at ω2 = 1 [kg m]
    integer, intent(in) :: turns           !! k, not 0
    real(wp), intent(in) :: place(2)       !! of its axis [m]
    type(shaft_t) :: shaft

    real(wp), parameter :: rounding = 1.0e-13_wp
    real(wp) :: part(2)

    shaft%turns = turns
    shaft%first_moment = abs(coefficient)/real(turns, wp)**2
    part = -[real(coefficient), aimag(coefficient)]
    where (abs(part) <= rounding*abs(coefficient)) part = 0.0_wp
    shaft%phase = atan2(part(2), part(1))/degree
    shaft%place = place
  end function cancelling_shaft

end module balance_shafts
