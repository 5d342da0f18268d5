!> Values, rates and accelerations of coordinates, and what an effort along one puts on its
!! terminals.
!!
!! With kinematic coefficients in place of velocities and accelerations, rates and accelerations are
!! derivatives with respect to the coordinate of the first drive: s' and s''.
module coordinates
  use constants, only: degree
  use coordinate_types, only: coordinate_t, frame_t, is_across, is_along, is_angle, is_distance, &
    is_sum, partial_t, terminal_t, twist_t, wrench_t
  use distances, only: distance_acceleration, find_distance
  use drive_values, only: drive_value
  use kinds, only: wp
  use lines, only: line_acceleration, line_axis, line_couple, line_value
  use linkages, only: cross, gives_angle, linkage_t, turned
  use pose_types, only: kinematic_coefficients_t, pose_t
  use terminals, only: frames_of, places_of, terminal_acceleration, terminal_direction, twists_of
  implicit none (type, external)
  private

  public :: evaluated_t, evaluate, evaluated_rate
  public :: coordinate_value, coordinate_rate, coordinate_acceleration, terminal_count, &
    add_partials, slider_coordinate, is_turning

  !> A coordinate at a pose, found once for all that is asked of it there.
  type :: evaluated_t
    real(wp) :: value           !! [m] or [rad]
    type(wrench_t) :: wrench(2) !! what an effort of 1 along it puts on its terminals: the virtual
                                !! work of this is its change; 0 of a sum
  end type evaluated_t

