!> Ratings of motors, bearings and the flywheel of a linkage over its whole cycle.
module sizing_study
  use constants, only: degree
  use elastic_reactions, only: elastic_division_t
  use errors, only: error_of_input, error_of_numerics, error_t, set_error
  use flywheels, only: flywheel_t, size_flywheel
  use gears, only: gear_share, gear_t, is_direct
  use interruption, only: was_interrupted
  use joint_rates, only: joint_rate
  use joint_study, only: bearing_values, bearings_at_speed, drives_at_speed, find_joints, &
    joint_t, joints_at_speed, joints_result_t
  use kinds, only: fineness, wp
  use lagrange_study, only: find_lagrange_terms, lagrange_result_t
  use linkages, only: linkage_t
  use linkage_paths, only: period_of
  use load_tables, only: load_period
  use positions, only: find_positions, positions_t
  implicit none (type, external)
  private

  public :: sizing_request_t, gear_t, sized_t, sizing_t, sizing_result_t, find_sizing

  !> Samples of a cycle: doubled until no result changes by more than `settled` of its peak.
  integer, parameter :: fewest_samples = 128, most_samples = 8192
  real(wp), parameter :: settled = 1.0e-11_wp*fineness

  !> A force below this share of the largest of its kind, and a mean below this share of the peak,
  !! is round-off and written as 0.
  real(wp), parameter :: round_off_share = 1.0e-12_wp

  !> Changes that fall by more than this with twice as many samples are those of a smooth force.
  real(wp), parameter :: of_smooth = 1.0e-3_wp

  !> A joint whose rate is below this share of that of the linkage is at rest: it is round-off.
  real(wp), parameter :: rest = 1.0e-12_wp

  !> Values of a flywheel: mean torque, energy, fluctuation without it, its inertia, fluctuation
  !! with it, greatest and least speed.
  integer, parameter :: flywheel_values = 7

  !> Where the peak of a force is flat nothing tells it from positions so near [deg].
  real(wp), parameter :: flatness = 1.0e-4_wp

  !> What is asked for.
  type :: sizing_request_t
    real(wp), allocatable :: speed(:)    !! (speeds) of the first drive [rad/s] or [m/s]
    real(wp) :: acceleration = 0.0_wp    !! of the first drive [rad/s²] or [m/s²]
    real(wp) :: fluctuation = 0.0_wp     !! of the speed, that a flywheel is to allow; 0: none is
                                         !! asked for [-]
    type(gear_t) :: gear                 !! between a motor and the first drive
  end type sizing_request_t

  !> A force over the cycle: of a drive its torque or force, with its sign, of the motor likewise,
  !! at its shaft; of a joint its magnitude.
  type :: sized_t
    integer :: drive = 0        !! number; 0: of a joint
    integer :: joint = 0        !! number; 0: of a drive
    logical :: is_motor = .false. !! of the motor of the first drive
    real(wp) :: peak = 0.0_wp   !! greatest absolute value, with its sign [N m] or [N]
    real(wp) :: crank = 0.0_wp  !! position of the first drive there [deg]
    real(wp) :: angle = 0.0_wp  !! of a joint: of the force there, in the axes of its link [deg]
    real(wp) :: rate = 0.0_wp   !! of a drive or the motor [rad/s] or [m/s]
    real(wp) :: rms = 0.0_wp    !! [N m] or [N]
    real(wp) :: mean = 0.0_wp   !! [N m] or [N]
    real(wp) :: cubic = 0.0_wp  !! cubic mean of absolute values [N m] or [N]
    logical :: turns = .false.  !! the joint turns or slides
    real(wp) :: turned_cubic = 0.0_wp !! cubic mean weighted by how fast it does [N]
    real(wp) :: turned_error = 0.0_wp !! of it, estimated, as a share of the peak [-]
    real(wp) :: error = 0.0_wp  !! of peak and other means, estimated, as a share of the peak [-]
    real(wp) :: angle_error = 0.0_wp !! of the angle, estimated [deg]
    real(wp) :: change(2) = 1.0_wp   !! of what `error` and `turned_error` are about, from half as
                                     !! many samples, as shares of the peak [-]
    logical :: has_kinks = .false.   !! the force passes zero between samples, perhaps
  end type sized_t

  !> At one speed.
  type :: sizing_t
    type(sized_t), allocatable :: sized(:)  !! drives, the motor if it has a gear, then joints
    logical :: has_flywheel = .false.       !! `flywheel` is found
    type(flywheel_t) :: flywheel            !! on the first drive
    type(flywheel_t) :: between             !! the same from the samples between
    real(wp) :: flywheel_error(flywheel_values) = 0.0_wp !! of the values of `values_of_flywheel`,
                                            !! estimated, shares of these; of the mean torque of
                                            !! the peak of the first drive [-]
  end type sizing_t

  type :: sizing_result_t
    type(error_t), allocatable :: error       !! why there is nothing
    real(wp) :: error_crank = 0.0_wp          !! where [deg]
    integer :: samples = 0                    !! of the cycle
    real(wp) :: period = 0.0_wp               !! of the cycle [deg]
    type(joint_t), allocatable :: joints(:)   !! as in `joint_study`
    logical, allocatable :: is_open(:)        !! (joints) the same, anywhere over the cycle
    type(sizing_t), allocatable :: at_speed(:)
  end type sizing_result_t

