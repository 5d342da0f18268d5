!> Forward dynamics: the motion of a four-bar under a drive, gravity and all other loads.
!!
!! The state is a point of the loop-closure curve, the rate ṡ along it, and the work done so far by
!! the drive and by loads without a potential. It is integrated in steps of order 8. After each step
!! the angles are projected back onto the curve. The energy is never corrected, so that its balance
!! measures the accuracy of the motion.
module forward_motions
  use adaptive_integration, only: advance, close_integrator, integrator_t, open_integrator, step_by
  use applied_loads, only: applied_potential
  use constants, only: degree, two_pi
  use curve_dynamics, only: find_inertia, new_curve_dynamics, potential_energy
  use drives, only: drive_t, refuse_speed
  use errors, only: error_of_dead_point, error_t, set_error
  use four_bar_poses, only: find_curve_pose
  use four_bar_rates, only: find_instant, four_bar_instant_t, moving_four_bar_t, no_stop, &
    rate_number, stop_at_end, stop_many_steps, stop_no_inertia, stop_steps, unknown_count, &
    work_number
  use free_forces, only: add_free_loads, forces_of_motion, free_equations_t, loads_t, &
    new_free_equations
  use gears, only: driven_by, driven_t, gear_share, gear_t, is_direct, rotor_energy
  use inertia_loads, only: load_t
  use interruption, only: was_interrupted
  use joint_forces, only: joint_forces_t
  use kinds, only: long, wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkages, only: linkage_t, normal_to
  use loop_curves, only: choose_branch, closure_error, curve_point_t, find_point, find_start, &
    new_loop_curve, place_from_crossing, project, reduce
  use pose_types, only: arm_to_pin, pins_of_body, pose_t
  use poses, only: dead_point_sine
  use rigid_bodies, only: rigid_body_t
  use whole_systems, only: new_whole_system
  implicit none (type, external)
  private

  public :: forward_motion_t, motion_sample_t, turning_point_t, start_motion, move_until, &
    sample_motion, motion_details_t, find_motion_details, end_motion
  public :: motion_tolerance

  !> Bound on the estimated error of a step, for the angles in radians and for the rate relative to
  !! itself: some forty roundings. The estimate is of order 7; the step, of order 8, is better by
  !! two or three digits, so that only rounding is left.
  real(wp), parameter :: motion_tolerance = 1.0e-14_wp

  !> If M is below this share of the inertia of all links when steps shrink to nothing, M is the
  !! cause.
  real(wp), parameter :: little_inertia = 1.0e-10_wp

  !> For |sin(θ4 − θ3)| below this, next to the point where the crank turns back, rounding may give
  !! either side.
  real(wp), parameter :: undecided_sine = 1.0e-12_wp

  !> A position where the crank turns back and the linkage changes its branch, or a change point
  !! through which it goes straight on.
  type :: turning_point_t
    real(wp) :: time = 0.0_wp    !! [s]
    real(wp) :: crank = 0.0_wp   !! with all whole turns [deg]
    logical :: to_open = .false. !! else to the crossed branch
    logical :: is_change_point = .false.
  end type turning_point_t

  !> A motion in progress.
  type :: forward_motion_t
    real(wp) :: time = 0.0_wp                          !! [s]
    real(wp) :: energy = 0.0_wp                        !! kinetic + potential, at the start [J]
    integer :: stop = no_stop                          !! why it does not continue
    type(error_t), allocatable :: ended                !! the table that then ends
    logical :: is_open = .true.                        !! on the open branch; else crossed
    integer(long) :: most_steps = 1000000_long         !! from one instant to the next: some 6,000
                                                       !! turns, and some seconds of computing
    integer :: turning_count = 0                       !! so far
    type(turning_point_t), allocatable :: turnings(:)  !! (at least turning_count)
    type(integrator_t) :: integrator                   !! to be closed by `end_motion`
    type(moving_four_bar_t), private :: system         !! equations of motion
    real(wp), private :: state(unknown_count) = 0.0_wp !! θ2, θ3, θ4, ṡ, work
  end type forward_motion_t

  !> The linkage at an instant; arrays in the order crank, coupler, follower.
  type :: motion_sample_t
    real(wp) :: time = 0.0_wp         !! [s]
    real(wp) :: angle(3) = 0.0_wp     !! with all whole turns [deg]
    real(wp) :: speed(3) = 0.0_wp     !! [rad/s]
    real(wp) :: torque = 0.0_wp       !! of the drive, through its gear, on the crank [N m]
    real(wp) :: kinetic = 0.0_wp      !! [J]
    real(wp) :: potential = 0.0_wp    !! of gravity and constant forces, 0 at the global origin, and
                                      !! of springs, 0 unloaded [J]
    real(wp) :: work = 0.0_wp         !! of the drive and of all other loads since the start, less
                                      !! what the gear takes [J]
    real(wp) :: energy_error = 0.0_wp !! kinetic + potential − work, less its value at the start [J]
    real(wp) :: closure = 0.0_wp      !! gap of the open loop [m]
    logical :: is_open = .true.       !! on the open branch; else crossed
  end type motion_sample_t

  !> More about the linkage at an instant.
  type :: motion_details_t
    real(wp) :: acceleration(3) = 0.0_wp !! of crank, coupler, follower [rad/s²]
    type(driven_t) :: driven             !! motor and gear
    real(wp) :: load_power = 0.0_wp      !! of all loads without a potential [W]
    type(joint_forces_t) :: joints       !! forces in the joints
    real(wp) :: imbalance = 0.0_wp       !! of `forces_of_motion` [-]
  end type motion_details_t

