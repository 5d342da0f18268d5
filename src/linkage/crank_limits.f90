!> Where the first drive, or another one, can be.
module crank_limits
  use errors, only: error_t
  use kinds, only: wp
  use linkage_paths, only: period_of
  use linkages, only: drives_angle, linkage_t
  use pose_types, only: pose_t
  use poses, only: find_moving_pose, place_links
  use sorting, only: ascending_order
  implicit none (type, external)
  private

  public :: crank_range_t, find_ranges, turns_fully, samples

  !> An interval of the first drive in which the linkage closes on its branch.
  type :: crank_range_t
    real(wp) :: from = 0.0_wp, to = 0.0_wp !! [deg] or [m]
    logical :: turns = .false.             !! a whole period, without limits
    integer :: blocked_by(2) = 0           !! groups that end it; 0: none
    integer :: left_at(2) = 0              !! pins of blocks that there leave their links; 0: none
  end type crank_range_t

  !> Samples of a range; extremes between them are found to rounding where the rate changes its sign
  !! once.
  integer, parameter :: samples = 720

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
    logical :: closes(0:samples), is_angle
    integer, allocatable :: order(:)
    integer :: i, k

    allocate (ranges(0))
    period = period_of(linkage)
    is_angle = linkage%drives(1)%kind == drives_angle
    if (present(drive)) then
      is_angle = linkage%drives(drive)%kind == drives_angle
      period = merge(360.0_wp, 0.0_wp, is_angle)
    end if
    if (period <= 0.0_wp) then
      step = 360.0_wp/samples
      if (.not. is_angle) step = maxval(linkage%bodies%length)/samples
      order = ascending_order(inside)
      do i = 1, size(inside)
        c = inside(order(i))
        if (size(ranges) > 0) then
          if (c <= ranges(size(ranges))%to + 1.0e-6_wp*step) cycle
        end if
        if (.not. is_closed(linkage, c)) cycle
        call find_end(linkage, c, -step, range%blocked_by(1), range%left_at(1), range%from)
        call find_end(linkage, c, step, range%blocked_by(2), range%left_at(2), range%to)
        ranges = [ranges, range]
      end do
      return
    end if
    do i = 0, samples
      closes(i) = is_closed(linkage, period*i/samples)
    end do
    if (all(closes)) then
      range%to = period
      range%turns = .true.
      ranges = [range]
      return
    end if
    ! From a gap on, round the period.
    k = findloc(closes(:samples - 1), .false., dim=1) - 1
    step = period/samples
    first = period*k/samples
    i = 1
    do while (i <= samples)
      c = first + step*i
      if (.not. closes(modulo(k + i, samples))) then
        i = i + 1
        cycle
      end if
      call find_end(linkage, c, -step, range%blocked_by(1), range%left_at(1), range%from)
      call find_end(linkage, c, step, range%blocked_by(2), range%left_at(2), range%to)
      ranges = [ranges, range]
      i = max(i + 1, 1 + floor((range%to - first)/step))
    end do
  end subroutine find_ranges

  !> Whether the first drive turns a link fully and all positions repeat after a turn, without a
  !! dead point on the way.
  pure function turns_fully(linkage) result(turns)
    type(linkage_t), intent(in) :: linkage !! of any kind, with its path
    logical :: turns

    type(pose_t) :: pose
    type(error_t), allocatable :: error
    integer :: i

    turns = linkage%drives(1)%kind == drives_angle .and. &
      abs(period_of(linkage) - 360.0_wp) <= 0.0_wp
    do i = 1, samples
      if (.not. turns) return
      call find_moving_pose(linkage, 360.0_wp*i/samples, pose, error)
      turns = .not. allocated(error)
    end do
  end function turns_fully

  pure function is_closed(linkage, crank) result(is)
    type(linkage_t), intent(in) :: linkage
    real(wp), intent(in) :: crank
    logical :: is

    type(pose_t) :: pose
    type(error_t), allocatable :: error

    call place_links(linkage, crank, pose, error)
    is = .not. allocated(error)
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

  !> The last coordinate, in steps from one at which the linkage closes, at which it still does, by
  !! bisection; the group that is nearest to its dead point there, and the block that leaves its
  !! link.
  pure subroutine find_end(linkage, inside, step, group, pin, last)
    type(linkage_t), intent(in) :: linkage
    real(wp), intent(in) :: inside
    real(wp), intent(in) :: step !! with its sign
    integer, intent(out) :: group
    integer, intent(out) :: pin !! of the block; 0: none
    real(wp), intent(out) :: last

    type(pose_t) :: pose
    type(error_t), allocatable :: error
    real(wp) :: beyond, middle, jump
    integer :: i, number

    last = inside
    group = 0
    pin = 0
    do i = 1, 20*samples
      beyond = last + step
      call find_jump(linkage, last, beyond, number, jump)
      if (number > 0) then
        last = jump
        group = linkage%path%bridges(number)%group
        return
      end if
      if (.not. is_closed(linkage, beyond)) exit
      last = beyond
    end do
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
    if (allocated(error)) pin = error%place%pin
    call place_links(linkage, last, pose, error)
    if (.not. allocated(error)) then
      if (size(pose%sine) > 0) group = minloc(abs(pose%sine), dim=1)
    end if
  end subroutine find_end

  !> A place between two coordinates at which dyads on their sides would jump.
  pure subroutine find_jump(linkage, from, to, number, place)
    type(linkage_t), intent(in) :: linkage
    real(wp), intent(in) :: from, to
    integer, intent(out) :: number !! of the bridge there; 0: there is none
    real(wp), intent(out) :: place

    number = 0
    place = from
    if (allocated(linkage%path%crank) .or. .not. allocated(linkage%path%bridges)) return
    associate (path => linkage%path)
      do number = size(path%bridges), 1, -1
        if (.not. path%bridges(number)%is_jump) cycle
        place = path%bridges(number)%change
        if (path%period > 0.0_wp) place = min(from, to) + modulo(place - min(from, to), path%period)
        if ((place - from)*(to - place) > 0.0_wp) return
      end do
    end associate
  end subroutine find_jump

end module crank_limits
