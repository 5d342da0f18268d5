!> The range of the first drive in which a linkage is: it leaves it only if it is taken apart.
module home_ranges
  use crank_limits, only: crank_range_t, find_ranges_of_deck
  use kinds, only: wp
  use linkage_paths, only: period_of
  use linkages, only: linkage_t
  implicit none (type, external)
  private

  public :: home_range_t, find_home_range

  !> Where the linkage is, if there are several ranges.
  type :: home_range_t
    integer :: ranges = 0         !! how many there are; 0: not several
    logical :: is_drawn = .false. !! it is that of the drawing; else of the first position in reach
    real(wp) :: ends(2) = 0.0_wp  !! in the turns of the deck [deg] or [m]
    real(wp) :: period = 0.0_wp   !! after which the linkage repeats its positions, if that is more
                                  !! than a turn [deg]; else 0
  end type home_range_t

contains

  !> The range of the drawing, or without one that of the first position that has one.
  pure subroutine find_home_range(linkage, starts, positions, has_gaps, home)
    type(linkage_t), intent(in) :: linkage   !! of any kind, with its path
    real(wp), intent(in) :: starts(:)        !! of the drawing, if there is one, then those of the
                                             !! deck [deg] or [m]
    real(wp), intent(in) :: positions(:)     !! of the deck [deg] or [m]
    logical, intent(in) :: has_gaps          !! there may be several ranges
    type(home_range_t), intent(out) :: home

    type(crank_range_t), allocatable :: ranges(:)
    real(wp) :: period, ahead
    integer :: i, r

    period = period_of(linkage)
    if (period > 360.5_wp) home%period = period
    if (.not. has_gaps) return
    call find_ranges_of_deck(linkage, starts, positions, ranges)
    if (size(ranges) < 2) return
    do i = 1, size(starts)
      do r = 1, size(ranges)
        ahead = starts(i) - ranges(r)%from
        if (period > 0.0_wp) ahead = modulo(ahead, period)
        if (ahead < 0.0_wp .or. ahead > ranges(r)%to - ranges(r)%from) cycle
        home%ranges = size(ranges)
        home%is_drawn = i == 1 .and. any(linkage%drawing%is_drawn .and. .not. linkage%is_ground)
        home%ends = [ranges(r)%from, ranges(r)%to]
        return
      end do
    end do
  end subroutine find_home_range

end module home_ranges
