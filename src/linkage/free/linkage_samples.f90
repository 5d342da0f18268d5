!> A linkage in motion at an instant.
module linkage_samples
  use applied_loads, only: applied_potential
  use body_points, only: find_point_coefficients, point_coefficients_t
  use constants, only: degree
  use free_forces, only: add_free_loads, forces_of_motion, free_equations_t, loads_t, &
    new_free_equations
  use gears, only: driven_by, driven_t, gear_share, is_direct, rotor_energy
  use joint_forces, only: joint_forces_t
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkage_instants, only: linkage_instant_t
  use linkage_rates, only: find_instant, find_state, moving_linkage_t, rate_of_drive
  use linkages, only: gives_angle
  use loop_curves, only: closure_error
  use pose_types, only: count_from, pose_t
  use poses, only: dead_point_sine
  use rigid_bodies, only: central_inertia, mass_centre
  use whole_systems, only: drive_acceleration
  implicit none (type, external)
  private

  public :: linkage_sample_t, loop_sample_t, linkage_details_t, sample_state, find_details

  !> What is known of a linkage of one loop besides; arrays in the order crank, coupler, follower.
  type :: loop_sample_t
    real(wp) :: angle(3) = 0.0_wp !! θ2, θ3, θ4 with all whole turns [deg]
    real(wp) :: speed(3) = 0.0_wp !! [rad/s]
    real(wp) :: closure = 0.0_wp  !! gap of the open loop [m]
    logical :: is_left = .true.   !! B is to the left of A → O4; else to its right
  end type loop_sample_t

  type :: linkage_sample_t
    real(wp) :: time = 0.0_wp            !! [s]
    real(wp), allocatable :: position(:) !! (free drives) with all whole turns [deg] or [m]
    real(wp), allocatable :: rate(:)     !! (free drives) [rad/s] or [m/s]
    real(wp), allocatable :: pin(:, :)   !! (2, pins) in global axes [m]
    real(wp) :: torque = 0.0_wp          !! of the drive, through its gear [N m] or [N]
    real(wp) :: kinetic = 0.0_wp         !! [J]
    real(wp) :: potential = 0.0_wp       !! of gravity and constant forces, 0 at the global origin,
                                         !! and of springs, 0 unloaded [J]
    real(wp) :: work = 0.0_wp            !! of the drive and of all other loads since the start,
                                         !! less what the gear takes [J]
    real(wp) :: energy_error = 0.0_wp    !! kinetic + potential − work, less its value at the start
                                         !! [J]
    type(loop_sample_t), allocatable :: loop !! of a linkage of one loop
  end type linkage_sample_t

  !> More about the linkage at an instant.
  type :: linkage_details_t
    real(wp), allocatable :: acceleration(:) !! (free drives) [rad/s²] or [m/s²]; of a linkage of
                                             !! one loop (3) crank, coupler, follower
    type(driven_t) :: driven                 !! motor and gear
    real(wp) :: load_power = 0.0_wp          !! of all loads without a potential [W]
    real(wp), allocatable :: direction(:, :) !! (2, bodies) unit vectors, first → last pin
    real(wp), allocatable :: turning(:)      !! (bodies) angular accelerations [rad/s²]
    type(pose_t) :: pose                     !! pins in global axes
    type(kinematic_coefficients_t) :: motion !! velocities, and accelerations
    type(joint_forces_t) :: joints           !! forces in the joints, where they are wanted
    real(wp) :: imbalance = 0.0_wp           !! of `forces_of_motion` [-]
  end type linkage_details_t

