!> What forces and couples at terminals do: their work on displacements of a linkage in parts. These
!! are its unknowns one by one, a row of the border, or `chords_t` of some.
!!
!! A terminal on a rigid link moves with the first point of this, by U, and turns with it by θ: with
!! the arm r from there a force F and a couple M do the work `F·U + (M + r × F) θ`. A hinged end of
!! a part that bends turns with its chord, and as the curves of the other end turn it.
module terminal_work
  use border_unknowns, only: border_unknowns_t
  use deformation_places, only: rotation_row
  use elastic_linkages, only: elastic_linkage_t
  use elastic_positions, only: elastic_position_t
  use elastic_terminals, only: elastic_terminal_t, fixed_rotation
  use kinds, only: wp
  use link_modes, only: link_modes_t
  use linkages, only: cross, turned
  use pin_displacements, only: chords_t
  use poses, only: pose_t
  implicit none (type, external)
  private

  public :: terminal_arm, way_between, line_direction, pins_of_rigid
  public :: add_between, add_point, add_rotation, work_between
  public :: find_end, end_slopes, turn_of_end

contains

  !> From the point of a terminal to its place [m].
  pure function terminal_arm(pose, terminal) result(arm)
    type(pose_t), intent(in) :: pose                 !! of points and parts
    type(elastic_terminal_t), intent(in) :: terminal !! with a point
    real(wp) :: arm(2)

    if (terminal%block > 0) then
      arm = pose%pin(:, terminal%block) - pose%pin(:, terminal%point)
    else if (terminal%is_rigid) then
      arm = turned(terminal%place, pose%direction(:, terminal%part))
    else
      arm = terminal%place
    end if
  end function terminal_arm

  !> The way from a terminal to another [m].
  pure function way_between(pose, ends) result(way)
    type(pose_t), intent(in) :: pose                !! of points and parts
    type(elastic_terminal_t), intent(in) :: ends(2) !! with points
    real(wp) :: way(2)

    way = pose%pin(:, ends(2)%point) + terminal_arm(pose, ends(2)) - &
      (pose%pin(:, ends(1)%point) + terminal_arm(pose, ends(1)))
  end function way_between

  !> Direction of the line of a slider.
  pure function line_direction(elastic, pose, slider) result(direction)
    type(elastic_linkage_t), intent(in) :: elastic !! parts
    type(pose_t), intent(in) :: pose               !! of points and parts
    integer, intent(in) :: slider                  !! number
    real(wp) :: direction(2)                       !! unit vector

    direction = elastic%linkage%sliders(slider)%direction
    associate (part => elastic%sliding(1, slider)%part)
      if (part > 0) direction = turned(direction, turned([elastic%axis(1, part), &
        -elastic%axis(2, part)], pose%direction(:, part)))
    end associate
  end function line_direction

  !> A rigid link at one of its pins, and this pin.
  pure function pins_of_rigid(elastic, part, number) result(ends)
    type(elastic_linkage_t), intent(in) :: elastic
    integer, intent(in) :: part          !! number of the rigid link
    integer, intent(in) :: number        !! 0: its last pin; of one further
    type(elastic_terminal_t) :: ends(2)

    associate (body => elastic%linkage%bodies(part))
      ends(1) = elastic_terminal_t(point=body%first_pin, part=part, is_rigid=.true., &
        rotation=elastic%rotation(1, part), place=[body%length, 0.0_wp])
      ends(2)%point = body%last_pin
      if (number == 0) return
      ends(1)%place = body%further(number)%place
      ends(2)%point = body%further(number)%pin
    end associate
  end function pins_of_rigid

  !> Adds the work of a force and a couple on the second of two terminals, and of the opposite on
  !! the first.
  pure subroutine add_between(at, ends, force, couple, row)
    type(elastic_position_t), intent(in) :: at
    type(elastic_terminal_t), intent(in) :: ends(2) !! none hinged
    real(wp), intent(in) :: force(2)
    real(wp), intent(in) :: couple
    real(wp), intent(inout) :: row(:)               !! (unknowns)

    real(wp) :: sense
    integer :: k

    do k = 1, 2
      sense = merge(-1.0_wp, 1.0_wp, k == 1)
      call add_point(at%numbers, ends(k)%point, sense*force, row)
      call add_rotation(at%numbers, ends(k)%rotation, sense*moment_of(at%pose, ends(k), force, &
        couple), row)
    end do
  end subroutine add_between

  !> Adds `a·U` of a point.
  pure subroutine add_point(numbers, point, a, row)
    type(border_unknowns_t), intent(in) :: numbers
    integer, intent(in) :: point !! number; 0: the ground
    real(wp), intent(in) :: a(2)
    real(wp), intent(inout) :: row(:)

    integer :: first

    if (point == 0) return
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

  !> Work on some displacements of a force and a couple on the second of two terminals, and of the
  !! opposite on the first.
  pure function work_between(at, chords, ends, force, couple) result(work)
    type(elastic_position_t), intent(in) :: at
    type(chords_t), intent(in) :: chords            !! what the displacements do to points
    type(elastic_terminal_t), intent(in) :: ends(2)
    real(wp), intent(in) :: force(2)
    real(wp), intent(in) :: couple
    real(wp) :: work(size(chords%turn, 1))          !! (displacements)

    work = work_at(at, chords, ends(2), force, couple) - work_at(at, chords, ends(1), force, couple)
  end function work_between

  pure function work_at(at, chords, terminal, force, couple) result(work)
    type(elastic_position_t), intent(in) :: at
    type(chords_t), intent(in) :: chords
    type(elastic_terminal_t), intent(in) :: terminal
    real(wp), intent(in) :: force(2), couple
    real(wp) :: work(size(chords%turn, 1))

    real(wp) :: moment
    integer :: part, end

    moment = moment_of(at%pose, terminal, force, couple)
    work = 0.0_wp
    if (terminal%point > 0) work = matmul(force, chords%pin(:, terminal%point, :))
    if (terminal%rotation > 0) then
      work = work + moment*chords%rotation(terminal%rotation, :)
    else if (terminal%rotation == 0 .and. terminal%part > 0 .and. abs(moment) > 0.0_wp) then
      call find_end(at%elastic, terminal, part, end)
      work = work + moment*turn_of_end(at%model%links(part), chords%turn(:, part), &
        chords%across(3:, :, part), end)
    end if
  end function work_at

  !> Moment about the point of a terminal, which turns it: of a force on a rigid link, too.
  pure function moment_of(pose, terminal, force, couple) result(moment)
    type(pose_t), intent(in) :: pose
    type(elastic_terminal_t), intent(in) :: terminal
    real(wp), intent(in) :: force(2), couple
    real(wp) :: moment

    moment = couple
    if (terminal%is_rigid) moment = moment + cross(terminal_arm(pose, terminal), force)
  end function moment_of

  !> The part that has a terminal at an end, at this position.
  pure subroutine find_end(elastic, terminal, part, end)
    type(elastic_linkage_t), intent(in) :: elastic   !! with parts that are placed
    type(elastic_terminal_t), intent(in) :: terminal !! an end of a link that bends
    integer, intent(out) :: part
    integer, intent(out) :: end                      !! 1: the first, 2: the last

    do part = terminal%part, size(elastic%body)
      associate (body => elastic%linkage%bodies(part))
        end = findloc([body%first_pin, body%last_pin], terminal%point, dim=1)
      end associate
      if (end > 0) return
    end do
  end subroutine find_end

  !> Rotations of an end of a part that bends against its chord: of curves, then own modes.
  pure function end_slopes(link, end) result(slopes)
    type(link_modes_t), intent(in) :: link
    integer, intent(in) :: end !! 1: the first, 2: the last
    real(wp) :: slopes(link%curves + link%modes)

    real(wp) :: row(link%bending_shapes%unknowns)

    row = rotation_row(link%bending_shapes, real(end - 1, wp))
    slopes = matmul(row(:size(link%bending, 1)), link%bending)
  end function end_slopes

  !> Rotation of a hinged end of a part that bends: that of its chord, and what the curves of the
  !! other end add.
  pure function turn_of_end(link, chord, curve, number) result(turn)
    type(link_modes_t), intent(in) :: link   !! of the part
    real(wp), intent(in) :: chord(:)         !! (displacements) what they turn its chord
    real(wp), intent(in) :: curve(:, :)      !! (curves or more, displacements)
    integer, intent(in) :: number            !! 1: the first end, 2: the last
    real(wp) :: turn(size(chord))            !! (displacements)

    real(wp) :: slopes(link%curves + link%modes)
    integer :: i

    turn = chord
    slopes = end_slopes(link, number)
    do i = 1, link%curves
      turn = turn + slopes(i)*curve(i, :)
    end do
  end function turn_of_end

end module terminal_work
