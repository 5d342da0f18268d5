!> The crank positions of a run: each computed once, however often it is written.
module positions
  use applied_loads, only: evaluate_loads
  use coordinates, only: evaluated_t
  use errors, only: error_t
  use kinds, only: wp
  use kinematic_coefficients, only: find_kinematic_coefficients, kinematic_coefficients_t
  use linkage_paths, only: period_of
  use linkages, only: linkage_t
  use load_tables, only: load_period, refuse_beyond_tables
  use poses, only: find_moving_pose, pose_t, refuse_change_point
  use sorting, only: ascending_order
  implicit none (type, external)
  private

  public :: positions_t, state_t, refuse_change_points, find_positions, list_positions, &
    list_block, find_first_alike, find_state, by_crank_angle

  !> The linkage at one crank angle.
  type :: state_t
    real(wp) :: crank = 0.0_wp          !! crank angle [deg]
    real(wp), allocatable :: time       !! of an instant; else not allocated [s]
    type(pose_t), allocatable :: pose   !! incomplete if out of reach
    type(kinematic_coefficients_t), allocatable :: coefficients !! undefined after an error
    type(error_t), allocatable :: error !! why the links cannot be moved here
  end type state_t

  !> All listed crank angles or a block of the list, and one state for each different angle.
  type :: positions_t
    real(wp) :: period = 360.0_wp           !! after which positions repeat [deg]; 0: none
    integer :: before = 0                   !! positions of the list before this block
    integer :: repeated = 0                 !! states that an earlier block has, too
    real(wp), allocatable :: crank(:)       !! (positions) as the deck lists them [deg]
    integer, allocatable :: state(:)        !! (positions) number in `states`; 0° and 360° have the
                                            !! same
    type(state_t), allocatable :: states(:) !! (different angles) in the order of the list
  end type positions_t

contains

  !> Finds pose and kinematic coefficients once for every different angle.
  !!
  !! Errors of a position are left in its state.
  pure function find_positions(linkage, crank) result(positions)
    type(linkage_t), intent(in) :: linkage !! lengths, pins and dyads
    real(wp), intent(in) :: crank(:)       !! (positions) crank angles [deg]
    type(positions_t) :: positions

    integer :: i

    call list_positions(crank, positions, load_period(linkage, period_of(linkage)))
    do i = 1, size(positions%states)
      call find_state(linkage, positions%states(i))
    end do
  end function find_positions

  !> The different angles of a list, without poses. Whole turns make no difference, or whole periods
  !! where the linkage repeats its positions later.
  pure subroutine list_positions(crank, positions, period, instants)
    real(wp), intent(in) :: crank(:)            !! (positions) crank angles [deg]
    type(positions_t), intent(out) :: positions !! with states yet to be found
    real(wp), intent(in), optional :: period    !! of the linkage [deg]; 0: none; absent: a turn
    real(wp), intent(in), optional :: instants(:) !! (positions) each is a state of its own, for the
                                                !! speed differs from one to the other; none: they
                                                !! are not [s]

    logical :: is_apart

    if (present(period)) positions%period = period
    is_apart = .false.
    if (present(instants)) is_apart = size(instants) > 0
    call list_block(crank, find_first_alike(crank, positions%period, is_apart), 0, size(crank), &
      positions, instants)
  end subroutine list_positions

  !> For every position of a list the first one with the same crank angle, which may be itself.
  pure function find_first_alike(crank, period, instants) result(first)
    real(wp), intent(in) :: crank(:) !! (positions) crank angles [deg]
    real(wp), intent(in) :: period   !! as of `list_positions`
    logical, intent(in) :: instants  !! likewise
    integer :: first(size(crank))    !! (positions) numbers

    real(wp) :: reduced(size(crank))
    integer :: order(size(crank)), i

    first = [(i, i=1, size(crank))]
    if (instants) return
    reduced = reduced_crank(period, crank)
    order = ascending_order(reduced)
    ! Equal angles are adjacent in the sorted order, the first listed before the others.
    do i = 2, size(crank)
      if (reduced(order(i)) <= reduced(order(i - 1))) first(order(i)) = first(order(i - 1))
    end do
  end function find_first_alike

  !> The different angles of a block of a list, without poses.
  pure subroutine list_block(crank, first_alike, before, last, positions, instants)
    real(wp), intent(in) :: crank(:)      !! (positions) all of the list [deg]
    integer, intent(in) :: first_alike(:) !! (positions) by `find_first_alike`
    integer, intent(in) :: before, last   !! positions before the block, number of its last one
    type(positions_t), intent(inout) :: positions !! new; on return with states yet to be found
    real(wp), intent(in), optional :: instants(:) !! as of `list_positions`

    integer :: i, states

    positions%before = before
    positions%crank = crank(before + 1:last)
    positions%repeated = count(first_alike(before + 1:last) <= before)
    allocate (positions%state(last - before))
    states = 0
    do i = before + 1, last
      if (first_alike(i) > before .and. first_alike(i) < i) then
        positions%state(i - before) = positions%state(first_alike(i) - before)
      else
        states = states + 1
        positions%state(i - before) = states
      end if
    end do
    allocate (positions%states(states))
    do i = 1, size(positions%state)
      positions%states(positions%state(i))%crank = crank(first_alike(before + i))
    end do
    if (.not. present(instants)) return
    do i = 1, merge(states, 0, size(instants) > 0)
      positions%states(i)%time = instants(before + i)
    end do
  end subroutine list_block

  !> Pose and kinematic coefficients at the crank angle of a state.
  !!
  !! Errors, left in the state: those of `find_moving_pose`; a position beyond the ends of a table.
  pure subroutine find_state(linkage, state)
    type(linkage_t), intent(in) :: linkage !! lengths, pins and dyads
    type(state_t), intent(inout) :: state  !! with its crank angle, and the time of an instant

    type(evaluated_t), allocatable :: along(:)

    allocate (state%pose, state%coefficients)
    call find_moving_pose(linkage, state%crank, state%pose, state%error)
    state%pose%has_time = allocated(state%time)
    if (allocated(state%time)) state%pose%time = state%time
    if (.not. allocated(state%error)) then
      call evaluate_loads(linkage, state%pose, along)
      call refuse_beyond_tables(linkage, state%pose, along, state%error)
    end if
    if (.not. allocated(state%error)) state%coefficients = &
      find_kinematic_coefficients(linkage, state%pose)
  end subroutine find_state

  !> An error at change points: the linkage is moved through them, but forces in its joints, and
  !! vibrations, are not determined there.
  pure subroutine refuse_change_points(positions)
    type(positions_t), intent(inout) :: positions !! with their states

    integer :: i

    do i = 1, size(positions%states)
      associate (state => positions%states(i))
        if (allocated(state%error)) cycle
        call refuse_change_point(state%pose, state%error)
      end associate
    end do
  end subroutine refuse_change_points

  !> Numbers of all states in ascending order of their crank angles from 0° to 360°.
  pure function by_crank_angle(positions) result(states)
    type(positions_t), intent(in) :: positions !! their states may be yet to be found
    integer :: states(size(positions%states))

    states = ascending_order(reduced_crank(positions%period, positions%states%crank))
  end function by_crank_angle

  !> Coordinates of the first drive without whole periods.
  pure function reduced_crank(period, crank) result(reduced)
    real(wp), intent(in) :: period   !! 0: none
    real(wp), intent(in) :: crank(:) !! [deg] or [m]
    real(wp) :: reduced(size(crank))

    reduced = crank
    if (period > 0.0_wp) reduced = modulo(crank, period)
  end function reduced_crank

end module positions
