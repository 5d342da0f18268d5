!> Equations of motion of a four-bar along its loop-closure curve, under a drive, gravity and all
!! other loads.
module four_bar_rates
  use adaptive_integration, only: rate_system_t
  use constants, only: two_pi
  use applied_loads, only: add_conservative_loads, add_moving_loads, add_prescribed_loads, &
    generalised_force
  use curve_dynamics, only: conservative_torques, curve_dynamics_t, find_inertia
  use drives, only: drive_t, refuse_speed
  use errors, only: error_t
  use four_bar_poses, only: find_curve_pose
  use free_friction, only: find_free_friction
  use gears, only: driven_by, driven_t, gear_share, gear_t, reflected_inertia
  use inertia_loads, only: load_t
  use joint_friction, only: friction_t, has_friction, is_solved
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkages, only: linkage_t
  use load_tables, only: refuse_beyond_tables
  use loop_curves, only: curve_point_t, find_point, loop_curve_t
  use motion_switches, only: has_switches, switches_at
  use pose_types, only: pose_t
  use rigid_bodies, only: rigid_body_t
  use whole_systems, only: whole_system_t
  implicit none (type, external)
  private

  public :: moving_four_bar_t, four_bar_instant_t, find_instant, rate_number, work_number, &
    unknown_count
  public :: no_stop, stop_change_point, stop_no_inertia, stop_too_fast, stop_steps, &
    stop_many_steps, stop_at_end, stop_locked

  !> Why a motion stops. For reasons 1 to 3, where a table ends, and where no acceleration balances
  !! friction, there are no rates.
  integer, parameter :: no_stop = 0, stop_change_point = 1, stop_no_inertia = 2, &
    stop_too_fast = 3, stop_steps = 4, stop_many_steps = 5, stop_at_end = 6, &
    stop_locked = 7

  !> Steps begin with angles from −π to π: a trial step beyond `most_angle` is too long, whatever
  !! its estimated error [rad]. `most_rate` is beyond any mechanics, but short of overflow [rad/s].
  real(wp), parameter :: most_angle = 9.0_wp, most_rate = 1.0e100_wp

  !> There are no rates where M is below this share of the inertia of all links.
  real(wp), parameter :: least_inertia = 1.0e-13_wp

  !> Numbers of the unknowns that follow the three angles [rad]: rate ṡ [rad/s] and work [J]; total
  !! number of unknowns.
  integer, parameter :: rate_number = 4, work_number = 5, unknown_count = 5

  !> A four-bar in motion: all that its rates depend on.
  type, extends(rate_system_t) :: moving_four_bar_t
    type(loop_curve_t) :: curve
    type(curve_dynamics_t) :: dynamics
    class(drive_t), allocatable :: drive
    type(gear_t) :: gear          !! from the drive to the crank, with its rotor
    type(linkage_t) :: linkage    !! its loads
    type(whole_system_t) :: whole !! its equations, for friction
    type(rigid_body_t), allocatable :: rigid(:) !! (bodies) likewise
    real(wp) :: turns(3) = 0.0_wp !! whole turns not contained in the angle of each link
    integer :: stop = no_stop     !! why rates were last not found
    type(error_t), allocatable :: ended !! the table that ended, when `stop` says so
  contains
    procedure :: find_rates => rates_of_motion
    procedure :: switches => switches_of_motion
  end type moving_four_bar_t

  !> A four-bar at an instant of its motion.
  type :: four_bar_instant_t
    type(curve_point_t) :: point
    real(wp) :: rate = 0.0_wp          !! s̈ [rad/s²]
    type(driven_t) :: driven           !! motor and gear
    real(wp) :: driving = 0.0_wp       !! of drive and loads without a potential, along the curve
                                       !! [N m]
    real(wp) :: loading = 0.0_wp       !! of these loads alone [N m]
    type(load_t) :: body_load(3)       !! of all loads of the linkage, but for weights, constant
                                       !! forces on pins and constant torques
    real(wp), allocatable :: pin_load(:, :) !! (2, pins) likewise; not allocated: there are none [N]
  end type four_bar_instant_t

