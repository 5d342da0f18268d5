!> The multipliers of a turn at one speed, without damping, as those of its vibrations, and which of
!! them those at another speed are.
!!
!! Each vibration has one multiplier of positive Krein signature, on the unit circle at α turns, and
!! its conjugate. Two that have met left the circle: together they are a multiplier of positive and
!! one of negative signature at one angle, and their two motions span a plane that changes
!! continuously where each motion by itself does not. Products of these spaces tell which
!! multipliers belong together at two speeds; those of different vibrations are 0.
module multiplier_stations
  use kinds, only: wp
  use slow_motions, only: slow_mode_t
  use turn_spectra, only: turn_spectrum_t
  implicit none (type, external)
  private

  public :: station_t, new_station, match_stations, plane_t, plane_of, state_of, left_of

  !> Real parts of exponents above this are off the circle; exponents of a pair of multipliers
  !! ρ, 1/ρ̄ differ by no more than the second.
  real(wp), parameter :: off_circle = 1.0e-7_wp, of_pair = 1.0e-5_wp

  !> A vibration is found again if its angle is as near as this to where it is expected [turns], and
  !! if the product of the spaces is no less than this. Between, its angle is known well if it is as
  !! near as the third.
  real(wp), parameter :: near_enough = 0.2_wp, same_enough = 0.6_wp, smooth_enough = 4.0e-3_wp

  !> Where two multipliers meet their actions vanish, and slopes are not finite: no smaller ones
  !! than this are used.
  real(wp), parameter :: least_action = 0.1_wp

  !> Multipliers as those of vibrations. Two vibrations whose multipliers have met share their
  !! space.
  type :: station_t
    real(wp) :: speed = 0.0_wp              !! |ω2| [rad/s]
    real(wp) :: scale = 1.0_wp              !! of momenta
    integer, allocatable :: number(:)       !! (vibrations) by the frequency of the shape
    real(wp), allocatable :: turns(:)       !! (vibrations) α, −1/2 to 1/2
    real(wp), allocatable :: rate(:)        !! (vibrations) frequency of the shape in terms of ω2
    real(wp), allocatable :: slope(:)       !! (vibrations) dα/d ln ω2 [turns]; 0: off the circle
    real(wp), allocatable :: growth(:)      !! (vibrations) greatest real part of σ; 0: on the
                                            !! circle
    integer, allocatable :: met(:)          !! (vibrations) whose multiplier each has met, itself
                                            !! where it is real; 0: none
    complex(wp), allocatable :: space(:, :, :) !! (coordinates and momenta, 2, vibrations) motions
    complex(wp), allocatable :: dual(:, :, :)  !! the same, of product 1 with one motion, 0 with the
                                               !! other
  end type station_t

  !> The space of two multipliers that meet, or may.
  type :: plane_t
    real(wp) :: speed = 0.0_wp, scale = 1.0_wp
    real(wp) :: turns = 0.0_wp  !! the mean angle of both
    real(wp) :: rate = 0.0_wp   !! −d turns/d ln ω2, about
    complex(wp), allocatable :: space(:, :), dual(:, :) !! (coordinates and momenta, 2)
  end type plane_t

