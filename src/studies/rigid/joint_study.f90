! src/studies/rigid/ - studies of the rigid linkage: kinematics, forces, limits, sizing.
! In: a linkage, positions, speeds. Out: results. Forces are found per unit load case;
! `joints_at_speed` gives them at a speed. Begin with `find_joints` here; then `find_limits` in
! `limits_study.f90`.
! Not here: balancing (`src/studies/balance`), motions (`src/studies/motion`), the methods
! (`src/linkage`).

!> Forces in the joints of any linkage: on every link at every pin, of guides, blocks and welds, of
!! the drives, those that shake the ground, and all that it bears.
module joint_study
  use applied_loads, only: evaluate_loads, standing_pulls
  use constants, only: degree
  use coordinate_study, only: coordinate_state, coordinate_state_t
  use coordinates, only: evaluated_t
  use elastic_reactions, only: elastic_division_t, least_open, self_stresses
  use errors, only: error_t, outcome_t
  use frame_forces, only: find_frame_load
  use ground_loads, only: pulls_on_ground
  use drive_values, only: drive_value, find_rates_of_drives
  use joint_forces, only: force_at_pin, joint_forces_t
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkages, only: cross, is_actuated, linkage_t, reference_point, turned, turned_back
  use load_cases, only: case_count, constant_case
  use pose_types, only: pins_of_body, pose_t
  use position_loads, only: find_position_loads, find_speed_loads, position_loads_t
  use positions, only: positions_t, state_t
  use rounded_sums, only: rounded_sum_t, without_rounding
  use running_loads, only: depends_on_speed, lock_of, lock_t, running_t
  implicit none (type, external)
  private

  public :: joint_t, joints_result_t, list_joints, open_joints, joint_values, find_joints, &
    joints_at_speed, bearings_at_speed, drives_at_speed, frame_at_speed, bearing_values

  !> Values of a joint in `bearings_at_speed`: fx, fy, axial, transverse, magnitude, angle.
  integer, parameter :: bearing_values = 6

  !> A force below this share of the largest one at its position has no direction: it is round-off.
  real(wp), parameter :: round_off_share = 1.0e-12_wp

  !> A row of forces: of a pin on a body, or of a slider on its pin or on the body of its line.
  type :: joint_t
    integer :: pin = 0
    integer :: body = 0   !! on which the force acts; 0: on the pin, by a fixed guide
    integer :: slider = 0 !! whose force it is; 0: that of the pin
  end type joint_t

  !> Forces under the three unit loads, and what loads that depend on the speed add to them. The
  !! forces at any speed are sums of these. Zeros where there is no pose.
  type :: joints_result_t
    type(joint_t), allocatable :: joints(:)    !! pins in their order, then sliders
    real(wp), allocatable :: force(:, :, :, :) !! (3, joints, cases, states) fx, fy, moment [N, N m]
    real(wp), allocatable :: drive(:, :, :)    !! (drives, cases, states) [N m] or [N]
    real(wp), allocatable :: shaking(:, :, :)  !! (3, cases, states) force and moment [N, N m]
    real(wp), allocatable :: running_force(:, :, :, :) !! (3, joints, speeds, states) added at each
                                               !! speed, as `force`; no speeds: nothing is
    real(wp), allocatable :: running_drive(:, :, :)    !! (drives, speeds, states), as `drive`
    real(wp), allocatable :: frame(:, :, :)    !! (3, cases, states) force on the frame, and moment
                                               !! about `reference_point` [N, N m]
    real(wp), allocatable :: running_frame(:, :, :)    !! (3, speeds, states), as `frame`
    type(lock_t), allocatable :: lock(:, :)    !! (speeds, states) where friction locks the linkage
    type(outcome_t), allocatable :: outcome(:) !! (states) why elasticity does not divide the forces
                                               !! there
    logical, allocatable :: is_open(:, :)      !! (joints, states) rigid links alone hold each other
                                               !! there, and nothing tells the force
  end type joints_result_t

