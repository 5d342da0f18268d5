!> The axis of a link, straight from pin to pin, and the places of the link beside it.
module link_axis
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: foot_t, foot_on_axis, lies_on_axis

  !> Distance from the axis that is rounding, as a share of the link [-].
  real(wp), parameter :: rounding = 1.0e-6_wp

  !> Relative difference of two distances that are one [-].
  real(wp), parameter :: tie = 1.0e-12_wp

  !> The place of an axis that is nearest to a place of its link.
  type :: foot_t
    integer :: segment = 0         !! from 1, in the order of the pins
    real(wp) :: along = 0.0_wp     !! from the first pin of the segment [m]
    real(wp) :: distance = 0.0_wp  !! of the place from there [m]
    real(wp) :: beyond = 0.0_wp    !! how far the place is beyond an end of the axis, along its
                                   !! first or last segment [m]
  end type foot_t

contains

  !> The foot of a place on the axis of a link; of several the first.
  pure function foot_on_axis(pins, is_closed, place) result(foot)
    real(wp), intent(in) :: pins(:, :)   !! (2, pins) places of the pins, two at least, no two
                                         !! neighbours at one place [m]
    logical, intent(in) :: is_closed     !! the last pin is joined to the first
    real(wp), intent(in) :: place(2)     !! in the same axes [m]
    type(foot_t) :: foot

    real(wp) :: way(2), length, along, distance
    integer :: i, next, segments

    segments = size(pins, 2) - merge(0, 1, is_closed)
    do i = 1, segments
      next = mod(i, size(pins, 2)) + 1
      way = pins(:, next) - pins(:, i)
      length = norm2(way)
      way = way/length
      along = dot_product(way, place - pins(:, i))
      distance = norm2(place - pins(:, i) - min(max(along, 0.0_wp), length)*way)
      if (i > 1 .and. distance >= (1.0_wp - tie)*foot%distance) cycle
      foot = foot_t(i, min(max(along, 0.0_wp), length), distance)
      if (is_closed) cycle
      if (i == 1) foot%beyond = max(0.0_wp, -along)
      if (i == segments) foot%beyond = max(foot%beyond, along - length)
    end do
  end function foot_on_axis

  !> Whether a place is on the axis of its link, but for rounding.
  pure function lies_on_axis(pins, foot) result(lies)
    real(wp), intent(in) :: pins(:, :)   !! (2, pins) as for its foot [m]
    type(foot_t), intent(in) :: foot     !! of the place
    logical :: lies

    lies = foot%distance <= rounding*maxval(abs(pins))
  end function lies_on_axis

end module link_axis
