!> Vibrations of a running linkage, without damping, followed over its speed, and where multipliers
!! of two of them meet.
!!
!! Each vibration has one multiplier of positive Krein signature; its phase is `α = F/ω` turns but
!! for whole turns, with the frequency F that is followed. A multiplier belongs to the vibration
!! whose phase is expected there and with which alone it has a symplectic product: multipliers of
!! others pass through. Two multipliers of opposite signature meet where `αᵢ + αⱼ` is a whole
!! number; with i = j it is a vibration that meets its own conjugate.
module vibration_branches
  use kinds, only: wp
  use slow_motions, only: slow_mode_t
  use stability, only: turn_spectrum_t
  implicit none (type, external)
  private

  public :: station_t, new_station, branches_t, begin_branches, go_on, meeting_t, find_meetings, &
    frequency_at, unlikeness

  !> Actions below this are of multipliers that have met: they have no signature.
  real(wp), parameter :: certain = 0.1_wp

  !> A vibration is found again if its phase is expected as near as this [turns], and if its product
  !! is no less than this.
  real(wp), parameter :: near_enough = 0.05_wp, same_enough = 0.6_wp

  !> Sums of phases this near to a whole number are locked to it.
  real(wp), parameter :: locked = 1.0e-9_wp

  !> Multipliers at a speed on the sheet on which their signature is positive, on both if they have
  !! none.
  type :: station_t
    real(wp) :: speed = 0.0_wp              !! |ω2| [rad/s]
    integer, allocatable :: number(:)       !! (candidates) of the vibration, by frequency
    real(wp), allocatable :: phase(:)       !! (candidates) α but for whole turns [turns]
    real(wp), allocatable :: frequency(:)   !! (candidates) of the shape over the turn [rad/s]
    logical, allocatable :: has_met(:)      !! (candidates)
    complex(wp), allocatable :: state(:, :) !! (coordinates and momenta, candidates), product 1
  end type station_t

  !> Vibrations as followed so far.
  type :: branches_t
    real(wp) :: speed = 0.0_wp
    real(wp), allocatable :: frequency(:)   !! (vibrations) F [rad/s]
    real(wp), allocatable :: slope(:)       !! (vibrations) of F over the speed
    real(wp), allocatable :: shape(:)       !! (vibrations) frequency of the shape over the turn
    logical, allocatable :: is_wanted(:)    !! (vibrations) by that frequency
    logical :: have_met = .false.           !! multipliers of some that are wanted
    logical, allocatable :: is_known(:)     !! (vibrations) `state` is there
    complex(wp), allocatable :: state(:, :) !! (coordinates and momenta, vibrations) where they were
                                            !! last seen apart from others
  end type branches_t

  !> A meeting of two multipliers.
  type :: meeting_t
    integer :: vibration(2) = 0            !! their numbers
    integer :: total = 0                   !! αᵢ + αⱼ
    integer :: step = 0                    !! number of the step of the speed in which it is
    real(wp) :: around(2) = 0.0_wp         !! speeds about it at which no multipliers have met
    real(wp) :: speed(2) = 0.0_wp          !! between which it is [rad/s]
    real(wp) :: frequency(2, 2) = 0.0_wp   !! (vibrations, speeds) [rad/s]
    real(wp) :: shape(2) = 0.0_wp          !! their least and greatest frequency of the shape
    logical :: is_known(2, 2) = .false.    !! (vibrations, speeds)
    complex(wp), allocatable :: state(:, :, :) !! (coordinates and momenta, vibrations, speeds)
  end type meeting_t

