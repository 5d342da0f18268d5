!> Refinement of what is solved on two levels: the difference of both solutions tells errors, and
!! orders or samples are raised until these are small enough, or more of the same is of no use. What
!! is solved and measured is the caller's; whether and with what it is solved again is decided here.
!!
!! A round: `begin_round`, both solutions, `add_work`; then `compare` with the error, where raising
!! has to gain, and `raise` if it is too large.
module refinements
  use interruption, only: was_interrupted
  use kinds, only: long, wp
  use turn_grids, only: turn_grid_t
  implicit none (type, external)
  private

  public :: refinement_t, refinement_limits_t, sample_numbers, most_samples, order_on, samples_on, &
    begin_round, add_work, compare, raise, repeat_round

  !> Numbers of samples, products of small factors.
  integer, parameter :: sample_numbers(*) = [64, 96, 128, 192, 256, 384, 512, 768, 1024, 1536, &
    2048], most_samples = sample_numbers(size(sample_numbers))

  !> Orders of the second level above those of the first, and by which they are raised.
  integer, parameter :: orders_above = 2

  !> When to stop. What is not given does not limit.
  type :: refinement_limits_t
    integer :: order = huge(1)           !! of the first level
    integer :: rounds = huge(1)          !! times that orders or samples are raised
    integer(long) :: work = huge(1_long) !! as by `add_work`
    real(wp) :: gain = 1.0_wp            !! errors are to fall by this each time
    integer :: idle = huge(1)            !! the so many-th time, one after another, that they do not
                                         !! is the last
    real(wp) :: rounding = huge(1.0_wp)  !! that of larger errors does not count, which are none of
                                         !! rounding
  end type refinement_limits_t

  !> What is chosen, and how it went so far.
  type :: refinement_t
    type(refinement_limits_t) :: limits
    integer :: order = 0           !! highest polynomial degree of the first level
    integer :: samples = 0         !! over a turn, of the first level
    integer :: least_above = 0     !! samples of the second level, at least
    logical :: backwards = .false. !! the crank turns clockwise
    integer :: level(2) = 0        !! numbers of both levels, by `need_levels`
    logical :: pending = .true.    !! to be solved, with this choice
    integer :: round = 0           !! times raised
    integer(long) :: work = 0_long
    real(wp) :: smallest = huge(1.0_wp) !! error so far
    logical :: gained = .false.    !! enough, by what was raised before
    integer :: idle = 0            !! times that it did not, one after another
  end type refinement_t

contains

  !> Order of the first or second level.
  elemental integer function order_on(refinement, level)
    type(refinement_t), intent(in) :: refinement
    integer, intent(in) :: level

    order_on = refinement%order + (level - 1)*orders_above
  end function order_on

  !> Its samples. The second has half as many more: with a third more, errors were seen that both
  !! have in common.
  elemental integer function samples_on(refinement, level)
    type(refinement_t), intent(in) :: refinement
    integer, intent(in) :: level

    samples_on = refinement%samples
    if (level == 2) samples_on = max(3*refinement%samples/2, refinement%least_above)
  end function samples_on

  !> Begins a solution if one is pending. It is the last unless something is raised or repeated; an
  !! interrupted run leaves no results.
  subroutine begin_round(refinement, begun)
    type(refinement_t), intent(inout) :: refinement
    logical, intent(out) :: begun

    begun = refinement%pending .and. .not. was_interrupted()
    refinement%pending = .false.
  end subroutine begin_round

  !> Work on a level: applications of the equation, and a slow motion.
  pure subroutine add_work(refinement, grid, applications, slow)
    type(refinement_t), intent(inout) :: refinement
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: applications
    integer, intent(in), optional :: slow !! coordinates

    integer(long) :: work

    work = int(applications, long)*grid%unknowns
    if (present(slow)) work = work + int(slow, long)**3
    refinement%work = refinement%work + work*grid%samples
  end subroutine add_work

  !> Takes the error of a result, huge if there is none.
  pure subroutine compare(refinement, error, is_best)
    type(refinement_t), intent(inout) :: refinement
    real(wp), intent(in) :: error
    logical, intent(out) :: is_best !! smaller than all before

    is_best = error < refinement%smallest
    ! Nothing before is to gain on.
    refinement%gained = error <= refinement%limits%gain*refinement%smallest .or. &
      refinement%smallest >= huge(error)
    refinement%idle = merge(0, refinement%idle + 1, refinement%gained .or. error > &
      refinement%limits%rounding)
    refinement%smallest = min(error, refinement%smallest)
  end subroutine compare

  !> Raises orders and samples, within the limits.
  pure subroutine raise(refinement, orders, samples)
    type(refinement_t), intent(inout) :: refinement
    integer, intent(in) :: orders  !! so many times, 0: not
    integer, intent(in) :: samples !! to as many at least; no more than there are: not

    refinement%round = refinement%round + 1
    associate (limits => refinement%limits)
      refinement%pending = refinement%round <= limits%rounds .and. refinement%work <= limits%work &
        .and. refinement%idle < limits%idle .and. .not. (orders > 0 .and. refinement%order >= &
        limits%order) .and. .not. (samples > refinement%samples .and. refinement%samples >= &
        most_samples)
      if (.not. refinement%pending) return
      refinement%order = min(limits%order, refinement%order + orders*orders_above)
    end associate
    if (samples > refinement%samples) refinement%samples = sample_numbers(findloc(sample_numbers &
      >= min(samples, most_samples), .true., dim=1))
  end subroutine raise

  !> The same choice once more, if there is time for it.
  pure subroutine repeat_round(refinement)
    type(refinement_t), intent(inout) :: refinement

    refinement%pending = refinement%work <= refinement%limits%work
  end subroutine repeat_round

end module refinements
