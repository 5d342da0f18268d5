!> Forward dynamics of a model: its motion from a start on, kept at the instants that are to be
!! written.
module motion_study
  use attached_parts, only: body_of
  use drives, only: motor_drive_t, resistances_t
  use errors, only: error_t
  use forward_motions, only: end_motion, forward_motion_t, motion_sample_t, move_until, &
    sample_motion, start_motion, turning_point_t
  use four_bar_rates, only: no_stop, stop_change_point, stop_many_steps, stop_no_inertia, &
    stop_too_fast
  use interruption, only: was_interrupted
  use kinds, only: long, wp
  use loop_curves, only: change_point_message
  use mechanisms, only: mechanism_t
  use models, only: model_t, report_number
  use progress, only: progress_t, show_progress
  use request_cards, only: report_motion, report_t
  use rigid_bodies, only: rigid_bodies_of
  implicit none (type, external)
  private

  public :: motion_run_t, run_motion, has_motion, motion_rows_of, motion_failed, motion_failure

  !> The end of a motion is one of its instants when it is hit within this share of a step.
  real(wp), parameter :: hit = 1.0e-9_wp

  type :: motion_run_t
    integer :: count = 0                               !! of instants that the motion has reached
    type(motion_sample_t), allocatable :: samples(:)   !! (all instants); not allocated: no motion
                                                       !! is asked for
    type(turning_point_t), allocatable :: turnings(:)  !! where the crank turns back
    type(motion_sample_t) :: last                      !! where it ends
    type(error_t), allocatable :: error                !! why it does not begin
    integer :: stop = no_stop                          !! why it does not go on
    integer(long) :: steps = 0_long                    !! of the integration
    real(wp) :: energy = 0.0_wp                        !! kinetic and potential, at the start [J]
  end type motion_run_t

contains

  !> Computes the motion that a model asks for, if it does. Its failures are part of the result.
  subroutine run_motion(model, mechanism, progress, run)
    type(model_t), intent(in) :: model
    type(mechanism_t), intent(in) :: mechanism
    type(progress_t), intent(inout) :: progress
    type(motion_run_t), intent(inout) :: run

    type(forward_motion_t) :: motion
    integer :: i, number

    number = report_number(model, report_motion)
    if (number == 0) return
    associate (asked => model%reports(number))
      allocate (run%samples(motion_rows(asked)), run%turnings(0))
      run%last%angle(1) = asked%start_angle
      call start_motion(mechanism%linkage, rigid_bodies_of(mechanism%linkage, &
        mechanism%load_elements), drive_of(model), resistances_of(model), asked%start_angle, &
        asked%start_speed, asked%end_time, motion, run%error)
      if (allocated(run%error)) return
      do i = 1, size(run%samples)
        call move_until(motion, instant(asked, i))
        if (was_interrupted()) exit
        run%last = sample_motion(motion)
        if (motion%stop /= no_stop) exit
        run%samples(i) = run%last
        run%count = i
        call show_progress(progress, i, size(run%samples))
      end do
    end associate
    run%turnings = motion%turnings(:motion%turning_count)
    run%stop = motion%stop
    run%steps = motion%integrator%steps
    run%energy = motion%energy
    call end_motion(motion)
  end subroutine run_motion

  !> Number of instants `0, step, 2 step, …` up to the end.
  pure function motion_rows(asked) result(rows)
    type(report_t), intent(in) :: asked !! REPORT motion
    integer :: rows

    rows = 1 + int(asked%end_time/asked%time_step + hit)
  end function motion_rows

  !> The same for what a model asks for, which may be no motion.
  pure function motion_rows_of(model) result(rows)
    type(model_t), intent(in) :: model
    integer :: rows

    integer :: number

    rows = 0
    number = report_number(model, report_motion)
    if (number > 0) rows = motion_rows(model%reports(number))
  end function motion_rows_of

  !> An instant by its number, from 1 [s].
  pure function instant(asked, number) result(time)
    type(report_t), intent(in) :: asked !! REPORT motion
    integer, intent(in) :: number
    real(wp) :: time

    time = (number - 1)*asked%time_step
    if (abs(time - asked%end_time) <= hit*asked%time_step) time = asked%end_time
  end function instant

  !> The motor on the driven link; none pulls with nothing.
  pure function drive_of(model) result(drive)
    type(model_t), intent(in) :: model
    type(motor_drive_t) :: drive

    associate (motor => model%motor)
      drive%stall = merge(motor%stall, motor%torque, motor%is_line)
      if (motor%is_line) drive%slope = motor%stall/motor%noload
    end associate
  end function drive_of

  !> What the LOAD cards, at most one a link, take from the bodies.
  pure function resistances_of(model) result(resistances)
    type(model_t), intent(in) :: model
    type(resistances_t) :: resistances

    integer :: i, body

    do i = 1, size(model%resistances)
      associate (resistance => model%resistances(i))
        body = body_of(model, resistance%link)
        resistances%taken(body) = resistance%torque
        resistances%damping(body) = resistance%damping
      end associate
    end do
  end function resistances_of

  !> Whether a motion was asked for.
  pure function has_motion(run) result(has)
    type(motion_run_t), intent(in) :: run
    logical :: has

    has = allocated(run%samples)
  end function has_motion

  !> Whether it has not reached its end.
  pure function motion_failed(run) result(failed)
    type(motion_run_t), intent(in) :: run
    logical :: failed

    failed = allocated(run%error) .or. run%stop /= no_stop
  end function motion_failed

  !> Why not; empty if it has.
  pure function motion_failure(run) result(reason)
    type(motion_run_t), intent(in) :: run
    character(len=:), allocatable :: reason

    reason = ""
    if (allocated(run%error)) then
      reason = run%error%message
      return
    end if
    select case (run%stop)
    case (no_stop)
      return
    case (stop_change_point)
      reason = change_point_message
    case (stop_no_inertia)
      reason = "nothing that has a mass moves here with the linkage: there is no inertia"
    case (stop_too_fast)
      reason = "the links turn too fast to be followed"
    case (stop_many_steps)
      reason = "a million steps of the integration do not reach the next row: 'step=' or "// &
        "'end=' is too long for a motion as "// &
        "fast as this, or motor or damping too strong for the masses"
    case default
      reason = "the steps of the integration shrink to nothing"
    end select
  end function motion_failure

end module motion_study
