!> The way of a linkage whose groups only iterations place: followed once, from the drawing, over
!! whole turns of the first drive.
!!
!! From station to station Newton's method starts from the velocities and accelerations of the last
!! one. A step is halved unless it converges, every determinant keeps its sign, and the correction
!! is small compared with the way: the linkage cannot leave its branch.
module linkage_paths
  use errors, only: error_of_dead_point, error_of_input, error_t, set_error
  use kinds, only: wp
  use kinematic_coefficients, only: find_kinematic_coefficients, kinematic_coefficients_t
  use linkages, only: drives_angle, groups_by_newton, linkage_t, normal_to, path_t, reference_point
  use constants, only: degree
  use pose_types, only: drawn_pose, pose_t
  use poses, only: dead_point_sine, place_groups
  implicit none (type, external)
  private

  public :: follow_path, period_of, has_iterations, most_turns

  !> Largest step between stations: of an angle [deg]; of a length as a share of the linkage.
  real(wp), parameter :: angle_step = 2.0_wp, length_step = 0.005_wp

  !> Steps are halved this often, at most: then the path ends.
  integer, parameter :: most_halvings = 24

  !> Turns after which a linkage that has not repeated its positions is taken to have no period.
  integer, parameter :: most_turns = 8

  !> A pose repeats an earlier one if all pins are this near, as a share of the linkage.
  real(wp), parameter :: same_pose = 1.0e-9_wp

  !> Farther from the drawing than this share of the linkage no assembly is what was drawn.
  real(wp), parameter :: drawing_reach = 0.2_wp

