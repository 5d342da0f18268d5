!> What springs, dampers and processes put on a linkage at a pose, in three parts: with a potential
!! energy; without one, but determined by the pose; and what depends on how fast the linkage moves.
module applied_loads
  use applied_load_types, only: acts_always, applied_load_t, applies_along, applies_couple, &
    applies_force, deflection, over_nothing
  use coordinate_types, only: coordinate_t, is_angle, is_sum, terminal_t
  use coordinates, only: evaluate, evaluated_rate, evaluated_t
  use inertia_loads, only: load_t
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkages, only: cross, forced_place_t, linkage_t, turned
  use load_tables, only: table_factor
  use pose_types, only: pose_t
  use poses, only: arm_to_place
  use pull_laws, only: moving_pull, pull_energy, pull_scale, standing_pull
  use terminals, only: terminal_place, terminal_velocity
  implicit none (type, external)
  private

  public :: evaluate_loads, add_conservative_loads, add_prescribed_loads, add_standing_loads, &
    add_moving_loads, is_moving, moving_force, moving_couple, forced_places, forces_at_places, &
    applied_potential, generalised_force, has_standing_loads, has_moving_loads, &
    standing_pulls, moving_pulls, spring_scale, load_switches, turns_over, add_effort

contains

  !> The coordinates of all loads along one, at a pose: for all that is asked of these loads there.
  pure subroutine evaluate_loads(linkage, pose, along)
    type(linkage_t), intent(in) :: linkage !! its loads
    type(pose_t), intent(in) :: pose       !! positions and directions
    type(evaluated_t), allocatable, intent(inout) :: along(:) !! (loads); new, or of another pose

    integer :: i

    if (.not. allocated(along)) allocate (along(load_count(linkage)))
    do i = 1, size(along)
      if (linkage%loads(i)%kind == applies_along) call evaluate(linkage, pose, &
        linkage%loads(i)%along, along(i))
    end do
  end subroutine evaluate_loads

  !> Whether any load is there at rest.
  pure function has_standing_loads(linkage) result(has)
    type(linkage_t), intent(in) :: linkage !! its loads
    logical :: has

    integer :: i

    has = .false.
    if (.not. allocated(linkage%loads)) return
    do i = 1, size(linkage%loads)
      has = has .or. is_conservative(linkage%loads(i)) .or. is_prescribed(linkage%loads(i))
    end do
  end function has_standing_loads

  !> Whether any load depends on how fast the linkage moves.
  pure function has_moving_loads(linkage) result(has)
    type(linkage_t), intent(in) :: linkage !! its loads
    logical :: has

    integer :: i

    has = .false.
    if (.not. allocated(linkage%loads)) return
    do i = 1, size(linkage%loads)
      has = has .or. is_moving(linkage%loads(i))
    end do
  end function has_moving_loads

  !> Whether a part of a load has a potential: springs, and constant forces in global axes.
  elemental function is_conservative(load) result(is)
    type(applied_load_t), intent(in) :: load
    logical :: is

    select case (load%kind)
    case (applies_along)
      is = abs(load%law%stiffness) > 0.0_wp .or. abs(load%law%tension) > 0.0_wp
    case (applies_force)
      is = .not. load%is_carried .and. load%over == over_nothing .and. &
        load%during == acts_always .and. any(abs(load%force) > 0.0_wp)
    case default
      is = .false.
    end select
  end function is_conservative

  !> Whether a part of a load depends on the pose alone, but has no potential.
  elemental function is_prescribed(load) result(is)
    type(applied_load_t), intent(in) :: load
    logical :: is

    is = .false.
    if (load%during /= acts_always) return
    select case (load%kind)
    case (applies_force)
      is = any(abs(load%force) > 0.0_wp) .and. .not. is_conservative(load)
    case (applies_couple)
      is = abs(load%couple) > 0.0_wp
    end select
  end function is_prescribed

  !> Whether a part of a load depends on the rate of its coordinate.
  elemental function is_moving(load) result(is)
    type(applied_load_t), intent(in) :: load
    logical :: is

    is = load%during /= acts_always .or. load%law%damping > 0.0_wp .or. load%resisting > 0.0_wp
  end function is_moving

  !> Adds springs and constant forces.
  pure subroutine add_conservative_loads(linkage, pose, along, body_load, pin_load)
    type(linkage_t), intent(in) :: linkage          !! its loads
    type(pose_t), intent(in) :: pose                !! positions and directions
    type(evaluated_t), intent(in) :: along(:)       !! (loads) of `evaluate_loads` at this pose
    type(load_t), intent(inout) :: body_load(:)     !! (bodies) about their first pins
    real(wp), intent(inout) :: pin_load(:, :)       !! (2, pins) [N]

    integer :: i

    do i = 1, size(linkage%loads)
      associate (load => linkage%loads(i))
        if (.not. is_conservative(load)) cycle
        if (load%kind == applies_force) then
          call add_force(pose, load%at, load%force, body_load, pin_load)
        else
          call add_effort(linkage, pose, load%along, along(i), -standing_pull(load%law, &
            deflection(load, along(i)%value)), body_load, pin_load)
        end if
      end associate
    end do
  end subroutine add_conservative_loads

  !> Adds forces and couples that a table or their body determines, and constant couples.
  pure subroutine add_prescribed_loads(linkage, pose, body_load, pin_load)
    type(linkage_t), intent(in) :: linkage          !! its loads
    type(pose_t), intent(in) :: pose                !! with the coordinate of the first drive
    type(load_t), intent(inout) :: body_load(:)     !! (bodies) about their first pins
    real(wp), intent(inout) :: pin_load(:, :)       !! (2, pins) [N]

    integer :: i

    do i = 1, size(linkage%loads)
      associate (load => linkage%loads(i))
        if (.not. is_prescribed(load)) cycle
        if (load%kind == applies_force) then
          call add_force(pose, load%at, table_factor(linkage, pose, load)*force_of(pose, load), &
            body_load, pin_load)
        else
          body_load(load%at%body)%moment = body_load(load%at%body)%moment + &
            table_factor(linkage, pose, load)*load%couple
        end if
      end associate
    end do
  end subroutine add_prescribed_loads

  !> Adds all that a pose determines: springs, and loads that a table or their body determines.
  pure subroutine add_standing_loads(linkage, pose, along, body_load, pin_load)
    type(linkage_t), intent(in) :: linkage          !! its loads
    type(pose_t), intent(in) :: pose                !! with the coordinate of the first drive
    type(evaluated_t), intent(in) :: along(:)       !! (loads) of `evaluate_loads` at this pose
    type(load_t), intent(inout) :: body_load(:)     !! (bodies) about their first pins
    real(wp), intent(inout) :: pin_load(:, :)       !! (2, pins) [N]

    call add_conservative_loads(linkage, pose, along, body_load, pin_load)
    call add_prescribed_loads(linkage, pose, body_load, pin_load)
  end subroutine add_standing_loads

  !> Places of a body on which forces act that a pose determines, or all forces.
  pure function forced_places(loads, body, with_moving) result(places)
    type(applied_load_t), intent(in) :: loads(:) !! of the linkage
    integer, intent(in) :: body                  !! its number
    logical, intent(in), optional :: with_moving !! those that depend on the motion, too; absent: no
    type(forced_place_t), allocatable :: places(:)

    logical :: acts(size(loads))
    integer :: i, n

    acts = loads%kind == applies_force .and. (is_conservative(loads) .or. is_prescribed(loads))
    if (present(with_moving)) acts = acts .or. with_moving .and. loads%kind == applies_force .and. &
      is_moving(loads)
    do i = 1, size(loads)
      acts(i) = acts(i) .and. loads(i)%at%pin == 0 .and. loads(i)%at%body == body
    end do
    allocate (places(count(acts)))
    n = 0
    do i = 1, size(loads)
      if (.not. acts(i)) cycle
      n = n + 1
      places(n)%load = i
      places(n)%place = loads(i)%at%place
    end do
  end function forced_places

  !> The forces at places of bodies that a pose determines; 0 of all other loads [N].
  pure function forces_at_places(linkage, pose) result(force)
    type(linkage_t), intent(in) :: linkage           !! its loads, and places where forces act
    type(pose_t), intent(in) :: pose                 !! with the coordinate of the first drive
    real(wp) :: force(2, load_count(linkage))        !! (2, loads) in global axes

    integer :: b, i

    force = 0.0_wp
    do b = 1, size(linkage%bodies)
      if (.not. allocated(linkage%bodies(b)%forced)) cycle
      do i = 1, size(linkage%bodies(b)%forced)
        associate (number => linkage%bodies(b)%forced(i)%load)
          if (.not. (is_conservative(linkage%loads(number)) .or. &
            is_prescribed(linkage%loads(number)))) cycle
          force(:, number) = table_factor(linkage, pose, linkage%loads(number))* &
            force_of(pose, linkage%loads(number))
        end associate
      end do
    end do
  end function forces_at_places

  !> Adds what depends on the motion: dampers, resistances, and loads that act in one direction of
  !! the motion only.
  pure subroutine add_moving_loads(linkage, pose, along, now, body_load, pin_load)
    type(linkage_t), intent(in) :: linkage          !! its loads
    type(pose_t), intent(in) :: pose                !! with the coordinate of the first drive
    type(evaluated_t), intent(in) :: along(:)       !! (loads) of `evaluate_loads` at this pose
    type(kinematic_coefficients_t), intent(in) :: now !! velocities [m/s], [rad/s]
    type(load_t), intent(inout) :: body_load(:)     !! (bodies) about their first pins
    real(wp), intent(inout) :: pin_load(:, :)       !! (2, pins) [N]

    integer :: i

    do i = 1, size(linkage%loads)
      associate (load => linkage%loads(i))
        if (.not. is_moving(load)) cycle
        select case (load%kind)
        case (applies_force)
          call add_force(pose, load%at, moving_force(linkage, pose, now, load), body_load, pin_load)
        case (applies_couple)
          body_load(load%at%body)%moment = body_load(load%at%body)%moment + &
            moving_couple(linkage, pose, now, load)
        case default
          call add_effort(linkage, pose, load%along, along(i), -moving_pull(load%law, &
            deflection(load, along(i)%value), evaluated_rate(linkage, pose, now, load%along, &
            along(i))), body_load, pin_load)
        end select
      end associate
    end do
  end subroutine add_moving_loads

  !> What a force at a place has beside its part that a pose determines: its resistance to the
  !! motion of the place, and all of it where it acts in one direction of the motion [N].
  pure function moving_force(linkage, pose, now, load) result(force)
    type(linkage_t), intent(in) :: linkage          !! of this load
    type(pose_t), intent(in) :: pose                !! with the coordinate of the first drive
    type(kinematic_coefficients_t), intent(in) :: now !! velocities [m/s], [rad/s]
    type(applied_load_t), intent(in) :: load        !! a force that `is_moving`
    real(wp) :: force(2)

    real(wp) :: velocity(2), speed

    velocity = terminal_velocity(linkage, pose, now, load%at)
    speed = norm2(velocity)
    force = -load%law%damping*velocity
    if (speed > 0.0_wp) force = force - resistance(load, speed)/speed*velocity
    if (load%during /= acts_always) force = force + share_of(load, velocity, force_of(pose, &
      load))*table_factor(linkage, pose, load)*force_of(pose, load)
  end function moving_force

  !> The same of a couple on a body [N m].
  pure function moving_couple(linkage, pose, now, load) result(couple)
    type(linkage_t), intent(in) :: linkage          !! of this load
    type(pose_t), intent(in) :: pose                !! with the coordinate of the first drive
    type(kinematic_coefficients_t), intent(in) :: now !! velocities [m/s], [rad/s]
    type(applied_load_t), intent(in) :: load        !! a couple that `is_moving`
    real(wp) :: couple

    real(wp) :: speed

    speed = now%turn(load%at%body)
    couple = -load%law%damping*speed - resistance(load, speed)
    if (load%during /= acts_always) couple = couple + share_of(load, [speed, 0.0_wp], &
      [load%couple, 0.0_wp])*table_factor(linkage, pose, load)*load%couple
  end function moving_couple

  !> What the position determines of the pulls of springs and stops; 0 of all other loads [N] or
  !! [N m].
  pure function standing_pulls(linkage, along) result(pull)
    type(linkage_t), intent(in) :: linkage !! its loads
    type(evaluated_t), intent(in) :: along(:) !! (loads) of `evaluate_loads`
    real(wp), allocatable :: pull(:)       !! (loads)

    integer :: i

    allocate (pull(load_count(linkage)), source=0.0_wp)
    do i = 1, size(pull)
      associate (load => linkage%loads(i))
        if (is_conservative(load) .and. load%kind == applies_along) pull(i) = &
          standing_pull(load%law, deflection(load, along(i)%value))
      end associate
    end do
  end function standing_pulls

  !> What the rates of springs, dampers and stops add to their pulls; 0 of all other loads [N] or
  !! [N m].
  pure function moving_pulls(linkage, pose, along, now) result(pull)
    type(linkage_t), intent(in) :: linkage !! its loads
    type(pose_t), intent(in) :: pose       !! positions and directions
    type(evaluated_t), intent(in) :: along(:) !! (loads) of `evaluate_loads` at this pose
    type(kinematic_coefficients_t), intent(in) :: now !! velocities [m/s], [rad/s]
    real(wp), allocatable :: pull(:)       !! (loads)

    integer :: i

    allocate (pull(load_count(linkage)), source=0.0_wp)
    do i = 1, size(pull)
      associate (load => linkage%loads(i))
        if (is_moving(load) .and. load%kind == applies_along) pull(i) = moving_pull(load%law, &
          deflection(load, along(i)%value), evaluated_rate(linkage, pose, now, load%along, &
          along(i)))
      end associate
    end do
  end function moving_pulls

  pure function load_count(linkage) result(number)
    type(linkage_t), intent(in) :: linkage
    integer :: number

    number = 0
    if (allocated(linkage%loads)) number = size(linkage%loads)
  end function load_count

  !> Potential energy of springs, 0 unloaded, and of constant forces, 0 with their places at the
  !! global origin [J].
  pure function applied_potential(linkage, pose, along) result(energy)
    type(linkage_t), intent(in) :: linkage !! its loads
    type(pose_t), intent(in) :: pose       !! positions and directions
    type(evaluated_t), intent(in) :: along(:) !! (loads) of `evaluate_loads` at this pose
    real(wp) :: energy

    integer :: i

    energy = 0.0_wp
    do i = 1, size(linkage%loads)
      associate (load => linkage%loads(i))
        if (.not. is_conservative(load)) cycle
        if (load%kind == applies_force) then
          energy = energy - dot_product(load%force, terminal_place(linkage, pose, load%at) + &
            pose%origin)
        else
          energy = energy + pull_energy(load%law, deflection(load, along(i)%value))
        end if
      end associate
    end do
  end function applied_potential

  !> Sum of the magnitudes of what springs do, from which their generalised force is a difference:
  !! its rounding is of the order of 1e-16 of it [N m] or [N].
  pure function spring_scale(linkage, pose, per) result(scale)
    type(linkage_t), intent(in) :: linkage            !! its loads
    type(pose_t), intent(in) :: pose                  !! positions and directions
    type(kinematic_coefficients_t), intent(in) :: per !! velocities per rate of the coordinate
    real(wp) :: scale

    type(evaluated_t), allocatable :: along(:)
    integer :: i

    call evaluate_loads(linkage, pose, along)
    scale = 0.0_wp
    do i = 1, size(along)
      associate (load => linkage%loads(i))
        if (.not. is_conservative(load) .or. load%kind /= applies_along) cycle
        scale = scale + pull_scale(load%law, deflection(load, along(i)%value))* &
          work_scale(linkage, pose, per, load%along, along(i))
      end associate
    end do
  end function spring_scale

  !> Sum of the magnitudes of the works of an effort of 1 along a coordinate.
  pure recursive function work_scale(linkage, pose, per, coordinate, evaluated) result(scale)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(kinematic_coefficients_t), intent(in) :: per
    type(coordinate_t), intent(in) :: coordinate
    type(evaluated_t), intent(in) :: evaluated
    real(wp) :: scale

    type(evaluated_t) :: term
    integer :: i

    scale = 0.0_wp
    if (coordinate%kind == is_sum) then
      do i = 1, size(coordinate%term)
        call evaluate(linkage, pose, linkage%coordinates(coordinate%term(i)), term)
        scale = scale + abs(coordinate%weight(i))*work_scale(linkage, pose, per, &
          linkage%coordinates(coordinate%term(i)), term)
      end do
      return
    end if
    do i = 1, 2
      associate (at => coordinate%at(i), wrench => evaluated%wrench(i))
        scale = scale + norm2(wrench%force)*norm2(terminal_velocity(linkage, pose, per, at))
        if (at%body > 0) scale = scale + abs(wrench%couple*per%turn(at%body))
      end associate
    end do
  end function work_scale

  !> Generalised force of loads: their virtual work per change of the coordinate for which the
  !! coefficients stand [N m] or [N].
  pure function generalised_force(linkage, per, body_load, pin_load) result(force)
    type(linkage_t), intent(in) :: linkage             !! first pins of its bodies
    type(kinematic_coefficients_t), intent(in) :: per  !! velocities per rate of the coordinate
    type(load_t), intent(in) :: body_load(:)           !! (bodies) about their first pins
    real(wp), intent(in) :: pin_load(:, :)             !! (2, pins) [N]
    real(wp) :: force

    integer :: b

    force = sum(pin_load*per%pin)
    do b = 1, size(body_load)
      force = force + dot_product(body_load(b)%force, per%pin(:, linkage%bodies(b)%first_pin)) + &
        body_load(b)%moment*per%turn(b)
    end do
  end function generalised_force

  !> A force in global axes.
  pure function force_of(pose, load) result(force)
    type(pose_t), intent(in) :: pose
    type(applied_load_t), intent(in) :: load
    real(wp) :: force(2)

    force = load%force
    if (load%is_carried) force = turned(load%force, pose%direction(:, load%at%body))
  end function force_of

  !> Whether a load changes its direction or its share with the direction of the motion.
  elemental function turns_over(load) result(does)
    type(applied_load_t), intent(in) :: load
    logical :: does

    does = load%during /= acts_always .or. load%resisting > 0.0_wp
  end function turns_over

  !> What decides on the direction of loads against the motion, and on the share of those that act
  !! in one direction of it only: the arguments of tanh.
  pure function load_switches(linkage, pose, along, now) result(switches)
    type(linkage_t), intent(in) :: linkage        !! its loads
    type(pose_t), intent(in) :: pose              !! positions and directions
    type(evaluated_t), intent(in) :: along(:)     !! (loads) of `evaluate_loads` at this pose
    type(kinematic_coefficients_t), intent(in) :: now !! velocities [m/s], [rad/s]
    real(wp) :: switches(2, 2*load_count(linkage)) !! of each load the velocity against which it
                                                  !! acts, and that along it; 0: none [-]

    real(wp) :: velocity(2), value(2)
    integer :: i

    switches = 0.0_wp
    do i = 1, load_count(linkage)
      associate (load => linkage%loads(i))
        if (.not. turns_over(load)) cycle
        value = [load%couple, 0.0_wp]
        select case (load%kind)
        case (applies_force)
          velocity = terminal_velocity(linkage, pose, now, load%at)
          value = force_of(pose, load)
        case (applies_couple)
          velocity = [now%turn(load%at%body), 0.0_wp]
        case default
          velocity = [evaluated_rate(linkage, pose, now, load%along, along(i)), 0.0_wp]
        end select
        if (load%resisting > 0.0_wp) switches(:, 2*i - 1) = velocity/load%smooth
        if (load%during /= acts_always) switches(1, 2*i) = along_value(load, velocity, value)
      end associate
    end do
  end function load_switches

  !> Share of a load that acts in one direction of the motion only: from 0 to 1, half at rest.
  pure function share_of(load, velocity, value) result(share)
    type(applied_load_t), intent(in) :: load
    real(wp), intent(in) :: velocity(2), value(2)
    real(wp) :: share

    share = 0.0_wp
    if (norm2(value) > 0.0_wp) share = 0.5_wp*(1.0_wp + tanh(load%during*along_value(load, &
      velocity, value)))
  end function share_of

  !> The velocity along a load, over that within which it changes its sign smoothly; of no load 0.
  pure function along_value(load, velocity, value) result(along)
    type(applied_load_t), intent(in) :: load
    real(wp), intent(in) :: velocity(2), value(2)
    real(wp) :: along

    along = 0.0_wp
    if (norm2(value) > 0.0_wp) along = dot_product(velocity, value)/(norm2(value)*load%smooth)
  end function along_value

  !> Resistance of constant magnitude, against the motion.
  pure function resistance(load, speed)
    type(applied_load_t), intent(in) :: load
    real(wp), intent(in) :: speed
    real(wp) :: resistance

    resistance = load%resisting*tanh(speed/load%smooth)
  end function resistance

  !> Adds what an effort along a coordinate puts on pins and bodies.
  pure recursive subroutine add_effort(linkage, pose, coordinate, evaluated, effort, body_load, &
    pin_load)
    type(linkage_t), intent(in) :: linkage          !! the terms of a sum
    type(pose_t), intent(in) :: pose                !! positions and directions
    type(coordinate_t), intent(in) :: coordinate
    type(evaluated_t), intent(in) :: evaluated      !! of it, at this pose
    real(wp), intent(in) :: effort                  !! [N] or [N m]
    type(load_t), intent(inout) :: body_load(:)     !! (bodies) about their first pins
    real(wp), intent(inout) :: pin_load(:, :)       !! (2, pins) [N]

    type(evaluated_t) :: term
    integer :: i

    if (coordinate%kind == is_sum) then
      do i = 1, size(coordinate%term)
        call evaluate(linkage, pose, linkage%coordinates(coordinate%term(i)), term)
        call add_effort(linkage, pose, linkage%coordinates(coordinate%term(i)), term, &
          coordinate%weight(i)*effort, body_load, pin_load)
      end do
      return
    end if
    do i = 1, 2
      associate (at => coordinate%at(i), wrench => evaluated%wrench(i))
        if (at%body == 0 .and. at%pin == 0) cycle
        if (coordinate%kind /= is_angle) call add_force(pose, at, effort*wrench%force, &
          body_load, pin_load)
        if (at%body > 0) body_load(at%body)%moment = body_load(at%body)%moment + &
          effort*wrench%couple
      end associate
    end do
  end subroutine add_effort

  !> Adds a force at a place.
  pure subroutine add_force(pose, at, force, body_load, pin_load)
    type(pose_t), intent(in) :: pose
    type(terminal_t), intent(in) :: at
    real(wp), intent(in) :: force(2) !! [N]
    type(load_t), intent(inout) :: body_load(:)
    real(wp), intent(inout) :: pin_load(:, :)

    if (at%pin > 0) then
      pin_load(:, at%pin) = pin_load(:, at%pin) + force
    else
      body_load(at%body)%force = body_load(at%body)%force + force
      body_load(at%body)%moment = body_load(at%body)%moment + cross(arm_to_place(pose, at%body, &
        at%place), force)
    end if
  end subroutine add_force

end module applied_loads
