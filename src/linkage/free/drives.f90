!> The drive of a linkage that moves by itself.
module drives
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: drive_t, motor_drive_t

  !> A torque on the driven body.
  type, abstract :: drive_t
  contains
    procedure(torque_interface), deferred :: torque
  end type drive_t

  abstract interface
    pure function torque_interface(self, time, angle, speed) result(torque)
      import :: drive_t, wp
      class(drive_t), intent(in) :: self
      real(wp), intent(in) :: time  !! [s]
      real(wp), intent(in) :: angle !! of the driven body, with all whole turns [rad]
      real(wp), intent(in) :: speed !! of the driven body [rad/s]
      real(wp) :: torque            !! counter-clockwise [N m]
    end function torque_interface
  end interface

  !> A motor with a linear torque-speed line `stall − slope ω`: a constant torque if the slope is 0,
  !! no torque if both are 0.
  type, extends(drive_t) :: motor_drive_t
    real(wp) :: stall = 0.0_wp !! [N m]
    real(wp) :: slope = 0.0_wp !! [N m s]
  contains
    procedure :: torque => motor_torque
  end type motor_drive_t

contains

  !> Torque of the motor at a speed, counter-clockwise [N m].
  pure function motor_torque(self, time, angle, speed) result(torque)
    class(motor_drive_t), intent(in) :: self
    real(wp), intent(in) :: time  !! not used [s]
    real(wp), intent(in) :: angle !! not used [rad]
    real(wp), intent(in) :: speed !! of the driven body [rad/s]
    real(wp) :: torque

    ! The torque depends on neither time nor angle; the zero term only marks both as used.
    torque = self%stall - self%slope*speed + 0.0_wp*(time + angle)
  end function motor_torque

end module drives
