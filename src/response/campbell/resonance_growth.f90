!> How the loads of the motion excite a vibration at a critical speed, where its multipliers are
!! real or nearly so: how much it grows in a turn from rest, by the loads alone, and with damping
!! the part that it has in the steady state.
!!
!! The periodic solution `y(σ)` of `L(σ) y = f`, the motion `e^{σ θ} y` under `e^{σ θ} f`, has poles
!! at the exponents of free vibrations. Those of a critical speed are a pair at `σ0 ± κ`,
!! `y = (r (σ − σ0) + b)/((σ − σ0)² − κ²) + …`: without damping σ0 = 0, and the motion from rest is
!! `r θ + …` as long as κ θ is small. From solutions at `σ0 ± η`, sum s and difference d,
!! `(η − κ²/η) d/2 = r + O(η²)`, a polynomial in η², of which three distances give the value at 0,
!! and `(η² − κ²) s/2 = b + O(η² − κ²)` likewise the value at κ².
module resonance_growth
  use constants, only: two_pi
  use elastic_equations, only: elastic_terms_t, load_at_speed
  use equations_at_speed, only: equation_at_speed_t
  use errors, only: error_t
  use fourier_transform, only: close_fourier, fourier_plan_t, open_fourier
  use kinds, only: wp
  use periodic_solver, only: approximate_solution, solve_periodic
  use response_levels, only: level_t, set_equation
  use response_types, only: link_damping_t
  use slow_motions, only: new_slow_motion, slow_motion_t
  implicit none (type, external)
  private

  public :: critical_pair_t, growth_t, find_growth

  !> Exponents that meet, or nearly so, at a critical speed: `σ0 ± κ`.
  type :: critical_pair_t
    real(wp) :: speed = 0.0_wp  !! |ω2| [rad/s]
    real(wp) :: centre = 0.0_wp !! σ0, per radian of the crank
    real(wp) :: square = 0.0_wp !! κ²; below 0: exponents are `σ0 ± i|κ|`
    real(wp) :: doubt = 0.0_wp  !! their error
  end type critical_pair_t

  !> Motions over the turn: (samples, unknowns, value and error) [√J].
  type :: growth_t
    real(wp), allocatable :: growth(:, :, :) !! from rest, in a turn
    real(wp), allocatable :: steady(:, :, :) !! resonant part of the steady state; 0 where
                                             !! vibrations do not fade
    real(wp) :: lack = 0.0_wp                !! of both, relative, by what iterations leave of
                                             !! solutions and exponents
  end type growth_t

  !> Distance of the solutions from the pole: near enough to be far from other exponents, far enough
  !! for both of the pair to lie close to it beside; times the distance of these from each other.
  real(wp), parameter :: nearest = 2.0e-3_wp, beside_pair = 3.0_wp
  real(wp), parameter :: distances(3) = [1.0_wp, 1.5_wp, 2.0_wp] !! in these

  !> Sum of the factors, without sign, of the three in the value there: `Π η_j² / |η_j² − η_i²|`.
  real(wp), parameter :: extrapolating = 4.7_wp

  !> Stages of the collocation of slow motions.
  integer, parameter :: stages = 4

contains

  !> Growth of the displacements in a turn, `2π r`, over the turn; the resonant part of the steady
  !! state; and the errors of both by the extrapolation, estimated.
  !!
  !! Errors: iterations do not converge; the slow motion grows too much.
  subroutine find_growth(level, slow, pair, dampings, terms, tolerance, found, error)
    type(level_t), intent(in), target :: level       !! with this many slow coordinates
    integer, intent(in) :: slow
    type(critical_pair_t), intent(in) :: pair
    type(link_damping_t), intent(in) :: dampings(:)  !! as for `damping_of`
    type(elastic_terms_t), intent(in) :: terms
    real(wp), intent(in) :: tolerance                !! of the solutions; huge: from the slow motion
                                                     !! alone
    type(growth_t), intent(out) :: found
    type(error_t), allocatable, intent(out) :: error !! why there is none

    type(fourier_plan_t), target :: plan
    type(slow_motion_t), target :: motion
    type(equation_at_speed_t) :: equation
    real(wp), dimension(level%grid%samples, level%grid%unknowns) :: load, y
    real(wp), dimension(level%grid%samples, level%grid%unknowns, 3) :: odd, even
    real(wp) :: eta(3), remainder
    integer :: i, side, iterations

    load = load_at_speed(level%grid, pair%speed)
    eta = max(nearest, beside_pair*sqrt(abs(pair%square)))*distances
    odd = 0.0_wp
    even = 0.0_wp
    call open_fourier(level%grid%samples, plan)
    attempt: block
      call new_slow_motion(plan, level%basis(slow), pair%speed, stages, motion, error)
      if (allocated(error)) exit attempt
      call set_equation(level, plan, motion, pair%speed, dampings, terms, equation)
      do i = 1, 3
        do side = -1, 1, 2
          call approximate_solution(equation, load, y, pair%centre + side*eta(i))
          if (tolerance < 1.0_wp) then
            call solve_periodic(equation, load, tolerance, y, iterations, remainder, error, &
              exponent=pair%centre + side*eta(i))
            if (allocated(error)) exit attempt
            found%lack = max(found%lack, extrapolating*remainder)
          end if
          odd(:, :, i) = odd(:, :, i) + 0.5_wp*side*(eta(i) - pair%square/eta(i))*y
          even(:, :, i) = even(:, :, i) + 0.5_wp*(eta(i)**2 - pair%square)*y
        end do
      end do
    end block attempt
    call close_fourier(plan)
    if (allocated(error)) return
    ! Of a/(σ − σ0) + b/(σ − σ0)² the second is seen in the odd part where σ0 is not quite right.
    found%lack = found%lack + extrapolating*pair%doubt/eta(1)**2*(2.0_wp*sqrt(abs(pair%square)) + &
      pair%doubt + 2.0_wp*maxval(abs(even(:, :, 1)))/max(maxval(abs(odd(:, :, 1))), tiny(1.0_wp)))
    odd = extrapolated(odd, eta**2, 0.0_wp)
    found%growth = two_pi*odd(:, :, :2)
    allocate (found%steady, mold=found%growth)
    found%steady = 0.0_wp
    if (pair%centre + sqrt(max(0.0_wp, pair%square)) >= 0.0_wp) return
    even = extrapolated(even, eta**2, pair%square)
    found%steady = (even(:, :, :2) - pair%centre*odd(:, :, :2))/(pair%centre**2 - pair%square)
  end subroutine find_growth

  !> Value and error at a place of functions known at three, in the first two places of the last
  !! dimension: by parabolas, and what lines through the nearer two differ from these.
  pure function extrapolated(known, at, place) result(found)
    real(wp), intent(in) :: known(:, :, :) !! (…, three)
    real(wp), intent(in) :: at(3), place
    real(wp) :: found(size(known, 1), size(known, 2), 3)

    found(:, :, 2) = (linear(1) - linear(2))*(place - at(1))/(at(3) - at(1))
    found(:, :, 1) = linear(1) - found(:, :, 2)
    found(:, :, 3) = 0.0_wp

  contains

    pure function linear(first) result(value)
      integer, intent(in) :: first
      real(wp) :: value(size(known, 1), size(known, 2))

      value = known(:, :, first) + (known(:, :, first + 1) - known(:, :, first))*(place - &
        at(first))/(at(first + 1) - at(first))
    end function linear

  end function extrapolated

end module resonance_growth
