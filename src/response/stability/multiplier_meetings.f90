!> Where multipliers of vibrations meet as the speed changes, by the slow motion without damping.
!!
!! Stations of the speed are so near each other that each multiplier is found again at the next. Two
!! on the circle whose angles add up to a whole number between two stations have met there; an
!! interval in which they are off the circle at stations goes from edge to edge.
module multiplier_meetings
  use constants, only: pi
  use errors, only: error_of_numerics, error_t
  use exponent_meetings, only: find_closest
  use fourier_transform, only: close_fourier, fourier_plan_t, open_fourier
  use interruption, only: was_interrupted
  use kinds, only: wp
  use link_store, only: link_store_t
  use meeting_exponents, only: bound_growth, close_pair, find_numbers, meeting_pair_t, meeting_t, &
    open_pair
  use motion_tables, only: least_speeds, motion_table_t, new_motion_table, table_width
  use multiplier_stations, only: match_stations, new_station, plane_of, plane_t, station_t
  use refinements, only: most_samples, sample_numbers
  use response_levels, only: level_slot_t, need_basis, need_level
  use stability_types, only: gap_t, intervals_t, stability_request_t
  use structures, only: structure_t
  use text, only: to_string
  use turn_grids, only: turn_grid_t
  use turn_spectra, only: first_order, first_samples, slow_number, usual_stages
  implicit none (type, external)
  private

  public :: find_meetings, add_gap, least_modes

  !> Steps of the speed, in terms of it, and in which the fastest vibration wanted turns by no more
  !! than the second; most times one is halved.
  real(wp), parameter :: step_share = 0.01_wp, step_turns = 0.03_wp
  integer, parameter :: most_halvings = 9

  !> Two intervals of one vibration that are nearer to each other than this share of the speed are
  !! one.
  real(wp), parameter :: for_a_moment = 4.0e-4_wp

  !> An interval is followed beyond the range by so many steps.
  integer, parameter :: most_beyond = 100

  !> Samples are for no fewer vibrations than this: the next ones take part where multipliers are
  !! near each other. These are followed with steps for this accuracy: meetings only have to be
  !! found.
  integer, parameter :: least_modes = 3
  real(wp), parameter :: to_follow = 0.1_wp

  !> Distance in turns of the places beside a meeting from which its growth is found.
  real(wp), parameter :: beside = 3.0e-4_wp

  !> Vibrations below this share of the frequency of two that meet have smaller numbers; those with
  !! numbers larger than wanted by more than this are not wanted where they meet.
  real(wp), parameter :: surely_slower = 0.8_wp
  integer, parameter :: numbers_above = 2

  !> Angles whose change differs by more than this share from what slopes say are not known between.
  real(wp), parameter :: not_smooth = 0.3_wp

  !> Places in an interval at which vibrations are numbered.
  integer, parameter :: inside = 5

  !> Growth above this share of the least that counts is looked into.
  real(wp), parameter :: worth = 0.5_wp

  !> Edges are found to this share of the step in which they are, in no more steps than these.
  real(wp), parameter :: near_edge = 2.0e-3_wp
  integer, parameter :: most_steps = 30

  !> Edges by the slow motion are right to this share of the speed.
  real(wp), parameter :: of_edge = 1.0e-3_wp

  character(len=*), parameter :: not_followed = "vibrations cannot be followed"

  !> Two stations that are neighbours.
  type :: step_t
    type(station_t) :: left, right
    integer, allocatable :: partner(:)         !! (vibrations of the left) among those of the right
    type(meeting_t), allocatable :: meeting(:) !! between them that may count
    integer :: meetings = 0                    !! between them, looked into
    logical :: pending = .true., good = .false.
    character(len=80) :: fault = ""
  end type step_t

  !> Speeds whose slow motions come from one table: from a station, found by itself, to the first of
  !! the next run.
  type :: run_t
    integer :: first = 0, last = 0 !! numbers of its speeds
    type(station_t) :: begin
    type(step_t), allocatable :: steps(:)
  end type run_t

  !> An interval whose other edge is not reached yet.
  type :: open_t
    integer :: pair(2) = 0             !! vibrations at the station reached
    logical :: has_edge = .false.      !! its first edge is known
    logical :: is_wanted = .false.     !! both are at some station
    integer :: least_number = huge(1)  !! of the greater of both, at any station
    real(wp) :: since = 0.0_wp         !! first station, if there is no edge
    type(meeting_t) :: meeting
  end type open_t

