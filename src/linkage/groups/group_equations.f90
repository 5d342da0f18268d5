! src/linkage/groups/ - positions, velocities and accelerations of a linkage, group after group.
! In: a planned `linkage_t`, the coordinate of its first drive. Out: a `pose_t`, its
! `kinematic_coefficients_t`. Begin with `find_pose` in `poses.f90` and
! `find_kinematic_coefficients` in `kinematic_coefficients.f90`. The constraint equations are here,
! with their gradients.
! Not here: the order of the groups (`src/linkage/plan`), ways through change points
! (`src/linkage/limits`).

!> What pins of bodies, sliders, turns and drives demand of the pose: misfits and gradients. Second
!! derivatives along the motion are those of the coordinates that they hold.
!!
!! The unknowns of a group are the positions of its pins and the angles of its bodies. With u from
!! the first pin of a body to another one, and n the normal of the unit vector there, which turns
!! with the body, the pin demands `|u| = r` and `n·u = 0`; a pin on the line of a body `m·u = c`
!! with the normal m of the line. The distance does not depend on the angle: a group may place pins
!! before the bodies between them are turned. One matrix of gradients serves positions (Newton),
!! velocities and accelerations, and, transposed, the forces.
module group_equations
  use constants, only: degree
  use coordinate_types, only: coordinate_t, gradients_t, is_angle
  use coordinates, only: add_partials, evaluate, evaluated_t, terminal_count
  use drive_values, only: direction_at, drive_value
  use kinds, only: wp
  use linkages, only: body_t, cross, demand_drive, demand_length, equation_t, gives_angle, &
    group_t, linkage_t, turned
  use pose_types, only: pose_t
  implicit none (type, external)
  private

  public :: find_gradients, misfit_of, unknowns_of, world_line, line_axis, line_offset, farthest_arm

contains

  !> Gradients of equations at a pose, and by how much these are not fulfilled.
  pure subroutine find_gradients(linkage, pose, equations, gradients, crank, misfits)
    type(linkage_t), intent(in) :: linkage          !! bodies and drives
    type(pose_t), intent(in) :: pose                !! pins and directions
    type(equation_t), intent(in) :: equations(:)    !! of this linkage
    type(gradients_t), intent(out) :: gradients     !! of their misfits
    real(wp), intent(in), optional :: crank         !! as of `misfit_of`
    real(wp), intent(out), optional :: misfits(:)   !! (equations) [m], or [rad] between angles

    type(evaluated_t) :: evaluated
    integer :: i, filled

    filled = 0
    do i = 1, size(equations)
      filled = filled + terminal_count(equations(i)%coordinate)
    end do
    allocate (gradients%last(0:size(equations)), gradients%partial(filled))
    filled = 0
    gradients%last(0) = 0
    do i = 1, size(equations)
      associate (coordinate => equations(i)%coordinate)
        call evaluate(linkage, pose, coordinate, evaluated, as_placed=.true.)
        call add_partials(linkage, pose, coordinate, evaluated, 1.0_wp, gradients%partial, filled)
      end associate
      gradients%last(i) = filled
      if (present(misfits)) misfits(i) = misfit_at(linkage, equations(i), pose, crank, evaluated)
    end do
  end subroutine find_gradients

  !> By how much an equation is not fulfilled [m], or [rad] between angles.
  pure function misfit_of(linkage, equation, pose, crank) result(misfit)
    type(linkage_t), intent(in) :: linkage   !! bodies, sliders, turns and drives
    type(equation_t), intent(in) :: equation !! one of its equations
    type(pose_t), intent(in) :: pose         !! pins and directions
    real(wp), intent(in) :: crank            !! coordinate of the first drive [deg] or [m]
    real(wp) :: misfit

    type(evaluated_t) :: evaluated

    call evaluate(linkage, pose, equation%coordinate, evaluated, as_placed=.true.)
    misfit = misfit_at(linkage, equation, pose, crank, evaluated)
  end function misfit_of

  !> The same where its coordinate is evaluated already.
  pure function misfit_at(linkage, equation, pose, crank, evaluated) result(misfit)
    type(linkage_t), intent(in) :: linkage
    type(equation_t), intent(in) :: equation
    type(pose_t), intent(in) :: pose
    real(wp), intent(in) :: crank
    type(evaluated_t), intent(in) :: evaluated
    real(wp) :: misfit

    type(coordinate_t) :: coordinate
    type(evaluated_t) :: turned_back
    real(wp) :: target

    select case (equation%kind)
    case (demand_length)
      misfit = evaluated%value - norm2(equation%place)
    case (demand_drive)
      target = drive_value(linkage, equation%number, crank)
      if (equation%coordinate%kind == is_angle) then
        ! Whole turns are nothing, and lose no digit.
        coordinate = equation%coordinate
        coordinate%at(1)%direction = turned(coordinate%at(1)%direction, direction_at(target))
        call evaluate(linkage, pose, coordinate, turned_back, as_placed=.true.)
        misfit = turned_back%value
      else if (gives_angle(linkage%drives(equation%number))) then
        misfit = evaluated%value - target*degree
        misfit = atan2(sin(misfit), cos(misfit))
      else
        misfit = evaluated%value - target
      end if
    case default
      misfit = evaluated%value
    end select
  end function misfit_at

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