contains

  !> Whether a linkage has groups that only iterations place.
  pure function has_iterations(linkage) result(has)
    type(linkage_t), intent(in) :: linkage !! its groups
    logical :: has

    has = any(linkage%groups%kind == groups_by_newton)
  end function has_iterations

  !> The interval of the first drive after which all positions repeat [deg]; 0: there is none.
  pure function period_of(linkage) result(period)
    type(linkage_t), intent(in) :: linkage !! its drives, and its path if it has one
    real(wp) :: period

    integer :: turns, i
    logical :: repeats

    period = 0.0_wp
    if (linkage%drives(1)%kind /= drives_angle) return
    if (allocated(linkage%path%crank)) then
      period = linkage%path%period
      return
    end if
    do turns = 1, most_turns
      repeats = .true.
      do i = 2, size(linkage%drives)
        associate (drive => linkage%drives(i))
          if (abs(drive%ratio) <= 0.0_wp) cycle
          repeats = repeats .and. drive%kind == drives_angle .and. &
            abs(turns*drive%ratio - anint(turns*drive%ratio)) <= 0.0_wp
        end associate
      end do
      if (repeats) then
        period = 360.0_wp*turns
        return
      end if
    end do
  end function period_of

  !> Finds the stations of the path. A linkage of dyads alone has none.
  !!
  !! Errors: the linkage does not assemble near the drawing; the pose found is then that of the
  !! iterations, if they converged. It is at a dead point there.
  pure subroutine follow_path(linkage, start, nearest, error)
    type(linkage_t), intent(inout) :: linkage !! with groups and drawing; its path is set
    real(wp), intent(in) :: start             !! coordinate of the first drive in the drawing [deg]
                                              !! or [m]
    type(pose_t), allocatable, intent(out) :: nearest !! assembly nearest to the drawing, in global
                                                      !! axes; not allocated without one
    type(error_t), allocatable, intent(inout) :: error !! why there is no path

    type(pose_t) :: pose
    type(path_t) :: up, down
    real(wp) :: origin(2), correction, span, farthest
    integer :: i

    if (allocated(linkage%path%crank)) deallocate (linkage%path%crank)
    if (.not. has_iterations(linkage)) return
    origin = reference_point(linkage)
    pose = drawn_pose(linkage, origin)
    call place_groups(linkage, start, pose, correction, error)
    if (allocated(error)) return
    span = linkage_span(linkage, pose)
    farthest = 0.0_wp
    do i = 1, size(linkage%is_ground)
      if (linkage%drawing%is_drawn(i) .and. .not. linkage%is_ground(i)) farthest = max(farthest, &
        norm2(pose%pin(:, i) + origin - linkage%drawing%pin(:, i)))
    end do
    if (farthest > drawing_reach*span) then
      nearest = pose
      nearest%pin = nearest%pin + spread(origin, 2, size(nearest%pin, 2))
      call set_error(error, error_of_input, "the linkage does not assemble near the drawing")
      return
    end if
    call march(linkage, start, pose, 1.0_wp, span, up)
    if (up%period > 0.0_wp) then
      linkage%path = up
      return
    end if
    call march(linkage, start, pose, -1.0_wp, span, down)
    if (size(down%crank) + size(up%crank) <= 2) then
      call set_error(error, error_of_dead_point, "dead point: the linkage cannot be followed "// &
        "from the drawing")
      return
    end if
    call join(down, up, linkage%path)
    ! Within less than a turn an angle is the same with and without whole turns.
    associate (path => linkage%path)
      if (linkage%drives(1)%kind == drives_angle .and. path%crank(size(path%crank)) - &
        path%crank(1) < 360.0_wp) path%period = 360.0_wp
    end associate
  end subroutine follow_path

  !> The largest extent of a linkage [m].
  pure function linkage_span(linkage, pose) result(span)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    real(wp) :: span

    span = max(maxval(maxval(pose%pin, dim=2) - minval(pose%pin, dim=2)), &
      maxval(linkage%bodies%length))
  end function linkage_span

  !> Follows the linkage in one sense until it repeats its pose, ends, or has made enough turns.
  pure subroutine march(linkage, start, first_pose, sense, span, path)
    type(linkage_t), intent(in) :: linkage
    real(wp), intent(in) :: start
    type(pose_t), intent(in) :: first_pose
    real(wp), intent(in) :: sense !! +1: up; −1: down
    real(wp), intent(in) :: span  !! of the linkage [m]
    type(path_t), intent(out) :: path

    type(pose_t) :: pose, next
    type(kinematic_coefficients_t) :: coefficients
    real(wp) :: c, step, most_step, goal, unit
    integer :: halvings, stations, turns
    logical :: is_angle, is_good

    is_angle = linkage%drives(1)%kind == drives_angle
    most_step = length_step*span
    if (is_angle) most_step = angle_step
    unit = 1.0_wp
    if (is_angle) unit = degree
    pose = first_pose
    c = start
    coefficients = find_kinematic_coefficients(linkage, pose)
    stations = 0
    call append_station(path, stations, c, pose, coefficients, unit)
    halvings = 0
    turns = 1
    goal = start + sense*360.0_wp
    if (any(abs(pose%sine) < dead_point_sine)) then
      call trim_path(path, stations)
      return
    end if
    do
      step = sense*most_step/2.0_wp**halvings
      if (is_angle) then
        ! A station stands exactly at every whole turn.
        if (sense*(goal - c - step) < 1.0e-6_wp*most_step) step = goal - c
      end if
      call make_step(linkage, c, pose, coefficients, step, unit, next, is_good)
      if (.not. is_good) then
        halvings = halvings + 1
        if (halvings > most_halvings) exit
        cycle
      end if
      c = c + step
      if (is_angle .and. abs(c - goal) < 1.0e-9_wp) c = goal
      pose = next
      coefficients = find_kinematic_coefficients(linkage, pose)
      call append_station(path, stations, c, pose, coefficients, unit)
      halvings = max(0, halvings - 1)
      if (is_angle) then
        if (abs(c - goal) > 0.0_wp) cycle
        if (repeats(pose, first_pose, span)) then
          ! Whole turns to the last digit, wherever they start.
          path%period = turns*360.0_wp
          exit
        end if
        if (turns >= most_turns) exit
        turns = turns + 1
        goal = start + sense*turns*360.0_wp
      else
        if (abs(c - start) > 10.0_wp*span) exit
      end if
    end do
    call trim_path(path, stations)
  end subroutine march

  !> One step along the path; not good if it may have left the branch.
  pure subroutine make_step(linkage, c, pose, coefficients, step, unit, next, is_good)
    type(linkage_t), intent(in) :: linkage
    real(wp), intent(in) :: c    !! coordinate before the step
    type(pose_t), intent(in) :: pose
    type(kinematic_coefficients_t), intent(in) :: coefficients
    real(wp), intent(in) :: step
    real(wp), intent(in) :: unit !! of the coordinate in [rad] or [m]
    type(pose_t), intent(out) :: next
    logical, intent(out) :: is_good

    type(error_t), allocatable :: error
    real(wp) :: d, angle, correction
    integer :: b

    d = step*unit
    next = pose
    next%pin = pose%pin + d*coefficients%pin + 0.5_wp*d**2*coefficients%pin_slope
    do b = 1, size(pose%direction, 2)
      angle = d*coefficients%turn(b) + 0.5_wp*d**2*coefficients%turn_slope(b)
      next%direction(:, b) = cos(angle)*pose%direction(:, b) + sin(angle)*normal_to( &
        pose%direction(:, b))
    end do
    call place_groups(linkage, c + step, next, correction, error)
    is_good = .not. allocated(error)
    if (.not. is_good) return
    is_good = all(next%sine*pose%sine > 0.0_wp) .and. all(abs(next%sine) > &
      dead_point_sine) .and. correction <= 0.1_wp*maxval(abs(next%pin - pose%pin))
  end subroutine make_step

  !> Whether all pins and bodies are where they were.
  pure function repeats(pose, first, span)
    type(pose_t), intent(in) :: pose, first
    real(wp), intent(in) :: span
    logical :: repeats

    repeats = maxval(abs(pose%pin - first%pin)) <= same_pose*span .and. &
      maxval(abs(pose%direction - first%direction)) <= same_pose
  end function repeats

  !> Adds a station; room grows by doubling.
  pure subroutine append_station(path, stations, c, pose, coefficients, unit)
    type(path_t), intent(inout) :: path
    integer, intent(inout) :: stations
    real(wp), intent(in) :: c
    type(pose_t), intent(in) :: pose
    type(kinematic_coefficients_t), intent(in) :: coefficients
    real(wp), intent(in) :: unit

    if (.not. allocated(path%crank)) then
      call resize(path, 256, stations, size(pose%pin, 2), size(pose%direction, 2))
    else if (stations == size(path%crank)) then
      call resize(path, 2*stations, stations, size(pose%pin, 2), size(pose%direction, 2))
    end if
    stations = stations + 1
    path%crank(stations) = c
    path%pin(:, :, stations) = pose%pin
    path%direction(:, :, stations) = pose%direction
    path%pin_rate(:, :, stations) = unit*coefficients%pin
    path%turn_rate(:, stations) = unit*coefficients%turn
  end subroutine append_station

  !> Gives a path room for a number of stations, and keeps those it has.
  pure subroutine resize(path, room, stations, pins, bodies)
    type(path_t), intent(inout) :: path
    integer, intent(in) :: room, stations, pins, bodies

    type(path_t) :: larger

    larger%period = path%period
    allocate (larger%crank(room), larger%pin(2, pins, room), larger%direction(2, bodies, room), &
      larger%pin_rate(2, pins, room), larger%turn_rate(bodies, room))
    if (stations > 0) then
      larger%crank(:stations) = path%crank(:stations)
      larger%pin(:, :, :stations) = path%pin(:, :, :stations)
      larger%direction(:, :, :stations) = path%direction(:, :, :stations)
      larger%pin_rate(:, :, :stations) = path%pin_rate(:, :, :stations)
      larger%turn_rate(:, :stations) = path%turn_rate(:, :stations)
    end if
    path = larger
  end subroutine resize

  !> Takes away the room that no station uses.
  pure subroutine trim_path(path, stations)
    type(path_t), intent(inout) :: path
    integer, intent(in) :: stations

    call resize(path, stations, stations, size(path%pin, 2), size(path%direction, 2))
  end subroutine trim_path

  !> The way down, turned round, and the way up; the station where both begin once.
  pure subroutine join(down, up, path)
    type(path_t), intent(in) :: down, up
    type(path_t), intent(out) :: path

    integer :: n, i, at, stations

    n = size(down%crank)
    stations = n + size(up%crank) - 1
    call resize(path, stations, 0, size(up%pin, 2), size(up%direction, 2))
    do i = 1, stations
      if (i < n) then
        at = n + 1 - i
        path%crank(i) = down%crank(at)
        path%pin(:, :, i) = down%pin(:, :, at)
        path%direction(:, :, i) = down%direction(:, :, at)
        path%pin_rate(:, :, i) = down%pin_rate(:, :, at)
        path%turn_rate(:, i) = down%turn_rate(:, at)
      else
        at = i - n + 1
        path%crank(i) = up%crank(at)
        path%pin(:, :, i) = up%pin(:, :, at)
        path%direction(:, :, i) = up%direction(:, :, at)
        path%pin_rate(:, :, i) = up%pin_rate(:, :, at)
        path%turn_rate(:, i) = up%turn_rate(:, at)
      end if
    end do
  end subroutine join

end module linkage_paths
