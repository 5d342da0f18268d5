!> Where the first drive can be, and the extremes over it of quantities of the linkage.
module crank_limits
  use constants, only: degree
  use errors, only: error_t
  use kinds, only: wp
  use kinematic_coefficients, only: find_kinematic_coefficients, kinematic_coefficients_t
  use linkage_paths, only: period_of
  use linkages, only: drives_angle, linkage_t
  use pose_types, only: pose_t
  use poses, only: body_angle, dead_point_sine, find_pose, place_links, transmission_angle
  implicit none (type, external)
  private

  public :: crank_range_t, quantity_t, extremes_t, find_ranges, find_extremes, &
    turns_fully
  public :: angle_of_body, place_of_slider, transmission_of_dyad, pressure_of_slider

  !> An interval of the first drive in which the linkage closes on its branch.
  type :: crank_range_t
    real(wp) :: from = 0.0_wp, to = 0.0_wp !! [deg] or [m]
    logical :: turns = .false.             !! a whole period, without limits
    integer :: blocked_by(2) = 0           !! groups that end it; 0: none
    integer :: left_at(2) = 0              !! pins of blocks that there leave their links; 0: none
  end type crank_range_t

  !> Kinds of quantities.
  integer, parameter :: angle_of_body = 1, place_of_slider = 2, transmission_of_dyad = 3, &
    pressure_of_slider = 4

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

  !> Samples of a range; extremes between them are found to rounding where the rate changes its sign
  !! once.
  integer, parameter :: samples = 720

  integer, parameter :: most_halvings = 80

