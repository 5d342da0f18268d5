!> Kinematics at a position and speed: angles, angular velocities and accelerations of links, paths,
!! velocities and accelerations of pins; of a four-bar in one row, with the transmission angle.
module kinematics_study
  use four_bar_loops, only: four_bar_t
  use kinds, only: wp
  use linkages, only: linkage_t
  use poses, only: angle_along, body_angle, transmission_angle
  use positions, only: positions_t, state_t
  use units, only: in_degrees
  implicit none (type, external)
  private

  public :: link_at_speed, pin_at_speed, four_bar_at_speed, transmission_at, &
    transmission_range_t, widen_transmission_range

  !> The least and the greatest transmission angle of a four-bar over a deck's list.
  type :: transmission_range_t
    real(wp) :: least = huge(1.0_wp), most = -1.0_wp !! [deg]; most < 0: there is no pose at all
    real(wp) :: at_least = 0.0_wp, at_most = 0.0_wp  !! crank angles [deg]
  end type transmission_range_t

contains

  !> Angle [deg], angular velocity [rad/s] and acceleration [rad/s²] of a link.
  pure function link_at_speed(linkage, state, body, speed, acceleration, from) result(values)
    type(linkage_t), intent(in) :: linkage !! its bodies
    type(state_t), intent(in) :: state     !! with a pose
    integer, intent(in) :: body            !! number, from 1
    real(wp), intent(in) :: speed          !! of the first drive [rad/s] or [m/s]
    real(wp), intent(in) :: acceleration   !! of the first drive [rad/s²] or [m/s²]
    integer, intent(in), optional :: from  !! its end from which the angle is measured; absent: as
                                           !! its card names the pins
    real(wp) :: values(3)

    associate (h => state%coefficients%turn(body), slope => state%coefficients%turn_slope(body))
      values = [0.0_wp, h*speed, h*acceleration + slope*speed**2]
    end associate
    if (present(from)) then
      values(1) = in_degrees(angle_along(linkage, state%pose, body, from))
    else
      values(1) = in_degrees(body_angle(linkage, state%pose, body))
    end if
  end function link_at_speed

  !> Place [m], velocity [m/s] and acceleration [m/s²] of a pin.
  pure function pin_at_speed(state, pin, speed, acceleration) result(values)
    type(state_t), intent(in) :: state   !! with a pose
    integer, intent(in) :: pin           !! number, from 1
    real(wp), intent(in) :: speed        !! of the first drive [rad/s] or [m/s]
    real(wp), intent(in) :: acceleration !! of the first drive [rad/s²] or [m/s²]
    real(wp) :: values(6)

    values = [state%pose%pin(:, pin), state%coefficients%pin(:, pin)*speed, &
      state%coefficients%pin(:, pin)*acceleration + state%coefficients%pin_slope(:, pin)*speed**2]
  end function pin_at_speed

  !> A four-bar, Ulker 2010 (2.1) to (2.38): θ3, θ4 [deg], ω3, ω4 [rad/s], α3, α4 [rad/s²], x and y
  !! of A and B [m], transmission angle [deg].
  pure function four_bar_at_speed(linkage, four_bar, state, speed, acceleration) result(values)
    type(linkage_t), intent(in) :: linkage   !! a four-bar
    type(four_bar_t), intent(in) :: four_bar !! that it is
    type(state_t), intent(in) :: state       !! with a pose
    real(wp), intent(in) :: speed            !! ω2 [rad/s]
    real(wp), intent(in) :: acceleration     !! α2 [rad/s²]
    real(wp) :: values(11)

    real(wp) :: link(3, 2)
    integer :: i

    do i = 1, 2
      link(:, i) = link_at_speed(linkage, state, four_bar%body(i + 1), speed, acceleration, &
        four_bar%pin(2*i))
    end do
    values(:10) = [transpose(link), state%pose%pin(:, four_bar%pin(2:3))]
    values(11) = transmission_at(linkage, four_bar, state)
  end function four_bar_at_speed

  !> Transmission angle of a four-bar, between coupler and follower [deg].
  pure function transmission_at(linkage, four_bar, state) result(angle)
    type(linkage_t), intent(in) :: linkage   !! a four-bar
    type(four_bar_t), intent(in) :: four_bar !! that it is
    type(state_t), intent(in) :: state       !! with a pose
    real(wp) :: angle

    angle = in_degrees(transmission_angle(linkage, state%pose, four_bar%dyad))
  end function transmission_at

  !> Takes the transmission angles at some positions into their range; of equal ones the first
  !! counts.
  pure subroutine widen_transmission_range(linkage, four_bar, positions, range)
    type(linkage_t), intent(in) :: linkage              !! a four-bar
    type(four_bar_t), intent(in) :: four_bar            !! that it is
    type(positions_t), intent(in) :: positions          !! of the run, or a block of them
    type(transmission_range_t), intent(inout) :: range  !! of the blocks before

    real(wp) :: angle
    integer :: i

    do i = 1, size(positions%crank)
      associate (state => positions%states(positions%state(i)))
        if (allocated(state%error)) cycle
        angle = transmission_at(linkage, four_bar, state)
      end associate
      if (angle < range%least) range%at_least = positions%crank(i)
      if (angle > range%most) range%at_most = positions%crank(i)
      range%least = min(range%least, angle)
      range%most = max(range%most, angle)
    end do
  end subroutine widen_transmission_range

end module kinematics_study
