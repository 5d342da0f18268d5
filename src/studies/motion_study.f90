!> Forward dynamics: the motion of a four-bar under given loads, sampled at equal time steps.
module motion_study
  use constants, only: degree
  use drives, only: motor_drive_t
  use errors, only: error_of_dead_point, error_of_numerics, error_t, set_error
  use forward_motions, only: end_motion, find_motion_details, forward_motion_t, motion_details_t, &
    motion_sample_t, motion_tolerance, move_until, sample_motion, start_motion, turning_point_t
  use four_bar_rates, only: no_stop, stop_change_point, stop_locked, stop_many_steps, &
    stop_no_inertia, &
    stop_too_fast
  use gears, only: gear_t
  use interruption, only: was_interrupted
  use kinds, only: long, wp
  use linkages, only: linkage_t, turned
  use loop_curves, only: change_point_message
  use pose_types, only: pins_of_body, place_of_pin
  use reactions_study, only: pin_forces, pin_forces_of
  use rigid_bodies, only: rigid_bodies_of
  implicit none (type, external)
  private

  public :: motion_request_t, motion_result_t, motion_under_way_t, begin_motion, continue_motion, &
    finish_motion
  public :: motion_tolerance, undetermined_message

  type :: motion_request_t
    real(wp) :: start_angle = 0.0_wp !! of the crank [deg]
    real(wp) :: start_speed = 0.0_wp !! of the crank [rad/s]
    real(wp) :: end_time = 0.0_wp    !! [s]
    real(wp), allocatable :: instants(:) !! of the samples, ascending from 0 to `end_time` [s]
    type(motor_drive_t) :: drive     !! motor on the crank
    type(gear_t) :: gear             !! between them
    logical :: with_details = .false. !! accelerations, powers and forces are wanted
    logical :: with_pins = .false.   !! the places of all pins are wanted
    logical :: through = .false.     !! straight through change points, in place of a stop there
  end type motion_request_t

  type :: motion_result_t
    integer :: count = 0                               !! instants reached
    type(motion_sample_t), allocatable :: samples(:)   !! (all instants) the first `count` are set
    type(turning_point_t), allocatable :: turnings(:)  !! where the crank has turned back, and
                                                       !! change points that were passed
    type(motion_sample_t) :: last                      !! last state reached
    type(error_t), allocatable :: error                !! why it has not reached the end time
    logical :: has_begun = .false.                     !! the start was possible
    integer(long) :: steps = 0_long                    !! of the integration
    integer(long) :: implicit_steps = 0_long           !! those of the implicit method among them
    real(wp) :: energy = 0.0_wp                        !! kinetic + potential, at the start [J]
    real(wp), allocatable :: pin(:, :, :)              !! (2, pins, instants) in global axes, where
                                                       !! they are wanted [m]
    ! Where details are wanted:
    logical, allocatable :: is_determined(:)           !! (instants) else an instant has none
    real(wp), allocatable :: acceleration(:, :)        !! (3, instants) crank, coupler, follower
                                                       !! [rad/s²]
    real(wp), allocatable :: power(:, :)               !! (3, instants) of the motor, lost in its
                                                       !! gear, of loads without a potential [W]
    real(wp), allocatable :: force(:, :)               !! (pin forces, instants) as in
                                                       !! `reactions_study` [N]
  end type motion_result_t

  !> What is said of an instant without details.
  character(len=*), parameter :: undetermined_message = &
    "forces do not determine the accelerations at this position"

  !> A motion that is being computed.
  type :: motion_under_way_t
    type(motion_request_t), private :: request
    type(forward_motion_t), private :: motion
    type(linkage_t), private :: linkage
    integer, private :: next = 1        !! number of the next instant
    logical :: is_over = .false.        !! at the end, stopped or interrupted
  end type motion_under_way_t

