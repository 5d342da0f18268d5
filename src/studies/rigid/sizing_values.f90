!> What is sized at one speed, and its errors by twice as many samples of the cycle.
module sizing_values
  use flywheels, only: flywheel_t
  use kinds, only: fineness, wp
  implicit none (type, external)
  private

  public :: sized_t, sizing_t, timed_t, largest_change, between_angles, settled

  !> Samples of a cycle are doubled until no result changes by more than this share of its peak.
  real(wp), parameter :: settled = 1.0e-11_wp*fineness

  !> Changes that fall by more than this with twice as many samples are those of a smooth force.
  real(wp), parameter :: of_smooth = 1.0e-3_wp

  !> Values of a flywheel: mean torque, energy, fluctuation without it, its inertia, fluctuation
  !! with it, greatest and least speed.
  integer, parameter :: flywheel_values = 7

  !> What varies with laws, and of actuators; that of a drive at constant speed does not.
  type :: timed_t
    real(wp) :: rate_at = 0.0_wp    !! where the rate is greatest [deg], of laws [s]
    real(wp) :: rms_rate = 0.0_wp   !! [rad/s] or [m/s]
    real(wp) :: peak_power = 0.0_wp !! greatest absolute value, with its sign [W]
    real(wp) :: power_at = 0.0_wp   !! where it is, likewise
    real(wp) :: mean_power = 0.0_wp !! [W]
    real(wp) :: error(2) = 0.0_wp   !! of rates and powers, estimated, as shares of the greatest [-]
    real(wp) :: change(2) = 1.0_wp  !! of these from half as many samples [-]
  end type timed_t

  !> A force over the cycle: of a drive its torque or force, with its sign, of the motor likewise,
  !! at its shaft; of a joint its magnitude.
  type :: sized_t
    integer :: drive = 0        !! number; 0: of a joint
    integer :: joint = 0        !! number; 0: of a drive
    logical :: is_motor = .false. !! of the motor of the first drive
    real(wp) :: peak = 0.0_wp   !! greatest absolute value, with its sign [N m] or [N]
    real(wp) :: crank = 0.0_wp  !! position of the first drive there [deg], of laws the time [s]
    real(wp) :: angle = 0.0_wp  !! of a joint: of the force there, in the axes of its link [deg]
    real(wp) :: rate = 0.0_wp   !! of a drive or the motor, where it varies the greatest absolute
                                !! value with its sign [rad/s] or [m/s]
    logical :: varies = .false. !! its rate: of a drive or the motor with laws, or an actuator
    type(timed_t) :: timed      !! where it does
    real(wp) :: rms = 0.0_wp    !! [N m] or [N]
    real(wp) :: mean = 0.0_wp   !! [N m] or [N]
    real(wp) :: cubic = 0.0_wp  !! cubic mean of absolute values [N m] or [N]
    logical :: turns = .false.  !! the joint turns or slides
    real(wp) :: turned_cubic = 0.0_wp !! cubic mean weighted by how fast it does [N]
    real(wp) :: turned_error = 0.0_wp !! of it, estimated, as a share of the peak [-]
    real(wp) :: error = 0.0_wp  !! of peak and other means, estimated, as a share of the peak [-]
    real(wp) :: angle_error = 0.0_wp !! of the angle, estimated [deg]
    real(wp) :: change(2) = 1.0_wp   !! of what `error` and `turned_error` are about, from half as
                                     !! many samples, as shares of the peak [-]
    logical :: has_kinks = .false.   !! the force passes zero between samples, perhaps
  end type sized_t

  !> At one speed.
  type :: sizing_t
    type(sized_t), allocatable :: sized(:)  !! drives, the motor if it has a gear, then joints
    logical :: has_flywheel = .false.       !! `flywheel` is found
    type(flywheel_t) :: flywheel            !! on the first drive
    type(flywheel_t) :: between             !! the same from the samples between
    real(wp) :: flywheel_error(flywheel_values) = 0.0_wp !! of the values of `values_of_flywheel`,
                                            !! estimated, shares of these; of the mean torque of
                                            !! the peak of the first drive [-]
  end type sizing_t

