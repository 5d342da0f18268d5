! src/linkage/limits/ - how far a linkage moves: ranges of drives, dead points, change points.
! In: a planned linkage. Out: its `path_t`; ranges of its drives, with extreme values and dead
! points in them. Begin with `follow_path` in `linkage_paths.f90`, then `find_ranges` in
! `crank_limits.f90` and `find_extremes` in `crank_extremes.f90` (transmission angles, strokes).
! Not here: the pose at a coordinate (`src/linkage/groups`), limits of four-bars in closed form
! (`src/linkage/four_bar`).

!> Places on a bridge: polynomials through nodes on both sides of a change point.
!!
!! Weights of a polynomial's value and of its derivatives at a place follow from those through fewer
!! nodes (B. Fornberg, Math. Comp. 51 (1988) 699).
module bridges
  use constants, only: degree
  use kinds, only: wp
  use linkages, only: bridge_t, cross, follows_angle, linkage_t, path_t, reference_point
  use pose_types, only: pose_t
  implicit none (type, external)
  private

  public :: change_point_t, place_on_path, bridge_at, cross_bridge, change_of, change_points_of, &
    thinned, edge_sine, node_weights

  !> Where the equations of a group depend on each other, and the linkage goes smoothly on.
  type :: change_point_t
    integer :: group = 0       !! number, from 1
    real(wp) :: crank = 0.0_wp !! [deg] or [m]
  end type change_point_t

