!> Forces in the parts of a linkage by its elasticity, whether it is statically determinate or not.
!!
!! The stiffness is the unit matrix. So the border unknowns of the static solution are the work of
!! the loads on unit border displacements, `z = Sᵀ f`, and `y = Q z` are the forces in parts and
!! springs. The force in a constraint is the work of the loads on a displacement that violates it,
!! less the work of the parts and springs that this strains. Free drives act as loads: the torque or
!! force that the motion needs.
module part_forces
  use axial_forces, only: distributed_unit_forces, lump_functions, most_lump_functions
  use border_loads, only: border_work, own_work
  use border_rows, only: damper_rows
  use border_unknowns, only: border_unknowns_t
  use carried_bodies, only: add_carried_stiffness, carried_work
  use dense_factor, only: dense_factor_t, factorize, solve
  use drive_rates, only: drive_rates_of, own_drive_compliance, own_drive_rates, &
    own_turns_by_couples
  use elastic_linkages, only: spring_t
  use elastic_positions, only: elastic_position_t
  use kinds, only: wp
  use link_modes, only: link_modes_t
  use linkages, only: linkage_t, normal_to
  use load_cases, only: case_count, constant_case, load_case_t, unit_loads_t
  use part_displacements, only: border_t, chords_of
  use part_force_types, only: loaded_parts_t, part_forces_t, part_loads_t
  use pin_displacements, only: chords_t
  use poses, only: pose_t
  use rigid_part_loads, only: turning_joints, turning_load
  use terminal_work, only: line_direction, turn_of_end, way_between, work_between
  implicit none (type, external)
  private

  public :: part_forces_t, pull_forces_t, find_part_forces, find_dyad_forces, find_pull_forces, &
    make_room, take_forces

  !> Forces where every damper pulls by 1 N, or turns back by 1 N m.
  type :: pull_forces_t
    real(wp), allocatable :: row(:, :)        !! (border, dampers) stretch or turn of each for unit
                                              !! unknowns, [m] or [rad]
    real(wp), allocatable :: axial(:, :)      !! (parts, dampers) axial force, the same all along;
                                              !! of a rigid part as in `part_forces_t`
    real(wp), allocatable :: second_order(:, :, :) !! (border, border, dampers)
  end type pull_forces_t

  !> What own modes of a part do to the joints of free drives.
  type :: own_rates_t
    real(wp), allocatable :: rate(:, :) !! (free drives, own modes)
  end type own_rates_t