contains

  !> All meetings of vibrations wanted from the least to the greatest speed of a request in which
  !! they may grow by as much as asked for.
  !!
  !! Errors: the crank does not turn fully; own modes of a link could not be found.
  subroutine find_meetings(structure, request, threads, store, found, meetings, error)
    class(structure_t), intent(in) :: structure      !! linkage and beams
    type(stability_request_t), intent(in) :: request !! without damping
    integer, intent(in) :: threads                   !! number of OpenMP threads
    type(link_store_t), intent(inout) :: store       !! links decomposed earlier
    type(intervals_t), intent(inout) :: found        !! with a range; gets gaps and numbers
    type(meeting_t), allocatable, intent(out) :: meetings(:)
    type(error_t), allocatable, intent(out) :: error !! why there are none

    type(level_slot_t), allocatable, target :: levels(:)
    type(run_t), allocatable :: runs(:)
    type(station_t) :: last
    type(step_t), allocatable :: steps(:)
    type(meeting_t), allocatable :: grown(:)
    real(wp), allocatable :: speeds(:)
    real(wp) :: from, range(2), fastest
    integer :: i, k, number(size(sample_numbers)), slow

    allocate (levels(0), meetings(0))
    ! By the slow motion meetings are a little beside where they are.
    range = found%range*[1.0_wp - step_share, 1.0_wp + step_share]
    call make_levels(error)
    if (allocated(error)) return
    from = range(1)
    do while (samples_at(levels(1)%level%grid, request%modes, from, to_follow) == 0)
      from = 1.1_wp*from
    end do
    if (from > range(1)) call add_gap(range(1), from, "too many vibrations in a turn of the "// &
      "crank for "//to_string(most_samples)//" samples", found)
    if (from >= range(2)) return
    call find_fastest
    speeds = [from]
    do while (speeds(size(speeds)) < range(2))
      associate (speed => speeds(size(speeds)))
        speeds = [speeds, min(speed + step_at(speed), range(2))]
      end associate
    end do
    call divide_range
    !$omp parallel do num_threads(threads) schedule(dynamic) default(shared) private(k)
    do k = 1, size(runs)
      if (.not. was_interrupted()) call find_station(speeds(runs(k)%first), runs(k)%begin)
    end do
    !$omp end parallel do
    call find_station(speeds(size(speeds)), last)
    !$omp parallel do num_threads(threads) schedule(dynamic) default(shared) private(k)
    do k = 1, size(runs)
      if (was_interrupted()) cycle
      if (k < size(runs)) call follow(runs(k), runs(k + 1)%begin)
      if (k == size(runs)) call follow(runs(k), last)
    end do
    !$omp end parallel do
    if (was_interrupted()) return
    allocate (steps(sum([(size(runs(k)%steps), k=1, size(runs))])))
    i = 0
    do k = 1, size(runs)
      steps(i + 1:i + size(runs(k)%steps)) = runs(k)%steps
      i = i + size(runs(k)%steps)
      deallocate (runs(k)%steps)
    end do
    call extend(.false.)
    call extend(.true.)
    found%stations = size(steps) + 1
    do k = 1, size(steps)
      found%meetings = found%meetings + steps(k)%meetings
      ! As the result of a function it would not be freed in the constructor (gfortran 12).
      grown = pack(steps(k)%meeting, steps(k)%meeting%growth >= worth*request%least_growth)
      meetings = [meetings, grown]
      if (steps(k)%good) cycle
      ! Neighbours that failed alike are one gap.
      do i = k - 1, 1, -1
        if (steps(i)%good .or. steps(i)%fault /= steps(k)%fault) exit
      end do
      if (k < size(steps)) then
        if (.not. steps(k + 1)%good .and. steps(k + 1)%fault == steps(k)%fault) cycle
      end if
      call add_gap(steps(i + 1)%left%speed, steps(k)%right%speed, trim(steps(k)%fault), found)
    end do
    call join
    ! Edges by the slow motion are not far from where they are.
    meetings = pack(meetings, meetings%from <= (1.0_wp + of_edge)*found%range(2) .and. meetings%to &
      >= (1.0_wp - of_edge)*found%range(1))

  contains

    !> The levels of all speeds.
    subroutine make_levels(error)
      type(error_t), allocatable, intent(out) :: error

      integer :: at, place, last
      logical :: backwards

      backwards = request%speed(1) < 0.0_wp
      call need_level(structure, first_order(to_follow), sample_numbers(1), backwards, store, &
        levels, place, error)
      if (allocated(error)) return
      slow = slow_number(levels(1)%level%grid, request%modes)
      last = samples_at(levels(1)%level%grid, request%modes, range(1), to_follow)
      if (last == 0) last = size(sample_numbers)
      number = 0
      do at = max(1, samples_at(levels(1)%level%grid, request%modes, range(2), to_follow)), last
        call need_level(structure, first_order(to_follow), sample_numbers(at), backwards, store, &
          levels, number(at), error)
        if (allocated(error)) return
        call need_basis(slow, request%damping, levels(number(at))%level, error, .true.)
        if (allocated(error)) return
      end do
    end subroutine make_levels

    !> The number of the level for a speed.
    function level_for(speed) result(level)
      real(wp), intent(in) :: speed
      integer :: level

      level = number(samples_at(levels(1)%level%grid, request%modes, max(from, min(range(2), &
        speed)), to_follow))
    end function level_for

    !> The frequency of the fastest vibration wanted, at the first speed at which it is known.
    subroutine find_fastest
      type(station_t) :: station
      real(wp) :: speed

      fastest = 0.0_wp
      speed = from
      do while (speed < range(2) .and. fastest <= 0.0_wp)
        call find_station(speed, station)
        if (allocated(station%turns)) fastest = maxval(station%rate, mask=station%number <= &
          request%modes)*speed
        speed = 1.1_wp*speed
      end do
    end subroutine find_fastest

    !> The step from a speed to the next.
    function step_at(speed) result(step)
      real(wp), intent(in) :: speed !! [rad/s]
      real(wp) :: step

      step = speed*min(step_share, step_turns/max(fastest/speed, tiny(1.0_wp)))
    end function step_at

    !> Divides the range of speeds into runs.
    subroutine divide_range
      integer :: k

      allocate (runs(0))
      do k = 1, size(speeds) - 1
        if (size(runs) > 0) then
          if (speeds(k + 1) <= (1.0_wp + table_width)*speeds(runs(size(runs))%first) .and. &
            level_for(speeds(k)) == level_for(speeds(runs(size(runs))%first))) then
            runs(size(runs))%last = k + 1
            cycle
          end if
        end if
        runs = [runs, run_t(first=k, last=k + 1)]
      end do
    end subroutine divide_range

    !> Finds the stations of a run, and looks into the steps between them.
    subroutine follow(run, end)
      type(run_t), intent(inout) :: run
      type(station_t), intent(in) :: end !! the first of the next run

      type(motion_table_t), allocatable, target :: table !! none: absent
      integer :: k, n, round

      n = run%last - run%first
      if (n >= least_speeds) then
        allocate (table)
        call make_table(speeds(run%first), speeds(run%last), table)
      end if
      allocate (run%steps(n))
      run%steps(1)%left = run%begin
      run%steps(n)%right = end
      do k = 2, n
        if (was_interrupted()) return
        call find_station(speeds(run%first + k - 1), run%steps(k)%left, table)
        run%steps(k - 1)%right = run%steps(k)%left
      end do
      do round = 0, most_halvings
        do k = 1, size(run%steps)
          if (was_interrupted()) return
          if (run%steps(k)%pending) call look_between(run%steps(k), round == most_halvings, table)
        end do
        run%steps%pending = .not. run%steps%good .and. run%steps%pending
        if (.not. any(run%steps%pending) .or. round == most_halvings) exit
        call halve(run%steps, table)
      end do
    end subroutine follow

    subroutine make_table(from, to, table)
      real(wp), intent(in) :: from, to
      type(motion_table_t), intent(out) :: table

      type(fourier_plan_t) :: plan

      associate (level => levels(level_for(from))%level)
        call open_fourier(level%grid%samples, plan)
        call new_motion_table(plan, level%basis(slow), from, to, usual_stages, table)
        call close_fourier(plan)
      end associate
    end subroutine make_table

    subroutine find_station(speed, station, table)
      real(wp), intent(in) :: speed
      type(station_t), intent(out) :: station
      type(motion_table_t), intent(in), target, optional :: table !! absent: none

      type(meeting_pair_t) :: pair

      call open_pair(request, levels(level_for(speed))%level, slow, meeting_t(), .false., pair, &
        table)
      call pair%find_spectrum(speed)
      if (.not. allocated(pair%error)) call new_station(pair%spectrum, speed, station)
      station%speed = speed
      call close_pair(pair)
    end subroutine find_station

    !> Puts stations into steps that are not good.
    subroutine halve(steps, table)
      type(step_t), allocatable, intent(inout) :: steps(:)
      type(motion_table_t), intent(in), target, optional :: table !! absent: none

      type(step_t), allocatable :: halves(:)
      integer :: j, k

      allocate (halves(size(steps) + count(steps%pending)))
      j = 0
      do k = 1, size(steps)
        j = j + 1
        if (steps(k)%pending) then
          halves(j)%left = steps(k)%left
          call find_station(0.5_wp*(steps(k)%left%speed + steps(k)%right%speed), halves(j)%right, &
            table)
          j = j + 1
          halves(j)%left = halves(j - 1)%right
          halves(j)%right = steps(k)%right
        else
          halves(j) = steps(k)
        end if
      end do
      call move_alloc(halves, steps)
    end subroutine halve

    !> Finds each multiplier of a station again at the next, and looks into meetings between.
    subroutine look_between(step, is_last, table)
      type(step_t), intent(inout) :: step
      logical, intent(in) :: is_last !! it will not be halved any more
      type(motion_table_t), intent(in), target, optional :: table !! absent: none

      real(wp), allocatable :: change(:)
      real(wp) :: total(2)
      logical, allocatable :: near(:), alike(:), smooth(:)
      integer, allocatable :: number(:, :)
      integer :: i, j, n, to(2)
      logical :: good, is_wanted

      step%good = .false.
      step%fault = not_followed
      if (allocated(step%meeting)) deallocate (step%meeting)
      allocate (step%meeting(0))
      step%meetings = 0
      if (.not. (allocated(step%left%turns) .and. allocated(step%right%turns))) return
      n = size(step%left%turns)
      if (size(step%right%turns) /= n) return
      if (allocated(step%partner)) deallocate (step%partner)
      allocate (step%partner(n), change(n), near(n), alike(n), smooth(n))
      call match_stations(step%left, step%right, step%partner, change, near, alike, smooth)
      number = reshape([step%left%number, step%right%number(step%partner)], [n, 2])
      do i = 1, n
        do j = i, n
          is_wanted = any(max(number(i, :), number(j, :)) <= request%modes)
          if (.not. is_wanted) then
            if (is_last .or. .not. may_be_wanted(step, number, [i, j])) cycle
          end if
          ! Two that pass each other closely need not be told apart.
          if (.not. all(near([i, j]) .and. (alike([i, j]) .and. smooth([i, j]) .or. is_last))) &
            return
          to = step%partner([i, j])
          if (step%left%met(i) == j .or. step%right%met(to(1)) == to(2)) cycle
          if (stays_with_other(step, i) .or. stays_with_other(step, j)) cycle
          ! Off the circle at both, with others: it was on it between, if only for a moment.
          if (any(step%left%met([i, j]) > 0 .and. step%right%met(to) > 0) .and. step%right%speed - &
            step%left%speed > for_a_moment*step%left%speed .and. .not. is_last) return
          total(1) = step%left%turns(i) + step%left%turns(j)
          total(2) = total(1) + change(i) + change(j)
          if (ceiling(minval(total)) > floor(maxval(total))) cycle
          good = ceiling(minval(total)) == floor(maxval(total)) .and. &
            step%left%met(i) + step%left%met(j) + sum(step%right%met(to)) == 0
          if (good .and. .not. is_last) good = is_smooth(step, [i, j], total(2) - total(1))
          if (good) call look_into(step, [i, j], to, total - ceiling(minval(total)), good, table)
          if (good) cycle
          step%fault = "two multipliers meet near others"
          return
        end do
      end do
      step%good = .true.
    end subroutine look_between

    !> Whether a vibration is off the circle at both stations with the same one.
    pure function stays_with_other(step, i) result(stays)
      type(step_t), intent(in) :: step
      integer, intent(in) :: i !! at the left
      logical :: stays

      stays = step%left%met(i) > 0
      if (stays) stays = step%right%met(step%partner(i)) == step%partner(step%left%met(i))
    end function stays_with_other

    !> Whether two angles change as their slopes at both stations say.
    pure function is_smooth(step, left, change) result(smooth)
      type(step_t), intent(in) :: step
      integer, intent(in) :: left(2)   !! vibrations of the left
      real(wp), intent(in) :: change   !! of the sum of their angles
      logical :: smooth

      smooth = abs(change - 0.5_wp*log(step%right%speed/step%left%speed)*sum(step%left% &
        slope(left) + step%right%slope(step%partner(left)))) <= not_smooth*abs(change)
    end function is_smooth

    !> Whether two vibrations may be those wanted by their numbers where they meet between stations:
    !! both have about the geometric mean of their frequencies there, with equal actions. A number
    !! next to those wanted may be one of them where others meet, too.
    pure function may_be_wanted(step, number, pair) result(may)
      type(step_t), intent(in) :: step
      integer, intent(in) :: number(:, :) !! (vibrations of the left, stations)
      integer, intent(in) :: pair(2)      !! vibrations of the left
      logical :: may

      logical :: slower(size(number, 1))

      may = minval(maxval(number(pair, :), dim=1)) <= request%modes + 1
      if (may .or. minval(maxval(number(pair, :), dim=1)) > request%modes + numbers_above) return
      slower = step%left%rate < surely_slower*sqrt(product(step%left%rate(pair))) .and. &
        step%right%rate(step%partner) < surely_slower*sqrt(product(step%right%rate(step% &
        partner(pair))))
      slower(pair) = .false.
      may = count(slower) + merge(1, 2, pair(1) == pair(2)) <= request%modes
    end function may_be_wanted

    !> Growth and place of the meeting of two vibrations between stations.
    subroutine look_into(step, left, right, total, good, table)
      type(step_t), intent(inout) :: step
      integer, intent(in) :: left(2), right(2) !! their numbers at both stations
      real(wp), intent(in) :: total(2)         !! sums of angles there, but for a whole number
      logical, intent(out) :: good             !! it was found
      type(motion_table_t), intent(in), target, optional :: table !! absent: none

      type(meeting_t) :: meeting
      type(meeting_pair_t) :: pair
      real(wp) :: length, square, slope, width
      logical :: counts

      allocate (meeting%plane(2))
      meeting%plane(1) = plane_of(step%left, left)
      meeting%plane(2) = plane_of(step%right, right)
      meeting%is_own = left(1) == left(2)
      length = step%right%speed - step%left%speed
      meeting%at = step%left%speed - total(1)/(total(2) - total(1))*length
      call open_pair(request, levels(level_for(step%left%speed))%level, slow, meeting, .false., &
        pair, table)
      good = .true.
      width = 0.0_wp
      call bound_growth(pair, meeting%at, step%left%rate(left)/abs(step%left%slope(left)), &
        meeting%growth)
      if (meeting%growth >= worth*request%least_growth) then
        call find_closest(pair, meeting%at, min(0.25_wp, beside/abs(total(2) - total(1)))*length, &
          square, slope, good)
        if (good) width = sqrt(max(-square, 0.0_wp))/slope
        meeting%growth = pi*sqrt(max(-square, 0.0_wp))
      end if
      meeting%from = meeting%at - width
      meeting%to = meeting%at + width
      counts = good .and. meeting%growth >= worth*request%least_growth
      if (counts) call find_whether_wanted(pair, meeting, counts)
      call close_pair(pair)
      if (.not. good) return
      ! Both are on the circle at both stations.
      good = meeting%to >= step%left%speed .and. meeting%from <= step%right%speed
      if (good) step%meetings = step%meetings + 1
      if (good .and. counts) step%meeting = [step%meeting, meeting]
    end subroutine look_into

    !> Steps beyond an end of the range, until multipliers that are off the circle there return.
    subroutine extend(forwards)
      logical, intent(in) :: forwards

      type(step_t) :: step
      type(station_t) :: here
      logical, allocatable :: off(:), still(:)
      real(wp) :: length
      integer :: i, k

      here = steps(1)%left
      if (forwards) here = steps(size(steps))%right
      if (.not. allocated(here%turns)) return
      off = here%met > 0 .and. here%number <= request%modes + 1
      do i = 1, size(off)
        if (off(i)) off(i) = here%number(here%met(i)) <= request%modes + 1
      end do
      length = step_at(here%speed)
      do k = 1, most_beyond
        if (.not. any(off) .or. was_interrupted()) return
        step = step_t()
        if (forwards) then
          step%left = here
          call find_station(here%speed + length, step%right)
        else
          step%right = here
          call find_station(here%speed - length, step%left)
        end if
        call look_between(step, .true.)
        deallocate (step%meeting)
        allocate (step%meeting(0))
        if (.not. allocated(step%partner)) return
        if (.not. step%good .and. step%fault == not_followed) then
          length = 0.5_wp*length
          cycle
        end if
        step%good = .true.
        step%pending = .false.
        if (forwards) then
          steps = [steps, step]
          here = step%right
        else
          steps = [step, steps]
          here = step%left
        end if
        allocate (still(size(here%turns)), source=.false.)
        do i = 1, size(step%partner)
          if (step%partner(i) == 0) cycle
          if (forwards) still(step%partner(i)) = off(i)
          if (.not. forwards) still(i) = off(step%partner(i))
        end do
        off = still .and. here%met > 0
        deallocate (still)
      end do
    end subroutine extend

    !> Intervals with stations inside, from edge to edge.
    subroutine join
      type(open_t), allocatable :: open(:)
      integer :: i, k

      open = all_of(steps(1)%left)
      do k = 1, size(steps)
        associate (step => steps(k))
          if (.not. step%good) then
            do i = 1, size(open)
              call lose(open(i), step%left%speed)
            end do
            open = all_of(step%right)
          else
            call pass(step, open)
          end if
        end associate
      end do
      do i = 1, size(open)
        call lose(open(i), steps(size(steps))%right%speed)
      end do
    end subroutine join

    !> The pairs that are off the circle at a station, edges unknown.
    function all_of(station) result(open)
      type(station_t), intent(in) :: station
      type(open_t), allocatable :: open(:)

      type(open_t) :: new
      integer :: i

      allocate (open(0))
      if (.not. allocated(station%turns)) return
      do i = 1, size(station%turns)
        if (station%met(i) < i) cycle
        new = open_t()
        new%since = station%speed
        allocate (new%meeting%plane(0))
        call go_to(station, [i, station%met(i)], new)
        open = [open, new]
      end do
    end function all_of

    !> An open interval has reached a station.
    subroutine go_to(station, pair, open)
      type(station_t), intent(in) :: station
      integer, intent(in) :: pair(2)
      type(open_t), intent(inout) :: open

      open%pair = pair
      open%least_number = min(open%least_number, maxval(station%number(pair)))
      open%is_wanted = open%least_number <= request%modes
      associate (meeting => open%meeting, growth => 2.0_wp*pi*station%growth(pair(1)))
        call append_plane(station, pair, meeting%plane)
        if (growth <= meeting%growth) return
        meeting%is_own = pair(1) == pair(2)
        meeting%growth = growth
        meeting%at = station%speed
      end associate
    end subroutine go_to

    subroutine append_plane(station, pair, planes)
      type(station_t), intent(in) :: station
      integer, intent(in) :: pair(2)
      type(plane_t), allocatable, intent(inout) :: planes(:)

      type(plane_t) :: plane

      ! In an array constructor the result of a function would not be freed (gfortran 12).
      plane = plane_of(station, pair)
      planes = [planes, plane]
    end subroutine append_plane

    !> What becomes of open intervals in a step: some end, others go on, new ones begin.
    subroutine pass(step, open)
      type(step_t), intent(in) :: step
      type(open_t), allocatable, intent(inout) :: open(:)

      type(open_t) :: new
      logical :: goes_on(size(open)), is_old(size(step%right%turns)), good
      integer :: i, to(2), before(2)

      is_old = .false.
      do i = 1, size(open)
        to = step%partner(open(i)%pair)
        goes_on(i) = all(to > 0)
        if (goes_on(i)) then
          ! One of them may grow on with another: a third has passed.
          associate (met => step%right%met(to))
            if (met(1) /= to(2) .and. any(met > 0)) to = [to(maxloc(met, dim=1)), maxval(met)]
          end associate
          goes_on(i) = step%right%met(to(1)) == to(2) .and. .not. any(is_old(to))
        end if
        if (goes_on(i)) then
          call go_to(step%right, to, open(i))
          is_old(to) = .true.
        else if (any(to == 0)) then
          call lose(open(i), step%right%speed)
        else
          call append_plane(step%right, to, open(i)%meeting%plane)
          call find_edge(step, open(i)%pair, open(i)%meeting%plane(size(open(i)%meeting% &
            plane) - 1:), open(i)%meeting%to, good)
          if (good .and. open(i)%has_edge) then
            call keep(open(i))
          else if (good) then
            call lose(open(i), min(step%right%speed, (1.0_wp + of_edge)*open(i)%meeting%to))
          else
            call lose(open(i), step%right%speed)
          end if
        end if
      end do
      open = pack(open, goes_on)
      do i = 1, size(step%right%turns)
        if (step%right%met(i) < i .or. is_old(i)) cycle
        new = open_t()
        new%since = step%left%speed
        allocate (new%meeting%plane(0))
        before = [findloc(step%partner, i, dim=1), findloc(step%partner, step%right%met(i), dim=1)]
        if (all(before > 0)) call append_plane(step%left, before, new%meeting%plane)
        call go_to(step%right, [i, step%right%met(i)], new)
        if (all(before > 0)) call find_edge(step, before, new%meeting%plane, new%meeting%from, &
          new%has_edge)
        open = [open, new]
      end do
    end subroutine pass

    !> The square of the difference of two exponents at a station, negative off the circle.
    pure function square_of(station, pair) result(square)
      type(station_t), intent(in) :: station
      integer, intent(in) :: pair(2) !! vibrations
      real(wp) :: square

      if (station%met(pair(1)) == pair(2)) then
        square = -4.0_wp*station%growth(pair(1))**2
      else
        square = sum(station%turns(pair))
        square = (square - anint(square))**2
      end if
    end function square_of

    !> Where the square of the difference of two exponents changes its sign between two stations, by
    !! the Illinois method.
    subroutine find_edge(step, left, plane, edge, good)
      type(step_t), intent(in) :: step
      integer, intent(in) :: left(2)        !! vibrations of the left
      type(plane_t), intent(in) :: plane(:) !! at both
      real(wp), intent(out) :: edge         !! [rad/s]
      logical, intent(out) :: good

      type(meeting_pair_t) :: pair
      type(meeting_t) :: meeting
      complex(wp) :: total, square
      real(wp) :: place(3), value(3)
      integer :: i, side
      logical :: moved(2), near

      meeting%plane = plane
      call open_pair(request, levels(level_for(step%left%speed))%level, slow, meeting, .false., &
        pair)
      place(:2) = [step%left%speed, step%right%speed]
      edge = place(1)
      value(:2) = [square_of(step%left, left), square_of(step%right, step%partner(left))]
      search: block
        good = value(1)*value(2) <= 0.0_wp
        if (.not. good) exit search
        side = 0
        moved = .false.
        do i = 1, most_steps
          place(3) = (place(1)*value(2) - place(2)*value(1))/(value(2) - value(1))
          near = abs(place(3) - edge) <= near_edge*(step%right%speed - step%left%speed)
          edge = place(3)
          ! A value that is small beside the other hardly moves the place at first.
          if (near .and. all(moved)) exit
          call pair%evaluate(edge, total, square, good)
          if (.not. good) exit search
          value(3) = real(square)
          if (value(3)*value(2) > 0.0_wp) then
            place(2) = place(3)
            moved(2) = .true.
            value(2) = value(3)
            if (side == 2) value(1) = 0.5_wp*value(1)
            side = 2
          else
            place(1) = place(3)
            moved(1) = .true.
            value(1) = value(3)
            if (side == 1) value(2) = 0.5_wp*value(2)
            side = 1
          end if
        end do
      end block search
      call close_pair(pair)
    end subroutine find_edge

    !> Whether two vibrations have numbers of those wanted anywhere in their interval.
    subroutine find_whether_wanted(pair, meeting, is_wanted)
      type(meeting_pair_t), intent(inout) :: pair !! of the meeting
      type(meeting_t), intent(in) :: meeting
      logical, intent(out) :: is_wanted

      integer :: i
      logical :: good

      is_wanted = .false.
      do i = 1, inside
        call find_numbers(pair, meeting%from + (i - 0.5_wp)*(meeting%to - meeting%from)/inside, &
          good)
        if (good) is_wanted = all(pair%number <= request%modes)
        if (is_wanted) return
      end do
    end subroutine find_whether_wanted

    !> An interval whose edges are known, if both vibrations are wanted somewhere in it.
    subroutine keep(open)
      type(open_t), intent(inout) :: open

      type(meeting_pair_t) :: pair

      found%meetings = found%meetings + 1
      if (.not. open%is_wanted .and. open%least_number <= request%modes + numbers_above) then
        associate (meeting => open%meeting)
          call open_pair(request, levels(level_for(meeting%at))%level, slow, meeting, .false., pair)
          call find_whether_wanted(pair, meeting, open%is_wanted)
          call close_pair(pair)
        end associate
      end if
      if (.not. open%is_wanted .or. open%meeting%growth < worth*request%least_growth) return
      meetings = [meetings, open%meeting]
    end subroutine keep

    !> An interval of which an edge is not known.
    subroutine lose(open, until)
      type(open_t), intent(in) :: open
      real(wp), intent(in) :: until

      real(wp) :: since

      if (open%least_number > request%modes + merge(0, 1, open%meeting%is_own) .or. &
        open%meeting%growth < request%least_growth) return
      since = open%since
      if (open%has_edge) since = open%meeting%from
      call add_gap(since, until, "vibrations grow, edges are not found", found)
    end subroutine lose

  end subroutine find_meetings

  !> Names speeds at which intervals could not be found, as far as they are in the range.
  subroutine add_gap(from, to, reason, found)
    real(wp), intent(in) :: from, to !! [rad/s]
    character(len=*), intent(in) :: reason
    type(intervals_t), intent(inout) :: found

    type(gap_t) :: gap
    integer :: i

    if (from >= found%range(2) .or. to <= found%range(1)) return
    gap%from = max(from, found%range(1))
    gap%to = min(to, found%range(2))
    do i = 1, size(found%gap)
      ! Several meetings there.
      if (found%gap(i)%error%text == reason .and. abs(found%gap(i)%from - gap%from) <= 0.0_wp &
        .and. abs(found%gap(i)%to - gap%to) <= 0.0_wp) return
    end do
    gap%error%kind = error_of_numerics
    gap%error%text = reason
    found%gap = [found%gap, gap]
  end subroutine add_gap

  !> Samples for so many vibrations; 0: too many.
  pure function samples_at(grid, modes, speed, accuracy) result(at)
    type(turn_grid_t), intent(in) :: grid
    integer, intent(in) :: modes
    real(wp), intent(in) :: speed !! [rad/s]
    real(wp), intent(in) :: accuracy
    integer :: at !! of `sample_numbers`

    at = first_samples(grid, max(modes, least_modes), speed, accuracy)
  end function samples_at

end module multiplier_meetings
