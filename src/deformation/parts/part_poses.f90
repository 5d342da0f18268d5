! src/deformation/parts/ - links cut in straight parts at a position: places, loads and forces.
! In: an `elastic_position_t`, pose and unit loads of the linkage. Out: `chords_t`, and loads and
! forces, a `loaded_parts_t`. Begin with `place_parts_of` here; then `find_part_chords` in
! `part_displacements.f90`, `find_part_loads` here, `find_part_forces` in `part_forces.f90`. Forces
! in joints that statics cannot tell apart: `take_part_reactions` in `part_reactions.f90`.
! Not here: the division into parts (`src/beam`), rows of the border (`src/deformation/pins`).

!> Pose and loads of the parts of a vibrating linkage, from those of the linkage that moves.
module part_poses
  use acceleration_fields, only: acceleration_field_t, point_acceleration
  use applied_load_types, only: is_torsional
  use applied_loads, only: evaluate_loads, standing_pulls
  use coordinates, only: evaluated_t
  use carried_bodies, only: add_short_pieces, carried_loads
  use elastic_linkages, only: add_couple, elastic_linkage_t, spring_t
  use elastic_positions, only: elastic_position_t
  use errors, only: error_t
  use kinds, only: wp
  use linkages, only: cross, drive_of_length, linkage_t, normal_to, turned, turned_back
  use load_cases, only: case_count, constant_case, load_case_t, unit_loads_t
  use part_force_types, only: part_loads_t
  use piece_places, only: place_pieces
  use poses, only: arm_to_place, pose_t
  implicit none (type, external)
  private

  public :: place_parts_of, find_part_loads, highest_force

