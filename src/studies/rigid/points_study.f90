!> Paths, velocities and accelerations of points fixed to links.
module points_study
  use body_points, only: find_point_coefficients, point_coefficients_t, point_total_acceleration, &
    point_velocity
  use kinds, only: wp
  use linkages, only: linkage_t
  use positions, only: positions_t
  implicit none (type, external)
  private

  public :: find_points, point_at_speed

  !> Number of values of `point_at_speed`.
  integer, parameter :: point_values = 6

contains

  !> Points at all positions, once for all speeds: Ulker 2010 (2.39) to (2.44).
  subroutine find_points(linkage, body, place, positions, threads, found)
    type(linkage_t), intent(in) :: linkage     !! that carries the points
    integer, intent(in) :: body(:)             !! (points) body to which each point is fixed
    real(wp), intent(in) :: place(:, :)        !! (2, points) from the first pin of the body, in the
                                               !! axes of the body [m]
    type(positions_t), intent(in) :: positions !! of the run
    integer, intent(in) :: threads             !! number of OpenMP threads
    type(point_coefficients_t), allocatable, intent(out) :: found(:, :) !! (points, states) zeros
                                                                        !! where there is no pose

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

  !> Values at a speed: x and y of place [m], velocity [m/s], acceleration [m/s²].
  pure function point_at_speed(point, speed, acceleration) result(values)
    type(point_coefficients_t), intent(in) :: point !! at a position
    real(wp), intent(in) :: speed                   !! ω2 [rad/s]
    real(wp), intent(in) :: acceleration            !! α2 [rad/s²]
    real(wp) :: values(point_values)

    values = [point%place, point_velocity(point, speed), &
      point_total_acceleration(point, speed, acceleration)]
  end function point_at_speed

end module points_study
