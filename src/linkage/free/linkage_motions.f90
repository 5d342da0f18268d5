!> Forward dynamics of any linkage: its motion under a drive, gravity and all other loads,
!! on the curve or surface of all its positions.
!!
!! Near dead points every step has a chart of its own, made where it begins: a drive may come to its
!! limit and turn back while the linkage goes on, on its other branch. A linkage of one loop moves
!! along its curve, whose angles are integrated and projected back onto it after each step. The
!! energy is never corrected, so that its balance measures the accuracy of the motion.
module linkage_motions
  use adaptive_integration, only: advance, close_integrator, integrator_t, open_integrator, &
    reopen_integrator, step_by
  use bridges, only: place_on_path
  use constants, only: degree, two_pi
  use drives, only: drive_t, refuse_speed
  use errors, only: error_of_dead_point, error_t, set_error
  use gears, only: gear_t
  use group_determinants, only: determinant_of, determinants_of
  use drive_values, only: drive_rate, drive_value
  use interruption, only: was_interrupted
  use joint_friction, only: has_friction
  use kinds, only: long, wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkage_instants, only: linkage_instant_t
  use linkage_paths, only: has_change_points, period_of
  use linkage_rates, only: all_inertia_of, find_rates_of_coordinates, find_state, free_drives, &
    inertia_share, least_inertia_of, longest_step, moving_linkage_t, no_stop, place_by_drives, &
    rate_of_drive, stop_at_end, stop_change_point, stop_energy, stop_many_steps, stop_misfit, &
    stop_no_inertia, stop_steps
  use linkage_samples, only: find_details, linkage_details_t, linkage_sample_t, sample_state
  use linkages, only: gives_angle, linkage_t, reference_point
  use load_tables, only: next_row
  use loop_curves, only: change_point_message, choose_branch, curve_point_t, find_point, &
    find_start, new_loop_curve, place_from_crossing, project, reduce
  use loop_poses, only: has_loop
  use motion_charts, only: is_same_side, motion_chart_t, new_chart
  use pose_types, only: count_from, pose_t
  use poses, only: dead_point_sine, place_links
  use redundancies, only: refuse_misfit
  use rigid_bodies, only: rigid_body_t
  use whole_systems, only: drive_position, new_whole_system, rate_along
  implicit none (type, external)
  private

  public :: linkage_motion_t, linkage_sample_t, passage_t, start_linkage_motion, &
    move_linkage_until, sample_linkage_motion, linkage_details_t, find_linkage_details, &
    end_linkage_motion
  public :: motion_tolerance, refuse_change_point

  !> Bound on the estimated error of a step: some forty roundings. Where equations nearly depend on
  !! each other, rounding divided by the square of their independence.
  real(wp), parameter :: motion_tolerance = 1.0e-14_wp, rounding = 1.0e-16_wp

  !> With a determinant of a group below the first the coordinates are those of a chart; with all of
  !! them above the second those of the drives again.
  real(wp), parameter :: near_dead_point = 0.2_wp, far_from_dead_points = 0.3_wp

  !> Equations less independent than the first are those of a change point; below the second, next
  !! to one, rounding may be too much for any step.
  real(wp), parameter :: least_independence = dead_point_sine, near_change_point = 1.0e-2_wp

  !> If the inertia of a coordinate is below this share of all masses when steps shrink to nothing,
  !! this is the cause.
  real(wp), parameter :: little_inertia = 1.0e-10_wp

  !> Determinants below this, next to a dead point, may be of either sign by rounding.
  real(wp), parameter :: undecided_sine = 1.0e-12_wp

  !> Next to a change point steps shrink to what rounding allows. This many in turn, each shorter
  !! than this share of the time to the next instant, end the motion there.
  integer, parameter :: most_tiny_steps = 200
  real(wp), parameter :: tiny_step = 1.0e-5_wp, end_step = 1.0e-12_wp

  !> A motion whose energies do not balance to this share of the largest is wrong.
  real(wp), parameter :: lost_energy = 1.0e-6_wp

  !> A dead point of a group that the linkage has passed: it is on its other branch. Or a change
  !! point through which it has gone straight on.
  type :: passage_t
    real(wp) :: time = 0.0_wp     !! [s]
    real(wp) :: position = 0.0_wp !! of the first drive, with all whole turns [deg] or [m]
    integer :: group = 0          !! number in the linkage; 0: a change point
    logical :: to_left = .false.  !! the determinant of the group, or of the first, is then positive
  end type passage_t

  !> A motion in progress.
  type :: linkage_motion_t
    real(wp) :: time = 0.0_wp                     !! [s]
    real(wp) :: energy = 0.0_wp                   !! kinetic + potential, at the start [J]
    integer :: stop = no_stop                     !! why it does not continue
    type(error_t), allocatable :: left            !! the block that then leaves its link
    integer(long) :: most_steps = 1000000_long    !! from one instant to the next
    integer :: passage_count = 0                  !! so far
    type(passage_t), allocatable :: passages(:)   !! (at least passage_count)
    type(integrator_t) :: integrator              !! to be closed by `end_linkage_motion`
    type(moving_linkage_t), private :: system     !! equations of motion
    real(wp), allocatable, private :: state(:)    !! coordinates, rates, work
    real(wp), allocatable, private :: position(:) !! (free drives) with all whole turns [deg] or [m]
    logical, allocatable, private :: is_left(:)   !! (groups) the determinant is positive
    real(wp), private :: most_energy = 0.0_wp     !! of all kinds, at the samples so far [J]
    real(wp), private :: tolerance = motion_tolerance !! of the present steps
    real(wp), private :: work_scale = 1.0_wp      !! against which the work may be small [J]
  end type linkage_motion_t

