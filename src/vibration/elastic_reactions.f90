!> Forces in the joints of statically indeterminate linkages, by the elasticity of their links.
!!
!! The loads are those of statics: springs pull as they do at the position, and masses are where
!! INERTIA puts them. States of self-stress of rigid links have no strain energy: the forces in them
!! stay open.
module elastic_reactions
  use acceleration_fields, only: point_acceleration
  use applied_loads, only: add_moving_loads, evaluate_loads, forced_places, has_moving_loads
  use coordinates, only: evaluated_t
  use deformation_model, only: deformation_model_t, new_deformation_model
  use elastic_linkages, only: elastic_linkage_t, new_elastic_linkage
  use elastic_positions, only: elastic_position_t
  use errors, only: error_of_input, error_t, set_error
  use group_factors, only: factorize_groups, group_factors_t
  use inertia_loads, only: load_t, lumped_masses, lumped_stations
  use joint_forces, only: add_scaled, find_joint_forces, joint_forces_t, no_joint_forces
  use joint_friction, only: find_rubbing, force_in_joint, has_friction, put_friction, rubbing_t
  use kinematic_coefficients, only: kinematic_coefficients_t
  use kinds, only: wp
  use linkages, only: body_t, cross, drive_of_angle, forced_place_t, linkage_t, lump_t
  use load_cases, only: case_count, find_unit_loads
  use mixed_positions, only: find_mixed_forces
  use part_displacements, only: border_size
  use part_efforts, only: add_drive_effort, add_friction_effort, add_moving_efforts, effort_case, &
    no_part_loads
  use part_force_types, only: loaded_parts_t, part_loads_t
  use part_forces, only: find_part_forces
  use part_reactions, only: take_part_reactions
  use pin_displacements, only: chords_t
  use poses, only: arm_to_place, pose_t
  use position_assembly, only: assembled_t, choose_form, load_mixed, load_parts, new_assembled, &
    place_parts
  use reactions, only: unit_reactions_t
  use running_loads, only: divided_t, velocities_at
  use structures, only: structure_t
  implicit none (type, external)
  private

  public :: elastic_division_t, divided_position_t, new_elastic_division, new_elastic_model, &
    divide_by_elasticity, find_divided, divide_motion, self_stresses, least_open

  !> Orders of the links: their border alone carries loads.
  integer, parameter :: least_order = 5

  !> A force of a state of self-stress above this share of its largest is open; less is round-off.
  real(wp), parameter :: least_open = 1.0e-9_wp

  !> A linkage whose elasticity divides forces, once for all positions.
  type :: elastic_division_t
    type(structure_t) :: structure            !! with its loads and masses on its parts
    type(deformation_model_t) :: model        !! of its parts
  end type elastic_division_t

  !> The linkage at a position.
  type :: divided_position_t
    type(assembled_t) :: here
    type(chords_t) :: chords
    type(pose_t) :: pose                      !! of the linkage that moves
  end type divided_position_t