contains

  !> Peaks and means over the cycle for every speed, and flywheels.
  !!
  !! Peaks between samples are enclosed by golden-section search around the three highest samples.
  !! Errors are estimated by those with half as many samples. Errors: the first drive does not turn
  !! fully, positions and loads do not repeat, or those of a position.
  subroutine find_sizing(linkage, elements, request, threads, found, division)
    type(linkage_t), intent(in) :: linkage       !! of any kind, with masses
    integer, intent(in) :: elements(:)           !! (bodies) on whose nodes the masses are lumped;
                                                 !! 0: distributed
    type(sizing_request_t), intent(in) :: request
    integer, intent(in) :: threads               !! number of OpenMP threads
    type(sizing_result_t), intent(out) :: found
    type(elastic_division_t), intent(in), optional :: division !! of this linkage, if its elasticity
                                                 !! divides forces

    type(sizing_t), allocatable :: last(:)
    type(positions_t) :: positions
    type(joints_result_t) :: joints
    real(wp), allocatable :: speeds(:, :), accelerations(:, :)
    real(wp) :: change
    integer :: i, k, samples

    found%period = load_period(linkage, period_of(linkage))
    if (found%period <= 0.0_wp) then
      call set_error(found%error, error_of_input, "positions and loads do not repeat with the "// &
        "first drive: there is no cycle")
      return
    end if
    samples = fewest_samples*max(1, nint(found%period/360.0_wp))
    do
      positions = find_positions(linkage, [(found%period*(i - 1)/samples, i=1, samples)])
      do i = 1, samples
        if (.not. allocated(positions%states(i)%error)) cycle
        found%error = positions%states(i)%error
        found%error_crank = positions%states(i)%crank
        return
      end do
      speeds = spread(request%speed, 2, samples)
      accelerations = spread(0.0_wp*request%speed + request%acceleration, 2, samples)
      call find_joints(linkage, elements, positions, threads, joints, speeds, accelerations, &
        division)
      do i = 1, samples
        if (.not. allocated(joints%outcome(i)%error)) cycle
        found%error = joints%outcome(i)%error
        found%error_crank = positions%states(i)%crank
        return
      end do
      if (any(joints%lock%friction > 0)) then
        i = findloc(any(joints%lock%friction > 0, dim=1), .true., dim=1)
        call set_error(found%error, error_of_numerics, "friction locks the linkage")
        found%error_crank = positions%states(i)%crank
        return
      end if
      found%joints = joints%joints
      found%is_open = any(joints%is_open, dim=2)
      found%samples = samples
      if (allocated(found%at_speed)) call move_alloc(found%at_speed, last)
      allocate (found%at_speed(size(request%speed)))
      !$omp parallel do num_threads(threads) schedule(dynamic) default(shared) private(k)
      do k = 1, size(request%speed)
        call size_speed(linkage, elements, request, positions, joints, k, found%at_speed(k), &
          division)
      end do
      !$omp end parallel do
      if (request%fluctuation > 0.0_wp) call find_flywheels(linkage, elements, request, positions, &
        threads, speeds, accelerations, found, division)
      change = huge(change)
      if (allocated(last)) change = largest_change(found%at_speed, last)
      if (change <= settled .or. 2*samples > most_samples .or. was_interrupted()) exit
      samples = 2*samples
    end do
  end subroutine find_sizing

  !> All drives and joints at a speed.
  subroutine size_speed(linkage, elements, request, positions, joints, number, found, division)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: elements(:)
    type(sizing_request_t), intent(in) :: request
    type(positions_t), intent(in) :: positions
    type(joints_result_t), intent(in) :: joints
    integer, intent(in) :: number !! of the speed
    type(sizing_t), intent(inout) :: found
    type(elastic_division_t), intent(in), optional :: division

    real(wp), allocatable :: values(:, :)
    real(wp) :: drives(3, size(linkage%drives))
    integer :: i, s, n, d

    d = size(linkage%drives) + motors(request)
    n = d + size(joints%joints)
    allocate (found%sized(n), values(size(positions%states), n))
    do i = 1, size(values, 1)
      values(i, :) = values_at(linkage, joints, i, request, number)
    end do
    drives = drives_at_speed(linkage, joints, 1, 0.0_wp, request%speed(number), &
      request%acceleration)
    do s = 1, n
      associate (sized => found%sized(s))
        if (s <= size(linkage%drives)) then
          sized%drive = s
          sized%rate = drives(2, s)
        else if (s <= d) then
          sized%drive = 1
          sized%is_motor = .true.
          sized%rate = request%gear%ratio*drives(2, 1)
        else
          sized%joint = s - d
        end if
        sized%mean = sum(values(:, s))/size(values, 1)
        sized%rms = sqrt(sum(values(:, s)**2)/size(values, 1))
        sized%cubic = (sum(abs(values(:, s))**3)/size(values, 1))**(1.0_wp/3.0_wp)
        if (maxval(abs(values(:, s))) <= round_off_share*maxval(abs(values(:, &
          merge(1, d + 1, s <= d):merge(d, n, s <= d))))) then
          sized%mean = 0.0_wp
          sized%rms = 0.0_wp
          sized%cubic = 0.0_wp
          cycle
        end if
        if (s > d) then
          if (any(joints%is_open(s - d, :))) cycle
        end if
        call find_peak(linkage, elements, request, number, s, positions%period, values(:, s), &
          sized, division)
        if (abs(sized%mean) <= round_off_share*abs(sized%peak)) sized%mean = 0.0_wp
        if (s <= d) cycle
        sized%has_kinks = any(values(:, s) < abs(cshift(values(:, s), 1) - values(:, s)))
        call find_turned_mean(linkage, positions, joints%joints(s - d), values(:, s), sized)
      end associate
    end do
  end subroutine size_speed

  !> The cubic mean of the force in a joint over the way that it turns or slides,
  !! `(∫ F³ |v| dt/∫ |v| dt)^(1/3)`: with it as a constant load a rolling bearing has the same life
  !! (ISO 281; exponent 3, of balls).
  !!
  !! Where the rate v changes its sign between two samples it is taken as linear, and the error
  !! falls with the third power of their distance. Else sums over the period are as exact as
  !! those of the other means.
  subroutine find_turned_mean(linkage, positions, joint, values, sized)
    type(linkage_t), intent(in) :: linkage
    type(positions_t), intent(in) :: positions
    type(joint_t), intent(in) :: joint
    real(wp), intent(in) :: values(:)     !! (samples) magnitudes [N]
    type(sized_t), intent(inout) :: sized !! with its peak

    real(wp) :: rate(size(values)), cube(size(values)), sums(2), share
    integer :: i, k, n

    n = size(values)
    do i = 1, n
      associate (state => positions%states(i))
        rate(i) = joint_rate(linkage, state%pose, state%coefficients, joint%pin, joint%body, &
          joint%slider)
      end associate
    end do
    sized%turns = maxval(abs(rate)) > rest*linkage_rate(linkage, positions)
    if (.not. sized%turns) return
    cube = (values/abs(sized%peak))**3
    sums = [sum(abs(rate)*cube), sum(abs(rate))]
    do i = 1, n
      k = modulo(i, n) + 1
      if (rate(i)*rate(k) >= 0.0_wp) cycle
      ! |v| is less between them than the chord from |v_i| to |v_k|, by this share of their sum.
      share = abs(rate(i)*rate(k))/(abs(rate(i)) + abs(rate(k)))
      sums = sums - share*[0.5_wp*(cube(i) + cube(k)), 1.0_wp]
    end do
    sized%turned_cubic = abs(sized%peak)*(sums(1)/sums(2))**(1.0_wp/3.0_wp)
  end subroutine find_turned_mean

  !> The greatest rate at which any body turns, or a pin moves per length of the first body.
  pure function linkage_rate(linkage, positions) result(rate)
    type(linkage_t), intent(in) :: linkage
    type(positions_t), intent(in) :: positions
    real(wp) :: rate

    integer :: i

    rate = 0.0_wp
    do i = 1, size(positions%states)
      associate (coefficients => positions%states(i)%coefficients)
        rate = max(rate, maxval(abs(coefficients%turn)), maxval(abs(coefficients%pin))/ &
          linkage%bodies(1)%length)
      end associate
    end do
  end function linkage_rate

  !> Number of motors that differ from what the first drive is: 0 or 1.
  pure function motors(request) result(number)
    type(sizing_request_t), intent(in) :: request
    integer :: number

    number = merge(0, 1, is_direct(request%gear) .and. abs(request%gear%ratio - 1.0_wp) <= 0.0_wp)
  end function motors

  !> Torque at the shaft of the motor that gives a torque on the first drive: through the gear, with
  !! its losses, and for the rotor [N m].
  pure function motor_torque(gear, torque, rate, acceleration) result(motor)
    type(gear_t), intent(in) :: gear
    real(wp), intent(in) :: torque       !! on the driven body [N m]
    real(wp), intent(in) :: rate         !! of it [rad/s]
    real(wp), intent(in) :: acceleration !! of it [rad/s²]
    real(wp) :: motor

    real(wp) :: through

    through = torque/gear%ratio
    through = through/gear_share(gear, rate, through)
    motor = through + gear%rotor*gear%ratio*acceleration
  end function motor_torque

  !> Forces of the drives, torque of the motor, then magnitudes of the joints.
  pure function values_at(linkage, joints, state, request, number) result(values)
    type(linkage_t), intent(in) :: linkage
    type(joints_result_t), intent(in) :: joints
    integer, intent(in) :: state
    type(sizing_request_t), intent(in) :: request
    integer, intent(in) :: number !! of the speed
    real(wp) :: values(size(linkage%drives) + motors(request) + size(joints%joints))

    real(wp) :: drives(3, size(linkage%drives)), forces(3, size(joints%joints))
    integer :: d

    d = size(linkage%drives)
    drives = drives_at_speed(linkage, joints, state, 0.0_wp, request%speed(number), &
      request%acceleration, number)
    forces = joints_at_speed(joints, state, request%speed(number), request%acceleration, number)
    values(:d) = drives(3, :)
    if (motors(request) > 0) values(d + 1) = motor_torque(request%gear, drives(3, 1), drives(2, &
      1), request%acceleration)
    values(d + motors(request) + 1:) = norm2(forces(:2, :), dim=1)
  end function values_at

  !> The greatest absolute value: golden-section search around the highest samples.
  subroutine find_peak(linkage, elements, request, number, signal, period, values, sized, division)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: elements(:)
    type(sizing_request_t), intent(in) :: request
    integer, intent(in) :: number, signal !! of the speed; of the force
    real(wp), intent(in) :: period        !! [deg]
    real(wp), intent(in) :: values(:)     !! (samples)
    type(sized_t), intent(inout) :: sized
    type(elastic_division_t), intent(in), optional :: division

    integer, parameter :: most_peaks = 3, constant_angles = 8
    real(wp), parameter :: golden = 0.5_wp*(sqrt(5.0_wp) - 1.0_wp)
    ! A peak is flat: this close to it [deg] the value is exact to the last digits.
    real(wp), parameter :: near = 1.0e-6_wp
    real(wp) :: height(size(values)), a, b, x(2), y(2), step
    integer :: at, k
    logical :: is_constant

    step = period/size(values)
    height = abs(values)
    at = maxloc(height, dim=1)
    sized%peak = values(at)
    sized%crank = step*(at - 1)
    height = merge(height, 0.0_wp, height >= cshift(height, 1) .and. height >= cshift(height, -1))
    ! A force that is constant has no peak to look for.
    is_constant = maxval(abs(values)) - minval(abs(values)) <= 1.0e-12_wp*abs(sized%peak)
    if (is_constant) height = 0.0_wp
    do k = 1, most_peaks
      at = maxloc(height, dim=1)
      if (height(at) <= 0.0_wp) exit
      height(at) = 0.0_wp
      a = step*(at - 2)
      b = step*at
      x = [b - golden*(b - a), a + golden*(b - a)]
      y = [value_at(x(1)), value_at(x(2))]
      do while (b - a > near)
        if (abs(y(1)) >= abs(y(2))) then
          b = x(2)
          x = [b - golden*(b - a), x(1)]
          y = [value_at(x(1)), y(1)]
        else
          a = x(1)
          x = [x(2), a + golden*(b - a)]
          y = [y(2), value_at(x(2))]
        end if
      end do
      at = merge(1, 2, abs(y(1)) >= abs(y(2)))
      if (abs(y(at)) <= abs(sized%peak)) cycle
      sized%peak = y(at)
      sized%crank = modulo(x(at), period)
    end do
    if (sized%joint == 0) return
    sized%angle = angle_at(sized%crank)
    if (is_constant) then
      ! Any position may be that of the peak.
      sized%angle_error = maxval([(between_angles(angle_at(period*k/constant_angles), &
        sized%angle), k=1, constant_angles)])
    else
      sized%angle_error = between_angles(angle_at(sized%crank + flatness), sized%angle)
    end if
    sized%angle_error = sized%angle_error + round_off_share*180.0_wp

  contains

    !> The force at a position; 0 where there is none.
    function value_at(crank) result(value)
      real(wp), intent(in) :: crank
      real(wp) :: value

      type(positions_t) :: there
      type(joints_result_t) :: joints
      real(wp), allocatable :: all_values(:)

      value = 0.0_wp
      there = find_positions(linkage, [crank])
      if (allocated(there%states(1)%error)) return
      call find_joints(linkage, elements, there, 1, joints, spread(request%speed, 2, 1), &
        spread(0.0_wp*request%speed + request%acceleration, 2, 1), division)
      if (allocated(joints%outcome(1)%error)) return
      if (any(joints%lock%friction > 0)) return
      all_values = values_at(linkage, joints, 1, request, number)
      value = all_values(signal)
    end function value_at

    !> Direction of the force of the joint at a position.
    function angle_at(crank) result(angle)
      real(wp), intent(in) :: crank
      real(wp) :: angle

      type(positions_t) :: there
      type(joints_result_t) :: joints
      real(wp), allocatable :: bearings(:, :)

      there = find_positions(linkage, [crank])
      call find_joints(linkage, elements, there, 1, joints, spread(request%speed, 2, 1), &
        spread(0.0_wp*request%speed + request%acceleration, 2, 1), division)
      bearings = bearings_at_speed(linkage, joints, there%states(1)%pose, 1, &
        request%speed(number), request%acceleration, number)
      angle = bearings(bearing_values, sized%joint)
    end function angle_at

  end subroutine find_peak

  !> Flywheels for all speeds; loads that depend on the speed are those at the mean speed.
  subroutine find_flywheels(linkage, elements, request, positions, threads, speeds, &
    accelerations, found, division)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: elements(:)
    type(sizing_request_t), intent(in) :: request
    type(positions_t), intent(in) :: positions
    integer, intent(in) :: threads
    real(wp), intent(in) :: speeds(:, :), accelerations(:, :)
    type(sizing_result_t), intent(inout) :: found
    type(elastic_division_t), intent(in), optional :: division

    type(lagrange_result_t) :: lagrange
    real(wp), allocatable :: load(:)
    integer :: k

    call find_lagrange_terms(linkage, elements, positions, threads, lagrange, speeds, &
      accelerations, division)
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
  end subroutine find_flywheels

  !> The greatest change of all results, which become their estimated errors.
  function largest_change(now, last) result(change)
    type(sizing_t), intent(inout) :: now(:)
    type(sizing_t), intent(in) :: last(:)
    real(wp) :: change

    integer :: k, s

    change = 0.0_wp
    do k = 1, size(now)
      do s = 1, size(now(k)%sized)
        associate (a => now(k)%sized(s), b => last(k)%sized(s))
          a%change = [max(abs(abs(a%peak) - abs(b%peak)), abs(a%rms - b%rms), abs(a%mean - &
            b%mean), abs(a%cubic - b%cubic)), abs(a%turned_cubic - b%turned_cubic)]/ &
            max(abs(a%peak), tiny(1.0_wp))
          a%error = error_of(a%has_kinks, a%change(1), b%change(1), b%error)
          a%turned_error = error_of(.false., a%change(2), b%change(2), b%turned_error)
          a%angle_error = max(a%angle_error, between_angles(a%angle, b%angle))
          change = max(change, a%change(1))
        end associate
      end do
      if (.not. now(k)%has_flywheel) cycle
      call compare_flywheels(now(k), last(k), change)
    end do
  end function largest_change

  !> The error of a mean from its change by twice as many samples. Means of a smooth force converge
  !! exponentially. With kinks, where friction changes its sense or a force passes zero, errors fall
  !! with the square of the distance of samples and by where the kinks lie between them, and a
  !! change may be small by chance: then they count that were before.
  elemental function error_of(has_kinks, change, last_change, last_error) result(error)
    logical, intent(in) :: has_kinks !! else they show by how changes fall
    real(wp), intent(in) :: change, last_change, last_error
    real(wp) :: error

    error = change
    if (max(change, last_change) <= settled) return
    if (has_kinks .or. change > max(of_smooth*last_change, last_change**1.5_wp)) error = &
      max(change, 0.25_wp*last_error)
  end function error_of

  !> Errors of a flywheel: from half as many samples, and from those between. The latter miss the
  !! extremes, and the mean of 1/ω, by the opposite of what the former do, so that the errors of
  !! both are not small by chance together.
  pure subroutine compare_flywheels(now, last, change)
    type(sizing_t), intent(inout) :: now
    type(sizing_t), intent(in) :: last
    real(wp), intent(inout) :: change

    real(wp), parameter :: rounding = 32.0_wp*epsilon(1.0_wp), safety = 1.5_wp
    real(wp), dimension(flywheel_values) :: here, scale, least

    here = values_of_flywheel(now%flywheel)
    scale = max(abs(here), tiny(1.0_wp))
    scale(1) = max(abs(now%sized(1)%peak), abs(here(1)), tiny(1.0_wp))
    now%flywheel_error = max(abs(here - values_of_flywheel(now%between)), &
      abs(here - values_of_flywheel(last%flywheel)))/scale
    ! Differences of speeds have the rounding of the speeds.
    least = rounding
    least([3, 4, 5]) = rounding/max(here([3, 5, 5]), rounding)
    change = max(change, maxval(now%flywheel_error, mask=now%flywheel_error > 10.0_wp*least))
    now%flywheel_error = safety*now%flywheel_error + least
  end subroutine compare_flywheels

  pure function values_of_flywheel(flywheel) result(values)
    type(flywheel_t), intent(in) :: flywheel
    real(wp) :: values(flywheel_values)

    values = [flywheel%mean_torque, flywheel%energy, flywheel%alone, flywheel%inertia, &
      flywheel%fluctuation, flywheel%greatest, flywheel%least]
  end function values_of_flywheel

  !> Distance of two directions [deg].
  elemental function between_angles(one, other) result(distance)
    real(wp), intent(in) :: one, other !! [deg]
    real(wp) :: distance

    distance = abs(modulo(one - other + 180.0_wp, 360.0_wp) - 180.0_wp)
  end function between_angles

end module sizing_study
