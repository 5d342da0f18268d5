!> The least and the greatest value, over a range of the first drive, of quantities of a linkage.
module crank_extremes
  use bridges, only: node_weights
  use constants, only: degree
  use coordinates, only: coordinate_rate, coordinate_value, slider_coordinate
  use crank_limits, only: crank_range_t
  use errors, only: error_t
  use group_equations, only: line_axis, line_offset
  use kinds, only: wp
  use kinematic_coefficients, only: find_kinematic_coefficients, kinematic_coefficients_t
  use linkages, only: cross, linkage_t
  use pose_types, only: pose_t
  use poses, only: body_angle, dead_point_sine, place_links, transmission_angle
  implicit none (type, external)
  private

  public :: quantity_t, extremes_t, find_extremes
  public :: angle_of_body, place_of_slider, transmission_of_dyad, pressure_of_slider, &
    transmission_of_lines, pressure_of_lever

  !> Kinds of quantities: the angle of a body; the place of a slider along its line; the angle of
  !! the two links of RRR, of the two lines of PRP and PPR; the angle between the force on a link
  !! and the motion of where it acts, of RRP and RPR.
  integer, parameter :: angle_of_body = 1, place_of_slider = 2, transmission_of_dyad = 3, &
    pressure_of_slider = 4, transmission_of_lines = 5, pressure_of_lever = 6

  !> A quantity that changes with the first drive.
  type :: quantity_t
    integer :: kind = angle_of_body
    integer :: number = 0 !! of the body, slider or group
  end type quantity_t

  !> Least and greatest value of a quantity, with the coordinates of the first drive there.
  type :: extremes_t
    real(wp) :: least = 0.0_wp, greatest = 0.0_wp !! [deg] or [m]
    real(wp) :: at_least = 0.0_wp, at_greatest = 0.0_wp
    real(wp) :: turned = 0.0_wp !! net change over a period [deg]; 0 if it returns
    integer :: reversals = 0    !! sign changes of its rate
  end type extremes_t

  !> What is known of a quantity on the way through a range.
  type :: walk_t
    logical :: has_last = .false. !! of the values behind
    real(wp) :: first = 0.0_wp, first_rate = 0.0_wp
    real(wp) :: c = 0.0_wp, value = 0.0_wp, rate = 0.0_wp
  end type walk_t

  integer, parameter :: most_halvings = 80

  !> What changes less than by rounding is constant: angles [deg], places as a share of the links.
  real(wp), parameter :: constant_angle = 1.0e-9_wp, constant_place = 1.0e-11_wp

