!> Friction in the joints at every position: forces, sliding, power lost, and whether the linkage
!! holds itself at rest.
module friction_study
  use elastic_reactions, only: elastic_division_t
  use errors, only: error_t, outcome_t
  use joint_friction, only: friction_t
  use kinds, only: wp
  use linkages, only: linkage_t
  use load_cases, only: constant_case
  use position_loads, only: find_position_loads, find_speed_loads, position_loads_t
  use positions, only: positions_t, state_t
  use running_loads, only: lock_of, lock_t, running_t
  use starting_linkages, only: starting_linkage, starting_speed
  implicit none (type, external)
  private

  public :: friction_result_t, find_joint_friction, lock_t
  public :: friction_values, normal_value, sliding_value, force_value, moment_value, power_value
  public :: forward_sense, backward_sense

  !> Values of a joint that rubs: force in it [N], sliding speed [m/s], friction along a line [N],
  !! couple of a pin [N m], power lost [W].
  integer, parameter :: friction_values = 5, normal_value = 1, sliding_value = 2, force_value = 3, &
    moment_value = 4, power_value = 5

  !> Senses of the first drive in which it may start.
  integer, parameter :: forward_sense = 1, backward_sense = 2

  !> A torque below this share of its parts has no sign: it is round-off.
  real(wp), parameter :: round_off = 1.0e-12_wp

  type :: friction_result_t
    integer, allocatable :: first(:)            !! (joints) number of the first friction of each
    real(wp), allocatable :: values(:, :, :, :) !! (friction_values, joints, speeds, states)
    type(lock_t), allocatable :: lock(:, :)     !! (speeds, states) where it locks the linkage
    real(wp), allocatable :: start(:, :)        !! (2, states) torque or force of the first drive
                                                !! that starts it from rest, forward and backward;
                                                !! 0 where it is locked [N m] or [N]
    type(lock_t), allocatable :: start_lock(:, :) !! (2, states) where it cannot start
    type(outcome_t), allocatable :: outcome(:)  !! (states) why elasticity does not divide the
                                                !! forces there
  end type friction_result_t

contains

  !> Friction at all positions and speeds.
  !!
  !! Torques at the start are those against full friction, see `starting_linkage`: what rests moves
  !! by itself where the one backward is positive, or that forward negative, and else holds itself.
  subroutine find_joint_friction(linkage, elements, positions, threads, speeds, accelerations, &
    found, division)
    type(linkage_t), intent(in) :: linkage      !! with frictions
    integer, intent(in) :: elements(:)          !! (bodies) on whose nodes the masses are lumped;
                                                !! 0: distributed
    type(positions_t), intent(in) :: positions  !! of the run
    integer, intent(in) :: threads              !! number of OpenMP threads
    real(wp), intent(in) :: speeds(:, :)        !! (speeds, states) of the first drive [rad/s] or
                                                !! [m/s]
    real(wp), intent(in) :: accelerations(:, :) !! likewise [rad/s²] or [m/s²]
    type(friction_result_t), intent(out) :: found !! for all positions and speeds
    type(elastic_division_t), intent(in), optional :: division !! of this linkage, if its elasticity
                                                !! divides forces

    type(elastic_division_t), allocatable :: of_start
    type(linkage_t) :: starting
    integer :: i, n, joints

    starting = starting_linkage(linkage)
    joints = maxval(linkage%frictions%joint)
    n = size(positions%states)
    found%first = [(findloc(linkage%frictions%joint, i, dim=1), i=1, joints)]
    allocate (found%values(friction_values, joints, size(speeds, 1), n), &
      found%lock(size(speeds, 1), n), found%start(2, n), found%start_lock(2, n))
    found%values = 0.0_wp
    found%start = 0.0_wp
    allocate (found%outcome(n))
    if (present(division)) then
      of_start = division
      of_start%structure%linkage%loads = starting%loads
    end if
    !$omp parallel do num_threads(threads) schedule(dynamic, 32) default(shared) private(i)
    do i = 1, n
      if (.not. allocated(positions%states(i)%error)) call find_at(i, positions%states(i))
    end do
    !$omp end parallel do

  contains

    !> Friction at a state.
    subroutine find_at(i, state)
      integer, intent(in) :: i !! number of the state
      type(state_t), intent(in) :: state

      type(position_loads_t) :: loads
      type(running_t) :: running
      type(error_t), allocatable :: failure
      real(wp) :: forward
      integer :: k

      call find_position_loads(linkage, elements, state%pose, state%coefficients, loads, &
        failure, division)
      do k = 1, size(speeds, 1)
        if (allocated(failure)) exit
        call find_speed_loads(linkage, state%pose, state%coefficients, speeds(k, i), &
          accelerations(k, i), loads, running, failure, division)
        if (allocated(failure)) exit
        found%lock(k, i) = lock_of(running)
        if (found%lock(k, i)%friction == 0) found%values(:, :, k, i) = values_of(linkage, &
          joints, running%friction)
      end do
      do k = forward_sense, backward_sense
        if (allocated(failure)) exit
        forward = merge(starting_speed, -starting_speed, k == forward_sense)
        call find_speed_loads(starting, state%pose, state%coefficients, forward, 0.0_wp, loads, &
          running, failure, of_start)
        if (allocated(failure)) exit
        found%start_lock(k, i) = lock_of(running)
        if (found%start_lock(k, i)%friction > 0) cycle
        associate (constant => loads%unit%of_case(constant_case)%joints%torque, &
            moving => running%joints%torque)
          if (abs(constant + moving) > round_off*(abs(constant) + abs(moving))) &
            found%start(k, i) = constant + moving
        end associate
      end do
      if (allocated(failure)) found%outcome(i)%error = failure
    end subroutine find_at

  end subroutine find_joint_friction

  !> Values of all joints that rub: those of both ends of a block together.
  pure function values_of(linkage, joints, friction) result(values)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: joints
    type(friction_t), intent(in) :: friction
    real(wp) :: values(friction_values, joints)

    integer :: k

    values = 0.0_wp
    do k = 1, size(linkage%frictions)
      associate (rub => linkage%frictions(k), value => values(:, linkage%frictions(k)%joint))
        value(normal_value) = value(normal_value) + friction%normal(k)
        value(power_value) = value(power_value) + friction%power(k)
        if (rub%slider > 0) then
          value(sliding_value) = friction%rate(k)
          value(force_value) = value(force_value) + friction%effort(k)
        else
          value(sliding_value) = rub%radius*friction%rate(k)
          value(moment_value) = value(moment_value) + friction%effort(k)
        end if
      end associate
    end do
  end function values_of

end module friction_study
