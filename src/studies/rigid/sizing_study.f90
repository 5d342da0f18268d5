!> Ratings of motors, bearings and the flywheel of a linkage over its whole cycle.
module sizing_study
  use constants, only: degree
  use cycle_forces, only: cycle_forces_t, sizing_request_t
  use elastic_reactions, only: elastic_division_t
  use errors, only: error_of_input, error_of_numerics, error_t, set_error
  use flywheels, only: size_flywheel
  use gears, only: gear_t
  use interruption, only: was_interrupted
  use joint_rates, only: joint_rate
  use joint_study, only: drives_at_speed, joint_t, joints_result_t
  use kinds, only: wp
  use lagrange_study, only: find_lagrange_terms, lagrange_result_t
  use linkages, only: linkage_t
  use linkage_paths, only: period_of
  use load_tables, only: load_period
  use positions, only: find_positions, positions_t
  use sizing_values, only: between_angles, largest_change, settled, sized_t, sizing_t
  implicit none (type, external)
  private

  public :: sizing_request_t, gear_t, sized_t, sizing_t, sizing_result_t, find_sizing

  !> Samples of a cycle, per turn; and the most in all.
  integer, parameter :: fewest_samples = 128, most_samples = 8192

  !> A force below this share of the largest of its kind, and a mean below this share of the peak,
  !! is round-off and written as 0.
  real(wp), parameter :: round_off_share = 1.0e-12_wp

  !> A joint whose rate is below this share of that of the linkage is at rest: it is round-off.
  real(wp), parameter :: rest = 1.0e-12_wp

  !> Where the peak of a force is flat nothing tells it from positions so near [deg].
  real(wp), parameter :: flatness = 1.0e-4_wp

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

    type(cycle_forces_t) :: forces
    type(sizing_t), allocatable :: last(:)
    type(positions_t) :: positions
    type(joints_result_t) :: joints
    real(wp) :: change
    integer :: k

    found%period = load_period(linkage, period_of(linkage))
    if (found%period <= 0.0_wp) then
      call set_error(found%error, error_of_input, "positions and loads do not repeat with the "// &
        "first drive: there is no cycle")
      return
    end if
    forces%linkage = linkage
    forces%elements = elements
    forces%request = request
    if (present(division)) forces%division = division
    found%samples = fewest_samples*max(1, nint(found%period/360.0_wp))
    do
      call find_cycle(forces, threads, found, positions, joints)
      if (allocated(found%error)) return
      if (allocated(found%at_speed)) call move_alloc(found%at_speed, last)
      allocate (found%at_speed(size(request%speed)))
      !$omp parallel do num_threads(threads) schedule(dynamic) default(shared) private(k)
      do k = 1, size(request%speed)
        call size_speed(forces, positions, joints, k, found%at_speed(k))
      end do
      !$omp end parallel do
      if (request%fluctuation > 0.0_wp) call find_flywheels(forces, positions, threads, found)
      change = huge(change)
      if (allocated(last)) change = largest_change(found%at_speed, last)
      if (change <= settled .or. 2*found%samples > most_samples .or. was_interrupted()) exit
      found%samples = 2*found%samples
    end do
  end subroutine find_sizing

  !> All positions and joints of the cycle; an error where one of them has no forces.
  subroutine find_cycle(forces, threads, found, positions, joints)
    type(cycle_forces_t), intent(in) :: forces
    integer, intent(in) :: threads
    type(sizing_result_t), intent(inout) :: found !! with period and samples
    type(positions_t), intent(out) :: positions
    type(joints_result_t), intent(out) :: joints

    integer :: i

    positions = find_positions(forces%linkage, [(found%period*(i - 1)/found%samples, i=1, &
      found%samples)])
    do i = 1, found%samples
      if (.not. allocated(positions%states(i)%error)) cycle
      found%error = positions%states(i)%error
      found%error_crank = positions%states(i)%crank
      return
    end do
    call forces%find_joints_at(positions, threads, joints)
    do i = 1, found%samples
      if (.not. allocated(joints%outcome(i)%error)) cycle
      found%error = joints%outcome(i)%error
      found%error_crank = positions%states(i)%crank
      return
    end do
    i = findloc(any(joints%lock%friction > 0, dim=1), .true., dim=1)
    if (i > 0) then
      call set_error(found%error, error_of_numerics, "friction locks the linkage")
      found%error_crank = positions%states(i)%crank
      return
    end if
    found%joints = joints%joints
    found%is_open = any(joints%is_open, dim=2)
  end subroutine find_cycle

  !> All drives and joints at a speed.
  subroutine size_speed(forces, positions, joints, number, found)
    type(cycle_forces_t), intent(in) :: forces
    type(positions_t), intent(in) :: positions
    type(joints_result_t), intent(in) :: joints
    integer, intent(in) :: number !! of the speed
    type(sizing_t), intent(inout) :: found

    real(wp), allocatable :: values(:, :)
    real(wp) :: drives(3, size(forces%linkage%drives))
    integer :: i, s, n, d

    d = size(forces%linkage%drives) + forces%motors()
    n = d + size(joints%joints)
    allocate (found%sized(n), values(size(positions%states), n))
    do i = 1, size(values, 1)
      values(i, :) = forces%values_of(joints, i, number)
    end do
    drives = drives_at_speed(forces%linkage, joints, 1, 0.0_wp, forces%request%speed(number), &
      forces%request%acceleration)
    do s = 1, n
      associate (sized => found%sized(s))
        if (s <= size(forces%linkage%drives)) then
          sized%drive = s
          sized%rate = drives(2, s)
        else if (s <= d) then
          sized%drive = 1
          sized%is_motor = .true.
          sized%rate = forces%request%gear%ratio*drives(2, 1)
        else
          sized%joint = s - d
        end if
        if (maxval(abs(values(:, s))) <= round_off_share*maxval(abs(values(:, &
          merge(1, d + 1, s <= d):merge(d, n, s <= d))))) cycle
        sized%mean = sum(values(:, s))/size(values, 1)
        sized%rms = sqrt(sum(values(:, s)**2)/size(values, 1))
        sized%cubic = (sum(abs(values(:, s))**3)/size(values, 1))**(1.0_wp/3.0_wp)
        if (s > d) then
          if (any(joints%is_open(s - d, :))) cycle
        end if
        call find_peak(forces, number, s, positions%period, values(:, s), sized)
        if (abs(sized%mean) <= round_off_share*abs(sized%peak)) sized%mean = 0.0_wp
        if (s <= d) cycle
        sized%has_kinks = any(values(:, s) < abs(cshift(values(:, s), 1) - values(:, s)))
        call find_turned_mean(forces%linkage, positions, joints%joints(s - d), values(:, s), sized)
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

  !> The greatest absolute value, between the highest samples, and of a joint its angle there.
  subroutine find_peak(forces, number, signal, period, values, sized)
    type(cycle_forces_t), intent(in) :: forces
    integer, intent(in) :: number, signal !! of the speed; of the force
    real(wp), intent(in) :: period        !! [deg]
    real(wp), intent(in) :: values(:)     !! (samples)
    type(sized_t), intent(inout) :: sized

    integer, parameter :: most_peaks = 3
    real(wp) :: height(size(values)), step, crank, value
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
      call enclose_peak(forces, number, signal, step*[at - 2, at], crank, value)
      if (abs(value) <= abs(sized%peak)) cycle
      sized%peak = value
      sized%crank = modulo(crank, period)
    end do
    if (sized%joint > 0) call find_angle(forces, number, period, is_constant, sized)
  end subroutine find_peak

  !> Golden-section search for the greatest absolute value between two positions.
  subroutine enclose_peak(forces, number, signal, ends, crank, value)
    type(cycle_forces_t), intent(in) :: forces
    integer, intent(in) :: number, signal !! of the speed; of the force
    real(wp), intent(in) :: ends(2)       !! [deg]
    real(wp), intent(out) :: crank        !! where it is [deg]
    real(wp), intent(out) :: value        !! with its sign [N m] or [N]

    real(wp), parameter :: golden = 0.5_wp*(sqrt(5.0_wp) - 1.0_wp)
    ! A peak is flat: this close to it [deg] the value is exact to the last digits.
    real(wp), parameter :: near = 1.0e-6_wp
    real(wp) :: a, b, x(2), y(2)
    integer :: at

    a = ends(1)
    b = ends(2)
    x = [b - golden*(b - a), a + golden*(b - a)]
    y = [forces%value_at(x(1), signal, number), forces%value_at(x(2), signal, number)]
    do while (b - a > near)
      if (abs(y(1)) >= abs(y(2))) then
        b = x(2)
        x = [b - golden*(b - a), x(1)]
        y = [forces%value_at(x(1), signal, number), y(1)]
      else
        a = x(1)
        x = [x(2), a + golden*(b - a)]
        y = [y(2), forces%value_at(x(2), signal, number)]
      end if
    end do
    at = merge(1, 2, abs(y(1)) >= abs(y(2)))
    crank = x(at)
    value = y(at)
  end subroutine enclose_peak

  !> Direction of the force of a joint at its peak. Its error is what it changes by nearby; any
  !! position may be that of the peak of a constant force.
  subroutine find_angle(forces, number, period, is_constant, sized)
    type(cycle_forces_t), intent(in) :: forces
    integer, intent(in) :: number         !! of the speed
    real(wp), intent(in) :: period        !! [deg]
    logical, intent(in) :: is_constant    !! the magnitude of the force
    type(sized_t), intent(inout) :: sized !! with the peak

    integer, parameter :: constant_angles = 8
    real(wp) :: angle
    integer :: k

    sized%angle = forces%angle_at(sized%crank, sized%joint, number)
    if (is_constant) then
      sized%angle_error = 0.0_wp
      do k = 1, constant_angles
        angle = forces%angle_at(period*k/constant_angles, sized%joint, number)
        sized%angle_error = max(sized%angle_error, between_angles(angle, sized%angle))
      end do
    else
      angle = forces%angle_at(sized%crank + flatness, sized%joint, number)
      sized%angle_error = between_angles(angle, sized%angle)
    end if
    sized%angle_error = sized%angle_error + round_off_share*180.0_wp
  end subroutine find_angle

  !> Flywheels for all speeds; loads that depend on the speed are those at the mean speed.
  subroutine find_flywheels(forces, positions, threads, found)
    type(cycle_forces_t), intent(in) :: forces
    type(positions_t), intent(in) :: positions
    integer, intent(in) :: threads
    type(sizing_result_t), intent(inout) :: found

    type(lagrange_result_t) :: lagrange
    real(wp), allocatable :: load(:), speeds(:, :), accelerations(:, :)
    integer :: k

    call forces%find_rates(size(positions%states), speeds, accelerations)
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
