!> Where the first drive, or another one, can be.
module crank_limits
  use drive_values, only: drive_weight
  use errors, only: error_t
  use kinds, only: wp
  use linkage_paths, only: period_of
  use linkages, only: bridge_t, gives_angle, linkage_t
  use low_points, only: find_gap, find_sines
  use pose_types, only: pose_t
  use poses, only: place_links
  use sorting, only: ascending_order
  implicit none (type, external)
  private

  public :: crank_range_t, find_ranges, find_ranges_of_deck, in_turns_of

  !> An interval of the first drive in which the linkage closes on its branch.
  type :: crank_range_t
    real(wp) :: from = 0.0_wp, to = 0.0_wp !! [deg] or [m]
    logical :: turns = .false.             !! a whole period, without limits
    integer :: blocked_by(2) = 0           !! groups that end it; 0: none
    integer :: left_at(2) = 0              !! pins of blocks that there leave their links; 0: none
    logical :: is_open(2) = .false.        !! no end has been found: the range goes on
    integer :: samples = 720               !! extremes between them are found to rounding where the
                                           !! rate changes its sign once
  end type crank_range_t

  !> Samples of a turn, or of the length of the longest link.
  integer, parameter :: samples = 720

  !> An end is looked for in steps of samples so far: turns of a linkage without a period, lengths
  !! of the longest link. From there on steps of a length double.
  integer, parameter :: turns_searched = 50, lengths_searched = 20, most_doublings = 16

  integer, parameter :: most_halvings = 80

