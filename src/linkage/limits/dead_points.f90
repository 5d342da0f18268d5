!> Where in a range of the first drive a group comes nearest to a dead point.
module dead_points
  use bridges, only: bridge_at, change_point_t, change_points_of, place_on_path
  use crank_limits, only: crank_range_t
  use errors, only: error_t
  use kinds, only: wp
  use linkage_paths, only: has_change_points
  use linkages, only: linkage_t
  use pose_types, only: pose_t
  use poses, only: dead_point_sine, place_links
  implicit none (type, external)
  private

  public :: low_point_t, find_low_points

  !> A minimum of the scaled determinant |σ| of a group, as in `pose_t`.
  type :: low_point_t
    integer :: group = 0
    real(wp) :: crank = 0.0_wp     !! coordinate of the first drive [deg] or [m]
    real(wp) :: sine = 0.0_wp      !! |σ| there [-]
    logical :: is_dead = .false.   !! positions there are refused
    logical :: is_change = .false. !! the linkage goes smoothly through
  end type low_point_t

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
      sine(:, i) = sines_at(linkage, crank_at(range, real(i, wp)))
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

  !> |σ| of all groups; 0 where the links cannot be placed.
  pure function sines_at(linkage, crank) result(sines)
    type(linkage_t), intent(in) :: linkage
    real(wp), intent(in) :: crank
    real(wp) :: sines(size(linkage%groups))

    type(pose_t) :: pose
    type(error_t), allocatable :: error

    sines = 0.0_wp
    call place_links(linkage, crank, pose, error)
    if (.not. allocated(error)) sines = abs(pose%sine)
  end function sines_at

  !> The minimum of |σ| of a group between two coordinates, by golden-section search.
  pure function lowest_point(linkage, group, from, to) result(point)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: group
    real(wp), intent(in) :: from, to
    type(low_point_t) :: point

    real(wp), parameter :: golden = 0.5_wp*(sqrt(5.0_wp) - 1.0_wp)
    real(wp) :: a, b, x(2), y(2)

    a = from
    b = to
    x = [b - golden*(b - a), a + golden*(b - a)]
    y = [sine_of(x(1)), sine_of(x(2))]
    do while (b - a > max(1.0e-11_wp*(to - from), 4.0_wp*spacing(max(abs(a), abs(b)))))
      if (y(1) <= y(2)) then
        b = x(2)
        x = [b - golden*(b - a), x(1)]
        y = [sine_of(x(1)), y(1)]
      else
        a = x(1)
        x = [x(2), a + golden*(b - a)]
        y = [y(2), sine_of(x(2))]
      end if
    end do
    point = low_point_t(group, x(minloc(y, dim=1)), minval(y), minval(y) < dead_point_sine)
    ! At a dead point σ is zero over some way, by rounding: its middle is sharper than its lowest.
    if (point%is_dead) point%crank = 0.5_wp*(edge(point%crank, from) + edge(point%crank, to))

  contains

    !> Where positions begin to be accepted, from a refused one towards another one.
    pure function edge(refused, accepted) result(middle)
      real(wp), intent(in) :: refused, accepted
      real(wp) :: middle

      real(wp) :: inner, outer
      integer :: i

      inner = refused
      outer = accepted
      do i = 1, 60
        middle = 0.5_wp*(inner + outer)
        if (sine_of(middle) < dead_point_sine) then
          inner = middle
        else
          outer = middle
        end if
      end do
    end function edge

    pure function sine_of(crank) result(sine)
      real(wp), intent(in) :: crank
      real(wp) :: sine

      real(wp) :: sines(size(linkage%groups))

      sines = sines_at(linkage, crank)
      sine = sines(group)
    end function sine_of

  end function lowest_point

end module dead_points
