!> Forces in the joints of a linkage whose drives give its motion, while actuators give the efforts.
!!
!! With an effort of 1 along the coordinate s_a of actuator a the drives give −J_ad = −∂s_a/∂c_d, by
!! virtual work. Efforts τ with `Jᵀ τ = λ`, where λ is what the drives would give without them,
!! leave nothing to the drives: added to the loads they complete every load case, and all that is
!! made of cases, and of friction, holds.
module actuated_forces
  use applied_loads, only: add_effort
  use coordinate_types, only: coordinate_t, is_sum
  use coordinates, only: evaluate, evaluated_t, is_turning
  use dense_factor, only: dense_factor_t, factorize, least_singular_value, solve_transposed
  use errors, only: error_of_numerics, error_t, set_error
  use ground_loads, only: effort_on_ground
  use group_factors, only: factorize_groups, group_factors_t
  use inertia_loads, only: load_t
  use joint_forces, only: add_force, add_scaled, find_joint_forces, joint_forces_t
  use kinds, only: wp
  use linkages, only: drive_of_length, gives_angle, is_actuated, linkage_t
  use pose_types, only: pose_t
  implicit none (type, external)
  private

  public :: statics_factors_t, factorize_statics, find_actuated_forces
  public :: find_actuator_fault, actuator_sense, actuators_on_ground

  !> Efforts of one along all actuators at a pose.
  type :: actuation_t
    type(joint_forces_t), allocatable :: of_one(:) !! (actuators) that balance them
    real(wp), allocatable :: scale(:)          !! (actuators) units of their coordinates
    real(wp), allocatable :: drive_scale(:)    !! (drives) those of theirs
    logical, allocatable :: moves(:)           !! (actuators) with any drive
    type(dense_factor_t) :: factor             !! of J in these units
    logical :: holds = .false.                 !! J is regular
  end type actuation_t

  !> What the forces of all loads at a pose have in common.
  type :: statics_factors_t
    type(group_factors_t), allocatable :: groups(:) !! of `factorize_groups`
    type(actuation_t), allocatable :: actuation     !! not allocated: the drives give the efforts
  end type statics_factors_t

  !> Below this, in units of the size of the linkage and radians, J is singular.
  real(wp), parameter :: least_motion = 1.0e-9_wp

