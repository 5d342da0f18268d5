!> The quantities of an elastic motion in time: displacements of points and strains of gauges.
module transient_quantities
  use kinds, only: wp
  use response_series, only: gauge_series, point_series, strains_along
  use response_types, only: response_request_t
  use turn_grids, only: moves, turn_grid_t
  implicit none (type, external)
  private

  public :: quantities_of, of_point, of_gauge

  !> Numbers of them: of points (x, y, rotation), then of gauges (axial strain, curvature).
  integer, parameter :: of_point = 3, of_gauge = 2

contains

  !> All quantities at the samples of a grid.
  function quantities_of(grid, request, y) result(series)
    type(turn_grid_t), intent(in) :: grid
    type(response_request_t), intent(in) :: request !! points, gauges
    real(wp), intent(in) :: y(:, :)                 !! (samples, unknowns) [√J]
    real(wp) :: series(size(y, 1), of_point*size(request%points) + of_gauge*size(request%gauges))

    real(wp) :: moved(size(y, 1), 3)
    integer :: first, i

    associate (points => request%points, gauges => request%gauges)
      do i = 1, size(points)
        first = of_point*(i - 1) + 1
        series(:, first:first + 2) = point_series(grid, points(i)%body, points(i)%place, y)
      end do
      do i = 1, size(gauges)
        first = of_point*size(points) + of_gauge*(i - 1) + 1
        if (moves(grid, gauges(i)%body)) then
          moved = gauge_series(grid, gauges(i)%body, gauges(i)%xi, y)
          series(:, first:first + 1) = moved(:, :2)
        else
          call strains_along(grid, gauges(i)%body, [gauges(i)%xi], y, series(:, first:first), &
            series(:, first + 1:first + 1))
        end if
      end do
    end associate
  end function quantities_of

end module transient_quantities
