!> Forward dynamics of any linkage: its motion under a drive, resistances, gravity and constant
!! loads, in the coordinates of its free drives.
!!
!! The energy is never corrected, so that its balance measures the accuracy of the motion.
module linkage_motions
  use adaptive_integration, only: advance, close_integrator, integrator_t, open_integrator
  use constants, only: degree, two_pi
  use drives, only: drive_t
  use errors, only: error_of_dead_point, error_t, set_error
  use group_equations, only: drive_rate
  use interruption, only: was_interrupted
  use kinds, only: long, wp
  use linkage_paths, only: period_of
  use linkage_rates, only: energies_at, free_drives, moving_linkage_t, no_stop, pose_at, &
    stop_at_end, stop_dead_point, stop_many_steps, stop_steps
  use linkages, only: drives_angle, linkage_t, reference_point
  use pose_types, only: pose_t
  use poses, only: dead_point_sine, place_links
  use rigid_bodies, only: rigid_body_t
  implicit none (type, external)
  private

  public :: linkage_motion_t, linkage_sample_t, start_linkage_motion, move_linkage_until, &
    sample_linkage_motion, end_linkage_motion
  public :: linkage_motion_tolerance

  !> Bound on the estimated error of a step: some forty roundings.
  real(wp), parameter :: linkage_motion_tolerance = 1.0e-14_wp

  !> Near a dead point rates lose digits, and steps shrink to what rounding allows. This many steps
  !! in turn, each shorter than this share of the time to the next instant, with a scaled
  !! determinant below this, end the motion there.
  integer, parameter :: most_tiny_steps = 200
  real(wp), parameter :: tiny_step = 1.0e-5_wp, near_dead_point = 0.05_wp

  !> A motion in progress.
  type :: linkage_motion_t
    real(wp) :: time = 0.0_wp                     !! [s]
    real(wp) :: energy = 0.0_wp                   !! kinetic + potential, at the start [J]
    integer :: stop = no_stop                     !! why it does not continue
    type(error_t), allocatable :: left            !! of a block that then leaves its link
    integer(long) :: most_steps = 1000000_long    !! from one instant to the next
    type(integrator_t) :: integrator              !! to be closed by `end_linkage_motion`
    type(moving_linkage_t), private :: system     !! equations of motion
    real(wp), allocatable, private :: state(:)    !! coordinates, rates, work
  end type linkage_motion_t

  !> The linkage at an instant.
  type :: linkage_sample_t
    real(wp) :: time = 0.0_wp            !! [s]
    real(wp), allocatable :: position(:) !! (free drives) with all whole turns [deg] or [m]
    real(wp), allocatable :: rate(:)     !! (free drives) [rad/s] or [m/s]
    real(wp) :: torque = 0.0_wp          !! of the drive [N m] or [N]
    real(wp) :: kinetic = 0.0_wp         !! [J]
    real(wp) :: potential = 0.0_wp       !! of gravity and constant forces [J]
    real(wp) :: work = 0.0_wp            !! of drive, resistances and constant torques since the
                                         !! start [J]
    real(wp) :: energy_error = 0.0_wp    !! kinetic + potential − work, less its value at the start
                                         !! [J]
  end type linkage_sample_t

