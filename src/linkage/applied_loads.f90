!> What springs, dampers and processes put on a linkage at a pose, in three parts: with a potential
!! energy; without one, but determined by the pose; and what depends on how fast the linkage moves.
module applied_loads
  use applied_load_types, only: acts_always, applied_load_t, applies_along, applies_between, &
    applies_couple, applies_force, load_place_t, over_angle, over_drive, over_nothing, &
    over_slider, over_travel
  use body_points, only: find_point_coefficients, point_coefficients_t
  use constants, only: degree
  use cubic_splines, only: spline_values
  use errors, only: error_of_numerics, error_t, set_error
  use group_equations, only: world_line
  use inertia_loads, only: load_t
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use linkages, only: cross, drives_angle, linkage_t, reference_point, turned
  use pose_types, only: pose_t
  use poses, only: arm_to_place, body_angle
  implicit none (type, external)
  private

  public :: add_conservative_loads, add_prescribed_loads, add_moving_loads, applied_potential, &
    generalised_force, has_standing_loads, has_moving_loads, refuse_beyond_tables, load_period, &
    springs_on_ground, dampers_on_ground, spring_scale

  !> By how much rounding may put a coordinate beyond the ends of a table, of its length.
  real(wp), parameter :: slack = 1.0e-12_wp

  !> Largest angle between a torsional spring and its rest; its sign changes at a half turn [rad].
  real(wp), parameter :: most_deflection = 170.0_wp*degree

