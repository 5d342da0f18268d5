!> Ratings of motors, bearings and the flywheel of a linkage over its whole cycle.
module sizing_study
  use actuated_forces, only: actuator_sense
  use applied_load_types, only: over_time
  use constants, only: degree
  use cycle_forces, only: cycle_forces_t, is_timed, of_forces, of_powers, of_rates, sizing_request_t
  use elastic_reactions, only: elastic_division_t
  use errors, only: error_of_input, error_of_numerics, error_t, set_error
  use flywheels, only: size_flywheel
  use gears, only: gear_t
  use drive_values, only: drive_value
  use interruption, only: was_interrupted
  use joint_rates, only: joint_rate
  use joint_study, only: joint_t, joints_result_t
  use kinds, only: wp
  use lagrange_study, only: find_lagrange_terms, lagrange_result_t
  use linkages, only: is_actuated, linkage_t
  use motion_programs, only: motion_program_t, program_breaks, program_period
  use linkage_paths, only: period_of
  use load_tables, only: load_period
  use positions, only: positions_t
  use sizing_values, only: between_angles, largest_change, settled, sized_t, sizing_t
  use sorting, only: ascending_order
  implicit none (type, external)
  private

  public :: sizing_request_t, gear_t, sized_t, sizing_t, sizing_result_t, find_sizing

  !> Samples of a cycle, per turn; and the most in all.
  integer, parameter :: fewest_samples = 128, most_samples = 8192

  !> Of pieces in time, means settle slower: samples are doubled until no result changes by more
  !! than this share of its peak. Instants nearer to each other than a share of the time are one.
  real(wp), parameter :: settled_by_pieces = 1.0e-9_wp, one_instant = 1.0e-12_wp

  !> A force below this share of the largest of its kind, and a mean below this share of the peak,
  !! is round-off and written as 0.
  real(wp), parameter :: round_off_share = 1.0e-12_wp

  !> A joint whose rate is below this share of that of the linkage is at rest: it is round-off.
  real(wp), parameter :: rest = 1.0e-12_wp

  !> Where the peak of a force is flat nothing tells it from positions so near [deg], of laws in
  !! 360th parts of the cycle.
  real(wp), parameter :: flatness = 1.0e-4_wp

  !> The places of a cycle at which there are samples.
  type :: cycle_t
    real(wp), allocatable :: at(:)    !! (samples) [deg], of laws [s]
    real(wp), allocatable :: width(:) !! (samples) of the interval behind it, the last behind which
                                      !! the cycle begins again; any unit
    real(wp), allocatable :: weight(:) !! (samples) with which means are summed; any unit
    real(wp) :: from = 0.0_wp         !! where it begins
    real(wp) :: period = 0.0_wp       !! its length
    real(wp) :: unit = 1.0_wp         !! in which peaks are enclosed: 1 deg, or a 360th part of a
                                      !! cycle in time
    logical :: repeats = .true.       !! else it is what the instants of the deck span
  end type cycle_t

  type :: sizing_result_t
    type(error_t), allocatable :: error       !! why there is nothing
    real(wp) :: error_crank = 0.0_wp          !! where [deg], of laws [s]
    integer :: samples = 0                    !! of the cycle
    real(wp) :: period = 0.0_wp               !! of the cycle [deg], of laws [s]
    logical :: repeats = .true.               !! it is one of a periodic motion, not of instants
    type(joint_t), allocatable :: joints(:)   !! as in `joint_study`
    logical, allocatable :: is_open(:)        !! (joints) the same, anywhere over the cycle
    type(sizing_t), allocatable :: at_speed(:)
  end type sizing_result_t

