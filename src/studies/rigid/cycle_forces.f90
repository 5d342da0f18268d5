!> Forces of the drives, of the motor and of the joints of a linkage over its cycle.
module cycle_forces
  use elastic_reactions, only: elastic_division_t
  use gears, only: gear_share, gear_t, is_direct
  use joint_study, only: bearing_values, bearings_at_speed, drives_at_speed, find_joints, &
    joints_at_speed, joints_result_t
  use kinds, only: wp
  use linkages, only: linkage_t
  use positions, only: find_positions, positions_t
  implicit none (type, external)
  private

  public :: sizing_request_t, cycle_forces_t

  !> What is asked for.
  type :: sizing_request_t
    real(wp), allocatable :: speed(:)    !! (speeds) of the first drive [rad/s] or [m/s]
    real(wp) :: acceleration = 0.0_wp    !! of the first drive [rad/s²] or [m/s²]
    real(wp) :: fluctuation = 0.0_wp     !! of the speed, that a flywheel is to allow; 0: none is
                                         !! asked for [-]
    type(gear_t) :: gear                 !! between a motor and the first drive
  end type sizing_request_t

  !> The forces as functions of the position. They are numbered: drives, the motor if it has a gear
  !! or a rotor, joints.
  type :: cycle_forces_t
    type(linkage_t) :: linkage         !! of any kind, with masses
    integer, allocatable :: elements(:) !! (bodies) on whose nodes the masses are lumped; 0:
                                       !! distributed
    type(sizing_request_t) :: request
    type(elastic_division_t), allocatable :: division !! if elasticity divides forces
  contains
    procedure :: motors
    procedure :: find_rates
    procedure :: find_joints_at
    procedure :: values_of
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

  !> Speed and acceleration of the first drive, the same at every position.
  pure subroutine find_rates(self, samples, speeds, accelerations)
    class(cycle_forces_t), intent(in) :: self
    integer, intent(in) :: samples                             !! positions
    real(wp), allocatable, intent(out) :: speeds(:, :)         !! (speeds, positions)
    real(wp), allocatable, intent(out) :: accelerations(:, :)  !! (speeds, positions)

    speeds = spread(self%request%speed, 2, samples)
    accelerations = spread(0.0_wp*self%request%speed + self%request%acceleration, 2, samples)
  end subroutine find_rates

  !> All joints at positions and all speeds. Errors of a position stand in its outcome.
  subroutine find_joints_at(self, positions, threads, joints)
    class(cycle_forces_t), intent(in) :: self
    type(positions_t), intent(in) :: positions
    integer, intent(in) :: threads !! number of OpenMP threads
    type(joints_result_t), intent(out) :: joints

    real(wp), allocatable :: speeds(:, :), accelerations(:, :)

    call self%find_rates(size(positions%states), speeds, accelerations)
    call find_joints(self%linkage, self%elements, positions, threads, joints, speeds, &
      accelerations, self%division)
  end subroutine find_joints_at

  !> All forces at a position, of joints magnitudes [N m] or [N].
  pure function values_of(self, joints, state, number) result(values)
    class(cycle_forces_t), intent(in) :: self
    type(joints_result_t), intent(in) :: joints !! of `find_joints_at`
    integer, intent(in) :: state                !! the position among those of the joints
    integer, intent(in) :: number               !! of the speed
    real(wp) :: values(size(self%linkage%drives) + self%motors() + size(joints%joints))

    real(wp) :: drives(3, size(self%linkage%drives)), forces(3, size(joints%joints))
    integer :: d

    d = size(self%linkage%drives)
    associate (request => self%request)
      drives = drives_at_speed(self%linkage, joints, state, 0.0_wp, request%speed(number), &
        request%acceleration, number)
      forces = joints_at_speed(joints, state, request%speed(number), request%acceleration, number)
      values(:d) = drives(3, :)
      if (self%motors() > 0) values(d + 1) = motor_torque(request%gear, drives(3, 1), drives(2, &
        1), request%acceleration)
      values(d + self%motors() + 1:) = norm2(forces(:2, :), dim=1)
    end associate
  end function values_of

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

  !> A force at a position of the first drive; 0 where there is none [N m] or [N].
  function value_at(self, crank, signal, number) result(value)
    class(cycle_forces_t), intent(in) :: self
    real(wp), intent(in) :: crank         !! [deg]
    integer, intent(in) :: signal, number !! of the force; of the speed
    real(wp) :: value

    type(positions_t) :: there
    type(joints_result_t) :: joints
    real(wp), allocatable :: values(:)

    value = 0.0_wp
    there = find_positions(self%linkage, [crank])
    if (allocated(there%states(1)%error)) return
    call self%find_joints_at(there, 1, joints)
    if (allocated(joints%outcome(1)%error)) return
    if (any(joints%lock%friction > 0)) return
    values = self%values_of(joints, 1, number)
    value = values(signal)
  end function value_at

  !> Direction of the force of a joint, in the axes of its link [deg].
  function angle_at(self, crank, joint, number) result(angle)
    class(cycle_forces_t), intent(in) :: self
    real(wp), intent(in) :: crank        !! a position where joints have forces [deg]
    integer, intent(in) :: joint, number !! of the joint; of the speed
    real(wp) :: angle

    type(positions_t) :: there
    type(joints_result_t) :: joints
    real(wp), allocatable :: bearings(:, :)

    there = find_positions(self%linkage, [crank])
    call self%find_joints_at(there, 1, joints)
    bearings = bearings_at_speed(self%linkage, joints, there%states(1)%pose, 1, &
      self%request%speed(number), self%request%acceleration, number)
    angle = bearings(bearing_values, joint)
  end function angle_at

end module cycle_forces