contains

  !> The parts of a linkage, once for all positions.
  !!
  !! Errors: a link has no own modes.
  subroutine new_elastic_division(structure, division, error, crank)
    class(structure_t), intent(in) :: structure          !! that `has_elastic_reactions`
    type(elastic_division_t), intent(out) :: division
    type(error_t), allocatable, intent(out) :: error
    real(wp), intent(in), optional :: crank(:)           !! some positions of the first drive, which
                                                         !! holds its link; absent: of a motion in
                                                         !! which nothing does

    type(linkage_t) :: released
    integer :: b

    division%structure%linkage = structure%linkage
    division%structure%load_elements = structure%load_elements
    associate (linkage => division%structure%linkage)
      if (has_moving_loads(linkage)) then
        do b = 1, size(linkage%bodies)
          linkage%bodies(b)%forced = forced_places(linkage%loads, b, with_moving=.true.)
        end do
      end if
      released = linkage
      if (.not. present(crank)) then
        where (linkage%drives%kind == drive_of_angle) released%drives%is_free = .true.
        linkage%drives%is_free = .false.
      end if
    end associate
    division%structure%elastic = new_elastic_linkage(released, structure%beams)
    if (.not. present(crank)) division%structure%elastic%free_drives = [integer ::]
    call take_statics(structure%load_elements, division%structure%elastic)
    call new_elastic_model(division%structure, division%model, error, crank)
  end subroutine new_elastic_division

  !> The parts of a linkage with as few unknowns as loads at rest need.
  !!
  !! Errors: a link has no own modes.
  subroutine new_elastic_model(structure, model, error, crank)
    class(structure_t), intent(in) :: structure      !! with parts
    type(deformation_model_t), intent(out) :: model
    type(error_t), allocatable, intent(out) :: error
    real(wp), intent(in), optional :: crank(:)       !! some positions of the first drive, for the
                                                     !! border; absent: it is left out

    integer :: parts

    parts = size(structure%elastic%body)
    call new_deformation_model(structure%elastic%linkage, structure%elastic%beams, spread(0, 1, &
      parts), spread(least_order, 1, parts), spread(.false., 1, parts), model, error, &
      held=structure%elastic%held)
    if (allocated(error)) return
    if (present(crank)) call choose_form(structure, 0, crank, model)
  end subroutine new_elastic_model

  !> Springs become loads. Where the masses of a part sit on the nodes of its elements, their forces
  !! act there, behind the loads of the linkage.
  pure subroutine take_statics(elements, elastic)
    integer, intent(in) :: elements(:) !! (bodies) on whose nodes the masses are lumped; 0:
                                       !! distributed
    type(elastic_linkage_t), intent(inout) :: elastic

    type(lump_t), allocatable :: masses(:)
    integer :: i, k, number

    elastic%springs%stiffness = 0.0_wp
    number = size(elastic%linkage%loads)
    do k = 1, size(elastic%body)
      associate (part => elastic%linkage%bodies(k))
        if (elements(elastic%body(k)) == 0 .or. .not. part%bends) cycle
        masses = masses_on(part, elements(elastic%body(k)))
        if (.not. allocated(part%forced)) allocate (part%forced(0))
        do i = 1, size(masses)
          number = number + 1
          part%forced = [part%forced, forced_place_t(number, masses(i)%place)]
        end do
      end associate
    end do
  end subroutine take_statics

  !> Masses of a part whose own sit on the nodes of its elements: these, then those fixed to it.
  pure function masses_on(part, elements) result(masses)
    type(body_t), intent(in) :: part
    integer, intent(in) :: elements
    type(lump_t) :: masses(elements + 1 + size(part%lumps))

    real(wp) :: mass(elements + 1), station(elements + 1)
    integer :: i

    mass = lumped_masses(part, elements)
    station = lumped_stations(part, elements)
    do i = 1, elements + 1
      masses(i) = lump_t(mass(i), [station(i), 0.0_wp], 0.0_wp)
    end do
    masses(elements + 2:) = part%lumps
  end function masses_on

  !> The forces in the parts where masses sit on nodes.
  pure subroutine load_nodes(division, at)
    type(elastic_division_t), intent(in) :: division
    type(divided_position_t), intent(inout) :: at

    type(loaded_parts_t) :: loaded

    loaded%loads = at%here%loaded%loads
    call lump_loads(division, at%here%elastic_position_t, loaded%loads)
    call find_forces(division, at, loaded)
    at%here%loaded = loaded
  end subroutine load_nodes

  !> The forces in the parts under loads.
  pure subroutine find_forces(division, at, loaded)
    type(elastic_division_t), intent(in) :: division
    type(divided_position_t), intent(in) :: at
    type(loaded_parts_t), intent(inout) :: loaded !! with loads; gets their forces

    real(wp), allocatable :: solution(:, :)

    associate (here => at%here, linkage => division%structure%linkage)
      if (allocated(here%mixed)) then
        call find_mixed_forces(here%elastic_position_t, here%mixed, loaded, solution)
      else
        call find_part_forces(here%elastic_position_t, here%border, at%chords, loaded)
      end if
    end associate
  end subroutine find_forces

  !> Puts the inertia loads of such parts on their nodes.
  pure subroutine lump_loads(division, at, loads)
    type(elastic_division_t), intent(in) :: division
    type(elastic_position_t), intent(in) :: at
    type(part_loads_t), intent(inout) :: loads !! of masses along the parts

    type(lump_t), allocatable :: masses(:)
    real(wp) :: force(2)
    integer :: c, i, k, n, number

    associate (elastic => at%elastic)
      do c = 1, case_count
        if (.not. loads%unit%occurs(c)) cycle
        number = size(elastic%linkage%loads)
        do k = 1, size(elastic%body)
          n = division%structure%load_elements(elastic%body(k))
          if (n == 0 .or. .not. elastic%linkage%bodies(k)%bends) cycle
          masses = masses_on(elastic%linkage%bodies(k), n)
          associate (case => loads%unit%of_case(c))
            do i = 1, size(masses)
              number = number + 1
              force = -masses(i)%mass*point_acceleration(case%field, k, masses(i)%place(1), &
                masses(i)%place(2))
              case%place_force(:, number) = force
              case%body_force(:, k) = case%body_force(:, k) + force
              case%couple(k) = case%couple(k) + cross(arm_to_place(at%pose, k, &
                masses(i)%place), force)
            end do
            case%field%at_first(:, k) = 0.0_wp
            case%field%slope(:, k) = 0.0_wp
          end associate
        end do
      end do
    end associate
  end subroutine lump_loads

  !> Puts the forces by elasticity in place of those of statics.
  !!
  !! Errors: those of `place_parts` and `find_part_chords`.
  subroutine divide_by_elasticity(division, pose, coefficients, unit, at, error)
    type(elastic_division_t), intent(in) :: division           !! of this linkage
    type(pose_t), intent(in) :: pose                           !! away from dead points
    type(kinematic_coefficients_t), intent(in) :: coefficients !! at the pose
    type(unit_reactions_t), intent(inout) :: unit              !! by statics
    type(divided_position_t), intent(out) :: at                !! for other loads
    type(error_t), allocatable, intent(out) :: error

    integer :: i

    at%pose = pose
    at%here = new_assembled(division%structure, division%model)
    at%here%loads = find_unit_loads(division%structure%linkage, pose, coefficients)
    if (division%model%mixed) then
      call load_mixed(division%structure, division%model, pose, .false., at%here, error)
    else
      call load_parts(division%structure, division%model, pose, at%here, at%chords, error)
    end if
    if (allocated(error)) return
    if (any(division%structure%load_elements > 0)) call load_nodes(division, at)
    do i = 1, case_count
      call take_part_reactions(division%structure%linkage, at%here%elastic_position_t, &
        at%here%loaded, i, unit%of_case(i)%joints)
    end do
  end subroutine divide_by_elasticity

  !> The forces in the joints of `find_running_loads` at a speed.
  !!
  !! Errors: friction depends on a force that is open.
  pure subroutine find_divided(division, at, coefficients, speed, divided, error)
    type(elastic_division_t), intent(in) :: division
    type(divided_position_t), intent(in) :: at                 !! of `divide_by_elasticity`
    type(kinematic_coefficients_t), intent(in) :: coefficients !! there
    real(wp), intent(in) :: speed                              !! of the first drive [rad/s], [m/s]
    type(divided_t), intent(inout) :: divided                  !! friction that is there is kept
    type(error_t), allocatable, intent(out) :: error

    type(joint_forces_t), allocatable :: states(:)
    integer :: i, k

    call divide_moving(division, at, coefficients, speed, divided%moving)
    if (allocated(divided%friction)) return
    call divide_friction(division, at, divided%friction)
    states = self_stresses(division, at)
    associate (linkage => division%structure%linkage)
      do i = 1, size(states)
        do k = 1, size(divided%friction)
          if (norm2(force_in_joint(linkage, states(i), linkage%frictions(k))) <= least_open) cycle
          call set_error(error, error_of_input, "friction depends on the forces in the joints, "// &
            "and rigid links hold each other where one rubs", pin=linkage%frictions(k)%pin, &
            body=linkage%frictions(k)%body)
          return
        end do
      end do
    end associate
  end subroutine find_divided

  !> The forces in the joints under other loads.
  pure subroutine find_effort_forces(division, at, loaded, joints)
    type(elastic_division_t), intent(in) :: division
    type(divided_position_t), intent(in) :: at
    type(loaded_parts_t), intent(inout) :: loaded !! with loads; gets their forces
    type(joint_forces_t), intent(inout) :: joints !! of statics: those of drives are kept

    call find_forces(division, at, loaded)
    call take_part_reactions(division%structure%linkage, at%here%elastic_position_t, loaded, &
      effort_case, joints)
  end subroutine find_effort_forces

  !> Forces in the joints that balance the loads that depend on the speed, but for friction.
  pure subroutine divide_moving(division, at, coefficients, speed, joints)
    type(elastic_division_t), intent(in) :: division
    type(divided_position_t), intent(in) :: at                 !! of `divide_by_elasticity`
    type(kinematic_coefficients_t), intent(in) :: coefficients !! there
    real(wp), intent(in) :: speed                              !! of the first drive [rad/s], [m/s]
    type(joint_forces_t), intent(out) :: joints

    type(kinematic_coefficients_t) :: now
    type(loaded_parts_t) :: loaded
    type(load_t) :: body_load(size(division%structure%linkage%bodies))
    type(evaluated_t), allocatable :: along(:)
    real(wp) :: pin_load(2, size(division%structure%linkage%is_ground))

    pin_load = 0.0_wp
    associate (linkage => division%structure%linkage)
      if (.not. has_moving_loads(linkage)) then
        joints = no_joint_forces(linkage)
        return
      end if
      now = velocities_at(coefficients, speed)
      call evaluate_loads(linkage, at%pose, along)
      call add_moving_loads(linkage, at%pose, along, now, body_load, pin_load)
      joints = find_joint_forces(linkage, at%pose, body_load, pin_load)
      loaded%loads = no_part_loads(at%here%elastic)
      call add_moving_efforts(linkage, at%pose, now, at%here%elastic_position_t, loaded%loads)
    end associate
    call find_effort_forces(division, at, loaded, joints)
  end subroutine divide_moving

  !> Forces in the joints that balance an effort of one in each joint that rubs.
  pure subroutine divide_friction(division, at, joints)
    type(elastic_division_t), intent(in) :: division
    type(divided_position_t), intent(in) :: at                     !! of `divide_by_elasticity`
    type(joint_forces_t), allocatable, intent(out) :: joints(:)    !! (frictions)

    type(loaded_parts_t) :: loaded
    type(load_t) :: body_load(size(division%structure%linkage%bodies))
    type(group_factors_t), allocatable :: factors(:)
    type(rubbing_t), allocatable :: rubbing(:)
    real(wp) :: pin_load(2, size(division%structure%linkage%is_ground))
    real(wp), allocatable :: effort(:)
    integer :: k

    associate (linkage => division%structure%linkage)
      if (.not. has_friction(linkage)) then
        allocate (joints(0))
        return
      end if
      allocate (joints(size(linkage%frictions)), effort(size(linkage%frictions)))
      call factorize_groups(linkage, at%pose, factors)
      call find_rubbing(linkage, at%pose, rubbing)
      do k = 1, size(joints)
        effort = 0.0_wp
        effort(k) = 1.0_wp
        call put_friction(linkage, at%pose, rubbing, effort, body_load, pin_load)
        joints(k) = find_joint_forces(linkage, at%pose, body_load, pin_load, factors)
        loaded%loads = no_part_loads(at%here%elastic)
        call add_friction_effort(k, at%here%elastic_position_t, loaded%loads)
        call find_effort_forces(division, at, loaded, joints(k))
      end do
    end associate
  end subroutine divide_friction

  !> Forces in the joints of a linkage that moves freely: its inertia, and the force of the first
  !! drive, balance all loads.
  !!
  !! Errors: those of `place_parts`; the linkage has other free motions than its drives: a dead
  !! point.
  subroutine divide_motion(division, pose, motion, drive_force, joints, states, error)
    type(elastic_division_t), intent(in) :: division       !! of a motion
    type(pose_t), intent(in) :: pose                       !! in global axes
    type(kinematic_coefficients_t), intent(in) :: motion   !! velocities and accelerations
    real(wp), intent(in) :: drive_force                    !! on the first drive [N m] or [N]
    type(joint_forces_t), intent(out) :: joints
    type(joint_forces_t), allocatable, intent(out) :: states(:) !! of self-stress
    type(error_t), allocatable, intent(out) :: error

    type(divided_position_t) :: at
    type(loaded_parts_t) :: loaded
    integer :: unknowns, free, i

    at%pose = pose
    associate (linkage => division%structure%linkage)
      at%here = new_assembled(division%structure, division%model)
      ! With velocities and accelerations for coefficients the first case is all inertia.
      at%here%loads = find_unit_loads(linkage, pose, motion, [.true., .false., .true.])
      call place_parts(division%structure, division%model, pose, at%here, error)
      if (allocated(error)) return
      call border_size(at%here%elastic_position_t, unknowns, free)
      at%here%model%layout%border = unknowns
      at%here%model%layout%free = count(linkage%drives%kind == drive_of_angle)
      call load_parts(division%structure, division%model, pose, at%here, at%chords, error)
      if (allocated(error)) return
      if (any(division%structure%load_elements > 0)) call load_nodes(division, at)
      joints = no_joint_forces(linkage)
      do i = 1, case_count
        if (at%here%loads%occurs(i)) call add_forces(at%here%loaded, i)
      end do
      loaded%loads = no_part_loads(at%here%elastic)
      if (has_moving_loads(linkage)) call add_moving_efforts(linkage, pose, motion, &
        at%here%elastic_position_t, loaded%loads)
      associate (drive => linkage%drives(1))
        if (drive%kind == drive_of_angle) call add_drive_effort(1, drive_force, &
          at%here%elastic_position_t, loaded%loads)
      end associate
      call find_forces(division, at, loaded)
      call add_forces(loaded, effort_case)
      joints%drive(1) = drive_force
      joints%torque = drive_force
    end associate
    states = self_stresses(division, at)

  contains

    !> Adds the forces of a load case.
    subroutine add_forces(of_loads, case)
      type(loaded_parts_t), intent(in) :: of_loads
      integer, intent(in) :: case

      type(joint_forces_t) :: of_case

      of_case = no_joint_forces(division%structure%linkage)
      call take_part_reactions(division%structure%linkage, at%here%elastic_position_t, of_loads, &
        case, of_case)
      call add_scaled(joints, 1.0_wp, of_case)
    end subroutine add_forces

  end subroutine divide_motion

  !> Forces in the joints that are in equilibrium without loads, and that strain nothing: rigid
  !! links hold each other. The largest force of each is one, moments divided by the longest link.
  pure function self_stresses(division, at) result(states)
    type(elastic_division_t), intent(in) :: division
    type(divided_position_t), intent(in) :: at              !! of `divide_by_elasticity`
    type(joint_forces_t), allocatable :: states(:)

    type(loaded_parts_t) :: loaded
    type(joint_forces_t) :: joints
    integer, allocatable :: open(:)
    real(wp), allocatable :: given(:)
    integer :: i, j, k, n

    loaded%loads = no_part_loads(at%here%elastic)
    loaded%forces = at%here%loaded%forces
    associate (forces => loaded%forces, linkage => division%structure%linkage, &
        parts => at%here%elastic_position_t)
      forces%guide = 0.0_wp
      forces%weighted = 0.0_wp
      forces%spring = 0.0_wp
      forces%drive = 0.0_wp
      forces%constraint = 0.0_wp
      joints = no_joint_forces(linkage)
      call take_part_reactions(linkage, parts, loaded, effort_case, joints, open=open)
      ! In mixed form no constraint follows from others.
      n = 0
      if (allocated(at%here%border)) n = at%here%border%basis%idle_constraints
      allocate (states(n + size(open)), given(size(open)))
      do i = 1, size(states)
        given = 0.0_wp
        forces%constraint(:, effort_case) = 0.0_wp
        if (i <= n) then
          forces%constraint(:, effort_case) = at%here%border%basis%dependence(:, i)
        else
          given(i - n) = 1.0_wp
        end if
        do k = 1, merge(size(parts%numbers%line_constraint), 0, n > 0)
          j = parts%numbers%line_constraint(k)
          if (j > 0) forces%guide(k, effort_case) = -forces%constraint(j, effort_case)
        end do
        states(i) = no_joint_forces(linkage)
        call take_part_reactions(linkage, parts, loaded, effort_case, states(i), given)
        call scale(maxval(parts%elastic%linkage%bodies%length), states(i))
      end do
    end associate

  contains

    !> Makes the largest force one.
    pure subroutine scale(length, state)
      real(wp), intent(in) :: length !! [m]
      type(joint_forces_t), intent(inout) :: state

      type(joint_forces_t) :: unscaled
      real(wp) :: largest

      largest = maxval([maxval(abs(state%on_first)), maxval(abs(state%on_last)), &
        reshape(abs(state%on_further), [size(state%on_further)]), abs(state%guide), &
        abs(state%couple)/length])
      unscaled = state
      call add_scaled(state, -1.0_wp, unscaled)
      if (largest > 0.0_wp) call add_scaled(state, 1.0_wp/largest, unscaled)
    end subroutine scale

  end function self_stresses

end module elastic_reactions
