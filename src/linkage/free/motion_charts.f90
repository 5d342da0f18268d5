!> Coordinates of a moving linkage that are good near a pose, whatever its drives do there.
!!
!! With q the unknowns of all pins and bodies and C(q) = 0 what the linkage demands, the columns of
!! V are orthonormal directions in which it can move at a pose q0: ∇C V = 0. The coordinates are
!! u = Vᵀ(q − q0). Where a drive comes to a limit, V and u stay regular; only at a change point,
!! where ∇C loses a rank, there are none.
module motion_charts
  use dense_factor, only: dense_factor_t, factorize, solve
  use kinds, only: wp
  use kinematic_coefficients, only: kinematic_coefficients_t
  use orthogonal_complement, only: find_complement
  use pose_types, only: pose_t
  use whole_systems, only: curvatures, demands, displaced, misfits, unknown_count, whole_system_t
  implicit none (type, external)
  private

  public :: motion_chart_t, new_chart, find_on_chart, velocities, accelerations, rates_on, &
    is_same_side

  type :: motion_chart_t
    type(pose_t) :: pose                    !! where it is made, pins from `reference_point`
    real(wp) :: crank = 0.0_wp              !! the first drive there, with whole turns [deg] or [m]
    integer, allocatable :: chosen(:)       !! equations, of which others follow
    real(wp), allocatable :: direction(:, :) !! V (unknowns, coordinates)
    type(dense_factor_t) :: factor          !! of ∇C above Vᵀ
    real(wp) :: independence = 0.0_wp       !! of the equations; 0 at a change point [-]
  end type motion_chart_t

  !> Iterations end with a correction below this share of the linkage: the next would be below its
  !! square.
  real(wp), parameter :: last_correction = 1.0e-11_wp

  integer, parameter :: most_iterations = 12