contains

  !> What a coordinate is at a pose. The gradient of a sum is that of its terms.
  pure recursive subroutine evaluate(linkage, pose, coordinate, evaluated, crank, as_placed)
    type(linkage_t), intent(in) :: linkage !! its bodies, and the terms of a sum
    type(pose_t), intent(in) :: pose       !! positions and directions
    type(coordinate_t), intent(in) :: coordinate
    type(evaluated_t), intent(out) :: evaluated
    real(wp), intent(in), optional :: crank !! coordinate of the first drive, where several have
                                           !! one pose; absent: that of the pose [deg] or [m]
    logical, intent(in), optional :: as_placed !! as pins and bodies are, whatever a drive gives:
                                           !! an angle is from −π to π

    type(frame_t) :: frame(2)
    type(evaluated_t) :: term
    real(wp) :: place(2, 2), direction(2, 2), at
    logical :: is_given
    integer :: k

    is_given = coordinate%drive > 0
    if (present(as_placed)) is_given = is_given .and. .not. as_placed
    evaluated%value = 0.0_wp
    do k = 1, 2
      evaluated%wrench(k)%place = 0.0_wp
      evaluated%wrench(k)%force = 0.0_wp
      evaluated%wrench(k)%couple = 0.0_wp
    end do
    associate (value => evaluated%value, wrench => evaluated%wrench)
      select case (coordinate%kind)
      case (is_distance)
        place = places_of(linkage, pose, coordinate%at)
        wrench(1)%place = place(:, 1)
        wrench(2)%place = place(:, 2)
        call find_distance(place, value, wrench(2)%force)
        wrench(1)%force = -wrench(2)%force
      case (is_along, is_across)
        frame = frames_of(linkage, pose, coordinate%at)
        wrench(1)%place = frame(1)%place
        wrench(2)%place = frame(2)%place
        value = line_value(frame, coordinate%kind == is_across)
        wrench(2)%force = line_axis(frame, coordinate%kind == is_across)
        wrench(1)%force = -wrench(2)%force
        wrench(1)%couple = line_couple(frame, coordinate%kind == is_across)
      case (is_angle)
        if (.not. is_given) then
          direction(:, 1) = terminal_direction(pose, coordinate%at(1))
          direction(:, 2) = terminal_direction(pose, coordinate%at(2))
          ! Adding zero turns −0 into 0.
          value = atan2(cross(direction(:, 1), direction(:, 2)) + 0.0_wp, &
            dot_product(direction(:, 1), direction(:, 2)) + 0.0_wp)
        end if
        wrench(2)%couple = 1.0_wp
        wrench(1)%couple = -1.0_wp
      case (is_sum)
        do k = 1, size(coordinate%term)
          call evaluate(linkage, pose, linkage%coordinates(coordinate%term(k)), term, crank, &
            as_placed)
          value = value + coordinate%weight(k)*term%value
        end do
      end select
      if (.not. is_given) return
      at = pose%crank
      if (present(crank)) at = crank
      value = drive_value(linkage, coordinate%drive, at)
      if (gives_angle(linkage%drives(coordinate%drive))) value = value*degree
    end associate
  end subroutine evaluate

  !> Its value [m] or [rad].
  pure function coordinate_value(linkage, pose, coordinate, crank) result(value)
    type(linkage_t), intent(in) :: linkage !! as for `evaluate`, like all others
    type(pose_t), intent(in) :: pose
    type(coordinate_t), intent(in) :: coordinate
    real(wp), intent(in), optional :: crank
    real(wp) :: value

    type(evaluated_t) :: evaluated

    call evaluate(linkage, pose, coordinate, evaluated, crank)
    value = evaluated%value
  end function coordinate_value

  !> Its rate [m/s] or [rad/s].
  pure function coordinate_rate(linkage, pose, motion, coordinate) result(rate)
    type(linkage_t), intent(in) :: linkage !! as for `evaluate`
    type(pose_t), intent(in) :: pose
    type(kinematic_coefficients_t), intent(in) :: motion !! velocities of pins and bodies
    type(coordinate_t), intent(in) :: coordinate
    real(wp) :: rate

    type(evaluated_t) :: evaluated

    call evaluate(linkage, pose, coordinate, evaluated)
    rate = evaluated_rate(linkage, pose, motion, coordinate, evaluated)
  end function coordinate_rate

  !> The same where it is evaluated already: what its wrenches do on its terminals.
  pure recursive function evaluated_rate(linkage, pose, motion, coordinate, evaluated) result(rate)
    type(linkage_t), intent(in) :: linkage !! as for `evaluate`
    type(pose_t), intent(in) :: pose
    type(kinematic_coefficients_t), intent(in) :: motion !! velocities of pins and bodies
    type(coordinate_t), intent(in) :: coordinate
    type(evaluated_t), intent(in) :: evaluated !! of it, at this pose
    real(wp) :: rate

    type(twist_t) :: twist(2)
    integer :: i

    rate = 0.0_wp
    if (coordinate%kind == is_sum) then
      do i = 1, size(coordinate%term)
        rate = rate + coordinate%weight(i)*coordinate_rate(linkage, pose, motion, &
          linkage%coordinates(coordinate%term(i)))
      end do
      return
    end if
    twist = twists_of(linkage, pose, motion, coordinate%at)
    associate (wrench => evaluated%wrench)
      rate = dot_product(wrench(2)%force, twist(2)%velocity - twist(1)%velocity) + &
        wrench(1)%couple*twist(1)%turn + wrench(2)%couple*twist(2)%turn
    end associate
  end function evaluated_rate

  !> Its acceleration [m/s²] or [rad/s²]; of rates alone, with all pins and bodies moving evenly, it
  !! is q'ᵀ ∇²s q'.
  pure recursive function coordinate_acceleration(linkage, pose, motion, coordinate, &
    of_rates_alone) result(acceleration)
    type(linkage_t), intent(in) :: linkage !! as for `coordinate_value`
    type(pose_t), intent(in) :: pose       !! positions and directions
    type(kinematic_coefficients_t), intent(in) :: motion !! velocities and accelerations
    type(coordinate_t), intent(in) :: coordinate
    logical, intent(in), optional :: of_rates_alone !! accelerations are not there
    real(wp) :: acceleration

    type(twist_t) :: twist(2), slope(2)
    integer :: i

    acceleration = 0.0_wp
    if (coordinate%kind == is_sum) then
      do i = 1, size(coordinate%term)
        acceleration = acceleration + coordinate%weight(i)*coordinate_acceleration(linkage, pose, &
          motion, linkage%coordinates(coordinate%term(i)), of_rates_alone)
      end do
      return
    end if
    twist = twists_of(linkage, pose, motion, coordinate%at)
    do i = 1, 2
      slope(i) = terminal_acceleration(linkage, pose, motion, coordinate%at(i), of_rates_alone)
    end do
    select case (coordinate%kind)
    case (is_distance)
      acceleration = distance_acceleration(places_of(linkage, pose, coordinate%at), twist, slope)
    case (is_along, is_across)
      acceleration = line_acceleration(frames_of(linkage, pose, coordinate%at), twist, slope, &
        coordinate%kind == is_across)
    case (is_angle)
      acceleration = slope(2)%turn - slope(1)%turn
    end select
  end function coordinate_acceleration

  !> Number of its terminals.
  pure function terminal_count(coordinate) result(number)
    type(coordinate_t), intent(in) :: coordinate
    integer :: number

    number = 2
    if (coordinate%kind == is_sum) number = 2*size(coordinate%term)
  end function terminal_count

  !> Appends its derivatives, times a weight, to those of others.
  pure recursive subroutine add_partials(linkage, pose, coordinate, evaluated, weight, partials, &
    filled)
    type(linkage_t), intent(in) :: linkage     !! as for `evaluate`
    type(pose_t), intent(in) :: pose
    type(coordinate_t), intent(in) :: coordinate
    type(evaluated_t), intent(in) :: evaluated !! of it, at this pose
    real(wp), intent(in) :: weight             !! 1 of itself
    type(partial_t), intent(inout) :: partials(:) !! has room for one of each terminal
    integer, intent(inout) :: filled           !! how many of them are there

    type(evaluated_t) :: term
    integer :: i

    if (coordinate%kind == is_sum) then
      do i = 1, size(coordinate%term)
        associate (it => linkage%coordinates(coordinate%term(i)))
          call evaluate(linkage, pose, it, term, as_placed=.true.)
          call add_partials(linkage, pose, it, term, weight*coordinate%weight(i), partials, filled)
        end associate
      end do
      return
    end if
    do i = 1, 2
      associate (at => coordinate%at(i), wrench => evaluated%wrench(i))
        if (at%body == 0 .and. at%pin == 0) cycle
        filled = filled + 1
        associate (partial => partials(filled))
          partial%body = at%body
          partial%pin = at%pin
          partial%by_pin = weight*wrench%force
          partial%by_angle = 0.0_wp
          if (at%body == 0) cycle
          partial%by_angle = weight*wrench%couple
          if (coordinate%kind == is_angle) cycle
          partial%pin = linkage%bodies(at%body)%first_pin
          partial%by_angle = partial%by_angle + weight*cross(turned(at%place, pose%direction(:, &
            at%body)), wrench%force)
        end associate
      end associate
    end do
  end subroutine add_partials

  !> Whether it is an angle, not a length.
  pure function is_turning(linkage, coordinate) result(is)
    type(linkage_t), intent(in) :: linkage !! the terms of a sum
    type(coordinate_t), intent(in) :: coordinate
    logical :: is

    is = coordinate%kind == is_angle
    if (coordinate%kind == is_sum) is = linkage%coordinates(coordinate%term(1))%kind == is_angle
  end function is_turning

  !> The place of the pin of a slider along its line.
  pure function slider_coordinate(linkage, number) result(coordinate)
    type(linkage_t), intent(in) :: linkage !! its sliders
    integer, intent(in) :: number          !! of the slider, from 1
    type(coordinate_t) :: coordinate

    coordinate%kind = is_along
    associate (slider => linkage%sliders(number))
      coordinate%at(1) = terminal_t(body=slider%body, place=slider%point, &
        direction=slider%direction)
      coordinate%at(2)%pin = slider%pin
    end associate
  end function slider_coordinate

end module coordinates