contains

  !> Rates, pins, torque and energies of a state.
  subroutine sample_state(system, time, state, position, sample, is_found)
    type(moving_linkage_t), intent(in) :: system
    real(wp), intent(in) :: time        !! [s]
    real(wp), intent(in) :: state(:)    !! coordinates, rates, work
    real(wp), intent(in) :: position(:) !! (free drives) with all whole turns [deg] or [m]
    type(linkage_sample_t), intent(out) :: sample !! without its error
    logical, intent(out), optional :: is_found    !! false: this is a change point, and the sample
                                                  !! has time and position only

    type(linkage_instant_t) :: at
    type(point_coefficients_t) :: point
    type(driven_t) :: driven
    real(wp) :: unit
    logical :: found
    integer :: b, k, p

    associate (linkage => system%whole%linkage, pose => at%pose, now => at%motion)
      call find_state(system, state, at, found)
      sample%time = time
      sample%position = position
      if (present(is_found)) is_found = found
      if (.not. found) then
        ! The motion has come to a change point, and ends.
        sample%rate = 0.0_wp*position
        sample%pin = 0.0_wp*linkage%ground_position
        return
      end if
      sample%rate = [(rate_of_drive(system, pose, now, system%free(k)), k=1, size(system%free))]
      if (allocated(system%loop)) call sample_loop(system, state, now, sample)
      unit = merge(degree, 1.0_wp, gives_angle(linkage%drives(1)))
      driven = driven_now(system, time, state, unit*position(1), sample%rate(1))
      sample%torque = driven%torque
      sample%kinetic = rotor_energy(system%gear, sample%rate(1))
      sample%work = state(size(state))
      do b = 1, size(system%rigid)
        associate (rigid => system%rigid(b))
          point = find_point_coefficients(linkage, pose, now, b, mass_centre(rigid))
          sample%kinetic = sample%kinetic + 0.5_wp*(rigid%mass*sum(point%rate**2) + &
            central_inertia(rigid)*now%turn(b)**2)
          sample%potential = sample%potential - rigid%mass*dot_product(linkage%gravity, &
            point%place + pose%origin)
        end associate
      end do
      sample%pin = pose%pin + spread(pose%origin, 2, size(pose%pin, 2))
      do p = 1, size(linkage%is_ground)
        sample%kinetic = sample%kinetic + 0.5_wp*linkage%pin_mass(p)*sum(now%pin(:, p)**2)
        sample%potential = sample%potential - dot_product(linkage%pin_mass(p)*linkage%gravity + &
          linkage%pin_force(:, p), sample%pin(:, p))
      end do
      if (size(linkage%loads) > 0) sample%potential = sample%potential + &
        applied_potential(linkage, pose, at%along)
    end associate
  end subroutine sample_state

  !> Angles, their rates and the gap of a loop.
  pure subroutine sample_loop(system, state, now, sample)
    type(moving_linkage_t), intent(in) :: system
    real(wp), intent(in) :: state(:) !! three angles, rate, work
    type(kinematic_coefficients_t), intent(in) :: now !! velocities
    type(linkage_sample_t), intent(inout) :: sample

    allocate (sample%loop)
    sample%loop%angle = state(1:3)/degree + 360.0_wp*system%turns
    sample%loop%speed = now%turn(system%loop%four_bar%body)
    sample%loop%closure = closure_error(system%loop, state(1:3))
  end subroutine sample_loop

  !> Motor and gear at a state. Where there is no acceleration, that of the first drive is taken to
  !! be none.
  function driven_now(system, time, state, angle, rate) result(driven)
    type(moving_linkage_t), intent(in) :: system
    real(wp), intent(in) :: time, state(:)
    real(wp), intent(in) :: angle, rate !! of the first drive [rad], [rad/s]; or [m], [m/s]
    type(driven_t) :: driven

    type(moving_linkage_t) :: same
    type(linkage_instant_t) :: instant
    real(wp) :: torque
    logical :: found

    found = .false.
    if (.not. is_direct(system%gear)) then
      same = system
      call find_instant(same, time, state, instant, found)
      driven = instant%driven
    end if
    if (found) return
    associate (gear => system%gear)
      torque = system%drive%torque(time, gear%ratio*angle, gear%ratio*rate)
      driven = driven_by(gear, torque, gear_share(gear, rate, torque), rate, 0.0_wp)
    end associate
  end function driven_now

  !> Accelerations, powers and forces in the joints of a state. Not found where there are no rates
  !! of the motion.
  subroutine find_details(system, time, state, with_forces, details, found)
    type(moving_linkage_t), intent(in) :: system
    real(wp), intent(in) :: time         !! [s]
    real(wp), intent(in) :: state(:)     !! coordinates, rates, work
    logical, intent(in) :: with_forces   !! those in the joints, too; of a linkage that is not
                                         !! redundant
    type(linkage_details_t), intent(out) :: details
    logical, intent(out) :: found

    type(moving_linkage_t) :: same
    type(linkage_instant_t) :: instant
    type(free_equations_t) :: equations
    type(loads_t) :: loads
    integer :: k

    same = system
    call find_instant(same, time, state, instant, found)
    if (.not. found) return
    associate (whole => system%whole, pose => instant%pose, motion => instant%motion)
      if (allocated(system%loop)) then
        details%acceleration = motion%turn_slope(system%loop%four_bar%body)
      else
        details%acceleration = [(drive_acceleration(whole, pose, system%free(k), motion), k=1, &
          size(system%free))]
      end if
      details%driven = instant%driven
      details%load_power = instant%load_power
      details%direction = pose%direction
      details%turning = motion%turn_slope
      details%pose = pose
      call count_from([0.0_wp, 0.0_wp], details%pose)
      details%motion = motion
      if (.not. with_forces) return
      ! At a change point itself they are not determined; charts have no such places.
      if (allocated(pose%sine)) found = all(abs(pose%sine) > dead_point_sine)
      if (.not. found) return
      call new_free_equations(whole, system%rigid, pose, instant%per, 0.0_wp, equations)
      found = abs(equations%factor%determinant) > 0.0_wp
      if (.not. found) return
      allocate (loads%body(size(system%rigid)))
      allocate (loads%pin, source=0.0_wp*instant%pin_load)
      call add_free_loads(whole, system%rigid, pose, motion, instant%body_load, instant%pin_load, &
        loads)
      call forces_of_motion(whole, pose, equations, loads, details%driven%torque, &
        details%joints, details%imbalance)
      if (allocated(instant%friction)) details%joints%friction = instant%friction
    end associate
  end subroutine find_details

end module linkage_samples
