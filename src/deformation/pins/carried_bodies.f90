!> What is fixed to cross-sections where ways are cut: masses, forces at places, blocks that turn
!! with their guides.
!!
!! With the displacement U of the point, the rotation θ of the cross-section and the arm r of a mass
!! centre from there, `½ m |U̇ + θ̇ J r|² + ½ I θ̇²`. Forces F at the end of the arm do the work
!! `F·U + (r × F) θ`, and `−½ θ² F·r` of the second order; the centrifugal forces of the own parts
!! of a mass, which turn with it, `−½ θ² I ω²`.
module carried_bodies
  use acceleration_fields, only: point_acceleration
  use elastic_linkages, only: elastic_linkage_t
  use kinds, only: wp
  use linkages, only: cross, normal_to, turned
  use load_cases, only: load_case_t
  use pin_displacements, only: chords_t
  use poses, only: pose_t
  implicit none (type, external)
  private

  public :: carried_loads, carried_force, carried_work, carried_motion, add_carried_mass, &
    add_carried_stiffness, add_short_pieces

contains

  !> Inertia loads, weights and forces of a load case.
  pure function carried_loads(elastic, pose, case) result(load)
    type(elastic_linkage_t), intent(in) :: elastic !! at this position
    type(pose_t), intent(in) :: pose               !! of points and parts
    type(load_case_t), intent(in) :: case          !! of the parts
    real(wp) :: load(4, size(elastic%carried))     !! (force x and y, moment about the point,
                                                   !! Σ F·r + I ω²; carried bodies) [N, N m]

    real(wp) :: force(2), arm(2)
    integer :: i, part

    do i = 1, size(elastic%carried)
      associate (this => elastic%carried(i))
        part = elastic%ways(this%way)%first_part
        force = -this%mass*point_acceleration(case%field, part, this%place(1), this%place(2))
        if (this%load > 0 .and. allocated(case%place_force)) force = force + &
          case%place_force(:, this%load)
        arm = turned(this%arm, pose%direction(:, part))
        load(:3, i) = carried_force(elastic, pose, i, force)
        load(3, i) = load(3, i) - this%inertia*case%field%angular(part)
        load(4, i) = dot_product(arm, force) - this%inertia*dot_product(pose%direction(:, part), &
          case%field%slope(:, part))
      end associate
    end do
  end function carried_loads

  !> A force at its place, at the point of its cut.
  pure function carried_force(elastic, pose, number, force) result(load)
    type(elastic_linkage_t), intent(in) :: elastic !! at this position
    type(pose_t), intent(in) :: pose               !! of points and parts
    integer, intent(in) :: number                  !! of the carried body
    real(wp), intent(in) :: force(2)               !! [N]
    real(wp) :: load(3)                            !! force x and y, moment about the point [N, N m]

    associate (this => elastic%carried(number))
      load = [force, cross(turned(this%arm, pose%direction(:, &
        elastic%ways(this%way)%first_part)), force)]
    end associate
  end function carried_force

  !> Work of such loads on some displacements.
  pure function carried_work(elastic, chords, load) result(work)
    type(elastic_linkage_t), intent(in) :: elastic !! at this position
    type(chords_t), intent(in) :: chords           !! what the displacements do to points
    real(wp), intent(in) :: load(:, :)             !! (4, carried bodies) as of `carried_loads`
    real(wp) :: work(size(chords%turn, 1))         !! (displacements)

    integer :: i

    work = 0.0_wp
    do i = 1, size(elastic%carried)
      associate (this => elastic%carried(i))
        work = work + matmul(load(:2, i), chords%pin(:, this%point, :))
        if (this%rotation > 0) work = work + load(3, i)*chords%rotation(this%rotation, :)
      end associate
    end do
  end function carried_work

  !> Motion of one in fixed axes: of its mass centre, and the rotation of the cross-section at a
  !! unit arm along the way.
  pure function carried_motion(elastic, pose, chords, number) result(motion)
    type(elastic_linkage_t), intent(in) :: elastic  !! at this position
    type(pose_t), intent(in) :: pose                !! of points and parts
    type(chords_t), intent(in) :: chords            !! what displacements do to points
    integer, intent(in) :: number                   !! of the carried body
    real(wp) :: motion(2, 2, size(chords%turn, 1))  !! (x and y, of centre and arm, displacements)

    real(wp) :: along(2), across(2)

    associate (this => elastic%carried(number))
      along = pose%direction(:, elastic%ways(this%way)%first_part)
      across = normal_to(turned(this%arm, along))
      motion(:, 1, :) = chords%pin(:, this%point, :)
      motion(:, 2, :) = 0.0_wp
      if (this%rotation <= 0) return
      associate (turn => chords%rotation(this%rotation, :))
        motion(:, 1, :) = motion(:, 1, :) + spread(across, 2, size(turn))*spread(turn, 1, 2)
        motion(:, 2, :) = spread(normal_to(along), 2, size(turn))*spread(turn, 1, 2)
      end associate
    end associate
  end function carried_motion

  !> Adds what they do to the mass matrix between some displacements, with the cross-sections of
  !! short pieces.
  pure subroutine add_carried_mass(elastic, pose, chords, mass)
    type(elastic_linkage_t), intent(in) :: elastic !! at this position
    type(pose_t), intent(in) :: pose               !! of points and parts
    type(chords_t), intent(in) :: chords           !! what the displacements do to points
    real(wp), intent(inout) :: mass(:, :)          !! (displacements, displacements)

    real(wp) :: moved(2, 2, size(mass, 1))
    integer :: i, j

    do i = 1, size(elastic%carried)
      associate (this => elastic%carried(i))
        if (this%mass > 0.0_wp) then
          moved = carried_motion(elastic, pose, chords, i)
          do j = 1, size(mass, 2)
            mass(:, j) = mass(:, j) + this%mass*(moved(1, 1, :)*moved(1, 1, j) + moved(2, 1, &
              :)*moved(2, 1, j))
          end do
        end if
        if (this%rotation > 0) call add_inertia(this%inertia, chords%rotation(this%rotation, :), &
          mass)
      end associate
    end do
    do i = 1, size(elastic%ways)
      do j = 1, size(elastic%ways(i)%cuts)
        associate (cut => elastic%ways(i)%cuts(j))
          if (cut%rotation > 0) call add_inertia(cut%inertia, chords%rotation(cut%rotation, :), &
            mass)
        end associate
      end do
    end do
  end subroutine add_carried_mass

  !> Adds `I θ²`.
  pure subroutine add_inertia(inertia, turn, mass)
    real(wp), intent(in) :: inertia, turn(:)
    real(wp), intent(inout) :: mass(:, :)

    integer :: j

    if (.not. inertia > 0.0_wp) return
    do j = 1, size(turn)
      mass(:, j) = mass(:, j) + inertia*turn*turn(j)
    end do
  end subroutine add_inertia

  !> Adds what turns the cross-sections of short pieces with the cuts beside them: `−I α`.
  pure subroutine add_short_pieces(elastic, case, moment)
    type(elastic_linkage_t), intent(in) :: elastic !! at this position
    type(load_case_t), intent(in) :: case          !! of the parts
    real(wp), intent(inout) :: moment(:)           !! (rotations) [N m]

    integer :: i, k

    do i = 1, size(elastic%ways)
      associate (way => elastic%ways(i))
        do k = 1, size(way%cuts)
          if (way%cuts(k)%rotation > 0) moment(way%cuts(k)%rotation) = &
            moment(way%cuts(k)%rotation) - way%cuts(k)%inertia*case%field%angular(way%first_part)
        end do
      end associate
    end do
  end subroutine add_short_pieces

  !> Adds what their loads do of the second order as cross-sections turn.
  pure subroutine add_carried_stiffness(elastic, chords, load, stiffness)
    type(elastic_linkage_t), intent(in) :: elastic !! at this position
    type(chords_t), intent(in) :: chords           !! what the displacements do to rotations
    real(wp), intent(in) :: load(:, :)             !! (4, carried bodies) as of `carried_loads`
    real(wp), intent(inout) :: stiffness(:, :)     !! (displacements, displacements)

    real(wp) :: turn(size(stiffness, 1))
    integer :: i, j

    do i = 1, size(elastic%carried)
      associate (this => elastic%carried(i))
        if (this%rotation <= 0 .or. .not. abs(load(4, i)) > 0.0_wp) cycle
        turn = chords%rotation(this%rotation, :)
        do j = 1, size(turn)
          stiffness(:, j) = stiffness(:, j) + load(4, i)*turn*turn(j)
        end do
      end associate
    end do
  end subroutine add_carried_stiffness

end module carried_bodies
