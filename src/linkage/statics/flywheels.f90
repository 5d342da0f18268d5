!> The flywheel that keeps the speed of a driven linkage within a fluctuation, from the energy of
!! its cycle.
module flywheels
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: flywheel_t, size_flywheel

  !> A flywheel, and the cycle with it.
  type :: flywheel_t
    real(wp) :: inertia = 0.0_wp       !! that the flywheel needs; 0: none is needed [kg m²]
    real(wp) :: mean_torque = 0.0_wp   !! that drives the linkage [N m]
    real(wp) :: energy = 0.0_wp        !! greatest less least of ∫(Tm − Q) dθ [J]
    logical :: moves_alone = .false.   !! the linkage without a flywheel has an inertia everywhere
    real(wp) :: alone = 0.0_wp         !! its fluctuation without a flywheel [-]
    real(wp) :: fluctuation = 0.0_wp   !! with it [-]
    real(wp) :: greatest = 0.0_wp, least = 0.0_wp       !! speeds with it, absolute values [rad/s]
    real(wp) :: at_greatest = 0.0_wp, at_least = 0.0_wp !! where, from the start of the cycle [rad]
  end type flywheel_t

  !> A cycle, at the ends of its intervals.
  type :: cycle_t
    real(wp) :: step = 0.0_wp            !! length of an interval [rad]
    real(wp), allocatable :: inertia(:)  !! M [kg m²]
    real(wp), allocatable :: slope(:)    !! M' [kg m²]
    real(wp), allocatable :: excess(:)   !! Tm − Q [N m]
    real(wp), allocatable :: energy(:)   !! its integral W from the start [J]
  end type cycle_t

  !> A mean torque below this share of the largest torque is round-off and written as 0.
  real(wp), parameter :: round_off_share = 1.0e-12_wp

  integer, parameter :: most_iterations = 100, most_doublings = 400