contains

  !> Rates of the unknowns: angular velocities, s̈ from `M s̈ = Q_s − ½ M' ṡ²`, and the power of the
  !! drive and of loads without a potential.
  !!
  !! Not found at a change point, where M vanishes, beyond `most_angle` and `most_rate`, and beyond
  !! the end of a table; `stop` gives the reason.
  subroutine rates_of_motion(self, time, state, rates, found)
    class(moving_four_bar_t), intent(inout) :: self
    real(wp), intent(in) :: time      !! [s]
    real(wp), intent(in) :: state(:)  !! θ2, θ3, θ4, ṡ, work
    real(wp), intent(out) :: rates(:) !! of the state; defined only if found
    logical, intent(out) :: found     !! false: `stop` is set

    type(four_bar_instant_t) :: instant

    call find_instant(self, time, state, instant, found)
    if (.not. found) return
    rates(1:3) = instant%point%tangent*state(rate_number)
    rates(rate_number) = instant%rate
    rates(work_number) = instant%driving*state(rate_number) + instant%driven%to_rotor
  end subroutine rates_of_motion

  !> Arguments of the loads that turn over with the motion.
  function switches_of_motion(self, state) result(switches)
    class(moving_four_bar_t), intent(in) :: self
    real(wp), intent(in) :: state(:)        !! θ2, θ3, θ4, ṡ, work
    real(wp), allocatable :: switches(:, :) !! as of `switches_at`; empty: none, or no position

    type(curve_point_t) :: point
    type(pose_t) :: pose
    type(kinematic_coefficients_t) :: per, now
    logical :: found

    allocate (switches(2, 0))
    if (.not. has_switches(self%linkage, self%gear)) return
    call find_point(self%curve, state(1:3), point, found)
    if (.not. found) return
    call find_state(self, state, point, pose, per, now)
    switches = switches_at(self%linkage, pose, now, self%gear, now%turn(1))
  end function switches_of_motion

  !> Pose, velocities per ṡ and velocities at a point of the curve.
  subroutine find_state(self, state, point, pose, per, now)
    class(moving_four_bar_t), intent(in) :: self
    real(wp), intent(in) :: state(:)
    type(curve_point_t), intent(in) :: point
    type(pose_t), intent(out) :: pose
    type(kinematic_coefficients_t), intent(out) :: per, now

    call find_curve_pose(self%linkage, point, state(1) + two_pi*self%turns(1), pose, per)
    now = per
    now%turn = state(rate_number)*per%turn
    now%pin = state(rate_number)*per%pin
  end subroutine find_state

  !> The motion at a state: s̈, motor, gear and loads.
  !!
  !! The torque through the gear depends on s̈, and the losses in the gear on its sign. With either
  !! losses it has the same sign, so that a second trial at most finds those that there are: of M, Q
  !! and the motor's torque Tm per coordinate of the driven body it is that of `M Tm − J n Q`.
  !! Friction in joints may disturb this; then the losses of the second trial count.
  subroutine find_instant(self, time, state, instant, found)
    class(moving_four_bar_t), intent(inout) :: self
    real(wp), intent(in) :: time      !! [s]
    real(wp), intent(in) :: state(:)  !! θ2, θ3, θ4, ṡ, work
    type(four_bar_instant_t), intent(out) :: instant
    logical, intent(out) :: found     !! as of `rates_of_motion`

    real(wp) :: inertia, slope, speed(3), torque, driving, restoring, motor, share, reflected, &
      through
    type(error_t), allocatable :: error
    integer :: trial

    ! Written so that NaN is refused as well.
    found = maxval(abs(state(1:3))) < most_angle .and. abs(state(rate_number)) < most_rate
    if (.not. found) then
      self%stop = stop_too_fast
      return
    end if
    associate (point => instant%point)
      call find_point(self%curve, state(1:3), point, found)
      if (.not. found) then
        self%stop = stop_change_point
        return
      end if
      call find_inertia(self%dynamics, point, inertia, slope)
      found = inertia + self%gear%ratio**2*self%gear%rotor*point%tangent(1)**2 > &
        least_inertia*(sum(self%dynamics%inertia) + self%gear%ratio**2*self%gear%rotor)
      if (.not. found) then
        self%stop = stop_no_inertia
        return
      end if
      speed = point%tangent*state(rate_number)
      call refuse_speed(self%drive, self%gear%ratio*speed(1), error)
      found = .not. allocated(error)
      if (.not. found) then
        self%stop = stop_at_end
        call move_alloc(error, self%ended)
        return
      end if
      motor = self%drive%torque(time, self%gear%ratio*(state(1) + two_pi*self%turns(1)), &
        self%gear%ratio*speed(1))
      through = motor
      do trial = 1, 2
        share = gear_share(self%gear, speed(1), through)
        reflected = reflected_inertia(self%gear, share)
        torque = self%gear%ratio*share*motor
        instant%loading = dot_product(self%dynamics%couple, point%tangent)
        driving = point%tangent(1)*torque + instant%loading
        restoring = dot_product(conservative_torques(self%dynamics, point), point%tangent)
        if (size(self%linkage%loads) > 0 .or. has_friction(self%linkage)) then
          call add_loads(self, state, torque, reflected, instant, restoring, driving, found)
          if (.not. found) return
        end if
        instant%rate = (driving + restoring - (0.5_wp*slope + reflected*point%tangent(1)* &
          point%tangent_slope(1))*state(rate_number)**2)/(inertia + reflected*point%tangent(1)**2)
        instant%driven = driven_by(self%gear, motor, share, speed(1), point%tangent(1)* &
          instant%rate + point%tangent_slope(1)*state(rate_number)**2)
        instant%driving = driving - point%tangent(1)*(torque - instant%driven%torque)
        if (self%gear%efficiency >= 1.0_wp) exit
        if (through >= 0.0_wp .eqv. instant%driven%through >= 0.0_wp) exit
        through = instant%driven%through
      end do
    end associate
  end subroutine find_instant

  !> Adds the generalised forces of springs, dampers, processes and friction along the curve: those
  !! with a potential to the first, all others to the second and to the loading of the instant,
  !! which gets the loads themselves, too.
  subroutine add_loads(self, state, torque, reflected, instant, restoring, driving, found)
    class(moving_four_bar_t), intent(inout) :: self
    real(wp), intent(in) :: state(:)
    real(wp), intent(in) :: torque                !! of the drive, but for the rotor [N m]
    real(wp), intent(in) :: reflected             !! its inertia on the crank [kg m²]
    type(four_bar_instant_t), intent(inout) :: instant
    real(wp), intent(inout) :: restoring, driving !! [N m]
    logical, intent(out) :: found                 !! false: a table has ended, or joints lock;
                                                  !! `stop` is set

    type(pose_t) :: pose
    type(kinematic_coefficients_t) :: per, now
    type(kinematic_coefficients_t), allocatable :: all_per(:)
    type(load_t) :: body_load(3), of_springs(3)
    real(wp), dimension(2, size(self%linkage%is_ground)) :: pin_load, spring_force
    type(error_t), allocatable :: error
    type(friction_t) :: friction
    real(wp), parameter :: origin(2) = 0.0_wp
    real(wp) :: added
    integer :: b

    associate (linkage => self%linkage, point => instant%point)
      call find_state(self, state, point, pose, per, now)
      call refuse_beyond_tables(linkage, pose, origin, error)
      found = .not. allocated(error)
      if (.not. found) then
        self%stop = stop_at_end
        call move_alloc(error, self%ended)
        return
      end if
      spring_force = 0.0_wp
      pin_load = 0.0_wp
      call add_conservative_loads(linkage, pose, of_springs, spring_force)
      call add_prescribed_loads(linkage, pose, origin, body_load, pin_load)
      call add_moving_loads(linkage, pose, origin, now, body_load, pin_load)
      restoring = restoring + generalised_force(linkage, per, of_springs, spring_force)
      added = generalised_force(linkage, per, body_load, pin_load)
      driving = driving + added
      instant%loading = instant%loading + added
      do b = 1, 3
        body_load(b)%force = body_load(b)%force + of_springs(b)%force
        body_load(b)%moment = body_load(b)%moment + of_springs(b)%moment
      end do
      pin_load = pin_load + spring_force
      if (has_friction(linkage)) then
        ! An array constructor would leak the memory of components in gfortran 12.
        allocate (all_per(1))
        all_per(1) = per
        call find_free_friction(self%whole, self%rigid, pose, all_per, now, body_load, pin_load, &
          torque, friction, reflected)
        found = friction%state == is_solved
        if (.not. found) self%stop = stop_locked
        added = generalised_force(linkage, per, friction%body_load, friction%pin_load)
        driving = driving + added
        instant%loading = instant%loading + added
        do b = 1, 3
          body_load(b)%force = body_load(b)%force + friction%body_load(b)%force
          body_load(b)%moment = body_load(b)%moment + friction%body_load(b)%moment
        end do
        pin_load = pin_load + friction%pin_load
      end if
      instant%body_load = body_load
      instant%pin_load = pin_load
    end associate
  end subroutine add_loads

end module four_bar_rates
