!> Equations of motion of any linkage that moves by itself.
!!
!! The first drive is free, and so are those that the deck calls free; the others are held, or
!! geared to the first. The coordinates are those of the free drives, for which groups have closed
!! forms; near dead points, where drives turn back, those of a chart (`motion_charts`). That of a
!! linkage of one loop is the length of its curve (`loop_curves`), along with its angles. With the
!! velocities `h_k` of pins and bodies per rate of coordinate k,
!! `Σ_l M_kl ü_l = Q_k − Σ m h_k·b`, where M_kl is `Σ m h_k·h_l` over all masses, Q_k the loads
!! along h_k, and b the accelerations with the present rates and no ü.
module linkage_rates
  use adaptive_integration, only: rate_system_t
  use applied_load_types, only: deflection
  use applied_loads, only: evaluate_loads
  use block_ends, only: refuse_leaving_block
  use constants, only: degree, two_pi
  use coordinate_types, only: coordinate_t, is_distance, is_sum, twist_t
  use coordinates, only: coordinate_value, evaluated_rate
  use dense_factor, only: dense_factor_t, factorize, solve
  use drives, only: drive_t, refuse_speed
  use errors, only: error_of_dead_point, error_of_reach, error_t, set_error
  use gears, only: driven_by, gear_share, gear_t, reflected_inertia
  use drive_values, only: drive_rate
  use group_factors, only: factorize_groups, group_factors_t
  use kinds, only: wp
  use kinematic_coefficients, only: find_kinematic_coefficients, find_velocities, &
    kinematic_coefficients_t
  use linkage_instants, only: add_accelerations, add_loads, find_inertia, linkage_instant_t, &
    make_room
  use linkages, only: gives_angle, linkage_t, reference_point
  use load_tables, only: refuse_beyond_tables
  use loop_curves, only: curve_point_t, find_point, loop_curve_t
  use loop_poses, only: place_on_curve
  use motion_charts, only: accelerations, find_on_chart, motion_chart_t, velocities
  use motion_switches, only: has_switches, switches_at
  use pose_types, only: count_from, pose_t
  use poses, only: dead_point_sine, place_groups, place_links
  use pull_laws, only: contact_depth
  use rigid_bodies, only: rigid_body_t
  use terminals, only: twists_of
  use whole_systems, only: drive_acceleration, drive_position, drive_row, rate_along, whole_system_t
  implicit none (type, external)
  private

  public :: moving_linkage_t, longest_step, find_instant, free_drives, find_state, &
    place_by_drives, find_rates_of_coordinates, all_inertia_of, least_inertia_of, &
    inertia_share, rate_of_drive
  public :: no_stop, stop_change_point, stop_no_inertia, stop_too_fast, stop_steps, &
    stop_many_steps, stop_misfit, stop_energy, stop_at_end, stop_locked

  !> Why a motion stops.
  integer, parameter :: no_stop = 0
  integer, parameter :: stop_change_point = 1
  integer, parameter :: stop_no_inertia = 2 !! nothing with a mass moves: there are no rates
  integer, parameter :: stop_too_fast = 3   !! links move too fast to have rates
  integer, parameter :: stop_steps = 4      !! steps have become too short
  integer, parameter :: stop_many_steps = 5
  integer, parameter :: stop_misfit = 6     !! redundant links do not fit
  integer, parameter :: stop_energy = 7     !! energies do not balance
  integer, parameter :: stop_at_end = 8     !! a block leaves its link, or a table ends
  integer, parameter :: stop_locked = 9     !! no acceleration balances friction

  !> Steps begin with an angle of the first drive from −π to π: a trial step beyond `most_angle` is
  !! too long, whatever its estimated error [rad]. `most_rate` is beyond any mechanics, but short of
  !! overflow.
  real(wp), parameter :: most_angle = 9.0_wp, most_rate = 1.0e100_wp

  !> Within a turn of half a radian the cubic of a depth is right to the hundredth of its rise that
  !! `advance` allows for [rad].
  real(wp), parameter :: most_turn = 0.5_wp

  !> There are no rates where the scaled determinant of M is below this.
  real(wp), parameter :: least_inertia = 1.0e-13_wp

  !> A linkage in motion. Its state: coordinates of the free drives [rad] or [m], or of the chart
  !! [m], their rates, the work done so far by the drive and all loads without a potential [J]. That
  !! of a loop has its three angles for one coordinate, whose rate ṡ follows.
  type, extends(rate_system_t) :: moving_linkage_t
    type(whole_system_t) :: whole
    type(rigid_body_t), allocatable :: rigid(:) !! (bodies)
    integer, allocatable :: free(:)             !! numbers of the free drives; the first is 1
    class(drive_t), allocatable :: drive        !! torque or force on the first drive
    type(gear_t) :: gear                        !! between them, with the rotor
    logical :: by_drives = .true.               !! the state has the coordinates of the drives
    real(wp) :: turned = 0.0_wp                 !! whole turns of the first drive that its
                                                !! coordinate in the state does not contain [deg]
    real(wp) :: period = 0.0_wp                 !! of the positions [deg]; 0: none
    type(pose_t) :: pose                        !! the last one, from `reference_point`: a start for
                                                !! iterations
    type(motion_chart_t) :: chart               !! whose coordinates the state has else
    type(loop_curve_t), allocatable :: loop     !! whose angles it has in place of both
    real(wp) :: turns(3) = 0.0_wp               !! whole turns that these do not contain
    real(wp) :: all_inertia = 0.0_wp            !! of a loop, `all_inertia_of` it [kg m²]
    type(linkage_instant_t), allocatable, private :: instant !! the last one: room for the next
    real(wp), allocatable :: seen(:)            !! state that it is of,
    logical :: is_seen = .false.                !! if of any
    logical :: has_loads = .true.               !! besides weights and constant forces on pins
    integer :: stop = no_stop                   !! why rates were last not found
    type(error_t), allocatable :: left          !! the block that left its link, or the table
                                                !! that ended, when `stop` says so
  contains
    procedure :: find_rates => rates_of_motion
    procedure :: switches => switches_of_motion
    procedure :: contacts => contacts_of_motion
  end type moving_linkage_t

