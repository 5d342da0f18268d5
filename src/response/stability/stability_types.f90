! src/response/stability/ - free vibrations of a turning elastic linkage: Floquet exponents.
! In: a structure, a `stability_request_t`. Out: `stability_t`, or `intervals_t` of parametric
! resonance. Begin with `find_stability` in `stability.f90`: `find_spectrum` in `turn_spectra.f90`,
! by slow motions, then `find_floquet_modes` in `floquet_exponents.f90`, by the whole equation.
! Intervals: `find_intervals` in `instability_intervals.f90`.
! Not here: the equation (`src/response/turn`), the response to loads (`src/response/steady`).

!> What is asked of the stability of a motion, and what is found.
module stability_types
  use elastic_equations, only: elastic_terms_t
  use errors, only: error_t, outcome_t
  use kinds, only: long, wp
  use response_types, only: link_damping_t
  implicit none (type, external)
  private

  public :: stability_request_t, exponent_t, speed_stability_t, stability_t, &
    instability_t, gap_t, intervals_t
  public :: stable, undecided, unstable_flip, unstable_fold, unstable_combination, is_unstable

  !> Verdicts: a multiplier is inside the unit circle or, without damping, on it and cannot leave
  !! it; it is outside, where it passed −1 (flip) or 1 (fold), or met that of another mode.
  integer, parameter :: undecided = 0, stable = 1, unstable_flip = 2, unstable_fold = 3, &
    unstable_combination = 4

  type :: stability_request_t
    real(wp), allocatable :: speed(:)               !! ω2, none zero [rad/s]
    integer :: modes = 3                            !! vibrations wanted, from the slowest
    real(wp) :: accuracy = 1.0e-6_wp                !! of growth [nepers a turn]
    integer :: samples = 0                          !! over the turn, of the first solution; the
                                                    !! second has half as many more. 0: as many as
                                                    !! the accuracy needs
    real(wp) :: least_growth = 1.0e-4_wp            !! of intervals that are wanted [nepers a turn]
    type(elastic_terms_t) :: terms
    type(link_damping_t), allocatable :: damping(:) !! (bodies), then that of dampers, if any act
  end type stability_request_t

  !> The Floquet exponent of a vibration: of the two of a pair of real multipliers the greater.
  type :: exponent_t
    integer :: mode = 0               !! its number
    real(wp) :: turns = 0.0_wp        !! per turn of the crank, 0 to 1/2
    real(wp) :: growth = 0.0_wp       !! ln|multiplier| of a turn
    real(wp) :: frequency = 0.0_wp    !! of those that the turns allow the one nearest to the mean
                                      !! frequency of the frozen linkage [rad/s]
    integer :: signature = 0          !! Krein: 1, −1; 0 where multipliers have met
    real(wp) :: error = 0.0_wp        !! of growth, and of 2π turns
    integer :: verdict = undecided
    integer :: partner = 0            !! number of the mode whose multiplier it met; 0: none
  end type exponent_t

  !> The exponents at one speed.
  type, extends(outcome_t) :: speed_stability_t
    type(exponent_t), allocatable :: exponent(:) !! (modes)
    integer :: order = 0                      !! highest polynomial degree
    integer :: samples = 0                    !! over the turn
    integer :: slow = 0                       !! slow coordinates
    integer(long) :: applications = 0_long    !! of the equation, to complex motions
  end type speed_stability_t

  type :: stability_t
    type(speed_stability_t), allocatable :: at_speed(:) !! (speeds)
  end type stability_t

  !> An interval of speeds at which vibrations grow.
  type :: instability_t
    real(wp) :: from = 0.0_wp, to = 0.0_wp !! edges [rad/s]
    integer :: kind = unstable_flip        !! one of the verdicts of instability
    integer :: mode(2) = 0                 !! numbers of the vibrations that meet, at the speed of
                                           !! the largest growth; equal unless it is a combination
    real(wp) :: growth = 0.0_wp            !! the largest [nepers a turn]
    real(wp) :: at = 0.0_wp                !! its speed [rad/s]
    real(wp) :: error = 0.0_wp             !! of the edges [rad/s]
    real(wp) :: growth_error = 0.0_wp      !! of the largest growth
  end type instability_t

  !> Speeds at which intervals could not be found.
  type :: gap_t
    real(wp) :: from = 0.0_wp, to = 0.0_wp !! [rad/s]
    type(error_t) :: error                 !! why
  end type gap_t

  type :: intervals_t
    type(instability_t), allocatable :: interval(:) !! by speed
    type(gap_t), allocatable :: gap(:)
    real(wp) :: range(2) = 0.0_wp                   !! of the speed [rad/s]
    integer :: stations = 0, meetings = 0           !! speeds that were looked at, meetings found
    type(error_t), allocatable :: error             !! why there are none
  end type intervals_t

contains

  !> Whether a verdict is one of instability.
  elemental function is_unstable(verdict) result(yes)
    integer, intent(in) :: verdict
    logical :: yes

    yes = verdict >= unstable_flip
  end function is_unstable

end module stability_types
