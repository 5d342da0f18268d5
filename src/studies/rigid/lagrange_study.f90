!> The terms of Lagrange's equation at every position.
module lagrange_study
  use elastic_reactions, only: elastic_division_t
  use errors, only: error_t, outcome_t
  use joint_friction, only: has_friction
  use kinds, only: wp
  use lagrange, only: demanded_torque, find_lagrange, kinetic_energy, lagrange_t, velocity_term
  use linkages, only: linkage_t
  use position_loads, only: find_position_loads, find_speed_loads, position_loads_t
  use positions, only: positions_t, state_t
  use rigid_bodies, only: rigid_bodies_of, rigid_body_t
  use running_loads, only: depends_on_speed, lock_of, lock_t, running_t
  implicit none (type, external)
  private

  public :: lagrange_result_t, find_lagrange_terms, lagrange_at_speed

  !> Number of values of `lagrange_at_speed`.
  integer, parameter :: lagrange_values = 8

  type :: lagrange_result_t
    type(lagrange_t), allocatable :: terms(:)    !! (states) zeros where there is no pose
    real(wp), allocatable :: running_load(:, :)  !! (speeds, states) added to `load` at each speed;
                                                 !! no speeds: nothing is [N m]
    type(lock_t), allocatable :: lock(:, :)    !! (speeds, states) where friction locks the linkage
    type(outcome_t), allocatable :: outcome(:) !! (states) why elasticity does not divide the forces
                                               !! that friction depends on
  end type lagrange_result_t

contains

  !> Generalised inertia M, M' = dM/dθ2, generalised loads and potential at all positions, once for
  !! all speeds: Ulker 2010 (2.50) to (2.64).
  subroutine find_lagrange_terms(linkage, elements, positions, threads, found, speeds, &
      accelerations, division)
    type(linkage_t), intent(in) :: linkage     !! with masses
    integer, intent(in) :: elements(:)         !! (bodies) on whose nodes the masses are lumped; 0:
                                               !! distributed
    type(positions_t), intent(in) :: positions !! of the run
    integer, intent(in) :: threads             !! number of OpenMP threads
    type(lagrange_result_t), intent(out) :: found !! for all positions and speeds
    real(wp), intent(in), optional :: speeds(:, :) !! (speeds, states) of the first drive, for loads
                                                   !! that depend on it [rad/s] or [m/s]; absent:
                                                   !! without these
    real(wp), intent(in), optional :: accelerations(:, :) !! (speeds, states) likewise, for friction
                                                   !! [rad/s²] or [m/s²]; absent: none
    type(elastic_division_t), intent(in), optional :: division !! of this linkage, if its elasticity
                                                   !! divides the forces that friction depends on

    type(rigid_body_t) :: rigid(size(linkage%bodies))
    integer :: i, running_speeds

    rigid = rigid_bodies_of(linkage, elements)
    running_speeds = 0
    if (present(speeds) .and. depends_on_speed(linkage)) running_speeds = size(speeds, 1)
    allocate (found%terms(size(positions%states)), found%running_load(running_speeds, &
      size(positions%states)))
    allocate (found%lock(running_speeds, size(positions%states)))
    found%running_load = 0.0_wp
    allocate (found%outcome(size(found%terms)))
    !$omp parallel do num_threads(threads) schedule(dynamic, 32) default(shared) private(i)
    do i = 1, size(found%terms)
      if (.not. allocated(positions%states(i)%error)) call find_at(i, positions%states(i))
    end do
    !$omp end parallel do

  contains

    !> Terms at a state.
    subroutine find_at(i, state)
      integer, intent(in) :: i !! number of the state
      type(state_t), intent(in) :: state

      type(position_loads_t) :: loads
      type(running_t) :: running
      type(error_t), allocatable :: failure
      real(wp) :: acceleration
      integer :: k

      found%terms(i) = find_lagrange(linkage, rigid, state%pose, state%coefficients)
      if (running_speeds > 0 .and. has_friction(linkage)) then
        call find_position_loads(linkage, elements, state%pose, state%coefficients, loads, &
          failure, division)
        if (allocated(failure)) then
          found%outcome(i)%error = failure
          return
        end if
      end if
      do k = 1, running_speeds
        acceleration = 0.0_wp
        if (present(accelerations)) acceleration = accelerations(k, i)
        if (has_friction(linkage)) then
          call find_speed_loads(linkage, state%pose, state%coefficients, speeds(k, i), &
            acceleration, loads, running, failure, division)
        else
          call find_speed_loads(linkage, state%pose, state%coefficients, speeds(k, i), &
            acceleration, loads, running, failure)
        end if
        if (allocated(failure)) then
          found%outcome(i)%error = failure
          exit
        end if
        found%lock(k, i) = lock_of(running)
        if (found%lock(k, i)%friction > 0) cycle
        found%running_load(k, i) = running%load
      end do
    end subroutine find_at

  end subroutine find_lagrange_terms

  !> Values at a speed: M, M' [kg m²], `½ M' ω2²`, gravity, load, torque, kinetic energy, potential
  !! [N m].
  pure function lagrange_at_speed(found, state, speed, acceleration, number) result(values)
    type(lagrange_result_t), intent(in) :: found !! for all positions
    integer, intent(in) :: state                 !! number; with a pose
    real(wp), intent(in) :: speed                !! ω2 [rad/s]
    real(wp), intent(in) :: acceleration         !! α2 [rad/s²]
    integer, intent(in), optional :: number !! of the speed, for loads that depend on it; absent:
                                            !! without these
    real(wp) :: values(lagrange_values)

    type(lagrange_t) :: terms

    terms = found%terms(state)
    if (present(number)) then
      if (size(found%running_load, 1) > 0) terms%load = terms%load + found%running_load(number, &
        state)
    end if
    values = [terms%inertia, terms%inertia_slope, velocity_term(terms, speed), terms%gravity, &
      terms%load, demanded_torque(terms, speed, acceleration), kinetic_energy(terms, speed), &
      terms%potential]
  end function lagrange_at_speed

end module lagrange_study
