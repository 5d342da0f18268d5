! src/linkage/statics/ - forces in the joints of a rigid linkage, and the torque for a given motion.
! In: a pose, loads on bodies and pins. Out: `joint_forces_t`; `unit_reactions_t` for all load
! cases, with shaking force. Begin with `find_joint_forces` here, from the last group to the first,
! then `find_unit_reactions` in `reactions.f90`; `actuated_forces.f90` puts efforts of actuators in
! place of those of drives. Lagrange's equation: `find_lagrange` in
! `lagrange.f90`.
! Not here: loads (`src/linkage/loads`), links that are more than statics needs
! (`src/vibration/elastic_reactions.f90`).

!> Forces in the pins, from the equilibrium of every link.
module joint_forces
  use dense_factor, only: solve_transposed
  use group_factors, only: factorize_group, group_factors_t
  use inertia_loads, only: load_t
  use kinds, only: wp
  use linkages, only: cross, demand_drive, demand_line, demand_turn, equation_t, group_t, &
    group_carried, group_dyad, is_dyad_linkage, linkage_t, normal_to
  use pose_types, only: arm_to_pin
  use poses, only: arm_to_middle, dead_point_sine, pose_t
  implicit none (type, external)
  private

  public :: joint_forces_t, no_joint_forces, find_joint_forces, force_at_pin, take_reaction, &
    add_force, add_scaled

  !> Forces on the bodies at their pins, and the torque of the drive.
  type :: joint_forces_t
    real(wp), allocatable :: on_first(:, :) !! (2, bodies) force on the body at its first pin [N]
    real(wp), allocatable :: on_last(:, :)  !! (2, bodies) force on the body at its last pin [N]
    real(wp) :: torque = 0.0_wp             !! of the first drive on what it drives [N m] or [N]
    ! Not allocated in linkages of a crank and dyads of binary links:
    real(wp), allocatable :: on_further(:, :) !! (2, further pins of all bodies) force on the body
                                              !! there [N]; see `force_at_pin`
    real(wp), allocatable :: guide(:)         !! (sliders) force of the line on the pin, along the
                                              !! normal of the line [N]
    real(wp), allocatable :: couple(:)        !! (turns) moment on its body from the other one [N m]
    real(wp), allocatable :: drive(:)         !! (drives) torque or force of each, or of the
                                              !! actuators in their place [N m] or [N]
    real(wp), allocatable :: friction(:)      !! (frictions) couple on the body, or force along the
                                              !! line on the pin [N m] or [N]; not allocated where
                                              !! nothing rubs
  end type joint_forces_t

