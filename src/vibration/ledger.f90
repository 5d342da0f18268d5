!> What a run computed, counted.
module ledger
  implicit none (type, external)
  private

  public :: ledger_t, add_ledger

  type :: ledger_t
    integer :: link_models = 0          !! links taken apart into their own modes
    integer :: mass_matrices = 0        !! assembled, one a position and model
    integer :: stiffness_matrices = 0   !! assembled: nodal solvers only, elsewhere it is the unit
                                        !! matrix
    integer :: geometric_matrices = 0   !! assembled, for ω2² = 1 or α2 = 1
    integer :: factorizations = 0       !! of any matrix: inverse iterations, shifts, counts
    integer :: extrapolated = 0         !! eigenproblems begun from neighbouring positions
    integer :: reduced_solutions = 0    !! begun from the first own modes of every link
    integer :: full_solutions = 0       !! begun from, or solved as, the eigenproblem of all
                                        !! unknowns
    integer :: operator_products = 0    !! mass matrix times vector on long meshes
    integer :: proofs = 0               !! that no mode is missing
    integer :: shapes = 0               !! mode shapes worked out
  end type ledger_t

contains

  elemental subroutine add_ledger(total, part)
    type(ledger_t), intent(inout) :: total
    type(ledger_t), intent(in) :: part

    total%link_models = total%link_models + part%link_models
    total%mass_matrices = total%mass_matrices + part%mass_matrices
    total%stiffness_matrices = total%stiffness_matrices + part%stiffness_matrices
    total%geometric_matrices = total%geometric_matrices + part%geometric_matrices
    total%factorizations = total%factorizations + part%factorizations
    total%extrapolated = total%extrapolated + part%extrapolated
    total%reduced_solutions = total%reduced_solutions + part%reduced_solutions
    total%full_solutions = total%full_solutions + part%full_solutions
    total%operator_products = total%operator_products + part%operator_products
    total%proofs = total%proofs + part%proofs
    total%shapes = total%shapes + part%shapes
  end subroutine add_ledger

end module ledger