contains

  !> Numbers of the drives that are free: the first, and those that are marked.
  pure function free_drives(is_free) result(free)
    logical, intent(in) :: is_free(:)  !! (drives) marked in the deck
    integer, allocatable :: free(:)

    integer :: i

    free = pack([(i, i=1, size(is_free))], [.true., is_free(2:)])
  end function free_drives

  !> Pose, velocities per rate of coordinate, velocities and accelerations without ü at a state.
  subroutine find_state(self, state, instant, found, left, is_crossing, time)
    class(moving_linkage_t), intent(in) :: self
    real(wp), intent(in) :: state(:)    !! coordinates, rates, work
    type(linkage_instant_t), intent(inout) :: instant !! new, or of another state
    logical, intent(out) :: found       !! the coordinates reach so far
    type(error_t), allocatable, intent(out), optional :: left !! else the block that leaves its
                                                              !! link, or the table that ends
    logical, intent(out), optional :: is_crossing !! a loop is at a change point
    real(wp), intent(in), optional :: time !! of the pose, where loads are wanted [s]

    type(dense_factor_t) :: factor
    type(error_t), allocatable :: error
    type(group_factors_t), allocatable :: factors(:)
    real(wp) :: direction(size(self%free))
    type(curve_point_t) :: point
    integer :: f, k

    if (present(is_crossing)) is_crossing = .false.
    f = size(self%free)
    associate (linkage => self%whole%linkage, pose => instant%pose, now => instant%motion)
      if (allocated(self%loop)) then
        call find_point(self%loop, state(1:3), point, found)
        if (present(is_crossing)) is_crossing = .not. found
        if (.not. found) return
        if (.not. allocated(instant%per)) allocate (instant%per(1))
        call place_on_curve(linkage, self%loop%four_bar, point, state(1) + two_pi*self%turns(1), &
          state(4), pose, instant%per(1), now)
        call refuse_loads(linkage, instant, error, time)
        found = .not. allocated(error)
        if (present(left)) call move_alloc(error, left)
        return
      end if
      if (allocated(instant%per)) deallocate (instant%per)
      if (.not. self%by_drives) then
        call find_on_chart(self%whole, self%chart, state(:f), pose, factor, found)
        if (.not. found) return
        pose%crank = drive_position(self%whole, pose, 1, self%chart%crank)
        call refuse_leaving_block(linkage, pose, error)
        if (.not. allocated(error)) call refuse_loads(linkage, instant, error, time)
        found = .not. allocated(error)
        if (present(left)) call move_alloc(error, left)
        if (.not. found) return
        call velocities(self%whole, self%chart, factor, instant%per)
        call accelerations(self%whole, self%chart, factor, pose, instant%per, state(f + 1:2*f), now)
        return
      end if
      call place_by_drives(self, state(:f), pose, error)
      found = .not. allocated(error)
      if (present(left) .and. .not. found) then
        if (error%place%pin > 0) call move_alloc(error, left)
      end if
      if (.not. found) return
      pose%crank = state(1)
      if (gives_angle(linkage%drives(1))) pose%crank = state(1)/degree + self%turned
      call refuse_loads(linkage, instant, error, time)
      found = .not. allocated(error)
      if (present(left) .and. .not. found) call move_alloc(error, left)
      if (.not. found) return
      call factorize_groups(linkage, pose, factors)
      now = find_kinematic_coefficients(linkage, pose, rates_of_drives(self, state(f + 1:2*f)), &
        factors)
      allocate (instant%per(f))
      do k = 1, f
        direction = 0.0_wp
        direction(k) = 1.0_wp
        call find_velocities(linkage, pose, rates_of_drives(self, direction), instant%per(k), &
          factors)
      end do
    end associate
  end subroutine find_state

  !> Evaluates the coordinates of loads, and refuses a pose where these end; it gets its time.
  pure subroutine refuse_loads(linkage, instant, error, time)
    type(linkage_t), intent(in) :: linkage
    type(linkage_instant_t), intent(inout) :: instant
    type(error_t), allocatable, intent(inout) :: error
    real(wp), intent(in), optional :: time !! [s]

    instant%pose%has_time = present(time)
    if (present(time)) instant%pose%time = time
    call evaluate_loads(linkage, instant%pose, instant%along)
    call refuse_beyond_tables(linkage, instant%pose, instant%along, error)
  end subroutine refuse_loads

  !> The last instant becomes that of a state: with pose and velocities at least.
  subroutine look_at(self, state, found)
    class(moving_linkage_t), intent(inout) :: self
    real(wp), intent(in) :: state(:) !! coordinates, rates, work
    logical, intent(out) :: found    !! as of `find_state`

    type(linkage_instant_t), allocatable :: instant

    found = self%is_seen
    if (found) found = all(abs(self%seen - state) <= 0.0_wp)
    if (found) return
    call take_room(self, instant)
    call find_state(self, state, instant, found)
    call move_alloc(instant, self%instant)
    self%seen = state
    self%is_seen = found
  end subroutine look_at

  !> Room for an instant: that of the last one, which is no more.
  subroutine take_room(self, instant)
    class(moving_linkage_t), intent(inout) :: self
    type(linkage_instant_t), allocatable, intent(out) :: instant

    self%is_seen = .false.
    if (allocated(self%instant)) then
      call move_alloc(self%instant, instant)
    else
      allocate (instant)
    end if
  end subroutine take_room

  !> The pose at coordinates of the free drives.
  !!
  !! Errors: out of reach; dead points; iterations that do not converge; a block leaves its link.
  subroutine place_by_drives(self, coordinates, pose, error)
    class(moving_linkage_t), intent(in) :: self
    real(wp), intent(in) :: coordinates(:) !! (free drives) [rad] or [m]
    type(pose_t), intent(out) :: pose      !! pins from `reference_point`
    type(error_t), allocatable, intent(out) :: error !! why there is none

    type(linkage_t) :: linkage
    real(wp) :: crank, correction
    integer :: i

    crank = coordinates(1)
    if (gives_angle(self%whole%linkage%drives(1))) then
      if (.not. abs(crank) < most_angle) then
        call set_error(error, error_of_reach, "the step is too long")
        return
      end if
      crank = crank/degree
      if (self%period > 0.0_wp) then
        crank = crank + modulo(self%turned, self%period)
      else
        crank = crank + self%turned
      end if
    end if
    if (size(self%free) == 1) then
      call place_links(self%whole%linkage, crank, pose, error)
      if (.not. allocated(error)) call count_from(reference_point(self%whole%linkage), pose)
    else
      linkage = self%whole%linkage
      do i = 2, size(self%free)
        associate (drive => linkage%drives(self%free(i)))
          drive%ratio = 0.0_wp
          drive%phase = coordinates(i)
          if (gives_angle(drive)) drive%phase = coordinates(i)/degree
        end associate
      end do
      pose = self%pose
      call place_groups(linkage, crank, pose, correction, error)
      if (.not. allocated(error)) call refuse_leaving_block(linkage, pose, error)
    end if
    if (allocated(error)) return
    if (allocated(pose%coefficients)) return
    if (.not. all(abs(pose%sine) > dead_point_sine)) call set_error(error, error_of_dead_point, &
      "dead point")
  end subroutine place_by_drives

  !> Rates of all drives from those of the free ones: the others are held or geared to the first.
  pure function rates_of_drives(self, rates) result(all_rates)
    class(moving_linkage_t), intent(in) :: self
    real(wp), intent(in) :: rates(:) !! (free drives)
    real(wp) :: all_rates(size(self%whole%linkage%drives))

    integer :: i

    all_rates = [(drive_rate(self%whole%linkage, i)*rates(1), i=1, size(all_rates))]
    all_rates(self%free) = rates
  end function rates_of_drives

  !> Rate of a drive's coordinate [rad/s] or [m/s].
  pure function rate_of_drive(self, pose, now, drive) result(rate)
    class(moving_linkage_t), intent(in) :: self
    type(pose_t), intent(in) :: pose                 !! of `find_state`
    type(kinematic_coefficients_t), intent(in) :: now !! likewise
    integer, intent(in) :: drive                     !! number, from 1
    real(wp) :: rate

    if (allocated(self%loop)) then
      rate = now%turn(1)
    else
      rate = rate_along(self%whole, drive_row(self%whole, pose, drive), now%turn, now%pin)
    end if
  end function rate_of_drive

  !> Rates of the coordinates at which the free drives have given rates.
  subroutine find_rates_of_coordinates(self, rates, state)
    class(moving_linkage_t), intent(in) :: self
    real(wp), intent(in) :: rates(:)     !! (free drives) [rad/s] or [m/s]
    real(wp), intent(inout) :: state(:)  !! coordinates 0; gets rates

    type(linkage_instant_t) :: instant
    type(dense_factor_t) :: factor
    real(wp) :: by(size(rates), size(rates))
    logical :: found
    integer :: f, k, l

    f = size(rates)
    call find_state(self, state, instant, found)
    do k = 1, f
      do l = 1, f
        by(k, l) = rate_of_drive(self, instant%pose, instant%per(l), self%free(k))
      end do
    end do
    call factorize(by, factor)
    state(f + 1:2*f) = solve(factor, rates)
  end subroutine find_rates_of_coordinates

  !> Rates of the state. Not found beyond the chart, and where nothing with a mass moves; `stop`
  !! gives the reason.
  subroutine rates_of_motion(self, time, state, rates, found)
    class(moving_linkage_t), intent(inout) :: self
    real(wp), intent(in) :: time      !! [s]
    real(wp), intent(in) :: state(:)  !! coordinates, rates, work
    real(wp), intent(out) :: rates(:) !! of the state; defined only if found
    logical, intent(out) :: found     !! false: `stop` is set

    type(linkage_instant_t), allocatable :: instant
    integer :: f

    f = size(self%free)
    rates = 0.0_wp
    call take_room(self, instant)
    call find_instant(self, time, state, instant, found)
    call move_alloc(instant, self%instant)
    if (.not. found) return
    self%seen = state
    self%is_seen = .true.
    associate (instant => self%instant)
      if (allocated(self%loop)) then
        rates = [instant%motion%turn(self%loop%four_bar%body), instant%acceleration, &
          instant%power]
        return
      end if
      rates(:f) = state(f + 1:2*f)
      rates(f + 1:2*f) = instant%acceleration
      rates(2*f + 1) = instant%power
    end associate
  end subroutine rates_of_motion

  !> Arguments of the loads that turn over with the motion.
  function switches_of_motion(self, state) result(switches)
    class(moving_linkage_t), intent(inout) :: self
    real(wp), intent(in) :: state(:)        !! coordinates, rates, work
    real(wp), allocatable :: switches(:, :) !! as of `switches_at`; empty: none, or no position

    logical :: found

    allocate (switches(2, 0))
    if (.not. has_switches(self%whole%linkage, self%gear)) return
    call look_at(self, state, found)
    if (.not. found) return
    associate (pose => self%instant%pose, now => self%instant%motion)
      switches = switches_at(self%whole%linkage, pose, self%instant%along, now, self%gear, &
        rate_of_drive(self, pose, now, 1))
    end associate
  end function switches_of_motion

  !> The longest step in which the course of contacts is seen: no body turns, and no line between
  !! the ends of a distance, by more than `most_turn`; huge without contacts [s].
  function longest_step(self, state) result(step)
    class(moving_linkage_t), intent(inout) :: self
    real(wp), intent(in) :: state(:) !! coordinates, rates, work
    real(wp) :: step

    real(wp) :: turn
    logical :: found
    integer :: i

    step = huge(step)
    if (all(self%whole%linkage%loads%law%side == 0)) return
    call look_at(self, state, found)
    if (.not. found) return
    associate (linkage => self%whole%linkage, pose => self%instant%pose, now => self%instant%motion)
      turn = maxval(abs(now%turn))
      do i = 1, size(linkage%loads)
        if (linkage%loads(i)%law%side /= 0) turn = max(turn, line_turn(linkage, pose, now, &
          linkage%loads(i)%along))
      end do
    end associate
    if (turn > 0.0_wp) step = most_turn/turn
  end function longest_step

  !> A bound of how fast the line between the ends of a distance turns, of a sum the greatest of its
  !! terms; 0 of other coordinates [rad/s].
  pure recursive function line_turn(linkage, pose, now, coordinate) result(turn)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(kinematic_coefficients_t), intent(in) :: now
    type(coordinate_t), intent(in) :: coordinate
    real(wp) :: turn

    ! Ends that meet make no step vanish.
    real(wp), parameter :: least = 1.0e-3_wp
    type(twist_t) :: twist(2)
    integer :: i

    turn = 0.0_wp
    if (coordinate%kind == is_sum) then
      do i = 1, size(coordinate%term)
        turn = max(turn, line_turn(linkage, pose, now, linkage%coordinates(coordinate%term(i))))
      end do
    end if
    if (coordinate%kind /= is_distance) return
    twist = twists_of(linkage, pose, now, coordinate%at)
    turn = norm2(twist(2)%velocity - twist(1)%velocity)/max(coordinate_value(linkage, pose, &
      coordinate), least*maxval(linkage%bodies%length))
  end function line_turn

  !> How deep stops and springs of one side are pressed.
  function contacts_of_motion(self, state) result(contacts)
    class(moving_linkage_t), intent(inout) :: self
    real(wp), intent(in) :: state(:)        !! coordinates, rates, work
    real(wp), allocatable :: contacts(:, :) !! (3, contacts) depth, its rate, width; empty: none, or
                                            !! no position

    logical :: found
    integer :: i, n

    n = count(self%whole%linkage%loads%law%side /= 0)
    if (n > 0) then
      call look_at(self, state, found)
      if (.not. found) n = 0
    end if
    allocate (contacts(3, n))
    if (n == 0) return
    n = 0
    associate (linkage => self%whole%linkage, at => self%instant)
      do i = 1, size(linkage%loads)
        associate (load => linkage%loads(i), along => at%along(i))
          if (load%law%side == 0) cycle
          n = n + 1
          contacts(:, n) = [contact_depth(load%law, deflection(load, along%value), &
            evaluated_rate(linkage, at%pose, at%motion, load%along, along)), load%law%contact]
        end associate
      end do
    end associate
  end function contacts_of_motion

  !> The motion at a state: ü, motor, gear and loads.
  subroutine find_instant(self, time, state, instant, found)
    class(moving_linkage_t), intent(inout) :: self
    real(wp), intent(in) :: time      !! [s]
    real(wp), intent(in) :: state(:)  !! coordinates, rates, work
    type(linkage_instant_t), intent(inout) :: instant !! new, or another one of this motion
    logical, intent(out) :: found     !! as of `rates_of_motion`

    real(wp) :: torque

    call move_to_state(self, time, state, instant, found)
    if (.not. found) return
    call make_room(instant, size(self%free), size(self%rigid))
    call find_first_drive(self, time, state, instant, found)
    if (.not. found) return
    call find_inertia(self%whole%linkage, self%rigid, instant%pose, instant%motion, instant%per, &
      instant%inertia, instant%right)
    call find_accelerations(self, instant, torque, found)
    if (.not. found) return
    associate (rates => state(size(state) - size(self%free):size(state) - 1))
      instant%driving = instant%driving - (torque - instant%driven%torque)*instant%first%per
      instant%load_power = dot_product(instant%loading, rates)
      instant%power = dot_product(instant%driving, rates) + instant%driven%to_rotor
    end associate
    call add_accelerations(instant)
  end subroutine find_instant

  !> Pose and velocities of a state; `stop` says why there are none.
  subroutine move_to_state(self, time, state, instant, found)
    class(moving_linkage_t), intent(inout) :: self
    real(wp), intent(in) :: time, state(:)
    type(linkage_instant_t), intent(inout) :: instant
    logical, intent(out) :: found

    type(error_t), allocatable :: left
    logical :: is_crossing

    found = maxval(abs(state)) < most_rate
    if (allocated(self%loop)) found = found .and. maxval(abs(state(1:3))) < most_angle
    if (.not. found) then
      self%stop = stop_too_fast
      return
    end if
    call find_state(self, state, instant, found, left, is_crossing, time)
    if (found) return
    self%stop = merge(stop_at_end, stop_steps, allocated(left))
    if (is_crossing) self%stop = stop_change_point
    if (allocated(left)) call move_alloc(left, self%left)
  end subroutine move_to_state

  !> Motion of the first drive and torque of its motor. Not found where the motor has no torque.
  subroutine find_first_drive(self, time, state, instant, found)
    class(moving_linkage_t), intent(inout) :: self
    real(wp), intent(in) :: time, state(:)
    type(linkage_instant_t), intent(inout) :: instant !! with pose and velocities
    logical, intent(out) :: found

    type(error_t), allocatable :: error
    real(wp) :: coordinate
    integer :: k

    associate (first => instant%first, now => instant%motion)
      if (self%by_drives) then
        first%per = 0.0_wp
        first%per(1) = 1.0_wp
        first%rate = state(size(self%free) + 1)
        first%bent = 0.0_wp
        coordinate = state(1)
      else if (allocated(self%loop)) then
        first%per = instant%per(1)%turn(1)
        first%rate = now%turn(1)
        first%bent = now%turn_slope(1)
        coordinate = coordinate_of(self, instant%pose)
      else
        do k = 1, size(first%per)
          first%per(k) = rate_of_drive(self, instant%pose, instant%per(k), 1)
        end do
        first%rate = rate_of_drive(self, instant%pose, now, 1)
        first%bent = drive_acceleration(self%whole, instant%pose, 1, now)
        coordinate = coordinate_of(self, instant%pose)
      end if
      call refuse_speed(self%drive, self%gear%ratio*first%rate, error)
      found = .not. allocated(error)
      if (.not. found) then
        self%stop = stop_at_end
        call move_alloc(error, self%left)
        return
      end if
      first%motor = self%drive%torque(time, self%gear%ratio*coordinate, self%gear%ratio*first%rate)
    end associate
  end subroutine find_first_drive

  !> ü, with the losses in the gear.
  !!
  !! The torque through the gear depends on ü, and the losses in the gear on its sign. With either
  !! losses it has the same sign, so that a second trial at most finds those that there are: of M, Q
  !! and the motor's torque Tm per coordinate of the driven body it is that of `M Tm − J n Q`.
  !! Friction in joints may disturb this; then the losses of the second trial count.
  subroutine find_accelerations(self, instant, torque, found)
    class(moving_linkage_t), intent(inout) :: self
    type(linkage_instant_t), intent(inout) :: instant !! with M, Q and the first drive
    real(wp), intent(out) :: torque !! on the first drive, but for the rotor [N m] or [N]
    logical, intent(out) :: found

    real(wp) :: through
    integer :: trial

    through = instant%first%motor
    do trial = 1, 2
      call solve_trial(self, through, instant, torque, found)
      if (.not. found) return
      if (self%gear%efficiency >= 1.0_wp) return
      if (through >= 0.0_wp .eqv. instant%driven%through >= 0.0_wp) return
      through = instant%driven%through
    end do
  end subroutine find_accelerations

  !> ü with the losses of a torque through the gear, of which only the sign counts.
  subroutine solve_trial(self, through, instant, torque, found)
    class(moving_linkage_t), intent(inout) :: self
    real(wp), intent(in) :: through                   !! [N m]
    type(linkage_instant_t), intent(inout) :: instant
    real(wp), intent(out) :: torque                   !! on the first drive, but for the rotor
    logical, intent(out) :: found

    type(dense_factor_t) :: factor
    real(wp) :: share, reflected
    integer :: k

    associate (gear => self%gear, first => instant%first)
      share = gear_share(gear, first%rate, through)
      reflected = reflected_inertia(gear, share)
      torque = gear%ratio*share*first%motor
      do k = 1, size(first%per)
        instant%with_rotor(:, k) = instant%inertia(:, k) + reflected*first%per(k)*first%per
      end do
      if (allocated(self%loop)) then
        found = instant%with_rotor(1, 1) > least_inertia*self%all_inertia
      else
        call factorize(instant%with_rotor, factor)
        found = abs(factor%determinant) > least_inertia
      end if
      if (.not. found) then
        self%stop = stop_no_inertia
        return
      end if
      instant%driving = torque*first%per
      instant%loading = 0.0_wp
      instant%all_right = instant%right
      if (self%has_loads) call add_loads(self%whole, self%rigid, torque, reflected, instant, found)
      if (.not. found) then
        self%stop = stop_locked
        return
      end if
      instant%all_right = instant%all_right + instant%driving - (reflected*first%bent)*first%per
      if (allocated(self%loop)) then
        instant%acceleration(1) = instant%all_right(1)/instant%with_rotor(1, 1)
      else
        instant%acceleration = solve(factor, instant%all_right)
      end if
      instant%driven = driven_by(gear, first%motor, share, first%rate, first%bent + &
        dot_product(first%per, instant%acceleration))
    end associate
  end subroutine solve_trial

  !> Coordinate of the first drive, with all whole turns [rad] or [m].
  pure function coordinate_of(self, pose) result(coordinate)
    class(moving_linkage_t), intent(in) :: self
    type(pose_t), intent(in) :: pose
    real(wp) :: coordinate

    coordinate = pose%crank
    if (.not. allocated(self%loop)) coordinate = drive_position(self%whole, pose, 1, &
      self%chart%crank)
    if (gives_angle(self%whole%linkage%drives(1))) coordinate = coordinate*degree
  end function coordinate_of

  !> The least inertia of the coordinates, as a share of all masses [-].
  subroutine inertia_share(self, state, share)
    class(moving_linkage_t), intent(in) :: self
    real(wp), intent(in) :: state(:) !! coordinates, rates, work
    real(wp), intent(out) :: share

    share = 0.0_wp
    if (all_inertia_of(self) > 0.0_wp) share = least_inertia_of(self, state)/all_inertia_of(self)
  end subroutine inertia_share

  !> The least inertia of the coordinates at a state, with that of the rotor; 0 where there is no
  !! position [kg] or [kg m²].
  function least_inertia_of(self, state) result(least)
    class(moving_linkage_t), intent(in) :: self
    real(wp), intent(in) :: state(:) !! coordinates, rates, work
    real(wp) :: least

    type(linkage_instant_t) :: at
    real(wp) :: inertia(size(self%free), size(self%free)), right(size(self%free))
    logical :: found
    integer :: k

    least = 0.0_wp
    call find_state(self, state, at, found)
    if (.not. found) return
    call find_inertia(self%whole%linkage, self%rigid, at%pose, at%motion, at%per, inertia, right)
    do k = 1, size(right)
      inertia(k, k) = inertia(k, k) + self%gear%ratio**2*self%gear%rotor*rate_of_drive(self, &
        at%pose, at%per(k), 1)**2
    end do
    least = minval([(inertia(k, k), k=1, size(right))])
  end function least_inertia_of

  !> All masses, and moments of inertia as masses at the length of their bodies, the rotor's at
  !! that of the first [kg]; of a loop all masses as moments of inertia at these lengths [kg m²].
  pure function all_inertia_of(self) result(all)
    class(moving_linkage_t), intent(in) :: self
    real(wp) :: all

    associate (scale => self%whole%scale, linkage => self%whole%linkage, &
        rotor => self%gear%ratio**2*self%gear%rotor)
      if (allocated(self%loop)) then
        all = sum(self%rigid%mass*scale**2 + self%rigid%inertia) + &
          sum(linkage%pin_mass)*maxval(scale)**2 + rotor
      else
        all = sum(self%rigid%mass + self%rigid%inertia/scale**2) + sum(linkage%pin_mass) + &
          rotor/scale(1)**2
      end if
    end associate
  end function all_inertia_of

end module linkage_rates
