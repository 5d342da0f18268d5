!> Where in a range of the first drive a group comes nearest to a dead point.
module dead_points
  use bridges, only: bridge_at, change_point_t, change_points_of, place_on_path
  use crank_limits, only: crank_range_t
  use kinds, only: wp
  use linkage_paths, only: has_change_points
  use linkages, only: linkage_t
  use low_points, only: find_sines, low_point_t, lowest_point
  implicit none (type, external)
  private

  public :: find_low_points

contains

  !> The dead points inside a range, where the linkage goes on but its motion is not determined, and
  !! the least |σ| of every group that iterations place. Ends of the range are none of them.
  pure subroutine find_low_points(linkage, range, by_iterations, points)
    type(linkage_t), intent(in) :: linkage                      !! of any kind, with its path
    type(crank_range_t), intent(in) :: range                    !! of the first drive
    logical, intent(in) :: by_iterations(:)                     !! (groups)
    type(low_point_t), allocatable, intent(out) :: points(:)

    !> A minimum of the samples that is not lower cannot reach zero between them.
    real(wp), parameter :: low = 0.1_wp
    !> The beginning of a turn is not its end.
    real(wp), parameter :: rounding = 1.0e-9_wp
    type(change_point_t), allocatable :: changes(:)
    real(wp), allocatable :: sine(:, :)
    type(low_point_t) :: point, least
    integer :: samples, g, i

    samples = range%samples
    allocate (points(0), changes(0), sine(size(linkage%groups), -1:samples + 1))
    if (has_change_points(linkage)) call change_points_of(linkage, range%from, range%to, changes)
    do i = 1, size(changes)
      points = [points, low_point_t(changes(i)%group, changes(i)%crank, is_change=.true.)]
    end do
    do i = 0, samples
      call find_sines(linkage, crank_at(range, real(i, wp)), sine(:, i))
    end do
    ! Beyond the ends a range that turns begins again.
    sine(:, -1) = -1.0_wp
    sine(:, samples + 1) = -1.0_wp
    if (range%turns) then
      sine(:, -1) = sine(:, samples - 1)
      sine(:, samples) = huge(1.0_wp)
    end if
    do g = 1, size(linkage%groups)
      least%sine = huge(1.0_wp)
      do i = 0, samples
        if (sine(g, i) > sine(g, i - 1) .or. sine(g, i) >= next_of(i)) cycle
        if (sine(g, i) > low .and. .not. by_iterations(g)) cycle
        point = lowest_point(linkage, g, crank_at(range, i - 1.0_wp), crank_at(range, i + 1.0_wp))
        if (is_on_bridge(linkage, point%crank)) cycle
        if (range%turns .and. point%crank < range%from - rounding) point%crank = point%crank + &
          (range%to - range%from)
        point%crank = max(point%crank, range%from)
        if (point%is_dead) points = [points, point]
        if (point%sine < least%sine) least = point
      end do
      if (by_iterations(g) .and. .not. least%is_dead .and. least%group > 0) points = [points, least]
    end do

  contains

    !> The sample behind one; of a whole turn the first one behind the last.
    pure function next_of(number) result(value)
      integer, intent(in) :: number
      real(wp) :: value

      value = sine(g, number + 1)
      if (range%turns .and. number == range%samples - 1) value = sine(g, 0)
    end function next_of

  end subroutine find_low_points

  pure logical function is_on_bridge(linkage, crank)
    type(linkage_t), intent(in) :: linkage
    real(wp), intent(in) :: crank

    is_on_bridge = .false.
    if (has_change_points(linkage)) is_on_bridge = bridge_at(linkage%path, place_on_path( &
      linkage%path, crank)) > 0
  end function is_on_bridge

  !> A coordinate of a range, counted in samples.
  pure function crank_at(range, number) result(crank)
    type(crank_range_t), intent(in) :: range
    real(wp), intent(in) :: number
    real(wp) :: crank

    crank = range%from + (range%to - range%from)*number/range%samples
  end function crank_at

end module dead_points
