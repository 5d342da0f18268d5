! src/vibration/loci/ - modes followed by their shapes over positions and speeds; mode shapes.
! In: a `sweep_t` with prints of its modes. Out: `loci_t`, with crossings and veerings; `shapes_t`.
! Begin with `follow_loci` here, then `prints_of` in `mode_prints.f90`. Shapes: `sample_reduced` in
! `shape_samples.f90`.
! Not here: likeness of modes (`src/eigen/modal_assurance.f90`), rows of a locus
! (`src/studies/elastic/loci_study.f90`).

!> Modes followed by their shapes along crank angle and speed.
module frequency_loci
  use errors, only: error_t, outcome_t
  use kinds, only: wp
  use kinematic_coefficients, only: find_kinematic_coefficients
  use load_cases, only: case_count
  use mixed_positions, only: find_mixed_prints
  use modal_assurance, only: likeness, mode_prints_t
  use mode_prints, only: prints_of
  use position_assembly, only: assemble_position, assembled_t, new_assembled
  use position_results, only: frequency_of
  use positions, only: positions_t, state_t
  use sorting, only: ascending_order
  use speed_solver, only: new_speed_work, solve_speeds, speed_work_t
  use structures, only: find_structure_pose, structure_t
  use sweeps, only: has_result, sweep_t
  use vibration_models, only: load_factors, mode_request_t
  implicit none (type, external)
  private

  public :: loci_t, follow_loci, event_none, event_start, event_crossing, event_veering, &
    event_ambiguous

  integer, parameter :: event_none = 0, event_start = 1, event_crossing = 2, event_veering = 3, &
    event_ambiguous = 4

  type :: loci_t
    integer :: count = 0                         !! loci in all
    integer, allocatable :: locus(:, :, :)       !! (modes, rows, speeds) number of the locus that
                                                 !! a mode belongs to; 0: failed row
    real(wp), allocatable :: mac(:, :, :)        !! (modes, rows, speeds) likeness to the same
                                                 !! locus on the row before; 1 at a start
    integer, allocatable :: event(:, :, :)       !! (modes, rows, speeds)
    integer, allocatable :: partner(:, :, :)     !! (modes, rows, speeds) the other locus of a
                                                 !! crossing or veering; else 0
  end type loci_t

  !> Modes at a place between or on two rows.
  type :: waypoint_t
    real(wp) :: place(2) = 0.0_wp !! crank angle and speed [deg, rad/s]
    type(mode_prints_t) :: prints
  end type waypoint_t

  !> Likenesses above which shapes are the same and below which they differ; between them the step
  !! is cut in two, at most `most_halvings` times.
  real(wp), parameter :: same_shape = 0.9_wp, other_shape = 0.1_wp
  integer, parameter :: most_halvings = 6

  !> Two frequencies have parted again when their distance is this multiple of the least one. If
  !! only two modes veer, half of each shape has passed to the other at √2.
  real(wp), parameter :: veering_width = 1.6_wp

  !> Share of a step at which it is cut: not its middle, which may be a dead point between two
  !! symmetric positions.
  real(wp), parameter :: cut = 0.45_wp

