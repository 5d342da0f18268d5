! src/studies/motion/ - the motion of a linkage under its motor and loads, sampled at instants.
! In: a linkage, a `motion_request_t`. Out: a `motion_result_t`. Begin with `begin_motion` and
! `continue_motion` here.
! Not here: the method (`src/linkage/free`), elastic motions in time (`src/response/transient`).

!> Forward dynamics: the motion of a linkage under given loads, sampled at given instants.
module motion_study
  use coordinate_study, only: coordinate_state, coordinate_state_t
  use drives, only: motor_drive_t
  use elastic_reactions, only: divide_motion, elastic_division_t, new_elastic_division
  use errors, only: error_of_numerics, error_of_reach, error_t, set_error
  use gears, only: gear_t
  use interruption, only: was_interrupted
  use joint_forces, only: joint_forces_t
  use joint_study, only: joint_t, joint_values, list_joints, open_joints
  use kinds, only: long, wp
  use linkage_motions, only: end_linkage_motion, find_linkage_details, &
    linkage_details_t, linkage_motion_t, linkage_sample_t, motion_tolerance, &
    move_linkage_until, passage_t, refuse_change_point, sample_linkage_motion, start_linkage_motion
  use linkage_paths, only: leave_path
  use linkage_rates, only: free_drives, no_stop, stop_change_point, stop_energy, stop_locked, &
    stop_many_steps, stop_misfit, stop_no_inertia, stop_too_fast
  use linkages, only: linkage_t
  use loop_poses, only: has_loop
  use rigid_bodies, only: rigid_bodies_of
  use structures, only: has_elastic_reactions, structure_t
  implicit none (type, external)
  private

  public :: motion_request_t, motion_result_t, motion_under_way_t, &
    begin_motion, continue_motion, finish_motion, &
    motion_tolerance, free_drives, undetermined_message

  type :: motion_request_t
    real(wp) :: start = 0.0_wp           !! of the first drive [deg] or [m]
    real(wp) :: speed = 0.0_wp           !! of the first drive [rad/s] or [m/s]
    real(wp), allocatable :: rates(:)    !! (drives) of further free ones at the start [rad/s] or
                                         !! [m/s]
    real(wp) :: end_time = 0.0_wp        !! [s]
    real(wp), allocatable :: instants(:) !! of the samples, ascending from 0 to `end_time` [s]
    logical, allocatable :: is_free(:)   !! (drives) marked in the deck
    type(motor_drive_t) :: drive         !! motor on the first drive
    type(gear_t) :: gear                 !! between them
    logical :: with_details = .false.    !! accelerations and powers are wanted
    logical :: with_forces = .false.     !! forces in the joints are wanted, and the former
    integer, allocatable :: held_by(:)   !! (coordinates) number of the drive of each; 0: none. Not
                                         !! allocated: coordinates are not wanted
    logical :: with_pins = .false.       !! the places of all pins are wanted
    logical :: through = .false.         !! straight through change points, in place of a stop there
  end type motion_request_t

  type :: motion_result_t
    integer :: count = 0                               !! instants reached
    type(linkage_sample_t), allocatable :: samples(:)  !! (all instants) the first `count` are set
    type(linkage_sample_t) :: last                     !! last state reached
    type(error_t), allocatable :: error                !! why it has not reached the end time
    integer(long) :: steps = 0_long                    !! of the integration
    integer(long) :: implicit_steps = 0_long           !! those of the implicit method among them
    real(wp) :: energy = 0.0_wp                        !! kinetic + potential, at the start [J]
    type(passage_t), allocatable :: passages(:)        !! dead points and change points that it has
                                                       !! passed
    logical :: has_begun = .false.                     !! the start was possible
    ! Where details are wanted:
    logical, allocatable :: is_determined(:)           !! (instants) else an instant has none
    real(wp), allocatable :: acceleration(:, :)        !! (free drives, instants) [rad/s²] or
                                                       !! [m/s²]; of a linkage of one loop (3,
                                                       !! instants) crank, coupler, follower
    real(wp), allocatable :: motor(:, :)               !! (2, instants) torque at its own shaft, and
                                                       !! speed [N m, rad/s] or [N, m/s]
    real(wp), allocatable :: power(:, :)               !! (3, instants) of the motor, lost in its
                                                       !! gear, of loads without a potential [W]
    type(joint_t), allocatable :: joints(:)            !! as in `joint_study`, where forces are
                                                       !! wanted
    real(wp), allocatable :: force(:, :, :)            !! (3, joints, instants) fx, fy, moment
                                                       !! [N, N m]
    logical, allocatable :: is_open(:, :)              !! (joints, instants) as in `joint_study`
    type(coordinate_state_t), allocatable :: coordinates(:, :) !! (coordinates, instants)
  end type motion_result_t

  !> What is said of an instant without details.
  character(len=*), parameter :: undetermined_message = &
    "forces do not determine the accelerations at this position"

  !> A motion that is being computed.
  type :: motion_under_way_t
    type(motion_request_t), private :: request
    type(linkage_motion_t), private :: motion
    type(linkage_t), private :: linkage
    type(elastic_division_t), allocatable, private :: division !! of linkages whose elasticity
                                                               !! divides forces
    integer, private :: next = 1  !! number of the next instant
    logical :: is_over = .false.  !! at the end, stopped or interrupted
  end type motion_under_way_t