contains

  !> Prepares a motion at its first instant.
  !!
  !! Errors: those of `find_start` (out of reach, change point); a speed at a limit position, where
  !! the crank can only be at rest and its speed would not determine those of the other links; a
  !! speed beyond the table of the motor; no memory. Other reasons why a motion cannot begin are
  !! found by `move_until`.
  subroutine start_motion(linkage, rigid, drive, crank_degrees, speed, duration, motion, error, &
      through, gear)
    type(linkage_t), intent(in) :: linkage           !! a four-bar
    type(rigid_body_t), intent(in) :: rigid(:)       !! (bodies) of the linkage
    class(drive_t), intent(in) :: drive              !! torque on the crank
    real(wp), intent(in) :: crank_degrees            !! at the start [deg]
    real(wp), intent(in) :: speed                    !! of the crank at the start [rad/s]
    real(wp), intent(in) :: duration                 !! about how long it is to be followed, above
                                                     !! 0 [s]
    type(forward_motion_t), intent(out) :: motion    !! at its first instant; to be ended by
                                                     !! `end_motion`
    type(error_t), allocatable, intent(out) :: error !! why it cannot begin
    logical, intent(in), optional :: through         !! straight through change points, in place of
                                                     !! a stop there
    type(gear_t), intent(in), optional :: gear       !! from the drive to the crank; absent: none

    type(curve_point_t) :: point
    type(motion_sample_t) :: first
    real(wp) :: slope, inertia
    logical :: is_smooth

    motion%system%curve = new_loop_curve(linkage, through)
    motion%system%dynamics = new_curve_dynamics(linkage, rigid)
    allocate (motion%system%drive, source=drive)
    if (present(gear)) motion%system%gear = gear
    motion%system%linkage = linkage
    motion%system%whole = new_whole_system(linkage, [1])
    motion%system%rigid = rigid
    allocate (motion%turnings(0))
    call find_start(linkage, crank_degrees, motion%state(1:3), error)
    if (allocated(error)) return
    motion%system%turns(1) = anint((crank_degrees*degree - motion%state(1))/two_pi)
    call find_point(motion%system%curve, motion%state(1:3), point, is_smooth)
    motion%is_open = point%sine > 0.0_wp
    if (abs(point%sine) < dead_point_sine) then
      motion%is_open = linkage%groups(1)%side > 0.0_wp
      if (abs(speed) > 0.0_wp) call set_error(error, error_of_dead_point, &
        "dead point: at a limit position the crank turns back and can have no "// &
        "speed; expected speed=0")
      if (allocated(error)) return
    end if
    call refuse_speed(motion%system%drive, motion%system%gear%ratio*speed, error)
    if (allocated(error)) return
    motion%state(rate_number) = 0.0_wp
    if (abs(speed) > 0.0_wp) motion%state(rate_number) = speed/point%tangent(1)
    call find_inertia(motion%system%dynamics, point, inertia, slope)
    call choose_branch(motion%system%curve, motion%state(1:3))
    first = sample_motion(motion)
    motion%energy = first%kinetic + first%potential
    ! Rates and work that are small against those of one radian in the whole duration do not matter.
    call open_integrator(motion%integrator, [1.0_wp, 1.0_wp, 1.0_wp, 1.0_wp/duration, &
      first%kinetic + (inertia + motion%system%gear%ratio**2*motion%system%gear%rotor* &
      point%tangent(1)**2)/duration**2], motion_tolerance, 0.01_wp*duration, error)
  end subroutine start_motion

  !> Frees the integrator of a motion.
  subroutine end_motion(motion)
    type(forward_motion_t), intent(inout) :: motion !! no longer to be continued

    call close_integrator(motion%integrator)
  end subroutine end_motion

  !> Follows the motion up to an instant, which is met exactly unless the motion stops or the run is
  !! interrupted.
  !!
  !! A motion that takes too many steps on the way is stopped. It would otherwise seem to run for
  !! ever, because the instant is too far ahead or the motion too fast. `motion%stop` gives the
  !! reason of a stop.
  subroutine move_until(motion, time)
    type(forward_motion_t), intent(inout) :: motion !! begun by `start_motion`
    real(wp), intent(in) :: time !! to be reached [s]

    type(error_t), allocatable :: error
    real(wp) :: before(unknown_count), time_before
    integer(long) :: last_step

    last_step = motion%integrator%steps + motion%most_steps
    do while (motion%time < time .and. motion%stop == no_stop)
      if (was_interrupted()) return
      if (motion%integrator%steps >= last_step) then
        motion%stop = stop_many_steps
        return
      end if
      before = motion%state
      time_before = motion%time
      motion%system%stop = no_stop
      call advance(motion%integrator, motion%system, motion%time, time, motion%state, error)
      if (allocated(error)) then
        motion%stop = merge(motion%system%stop, stop_steps, motion%system%stop /= no_stop)
        if (motion%stop == stop_at_end) call move_alloc(motion%system%ended, motion%ended)
        if (motion%stop == stop_steps) then
          if (inertia_of(motion) < little_inertia) motion%stop = stop_no_inertia
        end if
        return
      end if
      call project(motion%system%curve, motion%state(1:3))
      if (has_passed_crossing(motion, before)) then
        call note_passage(motion, time_before, before, .true.)
      else if (has_changed_branch(motion)) then
        call note_passage(motion, time_before, before, .false.)
      end if
      call reduce(motion%state(1:3), motion%system%turns)
      call choose_branch(motion%system%curve, motion%state(1:3))
    end do
  end subroutine move_until

  !> M at the present point, as a share of the inertia of all links.
  pure function inertia_of(motion) result(inertia)
    type(forward_motion_t), intent(in) :: motion
    real(wp) :: inertia

    type(curve_point_t) :: point
    real(wp) :: slope
    logical :: is_smooth

    call find_point(motion%system%curve, motion%state(1:3), point, is_smooth)
    call find_inertia(motion%system%dynamics, point, inertia, slope)
    associate (rotor => motion%system%gear%ratio**2*motion%system%gear%rotor)
      inertia = (inertia + rotor*point%tangent(1)**2)/(sum(motion%system%dynamics%inertia) + rotor)
    end associate
  end function inertia_of

  !> Whether the sign of `sin(θ4 − θ3)`, positive where B lies to the left of A → O4, shows a change
  !! of branch.
  pure function has_changed_branch(motion) result(has)
    type(forward_motion_t), intent(in) :: motion
    logical :: has

    real(wp) :: sine

    sine = sin(motion%state(3) - motion%state(2))
    has = abs(sine) > undecided_sine .and. (sine > 0.0_wp .neqv. motion%is_open)
  end function has_changed_branch

  !> Whether the last step has passed a change point.
  pure function has_passed_crossing(motion, before) result(has)
    type(forward_motion_t), intent(in) :: motion
    real(wp), intent(in) :: before(unknown_count) !! state at its beginning
    logical :: has

    real(wp) :: from, to, slope(3)

    has = motion%system%curve%near > 0
    if (.not. has) return
    call place_from_crossing(motion%system%curve, before(1:3), from, slope)
    call place_from_crossing(motion%system%curve, motion%state(1:3), to, slope)
    has = from*to < 0.0_wp .or. (abs(to) <= 0.0_wp .and. abs(from) > 0.0_wp)
  end function has_passed_crossing

  !> Records the passage of a change point, or a change of branch, and the instant in the last step
  !! at which the place along the branch, or `sin(θ4 − θ3)`, passed through zero. It is found by
  !! Newton's method within a shrinking interval; each trial is a single step from the beginning of
  !! the last one. If the sign at that beginning is mere rounding, the instant is the beginning
  !! itself.
  subroutine note_passage(motion, time, before, is_change_point)
    type(forward_motion_t), intent(inout) :: motion
    real(wp), intent(in) :: time !! at the beginning of the step [s]
    real(wp), intent(in) :: before(unknown_count) !! state at that time
    logical, intent(in) :: is_change_point

    integer, parameter :: most_trials = 60
    type(error_t), allocatable :: error
    real(wp) :: state(unknown_count), rates(unknown_count), low, high, step, next, value, &
      start_value, by_angle(3), slope
    integer :: trial
    logical :: found

    if (has_changed_branch(motion)) motion%is_open = .not. motion%is_open
    low = 0.0_wp
    high = motion%time - time
    call find_value(before, start_value)
    call find_value(motion%state, value)
    step = 0.0_wp
    if (value*start_value < 0.0_wp) step = high*start_value/(start_value - value)
    state = before
    do trial = 1, merge(most_trials, 0, value*start_value < 0.0_wp)
      state = before
      call step_by(motion%integrator, motion%system, time, step, state, error)
      found = .false.
      if (.not. allocated(error)) call motion%system%find_rates(time + step, state, rates, found)
      if (.not. found) exit
      call find_value(state, value)
      if (value*start_value > 0.0_wp) then
        low = step
      else
        high = step
      end if
      slope = dot_product(by_angle, rates(1:3))
      next = -1.0_wp
      if (abs(slope) > tiny(slope)) next = step - value/slope
      if (abs(next - step) <= 2.0_wp*epsilon(1.0_wp)*(time + step)) exit
      if (.not. (next >= low .and. next <= high)) next = 0.5_wp*(low + high)
      step = next
    end do
    call append_turning_point(motion, turning_point_t(time + step, &
      state(1)/degree + 360.0_wp*motion%system%turns(1), motion%is_open, is_change_point))

  contains

    !> What passes through zero, and its derivatives by the angles.
    subroutine find_value(state, value)
      real(wp), intent(in) :: state(unknown_count)
      real(wp), intent(out) :: value

      if (is_change_point) then
        call place_from_crossing(motion%system%curve, state(1:3), value, by_angle)
      else
        value = sin(state(3) - state(2))
        by_angle = cos(state(3) - state(2))*[0.0_wp, -1.0_wp, 1.0_wp]
      end if
    end subroutine find_value

  end subroutine note_passage

  pure subroutine append_turning_point(motion, turning)
    type(forward_motion_t), intent(inout) :: motion
    type(turning_point_t), intent(in) :: turning

    type(turning_point_t), allocatable :: larger(:)

    if (motion%turning_count == size(motion%turnings)) then
      allocate (larger(2*motion%turning_count + 8))
      larger(:motion%turning_count) = motion%turnings
      call move_alloc(larger, motion%turnings)
    end if
    motion%turning_count = motion%turning_count + 1
    motion%turnings(motion%turning_count) = turning
  end subroutine append_turning_point

  !> Angles, speeds, torque and energies at the present instant.
  function sample_motion(motion) result(sample)
    type(forward_motion_t), intent(in) :: motion !! begun by `start_motion`
    type(motion_sample_t) :: sample

    type(curve_point_t) :: point
    type(driven_t) :: driven
    type(pose_t) :: pose
    type(kinematic_coefficients_t) :: per
    real(wp) :: inertia, slope
    logical :: is_smooth

    associate (system => motion%system, angle => motion%state(1:3))
      call find_point(system%curve, angle, point, is_smooth)
      call find_inertia(system%dynamics, point, inertia, slope)
      sample%time = motion%time
      sample%angle = angle/degree + 360.0_wp*system%turns
      sample%speed = point%tangent*motion%state(rate_number)
      driven = driven_now(motion, angle(1) + two_pi*system%turns(1), sample%speed(1))
      sample%torque = driven%torque
      sample%kinetic = 0.5_wp*inertia*motion%state(rate_number)**2 + rotor_energy(system%gear, &
        sample%speed(1))
      sample%potential = potential_energy(system%dynamics, point)
      if (size(system%linkage%loads) > 0) then
        call find_curve_pose(system%linkage, point, angle(1) + two_pi*system%turns(1), pose, per)
        sample%potential = sample%potential + applied_potential(system%linkage, pose, &
          [0.0_wp, 0.0_wp])
      end if
      sample%work = motion%state(work_number)
      sample%energy_error = sample%kinetic + sample%potential - sample%work - motion%energy
      sample%closure = closure_error(system%curve, angle)
      sample%is_open = motion%is_open
    end associate
  end function sample_motion

  !> Motor and gear at the present instant. Where there is no acceleration, that of the crank is
  !! taken to be none.
  function driven_now(motion, angle, speed) result(driven)
    type(forward_motion_t), intent(in) :: motion
    real(wp), intent(in) :: angle, speed !! of the crank [rad], [rad/s]
    type(driven_t) :: driven

    type(moving_four_bar_t) :: system
    type(four_bar_instant_t) :: instant
    real(wp) :: torque
    logical :: found

    found = .false.
    if (.not. is_direct(motion%system%gear)) then
      system = motion%system
      call find_instant(system, motion%time, motion%state, instant, found)
      driven = instant%driven
    end if
    if (found) return
    associate (gear => motion%system%gear)
      torque = motion%system%drive%torque(motion%time, gear%ratio*angle, gear%ratio*speed)
      driven = driven_by(gear, torque, gear_share(gear, speed, torque), speed, 0.0_wp)
    end associate
  end function driven_now

  !> Accelerations, powers and forces in the joints at the present instant. Not found where there
  !! are no rates of the motion, at change points.
  subroutine find_motion_details(motion, details, found)
    type(forward_motion_t), intent(in) :: motion   !! begun by `start_motion`
    type(motion_details_t), intent(out) :: details !! of this instant
    logical, intent(out) :: found

    type(moving_four_bar_t) :: system
    type(four_bar_instant_t) :: instant
    type(pose_t) :: pose
    type(kinematic_coefficients_t) :: per, now
    type(kinematic_coefficients_t), allocatable :: all_per(:)
    type(free_equations_t) :: equations
    type(loads_t) :: loads
    real(wp), allocatable :: pin_load(:, :)

    system = motion%system
    call find_instant(system, motion%time, motion%state, instant, found)
    if (.not. found) return
    associate (rate => motion%state(rate_number), point => instant%point)
      details%acceleration = point%tangent*instant%rate + point%tangent_slope*rate**2
      details%driven = instant%driven
      details%load_power = instant%loading*rate
      call find_curve_pose(system%linkage, point, motion%state(1) + two_pi*system%turns(1), pose, &
        per)
      now = moving(system%linkage, pose, per, rate, details%acceleration)
    end associate
    ! An array constructor would leak the memory of components in gfortran 12.
    allocate (all_per(1))
    all_per(1) = per
    call new_free_equations(system%whole, system%rigid, pose, all_per, 0.0_wp, equations)
    found = abs(equations%factor%determinant) > 0.0_wp
    if (.not. found) return
    allocate (pin_load(2, size(system%linkage%is_ground)), source=0.0_wp)
    if (allocated(instant%pin_load)) pin_load = instant%pin_load
    allocate (loads%body(size(system%rigid)))
    allocate (loads%pin, source=0.0_wp*pin_load)
    call add_free_loads(system%whole, system%rigid, pose, now, instant%body_load, pin_load, loads)
    call forces_of_motion(system%whole, pose, equations, loads, details%driven%torque, &
      details%joints, details%imbalance)
  end subroutine find_motion_details

  !> Velocities and accelerations of bodies and pins.
  pure function moving(linkage, pose, per, rate, acceleration) result(now)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(kinematic_coefficients_t), intent(in) :: per
    real(wp), intent(in) :: rate            !! ṡ
    real(wp), intent(in) :: acceleration(3) !! of crank, coupler, follower
    type(kinematic_coefficients_t) :: now

    integer, allocatable :: pins(:)
    integer :: numbers(3), bases(3), b, i, k

    now = per
    now%turn = rate*per%turn
    now%pin = rate*per%pin
    associate (dyad => linkage%groups(1))
      numbers = [1, dyad%body]
      bases = [linkage%bodies(1)%first_pin, dyad%base]
    end associate
    do i = 1, 3
      b = numbers(i)
      now%turn_slope(b) = acceleration(i)
      pins = pins_of_body(linkage%bodies(b))
      do k = 1, size(pins)
        if (pins(k) == bases(i)) cycle
        associate (arm => arm_to_pin(linkage, pose, b, pins(k)) - arm_to_pin(linkage, pose, b, &
            bases(i)))
          now%pin_slope(:, pins(k)) = now%pin_slope(:, bases(i)) + acceleration(i)* &
            normal_to(arm) - now%turn(b)**2*arm
        end associate
      end do
    end do
  end function moving

end module forward_motions
