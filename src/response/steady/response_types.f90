! src/response/steady/ - the steady elastic response at constant speed of the crank.
! In: a structure, a `response_request_t`. Out: a `response_t` with estimated errors. Begin with
! `find_steady_responses` in `steady_responses.f90`: two levels by `need_levels` in
! `response_levels.f90`, each solved by `solve_periodic` in `periodic_solver.f90`.
! Not here: the equation (`src/response/turn`), slow motions
! (`src/response/stability/slow_motions.f90`), motions that do not repeat
! (`src/response/transient`).

!> What is asked of the elastic response of a linkage, and what is found.
module response_types
  use elastic_equations, only: elastic_terms_t
  use errors, only: outcome_t
  use kinds, only: long, wp
  implicit none (type, external)
  private

  public :: response_request_t, link_damping_t, gauge_t, response_point_t, link_section_t
  public :: response_t, speed_response_t, peak_t
  public :: axial_strain, bending_strain, moment, axial_force, shear_force, stress, strain_values
  public :: rigid_torque, linear_torque, quadratic_torque, total_torque, power, drive_values
  public :: no_damping, damping_time, damping_ratio, damping_by_dampers

  !> Kinds of damping of a link; of dampers, each of which has its own constant.
  integer, parameter :: no_damping = 0, damping_time = 1, damping_ratio = 2, damping_by_dampers = 3

  !> Places of the values of a gauge [-, -, N m, N, N, Pa].
  integer, parameter :: axial_strain = 1, bending_strain = 2, moment = 3, axial_force = 4, &
    shear_force = 5, stress = 6, strain_values = 6

  !> Places of the values of the drive [N m, W].
  integer, parameter :: rigid_torque = 1, linear_torque = 2, quadratic_torque = 3, &
    total_torque = 4, power = 5, drive_values = 5

  type :: link_damping_t
    integer :: kind = no_damping
    real(wp) :: value = 0.0_wp !! Kelvin–Voigt time [s], or damping ratio [-]
  end type link_damping_t

  !> A place on a link that bends.
  type :: gauge_t
    integer :: body = 0
    real(wp) :: xi = 0.5_wp    !! from 0 to 1 along the body, in its direction round the loop
    real(wp) :: sense = 1.0_wp !! −1: the deck's link runs the other way, so that curvature and
                               !! moment change their sign; the shear force does not
    real(wp) :: side = 1.0_wp  !! of the strain of bending: 1 on the face that is stretched where
                               !! the deck's link turns left, −1 on the other
  end type gauge_t

  !> A point of a link whose displacement is wanted.
  type :: response_point_t
    integer :: body = 0
    real(wp) :: place(2) = 0.0_wp !! from the first pin of the body, in its axes [m]
  end type response_point_t

  !> What stress and strain of a link need besides its stiffnesses.
  type :: link_section_t
    real(wp) :: outer = 0.0_wp  !! largest distance of a fibre from the axis, in the plane [m]
    real(wp) :: modulus = 0.0_wp !! E [Pa]
  end type link_section_t

  type :: response_request_t
    real(wp), allocatable :: speed(:)               !! ω2, none zero [rad/s]
    real(wp), allocatable :: crank(:)               !! (positions) crank angles [deg]
    real(wp) :: accuracy = 1.0e-6_wp                !! relative to the largest over the turn
    type(elastic_terms_t) :: terms
    type(link_damping_t), allocatable :: damping(:) !! (bodies), then that of dampers, if any act
    type(link_section_t), allocatable :: section(:) !! (bodies)
    type(gauge_t), allocatable :: gauges(:)
    type(response_point_t), allocatable :: points(:)
    logical :: peaks = .false.                      !! largest values are wanted
    logical :: validity = .false.                   !! what limits the results is wanted
    integer :: modes = 3                            !! vibrations whose multipliers limit them
  end type response_request_t

  !> The largest value of a quantity of a link, with its place and crank angle.
  type :: peak_t
    real(wp) :: value = 0.0_wp
    real(wp) :: xi = 0.0_wp    !! along the body
    real(wp) :: share = 0.0_wp !! the same, or of both pieces of a link with a block
    real(wp) :: crank = 0.0_wp !! [deg]
    logical :: is_constant = .false. !! over the turn: `crank` says nothing
  end type peak_t

  !> The steady response at one speed. Errors are relative to the largest value over the turn.
  type, extends(outcome_t) :: speed_response_t
    real(wp), allocatable :: displacement(:, :, :)  !! (x, y, rotation; points; positions) [m, rad]
    real(wp), allocatable :: displacement_error(:)  !! (points)
    real(wp), allocatable :: strain(:, :, :)        !! (strain_values, gauges, positions)
    real(wp), allocatable :: strain_error(:)        !! (gauges)
    real(wp), allocatable :: drive(:, :)            !! (drive_values, positions)
    real(wp) :: drive_error = 0.0_wp
    real(wp) :: mean_torque = 0.0_wp                !! of the total [N m]
    type(peak_t), allocatable :: largest_strain(:)     !! (bodies) [-]
    type(peak_t), allocatable :: largest_stress(:)     !! (bodies) [Pa]
    type(peak_t), allocatable :: largest_deflection(:) !! (bodies) [m]
    real(wp), allocatable :: deflection(:)          !! (bodies) largest at a few places and the
                                                    !! samples of the turn, whatever is asked for
                                                    !! [m]
    real(wp), allocatable :: power_lost(:)          !! (bodies) mean over the turn [W]
    real(wp), allocatable :: peak_error(:)          !! (bodies)
    real(wp), allocatable :: buckling(:)            !! (bodies) largest compression of the rigid
                                                    !! linkage / that at which the link buckles as
                                                    !! pinned
    real(wp), allocatable :: buckling_error(:)      !! (bodies) relative
    real(wp), allocatable :: quadratic_change(:)    !! (bodies) of the largest strain, relative;
                                                    !! unallocated: not estimated
    real(wp), allocatable :: quadratic_error(:)     !! (bodies) relative
    real(wp), allocatable :: out_of_plane           !! first frequency of vibrations out of the
                                                    !! plane of motion [Hz]; unallocated: not
                                                    !! estimated
    real(wp) :: out_of_plane_error = 0.0_wp         !! relative
    real(wp), allocatable :: modal_distance         !! least |1 − multiplier| of the slowest
                                                    !! vibrations; unallocated: not found
    real(wp) :: modal_distance_error = 0.0_wp       !! relative
    real(wp) :: distance = 0.0_wp                   !! least |1 − multiplier| of all that samples
                                                    !! resolve, about; 0: resonance
    real(wp) :: growth = 0.0_wp                     !! largest ln|multiplier|
    complex(wp) :: nearest = (0.0_wp, 0.0_wp)       !! of the multiplier nearest to 1:
                                                    !! ln|multiplier| and, as imaginary part, turns
                                                    !! (0 to 1/2)
    integer :: order = 0                            !! highest polynomial degree
    integer :: samples = 0                          !! over the turn
    integer :: slow = 0                             !! slow coordinates
    integer(long) :: applications = 0_long          !! of the equation of motion
    real(wp) :: largest_error = 0.0_wp              !! of all quantities
  end type speed_response_t

  type :: response_t
    type(speed_response_t), allocatable :: at_speed(:) !! (speeds)
  end type response_t

end module response_types