contains

  !> What is found once for all loads at a pose.
  pure subroutine factorize_statics(linkage, pose, factors)
    type(linkage_t), intent(in) :: linkage          !! its groups and actuators
    type(pose_t), intent(in) :: pose                !! away from dead points
    type(statics_factors_t), intent(out) :: factors

    call factorize_groups(linkage, pose, factors%groups)
    if (.not. is_actuated(linkage)) return
    allocate (factors%actuation)
    call find_actuation(linkage, pose, factors%groups, factors%actuation)
  end subroutine factorize_statics

  !> As `find_joint_forces`, with the efforts of actuators, where there are any, in place of those
  !! of the drives; `torque` remains that of the first drive that they replace. Where they cannot
  !! hold the linkage, which `find_actuator_fault` tells, the drives do.
  pure function find_actuated_forces(linkage, pose, factors, body_load, pin_load) result(forces)
    type(linkage_t), intent(in) :: linkage   !! its actuators
    type(pose_t), intent(in) :: pose         !! away from dead points
    type(statics_factors_t), intent(in) :: factors !! of `factorize_statics` there
    type(load_t), intent(in) :: body_load(:) !! (bodies) all loads but pin forces
    real(wp), intent(in) :: pin_load(:, :)   !! (2, pins) loads on the pins [N]
    type(joint_forces_t) :: forces

    real(wp) :: torque, effort(size(linkage%drives))
    integer :: a

    forces = find_joint_forces(linkage, pose, body_load, pin_load, factors%groups)
    if (.not. allocated(factors%actuation)) return
    associate (actuation => factors%actuation)
      if (.not. actuation%holds) return
      torque = forces%torque
      effort = solve_transposed(actuation%factor, actuation%drive_scale*forces%drive)/ &
        actuation%scale
      do a = 1, size(effort)
        call add_scaled(forces, effort(a), actuation%of_one(a))
      end do
    end associate
    forces%torque = torque
    forces%drive = effort
  end function find_actuated_forces

  !> Whether the actuators hold a linkage at a pose. Errors: one of them does not move, or there is
  !! a motion in which none does.
  pure subroutine find_actuator_fault(linkage, factors, error)
    type(linkage_t), intent(in) :: linkage         !! its actuators, if it has any
    type(statics_factors_t), intent(in) :: factors !! of `factorize_statics` at a pose
    type(error_t), allocatable, intent(out) :: error

    character(len=:), allocatable :: names
    integer :: a

    if (.not. allocated(factors%actuation)) return
    if (factors%actuation%holds) return
    names = ""
    do a = 1, size(linkage%actuators)
      if (.not. all(factors%actuation%moves) .and. factors%actuation%moves(a)) cycle
      if (len(names) > 0) names = names//", "
      names = names//"'"//linkage%actuators(a)%name//"'"
    end do
    if (all(factors%actuation%moves)) then
      call set_error(error, error_of_numerics, names//" cannot hold the linkage: it can move "// &
        "there while they do not")
    else
      call set_error(error, error_of_numerics, names//" cannot hold the linkage: "// &
        trim(merge("it does not move  ", "they do not move  ", &
        count(.not. factors%actuation%moves) == 1))//" there")
    end if
  end subroutine find_actuator_fault

  !> The sign of the determinant of J, 0 where the actuators cannot hold the linkage: where it is
  !! another one they cannot on the way, and their efforts grow beyond all bounds.
  pure function actuator_sense(linkage, pose) result(sense)
    type(linkage_t), intent(in) :: linkage !! with actuators
    type(pose_t), intent(in) :: pose       !! away from dead points
    real(wp) :: sense

    type(statics_factors_t) :: factors

    call factorize_statics(linkage, pose, factors)
    sense = 0.0_wp
    if (factors%actuation%holds) sense = sign(1.0_wp, factors%actuation%factor%determinant)
  end function actuator_sense

  !> Efforts of one, and J.
  pure subroutine find_actuation(linkage, pose, groups, actuation)
    type(linkage_t), intent(in) :: linkage !! with actuators
    type(pose_t), intent(in) :: pose
    type(group_factors_t), allocatable, intent(in) :: groups(:)
    type(actuation_t), intent(out) :: actuation

    real(wp) :: jacobian(size(linkage%actuators), size(linkage%drives)), length
    integer :: a

    allocate (actuation%of_one(size(linkage%actuators)))
    ! A power of two takes no digit.
    length = scale(1.0_wp, exponent(max(maxval(linkage%bodies%length), maxval(abs(pose%pin)))))
    actuation%drive_scale = merge(1.0_wp, length, gives_angle(linkage%drives))
    allocate (actuation%scale(size(linkage%actuators)), source=length)
    do a = 1, size(linkage%actuators)
      associate (coordinate => linkage%coordinates(linkage%actuators(a)%coordinate))
        if (is_turning(linkage, coordinate)) actuation%scale(a) = 1.0_wp
        call balance_one(linkage, pose, coordinate, groups, actuation%of_one(a))
      end associate
      jacobian(a, :) = -actuation%of_one(a)%drive*actuation%drive_scale/actuation%scale(a)
    end do
    actuation%moves = norm2(jacobian, dim=2) > least_motion
    if (.not. all(actuation%moves)) return
    call factorize(jacobian, actuation%factor)
    if (abs(actuation%factor%determinant) > 0.0_wp) actuation%holds = &
      abs(least_singular_value(actuation%factor)) > least_motion
  end subroutine find_actuation

  !> What balances an effort of 1 along a coordinate.
  pure subroutine balance_one(linkage, pose, coordinate, groups, forces)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(coordinate_t), intent(in) :: coordinate
    type(group_factors_t), allocatable, intent(in) :: groups(:)
    type(joint_forces_t), intent(out) :: forces

    type(evaluated_t) :: evaluated
    type(load_t) :: body_load(size(linkage%bodies))
    real(wp) :: pin_load(2, size(linkage%is_ground))

    pin_load = 0.0_wp
    call evaluate(linkage, pose, coordinate, evaluated)
    call add_effort(linkage, pose, coordinate, evaluated, 1.0_wp, body_load, pin_load)
    forces = find_joint_forces(linkage, pose, body_load, pin_load, groups)
    call press_rams(linkage, pose, coordinate, 1.0_wp, forces)
  end subroutine balance_one

  !> A ram bears its own effort: pins put on its ends the opposite of what it puts on them.
  pure recursive subroutine press_rams(linkage, pose, coordinate, effort, forces)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(coordinate_t), intent(in) :: coordinate
    real(wp), intent(in) :: effort
    type(joint_forces_t), intent(inout) :: forces

    type(evaluated_t) :: evaluated
    integer :: i, body

    if (coordinate%kind == is_sum) then
      do i = 1, size(coordinate%term)
        call press_rams(linkage, pose, linkage%coordinates(coordinate%term(i)), &
          coordinate%weight(i)*effort, forces)
      end do
      return
    end if
    body = ram_of(linkage, coordinate)
    if (body == 0) return
    call evaluate(linkage, pose, coordinate, evaluated)
    do i = 1, 2
      call add_force(linkage, body, coordinate%at(i)%pin, -effort*evaluated%wrench(i)%force, &
        forces)
    end do
  end subroutine press_rams

  !> The body whose driven length a coordinate is; 0: none. A measure between the same pins acts
  !! beside the ram.
  pure function ram_of(linkage, coordinate) result(body)
    type(linkage_t), intent(in) :: linkage
    type(coordinate_t), intent(in) :: coordinate
    integer :: body

    body = 0
    if (coordinate%drive == 0) return
    associate (drive => linkage%drives(coordinate%drive))
      if (drive%kind == drive_of_length) body = drive%body
    end associate
  end function ram_of

  !> What actuators put on the ground beside the forces in the joints, those of rams.
  pure function actuators_on_ground(linkage, pose, effort) result(load)
    type(linkage_t), intent(in) :: linkage !! its actuators
    type(pose_t), intent(in) :: pose       !! pins and directions
    real(wp), intent(in) :: effort(:)      !! (actuators) [N] or [N m]
    real(wp) :: load(3)                    !! fx, fy [N], moment about `reference_point` [N m]

    type(evaluated_t) :: evaluated
    integer :: a, i

    load = 0.0_wp
    do a = 1, size(effort)
      associate (it => linkage%coordinates(linkage%actuators(a)%coordinate))
        if (it%kind /= is_sum) then
          call evaluate(linkage, pose, it, evaluated)
          if (ram_of(linkage, it) == 0) load = load + effort_on_ground(linkage, pose, it, &
            evaluated, effort(a))
          cycle
        end if
        do i = 1, size(it%term)
          associate (term => linkage%coordinates(it%term(i)))
            call evaluate(linkage, pose, term, evaluated)
            if (ram_of(linkage, term) == 0) load = load + effort_on_ground(linkage, pose, term, &
              evaluated, it%weight(i)*effort(a))
          end associate
        end do
      end associate
    end do
  end function actuators_on_ground

end module actuated_forces