contains

  !> Forces at the pins and driving torque by Ulker 2010 (2.47) to (2.49).
  !!
  !! Groups are removed in the reverse of the order in which they are placed. Each passes the forces
  !! at its bases on as loads on what carries it, until only the driven body is left. At a change
  !! point statics tells the force of a single drive alone; the others are 0.
  pure function find_joint_forces(linkage, pose, body_load, pin_load, factors) result(forces)
    type(linkage_t), intent(in) :: linkage   !! bodies and dyads
    type(pose_t), intent(in) :: pose         !! away from dead points
    type(load_t), intent(in) :: body_load(:) !! (bodies) all loads but pin forces
    real(wp), intent(in) :: pin_load(:, :)   !! (2, pins) loads on the pins [N]
    type(group_factors_t), intent(in), optional :: factors(:) !! of `factorize_groups` at this pose,
                                             !! for any number of loads; absent: they are found
    type(joint_forces_t) :: forces

    type(group_factors_t) :: own
    type(load_t) :: load(size(body_load))
    real(wp) :: carried(2, size(pin_load, 2))
    logical :: is_passed(size(body_load))
    integer :: i

    is_passed = .false.
    allocate (forces%on_first(2, size(linkage%bodies)), forces%on_last(2, size(linkage%bodies)))
    forces%on_first = 0.0_wp
    forces%on_last = 0.0_wp
    carried = pin_load
    load = body_load
    if (.not. is_dyad_linkage(linkage)) call clear_further_forces(linkage, forces)
    if (allocated(pose%coefficients) .and. any(abs(pose%sine) < dead_point_sine)) then
      forces%torque = force_of_drive(linkage, pose, body_load, pin_load)
      if (allocated(forces%drive)) forces%drive(1) = forces%torque
      return
    end if
    do i = size(linkage%groups), 1, -1
      select case (linkage%groups(i)%kind)
      case (group_dyad)
        call solve_dyad(linkage, linkage%groups(i), pose, pose%sine(i), load, carried, forces)
      case (group_carried)
        call load_body(linkage, linkage%groups(i), pose, carried, load, forces)
      case default
        if (present(factors)) then
          call solve_group(linkage, linkage%groups(i), factors(i), is_passed, carried, load, forces)
        else
          call factorize_group(linkage, linkage%groups(i), pose, own)
          call solve_group(linkage, linkage%groups(i), own, is_passed, carried, load, forces)
        end if
      end select
    end do
    if (linkage%has_crank) then
      associate (crank => linkage%bodies(1))
        forces%on_last(:, 1) = carried(:, crank%last_pin)
        forces%on_first(:, 1) = -(forces%on_last(:, 1) + load(1)%force)
        forces%torque = -(crank%length*cross(pose%direction(:, 1), forces%on_last(:, 1)) + &
          load(1)%moment)
      end associate
      if (allocated(forces%drive)) forces%drive(1) = forces%torque
    else
      forces%torque = forces%drive(1)
    end if
  end function find_joint_forces

  !> Torque or force of a single drive, by the virtual work of the loads [N m] or [N].
  pure function force_of_drive(linkage, pose, body_load, pin_load) result(force)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose         !! with its coefficients
    type(load_t), intent(in) :: body_load(:) !! (bodies)
    real(wp), intent(in) :: pin_load(:, :)   !! (2, pins) [N]
    real(wp) :: force

    integer :: b

    force = -sum(pin_load*pose%coefficients%pin)
    do b = 1, size(body_load)
      force = force - dot_product(body_load(b)%force, pose%coefficients%pin(:, &
        linkage%bodies(b)%first_pin)) - body_load(b)%moment*pose%coefficients%turn(b)
    end do
  end function force_of_drive

  !> No forces in the joints of a linkage that is no four-bar.
  pure function no_joint_forces(linkage) result(forces)
    type(linkage_t), intent(in) :: linkage !! its bodies, sliders, turns, drives
    type(joint_forces_t) :: forces

    allocate (forces%on_first(2, size(linkage%bodies)), forces%on_last(2, size(linkage%bodies)))
    forces%on_first = 0.0_wp
    forces%on_last = 0.0_wp
    call clear_further_forces(linkage, forces)
  end function no_joint_forces

  !> Makes room for what a four-bar does not have.
  pure subroutine clear_further_forces(linkage, forces)
    type(linkage_t), intent(in) :: linkage
    type(joint_forces_t), intent(inout) :: forces

    integer :: b, further

    further = 0
    do b = 1, size(linkage%bodies)
      further = further + size(linkage%bodies(b)%further)
    end do
    allocate (forces%on_further(2, further), forces%guide(size(linkage%sliders)), &
      forces%couple(size(linkage%turns)), forces%drive(size(linkage%drives)))
    forces%on_further = 0.0_wp
    forces%guide = 0.0_wp
    forces%couple = 0.0_wp
    forces%drive = 0.0_wp
  end subroutine clear_further_forces

  !> Force on a body at one of its pins [N].
  pure function force_at_pin(linkage, forces, body, pin) result(force)
    type(linkage_t), intent(in) :: linkage     !! its bodies
    type(joint_forces_t), intent(in) :: forces !! of this linkage
    integer, intent(in) :: body                !! number, from 1
    integer, intent(in) :: pin                 !! number, one of its pins
    real(wp) :: force(2)

    if (pin == linkage%bodies(body)%first_pin) then
      force = forces%on_first(:, body)
    else if (pin == linkage%bodies(body)%last_pin) then
      force = forces%on_last(:, body)
    else
      force = forces%on_further(:, number_of_further(linkage, body, pin))
    end if
  end function force_at_pin

  !> Number of a further pin among those of all bodies.
  pure function number_of_further(linkage, body, pin) result(number)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: body, pin
    integer :: number

    integer :: b

    number = 0
    do b = 1, body - 1
      number = number + size(linkage%bodies(b)%further)
    end do
    number = number + findloc(linkage%bodies(body)%further%pin, pin, dim=1)
  end function number_of_further

  !> Adds a force on a body at one of its pins.
  pure subroutine add_force(linkage, body, pin, force, forces)
    type(linkage_t), intent(in) :: linkage        !! its bodies
    integer, intent(in) :: body                   !! number, from 1
    integer, intent(in) :: pin                    !! number, one of its pins
    real(wp), intent(in) :: force(2)              !! [N]
    type(joint_forces_t), intent(inout) :: forces !! of this linkage

    integer :: number

    if (pin == linkage%bodies(body)%first_pin) then
      forces%on_first(:, body) = forces%on_first(:, body) + force
    else if (pin == linkage%bodies(body)%last_pin) then
      forces%on_last(:, body) = forces%on_last(:, body) + force
    else
      number = number_of_further(linkage, body, pin)
      forces%on_further(:, number) = forces%on_further(:, number) + force
    end if
  end subroutine add_force

  !> Adds a multiple of other forces in the same joints.
  pure subroutine add_scaled(forces, factor, others)
    type(joint_forces_t), intent(inout) :: forces !! to which they are added
    real(wp), intent(in) :: factor
    type(joint_forces_t), intent(in) :: others    !! of the same linkage

    forces%on_first = forces%on_first + factor*others%on_first
    forces%on_last = forces%on_last + factor*others%on_last
    forces%torque = forces%torque + factor*others%torque
    if (.not. allocated(forces%drive)) return
    forces%on_further = forces%on_further + factor*others%on_further
    forces%guide = forces%guide + factor*others%guide
    forces%couple = forces%couple + factor*others%couple
    forces%drive = forces%drive + factor*others%drive
  end subroutine add_scaled

  !> Pins of a body that is placed before them: what they bear is a load of the body.
  pure subroutine load_body(linkage, group, pose, carried, load, forces)
    type(linkage_t), intent(in) :: linkage
    type(group_t), intent(in) :: group
    type(pose_t), intent(in) :: pose
    real(wp), intent(in) :: carried(:, :)
    type(load_t), intent(inout) :: load(:)
    type(joint_forces_t), intent(inout) :: forces

    integer :: i, pin, body

    body = group%body(1)
    do i = 1, size(group%pins)
      pin = group%pins(i)
      call add_force(linkage, body, pin, carried(:, pin), forces)
      load(body)%force = load(body)%force + carried(:, pin)
      load(body)%moment = load(body)%moment + cross(arm_to_pin(linkage, pose, body, pin), &
        carried(:, pin))
    end do
  end subroutine load_body

  !> Forces in a group, from its equations: `Jᵀ λ = −Q`, with Q the loads on its unknowns and λ the
  !! forces that the equations stand for. They load what is placed before.
  pure subroutine solve_group(linkage, group, factors, is_passed, carried, load, forces)
    type(linkage_t), intent(in) :: linkage
    type(group_t), intent(in) :: group
    type(group_factors_t), intent(in) :: factors
    logical, intent(inout) :: is_passed(:)   !! (bodies) whose loads their first pins bear already
    real(wp), intent(inout) :: carried(:, :) !! (2, pins) loads on pins so far [N]
    type(load_t), intent(inout) :: load(:)   !! (bodies) so far, with those of pins they carry
    type(joint_forces_t), intent(inout) :: forces

    real(wp) :: lambda(size(group%equations))
    integer :: i, k, first

    ! The load of a body acts at its first pin, which passes it on.
    do i = 1, size(group%loaded)
      first = linkage%bodies(group%loaded(i))%first_pin
      carried(:, first) = carried(:, first) + load(group%loaded(i))%force
      forces%on_first(:, group%loaded(i)) = forces%on_first(:, group%loaded(i)) - &
        load(group%loaded(i))%force
    end do
    is_passed(group%loaded) = .true.
    do k = 1, size(group%pins)
      lambda(2*k - 1:2*k) = -carried(:, group%pins(k))
    end do
    lambda(2*size(group%pins) + 1:) = -load(group%bodies)%moment/factors%scale
    lambda = solve_transposed(factors%factor, lambda)
    do i = 1, size(group%equations)
      associate (partial => factors%gradients%partial, last => factors%gradients%last)
        do k = last(i - 1) + 1, last(i)
          associate (body => partial(k)%body, pin => partial(k)%pin, force => &
            lambda(i)*partial(k)%by_pin)
            if (body > 0) load(body)%moment = load(body)%moment + lambda(i)*partial(k)%by_angle
            if (pin == 0) cycle
            if (body > 0) then
              call load_first_pin(linkage, is_passed(body), body, force, carried, load, forces)
            else
              carried(:, pin) = carried(:, pin) + force
            end if
          end associate
        end do
        call take_reaction(linkage, group%equations(i), lambda(i), partial(last(i))%by_pin, &
          forces)
      end associate
    end do
  end subroutine solve_group

  !> What an equation puts on joints and drives, and on the pin of whose body it gives length or
  !! direction.
  pure subroutine take_reaction(linkage, equation, lambda, by_pin, forces)
    type(linkage_t), intent(in) :: linkage
    type(equation_t), intent(in) :: equation
    real(wp), intent(in) :: lambda            !! its reaction [N] or [N m]
    real(wp), intent(in) :: by_pin(2)         !! of the last partial of its gradient
    type(joint_forces_t), intent(inout) :: forces

    if (equation%pin > 0) call add_force(linkage, equation%body, equation%pin, &
      -lambda*by_pin, forces)
    select case (equation%kind)
    case (demand_line)
      forces%guide(equation%number) = lambda
    case (demand_turn)
      forces%couple(equation%number) = lambda
    case (demand_drive)
      forces%drive(equation%number) = lambda
    end select
  end subroutine take_reaction

  !> What an equation puts on a body is a load on its first pin, which bears the opposite of it; if
  !! the body is placed before, it is a load of the body.
  pure subroutine load_first_pin(linkage, is_passed, body, force, carried, load, forces)
    type(linkage_t), intent(in) :: linkage
    logical, intent(in) :: is_passed
    integer, intent(in) :: body
    real(wp), intent(in) :: force(2)
    real(wp), intent(inout) :: carried(:, :)
    type(load_t), intent(inout) :: load(:)
    type(joint_forces_t), intent(inout) :: forces

    if (is_passed) then
      carried(:, linkage%bodies(body)%first_pin) = carried(:, linkage%bodies(body)%first_pin) + &
        force
      forces%on_first(:, body) = forces%on_first(:, body) - force
    else
      load(body)%force = load(body)%force + force
    end if
  end subroutine load_first_pin

  !> Forces in one dyad. The moments of each body about its base give the force X on the first body
  !! at the middle pin: `n3·X = p`, `n4·X = q`, hence `X = (p e4 − q e3)/sin(θ4 − θ3)`.
  pure subroutine solve_dyad(linkage, dyad, pose, sine, body_load, carried, forces)
    type(linkage_t), intent(in) :: linkage
    type(group_t), intent(in) :: dyad
    type(pose_t), intent(in) :: pose
    real(wp), intent(in) :: sine
    type(load_t), intent(in) :: body_load(:)
    real(wp), intent(inout) :: carried(:, :) !! (2, pins) loads on pins so far [N]
    type(joint_forces_t), intent(inout) :: forces

    real(wp) :: e(2, 2), moment(2), at_middle(2, 2), at_base(2), p, q
    integer :: k

    do k = 1, 2
      associate (body => linkage%bodies(dyad%body(k)), load => body_load(dyad%body(k)))
        e(:, k) = arm_to_middle(linkage, dyad, pose, k)
        moment(k) = load%moment
        if (body%last_pin /= dyad%middle) moment(k) = load%moment + body%length*cross(e(:, k), &
          load%force)
        moment(k) = moment(k)/body%length
      end associate
    end do
    p = -moment(1)
    q = dot_product(normal_to(e(:, 2)), carried(:, dyad%middle)) + moment(2)
    at_middle(:, 1) = (p*e(:, 2) - q*e(:, 1))/sine
    at_middle(:, 2) = carried(:, dyad%middle) - at_middle(:, 1)

    do k = 1, 2
      at_base = -(at_middle(:, k) + body_load(dyad%body(k))%force)
      carried(:, dyad%base(k)) = carried(:, dyad%base(k)) - at_base
      if (linkage%bodies(dyad%body(k))%last_pin == dyad%middle) then
        forces%on_last(:, dyad%body(k)) = at_middle(:, k)
        forces%on_first(:, dyad%body(k)) = at_base
      else
        forces%on_first(:, dyad%body(k)) = at_middle(:, k)
        forces%on_last(:, dyad%body(k)) = at_base
      end if
    end do
  end subroutine solve_dyad

end module joint_forces
