!> Forces of the drives, of the motor and of the joints of a linkage over its cycle.
module cycle_forces
  use constants, only: degree
  use elastic_reactions, only: elastic_division_t
  use gears, only: gear_share, gear_t, is_direct
  use joint_study, only: bearing_values, bearings_at_speed, drives_at_speed, find_joints, &
    joints_at_speed, joints_result_t
  use drive_values, only: find_rates_of_drives
  use kinds, only: wp
  use linkages, only: gives_angle, linkage_t
  use motion_programs, only: motion_program_t, program_values
  use positions, only: find_positions, find_state, list_positions, positions_t
  implicit none (type, external)
  private

  public :: sizing_request_t, cycle_forces_t, is_timed, of_forces, of_rates, of_powers

  !> What a signal is.
  integer, parameter :: of_forces = 1, of_rates = 2, of_powers = 3

  !> What is asked for.
  type :: sizing_request_t
    real(wp), allocatable :: speed(:)    !! (speeds) of the first drive [rad/s] or [m/s]
    real(wp) :: acceleration = 0.0_wp    !! of the first drive [rad/s²] or [m/s²]
    real(wp) :: fluctuation = 0.0_wp     !! of the speed, that a flywheel is to allow; 0: none is
                                         !! asked for [-]
    type(gear_t) :: gear                 !! between a motor and the first drive
    real(wp), allocatable :: times(:)    !! instants of laws; not allocated: at constant speed [s]
    type(motion_program_t), allocatable :: program !! law of the first drive, which the others
                                         !! follow; not allocated: the linkage runs in time
  end type sizing_request_t

  !> The forces as functions of the place in the cycle: the position of the first drive in degrees,
  !! of laws the time in seconds. They are numbered: drives, the motor if it has a gear or a rotor,
  !! joints; powers of drives and motor have negative numbers.
  type :: cycle_forces_t
    type(linkage_t) :: linkage         !! of any kind, with masses
    integer, allocatable :: elements(:) !! (bodies) on whose nodes the masses are lumped; 0:
                                       !! distributed
    type(sizing_request_t) :: request
    type(elastic_division_t), allocatable :: division !! if elasticity divides forces
  contains
    procedure :: motors
    procedure :: motion_at
    procedure :: positions_at
    procedure :: find_rates
    procedure :: find_joints_at
    procedure :: find_values
    procedure :: value_at
    procedure :: angle_at
  end type cycle_forces_t

