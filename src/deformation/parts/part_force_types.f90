!> Loads of the parts of a linkage, and forces in them.
module part_force_types
  use kinds, only: wp
  use load_cases, only: unit_loads_t
  implicit none (type, external)
  private

  public :: part_loads_t, part_forces_t, loaded_parts_t

  !> Loads of the parts, and what acts on rotations and lines of springs.
  type :: part_loads_t
    type(unit_loads_t) :: unit                      !! on parts and points
    real(wp), allocatable :: moment(:, :)           !! (rotations, cases) [N m]
    real(wp), allocatable :: pull(:)                !! (springs) at the pose, before the linkage
                                                    !! yields [N] or [N m]
    real(wp), allocatable :: end_couple(:, :, :)    !! (2, parts, cases) on the ends of parts that
                                                    !! bend [N m]
    real(wp), allocatable :: tension(:)             !! (tensions) [N] or [N m]
    real(wp), allocatable :: carried(:, :, :)       !! (4, carried bodies, cases) as of
                                                    !! `carried_loads` [N, N m]
  end type part_loads_t

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

  !> Loads, and the forces that balance them.
  type :: loaded_parts_t
    type(part_loads_t) :: loads
    type(part_forces_t) :: forces
  end type loaded_parts_t

end module part_force_types
