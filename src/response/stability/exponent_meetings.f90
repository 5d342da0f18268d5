!> Where two exponents that depend on a parameter meet, and how far they are apart then.
!!
!! Each by itself has a branch point there; their sum and the square of their difference are
!! analytic. Both are interpolated by parabolas through three values beside a place, which is then
!! looked at itself, until it stays: two or three values are enough for a place.
module exponent_meetings
  use constants, only: two_pi
  use kinds, only: wp
  use sorting, only: ascending_order
  implicit none (type, external)
  private

  public :: exponent_pair_t, interval_t, find_closest, find_interval

  !> Two exponents σ of a parameter.
  type, abstract :: exponent_pair_t
    logical :: is_damped = .false. !! else σ is on the imaginary axis or has a partner −σ̄
  contains
    procedure(evaluate_i), deferred :: evaluate
  end type exponent_pair_t

  abstract interface
    !> Sum of the exponents and `−(σ1 − σ2)²`.
    subroutine evaluate_i(self, place, total, square, good)
      import :: exponent_pair_t, wp
      class(exponent_pair_t), intent(inout), target :: self
      real(wp), intent(in) :: place          !! of the parameter
      complex(wp), intent(out) :: total, square
      logical, intent(out) :: good           !! they were found
    end subroutine evaluate_i
  end interface

  !> Where exponents have positive real parts.
  type :: interval_t
    real(wp) :: from = 0.0_wp, to = 0.0_wp
    real(wp) :: at = 0.0_wp     !! where one is largest
    real(wp) :: growth = 0.0_wp !! 2π times the largest; 0: there is no interval
  end type interval_t

  !> What is known of a pair.
  type :: samples_t
    integer :: number = 0
    real(wp) :: place(64) = 0.0_wp
    complex(wp) :: total(64) = 0.0_wp, square(64) = 0.0_wp
  end type samples_t

  !> A parabola is right where exponents bend over this share of the parameter. An edge is found
  !! when a value is known so near to it that the parabola is right to the tolerance or to the
  !! second share of the interval's width there; the peak, which is flat, when one is as near as
  !! the third, and another as the fourth: that through both edges and the middle is in the middle.
  real(wp), parameter :: bends_over = 0.1_wp, of_width = 2.0e-5_wp, reach = 1.0e-2_wp, &
    for_peak = 0.5_wp

  !> Places a little beside one: in terms of how near they have to be, and for a peak of half the
  !! width.
  real(wp), parameter :: beside = 0.3_wp, beside_peak = 0.25_wp

  !> Most places are looked at so many times; widths by which one is left at most, and share of it
  !! for a peak with damping.
  integer, parameter :: most_rounds = 14
  real(wp), parameter :: farthest = 10.0_wp, near_peak = 0.25_wp

  !> Steps of bisections and golden sections of parabolas, and pieces in which a peak is looked for.
  integer, parameter :: bisections = 60, sections = 60, scan = 200

