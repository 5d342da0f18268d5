!> The equations of motion of a linkage at an instant: M, loads, and what follows of ü.
module linkage_instants
  use applied_loads, only: add_conservative_loads, add_moving_loads, add_prescribed_loads, &
    generalised_force
  use coordinates, only: evaluated_t
  use free_friction, only: find_free_friction
  use gears, only: driven_t
  use inertia_loads, only: load_t
  use joint_friction, only: friction_t, has_friction, is_solved
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkages, only: linkage_t
  use pose_types, only: pose_t
  use rigid_bodies, only: central_inertia, mass_centre, rigid_body_t
  use whole_systems, only: whole_system_t
  implicit none (type, external)
  private

  public :: linkage_instant_t, make_room, find_inertia, add_loads, add_accelerations

  !> The first drive and its motor.
  type :: first_drive_t
    real(wp), allocatable :: per(:) !! (coordinates) its rate per rate of each
    real(wp) :: rate = 0.0_wp       !! [rad/s] or [m/s]
    real(wp) :: bent = 0.0_wp       !! its acceleration without ü [rad/s²] or [m/s²]
    real(wp) :: motor = 0.0_wp      !! torque on the motor's shaft [N m] or [N]
  end type first_drive_t

  !> A linkage at an instant of its motion.
  type :: linkage_instant_t
    type(pose_t) :: pose                         !! pins from `reference_point`
    type(kinematic_coefficients_t), allocatable :: per(:) !! (coordinates) velocities per rate
    type(kinematic_coefficients_t) :: motion     !! velocities, and accelerations
    type(evaluated_t), allocatable :: along(:)   !! (loads) of `evaluate_loads`
    real(wp), allocatable :: acceleration(:)     !! (coordinates) ü
    type(driven_t) :: driven                     !! motor and gear
    real(wp) :: load_power = 0.0_wp              !! of all loads without a potential [W]
    real(wp) :: power = 0.0_wp                   !! of these and of the drive, less what the gear
                                                 !! takes [W]
    type(load_t), allocatable :: body_load(:)    !! (bodies) of all loads, but for weights, constant
                                                 !! forces on pins and constant torques
    real(wp), allocatable :: pin_load(:, :)      !! (2, pins) likewise [N]
    real(wp), allocatable :: friction(:)         !! (frictions) efforts [N m] or [N]; not allocated
                                                 !! where nothing rubs
    type(first_drive_t) :: first
    ! Equations, kept as room for the next instant:
    real(wp), allocatable :: inertia(:, :)       !! (coordinates, coordinates) M
    real(wp), allocatable :: with_rotor(:, :)    !! M with the rotor
    real(wp), allocatable :: right(:)            !! (coordinates) of gravity, constant forces and
                                                 !! inertia without ü
    real(wp), allocatable :: all_right(:)        !! of all loads and the rotor, too
    real(wp), allocatable :: driving(:)          !! of the drive and loads without a potential
    real(wp), allocatable :: loading(:)          !! of these loads only
  end type linkage_instant_t

