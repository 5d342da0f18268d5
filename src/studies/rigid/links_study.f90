!> Angles, angular velocities and accelerations of links, and paths, velocities and accelerations of
!! pins, at a position and speed.
module links_study
  use constants, only: degree
  use kinds, only: wp
  use linkages, only: linkage_t
  use poses, only: body_angle
  use positions, only: state_t
  implicit none (type, external)
  private

  public :: link_at_speed, pin_at_speed

contains

  !> Angle [deg], angular velocity [rad/s] and acceleration [rad/s²] of a link.
  pure function link_at_speed(linkage, state, body, speed, acceleration) result(values)
    type(linkage_t), intent(in) :: linkage !! its bodies
    type(state_t), intent(in) :: state     !! with a pose
    integer, intent(in) :: body            !! number, from 1
    real(wp), intent(in) :: speed          !! of the first drive [rad/s] or [m/s]
    real(wp), intent(in) :: acceleration   !! of the first drive [rad/s²] or [m/s²]
    real(wp) :: values(3)

    values = [body_angle(linkage, state%pose, body)/degree, state%coefficients%turn(body)*speed, &
      state%coefficients%turn(body)*acceleration + state%coefficients%turn_slope(body)*speed**2]
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

end module links_study