contains

  !> Number of motors that differ from what the first drive is: 0 or 1.
  pure function motors(self) result(number)
    class(cycle_forces_t), intent(in) :: self
    integer :: number

    associate (gear => self%request%gear)
      number = merge(0, 1, is_direct(gear) .and. abs(gear%ratio - 1.0_wp) <= 0.0_wp)
    end associate
  end function motors

  !> Whether the cycle is one in time, of laws.
  pure function is_timed(request) result(is)
    type(sizing_request_t), intent(in) :: request
    logical :: is

    is = allocated(request%times)
  end function is_timed

  !> Position, speed and acceleration of what the linkage is moved by: of the first drive, or of the
  !! time.
  pure function motion_at(self, at, number) result(motion)
    class(cycle_forces_t), intent(in) :: self
    real(wp), intent(in) :: at    !! place in the cycle [deg] or [s]
    integer, intent(in) :: number !! of the speed
    real(wp) :: motion(3)         !! [deg, rad/s, rad/s²], [m, m/s, m/s²] or [s, 1, 0]

    if (.not. is_timed(self%request)) then
      motion = [at, self%request%speed(number), self%request%acceleration]
    else if (allocated(self%request%program)) then
      motion = program_values(self%request%program, at)
      if (gives_angle(self%linkage%drives(1))) motion(2:) = motion(2:)*degree
    else
      motion = [at, 1.0_wp, 0.0_wp]
    end if
  end function motion_at

  !> The linkage at places of the cycle. Errors are left in the states.
  pure function positions_at(self, at) result(positions)
    class(cycle_forces_t), intent(in) :: self
    real(wp), intent(in) :: at(:)
    type(positions_t) :: positions

    real(wp) :: motion(3), crank(size(at))
    integer :: i

    if (.not. is_timed(self%request)) then
      positions = find_positions(self%linkage, at)
      return
    end if
    do i = 1, size(at)
      motion = self%motion_at(at(i), 1)
      crank(i) = motion(1)
    end do
    call list_positions(crank, positions, instants=at)
    do i = 1, size(at)
      call find_state(self%linkage, positions%states(i))
    end do
  end function positions_at

  !> Speed and acceleration of what the linkage is moved by.
  pure subroutine find_rates(self, at, speeds, accelerations)
    class(cycle_forces_t), intent(in) :: self
    real(wp), intent(in) :: at(:)                              !! (places) in the cycle
    real(wp), allocatable, intent(out) :: speeds(:, :)         !! (speeds, places)
    real(wp), allocatable, intent(out) :: accelerations(:, :)  !! (speeds, places)

    real(wp) :: motion(3)
    integer :: i, k

    allocate (speeds(size(self%request%speed), size(at)), &
      accelerations(size(self%request%speed), size(at)))
    do i = 1, size(at)
      do k = 1, size(self%request%speed)
        motion = self%motion_at(at(i), k)
        speeds(k, i) = motion(2)
        accelerations(k, i) = motion(3)
      end do
    end do
  end subroutine find_rates

  !> All joints at places of the cycle and all speeds. Errors of a place stand in its outcome.
  subroutine find_joints_at(self, at, positions, threads, joints)
    class(cycle_forces_t), intent(in) :: self
    real(wp), intent(in) :: at(:)              !! (places) in the cycle
    type(positions_t), intent(in) :: positions !! there
    integer, intent(in) :: threads !! number of OpenMP threads
    type(joints_result_t), intent(out) :: joints

    real(wp), allocatable :: speeds(:, :), accelerations(:, :)

    call self%find_rates(at, speeds, accelerations)
    call find_joints(self%linkage, self%elements, positions, threads, joints, speeds, &
      accelerations, self%division)
  end subroutine find_joints_at

  !> All forces at a place, of joints magnitudes, and the rates of drives and of the motor.
  pure subroutine find_values(self, positions, joints, state, at, number, values, rates)
    class(cycle_forces_t), intent(in) :: self
    type(positions_t), intent(in) :: positions  !! of `positions_at`
    type(joints_result_t), intent(in) :: joints !! of `find_joints_at`
    integer, intent(in) :: state                !! the place among those of the joints
    real(wp), intent(in) :: at                  !! the place in the cycle
    integer, intent(in) :: number               !! of the speed
    real(wp), intent(out) :: values(:)          !! (forces) [N m] or [N]
    real(wp), intent(out) :: rates(:)           !! (drives, motor) [rad/s] or [m/s]

    real(wp) :: drives(3, size(self%linkage%drives)), forces(3, size(joints%joints)), motion(3)
    integer :: d

    d = size(self%linkage%drives)
    motion = self%motion_at(at, number)
    associate (request => self%request)
      drives = drives_at_speed(self%linkage, joints, positions%states(state), state, motion(1), &
        motion(2), motion(3), number)
      forces = joints_at_speed(joints, state, motion(2), motion(3), number)
      values(:d) = drives(3, :)
      rates(:d) = drives(2, :)
      if (self%motors() > 0) then
        values(d + 1) = motor_torque(request%gear, drives(3, 1), drives(2, 1), &
          first_acceleration(self%linkage, motion))
        rates(d + 1) = request%gear%ratio*drives(2, 1)
      end if
      values(d + self%motors() + 1:) = norm2(forces(:2, :), dim=1)
    end associate
  end subroutine find_values

  !> Acceleration of the first drive.
  pure function first_acceleration(linkage, motion) result(acceleration)
    type(linkage_t), intent(in) :: linkage
    real(wp), intent(in) :: motion(3) !! of `motion_at`
    real(wp) :: acceleration

    real(wp), dimension(size(linkage%drives)) :: rates, accelerations

    acceleration = motion(3)
    if (.not. linkage%runs_in_time) return
    call find_rates_of_drives(linkage, motion(1), rates, accelerations)
    acceleration = accelerations(1)
  end function first_acceleration

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

  !> A force, rate or power at a place of the cycle; 0 where there is none [N m], [N], [rad/s],
  !! [m/s] or [W].
  function value_at(self, at, kind, signal, number) result(value)
    class(cycle_forces_t), intent(in) :: self
    real(wp), intent(in) :: at            !! [deg] or [s]
    integer, intent(in) :: kind           !! one of the of_… constants
    integer, intent(in) :: signal, number !! of the force; of the speed
    real(wp) :: value

    type(positions_t) :: there
    type(joints_result_t) :: joints
    real(wp), allocatable :: values(:), rates(:)

    value = 0.0_wp
    there = self%positions_at([at])
    if (allocated(there%states(1)%error)) return
    call self%find_joints_at([at], there, 1, joints)
    if (allocated(joints%outcome(1)%error)) return
    if (any(joints%lock%friction > 0)) return
    associate (d => size(self%linkage%drives) + self%motors())
      allocate (values(d + size(joints%joints)), rates(d))
    end associate
    call self%find_values(there, joints, 1, at, number, values, rates)
    value = 1.0_wp
    if (kind /= of_rates) value = values(signal)
    if (kind /= of_forces) value = value*rates(signal)
  end function value_at

  !> Direction of the force of a joint, in the axes of its link; 0 where it has none [deg].
  function angle_at(self, at, joint, number) result(angle)
    class(cycle_forces_t), intent(in) :: self
    real(wp), intent(in) :: at           !! a place where joints have forces [deg] or [s]
    integer, intent(in) :: joint, number !! of the joint; of the speed
    real(wp) :: angle

    type(positions_t) :: there
    type(joints_result_t) :: joints
    real(wp), allocatable :: bearings(:, :)
    real(wp) :: motion(3)

    angle = 0.0_wp
    there = self%positions_at([at])
    if (allocated(there%states(1)%error)) return
    call self%find_joints_at([at], there, 1, joints)
    if (allocated(joints%outcome(1)%error)) return
    motion = self%motion_at(at, number)
    bearings = bearings_at_speed(self%linkage, joints, there%states(1)%pose, 1, motion(2), &
      motion(3), number)
    angle = bearings(bearing_values, joint)
  end function angle_at

end module cycle_forces
