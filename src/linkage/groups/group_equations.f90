! src/linkage/groups/ - positions, velocities and accelerations of a linkage, group after group.
! In: a planned `linkage_t`, the coordinate of its first drive. Out: a `pose_t`, its
! `kinematic_coefficients_t`. Begin with `find_pose` in `poses.f90` and
! `find_kinematic_coefficients` in `kinematic_coefficients.f90`. The constraint equations are here,
! with gradients and curvatures.
! Not here: the order of the groups (`src/linkage/plan`), ways through change points
! (`src/linkage/limits`).

!> What pins of bodies, sliders, turns and drives demand of the pose: misfits, gradients, and second
!! derivatives along the motion.
!!
!! The unknowns of a group are the positions of its pins and the angles of its bodies. With u from
!! the first pin of a body to another one, and n the normal of the unit vector there, which turns
!! with the body, the pin demands `|u| = r` and `n·u = 0`; a pin on the line of a body `m·u = c`
!! with the normal m of the line. The distance does not depend on the angle: a group may place pins
!! before the bodies between them are turned. One matrix of gradients serves positions (Newton),
!! velocities and accelerations, and, transposed, the forces.
module group_equations
  use constants, only: degree
  use coordinate_types, only: coordinate_t, gradient_t, is_across, is_angle, is_distance, is_sum
  use coordinates, only: add_gradient, coordinate_acceleration, evaluate, evaluated_t, &
    slider_coordinate
  use drive_values, only: direction_at, drive_value
  use kinds, only: wp
  use linkages, only: body_t, cross, demand_angle, demand_drive, demand_length, demand_line, &
    demand_turn, drive_of_angle, drive_of_coordinate, drive_of_length, drive_of_slider, &
    equation_t, gives_angle, group_t, linkage_t, turned
  use pose_types, only: kinematic_coefficients_t, pose_t
  implicit none (type, external)
  private

  public :: held_coordinate, find_gradient, misfit_of, curvature_of, unknowns_of, world_line, &
    line_axis, line_offset, farthest_arm