contains

  !> Peaks and means over the cycle for every speed, and flywheels.
  !!
  !! Peaks between samples are enclosed by golden-section search around the three highest samples.
  !! Errors are estimated by those with half as many samples. Of laws the cycle is a period that
  !! they have, or what the instants span: then samples divide the pieces between instants, jumps
  !! of laws and rows of tables over the time. Errors:
  !! the first drive does not turn fully, positions and loads do not repeat, or those of a position.
  subroutine find_sizing(linkage, elements, request, threads, found, division)
    type(linkage_t), intent(in) :: linkage       !! of any kind, with masses
    integer, intent(in) :: elements(:)           !! (bodies) on whose nodes the masses are lumped;
                                                 !! 0: distributed
    type(sizing_request_t), intent(in) :: request
    integer, intent(in) :: threads               !! number of OpenMP threads
    type(sizing_result_t), intent(out) :: found
    type(elastic_division_t), intent(in), optional :: division !! of this linkage, if its elasticity
                                                 !! divides forces

    type(cycle_forces_t) :: forces
    type(cycle_t) :: span
    type(sizing_t), allocatable :: last(:)
    type(positions_t) :: positions
    type(joints_result_t) :: joints
    real(wp), allocatable :: nodes(:)
    real(wp) :: change
    integer :: level

    forces%linkage = linkage
    forces%elements = elements
    forces%request = request
    if (present(division)) forces%division = division
    call choose_cycle(forces, span, found)
    if (allocated(found%error)) return
    level = 0
    if (.not. span%repeats) call find_nodes(forces, span, nodes)
    do
      if (span%repeats) then
        call take_samples(found%samples, span)
      else
        call divide_pieces(nodes, level, span)
        found%samples = size(span%at)
        level = level + 1
        if (found%samples < fewest_samples) cycle
      end if
      call size_cycle(forces, span, threads, found, positions, joints)
      if (allocated(found%error)) return
      if (request%fluctuation > 0.0_wp) call find_flywheels(forces, span, positions, threads, found)
      change = huge(change)
      if (allocated(last)) change = largest_change(found%at_speed, last)
      if (change <= merge(settled, settled_by_pieces, span%repeats) .or. was_interrupted()) exit
      if (2*found%samples > most_samples .and. (span%repeats .or. allocated(last))) exit
      call move_alloc(found%at_speed, last)
      if (span%repeats) found%samples = 2*found%samples
    end do
  end subroutine find_sizing

  !> What the cycle is: that of the first drive, the common period of all laws, or the instants.
  subroutine choose_cycle(forces, span, found)
    type(cycle_forces_t), intent(in) :: forces
    type(cycle_t), intent(out) :: span
    type(sizing_result_t), intent(inout) :: found

    associate (linkage => forces%linkage, request => forces%request)
      if (.not. is_timed(request)) then
        span%period = load_period(linkage, period_of(linkage))
        if (span%period <= 0.0_wp) call set_error(found%error, error_of_input, &
          "positions and loads do not repeat with the first drive: there is no cycle")
        found%samples = fewest_samples*max(1, nint(span%period/360.0_wp))
      else
        call find_period_of_laws(forces, span)
        if (span%repeats) span%repeats = returns(forces, span)
        if (.not. span%repeats) then
          span%from = minval(request%times)
          span%period = maxval(request%times) - span%from
        end if
        span%unit = span%period/360.0_wp
        found%samples = fewest_samples
        if (.not. span%repeats .and. size(request%times) < 2) call set_error(found%error, &
          error_of_input, "one instant is no cycle")
      end if
    end associate
    found%period = span%period
    found%repeats = span%repeats
  end subroutine choose_cycle

  !> The period that all laws have, tables with periodic ends and formulas with one.
  pure subroutine find_period_of_laws(forces, span)
    type(cycle_forces_t), intent(in) :: forces
    type(cycle_t), intent(inout) :: span

    integer :: d

    if (allocated(forces%request%program)) then
      call take_period(forces%request%program, span)
      return
    end if
    do d = 1, size(forces%linkage%drives)
      if (forces%linkage%drives(d)%has_law) call take_period(forces%linkage%drives(d)%law, span)
    end do
  end subroutine find_period_of_laws

  !> The period of a law, if it has one that is that of laws before it.
  pure subroutine take_period(program, span)
    type(motion_program_t), intent(in) :: program
    type(cycle_t), intent(inout) :: span

    real(wp), parameter :: rounding = 1.0e-12_wp
    real(wp) :: range(2), period

    range = program_period(program)
    period = range(2) - range(1)
    if (period <= 0.0_wp) then
      span%repeats = .false.
    else if (span%period > 0.0_wp) then
      span%repeats = span%repeats .and. abs(period - span%period) <= rounding*period
    else
      span%from = range(1)
      span%period = period
    end if
  end subroutine take_period

  !> Whether all pins and bodies are after a period where they were, and loads over the turns of the
  !! first drive what they were.
  function returns(forces, span)
    type(cycle_forces_t), intent(in) :: forces
    type(cycle_t), intent(in) :: span
    logical :: returns

    real(wp), parameter :: near = 1.0e-9_wp
    type(positions_t) :: ends
    real(wp) :: way

    ends = forces%positions_at(span%from + [0.0_wp, span%period])
    returns = .not. (allocated(ends%states(1)%error) .or. allocated(ends%states(2)%error))
    if (.not. returns) return
    associate (first => ends%states(1)%pose, last => ends%states(2)%pose)
      returns = maxval(abs(last%pin - first%pin)) <= near*maxval(forces%linkage%bodies%length) &
        .and. maxval(abs(last%direction - first%direction)) <= near
      way = abs(drive_value(forces%linkage, 1, last%crank) - drive_value(forces%linkage, 1, &
        first%crank))
    end associate
    if (way > near) returns = returns .and. abs(load_period(forces%linkage, way) - way) <= near*way
  end function returns

  !> Evenly spaced samples of a cycle that repeats.
  pure subroutine take_samples(number, span)
    integer, intent(in) :: number
    type(cycle_t), intent(inout) :: span

    integer :: i

    span%at = [(span%from + span%period*(i - 1)/number, i=1, number)]
    span%width = [(1.0_wp, i=1, number)]
    span%weight = span%width
  end subroutine take_samples

  !> Between which all is smooth, but for what joints and friction do: the instants, rows of tables
  !! over the time, and jumps of laws, these twice: before and behind the jump.
  subroutine find_nodes(forces, span, nodes)
    type(cycle_forces_t), intent(in) :: forces
    type(cycle_t), intent(in) :: span
    real(wp), allocatable, intent(out) :: nodes(:) !! rising [s]

    real(wp), allocatable :: jumps(:), all(:)
    real(wp) :: aside
    integer :: i

    jumps = [real(wp) ::]
    if (allocated(forces%request%program)) call append_jumps(forces%request%program)
    associate (linkage => forces%linkage)
      do i = 1, size(linkage%drives)
        if (.not. allocated(forces%request%program) .and. linkage%drives(i)%has_law) call &
          append_jumps(linkage%drives(i)%law)
      end do
      ! A few roundings: what is smooth on either side does not notice them.
      aside = 16.0_wp*spacing(maxval(abs(span%from + [0.0_wp, span%period])))
      all = [forces%request%times, jumps - aside, jumps + aside]
      if (allocated(linkage%loads)) then
        do i = 1, size(linkage%loads)
          if (linkage%loads(i)%over == over_time) all = [all, linkage%loads(i)%table%x]
        end do
      end if
    end associate
    all = pack(all, all >= span%from .and. all <= span%from + span%period)
    nodes = all(ascending_order(all))

  contains

    !> With those at the end of the span.
    subroutine append_jumps(program)
      type(motion_program_t), intent(in) :: program

      jumps = [jumps, program_breaks(program, span%from, span%from + (1.0_wp + &
        4.0_wp*one_instant)*span%period)]
    end subroutine append_jumps

  end subroutine find_nodes

  !> Samples of pieces: each is halved so many times, and its mean is by Simpson's rule.
  pure subroutine divide_pieces(nodes, level, span)
    real(wp), intent(in) :: nodes(:) !! rising [s]
    integer, intent(in) :: level     !! 0: its ends alone
    type(cycle_t), intent(inout) :: span

    integer :: parts(size(nodes) - 1), i, k, n
    real(wp) :: step

    parts = 2**level
    where (nodes(2:) - nodes(:size(parts)) <= one_instant*span%period) parts = 1
    if (allocated(span%at)) deallocate (span%at, span%weight)
    allocate (span%at(sum(parts) + 1), span%weight(sum(parts) + 1))
    span%weight = 0.0_wp
    n = 0
    do i = 1, size(parts)
      step = (nodes(i + 1) - nodes(i))/parts(i)
      span%at(n + 1:n + parts(i)) = [(nodes(i) + k*step, k=0, parts(i) - 1)]
      if (parts(i) == 1) then
        span%weight(n + 1:n + 2) = span%weight(n + 1:n + 2) + 0.5_wp*step
      else
        do k = 1, parts(i), 2
          span%weight(n + k:n + k + 2) = span%weight(n + k:n + k + 2) + step/3.0_wp*[1, 4, 1]
        end do
      end if
      n = n + parts(i)
    end do
    span%at(n + 1) = nodes(size(nodes))
    span%width = [span%at(2:) - span%at(:n), 0.0_wp]
  end subroutine divide_pieces

  !> All forces of a cycle at all speeds; an error where one of its samples has none.
  subroutine size_cycle(forces, span, threads, found, positions, joints)
    type(cycle_forces_t), intent(in) :: forces
    type(cycle_t), intent(in) :: span
    integer, intent(in) :: threads
    type(sizing_result_t), intent(inout) :: found
    type(positions_t), intent(out) :: positions
    type(joints_result_t), intent(out) :: joints

    integer :: k

    call find_cycle(forces, span, threads, found, positions, joints)
    if (allocated(found%error)) return
    allocate (found%at_speed(size(forces%request%speed)))
    !$omp parallel do num_threads(threads) schedule(dynamic) default(shared) private(k)
    do k = 1, size(forces%request%speed)
      call size_speed(forces, span, positions, joints, k, found%at_speed(k))
    end do
    !$omp end parallel do
  end subroutine size_cycle

  !> All positions and joints of the cycle; an error where one of them has no forces.
  subroutine find_cycle(forces, span, threads, found, positions, joints)
    type(cycle_forces_t), intent(in) :: forces
    type(cycle_t), intent(in) :: span
    integer, intent(in) :: threads
    type(sizing_result_t), intent(inout) :: found
    type(positions_t), intent(out) :: positions
    type(joints_result_t), intent(out) :: joints

    real(wp), allocatable :: sense(:)
    integer :: i

    positions = forces%positions_at(span%at)
    do i = 1, size(span%at)
      if (.not. allocated(positions%states(i)%error)) cycle
      found%error = positions%states(i)%error
      found%error_crank = span%at(i)
      return
    end do
    call forces%find_joints_at(span%at, positions, threads, joints)
    do i = 1, size(span%at)
      if (.not. allocated(joints%outcome(i)%error)) cycle
      found%error = joints%outcome(i)%error
      found%error_crank = span%at(i)
      return
    end do
    if (is_actuated(forces%linkage)) then
      sense = [(actuator_sense(forces%linkage, positions%states(i)%pose), i=1, size(span%at))]
      i = findloc(sense(2:)*sense(:size(sense) - 1) < 0.0_wp, .true., dim=1)
      if (i > 0) then
        call set_error(found%error, error_of_numerics, "ACTUATE does not hold the linkage "// &
          "all the way: between two samples it can move while the actuators do not")
        found%error_crank = span%at(i)
        return
      end if
    end if
    i = findloc(any(joints%lock%friction > 0, dim=1), .true., dim=1)
    if (i > 0) then
      call set_error(found%error, error_of_numerics, "friction locks the linkage")
      found%error_crank = span%at(i)
      return
    end if
    found%joints = joints%joints
    found%is_open = any(joints%is_open, dim=2)
  end subroutine find_cycle

  !> All drives and joints at a speed.
  subroutine size_speed(forces, span, positions, joints, number, found)
    type(cycle_forces_t), intent(in) :: forces
    type(cycle_t), intent(in) :: span
    type(positions_t), intent(in) :: positions
    type(joints_result_t), intent(in) :: joints
    integer, intent(in) :: number !! of the speed
    type(sizing_t), intent(inout) :: found

    real(wp), allocatable :: values(:, :), rates(:, :)
    integer :: i, s, n, d

    d = size(forces%linkage%drives) + forces%motors()
    n = d + size(joints%joints)
    allocate (found%sized(n), values(size(span%at), n), rates(size(span%at), d))
    do i = 1, size(values, 1)
      call forces%find_values(positions, joints, i, span%at(i), number, values(i, :), rates(i, :))
    end do
    do s = 1, n
      associate (sized => found%sized(s))
        if (s <= size(forces%linkage%drives)) then
          sized%drive = s
        else if (s <= d) then
          sized%drive = 1
          sized%is_motor = .true.
        else
          sized%joint = s - d
        end if
        if (s <= d) call size_motion(forces, span, number, s, values(:, s), rates(:, s), sized)
        if (maxval(abs(values(:, s))) <= round_off_share*maxval(abs(values(:, &
          merge(1, d + 1, s <= d):merge(d, n, s <= d))))) cycle
        sized%mean = mean_of(span, values(:, s))
        sized%rms = sqrt(mean_of(span, values(:, s)**2))
        sized%cubic = mean_of(span, abs(values(:, s))**3)**(1.0_wp/3.0_wp)
        if (s > d) then
          if (any(joints%is_open(s - d, :))) cycle
        end if
        call find_peak(forces, span, of_forces, number, s, values(:, s), sized%peak, sized%crank)
        if (abs(sized%mean) <= round_off_share*abs(sized%peak)) sized%mean = 0.0_wp
        sized%has_kinks = is_timed(forces%request)
        if (s <= d) cycle
        call find_angle(forces, span, number, is_constant(values(:, s)), sized)
        sized%has_kinks = sized%has_kinks .or. any(values(:, s) < abs(cshift(values(:, s), 1) - &
          values(:, s)))
        call find_turned_mean(forces, span, positions, joints%joints(s - d), values(:, s), sized)
      end associate
    end do
  end subroutine size_speed

  !> The rate of a drive or of the motor, and its power; of a drive at constant speed the former is
  !! all.
  subroutine size_motion(forces, span, number, signal, values, rates, sized)
    type(cycle_forces_t), intent(in) :: forces
    type(cycle_t), intent(in) :: span
    integer, intent(in) :: number, signal !! of the speed; of the drive or motor
    real(wp), intent(in) :: values(:), rates(:) !! (samples)
    type(sized_t), intent(inout) :: sized

    real(wp) :: power(size(values))

    sized%rate = rates(1)
    sized%varies = is_timed(forces%request) .or. is_actuated(forces%linkage)
    if (.not. sized%varies) return
    power = values*rates
    associate (timed => sized%timed)
      call find_peak(forces, span, of_rates, number, signal, rates, sized%rate, timed%rate_at)
      timed%rms_rate = sqrt(mean_of(span, rates**2))
      timed%mean_power = mean_of(span, power)
      call find_peak(forces, span, of_powers, number, signal, power, timed%peak_power, &
        timed%power_at)
      if (abs(timed%mean_power) <= round_off_share*abs(timed%peak_power)) timed%mean_power = 0.0_wp
    end associate
  end subroutine size_motion

  !> The mean over the cycle.
  pure function mean_of(span, values) result(mean)
    type(cycle_t), intent(in) :: span
    real(wp), intent(in) :: values(:) !! (samples)
    real(wp) :: mean

    mean = sum(span%weight*values)/sum(span%weight)
  end function mean_of

  !> Whether a force has no peak to look for.
  pure function is_constant(values) result(is)
    real(wp), intent(in) :: values(:) !! (samples)
    logical :: is

    is = maxval(abs(values)) - minval(abs(values)) <= 1.0e-12_wp*maxval(abs(values))
  end function is_constant

  !> The cubic mean of the force in a joint over the way that it turns or slides,
  !! `(∫ F³ |v| dt/∫ |v| dt)^(1/3)`: with it as a constant load a rolling bearing has the same life
  !! (ISO 281; exponent 3, of balls).
  !!
  !! Where the rate v changes its sign between two samples it is taken as linear, and the error
  !! falls with the third power of their distance. Else sums over the period are as exact as
  !! those of the other means.
  subroutine find_turned_mean(forces, span, positions, joint, values, sized)
    type(cycle_forces_t), intent(in) :: forces
    type(cycle_t), intent(in) :: span
    type(positions_t), intent(in) :: positions
    type(joint_t), intent(in) :: joint
    real(wp), intent(in) :: values(:)     !! (samples) magnitudes [N]
    type(sized_t), intent(inout) :: sized !! with its peak

    real(wp), dimension(size(values)) :: rate, cube, pace, weight
    real(wp) :: sums(2), share, motion(3)
    integer :: i, k, n

    n = size(values)
    pace = 1.0_wp
    do i = 1, n
      motion = forces%motion_at(span%at(i), 1)
      if (is_timed(forces%request)) pace(i) = motion(2)
      associate (state => positions%states(i))
        rate(i) = pace(i)*joint_rate(forces%linkage, state%pose, state%coefficients, joint%pin, &
          joint%body, joint%slider)
      end associate
    end do
    sized%turns = maxval(abs(rate)) > rest*linkage_rate(forces%linkage, positions, pace)
    if (.not. sized%turns) return
    cube = (values/abs(sized%peak))**3
    weight = 0.5_wp*(span%width + cshift(span%width, -1))
    sums = [sum(weight*abs(rate)*cube), sum(weight*abs(rate))]
    do i = 1, n
      k = modulo(i, n) + 1
      if (rate(i)*rate(k) >= 0.0_wp) cycle
      ! |v| is less between them than the chord from |v_i| to |v_k|, by this share of their sum.
      share = span%width(i)*abs(rate(i)*rate(k))/(abs(rate(i)) + abs(rate(k)))
      sums = sums - share*[0.5_wp*(cube(i) + cube(k)), 1.0_wp]
    end do
    sized%turned_cubic = abs(sized%peak)*(sums(1)/sums(2))**(1.0_wp/3.0_wp)
  end subroutine find_turned_mean

  !> The greatest rate at which any body turns, or a pin moves per length of the first body.
  pure function linkage_rate(linkage, positions, pace) result(rate)
    type(linkage_t), intent(in) :: linkage
    type(positions_t), intent(in) :: positions
    real(wp), intent(in) :: pace(:) !! (samples) with which rates are multiplied
    real(wp) :: rate

    integer :: i

    rate = 0.0_wp
    do i = 1, size(positions%states)
      associate (coefficients => positions%states(i)%coefficients)
        rate = max(rate, abs(pace(i))*maxval(abs(coefficients%turn)), &
          abs(pace(i))*maxval(abs(coefficients%pin))/linkage%bodies(1)%length)
      end associate
    end do
  end function linkage_rate

  !> The greatest absolute value: between the highest samples.
  subroutine find_peak(forces, span, kind, number, signal, values, peak, place)
    type(cycle_forces_t), intent(in) :: forces
    type(cycle_t), intent(in) :: span
    integer, intent(in) :: kind           !! one of the of_… constants
    integer, intent(in) :: number, signal !! of the speed; of the force
    real(wp), intent(in) :: values(:)     !! (samples)
    real(wp), intent(out) :: peak         !! with its sign
    real(wp), intent(out) :: place        !! where it is

    integer, parameter :: most_peaks = 3
    real(wp) :: height(size(values)), ends(2), there, value
    integer :: at, k

    height = abs(values)
    at = maxloc(height, dim=1)
    peak = values(at)
    place = span%at(at)
    if (is_constant(values)) return
    height = merge(height, 0.0_wp, height >= cshift(height, 1) .and. height >= cshift(height, -1))
    do k = 1, most_peaks
      at = maxloc(height, dim=1)
      if (height(at) <= 0.0_wp) exit
      height(at) = 0.0_wp
      ends = [span%at(max(1, at - 1)), span%at(min(at + 1, size(values)))]
      if (span%repeats) ends = span%at(at) + span%period/size(values)*[-1, 1]
      call enclose_peak(forces, span, kind, number, signal, ends, there, value)
      if (abs(value) <= abs(peak)) cycle
      peak = value
      place = there
      if (span%repeats) place = span%from + modulo(there - span%from, span%period)
    end do
  end subroutine find_peak

  !> Golden-section search for the greatest absolute value between two positions.
  subroutine enclose_peak(forces, span, kind, number, signal, ends, place, value)
    type(cycle_forces_t), intent(in) :: forces
    type(cycle_t), intent(in) :: span
    integer, intent(in) :: kind           !! one of the of_… constants
    integer, intent(in) :: number, signal !! of the speed; of the force
    real(wp), intent(in) :: ends(2)       !! [deg], of laws [s]
    real(wp), intent(out) :: place        !! where it is, likewise
    real(wp), intent(out) :: value        !! with its sign [N m], [N] or [W]

    real(wp), parameter :: golden = 0.5_wp*(sqrt(5.0_wp) - 1.0_wp)
    ! A peak is flat: this close to it the value is exact to the last digits.
    real(wp), parameter :: near = 1.0e-6_wp
    real(wp) :: a, b, x(2), y(2)
    integer :: at

    a = ends(1)
    b = ends(2)
    x = [b - golden*(b - a), a + golden*(b - a)]
    y = [forces%value_at(x(1), kind, signal, number), forces%value_at(x(2), kind, signal, &
      number)]
    do while (b - a > near*span%unit)
      if (abs(y(1)) >= abs(y(2))) then
        b = x(2)
        x = [b - golden*(b - a), x(1)]
        y = [forces%value_at(x(1), kind, signal, number), y(1)]
      else
        a = x(1)
        x = [x(2), a + golden*(b - a)]
        y = [y(2), forces%value_at(x(2), kind, signal, number)]
      end if
    end do
    at = merge(1, 2, abs(y(1)) >= abs(y(2)))
    place = x(at)
    value = y(at)
  end subroutine enclose_peak

  !> Direction of the force of a joint at its peak. Its error is what it changes by nearby; any
  !! position may be that of the peak of a constant force.
  subroutine find_angle(forces, span, number, stays, sized)
    type(cycle_forces_t), intent(in) :: forces
    type(cycle_t), intent(in) :: span
    integer, intent(in) :: number         !! of the speed
    logical, intent(in) :: stays          !! the magnitude of the force is constant
    type(sized_t), intent(inout) :: sized !! with the peak

    integer, parameter :: constant_angles = 8
    real(wp) :: angle, near
    integer :: k

    sized%angle = forces%angle_at(sized%crank, sized%joint, number)
    if (stays) then
      sized%angle_error = 0.0_wp
      do k = 1, constant_angles
        angle = forces%angle_at(span%from + span%period*k/constant_angles, sized%joint, number)
        sized%angle_error = max(sized%angle_error, between_angles(angle, sized%angle))
      end do
    else
      ! Beyond its last instant nothing is known of a motion that does not repeat.
      near = flatness*span%unit
      if (.not. span%repeats .and. sized%crank + near > maxval(span%at)) near = -near
      angle = forces%angle_at(sized%crank + near, sized%joint, number)
      sized%angle_error = between_angles(angle, sized%angle)
    end if
    sized%angle_error = sized%angle_error + round_off_share*180.0_wp
  end subroutine find_angle

  !> Flywheels for all speeds; loads that depend on the speed are those at the mean speed.
  subroutine find_flywheels(forces, span, positions, threads, found)
    type(cycle_forces_t), intent(in) :: forces
    type(cycle_t), intent(in) :: span
    type(positions_t), intent(in) :: positions
    integer, intent(in) :: threads
    type(sizing_result_t), intent(inout) :: found

    type(lagrange_result_t) :: lagrange
    real(wp), allocatable :: load(:), speeds(:, :), accelerations(:, :)
    integer :: k

    call forces%find_rates(span%at, speeds, accelerations)
    call find_lagrange_terms(forces%linkage, forces%elements, positions, threads, lagrange, &
      speeds, accelerations, forces%division)
    associate (request => forces%request)
      do k = 1, size(request%speed)
        if (abs(request%speed(k)) <= 0.0_wp) cycle
        load = lagrange%terms%gravity + lagrange%terms%load
        if (size(lagrange%running_load, 1) > 0) load = load + lagrange%running_load(k, :)
        found%at_speed(k)%has_flywheel = .true.
        ! The rotor of the motor is a flywheel, too.
        associate (inertia => lagrange%terms%inertia + request%gear%ratio**2*request%gear%rotor, &
            slope => lagrange%terms%inertia_slope)
          found%at_speed(k)%flywheel = size_flywheel(inertia, slope, load, found%period*degree, &
            request%speed(k), request%fluctuation)
          found%at_speed(k)%between = size_flywheel(cshift(inertia, 1), cshift(slope, 1), &
            cshift(load, 1), found%period*degree, request%speed(k), request%fluctuation)
        end associate
      end do
    end associate
  end subroutine find_flywheels

end module sizing_study
