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
  use kinds, only: wp
  use linkages, only: body_t, cross, demand_angle, demand_drive, demand_length, demand_line, &
    demand_turn, drive_of_angle, drive_of_length, drive_of_slider, equation_t, group_t, &
    linkage_t, normal_to, turned
  use pose_types, only: pose_t
  implicit none (type, external)
  private

  public :: gradient_t, find_gradient, misfit_of, curvature_of, unknowns_of, &
    world_line, line_axis, line_offset, farthest_arm

  !> Derivatives of an equation by the positions of up to two pins and the angles of up to two
  !! bodies.
  type :: gradient_t
    integer :: pin(2) = 0                    !! 0: none
    integer :: body(2) = 0                   !! 0: none
    real(wp) :: by_pin(2, 2) = 0.0_wp        !! (2, pins) [-]
    real(wp) :: by_angle(2) = 0.0_wp         !! (bodies) [m], or [-] of equations between angles
  end type gradient_t

contains

  !> Gradient of an equation at a pose.
  pure subroutine find_gradient(linkage, equation, pose, gradient)
    type(linkage_t), intent(in) :: linkage        !! bodies, sliders, turns and drives
    type(equation_t), intent(in) :: equation      !! one of its equations
    type(pose_t), intent(in) :: pose              !! pins and directions
    type(gradient_t), intent(out) :: gradient     !! of its misfit

    real(wp) :: axis(2)

    select case (equation%kind)
    case (demand_length)
      call of_distance(linkage, pose, equation%body, equation%pin, gradient)
    case (demand_angle)
      axis = turned(equation%place, pose%direction(:, equation%body))
      axis = normal_to(axis/norm2(axis))
      call along_body(linkage, pose, equation%body, equation%pin, axis, gradient)
    case (demand_line)
      call on_line(linkage, pose, equation%number, .true., gradient)
    case (demand_turn)
      gradient%body = [linkage%turns(equation%number)%body, &
        linkage%turns(equation%number)%against]
      gradient%by_angle = [1.0_wp, -1.0_wp]
    case (demand_drive)
      associate (drive => linkage%drives(equation%number))
        select case (drive%kind)
        case (drive_of_angle)
          gradient%body = [drive%body, drive%against]
          gradient%by_angle = [1.0_wp, -1.0_wp]
        case (drive_of_slider)
          call on_line(linkage, pose, drive%slider, .false., gradient)
        case (drive_of_length)
          call of_distance(linkage, pose, drive%body, linkage%bodies(drive%body)%last_pin, &
            gradient)
        end select
      end associate
    end select
  end subroutine find_gradient

  !> `|u|` with u from the first pin of a body to another one.
  pure subroutine of_distance(linkage, pose, body, pin, gradient)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    integer, intent(in) :: body !! number
    integer, intent(in) :: pin  !! at the end of u
    type(gradient_t), intent(inout) :: gradient

    real(wp) :: u(2), distance

    u = pose%pin(:, pin) - pose%pin(:, linkage%bodies(body)%first_pin)
    distance = norm2(u)
    if (distance > 0.0_wp) then
      u = u/distance
    else
      u = pose%direction(:, body)
    end if
    gradient%pin = [pin, linkage%bodies(body)%first_pin]
    gradient%by_pin(:, 1) = u
    gradient%by_pin(:, 2) = -u
    gradient%body(1) = body
  end subroutine of_distance

  !> `e·u` with e turning with a body, and u from its first pin to another one.
  pure subroutine along_body(linkage, pose, body, pin, e, gradient)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    integer, intent(in) :: body !! number
    integer, intent(in) :: pin  !! at the end of u
    real(wp), intent(in) :: e(2)
    type(gradient_t), intent(inout) :: gradient

    gradient%pin = [pin, linkage%bodies(body)%first_pin]
    gradient%by_pin(:, 1) = e
    gradient%by_pin(:, 2) = -e
    gradient%body(1) = body
    gradient%by_angle(1) = dot_product(normal_to(e), pose%pin(:, pin) - pose%pin(:, &
      linkage%bodies(body)%first_pin))
  end subroutine along_body

  !> Across the line of a slider, or along it.
  pure subroutine on_line(linkage, pose, number, is_across, gradient)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    integer, intent(in) :: number !! of the slider
    logical, intent(in) :: is_across
    type(gradient_t), intent(inout) :: gradient

    real(wp) :: e(2)

    associate (slider => linkage%sliders(number))
      e = line_axis(linkage, pose, number)
      if (is_across) e = normal_to(e)
      if (slider%body > 0) then
        call along_body(linkage, pose, slider%body, slider%pin, e, gradient)
      else
        gradient%pin(1) = slider%pin
        gradient%by_pin(:, 1) = e
      end if
    end associate
  end subroutine on_line

  !> By how much an equation is not fulfilled [m], or [rad] between angles.
  pure function misfit_of(linkage, equation, pose, crank) result(misfit)
    type(linkage_t), intent(in) :: linkage   !! bodies, sliders, turns and drives
    type(equation_t), intent(in) :: equation !! one of its equations
    type(pose_t), intent(in) :: pose         !! pins and directions
    real(wp), intent(in) :: crank            !! coordinate of the first drive [deg] or [m]
    real(wp) :: misfit

    real(wp) :: axis(2), u(2), wanted(2), found(2)

    misfit = 0.0_wp
    select case (equation%kind)
    case (demand_length)
      u = pose%pin(:, equation%pin) - pose%pin(:, linkage%bodies(equation%body)%first_pin)
      misfit = norm2(u) - norm2(equation%place)
    case (demand_angle)
      axis = turned(equation%place, pose%direction(:, equation%body))
      u = pose%pin(:, equation%pin) - pose%pin(:, linkage%bodies(equation%body)%first_pin)
      misfit = cross(axis, u)/norm2(axis)
    case (demand_line)
      call world_line(linkage, pose, equation%number, axis, u)
      misfit = cross(axis, pose%pin(:, linkage%sliders(equation%number)%pin) - u)
    case (demand_turn)
      associate (turn => linkage%turns(equation%number))
        wanted = turn%relative
        if (turn%against > 0) wanted = turned(wanted, pose%direction(:, turn%against))
        found = pose%direction(:, turn%body)
      end associate
      misfit = atan2(cross(wanted, found), dot_product(wanted, found))
    case (demand_drive)
      associate (drive => linkage%drives(equation%number))
        select case (drive%kind)
        case (drive_of_angle)
          wanted = drive_direction(linkage, equation%number, pose, crank)
          found = pose%direction(:, drive%body)
          misfit = atan2(cross(wanted, found), dot_product(wanted, found))
        case (drive_of_slider)
          call world_line(linkage, pose, drive%slider, axis, u)
          misfit = dot_product(axis, pose%pin(:, linkage%sliders(drive%slider)%pin) - u) - &
            drive_value(linkage, equation%number, crank)
        case (drive_of_length)
          u = pose%pin(:, linkage%bodies(drive%body)%last_pin) - pose%pin(:, &
            linkage%bodies(drive%body)%first_pin)
          misfit = norm2(u) - drive_value(linkage, equation%number, crank)
        end select
      end associate
    end select
  end function misfit_of

  !> Second derivative of an equation along the motion without second derivatives of the unknowns:
  !! q'ᵀ ∇²C q' [m per crank²].
  pure function curvature_of(linkage, equation, pose, turn, pin_rate) result(curvature)
    type(linkage_t), intent(in) :: linkage   !! bodies, sliders, turns and drives
    type(equation_t), intent(in) :: equation !! one of its equations
    type(pose_t), intent(in) :: pose         !! pins and directions
    real(wp), intent(in) :: turn(:)          !! (bodies) h
    real(wp), intent(in) :: pin_rate(:, :)   !! (2, pins) [m]
    real(wp) :: curvature

    type(gradient_t) :: gradient
    real(wp) :: e(2), u(2), w(2), h

    curvature = 0.0_wp
    call find_gradient(linkage, equation, pose, gradient)
    ! Only distances, and those along or across the axis of a body that turns.
    if (gradient%pin(1) == 0 .or. gradient%body(1) == 0) return
    e = gradient%by_pin(:, 1)
    h = turn(gradient%body(1))
    u = pose%pin(:, gradient%pin(1)) - pose%pin(:, gradient%pin(2))
    w = pin_rate(:, gradient%pin(1)) - pin_rate(:, gradient%pin(2))
    if (is_distance(linkage, equation)) then
      curvature = cross(e, w)**2/norm2(u)
      return
    end if
    curvature = 2.0_wp*h*dot_product(normal_to(e), w) - h**2*dot_product(e, u)
  end function curvature_of

  !> Whether an equation is about a distance, whatever the angle of the body between its ends.
  pure function is_distance(linkage, equation) result(is)
    type(linkage_t), intent(in) :: linkage
    type(equation_t), intent(in) :: equation
    logical :: is

    is = equation%kind == demand_length
    if (equation%kind == demand_drive) is = linkage%drives(equation%number)%kind == drive_of_length
  end function is_distance

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
