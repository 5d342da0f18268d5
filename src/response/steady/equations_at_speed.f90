!> The equation of motion on a grid at a speed, with what its solutions need, as one value: it
!! points to what speeds and solutions share.
module equations_at_speed
  use elastic_equations, only: elastic_terms_t
  use fourier_transform, only: fourier_plan_t
  use kinds, only: wp
  use slow_bases, only: slow_basis_t
  use slow_motions, only: slow_motion_t
  use strain_dampings, only: damping_t
  use turn_grids, only: turn_grid_t
  implicit none (type, external)
  private

  public :: equation_at_speed_t

  type :: equation_at_speed_t
    type(turn_grid_t), pointer :: grid => null()
    type(fourier_plan_t), pointer :: plan => null()  !! for its samples
    type(slow_basis_t), pointer :: basis => null()   !! of this grid
    type(slow_motion_t), pointer :: motion => null() !! at this speed, of as many coordinates
    real(wp) :: speed = 0.0_wp                       !! ω2 [rad/s]
    type(elastic_terms_t) :: terms
    type(damping_t) :: damping                       !! see `damping_of`
  end type equation_at_speed_t

end module equations_at_speed
