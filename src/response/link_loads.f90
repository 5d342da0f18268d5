!> The axial forces of the rigid motion against those at which the links buckle.
module link_loads
  use axial_limits, only: least_axial_force
  use constants, only: pi
  use kinds, only: wp
  use linkages, only: linkage_t
  use load_cases, only: constant_case
  use turn_grids, only: turn_grid_t
  implicit none (type, external)
  private

  public :: buckling_shares

contains

  !> The largest compression over the turn, anywhere in a link, over that at which the link buckles
  !! as pinned at both ends, `π² EI/L²`. Negative: the link is stretched all the time; 0: it is
  !! rigid.
  !!
  !! Between the crank angles of the grid a parabola through three neighbours has the largest value.
  pure function buckling_shares(linkage, grid, speed) result(share)
    type(linkage_t), intent(in) :: linkage  !! of the grid
    type(turn_grid_t), intent(in) :: grid   !! axial forces of the unit loads
    real(wp), intent(in) :: speed           !! ω2 [rad/s]
    real(wp) :: share(size(linkage%bodies)) !! [-]

    real(wp) :: pressed(0:grid%samples + 1), bend
    integer :: b, k, at, n

    n = grid%samples
    share = 0.0_wp
    do b = 1, size(share)
      associate (link => grid%model%links(b))
        if (.not. link%bends) cycle
        do k = 1, n
          pressed(k) = -least_axial_force(linkage%bodies(b), speed**2*grid%force(k, :, b, 1) + &
            grid%force(k, :, b, constant_case))
        end do
        pressed(0) = pressed(n)
        pressed(n + 1) = pressed(1)
        at = maxloc(pressed(1:n), dim=1)
        share(b) = pressed(at)
        bend = pressed(at - 1) + pressed(at + 1) - 2.0_wp*pressed(at)
        if (bend < 0.0_wp) share(b) = share(b) - 0.125_wp*(pressed(at + 1) - &
          pressed(at - 1))**2/bend
        share(b) = share(b)*link%length**2/(pi**2*link%bending_stiffness)
      end associate
    end do
  end function buckling_shares

end module link_loads
