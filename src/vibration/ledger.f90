!> Counters of the work done in a run, for `--stats`.
module ledger
  implicit none (type, external)
  private

  public :: ledger_t, add_ledger

  type :: ledger_t
    integer :: kinematic_solutions = 0  !! poses sought besides those of the positions: with changed
                                        !! lengths, and between rows
    integer :: link_models = 0          !! links decomposed into their own modes
    integer :: mass_matrices = 0        !! assembled, one a position and model, and one for each
                                        !! pose with changed lengths
    integer :: stiffness_matrices = 0   !! assembled, by nodal solvers only; elsewhere K is the unit
                                        !! matrix
    integer :: geometric_matrices = 0   !! assembled, one for each unit load that occurs, and one
                                        !! for each pose with changed lengths under loads
    integer :: factorizations = 0       !! of any matrix: inverse iterations, shifts, inertia counts
    integer :: extrapolated = 0         !! eigenproblems started from neighbouring positions
    integer :: reduced_solutions = 0    !! eigenproblems started from the first own modes of every
                                        !! link
    integer :: full_solutions = 0       !! eigenproblems started from, or solved as, the dense one
                                        !! of all unknowns
    integer :: proofs = 0               !! that no mode is missing
    integer :: shapes = 0               !! mode shapes sampled
  end type ledger_t

contains

  !> Adds the counts of a part of the work to a total.
  elemental subroutine add_ledger(total, part)
    type(ledger_t), intent(inout) :: total !! counts so far
    type(ledger_t), intent(in) :: part     !! counts to add

    total%kinematic_solutions = total%kinematic_solutions + part%kinematic_solutions
    total%link_models = total%link_models + part%link_models
    total%mass_matrices = total%mass_matrices + part%mass_matrices
    total%stiffness_matrices = total%stiffness_matrices + part%stiffness_matrices
    total%geometric_matrices = total%geometric_matrices + part%geometric_matrices
    total%factorizations = total%factorizations + part%factorizations
    total%extrapolated = total%extrapolated + part%extrapolated
    total%reduced_solutions = total%reduced_solutions + part%reduced_solutions
    total%full_solutions = total%full_solutions + part%full_solutions
    total%proofs = total%proofs + part%proofs
    total%shapes = total%shapes + part%shapes
  end subroutine add_ledger

end module ledger
