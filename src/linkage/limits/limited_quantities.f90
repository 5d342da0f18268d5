!> Quantities whose least and greatest value over a range of the first drive is told: what they are
!! at a pose, and how they change there.
module limited_quantities
  use constants, only: degree
  use coordinate_types, only: coordinate_t, is_sum
  use coordinates, only: coordinate_rate, coordinate_value, slider_coordinate, turns => is_turning
  use group_equations, only: line_axis, line_offset
  use kinds, only: wp
  use linkages, only: cross, linkage_t
  use pose_types, only: kinematic_coefficients_t, pose_t
  use poses, only: body_angle, transmission_angle
  implicit none (type, external)
  private

  public :: quantity_t, measure, total, unwrapped, most_terms, is_a_sum, is_turning
  public :: angle_of_body, place_of_slider, transmission_of_dyad, pressure_of_slider, &
    transmission_of_lines, pressure_of_lever, value_of_coordinate

  !> Kinds of quantities: the angle of a body; the place of a slider along its line; the angle of
  !! the two links of RRR, of the two lines of PRP and PPR; the angle between the force on a link
  !! and the motion of where it acts, of RRP and RPR; the value of a coordinate.
  integer, parameter :: angle_of_body = 1, place_of_slider = 2, transmission_of_dyad = 3, &
    pressure_of_slider = 4, transmission_of_lines = 5, pressure_of_lever = 6, &
    value_of_coordinate = 7

  !> A quantity that changes with the first drive. It is the sum of its terms: of most one only.
  type :: quantity_t
    integer :: kind = angle_of_body
    integer :: number = 0 !! of the body, slider, group or coordinate
  end type quantity_t

