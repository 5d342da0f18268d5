!> Paths, velocities and accelerations of points fixed to links.
module points_study
  use body_points, only: find_point_coefficients, point_coefficients_t, point_total_acceleration, &
    point_velocity
  use kinds, only: wp
  use linkages, only: linkage_t
  use positions, only: positions_t
  implicit none (type, external)
  private

  public :: find_points, point_at_speed, point_values

  !> Numbers of `point_at_speed`.
  integer, parameter :: point_values = 6

contains

  !> Points at all positions, once for all speeds; zeros where there is no pose.
  subroutine find_points(linkage, body, place, positions, threads, found)
    type(linkage_t), intent(in) :: linkage
    integer, intent(in) :: body(:)      !! (points) that each is fixed to
    real(wp), intent(in) :: place(:, :) !! (2, points) from the first pin of its body, in its axes
                                        !! [m]
    type(positions_t), intent(in) :: positions
    integer, intent(in) :: threads
    type(point_coefficients_t), allocatable, intent(out) :: found(:, :) !! (points, states)

    integer :: i, p

    allocate (found(size(body), size(positions%states)))
    !$omp parallel do num_threads(threads) schedule(dynamic, 32) default(shared) private(i, p)
    do i = 1, size(positions%states)
      associate (state => positions%states(i))
        if (allocated(state%error)) cycle
        do p = 1, size(body)
          found(p, i) = find_point_coefficients(linkage, state%pose, state%coefficients, body(p), &
            place(:, p))
        end do
      end associate
    end do
    !$omp end parallel do
  end subroutine find_points

  !> At a speed: place [m], velocity [m/s], acceleration [m/s²].
  pure function point_at_speed(point, speed, acceleration) result(values)
    type(point_coefficients_t), intent(in) :: point
    real(wp), intent(in) :: speed        !! ω2 [rad/s]
    real(wp), intent(in) :: acceleration !! α2 [rad/s²]
    real(wp) :: values(point_values)

    values = [point%place, point_velocity(point, speed), &
      point_total_acceleration(point, speed, acceleration)]
  end function point_at_speed

end module points_study
