!> The way of a linkage with change points, or whose groups only iterations place: followed once,
!! from the drawing, over whole turns of the first drive.
!!
!! From station to station Newton's method, or the choice between two places, starts from the
!! velocities and accelerations of the last one. A step is halved unless it is good: the linkage
!! cannot leave its branch. Change points are bridged.
module linkage_paths
  use bridges, only: cross_bridge
  use change_points, only: find_bridge, is_near_change, near_change
  use constants, only: degree
  use drive_values, only: drive_weight
  use errors, only: error_of_dead_point, error_of_input, error_t, set_error
  use kinds, only: wp
  use linkages, only: bridge_t, rule_branch, rule_stop, rule_through, drive_of_angle, gives_angle, &
    follows_angle, group_t, group_by_newton, is_dyad_linkage, linkage_t, path_t, reference_point
  use path_limits, only: approach_t, watch
  use path_steps, only: new_station, station_t, take_step
  use pose_types, only: count_from, drawn_pose, pose_t
  use poses, only: dead_point_sine, place_groups, place_links
  use time_steps, only: step_in_time
  implicit none (type, external)
  private

  public :: follow_path, leave_path, has_change_points, period_of, has_iterations

  !> Largest step between stations: of an angle [deg]; of a length as a share of the linkage.
  real(wp), parameter :: angle_step = 2.0_wp, length_step = 0.005_wp

  !> Steps are halved this often, at most: then the path ends.
  integer, parameter :: most_halvings = 40

  !> Turns after which a linkage that has not repeated its positions is taken to have no period:
  !! where drives alone tell, and where it is followed.
  integer, parameter :: most_turns = 1000, most_turns_followed = 8

  !> A pose repeats an earlier one if all pins are this near, as a share of the linkage.
  real(wp), parameter :: same_pose = 1.0e-9_wp

  !> Bridges may begin where determinants are this share of their usual size.
  real(wp), parameter :: nearest_start = near_change/8.0_wp

  !> Dyads that close this share of a step beyond the end of a path are lost, not at a limit.
  real(wp), parameter :: a_little = 1.0e-7_wp

  !> Farther from the drawing than this share of the linkage no assembly is what was drawn.
  real(wp), parameter :: drawing_reach = 0.2_wp