contains

  !> Places points and parts. Lengths of parts that change with the position are set.
  !!
  !! Errors: a block is at an end of the straight part that it slides along, or beyond.
  pure subroutine place_parts_of(linkage, pose, elastic, placed, error)
    type(linkage_t), intent(in) :: linkage              !! that moves
    type(pose_t), intent(in) :: pose                    !! of it
    type(elastic_linkage_t), intent(inout) :: elastic   !! of this linkage
    type(pose_t), intent(inout) :: placed               !! of its points and parts
    type(error_t), allocatable, intent(out) :: error    !! its place has link and pin

    real(wp) :: way(2)
    integer :: i, k, n

    if (.not. allocated(placed%pin)) allocate (placed%pin(2, size(elastic%is_fixed)), &
      placed%direction(2, size(elastic%body)))
    placed%crank = pose%crank
    placed%sine = pose%sine
    placed%pin(:, :size(pose%pin, 2)) = pose%pin
    do k = 1, size(elastic%body)
      placed%direction(:, k) = turned(elastic%axis(:, k), pose%direction(:, elastic%body(k)))
    end do
    do i = 1, size(elastic%ways)
      if (size(elastic%ways(i)%cuts) == 0) cycle
      call place_pieces(linkage, pose, i, elastic, placed, error)
      if (allocated(error)) return
    end do
    do i = 1, size(linkage%drives)
      if (linkage%drives(i)%kind /= drive_of_length) cycle
      n = findloc(elastic%body, linkage%drives(i)%body, dim=1)
      associate (part => elastic%linkage%bodies(n))
        way = pose%pin(:, part%last_pin) - pose%pin(:, part%first_pin)
        part%length = norm2(way)
      end associate
    end do
  end subroutine place_parts_of

  !> The loads of the parts.
  pure subroutine find_part_loads(linkage, pose, loads, at, of_parts)
    type(linkage_t), intent(in) :: linkage           !! that moves
    type(pose_t), intent(in) :: pose                 !! of it
    type(unit_loads_t), intent(in) :: loads          !! of this pose
    type(elastic_position_t), intent(in) :: at       !! of it
    type(part_loads_t), intent(out) :: of_parts

    type(evaluated_t), allocatable :: along(:)
    integer :: i

    allocate (of_parts%moment(at%elastic%rotations, case_count), of_parts%end_couple(2, &
      size(at%elastic%body), case_count), source=0.0_wp)
    allocate (of_parts%pull(size(at%elastic%springs)), &
      of_parts%tension(size(at%elastic%tensions)), source=0.0_wp)
    of_parts%unit%occurs = loads%occurs
    do i = 1, case_count
      if (.not. loads%occurs(i)) cycle
      associate (of_links => loads%of_case(i), parts => of_parts%unit%of_case(i))
        call take_field(linkage, pose, of_links%field, at%elastic, at%pose, parts%field)
        allocate (parts%pin_force(2, size(at%elastic%is_fixed)), &
          parts%couple(size(at%elastic%body)))
        parts%pin_force = 0.0_wp
        parts%pin_force(:, :size(of_links%pin_force, 2)) = of_links%pin_force
        parts%couple = 0.0_wp
        if (allocated(of_links%place_force) .or. highest_force(at%elastic) > size(linkage%loads)) &
          then
          allocate (parts%place_force(2, highest_force(at%elastic)), source=0.0_wp)
          allocate (parts%body_force(2, size(at%elastic%body)), source=0.0_wp)
        end if
        if (allocated(of_links%place_force)) parts%place_force(:, :size(linkage%loads)) = &
          of_links%place_force
      end associate
    end do
    if (loads%occurs(constant_case)) then
      call evaluate_loads(linkage, pose, along)
      associate (pull => standing_pulls(linkage, along))
        of_parts%pull = pull(at%elastic%springs%load)
        of_parts%tension = pull(at%elastic%tensions%load)
      end associate
    end if
    do i = 1, case_count
      if (loads%occurs(i)) call take_couples(linkage, pose, loads%of_case(i), at%elastic, at%pose, &
        [at%elastic%springs, at%elastic%tensions], merge(1.0_wp, 0.0_wp, i == constant_case)* &
        [of_parts%pull, of_parts%tension], of_parts%unit%of_case(i))
    end do
    allocate (of_parts%carried(4, size(at%elastic%carried), case_count), source=0.0_wp)
    do i = 1, case_count
      if (.not. loads%occurs(i)) cycle
      of_parts%carried(:, :, i) = carried_loads(at%elastic, at%pose, of_parts%unit%of_case(i))
      call add_short_pieces(at%elastic, of_parts%unit%of_case(i), of_parts%moment(:, i))
    end do
    call turn_ends(at%elastic, at%elastic%springs, of_parts%pull, of_parts%moment(:, constant_case))
    call turn_ends(at%elastic, at%elastic%tensions, of_parts%tension, of_parts%moment(:, &
      constant_case))
  end subroutine find_part_loads

  !> The highest number of a force at a place of a part, or of a load of the linkage.
  pure function highest_force(elastic) result(number)
    type(elastic_linkage_t), intent(in) :: elastic !! parts with places where forces act
    integer :: number

    integer :: i, k

    number = size(elastic%linkage%loads)
    do k = 1, size(elastic%body)
      if (.not. allocated(elastic%linkage%bodies(k)%forced)) cycle
      do i = 1, size(elastic%linkage%bodies(k)%forced)
        number = max(number, elastic%linkage%bodies(k)%forced(i)%load)
      end do
    end do
  end function highest_force

  !> Adds what springs that turn do to the ends that they hold.
  pure subroutine turn_ends(elastic, springs, pull, moment)
    type(elastic_linkage_t), intent(in) :: elastic
    type(spring_t), intent(in) :: springs(:)
    real(wp), intent(in) :: pull(:)      !! (springs) [N] or [N m]
    real(wp), intent(inout) :: moment(:) !! (rotations)

    integer :: i, k

    do i = 1, size(springs)
      if (.not. springs(i)%turns) cycle
      do k = 1, 2
        associate (rotation => elastic%load_ends(k, springs(i)%load)%rotation)
          if (rotation > 0) moment(rotation) = moment(rotation) + merge(pull(i), -pull(i), k == 1)
        end associate
      end do
    end do
  end subroutine turn_ends

  !> Accelerations of points and parts.
  pure subroutine take_field(linkage, pose, of_links, elastic, placed, field)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(acceleration_field_t), intent(in) :: of_links
    type(elastic_linkage_t), intent(in) :: elastic
    type(pose_t), intent(in) :: placed
    type(acceleration_field_t), intent(out) :: field

    real(wp) :: place(2)
    integer :: b, i, k

    allocate (field%at_pin(2, size(elastic%is_fixed)), field%at_first(2, size(elastic%body)), &
      field%slope(2, size(elastic%body)), field%angular(size(elastic%body)))
    field%at_pin(:, :size(of_links%at_pin, 2)) = of_links%at_pin
    do k = 1, size(elastic%ways)
      do i = 1, size(elastic%ways(k)%cuts)
        associate (b => elastic%ways(k)%body, point => elastic%ways(k)%cuts(i)%point)
          if (point <= size(of_links%at_pin, 2)) cycle
          place = turned_back(placed%pin(:, point) - pose%pin(:, linkage%bodies(b)%first_pin), &
            pose%direction(:, b))
          field%at_pin(:, point) = point_acceleration(of_links, b, place(1), place(2))
        end associate
      end do
    end do
    do k = 1, size(elastic%body)
      b = elastic%body(k)
      field%at_first(:, k) = point_acceleration(of_links, b, elastic%place(1, k), &
        elastic%place(2, k))
      field%slope(:, k) = elastic%axis(1, k)*of_links%slope(:, b) + elastic%axis(2, &
        k)*normal_to(of_links%slope(:, b))
      field%angular(k) = of_links%angular(b)
    end do
  end subroutine take_field

  !> Couples and forces of links: of a rigid link as they are; of one that bends its couples spread
  !! over its length, forces at places with their moments where they are, springs on its ends.
  pure subroutine take_couples(linkage, pose, of_links, elastic, placed, springs, pull, parts)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(load_case_t), intent(in) :: of_links
    type(elastic_linkage_t), intent(in) :: elastic
    type(pose_t), intent(in) :: placed
    type(spring_t), intent(in) :: springs(:) !! and tensions
    real(wp), intent(in) :: pull(:) !! (springs) in this case
    type(load_case_t), intent(inout) :: parts

    real(wp) :: couple(size(linkage%bodies)), arm(2)
    integer :: b, i, k

    couple = of_links%couple
    do i = 1, size(pull)
      associate (load => linkage%loads(springs(i)%load))
        if (.not. is_torsional(load)) cycle
        do k = 1, 2
          b = load%along%at(k)%body
          if (b > 0) couple(b) = couple(b) - merge(1.0_wp, -1.0_wp, k == 1)*pull(i)
        end do
      end associate
    end do
    do b = 1, size(couple)
      if (linkage%bodies(b)%bends .and. allocated(of_links%place_force) .and. &
        allocated(linkage%bodies(b)%forced)) then
        do i = 1, size(linkage%bodies(b)%forced)
          arm = arm_to_place(pose, b, linkage%bodies(b)%forced(i)%place)
          couple(b) = couple(b) - cross(arm, of_links%place_force(:, &
            linkage%bodies(b)%forced(i)%load))
        end do
      end if
      call add_couple(elastic, b, couple(b), parts%couple)
    end do
    if (.not. allocated(of_links%place_force)) return
    do k = 1, size(elastic%body)
      associate (part => elastic%linkage%bodies(k))
        if (.not. part%bends) then
          parts%body_force(:, k) = of_links%body_force(:, elastic%body(k))
          cycle
        end if
        if (.not. allocated(part%forced)) cycle
        do i = 1, size(part%forced)
          arm = arm_to_place(placed, k, part%forced(i)%place)
          associate (force => parts%place_force(:, part%forced(i)%load))
            parts%couple(k) = parts%couple(k) + cross(arm, force)
            parts%body_force(:, k) = parts%body_force(:, k) + force
          end associate
        end do
      end associate
    end do
  end subroutine take_couples

end module part_poses
