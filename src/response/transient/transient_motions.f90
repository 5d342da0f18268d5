!> The elastic motion in time from a state, at given instants, by steps of equal number between
!! them, and between them and where the motion of the crank is not smooth.
!!
!! At constant speed the instants return turn after turn: what the steps between two of them do is
!! kept as one matrix, and further turns are products of matrices and states.
module transient_motions
  use crank_laws, only: constant_from, crank_breaks, crank_law_t, crank_motion
  use deformation_model, only: deformation_model_t
  use errors, only: error_of_numerics, error_t, set_error
  use gauss_collocation, only: new_radau_collocation
  use interruption, only: was_interrupted
  use kinds, only: long, wp
  use motion_matrices, only: find_motion_matrices, motion_matrices_t
  use path_grids, only: new_path_grid, place_grid
  use strain_dampings, only: damping_t
  use structures, only: structure_t
  use transient_steps, only: advance, elastic_state_t, kick, make_steps, stepping_t, take_steps, &
    transient_step_t
  use turn_grids, only: turn_grid_t
  implicit none (type, external)
  private

  public :: transient_motion_t, new_stepping, solve_motion, stages

  !> Stages of a step by Radau's method: it is of order 9. Vibrations too fast for the steps, and
  !! deformations that damping stops at once, fade instead of going on for ever.
  integer, parameter :: stages = 5

  !> A motion that grows beyond this has no digits any more.
  real(wp), parameter :: near_overflow = 1.0e100_wp

  !> Speeds of the crank that differ less, and intervals of rows, are the same.
  real(wp), parameter :: rounding = 1.0e-9_wp

  type :: transient_motion_t
    real(wp), allocatable :: state(:, :) !! (2 unknowns, instants) y, P [√J, √J s]
    integer(long) :: made = 0_long       !! steps whose matrices were made
    integer(long) :: taken = 0_long      !! products of a matrix and a state
  end type transient_motion_t

contains

  !> Steps of equal number between instants.
  !!
  !! Errors: those of `new_path_grid`.
  subroutine new_stepping(structure, model, law, damping, axial, substeps, stepping, error)
    class(structure_t), intent(in) :: structure    !! linkage and beams
    type(deformation_model_t), intent(in) :: model !! of its bodies
    type(crank_law_t), intent(in) :: law           !! of the crank
    type(damping_t), intent(in) :: damping         !! of `damping_of`
    logical, intent(in) :: axial                   !! with the stiffness of axial forces
    integer, intent(in) :: substeps                !! between instants
    type(stepping_t), intent(out) :: stepping
    type(error_t), allocatable, intent(out) :: error

    stepping%law = law
    stepping%damping = damping
    stepping%axial = axial
    stepping%rule = new_radau_collocation(stages)
    call new_path_grid(structure, model, stages*substeps, stepping%grid, error, law%range)
  end subroutine new_stepping

  !> The state at every instant.
  !!
  !! Errors: those of `place_grid`; a step has no solution; the motion grows beyond all numbers.
  subroutine solve_motion(structure, time, instants, start, stepping, motion, error)
    class(structure_t), intent(in) :: structure    !! linkage and beams
    real(wp), intent(in) :: time(:)                !! (instants) [s]; of a constant speed even,
                                                   !! but the last
    integer, intent(in) :: instants                !! of a turn at constant speed
    real(wp), intent(in) :: start(:)               !! (2 unknowns) y, P at the first instant
    type(stepping_t), intent(inout) :: stepping    !! by `new_stepping`
    type(transient_motion_t), intent(out) :: motion
    type(error_t), allocatable, intent(out) :: error

    type(turn_grid_t) :: here
    type(motion_matrices_t) :: matrices_here
    type(transient_step_t), allocatable :: steps(:)
    type(transient_step_t) :: kept(instants)
    type(elastic_state_t) :: state
    real(wp), allocatable :: places(:)
    real(wp) :: speed !! before the next piece of the motion of the crank [rad/s]
    integer :: first, i, k, slot, substeps

    substeps = stepping%grid%samples/stages
    allocate (motion%state(size(start), size(time)))
    state%value = start
    state%carry = 0.0_wp*start
    motion%state(:, 1) = start
    first = findloc(time >= constant_from(stepping%law), .true., dim=1)
    if (first == 0) first = size(time)
    speed = huge(speed)
    do k = 1, size(time) - 1
      if (was_interrupted()) exit
      slot = 1 + modulo(k - first, instants)
      ! What does not return is not worth its matrix.
      if (k >= first .and. is_whole(k) .and. .not. allocated(kept(slot)%push) .and. &
        k + instants < size(time)) then
        call make_steps(structure, time(k), (time(k + 1) - time(k))/substeps, stepping, steps, &
          error)
        if (allocated(error)) return
        motion%made = motion%made + substeps
        call join(steps, kept(slot))
      end if
      if (k >= first .and. is_whole(k) .and. allocated(kept(slot)%push)) then
        call advance(kept(slot), state)
        motion%taken = motion%taken + 1
      else
        places = [time(k), crank_breaks(stepping%law, time(k), time(k + 1)), time(k + 1)]
        do i = 1, size(places) - 1
          call go(places(i), places(i + 1))
          if (allocated(error)) return
        end do
      end if
      motion%state(:, k + 1) = state%value
      if (maxval(abs(state%value)) <= near_overflow) cycle
      call set_error(error, error_of_numerics, "the motion grows without limit")
      return
    end do

  contains

    !> Whether an interval is as long as the others.
    pure logical function is_whole(k)
      integer, intent(in) :: k !! its number

      is_whole = abs(time(k + 1) - time(k) - (time(2) - time(1))) <= rounding*(time(2) - time(1))
    end function is_whole

    !> Steps from one time to another, after a jump of the speed if there is one.
    subroutine go(from, to)
      real(wp), intent(in) :: from, to !! [s]

      real(wp) :: now(0:2)

      if (allocated(stepping%law%program)) then
        now = crank_motion(stepping%law, from, 0.5_wp*(from + to))
        if (k > 1 .or. i > 1) call jump(now(0), now(1) - speed)
        if (allocated(error)) return
        now = crank_motion(stepping%law, to, 0.5_wp*(from + to))
        speed = now(1)
      end if
      call take_steps(structure, from, (to - from)/substeps, stepping, state, error)
      motion%made = motion%made + substeps
      motion%taken = motion%taken + substeps
    end subroutine go

    !> What a jump of the crank's speed does.
    subroutine jump(crank, change)
      real(wp), intent(in) :: crank  !! angle [deg]
      real(wp), intent(in) :: change !! [rad/s]

      if (abs(change) <= rounding*abs(speed) .or. abs(change) <= tiny(change)) return
      if (.not. allocated(here%first)) call new_path_grid(structure, stepping%grid%model, 1, &
        here, error, stepping%law%range)
      if (.not. allocated(error)) call place_grid(structure, [crank], here, error)
      if (allocated(error)) return
      call find_motion_matrices(here, matrices_here)
      call kick(matrices_here, 1, change, stepping%axial, state)
    end subroutine jump

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
