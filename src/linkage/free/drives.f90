!> The drive of a linkage that moves by itself.
module drives
  use cubic_splines, only: cubic_spline_t, spline_values
  use errors, only: error_of_numerics, error_t, set_error
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: drive_t, motor_drive_t, refuse_speed

  !> A torque on the driven body, or on the shaft of a motor before its gear (`gears`).
  type, abstract :: drive_t
  contains
    procedure(torque_interface), deferred :: torque
  end type drive_t

  abstract interface
    pure function torque_interface(self, time, angle, speed) result(torque)
      import :: drive_t, wp
      class(drive_t), intent(in) :: self
      real(wp), intent(in) :: time  !! [s]
      real(wp), intent(in) :: angle !! of the shaft, with all whole turns [rad]
      real(wp), intent(in) :: speed !! of the shaft [rad/s]
      real(wp) :: torque            !! counter-clockwise [N m]
    end function torque_interface
  end interface

  !> A motor with a linear torque-speed line `stall − slope ω`: a constant torque if the slope is 0,
  !! no torque if both are 0; or with a line through the points of a table.
  type, extends(drive_t) :: motor_drive_t
    real(wp) :: stall = 0.0_wp !! [N m]
    real(wp) :: slope = 0.0_wp !! [N m s]
    type(cubic_spline_t), allocatable :: line   !! torque over speed [rad/s], [N m]; in place of
                                                !! the straight one
    character(len=:), allocatable :: table_name !! of this line, for messages
  contains
    procedure :: torque => motor_torque
  end type motor_drive_t

  !> By how much rounding may put a speed beyond the ends of a table, of its length.
  real(wp), parameter :: slack = 1.0e-12_wp

contains

  !> Torque of the motor at a speed, counter-clockwise [N m].
  pure function motor_torque(self, time, angle, speed) result(torque)
    class(motor_drive_t), intent(in) :: self
    real(wp), intent(in) :: time  !! not used [s]
    real(wp), intent(in) :: angle !! not used [rad]
    real(wp), intent(in) :: speed !! of the shaft [rad/s]
    real(wp) :: torque

    real(wp) :: values(3)

    ! The torque depends on neither time nor angle; the zero term only marks both as used.
    torque = self%stall - self%slope*speed + 0.0_wp*(time + angle)
    if (.not. allocated(self%line)) return
    values = spline_values(self%line, speed)
    torque = values(1)
  end function motor_torque

  !> Refuses a speed beyond the ends of the table of a motor.
  pure subroutine refuse_speed(drive, speed, error)
    class(drive_t), intent(in) :: drive
    real(wp), intent(in) :: speed !! of the shaft [rad/s]
    type(error_t), allocatable, intent(inout) :: error !! allocated if there is no torque

    real(wp) :: first, last

    select type (drive)
    class is (motor_drive_t)
      if (.not. allocated(drive%line)) return
      first = drive%line%x(1)
      last = drive%line%x(size(drive%line%x))
      if (speed < first - slack*(last - first)) then
        call set_error(error, error_of_numerics, "the motor turns slower than the first speed "// &
          "of the table "//drive%table_name)
      else if (speed > last + slack*(last - first)) then
        call set_error(error, error_of_numerics, "the motor turns faster than the last speed "// &
          "of the table "//drive%table_name)
      end if
    end select
  end subroutine refuse_speed

end module drives
