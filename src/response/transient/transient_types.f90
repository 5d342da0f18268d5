! src/response/transient/ - elastic motions in time at a prescribed motion of the crank.
! In: a structure, a `transient_request_t`. Out: a `transient_t` with estimated errors. Begin with
! `find_transients` in `transient_responses.f90`: `find_start` in `transient_starts.f90`, then
! `solve_motion` in `transient_motions.f90`.
! Not here: the motion of the crank (`src/response/turn/crank_laws.f90`), motions under a motor
! (`src/linkage/free`).

!> What is asked of an elastic motion in time, and what is found.
module transient_types
  use errors, only: error_t, outcome_t
  use kinds, only: long, wp
  use motion_programs, only: motion_program_t
  use response_types, only: response_request_t
  implicit none (type, external)
  private

  public :: transient_request_t, speed_transient_t, transient_t, from_rest, from_steady

  !> Kinds of the start: undeformed and moving with the rigid linkage; in the steady state.
  integer, parameter :: from_rest = 1, from_steady = 2

  type :: transient_request_t
    type(response_request_t) :: response !! speeds, accuracy, terms, damping, gauges, points;
                                         !! accuracy is relative to the largest over the run
    real(wp) :: ramp = 0.0_wp       !! time in which the crank gets to its speed; 0: it has it [s]
    logical :: turns_fully = .true. !! the linkage, and is where it was after a turn
    real(wp) :: crank = 0.0_wp      !! first crank angle [deg]
    real(wp) :: turns = 1.0_wp      !! of the crank, until the end
    integer :: instants = 72        !! of a turn at the speed
    integer :: start = from_rest
    integer :: mode = 0             !! whose shape is added at the start; 0: none
    real(wp) :: amplitude = 0.0_wp  !! its largest displacement [m]
    real(wp) :: velocity = 0.0_wp   !! its largest velocity [m/s]
    type(motion_program_t), allocatable :: program !! of the crank, in degrees, in place of speeds
    real(wp), allocatable :: time(:) !! rising instants of its rows [s]
  end type transient_request_t

  !> The motion at one speed. Errors are relative to the largest value over the run.
  type, extends(outcome_t) :: speed_transient_t
    type(error_t), allocatable :: strain_fault     !! why its strains are not there
    real(wp), allocatable :: time(:)               !! (instants) [s]
    real(wp), allocatable :: crank(:)              !! (instants), past whole turns [deg]
    real(wp), allocatable :: rate(:)               !! (instants) ω2 [rad/s]
    real(wp), allocatable :: displacement(:, :, :) !! (x, y, rotation; points; instants) [m, rad]
    real(wp), allocatable :: displacement_error(:) !! (points)
    real(wp), allocatable :: strain(:, :, :)       !! (strain_values, gauges, instants)
    real(wp), allocatable :: strain_error(:)       !! (gauges)
    real(wp), allocatable :: deflection(:)         !! (links) largest at a few places and rows [m]
    integer :: order = 0                           !! highest polynomial degree
    integer :: steps = 0                           !! between instants
    integer(long) :: made = 0_long                 !! steps whose matrices were made
    integer(long) :: taken = 0_long                !! products of a matrix and a state
    real(wp) :: least_error = 0.0_wp               !! that any is stated with
    real(wp) :: largest_error = 0.0_wp             !! of all quantities
  end type speed_transient_t

  type :: transient_t
    type(speed_transient_t), allocatable :: at_speed(:) !! (speeds)
  end type transient_t

end module transient_types