contains

  !> Prepares a motion at its first instant. Free drives start where the deck's affine relation with
  !! the first one puts them, with the rates of this relation.
  !!
  !! Errors: the start is out of reach or a dead point; no memory.
  subroutine start_linkage_motion(linkage, rigid, is_free, drive, taken, damping, crank, speed, &
    duration, motion, error)
    type(linkage_t), intent(in) :: linkage           !! of any kind, with loads and a path if it
                                                     !! needs one
    type(rigid_body_t), intent(in) :: rigid(:)       !! (bodies) of the linkage
    logical, intent(in) :: is_free(:)                !! (drives) marked; the first always is
    class(drive_t), intent(in) :: drive              !! torque or force on the first drive
    real(wp), intent(in) :: taken(:)                 !! (bodies) resisting torques [N m]
    real(wp), intent(in) :: damping(:)               !! (bodies) of their turning [N m s]
    real(wp), intent(in) :: crank                    !! of the first drive at the start [deg] or [m]
    real(wp), intent(in) :: speed                    !! of the first drive at the start [rad/s] or
                                                     !! [m/s]
    real(wp), intent(in) :: duration                 !! about how long it is to be followed [s]
    type(linkage_motion_t), intent(out) :: motion    !! at its first instant; to be ended by
                                                     !! `end_linkage_motion`
    type(error_t), allocatable, intent(out) :: error !! why it cannot begin

    type(pose_t) :: pose
    real(wp) :: unit, kinetic, potential
    integer :: f, k

    associate (system => motion%system)
      system%linkage = linkage
      system%rigid = rigid
      system%free = free_drives(is_free)
      allocate (system%drive, source=drive)
      system%taken = taken
      system%damping = damping
      system%period = period_of(linkage)
      f = size(system%free)
      allocate (motion%state(2*f + 1))
      motion%state = 0.0_wp
      do k = 1, f
        associate (free => linkage%drives(system%free(k)))
          unit = 1.0_wp
          if (free%kind == drives_angle) unit = degree
          motion%state(k) = unit*(free%ratio*crank + free%phase)
        end associate
      end do
      do k = 1, f
        motion%state(f + k) = speed*drive_rate(linkage, system%free(k))
      end do
      if (f > 1) then
        ! A start for iterations.
        call place_links(linkage, crank, system%pose, error)
        if (allocated(error)) return
        system%pose%pin = system%pose%pin - spread(reference_point(linkage), 2, &
          size(system%pose%pin, 2))
      end if
      call reduce(motion)
      call pose_at(system, motion%state(:f), pose, error)
      if (allocated(error)) return
      if (any(abs(pose%sine) < dead_point_sine)) then
        call set_error(error, error_of_dead_point, "dead point: a motion cannot start here")
        return
      end if
      system%pose = pose
      call energies_at(system, motion%state(:f), motion%state(f + 1:2*f), kinetic, potential, error)
      if (allocated(error)) return
      motion%energy = kinetic + potential
      call open_integrator(motion%integrator, [spread(span_of(linkage), 1, f), &
        spread(max(abs(speed), 1.0_wp/duration), 1, f), max(kinetic, tiny(1.0_wp)**0.25_wp)], &
        linkage_motion_tolerance, 0.01_wp*duration, error)
    end associate
  end subroutine start_linkage_motion

  !> Size of a coordinate: a radian, or the linkage.
  pure function span_of(linkage) result(span)
    type(linkage_t), intent(in) :: linkage
    real(wp) :: span

    span = 1.0_wp
    if (linkage%drives(1)%kind /= drives_angle) span = maxval(linkage%bodies%length)
  end function span_of

  !> Keeps the first coordinate, an angle, within half a turn.
  subroutine reduce(motion)
    type(linkage_motion_t), intent(inout) :: motion

    real(wp) :: turns

    if (motion%system%linkage%drives(1)%kind /= drives_angle) return
    turns = anint(motion%state(1)/two_pi)
    motion%state(1) = motion%state(1) - turns*two_pi
    motion%system%turned = motion%system%turned + 360.0_wp*turns
  end subroutine reduce

  !> Frees the integrator of a motion.
  subroutine end_linkage_motion(motion)
    type(linkage_motion_t), intent(inout) :: motion !! no longer to be continued

    call close_integrator(motion%integrator)
  end subroutine end_linkage_motion

  !> Follows the motion up to an instant, which is met exactly unless the motion stops or the run is
  !! interrupted; `motion%stop` gives the reason of a stop.
  subroutine move_linkage_until(motion, time)
    type(linkage_motion_t), intent(inout) :: motion !! begun
    real(wp), intent(in) :: time                    !! to be reached [s]

    type(error_t), allocatable :: error
    type(pose_t) :: pose
    integer(long) :: last_step
    real(wp) :: before, span
    integer :: tiny_steps

    tiny_steps = 0
    span = time - motion%time
    last_step = motion%integrator%steps + motion%most_steps
    do while (motion%time < time .and. motion%stop == no_stop)
      if (was_interrupted()) return
      if (motion%integrator%steps >= last_step) then
        motion%stop = stop_many_steps
        return
      end if
      motion%system%stop = no_stop
      before = motion%time
      call advance(motion%integrator, motion%system, motion%time, time, motion%state, error)
      if (allocated(error)) then
        motion%stop = merge(motion%system%stop, stop_steps, motion%system%stop /= no_stop)
        if (motion%stop == stop_at_end) motion%left = motion%system%left
        return
      end if
      call pose_at(motion%system, motion%state(:size(motion%system%free)), pose, error)
      if (.not. allocated(error)) then
        motion%system%pose = pose
        if (motion%time - before < tiny_step*span .and. motion%time < time .and. any(abs( &
          pose%sine) < near_dead_point)) then
          tiny_steps = tiny_steps + 1
        else
          tiny_steps = 0
        end if
        if (tiny_steps > most_tiny_steps) motion%stop = stop_dead_point
      end if
      call reduce(motion)
    end do
  end subroutine move_linkage_until

  !> Positions, rates, torque and energies at the present instant.
  subroutine sample_linkage_motion(motion, sample)
    type(linkage_motion_t), intent(in) :: motion  !! begun
    type(linkage_sample_t), intent(out) :: sample !! of this instant

    type(error_t), allocatable :: error
    integer :: f, k

    associate (system => motion%system)
      f = size(system%free)
      sample%time = motion%time
      sample%position = motion%state(:f)
      do k = 1, f
        if (system%linkage%drives(system%free(k))%kind == drives_angle) sample%position(k) = &
          motion%state(k)/degree
      end do
      sample%position(1) = sample%position(1) + system%turned
      sample%rate = motion%state(f + 1:2*f)
      sample%torque = system%drive%torque(motion%time, motion%state(1), sample%rate(1))
      call energies_at(system, motion%state(:f), sample%rate, sample%kinetic, sample%potential, &
        error)
      sample%work = motion%state(2*f + 1)
      sample%energy_error = sample%kinetic + sample%potential - sample%work - motion%energy
    end associate
  end subroutine sample_linkage_motion

end module linkage_motions
