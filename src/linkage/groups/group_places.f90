!> Places groups other than RRR dyads of given lengths: in closed form, from circles and lines, or
!! by Newton's method.
module group_places
  use dense_factor, only: least_singular_value, solve
  use dyad_places, only: limit_slack, place_dyad
  use errors, only: error_of_dead_point, error_of_numerics, error_of_reach, error_t, set_error
  use drive_values, only: drive_direction, drive_value
  use group_equations, only: line_axis, line_offset, world_line
  use group_factors, only: factorize_group, group_factors_t
  use kinds, only: wp
  use linkages, only: cross, demand_drive, equation_t, group_t, group_carried, &
    group_cross_slide, group_driven_dyad, group_on_line, group_placed, group_spanned, &
    group_through_pin, group_turned, group_two_lines, linkage_t, normal_to, turned
  use pose_types, only: arm_to_pin, place_of_pin, pose_t
  implicit none (type, external)
  private

  public :: place_group, improve_group

  integer, parameter :: most_iterations = 30

contains

  !> Places the pins of a group and turns its bodies. The group is no RRR dyad of given lengths, and
  !! none that only iterations place.
  !!
  !! Errors: the position is out of reach; a dead point that leaves the group undetermined.
  pure subroutine place_group(linkage, group, side, crank, pose, sine, error)
    type(linkage_t), intent(in) :: linkage    !! bodies, sliders, turns and drives
    type(group_t), intent(in) :: group        !! of this linkage
    real(wp), intent(in) :: side              !! as in `group_t`
    real(wp), intent(in) :: crank             !! coordinate of the first drive [deg] or [m]
    type(pose_t), intent(inout) :: pose       !! with all groups before this one
    real(wp), intent(out) :: sine             !! of the group; see `pose_t`
    type(error_t), allocatable, intent(inout) :: error !! why it cannot be placed

    real(wp) :: axis(2), point(2), other_axis(2), other_point(2), way(2)
    integer :: i

    sine = 1.0_wp
    select case (group%kind)
    case (group_carried)
      do i = 1, size(group%pins)
        pose%pin(:, group%pins(i)) = pose%pin(:, group%base(1)) + arm_to_pin(linkage, pose, &
          group%body(1), group%pins(i))
      end do
    case (group_driven_dyad)
      call place_driven_dyad(linkage, group, side, crank, pose, sine, error)
    case (group_on_line)
      call place_on_line(linkage, group, side, crank, pose, sine, error)
    case (group_through_pin)
      call place_through_pin(linkage, group, side, pose, sine, error)
    case (group_two_lines)
      call world_line(linkage, pose, group%slider(1), axis, point)
      call world_line(linkage, pose, group%slider(2), other_axis, other_point)
      call intersect(axis, point, other_axis, other_point, pose%pin(:, group%pins(1)), sine, error)
    case (group_cross_slide)
      call turn_body(linkage, group, pose, crank)
      call world_line(linkage, pose, group%slider(1), axis, point)
      other_axis = line_axis(linkage, pose, group%slider(2))
      ! The pin through which its own line passes, seen from the line through its first pin.
      other_point = pose%pin(:, group%middle) - line_offset(linkage, group%slider(2))*normal_to( &
        other_axis)
      call intersect(axis, point, other_axis, other_point, pose%pin(:, group%pins(1)), sine, error)
    case (group_turned)
      call turn_body(linkage, group, pose, crank)
    case (group_spanned)
      way = pose%pin(:, group%middle) - pose%pin(:, group%base(1))
      if (.not. norm2(way) > 0.0_wp) then
        sine = 0.0_wp
        call set_error(error, error_of_dead_point, "dead point: two pins of the link coincide", &
          body=group%body(1))
        return
      end if
      pose%direction(:, group%body(1)) = turned_back(way/norm2(way), place_of_pin(linkage%bodies( &
        group%body(1)), group%middle))
    case (group_placed)
      associate (number => group%equations(1)%number)
        call world_line(linkage, pose, linkage%drives(number)%slider, axis, point)
        pose%pin(:, group%pins(1)) = point + drive_value(linkage, number, crank)*axis
      end associate
    end select
  end subroutine place_group

  !> Turns a body as another one, or its drive, does.
  pure subroutine turn_body(linkage, group, pose, crank)
    type(linkage_t), intent(in) :: linkage
    type(group_t), intent(in) :: group
    type(pose_t), intent(inout) :: pose
    real(wp), intent(in) :: crank

    real(wp) :: direction(2)

    associate (equation => group%equations(1))
      if (equation%kind == demand_drive) then
        direction = drive_direction(linkage, equation%number, pose, crank)
      else
        direction = direction_of_turn(linkage, equation%number, group%body(1), pose)
      end if
    end associate
    pose%direction(:, group%body(1)) = direction
  end subroutine turn_body

  !> Direction of one of the two bodies that turn together, from the other one.
  pure function direction_of_turn(linkage, number, body, pose) result(direction)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: number !! of the turn
    integer, intent(in) :: body   !! whose direction is wanted
    type(pose_t), intent(in) :: pose
    real(wp) :: direction(2)

    associate (turn => linkage%turns(number))
      if (body == turn%body) then
        direction = turn%relative
        if (turn%against > 0) direction = turned(direction, pose%direction(:, turn%against))
      else
        direction = turned([turn%relative(1), -turn%relative(2)], pose%direction(:, turn%body))
      end if
    end associate
  end function direction_of_turn

  !> RRR with driven lengths.
  pure subroutine place_driven_dyad(linkage, group, side, crank, pose, sine, error)
    type(linkage_t), intent(in) :: linkage
    type(group_t), intent(in) :: group
    real(wp), intent(in) :: side
    real(wp), intent(in) :: crank
    type(pose_t), intent(inout) :: pose
    real(wp), intent(out) :: sine
    type(error_t), allocatable, intent(inout) :: error

    real(wp) :: r(2)
    integer :: k

    sine = 0.0_wp
    do k = 1, 2
      call find_length(linkage, group%equations(2*k - 1), group%body(k), crank, r(k), error)
    end do
    if (.not. allocated(error)) call place_dyad(linkage, group, r, side, pose, sine, error)
  end subroutine place_driven_dyad

  !> The distance between two pins of a body, which may be driven.
  pure subroutine find_length(linkage, equation, body, crank, length, error)
    type(linkage_t), intent(in) :: linkage
    type(equation_t), intent(in) :: equation !! that gives it
    integer, intent(in) :: body              !! number
    real(wp), intent(in) :: crank
    real(wp), intent(out) :: length
    type(error_t), allocatable, intent(inout) :: error

    if (equation%kind /= demand_drive) then
      length = norm2(equation%place)
      return
    end if
    length = drive_value(linkage, equation%number, crank)
    if (length > 0.0_wp) return
    call set_error(error, error_of_reach, "the position is out of reach: a ram has a length "// &
      "above 0", body=body)
  end subroutine find_length

  !> RRP: the circle of a body about its base meets the line of a slider.
  !!
  !! With h the distance of the base from the line, the pin lies `√((r − h)(r + h))` from the foot
  !! of the perpendicular.
  pure subroutine place_on_line(linkage, group, side, crank, pose, sine, error)
    type(linkage_t), intent(in) :: linkage
    type(group_t), intent(in) :: group
    real(wp), intent(in) :: side
    real(wp), intent(in) :: crank
    type(pose_t), intent(inout) :: pose
    real(wp), intent(out) :: sine
    type(error_t), allocatable, intent(inout) :: error

    real(wp) :: axis(2), point(2), place(2), way(2), r, h, squared, along

    call world_line(linkage, pose, group%slider(1), axis, point)
    place = place_of_pin(linkage%bodies(group%body(1)), group%middle)
    sine = 0.0_wp
    call find_length(linkage, group%equations(1), group%body(1), crank, r, error)
    if (allocated(error)) return
    way = pose%pin(:, group%base(1)) - point
    h = cross(axis, way)
    squared = (r - h)*(r + h)
    if (squared < -limit_slack*max(r, abs(h))**2) then
      call set_error(error, error_of_reach, "the position is out of reach", body=group%body(1), &
        missing=abs(h) - r)
      return
    end if
    along = side*sqrt(max(squared, 0.0_wp))
    pose%pin(:, group%middle) = point + (dot_product(axis, way) + along)*axis
    ! From the base: along the line, and back across it.
    way = along*axis - h*normal_to(axis)
    pose%direction(:, group%body(1)) = turned_back(way/norm2(way), place)
    sine = along/r
  end subroutine place_on_line

  !> RPR: the line of a body passes through a pin placed before.
  pure subroutine place_through_pin(linkage, group, side, pose, sine, error)
    type(linkage_t), intent(in) :: linkage
    type(group_t), intent(in) :: group
    real(wp), intent(in) :: side
    type(pose_t), intent(inout) :: pose
    real(wp), intent(out) :: sine
    type(error_t), allocatable, intent(inout) :: error

    real(wp) :: u(2), offset, squared, along, distance

    offset = line_offset(linkage, group%slider(1))
    u = pose%pin(:, group%middle) - pose%pin(:, group%base(1))
    distance = norm2(u)
    squared = (distance - offset)*(distance + offset)
    sine = 0.0_wp
    if (squared < -limit_slack*max(distance, abs(offset))**2) then
      call set_error(error, error_of_reach, "the position is out of reach", body=group%body(1))
      return
    else if (.not. distance > 0.0_wp) then
      call set_error(error, error_of_dead_point, "dead point: the block is at the pin about "// &
        "which the link turns", body=group%body(1))
      return
    end if
    along = side*sqrt(max(squared, 0.0_wp))
    ! The line passes the first pin at a distance: to its left where `offset` is positive.
    pose%direction(:, group%body(1)) = turned_back((along*u - offset*normal_to(u))/distance**2, &
      linkage%sliders(group%slider(1))%direction)
    pose%direction(:, group%body(1)) = pose%direction(:, group%body(1))/norm2(pose%direction(:, &
      group%body(1)))
    sine = along/max(linkage%bodies(group%body(1))%length, distance)
  end subroutine place_through_pin

  !> The point where two lines meet.
  pure subroutine intersect(axis, point, other_axis, other_point, place, sine, error)
    real(wp), intent(in) :: axis(2), point(2), other_axis(2), other_point(2)
    real(wp), intent(out) :: place(2)
    real(wp), intent(out) :: sine
    type(error_t), allocatable, intent(inout) :: error

    place = point
    sine = cross(axis, other_axis)
    if (.not. abs(sine) > 0.0_wp) then
      call set_error(error, error_of_dead_point, "dead point: two guides are parallel")
      return
    end if
    place = point + cross(other_point - point, other_axis)/sine*axis
  end subroutine intersect

  !> The direction of a body from the direction, in global axes, of one of its vectors.
  pure function turned_back(direction, vector) result(axis)
    real(wp), intent(in) :: direction(2) !! unit vector, global axes
    real(wp), intent(in) :: vector(2)    !! the same, in the axes of the body, of any length
    real(wp) :: axis(2)

    axis = turned([vector(1), -vector(2)]/norm2(vector), direction)
  end function turned_back

  !> Newton's method from a pose near by, until the corrections are rounding.
  !!
  !! Errors: a singular matrix, or no convergence. The pose is then of no use.
  pure subroutine improve_group(linkage, group, crank, pose, sine, largest, iterations, &
    error)
    type(linkage_t), intent(in) :: linkage    !! bodies, sliders, turns and drives
    type(group_t), intent(in) :: group        !! with equations
    real(wp), intent(in) :: crank             !! coordinate of the first drive [deg] or [m]
    type(pose_t), intent(inout) :: pose       !! near the solution; the solution
    real(wp), intent(out) :: sine             !! as in `pose_t`, at the last iteration
    real(wp), intent(out) :: largest          !! correction of all iterations [m]
    integer, intent(out) :: iterations        !! how many
    type(error_t), allocatable, intent(inout) :: error !! why it does not converge

    type(group_factors_t) :: factors
    real(wp), dimension(size(group%equations)) :: misfit, step, total
    real(wp) :: size_of_step, last, reach, angle
    integer :: k

    sine = 0.0_wp
    largest = 0.0_wp
    total = 0.0_wp
    last = huge(last)
    reach = 1.0_wp
    do iterations = 1, most_iterations
      call factorize_group(linkage, group, pose, factors, crank, misfit)
      if (.not. abs(factors%factor%determinant) > 0.0_wp) exit
      reach = maxval([maxval(abs(pose%pin)), factors%scale])
      step = -solve(factors%factor, misfit)
      do k = 1, size(group%pins)
        pose%pin(:, group%pins(k)) = pose%pin(:, group%pins(k)) + step(2*k - 1:2*k)
      end do
      do k = 1, size(group%bodies)
        angle = step(2*size(group%pins) + k)/factors%scale(k)
        associate (direction => pose%direction(:, group%bodies(k)))
          pose%direction(:, group%bodies(k)) = turned([cos(angle), sin(angle)], direction)
        end associate
        pose%direction(:, group%bodies(k)) = pose%direction(:, group%bodies(k))/norm2( &
          pose%direction(:, group%bodies(k)))
      end do
      total = total + step
      largest = maxval(abs(total))
      size_of_step = maxval(abs(step))
      if (.not. size_of_step <= 1.0e6_wp*reach) exit
      ! Rounding remains: corrections, or misfits near dead points, that are tiny, and corrections
      ! no smaller than half the last ones.
      if (size_of_step <= 4.0_wp*epsilon(1.0_wp)*reach .or. (size_of_step >= 0.5_wp*last .and. &
        (size_of_step <= 1.0e-12_wp*reach .or. &
        maxval(abs(misfit)) <= 16.0_wp*epsilon(1.0_wp)*reach))) then
        sine = least_singular_value(factors%factor)/group%usual
        return
      end if
      last = size_of_step
    end do
    call set_error(error, error_of_numerics, "the position was not found by iterations", &
      body=body_of(group))
  end subroutine improve_group

  !> A body that a group is about; 0 if its equations are about pins on fixed lines only.
  pure function body_of(group) result(body)
    type(group_t), intent(in) :: group
    integer :: body

    body = maxval([0, group%equations%body])
    if (size(group%bodies) > 0) body = group%bodies(1)
  end function body_of

end module group_places
