!> The elastic motion in time from a state, at given instants, by steps of equal number between
!! them.
!!
!! At constant speed the instants return turn after turn: what the steps between two of them do is
!! kept as one matrix, and further turns are products of matrices and states.
module transient_motions
  use crank_laws, only: crank_law_t
  use deformation_model, only: deformation_model_t
  use errors, only: error_of_numerics, error_t, set_error
  use gauss_collocation, only: collocation_t, new_radau_collocation
  use interruption, only: was_interrupted
  use kinds, only: long, wp
  use motion_matrices, only: motion_matrices_t
  use path_grids, only: new_path_grid
  use structures, only: structure_t
  use transient_steps, only: advance, elastic_state_t, make_steps, take_steps, transient_step_t
  use turn_grids, only: turn_grid_t
  implicit none (type, external)
  private

  public :: transient_motion_t, solve_motion, stages

  !> Stages of a step by Radau's method: it is of order 9. Vibrations too fast for the steps, and
  !! deformations that damping stops at once, fade instead of going on for ever.
  integer, parameter :: stages = 5

  !> A motion that grows beyond this has no digits any more.
  real(wp), parameter :: near_overflow = 1.0e100_wp

  type :: transient_motion_t
    real(wp), allocatable :: state(:, :) !! (2 unknowns, instants) y, P [√J, √J s]
    integer(long) :: made = 0_long       !! steps whose matrices were made
    integer(long) :: taken = 0_long      !! products of a matrix and a state
  end type transient_motion_t

contains

  !> The state at every instant.
  !!
  !! Errors: those of `new_path_grid` and `place_grid`; a step has no solution; the motion grows
  !! beyond all numbers.
  subroutine solve_motion(structure, model, law, damping, axial, time, instants, substeps, start, &
    motion, error)
    class(structure_t), intent(in) :: structure    !! linkage and beams
    type(deformation_model_t), intent(in) :: model !! of its bodies
    type(crank_law_t), intent(in) :: law           !! of the crank
    real(wp), intent(in) :: damping(:)             !! of `damping_of` [s]
    logical, intent(in) :: axial                   !! with the stiffness of axial forces
    real(wp), intent(in) :: time(:)                !! (instants) even, from 0 [s]
    integer, intent(in) :: instants                !! of a turn at constant speed
    integer, intent(in) :: substeps                !! between instants
    real(wp), intent(in) :: start(:)               !! (2 unknowns) y, P at the first instant
    type(transient_motion_t), intent(out) :: motion
    type(error_t), allocatable, intent(out) :: error

    type(collocation_t) :: rule
    type(turn_grid_t) :: grid
    type(motion_matrices_t) :: matrices
    type(transient_step_t), allocatable :: steps(:)
    type(transient_step_t) :: kept(instants)
    type(elastic_state_t) :: state
    integer :: first, k, slot

    rule = new_radau_collocation(stages)
    call new_path_grid(structure, model, stages*substeps, grid, error)
    if (allocated(error)) return
    allocate (motion%state(size(start), size(time)))
    state%value = start
    state%carry = 0.0_wp*start
    motion%state(:, 1) = start
    first = findloc(time >= law%ramp, .true., dim=1)
    if (first == 0) first = size(time)
    do k = 1, size(time) - 1
      if (was_interrupted()) exit
      if (k >= first) then
        slot = 1 + modulo(k - first, instants)
        ! What does not return is not worth its matrix.
        if (.not. allocated(kept(slot)%push) .and. k + instants < size(time)) then
          call make_steps(structure, law, damping, axial, rule, time(k), (time(k + 1) - &
            time(k))/substeps, grid, matrices, steps, error)
          if (allocated(error)) return
          motion%made = motion%made + substeps
          call join(steps, kept(slot))
        end if
        if (allocated(kept(slot)%push)) then
          call advance(kept(slot), state)
          motion%taken = motion%taken + 1
        else
          call go(time(k), time(k + 1))
        end if
      else if (time(k + 1) <= law%ramp) then
        call go(time(k), time(k + 1))
      else
        call go(time(k), law%ramp)
        if (.not. allocated(error)) call go(law%ramp, time(k + 1))
      end if
      if (allocated(error)) return
      motion%state(:, k + 1) = state%value
      if (maxval(abs(state%value)) <= near_overflow) cycle
      call set_error(error, error_of_numerics, "the motion grows without limit")
      return
    end do

  contains

    !> Steps from one time to another.
    subroutine go(from, to)
      real(wp), intent(in) :: from, to !! [s]

      call take_steps(structure, law, damping, axial, rule, from, (to - from)/substeps, grid, &
        matrices, state, error)
      motion%made = motion%made + substeps
      motion%taken = motion%taken + substeps
    end subroutine go

  end subroutine solve_motion

  !> Steps one after another as one: `(1 + B)(1 + A) = 1 + A + B + B A`.
  pure subroutine join(steps, whole)
    type(transient_step_t), intent(in) :: steps(:)
    type(transient_step_t), intent(out) :: whole

    integer :: i

    whole = steps(1)
    do i = 2, size(steps)
      whole%push = whole%push + (steps(i)%push + matmul(steps(i)%change, whole%push))
      whole%change = whole%change + (steps(i)%change + matmul(steps(i)%change, whole%change))
    end do
  end subroutine join

end module transient_motions
