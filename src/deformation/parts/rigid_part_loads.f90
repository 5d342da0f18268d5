!> What acts on a rigid link of a vibrating linkage: inertia, forces at its points and at places,
!! blocks that slide along it with their drives, springs.
module rigid_part_loads
  use elastic_linkages, only: spring_t
  use elastic_positions, only: elastic_position_t
  use elastic_terminals, only: elastic_terminal_t
  use inertia_loads, only: distributed_load, load_t
  use kinds, only: wp
  use linkages, only: cross, normal_to, turned
  use load_cases, only: constant_case, load_case_t
  use part_force_types, only: loaded_parts_t, part_forces_t
  use terminal_work, only: line_direction, terminal_arm, way_between
  implicit none (type, external)
  private

  public :: load_on_rigid, turning_load, turning_joints

  !> A force on a link.
  type :: placed_force_t
    real(wp) :: force(2) = 0.0_wp !! [N]
    real(wp) :: arm(2) = 0.0_wp   !! where it acts, from the first point of the link [m]
  end type placed_force_t

contains

  !> The resultant of all but the forces at its pins, and the couples of turns, of drives and of
  !! springs that turn.
  pure function load_on_rigid(at, loaded, case, part) result(load)
    type(elastic_position_t), intent(in) :: at
    type(loaded_parts_t), intent(in) :: loaded     !! its loads and forces
    integer, intent(in) :: case                    !! number of the load case
    integer, intent(in) :: part                    !! number of the rigid part
    type(load_t) :: load                           !! about its first pin [N, N m]

    type(placed_force_t), allocatable :: others(:)
    real(wp) :: change(size(at%elastic%springs))
    integer :: i

    associate (of_case => loaded%loads%unit%of_case(case))
      load = distributed_load(at%elastic%linkage%bodies(part), part, at%pose, of_case%field)
      load%moment = load%moment + of_case%couple(part)
      if (allocated(of_case%body_force)) load%force = load%force + of_case%body_force(:, part)
    end associate
    ! Pulls at the pose are among the forces at places; the linkage yields to the loads.
    change = loaded%forces%spring(:, case)
    if (case == constant_case) change = change - loaded%loads%pull
    others = forces_of_others(at, loaded%forces, case, at%elastic%springs, change, part)
    do i = 1, size(others)
      load%force = load%force + others(i)%force
      load%moment = load%moment + cross(others(i)%arm, others(i)%force)
    end do
  end function load_on_rigid

  !> `Σ F·r` of a rigid link, r from its first point: forces at its points, of blocks and springs
  !! on it, and its loads [N m].
  pure function turning_load(at, loaded, case, springs, pull, part) result(total)
    type(elastic_position_t), intent(in) :: at
    type(loaded_parts_t), intent(in) :: loaded     !! its loads and forces, but axial ones
    integer, intent(in) :: case                    !! number of the load case
    type(spring_t), intent(in) :: springs(:)       !! all that pull
    real(wp), intent(in) :: pull(:)                !! (springs) [N] or [N m]
    integer, intent(in) :: part                    !! number of the rigid part
    real(wp) :: total

    integer :: i

    associate (body => at%elastic%linkage%bodies(part), of_case => loaded%loads%unit%of_case(case))
      total = turning_joints(at, loaded%forces, case, springs, pull, part) - &
        inertia_turning(at, of_case, part)
      if (.not. (allocated(body%forced) .and. allocated(of_case%place_force))) return
      do i = 1, size(body%forced)
        total = total + dot_product(of_case%place_force(:, body%forced(i)%load), &
          turned(body%forced(i)%place, at%pose%direction(:, part)))
      end do
    end associate
  end function turning_load

  !> The same of forces at its points, of blocks and springs on it.
  pure function turning_joints(at, forces, case, springs, pull, part) result(total)
    type(elastic_position_t), intent(in) :: at
    type(part_forces_t), intent(in) :: forces      !! in constraints, of guides and drives
    integer, intent(in) :: case                    !! number of the load case
    type(spring_t), intent(in) :: springs(:)       !! all that pull
    real(wp), intent(in) :: pull(:)                !! (springs) [N] or [N m]
    integer, intent(in) :: part                    !! number of the rigid part
    real(wp) :: total

    type(placed_force_t), allocatable :: others(:)
    real(wp) :: arm(2)
    integer :: i, k, row

    associate (body => at%elastic%linkage%bodies(part), e => at%pose%direction(:, part))
      total = 0.0_wp
      do k = 0, size(body%further)
        arm = e*body%length
        if (k > 0) arm = turned(body%further(k)%place, e)
        row = at%numbers%body_constraint(part) + 2*k
        total = total + dot_product(forces%constraint(row + 1:row + 2, case), arm)
      end do
    end associate
    others = forces_of_others(at, forces, case, springs, pull, part)
    do i = 1, size(others)
      total = total + dot_product(others(i)%force, others(i)%arm)
    end do
  end function turning_joints

  !> Forces on a rigid link of blocks that slide along it, and of springs at its places.
  pure function forces_of_others(at, forces, case, springs, tension, part) result(others)
    type(elastic_position_t), intent(in) :: at
    type(part_forces_t), intent(in) :: forces
    integer, intent(in) :: case
    type(spring_t), intent(in) :: springs(:)
    real(wp), intent(in) :: tension(:) !! (springs) of those along a line [N]
    integer, intent(in) :: part
    type(placed_force_t), allocatable :: others(:)

    type(placed_force_t) :: room(size(at%elastic%linkage%sliders) + 2*size(springs))
    real(wp) :: way(2)
    integer :: i, n

    n = 0
    do i = 1, size(at%elastic%sliding, 2)
      call put_between(at, at%elastic%sliding(:, i), force_on_block(at, forces, case, i), part, &
        room, n)
    end do
    do i = 1, size(springs)
      if (springs(i)%turns) cycle
      associate (ends => at%elastic%load_ends(:, springs(i)%load))
        way = way_between(at%pose, ends)
        if (norm2(way) > 0.0_wp) way = way/norm2(way)
        call put_between(at, ends, -tension(i)*way, part, room, n)
      end associate
    end do
    others = room(:n)
  end function forces_of_others

  !> Adds a force on the second of two terminals, and the opposite on the first, if they are on a
  !! rigid link.
  pure subroutine put_between(at, ends, force, part, others, n)
    type(elastic_position_t), intent(in) :: at
    type(elastic_terminal_t), intent(in) :: ends(2)
    real(wp), intent(in) :: force(2)               !! [N]
    integer, intent(in) :: part                    !! number of the rigid link
    type(placed_force_t), intent(inout) :: others(:)
    integer, intent(inout) :: n                    !! how many there are

    integer :: k

    do k = 1, 2
      if (.not. ends(k)%is_rigid .or. ends(k)%part /= part) cycle
      n = n + 1
      others(n)%force = merge(-force, force, k == 1)
      others(n)%arm = terminal_arm(at%pose, ends(k))
    end do
  end subroutine put_between

  !> Force of a guide on its block, with that of a drive that moves the block [N].
  pure function force_on_block(at, forces, case, slider) result(force)
    type(elastic_position_t), intent(in) :: at
    type(part_forces_t), intent(in) :: forces
    integer, intent(in) :: case, slider
    real(wp) :: force(2)

    real(wp) :: direction(2)
    integer :: i, row

    direction = line_direction(at%elastic, at%pose, slider)
    force = forces%guide(slider, case)*normal_to(direction)
    do i = 1, size(at%elastic%linkage%drives)
      if (at%elastic%linkage%drives(i)%slider /= slider) cycle
      force = force + forces%drive(i, case)*direction
      row = at%numbers%drive_constraint(i)
      if (row > 0) force = force - forces%constraint(row, case)*direction
    end do
  end function force_on_block

  !> `∫ a·r dm` of a rigid link. The rotary inertia of cross-sections does not count.
  pure function inertia_turning(at, case, part) result(total)
    type(elastic_position_t), intent(in) :: at
    type(load_case_t), intent(in) :: case
    integer, intent(in) :: part
    real(wp) :: total

    real(wp) :: mass
    integer :: i

    associate (body => at%elastic%linkage%bodies(part), e => at%pose%direction(:, part), first => &
        case%field%at_first(:, part), slope => case%field%slope(:, part))
      mass = body%line_density*body%length
      total = mass*body%length*(0.5_wp*dot_product(e, first) + body%length/3.0_wp*dot_product(e, &
        slope))
      do i = 1, size(body%lumps)
        associate (lump => body%lumps(i))
          total = total + lump%mass*dot_product(turned(lump%place, e), first) + &
            (lump%mass*dot_product(lump%place, lump%place) + (lump%inertia - &
            lump%rotary_inertia))*dot_product(e, slope)
        end associate
      end do
    end associate
  end function inertia_turning

end module rigid_part_loads