contains

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
    case (applies_along, applies_between)
      is = abs(load%stiffness) > 0.0_wp .or. abs(load%tension) > 0.0_wp
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

    is = load%during /= acts_always .or. load%damping > 0.0_wp .or. load%resisting > 0.0_wp
  end function is_moving

  !> Adds springs and constant forces.
  pure subroutine add_conservative_loads(linkage, pose, body_load, pin_load)
    type(linkage_t), intent(in) :: linkage          !! its loads
    type(pose_t), intent(in) :: pose                !! positions and directions
    type(load_t), intent(inout) :: body_load(:)     !! (bodies) about their first pins
    real(wp), intent(inout) :: pin_load(:, :)       !! (2, pins) [N]

    real(wp) :: pull
    integer :: i

    do i = 1, size(linkage%loads)
      associate (load => linkage%loads(i))
        if (.not. is_conservative(load)) cycle
        if (load%kind == applies_force) then
          call add_force(linkage, pose, load%at(1), load%force, body_load, pin_load)
        else
          pull = load%tension + load%stiffness*deflection(linkage, pose, load)
          call add_pull(linkage, pose, load, pull, body_load, pin_load)
        end if
      end associate
    end do
  end subroutine add_conservative_loads

  !> Adds forces and couples that a table or their body determines, and constant couples.
  pure subroutine add_prescribed_loads(linkage, pose, origin, body_load, pin_load)
    type(linkage_t), intent(in) :: linkage          !! its loads
    type(pose_t), intent(in) :: pose                !! with the coordinate of the first drive
    real(wp), intent(in) :: origin(2)               !! from which its pins are counted [m]
    type(load_t), intent(inout) :: body_load(:)     !! (bodies) about their first pins
    real(wp), intent(inout) :: pin_load(:, :)       !! (2, pins) [N]

    integer :: i

    do i = 1, size(linkage%loads)
      associate (load => linkage%loads(i))
        if (.not. is_prescribed(load)) cycle
        if (load%kind == applies_force) then
          call add_force(linkage, pose, load%at(1), factor(linkage, pose, origin, load)* &
            force_of(pose, load), body_load, pin_load)
        else
          body_load(load%body(1))%moment = body_load(load%body(1))%moment + &
            factor(linkage, pose, origin, load)*load%couple
        end if
      end associate
    end do
  end subroutine add_prescribed_loads

  !> Adds what depends on the motion: dampers, resistances, and loads that act in one direction of
  !! the motion only.
  pure subroutine add_moving_loads(linkage, pose, origin, now, body_load, pin_load)
    type(linkage_t), intent(in) :: linkage          !! its loads
    type(pose_t), intent(in) :: pose                !! with the coordinate of the first drive
    real(wp), intent(in) :: origin(2)               !! from which its pins are counted [m]
    type(kinematic_coefficients_t), intent(in) :: now !! velocities [m/s], [rad/s]
    type(load_t), intent(inout) :: body_load(:)     !! (bodies) about their first pins
    real(wp), intent(inout) :: pin_load(:, :)       !! (2, pins) [N]

    real(wp) :: velocity(2), force(2), couple, speed
    integer :: i

    do i = 1, size(linkage%loads)
      associate (load => linkage%loads(i))
        if (.not. is_moving(load)) cycle
        select case (load%kind)
        case (applies_force)
          velocity = velocity_at(linkage, pose, now, load%at(1))
          speed = norm2(velocity)
          force = -load%damping*velocity
          if (speed > 0.0_wp) force = force - resistance(load, speed)/speed*velocity
          if (load%during /= acts_always) force = force + share_of(load, velocity, &
            force_of(pose, load))*factor(linkage, pose, origin, load)*force_of(pose, load)
          call add_force(linkage, pose, load%at(1), force, body_load, pin_load)
        case (applies_couple)
          speed = now%turn(load%body(1))
          couple = -load%damping*speed - resistance(load, speed)
          if (load%during /= acts_always) couple = couple + share_of(load, [speed, 0.0_wp], &
            [load%couple, 0.0_wp])*factor(linkage, pose, origin, load)*load%couple
          body_load(load%body(1))%moment = body_load(load%body(1))%moment + couple
        case default
          speed = rate_of(linkage, pose, now, load)
          call add_pull(linkage, pose, load, load%damping*speed + resistance(load, speed), &
            body_load, pin_load)
        end select
      end associate
    end do
  end subroutine add_moving_loads

  !> Potential energy of springs, 0 unloaded, and of constant forces, 0 with their places at the
  !! global origin [J].
  pure function applied_potential(linkage, pose, origin) result(energy)
    type(linkage_t), intent(in) :: linkage !! its loads
    type(pose_t), intent(in) :: pose       !! positions and directions
    real(wp), intent(in) :: origin(2)      !! from which its pins are counted [m]
    real(wp) :: energy

    real(wp) :: stretch
    integer :: i

    energy = 0.0_wp
    do i = 1, size(linkage%loads)
      associate (load => linkage%loads(i))
        if (.not. is_conservative(load)) cycle
        if (load%kind == applies_force) then
          energy = energy - dot_product(load%force, place_in(linkage, pose, load%at(1)) + origin)
        else
          stretch = deflection(linkage, pose, load)
          energy = energy + (load%tension + 0.5_wp*load%stiffness*stretch)*stretch
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

    real(wp) :: pull
    integer :: i

    scale = 0.0_wp
    do i = 1, size(linkage%loads)
      associate (load => linkage%loads(i))
        if (.not. is_conservative(load) .or. load%kind == applies_force) cycle
        pull = abs(load%tension) + load%stiffness*(abs(deflection(linkage, pose, load)) + &
          abs(load%rest))
        if (load%kind == applies_along) then
          scale = scale + pull*(norm2(velocity_at(linkage, pose, per, load%at(1))) + &
            norm2(velocity_at(linkage, pose, per, load%at(2))))
        else
          scale = scale + pull*abs(per%turn(load%body(2)))
          if (load%body(1) > 0) scale = scale + pull*abs(per%turn(load%body(1)))
        end if
      end associate
    end do
  end function spring_scale

  !> Force of springs on the ground, and its moment about `reference_point` [N, N m].
  pure function springs_on_ground(linkage, pose) result(load)
    type(linkage_t), intent(in) :: linkage !! its loads
    type(pose_t), intent(in) :: pose       !! positions in global axes, and directions
    real(wp) :: load(3)

    integer :: i

    load = 0.0_wp
    if (.not. allocated(linkage%loads)) return
    do i = 1, size(linkage%loads)
      associate (spring => linkage%loads(i))
        if (.not. is_conservative(spring) .or. spring%kind == applies_force) cycle
        load = load + on_ground(linkage, pose, spring, spring%tension + spring%stiffness* &
          deflection(linkage, pose, spring))
      end associate
    end do
  end function springs_on_ground

  !> Force of dampers on the ground, and its moment about `reference_point` [N, N m].
  pure function dampers_on_ground(linkage, pose, now) result(load)
    type(linkage_t), intent(in) :: linkage !! its loads
    type(pose_t), intent(in) :: pose       !! positions in global axes, and directions
    type(kinematic_coefficients_t), intent(in) :: now !! velocities [m/s], [rad/s]
    real(wp) :: load(3)

    real(wp) :: rate
    integer :: i

    load = 0.0_wp
    if (.not. allocated(linkage%loads)) return
    do i = 1, size(linkage%loads)
      associate (damper => linkage%loads(i))
        if (.not. is_moving(damper)) cycle
        if (damper%kind /= applies_along .and. damper%kind /= applies_between) cycle
        rate = rate_of(linkage, pose, now, damper)
        load = load + on_ground(linkage, pose, damper, damper%damping*rate + resistance(damper, &
          rate))
      end associate
    end do
  end function dampers_on_ground

  !> What the pull of a line or between two bodies puts on the ground.
  pure function on_ground(linkage, pose, load, pull) result(total)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(applied_load_t), intent(in) :: load
    real(wp), intent(in) :: pull
    real(wp) :: total(3)

    real(wp) :: force(2)
    integer :: k

    total = 0.0_wp
    if (load%kind == applies_between) then
      if (load%body(1) == 0) total(3) = pull
      return
    end if
    do k = 1, 2
      if (load%at(k)%pin == 0) cycle
      if (.not. linkage%is_ground(load%at(k)%pin)) cycle
      force = merge(pull, -pull, k == 1)*axis_of(linkage, pose, load)
      total = total + [force, cross(place_in(linkage, pose, load%at(k)) - &
        reference_point(linkage), force)]
    end do
  end function on_ground

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

  !> Refuses a pose beyond the ends of a table, or with a torsional spring near half a turn from its
  !! rest, where its torque would jump.
  pure subroutine refuse_beyond_tables(linkage, pose, origin, error)
    type(linkage_t), intent(in) :: linkage !! its loads
    type(pose_t), intent(in) :: pose       !! with the coordinate of the first drive
    real(wp), intent(in) :: origin(2)      !! from which its pins are counted [m]
    type(error_t), allocatable, intent(inout) :: error !! allocated if there is such a table or
                                                       !! spring

    real(wp) :: x, first, last
    integer :: i

    if (.not. allocated(linkage%loads)) return
    do i = 1, size(linkage%loads)
      associate (load => linkage%loads(i))
        if (load%kind == applies_between .and. load%stiffness > 0.0_wp .and. &
          .not. counts_turns(linkage, load)) then
          if (abs(deflection(linkage, pose, load)) > most_deflection) then
            call set_error(error, error_of_numerics, "a torsional spring is turned by nearly "// &
              "half "// &
              "a turn or more, and its torque would jump")
            return
          end if
        end if
        if (load%over == over_nothing .or. load%table%is_periodic) cycle
        x = table_coordinate(linkage, pose, origin, load)
        first = load%table%x(1)
        last = load%table%x(size(load%table%x))
        if (x >= first - slack*(last - first) .and. x <= last + slack*(last - first)) cycle
        if (x < first) then
          call set_error(error, error_of_numerics, "the table "//load%table_name//" begins later")
        else
          call set_error(error, error_of_numerics, "the table "//load%table_name//" ends before")
        end if
        return
      end associate
    end do
  end subroutine refuse_beyond_tables

  !> After how much of the first drive's angle positions and loads repeat: a whole number of periods
  !! of the positions [deg]; 0: they do not.
  pure function load_period(linkage, period) result(whole)
    type(linkage_t), intent(in) :: linkage !! its loads
    real(wp), intent(in) :: period         !! of the positions [deg]; 0: none
    real(wp) :: whole

    integer, parameter :: most_turns = 64
    real(wp) :: length
    integer :: i, turns

    whole = period
    if (.not. allocated(linkage%loads) .or. period <= 0.0_wp) return
    do i = 1, size(linkage%loads)
      associate (load => linkage%loads(i))
        if (load%kind == applies_between .and. load%body(1) == 0 .and. load%body(2) == 1 .and. &
          linkage%has_crank .and. load%stiffness > 0.0_wp) whole = 0.0_wp
        if (load%over /= over_drive) cycle
        if (.not. load%table%is_periodic) whole = 0.0_wp
        if (whole <= 0.0_wp) return
        length = (load%table%x(size(load%table%x)) - load%table%x(1))/degree
        do turns = 1, most_turns
          if (abs(turns*whole/length - anint(turns*whole/length)) > 1.0e-9_wp) cycle
          whole = turns*whole
          exit
        end do
        if (turns > most_turns) whole = 0.0_wp
        if (whole <= 0.0_wp) return
      end associate
    end do
  end function load_period

  !> The coordinate that the table of a load is over [m] or [rad].
  pure function table_coordinate(linkage, pose, origin, load) result(x)
    type(linkage_t), intent(in) :: linkage   !! its sliders and bodies
    type(pose_t), intent(in) :: pose         !! with the coordinate of the first drive
    real(wp), intent(in) :: origin(2)        !! from which its pins are counted [m]
    type(applied_load_t), intent(in) :: load !! with a table
    real(wp) :: x

    real(wp) :: axis(2), point(2)

    select case (load%over)
    case (over_drive)
      x = pose%crank
      if (linkage%drives(1)%kind == drives_angle) x = x*degree
    case (over_slider)
      call world_line(linkage, pose, load%number, origin, axis, point)
      x = dot_product(axis, pose%pin(:, linkage%sliders(load%number)%pin) - point)
    case (over_travel)
      x = dot_product(load%force, place_in(linkage, pose, load%at(1)) + origin)/norm2(load%force)
    case (over_angle)
      x = body_angle(linkage, pose, load%number)
    case default
      x = 0.0_wp
    end select
  end function table_coordinate

  !> What the value of a load is multiplied with: 1, or the value of its table.
  pure function factor(linkage, pose, origin, load)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    real(wp), intent(in) :: origin(2)
    type(applied_load_t), intent(in) :: load
    real(wp) :: factor

    real(wp) :: values(3)

    factor = 1.0_wp
    if (load%over == over_nothing) return
    values = spline_values(load%table, table_coordinate(linkage, pose, origin, load))
    factor = values(1)
  end function factor

  !> A force in global axes.
  pure function force_of(pose, load) result(force)
    type(pose_t), intent(in) :: pose
    type(applied_load_t), intent(in) :: load
    real(wp) :: force(2)

    force = load%force
    if (load%is_carried) force = turned(load%force, pose%direction(:, load%at(1)%body))
  end function force_of

  !> Share of a load that acts in one direction of the motion only: from 0 to 1, half at rest.
  pure function share_of(load, velocity, value) result(share)
    type(applied_load_t), intent(in) :: load
    real(wp), intent(in) :: velocity(2), value(2)
    real(wp) :: share

    share = 0.0_wp
    if (norm2(value) > 0.0_wp) share = 0.5_wp*(1.0_wp + tanh(load%during* &
      dot_product(velocity, value)/(norm2(value)*load%smooth)))
  end function share_of

  !> Resistance of constant magnitude, against the motion.
  pure function resistance(load, speed)
    type(applied_load_t), intent(in) :: load
    real(wp), intent(in) :: speed
    real(wp) :: resistance

    resistance = load%resisting*tanh(speed/load%smooth)
  end function resistance

  !> Where a load acts [m].
  pure function place_in(linkage, pose, at) result(place)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(load_place_t), intent(in) :: at
    real(wp) :: place(2)

    if (at%pin > 0) then
      place = pose%pin(:, at%pin) + at%place
    else
      place = pose%pin(:, linkage%bodies(at%body)%first_pin) + arm_to_place(pose, at%body, at%place)
    end if
  end function place_in

  !> How fast that place moves [m/s].
  pure function velocity_at(linkage, pose, now, at) result(velocity)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(kinematic_coefficients_t), intent(in) :: now
    type(load_place_t), intent(in) :: at
    real(wp) :: velocity(2)

    type(point_coefficients_t) :: point

    if (at%pin > 0) then
      velocity = now%pin(:, at%pin)
    else
      point = find_point_coefficients(linkage, pose, now, at%body, at%place)
      velocity = point%rate
    end if
  end function velocity_at

  !> By how much a spring is stretched [m], or turned: from −π to π, but on a crank with all whole
  !! turns [rad].
  pure function deflection(linkage, pose, load) result(stretch)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(applied_load_t), intent(in) :: load
    real(wp) :: stretch

    real(wp) :: angle

    if (load%kind == applies_along) then
      stretch = norm2(place_in(linkage, pose, load%at(2)) - place_in(linkage, pose, load%at(1))) - &
        load%rest
    else if (counts_turns(linkage, load)) then
      stretch = pose%crank*degree - load%rest
    else
      angle = body_angle(linkage, pose, load%body(2)) - load%rest
      if (load%body(1) > 0) angle = angle - body_angle(linkage, pose, load%body(1))
      stretch = atan2(sin(angle), cos(angle))
    end if
  end function deflection

  !> Whether a spring counts whole turns: from the ground to the crank.
  pure function counts_turns(linkage, load) result(counts)
    type(linkage_t), intent(in) :: linkage
    type(applied_load_t), intent(in) :: load !! between two bodies
    logical :: counts

    counts = linkage%has_crank .and. load%body(2) == 1 .and. load%body(1) == 0
  end function counts_turns

  !> Rate of the coordinate of a line or of two bodies [m/s] or [rad/s].
  pure function rate_of(linkage, pose, now, load) result(rate)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(kinematic_coefficients_t), intent(in) :: now
    type(applied_load_t), intent(in) :: load
    real(wp) :: rate

    if (load%kind == applies_along) then
      rate = dot_product(axis_of(linkage, pose, load), velocity_at(linkage, pose, now, &
        load%at(2)) - velocity_at(linkage, pose, now, load%at(1)))
    else
      rate = now%turn(load%body(2))
      if (load%body(1) > 0) rate = rate - now%turn(load%body(1))
    end if
  end function rate_of

  !> Unit vector along a line; zero where its ends meet.
  pure function axis_of(linkage, pose, load) result(axis)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(applied_load_t), intent(in) :: load
    real(wp) :: axis(2)

    axis = place_in(linkage, pose, load%at(2)) - place_in(linkage, pose, load%at(1))
    if (norm2(axis) > 0.0_wp) axis = axis/norm2(axis)
  end function axis_of

  !> Adds a pull that shortens a line, or turns two bodies back.
  pure subroutine add_pull(linkage, pose, load, pull, body_load, pin_load)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(applied_load_t), intent(in) :: load
    real(wp), intent(in) :: pull !! [N] or [N m]
    type(load_t), intent(inout) :: body_load(:)
    real(wp), intent(inout) :: pin_load(:, :)

    real(wp) :: axis(2)

    if (load%kind == applies_along) then
      axis = axis_of(linkage, pose, load)
      call add_force(linkage, pose, load%at(1), pull*axis, body_load, pin_load)
      call add_force(linkage, pose, load%at(2), -pull*axis, body_load, pin_load)
    else
      body_load(load%body(2))%moment = body_load(load%body(2))%moment - pull
      if (load%body(1) > 0) body_load(load%body(1))%moment = body_load(load%body(1))%moment + pull
    end if
  end subroutine add_pull

  !> Adds a force at a place.
  pure subroutine add_force(linkage, pose, at, force, body_load, pin_load)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(load_place_t), intent(in) :: at
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
