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
  use elastic_linkages, only: elastic_linkage_t, fixed_rotation, spring_t
  use elastic_positions, only: elastic_position_t
  use graded_rows, only: graded_rows_t
  use kinds, only: wp
  use link_modes, only: link_modes_t
  use linkages, only: body_t, normal_to, turned
  use poses, only: pose_t
  implicit none (type, external)
  private

  public :: find_border_rows, damper_rows, line_direction, spring_way, add_stretch, add_spring, &
    add_line, add_rigid, part_rows

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
      if (at%numbers%line_constraint(i) > 0) call add_line(at, i, &
        normal_to(line_direction(at%elastic, at%pose, i)), rows%constraint(:, &
        at%numbers%line_constraint(i)))
    end do
    do i = 1, size(at%numbers%drive_constraint)
      if (at%numbers%drive_constraint(i) > 0) call add_line(at, &
        at%elastic%linkage%drives(i)%slider, line_direction(at%elastic, at%pose, &
        at%elastic%linkage%drives(i)%slider), rows%constraint(:, at%numbers%drive_constraint(i)))
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

  !> Adds `a·U` of a point.
  pure subroutine add_point(numbers, point, a, row)
    type(border_unknowns_t), intent(in) :: numbers
    integer, intent(in) :: point
    real(wp), intent(in) :: a(2)
    real(wp), intent(inout) :: row(:)

    integer :: first

    first = numbers%point(point)
    if (first > 0) row(first:first + 1) = row(first:first + 1) + a
  end subroutine add_point

  !> Adds a rotation, times a factor.
  pure subroutine add_rotation(numbers, rotation, factor, row)
    type(border_unknowns_t), intent(in) :: numbers
    integer, intent(in) :: rotation !! number, or `fixed_rotation`
    real(wp), intent(in) :: factor
    real(wp), intent(inout) :: row(:)

    if (rotation == fixed_rotation .or. rotation == 0) return
    associate (entry => row(numbers%rotation(rotation)))
      entry = entry + factor/numbers%size_of
    end associate
  end subroutine add_rotation

  !> Adds `U_k − U_0 − θ J r_k = 0` for all pins of a rigid link beyond the first.
  pure subroutine add_rigid(at, part, constraint)
    type(elastic_position_t), intent(in) :: at
    integer, intent(in) :: part                     !! number of the link
    real(wp), intent(inout) :: constraint(:, :)     !! (unknowns, two of each pin)

    real(wp) :: arm(2), unit(2)
    integer :: i, k, pin, row

    associate (body => at%elastic%linkage%bodies(part))
      do k = 0, size(body%further)
        pin = body%last_pin
        if (k > 0) pin = body%further(k)%pin
        arm = at%pose%direction(:, part)*body%length
        if (k > 0) arm = turned(body%further(k)%place, at%pose%direction(:, part))
        do i = 1, 2
          row = 2*k + i
          unit = 0.0_wp
          unit(i) = 1.0_wp
          call add_point(at%numbers, pin, unit, constraint(:, row))
          call add_point(at%numbers, body%first_pin, -unit, constraint(:, row))
          call add_rotation(at%numbers, at%elastic%rotation(1, part), -dot_product(unit, &
            normal_to(arm)), constraint(:, row))
        end do
      end do
    end associate
  end subroutine add_rigid

  !> Adds `a·(U_P − U_Q)` of a block at P on the point Q of its guide.
  pure subroutine add_line(at, slider, a, row)
    type(elastic_position_t), intent(in) :: at
    integer, intent(in) :: slider                   !! number
    real(wp), intent(in) :: a(2)                    !! a direction
    real(wp), intent(inout) :: row(:)               !! (unknowns)

    integer :: part

    associate (line => at%elastic%linkage%sliders(slider))
      call add_point(at%numbers, line%pin, a, row)
      if (at%elastic%contact(slider) > 0) then
        call add_point(at%numbers, at%elastic%contact(slider), -a, row)
      else if (line%body > 0) then
        part = findloc(at%elastic%body, line%body, dim=1)
        associate (first => at%elastic%linkage%bodies(part)%first_pin)
          call add_point(at%numbers, first, -a, row)
          call add_rotation(at%numbers, at%elastic%rotation(1, part), -dot_product(a, &
            normal_to(at%pose%pin(:, line%pin) - at%pose%pin(:, first))), row)
        end associate
      end if
    end associate
  end subroutine add_line

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

    if (spring%turns) then
      call add_rotation(at%numbers, spring%rotation(2), 1.0_wp, row)
      call add_rotation(at%numbers, spring%rotation(1), -1.0_wp, row)
      return
    end if
    way = spring_way(at%elastic, at%pose, spring)
    if (norm2(way) > 0.0_wp) way = way/norm2(way)
    call add_stretch(at, spring, way, row)
  end subroutine add_spring

  !> The way between the ends of a spring along a line [m].
  pure function spring_way(elastic, pose, spring) result(way)
    type(elastic_linkage_t), intent(in) :: elastic !! its parts
    type(pose_t), intent(in) :: pose               !! of points and parts
    type(spring_t), intent(in) :: spring           !! or a damper
    real(wp) :: way(2)                             !! from its first end to its second

    way = end_place(elastic, pose, spring, 2) - end_place(elastic, pose, spring, 1)
  end function spring_way

  !> Where an end of a spring is [m].
  pure function end_place(elastic, pose, spring, k) result(place)
    type(elastic_linkage_t), intent(in) :: elastic
    type(pose_t), intent(in) :: pose
    type(spring_t), intent(in) :: spring
    integer, intent(in) :: k
    real(wp) :: place(2)

    integer :: part

    associate (at => elastic%linkage%loads(spring%load)%along%at(k))
      if (at%pin > 0) then
        place = pose%pin(:, at%pin) + at%place
      else
        part = findloc(elastic%body, at%body, dim=1)
        place = pose%pin(:, elastic%linkage%bodies(part)%first_pin) + turned(at%place, &
          pose%direction(:, part))
      end if
    end associate
  end function end_place

  !> Adds `a·(U_2 − U_1)` of the ends of a spring.
  pure subroutine add_stretch(at, spring, a, row)
    type(elastic_position_t), intent(in) :: at
    type(spring_t), intent(in) :: spring            !! or a damper
    real(wp), intent(in) :: a(2)                    !! a direction
    real(wp), intent(inout) :: row(:)               !! (unknowns)

    integer :: k, part
    real(wp) :: sense

    do k = 1, 2
      sense = merge(-1.0_wp, 1.0_wp, k == 1)
      associate (held => at%elastic%linkage%loads(spring%load)%along%at(k))
        if (held%pin > 0) then
          call add_point(at%numbers, held%pin, sense*a, row)
        else
          ! A place that is no pin is one of a rigid link.
          part = findloc(at%elastic%body, held%body, dim=1)
          call add_point(at%numbers, at%elastic%linkage%bodies(part)%first_pin, sense*a, row)
          call add_rotation(at%numbers, at%elastic%rotation(1, part), sense*dot_product(a, &
            normal_to(turned(held%place, at%pose%direction(:, part)))), row)
        end if
      end associate
    end do
  end subroutine add_stretch

  !> Direction of the line of a slider.
  pure function line_direction(elastic, pose, slider) result(direction)
    type(elastic_linkage_t), intent(in) :: elastic !! parts
    type(pose_t), intent(in) :: pose               !! of points and parts
    integer, intent(in) :: slider                  !! number
    real(wp) :: direction(2)                       !! unit vector

    integer :: part

    associate (line => elastic%linkage%sliders(slider))
      direction = line%direction
      if (line%body == 0) return
      part = findloc(elastic%body, line%body, dim=1)
      associate (axis => elastic%axis(:, part))
        direction = turned(direction, turned([axis(1), -axis(2)], pose%direction(:, part)))
      end associate
    end associate
  end function line_direction

end module border_rows