contains

  !> A coordinate without whole periods of the path.
  pure function place_on_path(path, crank) result(place)
    type(path_t), intent(in) :: path !! with stations
    real(wp), intent(in) :: crank    !! [deg] or [m]
    real(wp) :: place                !! at or behind its beginning, if there is a period

    real(wp) :: first

    place = crank
    if (.not. path%period > 0.0_wp) return
    first = path%crank(1)
    if (allocated(path%limits(1)%crank)) first = path%limits(1)%change
    place = first + modulo(crank - first, path%period)
  end function place_on_path

  !> The bridge of a path at a coordinate; 0: there is none.
  pure function bridge_at(path, crank) result(number)
    type(path_t), intent(in) :: path !! with stations
    real(wp), intent(in) :: crank    !! between its first and its last station [deg] or [m]
    integer :: number

    if (.not. allocated(path%bridges)) then
      number = 0
      return
    end if
    do number = size(path%bridges), 1, -1
      if (crank >= path%bridges(number)%from .and. crank <= path%bridges(number)%to) return
    end do
  end function bridge_at

  !> The pose at a place of a bridge, with its kinematic coefficients.
  pure subroutine cross_bridge(linkage, bridge, crank, pose)
    type(linkage_t), intent(in) :: linkage !! its drives
    type(bridge_t), intent(in) :: bridge   !! of this linkage
    real(wp), intent(in) :: crank          !! between its nodes [deg] or [m]
    type(pose_t), intent(out) :: pose      !! pins from `reference_point`

    real(wp) :: weight(size(bridge%crank), 0:2), d(2, 0:2), length
    integer :: b, p, k

    if (bridge%by_sine) then
      weight = weights_by_sine(bridge, crank)
    else
      weight = node_weights(bridge%crank, crank)
    end if
    ! Derivatives are per radian.
    if (follows_angle(linkage)) then
      weight(:, 1) = weight(:, 1)/degree
      weight(:, 2) = weight(:, 2)/degree**2
    end if
    pose%crank = crank
    pose%origin = reference_point(linkage)
    allocate (pose%coefficients)
    associate (it => pose%coefficients, pins => size(bridge%pin, 2), &
        bodies => size(bridge%direction, 2))
      allocate (pose%pin(2, pins), it%pin(2, pins), it%pin_slope(2, pins))
      allocate (pose%direction(2, bodies), it%turn(bodies), it%turn_slope(bodies))
      do p = 1, pins
        pose%pin(:, p) = matmul(bridge%pin(:, p, :), weight(:, 0))
        it%pin(:, p) = matmul(bridge%pin(:, p, :), weight(:, 1))
        it%pin_slope(:, p) = matmul(bridge%pin(:, p, :), weight(:, 2))
      end do
      do b = 1, bodies
        do k = 0, 2
          d(:, k) = matmul(bridge%direction(:, b, :), weight(:, k))
        end do
        length = norm2(d(:, 0))
        d = d/length
        pose%direction(:, b) = d(:, 0)
        it%turn(b) = cross(d(:, 0), d(:, 1))
        it%turn_slope(b) = cross(d(:, 0), d(:, 2))
      end do
    end associate
    pose%sine = matmul(bridge%sine, weight(:, 0))
  end subroutine cross_bridge

  !> Where on a bridge the determinant of a group is zero, by halving.
  pure function change_of(linkage, bridge, group) result(change)
    type(linkage_t), intent(in) :: linkage !! its drives
    type(bridge_t), intent(in) :: bridge   !! on whose sides this determinant has two signs
    integer, intent(in) :: group           !! number, from 1
    real(wp) :: change                     !! [deg] or [m]

    type(pose_t) :: pose
    real(wp) :: ends(2)
    integer :: i, middle

    middle = size(bridge%crank)/2
    ends = bridge%crank(middle:middle + 1)
    do i = 1, 60
      change = 0.5_wp*sum(ends)
      call cross_bridge(linkage, bridge, change, pose)
      ends(merge(1, 2, pose%sine(group)*bridge%sine(group, middle) > 0.0_wp)) = change
    end do
  end function change_of

  !> The change points of a path in an interval, each once: of every group that has one under a
  !! bridge, and not again where another bridge leads over it at the end of the path.
  pure subroutine change_points_of(linkage, from, to, points)
    type(linkage_t), intent(in) :: linkage                     !! with bridges
    real(wp), intent(in) :: from, to                           !! [deg] or [m]
    type(change_point_t), allocatable, intent(out) :: points(:)

    !> Change points are the same if they are this near [deg] or [m].
    real(wp), parameter :: same = 1.0e-6_wp
    real(wp) :: crank
    integer :: i, g

    allocate (points(0))
    associate (path => linkage%path)
      if (.not. allocated(path%bridges)) return
      do i = 1, size(path%bridges)
        associate (bridge => path%bridges(i))
          do g = 1, size(linkage%groups)
            if (bridge%sine(g, 1)*bridge%sine(g, size(bridge%crank)) > 0.0_wp) cycle
            crank = change_of(linkage, bridge, g)
            if (path%period > 0.0_wp) crank = from + modulo(crank - from, path%period)
            if (crank > to .or. any(points%group == g .and. abs(points%crank - crank) < same)) cycle
            points = [points, change_point_t(g, crank)]
          end do
        end associate
      end do
    end associate
  end subroutine change_points_of

  !> The least of all determinants at the ends of a bridge.
  pure function edge_sine(bridge) result(sine)
    type(bridge_t), intent(in) :: bridge !! over a change point
    real(wp) :: sine

    integer :: middle

    middle = size(bridge%crank)/2
    sine = minval(abs(bridge%sine(:, middle:middle + 1)))
  end function edge_sine

  !> A bridge without its outermost nodes. By how much its places differ is an estimate of the error
  !! of the whole one.
  pure function thinned(bridge) result(fewer)
    type(bridge_t), intent(in) :: bridge !! towards a limit the last node is nearest to it
    type(bridge_t) :: fewer

    integer :: last

    fewer = bridge
    last = size(bridge%crank) - merge(0, 1, bridge%by_sine)
    fewer%crank = bridge%crank(2:last)
    fewer%pin = bridge%pin(:, :, 2:last)
    fewer%direction = bridge%direction(:, :, 2:last)
    fewer%sine = bridge%sine(:, 2:last)
  end function thinned

  !> Weights of the values at nodes in the value and the derivatives by the coordinate, of
  !! polynomials in the determinant of a group: c(σ) is the coordinate, d/dc = (d/dσ)/c′, and
  !! d²/dc² = (d²/dσ² − c″ d/dc)/c′². At the limit itself there are no derivatives: they are 0.
  pure function weights_by_sine(bridge, crank) result(weight)
    type(bridge_t), intent(in) :: bridge
    real(wp), intent(in) :: crank      !! between the last node and the limit [deg] or [m]
    real(wp) :: weight(size(bridge%crank), 0:2)

    real(wp) :: node(size(bridge%crank)), c(0:2), sine, step
    integer :: i, last

    node = bridge%sine(bridge%group, :)
    last = size(node)
    sine = 0.0_wp
    if (abs(bridge%change - crank) > 0.0_wp) sine = node(size(node))*sqrt(min(1.0_wp, abs(( &
      bridge%change - crank)/(bridge%change - bridge%crank(last)))))
    do i = 1, 20
      weight = node_weights(node, sine)
      c = matmul(bridge%crank - bridge%change, weight)
      if (.not. abs(c(1)) > 0.0_wp .or. .not. abs(sine) > 0.0_wp) exit
      step = (bridge%change + c(0) - crank)/c(1)
      ! Between the limit and the last node, but for rounding.
      step = sine - min(max((sine - step)/node(size(node)), 0.0_wp), 1.0_wp)*node(size(node))
      sine = sine - step
      if (abs(step) <= 2.0_wp*spacing(sine)) exit
    end do
    weight = node_weights(node, sine)
    c = matmul(bridge%crank - bridge%change, weight)
    if (abs(sine) > 0.0_wp .and. abs(c(1)) > 0.0_wp) then
      weight(:, 1) = weight(:, 1)/c(1)
      weight(:, 2) = (weight(:, 2) - c(2)*weight(:, 1))/c(1)**2
    else
      weight(:, 1:) = 0.0_wp
    end if
  end function weights_by_sine

  !> Weights of the values at nodes in the value, the first and the second derivative at a place of
  !! the polynomial through them.
  pure function node_weights(node, x) result(weight)
    real(wp), intent(in) :: node(:) !! all different
    real(wp), intent(in) :: x
    real(wp) :: weight(size(node), 0:2)

    real(wp) :: product, last_product, way, last(0:2)
    integer :: i, j, k

    weight = 0.0_wp
    weight(1, 0) = 1.0_wp
    last_product = 1.0_wp
    do i = 2, size(node)
      product = 1.0_wp
      last = weight(i - 1, :)
      do j = 1, i - 1
        way = node(i) - node(j)
        product = product*way
        do k = min(i - 1, 2), 1, -1
          weight(j, k) = ((node(i) - x)*weight(j, k) - k*weight(j, k - 1))/way
        end do
        weight(j, 0) = (node(i) - x)*weight(j, 0)/way
      end do
      do k = min(i - 1, 2), 1, -1
        weight(i, k) = last_product/product*(k*last(k - 1) - (node(i - 1) - x)*last(k))
      end do
      weight(i, 0) = -last_product/product*(node(i - 1) - x)*last(0)
      last_product = product
    end do
  end function node_weights

end module bridges
