!> Rows of the border: how the points and rotations of a linkage deform its parts and springs.
!!
!! Unknowns p: two displacements of every point that can move, then the rotations. A part between
!! the points i and j with the unit vector e, its normal n, and the rotation of its chord
!! `ψ = n·(U_j − U_i)/L` has the border deformations `e·(U_j − U_i)`, and at its held ends `θ − ψ`,
!! or `θ_i + θ_j − 2 ψ` and `θ_i − θ_j`; in units of those of a unit unknown they are the border's
!! share of y. A spring has `√k` times its stretch or turn. Constraints: points of a rigid link,
!! blocks on guides, a ram that is held.
module border_rows
  use border_unknowns, only: border_unknowns_t
  use elastic_linkages, only: spring_t
  use elastic_positions, only: elastic_position_t
  use graded_rows, only: graded_rows_t
  use kinds, only: wp
  use link_modes, only: link_modes_t
  use linkages, only: body_t, normal_to
  use terminal_work, only: add_between, add_point, add_rotation, line_direction, pins_of_rigid, &
    way_between
  implicit none (type, external)
  private

  public :: find_border_rows, damper_rows, add_spring, add_rigid, part_rows

contains

  !> The rows at a position.
  pure subroutine find_border_rows(at, rows)
    type(elastic_position_t), intent(in) :: at
    type(graded_rows_t), intent(inout) :: rows       !! storage is kept if it has the right size

    real(wp) :: normal(2)
    integer :: i, k

    if (allocated(rows%row)) then
      if (any(shape(rows%row) /= [at%numbers%unknowns, size(at%numbers%rows)])) &
        deallocate (rows%row, rows%constraint, rows%weight)
    end if
    if (.not. allocated(rows%row)) allocate (rows%row(at%numbers%unknowns, size(at%numbers%rows)), &
      rows%constraint(at%numbers%unknowns, at%numbers%constraints), &
      rows%weight(size(at%numbers%rows)))
    rows%row = 0.0_wp
    rows%constraint = 0.0_wp
    do k = 1, size(at%model%links)
      associate (part => at%elastic%linkage%bodies(k), axis => at%pose%direction(:, k))
        if (.not. part%bends) then
          i = at%numbers%body_constraint(k)
          call add_rigid(at, k, rows%constraint(:, i + 1:i + 2*(1 + size(part%further))))
          cycle
        end if
        i = at%numbers%elongation(k)
        call add_chord(at%numbers, part, axis, rows%row(:, i))
        rows%weight(i) = 1.0_wp/at%model%links(k)%elongation
        normal = normal_to(axis)/part%length
        do i = 1, at%model%links(k)%curves
          associate (row => rows%row(:, at%numbers%curve(i, k)))
            if (at%model%links(k)%curves == 2) then
              call add_rotation(at%numbers, at%elastic%rotation(1, k), 1.0_wp, row)
              call add_rotation(at%numbers, at%elastic%rotation(2, k), merge(1.0_wp, -1.0_wp, &
                i == 1), row)
              if (i == 1) call add_chord(at%numbers, part, -2.0_wp*normal, row)
            else
              call add_rotation(at%numbers, at%elastic%rotation(merge(1, 2, &
                at%model%links(k)%held(1)), k), 1.0_wp, row)
              call add_chord(at%numbers, part, -normal, row)
            end if
          end associate
          rows%weight(at%numbers%curve(i, k)) = 1.0_wp/at%model%links(k)%curve_rotation(i)
        end do
      end associate
    end do
    do i = 1, size(at%elastic%springs)
      call add_spring(at, at%elastic%springs(i), rows%row(:, at%numbers%spring(i)))
      rows%weight(at%numbers%spring(i)) = sqrt(at%elastic%springs(i)%stiffness)
    end do
    do i = 1, size(at%numbers%line_constraint)
      if (at%numbers%line_constraint(i) > 0) call add_between(at, at%elastic%sliding(:, i), &
        normal_to(line_direction(at%elastic, at%pose, i)), 0.0_wp, rows%constraint(:, &
        at%numbers%line_constraint(i)))
    end do
    do i = 1, size(at%numbers%drive_constraint)
      if (at%numbers%drive_constraint(i) > 0) call add_between(at, at%elastic%driven(:, i), &
        line_direction(at%elastic, at%pose, at%elastic%linkage%drives(i)%slider), 0.0_wp, &
        rows%constraint(:, at%numbers%drive_constraint(i)))
    end do
  end subroutine find_border_rows

  !> The weighted rows of a part that bends in its own displacements.
  pure function part_rows(link, length, axis) result(rows)
    type(link_modes_t), intent(in) :: link !! its ends
    real(wp), intent(in) :: length         !! [m]
    real(wp), intent(in) :: axis(2)        !! its direction
    real(wp) :: rows(6, 1 + link%curves)   !! (displacements of its first point, of its last,
                                           !! rotations of both ends; elongation, curves)

    real(wp) :: chord(4)
    integer :: i

    rows = 0.0_wp
    rows(:4, 1) = [-axis, axis]/link%elongation
    chord = [-normal_to(axis), normal_to(axis)]/length
    do i = 1, link%curves
      associate (row => rows(:, 1 + i))
        if (link%curves == 2) then
          row(5:6) = [1.0_wp, merge(1.0_wp, -1.0_wp, i == 1)]
          if (i == 1) row(:4) = -2.0_wp*chord
        else
          row(merge(5, 6, link%held(1))) = 1.0_wp
          row(:4) = -chord
        end if
        row = row/link%curve_rotation(i)
      end associate
    end do
  end function part_rows

  !> Adds `a·(U_j − U_i)` of a part.
  pure subroutine add_chord(numbers, part, a, row)
    type(border_unknowns_t), intent(in) :: numbers
    type(body_t), intent(in) :: part
    real(wp), intent(in) :: a(2)
    real(wp), intent(inout) :: row(:)

    call add_point(numbers, part%last_pin, a, row)
    call add_point(numbers, part%first_pin, -a, row)
  end subroutine add_chord

  !> Adds `U_k − U_0 − θ J r_k = 0` for all pins of a rigid link beyond the first.
  pure subroutine add_rigid(at, part, constraint)
    type(elastic_position_t), intent(in) :: at
    integer, intent(in) :: part                     !! number of the link
    real(wp), intent(inout) :: constraint(:, :)     !! (unknowns, two of each pin)

    real(wp) :: unit(2)
    integer :: i, k

    do k = 0, size(at%elastic%linkage%bodies(part)%further)
      do i = 1, 2
        unit = 0.0_wp
        unit(i) = 1.0_wp
        call add_between(at, pins_of_rigid(at%elastic, part, k), unit, 0.0_wp, constraint(:, 2*k + &
          i))
      end do
    end do
  end subroutine add_rigid

  !> What the dampers feel: stretch or turn.
  pure function damper_rows(at) result(rows)
    type(elastic_position_t), intent(in) :: at !! with dampers
    real(wp) :: rows(at%numbers%unknowns, size(at%elastic%dampers)) !! [-] or [1/m]

    integer :: i

    rows = 0.0_wp
    do i = 1, size(at%elastic%dampers)
      call add_spring(at, at%elastic%dampers(i), rows(:, i))
    end do
  end function damper_rows

  !> Adds the stretch or turn of a spring.
  pure subroutine add_spring(at, spring, row)
    type(elastic_position_t), intent(in) :: at
    type(spring_t), intent(in) :: spring            !! or a damper
    real(wp), intent(inout) :: row(:)               !! (unknowns)

    real(wp) :: way(2)

    associate (ends => at%elastic%load_ends(:, spring%load))
      if (spring%turns) then
        call add_between(at, ends, [0.0_wp, 0.0_wp], 1.0_wp, row)
        return
      end if
      way = way_between(at%pose, ends)
      if (norm2(way) > 0.0_wp) way = way/norm2(way)
      call add_between(at, ends, way, 0.0_wp, row)
    end associate
  end subroutine add_spring

end module border_rows
