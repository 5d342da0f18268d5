!> Rows of the border: how the points and rotations of a linkage deform its parts and springs.
!!
!! Unknowns p: two displacements of every point that can move, then the rotations. A part between
!! the points i and j with the unit vector e, its normal n, and the rotation of its chord
!! `ψ = n·(U_j − U_i)/L` has the border deformations `e·(U_j − U_i)`, and at its held ends `θ − ψ`,
!! or `θ_i + θ_j − 2 ψ` and `θ_i − θ_j`; in units of those of a unit unknown they are the border's
!! share of y. A spring has `√k` times its stretch or turn. Constraints: points of a rigid link,
!! blocks on guides, a ram that is held.
module border_rows
  use elastic_linkages, only: elastic_linkage_t, fixed_rotation, spring_t
  use graded_rows, only: graded_rows_t
  use kinds, only: wp
  use link_modes, only: link_modes_t
  use linkages, only: body_t, drive_of_slider, normal_to, turned
  use poses, only: pose_t
  implicit none (type, external)
  private

  public :: border_unknowns_t, border_row_t, new_border_unknowns, find_border_rows, &
    damper_rows, line_direction, spring_way, add_stretch, add_spring, add_line, add_rigid, part_rows
  public :: row_elongation, row_curve, row_spring

  !> What a row is.
  integer, parameter :: row_elongation = 1, row_curve = 2, row_spring = 3

  !> The meaning of a row of `graded_rows_t`.
  type :: border_row_t
    integer :: kind = 0   !! one of the row_… constants
    integer :: number = 0 !! of the part or spring
    integer :: curve = 0  !! number of the curve of a part
  end type border_row_t

  !> Numbers of unknowns, rows and constraints of a linkage, the same at every position.
  type :: border_unknowns_t
    integer :: unknowns = 0
    integer, allocatable :: point(:)         !! (points) number of the first of two; 0: fixed
    integer, allocatable :: rotation(:)      !! (rotations)
    type(border_row_t), allocatable :: rows(:)
    integer, allocatable :: elongation(:)    !! (parts) number of the row; 0: rigid
    integer, allocatable :: curve(:, :)      !! (2, parts) numbers of the rows; 0: none
    integer, allocatable :: spring(:)        !! (springs) number of the row
    integer :: constraints = 0
    integer, allocatable :: body_constraint(:) !! (parts) number of the one before the first of a
                                               !! rigid part
    integer, allocatable :: line_constraint(:) !! (sliders) across the line; 0: none
    integer, allocatable :: drive_constraint(:) !! (drives) along the line of a moving guide, or 0
    real(wp) :: size_of = 1.0_wp             !! by which rotations are multiplied [m]
  end type border_unknowns_t