contains

  !> Starts a motion.
  !!
  !! Errors, in `result%error`: the start position is out of reach, is a limit position and the
  !! start speed is not 0, or is a change point; no memory.
  subroutine begin_motion(request, linkage, elements, under_way, result)
    type(motion_request_t), intent(in) :: request      !! start, end and motor
    type(linkage_t), intent(in) :: linkage             !! a four-bar
    integer, intent(in) :: elements(:)                 !! (bodies) on whose nodes the masses are
                                                       !! lumped; 0: distributed
    type(motion_under_way_t), intent(out) :: under_way !! over if the start is impossible
    type(motion_result_t), intent(out) :: result       !! without samples yet

    under_way%request = request
    allocate (result%samples(size(request%instants)), result%turnings(0))
    if (request%with_details) allocate (result%is_determined(size(request%instants)), &
      result%acceleration(3, size(request%instants)), result%power(3, size(request%instants)), &
      result%force(pin_forces, size(request%instants)))
    if (request%with_pins) then
      under_way%linkage = linkage
      allocate (result%pin(2, size(linkage%is_ground), size(request%instants)))
    end if
    result%last%angle(1) = request%start_angle
    call start_motion(linkage, rigid_bodies_of(linkage, elements), request%drive, &
      request%start_angle, request%start_speed, request%end_time, under_way%motion, result%error, &
      request%through, request%gear)
    result%has_begun = .not. allocated(result%error)
    under_way%is_over = allocated(result%error)
  end subroutine begin_motion

  !> Continues a motion over the next instants, until it is over or the given number is reached.
  subroutine continue_motion(under_way, instants, result)
    type(motion_under_way_t), intent(inout) :: under_way !! begun
    integer, intent(in) :: instants                      !! number, at most
    type(motion_result_t), intent(inout) :: result       !! gets the samples of these instants

    integer :: i

    do i = under_way%next, min(under_way%next + instants - 1, size(result%samples))
      if (under_way%is_over) return
      call move_until(under_way%motion, under_way%request%instants(i))
      under_way%is_over = was_interrupted()
      if (under_way%is_over) return
      result%last = sample_motion(under_way%motion)
      under_way%is_over = under_way%motion%stop /= no_stop
      if (under_way%is_over) return
      result%samples(i) = result%last
      if (under_way%request%with_details) call take_details(under_way%motion, i, result)
      if (under_way%request%with_pins) result%pin(:, :, i) = pins_at(under_way%linkage, &
        result%last%angle)
      result%count = i
    end do
    under_way%next = i
    under_way%is_over = under_way%next > size(result%samples)
  end subroutine continue_motion

  !> Accelerations, powers and forces of an instant.
  subroutine take_details(motion, number, result)
    type(forward_motion_t), intent(in) :: motion
    integer, intent(in) :: number !! of the instant
    type(motion_result_t), intent(inout) :: result

    type(motion_details_t) :: details
    real(wp) :: forces(pin_forces + 1)

    call find_motion_details(motion, details, result%is_determined(number))
    if (.not. result%is_determined(number)) return
    result%acceleration(:, number) = details%acceleration
    result%power(:, number) = [details%driven%power, details%driven%loss, details%load_power]
    forces = pin_forces_of(details%joints)
    result%force(:, number) = forces(:pin_forces)
  end subroutine take_details

  !> Places of the pins of a four-bar whose links are at some angles.
  pure function pins_at(linkage, angle) result(pin)
    type(linkage_t), intent(in) :: linkage
    real(wp), intent(in) :: angle(:) !! (bodies) [deg]
    real(wp) :: pin(2, size(linkage%is_ground))

    integer, allocatable :: pins(:)
    real(wp) :: direction(2)
    integer :: b, i

    pin = linkage%ground_position
    do b = 1, size(linkage%bodies)
      associate (body => linkage%bodies(b))
        ! The angle is that of its heading.
        direction = turned([cos(angle(b)*degree), sin(angle(b)*degree)], [body%heading(1), &
          -body%heading(2)])
        pins = pins_of_body(body)
        do i = 2, size(pins)
          pin(:, pins(i)) = pin(:, body%first_pin) + turned(place_of_pin(body, pins(i)), direction)
        end do
      end associate
    end do
  end function pins_at

  !> Ends a motion and completes its result.
  !!
  !! Errors, in `result%error`: the motion has stopped before its end, at a change point, where
  !! nothing with a mass moves, or because the integration cannot continue.
  subroutine finish_motion(under_way, result)
    type(motion_under_way_t), intent(inout) :: under_way !! its memory is released
    type(motion_result_t), intent(inout) :: result       !! gets turning points, steps and energy

    if (.not. result%has_begun) return
    associate (motion => under_way%motion)
      result%turnings = motion%turnings(:motion%turning_count)
      result%steps = motion%integrator%steps
      result%implicit_steps = motion%integrator%implicit_steps
      result%energy = motion%energy
      if (allocated(motion%ended)) then
        result%error = motion%ended
      else
        call explain_stop(motion%stop, result%error)
      end if
    end associate
    call end_motion(under_way%motion)
  end subroutine finish_motion

  !> Turns the reason why a motion has stopped into an error; none for `no_stop`.
  pure subroutine explain_stop(stop, error)
    integer, intent(in) :: stop !! as in `four_bar_rates`
    type(error_t), allocatable, intent(inout) :: error

    select case (stop)
    case (no_stop)
      return
    case (stop_change_point)
      call set_error(error, error_of_dead_point, change_point_message)
    case (stop_no_inertia)
      call set_error(error, error_of_numerics, &
        "nothing with a mass moves with the linkage at this position: there is no inertia")
    case (stop_too_fast)
      call set_error(error, error_of_numerics, "the links turn too fast to be integrated")
    case (stop_many_steps)
      call set_error(error, error_of_numerics, "a million steps of the integration do not "// &
        "reach the next row: 'step=' or 'end=' is too long for a motion as fast as this, or "// &
        "motor or damping too strong for the masses")
    case (stop_locked)
      call set_error(error, error_of_numerics, "friction locks the joints: no acceleration "// &
        "balances the forces at this position")
    case default
      call set_error(error, error_of_numerics, "the steps of the integration shrink to nothing")
    end select
  end subroutine explain_stop

end module motion_study
