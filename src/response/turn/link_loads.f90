!> The axial forces of the rigid motion against those at which the links buckle.
module link_loads
  use axial_limits, only: least_axial_force
  use constants, only: pi, two_pi
  use fourier_transform, only: coefficients_of, fourier_plan_t, value_at
  use kinds, only: wp
  use linkages, only: body_t, linkage_t
  use load_cases, only: constant_case
  use turn_grids, only: turn_grid_t
  implicit none (type, external)
  private

  public :: buckling_shares

  !> Sampled maxima that may be the largest: within this share of the range.
  real(wp), parameter :: candidates = 0.1_wp

  !> Rounds of the search between samples, and how its steps shrink.
  integer, parameter :: rounds = 12
  real(wp), parameter :: narrowing = 0.3_wp

contains

  !> The largest compression over the turn, anywhere in a link, over that at which the link buckles
  !! as pinned at both ends, `π² EI/L²`. Negative: the link is stretched all the time; 0: it is
  !! rigid.
  !!
  !! Sampled maxima near the largest are followed between the crank angles of the grid.
  function buckling_shares(linkage, grid, plan, speed) result(share)
    type(linkage_t), intent(in) :: linkage   !! of the grid
    type(turn_grid_t), intent(in) :: grid    !! axial forces of the unit loads
    type(fourier_plan_t), intent(in) :: plan !! for its samples
    real(wp), intent(in) :: speed            !! ω2 [rad/s]
    real(wp) :: share(size(linkage%bodies))  !! [-]

    real(wp) :: pressed(0:grid%samples + 1), least
    real(wp), allocatable :: force(:, :), coefficients(:, :)
    integer :: b, k, n

    n = grid%samples
    share = 0.0_wp
    do b = 1, size(share)
      associate (link => grid%model%links(b))
        if (.not. link%bends) cycle
        force = speed**2*grid%force(:, :, b, 1) + grid%force(:, :, b, constant_case)
        allocate (coefficients, mold=force)
        call coefficients_of(plan, force, coefficients)
        do k = 1, n
          pressed(k) = -least_axial_force(linkage%bodies(b), force(k, :))
        end do
        pressed(0) = pressed(n)
        pressed(n + 1) = pressed(1)
        share(b) = maxval(pressed)
        least = share(b) - candidates*(share(b) - minval(pressed))
        do k = 1, n
          if (pressed(k) < max(least, pressed(k - 1), pressed(k + 1))) cycle
          share(b) = max(share(b), largest_near(linkage%bodies(b), coefficients, two_pi*(k - 1)/n, &
            two_pi/n))
        end do
        share(b) = share(b)*link%length**2/(pi**2*link%bending_stiffness)
        deallocate (coefficients)
      end associate
    end do
  end function buckling_shares

  !> The largest compression near a crank angle, by parabolas through points that move closer.
  pure function largest_near(body, coefficients, start, step) result(largest)
    type(body_t), intent(in) :: body
    real(wp), intent(in) :: coefficients(:, :) !! of its axial force over the turn
    real(wp), intent(in) :: start, step        !! [rad]
    real(wp) :: largest                        !! [N]

    real(wp) :: best, width, f(-1:1), at(-1:1), bend
    integer :: i, k

    best = start
    width = step
    do k = 1, rounds
      at = best + width*[-1, 0, 1]
      f = [(pressed_at(at(i)), i=-1, 1)]
      largest = maxval(f)
      best = at(maxloc(f, dim=1) - 2)
      bend = f(-1) + f(1) - 2.0_wp*f(0)
      if (bend < 0.0_wp) then
        at(0) = at(0) + 0.5_wp*width*max(-1.0_wp, min(1.0_wp, (f(-1) - f(1))/bend))
        f(0) = pressed_at(at(0))
        if (f(0) > largest) then
          largest = f(0)
          best = at(0)
        end if
      end if
      width = narrowing*width
    end do

  contains

    pure function pressed_at(theta) result(pressed)
      real(wp), intent(in) :: theta
      real(wp) :: pressed

      pressed = -least_axial_force(body, value_at(coefficients, theta))
    end function pressed_at

  end function largest_near

end module link_loads