contains

  !> Inertia of the flywheel on the first drive with which the speed fluctuates by δ.
  !!
  !! A constant torque Tm, the mean of the loads Q at the first drive, keeps the cycle:
  !! `½ (M + I) ω² = E0 + W`, `W = ∫(Tm − Q) dθ`. E0 is such that the mean speed over time,
  !! `Θ / ∫dθ/ω`, is Ω, and the inertia I such that `(ωmax − ωmin)/Ω = δ`. The textbooks'
  !! `ΔE/(δ Ω²)` (Norton, Design of Machinery, section 11.11) is its limit for small δ and
  !! constant M. W is by Simpson's rule on every second sample; greatest and least ω² between
  !! samples are those of Hermite's cubics with the exact slope `(2 (Tm − Q) − ω² M')/(M + I)`.
  !! The errors are of the fourth order of the distance of samples. M and Q do not depend on ω.
  pure function size_flywheel(inertia, slope, load, period, speed, fluctuation) result(flywheel)
    real(wp), intent(in) :: inertia(:)   !! (samples) M at an even number of even steps [kg m²]
    real(wp), intent(in) :: slope(:)     !! (samples) M' [kg m²]
    real(wp), intent(in) :: load(:)      !! (samples) Q, torque that holds the loads [N m]
    real(wp), intent(in) :: period       !! Θ of the cycle [rad]
    real(wp), intent(in) :: speed        !! Ω, not 0 [rad/s]
    real(wp), intent(in) :: fluctuation  !! δ > 0 [-]
    type(flywheel_t) :: flywheel

    type(cycle_t) :: turn
    real(wp) :: low, high, middle
    integer :: i

    turn = cycle_of(inertia, slope, load, period)
    flywheel%mean_torque = mean_load(load)
    if (abs(flywheel%mean_torque) <= round_off_share*maxval(abs(load))) flywheel%mean_torque = &
      0.0_wp
    flywheel%energy = swing(turn%energy, turn%excess, turn%step)
    flywheel%moves_alone = minval(turn%inertia) > epsilon(1.0_wp)*flywheel%energy/speed**2
    if (flywheel%moves_alone) then
      call run(turn, 0.0_wp, speed, flywheel)
      flywheel%alone = flywheel%fluctuation
      if (flywheel%alone <= fluctuation) return
    end if
    if (.not. (flywheel%energy > 0.0_wp .or. maxval(turn%inertia) > minval(turn%inertia))) then
      ! Nothing changes the speed, and where nothing has a mass, no energy tells it.
      flywheel%greatest = abs(speed)
      flywheel%least = abs(speed)
      return
    end if
    ! What loads and what the change of M alone would ask for.
    high = flywheel%energy/(fluctuation*speed**2) + (maxval(turn%inertia) - &
      minval(turn%inertia))/fluctuation + tiny(1.0_wp)
    do i = 1, most_doublings
      call run(turn, high, speed, flywheel)
      if (flywheel%fluctuation <= fluctuation) exit
      high = 2.0_wp*high
    end do
    low = high
    do i = 1, most_doublings
      low = 0.5_wp*low
      if (low < epsilon(1.0_wp)*maxval(turn%inertia)) then
        low = 0.0_wp
        exit
      end if
      call run(turn, low, speed, flywheel)
      if (flywheel%fluctuation > fluctuation) exit
      high = low
    end do
    do
      middle = 0.5_wp*(low + high)
      if (middle <= low .or. middle >= high) exit
      call run(turn, middle, speed, flywheel)
      if (flywheel%fluctuation > fluctuation) then
        low = middle
      else
        high = middle
      end if
    end do
    call run(turn, high, speed, flywheel)
    flywheel%inertia = high
  end function size_flywheel

  !> Mean by Simpson's rule over intervals of two steps.
  pure function mean_load(load) result(mean)
    real(wp), intent(in) :: load(:)
    real(wp) :: mean

    mean = (2.0_wp*sum(load(1::2)) + 4.0_wp*sum(load(2::2)))/(3.0_wp*size(load))
  end function mean_load

  !> The cycle at every second sample.
  pure function cycle_of(inertia, slope, load, period) result(turn)
    real(wp), intent(in) :: inertia(:), slope(:), load(:), period
    type(cycle_t) :: turn

    real(wp) :: excess(size(load) + 1)
    integer :: k, n

    n = size(load)/2
    excess(:2*n) = mean_load(load) - load
    excess(2*n + 1) = excess(1)
    turn%step = period/n
    turn%inertia = inertia(1::2)
    turn%slope = slope(1::2)
    turn%excess = excess(1:2*n:2)
    allocate (turn%energy(n))
    turn%energy(1) = 0.0_wp
    do k = 2, n
      turn%energy(k) = turn%energy(k - 1) + turn%step/6.0_wp*(excess(2*k - 3) + &
        4.0_wp*excess(2*k - 2) + excess(2*k - 1))
    end do
  end function cycle_of

  !> Speeds and fluctuation with a flywheel of a given inertia.
  pure subroutine run(turn, added, speed, flywheel)
    type(cycle_t), intent(in) :: turn
    real(wp), intent(in) :: added, speed !! I, Ω
    type(flywheel_t), intent(inout) :: flywheel

    real(wp), dimension(size(turn%energy)) :: total, square, slope
    real(wp) :: low, high

    total = turn%inertia + added
    square = 2.0_wp*(energy_of_mean_speed(turn, total, abs(speed)) + turn%energy)/total
    slope = (2.0_wp*turn%excess - square*turn%slope)/total
    call find_extremes(square, slope, turn%step, low, high, flywheel%at_least, flywheel%at_greatest)
    flywheel%least = sqrt(max(0.0_wp, low))
    flywheel%greatest = sqrt(high)
    ! The difference of two speeds that are nearly the same would lose its digits.
    flywheel%fluctuation = (high - low)/((flywheel%greatest + flywheel%least)*abs(speed))
  end subroutine run

  !> E0 with which the mean speed over time is the given one. The time of the cycle falls with E0
  !! and is convex: Newton's method comes from below and stays there. Where the mean speed is so low
  !! that the linkage all but stops, its energy there is less than rounding: none is left.
  pure function energy_of_mean_speed(turn, total, speed) result(energy)
    type(cycle_t), intent(in) :: turn
    real(wp), intent(in) :: total(:), speed
    real(wp) :: energy

    real(wp) :: rate(size(total)), floor, next, excess, last
    integer :: i

    floor = -minval(turn%energy)
    energy = max(0.5_wp*speed**2*sum(total)/size(total) - sum(turn%energy)/size(total), &
      floor + 1.0e-3_wp*speed**2*minval(total))
    last = huge(last)
    do i = 1, most_iterations
      if (energy <= floor) exit
      rate = sqrt(2.0_wp*(energy + turn%energy)/total)
      ! Mean of 1/ω less what it is to be, and its derivative −mean of 1/(ω³ (M + I)).
      excess = sum(1.0_wp/rate)/size(total) - 1.0_wp/speed
      next = energy + excess/(sum(1.0_wp/(rate**3*total))/size(total))
      if (next <= floor) next = 0.5_wp*(energy + floor)
      ! Steps shrink until rounding stops them.
      if (abs(next - energy) <= 0.0_wp .or. (abs(next - energy) >= last .and. &
        last <= 1.0e-10_wp*abs(energy - floor))) exit
      last = abs(next - energy)
      energy = next
    end do
  end function energy_of_mean_speed

  !> Greatest less least of a periodic quantity.
  pure function swing(values, slopes, step) result(difference)
    real(wp), intent(in) :: values(:), slopes(:), step
    real(wp) :: difference

    real(wp) :: low, high, at_low, at_high

    call find_extremes(values, slopes, step, low, high, at_low, at_high)
    difference = high - low
  end function swing

  !> Extremes of a periodic quantity, also between samples, on Hermite's cubics.
  pure subroutine find_extremes(values, slopes, step, low, high, at_low, at_high)
    real(wp), intent(in) :: values(:), slopes(:), step
    real(wp), intent(out) :: low, high, at_low, at_high !! at_…: from the first sample

    real(wp) :: c(0:3), root(2), discriminant, q, value
    integer :: k, next, r

    at_low = step*(minloc(values, dim=1) - 1)
    at_high = step*(maxloc(values, dim=1) - 1)
    low = minval(values)
    high = maxval(values)
    do k = 1, size(values)
      next = 1 + mod(k, size(values))
      if (slopes(k)*slopes(next) > 0.0_wp) cycle
      c(0) = values(k)
      c(1) = step*slopes(k)
      c(2) = 3.0_wp*(values(next) - values(k)) - step*(2.0_wp*slopes(k) + slopes(next))
      c(3) = 2.0_wp*(values(k) - values(next)) + step*(slopes(k) + slopes(next))
      ! Roots of c1 + 2 c2 t + 3 c3 t², without cancellation.
      discriminant = c(2)**2 - 3.0_wp*c(3)*c(1)
      if (discriminant < 0.0_wp) cycle
      q = -(c(2) + sign(sqrt(discriminant), c(2)))
      root = -1.0_wp
      if (abs(c(3)) > 0.0_wp) root(1) = q/(3.0_wp*c(3))
      if (abs(q) > 0.0_wp) root(2) = c(1)/q
      do r = 1, 2
        if (.not. (root(r) >= 0.0_wp .and. root(r) <= 1.0_wp)) cycle
        value = c(0) + root(r)*(c(1) + root(r)*(c(2) + root(r)*c(3)))
        if (value < low) then
          low = value
          at_low = step*(k - 1 + root(r))
        end if
        if (value > high) then
          high = value
          at_high = step*(k - 1 + root(r))
        end if
      end do
    end do
  end subroutine find_extremes

end module flywheels