contains

  !> Whether a linkage has groups that only iterations place.
  pure function has_iterations(linkage) result(has)
    type(linkage_t), intent(in) :: linkage !! its groups
    logical :: has

    has = any(linkage%groups%kind == group_by_newton)
  end function has_iterations

  !> Whether a linkage goes smoothly through points at which its equations depend on each other.
  pure function has_change_points(linkage) result(has)
    type(linkage_t), intent(in) :: linkage !! with its path, if it has one
    logical :: has

    has = allocated(linkage%path%crank)
    if (has) has = size(linkage%path%bridges) > 0
  end function has_change_points

  !> The interval of the first drive after which all positions repeat [deg]; 0: there is none.
  pure function period_of(linkage) result(period)
    type(linkage_t), intent(in) :: linkage !! its drives, and its path if it has one
    real(wp) :: period

    period = 0.0_wp
    if (.not. follows_angle(linkage)) return
    period = period_of_drives(linkage)
    if (allocated(linkage%path%crank)) period = linkage%path%period
  end function period_of

  !> The interval of the first drive, an angle, after which all drives repeat [deg]; 0: there is
  !! none.
  pure function period_of_drives(linkage) result(period)
    type(linkage_t), intent(in) :: linkage !! its drives
    real(wp) :: period

    !> A ratio is that of whole numbers but for rounding.
    real(wp), parameter :: rounding = 4.0_wp*epsilon(1.0_wp)
    integer :: turns, i
    logical :: repeats

    do turns = 1, most_turns
      repeats = .true.
      do i = 2, size(linkage%drives)
        associate (drive => linkage%drives(i), others => turns*linkage%drives(i)%ratio)
          if (abs(drive%ratio) <= 0.0_wp) cycle
          repeats = repeats .and. drive%kind == drive_of_angle .and. &
            abs(others - anint(others)) <= rounding*abs(others)
        end associate
      end do
      period = 360.0_wp*turns
      if (repeats) return
    end do
    period = 0.0_wp
  end function period_of_drives

  !> Finds the path of a linkage with change points, or with groups that only iterations place.
  !!
  !! Errors: the linkage does not assemble near the drawing; the pose found is then that of the
  !! iterations, if they converged. It is at a dead point there.
  pure subroutine follow_path(linkage, starts, changes, nearest, error)
    type(linkage_t), intent(inout) :: linkage !! with groups and drawing; its path is set
    real(wp), intent(in) :: starts(:)         !! coordinates of the first drive [deg] or [m]: in the
                                              !! drawing, or without one those of the deck, of which
                                              !! the first serves that is no change point
    integer, intent(in) :: changes            !! one of the rule_… constants
    type(pose_t), allocatable, intent(out) :: nearest !! assembly nearest to the drawing, in global
                                                      !! axes; not allocated without one
    type(error_t), allocatable, intent(inout) :: error !! why there is no path

    type(station_t) :: first
    type(path_t) :: path
    real(wp) :: usual(size(linkage%groups)), span

    if (allocated(linkage%path%crank)) deallocate (linkage%path%crank)
    usual = 0.0_wp
    if (has_iterations(linkage)) then
      call begin_at_drawing(linkage, starts(1), first, span, nearest, error)
      if (allocated(error)) return
      call follow_by_iterations(linkage, first, span, changes == rule_through .and. &
        .not. linkage%runs_in_time)
      if (size(linkage%path%crank) == 1) call set_error(error, error_of_dead_point, &
        "dead point: the linkage cannot be followed from the drawing")
      return
    end if
    ! In time dyads keep their sides.
    if (linkage%runs_in_time .or. .not. may_change(linkage)) return
    call begin_at_place(linkage, starts, first, span, usual)
    if (span <= 0.0_wp) return
    call follow(linkage, first, span, usual, .true., path)
    if (changes == rule_branch) call find_jumps(linkage, path%bridges)
    if ((size(path%bridges) == 0 .and. .not. any(path%is_lost)) .or. changes == rule_branch) then
      ! Dyads need no path where their sides are the same everywhere.
      deallocate (path%crank)
    else if (changes == rule_stop) then
      call follow(linkage, first, span, usual, .false., path)
      path%stops = .true.
    end if
    linkage%path = path
  end subroutine follow_path

  !> The place of iterations nearest to the drawing.
  pure subroutine begin_at_drawing(linkage, start, first, span, nearest, error)
    type(linkage_t), intent(inout) :: linkage !! usual sizes of groups by iterations are set
    real(wp), intent(in) :: start
    type(station_t), intent(out) :: first
    real(wp), intent(out) :: span !! of the linkage [m]
    type(pose_t), allocatable, intent(out) :: nearest
    type(error_t), allocatable, intent(inout) :: error

    type(pose_t) :: pose
    logical :: is_given(size(linkage%is_ground))
    real(wp) :: correction, farthest
    integer :: i

    pose = drawn_pose(linkage, reference_point(linkage))
    call place_groups(linkage, start, pose, correction, error)
    if (allocated(error)) return
    span = linkage_span(linkage, pose)
    farthest = 0.0_wp
    is_given = linkage%drawing%is_drawn .and. .not. linkage%is_ground
    if (allocated(linkage%drawing%follows)) is_given = is_given .and. .not. linkage%drawing%follows
    do i = 1, size(linkage%is_ground)
      if (is_given(i)) farthest = max(farthest, norm2(pose%pin(:, i) + pose%origin - &
        linkage%drawing%pin(:, i)))
    end do
    if (farthest > drawing_reach*span) then
      nearest = pose
      call count_from([0.0_wp, 0.0_wp], nearest)
      call set_error(error, error_of_input, "the linkage does not assemble near the drawing")
      return
    end if
    call take_usual(linkage, abs(pose%sine), pose)
    first = new_station(linkage, start, pose)
  end subroutine begin_at_drawing

  !> Sizes of groups by iterations are measured by larger ones from now on.
  pure subroutine take_usual(linkage, sine, pose)
    type(linkage_t), intent(inout) :: linkage
    real(wp), intent(in) :: sine(:)    !! (groups) that are usual, by the old measure
    type(pose_t), intent(inout) :: pose

    integer :: i

    do i = 1, size(sine)
      ! Smaller ones are a dead point whatever is usual: too many digits are lost.
      if (linkage%groups(i)%kind /= group_by_newton .or. sine(i) < dead_point_sine) cycle
      linkage%groups(i)%usual = linkage%groups(i)%usual*sine(i)
      pose%sine(i) = pose%sine(i)/sine(i)
    end do
  end subroutine take_usual

  !> The way of a linkage with groups that iterations place. Drawn near a dead point it is followed
  !! once more, for what is small has been unknown.
  pure subroutine follow_by_iterations(linkage, first, span, through)
    type(linkage_t), intent(inout) :: linkage
    type(station_t), intent(inout) :: first
    real(wp), intent(in) :: span
    logical, intent(in) :: through

    type(path_t) :: path
    real(wp) :: usual(size(linkage%groups))

    usual = 0.0_wp
    call follow(linkage, first, span, usual, through, path)
    if (any(usual > 2.0_wp)) then
      call take_usual(linkage, max(usual, 1.0_wp), first%pose)
      usual = 0.0_wp
      call follow(linkage, first, span, usual, through, path)
    end if
    linkage%path = path
  end subroutine follow_by_iterations

  !> Whether dyads may have a change point: on the sides that they have, some determinant comes near
  !! to zero in a period of the first drive. Of a drive without a period that is not known.
  pure function may_change(linkage) result(may)
    type(linkage_t), intent(in) :: linkage
    logical :: may

    !> At steps between stations a determinant that passes zero is below this share of its largest.
    real(wp), parameter :: low = 0.2_wp
    type(pose_t) :: pose
    type(error_t), allocatable :: error
    real(wp), dimension(size(linkage%groups)) :: least, greatest
    real(wp) :: period, correction
    integer :: i

    if (is_dyad_linkage(linkage) .and. size(linkage%groups) == 1) then
      may = adds_up(linkage, linkage%groups(1))
      return
    end if
    period = period_of(linkage)
    may = period <= 0.0_wp
    least = 1.0_wp
    greatest = 0.0_wp
    do i = 1, nint(period/angle_step)
      call place_groups(linkage, i*angle_step, pose, correction, error)
      if (allocated(error)) then
        deallocate (error)
        cycle
      end if
      least = min(least, abs(pose%sine))
      greatest = max(greatest, abs(pose%sine))
      may = any(least < low*greatest)
      if (may) return
    end do
  end function may_change

  !> Whether the crank comes just as near to the other pivot, or as far from it, as a dyad folds or
  !! stretches.
  pure function adds_up(linkage, dyad) result(does)
    type(linkage_t), intent(in) :: linkage
    type(group_t), intent(in) :: dyad
    logical :: does

    real(wp), parameter :: nearly = 1.0e-6_wp
    real(wp) :: ground, r(2), reach(4)

    ground = norm2(linkage%ground_position(:, dyad%base(2)) - linkage%ground_position(:, &
      linkage%bodies(1)%first_pin))
    associate (crank => linkage%bodies(1)%length)
      r = linkage%bodies(dyad%body)%length
      reach = [ground + crank - sum(r), ground + crank - abs(r(1) - r(2)), &
        abs(ground - crank) - sum(r), abs(ground - crank) - abs(r(1) - r(2))]
      does = any(abs(reach) < nearly*(ground + crank))
    end associate
  end function adds_up

  !> Where dyads on their sides would jump.
  pure subroutine find_jumps(linkage, bridges)
    type(linkage_t), intent(in) :: linkage
    type(bridge_t), intent(inout) :: bridges(:)

    !> So near pins have come together, as a share of the links.
    real(wp), parameter :: together = 1.0e-6_wp
    type(pose_t) :: pose
    integer :: i

    do i = 1, size(bridges)
      call cross_bridge(linkage, bridges(i), bridges(i)%change, pose)
      associate (group => linkage%groups(bridges(i)%group))
        if (group%base(2) == 0) cycle
        bridges(i)%is_jump = norm2(pose%pin(:, group%base(2)) - pose%pin(:, group%base(1))) < &
          together*maxval(linkage%bodies(group%body)%length)
      end associate
    end do
  end subroutine find_jumps

  !> Dyads without a path, on the sides on which the path has them at a coordinate.
  pure subroutine leave_path(linkage, crank)
    type(linkage_t), intent(inout) :: linkage
    real(wp), intent(in) :: crank !! [deg] or [m]

    type(pose_t) :: pose
    type(error_t), allocatable :: error

    if (.not. allocated(linkage%path%crank) .or. has_iterations(linkage)) return
    call place_links(linkage, crank, pose, error)
    if (.not. allocated(error)) linkage%groups%side = sign(1.0_wp, pose%sine)
    deallocate (linkage%path%crank)
  end subroutine leave_path

  !> The first of some places where a linkage of dyads closes or, if a bridge cannot begin there,
  !! one beside it, on the side on which it is of its change point.
  pure subroutine begin_at_place(linkage, starts, first, span, usual)
    type(linkage_t), intent(in) :: linkage
    real(wp), intent(in) :: starts(:)
    type(station_t), intent(out) :: first
    real(wp), intent(out) :: span         !! of the linkage [m]; 0: there is none
    real(wp), intent(inout) :: usual(:)   !! (groups) largest determinants there

    integer, parameter :: most_places = 100
    real(wp), parameter :: beside(*) = [1.0e-3_wp, 0.5_wp, 1.0_wp, 3.0_wp, 10.0_wp] !! [deg], or
                                          !! hundredths of the longest link
    type(pose_t) :: pose, best
    type(error_t), allocatable :: error
    real(wp), allocatable :: places(:)
    real(wp) :: correction, start, unit
    integer :: i, k

    span = 0.0_wp
    unit = 1.0_wp
    if (.not. gives_angle(linkage%drives(1))) unit = 0.01_wp*maxval(linkage%bodies%length)
    ! Where pins that carry a dyad meet nothing is placed.
    places = [starts(::1 + (size(starts) - 1)/most_places), starts(1) + beside(2:)*unit]
    do i = 1, size(places)
      call place_groups(linkage, places(i), pose, correction, error)
      if (allocated(error)) then
        deallocate (error)
        cycle
      end if
      usual = max(usual, abs(pose%sine))
      if (.not. allocated(best%sine)) best = pose
    end do
    if (.not. allocated(best%sine)) return
    start = best%crank
    k = minloc(abs(best%sine)/max(usual, tiny(1.0_wp)), dim=1)
    do i = 1, size(beside)
      if (.not. (is_near_change(best%sine, usual, nearest_start) .or. &
        any(abs(best%sine) < dead_point_sine))) exit
      call place_groups(linkage, start + beside(i)*unit, pose, correction, error)
      if (allocated(error)) exit
      usual = max(usual, abs(pose%sine))
      if (i == 1) then
        if (abs(pose%sine(k)) < abs(best%sine(k))) unit = -unit
        cycle
      end if
      best = pose
    end do
    if (any(abs(best%sine) < dead_point_sine)) return
    span = linkage_span(linkage, best)
    first = new_station(linkage, best%crank, best)
  end subroutine begin_at_place

  !> The way from a place in both senses, or over a whole period.
  pure subroutine follow(linkage, first, span, usual, through, path)
    type(linkage_t), intent(in) :: linkage
    type(station_t), intent(in) :: first
    real(wp), intent(in) :: span
    real(wp), intent(inout) :: usual(:) !! (groups) largest determinants, as far as known
    logical, intent(in) :: through !! change points
    type(path_t), intent(out) :: path

    type(path_t) :: up, down

    call march(linkage, first, 1.0_wp, span, usual, through, up)
    if (up%period > 0.0_wp) then
      path = up
      return
    end if
    call march(linkage, first, -1.0_wp, span, usual, through, down)
    call join(down, up, path)
    ! Within less than a turn an angle is the same with and without whole turns.
    if (follows_angle(linkage) .and. path%crank(size(path%crank)) - &
      path%crank(1) < 360.0_wp) path%period = 360.0_wp
  end subroutine follow

  !> The largest extent of a linkage [m].
  pure function linkage_span(linkage, pose) result(span)
    type(linkage_t), intent(in) :: linkage
    type(pose_t), intent(in) :: pose
    real(wp) :: span

    span = max(maxval(maxval(pose%pin, dim=2) - minval(pose%pin, dim=2)), &
      maxval(linkage%bodies%length))
  end function linkage_span

  !> Follows the linkage in one sense until it repeats its pose, ends, or has made enough turns; in
  !! time to the last instant.
  pure subroutine march(linkage, first, sense, span, usual, through, path)
    type(linkage_t), intent(in) :: linkage
    type(station_t), intent(in) :: first
    real(wp), intent(in) :: sense       !! +1: up; −1: down
    real(wp), intent(in) :: span        !! of the linkage [m]
    real(wp), intent(inout) :: usual(:) !! (groups) largest determinants, as far as known
    logical, intent(in) :: through      !! change points
    type(path_t), intent(out) :: path

    type(station_t) :: here, next, last, behind
    type(bridge_t) :: bridge
    type(approach_t) :: approach
    type(pose_t) :: pose
    real(wp) :: step, most_step, goal, unit, weight
    integer :: halvings, stations, turns
    logical :: is_angle, is_close, is_good, is_free, is_ahead, found

    is_angle = follows_angle(linkage)
    weight = drive_weight(linkage, 1)
    most_step = merge(angle_step, length_step*span, is_angle)*weight
    unit = 1.0_wp
    if (is_angle) unit = degree
    usual = max(usual, abs(first%pose%sine))
    here = first
    stations = 0
    allocate (path%bridges(0))
    call append_station(path, stations, here, unit)
    halvings = 0
    turns = 1
    goal = first%crank + sense*360.0_wp
    if (any(abs(here%pose%sine) < dead_point_sine)) then
      call trim_path(path, stations)
      return
    end if
    is_close = .false.
    do
      if (linkage%runs_in_time) then
        most_step = step_in_time(linkage, here%crank, sense, angle_step, length_step*span)
        if (.not. most_step > 0.0_wp) exit
      end if
      step = sense*most_step/2.0_wp**halvings
      if (is_angle) then
        ! A station stands exactly at every whole turn.
        if (sense*(goal - here%crank - step) < 1.0e-6_wp*most_step) step = goal - here%crank
      end if
      ! Beside a coordinate that is too large the step is nothing.
      if (.not. abs(here%crank + step - here%crank) > 0.0_wp) exit
      call take_step(linkage, here, step, unit, next, is_good)
      is_free = is_good
      if (is_good) is_free = .not. is_near_change(next%pose%sine, usual, near_change)
      if (.not. (is_free .or. is_close)) then
        found = .false.
        is_close = .true.
        if (through) then
          call find_bridge(linkage, here, sense*most_step, unit, usual, span, bridge, last, &
            behind, found, is_ahead)
          is_close = .not. (found .or. is_ahead)
        end if
        if (found) then
          path%bridges = [path%bridges, bridge]
          if (abs(last%crank - here%crank) > 0.0_wp) call append_station(path, stations, last, unit)
          next = behind
          is_good = .true.
        end if
      end if
      if (.not. is_good) then
        halvings = halvings + 1
        if (halvings > most_halvings) exit
        cycle
      end if
      here = next
      if (is_angle .and. abs(here%crank - goal) < 1.0e-9_wp) here%crank = goal
      call append_station(path, stations, here, unit)
      usual = max(usual, abs(here%pose%sine))
      if (is_close) is_close = is_near_change(here%pose%sine, usual, near_change)
      halvings = max(0, halvings - 1)
      if (linkage%runs_in_time) cycle
      call watch(linkage, here, span, approach)
      if (approach%is_over) exit
      if (is_angle) then
        if (sense*(goal - here%crank) > 0.0_wp) cycle
        pose = here%pose
        ! A bridge may lead over the end of a turn.
        if (abs(here%crank - goal) > 0.0_wp) call cross_bridge(linkage, bridge, goal, pose)
        if (repeats(pose, first%pose, span)) then
          ! Whole turns to the last digit, wherever they start.
          path%period = turns*360.0_wp
          exit
        end if
        if (turns >= min(most_turns_followed*weight, 1.0_wp*most_turns)) exit
        turns = turns + 1
        goal = first%crank + sense*turns*360.0_wp
      else
        if (abs(here%crank - first%crank) > 10.0_wp*span*weight) exit
      end if
    end do
    if (approach%is_found) then
      path%limits(merge(2, 1, sense > 0.0_wp)) = approach%limit
    else if (through .and. halvings > most_halvings .and. .not. has_iterations(linkage)) then
      path%is_lost(merge(2, 1, sense > 0.0_wp)) = closes_at(linkage, here%crank + &
        a_little*sense*most_step, here%pose)
    end if
    call trim_path(path, stations)
  end subroutine march

  !> Whether dyads close at a coordinate on the sides that they have in a pose.
  pure function closes_at(linkage, crank, pose) result(does)
    type(linkage_t), intent(in) :: linkage
    real(wp), intent(in) :: crank    !! [deg] or [m]
    type(pose_t), intent(in) :: pose
    logical :: does

    type(pose_t) :: there
    type(error_t), allocatable :: error
    real(wp) :: correction

    call place_groups(linkage, crank, there, correction, error, sign(1.0_wp, pose%sine))
    does = .not. allocated(error)
  end function closes_at

  !> Whether all pins and bodies are where they were.
  pure function repeats(pose, first, span)
    type(pose_t), intent(in) :: pose, first
    real(wp), intent(in) :: span
    logical :: repeats

    repeats = maxval(abs(pose%pin - first%pin)) <= same_pose*span .and. &
      maxval(abs(pose%direction - first%direction)) <= same_pose
  end function repeats

  !> Adds a station; room grows by doubling.
  pure subroutine append_station(path, stations, station, unit)
    type(path_t), intent(inout) :: path
    integer, intent(inout) :: stations
    type(station_t), intent(in) :: station
    real(wp), intent(in) :: unit

    if (.not. allocated(path%crank)) then
      call resize(path, 256, stations, station%pose)
    else if (stations == size(path%crank)) then
      call resize(path, 2*stations, stations, station%pose)
    end if
    stations = stations + 1
    path%crank(stations) = station%crank
    path%pin(:, :, stations) = station%pose%pin
    path%direction(:, :, stations) = station%pose%direction
    path%pin_rate(:, :, stations) = unit*station%coefficients%pin
    path%turn_rate(:, stations) = unit*station%coefficients%turn
    path%side(:, stations) = sign(1.0_wp, station%pose%sine)
  end subroutine append_station

  !> Gives a path room for a number of stations, and keeps those it has.
  pure subroutine resize(path, room, stations, pose)
    type(path_t), intent(inout) :: path
    integer, intent(in) :: room, stations
    type(pose_t), intent(in) :: pose !! any, for its sizes

    type(path_t) :: larger

    larger%period = path%period
    larger%limits = path%limits
    larger%is_lost = path%is_lost
    larger%bridges = path%bridges
    associate (pins => size(pose%pin, 2), bodies => size(pose%direction, 2))
      allocate (larger%crank(room), larger%pin(2, pins, room), larger%direction(2, bodies, room), &
        larger%pin_rate(2, pins, room), larger%turn_rate(bodies, room), &
        larger%side(size(pose%sine), room))
    end associate
    if (stations > 0) then
      larger%crank(:stations) = path%crank(:stations)
      larger%pin(:, :, :stations) = path%pin(:, :, :stations)
      larger%direction(:, :, :stations) = path%direction(:, :, :stations)
      larger%pin_rate(:, :, :stations) = path%pin_rate(:, :, :stations)
      larger%turn_rate(:, :stations) = path%turn_rate(:, :stations)
      larger%side(:, :stations) = path%side(:, :stations)
    end if
    path = larger
  end subroutine resize

  !> Takes away the room that no station uses.
  pure subroutine trim_path(path, stations)
    type(path_t), intent(inout) :: path
    integer, intent(in) :: stations

    path%crank = path%crank(:stations)
    path%pin = path%pin(:, :, :stations)
    path%direction = path%direction(:, :, :stations)
    path%pin_rate = path%pin_rate(:, :, :stations)
    path%turn_rate = path%turn_rate(:, :stations)
    path%side = path%side(:, :stations)
  end subroutine trim_path

  !> The way down, turned round, and the way up; the station where both begin once.
  pure subroutine join(down, up, path)
    type(path_t), intent(in) :: down, up
    type(path_t), intent(out) :: path

    integer :: i, n

    n = size(down%crank)
    path%crank = [down%crank(n:2:-1), up%crank]
    path%limits(1) = down%limits(1)
    path%limits(2) = up%limits(2)
    path%is_lost = down%is_lost .or. up%is_lost
    path%bridges = [(down%bridges(i), i=size(down%bridges), 1, -1), (up%bridges(i), i=1, &
      size(up%bridges))]
    associate (stations => size(path%crank), pins => size(up%pin, 2), &
        bodies => size(up%turn_rate, 1))
      allocate (path%pin(2, pins, stations), path%direction(2, bodies, stations), &
        path%pin_rate(2, pins, stations), path%turn_rate(bodies, stations), &
        path%side(size(up%side, 1), stations))
    end associate
    path%pin(:, :, :n - 1) = down%pin(:, :, n:2:-1)
    path%pin(:, :, n:) = up%pin
    path%direction(:, :, :n - 1) = down%direction(:, :, n:2:-1)
    path%direction(:, :, n:) = up%direction
    path%pin_rate(:, :, :n - 1) = down%pin_rate(:, :, n:2:-1)
    path%pin_rate(:, :, n:) = up%pin_rate
    path%turn_rate(:, :n - 1) = down%turn_rate(:, n:2:-1)
    path%turn_rate(:, n:) = up%turn_rate
    path%side(:, :n - 1) = down%side(:, n:2:-1)
    path%side(:, n:) = up%side
  end subroutine join

end module linkage_paths