contains

  !> Least and greatest values of quantities over a range. Of a constant they are the same.
  pure subroutine find_extremes(linkage, range, quantities, extremes)
    type(linkage_t), intent(in) :: linkage          !! of any kind, with its path
    type(crank_range_t), intent(in) :: range        !! one of `find_ranges`
    type(quantity_t), intent(in) :: quantities(:)   !! which
    type(extremes_t), intent(out) :: extremes(:)    !! (quantities) over the range

    type(walk_t) :: walks(size(quantities))
    type(pose_t) :: pose
    type(kinematic_coefficients_t) :: coefficients
    real(wp), dimension(size(quantities)) :: value, rate
    real(wp) :: c
    logical :: is_fine
    integer :: i, q

    do i = 0, range%samples
      c = range%from + (range%to - range%from)*i/range%samples
      call place(linkage, c, pose, coefficients, is_fine)
      if (.not. is_fine .and. .not. (i == 0 .or. i == range%samples)) cycle
      do q = 1, size(quantities)
        call measure(linkage, quantities(q), pose, coefficients, value(q), rate(q))
      end do
      if (.not. is_fine) call look_ahead(linkage, quantities, range, i == 0, value)
      do q = 1, size(quantities)
        call go_on(linkage, quantities(q), c, value(q), rate(q), is_fine, walks(q), extremes(q))
      end do
    end do
    do q = 1, size(quantities)
      call finish(linkage, range, quantities(q), walks(q), extremes(q))
    end do
  end subroutine find_extremes

  !> Takes the next sample of a quantity, and what is extreme between it and the last one.
  pure subroutine go_on(linkage, quantity, c, value, rate, is_fine, walk, extremes)
    type(linkage_t), intent(in) :: linkage
    type(quantity_t), intent(in) :: quantity
    real(wp), intent(in) :: c, value, rate
    logical, intent(in) :: is_fine         !! there is a rate
    type(walk_t), intent(inout) :: walk
    type(extremes_t), intent(inout) :: extremes

    real(wp) :: here, low, high, low_rate, middle, middle_value, middle_rate, tried
    logical :: is_middle_fine
    integer :: k

    here = value
    if (walk%has_last) then
      here = unwrapped(quantity, value, walk%value)
    else
      walk%first = value
      extremes%least = value
      extremes%greatest = value
      extremes%at_least = c
      extremes%at_greatest = c
    end if
    call take(extremes, c, here)
    if (walk%has_last .and. is_fine .and. rate*walk%rate < 0.0_wp) then
      extremes%reversals = extremes%reversals + 1
      low = walk%c
      high = c
      low_rate = walk%rate
      middle = c
      middle_value = value
      do k = 1, most_halvings
        middle = 0.5_wp*(low + high)
        if (abs(high - low) <= 2.0_wp*spacing(abs(middle))) exit
        call evaluate(linkage, quantity, middle, tried, middle_rate, is_middle_fine)
        if (.not. is_middle_fine) exit
        middle_value = tried
        if (middle_rate*low_rate > 0.0_wp) then
          low = middle
        else
          high = middle
        end if
      end do
      call take(extremes, middle, unwrapped(quantity, middle_value, walk%value))
    end if
    walk%value = here
    ! A rate of zero has no sign to compare with: the next one is compared with the last that has.
    if (walk%has_last .and. is_fine .and. abs(rate) <= 0.0_wp) return
    walk%has_last = .true.
    walk%c = c
    walk%rate = merge(rate, 0.0_wp, is_fine)
    if (.not. abs(walk%first_rate) > 0.0_wp) walk%first_rate = walk%rate
  end subroutine go_on

  !> What is known at the end of a range.
  pure subroutine finish(linkage, range, quantity, walk, extremes)
    type(linkage_t), intent(in) :: linkage
    type(crank_range_t), intent(in) :: range
    type(quantity_t), intent(in) :: quantity
    type(walk_t), intent(in) :: walk
    type(extremes_t), intent(inout) :: extremes

    real(wp) :: constant

    ! It may turn back where a turn begins.
    if (range%turns .and. walk%first_rate*walk%rate < 0.0_wp) extremes%reversals = &
      extremes%reversals + 1
    if (range%turns .and. quantity%kind == angle_of_body) extremes%turned = &
      360.0_wp*anint((walk%value - walk%first)/360.0_wp)
    constant = constant_angle
    if (quantity%kind == place_of_slider) constant = constant_place*maxval(linkage%bodies%length)
    if (extremes%greatest - extremes%least > constant) return
    extremes%greatest = extremes%least
    extremes%at_greatest = extremes%at_least
    extremes%reversals = 0
  end subroutine finish

  !> Quantities at an end of a range where there is no rate: those to which places inside lead.
  !! There solving loses half the digits, and where the pins that carry a dyad meet its direction is
  !! rounding; but all is smooth in the root of the distance from a limit.
  pure subroutine look_ahead(linkage, quantities, range, is_first, value)
    type(linkage_t), intent(in) :: linkage
    type(quantity_t), intent(in) :: quantities(:)
    type(crank_range_t), intent(in) :: range
    logical, intent(in) :: is_first          !! the end is the lower one
    real(wp), intent(inout) :: value(:)      !! (quantities) as placed there

    integer, parameter :: nodes = 8
    !> Roots of the distance of the nearest place, as shares of the range: nearer places are
    !! rounded more, with others the polynomial is less exact.
    real(wp), parameter :: nearest(*) = [0.01_wp, 0.02_wp, 0.04_wp]
    type(pose_t) :: pose
    type(kinematic_coefficients_t) :: coefficients
    real(wp) :: near(nodes, size(value)), root(nodes), weight(nodes, 0:2), fewer(nodes - 1, 0:2), &
      found, error, least(size(value)), rate, way
    logical :: is_fine
    integer :: i, k, q

    least = huge(1.0_wp)
    do i = 1, size(nearest)
      root = [(nearest(i)*k, k=1, nodes)]
      do k = 1, nodes
        way = (range%to - range%from)*root(k)**2
        call place(linkage, merge(range%from + way, range%to - way, is_first), pose, coefficients, &
          is_fine)
        if (.not. is_fine) exit
        do q = 1, size(value)
          call measure(linkage, quantities(q), pose, coefficients, near(k, q), rate)
          near(k, q) = unwrapped(quantities(q), near(k, q), near(1, q))
        end do
      end do
      if (.not. is_fine) cycle
      weight = node_weights(root, 0.0_wp)
      fewer = node_weights(root(:nodes - 1), 0.0_wp)
      do q = 1, size(value)
        found = dot_product(weight(:, 0), near(:, q))
        error = abs(found - dot_product(fewer(:, 0), near(:nodes - 1, q)))
        if (error >= least(q)) cycle
        least(q) = error
        value(q) = found
      end do
    end do
  end subroutine look_ahead

  pure subroutine take(extremes, c, value)
    type(extremes_t), intent(inout) :: extremes
    real(wp), intent(in) :: c, value

    if (value < extremes%least) then
      extremes%least = value
      extremes%at_least = c
    end if
    if (value > extremes%greatest) then
      extremes%greatest = value
      extremes%at_greatest = c
    end if
  end subroutine take

  !> Angles of bodies go on past half turns.
  pure function unwrapped(quantity, value, last) result(near)
    type(quantity_t), intent(in) :: quantity
    real(wp), intent(in) :: value, last
    real(wp) :: near

    near = value
    if (quantity%kind == angle_of_body) near = value - 360.0_wp*anint((value - last)/360.0_wp)
  end function unwrapped

  !> A quantity and its rate, up to a positive factor, at a coordinate. Not fine near dead points,
  !! where there is no rate, and out of reach, where there is no value.
  pure subroutine evaluate(linkage, quantity, c, value, rate, is_fine)
    type(linkage_t), intent(in) :: linkage
    type(quantity_t), intent(in) :: quantity
    real(wp), intent(in) :: c
    real(wp), intent(out) :: value, rate
    logical, intent(out) :: is_fine

    type(pose_t) :: pose
    type(kinematic_coefficients_t) :: coefficients

    call place(linkage, c, pose, coefficients, is_fine)
    call measure(linkage, quantity, pose, coefficients, value, rate)
  end subroutine evaluate

  !> A pose and its coefficients; without these near dead points, and without both out of reach.
  pure subroutine place(linkage, c, pose, coefficients, is_fine)
    type(linkage_t), intent(in) :: linkage
    real(wp), intent(in) :: c
    type(pose_t), intent(out) :: pose
    type(kinematic_coefficients_t), intent(out) :: coefficients
    logical, intent(out) :: is_fine !! neither of the two

    type(error_t), allocatable :: error

    call place_links(linkage, c, pose, error)
    is_fine = .not. allocated(error)
    if (.not. is_fine) then
      if (allocated(pose%pin)) deallocate (pose%pin)
      return
    end if
    is_fine = all(abs(pose%sine) > dead_point_sine) .or. allocated(pose%coefficients)
    if (is_fine) then
      coefficients = find_kinematic_coefficients(linkage, pose)
    else
      ! The rates are of no use, but they are asked for.
      allocate (coefficients%turn(size(linkage%bodies)), &
        coefficients%pin(2, size(linkage%is_ground)), source=0.0_wp)
    end if
  end subroutine place

  !> A quantity and its rate, up to a positive factor, of a pose; 0 without one.
  pure subroutine measure(linkage, quantity, pose, coefficients, value, rate)
    type(linkage_t), intent(in) :: linkage
    type(quantity_t), intent(in) :: quantity
    type(pose_t), intent(in) :: pose
    type(kinematic_coefficients_t), intent(in) :: coefficients
    real(wp), intent(out) :: value, rate

    value = 0.0_wp
    rate = 0.0_wp
    if (.not. allocated(pose%pin)) return
    select case (quantity%kind)
    case (angle_of_body)
      value = body_angle(linkage, pose, quantity%number)/degree
      rate = coefficients%turn(quantity%number)
    case (place_of_slider)
      value = coordinate_value(linkage, pose, slider_coordinate(linkage, quantity%number))
      rate = coordinate_rate(linkage, pose, coefficients, slider_coordinate(linkage, &
        quantity%number))
    case default
      call evaluate_group(linkage, quantity, pose, coefficients, value, rate)
    end select
  end subroutine measure

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

end module crank_extremes
