!> Steps of the time along the way of a linkage that runs in time.
module time_steps
  use drive_values, only: drive_value, drive_weight
  use kinds, only: wp
  use linkages, only: gives_angle, linkage_t
  use motion_programs, only: program_breaks
  implicit none (type, external)
  private

  public :: step_in_time

contains

  !> The largest step from an instant in which no drive moves far and no law jumps, as far as the
  !! last instant of this sense; 0 there [s].
  pure function step_in_time(linkage, time, sense, angle, length) result(step)
    type(linkage_t), intent(in) :: linkage !! its drives and their laws
    real(wp), intent(in) :: time           !! [s]
    real(wp), intent(in) :: sense          !! +1: up; −1: down
    real(wp), intent(in) :: angle, length  !! how far drives may move [deg], [m]
    real(wp) :: step

    integer, parameter :: samples = 8
    real(wp) :: far
    integer :: d, k
    logical :: is_far

    step = sense*(linkage%times(merge(2, 1, sense > 0.0_wp)) - time)
    if (.not. step > 0.0_wp) then
      step = 0.0_wp
      return
    end if
    do d = 1, size(linkage%drives)
      far = merge(angle, length, gives_angle(linkage%drives(d)))*drive_weight(linkage, d)
      do
        is_far = .false.
        do k = 1, samples
          is_far = is_far .or. abs(drive_value(linkage, d, time + sense*step*k/samples) - &
            drive_value(linkage, d, time)) > far
        end do
        if (.not. is_far .or. step <= spacing(time)) exit
        step = 0.5_wp*step
      end do
    end do
    do d = 1, size(linkage%drives)
      if (linkage%drives(d)%has_law) step = way_to_break(linkage, d, time, sense, step)
    end do
  end function step_in_time

  !> A step that ends where the law of a drive jumps, or a derivative of it does.
  pure function way_to_break(linkage, drive, time, sense, step) result(way)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: drive
    real(wp), intent(in) :: time, sense, step
    real(wp) :: way

    real(wp), allocatable :: breaks(:)

    way = step
    if (sense > 0.0_wp) then
      breaks = program_breaks(linkage%drives(drive)%law, time, time + step)
      if (size(breaks) > 0) way = breaks(1) - time
    else
      breaks = program_breaks(linkage%drives(drive)%law, time - step, time)
      if (size(breaks) > 0) way = time - breaks(size(breaks))
    end if
  end function way_to_break

end module time_steps