contains

  !> A quantity and its rate, up to a positive factor, of a pose; 0 without one.
  pure subroutine measure(linkage, quantity, pose, coefficients, value, rate)
    type(linkage_t), intent(in) :: linkage
    type(quantity_t), intent(in) :: quantity
    type(pose_t), intent(in) :: pose
    type(kinematic_coefficients_t), intent(in) :: coefficients
    real(wp), intent(out) :: value(:) !! (terms) [deg] or [m]
    real(wp), intent(out) :: rate     !! of all terms together

    value = 0.0_wp
    rate = 0.0_wp
    if (.not. allocated(pose%pin)) return
    select case (quantity%kind)
    case (angle_of_body)
      value(1) = body_angle(linkage, pose, quantity%number)/degree
      rate = coefficients%turn(quantity%number)
    case (place_of_slider)
      value(1) = coordinate_value(linkage, pose, slider_coordinate(linkage, quantity%number))
      rate = coordinate_rate(linkage, pose, coefficients, slider_coordinate(linkage, &
        quantity%number))
    case (value_of_coordinate)
      call evaluate_terms(linkage, pose, linkage%coordinates(quantity%number), value)
      if (is_turning(linkage, quantity)) value = value/degree
      rate = coordinate_rate(linkage, pose, coefficients, linkage%coordinates(quantity%number))
    case default
      call evaluate_group(linkage, quantity, pose, coefficients, value(1), rate)
    end select
  end subroutine measure

  !> The values of the terms of a coordinate [m] or [rad].
  pure subroutine evaluate_terms(linkage, pose, coordinate, value)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    type(coordinate_t), intent(in) :: coordinate
    real(wp), intent(inout) :: value(:) !! (terms)

    integer :: i

    if (coordinate%kind /= is_sum) then
      value(1) = coordinate_value(linkage, pose, coordinate)
      return
    end if
    do i = 1, size(coordinate%term)
      value(i) = coordinate_value(linkage, pose, linkage%coordinates(coordinate%term(i)))
    end do
  end subroutine evaluate_terms

  !> The transmission or pressure angle of a group, and its rate up to a positive factor.
  pure subroutine evaluate_group(linkage, quantity, pose, coefficients, value, rate)
    type(linkage_t), intent(in) :: linkage
    type(quantity_t), intent(in) :: quantity
    type(pose_t), intent(in) :: pose
    type(kinematic_coefficients_t), intent(in) :: coefficients
    real(wp), intent(out) :: value, rate

    real(wp) :: axis(2), other(2), point(2), distance

    associate (group => linkage%groups(quantity%number), h => coefficients%turn, &
        sine => pose%sine(quantity%number))
      select case (quantity%kind)
      case (transmission_of_dyad)
        value = transmission_angle(linkage, pose, quantity%number)/degree
        rate = (h(group%body(2)) - h(group%body(1)))*sign(1.0_wp, sine)
      case (pressure_of_slider)
        value = acos(min(1.0_wp, abs(sine)))/degree
        rate = h(group%body(1)) - turn_of_line(group%slider(1))
      case (transmission_of_lines)
        axis = line_axis(linkage, pose, group%slider(1))
        other = line_axis(linkage, pose, group%slider(2))
        value = atan2(abs(cross(axis, other)), abs(dot_product(axis, other)))/degree
        rate = (turn_of_line(group%slider(2)) - turn_of_line(group%slider(1)))* &
          sign(1.0_wp, cross(axis, other))*sign(1.0_wp, dot_product(axis, other))
      case default
        ! The force is across the line, the motion across the way from the pivot to the block.
        point = pose%pin(:, group%middle) - pose%pin(:, group%base(1))
        distance = norm2(point)
        value = asin(min(1.0_wp, abs(line_offset(linkage, group%slider(1)))/distance))/degree
        rate = -dot_product(point, coefficients%pin(:, group%middle) - &
          coefficients%pin(:, group%base(1)))
      end select
    end associate

  contains

    !> Turn of the line of a slider; 0 of a fixed one.
    pure function turn_of_line(number) result(turn)
      integer, intent(in) :: number !! of the slider
      real(wp) :: turn

      turn = 0.0_wp
      if (linkage%sliders(number)%body > 0) turn = coefficients%turn(linkage%sliders(number)%body)
    end function turn_of_line

  end subroutine evaluate_group

  !> Angles go on past half turns.
  pure function unwrapped(linkage, quantity, value, last) result(near)
    type(linkage_t), intent(in) :: linkage
    type(quantity_t), intent(in) :: quantity
    real(wp), intent(in) :: value(:), last(:) !! (terms)
    real(wp) :: near(size(value))

    near = value
    if (is_turning(linkage, quantity)) near = value - 360.0_wp*anint((value - last)/360.0_wp)
  end function unwrapped

  !> The value of a quantity whose terms are known: Σ w s of a sum of coordinates.
  pure function total(linkage, quantity, value)
    type(linkage_t), intent(in) :: linkage
    type(quantity_t), intent(in) :: quantity
    real(wp), intent(in) :: value(:) !! (terms)
    real(wp) :: total

    integer :: i

    total = value(1)
    if (.not. is_a_sum(linkage, quantity)) return
    total = 0.0_wp
    associate (weight => linkage%coordinates(quantity%number)%weight)
      do i = 1, size(weight)
        total = total + weight(i)*value(i)
      end do
    end associate
  end function total

  !> Whether a quantity is a sum of coordinates.
  pure function is_a_sum(linkage, quantity)
    type(linkage_t), intent(in) :: linkage
    type(quantity_t), intent(in) :: quantity
    logical :: is_a_sum

    is_a_sum = quantity%kind == value_of_coordinate
    if (is_a_sum) is_a_sum = linkage%coordinates(quantity%number)%kind == is_sum
  end function is_a_sum

  !> Whether a quantity may go round: an angle of a body or between terminals, or a sum of these.
  pure function is_turning(linkage, quantity)
    type(linkage_t), intent(in) :: linkage
    type(quantity_t), intent(in) :: quantity
    logical :: is_turning

    is_turning = quantity%kind == angle_of_body
    if (quantity%kind == value_of_coordinate) is_turning = turns(linkage, &
      linkage%coordinates(quantity%number))
  end function is_turning

  !> The room that the terms of any of the quantities need.
  pure function most_terms(linkage, quantities) result(most)
    type(linkage_t), intent(in) :: linkage
    type(quantity_t), intent(in) :: quantities(:)
    integer :: most

    integer :: q

    most = 1
    do q = 1, size(quantities)
      if (is_a_sum(linkage, quantities(q))) most = max(most, size(linkage%coordinates( &
        quantities(q)%number)%term))
    end do
  end function most_terms

end module limited_quantities