contains

  !> Makes the room of an instant, once.
  pure subroutine make_room(instant, coordinates, bodies)
    type(linkage_instant_t), intent(inout) :: instant !! with its pose
    integer, intent(in) :: coordinates, bodies        !! numbers of them

    if (allocated(instant%right)) return
    associate (f => coordinates)
      allocate (instant%first%per(f), instant%right(f), instant%all_right(f), instant%driving(f), &
        instant%loading(f), instant%acceleration(f), instant%inertia(f, f), &
        instant%with_rotor(f, f))
    end associate
    allocate (instant%body_load(bodies))
    instant%pin_load = 0.0_wp*instant%pose%pin
  end subroutine make_room

  !> M, and the generalised forces of gravity, constant forces and inertia without ü.
  pure subroutine find_inertia(linkage, rigid, pose, now, per, inertia, right)
    type(linkage_t), intent(in) :: linkage
    type(rigid_body_t), intent(in) :: rigid(:)              !! (bodies)
    type(pose_t), intent(in) :: pose
    type(kinematic_coefficients_t), intent(in) :: now       !! per second; accelerations without ü
    type(kinematic_coefficients_t), intent(in) :: per(:)    !! (coordinates) velocities per rate
    real(wp), intent(out) :: inertia(:, :)                  !! (coordinates, coordinates) M
    real(wp), intent(out) :: right(:)                       !! (coordinates)

    real(wp) :: along(2, size(per)), force(2), turning
    real(wp), dimension(2) :: centre, arm, across, slope
    integer :: b, k, l, p

    inertia = 0.0_wp
    right = 0.0_wp
    do b = 1, size(rigid)
      centre = mass_centre(rigid(b))
      turning = central_inertia(rigid(b))
      associate (axis => pose%direction(:, b), pin => linkage%bodies(b)%first_pin)
        ! As `find_point_coefficients` has it, without calls: this is most of the work of a step.
        arm = centre(1)*axis + centre(2)*[-axis(2), axis(1)]
        across = [-arm(2), arm(1)]
        slope = now%pin_slope(:, pin) + now%turn_slope(b)*across - now%turn(b)**2*arm
        do k = 1, size(per)
          along(:, k) = per(k)%pin(:, pin) + per(k)%turn(b)*across
        end do
      end associate
      force = rigid(b)%mass*(linkage%gravity - slope)
      do k = 1, size(per)
        right(k) = right(k) + dot_product(force, along(:, k)) - turning*now%turn_slope(b)* &
          per(k)%turn(b)
        do l = 1, k
          inertia(k, l) = inertia(k, l) + rigid(b)%mass*dot_product(along(:, k), &
            along(:, l)) + turning*per(k)%turn(b)*per(l)%turn(b)
        end do
      end do
    end do
    do p = 1, size(linkage%is_ground)
      force = linkage%pin_mass(p)*(linkage%gravity - now%pin_slope(:, p)) + &
        linkage%pin_force(:, p)
      do k = 1, size(per)
        right(k) = right(k) + dot_product(force, per(k)%pin(:, p))
        do l = 1, k
          inertia(k, l) = inertia(k, l) + linkage%pin_mass(p)*dot_product(per(k)%pin(:, p), &
            per(l)%pin(:, p))
        end do
      end do
    end do
    do k = 1, size(per)
      inertia(:k - 1, k) = inertia(k, :k - 1)
    end do
  end subroutine find_inertia

  !> Adds the generalised forces of springs, dampers, processes and friction: those with a potential
  !! to `all_right`, all others, with constant torques, to `driving` and `loading`; the instant gets
  !! the loads themselves.
  pure subroutine add_loads(whole, rigid, torque, reflected, instant, found)
    type(whole_system_t), intent(in) :: whole
    type(rigid_body_t), intent(in) :: rigid(:)      !! (bodies)
    real(wp), intent(in) :: torque                  !! of the drive, but for the rotor
    real(wp), intent(in) :: reflected               !! inertia of the rotor on the first drive
    type(linkage_instant_t), intent(inout) :: instant !! with pose and velocities
    logical, intent(out) :: found                   !! false where joints lock

    type(load_t) :: body_load(size(rigid)), of_springs(size(rigid))
    real(wp), dimension(2, size(instant%pose%pin, 2)) :: pin_load, spring_force
    type(friction_t) :: friction
    real(wp) :: added(size(instant%per))
    integer :: k

    found = .true.
    pin_load = 0.0_wp
    associate (linkage => whole%linkage, pose => instant%pose, along => instant%along, &
        per => instant%per, now => instant%motion, right => instant%all_right, &
        driving => instant%driving, loading => instant%loading)
      do k = 1, size(per)
        added(k) = dot_product(linkage%couple, per(k)%turn)
      end do
      driving = driving + added
      loading = loading + added
      if (size(linkage%loads) > 0 .or. has_friction(linkage)) then
        spring_force = 0.0_wp
        call add_conservative_loads(linkage, pose, along, of_springs, spring_force)
        call add_prescribed_loads(linkage, pose, body_load, pin_load)
        call add_moving_loads(linkage, pose, along, now, body_load, pin_load)
        do k = 1, size(per)
          right(k) = right(k) + generalised_force(linkage, per(k), of_springs, spring_force)
          added(k) = generalised_force(linkage, per(k), body_load, pin_load)
        end do
        driving = driving + added
        loading = loading + added
        call add_to(of_springs, body_load)
        pin_load = pin_load + spring_force
      end if
      if (has_friction(linkage)) then
        call find_free_friction(whole, rigid, pose, per, now, body_load, pin_load, &
          torque, friction, reflected)
        found = friction%state == is_solved
        do k = 1, size(per)
          added(k) = generalised_force(linkage, per(k), friction%body_load, friction%pin_load)
        end do
        driving = driving + added
        loading = loading + added
        call add_to(friction%body_load, body_load)
        pin_load = pin_load + friction%pin_load
        instant%friction = friction%effort
      end if
    end associate
    instant%body_load = body_load
    instant%pin_load = pin_load
  end subroutine add_loads

  !> Adds forces and moments of all bodies to others.
  pure subroutine add_to(more, loads)
    type(load_t), intent(in) :: more(:)
    type(load_t), intent(inout) :: loads(:)

    integer :: b

    do b = 1, size(loads)
      loads(b)%force = loads(b)%force + more(b)%force
      loads(b)%moment = loads(b)%moment + more(b)%moment
    end do
  end subroutine add_to

  !> Adds what ü does to the accelerations of pins and bodies.
  pure subroutine add_accelerations(instant)
    type(linkage_instant_t), intent(inout) :: instant !! with ü; its motion without it

    integer :: k

    do k = 1, size(instant%acceleration)
      instant%motion%turn_slope = instant%motion%turn_slope + instant%acceleration(k)* &
        instant%per(k)%turn
      instant%motion%pin_slope = instant%motion%pin_slope + instant%acceleration(k)* &
        instant%per(k)%pin
    end do
  end subroutine add_accelerations

end module linkage_instants