contains

  !> The greatest change of all results, which become their estimated errors.
  function largest_change(now, last) result(change)
    type(sizing_t), intent(inout) :: now(:)
    type(sizing_t), intent(in) :: last(:)
    real(wp) :: change

    integer :: k, s

    change = 0.0_wp
    do k = 1, size(now)
      do s = 1, size(now(k)%sized)
        associate (a => now(k)%sized(s), b => last(k)%sized(s))
          a%change = [max(abs(abs(a%peak) - abs(b%peak)), abs(a%rms - b%rms), abs(a%mean - &
            b%mean), abs(a%cubic - b%cubic)), abs(a%turned_cubic - b%turned_cubic)]/ &
            max(abs(a%peak), tiny(1.0_wp))
          a%error = error_of(a%has_kinks, a%change(1), b%change(1), b%error)
          a%turned_error = error_of(.false., a%change(2), b%change(2), b%turned_error)
          a%angle_error = max(a%angle_error, between_angles(a%angle, b%angle))
          change = max(change, a%change(1))
          call compare_timed(a%rate, b%rate, b%timed, a%timed)
        end associate
      end do
      if (.not. now(k)%has_flywheel) cycle
      call compare_flywheels(now(k), last(k), change)
    end do
  end function largest_change

  !> Errors of what varies with laws, which have kinks.
  pure subroutine compare_timed(rate, last_rate, last, now)
    real(wp), intent(in) :: rate, last_rate !! greatest
    type(timed_t), intent(in) :: last
    type(timed_t), intent(inout) :: now

    now%change = [max(abs(abs(rate) - abs(last_rate)), abs(now%rms_rate - last%rms_rate))/ &
      max(abs(rate), tiny(1.0_wp)), max(abs(abs(now%peak_power) - abs(last%peak_power)), &
      abs(now%mean_power - last%mean_power))/max(abs(now%peak_power), tiny(1.0_wp))]
    now%error = error_of(.true., now%change, last%change, last%error)
  end subroutine compare_timed

  !> The error of a mean from its change by twice as many samples. Means of a smooth force converge
  !! exponentially. With kinks, where friction changes its sense or a force passes zero, errors fall
  !! with the square of the distance of samples and by where the kinks lie between them, and a
  !! change may be small by chance: then they count that were before.
  elemental function error_of(has_kinks, change, last_change, last_error) result(error)
    logical, intent(in) :: has_kinks !! else they show by how changes fall
    real(wp), intent(in) :: change, last_change, last_error
    real(wp) :: error

    error = change
    if (max(change, last_change) <= settled) return
    if (has_kinks .or. change > max(of_smooth*last_change, last_change**1.5_wp)) error = &
      max(change, 0.25_wp*last_error)
  end function error_of

  !> Errors of a flywheel: from half as many samples, and from those between. The latter miss the
  !! extremes, and the mean of 1/ω, by the opposite of what the former do, so that the errors of
  !! both are not small by chance together.
  pure subroutine compare_flywheels(now, last, change)
    type(sizing_t), intent(inout) :: now
    type(sizing_t), intent(in) :: last
    real(wp), intent(inout) :: change

    real(wp), parameter :: rounding = 32.0_wp*epsilon(1.0_wp), safety = 1.5_wp
    real(wp), dimension(flywheel_values) :: here, scale, least

    here = values_of_flywheel(now%flywheel)
    scale = max(abs(here), tiny(1.0_wp))
    scale(1) = max(abs(now%sized(1)%peak), abs(here(1)), tiny(1.0_wp))
    now%flywheel_error = max(abs(here - values_of_flywheel(now%between)), &
      abs(here - values_of_flywheel(last%flywheel)))/scale
    ! Differences of speeds have the rounding of the speeds.
    least = rounding
    least([3, 4, 5]) = rounding/max(here([3, 5, 5]), rounding)
    change = max(change, maxval(now%flywheel_error, mask=now%flywheel_error > 10.0_wp*least))
    now%flywheel_error = safety*now%flywheel_error + least
  end subroutine compare_flywheels

  pure function values_of_flywheel(flywheel) result(values)
    type(flywheel_t), intent(in) :: flywheel
    real(wp) :: values(flywheel_values)

    values = [flywheel%mean_torque, flywheel%energy, flywheel%alone, flywheel%inertia, &
      flywheel%fluctuation, flywheel%greatest, flywheel%least]
  end function values_of_flywheel

  !> Distance of two directions [deg].
  elemental function between_angles(one, other) result(distance)
    real(wp), intent(in) :: one, other !! [deg]
    real(wp) :: distance

    distance = abs(modulo(one - other + 180.0_wp, 360.0_wp) - 180.0_wp)
  end function between_angles

end module sizing_values