contains

  !> Where two exponents are closest, or farthest from the imaginary axis: the least value of the
  !! real part of the square, by parabolas.
  subroutine find_closest(pair, place, step, square, slope, good)
    class(exponent_pair_t), intent(inout) :: pair
    real(wp), intent(inout) :: place      !! about, then where
    real(wp), intent(in) :: step          !! for differences
    real(wp), intent(out) :: square       !! there
    real(wp), intent(out) :: slope        !! of the difference beside, root of half the second
                                          !! derivative of the square
    logical, intent(out) :: good          !! it was found

    integer, parameter :: most = 8
    real(wp), parameter :: near = 3.0_wp
    complex(wp) :: total, value(-1:1)
    real(wp) :: curvature, gradient, move
    integer :: i, round

    square = 0.0_wp
    slope = 0.0_wp
    do round = 1, most
      do i = -1, 1
        call pair%evaluate(place + i*step, total, value(i), good)
        if (.not. good) return
      end do
      curvature = real(value(-1) - 2.0_wp*value(0) + value(1))/(2.0_wp*step**2)
      gradient = real(value(1) - value(-1))/(2.0_wp*step)
      good = curvature > 0.0_wp
      if (.not. good) return
      move = -gradient/(2.0_wp*curvature)
      square = real(value(0)) + 0.5_wp*gradient*move
      slope = sqrt(curvature)
      good = abs(move) <= max(near*step, 0.1_wp*sqrt(max(-square, 0.0_wp))/slope)
      place = place + move
      if (good) return
    end do
  end subroutine find_closest

  !> Edges, largest growth and its place of an interval.
  subroutine find_interval(pair, about, tolerance, interval, good)
    class(exponent_pair_t), intent(inout) :: pair
    real(wp), intent(in) :: about(3)         !! edges and peak: from, at, to
    real(wp), intent(in) :: tolerance        !! of its edges, beside a share of the width
    type(interval_t), intent(out) :: interval !! without growth if there is none
    logical, intent(out) :: good             !! values were found, and places stay

    type(samples_t) :: samples
    real(wp) :: goal(3), scale
    integer :: i, round
    logical :: exists, added

    goal = about
    scale = 0.5_wp*(about(3) - about(1))
    do i = 1, 3
      call add(i)
      if (.not. good) return
    end do
    do round = 1, most_rounds
      goal(2) = peak_of(near_three(samples, goal(2)), pair%is_damped, goal(2), farthest*scale)
      exists = largest_real_part(near_three(samples, goal(2)), goal(2), pair%is_damped) > 0.0_wp
      if (exists) then
        goal(1) = edge_of(samples, pair%is_damped, goal(2), -scale, goal(1))
        goal(3) = edge_of(samples, pair%is_damped, goal(2), scale, goal(3))
        scale = 0.5_wp*(goal(3) - goal(1))
      end if
      added = .false.
      do i = 1, 3
        if (i /= 2 .and. .not. exists) cycle
        if (is_known(i)) cycle
        if (i == 2 .and. nearest_to(goal(2)) <= near_to(2)) then
          call add_at(goal(2) + beside_peak*scale)
        else
          call add(i)
        end if
        if (.not. good) return
        added = .true.
      end do
      if (.not. added) exit
    end do
    good = .not. added
    if (.not. good .or. .not. exists) return
    ! The value itself, where a parabola is not good enough.
    if (nearest_to(goal(2)) > of_width*bends_over*abs(goal(2))) call add(2)
    if (.not. good) return
    interval%from = goal(1)
    interval%at = goal(2)
    interval%to = goal(3)
    interval%growth = two_pi*largest_real_part(near_three(samples, goal(2)), goal(2), &
      pair%is_damped)

  contains

    !> Whether parabolas are good enough at a goal.
    function is_known(i) result(known)
      integer, intent(in) :: i
      logical :: known

      known = nearest_to(goal(i)) <= near_to(i)
      if (i == 2 .and. exists) known = known .and. count(abs(samples%place(:samples%number) - &
        goal(2)) <= for_peak*scale) > 1
    end function is_known

    !> How near a sample is to be to a goal.
    function near_to(i) result(near)
      integer, intent(in) :: i
      real(wp) :: near

      near = reach*scale
      ! near (scale + near) = product
      if (i /= 2) near = 0.5_wp*(sqrt(scale**2 + 4.0_wp*(tolerance + of_width*scale)*bends_over* &
        abs(goal(i))) - scale)
    end function near_to

    !> Distance of the nearest sample.
    function nearest_to(place) result(apart)
      real(wp), intent(in) :: place
      real(wp) :: apart

      apart = minval(abs(samples%place(:samples%number) - place))
    end function nearest_to

    !> Adds a sample near a goal: a little beside it where there is none, as a third multiplier may
    !! pass there.
    subroutine add(i)
      integer, intent(in) :: i

      integer :: attempt

      do attempt = 0, 2
        call add_at(goal(i) + attempt*beside*(-1)**attempt*min(near_to(i), scale))
        if (good) return
      end do
    end subroutine add

    subroutine add_at(place)
      real(wp), intent(in) :: place

      integer :: n

      n = samples%number + 1
      good = n <= size(samples%place)
      if (.not. good) return
      samples%place(n) = place
      call pair%evaluate(place, samples%total(n), samples%square(n), good)
      if (good) samples%number = n
    end subroutine add_at

  end subroutine find_interval

  !> The three samples nearest to a place.
  pure function near_three(samples, place) result(three)
    type(samples_t), intent(in) :: samples
    real(wp), intent(in) :: place
    type(samples_t) :: three

    integer :: order(samples%number)

    order = ascending_order(abs(samples%place(:samples%number) - place))
    three%number = 3
    three%place(:3) = samples%place(order(:3))
    three%total(:3) = samples%total(order(:3))
    three%square(:3) = samples%square(order(:3))
  end function near_three

  !> The parabola through three values.
  pure function parabola(place, value, x) result(y)
    real(wp), intent(in) :: place(3), x
    complex(wp), intent(in) :: value(3)
    complex(wp) :: y

    complex(wp) :: first, second

    first = (value(2) - value(1))/(place(2) - place(1))
    second = ((value(3) - value(2))/(place(3) - place(2)) - first)/(place(3) - place(1))
    y = value(1) + (x - place(1))*(first + (x - place(2))*second)
  end function parabola

  !> The greater real part of both exponents by parabolas.
  pure function largest_real_part(three, place, is_damped) result(largest)
    type(samples_t), intent(in) :: three
    real(wp), intent(in) :: place
    logical, intent(in) :: is_damped
    real(wp) :: largest

    largest = greater_of(parabola(three%place(:3), three%total(:3), place), &
      parabola(three%place(:3), three%square(:3), place), is_damped)
  end function largest_real_part

  !> The greater real part of both exponents. Without damping exponents are on the axis or beside it
  !! by half the root of the square, which is negative then.
  elemental function greater_of(total, square, is_damped) result(greater)
    complex(wp), intent(in) :: total, square
    logical, intent(in) :: is_damped
    real(wp) :: greater

    if (is_damped) then
      greater = 0.5_wp*(real(total) + abs(real(sqrt(-square))))
    else
      greater = 0.5_wp*sign(sqrt(abs(real(square))), -real(square))
    end if
  end function greater_of

  !> Where the real part is largest, by golden section; without damping by the vertex.
  pure function peak_of(three, is_damped, about, farthest) result(peak)
    type(samples_t), intent(in) :: three
    logical, intent(in) :: is_damped
    real(wp), intent(in) :: about, farthest
    real(wp) :: peak

    real(wp), parameter :: golden = 0.381966011250105152_wp
    real(wp) :: low, high, a, b, at_a, at_b, first, second
    integer :: step

    low = about - farthest
    high = about + farthest
    if (.not. is_damped) then
      associate (x => three%place(:3), y => real(three%square(:3), wp))
        first = (y(2) - y(1))/(x(2) - x(1))
        second = ((y(3) - y(2))/(x(3) - x(2)) - first)/(x(3) - x(1))
        peak = about
        if (second > 0.0_wp) peak = 0.5_wp*(x(1) + x(2) - first/second)
      end associate
      peak = max(low, min(high, peak))
      return
    end if
    ! Beside an interval the real part hardly changes: the peak is among many places, not far away.
    low = about - near_peak*farthest
    high = about + near_peak*farthest
    peak = low
    do step = 0, scan
      a = low + step*(high - low)/scan
      if (largest_real_part(three, a, is_damped) > largest_real_part(three, peak, is_damped)) &
        peak = a
    end do
    a = (high - low)/scan
    low = peak - a
    high = peak + a
    a = low + golden*(high - low)
    b = high - golden*(high - low)
    at_a = largest_real_part(three, a, is_damped)
    at_b = largest_real_part(three, b, is_damped)
    do step = 1, sections
      if (at_a > at_b) then
        high = b
        b = a
        at_b = at_a
        a = low + golden*(high - low)
        at_a = largest_real_part(three, a, is_damped)
      else
        low = a
        a = b
        at_a = at_b
        b = high - golden*(high - low)
        at_b = largest_real_part(three, b, is_damped)
      end if
    end do
    peak = 0.5_wp*(low + high)
  end function peak_of

  !> The edge on one side of a peak, by bisection of a parabola: through the samples on both sides
  !! of it and the next, or, beyond all samples, through those near where it was.
  pure function edge_of(samples, is_damped, peak, step, before) result(edge)
    type(samples_t), intent(in) :: samples
    logical, intent(in) :: is_damped
    real(wp), intent(in) :: peak, step, before
    real(wp) :: edge

    type(samples_t) :: three
    real(wp) :: ahead(samples%number), inside, outside
    logical :: grows(samples%number)
    integer :: i, last, next

    ahead = sign(1.0_wp, step)*(samples%place(:samples%number) - peak)
    grows = greater_of(samples%total(:samples%number), samples%square(:samples%number), &
      is_damped) > 0.0_wp
    next = minloc(ahead, dim=1, mask=ahead > 0.0_wp .and. .not. grows)
    last = 0
    if (next > 0) last = maxloc(ahead, dim=1, mask=grows .and. ahead < ahead(next))
    if (last > 0) then
      three = near_both(samples, last, next, before)
      inside = samples%place(last)
      outside = samples%place(next)
    else
      three = near_three(samples, before)
      if (largest_real_part(three, peak, is_damped) <= 0.0_wp) three = near_three(samples, peak)
      inside = peak
      outside = peak
      do i = 1, 4*nint(farthest)
        outside = outside + 0.25_wp*step
        if (largest_real_part(three, outside, is_damped) <= 0.0_wp) exit
        inside = outside
      end do
    end if
    do i = 1, bisections
      edge = 0.5_wp*(inside + outside)
      if (largest_real_part(three, edge, is_damped) > 0.0_wp) then
        inside = edge
      else
        outside = edge
      end if
    end do
  end function edge_of

  !> Two samples and the one of the others that is nearest to a place.
  pure function near_both(samples, one, other, place) result(three)
    type(samples_t), intent(in) :: samples
    integer, intent(in) :: one, other
    real(wp), intent(in) :: place
    type(samples_t) :: three

    real(wp) :: apart(samples%number)

    apart = abs(samples%place(:samples%number) - place)
    apart([one, other]) = huge(1.0_wp)
    associate (all => [one, other, minloc(apart, dim=1)])
      three%number = 3
      three%place(:3) = samples%place(all)
      three%total(:3) = samples%total(all)
      three%square(:3) = samples%square(all)
    end associate
  end function near_both

end module exponent_meetings