contains

  !> The multipliers of a spectrum.
  subroutine new_station(spectrum, speed, station)
    type(turn_spectrum_t), intent(in) :: spectrum !! without damping
    real(wp), intent(in) :: speed                 !! |ω2| [rad/s]
    type(station_t), intent(out) :: station

    integer :: k, n

    station%speed = speed
    n = 2*size(spectrum%mode)
    allocate (station%number(n), station%phase(n), station%frequency(n), station%has_met(n), &
      station%state(2*spectrum%motion%number, n))
    n = 0
    do k = 1, size(spectrum%mode)
      if (spectrum%number(k) == 0) cycle
      associate (mode => spectrum%mode(k))
        if (abs(mode%action) < certain) then
          call add(mode, aimag(mode%exponent), mode%start)
          call add(mode, -aimag(mode%exponent), conjg(mode%start))
        else if (mode%action > 0.0_wp) then
          call add(mode, aimag(mode%exponent), mode%start)
        else
          call add(mode, -aimag(mode%exponent), conjg(mode%start))
        end if
      end associate
    end do
    station%number = station%number(:n)
    station%phase = station%phase(:n)
    station%frequency = station%frequency(:n)
    station%has_met = station%has_met(:n)
    station%state = station%state(:, :n)

  contains

    subroutine add(mode, phase, start)
      type(slow_mode_t), intent(in) :: mode
      real(wp), intent(in) :: phase
      complex(wp), intent(in) :: start(:)

      n = n + 1
      station%number(n) = spectrum%number(k)
      station%phase(n) = phase
      station%frequency(n) = mode%shape_frequency
      station%has_met(n) = abs(mode%action) < certain
      station%state(:, n) = state_of(start, spectrum%motion%scale*speed)
    end subroutine add

  end subroutine new_station

  !> Coordinates and momenta at the first crank angle, of product 1 with themselves.
  pure function state_of(start, scale) result(state)
    complex(wp), intent(in) :: start(:) !! as in a mode of the slow motion
    real(wp), intent(in) :: scale       !! of momenta, times the speed
    complex(wp) :: state(size(start))

    integer :: m

    m = size(start)/2
    state(:m) = start(:m)
    state(m + 1:) = scale*start(m + 1:)
    state = state/sqrt(max(abs(product_of(state, state)), tiny(1.0_wp)))
  end function state_of

  !> How unlike a vibration a mode of the slow motion is, or its conjugate, from 0 to 1: by their
  !! product, where both have one.
  pure function unlikeness(meeting, vibration, mode, scale, conjugate) result(unlike)
    type(meeting_t), intent(in) :: meeting
    integer, intent(in) :: vibration    !! 1 or 2
    type(slow_mode_t), intent(in) :: mode
    real(wp), intent(in) :: scale       !! of momenta, times the speed
    logical, intent(in) :: conjugate
    real(wp) :: unlike

    complex(wp) :: state(size(mode%start))
    integer :: k

    unlike = 1.0_wp - same_enough
    if (abs(mode%action) < certain .or. .not. any(meeting%is_known(vibration, :))) return
    state = state_of(mode%start, scale)
    if (conjugate) state = conjg(state)
    unlike = 1.0_wp
    do k = 1, 2
      if (meeting%is_known(vibration, k)) unlike = min(unlike, &
        abs(1.0_wp - abs(product_of(meeting%state(:, vibration, k), state))))
    end do
  end function unlikeness

  !> The symplectic product `zᴴp − pᴴz` of two states.
  pure function product_of(one, other) result(product)
    complex(wp), intent(in) :: one(:), other(:)
    complex(wp) :: product

    integer :: m

    m = size(one)/2
    product = dot_product(one(:m), other(m + 1:)) - dot_product(one(m + 1:), other(:m))
  end function product_of

  !> Begins at a speed with the vibrations as they are numbered there.
  pure subroutine begin_branches(station, mean, branches)
    type(station_t), intent(in) :: station
    real(wp), intent(in) :: mean(:)   !! frequencies of the frozen linkage, mean over the turn, of
                                      !! as many vibrations as are wanted [rad/s]
    type(branches_t), intent(out) :: branches

    integer :: i, k, n

    n = maxval(station%number)
    branches%speed = station%speed
    allocate (branches%frequency(n), branches%shape(n), branches%state(size(station%state, 1), n))
    branches%slope = [(0.0_wp, i=1, n)]
    branches%is_known = [(.false., i=1, n)]
    branches%is_wanted = [(i <= size(mean), i=1, n)]
    do i = 1, n
      k = findloc(station%number, i, dim=1)
      branches%shape(i) = station%frequency(k)
      branches%frequency(i) = branches%shape(i)
      if (i <= size(mean)) branches%frequency(i) = mean(i)
      branches%frequency(i) = station%speed*(station%phase(k) + anint(branches%frequency(i)/ &
        station%speed - station%phase(k)))
      branches%is_known(i) = .not. station%has_met(k)
      branches%state(:, i) = station%state(:, k)
    end do
  end subroutine begin_branches

  !> Goes on to another speed: the multipliers that are nearest to where phases are expected, and
  !! most like those known. Of vibrations that are not wanted phases are not needed.
  pure subroutine go_on(branches, station, vibrations, next, is_near, is_like)
    type(branches_t), intent(in) :: branches
    type(station_t), intent(in) :: station
    integer, intent(in) :: vibrations        !! that are wanted
    type(branches_t), intent(out) :: next
    logical, intent(out) :: is_near, is_like !! each that is wanted was found where its phase is
                                             !! expected, and is like it was

    real(wp), dimension(size(branches%frequency), size(station%phase)) :: apart, unlike
    logical, dimension(size(branches%frequency), size(station%phase)) :: free
    real(wp) :: expected(size(branches%frequency))
    integer :: at(2), i, k, n, step

    n = size(branches%frequency)
    expected = branches%frequency + branches%slope*(station%speed - branches%speed)
    do k = 1, size(station%phase)
      do i = 1, n
        apart(i, k) = station%phase(k) - expected(i)/station%speed
        ! Where nothing can be told the phase decides.
        unlike(i, k) = 1.0_wp - same_enough
        if (branches%is_known(i) .and. .not. station%has_met(k)) unlike(i, k) = &
          max(0.0_wp, 1.0_wp - abs(product_of(branches%state(:, i), station%state(:, k))))
      end do
    end do
    apart = apart - anint(apart)
    next = branches
    next%speed = station%speed
    next%have_met = any(station%has_met .and. station%number <= vibrations)
    free = .true.
    is_near = size(station%phase) >= n
    is_like = is_near
    if (.not. is_near) return
    do step = 1, n
      at = minloc(min(1.0_wp, apart/near_enough)**2 + (unlike/(1.0_wp - same_enough))**2, mask=free)
      i = at(1)
      k = at(2)
      free(i, :) = .false.
      free(:, k) = .false.
      next%frequency(i) = expected(i) + apart(i, k)*station%speed
      next%shape(i) = station%frequency(k)
      next%is_wanted(i) = station%number(k) <= vibrations
      if (branches%is_wanted(i) .or. next%is_wanted(i)) then
        is_near = is_near .and. abs(apart(i, k)) < near_enough
        is_like = is_like .and. unlike(i, k) <= 1.0_wp - same_enough
      end if
      if (station%has_met(k)) cycle
      if (branches%is_known(i)) next%slope(i) = (next%frequency(i) - branches%frequency(i))/ &
        (station%speed - branches%speed)
      next%is_known(i) = .true.
      next%state(:, i) = station%state(:, k)
    end do
  end subroutine go_on

  !> Appends the meetings between two speeds: all with a whole number between both sums of phases,
  !! or at the second speed. One that lasts at the first has been counted before.
  pure subroutine find_meetings(left, right, meetings)
    type(branches_t), intent(in) :: left, right !! the same for meetings at the first speed of all
    type(meeting_t), allocatable, intent(inout) :: meetings(:)

    type(meeting_t) :: meeting
    real(wp) :: total(2)
    integer :: i, j, n
    logical :: is_first

    is_first = .not. right%speed > left%speed
    do i = 1, size(left%frequency)
      do j = i, size(left%frequency)
        if (.not. (all(left%is_wanted([i, j])) .or. all(right%is_wanted([i, j])))) cycle
        total = [(left%frequency(i) + left%frequency(j))/left%speed, &
          (right%frequency(i) + right%frequency(j))/right%speed]
        do n = ceiling(minval(total) - locked), floor(maxval(total) + locked)
          if ((abs(total(1) - n) <= locked) .neqv. is_first) cycle
          meeting%vibration = [i, j]
          meeting%total = n
          meeting%speed = [left%speed, right%speed]
          meeting%frequency(:, 1) = left%frequency([i, j])
          meeting%frequency(:, 2) = right%frequency([i, j])
          meeting%is_known(:, 1) = left%is_known([i, j])
          meeting%is_known(:, 2) = right%is_known([i, j])
          if (allocated(meeting%state)) deallocate (meeting%state)
          allocate (meeting%state(size(left%state, 1), 2, 2))
          meeting%state(:, :, 1) = left%state(:, [i, j])
          meeting%state(:, :, 2) = right%state(:, [i, j])
          meeting%shape = [minval([left%shape([i, j]), right%shape([i, j])]), &
            maxval([left%shape([i, j]), right%shape([i, j])])]
          meetings = [meetings, meeting]
        end do
      end do
    end do
  end subroutine find_meetings

  !> The frequencies of a meeting at a speed, in between both or near.
  pure function frequency_at(meeting, speed) result(frequency)
    type(meeting_t), intent(in) :: meeting
    real(wp), intent(in) :: speed
    real(wp) :: frequency(2)

    real(wp) :: share

    share = 0.0_wp
    if (meeting%speed(2) > meeting%speed(1)) share = (speed - meeting%speed(1))/ &
      (meeting%speed(2) - meeting%speed(1))
    frequency = meeting%frequency(:, 1) + share*(meeting%frequency(:, 2) - meeting%frequency(:, 1))
  end function frequency_at

end module vibration_branches