contains

  !> Prepares a motion at its first instant. Free drives start where the deck's affine relation with
  !! the first one puts them, with the rates of this relation.
  !!
  !! Errors: the start is out of reach, a change point, or a dead point with a speed; a speed beyond
  !! the table of the motor; no memory.
  subroutine start_linkage_motion(linkage, rigid, is_free, drive, crank, speed, &
    duration, motion, error, gear, through, rates)
    type(linkage_t), intent(in) :: linkage           !! of any kind, with loads and a path if it
                                                     !! needs one
    type(rigid_body_t), intent(in) :: rigid(:)       !! (bodies) of the linkage
    logical, intent(in) :: is_free(:)                !! (drives) marked; the first always is
    class(drive_t), intent(in) :: drive              !! torque or force on the first drive
    real(wp), intent(in) :: crank                    !! of the first drive at the start [deg] or [m]
    real(wp), intent(in) :: speed                    !! of the first drive at the start [rad/s] or
                                                     !! [m/s]
    real(wp), intent(in) :: duration                 !! about how long it is to be followed [s]
    type(linkage_motion_t), intent(out) :: motion    !! at its first instant; to be ended by
                                                     !! `end_linkage_motion`
    type(error_t), allocatable, intent(out) :: error !! why it cannot begin
    type(gear_t), intent(in), optional :: gear       !! from the drive to the linkage; absent: none
    logical, intent(in), optional :: through         !! a loop goes straight through change points,
                                                     !! in place of a stop there; others go where
                                                     !! their path leads
    real(wp), intent(in), optional :: rates(:)       !! (drives) of further free ones at the start,
                                                     !! beside those of the relation [rad/s] or
                                                     !! [m/s]; absent: 0

    type(pose_t) :: pose
    type(linkage_sample_t) :: first
    real(wp), allocatable :: first_rates(:), determinants(:), scale(:)
    integer :: f, k

    associate (system => motion%system)
      system%free = free_drives(is_free)
      system%whole = new_whole_system(linkage, system%free)
      system%rigid = rigid
      allocate (system%drive, source=drive)
      if (present(gear)) system%gear = gear
      system%has_loads = size(linkage%loads) > 0 .or. has_friction(linkage) .or. &
        any(abs(linkage%couple) > 0.0_wp)
      call refuse_speed(system%drive, system%gear%ratio*speed, error)
      if (allocated(error)) return
      f = size(system%free)
      call place_links(linkage, crank, pose, error)
      if (allocated(error)) return
      first_rates = [(speed*drive_rate(linkage, system%free(k)), k=1, f)]
      if (present(rates)) first_rates = first_rates + rates(system%free)
      if (has_loop(linkage)) call take_loop(motion, crank, speed, through, error)
      if (allocated(error)) return
      if (any(abs(pose%sine) < dead_point_sine) .and. .not. allocated(pose%coefficients) .and. &
        any(abs(first_rates) > 0.0_wp)) then
        call set_error(error, error_of_dead_point, "dead point: at a limit position the "// &
          trim(merge("crank      ", "first drive", allocated(system%loop)))// &
          " turns back and can have no speed; expected speed=0")
        return
      end if
      call count_from(reference_point(linkage), pose)
      system%period = period_of(linkage)
      system%pose = pose
      if (.not. allocated(system%loop)) then
        system%chart = new_chart(system%whole, pose, crank, f)
        system%by_drives = .not. is_near_dead_point(linkage, pose, f)
        if (system%chart%independence < least_independence .and. .not. system%by_drives) then
          call refuse_change_point(.false., error)
          return
        end if
      end if
      determinants = determinants_of(linkage, pose)
      ! At a dead point itself the branch is that of the deck: closed forms are on it.
      motion%is_left = merge(determinants > 0.0_wp, linkage%groups%side > 0.0_wp, &
        abs(determinants) > merge(dead_point_sine, undecided_sine, allocated(system%loop)))
      motion%position = [(drive_value(linkage, system%free(k), crank), k=1, f)]
      allocate (motion%passages(0))
      if (.not. allocated(system%loop)) then
        allocate (motion%state(2*f + 1))
        motion%state = 0.0_wp
        if (system%by_drives) then
          call take_drives(motion, first_rates)
        else if (any(abs(first_rates) > 0.0_wp)) then
          call find_rates_of_coordinates(system, first_rates, motion%state)
        end if
      end if
      call sample_linkage_motion(motion, first)
      motion%energy = first%kinetic + first%potential
      motion%stop = no_stop
      ! Work that is small against the energy of one radian in the whole duration does not matter.
      if (allocated(system%loop)) then
        scale = [1.0_wp, 1.0_wp, 1.0_wp, 1.0_wp/duration, first%kinetic + least_inertia_of(system, &
          motion%state)/duration**2]
        motion%most_energy = scale(5)
      else
        motion%work_scale = first%kinetic + all_inertia_of(system)*(span_of(linkage)/duration)**2
        motion%tolerance = tolerance_of(motion)
        scale = scale_of(motion, 0.01_wp*duration)
      end if
      call open_integrator(motion%integrator, scale, motion%tolerance, 0.01_wp*duration, &
        error)
    end associate
  end subroutine start_linkage_motion

  !> The state of a linkage of one loop. Errors: it is at a change point; those of `find_start`.
  pure subroutine take_loop(motion, crank, speed, through, error)
    type(linkage_motion_t), intent(inout) :: motion
    real(wp), intent(in) :: crank !! [deg]
    real(wp), intent(in) :: speed !! of the crank [rad/s]
    logical, intent(in), optional :: through
    type(error_t), allocatable, intent(inout) :: error

    type(curve_point_t) :: point
    logical :: is_smooth

    associate (system => motion%system)
      allocate (system%loop)
      system%loop = new_loop_curve(system%whole%linkage, through)
      system%by_drives = .false.
      system%all_inertia = all_inertia_of(system)
      allocate (motion%state(5))
      motion%state = 0.0_wp
      call find_start(system%whole%linkage, crank, motion%state(1:3), error)
      if (allocated(error)) return
      system%turns(1) = anint((crank*degree - motion%state(1))/two_pi)
      call find_point(system%loop, motion%state(1:3), point, is_smooth)
      if (abs(speed) > 0.0_wp .and. abs(point%tangent(1)) > 0.0_wp) motion%state(4) = speed/ &
        point%tangent(1)
      call choose_branch(system%loop, motion%state(1:3))
    end associate
  end subroutine take_loop

  !> The error of a motion that comes to a change point.
  pure subroutine refuse_change_point(in_loop, error)
    logical, intent(in) :: in_loop !! of a linkage of one loop: all its links are in line
    type(error_t), allocatable, intent(inout) :: error !! allocated on return

    if (in_loop) then
      call set_error(error, error_of_dead_point, change_point_message)
    else
      call set_error(error, error_of_dead_point, &
        "change point: links lie in one line, and the linkage may go on either way")
    end if
  end subroutine refuse_change_point

  !> Values of the state against which it may change little: of coordinates the linkage, or a
  !! radian, of rates the largest present one, or a hundredth of the linkage in a step.
  pure function scale_of(motion, step) result(scale)
    type(linkage_motion_t), intent(in) :: motion
    real(wp), intent(in) :: step !! of the integration [s]
    real(wp) :: scale(size(motion%state))

    real(wp) :: span
    integer :: f

    associate (system => motion%system)
      f = size(system%free)
      span = span_of(system%whole%linkage)
      if (system%by_drives .and. gives_angle(system%whole%linkage%drives(1))) &
        span = 1.0_wp
      scale(:f) = span
      scale(f + 1:2*f) = max(maxval(abs(motion%state(f + 1:2*f))), span*0.01_wp/step)
      scale(2*f + 1) = motion%work_scale
    end associate
  end function scale_of

  !> The error that steps may have from the present position on.
  pure function tolerance_of(motion) result(tolerance)
    type(linkage_motion_t), intent(in) :: motion
    real(wp) :: tolerance

    tolerance = motion_tolerance
    if (.not. motion%system%by_drives) tolerance = max(tolerance, &
      rounding/max(motion%system%chart%independence, least_independence)**2)
  end function tolerance_of

  !> The state in the coordinates of the drives, at their positions.
  subroutine take_drives(motion, rates)
    type(linkage_motion_t), intent(inout) :: motion
    real(wp), intent(in) :: rates(:) !! (free drives) [rad/s] or [m/s]

    integer :: f, k

    f = size(rates)
    associate (system => motion%system)
      do k = 1, f
        motion%state(k) = motion%position(k)
        if (.not. gives_angle(system%whole%linkage%drives(system%free(k)))) cycle
        ! Whole turns are taken away in degrees, where nothing is rounded.
        if (k == 1) system%turned = 360.0_wp*anint(motion%position(k)/360.0_wp)
        if (k == 1) motion%state(k) = motion%position(k) - system%turned
        motion%state(k) = degree*motion%state(k)
      end do
      motion%state(f + 1:2*f) = rates
      system%by_drives = .true.
    end associate
  end subroutine take_drives

  !> Size of a linkage, and of its coordinates [m].
  pure function span_of(linkage) result(span)
    type(linkage_t), intent(in) :: linkage
    real(wp) :: span

    span = maxval(linkage%bodies%length)
  end function span_of

  !> Frees the integrator of a motion.
  subroutine end_linkage_motion(motion)
    type(linkage_motion_t), intent(inout) :: motion !! no longer to be continued

    call close_integrator(motion%integrator)
  end subroutine end_linkage_motion

  !> Follows the motion up to an instant, which is met exactly unless the motion stops or the run is
  !! interrupted; `motion%stop` gives the reason of a stop.
  subroutine move_linkage_until(motion, time)
    type(linkage_motion_t), intent(inout) :: motion !! begun
    real(wp), intent(in) :: time                    !! to be reached [s]

    type(error_t), allocatable :: error
    real(wp) :: before(size(motion%state)), time_before, limit, share, span
    integer(long) :: last_step
    integer :: tiny_steps

    tiny_steps = 0
    span = time - motion%time
    last_step = motion%integrator%steps + motion%most_steps
    do while (motion%time < time .and. motion%stop == no_stop)
      if (was_interrupted()) return
      if (motion%integrator%steps >= last_step) then
        motion%stop = stop_many_steps
        return
      end if
      motion%system%stop = no_stop
      before = motion%state
      time_before = motion%time
      limit = min(next_row(motion%system%whole%linkage, motion%time, time), motion%time + &
        longest_step(motion%system, motion%state))
      call advance(motion%integrator, motion%system, motion%time, limit, motion%state, error)
      if (allocated(error)) then
        motion%stop = merge(motion%system%stop, stop_steps, motion%system%stop /= no_stop)
        if (motion%stop == stop_at_end) motion%left = motion%system%left
        if (motion%stop /= stop_steps) return
        call inertia_share(motion%system, motion%state, share)
        if (share < little_inertia) then
          motion%stop = stop_no_inertia
        else if (is_near_change_point(motion)) then
          motion%stop = stop_change_point
        end if
        return
      end if
      if (allocated(motion%system%loop)) then
        call go_on_in_loop(motion, time_before, before)
      else if (motion%system%by_drives) then
        call go_on_by_drives(motion)
      else
        call go_on_from_chart(motion, time_before, before)
      end if
      ! A block comes to the end of its link by steps of which each is a half of the last.
      if (motion%system%stop == stop_at_end .and. motion%time - time_before < end_step*span) then
        motion%stop = stop_at_end
        motion%left = motion%system%left
      end if
      tiny_steps = tiny_steps + 1
      if (motion%time - time_before >= tiny_step*span .or. .not. is_near_change_point(motion)) &
        tiny_steps = 0
      if (tiny_steps > most_tiny_steps .and. motion%stop == no_stop) motion%stop = stop_change_point
    end do
  end subroutine move_linkage_until

  !> Whether the equations of the present chart depend on each other, nearly.
  pure function is_near_change_point(motion) result(is)
    type(linkage_motion_t), intent(in) :: motion
    logical :: is

    is = .not. (motion%system%by_drives .or. allocated(motion%system%loop)) .and. &
      motion%system%chart%independence < near_change_point
  end function is_near_change_point

  !> Whether a drive may come to its limit soon: the determinant of a group is small, and on a path
  !! the limit is nearer than the change points, which the drive passes.
  pure function is_near_dead_point(linkage, pose, free) result(is)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    integer, intent(in) :: free !! number of free drives
    logical :: is

    real(wp) :: at, to_limit
    integer :: last

    is = any(abs(pose%sine) <= near_dead_point)
    if (.not. is .or. free > 1 .or. .not. has_change_points(linkage)) return
    associate (path => linkage%path)
      last = size(path%crank)
      at = place_on_path(path, pose%crank)
      to_limit = min(at - path%crank(1), path%crank(last) - at)
      ! Whole periods have no ends.
      is = path%crank(last) - path%crank(1) < path%period .or. path%period <= 0.0_wp
      if (is) is = to_limit < minval([abs(at - path%bridges%from), abs(at - path%bridges%to)]) &
        .and. .not. allocated(pose%coefficients)
    end associate
  end function is_near_dead_point

  !> After a step in the coordinates of the drives: near a dead point the next one is on a chart.
  subroutine go_on_by_drives(motion)
    type(linkage_motion_t), intent(inout) :: motion

    type(pose_t) :: pose
    type(linkage_instant_t) :: at
    type(error_t), allocatable :: error
    logical :: near, found

    associate (system => motion%system)
      call place_by_drives(system, motion%state(:size(system%free)), pose, error)
      near = .false.
      if (.not. allocated(error)) then
        system%pose = pose
        near = is_near_dead_point(system%whole%linkage, pose, size(system%free))
      end if
      if (near) call find_state(system, motion%state, at, found)
      call read_drives(motion)
      if (.not. near) return
      system%chart = new_chart(system%whole, at%pose, motion%position(1), size(system%free))
      system%by_drives = .false.
    end associate
    call set_rates(motion, at%motion)
    call reopen_steps(motion)
  end subroutine go_on_by_drives

  !> After a step on a chart: dead points that were passed, and the coordinates of the next one. A
  !! step past a change point is taken back.
  subroutine go_on_from_chart(motion, time, before)
    type(linkage_motion_t), intent(inout) :: motion
    real(wp), intent(in) :: time      !! at the beginning of the step [s]
    real(wp), intent(in) :: before(:) !! state at that time

    type(linkage_instant_t) :: at
    type(motion_chart_t) :: chart
    real(wp) :: determinants(size(motion%is_left)), rates(size(motion%position))
    logical :: found
    integer :: k

    associate (system => motion%system, pose => at%pose, now => at%motion)
      call find_state(system, motion%state, at, found)
      chart = new_chart(system%whole, pose, drive_position(system%whole, pose, 1, &
        motion%position(1)), size(system%free))
      if (.not. is_same_side(system%whole, system%chart, chart) .or. chart%independence < &
        least_independence) then
        motion%stop = stop_change_point
        motion%time = time
        motion%state = before
        return
      end if
      determinants = determinants_of(system%whole%linkage, pose)
      call note_passages(motion, determinants, time, before)
      do k = 1, size(rates)
        motion%position(k) = drive_position(system%whole, pose, system%free(k), motion%position(k))
        rates(k) = rate_of_drive(system, pose, now, system%free(k))
      end do
      chart%pose%sine = determinants
      call take_next_chart(motion, chart, now)
      if (all(abs(determinants) > far_from_dead_points) .and. has_way_back(motion)) then
        system%pose = pose
        system%pose%sine = determinants
        call take_drives(motion, rates)
        call reopen_steps(motion)
      end if
    end associate
  end subroutine go_on_from_chart

  !> After a step in a loop: the angles are moved onto its curve, what was passed is recorded, and
  !! whole turns are taken away.
  subroutine go_on_in_loop(motion, time, before)
    type(linkage_motion_t), intent(inout) :: motion
    real(wp), intent(in) :: time      !! at the beginning of the step [s]
    real(wp), intent(in) :: before(:) !! state at that time

    real(wp) :: sine, from, to, slope(3)
    logical :: crosses, changes

    associate (loop => motion%system%loop, angle => motion%state(1:3))
      call project(loop, angle)
      sine = sin(angle(3) - angle(2))
      changes = abs(sine) > undecided_sine .and. (sine > 0.0_wp .neqv. motion%is_left(1))
      if (changes) motion%is_left(1) = .not. motion%is_left(1)
      crosses = loop%near > 0
      if (crosses) then
        call place_from_crossing(loop, before(1:3), from, slope)
        call place_from_crossing(loop, angle, to, slope)
        crosses = from*to < 0.0_wp .or. (abs(to) <= 0.0_wp .and. abs(from) > 0.0_wp)
      end if
      if (crosses) then
        call note_passage(motion, 0, time, before)
      else if (changes) then
        call note_passage(motion, 1, time, before)
      end if
      call reduce(angle, motion%system%turns)
      call choose_branch(loop, angle)
      motion%position(1) = angle(1)/degree + 360.0_wp*motion%system%turns(1)
    end associate
  end subroutine go_on_in_loop

  !> Whether drives may be the coordinates again: a path is that of the branch of the start only.
  pure function has_way_back(motion) result(has)
    type(linkage_motion_t), intent(in) :: motion
    logical :: has

    has = motion%passage_count == 0 .or. .not. allocated(motion%system%whole%linkage%path%crank)
  end function has_way_back

  !> Positions of the drives from the state, whose first coordinate is kept within half a turn.
  subroutine read_drives(motion)
    type(linkage_motion_t), intent(inout) :: motion

    real(wp) :: turns
    integer :: k

    associate (system => motion%system)
      do k = 1, size(motion%position)
        motion%position(k) = motion%state(k)
        if (.not. gives_angle(system%whole%linkage%drives(system%free(k)))) cycle
        motion%position(k) = motion%state(k)/degree
        if (k > 1) cycle
        motion%position(1) = motion%position(1) + system%turned
        turns = anint(motion%state(1)/two_pi)
        motion%state(1) = motion%state(1) - turns*two_pi
        system%turned = system%turned + 360.0_wp*turns
      end do
    end associate
  end subroutine read_drives

  !> Other coordinates have another size: the error of steps is measured anew.
  subroutine reopen_steps(motion)
    type(linkage_motion_t), intent(inout) :: motion

    type(error_t), allocatable :: error

    motion%tolerance = tolerance_of(motion)
    call reopen_integrator(motion%integrator, scale_of(motion, motion%integrator%step), &
      motion%tolerance, error)
    if (allocated(error)) motion%stop = stop_steps
  end subroutine reopen_steps

  !> The state on the chart of the next step. The motion stops where links that are redundant do not
  !! fit.
  subroutine take_next_chart(motion, chart, now)
    type(linkage_motion_t), intent(inout) :: motion
    type(motion_chart_t), intent(in) :: chart         !! at the present pose
    type(kinematic_coefficients_t), intent(in) :: now !! velocities

    type(error_t), allocatable :: error

    associate (system => motion%system)
      system%chart = chart
      call refuse_misfit(system%whole%linkage, chart%pose, chart%crank, error)
      if (allocated(error)) motion%stop = stop_misfit
      call set_rates(motion, now)
      if (tolerance_of(motion) > 2.0_wp*motion%tolerance .or. tolerance_of(motion) < &
        0.5_wp*motion%tolerance) call reopen_steps(motion)
    end associate
  end subroutine take_next_chart

  !> The state where a chart is made: its coordinates are 0, their rates those of given velocities.
  subroutine set_rates(motion, now)
    type(linkage_motion_t), intent(inout) :: motion
    type(kinematic_coefficients_t), intent(in) :: now

    integer :: f, k

    associate (system => motion%system)
      ! The same numbers are another state.
      system%is_seen = .false.
      f = size(system%free)
      motion%state(:f) = 0.0_wp
      motion%state(f + 1:2*f) = [(rate_along(system%whole, system%chart%direction(:, k), &
        now%turn, now%pin), k=1, f)]
    end associate
  end subroutine set_rates

  !> Records the dead points that were passed in the last step. Groups in closed form are then on
  !! their other side; iterations have no path there.
  subroutine note_passages(motion, determinants, time, before)
    type(linkage_motion_t), intent(inout) :: motion
    real(wp), intent(in) :: determinants(:) !! (groups) after the step
    real(wp), intent(in) :: time      !! at the beginning of the step [s]
    real(wp), intent(in) :: before(:) !! state at that time

    integer :: i

    do i = 1, size(determinants)
      if (abs(determinants(i)) <= undecided_sine) cycle
      if (determinants(i) > 0.0_wp .eqv. motion%is_left(i)) cycle
      motion%is_left(i) = .not. motion%is_left(i)
      call note_passage(motion, i, time, before)
      associate (side => motion%system%whole%linkage%groups(i)%side)
        side = -side
      end associate
    end do
  end subroutine note_passages

  !> Records the instant in the last step at which the determinant of a group, or the place along
  !! the branch through a change point, passed through zero: by secants, or halving where they leave
  !! the interval; each trial is a single step from the beginning of the last one. If the sign at
  !! that beginning is mere rounding, the instant is the beginning itself.
  subroutine note_passage(motion, group, time, before)
    type(linkage_motion_t), intent(inout) :: motion
    integer, intent(in) :: group      !! 0: a change point
    real(wp), intent(in) :: time      !! at the beginning of the step [s]
    real(wp), intent(in) :: before(:) !! state at that time

    integer, parameter :: most_trials = 100
    real(wp) :: low, high, at, next, last, value, last_value, first
    type(passage_t) :: passage
    logical :: found
    integer :: i

    passage%group = group
    passage%to_left = motion%is_left(max(1, group))
    low = 0.0_wp
    high = motion%time - time
    call try(high, last_value)
    last = high
    call try(low, first)
    at = low
    value = first
    do i = 1, merge(most_trials, 0, found .and. first*last_value < 0.0_wp)
      next = 0.5_wp*(low + high)
      if (abs(value - last_value) > 0.0_wp) next = at - value*((at - last)/(value - last_value))
      if (abs(next - at) <= 2.0_wp*epsilon(1.0_wp)*(time + at)) exit
      if (.not. (next > low .and. next < high)) next = 0.5_wp*(low + high)
      if (next <= low .or. next >= high) exit
      last = at
      last_value = value
      at = next
      call try(at, value)
      if (.not. found) exit
      if (value*first > 0.0_wp) then
        low = at
      else
        high = at
      end if
      if (.not. abs(value) > 0.0_wp) exit
    end do
    call append_passage(motion, passage)

  contains

    !> What passes through zero, so long after the beginning.
    subroutine try(step, value)
      real(wp), intent(in) :: step
      real(wp), intent(out) :: value

      type(error_t), allocatable :: error
      type(linkage_instant_t) :: at
      real(wp) :: state(size(before)), slope(3)

      value = 0.0_wp
      found = .false.
      associate (system => motion%system)
        state = before
        if (step > 0.0_wp) call step_by(motion%integrator, system, time, step, state, error)
        if (allocated(error)) return
        call find_state(system, state, at, found)
        if (.not. found) return
        passage%time = time + step
        if (allocated(system%loop)) then
          passage%position = state(1)/degree + 360.0_wp*system%turns(1)
        else
          passage%position = drive_position(system%whole, at%pose, 1, motion%position(1))
        end if
        if (group > 0) then
          value = determinant_of(system%whole%linkage, at%pose, group)
        else
          call place_from_crossing(system%loop, state(1:3), value, slope)
        end if
      end associate
    end subroutine try

  end subroutine note_passage

  pure subroutine append_passage(motion, passage)
    type(linkage_motion_t), intent(inout) :: motion
    type(passage_t), intent(in) :: passage

    type(passage_t), allocatable :: larger(:)

    if (motion%passage_count == size(motion%passages)) then
      allocate (larger(2*motion%passage_count + 8))
      larger(:motion%passage_count) = motion%passages(:motion%passage_count)
      call move_alloc(larger, motion%passages)
    end if
    motion%passage_count = motion%passage_count + 1
    motion%passages(motion%passage_count) = passage
  end subroutine append_passage

  !> Positions, rates, torque and energies at the present instant. The motion stops where the
  !! balance of energies shows that it has lost its digits.
  subroutine sample_linkage_motion(motion, sample)
    type(linkage_motion_t), intent(inout) :: motion !! begun
    type(linkage_sample_t), intent(out) :: sample   !! of this instant

    logical :: found

    call sample_state(motion%system, motion%time, motion%state, motion%position, sample, found)
    if (.not. found) then
      if (motion%stop == no_stop) motion%stop = stop_change_point
      return
    end if
    if (allocated(sample%loop)) sample%loop%is_left = motion%is_left(1)
    sample%energy_error = sample%kinetic + sample%potential - sample%work - motion%energy
    motion%most_energy = max(motion%most_energy, sample%kinetic + abs(sample%potential) + &
      abs(sample%work))
    if (abs(sample%energy_error) > lost_energy*motion%most_energy .and. motion%stop == no_stop) &
      motion%stop = stop_energy
  end subroutine sample_linkage_motion

  !> Accelerations, powers and forces in the joints at the present instant. Not found where there
  !! are no rates of the motion.
  subroutine find_linkage_details(motion, with_forces, details, found)
    type(linkage_motion_t), intent(in) :: motion    !! begun
    logical, intent(in) :: with_forces              !! those in the joints, too
    type(linkage_details_t), intent(out) :: details !! of this instant
    logical, intent(out) :: found

    call find_details(motion%system, motion%time, motion%state, with_forces, details, found)
  end subroutine find_linkage_details

end module linkage_motions