contains

  !> Numbers everything.
  pure function new_border_unknowns(elastic, links) result(numbers)
    type(elastic_linkage_t), intent(in) :: elastic !! parts, points, rotations
    type(link_modes_t), intent(in) :: links(:)     !! (parts)
    type(border_unknowns_t) :: numbers

    integer :: i, k, n

    allocate (numbers%point(size(elastic%is_fixed)), numbers%rotation(elastic%rotations), &
      numbers%elongation(size(links)), numbers%curve(2, size(links)), &
      numbers%spring(size(elastic%springs)), numbers%body_constraint(size(links)), &
      numbers%line_constraint(size(elastic%linkage%sliders)), &
      numbers%drive_constraint(size(elastic%linkage%drives)))
    numbers%point = 0
    do i = 1, size(numbers%point)
      if (elastic%is_fixed(i)) cycle
      numbers%point(i) = numbers%unknowns + 1
      numbers%unknowns = numbers%unknowns + 2
    end do
    numbers%rotation = [(numbers%unknowns + i, i=1, elastic%rotations)]
    numbers%unknowns = numbers%unknowns + elastic%rotations
    numbers%elongation = 0
    numbers%curve = 0
    n = count(elastic%linkage%bodies%bends) + sum(links%curves) + size(elastic%springs)
    allocate (numbers%rows(n))
    n = 0
    do k = 1, size(links)
      if (.not. elastic%linkage%bodies(k)%bends) cycle
      n = n + 1
      numbers%elongation(k) = n
      numbers%rows(n) = border_row_t(row_elongation, k, 0)
      do i = 1, links(k)%curves
        n = n + 1
        numbers%curve(i, k) = n
        numbers%rows(n) = border_row_t(row_curve, k, i)
      end do
    end do
    ! Closed forms begin with the rotation of the clamped end.
    if (elastic%in_closed_form .and. links(1)%curves == 1) then
      numbers%elongation(1) = 2
      numbers%curve(1, 1) = 1
      numbers%rows(:2) = numbers%rows(2:1:-1)
    end if
    do i = 1, size(elastic%springs)
      n = n + 1
      numbers%spring(i) = n
      numbers%rows(n) = border_row_t(row_spring, i, 0)
    end do
    call number_constraints(elastic, numbers)
    numbers%size_of = maxval(elastic%linkage%bodies%length)
  end function new_border_unknowns

  pure subroutine number_constraints(elastic, numbers)
    type(elastic_linkage_t), intent(in) :: elastic
    type(border_unknowns_t), intent(inout) :: numbers

    integer :: i, n

    n = 0
    numbers%body_constraint = 0
    do i = 1, size(numbers%body_constraint)
      associate (part => elastic%linkage%bodies(i))
        numbers%body_constraint(i) = n
        if (.not. part%bends) n = n + 2*(1 + size(part%further))
      end associate
    end do
    numbers%line_constraint = 0
    do i = 1, size(numbers%line_constraint)
      associate (line => elastic%linkage%sliders(i))
        if (elastic%is_fixed(line%pin) .and. line%body == 0) cycle
        n = n + 1
        numbers%line_constraint(i) = n
      end associate
    end do
    numbers%drive_constraint = 0
    do i = 1, size(numbers%drive_constraint)
      associate (drive => elastic%linkage%drives(i))
        if (drive%kind /= drive_of_slider .or. drive%is_free) cycle
        if (elastic%linkage%sliders(drive%slider)%body == 0) cycle
        n = n + 1
        numbers%drive_constraint(i) = n
      end associate
    end do
    numbers%constraints = n
  end subroutine number_constraints

  !> The rows at a position.
  pure subroutine find_border_rows(elastic, links, numbers, pose, rows)
    type(elastic_linkage_t), intent(in) :: elastic   !! parts of this position
    type(link_modes_t), intent(in) :: links(:)       !! (parts)
    type(border_unknowns_t), intent(in) :: numbers   !! of these
    type(pose_t), intent(in) :: pose                 !! of points and parts
    type(graded_rows_t), intent(inout) :: rows       !! storage is kept if it has the right size

    real(wp) :: normal(2)
    integer :: i, k

    if (allocated(rows%row)) then
      if (any(shape(rows%row) /= [numbers%unknowns, size(numbers%rows)])) deallocate (rows%row, &
        rows%constraint, rows%weight)
    end if
    if (.not. allocated(rows%row)) allocate (rows%row(numbers%unknowns, size(numbers%rows)), &
      rows%constraint(numbers%unknowns, numbers%constraints), rows%weight(size(numbers%rows)))
    rows%row = 0.0_wp
    rows%constraint = 0.0_wp
    do k = 1, size(links)
      associate (part => elastic%linkage%bodies(k), axis => pose%direction(:, k))
        if (.not. part%bends) then
          i = numbers%body_constraint(k)
          call add_rigid(elastic, numbers, pose, k, rows%constraint(:, i + 1:i + 2*(1 + &
            size(part%further))))
          cycle
        end if
        i = numbers%elongation(k)
        call add_chord(numbers, part, axis, rows%row(:, i))
        rows%weight(i) = 1.0_wp/links(k)%elongation
        normal = normal_to(axis)/part%length
        do i = 1, links(k)%curves
          associate (row => rows%row(:, numbers%curve(i, k)))
            if (links(k)%curves == 2) then
              call add_rotation(numbers, elastic%rotation(1, k), 1.0_wp, row)
              call add_rotation(numbers, elastic%rotation(2, k), merge(1.0_wp, -1.0_wp, i == 1), &
                row)
              if (i == 1) call add_chord(numbers, part, -2.0_wp*normal, row)
            else
              call add_rotation(numbers, elastic%rotation(merge(1, 2, links(k)%held(1)), k), &
                1.0_wp, row)
              call add_chord(numbers, part, -normal, row)
            end if
          end associate
          rows%weight(numbers%curve(i, k)) = 1.0_wp/links(k)%curve_rotation(i)
        end do
      end associate
    end do
    do i = 1, size(elastic%springs)
      call add_spring(elastic, numbers, pose, elastic%springs(i), &
        rows%row(:, numbers%spring(i)))
      rows%weight(numbers%spring(i)) = sqrt(elastic%springs(i)%stiffness)
    end do
    do i = 1, size(numbers%line_constraint)
      if (numbers%line_constraint(i) > 0) call add_line(elastic, numbers, pose, i, &
        normal_to(line_direction(elastic, pose, i)), &
        rows%constraint(:, numbers%line_constraint(i)))
    end do
    do i = 1, size(numbers%drive_constraint)
      if (numbers%drive_constraint(i) > 0) call add_line(elastic, numbers, pose, &
        elastic%linkage%drives(i)%slider, line_direction(elastic, pose, &
        elastic%linkage%drives(i)%slider), rows%constraint(:, numbers%drive_constraint(i)))
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
  pure subroutine add_rigid(elastic, numbers, pose, part, constraint)
    type(elastic_linkage_t), intent(in) :: elastic  !! its parts
    type(border_unknowns_t), intent(in) :: numbers  !! of the unknowns
    type(pose_t), intent(in) :: pose                !! of points and parts
    integer, intent(in) :: part                     !! number of the link
    real(wp), intent(inout) :: constraint(:, :)     !! (unknowns, two of each pin)

    real(wp) :: arm(2), unit(2)
    integer :: i, k, pin, row

    associate (body => elastic%linkage%bodies(part))
      do k = 0, size(body%further)
        pin = body%last_pin
        if (k > 0) pin = body%further(k)%pin
        arm = pose%direction(:, part)*body%length
        if (k > 0) arm = turned(body%further(k)%place, pose%direction(:, part))
        do i = 1, 2
          row = 2*k + i
          unit = 0.0_wp
          unit(i) = 1.0_wp
          call add_point(numbers, pin, unit, constraint(:, row))
          call add_point(numbers, body%first_pin, -unit, constraint(:, row))
          call add_rotation(numbers, elastic%rotation(1, part), -dot_product(unit, &
            normal_to(arm)), constraint(:, row))
        end do
      end do
    end associate
  end subroutine add_rigid

  !> Adds `a·(U_P − U_Q)` of a block at P on the point Q of its guide.
  pure subroutine add_line(elastic, numbers, pose, slider, a, row)
    type(elastic_linkage_t), intent(in) :: elastic  !! its parts
    type(border_unknowns_t), intent(in) :: numbers  !! of the unknowns
    type(pose_t), intent(in) :: pose                !! of points and parts
    integer, intent(in) :: slider                   !! number
    real(wp), intent(in) :: a(2)                    !! a direction
    real(wp), intent(inout) :: row(:)               !! (unknowns)

    integer :: part

    associate (line => elastic%linkage%sliders(slider))
      call add_point(numbers, line%pin, a, row)
      if (elastic%contact(slider) > 0) then
        call add_point(numbers, elastic%contact(slider), -a, row)
      else if (line%body > 0) then
        part = findloc(elastic%body, line%body, dim=1)
        associate (first => elastic%linkage%bodies(part)%first_pin)
          call add_point(numbers, first, -a, row)
          call add_rotation(numbers, elastic%rotation(1, part), -dot_product(a, &
            normal_to(pose%pin(:, line%pin) - pose%pin(:, first))), row)
        end associate
      end if
    end associate
  end subroutine add_line

  !> What the dampers feel: stretch or turn.
  pure function damper_rows(elastic, numbers, pose) result(rows)
    type(elastic_linkage_t), intent(in) :: elastic !! its dampers
    type(border_unknowns_t), intent(in) :: numbers !! of the unknowns
    type(pose_t), intent(in) :: pose               !! of points and parts
    real(wp) :: rows(numbers%unknowns, size(elastic%dampers)) !! [-] or [1/m]

    integer :: i

    rows = 0.0_wp
    do i = 1, size(elastic%dampers)
      call add_spring(elastic, numbers, pose, elastic%dampers(i), rows(:, i))
    end do
  end function damper_rows

  !> Adds the stretch or turn of a spring.
  pure subroutine add_spring(elastic, numbers, pose, spring, row)
    type(elastic_linkage_t), intent(in) :: elastic  !! its parts
    type(border_unknowns_t), intent(in) :: numbers  !! of the unknowns
    type(pose_t), intent(in) :: pose                !! of points and parts
    type(spring_t), intent(in) :: spring            !! or a damper
    real(wp), intent(inout) :: row(:)               !! (unknowns)

    real(wp) :: way(2)

    if (spring%turns) then
      call add_rotation(numbers, spring%rotation(2), 1.0_wp, row)
      call add_rotation(numbers, spring%rotation(1), -1.0_wp, row)
      return
    end if
    way = spring_way(elastic, pose, spring)
    if (norm2(way) > 0.0_wp) way = way/norm2(way)
    call add_stretch(elastic, numbers, pose, spring, way, row)
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
  pure subroutine add_stretch(elastic, numbers, pose, spring, a, row)
    type(elastic_linkage_t), intent(in) :: elastic  !! its parts
    type(border_unknowns_t), intent(in) :: numbers  !! of the unknowns
    type(pose_t), intent(in) :: pose                !! of points and parts
    type(spring_t), intent(in) :: spring            !! or a damper
    real(wp), intent(in) :: a(2)                    !! a direction
    real(wp), intent(inout) :: row(:)               !! (unknowns)

    integer :: k, part
    real(wp) :: sense

    do k = 1, 2
      sense = merge(-1.0_wp, 1.0_wp, k == 1)
      associate (at => elastic%linkage%loads(spring%load)%along%at(k))
        if (at%pin > 0) then
          call add_point(numbers, at%pin, sense*a, row)
        else
          ! A place that is no pin is one of a rigid link.
          part = findloc(elastic%body, at%body, dim=1)
          call add_point(numbers, elastic%linkage%bodies(part)%first_pin, sense*a, row)
          call add_rotation(numbers, elastic%rotation(1, part), sense*dot_product(a, &
            normal_to(turned(at%place, pose%direction(:, part)))), row)
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