contains

  !> Starts a motion. Errors, in `result%error`: those of `start_linkage_motion`.
  subroutine begin_motion(request, linkage, elements, under_way, result, structure)
    type(motion_request_t), intent(in) :: request      !! start, end and motor
    type(linkage_t), intent(in) :: linkage                     !! of any kind
    integer, intent(in) :: elements(:)                         !! (bodies) on whose nodes the masses
                                                               !! are lumped; 0: distributed
    type(motion_under_way_t), intent(out) :: under_way !! over if the start is impossible
    type(motion_result_t), intent(out) :: result       !! without samples yet
    class(structure_t), intent(in), optional :: structure      !! of this linkage, with its beams;
                                                               !! absent: none bends

    under_way%request = request
    under_way%linkage = linkage
    if (has_loop(linkage) .or. .not. request%through) call leave_path(under_way%linkage, &
      request%start)
    allocate (result%samples(size(request%instants)), result%passages(0))
    if (request%with_details) allocate (result%is_determined(size(request%instants)), &
      result%acceleration(merge(3, size(free_drives(request%is_free)), has_loop(linkage)), &
      size(request%instants)), result%power(3, size(request%instants)), &
      result%motor(2, size(request%instants)))
    if (allocated(request%held_by)) allocate (result%coordinates(size(request%held_by), &
      size(request%instants)))
    if (request%with_forces) then
      call list_joints(linkage, result%joints)
      allocate (result%force(3, size(result%joints), size(request%instants)))
      allocate (result%is_open(size(result%joints), size(request%instants)), source=.false.)
      if (present(structure)) call take_division(structure, under_way, result%error)
      under_way%is_over = allocated(result%error)
      if (under_way%is_over) return
    end if
    call start_linkage_motion(under_way%linkage, rigid_bodies_of(linkage, elements), &
      request%is_free, request%drive, request%start, request%speed, request%end_time, &
      under_way%motion, result%error, request%gear, request%through, request%rates)
    result%has_begun = .not. allocated(result%error)
    under_way%is_over = allocated(result%error)
  end subroutine begin_motion

  !> The division of forces by elasticity. Errors: a link has no own modes.
  subroutine take_division(structure, under_way, error)
    class(structure_t), intent(in) :: structure
    type(motion_under_way_t), intent(inout) :: under_way
    type(error_t), allocatable, intent(out) :: error

    if (.not. has_elastic_reactions(structure)) return
    allocate (under_way%division)
    call new_elastic_division(structure, under_way%division, error)
  end subroutine take_division

  !> Continues a motion over the next instants, until it is over or the given number is reached.
  subroutine continue_motion(under_way, instants, result)
    type(motion_under_way_t), intent(inout) :: under_way !! begun
    integer, intent(in) :: instants                              !! number, at most
    type(motion_result_t), intent(inout) :: result       !! gets the samples

    integer :: i

    do i = under_way%next, min(under_way%next + instants - 1, size(result%samples))
      if (under_way%is_over) return
      call move_linkage_until(under_way%motion, under_way%request%instants(i))
      under_way%is_over = was_interrupted()
      if (under_way%is_over) return
      call sample_linkage_motion(under_way%motion, result%last)
      if (.not. under_way%request%with_pins) deallocate (result%last%pin)
      under_way%is_over = under_way%motion%stop /= no_stop
      if (under_way%is_over) return
      result%samples(i) = result%last
      if (under_way%request%with_details) call take_details(under_way, i, result)
      result%count = i
    end do
    under_way%next = i
    under_way%is_over = under_way%next > size(result%samples)
  end subroutine continue_motion

  !> Accelerations, powers and forces of an instant.
  subroutine take_details(under_way, number, result)
    type(motion_under_way_t), intent(in) :: under_way
    integer, intent(in) :: number !! of the instant
    type(motion_result_t), intent(inout) :: result

    type(linkage_details_t) :: details
    type(joint_forces_t), allocatable :: states(:)
    type(error_t), allocatable :: error
    logical :: by_statics

    by_statics = under_way%request%with_forces .and. .not. allocated(under_way%division)
    call find_linkage_details(under_way%motion, by_statics, details, result%is_determined(number))
    if (.not. result%is_determined(number)) return
    if (allocated(under_way%division)) then
      call divide_motion(under_way%division, details%pose, details%motion, details%driven%torque, &
        details%joints, states, error)
      result%is_determined(number) = .not. allocated(error)
      if (allocated(error)) return
      result%is_open(:, number) = open_joints(under_way%linkage, result%joints, states)
    end if
    result%acceleration(:, number) = details%acceleration
    result%motor(:, number) = [details%driven%motor, under_way%request%gear%ratio* &
      result%last%rate(1)]
    result%power(:, number) = [details%driven%power, details%driven%loss, details%load_power]
    if (under_way%request%with_forces) result%force(:, :, number) = joint_values( &
      under_way%linkage, result%joints, details%joints, details%direction, details%turning)
    if (allocated(under_way%request%held_by)) call take_coordinates(under_way, details, &
      result%coordinates(:, number))
  end subroutine take_details

  !> Coordinates at an instant. What holds them is the motor, or the force of a drive.
  subroutine take_coordinates(under_way, details, states)
    type(motion_under_way_t), intent(in) :: under_way
    type(linkage_details_t), intent(in) :: details
    type(coordinate_state_t), intent(out) :: states(:)

    real(wp) :: force
    integer :: i

    do i = 1, size(states)
      associate (drive => under_way%request%held_by(i))
        force = 0.0_wp
        if (drive == 1) then
          force = details%driven%torque
        else if (drive > 1) then
          force = details%joints%drive(drive)
        end if
      end associate
      states(i) = coordinate_state(under_way%linkage, details%pose, details%motion, &
        details%pose%crank, i, force, [1.0_wp, 0.0_wp])
    end do
  end subroutine take_coordinates

  !> Ends a motion and completes its result.
  !!
  !! Errors, in `result%error`: the motion has stopped before its end.
  subroutine finish_motion(under_way, result)
    type(motion_under_way_t), intent(inout) :: under_way !! its memory is released
    type(motion_result_t), intent(inout) :: result       !! gets steps, energy, passages

    if (.not. result%has_begun) return
    associate (motion => under_way%motion)
      result%steps = motion%integrator%steps
      result%implicit_steps = motion%integrator%implicit_steps
      result%energy = motion%energy
      result%passages = motion%passages(:motion%passage_count)
      if (allocated(motion%left)) then
        result%error = motion%left
      else
        call explain_stop(motion%stop, has_loop(under_way%linkage), result%error)
      end if
    end associate
    call end_linkage_motion(under_way%motion)
  end subroutine finish_motion

  !> Turns the reason why a motion has stopped into an error; none for `no_stop`.
  pure subroutine explain_stop(stop, in_loop, error)
    integer, intent(in) :: stop    !! as in `linkage_rates`
    logical, intent(in) :: in_loop !! the linkage has one loop, in which all links turn
    type(error_t), allocatable, intent(inout) :: error

    select case (stop)
    case (no_stop)
      return
    case (stop_change_point)
      call refuse_change_point(in_loop, error)
    case (stop_misfit)
      call set_error(error, error_of_reach, "redundant links do not fit beyond this position")
    case (stop_energy)
      call set_error(error, error_of_numerics, "the energies do not balance: the motion has "// &
        "lost its digits")
    case (stop_no_inertia)
      call set_error(error, error_of_numerics, "nothing with a mass moves"//trim(merge( &
        " with the linkage", "                 ", in_loop))//" at this position: there is no "// &
        "inertia")
    case (stop_too_fast)
      call set_error(error, error_of_numerics, "the links "//merge("turn", "move", in_loop)// &
        " too fast to be integrated")
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
