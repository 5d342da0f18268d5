!> What drives give: their coordinates, rates and accelerations, by the coordinate of the first one
!! or in time.
module drive_values
  use constants, only: degree
  use coordinate_types, only: is_sum
  use kinds, only: wp
  use linkages, only: drive_of_coordinate, gives_angle, linkage_t, turned
  use motion_programs, only: program_values
  use pose_types, only: pose_t
  implicit none (type, external)
  private

  public :: drive_value, drive_weight, drive_rate, find_rates_of_drives, drive_direction, &
    direction_at

contains

  !> Coordinate of a drive [deg] or [m].
  pure function drive_value(linkage, number, crank) result(value)
    type(linkage_t), intent(in) :: linkage !! its drives
    integer, intent(in) :: number          !! of the drive, from 1
    real(wp), intent(in) :: crank          !! coordinate of the first drive [deg] or [m]; in time
                                           !! [s]
    real(wp) :: value

    real(wp) :: motion(0:2)

    if (linkage%runs_in_time) then
      motion = motion_in_time(linkage, number, crank)
      value = motion(0)
    else
      value = linkage%drives(number)%ratio*crank + linkage%drives(number)%phase
    end if
  end function drive_value

  !> How far the coordinate of a drive may go where lengths or angles of the linkage change by 1: a
  !! sum has weights of any size.
  pure function drive_weight(linkage, number) result(weight)
    type(linkage_t), intent(in) :: linkage !! its drives and coordinates
    integer, intent(in) :: number          !! of the drive, from 1
    real(wp) :: weight

    integer :: i

    weight = 1.0_wp
    if (linkage%drives(number)%kind /= drive_of_coordinate) return
    associate (coordinate => linkage%coordinates(linkage%drives(number)%coordinate))
      if (coordinate%kind /= is_sum) return
      weight = 0.0_wp
      do i = 1, size(coordinate%term)
        if (any(coordinate%term(:i - 1) == coordinate%term(i))) cycle
        weight = weight + abs(sum(coordinate%weight, mask=coordinate%term == coordinate%term(i)))
      end do
    end associate
  end function drive_weight

  !> Position, rate and acceleration of a drive of a linkage that runs in time.
  pure function motion_in_time(linkage, number, time) result(motion)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: number
    real(wp), intent(in) :: time !! [s]
    real(wp) :: motion(0:2)      !! [deg, deg/s, deg/s²] or [m, m/s, m/s²]

    associate (drive => linkage%drives(number))
      if (drive%has_law) then
        motion = program_values(drive%law, time)
      else
        motion = drive%ratio*program_values(linkage%drives(1)%law, time)
      end if
      motion(0) = motion(0) + drive%phase
    end associate
  end function motion_in_time

  !> Rate of a drive's coordinate, angles in radians, per that of the first drive.
  pure function drive_rate(linkage, number) result(rate)
    type(linkage_t), intent(in) :: linkage !! its drives, which go with the first one
    integer, intent(in) :: number          !! of the drive, from 1
    real(wp) :: rate

    rate = linkage%drives(number)%ratio
    if (gives_angle(linkage%drives(number))) rate = rate*degree
    if (gives_angle(linkage%drives(1))) rate = rate/degree
    if (number == 1) rate = 1.0_wp
  end function drive_rate

  !> First and second derivatives of the coordinates of all drives, angles in radians, with respect
  !! to that of the first one, of which the second are 0; in time rates and accelerations.
  pure subroutine find_rates_of_drives(linkage, crank, rates, accelerations)
    type(linkage_t), intent(in) :: linkage        !! its drives
    real(wp), intent(in) :: crank                 !! coordinate of the first drive [deg] or [m]; in
                                                  !! time [s]
    real(wp), intent(out) :: rates(:)             !! (drives) [rad] or [m], per rad or m; in time
                                                  !! per second
    real(wp), intent(out) :: accelerations(:)     !! (drives) likewise, per square

    real(wp) :: motion(0:2)
    integer :: i

    accelerations = 0.0_wp
    if (.not. linkage%runs_in_time) then
      rates = [(drive_rate(linkage, i), i=1, size(rates))]
      return
    end if
    do i = 1, size(rates)
      motion = motion_in_time(linkage, i, crank)
      if (gives_angle(linkage%drives(i))) motion = motion*degree
      rates(i) = motion(1)
      accelerations(i) = motion(2)
    end do
  end subroutine find_rates_of_drives

  !> The direction, first → last pin, that a drive gives its body.
  pure function drive_direction(linkage, number, pose, crank) result(direction)
    type(linkage_t), intent(in) :: linkage !! its drives and bodies
    integer, intent(in) :: number          !! of a drive of an angle
    type(pose_t), intent(in) :: pose       !! direction of the body from which it is measured
    real(wp), intent(in) :: crank          !! coordinate of the first drive [deg] or [m]
    real(wp) :: direction(2)

    associate (drive => linkage%drives(number))
      direction = direction_at(drive_value(linkage, number, crank))
      if (drive%against > 0) direction = turned(direction, &
        turned(linkage%bodies(drive%against)%heading, pose%direction(:, drive%against)))
      associate (heading => linkage%bodies(drive%body)%heading)
        direction = turned([heading(1), -heading(2)], direction)
      end associate
    end associate
  end function drive_direction

  !> Cosine and sine of an angle in degrees. Whole turns are removed first: 0° and 360° are the same
  !! position to the last digit.
  pure function direction_at(degrees) result(direction)
    real(wp), intent(in) :: degrees !! [deg]
    real(wp) :: direction(2)

    real(wp) :: angle, quadrants

    ! Within ±45° of an axis cosine and sine keep their last digits: 90° gives 0 and 1.
    angle = modulo(degrees, 360.0_wp)
    quadrants = anint(angle/90.0_wp)
    angle = (angle - 90.0_wp*quadrants)*degree
    direction = [cos(angle), sin(angle)]
    select case (modulo(nint(quadrants), 4))
    case (1)
      direction = [-direction(2), direction(1)]
    case (2)
      direction = -direction
    case (3)
      direction = [direction(2), -direction(1)]
    end select
  end function direction_at

end module drive_values