contains

  !> Forces at all positions, once for all speeds.
  subroutine find_joints(linkage, elements, positions, threads, found, speeds, accelerations, &
    division)
    type(linkage_t), intent(in) :: linkage      !! of any kind
    integer, intent(in) :: elements(:)          !! (bodies) on whose nodes the masses are lumped;
                                                !! 0: distributed
    type(positions_t), intent(in) :: positions  !! of the run
    integer, intent(in) :: threads              !! number of OpenMP threads
    type(joints_result_t), intent(out) :: found !! for all positions and speeds
    real(wp), intent(in), optional :: speeds(:, :) !! (speeds, states) of the first drive, for loads
                                                   !! that depend on it [rad/s] or [m/s]; absent:
                                                   !! without these
    real(wp), intent(in), optional :: accelerations(:, :) !! (speeds, states) likewise, for friction
                                                   !! [rad/s²] or [m/s²]; absent: none
    type(elastic_division_t), intent(in), optional :: division !! of this linkage, whose elasticity
                                                   !! divides the forces of links that are more than
                                                   !! needed; absent: there are none

    integer :: i, n, running_speeds

    call list_joints(linkage, found%joints)
    n = size(positions%states)
    allocate (found%force(3, size(found%joints), case_count, n), &
      found%drive(size(linkage%drives), case_count, n), found%shaking(3, case_count, n), &
      found%frame(3, case_count, n))
    found%force = 0.0_wp
    found%drive = 0.0_wp
    found%shaking = 0.0_wp
    found%frame = 0.0_wp
    running_speeds = 0
    if (present(speeds) .and. depends_on_speed(linkage)) running_speeds = size(speeds, 1)
    allocate (found%running_force(3, size(found%joints), running_speeds, n), &
      found%running_drive(size(linkage%drives), running_speeds, n), &
      found%running_frame(3, running_speeds, n), found%lock(running_speeds, n))
    found%running_force = 0.0_wp
    found%running_drive = 0.0_wp
    found%running_frame = 0.0_wp
    allocate (found%is_open(size(found%joints), n), source=.false.)
    allocate (found%outcome(n))
    !$omp parallel do num_threads(threads) schedule(dynamic, 32) default(shared) private(i)
    do i = 1, n
      if (.not. allocated(positions%states(i)%error)) call find_at(i, positions%states(i))
    end do
    !$omp end parallel do

  contains

    !> Forces at a state.
    subroutine find_at(i, state)
      integer, intent(in) :: i !! number of the state
      type(state_t), intent(in) :: state

      type(position_loads_t) :: loads
      type(running_t) :: running
      type(error_t), allocatable :: failure
      type(evaluated_t), allocatable :: along(:)
      real(wp) :: acceleration
      integer :: k

      call find_position_loads(linkage, elements, state%pose, state%coefficients, loads, &
        failure, division)
      if (allocated(failure)) then
        found%outcome(i)%error = failure
        return
      end if
      if (present(division)) found%is_open(:, i) = open_joints(linkage, found%joints, &
        self_stresses(division, loads%at))
      do k = 1, case_count
        call take_forces(linkage, found%joints, loads%unit%of_case(k)%joints, found%force(:, :, &
          k, i))
        associate (of_case => loads%unit%of_case(k))
          found%drive(:, k, i) = drives_of(of_case%joints)
          found%shaking(:, k, i) = [of_case%shaking_force, of_case%shaking_moment]
          found%frame(:, k, i) = find_frame_load(linkage, state%pose, of_case%joints)
        end associate
      end do
      call turn_guides(linkage, found%joints, state%pose%direction, found%force(:, :, :, i))
      do k = 1, running_speeds
        acceleration = 0.0_wp
        if (present(accelerations)) acceleration = accelerations(k, i)
        call find_speed_loads(linkage, state%pose, state%coefficients, speeds(k, i), &
          acceleration, loads, running, failure, division)
        if (allocated(failure)) then
          found%outcome(i)%error = failure
          exit
        end if
        found%lock(k, i) = lock_of(running)
        if (found%lock(k, i)%friction > 0) cycle
        call take_forces(linkage, found%joints, running%joints, found%running_force(:, :, k, i))
        found%running_drive(:, k, i) = drives_of(running%joints)
        found%running_frame(:, k, i) = find_frame_load(linkage, state%pose, running%joints) + &
          running%on_ground
      end do
      call evaluate_loads(linkage, state%pose, along)
      found%frame(:, constant_case, i) = found%frame(:, constant_case, i) + &
        pulls_on_ground(linkage, state%pose, along, standing_pulls(linkage, along))
      call turn_guides(linkage, found%joints, state%pose%direction, found%running_force(:, :, :, &
        i))
      call add_blocks(linkage, found%joints, state%coefficients, found%force(:, :, :, i))
    end subroutine find_at

  end subroutine find_joints

  !> Joints whose forces are open: those of any state of self-stress.
  pure function open_joints(linkage, joints, states) result(are)
    type(linkage_t), intent(in) :: linkage        !! its turns
    type(joint_t), intent(in) :: joints(:)        !! of `list_joints`
    type(joint_forces_t), intent(in) :: states(:) !! of `self_stresses`
    logical :: are(size(joints))

    real(wp) :: values_of(3, size(joints)), length
    integer :: i

    are = .false.
    length = maxval(linkage%bodies%length)
    do i = 1, size(states)
      values_of = 0.0_wp
      call take_forces(linkage, joints, states(i), values_of)
      are = are .or. norm2(values_of(:2, :), dim=1) > least_open .or. abs(values_of(3, :)) > &
        least_open*length
    end do
  end function open_joints

  !> Torques or forces of all drives [N m] or [N].
  pure function drives_of(forces) result(drive)
    type(joint_forces_t), intent(in) :: forces
    real(wp), allocatable :: drive(:)

    if (allocated(forces%drive)) then
      drive = forces%drive
    else
      drive = [forces%torque]
    end if
  end function drives_of

  !> All joints: every body at every pin, then every slider.
  pure subroutine list_joints(linkage, joints)
    type(linkage_t), intent(in) :: linkage               !! its bodies and sliders
    type(joint_t), allocatable, intent(out) :: joints(:) !! pins in their order, then sliders

    type(joint_t), allocatable :: room(:)
    integer :: p, b, i, filled

    allocate (room(size(linkage%is_ground)*size(linkage%bodies) + 2*size(linkage%sliders)))
    filled = 0
    do p = 1, size(linkage%is_ground)
      do b = 1, size(linkage%bodies)
        if (.not. any(pins_of_body(linkage%bodies(b)) == p)) cycle
        filled = filled + 1
        room(filled) = joint_t(p, b, 0)
      end do
    end do
    do i = 1, size(linkage%sliders)
      filled = filled + 1
      room(filled) = joint_t(linkage%sliders(i)%pin, linkage%sliders(i)%body, i)
    end do
    allocate (joints(filled))
    joints = room(:filled)
  end subroutine list_joints

  !> Force and moment of every joint of a linkage in a known motion, as of `joints_at_speed`.
  pure function joint_values(linkage, joints, forces, direction, turning) result(values_of)
    type(linkage_t), intent(in) :: linkage     !! its sliders and turns
    type(joint_t), intent(in) :: joints(:)     !! of `list_joints`
    type(joint_forces_t), intent(in) :: forces !! of this linkage
    real(wp), intent(in) :: direction(:, :)    !! (2, bodies) unit vectors
    real(wp), intent(in) :: turning(:)         !! (bodies) angular accelerations [rad/s²]
    real(wp) :: values_of(3, size(joints))     !! fx, fy, moment [N, N m]

    real(wp) :: force(3, size(joints), 1)
    integer :: i

    force = 0.0_wp
    call take_forces(linkage, joints, forces, force(:, :, 1))
    call turn_guides(linkage, joints, direction, force)
    values_of = force(:, :, 1)
    do i = 1, size(joints)
      if (joints(i)%slider == 0 .or. joints(i)%body == 0) cycle
      values_of(3, i) = values_of(3, i) - linkage%sliders(joints(i)%slider)%inertia* &
        turning(joints(i)%body)
    end do
  end function joint_values

  !> Forces and moments of one unit load. That of a slider is along the normal of its line, its
  !! first component, and by friction along the line, its second, until `turn_guides` turns it.
  pure subroutine take_forces(linkage, joints, forces, values_of)
    type(linkage_t), intent(in) :: linkage
    type(joint_t), intent(in) :: joints(:)
    type(joint_forces_t), intent(in) :: forces
    real(wp), intent(inout) :: values_of(:, :) !! (3, joints)

    integer :: i, t

    do i = 1, size(joints)
      associate (joint => joints(i))
        if (joint%slider > 0) then
          values_of(1, i) = forces%guide(joint%slider)
        else
          values_of(:2, i) = force_at_pin(linkage, forces, joint%body, joint%pin)
        end if
        do t = 1, size(linkage%turns)
          associate (turn => linkage%turns(t))
            if (turn%pin /= joint%pin .or. turn%slider /= joint%slider .and. &
              .not. (joint%slider == 0 .and. turn%slider > 0)) cycle
            ! The moment on the block is that of its guide; a link on the block bears it.
            if (joint%slider > 0) then
              values_of(3, i) = values_of(3, i) + merge(-1.0_wp, 1.0_wp, joint%body > 0)* &
                forces%couple(t)
            else if (turn%body == joint%body) then
              values_of(3, i) = values_of(3, i) + forces%couple(t)
            else if (turn%against == joint%body .and. turn%slider == 0) then
              values_of(3, i) = values_of(3, i) - forces%couple(t)
            end if
          end associate
        end do
      end associate
    end do
    if (allocated(forces%friction)) call take_friction(linkage, joints, forces%friction, values_of)
  end subroutine take_forces

  !> Adds friction: a force along the line of a slider; a couple in a pin, to the moments on both of
  !! its links. Where a pin turns on a block, the couple acts on the link and on the body that bears
  !! the block: that of the line, or the guide. A ground pivot has no row.
  pure subroutine take_friction(linkage, joints, effort, values_of)
    type(linkage_t), intent(in) :: linkage
    type(joint_t), intent(in) :: joints(:)
    real(wp), intent(in) :: effort(:)          !! (frictions) of `joint_forces_t`
    real(wp), intent(inout) :: values_of(:, :) !! (3, joints)

    integer :: i, k

    do k = 1, size(effort)
      associate (rub => linkage%frictions(k))
        do i = 1, size(joints)
          associate (joint => joints(i))
            if (joint%pin /= rub%pin) cycle
            if (rub%slider > 0) then
              if (joint%slider == rub%slider) values_of(2, i) = values_of(2, i) + effort(k)
            else if (joint%body == 0) then
              ! By the guide on the block, against the couple by the link.
              if (rub%against == 0) values_of(3, i) = values_of(3, i) + effort(k)
            else if (joint%body == rub%body) then
              values_of(3, i) = values_of(3, i) + effort(k)
            else if (joint%body == rub%against) then
              values_of(3, i) = values_of(3, i) - effort(k)
            end if
          end associate
        end do
      end associate
    end do
  end subroutine take_friction

  !> Forces of sliders from the axes of their lines to global axes; those on the body of a line are
  !! opposite to those on the pin. The force of a drive along the line belongs to the drive.
  pure subroutine turn_guides(linkage, joints, direction, force)
    type(linkage_t), intent(in) :: linkage
    type(joint_t), intent(in) :: joints(:)
    real(wp), intent(in) :: direction(:, :)    !! (2, bodies)
    real(wp), intent(inout) :: force(:, :, :)  !! (3, joints, cases)

    real(wp) :: normal(2), axis(2)
    integer :: i, k

    do i = 1, size(joints)
      if (joints(i)%slider == 0) cycle
      associate (slider => linkage%sliders(joints(i)%slider))
        axis = slider%direction
        if (slider%body > 0) axis = -(slider%direction(1)*direction(:, slider%body) + &
          slider%direction(2)*[-direction(2, slider%body), direction(1, slider%body)])
        normal = [-axis(2), axis(1)]
      end associate
      do k = 1, size(force, 3)
        force(:2, i, k) = force(1, i, k)*normal + force(2, i, k)*axis
      end do
    end do
  end subroutine turn_guides

  !> The moments with which blocks that turn load the bodies of their lines: −I α.
  pure subroutine add_blocks(linkage, joints, coefficients, force)
    type(linkage_t), intent(in) :: linkage
    type(joint_t), intent(in) :: joints(:)
    type(kinematic_coefficients_t), intent(in) :: coefficients
    real(wp), intent(inout) :: force(:, :, :) !! (3, joints, cases)

    integer :: i

    do i = 1, size(joints)
      if (joints(i)%slider == 0 .or. joints(i)%body == 0) cycle
      associate (inertia => linkage%sliders(joints(i)%slider)%inertia, body => joints(i)%body)
        force(3, i, 1) = force(3, i, 1) - inertia*coefficients%turn_slope(body)
        force(3, i, 2) = force(3, i, 2) - inertia*coefficients%turn(body)
      end associate
    end do
  end subroutine add_blocks

  !> Force and moment of every joint at a speed: under the unit loads times ω2² and α2, under the
  !! constant loads, and under loads that depend on the speed.
  pure function joints_at_speed(found, state, speed, acceleration, number) result(forces)
    type(joints_result_t), intent(in) :: found !! for all positions
    integer, intent(in) :: state               !! number; with a pose
    real(wp), intent(in) :: speed              !! of the first drive [rad/s] or [m/s]
    real(wp), intent(in) :: acceleration       !! of the first drive [rad/s²] or [m/s²]
    integer, intent(in), optional :: number !! of the speed, for loads that depend on it; absent:
                                            !! without these
    real(wp) :: forces(3, size(found%joints))  !! fx, fy, moment [N, N m]

    real(wp) :: factor(case_count)
    integer :: k

    factor = [speed**2, acceleration, 1.0_wp]
    forces = 0.0_wp
    do k = 1, case_count
      forces = forces + factor(k)*found%force(:, :, k, state)
    end do
    if (.not. present(number)) return
    if (size(found%running_force, 3) > 0) forces = forces + found%running_force(:, :, number, state)
  end function joints_at_speed

  !> The force in every joint in global axes and in those of the link on which it acts, as its LINK
  !! card measures: along the way from the first pin of the card to the second, and to the left of
  !! it; of a fixed guide, along the guide. The angle is that of the force in these axes.
  pure function bearings_at_speed(linkage, found, pose, state, speed, acceleration, number) &
    result(values)
    type(linkage_t), intent(in) :: linkage      !! its bodies and sliders
    type(joints_result_t), intent(in) :: found  !! for all positions
    type(pose_t), intent(in) :: pose            !! of the state
    integer, intent(in) :: state                !! number; with a pose
    real(wp), intent(in) :: speed               !! of the first drive [rad/s] or [m/s]
    real(wp), intent(in) :: acceleration        !! of the first drive [rad/s²] or [m/s²]
    integer, intent(in) :: number               !! of the speed, for loads that depend on it
    real(wp) :: values(bearing_values, size(found%joints)) !! [N]; the angle in (−180, 180] [deg],
                                                !! 0 of a force that is round-off

    real(wp) :: forces(3, size(found%joints)), largest
    integer :: i

    forces = joints_at_speed(found, state, speed, acceleration, number)
    largest = 0.0_wp
    do i = 1, size(found%joints)
      largest = max(largest, norm2(forces(:2, i)))
    end do
    do i = 1, size(found%joints)
      associate (local => turned_back(forces(:2, i), joint_axis(linkage, found%joints(i), pose)))
        values(:, i) = [forces(:2, i), local, norm2(forces(:2, i)), &
          angle_of(local, round_off_share*largest)]
      end associate
    end do
  end function bearings_at_speed

  !> The axis of the link, or of the guide, on which a joint acts: a unit vector in global axes.
  pure function joint_axis(linkage, joint, pose) result(axis)
    type(linkage_t), intent(in) :: linkage
    type(joint_t), intent(in) :: joint
    type(pose_t), intent(in) :: pose
    real(wp) :: axis(2)

    if (joint%body > 0) then
      axis = turned(linkage%bodies(joint%body)%card_axis, pose%direction(:, joint%body))
    else
      axis = linkage%sliders(joint%slider)%direction
    end if
  end function joint_axis

  !> Angle of a force, which round-off does not throw from 180° to −180° [deg].
  pure function angle_of(force, round_off) result(angle)
    real(wp), intent(in) :: force(2)
    real(wp), intent(in) :: round_off !! of its components
    real(wp) :: angle

    angle = 0.0_wp
    if (norm2(force) <= round_off) return
    if (force(1) < 0.0_wp .and. abs(force(2)) <= round_off) then
      angle = 180.0_wp
    else
      angle = atan2(force(2), force(1))/degree
    end if
  end function angle_of

  !> Shaking force and moment, then force and moment on the frame, at a position and speed.
  !!
  !! The former are the resultant of the inertia forces −Σ m a, and their moment with all −I α
  !! (Berkof and Lowen 1969); the latter are of all forces at the ground, loads and weights among
  !! them, and of the reactions of the drives (Norton, Design of Machinery, section 11.8).
  pure function frame_at_speed(linkage, found, state, speed, acceleration, number, about) &
    result(values)
    type(linkage_t), intent(in) :: linkage     !! its point of reference
    type(joints_result_t), intent(in) :: found !! for all positions
    integer, intent(in) :: state               !! number; with a pose
    real(wp), intent(in) :: speed              !! of the first drive [rad/s] or [m/s]
    real(wp), intent(in) :: acceleration       !! of the first drive [rad/s²] or [m/s²]
    integer, intent(in) :: number              !! of the speed, for loads that depend on it
    real(wp), intent(in), optional :: about(2) !! point about which moments are, in global axes;
                                               !! absent: `reference_point` [m]
    real(wp) :: values(6)                      !! fx, fy, moment, twice [N, N m]

    type(rounded_sum_t) :: sums(6)
    real(wp) :: factor(case_count), arm(2)
    integer :: k

    factor = [speed**2, acceleration, 1.0_wp]
    do k = 1, case_count
      call sums%add(factor(k)*[found%shaking(:, k, state), found%frame(:, k, state)])
    end do
    if (size(found%running_frame, 2) > 0) call sums(4:)%add(found%running_frame(:, number, state))
    if (present(about)) then
      arm = reference_point(linkage) - about
      call sums(3)%add(cross(arm, sums(:2)%value))
      call sums(6)%add(cross(arm, sums(4:5)%value))
    end if
    values = without_rounding(sums)
  end function frame_at_speed

  !> Position, rate and force of every drive at a position and speed, or of the actuators that give
  !! efforts in their place.
  pure function drives_at_speed(linkage, found, at, state, crank, speed, acceleration, number) &
    result(drives)
    type(linkage_t), intent(in) :: linkage     !! its drives
    type(joints_result_t), intent(in) :: found !! for all positions
    type(state_t), intent(in) :: at            !! with a pose
    integer, intent(in) :: state               !! its number
    real(wp), intent(in) :: crank              !! coordinate of the first drive [deg] or [m]
    real(wp), intent(in) :: speed              !! of the first drive [rad/s] or [m/s]
    real(wp), intent(in) :: acceleration       !! of the first drive [rad/s²] or [m/s²]
    integer, intent(in), optional :: number !! of the speed, for loads that depend on it; absent:
                                            !! without these
    real(wp) :: drives(3, size(linkage%drives)) !! [deg, rad/s, N m] or [m, m/s, N]

    real(wp), dimension(size(linkage%drives)) :: rates, accelerations
    type(coordinate_state_t) :: moved
    integer :: d

    call find_rates_of_drives(linkage, crank, rates, accelerations)
    do d = 1, size(linkage%drives)
      if (is_actuated(linkage)) then
        moved = coordinate_state(linkage, at%pose, at%coefficients, crank, &
          linkage%actuators(d)%coordinate, 0.0_wp, [speed, acceleration])
        drives(:2, d) = [moved%value, moved%rate]
      else
        drives(:2, d) = [drive_value(linkage, d, crank), rates(d)*speed]
      end if
      drives(3, d) = speed**2*found%drive(d, 1, state) + acceleration*found%drive(d, 2, state) + &
        found%drive(d, 3, state)
    end do
    if (.not. present(number)) return
    if (size(found%running_drive, 2) > 0) drives(3, :) = drives(3, :) + found%running_drive(:, &
      number, state)
  end function drives_at_speed

end module joint_study