contains

  !> The forces at a position.
  pure subroutine find_part_forces(at, border, chords, loaded)
    type(elastic_position_t), intent(in) :: at      !! with parts that are placed
    type(border_t), intent(in) :: border            !! with violations of constraints
    type(chords_t), intent(in) :: chords            !! of the border unknowns
    type(loaded_parts_t), intent(inout) :: loaded   !! with loads; gets their forces

    type(chords_t) :: of_constraints
    type(own_rates_t) :: on_own(size(at%model%links))
    real(wp), allocatable :: on_drives(:, :), drives_of_constraints(:, :), held(:), &
      compliance(:, :)
    real(wp) :: work(size(chords%turn, 1)), weighted(size(border%rows%weight)), &
      lambda(at%numbers%constraints), constant
    integer :: i, n

    n = size(chords%turn, 1) - chords%free
    call make_room(at, loaded%loads, n + chords%free, loaded%forces)
    if (.not. any(loaded%loads%unit%occurs)) return
    of_constraints = chords_of(at, border%basis%violation, border%basis%weighted_violation)
    on_drives = drive_rates_of(at, chords)
    drives_of_constraints = drive_rates_of(at, of_constraints)
    call find_own_drive_rates(at, on_own, compliance)
    do i = 1, case_count
      if (.not. loaded%loads%unit%occurs(i)) cycle
      associate (case => loaded%loads%unit%of_case(i))
        work = border_work(at%elastic%linkage, at%model%links, chords, at%pose, case) + &
          matmul(loaded%loads%moment(:, i), chords%rotation) + work_on_ends(at, chords, &
          loaded%loads%end_couple(:, :, i)) + carried_work(at%elastic, chords, &
          loaded%loads%carried(:, :, i))
        lambda = border_work(at%elastic%linkage, at%model%links, of_constraints, at%pose, case) + &
          matmul(loaded%loads%moment(:, i), of_constraints%rotation) + work_on_ends(at, &
          of_constraints, loaded%loads%end_couple(:, :, i)) + carried_work(at%elastic, &
          of_constraints, loaded%loads%carried(:, :, i))
        loaded%forces%work(:n, i) = work(:n)
        if (size(on_drives, 1) > 0) then
          held = held_by_drives(on_drives(:, :n), on_drives(:, n + 1:), work, compliance, &
            own_turns(at, case, loaded%loads%end_couple(:, :, i), on_own))
          loaded%forces%drive(at%elastic%free_drives, i) = held
          work = work + matmul(held, on_drives)
          lambda = lambda + matmul(held, drives_of_constraints)
        end if
        loaded%forces%border(:n, i) = work(:n)
        weighted = matmul(border%basis%weighted, work(:n))
        lambda = lambda - matmul(weighted, border%basis%weighted_violation)
        call take_forces(at, weighted, lambda, i, loaded)
        constant = merge(1.0_wp, 0.0_wp, i == constant_case)
        call add_guides(at, chords, loaded%forces%guide(:, i), loaded%forces%second_order(:, :, i))
        call add_lines(at, chords, at%elastic%springs, loaded%forces%spring(:, i), &
          loaded%forces%second_order(:, :, i))
        call add_lines(at, chords, at%elastic%tensions, constant*loaded%loads%tension, &
          loaded%forces%second_order(:, :, i))
        call add_carried_stiffness(at%elastic, chords, loaded%loads%carried(:, :, i), &
          loaded%forces%second_order(:, :, i))
      end associate
    end do
  end subroutine find_part_forces

  !> The forces of a crank and dyads, from the equilibrium of one dyad after another.
  pure subroutine find_dyad_forces(linkage, pose, loads, links, chords, forces)
    type(linkage_t), intent(in) :: linkage     !! of binary links
    type(pose_t), intent(in) :: pose
    type(unit_loads_t), intent(in) :: loads    !! of this pose
    type(link_modes_t), intent(in) :: links(:) !! (bodies)
    type(chords_t), intent(in) :: chords       !! of the border unknowns
    type(part_forces_t), intent(inout) :: forces !! axial, and of the border; room is used again

    integer :: i, n

    n = size(chords%turn, 1)
    forces%axial = distributed_unit_forces(linkage, pose, loads)
    if (.not. any(loads%occurs)) return
    if (.not. allocated(forces%border)) allocate (forces%second_order(n, n, case_count), &
      forces%border(n, case_count), source=0.0_wp)
    do i = 1, case_count
      forces%border(:, i) = 0.0_wp
      if (loads%occurs(i)) forces%border(:, i) = border_work(linkage, links, chords, pose, &
        loads%of_case(i))
    end do
    forces%work = forces%border
  end subroutine find_dyad_forces

  !> Forces of no loads.
  pure subroutine make_room(at, loads, border, forces)
    type(elastic_position_t), intent(in) :: at
    type(part_loads_t), intent(in) :: loads         !! which of them occur
    integer, intent(in) :: border                   !! number of unknowns of a border
    type(part_forces_t), intent(out) :: forces

    allocate (forces%axial(merge(3 + most_lump_functions(at%elastic%linkage), 0, &
      any(loads%unit%occurs)), size(at%elastic%body), case_count), forces%second_order(border, &
      border, case_count), forces%guide(size(at%elastic%contact), case_count), &
      forces%spring(size(at%elastic%springs), case_count), forces%border(border, case_count), &
      forces%work(border, case_count), forces%weighted(size(at%numbers%rows), case_count), &
      forces%constraint(at%numbers%constraints, case_count), &
      forces%drive(size(at%elastic%driven, 2), &
      case_count), source=0.0_wp)
  end subroutine make_room

  !> The forces of a load case from those in rows and constraints.
  pure subroutine take_forces(at, weighted, lambda, case, loaded)
    type(elastic_position_t), intent(in) :: at
    real(wp), intent(in) :: weighted(:)             !! (rows) [√J]
    real(wp), intent(in) :: lambda(:)               !! (constraints) [N]
    integer, intent(in) :: case                     !! number of the load case
    type(loaded_parts_t), intent(inout) :: loaded   !! with loads and forces of free drives

    real(wp) :: constant, mean
    integer :: k

    loaded%forces%weighted(:, case) = weighted
    loaded%forces%constraint(:, case) = lambda
    constant = merge(1.0_wp, 0.0_wp, case == constant_case)
    loaded%forces%guide(:, case) = guide_forces(at%numbers, lambda)
    loaded%forces%spring(:, case) = spring_forces(at, weighted) + constant*loaded%loads%pull
    do k = 1, size(at%model%links)
      if (at%elastic%linkage%bodies(k)%bends) then
        mean = weighted(at%numbers%elongation(k))/at%model%links(k)%elongation
        call add_distribution(at%elastic%linkage, k, at%pose, loaded%loads%unit%of_case(case), &
          mean, loaded%forces%axial(:, k, case))
      else
        loaded%forces%axial(1, k, case) = turning_load(at, loaded, case, [at%elastic%springs, &
          at%elastic%tensions], [loaded%forces%spring(:, case), constant*loaded%loads%tension], &
          k)/at%elastic%linkage%bodies(k)%length
      end if
    end do
  end subroutine take_forces

  !> Work of couples on the ends of parts that bend.
  pure function work_on_ends(at, chords, couple) result(work)
    type(elastic_position_t), intent(in) :: at
    type(chords_t), intent(in) :: chords
    real(wp), intent(in) :: couple(:, :) !! (2, parts) [N m]
    real(wp) :: work(size(chords%turn, 1))

    integer :: e, k

    work = 0.0_wp
    do k = 1, size(at%model%links)
      do e = 1, 2
        if (.not. abs(couple(e, k)) > 0.0_wp) cycle
        if (at%elastic%rotation(e, k) > 0) then
          work = work + couple(e, k)*chords%rotation(at%elastic%rotation(e, k), :)
        else if (at%elastic%rotation(e, k) == 0) then
          work = work + couple(e, k)*turn_of_end(at%model%links(k), chords%turn(:, k), &
            chords%across(3:, :, k), e)
        end if
      end do
    end do
  end function work_on_ends

  !> The forces of unit pulls at a position.
  pure subroutine find_pull_forces(at, border, chords, forces)
    type(elastic_position_t), intent(in) :: at      !! with parts that are placed
    type(border_t), intent(in) :: border            !! with violations of constraints
    type(chords_t), intent(in) :: chords            !! of the border unknowns, no motion being free
    type(pull_forces_t), intent(out) :: forces

    real(wp) :: rows(at%numbers%unknowns, size(at%elastic%dampers)), &
      weighted(size(border%rows%weight)), lambda(at%numbers%constraints)
    type(part_forces_t) :: unit
    integer :: i, k

    rows = damper_rows(at)
    forces%row = matmul(transpose(border%basis%unknown), rows)
    allocate (unit%drive(size(at%elastic%linkage%drives), 1), forces%axial(size(at%model%links), &
      size(rows, 2)), forces%second_order(size(forces%row, 1), size(forces%row, 1), size(rows, &
      2)), source=0.0_wp)
    do i = 1, size(rows, 2)
      ! A pull does work where a damper gets shorter.
      weighted = -matmul(border%basis%weighted, forces%row(:, i))
      lambda = -matmul(rows(:, i), border%basis%violation) - matmul(weighted, &
        border%basis%weighted_violation)
      unit%constraint = reshape(lambda, [size(lambda), 1])
      unit%guide = reshape(guide_forces(at%numbers, lambda), [size(at%elastic%contact), 1])
      associate (springs => [at%elastic%springs, at%elastic%dampers(i)], pull => &
          [spring_forces(at, weighted), 1.0_wp])
        do k = 1, size(at%model%links)
          if (at%elastic%linkage%bodies(k)%bends) then
            forces%axial(k, i) = weighted(at%numbers%elongation(k))/at%model%links(k)%elongation
          else
            forces%axial(k, i) = turning_joints(at, unit, 1, springs, pull, &
              k)/at%elastic%linkage%bodies(k)%length
          end if
        end do
        call add_guides(at, chords, unit%guide(:, 1), forces%second_order(:, :, i))
        call add_lines(at, chords, springs, pull, forces%second_order(:, :, i))
      end associate
    end do
  end subroutine find_pull_forces

  !> What springs that are strained by the deformation pull, or turn back [N] or [N m].
  pure function spring_forces(at, weighted) result(force)
    type(elastic_position_t), intent(in) :: at
    real(wp), intent(in) :: weighted(:) !! (rows) [√J]
    real(wp) :: force(size(at%elastic%springs))

    force = sqrt(at%elastic%springs%stiffness)*weighted(at%numbers%spring)
  end function spring_forces

  !> Forces of guides on their blocks, along the normals of their lines [N].
  pure function guide_forces(numbers, lambda) result(force)
    type(border_unknowns_t), intent(in) :: numbers
    real(wp), intent(in) :: lambda(:) !! (constraints)
    real(wp) :: force(size(numbers%line_constraint))

    integer :: i

    force = 0.0_wp
    do i = 1, size(force)
      associate (row => numbers%line_constraint(i))
        if (row > 0) force(i) = -lambda(row)
      end associate
    end do
  end function guide_forces

  !> `N(ξ)` of a part from its mean and the loads along it.
  pure subroutine add_distribution(linkage, part, pose, case, mean, force)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: part
    type(pose_t), intent(in) :: pose
    type(load_case_t), intent(in) :: case
    real(wp), intent(in) :: mean
    real(wp), intent(inout) :: force(:)

    real(wp), allocatable :: jump(:)
    real(wp) :: mass, place
    integer :: i

    associate (body => linkage%bodies(part), e => pose%direction(:, part))
      mass = body%line_density*body%length
      force(2) = mass*dot_product(e, case%field%at_first(:, part))
      force(3) = 0.5_wp*mass*body%length*dot_product(e, case%field%slope(:, part))
      jump = lump_functions(linkage, part, pose, case)
      force(4:3 + size(jump)) = jump
      force(1) = mean - force(2)/2.0_wp - force(3)/3.0_wp
      do i = 1, size(body%lumps)
        place = body%lumps(i)%place(1)/body%length
        force(1) = force(1) - place*jump(i)
      end do
      if (.not. allocated(body%forced)) return
      do i = 1, size(body%forced)
        place = body%forced(i)%place(1)/body%length
        force(1) = force(1) - place*jump(size(body%lumps) + i)
      end do
    end associate
  end subroutine add_distribution

  !> What blocks on guides that turn add to K_G: `R s θ`.
  pure subroutine add_guides(at, chords, guide, stiffness)
    type(elastic_position_t), intent(in) :: at
    type(chords_t), intent(in) :: chords
    real(wp), intent(in) :: guide(:)   !! (sliders) [N]
    real(wp), intent(inout) :: stiffness(:, :)

    real(wp), dimension(size(stiffness, 1)) :: along, turn
    integer :: i, j

    do i = 1, size(guide)
      if (at%elastic%sliding(1, i)%rotation <= 0) cycle
      turn = chords%rotation(at%elastic%sliding(1, i)%rotation, :)
      along = work_between(at, chords, at%elastic%sliding(:, i), line_direction(at%elastic, &
        at%pose, i), 0.0_wp)
      do j = 1, size(turn)
        stiffness(:, j) = stiffness(:, j) + guide(i)*(along*turn(j) + turn*along(j))
      end do
    end do
  end subroutine add_guides

  !> What pulls along lines that turn with the linkage add: `½ (T/l) (n·ΔU)²`.
  pure subroutine add_lines(at, chords, springs, pull, stiffness)
    type(elastic_position_t), intent(in) :: at
    type(chords_t), intent(in) :: chords
    type(spring_t), intent(in) :: springs(:)
    real(wp), intent(in) :: pull(:)    !! (springs) [N] or [N m]
    real(wp), intent(inout) :: stiffness(:, :)

    real(wp) :: across(size(stiffness, 1)), way(2)
    integer :: i, j

    do i = 1, size(pull)
      if (springs(i)%turns) cycle
      associate (ends => at%elastic%load_ends(:, springs(i)%load))
        way = way_between(at%pose, ends)
        if (.not. norm2(way) > 0.0_wp) cycle
        across = work_between(at, chords, ends, normal_to(way)/norm2(way), 0.0_wp)
      end associate
      do j = 1, size(across)
        stiffness(:, j) = stiffness(:, j) + pull(i)/norm2(way)*across*across(j)
      end do
    end do
  end subroutine add_lines

  !> What own modes of all parts do to the joints of free drives, and how they yield to these.
  pure subroutine find_own_drive_rates(at, on_own, compliance)
    type(elastic_position_t), intent(in) :: at
    type(own_rates_t), intent(out) :: on_own(:) !! (parts) empty of rigid ones
    real(wp), allocatable, intent(out) :: compliance(:, :)

    integer :: k, d

    d = size(at%elastic%free_drives)
    allocate (compliance(d, d), source=0.0_wp)
    if (d == 0) return
    do k = 1, size(at%model%links)
      if (.not. at%model%links(k)%bends) cycle
      on_own(k)%rate = own_drive_rates(at, k)
      compliance = compliance + own_drive_compliance(at%elastic, k)
    end do
  end subroutine find_own_drive_rates

  !> Turns of the joints of free drives by own modes under the loads.
  pure function own_turns(at, case, couple, on_own) result(turns)
    type(elastic_position_t), intent(in) :: at
    type(load_case_t), intent(in) :: case
    real(wp), intent(in) :: couple(:, :) !! (2, parts) on the ends of those that bend [N m]
    type(own_rates_t), intent(in) :: on_own(:)
    real(wp) :: turns(size(at%elastic%free_drives))

    integer :: k

    turns = 0.0_wp
    do k = 1, size(at%model%links)
      if (.not. allocated(on_own(k)%rate)) cycle
      turns = turns + matmul(on_own(k)%rate, own_work(at%elastic%linkage, at%model%links(k), k, &
        at%pose, case)) + own_turns_by_couples(at%elastic, k, couple(:, k))
    end do
  end function own_turns

  !> Torques and forces with which free drives hold the linkage at its position while it yields to
  !! the loads, `z = f_z + R_zᵀ m`: no drive moves, `R_z z + R_w w = 0`, and nothing is left that
  !! works on the free motions w, `f_w + R_wᵀ m = 0`.
  pure function held_by_drives(yields, moves, work, compliance, turns) result(held)
    real(wp), intent(in) :: yields(:, :) !! (drives, unknowns) R_z
    real(wp), intent(in) :: moves(:, :)  !! (drives, free motions) R_w
    real(wp), intent(in) :: work(:)      !! (unknowns, then free motions) f
    real(wp), intent(in) :: compliance(:, :) !! (drives, drives) of own modes, R Rᵀ
    real(wp), intent(in) :: turns(:)     !! (drives) of own modes under the loads
    real(wp) :: held(size(yields, 1))

    real(wp) :: matrix(size(yields, 1) + size(moves, 2), size(yields, 1) + size(moves, 2))
    real(wp) :: right(size(matrix, 1)), solution(size(matrix, 1))
    type(dense_factor_t) :: factor
    integer :: d, n

    d = size(yields, 1)
    n = size(yields, 2)
    matrix = 0.0_wp
    matrix(:d, :d) = matmul(yields, transpose(yields)) + compliance
    matrix(:d, d + 1:) = moves
    matrix(d + 1:, :d) = transpose(moves)
    right(:d) = -matmul(yields, work(:n)) - turns
    right(d + 1:) = -work(n + 1:)
    held = 0.0_wp
    call factorize(matrix, factor)
    if (.not. abs(factor%determinant) > 0.0_wp) return
    solution = solve(factor, right)
    held = solution(:d)
  end function held_by_drives

end module part_forces