contains

  !> Follows every mode from row to row in the order of crank angles, block after block of speeds;
  !! the first row of a block continues that of the block before.
  subroutine follow_loci(structure, positions, sweep, loci)
    type(structure_t), intent(in) :: structure
    type(positions_t), intent(in) :: positions !! the rows, in any order
    type(sweep_t), intent(inout) :: sweep      !! with the prints of all modes; its ledger counts
                                               !! what is found between the rows
    type(loci_t), intent(out) :: loci          !! no locus where a position has failed

    type(speed_work_t) :: work
    integer :: order(size(positions%crank)), rows, speeds, modes, i, k, last, first_row
    logical :: apart

    rows = size(positions%crank)
    speeds = size(sweep%request%speed)
    modes = sweep%request%modes
    allocate (loci%locus(modes, rows, speeds), loci%mac(modes, rows, speeds))
    allocate (loci%event(modes, rows, speeds), loci%partner(modes, rows, speeds))
    loci%locus = 0
    loci%mac = 1.0_wp
    loci%event = event_none
    loci%partner = 0
    order = ascending_order(positions%crank)
    work = new_speed_work(sweep%models%continuum, 1)
    first_row = 0
    do k = 1, speeds
      last = 0
      apart = .false.
      do i = 1, rows
        ! Beyond a dead point the linkage may take another form, so no locus continues there.
        if (last > 0 .and. allocated(positions%states(positions%state(order(i)))%error)) &
          apart = .true.
        if (.not. has_result(positions, sweep, positions%state(order(i)), k)) cycle
        if (apart) then
          call start_loci(loci, order(i), k)
        else if (last > 0) then
          call follow_step(structure, positions, [last, k], [order(i), k], work, sweep, loci)
        else if (first_row > 0 .and. k > 1) then
          call follow_step(structure, positions, [first_row, k - 1], [order(i), k], work, sweep, &
            loci)
        else
          call start_loci(loci, order(i), k)
        end if
        apart = .false.
        if (last == 0) first_row = order(i)
        last = order(i)
      end do
      if (last == 0) first_row = 0
      call mark_veerings(positions, sweep, order, k, loci)
    end do
  end subroutine follow_loci

  !> A new locus for every mode.
  pure subroutine start_loci(loci, row, speed)
    type(loci_t), intent(inout) :: loci
    integer, intent(in) :: row, speed

    integer :: i

    do i = 1, size(loci%locus, 1)
      loci%locus(i, row, speed) = loci%count + i
      loci%event(i, row, speed) = event_start
    end do
    loci%count = loci%count + size(loci%locus, 1)
  end subroutine start_loci

  !> One step: every mode of a row gets the locus of the mode that it continues, or begins a new
  !! one.
  subroutine follow_step(structure, positions, from, to, work, sweep, loci)
    type(structure_t), intent(in) :: structure
    type(positions_t), intent(in) :: positions
    integer, intent(in) :: from(2), to(2)     !! row and speed
    type(speed_work_t), intent(inout) :: work !! for what lies between them
    type(sweep_t), intent(inout) :: sweep
    type(loci_t), intent(inout) :: loci

    type(waypoint_t) :: first, second
    integer :: next(sweep%request%modes), i, j
    real(wp) :: mac(sweep%request%modes, sweep%request%modes)
    logical :: clear(sweep%request%modes)

    first = waypoint_on_row(positions, sweep, from)
    second = waypoint_on_row(positions, sweep, to)
    call match(structure, sweep, first, second, most_halvings, work, next, clear)
    mac = likeness(first%prints, second%prints)
    do j = 1, size(next)
      i = findloc(next, j, dim=1)
      if (i > 0) then
        loci%locus(j, to(1), to(2)) = loci%locus(i, from(1), from(2))
        loci%mac(j, to(1), to(2)) = mac(i, j)
      else
        loci%count = loci%count + 1
        loci%locus(j, to(1), to(2)) = loci%count
        ! A mode that nothing leads to has come down from above the computed ones, or may be the
        ! continuation of a doubtful one.
        loci%event(j, to(1), to(2)) = merge(event_start, event_ambiguous, all(clear))
        loci%mac(j, to(1), to(2)) = maxval(mac(:, j))
      end if
    end do
    call mark_crossings(loci, next, to)
  end subroutine follow_step

  !> The modes of a row.
  pure function waypoint_on_row(positions, sweep, at) result(waypoint)
    type(positions_t), intent(in) :: positions
    type(sweep_t), intent(in) :: sweep
    integer, intent(in) :: at(2) !! row and speed
    type(waypoint_t) :: waypoint

    waypoint%place = [positions%crank(at(1)), sweep%request%speed(at(2))]
    waypoint%prints = sweep%results(positions%state(at(1)))%prints(at(2))
  end function waypoint_on_row

  !> For every mode of one place the mode of another place that continues it; 0 if it leaves the
  !! modes computed, or is not clear.
  !!
  !! Where the shape of a mode is neither the same as that of another nor different from all, the
  !! step is cut in two. What is unclear after the last cut stays unclear.
  recursive subroutine match(structure, sweep, first, second, halvings, work, next, clear)
    type(structure_t), intent(in) :: structure
    type(sweep_t), intent(inout) :: sweep
    type(waypoint_t), intent(in) :: first, second
    integer, intent(in) :: halvings     !! that are left
    type(speed_work_t), intent(inout) :: work
    integer, intent(out) :: next(:)     !! (modes of `first`) number of a mode of `second`
    logical, intent(out) :: clear(:)    !! (modes of `first`) their shapes leave no doubt

    type(waypoint_t) :: middle
    real(wp) :: mac(size(next), size(next))
    integer :: to_middle(size(next)), from_middle(size(next)), i
    logical :: to_middle_clear(size(next)), from_middle_clear(size(next)), doubtful(size(next)), &
      found

    mac = likeness(first%prints, second%prints)
    next = maxloc(mac, dim=2)
    do i = 1, size(next)
      clear(i) = count(mac(i, :) >= same_shape) == 1 .and. count(mac(:, next(i)) >= same_shape) == 1
      if (.not. clear(i)) next(i) = 0
      clear(i) = clear(i) .or. all(mac(i, :) <= other_shape)
    end do
    if (all(clear) .or. halvings == 0) return
    middle%place = first%place + cut*(second%place - first%place)
    call prints_at(structure, sweep, middle%place, work, middle%prints, found)
    if (.not. found) return
    call match(structure, sweep, first, middle, halvings - 1, work, to_middle, to_middle_clear)
    ! If no doubtful mode reaches the middle, the second half decides nothing.
    if (any(to_middle > 0 .and. .not. clear)) then
      call match(structure, sweep, middle, second, halvings - 1, work, from_middle, &
        from_middle_clear)
    end if
    do i = 1, size(next)
      if (clear(i)) cycle
      clear(i) = to_middle_clear(i)
      if (to_middle(i) == 0) cycle
      clear(i) = from_middle_clear(to_middle(i))
      next(i) = from_middle(to_middle(i))
    end do
    ! Two modes that lead to the same one leave both in doubt.
    doubtful = [(next(i) > 0 .and. count(next == next(i)) > 1, i=1, size(next))]
    where (doubtful)
      next = 0
      clear = .false.
    end where
  end subroutine match

  !> Modes between two rows.
  subroutine prints_at(structure, sweep, place, work, prints, found)
    type(structure_t), intent(in) :: structure
    type(sweep_t), intent(inout) :: sweep
    real(wp), intent(in) :: place(2) !! crank angle and speed [deg, rad/s]
    type(speed_work_t), intent(inout) :: work
    type(mode_prints_t), intent(out) :: prints
    logical, intent(out) :: found

    type(state_t) :: state
    type(assembled_t) :: here
    type(error_t), allocatable :: error
    type(mode_request_t) :: request
    type(outcome_t) :: outcome(1)
    real(wp) :: factor(case_count, 1)

    found = .false.
    allocate (state%pose)
    call find_structure_pose(structure, place(1), state%pose, error)
    sweep%counts%kinematic_solutions = sweep%counts%kinematic_solutions + 1
    if (allocated(error)) return
    state%coefficients = find_kinematic_coefficients(structure%linkage, state%pose)
    request = sweep%request
    request%speed = place(2:2)
    factor = load_factors(request)
    ! Places between two rows come in no order, and may differ in speed alone: no track leads there.
    work%tracks(1)%length = 0
    associate (model => sweep%models%continuum, modes => work%found(1))
      here = new_assembled(structure, model)
      call assemble_position(structure, model, state, factor, work%equations, here, outcome, &
        sweep%counts)
      if (allocated(outcome(1)%error)) return
      call solve_speeds(place(1), factor, request%modes, [.false.], work, outcome, sweep%counts, &
        here%mixed)
      found = .not. allocated(outcome(1)%error)
      if (.not. found) return
      if (allocated(here%mixed)) then
        call find_mixed_prints(here%mixed, here%model%links, modes, request%modes, prints)
      else
        prints = prints_of(model, work%equations%chords, modes, request%modes)
      end if
    end associate
  end subroutine prints_at

  !> Two loci that have changed places since the row before have crossed.
  pure subroutine mark_crossings(loci, next, to)
    type(loci_t), intent(inout) :: loci
    integer, intent(in) :: next(:) !! (modes of the row before) mode that continues each; 0: none
    integer, intent(in) :: to(2)   !! row and speed

    integer :: i, j

    do i = 1, size(next)
      do j = i + 1, size(next)
        if (next(i) == 0 .or. next(j) == 0 .or. next(i) < next(j)) cycle
        loci%event(next([i, j]), to(1), to(2)) = event_crossing
        loci%partner(next(i), to(1), to(2)) = loci%locus(next(j), to(1), to(2))
        loci%partner(next(j), to(1), to(2)) = loci%locus(next(i), to(1), to(2))
      end do
    end do
  end subroutine mark_crossings

  !> Two neighbouring loci that come near, exchange their shapes and part again have veered:
  !! marked where they are nearest.
  pure subroutine mark_veerings(positions, sweep, order, speed, loci)
    type(positions_t), intent(in) :: positions
    type(sweep_t), intent(in) :: sweep
    integer, intent(in) :: order(:) !! rows by crank angle
    integer, intent(in) :: speed
    type(loci_t), intent(inout) :: loci

    real(wp) :: distance(size(order))
    integer :: i, mode, left, right

    do mode = 1, sweep%request%modes - 1
      do i = 1, size(order)
        distance(i) = huge(1.0_wp)
        if (.not. has_result(positions, sweep, positions%state(order(i)), speed)) cycle
        associate (lambda => sweep%results(positions%state(order(i)))%lambda(:, speed))
          distance(i) = frequency_of(lambda(mode + 1)) - frequency_of(lambda(mode))
        end associate
      end do
      do i = 2, size(order) - 1
        if (distance(i) > distance(i - 1) .or. distance(i) >= distance(i + 1)) cycle
        left = edge(distance, i, -1)
        right = edge(distance, i, 1)
        if (left == 0 .or. right == 0) cycle
        if (.not. have_exchanged(positions, sweep, loci, mode, speed, order(left), &
          order(right))) cycle
        loci%event(mode:mode + 1, order(i), speed) = event_veering
        loci%partner(mode, order(i), speed) = loci%locus(mode + 1, order(i), speed)
        loci%partner(mode + 1, order(i), speed) = loci%locus(mode, order(i), speed)
      end do
    end do
  end subroutine mark_veerings

  !> The row at which two frequencies have parted again, on one side of their least distance; 0 if
  !! they do not.
  pure function edge(distance, nearest, side)
    real(wp), intent(in) :: distance(:)
    integer, intent(in) :: nearest, side
    integer :: edge

    integer :: i

    edge = 0
    i = nearest
    do while (i + side >= 1 .and. i + side <= size(distance))
      if (distance(i + side) >= huge(1.0_wp) .or. distance(i + side) < distance(i)) return
      i = i + side
      if (distance(i) > veering_width*distance(nearest)) then
        edge = i
        return
      end if
    end do
  end function edge

  !> Whether a mode of one row looks like the next higher one of another, and the other way round,
  !! though their loci do not.
  pure function have_exchanged(positions, sweep, loci, mode, speed, from, to) result(have)
    type(positions_t), intent(in) :: positions
    type(sweep_t), intent(in) :: sweep
    type(loci_t), intent(in) :: loci
    integer, intent(in) :: mode, speed, from, to
    logical :: have

    real(wp) :: mac(sweep%request%modes, sweep%request%modes)

    have = all(loci%locus(mode:mode + 1, from, speed) == loci%locus(mode:mode + 1, to, &
      speed))
    if (.not. have) return
    mac = likeness(sweep%results(positions%state(from))%prints(speed), &
      sweep%results(positions%state(to))%prints(speed))
    have = mac(mode, mode + 1) > mac(mode, mode) .and. mac(mode + 1, mode) > mac(mode + 1, mode + 1)
  end function have_exchanged

end module frequency_loci
