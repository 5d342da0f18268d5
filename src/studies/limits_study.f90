!> What a linkage that is no four-bar can do: ranges of its first drive, swings of its links,
!! strokes of its sliders, time ratios, transmission and pressure angles.
module limits_study
  use crank_limits, only: angle_of_body, crank_range_t, extremes_t, find_extremes, find_ranges, &
    place_of_slider, pressure_of_slider, quantity_t, transmission_of_dyad
  use kinds, only: wp
  use linkages, only: groups_dyad, groups_on_line, linkage_t
  implicit none (type, external)
  private

  public :: limits_result_t, find_limits, time_ratio
  public :: crank_range_t
  public :: quantity_t, angle_of_body, place_of_slider, pressure_of_slider, transmission_of_dyad

  !> Ranges, and the extremes of every quantity over each.
  type :: limits_result_t
    type(crank_range_t), allocatable :: ranges(:)
    type(quantity_t), allocatable :: quantities(:)
    type(extremes_t), allocatable :: extremes(:, :) !! (quantities, ranges)
  end type limits_result_t

contains

  !> Finds all ranges, and the extremes in them.
  pure subroutine find_limits(linkage, inside, found)
    type(linkage_t), intent(in) :: linkage      !! of any kind, with its path
    real(wp), intent(in) :: inside              !! a coordinate of the first drive [deg] or [m]
    type(limits_result_t), intent(out) :: found !! over all ranges

    integer :: r, q

    call find_ranges(linkage, inside, found%ranges)
    call list_quantities(linkage, found%quantities)
    allocate (found%extremes(size(found%quantities), size(found%ranges)))
    do r = 1, size(found%ranges)
      do q = 1, size(found%quantities)
        call find_extremes(linkage, found%ranges(r), found%quantities(q), found%extremes(q, r))
      end do
    end do
  end subroutine find_limits

  !> Angles of all bodies but the crank, places on fixed guides, angles of dyads.
  pure subroutine list_quantities(linkage, quantities)
    type(linkage_t), intent(in) :: linkage
    type(quantity_t), allocatable, intent(out) :: quantities(:)

    type(quantity_t) :: room(size(linkage%bodies) + size(linkage%sliders) + size(linkage%groups))
    integer :: i, filled

    filled = 0
    do i = 1, size(linkage%bodies)
      if (linkage%has_crank .and. i == 1) cycle
      filled = filled + 1
      room(filled) = quantity_t(angle_of_body, i)
    end do
    do i = 1, size(linkage%sliders)
      if (linkage%sliders(i)%body > 0) cycle
      filled = filled + 1
      room(filled) = quantity_t(place_of_slider, i)
    end do
    do i = 1, size(linkage%groups)
      if (linkage%groups(i)%kind == groups_dyad) then
        filled = filled + 1
        room(filled) = quantity_t(transmission_of_dyad, i)
      else if (linkage%groups(i)%kind == groups_on_line) then
        filled = filled + 1
        room(filled) = quantity_t(pressure_of_slider, i)
      end if
    end do
    allocate (quantities(filled))
    quantities = room(:filled)
  end subroutine list_quantities

  !> Time of the slower of two strokes over that of the quicker one, at a constant rate of the first
  !! drive; 0 where there are not two strokes a period.
  pure function time_ratio(range, extremes) result(ratio)
    type(crank_range_t), intent(in) :: range   !! of the first drive
    type(extremes_t), intent(in) :: extremes   !! of an angle or a place over it
    real(wp) :: ratio

    real(wp) :: forward, period

    ratio = 0.0_wp
    if (.not. range%turns .or. extremes%reversals /= 2 .or. abs(extremes%turned) > 0.0_wp) return
    period = range%to - range%from
    forward = modulo(extremes%at_greatest - extremes%at_least, period)
    if (forward <= 0.0_wp) return
    ratio = max(forward, period - forward)/min(forward, period - forward)
  end function time_ratio

end module limits_study
