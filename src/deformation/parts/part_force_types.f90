!> Forces in the parts of a linkage.
module part_force_types
  use kinds, only: wp
  implicit none (type, external)
  private

  public :: part_forces_t

  !> Forces of the unit loads.
  type :: part_forces_t
    real(wp), allocatable :: axial(:, :, :)   !! (1, ξ, ξ², lumps; parts; cases) as of
                                              !! `distributed_unit_forces` [N]
    real(wp), allocatable :: second_order(:, :, :) !! (border, border, cases) what blocks on guides
                                              !! and springs add to K_G [-]
    real(wp), allocatable :: border(:, :)     !! (border, cases) static solution; 0 of free motions
    real(wp), allocatable :: work(:, :)       !! (border, cases) the same where nothing holds free
                                              !! drives: work of the loads alone [√J]
    real(wp), allocatable :: guide(:, :)      !! (sliders, cases) force of the guide on the block,
                                              !! along the normal of its line [N]
    real(wp), allocatable :: weighted(:, :)   !! (rows, cases) forces of parts and springs in units
                                              !! of y [√J]
    real(wp), allocatable :: constraint(:, :) !! (constraints, cases) multipliers [N]
    real(wp), allocatable :: spring(:, :)     !! (springs, cases) [N] or [N m]
    real(wp), allocatable :: drive(:, :)      !! (drives, cases) of free ones; 0 of others [N m] or
                                              !! [N]
  end type part_forces_t

end module part_force_types
