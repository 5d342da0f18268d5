!> Equations of motion of a four-bar along its loop-closure curve, under a drive, gravity and all
!! other loads.
module four_bar_rates
  use adaptive_integration, only: rate_system_t
  use constants, only: two_pi
  use applied_loads, only: add_conservative_loads, add_moving_loads, add_prescribed_loads, &
    generalised_force
  use curve_dynamics, only: conservative_torques, curve_dynamics_t, find_inertia
  use drives, only: drive_t
  use errors, only: error_t
  use four_bar_poses, only: find_curve_pose
  use free_friction, only: find_free_friction
  use inertia_loads, only: load_t
  use joint_friction, only: friction_t, has_friction, is_solved
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkages, only: linkage_t
  use load_tables, only: refuse_beyond_tables
  use loop_curves, only: curve_point_t, find_point, loop_curve_t
  use pose_types, only: pose_t
  use rigid_bodies, only: rigid_body_t
  use whole_systems, only: whole_system_t
  implicit none (type, external)
  private

  public :: moving_four_bar_t, rate_number, work_number, unknown_count
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
    type(linkage_t) :: linkage    !! its loads
    type(whole_system_t) :: whole !! its equations, for friction
    type(rigid_body_t), allocatable :: rigid(:) !! (bodies) likewise
    real(wp) :: turns(3) = 0.0_wp !! whole turns not contained in the angle of each link
    integer :: stop = no_stop     !! why rates were last not found
    type(error_t), allocatable :: ended !! the table that ended, when `stop` says so
  contains
    procedure :: find_rates => rates_of_motion
  end type moving_four_bar_t

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

    type(curve_point_t) :: point
    real(wp) :: inertia, slope, speed(3), torque, driving, restoring

    ! Written so that NaN is refused as well.
    found = maxval(abs(state(1:3))) < most_angle .and. abs(state(rate_number)) < most_rate
    if (.not. found) then
      self%stop = stop_too_fast
      return
    end if
    call find_point(self%curve, state(1:3), point, found)
    if (.not. found) then
      self%stop = stop_change_point
      return
    end if
    call find_inertia(self%dynamics, point, inertia, slope)
    found = inertia > least_inertia*sum(self%dynamics%inertia)
    if (.not. found) then
      self%stop = stop_no_inertia
      return
    end if
    speed = point%tangent*state(rate_number)
    torque = self%drive%torque(time, state(1) + two_pi*self%turns(1), speed(1))
    driving = point%tangent(1)*torque + dot_product(self%dynamics%couple, point%tangent)
    restoring = dot_product(conservative_torques(self%dynamics, point), point%tangent)
    if (size(self%linkage%loads) > 0 .or. has_friction(self%linkage)) then
      call add_loads(self, point, state, torque, restoring, driving, found)
      if (.not. found) return
    end if
    rates(1:3) = speed
    rates(rate_number) = (driving + restoring - 0.5_wp*slope*state(rate_number)**2)/inertia
    rates(work_number) = driving*state(rate_number)
  end subroutine rates_of_motion

  !> Adds the generalised forces of springs, dampers, processes and friction along the curve: those
  !! with a potential to the first, all others to the second.
  subroutine add_loads(self, point, state, torque, restoring, driving, found)
    class(moving_four_bar_t), intent(inout) :: self
    type(curve_point_t), intent(in) :: point
    real(wp), intent(in) :: state(:)
    real(wp), intent(in) :: torque                !! of the drive [N m]
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
    integer :: b

    associate (linkage => self%linkage)
      call find_curve_pose(linkage, point, state(1) + two_pi*self%turns(1), pose, per)
      call refuse_beyond_tables(linkage, pose, origin, error)
      found = .not. allocated(error)
      if (.not. found) then
        self%stop = stop_at_end
        call move_alloc(error, self%ended)
        return
      end if
      now = per
      now%turn = state(rate_number)*per%turn
      now%pin = state(rate_number)*per%pin
      spring_force = 0.0_wp
      pin_load = 0.0_wp
      call add_conservative_loads(linkage, pose, of_springs, spring_force)
      call add_prescribed_loads(linkage, pose, origin, body_load, pin_load)
      call add_moving_loads(linkage, pose, origin, now, body_load, pin_load)
      restoring = restoring + generalised_force(linkage, per, of_springs, spring_force)
      driving = driving + generalised_force(linkage, per, body_load, pin_load)
      if (.not. has_friction(linkage)) return
      do b = 1, 3
        body_load(b)%force = body_load(b)%force + of_springs(b)%force
        body_load(b)%moment = body_load(b)%moment + of_springs(b)%moment
      end do
      ! An array constructor would copy no components in gfortran 12.
      allocate (all_per(1))
      all_per(1) = per
      call find_free_friction(self%whole, self%rigid, pose, all_per, now, body_load, &
        pin_load + spring_force, torque, friction)
      found = friction%state == is_solved
      if (.not. found) self%stop = stop_locked
      driving = driving + generalised_force(linkage, per, friction%body_load, friction%pin_load)
    end associate
  end subroutine add_loads

end module four_bar_rates