contains

  !> The intervals in which the linkage closes; of a driven length, those around given coordinates.
  !! They are those of the first drive, or of another one that alone moves: with the ratio 1, and 0
  !! of all others.
  pure subroutine find_ranges(linkage, inside, ranges, drive)
    type(linkage_t), intent(in) :: linkage                      !! of any kind, with its path
    real(wp), intent(in) :: inside(:)                           !! coordinates of the deck [deg] or
                                                                !! [m]
    type(crank_range_t), allocatable, intent(out) :: ranges(:)  !! ascending; none if it closes
                                                                !! nowhere
    integer, intent(in), optional :: drive                      !! number of that other one

    type(crank_range_t) :: range
    real(wp) :: step, c, period, first
    real(wp) :: place
    real(wp), allocatable :: sine(:, :)
    logical, allocatable :: closes(:)
    logical :: is_angle, found
    integer, allocatable :: order(:)
    integer :: i, k, n, group, number

    allocate (ranges(0))
    period = period_of(linkage)
    is_angle = gives_angle(linkage%drives(1))
    if (present(drive)) then
      is_angle = gives_angle(linkage%drives(drive))
      period = merge(360.0_wp, 0.0_wp, is_angle)
    end if
    if (period <= 0.0_wp) then
      step = 360.0_wp/samples
      if (.not. is_angle) step = maxval(linkage%bodies%length)/samples
      number = 1
      if (present(drive)) number = drive
      step = step*drive_weight(linkage, number)
      order = ascending_order(inside)
      do i = 1, size(inside)
        c = inside(order(i))
        if (size(ranges) > 0) then
          if (c <= ranges(size(ranges))%to + 1.0e-6_wp*step) cycle
        end if
        if (.not. is_closed(linkage, c)) cycle
        call find_end(linkage, c, -step, is_angle, minval(inside), range, 1)
        call find_end(linkage, c, step, is_angle, maxval(inside), range, 2)
        call set_samples(range, is_angle)
        ranges = [ranges, range]
      end do
      return
    end if
    n = samples*nint(period/360.0_wp)
    allocate (closes(0:n), sine(size(linkage%groups), 0:n + 1))
    do i = 0, n
      call find_sines(linkage, period*i/n, sine(:, i), closes(i))
    end do
    sine(:, n + 1) = sine(:, 1)
    ! From a gap on, round the period.
    k = findloc(closes(:n - 1), .false., dim=1) - 1
    do i = 1, n
      if (k >= 0) exit
      call find_jump(linkage, period*(i - 1)/n, period*i/n, group, place)
      if (group > 0) k = i - 1
      if (group > 0) exit
      call find_gap(linkage, period*[i - 1, i, i + 1]/n, sine(:, i - 1:i + 1), found, place)
      if (found) k = floor(place*n/period)
    end do
    if (k < 0) then
      range%to = period
      range%turns = .true.
      call set_samples(range, is_angle)
      ranges = [range]
      return
    end if
    step = period/n
    first = period*k/n
    i = 1
    do while (i <= n)
      c = first + step*i
      if (.not. closes(modulo(k + i, n))) then
        i = i + 1
        cycle
      end if
      call find_end(linkage, c, -step, is_angle, c, range, 1)
      call find_end(linkage, c, step, is_angle, c, range, 2)
      call set_samples(range, is_angle)
      ranges = [ranges, range]
      i = max(i + 1, 1 + floor((range%to - first)/step))
    end do
  end subroutine find_ranges

  !> The ranges of the first drive in the turns of a deck's positions, ascending there.
  pure subroutine find_ranges_of_deck(linkage, inside, positions, ranges)
    type(linkage_t), intent(in) :: linkage                      !! of any kind, with its path
    real(wp), intent(in) :: inside(:)                           !! of a driven length, those around
                                                                !! which are found [deg] or [m]
    real(wp), intent(in) :: positions(:)                        !! of the deck [deg] or [m]
    type(crank_range_t), allocatable, intent(out) :: ranges(:)

    real(wp) :: ends(2)
    integer :: r

    call find_ranges(linkage, inside, ranges)
    do r = 1, size(ranges)
      ends = in_turns_of(ranges(r), period_of(linkage), positions)
      ranges(r)%from = ends(1)
      ranges(r)%to = ends(2)
    end do
    ranges = ranges(ascending_order(ranges%from))
  end subroutine find_ranges_of_deck

  !> The ends of a range in those turns that some positions have: where most of it is between them;
  !! then nearest to 0.
  pure function in_turns_of(range, period, positions) result(ends)
    type(crank_range_t), intent(in) :: range !! one of `find_ranges`
    real(wp), intent(in) :: period           !! of the linkage [deg]; 0: none
    real(wp), intent(in) :: positions(:)     !! of the first drive [deg]; none: about 0
    real(wp) :: ends(2)                      !! [deg] or [m]

    real(wp), parameter :: rounding = 1.0e-6_wp
    real(wp) :: hull(2), tried(2), common, most
    integer :: i, nearest

    ends = [range%from, range%to]
    if (period <= 0.0_wp .or. range%turns) return
    hull = 0.0_wp
    if (size(positions) > 0) hull = [minval(positions), maxval(positions)]
    most = -huge(1.0_wp)
    ! Turns that touch the positions; of many of these those nearest to 0 serve as well as any.
    nearest = nint((min(max(0.0_wp, hull(1)), hull(2)) - 0.5_wp*(range%from + range%to))/period)
    do i = nearest - 2, nearest + 2
      tried = [range%from, range%to] + i*period
      common = min(tried(2), hull(2)) - max(tried(1), hull(1))
      if (common < most - rounding) cycle
      if (common < most + rounding .and. abs(sum(tried)) > abs(sum(ends)) + rounding) cycle
      most = max(most, common)
      ends = tried
    end do
  end function in_turns_of

  pure function is_closed(linkage, crank) result(is)
    type(linkage_t), intent(in) :: linkage
    real(wp), intent(in) :: crank
    logical :: is

    real(wp) :: sine(size(linkage%groups))

    call find_sines(linkage, crank, sine, is)
  end function is_closed

  !> Whether the linkage closes, and no group is at its limit but for rounding.
  pure function is_inside(linkage, crank) result(is)
    type(linkage_t), intent(in) :: linkage
    real(wp), intent(in) :: crank
    logical :: is

    type(pose_t) :: pose
    type(error_t), allocatable :: error

    call place_links(linkage, crank, pose, error)
    is = .not. allocated(error)
    if (is) is = all(abs(pose%sine) > 0.0_wp) .or. allocated(pose%coefficients)
  end function is_inside

  !> Samples of a range with its ends.
  pure subroutine set_samples(range, is_angle)
    type(crank_range_t), intent(inout) :: range
    logical, intent(in) :: is_angle

    range%samples = samples
    if (is_angle) then
      range%samples = samples*max(1, nint((range%to - range%from)/360.0_wp))
    else if (any(range%is_open)) then
      range%samples = samples*lengths_searched
    end if
  end subroutine set_samples

  !> Sets an end of a range: the last coordinate, in steps from one at which the linkage closes, at
  !! which it still does, by bisection; the group that is nearest to its dead point there, and the
  !! block that leaves its link.
  pure subroutine find_end(linkage, inside, step, is_angle, farthest, range, end)
    type(linkage_t), intent(in) :: linkage
    real(wp), intent(in) :: inside
    real(wp), intent(in) :: step      !! with its sign
    logical, intent(in) :: is_angle
    real(wp), intent(in) :: farthest  !! an open range goes as far as here, at least
    type(crank_range_t), intent(inout) :: range
    integer, intent(in) :: end        !! 1: from, 2: to

    type(pose_t) :: pose
    type(error_t), allocatable :: error
    real(wp) :: last, beyond, middle
    integer :: i, group

    range%left_at(end) = 0
    call search_end(linkage, inside, step, is_angle, last, beyond, group, range%is_open(end))
    range%blocked_by(end) = group
    if (range%is_open(end)) then
      if (step*(farthest - last) > 0.0_wp) last = farthest
    else if (group == 0) then
      do i = 1, most_halvings
        middle = 0.5_wp*(last + beyond)
        if (abs(beyond - last) <= 2.0_wp*spacing(max(abs(last), abs(step)))) exit
        if (is_inside(linkage, middle)) then
          last = middle
        else
          beyond = middle
        end if
      end do
      call place_links(linkage, beyond, pose, error)
      if (allocated(error)) range%left_at(end) = error%place%pin
      call place_links(linkage, last, pose, error)
      if (.not. allocated(error) .and. size(pose%sine) > 0) range%blocked_by(end) = &
        minloc(abs(pose%sine), dim=1)
    end if
    if (end == 1) range%from = last
    if (end == 2) range%to = last
  end subroutine find_end

  !> Goes on in steps while the linkage closes.
  pure subroutine search_end(linkage, inside, step, is_angle, last, beyond, group, is_open)
    type(linkage_t), intent(in) :: linkage
    real(wp), intent(in) :: inside
    real(wp), intent(in) :: step        !! with its sign
    logical, intent(in) :: is_angle
    real(wp), intent(out) :: last       !! at which it still does; where steps of samples end if no
                                        !! end is found
    real(wp), intent(out) :: beyond     !! at which it does no more
    integer, intent(out) :: group       !! that would jump at `last`; 0: none
    logical, intent(out) :: is_open     !! no end has been found

    real(wp) :: place, sine(size(linkage%groups), 3)
    logical :: closes, has_two, found
    integer :: i

    is_open = .false.
    last = inside
    call find_sines(linkage, inside - step, sine(:, 1), has_two)
    call find_sines(linkage, inside, sine(:, 2))
    do i = 1, samples*merge(turns_searched, lengths_searched, is_angle)
      beyond = last + step
      call find_jump(linkage, last, beyond, group, place)
      if (group > 0) then
        last = place
        return
      end if
      call find_sines(linkage, beyond, sine(:, 3), closes)
      if (.not. closes) return
      if (has_two) then
        call find_gap(linkage, [last - step, last, beyond], sine, found, place)
        ! One behind the first place is not on the way.
        found = found .and. (i > 1 .or. (place - last)*step > 0.0_wp)
        if (found) then
          if ((place - last)*step <= 0.0_wp) last = last - step
          beyond = place
          return
        end if
      end if
      sine(:, :2) = sine(:, 2:)
      has_two = .true.
      last = beyond
    end do
    do i = 1, merge(0, most_doublings, is_angle)
      beyond = inside + 2.0_wp**i*(last - inside)
      if (is_closed(linkage, beyond)) cycle
      last = inside + 2.0_wp**(i - 1)*(last - inside)
      return
    end do
    is_open = .true.
  end subroutine search_end

  !> A place between two coordinates at which a group jumps: on their sides, where two ways cross;
  !! on a path, at its limits, beyond which the linkage may close in another assembly.
  pure subroutine find_jump(linkage, from, to, group, place)
    type(linkage_t), intent(in) :: linkage
    real(wp), intent(in) :: from, to
    integer, intent(out) :: group !! 0: there is none
    real(wp), intent(out) :: place

    integer :: i

    group = 0
    place = from
    associate (path => linkage%path)
      if (allocated(path%crank)) then
        do i = 1, 2
          if (allocated(path%limits(i)%crank)) call look_at(path%limits(i), path%period, from, to, &
            group, place)
        end do
      else if (allocated(path%bridges)) then
        do i = size(path%bridges), 1, -1
          if (path%bridges(i)%is_jump) call look_at(path%bridges(i), path%period, from, to, group, &
            place)
        end do
      end if
    end associate

  end subroutine find_jump

  !> Whether a change point, or a limit, lies between two coordinates.
  pure subroutine look_at(bridge, period, from, to, group, place)
    type(bridge_t), intent(in) :: bridge
    real(wp), intent(in) :: period          !! 0: none
    real(wp), intent(in) :: from, to
    integer, intent(inout) :: group         !! of the bridge, if it lies there and none is known yet
    real(wp), intent(inout) :: place

    real(wp) :: its_place

    if (group > 0) return
    its_place = bridge%change
    if (period > 0.0_wp) its_place = min(from, to) + modulo(its_place - min(from, to), period)
    if ((its_place - from)*(to - its_place) <= 0.0_wp) return
    group = bridge%group
    place = its_place
  end subroutine look_at

end module crank_limits
