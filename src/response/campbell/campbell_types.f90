! src/response/campbell/ - Campbell diagrams and critical speeds of a turning elastic linkage.
! In: a structure, a `stability_request_t`. Out: a `campbell_t`. Begin with `find_campbell` in
! `campbell.f90`: after the exponents `find_bands` in `frozen_bands.f90`, then
! `find_critical_speeds` in `critical_speeds.f90`.
! Not here: Floquet exponents, and crossings of their multipliers (`src/response/stability`).

!> What is asked of a Campbell diagram, and what is found: bands of frozen frequencies, Floquet
!! frequencies, critical speeds.
module campbell_types
  use errors, only: error_t, outcome_t
  use kinds, only: wp
  use stability_types, only: exponent_t
  implicit none (type, external)
  private

  public :: band_t, speed_campbell_t, critical_t, gap_t, campbell_t

  !> Frequencies of a mode of the linkage frozen at the positions of a turn.
  type :: band_t
    real(wp) :: least = 0.0_wp    !! [rad/s]
    real(wp) :: mean = 0.0_wp     !! over the time of a turn [rad/s]
    real(wp) :: greatest = 0.0_wp !! [rad/s]
    real(wp) :: error = 0.0_wp    !! estimated, the largest of the three relative ones
  end type band_t

  !> What is known at a speed of the deck.
  type, extends(outcome_t) :: speed_campbell_t
    type(band_t), allocatable :: band(:)         !! (modes); none where the linkage frozen in some
                                                 !! position buckles under the axial forces
    type(exponent_t), allocatable :: exponent(:) !! (modes)
  end type speed_campbell_t

  !> A speed at which a Floquet frequency is a multiple of it.
  type :: critical_t
    real(wp) :: speed = 0.0_wp       !! ω2 [rad/s]
    real(wp) :: speed_error = 0.0_wp !! relative
    integer :: line = 0              !! the multiple
    integer :: mode = 0
    real(wp) :: frequency = 0.0_wp   !! [rad/s]
    real(wp) :: growth = 0.0_wp      !! ln|multiplier| of a turn, below 0 with damping
    real(wp) :: excitation = 0.0_wp  !! growth of the largest deflection of the resonant part of a
                                     !! motion from rest, in its first turn [m]
    real(wp) :: amplitude = 0.0_wp   !! largest deflection of the resonant part of the steady state
                                     !! [m]; 0 without damping
    real(wp) :: error = 0.0_wp       !! of the excitation, relative
    type(error_t), allocatable :: fault !! why there is no excitation
  end type critical_t

  !> Speeds between which multipliers could not be followed.
  type :: gap_t
    real(wp) :: speed(2) = 0.0_wp    !! ω2 [rad/s]
  end type gap_t

  type :: campbell_t
    type(speed_campbell_t), allocatable :: at_speed(:) !! (speeds)
    type(critical_t), allocatable :: critical(:)       !! in ascending order of |ω2|
    type(gap_t), allocatable :: gap(:)
    integer :: left_out = 0          !! critical speeds that the response hardly excites
    logical :: damped = .false.      !! a link has damping: amplitudes are finite
  end type campbell_t

end module campbell_types
