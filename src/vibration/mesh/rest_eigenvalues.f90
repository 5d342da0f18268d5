!> The lowest eigenvalue at rest, approximately and independent of the deck's mesh. The rounding
!! error of nodal matrices is compared with it.
module rest_eigenvalues
  use deformation_model, only: deformation_model_t, new_deformation_model
  use errors, only: clear_outcome, error_t, outcome_t
  use kinds, only: wp
  use ledger, only: ledger_t
  use load_cases, only: case_count
  use position_equations, only: assemble_equations
  use positions, only: find_positions, positions_t
  use speed_solver, only: new_speed_work, solve_speeds, speed_work_t
  use structures, only: structure_t
  implicit none (type, external)
  private

  public :: lowest_rest_eigenvalues

  integer, parameter :: low_order = 5

contains

  !> The lowest ω² of the unloaded structure at given crank angles [1/s²], to a few digits: huge
  !! where there is no pose or no solution, all zero if a link has no own modes.
  function lowest_rest_eigenvalues(structure, crank) result(lambda)
    type(structure_t), intent(in) :: structure !! with beams
    real(wp), intent(in) :: crank(:)           !! (angles) [deg]
    real(wp) :: lambda(size(crank))            !! (angles)

    type(positions_t) :: positions
    type(deformation_model_t) :: model
    type(speed_work_t) :: work
    type(outcome_t) :: outcome(1)
    type(ledger_t) :: counts
    type(error_t), allocatable :: error
    real(wp) :: no_forces(0, size(structure%beams), case_count), at_rest(case_count, 1)
    integer :: i

    lambda = 0.0_wp
    positions = find_positions(structure%linkage, crank)
    call new_deformation_model(structure%linkage, structure%beams, &
      spread(1, 1, size(structure%beams)), spread(low_order, 1, size(structure%beams)), &
      spread(.false., 1, size(structure%beams)), model, error)
    if (allocated(error)) return
    work = new_speed_work(model, 1)
    at_rest = 0.0_wp
    do i = 1, size(crank)
      associate (state => positions%states(positions%state(i)))
        if (allocated(state%error)) then
          lambda(i) = huge(lambda)
          cycle
        end if
        call clear_outcome(outcome)
        call assemble_equations(structure%linkage, model, state%pose, no_forces, at_rest, &
          work%equations, counts)
        call solve_speeds(state%crank, at_rest, 1, [.false.], work, outcome, counts)
      end associate
      lambda(i) = huge(lambda)
      if (.not. allocated(outcome(1)%error)) lambda(i) = work%found(1)%lambda(1)
    end do
  end function lowest_rest_eigenvalues

end module rest_eigenvalues