contains

  !> The multipliers of a spectrum.
  subroutine new_station(spectrum, speed, station)
    type(turn_spectrum_t), intent(in) :: spectrum !! without damping
    real(wp), intent(in) :: speed                 !! |ω2| [rad/s]
    type(station_t), intent(out) :: station

    integer :: k, n, other
    logical :: free(size(spectrum%mode))

    station%speed = speed
    station%scale = spectrum%motion%scale*speed
    n = size(spectrum%mode)
    allocate (station%number(n), station%turns(n), station%rate(n), station%slope(n), &
      station%growth(n), station%met(n), station%space(2*spectrum%motion%number, 2, n))
    allocate (station%dual, mold=station%space)
    n = 0
    free = spectrum%number > 0
    do k = 1, size(spectrum%mode)
      if (.not. free(k)) cycle
      associate (mode => spectrum%mode(k))
        other = partner_of(k)
        free(k) = .false.
        if (other > 0) then
          free(other) = .false.
          call add_met(k, other)
          if (.not. mode%is_complex) cycle
          station%met(n) = n + 1
          call add_met(other, k)
          station%met(n) = n - 1
          station%turns(n) = -station%turns(n)
          station%space(:, :, n) = conjg(station%space(:, :, n))
          station%dual(:, :, n) = conjg(station%dual(:, :, n))
        else
          call add_free(mode)
        end if
      end associate
    end do
    station%number = station%number(:n)
    station%turns = station%turns(:n)
    station%rate = station%rate(:n)
    station%slope = station%slope(:n)
    station%growth = station%growth(:n)
    station%met = station%met(:n)
    station%space = station%space(:, :, :n)
    station%dual = station%dual(:, :, :n)

  contains

    !> The mode whose exponent is −σ̄, of a mode off the circle; 0: it is on it.
    pure function partner_of(k) result(partner)
      integer, intent(in) :: k
      integer :: partner

      real(wp) :: apart(size(spectrum%mode))

      partner = 0
      associate (mode => spectrum%mode)
        if (mode(k)%is_complex .and. abs(real(mode(k)%exponent)) <= off_circle) return
        apart = abs(mode%exponent + conjg(mode(k)%exponent))
        where (.not. free .or. (mode%is_complex .neqv. mode(k)%is_complex)) apart = huge(1.0_wp)
        apart(k) = huge(1.0_wp)
        if (minval(apart) <= of_pair .or. .not. mode(k)%is_complex) partner = minloc(apart, dim=1)
        if (partner > 0) then
          if (apart(partner) >= huge(1.0_wp)) partner = 0
        end if
      end associate
    end function partner_of

    subroutine add(mode)
      type(slow_mode_t), intent(in) :: mode

      n = n + 1
      station%number(n) = spectrum%number(k)
      station%turns(n) = aimag(mode%exponent)
      station%rate(n) = mode%shape_frequency/speed
      station%slope(n) = 0.0_wp
      station%growth(n) = 0.0_wp
      station%met(n) = 0
      station%space(:, :, n) = 0.0_wp
      station%dual(:, :, n) = 0.0_wp
    end subroutine add

    subroutine add_free(mode)
      type(slow_mode_t), intent(in) :: mode

      complex(wp) :: u(size(mode%start)), square

      call add(mode)
      ! Only the stiffness depends on ω2: dσ/d ln ω2 is that part of the action.
      station%slope(n) = -station%rate(n)/max(abs(mode%action), least_action)
      u = state_of(mode%start, station%scale)
      if (mode%action < 0.0_wp) then
        u = conjg(u)
        station%turns(n) = -station%turns(n)
      end if
      square = product_of(u, u)
      u = u/sqrt(max(abs(square), tiny(1.0_wp)))
      station%space(:, 1, n) = u
      station%dual(:, 1, n) = u/sign(1.0_wp, aimag(square))*(0.0_wp, 1.0_wp)
    end subroutine add_free

    !> A mode off the circle and its partner; the number is that of the first.
    subroutine add_met(first, second)
      integer, intent(in) :: first, second

      complex(wp), dimension(size(station%space, 1)) :: v, w

      associate (one => spectrum%mode(first), other => spectrum%mode(second))
        call add(one)
        station%number(n) = spectrum%number(first)
        station%turns(n) = aimag(one%exponent)
        station%growth(n) = max(real(one%exponent), real(other%exponent))
        station%met(n) = n
        v = state_of(one%start, station%scale)
        w = state_of(other%start, station%scale)
        station%space(:, 1, n) = v
        station%space(:, 2, n) = w
        station%dual(:, 1, n) = w/conjg(product_of(w, v))
        station%dual(:, 2, n) = v/conjg(product_of(v, w))
      end associate
    end subroutine add_met

  end subroutine new_station

  !> Coordinates and momenta at the first crank angle.
  pure function state_of(start, scale) result(state)
    complex(wp), intent(in) :: start(:) !! as in a mode of the slow motion
    real(wp), intent(in) :: scale       !! of momenta, times the speed
    complex(wp) :: state(size(start))

    integer :: m

    m = size(start)/2
    state(:m) = start(:m)
    state(m + 1:) = scale*start(m + 1:)
  end function state_of

  !> The symplectic product `zᴴp − pᴴz` of two states.
  pure function product_of(one, other) result(product)
    complex(wp), intent(in) :: one(:), other(:)
    complex(wp) :: product

    integer :: m

    m = size(one)/2
    product = dot_product(one(:m), other(m + 1:)) - dot_product(one(m + 1:), other(:m))
  end function product_of

  !> Which vibration of a speed is which of another that is near: those whose spaces are most alike
  !! and whose angles are nearest to where they are expected, the best first.
  pure subroutine match_stations(from, to, partner, change, near, alike, smooth)
    type(station_t), intent(in) :: from, to
    integer, intent(out) :: partner(:)   !! (vibrations of `from`) among those of `to`; 0: none
    real(wp), intent(out) :: change(:)   !! (vibrations of `from`) of α [turns]
    logical, intent(out) :: near(:), alike(:) !! (vibrations of `from`) the angle is near where it
                                              !! was expected, the space as it was
    logical, intent(out) :: smooth(:)         !! (the same) the angle is where slopes at both ends
                                              !! have it

    real(wp), dimension(size(from%turns), size(to%turns)) :: apart, unlike, cost, expected
    integer :: at(2), i, k, step

    do k = 1, size(to%turns)
      expected(:, k) = from%turns + log(to%speed/from%speed)*0.5_wp*(from%slope + to%slope(k))
      where (from%met > 0) expected(:, k) = from%turns + log(to%speed/from%speed)*to%slope(k)
      if (to%met(k) > 0) expected(:, k) = from%turns + log(to%speed/from%speed)*from%slope
      apart(:, k) = to%turns(k) - expected(:, k)
      do i = 1, size(from%turns)
        unlike(i, k) = max(0.0_wp, 1.0_wp - likeness(from, i, to, k))
      end do
    end do
    apart = apart - anint(apart)
    cost = min(1.0_wp, abs(apart)/near_enough)**2 + (unlike/(1.0_wp - same_enough))**2
    partner = 0
    change = 0.0_wp
    near = .false.
    alike = .false.
    smooth = .false.
    do step = 1, min(size(from%turns), size(to%turns))
      at = minloc(cost)
      i = at(1)
      k = at(2)
      partner(i) = k
      change(i) = expected(i, k) + apart(i, k) - from%turns(i)
      near(i) = abs(apart(i, k)) < near_enough
      smooth(i) = abs(apart(i, k)) < smooth_enough
      alike(i) = unlike(i, k) <= 1.0_wp - same_enough
      cost(i, :) = huge(1.0_wp)
      cost(:, k) = huge(1.0_wp)
    end do
  end subroutine match_stations

  !> How alike the spaces of two vibrations are: 1 where they are the same, or one is in the other.
  pure function likeness(one, i, other, k)
    type(station_t), intent(in) :: one, other
    integer, intent(in) :: i, k
    real(wp) :: likeness

    complex(wp) :: trace
    integer :: a, b, dimensions

    trace = 0.0_wp
    do b = 1, 2
      do a = 1, 2
        trace = trace + product_of(one%dual(:, a, i), other%space(:, b, k))* &
          product_of(other%dual(:, b, k), one%space(:, a, i))
      end do
    end do
    dimensions = merge(2, 1, one%met(i) > 0 .and. other%met(k) > 0)
    likeness = sqrt(abs(trace)/dimensions)
  end function likeness

  !> The space of the multiplier of one vibration and the conjugate of that of another, or of its
  !! own.
  pure function plane_of(station, pair) result(plane)
    type(station_t), intent(in) :: station
    integer, intent(in) :: pair(2) !! vibrations
    type(plane_t) :: plane

    real(wp) :: apart

    plane%speed = station%speed
    plane%scale = station%scale
    associate (i => pair(1), j => pair(2))
      plane%turns = station%turns(i)
      plane%space = station%space(:, :, i)
      plane%dual = station%dual(:, :, i)
      if (station%met(i) == j) return
      apart = -station%turns(j) - station%turns(i)
      plane%turns = station%turns(i) + 0.5_wp*(apart - anint(apart))
      plane%rate = 0.5_wp*(station%slope(j) - station%slope(i))
      plane%space(:, 2) = conjg(station%space(:, 1, j))
      plane%dual(:, 2) = conjg(station%dual(:, 1, j))
    end associate
  end function plane_of

  !> What is left of a state beside its part in a plane, from 0 to about 1.
  pure function left_of(plane, state) result(left)
    type(plane_t), intent(in) :: plane
    complex(wp), intent(in) :: state(:)
    real(wp) :: left

    complex(wp) :: rest(size(state))
    integer :: i

    rest = state
    do i = 1, 2
      rest = rest - product_of(plane%dual(:, i), state)*plane%space(:, i)
    end do
    left = length_of(rest)/length_of(state)

  contains

    pure function length_of(x) result(length)
      complex(wp), intent(in) :: x(:)
      real(wp) :: length

      integer :: m

      m = size(x)/2
      length = sqrt(sum(abs(x(:m))**2) + sum(abs(x(m + 1:)/plane%scale)**2))
    end function length_of

  end function left_of

end module multiplier_stations