contains

  !> The intervals in which the linkage closes; of a driven length, that around a given coordinate.
  pure subroutine find_ranges(linkage, inside, ranges)
    type(linkage_t), intent(in) :: linkage                      !! of any kind, with its path
    real(wp), intent(in) :: inside                              !! a coordinate of the deck [deg] or
                                                                !! [m]
    type(crank_range_t), allocatable, intent(out) :: ranges(:)  !! ascending; none if it closes
                                                                !! nowhere

    type(crank_range_t) :: range
    real(wp) :: step, c, period, first
    logical :: closes(0:samples)
    integer :: i, k

    allocate (ranges(0))
    period = period_of(linkage)
    if (linkage%drives(1)%kind /= drives_angle .or. period <= 0.0_wp) then
      if (.not. is_closed(linkage, inside)) return
      step = 360.0_wp/samples
      if (linkage%drives(1)%kind /= drives_angle) step = maxval(linkage%bodies%length)/samples
      call find_end(linkage, inside, -step, range%blocked_by(1), range%left_at(1), range%from)
      call find_end(linkage, inside, step, range%blocked_by(2), range%left_at(2), range%to)
      ranges = [range]
      return
    end if
    do i = 0, samples
      closes(i) = is_closed(linkage, period*i/samples)
    end do
    if (all(closes)) then
      range%to = period
      range%turns = .true.
      ranges = [range]
      return
    end if
    ! From a gap on, round the period.
    k = findloc(closes(:samples - 1), .false., dim=1) - 1
    step = period/samples
    first = period*k/samples
    i = 1
    do while (i <= samples)
      c = first + step*i
      if (.not. closes(modulo(k + i, samples))) then
        i = i + 1
        cycle
      end if
      call find_end(linkage, c, -step, range%blocked_by(1), range%left_at(1), range%from)
      call find_end(linkage, c, step, range%blocked_by(2), range%left_at(2), range%to)
      ranges = [ranges, range]
      i = max(i + 1, 1 + floor((range%to - first)/step))
    end do
  end subroutine find_ranges

  !> Whether the first drive turns a link fully and all positions repeat after a turn, without a
  !! dead point on the way.
  pure function turns_fully(linkage) result(turns)
    type(linkage_t), intent(in) :: linkage !! of any kind, with its path
    logical :: turns

    type(pose_t) :: pose
    type(error_t), allocatable :: error
    integer :: i

    turns = linkage%drives(1)%kind == drives_angle .and. &
      abs(period_of(linkage) - 360.0_wp) <= 0.0_wp
    do i = 1, samples
      if (.not. turns) return
      call find_pose(linkage, 360.0_wp*i/samples, pose, error)
      turns = .not. allocated(error)
    end do
  end function turns_fully

  pure function is_closed(linkage, crank) result(is)
    type(linkage_t), intent(in) :: linkage
    real(wp), intent(in) :: crank
    logical :: is

    type(pose_t) :: pose
    type(error_t), allocatable :: error

    call place_links(linkage, crank, pose, error)
    is = .not. allocated(error)
  end function is_closed

  !> Whether the linkage closes, and no group is at its limit but for rounding.
  pure function is_inside(linkage, crank) result(is)
    type(linkage_t), intent(in) :: linkage
    real(wp), intent(in) :: crank
    logical :: is

    type(pose_t) :: pose
    type(error_t), allocatable :: error

    call place_links(linkage, crank, pose, error)
    is = .not. allocated(error)
    if (is) is = all(abs(pose%sine) > 0.0_wp)
  end function is_inside

  !> The last coordinate, in steps from one at which the linkage closes, at which it still does, by
  !! bisection; the group that is nearest to its dead point there, and the block that leaves its
  !! link.
  pure subroutine find_end(linkage, inside, step, group, pin, last)
    type(linkage_t), intent(in) :: linkage
    real(wp), intent(in) :: inside
    real(wp), intent(in) :: step !! with its sign
    integer, intent(out) :: group
    integer, intent(out) :: pin !! of the block; 0: none
    real(wp), intent(out) :: last

    type(pose_t) :: pose
    type(error_t), allocatable :: error
    real(wp) :: beyond, middle
    integer :: i

    last = inside
    group = 0
    pin = 0
    do i = 1, 20*samples
      beyond = last + step
      if (.not. is_closed(linkage, beyond)) exit
      last = beyond
    end do
    do i = 1, most_halvings
      middle = 0.5_wp*(last + beyond)
      if (abs(beyond - last) <= 2.0_wp*spacing(max(abs(last), abs(step)))) exit
      if (is_inside(linkage, middle)) then
        last = middle
      else
        beyond = middle
      end if
    end do
    call place_links(linkage, beyond, pose, error)
    if (allocated(error)) pin = error%place%pin
    call place_links(linkage, last, pose, error)
    if (.not. allocated(error)) then
      if (size(pose%sine) > 0) group = minloc(abs(pose%sine), dim=1)
    end if
  end subroutine find_end

  !> Least and greatest values of a quantity over a range.
  pure subroutine find_extremes(linkage, range, quantity, extremes)
    type(linkage_t), intent(in) :: linkage        !! of any kind, with its path
    type(crank_range_t), intent(in) :: range      !! one of `find_ranges`
    type(quantity_t), intent(in) :: quantity      !! which
    type(extremes_t), intent(out) :: extremes     !! over the range

    real(wp) :: c, value, rate, last_c, last_value, last_rate, low, high, low_rate, first
    logical :: is_fine, has_last
    integer :: i, k

    has_last = .false.
    first = 0.0_wp
    last_c = 0.0_wp
    last_value = 0.0_wp
    last_rate = 0.0_wp
    do i = 0, samples
      c = range%from + (range%to - range%from)*i/samples
      call evaluate(linkage, quantity, c, value, rate, is_fine)
      if (.not. is_fine .and. .not. (i == 0 .or. i == samples)) cycle
      if (has_last) value = unwrapped(quantity, value, last_value)
      if (.not. has_last) then
        first = value
        extremes%least = value
        extremes%greatest = value
        extremes%at_least = c
        extremes%at_greatest = c
      end if
      call take(extremes, c, value)
      if (has_last .and. is_fine .and. rate*last_rate < 0.0_wp) then
        extremes%reversals = extremes%reversals + 1
        low = last_c
        high = c
        low_rate = last_rate
        do k = 1, most_halvings
          c = 0.5_wp*(low + high)
          if (abs(high - low) <= 2.0_wp*spacing(abs(c))) exit
          call evaluate(linkage, quantity, c, value, rate, is_fine)
          if (.not. is_fine) exit
          if (rate*low_rate > 0.0_wp) then
            low = c
          else
            high = c
          end if
        end do
        value = unwrapped(quantity, value, last_value)
        call take(extremes, c, value)
        c = range%from + (range%to - range%from)*i/samples
        call evaluate(linkage, quantity, c, value, rate, is_fine)
        value = unwrapped(quantity, value, last_value)
      end if
      last_value = value
      ! A rate of zero has no sign to compare with: the next one is compared with the last that has.
      if (has_last .and. is_fine .and. abs(rate) <= 0.0_wp) cycle
      has_last = .true.
      last_c = c
      last_rate = merge(rate, 0.0_wp, is_fine)
    end do
    if (range%turns .and. quantity%kind == angle_of_body) extremes%turned = &
      360.0_wp*anint((last_value - first)/360.0_wp)
  end subroutine find_extremes

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
    type(error_t), allocatable :: error
    integer :: line_body

    value = 0.0_wp
    rate = 0.0_wp
    call place_links(linkage, c, pose, error)
    is_fine = .not. allocated(error)
    if (.not. is_fine) return
    is_fine = all(abs(pose%sine) > dead_point_sine)
    if (is_fine) coefficients = find_kinematic_coefficients(linkage, pose)
    select case (quantity%kind)
    case (angle_of_body)
      value = body_angle(linkage, pose, quantity%number)/degree
      if (is_fine) rate = coefficients%turn(quantity%number)
    case (place_of_slider)
      associate (slider => linkage%sliders(quantity%number))
        value = dot_product(slider%direction, pose%pin(:, slider%pin) - slider%point)
        if (is_fine) rate = dot_product(slider%direction, coefficients%pin(:, slider%pin))
      end associate
    case (transmission_of_dyad)
      value = transmission_angle(linkage, pose, quantity%number)/degree
      if (is_fine) rate = (coefficients%turn(linkage%groups(quantity%number)%body(2)) - &
        coefficients%turn(linkage%groups(quantity%number)%body(1)))*sign(1.0_wp, &
        pose%sine(quantity%number))
    case (pressure_of_slider)
      value = acos(min(1.0_wp, abs(pose%sine(quantity%number))))/degree
      associate (group => linkage%groups(quantity%number))
        if (is_fine) then
          rate = coefficients%turn(group%body(1))
          line_body = linkage%sliders(group%slider(1))%body
          if (line_body > 0) rate = rate - coefficients%turn(line_body)
        end if
      end associate
    end select
  end subroutine evaluate

end module crank_limits
