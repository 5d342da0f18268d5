!> Where a group comes nearest to a dead point, and gaps that steps of a search leap over.
module low_points
  use errors, only: error_t
  use kinds, only: wp
  use linkages, only: linkage_t
  use pose_types, only: pose_t
  use poses, only: dead_point_sine, place_links
  implicit none (type, external)
  private

  public :: low_point_t, lowest_point, find_sines, find_gap

  !> A minimum of the scaled determinant |σ| of a group, as in `pose_t`.
  type :: low_point_t
    integer :: group = 0
    real(wp) :: crank = 0.0_wp     !! coordinate of the first drive [deg] or [m]
    real(wp) :: sine = 0.0_wp      !! |σ| there [-]
    logical :: is_dead = .false.   !! positions there are refused
    real(wp) :: width = 0.0_wp     !! of these positions [deg] or [m]
    logical :: is_change = .false. !! the linkage goes smoothly through
  end type low_point_t

contains

  !> |σ| of all groups; 0 where the links cannot be placed.
  pure subroutine find_sines(linkage, crank, sine, closes)
    type(linkage_t), intent(in) :: linkage !! of any kind, with its path
    real(wp), intent(in) :: crank          !! coordinate of the first drive [deg] or [m]
    real(wp), intent(out) :: sine(:)       !! (groups) [-]
    logical, intent(out), optional :: closes !! the links can be placed

    type(pose_t) :: pose
    type(error_t), allocatable :: error

    call place_links(linkage, crank, pose, error)
    sine = 0.0_wp
    if (.not. allocated(error)) sine = abs(pose%sine)
    if (present(closes)) closes = .not. allocated(error)
  end subroutine find_sines

  !> A gap between three neighbours at which the linkage closes.
  !!
  !! Beside a dead point |σ| goes like the root of the distance: its square is smooth, and falls
  !! below zero in a gap. Where it is least at the middle one of three, and a parabola through them
  !! says that it may be zero, its minimum is sought.
  pure subroutine find_gap(linkage, at, sine, found, place)
    type(linkage_t), intent(in) :: linkage !! of any kind, with its path
    real(wp), intent(in) :: at(3)          !! coordinates of the first drive, a step apart, in
                                           !! either order [deg] or [m]
    real(wp), intent(in) :: sine(:, :)     !! (groups, 3) by `find_sines`
    logical, intent(out) :: found
    real(wp), intent(out) :: place         !! its middle [deg] or [m]

    !> Share of the neighbours' square to which a parabola must fall.
    real(wp), parameter :: low = 0.05_wp
    type(low_point_t) :: point
    real(wp) :: square(3), slope, curvature, no_sine(size(sine, 1))
    logical :: closes(3)
    integer :: g, i

    found = .false.
    place = at(2)
    do g = 1, size(sine, 1)
      square = sine(g, :)**2
      slope = 0.5_wp*(square(3) - square(1))
      curvature = square(1) - 2.0_wp*square(2) + square(3)
      if (square(2) > min(square(1), square(3)) .or. .not. curvature > 0.0_wp) cycle
      if (square(2) - 0.5_wp*slope**2/curvature > low*max(square(1), square(3))) cycle
      point = lowest_point(linkage, g, minval(at), maxval(at))
      if (.not. point%is_dead) cycle
      ! At a change point the linkage may fail to close by rounding, but not over half of the way
      ! on which positions are refused.
      do i = 1, 3
        call find_sines(linkage, point%crank + 0.25_wp*(i - 2)*point%width, no_sine, closes(i))
      end do
      found = .not. any(closes)
      place = point%crank
      if (found) return
    end do
  end subroutine find_gap

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
    if (.not. point%is_dead) return
    a = edge(point%crank, from)
    b = edge(point%crank, to)
    point%crank = 0.5_wp*(a + b)
    point%width = b - a

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

      call find_sines(linkage, crank, sines)
      sine = sines(group)
    end function sine_of

  end function lowest_point

end module low_points