contains

  !> The chart at a pose.
  pure function new_chart(system, pose, crank, freedoms) result(chart)
    type(whole_system_t), intent(in) :: system !! of a linkage
    type(pose_t), intent(in) :: pose           !! at which its equations are fulfilled
    real(wp), intent(in) :: crank              !! the first drive there [deg] or [m]
    integer, intent(in) :: freedoms            !! number of coordinates
    type(motion_chart_t) :: chart

    real(wp), allocatable :: rows(:, :), unit_rows(:, :)
    integer :: i, n

    n = unknown_count(system)
    chart%pose = pose
    chart%crank = crank
    rows = demands(system, pose)
    unit_rows = rows
    do i = 1, size(rows, 1)
      unit_rows(i, :) = rows(i, :)/max(norm2(rows(i, :)), tiny(1.0_wp))
    end do
    allocate (chart%chosen(n - freedoms), chart%direction(n, freedoms))
    call find_complement(unit_rows, n - freedoms, chart%chosen, chart%direction, &
      chart%independence)
    call factorize(bordered(rows, chart), chart%factor)
  end function new_chart

  !> The chosen gradients above the directions of the chart.
  pure function bordered(rows, chart) result(matrix)
    real(wp), intent(in) :: rows(:, :)
    type(motion_chart_t), intent(in) :: chart
    real(wp), allocatable :: matrix(:, :)

    integer :: m, n

    n = size(rows, 2)
    m = size(chart%chosen)
    allocate (matrix(n, n))
    matrix(:m, :) = rows(chart%chosen, :)
    matrix(m + 1:, :) = transpose(chart%direction)
  end function bordered

  !> The pose at coordinates, by Newton's method from the second-order motion out of the chart's
  !! pose. Not found where iterations do not converge or lead farther away than the coordinates say.
  pure subroutine find_on_chart(system, chart, coordinates, pose, factor, found)
    type(whole_system_t), intent(in) :: system    !! of the linkage
    type(motion_chart_t), intent(in) :: chart     !! of `new_chart`
    real(wp), intent(in) :: coordinates(:)        !! u [m]
    type(pose_t), intent(out) :: pose             !! pins from `reference_point`; without `sine`
    type(dense_factor_t), intent(out) :: factor   !! of ∇C above Vᵀ at the pose
    logical, intent(out) :: found                 !! else the pose is of no use

    real(wp) :: q(size(chart%direction, 1)), start(size(q)), step(size(q)), right(size(q)), &
      misfit(size(system%equations)), span, correction
    type(kinematic_coefficients_t) :: straight
    integer :: i, m

    m = size(chart%chosen)
    span = maxval(system%scale)
    start = matmul(chart%direction, coordinates)
    found = .true.
    if (.not. norm2(start) > 0.0_wp) then
      pose = chart%pose
      factor = chart%factor
      return
    end if
    straight = as_coefficients(system, start)
    misfit = curvatures(system, chart%pose, straight)
    right = 0.0_wp
    right(:m) = -0.5_wp*misfit(chart%chosen)
    q = start + solve(chart%factor, right)
    do i = 1, most_iterations
      pose = displaced(system, chart%pose, q)
      call factorize(bordered(demands(system, pose), chart), factor)
      found = abs(factor%determinant) > 0.0_wp
      if (.not. found) return
      if (i > 1) then
        if (correction <= last_correction*span) return
      end if
      misfit = misfits(system, pose, chart%crank)
      right(:m) = -misfit(chart%chosen)
      right(m + 1:) = coordinates - matmul(q, chart%direction)
      step = solve(factor, right)
      correction = maxval(abs(step))
      q = q + step
      found = norm2(q - start) <= 0.5_wp*norm2(start) .and. correction < span
      if (.not. found) return
    end do
    found = .false.
  end subroutine find_on_chart

  !> Velocities of pins and bodies, one set for each coordinate.
  pure subroutine velocities(system, chart, factor, per)
    type(whole_system_t), intent(in) :: system  !! of the linkage
    type(motion_chart_t), intent(in) :: chart
    type(dense_factor_t), intent(in) :: factor  !! of `find_on_chart`
    type(kinematic_coefficients_t), allocatable, intent(out) :: per(:) !! (coordinates) [-], [1/m];
                                                                       !! their slopes are 0

    real(wp) :: right(size(chart%direction, 1))
    integer :: k

    allocate (per(size(chart%direction, 2)))
    do k = 1, size(per)
      right = 0.0_wp
      right(size(chart%chosen) + k) = 1.0_wp
      per(k) = as_coefficients(system, solve(factor, right))
    end do
  end subroutine velocities

  !> Velocities at rates of the coordinates, and accelerations while these rates do not change:
  !! ∇C q'' = −q'ᵀ∇²C q', Vᵀq'' = 0.
  pure subroutine accelerations(system, chart, factor, pose, per, rates, now)
    type(whole_system_t), intent(in) :: system  !! of the linkage
    type(motion_chart_t), intent(in) :: chart
    type(dense_factor_t), intent(in) :: factor  !! of `find_on_chart`
    type(pose_t), intent(in) :: pose            !! likewise
    type(kinematic_coefficients_t), intent(in) :: per(:) !! of `velocities`
    real(wp), intent(in) :: rates(:)            !! (coordinates) u' [m/s]
    type(kinematic_coefficients_t), intent(out) :: now   !! [m/s], [rad/s] and per second

    type(kinematic_coefficients_t) :: slopes
    real(wp) :: right(size(chart%direction, 1)), bend(size(system%equations))
    integer :: m

    m = size(chart%chosen)
    now = rates_on(per, rates)
    bend = curvatures(system, pose, now)
    right = 0.0_wp
    right(:m) = -bend(chart%chosen)
    slopes = as_coefficients(system, solve(factor, right))
    now%turn_slope = slopes%turn
    now%pin_slope = slopes%pin
  end subroutine accelerations

  !> Velocities of pins and bodies at rates of the coordinates.
  pure function rates_on(per, rates) result(now)
    type(kinematic_coefficients_t), intent(in) :: per(:) !! of `velocities`
    real(wp), intent(in) :: rates(:)                     !! (coordinates) u' [m/s]
    type(kinematic_coefficients_t) :: now                !! [m/s], [rad/s]; slopes are 0

    integer :: k

    now = per(1)
    now%turn = rates(1)*per(1)%turn
    now%pin = rates(1)*per(1)%pin
    do k = 2, size(per)
      now%turn = now%turn + rates(k)*per(k)%turn
      now%pin = now%pin + rates(k)*per(k)%pin
    end do
  end function rates_on

  !> Derivatives of the unknowns as those of pins and bodies.
  pure function as_coefficients(system, unknowns) result(coefficients)
    type(whole_system_t), intent(in) :: system
    real(wp), intent(in) :: unknowns(:)
    type(kinematic_coefficients_t) :: coefficients

    integer :: i

    allocate (coefficients%turn(size(system%at_body)), coefficients%pin(2, size(system%at_pin)))
    do i = 1, size(system%at_pin)
      coefficients%pin(:, i) = 0.0_wp
      if (system%at_pin(i) >= 0) coefficients%pin(:, i) = unknowns(system%at_pin(i) + &
        1:system%at_pin(i) + 2)
    end do
    coefficients%turn = unknowns(system%at_body)/system%scale
    allocate (coefficients%turn_slope, mold=coefficients%turn)
    allocate (coefficients%pin_slope, mold=coefficients%pin)
    coefficients%turn_slope = 0.0_wp
    coefficients%pin_slope = 0.0_wp
  end function as_coefficients

  !> Whether the linkage has not passed a change point from one chart to the next: along a smooth
  !! way the determinant of gradients and directions keeps its sign.
  pure function is_same_side(system, before, after) result(is)
    type(whole_system_t), intent(in) :: system       !! of the linkage
    type(motion_chart_t), intent(in) :: before, after
    logical :: is

    type(dense_factor_t) :: factor, between
    type(motion_chart_t) :: same

    call factorize(matmul(transpose(before%direction), after%direction), between)
    same = after
    same%chosen = before%chosen
    call factorize(bordered(demands(system, after%pose), same), factor)
    is = factor%determinant*between%determinant*before%factor%determinant > 0.0_wp
  end function is_same_side

end module motion_charts