contains

  !> The coordinate that an equation holds. The terminals of an angle have directions that agree
  !! where it is fulfilled; the first one of a drive is still to be turned by what this gives.
  pure function held_coordinate(linkage, equation) result(coordinate)
    type(linkage_t), intent(in) :: linkage   !! bodies, sliders, turns and drives
    type(equation_t), intent(in) :: equation !! one of its equations
    type(coordinate_t) :: coordinate

    select case (equation%kind)
    case (demand_length)
      coordinate%kind = is_distance
      coordinate%at(1)%body = equation%body
      coordinate%at(2)%pin = equation%pin
    case (demand_angle)
      coordinate%kind = is_across
      coordinate%at(1)%body = equation%body
      coordinate%at(1)%direction = equation%place/norm2(equation%place)
      coordinate%at(2)%pin = equation%pin
    case (demand_line)
      coordinate = slider_coordinate(linkage, equation%number)
      coordinate%kind = is_across
    case (demand_turn)
      coordinate%kind = is_angle
      associate (turn => linkage%turns(equation%number))
        coordinate%at(1)%body = turn%against
        coordinate%at(1)%direction = turn%relative
        coordinate%at(2)%body = turn%body
      end associate
    case (demand_drive)
      coordinate = driven_coordinate(linkage, equation%number)
    end select
  end function held_coordinate

  !> The coordinate of a drive.
  pure function driven_coordinate(linkage, number) result(coordinate)
    type(linkage_t), intent(in) :: linkage !! bodies, sliders and drives
    integer, intent(in) :: number          !! of the drive, from 1
    type(coordinate_t) :: coordinate

    associate (drive => linkage%drives(number))
      select case (drive%kind)
      case (drive_of_angle)
        coordinate%kind = is_angle
        coordinate%at%body = [drive%against, drive%body]
        if (drive%against > 0) coordinate%at(1)%direction = linkage%bodies(drive%against)%heading
        coordinate%at(2)%direction = linkage%bodies(drive%body)%heading
      case (drive_of_slider)
        coordinate = slider_coordinate(linkage, drive%slider)
      case (drive_of_length)
        coordinate%kind = is_distance
        coordinate%at(1)%body = drive%body
        coordinate%at(2)%pin = linkage%bodies(drive%body)%last_pin
      case (drive_of_coordinate)
        coordinate = linkage%coordinates(drive%coordinate)
      end select
    end associate
  end function driven_coordinate

  !> Gradient of an equation at a pose.
  pure subroutine find_gradient(linkage, equation, pose, gradient)
    type(linkage_t), intent(in) :: linkage        !! bodies, sliders, turns and drives
    type(equation_t), intent(in) :: equation      !! one of its equations
    type(pose_t), intent(in) :: pose              !! pins and directions
    type(gradient_t), intent(out) :: gradient     !! of its misfit

    call add_gradient(linkage, pose, held_coordinate(linkage, equation), 1.0_wp, gradient)
  end subroutine find_gradient

  !> By how much an equation is not fulfilled [m], or [rad] between angles.
  pure function misfit_of(linkage, equation, pose, crank) result(misfit)
    type(linkage_t), intent(in) :: linkage   !! bodies, sliders, turns and drives
    type(equation_t), intent(in) :: equation !! one of its equations
    type(pose_t), intent(in) :: pose         !! pins and directions
    real(wp), intent(in) :: crank            !! coordinate of the first drive [deg] or [m]
    real(wp) :: misfit

    type(coordinate_t) :: coordinate
    type(evaluated_t) :: evaluated
    real(wp) :: target
    logical :: is_turning

    coordinate = held_coordinate(linkage, equation)
    target = 0.0_wp
    if (equation%kind == demand_length) target = norm2(equation%place)
    if (equation%kind == demand_drive) then
      target = drive_value(linkage, equation%number, crank)
      if (coordinate%kind == is_angle) then
        coordinate%at(1)%direction = turned(coordinate%at(1)%direction, direction_at(target))
        target = 0.0_wp
      end if
    end if
    call evaluate(linkage, pose, coordinate, evaluated, as_placed=.true.)
    ! A sum of angles.
    is_turning = coordinate%kind == is_sum .and. equation%kind == demand_drive
    if (is_turning) is_turning = gives_angle(linkage%drives(equation%number))
    if (is_turning) target = target*degree
    misfit = evaluated%value - target
    if (is_turning) misfit = atan2(sin(misfit), cos(misfit))
  end function misfit_of

  !> Second derivative of an equation along the motion without second derivatives of the unknowns:
  !! q'ᵀ ∇²C q' [m per crank²].
  pure function curvature_of(linkage, equation, pose, motion) result(curvature)
    type(linkage_t), intent(in) :: linkage   !! bodies, sliders, turns and drives
    type(equation_t), intent(in) :: equation !! one of its equations
    type(pose_t), intent(in) :: pose         !! pins and directions
    type(kinematic_coefficients_t), intent(in) :: motion !! q'
    real(wp) :: curvature

    curvature = coordinate_acceleration(linkage, pose, motion, held_coordinate(linkage, equation), &
      of_rates_alone=.true.)
  end function curvature_of

  !> Direction and a point of the line of a slider.
  pure subroutine world_line(linkage, pose, number, direction, point)
    type(linkage_t), intent(in) :: linkage !! its sliders
    type(pose_t), intent(in) :: pose       !! of the body that has the line
    integer, intent(in) :: number          !! of the slider, from 1
    real(wp), intent(out) :: direction(2)  !! unit vector, global axes
    real(wp), intent(out) :: point(2)      !! counted as the pins of the pose [m]

    direction = line_axis(linkage, pose, number)
    associate (slider => linkage%sliders(number))
      if (slider%body > 0) then
        point = pose%pin(:, linkage%bodies(slider%body)%first_pin) + turned(slider%point, &
          pose%direction(:, slider%body))
      else
        point = slider%point - pose%origin
      end if
    end associate
  end subroutine world_line

  !> Direction of the line of a slider, global axes.
  pure function line_axis(linkage, pose, number) result(axis)
    type(linkage_t), intent(in) :: linkage !! its sliders
    type(pose_t), intent(in) :: pose       !! of the body that has the line
    integer, intent(in) :: number          !! of the slider, from 1
    real(wp) :: axis(2)

    associate (slider => linkage%sliders(number))
      axis = slider%direction
      if (slider%body > 0) axis = turned(axis, pose%direction(:, slider%body))
    end associate
  end function line_axis

  !> Distance of the line of a body from its first pin, positive if the pin lies to its right [m].
  pure function line_offset(linkage, number) result(offset)
    type(linkage_t), intent(in) :: linkage !! its sliders
    integer, intent(in) :: number          !! of a slider on a body
    real(wp) :: offset

    offset = cross(linkage%sliders(number)%direction, linkage%sliders(number)%point)
  end function line_offset

  !> Number of unknowns of a group: two of each pin, one of each body.
  pure function unknowns_of(group) result(number)
    type(group_t), intent(in) :: group !! its pins and bodies
    integer :: number

    number = 2*size(group%pins) + size(group%bodies)
  end function unknowns_of

  !> Distance of the farthest pin of a body from its first one [m].
  pure function farthest_arm(body) result(arm)
    type(body_t), intent(in) :: body !! with its pins
    real(wp) :: arm

    integer :: i

    arm = body%length
    do i = 1, size(body%further)
      arm = max(arm, norm2(body%further(i)%place))
    end do
  end function farthest_arm

end module group_equations
